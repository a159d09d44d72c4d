#include "runtime/program/obstacle_course.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/random.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The passage runs from 0 to LENGTH along a; the yards are before and behind it. */
enum { BAFFLES = 5, WAYPOINTS = 2 * BAFFLES };
#define LENGTH 12.0 /* m */
#define HALF_WIDTH 1.6
#define EVERY 2.2 /* m from baffle to baffle */
#define FIRST 1.6
#define BEFORE 0.5  /* m: waypoints are that far before and behind a gap */
#define NEAR 0.7    /* m, from a waypoint, which is then passed */
#define YARD 1.0    /* m from the passage, from where on people are in the open */
#define START 3.0   /* m before the passage stands the first ... */
#define ROW 1.4     /* ... and behind him the others, this far apart: one by one, as the gaps are */
#define END 9.0     /* m behind the passage are the goals of the last */
#define POSES 5.0   /* per second, that are compared with recorded ones */
#define WALKING 0.3 /* m/s: who is slower is not judged by how he walks */

typedef struct course_run {
    const ff_obstacle_course *course;
    const ff_figure *figure;
    const ff_pose_base *base;
    ff_scene *scene;
    ff_recording *recording;
    ff_watch watch;
    ff_crowd *crowd;
    ff_agent *handles;
    uint32_t *waypoint, *hint; /* per agent */
    ff_obstacle_result *out;
} course_run;

static ff_status add_wall(ff_scene *scene, ff_vec2 p, ff_vec2 q, ff_error *error)
{
    ff_scene_wall *wall = ff_array_grow(&scene->walls, 1, sizeof *wall);
    if (!wall) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a wall");
    *wall = (ff_scene_wall){p, q};
    return FF_OK;
}

/* Where the gap of a baffle is: on the left and on the right in turn. */
static double side_of(int baffle)
{
    return baffle % 2 == 0 ? 1.0 : -1.0;
}

static ff_status build_walls(const ff_obstacle_course *course, ff_scene *scene, ff_error *error)
{
    ff_status status = FF_OK;
    for (int side = -1; side <= 1 && status == FF_OK; side += 2)
        status = add_wall(scene, ff_v2(0.0, side * HALF_WIDTH), ff_v2(LENGTH, side * HALF_WIDTH), error);
    for (int k = 0; k < BAFFLES && status == FF_OK; ++k) {
        double a = FIRST + k * EVERY, side = side_of(k);
        status =
            add_wall(scene, ff_v2(a, -side * HALF_WIDTH), ff_v2(a, side * (HALF_WIDTH - course->gap)), error);
    }
    return status;
}

static ff_status place_people(const ff_obstacle_course *course, ff_scene *scene, ff_error *error)
{
    for (uint32_t i = 0; i < course->agents; ++i) {
        ff_scene_agent *agent = ff_array_grow(&scene->agents, 1, sizeof *agent);
        if (!agent) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u agents", course->agents);
        ff_random random = {course->seed, 1, 16 * (uint64_t)i};
        double back = START + ROW * i, side = i % 2 == 0 ? 0.4 : -0.4;
        *agent = (ff_scene_agent){.position = ff_v2(-back + ff_random_range(&random, -0.3, 0.3),
                                                    side + ff_random_range(&random, -0.2, 0.2)),
                                  .goal = ff_v2(LENGTH + END - 0.9 * (i / 4), (i % 4 - 1.5) * 1.2),
                                  .preferred_speed = ff_random_range(&random, 1.15, 1.45),
                                  .radius = 0.3,
                                  .goal_tolerance = 0.5};
    }
    return FF_OK;
}

static ff_status build_scene(const ff_obstacle_course *course, ff_scene *scene, ff_error *error)
{
    *scene = (ff_scene){.kind = FF_SCENE_CUSTOM,
                        .seconds = course->seconds,
                        .step = course->step,
                        .seed = course->seed,
                        .navigation = ff_scene_navigation_default(),
                        .groups = 1,
                        .most = course->agents,
                        .most_numbers = course->agents};
    scene->navigation.synthesis = course->synthesis;
    snprintf(scene->title, sizeof scene->title, "Obstacle course, %s", ff_synthesis_name(course->synthesis));
    ff_status status = build_walls(course, scene, error);
    return status == FF_OK ? place_people(course, scene, error) : status;
}

/* Before and behind each gap in turn. */
static ff_vec2 waypoint_of(const ff_obstacle_course *course, uint32_t index)
{
    int baffle = (int)index / 2;
    double a = FIRST + baffle * EVERY + (index % 2 == 0 ? -BEFORE : BEFORE);
    return ff_v2(a, side_of(baffle) * (HALF_WIDTH - 0.5 * course->gap));
}

/* On to the next waypoint, and in the end to the goal. */
static ff_status lead(course_run *run, uint32_t i, ff_vec2 at, ff_error *error)
{
    uint32_t *next = &run->waypoint[i];
    if (*next >= WAYPOINTS) return FF_OK;
    ff_vec2 way = waypoint_of(run->course, *next);
    bool there = ff_length2(ff_sub2(way, at)) < NEAR || at.a > way.a + 0.1;
    if (*next > 0 && !there) return FF_OK;
    *next += there;
    ff_vec2 goal = *next < WAYPOINTS ? waypoint_of(run->course, *next) : ff_scene_agents(run->scene)[i].goal;
    return ff_crowd_set_goal(run->crowd, run->handles[i], goal, error);
}

static ff_status create_crowd(course_run *run, const ff_pack *pack, ff_error *error)
{
    ff_scene *scene = run->scene;
    uint32_t count = ff_scene_agent_count(scene);
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = count;
    def.max_walls = ff_scene_wall_count(scene);
    def.step = scene->step;
    def.seed = scene->seed;
    def.synthesis = scene->navigation.synthesis;
    ff_status status = ff_crowd_create(pack, &def, &run->crowd, error);
    for (uint32_t i = 0; i < count && status == FF_OK; ++i) {
        const ff_scene_agent *who = &ff_scene_agents(scene)[i];
        ff_agent_def person = ff_agent_def_default();
        person.position = who->position;
        person.goal = waypoint_of(run->course, 0);
        person.preferred_speed = who->preferred_speed;
        person.radius = who->radius;
        status = ff_crowd_add_agent(run->crowd, &person, &run->handles[i], error);
    }
    for (uint32_t i = 0; i < def.max_walls && status == FF_OK; ++i)
        status = ff_crowd_add_wall(run->crowd, ff_scene_walls(scene)[i].p, ff_scene_walls(scene)[i].q, error);
    return status;
}

static void touch_walls(course_run *run, uint32_t i)
{
    double deepest = 0.0;
    for (uint32_t k = 0; k < ff_scene_wall_count(run->scene); ++k) {
        const ff_scene_wall *wall = &ff_scene_walls(run->scene)[k];
        deepest = ff_max(deepest, ff_cylinders_in_wall(&run->watch.contacts.bodies[i], wall->p, wall->q));
    }
    run->out->wall_deepest = ff_max(run->out->wall_deepest, deepest);
    run->out->wall.sum += deepest > 0.0;
    ++run->out->wall.terms;
}

static void judge(course_run *run, uint32_t i, const ff_agent_state *state, ff_vec3 hips,
                  const ff_quat *rotations)
{
    if (ff_length2(state->velocity) < WALKING) return;
    ff_vec3 places[FF_FIGURE_MAX_JOINTS];
    ff_figure_place(run->figure, hips, rotations, places, NULL);
    ff_leg_pose_points legs = ff_legs_of(places, state->position, state->heading);
    bool open = state->position.a < -YARD || state->position.a > LENGTH + YARD;
    ff_mean *mean = open ? &run->out->open : &run->out->passage;
    mean->sum += ff_pose_base_nearest(run->base, &legs, &run->hint[i]);
    ++mean->terms;
}

static ff_status look(course_run *run, bool judged, ff_error *error)
{
    ff_status status = ff_recording_begin(run->recording, error);
    for (uint32_t i = 0; i < run->course->agents && status == FF_OK; ++i) {
        ff_agent_state state;
        ff_vec3 hips;
        ff_quat rotations[FF_FIGURE_MAX_JOINTS];
        status = ff_crowd_agent_state(run->crowd, run->handles[i], &state, error);
        if (status == FF_OK)
            status = ff_crowd_agent_pose(run->crowd, run->handles[i], &hips, rotations, error);
        if (status == FF_OK) status = lead(run, i, state.position, error);
        if (status != FF_OK) break;
        state.reached = state.reached && run->waypoint[i] >= WAYPOINTS;
        ff_recording_set_track(run->recording, i, &state);
        if (ff_recording_wants_pose(run->recording))
            ff_recording_set_pose(run->recording, i, hips, rotations);
        status = ff_watch_pose(&run->watch, run->figure, i, &state, hips, rotations, error);
        touch_walls(run, i);
        if (judged) judge(run, i, &state, hips, rotations);
    }
    if (status == FF_OK) ff_watch_step(&run->watch, run->recording);
    return status;
}

static ff_status walk(course_run *run, ff_error *error)
{
    const ff_obstacle_course *course = run->course;
    uint64_t most = (uint64_t)(course->seconds / course->step + 0.5);
    uint64_t every = (uint64_t)ff_max(1.0, 1.0 / (POSES * course->step) + 0.5);
    ff_status status = look(run, false, error);
    for (uint64_t k = 1; k <= most && status == FF_OK; ++k) {
        ff_crowd_step(run->crowd);
        status = look(run, k % every == 0, error);
        if (ff_watch_reached(run->recording) == course->agents) break;
    }
    if (status == FF_OK) status = ff_skate_finish(&run->watch.skate, error);
    if (status == FF_OK) status = ff_measures_take(&run->watch, run->recording, &run->out->measures, error);
    if (status == FF_OK)
        status = ff_crowd_synthesis_counts(run->crowd, (ff_agent){0, 0}, &run->out->counts, error);
    return status;
}

static ff_status take_memory(course_run *run, ff_error *error)
{
    uint32_t count = run->course->agents;
    run->handles = ff_calloc(count, sizeof *run->handles);
    run->waypoint = ff_calloc(count, sizeof *run->waypoint);
    run->hint = ff_calloc(count, sizeof *run->hint);
    if (run->handles && run->waypoint && run->hint) return FF_OK;
    return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u agents", count);
}

ff_status ff_obstacle_walk(const ff_pack *pack, const ff_figure *figure, const ff_pose_base *base,
                           const ff_obstacle_course *course, ff_obstacle_result *out, ff_scene *scene,
                           ff_recording *recording, ff_error *error)
{
    ff_scene own_scene;
    ff_recording own_recording = {0};
    course_run run = {.course = course,
                      .figure = figure,
                      .base = base,
                      .scene = scene ? scene : &own_scene,
                      .recording = recording ? recording : &own_recording,
                      .out = out};
    memset(out, 0, sizeof *out);
    memset(run.recording, 0, sizeof *run.recording);
    ff_status status = build_scene(course, run.scene, error);
    if (status == FF_OK) status = take_memory(&run, error);
    if (status == FF_OK)
        status = ff_recording_create(course->agents, figure->joint_count, course->step,
                                     (uint64_t)(course->seconds / course->step) + 2, run.recording, error);
    if (!recording) run.recording->pose_stride = 0;
    if (status == FF_OK) status = ff_watch_create(run.scene, figure, &run.watch, error);
    if (status == FF_OK) status = create_crowd(&run, pack, error);
    if (status == FF_OK) status = walk(&run, error);
    ff_crowd_destroy(run.crowd);
    ff_watch_free(&run.watch);
    free(run.handles);
    free(run.waypoint);
    free(run.hint);
    if (!scene) ff_scene_free(&own_scene);
    if (!recording) ff_recording_free(&own_recording);
    return status;
}
