/* Where an action takes the body, and whom it meets there: plan_course.h. */
#include "runtime/core/plan/plan_course.h"

/* s into the action at a knot of its course. */
static float time_at(const ff_course *c, uint32_t knot)
{
    return (float)(c->stance->knot + (int32_t)knot) * (float)FF_TRACK_STEP - c->stance->time;
}

/* From the stance's tail to a last knot. */
static uint32_t knots_to(const ff_stance *st, int32_t last)
{
    uint32_t more = last > st->knot ? (uint32_t)(last - st->knot) : 0;
    return 1 + (more < FF_SIGHT_KNOTS - 1 ? more : FF_SIGHT_KNOTS - 1);
}

void ff_course_begin(const ff_sight *sight, const ff_stance *st, const ff_set_next *next, ff_course *c)
{
    const ff_set_action *b = &sight->set->actions[next->action];
    c->stance = st;
    c->action = b;
    c->anchor = next->other ? st->other : st->at;
    c->joint = &sight->set->joints[next - sight->set->next];
    c->last = (int32_t)((st->time + b->duration) / (float)FF_TRACK_STEP);
    c->total = knots_to(st, c->last);
    c->a = c->anchor[0] + st->cosine * b->circle[0] - st->sine * b->circle[1];
    c->b = c->anchor[1] + st->sine * b->circle[0] + st->cosine * b->circle[1];
    c->radius = b->circle[2] + next->jump + st->moved + sight->margin;
    c->rooted = false;
    c->made = 1;
    c->knots[0] = st->tail;
}

/* The root at all knots, and at four more the last one again, as four are looked at at a time. */
static void find_roots(const ff_action_set *set, ff_course *c)
{
    const ff_stance *st = c->stance;
    c->rooted = true;
    c->root_a[0] = st->tail.a[FF_COLLIDER_ROOT];
    c->root_b[0] = st->tail.b[FF_COLLIDER_ROOT];
    c->about[0] = st->about;
    for (uint32_t k = 1; k < c->total; ++k) {
        float t = time_at(c, k), move[2];
        ff_set_root root = ff_set_root_at(set, c->action, t);
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
static const ff_knot *course_knot(const ff_sight *sight, ff_course *c, uint32_t k)
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
    ff_set_put(&local, c->anchor, c->stance->cosine, c->stance->sine, to);
    return to;
}

/* One collider at a knot: a, b, y. */
static void course_collider(const ff_sight *sight, const ff_course *c, uint32_t k, int i, float out[3])
{
    if (c->made >> k & 1u) {
        out[0] = c->knots[k].a[i];
        out[1] = c->knots[k].b[i];
        out[2] = c->knots[k].y[i];
        return;
    }
    float t = time_at(c, k), local[3], cosine = c->stance->cosine, sine = c->stance->sine;
    ff_set_sample_one(sight->set, c->action, t, i, local);
    if (t < c->joint->over) ff_joint_add_one(c->joint, t, i, local);
    out[0] = c->anchor[0] + cosine * local[0] - sine * local[1];
    out[1] = c->anchor[1] + sine * local[0] + cosine * local[1];
    out[2] = local[2];
}

void ff_course_make(const ff_sight *sight, ff_course *c)
{
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
        const ff_knot *y = ff_sight_knot(seen, k, &radius);
        path->a[k] = y->a[FF_COLLIDER_ROOT] + seen->a;
        path->b[k] = y->b[FF_COLLIDER_ROOT] + seen->b;
        path->radius[k] = radius > before ? radius : before;
        before = radius;
    }
    return path;
}

/* Bit k: between knots k and k + 1 of the course its root comes so near to a path, of which i is the knot of k = 0, that the bodies may meet.
 * square[k]: how near, m2. */
static uint64_t near_path(const ff_course *c, const ff_sight_path *path, uint32_t i, float margin,
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

/* Do the bodies meet between a knot of the course and the next? *with: where, if they do. */
static bool bodies_meet(const ff_sight *sight, ff_course *c, uint32_t who, uint32_t k, ff_meeting *with)
{
    float r0, r1, mine = c->about[k] > c->about[k + 1] ? c->about[k] : c->about[k + 1];
    const ff_sight_track *seen = &sight->seen[who];
    const ff_knot *x0 = course_knot(sight, c, k), *x1 = course_knot(sight, c, k + 1);
    with->who = (uint16_t)who;
    with->knot = c->stance->knot + (int32_t)k;
    const ff_knot *y0 = ff_sight_knot(seen, with->knot, &r0), *y1 = ff_sight_knot(seen, with->knot + 1, &r1);
    return ff_bodies_hit(x0, x1, y0, y1, seen->a, seen->b, mine, r0 > r1 ? r0 : r1, &sight->limits,
                         &with->touch);
}

/* One who is near: between which knots. */
typedef struct encounter {
    uint64_t near;
    uint32_t who, place; /* the place-th of the stance's near ones */
    uint32_t nearest;    /* the knot after which the roots are */
} encounter;

/* Does its root come near? *touch: it meets the other root, and that is all there is to know. */
static bool comes_near(ff_sight *sight, ff_course *c, uint32_t who, encounter *out, bool *touch,
                       ff_meeting *with)
{
    const ff_stance *st = c->stance;
    *touch = false;
    if (!c->rooted) find_roots(sight->set, c);
    uint32_t from = st->knot < FF_TRACK_KNOTS_MAX ? (uint32_t)st->knot : FF_TRACK_KNOTS_MAX;
    float square[FF_SIGHT_KNOTS + 4], least = INFINITY;
    out->who = who;
    out->near = near_path(c, path_of(sight, who), from, sight->margin, square);
    if (!out->near) return false;
    for (uint32_t k = 0; out->near >> k; ++k)
        if ((out->near >> k & 1u) && square[k] < least) {
            out->nearest = k;
            least = square[k];
        }
    *touch = least <= sight->limits.squared[FF_COLLIDER_ROOT][FF_COLLIDER_ROOT] &&
             bodies_meet(sight, c, who, out->nearest, with);
    return true;
}

/* Do the bodies meet? Where they are nearest they meet first. */
static bool bodies_touch(ff_sight *sight, ff_course *c, const encounter *e, ff_meeting *with)
{
    uint64_t near = e->near;
    if ((near >> e->nearest & 1u) && bodies_meet(sight, c, e->who, e->nearest, with)) return true;
    near &= ~((uint64_t)1 << e->nearest);
    for (uint32_t k = 0; near >> k; ++k)
        if ((near >> k & 1u) && bodies_meet(sight, c, e->who, k, with)) return true;
    return false;
}

/* Do the same two colliders meet at the same moment on this course as well? */
static bool meets_again(const ff_sight *sight, const ff_course *c, const ff_meeting *met)
{
    int32_t k = met->knot - c->stance->knot;
    if (met->who >= sight->count || k < 0 || k + 1 >= (int32_t)c->total) return false;
    const ff_sight_track *seen = &sight->seen[met->who];
    float radius, x0[3], x1[3];
    course_collider(sight, c, (uint32_t)k, met->touch.mine, x0);
    course_collider(sight, c, (uint32_t)k + 1, met->touch.mine, x1);
    const ff_knot *y0 = ff_sight_knot(seen, met->knot, &radius),
                  *y1 = ff_sight_knot(seen, met->knot + 1, &radius);
    return ff_colliders_hit(met->touch, x0, x1, y0, y1, seen->a, seen->b, &sight->limits);
}

/* Puts a meeting before the others of a list, of which the last leaves. */
static void put_first(ff_meeting list[FF_MEETINGS], ff_meeting met, uint32_t last)
{
    for (uint32_t i = last; i > 0; --i)
        list[i] = list[i - 1];
    list[0] = met;
}

/* Where one action is in somebody's way the next one mostly is as well: is one of the last meetings one again? */
static bool meets_as_before(const ff_sight *sight, const ff_course *c, ff_stance *st)
{
    for (uint32_t i = 0; i < FF_MEETINGS; ++i)
        if (meets_again(sight, c, &st->met[i])) {
            put_first(st->met, st->met[i], i);
            return true;
        }
    return false;
}

/* Keeps a meeting, and looks at whom it was with first from now on. */
static void remember(ff_sight *sight, ff_stance *st, uint32_t place, ff_meeting met)
{
    uint8_t who = st->near[place];
    st->near[place] = st->near[0];
    st->near[0] = who;
    put_first(st->met, met, FF_MEETINGS - 1);
    put_first(sight->met, met, FF_MEETINGS - 1);
}

/* Is somebody of the near ones met? Roots first, all of them: they tell soonest, and of most. */
bool ff_course_meets(ff_sight *sight, ff_course *c, ff_stance *st)
{
    encounter list[FF_SIGHT_MAX];
    uint32_t count = 0;
    ff_meeting met;
    bool touch;
    if (c->total < 2) return false;
    if (meets_as_before(sight, c, st)) return true;
    for (uint32_t i = 0; i < st->near_count; ++i) {
        if (!comes_near(sight, c, st->near[i], &list[count], &touch, &met)) continue;
        if (touch) {
            remember(sight, st, i, met);
            return true;
        }
        list[count++].place = i;
    }
    for (uint32_t i = 0; i < count; ++i)
        if (bodies_touch(sight, c, &list[i], &met)) {
            remember(sight, st, list[i].place, met);
            return true;
        }
    return false;
}
