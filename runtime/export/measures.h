/* measures.h - the figures of a whole run, from its recording and what was watched while it ran. */
#ifndef FF_MEASURES_H
#define FF_MEASURES_H

#include "runtime/export/watch.h"

typedef struct ff_slides {
    double median, p95, most; /* m, path of the ball over a plant */
    uint64_t plants;
} ff_slides;

typedef struct ff_measures {
    uint32_t agents, arrived;
    double mean_arrival, last_arrival; /* s; of those who arrived */
    double collision_rate;             /* C, eq 17 */
    double deepest;                    /* m, of discs */
    uint64_t pairs;                    /* of discs that were ever deeper than FF_OVERLAP_LEAST */
    double raw, filtered; /* A, m/s^2, eq 18: from step to step; velocities over one step of walking */
    /* The latter en route: from 2 s on until 1.5 m before the goal, while walking (faster than 0.15 m/s). A jam has next to
     * no acceleration, so with those who stand in it counted (route_all) a method is the smoother the more it jams. */
    double route, route_all;
    double body_deepest;     /* m, of the bodies' five cylinders */
    uint64_t body_pairs;     /* of bodies that ever touched, as pairs */
    ff_slides planted, seen; /* ff_skate */
    double low_slide;        /* m/s */
    double joint_speed;      /* rad/s, of the fastest joint between two steps */
} ff_measures;

/* Sorts the watch's slides; otherwise changes nothing. */
ff_status ff_measures_take(ff_watch *watch, const ff_recording *recording, ff_measures *out, ff_error *error);

#endif
