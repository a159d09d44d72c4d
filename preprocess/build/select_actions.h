/* select_actions.h - a good small set of actions (footstep study, section 1, "subsets"). */
#ifndef FF_SELECT_ACTIONS_H
#define FF_SELECT_ACTIONS_H

#include "preprocess/build/build_clip.h"
#include "runtime/core/base/tasks.h"

/* Keep wanted actions of all the clips' (mirror images come on top) and drop the rest from their lists: standing, starts,
 * stops, turns and steps from standing first; then those that cover (mode, landing, turn, duration) best, from the most
 * ordinary one outwards; then those that give the most partners to go on with. Steps that are not captured cleanly or have
 * hardly any partner do not count. */
ff_status ff_actions_select(const ff_successor_settings *settings, ff_build_clip *clips, int count,
                            int wanted, ff_tasks *tasks, ff_error *error);

#endif
