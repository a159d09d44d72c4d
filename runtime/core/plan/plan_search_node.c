/* What a node of a search stands for, and whether it is free and safe: plan_search.h. */
#include "runtime/core/plan/plan_search.h"

#include <string.h>

/* ------------------------------------------------------------------------------------------------------ geometry */

void ff_search_root(const ff_search *s, const ff_search_node *n, float root[2])
{
    const ff_set_action *a = &s->set->actions[n->action];
    /* The heading at the start of the action: cosine and sine turned back by its theta. */
    float c = n->cosine * a->cosine + n->sine * a->sine, d = n->sine * a->cosine - n->cosine * a->sine;
    root[0] = n->other[0] + c * a->root_end[0] - d * a->root_end[1];
    root[1] = n->other[1] + d * a->root_end[0] + c * a->root_end[1];
}

ff_search_look ff_search_ask(const ff_search *s, const ff_search_node *n)
{
    ff_search_look look;
    ff_search_root(s, n, look.root);
    look.goal =
        ff_guide_ask(&s->guide, &s->guide.goal, look.root, n->cosine, n->sine, &s->set->actions[n->action]);
    return look;
}

void ff_search_guess(const ff_search *s, ff_search_node *n, const ff_search_look *look)
{
    n->h = ff_guide_cost(&s->guide, look->goal, look->root, n->cosine, n->sine, &s->set->actions[n->action]);
}

/* The node that a successor leads to. */
ff_search_node ff_search_child(const ff_search *s, uint32_t parent, uint16_t k)
{
    const ff_search_node *p = &s->memory->nodes[parent];
    const ff_set_next *next = &s->set->next[s->set->actions[p->action].first_next + k];
    const ff_set_action *b = &s->set->actions[next->action];
    const float *anchor = next->other ? p->other : p->at;
    float more = b->flags & FF_SET_REACTIVE ? (float)s->options.reactive_cost - FF_PLATFORM_COST : 0.0f;
    return (ff_search_node){.at = {anchor[0] + p->cosine * b->land[0] - p->sine * b->land[1],
                                   anchor[1] + p->sine * b->land[0] + p->cosine * b->land[1]},
                            .other = {anchor[0], anchor[1]},
                            .cosine = p->cosine * b->cosine - p->sine * b->sine,
                            .sine = p->sine * b->cosine + p->cosine * b->sine,
                            .heading = p->heading + b->theta,
                            .time = p->time + b->duration,
                            .g = p->g + next->cost + more,
                            .parent = parent,
                            .action = next->action,
                            .next = k,
                            .depth = (uint8_t)(p->depth + 1)};
}

ff_search_node ff_search_waiting(const ff_search *s, uint32_t parent, float seconds)
{
    ff_search_node n = s->memory->nodes[parent];
    n.time += seconds;
    n.g += (float)(s->options.wait * FF_E_S) * seconds;
    n.parent = parent;
    n.next = FF_SET_NO_STOP;
    ++n.depth;
    n.flags = FF_NODE_HELD;
    return n;
}

/* Fill in a stance for a node. */
void ff_search_stand_at(const ff_search *s, const ff_search_node *n, ff_stance *out)
{
    const ff_set_action *a = &s->set->actions[n->action];
    memcpy(out->at, n->at, sizeof out->at);
    memcpy(out->other, n->other, sizeof out->other);
    out->cosine = n->cosine;
    out->sine = n->sine;
    out->time = n->time;
    out->action = n->action;
    out->hold = (n->flags & FF_NODE_HELD) != 0;
    ff_stance_begin(&s->memory->sight, n->cosine * a->cosine + n->sine * a->sine,
                    n->sine * a->cosine - n->cosine * a->sine, out);
}

static ff_stance *stance_of(ff_search *s, uint32_t index)
{
    uint32_t place = index % FF_SEARCH_STANCES;
    if (s->stance_of[place] != index) {
        ff_search_stand_at(s, &s->memory->nodes[index], &s->memory->stance[place]);
        s->stance_of[place] = index;
    }
    return &s->memory->stance[place];
}

uint32_t ff_search_add(ff_search *s, const ff_search_node *n)
{
    if (s->count == s->memory->room) return FF_SEARCH_NONE;
    s->memory->nodes[s->count] = *n;
    return s->count++;
}

/* ------------------------------------------------------------------------------------------------------- testing */

void ff_search_fetch(const ff_search *s, const ff_search_node *n)
{
#ifdef __GNUC__
    if (n->flags & FF_NODE_HELD) return;
    const ff_set_action *a = &s->set->actions[s->memory->nodes[n->parent].action];
    const char *joint = (const char *)&s->set->joints[a->first_next + n->next];
    for (uint32_t i = 0; i < sizeof(ff_joint); i += 64)
        __builtin_prefetch(joint + i);
#endif
}

/* Is the way from its parent to the node free? Costs of going near others are added. */
bool ff_search_is_free(ff_search *s, ff_search_node *n)
{
    if (n->flags & FF_NODE_TESTED) return true;
    if (ff_sight_is_empty(&s->memory->sight)) {
        n->flags |= FF_NODE_TESTED;
        return true;
    }
    ff_stance *stance = stance_of(s, n->parent);
    ++s->result.tested;
    bool free_way;
    float more = 0.0f;
    if (n->flags & FF_NODE_HELD)
        free_way = ff_stance_waits(&s->memory->sight, stance, n->time - s->memory->nodes[n->parent].time);
    else {
        const ff_set_action *a = &s->set->actions[s->memory->nodes[n->parent].action];
        free_way = ff_stance_free(&s->memory->sight, stance, &s->set->next[a->first_next + n->next], &more);
    }
    n->flags |= free_way ? FF_NODE_TESTED : FF_NODE_DEAD;
    n->g += more;
    return free_way;
}

/* Is the first action of its k-th way of stopping free? Several ways begin alike. */
static bool stop_begins(ff_search *s, uint32_t index, uint32_t k, uint8_t known[FF_SET_STOPS_MAX])
{
    const ff_set_action *a = &s->set->actions[s->memory->nodes[index].action];
    const ff_set_stop *stops = &s->set->stops[a->first_stop];
    enum { FREE = 1, TAKEN };
    for (uint32_t i = 0; i < k; ++i)
        if (stops[i].next[0] == stops[k].next[0]) return (known[k] = known[i]) == FREE;
    const ff_set_next *next = &s->set->next[a->first_next + stops[k].next[0]];
    known[k] = ff_stance_free(&s->memory->sight, stance_of(s, index), next, NULL) ? FREE : TAKEN;
    return known[k] == FREE;
}

/* May one who has come to the node stand there for ever? */
static bool may_stand(ff_search *s, const ff_search_node *n)
{
    ff_search_stand_at(s, n, &s->memory->step);
    return ff_stance_waits(&s->memory->sight, &s->memory->step, INFINITY);
}

/* Does one come to stand from the node, by its k-th way of stopping, and may stand there for ever? */
static bool stops_by(ff_search *s, uint32_t index, uint32_t k, uint8_t known[FF_SET_STOPS_MAX])
{
    ff_plan_scratch *m = s->memory;
    const ff_set_stop *stop = &s->set->stops[s->set->actions[m->nodes[index].action].first_stop + k];
    if (!stop_begins(s, index, k, known)) return false;
    ff_search_node here = ff_search_child(s, index, stop->next[0]);
    if (stop->next[1] != FF_SET_NO_STOP) {
        uint32_t mark = s->count, at = ff_search_add(s, &here);
        if (at == FF_SEARCH_NONE) return false;
        ff_search_stand_at(s, &here, &m->step);
        const ff_set_next *next = &s->set->next[s->set->actions[here.action].first_next + stop->next[1]];
        bool free_way = ff_stance_free(&m->sight, &m->step, next, NULL);
        if (free_way) here = ff_search_child(s, at, stop->next[1]);
        s->count = mark;
        if (!free_way) return false;
    }
    return may_stand(s, &here);
}

/* Can one always stop from here? Found out once per node. */
bool ff_search_is_safe(ff_search *s, uint32_t index)
{
    ff_search_node *n = &s->memory->nodes[index];
    if (!s->options.safe) return true;
    if (n->flags & (FF_NODE_SAFE | FF_NODE_UNSAFE)) return (n->flags & FF_NODE_SAFE) != 0;
    const ff_set_action *a = &s->set->actions[n->action];
    uint8_t known[FF_SET_STOPS_MAX];
    n->stop = FF_SET_NO_STOP;
    bool safe = (a->flags & FF_SET_TO_STANDING) && may_stand(s, n);
    for (uint32_t k = 0; k < a->stop_count && !safe; ++k) {
        safe = stops_by(s, index, k, known);
        if (safe) n->stop = (uint16_t)k;
    }
    n->flags |= safe ? FF_NODE_SAFE : FF_NODE_UNSAFE;
    return safe;
}

bool ff_search_at_goal(const ff_search *s, const ff_search_node *n)
{
    float root[2];
    ff_search_root(s, n, root);
    if (!ff_guide_reached(&s->guide, root)) return false;
    if (s->goal->stand && !(s->set->actions[n->action].flags & FF_SET_TO_STANDING)) return false;
    if ((double)n->time > s->goal->latest - (double)s->memory->sight.first_knot * FF_TRACK_STEP) return false;
    return s->goal->tolerance >= FF_PI ||
           fabs(ff_wrap((double)n->heading - s->goal->heading)) <= s->goal->tolerance;
}
