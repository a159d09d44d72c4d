/* reach.h - what it costs to get anywhere in empty space, by the pack's actions: the tables that guide the search for
 * footsteps (footstep study, section 4.2). */
#ifndef FF_REACH_H
#define FF_REACH_H

#include "preprocess/pack/pack_write.h"

/* Fill REAC, and `reach` of the actions, from ACTN and NEXT: for the actions that a planner takes by default
 * (ff_action_set_create). Nothing when it finds none. */
ff_status ff_pack_add_reach(ff_pack_content *content, ff_error *error);

#endif
