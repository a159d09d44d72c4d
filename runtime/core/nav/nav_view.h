/* nav_view.h - what one agent sees during a step, and what motion-constrained navigation and its baselines make of it:
 * forces, ORCA lines, a velocity that obeys them. */
#ifndef FF_NAV_VIEW_H
#define FF_NAV_VIEW_H

#include "runtime/core/nav/nav.h"

#define FF_RELAXATION 0.54    /* s, of eq 9 */
#define FF_HORIZON 2.5        /* s, of ORCA */
#define FF_SPEED_MAX 2.2      /* m/s, of those who prefer no more */
#define FF_COMMAND_CHANGE 2.0 /* m/s^2, of MCN */
#define FF_COMMAND_STILL 0.05 /* m/s: a command below it has no direction */

typedef struct ff_nav_view {
    const ff_nav_world *world;
    const ff_seen *me;
    const ff_neighbour *neighbours;
    uint32_t neighbour_count;
    const ff_wall *walls[FF_NEAR_WALLS_MAX];
    uint32_t wall_count;
    ff_mover_seen movers[FF_MOVERS_SEEN_MAX];
    uint32_t mover_count;
    double speed_max; /* m/s, that may be asked for at all */
} ff_nav_view;

/* What ORCA is told of a pair. */
typedef struct ff_avoiding {
    double prediction; /* s, ahead of which the pair is looked at */
    double lean;       /* rad, side preference of pairs that meet head on (ff_orca_disc) */
    bool weighted;     /* lines weigh by time to collision */
} ff_avoiding;

/* Half-planes in the order in which they yield: walls never, then what the body can do, then other agents. */
typedef struct ff_constraints {
    ff_line line[FF_LINES_MAX];
    uint32_t walls, hull, sharp, hard; /* ends: [0, walls) are walls, [walls, hull) the hull, and so on */
    uint32_t count;
} ff_constraints;

void ff_nav_look(const ff_nav_world *world, uint32_t self, const ff_neighbour *neighbours, uint32_t count,
                 ff_nav_view *out);

/* Sum of the power-law forces of everybody, every wall and every obstacle near, each at most one, all together at most total (m/s^2). */
ff_vec2 ff_nav_forces(const ff_nav_view *view, double one, double total);

/* Begin with the walls; put those of obstacles that move (seen `prediction` s ahead) and the neighbours' at the end. */
void ff_nav_add_walls(const ff_nav_view *view, ff_constraints *lines);
void ff_nav_add_movers(const ff_nav_view *view, double prediction, ff_constraints *lines);
void ff_nav_add_agents(const ff_nav_view *view, ff_avoiding how, ff_constraints *lines);

/* The velocity nearest to wish inside near, if the hard lines leave anything there, else inside wide. If rounding leaves
 * nothing there either, the standing foot, sharp turns and the hull are given up in this order (the body will clamp), the
 * walls never; the standing foot also where it would leave an agent unavoided. Agents that cannot all be avoided are violated evenly, weights counted. */
ff_vec2 ff_nav_solve(ff_constraints *lines, ff_circle near, ff_circle wide, ff_vec2 wish);

#endif
