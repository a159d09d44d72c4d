/* Scene files: layouts as in the navigation study, and every mistake named with its line. */
#include "runtime/export/scene.h"
#include "tests/check.h"
#include "tests/export/walker.h"

static double nearest_start(const ff_scene *scene)
{
    double least = 1e9;
    for (uint32_t i = 0; i < ff_scene_agent_count(scene); ++i)
        for (uint32_t j = 0; j < i; ++j)
            least = ff_min(least, ff_length2(ff_sub2(ff_scene_agents(scene)[i].position,
                                                     ff_scene_agents(scene)[j].position)));
    return least;
}

static void test_a_circle_sends_everyone_to_the_opposite_side(void **state)
{
    (void)state;
    ff_scene scene;
    walker_scene("{\"kind\": \"circle\", \"agents\": 40}", &scene);
    assert_int_equal(ff_scene_agent_count(&scene), 40);
    for (uint32_t i = 0; i < 40; ++i) {
        const ff_scene_agent *agent = &ff_scene_agents(&scene)[i];
        FF_ASSERT_NEAR(ff_length2(agent->position), 6.4, 1e-9); /* 0.16 N */
        FF_ASSERT_NEAR(ff_length2(ff_add2(agent->position, agent->goal)), 0.0, 1e-9);
        ff_vec2 inward = ff_scale2(ff_unit2(agent->position), -1.0);
        FF_ASSERT_NEAR(ff_dot2(inward, ff_fwd2(agent->heading)), 1.0, 1e-9);
        FF_ASSERT_NEAR(agent->preferred_speed, 1.3, 0.0);
    }
    ff_scene_free(&scene);
}

static void test_a_two_way_crossing_is_two_blocks_at_a_right_angle(void **state)
{
    (void)state;
    ff_scene scene;
    walker_scene("{\"kind\": \"two_way\"}", &scene);
    assert_int_equal(ff_scene_agent_count(&scene), 30);
    assert_int_equal(scene.groups, 2);
    const ff_scene_agent *first = ff_scene_agents(&scene), *last = first + 29;
    ff_vec2 way[2] = {ff_sub2(first->goal, first->position), ff_sub2(last->goal, last->position)};
    FF_ASSERT_NEAR(ff_dot2(way[0], way[1]), 0.0, 1e-9);
    FF_ASSERT_NEAR(ff_length2(way[0]), 20.0, 1e-9);
    FF_ASSERT_NEAR(nearest_start(&scene), 0.64, 0.04);
    ff_scene_free(&scene);
}

static void test_a_bidirectional_crowd_starts_inside_its_corridor(void **state)
{
    (void)state;
    ff_scene scene;
    walker_scene("{\"kind\": \"bidirectional\", \"corridor_width\": 6.0, \"agents\": 100}", &scene);
    assert_int_equal(ff_scene_agent_count(&scene), 100);
    assert_int_equal(ff_scene_wall_count(&scene), 2);
    for (uint32_t i = 0; i < 100; ++i) {
        const ff_scene_agent *agent = &ff_scene_agents(&scene)[i];
        FF_ASSERT_BELOW(fabs(agent->position.b), 3.0 - 0.3);
        const ff_scene_wall *wall = ff_scene_walls(&scene);
        FF_ASSERT_BELOW(fabs(agent->position.a), fabs(wall->p.a) - 0.3);
        FF_ASSERT_BELOW(fabs(agent->goal.a), fabs(wall->p.a));
    }
    ff_scene_free(&scene);
}

static void test_a_four_way_crossing_starts_in_the_corners_of_its_square(void **state)
{
    (void)state;
    ff_scene scene;
    walker_scene("{\"kind\": \"four_way\", \"agents\": 100, \"jitter\": 0}", &scene);
    ff_vec2 middle[4] = {{0}};
    for (uint32_t i = 0; i < 100; ++i)
        middle[ff_scene_agents(&scene)[i].group] = ff_madd2(middle[ff_scene_agents(&scene)[i].group],
                                                            ff_scene_agents(&scene)[i].position, 1.0 / 25.0);
    for (int g = 0; g < 4; ++g) {
        FF_ASSERT_NEAR(fabs(middle[g].a), 12.0, 1e-9);
        FF_ASSERT_NEAR(fabs(middle[g].b), 12.0, 1e-9);
    }
    FF_ASSERT_NEAR(nearest_start(&scene), 1.11, 1e-9);
    ff_scene_free(&scene);
}

static void test_seeds_change_where_people_start_and_equal_seeds_do_not(void **state)
{
    (void)state;
    ff_scene one, same, other;
    walker_scene("{\"kind\": \"two_way\", \"seed\": 1}", &one);
    walker_scene("{\"kind\": \"two_way\", \"seed\": 1}", &same);
    walker_scene("{\"kind\": \"two_way\", \"seed\": 2}", &other);
    for (int i = 0; i < 30; ++i) {
        FF_ASSERT_NEAR(ff_scene_agents(&one)[i].position.a, ff_scene_agents(&same)[i].position.a, 0.0);
        FF_ASSERT_NEAR(ff_scene_agents(&one)[i].position.b, ff_scene_agents(&same)[i].position.b, 0.0);
    }
    assert_true(ff_scene_agents(&one)[7].position.a != ff_scene_agents(&other)[7].position.a);
    ff_scene_free(&one);
    ff_scene_free(&same);
    ff_scene_free(&other);
}

static void test_speeds_spread_about_the_preferred_speed(void **state)
{
    (void)state;
    ff_scene scene;
    walker_scene("{\"kind\": \"circle\", \"agents\": 400, \"preferred_speed_spread\": 0.15}", &scene);
    double sum = 0.0, squares = 0.0;
    for (uint32_t i = 0; i < 400; ++i) {
        double off = ff_scene_agents(&scene)[i].preferred_speed - 1.3;
        sum += off;
        squares += off * off;
    }
    FF_ASSERT_NEAR(sum / 400.0, 0.0, 0.02);
    FF_ASSERT_NEAR(sqrt(squares / 400.0), 0.14, 0.02); /* cut off at two deviations */
    ff_scene_free(&scene);
}

static void test_a_custom_scene_is_taken_as_it_stands(void **state)
{
    (void)state;
    ff_scene scene;
    walker_scene("{\"kind\": \"custom\", \"agent_radius\": 0.25, \"at_goal\": \"leave\", \"agents\": [\n"
                 "{\"position\": [1, 2], \"goal\": [3, 2]},\n"
                 "{\"position\": [-1, 2], \"goal\": [3, -2], \"radius\": 0.4, \"preferred_speed\": 0.9, "
                 "\"heading_degrees\": 90}],\n"
                 "\"walls\": [[0, 0, 5, 0]]}",
                 &scene);
    const ff_scene_agent *agents = ff_scene_agents(&scene);
    assert_int_equal(ff_scene_agent_count(&scene), 2);
    FF_ASSERT_NEAR(agents[0].position.a, 2.0, 0.0); /* [x, z] in files, (z, x) inside */
    FF_ASSERT_NEAR(agents[0].position.b, 1.0, 0.0);
    FF_ASSERT_NEAR(agents[0].heading, FF_PI / 2, 1e-12); /* towards +x is left of +z */
    FF_ASSERT_NEAR(agents[0].radius, 0.25, 0.0);
    FF_ASSERT_NEAR(agents[1].radius, 0.4, 0.0);
    FF_ASSERT_NEAR(agents[1].heading, FF_PI / 2, 1e-12);
    FF_ASSERT_NEAR(agents[1].preferred_speed, 0.9, 0.0);
    assert_true(scene.leave);
    FF_ASSERT_NEAR(ff_scene_walls(&scene)->q.b, 5.0, 0.0);
    ff_scene_free(&scene);
}

static void test_the_way_of_navigating_is_read_with_all_its_parts(void **state)
{
    (void)state;
    ff_scene scene;
    ff_crowd_def usual = ff_crowd_def_default();
    walker_scene("{\"kind\": \"circle\"}", &scene);
    assert_int_equal(scene.navigation.method, FF_NAVIGATION_MCN);
    assert_int_equal(scene.navigation.synthesis, usual.synthesis);
    assert_true(scene.navigation.mcn.hull && scene.navigation.mcn.stance && !scene.navigation.mcn.back_pedal);
    FF_ASSERT_NEAR(scene.navigation.keep_right, usual.keep_right, 0.0);
    ff_scene_free(&scene);
    walker_scene(
        "{\"kind\": \"circle\", \"navigation\": \"sf\", \"synthesis\": \"semi-procedural\", "
        "\"speed_variations\": [0.8, 1.1], \"mcn\": "
        "{\"stance\": false, \"back_pedal\": true, "
        "\"facing\": \"strafe\", \"keep_right\": -0.2, \"padding\": 0.1, \"prediction\": 0}, \"baseline\": "
        "{\"keep_right\": 0.3, \"padding\": 0.02, \"model_velocity\": true}}",
        &scene);
    const ff_scene_navigation *navigation = &scene.navigation;
    assert_int_equal(navigation->method, FF_NAVIGATION_SF);
    assert_int_equal(navigation->synthesis, FF_SYNTHESIS_SEMI_PROCEDURAL);
    assert_true(navigation->mcn.hull && !navigation->mcn.stance && navigation->mcn.back_pedal);
    assert_int_equal(navigation->mcn.facing, FF_FACING_STRAFE);
    const double speeds[FF_SPEED_VARIATIONS_MAX] = {0.8, 1.1};
    assert_memory_equal(navigation->speed_variations, speeds, sizeof speeds);
    FF_ASSERT_NEAR(navigation->keep_right, -0.2, 0.0);
    FF_ASSERT_NEAR(navigation->mcn.padding, 0.1, 0.0);
    FF_ASSERT_NEAR(navigation->mcn.prediction, 0.0, 0.0);
    FF_ASSERT_NEAR(navigation->baseline.keep_right, 0.3, 0.0);
    assert_true(navigation->baseline.model_velocity);
    ff_scene_free(&scene);
    walker_scene("{\"kind\": \"custom\", \"agents\": [{\"position\": [0, 0], \"goal\": [1, 1], "
                 "\"navigation\": \"orca\", \"synthesis\": \"hybrid\"}, "
                 "{\"position\": [3, 0], \"goal\": [1, 1]}]}",
                 &scene);
    assert_int_equal(ff_scene_agents(&scene)[0].navigation, FF_NAVIGATION_ORCA);
    assert_int_equal(ff_scene_agents(&scene)[1].navigation, FF_NAVIGATION_CROWD);
    assert_int_equal(ff_scene_agents(&scene)[0].synthesis, FF_SYNTHESIS_HYBRID);
    assert_int_equal(ff_scene_agents(&scene)[1].synthesis, FF_SYNTHESIS_CROWD);
    ff_scene_free(&scene);
}

static void test_every_mistake_is_named_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
        uint32_t line;
    } cases[] = {
        {"{\n}", "kind", 1},
        {"{\"kind\":\n\"cricle\"}", "cricle", 2},
        {"{\"kind\": \"circle\",\n\n\"radious\": 3}", "radious", 3},
        {"{\"kind\": \"circle\",\n\"corridor_width\": 3}", "corridor_width", 2},
        {"{\"kind\": \"circle\",\n\"agents\": 0}", "agents", 2},
        {"{\"kind\": \"circle\",\n\"agents\": 1.5}", "agents", 2},
        {"{\"kind\": \"circle\",\n\"agents\": 1000000000}", "agents", 2},
        {"{\"kind\": \"circle\",\n\"seconds\": -1}", "seconds", 2},
        {"{\"kind\": \"circle\",\n\"seconds\": \"long\"}", "seconds", 2},
        {"{\"kind\": \"circle\",\n\"step\": 5}", "step", 2},
        {"{\"kind\": \"circle\",\n\"at_goal\": \"dance\"}", "dance", 2},
        {"{\"kind\": \"circle\",\n\"walls\": 3}", "walls", 2},
        {"{\"kind\": \"circle\",\n\"walls\": [[1, 2, 3]]}", "wall", 2},
        {"{\"kind\": \"circle\",\n\"walls\": [[1, 2, 1, 2]]}", "wall", 2},
        {"{\"kind\": \"circle\",\n\"walls\": [[1, 2, 3,\n\"x\"]]}", "wall", 3},
        {"{\"kind\": \"circle\",\n\"navigation\": \"rvo\"}", "rvo", 2},
        {"{\"kind\": \"circle\",\n\"navigation\": \"\"}", "navigation", 2},
        {"{\"kind\": \"circle\",\n\"synthesis\": \"motion graph\"}", "semi-procedural", 2},
        {"{\"kind\": \"circle\",\n\"synthesis\": 1}", "synthesis", 2},
        {"{\"kind\": \"circle\",\n\"mcn\": true}", "mcn", 2},
        {"{\"kind\": \"circle\",\n\"mcn\": {\"hulk\": true}}", "hull", 2},
        {"{\"kind\": \"circle\",\n\"mcn\": {\"hull\": 1}}", "hull", 2},
        {"{\"kind\": \"circle\",\n\"mcn\": {\n\"facing\": \"up\"}}", "up", 3},
        {"{\"kind\": \"circle\",\n\"mcn\": {\"padding\": -1}}", "padding", 2},
        {"{\"kind\": \"circle\",\n\"baseline\": {\"stance\": true}}", "stance", 2},
        {"{\"kind\": \"circle\",\n\"planner\": \"feet\"}", "feet", 2},
        {"{\"kind\": \"circle\",\n\"planner\": 2}", "planner", 2},
        {"{\"kind\": \"circle\",\n\"speed_variations\": 2}", "speed_variations", 2},
        {"{\"kind\": \"circle\",\n\"speed_variations\": [0.9, 3]}", "factors", 2},
        {"{\"kind\": \"circle\",\n\"speed_variations\": [1, 1, 1, 1, 1]}", "at most 4", 2},
        {"{\"kind\": \"circle\",\n\"obstacles\": 2}", "obstacles", 2},
        {"{\"kind\": \"circle\",\n\"obstacles\": [{\"radius\": 1}]}", "position", 2},
        {"{\"kind\": \"circle\",\n\"obstacles\": [{\"position\": [0]}]}", "[x, z]", 2},
        {"{\"kind\": \"circle\",\n\"obstacles\": [{\"position\": [0, 0], \"radius\": 0}]}", "size", 2},
        {"{\"kind\": \"circle\",\n\"obstacles\": [{\"path\": [[0, 0, 1],\n[1, 1, 1]]}]}", "rising", 3},
        {"{\"kind\": \"custom\"}", "agents", 1},
        {"{\"kind\": \"custom\",\n\"agents\": []}", "agents", 2},
        {"{\"kind\": \"custom\",\n\"agents\": [\n3]}", "position", 3},
        {"{\"kind\": \"custom\",\n\"agents\": [\n{\"position\": [0, 0]}]}", "goal", 3},
        {"{\"kind\": \"custom\",\n\"agents\": [\n{\"position\": [0, 0], \"goal\":\n[1, 1e9]}]}", "metres", 4},
        {"{\"kind\": \"custom\",\n\"agents\": [{\"position\": [0, 0], \"goal\": [1, 1],\n\"speed\": 2}]}",
         "speed", 3},
        {"{\"kind\": \"circle\",\n\"agents\": }", "JSON", 2},
        {"{\"kind\": \"circle\",\n\"agents\": 3,\n\"agents\": 4}", "agents", 3},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        ff_error error = {0};
        ff_scene_def def;
        ff_status status = ff_scene_def_parse(cases[i].text, strlen(cases[i].text), "bad.json", &def, &error);
        if (status == FF_OK || error.line != cases[i].line || !strstr(error.message, cases[i].says))
            fail_msg("%s\ngives line %u: %s", cases[i].text, error.line, error.message);
        assert_string_equal(error.file, "bad.json");
        ff_scene_def_free(&def);
    }
}

static void test_people_may_not_start_inside_each_other(void **state)
{
    (void)state;
    const char *text = "{\"kind\": \"circle\", \"agents\": 60, \"radius\": 4}";
    ff_error error;
    ff_scene_def def;
    ff_scene scene;
    FF_ASSERT_OK(ff_scene_def_parse(text, strlen(text), "tight.json", &def, &error), error);
    assert_int_equal(ff_scene_create(&def, &scene, &error), FF_ERR_ARGUMENT);
    assert_non_null(strstr(error.message, "inside each other"));
    ff_scene_def_free(&def);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_circle_sends_everyone_to_the_opposite_side),
        cmocka_unit_test(test_a_two_way_crossing_is_two_blocks_at_a_right_angle),
        cmocka_unit_test(test_a_bidirectional_crowd_starts_inside_its_corridor),
        cmocka_unit_test(test_a_four_way_crossing_starts_in_the_corners_of_its_square),
        cmocka_unit_test(test_seeds_change_where_people_start_and_equal_seeds_do_not),
        cmocka_unit_test(test_speeds_spread_about_the_preferred_speed),
        cmocka_unit_test(test_a_custom_scene_is_taken_as_it_stands),
        cmocka_unit_test(test_the_way_of_navigating_is_read_with_all_its_parts),
        cmocka_unit_test(test_every_mistake_is_named_with_its_line),
        cmocka_unit_test(test_people_may_not_start_inside_each_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
