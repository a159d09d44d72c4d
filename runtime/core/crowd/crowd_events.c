/* crowd_events.c - the events monitor: who needs a new plan, and why (Beacco et al. 2013, 3.1; algorithms B.8). */
#include "runtime/core/crowd/crowd_footsteps.h"
#include "runtime/core/crowd/crowd_state.h"

#define GOAL_MOVED 0.2     /* m, algorithms B.8 */
#define TURNED_AWAY 0.35   /* rad, from what one shall look at */
#define WAYPOINT_NEAR 0.6  /* m, within which a waypoint counts as passed (B.3) */
#define WAYPOINT_WIDTH 0.3 /* m, half of the way on which the next one is seen (B.7) */
#define FORESEEN 2.0       /* s, in which obstacles on paths are looked for */
#define IMMINENT 1.0       /* s, the same of what is not to be foreseen (B.8) */
#define SETTLED 0.2        /* s, for which those who go by velocity are given time to see a new plan */
#define DANGER 1.5 /* s: the feet of a jump leave the ground after 0.5 s, once the step before is over */

static void call_for(ff_stepper *s, ff_plan_event event, double time)
{
    if (s->pending == 0) s->asked = time;
    if (!(s->pending >> event & 1u)) ++s->counts.events[event];
    s->pending |= 1u << event;
}

/* Waypoints are left behind when they are reached, or when a later one is seen (B.7). */
static void pass_waypoints(const ff_crowd *crowd, uint32_t slot, ff_stepper *s)
{
    if (s->waypoint_next >= s->waypoint_count) return;
    ff_vec2 way[FF_WAYPOINTS_MAX + 1], here = crowd->bodies[slot].position;
    for (uint32_t i = 0; i < s->waypoint_count; ++i)
        way[i] = s->waypoint[i];
    way[s->waypoint_count] = crowd->traits[slot].goal;
    if (ff_length2(ff_sub2(way[s->waypoint_next], here)) < WAYPOINT_NEAR) ++s->waypoint_next;
    s->waypoint_next = ff_waypoint_seen(crowd->footsteps->solids, way, s->waypoint_count + 1,
                                        s->waypoint_next, here, WAYPOINT_WIDTH);
}

/* A plan that came into force in the last step crosses this one. In the planner's own formulation that happens only where
 * somebody had to break off a step. */
static bool crossed(const ff_crowd *crowd, uint32_t slot, double time)
{
    const ff_footsteps *f = crowd->footsteps;
    const ff_stepper *s = &crowd->steppers[slot];
    for (uint32_t i = 0; i < f->changed_count; ++i) {
        const ff_stepper *other = &crowd->steppers[f->changed[i]];
        if (f->changed[i] == slot) continue;
        if (ff_bounds_meet(&f->bounds[slot], &f->bounds[f->changed[i]]) &&
            ff_track_conflict(&s->track, &other->track, time, 0.0, NULL))
            return true;
    }
    return false;
}

/* s until an obstacle of the kind is met, within what is foreseen; INFINITY: it is not. How those that are about to be met can be
 * evaded is added to what *evasions says. */
static double until_met(const ff_crowd *crowd, const ff_stepper *s, ff_obstacle_kind kind, double time,
                        uint32_t *evasions)
{
    double least = INFINITY, when;
    for (uint32_t i = 0; i < crowd->obstacle_count; ++i) {
        const ff_crowd_obstacle *obstacle = &crowd->obstacles[i];
        if (obstacle->kind != (uint32_t)kind ||
            !ff_track_meets(&s->track, time, FORESEEN, &obstacle->shape, obstacle->velocity, 0.0, &when))
            continue;
        least = ff_min(least, when - time);
        if (when - time <= DANGER) *evasions |= ff_shape_evasions(&obstacle->shape);
    }
    return least;
}

/* Somebody who goes by velocity could not keep off the plan. */
static bool walkers_met(const ff_crowd *crowd, uint32_t slot, double time)
{
    return ff_glides_met(crowd, slot, &crowd->steppers[slot].track, &crowd->footsteps->bounds[slot], time,
                         IMMINENT) < INFINITY;
}

void ff_footsteps_watch(ff_crowd *crowd, uint32_t index)
{
    uint32_t slot = crowd->grid.seen[index].slot;
    if (!ff_is_stepper(crowd, slot)) return;
    ff_stepper *s = &crowd->steppers[slot];
    const ff_footsteps_def *def = &crowd->def.footsteps;
    double time = ff_crowd_time(crowd);
    pass_waypoints(crowd, slot, s);
    bool arrived = ff_stepper_arrived(crowd, slot), done = s->at + 1 == s->plan.count;
    if (ff_length2(ff_sub2(ff_stepper_target(crowd, slot), s->target)) > GOAL_MOVED)
        call_for(s, FF_EVENT_GOAL, time);
    double facing;
    if (done && ff_stepper_turns(crowd, slot, &facing) > TURNED_AWAY) call_for(s, FF_EVENT_GOAL, time);
    if (!arrived && (done || time - s->created >= def->expiry || s->consumed >= def->expiry_actions))
        call_for(s, FF_EVENT_EXPIRY, time);
    uint32_t evasions = 0;
    double on_path = until_met(crowd, s, FF_OBSTACLE_PATH, time, &evasions),
           moved = until_met(crowd, s, FF_OBSTACLE_FREE, time, &evasions);
    if (crossed(crowd, slot, time) || on_path < INFINITY) call_for(s, FF_EVENT_NEARBY, time);
    if (ff_min(on_path, moved) <= DANGER) {
        call_for(s, FF_EVENT_DANGER, time);
        s->evasions = evasions;
    }
    if (moved <= IMMINENT || (time - s->created > SETTLED && walkers_met(crowd, slot, time))) {
        if (!(s->pending >> FF_EVENT_SURPRISE & 1u)) s->surprised = time;
        call_for(s, FF_EVENT_SURPRISE, time);
    }
    /* Only without passive safety does a plan end in anything but a stand. */
    uint32_t last = s->plan.steps[s->plan.count - 1].action;
    if (done && !(ff_action_set_record(crowd->footsteps->actions, last)->flags & FF_ACTION_TO_STANDING))
        s->counts.without_plan += crowd->def.step;
}
