/* The search of plan.h: anytime repairing A* (Likhachev, Gordon and Thrun 2003; algorithms B.5 and B.6) over actions.
 *
 * A node is never changed once it is there, so every path in the tree is exact; of nodes that count as one place the
 * cheapest goes on. A node is tested for collisions before its place is taken (at the latest), so an untested one never
 * shuts out one that is free.
 */
#define _POSIX_C_SOURCE 199309L
#include "runtime/core/plan_guide.h"
#include "runtime/core/plan_sight.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#define PLACE 0.2f         /* m: footstep study, section 2, "lattice" */
#define PLACE_TURN 0.5236f /* rad */
#define PLACE_TIME 0.5f    /* s */
#define HOLD 0.5f          /* s, of waiting at a time */
#define LATE 1.5f          /* s past the time horizon in which a stop may be found */
#define NONE UINT32_MAX
enum { HORIZON_MAX = 20, NODES_MAX = 1 << 20, PLACES = 1 << 14 };

enum { TESTED = 1, SAFE = 2, UNSAFE = 4, CLOSED = 8, HELD = 16, DEAD = 32 };

typedef struct node {
    float at[2], other[2]; /* m: ball of the landed foot; anchor of the action that led here */
    float cosine, sine, heading;
    float time, g, h; /* s from the first knot; J/kg */
    uint32_t parent;
    uint16_t action, next; /* the action that led here; its place in the parent's list */
    uint8_t depth, flags;
    uint16_t stop; /* which way of stopping is free, when SAFE: FF_SET_NO_STOP = it stands already */
} node;

/* Cheapest of the nodes at a place that were looked at. */
typedef struct taken {
    uint64_t key;
    uint32_t node, round;
} taken;

struct ff_plan_scratch {
    uint32_t nodes_max;
    node *nodes;
    uint64_t *heap;
    uint32_t *later; /* nodes that are cheaper than one that was expanded in this round */
    taken *places;
    uint32_t room, search; /* of nodes; number of the search */
    ff_sight sight;
    ff_stance stance, step; /* of the node that is expanded; on the way of a stop */
};

typedef struct search {
    const ff_action_set *set;
    const ff_plan_goal *goal;
    ff_plan_options options;
    ff_plan_scratch *memory;
    ff_guide guide;
    uint32_t count, heap_count, later_count;
    uint32_t open_stance;    /* node of memory->stance, or NONE */
    float inflation, latest; /* latest: s from the first knot that a node may end at */
    float ahead;             /* s: time of enough, or INFINITY */
    uint32_t best, part;     /* the plan so far ends here; else the nearest to the goal, safe */
    float best_cost;
    uint32_t first_best; /* nodes expanded when there was a plan */
    ff_plan_result result;
    struct timespec begun;
} search;

/* -------------------------------------------------------------------------------------------------------- memory */

ff_status ff_plan_scratch_create(const ff_action_set *set, uint32_t nodes_max, ff_plan_scratch **out,
                                 ff_error *error)
{
    *out = NULL;
    ff_plan_scratch *m = ff_calloc(1, sizeof *m);
    if (m) {
        uint64_t room = (uint64_t)(nodes_max + 32) * (set->next_most + 1);
        m->nodes_max = nodes_max;
        m->room = room < NODES_MAX ? (uint32_t)room : NODES_MAX;
        m->nodes = ff_calloc(m->room, sizeof *m->nodes);
        m->heap = ff_calloc(m->room, sizeof *m->heap);
        m->later = ff_calloc(m->room, sizeof *m->later);
        m->places = ff_calloc(PLACES, sizeof *m->places);
    }
    if (!m || !m->nodes || !m->heap || !m->later || !m->places) {
        ff_plan_scratch_destroy(m);
        return ff_fail(error, FF_ERR_NO_MEMORY, "a search of %u nodes", nodes_max);
    }
    *out = m;
    return FF_OK;
}

void ff_plan_scratch_destroy(ff_plan_scratch *scratch)
{
    if (!scratch) return;
    free(scratch->nodes);
    free(scratch->heap);
    free(scratch->later);
    free(scratch->places);
    free(scratch);
}

/* ---------------------------------------------------------------------------------------------------------- heap */

/* By f, then larger g, then the older one; all in one number. f and g are not negative. */
static uint64_t key_of(const search *s, uint32_t index)
{
    const node *n = &s->memory->nodes[index];
    float f = n->g + s->inflation * n->h;
    uint32_t bits, g = (uint32_t)(n->g * 16.0f);
    memcpy(&bits, &f, sizeof bits);
    return (uint64_t)bits << 32 | (uint64_t)(4095u - (g < 4095u ? g : 4095u)) << 20 | index;
}

static float key_cost(uint64_t key)
{
    uint32_t bits = (uint32_t)(key >> 32);
    float f;
    memcpy(&f, &bits, sizeof f);
    return f;
}

static void sift_up(uint64_t *heap, uint32_t at)
{
    uint64_t key = heap[at];
    for (; at > 0 && key < heap[(at - 1) / 2]; at = (at - 1) / 2)
        heap[at] = heap[(at - 1) / 2];
    heap[at] = key;
}

static void sift_down(uint64_t *heap, uint32_t count, uint32_t at)
{
    uint64_t key = heap[at];
    for (uint32_t child; (child = 2 * at + 1) < count; at = child) {
        if (child + 1 < count && heap[child + 1] < heap[child]) ++child;
        if (key <= heap[child]) break;
        heap[at] = heap[child];
    }
    heap[at] = key;
}

static void push(search *s, uint32_t index)
{
    s->memory->heap[s->heap_count] = key_of(s, index);
    sift_up(s->memory->heap, s->heap_count++);
}

static uint32_t pop(search *s)
{
    uint64_t *heap = s->memory->heap, top = heap[0];
    heap[0] = heap[--s->heap_count];
    if (s->heap_count > 0) sift_down(heap, s->heap_count, 0);
    return (uint32_t)(top & 0xfffff);
}

/* ------------------------------------------------------------------------------------------------------- places */

static uint64_t place_key(const search *s, const node *n)
{
    uint64_t key = (uint64_t)(uint32_t)(int32_t)floorf(n->at[0] / PLACE + 0.5f) & 0xffffu;
    key = key << 16 | ((uint64_t)(uint32_t)(int32_t)floorf(n->at[1] / PLACE + 0.5f) & 0xffffu);
    int32_t turn = (int32_t)floorf(n->heading / PLACE_TURN + 0.5f) % 12;
    key = key << 4 | (uint64_t)(turn < 0 ? turn + 12 : turn);
    const ff_set_action *a = &s->set->actions[n->action];
    key = key << 4 | (uint64_t)(a->support | (uint32_t)a->kind << 1);
    bool moving = s->memory->sight.count > 0 || s->memory->sight.mover_count > 0;
    return key << 8 | (moving ? (uint64_t)(n->time / PLACE_TIME) & 0xffu : 0u);
}

/* The entry of a place: its own, or a free one. NULL when the table is full. */
static taken *find_place(search *s, uint64_t key)
{
    ff_plan_scratch *m = s->memory;
    uint64_t at = (key * 0x9e3779b97f4a7c15u) >> 50;
    for (uint32_t i = 0; i < 64; ++i, ++at) {
        taken *t = &m->places[at & (PLACES - 1)];
        if (t->round != m->search || t->key == key) return t;
    }
    return NULL;
}

/* Is the node's place taken by one that is as cheap? */
static bool is_taken(search *s, const node *n)
{
    if (!s->options.merge) return false;
    taken *t = find_place(s, place_key(s, n));
    return t && t->round == s->memory->search && s->memory->nodes[t->node].g <= n->g;
}

/* Take its place. *again: another one of the place was expanded in this round. */
static bool take_place(search *s, uint32_t index, bool *again)
{
    *again = false;
    if (!s->options.merge) return true;
    node *n = &s->memory->nodes[index];
    uint64_t key = place_key(s, n);
    taken *t = find_place(s, key);
    if (!t) return true;
    if (t->round == s->memory->search) {
        node *old = &s->memory->nodes[t->node];
        if (old->g <= n->g) return false;
        *again = (old->flags & CLOSED) != 0;
    }
    *t = (taken){key, index, s->memory->search};
    return true;
}

/* ------------------------------------------------------------------------------------------------------ geometry */

static void root_of(const search *s, const node *n, float root[2])
{
    const ff_set_action *a = &s->set->actions[n->action];
    /* The heading at the start of the action: cosine and sine turned back by its theta. */
    float c = n->cosine * a->cosine + n->sine * a->sine, d = n->sine * a->cosine - n->cosine * a->sine;
    root[0] = n->other[0] + c * a->root_end[0] - d * a->root_end[1];
    root[1] = n->other[1] + d * a->root_end[0] + c * a->root_end[1];
}

static void set_guess(search *s, node *n)
{
    float root[2];
    root_of(s, n, root);
    n->h = ff_guide_cost(&s->guide, root, n->cosine, n->sine, &s->set->actions[n->action]);
}

/* The node that a successor leads to. */
static node child_of(const search *s, uint32_t parent, uint16_t k)
{
    const node *p = &s->memory->nodes[parent];
    const ff_set_next *next = &s->set->next[s->set->actions[p->action].first_next + k];
    const ff_set_action *b = &s->set->actions[next->action];
    const float *anchor = next->other ? p->other : p->at;
    return (node){.at = {anchor[0] + p->cosine * b->land[0] - p->sine * b->land[1],
                         anchor[1] + p->sine * b->land[0] + p->cosine * b->land[1]},
                  .other = {anchor[0], anchor[1]},
                  .cosine = p->cosine * b->cosine - p->sine * b->sine,
                  .sine = p->sine * b->cosine + p->cosine * b->sine,
                  .heading = p->heading + b->theta,
                  .time = p->time + b->duration,
                  .g = p->g + next->cost,
                  .parent = parent,
                  .action = next->action,
                  .next = k,
                  .depth = (uint8_t)(p->depth + 1)};
}

static node waiting_child(const search *s, uint32_t parent, float seconds)
{
    node n = s->memory->nodes[parent];
    n.time += seconds;
    n.g += (float)(s->options.wait * FF_E_S) * seconds;
    n.parent = parent;
    n.next = FF_SET_NO_STOP;
    ++n.depth;
    n.flags = HELD;
    return n;
}

/* Fill in a stance for a node. */
static void stand_at(const search *s, const node *n, ff_stance *out)
{
    const ff_set_action *a = &s->set->actions[n->action];
    memcpy(out->at, n->at, sizeof out->at);
    memcpy(out->other, n->other, sizeof out->other);
    out->cosine = n->cosine;
    out->sine = n->sine;
    out->time = n->time;
    out->action = n->action;
    out->hold = (n->flags & HELD) != 0;
    ff_stance_begin(&s->memory->sight, n->cosine * a->cosine + n->sine * a->sine,
                    n->sine * a->cosine - n->cosine * a->sine, out);
}

static ff_stance *stance_of(search *s, uint32_t index)
{
    if (s->open_stance != index) {
        stand_at(s, &s->memory->nodes[index], &s->memory->stance);
        s->open_stance = index;
    }
    return &s->memory->stance;
}

static uint32_t add_node(search *s, const node *n)
{
    if (s->count == s->memory->room) return NONE;
    s->memory->nodes[s->count] = *n;
    return s->count++;
}

/* ------------------------------------------------------------------------------------------------------- testing */

/* Is the way from its parent to the node free? Costs of going near others are added. */
static bool is_free(search *s, node *n)
{
    if (n->flags & TESTED) return true;
    ff_stance *stance = stance_of(s, n->parent);
    ++s->result.tested;
    bool free_way;
    float more = 0.0f;
    if (n->flags & HELD)
        free_way = ff_stance_waits(&s->memory->sight, stance, n->time - s->memory->nodes[n->parent].time);
    else {
        const ff_set_action *a = &s->set->actions[s->memory->nodes[n->parent].action];
        free_way = ff_stance_free(&s->memory->sight, stance, &s->set->next[a->first_next + n->next], &more);
    }
    n->flags |= free_way ? TESTED : DEAD;
    n->g += more;
    return free_way;
}

/* Does one come to stand from the node, by its k-th way of stopping, and may stand there for ever? */
static bool stops_by(search *s, const node *from, uint32_t k)
{
    const ff_set_action *a = &s->set->actions[from->action];
    const ff_set_stop *stop = &s->set->stops[a->first_stop + k];
    ff_plan_scratch *m = s->memory;
    uint32_t mark = s->count;
    node here = *from;
    for (int i = 0; i < 2 && stop->next[i] != FF_SET_NO_STOP; ++i) {
        uint32_t at = add_node(s, &here);
        if (at == NONE) {
            s->count = mark;
            return false;
        }
        stand_at(s, &here, &m->step);
        const ff_set_next *next = &s->set->next[s->set->actions[here.action].first_next + stop->next[i]];
        if (!ff_stance_free(&m->sight, &m->step, next, NULL)) {
            s->count = mark;
            return false;
        }
        here = child_of(s, at, stop->next[i]);
    }
    s->count = mark;
    stand_at(s, &here, &m->step);
    return ff_stance_waits(&m->sight, &m->step, INFINITY);
}

/* Can one always stop from here? Found out once per node. */
static bool is_safe(search *s, uint32_t index)
{
    node *n = &s->memory->nodes[index];
    if (!s->options.safe) return true;
    if (n->flags & (SAFE | UNSAFE)) return (n->flags & SAFE) != 0;
    const ff_set_action *a = &s->set->actions[n->action];
    bool safe = false;
    n->stop = FF_SET_NO_STOP;
    if (a->flags & FF_SET_TO_STANDING) {
        stand_at(s, n, &s->memory->step);
        safe = ff_stance_waits(&s->memory->sight, &s->memory->step, INFINITY);
    }
    for (uint32_t k = 0; k < a->stop_count && !safe; ++k) {
        safe = stops_by(s, n, k);
        if (safe) n->stop = (uint16_t)k;
    }
    n->flags |= safe ? SAFE : UNSAFE;
    return safe;
}

/* ----------------------------------------------------------------------------------------------------- the search */

static bool at_goal(const search *s, const node *n)
{
    float root[2];
    root_of(s, n, root);
    if (!ff_guide_reached(&s->guide, root)) return false;
    if (s->goal->stand && !(s->set->actions[n->action].flags & FF_SET_TO_STANDING)) return false;
    if ((double)n->time > s->goal->latest - (double)s->memory->sight.first_knot * FF_TRACK_STEP) return false;
    return s->goal->tolerance >= FF_PI ||
           fabs(ff_wrap((double)n->heading - s->goal->heading)) <= s->goal->tolerance;
}

static bool out_of_budget(const search *s)
{
    if (s->best != NONE && s->result.expanded >= s->first_best + s->options.improve) return true;
    if (s->result.expanded >= s->options.nodes || s->result.expanded >= s->memory->nodes_max) return true;
    if (s->count + s->set->next_most + 4 > s->memory->room) return true;
    if (!(s->options.seconds > 0.0) || (s->result.expanded & 7u)) return false;
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)(now.tv_sec - s->begun.tv_sec) + 1e-9 * (double)(now.tv_nsec - s->begun.tv_nsec) >
           s->options.seconds;
}

/* A child that was thought of: tested now, or when it is looked at. */
static void consider(search *s, node *child)
{
    ++s->result.generated;
    if (child->time > s->latest) return;
    set_guess(s, child);
    if (child->g + child->h >= s->best_cost || is_taken(s, child)) return;
    if (!s->options.lazy && !is_free(s, child)) return;
    uint32_t index = add_node(s, child);
    if (index != NONE) push(s, index);
}

static void expand(search *s, uint32_t index)
{
    const node *n = &s->memory->nodes[index];
    const ff_set_action *a = &s->set->actions[n->action];
    ++s->result.expanded;
    s->memory->nodes[index].flags |= CLOSED;
    if (n->depth >= s->options.horizon) return;
    for (uint32_t k = 0; k < a->step_count; ++k) {
        node child = child_of(s, index, (uint16_t)k);
        consider(s, &child);
    }
    if (a->flags & FF_SET_TO_STANDING) {
        node child = waiting_child(s, index, HOLD);
        consider(s, &child);
    }
}

/* A node at the head of the queue, tested and with its place taken. Returns whether it ends the round. */
static bool look_at(search *s, uint32_t index)
{
    node *n = &s->memory->nodes[index];
    bool reached = at_goal(s, n),
         enough = n->time >= s->ahead || (s->ahead < INFINITY && n->depth >= s->options.horizon);
    if ((reached || enough) && is_safe(s, index)) {
        float cost = n->g + (reached ? 0.0f : n->h);
        if (cost < s->best_cost) {
            if (s->best == NONE) s->first_best = s->result.expanded;
            s->best = index;
            s->best_cost = cost;
            s->result.outcome = reached ? FF_PLAN_REACHED : FF_PLAN_AHEAD;
        }
        return true;
    }
    if (n->time > s->ahead + LATE) return false;
    /* The nearest to the goal so far that one can stop from. */
    const node *part = s->part == NONE ? NULL : &s->memory->nodes[s->part];
    if (s->best == NONE && n->depth > 0 && (!part || n->h < part->h) && is_safe(s, index)) s->part = index;
    expand(s, index);
    return false;
}

/* Until nothing in the queue can be better than the best plan, or the budget is used up. */
static bool improve(search *s)
{
    ++s->result.rounds;
    while (s->heap_count > 0 && key_cost(s->memory->heap[0]) < s->best_cost) {
        if (out_of_budget(s)) return false;
        uint32_t index = pop(s);
        node *n = &s->memory->nodes[index];
        bool again;
        if (n->flags & DEAD) continue;
        if (!(n->flags & TESTED)) {
            float g = n->g;
            if (!is_free(s, n)) continue;
            if (n->g > g) { /* dearer than it looked: back into the queue */
                push(s, index);
                continue;
            }
        }
        if (!take_place(s, index, &again)) continue;
        if (again) {
            s->memory->later[s->later_count++] = index;
            continue;
        }
        look_at(s, index);
    }
    return true;
}

/* Lower bound of all that is left: what inflation the best plan is within. */
static float proven(const search *s)
{
    float least = INFINITY;
    const node *nodes = s->memory->nodes;
    for (uint32_t i = 0; i < s->heap_count; ++i) {
        const node *n = &nodes[s->memory->heap[i] & 0xfffff];
        least = n->g + n->h < least ? n->g + n->h : least;
    }
    for (uint32_t i = 0; i < s->later_count; ++i) {
        const node *n = &nodes[s->memory->later[i]];
        least = n->g + n->h < least ? n->g + n->h : least;
    }
    float bound = s->best_cost / least;
    return least <= 0.0f || bound > s->inflation ? s->inflation : (bound < 1.0f ? 1.0f : bound);
}

/* Rounds of less and less inflation; each goes on with what the one before left open. */
static void search_on(search *s)
{
    for (;;) {
        bool done = improve(s);
        s->result.inflation = s->best == NONE ? INFINITY : (double)proven(s);
        if (!done || !(s->options.inflation_step > 0.0) || s->result.inflation <= 1.0 || s->best == NONE)
            return;
        s->inflation =
            (float)ff_max(1.0, ff_min(s->result.inflation, (double)s->inflation) - s->options.inflation_step);
        uint32_t *later = s->memory->later, kept = 0;
        uint64_t *heap = s->memory->heap;
        for (uint32_t i = 0; i < s->later_count; ++i)
            heap[s->heap_count++] = later[i];
        s->later_count = 0;
        for (uint32_t i = 0; i < s->heap_count; ++i) {
            uint32_t index = (uint32_t)(heap[i] & 0xfffff);
            const node *n = &s->memory->nodes[index];
            if (n->g + n->h < s->best_cost) heap[kept++] = key_of(s, index);
        }
        s->heap_count = kept;
        for (uint32_t i = kept / 2; i-- > 0;)
            sift_down(heap, kept, i);
        for (uint32_t i = 0; i < s->count; ++i)
            s->memory->nodes[i].flags &= (uint8_t)~CLOSED;
    }
}

/* ------------------------------------------------------------------------------------------------- plans and nodes */

/* The start: the joint at the end of the step that is being done. */
static node start_node(const search *s, const ff_plan_step *step, double end)
{
    const ff_set_action *a = &s->set->actions[step->action];
    ff_vec2 axis = ff_fwd2(step->heading), turned = ff_fwd2(step->heading + (double)a->theta);
    ff_vec2 other = ff_sub2(step->anchor, s->memory->sight.origin);
    ff_vec2 at = ff_add2(other, ff_from_frame2(axis, ff_v2((double)a->land[0], (double)a->land[1])));
    node n = {.at = {(float)at.a, (float)at.b},
              .other = {(float)other.a, (float)other.b},
              .cosine = (float)turned.a,
              .sine = (float)turned.b,
              .heading = (float)(step->heading + (double)a->theta),
              .time = (float)(end - (double)s->memory->sight.first_knot * FF_TRACK_STEP),
              .parent = NONE,
              .action = (uint16_t)step->action,
              .flags = (uint8_t)(TESTED | (step->hold ? HELD : 0))};
    return n;
}

/* Seeds the queue with what the current plan says from here on, as far as it is still free. Its last node becomes the best
 * plan if it is at the goal. */
static void follow(search *s, const ff_plan *plan, uint32_t step)
{
    uint32_t at = 0;
    bool again;
    for (uint32_t i = step + 1; i < plan->stop && at != NONE; ++i) {
        const ff_set_action *a = &s->set->actions[s->memory->nodes[at].action];
        node child;
        uint16_t k = 0;
        if (plan->steps[i].hold)
            child = waiting_child(s, at, (float)(ff_plan_step_end(plan, i) - plan->steps[i].start));
        else {
            while (k < a->next_count && s->set->next[a->first_next + k].action != plan->steps[i].action)
                ++k;
            if (k == a->next_count) return;
            child = child_of(s, at, k);
        }
        if (child.depth > s->options.horizon || child.time > s->latest || !is_free(s, &child)) return;
        set_guess(s, &child);
        at = add_node(s, &child);
        if (at == NONE) return;
        push(s, at);
        if (at_goal(s, &child) && is_safe(s, at) && take_place(s, at, &again)) {
            s->best = at;
            s->best_cost = s->memory->nodes[at].g;
            s->result.outcome = FF_PLAN_REACHED;
        }
    }
}

/* Appends a step after the last one. */
static void append(const ff_action_set *set, ff_plan *plan, uint16_t action, bool other, bool hold,
                   double seconds, double *end)
{
    const ff_plan_step *last = &plan->steps[plan->count - 1];
    const ff_set_action *a = &set->actions[last->action];
    ff_plan_step step = *last;
    step.start = *end;
    step.hold = hold;
    if (!hold) {
        if (!other)
            step.anchor =
                ff_add2(last->anchor, ff_from_frame2(ff_fwd2(last->heading),
                                                     ff_v2((double)a->land[0], (double)a->land[1])));
        step.heading = last->heading + (double)a->theta;
        step.action = action;
        seconds = (double)set->actions[action].duration;
    }
    *end += seconds;
    plan->steps[plan->count++] = step;
}

static void append_node(const search *s, const node *n, ff_plan *plan, double *end)
{
    const node *parent = &s->memory->nodes[n->parent];
    bool other =
        !(n->flags & HELD) && s->set->next[s->set->actions[parent->action].first_next + n->next].other;
    append(s->set, plan, n->action, other, (n->flags & HELD) != 0, (double)(n->time - parent->time), end);
}

static void append_stop(const search *s, const node *n, ff_plan *plan, double *end)
{
    plan->stop = plan->count;
    const ff_set_action *a = &s->set->actions[n->action];
    if (n->stop != FF_SET_NO_STOP) {
        const ff_set_stop *stop = &s->set->stops[a->first_stop + n->stop];
        for (int i = 0; i < 2 && stop->next[i] != FF_SET_NO_STOP; ++i) {
            const ff_set_next *next = &s->set->next[a->first_next + stop->next[i]];
            append(s->set, plan, next->action, next->other, false, 0.0, end);
            a = &s->set->actions[next->action];
        }
    }
    append(s->set, plan, 0, false, true, 0.0, end);
}

/* From the current plan's step, through the nodes, to the stop. */
static void write_plan(const search *s, const ff_plan *current, uint32_t step, double end, uint32_t last,
                       ff_plan *out)
{
    uint32_t path[HORIZON_MAX + 2], n = 0;
    for (uint32_t i = last; i != 0; i = s->memory->nodes[i].parent)
        path[n++] = i;
    ff_plan plan = {.from = step > 0 ? current->steps[step - 1] : current->from};
    plan.steps[plan.count++] = current->steps[step];
    plan.own = 1;
    while (n > 0)
        append_node(s, &s->memory->nodes[path[--n]], &plan, &end);
    append_stop(s, &s->memory->nodes[last], &plan, &end);
    plan.cost = s->result.cost;
    *out = plan;
}

ff_plan_result ff_plan_search(const ff_action_set *set, const ff_plan_world *world, const ff_plan *current,
                              double time, const ff_plan_goal *goal, const ff_plan_options *options,
                              ff_plan_scratch *scratch, ff_plan *out)
{
    search s = {.set = set,
                .goal = goal,
                .options = *options,
                .memory = scratch,
                .open_stance = NONE,
                .best = NONE,
                .part = NONE,
                .best_cost = INFINITY};
    s.result.outcome = FF_PLAN_NONE;
    s.result.inflation = INFINITY;
    if (options->seconds > 0.0) clock_gettime(CLOCK_MONOTONIC, &s.begun);
    if (s.options.horizon > HORIZON_MAX) s.options.horizon = HORIZON_MAX;
    uint32_t step = ff_plan_step_at(current, time);
    const ff_plan_step *doing = &current->steps[step];
    double end = doing->hold ? ff_max(time, doing->start) : ff_plan_step_end(current, step);
    ff_sight_open(set, world, options, doing->anchor, end, &scratch->sight);
    s.guide = ff_guide_make(set, world->solids, goal, ff_plan_root_at(set, current, end).position,
                            doing->anchor, options->table);
    s.inflation = (float)ff_max(options->inflation, 1.0);
    float start = (float)scratch->sight.lead;
    s.ahead = options->time_horizon > 0.0 ? start + (float)options->time_horizon : INFINITY;
    s.latest = (float)((FF_TRACK_KNOTS_MAX - 2) * FF_TRACK_STEP) - (float)(end - time) - 2.5f;
    if (++scratch->search == 0) scratch->search = 1;
    node first = start_node(&s, doing, end);
    set_guess(&s, &first);
    add_node(&s, &first);
    push(&s, 0);
    follow(&s, current, step);
    search_on(&s);
    uint32_t last = s.best != NONE ? s.best : s.part;
    if (s.best == NONE && last == NONE && is_safe(&s, 0)) last = 0;
    if (last == NONE) return s.result;
    const node *n = &scratch->nodes[last];
    if (s.best == NONE) s.result.outcome = FF_PLAN_PART;
    s.result.cost = s.best != NONE ? (double)s.best_cost : (double)(n->g + n->h);
    write_plan(&s, current, step, end, last, out);
    return s.result;
}

ff_plan_options ff_plan_options_default(void)
{
    return (ff_plan_options){.nodes = 300,
                             .improve = 60,
                             .horizon = 16,
                             .time_horizon = 5.0,
                             .inflation = 2.0,
                             .inflation_step = 0.5,
                             .margin = 0.05,
                             .stand_margin = 0.03,
                             .wait = FF_PLAN_WAIT,
                             .proximity = 0.3,
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
