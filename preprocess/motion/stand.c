#include "preprocess/motion/stand.h"

#include "preprocess/base/filter.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/gait/leg_ik.h"

#include <stdlib.h>

#define LEVEL_ENOUGH 0.001 /* m */
#define TOE_BEND 1.2       /* rad */

static int ball_of(int foot)
{
    return foot ? FF_ROLE_BALL_R : FF_ROLE_BALL_L;
}

/* Median height of a foot's ball while it stands: over its flat stretches, over whole plants when there is no flat
 * one. False when the foot never stands. scratch has room for every frame. */
static bool planted_height(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants, int foot,
                           double *scratch, double *out)
{
    int count = 0;
    for (int pass = 0; pass < 2 && count == 0; ++pass) {
        for (int p = 0; p < plants->count; ++p) {
            const ff_plant *plant = &plants->items[p];
            int from = pass ? plant->start : plant->flat_start, to = pass ? plant->end : plant->flat_end;
            if (plant->foot != foot || from < 0) continue;
            for (int k = from; k <= to && k < motion->frame_count && count < motion->frame_count; ++k) {
                ff_vec3 at[FF_BODY_COUNT];
                ff_motion_pose(rig, motion, k, at, NULL);
                scratch[count++] = at[ball_of(foot)].y;
            }
        }
    }
    if (count > 0) *out = ff_filter_quantile(scratch, count, 0.5);
    return count > 0;
}

static double lowest_ball(const ff_rig *rig, const ff_motion *motion, double *scratch)
{
    for (int k = 0; k < motion->frame_count; ++k) {
        ff_vec3 at[FF_BODY_COUNT];
        ff_motion_pose(rig, motion, k, at, NULL);
        scratch[k] = ff_min(at[FF_ROLE_BALL_L].y, at[FF_ROLE_BALL_R].y);
    }
    return ff_filter_quantile(scratch, motion->frame_count, 0.05);
}

/* Move one foot up by rise in one frame; the foot keeps its rotation in the world. */
static void raise_foot(const ff_rig *rig, ff_motion *motion, int frame, int foot, double rise)
{
    ff_vec3 at[FF_BODY_COUNT];
    ff_quat world[FF_ROLE_JOINT_COUNT], *local = motion->rotations + (size_t)frame * FF_ROLE_JOINT_COUNT;
    int hip = foot ? FF_ROLE_HIP_R : FF_ROLE_HIP_L, knee = hip + 1, ankle = hip + 2;
    ff_motion_pose(rig, motion, frame, at, world);
    ff_leg leg = {at[hip], at[knee], at[ankle], world[hip], world[knee], world[ankle]};
    ff_leg_solve(&leg, at[hip], ff_add3(at[ankle], ff_v3(0.0, rise, 0.0)));
    local[hip] = ff_quat_mul(ff_quat_conj(world[0]), leg.thigh);
    local[knee] = ff_quat_mul(ff_quat_conj(leg.thigh), leg.shank);
    local[ankle] = ff_quat_mul(ff_quat_conj(leg.shank), world[ankle]);
}

/* Bend the toes up until their tip is no lower than low: while the heel rises they stay flat on the floor, which
 * captured toe joints do not show well enough. */
static void keep_toes_up(const ff_rig *rig, ff_motion *motion, int frame, int foot, double low)
{
    ff_vec3 at[FF_BODY_COUNT];
    ff_quat world[FF_ROLE_JOINT_COUNT], *local = motion->rotations + (size_t)frame * FF_ROLE_JOINT_COUNT;
    int ball = ball_of(foot), tip = foot ? FF_ROLE_TOE_R : FF_ROLE_TOE_L;
    ff_motion_pose(rig, motion, frame, at, world);
    double length = ff_length3(rig->offset[tip]);
    if (at[tip].y >= low || length < 0.01) return;
    /* Toes bent up by phi point along (0, sin phi, cos phi) of the foot; the sine of their slope is
     * up sin phi + ahead cos phi. */
    double up = ff_quat_rotate(world[ball - 1], ff_v3(0.0, 1.0, 0.0)).y;
    double ahead = ff_quat_rotate(world[ball - 1], ff_v3(0.0, 0.0, 1.0)).y;
    double size = sqrt(up * up + ahead * ahead), slope = (low - at[ball].y) / length;
    if (up <= 0.0) return;
    double sine = ff_clamp(slope / size, -1.0, 1.0);
    double bend = ff_atan2(sine, sqrt(1.0 - sine * sine)) - ff_atan2(ahead, up);
    local[ball] = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -ff_clamp(bend, -TOE_BEND, TOE_BEND));
}

ff_status ff_motion_stand(const ff_rig *rig, ff_motion *motion, const ff_plants *plants, ff_error *error)
{
    size_t n = (size_t)motion->frame_count;
    double *scratch = ff_calloc(n, sizeof *scratch);
    if (!scratch) return ff_fail(error, FF_ERR_NO_MEMORY, "the floor of %d frames", motion->frame_count);
    ff_vec3 rest[FF_BODY_COUNT];
    ff_rig_rest_pose(rig, rest);
    double height[2], rise;
    bool left = planted_height(rig, motion, plants, FF_LEFT, scratch, &height[0]);
    bool right = planted_height(rig, motion, plants, FF_RIGHT, scratch, &height[1]);
    if (!left) height[0] = right ? height[1] : lowest_ball(rig, motion, scratch);
    if (!right) height[1] = height[0];
    free(scratch);
    rise = rest[FF_ROLE_BALL_L].y - 0.5 * (height[0] + height[1]);
    double apart =
        0.5 * (height[1] - height[0]); /* what the left foot still has to go up, the right one down */
    for (int k = 0; k < motion->frame_count; ++k) {
        motion->hips[k].z += rise;
        for (int foot = 0; foot < 2; ++foot) {
            if (fabs(apart) >= LEVEL_ENOUGH) raise_foot(rig, motion, k, foot, foot ? -apart : apart);
            keep_toes_up(rig, motion, k, foot, rest[FF_ROLE_TOE_L].y);
        }
    }
    return FF_OK;
}
