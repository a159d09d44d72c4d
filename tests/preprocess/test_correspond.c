/* Correspondences: alignment against planted motions, the map against the plain formula, planted time warps found again,
 * order and spacing, the same bytes from any number of threads. */
#include "tests/preprocess/cycles_make.h"
#include "tests/preprocess/standard.h"

#include "preprocess/examples/correspond_set.h"
#include "runtime/core/base/random.h"

static ff_vec3 random_point(ff_random *random)
{
    return ff_v3(ff_random_range(random, -1.0, 1.0), ff_random_range(random, 0.0, 2.0),
                 ff_random_range(random, -1.0, 1.0));
}

static void a_planted_turn_and_shift_come_back_to_1e_12(void **state)
{
    (void)state;
    enum { COUNT = 60, PERIOD = 20 };
    ff_random random = {5, 1, 0};
    for (int trial = 0; trial < 200; ++trial) {
        ff_vec3 first[COUNT], second[COUNT];
        double weights[PERIOD];
        ff_alignment planted = {ff_random_range(&random, -3.1, 3.1),
                                {ff_random_range(&random, -5.0, 5.0), ff_random_range(&random, -5.0, 5.0)}};
        for (int i = 0; i < PERIOD; ++i)
            weights[i] = ff_random_range(&random, 0.5, 2.0);
        for (int i = 0; i < COUNT; ++i) {
            second[i] = random_point(&random);
            first[i] = ff_aligned(&planted, second[i]);
        }
        ff_alignment found = ff_cloud_align(first, second, weights, PERIOD, COUNT);
        FF_ASSERT_NEAR(ff_wrap(found.turn - planted.turn), 0.0, 1e-12);
        FF_ASSERT_NEAR(found.shift.a, planted.shift.a, 1e-12);
        FF_ASSERT_NEAR(found.shift.b, planted.shift.b, 1e-12);
        FF_ASSERT_BELOW(ff_cloud_distance(first, second, weights, PERIOD, COUNT, &found), 1e-12);
    }
}

/* The closed form is the least: no other turn or shift nearby is better. */
static void the_alignment_of_different_clouds_is_the_best(void **state)
{
    (void)state;
    enum { COUNT = 40 };
    ff_random random = {6, 1, 0};
    for (int trial = 0; trial < 50; ++trial) {
        ff_vec3 first[COUNT], second[COUNT];
        double weights[COUNT];
        for (int i = 0; i < COUNT; ++i) {
            first[i] = random_point(&random);
            second[i] = random_point(&random);
            weights[i] = ff_random_range(&random, 0.5, 2.0);
        }
        ff_alignment best = ff_cloud_align(first, second, weights, COUNT, COUNT);
        double least = ff_cloud_distance(first, second, weights, COUNT, COUNT, &best);
        for (int i = 0; i < 6; ++i) {
            ff_alignment other = best;
            double step = i % 2 ? 1e-3 : -1e-3;
            *(i / 2 == 0 ? &other.turn : i / 2 == 1 ? &other.shift.a : &other.shift.b) += step;
            assert_true(ff_cloud_distance(first, second, weights, COUNT, COUNT, &other) > least);
        }
    }
}

/* -------------------------------------------------------------------------------------------- made-up cycles */

enum { POINTS = 8, FRAMES = 120 };
static const double made_weights[POINTS] = {1, 1, 1, 1.5, 1.5, 2, 2, 1};

/* A body of wandering points. */
static ff_vec3 made_point(int point, double phase)
{
    double a = FF_TAU * phase, b = 1.7 * point;
    return ff_v3(0.3 * sin(a + b) + 0.1 * sin(2.0 * a + 2.0 * b) + 0.1 * point, 1.0 + 0.2 * cos(a + 0.5 * b),
                 0.4 * cos(a + b) + 0.1 * sin(3.0 * a + b));
}

/* Where in its cycle the warped body is. */
static double planted_warp(double phase, double bend)
{
    return phase + 0.3 + bend * sin(FF_TAU * phase);
}

static ff_point_cycle made_cycle(bool warped, double bend, const ff_alignment *moved)
{
    ff_point_cycle cycle = {FRAMES, POINTS, 1.1, {0.0, 0.0}, 0.0, NULL, made_weights};
    cycle.points = malloc(FRAMES * POINTS * sizeof *cycle.points);
    assert_non_null(cycle.points);
    for (int k = 0; k < FRAMES; ++k)
        for (int p = 0; p < POINTS; ++p) {
            double phase = k / (double)FRAMES;
            cycle.points[k * POINTS + p] =
                ff_aligned(moved, made_point(p, warped ? planted_warp(phase, bend) : phase));
        }
    return cycle;
}

static double off_by(double x, double y)
{
    double d = x - y;
    return fabs(d - floor(d + 0.5));
}

static void check_order(const ff_cycle_pairs *pairs)
{
    double around[2] = {0.0, 0.0};
    for (int i = 0; i < pairs->count && pairs->count > 1; ++i) {
        const ff_cycle_pair *pair = &pairs->pair[i], *next = &pairs->pair[(i + 1) % pairs->count];
        for (int side = 0; side < 2; ++side) {
            double step = next->phase[side] - pair->phase[side];
            step -= floor(step);
            assert_true(pair->phase[side] >= 0.0 && pair->phase[side] < 1.0);
            assert_true(step >= FF_PAIR_SPACING - 1e-9);
            around[side] += step;
        }
    }
    if (pairs->count < 2) return;
    FF_ASSERT_NEAR(around[0], 1.0, 1e-9);
    FF_ASSERT_NEAR(around[1], 1.0, 1e-9);
}

static void find_warp(double bend, double tolerance)
{
    ff_alignment still = {0.0, {0.0, 0.0}}, moved = {0.7, {2.0, -1.0}};
    ff_point_cycle first = made_cycle(false, 0.0, &still), second = made_cycle(true, bend, &moved);
    ff_map_windows windows[2];
    ff_error error;
    FF_ASSERT_OK(ff_map_windows_make(&first, &windows[0], &error), error);
    FF_ASSERT_OK(ff_map_windows_make(&second, &windows[1], &error), error);
    ff_cycle_side side[2] = {{&first, &windows[0], NULL}, {&second, &windows[1], NULL}};
    static double map[FF_MAP_SIDE * FF_MAP_SIDE];
    ff_cycle_pairs pairs;
    FF_ASSERT_OK(ff_correspond(&standard()->correspondences, &side[0], &side[1], 0.05, map, &pairs, &error),
                 error);
    assert_true(pairs.count >= 6);
    assert_false(pairs.by_keys);
    check_order(&pairs);
    for (int i = 0; i < pairs.count; ++i) {
        const ff_cycle_pair *pair = &pairs.pair[i];
        FF_ASSERT_BELOW(off_by(pair->phase[0], planted_warp(pair->phase[1], bend)), tolerance);
        FF_ASSERT_NEAR(pair->alignment.turn, -0.7, 0.02);
        FF_ASSERT_BELOW(pair->rms, 0.02);
    }
    for (int i = 0; i < 2; ++i)
        assert_true(pairs.wait[i] > 0.05 && pairs.wait[i] < 0.4);
    FF_ASSERT_BELOW(pairs.mean, 0.03);
    for (int i = 0; i < 2; ++i)
        ff_map_windows_free(&windows[i]);
    ff_point_cycle_free(&first);
    ff_point_cycle_free(&second);
}

/* A shift in time comes back exactly, though it is no whole number of the map's cells. In a bent warp one window runs
 * faster than the other, which draws the best moment aside a little: half a cell. */
static void a_planted_time_warp_is_found_again(void **state)
{
    (void)state;
    find_warp(0.0, 2e-4);
    find_warp(0.02, 0.5 / FF_MAP_SIDE);
}

static void the_map_is_the_distance_of_the_windows(void **state)
{
    (void)state;
    ff_alignment still = {0.0, {0.0, 0.0}}, moved = {-0.4, {0.5, 0.0}};
    ff_point_cycle first = made_cycle(false, 0.0, &still), second = made_cycle(true, 0.02, &moved);
    first.velocity = ff_v2(1.2, 0.1), first.turn = 0.5;
    second.velocity = ff_v2(0.9, 0.0), second.turn = -0.2;
    ff_map_windows windows[2];
    ff_error error;
    FF_ASSERT_OK(ff_map_windows_make(&first, &windows[0], &error), error);
    FF_ASSERT_OK(ff_map_windows_make(&second, &windows[1], &error), error);
    static double map[FF_MAP_SIDE * FF_MAP_SIDE];
    ff_distance_map(&windows[0], &windows[1], map);
    for (int row = 0; row < FF_MAP_SIDE; row += 7) {
        for (int column = 0; column < FF_MAP_SIDE; column += 5) {
            ff_vec3 a[FF_CLOUD_MAX], b[FF_CLOUD_MAX];
            ff_cycle_window(&first, row / (double)FF_MAP_SIDE, a, NULL);
            ff_cycle_window(&second, column / (double)FF_MAP_SIDE, b, NULL);
            ff_alignment best = ff_cloud_align(a, b, made_weights, POINTS, FF_WINDOW * POINTS);
            FF_ASSERT_NEAR(map[row * FF_MAP_SIDE + column],
                           ff_cloud_distance(a, b, made_weights, POINTS, FF_WINDOW * POINTS, &best), 1e-7);
        }
    }
    for (int i = 0; i < 2; ++i)
        ff_map_windows_free(&windows[i]);
    ff_point_cycle_free(&first);
    ff_point_cycle_free(&second);
}

static void window_slopes_are_the_change_of_the_points(void **state)
{
    (void)state;
    ff_alignment still = {0.0, {0.0, 0.0}};
    ff_point_cycle cycle = made_cycle(true, 0.02, &still);
    cycle.velocity = ff_v2(1.2, 0.1), cycle.turn = 0.8;
    const double e = 1e-6;
    for (double phase = -0.3; phase < 1.5; phase += 0.0937) {
        ff_vec3 at[FF_CLOUD_MAX], slope[FF_CLOUD_MAX], before[FF_CLOUD_MAX], after[FF_CLOUD_MAX];
        ff_cycle_window(&cycle, phase, at, slope);
        ff_cycle_window(&cycle, phase - e, before, NULL);
        ff_cycle_window(&cycle, phase + e, after, NULL);
        for (int i = 0; i < FF_WINDOW * POINTS; ++i) {
            ff_vec3 change = ff_scale3(ff_sub3(after[i], before[i]), 0.5 / e);
            FF_ASSERT_BELOW(ff_length3(ff_sub3(change, slope[i])), 1e-4);
        }
    }
    ff_point_cycle_free(&cycle);
}

/* ------------------------------------------------------------------------------------------------ real examples */

static ff_example_set set_of(const char *const *names, int count, const ff_rig *rig)
{
    made_motion made[8];
    ff_cycles cycles[8];
    const int subject[8] = {0};
    ff_error error;
    ff_example_set set;
    for (int i = 0; i < count; ++i) {
        made[i] = make_motion(rig, generated_clip(names[i]));
        cycles[i] = cut_cycles(rig, &made[i]);
    }
    FF_ASSERT_OK(ff_examples_select(&standard()->cut.examples, rig, cycles, subject, count, &set, &error),
                 error);
    for (int i = 0; i < count; ++i) {
        ff_cycles_free(&cycles[i]);
        made_motion_free(&made[i]);
    }
    return set;
}

static void examples_correspond_in_order_within_the_limits_on_any_number_of_threads(void **state)
{
    (void)state;
    const char *const names[] = {"walk-slow", "walk-normal", "walk-fast", "curve-left"};
    ff_rig rig = rig_of_generated("walk-normal");
    ff_example_set set = set_of(names, 4, &rig);
    ff_example *gait = calloc((size_t)set.count, sizeof *gait);
    assert_non_null(gait);
    ff_correspondences found[2];
    for (uint32_t i = 0; i < 2; ++i) {
        ff_tasks *tasks;
        ff_error error;
        FF_ASSERT_OK(ff_tasks_create(1 + 2 * i, &tasks, &error), error);
        FF_ASSERT_OK(
            ff_correspond_set(&standard()->correspondences, &rig, &set, gait, tasks, &found[i], &error),
            error);
        ff_tasks_destroy(tasks);
    }
    assert_int_equal(found[0].count, set.count * (set.count - 1) / 2);
    assert_int_equal(found[0].count, found[1].count);
    assert_memory_equal(found[0].items, found[1].items, (size_t)found[0].count * sizeof *found[0].items);
    int with_pairs = 0;
    for (int i = 0; i < found[0].count; ++i) {
        const ff_cycle_pairs *pairs = &found[0].items[i].pairs;
        check_order(pairs);
        for (int k = 0; k < pairs->count; ++k) {
            FF_ASSERT_BELOW(pairs->pair[k].rms, FF_PAIR_LIMIT);
            FF_ASSERT_BELOW(pairs->pair[k].distance, FF_MAP_LIMIT);
        }
        with_pairs += pairs->count > 1;
    }
    assert_true(with_pairs > found[0].count / 3);
    ff_correspondences_free(&found[0]);
    ff_correspondences_free(&found[1]);
    free(gait);
    ff_example_set_free(&set);
}

/* The left foot's strike must not be taken for the right one's: walks of one person at two speeds agree where their
 * keys do. */
static void walks_at_two_speeds_agree_where_their_keys_do(void **state)
{
    (void)state;
    const char *const names[] = {"walk-normal", "walk-fast"};
    ff_rig rig = rig_of_generated("walk-normal");
    ff_example e[2];
    ff_point_cycle cycle[2];
    ff_map_windows windows[2];
    ff_error error;
    for (int i = 0; i < 2; ++i) {
        made_motion made = make_motion(&rig, generated_clip(names[i]));
        ff_cycles cycles = cut_cycles(&rig, &made);
        e[i] = cycles.items[1];
        memset(&cycles.items[1], 0, sizeof cycles.items[1]);
        FF_ASSERT_OK(ff_point_cycle_from_example(&rig, &e[i], &cycle[i], &error), error);
        FF_ASSERT_OK(ff_map_windows_make(&cycle[i], &windows[i], &error), error);
        ff_cycles_free(&cycles);
        made_motion_free(&made);
    }
    ff_cycle_side side[2] = {{&cycle[0], &windows[0], e[0].record.key},
                             {&cycle[1], &windows[1], e[1].record.key}};
    static double map[FF_MAP_SIDE * FF_MAP_SIDE];
    ff_cycle_pairs pairs;
    FF_ASSERT_OK(ff_correspond(&standard()->correspondences, &side[0], &side[1], FF_PAIR_LIMIT_STRAIGHT, map,
                               &pairs, &error),
                 error);
    assert_true(pairs.count >= 4);
    for (int i = 0; i < pairs.count; ++i)
        FF_ASSERT_BELOW(off_by(pairs.pair[i].phase[0], pairs.pair[i].phase[1]), 0.05);
    for (int i = 0; i < 2; ++i) {
        ff_map_windows_free(&windows[i]);
        ff_point_cycle_free(&cycle[i]);
        ff_example_free(&e[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_planted_turn_and_shift_come_back_to_1e_12),
        cmocka_unit_test(the_alignment_of_different_clouds_is_the_best),
        cmocka_unit_test(a_planted_time_warp_is_found_again),
        cmocka_unit_test(the_map_is_the_distance_of_the_windows),
        cmocka_unit_test(window_slopes_are_the_change_of_the_points),
        cmocka_unit_test(examples_correspond_in_order_within_the_limits_on_any_number_of_threads),
        cmocka_unit_test(walks_at_two_speeds_agree_where_their_keys_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
