/* pair.h - the same sum for two at once, a left and a right leg: numbers, vectors and quaternions in pairs, in what gcc and
 * clang make of any machine's vector unit. Each half has the bits that the sum alone would have. */
#ifndef FF_PAIR_H
#define FF_PAIR_H

#include "runtime/core/base/maths.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

typedef double ff_pair __attribute__((vector_size(16)));
typedef int64_t ff_pair_bits __attribute__((vector_size(16))); /* -1 for true, 0 for false */

typedef struct ff_pair3 {
    ff_pair x, y, z;
} ff_pair3;

typedef struct ff_pairq {
    ff_pair x, y, z, w;
} ff_pairq;

static inline ff_pair ff_pair_of(double left, double right)
{
    return (ff_pair){left, right};
}
static inline ff_pair3 ff_pair3_of(ff_vec3 left, ff_vec3 right)
{
    return (ff_pair3){{left.x, right.x}, {left.y, right.y}, {left.z, right.z}};
}
static inline ff_pairq ff_pairq_of(ff_quat left, ff_quat right)
{
    return (ff_pairq){{left.x, right.x}, {left.y, right.y}, {left.z, right.z}, {left.w, right.w}};
}
static inline ff_vec3 ff_pair3_half(ff_pair3 v, int half)
{
    return ff_v3(v.x[half], v.y[half], v.z[half]);
}
static inline ff_quat ff_pairq_half(ff_pairq q, int half)
{
    return (ff_quat){q.x[half], q.y[half], q.z[half], q.w[half]};
}

static inline ff_pair ff_pair_sqrt(ff_pair x)
{
#if defined(__SSE2__)
    return (ff_pair)_mm_sqrt_pd((__m128d)x);
#else
    return (ff_pair){sqrt(x[0]), sqrt(x[1])};
#endif
}
static inline ff_pair ff_pair_choose(ff_pair_bits which, ff_pair yes, ff_pair no)
{
    return (ff_pair)((which & (ff_pair_bits)yes) | (~which & (ff_pair_bits)no));
}
static inline ff_pair ff_pair_max(ff_pair x, ff_pair y)
{
    return ff_pair_choose(x > y, x, y);
}
/* 1 / length, or 0 for a length that has no direction. */
static inline ff_pair ff_pair_inverse(ff_pair length)
{
    return (ff_pair)((ff_pair_bits)(1.0 / length) & (length > 1e-12));
}

static inline ff_pair3 ff_pair3_add(ff_pair3 u, ff_pair3 v)
{
    return (ff_pair3){u.x + v.x, u.y + v.y, u.z + v.z};
}
static inline ff_pair3 ff_pair3_sub(ff_pair3 u, ff_pair3 v)
{
    return (ff_pair3){u.x - v.x, u.y - v.y, u.z - v.z};
}
static inline ff_pair3 ff_pair3_scale(ff_pair3 u, ff_pair s)
{
    return (ff_pair3){u.x * s, u.y * s, u.z * s};
}
static inline ff_pair3 ff_pair3_madd(ff_pair3 u, ff_pair3 v, ff_pair s)
{
    return (ff_pair3){u.x + v.x * s, u.y + v.y * s, u.z + v.z * s};
}
static inline ff_pair ff_pair3_dot(ff_pair3 u, ff_pair3 v)
{
    return u.x * v.x + u.y * v.y + u.z * v.z;
}
static inline ff_pair3 ff_pair3_cross(ff_pair3 u, ff_pair3 v)
{
    return (ff_pair3){u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}
static inline ff_pair ff_pair3_length(ff_pair3 u)
{
    return ff_pair_sqrt(ff_pair3_dot(u, u));
}
static inline ff_pair3 ff_pair3_unit(ff_pair3 u)
{
    return ff_pair3_scale(u, ff_pair_inverse(ff_pair3_length(u)));
}

static inline ff_pairq ff_pairq_mul(ff_pairq p, ff_pairq q)
{
    return (ff_pairq){
        p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y, p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x,
        p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w, p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z};
}
static inline ff_pairq ff_pairq_conj(ff_pairq q)
{
    return (ff_pairq){-q.x, -q.y, -q.z, q.w};
}
static inline ff_pair3 ff_pairq_rotate(ff_pairq q, ff_pair3 v)
{
    ff_pair3 u = {q.x, q.y, q.z}, t = ff_pair3_cross(u, v);
    t = (ff_pair3){t.x + t.x, t.y + t.y, t.z + t.z};
    return ff_pair3_add(ff_pair3_madd(v, t, q.w), ff_pair3_cross(u, t));
}
/* ff_quat_between of both. */
static inline ff_pairq ff_pairq_between(ff_pair3 from, ff_pair3 to)
{
    ff_pair3 axis = ff_pair3_cross(from, to);
    ff_pair w = 1.0 + ff_pair3_dot(from, to);
    if (w[0] < 1e-9 || w[1] < 1e-9)
        return ff_pairq_of(ff_quat_between(ff_pair3_half(from, 0), ff_pair3_half(to, 0)),
                           ff_quat_between(ff_pair3_half(from, 1), ff_pair3_half(to, 1)));
    ff_pair over = 1.0 / ff_pair_sqrt(ff_pair3_dot(axis, axis) + w * w);
    return (ff_pairq){axis.x * over, axis.y * over, axis.z * over, w * over};
}

#endif
