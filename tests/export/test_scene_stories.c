/* What happens in the scenes with behaviour that come with the project, on the built-in pack: what their files promise. */
#define _GNU_SOURCE
#include "runtime/export/scene_crowd.h"
#include "tests/built_in_open.h"

#include <stdio.h>

enum { MOST = 64, NUMBERS = 256 };

/* A scene under way. */
typedef struct story {
    ff_scene scene;
    ff_behaviour_def def;
    ff_crowd *crowd;
    ff_agent agents[MOST];
    uint32_t count;
    double time; /* s */
} story;

static void begin(story *s, const char *path)
{
    ff_error error;
    ff_scene_def file;
    FF_ASSERT_OK(ff_scene_def_load(path, &file, &error), error);
    FF_ASSERT_OK(ff_scene_create(&file, &s->scene, &error), error);
    ff_scene_def_free(&file);
    ff_crowd_def def = ff_scene_crowd_def(&s->scene, &s->def);
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &s->crowd, &error), error);
    FF_ASSERT_OK(ff_scene_populate(&s->scene, s->crowd, &error), error);
    s->time = 0.0;
}

static void step(story *s)
{
    ff_error error;
    ff_crowd_step(s->crowd);
    FF_ASSERT_OK(ff_crowd_fault(s->crowd, &error), error);
    s->count = ff_crowd_agents(s->crowd, s->agents, MOST);
    assert_true(s->count <= MOST);
    s->time = (double)ff_crowd_step_count(s->crowd) * s->scene.step;
}

static void end(story *s)
{
    ff_crowd_destroy(s->crowd);
    ff_scene_free(&s->scene);
}

static ff_agent_state state_of(const story *s, uint32_t i)
{
    ff_error error;
    ff_agent_state state;
    FF_ASSERT_OK(ff_crowd_agent_state(s->crowd, s->agents[i], &state, &error), error);
    return state;
}

static ff_agent_behaviour behaviour_of(const story *s, uint32_t i)
{
    ff_error error;
    ff_agent_behaviour behaviour;
    FF_ASSERT_OK(ff_crowd_agent_behaviour(s->crowd, s->agents[i], &behaviour, &error), error);
    return behaviour;
}

static uint32_t state_named(const story *s, const char *name)
{
    for (uint32_t i = 0; i < s->def.state_count; ++i)
        if (strcmp(s->def.states[i].name, name) == 0) return i;
    fail();
    return 0;
}

static void the_crossing_is_clear_when_the_light_says_stop_and_people_set_out_on_walk_only(void **state)
{
    (void)state;
    story s;
    begin(&s, "runtime/scenes/crossing.json");
    const uint32_t cross = state_named(&s, "Cross");
    uint32_t last[NUMBERS], last_goal[NUMBERS], ways = 0, phase = 0, clear_rounds = 0;
    for (int i = 0; i < NUMBERS; ++i)
        last[i] = last_goal[i] = FF_NONE;
    while (s.time < s.scene.seconds) {
        uint32_t before = phase;
        phase = ff_crowd_signal_phase(s.crowd, 0); /* as the step's behaviour sees it */
        step(&s);
        assert_int_equal(s.count, 32);
        clear_rounds += phase == 2 && before == 1;
        for (uint32_t i = 0; i < s.count; ++i) {
            ff_agent_behaviour b = behaviour_of(&s, i);
            ff_agent_state a = state_of(&s, i);
            /* Corners begin at 6.4 m; who makes way there may stand on the kerb. */
            bool on_road = fabs(a.position.a) < 5.6 || fabs(a.position.b) < 5.6;
            if (phase == 2) assert_false(on_road);
            if (b.state == cross && last[a.number] != cross) {
                assert_int_equal(phase, 0);
                if (last_goal[a.number] != FF_NONE) assert_int_not_equal(b.goal, last_goal[a.number]);
                ++ways;
            }
            last[a.number] = b.state;
            last_goal[a.number] = b.goal;
        }
    }
    assert_true(clear_rounds >= 2 && ways >= 80);
    end(&s);
}

static void the_trade_show_keeps_to_its_capacities_and_times_and_loses_nobody(void **state)
{
    (void)state;
    story s;
    begin(&s, "runtime/scenes/tradeshow.json");
    const uint32_t look = state_named(&s, "Look"), go = state_named(&s, "Go"),
                   arrive = state_named(&s, "Arrive");
    static uint32_t last[NUMBERS], seen[NUMBERS];
    static double since[NUMBERS];
    memset(seen, 0, sizeof seen);
    for (int i = 0; i < NUMBERS; ++i)
        last[i] = FF_NONE;
    uint32_t looks = 0, most = 0;
    double worst = 0.0;
    while (s.time < s.scene.seconds) {
        step(&s);
        uint32_t taken[MOST] = {0};
        for (uint32_t i = 0; i < s.count; ++i) {
            ff_agent_behaviour b = behaviour_of(&s, i);
            ff_agent_state a = state_of(&s, i);
            uint32_t n = a.number;
            assert_true(n < NUMBERS);
            if (b.goal != FF_NONE) ++taken[b.goal];
            if (b.state != last[n]) {
                double spent = s.time - since[n];
                if (last[n] == look) assert_true(spent > 3.96 && spent < 6.04);
                if (last[n] == arrive) assert_true(spent > 1.96 && spent < 4.04);
                if (b.state == go) assert_int_equal(seen[n], 3);
                looks += b.state == look;
                seen[n] += b.state == look;
                last[n] = b.state;
                since[n] = s.time;
            }
            if (b.state != look || b.seconds < 3.8) continue;
            ff_vec2 way = ff_sub2(s.def.goals[b.goal].look_at, a.position);
            double off = fabs(ff_wrap(ff_atan2(way.b, way.a) - a.heading));
            FF_ASSERT_BELOW(off, 0.3); /* who steps aside turns meanwhile */
            if (ff_length2(a.velocity) < 0.05) worst = ff_max(worst, off);
            FF_ASSERT_BELOW(ff_length2(a.velocity), 0.65); /* stands, or steps aside */
        }
        for (uint32_t g = 0; g < s.def.goal_count; ++g) {
            uint32_t capacity = s.def.goals[g].capacity;
            assert_int_equal(taken[g], ff_crowd_goal_taken(s.crowd, g));
            assert_true(capacity == 0 || taken[g] <= capacity);
            most = capacity > 0 && taken[g] > most ? taken[g] : most;
        }
        ff_crowd_counts counts = ff_crowd_count(s.crowd);
        assert_true(counts.added == counts.spawned && counts.spawned == counts.left + s.count);
        assert_true(s.count <= 20);
    }
    assert_true(ff_crowd_count(s.crowd).left >= 5 && looks >= 30);
    assert_int_equal(most, 3); /* booths were full */
    FF_ASSERT_BELOW(worst, 0.08);
    end(&s);
}

static void shoppers_look_and_browse_for_their_times_inside_the_shops_and_before_them(void **state)
{
    (void)state;
    story s;
    begin(&s, "runtime/scenes/mall.json");
    const uint32_t window = state_named(&s, "Window"), browse = state_named(&s, "Browse");
    static uint32_t last[NUMBERS];
    static double since[NUMBERS];
    for (int i = 0; i < NUMBERS; ++i)
        last[i] = FF_NONE;
    uint32_t looked = 0, browsed = 0;
    while (s.time < s.scene.seconds) {
        step(&s);
        assert_int_equal(s.count, 15);
        for (uint32_t i = 0; i < s.count; ++i) {
            ff_agent_behaviour b = behaviour_of(&s, i);
            ff_agent_state a = state_of(&s, i);
            assert_true(fabs(a.position.b) < 6.0 && fabs(a.position.a) < 18.5); /* within the walls */
            if (b.state == browse) assert_true(fabs(a.position.b) > 1.5);
            if (b.state == window) assert_true(fabs(a.position.b) < 1.5);
            if (b.state == last[a.number]) continue;
            double spent = s.time - since[a.number];
            if (last[a.number] == window) assert_true(spent > 2.96 && spent < 8.04);
            if (last[a.number] == browse) assert_true(spent > 3.96 && spent < 8.04);
            looked += last[a.number] == window;
            browsed += last[a.number] == browse;
            last[a.number] = b.state;
            since[a.number] = s.time;
        }
    }
    assert_true(looked >= 15 && browsed >= 10);
    end(&s);
}

static void everyone_gets_through_the_course_past_all_its_goals_in_order(void **state)
{
    (void)state;
    story s;
    begin(&s, "runtime/scenes/course.json");
    static uint32_t passed[NUMBERS];
    memset(passed, 0, sizeof passed);
    while (s.time < s.scene.seconds && ff_crowd_count(s.crowd).left < 5) {
        step(&s);
        for (uint32_t i = 0; i < s.count; ++i) {
            ff_agent_behaviour b = behaviour_of(&s, i);
            uint32_t n = state_of(&s, i).number;
            assert_true(b.goal == passed[n] || b.goal == passed[n] + 1);
            passed[n] = b.goal;
        }
    }
    assert_int_equal(ff_crowd_count(s.crowd).left, 5);
    for (int n = 0; n < 5; ++n)
        assert_int_equal(passed[n], 9); /* nine ways, then the end */
    end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_crossing_is_clear_when_the_light_says_stop_and_people_set_out_on_walk_only),
        cmocka_unit_test(the_trade_show_keeps_to_its_capacities_and_times_and_loses_nobody),
        cmocka_unit_test(shoppers_look_and_browse_for_their_times_inside_the_shops_and_before_them),
        cmocka_unit_test(everyone_gets_through_the_course_past_all_its_goals_in_order),
    };
    return cmocka_run_group_tests(tests, open_pack, close_pack);
}
