/* successors.h - which action may follow which, and what the joint costs (algorithms A.13; footstep study, sections 1
 * and 4). */
#ifndef FF_SUCCESSORS_H
#define FF_SUCCESSORS_H

#include "preprocess/actions/steps.h"
#include "preprocess/pack/pack_write.h"
#include "runtime/core/base/tasks.h"

/* The two ends of an action. */
typedef struct ff_action_joins {
    ff_join start, end;
} ff_action_joins;

/* Distance of poses (m) up to which an action may follow another one, when there are so many (without mirror images). */
double ff_join_limit(const ff_successor_settings *settings, int actions);

/* May next follow action at all: feet, speeds, turns? */
bool ff_may_follow(const ff_successor_settings *settings, const ff_pack_action *action,
                   const ff_pack_action *next);

/* Distance of the poses where next follows action, m. Stops early and returns more than limit when it is beyond. */
double ff_join_distance(const ff_pack_action *action, const ff_action_joins *joins,
                        const ff_pack_action *next, const ff_action_joins *next_joins, double limit);

/* Fill NEXT and the actions' first_successor and successor_count from content->actions and content->joins. Every action
 * gets at least one successor, and from every walk one comes to stand within two actions, when the pack has actions that
 * end in standing. */
ff_status ff_pack_add_successors(ff_pack_content *content, const ff_successor_settings *settings,
                                 ff_tasks *tasks, ff_error *error);

#endif
