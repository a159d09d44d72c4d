/* A step takes no memory, nor does asking for poses. Counts calls of the C library's allocators (glibc's inner names let
 * a program put its own in front); under the sanitizers, which do the same, there is nothing to count. */
#define _GNU_SOURCE
#include "tests/built_in_pack.h"
#include "tests/core/crowd_trial.h"
#include "tests/core/walker_pack.h"

#include <stdatomic.h>

static atomic_uint calls;

#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#elif defined(__has_feature)
#define SANITIZED __has_feature(address_sanitizer)
#else
#define SANITIZED 0
#endif

#if defined(__GLIBC__) && !SANITIZED
#define COUNTS 1
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);
void *__libc_memalign(size_t align, size_t size);

void *malloc(size_t size)
{
    atomic_fetch_add(&calls, 1);
    return __libc_malloc(size);
}
void *calloc(size_t count, size_t size)
{
    atomic_fetch_add(&calls, 1);
    return __libc_calloc(count, size);
}
void *realloc(void *old, size_t size)
{
    atomic_fetch_add(&calls, 1);
    return __libc_realloc(old, size);
}
void *aligned_alloc(size_t align, size_t size)
{
    atomic_fetch_add(&calls, 1);
    return __libc_memalign(align, size);
}
#else
#define COUNTS 0
#endif

static void neither_steps_nor_poses_take_memory(void **state)
{
    (void)state;
    size_t size;
    ff_error error;
    ff_pack *pack;
    ff_crowd *crowd;
    void *image = ff_walker_image(&ff_walker_grid_full, &size);
    FF_ASSERT_OK(ff_pack_open_memory(image, size, &pack, &error), error);
    trial t = {.layout = TRIAL_CORRIDOR, .seed = 1};
    ff_crowd_def def = ff_crowd_def_default();
    def.threads = 2;
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &crowd, &error), error);
    unsigned before = calls;
    assert_true(before > 0 || !COUNTS);
    trial_lay_out(crowd, &t); /* adding walls and agents takes none either */
    ff_agent agents[64];
    ff_quat rotations[FF_PACK_MAX_JOINTS];
    ff_vec3 hips;
    uint32_t count = ff_crowd_agents(crowd, agents, 64);
    for (int i = 0; i < 400; ++i) {
        ff_crowd_step(crowd);
        FF_ASSERT_OK(ff_crowd_agent_pose(crowd, agents[(uint32_t)i % count], &hips, rotations, &error),
                     error);
    }
    assert_int_equal(calls, before);
    ff_crowd_destroy(crowd);
    ff_pack_close(pack);
    free(image);
}

/* Nor does planning and playing footsteps, changing to them and back, or an obstacle that moves. */
static void footsteps_take_no_memory(void **state)
{
    (void)state;
    enum { PEOPLE = 10 };
    ff_error error;
    ff_pack *pack;
    ff_crowd *crowd;
    ff_agent agents[PEOPLE];
    ff_quat rotations[FF_PACK_MAX_JOINTS];
    ff_vec3 hips;
    FF_ASSERT_OK(ff_pack_open(ff_built_in_pack_path(), &pack, &error), error);
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = PEOPLE;
    def.threads = 2;
    def.planner = FF_PLANNER_FOOTSTEPS;
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &crowd, &error), error);
    unsigned before = calls;
    ff_obstacle_def block = ff_obstacle_def_default();
    block.kind = FF_OBSTACLE_FREE;
    FF_ASSERT_OK(ff_crowd_add_obstacle(crowd, &block, NULL, &error), error);
    for (uint32_t i = 0; i < PEOPLE; ++i) {
        ff_agent_def agent = ff_agent_def_default();
        agent.position = ff_scale2(ff_fwd2(FF_TAU * i / PEOPLE), 4.0);
        agent.goal = ff_scale2(agent.position, -1.0);
        agent.heading = FF_TAU * i / PEOPLE + FF_PI;
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &agent, &agents[i], &error), error);
    }
    for (int i = 0; i < 150; ++i) {
        FF_ASSERT_OK(ff_crowd_move_obstacle(crowd, 0, ff_v2(0.01 * i, 1.0), 0.0, &error), error);
        ff_planner planner = i < 100 ? FF_PLANNER_VELOCITY : FF_PLANNER_FOOTSTEPS;
        if (i % 50 == 40)
            FF_ASSERT_OK(ff_crowd_set_planner(crowd, agents[i % PEOPLE], planner, &error), error);
        ff_crowd_step(crowd);
        FF_ASSERT_OK(ff_crowd_agent_pose(crowd, agents[i % PEOPLE], &hips, rotations, &error), error);
    }
    assert_int_equal(calls, before);
    ff_crowd_destroy(crowd);
    ff_pack_close(pack);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(neither_steps_nor_poses_take_memory),
                                       cmocka_unit_test(footsteps_take_no_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
