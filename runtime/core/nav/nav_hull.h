/* nav_hull.h - velocities that the walking examples can make, as half-planes in the agent's own frame (FbCrowd
 * eq 2-5; algorithms A.11). */
#ifndef FF_NAV_HULL_H
#define FF_NAV_HULL_H

#include "runtime/core/nav/nav_solve.h"
#include "runtime/core/pack/pack_format.h"

#define FF_HULL_MAX 16

typedef struct ff_hull {
    ff_line line[FF_HULL_MAX]; /* components (forward, left), m/s; the origin satisfies all */
    uint32_t count;
    double speed; /* m/s, of the fastest corner */
} ff_hull;

/* Hull of the points and the origin (standing still must stay allowed). Corners beyond FF_HULL_MAX are cut off,
 * smallest ones first. Points on one line give the box of A.11, none no limit. */
void ff_hull_make(const ff_pack_point2 *points, uint32_t count, ff_hull *out);

/* Put the hull's lines, turned to where the agent faces (facing = unit vector), at the end of lines; returns the
 * new count. */
uint32_t ff_hull_lines(const ff_hull *hull, ff_vec2 facing, ff_line *lines, uint32_t count);

/* Somebody asked to turn round (by more than 90 degrees, until less than 80 are left) may drift to the side
 * of the turn at 0.3 m/s only, so he slows and turns on the spot. *side: the remembered turn (+1 left, -1 right, 0
 * none). A.11, 5, in its form for databases without tight turns. */
uint32_t ff_hull_sharp_turn(ff_vec2 facing, ff_vec2 preferred, double *side, ff_line *lines, uint32_t count);

#endif
