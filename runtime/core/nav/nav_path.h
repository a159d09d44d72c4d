/* nav_path.h - those who move by a plan, as those see them who go by velocity: the plan is public, so it is known where they
 * will be, and they cannot leave it at once; all avoiding is the others' part. */
#ifndef FF_NAV_PATH_H
#define FF_NAV_PATH_H

#include "runtime/core/nav/nav_view.h"

/* How the pair of view->me and a neighbour on a path would meet if view->me went on at its reference velocity. */
typedef struct ff_path_meeting {
    ff_vec2 to_other; /* m, from where view->me will be in `ahead` to where the other will be */
    ff_vec2 velocity; /* m/s, at which the other gets evenly from there to where they come nearest */
    double reach;     /* m, which both bodies need then */
    double time;      /* s from now until they touch; INFINITY: they do not */
} ff_path_meeting;

/* Where it is in `time` s from now; it stays at its first and last point before and after. */
ff_vec2 ff_path_at(const ff_path *path, double time);

ff_path_meeting ff_path_meet(const ff_path *path, const ff_seen *me, double ahead);

#endif
