/* Which actions of a pack a planner takes: ff_set_select. A pack may hold a thousand, most of them nearly alike, and
 * every one that may come next has to be looked at each time. As in preprocess/build/select_actions.c, on records: first what
 * nobody can do without, then what differs most from that, then what joins best. */
#include "runtime/core/base/memory.h"
#include "runtime/core/plan/plan_set.h"

#include <stdlib.h>
#include <string.h>

/* Scales of the difference between actions (footstep study, section 1). */
static const double LANDING = 0.12, TURN = 12.0 * FF_DEG, DURATION = 0.08, OTHER_KIND = 3.0;
static const double ALIKE = 0.25;     /* nobody needs a second one that is so near */
static const double COVERING = 0.6;   /* share of the room for covering; the rest joins well */
static const uint32_t RUN_SHARE = 12; /* one in so many may be a run */
static const double
    ASIDE = 45.0 * FF_DEG,
    SHORT = 0.2; /* of a step: further to the side, or shorter (m), and it does not count as going ahead */
static const uint32_t ROOM_FOR_MADE_UP = 40;

typedef struct selection {
    const ff_pack *pack;
    uint32_t count, cap, chosen, runs;
    const bool *usable;
    bool *taken;
    uint32_t *twin;   /* the mirror image, or the action itself */
    uint32_t *joined; /* how many taken ones it follows or leads to */
    double *away;     /* from the nearest taken one */
    uint32_t *first_lead, *leads;
} selection;

/* Is it one of a kind that begins or ends in standing? 0: no. */
static int kind_of(const ff_pack_action *r)
{
    bool from = (r->flags & FF_ACTION_FROM_STANDING) != 0, to = (r->flags & FF_ACTION_TO_STANDING) != 0;
    if (r->mode == FF_MODE_IDLE) return 1;
    if (r->mode == FF_MODE_JUMP) return 2;
    if (r->mode == FF_MODE_CROUCH) return 3;
    if (!from && !to) return 0;
    double turn = fabs((double)r->theta) / FF_DEG, alpha = fabs((double)r->alpha) / FF_DEG;
    int turned = turn < 12.0 ? 0 : (turn < 32.0 ? 1 : (turn < 65.0 ? 2 : (turn < 120.0 ? 3 : 4)));
    int way = alpha < 45.0 ? 0 : (alpha < 135.0 ? 1 : 2);
    if (from && to) return 10 + 5 * way + turned;
    return (from ? 30 : 50) + 5 * way + turned + ((double)r->speed > 0.15 ? 0 : 40);
}
enum { KINDS = 120 };

/* Two actions as a planner sees them, sides apart. */
static double between(const ff_pack_action *x, const ff_pack_action *y)
{
    double side = x->support == y->support ? 1.0 : -1.0;
    double a = ((double)x->land[0] - (double)y->land[0]) / LANDING,
           b = ((double)x->land[1] - side * (double)y->land[1]) / LANDING;
    double turn = ((double)x->theta - side * (double)y->theta) / TURN,
           time = ((double)x->duration - (double)y->duration) / DURATION;
    double kind =
        kind_of(x) == kind_of(y) && (x->mode == FF_MODE_RUN) == (y->mode == FF_MODE_RUN) ? 0.0 : OTHER_KIND;
    return sqrt(a * a + b * b + turn * turn + time * time + kind * kind);
}

/* The mirror image: of the same clip and span, with the other foot. */
static void find_twins(selection *s)
{
    const ff_pack_action *r = s->pack->actions;
    for (uint32_t i = 0; i < s->count; ++i) {
        s->twin[i] = i;
        double best = ALIKE;
        for (uint32_t k = 0; k < s->count; ++k) {
            if (!s->usable[k] || r[k].support == r[i].support || r[k].mode != r[i].mode) continue;
            bool same = r[k].clip == r[i].clip && r[k].t_0 == r[i].t_0 && r[k].t_end == r[i].t_end;
            double off = same ? 0.0 : between(&r[i], &r[k]);
            if (off < best) {
                best = off;
                s->twin[i] = k;
            }
        }
    }
}

/* Which actions each one follows: leads[first_lead[k]] up to first_lead[k + 1]. */
static bool find_leads(selection *s)
{
    const ff_pack_action *r = s->pack->actions;
    const ff_pack_successor *all = s->pack->successors;
    size_t total = 0;
    for (uint32_t i = 0; i < s->count; ++i)
        total += r[i].successor_count;
    s->first_lead = ff_calloc((size_t)s->count + 2, sizeof *s->first_lead);
    s->leads = ff_calloc(total, sizeof *s->leads);
    if (!s->first_lead || !s->leads) return false;
    uint32_t *next =
        s->first_lead + 1; /* where the next one of each is put: in the end, where the others' begin */
    for (uint32_t i = 0; i < s->count; ++i)
        for (uint32_t k = 0; k < r[i].successor_count; ++k)
            ++next[all[r[i].first_successor + k].action + 1];
    for (uint32_t k = 1; k <= s->count; ++k)
        next[k] += next[k - 1];
    for (uint32_t i = 0; i < s->count; ++i)
        for (uint32_t k = 0; k < r[i].successor_count; ++k)
            s->leads[next[all[r[i].first_successor + k].action]++] = i;
    return true;
}

static void count_joins(selection *s, uint32_t taken)
{
    const ff_pack_action *r = &s->pack->actions[taken];
    for (uint32_t i = 0; i < r->successor_count; ++i)
        ++s->joined[s->pack->successors[r->first_successor + i].action];
    for (uint32_t i = s->first_lead[taken]; i < s->first_lead[taken + 1]; ++i)
        ++s->joined[s->leads[i]];
}

static void take(selection *s, uint32_t index)
{
    for (int side = 0; side < 2; ++side, index = s->twin[index]) {
        if (s->taken[index] || s->chosen >= s->cap) continue;
        s->taken[index] = true;
        ++s->chosen;
        s->runs += s->pack->actions[index].mode == FF_MODE_RUN;
        count_joins(s, index);
        for (uint32_t k = 0; k < s->count; ++k)
            s->away[k] = ff_min(s->away[k], between(&s->pack->actions[index], &s->pack->actions[k]));
    }
}

/* The usable one of a kind that joins most others of the pack; count when there is none. */
static uint32_t best_of_kind(const selection *s, const uint32_t *links, int kind)
{
    uint32_t best = s->count;
    for (uint32_t i = 0; i < s->count; ++i) {
        const ff_pack_action *r = &s->pack->actions[i];
        bool ordinary = kind != 0 || r->mode == FF_MODE_WALK_SHORT || r->mode == FF_MODE_WALK_LONG;
        bool made_up = ff_action_is_made_up(r);
        if (s->usable[i] && !made_up && ordinary && kind_of(r) == kind &&
            (best == s->count || links[i] > links[best]))
            best = i;
    }
    return best;
}

/* Standing, walking, a start and a stop; turns on the spot; steps aside and back; then one of every other kind that begins or
 * ends in standing, as long as two thirds of the room are left for steps. */
static void take_needed(selection *s)
{
    static const int first[] = {1, 30, 50, 0, 70, 12, 13, 11, 35, 55, 75, 40, 60, 80, 90};
    enum { FIRST = sizeof first / sizeof first[0] };
    uint32_t *links = ff_calloc(s->count, sizeof *links);
    if (!links) return;
    for (uint32_t i = 0; i < s->count; ++i) {
        const ff_pack_action *r = &s->pack->actions[i];
        for (uint32_t k = 0; k < r->successor_count; ++k) {
            uint32_t next = s->pack->successors[r->first_successor + k].action;
            if (ff_action_is_made_up(r) || ff_action_is_made_up(&s->pack->actions[next])) continue;
            ++links[i];
            ++links[next];
        }
    }
    bool done[KINDS] = {false};
    for (int round = 0; round < FIRST + KINDS; ++round) {
        int kind = round < FIRST ? first[round] : round - FIRST;
        uint32_t best = best_of_kind(s, links, kind);
        bool room = round < 5 || (round < FIRST ? 2 * s->chosen < s->cap : 3 * s->chosen < s->cap);
        if (!done[kind] && best < s->count && room) take(s, best);
        done[kind] = true;
    }
    free(links);
}

static bool may_take(const selection *s, uint32_t index)
{
    const ff_pack_action *r = &s->pack->actions[index];
    if (!s->usable[index] || s->taken[index] || r->mode == FF_MODE_IDLE || ff_action_is_made_up(r) ||
        s->away[index] < ALIKE)
        return false;
    return r->mode != FF_MODE_RUN || (s->runs + 1) * RUN_SHARE <= s->cap;
}

/* How well one gets on by a walking step, 0 to 1: steps that join well are often slow ones, whose poses differ little. */
static double ease_of(const ff_pack_action *r)
{
    double way = (double)r->speed * (double)r->duration;
    bool ahead = fabs((double)r->alpha) < ASIDE && way > SHORT;
    if (!ahead || (r->mode != FF_MODE_WALK_SHORT && r->mode != FF_MODE_WALK_LONG)) return 0.0;
    return ff_max(0.0, 1.0 - ((double)ff_action_cost(r, 1.0f) / way - 2.0 * sqrt(FF_E_S * FF_E_W)));
}

/* What differs most, and then what joins most of those taken and gets on well. */
static void take_rest(selection *s)
{
    const ff_pack_action *r = s->pack->actions;
    uint32_t covering = s->chosen + (uint32_t)(COVERING * (s->cap - s->chosen));
    while (s->chosen < s->cap) {
        uint32_t best = s->count;
        double most = 0.0;
        for (uint32_t i = 0; i < s->count; ++i) {
            if (!may_take(s, i)) continue;
            double worth = s->joined[i];
            if (s->chosen < covering)
                worth = s->joined[i] >= 4 ? s->away[i] : 0.0;
            else
                worth *= ease_of(&r[i]);
            if (best < s->count && worth <= most) continue;
            best = i;
            most = worth;
        }
        if (best == s->count) return;
        take(s, best);
    }
}

/* Jumps and ducks that were made up for danger come on top: they take no step's place, and no search looks at them otherwise. */
static void take_made_up(selection *s)
{
    for (uint32_t i = 0; i < s->count && s->cap >= ROOM_FOR_MADE_UP; ++i) {
        if (!s->usable[i] || !ff_action_is_made_up(&s->pack->actions[i])) continue;
        s->taken[i] = true;
        ++s->chosen;
        count_joins(s, i);
    }
}

/* Drop what leads nowhere or what nothing leads to, until all have both. */
static void prune(selection *s, uint32_t stand)
{
    for (bool again = true; again;) {
        again = false;
        memset(s->joined, 0, s->count * sizeof *s->joined);
        for (uint32_t i = 0; i < s->count; ++i) {
            const ff_pack_action *r = &s->pack->actions[i];
            for (uint32_t k = 0; s->taken[i] && k < r->successor_count; ++k)
                ++s->joined[s->pack->successors[r->first_successor + k].action];
        }
        for (uint32_t i = 0; i < s->count; ++i) {
            const ff_pack_action *r = &s->pack->actions[i];
            bool leads = false;
            for (uint32_t k = 0; s->taken[i] && k < r->successor_count && !leads; ++k) {
                uint32_t next = s->pack->successors[r->first_successor + k].action;
                leads = s->taken[next] && s->pack->actions[next].mode != FF_MODE_IDLE;
            }
            if (!s->taken[i] || i == stand || (leads && s->joined[i] > 0)) continue;
            s->taken[i] = false;
            --s->chosen;
            again = true;
        }
    }
}

/* The stillest standing that most lead on from. */
static uint32_t choose_stand(const selection *s)
{
    uint32_t best = s->count;
    double most = -INFINITY;
    for (uint32_t i = 0; i < s->count; ++i) {
        const ff_pack_action *r = &s->pack->actions[i];
        if (!s->usable[i] || !(r->flags & FF_ACTION_TO_STANDING) || (r->flags & FF_ACTION_WHOLE) ||
            ff_action_is_made_up(r))
            continue;
        double worth = (double)r->successor_count * (r->mode == FF_MODE_IDLE ? 2.0 : 1.0) -
                       100.0 * fabs((double)r->theta) - 50.0 * (double)r->speed;
        if (worth > most) {
            most = worth;
            best = i;
        }
    }
    return best;
}

uint32_t ff_set_select(const ff_pack *pack, uint32_t cap, bool *usable, bool *chosen, uint32_t *stand)
{
    selection s = {.pack = pack, .count = pack->action_count, .cap = cap, .usable = usable, .taken = chosen};
    s.twin = ff_calloc(s.count, sizeof *s.twin);
    s.joined = ff_calloc(s.count, sizeof *s.joined);
    s.away = ff_calloc(s.count, sizeof *s.away);
    if (find_leads(&s) && s.twin && s.joined && s.away) {
        for (uint32_t i = 0; i < s.count; ++i)
            s.away[i] = INFINITY;
        find_twins(&s);
        *stand = choose_stand(&s);
        if (*stand < s.count) {
            take(&s, *stand);
            take_needed(&s);
            take_rest(&s);
            take_made_up(&s);
            prune(&s, *stand);
        }
    }
    free(s.twin);
    free(s.joined);
    free(s.away);
    free(s.first_lead);
    free(s.leads);
    return s.chosen;
}
