#include "preprocess/motion/retarget.h"

#include "runtime/core/base/fail.h"

#include <string.h>

/* A bone shorter than this has no direction (m). */
#define BONE_MIN 0.01
/* Knees and elbows bent less than this (sine) do not show their axis. */
#define BEND_MIN 0.2
/* Frames a skeleton is calibrated on at most. */
#define CALIBRATION_FRAMES 240

/* The role at the far end of a joint's bone, for bones that have a clear direction. */
static ff_role bone_end(int role)
{
    switch (role) {
    case FF_ROLE_CLAVICLE_L:
        return FF_ROLE_SHOULDER_L;
    case FF_ROLE_SHOULDER_L:
        return FF_ROLE_ELBOW_L;
    case FF_ROLE_ELBOW_L:
        return FF_ROLE_WRIST_L;
    case FF_ROLE_WRIST_L:
        return FF_ROLE_HAND_L;
    case FF_ROLE_CLAVICLE_R:
        return FF_ROLE_SHOULDER_R;
    case FF_ROLE_SHOULDER_R:
        return FF_ROLE_ELBOW_R;
    case FF_ROLE_ELBOW_R:
        return FF_ROLE_WRIST_R;
    case FF_ROLE_WRIST_R:
        return FF_ROLE_HAND_R;
    case FF_ROLE_HIP_L:
        return FF_ROLE_KNEE_L;
    case FF_ROLE_KNEE_L:
        return FF_ROLE_ANKLE_L;
    case FF_ROLE_HIP_R:
        return FF_ROLE_KNEE_R;
    case FF_ROLE_KNEE_R:
        return FF_ROLE_ANKLE_R;
    default:
        return FF_ROLE_NONE;
    }
}

/* The rotation that takes +Y to up and +Z to forward (unit, made perpendicular to up). */
static ff_quat frame_rotation(ff_vec3 up, ff_vec3 forward)
{
    ff_quat q = ff_quat_between(ff_v3(0.0, 1.0, 0.0), up);
    ff_vec3 z = ff_quat_rotate(q, ff_v3(0.0, 0.0, 1.0));
    ff_vec3 flat = ff_unit3(ff_madd3(forward, up, -ff_dot3(forward, up)));
    double angle = ff_atan2(ff_dot3(ff_cross3(z, flat), up), ff_dot3(z, flat));
    return ff_quat_mul(ff_quat_axis(up, angle), q);
}

/* Direction to the left of a body from its hip and shoulder joints (algorithms A.4), not of unit length. */
static ff_vec3 body_left(const int *joint, const ff_vec3 *at)
{
    ff_vec3 left = ff_sub3(at[joint[FF_ROLE_HIP_L]], at[joint[FF_ROLE_HIP_R]]);
    if (joint[FF_ROLE_SHOULDER_L] >= 0 && joint[FF_ROLE_SHOULDER_R] >= 0)
        left = ff_add3(left, ff_sub3(at[joint[FF_ROLE_SHOULDER_L]], at[joint[FF_ROLE_SHOULDER_R]]));
    return left;
}

/* left = (cos psi, 0, -sin psi) */
static double heading_of_left(ff_vec3 left)
{
    return ff_atan2(-left.z, left.x);
}

double ff_clip_leg_length(const int *joint, const ff_vec3 *at)
{
    double sum = 0.0;
    for (int side = 0; side < 2; ++side) {
        int hip = joint[side ? FF_ROLE_HIP_R : FF_ROLE_HIP_L],
            knee = joint[side ? FF_ROLE_KNEE_R : FF_ROLE_KNEE_L];
        int ankle = joint[side ? FF_ROLE_ANKLE_R : FF_ROLE_ANKLE_L];
        if (hip < 0 || knee < 0 || ankle < 0) return 0.0;
        sum += ff_length3(ff_sub3(at[knee], at[hip])) + ff_length3(ff_sub3(at[ankle], at[knee]));
    }
    return 0.5 * sum;
}

bool ff_rest_is_standing(const ff_clip *clip, const int *joint, ff_vec3 *at, double *heading)
{
    *heading = 0.0;
    ff_clip_rest_pose(clip, at);
    double leg = ff_clip_leg_length(joint, at);
    if (!(leg > 0.0)) return false;
    for (int side = 0; side < 2; ++side) {
        ff_vec3 hip = at[joint[side ? FF_ROLE_HIP_R : FF_ROLE_HIP_L]];
        ff_vec3 ankle = at[joint[side ? FF_ROLE_ANKLE_R : FF_ROLE_ANKLE_L]];
        if (hip.y - ankle.y < 0.7 * leg) return false;
    }
    int top = joint[FF_ROLE_HEAD] >= 0 ? joint[FF_ROLE_HEAD] : joint[FF_ROLE_NECK];
    if (top >= 0 && at[top].y - at[joint[FF_ROLE_HIP_L]].y < 0.3 * leg) return false;
    ff_vec3 left = body_left(joint, at);
    if (ff_length2(ff_plane(left)) < 0.1 * leg) return false;
    *heading = heading_of_left(left);
    return true;
}

static void align_to_rest(const ff_rig *rig, const ff_vec3 *rest, double heading, ff_retarget *out)
{
    ff_quat facing = ff_quat_yaw(heading);
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
        out->align[r] = facing;
        ff_role end = bone_end(r);
        if (end == FF_ROLE_NONE || out->joint[r] < 0 || out->joint[end] < 0) continue;
        ff_vec3 bone = ff_sub3(rest[out->joint[end]], rest[out->joint[r]]);
        if (ff_length3(bone) < BONE_MIN) continue;
        ff_vec3 from = ff_quat_rotate(facing, ff_unit3(rig->offset[end]));
        out->align[r] = ff_quat_mul(ff_quat_between(from, ff_unit3(bone)), facing);
    }
}

/* ------------------------------------------------------------------------- calibration on the motion itself */

/* World rotation of the rig's limb joint whose bone points along bone and whose knee or elbow turns about hinge. */
static ff_quat limb_rotation(int role, ff_vec3 bone, ff_vec3 hinge)
{
    if (role >= FF_ROLE_HIP_L) { /* legs: bone along -Y, hinge +X; forward = left x up */
        ff_vec3 up = ff_scale3(bone, -1.0);
        return frame_rotation(up, ff_cross3(hinge, up));
    }
    /* Arms out, elbows bending forwards: bone along +-X, hinge -+Y (thumbs forward). */
    double side = role < FF_ROLE_CLAVICLE_R ? 1.0 : -1.0;
    ff_vec3 up = ff_scale3(hinge, -side);
    return frame_rotation(up, ff_cross3(ff_scale3(bone, side), up));
}

/* The world rotation the rig's joint should have in this pose; false when the pose does not show it. */
static bool wanted_rotation(const ff_rig *rig, const int *joint, const ff_vec3 *at, int role, double heading,
                            ff_quat *out)
{
    *out = ff_quat_yaw(heading);
    bool upper = role == FF_ROLE_SHOULDER_L || role == FF_ROLE_SHOULDER_R || role == FF_ROLE_HIP_L ||
                 role == FF_ROLE_HIP_R;
    bool lower = role == FF_ROLE_ELBOW_L || role == FF_ROLE_ELBOW_R || role == FF_ROLE_KNEE_L ||
                 role == FF_ROLE_KNEE_R;
    bool wrist = role == FF_ROLE_WRIST_L || role == FF_ROLE_WRIST_R;
    if (wrist) role -= 1; /* a hand is taken to be in line with the forearm on average */
    if (role == FF_ROLE_CLAVICLE_L || role == FF_ROLE_CLAVICLE_R) {
        ff_vec3 bone = ff_sub3(at[joint[role + 1]], at[joint[role]]);
        if (joint[role + 1] < 0 || ff_length3(bone) < BONE_MIN) return true;
        ff_vec3 from = ff_quat_rotate(*out, ff_unit3(rig->offset[role + 1]));
        *out = ff_quat_mul(ff_quat_between(from, ff_unit3(bone)), *out);
        return true;
    }
    if (!upper && !lower && !wrist) return true;
    int first = upper ? role : role - 1; /* hip, knee, ankle and shoulder, elbow, wrist follow each other */
    if (joint[first] < 0 || joint[first + 1] < 0 || joint[first + 2] < 0) return false;
    ff_vec3 over = ff_unit3(ff_sub3(at[joint[first + 1]], at[joint[first]]));
    ff_vec3 under = ff_unit3(ff_sub3(at[joint[first + 2]], at[joint[first + 1]]));
    ff_vec3 hinge = ff_cross3(over, under);
    if (ff_length3(hinge) < BEND_MIN) return false;
    *out = limb_rotation(role, upper ? over : under, ff_unit3(hinge));
    return true;
}

/* Mean of (clip's world rotation)^-1 * (wanted world rotation) over the clip. */
static void align_to_motion(const ff_rig *rig, const ff_clip *clip, ff_retarget *out)
{
    ff_vec3 at[FF_CLIP_MAX_JOINTS];
    ff_quat turned[FF_CLIP_MAX_JOINTS], sum[FF_ROLE_JOINT_COUNT];
    memset(sum, 0, sizeof sum);
    int frames = clip->frame_count - clip->rest_frames;
    int stride = frames / CALIBRATION_FRAMES + 1;
    for (int k = clip->rest_frames; k < clip->frame_count; k += stride) {
        ff_clip_pose(clip, k, at, turned);
        double heading = heading_of_left(body_left(out->joint, at));
        for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
            ff_quat wanted;
            if (out->joint[r] < 0 || !wanted_rotation(rig, out->joint, at, r, heading, &wanted)) continue;
            ff_quat q = ff_quat_mul(ff_quat_conj(turned[out->joint[r]]), wanted);
            double sign = ff_quat_dot(q, sum[r]) < 0.0 ? -1.0 : 1.0;
            sum[r] = (ff_quat){sum[r].x + sign * q.x, sum[r].y + sign * q.y, sum[r].z + sign * q.z,
                               sum[r].w + sign * q.w};
        }
    }
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        out->align[r] = ff_quat_unit(sum[r]);
}

/* ---------------------------------------------------------------------------------------------------- feet */

static void align_feet(const ff_plants *plants, ff_retarget *out)
{
    for (int foot = 0; foot < 2; ++foot) {
        const ff_foot_shape *shape = &plants->shape[foot];
        ff_vec3 along = ff_sub3(shape->ball, shape->heel);
        ff_vec3 up =
            ff_scale3(shape->heel, -1.0); /* the ankle is over the heel-ball line: its plane is upright */
        if (ff_length3(along) < BONE_MIN) continue;
        along = ff_unit3(along);
        up = ff_madd3(up, along, -ff_dot3(up, along));
        if (ff_length3(up) < 1e-4) continue;
        out->align[foot ? FF_ROLE_ANKLE_R : FF_ROLE_ANKLE_L] = frame_rotation(ff_unit3(up), along);
    }
}

/* Toes lie along the foot, in the mean of the frames in which the foot is flat (of all frames when it never is). */
static void align_toes(const ff_clip *clip, const ff_plants *plants, ff_retarget *out)
{
    ff_vec3 at[FF_CLIP_MAX_JOINTS], sum[2] = {{0}};
    ff_quat turned[FF_CLIP_MAX_JOINTS];
    for (int pass = 0; pass < 2; ++pass) {
        for (int p = 0; p < plants->count; ++p) {
            const ff_plant *plant = &plants->items[p];
            int ball = out->joint[plant->foot ? FF_ROLE_BALL_R : FF_ROLE_BALL_L];
            int ankle = plant->foot ? FF_ROLE_ANKLE_R : FF_ROLE_ANKLE_L;
            bool done = pass == 1 && ff_length3(sum[plant->foot]) > 0.0;
            int from = pass ? plant->start : plant->flat_start, to = pass ? plant->end : plant->flat_end;
            if (ball < 0 || done || from < 0) continue;
            for (int k = from; k <= to && k < clip->frame_count; k += (to - from) / 8 + 1) {
                ff_clip_pose(clip, k, at, turned);
                ff_quat foot = ff_quat_mul(turned[out->joint[ankle]], out->align[ankle]);
                ff_vec3 along = ff_quat_rotate(foot, ff_v3(0.0, 0.0, 1.0));
                sum[plant->foot] =
                    ff_add3(sum[plant->foot], ff_quat_rotate(ff_quat_conj(turned[ball]), along));
            }
        }
    }
    for (int foot = 0; foot < 2; ++foot) {
        int ankle = foot ? FF_ROLE_ANKLE_R : FF_ROLE_ANKLE_L;
        out->toes[foot] = ff_length3(sum[foot]) > 0.0
                              ? ff_unit3(sum[foot])
                              : ff_quat_rotate(out->align[ankle], ff_v3(0.0, 0.0, 1.0));
    }
}

ff_status ff_retarget_begin(const ff_rig *rig, const ff_clip *clip, const ff_plants *plants, ff_retarget *out,
                            ff_error *error)
{
    memset(out, 0, sizeof *out);
    for (int r = 0; r < FF_ROLE_COUNT; ++r)
        out->joint[r] = ff_clip_find(clip, (ff_role)r);
    ff_vec3 at[FF_CLIP_MAX_JOINTS];
    ff_clip_pose(clip, clip->frame_count - 1, at, NULL);
    double leg = ff_clip_leg_length(out->joint, at);
    if (!(leg > 0.0) || out->joint[FF_ROLE_HIPS] < 0) {
        ff_fail(error, FF_ERR_NO_DATA,
                "no joint found for the hips, a knee or an ankle; name them in the catalogue's roles");
        ff_error_in_file(error, clip->source ? clip->source : "");
        return FF_ERR_NO_DATA;
    }
    out->scale = rig->leg / leg;
    double heading;
    if (ff_rest_is_standing(clip, out->joint, at, &heading)) {
        align_to_rest(rig, at, heading, out);
    } else {
        align_to_motion(rig, clip, out);
    }
    align_feet(plants, out);
    align_toes(clip, plants, out);
    return FF_OK;
}

/* Toes bend about one axis; what else the toe joint does in captured data is noise (synthesis study). */
static ff_quat toe_rotation(ff_quat foot, ff_vec3 along)
{
    ff_vec3 u = ff_quat_rotate(ff_quat_conj(foot), along);
    double up = ff_clamp(ff_atan2(u.y, u.z), -0.5, 1.2);
    return ff_quat_mul(foot, ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -up));
}

void ff_retarget_pose(const ff_retarget *retarget, const ff_rig *rig, const ff_clip *clip, int frame,
                      ff_vec3 *hips, ff_quat *world)
{
    ff_vec3 at[FF_CLIP_MAX_JOINTS];
    ff_quat turned[FF_CLIP_MAX_JOINTS];
    ff_clip_pose(clip, frame, at, turned);
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
        int j = retarget->joint[r];
        if (j < 0) {
            world[r] = r == 0 ? FF_QUAT_IDENTITY : world[ff_role_parent((ff_role)r)];
        } else if (r == FF_ROLE_BALL_L || r == FF_ROLE_BALL_R) {
            ff_vec3 along = ff_quat_rotate(turned[j], retarget->toes[r == FF_ROLE_BALL_R]);
            world[r] = toe_rotation(world[r - 1], along);
        } else {
            world[r] = ff_quat_mul(turned[j], retarget->align[r]);
        }
    }
    ff_vec3 middle = ff_lerp3(at[retarget->joint[FF_ROLE_HIP_L]], at[retarget->joint[FF_ROLE_HIP_R]], 0.5);
    ff_vec3 own = ff_lerp3(rig->offset[FF_ROLE_HIP_L], rig->offset[FF_ROLE_HIP_R], 0.5);
    *hips = ff_sub3(ff_scale3(middle, retarget->scale), ff_quat_rotate(world[FF_ROLE_HIPS], own));
}
