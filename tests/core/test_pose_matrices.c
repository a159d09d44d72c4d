/* Matrices of joints: against forward kinematics in doubles, SIMD against plain C, and of whole crowds. */
#include "runtime/core/pack/joints.h"
#include "runtime/core/pose/pose_matrices.h"
#include "tests/core/crowd_trial.h"
#include "tests/core/walker_open.h"

#define AGENTS 40
#define LANES 24

/* Every joint's frame must take three points to where doubles take them, on a body of that size. */
static void check_matrices(const ff_matrix *got, ff_vec3 hips, double size, const ff_quat *rotations,
                           double tolerance)
{
    ff_vec3 place[FF_JOINT_COUNT];
    ff_quat turn[FF_JOINT_COUNT];
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        int parent = ff_joint_parents[j];
        const double *rest = ff_walker_offsets[j];
        ff_vec3 offset = ff_scale3(ff_v3(rest[0], rest[1], rest[2]), size);
        turn[j] = parent < 0 ? rotations[j] : ff_quat_mul(turn[parent], rotations[j]);
        place[j] = parent < 0 ? hips : ff_add3(place[parent], ff_quat_rotate(turn[parent], offset));
        for (int axis = 0; axis < 4; ++axis) {
            ff_vec3 point = ff_v3(axis == 1, axis == 2, axis == 3);
            ff_vec3 want = ff_add3(place[j], ff_quat_rotate(turn[j], ff_scale3(point, size)));
            const double v[3] = {point.x, point.y, point.z}, to[3] = {want.x, want.y, want.z};
            for (int i = 0; i < 3; ++i) {
                const float *row = got[j].row[i];
                double at =
                    (double)row[0] * v[0] + (double)row[1] * v[1] + (double)row[2] * v[2] + (double)row[3];
                FF_ASSERT_NEAR(at, to[i], tolerance);
            }
        }
    }
}

static void any_pose_comes_within_a_hundredth_of_a_millimetre_and_to_the_same_bits_in_plain_c(void **state)
{
    (void)state;
    ff_random random = {6, 1, 0};
    float offsets[3 * LANES] = {0.0f};
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        for (int i = 0; i < 3; ++i)
            offsets[i * LANES + j] = (float)ff_walker_offsets[j][i];
    ff_pose_tree tree = {ff_joint_parents, offsets, FF_JOINT_COUNT, LANES};
    for (int run = 0; run < 500; ++run) {
        ff_quat rotations[FF_JOINT_COUNT];
        ff_matrix fast[FF_JOINT_COUNT], plain[FF_JOINT_COUNT];
        float lanes[4 * LANES];
        ff_pose_root root = {.scale = run % 5 == 0 ? 1.0f : (float)ff_random_range(&random, 0.7, 1.2)};
        for (int j = 0; j < FF_JOINT_COUNT; ++j)
            rotations[j] = ff_quat_unit((ff_quat){ff_random_normal(&random), ff_random_normal(&random),
                                                  ff_random_normal(&random), ff_random_normal(&random)});
        for (int i = 0; i < 3; ++i)
            root.place[i] = (float)ff_random_range(&random, -20.0, 20.0);
        ff_pose_lanes(rotations, FF_JOINT_COUNT, LANES, lanes);
        ff_pose_matrices(&tree, lanes, &root, fast);
        ff_pose_matrices_plain(&tree, lanes, &root, plain);
        assert_memory_equal(fast, plain, sizeof fast);
        ff_vec3 hips = ff_v3((double)root.place[0], (double)root.place[1], (double)root.place[2]);
        check_matrices(fast, hips, (double)root.scale, rotations, 1e-5);
    }
}

/* Walkers on a circle about centre; every third one was taken away again. */
static ff_crowd *walkers(uint32_t threads, ff_vec2 centre)
{
    ff_error error;
    ff_crowd *crowd;
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = AGENTS;
    def.threads = threads;
    FF_ASSERT_OK(ff_crowd_create(walker.pack, &def, &crowd, &error), error);
    for (int i = 0; i < AGENTS; ++i) {
        ff_agent agent;
        ff_agent_def one = ff_agent_def_default();
        ff_vec2 out = ff_scale2(ff_fwd2(FF_TAU * i / AGENTS), 7.0);
        one.position = ff_add2(centre, out);
        one.goal = ff_sub2(centre, out);
        one.heading = ff_atan2(-out.b, -out.a);
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &one, &agent, &error), error);
        if (i % 3 == 2) FF_ASSERT_OK(ff_crowd_remove_agent(crowd, agent, &error), error);
    }
    return crowd;
}

static void a_crowds_matrices_are_those_of_its_poses(void **state)
{
    (void)state;
    ff_error error;
    /* Far from the origin of the world, but not from the one that is given. */
    ff_vec2 centre = ff_v2(-91234.5, 654321.25);
    ff_crowd *crowd = walkers(1, centre);
    for (int i = 0; i < 240; ++i) {
        static ff_matrix all[AGENTS][FF_JOINT_COUNT];
        ff_agent agents[AGENTS];
        ff_crowd_step(crowd);
        if (i % 40 != 7) continue;
        uint32_t count = ff_crowd_agents(crowd, agents, AGENTS);
        FF_ASSERT_OK(ff_crowd_matrices(crowd, centre, all[0], AGENTS, &error), error);
        for (uint32_t k = 0; k < count; ++k) {
            ff_matrix one[FF_JOINT_COUNT];
            ff_vec3 hips;
            ff_quat rotations[FF_JOINT_COUNT];
            FF_ASSERT_OK(ff_crowd_agent_matrices(crowd, agents[k], centre, one, &error), error);
            assert_memory_equal(one, all[k], sizeof one);
            FF_ASSERT_OK(ff_crowd_agent_pose(crowd, agents[k], &hips, rotations, &error), error);
            check_matrices(one, ff_sub3(hips, ff_ground(centre, 0.0)), 1.0, rotations, 1e-5);
        }
    }
    ff_crowd_destroy(crowd);
}

static void any_number_of_threads_gives_the_same_matrices_and_asking_changes_nothing(void **state)
{
    (void)state;
    static ff_matrix out[3][AGENTS * FF_JOINT_COUNT];
    const uint32_t threads[3] = {1, 2, 8};
    uint64_t hash[3];
    ff_error error;
    for (int t = 0; t < 3; ++t) {
        ff_crowd *crowd = walkers(threads[t], ff_v2(0.0, 0.0));
        memset(out[t], 0, sizeof out[t]);
        for (int i = 0; i < 120; ++i) {
            ff_crowd_step(crowd);
            /* Of the first crowd once, of the others at every step. */
            if (t > 0 || i == 119)
                FF_ASSERT_OK(ff_crowd_matrices(crowd, ff_v2(0.0, 0.0), out[t], AGENTS, &error), error);
        }
        hash[t] = ff_crowd_state_hash(crowd);
        ff_crowd_destroy(crowd);
        assert_memory_equal(out[t], out[0], sizeof out[0]);
        assert_true(hash[t] == hash[0]);
    }
}

static void what_cannot_be_done_is_refused(void **state)
{
    (void)state;
    ff_error error;
    static ff_matrix out[AGENTS * FF_JOINT_COUNT];
    ff_crowd *crowd = walkers(1, ff_v2(0.0, 0.0));
    ff_vec2 here = ff_v2(0.0, 0.0);
    uint32_t agents = ff_crowd_agent_count(crowd);
    out[0].row[0][0] = 7.0f;
    assert_int_equal(ff_crowd_matrices(crowd, here, NULL, agents, &error), FF_ERR_ARGUMENT);
    assert_int_equal(ff_crowd_matrices(crowd, here, out, agents - 1, &error), FF_ERR_RANGE);
    assert_int_equal(ff_crowd_matrices(crowd, ff_v2(NAN, 0.0), out, agents, &error), FF_ERR_NOT_FINITE);
    assert_int_equal(ff_crowd_agent_matrices(crowd, (ff_agent){0, 0}, here, out, &error), FF_ERR_ARGUMENT);
    ff_agent first;
    ff_crowd_agents(crowd, &first, 1);
    assert_int_equal(ff_crowd_agent_matrices(crowd, first, here, NULL, &error), FF_ERR_ARGUMENT);
    assert_true(out[0].row[0][0] == 7.0f);
    FF_ASSERT_OK(ff_crowd_matrices(crowd, here, out, agents, &error), error);
    ff_crowd_destroy(crowd);
}

int main(void)
{
    walker.grid = &ff_walker_grid_small;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_pose_comes_within_a_hundredth_of_a_millimetre_and_to_the_same_bits_in_plain_c),
        cmocka_unit_test(a_crowds_matrices_are_those_of_its_poses),
        cmocka_unit_test(any_number_of_threads_gives_the_same_matrices_and_asking_changes_nothing),
        cmocka_unit_test(what_cannot_be_done_is_refused),
    };
    return cmocka_run_group_tests(tests, ff_walker_open, ff_walker_close);
}
