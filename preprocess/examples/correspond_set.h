/* correspond_set.h - correspondences between all examples of a pack, and of each with the semi-procedural clip. */
#ifndef FF_CORRESPOND_SET_H
#define FF_CORRESPOND_SET_H

#include "preprocess/examples/correspond.h"
#include "preprocess/examples/examples.h"
#include "runtime/core/base/tasks.h"

typedef struct ff_set_pairs {
    int from, to; /* examples; to = -1: the semi-procedural clip at the rates of from */
    ff_cycle_pairs pairs;
} ff_set_pairs;

typedef struct ff_correspondences {
    ff_set_pairs *items; /* by from, then to, the semi-procedural clip last; those without a pair too */
    int count;
} ff_correspondences;

/* gait[i] is the semi-procedural clip at the rates of example i (frame_count 0 = there is none). The result does not
 * depend on the number of threads. The caller frees with ff_correspondences_free. */
ff_status ff_correspond_set(const ff_correspondence_settings *settings, const ff_rig *rig,
                            const ff_example_set *set, const ff_example *gait, ff_tasks *tasks,
                            ff_correspondences *out, ff_error *error);
void ff_correspondences_free(ff_correspondences *correspondences);

#endif
