/* steps.h - single-step actions cut from a motion, annotated with Table 1 of Beacco et al. 2013. */
#ifndef FF_STEPS_H
#define FF_STEPS_H

#include "preprocess/motion.h"
#include "runtime/core/pack_format.h"

#define FF_COLLIDER_SAMPLES_MAX 64

typedef struct ff_action {
    ff_pack_action record; /* clip and first_collider are filled in by the pack builder; times from the file's
                              first pose; plants index ff_plants.items */
    int first_frame, last_frame; /* of the motion */
    ff_pack_collider colliders[FF_COLLIDER_SAMPLES_MAX][FF_COLLIDER_COUNT];
} ff_action;

/* A stretch that was not cut into an action, and why, for the report. */
typedef struct ff_rejection {
    int first_frame, last_frame;
    char reason[96];
} ff_rejection;

typedef struct ff_actions {
    ff_action *items; /* by t_0, none mirrored */
    int count;
    ff_rejection *rejections;
    int rejection_count;
} ff_actions;

/* mode_tag: a whole-clip mode given in the catalogue (FF_MODE_*), or -1 to find it from the motion. */
ff_status ff_actions_cut(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants, int mode_tag,
                         ff_actions *out, ff_error *error);
void ff_actions_free(ff_actions *actions);

/* Tell short from long walking steps by the median step length of all given clips (algorithms A.7). */
ff_status ff_actions_split_walks(ff_actions *const *sets, int count, ff_error *error);

/* The record and colliders of the mirrored action. */
void ff_action_mirror(const ff_action *action, ff_action *out);

#endif
