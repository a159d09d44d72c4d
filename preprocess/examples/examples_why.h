/* examples_why.h - why a set of clips gives nothing to walk with. */
#ifndef FF_EXAMPLES_WHY_H
#define FF_EXAMPLES_WHY_H

#include "preprocess/examples/examples.h"

/* Say what the cycles of all clips are instead of straight walks; returns FF_ERR_NO_DATA. */
ff_status ff_examples_fail(const ff_example_settings *settings, const ff_rig *rig, const ff_cycles *cycles,
                           int clip_count, ff_error *error);

#endif
