/* breaks.h - where a capture is broken: single wild frames, bursts, jumps and stretches that stand still in mid-motion. */
#ifndef FF_BREAKS_H
#define FF_BREAKS_H

#include "mocap/clip.h"
#include "preprocess/base/stage_settings.h"

typedef enum ff_break_kind {
    FF_BREAK_SPIKE,  /* one frame is off and its neighbours agree with each other */
    FF_BREAK_BURST,  /* several frames are off */
    FF_BREAK_JUMP,   /* before and after do not meet */
    FF_BREAK_FROZEN, /* the same pose again and again while the body is moving */
    FF_BREAK_KIND_COUNT
} ff_break_kind;

typedef struct ff_break {
    int first, last; /* frames of the clip, both broken, inclusive */
    ff_break_kind kind;
    ff_role role; /* of the joint that is furthest off; FF_ROLE_NONE when it froze */
    /* m off where the frames around have it; frozen: m/s at which the body moves before or after */
    double size;
    bool body;     /* trunk or legs are broken: nothing is cut across it. False: only a toe tip or an arm */
    bool repaired; /* put back from the frames around */
} ff_break;

typedef struct ff_breaks {
    ff_break *items; /* by first */
    int count;
} ff_breaks;

/* Find every break of the clip. On failure *out is zeroed. */
ff_status ff_breaks_find(const ff_clip *clip, const ff_break_settings *settings, ff_breaks *out,
                         ff_error *error);

/* The same, and put single frames (spikes, one frame doubled) back from their neighbours, in place. */
ff_status ff_breaks_repair(ff_clip *clip, const ff_break_settings *settings, ff_breaks *out, ff_error *error);
void ff_breaks_free(ff_breaks *breaks);

/* The first break of the body, not repaired, that has a frame in [first, last], or NULL. A jump counts when it lies
 * between two of these frames. */
const ff_break *ff_breaks_within(const ff_breaks *breaks, int first, int last);

/* "frames 102 to 107: left ball jumps by 12 cm" */
void ff_break_say(const ff_break *b, char *text, size_t size);
const char *ff_break_kind_name(ff_break_kind kind);

#endif
