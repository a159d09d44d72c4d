/* pose_encode.h - a motion as a pose stream of the pack: which values move, how often and how finely each is kept. */
#ifndef FF_POSE_ENCODE_H
#define FF_POSE_ENCODE_H

#include "preprocess/pack/pack_write.h"
#include "runtime/core/base/maths.h"

/* Bytes per second that suffice even for noisy capture (issue 3, bar 5: 8,000 for 31 joints, here are 21). */
#define FF_POSE_BYTES 5400.0

/* What is to be stored, at its own rate, on the pack's skeleton. */
typedef struct ff_pose_motion {
    int frame_count;
    double frame_time; /* s */
    bool cyclic;
    double bytes;        /* at most so many per second; 0 = FF_POSE_BYTES */
    const ff_vec3 *root; /* [frame_count] a, b, heading; NULL = stays at zero */
    const ff_vec3 *hips; /* [frame_count] forward, left of the root, height */
    const ff_quat
        *rotations; /* [frame_count][FF_JOINT_COUNT] local; joint 0 relative to the root's heading */
} ff_pose_motion;

/* Distances of joints and points (tips, heels) from where they should be, m, over all frames of the motion. */
typedef struct ff_pose_error {
    double mean, p99, max;
} ff_pose_error;

typedef struct ff_pose_coded {
    ff_pack_stream stream; /* places counted from the starts of the arrays below; frames not set */
    ff_pack_slots slots;
    ff_array lanes, keys, roots; /* ff_pack_lanes, bytes, float[3] */
    ff_pose_error quantised;     /* against the splines before rounding */
    ff_pose_error whole;         /* against the motion: resampling and quantising */
    double bytes_per_second;     /* of everything above but frames */
} ff_pose_coded;

/* joints [FF_JOINT_COUNT] and points [FF_POINT_COUNT]: the pack's skeleton. The caller frees *out with
 * ff_pose_coded_free. */
ff_status ff_pose_encode(const ff_pack_joint *joints, const ff_pack_point *points,
                         const ff_pose_motion *motion, ff_pose_coded *out, ff_error *error);
void ff_pose_coded_free(ff_pose_coded *coded);

/* Measure a stream against a motion (pose_error.c): quantised and whole. splined: the motion as the splines before
 * rounding have it. */
ff_status ff_pose_measure(const ff_pack_joint *joints, const ff_pack_point *points,
                          const ff_pose_motion *motion, const ff_pose_motion *splined, ff_pose_coded *coded,
                          ff_error *error);

/* Append to the pack, with so many frames at a rate for FEET or TRCK. */
ff_status ff_pack_add_stream(ff_pack_content *content, const ff_pose_coded *coded, int frame_count,
                             double rate, uint32_t *index, ff_error *error);

#endif
