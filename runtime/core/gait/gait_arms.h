/* gait_arms.h - arms that take their time from one way of moving to another: no faster than people's. */
#ifndef FF_GAIT_ARMS_H
#define FF_GAIT_ARMS_H

#include "runtime/core/gait/gait_sample.h"

/* Whether an arm may be turned too quickly just now: what is left of the last change of way turns it, too. */
bool ff_gait_arms_hurry(const ff_blend_space *space, const ff_gait *gait);

/* How the motion itself has the arms (ff_arm_joints). */
void ff_gait_arms(const ff_blend_space *space, const ff_cursor *cursor, ff_quat arms[FF_ARM_JOINTS]);

/* After dt seconds have passed for the motion, which has come from arms to cursor, and for gait->offset: where an arm would be
 * turned too quickly, what is left of the last change of way waits. */
void ff_gait_hold_arms(const ff_blend_space *space, ff_gait *gait, const ff_cursor *cursor,
                       const ff_quat arms[FF_ARM_JOINTS], double dt);

#endif
