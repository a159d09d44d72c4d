#include "mocap/euler.h"

/* Closer to straight up or down than this (sine), two of the angles turn about the same axis: one is set to zero. */
#define GIMBAL 0.9999999999

static double arcsine(double s)
{
    s = ff_clamp(s, -1.0, 1.0);
    return ff_atan2(s, sqrt((1.0 - s) * (1.0 + s)));
}

ff_vec3 ff_euler_zxy(ff_quat q)
{
    double m21 = 2.0 * (q.y * q.z + q.w * q.x);
    double m00 = 1.0 - 2.0 * (q.y * q.y + q.z * q.z), m10 = 2.0 * (q.x * q.y + q.w * q.z);
    double m01 = 2.0 * (q.x * q.y - q.w * q.z), m11 = 1.0 - 2.0 * (q.x * q.x + q.z * q.z);
    double m20 = 2.0 * (q.x * q.z - q.w * q.y), m22 = 1.0 - 2.0 * (q.x * q.x + q.y * q.y);
    ff_vec3 angles = ff_v3(arcsine(m21), 0.0, 0.0);
    if (fabs(m21) > GIMBAL) {
        angles.z = ff_atan2(m10, m00);
    } else {
        angles.y = ff_atan2(-m20, m22);
        angles.z = ff_atan2(-m01, m11);
    }
    return ff_scale3(angles, 1.0 / FF_DEG);
}

ff_vec3 ff_euler_zyx(ff_quat q)
{
    double m20 = 2.0 * (q.x * q.z - q.w * q.y);
    double m00 = 1.0 - 2.0 * (q.y * q.y + q.z * q.z), m10 = 2.0 * (q.x * q.y + q.w * q.z);
    double m01 = 2.0 * (q.x * q.y - q.w * q.z), m11 = 1.0 - 2.0 * (q.x * q.x + q.z * q.z);
    double m21 = 2.0 * (q.y * q.z + q.w * q.x), m22 = 1.0 - 2.0 * (q.x * q.x + q.y * q.y);
    ff_vec3 angles = ff_v3(0.0, arcsine(-m20), 0.0);
    if (fabs(m20) > GIMBAL) {
        angles.z = ff_atan2(-m01, m11);
    } else {
        angles.x = ff_atan2(m21, m22);
        angles.z = ff_atan2(m10, m00);
    }
    return ff_scale3(angles, 1.0 / FF_DEG);
}
