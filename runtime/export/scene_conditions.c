/* scene_conditions.c - when a state ends: {"timer": [2, 4]}, {"all": [...]}, ... */
#include "runtime/export/scene_behaviour.h"

#include <string.h>

typedef struct kind_name {
    const char *name;
    ff_condition_kind kind;
    const char *expected; /* of what the value is */
} kind_name;

static const kind_name kinds[] = {
    {"arrived", FF_IF_ARRIVED, "a distance in m"},  {"timer", FF_IF_TIMER, "seconds"},
    {"chance", FF_IF_CHANCE, "how often a second"}, {"inside", FF_IF_INSIDE, "a region's name"},
    {"outside", FF_IF_OUTSIDE, "a region's name"},  {"signal", FF_IF_SIGNAL, "[signal, phase]"},
    {"blocked", FF_IF_BLOCKED, "seconds"},          {"less", FF_IF_LESS, "[property, number]"},
    {"more", FF_IF_MORE, "[property, number]"},     {"all", FF_IF_ALL, "a list of conditions"},
    {"any", FF_IF_ANY, "a list of conditions"},     {"not", FF_IF_NOT, "a condition"},
};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

static const char *const properties[] = {"speed",      "radius", "goal_distance",   "goal_number",
                                         "state_time", "age",    "preferred_speed", NULL};

ff_status ff_read_property(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                           uint32_t *out)
{
    const char *name = json_string_value(value);
    for (uint32_t i = 0; name && properties[i]; ++i) {
        if (strcmp(properties[i], name) != 0) continue;
        *out = i;
        return FF_OK;
    }
    uint32_t variable;
    ff_status status = ff_find_named(r, value, within, &r->out->variables, sizeof(ff_variable_def), 0,
                                     "property or variable", &variable);
    if (status == FF_OK) *out = FF_PROPERTY_VARIABLE + variable;
    return status;
}

static ff_status read_number(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                             const char *what, double low, double high, ff_condition_def *out)
{
    double number = json_number_value(value);
    if (!json_is_number(value) || !(number >= low && number <= high))
        return ff_json_fail(r->json, ff_place_of(value, within), r->error, "%s is a number from %g to %g",
                            what, low, high);
    out->amount.a = number;
    return FF_OK;
}

static ff_status read_signal(const ff_behaviour_reading *r, const json_t *value, ff_condition_def *out)
{
    if (json_array_size(value) != 2)
        return ff_json_fail(r->json, value, r->error, "expected [signal, phase], by their names");
    ff_status status = ff_find_named(r, json_array_get(value, 0), value, &r->out->signals,
                                     sizeof(ff_signal_def), 0, "signal", &out->index);
    if (status != FF_OK) return status;
    const ff_signal_def *signal = (const ff_signal_def *)r->out->signals.data + out->index;
    ff_array phases = {(ff_phase_def *)r->out->phases.data + signal->first_phase, signal->phase_count, 0};
    return ff_find_named(r, json_array_get(value, 1), value, &phases, sizeof(ff_phase_def), 0, "phase",
                         &out->value);
}

static ff_status read_comparison(const ff_behaviour_reading *r, const json_t *value, ff_condition_def *out)
{
    if (json_array_size(value) != 2)
        return ff_json_fail(r->json, value, r->error, "expected [property, number]");
    ff_status status = ff_read_property(r, json_array_get(value, 0), value, &out->index);
    return status == FF_OK
               ? read_number(r, json_array_get(value, 1), value, "what is compared with", -1e6, 1e6, out)
               : status;
}

/* What is no list of others. */
static ff_status read_plain(const ff_behaviour_reading *r, const json_t *value, ff_condition_def *out)
{
    switch (out->kind) {
    case FF_IF_ARRIVED:
        return read_number(r, value, value, "\"arrived\" (m)", 0.05, 1000.0, out);
    case FF_IF_TIMER:
        return ff_read_amount(r, value, value, "\"timer\" (s)", 0.0, 1e5, &out->amount);
    case FF_IF_CHANCE:
        return read_number(r, value, value, "\"chance\" (per s)", 0.0, 1000.0, out);
    case FF_IF_BLOCKED:
        return read_number(r, value, value, "\"blocked\" (s)", 0.0, 1e5, out);
    case FF_IF_INSIDE:
    case FF_IF_OUTSIDE:
        return ff_find_named(r, value, value, &r->out->regions, sizeof(ff_region_def), 0, "region",
                             &out->index);
    case FF_IF_SIGNAL:
        return read_signal(r, value, out);
    default:
        return read_comparison(r, value, out);
    }
}

static ff_status read_into(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                           uint32_t index);

static ff_status read_parts(const ff_behaviour_reading *r, const json_t *value, ff_condition_kind kind,
                            uint32_t index)
{
    size_t count = kind == FF_IF_NOT ? 1 : json_array_size(value);
    if (count == 0)
        return ff_json_fail(r->json, value, r->error, "expected a list of at least one condition");
    uint32_t first;
    ff_status status = ff_grow_list(r, &r->out->conditions, sizeof(ff_condition_def), count, &first);
    if (status != FF_OK) return status;
    ((ff_condition_def *)r->out->conditions.data)[index] =
        (ff_condition_def){.kind = kind, .first = first, .count = (uint32_t)count};
    for (uint32_t i = 0; i < count && status == FF_OK; ++i)
        status = read_into(r, kind == FF_IF_NOT ? value : json_array_get(value, i), value, first + i);
    return status;
}

static ff_status refuse(const ff_behaviour_reading *r, const json_t *value)
{
    return ff_json_fail(
        r->json, value, r->error,
        "a condition is \"always\" or one of {\"arrived\": m}, {\"timer\": s}, {\"chance\": per s}, "
        "{\"inside\": region}, {\"outside\": region}, {\"signal\": [signal, phase]}, {\"blocked\": s}, "
        "{\"less\": [property, number]}, {\"more\": ...}, {\"all\": [...]}, {\"any\": [...]}, "
        "{\"not\": condition}");
}

/* Recursion is as deep as the file nests, which jansson bounds. */
static ff_status read_into(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                           uint32_t index)
{
    ff_condition_def condition = {.kind = FF_IF_ALWAYS};
    const char *word = json_string_value(value);
    if (word && strcmp(word, "always") == 0) {
        ((ff_condition_def *)r->out->conditions.data)[index] = condition;
        return FF_OK;
    }
    if (json_object_size(value) != 1) return refuse(r, ff_place_of(value, within));
    const char *name = json_object_iter_key(json_object_iter((json_t *)value));
    const json_t *operand = json_object_get(value, name);
    for (int i = 0; i < KINDS; ++i) {
        if (strcmp(kinds[i].name, name) != 0) continue;
        if (json_is_boolean(operand) || json_is_null(operand))
            return ff_json_fail_key(r->json, value, name, r->error, "\"%s\" needs %s", name,
                                    kinds[i].expected);
        if (kinds[i].kind >= FF_IF_ALL) return read_parts(r, operand, kinds[i].kind, index);
        condition.kind = kinds[i].kind;
        ff_status status = read_plain(r, operand, &condition);
        ((ff_condition_def *)r->out->conditions.data)[index] = condition;
        return status;
    }
    return refuse(r, ff_place_of(value, within));
}

ff_status ff_read_condition(const ff_behaviour_reading *r, const json_t *value, const json_t *within,
                            uint32_t *out)
{
    ff_status status = ff_grow_list(r, &r->out->conditions, sizeof(ff_condition_def), 1, out);
    return status == FF_OK ? read_into(r, value, within, *out) : status;
}
