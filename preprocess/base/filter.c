#include "preprocess/base/filter.h"

#include <stdlib.h>

/* A biquad in the transposed direct form II. */
typedef struct biquad {
    double b[3], a[3], s1, s2;
} biquad;

/* As if x had always been there. */
static void settle(biquad *q, double x)
{
    q->s2 = x * (q->b[2] - q->a[2]);
    q->s1 = x * (q->b[1] - q->a[1]) + q->s2;
}

static double filtered(biquad *q, double in)
{
    double out = q->b[0] * in + q->s1;
    q->s1 = q->b[1] * in - q->a[1] * out + q->s2;
    q->s2 = q->b[2] * in - q->a[2] * out;
    return out;
}

/* Forwards and backwards over a signal that goes on beyond its ends as its own point reflection, so that what moves
 * there keeps moving. */
static void both_ways(biquad *q, double *x, int count, ptrdiff_t stride)
{
    enum { PAD = 64 };
    double tail[PAD] = {0.0};
    int pad = count - 1 < PAD ? count - 1 : PAD;
    double first = x[0], last = x[(count - 1) * stride];
    for (int k = 0; k < pad; ++k)
        tail[k] = 2.0 * last - x[(count - 2 - k) * stride];
    settle(q, 2.0 * first - x[pad * stride]);
    for (int k = pad; k > 0; --k)
        filtered(q, 2.0 * first - x[k * stride]);
    for (int i = 0; i < count; ++i)
        x[i * stride] = filtered(q, x[i * stride]);
    for (int k = 0; k < pad; ++k)
        tail[k] = filtered(q, tail[k]);
    settle(q, tail[pad - 1]);
    for (int k = pad - 1; k >= 0; --k)
        filtered(q, tail[k]);
    for (int i = count - 1; i >= 0; --i)
        x[i * stride] = filtered(q, x[i * stride]);
}

void ff_filter_low_pass(double *values, int count, int stride, double rate, double cutoff)
{
    if (count < 4 || cutoff >= 0.36 * rate) return;
    double s, c;
    ff_sincos(FF_PI * cutoff / rate, &s, &c);
    /* Two passes lower the -3 dB point of each by (sqrt(2) - 1)^(1/4) (Winter, Biomechanics, section 3.4.4.2). */
    double k = s / c / 0.8022, g = 1.0 / (1.0 + sqrt(2.0) * k + k * k);
    biquad q = {.b = {k * k * g, 2.0 * k * k * g, k * k * g},
                .a = {1.0, 2.0 * (k * k - 1.0) * g, (1.0 - sqrt(2.0) * k + k * k) * g}};
    both_ways(&q, values, count, stride);
}

void ff_filter_low_pass3(ff_vec3 *points, int count, double rate, double cutoff)
{
    ff_filter_low_pass(&points->x, count, 3, rate, cutoff);
    ff_filter_low_pass(&points->y, count, 3, rate, cutoff);
    ff_filter_low_pass(&points->z, count, 3, rate, cutoff);
}

/* Distance of a point from the middle of its neighbours. */
static double off_line(const ff_vec3 *points, int count, int i)
{
    if (i < 1 || i + 1 >= count) return 0.0;
    return ff_length3(ff_sub3(points[i], ff_lerp3(points[i - 1], points[i + 1], 0.5)));
}

void ff_filter_despike(ff_vec3 *points, int count, double rate)
{
    /* 300 m/s2 is three times what feet reach when they strike the floor; 1 cm is far above marker noise. */
    double limit = 0.01 + 150.0 / (rate * rate);
    for (int i = 1; i + 1 < count; ++i) {
        double here = off_line(points, count, i);
        if (here > limit && here >= off_line(points, count, i - 1) && here >= off_line(points, count, i + 1))
            points[i] = ff_lerp3(points[i - 1], points[i + 1], 0.5);
    }
}

static ff_vec3 cubic(ff_vec3 p0, ff_vec3 p1, ff_vec3 p2, ff_vec3 p3, double t)
{
    /* Catmull-Rom: slopes are central differences. */
    ff_vec3 m1 = ff_scale3(ff_sub3(p2, p0), 0.5), m2 = ff_scale3(ff_sub3(p3, p1), 0.5);
    double t2 = t * t, t3 = t2 * t;
    ff_vec3 p = ff_scale3(p1, 2.0 * t3 - 3.0 * t2 + 1.0);
    p = ff_madd3(p, m1, t3 - 2.0 * t2 + t);
    p = ff_madd3(p, p2, 3.0 * t2 - 2.0 * t3);
    return ff_madd3(p, m2, t3 - t2);
}

void ff_filter_upsample(const ff_vec3 *in, int count, int factor, ff_vec3 *out)
{
    for (int i = 0; i + 1 < count; ++i) {
        ff_vec3 p0 = in[i > 0 ? i - 1 : 0], p3 = in[i + 2 < count ? i + 2 : count - 1];
        for (int k = 0; k < factor; ++k)
            out[i * factor + k] = cubic(p0, in[i], in[i + 1], p3, (double)k / factor);
    }
    out[(count - 1) * factor] = in[count - 1];
}

ff_vec3 ff_filter_velocity(const ff_vec3 *points, int count, int index, double rate)
{
    int before = index > 0 ? index - 1 : 0;
    int after = index + 1 < count ? index + 1 : count - 1;
    if (after == before) return ff_v3(0.0, 0.0, 0.0);
    return ff_scale3(ff_sub3(points[after], points[before]), rate / (after - before));
}

static int compare(const void *x, const void *y)
{
    double a = *(const double *)x, b = *(const double *)y;
    return (a > b) - (a < b);
}

double ff_filter_quantile(double *values, int count, double share)
{
    qsort(values, (size_t)count, sizeof *values, compare);
    double at = ff_clamp(share, 0.0, 1.0) * (count - 1);
    int low = (int)at;
    int high = low + 1 < count ? low + 1 : low;
    return ff_lerp(values[low], values[high], at - low);
}

double ff_filter_noise(const ff_vec3 *points, int count, double *scratch)
{
    if (count < 4) return 0.0;
    for (int i = 0; i + 3 < count; ++i) {
        ff_vec3 near = ff_sub3(points[i + 1], points[i + 2]), far = ff_sub3(points[i + 3], points[i]);
        scratch[i] = ff_length3(ff_madd3(far, near, 3.0));
    }
    /* A third difference of white noise has variance 20; the median length of a normal 3-vector is 1.538. */
    return ff_filter_quantile(scratch, count - 3, 0.5) / (sqrt(20.0) * 1.538);
}
