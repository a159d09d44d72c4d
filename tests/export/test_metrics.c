/* Metrics against closed forms: FbCrowd's equations 16 to 18 with the erratum, and foot skate. */
#include "runtime/core/base/random.h"
#include "runtime/export/body_contacts.h"
#include "runtime/export/metrics.h"
#include "runtime/export/skate.h"
#include "tests/check.h"

static void test_discs_that_pass_through_each_other_meet_half_way(void **state)
{
    (void)state;
    double distance = ff_closest_distance(ff_v2(-1.0, 0.0), ff_v2(2.0, 0.0));
    FF_ASSERT_NEAR(distance, 0.0, 1e-15);
    FF_ASSERT_NEAR(ff_penetration(distance, 0.5), 1.0, 1e-15);
}

static void test_discs_that_part_are_nearest_at_the_start(void **state)
{
    (void)state;
    double distance = ff_closest_distance(ff_v2(1.0, 0.0), ff_v2(2.0, 0.0));
    FF_ASSERT_NEAR(distance, 1.0, 1e-15);
    FF_ASSERT_NEAR(ff_penetration(distance, 0.5), 0.0, 0.0);
}

static void test_discs_at_rest_keep_their_distance(void **state)
{
    (void)state;
    FF_ASSERT_NEAR(ff_closest_distance(ff_v2(0.3, 0.4), ff_v2(0.0, 0.0)), 0.5, 1e-15);
    FF_ASSERT_NEAR(ff_penetration(0.5, 1.0), 0.5, 1e-15);
    FF_ASSERT_NEAR(ff_penetration(0.0, 0.0), 0.0, 0.0);
}

static void test_the_closest_distance_is_that_of_a_fine_search(void **state)
{
    (void)state;
    ff_random random = {5, 0, 0};
    for (int trial = 0; trial < 200; ++trial) {
        ff_vec2 p = ff_v2(ff_random_range(&random, -1, 1), ff_random_range(&random, -1, 1));
        ff_vec2 v = ff_v2(ff_random_range(&random, -2, 2), ff_random_range(&random, -2, 2));
        double least = 1e9;
        for (int k = 0; k <= 2000; ++k)
            least = ff_min(least, ff_length2(ff_madd2(p, v, k / 2000.0)));
        FF_ASSERT_NEAR(ff_closest_distance(p, v), least, 2e-3);
        FF_ASSERT_BELOW(ff_closest_distance(p, v), least + 1e-12);
    }
}

static ff_track track_at(double a, double b)
{
    return (ff_track){.position = ff_v2(a, b), .present = 1};
}

static void test_collisions_are_counted_per_agent_and_step_and_pairs_once(void **state)
{
    (void)state;
    ff_error error;
    ff_collisions collisions;
    FF_ASSERT_OK(ff_collisions_create(3, &collisions, &error), error);
    const double radii[3] = {0.25, 0.25, 0.25};
    ff_track before[3] = {track_at(-1, 0), track_at(1, 0), track_at(0, 5)};
    ff_track after[3] = {track_at(1, 0), track_at(-1, 0), track_at(0, 5)};
    ff_collisions_add(&collisions, before, after, radii); /* through each other: PD 1 */
    ff_collisions_add(&collisions, after, before, radii); /* and back */
    FF_ASSERT_NEAR(ff_collision_rate(&collisions), 2.0 / 6.0, 1e-15);
    FF_ASSERT_NEAR(collisions.deepest, 0.5, 1e-15);
    assert_int_equal(collisions.pairs, 1);
    after[1].present = 0; /* gone: two agents remain, and nothing to run into */
    ff_collisions_add(&collisions, before, after, radii);
    FF_ASSERT_NEAR(ff_collision_rate(&collisions), 2.0 / 8.0, 1e-15);
    ff_collisions_free(&collisions);
}

static void test_a_graze_below_a_centimetre_is_measured_but_is_no_overlapping_pair(void **state)
{
    (void)state;
    ff_error error;
    ff_collisions collisions;
    FF_ASSERT_OK(ff_collisions_create(2, &collisions, &error), error);
    const double radii[2] = {0.3, 0.3};
    ff_track still[2] = {track_at(0, 0), track_at(0.595, 0)};
    ff_collisions_add(&collisions, still, still, radii);
    FF_ASSERT_NEAR(collisions.deepest, 0.005, 1e-12);
    assert_int_equal(collisions.pairs, 0);
    FF_ASSERT_NEAR(ff_collision_rate(&collisions), 0.005 / 0.6 / 2.0, 1e-12);
    ff_collisions_free(&collisions);
}

enum { POINTS = 90 };

static double mean_acceleration(const ff_vec2 *points, size_t window, double step)
{
    double sum = 0.0;
    uint64_t terms = 0;
    ff_acceleration_add(points, POINTS, window, step, 0.0, &sum, &terms);
    assert_int_equal(terms, POINTS - window - 1);
    return sum / (double)terms;
}

static void test_constant_acceleration_is_found_raw_and_filtered(void **state)
{
    (void)state;
    const double step = 1.0 / 30.0;
    ff_vec2 points[POINTS];
    for (int k = 0; k < POINTS; ++k)
        points[k] = ff_v2(0.5 * 0.8 * k * step * k * step, 1.3 * k * step);
    FF_ASSERT_NEAR(mean_acceleration(points, 1, step), 0.8, 1e-10);
    FF_ASSERT_NEAR(mean_acceleration(points, 15, step), 0.8, 1e-10);
}

static void test_sway_at_the_period_of_the_window_is_filtered_out(void **state)
{
    (void)state;
    const double step = 1.0 / 30.0, sway = FF_TAU / 0.5;
    ff_vec2 points[POINTS];
    for (int k = 0; k < POINTS; ++k)
        points[k] = ff_v2(1.3 * k * step + 0.02 * ff_sin(sway * k * step), 0.0);
    FF_ASSERT_BELOW(mean_acceleration(points, 15, step), 1e-10);
    /* |a| of a sine is 2/pi of its peak; sampled differences see a little less. */
    FF_ASSERT_NEAR(mean_acceleration(points, 1, step), 2.0 / FF_PI * 0.02 * sway * sway, 0.15);
}

static void test_those_who_stand_in_a_jam_can_be_left_out(void **state)
{
    (void)state;
    ff_vec2 points[40];
    /* 1 m/s^2 from a stand for 1 s at 0.1 s, after 2 s of standing. */
    for (int k = 0; k < 40; ++k) {
        double t = ff_max(0.0, 0.1 * (k - 20));
        points[k] = ff_v2(0.5 * t * t, 0.0);
    }
    double sum = 0.0, moving = 0.0;
    uint64_t terms = 0, moving_terms = 0;
    ff_acceleration_add(points, 40, 1, 0.1, 0.0, &sum, &terms);
    ff_acceleration_add(points, 40, 1, 0.1, 0.15, &moving, &moving_terms);
    assert_int_equal(terms, 38);
    assert_int_equal(moving_terms, 18); /* from the step on that ends at 0.15 m/s */
    FF_ASSERT_NEAR(moving / (double)moving_terms, 1.0, 1e-9);
    FF_ASSERT_BELOW(sum / (double)terms, 0.51);
}

static void test_too_short_paths_add_nothing(void **state)
{
    (void)state;
    double sum = 0.0;
    uint64_t terms = 0;
    ff_vec2 points[2] = {{0, 0}, {1, 0}};
    ff_acceleration_add(points, 2, 1, 0.1, 0.0, &sum, &terms);
    ff_acceleration_add(points, 0, 15, 0.1, 0.0, &sum, &terms);
    assert_int_equal(terms, 0);
}

static void test_quantiles_are_linear_between_values(void **state)
{
    (void)state;
    double values[5] = {4.0, 1.0, 3.0, 2.0, 5.0};
    FF_ASSERT_NEAR(ff_quantile(values, 5, 0.5), 3.0, 0.0);
    FF_ASSERT_NEAR(ff_quantile(values, 5, 0.95), 4.8, 1e-12);
    FF_ASSERT_NEAR(ff_quantile(values, 5, 1.0), 5.0, 0.0);
    FF_ASSERT_NEAR(ff_quantile(values, 1, 0.95), 1.0, 0.0);
    FF_ASSERT_NEAR(ff_quantile(values, 0, 0.5), 0.0, 0.0);
}

static void test_a_planted_foot_that_slides_is_measured_plant_by_plant(void **state)
{
    (void)state;
    ff_error error;
    ff_skate skate;
    FF_ASSERT_OK(ff_skate_create(1, 1.0 / 30.0, &skate, &error), error);
    /* Plant of 11 frames sliding 1 mm each, a swing, a plant that stands. */
    for (int k = 0; k < 40; ++k) {
        bool planted = k < 11 || k >= 25;
        double z = k < 11 ? 0.001 * k : (k < 25 ? 0.01 + 0.05 * (k - 10) : 0.76);
        ff_vec3 ball = ff_v3(0.1, planted ? 0.03 : 0.10, z);
        FF_ASSERT_OK(ff_skate_add(&skate, 0, 1, ball, 0.03, planted, &error), error);
    }
    FF_ASSERT_OK(ff_skate_finish(&skate, &error), error);
    const double *slides = skate.planted.data;
    assert_int_equal(skate.planted.count, 2);
    FF_ASSERT_NEAR(slides[0], 0.010, 1e-12);
    FF_ASSERT_NEAR(slides[1], 0.0, 1e-12);
    assert_int_equal(skate.seen.count, 2);
    ff_skate_free(&skate);
}

static void test_a_foot_that_slides_unlabelled_is_seen_all_the_same(void **state)
{
    (void)state;
    ff_error error;
    ff_skate skate;
    FF_ASSERT_OK(ff_skate_create(1, 1.0 / 30.0, &skate, &error), error);
    for (int k = 0; k <= 30; ++k) /* 0.3 m/s on the ground for 1 s, never called planted */
        FF_ASSERT_OK(ff_skate_add(&skate, 0, 0, ff_v3(0.0, 0.03, 0.01 * k), 0.03, false, &error), error);
    FF_ASSERT_OK(ff_skate_finish(&skate, &error), error);
    assert_int_equal(skate.planted.count, 0);
    assert_int_equal(skate.seen.count, 1);
    FF_ASSERT_NEAR(*(const double *)skate.seen.data, 0.29, 1e-9);
    FF_ASSERT_NEAR(skate.low_path / skate.low_time, 0.3, 1e-9);
    ff_skate_free(&skate);
}

/* A person by the places of head, hands and feet, all other cylinders being far from everything. */
static ff_cylinders person(double ahead, double aside)
{
    ff_vec3 joints[FF_JOINT_COUNT] = {{0}};
    joints[FF_JOINT_HEAD] = ff_v3(aside, 1.6, ahead);
    joints[FF_JOINT_WRIST_L] = ff_v3(aside + 0.25, 0.9, ahead);
    joints[FF_JOINT_WRIST_R] = ff_v3(aside - 0.25, 0.9, ahead);
    joints[FF_JOINT_BALL_L] = ff_v3(aside + 0.1, 0.03, ahead + 0.3);
    joints[FF_JOINT_BALL_R] = ff_v3(aside - 0.1, 0.03, ahead - 0.3);
    return ff_cylinders_of(joints);
}

static void test_bodies_touch_where_cylinders_of_the_same_height_do(void **state)
{
    (void)state;
    ff_cylinders p = person(0.0, 0.0);
    ff_cylinders beside = person(0.0, 0.6), behind = person(-0.6, -0.2), near = person(0.0, 0.7),
                 far = person(0.0, 2.0);
    FF_ASSERT_NEAR(ff_cylinders_overlap(&p, &beside), 0.06, 1e-12); /* hands 0.1 apart, 0.16 thick */
    FF_ASSERT_NEAR(ff_cylinders_overlap(&p, &behind), 0.22,
                   1e-12); /* one steps where the other's rear foot is */
    FF_ASSERT_NEAR(ff_cylinders_overlap(&p, &near), 0.0, 1e-12);
    FF_ASSERT_NEAR(ff_cylinders_overlap(&p, &far), 0.0, 0.0);
    /* A hand over a foot touches nothing: 0.8 m lie between them. */
    ff_cylinders low = person(0.0, 0.0), high = person(-0.3, 0.35);
    FF_ASSERT_NEAR(ff_cylinders_overlap(&low, &high), ff_cylinders_overlap(&high, &low), 1e-15);
}

static void test_touching_bodies_are_counted_once_and_the_absent_never(void **state)
{
    (void)state;
    ff_error error;
    ff_contacts contacts;
    FF_ASSERT_OK(ff_contacts_create(3, &contacts, &error), error);
    for (int k = 0; k < 4; ++k) {
        contacts.bodies[0] = person(0.0, 0.0);
        contacts.bodies[1] = person(0.0, 0.6);
        if (k == 0) contacts.bodies[2] = person(0.0, -5.0);
        ff_contacts_count(&contacts);
    }
    assert_int_equal(contacts.pairs, 1);
    FF_ASSERT_NEAR(contacts.deepest, 0.06, 1e-12);
    contacts.bodies[2] = person(0.0, 0.0); /* alone */
    ff_contacts_count(&contacts);
    assert_int_equal(contacts.pairs, 1);
    ff_contacts_free(&contacts);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_discs_that_pass_through_each_other_meet_half_way),
        cmocka_unit_test(test_discs_that_part_are_nearest_at_the_start),
        cmocka_unit_test(test_discs_at_rest_keep_their_distance),
        cmocka_unit_test(test_the_closest_distance_is_that_of_a_fine_search),
        cmocka_unit_test(test_collisions_are_counted_per_agent_and_step_and_pairs_once),
        cmocka_unit_test(test_a_graze_below_a_centimetre_is_measured_but_is_no_overlapping_pair),
        cmocka_unit_test(test_constant_acceleration_is_found_raw_and_filtered),
        cmocka_unit_test(test_sway_at_the_period_of_the_window_is_filtered_out),
        cmocka_unit_test(test_those_who_stand_in_a_jam_can_be_left_out),
        cmocka_unit_test(test_too_short_paths_add_nothing),
        cmocka_unit_test(test_quantiles_are_linear_between_values),
        cmocka_unit_test(test_a_planted_foot_that_slides_is_measured_plant_by_plant),
        cmocka_unit_test(test_bodies_touch_where_cylinders_of_the_same_height_do),
        cmocka_unit_test(test_touching_bodies_are_counted_once_and_the_absent_never),
        cmocka_unit_test(test_a_foot_that_slides_unlabelled_is_seen_all_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
