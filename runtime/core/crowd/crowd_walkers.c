/* crowd_walkers.c - how searches see those who go by velocity: bodies longer than wide, that go where their glides lead (crowd_glides.c)
 * and stand there, with room that grows. They keep off plans, which they know (nav_path.h): this is to leave them room to do so. */
#include "runtime/core/crowd/crowd_state.h"
#include "runtime/core/plan/plan_set.h"

#define WIDE 0.33   /* m from the root, the planner's margin not counted: elbows and hands */
#define STRIDE 0.2  /* m more before and behind, of who walks briskly */
#define BRISK 1.2   /* m/s */
#define GROW 0.08   /* m/s */
#define SEEN 2.5    /* s, for which one goes on at most before it stands, braking included */
#define AHEAD 5.5   /* s, that plans reach ahead */
#define PLANNER 1.7 /* m/s, of those who plan, at the most */
#define BODIES 1.5  /* m: two bodies and some */
#define LEAST 0.1   /* m, of somebody however near */
#define TOUCH 5e-3  /* m */

enum { MOST = 48 }; /* of them, the nearest */

static double reach_of(const ff_seen *other)
{
    return BODIES + SEEN * ff_length2(other->reference) + AHEAD * PLANNER;
}

static double beside(ff_vec2 p, const ff_walker *w, ff_vec2 at)
{
    ff_vec2 ahead = ff_unit2(w->velocity), x = ff_sub2(p, at);
    double along = ff_clamp(ff_dot2(ahead, x), -w->half_length, w->half_length);
    return ff_length2(ff_madd2(x, ahead, -along));
}

/* m between the body at a knot and the middle line of a walker. */
static double room_at(const ff_track *track, const float *radii, int64_t knot, const ff_walker *w, ff_vec2 at)
{
    int64_t k = knot - track->first, last = (int64_t)track->count - 1;
    const ff_knot *body = &track->knots[k < 0 ? 0 : (k > last ? last : k)];
    double least = INFINITY;
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i) {
        ff_vec2 p = ff_add2(track->origin, ff_v2((double)body->a[i], (double)body->b[i]));
        least = ff_min(least, beside(p, w, at) - (double)radii[i]);
    }
    return least;
}

/* Who is nearer already is in the way no more than that; nor, for a while, is who cannot be avoided before the present step
 * is over. Else who stands close to somebody would find no way at all. */
static void leave_what_is(const ff_crowd *crowd, uint32_t slot, double time, ff_walker *w)
{
    const ff_stepper *s = &crowd->steppers[slot];
    bool moves = s->at + 1 < s->plan.count && !s->plan.steps[s->at].hold;
    double end = (moves ? s->plan.steps[s->at + 1].start : time) + FF_TRACK_STEP;
    int64_t first = (int64_t)floor(time / FF_TRACK_STEP);
    for (int64_t k = first; k == first || (double)k * FF_TRACK_STEP <= end; ++k) {
        double later = ff_max((double)k * FF_TRACK_STEP - time, 0.0);
        double room = room_at(&s->track, crowd->footsteps->actions->radii, k, w,
                              ff_madd2(w->position, w->velocity, later)) -
                      TOUCH;
        double kept = room - crowd->def.footsteps.margin - w->grow * later;
        w->radius = ff_max(ff_min(w->radius, kept), LEAST);
    }
}

ff_walker ff_walker_of(const ff_crowd *crowd, uint32_t slot, const ff_seen *other, double time)
{
    double brisk = ff_min(ff_length2(other->reference) / BRISK, 1.0);
    const ff_glide *glide = &crowd->footsteps->glides[other->slot];
    ff_walker w = {.position = other->position,
                   .velocity = other->reference,
                   .wide = WIDE,
                   .radius = WIDE,
                   .half_length = STRIDE * brisk,
                   .grow = GROW,
                   .until = INFINITY,
                   .path_a = glide->a,
                   .path_b = glide->b,
                   .path_count = FF_GLIDE_POINTS};
    if (ff_is_stepper(crowd, slot)) leave_what_is(crowd, slot, time, &w);
    return w;
}

void ff_walkers_see(const ff_crowd *crowd, uint32_t slot, ff_plan_lane *lane, ff_plan_world *world)
{
    double distance[MOST], time = ff_crowd_time(crowd);
    uint32_t count = 0;
    ff_vec2 here = crowd->bodies[slot].position;
    bool nobody = crowd->stepper_count == crowd->agent_count;
    for (uint32_t i = 0; i < crowd->grid.count && !nobody; ++i) {
        const ff_seen *other = &crowd->grid.seen[i];
        double far = ff_length2(ff_sub2(other->position, here));
        if (other->slot == slot || other->firm || far > reach_of(other) ||
            (count == MOST && far >= distance[MOST - 1]))
            continue;
        uint32_t at = count < MOST ? count++ : MOST - 1;
        for (; at > 0 && far < distance[at - 1]; --at) {
            distance[at] = distance[at - 1];
            lane->walkers[at] = lane->walkers[at - 1];
        }
        distance[at] = far;
        lane->walkers[at] = ff_walker_of(crowd, slot, other, time);
    }
    world->walkers = lane->walkers;
    world->walker_count = count;
}

void ff_walkers_believe(ff_plan_lane *lane, const ff_plan_world *world)
{
    for (uint32_t i = 0; i < world->walker_count; ++i)
        lane->walkers[i].grow = 0.0;
}
