/* Decoding in two steps: lanes to values (whole numbers up to the last multiplication, so that SIMD and plain C agree to
 * the bit), then values to rotations, in floats, in the same order in both. pose_stream_sse2.h has the SIMD twins. */
#include "runtime/core/pack/pose_stream.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/pack/joints.h"

#include <string.h>

#define SMALLEST 1e-6f /* squared length below which four parts say nothing of a rotation */

/* Where the same joint is on the other side. */
static const uint8_t mirror_of[FF_STREAM_SLOTS] = {0, 1,  2,  3,  4,  9,  10, 11, 12, 5,  6,  7,
                                                   8, 17, 18, 19, 20, 13, 14, 15, 16, 21, 22, 23};
static const uint8_t itself[FF_STREAM_SLOTS] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11,
                                                12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23};

/* What a stream's lanes say at a moment, numbered as ff_pack_slots does. */
typedef struct values {
    _Alignas(16) float at[FF_LANE_FIRST + 8 * FF_STREAM_BLOCKS];
} values;

double ff_stream_fraction(const ff_pack_stream *stream, double time)
{
    double fraction = time / (double)stream->seconds;
    if (stream->flags & FF_STREAM_CYCLIC) {
        fraction -= floor(fraction);
        return fraction < 1.0 ? fraction : 0.0;
    }
    return ff_clamp(fraction, 0.0, 1.0);
}

void ff_stream_weights(float t, int32_t weights[4])
{
    float s = 1.0f - t, t2 = t * t, t3 = t2 * t;
    weights[0] = (int32_t)(s * s * s * (32768.0f / 6.0f) + 0.5f);
    weights[2] = (int32_t)((1.0f + 3.0f * ((t + t2) - t3)) * (32768.0f / 6.0f) + 0.5f);
    weights[3] = (int32_t)(t3 * (32768.0f / 6.0f) + 0.5f);
    weights[1] = 32768 - weights[0] - weights[2] - weights[3];
}

/* The key before a place, and how far on towards the next one the place is. */
static uint32_t key_at(double fraction, uint32_t intervals, double *t)
{
    double place = fraction * intervals;
    uint32_t key = (uint32_t)place;
    if (key > intervals - 1) key = intervals - 1;
    *t = place - key;
    return key;
}

void ff_stream_root(const ff_pack *pack, uint32_t index, double fraction, double root[3])
{
    const ff_pack_stream *stream = &pack->streams[index];
    root[0] = root[1] = root[2] = 0.0;
    if (stream->root_intervals == 0) return;
    double t;
    uint32_t key = key_at(fraction, stream->root_intervals, &t);
    double s = 1.0 - t, t2 = t * t, t3 = t2 * t, w[4];
    w[0] = s * s * s / 6.0;
    w[2] = (1.0 + 3.0 * (t + t2 - t3)) / 6.0;
    w[3] = t3 / 6.0;
    w[1] = 1.0 - w[0] - w[2] - w[3];
    const float(*at)[3] = pack->roots + stream->first_root + key;
    for (int i = 0; i < 3; ++i)
        root[i] = w[0] * (double)at[0][i] + w[1] * (double)at[1][i] + w[2] * (double)at[2][i] +
                  w[3] * (double)at[3][i];
}

static bool has_lanes(const ff_pack_level *level)
{
    return level->wide + level->narrow > 0;
}

/* The first of a level's four keys, and how far on towards the second-next the moment is. */
static const unsigned char *first_key(const ff_pack *pack, const ff_pack_level *level, double fraction,
                                      float *t)
{
    double on;
    size_t key = key_at(fraction, level->intervals, &on);
    *t = (float)on;
    return pack->keys + level->first_byte + key * ff_level_stride(level);
}

static void read_constants(values *now)
{
    now->at[FF_LANE_ZERO] = 0.0f;
    now->at[FF_LANE_ONE] = 1.0f;
}

static void read_still(const ff_pack_lanes *lanes, uint32_t count, float *out)
{
    for (uint32_t i = 0; i < count; ++i)
        out[i] = lanes[i / 8].base[i % 8];
}

static ff_vec3 hips_of(const values *now, const ff_pack_slots *slots, bool mirrored)
{
    double part[3];
    for (int c = 0; c < 3; ++c)
        part[c] = (double)now->at[slots->lane[c][FF_STREAM_HIPS]];
    return ff_v3(mirrored ? 0.0 - part[1] : part[1], part[2], part[0]);
}

/* -------------------------------------------------------------------------------------------------- in plain C */

static int32_t wide_key(const unsigned char *at)
{
    int16_t key;
    memcpy(&key, at, sizeof key);
    return key;
}

static int32_t narrow_key(const unsigned char *at)
{
    return (signed char)*at * 256;
}

static float value_of(const ff_pack_lanes *lanes, uint32_t i, int32_t sum)
{
    return lanes[i / 8].base[i % 8] + lanes[i / 8].scale[i % 8] * (float)sum;
}

/* One level's lanes from block on; returns the block after them. */
static uint32_t read_level_plain(const ff_pack *pack, const ff_pack_level *level, double fraction,
                                 const ff_pack_lanes *lanes, uint32_t block, values *now)
{
    float t, *out = now->at + FF_LANE_FIRST + 8 * block;
    int32_t w[4];
    size_t stride = ff_level_stride(level);
    const unsigned char *k0 = first_key(pack, level, fraction, &t), *k1 = k0 + stride, *k2 = k1 + stride,
                        *k3 = k2 + stride;
    ff_stream_weights(t, w);
    lanes += block;
    for (uint32_t i = 0; i < level->wide; ++i) {
        size_t at = 2 * (size_t)i;
        out[i] = value_of(lanes, i,
                          w[0] * wide_key(k0 + at) + w[1] * wide_key(k1 + at) + w[2] * wide_key(k2 + at) +
                              w[3] * wide_key(k3 + at));
    }
    uint32_t wide_blocks = (level->wide + 7u) / 8u;
    lanes += wide_blocks;
    out += 8 * wide_blocks;
    for (uint32_t i = 0; i < level->narrow; ++i) {
        size_t at = 2 * (size_t)level->wide + i;
        out[i] = value_of(lanes, i,
                          w[0] * narrow_key(k0 + at) + w[1] * narrow_key(k1 + at) +
                              w[2] * narrow_key(k2 + at) + w[3] * narrow_key(k3 + at));
    }
    return block + wide_blocks + (level->narrow + 7u) / 8u;
}

static void rotations_plain(const values *now, const ff_pack_slots *slots, bool mirrored, ff_quat *rotations)
{
    const uint8_t *to = mirrored ? mirror_of : itself;
    float side = mirrored ? -1.0f : 1.0f;
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        float x = now->at[slots->lane[0][j]], y = now->at[slots->lane[1][j]], z = now->at[slots->lane[2][j]],
              w = now->at[slots->lane[3][j]];
        float n = (x * x + y * y) + (z * z + w * w);
        if (!(n > SMALLEST)) x = y = z = 0.0f, w = n = 1.0f;
        float r = 1.0f / sqrtf(n);
        float a = slots->x[j], b = slots->y[j], c = slots->z[j], d = slots->w[j];
        float qx = ((d * x + a * w) + (b * z - c * y)) * r;
        float qy = ((d * y + b * w) + (c * x - a * z)) * r * side;
        float qz = ((d * z + c * w) + (a * y - b * x)) * r * side;
        float qw = ((d * w - a * x) - (b * y + c * z)) * r;
        rotations[to[j]] = (ff_quat){(double)qx, (double)qy, (double)qz, (double)qw};
    }
}

void ff_stream_pose_plain(const ff_pack *pack, uint32_t index, double fraction, bool mirrored, ff_vec3 *hips,
                          ff_quat *rotations)
{
    const ff_pack_stream *stream = &pack->streams[index];
    const ff_pack_slots *slots = &pack->slots[index];
    const ff_pack_lanes *lanes = pack->lanes + stream->first_lanes;
    uint32_t block = 0;
    values now;
    read_constants(&now);
    for (int i = 0; i < FF_STREAM_LEVELS; ++i)
        if (has_lanes(&stream->level[i]))
            block = read_level_plain(pack, &stream->level[i], fraction, lanes, block, &now);
    read_still(lanes + block, stream->still, now.at + FF_LANE_FIRST + 8 * block);
    if (hips) *hips = hips_of(&now, slots, mirrored);
    if (rotations) rotations_plain(&now, slots, mirrored, rotations);
}

/* ----------------------------------------------------------------------------------------------------- with SSE2 */

#if defined(__SSE2__)
#include "runtime/core/pack/pose_stream_sse2.h"

void ff_stream_pose(const ff_pack *pack, uint32_t index, double fraction, bool mirrored, ff_vec3 *hips,
                    ff_quat *rotations)
{
    const ff_pack_stream *stream = &pack->streams[index];
    const ff_pack_slots *slots = &pack->slots[index];
    values now;
    read_constants(&now);
    read_levels_sse2(pack, stream, fraction, &now);
    if (hips) *hips = hips_of(&now, slots, mirrored);
    if (rotations)
        rotations_sse2(&now, slots, (stream->flags & FF_STREAM_FOUR_PARTS) != 0, mirrored, rotations);
}
#else
void ff_stream_pose(const ff_pack *pack, uint32_t stream, double fraction, bool mirrored, ff_vec3 *hips,
                    ff_quat *rotations)
{
    ff_stream_pose_plain(pack, stream, fraction, mirrored, hips, rotations);
}
#endif

/* --------------------------------------------------------------------------------------------------------- public */

uint32_t ff_pack_stream_count(const ff_pack *pack)
{
    return pack->stream_count;
}

double ff_pack_stream_seconds(const ff_pack *pack, uint32_t stream)
{
    return stream < pack->stream_count ? (double)pack->streams[stream].seconds : 0.0;
}

int ff_pack_stream_cyclic(const ff_pack *pack, uint32_t stream)
{
    return stream < pack->stream_count && (pack->streams[stream].flags & FF_STREAM_CYCLIC) != 0;
}

uint32_t ff_pack_clip_count(const ff_pack *pack)
{
    return pack->clip_count;
}

const char *ff_pack_clip_name(const ff_pack *pack, uint32_t clip)
{
    return clip < pack->clip_count ? ff_pack_string(pack, pack->clips[clip].name) : "";
}

uint32_t ff_pack_clip_stream(const ff_pack *pack, uint32_t clip)
{
    return clip < pack->clip_count ? pack->clips[clip].stream : UINT32_MAX;
}

ff_status ff_pack_sample(const ff_pack *pack, uint32_t stream, double time, uint32_t flags,
                         ff_root_frame *root, ff_vec3 *hips, ff_quat *rotations, ff_error *error)
{
    if (stream >= pack->stream_count)
        return ff_fail(error, FF_ERR_ARGUMENT, "stream %u, but the pack has %u", stream, pack->stream_count);
    if (flags & ~(uint32_t)FF_SAMPLE_MIRRORED)
        return ff_fail(error, FF_ERR_ARGUMENT, "unknown sampling flags %x", flags);
    if (!isfinite(time)) return ff_fail(error, FF_ERR_NOT_FINITE, "the time to sample is %g", time);
    bool mirrored = (flags & FF_SAMPLE_MIRRORED) != 0;
    double fraction = ff_stream_fraction(&pack->streams[stream], time), at[3];
    if (root) {
        ff_stream_root(pack, stream, fraction, at);
        *root = (ff_root_frame){{at[0], mirrored ? 0.0 - at[1] : at[1]}, mirrored ? 0.0 - at[2] : at[2]};
    }
    if (hips || rotations) ff_stream_pose(pack, stream, fraction, mirrored, hips, rotations);
    return FF_OK;
}

void ff_root_place(const ff_root_frame *root, ff_vec3 *hips, ff_quat *rotation)
{
    ff_quat turn = ff_quat_yaw(root->heading);
    *hips = ff_add3(ff_ground(root->position, 0.0), ff_quat_rotate(turn, *hips));
    *rotation = ff_quat_mul(turn, *rotation);
}
