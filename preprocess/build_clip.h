/* build_clip.h - one clip on its way into a pack. */
#ifndef FF_BUILD_CLIP_H
#define FF_BUILD_CLIP_H

#include "mocap/catalogue.h"
#include "preprocess/clean.h"
#include "preprocess/cycles.h"
#include "preprocess/steps.h"

/* Catalogue tag of clips that are no model of walking (a ball is dribbled, someone sneaks): their steps become actions,
 * but no gait example. */
#define FF_TAG_NO_EXAMPLE "no-example"

typedef struct ff_build_clip {
    char *source; /* relative to the folder that holds all clips: never an absolute path */
    const char *licence, *citation, *tags, *mode;
    bool mirror;
    int first_frame; /* of the file: frames before it were trimmed */
    uint64_t hash;   /* XXH64 of the file's bytes; of the poses of a built-in clip */
    int subject;     /* clips of one skeleton have the same number */
    bool first_of_subject;

    ff_status status; /* of the stages so far */
    ff_error error;
    ff_clip clip;
    ff_breaks repaired; /* what was broken in the file; what could not be put back is in plants.breaks too */
    ff_plants plants;
    ff_motion motion;
    ff_clean_report cleaned; /* all 0 when it was not asked for */
    ff_actions actions;
    ff_cycles cycles;
} ff_build_clip;

/* Stage 1: read the file (or generate built-in clip index), trim, find plants. */
void ff_build_clip_load(ff_build_clip *clip, const ff_catalogue_entry *entry);
void ff_build_clip_generate(ff_build_clip *clip, int index);
/* Stage 2: onto the rig, feet cleaned up if clean is set, actions and gait cycles. */
void ff_build_clip_cut(ff_build_clip *clip, const ff_rig *rig, bool clean);

void ff_build_clip_free(ff_build_clip *clip);

/* Give clips with the same bone lengths the same subject number, counting from 0. */
void ff_build_find_subjects(ff_build_clip *clips, int count);

#endif
