#include "preprocess/report/pack_read.h"

#include "preprocess/examples/derive.h"

#include <stdio.h>
#include <string.h>

void ff_pack_read_rig(const ff_pack *pack, ff_rig *out)
{
    static const int roles[FF_POINT_COUNT] = {
        [FF_POINT_HEAD_TOP] = FF_ROLE_HEAD_TOP, [FF_POINT_HAND_L] = FF_ROLE_HAND_L,
        [FF_POINT_HAND_R] = FF_ROLE_HAND_R,     [FF_POINT_TOE_L] = FF_ROLE_TOE_L,
        [FF_POINT_TOE_R] = FF_ROLE_TOE_R,       [FF_POINT_HEEL_L] = FF_BODY_HEEL_L,
        [FF_POINT_HEEL_R] = FF_BODY_HEEL_R};
    *out = (ff_rig){.leg = 0.0};
    for (uint32_t j = 0; j < pack->joint_count && j < FF_ROLE_JOINT_COUNT; ++j)
        out->offset[j] = ff_pack_joint_offset(pack, j);
    for (uint32_t p = 0; p < pack->point_count && p < FF_POINT_COUNT; ++p) {
        const float *offset = pack->points[p].offset;
        out->offset[roles[p]] = ff_v3((double)offset[0], (double)offset[1], (double)offset[2]);
    }
    out->leg = -(out->offset[FF_ROLE_KNEE_L].y + out->offset[FF_ROLE_ANKLE_L].y);
}

ff_status ff_pack_read_example(const ff_pack *pack, uint32_t index, ff_example *out, ff_error *error)
{
    const ff_pack_example *record = &pack->examples[index];
    const ff_pack_stream *stream = &pack->streams[record->stream];
    int n = (int)stream->frame_count;
    ff_status status = ff_example_alloc(out, n, error);
    for (int k = 0; k < n && status == FF_OK; ++k) {
        ff_vec3 hips;
        status = ff_pack_sample(pack, record->stream, k * ff_pack_stream_seconds(pack, record->stream) / n, 0,
                                NULL, &hips, out->rotations + (size_t)k * FF_ROLE_JOINT_COUNT, error);
        out->hips[k] = ff_v3(hips.z, hips.x, hips.y);
    }
    if (status != FF_OK) {
        ff_example_free(out);
        return status;
    }
    memcpy(out->feet, &pack->feet[2 * stream->first_frame], 2 * (size_t)n * sizeof *out->feet);
    out->record = *record;
    if (pack->loop_count > 0) out->loop = pack->loops[index];
    snprintf(out->name, sizeof out->name, "%.95s", ff_pack_string(pack, record->name));
    return FF_OK;
}

ff_status ff_pack_play_gait(const ff_pack *pack, const ff_rig *rig, uint32_t example, ff_example *out,
                            ff_error *error)
{
    ff_example base;
    ff_gait_fit fit = {.gait = *pack->gait};
    const ff_pack_example *r = &pack->examples[example];
    memcpy(fit.path, pack->gait_path, sizeof fit.path);
    ff_status status = ff_pack_read_example(pack, pack->gait->example, &base, error);
    if (status != FF_OK) return status;
    ff_derive_target target = {"semi-procedural", (double)r->v_forward, (double)r->v_left,
                               (double)r->turn_rate, 0.0};
    status = ff_derive_walk(rig, &base, &fit, &target, out, error);
    ff_example_free(&base);
    return status;
}
