/* floor.h - the clip's floor: one plane under both feet, and how high the points of each foot stand over it. */
#ifndef FF_FLOOR_H
#define FF_FLOOR_H

#include "preprocess/plants/foot_signals.h"

/* A place where the ball of a foot rested. */
typedef struct ff_floor_sample {
    int foot;
    ff_vec3 ball;  /* m */
    double weight; /* s it rested there */
} ff_floor_sample;

typedef struct ff_floor_fit {
    ff_vec2 slope;   /* m per m */
    double level[2]; /* m, of each foot's ball at the plane's origin */
    double scatter;  /* m, mean distance of the samples from the plane */
} ff_floor_fit;

/* Robust plane through the samples with one level per foot (the balls of a real skeleton's feet differ in height by
 * up to 2 cm). Directions the samples say nothing about stay level. count >= 1. */
ff_floor_fit ff_floor_solve(const ff_floor_settings *settings, const ff_floor_sample *samples, int count);

/* Height of the plane's rise at a point, without the level. */
static inline double ff_floor_rise(ff_vec2 slope, ff_vec3 p)
{
    return slope.a * p.z + slope.b * p.x;
}

/* Fill signals->height: each point over its own rest level, which is the median over frames where the ball is within
 * still_height of the plane and all three points are slow (the ball's level when there is no such frame). */
void ff_floor_heights(const ff_floor_fit *fit, int foot, ff_foot_signals *signals, double *scratch);

#endif
