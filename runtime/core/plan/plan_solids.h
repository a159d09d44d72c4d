/* plan_solids.h - what does not move, and whether colliders that move straight touch it. */
#ifndef FF_PLAN_SOLIDS_H
#define FF_PLAN_SOLIDS_H

#include "runtime/core/plan/plan.h"

/* A shape, ready for tests: axis = the unit vector of its length. */
typedef struct ff_solid {
    ff_vec2 centre, axis;
    double half_length, half_width, radius;
    double low, high;
    double bound; /* m, about the centre, holds all of it */
    uint32_t round, reserved;
} ff_solid;

ff_solid ff_solid_of_shape(const ff_shape *shape);
ff_solid ff_solid_of_wall(ff_vec2 from, ff_vec2 to);

/* Squared distance of the segment from p to q to the footprint without its radius; 0 when they meet. */
double ff_solid_distance2(const ff_solid *solid, ff_vec2 p, ff_vec2 q);

/* Do the colliders, moving straight from x0 to x1 (knots about origin), come nearer than their radii and margin to a solid that moves from
 * where it is by `moved` meanwhile? */
bool ff_solid_hit(const ff_solid *solid, ff_vec2 moved, ff_vec2 origin, const ff_knot *x0, const ff_knot *x1,
                  const float *radii, double margin);

struct ff_solids {
    ff_solid *items;
    double (*box)[4]; /* [2 * leaves]: low a, low b, high a, high b; node 1 is the root */
    uint32_t count, leaves;
};

/* None yet, with room for so many; and one more of them. */
ff_status ff_solids_reserve(uint32_t capacity, ff_solids **out, ff_error *error);
void ff_solids_add(ff_solids *solids, ff_solid solid);

/* Is any within the radius of p? */
bool ff_solids_near(const ff_solids *solids, ff_vec2 p, double radius);

/* Do colliders that move along knots[0 .. count - 1] about origin touch any? They stay within radius of centre. */
bool ff_solids_hit(const ff_solids *solids, ff_vec2 centre, double radius, ff_vec2 origin,
                   const ff_knot *knots, uint32_t count, const float *radii, double margin);

#endif
