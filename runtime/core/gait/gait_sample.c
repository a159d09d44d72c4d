#include "runtime/core/gait/gait_sample.h"

double ff_phase_wrap(double phase)
{
    double wrapped = phase - FF_GAIT_KEYS * floor(phase / FF_GAIT_KEYS);
    return wrapped < FF_GAIT_KEYS ? wrapped : 0.0;
}

double ff_idle_fraction(const ff_blend_space *space, double idle_time)
{
    if (space->idle < 0) return 0.0;
    const ff_blend_vertex *idle = &space->vertices[space->idle];
    double frames = idle_time * idle->rate / idle->frame_count;
    return frames - floor(frames);
}

static void add_part(ff_cursor *cursor, const ff_blend_vertex *vertex, double fraction, double weight)
{
    double place = fraction * vertex->frame_count;
    double whole = floor(place);
    uint32_t count = vertex->frame_count, frame = (uint32_t)whole;
    if (frame >= count) frame %= count;
    uint32_t part = cursor->count++;
    cursor->part[part].frame[0] = vertex->first_frame + frame;
    cursor->part[part].frame[1] = vertex->first_frame + (frame + 1 < count ? frame + 1 : 0);
    cursor->part[part].weight[1] = weight * (place - whole);
    cursor->part[part].weight[0] = weight - cursor->part[part].weight[1];
}

/* Section keys of the semi-procedural cycle. */
static void clip_keys(const ff_blend *clip, double key[FF_GAIT_KEYS + 1])
{
    key[0] = 0.0;
    key[1] = clip->stance - 0.5;
    key[2] = 0.5;
    key[3] = clip->stance;
    key[FF_GAIT_KEYS] = 1.0;
}

static double fraction_at(const double key[FF_GAIT_KEYS + 1], double phase)
{
    double wrapped = ff_phase_wrap(phase);
    int section = (int)wrapped;
    return ff_lerp(key[section], key[section + 1], wrapped - section);
}

static double phase_at(const double key[FF_GAIT_KEYS + 1], double fraction)
{
    int k = FF_GAIT_KEYS - 1;
    while (k > 0 && fraction < key[k])
        --k;
    return ff_phase_wrap(k + (fraction - key[k]) / (key[k + 1] - key[k]));
}

double ff_vertex_fraction(const ff_blend_space *space, int32_t vertex, double phase)
{
    return fraction_at(space->vertices[vertex].key, phase);
}

double ff_vertex_phase(const ff_blend_space *space, int32_t vertex, double fraction)
{
    return phase_at(space->vertices[vertex].key, fraction);
}

double ff_clip_fraction(const ff_blend *clip, double phase)
{
    double key[FF_GAIT_KEYS + 1];
    clip_keys(clip, key);
    return fraction_at(key, phase);
}

double ff_clip_phase(const ff_blend *clip, double fraction)
{
    double key[FF_GAIT_KEYS + 1];
    clip_keys(clip, key);
    return phase_at(key, fraction);
}

/* The clip's trunk, arms and knees: those of its example at the same phase, read backwards by who goes backwards. */
static void point_at_clip(const ff_blend_space *space, const ff_blend *clip, double phase, ff_cursor *cursor)
{
    const ff_blend_vertex *vertex = &space->vertices[space->model.vertex];
    double at = fraction_at(vertex->key, phase), back = ff_gait_model_backward(clip->rates);
    double turned = vertex->key[3] - at;
    cursor->clip = clip;
    cursor->fraction = ff_clip_fraction(clip, phase);
    if (back < 1.0) add_part(cursor, vertex, at, 1.0 - back);
    if (back > 0.0) add_part(cursor, vertex, turned - floor(turned), back);
}

ff_cursor ff_cursor_of_clip(const ff_blend_space *space, const ff_blend *clip, double fraction)
{
    ff_cursor cursor = {.clip = clip};
    point_at_clip(space, clip, ff_clip_phase(clip, fraction), &cursor);
    return cursor;
}

ff_cursor ff_cursor_at(const ff_blend_space *space, const ff_blend *blend, double phase, double idle_time)
{
    ff_cursor cursor;
    cursor.count = 0;
    cursor.clip = NULL;
    cursor.fraction = 0.0;
    if (blend->way == FF_SEMI_PROCEDURAL) {
        point_at_clip(space, blend, phase, &cursor);
        return cursor;
    }
    double wrapped = ff_phase_wrap(phase);
    int section = (int)wrapped;
    double share = wrapped - section;
    for (int i = 0; i < FF_BLEND_MAX; ++i) {
        if (blend->vertex[i] < 0 || !(blend->weight[i] > 0.0)) continue;
        const ff_blend_vertex *vertex = &space->vertices[blend->vertex[i]];
        double fraction = vertex->idle ? ff_idle_fraction(space, idle_time)
                                       : ff_lerp(vertex->key[section], vertex->key[section + 1], share);
        add_part(&cursor, vertex, fraction, blend->weight[i]);
    }
    return cursor;
}

ff_cursor ff_cursor_of_vertex(const ff_blend_space *space, int32_t vertex, double fraction)
{
    ff_cursor cursor;
    cursor.count = 0;
    cursor.clip = NULL;
    cursor.fraction = 0.0;
    add_part(&cursor, &space->vertices[vertex], fraction, 1.0);
    return cursor;
}

ff_foot_sample ff_sample_foot(const ff_blend_space *space, const ff_cursor *cursor, int foot)
{
    if (cursor->clip) {
        const ff_blend *clip = cursor->clip;
        ff_model_foot at =
            ff_gait_model_foot(&space->model.clip, clip->rates, clip->period, foot, cursor->fraction);
        return (ff_foot_sample){at.forward, at.left, at.height, at.yaw, at.pitch};
    }
    ff_foot_sample sample = {0.0, 0.0, 0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < cursor->count; ++i)
        for (int k = 0; k < 2; ++k) {
            const ff_pack_foot *at = &space->pack->feet[2 * cursor->part[i].frame[k] + (uint32_t)foot];
            double weight = cursor->part[i].weight[k];
            sample.forward += weight * at->ball[0];
            sample.left += weight * at->ball[1];
            sample.height += weight * at->ball[2];
            sample.yaw += weight * at->yaw;
            sample.pitch += weight * at->pitch;
        }
    return sample;
}

ff_vec3 ff_sample_hips(const ff_blend_space *space, const ff_cursor *cursor)
{
    if (cursor->clip) {
        ff_vec3 at = ff_gait_model_hips(&space->model.clip, cursor->clip->rates, cursor->fraction);
        at.z += ff_gait_model_rise(&space->model.clip, cursor->clip->rates, cursor->fraction);
        return ff_v3(at.x, at.y, at.z + cursor->clip->hips);
    }
    ff_vec3 hips = ff_v3(0.0, 0.0, 0.0);
    for (uint32_t i = 0; i < cursor->count; ++i)
        for (int k = 0; k < 2; ++k) {
            const float *at = space->hips[cursor->part[i].frame[k]];
            hips =
                ff_madd3(hips, ff_v3((double)at[0], (double)at[1], (double)at[2]), cursor->part[i].weight[k]);
        }
    return hips;
}

#define LEAST_SIZE 0.15 /* of the clip's trunk and arms: some of it is left in the smallest steps */

/* A joint of the semi-procedural clip: trunk and arms move as much as the steps are large, and the body leans. */
static ff_quat clip_rotation(const ff_blend_space *space, const ff_cursor *cursor, int joint, ff_quat full)
{
    const ff_clip_model *model = &space->model;
    ff_rates rates = cursor->clip->rates;
    if (joint >= FF_JOINT_HIP_L) return full;
    double size = ff_clamp(ff_gait_model_size(&model->clip, rates), LEAST_SIZE, 1.0);
    ff_quat turn = ff_quat_nlerp(model->mean[joint], full, size);
    if (joint != FF_JOINT_HIPS) return turn;
    double lean = ff_gait_model_lean(&model->clip, rates, cursor->fraction);
    return ff_quat_mul(ff_quat_axis(ff_v3(0.0, 0.0, 1.0), -lean), turn);
}

/* Weighted mean on the hemisphere that the stored frames were put on, normalised: for examples within 60 degrees the same
 * as chains of slerp within 1 degree (algorithms D.1). */
ff_quat ff_sample_rotation(const ff_blend_space *space, const ff_cursor *cursor, int joint)
{
    ff_quat sum = {0.0, 0.0, 0.0, 0.0};
    uint32_t lanes = space->poses.lanes;
    for (uint32_t i = 0; i < cursor->count; ++i)
        for (int k = 0; k < 2; ++k) {
            const int16_t *q = ff_pose_frame(&space->poses, cursor->part[i].frame[k]) + joint;
            double weight = cursor->part[i].weight[k];
            sum.x += weight * q[0];
            sum.y += weight * q[lanes];
            sum.z += weight * q[2 * lanes];
            sum.w += weight * q[3 * lanes];
        }
    sum = ff_quat_unit(sum);
    return cursor->clip ? clip_rotation(space, cursor, joint, sum) : sum;
}

static void add_to_mix(const ff_cursor *cursor, double share, ff_pose_mix *mix)
{
    for (uint32_t i = 0; i < cursor->count; ++i)
        ff_pose_mix_add(mix, cursor->part[i].frame[0], cursor->part[i].frame[1],
                        share * cursor->part[i].weight[0], share * cursor->part[i].weight[1]);
}

void ff_sample_rotations(const ff_blend_space *space, const ff_cursor *cursor, const ff_cursor *other,
                         double share, ff_quat *rotations)
{
    ff_pose_mix mix = {.count = 0};
    float lanes[4 * FF_POSE_LANES];
    add_to_mix(cursor, other ? 1.0 - share : 1.0, &mix);
    if (other) add_to_mix(other, share, &mix);
    ff_pose_blend(&space->poses, &mix, lanes);
    ff_pose_rotations(lanes, FF_POSE_LANES, FF_JOINT_SPINE, FF_JOINT_COUNT - FF_JOINT_SPINE,
                      rotations + FF_JOINT_SPINE);
    for (int joint = FF_JOINT_SPINE; joint < FF_JOINT_HIP_L && cursor->clip; ++joint)
        rotations[joint] = clip_rotation(space, cursor, joint, rotations[joint]);
}

static double section_duration(const ff_blend_space *space, const ff_blend *blend, int section)
{
    if (blend->way == FF_SEMI_PROCEDURAL) {
        double key[FF_GAIT_KEYS + 1];
        clip_keys(blend, key);
        return blend->period * (key[section + 1] - key[section]);
    }
    double duration = 0.0;
    for (int i = 0; i < FF_BLEND_MAX; ++i) {
        if (blend->vertex[i] < 0) continue;
        const ff_blend_vertex *vertex = &space->vertices[blend->vertex[i]];
        duration += blend->weight[i] * vertex->period * (vertex->key[section + 1] - vertex->key[section]);
    }
    return duration;
}

double ff_phase_duration(const ff_blend_space *space, const ff_blend *blend, double from, double to)
{
    double total = 0.0, u = from;
    while (u < to) {
        double floor_u = floor(u);
        double next = ff_min(floor_u + 1.0, to);
        total += (next - u) * section_duration(space, blend, (int)ff_phase_wrap(floor_u));
        u = next;
    }
    return total;
}

double ff_phase_advance(const ff_blend_space *space, const ff_blend *blend, double phase, double dt)
{
    double u = ff_phase_wrap(phase);
    for (int guard = 0; guard < 16 && dt > 0.0; ++guard) {
        int section = (int)u;
        double duration = section_duration(space, blend, section);
        double left = (section + 1 - u) * duration;
        if (dt < left) return u + dt / duration;
        dt -= left;
        u = section + 1 < FF_GAIT_KEYS ? section + 1 : 0.0;
    }
    return u;
}

void ff_blend_lock(const ff_blend_space *space, const ff_blend *blend, int foot, double *start,
                   double *length)
{
    *start = *length = 0.0;
    if (blend->way == FF_SEMI_PROCEDURAL) {
        /* Read backwards, a foot stands from where it let go to where it came down. */
        const double *hold = space->model.hold;
        double back = ff_gait_model_backward(blend->rates);
        double from = ff_clip_phase(blend, ff_lerp(hold[0], 1.0 - hold[1], back) * blend->stance);
        double to = ff_clip_phase(blend, ff_lerp(hold[1], 1.0 - hold[0], back) * blend->stance);
        *start = 2.0 * foot + from;
        *length = to - from;
        return;
    }
    for (int i = 0; i < FF_BLEND_MAX; ++i) {
        if (blend->vertex[i] < 0) continue;
        *start += blend->weight[i] * space->vertices[blend->vertex[i]].lock_start[foot];
        *length += blend->weight[i] * space->vertices[blend->vertex[i]].lock_length[foot];
    }
}
