/* A crowd's own copy of its behaviour. */
#include "runtime/core/base/fail.h"
#include "runtime/core/base/maths.h"
#include "runtime/core/behave/behave.h"

#include <stdlib.h>
#include <string.h>

#define ROW(name, list, number)                                                                              \
    {                                                                                                        \
        name, offsetof(ff_behaviour_def, list), offsetof(ff_behaviour_def, number),                          \
            sizeof *((ff_behaviour_def *)0)->list                                                            \
    }

const ff_behaviour_array ff_behaviour_arrays[FF_BEHAVIOUR_ARRAYS] = {
    ROW("BMAC", machines, machine_count),
    ROW("BSTA", states, state_count),
    ROW("BTRA", transitions, transition_count),
    ROW("BTGT", targets, target_count),
    ROW("BCON", conditions, condition_count),
    ROW("BACT", acts, act_count),
    ROW("BSET", sets, set_count),
    ROW("BGOA", goals, goal_count),
    ROW("BREG", regions, region_count),
    ROW("BSIG", signals, signal_count),
    ROW("BPHA", phases, phase_count),
    ROW("BVAR", variables, variable_count),
    ROW("BSPW", spawners, spawner_count),
};

/* Members are copied as bytes, as the pointers have different types. */
const void *ff_behaviour_array_data(const ff_behaviour_def *def, const ff_behaviour_array *array)
{
    const void *data;
    memcpy(&data, (const unsigned char *)def + array->pointer, sizeof data);
    return data;
}

uint32_t ff_behaviour_array_count(const ff_behaviour_def *def, const ff_behaviour_array *array)
{
    uint32_t count;
    memcpy(&count, (const unsigned char *)def + array->count, sizeof count);
    return count;
}

void ff_behaviour_array_set(ff_behaviour_def *def, const ff_behaviour_array *array, const void *data,
                            uint32_t count)
{
    memcpy((unsigned char *)def + array->pointer, &data, sizeof data);
    memcpy((unsigned char *)def + array->count, &count, sizeof count);
}

/* One block for all arrays; their records are multiples of 8 bytes. */
static ff_status copy_arrays(const ff_behaviour_def *def, ff_behaviour *copy, ff_error *error)
{
    size_t bytes = 0;
    for (int i = 0; i < FF_BEHAVIOUR_ARRAYS; ++i)
        bytes += ff_behaviour_array_count(def, &ff_behaviour_arrays[i]) * ff_behaviour_arrays[i].size;
    unsigned char *at = ff_calloc(bytes, 1);
    if (!at) return ff_fail(error, FF_ERR_NO_MEMORY, "a behaviour of %zu bytes", bytes);
    copy->block = at;
    for (int i = 0; i < FF_BEHAVIOUR_ARRAYS; ++i) {
        const ff_behaviour_array *array = &ff_behaviour_arrays[i];
        uint32_t count = ff_behaviour_array_count(def, array);
        size_t size = count * array->size;
        if (size > 0) memcpy(at, ff_behaviour_array_data(def, array), size);
        ff_behaviour_array_set(&copy->def, array, at, count);
        at += size;
    }
    return FF_OK;
}

/* The nearest that any condition below this one calls arrived; 0: none does. */
static double arrival_in(const ff_behaviour_def *def, uint32_t index)
{
    const ff_condition_def *condition = &def->conditions[index];
    if (condition->kind == FF_IF_ARRIVED) return condition->amount.a;
    double least = 0.0;
    if (condition->kind < FF_IF_ALL) return least;
    for (uint32_t i = 0; i < condition->count; ++i) {
        double below = arrival_in(def, condition->first + i);
        if (below > 0.0 && (least == 0.0 || below < least)) least = below;
    }
    return least;
}

static double arrival_of(const ff_behaviour_def *def, const ff_state_def *state)
{
    double least = 0.0;
    for (uint32_t t = 0; t < state->transition_count; ++t) {
        double here = arrival_in(def, def->transitions[state->first_transition + t].condition);
        if (here > 0.0 && (least == 0.0 || here < least)) least = here;
    }
    return least;
}

static void derive(ff_behaviour *behaviour)
{
    const ff_behaviour_def *def = &behaviour->def;
    for (uint32_t i = 0; i < def->goal_count; ++i)
        behaviour->set_of[i] = FF_NONE;
    for (uint32_t s = def->set_count; s-- > 0;)
        for (uint32_t i = 0; i < def->sets[s].goal_count; ++i)
            behaviour->set_of[def->sets[s].first_goal + i] = s;
    for (uint32_t i = 0; i < def->state_count; ++i)
        behaviour->tolerance[i] = arrival_of(def, &def->states[i]);
    for (uint32_t i = 0; i < def->signal_count; ++i)
        behaviour->shown[i] = FF_NONE;
    behaviour->fault.number = FF_NONE;
}

ff_status ff_behaviour_create(const ff_behaviour_def *def, ff_behaviour **out, ff_error *error)
{
    *out = NULL;
    ff_status status = ff_behaviour_check(def, error);
    if (status != FF_OK) return status;
    ff_behaviour *copy = ff_calloc(1, sizeof *copy);
    if (!copy) return ff_fail(error, FF_ERR_NO_MEMORY, "a behaviour");
    status = copy_arrays(def, copy, error);
    copy->set_of = ff_calloc(def->goal_count, sizeof *copy->set_of);
    copy->tolerance = ff_calloc(def->state_count, sizeof *copy->tolerance);
    copy->taken = ff_calloc(def->goal_count, sizeof *copy->taken);
    copy->shown = ff_calloc(def->signal_count, sizeof *copy->shown);
    copy->spawning = ff_calloc(def->spawner_count, sizeof *copy->spawning);
    if (status == FF_OK && !(copy->set_of && copy->tolerance && copy->taken && copy->shown && copy->spawning))
        status = ff_fail(error, FF_ERR_NO_MEMORY, "a behaviour of %u states and %u goals", def->state_count,
                         def->goal_count);
    if (status != FF_OK) {
        ff_behaviour_destroy(copy);
        return status;
    }
    derive(copy);
    *out = copy;
    return FF_OK;
}

void ff_behaviour_destroy(ff_behaviour *behaviour)
{
    if (!behaviour) return;
    free(behaviour->block);
    free(behaviour->set_of);
    free(behaviour->tolerance);
    free(behaviour->taken);
    free(behaviour->shown);
    free(behaviour->spawning);
    free(behaviour);
}
