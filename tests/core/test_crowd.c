/* Crowds through the public API: life and death of agents, goals, walls, determinism, bad arguments. */
#include "tests/core/crowd_ask.h"
#include "tests/core/crowd_trial.h"
#include "tests/core/walker_open.h"

static ff_crowd *new_crowd(uint32_t agents, uint32_t threads)
{
    ff_error error;
    ff_crowd *crowd;
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = agents;
    def.max_walls = 64;
    def.threads = threads;
    FF_ASSERT_OK(ff_crowd_create(walker.pack, &def, &crowd, &error), error);
    return crowd;
}

static ff_agent add(ff_crowd *crowd, ff_vec2 from, ff_vec2 goal)
{
    ff_error error;
    ff_agent agent;
    ff_agent_def def = ff_agent_def_default();
    ff_vec2 way = ff_sub2(goal, from);
    def.position = from;
    def.goal = goal;
    def.heading = ff_atan2(way.b, way.a);
    FF_ASSERT_OK(ff_crowd_add_agent(crowd, &def, &agent, &error), error);
    return agent;
}

static void a_lone_walker_goes_straight_to_the_goal_and_stands_there_without_dithering(void **state)
{
    (void)state;
    ff_crowd *crowd = new_crowd(1, 1);
    ff_agent agent = add(crowd, ff_v2(0, 0), ff_v2(10, 0));
    ff_agent_state s = {0};
    while (!s.reached && ff_crowd_step_count(crowd) < 400) {
        ff_crowd_step(crowd);
        s = state_of(crowd, agent);
        FF_ASSERT_NEAR(s.position.b, 0.0, 0.02); /* no side preference without anybody to meet */
    }
    assert_true(s.reached);
    assert_true(ff_crowd_step_count(crowd) < 300);
    FF_ASSERT_BELOW(ff_length2(ff_sub2(s.position, s.goal)), 0.5);
    for (int i = 0; i < 60; ++i)
        ff_crowd_step(crowd);
    ff_agent_state rest = state_of(crowd, agent);
    for (int i = 0; i < 300; ++i) {
        ff_crowd_step(crowd);
        s = state_of(crowd, agent);
        assert_true(s.reached);
        FF_ASSERT_NEAR(s.position.a, rest.position.a, 0.0);
        FF_ASSERT_NEAR(s.heading, rest.heading, 0.0);
        FF_ASSERT_NEAR(ff_length2(s.velocity), 0.0, 0.0);
    }
    ff_crowd_destroy(crowd);
}

static void slow_people_reach_small_goals_and_fast_ones_do_not_overshoot(void **state)
{
    (void)state;
    const double speeds[] = {0.1, 0.3, 0.8, 1.3, 1.7}, tolerances[] = {0.05, 0.2, 1.0};
    for (int k = 0; k < 15; ++k) {
        ff_crowd *crowd = new_crowd(1, 1);
        ff_error error;
        ff_agent agent;
        ff_agent_def def = ff_agent_def_default();
        def.goal = ff_v2(2.5, 0.5);
        def.preferred_speed = speeds[k % 5];
        def.goal_tolerance = tolerances[k / 5];
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &def, &agent, &error), error);
        for (int i = 0; i < 30 * 40 && !state_of(crowd, agent).reached; ++i)
            ff_crowd_step(crowd);
        for (int i = 0; i < 90; ++i)
            ff_crowd_step(crowd);
        assert_true(state_of(crowd, agent).reached);
        ff_crowd_destroy(crowd);
    }
}

static void who_looks_away_from_the_goal_turns_and_goes(void **state)
{
    (void)state;
    for (int k = 0; k < 8; ++k) {
        ff_crowd *crowd = new_crowd(1, 1);
        ff_error error;
        ff_agent agent;
        ff_agent_def def = ff_agent_def_default();
        def.goal = ff_v2(6, 0);
        def.heading = FF_PI * k / 4.0;
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &def, &agent, &error), error);
        for (int i = 0; i < 300 && !state_of(crowd, agent).reached; ++i)
            ff_crowd_step(crowd);
        assert_true(state_of(crowd, agent).reached);
        ff_crowd_destroy(crowd);
    }
}

/* Shoulder to shoulder, each with a new goal beyond the other. */
static void two_side_by_side_who_must_change_sides_do_so_on_the_way(void **state)
{
    (void)state;
    double last[2] = {0.0, 0.0};
    for (int both = 0; both < 2; ++both) {
        ff_crowd *crowd = new_crowd(2, 1);
        ff_error error;
        ff_agent pair[2] = {add(crowd, ff_v2(0, 0), ff_v2(20, 0))};
        if (both) pair[1] = add(crowd, ff_v2(0, 0.66), ff_v2(20, 0.66));
        for (int i = 0; i < 90; ++i)
            ff_crowd_step(crowd);
        for (int k = 0; k <= both; ++k) {
            ff_vec2 to = ff_add2(state_of(crowd, pair[k]).position, ff_v2(1.5, k ? -1.3 : 1.3));
            FF_ASSERT_OK(ff_crowd_set_goal(crowd, pair[k], to, &error), error);
        }
        for (int k = 0; k <= both; ++k)
            for (int i = 0; i < 900 && !state_of(crowd, pair[k]).reached; ++i, last[both] += 1.0 / 30.0)
                ff_crowd_step(crowd);
        print_message("%s: %.1f s\n", both ? "both" : "alone", last[both]);
        ff_crowd_destroy(crowd);
    }
    FF_ASSERT_BELOW(last[1], last[0] + 1.4); /* 1.7 when neither falls back */
}

/* With somebody who stands at either side, who has to be asked to make way. They stood there for six seconds, until the
 * watchdog sent one of them off. */
static void two_who_come_to_stand_nose_to_nose_step_past_each_other(void **state)
{
    (void)state;
    ff_crowd *crowd = new_crowd(4, 1);
    ff_vec2 right = ff_v2(-0.02, -0.66), left = ff_v2(0.04, 0.77);
    ff_agent one = add(crowd, ff_v2(0, 0), ff_v2(1.3, 0));
    ff_agent two = add(crowd, ff_v2(0.55, 0.32), ff_v2(-1.2, -0.39));
    add(crowd, right, right);
    add(crowd, left, left);
    double deepest = 0.0;
    int steps = 0;
    while (!(state_of(crowd, one).reached && state_of(crowd, two).reached) && steps < 600) {
        ff_crowd_step(crowd);
        ++steps;
        ff_vec2 gap = ff_sub2(state_of(crowd, one).position, state_of(crowd, two).position);
        deepest = ff_max(deepest, 0.6 - ff_length2(gap));
    }
    print_message("nose to nose: %.1f s\n", steps / 30.0);
    FF_ASSERT_BELOW(steps / 30.0, 6.0);
    FF_ASSERT_BELOW(deepest, 0.005);
    ff_crowd_destroy(crowd);
}

static void two_who_meet_head_on_pass_each_other_on_the_right(void **state)
{
    (void)state;
    ff_crowd *crowd = new_crowd(2, 1);
    ff_agent one = add(crowd, ff_v2(-5, 0), ff_v2(5, 0)), two = add(crowd, ff_v2(5, 0), ff_v2(-5, 0));
    double nearest = 1e9, side = 0.0;
    for (int i = 0; i < 400; ++i) {
        ff_crowd_step(crowd);
        ff_vec2 gap = ff_sub2(state_of(crowd, two).position, state_of(crowd, one).position);
        if (ff_length2(gap) < nearest) nearest = ff_length2(gap), side = gap.b;
    }
    FF_ASSERT_BELOW(0.6 - nearest, 0.005);
    assert_true(side > 0.0); /* the other is on the left */
    assert_true(state_of(crowd, one).reached && state_of(crowd, two).reached);
    ff_crowd_destroy(crowd);
}

static void people_on_one_point_part_without_nan(void **state)
{
    (void)state;
    ff_crowd *crowd = new_crowd(6, 1);
    ff_agent agent[6];
    for (int i = 0; i < 6; ++i)
        agent[i] = add(crowd, ff_v2(0, 0), ff_v2(i < 3 ? 4.0 : 0.0, 0));
    for (int i = 0; i < 600; ++i)
        ff_crowd_step(crowd);
    for (int i = 0; i < 6; ++i) {
        ff_agent_state s = state_of(crowd, agent[i]);
        assert_true(isfinite(s.position.a) && isfinite(s.position.b) && isfinite(s.heading));
        for (int j = 0; j < i; ++j)
            assert_true(ff_length2(ff_sub2(s.position, state_of(crowd, agent[j]).position)) > 0.5);
    }
    ff_crowd_destroy(crowd);
}

static void many_with_one_goal_settle_round_it(void **state)
{
    (void)state;
    ff_crowd *crowd = new_crowd(12, 1);
    ff_agent agent[12];
    for (int i = 0; i < 12; ++i)
        agent[i] = add(crowd, ff_scale2(ff_fwd2(FF_TAU * i / 12.0), 6.0), ff_v2(0, 0));
    for (int i = 0; i < 30 * 40; ++i)
        ff_crowd_step(crowd);
    int standing = 0;
    for (int i = 0; i < 12; ++i) {
        ff_agent_state s = state_of(crowd, agent[i]);
        FF_ASSERT_BELOW(ff_length2(s.position), 2.0);
        standing += ff_length2(s.velocity) < 0.3;
    }
    assert_true(standing >= 9);
    ff_crowd_destroy(crowd);
}

static void walls_are_never_crossed_and_a_door_is_passed(void **state)
{
    (void)state;
    enum { THROUGH = 9, ALL = 21 };
    ff_crowd *crowd = new_crowd(ALL, 1);
    ff_error error;
    /* A wall across, made of half-metre pieces, with a door from -1 to 1; some come to the door, some to the wall. */
    for (int i = 0; i < 40; ++i) {
        double b = -10.0 + 0.5 * i;
        if (b < -1.2 || b > 0.7)
            FF_ASSERT_OK(ff_crowd_add_wall(crowd, ff_v2(0, b), ff_v2(0, b + 0.5), &error), error);
    }
    ff_agent agent[ALL];
    for (int i = 0; i < ALL; ++i) {
        int row = i / 3, column = i % 3 - 1;
        ff_vec2 from = i < THROUGH ? ff_v2(-3.0 - row, column) : ff_v2(-2.0 - column, 3.0 + row - 3);
        agent[i] = add(crowd, from, ff_v2(i < THROUGH ? 6.0 - 1.5 * row : 5.0, from.b));
    }
    /* One in twenty of such crowds has somebody who is pushed past the door and needs a way round: 80 s at most. */
    for (int i = 0; i < 30 * 90; ++i) {
        ff_vec2 before[ALL];
        for (int k = 0; k < ALL; ++k)
            before[k] = state_of(crowd, agent[k]).position;
        ff_crowd_step(crowd);
        for (int k = 0; k < ALL; ++k) {
            ff_vec2 p = state_of(crowd, agent[k]).position;
            if (before[k].a * p.a > 0.0) continue;
            double b = before[k].b + (p.b - before[k].b) * -before[k].a / (p.a - before[k].a);
            assert_true(fabs(b) < 1.0 || fabs(b) > 10.0); /* through the door or round the end */
        }
    }
    for (int k = 0; k < THROUGH; ++k)
        assert_true(state_of(crowd, agent[k]).position.a > 0.0);
    ff_crowd_destroy(crowd);
}

static void who_gets_no_nearer_tries_a_way_round(void **state)
{
    (void)state;
    for (int k = 0; k < 2; ++k) {
        ff_crowd *crowd = new_crowd(1, 1);
        trial_wall(crowd, ff_v2(3, -1), ff_v2(3, 1)); /* square across the way */
        if (k == 1)
            trial_wall(crowd, ff_v2(3, -1), ff_v2(2, -2)); /* a pocket on the right: left it must be */
        ff_agent agent = add(crowd, ff_v2(0, 0), ff_v2(6, 0));
        for (int i = 0; i < 30 * 60 && !state_of(crowd, agent).reached; ++i)
            ff_crowd_step(crowd);
        assert_true(state_of(crowd, agent).reached);
        ff_crowd_destroy(crowd);
    }
}

static void stale_handles_and_bad_definitions_are_refused(void **state)
{
    (void)state;
    ff_error error;
    ff_crowd *crowd = new_crowd(2, 1);
    ff_agent a = add(crowd, ff_v2(0, 0), ff_v2(1, 0)), b = add(crowd, ff_v2(3, 0), ff_v2(4, 0)), c;
    assert_int_equal(a.generation, 1);
    ff_agent_def def = ff_agent_def_default();
    assert_int_equal(ff_crowd_add_agent(crowd, &def, &c, &error), FF_ERR_RANGE);
    FF_ASSERT_OK(ff_crowd_remove_agent(crowd, a, &error), error);
    assert_int_equal(ff_crowd_remove_agent(crowd, a, &error), FF_ERR_ARGUMENT);
    ff_agent_state s;
    assert_int_equal(ff_crowd_agent_state(crowd, a, &s, &error), FF_ERR_ARGUMENT);
    c = add(crowd, ff_v2(-3, 0), ff_v2(-4, 0));
    assert_int_equal(c.slot, a.slot);
    assert_int_equal(c.generation, 2);
    assert_int_equal(ff_crowd_set_goal(crowd, a, ff_v2(0, 0), &error), FF_ERR_ARGUMENT);
    FF_ASSERT_OK(ff_crowd_set_goal(crowd, b, ff_v2(9, 0), &error), error);
    assert_int_equal(ff_crowd_set_goal(crowd, b, ff_v2(NAN, 0), &error), FF_ERR_NOT_FINITE);
    ff_agent handles[4];
    assert_int_equal(ff_crowd_agents(crowd, handles, 4), 2);
    assert_int_equal(handles[0].generation, 2);
    assert_int_equal(ff_crowd_agent_count(crowd), 2);
    FF_ASSERT_OK(ff_crowd_remove_agent(crowd, b, &error), error);

    ff_agent_def bad[8];
    for (int i = 0; i < 8; ++i)
        bad[i] = ff_agent_def_default();
    bad[0].cookie = 0;
    bad[1].position.a = NAN;
    bad[2].goal.b = INFINITY;
    bad[3].radius = 0.0;
    bad[4].preferred_speed = -1.0;
    bad[5].goal_tolerance = NAN;
    bad[6].heading = INFINITY;
    bad[7].position.b = 1e9;
    for (int i = 0; i < 8; ++i)
        assert_int_not_equal(ff_crowd_add_agent(crowd, &bad[i], &c, &error), FF_OK);

    assert_int_equal(ff_crowd_add_wall(crowd, ff_v2(0, 0), ff_v2(0, 0), &error), FF_ERR_ARGUMENT);
    assert_int_equal(ff_crowd_add_wall(crowd, ff_v2(0, NAN), ff_v2(0, 0), &error), FF_ERR_NOT_FINITE);
    ff_crowd_step(crowd);
    assert_int_equal(ff_crowd_add_wall(crowd, ff_v2(0, 0), ff_v2(1, 0), &error), FF_ERR_ARGUMENT);
    ff_crowd_destroy(crowd);

    ff_crowd_def wrong[6];
    for (int i = 0; i < 6; ++i)
        wrong[i] = ff_crowd_def_default();
    wrong[0].cookie = 1;
    wrong[1].max_agents = 0;
    wrong[2].step = 0.0;
    wrong[3].step = NAN;
    wrong[4].threads = 0;
    wrong[5].keep_right = NAN;
    for (int i = 0; i < 6; ++i) {
        crowd = (ff_crowd *)&error;
        assert_int_not_equal(ff_crowd_create(walker.pack, &wrong[i], &crowd, &error), FF_OK);
        assert_null(crowd);
    }
    assert_int_equal(ff_crowd_create(NULL, &wrong[0], &crowd, &error), FF_ERR_ARGUMENT);
    ff_crowd_destroy(NULL);
}

static void serial_backwards(void *pool, uint32_t count, void (*function)(void *, uint32_t), void *context)
{
    ++*(int *)pool;
    for (uint32_t i = count; i-- > 0;)
        function(context, i);
}

/* A busy scene with removals, additions and new goals, 3,000 steps. */
static uint64_t busy_run(uint32_t threads, ff_parallel_for *tasks, void *pool, uint32_t steps)
{
    ff_error error;
    ff_crowd *crowd;
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = 60;
    def.threads = threads;
    def.tasks = tasks;
    def.task_pool = pool;
    FF_ASSERT_OK(ff_crowd_create(walker.pack, &def, &crowd, &error), error);
    trial_wall(crowd, ff_v2(-3, 1), ff_v2(3, 1.5));
    trial_wall(crowd, ff_v2(3, 1.5), ff_v2(3, 4));
    ff_random random = {8, 8, 0};
    ff_agent agents[60];
    for (int i = 0; i < 60; ++i)
        agents[i] = add(crowd, ff_scale2(ff_fwd2(FF_TAU * i / 60.0), 10.0),
                        ff_scale2(ff_fwd2(FF_TAU * i / 60.0), -10.0));
    for (uint32_t step = 0; step < steps; ++step) {
        ff_crowd_step(crowd);
        if (step % 50 != 49) continue;
        uint32_t k = (uint32_t)(ff_random_next(&random) % 60);
        ff_vec2 p = ff_scale2(ff_fwd2(ff_random_range(&random, -3, 3)), 9.0);
        FF_ASSERT_OK(ff_crowd_set_goal(crowd, agents[(k + 7) % 60], p, &error), error);
        FF_ASSERT_OK(ff_crowd_remove_agent(crowd, agents[k], &error), error);
        agents[k] = add(crowd, ff_scale2(p, 1.3), ff_scale2(p, -1.0));
    }
    uint64_t hash = ff_crowd_state_hash(crowd);
    ff_crowd_destroy(crowd);
    return hash;
}

static void one_thread_and_two_and_any_order_give_the_same_bits_after_3000_steps(void **state)
{
    (void)state;
    int calls = 0;
    uint64_t one = busy_run(1, NULL, NULL, 3000);
    assert_true(one == busy_run(2, NULL, NULL, 3000));
    assert_true(one == busy_run(1, serial_backwards, &calls, 3000));
    assert_true(calls > 3000);
    assert_true(one != busy_run(1, NULL, NULL, 2999));
}

static void a_pose_can_be_asked_for_at_any_time(void **state)
{
    (void)state;
    ff_error error;
    ff_crowd *crowd = new_crowd(1, 1);
    ff_agent agent = add(crowd, ff_v2(2, 1), ff_v2(8, 1));
    ff_quat rotations[FF_PACK_MAX_JOINTS];
    ff_vec3 hips;
    for (int i = 0; i < 60; ++i) {
        FF_ASSERT_OK(ff_crowd_agent_pose(crowd, agent, &hips, rotations, &error), error);
        ff_vec2 root = state_of(crowd, agent).position;
        FF_ASSERT_BELOW(ff_length2(ff_sub2(ff_plane(hips), root)), 0.25);
        for (uint32_t j = 0; j < ff_pack_joint_count(walker.pack); ++j)
            FF_ASSERT_NEAR(ff_quat_dot(rotations[j], rotations[j]), 1.0, 1e-9);
        ff_crowd_step(crowd);
    }
    assert_int_equal(ff_crowd_agent_pose(crowd, (ff_agent){0, 0}, &hips, rotations, &error), FF_ERR_ARGUMENT);
    ff_crowd_destroy(crowd);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lone_walker_goes_straight_to_the_goal_and_stands_there_without_dithering),
        cmocka_unit_test(slow_people_reach_small_goals_and_fast_ones_do_not_overshoot),
        cmocka_unit_test(who_looks_away_from_the_goal_turns_and_goes),
        cmocka_unit_test(two_side_by_side_who_must_change_sides_do_so_on_the_way),
        cmocka_unit_test(two_who_come_to_stand_nose_to_nose_step_past_each_other),
        cmocka_unit_test(two_who_meet_head_on_pass_each_other_on_the_right),
        cmocka_unit_test(people_on_one_point_part_without_nan),
        cmocka_unit_test(many_with_one_goal_settle_round_it),
        cmocka_unit_test(walls_are_never_crossed_and_a_door_is_passed),
        cmocka_unit_test(who_gets_no_nearer_tries_a_way_round),
        cmocka_unit_test(stale_handles_and_bad_definitions_are_refused),
        cmocka_unit_test(one_thread_and_two_and_any_order_give_the_same_bits_after_3000_steps),
        cmocka_unit_test(a_pose_can_be_asked_for_at_any_time),
    };
    return cmocka_run_group_tests(tests, ff_walker_open, ff_walker_close);
}
