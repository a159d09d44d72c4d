/* crowd_check_step.c - is what was read of somebody who moves by footsteps usable? */
#include "runtime/core/crowd/crowd_check.h"
#include "runtime/core/crowd/crowd_state.h"

#define LARGEST 1e7 /* m, rad: beyond any place */
#define LONGEST 1e9 /* s */
#define FAR 100.0   /* m, of a track from its origin */
#define OFFSET 1e4  /* of a pose offset's numbers */

static bool floats_fit(const float *from, size_t count, double limit)
{
    for (size_t i = 0; i < count; ++i)
        if (!((double)from[i] >= -limit && (double)from[i] <= limit)) return false;
    return true;
}

static bool within(double value, double limit)
{
    return value >= -limit && value <= limit;
}

static bool step_fits(const ff_crowd *crowd, const ff_plan_step *step)
{
    return within(step->anchor.a, LARGEST) && within(step->anchor.b, LARGEST) &&
           within(step->heading, LARGEST) && within(step->start, LONGEST) && step->hold <= 1 &&
           step->action < ff_action_set_count(crowd->footsteps->actions);
}

static bool plan_fits(const ff_crowd *crowd, const ff_plan *plan)
{
    if (plan->count < 1 || plan->count > FF_PLAN_STEPS_MAX || !step_fits(crowd, &plan->from)) return false;
    for (uint32_t i = 0; i < plan->count; ++i)
        if (!step_fits(crowd, &plan->steps[i]) || (i > 0 && plan->steps[i].start < plan->steps[i - 1].start))
            return false;
    return plan->steps[plan->count - 1].hold == 1 && plan->own <= plan->count && plan->stop <= plan->count;
}

static bool track_fits(const ff_track *track)
{
    if (track->count < 1 || track->count > FF_TRACK_KNOTS_MAX) return false;
    if (track->first < -(int64_t)LONGEST || track->first > 10 * (int64_t)LONGEST) return false;
    if (!within(track->origin.a, LARGEST) || !within(track->origin.b, LARGEST)) return false;
    if (!floats_fit(track->radii, FF_TRACK_LANES, 10.0)) return false;
    for (uint32_t i = 0; i < track->count; ++i) {
        const ff_knot *knot = &track->knots[i];
        if (!floats_fit(knot->a, FF_TRACK_LANES, FAR) || !floats_fit(knot->b, FF_TRACK_LANES, FAR) ||
            !floats_fit(knot->y, FF_TRACK_LANES, FAR) || !floats_fit(&track->radius[i], 1, FAR))
            return false;
    }
    for (uint32_t c = 0; c < ff_track_rooms(track); ++c)
        if (!floats_fit(&track->room[c].low_a, 4, 2.0 * FAR)) return false;
    return true;
}

static bool entry_fits(const ff_crowd *crowd, const ff_play_step *step)
{
    if (step->action != FF_PLAY_STAND && step->action >= crowd->pack->action_count) return false;
    if (step->action == FF_PLAY_STAND && step->last != FF_PLAY_STAND &&
        step->last >= crowd->pack->action_count)
        return false;
    if (!within(step->start, LONGEST) || !within(step->entered, LONGEST)) return false;
    if (!(step->end >= -LONGEST && step->end <= FF_PLAY_FOREVER)) return false;
    if (!within(step->pace, 10.0) || !within(step->heading, LARGEST)) return false;
    for (int foot = 0; foot < 2; ++foot) {
        const ff_play_foot *at = &step->foot[foot];
        if (!within(at->a, LARGEST) || !within(at->b, LARGEST) || !within(at->yaw, LARGEST) ||
            at->planted > 1)
            return false;
    }
    return within(step->a, LARGEST) && within(step->b, LARGEST);
}

static bool play_fits(const ff_crowd *crowd, const ff_play *play)
{
    const ff_pose_offset *offset = &play->offset;
    size_t numbers = (sizeof *offset - offsetof(ff_pose_offset, time)) / sizeof(float);
    /* One entry follows the other without end unless the first one has none. */
    bool follows = play->step[0].end >= FF_PLAY_FOREVER || play->step[1].end > play->step[0].end;
    return entry_fits(crowd, &play->step[0]) && entry_fits(crowd, &play->step[1]) && follows &&
           within(play->idle_time, LONGEST) && within(play->joined, LONGEST) &&
           within(offset->age, LONGEST) && floats_fit(offset->time, numbers, OFFSET);
}

const char *ff_crowd_check_stepper(const ff_crowd *crowd, const void *element, size_t *byte)
{
    const ff_stepper *s = element;
    *byte = offsetof(ff_stepper, moves);
    if (s->moves < FF_PLANNER_VELOCITY || s->moves > FF_PLANNER_FOOTSTEPS ||
        s->wanted < FF_PLANNER_VELOCITY || s->wanted > FF_PLANNER_FOOTSTEPS)
        return "a planner is none";
    *byte = offsetof(ff_stepper, waypoint_count);
    if (s->waypoint_count > FF_WAYPOINTS_MAX || s->waypoint_next > s->waypoint_count)
        return "there are too many waypoints";
    if (!ff_crowd_doubles_fit(s, offsetof(ff_stepper, target), offsetof(ff_stepper, waypoint_count), -LONGEST,
                              LONGEST, byte))
        return "a number is too large";
    if (s->moves != FF_PLANNER_FOOTSTEPS) return NULL;
    *byte = offsetof(ff_stepper, evasions);
    if (s->evasions > (FF_EVADE_JUMP | FF_EVADE_DUCK)) return "it evades in a way that is none";
    *byte = offsetof(ff_stepper, plan);
    if (!plan_fits(crowd, &s->plan) || s->at >= s->plan.count) return "a plan does not hold together";
    *byte = offsetof(ff_stepper, track);
    if (!track_fits(&s->track)) return "a track leaves the plane";
    *byte = offsetof(ff_stepper, play);
    if (!play_fits(crowd, &s->play)) return "what is played does not hold together";
    return NULL;
}
