#include "preprocess/actions/landing.h"

static const double PLACE = 0.002;   /* m: who is nearer to its place on the ground, ... */
static const double BALL_UP = 0.005; /* m: ... its ball no higher over where it rests ... */
static const double HEEL_UP = 0.010; /* m: ... and its heel than this, is down */
/* m: one that is higher up is not coming down: plants and pose contradict each other (step_check.c says so) */
static const double NEAR = 0.04;
static const double LATEST = 0.025; /* s after the signals: later, it is another moment of a captured foot */
static const double SLACK = 0.5 / 60.0; /* s: times that are later than the foot by so little are left */

typedef struct points {
    ff_vec3 ball, heel;
} points;

static points look_at(const ff_rig *rig, const ff_motion *motion, int foot, int frame)
{
    ff_vec3 at[FF_BODY_COUNT];
    ff_motion_pose(rig, motion, frame, at, NULL);
    return (points){at[foot == FF_LEFT ? FF_ROLE_BALL_L : FF_ROLE_BALL_R], at[FF_BODY_HEEL_L + foot]};
}

static bool is_near(const points *now, const points *rests)
{
    return now->ball.y - rests->ball.y < NEAR && now->heel.y - rests->heel.y < NEAR;
}

static bool is_down(const points *now, const points *rests)
{
    return ff_length2(ff_plane(ff_sub3(now->ball, rests->ball))) < PLACE &&
           now->ball.y - rests->ball.y < BALL_UP && now->heel.y - rests->heel.y < HEEL_UP;
}

int ff_landing_in_motion(const ff_rig *rig, const ff_motion *motion, const ff_plant *plant, int full)
{
    if (plant->written || plant->cut_start || plant->flat_start < 0 || full < plant->start) return full;
    /* Where the clip ends early in the plant, the heel may still be coming down in the middle of what there is. */
    int settled = plant->cut_end ? plant->flat_end : (plant->flat_start + plant->flat_end) / 2;
    points rests = look_at(rig, motion, plant->foot, settled);
    points now = look_at(rig, motion, plant->foot, full);
    int last = full + (int)(LATEST / motion->frame_time), slack = (int)(SLACK / motion->frame_time + 1e-6);
    int first = full;
    if (last > plant->flat_end) last = plant->flat_end;
    if (is_down(&now, &rests)) {
        for (; first > plant->start; --first) {
            now = look_at(rig, motion, plant->foot, first - 1);
            if (!is_down(&now, &rests)) break;
        }
        return first + slack < full ? first + slack : full;
    }
    for (first = full + 1; first <= last && is_near(&now, &rests); ++first) {
        now = look_at(rig, motion, plant->foot, first);
        if (is_down(&now, &rests)) return first;
    }
    return full;
}
