#include "runtime/export/watch.h"

#include "runtime/core/base/fail.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GAIT_STEP 0.5    /* s: one step of walking, over which velocities are averaged */
#define ROUTE_START 2.0  /* s */
#define ROUTE_MARGIN 1.5 /* m before the goal (navigation study, section 2) */

ff_status ff_watch_create(const ff_scene *scene, const ff_figure *figure, ff_watch *out, ff_error *error)
{
    uint32_t agents = ff_scene_agent_count(scene);
    memset(out, 0, sizeof *out);
    out->scene = scene;
    out->radii = ff_calloc(agents, sizeof *out->radii);
    ff_status status =
        out->radii ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u agents", agents);
    if (status == FF_OK) status = ff_collisions_create(agents, &out->collisions, error);
    if (status == FF_OK) status = ff_skate_create(agents, scene->step, &out->skate, error);
    if (status != FF_OK) {
        ff_watch_free(out);
        return status;
    }
    for (uint32_t i = 0; i < agents; ++i)
        out->radii[i] = ff_scene_agents(scene)[i].radius;
    out->rest_height[0] = figure->rest[FF_JOINT_BALL_L].y;
    out->rest_height[1] = figure->rest[FF_JOINT_BALL_R].y;
    return FF_OK;
}

void ff_watch_free(ff_watch *watch)
{
    free(watch->radii);
    ff_collisions_free(&watch->collisions);
    ff_skate_free(&watch->skate);
    memset(watch, 0, sizeof *watch);
}

void ff_watch_step(ff_watch *watch, const ff_recording *recording)
{
    uint32_t last = recording->step_count - 1;
    if (last == 0) return;
    ff_collisions_add(&watch->collisions, ff_recording_track(recording, last - 1, 0),
                      ff_recording_track(recording, last, 0), watch->radii);
}

ff_status ff_watch_pose(ff_watch *watch, const ff_figure *figure, uint32_t agent, const ff_agent_state *state,
                        ff_vec3 hips, const ff_quat *rotations, ff_error *error)
{
    static const int ball[2] = {FF_JOINT_BALL_L, FF_JOINT_BALL_R};
    ff_vec3 places[FF_FIGURE_MAX_JOINTS];
    ff_figure_place(figure, hips, rotations, places, NULL);
    for (int foot = 0; foot < 2; ++foot) {
        ff_status status = ff_skate_add(&watch->skate, agent, foot, places[ball[foot]],
                                        watch->rest_height[foot], state->planted[foot] != 0, error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}

uint32_t ff_watch_reached(const ff_recording *recording)
{
    uint32_t reached = 0;
    for (uint32_t i = 0; i < recording->agent_count; ++i)
        reached += ff_recording_track(recording, recording->step_count - 1, i)->reached != 0;
    return reached;
}

/* Steps [0, count) in which the agent was there. */
static uint32_t present_steps(const ff_recording *recording, uint32_t agent)
{
    uint32_t count = 0;
    while (count < recording->step_count && ff_recording_track(recording, count, agent)->present)
        ++count;
    return count;
}

typedef struct mean {
    double sum;
    uint64_t terms;
} mean;

static double mean_value(mean m)
{
    return m.terms ? m.sum / (double)m.terms : 0.0;
}

static json_t *report_acceleration(const ff_watch *watch, const ff_recording *recording)
{
    mean raw = {0}, filtered = {0}, route = {0};
    size_t window = (size_t)ff_max(1.0, floor(GAIT_STEP / recording->step + 0.5));
    ff_vec2 *points = ff_calloc(recording->step_count, sizeof *points);
    if (!points) return NULL;
    for (uint32_t i = 0; i < recording->agent_count; ++i) {
        uint32_t count = present_steps(recording, i), first = (uint32_t)(ROUTE_START / recording->step),
                 end = 0;
        ff_vec2 goal = ff_scene_agents(watch->scene)[i].goal;
        for (uint32_t k = 0; k < count; ++k) {
            points[k] = ff_recording_track(recording, k, i)->position;
            if (end == k && ff_length2(ff_sub2(goal, points[k])) > ROUTE_MARGIN) end = k + 1;
        }
        ff_acceleration_add(points, count, 1, recording->step, &raw.sum, &raw.terms);
        ff_acceleration_add(points, count, window, recording->step, &filtered.sum, &filtered.terms);
        if (end > first)
            ff_acceleration_add(points + first, end - first, window, recording->step, &route.sum,
                                &route.terms);
    }
    free(points);
    return json_pack("{s:f,s:f,s:f}", "raw", mean_value(raw), "filtered", mean_value(filtered), "route",
                     mean_value(route));
}

static json_t *report_slides(ff_array *slides)
{
    double *values = slides->data;
    size_t count = slides->count;
    double median = ff_quantile(values, count, 0.5), p95 = ff_quantile(values, count, 0.95);
    double most = ff_quantile(values, count, 1.0);
    return json_pack("{s:f,s:f,s:f,s:I}", "median", 100.0 * median, "p95", 100.0 * p95, "max", 100.0 * most,
                     "plants", (json_int_t)count);
}

static json_t *report_arrival(const ff_recording *recording)
{
    double sum = 0.0, last = 0.0;
    uint32_t arrived = 0;
    for (uint32_t i = 0; i < recording->agent_count; ++i) {
        for (uint32_t k = 0; k < recording->step_count; ++k) {
            if (!ff_recording_track(recording, k, i)->reached) continue;
            sum += k * recording->step;
            last = ff_max(last, k * recording->step);
            ++arrived;
            break;
        }
    }
    return json_pack("{s:f,s:f}", "mean", arrived ? sum / arrived : 0.0, "last", last);
}

static json_t *report_times(const ff_watch *watch, const ff_run_facts *facts)
{
    double scale = watch->collisions.agent_steps ? 1e6 / (double)watch->collisions.agent_steps : 0.0;
    const ff_crowd_timings *spent = &facts->timings;
    return json_pack("{s:f,s:f,s:f,s:f}", "total", spent->total * scale, "neighbours",
                     spent->neighbours * scale, "navigation", spent->navigation * scale, "synthesis",
                     spent->synthesis * scale);
}

json_t *ff_watch_report(ff_watch *watch, const ff_recording *recording, const ff_run_facts *facts)
{
    char hash[24];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)facts->state_hash);
    uint32_t steps = recording->step_count - 1;
    double low = watch->skate.low_time > 0.0 ? watch->skate.low_path / watch->skate.low_time : 0.0;
    return json_pack(
        "{s:s,s:s,s:s,s:s,s:I,s:I,s:I,s:I,s:f,s:f,s:I,s:o,s:f,s:o,s:I,s:f,s:o,s:o,s:f,s:o,s:s}", "version",
        FF_VERSION, "scene", facts->scene_path, "kind", ff_scene_kind_name(watch->scene->kind), "pack",
        facts->pack_path, "seed", (json_int_t)facts->seed, "threads", (json_int_t)facts->threads, "agents",
        (json_int_t)recording->agent_count, "reached", (json_int_t)ff_watch_reached(recording), "seconds",
        steps * recording->step, "step", recording->step, "steps", (json_int_t)steps, "arrival_s",
        report_arrival(recording), "collision_rate", ff_collision_rate(&watch->collisions),
        "mean_acceleration", report_acceleration(watch, recording), "overlapping_pairs",
        (json_int_t)watch->collisions.pairs, "max_penetration_m", watch->collisions.deepest, "foot_skate_cm",
        report_slides(&watch->skate.planted), "foot_skate_unlabelled_cm", report_slides(&watch->skate.seen),
        "foot_skate_low_m_per_s", low, "step_us_per_agent", report_times(watch, facts), "state_hash", hash);
}
