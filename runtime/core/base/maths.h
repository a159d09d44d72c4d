/* maths.h - vectors, quaternions and the few functions whose bits must not depend on the platform.
 *
 * Conventions (once, for every room): metres, radians, right-handed, Y up; quaternions (x, y, z, w), Hamilton
 * product, column vectors: v' = q v q^-1, parent * local. Yaw psi about +Y, positive = left;
 * fwd3 = (sin psi, 0, cos psi), left3 = (cos psi, 0, -sin psi). Plane coordinates (a, b) = (z, x):
 * fwd2 = (cos psi, sin psi), left2 = (-sin psi, cos psi), det(u, v) > 0 <=> v is left of u.
 */
#ifndef FF_MATHS_H
#define FF_MATHS_H

#include "runtime/footfall.h"

#include <math.h>
#include <stdbool.h>

#define FF_PI 3.14159265358979323846
#define FF_TAU (2.0 * FF_PI)
#define FF_DEG (FF_PI / 180.0)

/* Correctly reproducible everywhere (plain IEEE arithmetic, no libm): error below 1e-15 (sin, cos: for
 * |x| < 1e6) and 1e-15 (atan2); exp: relative error below 1e-14. State-path code uses only these and sqrt. */
void ff_sincos(double x, double *sine, double *cosine);
double ff_sin(double x);
double ff_cos(double x);
double ff_atan2(double y, double x);
double ff_acos(double x); /* argument clamped to [-1, 1] */
double ff_exp(double x);

static inline double ff_min(double x, double y)
{
    return x < y ? x : y;
}
static inline double ff_max(double x, double y)
{
    return x > y ? x : y;
}
static inline double ff_clamp(double x, double low, double high)
{
    return x < low ? low : (x > high ? high : x);
}
static inline double ff_lerp(double x, double y, double t)
{
    return x + (y - x) * t;
}
/* 0 at t <= 0, 1 at t >= 1, slopes 0 at both. */
static inline double ff_smooth(double t)
{
    t = ff_clamp(t, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}
/* Into (-pi, pi]. */
static inline double ff_wrap(double angle)
{
    double turns = floor((angle + FF_PI) / FF_TAU);
    double wrapped = angle - turns * FF_TAU;
    return wrapped <= -FF_PI ? wrapped + FF_TAU : (wrapped > FF_PI ? wrapped - FF_TAU : wrapped);
}

/* ------------------------------------------------------------------------------------------------- plane */
static inline ff_vec2 ff_v2(double a, double b)
{
    return (ff_vec2){a, b};
}
static inline ff_vec2 ff_add2(ff_vec2 u, ff_vec2 v)
{
    return ff_v2(u.a + v.a, u.b + v.b);
}
static inline ff_vec2 ff_sub2(ff_vec2 u, ff_vec2 v)
{
    return ff_v2(u.a - v.a, u.b - v.b);
}
static inline ff_vec2 ff_scale2(ff_vec2 u, double s)
{
    return ff_v2(u.a * s, u.b * s);
}
static inline ff_vec2 ff_madd2(ff_vec2 u, ff_vec2 v, double s)
{
    return ff_v2(u.a + v.a * s, u.b + v.b * s);
}
static inline double ff_dot2(ff_vec2 u, ff_vec2 v)
{
    return u.a * v.a + u.b * v.b;
}
static inline double ff_det2(ff_vec2 u, ff_vec2 v)
{
    return u.a * v.b - u.b * v.a;
}
static inline double ff_length2(ff_vec2 u)
{
    return sqrt(ff_dot2(u, u));
}
/* Unit vector, or (0, 0) for one too short to have a direction. */
static inline ff_vec2 ff_unit2(ff_vec2 u)
{
    double length = ff_length2(u);
    return length > 1e-12 ? ff_scale2(u, 1.0 / length) : ff_v2(0.0, 0.0);
}
static inline ff_vec2 ff_fwd2(double psi)
{
    ff_vec2 f;
    ff_sincos(psi, &f.b, &f.a);
    return f;
}
static inline ff_vec2 ff_left2(ff_vec2 u)
{
    return ff_v2(-u.b, u.a);
} /* u turned by +90 degrees */
/* Components of v along unit vector f and to its left, and back. */
static inline ff_vec2 ff_to_frame2(ff_vec2 f, ff_vec2 v)
{
    return ff_v2(ff_dot2(f, v), ff_det2(f, v));
}
static inline ff_vec2 ff_from_frame2(ff_vec2 f, ff_vec2 v)
{
    return ff_v2(f.a * v.a - f.b * v.b, f.b * v.a + f.a * v.b);
}

/* ------------------------------------------------------------------------------------------------- space */
static inline ff_vec3 ff_v3(double x, double y, double z)
{
    return (ff_vec3){x, y, z};
}
static inline ff_vec3 ff_add3(ff_vec3 u, ff_vec3 v)
{
    return ff_v3(u.x + v.x, u.y + v.y, u.z + v.z);
}
static inline ff_vec3 ff_sub3(ff_vec3 u, ff_vec3 v)
{
    return ff_v3(u.x - v.x, u.y - v.y, u.z - v.z);
}
static inline ff_vec3 ff_scale3(ff_vec3 u, double s)
{
    return ff_v3(u.x * s, u.y * s, u.z * s);
}
static inline ff_vec3 ff_madd3(ff_vec3 u, ff_vec3 v, double s)
{
    return ff_v3(u.x + v.x * s, u.y + v.y * s, u.z + v.z * s);
}
static inline double ff_dot3(ff_vec3 u, ff_vec3 v)
{
    return u.x * v.x + u.y * v.y + u.z * v.z;
}
static inline ff_vec3 ff_cross3(ff_vec3 u, ff_vec3 v)
{
    return ff_v3(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
}
static inline double ff_length3(ff_vec3 u)
{
    return sqrt(ff_dot3(u, u));
}
static inline ff_vec3 ff_unit3(ff_vec3 u)
{
    double length = ff_length3(u);
    return length > 1e-12 ? ff_scale3(u, 1.0 / length) : ff_v3(0.0, 0.0, 0.0);
}
static inline ff_vec3 ff_lerp3(ff_vec3 u, ff_vec3 v, double t)
{
    return ff_v3(ff_lerp(u.x, v.x, t), ff_lerp(u.y, v.y, t), ff_lerp(u.z, v.z, t));
}

/* ------------------------------------------------------------------------------------------- quaternions */
#define FF_QUAT_IDENTITY ((ff_quat){0.0, 0.0, 0.0, 1.0})
static inline ff_quat ff_quat_mul(ff_quat p, ff_quat q)
{
    return (ff_quat){
        p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y, p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x,
        p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w, p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z};
}
static inline ff_quat ff_quat_conj(ff_quat q)
{
    return (ff_quat){-q.x, -q.y, -q.z, q.w};
}
static inline double ff_quat_dot(ff_quat p, ff_quat q)
{
    return p.x * q.x + p.y * q.y + p.z * q.z + p.w * q.w;
}
static inline ff_quat ff_quat_unit(ff_quat q)
{
    double n = sqrt(ff_quat_dot(q, q));
    if (!(n > 1e-12)) return FF_QUAT_IDENTITY;
    double over = 1.0 / n;
    return (ff_quat){q.x * over, q.y * over, q.z * over, q.w * over};
}
static inline ff_vec3 ff_quat_rotate(ff_quat q, ff_vec3 v)
{
    ff_vec3 u = ff_v3(q.x, q.y, q.z);
    ff_vec3 t = ff_scale3(ff_cross3(u, v), 2.0);
    return ff_add3(ff_madd3(v, t, q.w), ff_cross3(u, t));
}
ff_quat ff_quat_axis(ff_vec3 unit_axis, double angle);
ff_quat ff_quat_yaw(double psi); /* about +Y */
/* Smallest rotation that takes unit vector from to unit vector to (any axis when they are opposite). */
ff_quat ff_quat_between(ff_vec3 from, ff_vec3 to);
/* Normalised linear interpolation along the shorter arc. */
ff_quat ff_quat_nlerp(ff_quat p, ff_quat q, double t);
ff_quat ff_quat_slerp(ff_quat p, ff_quat q, double t);
/* Heading of a rotation whose identity faces +Z: atan2 of the rotated forward vector, never an Euler angle. */
double ff_quat_heading(ff_quat q);
/* Rotation vector (axis * angle, angle in [0, pi]) of q, and back. */
ff_vec3 ff_quat_log(ff_quat q);
ff_quat ff_quat_exp(ff_vec3 rotation_vector);
double ff_quat_angle(ff_quat q); /* rotation angle in [0, pi] */

#endif
