/* Linear programmes of navigation against brute force. */
#include "runtime/core/base/random.h"
#include "runtime/core/nav/nav_solve.h"
#include "tests/check.h"

static ff_line random_line(ff_random *random, double reach)
{
    ff_vec2 d = ff_fwd2(ff_random_range(random, -FF_PI, FF_PI));
    ff_vec2 p = ff_v2(ff_random_range(random, -reach, reach), ff_random_range(random, -reach, reach));
    return (ff_line){p, d, ff_random_range(random, 1.0, 4.0)};
}

/* A line that admits the origin. */
static ff_line hard_line(ff_random *random)
{
    ff_vec2 normal = ff_fwd2(ff_random_range(random, -FF_PI, FF_PI));
    return (ff_line){ff_scale2(normal, ff_random_range(random, 0.0, 1.5)), ff_left2(normal), 1.0};
}

static double worst(const ff_line *lines, uint32_t first, uint32_t end, ff_vec2 v, bool weighted)
{
    double most = -INFINITY;
    for (uint32_t i = first; i < end; ++i)
        most = ff_max(most, (weighted ? lines[i].weight : 1.0) * ff_line_violation(lines[i], v));
    return most;
}

static void a_half_plane_is_feasible_on_its_left(void **state)
{
    (void)state;
    ff_line line = {{0.0, 0.0}, {0.0, 1.0}, 1.0}; /* outward normal (1, 0) */
    FF_ASSERT_NEAR(ff_line_violation(line, ff_v2(-1.0, 0.0)), -1.0, 0.0);
    FF_ASSERT_NEAR(ff_line_violation(line, ff_v2(1.0, 0.0)), 1.0, 0.0);
}

static void the_nearest_velocity_is_the_wish_the_circle_or_the_edge(void **state)
{
    (void)state;
    ff_circle circle = {{0.5, 0.0}, 1.0};
    ff_line line = {{0.2, 0.0}, {0.0, 1.0}, 1.0};
    ff_vec2 v;
    assert_int_equal(ff_solve_nearest(NULL, 0, circle, ff_v2(0.7, 0.1), &v), 0);
    FF_ASSERT_NEAR(v.a, 0.7, 0.0);
    ff_solve_nearest(NULL, 0, circle, ff_v2(5.5, 0.0), &v);
    FF_ASSERT_NEAR(v.a, 1.5, 1e-15);
    assert_int_equal(ff_solve_nearest(&line, 1, circle, ff_v2(0.7, 0.1), &v), 1);
    FF_ASSERT_NEAR(v.a, 0.2, 1e-15);
    FF_ASSERT_NEAR(v.b, 0.1, 1e-15);
}

static void an_unsatisfiable_line_is_named(void **state)
{
    (void)state;
    ff_line lines[2] = {{{0.1, 0.0}, {0.0, 1.0}, 1.0},
                        {{0.2, 0.0}, {0.0, -1.0}, 1.0}}; /* a <= 0.1, a >= 0.2 */
    ff_vec2 v;
    assert_int_equal(ff_solve_nearest(lines, 2, (ff_circle){{0, 0}, 1.0}, ff_v2(0.0, 0.0), &v), 1);
    FF_ASSERT_BELOW(ff_line_violation(lines[0], v), 1e-12);
    assert_int_equal(ff_solve_nearest(lines, 1, (ff_circle){{3.0, 0}, 1.0}, ff_v2(0.0, 0.0), &v), 0);
}

/* Candidates of the true optimum: the wish, its image on each line and the circle, all crossings. */
static double brute_nearest(const ff_line *lines, uint32_t count, ff_circle circle, ff_vec2 wish)
{
    ff_vec2 candidate[400];
    uint32_t n = 0;
    ff_vec2 out = ff_unit2(ff_sub2(wish, circle.centre));
    candidate[n++] = wish;
    candidate[n++] = ff_madd2(circle.centre, out, circle.radius);
    for (uint32_t i = 0; i < count; ++i) {
        ff_vec2 p = lines[i].point, d = lines[i].direction;
        candidate[n++] = ff_madd2(p, d, ff_dot2(d, ff_sub2(wish, p)));
        ff_vec2 q = ff_madd2(p, d, ff_dot2(d, ff_sub2(circle.centre, p)));
        ff_vec2 gap = ff_sub2(q, circle.centre);
        double half = sqrt(ff_max(circle.radius * circle.radius - ff_dot2(gap, gap), 0.0));
        candidate[n++] = ff_madd2(q, d, half);
        candidate[n++] = ff_madd2(q, d, -half);
        for (uint32_t j = 0; j < i; ++j) {
            double slope = ff_det2(d, lines[j].direction);
            if (fabs(slope) < 1e-4) continue;
            double t = ff_det2(lines[j].direction, ff_sub2(p, lines[j].point)) / slope;
            candidate[n++] = ff_madd2(p, d, t);
        }
    }
    double best = INFINITY;
    for (uint32_t i = 0; i < n; ++i) {
        bool inside = ff_length2(ff_sub2(candidate[i], circle.centre)) <= circle.radius + 1e-9;
        if (inside && worst(lines, 0, count, candidate[i], false) <= 1e-9)
            best = ff_min(best, ff_length2(ff_sub2(candidate[i], wish)));
    }
    return best;
}

static void random_programmes_agree_with_brute_force(void **state)
{
    (void)state;
    ff_random random = {1, 2, 0};
    uint32_t solved = 0, failed = 0;
    for (int round = 0; round < 4000; ++round) {
        ff_line lines[12] = {0};
        uint32_t count = (uint32_t)(1 + round % 12);
        for (uint32_t i = 0; i < count; ++i)
            lines[i] = i % 2 ? random_line(&random, 0.8) : hard_line(&random);
        ff_circle circle = {{ff_random_range(&random, -0.3, 0.3), 0.1}, ff_random_range(&random, 0.5, 2.2)};
        ff_vec2 wish = ff_v2(ff_random_range(&random, -2.0, 2.0), ff_random_range(&random, -2.0, 2.0)), v;
        double best = brute_nearest(lines, count, circle, wish);
        if (ff_solve_nearest(lines, count, circle, wish, &v) == count) {
            ++solved;
            FF_ASSERT_BELOW(worst(lines, 0, count, v, false), 1e-7);
            FF_ASSERT_BELOW(ff_length2(ff_sub2(v, circle.centre)), circle.radius + 1e-9);
            FF_ASSERT_NEAR(ff_length2(ff_sub2(v, wish)), best, 1e-6);
        } else {
            ++failed;
            assert_true(isinf(best));
        }
    }
    assert_true(solved > 1000 && failed > 500);
}

/* Largest weighted violation of the soft lines, with a steep wall where a hard one is violated: convex. */
static double cost(const ff_line *lines, uint32_t count, uint32_t hard, ff_vec2 v)
{
    double outside = hard > 0 ? worst(lines, 0, hard, v, false) : 0.0;
    return ff_max(worst(lines, hard, count, v, true), 1e7 * ff_max(outside, 0.0));
}

static double best_in_column(const ff_line *lines, uint32_t count, uint32_t hard, double radius, double a)
{
    double high = sqrt(ff_max(radius * radius - a * a, 0.0)), low = -high;
    for (int i = 0; i < 70; ++i) {
        double p = low + (high - low) / 3.0, q = high - (high - low) / 3.0;
        if (cost(lines, count, hard, ff_v2(a, p)) < cost(lines, count, hard, ff_v2(a, q)))
            high = q;
        else
            low = p;
    }
    return cost(lines, count, hard, ff_v2(a, 0.5 * (low + high)));
}

/* Least cost in the circle round the origin: nested ternary search, exact for convex functions. */
static double brute_dense(const ff_line *lines, uint32_t count, uint32_t hard, double radius)
{
    double low = -radius, high = radius;
    for (int i = 0; i < 70; ++i) {
        double p = low + (high - low) / 3.0, q = high - (high - low) / 3.0;
        if (best_in_column(lines, count, hard, radius, p) < best_in_column(lines, count, hard, radius, q))
            high = q;
        else
            low = p;
    }
    return best_in_column(lines, count, hard, radius, 0.5 * (low + high));
}

static void the_weighted_dense_fallback_agrees_with_brute_force(void **state)
{
    (void)state;
    ff_random random = {3, 4, 0};
    int infeasible = 0;
    for (int round = 0; round < 1500 && infeasible < 250; ++round) {
        ff_line lines[13] = {0};
        uint32_t hard = (uint32_t)(round % 4), count = hard + 3 + (uint32_t)(round % 8);
        for (uint32_t i = 0; i < count; ++i)
            lines[i] = i < hard ? hard_line(&random) : random_line(&random, 0.6);
        ff_circle circle = {{0.0, 0.0}, 2.0};
        ff_vec2 v;
        uint32_t failed = ff_solve_nearest(lines, count, circle, ff_v2(1.0, 0.3), &v);
        if (failed == count) continue;
        assert_true(failed >= hard);
        ++infeasible;
        ff_solve_dense(lines, count, hard, failed, circle, &v);
        FF_ASSERT_BELOW(worst(lines, 0, hard, v, false), 1e-7);
        FF_ASSERT_BELOW(ff_length2(v), 2.0 + 1e-9);
        FF_ASSERT_NEAR(worst(lines, hard, count, v, true), brute_dense(lines, count, hard, 2.0), 1e-5);
    }
    assert_int_equal(infeasible, 250);
}

static void the_more_pressing_of_two_opposed_lines_gets_more(void **state)
{
    (void)state;
    /* a >= 1 with weight 3 against a <= -1 with weight 1: 3 (1 - a) = a + 1 at a = 0.5. */
    ff_line lines[2] = {{{1.0, 0.0}, {0.0, -1.0}, 3.0}, {{-1.0, 0.0}, {0.0, 1.0}, 1.0}};
    ff_circle circle = {{0.0, 0.0}, 2.0};
    ff_vec2 v;
    uint32_t failed = ff_solve_nearest(lines, 2, circle, ff_v2(0.0, 0.0), &v);
    assert_int_equal(failed, 1);
    ff_solve_dense(lines, 2, 0, failed, circle, &v);
    FF_ASSERT_NEAR(v.a, 0.5, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_half_plane_is_feasible_on_its_left),
        cmocka_unit_test(the_nearest_velocity_is_the_wish_the_circle_or_the_edge),
        cmocka_unit_test(an_unsatisfiable_line_is_named),
        cmocka_unit_test(random_programmes_agree_with_brute_force),
        cmocka_unit_test(the_weighted_dense_fallback_agrees_with_brute_force),
        cmocka_unit_test(the_more_pressing_of_two_opposed_lines_gets_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
