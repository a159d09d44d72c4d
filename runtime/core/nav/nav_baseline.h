/* nav_baseline.h - the two methods that FbCrowd compares itself with, on the same body and synthesis (navigation study,
 * section 2). */
#ifndef FF_NAV_BASELINE_H
#define FF_NAV_BASELINE_H

#include "runtime/core/nav/nav_view.h"

/* ORCA alone: reciprocal velocity obstacles from the velocities seen, 2.5 s, half each, and RVO2's fallback. */
ff_vec2 ff_nav_orca(const ff_nav_view *view, ff_vec2 preferred);

/* Power-law forces alone: one explicit Euler step of eq 9 from the velocity seen, forces together at most 20 m/s2. */
ff_vec2 ff_nav_social_force(const ff_nav_view *view, ff_vec2 preferred);

#endif
