/* Crowds with behaviour: what happens at a small fair (behave_fair.h), and the same to the bit however it is stepped. */
#include "tests/check.h"
#include "tests/core/behave_fair.h"
#include "tests/core/crowd_ask.h"
#include "tests/core/walker_open.h"

#include "runtime/core/behave/behave.h"

/* A crowd at the fair, with some who are there from the start. */
static ff_crowd *fair_crowd(uint32_t threads, uint32_t there)
{
    ff_error error;
    ff_crowd *crowd;
    ff_behaviour_def behaviour = fair_behaviour();
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = 24;
    def.threads = threads;
    def.behaviour = &behaviour;
    FF_ASSERT_OK(ff_crowd_create(walker.pack, &def, &crowd, &error), error);
    for (uint32_t i = 0; i < there; ++i) {
        ff_agent agent;
        ff_agent_def one = ff_agent_def_default();
        one.position = one.goal = ff_v2(-1.5 + 1.0 * (double)i, 0.0);
        one.machine = FAIR_VISITOR;
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &one, &agent, &error), error);
    }
    return crowd;
}

static ff_agent_behaviour behaviour_of(const ff_crowd *crowd, ff_agent agent)
{
    ff_error error;
    ff_agent_behaviour b;
    FF_ASSERT_OK(ff_crowd_agent_behaviour(crowd, agent, &b, &error), error);
    return b;
}

static double angle_to(const ff_agent_state *s, ff_vec2 point)
{
    ff_vec2 way = ff_sub2(point, s->position);
    return fabs(ff_wrap(ff_atan2(way.b, way.a) - s->heading));
}

enum { MOST = 24, NUMBERS = 400 };

/* What is seen of one visitor, by number. */
typedef struct visitor {
    uint32_t state, goal, looks;
    double since;      /* s, at which it entered its state */
    double worst_look; /* rad, off its booth after 3.9 s of looking */
    bool seen;
    bool kept; /* in its state by booths that were all full */
} visitor;

static void the_fair_goes_as_its_machine_says(void **state)
{
    (void)state;
    static visitor all[NUMBERS];
    memset(all, 0, sizeof all);
    ff_crowd *crowd = fair_crowd(1, 3);
    ff_error error;
    int looks = 0, gone_on_red = 0;
    for (int step = 0; step < 30 * 180; ++step) {
        ff_crowd_step(crowd);
        FF_ASSERT_OK(ff_crowd_fault(crowd, &error), error);
        double time = (double)ff_crowd_step_count(crowd) * ff_crowd_def_default().step;
        ff_agent agents[MOST];
        uint32_t count = ff_crowd_agents(crowd, agents, MOST), taken[FAIR_GOALS] = {0}, own = 0, full = 0;
        for (uint32_t i = 0; i < count; ++i) {
            ff_agent_behaviour b = behaviour_of(crowd, agents[i]);
            ff_agent_state s = state_of(crowd, agents[i]);
            assert_true(s.number < NUMBERS && b.state < FAIR_STATES && b.machine == FAIR_VISITOR);
            visitor *v = &all[s.number];
            own += b.spawner == 0;
            if (b.goal != FF_NONE) ++taken[b.goal];
            if (!v->seen || b.state != v->state) {
                if (v->seen && v->state == FAIR_LOOK) {
                    double looked = time - v->since;
                    assert_true(looked > FAIR_LOOK_LEAST - 0.04);
                    if (!v->kept) FF_ASSERT_BELOW(looked, FAIR_LOOK_MOST + 0.04);
                    ++looks;
                    ++v->looks;
                }
                if (v->seen && v->state == FAIR_WALK) {
                    assert_int_equal(b.state, FAIR_LOOK);
                    assert_int_equal(b.goal, v->goal);
                }
                if (v->seen && b.state == FAIR_WALK)
                    assert_int_not_equal(b.goal, v->goal); /* not the last one */
                /* The transition was seen at the step's start. */
                double within = time - 1.0 / 30.0 - 6.0 * floor((time - 1.0 / 30.0) / 6.0);
                if (v->seen && b.state == FAIR_GO) gone_on_red += within < 4.0 - 1e-6;
                v->since = time;
                v->seen = true;
                v->kept = false;
            }
            v->state = b.state;
            v->goal = b.goal;
            if (b.state == FAIR_LOOK && b.seconds > 3.9)
                v->worst_look = ff_max(v->worst_look, angle_to(&s, fair_goals[b.goal].look_at));
        }
        for (uint32_t g = 0; g < FAIR_GOALS; ++g) {
            assert_int_equal(taken[g], ff_crowd_goal_taken(crowd, g));
            if (g < FAIR_BOOTHS) assert_true(taken[g] <= fair_goals[g].capacity);
            full += g < FAIR_BOOTHS && taken[g] == fair_goals[g].capacity;
        }
        if (full >= FAIR_BOOTHS - 1)
            for (uint32_t n = 0; n < NUMBERS; ++n)
                all[n].kept = true;
        assert_true(own <= fair_spawners[0].most);
        ff_crowd_counts counts = ff_crowd_count(crowd);
        assert_true(counts.added == counts.spawned + 3 && counts.added == counts.left + count);
    }
    ff_crowd_counts counts = ff_crowd_count(crowd);
    assert_true(counts.left >= 15 && looks >= 60 && gone_on_red == 0);
    double worst = 0.0;
    int looked = 0;
    for (int n = 0; n < NUMBERS; ++n) {
        if (!all[n].seen || !all[n].looks) continue;
        worst = ff_max(worst, all[n].worst_look);
        ++looked;
    }
    assert_true(looked > 15);
    FF_ASSERT_BELOW(worst, 0.3);
    ff_crowd_destroy(crowd);
}

static ff_crowd *reloaded(ff_crowd *crowd, uint32_t threads)
{
    ff_error error;
    size_t size = ff_crowd_save_size(crowd);
    void *data = malloc(size);
    assert_non_null(data);
    FF_ASSERT_OK(ff_crowd_save(crowd, data, size, &error), error);
    ff_crowd_destroy(crowd);
    ff_crowd_def run = ff_crowd_def_default();
    run.threads = threads;
    ff_crowd *loaded;
    FF_ASSERT_OK(ff_crowd_load(walker.pack, data, size, &run, &loaded, &error), error);
    free(data);
    return loaded;
}

static uint64_t fair_hash(uint32_t threads, int steps, int stop)
{
    ff_error error;
    ff_crowd *crowd = fair_crowd(threads, 2);
    for (int step = 0; step < steps; ++step) {
        if (step == 200) FF_ASSERT_OK(ff_crowd_set_signal(crowd, 0, 0, &error), error);
        if (step == 500) FF_ASSERT_OK(ff_crowd_set_signal(crowd, 0, FF_NONE, &error), error);
        if (stop && step % stop == stop - 1) crowd = reloaded(crowd, threads);
        ff_crowd_step(crowd);
    }
    uint64_t hash = ff_crowd_state_hash(crowd);
    ff_crowd_counts counts = ff_crowd_count(crowd);
    hash ^= ff_mix64(counts.added + (counts.left << 20) + (counts.spawned << 40));
    for (uint32_t g = 0; g < FAIR_GOALS; ++g)
        hash ^= ff_mix64(1000 + 10 * g + ff_crowd_goal_taken(crowd, g));
    ff_crowd_destroy(crowd);
    return hash;
}

static void threads_saving_and_loading_change_no_bit(void **state)
{
    (void)state;
    uint64_t once = fair_hash(1, 1500, 0);
    assert_true(once == fair_hash(2, 1500, 0));
    assert_true(once == fair_hash(8, 1500, 0));
    assert_true(once == fair_hash(1, 1500, 331));
    assert_true(once == fair_hash(2, 1500, 47));
    assert_true(once != fair_hash(1, 1499, 0));
}

/* ------------------------------------------------------------------------------------ machines of two states */

static const ff_condition_def always = {.kind = FF_IF_ALWAYS};

/* Two states that lead to each other. */
typedef struct pair {
    ff_machine_def machine;
    ff_state_def states[2];
    ff_transition_def transitions[2];
    ff_target_def targets[2];
    ff_condition_def conditions[2];
    ff_goal_def goals[2];
    ff_goal_set_def set;
    ff_behaviour_def def;
} pair;

static void make_pair(pair *p, ff_condition_def first, ff_condition_def second)
{
    *p = (pair){
        .machine = {"pair", 0, 0},
        .states =
            {{.name = "One", .choice = FF_CHOOSE_EXPLICIT, .from = 0, .transition_count = 1, .speed = 1.0},
             {.name = "Two",
              .choice = FF_CHOOSE_EXPLICIT,
              .from = 1,
              .first_transition = 1,
              .transition_count = 1,
              .speed = 0.5}},
        .transitions = {{0, 0, 1, 0}, {1, 1, 1, 0}},
        .targets = {{1, 0, 1.0}, {0, 0, 1.0}},
        .conditions = {first, second},
        .goals = {{"a", {FF_REGION_POINT, 0, {5, 0}, {0, 0}, 0}, {5, 5}, 1.0, 1, 0},
                  {"b", {FF_REGION_POINT, 0, {-5, 0}, {0, 0}, 0}, {-5, 5}, 1.0, 1, 0}},
        .set = {"ends", 0, 2, 0, 0}};
    p->def = (ff_behaviour_def){.machines = &p->machine,
                                .machine_count = 1,
                                .states = p->states,
                                .state_count = 2,
                                .transitions = p->transitions,
                                .transition_count = 2,
                                .targets = p->targets,
                                .target_count = 2,
                                .conditions = p->conditions,
                                .condition_count = 2,
                                .goals = p->goals,
                                .goal_count = 2,
                                .sets = &p->set,
                                .set_count = 1};
}

static ff_crowd *crowd_of(const ff_behaviour_def *behaviour)
{
    ff_error error;
    ff_crowd *crowd;
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = 8;
    def.behaviour = behaviour;
    FF_ASSERT_OK(ff_crowd_create(walker.pack, &def, &crowd, &error), error);
    return crowd;
}

static ff_status add(ff_crowd *crowd, ff_vec2 position, uint32_t machine, ff_agent *agent)
{
    ff_error error;
    ff_agent_def def = ff_agent_def_default();
    def.position = def.goal = position;
    def.machine = machine;
    return ff_crowd_add_agent(crowd, &def, agent, &error);
}

static void states_that_lead_round_without_time_are_a_fault_and_the_crowd_goes_on(void **state)
{
    (void)state;
    pair p;
    ff_error error;
    ff_agent agent;
    make_pair(&p, always, always);
    ff_crowd *crowd = crowd_of(&p.def);
    assert_int_equal(add(crowd, ff_v2(0, 0), 0, &agent), FF_OK);
    FF_ASSERT_OK(ff_crowd_fault(crowd, &error), error);
    ff_crowd_step(crowd);
    assert_int_equal(ff_crowd_fault(crowd, &error), FF_ERR_RANGE);
    assert_non_null(strstr(error.message, "agent 0"));
    assert_non_null(strstr(error.message, "\"One\"")); /* eight on from where it started */
    crowd = reloaded(crowd, 1);
    ff_crowd_step(crowd);
    assert_int_equal(ff_crowd_fault(crowd, &error), FF_ERR_RANGE);
    ff_crowd_destroy(crowd);
}

static void a_full_goal_keeps_others_out_until_it_is_left(void **state)
{
    (void)state;
    pair p;
    ff_agent first, second, third;
    make_pair(&p, (ff_condition_def){.kind = FF_IF_TIMER, .amount = {.a = 2.0}},
              (ff_condition_def){.kind = FF_IF_TIMER, .amount = {.a = 4.0}});
    ff_crowd *crowd = crowd_of(&p.def);
    assert_int_equal(add(crowd, ff_v2(0, 0), 0, &first), FF_OK);
    assert_int_equal(add(crowd, ff_v2(0, 2), 0, &second), FF_ERR_RANGE); /* goal a holds one */
    assert_int_equal(ff_crowd_agent_count(crowd), 1);
    for (int i = 0; i < 61; ++i)
        ff_crowd_step(crowd);
    assert_int_equal(behaviour_of(crowd, first).state, 1);
    FF_ASSERT_NEAR(ff_length2(ff_sub2(state_of(crowd, first).goal, ff_v2(-5, 0))), 0.0, 0.0);
    assert_int_equal(add(crowd, ff_v2(0, 2), 0, &second), FF_OK);
    assert_int_equal(add(crowd, ff_v2(0, 4), 0, &third), FF_ERR_RANGE);
    for (int i = 0; i < 90; ++i) /* its time is over, but b is still taken; and the first one wants a */
        ff_crowd_step(crowd);
    assert_int_equal(behaviour_of(crowd, second).state, 0);
    FF_ASSERT_BELOW(2.9, behaviour_of(crowd, second).seconds);
    ff_error error;
    FF_ASSERT_OK(ff_crowd_remove_agent(crowd, first, &error), error);
    assert_int_equal(ff_crowd_goal_taken(crowd, 1), 0);
    ff_crowd_step(crowd);
    assert_int_equal(behaviour_of(crowd, second).state, 1);
    ff_crowd_destroy(crowd);
}

static void who_cannot_go_notices_that_the_way_is_blocked(void **state)
{
    (void)state;
    pair p;
    ff_error error;
    ff_agent agent;
    ff_condition_def blocked = {.kind = FF_IF_BLOCKED, .amount = {.a = 1.0}};
    make_pair(&p, blocked, always);
    p.states[1].transition_count = 0;
    ff_crowd *crowd = crowd_of(&p.def);
    /* A cage. */
    for (int i = 0; i < 4; ++i)
        FF_ASSERT_OK(ff_crowd_add_wall(crowd, ff_scale2(ff_fwd2(0.5 * FF_PI * i + 0.25 * FF_PI), 0.7),
                                       ff_scale2(ff_fwd2(0.5 * FF_PI * i + 0.75 * FF_PI), 0.7), &error),
                     error);
    assert_int_equal(add(crowd, ff_v2(0, 0), 0, &agent), FF_OK);
    int steps = 0;
    for (; behaviour_of(crowd, agent).state == 0 && steps < 300; ++steps)
        ff_crowd_step(crowd);
    assert_in_range(steps, 30, 120);
    ff_crowd_destroy(crowd);
}

static void the_state_and_the_caller_share_the_speed(void **state)
{
    (void)state;
    pair p;
    ff_error error;
    ff_agent agent;
    ff_condition_def timer = {.kind = FF_IF_TIMER, .amount = {.a = 3.0}};
    make_pair(&p, timer, always);
    p.states[1].transition_count = 0;
    p.goals[1].place.centre = ff_v2(30, 0);
    p.goals[0].place.centre = ff_v2(30, 0);
    ff_crowd *crowd = crowd_of(&p.def);
    assert_int_equal(add(crowd, ff_v2(0, 0), 0, &agent), FF_OK);
    FF_ASSERT_OK(ff_crowd_set_preferred_speed(crowd, agent, 1.0, &error), error);
    for (int i = 0; i < 85; ++i)
        ff_crowd_step(crowd);
    FF_ASSERT_NEAR(ff_length2(state_of(crowd, agent).velocity), 1.0, 0.03);
    for (int i = 0; i < 90; ++i) /* Two: half of it */
        ff_crowd_step(crowd);
    FF_ASSERT_NEAR(ff_length2(state_of(crowd, agent).velocity), 0.5, 0.03);
    FF_ASSERT_OK(ff_crowd_set_preferred_speed(crowd, agent, 1.6, &error), error);
    for (int i = 0; i < 60; ++i)
        ff_crowd_step(crowd);
    FF_ASSERT_NEAR(ff_length2(state_of(crowd, agent).velocity), 0.8, 0.03);
    assert_int_equal(ff_crowd_set_preferred_speed(crowd, agent, NAN, &error), FF_ERR_NOT_FINITE);
    assert_int_equal(ff_crowd_set_preferred_speed(crowd, (ff_agent){9, 9}, 1.0, &error), FF_ERR_ARGUMENT);
    ff_crowd_destroy(crowd);
}

/* ----------------------------------------------------------------------------------------------- looking */

static void one_who_stands_turns_in_place_with_steps_to_what_it_shall_look_at(void **state)
{
    (void)state;
    ff_error error;
    for (int k = 0; k < 8; ++k) {
        ff_agent agent;
        ff_crowd *crowd = crowd_of(NULL);
        assert_int_equal(add(crowd, ff_v2(1, 1), FF_NONE, &agent), FF_OK);
        for (int i = 0; i < 30; ++i)
            ff_crowd_step(crowd);
        ff_vec2 way = ff_scale2(ff_fwd2(FF_TAU * k / 8.0), 4.0);
        ff_vec2 point = ff_add2(ff_v2(1, 1), way);
        FF_ASSERT_OK(ff_crowd_set_facing(crowd, agent, k % 2 ? FF_FACE_POINT : FF_FACE_HEADING,
                                         k % 2 ? point : way, &error),
                     error);
        int lifted = 0, aloft = 0;
        double moved = 0.0;
        for (int i = 0; i < 120; ++i) {
            ff_crowd_step(crowd);
            ff_agent_state s = state_of(crowd, agent);
            lifted += !s.planted[0] || !s.planted[1];
            aloft = s.planted[0] || s.planted[1] ? 0 : aloft + 1;
            assert_true(aloft < 2);
            moved = ff_max(moved, ff_length2(ff_sub2(s.position, ff_v2(1, 1))));
        }
        ff_agent_state s = state_of(crowd, agent);
        FF_ASSERT_BELOW(angle_to(&s, point), 0.06);
        FF_ASSERT_BELOW(moved, 0.25);
        assert_true(k == 0 || lifted > 5);
        FF_ASSERT_BELOW(fabs(s.turn_rate), 1e-9);
        FF_ASSERT_OK(ff_crowd_set_facing(crowd, agent, FF_FACE_FREE, ff_v2(0, 0), &error), error);
        assert_int_equal(ff_crowd_set_facing(crowd, agent, FF_FACE_GOAL, ff_v2(0, 0), &error),
                         FF_ERR_ARGUMENT);
        assert_int_equal(ff_crowd_set_facing(crowd, agent, FF_FACE_POINT, ff_v2(NAN, 0), &error),
                         FF_ERR_NOT_FINITE);
        ff_crowd_destroy(crowd);
    }
}

/* ------------------------------------------------------------------------------------------------ spawners */

static void spawners_put_in_as_many_as_they_say_where_there_is_room(void **state)
{
    (void)state;
    pair p;
    ff_condition_def arrived = {.kind = FF_IF_ARRIVED, .amount = {.a = 0.5}};
    make_pair(&p, arrived, always);
    p.states[0].choice = FF_CHOOSE_OFFSET;
    p.states[0].offset = ff_v2(6.0, 0.0);
    p.states[1].choice = FF_CHOOSE_IDENTITY;
    p.states[1].motion = FF_MOTION_STAND;
    p.states[1].transition_count = 0;
    for (int k = 0; k < 4; ++k) {
        ff_error error;
        ff_spawner_def spawner = {.name = "door",
                                  .place = {FF_REGION_BOX, 0, {0, 0}, {0.6, 3.0}, 0},
                                  .regular = k < 2,
                                  .total = k == 1 ? 5 : 0,
                                  .most = k == 2 ? 3 : 0,
                                  .rate = k == 3 ? 30.0 : 1.0,
                                  .preferred_speed = {.a = 1.3},
                                  .radius = {.a = 0.25}};
        p.def.spawners = &spawner;
        p.def.spawner_count = 1;
        ff_crowd_def def = ff_crowd_def_default();
        def.max_agents = k == 3 ? 20 : 64;
        def.behaviour = &p.def;
        ff_crowd *crowd;
        FF_ASSERT_OK(ff_crowd_create(walker.pack, &def, &crowd, &error), error);
        double nearest = INFINITY;
        uint32_t before = 0;
        for (int i = 0; i < 30 * 16; ++i) {
            ff_crowd_step(crowd);
            ff_agent agents[64];
            uint32_t count = ff_crowd_agents(crowd, agents, 64);
            for (uint32_t n = before; n < count; ++n) /* who has just come (nobody goes here) */
                for (uint32_t m = 0; m < n; ++m) {
                    ff_vec2 gap =
                        ff_sub2(state_of(crowd, agents[n]).position, state_of(crowd, agents[m]).position);
                    nearest = ff_min(nearest, ff_length2(gap));
                }
            before = count;
        }
        FF_ASSERT_BELOW(0.5, nearest);
        ff_crowd_counts counts = ff_crowd_count(crowd);
        assert_int_equal(counts.spawned, ff_crowd_agent_count(crowd));
        if (k == 0) assert_in_range(counts.spawned, 15, 16);
        if (k == 1) assert_int_equal(counts.spawned, 5);
        if (k == 2) assert_int_equal(counts.spawned, 3);
        if (k == 3) assert_int_equal(counts.spawned, 20);
        ff_crowd_destroy(crowd);
    }
}

static void behaviour_is_refused_whole_or_where_there_is_none(void **state)
{
    (void)state;
    ff_error error;
    ff_agent agent;
    ff_behaviour_def behaviour = fair_behaviour();
    behaviour.set_count = 0;
    ff_crowd_def def = ff_crowd_def_default();
    def.behaviour = &behaviour;
    ff_crowd *crowd;
    assert_int_not_equal(ff_crowd_create(walker.pack, &def, &crowd, &error), FF_OK);
    assert_null(crowd);
    crowd = crowd_of(NULL);
    assert_int_equal(add(crowd, ff_v2(0, 0), 0, &agent), FF_ERR_RANGE);
    assert_int_equal(add(crowd, ff_v2(0, 0), FF_NONE, &agent), FF_OK);
    assert_int_equal(behaviour_of(crowd, agent).state, FF_NONE);
    assert_int_equal(ff_crowd_set_signal(crowd, 0, 0, &error), FF_ERR_ARGUMENT);
    assert_int_equal(ff_crowd_signal_phase(crowd, 0), FF_NONE);
    assert_int_equal(ff_crowd_goal_taken(crowd, 0), 0);
    FF_ASSERT_OK(ff_crowd_fault(crowd, &error), error);
    ff_crowd_destroy(crowd);
    crowd = fair_crowd(1, 0);
    assert_int_equal(add(crowd, ff_v2(0, 0), FAIR_MACHINES, &agent), FF_ERR_RANGE);
    assert_int_equal(ff_crowd_set_signal(crowd, 0, 2, &error), FF_ERR_ARGUMENT);
    assert_int_equal(add(crowd, ff_v2(0, 0), FF_NONE, &agent), FF_OK); /* goals by its caller */
    ff_crowd_step(crowd);
    assert_int_equal(behaviour_of(crowd, agent).state, FF_NONE);
    ff_crowd_destroy(crowd);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fair_goes_as_its_machine_says),
        cmocka_unit_test(threads_saving_and_loading_change_no_bit),
        cmocka_unit_test(states_that_lead_round_without_time_are_a_fault_and_the_crowd_goes_on),
        cmocka_unit_test(a_full_goal_keeps_others_out_until_it_is_left),
        cmocka_unit_test(who_cannot_go_notices_that_the_way_is_blocked),
        cmocka_unit_test(the_state_and_the_caller_share_the_speed),
        cmocka_unit_test(one_who_stands_turns_in_place_with_steps_to_what_it_shall_look_at),
        cmocka_unit_test(spawners_put_in_as_many_as_they_say_where_there_is_room),
        cmocka_unit_test(behaviour_is_refused_whole_or_where_there_is_none),
    };
    return cmocka_run_group_tests(tests, ff_walker_open, ff_walker_close);
}
