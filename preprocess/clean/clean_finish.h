/* clean_finish.h - what the least squares leave of the error of pinned feet, taken out leg by leg in closed form. */
#ifndef FF_CLEAN_FINISH_H
#define FF_CLEAN_FINISH_H

#include "preprocess/clean/clean_pins.h"

/* Bring heel and ball of pinned feet exactly to their places in every frame of their flat stretches, heels only as far
 * as the legs reach and until they are let go; the correction of the first and last frame fades out over a twelfth of a
 * second around them (cleanup study, section 3.6). Then feet and toes are lifted out of the ground. */
void ff_clean_finish(const ff_rig *rig, ff_motion *motion, const ff_clean_pins *pins);

/* Bend one leg so that its ankle comes to ankle (towards it, when that is out of reach) and its foot is turned as foot,
 * world. The knee bends forward only. */
void ff_clean_reach(const ff_rig *rig, ff_clean_pose *pose, int side, ff_vec3 ankle, ff_quat foot);

#endif
