/* ORCA half-planes against a sampled definition of the velocity obstacle. */
#include "runtime/core/base/random.h"
#include "runtime/core/nav/nav_orca.h"
#include "tests/check.h"

/* Whether relative velocity v brings a disc at x (own minus other) within reach during horizon. */
static bool collides(ff_vec2 x, ff_vec2 v, double reach, double horizon)
{
    return ff_time_to_disc(x, v, reach) <= horizon;
}

static ff_vec2 random_vec(ff_random *random, double size)
{
    return ff_v2(ff_random_range(random, -size, size), ff_random_range(random, -size, size));
}

static void the_line_touches_the_velocity_obstacle_at_its_nearest_point(void **state)
{
    (void)state;
    ff_random random = {5, 1, 0};
    const double reach = 0.64, horizon = 2.5;
    int inside = 0, outside = 0;
    for (int round = 0; round < 3000; ++round) {
        ff_vec2 to_other = random_vec(&random, 4.0), own = random_vec(&random, 1.5);
        ff_vec2 relative = ff_sub2(own, random_vec(&random, 1.5)), x = ff_scale2(to_other, -1.0);
        if (ff_length2(to_other) < reach + 0.01) continue;
        ff_line line = ff_orca_disc(to_other, relative, own, reach, horizon, 1.0, 0.1, 0.0, ff_v2(1, 0));
        /* With full responsibility the line lies at the boundary point: relative + u. */
        ff_vec2 u = ff_sub2(line.point, own), boundary = ff_add2(relative, u);
        ff_vec2 outward = ff_left2(line.direction);
        assert_false(collides(x, ff_madd2(boundary, outward, 1e-6), reach, horizon));
        assert_true(collides(x, ff_madd2(boundary, outward, -1e-6), reach, horizon));
        bool now = collides(x, relative, reach, horizon);
        ++*(now ? &inside : &outside);
        assert_true((ff_dot2(u, outward) > 0.0) == now);
        /* No velocity nearer than |u| is on the other side of the boundary. */
        for (int k = 0; k < 24; ++k) {
            ff_vec2 near = ff_madd2(relative, ff_fwd2(FF_TAU * k / 24.0), 0.98 * ff_length2(u));
            assert_true(collides(x, near, reach, horizon) == now);
        }
    }
    assert_true(inside > 100 && outside > 300);
}

static void two_who_both_obey_their_lines_do_not_collide(void **state)
{
    (void)state;
    ff_random random = {5, 2, 0};
    const double reach = 0.64, horizon = 2.5;
    for (int round = 0; round < 2000; ++round) {
        ff_vec2 to_other = random_vec(&random, 4.0), v = random_vec(&random, 1.5),
                w = random_vec(&random, 1.5);
        if (ff_length2(to_other) < reach + 0.01) continue;
        ff_line mine = ff_orca_disc(to_other, ff_sub2(v, w), v, reach, horizon, 0.5, 0.1, 0.0, ff_v2(1, 0));
        ff_line theirs = ff_orca_disc(ff_scale2(to_other, -1.0), ff_sub2(w, v), w, reach, horizon, 0.5, 0.1,
                                      0.0, ff_v2(-1, 0));
        for (int k = 0; k < 20; ++k) {
            ff_vec2 a = random_vec(&random, 2.0), b = random_vec(&random, 2.0);
            if (ff_line_violation(mine, a) > -1e-9 || ff_line_violation(theirs, b) > -1e-9) continue;
            assert_false(collides(ff_scale2(to_other, -1.0), ff_sub2(a, b), reach, horizon));
        }
    }
}

static void an_overlapping_pair_is_told_to_part_and_identical_points_give_no_nan(void **state)
{
    (void)state;
    ff_line mine =
        ff_orca_disc(ff_v2(0.3, 0.0), ff_v2(0, 0), ff_v2(0, 0), 0.6, 2.5, 0.5, 0.1, 0.0, ff_v2(1, 0));
    assert_true(ff_line_violation(mine, ff_v2(0.0, 0.0)) > 0.0);
    assert_true(ff_line_violation(mine, ff_v2(-1.6, 0.0)) < 0.0);
    ff_vec2 zero = ff_v2(0.0, 0.0);
    ff_line p = ff_orca_disc(zero, zero, zero, 0.6, 2.5, 0.5, 0.1, 0.0, ff_v2(1, 0));
    ff_line q = ff_orca_disc(zero, zero, zero, 0.6, 2.5, 0.5, 0.1, 0.0, ff_v2(-1, 0));
    assert_true(isfinite(p.point.a) && isfinite(q.point.a));
    assert_true(p.point.a > 0.0 && q.point.a < 0.0);
}

/* ------------------------------------------------------------------------------------------------- walls */

static bool hits(const ff_wall *const *walls, uint32_t count, ff_vec2 p, ff_vec2 v, double horizon)
{
    for (uint32_t i = 0; i < count; ++i)
        if (ff_time_to_wall(walls[i], p, v, 0.3, NULL) <= horizon) return true;
    return false;
}

static bool allowed(const ff_line *lines, uint32_t count, ff_vec2 v)
{
    for (uint32_t i = 0; i < count; ++i)
        if (ff_line_violation(lines[i], v) > -1e-9) return false;
    return true;
}

static void no_velocity_that_the_lines_allow_hits_the_wall_and_standing_is_allowed(void **state)
{
    (void)state;
    ff_random random = {5, 3, 0};
    int open = 0;
    for (int round = 0; round < 3000; ++round) {
        ff_wall wall = ff_wall_between(random_vec(&random, 2.0), random_vec(&random, 2.0));
        const ff_wall *walls[1] = {&wall};
        ff_vec2 p = random_vec(&random, 3.0), own = random_vec(&random, 1.5);
        if (wall.length < 0.05 || ff_time_to_wall(&wall, p, own, 0.3, NULL) == 0.0) continue;
        ff_line line[2];
        assert_int_equal(ff_orca_walls(walls, 1, p, own, 0.3, 1.0, line, 0), 1);
        FF_ASSERT_BELOW(ff_line_violation(line[0], ff_v2(0.0, 0.0)), 1e-9);
        for (int k = 0; k < 30; ++k) {
            ff_vec2 v = random_vec(&random, 2.5);
            if (allowed(line, 1, v)) ++open, assert_false(hits(walls, 1, p, v, 1.0));
        }
        /* Tight: the nearest boundary point has a collision just behind it, and nothing nearer is on its side. */
        bool now = hits(walls, 1, p, own, 1.0);
        double distance = fabs(ff_line_violation(line[0], own));
        ff_vec2 outward = ff_left2(line[0].direction);
        assert_true(hits(walls, 1, p, ff_madd2(line[0].point, outward, -1e-6), 1.0));
        for (int k = 0; k < 24; ++k) {
            ff_vec2 near = ff_madd2(own, ff_fwd2(FF_TAU * k / 24.0), 0.98 * distance);
            assert_true(hits(walls, 1, p, near, 1.0) == now);
        }
    }
    assert_true(open > 10000);
}

static void a_chain_of_short_segments_allows_what_one_long_wall_allows(void **state)
{
    (void)state;
    ff_random random = {5, 4, 0};
    ff_wall part[10], whole = ff_wall_between(ff_v2(-2.5, 0.0), ff_v2(2.5, 0.0));
    const ff_wall *parts[10], *one[1] = {&whole};
    for (int i = 0; i < 10; ++i) {
        part[i] = ff_wall_between(ff_v2(-2.5 + 0.5 * i, 0.0), ff_v2(-2.0 + 0.5 * i, 0.0));
        parts[i] = &part[i];
    }
    for (int round = 0; round < 2000; ++round) {
        ff_vec2 p = ff_v2(ff_random_range(&random, -4.0, 4.0), ff_random_range(&random, 0.31, 1.5));
        ff_vec2 own = random_vec(&random, 1.5);
        ff_line chain[10], line[1];
        uint32_t count = ff_orca_walls(parts, 10, p, own, 0.3, 1.0, chain, 0);
        ff_orca_walls(one, 1, p, own, 0.3, 1.0, line, 0);
        for (int k = 0; k < 40; ++k) {
            ff_vec2 v = random_vec(&random, 1.5);
            if (allowed(line, 1, v)) assert_true(allowed(chain, count, v));
            if (allowed(chain, count, v)) assert_false(hits(parts, 10, p, v, 1.0));
        }
    }
}

static void corners_are_solid_inside_and_outside(void **state)
{
    (void)state;
    ff_random random = {5, 5, 0};
    for (int round = 0; round < 3000; ++round) {
        ff_vec2 corner = random_vec(&random, 1.0);
        ff_wall part[2] = {ff_wall_between(random_vec(&random, 3.0), corner),
                           ff_wall_between(corner, random_vec(&random, 3.0))};
        const ff_wall *walls[2] = {&part[0], &part[1]};
        ff_vec2 p = random_vec(&random, 2.0), own = random_vec(&random, 1.5);
        if (hits(walls, 2, p, own, 0.0) || part[0].length < 0.1 || part[1].length < 0.1) continue;
        ff_line lines[2];
        uint32_t count = ff_orca_walls(walls, 2, p, own, 0.3, 1.0, lines, 0);
        assert_true(allowed(lines, count, ff_v2(0.0, 0.0)) ||
                    ff_line_violation(lines[0], ff_v2(0.0, 0.0)) < 1e-9);
        for (int k = 0; k < 30; ++k) {
            ff_vec2 v = random_vec(&random, 2.0);
            if (allowed(lines, count, v)) assert_false(hits(walls, 2, p, v, 1.0));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_line_touches_the_velocity_obstacle_at_its_nearest_point),
        cmocka_unit_test(two_who_both_obey_their_lines_do_not_collide),
        cmocka_unit_test(an_overlapping_pair_is_told_to_part_and_identical_points_give_no_nan),
        cmocka_unit_test(no_velocity_that_the_lines_allow_hits_the_wall_and_standing_is_allowed),
        cmocka_unit_test(a_chain_of_short_segments_allows_what_one_long_wall_allows),
        cmocka_unit_test(corners_are_solid_inside_and_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
