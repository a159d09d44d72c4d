/* clip_check.h - what must hold of any clip that a reader accepts. */
#ifndef FF_CLIP_CHECK_H
#define FF_CLIP_CHECK_H

#include "mocap/read.h"

static inline void must(bool holds)
{
    if (!holds) __builtin_trap();
}

/* Counts in range, rotations of unit length, everything finite; then on through ff_clip_finish to a pose. */
static inline void check_clip(ff_clip *clip, char up)
{
    static ff_vec3 at[FF_CLIP_MAX_JOINTS];
    must(clip->joint_count > 0 && clip->joint_count <= FF_CLIP_MAX_JOINTS && clip->frame_count > 0);
    must(clip->frame_time > 0.0 && clip->rest_frames < clip->frame_count);
    for (size_t i = 0; i < (size_t)clip->frame_count * (size_t)clip->joint_count; ++i)
        must(fabs(ff_quat_dot(clip->rotations[i], clip->rotations[i]) - 1.0) < 1e-9);
    ff_load_options options = ff_load_options_default();
    options.up = up;
    if (ff_clip_finish(clip, &options, 0.0, NULL) == FF_OK) {
        ff_clip_pose(clip, clip->frame_count - 1, at, NULL);
        for (int j = 0; j < clip->joint_count; ++j)
            must(isfinite(at[j].x) && isfinite(at[j].y) && isfinite(at[j].z));
    }
    ff_clip_free(clip);
}

#endif
