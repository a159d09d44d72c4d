/* Is the next action, or standing, free of what is seen? See plan_sight.h. */
#include "runtime/core/plan/plan_course.h"

/* ------------------------------------------------------------------------------------------------------- tracks */

/* Do the colliders, from p at a knot to q at the next one, meet the other one? */
static bool meets(const ff_sight_track *seen, int32_t knot, const ff_knot *p, const ff_knot *q, float radius,
                  float margin, const ff_limits *limits)
{
    float r0, r1;
    const ff_knot *y0 = ff_sight_knot(seen, knot, &r0), *y1 = ff_sight_knot(seen, knot + 1, &r1);
    float theirs = r0 > r1 ? r0 : r1, reach = radius + theirs + margin;
    return ff_roots_near(p, q, y0, y1, seen->a, seen->b, reach) &&
           ff_bodies_hit(p, q, y0, y1, seen->a, seen->b, radius, theirs, limits, NULL);
}

/* Bit k: that one of those seen from i on, i + 3 at most, takes up room within radius of (a, b) in a window. */
static unsigned near_rooms(const ff_sight_rooms *r, uint32_t i, float a, float b, float radius)
{
    unsigned who = 0;
#ifdef __SSE2__
    const __m128 zero = _mm_setzero_ps(), x = _mm_set1_ps(a), y = _mm_set1_ps(b);
    __m128 da = _mm_max_ps(
        _mm_max_ps(_mm_sub_ps(_mm_loadu_ps(r->low_a + i), x), _mm_sub_ps(x, _mm_loadu_ps(r->high_a + i))),
        zero);
    __m128 db = _mm_max_ps(
        _mm_max_ps(_mm_sub_ps(_mm_loadu_ps(r->low_b + i), y), _mm_sub_ps(y, _mm_loadu_ps(r->high_b + i))),
        zero);
    who = (unsigned)_mm_movemask_ps(
        _mm_cmple_ps(_mm_add_ps(_mm_mul_ps(da, da), _mm_mul_ps(db, db)), _mm_set1_ps(radius * radius)));
#else
    for (uint32_t k = i; k < i + 4; ++k) {
        float da = fmaxf(fmaxf(r->low_a[k] - a, a - r->high_a[k]), 0.0f);
        float db = fmaxf(fmaxf(r->low_b[k] - b, b - r->high_b[k]), 0.0f);
        if (da * da + db * db <= radius * radius) who |= 1u << (k - i);
    }
#endif
    return who;
}

/* Lists who takes up room within radius of (a, b) in one of the chunks from first to last. */
static uint32_t list_near(const ff_sight *s, uint32_t first, uint32_t last, float a, float b, float radius,
                          uint8_t near[FF_SIGHT_MAX])
{
    uint32_t count = 0, end = s->window_count > 0 ? s->window_count - 1 : 0;
    uint32_t from = first < end ? first : end, to = last < end ? last : end;
    for (uint32_t i = 0; i < s->count; i += 4) {
        unsigned who = 0;
        for (uint32_t w = from; w <= to; w += FF_SIGHT_WINDOW)
            who |= near_rooms(&s->rooms[w], i, a, b, radius);
        for (uint32_t k = i; who; ++k, who >>= 1)
            if ((who & 1u) && ff_sight_room_near(&s->seen[k], first, last, a, b, radius))
                near[count++] = (uint8_t)k;
    }
    return count;
}

/* ------------------------------------------------------------------------------------------------------- movers */

static ff_vec2 sight_mover_at(const ff_sight_mover *m, int32_t knot)
{
    uint32_t k = knot < 0 ? 0 : (uint32_t)knot;
    return m->at[k < m->known ? k : m->known - 1];
}

/* Do the colliders, from p at a knot to q at the next one, meet it? */
static bool meets_mover(const ff_sight_mover *m, int32_t knot, const ff_knot *p, const ff_knot *q,
                        const float *radii, double margin)
{
    if (m->gone && knot >= (int32_t)m->known) return false;
    ff_vec2 from = sight_mover_at(m, knot), to = sight_mover_at(m, knot + 1);
    ff_solid solid = m->solid;
    solid.centre = from;
    uint32_t k = knot < 0 ? 0 : (uint32_t)knot;
    double slack = k < FF_TRACK_KNOTS_MAX ? (double)m->slack[k] : 0.0;
    return ff_solid_hit(&solid, ff_sub2(to, from), ff_v2(0.0, 0.0), p, q, radii,
                        margin + slack + m->grow * (double)k);
}

/* Could it be met by somebody who stays within radius of a place from one knot to another? */
static bool mover_near(const ff_sight_mover *m, int32_t from, int32_t to, float a, float b, float radius)
{
    if (m->gone && from >= (int32_t)m->known) return false;
    ff_vec2 here = ff_v2((double)a, (double)b);
    for (int32_t k = from; k <= to; ++k) {
        ff_vec2 at = sight_mover_at(m, k), next = sight_mover_at(m, k + 1);
        uint32_t slack = k < FF_TRACK_KNOTS_MAX ? (uint32_t)k : FF_TRACK_KNOTS_MAX - 1;
        double reach = (double)radius + m->solid.bound + m->grow * (double)to + (double)m->slack[slack] +
                       ff_length2(ff_sub2(next, at));
        if (ff_length2(ff_sub2(at, here)) <= reach) return true;
    }
    return false;
}

/* ------------------------------------------------------------------------------------------------------- stance */

/* An action's colliders at t seconds in its place, without what joins it to the one before. */
static void place(const ff_action_set *set, const ff_set_action *action, const float anchor[2], float c,
                  float s, float t, ff_knot *restrict out)
{
    ff_knot local;
    ff_set_sample(set, action, t, &local);
    ff_set_put(&local, anchor, c, s, out);
}

static float furthest(const ff_knot *p, const ff_knot *q)
{
    float most = 0.0f;
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i) {
        float da = p->a[i] - q->a[i], db = p->b[i] - q->b[i], square = da * da + db * db;
        most = square > most ? square : most;
    }
    return sqrtf(most);
}

void ff_stance_begin(const ff_sight *sight, float begin_cosine, float begin_sine, ff_stance *st)
{
    const ff_action_set *set = sight->set;
    const ff_set_action *a = &set->actions[st->action];
    place(set, a, st->other, begin_cosine, begin_sine, a->duration, &st->end);
    st->knot = (int32_t)(st->time / (float)FF_TRACK_STEP);
    float since = st->time - (float)st->knot * (float)FF_TRACK_STEP;
    if (st->hold)
        st->tail = st->end;
    else
        place(set, a, st->other, begin_cosine, begin_sine, a->duration - since, &st->tail);
    st->about = ff_knot_radius(&st->tail, set->radii);
    st->moved = furthest(&st->end, &st->tail);
    float ra = st->end.a[FF_COLLIDER_ROOT], rb = st->end.b[FF_COLLIDER_ROOT];
    float reach = a->next_reach[sight->reactive] + sight->margin + st->moved;
    int32_t last = st->knot + (int32_t)(a->next_longest[sight->reactive] / (float)FF_TRACK_STEP) + 1;
    st->near_count = list_near(sight, ff_sight_chunk(sight, st->knot), ff_sight_chunk(sight, last), ra, rb,
                               reach, st->near);
    st->mover_count = 0;
    for (uint32_t i = 0; i < sight->mover_count; ++i)
        if (mover_near(&sight->mover[i], st->knot, last, ra, rb, reach))
            st->mover[st->mover_count++] = (uint8_t)i;
    memcpy(st->met, sight->met, sizeof st->met);
    ff_vec2 root = ff_add2(sight->origin, ff_v2((double)ra, (double)rb));
    st->solids = sight->shape_count > 0 || ff_solids_near(sight->solids, root, (double)reach);
}

/* Does the course touch what does not move, or moves on known paths? */
static bool meets_things(const ff_sight *sight, ff_course *c)
{
    const ff_stance *st = c->stance;
    double margin = (double)sight->margin;
    if (st->mover_count == 0 && !st->solids) return false;
    ff_course_make(sight, c);
    ff_vec2 centre = ff_add2(sight->origin, ff_v2((double)c->a, (double)c->b));
    if (st->solids && ff_solids_hit(sight->solids, centre, (double)c->radius, sight->origin, c->knots,
                                    c->total, sight->set->radii, margin))
        return true;
    for (uint32_t k = 0; k + 1 < c->total; ++k) {
        const ff_knot *p = &c->knots[k], *q = p + 1;
        for (uint32_t i = 0; i < sight->shape_count; ++i)
            if (ff_solid_hit(&sight->shape[i], ff_v2(0.0, 0.0), sight->origin, p, q, sight->set->radii,
                             margin))
                return true;
        for (uint32_t i = 0; i < st->mover_count; ++i)
            if (meets_mover(&sight->mover[st->mover[i]], st->knot + (int32_t)k, p, q, sight->set->radii,
                            margin))
                return true;
    }
    return false;
}

/* J/kg for being within the proximity of others, torso to torso. */
static float proximity_cost(const ff_sight *sight, ff_course *c)
{
    const ff_stance *st = c->stance;
    float sum = 0.0f, within = sight->cost_within + 2.0f * sight->set->radii[FF_COLLIDER_ROOT];
    if (st->near_count > 0) ff_course_make(sight, c);
    for (uint32_t i = 0; i < st->near_count; ++i) {
        const ff_sight_track *seen = &sight->seen[st->near[i]];
        for (uint32_t k = 1; k < c->total; ++k) {
            float radius;
            const ff_knot *y = ff_sight_knot(seen, st->knot + (int32_t)k, &radius);
            float a = y->a[FF_COLLIDER_ROOT] + seen->a - c->knots[k].a[FF_COLLIDER_ROOT];
            float b = y->b[FF_COLLIDER_ROOT] + seen->b - c->knots[k].b[FF_COLLIDER_ROOT];
            if (a * a + b * b < within * within) sum += sight->cost * (float)FF_TRACK_STEP;
        }
    }
    return sum;
}

bool ff_stance_free(ff_sight *sight, ff_stance *st, const ff_set_next *next, float *cost)
{
    if (cost) *cost = 0.0f;
    if (st->near_count == 0 && st->mover_count == 0 && !st->solids) return true;
    ff_course c;
    ff_course_begin(sight, st, next, &c);
    if (ff_course_meets(sight, &c, st)) return false;
    if (meets_things(sight, &c)) return false;
    if (cost && sight->cost > 0.0f) *cost = proximity_cost(sight, &c);
    return true;
}

/* ------------------------------------------------------------------------------------------------------ standing */

/* Standing from the tail on, for ever or up to a knot, does it meet the other one? */
static bool stands_in_way(const ff_sight_track *seen, const ff_stance *st, int32_t last, bool ever,
                          float radius, float margin, const ff_limits *limits)
{
    int32_t end = seen->shift + (int32_t)seen->track->count - 1, stop = end < last ? end : last, k = st->knot;
    do {
        const ff_knot *from = k == st->knot ? &st->tail : &st->end;
        if (meets(seen, k, from, &st->end, radius, margin, limits)) return true;
    } while (++k < stop);
    return ever && meets(seen, k, &st->end, &st->end, radius, margin, limits);
}

/* Up to which knot standing has to be free of a mover. For ever: what can be jumped or ducked is, when it comes near. Else nobody
 * would go where a beam passes some day. */
static int32_t stands_until(const ff_sight_mover *mover, const ff_stance *st, bool ever, int32_t last)
{
    const int32_t ready = (int32_t)(2.0 / FF_TRACK_STEP);
    int32_t until = ever && mover->evaded && st->knot + ready < last ? st->knot + ready : last;
    return mover->yields < until ? mover->yields : until;
}

bool ff_stance_waits(ff_sight *sight, const ff_stance *st, float seconds)
{
    bool ever = !(seconds < 60.0f);
    float margin = ever ? sight->stand_margin : sight->margin;
    const ff_limits *limits = ever ? &sight->stand_limits : &sight->limits;
    int32_t last = ever ? FF_TRACK_KNOTS_MAX - 1 : (int32_t)((st->time + seconds) / (float)FF_TRACK_STEP);
    float ra = st->end.a[FF_COLLIDER_ROOT], rb = st->end.b[FF_COLLIDER_ROOT];
    const float *radii = sight->set->radii;
    float r0 = ff_knot_radius(&st->tail, radii), r1 = ff_knot_radius(&st->end, radii),
          radius = r0 > r1 ? r0 : r1;
    uint8_t near[FF_SIGHT_MAX];
    uint32_t count = list_near(sight, ff_sight_chunk(sight, st->knot), ff_sight_chunk(sight, last), ra, rb,
                               radius + st->moved + margin, near);
    for (uint32_t i = 0; i < count; ++i)
        if (stands_in_way(&sight->seen[near[i]], st, last, ever, radius, margin, limits)) return false;
    const ff_knot stands[2] = {st->tail, st->end};
    ff_vec2 centre = ff_add2(sight->origin, ff_v2((double)ra, (double)rb));
    if (ff_solids_hit(sight->solids, centre, (double)(radius + st->moved), sight->origin, stands, 2, radii,
                      (double)sight->margin))
        return false;
    for (uint32_t i = 0; i < sight->shape_count; ++i)
        if (ff_solid_hit(&sight->shape[i], ff_v2(0.0, 0.0), sight->origin, &stands[0], &stands[1], radii,
                         (double)sight->margin))
            return false;
    for (uint32_t i = 0; i < sight->mover_count; ++i)
        for (int32_t k = st->knot; k < stands_until(&sight->mover[i], st, ever, last); ++k)
            if (meets_mover(&sight->mover[i], k, k == st->knot ? &st->tail : &st->end, &st->end, radii,
                            (double)sight->margin))
                return false;
    return true;
}
