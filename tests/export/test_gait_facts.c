/* Straight walks on the built-in pack are walked as people walk: the reference ranges of the gait facts. */
#define _GNU_SOURCE /* readlink */
#include "runtime/export/gait_facts.h"
#include "runtime/export/metrics.h"
#include "tests/export/built_in_walk.h"

#define HZ 120
#define SETTLE (4 * HZ)
#define FRAMES (20 * HZ)

static ff_fact_frame frames[FRAMES];

static void walk_straight(const built_in *all, const ff_gait_standard *standard, double speed)
{
    built_in_walker w;
    ff_vec3 hips;
    ff_quat rotations[FF_JOINT_COUNT];
    built_in_begin(all, &w, 1);
    for (int k = 0; k < SETTLE + FRAMES; ++k) {
        built_in_go(&w, (ff_rates){speed, 0.0, 0.0}, 1.0 / HZ);
        if (k < SETTLE) continue;
        built_in_pose(&w, &hips, rotations);
        frames[k - SETTLE] = ff_fact_frame_of(standard, hips, rotations);
    }
}

static void steps_events_and_angles_are_people_s(void **state)
{
    const built_in *all = *state;
    ff_gait_standard standard;
    ff_error error;
    FF_ASSERT_OK(ff_gait_standard_make(all->pack, &all->figure, 1.0 / HZ, &standard, &error), error);
    for (int band = 0; band < FF_BAND_COUNT; ++band) {
        double walked[FF_FACT_COUNT], example[FF_FACT_COUNT], speed = ff_fact_speed(band);
        walk_straight(all, &standard, speed);
        FF_ASSERT_OK(ff_gait_facts_find(&standard, frames, FRAMES, walked, &error), error);
        FF_ASSERT_OK(ff_gait_facts_of_example(all->pack, &standard, speed, example, &error), error);
        for (int k = 0; k < FF_FACT_COUNT; ++k) {
            if (!ff_fact_holds((ff_fact)k, band, walked[k], example[k]))
                print_error("%.2f m/s, %s: %.3f, the example %.3f\n", speed, ff_fact_references()[k].name,
                            walked[k], example[k]);
            assert_true(ff_fact_holds((ff_fact)k, band, walked[k], example[k]));
        }
    }
}

static void cadence_and_step_length_are_those_of_the_feet(void **state)
{
    const built_in *all = *state;
    ff_gait_standard standard;
    ff_error error;
    const ff_vec3 *rest = all->figure.rest;
    double leg = rest[FF_JOINT_HIP_L].y - rest[FF_JOINT_ANKLE_L].y;
    FF_ASSERT_OK(ff_gait_standard_make(all->pack, &all->figure, 1.0 / HZ, &standard, &error), error);
    for (double speed = 0.9; speed < 1.8; speed += 0.2) {
        double facts[FF_FACT_COUNT];
        walk_straight(all, &standard, speed);
        FF_ASSERT_OK(ff_gait_facts_find(&standard, frames, FRAMES, facts, &error), error);
        FF_ASSERT_NEAR(facts[FF_FACT_CADENCE] / 60.0 * facts[FF_FACT_STEP] * leg, speed, 0.01 * speed);
    }
}

/* At 30 frames/s, deg/s: no joint's 99th percentile above 1.3 times that of the quickest person, no leg's median below 0.7 times
 * that of the calmest (gait facts: these limits were broken by 23 of 551 checks of people). */
static void joints_turn_no_faster_and_legs_no_slower_than_people_s(void **state)
{
    static const struct {
        int joint;
        double median[FF_BAND_COUNT], p99[FF_BAND_COUNT];
    } people[] = {{FF_JOINT_HIP_L, {77, 94, 128}, {286, 330, 378}},
                  {FF_JOINT_KNEE_L, {59, 76, 121}, {515, 594, 687}},
                  {FF_JOINT_ANKLE_L, {58, 65, 107}, {332, 495, 516}},
                  {FF_JOINT_HIP_R, {77, 94, 128}, {286, 330, 378}},
                  {FF_JOINT_KNEE_R, {59, 76, 121}, {515, 594, 687}},
                  {FF_JOINT_ANKLE_R, {58, 65, 107}, {332, 495, 516}},
                  {FF_JOINT_SHOULDER_L, {0, 0, 0}, {313, 503, 770}},
                  {FF_JOINT_ELBOW_L, {0, 0, 0}, {158, 259, 314}},
                  {FF_JOINT_CHEST, {0, 0, 0}, {112, 128, 165}},
                  {FF_JOINT_HEAD, {0, 0, 0}, {131, 137, 136}}};
    const built_in *all = *state;
    static double speeds[sizeof people / sizeof people[0]][FRAMES];
    for (int band = 0; band < FF_BAND_COUNT; ++band) {
        built_in_walker w;
        ff_quat last[FF_JOINT_COUNT], now[FF_JOINT_COUNT];
        ff_vec3 hips;
        size_t count = 0;
        built_in_begin(all, &w, 2);
        for (int k = 0; k < 24 * 30; ++k, memcpy(last, now, sizeof now)) {
            built_in_go(&w, (ff_rates){ff_fact_speed(band), 0.0, 0.0}, 1.0 / 30.0);
            built_in_pose(&w, &hips, now);
            if (k <= 4 * 30) continue;
            for (size_t i = 0; i < sizeof people / sizeof people[0]; ++i) {
                int j = people[i].joint;
                speeds[i][count] = ff_quat_angle(ff_quat_mul(ff_quat_conj(last[j]), now[j])) / FF_DEG * 30.0;
            }
            ++count;
        }
        for (size_t i = 0; i < sizeof people / sizeof people[0]; ++i) {
            FF_ASSERT_BELOW(ff_quantile(speeds[i], count, 0.99), 1.3 * people[i].p99[band]);
            FF_ASSERT_BELOW(0.7 * people[i].median[band], ff_quantile(speeds[i], count, 0.5) + 1e-9);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_events_and_angles_are_people_s),
        cmocka_unit_test(cadence_and_step_length_are_those_of_the_feet),
        cmocka_unit_test(joints_turn_no_faster_and_legs_no_slower_than_people_s),
    };
    return cmocka_run_group_tests(tests, built_in_open, built_in_close);
}
