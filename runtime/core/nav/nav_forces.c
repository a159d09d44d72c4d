#include "runtime/core/nav/nav_forces.h"

#define STRENGTH 1.5  /* k, m^2/s^2 per kg */
#define HORIZON 3.0   /* tau_0, s: the interaction horizon of eq 11, not the relaxation time of eq 9 */
#define TIME_MIN 0.05 /* s, guards 1 / tau^3 */
#define TIME_MAX 10.0 /* s, beyond it the force is negligible */
#define PUSH 10.0     /* m/s^2 for a whole overlap */
#define GRAZE 0.99    /* of the distance: the reach assumed for a pair that overlaps */

/* -dE/dtau of E = k tau^-2 exp(-tau / tau_0). */
static double steepness(double time)
{
    double tau = ff_max(time, TIME_MIN);
    return STRENGTH * ff_exp(-tau / HORIZON) / (tau * tau) * (2.0 / tau + 1.0 / HORIZON);
}

ff_vec2 ff_shorten2(ff_vec2 v, double limit)
{
    double length = ff_length2(v);
    return length > limit ? ff_scale2(v, limit / length) : v;
}

ff_vec2 ff_power_law(ff_vec2 x, ff_vec2 v, double reach)
{
    double time = ff_time_to_disc(x, v, reach);
    if (!(time <= TIME_MAX) || time <= 0.0) return ff_v2(0.0, 0.0);
    return ff_scale2(ff_time_to_disc_gradient(x, v, reach), steepness(time));
}

ff_vec2 ff_force_from_disc(ff_vec2 x, ff_vec2 v, double reach, double limit, ff_vec2 away)
{
    double distance = ff_length2(x);
    if (distance > reach) return ff_shorten2(ff_power_law(x, v, reach), limit);
    ff_vec2 graze = ff_power_law(x, v, GRAZE * distance);
    ff_vec2 out = distance > 1e-6 ? ff_scale2(x, 1.0 / distance) : away;
    double overlap = reach > 0.0 ? (reach - distance) / reach : 0.0;
    return ff_shorten2(ff_madd2(graze, out, PUSH * overlap), limit);
}

ff_vec2 ff_force_from_walls(const ff_wall *const *walls, uint32_t count, ff_vec2 p, ff_vec2 v, double radius,
                            double limit)
{
    double soonest = TIME_MAX;
    ff_vec2 gradient = ff_v2(0.0, 0.0);
    for (uint32_t i = 0; i < count; ++i) {
        ff_vec2 here;
        double time = ff_time_to_wall(walls[i], p, v, radius, &here);
        if (time < soonest) soonest = time, gradient = here;
    }
    if (soonest > 0.0) return ff_shorten2(ff_scale2(gradient, steepness(soonest)), limit);
    /* In touch: a constant gentle push out, so that nobody leans on a wall. */
    return ff_scale2(gradient, 1.0);
}
