#include "runtime/core/plan/plan_set.h"

#include "runtime/core/plan/plan_hit.h"
#include "runtime/core/plan/plan_joint.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

static const float FASTER = 0.9f; /* m/s, from one walking step to the next (algorithms A.13) */

const float ff_collider_radius[FF_COLLIDER_COUNT] = {0.12f, 0.08f, 0.08f, 0.11f, 0.11f, 0.18f};

void ff_collider_extent(uint32_t collider, float y, float *low, float *high)
{
    static const float below[FF_COLLIDER_COUNT] = {0.15f, 0.10f, 0.10f, 0.15f, 0.15f, 0.10f};
    static const float above[FF_COLLIDER_COUNT] = {0.12f, 0.10f, 0.10f, 0.10f, 0.10f, 0.45f};
    *low = y - below[collider] > 0.0f ? y - below[collider] : 0.0f;
    *high = y + above[collider];
}

/* --------------------------------------------------------------------------------------------------- records */

static void take_samples(ff_action_set *set, ff_set_action *a, const ff_pack_action *r)
{
    const ff_pack_collider *from = set->pack->colliders + r->first_collider;
    a->first_knot = set->knot_total;
    a->knots = r->collider_samples;
    a->samples_per_s = (float)(a->knots - 1) / a->duration;
    set->knot_total += a->knots;
    ff_knot *to = set->samples + a->first_knot;
    float low_a = INFINITY, low_b = INFINITY, high_a = -INFINITY, high_b = -INFINITY;
    for (uint32_t k = 0; k < a->knots; ++k)
        for (uint32_t i = 0; i < FF_COLLIDER_COUNT; ++i) {
            const ff_pack_collider *p = &from[k * FF_COLLIDER_COUNT + i];
            to[k].a[i] = p->a;
            to[k].b[i] = p->b;
            to[k].y[i] = p->y;
            low_a = fminf(low_a, p->a), high_a = fmaxf(high_a, p->a);
            low_b = fminf(low_b, p->b), high_b = fmaxf(high_b, p->b);
        }
    for (uint32_t k = 0; k < a->knots; ++k)
        set->roots[a->first_knot + k] = (ff_set_root){to[k].a[FF_COLLIDER_ROOT], to[k].b[FF_COLLIDER_ROOT],
                                                      ff_knot_radius(&to[k], set->radii)};
    a->circle[0] = 0.5f * (low_a + high_a);
    a->circle[1] = 0.5f * (low_b + high_b);
    float most = 0.0f;
    for (uint32_t k = 0; k < a->knots; ++k)
        for (uint32_t c = 0; c < FF_COLLIDER_COUNT; ++c) {
            float da = to[k].a[c] - a->circle[0], db = to[k].b[c] - a->circle[1];
            most = fmaxf(most, sqrtf(da * da + db * db) + set->radii[c]);
        }
    a->circle[2] = most;
}

static float duration_at(const ff_pack_action *r, float pace)
{
    return pace == 1.0f ? r->duration : r->duration / pace;
}

static void take_action(ff_action_set *set, const ff_body_frame *body, uint32_t index, uint32_t pack_index)
{
    const ff_pack_action *r = &set->pack->actions[pack_index];
    ff_set_action *a = &set->actions[index];
    ff_vec2 turn = ff_fwd2((double)r->theta);
    *a = (ff_set_action){.duration = r->duration,
                         .cost = ff_action_cost(r, 1.0f),
                         .land = {r->land[0], r->land[1]},
                         .root_end = {r->root_end[0], r->root_end[1]},
                         .theta = r->theta,
                         .cosine = (float)turn.a,
                         .sine = (float)turn.b,
                         .support = (uint8_t)r->support,
                         .kind = (uint8_t)ff_action_class_of(r),
                         .pace = 1.0f,
                         .pack_index = pack_index,
                         .reach = r->reach};
    if (r->reach == FF_REACH_NONE && !ff_action_is_platform(r)) set->reach = NULL;
    if (r->flags & FF_ACTION_TO_STANDING) a->flags |= FF_SET_TO_STANDING;
    if (r->flags & FF_ACTION_FROM_STANDING) a->flags |= FF_SET_FROM_STANDING;
    if (ff_action_is_platform(r)) a->flags |= FF_SET_REACTIVE;
    if (r->mode == FF_MODE_CROUCH) a->flags |= FF_SET_DUCK;
    take_samples(set, a, r);
    ff_set_ends_find(set->pack, body, pack_index, set->samples + a->first_knot, a->knots, &set->ends[index]);
}

/* Walking steps may be done faster and slower; what begins or ends in standing is as it was captured, and runs are (A.13). */
static bool may_vary(const ff_pack_action *r, float pace)
{
    uint32_t ends = FF_ACTION_FROM_STANDING | FF_ACTION_TO_STANDING;
    float duration = duration_at(r, pace);
    return (r->mode == FF_MODE_WALK_SHORT || r->mode == FF_MODE_WALK_LONG) && !(r->flags & ends) &&
           pace != 1.0f && duration >= FF_ACTION_SHORTEST && duration <= FF_ACTION_LONGEST;
}

/* The same action at another speed: same places, samples and table, other times. */
static void take_variant(ff_action_set *set, uint32_t index, float pace)
{
    ff_set_action *a = &set->actions[set->count];
    const ff_pack_action *r = &set->pack->actions[set->actions[index].pack_index];
    if (set->actions[index].variant_count++ == 0) set->actions[index].first_variant = set->count;
    *a = set->actions[index];
    a->pace = pace;
    a->duration = duration_at(r, pace);
    a->samples_per_s = (float)(a->knots - 1) / a->duration;
    a->cost = ff_action_cost(r, pace);
    ff_set_ends_pace(&set->ends[index], pace, a->duration, &set->ends[set->count]);
    a->variant_count = 0;
    ++set->count;
}

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
static void take_next(ff_action_set *set, uint32_t index, const uint16_t *place)
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

static void find_joints(ff_action_set *set)
{
    for (uint32_t i = 0; i < set->count; ++i) {
        const ff_set_action *a = &set->actions[i];
        for (uint32_t k = a->first_next; k < a->first_next + a->next_count; ++k)
            find_joint(set, a, &set->next[k], &set->joints[k]);
    }
}

/* With its speed varied, what share of its cost at its own speed does a successor (with its joint) cost at least? Then no
 * sequence costs less than that share of what the reach tables, which know own speeds alone, say. */
static void measure_reach_share(ff_action_set *set)
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
static void measure_next(ff_action_set *set)
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
static void find_stops(ff_action_set *set, uint32_t index)
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

/* ------------------------------------------------------------------------------------------------------ create */

/* What a set is made of. */
typedef struct recipe {
    bool *usable, *chosen; /* of the pack's actions */
    const double *speeds;  /* factors; 0: none */
    uint32_t speed_count;
    uint32_t stand; /* of the pack */
} recipe;

/* Is it taken at its n-th other speed? */
static bool is_varied(const recipe *from, const ff_pack_action *r, uint32_t n)
{
    return from->speeds[n] > 0.0 && may_vary(r, (float)from->speeds[n]);
}

/* Sums over the chosen actions, for the arrays' sizes. */
static ff_status take_memory(ff_action_set *set, const recipe *from, ff_error *error)
{
    size_t knots = 0, next = 0, count = 0, fold = 1 + (size_t)from->speed_count;
    for (uint32_t i = 0; i < set->pack->action_count; ++i) {
        if (!from->chosen[i]) continue;
        const ff_pack_action *r = &set->pack->actions[i];
        size_t times = 1;
        for (uint32_t n = 0; n < from->speed_count; ++n)
            times += is_varied(from, r, n);
        count += times;
        knots += r->collider_samples;
        next += times * fold * r->successor_count;
    }
    if (count > UINT16_MAX - 1u)
        return ff_fail(error, FF_ERR_RANGE, "%zu actions at all speeds; at most %u fit", count,
                       UINT16_MAX - 1u);
    set->actions = ff_calloc(count, sizeof *set->actions);
    set->ends = ff_calloc(count, sizeof *set->ends);
    set->next = ff_calloc(next, sizeof *set->next);
    set->joints = ff_calloc(next, sizeof *set->joints);
    set->stops = ff_calloc(count * FF_SET_STOPS_MAX, sizeof *set->stops);
    set->samples = ff_calloc(knots, sizeof *set->samples);
    set->roots = ff_calloc(knots, sizeof *set->roots);
    if (set->actions && set->ends && set->next && set->joints && set->stops && set->samples && set->roots)
        return FF_OK;
    return ff_fail(error, FF_ERR_NO_MEMORY, "a set of %zu actions", count);
}

static ff_status fill(ff_action_set *set, const recipe *from, ff_error *error)
{
    uint32_t total = set->pack->action_count;
    ff_body_frame body;
    ff_body_frame_read(set->pack, &body);
    uint16_t *place = ff_calloc(total, sizeof *place);
    if (!place) return ff_fail(error, FF_ERR_NO_MEMORY, "a set of %u actions", total);
    set->count = 0;
    for (uint32_t i = 0; i < total; ++i) {
        place[i] = from->chosen[i] ? (uint16_t)set->count : UINT16_MAX;
        if (!from->chosen[i]) continue;
        if (i == from->stand) set->stand = set->count;
        take_action(set, &body, set->count++, i);
    }
    for (uint32_t i = 0, own = set->count; i < own; ++i)
        for (uint32_t n = 0; n < from->speed_count; ++n)
            if (is_varied(from, &set->pack->actions[set->actions[i].pack_index], n))
                take_variant(set, i, (float)from->speeds[n]);
    for (uint32_t i = 0; i < set->count; ++i)
        take_next(set, i, place);
    free(place);
    find_joints(set);
    ff_status status = ff_set_find_arcs(set, &body, error);
    if (status != FF_OK) return status;
    measure_next(set);
    measure_reach_share(set);
    for (uint32_t i = 0; i < set->count; ++i)
        find_stops(set, i);
    if (set->actions[set->stand].step_count == 0)
        return ff_fail(error, FF_ERR_NO_DATA, "nothing may follow the pack's standing (action %u)",
                       from->stand);
    return FF_OK;
}

ff_status ff_action_set_create_varied(const ff_pack *pack, uint32_t cap, const double *speeds,
                                      uint32_t speed_count, ff_action_set **out, ff_error *error)
{
    *out = NULL;
    if (cap == 0) cap = FF_ACTIONS_DEFAULT;
    if (cap > UINT16_MAX - 1u) cap = UINT16_MAX - 1u;
    recipe from = {.usable = ff_calloc(pack->action_count, sizeof *from.usable),
                   .chosen = ff_calloc(pack->action_count, sizeof *from.chosen),
                   .speeds = speeds,
                   .speed_count = speed_count};
    ff_action_set *set = ff_calloc(1, sizeof *set);
    ff_status status = FF_OK;
    if (!from.usable || !from.chosen || !set)
        status = ff_fail(error, FF_ERR_NO_MEMORY, "a set of %u actions", cap);
    else {
        set->pack = pack;
        set->reach = pack->reach;
        set->radii = pack->collider_radii ? pack->collider_radii : ff_collider_radius;
        for (uint32_t i = 0; i < pack->action_count; ++i)
            from.usable[i] = ff_action_is_usable(&pack->actions[i]);
        if (ff_set_select(pack, cap, from.usable, from.chosen, &from.stand) == 0)
            status = ff_fail(
                error, FF_ERR_NO_DATA,
                "the pack has no actions to stand, start and stop with; build it without --no-derived");
    }
    if (status == FF_OK) status = take_memory(set, &from, error);
    if (status == FF_OK) status = fill(set, &from, error);
    free(from.usable);
    free(from.chosen);
    if (status != FF_OK) {
        ff_action_set_destroy(set);
        return status;
    }
    *out = set;
    return FF_OK;
}

ff_status ff_action_set_create(const ff_pack *pack, uint32_t cap, ff_action_set **out, ff_error *error)
{
    return ff_action_set_create_varied(pack, cap, NULL, 0, out, error);
}

void ff_action_set_destroy(ff_action_set *set)
{
    if (!set) return;
    free(set->actions);
    free(set->ends);
    free(set->next);
    free(set->joints);
    free(set->stops);
    free(set->samples);
    free(set->roots);
    free(set);
}

/* ----------------------------------------------------------------------------------------------------- questions */

uint32_t ff_action_set_count(const ff_action_set *set)
{
    return set->count;
}

const ff_pack_action *ff_action_set_record(const ff_action_set *set, uint32_t action)
{
    return &set->pack->actions[set->actions[action].pack_index];
}

uint32_t ff_action_set_pack_index(const ff_action_set *set, uint32_t action)
{
    return set->actions[action].pack_index;
}

double ff_action_set_pace(const ff_action_set *set, uint32_t action)
{
    return (double)set->actions[action].pace;
}

uint32_t ff_action_set_stand(const ff_action_set *set)
{
    return set->stand;
}

const ff_pack *ff_action_set_pack(const ff_action_set *set)
{
    return set->pack;
}
