/* clip_change.h - clips altered in ways that must not matter, for tests of whatever reads clips. */
#ifndef FF_CLIP_CHANGE_H
#define FF_CLIP_CHANGE_H

#include "mocap/clip.h"
#include "runtime/core/base/random.h"
#include "tests/check.h"

/* Every step-th frame of a clip from frame first on, as a clip of its own. */
static inline ff_clip clip_every(const ff_clip *from, int first, int step)
{
    ff_clip clip = *from;
    size_t joints = (size_t)from->joint_count, tracks = (size_t)from->track_count;
    clip.frame_count = (from->frame_count - 1 - first) / step + 1;
    clip.frame_time = from->frame_time * step;
    size_t frames = (size_t)clip.frame_count;
    clip.name = calloc(1, strlen(from->name) + 1);
    clip.source = calloc(1, 1);
    clip.joints = calloc(joints, sizeof *clip.joints);
    clip.rotations = calloc(frames * joints, sizeof *clip.rotations);
    clip.positions = calloc(frames * tracks + 1, sizeof *clip.positions);
    assert_true(clip.name && clip.source && clip.joints && clip.rotations && clip.positions);
    memcpy(clip.name, from->name, strlen(from->name));
    memcpy(clip.joints, from->joints, joints * sizeof *clip.joints);
    for (size_t f = 0; f < frames; ++f) {
        size_t g = (size_t)first + f * (size_t)step;
        memcpy(clip.rotations + f * joints, from->rotations + g * joints, joints * sizeof *clip.rotations);
        memcpy(clip.positions + f * tracks, from->positions + g * tracks, tracks * sizeof *clip.positions);
    }
    return clip;
}

static inline ff_clip clip_copy(const ff_clip *from)
{
    return clip_every(from, 0, 1);
}

/* Left and right exchanged: the whole skeleton reflected, then every role given to the other side. */
static inline void clip_reflect(ff_clip *clip)
{
    for (int j = 0; j < clip->joint_count; ++j) {
        clip->joints[j].offset.x = -clip->joints[j].offset.x;
        clip->joints[j].role = ff_role_mirror(clip->joints[j].role);
    }
    for (int k = 0; k < clip->frame_count * clip->joint_count; ++k) {
        clip->rotations[k].y = -clip->rotations[k].y;
        clip->rotations[k].z = -clip->rotations[k].z;
    }
    for (int k = 0; k < clip->frame_count * clip->track_count; ++k)
        clip->positions[k].x = -clip->positions[k].x;
}

/* The world turned by q, then moved. Joint 0 must be the only root and have a position track. */
static inline void clip_move(ff_clip *clip, ff_quat q, ff_vec3 by)
{
    int track = clip->joints[0].track;
    assert_true(track >= 0);
    for (int f = 0; f < clip->frame_count; ++f) {
        ff_vec3 *at = &clip->positions[f * clip->track_count + track];
        *at = ff_add3(ff_quat_rotate(q, *at), by);
        ff_quat *turn = &clip->rotations[f * clip->joint_count];
        *turn = ff_quat_mul(q, *turn);
    }
}

/* White noise on every coordinate of every joint's place, as markers have it; rotations stay. */
static inline void clip_shake(ff_clip *clip, double metres, uint64_t seed)
{
    int joints = clip->joint_count;
    ff_vec3 *at = calloc((size_t)joints, sizeof *at),
            *local = calloc((size_t)clip->frame_count * (size_t)joints, sizeof *local);
    ff_quat *turn = calloc((size_t)joints, sizeof *turn);
    ff_random random = {seed, 0, 0};
    assert_true(at && local && turn);
    for (int f = 0; f < clip->frame_count; ++f) {
        ff_clip_pose(clip, f, at, turn);
        for (int j = 0; j < joints; ++j) {
            double n[3];
            for (int k = 0; k < 3; ++k)
                n[k] = metres * ff_random_normal(&random);
            at[j] = ff_add3(at[j], ff_v3(n[0], n[1], n[2]));
        }
        for (int j = 0; j < joints; ++j) {
            int p = clip->joints[j].parent;
            local[f * joints + j] =
                p < 0 ? at[j] : ff_quat_rotate(ff_quat_conj(turn[p]), ff_sub3(at[j], at[p]));
        }
    }
    free(clip->positions);
    clip->positions = local;
    clip->track_count = joints;
    for (int j = 0; j < joints; ++j)
        clip->joints[j].track = j;
    free(at);
    free(turn);
}

#endif
