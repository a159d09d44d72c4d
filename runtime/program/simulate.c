#include "runtime/program/simulate.h"

#include "runtime/core/base/fail.h"
#include "runtime/export/scene_crowd.h"
#include "runtime/tool/progress.h"

#include <stdio.h>
#include <stdlib.h>

#define LINGER 1.0 /* s after the last arrival, so that one sees everybody come to a stand */

static ff_status load_crowd(const ff_simulation *simulation, const ff_crowd_def *def, ff_crowd **crowd,
                            ff_error *error)
{
    ff_status status = ff_crowd_load_file(simulation->pack, simulation->load, def, crowd, error);
    if (status != FF_OK) return status;
    ff_crowd_def saved = ff_crowd_definition(*crowd);
    if (saved.step == def->step && saved.seed == def->seed && saved.max_agents == def->max_agents &&
        saved.max_walls == def->max_walls && !saved.behaviour == !def->behaviour)
        return FF_OK;
    status = ff_fail(
        error, FF_ERR_ARGUMENT,
        "the crowd was saved from another scene: step %g s, seed %llu, %u agents and %u walls, and here "
        "%g s, %llu, %u and %u",
        saved.step, (unsigned long long)saved.seed, saved.max_agents, saved.max_walls, def->step,
        (unsigned long long)def->seed, def->max_agents, def->max_walls);
    ff_error_in_file(error, simulation->load);
    return status;
}

static ff_status create_crowd(const ff_simulation *simulation, ff_crowd **crowd, ff_error *error)
{
    ff_behaviour_def behaviour;
    ff_crowd_def def = ff_scene_crowd_def(simulation->scene, &behaviour);
    def.threads = simulation->threads;
    if (simulation->load) return load_crowd(simulation, &def, crowd, error);
    ff_status status = ff_crowd_create(simulation->pack, &def, crowd, error);
    return status == FF_OK ? ff_scene_populate(simulation->scene, *crowd, error) : status;
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

/* A row for an agent: those that the scene began with have theirs. */
static ff_status find_row(ff_simulation *simulation, const ff_crowd *crowd, ff_agent agent,
                          const ff_agent_state *state, ff_error *error)
{
    const ff_scene *scene = simulation->scene;
    if (state->number < ff_scene_agent_count(scene) && ff_scene_agents(scene)[state->number].radius > 0.0)
        return FF_OK;
    ff_agent_behaviour behaviour;
    ff_status status = ff_crowd_agent_behaviour(crowd, agent, &behaviour, error);
    if (status == FF_OK) status = ff_scene_add_spawned(simulation->scene, state, behaviour.spawner, error);
    return status;
}

/* One agent. *waits: it is still under way. */
static ff_status record_agent(ff_simulation *simulation, ff_crowd *crowd, ff_agent agent, bool *waits,
                              ff_error *error)
{
    ff_recording *recording = &simulation->recording;
    ff_agent_state state;
    ff_vec3 hips;
    ff_quat rotations[FF_FIGURE_MAX_JOINTS];
    ff_status status = ff_crowd_agent_state(crowd, agent, &state, error);
    if (status == FF_OK) status = find_row(simulation, crowd, agent, &state, error);
    if (status == FF_OK) status = ff_crowd_agent_pose(crowd, agent, &hips, rotations, error);
    if (status != FF_OK) return status;
    uint32_t row = state.number;
    const ff_scene *scene = simulation->scene;
    bool machine = ff_scene_agents(scene)[row].machine != FF_NONE;
    if (machine) state.reached = 0; /* it has other aims than to stand somewhere */
    if (simulation->leave_walking && scene->leave && !machine && is_near(scene, row, &state))
        state.reached = 1;
    ff_recording_set_track(recording, row, &state);
    if (ff_recording_wants_pose(recording)) ff_recording_set_pose(recording, row, hips, rotations);
    status = ff_watch_pose(&simulation->watch, simulation->figure, row, &state, hips, rotations, error);
    *waits = !state.reached;
    if (status != FF_OK || !scene->leave || !state.reached) return status;
    status = count_synthesis(crowd, agent, &simulation->synthesis, error);
    return status == FF_OK ? ff_crowd_remove_agent(crowd, agent, error) : status;
}

/* Put what every agent does now into the recording's next step. *waiting: how many are under way. */
static ff_status record(ff_simulation *simulation, ff_crowd *crowd, ff_agent *agents, uint32_t *waiting,
                        ff_error *error)
{
    ff_recording *recording = &simulation->recording;
    ff_status status = ff_recording_begin(recording, error);
    uint32_t count = ff_crowd_agents(crowd, agents, simulation->scene->most);
    *waiting = 0;
    for (uint32_t i = 0; i < count && status == FF_OK; ++i) {
        bool waits = false;
        status = record_agent(simulation, crowd, agents[i], &waits, error);
        *waiting += waits;
    }
    if (status != FF_OK) return status;
    ff_recording_end(recording);
    ff_watch_step(&simulation->watch, recording);
    return ff_crowd_fault(crowd, error);
}

/* Whether spawners will put in more. */
static bool more_come(const ff_scene *scene, const ff_crowd *crowd)
{
    const ff_spawner_def *spawners = scene->behaviour.spawners.data;
    uint64_t total = 0;
    for (size_t i = 0; i < scene->behaviour.spawners.count; ++i) {
        if (spawners[i].total == 0) return true;
        total += spawners[i].total;
    }
    return ff_crowd_count(crowd).spawned < total;
}

static ff_status save_now(ff_simulation *simulation, const ff_crowd *crowd, ff_error *error)
{
    const char *path = simulation->save;
    simulation->save = NULL;
    return path ? ff_crowd_save_file(crowd, path, error) : FF_OK;
}

static ff_status run_steps(ff_simulation *simulation, ff_crowd *crowd, ff_agent *agents, ff_error *error)
{
    const ff_scene *scene = simulation->scene;
    uint64_t most = (uint64_t)(scene->seconds / scene->step + 0.5), first = ff_crowd_step_count(crowd);
    uint64_t linger = (uint64_t)(LINGER / scene->step + 0.5), all_there = 0;
    ff_progress *progress = ff_progress_start("walking", most > first ? most - first : 0, simulation->quiet);
    uint32_t waiting;
    ff_status status = record(simulation, crowd, agents, &waiting, error);
    for (uint64_t k = first; k < most && status == FF_OK && all_there <= linger; ++k) {
        double time = (double)k * scene->step;
        if (simulation->save && time > simulation->save_at - 0.5 * scene->step)
            status = save_now(simulation, crowd, error);
        if (status != FF_OK) break;
        ff_crowd_step(crowd);
        status = record(simulation, crowd, agents, &waiting, error);
        all_there = waiting == 0 && !more_come(scene, crowd) ? all_there + 1 : 0;
        char item[64];
        snprintf(item, sizeof item, "%.1f s, %u under way", time + scene->step, waiting);
        ff_progress_step(progress, item);
    }
    ff_progress_end(progress);
    return status == FF_OK ? save_now(simulation, crowd, error) : status;
}

ff_status ff_simulate(ff_simulation *simulation, ff_error *error)
{
    const ff_scene *scene = simulation->scene;
    ff_crowd *crowd = NULL;
    ff_agent *agents = ff_calloc(scene->most, sizeof *agents);
    ff_status status =
        agents ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u agents", scene->most);
    if (status == FF_OK)
        status =
            ff_recording_create(scene->most_numbers, simulation->figure->joint_count, scene->step,
                                (uint64_t)(scene->seconds / scene->step) + 2, &simulation->recording, error);
    if (simulation->tracks_only) simulation->recording.pose_stride = 0;
    if (status == FF_OK) status = ff_watch_create(scene, simulation->figure, &simulation->watch, error);
    if (status == FF_OK) status = create_crowd(simulation, &crowd, error);
    if (status == FF_OK) simulation->recording.start = (double)ff_crowd_step_count(crowd) * scene->step;
    if (status == FF_OK) status = run_steps(simulation, crowd, agents, error);
    if (status == FF_OK) status = count_synthesis(crowd, (ff_agent){0, 0}, &simulation->synthesis, error);
    if (status == FF_OK) status = ff_skate_finish(&simulation->watch.skate, error);
    if (status == FF_OK && ff_scene_agent_count(scene) == 0)
        status = ff_fail(
            error, FF_ERR_NO_DATA,
            "nobody has come into the scene within %g s, so there is nothing to show; run it for longer",
            scene->seconds);
    if (status == FF_OK) {
        ff_recording_trim(&simulation->recording, ff_scene_agent_count(scene));
        simulation->state_hash = ff_crowd_state_hash(crowd);
        simulation->timings = ff_crowd_time_spent(crowd);
        simulation->counts = ff_crowd_count(crowd);
    }
    ff_crowd_destroy(crowd);
    free(agents);
    if (status != FF_OK) ff_simulation_free(simulation);
    return status;
}

void ff_simulation_free(ff_simulation *simulation)
{
    ff_recording_free(&simulation->recording);
    ff_watch_free(&simulation->watch);
}
