#include "runtime/export/scene.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/maths.h"

#include <stdio.h>
#include <string.h>

#define AGENTS_MOST 20000
#define WORLD_MOST 10000.0 /* m */

static const char *const kind_names[FF_SCENE_KIND_COUNT] = {"circle", "two_way", "bidirectional", "four_way",
                                                            "custom"};

const char *ff_scene_kind_name(ff_scene_kind kind)
{
    return kind_names[kind];
}

#define COMMON_KEYS                                                                                          \
    "kind", "title", "seconds", "step", "seed", "at_goal", "agents", "agent_radius", "preferred_speed",      \
        "preferred_speed_spread", "goal_tolerance", "walls", "navigation", "synthesis", "body_scale", "mcn", \
        "baseline", "planner", "speed_variations", "obstacles", "goals", "regions", "signals", "variables",  \
        "behaviours", "behaviour", "groups", "spawners"

static const char *const circle_keys[] = {COMMON_KEYS, "radius", "jitter", NULL};
static const char *const two_way_keys[] = {COMMON_KEYS, "spacing", "jitter", "distance", NULL};
static const char *const bidirectional_keys[] = {COMMON_KEYS,      "spacing",         "jitter", "distance",
                                                 "corridor_width", "corridor_length", NULL};
static const char *const four_way_keys[] = {COMMON_KEYS, "spacing", "jitter", "square", NULL};
static const char *const custom_keys[] = {COMMON_KEYS, NULL};
static const char *const *const kind_keys[FF_SCENE_KIND_COUNT] = {
    circle_keys, two_way_keys, bidirectional_keys, four_way_keys, custom_keys};
static const char *const agent_keys[] = {
    "position",  "goal",      "heading_degrees", "preferred_speed", "radius", "navigation",
    "synthesis", "behaviour", "planner",         "waypoints",       NULL};

static ff_status read_kind(const ff_json *json, ff_scene_def *def, ff_error *error)
{
    const char *kind = NULL;
    ff_status status = ff_json_string(json, json->root, "kind", &kind, error);
    if (status != FF_OK) return status;
    if (!kind)
        return ff_json_fail(json, json->root, error,
                            "a scene needs \"kind\": circle, two_way, bidirectional, four_way or custom");
    for (int k = 0; k < FF_SCENE_KIND_COUNT; ++k) {
        if (strcmp(kind, kind_names[k]) == 0) {
            def->kind = (ff_scene_kind)k;
            return FF_OK;
        }
    }
    return ff_json_fail(json, json_object_get(json->root, "kind"), error,
                        "kind is \"%s\"; circle, two_way, bidirectional, four_way and custom are known",
                        kind);
}

/* Go on only while nothing went wrong. */
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if (status == FF_OK) status = (call);                                                                \
    } while (0)

static ff_status read_common(const ff_json *json, ff_scene_def *def, ff_error *error)
{
    const json_t *root = json->root;
    const char *title = NULL, *at_goal = "stay";
    int64_t seed = 1;
    ff_status status = FF_OK;
    TRY(ff_json_string(json, root, "title", &title, error));
    TRY(ff_json_string(json, root, "at_goal", &at_goal, error));
    TRY(ff_json_integer(json, root, "seed", 0, INT64_MAX, &seed, error));
    TRY(ff_json_number(json, root, "seconds", 0.1, 3600.0, &def->seconds, error));
    TRY(ff_json_number(json, root, "step", 0.001, 0.1, &def->step, error));
    TRY(ff_json_number(json, root, "agent_radius", 0.1, 1.0, &def->agent_radius, error));
    TRY(ff_json_number(json, root, "preferred_speed", 0.1, 5.0, &def->preferred_speed, error));
    TRY(ff_json_number(json, root, "preferred_speed_spread", 0.0, 1.0, &def->speed_spread, error));
    TRY(ff_json_number(json, root, "goal_tolerance", 0.05, 5.0, &def->goal_tolerance, error));
    if (status != FF_OK) return status;
    if (strcmp(at_goal, "stay") != 0 && strcmp(at_goal, "leave") != 0)
        return ff_json_fail(json, json_object_get(root, "at_goal"), error,
                            "at_goal is \"%s\"; it can be \"stay\" or \"leave\"", at_goal);
    snprintf(def->title, sizeof def->title, "%s", title ? title : "");
    def->leave = strcmp(at_goal, "leave") == 0;
    def->seed = (uint64_t)seed;
    return FF_OK;
}

static ff_status read_sizes(const ff_json *json, ff_scene_def *def, ff_error *error)
{
    const json_t *root = json->root;
    ff_status status = FF_OK;
    if (def->kind != FF_SCENE_CUSTOM)
        TRY(ff_json_integer(json, root, "agents", 1, AGENTS_MOST, &def->agents, error));
    TRY(ff_json_number(json, root, "radius", 1.0, WORLD_MOST, &def->radius, error));
    TRY(ff_json_number(json, root, "spacing", 0.2, 100.0, &def->spacing, error));
    TRY(ff_json_number(json, root, "jitter", 0.0, 10.0, &def->jitter, error));
    TRY(ff_json_number(json, root, "distance", 1.0, WORLD_MOST, &def->distance, error));
    TRY(ff_json_number(json, root, "square", 2.0, WORLD_MOST, &def->square, error));
    TRY(ff_json_number(json, root, "corridor_width", 1.0, 1000.0, &def->corridor_width, error));
    TRY(ff_json_number(json, root, "corridor_length", 1.0, WORLD_MOST, &def->corridor_length, error));
    return status;
}

/* An array of `count` numbers in metres. */
static ff_status read_numbers(const ff_json *json, const json_t *value, size_t count, const char *what,
                              double *out, ff_error *error)
{
    if (!json_is_array(value) || json_array_size(value) != count)
        return ff_json_fail(json, value, error, "expected %s", what);
    for (size_t i = 0; i < count; ++i) {
        const json_t *item = json_array_get(value, i);
        out[i] = json_number_value(item);
        if (!json_is_number(item) || !(fabs(out[i]) <= WORLD_MOST))
            return ff_json_fail(json, item, error, "expected %s, each a number of metres up to %g", what,
                                WORLD_MOST);
    }
    return FF_OK;
}

static ff_status read_walls(const ff_json *json, ff_scene_def *def, ff_error *error)
{
    const json_t *walls = json_object_get(json->root, "walls");
    if (!walls) return FF_OK;
    if (!json_is_array(walls)) return ff_json_fail(json, walls, error, "walls is a list of [x1, z1, x2, z2]");
    for (size_t i = 0; i < json_array_size(walls); ++i) {
        const json_t *item = json_array_get(walls, i);
        double ends[4];
        ff_status status = read_numbers(json, item, 4, "a wall as [x1, z1, x2, z2]", ends, error);
        if (status != FF_OK) return status;
        if (ends[0] == ends[2] && ends[1] == ends[3])
            return ff_json_fail(json, item, error, "a wall needs two different ends");
        ff_scene_wall *wall = ff_array_grow(&def->walls, 1, sizeof *wall);
        if (!wall) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for walls");
        *wall = (ff_scene_wall){ff_v2(ends[1], ends[0]), ff_v2(ends[3], ends[2])};
    }
    return FF_OK;
}

static ff_status read_place(const ff_json *json, const json_t *object, const char *key, ff_vec2 *out,
                            ff_error *error)
{
    const json_t *value = json_object_get(object, key);
    if (!value) return ff_json_fail(json, object, error, "an agent needs \"%s\": [x, z]", key);
    double place[2];
    ff_status status = read_numbers(json, value, 2, "a place as [x, z]", place, error);
    if (status == FF_OK) *out = ff_v2(place[1], place[0]);
    return status;
}

static ff_status read_agent(const ff_json *json, const json_t *object, const ff_scene_def *def,
                            ff_scene_agent *out, ff_error *error)
{
    if (!json_is_object(object))
        return ff_json_fail(json, object, error, "an agent is {\"position\": [x, z], \"goal\": [x, z], ...}");
    double degrees = NAN;
    *out = (ff_scene_agent){.preferred_speed = def->preferred_speed,
                            .radius = def->agent_radius,
                            .goal_tolerance = def->goal_tolerance,
                            .machine = def->machine};
    ff_status status = ff_json_only_keys(json, object, agent_keys, error);
    TRY(read_place(json, object, "position", &out->position, error));
    TRY(ff_scene_machine_read(json, object, &def->behaviour, &out->machine, error));
    out->goal = out->position;
    if (out->machine == FF_NONE || json_object_get(object, "goal"))
        TRY(read_place(json, object, "goal", &out->goal, error));
    TRY(ff_json_number(json, object, "heading_degrees", -360.0, 360.0, &degrees, error));
    TRY(ff_json_number(json, object, "preferred_speed", 0.1, 5.0, &out->preferred_speed, error));
    TRY(ff_json_number(json, object, "radius", 0.1, 1.0, &out->radius, error));
    TRY(ff_scene_method_read(json, object, &out->navigation, error));
    TRY(ff_scene_synthesis_read(json, object, &out->synthesis, error));
    TRY(ff_scene_planner_read(json, object, &out->planner, error));
    TRY(ff_scene_waypoints_read(json, object, out, error));
    ff_vec2 way = ff_sub2(out->goal, out->position);
    out->heading = isfinite(degrees) ? degrees * FF_DEG : ff_atan2(way.b, way.a);
    return status;
}

static ff_status read_fixed(const ff_json *json, ff_scene_def *def, ff_error *error)
{
    const json_t *agents = json_object_get(json->root, "agents");
    size_t count = json_array_size(agents);
    bool others = def->crowds.count + def->behaviour.spawners.count > 0;
    if (!agents && others) return FF_OK;
    if (!json_is_array(agents) || count == 0 || count > AGENTS_MOST)
        return ff_json_fail(json, agents ? agents : json->root, error,
                            "a custom scene needs \"agents\": a list of 1 to %d {\"position\": [x, z], "
                            "\"goal\": [x, z]}; or \"groups\" or \"spawners\"",
                            AGENTS_MOST);
    for (size_t i = 0; i < count; ++i) {
        ff_scene_agent *agent = ff_array_grow(&def->fixed, 1, sizeof *agent);
        if (!agent) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu agents", count);
        ff_status status = read_agent(json, json_array_get(agents, i), def, agent, error);
        if (status != FF_OK) return status;
        agent->group = (uint32_t)i;
    }
    def->agents = (int64_t)count;
    return FF_OK;
}

static ff_status read_behaviour(const ff_json *json, ff_scene_def *def, ff_error *error)
{
    const ff_scene_usual usual = {def->preferred_speed, def->speed_spread, def->agent_radius};
    ff_status status = ff_scene_behaviour_read(json, &usual, &def->behaviour, &def->crowds, error);
    TRY(ff_scene_machine_read(json, json->root, &def->behaviour, &def->machine, error));
    return status;
}

static ff_status read_scene(const ff_json *json, ff_scene_def *def, ff_error *error)
{
    ff_status status = read_kind(json, def, error);
    TRY(ff_json_only_keys(json, json->root, kind_keys[def->kind], error));
    TRY(read_common(json, def, error));
    TRY(ff_scene_navigation_read(json, &def->navigation, error));
    TRY(read_sizes(json, def, error));
    TRY(read_walls(json, def, error));
    TRY(ff_scene_obstacles_read(json, &def->obstacles, error));
    TRY(read_behaviour(json, def, error));
    if (def->kind == FF_SCENE_CUSTOM) TRY(read_fixed(json, def, error));
    return status;
}
#undef TRY

ff_scene_def ff_scene_def_default(ff_scene_kind kind)
{
    static const int64_t usual_agents[FF_SCENE_KIND_COUNT] = {17, 30, 53, 100, 0};
    return (ff_scene_def){.kind = kind,
                          .seconds = 60.0,
                          .step = 1.0 / 30.0,
                          .seed = 1,
                          .navigation = ff_scene_navigation_default(),
                          .agents = usual_agents[kind],
                          .agent_radius = 0.3,
                          .preferred_speed = 1.3,
                          .goal_tolerance = 0.5,
                          .machine = FF_NONE,
                          .radius = NAN,
                          .spacing = NAN,
                          .jitter = NAN,
                          .distance = NAN,
                          .square = NAN,
                          .corridor_width = NAN,
                          .corridor_length = NAN};
}

static ff_status finish(ff_status loaded, ff_json *json, ff_scene_def *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    if (loaded != FF_OK) return loaded;
    ff_status status = read_kind(json, out, error);
    if (status == FF_OK) {
        *out = ff_scene_def_default(out->kind);
        status = read_scene(json, out, error);
    }
    if (status != FF_OK) ff_scene_def_free(out);
    ff_json_free(json);
    return status;
}

ff_status ff_scene_def_load(const char *path, ff_scene_def *out, ff_error *error)
{
    ff_json json;
    ff_status status = ff_json_load(path, &json, error);
    return finish(status, &json, out, error);
}

ff_status ff_scene_def_parse(const char *text, size_t size, const char *name, ff_scene_def *out,
                             ff_error *error)
{
    ff_json json;
    ff_status status = ff_json_parse(text, size, name, &json, error);
    return finish(status, &json, out, error);
}

void ff_scene_def_free(ff_scene_def *def)
{
    ff_array_free(&def->walls);
    ff_array_free(&def->obstacles);
    ff_array_free(&def->fixed);
    ff_array_free(&def->crowds);
    ff_scene_behaviour_free(&def->behaviour);
    memset(def, 0, sizeof *def);
}
