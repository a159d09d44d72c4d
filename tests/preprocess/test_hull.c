/* The hull against its definition by brute force, and the velocity set of FbCrowd. */
#include "preprocess/examples/hull.h"
#include "runtime/core/base/random.h"
#include "tests/check.h"

#define MANY 40

/* i -> j is an edge of the hull when every point is on its left or on the line. */
static bool is_edge(const ff_vec2 *p, int count, int i, int j)
{
    for (int k = 0; k < count; ++k)
        if (ff_det2(ff_sub2(p[j], p[i]), ff_sub2(p[k], p[i])) < -1e-9) return false;
    return true;
}

static void corners_are_those_of_brute_force(void **state)
{
    (void)state;
    for (uint64_t set = 0; set < 200; ++set) {
        ff_random random = {7, set, 0};
        ff_vec2 p[MANY];
        int count = 3 + (int)(ff_random_next(&random) % (MANY - 3)), corner[MANY];
        for (int i = 0; i < count; ++i)
            p[i] = ff_v2(ff_random_range(&random, -2.0, 2.0), ff_random_range(&random, -1.0, 3.0));
        int corners = ff_hull_find(p, count, corner);
        assert_true(corners >= 3);
        int edges = 0;
        for (int i = 0; i < count; ++i)
            for (int j = 0; j < count; ++j)
                edges += i != j && is_edge(p, count, i, j);
        assert_int_equal(corners, edges);
        for (int i = 0; i < corners; ++i)
            assert_true(is_edge(p, count, corner[i], corner[(i + 1) % corners]));
        for (int i = 1; i < corners; ++i)
            assert_true(p[corner[i]].a >= p[corner[0]].a);
    }
}

static void points_on_an_edge_and_doubles_are_no_corners(void **state)
{
    (void)state;
    const ff_vec2 p[] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2},
                         {0, 2}, {0, 1}, {1, 1}, {2, 2}, {0, 0}};
    int corner[11];
    assert_int_equal(ff_hull_find(p, 11, corner), 4);
    const ff_vec2 want[] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    for (int i = 0; i < 4; ++i) {
        FF_ASSERT_NEAR(p[corner[i]].a, want[i].a, 0.0);
        FF_ASSERT_NEAR(p[corner[i]].b, want[i].b, 0.0);
    }
}

static void degenerate_sets_have_few_corners(void **state)
{
    (void)state;
    int corner[4];
    const ff_vec2 line[] = {{0, 0}, {1, 1}, {2, 2}, {0.5, 0.5}}, place[] = {{1, 2}, {1, 2}, {1, 2}};
    assert_int_equal(ff_hull_find(line, 4, corner), 2);
    assert_int_equal(ff_hull_find(place, 3, corner), 1);
    assert_int_equal(ff_hull_find(NULL, 0, corner), 0);
}

static void a_left_turn_lies_to_the_left_and_half_a_turn_is_the_limit(void **state)
{
    (void)state;
    ff_vec2 v = ff_hull_velocity(1.5, 0.5);
    FF_ASSERT_NEAR(v.a, 1.5 * cos(0.5), 1e-12);
    FF_ASSERT_NEAR(v.b, 1.5 * sin(0.5), 1e-12);
    FF_ASSERT_NEAR(ff_hull_velocity(1.0, 4.0).a, -1.0, 1e-12);
}

static void the_velocity_hull_holds_every_example_and_standing_still(void **state)
{
    (void)state;
    ff_vec2 v[9], out[13];
    int count = 0;
    v[count++] = ff_v2(0.0, 0.0);
    for (int i = -2; i <= 2; ++i)
        v[count++] = ff_hull_velocity(1.6 - 0.2 * abs(i), 0.5 * i);
    int corners = ff_hull_of_velocities(v, count, out);
    assert_true(corners >= 3);
    for (int i = 0; i < corners; ++i) {
        ff_vec2 edge = ff_sub2(out[(i + 1) % corners], out[i]);
        for (int k = 0; k < count; ++k)
            assert_true(ff_det2(edge, ff_sub2(v[k], out[i])) >= -1e-9);
    }
}

static void straight_walks_alone_give_a_box(void **state)
{
    (void)state;
    const ff_vec2 v[] = {{0, 0}, {1.0, 0}, {1.5, 0}};
    ff_vec2 out[7];
    assert_int_equal(ff_hull_of_velocities(v, 3, out), 4);
    FF_ASSERT_NEAR(out[1].a, 1.5, 1e-12);
    FF_ASSERT_NEAR(out[1].b, -0.45, 1e-12);
    double area = 0.0;
    for (int i = 0; i < 4; ++i)
        area += ff_det2(out[i], out[(i + 1) % 4]);
    assert_true(area > 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corners_are_those_of_brute_force),
        cmocka_unit_test(points_on_an_edge_and_doubles_are_no_corners),
        cmocka_unit_test(degenerate_sets_have_few_corners),
        cmocka_unit_test(a_left_turn_lies_to_the_left_and_half_a_turn_is_the_limit),
        cmocka_unit_test(the_velocity_hull_holds_every_example_and_standing_still),
        cmocka_unit_test(straight_walks_alone_give_a_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
