/* Is the next action, or standing, free of what is seen? See plan_sight.h. */
#include "runtime/core/plan_sight.h"

#include "runtime/core/plan_joint.h"

#include <string.h>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

/* ------------------------------------------------------------------------------------------------------- tracks */

static const ff_knot *track_knot(const ff_sight_track *seen, int32_t knot, float *radius)
{
    int32_t k = knot - seen->shift, last = (int32_t)seen->track->count - 1;
    k = k < 0 ? 0 : (k > last ? last : k);
    *radius = seen->track->radius[k];
    return &seen->track->knots[k];
}

/* Do the colliders, from p at a knot to q at the next one, meet the other one? */
static bool meets(const ff_sight_track *seen, int32_t knot, const ff_knot *p, const ff_knot *q, float radius,
                  float margin, const ff_limits *limits)
{
    float r0, r1;
    const ff_knot *y0 = track_knot(seen, knot, &r0), *y1 = track_knot(seen, knot + 1, &r1);
    float theirs = r0 > r1 ? r0 : r1, reach = radius + theirs + margin;
    return ff_roots_near(p, q, y0, y1, seen->a, seen->b, reach) &&
           ff_bodies_hit(p, q, y0, y1, seen->a, seen->b, radius, theirs, limits);
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

/* Colliders in S0, in their place. */
static void put(const ff_knot *local, const float anchor[2], float c, float s, ff_knot *restrict out)
{
#ifdef __SSE2__
    const __m128 cosine = _mm_set1_ps(c), sine = _mm_set1_ps(s);
    const __m128 at_a = _mm_set1_ps(anchor[0]), at_b = _mm_set1_ps(anchor[1]);
    for (int i = 0; i <= FF_TRACK_LANES - 4; i += FF_TRACK_LANES - 4) { /* the middle ones twice */
        __m128 a = _mm_loadu_ps(local->a + i), b = _mm_loadu_ps(local->b + i);
        __m128 x = _mm_add_ps(at_a, _mm_mul_ps(cosine, a)), y = _mm_add_ps(at_b, _mm_mul_ps(sine, a));
        _mm_storeu_ps(out->a + i, _mm_sub_ps(x, _mm_mul_ps(sine, b)));
        _mm_storeu_ps(out->b + i, _mm_add_ps(y, _mm_mul_ps(cosine, b)));
    }
#else
    for (int i = 0; i < FF_TRACK_LANES; ++i) {
        out->a[i] = anchor[0] + c * local->a[i] - s * local->b[i];
        out->b[i] = anchor[1] + s * local->a[i] + c * local->b[i];
    }
#endif
    memcpy(out->y, local->y, sizeof out->y);
}

/* An action's colliders at t seconds in its place, without what joins it to the one before. */
static void place(const ff_action_set *set, const ff_set_action *action, const float anchor[2], float c,
                  float s, float t, ff_knot *restrict out)
{
    ff_knot local;
    ff_set_sample(set, action, t, &local);
    put(&local, anchor, c, s, out);
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
    ff_vec2 root = ff_add2(sight->origin, ff_v2((double)ra, (double)rb));
    st->solids = sight->shape_count > 0 || ff_solids_near(sight->solids, root, (double)reach);
}

/* A successor, in its place. Where its root gets to is worked out at once, all else where somebody is near. */
typedef struct course {
    const ff_stance *stance;
    const ff_set_action *action;
    const float *anchor;
    float a, b, radius; /* m: circle that holds all of it */
    int32_t last;       /* knot, not after its end */
    uint32_t total;     /* knots */
    bool begun;         /* roots are there */
    uint64_t made;      /* bit k: knots[k] is there */
    const ff_joint *joint;
    float root_a[FF_SIGHT_KNOTS + 4], root_b[FF_SIGHT_KNOTS + 4]; /* [0] is the stance's tail */
    float about[FF_SIGHT_KNOTS + 4]; /* radii about it, that hold all colliders */
    ff_knot knots[FF_SIGHT_KNOTS];
} course;

/* s into the action at a knot of its course. */
static float time_at(const course *c, uint32_t knot)
{
    return (float)(c->stance->knot + (int32_t)knot) * (float)FF_TRACK_STEP - c->stance->time;
}

/* The root at all knots, and at four more the last one again, as four are looked at at a time. */
static void begin_course(const ff_sight *sight, course *c)
{
    const ff_stance *st = c->stance;
    c->begun = true;
    c->made = 1;
    c->knots[0] = st->tail;
    c->root_a[0] = st->tail.a[FF_COLLIDER_ROOT];
    c->root_b[0] = st->tail.b[FF_COLLIDER_ROOT];
    c->about[0] = st->about;
    for (uint32_t k = 1; k < c->total; ++k) {
        float t = time_at(c, k), move[2];
        ff_set_root root = ff_set_root_at(sight->set, c->action, t);
        if (t < c->joint->over) {
            ff_joint_move(c->joint, t, move);
            root.a += move[0];
            root.b += move[1];
            root.about += ff_joint_about(c->joint, t);
        }
        c->root_a[k] = c->anchor[0] + st->cosine * root.a - st->sine * root.b;
        c->root_b[k] = c->anchor[1] + st->sine * root.a + st->cosine * root.b;
        c->about[k] = root.about;
    }
    for (uint32_t k = c->total; k < c->total + 4; ++k) {
        c->root_a[k] = c->root_a[k - 1];
        c->root_b[k] = c->root_b[k - 1];
        c->about[k] = c->about[k - 1];
    }
}

/* All colliders at a knot. */
static const ff_knot *course_knot(const ff_sight *sight, course *c, uint32_t k)
{
    ff_knot *to = &c->knots[k];
    if (c->made >> k & 1u) return to;
    c->made |= (uint64_t)1 << k;
    float t = time_at(c, k);
    ff_knot local, joined;
    ff_set_sample(sight->set, c->action, t, &local);
    if (t < c->joint->over) {
        ff_joint_add(c->joint, t, &local, &joined);
        local = joined;
    }
    put(&local, c->anchor, c->stance->cosine, c->stance->sine, to);
    return to;
}

static void make_course(const ff_sight *sight, course *c)
{
    if (!c->begun) begin_course(sight, c);
    for (uint32_t k = 0; k < c->total; ++k)
        course_knot(sight, c, k);
}

/* The path of one that is seen, made when it is first asked for. */
static const ff_sight_path *path_of(ff_sight *sight, uint32_t who)
{
    ff_sight_path *path = &sight->path[who];
    if (sight->pathed[who]) return path;
    sight->pathed[who] = true;
    const ff_sight_track *seen = &sight->seen[who];
    float before = 0.0f;
    for (int32_t k = FF_SIGHT_PATH - 1; k >= 0; --k) {
        float radius;
        const ff_knot *y = track_knot(seen, k, &radius);
        path->a[k] = y->a[FF_COLLIDER_ROOT] + seen->a;
        path->b[k] = y->b[FF_COLLIDER_ROOT] + seen->b;
        path->radius[k] = radius > before ? radius : before;
        before = radius;
    }
    return path;
}

/* Bit k: between knots k and k + 1 of the course its root comes so near to a path, of which i is the knot of k = 0, that the bodies may meet.
 * square[k]: how near, m2. */
static uint64_t near_path(const course *c, const ff_sight_path *path, uint32_t i, float margin,
                          float square[FF_SIGHT_KNOTS + 4])
{
    uint64_t near = 0;
    for (uint32_t k = 0; k + 1 < c->total; k += 4) {
#ifdef __SSE2__
        const __m128 zero = _mm_setzero_ps(), one = _mm_set1_ps(1.0f), tiny = _mm_set1_ps(1e-12f);
        __m128 pa = _mm_sub_ps(_mm_loadu_ps(path->a + i + k), _mm_loadu_ps(c->root_a + k));
        __m128 pb = _mm_sub_ps(_mm_loadu_ps(path->b + i + k), _mm_loadu_ps(c->root_b + k));
        __m128 da =
            _mm_sub_ps(_mm_sub_ps(_mm_loadu_ps(path->a + i + k + 1), _mm_loadu_ps(c->root_a + k + 1)), pa);
        __m128 db =
            _mm_sub_ps(_mm_sub_ps(_mm_loadu_ps(path->b + i + k + 1), _mm_loadu_ps(c->root_b + k + 1)), pb);
        __m128 dd = _mm_add_ps(_mm_mul_ps(da, da), _mm_mul_ps(db, db));
        __m128 t = _mm_sub_ps(zero, _mm_add_ps(_mm_mul_ps(pa, da), _mm_mul_ps(pb, db)));
        t = _mm_and_ps(_mm_div_ps(t, _mm_max_ps(dd, tiny)), _mm_cmpgt_ps(dd, tiny));
        t = _mm_min_ps(_mm_max_ps(t, zero), one);
        pa = _mm_add_ps(pa, _mm_mul_ps(t, da));
        pb = _mm_add_ps(pb, _mm_mul_ps(t, db));
        __m128 most = _mm_max_ps(_mm_loadu_ps(c->about + k), _mm_loadu_ps(c->about + k + 1));
        most = _mm_add_ps(_mm_add_ps(most, _mm_loadu_ps(path->radius + i + k)), _mm_set1_ps(margin));
        __m128 far = _mm_add_ps(_mm_mul_ps(pa, pa), _mm_mul_ps(pb, pb));
        _mm_storeu_ps(square + k, far);
        near |= (uint64_t)(unsigned)_mm_movemask_ps(_mm_cmple_ps(far, _mm_mul_ps(most, most))) << k;
#else
        for (uint32_t m = k; m < k + 4; ++m) {
            float pa = path->a[i + m] - c->root_a[m], pb = path->b[i + m] - c->root_b[m];
            float da = (path->a[i + m + 1] - c->root_a[m + 1]) - pa;
            float db = (path->b[i + m + 1] - c->root_b[m + 1]) - pb;
            float about = c->about[m] > c->about[m + 1] ? c->about[m] : c->about[m + 1];
            float most = about + path->radius[i + m] + margin;
            square[m] = ff_nearest_pass(pa, pb, da, db);
            if (square[m] <= most * most) near |= (uint64_t)1 << m;
        }
#endif
    }
    return near & (((uint64_t)1 << (c->total - 1)) - 1u);
}

/* Do the bodies meet between a knot of the course and the next? */
static bool bodies_meet(ff_sight *sight, course *c, uint32_t who, uint32_t k)
{
    float r0, r1, mine = c->about[k] > c->about[k + 1] ? c->about[k] : c->about[k + 1];
    const ff_sight_track *seen = &sight->seen[who];
    const ff_knot *x0 = course_knot(sight, c, k), *x1 = course_knot(sight, c, k + 1);
    const ff_knot *y0 = track_knot(seen, c->stance->knot + (int32_t)k, &r0);
    const ff_knot *y1 = track_knot(seen, c->stance->knot + (int32_t)k + 1, &r1);
    return ff_bodies_hit(x0, x1, y0, y1, seen->a, seen->b, mine, r0 > r1 ? r0 : r1, &sight->limits);
}

/* One who is near: between which knots. */
typedef struct encounter {
    uint64_t near;
    uint32_t who, place; /* the place-th of the stance's near ones */
    uint32_t nearest;    /* the knot after which the roots are */
} encounter;

/* Does its root come near? *touch: it meets the other root, and that is all there is to know. */
static bool comes_near(ff_sight *sight, course *c, uint32_t who, encounter *out, bool *touch)
{
    const ff_stance *st = c->stance;
    *touch = false;
    if (!ff_sight_room_near(&sight->seen[who], ff_sight_chunk(sight, st->knot),
                            ff_sight_chunk(sight, c->last), c->a, c->b, c->radius))
        return false;
    if (!c->begun) begin_course(sight, c);
    uint32_t from = st->knot < FF_TRACK_KNOTS_MAX ? (uint32_t)st->knot : FF_TRACK_KNOTS_MAX;
    float square[FF_SIGHT_KNOTS + 4], least = INFINITY;
    out->who = who;
    out->near = near_path(c, path_of(sight, who), from, sight->margin, square);
    if (!out->near) return false;
    for (uint32_t k = 0; k + 1 < c->total; ++k)
        if (square[k] < least) {
            out->nearest = k;
            least = square[k];
        }
    *touch = least <= sight->limits.squared[FF_COLLIDER_ROOT][FF_COLLIDER_ROOT] &&
             bodies_meet(sight, c, who, out->nearest);
    return true;
}

/* Do the bodies meet? Where they are nearest they meet first. */
static bool bodies_touch(ff_sight *sight, course *c, const encounter *e)
{
    uint64_t near = e->near;
    if ((near >> e->nearest & 1u) && bodies_meet(sight, c, e->who, e->nearest)) return true;
    near &= ~((uint64_t)1 << e->nearest);
    for (uint32_t k = 0; near >> k; ++k)
        if ((near >> k & 1u) && bodies_meet(sight, c, e->who, k)) return true;
    return false;
}

/* Is somebody of the near ones met? Roots first, all of them: they tell soonest, and of most. */
static bool meets_somebody(ff_sight *sight, course *c, ff_stance *st)
{
    encounter list[FF_SIGHT_MAX];
    uint32_t count = 0, met = FF_SIGHT_MAX;
    bool touch;
    if (c->total < 2) return false;
    for (uint32_t i = 0; i < st->near_count && met == FF_SIGHT_MAX; ++i) {
        if (!comes_near(sight, c, st->near[i], &list[count], &touch)) continue;
        if (touch)
            met = i;
        else
            list[count++].place = i;
    }
    for (uint32_t i = 0; i < count && met == FF_SIGHT_MAX; ++i)
        if (bodies_touch(sight, c, &list[i])) met = list[i].place;
    if (met == FF_SIGHT_MAX) return false;
    /* Who is in the way of one action is in the way of others: looked at first from now on. */
    uint8_t who = st->near[met];
    st->near[met] = st->near[0];
    st->near[0] = who;
    return true;
}

/* Does the course touch what does not move, or moves on known paths? */
static bool meets_things(const ff_sight *sight, course *c)
{
    const ff_stance *st = c->stance;
    double margin = (double)sight->margin;
    if (st->mover_count == 0 && !st->solids) return false;
    make_course(sight, c);
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
static float proximity_cost(const ff_sight *sight, course *c)
{
    const ff_stance *st = c->stance;
    float sum = 0.0f, within = sight->cost_within + 2.0f * sight->set->radii[FF_COLLIDER_ROOT];
    if (st->near_count > 0) make_course(sight, c);
    for (uint32_t i = 0; i < st->near_count; ++i) {
        const ff_sight_track *seen = &sight->seen[st->near[i]];
        for (uint32_t k = 1; k < c->total; ++k) {
            float radius;
            const ff_knot *y = track_knot(seen, st->knot + (int32_t)k, &radius);
            float a = y->a[FF_COLLIDER_ROOT] + seen->a - c->knots[k].a[FF_COLLIDER_ROOT];
            float b = y->b[FF_COLLIDER_ROOT] + seen->b - c->knots[k].b[FF_COLLIDER_ROOT];
            if (a * a + b * b < within * within) sum += sight->cost * (float)FF_TRACK_STEP;
        }
    }
    return sum;
}

/* From the stance's tail to a last knot. */
static uint32_t knots_to(const ff_stance *st, int32_t last)
{
    uint32_t more = last > st->knot ? (uint32_t)(last - st->knot) : 0;
    return 1 + (more < FF_SIGHT_KNOTS - 1 ? more : FF_SIGHT_KNOTS - 1);
}

bool ff_stance_free(ff_sight *sight, ff_stance *st, const ff_set_next *next, float *cost)
{
    if (cost) *cost = 0.0f;
    if (st->near_count == 0 && st->mover_count == 0 && !st->solids) return true;
    const ff_set_action *b = &sight->set->actions[next->action];
    course c;
    c.stance = st;
    c.action = b;
    c.anchor = next->other ? st->other : st->at;
    c.joint = &sight->set->joints[next - sight->set->next];
    c.last = (int32_t)((st->time + b->duration) / (float)FF_TRACK_STEP);
    c.total = knots_to(st, c.last);
    c.begun = false;
    c.made = 0;
    c.a = c.anchor[0] + st->cosine * b->circle[0] - st->sine * b->circle[1];
    c.b = c.anchor[1] + st->sine * b->circle[0] + st->cosine * b->circle[1];
    c.radius = b->circle[2] + next->jump + st->moved + sight->margin;
    if (meets_somebody(sight, &c, st)) return false;
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

/* Up to which knot standing for ever has to be free of a mover: what can be jumped or ducked is, when it comes near. Else nobody
 * would go where a beam passes some day. */
static int32_t stands_until(const ff_sight_mover *mover, const ff_stance *st, int32_t last)
{
    const int32_t ready = (int32_t)(2.0 / FF_TRACK_STEP);
    return mover->evaded && st->knot + ready < last ? st->knot + ready : last;
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
        for (int32_t k = st->knot; k < (ever ? stands_until(&sight->mover[i], st, last) : last); ++k)
            if (meets_mover(&sight->mover[i], k, k == st->knot ? &st->tail : &st->end, &st->end, radii,
                            (double)sight->margin))
                return false;
    return true;
}
