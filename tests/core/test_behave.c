/* The parts of behaviour by themselves: places, amounts, conditions, goals, and what a definition may not say. */
#include "runtime/core/behave/behave.h"
#include "tests/check.h"
#include "tests/core/behave_fair.h"

#include <stdio.h>

/* ------------------------------------------------------------------------------------- places and amounts */

static void points_of_a_region_lie_in_it_and_fill_it_evenly(void **state)
{
    (void)state;
    const ff_region regions[3] = {{FF_REGION_POINT, 0, {3, -2}, {0, 0}, 0},
                                  {FF_REGION_CIRCLE, 0, {3, -2}, {1.5, 0}, 0},
                                  {FF_REGION_BOX, 0, {3, -2}, {2, 0.5}, 0.7}};
    for (int k = 0; k < 3; ++k) {
        ff_random random = {4, (uint64_t)k, 0};
        ff_vec2 sum = {0, 0};
        double far_out = 0.0;
        enum { DRAWS = 4000 };
        for (int i = 0; i < DRAWS; ++i) {
            ff_vec2 p = ff_region_point(&regions[k], 0.0, &random);
            FF_ASSERT_BELOW(ff_region_distance(&regions[k], p), 1e-12);
            sum = ff_add2(sum, ff_sub2(p, regions[k].centre));
            far_out += ff_length2(ff_sub2(p, regions[k].centre)) > 1.5 / sqrt(2.0);
            ff_vec2 inner = ff_region_point(&regions[k], 0.3, &random);
            if (k == 1) FF_ASSERT_BELOW(ff_length2(ff_sub2(inner, regions[k].centre)), 1.2);
        }
        FF_ASSERT_BELOW(ff_length2(ff_scale2(sum, 1.0 / DRAWS)), 0.06);
        if (k == 1) FF_ASSERT_NEAR(far_out / DRAWS, 0.5, 0.03); /* half the area of a disc */
    }
    /* The corner of a turned box, by hand: 2 ahead and 0.5 to the left. */
    ff_vec2 corner = ff_add2(regions[2].centre, ff_from_frame2(ff_fwd2(0.7), ff_v2(2.0, 0.5)));
    ff_vec2 out = ff_add2(corner, ff_from_frame2(ff_fwd2(0.7), ff_v2(0.3, 0.4)));
    FF_ASSERT_NEAR(ff_region_distance(&regions[2], out), 0.5, 1e-12);
    FF_ASSERT_NEAR(ff_region_distance(&regions[1], ff_v2(3, 1)), 1.5, 1e-12);
    FF_ASSERT_NEAR(ff_region_distance(&regions[0], ff_v2(0, 2)), 5.0, 1e-12);
}

static void amounts_keep_their_range_and_mean(void **state)
{
    (void)state;
    const ff_amount amounts[4] = {{FF_AMOUNT_CONST, 0, 2.0, 0.0},
                                  {FF_AMOUNT_UNIFORM, 0, 1.0, 4.0},
                                  {FF_AMOUNT_NORMAL, 0, 3.0, 0.5},
                                  {FF_AMOUNT_NORMAL, 0, 0.1, 1.0}};
    const double low[4] = {2.0, 1.0, 2.0, 0.0}, high[4] = {2.0, 4.0, 4.0, 2.1}, mean[3] = {2.0, 2.5, 3.0};
    for (int k = 0; k < 4; ++k) {
        ff_random random = {9, (uint64_t)k, 0};
        double sum = 0.0;
        for (int i = 0; i < 4000; ++i) {
            double value = ff_amount_draw(&amounts[k], &random);
            assert_true(value >= low[k] && value <= high[k]);
            sum += value;
        }
        if (k < 3) FF_ASSERT_NEAR(sum / 4000.0, mean[k], 0.04);
    }
}

/* --------------------------------------------------------------------------------------------- conditions */

#define AMOUNT(value)                                                                                        \
    {                                                                                                        \
        FF_AMOUNT_CONST, 0, value, 0.0                                                                       \
    }

/* A machine of one state with one transition for each of the conditions that are roots. */
typedef struct one_state {
    ff_condition_def conditions[8];
    ff_transition_def transitions[8];
    ff_region_def region;
    ff_behaviour_def def;
} one_state;

static const ff_machine_def lone_machine = {"machine", 0, 0};
static const ff_target_def lone_target = {0, 0, 1.0};
static ff_state_def lone_state = {
    .name = "State", .motion = FF_MOTION_STAND, .choice = FF_CHOOSE_IDENTITY, .speed = 1.0};

static ff_behaviour *with_conditions(one_state *one, uint32_t count, uint32_t roots)
{
    lone_state.transition_count = roots;
    for (uint32_t i = 0; i < roots; ++i)
        one->transitions[i] = (ff_transition_def){i, 0, 1, 0};
    snprintf(one->region.name, sizeof one->region.name, "yard");
    one->region.place = (ff_region){FF_REGION_CIRCLE, 0, {0, 0}, {2, 0}, 0};
    one->def = (ff_behaviour_def){.machines = &lone_machine,
                                  .machine_count = 1,
                                  .states = &lone_state,
                                  .state_count = 1,
                                  .transitions = one->transitions,
                                  .transition_count = roots,
                                  .targets = &lone_target,
                                  .target_count = 1,
                                  .conditions = one->conditions,
                                  .condition_count = count,
                                  .regions = &one->region,
                                  .region_count = 1,
                                  .signals = fair_signals,
                                  .signal_count = 1,
                                  .phases = fair_phases,
                                  .phase_count = 2,
                                  .variables = fair_variables,
                                  .variable_count = 1};
    ff_error error;
    ff_behaviour *behaviour;
    FF_ASSERT_OK(ff_behaviour_create(&one->def, &behaviour, &error), error);
    return behaviour;
}

static ff_conduct conduct_of(uint64_t key)
{
    return (ff_conduct){
        .key = key, .state = 0, .goal = FF_NONE, .set = FF_NONE, .last = FF_NONE, .speed = 1.3, .entries = 1};
}

static bool first_holds(const ff_behaviour *behaviour, const ff_conduct *conduct, uint64_t step,
                        ff_vec2 position)
{
    ff_behave_view view = {behaviour, conduct, step, 0.1, position, 0.7, 0.3, false};
    return ff_behave_find(&view, 0) == 0;
}

static void a_timer_ends_once_at_a_time_of_its_range_that_each_agent_draws_anew_in_each_state(void **state)
{
    (void)state;
    one_state one = {.conditions = {{.kind = FF_IF_TIMER, .amount = {FF_AMOUNT_UNIFORM, 0, 2.0, 4.0}}}};
    ff_behaviour *behaviour = with_conditions(&one, 1, 1);
    double sum = 0.0, last = -1.0;
    int same = 0;
    for (uint64_t key = 0; key < 400; ++key) {
        ff_conduct conduct = conduct_of(ff_mix64(key / 2));
        conduct.entries = 1 + key % 2;
        conduct.entered = 50;
        uint64_t step = 50;
        while (!first_holds(behaviour, &conduct, step, ff_v2(0, 0)))
            assert_true(++step < 200);
        assert_true(first_holds(behaviour, &conduct, step + 1, ff_v2(0, 0)));
        double seconds = (double)(step - 50) * 0.1;
        assert_true(seconds >= 2.0 - 1e-9 && seconds <= 4.0 + 1e-9);
        same += seconds == last;
        last = seconds;
        sum += seconds;
    }
    FF_ASSERT_NEAR(sum / 400.0, 3.0, 0.12);
    assert_true(same < 60);
    ff_behaviour_destroy(behaviour);
}

static void a_chance_comes_as_often_as_it_says_whatever_the_step(void **state)
{
    (void)state;
    one_state one = {.conditions = {{.kind = FF_IF_CHANCE, .amount = AMOUNT(0.5)}}};
    ff_behaviour *behaviour = with_conditions(&one, 1, 1);
    ff_conduct conduct = conduct_of(77);
    for (int k = 0; k < 2; ++k) {
        double dt = k == 0 ? 0.1 : 0.02;
        int came = 0;
        for (uint64_t step = 0; step < (uint64_t)(2000.0 / dt); ++step) {
            ff_behave_view view = {behaviour, &conduct, step, dt, {0, 0}, 0.0, 0.3, false};
            came += ff_behave_find(&view, 0) == 0;
        }
        FF_ASSERT_NEAR(came / 2000.0, 0.5, 0.05);
    }
    ff_behaviour_destroy(behaviour);
}

static void conditions_combine_and_the_first_that_holds_counts(void **state)
{
    (void)state;
    /* 0: all of (inside, speed > 0.5); 1: not (any of (red, seen < 3)); then their parts. */
    one_state one = {
        .conditions = {{.kind = FF_IF_ALL, .first = 2, .count = 2},
                       {.kind = FF_IF_NOT, .first = 4, .count = 1},
                       {.kind = FF_IF_INSIDE},
                       {.kind = FF_IF_MORE, .index = FF_PROPERTY_SPEED, .amount = AMOUNT(0.5)},
                       {.kind = FF_IF_ANY, .first = 5, .count = 2},
                       {.kind = FF_IF_SIGNAL, .index = 0, .value = 0},
                       {.kind = FF_IF_LESS, .index = FF_PROPERTY_VARIABLE, .amount = AMOUNT(3.0)}}};
    ff_behaviour *behaviour = with_conditions(&one, 7, 2);
    for (int k = 0; k < 16; ++k) {
        bool inside = k & 1, fast = k & 2, green = k & 4, seen = k & 8;
        ff_conduct conduct = conduct_of(3);
        conduct.variable[0] = seen ? 3.0 : 2.0;
        ff_behave_view view = {.behaviour = behaviour,
                               .conduct = &conduct,
                               .step = green ? 45 : 20,
                               .dt = 0.1,
                               .position = ff_v2(inside ? 1.9 : 2.1, 0),
                               .speed = fast ? 0.7 : 0.3};
        uint32_t expected = inside && fast ? 0 : (green && seen ? 1 : FF_NONE);
        assert_int_equal(ff_behave_find(&view, 0), expected);
        assert_int_equal(ff_behave_find(&view, 1), green && seen ? 1 : FF_NONE);
    }
    ff_behaviour_destroy(behaviour);
}

static void a_signal_shows_its_phases_in_turn(void **state)
{
    (void)state;
    one_state one = {.conditions = {{.kind = FF_IF_ALWAYS}}};
    ff_behaviour *behaviour = with_conditions(&one, 1, 1);
    for (int i = 0; i < 600; ++i) { /* red for 4 s, green for 2 */
        double time = 0.05 + 0.1 * i, within = time - 6.0 * floor(time / 6.0);
        assert_int_equal(ff_behave_phase(behaviour, 0, time), within < 4.0 ? 0 : 1);
    }
    behaviour->shown[0] = 1;
    assert_int_equal(ff_behave_phase(behaviour, 0, 0.0), 1);
    ff_behaviour_destroy(behaviour);
}

static void what_is_asked_of_an_agent_is_what_it_has(void **state)
{
    (void)state;
    ff_behaviour_def def = fair_behaviour();
    ff_error error;
    ff_behaviour *behaviour;
    FF_ASSERT_OK(ff_behaviour_create(&def, &behaviour, &error), error);
    ff_conduct conduct = conduct_of(1);
    conduct.place = ff_v2(3, 4);
    conduct.born = 5;
    conduct.entered = 10;
    conduct.variable[0] = 6.5;
    ff_behave_view view = {behaviour, &conduct, 30, 0.1, {0, 0}, 0.7, 0.3, false};
    FF_ASSERT_NEAR(ff_behave_property(&view, FF_PROPERTY_SPEED), 0.7, 0);
    FF_ASSERT_NEAR(ff_behave_property(&view, FF_PROPERTY_RADIUS), 0.3, 0);
    FF_ASSERT_NEAR(ff_behave_property(&view, FF_PROPERTY_GOAL_DISTANCE), 5.0, 1e-12);
    FF_ASSERT_NEAR(ff_behave_property(&view, FF_PROPERTY_GOAL_NUMBER), -1.0, 0);
    conduct.goal = 2, conduct.set = 0;
    FF_ASSERT_NEAR(ff_behave_property(&view, FF_PROPERTY_GOAL_NUMBER), 2.0, 0);
    FF_ASSERT_NEAR(ff_behave_property(&view, FF_PROPERTY_STATE_TIME), 2.0, 1e-12);
    FF_ASSERT_NEAR(ff_behave_property(&view, FF_PROPERTY_AGE), 2.5, 1e-12);
    FF_ASSERT_NEAR(ff_behave_property(&view, FF_PROPERTY_PREFERRED_SPEED), 1.3, 0);
    FF_ASSERT_NEAR(ff_behave_property(&view, FF_PROPERTY_VARIABLE), 6.5, 0);
    ff_behaviour_destroy(behaviour);
}

/* --------------------------------------------------------------------------------------------------- goals */

static ff_state_def choosing(uint32_t choice)
{
    return (ff_state_def){.name = "S", .choice = choice, .from = 0, .speed = 1.0, .offset = {1, 2}};
}

static void each_way_of_choosing_takes_the_goal_it_says(void **state)
{
    (void)state;
    ff_behaviour_def def = fair_behaviour();
    ff_error error;
    ff_behaviour *behaviour;
    FF_ASSERT_OK(ff_behaviour_create(&def, &behaviour, &error), error);
    ff_conduct conduct = conduct_of(5);
    ff_pick pick;
    ff_vec2 here = ff_v2(3, 1);
    ff_state_def s = choosing(FF_CHOOSE_NEAREST);
    assert_true(ff_behave_choose(behaviour, &s, here, &conduct, &pick));
    assert_int_equal(pick.goal, 0);
    s = choosing(FF_CHOOSE_FARTHEST);
    assert_true(ff_behave_choose(behaviour, &s, here, &conduct, &pick));
    assert_int_equal(pick.goal, 1);
    s = choosing(FF_CHOOSE_EXPLICIT);
    s.from = FAIR_EXIT;
    assert_true(ff_behave_choose(behaviour, &s, here, &conduct, &pick));
    assert_int_equal(pick.goal, FAIR_EXIT);
    assert_int_equal(pick.set, 1);
    s = choosing(FF_CHOOSE_NEXT);
    for (uint32_t i = 0; i < 6; ++i) {
        assert_true(ff_behave_choose(behaviour, &s, here, &conduct, &pick));
        assert_int_equal(pick.goal, i % FAIR_BOOTHS);
        conduct.last = pick.goal;
    }
    const struct {
        uint32_t choice;
        ff_vec2 place;
    } places[3] = {{FF_CHOOSE_MIRROR, {-3, -1}}, {FF_CHOOSE_OFFSET, {4, 3}}, {FF_CHOOSE_IDENTITY, {3, 1}}};
    for (int k = 0; k < 3; ++k) {
        s = choosing(places[k].choice);
        assert_true(ff_behave_choose(behaviour, &s, here, &conduct, &pick));
        assert_int_equal(pick.goal, FF_NONE);
        FF_ASSERT_NEAR(ff_length2(ff_sub2(pick.place, places[k].place)), 0.0, 0.0);
    }
    conduct.goal = 3, conduct.set = 0;
    s = choosing(FF_CHOOSE_SHARED);
    assert_true(ff_behave_choose(behaviour, &s, here, &conduct, &pick));
    assert_int_equal(pick.goal, 3);
    ff_behaviour_destroy(behaviour);
}

static void random_goals_come_as_often_as_their_weights_and_never_when_full_or_last(void **state)
{
    (void)state;
    ff_behaviour_def def = fair_behaviour();
    ff_error error;
    ff_behaviour *behaviour;
    FF_ASSERT_OK(ff_behaviour_create(&def, &behaviour, &error), error);
    enum { DRAWS = 8000 };
    for (int k = 0; k < 4; ++k) {
        ff_state_def s = choosing(k % 2 ? FF_CHOOSE_WEIGHTED : FF_CHOOSE_RANDOM);
        s.not_last = 1;
        ff_conduct conduct = conduct_of(21);
        if (k >= 2) conduct.last = 0, behaviour->taken[3] = 2;
        int came[FAIR_BOOTHS] = {0};
        ff_pick pick;
        for (int i = 0; i < DRAWS; ++i) {
            assert_true(ff_behave_choose(behaviour, &s, ff_v2(0, 0), &conduct, &pick));
            ++came[pick.goal];
        }
        /* Weights 1, 1, 2, 1; with 0 and 3 barred 1, 2. */
        static const double share[4][FAIR_BOOTHS] = {
            {0.25, 0.25, 0.25, 0.25}, {0.2, 0.2, 0.4, 0.2}, {0, 0.5, 0.5, 0}, {0, 1.0 / 3, 2.0 / 3, 0}};
        for (int g = 0; g < FAIR_BOOTHS; ++g)
            FF_ASSERT_NEAR((double)came[g] / DRAWS, share[k][g], share[k][g] > 0 ? 0.02 : 0.0);
    }
    ff_pick pick;
    for (int choice = FF_CHOOSE_RANDOM; choice <= FF_CHOOSE_NEXT; ++choice) {
        ff_state_def s = choosing((uint32_t)choice);
        ff_conduct conduct = conduct_of(2);
        for (int g = 0; g < FAIR_BOOTHS; ++g)
            behaviour->taken[g] = 2;
        assert_false(ff_behave_choose(behaviour, &s, ff_v2(0, 0), &conduct, &pick));
        conduct.goal = conduct.last = 1; /* its own place is free for itself */
        assert_true(ff_behave_choose(behaviour, &s, ff_v2(0, 0), &conduct, &pick));
        assert_int_equal(pick.goal, 1);
        s.not_last = 1;
        assert_false(ff_behave_choose(behaviour, &s, ff_v2(0, 0), &conduct, &pick));
    }
    ff_behaviour_destroy(behaviour);
}

/* ---------------------------------------------------------------------------------------- bad definitions */

/* One member of a record of the fair set to a value that must be refused, with the array named. */
typedef struct bad_member {
    const char *section;
    uint32_t index;
    size_t offset, size;
    uint64_t value;
} bad_member;

#define NOT_A_NUMBER 0x7ff8000000000000u
#define BELOW_0 0xbff0000000000000u
#define REAL(type, member, bits) offsetof(type, member), 8, bits
#define WORD(type, member, value) offsetof(type, member), 4, value

static const bad_member bad_members[] = {
    {"BMAC", 0, offsetof(ff_machine_def, name), 1, 0},
    {"BMAC", 0, WORD(ff_machine_def, start, FAIR_STATES)},
    {"BSTA", 1, offsetof(ff_state_def, name), 1, 0},
    {"BSTA", 0, WORD(ff_state_def, choice, 99)},
    {"BSTA", 0, WORD(ff_state_def, from, 2)},
    {"BSTA", 0, WORD(ff_state_def, not_last, 2)},
    {"BSTA", 0, WORD(ff_state_def, motion, 2)},
    {"BSTA", 0, WORD(ff_state_def, face, 4)},
    {"BSTA", 1, WORD(ff_state_def, enter_count, 2)},
    {"BSTA", 1, WORD(ff_state_def, first_exit, UINT32_MAX)},
    {"BSTA", 0, WORD(ff_state_def, transition_count, 5)},
    {"BSTA", 0, REAL(ff_state_def, speed, NOT_A_NUMBER)},
    {"BSTA", 0, REAL(ff_state_def, offset, NOT_A_NUMBER)},
    {"BTRA", 3, WORD(ff_transition_def, condition, 6)},
    {"BTRA", 3, WORD(ff_transition_def, condition, 0)},
    {"BTRA", 2, WORD(ff_transition_def, target_count, 0)},
    {"BTRA", 2, WORD(ff_transition_def, first_target, 4)},
    {"BTGT", 4, WORD(ff_target_def, state, FAIR_STATES)},
    {"BTGT", 3, REAL(ff_target_def, weight, BELOW_0)},
    {"BCON", 0, WORD(ff_condition_def, kind, FF_IF_NOT + 1)},
    {"BCON", 0, REAL(ff_condition_def, amount.a, 0)},
    {"BCON", 1, WORD(ff_condition_def, first, 1)},
    {"BCON", 1, WORD(ff_condition_def, first, 3)},
    {"BCON", 1, WORD(ff_condition_def, count, 0)},
    {"BCON", 1, WORD(ff_condition_def, count, UINT32_MAX)},
    {"BCON", 2, REAL(ff_condition_def, amount.b, BELOW_0)},
    {"BCON", 3, WORD(ff_condition_def, index, FF_PROPERTY_VARIABLE + 1)},
    {"BCON", 5, WORD(ff_condition_def, index, 1)},
    {"BCON", 5, WORD(ff_condition_def, value, 2)},
    {"BACT", 0, WORD(ff_act_def, kind, 3)},
    {"BACT", 0, WORD(ff_act_def, property, FF_PROPERTY_SPEED)},
    {"BACT", 0, REAL(ff_act_def, amount.a, NOT_A_NUMBER)},
    {"BSET", 0, WORD(ff_goal_set_def, goal_count, FAIR_GOALS + 1)},
    {"BSET", 1, WORD(ff_goal_set_def, goal_count, 0)},
    {"BSET", 1, WORD(ff_goal_set_def, exit, 2)},
    {"BGOA", 2, WORD(ff_goal_def, place.shape, 3)},
    {"BGOA", 2, REAL(ff_goal_def, place.half.a, BELOW_0)},
    {"BGOA", 2, REAL(ff_goal_def, look_at.b, NOT_A_NUMBER)},
    {"BGOA", 2, REAL(ff_goal_def, weight, 0)},
    {"BSIG", 0, WORD(ff_signal_def, phase_count, 3)},
    {"BSIG", 0, REAL(ff_signal_def, passed, BELOW_0)},
    {"BPHA", 1, REAL(ff_phase_def, seconds, 0)},
    {"BVAR", 0, REAL(ff_variable_def, start, NOT_A_NUMBER)},
    {"BSPW", 0, WORD(ff_spawner_def, machine, 1)},
    {"BSPW", 0, WORD(ff_spawner_def, regular, 2)},
    {"BSPW", 0, REAL(ff_spawner_def, rate, BELOW_0)},
    {"BSPW", 0, REAL(ff_spawner_def, heading, NOT_A_NUMBER)},
    {"BSPW", 0, REAL(ff_spawner_def, radius.a, 0)},
};

static void everything_that_cannot_be_is_refused_in_its_own_array(void **state)
{
    (void)state;
    ff_error error;
    for (size_t i = 0; i < sizeof bad_members / sizeof bad_members[0]; ++i) {
        const bad_member *bad = &bad_members[i];
        ff_behaviour_def def = fair_behaviour();
        FF_ASSERT_OK(ff_behaviour_check(&def, &error), error);
        unsigned char copy[8192];
        for (int k = 0; k < FF_BEHAVIOUR_ARRAYS; ++k) {
            const ff_behaviour_array *array = &ff_behaviour_arrays[k];
            if (strcmp(array->name, bad->section) != 0) continue;
            uint32_t count = ff_behaviour_array_count(&def, array);
            assert_true(count * array->size <= sizeof copy);
            memcpy(copy, ff_behaviour_array_data(&def, array), count * array->size);
            memcpy(copy + bad->index * array->size + bad->offset, &bad->value, bad->size);
            ff_behaviour_array_set(&def, array, copy, count);
        }
        if (ff_behaviour_check(&def, &error) == FF_OK) {
            print_error("bad member %zu (%s) was accepted\n", i, bad->section);
            fail();
        }
        assert_string_equal(error.section, bad->section);
    }
    ff_behaviour_def def = fair_behaviour();
    def.goals = NULL;
    assert_int_equal(ff_behaviour_check(&def, &error), FF_ERR_RANGE);
    def = fair_behaviour();
    def.state_count = 1u << 20;
    assert_int_equal(ff_behaviour_check(&def, &error), FF_ERR_RANGE);
    def = fair_behaviour();
    def.variable_count = FF_VARIABLES + 1;
    assert_int_not_equal(ff_behaviour_check(&def, &error), FF_OK);
    assert_int_equal(ff_behaviour_check(NULL, &error), FF_ERR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_of_a_region_lie_in_it_and_fill_it_evenly),
        cmocka_unit_test(amounts_keep_their_range_and_mean),
        cmocka_unit_test(a_timer_ends_once_at_a_time_of_its_range_that_each_agent_draws_anew_in_each_state),
        cmocka_unit_test(a_chance_comes_as_often_as_it_says_whatever_the_step),
        cmocka_unit_test(conditions_combine_and_the_first_that_holds_counts),
        cmocka_unit_test(a_signal_shows_its_phases_in_turn),
        cmocka_unit_test(what_is_asked_of_an_agent_is_what_it_has),
        cmocka_unit_test(each_way_of_choosing_takes_the_goal_it_says),
        cmocka_unit_test(random_goals_come_as_often_as_their_weights_and_never_when_full_or_last),
        cmocka_unit_test(everything_that_cannot_be_is_refused_in_its_own_array),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
