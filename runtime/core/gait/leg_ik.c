#include "runtime/core/gait/leg_ik.h"

#define SOFT_FROM 0.99
#define SOFT_TO 0.998
#define SWING_FROM 0.95
#define SWING_TO 0.993
#define SWING_TAKES 0.15 /* of the swing, in which a leg becomes free to fall short of its foot ... */
#define SWING_GIVES 0.25 /* ... and before the landing no longer is */

static double ease(double distance, double from, double to)
{
    if (distance <= from) return distance;
    return from + (to - from) * (1.0 - ff_exp(-(distance - from) / (to - from)));
}

double ff_leg_soft_reach(double distance, double leg_length)
{
    return ease(distance, SOFT_FROM * leg_length, SOFT_TO * leg_length);
}

double ff_leg_hard_reach(double distance, double leg_length)
{
    double from = SOFT_FROM * leg_length, to = SOFT_TO * leg_length;
    if (distance <= from) return distance;
    double rest = ff_max((to - distance) / (to - from), 0.02), t = 1.0 - rest;
    for (int i = 0; i < 5; ++i) /* Newton's steps for exp(-t) = rest, which from below never overshoot */
        t += 1.0 - rest * ff_exp(t);
    return from + (to - from) * t;
}

double ff_leg_swing_reach(double distance, double leg_length, double share)
{
    return ff_lerp(distance, ease(distance, SWING_FROM * leg_length, SWING_TO * leg_length), share);
}

double ff_leg_swing_distance(double swing, double distance, double leg_length)
{
    double share = ff_smooth(swing / SWING_TAKES) * ff_smooth((1.0 - swing) / SWING_GIVES);
    return ff_leg_swing_reach(distance, leg_length, share);
}

/* Part of v at right angles to unit vector line. */
static ff_pair3 across(ff_pair3 v, ff_pair3 line)
{
    return ff_pair3_madd(v, line, -ff_pair3_dot(v, line));
}

/* Bones turned by what takes their old directions to the new ones (both over_length long), then carried along. */
static ff_pairq turn_bones(ff_pairq bones, ff_pairq carry, ff_pair3 old, ff_pair3 new, ff_pair over_length)
{
    ff_pairq turn = ff_pairq_between(ff_pair3_scale(old, over_length), ff_pair3_scale(new, over_length));
    return ff_pairq_mul(carry, ff_pairq_mul(turn, bones));
}

/* Knee and shank are laid out about the old line from hip to ankle, and all is carried to the new one at the end. */
void ff_legs_solve(ff_legs *legs, ff_pair3 hip, ff_pair3 ankle)
{
    const ff_pair3 forward = {{0.0, 0.0}, {0.0, 0.0}, {1.0, 1.0}};
    ff_pair3 thigh = ff_pair3_sub(legs->knee, legs->hip), shank = ff_pair3_sub(legs->ankle, legs->knee);
    ff_pair thigh_length = ff_pair3_length(thigh), shank_length = ff_pair3_length(shank);
    ff_pair both = thigh_length + shank_length;
    ff_pair3 old_line = ff_pair3_unit(ff_pair3_sub(legs->ankle, legs->hip)),
             wanted = ff_pair3_sub(ankle, hip);
    ff_pair distance = ff_pair3_length(wanted);
    ff_pair3 line = ff_pair3_scale(wanted, ff_pair_inverse(distance));

    /* A nearly straight knee has no side of its own: the front of the thigh helps it out. And one bent backward, as what is left
     * of a switch may have it for a moment, is not believed. */
    ff_pair3 front = across(ff_pairq_rotate(legs->thigh, forward), old_line), bent = across(thigh, old_line);
    ff_pair backward = ff_pair_max(-ff_pair3_dot(bent, front), ff_pair_of(0.0, 0.0));
    ff_pair square_front = ff_pair_max(ff_pair3_dot(front, front), ff_pair_of(1e-6, 1e-6));
    ff_pair3 side = ff_pair3_unit(ff_pair3_madd(bent, front, 0.05 * thigh_length + backward / square_front));

    ff_pair apart = thigh_length - shank_length, closest = ff_pair_max(apart, -apart) + 0.05 * both;
    distance = ff_pair_of(ff_leg_soft_reach(distance[0], both[0]), ff_leg_soft_reach(distance[1], both[1]));
    distance = ff_pair_max(distance, closest);
    ff_pair square = thigh_length * thigh_length;
    ff_pair along = (distance * distance + square - shank_length * shank_length) / (2.0 * distance);
    ff_pair out = ff_pair_sqrt(ff_pair_max(square - along * along, ff_pair_of(0.0, 0.0)));

    ff_pair3 new_thigh = ff_pair3_madd(ff_pair3_scale(old_line, along), side, out);
    ff_pair3 new_shank = ff_pair3_sub(ff_pair3_scale(old_line, distance), new_thigh);
    ff_pairq carry = ff_pairq_between(old_line, line);
    legs->thigh = turn_bones(legs->thigh, carry, thigh, new_thigh, ff_pair_inverse(thigh_length));
    legs->shank = turn_bones(legs->shank, carry, shank, new_shank, ff_pair_inverse(shank_length));
    legs->hip = hip;
    legs->knee = ff_pair3_add(hip, ff_pairq_rotate(carry, new_thigh));
    legs->ankle = ff_pair3_madd(hip, line, distance);
}

void ff_leg_solve(ff_leg *leg, ff_vec3 hip, ff_vec3 ankle)
{
    ff_legs legs = {ff_pair3_of(leg->hip, leg->hip),     ff_pair3_of(leg->knee, leg->knee),
                    ff_pair3_of(leg->ankle, leg->ankle), ff_pairq_of(leg->thigh, leg->thigh),
                    ff_pairq_of(leg->shank, leg->shank), ff_pairq_of(leg->foot, leg->foot)};
    ff_legs_solve(&legs, ff_pair3_of(hip, hip), ff_pair3_of(ankle, ankle));
    leg->hip = hip;
    leg->knee = ff_pair3_half(legs.knee, 0);
    leg->ankle = ff_pair3_half(legs.ankle, 0);
    leg->thigh = ff_pairq_half(legs.thigh, 0);
    leg->shank = ff_pairq_half(legs.shank, 0);
}
