/* pack_read.h - skeleton, examples and the semi-procedural clip back out of a pack, for reports and checks. */
#ifndef FF_PACK_READ_H
#define FF_PACK_READ_H

#include "preprocess/examples/gait_fit.h"
#include "runtime/core/pack/pack.h"

void ff_pack_read_rig(const ff_pack *pack, ff_rig *out);

/* Poses, feet, record and loop. The caller frees with ff_example_free. */
ff_status ff_pack_read_example(const ff_pack *pack, uint32_t index, ff_example *out, ff_error *error);

/* The semi-procedural clip at the rates of a walking example; the pack must have one. The caller frees with
 * ff_example_free. */
ff_status ff_pack_play_gait(const ff_pack *pack, const ff_rig *rig, uint32_t example, ff_example *out,
                            ff_error *error);

#endif
