/* Counter-based random numbers: the numbers themselves, and their statistics against the exact distributions. */
#include "tests/check.h"

#include "runtime/core/base/random.h"

enum { SAMPLES = 200000 };

static void the_numbers_are_those_of_an_independent_program(void **state)
{
    (void)state;
    /* From the formulas of random.h in Python integers; a change here breaks every recorded run. */
    assert_true(ff_random_at(0, 0, 0) == 0xf30429728e32fa04u);
    assert_true(ff_random_at(1, 2, 3) == 0x2d777c23e3aba2b4u);
    assert_true(ff_random_at(UINT64_MAX, UINT64_MAX, UINT64_MAX) == 0x9256a868ec923072u);
}

static void the_nth_number_depends_on_seed_stream_and_counter_alone(void **state)
{
    (void)state;
    ff_random forward = {.seed = 9, .stream = 4}, other = {.seed = 9, .stream = 5};
    for (uint64_t n = 0; n < 1000; ++n) {
        assert_true(ff_random_next(&forward) == ff_random_at(9, 4, n));
        ff_random_unit(&other); /* another stream in between changes nothing */
        ff_random jump = {9, 4, n};
        assert_true(ff_random_next(&jump) == ff_random_at(9, 4, n));
    }
}

static void units_are_uniform(void **state)
{
    (void)state;
    enum { BINS = 100 };
    int bins[BINS] = {0};
    double sum = 0.0, squares = 0.0;
    ff_random random = {.seed = 1};
    for (int i = 0; i < SAMPLES; ++i) {
        double u = ff_random_unit(&random);
        assert_true(u >= 0.0 && u < 1.0);
        ++bins[(int)(u * BINS)];
        sum += u, squares += u * u;
    }
    FF_ASSERT_NEAR(sum / SAMPLES, 0.5, 4.0 * sqrt(1.0 / 12.0 / SAMPLES)); /* four deviations of the mean */
    FF_ASSERT_NEAR(squares / SAMPLES, 1.0 / 3.0, 4.0 * sqrt(4.0 / 45.0 / SAMPLES));
    double chi2 = 0.0, expected = (double)SAMPLES / BINS;
    for (int i = 0; i < BINS; ++i)
        chi2 += (bins[i] - expected) * (bins[i] - expected) / expected;
    FF_ASSERT_NEAR(chi2, BINS - 1, 4.0 * sqrt(2.0 * (BINS - 1)));
}

/* Correlation of two sequences of units, in deviations of its own estimate. */
static double correlation(uint64_t seed_p, uint64_t stream_p, uint64_t seed_q, uint64_t stream_q,
                          uint64_t lag)
{
    double sum = 0.0;
    ff_random p = {seed_p, stream_p, 0}, q = {seed_q, stream_q, lag};
    for (int i = 0; i < SAMPLES; ++i)
        sum += (ff_random_unit(&p) - 0.5) * (ff_random_unit(&q) - 0.5);
    return sum * 12.0 / sqrt((double)SAMPLES);
}

static void neighbouring_seeds_streams_and_counters_do_not_correlate(void **state)
{
    (void)state;
    FF_ASSERT_BELOW(fabs(correlation(1, 0, 2, 0, 0)), 4.0);
    FF_ASSERT_BELOW(fabs(correlation(1, 0, 1, 1, 0)), 4.0);
    FF_ASSERT_BELOW(fabs(correlation(1, 7, 1, 8, 1)), 4.0);
    FF_ASSERT_BELOW(fabs(correlation(1, 0, 1, 0, 1)), 4.0);
    FF_ASSERT_BELOW(fabs(correlation(0, 1, 1, 0, 0)), 4.0);
    /* Every output bit follows every input bit half of the time. */
    int changed = 0;
    for (int bit = 0; bit < 64; ++bit) {
        uint64_t difference = ff_random_at(3, 5, 8) ^ ff_random_at(3, 5, 8 ^ (UINT64_C(1) << bit));
        for (; difference; difference &= difference - 1)
            ++changed;
    }
    FF_ASSERT_NEAR(changed / (64.0 * 64.0), 0.5, 4.0 * 0.5 / 64.0);
}

static void normals_have_the_moments_of_a_sum_of_twelve_uniforms(void **state)
{
    (void)state;
    double m1 = 0.0, m2 = 0.0, m3 = 0.0, m4 = 0.0;
    ff_random random = {.seed = 77, .stream = 3};
    for (int i = 0; i < SAMPLES; ++i) {
        double x = ff_random_normal(&random);
        assert_true(fabs(x) <= 6.0);
        m1 += x, m2 += x * x, m3 += x * x * x, m4 += x * x * x * x;
    }
    FF_ASSERT_NEAR(m1 / SAMPLES, 0.0, 4.0 / sqrt(SAMPLES));
    FF_ASSERT_NEAR(m2 / SAMPLES, 1.0, 4.0 * sqrt(1.9 / SAMPLES));
    FF_ASSERT_NEAR(m3 / SAMPLES, 0.0, 4.0 * sqrt(13.0 / SAMPLES));
    FF_ASSERT_NEAR(m4 / SAMPLES, 2.9, 4.0 * sqrt(75.0 / SAMPLES)); /* excess -1.2/12 */
}

static void ranges_stay_between_their_ends(void **state)
{
    (void)state;
    ff_random random = {.seed = 2};
    double low = 10.0, high = -10.0;
    for (int i = 0; i < 10000; ++i) {
        double x = ff_random_range(&random, -2.0, 3.0);
        assert_true(x >= -2.0 && x <= 3.0);
        low = ff_min(low, x), high = ff_max(high, x);
    }
    FF_ASSERT_NEAR(low, -2.0, 0.01);
    FF_ASSERT_NEAR(high, 3.0, 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_numbers_are_those_of_an_independent_program),
        cmocka_unit_test(the_nth_number_depends_on_seed_stream_and_counter_alone),
        cmocka_unit_test(units_are_uniform),
        cmocka_unit_test(neighbouring_seeds_streams_and_counters_do_not_correlate),
        cmocka_unit_test(normals_have_the_moments_of_a_sum_of_twelve_uniforms),
        cmocka_unit_test(ranges_stay_between_their_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
