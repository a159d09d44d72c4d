#include "runtime/export/recording.h"

#include "runtime/core/base/fail.h"

#include <string.h>

#define POSE_RATE 30.0
#define POSE_RATE_LEAST 5.0
#define POSE_BYTES_MOST (768.0 * 1024.0 * 1024.0)

ff_status ff_recording_create(uint32_t agents, uint32_t joints, double step, uint64_t most_steps,
                              ff_recording *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    if (agents == 0 || joints == 0 || joints > FF_FIGURE_MAX_JOINTS || !(step > 0.0))
        return ff_fail(error, FF_ERR_ARGUMENT, "a recording needs agents, joints and a positive step");
    double pose_bytes = (double)agents * (12.0 + 8.0 * joints);
    double stride = ff_max(1.0, floor(1.0 / (POSE_RATE * step) + 0.5));
    stride = ff_max(stride, ceil((double)most_steps * pose_bytes / POSE_BYTES_MOST));
    if (stride * step > 1.0 / POSE_RATE_LEAST && stride > 1.0)
        return ff_fail(error, FF_ERR_RANGE,
                       "%u agents for %.0f s do not fit the %.0f MB set aside for poses: run fewer agents or "
                       "fewer seconds",
                       agents, (double)most_steps * step, POSE_BYTES_MOST / 1048576.0);
    out->agent_count = agents;
    out->joint_count = joints;
    out->step = step;
    out->pose_stride = (uint32_t)stride;
    return FF_OK;
}

void ff_recording_free(ff_recording *recording)
{
    ff_array_free(&recording->tracks);
    ff_array_free(&recording->hips);
    ff_array_free(&recording->rotations);
    memset(recording, 0, sizeof *recording);
}

static ff_status begin_pose(ff_recording *recording, ff_error *error)
{
    size_t agents = recording->agent_count, turns = agents * recording->joint_count;
    float(*hips)[3] = ff_array_grow(&recording->hips, agents, sizeof *hips);
    int16_t(*rotations)[4] = ff_array_grow(&recording->rotations, turns, sizeof *rotations);
    if (!hips || !rotations) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for another pose");
    if (recording->pose_count > 0) {
        memcpy(hips, hips - agents, agents * sizeof *hips);
        memcpy(rotations, rotations - turns, turns * sizeof *rotations);
    } else {
        memset(hips, 0, agents * sizeof *hips);
        memset(rotations, 0, turns * sizeof *rotations);
    }
    ++recording->pose_count;
    return FF_OK;
}

ff_status ff_recording_begin(ff_recording *recording, ff_error *error)
{
    ff_track *tracks = ff_array_grow(&recording->tracks, recording->agent_count, sizeof *tracks);
    if (!tracks) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for another step");
    if (recording->step_count > 0)
        memcpy(tracks, tracks - recording->agent_count, recording->agent_count * sizeof *tracks);
    else
        memset(tracks, 0, recording->agent_count * sizeof *tracks);
    for (uint32_t i = 0; i < recording->agent_count; ++i)
        tracks[i].present = 0;
    ++recording->step_count;
    return ff_recording_wants_pose(recording) ? begin_pose(recording, error) : FF_OK;
}

bool ff_recording_wants_pose(const ff_recording *recording)
{
    return recording->pose_stride > 0 && (recording->step_count - 1) % recording->pose_stride == 0;
}

void ff_recording_set_track(ff_recording *recording, uint32_t agent, const ff_agent_state *state)
{
    ff_track *tracks = recording->tracks.data;
    tracks[(size_t)(recording->step_count - 1) * recording->agent_count + agent] =
        (ff_track){.position = state->position,
                   .heading = (float)state->heading,
                   .speed = (float)ff_length2(state->velocity),
                   .scale = (float)(state->scale > 0.0 ? state->scale : 1.0),
                   .present = 1,
                   .reached = state->reached,
                   .planted = {state->planted[0], state->planted[1]}};
}

static int16_t quantise(double value)
{
    return (int16_t)floor(ff_clamp(value, -1.0, 1.0) * 32767.0 + 0.5);
}

bool ff_recording_is_posed(const ff_recording *recording, uint32_t agent)
{
    if (recording->pose_count == 0) return false;
    const int16_t *raw = ff_recording_raw_rotations(recording, recording->pose_count - 1, agent)[0];
    return raw[0] || raw[1] || raw[2] || raw[3];
}

static void copy_back(ff_recording *recording, uint32_t agent)
{
    size_t joints = recording->joint_count, many = recording->agent_count, last = recording->pose_count - 1;
    float(*hips)[3] = recording->hips.data;
    int16_t(*rotations)[4] = recording->rotations.data;
    for (size_t pose = 0; pose < last; ++pose) {
        memcpy(hips[pose * many + agent], hips[last * many + agent], sizeof *hips);
        memcpy(rotations[(pose * many + agent) * joints], rotations[(last * many + agent) * joints],
               joints * sizeof *rotations);
    }
}

void ff_recording_set_pose(ff_recording *recording, uint32_t agent, ff_vec3 hips, const ff_quat *rotations)
{
    bool first = !ff_recording_is_posed(recording, agent);
    size_t index = (size_t)(recording->pose_count - 1) * recording->agent_count + agent;
    float(*place)[3] = recording->hips.data;
    place[index][0] = (float)hips.x;
    place[index][1] = (float)hips.y;
    place[index][2] = (float)hips.z;
    int16_t(*raw)[4] = recording->rotations.data;
    raw += index * recording->joint_count;
    /* q and -q are one rotation: keep each joint on the side it was on, for samplers that mix component-wise. */
    int16_t(*last)[4] = raw;
    if (recording->pose_count > 1) last -= (size_t)recording->agent_count * recording->joint_count;
    for (uint32_t j = 0; j < recording->joint_count; ++j) {
        ff_quat q = ff_quat_unit(rotations[j]);
        double side = q.x * last[j][0] + q.y * last[j][1] + q.z * last[j][2] + q.w * last[j][3];
        double sign = side < 0.0 ? -1.0 : 1.0;
        raw[j][0] = quantise(q.x * sign);
        raw[j][1] = quantise(q.y * sign);
        raw[j][2] = quantise(q.z * sign);
        raw[j][3] = quantise(q.w * sign);
    }
    if (first) copy_back(recording, agent);
}

void ff_recording_end(ff_recording *recording)
{
    if (recording->step_count < 2) return;
    ff_track *now =
        (ff_track *)recording->tracks.data + (size_t)(recording->step_count - 1) * recording->agent_count;
    const ff_track *before = now - recording->agent_count;
    for (uint32_t i = 0; i < recording->agent_count; ++i)
        if (before[i].present && !now[i].present) now[i].reached = 1;
}

/* Keep the first `few` of every `many` elements. */
static void thin_out(ff_array *array, size_t size, size_t many, size_t few)
{
    size_t rows = array->count / many;
    unsigned char *data = array->data;
    for (size_t row = 1; row < rows; ++row)
        memmove(data + row * few * size, data + row * many * size, few * size);
    array->count = rows * few;
}

void ff_recording_trim(ff_recording *recording, uint32_t agents)
{
    size_t many = recording->agent_count, joints = recording->joint_count;
    if (agents == 0 || agents >= many) return;
    thin_out(&recording->tracks, sizeof(ff_track), many, agents);
    thin_out(&recording->hips, sizeof(float[3]), many, agents);
    thin_out(&recording->rotations, sizeof(int16_t[4]), many * joints, agents * joints);
    recording->agent_count = agents;
}

ff_span ff_recording_span(const ff_recording *recording, uint32_t agent)
{
    ff_span span = {0, 0};
    while (span.first < recording->step_count && !ff_recording_track(recording, span.first, agent)->present)
        ++span.first;
    if (span.first == recording->step_count) return (ff_span){0, 0};
    span.end = span.first;
    while (span.end < recording->step_count && ff_recording_track(recording, span.end, agent)->present)
        ++span.end;
    return span;
}

const ff_track *ff_recording_track(const ff_recording *recording, uint32_t step, uint32_t agent)
{
    const ff_track *tracks = recording->tracks.data;
    return tracks + (size_t)step * recording->agent_count + agent;
}

const int16_t (*ff_recording_raw_rotations(const ff_recording *recording, uint32_t pose, uint32_t agent))[4]
{
    const int16_t(*raw)[4] = recording->rotations.data;
    return raw + ((size_t)pose * recording->agent_count + agent) * recording->joint_count;
}

const float *ff_recording_raw_hips(const ff_recording *recording, uint32_t pose, uint32_t agent)
{
    const float(*hips)[3] = recording->hips.data;
    return hips[(size_t)pose * recording->agent_count + agent];
}

double ff_recording_scale(const ff_recording *recording, uint32_t agent)
{
    for (uint32_t step = 0; step < recording->step_count; ++step) {
        const ff_track *track = ff_recording_track(recording, step, agent);
        if (track->present) return (double)track->scale;
    }
    return 1.0;
}

void ff_recording_pose(const ff_recording *recording, uint32_t pose, uint32_t agent, ff_vec3 *hips,
                       ff_quat *rotations)
{
    const float *place = ff_recording_raw_hips(recording, pose, agent);
    *hips = ff_v3(place[0], place[1], place[2]);
    const int16_t(*raw)[4] = ff_recording_raw_rotations(recording, pose, agent);
    for (uint32_t j = 0; j < recording->joint_count; ++j)
        rotations[j] = ff_quat_unit((ff_quat){raw[j][0], raw[j][1], raw[j][2], raw[j][3]});
}
