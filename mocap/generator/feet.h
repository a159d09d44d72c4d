/* feet.h - where a foot is at any time of a plan: planted, rolling or swinging. */
#ifndef FF_FEET_H
#define FF_FEET_H

#include "mocap/generator/curves.h"
#include "mocap/generator/plan.h"

typedef struct ff_foot_pose {
    ff_vec3 ankle;        /* m, world */
    double yaw, pitch;    /* rad, world; toes up + */
    double toe_extension; /* rad, toes up against the foot + */
    bool swinging;
} ff_foot_pose;

ff_foot_pose ff_foot_at(const ff_plan *plan, int foot, double t);

/* Points of a posed foot. */
ff_quat ff_foot_rotation(const ff_foot_pose *pose);
ff_vec3 ff_foot_ball(const ff_foot_pose *pose);
ff_vec3 ff_foot_heel(const ff_foot_pose *pose);

/* Set lift and aside of every swing: the sole clears the floor and the standing leg. Call once after
 * ff_plan_finish. */
void ff_feet_clear(ff_plan *plan);

#endif
