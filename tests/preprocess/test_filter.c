/* Filters and the floor against closed forms. */
#include "preprocess/base/filter.h"

#include "preprocess/plants/floor.h"
#include "runtime/core/base/random.h"
#include "tests/check.h"
#include "tests/preprocess/standard.h"

enum { N = 600 };
static const double RATE = 120.0;

/* Amplitude of a sine of one frequency after filtering, and how far it is shifted (s), from the middle of the signal. */
static void response(double hertz, double cutoff, double *gain, double *delay)
{
    double x[N], in_phase = 0.0, quadrature = 0.0;
    for (int i = 0; i < N; ++i)
        x[i] = ff_sin(FF_TAU * hertz * i / RATE);
    ff_filter_low_pass(x, N, 1, RATE, cutoff);
    for (int i = 120; i < 480; ++i) { /* whole periods of every frequency used */
        in_phase += x[i] * ff_sin(FF_TAU * hertz * i / RATE) / 180.0;
        quadrature += x[i] * ff_cos(FF_TAU * hertz * i / RATE) / 180.0;
    }
    *gain = sqrt(in_phase * in_phase + quadrature * quadrature);
    *delay = ff_atan2(quadrature, in_phase) / (FF_TAU * hertz);
}

static void the_low_pass_halves_power_at_its_cutoff_without_delay(void **state)
{
    (void)state;
    double gain, delay;
    response(15.0, 15.0, &gain, &delay);
    FF_ASSERT_NEAR(gain, sqrt(0.5), 0.01);
    FF_ASSERT_NEAR(delay, 0.0, 1e-4);
    response(2.0, 15.0, &gain, &delay);
    FF_ASSERT_NEAR(gain, 1.0, 0.001);
    FF_ASSERT_NEAR(delay, 0.0, 1e-5);
    response(50.0, 15.0, &gain, &delay);
    FF_ASSERT_BELOW(gain, 0.01);
}

static void what_moves_steadily_keeps_moving_to_the_last_frame(void **state)
{
    (void)state;
    ff_vec3 p[200];
    for (int count = 1; count <= 200; ++count) {
        for (int i = 0; i < count; ++i)
            p[i] = ff_v3(0.01 * i, 2.0 - 0.005 * i, 7.0);
        ff_filter_low_pass3(p, count, RATE, 10.0);
        /* Signals shorter than the filter's memory (half a second) keep a trace of having begun. */
        double tolerance = count > 64 ? 1e-6 : 5e-3;
        for (int i = 0; i < count; ++i)
            FF_ASSERT_BELOW(ff_length3(ff_sub3(p[i], ff_v3(0.01 * i, 2.0 - 0.005 * i, 7.0))), tolerance);
    }
}

static void spikes_go_and_everything_else_stays(void **state)
{
    (void)state;
    ff_vec3 p[100], q[100];
    for (int i = 0; i < 100; ++i) /* a foot that swings and stands */
        p[i] = q[i] = ff_v3(0.0, 0.1 + 0.1 * ff_sin(0.15 * i), 0.04 * i);
    ff_filter_despike(q, 100, RATE);
    assert_memory_equal(p, q, sizeof p);
    q[17].y += 0.2;
    q[60].x -= 0.5;
    ff_filter_despike(q, 100, RATE);
    for (int i = 0; i < 100; ++i)
        FF_ASSERT_BELOW(ff_length3(ff_sub3(p[i], q[i])), 0.002);
}

static void upsampling_meets_the_given_points(void **state)
{
    (void)state;
    ff_vec3 p[20], q[77];
    for (int i = 0; i < 20; ++i)
        p[i] = ff_v3(ff_sin(0.3 * i), 1.0, 0.2 * i);
    ff_filter_upsample(p, 20, 4, q);
    for (int i = 0; i < 20; ++i)
        assert_memory_equal(&p[i], &q[4 * i], sizeof p[i]);
    for (int i = 4; i < 72; ++i)
        FF_ASSERT_BELOW(ff_length3(ff_sub3(q[i], ff_v3(ff_sin(0.075 * i), 1.0, 0.05 * i))), 0.002);
    ff_filter_upsample(p, 1, 4, q);
    assert_memory_equal(p, q, sizeof p[0]);
}

static void quantiles_and_noise(void **state)
{
    (void)state;
    double x[] = {5.0, 1.0, 4.0, 2.0, 3.0}, scratch[N];
    FF_ASSERT_NEAR(ff_filter_quantile(x, 5, 0.5), 3.0, 0.0);
    FF_ASSERT_NEAR(ff_filter_quantile(x, 5, 0.0), 1.0, 0.0);
    FF_ASSERT_NEAR(ff_filter_quantile(x, 5, 1.0), 5.0, 0.0);
    FF_ASSERT_NEAR(ff_filter_quantile(x, 5, 0.125), 1.5, 1e-12);
    FF_ASSERT_NEAR(ff_filter_quantile(x, 1, 0.7), 1.0, 0.0);
    ff_vec3 p[N];
    ff_random random = {5, 0, 0};
    for (int i = 0; i < N; ++i) {
        p[i] = ff_v3(0.0, 0.1 * ff_sin(0.1 * i), 0.01 * i);
        p[i].x += 0.002 * ff_random_normal(&random);
        p[i].y += 0.002 * ff_random_normal(&random);
        p[i].z += 0.002 * ff_random_normal(&random);
    }
    FF_ASSERT_NEAR(ff_filter_noise(p, N, scratch), 0.002, 0.0003);
}

/* Rests along a path, on a known plane, the left foot higher, with a few in the air. */
static int make_rests(ff_floor_sample *out, ff_vec2 slope, double left_up)
{
    ff_random random = {9, 0, 0};
    for (int i = 0; i < 16; ++i) {
        ff_vec2 at = ff_v2(0.7 * i, (i % 2 ? -0.1 : 0.1) + 1.0 * ff_sin(0.3 * i));
        double y = 0.07 + ff_dot2(slope, at) + (i % 2 ? 0.0 : left_up) + 0.002 * ff_random_normal(&random);
        if (i == 5 || i == 10) y += 0.3;
        out[i] = (ff_floor_sample){i % 2 ? FF_RIGHT : FF_LEFT, ff_ground(at, y), 0.6};
    }
    return 16;
}

static void the_floor_is_found_under_both_feet_and_without_what_is_in_the_air(void **state)
{
    (void)state;
    ff_floor_sample rests[16];
    int count = make_rests(rests, ff_v2(0.018, -0.006), 0.015);
    ff_floor_fit fit = ff_floor_solve(&standard()->find.floor, rests, count);
    FF_ASSERT_NEAR(fit.slope.a, 0.018, 0.001);
    FF_ASSERT_NEAR(fit.slope.b, -0.006, 0.003);
    FF_ASSERT_NEAR(fit.level[FF_RIGHT], 0.07, 0.004);
    FF_ASSERT_NEAR(fit.level[FF_LEFT] - fit.level[FF_RIGHT], 0.015, 0.003);
}

static void one_rest_gives_a_level_floor(void **state)
{
    (void)state;
    ff_floor_sample rest = {FF_LEFT, {3.0, 0.05, -2.0}, 0.5};
    ff_floor_fit fit = ff_floor_solve(&standard()->find.floor, &rest, 1);
    FF_ASSERT_NEAR(fit.slope.a, 0.0, 1e-9);
    FF_ASSERT_NEAR(fit.slope.b, 0.0, 1e-9);
    FF_ASSERT_NEAR(fit.level[FF_LEFT], 0.05, 1e-3);
    FF_ASSERT_NEAR(fit.level[FF_RIGHT], 0.05, 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_low_pass_halves_power_at_its_cutoff_without_delay),
        cmocka_unit_test(what_moves_steadily_keeps_moving_to_the_last_frame),
        cmocka_unit_test(spikes_go_and_everything_else_stays),
        cmocka_unit_test(upsampling_meets_the_given_points),
        cmocka_unit_test(quantiles_and_noise),
        cmocka_unit_test(the_floor_is_found_under_both_feet_and_without_what_is_in_the_air),
        cmocka_unit_test(one_rest_gives_a_level_floor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
