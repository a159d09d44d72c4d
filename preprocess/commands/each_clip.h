/* each_clip.h - a command that looks at clips one after the other. */
#ifndef FF_EACH_CLIP_H
#define FF_EACH_CLIP_H

#include "mocap/catalogue.h"
#include "preprocess/plants/plants.h"
#include "runtime/tool/command_line.h"

/* What the command was told: its options point here. */
typedef struct ff_clip_run {
    const char *program, *what; /* what: for the progress line */
    const char *config;         /* settings, or NULL for the defaults */
    bool quiet;
} ff_clip_run;

/* Options for both, to stand among the command's own. */
#define FF_CONFIG_OPTION(run)                                                                                \
    {                                                                                                        \
        .name = "--config", .value_name = "FILE",                                                            \
        .help = "settings as JSON; 'footfall-pack config' prints them all", .text = &(run).config            \
    }
#define FF_QUIET_OPTION(run)                                                                                 \
    {                                                                                                        \
        .name = "--quiet", .alias = "-q", .help = "no progress on stderr", .flag = &(run).quiet              \
    }

#define FF_THREADS_OPTION(threads)                                                                           \
    {                                                                                                        \
        .name = "--threads", .value_name = "N", .help = "threads to use; the result does not depend on it",  \
        .integer = &(threads), .low = 1, .high = 256                                                         \
    }

/* Every entry of the inputs (files, folders, catalogues) is visited; the ones that fail are named on stderr and make the
 * exit status, which is returned, 1. */
typedef ff_status (*ff_entry_visit)(const ff_catalogue_entry *entry, void *context, ff_error *error);
int ff_each_entry(const ff_clip_run *run, const ff_operands *inputs, ff_entry_visit visit, void *context);

/* One clip, read, single broken frames put back (breaks: all that was broken), plants found, or written by a person beside
 * the clip. */
typedef struct ff_seen_clip {
    const ff_catalogue_entry *entry;
    ff_clip clip;
    ff_breaks breaks;
    ff_plants plants;
} ff_seen_clip;

typedef ff_status (*ff_clip_visit)(const ff_seen_clip *seen, void *context, ff_error *error);
int ff_each_clip(const ff_clip_run *run, const ff_operands *inputs, ff_clip_visit visit, void *context);

#endif
