/* Those who go by velocity among those who plan: where plans lead is known to them, and bodies do not get into each other. */
#define _GNU_SOURCE
#include "runtime/core/crowd/crowd_state.h"
#include "runtime/core/nav/nav_path.h"
#include "runtime/core/plan/plan_hit.h"
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

/* ------------------------------------------------------------------------------------------------- glides */

static ff_rates any_rates(const void *context, ff_rates target)
{
    (void)context;
    return target;
}

static ff_vec2 end_of(const ff_glide *glide)
{
    int last = FF_GLIDE_POINTS - 1;
    return ff_add2(glide->origin, ff_v2((double)glide->a[last], (double)glide->b[last]));
}

static void a_glide_ends_where_a_body_comes_to_a_stand(void **state)
{
    (void)state;
    for (int i = 0; i < 40; ++i) {
        ff_body body = {.heading = 0.3 * i, .rates = {0.2 + 0.07 * (i % 20), 0.0, 0.0}, .phase = i / 40.0};
        ff_body_limits limits = {any_rates, NULL, NULL, 0, 0.3, false};
        ff_glide glide;
        ff_glide_roll(body.position, ff_body_velocity(&body), ff_v2(0.0, 0.0), 0.0, &glide);
        for (int k = 0; k < 60; ++k)
            ff_body_step(&body, ff_v2(0.0, 0.0), body.heading, STEP, &limits);
        double off = ff_dot2(ff_sub2(end_of(&glide), body.position), ff_fwd2(body.heading));
        /* The glide brakes as in a swing: who brakes on a plant stands sooner, nobody later. */
        assert_true(off > -0.02 && off < 0.2);
    }
}

/* Somebody on a straight way, colliders in a row across it. */
static ff_track straight_track(ff_vec2 from, ff_vec2 velocity)
{
    ff_track track = {.origin = from, .count = 60};
    ff_vec2 across = ff_left2(ff_unit2(velocity));
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i)
        track.radii[i] = 0.1f;
    for (uint32_t k = 0; k < track.count; ++k) {
        for (int i = 0; i < FF_COLLIDER_COUNT; ++i) {
            double side = 0.08 * (i - 0.5 * (FF_COLLIDER_COUNT - 1));
            ff_vec2 at = ff_madd2(ff_scale2(velocity, k * FF_TRACK_STEP), across, side);
            track.knots[k].a[i] = (float)at.a;
            track.knots[k].b[i] = (float)at.b;
        }
        track.radius[k] = ff_knot_radius(&track.knots[k], track.radii);
    }
    return track;
}

/* By brute force. */
static double nearest_to(const ff_track *track, ff_vec2 velocity, ff_vec2 p, double seconds)
{
    double least = INFINITY;
    for (double t = 0.0; t < seconds; t += 1e-3)
        for (int i = 0; i < FF_COLLIDER_COUNT; ++i) {
            ff_vec2 at = ff_v2((double)track->knots[0].a[i], (double)track->knots[0].b[i]);
            ff_vec2 there = ff_madd2(ff_add2(track->origin, at), velocity, t);
            least = ff_min(least, ff_length2(ff_sub2(there, p)) - (double)track->radii[i]);
        }
    return least;
}

static void how_near_a_plan_comes_is_as_by_brute_force(void **state)
{
    (void)state;
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 60; ++i) {
        ff_vec2 from = ff_scale2(ff_fwd2(0.7 * i), 3.0),
                aside = ff_scale2(ff_left2(ff_fwd2(0.7 * i)), 0.012 * i);
        ff_vec2 velocity = ff_scale2(ff_sub2(aside, from), 0.35);
        ff_track track = straight_track(from, velocity);
        ff_glide stands;
        ff_glide_roll(ff_v2(0.0, 0.0), ff_v2(0.0, 0.0), ff_v2(0.0, 0.0), 0.0, &stands);
        double room = ff_glide_meets(&stands, &track, 0.0, 3.5, NULL) +
                      nearest_to(&track, velocity, ff_v2(0.0, 0.0), 3.5);
        low = ff_min(low, room);
        high = ff_max(high, room);
    }
    /* The room that the two shall have: always the same, that of a body. */
    assert_true(low > 0.3 && high < 0.5);
    FF_ASSERT_BELOW(high - low, 0.01);
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

/* Is a plan of the step that is over free of all glides of it, or nearer to none than what was in force? And of all other plans? */
static void check_new_plan(const ff_crowd *crowd, uint32_t slot, const ff_track *before, double time)
{
    const ff_track *track = &crowd->steppers[slot].track;
    for (uint32_t i = 0; i < crowd->slot_count; ++i) {
        if (i == slot) continue;
        if (ff_is_stepper(crowd, i)) {
            assert_false(ff_track_conflict(track, &crowd->steppers[i].track, time, 0.0, NULL));
            continue;
        }
        const ff_glide *glide = &crowd->footsteps->glides[i];
        double met = ff_glide_meets(glide, track, time, INFINITY, NULL);
        assert_true(met <= 0.0 || met <= ff_glide_meets(glide, before, time, INFINITY, NULL));
    }
}

static void check_plans(const ff_crowd *crowd, const ff_track *before, const uint64_t *reactions, double time)
{
    for (uint32_t i = 0; i < crowd->slot_count; ++i) {
        const ff_stepper *s = &crowd->steppers[i];
        /* Who has to break off a step does what it can. */
        if (ff_is_stepper(crowd, i) && s->created == time && s->counts.reactions == reactions[i])
            check_new_plan(crowd, i, &before[i], time);
    }
}

/* Every other one on footsteps, all on the way across. */
static ff_crowd *circle_of(double off, ff_agent agent[AGENTS])
{
    ff_crowd_def def = ff_crowd_def_default();
    ff_crowd *crowd;
    ff_error error;
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
    return crowd;
}

static void plans_come_into_force_only_past_others_and_past_where_they_can_stop(void **state)
{
    (void)state;
    static ff_track before[AGENTS];
    uint64_t reactions[AGENTS];
    ff_agent agent[AGENTS];
    ff_crowd *crowd = circle_of(0.03, agent);
    for (int step = 0; step < 10.0 / STEP; ++step) {
        double time = ff_crowd_time(crowd);
        for (int i = 0; i < AGENTS; ++i) {
            before[i] = crowd->steppers[i].track;
            reactions[i] = crowd->steppers[i].counts.reactions;
        }
        ff_crowd_step(crowd);
        check_plans(crowd, before, reactions, time);
    }
    ff_crowd_destroy(crowd);
}

/* How deep one who plans and one who goes by velocity ever get into each other on a circle; everybody gets across. */
static double deepest_on_circle(const ff_figure *figure, double off)
{
    ff_agent agent[AGENTS];
    ff_cylinders body[AGENTS];
    double deepest = 0.0;
    ff_crowd *crowd = circle_of(off, agent);
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
        cmocka_unit_test(a_glide_ends_where_a_body_comes_to_a_stand),
        cmocka_unit_test(how_near_a_plan_comes_is_as_by_brute_force),
        cmocka_unit_test(plans_come_into_force_only_past_others_and_past_where_they_can_stop),
        cmocka_unit_test(a_mixed_crowd_crosses_a_circle),
    };
    return cmocka_run_group_tests_name("mixed crowds", tests, open_pack, close_pack);
}
