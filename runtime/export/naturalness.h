/* naturalness.h - how far a pose is from the nearest one that somebody really had: the mean distance of the legs' joints, feet
 * counted double, over all poses of the pack's clips (not made-up ones) and their mirror images (synthesis study, "NN"). */
#ifndef FF_NATURALNESS_H
#define FF_NATURALNESS_H

#include "runtime/export/figure.h"

#define FF_LEGS 8 /* hip, knee, ankle and ball of either leg */

/* A leg pose: joints in the frame of the root (forward, left, up). */
typedef struct ff_leg_pose_points {
    float at[FF_LEGS][3];
} ff_leg_pose_points;

typedef struct ff_pose_base {
    ff_leg_pose_points *poses;
    uint32_t count;
} ff_pose_base;

/* Every clip of the pack at 30 poses per second, twice. figure is that of the pack. */
ff_status ff_pose_base_create(const ff_pack *pack, const ff_figure *figure, ff_pose_base *out,
                              ff_error *error);
void ff_pose_base_free(ff_pose_base *base);

/* The legs of a body: places of all joints in the world (ff_figure_place), the root's position and heading. */
ff_leg_pose_points ff_legs_of(const ff_vec3 *places, ff_vec2 position, double heading);

/* Distance (m) to the nearest pose. *hint: where the last one was found, begin with 0; it only saves time. */
double ff_pose_base_nearest(const ff_pose_base *base, const ff_leg_pose_points *legs, uint32_t *hint);

#endif
