/* simplices.h - the space of rates cut into simplices of examples, for barycentric blending (algorithms D.2). */
#ifndef FF_SIMPLICES_H
#define FF_SIMPLICES_H

#include "runtime/core/base/maths.h"
#include "runtime/core/base/memory.h"

/* More points than this are not triangulated (the search is over all quadruples). */
#define FF_SIMPLICES_MAX_POINTS 64

/* Corners of one simplex, indices of points; unused are -1. */
typedef struct ff_simplex {
    int vertex[4];
} ff_simplex;

/* Delaunay simplices of count points: tetrahedra, or triangles, segments or a single point when the points lie (within
 * 2 cm/s) in a plane, on a line or in one place. Appends ff_simplex to out. Points that coincide with an earlier one
 * are left out. */
ff_status ff_simplices_find(const ff_vec3 *points, int count, ff_array *out, ff_error *error);

#endif
