/* Which way of moving an agent wants (FbCrowd eq 1, read as its prose), and what a crowd makes of it. */
#define _GNU_SOURCE
#include "runtime/core/gait/synth_choice.h"
#include "tests/built_in_open.h"

static ff_choice_view far_from_all(void)
{
    return (ff_choice_view){.step = 0.1, .time = INFINITY, .ahead = 1.3, .since_switch = 10.0};
}

static ff_locomotion ask(const ff_choice_view *view, ff_choice *choice, bool *urgent)
{
    return ff_choose_locomotion(FF_SYNTHESIS_HYBRID, view, choice, urgent);
}

static void in_the_open_examples_are_blended_and_near_a_collision_they_are_not(void **state)
{
    (void)state;
    static const struct {
        double time, density;
        ff_locomotion way;
        bool urgent;
    } cases[] = {{INFINITY, 0.0, FF_BLENDING, false},   {2.1, 0.9, FF_BLENDING, false},
                 {1.9, 0.0, FF_SEMI_PROCEDURAL, false}, {INFINITY, 1.1, FF_SEMI_PROCEDURAL, false},
                 {0.3, 0.0, FF_SEMI_PROCEDURAL, true},  {0.0, 3.0, FF_SEMI_PROCEDURAL, true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        ff_choice choice = {0};
        ff_choice_view view = far_from_all();
        bool urgent;
        view.time = cases[i].time;
        view.density = cases[i].density;
        assert_int_equal(ask(&view, &choice, &urgent), cases[i].way);
        assert_int_equal(urgent, cases[i].urgent);
    }
}

static void back_to_blending_takes_a_margin_and_a_while(void **state)
{
    (void)state;
    ff_choice choice = {0};
    ff_choice_view view = far_from_all();
    bool urgent;
    view.time = 1.0;
    assert_int_equal(ask(&view, &choice, &urgent), FF_SEMI_PROCEDURAL);
    view.time = 2.3; /* no collision near, but not far enough either */
    for (int i = 0; i < 50; ++i)
        assert_int_equal(ask(&view, &choice, &urgent), FF_SEMI_PROCEDURAL);
    view.time = 5.0;
    for (int i = 0; i < 5; ++i)
        assert_int_equal(ask(&view, &choice, &urgent), FF_SEMI_PROCEDURAL);
    view.time = 2.3; /* the while begins anew */
    assert_int_equal(ask(&view, &choice, &urgent), FF_SEMI_PROCEDURAL);
    view.time = 5.0;
    int steps = 0;
    while (ask(&view, &choice, &urgent) == FF_SEMI_PROCEDURAL)
        assert_true(++steps < 20);
    assert_in_range(steps, 6, 8); /* 0.75 s */
}

static void nobody_changes_twice_at_once_unless_he_must(void **state)
{
    (void)state;
    ff_choice choice = {0};
    ff_choice_view view = far_from_all();
    bool urgent;
    view.since_switch = 0.2;
    view.time = 1.0;
    assert_int_equal(ask(&view, &choice, &urgent), FF_BLENDING);
    view.time = 0.2;
    assert_int_equal(ask(&view, &choice, &urgent), FF_SEMI_PROCEDURAL);
    assert_true(urgent);
}

static void who_is_told_how_to_walk_walks_so_whatever_happens(void **state)
{
    (void)state;
    ff_choice choice = {0};
    bool urgent;
    for (int i = 0; i < 40; ++i) {
        ff_choice_view view = far_from_all();
        view.time = i % 2 ? 0.1 : 9.0;
        ff_choice other = {0};
        assert_int_equal(ff_choose_locomotion(FF_SYNTHESIS_BLENDING, &view, &choice, &urgent), FF_BLENDING);
        assert_false(urgent);
        assert_int_equal(ff_choose_locomotion(FF_SYNTHESIS_SEMI_PROCEDURAL, &view, &other, &urgent),
                         FF_SEMI_PROCEDURAL);
    }
}

static void who_hurries_runs_where_there_is_room_ahead(void **state)
{
    (void)state;
    ff_choice choice = {0};
    ff_choice_view view = far_from_all();
    bool urgent;
    view.ahead = 3.0;
    assert_int_equal(ask(&view, &choice, &urgent), FF_BLENDING); /* at ease */
    view.hurries = true;
    assert_int_equal(ask(&view, &choice, &urgent), FF_RUNNING);
    view.ahead = 1.9; /* still quick enough to go on, not to begin */
    assert_int_equal(ask(&view, &choice, &urgent), FF_RUNNING);
    view.ahead = 1.6;
    assert_int_equal(ask(&view, &choice, &urgent), FF_BLENDING);
    view.ahead = 1.9;
    assert_int_equal(ask(&view, &choice, &urgent), FF_BLENDING);
}

static void density_is_that_of_people_spread_evenly(void **state)
{
    (void)state;
    enum { SIDE = 24 };
    static ff_seen people[SIDE * SIDE];
    size_t size = ff_grid_bytes(SIDE * SIDE);
    ff_arena arena;
    ff_error error;
    ff_grid grid;
    FF_ASSERT_OK(ff_arena_create(&arena, size + 64, &error), error);
    assert_true(ff_grid_init(&grid, SIDE * SIDE, &arena));
    for (int i = 0; i < SIDE * SIDE; ++i)
        people[i] =
            (ff_seen){.position = {0.5 * (i % SIDE), 0.5 * (i / SIDE)}, .radius = 0.2, .slot = (uint32_t)i};
    ff_grid_fill(&grid, people, SIDE * SIDE);
    for (uint32_t i = 0; i < grid.count; ++i) {
        ff_vec2 p = grid.seen[i].position;
        if (fabs(p.a - 6.0) > 2.0 || fabs(p.b - 6.0) > 2.0) continue;
        /* Four per m2; oneself is not counted, which is one Gaussian's peak less; beyond three deviations nobody is. */
        FF_ASSERT_NEAR(ff_choice_density(&grid, i), 4.0 - 1.0 / (FF_TAU * 0.64), 0.06);
    }
    ff_arena_destroy(&arena);
}

static void time_is_that_to_whoever_or_whatever_is_met_first(void **state)
{
    (void)state;
    ff_seen me = {.position = {0.0, 0.0}, .velocity = {1.0, 0.0}, .radius = 0.3};
    ff_neighbour neighbours[2] = {{.time = 3.0}, {.time = INFINITY}};
    ff_wall ahead = ff_wall_between(ff_v2(1.3, -1.0), ff_v2(1.3, 1.0));
    ff_wall beside = ff_wall_between(ff_v2(-5.0, 1.0), ff_v2(5.0, 1.0));
    const ff_wall *walls[2] = {&beside, &ahead};
    assert_true(isinf(ff_choice_time(&me, neighbours, 0, walls, 1)));
    FF_ASSERT_NEAR(ff_choice_time(&me, neighbours, 2, walls, 1), 3.0, 0.0);
    FF_ASSERT_NEAR(ff_choice_time(&me, neighbours, 2, walls, 2), 1.0, 1e-9);
}

/* ---------------------------------------------------------------------------------------------- in a crowd */

/* People who meet in the middle, some of them in a hurry. */
static ff_crowd *meeting(ff_synthesis synthesis, uint32_t threads)
{
    ff_error error;
    ff_crowd *crowd;
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = 24;
    def.threads = threads;
    def.synthesis = synthesis;
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &crowd, &error), error);
    for (int i = 0; i < 24; ++i) {
        ff_agent agent;
        ff_agent_def person = ff_agent_def_default();
        double angle = FF_TAU * i / 24.0;
        person.position = ff_scale2(ff_fwd2(angle), 6.0);
        person.goal = ff_scale2(person.position, -1.0);
        person.heading = angle + FF_PI;
        if (i % 6 == 0) person.preferred_speed = 3.0;
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &person, &agent, &error), error);
    }
    return crowd;
}

static void counts_tell_what_everybody_did(void **state)
{
    (void)state;
    static const ff_synthesis kinds[] = {FF_SYNTHESIS_BLENDING, FF_SYNTHESIS_SEMI_PROCEDURAL,
                                         FF_SYNTHESIS_HYBRID};
    for (int k = 0; k < 3; ++k) {
        ff_error error;
        ff_crowd *crowd = meeting(kinds[k], 1);
        for (int i = 0; i < 300; ++i)
            ff_crowd_step(crowd);
        ff_synthesis_counts all, one, sum = {0};
        ff_agent agents[24];
        FF_ASSERT_OK(ff_crowd_synthesis_counts(crowd, (ff_agent){0, 0}, &all, &error), error);
        uint32_t count = ff_crowd_agents(crowd, agents, 24);
        for (uint32_t i = 0; i < count; ++i) {
            FF_ASSERT_OK(ff_crowd_synthesis_counts(crowd, agents[i], &one, &error), error);
            FF_ASSERT_NEAR(one.blending_s + one.semi_procedural_s + one.running_s, 10.0, 1e-6);
            sum.transitions += one.transitions;
            sum.running_s += one.running_s;
        }
        FF_ASSERT_NEAR(all.blending_s + all.semi_procedural_s + all.running_s, 240.0, 1e-6);
        assert_int_equal(all.transitions, sum.transitions);
        FF_ASSERT_NEAR(all.running_s, sum.running_s, 1e-9);
        assert_true(all.urgent <= all.transitions);
        assert_true(all.running_s > 2.0);
        if (kinds[k] == FF_SYNTHESIS_BLENDING) FF_ASSERT_NEAR(all.semi_procedural_s, 0.0, 0.0);
        if (kinds[k] == FF_SYNTHESIS_SEMI_PROCEDURAL) FF_ASSERT_BELOW(all.blending_s, 3.0);
        if (kinds[k] == FF_SYNTHESIS_HYBRID)
            assert_true(all.blending_s > 20.0 && all.semi_procedural_s > 20.0);
        assert_int_equal(ff_crowd_synthesis_counts(crowd, (ff_agent){99, 1}, &one, &error), FF_ERR_ARGUMENT);
        assert_int_equal(ff_crowd_synthesis_counts(crowd, (ff_agent){0, 0}, NULL, &error), FF_ERR_ARGUMENT);
        ff_crowd_destroy(crowd);
    }
}

static void any_number_of_threads_walks_and_runs_alike(void **state)
{
    (void)state;
    uint64_t hash = 0;
    static const uint32_t threads[] = {1, 2, 8};
    for (int k = 0; k < 3; ++k) {
        ff_crowd *crowd = meeting(FF_SYNTHESIS_HYBRID, threads[k]);
        for (int i = 0; i < 400; ++i)
            ff_crowd_step(crowd);
        if (k == 0) hash = ff_crowd_state_hash(crowd);
        assert_true(hash == ff_crowd_state_hash(crowd));
        ff_crowd_destroy(crowd);
    }
}

static void a_wrong_method_is_refused(void **state)
{
    (void)state;
    ff_error error;
    ff_crowd *crowd;
    ff_crowd_def def = ff_crowd_def_default();
    def.synthesis = (ff_synthesis)9;
    assert_int_equal(ff_crowd_create(pack, &def, &crowd, &error), FF_ERR_RANGE);
    assert_non_null(strstr(error.message, "synthesis is 9"));
    crowd = meeting(FF_SYNTHESIS_HYBRID, 1);
    ff_agent agent;
    ff_agent_def person = ff_agent_def_default();
    person.synthesis = (ff_synthesis)-1;
    assert_int_equal(ff_crowd_add_agent(crowd, &person, &agent, &error), FF_ERR_RANGE);
    person = ff_agent_def_default();
    person.preferred_speed = 4.1;
    assert_int_equal(ff_crowd_add_agent(crowd, &person, &agent, &error), FF_ERR_RANGE);
    ff_crowd_destroy(crowd);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(in_the_open_examples_are_blended_and_near_a_collision_they_are_not),
        cmocka_unit_test(back_to_blending_takes_a_margin_and_a_while),
        cmocka_unit_test(nobody_changes_twice_at_once_unless_he_must),
        cmocka_unit_test(who_is_told_how_to_walk_walks_so_whatever_happens),
        cmocka_unit_test(who_hurries_runs_where_there_is_room_ahead),
        cmocka_unit_test(density_is_that_of_people_spread_evenly),
        cmocka_unit_test(time_is_that_to_whoever_or_whatever_is_met_first),
        cmocka_unit_test(counts_tell_what_everybody_did),
        cmocka_unit_test(any_number_of_threads_walks_and_runs_alike),
        cmocka_unit_test(a_wrong_method_is_refused),
    };
    return cmocka_run_group_tests(tests, open_pack, close_pack);
}
