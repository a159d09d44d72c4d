/* plan_course.h - an action that is thought of, in its place: where the body gets to, knot by knot, and whether it meets other agents
 * (plan_course.c). For plan_stance.c. */
#ifndef FF_PLAN_COURSE_H
#define FF_PLAN_COURSE_H

#include "runtime/core/plan/plan_joint.h"
#include "runtime/core/plan/plan_sight.h"

/* A successor, in its place. Where it gets to is worked out as far as somebody is near. */
typedef struct ff_course {
    const ff_stance *stance;
    const ff_set_action *action;
    const float *anchor;
    float a, b, radius; /* m: circle that holds all of it */
    int32_t last;       /* knot, not after its end */
    uint32_t total;     /* knots */
    bool rooted;        /* roots are there */
    uint64_t made;      /* bit k: knots[k] is there */
    const ff_joint *joint;
    float root_a[FF_SIGHT_KNOTS + 4], root_b[FF_SIGHT_KNOTS + 4]; /* [0] is the stance's tail */
    float about[FF_SIGHT_KNOTS + 4]; /* radii about it, that hold all colliders */
    ff_knot knots[FF_SIGHT_KNOTS];
} ff_course;

/* A successor (of set->next), in its place. The stance is kept. */
void ff_course_begin(const ff_sight *sight, const ff_stance *stance, const ff_set_next *next, ff_course *out);

/* Makes all knots that are not there yet. */
void ff_course_make(const ff_sight *sight, ff_course *course);

/* Is somebody of the stance's near ones met? Who is comes first among them from then on. */
bool ff_course_meets(ff_sight *sight, ff_course *course, ff_stance *stance);

#endif
