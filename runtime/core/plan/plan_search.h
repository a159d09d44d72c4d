/* plan_search.h - the inside of a search: plan_search.c drives it, plan_search_queue.c keeps what is to be looked at,
 * plan_search_node.c knows what a node stands for, plan_search_plan.c goes from plans to nodes and back.
 *
 * A node is never changed once it is there, so every path in the tree is exact; of nodes that count as one place the
 * cheapest goes on. A node is tested for collisions before its place is taken (at the latest), so an untested one never
 * shuts out one that is free.
 */
#ifndef FF_PLAN_SEARCH_H
#define FF_PLAN_SEARCH_H

#include "runtime/core/plan/plan_guide.h"
#include "runtime/core/plan/plan_sight.h"

#include <time.h>

#define FF_SEARCH_NONE UINT32_MAX
enum { FF_SEARCH_HORIZON_MAX = 20, FF_SEARCH_NODES_MAX = 1 << 20, FF_SEARCH_PLACES = 1 << 14 };

enum {
    FF_NODE_TESTED = 1,
    FF_NODE_SAFE = 2,
    FF_NODE_UNSAFE = 4,
    FF_NODE_CLOSED = 8,
    FF_NODE_HELD = 16,
    FF_NODE_DEAD = 32
};

typedef struct ff_search_node {
    float at[2], other[2]; /* m: ball of the landed foot; anchor of the action that led here */
    float cosine, sine, heading;
    float time, g, h; /* s from the first knot; J/kg */
    uint32_t parent;
    uint16_t action, next; /* the action that led here; its place in the parent's list */
    uint8_t depth, flags;
    uint16_t stop; /* which way of stopping is free, when FF_NODE_SAFE: FF_SET_NO_STOP = it stands already */
} ff_search_node;

/* Cheapest of the nodes at a place that were looked at. */
typedef struct ff_search_place {
    uint64_t key;
    uint32_t node, round;
} ff_search_place;

enum {
    FF_SEARCH_STANCES = 128
}; /* the queue goes back and forth between parents: 16 were made twice as often */

struct ff_plan_scratch {
    uint32_t nodes_max;
    ff_search_node *nodes;
    uint64_t *heap;
    uint32_t *later; /* nodes that are cheaper than one that was expanded in this round */
    ff_search_place *places;
    uint32_t room, search; /* of nodes; number of the search */
    ff_sight sight;
    ff_stance stance[FF_SEARCH_STANCES], step; /* of nodes whose children are tested; on the way of a stop */
};

typedef struct ff_search {
    const ff_action_set *set;
    const ff_plan_goal *goal;
    ff_plan_options options;
    ff_plan_scratch *memory;
    ff_guide guide;
    uint32_t count, heap_count, later_count;
    uint32_t stance_of[FF_SEARCH_STANCES]; /* nodes of memory->stance, or FF_SEARCH_NONE */
    float inflation, latest;               /* latest: s from the first knot that a node may end at */
    float ahead;                           /* s: time of enough, or INFINITY */
    uint32_t best;                         /* the plan so far ends here, or FF_SEARCH_NONE */
    float best_cost;
    uint32_t first_best; /* nodes expanded when there was a plan */
    ff_plan_result result;
    struct timespec begun;
} ff_search;

/* Order of the queue: by f, then larger g, then the older node; all in one number. */
uint64_t ff_search_key(const ff_search *s, uint32_t index);
float ff_search_key_cost(uint64_t key);
static inline uint32_t ff_search_key_node(uint64_t key)
{
    return (uint32_t)(key & (FF_SEARCH_NODES_MAX - 1));
}
void ff_search_push(ff_search *s, uint32_t index);
uint32_t ff_search_pop(ff_search *s);
void ff_search_sift_down(uint64_t *heap, uint32_t count, uint32_t at);

/* Is the node's place taken by one that is as cheap? */
bool ff_search_is_taken(ff_search *s, const ff_search_node *n);
/* Take its place, unless that is. *again: another one of the place was expanded in this round. */
bool ff_search_take_place(ff_search *s, uint32_t index, bool *again);

/* A new node; FF_SEARCH_NONE when there is no room. */
uint32_t ff_search_add(ff_search *s, const ff_search_node *n);
/* The node that the k-th successor of parent's action leads to; the one that waiting does. */
ff_search_node ff_search_child(const ff_search *s, uint32_t parent, uint16_t k);
ff_search_node ff_search_waiting(const ff_search *s, uint32_t parent, float seconds);
void ff_search_root(const ff_search *s, const ff_search_node *n, float root[2]);

/* Where a node's root is, and what there is to know from there. */
typedef struct ff_search_look {
    float root[2];
    ff_guide_look goal;
} ff_search_look;
ff_search_look ff_search_ask(const ff_search *s, const ff_search_node *n);
void ff_search_guess(const ff_search *s, ff_search_node *n, const ff_search_look *look); /* sets h */
bool ff_search_at_goal(const ff_search *s, const ff_search_node *n);

/* Fetches what a test of the node needs of memory that is hardly ever near, while other things are looked at. */
void ff_search_fetch(const ff_search *s, const ff_search_node *n);
/* Is the way from its parent to the node free? Costs of going near others are added. */
bool ff_search_is_free(ff_search *s, ff_search_node *n);
/* Can one always stop from here? Found out once per node. */
bool ff_search_is_safe(ff_search *s, uint32_t index);

/* The joint at the end of the step that is being done. */
ff_search_node ff_search_start(const ff_search *s, const ff_plan_step *step, double end);
/* Seeds the queue with what the current plan says from a step on, as far as it is still free. Its last node becomes the best
 * plan if it is at the goal. */
void ff_search_follow(ff_search *s, const ff_plan *plan, uint32_t step);
/* From the current plan's step, through the nodes, to the stop. */
void ff_search_write(const ff_search *s, const ff_plan *current, uint32_t step, double end, uint32_t last,
                     ff_plan *out);

#endif
