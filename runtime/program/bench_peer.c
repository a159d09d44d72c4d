#define _POSIX_C_SOURCE 199309L
#include "runtime/program/bench_peer.h"

#include "runtime/export/detour.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#define STILL 0.2 /* m/s, as ff_agent_state.reached has it */
#define ROOM 10.0 /* m round the outermost starts and goals */

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static ff_status make_peer(const ff_scene *scene, ff_detour **out, ff_error *error)
{
    const ff_scene_agent *agents = ff_scene_agents(scene);
    uint32_t count = ff_scene_agent_count(scene);
    double half = 0.0;
    ff_detour_agent *walkers = ff_calloc(count, sizeof *walkers);
    if (!walkers) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u agents", count);
    for (uint32_t i = 0; i < count; ++i) {
        walkers[i] = (ff_detour_agent){agents[i].position, agents[i].goal, agents[i].radius,
                                       agents[i].preferred_speed};
        half = ff_max(half, ff_max(ff_length2(agents[i].position), ff_length2(agents[i].goal)));
    }
    ff_status status = ff_detour_create(walkers, count, half + ROOM, out, error);
    free(walkers);
    return status;
}

/* Returns how many stand at their goals; UINT32_MAX when memory ran out. */
static ff_status record(const ff_detour *detour, const ff_scene *scene, ff_recording *recording,
                        uint32_t *there, ff_error *error)
{
    ff_status status = ff_recording_begin(recording, error);
    *there = 0;
    for (uint32_t i = 0; i < recording->agent_count && status == FF_OK; ++i) {
        const ff_scene_agent *agent = &ff_scene_agents(scene)[i];
        ff_agent_state state = {.position = ff_detour_position(detour, i),
                                .scale = 1.0,
                                .velocity = ff_detour_velocity(detour, i)};
        state.heading = ff_atan2(state.velocity.b, state.velocity.a);
        state.reached = ff_length2(ff_sub2(agent->goal, state.position)) <= agent->goal_tolerance &&
                        ff_length2(state.velocity) <= STILL;
        ff_recording_set_track(recording, i, &state);
        *there += state.reached;
    }
    return status;
}

static ff_status walk(ff_detour *detour, const ff_scene *scene, ff_trial *trial, ff_recording *recording,
                      ff_watch *watch, ff_error *error)
{
    uint32_t there = 0, steps = (uint32_t)(scene->seconds / scene->step + 0.5), k = 0;
    double spent = 0.0;
    ff_status status = record(detour, scene, recording, &there, error);
    for (; k < steps && there < recording->agent_count && status == FF_OK; ++k) {
        double start = now();
        ff_detour_step(detour, scene->step);
        spent += now() - start;
        status = record(detour, scene, recording, &there, error);
        if (status == FF_OK) ff_watch_step(watch, recording);
    }
    trial->navigation_ms = 1e3 * spent / ff_max(k, 1.0);
    trial->total_us = 1e3 * trial->navigation_ms / recording->agent_count;
    return status == FF_OK ? ff_measures_take(watch, recording, &trial->measures, error) : status;
}

ff_status ff_peer_run(const ff_figure *figure, ff_trial *trial, ff_scene *scene, ff_recording *recording,
                      ff_error *error)
{
    ff_detour *detour = NULL;
    ff_watch watch = {0};
    memset(recording, 0, sizeof *recording);
    ff_status status = ff_scene_create(&trial->def, scene, error);
    if (status != FF_OK) return status;
    status = make_peer(scene, &detour, error);
    if (status == FF_OK)
        status = ff_recording_create(ff_scene_agent_count(scene), figure->joint_count, scene->step,
                                     (uint64_t)(scene->seconds / scene->step) + 2, recording, error);
    recording->pose_stride = 0;
    if (status == FF_OK) status = ff_watch_create(scene, figure, &watch, error);
    if (status == FF_OK) status = walk(detour, scene, trial, recording, &watch, error);
    ff_watch_free(&watch);
    ff_detour_destroy(detour);
    return status;
}
