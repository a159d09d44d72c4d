#include "mocap/normal.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

static ff_vec3 across(const ff_clip *clip, const ff_vec3 *at, ff_role left, ff_role right)
{
    int l = ff_clip_find(clip, left), r = ff_clip_find(clip, right);
    return l < 0 || r < 0 ? ff_v3(0.0, 0.0, 0.0) : ff_sub3(at[l], at[r]);
}

bool ff_clip_heading(const ff_clip *clip, const ff_vec3 *at, double *heading)
{
    ff_vec3 left = ff_add3(across(clip, at, FF_ROLE_HIP_L, FF_ROLE_HIP_R),
                           across(clip, at, FF_ROLE_SHOULDER_L, FF_ROLE_SHOULDER_R));
    *heading = 0.0;
    if (ff_length2(ff_plane(left)) < 0.3 * ff_length3(left) || ff_length3(left) < 1e-6) return false;
    *heading = ff_atan2(-left.z, left.x); /* left = (cos, 0, -sin) */
    return true;
}

static void drop_rest_frames(ff_clip *clip)
{
    int rest = clip->rest_frames;
    if (rest <= 0 || rest >= clip->frame_count) return;
    size_t joints = (size_t)clip->joint_count, tracks = (size_t)clip->track_count,
           kept = (size_t)(clip->frame_count - rest), from = (size_t)rest;
    memmove(clip->rotations, clip->rotations + from * joints, kept * joints * sizeof *clip->rotations);
    if (tracks)
        memmove(clip->positions, clip->positions + from * tracks, kept * tracks * sizeof *clip->positions);
    clip->frame_count -= rest;
    clip->rest_frames = 0;
}

/* See everything from axes that are turned by -turn about the vertical: the rest pose turns with the motion. */
static void turn_all(ff_clip *clip, double angle)
{
    ff_quat turn = ff_quat_yaw(angle), back = ff_quat_yaw(-angle);
    for (int j = 0; j < clip->joint_count; ++j)
        clip->joints[j].offset = ff_quat_rotate(turn, clip->joints[j].offset);
    size_t rotations = (size_t)clip->frame_count * (size_t)clip->joint_count;
    for (size_t i = 0; i < rotations; ++i)
        clip->rotations[i] = ff_quat_mul(ff_quat_mul(turn, clip->rotations[i]), back);
    size_t positions = (size_t)clip->frame_count * (size_t)clip->track_count;
    for (size_t i = 0; i < positions; ++i)
        clip->positions[i] = ff_quat_rotate(turn, clip->positions[i]);
}

/* Move the motion, not the rest pose: by -from on the ground, then turn. */
static void place_motion(ff_clip *clip, ff_vec3 from, double angle)
{
    ff_quat turn = ff_quat_yaw(angle);
    ff_vec3 ground = ff_v3(from.x, 0.0, from.z);
    for (int j = 0; j < clip->joint_count; ++j) {
        const ff_joint *root = &clip->joints[j];
        if (root->parent >= 0) continue;
        for (int k = 0; k < clip->frame_count; ++k) {
            ff_quat *q = &clip->rotations[(size_t)k * (size_t)clip->joint_count + (size_t)j];
            *q = ff_quat_mul(turn, *q);
            if (root->track < 0) continue;
            ff_vec3 *p = &clip->positions[(size_t)k * (size_t)clip->track_count + (size_t)root->track];
            *p = ff_quat_rotate(turn, ff_sub3(*p, ground));
        }
    }
}

ff_status ff_clip_normalise(ff_clip *clip, ff_error *error)
{
    ff_vec3 *at = ff_calloc((size_t)clip->joint_count, sizeof *at);
    if (!at) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the joints of %s", clip->name);
    double heading;
    drop_rest_frames(clip);
    ff_clip_rest_pose(clip, at);
    if (ff_clip_heading(clip, at, &heading)) turn_all(clip, -heading);
    ff_clip_pose(clip, 0, at, NULL);
    int hips = ff_clip_find(clip, FF_ROLE_HIPS);
    ff_clip_heading(clip, at, &heading);
    place_motion(clip, at[hips < 0 ? 0 : hips], -heading);
    clip->unit_m = 1.0;
    free(at);
    return FF_OK;
}
