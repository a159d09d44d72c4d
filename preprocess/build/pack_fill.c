#include "preprocess/build/pack_fill.h"

#include "preprocess/actions/successors.h"
#include "preprocess/examples/hull.h"
#include "preprocess/examples/simplices.h"
#include "runtime/core/base/fail.h"

#include <stdlib.h>
#include <string.h>

#define TURN_SCALE 0.5            /* m/s per rad/s, as the runtime measures rates */
#define NO_STRAFE (15.0 * FF_DEG) /* algorithms A.10 */

static ff_status no_memory(ff_error *error)
{
    return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory filling the pack");
}

static void put3(float out[3], ff_vec3 v)
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

/* Thickness of the bone that starts at each joint (m, at leg 0.836), for drawing and colliders. */
static const float radius[FF_ROLE_JOINT_COUNT] = {
    [FF_ROLE_HIPS] = 0.11f,       [FF_ROLE_SPINE] = 0.12f,      [FF_ROLE_CHEST] = 0.12f,
    [FF_ROLE_NECK] = 0.05f,       [FF_ROLE_HEAD] = 0.09f,       [FF_ROLE_CLAVICLE_L] = 0.05f,
    [FF_ROLE_SHOULDER_L] = 0.05f, [FF_ROLE_ELBOW_L] = 0.04f,    [FF_ROLE_WRIST_L] = 0.03f,
    [FF_ROLE_CLAVICLE_R] = 0.05f, [FF_ROLE_SHOULDER_R] = 0.05f, [FF_ROLE_ELBOW_R] = 0.04f,
    [FF_ROLE_WRIST_R] = 0.03f,    [FF_ROLE_HIP_L] = 0.08f,      [FF_ROLE_KNEE_L] = 0.055f,
    [FF_ROLE_ANKLE_L] = 0.03f,    [FF_ROLE_BALL_L] = 0.025f,    [FF_ROLE_HIP_R] = 0.08f,
    [FF_ROLE_KNEE_R] = 0.055f,    [FF_ROLE_ANKLE_R] = 0.03f,    [FF_ROLE_BALL_R] = 0.025f,
};

ff_status ff_pack_add_rig(ff_pack_content *content, const ff_rig *rig, ff_error *error)
{
    static const int points[FF_POINT_COUNT] = {
        [FF_POINT_HEAD_TOP] = FF_ROLE_HEAD_TOP, [FF_POINT_HAND_L] = FF_ROLE_HAND_L,
        [FF_POINT_HAND_R] = FF_ROLE_HAND_R,     [FF_POINT_TOE_L] = FF_ROLE_TOE_L,
        [FF_POINT_TOE_R] = FF_ROLE_TOE_R,       [FF_POINT_HEEL_L] = FF_BODY_HEEL_L,
        [FF_POINT_HEEL_R] = FF_BODY_HEEL_R};
    ff_pack_joint *joint = ff_array_grow(&content->joints, FF_ROLE_JOINT_COUNT, sizeof *joint);
    ff_pack_point *point = ff_array_grow(&content->points, FF_POINT_COUNT, sizeof *point);
    if (!joint || !point) return no_memory(error);
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
        joint[r] = (ff_pack_joint){.parent = (int32_t)ff_role_parent((ff_role)r), .radius = radius[r]};
        joint[r].name = ff_pack_add_string(content, ff_role_name((ff_role)r));
        put3(joint[r].offset, rig->offset[r]);
        if (joint[r].name == UINT32_MAX) return no_memory(error);
    }
    for (int p = 0; p < FF_POINT_COUNT; ++p) {
        int from = points[p] == FF_BODY_HEEL_L   ? (int)FF_ROLE_ANKLE_L
                   : points[p] == FF_BODY_HEEL_R ? (int)FF_ROLE_ANKLE_R
                                                 : (int)ff_role_parent((ff_role)points[p]);
        point[p] = (ff_pack_point){.joint = from, .kind = (uint32_t)p};
        put3(point[p].offset, rig->offset[points[p]]);
    }
    return FF_OK;
}

/* ---------------------------------------------------------------------------------------------------- examples */

static ff_status add_cycle(ff_pack_content *content, const ff_example *example, uint32_t *stream,
                           ff_error *error)
{
    double rate = example->frame_count / (double)example->record.period;
    ff_pose_motion motion = {.frame_count = example->frame_count,
                             .frame_time = 1.0 / rate,
                             .cyclic = true,
                             .hips = example->hips,
                             .rotations = example->rotations};
    ff_pose_coded coded;
    ff_status status = ff_pose_encode(content->joints.data, content->points.data, &motion, &coded, error);
    if (status != FF_OK) return status;
    status = ff_pack_add_stream(content, &coded, example->frame_count, rate, stream, error);
    ff_pose_coded_free(&coded);
    return status;
}

static ff_status add_example(ff_pack_content *content, const ff_example *example, ff_error *error)
{
    ff_pack_example *record = ff_array_grow(&content->examples, 1, sizeof *record);
    size_t n = (size_t)example->frame_count;
    ff_pack_foot *feet = ff_array_grow(&content->feet, 2 * n, sizeof *feet);
    if (!record || !feet) return no_memory(error);
    *record = example->record;
    record->name = ff_pack_add_string(content, example->name);
    record->clip = (uint32_t)(example->clip < 0 ? 0 : example->clip);
    if (record->name == UINT32_MAX) return no_memory(error);
    memcpy(feet, example->feet, 2 * n * sizeof *feet);
    return add_cycle(content, example, &record->stream, error);
}

/* Simplices of the moving examples of one gait. */
static ff_status add_simplices(ff_pack_content *content, const ff_example_set *set, uint32_t gait,
                               ff_error *error)
{
    ff_vec3 points[FF_SIMPLICES_MAX_POINTS];
    int id[FF_SIMPLICES_MAX_POINTS] = {0}, count = 0;
    for (int i = 0; i < set->count && count < FF_SIMPLICES_MAX_POINTS; ++i) {
        const ff_pack_example *r = &set->items[i].record;
        if (r->gait != gait || (r->flags & FF_EXAMPLE_IDLE)) continue;
        points[count] = ff_v3((double)r->v_forward, (double)r->v_left, TURN_SCALE * (double)r->turn_rate);
        id[count++] = i;
    }
    ff_array found = {0};
    ff_status status = ff_simplices_find(points, count, &found, error);
    const ff_simplex *simplex = found.data;
    ff_pack_simplex *out = NULL;
    if (status == FF_OK && found.count > 0) {
        out = ff_array_grow(&content->simplices, found.count, sizeof *out);
        if (!out) status = no_memory(error);
    }
    for (size_t i = 0; out && i < found.count; ++i) {
        out[i].gait = gait;
        for (int k = 0; k < 4; ++k)
            out[i].vertex[k] = simplex[i].vertex[k] < 0 ? -1 : id[simplex[i].vertex[k]];
    }
    ff_array_free(&found);
    return status;
}

/* The velocity set of the examples that do not strafe, and standing still (algorithms A.11). */
static ff_status add_hull(ff_pack_content *content, const ff_example_set *set, ff_error *error)
{
    ff_vec2 *velocity = ff_calloc((size_t)set->count + 1, sizeof *velocity);
    ff_vec2 *corner = ff_calloc((size_t)set->count + 5, sizeof *corner);
    int count = 1, corners = -1; /* velocity[0] is standing still */
    for (int i = 0; velocity && i < set->count; ++i) {
        const ff_pack_example *r = &set->items[i].record;
        double forward = (double)r->v_forward, left = (double)r->v_left;
        if (forward <= 0.0 || fabs(ff_atan2(left, forward)) > NO_STRAFE) continue;
        velocity[count++] = ff_hull_velocity(ff_length2(ff_v2(forward, left)), (double)r->turn_rate);
    }
    if (velocity && corner) corners = ff_hull_of_velocities(velocity, count, corner);
    ff_pack_point2 *out = corners > 0 ? ff_array_grow(&content->hull, (size_t)corners, sizeof *out) : NULL;
    for (int i = 0; out && i < corners; ++i)
        out[i] = (ff_pack_point2){(float)corner[i].a, (float)corner[i].b};
    free(velocity);
    free(corner);
    return out ? FF_OK : no_memory(error);
}

ff_status ff_pack_add_examples(ff_pack_content *content, const ff_example_set *set, ff_error *error)
{
    ff_status status = FF_OK;
    for (int i = 0; i < set->count && status == FF_OK; ++i)
        status = add_example(content, &set->items[i], error);
    for (uint32_t gait = 0; gait < FF_GAIT_COUNT && status == FF_OK; ++gait)
        status = add_simplices(content, set, gait, error);
    if (status == FF_OK) status = add_hull(content, set, error);
    return status;
}

/* ------------------------------------------------------------------------------------------------------- clips */

static int16_t whole(double value, double unit)
{
    return (int16_t)ff_clamp(floor(value / unit + 0.5), -32768.0, 32767.0);
}

static void put_track(const ff_foot_track *from, ff_pack_track *to)
{
    const double height[3] = {from->heel_height, from->ball_height, from->toe_height};
    const double speed[3] = {from->heel_speed, from->ball_speed, from->toe_speed};
    for (int i = 0; i < 3; ++i) {
        to->height[i] = whole(height[i], 1e-4);
        to->speed[i] = whole(speed[i], 1e-3);
    }
}

/* The coded motion, and foot tracks at the pack's rate, from the first real pose on. */
static ff_status add_poses(ff_pack_content *content, const ff_build_clip *clip, double rate, uint32_t *stream,
                           ff_error *error)
{
    double dt = clip->motion.frame_time;
    int rest = clip->clip.rest_frames, last = clip->plants.frame_count - 1;
    int frames = (int)floor((clip->motion.frame_count - 1 - rest) * dt * rate + 1e-6) + 1;
    ff_status status = ff_pack_add_stream(content, &clip->pose, frames, rate, stream, error);
    if (status != FF_OK) return status;
    ff_pack_track *track = ff_array_grow(&content->tracks, 2 * (size_t)frames, sizeof *track);
    if (!track) return no_memory(error);
    for (int k = 0; k < frames; ++k) {
        int near = rest + (int)floor(k / (rate * dt) + 0.5);
        if (near > last) near = last;
        for (int foot = 0; foot < 2; ++foot)
            put_track(&clip->plants.tracks[2 * near + foot], &track[2 * k + foot]);
    }
    return FF_OK;
}

static ff_pack_plant plant_record(const ff_build_clip *clip, const ff_plant *plant, uint32_t number)
{
    double dt = clip->motion.frame_time, scale = clip->motion.scale;
    int offset = clip->first_frame;
    bool flat = plant->flat_start >= 0;
    return (ff_pack_plant){
        .clip = number,
        .foot = (uint32_t)plant->foot,
        .start = (float)((plant->start + offset) * dt),
        .end = (float)((plant->end + offset) * dt),
        .flat_start = flat ? (float)((plant->flat_start + offset) * dt) : -1.0f,
        .flat_end = flat ? (float)((plant->flat_end + offset) * dt) : -1.0f,
        .ball = {(float)(plant->ball.a * scale), (float)(plant->ball.b * scale)},
        .yaw = (float)plant->yaw,
        .slide = (float)(plant->slide * scale),
        .level = (float)(plant->level * scale),
        .origin = plant->written ? FF_PLANT_WRITTEN : FF_PLANT_FOUND,
        .confidence = (float)plant->confidence,
    };
}

static ff_status add_action(ff_pack_content *content, const ff_action *action, const ff_pack_clip *clip,
                            uint32_t number, double time_offset, ff_error *error)
{
    ff_pack_action record = action->record;
    size_t samples = (size_t)record.collider_samples * FF_COLLIDER_COUNT;
    ff_pack_action *out = ff_array_grow(&content->actions, 1, sizeof *out);
    ff_pack_collider *colliders = ff_array_grow(&content->colliders, samples, sizeof *colliders);
    ff_pack_event *events = ff_array_grow(&content->events, action->record.event_count, sizeof *events);
    ff_action_joins *join = ff_array_grow(&content->joins, 1, sizeof *join);
    if (!out || !colliders || (!events && record.event_count > 0) || !join) return no_memory(error);
    *join = (ff_action_joins){action->start, action->end};
    record.clip = number;
    record.first_collider = (uint32_t)(content->colliders.count - samples);
    record.t_0 = (float)((double)record.t_0 + time_offset);
    record.t_end = (float)((double)record.t_end + time_offset);
    if (record.flight[0] >= 0.0f) {
        record.flight[0] = (float)((double)record.flight[0] + time_offset);
        record.flight[1] = (float)((double)record.flight[1] + time_offset);
    }
    for (uint32_t i = 0; i < action->record.event_count; ++i) {
        events[i] = action->events[i];
        events[i].time = (float)((double)events[i].time + time_offset);
        events[i].plant += clip->first_plant;
    }
    record.first_event = (uint32_t)(content->events.count - record.event_count);
    if (record.support_plant != UINT32_MAX) record.support_plant += clip->first_plant;
    if (record.swing_plant != UINT32_MAX) record.swing_plant += clip->first_plant;
    memcpy(colliders, action->colliders, samples * sizeof *colliders);
    *out = record;
    return FF_OK;
}

static ff_status add_clip(ff_pack_content *content, const ff_build_clip *clip, uint32_t number, double rate,
                          ff_error *error)
{
    const ff_plants *plants = &clip->plants;
    ff_pack_clip record = {.source_hash = clip->hash, .flags = clip->derived ? FF_CLIP_DERIVED : 0};
    const char *texts[5] = {clip->clip.name, clip->source, clip->licence, clip->citation, clip->tags};
    uint32_t *names[5] = {&record.name, &record.source, &record.licence, &record.citation, &record.tags};
    for (int i = 0; i < 5; ++i)
        if ((*names[i] = ff_pack_add_string(content, texts[i])) == UINT32_MAX) return no_memory(error);
    double dt = clip->motion.frame_time, time_offset = clip->first_frame * dt;
    record.first_plant = (uint32_t)content->plants.count;
    record.plant_count = (uint32_t)plants->count;
    record.first_action = (uint32_t)content->actions.count;
    record.action_count = (uint32_t)clip->actions.count;
    record.source_rate = (float)(1.0 / dt);
    record.floor_base = (float)plants->floor.base;
    record.floor_slope[0] = (float)plants->floor.slope.a;
    record.floor_slope[1] = (float)plants->floor.slope.b;
    record.time_offset = (float)(time_offset + clip->clip.rest_frames * dt);
    ff_status status = add_poses(content, clip, rate, &record.stream, error);
    if (status != FF_OK) return status;
    for (int i = 0; i < plants->count; ++i) {
        ff_pack_plant *plant = ff_array_grow(&content->plants, 1, sizeof *plant);
        if (!plant) return no_memory(error);
        *plant = plant_record(clip, &plants->items[i], number);
    }
    for (int i = 0; i < clip->actions.count && status == FF_OK; ++i)
        status = add_action(content, &clip->actions.items[i], &record, number, time_offset, error);
    ff_pack_clip *out = ff_array_grow(&content->clips, 1, sizeof *out);
    if (!out) return no_memory(error);
    *out = record;
    return status;
}

/* Do two actions agree in all that a planner looks at, within 1 %? */
static bool same_action(const ff_pack_action *x, const ff_pack_action *y)
{
    if (x->mode != y->mode || x->support != y->support) return false;
    const double pairs[6][2] = {{(double)x->duration, (double)y->duration},
                                {(double)x->root_displacement[0], (double)y->root_displacement[0]},
                                {(double)x->root_displacement[1], (double)y->root_displacement[1]},
                                {(double)x->swing_displacement[0], (double)y->swing_displacement[0]},
                                {(double)x->swing_displacement[1], (double)y->swing_displacement[1]},
                                {(double)x->theta, (double)y->theta}};
    double size = 0.01 * ((double)x->step_length + (double)x->step_width + 0.1);
    for (int i = 0; i < 6; ++i)
        if (fabs(pairs[i][0] - pairs[i][1]) > size) return false;
    return true;
}

/* Mirror images of the actions, but for those that equal an action there is already (algorithms A.8). */
static ff_status add_mirrored(ff_pack_content *content, const ff_build_clip *clip, uint32_t number,
                              size_t originals, ff_error *error)
{
    ff_status status = FF_OK;
    double time_offset = clip->first_frame * clip->motion.frame_time;
    for (int i = 0; i < clip->actions.count && clip->mirror && status == FF_OK; ++i) {
        ff_action mirrored;
        ff_action_mirror(&clip->actions.items[i], &mirrored);
        const ff_pack_action *actions = content->actions.data;
        bool known = false;
        for (size_t k = 0; k < originals && !known; ++k)
            known = same_action(&actions[k], &mirrored.record);
        const ff_pack_clip *record = (const ff_pack_clip *)content->clips.data + number;
        if (!known) status = add_action(content, &mirrored, record, number, time_offset, error);
    }
    return status;
}

ff_status ff_pack_add_clips(ff_pack_content *content, const ff_build_clip *clips, int count, double rate,
                            ff_error *error)
{
    ff_status status = FF_OK;
    for (int i = 0; i < count && status == FF_OK; ++i)
        status = add_clip(content, &clips[i], (uint32_t)i, rate, error);
    size_t originals = content->actions.count;
    for (int i = 0; i < count && status == FF_OK; ++i)
        status = add_mirrored(content, &clips[i], (uint32_t)i, originals, error);
    return status;
}
