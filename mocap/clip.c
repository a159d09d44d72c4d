#include "mocap/clip.h"

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
