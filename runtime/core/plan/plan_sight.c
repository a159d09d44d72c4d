#include "runtime/core/plan/plan_sight.h"

#include <string.h>

/* ------------------------------------------------------------------------------------------------------ opening */

static const double STOPPED = 3.0;               /* s after the time horizon, at the latest, plans stand */
static const float FASTEST = 1.7f, REACH = 0.8f; /* m/s, m: of somebody who walks */

/* For each chunk of the search, one over the square of how far one who walks from the start may be when it ends, or when the search
 * does at the latest (knots). */
static void find_walks(const ff_sight *s, double end, float walk[FF_SIGHT_CHUNKS])
{
    for (uint32_t c = 0; c < FF_SIGHT_CHUNKS; ++c) {
        float until = (float)ff_min((double)((int32_t)(c + 1) * FF_TRACK_CHUNK - s->skipped), end);
        float far = REACH + FASTEST * (float)FF_TRACK_STEP * until;
        walk[c] = 1.0f / (far * far);
    }
}

/* How near a track comes to the start, as a share of how far one who walks from there may be by then; squared. More than 1: the two
 * cannot meet. */
static float nearest_share(const ff_sight_track *seen, const float walk[FF_SIGHT_CHUNKS])
{
    float least = INFINITY, a = -seen->a, b = -seen->b;
    int32_t last = (int32_t)seen->rooms - 1, c = seen->chunk < 0 ? -seen->chunk : 0;
    for (c = c < last ? c : last; c <= last; ++c) {
        const ff_track_room *r = &seen->track->room[c];
        float da = a < r->low_a ? r->low_a - a : (a > r->high_a ? a - r->high_a : 0.0f);
        float db = b < r->low_b ? r->low_b - b : (b > r->high_b ? b - r->high_b : 0.0f);
        int32_t at = c + seen->chunk;
        if (c == last || at >= FF_SIGHT_CHUNKS) at = FF_SIGHT_CHUNKS - 1; /* stands there for ever */
        float share = (da * da + db * db) * walk[at < 0 ? 0 : at];
        least = share < least ? share : least;
    }
    return least;
}

/* Those that can be met, the likeliest first, then in order of the list. What counts is where they will be, not where they are: two
 * who see each other too late have plans that meet (footstep study, section 4.3). */
static void see_tracks(ff_sight *s, const ff_plan_world *world, const ff_plan_options *options)
{
    uint32_t most = options->view_count < FF_SIGHT_MAX ? options->view_count : FF_SIGHT_MAX;
    double end =
        options->time_horizon > 0.0 ? (options->time_horizon + STOPPED) / FF_TRACK_STEP : FF_TRACK_KNOTS_MAX;
    float walk[FF_SIGHT_CHUNKS];
    find_walks(s, end, walk);
    if (most == 0) return;
    for (uint32_t i = 0; i < world->track_count; ++i) {
        const ff_track *track = world->tracks[i];
        ff_vec2 at = ff_sub2(track->origin, s->origin);
        if (!(ff_dot2(at, at) <= options->view * options->view)) continue;
        ff_sight_track seen = {.track = track,
                               .a = (float)at.a,
                               .b = (float)at.b,
                               .shift = (int32_t)(track->first - s->first_knot),
                               .chunk = (int32_t)(ff_knot_chunk(track->first) - ff_knot_chunk(s->first_knot)),
                               .rooms = ff_track_rooms(track)};
        seen.share = nearest_share(&seen, walk);
        if (seen.share > 1.0f || (s->count == most && seen.share >= s->seen[most - 1].share)) continue;
        uint32_t place = s->count < most ? s->count++ : most - 1;
        for (; place > 0 && seen.share < s->seen[place - 1].share; --place)
            s->seen[place] = s->seen[place - 1];
        s->seen[place] = seen;
    }
}

/* The boxes of window after window; spare lanes are nowhere. */
static void find_rooms(ff_sight *s)
{
    int32_t windows = 1;
    for (uint32_t i = 0; i < s->count; ++i) {
        const ff_sight_track *seen = &s->seen[i];
        int32_t end = seen->chunk + (int32_t)seen->rooms;
        windows = end > windows ? end : windows;
    }
    s->window_count = (uint32_t)(windows < FF_SIGHT_CHUNKS ? windows : FF_SIGHT_CHUNKS);
    for (uint32_t i = 0; i < s->count; ++i) {
        const ff_sight_track *seen = &s->seen[i];
        s->pathed[i] = false;
        for (int32_t w = 0; w < (int32_t)s->window_count; ++w) {
            int32_t last = (int32_t)seen->rooms - 1, c = w - seen->chunk;
            c = c < 0 ? 0 : (c > last ? last : c);
            ff_track_room all = seen->track->room[c];
            for (int32_t k = c + 1; k < c + FF_SIGHT_WINDOW && k <= last; ++k) {
                const ff_track_room *r = &seen->track->room[k];
                all.low_a = r->low_a < all.low_a ? r->low_a : all.low_a;
                all.low_b = r->low_b < all.low_b ? r->low_b : all.low_b;
                all.high_a = r->high_a > all.high_a ? r->high_a : all.high_a;
                all.high_b = r->high_b > all.high_b ? r->high_b : all.high_b;
            }
            ff_sight_rooms *to = &s->rooms[w];
            to->low_a[i] = all.low_a + seen->a, to->high_a[i] = all.high_a + seen->a;
            to->low_b[i] = all.low_b + seen->b, to->high_b[i] = all.high_b + seen->b;
        }
    }
    for (uint32_t i = s->count; i < FF_SIGHT_MAX && (i & 3u); ++i)
        for (uint32_t w = 0; w < s->window_count; ++w)
            s->rooms[w].low_a[i] = s->rooms[w].low_b[i] = s->rooms[w].high_a[i] = s->rooms[w].high_b[i] =
                INFINITY;
}

#define JUMPED 0.45 /* m: no higher is what can be jumped over ... */
#define DUCKED 1.0  /* ... and no lower what can be ducked under */

uint32_t ff_shape_evasions(const ff_shape *shape)
{
    return (shape->high <= JUMPED ? (uint32_t)FF_EVADE_JUMP : 0u) |
           (shape->low >= DUCKED ? (uint32_t)FF_EVADE_DUCK : 0u);
}

/* Where a mover is at a time. */
ff_vec2 ff_mover_at(const ff_mover *mover, double time)
{
    double t = time - mover->start, last = mover->path[mover->count - 1].time;
    if (mover->cyclic && last > 0.0) t -= last * floor(t / last);
    uint32_t i = 0;
    while (i + 1 < mover->count && mover->path[i + 1].time <= t)
        ++i;
    const ff_path_point *p = &mover->path[i];
    if (i + 1 == mover->count || t <= p->time) return p->at;
    double share = (t - p->time) / (mover->path[i + 1].time - p->time);
    return ff_madd2(p->at, ff_sub2(mover->path[i + 1].at, p->at), share);
}

/* How far the mover's corners between two times are off the straight line between its places then. */
static double corner_slack(const ff_mover *mover, double from, double to, ff_vec2 p, ff_vec2 q)
{
    enum { LOOKS = 8 };
    double most = 0.0;
    for (int i = 1; i < LOOKS; ++i) {
        double share = (double)i / LOOKS;
        ff_vec2 there = ff_mover_at(mover, ff_lerp(from, to, share));
        ff_vec2 straight = ff_madd2(p, ff_sub2(q, p), share);
        most = ff_max(most, ff_length2(ff_sub2(there, straight)));
    }
    return 2.0 * most; /* a corner between two looks is at most as far off again */
}

static void see_movers(ff_sight *s, const ff_plan_world *world)
{
    for (uint32_t i = 0; i < world->mover_count && s->mover_count < FF_SIGHT_MOVING_MAX; ++i) {
        const ff_mover *from = &world->movers[i];
        ff_sight_mover *m = &s->mover[s->mover_count++];
        ff_shape shape = from->shape;
        ff_vec2 centre = ff_sub2(shape.centre, s->origin);
        shape.centre = ff_v2(0.0, 0.0);
        m->solid = ff_solid_of_shape(&shape);
        m->grow = 0.0;
        m->known = FF_TRACK_KNOTS_MAX;
        m->gone = 0;
        m->evaded = ff_shape_evasions(&shape) != 0;
        m->yields = INT32_MAX;
        double time = (double)s->first_knot * FF_TRACK_STEP;
        for (uint32_t k = 0; k < FF_TRACK_KNOTS_MAX; ++k)
            m->at[k] = ff_add2(centre, ff_mover_at(from, time + k * FF_TRACK_STEP));
        for (uint32_t k = 0; k + 1 < FF_TRACK_KNOTS_MAX; ++k)
            m->slack[k] = (float)corner_slack(from, time + k * FF_TRACK_STEP, time + (k + 1) * FF_TRACK_STEP,
                                              ff_sub2(m->at[k], centre), ff_sub2(m->at[k + 1], centre));
        m->slack[FF_TRACK_KNOTS_MAX - 1] = 0.0f;
    }
}

/* Where it is believed to be, so many seconds from the time of the world on, from where it is then. */
static ff_vec2 walker_at(const ff_walker *w, double time)
{
    if (!w->path_a) return ff_scale2(w->velocity, time);
    double k = ff_clamp(time / FF_TRACK_STEP, 0.0, w->path_count - 1.0);
    uint32_t i = (uint32_t)k, next = i + 1 < w->path_count ? i + 1 : i;
    ff_vec2 p = ff_v2((double)w->path_a[i], (double)w->path_b[i]),
            q = ff_v2((double)w->path_a[next], (double)w->path_b[next]);
    return ff_madd2(p, ff_sub2(q, p), k - i);
}

/* Somebody who goes by velocity is believed to go on for a while, and then is anywhere. */
static void see_walkers(ff_sight *s, const ff_plan_world *world, double view)
{
    const double yields = 1.0, regain = 0.4, grows = 2.5; /* s, m/s, s */
    for (uint32_t i = 0; i < world->walker_count && s->mover_count < FF_SIGHT_MOVING_MAX; ++i) {
        const ff_walker *from = &world->walkers[i];
        ff_vec2 at = ff_sub2(from->position, s->origin);
        if (!(ff_length2(at) <= view)) continue;
        ff_sight_mover *m = &s->mover[s->mover_count++];
        m->solid = (ff_solid){.axis = ff_unit2(from->velocity),
                              .half_length = from->half_length,
                              .radius = from->radius,
                              .high = 1.9,
                              .bound = from->half_length + from->radius};
        if (from->half_length == 0.0) m->solid.axis = ff_v2(1.0, 0.0);
        m->grow = 0.0;
        m->known = (uint32_t)ff_min(from->until / FF_TRACK_STEP, FF_TRACK_KNOTS_MAX - 1.0);
        m->gone = 1;
        m->evaded = 0;
        m->yields = from->path_a ? INT32_MAX : (int32_t)(yields / FF_TRACK_STEP);
        for (uint32_t k = 0; k <= m->known; ++k) {
            double time = k * FF_TRACK_STEP - s->lead, later = ff_max(time, 0.0);
            m->at[k] = ff_add2(at, walker_at(from, time));
            m->slack[k] = (float)(ff_min(from->wide - from->radius, regain * later) +
                                  from->grow * ff_min(k * FF_TRACK_STEP, grows));
        }
    }
}

void ff_sight_open(const ff_action_set *set, const ff_plan_world *world, const ff_plan_options *options,
                   ff_vec2 origin, double time, ff_sight *out)
{
    out->set = set;
    out->solids = world->solids;
    out->origin = origin;
    out->first_knot = (int64_t)floor(time / FF_TRACK_STEP);
    out->skipped = (int32_t)(out->first_knot - ff_knot_chunk(out->first_knot) * FF_TRACK_CHUNK);
    out->lead = time - (double)out->first_knot * FF_TRACK_STEP;
    out->margin = (float)options->margin;
    out->stand_margin = (float)(options->margin + options->stand_margin);
    out->limits = ff_limits_of(set->radii, set->radii, out->margin);
    out->stand_limits = ff_limits_of(set->radii, set->radii, out->stand_margin);
    out->reactive = options->reactive != 0;
    out->cost = (float)options->proximity_cost;
    out->cost_within = (float)options->proximity;
    out->count = out->mover_count = out->shape_count = 0;
    for (int i = 0; i < FF_MEETINGS; ++i)
        out->met[i] = (ff_meeting){.who = FF_SIGHT_MAX};
    see_tracks(out, world, options);
    find_rooms(out);
    see_movers(out, world);
    see_walkers(out, world, options->view);
    for (uint32_t i = 0; i < world->shape_count && out->shape_count < FF_SIGHT_MAX; ++i)
        out->shape[out->shape_count++] = ff_solid_of_shape(&world->shapes[i]);
}
