/* loop.h - a stretch of a motion closed into a seamless loop on a root that moves at constant rates. */
#ifndef FF_LOOP_H
#define FF_LOOP_H

#include "preprocess/example.h"

/* Frames start to start + length of a motion, the last being the first again. */
typedef struct ff_stretch {
    int start, length;
} ff_stretch;

/* A root that moves at constant rates: where it is at the start of the stretch. */
typedef struct ff_steady_root {
    ff_vec2 origin, velocity; /* velocity in its own frame, m per frame */
    double heading, turn;     /* rad, rad per frame */
} ff_steady_root;

/* The constant-rate root through the smoothed root at both ends of the stretch, then shifted and turned so that hips
 * and facing are on it on average. Walks within 15 degrees of straight ahead or back face along their path. */
ff_steady_root ff_steady_root_fit(const ff_motion *motion, const ff_stretch *stretch);

/* The one that stands where hips and facing are on average. */
ff_steady_root ff_steady_root_still(const ff_motion *motion, const ff_stretch *stretch);

/* Mean distance of the joints (m) of the last from the first pose, both seen from the root. */
double ff_loop_seam(const ff_rig *rig, const ff_motion *motion, const ff_stretch *stretch,
                    const ff_steady_root *root);

/* The closed loop: poses near 60 Hz, period, rates, seam and wander; keys and feet are still to be found. */
ff_status ff_loop_close(const ff_rig *rig, const ff_motion *motion, const ff_stretch *stretch,
                        const ff_steady_root *root, ff_example *out, ff_error *error);

#endif
