/* derive_motion.h - short motions that no clip shows: from standing to walking and back, steps aside, back and round,
 * made from a standing pose and a captured walk (footstep study, section 1, "derivable"). */
#ifndef FF_DERIVE_MOTION_H
#define FF_DERIVE_MOTION_H

#include "preprocess/examples/example.h"

/* What the motions are made from. */
typedef struct ff_derive_base {
    const ff_rig *rig;
    const ff_example *stand; /* its first frame is how people stand */
    const ff_example *walk;  /* straight ahead */
    const ff_actions_settings *settings;
} ff_derive_base;

/* Both feet from one stance to another, one after the other; standing before and after. */
typedef struct ff_stance_move {
    double forward, left; /* m, of the whole stance in its own frame */
    double turn;          /* rad, + left */
    int first;            /* foot that goes first */
    double swing;         /* s, of one foot */
} ff_stance_move;

/* When the two feet of a move leave and land, s: [0] the one that goes first. Returns the length of the motion. */
double ff_stance_times(const ff_stance_move *move, double leaves[2], double lands[2]);

/* 60 frames per second. On failure *out is zeroed; the caller frees it with ff_motion_free. */
ff_status ff_derive_stand(const ff_derive_base *base, ff_motion *out, ff_error *error);
ff_status ff_derive_stance_move(const ff_derive_base *base, const ff_stance_move *move, ff_motion *out,
                                ff_error *error);
/* Standing, a step with the left foot, then half a cycle of the walk. */
ff_status ff_derive_start(const ff_derive_base *base, ff_motion *out, ff_error *error);
/* The walk, then a step with the left foot that ends beside the right one, standing; ducking: down meanwhile, and up again. */
ff_status ff_derive_stop(const ff_derive_base *base, bool ducking, ff_motion *out, ff_error *error);

/* When the last step of a stop begins, the left foot leaves and lands, and one stands, s. */
typedef struct ff_stop_times {
    double begin, leaves, lands, end;
} ff_stop_times;
ff_stop_times ff_derive_stop_times(const ff_derive_base *base, bool ducking);

#endif
