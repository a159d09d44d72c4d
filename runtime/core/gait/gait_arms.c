#include "runtime/core/gait/gait_arms.h"

/* From a run to a walk an elbow has 85 degrees to go, and often swings the same way: 1.9 times as fast as in any example. */
#define ARMS_FASTER 1.25 /* at most, than in any example */
#define NOT_FAST 0.25    /* of the fastest in any example: a fade of that speed is left to itself */

bool ff_gait_arms_hurry(const ff_blend_space *space, const ff_gait *gait)
{
    if (!ff_pose_offset_active(&gait->offset)) return false;
    for (int arm = 0; arm < FF_ARM_JOINTS; ++arm)
        if (ff_pose_offset_speed(&gait->offset, arm) * gait->style.arms >
            NOT_FAST * space->fastest[ff_arm_joints[arm]])
            return true;
    return false;
}

void ff_gait_arms(const ff_blend_space *space, const ff_cursor *cursor, ff_quat arms[FF_ARM_JOINTS])
{
    for (int arm = 0; arm < FF_ARM_JOINTS; ++arm)
        arms[arm] = ff_sample_rotation(space, cursor, ff_arm_joints[arm]);
}

void ff_gait_hold_arms(const ff_blend_space *space, ff_gait *gait, const ff_cursor *cursor,
                       const ff_quat arms[FF_ARM_JOINTS], double dt)
{
    ff_quat now[FF_ARM_JOINTS];
    if (!ff_pose_offset_active(&gait->offset)) return;
    ff_gait_arms(space, cursor, now);
    double faster = ARMS_FASTER / ff_max(gait->style.arms, 1.0); /* the style comes on top (gait_pose.c) */
    for (int arm = 0; arm < FF_ARM_JOINTS; ++arm) {
        double most = faster * space->fastest[ff_arm_joints[arm]] * dt;
        ff_pose_offset_hold(&gait->offset, arm, arms[arm], now[arm], most, dt);
    }
}
