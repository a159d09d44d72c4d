#include "mocap/clip.h"

#include "runtime/core/base/fail.h"

#include <stdlib.h>
#include <string.h>

void ff_clip_free(ff_clip *clip)
{
    free(clip->name);
    free(clip->source);
    free(clip->joints);
    free(clip->rotations);
    free(clip->positions);
    memset(clip, 0, sizeof *clip);
}

static ff_vec3 local_offset(const ff_clip *clip, int frame, int joint)
{
    const ff_joint *j = &clip->joints[joint];
    return j->track < 0 ? j->offset
                        : clip->positions[(size_t)frame * (size_t)clip->track_count + (size_t)j->track];
}

void ff_clip_pose(const ff_clip *clip, int frame, ff_vec3 *positions, ff_quat *rotations)
{
    const ff_quat *local = clip->rotations + (size_t)frame * (size_t)clip->joint_count;
    ff_quat stack[FF_CLIP_MAX_JOINTS];
    ff_quat *world = rotations ? rotations : stack;
    for (int j = 0; j < clip->joint_count; ++j) {
        ff_vec3 offset = local_offset(clip, frame, j);
        int parent = clip->joints[j].parent;
        if (parent < 0) {
            positions[j] = offset;
            world[j] = local[j];
        } else {
            positions[j] = ff_add3(positions[parent], ff_quat_rotate(world[parent], offset));
            world[j] = ff_quat_mul(world[parent], local[j]);
        }
    }
}

void ff_clip_rest_pose(const ff_clip *clip, ff_vec3 *positions)
{
    for (int j = 0; j < clip->joint_count; ++j) {
        int parent = clip->joints[j].parent;
        positions[j] =
            parent < 0 ? clip->joints[j].offset : ff_add3(positions[parent], clip->joints[j].offset);
    }
}

int ff_clip_find(const ff_clip *clip, ff_role role)
{
    for (int j = 0; j < clip->joint_count; ++j)
        if (clip->joints[j].role == role) return j;
    return -1;
}

ff_status ff_clip_keep(ff_clip *clip, int first, int last, ff_error *error)
{
    if (last < 0) last = clip->frame_count - 1;
    if (first == 0 && last == clip->frame_count - 1) return FF_OK;
    if (first > last || last >= clip->frame_count)
        return ff_fail(error, FF_ERR_RANGE, "trim keeps frames %d to %d, but the file has frames 0 to %d",
                       first, last, clip->frame_count - 1);
    size_t joints = (size_t)clip->joint_count, tracks = (size_t)clip->track_count,
           n = (size_t)last - (size_t)first + 1;
    memmove(clip->rotations, clip->rotations + (size_t)first * joints, n * joints * sizeof *clip->rotations);
    if (tracks)
        memmove(clip->positions, clip->positions + (size_t)first * tracks,
                n * tracks * sizeof *clip->positions);
    clip->frame_count = last - first + 1;
    clip->rest_frames = clip->rest_frames > first ? clip->rest_frames - first : 0;
    return FF_OK;
}
