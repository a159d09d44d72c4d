/* plan_guide.h - what is left to the goal, guessed: the heuristic of a search. Never more than it really costs, but for the
 * lattices of the reach table and the distance field. */
#ifndef FF_PLAN_GUIDE_H
#define FF_PLAN_GUIDE_H

#include "runtime/core/plan/plan_field.h"
#include "runtime/core/plan/plan_set.h"
#include "runtime/core/plan/plan_solids.h"

/* A place to make for. */
typedef struct ff_guide_goal {
    float at[2];  /* m, from the search's origin */
    float beyond; /* J/kg from there on */
    float nearer; /* J/kg that a wider one, or one that is walked past, saves over the table's */
    float field;  /* m left by the field */
    uint32_t stand;
} ff_guide_goal;

enum { FF_GUIDE_VIAS = 6 };
typedef struct ff_guide {
    const ff_pack_reach *reach; /* or NULL */
    const ff_field *field;      /* or NULL */
    ff_vec2 origin;
    float radius, rate;
    float unit; /* J/kg that 1 in the table stands for */
    ff_guide_goal goal;
    uint32_t via_count;
    ff_guide_goal via[FF_GUIDE_VIAS]; /* corners on the way that the field shows, in order */
} ff_guide;

ff_guide ff_guide_make(const ff_action_set *set, const ff_solids *solids, const ff_plan_goal *goal,
                       ff_vec2 start, ff_vec2 origin, bool table);

static inline bool ff_guide_reached(const ff_guide *guide, const float root[2])
{
    float a = guide->goal.at[0] - root[0], b = guide->goal.at[1] - root[1];
    return a * a + b * b <= guide->radius * guide->radius;
}

/* What the guess at what is left to a place stands on. Its cell of a reach table, of which there are many, is fetched while other places are
 * asked for: to wait for it took a tenth of a search. */
typedef struct ff_guide_look {
    const uint16_t *cell; /* or NULL: no table */
    float beyond;         /* J/kg past the table's edge */
    float least;          /* J/kg by the straight line */
} ff_guide_look;

/* The cell of the table of the last action for a goal (da, db) away; past the table's edge, from there straight on. */
static inline const uint16_t *ff_guide_cell(const ff_guide *guide, float da, float db, float distance,
                                            float cosine, float sine, const ff_set_action *last,
                                            float *beyond)
{
    enum { MIDDLE = FF_REACH_CELLS / 2 };
    const float half = (float)(MIDDLE - 1) * FF_REACH_CELL; /* whatever cell this rounds to */
    *beyond = 0.0f;
    if (distance > half) {
        *beyond = (distance - half) * guide->rate;
        da *= half / distance;
        db *= half / distance;
    }
    float f = cosine * da + sine * db, l = cosine * db - sine * da;
    if (last->support == 0) l = -l; /* the right foot has landed */
    int i = (int)(f / FF_REACH_CELL + (float)MIDDLE + 0.5f),
        k = (int)(l / FF_REACH_CELL + (float)MIDDLE + 0.5f);
    return &guide->reach[last->reach].cost[i][k];
}

static inline ff_guide_look ff_guide_ask(const ff_guide *guide, const ff_guide_goal *goal,
                                         const float root[2], float cosine, float sine,
                                         const ff_set_action *last)
{
    ff_guide_look look = {NULL, 0.0f, 0.0f};
    float a = goal->at[0] - root[0], b = goal->at[1] - root[1];
    float distance = sqrtf(a * a + b * b), left = distance - guide->radius;
    if (!(left > 0.0f) && !goal->stand) return look;
    if (left > 0.0f) look.least = left * guide->rate;
    if (guide->reach && last->reach != FF_REACH_NONE) {
        look.cell = ff_guide_cell(guide, a, b, distance, cosine, sine, last, &look.beyond);
#ifdef __GNUC__
        __builtin_prefetch(look.cell);
#endif
    }
    return look;
}

static inline float ff_guide_answer(const ff_guide *guide, const ff_guide_goal *goal, ff_guide_look look)
{
    float cost = look.least;
    if (look.cell) {
        float reach = guide->unit * (float)*look.cell + look.beyond - goal->nearer;
        cost = reach > cost ? reach : cost;
    }
    return cost + goal->beyond;
}

/* J/kg to bring a root within the radius of the goal, from where the last action has left it; look: what was asked about the goal. */
static inline float ff_guide_cost(const ff_guide *guide, ff_guide_look look, const float root[2],
                                  float cosine, float sine, const ff_set_action *last)
{
    float cost = ff_guide_answer(guide, &guide->goal, look);
    if (!guide->field) return cost;
    double far =
        ff_field_distance(guide->field, ff_add2(guide->origin, ff_v2((double)root[0], (double)root[1])));
    float round = ((float)far - guide->radius) * guide->rate;
    cost = round > cost ? round : cost;
    /* By each of the corners that are still to come: turning towards it costs too. */
    for (uint32_t i = 0; i < guide->via_count; ++i) {
        const ff_guide_goal *via = &guide->via[i];
        if (via->field >= (float)far - guide->radius) continue;
        float by = ff_guide_answer(guide, via, ff_guide_ask(guide, via, root, cosine, sine, last));
        cost = by > cost ? by : cost;
    }
    return cost;
}

#endif
