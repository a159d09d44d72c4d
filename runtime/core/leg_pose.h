/* leg_pose.h - the joints of one leg, from the hips and from where and how its foot is meant to be. */
#ifndef FF_LEG_POSE_H
#define FF_LEG_POSE_H

#include "runtime/core/leg_ik.h"
#include "runtime/core/synth_state.h"

/* The leg (0 left, 1 right) as local rotations have it, under hips at a place and rotation in the world. */
ff_leg ff_leg_of_clip(const ff_body_frame *body, int foot, ff_vec3 hips, ff_quat hips_turn,
                      const ff_quat *rotations);

/* Where the balls of a pose are and how its feet are turned, in the world as the hips are (rotations[0]). */
void ff_legs_of_pose(const ff_body_frame *body, ff_vec3 hips, const ff_quat *rotations, ff_vec3 ball[2],
                     ff_quat foot_turn[2]);

typedef struct ff_leg_target {
    ff_foothold ball;  /* yaw: of the foot, about which way a heel is raised */
    ff_quat turn;      /* of the foot, in the world */
    double clearance;  /* m, of the toe tip over its height in rest */
    double most_raise; /* rad, that the heel may be lifted by for the ankle to be in reach */
    /* 1: planted, out of reach it lifts its heel. 0: in the air, out of reach it is not quite reached. */
    double grip;
    double swing; /* 0: not in swing, else its progress to 1: the leg may fall short of its foot */
    double round; /* 0: a foot that lies flat to 1: it rolls or flies, and gets out of reach gradually */
} ff_leg_target;

/* Solve leg (as ff_leg_of_clip gives it) to the target and write the leg's four local rotations, of which the toes' are
 * read. */
void ff_leg_pose(const ff_body_frame *body, int foot, const ff_leg_target *target, ff_leg *leg,
                 ff_quat hips_turn, ff_quat *rotations);

#endif
