/* The standing foot's half-plane (FbCrowd eq 6-8 in the reading of nav_stance.h) and the rules of facing, against closed
 * forms. */
#include "runtime/core/nav/nav_facing.h"
#include "runtime/core/nav/nav_stance.h"
#include "tests/check.h"

#define STEP (1.0 / 30.0)

static const ff_stance left_foot = {0, {0.0, 0.1}, 0.0}; /* under the left hip, pointing ahead */
static const ff_stance right_foot = {1, {0.0, -0.1}, 0.0};

static ff_line line_of(const ff_stance *stance, ff_vec2 command, ff_stance_memory *memory, uint32_t *count)
{
    ff_line line = {0};
    *count = ff_stance_line(stance, ff_v2(0.0, 0.0), 0.3, ff_v2(1.2, 0.0), command, STEP, memory, &line, 0);
    return line;
}

static void the_forbidden_side_is_across_the_foot_turned_out_by_forty_degrees(void **state)
{
    (void)state;
    ff_vec2 n = ff_stance_normal(&left_foot);
    FF_ASSERT_NEAR(n.a, -sin(40.0 * FF_DEG), 1e-12);
    FF_ASSERT_NEAR(n.b, cos(40.0 * FF_DEG), 1e-12);
    n = ff_stance_normal(&right_foot);
    FF_ASSERT_NEAR(n.a, -sin(40.0 * FF_DEG), 1e-12);
    FF_ASSERT_NEAR(n.b, -cos(40.0 * FF_DEG), 1e-12);
}

static void room_is_what_is_left_between_disc_and_foot_over_a_swing(void **state)
{
    (void)state;
    FF_ASSERT_NEAR(ff_stance_room(&left_foot, ff_v2(0.0, 0.0), 0.3), 0.0, 0.0); /* under the disc */
    ff_stance wide = {0, {0.0, 0.6}, -40.0 * FF_DEG}; /* turned out: straight ahead */
    FF_ASSERT_NEAR(ff_stance_room(&wide, ff_v2(0.0, 0.0), 0.3), 0.3 / 0.4, 1e-12);
}

static void walking_ahead_and_to_the_free_side_is_allowed_and_across_the_foot_is_not(void **state)
{
    (void)state;
    ff_stance_memory memory = {0};
    uint32_t count = 0;
    ff_line line = {0};
    for (int i = 0; i < 10; ++i)
        line = line_of(&left_foot, ff_v2(1.2, 0.0), &memory, &count);
    assert_int_equal(count, 1);
    const ff_vec2 allowed[] = {{0.0, 0.0}, {1.3, 0.0}, {1.0, 0.8}, {0.8, -0.6}, {0.0, -0.6}};
    const ff_vec2 forbidden[] = {{0.0, 0.5}, {0.5, 0.6}, {0.2, 1.0}};
    for (size_t i = 0; i < sizeof allowed / sizeof *allowed; ++i)
        assert_true(ff_line_violation(line, allowed[i]) <= 1e-12);
    for (size_t i = 0; i < sizeof forbidden / sizeof *forbidden; ++i)
        assert_true(ff_line_violation(line, forbidden[i]) > 0.0);
}

static void a_new_foots_line_comes_in_over_a_tenth_of_a_second(void **state)
{
    (void)state;
    ff_stance_memory memory = {0};
    ff_vec2 command = ff_v2(0.0, 0.6), n = ff_stance_normal(&left_foot);
    double asked = ff_dot2(command, n), last = asked + 1.0;
    uint32_t count = 0;
    for (int i = 0; i < 4; ++i) {
        ff_line line = line_of(&left_foot, command, &memory, &count);
        double offset = ff_dot2(line.point, n);
        FF_ASSERT_NEAR(offset, asked * ff_max(0.0, 1.0 - (i + 1) * STEP / 0.1), 1e-12);
        assert_true(offset <= last);
        last = offset;
    }
    line_of(&right_foot, command, &memory, &count);
    FF_ASSERT_NEAR(memory.ease, STEP / 0.1, 1e-12); /* begins anew */
}

static void there_is_no_line_on_both_feet_nor_for_the_slow(void **state)
{
    (void)state;
    ff_stance both = {.foot = -1};
    ff_stance_memory memory = {0};
    ff_line line;
    ff_vec2 p = ff_v2(0.0, 0.0), fast = ff_v2(1.0, 0.0), slow = ff_v2(0.29, 0.0);
    assert_int_equal(ff_stance_line(&both, p, 0.3, fast, fast, STEP, &memory, &line, 0), 0);
    assert_int_equal(ff_stance_line(&left_foot, p, 0.3, slow, slow, STEP, &memory, &line, 0), 0);
    assert_int_equal(ff_stance_line(&left_foot, p, 0.3, fast, fast, STEP, &memory, &line, 0), 1);
}

static double face(ff_facing rule, bool back_pedal, ff_vec2 preferred, ff_vec2 command, double *strafing)
{
    return ff_nav_facing((ff_facing_rule){rule, back_pedal}, preferred, command, 0.7, STEP, strafing);
}

static void each_rule_faces_where_it_says(void **state)
{
    (void)state;
    double strafing = 0.0;
    ff_vec2 ahead = ff_v2(1.0, 0.0), aside = ff_v2(0.0, 1.0), back = ff_v2(-0.5, 0.0), none = ff_v2(0.0, 0.0);
    ff_vec2 oblique = ff_v2(0.1, 1.0); /* less than 90 degrees off */
    double half = 0.5 * ff_atan2(1.0, 0.1);
    FF_ASSERT_NEAR(face(FF_FACING_HALFWAY, false, ahead, oblique, &strafing), half, 1e-9);
    /* Pushed back he faces on, unless he has to run. */
    FF_ASSERT_NEAR(face(FF_FACING_HALFWAY, false, ahead, back, &strafing), 0.0, 1e-9);
    FF_ASSERT_NEAR(face(FF_FACING_HALFWAY, false, ahead, ff_v2(-1.2, 0.0), &strafing), FF_PI, 1e-9);
    FF_ASSERT_NEAR(face(FF_FACING_COMMAND, false, ahead, back, &strafing), FF_PI, 1e-9);
    FF_ASSERT_NEAR(face(FF_FACING_PREFERRED, false, ahead, back, &strafing), 0.0, 1e-9);
    FF_ASSERT_NEAR(face(FF_FACING_COMMAND, false, ahead, aside, &strafing), 0.5 * FF_PI, 1e-9);
    FF_ASSERT_NEAR(face(FF_FACING_COMMAND, true, ahead, back, &strafing), 0.0,
                   1e-9); /* backs off, facing on */
    FF_ASSERT_NEAR(face(FF_FACING_HALFWAY, true, ahead, ff_v2(-1.2, 0.0), &strafing), FF_PI, 1e-9);
    FF_ASSERT_NEAR(face(FF_FACING_HALFWAY, false, ahead, none, &strafing), 0.0, 1e-9);
    FF_ASSERT_NEAR(face(FF_FACING_HALFWAY, false, none, none, &strafing), 0.7, 0.0); /* as before */
}

static void side_stepping_lasts_a_second_and_then_rests_for_one(void **state)
{
    (void)state;
    double strafing = 0.0;
    ff_vec2 ahead = ff_v2(1.0, 0.0), way = ff_v2(0.6, 0.6);
    int to_the_goal = 0, along = 0;
    for (int i = 0; i < 60; ++i) {
        double heading = face(FF_FACING_STRAFE, false, ahead, way, &strafing);
        to_the_goal += fabs(heading) < 1e-9;
        along += fabs(heading - 0.25 * FF_PI) < 1e-9;
    }
    assert_int_equal(to_the_goal + along, 60);
    assert_in_range(to_the_goal, 29, 31);
    /* Hardly aside is no side-stepping and is never interrupted. */
    strafing = 0.0;
    for (int i = 0; i < 90; ++i)
        FF_ASSERT_NEAR(face(FF_FACING_STRAFE, false, ahead, ff_v2(1.0, 0.2), &strafing), 0.0, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_forbidden_side_is_across_the_foot_turned_out_by_forty_degrees),
        cmocka_unit_test(room_is_what_is_left_between_disc_and_foot_over_a_swing),
        cmocka_unit_test(walking_ahead_and_to_the_free_side_is_allowed_and_across_the_foot_is_not),
        cmocka_unit_test(a_new_foots_line_comes_in_over_a_tenth_of_a_second),
        cmocka_unit_test(there_is_no_line_on_both_feet_nor_for_the_slow),
        cmocka_unit_test(each_rule_faces_where_it_says),
        cmocka_unit_test(side_stepping_lasts_a_second_and_then_rests_for_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
