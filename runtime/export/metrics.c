#include "runtime/export/metrics.h"

#include "runtime/core/base/fail.h"

#include <stdlib.h>
#include <string.h>

double ff_closest_distance(ff_vec2 p, ff_vec2 v)
{
    double squared = ff_dot2(v, v);
    double s = squared < 1e-24 ? 0.0 : ff_clamp(-ff_dot2(p, v) / squared, 0.0, 1.0);
    return ff_length2(ff_madd2(p, v, s));
}

double ff_penetration(double distance, double radius_sum)
{
    return radius_sum > 0.0 ? ff_max(0.0, 1.0 - distance / radius_sum) : 0.0;
}

ff_status ff_collisions_create(uint32_t agents, ff_collisions *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    out->agent_count = agents;
    out->seen = ff_calloc((size_t)agents * agents / 8 + 1, 1);
    return out->seen ? FF_OK
                     : ff_fail(error, FF_ERR_NO_MEMORY, "no memory to count pairs of %u agents", agents);
}

void ff_collisions_free(ff_collisions *collisions)
{
    free(collisions->seen);
    memset(collisions, 0, sizeof *collisions);
}

static void count_pair(ff_collisions *collisions, uint32_t i, uint32_t j)
{
    size_t bit = (size_t)i * collisions->agent_count + j;
    uint8_t mask = (uint8_t)(1u << (bit & 7u));
    if (collisions->seen[bit >> 3] & mask) return;
    collisions->seen[bit >> 3] |= mask;
    ++collisions->pairs;
}

void ff_collisions_add(ff_collisions *collisions, const ff_track *before, const ff_track *after,
                       const double *radii)
{
    for (uint32_t i = 0; i < collisions->agent_count; ++i) {
        if (!before[i].present || !after[i].present) continue;
        ++collisions->agent_steps;
        ff_vec2 moved = ff_sub2(after[i].position, before[i].position);
        for (uint32_t j = i + 1; j < collisions->agent_count; ++j) {
            if (!before[j].present || !after[j].present) continue;
            ff_vec2 p = ff_sub2(before[i].position, before[j].position);
            ff_vec2 v = ff_sub2(moved, ff_sub2(after[j].position, before[j].position));
            double sum = radii[i] + radii[j];
            /* Too far apart to meet within the interval, whatever the directions. */
            if (ff_dot2(p, p) > 2.0 * (sum * sum + ff_dot2(v, v))) continue;
            double distance = ff_closest_distance(p, v);
            if (distance >= sum) continue;
            collisions->sum += ff_penetration(distance, sum);
            collisions->deepest = ff_max(collisions->deepest, sum - distance);
            if (sum - distance > FF_OVERLAP_LEAST) count_pair(collisions, i, j);
        }
    }
}

double ff_collision_rate(const ff_collisions *collisions)
{
    return collisions->agent_steps ? collisions->sum / (double)collisions->agent_steps : 0.0;
}

void ff_acceleration_add(const ff_vec2 *points, size_t count, size_t window, double step, double still,
                         double *sum, uint64_t *terms)
{
    double span = (double)window * step;
    for (size_t k = 0; k + window + 1 < count; ++k) {
        ff_vec2 now = ff_sub2(points[k + window], points[k]);
        ff_vec2 next = ff_sub2(points[k + window + 1], points[k + 1]);
        if (ff_max(ff_dot2(now, now), ff_dot2(next, next)) < still * still * span * span) continue;
        *sum += ff_length2(ff_sub2(next, now)) / (span * step);
        ++*terms;
    }
}

static int compare_doubles(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return a < b ? -1 : (a > b ? 1 : 0);
}

double ff_quantile(double *values, size_t count, double q)
{
    if (count == 0) return 0.0;
    qsort(values, count, sizeof *values, compare_doubles);
    double place = ff_clamp(q, 0.0, 1.0) * (double)(count - 1);
    size_t low = (size_t)place;
    size_t high = low + 1 < count ? low + 1 : low;
    return ff_lerp(values[low], values[high], place - (double)low);
}
