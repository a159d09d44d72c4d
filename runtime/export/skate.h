/* skate.h - how far planted feet slide, measured from the poses people see. */
#ifndef FF_SKATE_H
#define FF_SKATE_H

#include "runtime/core/base/maths.h"
#include "runtime/core/base/memory.h"

/* A stretch of frames over which a foot should stand still. */
typedef struct ff_skate_run {
    ff_vec2 last; /* m, the ball on the ground */
    double path;  /* m */
    uint32_t frames;
    bool open;
} ff_skate_run;

typedef struct ff_skate_foot {
    ff_skate_run planted; /* while the crowd says that the foot is planted */
    ff_skate_run seen;    /* while the foot is low and slow, whatever the crowd says */
    ff_vec3 last;
    bool known;
} ff_skate_foot;

typedef struct ff_skate {
    ff_skate_foot *feet; /* two per agent */
    uint32_t agent_count;
    double step;
    ff_array planted, seen; /* double: slide of each finished plant, m */
    double low_path,
        low_time; /* m, s: slide weighted by nearness to the ground (algorithm G.3, label-free) */
} ff_skate;

ff_status ff_skate_create(uint32_t agents, double step, ff_skate *out, ff_error *error);
void ff_skate_free(ff_skate *skate);

/* The next frame of a foot (0 left, 1 right): where its ball is, how high it is in the rest pose, planted or not. */
ff_status ff_skate_add(ff_skate *skate, uint32_t agent, int foot, ff_vec3 ball, double rest_height,
                       bool planted, ff_error *error);

/* Close the plants still open. */
ff_status ff_skate_finish(ff_skate *skate, ff_error *error);

#endif
