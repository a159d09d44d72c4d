/* People of the built-in pack who keep changing their minds: feet land and pass beside each other and over the floor, joints
 * hardly ever turn much faster than people's, nor do knees pop, whatever happens in the midst of a swing. */
#define _GNU_SOURCE
#include "runtime/core/base/random.h"
#include "runtime/core/gait/synth.h"
#include "runtime/export/gait_meter.h"
#include "tests/core/built_in_space.h"

#define HZ 60
#define DT (1.0 / HZ)
#define SECONDS 400.0
#define SPEED_UP (3.0 * DT) /* m/s and rad/s in a step: somewhat faster than people */
#define TURN_UP (6.0 * DT)
#define RARE_POSES 4 /* of 24,000 */

static ff_figure figure;
static ff_gait_standard standard;

typedef struct mind {
    ff_random random;
    ff_rates wanted, now;
    ff_locomotion way;
    double until;
} mind;

static double towards(double now, double wanted, double most)
{
    return now + ff_clamp(wanted - now, -most, most);
}

/* Mostly a turn on the spot, for which feet stand the closest, or back, or a stand; else anything that one can walk. */
static void change(mind *m, bool hybrid, double time)
{
    if (time < m->until) return;
    m->until = time + ff_random_range(&m->random, 0.2, 1.2);
    double what = ff_random_unit(&m->random);
    m->wanted = (ff_rates){0.0, 0.0, what < 0.2 ? 0.0 : ff_random_range(&m->random, -2.5, 2.5)};
    if (what > 0.6)
        m->wanted = (ff_rates){ff_random_range(&m->random, -0.6, 1.7), ff_random_range(&m->random, -0.5, 0.5),
                               ff_random_range(&m->random, -1.5, 1.5)};
    if (hybrid) m->way = ff_random_unit(&m->random) < 0.5 ? FF_BLENDING : FF_SEMI_PROCEDURAL;
}

static void follow(mind *m, const ff_gait *gait)
{
    ff_rates to = ff_gait_clamp(space, gait, m->wanted);
    m->now.forward = towards(m->now.forward, to.forward, SPEED_UP);
    m->now.left = towards(m->now.left, to.left, SPEED_UP);
    m->now.turn = towards(m->now.turn, to.turn, TURN_UP);
    m->now = ff_gait_clamp(space, gait, m->now);
}

static void walk(ff_locomotion way, bool hybrid, uint64_t seed, ff_gait_meter *meter)
{
    ff_error error;
    ff_gait *gait = calloc(1, ff_gait_size());
    assert_non_null(gait);
    FF_ASSERT_OK(ff_gait_meter_create(&standard, meter, &error), error);
    mind m = {.random = {seed, 77, 0}, .way = way};
    ff_vec2 position = {0.0, 0.0};
    double heading = 0.0;
    ff_gait_init(space, gait, position, heading, seed);
    for (int k = 0; k < (int)(SECONDS * HZ); ++k) {
        change(&m, hybrid, k * DT);
        ff_gait_want(space, gait, m.way, false);
        follow(&m, gait);
        ff_vec2 moved =
            ff_from_frame2(ff_fwd2(heading + 0.5 * m.now.turn * DT), ff_v2(m.now.forward, m.now.left));
        position = ff_madd2(position, moved, DT);
        heading = ff_wrap(heading + m.now.turn * DT);
        ff_gait_step(space, gait, position, heading, m.now, DT);

        ff_vec3 hips;
        ff_quat rotations[FF_JOINT_COUNT];
        const uint8_t planted[2] = {(uint8_t)ff_gait_planted(gait, 0), (uint8_t)ff_gait_planted(gait, 1)};
        ff_gait_pose(space, gait, position, heading, &hips, rotations);
        FF_ASSERT_OK(ff_gait_meter_add(meter, heading, planted, hips, rotations, &error), error);
    }
    free(gait);
}

static void check(ff_locomotion way, bool hybrid)
{
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        ff_gait_meter meter;
        walk(way, hybrid, seed, &meter);
        if (meter.close + meter.scraping > 0)
            print_error("seed %d: ankles at %.2f s, swings at %.2f s\n", (int)seed, meter.ankles.time,
                        meter.clearance.time);
        assert_true(meter.swings > 400);
        FF_ASSERT_BELOW(FF_ANKLE_GAP, meter.ankles.value);
        FF_ASSERT_BELOW(FF_SWING_CLEAR, meter.clearance.value);
        assert_in_range(meter.pops, 0, RARE_POSES);
        assert_in_range(meter.fast, 0, RARE_POSES);
        ff_gait_meter_free(&meter);
    }
}

static void feet_keep_clear_of_each_other_and_of_the_floor_in_blends(void **state)
{
    (void)state;
    check(FF_BLENDING, false);
}

static void feet_keep_clear_of_each_other_and_of_the_floor_on_the_clip(void **state)
{
    (void)state;
    check(FF_SEMI_PROCEDURAL, false);
}

static void feet_keep_clear_of_each_other_and_of_the_floor_while_ways_change(void **state)
{
    (void)state;
    check(FF_BLENDING, true);
}

static int set_up(void **state)
{
    ff_error error;
    open_space(state);
    FF_ASSERT_OK(ff_figure_from_pack(pack, &figure, &error), error);
    FF_ASSERT_OK(ff_gait_standard_make(pack, &figure, DT, &standard, &error), error);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feet_keep_clear_of_each_other_and_of_the_floor_in_blends),
        cmocka_unit_test(feet_keep_clear_of_each_other_and_of_the_floor_on_the_clip),
        cmocka_unit_test(feet_keep_clear_of_each_other_and_of_the_floor_while_ways_change),
    };
    return cmocka_run_group_tests(tests, set_up, close_space);
}
