/* What one agent costs: gait step, pose, clamping of rates. Usage: bench_synth [PACK] */
#define _GNU_SOURCE
#include "runtime/core/base/random.h"
#include "runtime/core/gait/synth_state.h"
#include "tests/core/walker_pack.h"

#include <time.h>

#define AGENTS 256
#define STEPS 600

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t); /* not what other programs take */
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

typedef struct walker {
    ff_gait gait;
    ff_vec2 position;
    double heading;
    ff_rates rates;
} walker;

static ff_rates wish(ff_random *random)
{
    return (ff_rates){ff_random_range(random, -0.3, 2.2), ff_random_range(random, -0.5, 0.5),
                      ff_random_range(random, -1.5, 1.5)};
}

static void move(walker *w, ff_rates target)
{
    w->rates.forward += 0.05 * (target.forward - w->rates.forward);
    w->rates.left += 0.05 * (target.left - w->rates.left);
    w->rates.turn += 0.05 * (target.turn - w->rates.turn);
    w->heading += w->rates.turn / 30.0;
    ff_vec2 velocity = ff_from_frame2(ff_fwd2(w->heading), ff_v2(w->rates.forward, w->rates.left));
    w->position = ff_madd2(w->position, velocity, 1.0 / 30.0);
}

static void measure(const ff_blend_space *space)
{
    static walker walkers[AGENTS];
    static ff_rates targets[AGENTS];
    ff_random random = {1, 1, 0};
    double step = 0.0, pose = 0.0, clamp = 0.0, checksum = 0.0, calls = (double)AGENTS * STEPS;
    for (int a = 0; a < AGENTS; ++a)
        ff_gait_init(space, &walkers[a].gait, walkers[a].position, 0.0, (uint64_t)a);
    for (int i = 0; i < STEPS; ++i) {
        for (int a = 0; a < AGENTS; ++a)
            targets[a] = wish(&random);
        double first = now();
        for (int a = 0; a < AGENTS; ++a)
            targets[a] = ff_blend_clamp(space, targets[a]);
        clamp += now() - first;
        for (int a = 0; a < AGENTS; ++a)
            move(&walkers[a], targets[a]);
        double start = now();
        for (int a = 0; a < AGENTS; ++a)
            ff_gait_step(space, &walkers[a].gait, walkers[a].position, walkers[a].heading, walkers[a].rates,
                         1.0 / 30.0);
        double middle = now();
        for (int a = 0; a < AGENTS; ++a) {
            ff_vec3 hips;
            ff_quat rotations[FF_JOINT_COUNT];
            ff_gait_pose(space, &walkers[a].gait, walkers[a].position, walkers[a].heading, &hips, rotations);
            checksum += rotations[FF_JOINT_KNEE_L].x;
        }
        step += middle - start;
        pose += now() - middle;
    }
    printf("ff_gait_step   %7.0f ns per agent and step\n", 1e9 * step / calls);
    printf("ff_gait_pose   %7.0f ns per agent and pose\n", 1e9 * pose / calls);
    printf("ff_blend_clamp %7.0f ns per call\n", 1e9 * clamp / calls);
    printf("state %zu bytes per agent (checksum %.6f)\n", ff_gait_size(), checksum);
}

int main(int argc, char **argv)
{
    ff_error error;
    char text[1024];
    ff_pack *pack = NULL;
    ff_blend_space *space = NULL;
    void *data = NULL;
    size_t size;
    ff_status status;
    if (argc > 1) {
        status = ff_pack_open(argv[1], &pack, &error);
    } else {
        data = ff_walker_image(&ff_walker_grid_full, &size);
        status = ff_pack_open_memory(data, size, &pack, &error);
    }
    if (status == FF_OK) status = ff_blend_space_create(pack, &space, &error);
    if (status == FF_OK) {
        measure(space);
    } else {
        fprintf(stderr, "%s\n", ff_error_text(&error, text, sizeof text));
    }
    ff_blend_space_destroy(space);
    ff_pack_close(pack);
    free(data);
    return status == FF_OK ? 0 : 1;
}
