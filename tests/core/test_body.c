/* The body that follows commands: root motion is exactly the rates, with lag, within the clamp, off the walls. */
#include "runtime/core/base/random.h"
#include "runtime/core/gait/body.h"
#include "tests/check.h"

/* The box of the navigation study, section 1. */
static ff_rates box(const void *context, ff_rates target)
{
    (void)context;
    target.turn = ff_clamp(target.turn, -2.5, 2.5);
    target.forward = ff_clamp(target.forward, -0.3, ff_clamp(2.2 - 0.75 * fabs(target.turn), 0.3, 1.75));
    double side = 0.65 * (1.0 - 0.7 * ff_clamp(target.forward - 1.2, 0.0, 1.0));
    target.left = ff_clamp(target.left, -side, side);
    return target;
}

static const ff_body_limits open_ground = {box, NULL, NULL, 0, 0.3, false};

static void a_command_is_reached_with_the_lag_of_legs(void **state)
{
    (void)state;
    ff_body body = {.phase = 0.0};
    double half = -1.0, time = 0.0;
    for (int i = 0; i < 60; ++i) {
        ff_body_step(&body, ff_v2(1.3, 0.0), 0.0, 1.0 / 30.0, &open_ground);
        time += 1.0 / 30.0;
        if (half < 0.0 && body.rates.forward >= 0.65) half = time;
    }
    assert_true(half > 0.1 && half < 0.5);
    FF_ASSERT_NEAR(body.rates.forward, 1.3, 0.02);
    FF_ASSERT_NEAR(body.rates.left, 0.0, 1e-12);
    FF_ASSERT_NEAR(body.position.b, 0.0, 1e-12);
    assert_true(body.position.a > 1.3 * (2.0 - 0.8) && body.position.a < 1.3 * (2.0 - 0.2));
}

static void the_root_moves_by_exactly_the_rates_it_reports(void **state)
{
    (void)state;
    ff_random random = {4, 4, 0};
    ff_body body = {.heading = 1.0};
    ff_vec2 command = ff_v2(0.0, 0.0);
    double facing = 1.0;
    for (int i = 0; i < 600; ++i) {
        if (i % 20 == 0) {
            command = ff_v2(ff_random_range(&random, -1.5, 1.5), ff_random_range(&random, -1.5, 1.5));
            facing = ff_random_range(&random, -FF_PI, FF_PI);
        }
        /* One sub-step a call, so that the mean rates are the rates of the whole call. */
        double dt = 1.0 / 60.0;
        ff_body before = body;
        ff_rates rates = ff_body_step(&body, command, facing, dt, &open_ground);
        ff_vec2 v =
            ff_from_frame2(ff_fwd2(before.heading + 0.5 * rates.turn * dt), ff_v2(rates.forward, rates.left));
        FF_ASSERT_NEAR(body.position.a - before.position.a, v.a * dt, 1e-14);
        FF_ASSERT_NEAR(body.position.b - before.position.b, v.b * dt, 1e-14);
        FF_ASSERT_NEAR(ff_wrap(body.heading - before.heading), rates.turn * dt, 1e-14);
        ff_vec2 change = ff_v2(rates.forward - before.rates.forward, rates.left - before.rates.left);
        FF_ASSERT_BELOW(ff_length2(change), 4.0 * dt + 1e-12);
        FF_ASSERT_BELOW(fabs(rates.turn), 2.5);
    }
}

static void the_step_length_of_the_crowd_hardly_matters(void **state)
{
    (void)state;
    ff_body fine = {.heading = 0.0}, coarse = fine;
    for (int i = 0; i < 90; ++i)
        ff_body_step(&fine, ff_v2(0.9, 0.5), 0.6, 1.0 / 30.0, &open_ground);
    for (int i = 0; i < 30; ++i)
        ff_body_step(&coarse, ff_v2(0.9, 0.5), 0.6, 0.1, &open_ground);
    FF_ASSERT_NEAR(fine.position.a, coarse.position.a, 1e-9);
    FF_ASSERT_NEAR(fine.heading, coarse.heading, 1e-9);
}

static void who_is_told_to_stand_comes_to_a_full_stop(void **state)
{
    (void)state;
    ff_body body = {.rates = {1.3, 0.1, 0.8}};
    for (int i = 0; i < 60; ++i)
        ff_body_step(&body, ff_v2(0.05, 0.0), body.heading, 1.0 / 30.0, &open_ground);
    FF_ASSERT_NEAR(body.rates.forward, 0.0, 0.0);
    FF_ASSERT_NEAR(body.rates.left, 0.0, 0.0);
    FF_ASSERT_NEAR(body.rates.turn, 0.0, 0.0);
    FF_ASSERT_BELOW(body.position.a, 0.6);
}

static void a_facing_behind_is_turned_to_without_overshoot(void **state)
{
    (void)state;
    ff_body body = {.heading = 0.0};
    double fastest = 0.0;
    for (int i = 0; i < 120; ++i) {
        ff_body_step(&body, ff_v2(0.0, 0.0), 3.0, 1.0 / 30.0, &open_ground);
        fastest = ff_max(fastest, body.rates.turn);
        FF_ASSERT_BELOW(body.heading, 3.2);
    }
    FF_ASSERT_NEAR(body.heading, 3.0, 0.05);
    assert_true(fastest > 2.0 && fastest <= 2.5);
}

static void no_command_brings_the_disc_into_a_wall(void **state)
{
    (void)state;
    ff_random random = {6, 4, 0};
    const ff_vec2 corner[5] = {{-2, -2}, {2, -2}, {2.5, 1.5}, {-1.5, 2}, {-2, -2}};
    ff_wall wall[4];
    const ff_wall *walls[4];
    for (int i = 0; i < 4; ++i)
        wall[i] = ff_wall_between(corner[i], corner[i + 1]), walls[i] = &wall[i];
    ff_body_limits room = {box, NULL, walls, 4, 0.3, false};
    for (int run = 0; run < 40; ++run) {
        ff_body body = {.heading = ff_random_range(&random, -3, 3), .rates = {1.7, 0.0, 0.0}};
        ff_vec2 command = ff_v2(0, 0);
        for (int i = 0; i < 200; ++i) {
            if (i % 30 == 0) command = ff_scale2(ff_fwd2(ff_random_range(&random, -FF_PI, FF_PI)), 1.7);
            ff_body_step(&body, command, ff_atan2(command.b, command.a), i % 2 ? 0.1 : 1.0 / 30.0, &room);
            for (int k = 0; k < 4; ++k) {
                double gap = ff_length2(ff_sub2(body.position, ff_wall_nearest(walls[k], body.position)));
                assert_true(gap >= 0.3 - 1e-9);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_command_is_reached_with_the_lag_of_legs),
        cmocka_unit_test(the_root_moves_by_exactly_the_rates_it_reports),
        cmocka_unit_test(the_step_length_of_the_crowd_hardly_matters),
        cmocka_unit_test(who_is_told_to_stand_comes_to_a_full_stop),
        cmocka_unit_test(a_facing_behind_is_turned_to_without_overshoot),
        cmocka_unit_test(no_command_brings_the_disc_into_a_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
