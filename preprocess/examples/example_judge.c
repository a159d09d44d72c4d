#include "preprocess/examples/example_judge.h"

#include <stdio.h>

/* For want of anything better; how far closing may then move a joint is a setting. */
#define LOOSE_WANDER 0.4
#define LOOSE_STANCE 0.25
#define LOOSE_UPRIGHT 0.85
/* Of who stands: mean distance of the ends (m), and of the largest way of any joint over the loop. */
#define SEAM_IDLE 0.015
#define RESTLESS 0.03

bool ff_example_is_straight(const ff_example *e)
{
    return e->record.v_left == 0.0f && e->record.turn_rate == 0.0f;
}

bool ff_example_is_model(const ff_example *e)
{
    return e->record.gait == FF_GAIT_WALK && !(e->record.flags & FF_EXAMPLE_IDLE) &&
           ff_example_is_straight(e) && e->record.v_forward >= FF_MODEL_SLOWEST;
}

static double mean_height(const ff_example *e)
{
    double sum = 0.0;
    for (int k = 0; k < e->frame_count; ++k)
        sum += e->hips[k].z;
    return sum / e->frame_count;
}

/* How far (m) the left foot passes to the right of the right one; blended with other gaits, crossed legs meet. */
static double crossing(const ff_example *e)
{
    double most = 0.0;
    for (int k = 0; k < e->frame_count; ++k)
        most = ff_max(most, (double)e->feet[2 * k + 1].ball[1] - (double)e->feet[2 * k].ball[1]);
    return most;
}

/* Largest way of any joint over the cycle, mean over the joints: how restless a standing person is. */
static double restlessness(const ff_rig *rig, const ff_example *e)
{
    ff_vec3 first[FF_BODY_COUNT], at[FF_BODY_COUNT];
    double most[FF_BODY_COUNT] = {0.0}, sum = 0.0;
    ff_example_pose(rig, e, 0, first);
    for (int k = 1; k < e->frame_count; ++k) {
        ff_example_pose(rig, e, k, at);
        for (int r = 0; r < FF_BODY_COUNT; ++r)
            most[r] = ff_max(most[r], ff_length3(ff_sub3(at[r], first[r])));
    }
    for (int r = 0; r < FF_BODY_COUNT; ++r)
        sum += most[r];
    return sum / FF_BODY_COUNT;
}

/* The shorter of the stretches in which a foot stands still, as a share of the cycle. */
static double shortest_lock(const ff_example *e)
{
    double shortest = 1.0;
    for (int foot = 0; foot < 2; ++foot) {
        double length = (double)e->record.lock[foot][1] - (double)e->record.lock[foot][0];
        shortest = ff_min(shortest, length < 0.0 ? length + 1.0 : length);
    }
    return shortest;
}

typedef struct verdict {
    char *why;
    size_t size;
    bool good;
} verdict;

/* The first figure out of its limits is the reason. scale: from SI to the unit the text names. */
static void at_most(verdict *v, double value, double limit, double scale, const char *text)
{
    if (!v->good || value <= limit) return;
    v->good = false;
    snprintf(v->why, v->size, "%s %.1f, at most %.1f", text, value * scale, limit * scale);
}

static void at_least(verdict *v, double value, double limit, double scale, const char *text)
{
    if (!v->good || value >= limit) return;
    v->good = false;
    snprintf(v->why, v->size, "%s %.1f, at least %.1f", text, value * scale, limit * scale);
}

static void judge_closing(const ff_example_settings *set, verdict *v, const ff_example *e)
{
    bool straight = ff_example_is_straight(e) && e->record.gait == FF_GAIT_WALK;
    at_most(v, (double)e->record.seam, straight ? set->seam_straight : set->seam, 100.0,
            "its ends differ by cm");
    at_most(v, (double)e->loop.moved, straight ? set->moved_straight : set->moved, 100.0,
            "closing moves a joint by cm");
    at_most(v, (double)e->loop.jump, FF_LOOP_JUMP, 1000.0, "still jumps by mm");
    at_most(v, (double)e->loop.cut_kick, (double)e->loop.contact_kick, 100.0,
            "velocities differ at the cut more than at a contact: cm/s");
}

bool ff_example_judge(const ff_example_settings *set, const ff_rig *rig, const ff_example *e, char *why,
                      size_t size)
{
    verdict v = {why, size, true};
    double speed = ff_length2(ff_v2((double)e->record.v_forward, (double)e->record.v_left));
    at_least(&v, mean_height(e), set->upright * rig->offset[FF_ROLE_HIPS].y, 100.0, "crouches: hips at cm");
    if (e->record.flags & FF_EXAMPLE_IDLE) {
        at_most(&v, (double)e->record.seam, SEAM_IDLE, 100.0, "its ends differ by cm");
        if (v.good) at_most(&v, restlessness(rig, e), RESTLESS, 100.0, "does not stand still: joints go cm");
        return v.good;
    }
    judge_closing(set, &v, e);
    at_most(&v, e->wander, set->wander, 1.0 / FF_DEG, "no steady turn: heading wanders by degrees");
    at_most(&v, crossing(e), set->crossed, 100.0, "legs cross by cm");
    if (e->record.gait == FF_GAIT_RUN) {
        at_least(&v, (double)e->record.v_forward, set->run_speed, 1.0, "runs at m/s");
        at_least(&v, (double)e->record.period, set->run_period, 1000.0, "no running cycle: ms");
        return v.good;
    }
    at_least(&v, shortest_lock(e), set->stance, 100.0, "a foot stands for % of the cycle");
    at_most(&v, speed, set->walk_speed, 1.0, "walks at m/s");
    at_most(&v, fabs((double)e->record.turn_rate), set->walk_turn, 1.0 / FF_DEG,
            "turns by degrees per second");
    return v.good;
}

bool ff_example_judge_loosely(const ff_example_settings *set, const ff_rig *rig, const ff_example *e,
                              char *why, size_t size)
{
    verdict v = {why, size, true};
    if (!ff_example_is_model(e)) {
        snprintf(why, size, "no straight walk");
        return false;
    }
    at_least(&v, mean_height(e), LOOSE_UPRIGHT * rig->offset[FF_ROLE_HIPS].y, 100.0, "crouches: hips at cm");
    at_most(&v, (double)e->loop.moved, set->moved_loose, 100.0, "closing moves a joint by cm");
    at_most(&v, (double)e->loop.jump, FF_LOOP_JUMP, 1000.0, "still jumps by mm");
    at_most(&v, e->wander, LOOSE_WANDER, 1.0 / FF_DEG, "no steady turn: heading wanders by degrees");
    at_most(&v, crossing(e), set->crossed, 100.0, "legs cross by cm");
    at_least(&v, shortest_lock(e), LOOSE_STANCE, 100.0, "a foot stands for % of the cycle");
    at_most(&v, (double)e->record.v_forward, set->walk_speed, 1.0, "walks at m/s");
    return v.good;
}
