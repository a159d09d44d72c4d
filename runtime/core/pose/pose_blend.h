/* pose_blend.h - stored poses blended: the local rotations of all joints, for display.
 *
 * Sums of weighted keys are whole numbers up to the normalisation, so SIMD and plain C agree to the last bit; a weight is
 * rounded to 1/32767, which turns no joint by more than 2e-5 of the angle between the poses that are blended. What a crowd
 * remembers and hashes never goes through here (runtime/README.md, Synthesis).
 */
#ifndef FF_POSE_BLEND_H
#define FF_POSE_BLEND_H

#include "runtime/core/base/maths.h"

/* Poses as parts of quaternions in 1/32767: of a frame x[lanes], then y, z and w; a lane is a joint, those after the last
 * joint are zero. Frames that are blended lie on one hemisphere, joint by joint (ff_pose_align): no signs are looked at. */
typedef struct ff_pose_store {
    int16_t *keys;  /* [frames][4][lanes] */
    uint32_t lanes; /* a multiple of 8, at most FF_POSE_LANES_MAX */
} ff_pose_store;

#define FF_POSE_LANES_MAX 64

static inline int16_t *ff_pose_frame(const ff_pose_store *store, uint32_t frame)
{
    return store->keys + (size_t)frame * 4 * store->lanes;
}

/* Joint's rotation of a frame. */
void ff_pose_write(const ff_pose_store *store, uint32_t frame, uint32_t joint, ff_quat rotation);
ff_quat ff_pose_read(const ff_pose_store *store, uint32_t frame, uint32_t joint);
/* Make a run of frames continuous, joint by joint, and turn the whole run to the side of mean[4 * joint] (parts x, y, z, w;
 * zero at first), to which it is then added. */
void ff_pose_align(const ff_pose_store *store, uint32_t first, uint32_t count, uint32_t joints, double *mean);

/* Frames with their weights, in pairs: what is between two frames of one motion. */
#define FF_POSE_PAIRS_MAX 16
typedef struct ff_pose_mix {
    struct {
        uint32_t frame[2];
        int16_t weight[2];
    } pair[FF_POSE_PAIRS_MAX];
    uint32_t count;
} ff_pose_mix;

/* Weights from 0 to 1; those of a mix add up to 1. What is more than FF_POSE_PAIRS_MAX is left out. */
void ff_pose_mix_add(ff_pose_mix *mix, uint32_t frame0, uint32_t frame1, double weight0, double weight1);

/* Unit quaternions x[lanes], y, z, w. The same bits with SIMD instructions and without. */
void ff_pose_blend(const ff_pose_store *store, const ff_pose_mix *mix, float *out);
/* The same in plain C: what ff_pose_blend is where there is no SSE2, and what it is tested against. */
void ff_pose_blend_plain(const ff_pose_store *store, const ff_pose_mix *mix, float *out);

/* Lanes first .. first + count as quaternions. */
void ff_pose_rotations(const float *lanes, uint32_t lane_count, uint32_t first, uint32_t count, ff_quat *out);

#endif
