/* Blended poses: against sums in doubles, SIMD against plain C, and the hemisphere that frames are put on. */
#include "runtime/core/base/random.h"
#include "runtime/core/pose/pose_blend.h"
#include "tests/check.h"

#define FRAMES 40

static ff_quat any_rotation(ff_random *random)
{
    return ff_quat_unit((ff_quat){ff_random_normal(random), ff_random_normal(random),
                                  ff_random_normal(random), ff_random_normal(random)});
}

/* A turn of at most angle about any axis. */
static ff_quat small_turn(ff_random *random, double angle)
{
    ff_vec3 axis = ff_v3(ff_random_normal(random), ff_random_normal(random), ff_random_normal(random));
    return ff_quat_axis(ff_unit3(axis), ff_random_range(random, -angle, angle));
}

static ff_pose_store make_store(uint32_t lanes)
{
    ff_pose_store store = {calloc((size_t)FRAMES * 4 * lanes, sizeof(int16_t)), lanes};
    assert_non_null(store.keys);
    return store;
}

/* Weights add up to 1. */
static ff_pose_mix any_mix(ff_random *random, uint32_t pairs)
{
    double weight[2 * FF_POSE_PAIRS_MAX], sum = 0.0;
    ff_pose_mix mix = {.count = 0};
    for (uint32_t i = 0; i < 2 * pairs; ++i)
        sum += weight[i] = ff_random_unit(random);
    for (uint32_t i = 0; i < pairs; ++i)
        ff_pose_mix_add(&mix, (uint32_t)ff_random_range(random, 0, FRAMES),
                        (uint32_t)ff_random_range(random, 0, FRAMES), weight[2 * i] / sum,
                        weight[2 * i + 1] / sum);
    return mix;
}

static void simd_and_plain_c_give_the_same_bits(void **state)
{
    (void)state;
    const uint32_t lanes[] = {8, 24, 32, FF_POSE_LANES_MAX};
    ff_random random = {5, 1, 0};
    for (size_t l = 0; l < sizeof lanes / sizeof *lanes; ++l) {
        ff_pose_store store = make_store(lanes[l]);
        for (uint32_t i = 0; i < FRAMES * 4 * lanes[l]; ++i)
            store.keys[i] = (int16_t)ff_random_range(&random, -32767.0, 32767.99);
        for (uint32_t run = 0; run < 200; ++run) {
            float fast[4 * FF_POSE_LANES_MAX], plain[4 * FF_POSE_LANES_MAX];
            ff_pose_mix mix = any_mix(&random, run % (FF_POSE_PAIRS_MAX + 1));
            ff_pose_blend(&store, &mix, fast);
            ff_pose_blend_plain(&store, &mix, plain);
            assert_memory_equal(fast, plain, 4 * lanes[l] * sizeof *fast);
        }
        free(store.keys);
    }
}

static void a_blend_is_the_weighted_mean_on_the_unit_sphere(void **state)
{
    (void)state;
    enum { LANES = 24, JOINTS = 21 };
    ff_random random = {5, 2, 0};
    ff_pose_store store = make_store(LANES);
    static ff_quat truth[FRAMES][JOINTS];
    double mean[4 * JOINTS] = {0.0};
    for (uint32_t j = 0; j < JOINTS; ++j) {
        ff_quat middle = any_rotation(&random);
        for (uint32_t k = 0; k < FRAMES; ++k) {
            truth[k][j] = ff_quat_mul(middle, small_turn(&random, 0.7));
            ff_pose_write(&store, k, j, truth[k][j]);
        }
    }
    ff_pose_align(&store, 0, FRAMES, JOINTS, mean);
    for (int run = 0; run < 100; ++run) {
        float lanes[4 * LANES];
        ff_quat got[JOINTS];
        ff_pose_mix mix = any_mix(&random, 5);
        ff_pose_blend(&store, &mix, lanes);
        ff_pose_rotations(lanes, LANES, 0, JOINTS, got);
        for (uint32_t j = 0; j < JOINTS; ++j) {
            ff_quat sum = {0.0, 0.0, 0.0, 0.0}, first = truth[0][j];
            for (uint32_t p = 0; p < 2 * mix.count; ++p) {
                ff_quat q = truth[mix.pair[p / 2].frame[p % 2]][j];
                double weight = mix.pair[p / 2].weight[p % 2] * (ff_quat_dot(first, q) < 0.0 ? -1.0 : 1.0);
                sum = (ff_quat){sum.x + weight * q.x, sum.y + weight * q.y, sum.z + weight * q.z,
                                sum.w + weight * q.w};
            }
            ff_quat off = ff_quat_mul(ff_quat_conj(ff_quat_unit(sum)), got[j]);
            FF_ASSERT_BELOW(ff_quat_angle(off), 1e-4);
            FF_ASSERT_NEAR(ff_quat_dot(got[j], got[j]), 1.0, 1e-6);
        }
    }
    free(store.keys);
}

static void frames_are_continuous_and_motions_on_one_hemisphere(void **state)
{
    (void)state;
    ff_random random = {5, 3, 0};
    ff_pose_store store = make_store(8);
    double mean[4] = {0.0};
    ff_quat middle = any_rotation(&random);
    for (uint32_t k = 0; k < FRAMES; ++k) {
        ff_quat q = ff_quat_mul(middle, small_turn(&random, 0.5));
        double side = ff_random_unit(&random) < 0.5 ? -1.0 : 1.0; /* the same rotation all the same */
        ff_pose_write(&store, k, 0, (ff_quat){side * q.x, side * q.y, side * q.z, side * q.w});
    }
    for (uint32_t motion = 0; motion < FRAMES; motion += 10)
        ff_pose_align(&store, motion, 10, 1, mean);
    for (uint32_t k = 1; k < FRAMES; ++k) {
        int64_t dot = 0;
        for (uint32_t part = 0; part < 4; ++part)
            dot += (int64_t)ff_pose_frame(&store, 0)[part * 8] * ff_pose_frame(&store, k)[part * 8];
        assert_true(dot > 0);
    }
    free(store.keys);
}

static void frames_that_cancel_and_no_frames_give_the_identity(void **state)
{
    (void)state;
    ff_pose_store store = make_store(8);
    float out[32];
    ff_pose_mix mix = {.count = 0};
    ff_pose_write(&store, 0, 0, (ff_quat){0.6, 0.0, 0.0, 0.8});
    ff_pose_write(&store, 1, 0, (ff_quat){-0.6, 0.0, 0.0, -0.8});
    ff_pose_blend(&store, &mix, out);
    assert_true(out[0] == 0.0f && out[24] == 1.0f);
    ff_pose_mix_add(&mix, 0, 1, 0.5, 0.5);
    ff_pose_blend(&store, &mix, out);
    assert_true(out[0] == 0.0f && out[8] == 0.0f && out[16] == 0.0f && out[24] == 1.0f);
    mix.count = 0;
    ff_pose_mix_add(&mix, 1, 1, 1.0, 0.0);
    ff_pose_blend(&store, &mix, out);
    FF_ASSERT_NEAR(out[0], -0.6, 1e-4);
    free(store.keys);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(simd_and_plain_c_give_the_same_bits),
        cmocka_unit_test(a_blend_is_the_weighted_mean_on_the_unit_sphere),
        cmocka_unit_test(frames_are_continuous_and_motions_on_one_hemisphere),
        cmocka_unit_test(frames_that_cancel_and_no_frames_give_the_identity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
