/* build_clip.h - one clip on its way into a pack. */
#ifndef FF_BUILD_CLIP_H
#define FF_BUILD_CLIP_H

#include "mocap/catalogue.h"
#include "preprocess/actions/steps.h"
#include "preprocess/base/cache.h"
#include "preprocess/build/settings.h"
#include "preprocess/clean/clean.h"
#include "preprocess/examples/cycles.h"
#include "preprocess/pack/pose_encode.h"

/* Catalogue tag of clips that are no model of walking (a ball is dribbled, someone sneaks): their steps become actions,
 * but no gait example. */
#define FF_TAG_NO_EXAMPLE "no-example"

typedef struct ff_build_clip {
    char *source;                    /* relative to the folder that holds all clips: never an absolute path */
    const ff_catalogue_entry *entry; /* NULL = a built-in clip */
    int built_in;                    /* index of the generator */
    bool derived;                    /* made from another clip: there is no file of it */
    const char *licence, *citation, *tags, *mode;
    bool mirror;
    int first_frame; /* of the file: frames before it were trimmed */
    int subject;     /* clips of one skeleton have the same number */
    bool first_of_subject;
    uint64_t find_key, cut_key; /* of the cache: what the results of the stages depend on */

    ff_status status; /* of the stages so far */
    ff_error error;

    /* Stage 1 */
    uint64_t hash;      /* XXH64 of the file's bytes; of the poses of a built-in clip */
    int frames;         /* after trimming */
    ff_clip clip;       /* only the last frame: all frames of all clips are never in memory together */
    ff_breaks repaired; /* what was broken in the file; what could not be put back is in plants.breaks too */
    ff_plants plants;
    /* Stage 2 */
    ff_motion motion;        /* after stage 2 without its frames: pose holds them */
    ff_clean_report cleaned; /* all 0 when it was not asked for */
    ff_actions actions;
    ff_cycles cycles;
    ff_pose_coded pose; /* the motion from its first real pose on */
} ff_build_clip;

/* What the stages of every clip share. */
typedef struct ff_build_shared {
    const ff_settings *settings;
    ff_cache *cache;
    const ff_rig *rig; /* stage 2, and what the pack says of it */
    const ff_pack_joint *joints;
    const ff_pack_point *points;
} ff_build_shared;

/* Take what the catalogue says, or the generator of built-in clip index. */
void ff_build_clip_begin(ff_build_clip *clip, const ff_catalogue_entry *entry, int index);
/* Stage 1: read the file (or generate the built-in clip), trim, find plants. */
void ff_build_clip_find(ff_build_clip *clip, const ff_build_shared *shared);
/* All frames of the clip as stage 1 saw them (trimmed, single broken ones put back). The caller frees *out. */
ff_status ff_build_clip_read(const ff_build_clip *clip, const ff_find_settings *settings, ff_clip *out,
                             ff_error *error);
/* Stage 2: onto the rig, feet cleaned up if the settings say so, actions, gait cycles and the motion as the pack stores it. */
void ff_build_clip_cut(ff_build_clip *clip, const ff_build_shared *shared);

/* The last of stage 2: code the motion from its first real pose on and give its frames back, which nothing needs
 * afterwards. */
ff_status ff_build_clip_store(ff_build_clip *clip, const ff_build_shared *shared);

/* Parts of stage 2, which checks of a pack go through again: motion, with its frames; then actions. */
ff_status ff_build_clip_motion(ff_build_clip *clip, const ff_build_shared *shared);
ff_status ff_build_clip_actions(ff_build_clip *clip, const ff_build_shared *shared);

static inline double ff_build_clip_seconds(const ff_build_clip *clip)
{
    return (clip->frames - 1) * clip->clip.frame_time;
}

void ff_build_clip_free(ff_build_clip *clip);

/* The skeleton of a pack for which none is given: median proportions of the people in the clips that could be read. Each
 * counts once, however many clips there are of one; gives them their subject numbers. */
ff_status ff_build_median_rig(ff_build_clip *clips, int count, ff_rig *out, ff_error *error);

/* Give clips with the same bone lengths the same subject number, counting from 0. */
void ff_build_find_subjects(ff_build_clip *clips, int count);

#endif
