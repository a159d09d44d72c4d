/* nav_time.h - time to collision of a moving disc with discs and walls (algorithms C.2). */
#ifndef FF_NAV_TIME_H
#define FF_NAV_TIME_H

#include "runtime/core/base/maths.h"

/* A static segment, solid from both sides. */
typedef struct ff_wall {
    ff_vec2 from, to; /* m */
    ff_vec2 along;    /* unit, from -> to */
    double length;    /* m, > 0 */
} ff_wall;

ff_wall ff_wall_between(ff_vec2 from, ff_vec2 to);
ff_vec2 ff_wall_nearest(const ff_wall *wall, ff_vec2 p);

/* Seconds until two discs touch: x = p_i - p_j, v = v_i - v_j, reach = r_i + r_j. 0 when they overlap now,
 * INFINITY when they never meet. */
static inline double ff_time_to_disc(ff_vec2 x, ff_vec2 v, double reach)
{
    double square = ff_dot2(v, v), closing = -ff_dot2(x, v), gap = ff_dot2(x, x) - reach * reach;
    if (gap <= 0.0) return 0.0;
    double discriminant = closing * closing - square * gap;
    if (closing <= 0.0 || square < 1e-9 || discriminant <= 0.0) return INFINITY;
    /* (B - D) / A written as C / (B + D): no cancellation when the two nearly touch. */
    return gap / (closing + sqrt(discriminant));
}

/* Seconds until a disc at p with velocity v touches the wall; the same conventions. *gradient (may be NULL) =
 * derivative by p: where to shift so that the contact comes later; the way out for an overlap, 0 for INFINITY. */
double ff_time_to_wall(const ff_wall *wall, ff_vec2 p, ff_vec2 v, double radius, ff_vec2 *gradient);

/* d tau / d x for a tau of ff_time_to_disc in (0, INFINITY). */
ff_vec2 ff_time_to_disc_gradient(ff_vec2 x, ff_vec2 v, double reach);

#endif
