/* Decoding in two steps: lanes to values (whole numbers up to the last multiplication, so that SIMD and plain C agree to
 * the bit), then values to rotations, in floats, in the same order in both. pose_stream_sse2.h has the SIMD twins. */
#include "runtime/core/pose_stream.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/joints.h"

#include <string.h>

#define W_SLOTS (3 * FF_STREAM_SLOTS)
#define SMALLEST 1e-6f /* squared length below which four parts say nothing of a rotation */

/* Where the same joint is on the other side. */
static const uint8_t mirror_of[FF_STREAM_SLOTS] = {0, 1,  2,  3,  4,  9,  10, 11, 12, 5,  6,  7,
                                                   8, 17, 18, 19, 20, 13, 14, 15, 16, 21, 22, 23};
static const uint8_t itself[FF_STREAM_SLOTS] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11,
                                                12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23};

/* Values by slot, as a row per component. */
typedef struct values {
    _Alignas(16) float at[4 * FF_STREAM_SLOTS];
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

static void spline_weights(double t, double w[4])
{
    double s = 1.0 - t, t2 = t * t;
    w[0] = s * s * s * (1.0 / 6.0);
    w[2] = (1.0 + 3.0 * (t + t2 - t2 * t)) * (1.0 / 6.0);
    w[3] = t2 * t * (1.0 / 6.0);
    w[1] = 1.0 - w[0] - w[2] - w[3];
}

void ff_stream_weights(double t, int16_t weights[4])
{
    double w[4];
    spline_weights(t, w);
    int near = (int)(w[0] * 32768.0 + 0.5), after = (int)(w[2] * 32768.0 + 0.5),
        far = (int)(w[3] * 32768.0 + 0.5);
    weights[0] = (int16_t)near;
    weights[1] = (int16_t)(32768 - near - after - far);
    weights[2] = (int16_t)after;
    weights[3] = (int16_t)far;
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
    double t, w[4];
    uint32_t key = key_at(fraction, stream->root_intervals, &t);
    spline_weights(t, w);
    const float(*at)[3] = pack->roots + stream->first_root + key;
    for (int i = 0; i < 3; ++i)
        root[i] = w[0] * (double)at[0][i] + w[1] * (double)at[1][i] + w[2] * (double)at[2][i] +
                  w[3] * (double)at[3][i];
}

static bool has_lanes(const ff_pack_level *level)
{
    return level->wide + level->narrow > 0;
}

/* Where each of the four keys of a level is, and their weights. */
typedef struct place {
    const unsigned char *key[4];
    int16_t weight[4];
} place;

static place place_on(const ff_pack *pack, const ff_pack_level *level, double fraction)
{
    place p;
    double t;
    size_t stride = ff_level_stride(level), key = key_at(fraction, level->intervals, &t);
    ff_stream_weights(t, p.weight);
    p.key[0] = pack->keys + level->first_byte + key * stride;
    for (int i = 1; i < 4; ++i)
        p.key[i] = p.key[i - 1] + stride;
    return p;
}

/* Slots without a lane: rotations are their references, the hips are in the root. */
static void clear(values *out)
{
    memset(out->at, 0, W_SLOTS * sizeof *out->at);
    for (int j = 0; j < FF_STREAM_SLOTS; ++j)
        out->at[W_SLOTS + j] = 1.0f;
}

static void read_still(const ff_pack_lanes *lanes, uint32_t count, values *out)
{
    for (uint32_t i = 0; i < count; ++i)
        out->at[lanes[i / 8].slot[i % 8]] = lanes[i / 8].base[i % 8];
}

static ff_vec3 hips_of(const values *from, bool mirrored)
{
    const float *at = from->at + FF_STREAM_HIPS;
    double left = (double)at[FF_STREAM_SLOTS];
    return ff_v3(mirrored ? 0.0 - left : left, (double)at[2 * FF_STREAM_SLOTS], (double)at[0]);
}

/* -------------------------------------------------------------------------------------------------- in plain C */

static int32_t sum_wide(const place *p, uint32_t lane)
{
    int32_t sum = 0;
    for (int i = 0; i < 4; ++i) {
        int16_t key;
        memcpy(&key, p->key[i] + 2 * (size_t)lane, sizeof key);
        sum += p->weight[i] * key;
    }
    return sum;
}

static int32_t sum_narrow(const place *p, size_t at)
{
    int32_t sum = 0;
    for (int i = 0; i < 4; ++i)
        sum += p->weight[i] * ((signed char)p->key[i][at] * 256);
    return sum;
}

static const ff_pack_lanes *read_level_plain(const ff_pack *pack, const ff_pack_level *level, double fraction,
                                             const ff_pack_lanes *lanes, values *out)
{
    place p = place_on(pack, level, fraction);
    for (uint32_t i = 0; i < level->wide; ++i) {
        const ff_pack_lanes *l = &lanes[i / 8];
        out->at[l->slot[i % 8]] = l->base[i % 8] + l->scale[i % 8] * (float)sum_wide(&p, i);
    }
    lanes += (level->wide + 7u) / 8u;
    for (uint32_t i = 0; i < level->narrow; ++i) {
        const ff_pack_lanes *l = &lanes[i / 8];
        size_t at = 2 * (size_t)level->wide + i;
        out->at[l->slot[i % 8]] = l->base[i % 8] + l->scale[i % 8] * (float)sum_narrow(&p, at);
    }
    return lanes + (level->narrow + 7u) / 8u;
}

static void rotations_plain(const values *from, const ff_pack_reference *reference, bool mirrored,
                            ff_quat *rotations)
{
    const float *at = from->at;
    const uint8_t *to = mirrored ? mirror_of : itself;
    float side = mirrored ? -1.0f : 1.0f;
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        float x = at[j], y = at[FF_STREAM_SLOTS + j], z = at[2 * FF_STREAM_SLOTS + j], w = at[W_SLOTS + j];
        float n = (x * x + y * y) + (z * z + w * w);
        if (!(n > SMALLEST)) x = y = z = 0.0f, w = n = 1.0f;
        float r = 1.0f / sqrtf(n);
        float a = reference->x[j], b = reference->y[j], c = reference->z[j], d = reference->w[j];
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
    const ff_pack_lanes *lanes = pack->lanes + stream->first_lanes;
    values now;
    clear(&now);
    for (int i = 0; i < FF_STREAM_LEVELS; ++i)
        if (has_lanes(&stream->level[i]))
            lanes = read_level_plain(pack, &stream->level[i], fraction, lanes, &now);
    read_still(lanes, stream->still, &now);
    if (hips) *hips = hips_of(&now, mirrored);
    if (rotations) rotations_plain(&now, &pack->references[index], mirrored, rotations);
}

/* ----------------------------------------------------------------------------------------------------- with SSE2 */

#if defined(__SSE2__)
#include "runtime/core/pose_stream_sse2.h"

void ff_stream_pose(const ff_pack *pack, uint32_t index, double fraction, bool mirrored, ff_vec3 *hips,
                    ff_quat *rotations)
{
    const ff_pack_stream *stream = &pack->streams[index];
    const ff_pack_lanes *lanes = pack->lanes + stream->first_lanes;
    values now;
    clear(&now);
    for (int i = 0; i < FF_STREAM_LEVELS; ++i)
        if (has_lanes(&stream->level[i]))
            lanes = read_level_sse2(pack, &stream->level[i], fraction, lanes, &now);
    read_still(lanes, stream->still, &now);
    if (hips) *hips = hips_of(&now, mirrored);
    if (rotations) rotations_sse2(&now, &pack->references[index], mirrored, rotations);
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
