/* each_clip.h - a command that looks at clips one after the other. */
#ifndef FF_EACH_CLIP_H
#define FF_EACH_CLIP_H

#include "mocap/catalogue.h"
#include "preprocess/plants.h"

/* One clip, read, single broken frames put back (breaks: all that was broken), plants found, or written by a person beside
 * the clip. */
typedef struct ff_seen_clip {
    const ff_catalogue_entry *entry;
    ff_clip clip;
    ff_breaks breaks;
    ff_plants plants;
} ff_seen_clip;

typedef ff_status (*ff_clip_visit)(const ff_seen_clip *seen, void *context, ff_error *error);

/* Every clip of the inputs (files, folders, catalogues) is tried; the ones that fail are named on stderr and make the
 * exit status, which is returned, 1. what: for the progress line. */
int ff_each_clip(const char *program, const char *what, const char *const *inputs, int count, bool quiet,
                 ff_clip_visit visit, void *context);

#endif
