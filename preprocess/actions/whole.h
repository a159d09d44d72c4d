/* whole.h - stretches of a motion that are played complete: turns on the spot, jumps, ducks (Beacco et al. 2013,
 * section 4). */
#ifndef FF_WHOLE_H
#define FF_WHOLE_H

#include "preprocess/motion/standing.h"

/* A moment at which a foot has come down whole. */
typedef struct ff_landing {
    int frame, plant;
} ff_landing;

typedef struct ff_whole {
    int first, last; /* frames */
    int mode;        /* FF_MODE_TURN, _JUMP or _CROUCH */
    bool standing;   /* the person stands at both ends */
} ff_whole;

/* Is this stretch without a foot on the ground a jump and no flight of a run? Long ones are, and those that both feet
 * begin or end as one. */
bool ff_flight_is_jump(const ff_whole_settings *set, const ff_motion *motion, const ff_plants *plants,
                       int from, int to);

/* In order of first; from the stands and the landings of the motion. Writes at most capacity, returns the number. */
int ff_wholes_find(const ff_cut_settings *set, const ff_rig *rig, const ff_motion *motion,
                   const ff_plants *plants, const ff_stand *stands, int stand_count,
                   const ff_landing *landings, int landing_count, ff_whole *out, int capacity);

#endif
