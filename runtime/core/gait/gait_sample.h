/* gait_sample.h - feet, hips and joint rotations of a blend at a phase. */
#ifndef FF_GAIT_SAMPLE_H
#define FF_GAIT_SAMPLE_H

#include "runtime/core/gait/synth_state.h"

/* A foot in the root frame. */
typedef ff_pose_foot ff_foot_sample;

/* Where a blend's parts are in their streams: the work shared by everything sampled at one phase. */
typedef struct ff_cursor {
    const ff_blend
        *clip; /* the semi-procedural clip at these rates, or NULL for examples; must outlive the cursor */
    double fraction; /* of its cycle */
    struct {
        uint32_t frame[2]; /* of the examples' frames */
        double weight[2];
    } part[FF_BLEND_MAX];
    uint32_t count;
} ff_cursor;

/* idle_time: s; the idle example, if it takes part, runs on this clock instead of the phase. */
ff_cursor ff_cursor_at(const ff_blend_space *space, const ff_blend *blend, double phase, double idle_time);
/* The semi-procedural clip (clip->way FF_SEMI_PROCEDURAL) at a fraction of its cycle. */
ff_cursor ff_cursor_of_clip(const ff_blend_space *space, const ff_blend *clip, double fraction);
/* One example alone at a fraction of its cycle. */
ff_cursor ff_cursor_of_vertex(const ff_blend_space *space, int32_t vertex, double fraction);

ff_foot_sample ff_sample_foot(const ff_blend_space *space, const ff_cursor *cursor, int foot);
ff_vec3 ff_sample_hips(const ff_blend_space *space, const ff_cursor *cursor); /* forward, left, height */
ff_quat ff_sample_rotation(const ff_blend_space *space, const ff_cursor *cursor, int joint);
/* The same of all joints but the hips, quickly and in floats (pose_blend.h): for display, not for what is remembered. With
 * other, which is of examples like cursor then, a share of it is mixed in. */
void ff_sample_rotations(const ff_blend_space *space, const ff_cursor *cursor, const ff_cursor *other,
                         double share, ff_quat *rotations);

/* How much of the idle example's cycle has passed on the idle clock, 0 to 1. */
double ff_idle_fraction(const ff_blend_space *space, double idle_time);

/* The blended cycle: how long from one phase to a later one (s), and the phase after dt. */
double ff_phase_duration(const ff_blend_space *space, const ff_blend *blend, double from, double to);
double ff_phase_advance(const ff_blend_space *space, const ff_blend *blend, double phase, double dt);

/* Blended lock of a foot: u from which it stands, and for how long. */
void ff_blend_lock(const ff_blend_space *space, const ff_blend *blend, int foot, double *start,
                   double *length);

/* Into [0, 4). */
double ff_phase_wrap(double phase);

/* Fractions of the cycle of an example, and of the semi-procedural clip, at a phase; and the phases at a fraction. */
double ff_vertex_fraction(const ff_blend_space *space, int32_t vertex, double phase);
double ff_vertex_phase(const ff_blend_space *space, int32_t vertex, double fraction);
double ff_clip_fraction(const ff_blend *clip, double phase);
double ff_clip_phase(const ff_blend *clip, double fraction);

#endif
