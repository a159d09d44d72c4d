/* scene_layout.c - the benchmark layouts: FbCrowd's four scenes, with the sizes of the navigation study, section 2
 * (tight enough that methods differ), all settable. */
#include "runtime/core/base/fail.h"
#include "runtime/core/base/random.h"
#include "runtime/export/scene.h"

#include <string.h>

enum { STREAM_PLACE = 1, STREAM_SPEED = 2 };

static double given(double value, double usual)
{
    return isnan(value) ? usual : value;
}

static ff_status add_agent(const ff_scene_def *def, ff_scene *scene, ff_vec2 position, ff_vec2 goal,
                           uint32_t group, ff_error *error)
{
    ff_scene_agent *agent = ff_array_grow(&scene->agents, 1, sizeof *agent);
    if (!agent) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %lld agents", (long long)def->agents);
    ff_random random = {def->seed, STREAM_SPEED, (scene->agents.count - 1) * 16};
    double offset = ff_clamp(ff_random_normal(&random), -2.0, 2.0) * def->speed_spread;
    ff_vec2 way = ff_sub2(goal, position);
    *agent = (ff_scene_agent){.position = position,
                              .goal = goal,
                              .heading = ff_atan2(way.b, way.a),
                              .preferred_speed = ff_max(0.3, def->preferred_speed + offset),
                              .radius = def->agent_radius,
                              .goal_tolerance = def->goal_tolerance,
                              .group = group,
                              .machine = def->machine};
    return FF_OK;
}

static ff_status place_circle(const ff_scene_def *def, ff_scene *scene, ff_error *error)
{
    uint32_t count = (uint32_t)def->agents;
    double radius = given(def->radius, ff_max(4.0, 0.16 * count));
    double jitter = given(def->jitter, ff_min(0.01 * radius, 0.15)) / radius;
    for (uint32_t i = 0; i < count; ++i) {
        ff_random random = {def->seed, STREAM_PLACE, i};
        double angle = FF_TAU * i / count + ff_random_range(&random, -jitter, jitter);
        ff_vec2 place = ff_scale2(ff_fwd2(angle), radius);
        ff_status status = add_agent(def, scene, place, ff_scale2(place, -1.0), i, error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}

/* A block of `count` people in rows of `columns`, facing `heading`, all walking `travel`; the middle of its front
 * row, or of the whole block, stands at `at`. */
typedef struct block {
    uint32_t count, columns, group;
    ff_vec2 at;
    double heading, travel, spacing, jitter;
    bool at_is_front;
} block;

static ff_status place_block(const ff_scene_def *def, const block *shape, ff_scene *scene, ff_error *error)
{
    uint32_t rows = (shape->count + shape->columns - 1) / shape->columns;
    ff_vec2 forward = ff_fwd2(shape->heading), left = ff_left2(forward);
    double middle = shape->at_is_front ? 0.0 : 0.5 * (rows - 1);
    for (uint32_t i = 0; i < shape->count; ++i) {
        uint32_t row = i / shape->columns, column = i % shape->columns;
        uint32_t in_row = row + 1 < rows ? shape->columns : shape->count - row * shape->columns;
        ff_random random = {def->seed, STREAM_PLACE + 16 * (1 + shape->group), 2 * (uint64_t)i};
        double ahead =
            (middle - row) * shape->spacing + ff_random_range(&random, -shape->jitter, shape->jitter);
        double aside = (column - 0.5 * (in_row - 1)) * shape->spacing +
                       ff_random_range(&random, -shape->jitter, shape->jitter);
        ff_vec2 place = ff_madd2(ff_madd2(shape->at, forward, ahead), left, aside);
        ff_vec2 goal = ff_madd2(place, forward, shape->travel);
        ff_status status = add_agent(def, scene, place, goal, shape->group, error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}

static ff_status place_two_way(const ff_scene_def *def, ff_scene *scene, ff_error *error)
{
    uint32_t count = (uint32_t)def->agents, half = (count + 1) / 2;
    double distance = given(def->distance, 10.0);
    block shape = {.columns = (uint32_t)ff_max(1.0, floor(sqrt(half * 5.0 / 3.0) + 0.5)),
                   .travel = 2.0 * distance,
                   .spacing = given(def->spacing, 0.66),
                   .jitter = given(def->jitter, 0.02)};
    for (uint32_t g = 0; g < 2; ++g) {
        shape.count = g == 0 ? half : count - half;
        shape.group = g;
        shape.heading = g == 0 ? 0.0 : 0.5 * FF_PI;
        shape.at = ff_scale2(ff_fwd2(shape.heading), -distance);
        ff_status status = place_block(def, &shape, scene, error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}

static ff_status add_wall(ff_scene *scene, ff_vec2 p, ff_vec2 q, ff_error *error)
{
    ff_scene_wall *wall = ff_array_grow(&scene->walls, 1, sizeof *wall);
    if (!wall) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for walls");
    *wall = (ff_scene_wall){p, q};
    return FF_OK;
}

static ff_status place_bidirectional(const ff_scene_def *def, ff_scene *scene, ff_error *error)
{
    uint32_t count = (uint32_t)def->agents, half = (count + 1) / 2;
    double width = given(def->corridor_width, 4.0), gap = given(def->distance, 14.0);
    double spacing = given(def->spacing, 0.9), jitter = given(def->jitter, 0.05);
    double room = width - 2.0 * (def->agent_radius + jitter);
    uint32_t columns = (uint32_t)ff_max(1.0, floor(room / spacing + 1e-9) + 1.0);
    uint32_t rows = (half + columns - 1) / columns;
    double depth = rows * spacing;
    double length = given(def->corridor_length, gap + 2.0 * depth + 4.0);
    block shape = {
        .columns = columns, .travel = gap + depth, .spacing = spacing, .jitter = jitter, .at_is_front = true};
    for (uint32_t g = 0; g < 2; ++g) {
        shape.count = g == 0 ? half : count - half;
        shape.group = g;
        shape.heading = g == 0 ? 0.0 : FF_PI;
        shape.at = ff_v2(g == 0 ? -0.5 * gap : 0.5 * gap, 0.0);
        ff_status status = place_block(def, &shape, scene, error);
        if (status != FF_OK) return status;
    }
    for (int side = -1; side <= 1; side += 2) {
        double b = 0.5 * width * side;
        ff_status status = add_wall(scene, ff_v2(-0.5 * length, b), ff_v2(0.5 * length, b), error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}

static ff_status place_four_way(const ff_scene_def *def, ff_scene *scene, ff_error *error)
{
    uint32_t count = (uint32_t)def->agents;
    double square = given(def->square, 24.0);
    for (uint32_t g = 0; g < 4; ++g) {
        block shape = {.count = count / 4 + (g < count % 4),
                       .group = g,
                       .heading = FF_PI * (0.25 + 0.5 * g),
                       .travel = square * sqrt(2.0),
                       .spacing = given(def->spacing, 1.11),
                       .jitter = given(def->jitter, 0.125)};
        if (shape.count == 0) continue;
        shape.columns = (uint32_t)ceil(sqrt(shape.count));
        shape.at = ff_scale2(ff_fwd2(shape.heading), -0.5 * shape.travel);
        ff_status status = place_block(def, &shape, scene, error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}

static ff_status place_fixed(const ff_scene_def *def, ff_scene *scene, ff_error *error)
{
    if (def->fixed.count == 0) return FF_OK;
    ff_scene_agent *agents = ff_array_grow(&scene->agents, def->fixed.count, sizeof *agents);
    if (!agents) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu agents", def->fixed.count);
    memcpy(agents, def->fixed.data, def->fixed.count * sizeof *agents);
    return FF_OK;
}

static ff_status check_apart(const ff_scene *scene, ff_error *error)
{
    const ff_scene_agent *agents = ff_scene_agents(scene);
    for (uint32_t i = 0; i < scene->agents.count; ++i)
        for (uint32_t j = 0; j < i; ++j) {
            double apart = ff_length2(ff_sub2(agents[i].position, agents[j].position));
            if (apart < agents[i].radius + agents[j].radius)
                return ff_fail(
                    error, FF_ERR_ARGUMENT,
                    "agents %u and %u would start %.2f m apart, inside each other (radii %.2f and %.2f "
                    "m): use more room or fewer agents",
                    j, i, apart, agents[j].radius, agents[i].radius);
        }
    return FF_OK;
}

ff_status ff_scene_create(const ff_scene_def *def, ff_scene *out, ff_error *error)
{
    static ff_status (*const place[FF_SCENE_KIND_COUNT])(const ff_scene_def *, ff_scene *, ff_error *) = {
        place_circle, place_two_way, place_bidirectional, place_four_way, place_fixed};
    memset(out, 0, sizeof *out);
    out->kind = def->kind;
    memcpy(out->title, def->title, sizeof out->title);
    out->seconds = def->seconds;
    out->step = def->step;
    out->seed = def->seed;
    out->leave = def->leave;
    out->navigation = def->navigation;
    const ff_scene_wall *walls = def->walls.data;
    ff_status status = FF_OK;
    for (size_t i = 0; i < def->walls.count && status == FF_OK; ++i)
        status = add_wall(out, walls[i].p, walls[i].q, error);
    const ff_obstacle_def *obstacles = def->obstacles.data;
    for (size_t i = 0; i < def->obstacles.count && status == FF_OK; ++i) {
        ff_obstacle_def *copy = ff_array_grow(&out->obstacles, 1, sizeof *copy);
        if (copy)
            *copy = obstacles[i];
        else
            status = ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu obstacles", def->obstacles.count);
    }
    if (status == FF_OK) status = ff_scene_behaviour_copy(&def->behaviour, &out->behaviour, error);
    if (status == FF_OK) status = place[def->kind](def, out, error);
    if (status == FF_OK) status = ff_scene_place_people(def, out, error);
    if (status == FF_OK) status = check_apart(out, error);
    if (status != FF_OK) ff_scene_free(out);
    return status;
}

void ff_scene_free(ff_scene *scene)
{
    ff_array_free(&scene->agents);
    ff_array_free(&scene->walls);
    ff_array_free(&scene->obstacles);
    ff_scene_behaviour_free(&scene->behaviour);
    memset(scene, 0, sizeof *scene);
}
