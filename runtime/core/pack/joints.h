/* joints.h - the skeleton of every pack: which joint is which. The order is that of the roles in mocap/roles.h. */
#ifndef FF_JOINTS_H
#define FF_JOINTS_H

#include <stdint.h>

enum {
    FF_JOINT_HIPS,
    FF_JOINT_SPINE,
    FF_JOINT_CHEST,
    FF_JOINT_NECK,
    FF_JOINT_HEAD,
    FF_JOINT_CLAVICLE_L,
    FF_JOINT_SHOULDER_L,
    FF_JOINT_ELBOW_L,
    FF_JOINT_WRIST_L,
    FF_JOINT_CLAVICLE_R,
    FF_JOINT_SHOULDER_R,
    FF_JOINT_ELBOW_R,
    FF_JOINT_WRIST_R,
    FF_JOINT_HIP_L,
    FF_JOINT_KNEE_L,
    FF_JOINT_ANKLE_L,
    FF_JOINT_BALL_L,
    FF_JOINT_HIP_R,
    FF_JOINT_KNEE_R,
    FF_JOINT_ANKLE_R,
    FF_JOINT_BALL_R,
    FF_JOINT_COUNT
};

/* What swings an arm: shoulder and elbow, left, then right. */
#define FF_ARM_JOINTS 4
static const int32_t ff_arm_joints[FF_ARM_JOINTS] = {FF_JOINT_SHOULDER_L, FF_JOINT_ELBOW_L,
                                                     FF_JOINT_SHOULDER_R, FF_JOINT_ELBOW_R};

/* Joint a of a leg is FF_JOINT_HIP_L + a + foot * FF_JOINT_LEG_STRIDE (foot 0 left, 1 right). */
enum { FF_JOINT_LEG_STRIDE = FF_JOINT_HIP_R - FF_JOINT_HIP_L };

static const int32_t ff_joint_parents[FF_JOINT_COUNT] = {-1, 0,  1, 2,  3,  2,  5, 6,  7,  2, 9,
                                                         10, 11, 0, 13, 14, 15, 0, 17, 18, 19};

#endif
