#include "mocap/generator/skeleton.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

typedef struct ff_body_joint {
    ff_role role, parent;
    const char *name;
    ff_vec3 offset; /* of the left or middle joint */
} ff_body_joint;

#define REST_HIPS (FF_BODY_ANKLE_HEIGHT + FF_BODY_LEG + FF_BODY_ROOT_UP)
#define HEAD_JOINT 0.105 /* of the 0.345 from neck base to crown */

/* Depth first, as motion files list joints. Right joints follow from the left ones. */
static const ff_body_joint joints[FF_ROLE_COUNT] = {
    {FF_ROLE_HIPS, FF_ROLE_NONE, "Hips", {0, REST_HIPS, -FF_BODY_ROOT_BACK}},
    {FF_ROLE_HIP_L, FF_ROLE_HIPS, "LeftUpLeg", {FF_BODY_HIP_HALF, -FF_BODY_ROOT_UP, FF_BODY_ROOT_BACK}},
    {FF_ROLE_KNEE_L, FF_ROLE_HIP_L, "LeftLeg", {0, -FF_BODY_THIGH, 0}},
    {FF_ROLE_ANKLE_L, FF_ROLE_KNEE_L, "LeftFoot", {0, -FF_BODY_SHANK, 0}},
    {FF_ROLE_BALL_L,
     FF_ROLE_ANKLE_L,
     "LeftToeBase",
     {0, FF_BODY_BALL_HEIGHT - FF_BODY_ANKLE_HEIGHT, FF_BODY_FOOT}},
    {FF_ROLE_TOE_L, FF_ROLE_BALL_L, "LeftToeEnd", {0, 0, FF_BODY_TOES}},
    {FF_ROLE_HIP_R, FF_ROLE_HIPS, "RightUpLeg", {0, 0, 0}},
    {FF_ROLE_KNEE_R, FF_ROLE_HIP_R, "RightLeg", {0, 0, 0}},
    {FF_ROLE_ANKLE_R, FF_ROLE_KNEE_R, "RightFoot", {0, 0, 0}},
    {FF_ROLE_BALL_R, FF_ROLE_ANKLE_R, "RightToeBase", {0, 0, 0}},
    {FF_ROLE_TOE_R, FF_ROLE_BALL_R, "RightToeEnd", {0, 0, 0}},
    {FF_ROLE_SPINE, FF_ROLE_HIPS, "Spine", {0, 0.075, 0}},
    {FF_ROLE_CHEST, FF_ROLE_SPINE, "Chest", {0, 0.135, -0.010}},
    {FF_ROLE_NECK, FF_ROLE_CHEST, "Neck", {0, 0.150, 0.005}},
    {FF_ROLE_HEAD, FF_ROLE_NECK, "Head", {0, HEAD_JOINT, 0.015}},
    {FF_ROLE_HEAD_TOP, FF_ROLE_HEAD, "HeadEnd", {0, 0.215, 0.010}},
    {FF_ROLE_CLAVICLE_L, FF_ROLE_CHEST, "LeftShoulder", {0.025, 0.135, 0.010}},
    {FF_ROLE_SHOULDER_L, FF_ROLE_CLAVICLE_L, "LeftArm", {0.150, 0.030, -0.010}},
    {FF_ROLE_ELBOW_L, FF_ROLE_SHOULDER_L, "LeftForeArm", {0.3535 * FF_BODY_LEG, 0, 0}},
    {FF_ROLE_WRIST_L, FF_ROLE_ELBOW_L, "LeftHand", {0.245, 0, 0}},
    {FF_ROLE_HAND_L, FF_ROLE_WRIST_L, "LeftHandEnd", {0.160, 0, 0}},
    {FF_ROLE_CLAVICLE_R, FF_ROLE_CHEST, "RightShoulder", {0, 0, 0}},
    {FF_ROLE_SHOULDER_R, FF_ROLE_CLAVICLE_R, "RightArm", {0, 0, 0}},
    {FF_ROLE_ELBOW_R, FF_ROLE_SHOULDER_R, "RightForeArm", {0, 0, 0}},
    {FF_ROLE_WRIST_R, FF_ROLE_ELBOW_R, "RightHand", {0, 0, 0}},
    {FF_ROLE_HAND_R, FF_ROLE_WRIST_R, "RightHandEnd", {0, 0, 0}},
};

/* The left counterpart of a right role; other roles as they are. */
static ff_role left_of(ff_role role)
{
    switch (role) {
    case FF_ROLE_CLAVICLE_R:
        return FF_ROLE_CLAVICLE_L;
    case FF_ROLE_SHOULDER_R:
        return FF_ROLE_SHOULDER_L;
    case FF_ROLE_ELBOW_R:
        return FF_ROLE_ELBOW_L;
    case FF_ROLE_WRIST_R:
        return FF_ROLE_WRIST_L;
    case FF_ROLE_HIP_R:
        return FF_ROLE_HIP_L;
    case FF_ROLE_KNEE_R:
        return FF_ROLE_KNEE_L;
    case FF_ROLE_ANKLE_R:
        return FF_ROLE_ANKLE_L;
    case FF_ROLE_BALL_R:
        return FF_ROLE_BALL_L;
    case FF_ROLE_HAND_R:
        return FF_ROLE_HAND_L;
    case FF_ROLE_TOE_R:
        return FF_ROLE_TOE_L;
    default:
        return role;
    }
}

static int index_of(ff_role role)
{
    for (int i = 0; i < FF_ROLE_COUNT; ++i)
        if (joints[i].role == role) return i;
    return -1;
}

ff_vec3 ff_body_offset(ff_role role)
{
    ff_role left = left_of(role);
    ff_vec3 offset = joints[index_of(left)].offset;
    if (left != role) offset.x = -offset.x;
    return offset;
}

static char *copied(const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    if (copy) memcpy(copy, text, size);
    return copy;
}

ff_status ff_body_clip(const char *name, int frame_count, ff_clip *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    out->joint_count = FF_ROLE_COUNT;
    out->track_count = 1;
    out->frame_count = frame_count;
    out->frame_time = 1.0 / 120.0;
    out->unit_m = 1.0;
    size_t rotation_count = (size_t)frame_count * FF_ROLE_COUNT;
    out->name = copied(name);
    out->source = copied("built in");
    out->joints = ff_calloc(FF_ROLE_COUNT, sizeof *out->joints);
    out->rotations = ff_calloc(rotation_count, sizeof *out->rotations);
    out->positions = ff_calloc((size_t)frame_count, sizeof *out->positions);
    if (!out->name || !out->source || !out->joints || !out->rotations || !out->positions) {
        ff_clip_free(out);
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the clip %s of %d frames", name, frame_count);
    }
    for (int j = 0; j < FF_ROLE_COUNT; ++j) {
        ff_joint *joint = &out->joints[j];
        strncpy(joint->name, joints[j].name, sizeof joint->name - 1);
        joint->role = joints[j].role;
        joint->parent = joints[j].parent == FF_ROLE_NONE ? -1 : index_of(joints[j].parent);
        joint->offset = ff_body_offset(joint->role);
        joint->track = j == 0 ? 0 : -1;
        joint->end_site = joint->role >= FF_ROLE_JOINT_COUNT;
    }
    for (size_t i = 0; i < rotation_count; ++i)
        out->rotations[i] = FF_QUAT_IDENTITY;
    for (int f = 0; f < frame_count; ++f)
        out->positions[f] = joints[0].offset;
    return FF_OK;
}
