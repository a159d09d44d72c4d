#include "runtime/export/scene_behaviour.h"

#include "runtime/core/base/maths.h"
#include "runtime/tool/nearest.h"

#include <stdio.h>
#include <string.h>

#define WORLD_MOST 10000.0 /* m */
#define CHOICES_MOST 64    /* names that are compared with a misspelt one */

/* Go on only while nothing went wrong. */
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if (status == FF_OK) status = (call);                                                                \
    } while (0)

/* ------------------------------------------------------------------------------------------------ lists */

ff_status ff_grow_list(const ff_behaviour_reading *r, ff_array *list, size_t size, size_t count,
                       uint32_t *out)
{
    *out = (uint32_t)list->count;
    void *first = ff_array_grow(list, count, size);
    if (!first) return ff_fail(r->error, FF_ERR_NO_MEMORY, "no memory for a scene's behaviour");
    memset(first, 0, count * size);
    return FF_OK;
}

typedef struct list_of {
    size_t offset, size; /* in ff_scene_behaviour; of a record */
} list_of;

static const list_of lists[] = {
    {offsetof(ff_scene_behaviour, machines), sizeof(ff_machine_def)},
    {offsetof(ff_scene_behaviour, states), sizeof(ff_state_def)},
    {offsetof(ff_scene_behaviour, transitions), sizeof(ff_transition_def)},
    {offsetof(ff_scene_behaviour, targets), sizeof(ff_target_def)},
    {offsetof(ff_scene_behaviour, conditions), sizeof(ff_condition_def)},
    {offsetof(ff_scene_behaviour, acts), sizeof(ff_act_def)},
    {offsetof(ff_scene_behaviour, sets), sizeof(ff_goal_set_def)},
    {offsetof(ff_scene_behaviour, goals), sizeof(ff_goal_def)},
    {offsetof(ff_scene_behaviour, regions), sizeof(ff_region_def)},
    {offsetof(ff_scene_behaviour, signals), sizeof(ff_signal_def)},
    {offsetof(ff_scene_behaviour, phases), sizeof(ff_phase_def)},
    {offsetof(ff_scene_behaviour, variables), sizeof(ff_variable_def)},
    {offsetof(ff_scene_behaviour, spawners), sizeof(ff_spawner_def)},
};
enum { LISTS = sizeof lists / sizeof lists[0] };
_Static_assert(sizeof(ff_scene_behaviour) == LISTS * sizeof(ff_array), "a list is missing here");

void ff_scene_behaviour_free(ff_scene_behaviour *behaviour)
{
    for (int i = 0; i < LISTS; ++i)
        ff_array_free((ff_array *)(void *)((char *)behaviour + lists[i].offset));
}

ff_status ff_scene_behaviour_copy(const ff_scene_behaviour *from, ff_scene_behaviour *to, ff_error *error)
{
    memset(to, 0, sizeof *to);
    for (int i = 0; i < LISTS; ++i) {
        const ff_array *list = (const ff_array *)(const void *)((const char *)from + lists[i].offset);
        ff_array *copy = (ff_array *)(void *)((char *)to + lists[i].offset);
        if (list->count == 0) continue;
        void *data = ff_array_grow(copy, list->count, lists[i].size);
        if (!data) {
            ff_scene_behaviour_free(to);
            return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a scene's behaviour");
        }
        memcpy(data, list->data, list->count * lists[i].size);
    }
    return FF_OK;
}

ff_behaviour_def ff_scene_behaviour_def(const ff_scene_behaviour *b)
{
    return (ff_behaviour_def){.machines = b->machines.data,
                              .machine_count = (uint32_t)b->machines.count,
                              .states = b->states.data,
                              .state_count = (uint32_t)b->states.count,
                              .transitions = b->transitions.data,
                              .transition_count = (uint32_t)b->transitions.count,
                              .targets = b->targets.data,
                              .target_count = (uint32_t)b->targets.count,
                              .conditions = b->conditions.data,
                              .condition_count = (uint32_t)b->conditions.count,
                              .acts = b->acts.data,
                              .act_count = (uint32_t)b->acts.count,
                              .sets = b->sets.data,
                              .set_count = (uint32_t)b->sets.count,
                              .goals = b->goals.data,
                              .goal_count = (uint32_t)b->goals.count,
                              .regions = b->regions.data,
                              .region_count = (uint32_t)b->regions.count,
                              .signals = b->signals.data,
                              .signal_count = (uint32_t)b->signals.count,
                              .phases = b->phases.data,
                              .phase_count = (uint32_t)b->phases.count,
                              .variables = b->variables.data,
                              .variable_count = (uint32_t)b->variables.count,
                              .spawners = b->spawners.data,
                              .spawner_count = (uint32_t)b->spawners.count};
}

/* ------------------------------------------------------------------------------------------------ names */

ff_status ff_take_name(const ff_behaviour_reading *r, const json_t *at, const char *name,
                       char out[FF_NAME_SIZE])
{
    size_t length = strlen(name);
    if (length == 0 || length >= FF_NAME_SIZE)
        return ff_json_fail(r->json, at, r->error, "the name \"%s\" has %zu bytes; names have 1 to %d", name,
                            length, FF_NAME_SIZE - 1);
    memcpy(out, name, length + 1);
    return FF_OK;
}

static const char *name_in(const ff_array *list, size_t size, uint32_t index)
{
    return (const char *)list->data + index * size;
}

ff_status ff_find_named(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                        const ff_array *list, size_t size, uint32_t first, const char *kind, uint32_t *out)
{
    const char *name = json_string_value(value), *choices[CHOICES_MOST + 1];
    if (!name)
        return ff_json_fail(r->json, ff_place_of(value, within), r->error, "expected the name of a %s", kind);
    size_t count = 0;
    for (uint32_t i = first; i < list->count; ++i) {
        const char *known = name_in(list, size, i);
        if (strcmp(known, name) == 0) {
            *out = i;
            return FF_OK;
        }
        if (count < CHOICES_MOST) choices[count++] = known;
    }
    choices[count] = NULL;
    const char *near = ff_nearest(name, choices);
    return ff_json_fail(r->json, value, r->error, "there is no %s \"%s\"%s%s%s", kind, name,
                        near ? "; did you mean \"" : "", near ? near : "", near ? "\"?" : "");
}

ff_status ff_scene_machine_read(const ff_json *json, const json_t *object,
                                const ff_scene_behaviour *behaviour, uint32_t *machine, ff_error *error)
{
    const json_t *value = json_object_get(object, "behaviour");
    const ff_behaviour_reading r = {json, NULL, error};
    if (!value) return FF_OK;
    if (!json_is_string(value))
        return ff_json_fail_key(json, object, "behaviour", error,
                                "behaviour is the name of one of \"behaviours\"");
    return ff_find_named(&r, value, object, &behaviour->machines, sizeof(ff_machine_def), 0, "behaviour",
                         machine);
}

/* ---------------------------------------------------------------------------------------------- numbers */

ff_status ff_read_each(const ff_behaviour_reading *r, const char *key, const char *what, ff_read_named *read)
{
    json_t *all = json_object_get(r->json->root, key), *value;
    const char *name;
    ff_status status = FF_OK;
    if (all && !json_is_object(all))
        return ff_json_fail_key(r->json, r->json->root, key, r->error, "%s is an object", key);
    json_object_foreach(all, name, value)
    {
        if (status == FF_OK && what && !json_is_object(value))
            return ff_json_fail_key(r->json, all, name, r->error, "%s", what);
        if (status == FF_OK) status = read(r, all, name, value);
    }
    return status;
}

ff_status ff_read_metres(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                         size_t count, const char *what, double *out)
{
    if (!json_is_array(value) || json_array_size(value) != count)
        return ff_json_fail(r->json, ff_place_of(value, within), r->error, "expected %s", what);
    for (size_t i = 0; i < count; ++i) {
        const json_t *item = json_array_get(value, i);
        out[i] = json_number_value(item);
        if (!json_is_number(item) || !(fabs(out[i]) <= WORLD_MOST))
            return ff_json_fail(r->json, value, r->error, "expected %s, each a number of metres up to %g",
                                what, WORLD_MOST);
    }
    return FF_OK;
}

static ff_status read_box(const ff_behaviour_reading *r, const json_t *object, const json_t *box,
                          ff_region *out)
{
    double sides[4], degrees = 0.0;
    ff_status status = ff_read_metres(r, box, object, 4, "a box as [x1, z1, x2, z2]", sides);
    TRY(ff_json_number(r->json, object, "turned_degrees", -360.0, 360.0, &degrees, r->error));
    if (status != FF_OK) return status;
    *out = (ff_region){.shape = FF_REGION_BOX,
                       .centre = ff_v2(0.5 * (sides[1] + sides[3]), 0.5 * (sides[0] + sides[2])),
                       .half = ff_v2(0.5 * fabs(sides[3] - sides[1]), 0.5 * fabs(sides[2] - sides[0])),
                       .heading = degrees * FF_DEG};
    return FF_OK;
}

ff_status ff_read_region(const ff_behaviour_reading *r, const json_t *object, ff_region *out)
{
    const json_t *point = json_object_get(object, "point"), *circle = json_object_get(object, "circle");
    const json_t *box = json_object_get(object, "box");
    double numbers[3] = {0.0};
    if (!!point + !!circle + !!box != 1)
        return ff_json_fail(
            r->json, object, r->error,
            "a place is one of \"point\": [x, z], \"circle\": [x, z, radius] and \"box\": [x1, z1, x2, z2]");
    if (!box && json_object_get(object, "turned_degrees"))
        return ff_json_fail_key(r->json, object, "turned_degrees", r->error, "only a box can be turned");
    if (box) return read_box(r, object, box, out);
    ff_status status = point ? ff_read_metres(r, point, object, 2, "a point as [x, z]", numbers)
                             : ff_read_metres(r, circle, object, 3, "a circle as [x, z, radius]", numbers);
    if (status == FF_OK && numbers[2] < 0.0)
        return ff_json_fail(r->json, circle, r->error, "a circle's radius is not negative");
    *out = (ff_region){.shape = point ? FF_REGION_POINT : FF_REGION_CIRCLE,
                       .centre = ff_v2(numbers[1], numbers[0]),
                       .half = ff_v2(numbers[2], 0.0)};
    return status;
}

static bool in_range(const json_t *value, double low, double high)
{
    double number = json_number_value(value);
    return json_is_number(value) && number >= low && number <= high;
}

ff_status ff_read_amount(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                         const char *what, double low, double high, ff_amount *out)
{
    static const char *const keys[] = {"mean", "deviation", NULL};
    const json_t *first = value, *second = NULL;
    out->kind = FF_AMOUNT_CONST;
    if (json_is_array(value) && json_array_size(value) == 2) {
        out->kind = FF_AMOUNT_UNIFORM;
        first = json_array_get(value, 0);
        second = json_array_get(value, 1);
    } else if (json_is_object(value)) {
        ff_status status = ff_json_only_keys(r->json, value, keys, r->error);
        if (status != FF_OK) return status;
        out->kind = FF_AMOUNT_NORMAL;
        first = json_object_get(value, "mean");
        second = json_object_get(value, "deviation");
    }
    double least =
        out->kind == FF_AMOUNT_UNIFORM && in_range(first, low, high) ? json_number_value(first) : 0.0;
    bool fits = in_range(first, low, high) && (out->kind == FF_AMOUNT_CONST || in_range(second, least, high));
    if (!fits)
        return ff_json_fail(
            r->json, ff_place_of(value, within), r->error,
            "%s is a number from %g to %g, or [low, high], or {\"mean\": ..., \"deviation\": ...}", what, low,
            high);
    out->a = json_number_value(first);
    out->b = second ? json_number_value(second) : 0.0;
    return FF_OK;
}

ff_status ff_scene_behaviour_read(const ff_json *json, const ff_scene_usual *usual, ff_scene_behaviour *out,
                                  ff_array *groups, ff_error *error)
{
    const ff_behaviour_reading r = {json, out, error};
    ff_status status = ff_read_goals(&r);
    TRY(ff_read_regions(&r));
    TRY(ff_read_signals(&r));
    TRY(ff_read_variables(&r));
    TRY(ff_read_machines(&r));
    TRY(ff_read_spawners(&r, usual));
    TRY(ff_read_groups(&r, usual, groups));
    if (status != FF_OK) return status;
    /* What the reader lets through a crowd would take: this can only be a number at the edge of a range. */
    ff_behaviour_def def = ff_scene_behaviour_def(out);
    return ff_behaviour_check(&def, error);
}
#undef TRY
