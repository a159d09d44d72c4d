/* nav_forces.h - anticipatory forces by the power law of human interactions (FbCrowd eq 9 and 11; Karamouzas,
 * Skinner and Guy 2014; algorithms C.3). Per unit mass: m/s^2. */
#ifndef FF_NAV_FORCES_H
#define FF_NAV_FORCES_H

#include "runtime/core/nav/nav_time.h"

#define FF_FORCE_MAX 5.0       /* m/s^2 per pair: a graze makes the published force unbounded */
#define FF_FORCE_TOTAL_MAX 8.0 /* m/s^2 */

/* The published force of a disc that is not overlapped, unclamped; x = p_i - p_j, v = v_i - v_j. */
ff_vec2 ff_power_law(ff_vec2 x, ff_vec2 v, double reach);

/* What acts on i: the power law clamped to limit; for an overlap, which the papers leave open, a graze plus
 * a push apart. away = unit direction to use when both stand on the same point. */
ff_vec2 ff_force_from_disc(ff_vec2 x, ff_vec2 v, double reach, double limit, ff_vec2 away);

/* The same for the nearest (in time) of the walls: neighbouring segments of one chain must not push twice. */
ff_vec2 ff_force_from_walls(const ff_wall *const *walls, uint32_t count, ff_vec2 p, ff_vec2 v, double radius,
                            double limit);

/* v shortened to at most limit. */
ff_vec2 ff_shorten2(ff_vec2 v, double limit);

#endif
