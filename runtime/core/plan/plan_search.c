/* The search of plan.h: anytime repairing A* (Likhachev, Gordon and Thrun 2003; algorithms B.5 and B.6) over actions. */
#define _POSIX_C_SOURCE 199309L
#include "runtime/core/plan/plan_search.h"

#include <string.h>

#define HOLD 0.5f /* s, of waiting at a time */
#define LATE 1.5f /* s past the time horizon in which a stop may be found */

enum { BATCH = 8 }; /* children, of which what the guide says is fetched together */

static bool out_of_budget(const ff_search *s)
{
    if (s->best != FF_SEARCH_NONE && s->result.expanded >= s->first_best + s->options.improve) return true;
    if (s->result.expanded >= s->options.nodes || s->result.expanded >= s->memory->nodes_max) return true;
    if (s->count + s->set->next_most + 4 > s->memory->room) return true;
    if (!(s->options.seconds > 0.0) || (s->result.expanded & 7u)) return false;
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)(now.tv_sec - s->begun.tv_sec) + 1e-9 * (double)(now.tv_nsec - s->begun.tv_nsec) >
           s->options.seconds;
}

/* A child that was thought of: tested now, or when it is looked at. */
static void consider(ff_search *s, ff_search_node *child, const ff_search_look *look)
{
    ++s->result.generated;
    if (child->time > s->latest) return;
    ff_search_guess(s, child, look);
    if (child->g + child->h >= s->best_cost || ff_search_is_taken(s, child)) return;
    if (!s->options.lazy && !ff_search_is_free(s, child)) return;
    uint32_t index = ff_search_add(s, child);
    if (index != FF_SEARCH_NONE) ff_search_push(s, index);
}

/* Children that were thought of together. */
typedef struct batch {
    ff_search_node child[BATCH];
    ff_search_look look[BATCH];
    uint32_t count;
} batch;

static void consider_all(ff_search *s, batch *b)
{
    for (uint32_t i = 0; i < b->count; ++i)
        consider(s, &b->child[i], &b->look[i]);
    b->count = 0;
}

/* The one that was put at the end. */
static void think_of(ff_search *s, batch *b)
{
    b->look[b->count] = ff_search_ask(s, &b->child[b->count]);
    if (++b->count == BATCH) consider_all(s, b);
}

static void expand(ff_search *s, uint32_t index)
{
    batch thought;
    thought.count = 0;
    const ff_search_node *n = &s->memory->nodes[index];
    const ff_set_action *a = &s->set->actions[n->action];
    ++s->result.expanded;
    s->memory->nodes[index].flags |= FF_NODE_CLOSED;
    if (n->depth >= s->options.horizon) return;
    uint32_t next_count = s->options.reactive ? a->next_count : a->step_count;
    for (uint32_t k = 0; k < next_count; ++k) {
        uint16_t next = s->set->next[a->first_next + k].action;
        if (k >= a->step_count && !ff_set_allows(&s->set->actions[next], s->options.reactive)) continue;
        thought.child[thought.count] = ff_search_child(s, index, (uint16_t)k);
        think_of(s, &thought);
    }
    if (a->flags & FF_SET_TO_STANDING) {
        thought.child[thought.count] = ff_search_waiting(s, index, HOLD);
        think_of(s, &thought);
    }
    consider_all(s, &thought);
}

/* A node at the head of the queue, tested and with its place taken. Returns whether it ends the round. */
static bool look_at(ff_search *s, uint32_t index)
{
    ff_search_node *n = &s->memory->nodes[index];
    bool reached = ff_search_at_goal(s, n),
         enough = n->time >= s->ahead || (s->ahead < INFINITY && n->depth >= s->options.horizon);
    if ((reached || enough) && ff_search_is_safe(s, index)) {
        float cost = n->g + (reached ? 0.0f : n->h);
        if (cost < s->best_cost) {
            if (s->best == FF_SEARCH_NONE) s->first_best = s->result.expanded;
            s->best = index;
            s->best_cost = cost;
            s->result.outcome = reached ? FF_PLAN_REACHED : FF_PLAN_AHEAD;
        }
        return true;
    }
    if (n->time > s->ahead + LATE) return false;
    expand(s, index);
    return false;
}

/* Until nothing in the queue can be better than the best plan, or the budget is used up. */
static bool improve(ff_search *s)
{
    ++s->result.rounds;
    while (s->heap_count > 0 && ff_search_key_cost(s->memory->heap[0]) < s->best_cost) {
        if (out_of_budget(s)) return false;
        uint32_t index = ff_search_pop(s);
        ff_search_node *n = &s->memory->nodes[index];
        bool again;
        if (n->flags & FF_NODE_DEAD) continue;
        if (!(n->flags & FF_NODE_TESTED)) {
            ff_search_fetch(s, n);
            /* Of those that would be found free, half lead to a place that has been taken since they were thought of. */
            if (ff_search_is_taken(s, n)) continue;
            float g = n->g;
            if (!ff_search_is_free(s, n)) continue;
            if (n->g > g) { /* dearer than it looked: back into the queue */
                ff_search_push(s, index);
                continue;
            }
        }
        if (!ff_search_take_place(s, index, &again)) continue;
        if (again) {
            s->memory->later[s->later_count++] = index;
            continue;
        }
        look_at(s, index);
    }
    return true;
}

/* Of the nodes that were expanded, the nearest to the goal that one can stop from: what there is of a plan when the search came
 * to no end. Looked for then only, as nearly all searches do. */
static uint32_t find_part(ff_search *s)
{
    uint64_t *heap = s->memory->heap;
    uint32_t count = 0;
    for (uint32_t i = 1; i < s->count; ++i) {
        const ff_search_node *n = &s->memory->nodes[i];
        if (!(n->flags & FF_NODE_CLOSED)) continue;
        uint32_t bits;
        memcpy(&bits, &n->h, sizeof bits);
        heap[count++] = (uint64_t)bits << 32 | i;
    }
    for (uint32_t i = count / 2; i-- > 0;)
        ff_search_sift_down(heap, count, i);
    while (count > 0) {
        uint32_t index = ff_search_key_node(heap[0]);
        if (ff_search_is_safe(s, index)) return index;
        heap[0] = heap[--count];
        if (count > 0) ff_search_sift_down(heap, count, 0);
    }
    return ff_search_is_safe(s, 0) ? 0 : FF_SEARCH_NONE;
}

/* Lower bound of all that is left: what inflation the best plan is within. */
static float proven(const ff_search *s)
{
    float least = INFINITY;
    const ff_search_node *nodes = s->memory->nodes;
    for (uint32_t i = 0; i < s->heap_count; ++i) {
        const ff_search_node *n = &nodes[ff_search_key_node(s->memory->heap[i])];
        least = n->g + n->h < least ? n->g + n->h : least;
    }
    for (uint32_t i = 0; i < s->later_count; ++i) {
        const ff_search_node *n = &nodes[s->memory->later[i]];
        least = n->g + n->h < least ? n->g + n->h : least;
    }
    float bound = s->best_cost / least;
    return least <= 0.0f || bound > s->inflation ? s->inflation : (bound < 1.0f ? 1.0f : bound);
}

/* Rounds of less and less inflation; each goes on with what the one before left open. */
static void search_on(ff_search *s)
{
    for (;;) {
        bool done = improve(s);
        s->result.inflation = s->best == FF_SEARCH_NONE ? INFINITY : (double)proven(s);
        if (!done || !(s->options.inflation_step > 0.0) || s->result.inflation <= 1.0 ||
            s->best == FF_SEARCH_NONE)
            return;
        s->inflation =
            (float)ff_max(1.0, ff_min(s->result.inflation, (double)s->inflation) - s->options.inflation_step);
        uint32_t *later = s->memory->later, kept = 0;
        uint64_t *heap = s->memory->heap;
        for (uint32_t i = 0; i < s->later_count; ++i)
            heap[s->heap_count++] = later[i];
        s->later_count = 0;
        for (uint32_t i = 0; i < s->heap_count; ++i) {
            uint32_t index = ff_search_key_node(heap[i]);
            const ff_search_node *n = &s->memory->nodes[index];
            if (n->g + n->h < s->best_cost) heap[kept++] = ff_search_key(s, index);
        }
        s->heap_count = kept;
        for (uint32_t i = kept / 2; i-- > 0;)
            ff_search_sift_down(heap, kept, i);
        for (uint32_t i = 0; i < s->count; ++i)
            s->memory->nodes[i].flags &= (uint8_t)~FF_NODE_CLOSED;
    }
}

/* Does the plan go on with a jump or a duck? */
static bool is_reactive(const ff_action_set *set, const ff_plan *plan, uint32_t step)
{
    for (uint32_t i = step; i < plan->count; ++i)
        if (!plan->steps[i].hold && (set->actions[plan->steps[i].action].flags & FF_SET_REACTIVE))
            return true;
    return false;
}

ff_plan_result ff_plan_search(const ff_action_set *set, const ff_plan_world *world, const ff_plan *current,
                              double time, const ff_plan_goal *goal, const ff_plan_options *options,
                              ff_plan_scratch *scratch, ff_plan *out)
{
    ff_search s = {.set = set,
                   .goal = goal,
                   .options = *options,
                   .memory = scratch,
                   .best = FF_SEARCH_NONE,
                   .best_cost = INFINITY};
    for (uint32_t i = 0; i < FF_SEARCH_STANCES; ++i)
        s.stance_of[i] = FF_SEARCH_NONE;
    s.result.outcome = FF_PLAN_NONE;
    s.result.inflation = INFINITY;
    if (options->seconds > 0.0) clock_gettime(CLOCK_MONOTONIC, &s.begun);
    if (s.options.horizon > FF_SEARCH_HORIZON_MAX) s.options.horizon = FF_SEARCH_HORIZON_MAX;
    uint32_t step = ff_plan_step_at(current, time);
    const ff_plan_step *doing = &current->steps[step];
    double end = doing->hold ? ff_max(time, doing->start) : ff_plan_step_end(current, step);
    ff_sight_open(set, world, options, doing->anchor, end, &scratch->sight);
    if (is_reactive(set, current, step)) scratch->sight.reactive = 1;
    s.guide = ff_guide_make(set, world->solids, goal, ff_plan_root_at(set, current, end).position,
                            doing->anchor, options->table);
    s.inflation = (float)ff_max(options->inflation, 1.0);
    float start = (float)scratch->sight.lead;
    s.ahead = options->time_horizon > 0.0 ? start + (float)options->time_horizon : INFINITY;
    s.latest = (float)((FF_TRACK_KNOTS_MAX - 2) * FF_TRACK_STEP) - (float)(end - time) - 2.5f;
    if (++scratch->search == 0) scratch->search = 1;
    ff_search_node first = ff_search_start(&s, doing, end);
    const ff_search_look look = ff_search_ask(&s, &first);
    ff_search_guess(&s, &first, &look);
    ff_search_add(&s, &first);
    ff_search_push(&s, 0);
    ff_search_follow(&s, current, step);
    search_on(&s);
    uint32_t last = s.best != FF_SEARCH_NONE ? s.best : find_part(&s);
    if (last == FF_SEARCH_NONE) return s.result;
    const ff_search_node *n = &scratch->nodes[last];
    if (s.best == FF_SEARCH_NONE) s.result.outcome = FF_PLAN_PART;
    s.result.cost = s.best != FF_SEARCH_NONE ? (double)s.best_cost : (double)(n->g + n->h);
    ff_search_write(&s, current, step, end, last, out);
    return s.result;
}

ff_plan_options ff_plan_options_default(void)
{
    return (ff_plan_options){.nodes = 300,
                             .improve = 15,
                             .horizon = 16,
                             .time_horizon = 5.5,
                             .inflation = 3.0,
                             .inflation_step = 0.5,
                             .margin = 0.05,
                             .stand_margin = 0.03,
                             .wait = FF_PLAN_WAIT,
                             .proximity = 0.3,
                             .reactive_cost = (double)FF_PLATFORM_COST,
                             .view = 20.0,
                             .view_count = FF_SIGHT_MAX,
                             .lazy = 1,
                             .safe = 1,
                             .table = 1,
                             .merge = 1};
}

ff_plan_goal ff_plan_goal_at(ff_vec2 at)
{
    return (ff_plan_goal){.at = at, .radius = 0.35, .tolerance = FF_PI, .latest = INFINITY, .stand = 1};
}
