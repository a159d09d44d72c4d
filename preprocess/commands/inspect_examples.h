/* inspect_examples.h - footfall-pack inspect --examples. */
#ifndef FF_INSPECT_EXAMPLES_H
#define FF_INSPECT_EXAMPLES_H

#include "runtime/core/pack/pack.h"

#include <jansson.h>

/* Print how the examples were closed and when one may pass into another, with the limits and the worst figures. */
void ff_inspect_examples(const ff_pack *pack);

/* Every correspondence as {from, to, by_keys, wait, pairs: [[phase, phase, rms], ...]}; to is -1 for the semi-procedural
 * clip. */
json_t *ff_correspondences_json(const ff_pack *pack);

#endif
