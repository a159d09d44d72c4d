/* derive_body.h - bodies that motions are made up of: poses of examples with their feet in the world, mixed, and put on the
 * rig by IK. */
#ifndef FF_DERIVE_BODY_H
#define FF_DERIVE_BODY_H

#include "preprocess/actions/derive_motion.h"
#include "preprocess/motion/foot_target.h"

#define FF_DERIVE_RATE 60.0  /* frames per second */
#define FF_DERIVE_STANDS 0.6 /* s, before and after */
#define FF_DERIVE_FULL 0.08  /* of a walk's cycle, from a foot's contact until it is whole on the floor */

/* A pose with its feet in the world. */
typedef struct ff_derive_body {
    ff_vec3 root, hips; /* as in ff_motion */
    ff_quat local[FF_ROLE_JOINT_COUNT];
    ff_foot_target feet[2];
} ff_derive_body;

int ff_derive_frames(double seconds);

/* The pose of an example at a phase, on a root; what it does to its feet is in feet. */
ff_derive_body ff_derive_example_body(const ff_rig *rig, const ff_example *example, double phase,
                                      ff_vec3 root);
ff_derive_body ff_derive_stand_body(const ff_derive_base *base, ff_vec3 root);

ff_foot_target ff_derive_mix_feet(const ff_foot_target *p, const ff_foot_target *q, double t);
/* All but the feet. */
void ff_derive_mix_bodies(const ff_derive_body *p, const ff_derive_body *q, double t, ff_derive_body *out);
/* A foot on its way: t from 0 to 1. Its heel comes up first, by rise (rad); lift: m. */
ff_foot_target ff_derive_swing(const ff_foot_target *from, const ff_foot_target *to, double t, double lift,
                               double rise);

/* Cubic from x0 with slope v0 to x1 with slope v1 over seconds. */
double ff_derive_hermite(double x0, double v0, double x1, double v1, double t, double seconds);

/* Lower the hips until both legs reach their feet, then pose the legs: frame k. */
void ff_derive_put_frame(const ff_rig *rig, const ff_derive_body *body, int k, ff_motion *motion);

#define FF_DERIVE_DUCK 1.85 /* s */
/* How far down one is, 0 to 1, at a time of a duck. */
double ff_derive_ducked(double time);

/* Crouched, by a share of a duck: hips down and back, trunk forward, eyes ahead. */
void ff_derive_crouch(const ff_rig *rig, double share, ff_derive_body *body);

#endif
