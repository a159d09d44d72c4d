/* steps.h - single-step actions cut from a motion, annotated with Table 1 of Beacco et al. 2013. */
#ifndef FF_STEPS_H
#define FF_STEPS_H

#include "preprocess/motion/motion.h"
#include "runtime/core/pack/pack_format.h"

#define FF_COLLIDER_SAMPLES_MAX 64
#define FF_ACTION_EVENTS_MAX 96

/* Joints about one end of an action, for the distance of poses (algorithms A.12): 5 frames, a 30th of a second apart. */
enum { FF_JOIN_FRAMES = 5 };
typedef struct ff_join {
    float at[FF_JOIN_FRAMES][FF_ROLE_JOINT_COUNT]
            [3]; /* m: forward and left of the standing foot's ball by the root's
                                                         heading, height over that foot's level */
} ff_join;

typedef struct ff_action {
    /* clip, first_collider, first_event and successors are filled in by the pack builder; times from the file's
     * first pose; plants index ff_plants.items */
    ff_pack_action record;
    int first_frame, last_frame; /* of the motion */
    ff_pack_collider colliders[FF_COLLIDER_SAMPLES_MAX][FF_COLLIDER_COUNT];
    ff_pack_event events[FF_ACTION_EVENTS_MAX]; /* times and plants as in record */
    ff_join start, end; /* start from the support foot, end from the foot that has landed */
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
ff_status ff_actions_cut(const ff_cut_settings *settings, const ff_rig *rig, const ff_motion *motion,
                         const ff_plants *plants, int mode_tag, ff_actions *out, ff_error *error);
void ff_actions_free(ff_actions *actions);

/* Tell short from long walking steps by the median step length of all given clips (algorithms A.7). */
ff_status ff_actions_split_walks(ff_actions *const *sets, int count, ff_error *error);

/* The record and colliders of the mirrored action. */
void ff_action_mirror(const ff_action *action, ff_action *out);

#endif
