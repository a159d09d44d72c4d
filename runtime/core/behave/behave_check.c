/* Is a behaviour's definition usable? After this nothing has to check again. */
#include "runtime/core/base/fail.h"
#include "runtime/core/base/maths.h"
#include "runtime/core/behave/behave.h"

#include <stdlib.h>
#include <string.h>

#define COUNT_MAX 65536u
#define PLACE_MAX 1e6 /* m */
#define TIME_MAX 1e6  /* s */
#define VALUE_MAX 1e9

/* Refuse a record of an array of the definition. */
#define REFUSE(name, array, record, ...)                                                                     \
    ff_fail_section(error, FF_ERR_ARGUMENT, name,                                                            \
                    (uint64_t)((const char *)(record) - (const char *)def->array), __VA_ARGS__)

static bool fits(double value, double low, double high)
{
    return value >= low && value <= high; /* false for nan */
}

static bool range_fits(uint32_t first, uint32_t count, uint32_t total)
{
    return count <= total && first <= total - count;
}

static bool is_name(const char *name)
{
    return name[0] != 0 && memchr(name, 0, FF_NAME_SIZE) != NULL;
}

static bool is_place(ff_vec2 p)
{
    return fits(p.a, -PLACE_MAX, PLACE_MAX) && fits(p.b, -PLACE_MAX, PLACE_MAX);
}

static bool is_region(const ff_region *region)
{
    return region->shape <= FF_REGION_BOX && is_place(region->centre) &&
           fits(region->half.a, 0.0, PLACE_MAX) && fits(region->half.b, 0.0, PLACE_MAX) &&
           fits(region->heading, -1e3, 1e3);
}

static bool is_amount(const ff_amount *amount, double low, double high)
{
    if (amount->kind > FF_AMOUNT_NORMAL || !fits(amount->a, low, high)) return false;
    if (amount->kind == FF_AMOUNT_UNIFORM) return fits(amount->b, amount->a, high);
    return amount->kind == FF_AMOUNT_CONST || fits(amount->b, 0.0, high);
}

static ff_status check_goals(const ff_behaviour_def *def, ff_error *error)
{
    for (uint32_t i = 0; i < def->goal_count; ++i) {
        const ff_goal_def *goal = &def->goals[i];
        if (!is_name(goal->name)) return REFUSE("BGOA", goals, goal, "goal %u has no name", i);
        if (!is_region(&goal->place) || !is_place(goal->look_at))
            return REFUSE("BGOA", goals, goal, "goal %s is no place", goal->name);
        if (!fits(goal->weight, 1e-9, VALUE_MAX))
            return REFUSE("BGOA", goals, goal, "goal %s has a weight of %g; expected more than 0", goal->name,
                          goal->weight);
    }
    for (uint32_t i = 0; i < def->set_count; ++i) {
        const ff_goal_set_def *set = &def->sets[i];
        if (!is_name(set->name)) return REFUSE("BSET", sets, set, "set of goals %u has no name", i);
        if (set->goal_count == 0 || !range_fits(set->first_goal, set->goal_count, def->goal_count) ||
            set->exit > 1)
            return REFUSE("BSET", sets, set, "set %s has no goals, or some that are not there", set->name);
    }
    return FF_OK;
}

static ff_status check_world(const ff_behaviour_def *def, ff_error *error)
{
    for (uint32_t i = 0; i < def->region_count; ++i) {
        const ff_region_def *region = &def->regions[i];
        if (!is_name(region->name) || !is_region(&region->place))
            return REFUSE("BREG", regions, region, "region %u has no name or is no place", i);
    }
    for (uint32_t i = 0; i < def->phase_count; ++i) {
        const ff_phase_def *phase = &def->phases[i];
        if (!is_name(phase->name) || !fits(phase->seconds, 1e-3, TIME_MAX))
            return REFUSE("BPHA", phases, phase, "phase %u has no name or does not last", i);
    }
    for (uint32_t i = 0; i < def->signal_count; ++i) {
        const ff_signal_def *signal = &def->signals[i];
        if (!is_name(signal->name) || signal->phase_count == 0 || !fits(signal->passed, 0.0, TIME_MAX) ||
            !range_fits(signal->first_phase, signal->phase_count, def->phase_count))
            return REFUSE("BSIG", signals, signal, "signal %u has no name, no phases or no time", i);
    }
    if (def->variable_count > FF_VARIABLES)
        return ff_fail_section(error, FF_ERR_RANGE, "BVAR", 0, "%u variables; there can be %d",
                               def->variable_count, FF_VARIABLES);
    for (uint32_t i = 0; i < def->variable_count; ++i) {
        const ff_variable_def *variable = &def->variables[i];
        if (!is_name(variable->name) || !fits(variable->start, -VALUE_MAX, VALUE_MAX))
            return REFUSE("BVAR", variables, variable, "variable %u has no name or no number", i);
    }
    return FF_OK;
}

static bool property_fits(const ff_behaviour_def *def, uint32_t property)
{
    return property < FF_PROPERTY_VARIABLE + def->variable_count;
}

static bool operand_fits(const ff_behaviour_def *def, const ff_condition_def *c)
{
    bool exact = c->amount.kind == FF_AMOUNT_CONST;
    switch (c->kind) {
    case FF_IF_ALWAYS:
        return true;
    case FF_IF_ARRIVED:
        return exact && fits(c->amount.a, 0.05, 1e3);
    case FF_IF_TIMER:
        return is_amount(&c->amount, 0.0, TIME_MAX);
    case FF_IF_CHANCE:
        return exact && fits(c->amount.a, 0.0, 1e3);
    case FF_IF_INSIDE:
    case FF_IF_OUTSIDE:
        return c->index < def->region_count;
    case FF_IF_SIGNAL:
        return c->index < def->signal_count && c->value < def->signals[c->index].phase_count;
    case FF_IF_BLOCKED:
        return exact && fits(c->amount.a, 0.0, TIME_MAX);
    case FF_IF_LESS:
    case FF_IF_MORE:
        return property_fits(def, c->index) && exact && fits(c->amount.a, -VALUE_MAX, VALUE_MAX);
    case FF_IF_ALL:
    case FF_IF_ANY:
        return c->count > 0;
    case FF_IF_NOT:
        return c->count == 1;
    default:
        return false;
    }
}

/* Conditions make trees: each stands behind the one that it is part of, and is part of no other. */
static ff_status check_tree(const ff_behaviour_def *def, uint8_t *used, ff_error *error)
{
    for (uint32_t i = 0; i < def->transition_count; ++i) {
        uint32_t root = def->transitions[i].condition;
        if (root >= def->condition_count || used[root]++)
            return REFUSE("BTRA", transitions, &def->transitions[i],
                          "transition %u has no condition of its own", i);
    }
    for (uint32_t i = 0; i < def->condition_count; ++i) {
        const ff_condition_def *c = &def->conditions[i];
        if (!operand_fits(def, c))
            return REFUSE("BCON", conditions, c, "condition %u is of no known kind, or asks for nothing", i);
        if (c->kind < FF_IF_ALL) continue;
        bool behind = c->first > i && range_fits(c->first, c->count, def->condition_count);
        for (uint32_t k = 0; behind && k < c->count; ++k)
            behind = !used[c->first + k]++;
        if (!behind) return REFUSE("BCON", conditions, c, "the parts of condition %u are not its own", i);
    }
    return FF_OK;
}

static ff_status check_transitions(const ff_behaviour_def *def, ff_error *error)
{
    uint8_t *used = ff_calloc(def->condition_count, 1);
    if (!used) return ff_fail(error, FF_ERR_NO_MEMORY, "%u conditions", def->condition_count);
    ff_status status = check_tree(def, used, error);
    free(used);
    if (status != FF_OK) return status;
    for (uint32_t i = 0; i < def->transition_count; ++i) {
        const ff_transition_def *transition = &def->transitions[i];
        if (transition->target_count == 0 ||
            !range_fits(transition->first_target, transition->target_count, def->target_count))
            return REFUSE("BTRA", transitions, transition, "transition %u leads nowhere", i);
    }
    for (uint32_t i = 0; i < def->target_count; ++i) {
        const ff_target_def *target = &def->targets[i];
        if (target->state >= def->state_count || !fits(target->weight, 1e-9, VALUE_MAX))
            return REFUSE("BTGT", targets, target, "target %u is no state, or has no weight", i);
    }
    for (uint32_t i = 0; i < def->act_count; ++i) {
        const ff_act_def *act = &def->acts[i];
        if (act->kind > FF_ACT_SCALE || act->property < FF_PROPERTY_PREFERRED_SPEED ||
            !property_fits(def, act->property) || !is_amount(&act->amount, -VALUE_MAX, VALUE_MAX))
            return REFUSE("BACT", acts, act, "act %u changes nothing that can be changed", i);
    }
    return FF_OK;
}

static const char *wrong_state(const ff_behaviour_def *def, const ff_state_def *state)
{
    if (state->choice > FF_CHOOSE_IDENTITY || state->not_last > 1) return "chooses its goal in no known way";
    if (state->choice == FF_CHOOSE_EXPLICIT && state->from >= def->goal_count)
        return "wants a goal that is none";
    bool among = state->choice >= FF_CHOOSE_RANDOM && state->choice <= FF_CHOOSE_NEXT;
    if (among && state->from >= def->set_count) return "wants a goal of a set that is none";
    if (state->motion > FF_MOTION_STAND || state->face > FF_FACE_GOAL)
        return "moves or looks in no known way";
    if (!is_place(state->offset) || !is_place(state->face_at)) return "has a place that is none";
    if (!fits(state->speed, 0.05, 20.0)) return "has a factor of the speed out of 0.05 to 20";
    if (!range_fits(state->first_enter, state->enter_count, def->act_count) ||
        !range_fits(state->first_exit, state->exit_count, def->act_count))
        return "has acts that are not there";
    if (!range_fits(state->first_transition, state->transition_count, def->transition_count))
        return "has transitions that are not there";
    return NULL;
}

static ff_status check_states(const ff_behaviour_def *def, ff_error *error)
{
    for (uint32_t i = 0; i < def->state_count; ++i) {
        const ff_state_def *state = &def->states[i];
        if (!is_name(state->name)) return REFUSE("BSTA", states, state, "state %u has no name", i);
        const char *wrong = wrong_state(def, state);
        if (wrong) return REFUSE("BSTA", states, state, "state %s %s", state->name, wrong);
    }
    for (uint32_t i = 0; i < def->machine_count; ++i) {
        const ff_machine_def *machine = &def->machines[i];
        if (!is_name(machine->name) || machine->start >= def->state_count)
            return REFUSE("BMAC", machines, machine, "machine %u has no name or no state to start in", i);
    }
    for (uint32_t i = 0; i < def->spawner_count; ++i) {
        const ff_spawner_def *s = &def->spawners[i];
        if (!is_name(s->name) || !is_region(&s->place) || s->machine >= def->machine_count || s->regular > 1)
            return REFUSE("BSPW", spawners, s, "spawner %u has no name, no place or no machine", i);
        if (!fits(s->rate, 0.0, 1e3) || !fits(s->heading, -1e3, 1e3) ||
            !is_amount(&s->preferred_speed, 0.1, 4.0) || !is_amount(&s->radius, 0.05, 1.5))
            return REFUSE("BSPW", spawners, s, "spawner %s has a rate, heading, speed or radius out of range",
                          s->name);
    }
    return FF_OK;
}

ff_status ff_behaviour_check(const ff_behaviour_def *def, ff_error *error)
{
    if (!def) return ff_fail(error, FF_ERR_ARGUMENT, "no behaviour given");
    for (int i = 0; i < FF_BEHAVIOUR_ARRAYS; ++i) {
        uint32_t count = ff_behaviour_array_count(def, &ff_behaviour_arrays[i]);
        if (count > COUNT_MAX || (count > 0 && !ff_behaviour_array_data(def, &ff_behaviour_arrays[i])))
            return ff_fail_section(error, FF_ERR_RANGE, ff_behaviour_arrays[i].name, 0,
                                   "%u records; expected at most %u, and an array of them", count, COUNT_MAX);
    }
    ff_status status = check_goals(def, error);
    if (status == FF_OK) status = check_world(def, error);
    if (status == FF_OK) status = check_transitions(def, error);
    if (status == FF_OK) status = check_states(def, error);
    return status;
}
