/* What a crowd costs, per agent and step and by phase: the antipodal circles of bar 6, then growth from 100 to 10,000
 * agents at one per 3 m2 with crossing ways. Usage: bench_crowd [PACK] */
#define _GNU_SOURCE
#include "tests/core/crowd_trial.h"
#include "tests/core/walker_pack.h"

#include <time.h>

#define DENSITY (1.0 / 3.0) /* 1/m^2 */
#define WARM 30
#define STEPS 90
#define MATRIX_ROUNDS 10

static double cpu_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t); /* not what other programs take */
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static ff_crowd *new_crowd(const ff_pack *pack, uint32_t agents)
{
    ff_error error;
    ff_crowd *crowd = NULL;
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = agents;
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &crowd, &error), error);
    return crowd;
}

/* us per agent, of CPU time. */
static double measure_matrices(ff_crowd *crowd, uint32_t agents)
{
    ff_error error;
    ff_matrix *out = ff_calloc((size_t)agents * FF_JOINT_COUNT, sizeof *out);
    assert_non_null(out);
    double start = cpu_time();
    for (int i = 0; i < MATRIX_ROUNDS; ++i)
        FF_ASSERT_OK(ff_crowd_matrices(crowd, ff_v2(0.0, 0.0), out, agents, &error), error);
    double spent = cpu_time() - start;
    free(out);
    return spent * 1e6 / ((double)agents * MATRIX_ROUNDS);
}

/* Steps until everybody stands, or `most`; prints CPU time, split as the phases' wall-clock times are. */
static void measure(ff_crowd *crowd, const char *name, uint32_t agents, uint32_t warm, uint32_t most)
{
    for (uint32_t i = 0; i < warm; ++i)
        ff_crowd_step(crowd);
    ff_crowd_timings before = ff_crowd_time_spent(crowd);
    double start = cpu_time();
    for (uint32_t i = 0; i < most; ++i)
        ff_crowd_step(crowd);
    double total = (cpu_time() - start) * 1e6 / ((double)agents * most);
    ff_crowd_timings after = ff_crowd_time_spent(crowd);
    double wall = after.total - before.total, scale = wall > 0.0 ? total / wall : 0.0;
    double near = after.snapshot + after.neighbours - before.snapshot - before.neighbours;
    printf("%-8s %6u agents: %6.2f us per agent and step (neighbours %.2f, navigation %.2f, bodies %.2f, "
           "synthesis %.2f), matrices %.2f\n",
           name, agents, total, near * scale, (after.navigation - before.navigation) * scale,
           (after.bodies - before.bodies) * scale, (after.synthesis - before.synthesis) * scale,
           measure_matrices(crowd, agents));
    ff_crowd_destroy(crowd);
}

static void circle(const ff_pack *pack, uint32_t agents)
{
    trial t = {.layout = TRIAL_CIRCLE, .agents = agents, .seed = 1};
    ff_crowd *crowd = new_crowd(pack, agents);
    trial_lay_out(crowd, &t);
    measure(crowd, "circle", agents, 0, 250 + 5 * agents);
}

static void plaza(const ff_pack *pack, uint32_t agents)
{
    trial t = {.layout = TRIAL_CIRCLE, .seed = 1};
    ff_random random = {1, 2, 0};
    ff_crowd *crowd = new_crowd(pack, agents);
    uint32_t side = (uint32_t)ceil(sqrt(agents));
    for (uint32_t i = 0; i < agents; ++i) {
        uint32_t row = i / side, column = i % side;
        ff_vec2 cell =
            ff_v2(column + ff_random_range(&random, -0.2, 0.2), row + ff_random_range(&random, -0.2, 0.2));
        ff_vec2 p = ff_scale2(cell, 1.0 / sqrt(DENSITY));
        trial_add(crowd, &t, &random, p, ff_madd2(p, ff_fwd2(ff_random_range(&random, -FF_PI, FF_PI)), 20.0));
    }
    measure(crowd, "plaza", agents, WARM, STEPS);
}

int main(int argc, char **argv)
{
    ff_pack *pack;
    ff_error error;
    void *image = NULL;
    size_t size;
    if (argc > 1) {
        FF_ASSERT_OK(ff_pack_open(argv[1], &pack, &error), error);
    } else {
        image = ff_walker_image(&ff_walker_grid_full, &size);
        FF_ASSERT_OK(ff_pack_open_memory(image, size, &pack, &error), error);
    }
    const uint32_t circles[] = {17, 40, 100}, plazas[] = {100, 300, 1000, 3000, 10000};
    for (size_t i = 0; i < sizeof circles / sizeof *circles; ++i)
        circle(pack, circles[i]);
    for (size_t i = 0; i < sizeof plazas / sizeof *plazas; ++i)
        plaza(pack, plazas[i]);
    ff_pack_close(pack);
    free(image);
    return 0;
}
