/* diff.h - two packs compared, part by part. */
#ifndef FF_DIFF_H
#define FF_DIFF_H

#include "runtime/core/pack/pack.h"

#include <stdbool.h>

/* Print what differs from a to b, a heading per part and a line per thing; nothing for parts that are the same. Returns
 * whether anything did. */
bool ff_packs_diff(const ff_pack *a, const ff_pack *b);

#endif
