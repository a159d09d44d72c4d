/* gait_switch.h - from one way of moving to another: when, at which phase, and how nothing jumps (FbCrowd 5.1, eq 10 and 15;
 * algorithms D.5; synthesis study, section 6).
 *
 * Phase counts the same steps in all ways, so at equal phase the same foot is where it is. Feet that stand go on standing at
 * their locks, those in the air fly on to their planned footprints; what hips, joints and swinging feet differ by is a
 * ff_pose_offset.
 */
#ifndef FF_GAIT_SWITCH_H
#define FF_GAIT_SWITCH_H

#include "runtime/core/gait/gait_sample.h"

/* Where the root is, and how it moves. */
typedef struct ff_gait_root {
    ff_vec2 position;
    double heading;
    ff_rates rates;
} ff_gait_root;

/* One step of a gait as it is, without any switch (gait.c). */
void ff_gait_advance(const ff_blend_space *space, ff_gait *gait, const ff_gait_root *root, double dt);

/* What its pose is made from, in the root's frame. */
void ff_gait_targets(const ff_blend_space *space, const ff_gait *gait, const ff_gait_root *root,
                     ff_pose_targets *out);

/* Switch to gait->wanted if this is the moment. */
void ff_gait_try_switch(const ff_blend_space *space, ff_gait *gait, const ff_gait_root *root);

#endif
