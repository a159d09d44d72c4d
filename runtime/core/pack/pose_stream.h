/* pose_stream.h - the pose of a stream at any moment, from the pack's bytes and nothing else: no state, no cache. */
#ifndef FF_POSE_STREAM_H
#define FF_POSE_STREAM_H

#include "runtime/core/pack/pack.h"

/* Bytes from key to key. */
static inline size_t ff_level_stride(const ff_pack_level *level)
{
    return 2 * (size_t)level->wide + (size_t)level->narrow;
}

/* How many ff_pack_lanes a stream has. */
static inline uint32_t ff_stream_lane_blocks(const ff_pack_stream *stream)
{
    uint32_t count = 0;
    for (int i = 0; i < FF_STREAM_LEVELS; ++i)
        count += (stream->level[i].wide + 7u) / 8u + (stream->level[i].narrow + 7u) / 8u;
    return count + stream->still / 8u + (stream->still % 8u > 0);
}

/* Place on the stream as a fraction, 0 to 1: cyclic ones go round, others stay at their ends. */
double ff_stream_fraction(const ff_pack_stream *stream, double time);

/* The four weights of a uniform cubic B-spline between two keys, 0 <= t <= 1, in 32768ths; their sum is exactly 1. */
void ff_stream_weights(float t, int32_t weights[4]);

/* Root on the ground: a, b, heading. */
void ff_stream_root(const ff_pack *pack, uint32_t stream, double fraction, double root[3]);

/* Hips in the root's frame (x left, y up, z forward) and local rotations [FF_JOINT_COUNT], joint 0 relative to the root's
 * heading; mirrored: with left and right exchanged. The same bits with SIMD instructions and without. */
void ff_stream_pose(const ff_pack *pack, uint32_t stream, double fraction, bool mirrored, ff_vec3 *hips,
                    ff_quat *rotations);
/* The same in plain C: what ff_stream_pose is where there is no SSE2, and what it is tested against. */
void ff_stream_pose_plain(const ff_pack *pack, uint32_t stream, double fraction, bool mirrored, ff_vec3 *hips,
                          ff_quat *rotations);

#endif
