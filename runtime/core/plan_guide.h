/* plan_guide.h - what is left to the goal, guessed: the heuristic of a search. Never more than it really costs. */
#ifndef FF_PLAN_GUIDE_H
#define FF_PLAN_GUIDE_H

#include "runtime/core/plan_set.h"

typedef struct ff_guide {
    float goal[2]; /* m, from the search's origin */
    float radius, rate;
} ff_guide;

static inline ff_guide ff_guide_make(const ff_action_set *set, const ff_plan_goal *goal, ff_vec2 origin,
                                     bool table)
{
    (void)table;
    return (ff_guide){
        {(float)(goal->at.a - origin.a), (float)(goal->at.b - origin.b)}, (float)goal->radius, set->rate};
}

static inline bool ff_guide_reached(const ff_guide *guide, const float root[2])
{
    float a = guide->goal[0] - root[0], b = guide->goal[1] - root[1];
    return a * a + b * b <= guide->radius * guide->radius;
}

/* J/kg to bring a root within the radius of the goal; ball and heading are those of the foot that has just landed. */
static inline float ff_guide_cost(const ff_guide *guide, const float root[2], const float ball[2],
                                  float cosine, float sine, const ff_set_action *last)
{
    (void)ball, (void)cosine, (void)sine, (void)last;
    float a = guide->goal[0] - root[0], b = guide->goal[1] - root[1];
    float left = sqrtf(a * a + b * b) - guide->radius;
    return left > 0.0f ? left * guide->rate : 0.0f;
}

#endif
