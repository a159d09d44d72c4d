/* foot_target.h - legs posed so that their feet are where they should be. */
#ifndef FF_FOOT_TARGET_H
#define FF_FOOT_TARGET_H

#include "preprocess/motion/motion.h"
#include "runtime/core/gait/leg_ik.h"

/* Where a foot should be. */
typedef struct ff_foot_target {
    ff_vec3 ball;     /* m, in the space that the pose is given in */
    ff_quat rotation; /* of the foot, in that space */
    ff_quat toes;     /* local */
} ff_foot_target;

ff_vec3 ff_target_ankle(const ff_rig *rig, const ff_foot_target *target);

/* Local rotations [FF_ROLE_JOINT_COUNT] to ones in the space of the first joint's parent. */
void ff_local_to_world(const ff_quat *local, ff_quat *world);

/* Turn thigh, shank, foot and toes of a pose (points at, rotations world and local) so that the foot is on its target
 * (towards it, when that is out of reach); only local is changed. */
void ff_leg_to_target(const ff_rig *rig, int foot, const ff_foot_target *target, const ff_vec3 *at,
                      const ff_quat *world, ff_quat *local);

#endif
