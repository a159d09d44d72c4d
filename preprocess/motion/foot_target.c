#include "preprocess/motion/foot_target.h"

ff_vec3 ff_target_ankle(const ff_rig *rig, const ff_foot_target *target)
{
    return ff_sub3(target->ball, ff_quat_rotate(target->rotation, rig->offset[FF_ROLE_BALL_L]));
}

void ff_local_to_world(const ff_quat *local, ff_quat *world)
{
    world[0] = local[0];
    for (int r = 1; r < FF_ROLE_JOINT_COUNT; ++r)
        world[r] = ff_quat_mul(world[ff_role_parent((ff_role)r)], local[r]);
}

void ff_leg_to_target(const ff_rig *rig, int foot, const ff_foot_target *target, const ff_vec3 *at,
                      const ff_quat *world, ff_quat *local)
{
    int hip = foot ? FF_ROLE_HIP_R : FF_ROLE_HIP_L, knee = hip + 1, ankle = hip + 2, ball = hip + 3;
    ff_leg leg = {at[hip], at[knee], at[ankle], world[hip], world[knee], world[ankle]};
    ff_leg_solve(&leg, at[hip], ff_target_ankle(rig, target));
    local[hip] = ff_quat_mul(ff_quat_conj(world[0]), leg.thigh);
    local[knee] = ff_quat_mul(ff_quat_conj(leg.thigh), leg.shank);
    local[ankle] = ff_quat_mul(ff_quat_conj(leg.shank), target->rotation);
    local[ball] = target->toes;
}
