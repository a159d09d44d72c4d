/* obstacle_course.h - an obstacle course of walls: an open yard, a passage with baffles to wind through, another yard. One way of
 * synthesis walks it, and is measured (FbCrowd, section 7.1: "Evaluating the benefits of HMS"). */
#ifndef FF_OBSTACLE_COURSE_H
#define FF_OBSTACLE_COURSE_H

#include "runtime/export/measures.h"
#include "runtime/export/naturalness.h"
#include "runtime/program/simulate.h"

typedef struct ff_obstacle_course {
    ff_synthesis synthesis;
    uint32_t agents;
    uint64_t seed;
    double seconds, step, gap; /* s; m, between a baffle's end and the wall */
} ff_obstacle_course;

typedef struct ff_mean {
    double sum;
    uint64_t terms;
} ff_mean;

static inline double ff_mean_value(ff_mean mean)
{
    return mean.terms > 0 ? mean.sum / (double)mean.terms : 0.0;
}

typedef struct ff_obstacle_result {
    ff_measures measures; /* of discs, bodies and feet; arrival at the end of the course */
    ff_mean open,
        passage; /* m: distance to the nearest recorded pose, of those who walk, in the yards and in between */
    double wall_deepest; /* m, of any body in any wall */
    ff_mean wall;        /* share of poses in which a body touches a wall */
    ff_synthesis_counts counts;
} ff_obstacle_result;

/* Walk it. What is drawn from it, scene and recording, the caller frees, or gives NULL for both. */
ff_status ff_obstacle_walk(const ff_pack *pack, const ff_figure *figure, const ff_pose_base *base,
                           const ff_obstacle_course *course, ff_obstacle_result *out, ff_scene *scene,
                           ff_recording *recording, ff_error *error);

#endif
