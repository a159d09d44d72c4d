/* clean_foot.h - where heel, ball and toe tip of a foot are, as a function of small changes of the pose, with slopes.
 *
 * A pose is changed by rotation vectors applied on the joint's own side, R = R0 exp(d), and by a shift of the hips
 * (cleanup study, section 3.3). Knee and toes turn about one axis, the joint's own +X. */
#ifndef FF_CLEAN_FOOT_H
#define FF_CLEAN_FOOT_H

#include "preprocess/motion/motion.h"

enum {
    FF_CLEAN_ROOT = 6,  /* shift of the hips (m), turn of the pelvis (rad) */
    FF_CLEAN_LEG = 8,   /* turns of hip (3), knee (1), ankle (3), toes (1), rad */
    FF_CLEAN_PLANT = 3, /* where a foot is planted: x, z of the ball (m), direction heel to ball (rad) */
    FF_CLEAN_KNEE = 3,  /* the knee among a leg's unknowns */
};

/* The joints of one leg that turn, from the hip down to the toes. */
enum { FF_LEG_HIP, FF_LEG_KNEE, FF_LEG_ANKLE, FF_LEG_BALL, FF_LEG_JOINTS };
enum { FF_FOOT_AT_HEEL, FF_FOOT_AT_BALL, FF_FOOT_AT_TOE, FF_FOOT_PLACES };

/* What is not changed yet: hips in the world, legs joint by joint. */
typedef struct ff_clean_pose {
    ff_vec3 hips;
    ff_quat pelvis;                 /* world */
    ff_quat legs[2][FF_LEG_JOINTS]; /* local */
    double flexion[2];              /* rad, of the knee about its axis; negative = bent the wrong way */
} ff_clean_pose;

/* d place / d unknown, [place][coordinate][unknown]. */
typedef struct ff_clean_slopes {
    double root[FF_FOOT_PLACES][3][FF_CLEAN_ROOT], leg[FF_FOOT_PLACES][3][FF_CLEAN_LEG];
} ff_clean_slopes;

static inline int ff_leg_role(int side, int joint)
{
    return (side == FF_LEFT ? FF_ROLE_HIP_L : FF_ROLE_HIP_R) + joint;
}

/* One frame of a motion, from and to it: the root stays where it is. */
void ff_clean_pose_read(const ff_motion *motion, int frame, ff_clean_pose *out);
void ff_clean_pose_write(const ff_clean_pose *pose, ff_motion *motion, int frame);
/* Add changes, root [FF_CLEAN_ROOT] and legs [2][FF_CLEAN_LEG]. */
void ff_clean_pose_change(ff_clean_pose *pose, const double *root, const double *legs);

/* Flexion of a knee about its own axis: hip to ankle is longest at 0. */
double ff_knee_flexion(ff_quat knee);

/* Places [FF_FOOT_PLACES] of a foot; slopes may be NULL. */
void ff_clean_foot(const ff_rig *rig, const ff_clean_pose *pose, int side, const double *root,
                   const double *leg, ff_vec3 *places, ff_clean_slopes *slopes);

/* Distance heel to ball along the ground, of a planted foot whose ball is so much higher than its heel. */
double ff_foot_reach(const ff_rig *rig, double rise);

/* d (exp(v) turned by d) / d v on the vector's own side: exp(v + e) = exp(v) exp(J e), columns of J. */
void ff_rotation_slope(ff_vec3 v, ff_vec3 *columns);

#endif
