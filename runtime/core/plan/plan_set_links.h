/* plan_set_links.h - what may follow the actions of a set, worked out in this order once they are there. For plan_set.c. */
#ifndef FF_PLAN_SET_LINKS_H
#define FF_PLAN_SET_LINKS_H

#include "runtime/core/plan/plan_set.h"

/* The successors of an action among those of the set, after those of the actions before it. place: of each action of the pack in the
 * set, UINT16_MAX: it is not there. */
void ff_set_find_next(ff_action_set *set, uint32_t index, const uint16_t *place);

/* Of all successors, without arcs (plan_arc.c). */
void ff_set_find_joints(ff_action_set *set);

/* How far successors reach, and the least cost per metre: with arcs. */
void ff_set_measure_next(ff_action_set *set);

/* What reach tables are worth where speeds are varied. */
void ff_set_measure_reach_share(ff_action_set *set);

/* The ways from the end of an action to a stand, after those of the actions before it. */
void ff_set_find_stops(ff_action_set *set, uint32_t index);

#endif
