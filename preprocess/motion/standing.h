/* standing.h - the stretches in which a person stands: both feet down and at rest, the body hardly moving. */
#ifndef FF_STANDING_H
#define FF_STANDING_H

#include "preprocess/motion/motion.h"

typedef struct ff_stand {
    int first, last; /* frames, inclusive */
} ff_stand;

/* Stretches of at least 0.3 s, in order. Writes at most capacity, returns the number. */
int ff_stands_find(const ff_standing_settings *settings, const ff_motion *motion, const ff_plants *plants,
                   ff_stand *out, int capacity);

/* The plant of foot that covers frame, or -1. */
int ff_plant_at(const ff_plants *plants, int foot, int frame);

/* Height of the hips over what is stood on (over the floor while no foot is down), m, in the motion's measure. */
double ff_hips_height(const ff_motion *motion, const ff_plants *plants, int frame);

#endif
