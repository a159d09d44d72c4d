/* nav_movers.h - obstacles that move, as those see them who go by velocity: discs, capsules and boxes that go on as they are known
 * or seen to, and give no way. Whatever their height: nobody who goes by velocity can step over anything, or duck. */
#ifndef FF_NAV_MOVERS_H
#define FF_NAV_MOVERS_H

#include "runtime/core/nav/nav_grid.h"
#include "runtime/core/nav/nav_solve.h"
#include "runtime/core/nav/nav_time.h"

#define FF_MOVERS_SEEN_MAX 4
#define FF_MOVER_LINES_MAX 4 /* of one */

/* A rectangle grown by a radius; a capsule has no width, a disc no length either. */
typedef struct ff_nav_mover {
    ff_path path;                           /* where its centre will be; at[0] = now */
    ff_vec2 ahead;                          /* unit, of its length */
    double half_length, half_width, radius; /* m */
} ff_nav_mover;

/* One that can be met, as an agent takes it. */
typedef struct ff_mover_seen {
    const ff_nav_mover *mover;
    ff_vec2 velocity; /* m/s, at which it gets evenly to where the agent would touch it or come nearest */
    ff_vec2 out;      /* unit, from its edge to the agent */
    double gap;       /* m, from the agent's middle to its edge, the radius counted; negative inside */
    double time;      /* s, in which they could meet at the soonest */
} ff_mover_seen;

/* The soonest of them, ties in their order; returns how many. */
uint32_t ff_movers_see(const ff_nav_mover *movers, uint32_t count, const ff_seen *me,
                       ff_mover_seen out[FF_MOVERS_SEEN_MAX]);

/* ORCA's lines of full responsibility put at the end of lines; returns the new count. reach: m, what the agent needs; ahead: s,
 * for which it cannot help going on as it does; least_time: s, in which an overlap is left. */
uint32_t ff_mover_lines(const ff_mover_seen *seen, const ff_seen *me, double reach, double ahead,
                        double least_time, ff_line *lines, uint32_t count);

/* The anticipatory force, at most limit (nav_forces.h). */
ff_vec2 ff_force_from_mover(const ff_mover_seen *seen, const ff_seen *me, double reach, double limit);

#endif
