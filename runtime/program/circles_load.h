/* circles_load.h - antipodal circles of forty side by side, as many as it takes: what a whole crowd costs per agent and
 * step, at the same density whatever its size. What `bench fig6` measures. */
#ifndef FF_CIRCLES_LOAD_H
#define FF_CIRCLES_LOAD_H

#include "runtime/footfall.h"

#define FF_CIRCLE_PEOPLE 40  /* the paper's number */
#define FF_CIRCLE_RADIUS 6.4 /* m: 0.16 per head, as the navigation study has it */
#define FF_CIRCLE_PITCH 16.8 /* m from centre to centre */

/* us per agent and step, medians over the steps measured. */
typedef struct ff_load_times {
    double total, navigation, steps, matrices, coupling;
} ff_load_times;

/* Where agent of count agents starts and is to go. Agents of one circle are anywhere in memory: numbered at random. */
typedef struct ff_circle_place {
    ff_vec2 from, goal;
} ff_circle_place;
void ff_circle_places(uint32_t count, ff_circle_place *out);

/* Walk everybody to where the circles close up, and measure from there until they meet: the crowd's step and the matrices
 * of all joints, in CPU time of one thread. */
ff_status ff_circles_measure(const ff_pack *pack, ff_navigation method, uint32_t count, ff_load_times *out,
                             ff_error *error);

/* The same by Detour's crowd, which has navigation only. */
ff_status ff_circles_measure_detour(uint32_t count, ff_load_times *out, ff_error *error);

#endif
