#include "preprocess/examples/correspond.h"

#include "runtime/core/base/fail.h"

#include <stdlib.h>
#include <string.h>

#define GRAIN                                                                                                \
    65536.0 /* phases are multiples of its inverse, so that the last bits of an optimiser do not matter */
#define ENOUGH 2      /* fewer minima than this: look at the keys */
#define VALLEY_HALF 8 /* cells */
#define WARP_SAMPLES 32

static double fraction(double x)
{
    return x - floor(x);
}

/* ------------------------------------------------------------------------------------------------------ selection */

/* A cell of the map. */
typedef struct moment {
    double distance;
    int row, column;
    bool minimum; /* else only on the floor of a valley */
} moment;

static int by_worth(const void *x, const void *y)
{
    const moment *a = x, *b = y;
    if (a->minimum != b->minimum) return a->minimum ? -1 : 1;
    if (a->distance != b->distance) return a->distance < b->distance ? -1 : 1;
    if (a->row != b->row) return a->row - b->row;
    return a->column - b->column;
}

/* Not above any of its eight neighbours; of equal ones the first counts. */
static bool is_minimum(const double *map, int row, int column)
{
    const int n = FF_MAP_SIDE;
    double here = map[row * n + column];
    for (int i = -1; i <= 1; ++i) {
        for (int k = -1; k <= 1; ++k) {
            if (i == 0 && k == 0) continue;
            double there = map[(row + i + n) % n * n + (column + k + n) % n];
            bool earlier = i < 0 || (i == 0 && k < 0);
            if (there < here || (there == here && earlier)) return false;
        }
    }
    return true;
}

/* Not above what lies across the diagonal, where one cycle is early and the other late. */
static bool is_valley(const double *map, int row, int column)
{
    const int n = FF_MAP_SIDE;
    double here = map[row * n + column];
    for (int d = 1; d <= VALLEY_HALF; ++d)
        if (map[(row + d) % n * n + (column - d + n) % n] < here ||
            map[(row - d + n) % n * n + (column + d) % n] < here)
            return false;
    return true;
}

static bool far_enough(const double *x, const double *y, double spacing)
{
    for (int i = 0; i < 2; ++i) {
        double d = fraction(x[i] - y[i]);
        if (ff_min(d, 1.0 - d) < spacing - 1e-12) return false;
    }
    return true;
}

/* Put a pair in its place, unless it is too near another one or would break the cyclic order. */
static bool insert(ff_cycle_pairs *pairs, const double phase[2], double spacing)
{
    int n = pairs->count, at = 0;
    if (n == FF_PAIRS_MAX) return false;
    for (int i = 0; i < n; ++i) {
        if (!far_enough(phase, pairs->pair[i].phase, spacing)) return false;
        if (pairs->pair[i].phase[0] < phase[0]) at = i + 1;
    }
    if (n > 1) {
        double before = pairs->pair[(at + n - 1) % n].phase[1], after = pairs->pair[at % n].phase[1];
        if (fraction(phase[1] - before) >= fraction(after - before)) return false;
    }
    memmove(&pairs->pair[at + 1], &pairs->pair[at], (size_t)(n - at) * sizeof *pairs->pair);
    pairs->pair[at] = (ff_cycle_pair){.phase = {phase[0], phase[1]}};
    ++pairs->count;
    return true;
}

/* Minima first, best ones first; then moments between them where the map is low too, as nobody should wait. */
static ff_status select_moments(const ff_correspondence_settings *set, const double *map, ff_cycle_pairs *out,
                                ff_error *error)
{
    moment *found = malloc(FF_MAP_SIDE * FF_MAP_SIDE * sizeof *found);
    if (!found) return ff_fail(error, FF_ERR_NO_MEMORY, "the minima of a distance map");
    int count = 0;
    for (int row = 0; row < FF_MAP_SIDE; ++row) {
        for (int column = 0; column < FF_MAP_SIDE; ++column) {
            double distance = map[row * FF_MAP_SIDE + column];
            if (distance > set->window) continue;
            bool minimum = is_minimum(map, row, column);
            if (minimum || is_valley(map, row, column))
                found[count++] = (moment){distance, row, column, minimum};
        }
    }
    qsort(found, (size_t)count, sizeof *found, by_worth);
    for (int i = 0; i < count; ++i) {
        const double phase[2] = {found[i].row / (double)FF_MAP_SIDE, found[i].column / (double)FF_MAP_SIDE};
        insert(out, phase, set->spacing);
    }
    free(found);
    return FF_OK;
}

/* ------------------------------------------------------------------------------------------------------ measuring */

static void measure(const ff_point_cycle *first, const ff_point_cycle *second, ff_cycle_pair *pair)
{
    ff_vec3 a[FF_CLOUD_MAX], b[FF_CLOUD_MAX];
    int count = first->point_count, middle = FF_WINDOW / 2 * count;
    ff_cycle_window(first, pair->phase[0], a, NULL);
    ff_cycle_window(second, pair->phase[1], b, NULL);
    pair->alignment = ff_cloud_align(a, b, first->weights, count, FF_WINDOW * count);
    pair->distance = ff_cloud_distance(a, b, first->weights, count, FF_WINDOW * count, &pair->alignment);
    pair->rms = ff_cloud_distance(a + middle, b + middle, NULL, count, count, &pair->alignment);
}

/* Measure pairs and let go of those beyond limit or, after refinement, out of order. */
static void keep_good(const ff_correspondence_settings *set, const ff_cycle_side *first,
                      const ff_cycle_side *second, double limit, ff_cycle_pairs *pairs)
{
    ff_cycle_pairs all = *pairs;
    pairs->count = 0;
    for (int i = 0; i < all.count; ++i) {
        double phase[2];
        for (int k = 0; k < 2; ++k)
            phase[k] = fraction(floor(all.pair[i].phase[k] * GRAIN + 0.5) / GRAIN);
        ff_cycle_pair pair = {.phase = {phase[0], phase[1]}};
        measure(first->cycle, second->cycle, &pair);
        if (pair.distance > set->window || pair.rms > limit || !insert(pairs, phase, set->spacing)) continue;
        for (int k = 0; k < pairs->count; ++k)
            if (pairs->pair[k].phase[0] == phase[0]) pairs->pair[k] = pair;
    }
}

static void find_waits(const ff_cycle_side *first, const ff_cycle_side *second, ff_cycle_pairs *pairs)
{
    const double period[2] = {first->cycle->period, second->cycle->period};
    for (int side = 0; side < 2; ++side) {
        pairs->wait[side] = pairs->count == 1 ? period[side] : 0.0;
        for (int i = 0; i < pairs->count && pairs->count > 1; ++i) {
            double next = pairs->pair[(i + 1) % pairs->count].phase[side];
            pairs->wait[side] =
                ff_max(pairs->wait[side], period[side] * fraction(next - pairs->pair[i].phase[side]));
        }
    }
}

/* Where in the second cycle the straight lines between the pairs come by at a phase of the first. */
static double warp_at(const ff_cycle_pairs *pairs, double phase)
{
    int n = pairs->count, i = n - 1;
    for (int k = 0; k < n; ++k)
        if (pairs->pair[k].phase[0] <= phase) i = k;
    if (phase < pairs->pair[0].phase[0]) i = n - 1;
    const double *from = pairs->pair[i].phase, *to = pairs->pair[(i + 1) % n].phase;
    double length = n == 1 ? 1.0 : fraction(to[0] - from[0]),
           other = n == 1 ? 1.0 : fraction(to[1] - from[1]);
    return from[1] + fraction(phase - from[0]) / length * other;
}

static void find_mean(const ff_cycle_side *first, const ff_cycle_side *second, ff_cycle_pairs *pairs)
{
    pairs->mean = 0.0;
    for (int i = 0; i < WARP_SAMPLES; ++i) {
        ff_cycle_pair pair = {.phase = {i / (double)WARP_SAMPLES, 0.0}};
        pair.phase[1] = warp_at(pairs, pair.phase[0]);
        measure(first->cycle, second->cycle, &pair);
        pairs->mean += pair.distance / WARP_SAMPLES;
    }
}

/* ------------------------------------------------------------------------------------------------------ all of it */

/* The same event of the same foot in both: always in order. */
static void pairs_of_keys(const ff_correspondence_settings *set, const ff_cycle_side *first,
                          const ff_cycle_side *second, ff_cycle_pairs *out)
{
    memset(out, 0, sizeof *out);
    out->by_keys = true;
    if (!first->keys || !second->keys) return;
    for (int k = 0; k < 4; ++k) {
        const double phase[2] = {(double)first->keys[k], (double)second->keys[k]};
        insert(out, phase, set->spacing);
    }
}

ff_status ff_correspond(const ff_correspondence_settings *settings, const ff_cycle_side *first,
                        const ff_cycle_side *second, double limit, double *map, ff_cycle_pairs *out,
                        ff_error *error)
{
    memset(out, 0, sizeof *out);
    ff_distance_map(first->windows, second->windows, map);
    ff_status status = select_moments(settings, map, out, error);
    if (status == FF_OK && out->count > 0)
        status = ff_correspond_refine(first->cycle, second->cycle, 1.0 / FF_MAP_SIDE, out, error);
    if (status != FF_OK) return status;
    keep_good(settings, first, second, limit, out);
    if (out->count < ENOUGH) {
        ff_cycle_pairs keys;
        pairs_of_keys(settings, first, second, &keys);
        keep_good(settings, first, second, limit, &keys);
        if (keys.count > out->count) *out = keys;
    }
    if (out->count == 0) return FF_OK;
    find_waits(first, second, out);
    find_mean(first, second, out);
    return FF_OK;
}
