/* build.h - the whole of preprocessing: clips in, the content of a pack out. */
#ifndef FF_BUILD_H
#define FF_BUILD_H

#include "mocap/catalogue.h"
#include "preprocess/build/settings.h"
#include "preprocess/pack/pack_write.h"

typedef struct ff_build_settings {
    ff_settings pack; /* all that the pack depends on beside the clips */
    bool strict;      /* a bad clip stops the build instead of being left out */
    bool quiet;       /* no progress on stderr */
    uint32_t threads; /* the result does not depend on it */
    const char
        *cache; /* folder in which results of clips are kept from build to build; NULL = none. The result does
                          not depend on it */
    const char *skin; /* glTF file of the character to draw; NULL = what the catalogue says */
    bool prune;       /* remove from it what this build had no use for */
} ff_build_settings;

typedef struct ff_build_result {
    ff_pack_content content;
    ff_error *skipped; /* why clips were left out, in the order of the clips */
    int skipped_count;
    int reused;        /* results of stages that came from the cache ... */
    int computed;      /* ... and that did not */
    int unkept;        /* that could not be written to it */
    char warning[320]; /* what is not as one would wish, although the pack is whole; "" = nothing */
} ff_build_result;

ff_build_settings ff_build_settings_default(void);

/* Build from the clips of a catalogue, or from the built-in clips when catalogue is NULL. The caller frees *out with
 * ff_build_result_free, also after a failure (the skipped clips may explain it). */
ff_status ff_build(const ff_catalogue *catalogue, const ff_build_settings *settings, ff_build_result *out,
                   ff_error *error);
void ff_build_result_free(ff_build_result *result);

/* footfall-pack build ... and footfall-pack inspect ...; argv after the command's name. Return the exit status. */
int ff_build_command(int argc, char **argv);
int ff_inspect_command(int argc, char **argv);

#endif
