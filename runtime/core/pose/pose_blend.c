#include "runtime/core/pose/pose_blend.h"

#include <string.h>

#define ONE 32767.0 /* of keys and of weights */
#define SMALLEST                                                                                             \
    1e12f /* squared length of a sum below which it says nothing of a rotation: 1e-6 of a whole one */

void ff_pose_write(const ff_pose_store *store, uint32_t frame, uint32_t joint, ff_quat rotation)
{
    const double part[4] = {rotation.x, rotation.y, rotation.z, rotation.w};
    int16_t *keys = ff_pose_frame(store, frame) + joint;
    for (uint32_t i = 0; i < 4; ++i)
        keys[i * store->lanes] = (int16_t)floor(ff_clamp(part[i], -1.0, 1.0) * ONE + 0.5);
}

ff_quat ff_pose_read(const ff_pose_store *store, uint32_t frame, uint32_t joint)
{
    const int16_t *x = ff_pose_frame(store, frame) + joint, *y = x + store->lanes, *z = y + store->lanes,
                  *w = z + store->lanes;
    return ff_quat_unit((ff_quat){*x, *y, *z, *w});
}

static void turn_over(const ff_pose_store *store, uint32_t frame, uint32_t joint)
{
    int16_t *keys = ff_pose_frame(store, frame) + joint;
    for (uint32_t i = 0; i < 4; ++i)
        keys[i * store->lanes] = (int16_t)-keys[i * store->lanes];
}

static int64_t dot(const ff_pose_store *store, uint32_t frame0, uint32_t frame1, uint32_t joint)
{
    const int16_t *p = ff_pose_frame(store, frame0) + joint, *q = ff_pose_frame(store, frame1) + joint;
    int64_t sum = 0;
    for (uint32_t i = 0; i < 4; ++i)
        sum += (int64_t)p[i * store->lanes] * q[i * store->lanes];
    return sum;
}

static void align_joint(const ff_pose_store *store, uint32_t first, uint32_t count, uint32_t joint,
                        double *mean)
{
    double sum[4] = {0.0, 0.0, 0.0, 0.0}, side = 0.0;
    for (uint32_t k = 0; k < count; ++k) {
        if (k > 0 && dot(store, first + k - 1, first + k, joint) < 0) turn_over(store, first + k, joint);
        const int16_t *keys = ff_pose_frame(store, first + k) + joint;
        for (uint32_t i = 0; i < 4; ++i)
            sum[i] += keys[i * store->lanes] / (ONE * count);
    }
    for (int i = 0; i < 4; ++i)
        side += sum[i] * mean[i];
    for (uint32_t k = 0; k < count && side < 0.0; ++k)
        turn_over(store, first + k, joint);
    for (int i = 0; i < 4; ++i)
        mean[i] += side < 0.0 ? -sum[i] : sum[i];
}

void ff_pose_align(const ff_pose_store *store, uint32_t first, uint32_t count, uint32_t joints, double *mean)
{
    for (uint32_t joint = 0; joint < joints; ++joint)
        align_joint(store, first, count, joint, mean + 4 * (size_t)joint);
}

static int16_t key_weight(double weight)
{
    return (int16_t)(ff_clamp(weight, 0.0, 1.0) * ONE + 0.5);
}

void ff_pose_mix_add(ff_pose_mix *mix, uint32_t frame0, uint32_t frame1, double weight0, double weight1)
{
    if (mix->count == FF_POSE_PAIRS_MAX) return;
    uint32_t at = mix->count++;
    mix->pair[at].frame[0] = frame0;
    mix->pair[at].frame[1] = frame1;
    mix->pair[at].weight[0] = key_weight(weight0);
    mix->pair[at].weight[1] = key_weight(weight1);
}

/* -------------------------------------------------------------------------------------------------- in plain C */

static void unit(float *x, float *y, float *z, float *w)
{
    float n = (*x * *x + *y * *y) + (*z * *z + *w * *w);
    if (!(n > SMALLEST)) *x = *y = *z = 0.0f, *w = n = 1.0f;
    float r = 1.0f / sqrtf(n);
    *x *= r, *y *= r, *z *= r, *w *= r;
}

/* Eight lanes at a time of one part: loops of a fixed length, which compilers turn into what their machine has. */
static void sum_eight(const ff_pose_store *store, const ff_pose_mix *mix, uint32_t at, float *restrict out)
{
    int32_t sum[8] = {0};
    for (uint32_t p = 0; p < mix->count; ++p) {
        const int16_t *restrict k0 = ff_pose_frame(store, mix->pair[p].frame[0]) + at;
        const int16_t *restrict k1 = ff_pose_frame(store, mix->pair[p].frame[1]) + at;
        int16_t w0 = mix->pair[p].weight[0], w1 = mix->pair[p].weight[1];
        for (int i = 0; i < 8; ++i)
            sum[i] += w0 * k0[i] + w1 * k1[i];
    }
    for (int i = 0; i < 8; ++i)
        out[i] = (float)sum[i];
}

void ff_pose_blend_plain(const ff_pose_store *store, const ff_pose_mix *mix, float *out)
{
    uint32_t lanes = store->lanes;
    for (uint32_t at = 0; at < 4 * lanes; at += 8)
        sum_eight(store, mix, at, out + at);
    for (uint32_t j = 0; j < lanes; ++j)
        unit(out + j, out + lanes + j, out + 2 * lanes + j, out + 3 * lanes + j);
}

void ff_pose_rotations(const float *lanes, uint32_t lane_count, uint32_t first, uint32_t count, ff_quat *out)
{
    const float *x = lanes + first, *y = x + lane_count, *z = y + lane_count, *w = z + lane_count;
    for (uint32_t j = 0; j < count; ++j)
        out[j] = (ff_quat){(double)x[j], (double)y[j], (double)z[j], (double)w[j]};
}

/* ----------------------------------------------------------------------------------------------------- with SSE2 */

#if defined(__SSE2__)
#include "runtime/core/pose/pose_blend_sse2.h"

void ff_pose_blend(const ff_pose_store *store, const ff_pose_mix *mix, float *out)
{
    blend_sse2(store, mix, out);
}
#else
void ff_pose_blend(const ff_pose_store *store, const ff_pose_mix *mix, float *out)
{
    ff_pose_blend_plain(store, mix, out);
}
#endif
