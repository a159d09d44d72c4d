/* inspect_examples.h - footfall-pack inspect --examples. */
#ifndef FF_INSPECT_EXAMPLES_H
#define FF_INSPECT_EXAMPLES_H

#include "runtime/core/pack.h"

/* Print how the examples were closed and when one may pass into another, with the limits and the worst figures. */
void ff_inspect_examples(const ff_pack *pack);

#endif
