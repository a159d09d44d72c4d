#define _POSIX_C_SOURCE 199309L
#include "runtime/program/plan_load.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/base/random.h"

#include <stdlib.h>
#include <time.h>

static const double VIEW = 9.0, CLEAR = 1.2, SPACIOUS = 0.25; /* m, m, people per m2 */
enum { WARM_UP = 10 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ------------------------------------------------------------------------------------------------------- street */

/* What one who stands in the middle takes up, whichever way he faces. Plans in force are free of each other, so the others keep off his;
 * nobody could plan his way out of theirs otherwise. */
static ff_shape room_of_standing(const ff_action_set *set)
{
    ff_plan stand;
    ff_track track;
    ff_plan_stand(set, ff_v2(0.0, 0.0), 0.0, 0.0, &stand);
    ff_plan_track(set, &stand, 0.0, &track);
    return (ff_shape){.radius = (double)track.radius[0], .high = 1.9};
}

/* Somebody at a random free place, on his way across. */
static void add_walker(ff_plan_street *s, double radius, const ff_shape *middle, ff_random *random)
{
    ff_plan *plan = &s->plans[s->count];
    ff_track *track = &s->tracks[s->count];
    ff_plan_options options = ff_plan_options_default();
    options.inflation_step = 0.0;
    for (int attempt = 0; attempt < 1000; ++attempt) {
        ff_vec2 at = ff_scale2(ff_fwd2(ff_random_range(random, -FF_PI, FF_PI)),
                               CLEAR + (radius - CLEAR) * sqrt(ff_random_unit(random)));
        ff_plan_stand(s->set, at, ff_random_range(random, -FF_PI, FF_PI), -1.0, plan);
        ff_plan_track(s->set, plan, 0.0, track);
        bool free_place = true;
        for (uint32_t i = 0; i < s->count && free_place; ++i)
            free_place = !ff_track_conflict(track, s->list[i], -1.0, 0.1, NULL);
        if (!free_place) continue;
        const ff_plan_world world = {
            .tracks = s->list, .track_count = s->count, .shapes = middle, .shape_count = 1};
        ff_plan_goal goal =
            ff_plan_goal_at(ff_scale2(ff_fwd2(ff_random_range(random, -FF_PI, FF_PI)), radius));
        ff_plan_search(s->set, &world, plan, -1.0, &goal, &options, s->scratch, plan);
        ff_plan_track(s->set, plan, -1.0, track);
        s->list[s->count++] = track;
        return;
    }
}

ff_status ff_plan_street_create(const ff_action_set *set, ff_plan_scratch *scratch, uint32_t count,
                                uint64_t seed, ff_plan_street *out, ff_error *error)
{
    *out = (ff_plan_street){.set = set, .scratch = scratch};
    out->plans = ff_calloc(count, sizeof *out->plans);
    out->tracks = ff_calloc(count, sizeof *out->tracks);
    out->list = ff_calloc(count, sizeof(const ff_track *));
    if (!out->plans || !out->tracks || !out->list)
        return ff_fail(error, FF_ERR_NO_MEMORY, "the plans of %u people", count);
    double radius = ff_min(VIEW, CLEAR + sqrt(count / (SPACIOUS * FF_PI)));
    const ff_shape middle = room_of_standing(set);
    ff_random random = {seed, 0, 0};
    for (uint32_t i = 0; i < count; ++i)
        add_walker(out, radius, &middle, &random);
    return FF_OK;
}

void ff_plan_street_destroy(ff_plan_street *street)
{
    free(street->plans);
    free(street->tracks);
    free(street->list);
}

/* ------------------------------------------------------------------------------------------------------ measuring */

static int by_value(const void *x, const void *y)
{
    const double *p = x, *q = y;
    return (*p > *q) - (*p < *q);
}

static double at_share(double *values, uint32_t count, double share)
{
    if (count == 0) return 0.0;
    qsort(values, count, sizeof *values, by_value);
    return values[(uint32_t)(share * (count - 1))];
}

typedef struct sums {
    double seconds, expanded, generated, tested, progress;
    uint32_t outcome[FF_PLAN_NONE + 1], ratios;
} sums;

/* One search; its figures into the sums and the lists. */
static void search_one(const ff_plan_street *street, const ff_plan_options *options, uint32_t number,
                       double distance, double exact, sums *sum, double *ms, double *expanded, double *ratio,
                       double *cost)
{
    ff_random random = {7, number, 0};
    ff_plan start, plan;
    ff_plan_stand(street->set, ff_v2(0.0, 0.0), ff_random_range(&random, -FF_PI, FF_PI), -1.0, &start);
    ff_plan_goal goal =
        ff_plan_goal_at(ff_scale2(ff_fwd2(ff_random_range(&random, -FF_PI, FF_PI)), distance));
    const ff_plan_world world = {.tracks = street->list, .track_count = street->count};
    plan = start;
    double begun = now();
    ff_plan_result result =
        ff_plan_search(street->set, &world, &start, 0.0, &goal, options, street->scratch, &plan);
    double seconds = now() - begun;
    sum->seconds += seconds;
    sum->expanded += result.expanded;
    sum->generated += result.generated;
    sum->tested += result.tested;
    ++sum->outcome[result.outcome];
    sum->progress +=
        distance - ff_length2(ff_sub2(ff_plan_root_at(street->set, &plan, 1e6).position, goal.at));
    ms[number] = 1e3 * seconds;
    expanded[number] = result.expanded;
    *cost = result.outcome == FF_PLAN_REACHED ? result.cost : -1.0;
    if (*cost >= 0.0 && exact > 0.0) ratio[sum->ratios++] = *cost / exact;
}

/* Of those of a street. */
static uint32_t first_problem(uint32_t street, uint32_t problems, uint32_t street_count)
{
    return (uint32_t)((uint64_t)problems * street / street_count);
}

/* The highest median of a street; sorts each street's. */
static double worst_median(double *ms, uint32_t problems, uint32_t street_count)
{
    double worst = 0.0;
    for (uint32_t s = 0; s < street_count; ++s) {
        uint32_t first = first_problem(s, problems, street_count),
                 last = first_problem(s + 1, problems, street_count);
        worst = ff_max(worst, at_share(ms + first, last - first, 0.5));
    }
    return worst;
}

ff_status ff_plan_load_measure(const ff_plan_street *streets, uint32_t street_count,
                               const ff_plan_options *options, uint32_t problems, double distance,
                               const double *exact, double *costs, ff_plan_load *out, ff_error *error)
{
    double *ms = ff_calloc(problems, sizeof *ms), *expanded = ff_calloc(problems, sizeof *expanded);
    double *ratio = ff_calloc(problems, sizeof *ratio);
    sums sum = {0}, none = {0};
    if (ms && expanded && ratio) {
        for (uint32_t s = 0; s < street_count; ++s) {
            const ff_plan_street *street = &streets[s];
            uint32_t first = first_problem(s, problems, street_count),
                     last = first_problem(s + 1, problems, street_count);
            double cost;
            /* Memory and tables are touched before anything is measured, as in a crowd that has walked for a while. */
            for (uint32_t i = first; i < last && i < first + WARM_UP; ++i)
                search_one(street, options, i, distance, 0.0, &none, ms, expanded, ratio, &cost);
            for (uint32_t i = first; i < last; ++i) {
                search_one(street, options, i, distance, exact ? exact[i] : 0.0, &sum, ms, expanded, ratio,
                           &cost);
                if (costs) costs[i] = cost;
            }
        }
        *out = (ff_plan_load){.expanded_median = at_share(expanded, problems, 0.5),
                              .expanded_p90 = at_share(expanded, problems, 0.9),
                              .children_per_s = sum.generated / sum.seconds,
                              .expanded_per_s = sum.expanded / sum.seconds,
                              .tested_per_s = sum.tested / sum.seconds,
                              .ms_worst = worst_median(ms, problems, street_count),
                              .reached = (double)sum.outcome[FF_PLAN_REACHED] / problems,
                              .ahead = (double)sum.outcome[FF_PLAN_AHEAD] / problems,
                              .part = (double)sum.outcome[FF_PLAN_PART] / problems,
                              .none = (double)sum.outcome[FF_PLAN_NONE] / problems,
                              .ratio_median = at_share(ratio, sum.ratios, 0.5),
                              .ratio_p95 = at_share(ratio, sum.ratios, 0.95),
                              .progress = sum.progress / problems};
        out->ms_median = at_share(ms, problems, 0.5);
        out->ms_p99 = at_share(ms, problems, 0.99);
    }
    bool good = ms && expanded && ratio;
    free(ms);
    free(expanded);
    free(ratio);
    return good ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "the figures of %u searches", problems);
}
