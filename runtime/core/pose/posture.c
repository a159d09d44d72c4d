#include "runtime/core/pose/posture.h"

#include "runtime/core/pack/pose_stream.h"

#define SAMPLES 16

static const int trunk[4] = {FF_JOINT_SPINE, FF_JOINT_CHEST, FF_JOINT_NECK, FF_JOINT_HEAD};
static const int clavicle[2] = {FF_JOINT_CLAVICLE_L, FF_JOINT_CLAVICLE_R};
static const int wrist[2] = {FF_JOINT_WRIST_L, FF_JOINT_WRIST_R};
static const int of_hips[3] = {FF_JOINT_SPINE, FF_JOINT_HIP_L, FF_JOINT_HIP_R};

static ff_quat add(ff_quat sum, ff_quat q)
{
    double sign = ff_quat_dot(sum, q) < 0.0 ? -1.0 : 1.0;
    return (ff_quat){sum.x + sign * q.x, sum.y + sign * q.y, sum.z + sign * q.z, sum.w + sign * q.w};
}

static void make_unit(ff_posture *posture)
{
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        posture->mean[j] = ff_quat_unit(posture->mean[j]);
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
    make_unit(&posture);
    return posture;
}

ff_posture ff_posture_of_gait(const ff_pack *pack, uint32_t gait)
{
    ff_posture posture = {{{0.0, 0.0, 0.0, 0.0}}};
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        if (pack->examples[i].gait != gait) continue;
        ff_posture own = ff_posture_of_stream(pack, pack->examples[i].stream);
        for (int j = 0; j < FF_JOINT_COUNT; ++j)
            posture.mean[j] = add(posture.mean[j], own.mean[j]);
    }
    make_unit(&posture);
    return posture;
}

/* mean with the pitch of another and, if upright, without roll. */
static ff_quat held(ff_quat mean, ff_quat other, bool upright)
{
    ff_vec3 turn = ff_quat_log(mean);
    return ff_quat_exp(ff_v3(ff_quat_log(other).x, turn.y, upright ? 0.0 : turn.z));
}

/* From one mean to another, for a rotation about it. */
static ff_quat moved(ff_quat to, ff_quat from, ff_quat rotation)
{
    return ff_quat_mul(ff_quat_mul(to, ff_quat_conj(from)), rotation);
}

void ff_posture_level(const ff_posture *own, const ff_posture *common, ff_quat *rotations)
{
    for (int side = 0; side < 2; ++side) {
        ff_quat *at = &rotations[clavicle[side]], *upper_arm = at + 1;
        ff_quat level = moved(common->mean[clavicle[side]], own->mean[clavicle[side]], *at);
        *upper_arm = ff_quat_mul(ff_quat_conj(level), ff_quat_mul(*at, *upper_arm));
        *at = level;
        ff_quat *hand = &rotations[wrist[side]];
        *hand = moved(common->mean[wrist[side]], own->mean[wrist[side]], *hand);
    }
    ff_quat hips = held(own->mean[FF_JOINT_HIPS], common->mean[FF_JOINT_HIPS], false);
    ff_quat level = moved(hips, own->mean[FF_JOINT_HIPS], rotations[FF_JOINT_HIPS]);
    ff_quat back = ff_quat_mul(ff_quat_conj(level), rotations[FF_JOINT_HIPS]);
    for (int i = 0; i < 3; ++i)
        rotations[of_hips[i]] = ff_quat_mul(back, rotations[of_hips[i]]);
    rotations[FF_JOINT_HIPS] = level;
    ff_quat spine =
        ff_quat_mul(ff_quat_mul(ff_quat_conj(hips), own->mean[FF_JOINT_HIPS]), own->mean[FF_JOINT_SPINE]);
    for (int i = 0; i < 4; ++i) {
        ff_quat mean = trunk[i] == FF_JOINT_SPINE ? spine : own->mean[trunk[i]];
        rotations[trunk[i]] = moved(held(mean, common->mean[trunk[i]], true), mean, rotations[trunk[i]]);
    }
}
