/* plan_load.h - planning problems to measure the search with: one who starts from standing, others who walk about him. */
#ifndef FF_PLAN_LOAD_H
#define FF_PLAN_LOAD_H

#include "runtime/core/plan/plan.h"

enum { FF_PLAN_LOAD_NODES = 20000 }; /* that searches may expand here */

/* Where people walk about: those in view, with the plans that they follow. Set and scratch are borrowed. */
typedef struct ff_plan_street {
    const ff_action_set *set;
    ff_plan_scratch *scratch;
    ff_plan *plans;
    ff_track *tracks;
    const ff_track **list;
    uint32_t count;
} ff_plan_street;

/* count people within 9 m (or a smaller disc, for few), none within a metre of the middle; each with a plan that is free
 * of those before, and of one who stands in the middle. Destroy also after a failure. */
ff_status ff_plan_street_create(const ff_action_set *set, ff_plan_scratch *scratch, uint32_t count,
                                uint64_t seed, ff_plan_street *out, ff_error *error);
void ff_plan_street_destroy(ff_plan_street *street); /* one that is zeroed is fine */

/* What many searches came to. Shares of plans; times on this thread. */
typedef struct ff_plan_load {
    double expanded_median, expanded_p90; /* nodes a plan */
    double children_per_s, expanded_per_s, tested_per_s;
    double ms_median, ms_p99;
    double ms_worst; /* the highest median of a street */
    double reached, ahead, part, none;
    double ratio_median, ratio_p95; /* cost to the least; 0: not asked for, or nothing reached */
    double progress;                /* m towards the goal, mean, where plans end */
} ff_plan_load;

/* problems searches, evenly over the streets (one or more), from the middle, with random headings, to goals at a distance all around.
 * exact: what each costs at least, or NULL (negative: it cannot be reached). costs: gets what each plan costs (negative: not reached), or
 * NULL. */
ff_status ff_plan_load_measure(const ff_plan_street *streets, uint32_t street_count,
                               const ff_plan_options *options, uint32_t problems, double distance,
                               const double *exact, double *costs, ff_plan_load *out, ff_error *error);

#endif
