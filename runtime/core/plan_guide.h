/* plan_guide.h - what is left to the goal, guessed: the heuristic of a search. Never more than it really costs, but for the
 * lattice of the reach table. */
#ifndef FF_PLAN_GUIDE_H
#define FF_PLAN_GUIDE_H

#include "runtime/core/plan_field.h"
#include "runtime/core/plan_set.h"

typedef struct ff_guide {
    const ff_pack_reach *reach; /* or NULL */
    const ff_field *field;      /* or NULL */
    ff_vec2 origin;
    float goal[2]; /* m, from the search's origin */
    float radius, rate;
    float nearer; /* J/kg that the goal's own radius saves over the table's */
} ff_guide;

static inline ff_guide ff_guide_make(const ff_action_set *set, const ff_plan_goal *goal, ff_vec2 origin,
                                     bool table)
{
    float wider = (float)goal->radius - FF_REACH_RADIUS;
    return (ff_guide){.reach = table ? set->reach : NULL,
                      .field = goal->field,
                      .origin = origin,
                      .goal = {(float)(goal->at.a - origin.a), (float)(goal->at.b - origin.b)},
                      .radius = (float)goal->radius,
                      .rate = set->rate,
                      .nearer = wider > 0.0f ? wider * set->rate : 0.0f};
}

static inline bool ff_guide_reached(const ff_guide *guide, const float root[2])
{
    float a = guide->goal[0] - root[0], b = guide->goal[1] - root[1];
    return a * a + b * b <= guide->radius * guide->radius;
}

/* From the table of the last action; past its edge, from there straight on. */
static inline float ff_guide_reach(const ff_guide *guide, float da, float db, float distance, float cosine,
                                   float sine, const ff_set_action *last)
{
    enum { MIDDLE = FF_REACH_CELLS / 2 };
    const float half = (float)(MIDDLE - 1) * FF_REACH_CELL; /* whatever cell this rounds to */
    float beyond = 0.0f;
    if (distance > half) {
        beyond = (distance - half) * guide->rate;
        da *= half / distance;
        db *= half / distance;
    }
    float f = cosine * da + sine * db, l = cosine * db - sine * da;
    if (last->support == 0) l = -l; /* the right foot has landed */
    int i = (int)(f / FF_REACH_CELL + (float)MIDDLE + 0.5f),
        k = (int)(l / FF_REACH_CELL + (float)MIDDLE + 0.5f);
    return FF_REACH_UNIT * (float)guide->reach[last->reach].cost[i][k] + beyond - guide->nearer;
}

/* J/kg to bring a root within the radius of the goal, from where the last action has left it. */
static inline float ff_guide_cost(const ff_guide *guide, const float root[2], float cosine, float sine,
                                  const ff_set_action *last)
{
    float a = guide->goal[0] - root[0], b = guide->goal[1] - root[1];
    float distance = sqrtf(a * a + b * b), left = distance - guide->radius;
    if (!(left > 0.0f)) return 0.0f;
    float straight = left * guide->rate;
    float cost = straight;
    if (guide->reach) {
        float reach = ff_guide_reach(guide, a, b, distance, cosine, sine, last);
        cost = reach > cost ? reach : cost;
    }
    if (guide->field) {
        double far =
            ff_field_distance(guide->field, ff_add2(guide->origin, ff_v2((double)root[0], (double)root[1])));
        float round = ((float)far - guide->radius) * guide->rate;
        cost = round > cost ? round : cost;
    }
    return cost;
}

#endif
