#include "runtime/core/leg_ik.h"

#define SOFT_FROM 0.99
#define SOFT_TO 0.998
#define SWING_FROM 0.95
#define SWING_TO 0.993

static double ease(double distance, double from, double to)
{
    if (distance <= from) return distance;
    return from + (to - from) * (1.0 - ff_exp(-(distance - from) / (to - from)));
}

double ff_leg_soft_reach(double distance, double leg_length)
{
    return ease(distance, SOFT_FROM * leg_length, SOFT_TO * leg_length);
}

double ff_leg_swing_reach(double distance, double leg_length, double share)
{
    return ff_lerp(distance, ease(distance, SWING_FROM * leg_length, SWING_TO * leg_length), share);
}

/* Part of v at right angles to unit vector line. */
static ff_vec3 across(ff_vec3 v, ff_vec3 line)
{
    return ff_madd3(v, line, -ff_dot3(v, line));
}

static double inverse(double length)
{
    return length > 1e-12 ? 1.0 / length : 0.0;
}

/* The bone turned by what takes its old direction to the new one (both over_length long), then carried along. */
static ff_quat turn_bone(ff_quat bone, ff_quat carry, ff_vec3 old, ff_vec3 new, double over_length)
{
    ff_quat turn = ff_quat_between(ff_scale3(old, over_length), ff_scale3(new, over_length));
    return ff_quat_mul(carry, ff_quat_mul(turn, bone));
}

/* Knee and shank are laid out about the old line from hip to ankle, and all is carried to the new one at the end. */
void ff_leg_solve(ff_leg *leg, ff_vec3 hip, ff_vec3 ankle)
{
    ff_vec3 thigh = ff_sub3(leg->knee, leg->hip), shank = ff_sub3(leg->ankle, leg->knee);
    double thigh_length = ff_length3(thigh), shank_length = ff_length3(shank);
    ff_vec3 old_line = ff_unit3(ff_sub3(leg->ankle, leg->hip)), wanted = ff_sub3(ankle, hip);
    double distance = ff_length3(wanted);
    ff_vec3 line = ff_scale3(wanted, inverse(distance));

    /* A nearly straight knee has no side of its own: the front of the thigh helps it out. */
    ff_vec3 front = ff_quat_rotate(leg->thigh, ff_v3(0.0, 0.0, 1.0));
    ff_vec3 side = ff_unit3(across(ff_madd3(thigh, front, 0.05 * thigh_length), old_line));

    double closest = fabs(thigh_length - shank_length) + 0.05 * (thigh_length + shank_length);
    distance = ff_max(ff_leg_soft_reach(distance, thigh_length + shank_length), closest);
    double along =
        (distance * distance + thigh_length * thigh_length - shank_length * shank_length) / (2.0 * distance);
    double out = sqrt(ff_max(thigh_length * thigh_length - along * along, 0.0));

    ff_vec3 new_thigh = ff_madd3(ff_scale3(old_line, along), side, out);
    ff_vec3 new_shank = ff_sub3(ff_scale3(old_line, distance), new_thigh);
    ff_quat carry = ff_quat_between(old_line, line);
    leg->thigh = turn_bone(leg->thigh, carry, thigh, new_thigh, inverse(thigh_length));
    leg->shank = turn_bone(leg->shank, carry, shank, new_shank, inverse(shank_length));
    leg->hip = hip;
    leg->knee = ff_add3(hip, ff_quat_rotate(carry, new_thigh));
    leg->ankle = ff_madd3(hip, line, distance);
}
