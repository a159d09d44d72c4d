#include "runtime/program/footstep_scenes.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/maths.h"

#include <stdio.h>

#define STEP (1.0 / 60.0)
enum { SHOTS = 3, OBSTACLES_MOST = 2 };

typedef struct figure_scene {
    const char *file, *title;
    const char *when[SHOTS];
    double at[SHOTS]; /* s */
    ff_obstacle_def obstacles[OBSTACLES_MOST];
    uint32_t obstacle_count;
    double wall_comes; /* s: when the last obstacle is put to wall, or INFINITY */
    ff_vec2 wall;
} figure_scene;

static figure_scene two_blocks(void)
{
    figure_scene s = {.file = "fig7.png",
                      .title = "Two obstacles on known paths",
                      .when = {"before", "letting one pass", "past both"},
                      .at = {1.2, 3.4, 6.0},
                      .obstacle_count = 2,
                      .wall_comes = INFINITY};
    for (int i = 0; i < 2; ++i) {
        double side = i == 0 ? 1.0 : -1.0, ahead = i == 0 ? -0.8 : 1.4;
        s.obstacles[i] = ff_obstacle_def_default();
        s.obstacles[i].kind = FF_OBSTACLE_PATH;
        s.obstacles[i].half_length = s.obstacles[i].half_width = 0.3;
        s.obstacles[i].path[0] = (ff_obstacle_point){0.0, ff_v2(ahead, 2.6 * side)};
        s.obstacles[i].path[1] = (ff_obstacle_point){6.5, ff_v2(ahead, -2.6 * side)};
        s.obstacles[i].path_count = 2;
    }
    return s;
}

static figure_scene moved_wall(void)
{
    figure_scene s = {.file = "fig8.png",
                      .title = "A wall that nobody foresaw",
                      .when = {"before", "it has come", "round it"},
                      .at = {2.2, 3.0, 6.5},
                      .obstacle_count = 1,
                      .wall_comes = 2.3,
                      .wall = {0.4, 0.2}};
    s.obstacles[0] = ff_obstacle_def_default();
    s.obstacles[0].kind = FF_OBSTACLE_FREE;
    s.obstacles[0].position = ff_v2(0.4, 3.0);
    s.obstacles[0].half_width = 1.0;
    s.obstacles[0].radius = 0.06;
    return s;
}

static ff_status look(const figure_scene *s, const ff_crowd *crowd, ff_agent agent, ff_plan_scene *shot,
                      ff_error *error)
{
    shot->shapes.count = 0;
    for (uint32_t i = 0; i < s->obstacle_count; ++i) {
        const ff_obstacle_def *def = &s->obstacles[i];
        ff_drawn_shape *shape = ff_array_grow(&shot->shapes, 1, sizeof *shape);
        if (!shape) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a picture");
        *shape = (ff_drawn_shape){.half_length = def->half_length,
                                  .half_width = def->half_width,
                                  .radius = def->radius,
                                  .kind = def->kind};
        ff_status status = ff_crowd_obstacle_place(crowd, i, &shape->centre, &shape->heading, error);
        if (status != FF_OK) return status;
    }
    return ff_plan_scene_look(shot, crowd, &agent, 1, error);
}

static ff_status walk(const figure_scene *s, ff_crowd *crowd, ff_plan_scene *shots, ff_error *error)
{
    ff_agent_def def = ff_agent_def_default();
    ff_agent agent;
    def.position = ff_v2(-3.6, 0.0);
    def.goal = ff_v2(3.6, 0.0);
    ff_status status = ff_crowd_add_agent(crowd, &def, &agent, error);
    for (uint32_t i = 0; i < s->obstacle_count && status == FF_OK; ++i)
        status = ff_crowd_add_obstacle(crowd, &s->obstacles[i], NULL, error);
    for (int step = 0; step * STEP <= s->at[SHOTS - 1] && status == FF_OK; ++step) {
        if (step * STEP >= s->wall_comes)
            status = ff_crowd_move_obstacle(crowd, s->obstacle_count - 1, s->wall, 0.0, error);
        ff_crowd_step(crowd);
        for (int i = 0; i < SHOTS && status == FF_OK; ++i)
            if (step * STEP <= s->at[i]) status = look(s, crowd, agent, &shots[i], error);
    }
    return status;
}

static ff_status draw(const ff_pack *pack, const figure_scene *s, const char *folder, ff_error *error)
{
    ff_plan_scene shots[SHOTS] = {{0}};
    ff_crowd *crowd = NULL;
    ff_crowd_def def = ff_crowd_def_default();
    char path[4096];
    def.max_agents = 1;
    def.step = STEP;
    def.planner = FF_PLANNER_FOOTSTEPS;
    for (int i = 0; i < SHOTS; ++i) {
        shots[i].title = s->title;
        shots[i].subtitle = s->when[i];
    }
    snprintf(path, sizeof path, "%s/%s", folder, s->file);
    ff_status status = ff_crowd_create(pack, &def, &crowd, error);
    if (status == FF_OK) status = walk(s, crowd, shots, error);
    if (status == FF_OK) status = ff_plan_picture_write(path, shots, SHOTS, error);
    for (int i = 0; i < SHOTS; ++i)
        ff_plan_scene_free(&shots[i]);
    ff_crowd_destroy(crowd);
    return status;
}

ff_status ff_footstep_scenes_draw(const ff_pack *pack, const char *folder, ff_error *error)
{
    figure_scene blocks = two_blocks(), wall = moved_wall();
    ff_status status = draw(pack, &blocks, folder, error);
    return status == FF_OK ? draw(pack, &wall, folder, error) : status;
}
