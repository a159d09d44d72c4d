/* plan_body.h - the third level of collision tests, for who wants to know exactly: bodies of capsules about their bones, in the poses of
 * the clips. Slow beside the other two (about 1 ms for two who pass each other): for checks, not for searches. */
#ifndef FF_PLAN_BODY_H
#define FF_PLAN_BODY_H

#include "runtime/core/pack/joints.h"
#include "runtime/core/plan/plan.h"

enum { FF_BODY_CAPSULES = FF_JOINT_COUNT - 1 + 5 }; /* bones, head, hands, toes */

typedef struct ff_body_capsule {
    ff_vec3 from, to; /* m, world */
    double radius;
} ff_body_capsule;

/* A body whose joints are at these places and turned so, in the world. */
void ff_body_capsules(const ff_pack *pack, const ff_vec3 at[FF_JOINT_COUNT],
                      const ff_quat turned[FF_JOINT_COUNT], ff_body_capsule out[FF_BODY_CAPSULES]);

/* m between two bodies; negative: how deep they are in each other. */
double ff_bodies_gap(const ff_body_capsule x[FF_BODY_CAPSULES], const ff_body_capsule y[FF_BODY_CAPSULES]);

/* The body of a plan's owner at a time. The joins of actions move it as they move the root. */
ff_status ff_plan_body_at(const ff_action_set *set, const ff_plan *plan, double time,
                          ff_body_capsule out[FF_BODY_CAPSULES], ff_error *error);

/* The least gap between two bodies from a time to another, m; negative: how deep they are in each other, at most about where the
 * search for it stopped. *when: at what time. Moments are as near each other as the gap asks for, 1/240 s at least. */
ff_status ff_plan_bodies_gap(const ff_action_set *set, const ff_plan *x, const ff_plan *y, double from,
                             double until, double *gap, double *when, ff_error *error);

#endif
