/* scene.h - who starts where and wants to go where, from a JSON file (runtime/scenes/README.md lists the keys). */
#ifndef FF_SCENE_H
#define FF_SCENE_H

#include "runtime/core/base/memory.h"
#include "runtime/export/scene_behaviour.h"
#include "runtime/tool/json.h"

typedef enum ff_scene_kind {
    FF_SCENE_CIRCLE,        /* everyone to the opposite side of a circle */
    FF_SCENE_TWO_WAY,       /* two blocks whose paths cross at a right angle */
    FF_SCENE_BIDIRECTIONAL, /* two blocks head-on in a corridor */
    FF_SCENE_FOUR_WAY,      /* four blocks from corners of a square to the opposite ones */
    FF_SCENE_CUSTOM,        /* agents one by one */
    FF_SCENE_KIND_COUNT
} ff_scene_kind;

typedef struct ff_scene_agent {
    ff_vec2 position, goal; /* m */
    double heading;         /* rad */
    double preferred_speed; /* m/s */
    double radius;          /* m */
    double goal_tolerance;  /* m */
    uint32_t group;         /* which block it starts in; on the circle its own number */
    uint32_t machine;       /* that it follows; FF_NONE: it goes to its goal */
    ff_navigation navigation;
    ff_synthesis synthesis;
    ff_planner planner;
    uint32_t waypoint_count;
    ff_vec2 waypoints[FF_WAYPOINTS_MAX]; /* m, on the way to the goal */
} ff_scene_agent;

/* How everyone finds their way and walks: the crowd's definition has the same members. */
typedef struct ff_scene_navigation {
    ff_navigation method;
    ff_synthesis synthesis;
    ff_planner planner;
    double speed_variations[FF_SPEED_VARIATIONS_MAX]; /* of walking steps, for those who plan them; 0: none */
    double body_scale;                                /* bodies differ in size by up to so much */
    double keep_right;                                /* rad, of MCN */
    ff_mcn_def mcn;
    ff_baseline_def baseline;
} ff_scene_navigation;

typedef struct ff_scene_wall {
    ff_vec2 p, q; /* m */
} ff_scene_wall;

/* What the file says, before anyone is placed. Sizes in m; NAN = not given, the layout chooses. */
typedef struct ff_scene_def {
    ff_scene_kind kind;
    char title[96];
    double seconds, step;
    uint64_t seed;
    bool leave; /* agents leave the scene when they reach their goals */
    ff_scene_navigation navigation;
    int64_t agents;
    double agent_radius, preferred_speed, speed_spread, goal_tolerance;
    double radius, spacing, jitter, distance, square, corridor_width, corridor_length;
    ff_array walls;     /* ff_scene_wall */
    ff_array obstacles; /* ff_obstacle_def */
    ff_array fixed;     /* ff_scene_agent, of a custom scene */
    ff_array crowds;    /* ff_scene_group */
    uint32_t machine;   /* of the agents of a layout; FF_NONE */
    ff_scene_behaviour behaviour;
} ff_scene_def;

typedef struct ff_scene {
    ff_scene_kind kind;
    char title[96];
    double seconds, step;
    uint64_t seed;
    bool leave;
    ff_scene_navigation navigation;
    ff_array agents;    /* ff_scene_agent: of the start; spawners add to it while the scene runs */
    ff_array walls;     /* ff_scene_wall */
    ff_array obstacles; /* ff_obstacle_def */
    ff_scene_behaviour behaviour;
    uint32_t groups;
    uint32_t most;         /* people at a time */
    uint32_t most_numbers; /* people in all */
} ff_scene;

const char *ff_scene_kind_name(ff_scene_kind kind); /* as in files: "two_way" */

/* Read a scene file strictly: an unknown key or a value of the wrong type is an error at its line. */
ff_status ff_scene_def_load(const char *path, ff_scene_def *out, ff_error *error);
ff_status ff_scene_def_parse(const char *text, size_t size, const char *name, ff_scene_def *out,
                             ff_error *error);
void ff_scene_def_free(ff_scene_def *def);

/* A layout as it is without any key: FbCrowd's scenes in the sizes of the navigation study. */
ff_scene_def ff_scene_def_default(ff_scene_kind kind);

const char *ff_navigation_name(ff_navigation navigation); /* as in files: "mcn" */
ff_synthesis ff_synthesis_named(const char *name);        /* FF_SYNTHESIS_CROWD when nothing is called so */
const char *ff_synthesis_name(ff_synthesis synthesis);    /* "hybrid" */
/* The keys "navigation", "synthesis", "mcn" and "baseline" of a scene (scene_navigation.c). */
ff_scene_navigation ff_scene_navigation_default(void);
ff_status ff_scene_navigation_read(const ff_json *json, ff_scene_navigation *out, ff_error *error);
/* "navigation" and "synthesis" of object, which may be the scene or one of its agents. */
ff_status ff_scene_method_read(const ff_json *json, const json_t *object, ff_navigation *out,
                               ff_error *error);
ff_status ff_scene_synthesis_read(const ff_json *json, const json_t *object, ff_synthesis *out,
                                  ff_error *error);

/* Footsteps (scene_footsteps.c): "planner" of the scene or of one of its agents, an agent's "waypoints", the scene's "obstacles" and
 * "speed_variations". */
ff_status ff_scene_planner_read(const ff_json *json, const json_t *object, ff_planner *out, ff_error *error);
ff_status ff_scene_speeds_read(const ff_json *json, double out[FF_SPEED_VARIATIONS_MAX], ff_error *error);
ff_status ff_scene_waypoints_read(const ff_json *json, const json_t *object, ff_scene_agent *out,
                                  ff_error *error);
ff_status ff_scene_obstacles_read(const ff_json *json, ff_array *out, ff_error *error);
/* Whether people do something there beside going to their goals. */
static inline bool ff_scene_has_behaviour(const ff_scene *scene)
{
    return scene->behaviour.machines.count > 0;
}

/* The groups of a scene that its kind has been placed in, and the counts of people (scene_people.c). */
ff_status ff_scene_place_people(const ff_scene_def *def, ff_scene *scene, ff_error *error);

/* Somebody has come in: the row that tells of them. Rows are numbered as ff_agent_state.number is; one that has no radius
 * tells of nobody yet. */
ff_status ff_scene_add_spawned(ff_scene *scene, const ff_agent_state *state, uint32_t spawner,
                               ff_error *error);

/* Place everyone. Fails when two agents would start inside each other. */
ff_status ff_scene_create(const ff_scene_def *def, ff_scene *out, ff_error *error);
void ff_scene_free(ff_scene *scene);

static inline uint32_t ff_scene_agent_count(const ff_scene *scene)
{
    return (uint32_t)scene->agents.count;
}
static inline const ff_scene_agent *ff_scene_agents(const ff_scene *scene)
{
    return scene->agents.data;
}
static inline uint32_t ff_scene_wall_count(const ff_scene *scene)
{
    return (uint32_t)scene->walls.count;
}
static inline const ff_scene_wall *ff_scene_walls(const ff_scene *scene)
{
    return scene->walls.data;
}

#endif
