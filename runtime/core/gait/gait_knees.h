/* gait_knees.h - knees that take their time. */
#ifndef FF_GAIT_KNEES_H
#define FF_GAIT_KNEES_H

#include "runtime/core/gait/leg_pose.h"

/* What the knee of a leg goes by. */
typedef struct ff_limb {
    ff_vec3 hip,
        landing;  /* landing: from ankle to hip, when the swing ends; looked at from FF_LANDS_WITHIN before */
    ff_quat turn; /* of the foot */
} ff_limb;

#define FF_LANDS_WITHIN 0.12 /* s */

/* Of a swing, s. */
double ff_gait_time_left(const ff_gait_foot *state);

/* One step of what is remembered of knees, of the legs' give, of raised heels; hips_drop and limbs move by what planted knees
 * need so as not to stop or start within a frame. */
void ff_gait_ease_knees(const ff_blend_space *space, ff_gait *gait, ff_limb limbs[2], double dt);

#endif
