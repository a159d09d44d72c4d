/* leg_pose.h - the joints of both legs, from the hips and from where and how the feet are meant to be. */
#ifndef FF_LEG_POSE_H
#define FF_LEG_POSE_H

#include "runtime/core/gait/leg_ik.h"
#include "runtime/core/gait/synth_state.h"

/* The legs as local rotations have them, under hips at a place in the world and with rotations[0]. */
void ff_legs_of_clip(const ff_body_frame *body, ff_vec3 hips, const ff_quat *rotations, ff_legs *out);

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
    double swing;     /* 0: not in swing, else its progress to 1: the leg may fall short of its foot */
    double round;     /* 0: a foot that lies flat to 1: it rolls or flies, and gets out of reach gradually */
    double toes_more; /* rad, by which toes are bent up, other than by the floor */
    /* m, by which the leg is longer than to the foot's place, or, of one that stands, than its reach */
    double give;
    double raise; /* rad, by which the heel is lifted in any case */
} ff_leg_target;

/* Where a foot's ankle shall be; the heel raised (turn, of the foot), or the leg let short of it, where it is out of reach. */
ff_vec3 ff_leg_ankle(const ff_body_frame *body, int foot, const ff_leg_target *target, ff_vec3 hip,
                     ff_quat *turn);

/* Solve legs (as ff_legs_of_clip gives them) to their targets, left and right, and write each leg's four local rotations,
 * of which the toes' are read. */
void ff_legs_pose(const ff_body_frame *body, const ff_leg_target target[2], ff_legs *legs,
                  ff_quat *rotations);

#endif
