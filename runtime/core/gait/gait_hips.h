/* gait_hips.h - where the hips are, and how far they must come down so that both feet are in reach. */
#ifndef FF_GAIT_HIPS_H
#define FF_GAIT_HIPS_H

#include "runtime/core/gait/gait_sample.h"
#include "runtime/core/gait/leg_pose.h"

/* Cursor of the idle example, if the gait stands or begins to and the pack has one; false otherwise. */
bool ff_gait_idle_cursor(const ff_blend_space *space, const ff_gait *gait, ff_cursor *out);

/* Hips joint in the world, before lowering. */
void ff_gait_hips(const ff_blend_space *space, const ff_gait *gait, const ff_cursor *cursor, ff_vec2 position,
                  double heading, ff_vec3 *hips, ff_quat *rotation);

/* Rotation of a foot on the ground or in the air, and its ankle for the ball's place. */
ff_quat ff_gait_foot_rotation(double yaw, double pitch);
ff_vec3 ff_gait_ankle(const ff_body_frame *body, int foot, ff_foothold ball, ff_quat rotation);

/* How far hip must come down for ankle to be within reach of leg (below 0: there is room). */
double ff_gait_lack(ff_vec3 hip, ff_vec3 ankle, double reach);

/* One step of gait->hips_drop. */
void ff_gait_lower_hips(const ff_blend_space *space, ff_gait *gait, const ff_cursor *cursor, ff_vec2 position,
                        double heading, double dt);

/* Hips and joints of somebody who just stands, idle_time into the idle motion, before the legs are solved to the feet. In
 * gait_pose.c. */
void ff_gait_idle_pose(const ff_blend_space *space, double idle_time, ff_vec2 position, double heading,
                       ff_vec3 *hips, ff_quat *rotations);

#define FF_MOST_RAISE (60.0 * FF_DEG) /* of a heel, for a planted foot to be in reach */

/* Where a foot is to be, turned as it is. In gait_pose.c. */
ff_leg_target ff_gait_leg_target(const ff_gait_foot *state, ff_quat turn);

/* m, of the tip of the toes over its height in rest; the same. */
double ff_gait_toe_clearance(const ff_gait_foot *state);

#endif
