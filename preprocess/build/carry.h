/* carry.h - a clip's results to bytes and back, for the cache.
 *
 * One function per result serves both directions, so that writing and reading cannot differ. Structs are carried as
 * they lie in memory, which is right as long as entries are keyed by the code version; what a pointer leads to is
 * carried after its struct. */
#ifndef FF_CARRY_H
#define FF_CARRY_H

#include "preprocess/build/build_clip.h"

/* What stage 1 found: the reduced clip, its plants, status and error. */
bool ff_carry_found_out(const ff_build_clip *clip, ff_array *out);
/* False when data is not what was carried out; the clip is then as it was. */
bool ff_carry_found_in(ff_build_clip *clip, const void *data, size_t size);

/* The same of stage 2: motion, actions, cycles, status and error. */
bool ff_carry_cut_out(const ff_build_clip *clip, ff_array *out);
bool ff_carry_cut_in(ff_build_clip *clip, const void *data, size_t size);

#endif
