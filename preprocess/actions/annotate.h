/* annotate.h - the annotation of one action: Table 1 of Beacco et al. 2013 and the sampled collider positions. */
#ifndef FF_ANNOTATE_H
#define FF_ANNOTATE_H

#include "preprocess/actions/steps.h"

/* Where an action lies and what stands. Plants index ff_plants.items. */
typedef struct ff_step_span {
    int first, last; /* frames */
    int support;     /* plant of the foot that stays */
    int swing;       /* plant in which the other foot arrives */
    int swing_from;  /* plant that the swing foot left, -1 = none in the clip: its place at first is taken */
    int mode;        /* FF_MODE_*, or -1: walk or run, told apart by flight and speed */
    uint32_t flags;  /* FF_ACTION_WHOLE, _FROM_STANDING, _TO_STANDING */
} ff_step_span;

/* First frame in which the whole foot is down: flat_start; for a foot that is never flat (forefoot runners) the first
 * frame in which the ball rests. -1 when it never is. */
int ff_plant_full(const ff_plants *plants, int plant);

/* Metabolic energy of walking (algorithms B.2; the figures are Whittle's as the paper uses them), J/kg: integral of e_s +
 * e_w v^2 over the root's ground path. */
double ff_walk_energy(const ff_energy_settings *energy, const ff_vec3 *root, int first, int last,
                      double frame_time);

/* Longest stretch of [first, last] in which no foot is down, in frames; returns false when there is none. */
bool ff_find_flight(const ff_plants *plants, int first, int last, int *from, int *to);

/* Fill record (all but clip and first_collider) and colliders. */
void ff_action_annotate(const ff_cut_settings *settings, const ff_rig *rig, const ff_motion *motion,
                        const ff_plants *plants, const ff_step_span *span, ff_action *out);

/* Joints about a frame as seen from origin and heading, over a level (m). */
void ff_join_read(const ff_rig *rig, const ff_motion *motion, int frame, ff_vec2 origin, double heading,
                  double level, ff_join *out);

/* Where the middles of the colliders are in a posed body; the root's stands on the hips, for want of their ground frame. */
void ff_collider_middles(const ff_vec3 at[FF_BODY_COUNT], ff_vec3 out[FF_COLLIDER_COUNT]);

/* m, of the cylinders about the colliders. */
void ff_collider_radii(const ff_collider_settings *settings, double out[FF_COLLIDER_COUNT]);

/* Fill colliders, collider_samples and coarse_radius of an action whose frames, frame S0 and height are given. */
void ff_action_sample(const ff_collider_settings *settings, const ff_rig *rig, const ff_motion *motion,
                      ff_vec2 origin, double heading, ff_action *out);

#endif
