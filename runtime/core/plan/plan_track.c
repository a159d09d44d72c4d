/* Where a plan's owner is, and whether two meet: plans, colliders and tracks of plan.h. */
#include "runtime/core/plan/plan_hit.h"
#include "runtime/core/plan/plan_joint.h"
#include "runtime/core/plan/plan_set.h"

#include <string.h>

static const float ROUNDING = 1e-4f; /* m, more than it comes to */

/* ----------------------------------------------------------------------------------------------------- steps */

static ff_vec2 from_step(const ff_plan_step *step, double a, double b)
{
    return ff_add2(step->anchor, ff_from_frame2(ff_fwd2(step->heading), ff_v2(a, b)));
}

void ff_plan_stand(const ff_action_set *set, ff_vec2 position, double heading, double time, ff_plan *out)
{
    const ff_set_action *stand = &set->actions[set->stand];
    ff_plan_step step = {
        .heading = heading - (double)stand->theta, .start = time, .action = set->stand, .hold = 1};
    ff_vec2 root = ff_v2((double)stand->root_end[0], (double)stand->root_end[1]);
    step.anchor = ff_sub2(position, ff_from_frame2(ff_fwd2(step.heading), root));
    memset(out, 0, sizeof *out);
    out->steps[0] = out->from = step;
    out->count = 1;
    out->own = out->stop = 0;
}

uint32_t ff_plan_step_at(const ff_plan *plan, double time)
{
    uint32_t i = 0;
    while (i + 1 < plan->count && plan->steps[i + 1].start <= time)
        ++i;
    return i;
}

double ff_plan_step_end(const ff_plan *plan, uint32_t step)
{
    return step + 1 < plan->count ? plan->steps[step + 1].start : INFINITY;
}

ff_footprint ff_plan_landing(const ff_action_set *set, const ff_plan_step *step)
{
    const ff_pack_action *r = ff_action_set_record(set, step->action);
    return (ff_footprint){from_step(step, (double)r->land[0], (double)r->land[1]),
                          step->heading + (double)r->land[2]};
}

ff_root_frame ff_plan_root_at(const ff_action_set *set, const ff_plan *plan, double time)
{
    const ff_plan_step *step = &plan->steps[ff_plan_step_at(plan, time)];
    const ff_set_action *a = &set->actions[step->action];
    double share = step->hold ? 1.0 : ff_clamp((time - step->start) / (double)a->duration, 0.0, 1.0);
    ff_knot at;
    ff_set_sample(set, a, (float)(share * (double)a->duration), &at);
    return (ff_root_frame){from_step(step, (double)at.a[FF_COLLIDER_ROOT], (double)at.b[FF_COLLIDER_ROOT]),
                           step->heading + share * (double)a->theta};
}

/* ------------------------------------------------------------------------------------------------- colliders */

typedef struct placed {
    double a[FF_COLLIDER_COUNT], b[FF_COLLIDER_COUNT], y[FF_COLLIDER_COUNT];
} placed;

/* The colliders of a step at t seconds from its start, without its joint; at its end for t = INFINITY and for holds. */
static void place(const ff_action_set *set, const ff_plan_step *step, double t, placed *out)
{
    const ff_set_action *action = &set->actions[step->action];
    ff_knot local;
    ff_set_sample(set, action, step->hold ? action->duration : (float)ff_min(t, (double)action->duration),
                  &local);
    ff_vec2 axis = ff_fwd2(step->heading);
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i) {
        ff_vec2 at =
            ff_add2(step->anchor, ff_from_frame2(axis, ff_v2((double)local.a[i], (double)local.b[i])));
        out->a[i] = at.a;
        out->b[i] = at.b;
        out->y[i] = (double)local.y[i];
    }
}

static void colliders_at(const ff_action_set *set, const ff_plan *plan, uint32_t index, double time,
                         placed *out)
{
    const ff_plan_step *step = &plan->steps[index];
    double t = ff_max(time - step->start, 0.0);
    place(set, step, t, out);
    if (step->hold) return;
    const ff_plan_step *last = index > 0 ? &plan->steps[index - 1] : &plan->from;
    bool stood = last->hold || set->actions[last->action].flags & FF_SET_TO_STANDING;
    ff_vec2 axis = ff_fwd2(step->heading), turned = ff_fwd2(step->heading - last->heading);
    const float turn[2] = {(float)turned.a, (float)turned.b};
    placed before, begin;
    ff_knot jump, moved, none = {.a = {0.0f}};
    ff_joint joint;
    place(set, last, INFINITY, &before);
    place(set, step, 0.0, &begin);
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i) {
        ff_vec2 off = ff_to_frame2(axis, ff_v2(before.a[i] - begin.a[i], before.b[i] - begin.b[i]));
        jump.a[i] = (float)off.a;
        jump.b[i] = (float)off.b;
        jump.y[i] = (float)(before.y[i] - begin.y[i]);
    }
    ff_joint_make(stood ? NULL : &set->ends[last->action], turn, &set->ends[step->action], &jump, &joint);
    const ff_joint *known = ff_set_joint(set, last->action, step->action);
    if (known) {
        memcpy(joint.arc_a, known->arc_a, sizeof joint.arc_a);
        memcpy(joint.arc_b, known->arc_b, sizeof joint.arc_b);
    }
    ff_joint_add(&joint, (float)t, &none, &moved);
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i) {
        ff_vec2 move = ff_from_frame2(axis, ff_v2((double)moved.a[i], (double)moved.b[i]));
        out->a[i] += move.a;
        out->b[i] += move.b;
        out->y[i] += (double)moved.y[i];
    }
}

void ff_plan_colliders(const ff_action_set *set, const ff_plan *plan, double time,
                       ff_vec3 out[FF_COLLIDER_COUNT])
{
    placed at;
    colliders_at(set, plan, ff_plan_step_at(plan, time), time, &at);
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i)
        out[i] = ff_v3(at.a[i], at.b[i], at.y[i]);
}

/* ---------------------------------------------------------------------------------------------------- tracks */

static float low_of(float x, float y)
{
    return x < y ? x : y;
}

static float high_of(float x, float y)
{
    return x > y ? x : y;
}

/* Room of each chunk: knots at both of its ends belong to it. */
static void find_rooms(ff_track *track)
{
    int64_t begin =
        ff_knot_chunk(track->first) * FF_TRACK_CHUNK - track->first; /* <= 0: of the first chunk */
    for (uint32_t c = 0; c < ff_track_rooms(track); ++c) {
        ff_track_room room = {INFINITY, INFINITY, -INFINITY, -INFINITY};
        for (uint32_t i = 0; i <= FF_TRACK_CHUNK; ++i) {
            int64_t k = begin + (int64_t)(c * FF_TRACK_CHUNK + i), last = (int64_t)track->count - 1;
            k = k < 0 ? 0 : (k > last ? last : k);
            float a = track->knots[k].a[FF_COLLIDER_ROOT], b = track->knots[k].b[FF_COLLIDER_ROOT],
                  r = track->radius[k];
            room.low_a = low_of(room.low_a, a - r), room.high_a = high_of(room.high_a, a + r);
            room.low_b = low_of(room.low_b, b - r), room.high_b = high_of(room.high_b, b + r);
        }
        track->room[c] = room;
    }
}

void ff_plan_track(const ff_action_set *set, const ff_plan *plan, double from, ff_track *out)
{
    memset(out, 0, sizeof *out);
    out->origin = plan->steps[ff_plan_step_at(plan, from)].anchor;
    out->first = (int64_t)floor(from / FF_TRACK_STEP);
    memcpy(out->radii, set->radii, sizeof out->radii);
    double stands = plan->steps[plan->count - 1].start;
    uint32_t step = 0;
    do {
        double time = (double)(out->first + (int64_t)out->count) * FF_TRACK_STEP;
        while (step + 1 < plan->count && plan->steps[step + 1].start <= time)
            ++step;
        placed at;
        colliders_at(set, plan, step, time, &at);
        ff_knot *knot = &out->knots[out->count];
        for (int i = 0; i < FF_COLLIDER_COUNT; ++i) {
            knot->a[i] = (float)(at.a[i] - out->origin.a);
            knot->b[i] = (float)(at.b[i] - out->origin.b);
            knot->y[i] = (float)at.y[i];
        }
        out->radius[out->count++] = ff_knot_radius(knot, set->radii);
        if (time >= stands) break;
    } while (out->count < FF_TRACK_KNOTS_MAX);
    find_rooms(out);
}

static const ff_knot *knot_at(const ff_track *track, int64_t number, float *radius)
{
    int64_t k = number - track->first;
    k = k < 0 ? 0 : (k >= (int64_t)track->count ? (int64_t)track->count - 1 : k);
    *radius = track->radius[k];
    return &track->knots[k];
}

/* Do they take up room within margin of each other in the chunk that a knot is in? */
static bool rooms_near(const ff_track *x, const ff_track *y, int64_t knot, ff_vec2 apart, float margin)
{
    int64_t chunk = ff_knot_chunk(knot), i = chunk - ff_knot_chunk(x->first),
            k = chunk - ff_knot_chunk(y->first);
    int64_t last_x = (int64_t)ff_track_rooms(x) - 1, last_y = (int64_t)ff_track_rooms(y) - 1;
    const ff_track_room *p = &x->room[i < 0 ? 0 : (i > last_x ? last_x : i)];
    const ff_track_room *q = &y->room[k < 0 ? 0 : (k > last_y ? last_y : k)];
    float a = (float)apart.a, b = (float)apart.b;
    return q->low_a + a <= p->high_a + margin && p->low_a <= q->high_a + a + margin &&
           q->low_b + b <= p->high_b + margin && p->low_b <= q->high_b + b + margin;
}

bool ff_track_conflict(const ff_track *x, const ff_track *y, double from, double margin, double *when)
{
    ff_limits limits = ff_limits_of(x->radii, y->radii, (float)margin);
    ff_vec2 apart = ff_sub2(y->origin, x->origin);
    int64_t last_x = x->first + (int64_t)x->count - 1, last_y = y->first + (int64_t)y->count - 1;
    int64_t last = last_x > last_y ? last_x : last_y;
    int64_t k = (int64_t)floor(from / FF_TRACK_STEP);
    float rx[2], ry[2];
    /* At least once, for two that only stand. */
    do {
        if (!rooms_near(x, y, k, apart, (float)margin + ROUNDING)) {
            k = (ff_knot_chunk(k) + 1) * FF_TRACK_CHUNK - 1; /* the next chunk */
            continue;
        }
        const ff_knot *x0 = knot_at(x, k, &rx[0]), *x1 = knot_at(x, k + 1, &rx[1]);
        const ff_knot *y0 = knot_at(y, k, &ry[0]), *y1 = knot_at(y, k + 1, &ry[1]);
        float mine = high_of(rx[0], rx[1]), theirs = high_of(ry[0], ry[1]),
              reach = mine + theirs + (float)margin;
        if (ff_roots_near(x0, x1, y0, y1, (float)apart.a, (float)apart.b, reach) &&
            ff_bodies_hit(x0, x1, y0, y1, (float)apart.a, (float)apart.b, mine, theirs, &limits, NULL)) {
            if (when) *when = (double)k * FF_TRACK_STEP;
            return true;
        }
    } while (++k < last);
    return false;
}
