#include "runtime/core/posture.h"

#include "runtime/core/pose_stream.h"

#define SAMPLES 16

static const int trunk[4] = {FF_JOINT_SPINE, FF_JOINT_CHEST, FF_JOINT_NECK, FF_JOINT_HEAD};
static const int clavicle[2] = {FF_JOINT_CLAVICLE_L, FF_JOINT_CLAVICLE_R};

static ff_quat add(ff_quat sum, ff_quat q)
{
    double sign = ff_quat_dot(sum, q) < 0.0 ? -1.0 : 1.0;
    return (ff_quat){sum.x + sign * q.x, sum.y + sign * q.y, sum.z + sign * q.z, sum.w + sign * q.w};
}

ff_posture ff_posture_of_stream(const ff_pack *pack, uint32_t stream)
{
    ff_posture posture = {{{0.0, 0.0, 0.0, 0.0}}};
    for (int k = 0; k < SAMPLES; ++k) {
        ff_vec3 hips;
        ff_quat rotations[FF_JOINT_COUNT];
        ff_stream_pose(pack, stream, (double)k / SAMPLES, false, &hips, rotations);
        for (int j = 0; j < FF_JOINT_COUNT; ++j)
            posture.mean[j] = add(posture.mean[j], rotations[j]);
    }
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        posture.mean[j] = ff_quat_unit(posture.mean[j]);
    return posture;
}

void ff_posture_clavicles(const ff_pack *pack, ff_quat out[2])
{
    out[0] = out[1] = (ff_quat){0.0, 0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        ff_posture own = ff_posture_of_stream(pack, pack->examples[i].stream);
        for (int side = 0; side < 2; ++side)
            out[side] = add(out[side], own.mean[clavicle[side]]);
    }
    for (int side = 0; side < 2; ++side)
        out[side] = ff_quat_unit(out[side]);
}

void ff_posture_level(const ff_posture *own, const ff_quat clavicles[2], ff_quat *rotations)
{
    for (int side = 0; side < 2; ++side) {
        ff_quat *at = &rotations[clavicle[side]], *upper_arm = at + 1;
        ff_quat mean = own->mean[clavicle[side]];
        ff_quat level = ff_quat_mul(ff_quat_mul(clavicles[side], ff_quat_conj(mean)), *at);
        *upper_arm = ff_quat_mul(ff_quat_conj(level), ff_quat_mul(*at, *upper_arm));
        *at = level;
    }
    for (int i = 0; i < 4; ++i) {
        ff_quat mean = own->mean[trunk[i]];
        ff_vec3 turn = ff_quat_log(mean);
        ff_quat upright = ff_quat_exp(ff_v3(turn.x, turn.y, 0.0));
        rotations[trunk[i]] = ff_quat_mul(ff_quat_mul(upright, ff_quat_conj(mean)), rotations[trunk[i]]);
    }
}
