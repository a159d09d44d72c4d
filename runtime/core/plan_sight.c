#include "runtime/core/plan_sight.h"

#include <string.h>

/* ------------------------------------------------------------------------------------------------------ opening */

/* The nearest ones that are near enough, in order of distance, then of the list. */
static void see_tracks(ff_sight *s, const ff_plan_world *world, double view, uint32_t most)
{
    for (uint32_t i = 0; i < world->track_count; ++i) {
        const ff_track *track = world->tracks[i];
        int64_t shift = track->first - s->first_knot;
        ff_vec2 at = ff_sub2(track->origin, s->origin);
        int64_t now = shift < 0 ? -shift : 0;
        uint32_t k = now < (int64_t)track->count ? (uint32_t)now : track->count - 1;
        float a = (float)at.a + track->knots[k].a[FF_COLLIDER_ROOT],
              b = (float)at.b + track->knots[k].b[FF_COLLIDER_ROOT];
        float distance = sqrtf(a * a + b * b);
        if (!((double)distance <= view)) continue;
        if (s->count == most && distance >= s->seen[most - 1].distance) continue;
        uint32_t place = s->count < most ? s->count++ : most - 1;
        for (; place > 0 && distance < s->seen[place - 1].distance; --place)
            s->seen[place] = s->seen[place - 1];
        s->seen[place] = (ff_sight_track){track, (float)at.a, (float)at.b, (int32_t)shift, distance};
    }
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
        double time = (double)s->first_knot * FF_TRACK_STEP;
        for (uint32_t k = 0; k < FF_TRACK_KNOTS_MAX; ++k)
            m->at[k] = ff_add2(centre, ff_mover_at(from, time + k * FF_TRACK_STEP));
        for (uint32_t k = 0; k + 1 < FF_TRACK_KNOTS_MAX; ++k)
            m->slack[k] = (float)corner_slack(from, time + k * FF_TRACK_STEP, time + (k + 1) * FF_TRACK_STEP,
                                              ff_sub2(m->at[k], centre), ff_sub2(m->at[k + 1], centre));
        m->slack[FF_TRACK_KNOTS_MAX - 1] = 0.0f;
    }
}

/* Somebody who goes by velocity is believed to go on for a while, and then is anywhere. */
static void see_walkers(ff_sight *s, const ff_plan_world *world, double view)
{
    const double believed = 2.5, grow = 0.08; /* s, m/s */
    for (uint32_t i = 0; i < world->walker_count && s->mover_count < FF_SIGHT_MOVING_MAX; ++i) {
        const ff_walker *from = &world->walkers[i];
        ff_vec2 at = ff_sub2(from->position, s->origin);
        if (!(ff_length2(at) <= view)) continue;
        ff_sight_mover *m = &s->mover[s->mover_count++];
        m->solid =
            (ff_solid){.axis = ff_v2(1.0, 0.0), .radius = from->radius, .high = 1.9, .bound = from->radius};
        m->grow = grow * FF_TRACK_STEP;
        m->known = (uint32_t)(believed / FF_TRACK_STEP);
        m->gone = 1;
        for (uint32_t k = 0; k <= m->known; ++k) {
            m->at[k] = ff_madd2(at, from->velocity, k * FF_TRACK_STEP - s->lead);
            m->slack[k] = 0.0f;
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
    out->lead = time - (double)out->first_knot * FF_TRACK_STEP;
    out->margin = (float)options->margin;
    out->stand_margin = (float)(options->margin + options->stand_margin);
    out->limits = ff_limits_of(out->margin);
    out->stand_limits = ff_limits_of(out->stand_margin);
    out->cost = (float)options->proximity_cost;
    out->cost_within = (float)options->proximity;
    out->count = out->mover_count = out->shape_count = 0;
    uint32_t most = options->view_count < FF_SIGHT_MAX ? options->view_count : FF_SIGHT_MAX;
    if (most > 0) see_tracks(out, world, options->view, most);
    see_movers(out, world);
    see_walkers(out, world, options->view);
    for (uint32_t i = 0; i < world->shape_count && out->shape_count < FF_SIGHT_MAX; ++i)
        out->shape[out->shape_count++] = ff_solid_of_shape(&world->shapes[i]);
}

/* ------------------------------------------------------------------------------------------------------- tracks */

static const ff_knot *track_knot(const ff_sight_track *seen, int32_t knot, uint32_t *place)
{
    int32_t k = knot - seen->shift;
    k = k < 0 ? 0 : (k >= (int32_t)seen->track->count ? (int32_t)seen->track->count - 1 : k);
    *place = (uint32_t)k;
    return &seen->track->knots[k];
}

/* Do the colliders, from p at a knot to q at the next one, meet the other one? */
static bool meets(const ff_sight_track *seen, int32_t knot, const ff_knot *p, const ff_knot *q, float radius,
                  float margin, const ff_limits *limits)
{
    uint32_t k0, k1;
    const ff_knot *y0 = track_knot(seen, knot, &k0), *y1 = track_knot(seen, knot + 1, &k1);
    float r0 = seen->track->radius[k0], r1 = seen->track->radius[k1];
    float reach = radius + (r0 > r1 ? r0 : r1) + margin;
    return ff_roots_near(p, q, y0, y1, seen->a, seen->b, reach) &&
           ff_knots_hit(p, q, y0, y1, seen->a, seen->b, limits);
}

/* Room that the other one takes up between two knots: a box. */
static void room_of(const ff_sight_track *seen, int32_t from, int32_t to, float room[4])
{
    const ff_track *track = seen->track;
    int32_t last = (int32_t)track->count - 1;
    int32_t low = from - seen->shift, high = to - seen->shift;
    low = low < 0 ? 0 : (low > last ? last : low);
    high = high < 0 ? 0 : (high > last ? last : high);
    room[0] = room[1] = INFINITY;
    room[2] = room[3] = -INFINITY;
    for (int32_t c = low / FF_TRACK_CHUNK; c <= high / FF_TRACK_CHUNK; ++c) {
        const ff_track_room *r = &track->room[c];
        room[0] = r->low_a < room[0] ? r->low_a : room[0];
        room[1] = r->low_b < room[1] ? r->low_b : room[1];
        room[2] = r->high_a > room[2] ? r->high_a : room[2];
        room[3] = r->high_b > room[3] ? r->high_b : room[3];
    }
    room[0] += seen->a, room[2] += seen->a;
    room[1] += seen->b, room[3] += seen->b;
}

static bool room_near(const float room[4], float a, float b, float radius)
{
    float da = a < room[0] ? room[0] - a : (a > room[2] ? a - room[2] : 0.0f);
    float db = b < room[1] ? room[1] - b : (b > room[3] ? b - room[3] : 0.0f);
    return da * da + db * db <= radius * radius;
}

/* ------------------------------------------------------------------------------------------------------- movers */

static ff_vec2 sight_mover_at(const ff_sight_mover *m, int32_t knot)
{
    uint32_t k = knot < 0 ? 0 : (uint32_t)knot;
    return m->at[k < m->known ? k : m->known - 1];
}

/* Do the colliders, from p at a knot to q at the next one, meet it? */
static bool meets_mover(const ff_sight *s, const ff_sight_mover *m, int32_t knot, const ff_knot *p,
                        const ff_knot *q, double margin)
{
    if (m->gone && knot >= (int32_t)m->known) return false;
    (void)s;
    ff_vec2 from = sight_mover_at(m, knot), to = sight_mover_at(m, knot + 1);
    ff_solid solid = m->solid;
    solid.centre = from;
    uint32_t k = knot < 0 ? 0 : (uint32_t)knot;
    double slack = k < FF_TRACK_KNOTS_MAX ? (double)m->slack[k] : 0.0;
    return ff_solid_hit(&solid, ff_sub2(to, from), ff_v2(0.0, 0.0), p, q,
                        margin + slack + m->grow * (double)k);
}

/* Could it be met by somebody who stays within radius of a place from one knot to another? */
static bool mover_near(const ff_sight_mover *m, int32_t from, int32_t to, float a, float b, float radius)
{
    if (m->gone && from >= (int32_t)m->known) return false;
    double reach = (double)radius + m->solid.bound + m->grow * (double)to + 0.3;
    for (int32_t k = from; k <= to + 1; k += 2) {
        ff_vec2 at = sight_mover_at(m, k);
        double step = 2.0 * ff_length2(ff_sub2(sight_mover_at(m, k + 1), at));
        if (ff_length2(ff_sub2(at, ff_v2((double)a, (double)b))) <= reach + step) return true;
    }
    return false;
}

/* ------------------------------------------------------------------------------------------------------- stance */

/* An action's colliders at t seconds in its place. */
static void place(const ff_action_set *set, const ff_set_action *action, const float anchor[2], float c,
                  float s, float t, ff_knot *out)
{
    ff_knot local;
    ff_set_sample(set, action, t, &local);
    for (int i = 0; i < FF_TRACK_LANES; ++i) {
        out->a[i] = anchor[0] + c * local.a[i] - s * local.b[i];
        out->b[i] = anchor[1] + s * local.a[i] + c * local.b[i];
        out->y[i] = local.y[i];
    }
}

void ff_stance_begin(const ff_sight *sight, float begin_cosine, float begin_sine, ff_stance *st)
{
    const ff_action_set *set = sight->set;
    const ff_set_action *a = &set->actions[st->action];
    place(set, a, st->other, begin_cosine, begin_sine, a->duration, &st->end);
    st->knot = (int32_t)floorf(st->time / (float)FF_TRACK_STEP);
    float since = st->time - (float)st->knot * (float)FF_TRACK_STEP;
    if (st->hold)
        st->tail = st->end;
    else
        place(set, a, st->other, begin_cosine, begin_sine, a->duration - since, &st->tail);
    float ra = st->end.a[FF_COLLIDER_ROOT], rb = st->end.b[FF_COLLIDER_ROOT];
    st->moved = 0.0f;
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i) {
        float da = st->end.a[i] - st->tail.a[i], db = st->end.b[i] - st->tail.b[i];
        float size = sqrtf(da * da + db * db);
        st->moved = size > st->moved ? size : st->moved;
    }
    float reach = a->next_reach + sight->margin + st->moved;
    int32_t last = st->knot + (int32_t)(set->longest / (float)FF_TRACK_STEP) + 1;
    st->near_count = st->mover_count = 0;
    for (uint32_t i = 0; i < sight->count; ++i) {
        float *room = st->room[st->near_count];
        room_of(&sight->seen[i], st->knot, last, room);
        if (room_near(room, ra, rb, reach)) st->near[st->near_count++] = (uint16_t)i;
    }
    for (uint32_t i = 0; i < sight->mover_count; ++i)
        if (mover_near(&sight->mover[i], st->knot, last, ra, rb, reach))
            st->mover[st->mover_count++] = (uint16_t)i;
    ff_vec2 root = ff_add2(sight->origin, ff_v2((double)ra, (double)rb));
    st->solids = sight->shape_count > 0 || ff_solids_near(sight->solids, root, (double)reach);
}

/* The knots of a successor: [0] is the stance's tail. Returns how many. */
static uint32_t course(const ff_sight *sight, const ff_stance *st, const ff_set_action *b,
                       const float anchor[2], const ff_knot *jump, ff_knot *out)
{
    int32_t last = (int32_t)floorf((st->time + b->duration) / (float)FF_TRACK_STEP);
    uint32_t n = 0;
    out[n++] = st->tail;
    for (int32_t k = st->knot + 1; k <= last && n < FF_SIGHT_KNOTS; ++k) {
        float t = (float)k * (float)FF_TRACK_STEP - st->time;
        ff_knot *to = &out[n++];
        place(sight->set, b, anchor, st->cosine, st->sine, t, to);
        float left = ff_set_blend(b, t);
        if (left > 0.0f)
            for (int i = 0; i < FF_TRACK_LANES; ++i) {
                to->a[i] += left * jump->a[i];
                to->b[i] += left * jump->b[i];
                to->y[i] += left * jump->y[i];
            }
    }
    return n;
}

/* Has the course anything to do with what does not move, or moves on known paths? */
static bool course_meets_things(const ff_sight *sight, const ff_stance *st, const ff_knot *knots, uint32_t n,
                                float a, float b, float radius)
{
    ff_vec2 centre = ff_add2(sight->origin, ff_v2((double)a, (double)b));
    if (st->solids &&
        ff_solids_hit(sight->solids, centre, (double)radius, sight->origin, knots, n, (double)sight->margin))
        return true;
    for (uint32_t i = 0; i < sight->shape_count; ++i)
        for (uint32_t k = 0; k + 1 < n; ++k)
            if (ff_solid_hit(&sight->shape[i], ff_v2(0.0, 0.0), sight->origin, &knots[k], &knots[k + 1],
                             (double)sight->margin))
                return true;
    for (uint32_t i = 0; i < st->mover_count; ++i)
        for (uint32_t k = 0; k + 1 < n; ++k)
            if (meets_mover(sight, &sight->mover[st->mover[i]], st->knot + (int32_t)k, &knots[k],
                            &knots[k + 1], (double)sight->margin))
                return true;
    return false;
}

/* J/kg for being within the proximity of others, torso to torso. */
static float proximity_cost(const ff_sight *sight, const ff_stance *st, const ff_knot *knots, uint32_t n)
{
    float sum = 0.0f, within = sight->cost_within + 2.0f * ff_collider_radius[FF_COLLIDER_ROOT];
    for (uint32_t i = 0; i < st->near_count; ++i) {
        const ff_sight_track *seen = &sight->seen[st->near[i]];
        for (uint32_t k = 1; k < n; ++k) {
            uint32_t at;
            const ff_knot *y = track_knot(seen, st->knot + (int32_t)k, &at);
            float a = y->a[FF_COLLIDER_ROOT] + seen->a - knots[k].a[FF_COLLIDER_ROOT];
            float b = y->b[FF_COLLIDER_ROOT] + seen->b - knots[k].b[FF_COLLIDER_ROOT];
            if (a * a + b * b < within * within) sum += sight->cost * (float)FF_TRACK_STEP;
        }
    }
    return sum;
}

bool ff_stance_free(const ff_sight *sight, const ff_stance *st, const ff_set_next *next, float *cost)
{
    if (cost) *cost = 0.0f;
    if (st->near_count == 0 && st->mover_count == 0 && !st->solids) return true;
    const ff_set_action *b = &sight->set->actions[next->action];
    const float *anchor = next->other ? st->other : st->at;
    const ff_knot *begin = &sight->set->samples[b->first_knot];
    ff_knot jump, knots[FF_SIGHT_KNOTS];
    for (int i = 0; i < FF_TRACK_LANES; ++i) {
        jump.a[i] = st->end.a[i] - anchor[0] - st->cosine * begin->a[i] + st->sine * begin->b[i];
        jump.b[i] = st->end.b[i] - anchor[1] - st->sine * begin->a[i] - st->cosine * begin->b[i];
        jump.y[i] = st->end.y[i] - begin->y[i];
    }
    float ca = anchor[0] + st->cosine * b->circle[0] - st->sine * b->circle[1];
    float cb = anchor[1] + st->sine * b->circle[0] + st->cosine * b->circle[1];
    float radius = b->circle[2] + next->jump + st->moved + sight->margin;
    uint32_t n = 0;
    for (uint32_t i = 0; i < st->near_count; ++i) {
        if (!room_near(st->room[i], ca, cb, radius)) continue;
        if (n == 0) n = course(sight, st, b, anchor, &jump, knots);
        const ff_sight_track *seen = &sight->seen[st->near[i]];
        for (uint32_t k = 0; k + 1 < n; ++k) {
            float r0 = ff_knot_radius(&knots[k]), r1 = ff_knot_radius(&knots[k + 1]);
            if (meets(seen, st->knot + (int32_t)k, &knots[k], &knots[k + 1], r0 > r1 ? r0 : r1, sight->margin,
                      &sight->limits))
                return false;
        }
    }
    if (st->mover_count > 0 || st->solids) {
        if (n == 0) n = course(sight, st, b, anchor, &jump, knots);
        if (course_meets_things(sight, st, knots, n, ca, cb, radius)) return false;
    }
    if (cost && sight->cost > 0.0f && n > 0) *cost = proximity_cost(sight, st, knots, n);
    return true;
}

bool ff_stance_waits(const ff_sight *sight, const ff_stance *st, float seconds)
{
    bool ever = !(seconds < 60.0f);
    float margin = ever ? sight->stand_margin : sight->margin;
    const ff_limits *limits = ever ? &sight->stand_limits : &sight->limits;
    int32_t last = ever ? 1 << 20 : (int32_t)floorf((st->time + seconds) / (float)FF_TRACK_STEP);
    float ra = st->end.a[FF_COLLIDER_ROOT], rb = st->end.b[FF_COLLIDER_ROOT];
    float r0 = ff_knot_radius(&st->tail), r1 = ff_knot_radius(&st->end), radius = r0 > r1 ? r0 : r1;
    for (uint32_t i = 0; i < sight->count; ++i) {
        const ff_sight_track *seen = &sight->seen[i];
        int32_t end = seen->shift + (int32_t)seen->track->count - 1, stop = end < last ? end : last;
        float room[4];
        room_of(seen, st->knot, stop > st->knot ? stop : st->knot, room);
        if (!room_near(room, ra, rb, radius + st->moved + margin)) continue;
        int32_t k = st->knot;
        do {
            const ff_knot *from = k == st->knot ? &st->tail : &st->end;
            if (meets(seen, k, from, &st->end, radius, margin, limits)) return false;
        } while (++k < stop);
        if (ever && meets(seen, k, &st->end, &st->end, radius, margin, limits)) return false;
    }
    const ff_knot stands[2] = {st->tail, st->end};
    ff_vec2 centre = ff_add2(sight->origin, ff_v2((double)ra, (double)rb));
    if (ff_solids_hit(sight->solids, centre, (double)(radius + st->moved), sight->origin, stands, 2,
                      (double)sight->margin))
        return false;
    for (uint32_t i = 0; i < sight->shape_count; ++i)
        if (ff_solid_hit(&sight->shape[i], ff_v2(0.0, 0.0), sight->origin, &stands[0], &stands[1],
                         (double)sight->margin))
            return false;
    int32_t known = last < FF_TRACK_KNOTS_MAX - 1 ? last : FF_TRACK_KNOTS_MAX - 1;
    for (uint32_t i = 0; i < sight->mover_count; ++i)
        for (int32_t k = st->knot; k < known; ++k)
            if (meets_mover(sight, &sight->mover[i], k, k == st->knot ? &st->tail : &st->end, &st->end,
                            (double)sight->margin))
                return false;
    return true;
}
