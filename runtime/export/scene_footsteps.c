/* scene_footsteps.c - the keys of a scene that have to do with footsteps: who plans them, on which way, past what. */
#include "runtime/core/base/fail.h"
#include "runtime/core/base/maths.h"
#include "runtime/export/scene.h"

#include <string.h>

#define WORLD_MOST 10000.0 /* m */
#define SIZE_MOST 1000.0

/* Go on only while nothing went wrong. */
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if (status == FF_OK) status = (call);                                                                \
    } while (0)

static ff_status read_point(const ff_json *json, const json_t *value, const char *what, ff_vec2 *out,
                            ff_error *error)
{
    double place[2] = {NAN, NAN};
    for (size_t i = 0; i < 2 && json_array_size(value) == 2; ++i)
        if (json_is_number(json_array_get(value, i))) place[i] = json_number_value(json_array_get(value, i));
    if (!(fabs(place[0]) <= WORLD_MOST && fabs(place[1]) <= WORLD_MOST))
        return ff_json_fail(json, value, error, "%s is [x, z], within %g m", what, WORLD_MOST);
    *out = ff_v2(place[1], place[0]);
    return FF_OK;
}

ff_status ff_scene_planner_read(const ff_json *json, const json_t *object, ff_planner *out, ff_error *error)
{
    const char *name = NULL;
    ff_status status = ff_json_string(json, object, "planner", &name, error);
    if (status != FF_OK || !name) return status;
    if (strcmp(name, "velocity") == 0)
        *out = FF_PLANNER_VELOCITY;
    else if (strcmp(name, "footsteps") == 0)
        *out = FF_PLANNER_FOOTSTEPS;
    else
        return ff_json_fail_key(json, object, "planner", error,
                                "planner is \"%s\"; it can be \"velocity\" or \"footsteps\"", name);
    return FF_OK;
}

ff_status ff_scene_speeds_read(const ff_json *json, double out[FF_SPEED_VARIATIONS_MAX], ff_error *error)
{
    const json_t *list = json_object_get(json->root, "speed_variations");
    if (!list) return FF_OK;
    size_t count = json_array_size(list);
    bool good = json_is_array(list) && count <= FF_SPEED_VARIATIONS_MAX;
    for (size_t i = 0; i < count && good; ++i) {
        const json_t *factor = json_array_get(list, i);
        good = json_is_number(factor) && json_number_value(factor) >= 0.5 && json_number_value(factor) <= 1.5;
        if (good) out[i] = json_number_value(factor);
    }
    if (good) return FF_OK;
    return ff_json_fail_key(json, json->root, "speed_variations", error,
                            "speed_variations is a list of at most %d factors, 0.5 to 1.5",
                            FF_SPEED_VARIATIONS_MAX);
}

ff_status ff_scene_waypoints_read(const ff_json *json, const json_t *object, ff_scene_agent *out,
                                  ff_error *error)
{
    const json_t *list = json_object_get(object, "waypoints");
    if (!list) return FF_OK;
    size_t count = json_array_size(list);
    if (!json_is_array(list) || count > FF_WAYPOINTS_MAX)
        return ff_json_fail_key(json, object, "waypoints", error,
                                "waypoints is a list of at most %d places [x, z]", FF_WAYPOINTS_MAX);
    for (size_t i = 0; i < count; ++i) {
        ff_status status = read_point(json, json_array_get(list, i), "a waypoint", &out->waypoints[i], error);
        if (status != FF_OK) return status;
    }
    out->waypoint_count = (uint32_t)count;
    return FF_OK;
}

/* [x, z, s] */
static ff_status read_path(const ff_json *json, const json_t *object, ff_obstacle_def *out, ff_error *error)
{
    const json_t *list = json_object_get(object, "path");
    if (!list) return FF_OK;
    size_t count = json_array_size(list);
    if (!json_is_array(list) || count < 1 || count > FF_OBSTACLE_POINTS_MAX)
        return ff_json_fail_key(json, object, "path", error,
                                "path is a list of 1 to %d moments [x, z, seconds]", FF_OBSTACLE_POINTS_MAX);
    double before = -1.0;
    for (size_t i = 0; i < count; ++i) {
        const json_t *item = json_array_get(list, i);
        double number[3] = {NAN, NAN, NAN};
        for (size_t k = 0; k < 3 && json_array_size(item) == 3; ++k)
            if (json_is_number(json_array_get(item, k)))
                number[k] = json_number_value(json_array_get(item, k));
        bool good = fabs(number[0]) <= WORLD_MOST && fabs(number[1]) <= WORLD_MOST && number[2] >= 0.0 &&
                    number[2] > before && number[2] <= 1e5;
        if (!good)
            return ff_json_fail(json, item, error,
                                "a moment of a path is [x, z, seconds], the seconds rising from 0 on");
        before = number[2];
        out->path[i] = (ff_obstacle_point){number[2], ff_v2(number[1], number[0])};
    }
    out->kind = FF_OBSTACLE_PATH;
    out->path_count = (uint32_t)count;
    return FF_OK;
}

static ff_status read_obstacle(const ff_json *json, const json_t *object, ff_obstacle_def *out,
                               ff_error *error)
{
    static const char *const keys[] = {"position", "heading_degrees", "length", "width",  "radius", "low",
                                       "high",     "round",           "path",   "cyclic", "start",  NULL};
    if (!json_is_object(object))
        return ff_json_fail(json, object, error,
                            "an obstacle is {\"position\": [x, z], \"radius\": ..., ...}");
    double degrees = 0.0, length = 0.0, width = 0.0;
    *out = ff_obstacle_def_default();
    ff_status status = ff_json_only_keys(json, object, keys, error);
    const json_t *place = json_object_get(object, "position");
    if (status == FF_OK && !place && !json_object_get(object, "path"))
        return ff_json_fail(json, object, error, "an obstacle needs a \"position\": [x, z] or a \"path\"");
    if (place) TRY(read_point(json, place, "a position", &out->position, error));
    TRY(ff_json_number(json, object, "heading_degrees", -360.0, 360.0, &degrees, error));
    TRY(ff_json_number(json, object, "length", 0.0, SIZE_MOST, &length, error));
    TRY(ff_json_number(json, object, "width", 0.0, SIZE_MOST, &width, error));
    if (length > 0.0 || width > 0.0) out->radius = 0.0;
    TRY(ff_json_number(json, object, "radius", 0.0, SIZE_MOST, &out->radius, error));
    TRY(ff_json_number(json, object, "low", 0.0, SIZE_MOST, &out->low, error));
    TRY(ff_json_number(json, object, "high", 0.01, SIZE_MOST, &out->high, error));
    TRY(ff_json_bool(json, object, "round", &out->round, error));
    TRY(read_path(json, object, out, error));
    TRY(ff_json_bool(json, object, "cyclic", &out->cyclic, error));
    TRY(ff_json_number(json, object, "start", 0.0, 1e5, &out->start, error));
    out->heading = degrees * FF_DEG;
    out->half_length = 0.5 * length;
    out->half_width = 0.5 * width;
    if (status == FF_OK && (ff_max(ff_max(length, width), out->radius) < 0.01 || out->high <= out->low))
        return ff_json_fail(json, object, error, "an obstacle has a size, and is higher than low");
    return status;
}
#undef TRY

ff_status ff_scene_obstacles_read(const ff_json *json, ff_array *out, ff_error *error)
{
    enum { MOST = 1000 };
    const json_t *list = json_object_get(json->root, "obstacles");
    if (!list) return FF_OK;
    if (!json_is_array(list) || json_array_size(list) > MOST)
        return ff_json_fail_key(json, json->root, "obstacles", error,
                                "obstacles is a list of at most %d objects", MOST);
    for (size_t i = 0; i < json_array_size(list); ++i) {
        ff_obstacle_def *obstacle = ff_array_grow(out, 1, sizeof *obstacle);
        if (!obstacle)
            return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu obstacles", json_array_size(list));
        ff_status status = read_obstacle(json, json_array_get(list, i), obstacle, error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}
