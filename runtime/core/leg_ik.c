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

void ff_leg_solve(ff_leg *leg, ff_vec3 hip, ff_vec3 ankle)
{
    ff_vec3 thigh = ff_sub3(leg->knee, leg->hip), shank = ff_sub3(leg->ankle, leg->knee);
    double thigh_length = ff_length3(thigh), shank_length = ff_length3(shank);
    ff_vec3 old_line = ff_unit3(ff_sub3(leg->ankle, leg->hip));
    ff_vec3 wanted = ff_sub3(ankle, hip);
    ff_vec3 line = ff_unit3(wanted);
    ff_quat carry = ff_quat_between(old_line, line);

    /* A nearly straight knee has no side of its own: the front of the thigh helps it out. */
    ff_vec3 front = ff_quat_rotate(leg->thigh, ff_v3(0.0, 0.0, 1.0));
    ff_vec3 side = ff_madd3(across(thigh, old_line), across(front, old_line), 0.05 * thigh_length);
    side = ff_quat_rotate(carry, side);
    side = ff_unit3(across(side, line));

    double closest = fabs(thigh_length - shank_length) + 0.05 * (thigh_length + shank_length);
    double distance = ff_length3(wanted);
    distance = ff_max(ff_leg_soft_reach(distance, thigh_length + shank_length), closest);
    double along =
        (distance * distance + thigh_length * thigh_length - shank_length * shank_length) / (2.0 * distance);
    double out = sqrt(ff_max(thigh_length * thigh_length - along * along, 0.0));

    ff_vec3 new_thigh = ff_add3(ff_scale3(line, along), ff_scale3(side, out));
    ff_vec3 new_shank = ff_sub3(ff_scale3(line, distance), new_thigh);
    ff_quat turn = ff_quat_between(ff_unit3(ff_quat_rotate(carry, thigh)), ff_unit3(new_thigh));
    leg->thigh = ff_quat_unit(ff_quat_mul(ff_quat_mul(turn, carry), leg->thigh));
    turn = ff_quat_between(ff_unit3(ff_quat_rotate(carry, shank)), ff_unit3(new_shank));
    leg->shank = ff_quat_unit(ff_quat_mul(ff_quat_mul(turn, carry), leg->shank));
    leg->hip = hip;
    leg->knee = ff_add3(hip, new_thigh);
    leg->ankle = ff_madd3(hip, line, distance);
}
