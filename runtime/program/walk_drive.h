/* walk_drive.h - walkers on courses of every kind: at given rates (which no goal would ask for), after commands, and in
 * crowds with goals. */
#ifndef FF_WALK_DRIVE_H
#define FF_WALK_DRIVE_H

#include "runtime/core/gait/synth.h"

typedef enum ff_course_kind {
    FF_COURSE_STEADY,   /* rates, after a start */
    FF_COURSE_STOPS,    /* to the rates and back to a stand, every so often */
    FF_COURSE_WAVES,    /* rates that sway: dodging */
    FF_COURSE_COMMANDS, /* a body with random commands and facings */
    FF_COURSE_GOALS,    /* a crowd whose goals change at random */
} ff_course_kind;

typedef struct ff_course {
    const char *name;
    ff_course_kind kind;
    ff_rates rates;
    double period;    /* s, of stops and waves, or between commands */
    uint32_t walkers; /* at least 1 */
    double side;      /* m, of the square that goals lie in */
    bool runs;        /* some of it is run, which is shown but not held to the bars of walking */
} ff_course;

/* Walks and turns of every kind; *count of them. */
const ff_course *ff_courses(uint32_t *count);

/* What a walker does at the end of a step. */
typedef struct ff_walk_pose {
    uint32_t walker;
    ff_agent_state state;
    ff_vec3 hips;
    const ff_quat *rotations; /* [joint count] */
} ff_walk_pose;

typedef ff_status ff_walk_visit(void *context, const ff_walk_pose *pose, ff_error *error);

typedef struct ff_walk_def {
    double seconds, step;
    uint64_t seed;
    /* FF_SYNTHESIS_HYBRID: between blending and the semi-procedural clip it changes in a crowd when it matters, else at
     * random. */
    ff_synthesis synthesis;
} ff_walk_def;

/* Walk a course, with everybody's first pose and the pose after each step shown to visit. */
ff_status ff_walk_drive(const ff_pack *pack, const ff_course *course, const ff_walk_def *def,
                        ff_walk_visit *visit, void *context, ff_error *error);

#endif
