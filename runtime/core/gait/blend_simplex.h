/* blend_simplex.h - points, triangles and tetrahedra of rates: is a target inside, and which point is nearest? */
#ifndef FF_BLEND_SIMPLEX_H
#define FF_BLEND_SIMPLEX_H

#include "runtime/core/gait/synth.h"

/* Metres per second that a turn of 1 rad/s counts for when distances between rates are measured: about what a turning
 * foot, half a step from the root, moves. */
#define FF_BLEND_TURN_SCALE 0.5

/* A point of the space of rates: (forward, left, FF_BLEND_TURN_SCALE * turn). */
ff_vec3 ff_blend_point(ff_rates rates);
ff_rates ff_blend_rates(ff_vec3 point);

/* A tetrahedron, ready for barycentric coordinates. */
typedef struct ff_blend_solid {
    int32_t vertex[4];
    ff_vec3 origin;     /* of vertex 3 */
    ff_vec3 inverse[3]; /* rows: coordinates 0 to 2 of (p - origin) */
    ff_vec3 low, high;
} ff_blend_solid;

/* False when the four points are too nearly in a plane to divide by their volume. */
bool ff_blend_solid_make(const ff_vec3 corner[4], const int32_t vertex[4], ff_blend_solid *out);
/* Barycentric coordinates of p; true when none is below -tolerance. */
bool ff_blend_solid_locate(const ff_blend_solid *solid, ff_vec3 p, double tolerance, double weight[4]);

/* Nearest point to p of a point, segment or triangle (count 1 to 3 corners); its weights; returns distance squared. */
double ff_blend_face_nearest(const ff_vec3 *corner, int count, ff_vec3 p, double weight[3]);

#endif
