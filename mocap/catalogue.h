/* catalogue.h - which clips to import and what people know about them (JSON), or a bare folder or list of files. */
#ifndef FF_CATALOGUE_H
#define FF_CATALOGUE_H

#include "mocap/load.h"

typedef struct ff_catalogue_entry {
    char *path;              /* resolved against the catalogue's folder */
    ff_load_options options; /* unit, fps, up, skeleton, role overrides */
    char *tags;              /* space-separated, "" when none */
    char *mode; /* "walk", "run", "jump", "turn", "crouch", "idle" ... or "" = found from the motion */
    int trim_first, trim_last; /* frames to keep, 0-based inclusive, 0 and -1 = all */
    bool mirror;
    char *licence, *citation; /* "" when not given */
} ff_catalogue_entry;

typedef struct ff_catalogue {
    ff_catalogue_entry *entries; /* sorted by path, so that packs do not depend on the order of folders */
    int count;
    char *skin; /* glTF file of the character to draw; NULL = none */
    ff_load_options skin_options;
    void *memory; /* what the strings live in */
} ff_catalogue;

/* Each input is a catalogue (.json), a folder (every .amc and .bvh below it) or a clip file. */
ff_status ff_catalogue_read(const char *const *inputs, int input_count, ff_catalogue *out, ff_error *error);
void ff_catalogue_free(ff_catalogue *catalogue);

#endif
