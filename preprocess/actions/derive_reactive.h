/* derive_reactive.h - what hardly any clip shows out of a stand or a walk: jumps over something low, and ducking under something
 * high (Beacco et al. 2013, future work: reactive actions). Made from a standing pose and a captured walk, on a ballistic path. */
#ifndef FF_DERIVE_REACTIVE_H
#define FF_DERIVE_REACTIVE_H

#include "preprocess/actions/derive_motion.h"

typedef enum ff_reactive_kind {
    FF_REACTIVE_JUMP, /* up and down again, both feet; from standing to standing */
    FF_REACTIVE_OVER, /* the same, forward */
    FF_REACTIVE_LEAP, /* from the right foot far onto the left one, out of a walk and on with it */
    FF_REACTIVE_DUCK, /* down and up again, feet where they are; from standing to standing */
    FF_REACTIVE_DIVE, /* the last step of a walk, down while the left foot comes beside the right one, and up */
} ff_reactive_kind;

enum { FF_REACTIVE_PLANTS = 4 };

/* What is known of a motion that was made up. */
typedef struct ff_reactive_times {
    struct {
        int foot;
        double from, to; /* s, INFINITY: to the end */
    } plant[FF_REACTIVE_PLANTS];
    int plant_count;
    double first, last; /* s, of the action */
    int support;        /* foot on which it begins */
    int mode;           /* FF_MODE_JUMP, FF_MODE_CROUCH */
    uint32_t flags;     /* FF_ACTION_FROM_STANDING, _TO_STANDING, _WHOLE */
} ff_reactive_times;

/* On failure *out is zeroed; the caller frees it with ff_motion_free. */
ff_status ff_derive_reactive(const ff_derive_base *base, ff_reactive_kind kind, ff_motion *out,
                             ff_reactive_times *times, ff_error *error);

#endif
