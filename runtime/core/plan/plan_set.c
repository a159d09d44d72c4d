#include "runtime/core/plan/plan_set.h"

#include "runtime/core/plan/plan_hit.h"
#include "runtime/core/plan/plan_joint.h"
#include "runtime/core/plan/plan_set_links.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

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
        ff_set_find_next(set, i, place);
    free(place);
    ff_set_find_joints(set);
    ff_status status = ff_set_find_arcs(set, &body, error);
    if (status != FF_OK) return status;
    ff_set_measure_next(set);
    ff_set_measure_reach_share(set);
    for (uint32_t i = 0; i < set->count; ++i)
        ff_set_find_stops(set, i);
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
