#define _POSIX_C_SOURCE 199309L
#include "runtime/program/circles_load.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/base/random.h"
#include "runtime/export/detour.h"
#include "runtime/export/metrics.h"

#include <stdlib.h>
#include <time.h>

#define STEP (1.0 / 30.0) /* s */
#define SPEED 1.3         /* m/s */
#define WARM 90           /* steps: 3.9 of the 6.4 m to the centre are done */
#define MEASURED 60       /* steps */
#define JITTER 0.01       /* rad */

/* Of this thread: not what other programs take. */
static double cpu_time(void)
{
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static uint32_t circle_count(uint32_t people)
{
    return (people + FF_CIRCLE_PEOPLE - 1) / FF_CIRCLE_PEOPLE;
}

static uint32_t side_of(uint32_t people)
{
    return (uint32_t)ceil(sqrt(circle_count(people)));
}

void ff_circle_places(uint32_t count, ff_circle_place *out)
{
    uint32_t circles = circle_count(count), side = side_of(count);
    ff_random random = {6, count, 0};
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t circle = i % circles, seat = i / circles, people = (count - circle + circles - 1) / circles;
        ff_vec2 centre = ff_v2((circle % side - 0.5 * (side - 1)) * FF_CIRCLE_PITCH,
                               (circle / side - 0.5 * (side - 1)) * FF_CIRCLE_PITCH);
        ff_vec2 arm = ff_scale2(ff_fwd2(FF_TAU * seat / people + ff_random_range(&random, -JITTER, JITTER)),
                                FF_CIRCLE_RADIUS);
        out[i] = (ff_circle_place){ff_add2(centre, arm), ff_sub2(centre, arm)};
    }
    for (uint32_t i = count - 1; i > 0; --i) {
        uint32_t other = (uint32_t)ff_random_range(&random, 0.0, i + 1.0);
        ff_circle_place swap = out[i];
        out[i] = out[other];
        out[other] = swap;
    }
}

static ff_status populate(ff_crowd *crowd, const ff_circle_place *places, uint32_t count, ff_error *error)
{
    ff_status status = FF_OK;
    for (uint32_t i = 0; i < count && status == FF_OK; ++i) {
        ff_agent agent;
        ff_agent_def def = ff_agent_def_default();
        ff_vec2 way = ff_sub2(places[i].goal, places[i].from);
        def.position = places[i].from;
        def.goal = places[i].goal;
        def.heading = ff_atan2(way.b, way.a);
        def.preferred_speed = SPEED;
        status = ff_crowd_add_agent(crowd, &def, &agent, error);
    }
    return status;
}

enum { NAVIGATION, STEPS, MATRICES, COUPLING, PHASES };

/* Seconds that the phases have taken so far. */
static void phases_of(const ff_crowd *crowd, double phase[PHASES])
{
    ff_crowd_timings spent = ff_crowd_time_spent(crowd);
    phase[NAVIGATION] = spent.neighbours + spent.navigation;
    phase[STEPS] = spent.synthesis;
    phase[MATRICES] = spent.matrices;
    phase[COUPLING] = spent.snapshot + spent.bodies;
}

typedef struct step_log {
    double total[MEASURED], phase[PHASES][MEASURED];
} step_log;

static double median_us(double *seconds, uint32_t count)
{
    return 1e6 * ff_quantile(seconds, MEASURED, 0.5) / count;
}

static ff_load_times times_of(step_log *log, uint32_t count)
{
    return (ff_load_times){median_us(log->total, count), median_us(log->phase[NAVIGATION], count),
                           median_us(log->phase[STEPS], count), median_us(log->phase[MATRICES], count),
                           median_us(log->phase[COUPLING], count)};
}

static ff_status measure_steps(ff_crowd *crowd, uint32_t count, ff_matrix *matrices, ff_load_times *out,
                               ff_error *error)
{
    step_log log;
    ff_status status = FF_OK;
    for (int i = 0; i < WARM + MEASURED && status == FF_OK; ++i) {
        double before[PHASES], after[PHASES], start = cpu_time();
        phases_of(crowd, before);
        ff_crowd_step(crowd);
        status = ff_crowd_matrices(crowd, ff_v2(0.0, 0.0), matrices, count, error);
        if (i < WARM) continue;
        log.total[i - WARM] = cpu_time() - start;
        phases_of(crowd, after);
        for (int p = 0; p < PHASES; ++p)
            log.phase[p][i - WARM] = after[p] - before[p];
    }
    *out = times_of(&log, count);
    return status;
}

ff_status ff_circles_measure(const ff_pack *pack, ff_navigation method, uint32_t count, ff_load_times *out,
                             ff_error *error)
{
    ff_crowd *crowd = NULL;
    ff_crowd_def def = ff_crowd_def_default();
    ff_circle_place *places = ff_calloc(count, sizeof *places);
    ff_matrix *matrices = ff_calloc((size_t)count * ff_pack_joint_count(pack), sizeof *matrices);
    def.max_agents = count;
    def.navigation = method;
    def.step = STEP;
    ff_status status = places && matrices
                           ? ff_crowd_create(pack, &def, &crowd, error)
                           : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u agents", count);
    if (status == FF_OK) {
        ff_circle_places(count, places);
        status = populate(crowd, places, count, error);
    }
    if (status == FF_OK) status = measure_steps(crowd, count, matrices, out, error);
    ff_crowd_destroy(crowd);
    free(matrices);
    free(places);
    return status;
}

ff_status ff_circles_measure_detour(uint32_t count, ff_load_times *out, ff_error *error)
{
    ff_detour *detour = NULL;
    ff_circle_place *places = ff_calloc(count, sizeof *places);
    ff_detour_agent *walkers = ff_calloc(count, sizeof *walkers);
    ff_status status =
        places && walkers ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u agents", count);
    double seconds[MEASURED];
    if (status == FF_OK) {
        ff_circle_places(count, places);
        for (uint32_t i = 0; i < count; ++i)
            walkers[i] = (ff_detour_agent){places[i].from, places[i].goal, 0.3, SPEED};
        status =
            ff_detour_create(walkers, count, 0.5 * FF_CIRCLE_PITCH * (side_of(count) + 1), &detour, error);
    }
    for (int i = 0; i < WARM + MEASURED && status == FF_OK; ++i) {
        double start = cpu_time();
        ff_detour_step(detour, STEP);
        if (i >= WARM) seconds[i - WARM] = cpu_time() - start;
    }
    if (status == FF_OK) {
        double us = median_us(seconds, count);
        *out = (ff_load_times){.total = us, .navigation = us};
    }
    ff_detour_destroy(detour);
    free(walkers);
    free(places);
    return status;
}
