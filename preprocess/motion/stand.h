/* stand.h - a retargeted motion put on the floor. */
#ifndef FF_STAND_H
#define FF_STAND_H

#include "preprocess/motion/motion.h"

/* Raise or lower the whole motion so that planted balls are at the rig's rest height, and what then is left of a
 * difference between the feet (captured feet stand up to 3 cm apart in height: skeletons and markers are not that
 * exact) foot by foot, by bending the legs. Toes that would go through the floor are bent up. Without any plant, the
 * lowest that the balls come to (5 %) is taken to be the floor. */
ff_status ff_motion_stand(const ff_rig *rig, ff_motion *motion, const ff_plants *plants, ff_error *error);

#endif
