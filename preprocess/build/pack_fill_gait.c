/* What velocity planning and synthesis need beside the examples themselves. */
#include "preprocess/build/pack_fill.h"
#include "preprocess/examples/correspond_set.h"
#include "preprocess/examples/derive.h"
#include "preprocess/examples/sharp_turn.h"

#include "runtime/core/base/fail.h"

#include <stdlib.h>
#include <string.h>

#define NO_STRAFE (15.0 * FF_DEG) /* algorithms A.10 */

static ff_status no_memory(ff_error *error)
{
    return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory filling the pack");
}

static ff_status add_loops(ff_pack_content *content, const ff_example_set *set, ff_error *error)
{
    ff_pack_loop *loops = ff_array_grow(&content->loops, (size_t)set->count, sizeof *loops);
    if (!loops) return no_memory(error);
    for (int i = 0; i < set->count; ++i)
        loops[i] = set->items[i].loop;
    return FF_OK;
}

static ff_pack_pair pair_record(const ff_cycle_pair *pair)
{
    return (ff_pack_pair){.phase = {(float)pair->phase[0], (float)pair->phase[1]},
                          .distance = (float)pair->distance,
                          .rms = (float)pair->rms,
                          .turn = (float)pair->alignment.turn,
                          .shift = {(float)pair->alignment.shift.a, (float)pair->alignment.shift.b}};
}

static ff_status add_correspondence(ff_pack_content *content, const ff_set_pairs *item, ff_error *error)
{
    const ff_cycle_pairs *pairs = &item->pairs;
    if (pairs->count == 0) return FF_OK;
    ff_pack_correspondence *out = ff_array_grow(&content->correspondences, 1, sizeof *out);
    ff_pack_pair *pair = ff_array_grow(&content->pairs, (size_t)pairs->count, sizeof *pair);
    if (!out || !pair) return no_memory(error);
    *out = (ff_pack_correspondence){.from = (uint32_t)item->from,
                                    .to = item->to < 0 ? FF_CORRESPOND_GAIT : (uint32_t)item->to,
                                    .first_pair = (uint32_t)(content->pairs.count - (size_t)pairs->count),
                                    .pair_count = (uint32_t)pairs->count,
                                    .flags = pairs->by_keys ? FF_CORRESPOND_KEYS : 0,
                                    .wait = {(float)pairs->wait[0], (float)pairs->wait[1]},
                                    .mean = (float)pairs->mean};
    for (int i = 0; i < pairs->count; ++i)
        pair[i] = pair_record(&pairs->pair[i]);
    return FF_OK;
}

static ff_status add_model(ff_pack_content *content, const ff_gait_fit *fit, ff_error *error)
{
    ff_pack_gait *gait = ff_array_grow(&content->gait, 1, sizeof *gait);
    ff_pack_gait_path *path = ff_array_grow(&content->gait_path, FF_GAIT_SAMPLES, sizeof *path);
    if (!gait || !path) return no_memory(error);
    *gait = fit->gait;
    memcpy(path, fit->path, sizeof fit->path);
    return FF_OK;
}

/* The semi-procedural clip at the rates of each walk; nothing for runs, which it does not do. */
static ff_status play_model(const ff_rig *rig, const ff_example_set *set, ff_example *gait, ff_error *error)
{
    const ff_example *base = &set->items[set->gait.gait.example];
    ff_status status = FF_OK;
    for (int i = 0; i < set->count && status == FF_OK; ++i) {
        const ff_pack_example *r = &set->items[i].record;
        if (r->gait != FF_GAIT_WALK) continue;
        ff_derive_target target = {"gait", (double)r->v_forward, (double)r->v_left, (double)r->turn_rate,
                                   0.0};
        status = ff_derive_walk(rig, base, &set->gait, &target, &gait[i], error);
    }
    return status;
}

/* Of the examples that go forwards without strafing, as the hull is (algorithms A.11). */
static ff_status add_sharp_turns(ff_pack_content *content, const ff_example_set *set, ff_error *error)
{
    ff_turning *motions = ff_calloc((size_t)set->count, sizeof *motions);
    if (!motions) return no_memory(error);
    int count = 0;
    for (int i = 0; i < set->count; ++i) {
        const ff_pack_example *r = &set->items[i].record;
        if (r->v_forward > 0.0f && fabs(ff_atan2((double)r->v_left, (double)r->v_forward)) <= NO_STRAFE)
            motions[count++] = (ff_turning){ff_length2(ff_v2((double)r->v_forward, (double)r->v_left)),
                                            (double)r->turn_rate};
    }
    ff_status status = ff_sharp_turns_find(motions, count, &content->sharp, error);
    free(motions);
    return status;
}

ff_status ff_pack_add_gait(ff_pack_content *content, const ff_correspondence_settings *settings,
                           const ff_rig *rig, const ff_example_set *set, ff_tasks *tasks, ff_error *error)
{
    ff_correspondences found = {0};
    ff_example *gait = ff_calloc((size_t)set->count, sizeof *gait);
    ff_status status = gait ? add_loops(content, set, error) : no_memory(error);
    if (status == FF_OK) status = add_sharp_turns(content, set, error);
    if (status == FF_OK) status = add_model(content, &set->gait, error);
    if (status == FF_OK) status = play_model(rig, set, gait, error);
    if (status == FF_OK) status = ff_correspond_set(settings, rig, set, gait, tasks, &found, error);
    for (int i = 0; i < found.count && status == FF_OK; ++i)
        status = add_correspondence(content, &found.items[i], error);
    ff_correspondences_free(&found);
    for (int i = 0; gait && i < set->count; ++i)
        ff_example_free(&gait[i]);
    free(gait);
    return status;
}
