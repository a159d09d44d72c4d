/* People who change between walking and running at all moments of their steps, and stop, turn no joint much faster than anybody
 * in the clips; their feet stand, and keep clear of the floor and of each other. */
#define _GNU_SOURCE /* readlink */
#include "runtime/core/base/random.h"
#include "runtime/export/metrics.h"
#include "tests/export/built_in_walk.h"

#define HZ 60
#define PEOPLE 40
#define SECONDS 18

static ff_gait_standard standard;

static void add(built_in_walker *w, ff_gait_meter *meter)
{
    ff_error error;
    ff_vec3 hips;
    ff_quat rotations[FF_JOINT_COUNT];
    const uint8_t planted[2] = {(uint8_t)ff_gait_planted(&w->gait, 0), (uint8_t)ff_gait_planted(&w->gait, 1)};
    built_in_pose(w, &hips, rotations);
    FF_ASSERT_OK(ff_gait_meter_add(meter, w->heading, planted, hips, rotations, &error), error);
}

/* Now a run, now a walk of this or that way or a stand, for as long as it comes. */
static void hurry_and_tarry(const built_in *all, uint64_t variation, ff_gait_meter *total, uint32_t *changes)
{
    ff_error error;
    ff_gait_meter meter;
    ff_random random = {11, variation, 0};
    built_in_walker w;
    built_in_begin(all, &w, ff_random_next(&random));
    FF_ASSERT_OK(ff_gait_meter_create(&standard, &meter, &error), error);
    double until = 0.0;
    ff_rates wanted = {0.0, 0.0, 0.0};
    for (int i = 0; i < SECONDS * HZ; ++i) {
        if (i >= until * HZ) {
            until += ff_random_range(&random, 0.8, 4.0);
            bool run = wanted.forward < 2.0, stop = ff_random_unit(&random) < 0.25;
            ff_locomotion slow = ff_random_unit(&random) < 0.5 ? FF_BLENDING : FF_SEMI_PROCEDURAL;
            wanted.forward =
                run ? ff_random_range(&random, 2.2, 3.2) : (stop ? 0.0 : ff_random_range(&random, 0.4, 1.6));
            wanted.turn = ff_random_range(&random, -0.4, 0.4);
            ff_gait_want(all->space, &w.gait, run ? FF_RUNNING : slow, false);
        }
        built_in_go(&w, wanted, 1.0 / HZ);
        add(&w, &meter);
    }
    *changes += w.gait.switches;
    FF_ASSERT_OK(ff_gait_meter_finish(&meter, &error), error);
    FF_ASSERT_OK(ff_gait_meter_merge(total, &meter, &error), error);
    ff_gait_meter_free(&meter);
}

static void from_walk_to_run_and_back_no_joint_is_flung_and_no_foot_slides(void **state)
{
    const built_in *all = *state;
    ff_error error;
    ff_gait_meter total;
    uint32_t changes = 0;
    FF_ASSERT_OK(ff_gait_standard_make(all->pack, &all->figure, 1.0 / HZ, &standard, &error), error);
    FF_ASSERT_OK(ff_gait_meter_create(&standard, &total, &error), error);
    for (uint64_t variation = 0; variation < PEOPLE; ++variation)
        hurry_and_tarry(all, variation, &total, &changes);
    ff_array *slides = &total.skate.planted;
    assert_true(changes > 4 * PEOPLE && total.poses == PEOPLE * SECONDS * HZ);
    if (total.joint.value > FF_JOINT_FASTER) print_message("%s\n", all->figure.name[total.joint.part]);
    FF_ASSERT_BELOW(total.joint.value, FF_JOINT_FASTER);
    FF_ASSERT_BELOW(ff_quantile(slides->data, slides->count, 0.5), 1e-3);
    FF_ASSERT_BELOW(ff_quantile(slides->data, slides->count, 0.95), 3e-3);
    assert_true(total.clearance.known && total.clearance.value >= FF_SWING_CLEAR);
    assert_true(total.ankles.known && total.ankles.value >= FF_ANKLE_GAP);
    ff_gait_meter_free(&total);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(from_walk_to_run_and_back_no_joint_is_flung_and_no_foot_slides)};
    return cmocka_run_group_tests(tests, built_in_open, built_in_close);
}
