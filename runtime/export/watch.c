#include "runtime/export/watch.h"

#include "runtime/core/base/fail.h"
#include "runtime/export/measures.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ff_status ff_watch_create(const ff_scene *scene, const ff_figure *figure, ff_watch *out, ff_error *error)
{
    uint32_t agents = scene->most_numbers;
    memset(out, 0, sizeof *out);
    out->scene = scene;
    out->least_dot = 1.0;
    out->radii = ff_calloc(agents, sizeof *out->radii);
    ff_status status =
        out->radii ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u agents", agents);
    if (status == FF_OK) status = ff_collisions_create(agents, &out->collisions, error);
    if (status == FF_OK) status = ff_contacts_create(agents, &out->contacts, error);
    out->joint_count = figure->joint_count;
    out->last = ff_calloc((size_t)agents * figure->joint_count, sizeof *out->last);
    if (status == FF_OK && !out->last)
        status = ff_fail(error, FF_ERR_NO_MEMORY, "no memory for poses of %u agents", agents);
    if (status == FF_OK) status = ff_skate_create(agents, scene->step, &out->skate, error);
    if (status != FF_OK) {
        ff_watch_free(out);
        return status;
    }
    out->rest_height[0] = figure->rest[FF_JOINT_BALL_L].y;
    out->rest_height[1] = figure->rest[FF_JOINT_BALL_R].y;
    return FF_OK;
}

void ff_watch_free(ff_watch *watch)
{
    free(watch->radii);
    free(watch->last);
    ff_contacts_free(&watch->contacts);
    ff_collisions_free(&watch->collisions);
    ff_skate_free(&watch->skate);
    memset(watch, 0, sizeof *watch);
}

void ff_watch_step(ff_watch *watch, const ff_recording *recording)
{
    uint32_t last = recording->step_count - 1;
    ff_contacts_count(&watch->contacts);
    if (last == 0) return;
    ff_collisions_add(&watch->collisions, ff_recording_track(recording, last - 1, 0),
                      ff_recording_track(recording, last, 0), watch->radii);
}

/* Joint 0 is left out: its rotation is that of the whole body. */
static void follow_joints(ff_watch *watch, uint32_t agent, const ff_quat *rotations)
{
    ff_quat *last = watch->last + (size_t)agent * watch->joint_count;
    for (uint32_t j = 1; j < watch->joint_count; ++j) {
        const ff_quat *p = &last[j], *q = &rotations[j];
        double dot = fabs(p->x * q->x + p->y * q->y + p->z * q->z + p->w * q->w);
        if (p->w != 0.0 || p->x != 0.0) watch->least_dot = ff_min(watch->least_dot, dot);
    }
    memcpy(last, rotations, watch->joint_count * sizeof *last);
}

ff_status ff_watch_pose(ff_watch *watch, const ff_figure *figure, uint32_t agent, const ff_agent_state *state,
                        ff_vec3 hips, const ff_quat *rotations, ff_error *error)
{
    static const int ball[2] = {FF_JOINT_BALL_L, FF_JOINT_BALL_R};
    ff_vec3 places[FF_FIGURE_MAX_JOINTS];
    ff_figure_place_scaled(figure, state->scale, hips, rotations, places, NULL);
    watch->radii[agent] = state->radius;
    watch->contacts.bodies[agent] = ff_cylinders_of(places);
    follow_joints(watch, agent, rotations);
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

void ff_watch_caption(const ff_scene *scene, const ff_recording *recording, char *text, size_t size)
{
    double seconds = (recording->step_count - 1) * recording->step;
    uint32_t reached = ff_watch_reached(recording);
    if (ff_scene_has_behaviour(scene) && reached == 0)
        snprintf(text, size, "%u people, %.1f s", recording->agent_count, seconds);
    else if (ff_scene_has_behaviour(scene))
        snprintf(text, size, "%u people, %u of whom left, in %.1f s", recording->agent_count, reached,
                 seconds);
    else
        snprintf(text, size, "%u agents, %u reached their goals in %.1f s", recording->agent_count, reached,
                 seconds);
}

static json_t *report_slides(const ff_slides *slides)
{
    return json_pack("{s:f,s:f,s:f,s:I}", "median", 100.0 * slides->median, "p95", 100.0 * slides->p95, "max",
                     100.0 * slides->most, "plants", (json_int_t)slides->plants);
}

static json_t *report_times(const ff_watch *watch, const ff_run_facts *facts)
{
    double scale = watch->collisions.agent_steps ? 1e6 / (double)watch->collisions.agent_steps : 0.0;
    const ff_crowd_timings *spent = &facts->timings;
    return json_pack("{s:f,s:f,s:f,s:f,s:f,s:f}", "total", spent->total * scale, "behaviour",
                     spent->behaviour * scale, "neighbours", (spent->snapshot + spent->neighbours) * scale,
                     "navigation", spent->navigation * scale, "bodies", spent->bodies * scale, "synthesis",
                     spent->synthesis * scale);
}

static json_t *report_synthesis(const ff_watch *watch, const ff_synthesis_counts *counts)
{
    double all = ff_max(counts->blending_s + counts->semi_procedural_s + counts->running_s, 1e-9);
    return json_pack("{s:s,s:f,s:f,s:f,s:I,s:I}", "method",
                     ff_synthesis_name(watch->scene->navigation.synthesis), "blending",
                     counts->blending_s / all, "semi_procedural", counts->semi_procedural_s / all, "running",
                     counts->running_s / all, "transitions", (json_int_t)counts->transitions, "urgent",
                     (json_int_t)counts->urgent);
}

json_t *ff_watch_report(ff_watch *watch, const ff_recording *recording, const ff_run_facts *facts)
{
    char hash[24];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)facts->state_hash);
    uint32_t steps = recording->step_count - 1;
    ff_measures m;
    if (ff_measures_take(watch, recording, &m, NULL) != FF_OK) return NULL;
    return json_pack(
        "{s:s,s:s,s:s,s:s,s:s,s:I,s:I,s:I,s:I,s:{s:I,s:I,s:I},s:f,s:f,s:f,s:I,s:{s:f,s:f},s:f,s:{s:f,s:f,s:f}"
        ",s:I,s:f,s:I,s:f,s:"
        "o,"
        "s:o,s:f,s:f,s:o,s:o,s:s}",
        "version", FF_VERSION, "scene", facts->scene_path, "kind", ff_scene_kind_name(watch->scene->kind),
        "navigation", ff_navigation_name(watch->scene->navigation.method), "pack", facts->pack_path, "seed",
        (json_int_t)facts->seed, "threads", (json_int_t)facts->threads, "agents", (json_int_t)m.agents,
        "reached", (json_int_t)ff_watch_reached(recording), "people", "added",
        (json_int_t)facts->counts.added, "spawned", (json_int_t)facts->counts.spawned, "left",
        (json_int_t)facts->counts.left, "start_s", recording->start, "seconds", steps * recording->step,
        "step", recording->step, "steps", (json_int_t)steps, "arrival_s", "mean", m.mean_arrival, "last",
        m.last_arrival, "collision_rate", m.collision_rate, "mean_acceleration", "raw", m.raw, "filtered",
        m.filtered, "route", m.route, "overlapping_pairs", (json_int_t)m.pairs, "max_penetration_m",
        m.deepest, "touching_bodies", (json_int_t)m.body_pairs, "max_body_penetration_m", m.body_deepest,
        "foot_skate_cm", report_slides(&m.planted), "foot_skate_unlabelled_cm", report_slides(&m.seen),
        "foot_skate_low_m_per_s", m.low_slide, "fastest_joint_degrees_per_s", m.joint_speed / FF_DEG,
        "step_us_per_agent", report_times(watch, facts), "synthesis",
        report_synthesis(watch, &facts->synthesis), "state_hash", hash);
}
