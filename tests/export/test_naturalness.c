/* The distance to the nearest recorded pose: none for what is recorded, and what a plain search finds for everything else. */
#define _GNU_SOURCE
#include "runtime/core/base/random.h"
#include "runtime/core/pack/pack.h"
#include "runtime/export/naturalness.h"
#include "tests/built_in_open.h"

static ff_figure figure;
static ff_pose_base base;

static void pose_at(uint32_t clip, double time, uint32_t flags, ff_vec3 *places)
{
    ff_error error;
    ff_vec3 hips;
    ff_quat rotations[FF_FIGURE_MAX_JOINTS];
    FF_ASSERT_OK(
        ff_pack_sample(pack, ff_pack_clip_stream(pack, clip), time, flags, NULL, &hips, rotations, &error),
        error);
    ff_figure_place(&figure, hips, rotations, places, NULL);
}

static void recorded_poses_are_found_wherever_the_body_stands(void **state)
{
    (void)state;
    ff_random random = {1, 1, 0};
    uint32_t hint = 0;
    for (int i = 0; i < 60; ++i) {
        uint32_t clip = (uint32_t)i % ff_pack_clip_count(pack);
        if (pack->clips[clip].flags & FF_CLIP_DERIVED) continue;
        ff_vec3 places[FF_FIGURE_MAX_JOINTS];
        pose_at(clip, (i % 20) / 30.0, i % 2 ? FF_SAMPLE_MIRRORED : 0, places);
        double heading = ff_random_range(&random, -3.0, 3.0);
        ff_vec2 root = {ff_random_range(&random, -50.0, 50.0), ff_random_range(&random, -50.0, 50.0)};
        for (uint32_t j = 0; j < figure.joint_count; ++j)
            places[j] =
                ff_ground(ff_add2(root, ff_from_frame2(ff_fwd2(heading), ff_plane(places[j]))), places[j].y);
        ff_leg_pose_points legs = ff_legs_of(places, root, heading);
        FF_ASSERT_BELOW(ff_pose_base_nearest(&base, &legs, &hint), 2e-3);
    }
}

static double plain_search(const ff_leg_pose_points *legs)
{
    static const double weights[FF_LEGS] = {2, 2, 2, 2, 1, 1, 1, 1}; /* feet count double */
    double best = 1e9;
    for (uint32_t i = 0; i < base.count; ++i) {
        double sum = 0.0;
        for (int k = 0; k < FF_LEGS; ++k) {
            double square = 0.0;
            for (int c = 0; c < 3; ++c)
                square += pow((double)base.poses[i].at[k][c] - (double)legs->at[k][c], 2.0);
            sum += weights[k] * sqrt(square) / 12.0;
        }
        best = fmin(best, sum);
    }
    return best;
}

static void the_nearest_is_the_nearest_whatever_the_hint(void **state)
{
    (void)state;
    ff_random random = {2, 1, 0};
    for (int i = 0; i < 40; ++i) {
        ff_leg_pose_points legs = base.poses[ff_random_next(&random) % base.count];
        for (int k = 0; k < FF_LEGS; ++k)
            for (int c = 0; c < 3; ++c)
                legs.at[k][c] += (float)ff_random_range(&random, -0.1, 0.1);
        uint32_t hint = (uint32_t)(ff_random_next(&random) % base.count), none = 0;
        double want = plain_search(&legs);
        FF_ASSERT_NEAR(ff_pose_base_nearest(&base, &legs, &hint), want, 1e-6);
        FF_ASSERT_NEAR(ff_pose_base_nearest(&base, &legs, &none), want, 1e-6);
        assert_true(want > 0.01);
    }
}

static void a_pose_pushed_aside_is_that_far_off(void **state)
{
    (void)state;
    ff_leg_pose_points legs = base.poses[100];
    for (int k = 0; k < FF_LEGS; ++k)
        legs.at[k][2] += 0.5f; /* half a metre over the ground */
    uint32_t hint = 0;
    FF_ASSERT_NEAR(ff_pose_base_nearest(&base, &legs, &hint), 0.35, 0.15);
}

static int set_up(void **state)
{
    ff_error error;
    open_pack(state);
    FF_ASSERT_OK(ff_figure_from_pack(pack, &figure, &error), error);
    FF_ASSERT_OK(ff_pose_base_create(pack, &figure, &base, &error), error);
    return 0;
}

static int tear_down(void **state)
{
    ff_pose_base_free(&base);
    return close_pack(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(recorded_poses_are_found_wherever_the_body_stands),
        cmocka_unit_test(the_nearest_is_the_nearest_whatever_the_hint),
        cmocka_unit_test(a_pose_pushed_aside_is_that_far_off),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
