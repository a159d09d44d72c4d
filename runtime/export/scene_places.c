/* scene_places.c - what there is in a scene for people to go by: goals, regions, signals, variables. */
#include "runtime/core/base/maths.h"
#include "runtime/export/scene_behaviour.h"

#include <stdio.h>
#include <string.h>

/* Go on only while nothing went wrong. */
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if (status == FF_OK) status = (call);                                                                \
    } while (0)

static const char *const goal_keys[] = {FF_REGION_KEYS, "name", "look_at", "weight", "capacity", NULL};
static const char *const set_keys[] = {"exit", "goals", NULL};
static const char *const region_keys[] = {FF_REGION_KEYS, NULL};
static const char *const signal_keys[] = {"phases", "passed", NULL};

/* ------------------------------------------------------------------------------------------------ goals */

/* Without a name it is called after its set: "booths 3". */
static ff_status name_goal(const ff_behaviour_reading *r, const json_t *object, const char *set,
                           size_t number, ff_goal_def *goal)
{
    const char *name = NULL;
    char usual[2 * FF_NAME_SIZE];
    snprintf(usual, sizeof usual, "%s %zu", set, number);
    ff_status status = ff_json_string(r->json, object, "name", &name, r->error);
    TRY(ff_take_name(r, object, name ? name : usual, goal->name));
    return status;
}

static ff_status refuse_double(const ff_behaviour_reading *r, const json_t *object, uint32_t index)
{
    const ff_goal_def *goals = r->out->goals.data;
    for (uint32_t i = 0; i < index; ++i)
        if (strcmp(goals[i].name, goals[index].name) == 0)
            return ff_json_fail(r->json, object, r->error,
                                "there are two goals \"%s\"; give them different names", goals[i].name);
    return FF_OK;
}

static ff_status read_goal(const ff_behaviour_reading *r, const json_t *goals, const char *set, size_t number,
                           uint32_t index)
{
    const json_t *object = json_array_get(goals, number - 1);
    if (!json_is_object(object))
        return ff_json_fail(r->json, ff_place_of(object, goals), r->error,
                            "a goal is {\"point\": [x, z], ...}");
    ff_goal_def *goal = (ff_goal_def *)r->out->goals.data + index;
    const json_t *look_at = json_object_get(object, "look_at");
    int64_t capacity = 0;
    double place[2];
    goal->weight = 1.0;
    ff_status status = ff_json_only_keys(r->json, object, goal_keys, r->error);
    TRY(name_goal(r, object, set, number, goal));
    TRY(refuse_double(r, object, index));
    TRY(ff_read_region(r, object, &goal->place));
    TRY(ff_json_number(r->json, object, "weight", 1e-6, 1e6, &goal->weight, r->error));
    TRY(ff_json_integer(r->json, object, "capacity", 0, 1000000, &capacity, r->error));
    goal->capacity = (uint32_t)capacity;
    goal->look_at = goal->place.centre;
    if (look_at) TRY(ff_read_metres(r, look_at, object, 2, "what is looked at as [x, z]", place));
    if (look_at && status == FF_OK) goal->look_at = ff_v2(place[1], place[0]);
    return status;
}

/* A list of goals, or {"exit": true, "goals": [...]}. */
static ff_status read_set(const ff_behaviour_reading *r, const json_t *sets, const char *name,
                          const json_t *value)
{
    uint32_t index, first;
    bool exit = false;
    const json_t *goals = json_is_object(value) ? json_object_get(value, "goals") : value;
    ff_status status = ff_grow_list(r, &r->out->sets, sizeof(ff_goal_set_def), 1, &index);
    if (json_is_object(value)) {
        TRY(ff_json_only_keys(r->json, value, set_keys, r->error));
        TRY(ff_json_bool(r->json, value, "exit", &exit, r->error));
    }
    if (status == FF_OK && (!json_is_array(goals) || json_array_size(goals) == 0))
        return ff_json_fail_key(
            r->json, sets, name, r->error,
            "a set of goals is a list of at least one, or {\"exit\": true, \"goals\": [...]}");
    TRY(ff_grow_list(r, &r->out->goals, sizeof(ff_goal_def), json_array_size(goals), &first));
    if (status != FF_OK) return status;
    ff_goal_set_def *set = (ff_goal_set_def *)r->out->sets.data + index;
    *set =
        (ff_goal_set_def){.first_goal = first, .goal_count = (uint32_t)json_array_size(goals), .exit = exit};
    TRY(ff_take_name(r, value, name, set->name));
    for (uint32_t i = 0; i < json_array_size(goals); ++i)
        TRY(read_goal(r, goals, name, i + 1, first + i));
    return status;
}

ff_status ff_read_goals(const ff_behaviour_reading *r)
{
    return ff_read_each(r, "goals", NULL, read_set);
}

/* ----------------------------------------------------------------------------------------------- others */

static ff_status read_region(const ff_behaviour_reading *r, const json_t *all, const char *name,
                             const json_t *value)
{
    (void)all;
    uint32_t index;
    ff_status status = ff_json_only_keys(r->json, value, region_keys, r->error);
    TRY(ff_grow_list(r, &r->out->regions, sizeof(ff_region_def), 1, &index));
    if (status != FF_OK) return status;
    ff_region_def *region = (ff_region_def *)r->out->regions.data + index;
    TRY(ff_take_name(r, value, name, region->name));
    TRY(ff_read_region(r, value, &region->place));
    return status;
}

ff_status ff_read_regions(const ff_behaviour_reading *r)
{
    return ff_read_each(r, "regions", "a region is {\"box\": [x1, z1, x2, z2]}", read_region);
}

/* [["walk", 20], ["stop", 8]] */
static ff_status read_phases(const ff_behaviour_reading *r, const json_t *signal, uint32_t index)
{
    const json_t *phases = json_object_get(signal, "phases");
    size_t count = json_array_size(phases);
    if (!json_is_array(phases) || count == 0)
        return ff_json_fail(r->json, signal, r->error,
                            "a signal needs \"phases\": a list of [name, seconds], at least one");
    uint32_t first;
    ff_status status = ff_grow_list(r, &r->out->phases, sizeof(ff_phase_def), count, &first);
    if (status != FF_OK) return status;
    ff_signal_def *def = (ff_signal_def *)r->out->signals.data + index;
    def->first_phase = first;
    def->phase_count = (uint32_t)count;
    for (size_t i = 0; i < count; ++i) {
        const json_t *item = json_array_get(phases, i);
        const char *name = json_string_value(json_array_get(item, 0));
        double seconds = json_number_value(json_array_get(item, 1));
        if (json_array_size(item) != 2 || !name || !(seconds >= 0.1 && seconds <= 1e5))
            return ff_json_fail(r->json, ff_place_of(item, phases), r->error,
                                "a phase is [name, seconds], of 0.1 s or more");
        ff_phase_def *phase = (ff_phase_def *)r->out->phases.data + first + i;
        phase->seconds = seconds;
        TRY(ff_take_name(r, item, name, phase->name));
    }
    return status;
}

static ff_status read_signal(const ff_behaviour_reading *r, const json_t *all, const char *name,
                             const json_t *value)
{
    (void)all;
    uint32_t index;
    ff_status status = ff_json_only_keys(r->json, value, signal_keys, r->error);
    TRY(ff_grow_list(r, &r->out->signals, sizeof(ff_signal_def), 1, &index));
    if (status != FF_OK) return status;
    ff_signal_def *signal = (ff_signal_def *)r->out->signals.data + index;
    TRY(ff_take_name(r, value, name, signal->name));
    TRY(ff_json_number(r->json, value, "passed", 0.0, 1e5, &signal->passed, r->error));
    TRY(read_phases(r, value, index));
    return status;
}

ff_status ff_read_signals(const ff_behaviour_reading *r)
{
    return ff_read_each(r, "signals", "a signal is {\"phases\": [[name, seconds]]}", read_signal);
}

static ff_status read_variable(const ff_behaviour_reading *r, const json_t *all, const char *name,
                               const json_t *value)
{
    (void)value;
    uint32_t index;
    double start = 0.0;
    ff_status status = ff_json_number(r->json, all, name, -1e6, 1e6, &start, r->error);
    TRY(ff_grow_list(r, &r->out->variables, sizeof(ff_variable_def), 1, &index));
    if (status != FF_OK) return status;
    ff_variable_def *variable = (ff_variable_def *)r->out->variables.data + index;
    variable->start = start;
    TRY(ff_take_name(r, all, name, variable->name));
    return status;
}

ff_status ff_read_variables(const ff_behaviour_reading *r)
{
    const json_t *variables = json_object_get(r->json->root, "variables");
    if (json_object_size(variables) > FF_VARIABLES)
        return ff_json_fail(r->json, variables, r->error, "%zu variables; there can be %d",
                            json_object_size(variables), FF_VARIABLES);
    return ff_read_each(r, "variables", NULL, read_variable);
}
#undef TRY
