/* What scene files say of behaviour: read into the right records, and every mistake named with its line. */
#include "runtime/core/base/file.h"
#include "runtime/export/scene.h"
#include "tests/check.h"

#include <stdio.h>

static ff_status parse(const char *text, ff_scene_def *def, ff_error *error)
{
    return ff_scene_def_parse(text, strlen(text), "scene.json", def, error);
}

static const char whole[] =
    "{\"kind\": \"custom\", \"preferred_speed\": 1.2, \"preferred_speed_spread\": 0.1,\n"
    "\"goals\": {\n"
    "  \"shops\": [{\"name\": \"bakery\", \"box\": [4, 1, 2, 5], \"turned_degrees\": 30, \"look_at\": [7, "
    "8], "
    "\"weight\": 2.5, \"capacity\": 4}, {\"circle\": [1, 2, 0.5]}],\n"
    "  \"gates\": {\"exit\": true, \"goals\": [{\"point\": [-3, 9]}]}},\n"
    "\"regions\": {\"road\": {\"box\": [-1, -2, 1, 2]}},\n"
    "\"signals\": {\"lights\": {\"phases\": [[\"walk\", 20], [\"stop\", 8]], \"passed\": 5}},\n"
    "\"variables\": {\"seen\": 1, \"tired\": 0},\n"
    "\"behaviours\": {\n"
    "  \"idler\": {\"start\": \"Stand\", \"states\": {\"Stand\": {\"move\": \"stand\", \"face\": "
    "{\"heading_degrees\": 90}}}},\n"
    "  \"visitor\": {\"start\": \"Walk\", \"states\": {\n"
    "    \"Go\": {\"goal\": {\"explicit\": \"gates 1\"}},\n"
    "    \"Walk\": {\"goal\": {\"weighted\": \"shops\", \"not_last\": true}, \"speed\": 1.5, \"next\": [\n"
    "      {\"when\": {\"arrived\": 0.4}, \"to\": {\"Look\": 3, \"Go\": 1}},\n"
    "      {\"when\": {\"any\": [{\"blocked\": 9}, {\"all\": [{\"inside\": \"road\"}, {\"not\": {\"signal\": "
    "[\"lights\", "
    "\"stop\"]}}]}]}, \"to\": \"Go\"}]},\n"
    "    \"Look\": {\"move\": \"face\", \"enter\": [{\"add\": \"seen\", \"value\": 1}, {\"set\": \"tired\", "
    "\"value\": [0, 2]}],\n"
    "      \"exit\": [{\"scale\": \"preferred_speed\", \"value\": {\"mean\": 0.9, \"deviation\": 0.05}}],\n"
    "      \"next\": [{\"when\": {\"timer\": {\"mean\": 5, \"deviation\": 1}}, \"to\": \"Walk\"},\n"
    "        {\"when\": {\"more\": [\"seen\", 3]}, \"to\": \"Go\"}, {\"when\": {\"chance\": 0.1}, \"to\": "
    "\"Go\"}]}}}},\n"
    "\"agents\": [{\"position\": [0, 0], \"goal\": [1, 1]}, {\"position\": [3, 0], \"behaviour\": "
    "\"idler\"}],\n"
    "\"groups\": [{\"behaviour\": \"visitor\", \"count\": 3, \"circle\": [10, 10, 2], \"radius\": [0.2, "
    "0.3]}],\n"
    "\"spawners\": [{\"behaviour\": \"visitor\", \"point\": [20, 0], \"rate\": 0.5, \"regular\": true, "
    "\"total\": 9, "
    "\"most\": 4, \"heading_degrees\": 180}]}";

static void every_key_comes_into_its_record(void **state)
{
    (void)state;
    ff_error error;
    ff_scene_def def;
    FF_ASSERT_OK(parse(whole, &def, &error), error);
    ff_behaviour_def b = ff_scene_behaviour_def(&def.behaviour);
    assert_int_equal(b.set_count, 2);
    assert_string_equal(b.sets[1].name, "gates");
    assert_true(b.sets[1].exit && !b.sets[0].exit && b.sets[1].first_goal == 2 && b.sets[0].goal_count == 2);
    const ff_goal_def *bakery = &b.goals[0];
    assert_string_equal(bakery->name, "bakery");
    assert_string_equal(b.goals[1].name, "shops 2");
    assert_int_equal(bakery->place.shape, FF_REGION_BOX);
    FF_ASSERT_NEAR(bakery->place.centre.a, 3.0, 0); /* plane coordinates are (z, x) */
    FF_ASSERT_NEAR(bakery->place.centre.b, 3.0, 0);
    FF_ASSERT_NEAR(bakery->place.half.a, 2.0, 0);
    FF_ASSERT_NEAR(bakery->place.half.b, 1.0, 0);
    FF_ASSERT_NEAR(bakery->place.heading, 30.0 * FF_DEG, 1e-12);
    FF_ASSERT_NEAR(bakery->look_at.a, 8.0, 0);
    FF_ASSERT_NEAR(bakery->look_at.b, 7.0, 0);
    assert_true(bakery->weight == 2.5 && bakery->capacity == 4 && b.goals[1].weight == 1.0 &&
                b.goals[1].capacity == 0);
    FF_ASSERT_NEAR(b.goals[1].place.half.a, 0.5, 0);
    FF_ASSERT_NEAR(b.goals[1].look_at.a, 2.0, 0); /* its own middle */
    assert_int_equal(b.regions[0].place.shape, FF_REGION_BOX);
    assert_true(b.signals[0].phase_count == 2 && b.signals[0].passed == 5.0 && b.phases[1].seconds == 8.0);
    assert_true(b.variable_count == 2 && b.variables[0].start == 1.0);

    assert_int_equal(b.machine_count, 2);
    assert_int_equal(b.state_count, 4);
    const ff_state_def *stand = &b.states[0], *go = &b.states[1], *walk = &b.states[2], *look = &b.states[3];
    assert_int_equal(b.machines[1].start, 2);
    assert_true(stand->motion == FF_MOTION_STAND && stand->face == FF_FACE_HEADING);
    FF_ASSERT_NEAR(stand->face_at.b, 1.0, 1e-12);
    assert_true(go->choice == FF_CHOOSE_EXPLICIT && go->from == 2 && go->motion == FF_MOTION_GOAL &&
                go->speed == 1.0);
    assert_true(walk->choice == FF_CHOOSE_WEIGHTED && walk->from == 0 && walk->not_last == 1 &&
                walk->speed == 1.5);
    assert_int_equal(walk->transition_count, 2);
    const ff_transition_def *first = &b.transitions[walk->first_transition];
    assert_true(first->target_count == 2 && b.targets[first->first_target].state == 3);
    assert_true(b.targets[first->first_target].weight == 3.0 &&
                b.targets[first->first_target + 1].state == 1);
    assert_true(b.conditions[first->condition].kind == FF_IF_ARRIVED &&
                b.conditions[first->condition].amount.a == 0.4);
    const ff_condition_def *any = &b.conditions[first[1].condition];
    assert_true(any->kind == FF_IF_ANY && any->count == 2);
    const ff_condition_def *all = &b.conditions[any->first + 1];
    assert_true(b.conditions[any->first].kind == FF_IF_BLOCKED && all->kind == FF_IF_ALL && all->count == 2);
    const ff_condition_def *not = &b.conditions[all->first + 1];
    assert_true(not ->kind == FF_IF_NOT && b.conditions[not ->first].kind == FF_IF_SIGNAL);
    assert_int_equal(b.conditions[not ->first].value, 1);
    assert_true(look->choice == FF_CHOOSE_SHARED && look->motion == FF_MOTION_STAND &&
                look->face == FF_FACE_GOAL);
    assert_true(look->enter_count == 2 && look->exit_count == 1 && look->transition_count == 3);
    assert_int_equal(b.acts[look->first_enter + 1].property, FF_PROPERTY_VARIABLE + 1);
    assert_int_equal(b.acts[look->first_enter + 1].amount.kind, FF_AMOUNT_UNIFORM);
    assert_int_equal(b.acts[look->first_exit].property, FF_PROPERTY_PREFERRED_SPEED);
    const ff_condition_def *timer = &b.conditions[b.transitions[look->first_transition].condition];
    assert_true(timer->amount.kind == FF_AMOUNT_NORMAL && timer->amount.a == 5.0 && timer->amount.b == 1.0);

    const ff_scene_group *group = def.crowds.data;
    assert_true(group->machine == 1 && group->count == 3 && group->radius.kind == FF_AMOUNT_UNIFORM);
    assert_true(group->preferred_speed.kind == FF_AMOUNT_NORMAL && group->preferred_speed.a == 1.2);
    const ff_spawner_def *spawner = &b.spawners[0];
    assert_true(spawner->machine == 1 && spawner->rate == 0.5 && spawner->regular && spawner->total == 9 &&
                spawner->most == 4);
    assert_string_equal(spawner->name, "spawner 1");
    ff_scene scene;
    FF_ASSERT_OK(ff_scene_create(&def, &scene, &error), error);
    assert_int_equal(ff_scene_agent_count(&scene), 5);
    assert_int_equal(scene.most, 9);
    assert_int_equal(scene.most_numbers, 14);
    const ff_scene_agent *agents = ff_scene_agents(&scene);
    assert_true(agents[0].machine == FF_NONE && agents[1].machine == 0 && agents[4].machine == 1);
    for (int i = 2; i < 5; ++i) {
        FF_ASSERT_BELOW(ff_length2(ff_sub2(agents[i].position, ff_v2(10, 10))),
                        2.0 - agents[i].radius + 1e-9);
        for (int j = 2; j < i; ++j)
            FF_ASSERT_BELOW(agents[i].radius + agents[j].radius,
                            ff_length2(ff_sub2(agents[i].position, agents[j].position)));
    }
    ff_scene_free(&scene);
    ff_scene_def_free(&def);
}

static void the_agents_of_a_layout_can_follow_a_behaviour_too(void **state)
{
    (void)state;
    ff_error error;
    ff_scene_def def;
    FF_ASSERT_OK(
        parse("{\"kind\": \"circle\", \"agents\": 5, \"behaviour\": \"there and back\", \"behaviours\": "
              "{\"there and "
              "back\": {\"start\": \"Go\", \"states\": {\"Go\": {\"goal\": \"mirror\", \"next\": [{\"when\": "
              "{\"arrived\": 0.5}, \"to\": \"Go\"}]}}}}}",
              &def, &error),
        error);
    ff_scene scene;
    FF_ASSERT_OK(ff_scene_create(&def, &scene, &error), error);
    for (int i = 0; i < 5; ++i)
        assert_int_equal(ff_scene_agents(&scene)[i].machine, 0);
    ff_scene_free(&scene);
    ff_scene_def_free(&def);
}

/* A place in `whole` changed into a mistake: what is replaced, by what, and what the complaint must say, at which line. */
typedef struct mistake {
    const char *from, *to, *says;
    uint32_t line;
} mistake;

static const mistake mistakes[] = {
    {"\"shops\": [", "\"shops\": [true, ", "a goal is", 3},
    {"\"name\": \"bakery\"", "\"nome\": \"bakery\"", "did you mean 'name'", 3},
    {"\"name\": \"bakery\"", "\"name\": \"\"", "names have 1 to 31", 3},
    {"\"name\": \"bakery\"", "\"name\": \"shops 2\"", "two goals \"shops 2\"", 3},
    {"\"box\": [4, 1, 2, 5]", "\"box\": [4, 1, 2]", "a box as [x1, z1, x2, z2]", 3},
    {"\"box\": [4, 1, 2, 5]", "\"box\": [4, 1, 2, 1e9]", "a number of metres", 3},
    {"\"circle\": [1, 2, 0.5]", "\"circle\": [1, 2, 0.5], \"turned_degrees\": 3", "only a box can be turned",
     3},
    {"\"circle\": [1, 2, 0.5]", "\"circle\": [1, 2, -0.5]", "not negative", 3},
    {"{\"circle\": [1, 2, 0.5]}", "{}", "a place is one of", 3},
    {"\"weight\": 2.5", "\"weight\": 0", "weight", 3},
    {"\"capacity\": 4", "\"capacity\": -4", "capacity", 3},
    {"\"goals\": [{\"point\": [-3, 9]}]", "\"goals\": []", "at least one", 4},
    {"\"exit\": true", "\"exit\": 1", "true or false", 4},
    {"{\"box\": [-1, -2, 1, 2]}", "[0, 0]", "a region is", 5},
    {"[\"walk\", 20]", "[\"walk\"]", "a phase is", 6},
    {"[\"walk\", 20]", "[\"walk\", 0]", "a phase is", 6},
    {"[[\"walk\", 20], [\"stop\", 8]]", "[]", "needs \"phases\"", 6},
    {"\"seen\": 1,", "\"seen\": \"much\",", "seen", 7},
    {"\"start\": \"Stand\"", "\"start\": \"Stant\"", "did you mean \"Stand\"", 9},
    {"\"start\": \"Stand\", ", "", "the one to \"start\" in", 9},
    {"\"move\": \"stand\"", "\"move\": \"sit\"", "move is \"sit\"", 9},
    {"{\"heading_degrees\": 90}", "{}", "heading_degrees", 9},
    {"{\"heading_degrees\": 90}", "7", "a point as [x, z]", 9},
    {"{\"explicit\": \"gates 1\"}", "{\"explicit\": \"gates\"}", "there is no goal \"gates\"", 11},
    {"{\"explicit\": \"gates 1\"}", "{\"explicit\": \"gates 1\", \"not_last\": true}", "a goal is", 11},
    {"{\"weighted\": \"shops\", \"not_last\": true}", "{\"weighted\": \"shop\"}", "did you mean \"shops\"",
     12},
    {"{\"weighted\": \"shops\", \"not_last\": true}", "\"weighted\"", "a goal is", 12},
    {"{\"weighted\": \"shops\", \"not_last\": true}", "{\"weighted\": \"shops\", \"random\": \"shops\"}",
     "a goal is", 12},
    {"\"speed\": 1.5", "\"speed\": 0", "speed", 12},
    {"{\"arrived\": 0.4}", "{\"arrived\": 0}", "\"arrived\" (m) is a number from", 13},
    {"{\"arrived\": 0.4}", "{\"arrived\": true}", "needs a distance", 13},
    {"{\"arrived\": 0.4}", "{\"arived\": 0.4}", "a condition is", 13},
    {"{\"arrived\": 0.4}", "{\"arrived\": 0.4, \"timer\": 3}", "a condition is", 13},
    {"{\"arrived\": 0.4}", "\"sometimes\"", "a condition is", 13},
    {"{\"when\": {\"arrived\": 0.4}, ", "{", "a condition is", 13},
    {"\"to\": {\"Look\": 3, \"Go\": 1}", "\"to\": {\"Look\": 3, \"Gone\": 1}", "there is no state \"Gone\"",
     13},
    {"\"to\": {\"Look\": 3, \"Go\": 1}", "\"to\": {\"Look\": 3, \"Go\": 0}", "Go", 13},
    {"\"to\": {\"Look\": 3, \"Go\": 1}", "\"to\": {}", "\"to\" is a state", 13},
    {"\"to\": {\"Look\": 3, \"Go\": 1}", "\"to\": \"Stand\"", "there is no state \"Stand\"", 13},
    {"{\"inside\": \"road\"}", "{\"inside\": \"rode\"}", "there is no region \"rode\"", 14},
    {"[\"lights\", \"stop\"]", "[\"lights\", \"halt\"]", "there is no phase \"halt\"", 14},
    {"[\"lights\", \"stop\"]", "[\"lights\"]", "[signal, phase]", 14},
    {"[\"lights\", \"stop\"]", "[true, \"stop\"]", "the name of a signal", 14},
    {"{\"any\": [", "{\"any\": [false, ", "a condition is", 14},
    {"\"move\": \"face\"", "\"mode\": \"face\"", "did you mean 'move'", 15},
    {"{\"add\": \"seen\"", "{\"add\": \"sean\"", "did you mean \"seen\"", 15},
    {"{\"add\": \"seen\"", "{\"add\": \"speed\"", "asked for but not changed", 15},
    {"{\"add\": \"seen\", \"value\": 1}", "{\"add\": \"seen\"}", "an act is", 15},
    {"[0, 2]}],", "[2, 0]}],", "[low, high]", 15},
    {"{\"mean\": 0.9, \"deviation\": 0.05}", "{\"mean\": 0.9, \"sigma\": 0.05}", "sigma", 16},
    {"\"deviation\": 1}", "\"deviation\": -1}", "\"timer\" (s) is", 17},
    {"[\"seen\", 3]", "[\"seen\", \"3\"]", "a number", 18},
    {"{\"chance\": 0.1}", "{\"chance\": -1}", "\"chance\"", 18},
    {"\"behaviour\": \"idler\"", "\"behaviour\": \"idle\"", "did you mean \"idler\"", 19},
    {"\"behaviour\": \"idler\"", "\"behaviour\": 7", "the name of one of \"behaviours\"", 19},
    {"{\"behaviour\": \"visitor\", \"count\": 3, ", "{\"count\": 3, ", "expected \"behaviour\"", 20},
    {"\"count\": 3", "\"count\": 0", "count", 20},
    {"\"radius\": [0.2, 0.3]", "\"radius\": [0, 0.3]", "radius (m) is a number from", 20},
    {"\"rate\": 0.5, ", "", "a spawner needs \"rate\"", 21},
    {"\"groups\": [", "\"groups\": [null, ", "groups is a list of objects", 20},
};

static char *changed(const mistake *m)
{
    const char *at = strstr(whole, m->from);
    assert_non_null(at);
    size_t size = sizeof whole + strlen(m->to);
    char *text = malloc(size);
    assert_non_null(text);
    snprintf(text, size, "%.*s%s%s", (int)(at - whole), whole, m->to, at + strlen(m->from));
    return text;
}

static void every_mistake_is_named_with_its_line(void **state)
{
    (void)state;
    int wrong = 0;
    for (size_t i = 0; i < sizeof mistakes / sizeof mistakes[0]; ++i) {
        ff_error error;
        ff_scene_def def;
        char *text = changed(&mistakes[i]), rendered[1024];
        if (parse(text, &def, &error) == FF_OK) {
            print_error("mistake %zu was accepted: %s\n", i, mistakes[i].to);
            ff_scene_def_free(&def);
            free(text);
            ++wrong;
            continue;
        }
        ff_error_text(&error, rendered, sizeof rendered);
        if (!strstr(error.message, mistakes[i].says) || error.line != mistakes[i].line || error.column == 0) {
            print_error("mistake %zu (%s), expected \"%s\" at line %u: %s\n", i, mistakes[i].to,
                        mistakes[i].says, mistakes[i].line, rendered);
            ++wrong;
        }
        free(text);
    }
    assert_int_equal(wrong, 0);
}

static void more_people_than_fit_are_refused(void **state)
{
    (void)state;
    ff_error error;
    ff_scene_def def;
    ff_scene scene;
    static const char behaviour[] =
        "\"behaviours\": {\"b\": {\"start\": \"S\", \"states\": {\"S\": {\"move\": \"stand\"}}}}";
    char text[512];
    snprintf(text, sizeof text,
             "{\"kind\": \"custom\", %s, \"groups\": [{\"behaviour\": \"b\", \"count\": 50, \"box\": [0, 0, "
             "2, 2]}]}",
             behaviour);
    FF_ASSERT_OK(parse(text, &def, &error), error);
    assert_int_equal(ff_scene_create(&def, &scene, &error), FF_ERR_ARGUMENT);
    assert_non_null(strstr(error.message, "no room for 50 people"));
    ff_scene_def_free(&def);
    snprintf(text, sizeof text,
             "{\"kind\": \"custom\", \"seconds\": 3600, %s, \"spawners\": [{\"behaviour\": \"b\", \"rate\": "
             "50, \"point\": [0, 0]}]}",
             behaviour);
    FF_ASSERT_OK(parse(text, &def, &error), error);
    assert_int_equal(ff_scene_create(&def, &scene, &error), FF_ERR_RANGE);
    assert_non_null(strstr(error.message, "\"total\""));
    ff_scene_def_free(&def);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_key_comes_into_its_record),
        cmocka_unit_test(the_agents_of_a_layout_can_follow_a_behaviour_too),
        cmocka_unit_test(every_mistake_is_named_with_its_line),
        cmocka_unit_test(more_people_than_fit_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
