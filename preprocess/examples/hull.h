/* hull.h - the convex hull of points of the plane. */
#ifndef FF_HULL_H
#define FF_HULL_H

#include "runtime/footfall.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Indices of the hull's corners, counter-clockwise in (a, b), starting with the one of smallest (a, b); points on an
 * edge (within 1e-9) are no corners. out has room for count. Returns how many there are: 2 for points on a line, 1 for
 * a single place, 0 for none; negative when memory is short. */
int ff_hull_find(const ff_vec2 *points, int count, int *out);

/* The velocity set of FbCrowd, eq 2-4: an example that walks v metres per second and turns by omega per second is the
 * point (cos omega, sin omega) * v of the agent's frame; omega is clamped to half a turn (algorithms A.11). */
ff_vec2 ff_hull_velocity(double speed, double turn_rate);

/* Hull of the velocities, as above but as points; with fewer than three corners the box of algorithms A.11.3 (up to
 * the fastest, 0.3 of it to each side). out has room for count + 4. Returns how many; negative: no memory. */
int ff_hull_of_velocities(const ff_vec2 *velocities, int count, ff_vec2 *out);

#ifdef __cplusplus
}
#endif
#endif
