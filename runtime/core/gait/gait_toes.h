/* gait_toes.h - toes that take their time. */
#ifndef FF_GAIT_TOES_H
#define FF_GAIT_TOES_H

#include "runtime/core/gait/gait_sample.h"

/* One step of how toes are bent: as in the motion, and as the floor has them; and no faster than people bend theirs, but where the
 * floor is in their way. After ff_gait_ease_knees. */
void ff_gait_bend_toes(const ff_blend_space *space, ff_gait *gait, const ff_cursor *cursor, double dt);

#endif
