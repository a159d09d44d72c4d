/* validate.h - a pack checked against what it promises, and against the clips it was made from. */
#ifndef FF_VALIDATE_H
#define FF_VALIDATE_H

#include "mocap/catalogue.h"
#include "runtime/core/pack/pack.h"

/* What is promised of a pack whose feet were cleaned up (issue 3, bars 3 and 5). */
#define FF_VALID_SLIDE                                                                                       \
    0.005 /* m, ball of a flat foot from its mean place: 3 mm of the clean-up, 2 mm of storage */
#define FF_VALID_RISE 0.05        /* m, of the ball over its level where an action begins and ends */
#define FF_VALID_POSE_MEAN 0.0005 /* m, joints and tips against the clip's own frames */
#define FF_VALID_POSE_99 0.002    /* m, 99 of 100 */
#define FF_VALID_FRAMES 1.5       /* frames of the clip, plants and actions elsewhere */

typedef struct ff_valid_own {
    uint32_t plants, sliding;        /* plants with a flat stretch; those that slide further than promised */
    double slide_median, slide_most; /* m */
    uint32_t actions, unplanted;     /* those that do not begin and end on a foot that is down */
    uint32_t loops, open_loops;      /* examples; those that do not close within 1 mm */
    bool cleaned;                    /* feet are promised to stand still at all */
    char first[2][160];              /* where the first sliding plant and the first unplanted action is */
} ff_valid_own;

/* Check the pack against itself. */
ff_status ff_validate_own(const ff_pack *pack, ff_valid_own *out, ff_error *error);
static inline bool ff_valid_own_good(const ff_valid_own *v)
{
    return (v->sliding == 0 || !v->cleaned) && v->unplanted == 0 && v->open_loops == 0;
}

typedef enum ff_valid_state {
    FF_VALID_SAME,
    FF_VALID_DIFFERS,  /* why says in what */
    FF_VALID_CHANGED,  /* the file has other bytes */
    FF_VALID_MISSING,  /* no such clip among those given */
    FF_VALID_UNUSABLE, /* it cannot be read or brought over; why */
    FF_VALID_MADE_UP   /* derived: there is no file */
} ff_valid_state;

typedef struct ff_valid_clip {
    ff_valid_state state;
    char why[256];
    double pose_mean, pose_99; /* m, stored poses against those worked out again */
} ff_valid_clip;

/* Work every clip of the pack out again from its file (or the generator, for built-in ones) and compare. catalogue may be
 * NULL: then only built-in clips are checked. out: [clip_count], the caller's. */
ff_status ff_validate_clips(const ff_pack *pack, const ff_catalogue *catalogue, uint32_t threads, bool quiet,
                            ff_valid_clip *out, ff_error *error);

#endif
