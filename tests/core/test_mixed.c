/* Those who go by velocity among those who plan: where plans lead is known to them, and bodies do not get into each other. */
#define _GNU_SOURCE
#include "runtime/core/crowd/crowd_state.h"
#include "runtime/core/nav/nav_path.h"
#include "runtime/export/body_contacts.h"
#include "tests/built_in_open.h"
#include "tests/core/crowd_ask.h"

#define STEP (1.0 / 30.0)
#define AGENTS 20

/* From `from` at a velocity, then at another from a time on. */
static ff_path path_of(ff_vec2 from, ff_vec2 before, ff_vec2 after, double turn)
{
    ff_path path;
    for (int i = 0; i < FF_PATH_POINTS; ++i) {
        double time = i * FF_PATH_STEP, first = ff_min(time, turn);
        path.at[i] = ff_madd2(ff_madd2(from, before, first), after, time - first);
    }
    return path;
}

static void who_goes_straight_is_met_as_a_disc_is(void **state)
{
    (void)state;
    const double ahead = 0.3;
    for (int i = 0; i < 24; ++i) {
        ff_vec2 from = ff_scale2(ff_fwd2(FF_TAU * i / 24.0), 3.0), v = ff_scale2(from, -0.4);
        ff_seen me = {.velocity = {0.3, 0.1}, .reference = {0.2, 0.3}};
        ff_path path = path_of(from, v, v, INFINITY);
        ff_path_meeting meeting = ff_path_meet(&path, &me, ahead);
        ff_vec2 x = ff_sub2(ff_madd2(from, v, ahead), ff_scale2(me.velocity, ahead));
        FF_ASSERT_BELOW(ff_length2(ff_sub2(meeting.to_other, x)), 1e-9);
        FF_ASSERT_BELOW(ff_length2(ff_sub2(meeting.velocity, v)), 1e-9);
        double time = ff_time_to_disc(x, ff_sub2(v, me.reference), meeting.reach);
        if (meeting.time < INFINITY) FF_ASSERT_NEAR(meeting.time - ahead, time, 0.5 * FF_PATH_STEP);
    }
}

static void where_a_plan_turns_is_known_before_it_does(void **state)
{
    (void)state;
    /* It goes past, three metres off, until it turns to where the agent will be. */
    ff_seen me = {.velocity = {1.2, 0.0}, .reference = {1.2, 0.0}};
    ff_path past = path_of(ff_v2(2.4, 3.0), ff_v2(0.0, 0.0), ff_v2(0.0, 0.0), INFINITY);
    ff_path turns = path_of(ff_v2(2.4, 3.0), ff_v2(0.0, 0.0), ff_v2(0.0, -2.0), 0.75);
    assert_true(ff_path_meet(&past, &me, 0.3).time == INFINITY);
    ff_path_meeting meeting = ff_path_meet(&turns, &me, 0.3);
    assert_true(meeting.time > 1.2 && meeting.time < 2.1);
    assert_true(meeting.velocity.b < -0.8);
}

static void who_stands_too_near_is_not_pushed_away(void **state)
{
    (void)state;
    ff_seen me = {.velocity = {0.0, 0.0}};
    ff_path stands = path_of(ff_v2(0.66, 0.0), ff_v2(0.0, 0.0), ff_v2(0.0, 0.0), INFINITY);
    ff_path_meeting meeting = ff_path_meet(&stands, &me, 0.3);
    FF_ASSERT_BELOW(meeting.reach, 0.66);
    ff_path far = path_of(ff_v2(2.0, 0.0), ff_v2(0.0, 0.0), ff_v2(0.0, 0.0), INFINITY);
    assert_true(ff_path_meet(&far, &me, 0.3).reach > meeting.reach);
}

/* ------------------------------------------------------------------------------------------------- crowds */

static ff_cylinders body_of(const ff_figure *figure, const ff_crowd *crowd, ff_agent agent)
{
    ff_vec3 hips, joints[FF_FIGURE_MAX_JOINTS];
    ff_quat local[FF_FIGURE_MAX_JOINTS], turned[FF_FIGURE_MAX_JOINTS];
    ff_error error;
    FF_ASSERT_OK(ff_crowd_agent_pose(crowd, agent, &hips, local, &error), error);
    ff_figure_place(figure, hips, local, joints, turned);
    return ff_cylinders_of_colliders(pack, joints, turned);
}

/* How deep one who plans and one who goes by velocity ever get into each other on a circle; everybody gets across. */
static double deepest_on_circle(const ff_figure *figure, double off)
{
    ff_crowd_def def = ff_crowd_def_default();
    ff_crowd *crowd;
    ff_agent agent[AGENTS];
    ff_cylinders body[AGENTS];
    ff_error error;
    double deepest = 0.0;
    def.max_agents = AGENTS;
    def.step = STEP;
    def.planner = FF_PLANNER_FOOTSTEPS;
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &crowd, &error), error);
    for (int i = 0; i < AGENTS; ++i) {
        ff_vec2 at = ff_scale2(ff_fwd2(FF_TAU * i / AGENTS + off * (i % 3)), 5.0);
        ff_agent_def one = ff_agent_def_default();
        one.position = at;
        one.goal = ff_scale2(at, -1.0);
        one.heading = ff_atan2(-at.b, -at.a);
        one.planner = i % 2 == 0 ? FF_PLANNER_FOOTSTEPS : FF_PLANNER_VELOCITY;
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &one, &agent[i], &error), error);
    }
    for (int step = 0; step < 20.0 / STEP; ++step) {
        ff_crowd_step(crowd);
        for (int i = 0; i < AGENTS; ++i)
            body[i] = body_of(figure, crowd, agent[i]);
        for (int i = 0; i < AGENTS; i += 2)
            for (int k = 1; k < AGENTS; k += 2)
                deepest = ff_max(deepest, ff_cylinders_overlap(&body[i], &body[k]));
    }
    for (int i = 0; i < AGENTS; ++i)
        assert_int_equal(state_of(crowd, agent[i]).reached, 1);
    ff_crowd_destroy(crowd);
    return deepest;
}

static void a_mixed_crowd_crosses_a_circle(void **state)
{
    (void)state;
    ff_figure figure;
    ff_error error;
    FF_ASSERT_OK(ff_figure_from_pack(pack, &figure, &error), error);
    for (int i = 0; i < 3; ++i) {
        double deepest = deepest_on_circle(&figure, 0.02 + 0.01 * i);
        print_message("one who plans and one who does not: at most %.1f cm deep\n", 100.0 * deepest);
        FF_ASSERT_BELOW(deepest, 0.05);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(who_goes_straight_is_met_as_a_disc_is),
        cmocka_unit_test(where_a_plan_turns_is_known_before_it_does),
        cmocka_unit_test(who_stands_too_near_is_not_pushed_away),
        cmocka_unit_test(a_mixed_crowd_crosses_a_circle),
    };
    return cmocka_run_group_tests_name("mixed crowds", tests, open_pack, close_pack);
}
