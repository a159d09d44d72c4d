/* nav_solve.h - the small linear programmes of ORCA (van den Berg et al. 2011; algorithms C.8).
 *
 * A line is the half-plane to the LEFT of its direction: v is feasible when det(direction, v - point) >= 0.
 */
#ifndef FF_NAV_SOLVE_H
#define FF_NAV_SOLVE_H

#include "runtime/core/base/maths.h"

typedef struct ff_line {
    ff_vec2 point;     /* m/s */
    ff_vec2 direction; /* unit */
    double weight;     /* > 0, how much a violation counts in ff_solve_dense */
} ff_line;

typedef struct ff_circle {
    ff_vec2 centre; /* m/s */
    double radius;  /* m/s */
} ff_circle;

#define FF_LINES_MAX 64

/* How far velocity v is on the wrong side: positive when line is violated. */
static inline double ff_line_violation(ff_line line, ff_vec2 v)
{
    return ff_det2(line.direction, ff_sub2(line.point, v));
}

/* The velocity nearest to wish inside circle and all lines. Returns count, or the index of the first line that
 * cannot be satisfied together with those before it; *out then satisfies those. count <= FF_LINES_MAX. */
uint32_t ff_solve_nearest(const ff_line *lines, uint32_t count, ff_circle circle, ff_vec2 wish, ff_vec2 *out);

/* Lines [0, hard) hold; of the soft lines [hard, count) the largest weight * violation is made as small as
 * possible. first_failed and *out come from ff_solve_nearest over the same lines. */
void ff_solve_dense(const ff_line *lines, uint32_t count, uint32_t hard, uint32_t first_failed,
                    ff_circle circle, ff_vec2 *out);

#endif
