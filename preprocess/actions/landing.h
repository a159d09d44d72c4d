/* landing.h - when a foot has landed, in the motion that will be played. */
#ifndef FF_LANDING_H
#define FF_LANDING_H

#include "preprocess/motion/motion.h"

/* The frame in which the whole foot of a plant is down, for full as the clip's signals have it (ff_plant_full). Those are
 * smoothed and allow for sliding; the cleaned motion pins the foot, which there may lie down earlier, or later. full
 * where that motion does not tell (a foot that is never flat), or a person wrote it. */
int ff_landing_in_motion(const ff_rig *rig, const ff_motion *motion, const ff_plant *plant, int full);

#endif
