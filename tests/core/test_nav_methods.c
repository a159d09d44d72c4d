/* The methods of navigation and the switches of their parts, through the public interface and against closed forms. */
#include "runtime/core/gait/synth_state.h"
#include "runtime/core/nav/nav_baseline.h"
#include "tests/core/crowd_trial.h"
#include "tests/core/walker_space.h"

static ff_walker_space full;

static int set_up(void **state)
{
    (void)state;
    full = ff_walker_space_make(&ff_walker_grid_full);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    ff_walker_space_free(&full);
    return 0;
}

static ff_crowd *new_crowd(const ff_crowd_def *def)
{
    ff_error error;
    ff_crowd *crowd = NULL;
    FF_ASSERT_OK(ff_crowd_create(full.pack, def, &crowd, &error), error);
    return crowd;
}

static uint64_t hash_after(const ff_crowd_def *def, uint32_t steps)
{
    ff_crowd *crowd = new_crowd(def);
    trial t = {.layout = TRIAL_CIRCLE, .agents = 24, .seed = 3};
    trial_lay_out(crowd, &t);
    for (uint32_t i = 0; i < steps; ++i)
        ff_crowd_step(crowd);
    uint64_t hash = ff_crowd_state_hash(crowd);
    ff_crowd_destroy(crowd);
    return hash;
}

static ff_crowd_def small_def(void)
{
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = 32;
    return def;
}

static void every_switch_makes_a_difference_and_none_is_random(void **state)
{
    (void)state;
    ff_crowd_def def = small_def();
    uint64_t usual = hash_after(&def, 240);
    assert_int_equal(hash_after(&def, 240), usual);
    /* Those that matter on this circle; sharp turns, detours and making way need other scenes. */
    bool *const parts[] = {&def.mcn.stance, &def.mcn.forces, &def.mcn.density, &def.mcn.weighted,
                           &def.mcn.gradual};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; ++i) {
        *parts[i] = false;
        uint64_t without = hash_after(&def, 240);
        *parts[i] = true;
        if (without == usual) print_message("part %zu makes no difference\n", i);
        assert_true(without != usual);
    }
    for (int rule = FF_FACING_STRAFE; rule <= FF_FACING_COMMAND; ++rule) {
        def.mcn.facing = (ff_facing)rule;
        assert_true(hash_after(&def, 240) != usual);
    }
}

static void every_method_gives_the_same_bits_on_any_number_of_threads(void **state)
{
    (void)state;
    uint64_t seen[4] = {0};
    for (int method = FF_NAVIGATION_CROWD; method <= FF_NAVIGATION_SF; ++method) {
        ff_crowd_def def = small_def();
        def.navigation = (ff_navigation)method;
        seen[method] = hash_after(&def, 200);
        def.threads = 3;
        assert_int_equal(hash_after(&def, 200), seen[method]);
    }
    assert_int_equal(seen[FF_NAVIGATION_CROWD], seen[FF_NAVIGATION_MCN]);
    assert_true(seen[FF_NAVIGATION_ORCA] != seen[FF_NAVIGATION_MCN]);
    assert_true(seen[FF_NAVIGATION_SF] != seen[FF_NAVIGATION_ORCA]);
}

/* A crowd of one agent at the origin who wants to go ahead, and what it asks for in its first step. */
static ff_vec2 first_command(ff_navigation method, double step)
{
    ff_error error;
    ff_agent agent;
    ff_agent_state now;
    ff_crowd_def def = small_def();
    def.step = step;
    ff_agent_def walker = ff_agent_def_default();
    walker.goal = ff_v2(20.0, 0.0);
    walker.navigation = method;
    ff_crowd *crowd = new_crowd(&def);
    FF_ASSERT_OK(ff_crowd_add_agent(crowd, &walker, &agent, &error), error);
    ff_crowd_step(crowd);
    FF_ASSERT_OK(ff_crowd_agent_state(crowd, agent, &now, &error), error);
    ff_crowd_destroy(crowd);
    return now.command;
}

static void the_first_command_of_each_method_is_as_computed(void **state)
{
    (void)state;
    FF_ASSERT_NEAR(first_command(FF_NAVIGATION_ORCA, 0.1).a, 1.3, 1e-12);            /* at once */
    FF_ASSERT_NEAR(first_command(FF_NAVIGATION_SF, 0.1).a, 0.1 * 1.3 / 0.54, 1e-12); /* one Euler step */
    FF_ASSERT_NEAR(first_command(FF_NAVIGATION_SF, 0.01).a, 0.1, 1e-12);             /* enough to start */
    FF_ASSERT_NEAR(first_command(FF_NAVIGATION_MCN, 0.1).a, 0.2, 1e-12);             /* 2 m/s2 */
    FF_ASSERT_NEAR(first_command(FF_NAVIGATION_CROWD, 0.1).a, 0.2, 1e-12);
    FF_ASSERT_NEAR(first_command(FF_NAVIGATION_SF, 0.1).b, 0.0, 1e-12);
}

static void people_of_all_methods_pass_each_other_in_one_crowd(void **state)
{
    (void)state;
    ff_error error;
    ff_crowd_def def = small_def();
    ff_crowd *crowd = new_crowd(&def);
    ff_agent agents[6];
    for (int i = 0; i < 6; ++i) {
        ff_agent_def walker = ff_agent_def_default();
        double angle = FF_TAU * i / 6.0 + 0.02 * i;
        walker.position = ff_scale2(ff_fwd2(angle), 5.0);
        walker.goal = ff_scale2(walker.position, -1.0);
        walker.heading = angle + FF_PI;
        walker.navigation = (ff_navigation)(FF_NAVIGATION_MCN + i % 3);
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &walker, &agents[i], &error), error);
    }
    int there = 0;
    for (int k = 0; k < 30 * 90 && there < 6; ++k) {
        ff_crowd_step(crowd);
        there = 0;
        for (int i = 0; i < 6; ++i) {
            ff_agent_state now;
            FF_ASSERT_OK(ff_crowd_agent_state(crowd, agents[i], &now, &error), error);
            there += now.reached;
        }
    }
    assert_int_equal(there, 6);
    ff_crowd_destroy(crowd);
}

/* m/s ahead, the least, of one whose goal is behind him. */
static double least_forward_rate(bool back_pedal)
{
    ff_error error;
    ff_crowd_def def = small_def();
    def.mcn.back_pedal = back_pedal;
    def.mcn.sharp_turn = false;
    ff_crowd *crowd = new_crowd(&def);
    ff_agent agent;
    ff_agent_def walker = ff_agent_def_default();
    walker.goal = ff_v2(20.0, 0.0);
    walker.heading = FF_PI; /* its goal is behind it */
    FF_ASSERT_OK(ff_crowd_add_agent(crowd, &walker, &agent, &error), error);
    double least = 0.0;
    for (int i = 0; i < 60; ++i) {
        ff_crowd_step(crowd);
        ff_agent_state now;
        FF_ASSERT_OK(ff_crowd_agent_state(crowd, agent, &now, &error), error);
        least = ff_min(least, ff_dot2(now.velocity, ff_fwd2(now.heading)));
    }
    ff_crowd_destroy(crowd);
    return least;
}

static void nobody_walks_backwards_unless_it_is_allowed(void **state)
{
    (void)state;
    assert_true(least_forward_rate(false) > -0.05);
    assert_true(least_forward_rate(true) < -0.1);
}

static void one_who_brakes_at_his_goal_is_taken_to_be_slower_than_he_is(void **state)
{
    (void)state;
    ff_mcn_def mcn = ff_crowd_def_default().mcn;
    ff_traits traits = {.goal = {10.0, 0.0}, .goal_tolerance = 0.5, .navigation = FF_NAVIGATION_MCN};
    ff_mind mind = {.command = {0.8, 0.0}};
    ff_vec2 velocity = ff_v2(1.0, 0.0);
    FF_ASSERT_NEAR(ff_nav_reference(&mcn, &traits, &mind, ff_v2(9.0, 0.0), velocity).a, 0.9, 1e-12);
    FF_ASSERT_NEAR(ff_nav_reference(&mcn, &traits, &mind, ff_v2(9.6, 0.0), velocity).a, 0.3, 1e-12);
    mind.command = ff_v2(0.1, 0.0);
    FF_ASSERT_NEAR(ff_nav_reference(&mcn, &traits, &mind, ff_v2(9.6, 0.0), ff_v2(0.2, 0.0)).a, 0.0, 1e-12);
    mind.standing = FF_STANDS; /* and one who stands and steps aside does what he does */
    FF_ASSERT_NEAR(ff_nav_reference(&mcn, &traits, &mind, ff_v2(9.6, 0.0), velocity).a, 0.55, 1e-12);
}

static void the_standing_foot_is_asked_of_the_gait(void **state)
{
    (void)state;
    ff_gait gait = {0};
    ff_vec2 ball = ff_v2(9.0, 9.0);
    double heading = 9.0;
    gait.style.scale = 1.0;
    gait.foot[0].planted = gait.foot[1].planted = 1;
    assert_int_equal(ff_gait_stance(&gait, &ball, &heading), -1);
    gait.foot[0].planted = 0;
    gait.foot[1].lock = (ff_foothold){1.0, 2.0, 0.0, 0.5};
    assert_int_equal(ff_gait_stance(&gait, &ball, &heading), 1);
    FF_ASSERT_NEAR(ball.a, 1.0, 0.0);
    FF_ASSERT_NEAR(ball.b, 2.0, 0.0);
    FF_ASSERT_NEAR(heading, 0.5, 0.0);
}

static void impossible_definitions_are_refused(void **state)
{
    (void)state;
    struct {
        double *value, bad;
    } table[8];
    ff_crowd_def def = small_def();
    ff_error error;
    ff_crowd *crowd = NULL;
    table[0].value = &def.mcn.padding, table[0].bad = -0.1;
    table[1].value = &def.mcn.prediction, table[1].bad = 2.0;
    table[2].value = &def.baseline.padding, table[2].bad = NAN;
    table[3].value = &def.baseline.keep_right, table[3].bad = 3.0;
    table[4].value = &def.keep_right, table[4].bad = -2.0;
    for (int i = 0; i < 5; ++i) {
        double good = *table[i].value;
        *table[i].value = table[i].bad;
        assert_true(ff_crowd_create(full.pack, &def, &crowd, &error) != FF_OK);
        *table[i].value = good;
    }
    def.navigation = (ff_navigation)7;
    assert_int_equal(ff_crowd_create(full.pack, &def, &crowd, &error), FF_ERR_RANGE);
    def.navigation = FF_NAVIGATION_MCN;
    def.mcn.facing = (ff_facing)9;
    assert_int_equal(ff_crowd_create(full.pack, &def, &crowd, &error), FF_ERR_RANGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_switch_makes_a_difference_and_none_is_random),
        cmocka_unit_test(every_method_gives_the_same_bits_on_any_number_of_threads),
        cmocka_unit_test(the_first_command_of_each_method_is_as_computed),
        cmocka_unit_test(people_of_all_methods_pass_each_other_in_one_crowd),
        cmocka_unit_test(nobody_walks_backwards_unless_it_is_allowed),
        cmocka_unit_test(one_who_brakes_at_his_goal_is_taken_to_be_slower_than_he_is),
        cmocka_unit_test(the_standing_foot_is_asked_of_the_gait),
        cmocka_unit_test(impossible_definitions_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
