/* The two-bone leg: lengths kept, targets met, no flips, no locked knees. */
#include "runtime/core/base/random.h"
#include "runtime/core/gait/leg_ik.h"
#include "tests/check.h"

static const ff_vec3 down_thigh = {0.0, -0.42, 0.0}, down_shank = {0.0, -0.40, 0.0};

static ff_leg leg_bent(double hip_angle, double knee_angle)
{
    ff_leg leg;
    leg.hip = ff_v3(0.1, 0.9, 0.0);
    leg.thigh = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -hip_angle);
    leg.shank = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), knee_angle - hip_angle);
    leg.foot = FF_QUAT_IDENTITY;
    leg.knee = ff_add3(leg.hip, ff_quat_rotate(leg.thigh, down_thigh));
    leg.ankle = ff_add3(leg.knee, ff_quat_rotate(leg.shank, down_shank));
    return leg;
}

static void check_bones(const ff_leg *leg)
{
    ff_vec3 knee = ff_add3(leg->hip, ff_quat_rotate(leg->thigh, down_thigh));
    ff_vec3 ankle = ff_add3(leg->knee, ff_quat_rotate(leg->shank, down_shank));
    FF_ASSERT_BELOW(ff_length3(ff_sub3(knee, leg->knee)), 1e-9);
    FF_ASSERT_BELOW(ff_length3(ff_sub3(ankle, leg->ankle)), 1e-9);
}

static void a_target_in_reach_is_met_and_rotations_carry_the_bones_there(void **state)
{
    (void)state;
    ff_random random = {1, 1, 0};
    for (int i = 0; i < 2000; ++i) {
        ff_leg leg = leg_bent(ff_random_range(&random, -0.6, 1.0), ff_random_range(&random, 0.02, 1.5));
        ff_vec3 hip = ff_v3(0.1, ff_random_range(&random, 0.8, 0.95), 0.0);
        ff_vec3 away =
            ff_unit3(ff_v3(ff_random_range(&random, -0.4, 0.4), -1.0, ff_random_range(&random, -0.8, 0.8)));
        ff_vec3 ankle = ff_madd3(hip, away, ff_random_range(&random, 0.2, 0.98 * 0.82));
        ff_leg_solve(&leg, hip, ankle);
        FF_ASSERT_BELOW(ff_length3(ff_sub3(leg.ankle, ankle)), 1e-9);
        check_bones(&leg);
    }
}

static void the_knee_bends_forward_and_moves_without_jumps(void **state)
{
    (void)state;
    ff_random random = {2, 1, 0};
    for (int path = 0; path < 50; ++path) {
        double side = ff_random_range(&random, -0.35, 0.35), rise = ff_random_range(&random, 0.0, 0.15);
        ff_vec3 last = {0.0, 0.0, 0.0};
        for (int i = 0; i <= 400; ++i) {
            double t = i / 400.0;
            ff_leg leg =
                leg_bent(0.5 * ff_cos(FF_TAU * t), 0.1 + 0.9 * ff_sin(FF_PI * t) * ff_sin(FF_PI * t));
            ff_vec3 ankle = ff_v3(0.1 + side * t, 0.09 + rise * ff_sin(FF_PI * t), 0.35 * ff_cos(FF_TAU * t));
            ff_leg_solve(&leg, leg.hip, ankle);
            ff_vec3 middle = ff_scale3(ff_add3(leg.hip, leg.ankle), 0.5);
            assert_true(leg.knee.z > middle.z);
            if (i > 0) FF_ASSERT_BELOW(ff_length3(ff_sub3(leg.knee, last)), 0.02);
            last = leg.knee;
        }
    }
}

static void reach_eases_from_0_990_to_0_998_and_never_locks(void **state)
{
    (void)state;
    double last = 0.0;
    for (int i = 0; i < 4000; ++i) {
        double wanted = i * 0.0005, got = ff_leg_soft_reach(wanted, 0.82);
        assert_true(got >= last && got <= wanted + 1e-15 && got <= 0.998 * 0.82 + 1e-12);
        if (wanted < 0.99 * 0.82) FF_ASSERT_NEAR(got, wanted, 1e-15);
        last = got;
    }
    ff_leg leg = leg_bent(0.0, 0.3);
    ff_leg_solve(&leg, leg.hip, ff_v3(0.1, -5.0, 0.0));
    check_bones(&leg);
    FF_ASSERT_NEAR(ff_length3(ff_sub3(leg.ankle, leg.hip)), 0.998 * 0.82, 1e-9);
}

static void a_straight_leg_bends_at_the_front_of_the_thigh(void **state)
{
    (void)state;
    ff_leg leg = leg_bent(0.0, 0.0);
    ff_leg_solve(&leg, leg.hip, ff_v3(0.1, 0.2, 0.0));
    check_bones(&leg);
    assert_true(leg.knee.z > 0.1);
    FF_ASSERT_NEAR(leg.knee.x, 0.1, 1e-9);
}

static void reach_that_is_eased_can_be_undone(void **state)
{
    (void)state;
    for (double share = 0.5; share < 0.9975; share += 0.0005) {
        double length = 0.9, far = ff_leg_hard_reach(share * length, length);
        FF_ASSERT_NEAR(ff_leg_soft_reach(far, length), share * length, 1e-6);
    }
    assert_true(isfinite(ff_leg_hard_reach(0.95, 0.9))); /* more than any leg has */
}

static void a_knee_bent_backward_comes_out_bent_forward(void **state)
{
    (void)state;
    for (int i = -40; i <= 40; ++i) {
        ff_leg leg = leg_bent(0.3, 0.01 * i);
        ff_vec3 ankle = ff_v3(0.1, 0.2, 0.1);
        ff_leg_solve(&leg, leg.hip, ankle);
        check_bones(&leg);
        assert_true(leg.knee.z > 0.5 * (leg.hip.z + ankle.z) + 0.1);
    }
}

static void assert_same_leg(const ff_legs *legs, int half, const ff_leg *alone)
{
    const ff_vec3 got[3] = {ff_pair3_half(legs->hip, half), ff_pair3_half(legs->knee, half),
                            ff_pair3_half(legs->ankle, half)};
    const ff_vec3 want[3] = {alone->hip, alone->knee, alone->ankle};
    const ff_quat turned[2] = {ff_pairq_half(legs->thigh, half), ff_pairq_half(legs->shank, half)};
    const ff_quat turn[2] = {alone->thigh, alone->shank};
    assert_memory_equal(got, want, sizeof got);
    assert_memory_equal(turned, turn, sizeof turned);
}

static void two_legs_at_once_are_each_as_alone_to_the_bit(void **state)
{
    (void)state;
    ff_random random = {3, 1, 0};
    for (int i = 0; i < 500; ++i) {
        ff_leg leg[2];
        ff_vec3 ankle[2];
        for (int k = 0; k < 2; ++k) {
            leg[k] = leg_bent(ff_random_range(&random, -0.6, 1.0), ff_random_range(&random, 0.02, 1.5));
            ankle[k] = ff_v3(ff_random_range(&random, -0.5, 0.5), ff_random_range(&random, -0.2, 1.0),
                             ff_random_range(&random, -0.8, 0.8));
        }
        /* Now and then one of the two is turned right round, out of reach, or has no way to go at all. */
        if (i % 10 == 0) ankle[0] = ff_sub3(ff_scale3(leg[0].hip, 2.0), leg[0].ankle);
        if (i % 10 == 1) ankle[1] = ff_v3(0.0, -9.0, 0.0);
        if (i % 10 == 2) ankle[0] = leg[0].hip;
        ff_legs legs = {ff_pair3_of(leg[0].hip, leg[1].hip),     ff_pair3_of(leg[0].knee, leg[1].knee),
                        ff_pair3_of(leg[0].ankle, leg[1].ankle), ff_pairq_of(leg[0].thigh, leg[1].thigh),
                        ff_pairq_of(leg[0].shank, leg[1].shank), ff_pairq_of(leg[0].foot, leg[1].foot)};
        ff_legs_solve(&legs, legs.hip, ff_pair3_of(ankle[0], ankle[1]));
        for (int k = 0; k < 2; ++k) {
            ff_leg_solve(&leg[k], leg[k].hip, ankle[k]);
            assert_true(isfinite(leg[k].knee.x) && isfinite(leg[k].thigh.w) && isfinite(leg[k].shank.w));
            assert_same_leg(&legs, k, &leg[k]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_target_in_reach_is_met_and_rotations_carry_the_bones_there),
        cmocka_unit_test(the_knee_bends_forward_and_moves_without_jumps),
        cmocka_unit_test(reach_eases_from_0_990_to_0_998_and_never_locks),
        cmocka_unit_test(a_straight_leg_bends_at_the_front_of_the_thigh),
        cmocka_unit_test(reach_that_is_eased_can_be_undone),
        cmocka_unit_test(a_knee_bent_backward_comes_out_bent_forward),
        cmocka_unit_test(two_legs_at_once_are_each_as_alone_to_the_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
