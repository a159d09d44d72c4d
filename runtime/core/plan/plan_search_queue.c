/* What a search is still to look at, in order, and which places are taken: plan_search.h. */
#include "runtime/core/plan/plan_search.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define PLACE 0.2f         /* m: footstep study, section 2, "lattice" */
#define PLACE_TURN 0.5236f /* rad */
#define PLACE_TIME 0.5f    /* s */

/* -------------------------------------------------------------------------------------------------------- memory */

ff_status ff_plan_scratch_create(const ff_action_set *set, uint32_t nodes_max, ff_plan_scratch **out,
                                 ff_error *error)
{
    *out = NULL;
    ff_plan_scratch *m = ff_calloc(1, sizeof *m);
    if (m) {
        uint64_t room = (uint64_t)(nodes_max + 32) * (set->next_most + 1);
        m->nodes_max = nodes_max;
        m->room = room < FF_SEARCH_NODES_MAX ? (uint32_t)room : FF_SEARCH_NODES_MAX;
        m->nodes = ff_calloc(m->room, sizeof *m->nodes);
        m->heap = ff_calloc(m->room, sizeof *m->heap);
        m->later = ff_calloc(m->room, sizeof *m->later);
        m->places = ff_calloc(FF_SEARCH_PLACES, sizeof *m->places);
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
uint64_t ff_search_key(const ff_search *s, uint32_t index)
{
    const ff_search_node *n = &s->memory->nodes[index];
    float f = n->g + s->inflation * n->h;
    uint32_t bits, g = (uint32_t)(n->g * 16.0f);
    memcpy(&bits, &f, sizeof bits);
    return (uint64_t)bits << 32 | (uint64_t)(4095u - (g < 4095u ? g : 4095u)) << 20 | index;
}

float ff_search_key_cost(uint64_t key)
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

void ff_search_sift_down(uint64_t *heap, uint32_t count, uint32_t at)
{
    uint64_t key = heap[at];
    for (uint32_t child; (child = 2 * at + 1) < count; at = child) {
        if (child + 1 < count && heap[child + 1] < heap[child]) ++child;
        if (key <= heap[child]) break;
        heap[at] = heap[child];
    }
    heap[at] = key;
}

void ff_search_push(ff_search *s, uint32_t index)
{
    s->memory->heap[s->heap_count] = ff_search_key(s, index);
    sift_up(s->memory->heap, s->heap_count++);
}

uint32_t ff_search_pop(ff_search *s)
{
    uint64_t *heap = s->memory->heap, top = heap[0];
    heap[0] = heap[--s->heap_count];
    if (s->heap_count > 0) ff_search_sift_down(heap, s->heap_count, 0);
    return ff_search_key_node(top);
}

/* ------------------------------------------------------------------------------------------------------- places */

/* The whole number nearest to x, for x within a few thousand: floorf is a call. */
static uint32_t nearest(float x)
{
    return (uint32_t)(int32_t)(x + 8192.5f) - 8192u;
}

static uint64_t place_key(const ff_search *s, const ff_search_node *n)
{
    uint64_t key = nearest(n->at[0] * (1.0f / PLACE)) & 0xffffu;
    key = key << 16 | (nearest(n->at[1] * (1.0f / PLACE)) & 0xffffu);
    key = key << 4 | (nearest(n->heading * (1.0f / PLACE_TURN)) + 12u * 600u) % 12u;
    const ff_set_action *a = &s->set->actions[n->action];
    key = key << 4 | (uint64_t)(a->support | (uint32_t)a->kind << 1);
    bool moving = s->memory->sight.count > 0 || s->memory->sight.mover_count > 0;
    return key << 8 | (moving ? (uint64_t)(n->time / PLACE_TIME) & 0xffu : 0u);
}

/* The entry of a place: its own, or a free one. NULL when the table is full. */
static ff_search_place *find_place(ff_search *s, uint64_t key)
{
    ff_plan_scratch *m = s->memory;
    uint64_t at = (key * 0x9e3779b97f4a7c15u) >> 50;
    for (uint32_t i = 0; i < 64; ++i, ++at) {
        ff_search_place *t = &m->places[at & (FF_SEARCH_PLACES - 1)];
        if (t->round != m->search || t->key == key) return t;
    }
    return NULL;
}

/* Is the node's place taken by one that is as cheap? */
bool ff_search_is_taken(ff_search *s, const ff_search_node *n)
{
    if (!s->options.merge) return false;
    ff_search_place *t = find_place(s, place_key(s, n));
    return t && t->round == s->memory->search && s->memory->nodes[t->node].g <= n->g;
}

/* Take its place. *again: another one of the place was expanded in this round. */
bool ff_search_take_place(ff_search *s, uint32_t index, bool *again)
{
    *again = false;
    if (!s->options.merge) return true;
    ff_search_node *n = &s->memory->nodes[index];
    uint64_t key = place_key(s, n);
    ff_search_place *t = find_place(s, key);
    if (!t) return true;
    if (t->round == s->memory->search) {
        ff_search_node *old = &s->memory->nodes[t->node];
        if (old->g <= n->g) return false;
        *again = (old->flags & FF_NODE_CLOSED) != 0;
    }
    *t = (ff_search_place){key, index, s->memory->search};
    return true;
}
