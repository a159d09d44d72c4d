/* synth_choice.h - which way of moving an agent wants: blended examples in the open, the semi-procedural clip where every
 * step counts (FbCrowd eq 1), a run where it is in a hurry.
 *
 * Eq 1 as printed blends when the time to collision is at most t_trans, that is just when a collision is imminent. Followed
 * is its prose: blending is preferred unless a collision is possible (algorithms D.5).
 */
#ifndef FF_SYNTH_CHOICE_H
#define FF_SYNTH_CHOICE_H

#include "runtime/core/gait/synth.h"
#include "runtime/core/nav/nav_grid.h"
#include "runtime/core/nav/nav_walls.h"

/* What is remembered of one agent. Plain, no padding: hashed as bytes. */
typedef struct ff_choice {
    double calm;      /* s, for which nothing has called for control */
    uint32_t control; /* 1: the semi-procedural clip is wanted */
    uint32_t runs;
} ff_choice;

/* What it goes by. */
typedef struct ff_choice_view {
    double step;         /* s */
    double time;         /* s to the first collision, INFINITY for none */
    double density;      /* people per m2 */
    double ahead;        /* m/s, of the command along where the body faces */
    double since_switch; /* s */
    bool hurries;        /* its preferred speed is above FF_RUN_PREFERRED */
} ff_choice_view;

/* synthesis: FF_SYNTHESIS_BLENDING, ... *urgent: a switch cannot wait. */
ff_locomotion ff_choose_locomotion(ff_synthesis synthesis, const ff_choice_view *view, ff_choice *choice,
                                   bool *urgent);

/* Until somebody of the neighbours (from ff_grid_neighbours: at present velocities) or a wall is touched. */
double ff_choice_time(const ff_seen *me, const ff_neighbour *neighbours, uint32_t count,
                      const ff_wall *const *walls, uint32_t wall_count);

/* People per m2 about grid->seen[self], itself excluded: a Gaussian of 0.8 m (algorithms C.5). */
double ff_choice_density(const ff_grid *grid, uint32_t self);

#endif
