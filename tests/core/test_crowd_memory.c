/* A step takes no memory, nor does asking for poses. Counts calls of the C library's allocators (glibc's inner names let
 * a program put its own in front); under the sanitizers, which do the same, there is nothing to count. */
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(neither_steps_nor_poses_take_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
