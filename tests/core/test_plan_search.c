/* The search as it is used: guided by the table, past walls, among others. */
#define _GNU_SOURCE
#include "tests/core/plan_world.h"

#include <stdio.h>

static int by_value(const void *x, const void *y)
{
    const double *p = x, *q = y;
    return (*p > *q) - (*p < *q);
}

static ff_plan_options exact_options(void)
{
    ff_plan_options options = ff_plan_options_default();
    options.nodes = options.improve = 20000;
    options.horizon = 20;
    options.time_horizon = 0.0;
    options.inflation = 1.0;
    options.inflation_step = 0.0;
    options.table = 0;
    return options;
}

/* ------------------------------------------------------------------------------------------------------- guides */

static void inflated_two_and_a_half_times_the_table_still_finds_good_ways(void **state)
{
    const plan_world *w = *state;
    enum { PROBLEMS = 100 };
    ff_random random = {5, 0, 0};
    double ratio[PROBLEMS];
    int n = 0, lost = 0, expanded = 0;
    for (int i = 0; i < PROBLEMS; ++i) {
        ff_plan start, plan;
        ff_plan_stand(w->set, ff_v2(0.0, 0.0), ff_random_range(&random, -FF_PI, FF_PI), 0.0, &start);
        ff_plan_goal goal = ff_plan_goal_at(ff_scale2(ff_fwd2(ff_random_range(&random, -FF_PI, FF_PI)), 5.0));
        ff_solids *solids = i % 10 == 0 ? plan_things(&random, 0.8, 4.0, PLAN_THINGS) : NULL;
        const ff_plan_world world = {.solids = solids};
        ff_plan_options options = exact_options();
        ff_plan_result exact =
            ff_plan_search(w->set, &world, &start, 0.0, &goal, &options, w->scratch, &plan);
        options.table = 1;
        options.inflation = 2.5;
        ff_plan_result quick =
            ff_plan_search(w->set, &world, &start, 0.0, &goal, &options, w->scratch, &plan);
        ff_solids_destroy(solids);
        if (exact.outcome != FF_PLAN_REACHED) continue;
        if (quick.outcome != FF_PLAN_REACHED) {
            ++lost;
            continue;
        }
        ratio[n++] = quick.cost / exact.cost;
        expanded += (int)quick.expanded;
    }
    qsort(ratio, (size_t)n, sizeof *ratio, by_value);
    printf("  %d problems: %.3f times the least in the median, %.3f at 95 %%; %.0f expansions\n", n,
           ratio[n / 2], ratio[n * 95 / 100], (double)expanded / n);
    assert_true(n >= 50 && lost == 0);
    FF_ASSERT_BELOW(ratio[n / 2], 1.10);
    FF_ASSERT_BELOW(ratio[n * 95 / 100], 1.25);
}

static void out_of_a_trap_leads_the_distance_field(void **state)
{
    const plan_world *w = *state;
    int worst = 0, out = 0;
    for (int i = 0; i < 40; ++i) {
        ff_random random = {9, (uint64_t)i, 0};
        double turn = ff_random_range(&random, -FF_PI, FF_PI), deep = ff_random_range(&random, 0.8, 2.0),
               wide = ff_random_range(&random, 1.4, 2.2);
        /* A U that opens away from the goal, with the agent in it. */
        ff_vec2 corner[4] = {{-deep, -wide}, {1.5, -wide}, {1.5, wide}, {-deep, wide}}, walls[3][2];
        for (int k = 0; k < 4; ++k)
            corner[k] = ff_from_frame2(ff_fwd2(turn), corner[k]);
        for (int k = 0; k < 3; ++k) {
            walls[k][0] = corner[k];
            walls[k][1] = corner[k + 1];
        }
        ff_error error;
        ff_solids *solids;
        ff_field *field;
        ff_vec2 to = ff_from_frame2(ff_fwd2(turn), ff_v2(ff_random_range(&random, 2.5, 4.0), 0.0));
        FF_ASSERT_OK(ff_solids_create((const ff_vec2(*)[2])walls, 3, NULL, 0, &solids, &error), error);
        FF_ASSERT_OK(ff_field_create(solids, to, 12.0, 0.5, &field, &error), error);
        const ff_plan_world world = {.solids = solids};
        ff_plan_goal goal = ff_plan_goal_at(to);
        goal.field = field;
        ff_plan_options options = ff_plan_options_default();
        options.nodes = 200;
        options.inflation = 3.0;
        options.inflation_step = 0.0;
        ff_plan plan;
        ff_plan_stand(w->set, ff_v2(0.0, 0.0), turn + ff_random_range(&random, -1.0, 1.0), 0.0, &plan);
        ff_vec2 at = ff_v2(0.0, 0.0);
        double time = 0.0;
        for (int k = 0; k < 40; ++k) {
            ff_plan_result result =
                ff_plan_search(w->set, &world, &plan, time, &goal, &options, w->scratch, &plan);
            if ((int)result.expanded > worst) worst = (int)result.expanded;
            if (result.outcome != FF_PLAN_AHEAD) break;
            time = plan.steps[plan.stop - 1].start + 0.01;
        }
        at = ff_plan_root_at(w->set, &plan, 1e6).position;
        out += ff_length2(ff_sub2(at, to)) <= 0.35;
        ff_field_destroy(field);
        ff_solids_destroy(solids);
    }
    printf("  %d of 40 are out, at most %d expansions a plan\n", out, worst);
    assert_true(out >= 38);
}

static void the_field_is_how_far_one_has_to_walk(void **state)
{
    (void)state;
    ff_error error;
    const ff_vec2 walls[1][2] = {{{-3.0, 2.0}, {3.0, 2.0}}};
    ff_solids *solids;
    ff_field *field;
    FF_ASSERT_OK(ff_solids_create(walls, 1, NULL, 0, &solids, &error), error);
    FF_ASSERT_OK(ff_field_create(solids, ff_v2(0.0, 4.0), 10.0, 0.3, &field, &error), error);
    ff_random random = {4, 0, 0};
    ff_vec2 goal = ff_v2(0.0, 4.0);
    for (int i = 0; i < 2000; ++i) {
        ff_vec2 p = ff_v2(ff_random_range(&random, -6.0, 6.0), ff_random_range(&random, -5.0, 9.0));
        if (ff_solids_near(solids, p, 0.4)) continue;
        double straight = ff_length2(ff_sub2(p, goal)), way = straight;
        if (!ff_solids_clear(solids, p, goal, 0.0)) {
            way = INFINITY;
            for (int side = -1; side <= 1; side += 2) {
                ff_vec2 end = ff_v2(3.3 * side, 2.0); /* at its clearance */
                way = ff_min(way, ff_length2(ff_sub2(p, end)) + ff_length2(ff_sub2(end, goal)));
            }
        }
        double said = ff_field_distance(field, p);
        FF_ASSERT_BELOW(said, way + 0.7); /* it counts cells */
        FF_ASSERT_BELOW(0.94 * way - 0.7, said);
    }
    assert_true(ff_field_distance(field, ff_v2(30.0, 0.0)) < 0.0);
    ff_field_destroy(field);
    ff_solids_destroy(solids);
    ff_field *none;
    assert_int_equal(ff_field_create(NULL, goal, NAN, 0.3, &none, &error), FF_ERR_RANGE);
    assert_null(none);
}

/* ------------------------------------------------------------------------------------------------------- safety */

/* What is stored of a plan, and what others see of it. */
typedef struct member {
    ff_plan plan;
    ff_track track;
    ff_vec2 goal;
} member;

static void plans_in_force_never_meet(void **state)
{
    const plan_world *w = *state;
    enum { PEOPLE = 12 };
    static member crowd[PEOPLE];
    const ff_track *others[PEOPLE];
    int made = 0, refused = 0, arrived = 0;
    for (int i = 0; i < PEOPLE; ++i) {
        ff_vec2 at = ff_scale2(ff_fwd2(FF_TAU * i / PEOPLE), 3.5);
        crowd[i].goal = ff_scale2(at, -1.0);
        ff_plan_stand(w->set, at, FF_TAU * i / PEOPLE + FF_PI, 0.0, &crowd[i].plan);
        ff_plan_track(w->set, &crowd[i].plan, 0.0, &crowd[i].track);
    }
    ff_plan_options options = ff_plan_options_default();
    for (int tick = 0; tick < 400; ++tick) {
        double time = tick * 0.05;
        member *m = &crowd[tick * 5 % PEOPLE];
        ff_plan_world world = {.tracks = others};
        for (int k = 0; k < PEOPLE; ++k)
            if (&crowd[k] != m) others[world.track_count++] = &crowd[k].track;
        ff_plan_goal goal = ff_plan_goal_at(m->goal);
        ff_plan plan = m->plan;
        ff_plan_result result =
            ff_plan_search(w->set, &world, &m->plan, time, &goal, &options, w->scratch, &plan);
        if (result.outcome == FF_PLAN_NONE) {
            ++refused;
            assert_memory_equal(&plan, &m->plan, sizeof plan);
            continue;
        }
        ++made;
        assert_true(plan.count <= FF_PLAN_STEPS_MAX && plan.steps[plan.count - 1].hold == 1);
        m->plan = plan;
        ff_plan_track(w->set, &plan, time, &m->track);
        for (uint32_t k = 0; k < world.track_count; ++k)
            assert_false(ff_track_conflict(&m->track, others[k], time, 0.0, NULL));
    }
    for (int i = 0; i < PEOPLE; ++i)
        arrived +=
            ff_length2(ff_sub2(ff_plan_root_at(w->set, &crowd[i].plan, 1e6).position, crowd[i].goal)) < 0.5;
    printf("  %d plans, %d refused; %d of %d at their goals after 20 s\n", made, refused, arrived, PEOPLE);
    assert_true(made > 300 && arrived == PEOPLE);
}

static void nobody_goes_through_a_thin_wall(void **state)
{
    const plan_world *w = *state;
    int met = 0;
    for (int i = 0; i < 1000; ++i) {
        ff_random random = {17, (uint64_t)i, 0};
        ff_vec2 middle =
            ff_scale2(ff_fwd2(ff_random_range(&random, -0.3, 0.3)), ff_random_range(&random, 0.6, 2.0));
        ff_vec2 half =
            ff_scale2(ff_fwd2(ff_random_range(&random, -FF_PI, FF_PI)), ff_random_range(&random, 0.1, 1.0));
        const ff_vec2 walls[1][2] = {{ff_sub2(middle, half), ff_add2(middle, half)}};
        ff_solids *solids;
        ff_error error;
        FF_ASSERT_OK(ff_solids_create(walls, 1, NULL, 0, &solids, &error), error);
        const ff_plan_world world = {.solids = solids};
        ff_plan plan;
        ff_plan_stand(w->set, ff_v2(0.0, 0.0), ff_random_range(&random, -0.3, 0.3), 0.0, &plan);
        if (!ff_solids_near(solids, ff_v2(0.0, 0.0), 0.5)) {
            ff_plan_goal goal = ff_plan_goal_at(ff_v2(4.0, 0.0));
            ff_plan_options options = ff_plan_options_default();
            options.nodes = 60;
            options.inflation_step = 0.0;
            ff_plan_search(w->set, &world, &plan, 0.0, &goal, &options, w->scratch, &plan);
            /* The joints' way itself, looked at twenty times as often as the search does. */
            bool over = false;
            ff_vec3 last[FF_COLLIDER_COUNT], at[FF_COLLIDER_COUNT];
            ff_plan_colliders(w->set, &plan, 0.0, last);
            for (double t = 0.005; t < plan.steps[plan.count - 1].start + 0.3; t += 0.005) {
                ff_plan_colliders(w->set, &plan, t, at);
                for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
                    ff_vec2 p = ff_v2(last[c].x, last[c].y), q = ff_v2(at[c].x, at[c].y);
                    assert_true(ff_solids_clear(solids, p, q, 0.7 * (double)ff_collider_radius[c]));
                }
                over = over || !ff_solids_clear(solids, ff_v2(0.0, 0.0), ff_v2(4.0, 0.0), 0.1);
                memcpy(last, at, sizeof last);
            }
            met += over;
        }
        ff_solids_destroy(solids);
    }
    printf("  %d walls were in the way\n", met);
    assert_true(met > 300);
}

static void moving_things_are_kept_from_when_they_are_there(void **state)
{
    const plan_world *w = *state;
    double nearest = INFINITY;
    int reached = 0;
    for (int i = 0; i < 60; ++i) {
        ff_random random = {23, (uint64_t)i, 0};
        ff_path_point paths[3][3];
        ff_mover movers[3];
        for (int k = 0; k < 3; ++k) {
            ff_vec2 from = ff_v2(ff_random_range(&random, 1.2, 3.5), -3.0),
                    to = ff_v2(ff_random_range(&random, 1.2, 3.5), 3.0);
            double takes = ff_random_range(&random, 2.0, 6.0);
            paths[k][0] = (ff_path_point){0.0, from};
            paths[k][1] = (ff_path_point){takes, to};
            paths[k][2] = (ff_path_point){2.0 * takes, from};
            movers[k] = (ff_mover){.shape = {.radius = 0.3, .high = 2.0},
                                   .path = paths[k],
                                   .count = 3,
                                   .cyclic = 1,
                                   .start = ff_random_range(&random, -5.0, 0.0)};
        }
        const ff_plan_world world = {.movers = movers, .mover_count = 3};
        ff_plan plan;
        ff_plan_stand(w->set, ff_v2(0.0, 0.0), 0.0, 0.0, &plan);
        ff_plan_goal goal = ff_plan_goal_at(ff_v2(5.0, 0.0));
        ff_plan_options options = ff_plan_options_default();
        ff_plan_result result =
            ff_plan_search(w->set, &world, &plan, 0.0, &goal, &options, w->scratch, &plan);
        reached += result.outcome == FF_PLAN_REACHED || result.outcome == FF_PLAN_AHEAD;
        for (double t = 0.0; t < 9.0; t += 0.01) {
            ff_vec3 at[FF_COLLIDER_COUNT];
            ff_plan_colliders(w->set, &plan, t, at);
            for (int c = 0; c < FF_COLLIDER_COUNT; ++c)
                for (int k = 0; k < 3; ++k) {
                    ff_vec2 gap = ff_sub2(ff_v2(at[c].x, at[c].y), ff_mover_at(&movers[k], t));
                    nearest = ff_min(nearest, ff_length2(gap) - 0.3 - (double)ff_collider_radius[c]);
                }
        }
    }
    printf("  %d of 60 got on; nearest %.3f m\n", reached, nearest);
    assert_true(reached >= 40 && nearest > 0.0);
}

/* -------------------------------------------------------------------------------------------------- being anytime */

static void with_more_nodes_plans_only_get_better(void **state)
{
    const plan_world *w = *state;
    int better = 0, closed = 0;
    for (int i = 0; i < 24; ++i) {
        ff_random random = {37, (uint64_t)i, 0};
        ff_solids *solids = plan_things(&random, 0.9, 3.0, PLAN_THINGS);
        const ff_plan_world world = {.solids = solids};
        ff_plan_goal goal = ff_plan_goal_at(ff_scale2(ff_fwd2(ff_random_range(&random, -FF_PI, FF_PI)), 4.0));
        ff_plan_options options = exact_options();
        options.table = 1;
        options.inflation = 3.0;
        options.inflation_step = 0.5;
        ff_plan start, plan;
        ff_plan_stand(w->set, ff_v2(0.0, 0.0), 0.0, 0.0, &start);
        double last = INFINITY, bound = INFINITY;
        for (uint32_t nodes = 8; nodes <= 4096; nodes *= 2) {
            options.nodes = nodes;
            ff_plan_result result =
                ff_plan_search(w->set, &world, &start, 0.0, &goal, &options, w->scratch, &plan);
            if (result.outcome != FF_PLAN_REACHED) continue;
            FF_ASSERT_BELOW(result.cost, last);
            FF_ASSERT_BELOW(result.inflation, bound);
            better += result.cost < last && last < INFINITY;
            last = result.cost;
            bound = result.inflation;
        }
        closed += bound <= 1.0;
        ff_solids_destroy(solids);
    }
    printf("  %d times better than before; %d of 24 proven the best\n", better, closed);
    assert_true(better >= 12 && closed >= 6);
}

static void a_plan_that_is_followed_never_gets_dearer(void **state)
{
    const plan_world *w = *state;
    for (int i = 0; i < 20; ++i) {
        ff_random random = {41, (uint64_t)i, 0};
        ff_solids *solids = plan_things(&random, 0.9, 3.0, PLAN_THINGS);
        const ff_plan_world world = {.solids = solids};
        ff_plan_goal goal = ff_plan_goal_at(ff_scale2(ff_fwd2(ff_random_range(&random, -FF_PI, FF_PI)), 3.5));
        ff_plan_options options = ff_plan_options_default();
        options.time_horizon = 0.0;
        options.nodes = options.improve = 1500;
        ff_plan plan;
        ff_plan_stand(w->set, ff_v2(0.0, 0.0), 0.0, 0.0, &plan);
        ff_plan_result result =
            ff_plan_search(w->set, &world, &plan, 0.0, &goal, &options, w->scratch, &plan);
        options.nodes = 4; /* hardly time to think */
        double time = 0.0, total = result.cost;
        while (result.outcome == FF_PLAN_REACHED && plan.own < plan.stop) {
            /* What the step that comes costs: the difference of what is left. */
            ff_plan old = plan;
            time = plan.steps[plan.own].start + 0.01;
            result = ff_plan_search(w->set, &world, &old, time, &goal, &options, w->scratch, &plan);
            assert_int_equal(result.outcome, FF_PLAN_REACHED);
            FF_ASSERT_BELOW(result.cost, total);
            total = result.cost;
        }
        ff_solids_destroy(solids);
    }
}

static void the_same_question_has_the_same_answer_whatever_was_asked_before(void **state)
{
    const plan_world *w = *state;
    ff_plan first[2], plan;
    ff_plan_options options = ff_plan_options_default();
    const ff_plan_world world = {0};
    for (int round = 0; round < 2; ++round) {
        memset(&first[round], 0, sizeof first[round]);
        ff_plan_stand(w->set, ff_v2(3.0, -1.0), 0.3, 7.0, &first[round]);
        ff_plan_goal goal = ff_plan_goal_at(ff_v2(-2.0, 2.0));
        ff_plan_search(w->set, &world, &first[round], 7.5, &goal, &options, w->scratch, &first[round]);
        ff_plan_stand(w->set, ff_v2(100.0, 0.0), 1.0, 0.0, &plan);
        goal = ff_plan_goal_at(ff_v2(104.0, 0.0));
        ff_plan_search(w->set, &world, &plan, 0.0, &goal, &options, w->scratch, &plan);
    }
    assert_memory_equal(&first[0], &first[1], sizeof first[0]);
}

static void who_is_surrounded_keeps_the_old_plan(void **state)
{
    const plan_world *w = *state;
    ff_plan plan, old;
    ff_plan_stand(w->set, ff_v2(0.0, 0.0), 0.0, 0.0, &plan);
    /* A wall through the very place: nothing begins free, not even standing. */
    const ff_vec2 walls[1][2] = {{{0.0, -2.0}, {0.0, 2.0}}};
    ff_solids *solids;
    ff_error error;
    FF_ASSERT_OK(ff_solids_create(walls, 1, NULL, 0, &solids, &error), error);
    const ff_plan_world world = {.solids = solids};
    ff_plan_goal goal = ff_plan_goal_at(ff_v2(3.0, 0.0));
    ff_plan_options options = ff_plan_options_default();
    old = plan;
    ff_plan_result result = ff_plan_search(w->set, &world, &plan, 0.0, &goal, &options, w->scratch, &plan);
    assert_int_equal(result.outcome, FF_PLAN_NONE);
    assert_memory_equal(&plan, &old, sizeof plan);
    ff_solids_destroy(solids);
}

static void an_agent_needs_at_most_16_kib(void **state)
{
    (void)state;
    assert_true(sizeof(ff_plan) + sizeof(ff_track) <= 14 * 1024);
}

static void waypoints_that_are_seen_past_are_skipped(void **state)
{
    (void)state;
    const ff_vec2 walls[2][2] = {{{2.0, -5.0}, {2.0, 1.3}}, {{4.0, -1.0}, {4.0, 5.0}}};
    const ff_vec2 points[4] = {{1.0, 1.8}, {2.5, 1.8}, {3.5, -1.8}, {6.0, -1.8}};
    ff_solids *solids;
    ff_error error;
    FF_ASSERT_OK(ff_solids_create(walls, 2, NULL, 0, &solids, &error), error);
    assert_int_equal(ff_waypoint_seen(solids, points, 4, 0, ff_v2(0.0, 0.0), 0.3), 0);
    assert_int_equal(ff_waypoint_seen(solids, points, 4, 0, ff_v2(0.5, 1.8), 0.3), 1);
    assert_int_equal(ff_waypoint_seen(solids, points, 4, 1, ff_v2(2.5, 1.6), 0.3), 2);
    assert_int_equal(ff_waypoint_seen(solids, points, 4, 2, ff_v2(3.0, -1.8), 0.3), 3);
    assert_int_equal(ff_waypoint_seen(NULL, points, 4, 0, ff_v2(0.0, 0.0), 0.3), 3);
    ff_solids_destroy(solids);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inflated_two_and_a_half_times_the_table_still_finds_good_ways),
        cmocka_unit_test(out_of_a_trap_leads_the_distance_field),
        cmocka_unit_test(the_field_is_how_far_one_has_to_walk),
        cmocka_unit_test(plans_in_force_never_meet),
        cmocka_unit_test(nobody_goes_through_a_thin_wall),
        cmocka_unit_test(moving_things_are_kept_from_when_they_are_there),
        cmocka_unit_test(with_more_nodes_plans_only_get_better),
        cmocka_unit_test(a_plan_that_is_followed_never_gets_dearer),
        cmocka_unit_test(the_same_question_has_the_same_answer_whatever_was_asked_before),
        cmocka_unit_test(who_is_surrounded_keeps_the_old_plan),
        cmocka_unit_test(an_agent_needs_at_most_16_kib),
        cmocka_unit_test(waypoints_that_are_seen_past_are_skipped),
    };
    return cmocka_run_group_tests(tests, plan_world_open, plan_world_close);
}
