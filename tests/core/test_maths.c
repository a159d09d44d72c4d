/* Maths against libm and closed forms. */
#include "tests/check.h"

static void sine_cosine_arctangent_and_exponential_agree_with_libm(void **state)
{
    (void)state;
    for (int i = -20000; i <= 20000; ++i) {
        double x = i * 0.0137;
        FF_ASSERT_NEAR(ff_sin(x), sin(x), 4e-16 + fabs(x) * 1e-17);
        FF_ASSERT_NEAR(ff_cos(x), cos(x), 4e-16 + fabs(x) * 1e-17);
        FF_ASSERT_NEAR(ff_atan2(sin(x) * 3.0, cos(x) * 3.0), atan2(sin(x) * 3.0, cos(x) * 3.0), 1e-15);
        double e = i * 0.001;
        FF_ASSERT_NEAR(ff_exp(e) / exp(e), 1.0, 1e-14);
        FF_ASSERT_NEAR(ff_exp(35.0 * e) / exp(35.0 * e), 1.0, 1e-14);
    }
    FF_ASSERT_NEAR(ff_exp(-740.0) / exp(-740.0), 1.0, 0.05); /* of its denormal size */
    assert_true(ff_exp(-1e300) == 0.0 && ff_exp(0.0) == 1.0 && isfinite(ff_exp(1e300)));
    for (int quarter = -9; quarter <= 9; ++quarter) {
        FF_ASSERT_NEAR(ff_sin(0.5 * FF_PI * quarter), sin(0.5 * FF_PI * quarter), 1e-15);
        FF_ASSERT_NEAR(ff_cos(0.5 * FF_PI * quarter), cos(0.5 * FF_PI * quarter), 1e-15);
        FF_ASSERT_NEAR(ff_sin(0.25 * FF_PI * quarter), sin(0.25 * FF_PI * quarter), 1e-15);
    }
    assert_true(isnan(ff_sin(NAN)) && isnan(ff_exp(NAN)));
}

static void heading_left_and_forward_keep_their_sign_in_plane_coordinates(void **state)
{
    (void)state;
    double psi = 0.9;
    ff_vec3 forward = ff_quat_rotate(ff_quat_yaw(psi), ff_v3(0.0, 0.0, 1.0));
    FF_ASSERT_NEAR(forward.x, 0.78333, 1e-5);
    FF_ASSERT_NEAR(forward.z, 0.62161, 1e-5);
    ff_vec2 f = ff_fwd2(psi), left = ff_left2(f);
    FF_ASSERT_NEAR(ff_ground(left, 0.0).x, 0.62161, 1e-5);
    FF_ASSERT_NEAR(ff_ground(left, 0.0).z, -0.78333, 1e-5);
    FF_ASSERT_NEAR(ff_det2(f, left), 1.0, 1e-15);
    FF_ASSERT_NEAR(ff_quat_heading(ff_quat_yaw(psi)), psi, 1e-15);
}

static void angles_wrap_into_the_half_open_circle(void **state)
{
    (void)state;
    FF_ASSERT_NEAR(ff_wrap(FF_PI), FF_PI, 0.0);
    FF_ASSERT_NEAR(ff_wrap(-FF_PI), FF_PI, 1e-15);
    FF_ASSERT_NEAR(ff_wrap(7.0), 7.0 - FF_TAU, 1e-15);
}

static void rotation_vectors_and_quaternions_are_inverse(void **state)
{
    (void)state;
    ff_vec3 v = ff_v3(0.3, -1.1, 0.7);
    ff_vec3 w = ff_quat_log(ff_quat_exp(v));
    FF_ASSERT_NEAR(ff_length3(ff_sub3(v, w)), 0.0, 1e-14);
    ff_quat between = ff_quat_between(ff_unit3(v), ff_v3(0.0, 1.0, 0.0));
    FF_ASSERT_NEAR(ff_quat_rotate(between, ff_unit3(v)).y, 1.0, 1e-14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sine_cosine_arctangent_and_exponential_agree_with_libm),
        cmocka_unit_test(heading_left_and_forward_keep_their_sign_in_plane_coordinates),
        cmocka_unit_test(angles_wrap_into_the_half_open_circle),
        cmocka_unit_test(rotation_vectors_and_quaternions_are_inverse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
