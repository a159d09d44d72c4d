#include "runtime/core/base/maths.h"

#include "runtime/core/base/trig_kernel.h"

#include <string.h>

/* Whole numbers without a call or a branch: added to 1.5 * 2^52 a double has no room for a fraction, and its lowest bits
 * are those of the nearest whole number. */
#define WHOLE 6755399441055744.0

static uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static double of_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* Argument reduction by pi/2 in three parts (Cody and Waite), then the kernels. No branches: headings are anything, so a
 * processor would guess the quarter wrong half of the time. */
void ff_sincos(double x, double *sine, double *cosine)
{
    double shifted = x * (2.0 / FF_PI) + WHOLE, n = shifted - WHOLE;
    uint64_t quarter = bits_of(shifted), odd = 0 - (quarter & 1);
    double r = ((x - n * 1.57079632673412561417e+00) - n * 6.07710050630396597660e-11) -
               n * 2.02226624879595063154e-21;
    uint64_t s = bits_of(ff_kernel_sin(r)), c = bits_of(ff_kernel_cos(r)), swap = (s ^ c) & odd;
    *sine = of_bits((s ^ swap) ^ (quarter >> 1 & 1) << 63);
    *cosine = of_bits((c ^ swap) ^ ((quarter + 1) >> 1 & 1) << 63);
}

double ff_sin(double x)
{
    double s, c;
    ff_sincos(x, &s, &c);
    return s;
}

double ff_cos(double x)
{
    double s, c;
    ff_sincos(x, &s, &c);
    return c;
}

/* atan on [0, 1] : reduce about 0, 1/2 or 1 so that |r| <= 0.27, then the odd fdlibm series. */
static double atan_unit(double t)
{
    static const double coefficients[] = {
        3.33333333333329318027e-01,  -1.99999999998764832476e-01, 1.42857142725034663711e-01,
        -1.11111104054623557880e-01, 9.09088713343650656196e-02,  -7.69187620504482999495e-02,
        6.66107313738753120669e-02,  -5.83357013379057348645e-02, 4.97687799461593236017e-02,
        -3.65315727442169155270e-02, 1.62858201153657823623e-02};
    double base = 0.0, r = t;
    if (t > 0.6875) {
        base = FF_PI / 4.0, r = (t - 1.0) / (t + 1.0);
    } else if (t > 0.4375) {
        base = 4.63647609000806093515e-01, r = (2.0 * t - 1.0) / (2.0 + t);
    }
    double z = r * r, sum = 0.0;
    for (int i = 10; i >= 0; --i)
        sum = coefficients[i] + z * sum;
    return base + (r - r * z * sum);
}

double ff_atan2(double y, double x)
{
    double ay = fabs(y), ax = fabs(x);
    if (!(ax > 0.0) && !(ay > 0.0)) return 0.0;
    double angle = ay <= ax ? atan_unit(ay / ax) : FF_PI / 2.0 - atan_unit(ax / ay);
    if (x < 0.0) angle = FF_PI - angle;
    return y < 0.0 ? -angle : angle;
}

double ff_acos(double x)
{
    x = ff_clamp(x, -1.0, 1.0);
    return ff_atan2(sqrt((1.0 - x) * (1.0 + x)), x);
}

/* x = n ln 2 + r with |r| <= 0.35, where 13 terms of the series reach 1e-17: in two halves, that they run side by side. */
double ff_exp(double x)
{
    if (x < -745.0) return 0.0;
    if (x > 709.0) x = 709.0;
    double shifted = x * 1.44269504088896338700e+00 + WHOLE, n = shifted - WHOLE;
    double r = (x - n * 6.93147180369123816490e-01) - n * 1.90821492927058770002e-10, q = r * r;
    double even =
        1.0 + q * (1.0 / 2 +
                   q * (1.0 / 24 +
                        q * (1.0 / 720 + q * (1.0 / 40320 + q * (1.0 / 3628800 + q * (1.0 / 479001600))))));
    double odd =
        1.0 +
        q * (1.0 / 6 +
             q * (1.0 / 120 +
                  q * (1.0 / 5040 + q * (1.0 / 362880 + q * (1.0 / 39916800 + q * (1.0 / 6227020800.0))))));
    double power = even + r * odd;
    if (n < -1000.0) return ldexp(power, (int)n); /* below the smallest normal number */
    return power * of_bits((bits_of(shifted) + 1023) << 52);
}

ff_quat ff_quat_axis(ff_vec3 unit_axis, double angle)
{
    double s, c;
    ff_sincos(0.5 * angle, &s, &c);
    return (ff_quat){unit_axis.x * s, unit_axis.y * s, unit_axis.z * s, c};
}

ff_quat ff_quat_yaw(double psi)
{
    return ff_quat_axis(ff_v3(0.0, 1.0, 0.0), psi);
}

ff_quat ff_quat_between(ff_vec3 from, ff_vec3 to)
{
    ff_vec3 axis = ff_cross3(from, to);
    double w = 1.0 + ff_dot3(from, to);
    if (w < 1e-9) {
        ff_vec3 other = fabs(from.x) < 0.9 ? ff_v3(1.0, 0.0, 0.0) : ff_v3(0.0, 1.0, 0.0);
        axis = ff_unit3(ff_cross3(from, other));
        return (ff_quat){axis.x, axis.y, axis.z, 0.0};
    }
    return ff_quat_unit((ff_quat){axis.x, axis.y, axis.z, w});
}

ff_quat ff_quat_nlerp(ff_quat p, ff_quat q, double t)
{
    double s = ff_quat_dot(p, q) < 0.0 ? -t : t;
    double r = 1.0 - t;
    return ff_quat_unit(
        (ff_quat){p.x * r + q.x * s, p.y * r + q.y * s, p.z * r + q.z * s, p.w * r + q.w * s});
}

ff_quat ff_quat_slerp(ff_quat p, ff_quat q, double t)
{
    ff_quat step = ff_quat_mul(ff_quat_conj(p), q);
    return ff_quat_unit(ff_quat_mul(p, ff_quat_exp(ff_scale3(ff_quat_log(step), t))));
}

double ff_quat_heading(ff_quat q)
{
    ff_vec3 f = ff_quat_rotate(q, ff_v3(0.0, 0.0, 1.0));
    return ff_atan2(f.x, f.z);
}

ff_vec3 ff_quat_log(ff_quat q)
{
    if (q.w < 0.0) q = (ff_quat){-q.x, -q.y, -q.z, -q.w};
    ff_vec3 v = ff_v3(q.x, q.y, q.z);
    double s = ff_length3(v);
    if (s < 1e-12) return ff_scale3(v, 2.0);
    return ff_scale3(v, 2.0 * ff_atan2(s, q.w) / s);
}

ff_quat ff_quat_exp(ff_vec3 rotation_vector)
{
    double angle = ff_length3(rotation_vector);
    if (angle < 1e-12) {
        ff_vec3 h = ff_scale3(rotation_vector, 0.5);
        return ff_quat_unit((ff_quat){h.x, h.y, h.z, 1.0});
    }
    return ff_quat_axis(ff_scale3(rotation_vector, 1.0 / angle), angle);
}

double ff_quat_angle(ff_quat q)
{
    return 2.0 * ff_atan2(sqrt(q.x * q.x + q.y * q.y + q.z * q.z), fabs(q.w));
}
