/* The velocity hull's half-planes (algorithms A.11, H). */
#include "runtime/core/base/random.h"
#include "runtime/core/nav/nav_hull.h"
#include "tests/check.h"

static bool holds(const ff_line *lines, uint32_t count, ff_vec2 v)
{
    for (uint32_t i = 0; i < count; ++i)
        if (ff_line_violation(lines[i], v) > 1e-9) return false;
    return true;
}

static ff_pack_point2 example(double speed, double turn)
{
    return (ff_pack_point2){(float)(speed * cos(turn)), (float)(speed * sin(turn))};
}

static void the_hull_of_the_anchor_examples_holds_what_it_should(void **state)
{
    (void)state;
    const ff_pack_point2 points[] = {example(1.3, 0.0), example(1.2, 0.6), example(1.2, -0.6),
                                     example(0.7, 1.6), example(0.7, -1.6)};
    ff_hull hull;
    ff_hull_make(points, 5, &hull);
    assert_true(holds(hull.line, hull.count, ff_v2(0.0, 0.0)));
    assert_true(holds(hull.line, hull.count, ff_v2(0.9, 0.2)));
    assert_false(holds(hull.line, hull.count, ff_v2(1.0, 1.0)));
    assert_false(holds(hull.line, hull.count, ff_v2(-0.3, 0.0)));
    FF_ASSERT_NEAR(hull.speed, 1.3, 1e-6);
}

static void the_origin_is_always_inside(void **state)
{
    (void)state;
    const ff_pack_point2 ahead[] = {{1.0f, 0.3f}, {1.0f, -0.3f}, {1.4f, 0.0f}};
    ff_hull hull;
    ff_hull_make(ahead, 3, &hull);
    assert_true(holds(hull.line, hull.count, ff_v2(0.0, 0.0)));
    assert_true(holds(hull.line, hull.count, ff_v2(0.7, 0.0)));
    assert_false(holds(hull.line, hull.count, ff_v2(0.5, 0.3)));
}

static void examples_on_one_line_give_a_box(void **state)
{
    (void)state;
    const ff_pack_point2 line[] = {{0.5f, 0.0f}, {1.5f, 0.0f}};
    ff_hull hull;
    ff_hull_make(line, 2, &hull);
    assert_int_equal(hull.count, 4);
    assert_true(holds(hull.line, 4, ff_v2(1.49, 0.44)) && holds(hull.line, 4, ff_v2(0.0, 0.0)));
    assert_false(holds(hull.line, 4, ff_v2(1.0, 0.46)) || holds(hull.line, 4, ff_v2(-0.01, 0.0)));
    ff_hull_make(NULL, 0, &hull); /* nothing is known: the body alone limits */
    assert_int_equal(hull.count, 0);
}

static void a_hull_with_many_corners_is_cut_from_inside(void **state)
{
    (void)state;
    ff_pack_point2 circle[200];
    for (int i = 0; i < 200; ++i)
        circle[i] =
            (ff_pack_point2){(float)(0.4 + 1.2 * cos(FF_TAU * i / 200.0)), (float)sin(FF_TAU * i / 200.0)};
    ff_hull hull;
    ff_hull_make(circle, 200, &hull);
    assert_int_equal(hull.count, FF_HULL_MAX);
    for (int i = 0; i < 200; ++i) {
        ff_vec2 v = ff_v2(0.4 + 1.2 * cos(FF_TAU * i / 200.0), sin(FF_TAU * i / 200.0));
        assert_true(holds(hull.line, hull.count, ff_v2(0.4 + 0.96 * (v.a - 0.4), 0.96 * v.b)));
        assert_false(holds(hull.line, hull.count, ff_v2(0.4 + 1.01 * (v.a - 0.4), 1.01 * v.b)));
    }
}

static void the_lines_turn_with_the_agent(void **state)
{
    (void)state;
    const ff_pack_point2 points[] = {{1.3f, 0.0f}, {1.0f, 0.6f}, {1.0f, -0.6f}, {-0.3f, 0.0f}};
    ff_hull hull;
    ff_line lines[FF_LINES_MAX];
    ff_hull_make(points, 4, &hull);
    ff_random random = {1, 1, 0};
    for (int i = 0; i < 2000; ++i) {
        ff_vec2 facing = ff_fwd2(ff_random_range(&random, -FF_PI, FF_PI));
        ff_vec2 v = ff_v2(ff_random_range(&random, -1.5, 1.5), ff_random_range(&random, -1.5, 1.5));
        uint32_t count = ff_hull_lines(&hull, facing, lines, 0);
        assert_true(holds(hull.line, hull.count, v) == holds(lines, count, ff_from_frame2(facing, v)));
    }
}

static void a_sharp_turn_forbids_swerving_until_it_is_nearly_done(void **state)
{
    (void)state;
    ff_line line;
    double side = 0.0;
    ff_vec2 facing = ff_v2(1.0, 0.0);
    assert_int_equal(ff_hull_sharp_turn(facing, ff_fwd2(85 * FF_DEG), &side, &line, 0), 0);
    assert_int_equal(ff_hull_sharp_turn(facing, ff_fwd2(95 * FF_DEG), &side, &line, 0), 1);
    FF_ASSERT_NEAR(side, 1.0, 0.0);
    assert_true(holds(&line, 1, ff_v2(1.0, 0.29)) && holds(&line, 1, ff_v2(0.0, -1.0)));
    assert_false(holds(&line, 1, ff_v2(0.0, 0.31)));
    assert_int_equal(ff_hull_sharp_turn(facing, ff_fwd2(85 * FF_DEG), &side, &line, 0), 1);
    assert_int_equal(ff_hull_sharp_turn(facing, ff_fwd2(75 * FF_DEG), &side, &line, 0), 0);
    assert_int_equal(ff_hull_sharp_turn(facing, ff_fwd2(-170 * FF_DEG), &side, &line, 0), 1);
    FF_ASSERT_NEAR(side, -1.0, 0.0);
    assert_false(holds(&line, 1, ff_v2(0.0, -0.31)));
    assert_int_equal(ff_hull_sharp_turn(facing, ff_v2(0.0, 0.0), &side, &line, 0), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hull_of_the_anchor_examples_holds_what_it_should),
        cmocka_unit_test(the_origin_is_always_inside),
        cmocka_unit_test(examples_on_one_line_give_a_box),
        cmocka_unit_test(a_hull_with_many_corners_is_cut_from_inside),
        cmocka_unit_test(the_lines_turn_with_the_agent),
        cmocka_unit_test(a_sharp_turn_forbids_swerving_until_it_is_nearly_done),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
