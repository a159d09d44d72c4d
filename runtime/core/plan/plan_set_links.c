/* What may follow the actions of a set: successors, joints, ways to a stand (plan_set_links.h). */
#include "runtime/core/plan/plan_set_links.h"

#include "runtime/core/plan/plan_joint.h"

#include <stdlib.h>
#include <string.h>

static const float FASTER = 0.9f; /* m/s, from one walking step to the next (algorithms A.13) */

static int by_cost(const void *x, const void *y)
{
    const ff_set_next *p = x, *q = y;
    if (p->cost != q->cost) return p->cost < q->cost ? -1 : 1;
    return (p->action > q->action) - (p->action < q->action);
}

/* A successor at the record's own speed and all others that it is there at. Speeds of two steps differ by no more than they may. */
static uint32_t add_next(const ff_action_set *set, const ff_set_action *a, uint16_t base, float join,
                         bool other, ff_set_next *list)
{
    const ff_set_action *b = &set->actions[base];
    const ff_pack_action *r = &set->pack->actions[a->pack_index], *next = &set->pack->actions[b->pack_index];
    uint32_t n = 0;
    for (uint32_t v = 0; v <= b->variant_count; ++v) {
        uint16_t at = v == 0 ? base : (uint16_t)(b->first_variant + v - 1);
        float faster = set->actions[at].pace * next->speed - a->pace * r->speed;
        bool own = a->pace == 1.0f && v == 0;
        if (!own && fabsf(faster) > FASTER) continue;
        list[n++] = (ff_set_next){at, other, set->actions[at].cost + join, 0.0f};
    }
    return n;
}

/* Successors among the chosen: steps first, then jumps and ducks, each cheapest first. Standing is waited in, not stepped
 * in: idle actions follow nothing. */
void ff_set_find_next(ff_action_set *set, uint32_t index, const uint16_t *place)
{
    ff_set_action *a = &set->actions[index];
    const ff_pack *pack = set->pack;
    const ff_pack_action *r = &pack->actions[a->pack_index];
    a->first_next = set->next_total;
    for (int reactive = 0; reactive < 2; ++reactive) {
        ff_set_next *list = set->next + set->next_total;
        uint32_t n = 0;
        for (uint32_t i = 0; i < r->successor_count; ++i) {
            const ff_pack_successor *s = &pack->successors[r->first_successor + i];
            const ff_pack_action *next = &pack->actions[s->action];
            if (place[s->action] == UINT16_MAX || next->mode == FF_MODE_IDLE) continue;
            if (ff_action_is_platform(next) != (reactive == 1)) continue;
            n += add_next(set, a, place[s->action], s->cost, next->support != r->swing, list + n);
        }
        qsort(list, n, sizeof *list, by_cost);
        set->next_total += n;
        if (reactive == 0) a->step_count = n;
    }
    a->next_count = set->next_total - a->first_next;
    if (a->next_count > set->next_most) set->next_most = a->next_count;
}

/* What joins a successor to a. */
static void find_joint(const ff_action_set *set, const ff_set_action *a, const ff_set_next *next,
                       ff_joint *out)
{
    const ff_set_action *b = &set->actions[next->action];
    const ff_knot *end = &set->samples[a->first_knot + a->knots - 1], *begin = &set->samples[b->first_knot];
    const ff_set_ends *before = a->flags & FF_SET_TO_STANDING ? NULL : &set->ends[a - set->actions];
    const float turn[2] = {a->cosine, a->sine};
    ff_knot jump;
    for (int i = 0; i < FF_TRACK_LANES; ++i) {
        float x = end->a[i] - (next->other ? 0.0f : a->land[0]);
        float y = end->b[i] - (next->other ? 0.0f : a->land[1]);
        jump.a[i] = a->cosine * x + a->sine * y - begin->a[i];
        jump.b[i] = a->cosine * y - a->sine * x - begin->b[i];
        jump.y[i] = end->y[i] - begin->y[i];
    }
    ff_joint_make(before, turn, &set->ends[next->action], &jump, out);
}

void ff_set_find_joints(ff_action_set *set)
{
    for (uint32_t i = 0; i < set->count; ++i) {
        const ff_set_action *a = &set->actions[i];
        for (uint32_t k = a->first_next; k < a->first_next + a->next_count; ++k)
            find_joint(set, a, &set->next[k], &set->joints[k]);
    }
}

/* With its speed varied, what share of its cost at its own speed does a successor (with its joint) cost at least? Then no
 * sequence costs less than that share of what the reach tables, which know own speeds alone, say. */
void ff_set_measure_reach_share(ff_action_set *set)
{
    set->reach_share = 1.0f;
    for (uint32_t i = 0; i < set->next_total; ++i) {
        const ff_set_next *next = &set->next[i];
        const ff_set_action *b = &set->actions[next->action];
        if (b->pace == 1.0f) continue;
        float own = ff_action_cost(&set->pack->actions[b->pack_index], 1.0f);
        set->reach_share = fminf(set->reach_share, next->cost / (next->cost - b->cost + own));
    }
}

/* What follows from the lists: how far successors reach, and the least cost per metre. */
void ff_set_measure_next(ff_action_set *set)
{
    set->rate = (float)(2.0 * sqrt(FF_E_S * FF_E_W));
    for (uint32_t i = 0; i < set->count; ++i) {
        ff_set_action *a = &set->actions[i];
        for (uint32_t k = 0; k < a->next_count; ++k) {
            ff_set_next *next = &set->next[a->first_next + k];
            const ff_set_action *b = &set->actions[next->action];
            const float anchor[2] = {next->other ? 0.0f : a->land[0], next->other ? 0.0f : a->land[1]};
            next->jump = ff_joint_most(&set->joints[a->first_next + k]);
            float ra = a->root_end[0] - anchor[0], rb = a->root_end[1] - anchor[1];
            float ea = a->cosine * b->root_end[0] - a->sine * b->root_end[1] - ra;
            float eb = a->sine * b->root_end[0] + a->cosine * b->root_end[1] - rb;
            float ca = a->cosine * b->circle[0] - a->sine * b->circle[1] - ra;
            float cb = a->sine * b->circle[0] + a->cosine * b->circle[1] - rb;
            float moved = sqrtf(ea * ea + eb * eb);
            if (moved > 1e-3f) set->rate = fminf(set->rate, next->cost / moved);
            float reach = sqrtf(ca * ca + cb * cb) + b->circle[2] + next->jump;
            for (int all = k < a->step_count ? 0 : 1; all < 2; ++all) {
                a->next_longest[all] = fmaxf(a->next_longest[all], b->duration);
                a->next_reach[all] = fmaxf(a->next_reach[all], reach);
            }
        }
    }
    set->rate *= 0.9999f; /* sums of floats */
}

/* ------------------------------------------------------------------------------------------------------ stops */

static void keep_stop(ff_set_stop *list, uint32_t *count, ff_set_stop stop)
{
    uint32_t at = *count < FF_SET_STOPS_MAX ? (*count)++ : FF_SET_STOPS_MAX;
    for (; at > 0 && stop.time < list[at - 1].time; --at)
        if (at < FF_SET_STOPS_MAX) list[at] = list[at - 1];
    if (at < FF_SET_STOPS_MAX) list[at] = stop;
}

/* The ways to a stand in one action; where there is none, in two; the quickest first. */
void ff_set_find_stops(ff_action_set *set, uint32_t index)
{
    ff_set_action *a = &set->actions[index];
    ff_set_stop *list = set->stops + set->stop_total;
    uint32_t n = 0;
    for (uint32_t k = 0; k < a->step_count; ++k) {
        const ff_set_next *next = &set->next[a->first_next + k];
        const ff_set_action *b = &set->actions[next->action];
        if (b->flags & FF_SET_TO_STANDING)
            keep_stop(list, &n, (ff_set_stop){{(uint16_t)k, FF_SET_NO_STOP}, b->duration, next->cost});
    }
    bool direct = n > 0;
    for (uint32_t k = 0; k < a->step_count && !direct; ++k) {
        const ff_set_next *next = &set->next[a->first_next + k];
        const ff_set_action *b = &set->actions[next->action];
        for (uint32_t m = 0; m < b->step_count; ++m) {
            const ff_set_next *last = &set->next[b->first_next + m];
            const ff_set_action *c = &set->actions[last->action];
            if (c->flags & FF_SET_TO_STANDING)
                keep_stop(list, &n,
                          (ff_set_stop){{(uint16_t)k, (uint16_t)m},
                                        b->duration + c->duration,
                                        next->cost + last->cost});
        }
    }
    float least = INFINITY;
    for (uint32_t k = 0; k < n; ++k)
        least = fminf(least, list[k].cost);
    if (direct) set->stop_cost = fmaxf(set->stop_cost, least);
    a->first_stop = set->stop_total;
    a->stop_count = n;
    set->stop_total += n;
}
