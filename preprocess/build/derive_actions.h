/* derive_actions.h - the actions that the clips lack and nobody can do without: standing, starting, stopping, turning on
 * the spot, stepping aside and back (footstep study, section 1, "missing"). */
#ifndef FF_DERIVE_ACTIONS_H
#define FF_DERIVE_ACTIONS_H

#include "preprocess/build/build_clip.h"
#include "preprocess/examples/examples.h"

/* What has no captured action among those of clips is derived from the set's standing and a straight walk of it: clips of
 * their own (ff_build_clip with derived set), whose actions are marked FF_ACTION_DERIVED. None when the set has no straight
 * walk. The caller frees each of *out with ff_build_clip_free, then *out. */
ff_status ff_derive_actions(const ff_build_shared *shared, const ff_example_set *set,
                            const ff_build_clip *clips, int count, ff_build_clip **out, int *out_count,
                            ff_error *error);

#endif
