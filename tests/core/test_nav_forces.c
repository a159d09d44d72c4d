/* Times to collision, forces and density against closed forms and finite differences (algorithms H). */
#include "runtime/core/base/random.h"
#include "runtime/core/nav/nav_density.h"
#include "runtime/core/nav/nav_forces.h"
#include "tests/check.h"

static void time_to_collision_of_discs_matches_the_anchors(void **state)
{
    (void)state;
    ff_vec2 v = ff_v2(2.6, 0.0);
    FF_ASSERT_NEAR(ff_time_to_disc(ff_v2(-3.0, 0.0), v, 0.5), 0.96154, 5e-6);
    FF_ASSERT_NEAR(ff_time_to_disc(ff_v2(-3.0, 0.2), v, 0.5), 0.97759, 5e-6);
    FF_ASSERT_NEAR(ff_time_to_disc(ff_v2(-1.8, 0.05), v, 0.5), 0.50096, 5e-6);
    FF_ASSERT_NEAR(ff_time_to_disc(ff_v2(-3.0, 0.499), v, 0.5), 1.14169, 5e-6);
    assert_true(isinf(ff_time_to_disc(ff_v2(-3.0, 0.51), v, 0.5)));
    assert_true(isinf(ff_time_to_disc(ff_v2(3.0, 0.0), v, 0.5)));
    assert_true(isinf(ff_time_to_disc(ff_v2(-3.0, 0.0), ff_v2(0.0, 0.0), 0.5)));
    FF_ASSERT_NEAR(ff_time_to_disc(ff_v2(0.3, 0.0), v, 0.5), 0.0, 0.0);
    FF_ASSERT_NEAR(ff_time_to_disc(ff_v2(0.0, 0.0), ff_v2(0.0, 0.0), 0.5), 0.0, 0.0);
}

static void the_power_law_matches_the_anchors(void **state)
{
    (void)state;
    const double anchor[][4] = {{-3.0, 0.0, -1.09296, 0.0},
                                {-3.0, 0.2, -1.03683, 0.45251},
                                {-1.8, 0.05, -8.41459, 0.84570},
                                {-3.0, 0.499, -0.63078, 9.95852}};
    for (size_t i = 0; i < 4; ++i) {
        ff_vec2 f = ff_power_law(ff_v2(anchor[i][0], anchor[i][1]), ff_v2(2.6, 0.0), 0.5);
        FF_ASSERT_NEAR(f.a, anchor[i][2], 6e-6);
        FF_ASSERT_NEAR(f.b, anchor[i][3], 6e-6);
    }
    FF_ASSERT_NEAR(
        ff_length2(ff_force_from_disc(ff_v2(-3.0, 0.499), ff_v2(2.6, 0.0), 0.5, FF_FORCE_MAX, ff_v2(1, 0))),
        FF_FORCE_MAX, 1e-12);
}

static void a_wall_one_second_away_pushes_as_computed(void **state)
{
    (void)state;
    /* The centre is 1.3 m from the wall: h = 1 m with r = 0.3. */
    ff_wall wall = ff_wall_between(ff_v2(-5.0, 0.0), ff_v2(5.0, 0.0));
    const ff_wall *walls[1] = {&wall};
    ff_vec2 gradient;
    FF_ASSERT_NEAR(ff_time_to_wall(&wall, ff_v2(0.0, 1.3), ff_v2(0.0, -1.0), 0.3, &gradient), 1.0, 1e-12);
    ff_vec2 f = ff_force_from_walls(walls, 1, ff_v2(0.0, 1.3), ff_v2(0.0, -1.0), 0.3, FF_FORCE_MAX);
    FF_ASSERT_NEAR(f.a, 0.0, 1e-12);
    FF_ASSERT_NEAR(f.b, 2.50786, 6e-6);
    f = ff_force_from_walls(walls, 1, ff_v2(0.0, -1.3), ff_v2(0.0, 1.0), 0.3,
                            FF_FORCE_MAX); /* the other side is solid too */
    FF_ASSERT_NEAR(f.b, -2.50786, 6e-6);
}

static void a_chain_of_segments_pushes_like_one_wall(void **state)
{
    (void)state;
    ff_wall part[8], whole = ff_wall_between(ff_v2(-2.0, 0.0), ff_v2(2.0, 0.0));
    const ff_wall *parts[8], *one[1] = {&whole};
    for (int i = 0; i < 8; ++i) {
        part[i] = ff_wall_between(ff_v2(-2.0 + 0.5 * i, 0.0), ff_v2(-1.5 + 0.5 * i, 0.0));
        parts[i] = &part[i];
    }
    ff_vec2 p = ff_v2(0.13, 1.0), v = ff_v2(0.4, -1.1);
    ff_vec2 f = ff_force_from_walls(parts, 8, p, v, 0.3, FF_FORCE_MAX),
            g = ff_force_from_walls(one, 1, p, v, 0.3, FF_FORCE_MAX);
    FF_ASSERT_NEAR(f.a, g.a, 1e-12);
    FF_ASSERT_NEAR(f.b, g.b, 1e-12);
}

static void gradients_agree_with_finite_differences(void **state)
{
    (void)state;
    ff_random random = {7, 8, 0};
    ff_wall wall = ff_wall_between(ff_v2(-0.7, 0.2), ff_v2(0.9, -0.4));
    int tried = 0;
    const double e = 1e-6;
    for (int i = 0; i < 20000; ++i) {
        ff_vec2 p = ff_v2(ff_random_range(&random, -4, 4), ff_random_range(&random, -4, 4));
        ff_vec2 v = ff_v2(ff_random_range(&random, -2, 2), ff_random_range(&random, -2, 2)), gradient;
        for (int kind = 0; kind < 2; ++kind) {
            double time = kind ? ff_time_to_wall(&wall, p, v, 0.3, &gradient) : ff_time_to_disc(p, v, 0.5);
            if (!kind) gradient = ff_time_to_disc_gradient(p, v, 0.5);
            /* Near a graze the second derivative swamps the difference. */
            if (!(time > 0.01 && time < 10.0) || ff_length2(gradient) > 5.0) continue;
            double d[2];
            for (int axis = 0; axis < 2; ++axis) {
                ff_vec2 step = axis ? ff_v2(0.0, e) : ff_v2(e, 0.0), up = ff_add2(p, step),
                        down = ff_sub2(p, step);
                double high = kind ? ff_time_to_wall(&wall, up, v, 0.3, NULL) : ff_time_to_disc(up, v, 0.5);
                double low =
                    kind ? ff_time_to_wall(&wall, down, v, 0.3, NULL) : ff_time_to_disc(down, v, 0.5);
                d[axis] = (high - low) / (2.0 * e);
            }
            FF_ASSERT_NEAR(gradient.a, d[0], 2e-3);
            FF_ASSERT_NEAR(gradient.b, d[1], 2e-3);
            ++tried;
        }
    }
    assert_true(tried > 3000);
}

static void time_to_a_wall_is_when_the_disc_first_touches(void **state)
{
    (void)state;
    ff_random random = {9, 8, 0};
    for (int i = 0; i < 3000; ++i) {
        ff_wall wall =
            ff_wall_between(ff_v2(ff_random_range(&random, -2, 2), ff_random_range(&random, -2, 2)),
                            ff_v2(ff_random_range(&random, -2, 2), ff_random_range(&random, -2, 2)));
        ff_vec2 p = ff_v2(ff_random_range(&random, -4, 4), ff_random_range(&random, -4, 4));
        ff_vec2 v = ff_v2(ff_random_range(&random, -2, 2), ff_random_range(&random, -2, 2));
        double time = ff_time_to_wall(&wall, p, v, 0.3, NULL), least = INFINITY;
        for (int k = 0; k <= 400; ++k) {
            ff_vec2 q = ff_madd2(p, v, ff_min(time, 8.0) * k / 400.0);
            double gap = ff_length2(ff_sub2(q, ff_wall_nearest(&wall, q))) - 0.3;
            if (k < 400) least = ff_min(least, gap);
            if (k == 400 && time > 0.0 && time < 8.0) FF_ASSERT_NEAR(gap, 0.0, 1e-6);
        }
        if (time > 0.0) assert_true(least > -1e-6);
    }
}

static void overlapping_and_coincident_pairs_get_a_finite_push_apart(void **state)
{
    (void)state;
    ff_vec2 f = ff_force_from_disc(ff_v2(0.3, 0.0), ff_v2(0.0, 0.0), 0.6, FF_FORCE_MAX, ff_v2(1, 0));
    FF_ASSERT_NEAR(f.a, 5.0, 1e-9);
    f = ff_force_from_disc(ff_v2(0.0, 0.0), ff_v2(0.0, 0.0), 0.6, FF_FORCE_MAX, ff_v2(-1, 0));
    FF_ASSERT_NEAR(f.a, -5.0, 1e-9);
    f = ff_force_from_disc(ff_v2(-0.5, 0.01), ff_v2(1.0, 0.0), 0.6, FF_FORCE_MAX, ff_v2(1, 0));
    assert_true(isfinite(f.a) && isfinite(f.b) && f.a < 0.0);
    ff_wall wall = ff_wall_between(ff_v2(-1.0, 0.0), ff_v2(1.0, 0.0));
    const ff_wall *walls[1] = {&wall};
    f = ff_force_from_walls(walls, 1, ff_v2(0.0, 0.0), ff_v2(0.0, 1.0), 0.3, FF_FORCE_MAX);
    assert_true(isfinite(f.a) && isfinite(f.b));
}

static void the_density_filter_matches_the_anchors(void **state)
{
    (void)state;
    const struct {
        double agents, beta, speed;
    } anchor[] = {{3, 0.5, 1.586}, {4, 0.5, 0.892}, {5, 0.5, 0.571}, {6, 0.5, 0.396},
                  {2, 0.9, 2.224}, {3, 0.9, 0.988}, {4, 0.9, 0.556}};
    double one = ff_density_of_agent(ff_v2(0.0, 0.0), ff_v2(1.0, 0.0));
    FF_ASSERT_NEAR(one, 0.2660, 5e-5);
    for (size_t i = 0; i < sizeof anchor / sizeof *anchor; ++i)
        FF_ASSERT_NEAR(ff_density_speed(anchor[i].agents * one, anchor[i].beta), anchor[i].speed, 6e-4);
    assert_true(ff_density_speed(0.0, 0.0) > 1000.0);
    double across = ff_density_of_agent(ff_v2(0.0, 0.6), ff_v2(1.0, 0.0));
    FF_ASSERT_NEAR(across, ff_density_of_agent(ff_v2(1.5, 0.0), ff_v2(1.0, 0.0)), 1e-12);
    FF_ASSERT_NEAR(ff_density_of_wall(ff_v2(0.0, 0.75)), one * exp(-0.5), 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(time_to_collision_of_discs_matches_the_anchors),
        cmocka_unit_test(the_power_law_matches_the_anchors),
        cmocka_unit_test(a_wall_one_second_away_pushes_as_computed),
        cmocka_unit_test(a_chain_of_segments_pushes_like_one_wall),
        cmocka_unit_test(gradients_agree_with_finite_differences),
        cmocka_unit_test(time_to_a_wall_is_when_the_disc_first_touches),
        cmocka_unit_test(overlapping_and_coincident_pairs_get_a_finite_push_apart),
        cmocka_unit_test(the_density_filter_matches_the_anchors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
