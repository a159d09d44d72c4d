/* plan_field.h - the way to a goal past what does not move, on a grid: how far it is from anywhere, for the heuristic of a
 * search. */
#ifndef FF_PLAN_FIELD_H
#define FF_PLAN_FIELD_H

#include "runtime/core/plan/plan.h"

struct ff_field {
    ff_vec2 corner;  /* middle of cell [0][0] */
    double cell;     /* m */
    uint32_t side;   /* cells */
    float *distance; /* [side][side] m, at most the true one; INFINITY where nobody fits or no way leads */
};

/* m to the goal from p, at most; negative when the field does not say. */
double ff_field_distance(const ff_field *field, ff_vec2 p);

/* The way down from p to the goal, a cell or two at a time: at most `most` places, p not among them. Returns how many; 0 when
 * the field does not say. */
uint32_t ff_field_path(const ff_field *field, ff_vec2 p, ff_vec2 *out, uint32_t most);

#endif
