/* example.h - one seamless gait cycle at constant root rates, as blending wants it (synthesis study, sections 1, 2). */
#ifndef FF_EXAMPLE_H
#define FF_EXAMPLE_H

#include "preprocess/motion/motion.h"
#include "runtime/core/pack/pack_format.h"

typedef struct ff_example {
    ff_pack_example record; /* name, clip and stream are filled in by the pack builder */
    ff_pack_loop loop;
    char name[96];
    int clip;        /* index of the clip it was cut from, -1 = made up */
    int first_frame; /* of that clip's motion */
    double wander; /* rad, largest distance of the real heading from the constant turn: high in transients */
    int frame_count;    /* one cycle: frame frame_count would be frame 0 again */
    ff_vec3 *hips;      /* [frame_count] forward, left of the constant-rate root, height */
    ff_quat *rotations; /* [frame_count][FF_ROLE_JOINT_COUNT] local, joint 0 relative to the root's heading */
    ff_pack_foot *feet; /* [frame_count][2] */
} ff_example;

/* Zeroed frames. The caller frees with ff_example_free. */
ff_status ff_example_alloc(ff_example *example, int frames, ff_error *error);
void ff_example_free(ff_example *example);

/* Points of one frame [FF_BODY_COUNT] in the root's frame: x = left, y = up, z = forward. */
void ff_example_pose(const ff_rig *rig, const ff_example *example, int frame, ff_vec3 *positions);

/* Fill feet from the poses, then lock from where the balls stand still (record.key must be set). Returns the shorter
 * of the two locks, as a share of the cycle. */
double ff_example_find_feet(const ff_rig *rig, ff_example *example);

/* Pose at a phase of the cycle (any number; its fraction counts). */
void ff_example_sample(const ff_example *example, double phase, ff_vec3 *hips, ff_quat *rotations);

/* Turn the head by one constant so that on average it looks ahead, a little down: how captured skeletons hold their
 * heads says how they were calibrated (gait facts), not where people looked. */
void ff_example_level_head(ff_example *example);

/* Take the shaking of markers out: every joint and the hips alike, so that a standing foot, which moves evenly in the
 * root's frame, still stands. */
ff_status ff_example_smooth(ff_example *example, ff_error *error);

/* Left and right exchanged, and re-phased so that the cycle again starts with the left contact. */
ff_status ff_example_mirror(const ff_rig *rig, const ff_example *example, ff_example *out, ff_error *error);

/* The same cycle read backwards: a walk the other way, starting with its own left contact. */
ff_status ff_example_reverse(const ff_rig *rig, const ff_example *example, ff_example *out, ff_error *error);

/* Displacement of a root after time t at constant rates, in its frame at time 0. */
ff_vec2 ff_root_arc(ff_vec2 velocity, double turn_rate, double t);

#endif
