/* correspond.h - times at which the poses of two cycles agree (FbCrowd 5.1 and 10; algorithms A.12): minima of the
 * distance map and the valleys between them, in cyclic order, spaced, refined. */
#ifndef FF_CORRESPOND_H
#define FF_CORRESPOND_H

#include "preprocess/base/stage_settings.h"
#include "preprocess/examples/pose_distance.h"

/* Defaults of the settings. */
#define FF_PAIRS_MAX 12      /* no more fit with FF_PAIR_SPACING */
#define FF_PAIR_SPACING 0.08 /* of a cycle, between two pairs in either cycle */
/* Joints further apart than this at the pair itself (m, root mean square) are no pair: between straight walks, and
 * between everything else. */
#define FF_PAIR_LIMIT_STRAIGHT 0.08
#define FF_PAIR_LIMIT 0.10
/* Windows further apart (m) are none either. They differ more than poses do when speeds differ, which a change of
 * weights before the change of cycle takes away. */
#define FF_MAP_LIMIT 0.15

typedef struct ff_cycle_pair {
    double phase[2];
    ff_alignment alignment; /* of the second cycle on the first */
    double distance, rms;   /* m: of the windows; of the poses */
} ff_cycle_pair;

typedef struct ff_cycle_pairs {
    ff_cycle_pair pair[FF_PAIRS_MAX]; /* phase[0] increases, phase[1] goes once around */
    int count;
    bool by_keys;   /* not minima, but the same events of the same foot */
    double wait[2]; /* s, longest until the next pair */
    double mean;    /* m, distance along the warp through the pairs */
} ff_cycle_pairs;

/* One side of a correspondence. keys NULL = it has no steps. */
typedef struct ff_cycle_side {
    const ff_point_cycle *cycle;
    const ff_map_windows *windows;
    const float *keys; /* [4] left contact, right off, right contact, left off */
} ff_cycle_side;

/* Pairs whose rms is at most limit; out->count = 0 when there is none. map [FF_MAP_SIDE^2] receives the
 * distances. */
ff_status ff_correspond(const ff_correspondence_settings *settings, const ff_cycle_side *first,
                        const ff_cycle_side *second, double limit, double *map, ff_cycle_pairs *out,
                        ff_error *error);

/* Move the pairs to where the windows agree best, all of one correspondence together: phases by at most reach, alignment
 * free, the warp between the pairs even (correspond_ceres.cpp). */
ff_status ff_correspond_refine(const ff_point_cycle *first, const ff_point_cycle *second, double reach,
                               ff_cycle_pairs *pairs, ff_error *error);

#endif
