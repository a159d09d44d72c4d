/* Which goal a state takes (algorithms F). */
#include "runtime/core/behave/behave.h"

enum { STREAM_CHOICE = 3 };

/* Its own place does not count as taken. */
static bool is_free(const ff_behaviour *behaviour, const ff_state_def *state, const ff_conduct *conduct,
                    uint32_t goal)
{
    if (state->not_last && goal == conduct->last) return false;
    uint32_t capacity = behaviour->def.goals[goal].capacity;
    return capacity == 0 || behaviour->taken[goal] - (conduct->goal == goal) < capacity;
}

static double weight_of(const ff_behaviour *behaviour, const ff_state_def *state, uint32_t goal)
{
    return state->choice == FF_CHOOSE_WEIGHTED ? behaviour->def.goals[goal].weight : 1.0;
}

static uint32_t draw(const ff_behaviour *behaviour, const ff_state_def *state, const ff_goal_set_def *set,
                     ff_conduct *conduct)
{
    double sum = 0.0;
    uint32_t chosen = FF_NONE;
    for (uint32_t g = set->first_goal; g < set->first_goal + set->goal_count; ++g)
        if (is_free(behaviour, state, conduct, g)) sum += weight_of(behaviour, state, g);
    double left = sum * ff_random_unit(&(ff_random){conduct->key, STREAM_CHOICE, conduct->draws++});
    for (uint32_t g = set->first_goal; g < set->first_goal + set->goal_count && left >= 0.0; ++g) {
        if (!is_free(behaviour, state, conduct, g)) continue;
        chosen = g;
        left -= weight_of(behaviour, state, g);
    }
    return chosen;
}

/* The nearest or the farthest of those free; of equal ones the first. */
static uint32_t by_distance(const ff_behaviour *behaviour, const ff_state_def *state,
                            const ff_goal_set_def *set, ff_vec2 position, const ff_conduct *conduct)
{
    uint32_t best = FF_NONE;
    double sign = state->choice == FF_CHOOSE_NEAREST ? 1.0 : -1.0, least = INFINITY;
    for (uint32_t g = set->first_goal; g < set->first_goal + set->goal_count; ++g) {
        double distance = sign * ff_region_distance(&behaviour->def.goals[g].place, position);
        if (distance >= least || !is_free(behaviour, state, conduct, g)) continue;
        best = g;
        least = distance;
    }
    return best;
}

/* The one behind its last goal, or the first; those that are full are passed over. */
static uint32_t next_of(const ff_behaviour *behaviour, const ff_state_def *state, const ff_goal_set_def *set,
                        const ff_conduct *conduct)
{
    uint32_t last = conduct->last - set->first_goal; /* large when it is none of these */
    uint32_t next = last < set->goal_count ? last + 1 : 0;
    for (uint32_t i = 0; i < set->goal_count; ++i) {
        uint32_t g = set->first_goal + (next + i) % set->goal_count;
        if (is_free(behaviour, state, conduct, g)) return g;
    }
    return FF_NONE;
}

static uint32_t from_set(const ff_behaviour *behaviour, const ff_state_def *state, ff_vec2 position,
                         ff_conduct *conduct)
{
    const ff_goal_set_def *set = &behaviour->def.sets[state->from];
    if (state->choice == FF_CHOOSE_NEXT) return next_of(behaviour, state, set, conduct);
    if (state->choice == FF_CHOOSE_NEAREST || state->choice == FF_CHOOSE_FARTHEST)
        return by_distance(behaviour, state, set, position, conduct);
    return draw(behaviour, state, set, conduct);
}

bool ff_behave_choose(const ff_behaviour *behaviour, const ff_state_def *state, ff_vec2 position,
                      ff_conduct *conduct, ff_pick *out)
{
    *out = (ff_pick){FF_NONE, FF_NONE, position};
    switch (state->choice) {
    case FF_CHOOSE_SHARED:
        *out = (ff_pick){conduct->goal, conduct->set, conduct->place};
        return true;
    case FF_CHOOSE_MIRROR:
        out->place = ff_scale2(position, -1.0);
        return true;
    case FF_CHOOSE_OFFSET:
        out->place = ff_add2(position, state->offset);
        return true;
    case FF_CHOOSE_IDENTITY:
        return true;
    case FF_CHOOSE_EXPLICIT:
        out->goal = state->from;
        out->set = behaviour->set_of[state->from];
        return is_free(behaviour, state, conduct, out->goal);
    default:
        out->goal = from_set(behaviour, state, position, conduct);
        out->set = state->from;
        return out->goal != FF_NONE;
    }
}
