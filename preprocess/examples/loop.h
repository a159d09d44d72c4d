/* loop.h - a stretch of a motion closed into a seamless loop on a root that moves at constant rates. */
#ifndef FF_LOOP_H
#define FF_LOOP_H

#include "preprocess/examples/example.h"

/* Frames start to start + length of a motion, the last being the first again. Or, half a cycle: the last is the mirror
 * image of the first, and the cycle goes on with the mirror image of all. */
typedef struct ff_stretch {
    int start, length;
    bool half;
} ff_stretch;

/* A root that moves at constant rates: where it is at the start of the stretch. */
typedef struct ff_steady_root {
    ff_vec2 origin, velocity; /* velocity in its own frame, m per frame */
    double heading, turn;     /* rad, rad per frame */
} ff_steady_root;

/* The constant-rate root through the smoothed root at both ends of the stretch, then shifted and turned so that hips
 * and facing are on it on average. Walks within 15 degrees of straight ahead or back face along their path. */
ff_steady_root ff_steady_root_fit(const ff_motion *motion, const ff_stretch *stretch);

/* The one of half a cycle: straight ahead, with hips and facing as far on one side at the start as on the other at the
 * end, as they are in a symmetric walk. */
ff_steady_root ff_steady_root_half(const ff_motion *motion, const ff_stretch *stretch);

/* The one that stands where hips and facing are on average. */
ff_steady_root ff_steady_root_still(const ff_motion *motion, const ff_stretch *stretch);

/* Mean distance of the joints (m) of the last from the first pose (of half a cycle from its mirror image), both seen
 * from the root. */
double ff_loop_seam(const ff_rig *rig, const ff_motion *motion, const ff_stretch *stretch,
                    const ff_steady_root *root);

/* What a cut costs (m): the seam, half of the largest gap of a joint (what closing will move it by), and a tenth of a
 * second of the difference of velocities. Frames to both sides of the stretch are looked at. */
double ff_loop_cost(const ff_rig *rig, const ff_motion *motion, const ff_stretch *stretch);

/* The steady root of a stretch that walks: fit or half. */
ff_steady_root ff_steady_root_of(const ff_motion *motion, const ff_stretch *stretch);

/* The closed loop: poses near 60 Hz, period, rates, seam, wander and what closing did. Frame 0 is where the share
 * `first` of the cycle is. Keys, feet and the contact to compare the cut with are still to be found. */
ff_status ff_loop_close(const ff_rig *rig, const ff_motion *motion, const ff_stretch *stretch,
                        const ff_steady_root *root, double first, ff_example *out, ff_error *error);

/* Fill example->loop.contact_kick. Keys must be set. */
void ff_loop_find_contact_kick(const ff_rig *rig, ff_example *example);

#endif
