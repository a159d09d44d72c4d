/* The meter sees what is wrong with a walk, and how much: each fault by itself, in a body that otherwise stands still. */
#define _GNU_SOURCE /* readlink */
#include "tests/export/built_in_walk.h"

#define HZ 60
#define FRAMES 60

typedef struct doll {
    ff_vec3 hips;
    ff_quat rotations[FF_JOINT_COUNT];
    uint8_t planted[2];
} doll;

static ff_gait_standard standard;

static doll standing(const built_in *all)
{
    doll d = {.hips = all->figure.rest[FF_JOINT_HIPS], .planted = {1, 1}};
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        d.rotations[j] = FF_QUAT_IDENTITY;
    return d;
}

static ff_quat bend(double degrees)
{
    return ff_quat_axis(ff_v3(1.0, 0.0, 0.0), degrees * FF_DEG);
}

typedef void fault(doll *d, int frame);

static ff_gait_meter measure(const built_in *all, fault *spoil)
{
    ff_error error;
    ff_gait_meter meter;
    FF_ASSERT_OK(ff_gait_meter_create(&standard, &meter, &error), error);
    for (int k = 0; k < FRAMES; ++k) {
        doll d = standing(all);
        if (spoil) spoil(&d, k);
        FF_ASSERT_OK(ff_gait_meter_add(&meter, 0.0, d.planted, d.hips, d.rotations, &error), error);
    }
    FF_ASSERT_OK(ff_gait_meter_finish(&meter, &error), error);
    return meter;
}

static void who_stands_still_has_no_faults(void **state)
{
    ff_gait_meter m = measure(*state, NULL);
    assert_int_equal(m.skate.planted.count, 2);
    FF_ASSERT_NEAR(((double *)m.skate.planted.data)[0], 0.0, 1e-12);
    assert_true(m.pops == 0 && m.fast == 0 && m.close == 0 && m.swings == 0 && m.poses == FRAMES);
    FF_ASSERT_NEAR(m.knee.value, 0.0, 1e-6);
    FF_ASSERT_NEAR(m.joint.value, 0.0, 1e-6);
    ff_gait_meter_free(&m);
}

static void slide(doll *d, int frame)
{
    d->hips.z += 0.001 * frame;
}

static void slides_are_added_up_over_a_plant(void **state)
{
    ff_gait_meter m = measure(*state, slide);
    for (int foot = 0; foot < 2; ++foot)
        FF_ASSERT_NEAR(((double *)m.skate.planted.data)[foot], 0.001 * (FRAMES - 1), 1e-9);
    ff_gait_meter_free(&m);
}

static void jerk_left_knee(doll *d, int frame)
{
    d->rotations[FF_JOINT_KNEE_L] = bend(frame == 30 ? 20.0 : 10.0);
}

/* A bend of 10, 20, 10 degrees has second differences of 10, -20 and 10. */
static void a_knee_that_jerks_is_timed_and_named(void **state)
{
    ff_gait_meter m = measure(*state, jerk_left_knee);
    FF_ASSERT_NEAR(m.knee.value, 20.0 * HZ * HZ, 1.0);
    FF_ASSERT_NEAR(m.knee.time, 31.0 / HZ, 1e-9);
    assert_int_equal(m.knee.part, 0);
    assert_int_equal(m.pops, 3);
    ff_gait_meter_free(&m);
}

static void fling_right_arm(doll *d, int frame)
{
    d->rotations[FF_JOINT_SHOULDER_R] =
        bend(3.0 * standard.fastest[FF_JOINT_SHOULDER_R] / FF_DEG / HZ * (frame == 20));
}

static void a_joint_is_held_against_its_fastest_in_the_pack(void **state)
{
    ff_gait_meter m = measure(*state, fling_right_arm);
    FF_ASSERT_NEAR(m.joint.value, 3.0, 1e-6);
    assert_int_equal(m.joint.part, FF_JOINT_SHOULDER_R);
    assert_int_equal(m.fast, 2); /* there and back */
    ff_gait_meter_free(&m);
}

/* In the air from 20 to 40, 5 mm up; in the middle of it the other foot is no matter. */
static void scrape(doll *d, int frame)
{
    d->planted[0] = frame < 20 || frame >= 40;
    d->hips.y += d->planted[0] ? 0.0 : 0.005;
}

static void a_swing_that_is_too_low_is_seen(void **state)
{
    ff_gait_meter m = measure(*state, scrape);
    assert_int_equal(m.swings, 1);
    assert_int_equal(m.scraping, 1);
    FF_ASSERT_NEAR(m.clearance.value, 0.005, 1e-9);
    ff_gait_meter_free(&m);
}

static void knock_ankles(doll *d, int frame)
{
    double in = frame == 10 ? 7.0 : 0.0; /* degrees: hips are some 17 cm apart, legs some 80 cm long */
    d->rotations[FF_JOINT_HIP_L] = ff_quat_axis(ff_v3(0.0, 0.0, 1.0), -in * FF_DEG);
    d->rotations[FF_JOINT_HIP_R] = ff_quat_axis(ff_v3(0.0, 0.0, 1.0), in * FF_DEG);
}

static void ankles_that_come_close_are_seen(void **state)
{
    const built_in *all = *state;
    const ff_vec3 *rest = all->figure.rest;
    double apart = rest[FF_JOINT_HIP_L].x - rest[FF_JOINT_HIP_R].x;
    double leg = rest[FF_JOINT_HIP_L].y - rest[FF_JOINT_ANKLE_L].y;
    ff_gait_meter m = measure(all, knock_ankles);
    FF_ASSERT_NEAR(m.ankles.value, fabs(apart - 2.0 * leg * ff_sin(7.0 * FF_DEG)), 0.01);
    assert_int_equal(m.close, m.ankles.value < FF_ANKLE_GAP ? 1 : 0);
    ff_gait_meter_free(&m);
}

static void measures_of_two_walkers_add_up(void **state)
{
    ff_error error;
    ff_gait_meter calm = measure(*state, NULL), jerky = measure(*state, jerk_left_knee);
    FF_ASSERT_OK(ff_gait_meter_merge(&calm, &jerky, &error), error);
    assert_int_equal(calm.poses, 2 * FRAMES);
    assert_int_equal(calm.pops, 3);
    assert_int_equal(calm.skate.planted.count, 4);
    FF_ASSERT_NEAR(calm.knee.value, jerky.knee.value, 0.0);
    ff_gait_meter_free(&calm);
    ff_gait_meter_free(&jerky);
}

static int open_and_learn(void **state)
{
    ff_error error;
    int failed = built_in_open(state);
    const built_in *all = *state;
    FF_ASSERT_OK(ff_gait_standard_make(all->pack, &all->figure, 1.0 / HZ, &standard, &error), error);
    return failed;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(who_stands_still_has_no_faults),
        cmocka_unit_test(slides_are_added_up_over_a_plant),
        cmocka_unit_test(a_knee_that_jerks_is_timed_and_named),
        cmocka_unit_test(a_joint_is_held_against_its_fastest_in_the_pack),
        cmocka_unit_test(a_swing_that_is_too_low_is_seen),
        cmocka_unit_test(ankles_that_come_close_are_seen),
        cmocka_unit_test(measures_of_two_walkers_add_up),
    };
    return cmocka_run_group_tests(tests, open_and_learn, built_in_close);
}
