#include "runtime/export/glb.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/export/glb_body.h"
#include "runtime/export/glb_surroundings.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GROUND_MARGIN 3.0 /* m around everybody's paths */

typedef struct writer {
    const ff_figure *figure;
    const ff_scene *scene;
    const ff_recording *recording;
    ff_glb_model *model;
    ff_glb_wardrobe wardrobe;
    int animation, times;
    float (*vectors)[3]; /* [pose] */
    int16_t (*turns)[4]; /* [joint][pose] */
} writer;

static void ground_bounds(const writer *w, ff_vec2 *low, ff_vec2 *high)
{
    *low = ff_v2(1e9, 1e9);
    *high = ff_v2(-1e9, -1e9);
    for (uint32_t k = 0; k < w->recording->step_count; ++k)
        for (uint32_t i = 0; i < w->recording->agent_count; ++i) {
            const ff_track *track = ff_recording_track(w->recording, k, i);
            if (!track->present) continue;
            ff_vec2 p = track->position;
            *low = ff_v2(ff_min(low->a, p.a - GROUND_MARGIN), ff_min(low->b, p.b - GROUND_MARGIN));
            *high = ff_v2(ff_max(high->a, p.a + GROUND_MARGIN), ff_max(high->b, p.b + GROUND_MARGIN));
        }
}

static int add_times(const writer *w)
{
    uint32_t count = w->recording->pose_count;
    float *seconds = (float *)w->vectors;
    for (uint32_t k = 0; k < count; ++k)
        seconds[k] = (float)(k * ff_recording_pose_step(w->recording));
    double low = 0.0, high = (double)seconds[count - 1];
    int view = ff_glb_add_view(w->model, seconds, count * sizeof *seconds, 0, FF_GLB_DATA);
    return ff_glb_add_accessor(w->model, view, 0, FF_GLB_F32, 0, 1, count, &low, &high);
}

static void add_translation(const writer *w, uint32_t agent, int hips)
{
    uint32_t count = w->recording->pose_count;
    for (uint32_t k = 0; k < count; ++k)
        memcpy(w->vectors[k], ff_recording_raw_hips(w->recording, k, agent), sizeof *w->vectors);
    int view = ff_glb_add_view(w->model, w->vectors, count * sizeof *w->vectors, 0, FF_GLB_DATA);
    int values = ff_glb_add_accessor(w->model, view, 0, FF_GLB_F32, 0, 3, count, NULL, NULL);
    ff_glb_add_channel(w->model, w->animation, hips, FF_GLB_TRANSLATION, w->times, values, 0);
}

/* All moving joints' rotations in one view; joints that stand still get theirs in the node. */
static void add_rotations(const writer *w, uint32_t agent, const int *nodes)
{
    uint32_t count = w->recording->pose_count, moving[FF_FIGURE_MAX_JOINTS], moving_count = 0;
    for (uint32_t j = 0; j < w->figure->joint_count; ++j) {
        int16_t(*turn)[4] = w->turns + (size_t)moving_count * count;
        bool moves = false;
        for (uint32_t k = 0; k < count; ++k) {
            memcpy(turn[k], ff_recording_raw_rotations(w->recording, k, agent)[j], sizeof *turn);
            moves = moves || memcmp(turn[k], turn[0], sizeof *turn) != 0;
        }
        if (moves) {
            moving[moving_count++] = j;
            continue;
        }
        ff_quat still = ff_quat_unit((ff_quat){turn[0][0], turn[0][1], turn[0][2], turn[0][3]});
        ff_glb_set_rotation(w->model, nodes[j], still);
    }
    if (moving_count == 0) return;
    size_t bytes = (size_t)count * sizeof *w->turns;
    int view = ff_glb_add_view(w->model, w->turns, moving_count * bytes, 0, FF_GLB_DATA);
    for (uint32_t m = 0; m < moving_count; ++m) {
        int values = ff_glb_add_accessor(w->model, view, m * bytes, FF_GLB_I16, 1, 4, count, NULL, NULL);
        ff_glb_add_channel(w->model, w->animation, nodes[moving[m]], FF_GLB_ROTATION, w->times, values, 0);
    }
}

/* An agent that leaves the scene shrinks to nothing from one key to the next, and one that comes later is nothing before. */
static void add_leaving(const writer *w, uint32_t agent, int hips)
{
    float size = (float)ff_recording_scale(w->recording, agent);
    const float one[3] = {size, size, size}, nothing[3] = {0.0f, 0.0f, 0.0f};
    ff_span there = ff_recording_span(w->recording, agent);
    if (there.first == 0 && there.end == w->recording->step_count) return;
    float times[3] = {0.0f}, scales[3][3];
    uint32_t keys = 1;
    memcpy(scales[0], there.first == 0 && there.end > 0 ? one : nothing, sizeof one);
    if (there.first > 0) {
        times[keys] = (float)(there.first * w->recording->step);
        memcpy(scales[keys++], one, sizeof one);
    }
    if (there.end > 0 && there.end < w->recording->step_count) {
        times[keys] = (float)(there.end * w->recording->step);
        memcpy(scales[keys++], nothing, sizeof nothing);
    }
    double low = 0.0, high = (double)times[keys - 1];
    int time_view = ff_glb_add_view(w->model, times, keys * sizeof *times, 0, FF_GLB_DATA);
    int scale_view = ff_glb_add_view(w->model, scales, keys * sizeof *scales, 0, FF_GLB_DATA);
    int time = ff_glb_add_accessor(w->model, time_view, 0, FF_GLB_F32, 0, 1, keys, &low, &high);
    int scale = ff_glb_add_accessor(w->model, scale_view, 0, FF_GLB_F32, 0, 3, keys, NULL, NULL);
    ff_glb_add_channel(w->model, w->animation, hips, FF_GLB_SCALE, time, scale, 1);
}

static void add_agent(writer *w, uint32_t agent)
{
    char name[64];
    int nodes[FF_FIGURE_MAX_JOINTS] = {0};
    const ff_figure *figure = w->figure;
    snprintf(name, sizeof name, "agent %u", agent);
    int top = ff_glb_add_node(w->model, name, -1, ff_v3(0.0, 0.0, 0.0));
    for (uint32_t j = 0; j < figure->joint_count; ++j)
        nodes[j] = ff_glb_add_node(w->model, figure->name[j], j == 0 ? top : nodes[figure->parent[j]],
                                   figure->offset[j]);
    /* Sizes differ by the scale of the hips, which stretches all below: so all share one mesh and its bind matrices. */
    ff_glb_set_scale(w->model, nodes[0], ff_recording_scale(w->recording, agent));
    int skin = ff_glb_add_skin(w->model, name, nodes, (int)figure->joint_count, w->wardrobe.inverse_binds);
    ff_look look = ff_look_of(w->scene, agent);
    snprintf(name, sizeof name, "agent %u body", agent);
    /* At the top of the scene: a skinned mesh is placed by its joints alone. */
    int body = ff_glb_add_node(w->model, name, -1, ff_v3(0.0, 0.0, 0.0));
    ff_glb_set_mesh(w->model, body, ff_glb_wardrobe_mesh(&w->wardrobe, w->model, &look), skin);
    add_translation(w, agent, nodes[0]);
    add_rotations(w, agent, nodes);
    add_leaving(w, agent, nodes[0]);
}

static ff_status build(writer *w, ff_error *error)
{
    size_t poses = w->recording->pose_count;
    ff_vec2 low, high;
    ff_status status = ff_glb_wardrobe_create(w->model, w->figure, &w->wardrobe, error);
    if (status != FF_OK) return status;
    w->vectors = ff_calloc(poses, sizeof *w->vectors);
    w->turns = ff_calloc(poses * w->figure->joint_count, sizeof *w->turns);
    if (!w->vectors || !w->turns) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu poses", poses);
    ground_bounds(w, &low, &high);
    status = ff_glb_add_surroundings(w->model, w->scene, low, high, error);
    w->animation = ff_glb_add_animation(w->model, "crowd");
    w->times = add_times(w);
    if (status == FF_OK)
        status = ff_glb_add_obstacles(w->model, w->scene, w->recording, w->animation, w->times, error);
    for (uint32_t i = 0; i < w->recording->agent_count; ++i)
        if (ff_recording_is_posed(w->recording, i)) add_agent(w, i);
    return status;
}

ff_status ff_glb_write(const char *path, const ff_figure *figure, const ff_scene *scene,
                       const ff_recording *recording, ff_error *error)
{
    writer w = {.figure = figure, .scene = scene, .recording = recording};
    char *bytes = NULL;
    size_t size = 0;
    w.model = ff_glb_model_create("Footfall " FF_VERSION);
    if (!w.model) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory to write %s", path);
    ff_status status = build(&w, error);
    if (status == FF_OK) status = ff_glb_model_serialise(w.model, &bytes, &size, error);
    if (status == FF_OK) status = ff_file_write_atomic(path, bytes, size, error);
    free(bytes);
    free(w.vectors);
    free(w.turns);
    ff_glb_wardrobe_free(&w.wardrobe);
    ff_glb_model_destroy(w.model);
    return status;
}
