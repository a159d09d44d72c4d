/* synthesis_load.h - many characters, each four motions blended and brought to matrices, by the library's own kernels: what
 * `bench synthesis` measures. */
#ifndef FF_SYNTHESIS_LOAD_H
#define FF_SYNTHESIS_LOAD_H

#include "runtime/core/gait/blend.h"

/* Skeleton: the pack's 21 joints, or with ten more, five fingers to a hand, that are turned by what the pack has for wrists
 * and elbows: 31, as the comparisons of others have. */
#define FF_LOAD_JOINTS 31
#define FF_LOAD_SAMPLES 4

typedef struct ff_synthesis_load ff_synthesis_load;

/* Whole walking examples of the pack at any phases and weights. The pack must outlive the load. */
ff_status ff_synthesis_load_create(const ff_pack *pack, uint32_t joints, uint32_t characters,
                                   ff_synthesis_load **out, ff_error *error);
void ff_synthesis_load_destroy(ff_synthesis_load *load); /* NULL is fine */

/* Let 1/30 s pass and make the matrices of everybody; legs: with both legs brought to footprints. */
void ff_synthesis_load_run(ff_synthesis_load *load, bool simd, bool legs);

/* Sum over all matrices, so that nothing is left out and runs can be compared. */
double ff_synthesis_load_sum(const ff_synthesis_load *load);

#endif
