#include "runtime/core/nav/nav_solve.h"

/* Two lines whose directions' determinant is smaller than this are parallel. */
#define PARALLEL 1e-5

typedef enum aim_kind {
    NEAREST,
    FARTHEST
} aim_kind; /* nearest to a velocity, or farthest along a unit vector */

typedef struct lp_aim {
    aim_kind kind;
    ff_vec2 wish;
} lp_aim;

/* Best point of lines[k] inside the circle and the lines before it. */
static bool solve_on_line(const ff_line *lines, uint32_t k, ff_circle circle, lp_aim aim, ff_vec2 *out)
{
    ff_vec2 start = ff_sub2(lines[k].point, circle.centre), d = lines[k].direction;
    double middle = ff_dot2(start, d);
    double square = middle * middle + circle.radius * circle.radius - ff_dot2(start, start);
    if (!(square >= 0.0)) return false;
    double half = sqrt(square);
    double low = -middle - half, high = -middle + half;
    for (uint32_t i = 0; i < k; ++i) {
        double slope = ff_det2(d, lines[i].direction);
        double room = ff_det2(lines[i].direction, ff_sub2(lines[k].point, lines[i].point));
        if (fabs(slope) <= PARALLEL) {
            if (room < 0.0) return false;
        } else if (slope > 0.0) {
            high = ff_min(high, room / slope);
        } else {
            low = ff_max(low, room / slope);
        }
        if (low > high) return false;
    }
    double t;
    if (aim.kind == FARTHEST) {
        t = ff_dot2(aim.wish, d) > 0.0 ? high : low;
    } else {
        t = ff_clamp(ff_dot2(d, ff_sub2(aim.wish, lines[k].point)), low, high);
    }
    *out = ff_madd2(lines[k].point, d, t);
    return true;
}

static ff_vec2 solve_in_circle(ff_circle circle, lp_aim aim)
{
    if (aim.kind == FARTHEST) return ff_madd2(circle.centre, aim.wish, circle.radius);
    ff_vec2 offset = ff_sub2(aim.wish, circle.centre);
    double length = ff_length2(offset);
    if (length <= circle.radius) return aim.wish;
    return ff_madd2(circle.centre, offset, circle.radius / length);
}

static uint32_t solve(const ff_line *lines, uint32_t count, ff_circle circle, lp_aim aim, ff_vec2 *out)
{
    *out = solve_in_circle(circle, aim);
    for (uint32_t k = 0; k < count; ++k) {
        if (ff_line_violation(lines[k], *out) > 0.0 && !solve_on_line(lines, k, circle, aim, out)) return k;
    }
    return count;
}

uint32_t ff_solve_nearest(const ff_line *lines, uint32_t count, ff_circle circle, ff_vec2 wish, ff_vec2 *out)
{
    return solve(lines, count, circle, (lp_aim){NEAREST, wish}, out);
}

/* The velocities where soft line j is violated no more than soft line i, weights counted: a half-plane. With equal
 * weights this is RVO2's bisector. False when it is everything or nothing. */
static bool no_worse_than(ff_line i, ff_line j, ff_line *out)
{
    ff_vec2 difference = ff_sub2(ff_scale2(j.direction, j.weight), ff_scale2(i.direction, i.weight));
    double length = ff_length2(difference);
    if (length < 1e-9) return false;
    double offset = j.weight * ff_det2(j.direction, j.point) - i.weight * ff_det2(i.direction, i.point);
    ff_vec2 direction = ff_scale2(difference, 1.0 / length);
    *out = (ff_line){ff_scale2(ff_left2(direction), offset / length), direction, 1.0};
    return true;
}

void ff_solve_dense(const ff_line *lines, uint32_t count, uint32_t hard, uint32_t first_failed,
                    ff_circle circle, ff_vec2 *out)
{
    ff_line tight[FF_LINES_MAX];
    double bound = 0.0;
    for (uint32_t k = 0; k < hard; ++k)
        tight[k] = lines[k];
    for (uint32_t i = first_failed; i < count; ++i) {
        if (lines[i].weight * ff_line_violation(lines[i], *out) <= bound) continue;
        uint32_t tight_count = hard;
        for (uint32_t j = hard; j < i; ++j)
            if (no_worse_than(lines[i], lines[j], &tight[tight_count])) ++tight_count;
        ff_vec2 best;
        lp_aim inward = {FARTHEST, ff_left2(lines[i].direction)};
        /* It can fail only by rounding, as the last result is feasible: keep that. */
        if (solve(tight, tight_count, circle, inward, &best) == tight_count) *out = best;
        bound = ff_max(bound, lines[i].weight * ff_line_violation(lines[i], *out));
    }
}
