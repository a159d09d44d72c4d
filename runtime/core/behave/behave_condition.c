/* Which transition of an agent's state holds. Nothing is remembered for that: what is drawn (a timer's seconds, whether a
 * chance comes) is a function of the agent's key, the number of states that it has entered, and the condition. */
#include "runtime/core/behave/behave.h"

/* Streams of an agent's key. */
enum { STREAM_TIMER = 1, STREAM_CHANCE = 2 };

static double seconds_in_state(const ff_behave_view *view)
{
    return (double)(view->step - view->conduct->entered) * view->dt;
}

double ff_behave_property(const ff_behave_view *view, uint32_t property)
{
    const ff_conduct *conduct = view->conduct;
    switch (property) {
    case FF_PROPERTY_SPEED:
        return view->speed;
    case FF_PROPERTY_RADIUS:
        return view->radius;
    case FF_PROPERTY_GOAL_DISTANCE:
        return ff_length2(ff_sub2(conduct->place, view->position));
    case FF_PROPERTY_GOAL_NUMBER:
        if (conduct->goal == FF_NONE || conduct->set == FF_NONE) return -1.0;
        return conduct->goal - view->behaviour->def.sets[conduct->set].first_goal;
    case FF_PROPERTY_STATE_TIME:
        return seconds_in_state(view);
    case FF_PROPERTY_AGE:
        return (double)(view->step - conduct->born) * view->dt;
    case FF_PROPERTY_PREFERRED_SPEED:
        return conduct->speed;
    default:
        return conduct->variable[property - FF_PROPERTY_VARIABLE];
    }
}

uint32_t ff_behave_phase(const ff_behaviour *behaviour, uint32_t signal, double time)
{
    const ff_signal_def *def = &behaviour->def.signals[signal];
    if (behaviour->shown[signal] != FF_NONE) return behaviour->shown[signal];
    const ff_phase_def *phases = &behaviour->def.phases[def->first_phase];
    double round = 0.0, left = time + def->passed;
    for (uint32_t i = 0; i < def->phase_count; ++i)
        round += phases[i].seconds;
    left -= floor(left / round) * round;
    for (uint32_t i = 0; i + 1 < def->phase_count; ++i) {
        if (left < phases[i].seconds) return i;
        left -= phases[i].seconds;
    }
    return def->phase_count - 1;
}

static bool timer_is_over(const ff_behave_view *view, uint32_t index, const ff_amount *amount)
{
    ff_random random = {view->conduct->key + STREAM_TIMER, view->conduct->entries, (uint64_t)index << 8};
    /* Half a step early rather than late: steps are added up. */
    return seconds_in_state(view) + 0.5 * view->dt > ff_amount_draw(amount, &random) ||
           (amount->kind == FF_AMOUNT_CONST && amount->a == 0.0);
}

static bool chance_comes(const ff_behave_view *view, uint32_t index, double rate)
{
    uint64_t stream = view->conduct->entries << 16 ^ index;
    ff_random random = {view->conduct->key + STREAM_CHANCE, stream, view->step};
    return ff_random_unit(&random) < 1.0 - ff_exp(-rate * view->dt);
}

static bool has_arrived(const ff_behave_view *view, double distance)
{
    ff_vec2 gap = ff_sub2(view->conduct->place, view->position);
    return view->settled || ff_dot2(gap, gap) <= distance * distance;
}

static bool holds(const ff_behave_view *view, uint32_t index);

/* Whether any of the parts holds, or any does not. */
static bool any_is(const ff_behave_view *view, const ff_condition_def *condition, bool wanted)
{
    for (uint32_t i = 0; i < condition->count; ++i)
        if (holds(view, condition->first + i) == wanted) return true;
    return false;
}

static bool holds(const ff_behave_view *view, uint32_t index)
{
    const ff_behaviour_def *def = &view->behaviour->def;
    const ff_condition_def *c = &def->conditions[index];
    switch (c->kind) {
    case FF_IF_ALWAYS:
        return true;
    case FF_IF_ARRIVED:
        return has_arrived(view, c->amount.a);
    case FF_IF_TIMER:
        return timer_is_over(view, index, &c->amount);
    case FF_IF_CHANCE:
        return chance_comes(view, index, c->amount.a);
    case FF_IF_INSIDE:
        return ff_region_distance(&def->regions[c->index].place, view->position) <= 0.0;
    case FF_IF_OUTSIDE:
        return ff_region_distance(&def->regions[c->index].place, view->position) > 0.0;
    case FF_IF_SIGNAL:
        return ff_behave_phase(view->behaviour, c->index, (double)view->step * view->dt) == c->value;
    case FF_IF_BLOCKED:
        return view->conduct->blocked >= c->amount.a;
    case FF_IF_LESS:
        return ff_behave_property(view, c->index) < c->amount.a;
    case FF_IF_MORE:
        return ff_behave_property(view, c->index) > c->amount.a;
    case FF_IF_ALL:
        return !any_is(view, c, false);
    case FF_IF_ANY:
        return any_is(view, c, true);
    default:
        return any_is(view, c, false); /* not */
    }
}

uint32_t ff_behave_find(const ff_behave_view *view, uint32_t first)
{
    const ff_state_def *state = &view->behaviour->def.states[view->conduct->state];
    for (uint32_t t = first; t < state->transition_count; ++t)
        if (holds(view, view->behaviour->def.transitions[state->first_transition + t].condition)) return t;
    return FF_NONE;
}
