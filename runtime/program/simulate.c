#include "runtime/program/simulate.h"

#include "runtime/core/base/fail.h"
#include "runtime/tool/progress.h"

#include <stdio.h>
#include <stdlib.h>

#define LINGER 1.0 /* s after the last arrival, so that one sees everybody come to a stand */

static ff_status populate(const ff_scene *scene, ff_crowd *crowd, ff_agent *handles, ff_error *error)
{
    const ff_scene_agent *agents = ff_scene_agents(scene);
    for (uint32_t i = 0; i < ff_scene_agent_count(scene); ++i) {
        ff_agent_def def = ff_agent_def_default();
        def.position = agents[i].position;
        def.heading = agents[i].heading;
        def.goal = agents[i].goal;
        def.goal_tolerance = agents[i].goal_tolerance;
        def.preferred_speed = agents[i].preferred_speed;
        def.radius = agents[i].radius;
        def.navigation = agents[i].navigation;
        def.synthesis = agents[i].synthesis;
        ff_status status = ff_crowd_add_agent(crowd, &def, &handles[i], error);
        if (status != FF_OK) return status;
    }
    const ff_scene_wall *walls = ff_scene_walls(scene);
    for (uint32_t i = 0; i < ff_scene_wall_count(scene); ++i) {
        ff_status status = ff_crowd_add_wall(crowd, walls[i].p, walls[i].q, error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}

static ff_status create_crowd(const ff_simulation *simulation, ff_crowd **crowd, ff_error *error)
{
    const ff_scene *scene = simulation->scene;
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = ff_scene_agent_count(scene);
    def.max_walls = ff_scene_wall_count(scene);
    def.step = scene->step;
    def.seed = scene->seed;
    def.threads = simulation->threads;
    def.keep_right = scene->navigation.keep_right;
    def.navigation = scene->navigation.method;
    def.synthesis = scene->navigation.synthesis;
    def.mcn = scene->navigation.mcn;
    def.baseline = scene->navigation.baseline;
    return ff_crowd_create(simulation->pack, &def, crowd, error);
}

static bool is_near(const ff_scene *scene, uint32_t agent, const ff_agent_state *state)
{
    return ff_length2(ff_sub2(state->goal, state->position)) <= ff_scene_agents(scene)[agent].goal_tolerance;
}

static ff_status count_synthesis(const ff_crowd *crowd, ff_agent agent, ff_synthesis_counts *sum,
                                 ff_error *error)
{
    ff_synthesis_counts one;
    ff_status status = ff_crowd_synthesis_counts(crowd, agent, &one, error);
    if (status != FF_OK) return status;
    sum->blending_s += one.blending_s;
    sum->semi_procedural_s += one.semi_procedural_s;
    sum->running_s += one.running_s;
    sum->transitions += one.transitions;
    sum->urgent += one.urgent;
    return FF_OK;
}

/* Put what every agent does now into the recording's next step. */
static ff_status record(ff_simulation *simulation, ff_crowd *crowd, ff_agent *handles, ff_error *error)
{
    ff_recording *recording = &simulation->recording;
    ff_status status = ff_recording_begin(recording, error);
    for (uint32_t i = 0; i < recording->agent_count && status == FF_OK; ++i) {
        if (handles[i].generation == 0) continue; /* has left */
        ff_agent_state state;
        ff_vec3 hips;
        ff_quat rotations[FF_FIGURE_MAX_JOINTS];
        status = ff_crowd_agent_state(crowd, handles[i], &state, error);
        if (status == FF_OK) status = ff_crowd_agent_pose(crowd, handles[i], &hips, rotations, error);
        if (status != FF_OK) break;
        if (simulation->leave_walking && simulation->scene->leave && is_near(simulation->scene, i, &state))
            state.reached = 1;
        ff_recording_set_track(recording, i, &state);
        if (ff_recording_wants_pose(recording)) ff_recording_set_pose(recording, i, hips, rotations);
        status = ff_watch_pose(&simulation->watch, simulation->figure, i, &state, hips, rotations, error);
        if (status == FF_OK && simulation->scene->leave && state.reached) {
            status = count_synthesis(crowd, handles[i], &simulation->synthesis, error);
            if (status == FF_OK) status = ff_crowd_remove_agent(crowd, handles[i], error);
            handles[i] = (ff_agent){0, 0};
        }
    }
    if (status == FF_OK) ff_watch_step(&simulation->watch, recording);
    return status;
}

static ff_status run_steps(ff_simulation *simulation, ff_crowd *crowd, ff_agent *handles, ff_error *error)
{
    const ff_scene *scene = simulation->scene;
    uint64_t most = (uint64_t)(scene->seconds / scene->step + 0.5);
    uint64_t linger = (uint64_t)(LINGER / scene->step + 0.5), all_there = 0;
    ff_progress *progress = ff_progress_start("walking", most, simulation->quiet);
    ff_status status = record(simulation, crowd, handles, error);
    for (uint64_t k = 0; k < most && status == FF_OK && all_there <= linger; ++k) {
        ff_crowd_step(crowd);
        status = record(simulation, crowd, handles, error);
        uint32_t reached = ff_watch_reached(&simulation->recording);
        all_there = reached == ff_scene_agent_count(scene) ? all_there + 1 : 0;
        char item[64];
        snprintf(item, sizeof item, "%.1f s, %u of %u there", (double)(k + 1) * scene->step, reached,
                 ff_scene_agent_count(scene));
        ff_progress_step(progress, item);
    }
    ff_progress_end(progress);
    return status;
}

ff_status ff_simulate(ff_simulation *simulation, ff_error *error)
{
    const ff_scene *scene = simulation->scene;
    uint32_t agents = ff_scene_agent_count(scene);
    ff_crowd *crowd = NULL;
    ff_agent *handles = ff_calloc(agents, sizeof *handles);
    ff_status status = handles ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u agents", agents);
    if (status == FF_OK)
        status =
            ff_recording_create(agents, simulation->figure->joint_count, scene->step,
                                (uint64_t)(scene->seconds / scene->step) + 2, &simulation->recording, error);
    if (simulation->tracks_only) simulation->recording.pose_stride = 0;
    if (status == FF_OK) status = ff_watch_create(scene, simulation->figure, &simulation->watch, error);
    if (status == FF_OK) status = create_crowd(simulation, &crowd, error);
    if (status == FF_OK) status = populate(scene, crowd, handles, error);
    if (status == FF_OK) status = run_steps(simulation, crowd, handles, error);
    if (status == FF_OK) status = count_synthesis(crowd, (ff_agent){0, 0}, &simulation->synthesis, error);
    if (status == FF_OK) status = ff_skate_finish(&simulation->watch.skate, error);
    if (status == FF_OK) {
        simulation->state_hash = ff_crowd_state_hash(crowd);
        simulation->timings = ff_crowd_time_spent(crowd);
    }
    ff_crowd_destroy(crowd);
    free(handles);
    if (status != FF_OK) ff_simulation_free(simulation);
    return status;
}

void ff_simulation_free(ff_simulation *simulation)
{
    ff_recording_free(&simulation->recording);
    ff_watch_free(&simulation->watch);
}
