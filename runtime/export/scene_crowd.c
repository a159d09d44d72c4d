#include "runtime/export/scene_crowd.h"

#include <string.h>

#define FF_SCENE_OBSTACLE_WALLS 8 /* that velocity navigation sees of one, at most */

ff_crowd_def ff_scene_crowd_def(const ff_scene *scene, ff_behaviour_def *behaviour)
{
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = scene->most;
    def.max_walls = ff_scene_wall_count(scene);
    def.step = scene->step;
    def.seed = scene->seed;
    def.keep_right = scene->navigation.keep_right;
    def.navigation = scene->navigation.method;
    def.synthesis = scene->navigation.synthesis;
    def.planner = scene->navigation.planner;
    memcpy(def.footsteps.speed_variations, scene->navigation.speed_variations,
           sizeof def.footsteps.speed_variations);
    const ff_scene_agent *agents = ff_scene_agents(scene);
    for (uint32_t i = 0; i < ff_scene_agent_count(scene); ++i)
        def.footsteps.mixed = def.footsteps.mixed || agents[i].planner == FF_PLANNER_FOOTSTEPS;
    def.max_obstacles = (uint32_t)scene->obstacles.count;
    def.max_walls += FF_SCENE_OBSTACLE_WALLS * def.max_obstacles;
    def.body_scale = scene->navigation.body_scale;
    def.mcn = scene->navigation.mcn;
    def.baseline = scene->navigation.baseline;
    *behaviour = ff_scene_behaviour_def(&scene->behaviour);
    if (ff_scene_has_behaviour(scene)) def.behaviour = behaviour;
    return def;
}

ff_status ff_scene_populate(const ff_scene *scene, ff_crowd *crowd, ff_error *error)
{
    const ff_scene_agent *agents = ff_scene_agents(scene);
    for (uint32_t i = 0; i < ff_scene_agent_count(scene); ++i) {
        ff_agent_def def = ff_agent_def_default();
        ff_agent agent;
        def.position = agents[i].position;
        def.heading = agents[i].heading;
        def.goal = agents[i].goal;
        def.goal_tolerance = agents[i].goal_tolerance;
        def.preferred_speed = agents[i].preferred_speed;
        def.radius = agents[i].radius;
        def.navigation = agents[i].navigation;
        def.synthesis = agents[i].synthesis;
        def.planner = agents[i].planner;
        def.machine = agents[i].machine;
        ff_status status = ff_crowd_add_agent(crowd, &def, &agent, error);
        if (status == FF_OK && agents[i].waypoint_count > 0)
            status =
                ff_crowd_set_waypoints(crowd, agent, agents[i].waypoints, agents[i].waypoint_count, error);
        if (status != FF_OK) return status;
    }
    const ff_scene_wall *walls = ff_scene_walls(scene);
    for (uint32_t i = 0; i < ff_scene_wall_count(scene); ++i) {
        ff_status status = ff_crowd_add_wall(crowd, walls[i].p, walls[i].q, error);
        if (status != FF_OK) return status;
    }
    const ff_obstacle_def *obstacles = scene->obstacles.data;
    for (size_t i = 0; i < scene->obstacles.count; ++i) {
        ff_status status = ff_crowd_add_obstacle(crowd, &obstacles[i], NULL, error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}
