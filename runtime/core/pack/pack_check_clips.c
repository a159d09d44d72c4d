#include "runtime/core/base/fail.h"
#include "runtime/core/pack/pack_check.h"

#define LIMIT_VALUE 1e6f /* s, m, J/kg: no clip reaches it */
#define ACTION_FLAGS                                                                                         \
    (FF_ACTION_MIRRORED | FF_ACTION_ALPHA_UNDEFINED | FF_ACTION_DERIVED | FF_ACTION_WHOLE |                  \
     FF_ACTION_FROM_STANDING | FF_ACTION_TO_STANDING)
#define SORTED_BY_TIME 1e-3f /* s: times are single precision */

static ff_status check_clip(const ff_pack *pack, uint32_t index, ff_error *error)
{
    const ff_pack_clip *clip = &pack->clips[index];
    const uint32_t names[5] = {clip->name, clip->source, clip->licence, clip->citation, clip->tags};
    for (int i = 0; i < 5; ++i)
        if (names[i] >= pack->string_size)
            return FF_PACK_REFUSE("CLIP", &clip->name + i, "clip %u: a text lies outside STRS", index);
    if (clip->stream >= pack->stream_count)
        return FF_PACK_REFUSE("CLIP", &clip->stream, "clip %u: stream %u of %u", index, clip->stream,
                              pack->stream_count);
    if (!ff_pack_range_fits(clip->first_plant, clip->plant_count, pack->plant_count))
        return FF_PACK_REFUSE("CLIP", &clip->first_plant, "clip %u: plants %u + %u of %u", index,
                              clip->first_plant, clip->plant_count, pack->plant_count);
    if (!ff_pack_range_fits(clip->first_action, clip->action_count, pack->action_count))
        return FF_PACK_REFUSE("CLIP", &clip->first_action, "clip %u: actions %u + %u of %u", index,
                              clip->first_action, clip->action_count, pack->action_count);
    if (!(clip->source_rate >= 1.0f && clip->source_rate <= 10000.0f))
        return FF_PACK_REFUSE("CLIP", &clip->source_rate, "clip %u: %g frames per second", index,
                              (double)clip->source_rate);
    const float *wild = ff_pack_wild_float(&clip->floor_base, 1, 1e4f);
    if (!wild) wild = ff_pack_wild_float(clip->floor_slope, 2, 10.0f);
    if (!wild) wild = ff_pack_wild_float(&clip->time_offset, 1, LIMIT_VALUE);
    if (wild) return FF_PACK_REFUSE("CLIP", wild, "clip %u: %g", index, (double)*wild);
    if (clip->flags & ~(uint32_t)FF_CLIP_DERIVED)
        return FF_PACK_REFUSE("CLIP", &clip->flags, "clip %u: flags %x", index, clip->flags);
    return FF_OK;
}

static ff_status check_plant(const ff_pack *pack, uint32_t index, ff_error *error)
{
    const ff_pack_plant *plant = &pack->plants[index];
    if (plant->clip >= pack->clip_count)
        return FF_PACK_REFUSE("PLNT", &plant->clip, "plant %u: clip %u of %u", index, plant->clip,
                              pack->clip_count);
    if (plant->foot > 1) return FF_PACK_REFUSE("PLNT", &plant->foot, "plant %u: foot %u", index, plant->foot);
    const float times[4] = {plant->start, plant->end, plant->flat_start, plant->flat_end};
    if (ff_pack_wild_float(times, 4, LIMIT_VALUE) || plant->end < plant->start ||
        plant->flat_end < plant->flat_start)
        return FF_PACK_REFUSE("PLNT", &plant->start, "plant %u: from %g to %g s, flat %g to %g s", index,
                              (double)times[0], (double)times[1], (double)times[2], (double)times[3]);
    const float *wild = ff_pack_wild_float(plant->ball, 2, LIMIT_VALUE);
    if (!wild) wild = ff_pack_wild_float(&plant->yaw, 1, LIMIT_VALUE);
    if (!wild) wild = ff_pack_wild_float(&plant->slide, 1, LIMIT_VALUE);
    if (!wild) wild = ff_pack_wild_float(&plant->level, 1, LIMIT_VALUE);
    if (wild) return FF_PACK_REFUSE("PLNT", wild, "plant %u: %g", index, (double)*wild);
    if (!(plant->confidence >= 0.0f && plant->confidence <= 1.0f))
        return FF_PACK_REFUSE("PLNT", &plant->confidence, "plant %u: confidence %g", index,
                              (double)plant->confidence);
    if (plant->origin >= FF_PLANT_ORIGIN_COUNT)
        return FF_PACK_REFUSE("PLNT", &plant->origin, "plant %u: origin %u", index, plant->origin);
    return FF_OK;
}

/* UINT32_MAX = the action has no such plant (a jump, say). */
static bool plant_known(const ff_pack *pack, uint32_t plant)
{
    return plant < pack->plant_count || plant == UINT32_MAX;
}

/* Events of an action lie in its time, in order. */
static ff_status check_events(const ff_pack *pack, uint32_t index, ff_error *error)
{
    const ff_pack_action *action = &pack->actions[index];
    if (!ff_pack_range_fits(action->first_event, action->event_count, pack->event_count))
        return FF_PACK_REFUSE("ACTN", &action->first_event, "action %u: events %u + %u of %u", index,
                              action->first_event, action->event_count, pack->event_count);
    float last = action->t_0 - SORTED_BY_TIME;
    for (uint32_t i = 0; i < action->event_count; ++i) {
        const ff_pack_event *event = &pack->events[action->first_event + i];
        if (!(event->time >= last && event->time <= action->t_end + SORTED_BY_TIME))
            return FF_PACK_REFUSE("EVNT", &event->time, "action %u: an event at %g s, after %g and up to %g",
                                  index, (double)event->time, (double)last, (double)action->t_end);
        if (event->foot > 1 || event->kind >= FF_EVENT_KIND_COUNT || event->plant >= pack->plant_count)
            return FF_PACK_REFUSE("EVNT", &event->foot, "action %u: foot %u, kind %u, plant %u of %u", index,
                                  event->foot, event->kind, event->plant, pack->plant_count);
        last = event->time;
    }
    return FF_OK;
}

/* Successors of an action: nearest first, standing on a foot that stands. */
static ff_status check_successors(const ff_pack *pack, uint32_t index, ff_error *error)
{
    const ff_pack_action *action = &pack->actions[index];
    if (!ff_pack_range_fits(action->first_successor, action->successor_count, pack->successor_count))
        return FF_PACK_REFUSE("ACTN", &action->first_successor, "action %u: successors %u + %u of %u", index,
                              action->first_successor, action->successor_count, pack->successor_count);
    float last = 0.0f;
    for (uint32_t i = 0; i < action->successor_count; ++i) {
        const ff_pack_successor *next = &pack->successors[action->first_successor + i];
        if (next->action >= pack->action_count)
            return FF_PACK_REFUSE("NEXT", &next->action, "action %u: successor %u of %u", index, next->action,
                                  pack->action_count);
        if (!(next->distance >= last && next->distance <= LIMIT_VALUE && next->cost >= 0.0f &&
              next->cost <= LIMIT_VALUE))
            return FF_PACK_REFUSE("NEXT", &next->distance,
                                  "action %u: successor %u at %g m, after %g m, costs %g J/kg", index,
                                  next->action, (double)next->distance, (double)last, (double)next->cost);
        bool stands = (action->flags & FF_ACTION_TO_STANDING) && !(action->flags & FF_ACTION_WHOLE) &&
                      (pack->actions[next->action].flags & FF_ACTION_FROM_STANDING);
        if (pack->actions[next->action].support != action->swing && !stands)
            return FF_PACK_REFUSE("NEXT", &next->action, "action %u: successor %u stands on the wrong foot",
                                  index, next->action);
        last = next->distance;
    }
    return FF_OK;
}

static ff_status check_action(const ff_pack *pack, uint32_t index, ff_error *error)
{
    const ff_pack_action *action = &pack->actions[index];
    if (action->clip >= pack->clip_count)
        return FF_PACK_REFUSE("ACTN", &action->clip, "action %u: clip %u of %u", index, action->clip,
                              pack->clip_count);
    if (action->mode >= FF_MODE_COUNT || action->support > 1 || action->swing > 1 ||
        (action->flags & ~(uint32_t)ACTION_FLAGS))
        return FF_PACK_REFUSE("ACTN", &action->mode, "action %u: mode %u, feet %u and %u, flags %x", index,
                              action->mode, action->support, action->swing, action->flags);
    /* The numbers of the record lie one after the other, from t_0 to coarse_radius. */
    size_t numbers =
        (offsetof(ff_pack_action, first_collider) - offsetof(ff_pack_action, t_0)) / sizeof(float);
    const float *first = (const float *)(const void *)((const char *)action + offsetof(ff_pack_action, t_0));
    const float *wild = ff_pack_wild_float(first, numbers, LIMIT_VALUE);
    if (wild) return FF_PACK_REFUSE("ACTN", wild, "action %u: %g", index, (double)*wild);
    if (!(action->t_end >= action->t_0 && action->duration >= 0.0f && action->coarse_radius >= 0.0f))
        return FF_PACK_REFUSE("ACTN", &action->t_0, "action %u: from %g to %g s, %g s long, radius %g m",
                              index, (double)action->t_0, (double)action->t_end, (double)action->duration,
                              (double)action->coarse_radius);
    if (!ff_pack_range_fits(action->first_collider, (uint64_t)action->collider_samples * FF_COLLIDER_COUNT,
                            pack->collider_count))
        return FF_PACK_REFUSE("ACTN", &action->first_collider, "action %u: %u collider samples at %u of %u",
                              index, action->collider_samples, action->first_collider, pack->collider_count);
    if (!plant_known(pack, action->support_plant) || !plant_known(pack, action->swing_plant))
        return FF_PACK_REFUSE("ACTN", &action->support_plant, "action %u: plants %u and %u of %u", index,
                              action->support_plant, action->swing_plant, pack->plant_count);
    if (action->reach != FF_REACH_NONE && action->reach >= pack->reach_count)
        return FF_PACK_REFUSE("ACTN", &action->reach, "action %u: reach table %u of %u", index, action->reach,
                              pack->reach_count);
    ff_status status = check_events(pack, index, error);
    return status == FF_OK ? check_successors(pack, index, error) : status;
}

/* Tracks go with the frames after the examples': two feet each, or the pack has none at all. */
static ff_status check_tracks(const ff_pack *pack, ff_error *error)
{
    uint64_t want = 2 * (uint64_t)pack->frame_count - pack->foot_count;
    if (pack->track_count == 0 || pack->track_count == want) return FF_OK;
    return FF_PACK_REFUSE("TRCK", pack->tracks, "%u foot tracks, expected none or %llu", pack->track_count,
                          (unsigned long long)want);
}

/* A size for every collider, or the pack has none at all. */
static ff_status check_collider_radii(const ff_pack *pack, ff_error *error)
{
    uint32_t count = pack->collider_radius_count;
    if (count != 0 && count != FF_COLLIDER_COUNT)
        return FF_PACK_REFUSE("CRAD", pack->collider_radii, "%u radii of colliders, expected %d", count,
                              FF_COLLIDER_COUNT);
    for (uint32_t c = 0; c < count; ++c)
        if (!(pack->collider_radii[c] > 0.0f && pack->collider_radii[c] < 10.0f))
            return FF_PACK_REFUSE("CRAD", &pack->collider_radii[c], "collider %u: radius %g m", c,
                                  (double)pack->collider_radii[c]);
    return FF_OK;
}

ff_status ff_pack_check_clips(const ff_pack *pack, ff_error *error)
{
    ff_status status = check_tracks(pack, error);
    if (status == FF_OK) status = check_collider_radii(pack, error);
    for (uint32_t i = 0; i < pack->clip_count && status == FF_OK; ++i)
        status = check_clip(pack, i, error);
    for (uint32_t i = 0; i < pack->plant_count && status == FF_OK; ++i)
        status = check_plant(pack, i, error);
    for (uint32_t i = 0; i < pack->action_count && status == FF_OK; ++i)
        status = check_action(pack, i, error);
    for (uint32_t i = 0; i < pack->collider_count && status == FF_OK; ++i) {
        const float *wild = ff_pack_wild_float(&pack->colliders[i].a, 3, LIMIT_VALUE);
        if (wild) status = FF_PACK_REFUSE("COLL", wild, "collider %u: %g m", i, (double)*wild);
    }
    return status;
}
