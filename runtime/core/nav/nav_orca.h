/* nav_orca.h - half-planes of collision-free velocities (ORCA, van den Berg et al. 2011; algorithms C.7). */
#ifndef FF_NAV_ORCA_H
#define FF_NAV_ORCA_H

#include "runtime/core/nav/nav_solve.h"
#include "runtime/core/nav/nav_time.h"

/* Line for avoiding a moving disc. to_other = p_j - p_i, relative = v_i - v_j, own = v_i, reach = r_i + r_j,
 * horizon in s, share = part of the avoidance that is ours; lean
 * (rad): up to this far off the middle to the left one still passes on the right (negative: the other way round); apart = unit direction to use when the geometry gives none
 * (the two must be given opposite ones). A pair that overlaps is told to part within overlap_time. */
ff_line ff_orca_disc(ff_vec2 to_other, ff_vec2 relative, ff_vec2 own, double reach, double horizon,
                     double share, double overlap_time, double lean, ff_vec2 apart);

/* Lines for not touching walls[count] (at most FF_WALL_LINES_MAX) within horizon seconds, put at the end of lines;
 * returns the new count. Walls take no part in avoiding: full responsibility. All lines admit standing still. Each wall's
 * velocity obstacle is left at the point nearest to our velocity that is not inside that of a wall which shares an end (a
 * chain is one obstacle); the nearest ways out come first, and walls that an earlier line has dealt with give none. */
#define FF_WALL_LINES_MAX 16
uint32_t ff_orca_walls(const ff_wall *const *walls, uint32_t count, ff_vec2 p, ff_vec2 own, double radius,
                       double horizon, ff_line *lines, uint32_t line_count);

#endif
