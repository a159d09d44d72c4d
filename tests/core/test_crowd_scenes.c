/* The scenes of the navigation study on a small pack: everyone arrives, nobody sinks into another (bar 6). */
#include "tests/core/crowd_trial.h"
#include "tests/core/walker_open.h"

static void run(trial_layout layout, uint32_t agents, double step, uint64_t seeds, double limit, double depth)
{
    for (uint64_t seed = 1; seed <= seeds; ++seed) {
        trial t = {.layout = layout, .agents = agents, .step = step, .seed = seed, .limit = limit};
        trial_result r = trial_run(walker.pack, &t);
        print_message("%u agents, step %.3f, seed %u: %u arrived, last %.1f s, deepest %.1f cm, %.2f us\n",
                      r.agents, step, (unsigned)seed, r.arrived, r.last, 100.0 * r.deepest, r.us_per_agent);
        assert_int_equal(r.arrived, r.agents);
        FF_ASSERT_BELOW(r.deepest, depth);
        assert_true(r.wall_gap >= 0.3 - 1e-9);
    }
}

static void penetration_between_steps_is_measured_as_defined(void **state)
{
    (void)state;
    FF_ASSERT_NEAR(trial_depth(ff_v2(-1, 0), ff_v2(1, 0), 0.5), 0.5, 1e-12); /* straight through */
    FF_ASSERT_NEAR(trial_depth(ff_v2(1, 0), ff_v2(3, 0), 0.5), 0.0, 0.0);
    FF_ASSERT_NEAR(trial_depth(ff_v2(0.4, 0), ff_v2(0.4, 0), 0.5), 0.1, 1e-12);
}

static void seventeen_and_forty_on_a_circle_all_arrive(void **state)
{
    (void)state;
    run(TRIAL_CIRCLE, 17, 1.0 / 30.0, 4, 40.0, 0.04);
    run(TRIAL_CIRCLE, 17, 0.1, 4, 40.0, 0.04);
    run(TRIAL_CIRCLE, 40, 1.0 / 30.0, 2, 60.0, 0.04);
    run(TRIAL_CIRCLE, 40, 0.1, 2, 60.0, 0.04);
}

static void a_hundred_on_a_circle_all_arrive(void **state)
{
    (void)state;
    run(TRIAL_CIRCLE, 100, 1.0 / 30.0, 1, 90.0, 0.04);
    run(TRIAL_CIRCLE, 100, 0.1, 1, 90.0, 0.04);
}

/* Everybody stays and stands at goals no wider apart than the starts: those behind must be let through. */
static void crossing_crowds_all_arrive(void **state)
{
    (void)state;
    run(TRIAL_CROSS, 0, 1.0 / 30.0, 1, 90.0, 0.05);
    run(TRIAL_CROSS, 0, 0.1, 2, 90.0, 0.05);
    run(TRIAL_FOUR, 0, 0.1, 1, 90.0, 0.05);
}

static void a_corridor_with_two_streams_flows(void **state)
{
    (void)state;
    run(TRIAL_CORRIDOR, 0, 1.0 / 30.0, 1, 90.0, 0.08);
    run(TRIAL_CORRIDOR, 0, 0.1, 2, 90.0, 0.08);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(penetration_between_steps_is_measured_as_defined),
        cmocka_unit_test(seventeen_and_forty_on_a_circle_all_arrive),
        cmocka_unit_test(a_hundred_on_a_circle_all_arrive),
        cmocka_unit_test(crossing_crowds_all_arrive),
        cmocka_unit_test(a_corridor_with_two_streams_flows),
    };
    return cmocka_run_group_tests(tests, ff_walker_open, ff_walker_close);
}
