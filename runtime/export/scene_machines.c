/* scene_machines.c - "behaviours" of a scene: states, what they do, and what leads from one to another. */
#include "runtime/core/base/maths.h"
#include "runtime/export/scene_behaviour.h"

#include <string.h>

/* Go on only while nothing went wrong. */
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if (status == FF_OK) status = (call);                                                                \
    } while (0)

static const char *const machine_keys[] = {"start", "states", NULL};
static const char *const state_keys[] = {"goal", "move", "speed", "face", "enter", "exit", "next", NULL};
static const char *const transition_keys[] = {"when", "to", NULL};
static const char *const act_keys[] = {"set", "add", "scale", "value", NULL};
static const char *const heading_keys[] = {"heading_degrees", NULL};

/* A state under way, by index: lists move when they grow. */
typedef struct state_reading {
    const ff_behaviour_reading *r;
    const json_t *object;
    uint32_t index, machine_first; /* states of the same machine begin there */
} state_reading;

static ff_state_def *state_of(const state_reading *s)
{
    return (ff_state_def *)s->r->out->states.data + s->index;
}

/* ------------------------------------------------------------------------------------------ goal, motion */

typedef struct choice_name {
    const char *name;
    ff_goal_choice choice;
} choice_name;

static const choice_name lone_choices[] = {
    {"shared", FF_CHOOSE_SHARED}, {"mirror", FF_CHOOSE_MIRROR}, {"identity", FF_CHOOSE_IDENTITY}};
static const choice_name set_choices[] = {{"random", FF_CHOOSE_RANDOM},   {"weighted", FF_CHOOSE_WEIGHTED},
                                          {"nearest", FF_CHOOSE_NEAREST}, {"farthest", FF_CHOOSE_FARTHEST},
                                          {"next", FF_CHOOSE_NEXT},       {"explicit", FF_CHOOSE_EXPLICIT},
                                          {"offset", FF_CHOOSE_OFFSET}};

static ff_status refuse_choice(const state_reading *s)
{
    return ff_json_fail_key(
        s->r->json, s->object, "goal", s->r->error,
        "a goal is \"shared\", \"mirror\" or \"identity\", or one of {\"explicit\": goal}, "
        "{\"random\": set}, {\"weighted\": set}, {\"nearest\": set}, {\"farthest\": set}, "
        "{\"next\": set}, {\"offset\": [x, z]}; from a set also with \"not_last\": true");
}

static ff_status read_operand(const state_reading *s, const json_t *goal, const json_t *operand,
                              ff_state_def *out)
{
    const ff_behaviour_reading *r = s->r;
    double offset[2];
    if (out->choice == FF_CHOOSE_EXPLICIT)
        return ff_find_named(r, operand, goal, &r->out->goals, sizeof(ff_goal_def), 0, "goal", &out->from);
    if (out->choice != FF_CHOOSE_OFFSET)
        return ff_find_named(r, operand, goal, &r->out->sets, sizeof(ff_goal_set_def), 0, "set of goals",
                             &out->from);
    ff_status status = ff_read_metres(r, operand, goal, 2, "an offset as [x, z]", offset);
    if (status == FF_OK) out->offset = ff_v2(offset[1], offset[0]);
    return status;
}

static ff_status read_choice(const state_reading *s)
{
    const json_t *goal = json_object_get(s->object, "goal");
    const char *word = json_string_value(goal);
    ff_state_def *state = state_of(s);
    if (!goal) return FF_OK; /* shared */
    for (size_t i = 0; word && i < sizeof lone_choices / sizeof lone_choices[0]; ++i) {
        if (strcmp(word, lone_choices[i].name) != 0) continue;
        state->choice = lone_choices[i].choice;
        return FF_OK;
    }
    bool not_last = false;
    ff_status status = ff_json_bool(s->r->json, goal, "not_last", &not_last, s->r->error);
    if (status != FF_OK || !json_is_object(goal)) return status != FF_OK ? status : refuse_choice(s);
    for (size_t i = 0; i < sizeof set_choices / sizeof set_choices[0]; ++i) {
        const json_t *operand = json_object_get(goal, set_choices[i].name);
        if (!operand) continue;
        bool one = json_object_size(goal) == 1u + (json_object_get(goal, "not_last") != NULL);
        bool from_set =
            set_choices[i].choice <= FF_CHOOSE_NEXT && set_choices[i].choice != FF_CHOOSE_EXPLICIT;
        if (!one || (not_last && !from_set)) return refuse_choice(s);
        state->choice = set_choices[i].choice;
        state->not_last = not_last;
        return read_operand(s, goal, operand, state);
    }
    return refuse_choice(s);
}

static ff_status read_motion(const state_reading *s)
{
    const char *move = "goal";
    ff_state_def *state = state_of(s);
    ff_status status = ff_json_string(s->r->json, s->object, "move", &move, s->r->error);
    state->speed = 1.0;
    TRY(ff_json_number(s->r->json, s->object, "speed", 0.05, 20.0, &state->speed, s->r->error));
    if (status != FF_OK) return status;
    bool face = strcmp(move, "face") == 0;
    if (strcmp(move, "goal") != 0 && strcmp(move, "stand") != 0 && !face)
        return ff_json_fail(
            s->r->json, json_object_get(s->object, "move"), s->r->error,
            "move is \"%s\"; it can be \"goal\" (walk there), \"stand\" or \"face\" (stand and look at "
            "what the goal is for)",
            move);
    state->motion = strcmp(move, "goal") == 0 ? FF_MOTION_GOAL : FF_MOTION_STAND;
    if (face) state->face = FF_FACE_GOAL;
    return FF_OK;
}

/* "goal", [x, z] or {"heading_degrees": d} */
static ff_status read_face(const state_reading *s)
{
    const json_t *face = json_object_get(s->object, "face");
    const char *word = json_string_value(face);
    ff_state_def *state = state_of(s);
    double place[2], degrees = NAN;
    if (!face) return FF_OK;
    if (json_is_object(face)) {
        ff_status status = ff_json_only_keys(s->r->json, face, heading_keys, s->r->error);
        TRY(ff_json_number(s->r->json, face, "heading_degrees", -360.0, 360.0, &degrees, s->r->error));
        if (status == FF_OK && isnan(degrees))
            status = ff_json_fail(s->r->json, face, s->r->error, "expected {\"heading_degrees\": d}");
        if (status != FF_OK) return status;
        state->face = FF_FACE_HEADING;
        state->face_at = ff_fwd2(degrees * FF_DEG);
        return FF_OK;
    }
    if (word && strcmp(word, "goal") == 0) {
        state->face = FF_FACE_GOAL;
        return FF_OK;
    }
    ff_status status = ff_read_metres(s->r, face, s->object, 2,
                                      "\"goal\", a point as [x, z], or {\"heading_degrees\": d}", place);
    state->face = FF_FACE_POINT;
    if (status == FF_OK) state->face_at = ff_v2(place[1], place[0]);
    return status;
}

/* ------------------------------------------------------------------------------------------------- acts */

static ff_status read_act(const ff_behaviour_reading *r, const json_t *list, const json_t *object,
                          uint32_t index)
{
    static const char *const names[3] = {"set", "add", "scale"};
    ff_act_def act = {0};
    uint32_t found = 0;
    const json_t *property = NULL;
    if (!json_is_object(object))
        return ff_json_fail(r->json, ff_place_of(object, list), r->error,
                            "an act is {\"set\": what, \"value\": number}, or with \"add\" or \"scale\"");
    ff_status status = ff_json_only_keys(r->json, object, act_keys, r->error);
    for (uint32_t kind = 0; kind < 3; ++kind) {
        if (!json_object_get(object, names[kind])) continue;
        ++found;
        act.kind = kind;
        property = json_object_get(object, names[kind]);
    }
    if (status == FF_OK && (found != 1 || !json_object_get(object, "value")))
        return ff_json_fail(r->json, object, r->error,
                            "an act is {\"set\": what, \"value\": number}, or with \"add\" or \"scale\"");
    TRY(ff_read_property(r, property, object, &act.property));
    if (status == FF_OK && act.property < FF_PROPERTY_PREFERRED_SPEED)
        return ff_json_fail(r->json, property, r->error,
                            "\"%s\" can be asked for but not changed; preferred_speed and variables can",
                            json_string_value(property));
    TRY(ff_read_amount(r, json_object_get(object, "value"), object, "\"value\"", -1e6, 1e6, &act.amount));
    ((ff_act_def *)r->out->acts.data)[index] = act;
    return status;
}

static ff_status read_acts(const state_reading *s, const char *key, uint32_t *first, uint32_t *count)
{
    const json_t *list = json_object_get(s->object, key);
    if (!list) return FF_OK;
    if (!json_is_array(list))
        return ff_json_fail_key(s->r->json, s->object, key, s->r->error, "%s is a list of acts", key);
    *count = (uint32_t)json_array_size(list);
    ff_status status = ff_grow_list(s->r, &s->r->out->acts, sizeof(ff_act_def), *count, first);
    for (uint32_t i = 0; i < *count; ++i)
        TRY(read_act(s->r, list, json_array_get(list, i), *first + i));
    return status;
}

/* ------------------------------------------------------------------------------------------ transitions */

/* The states of one machine, as a list of their own. */
static ff_status find_state(const state_reading *s, const json_t *name, const json_t *within, uint32_t *out)
{
    return ff_find_named(s->r, name, within, &s->r->out->states, sizeof(ff_state_def), s->machine_first,
                         "state", out);
}

/* "state" or {"state": weight, ...} */
static ff_status read_targets(const state_reading *s, const json_t *transition, uint32_t index)
{
    const json_t *to = json_object_get(transition, "to");
    size_t count = json_is_object(to) ? json_object_size(to) : 1;
    if (count == 0 || !(json_is_object(to) || json_is_string(to)))
        return ff_json_fail(s->r->json, transition, s->r->error,
                            "\"to\" is a state, or {\"state\": weight, \"other\": weight}");
    uint32_t first, n = 0;
    ff_status status = ff_grow_list(s->r, &s->r->out->targets, sizeof(ff_target_def), count, &first);
    if (status != FF_OK) return status;
    ff_transition_def *def = (ff_transition_def *)s->r->out->transitions.data + index;
    def->first_target = first;
    def->target_count = (uint32_t)count;
    ff_target_def *targets = (ff_target_def *)s->r->out->targets.data + first;
    targets[0].weight = 1.0;
    if (json_is_string(to)) return find_state(s, to, transition, &targets[0].state);
    const char *name;
    json_t *weight;
    json_object_foreach((json_t *)to, name, weight)
    {
        json_t *text = json_string(name);
        if (!text) return ff_fail(s->r->error, FF_ERR_NO_MEMORY, "no memory for a scene's behaviour");
        TRY(ff_json_number(s->r->json, to, name, 1e-6, 1e6, &targets[n].weight, s->r->error));
        if (status == FF_OK && find_state(s, text, to, &targets[n].state) != FF_OK) {
            char message[sizeof s->r->error->message];
            memcpy(message, s->r->error->message, sizeof message);
            status = ff_json_fail_key(s->r->json, to, name, s->r->error, "%s", message);
        }
        json_decref(text);
        ++n;
    }
    return status;
}

static ff_status read_transition(const state_reading *s, const json_t *list, const json_t *object,
                                 uint32_t index)
{
    uint32_t condition = 0;
    if (!json_is_object(object))
        return ff_json_fail(s->r->json, ff_place_of(object, list), s->r->error,
                            "a transition is {\"when\": condition, \"to\": state}");
    ff_status status = ff_json_only_keys(s->r->json, object, transition_keys, s->r->error);
    TRY(ff_read_condition(s->r, json_object_get(object, "when"), object, &condition));
    if (status != FF_OK) return status;
    ((ff_transition_def *)s->r->out->transitions.data)[index].condition = condition;
    return read_targets(s, object, index);
}

static ff_status read_transitions(const state_reading *s)
{
    const json_t *list = json_object_get(s->object, "next");
    if (!list) return FF_OK;
    if (!json_is_array(list))
        return ff_json_fail_key(s->r->json, s->object, "next", s->r->error,
                                "next is a list of {\"when\": condition, \"to\": state}");
    uint32_t first, count = (uint32_t)json_array_size(list);
    ff_status status = ff_grow_list(s->r, &s->r->out->transitions, sizeof(ff_transition_def), count, &first);
    if (status != FF_OK) return status;
    state_of(s)->first_transition = first;
    state_of(s)->transition_count = count;
    for (uint32_t i = 0; i < count; ++i)
        TRY(read_transition(s, list, json_array_get(list, i), first + i));
    return status;
}

/* --------------------------------------------------------------------------------------------- machines */

static ff_status read_state(const state_reading *s)
{
    uint32_t first[2] = {0}, count[2] = {0};
    ff_status status = ff_json_only_keys(s->r->json, s->object, state_keys, s->r->error);
    TRY(read_choice(s));
    TRY(read_motion(s));
    TRY(read_face(s));
    TRY(read_acts(s, "enter", &first[0], &count[0]));
    TRY(read_acts(s, "exit", &first[1], &count[1]));
    ff_state_def *state = state_of(s);
    state->first_enter = first[0], state->enter_count = count[0];
    state->first_exit = first[1], state->exit_count = count[1];
    TRY(read_transitions(s));
    return status;
}

/* All states get their names first, as transitions lead forward too. */
static ff_status name_states(const ff_behaviour_reading *r, const json_t *states, uint32_t *first)
{
    const char *name;
    json_t *value;
    ff_status status =
        ff_grow_list(r, &r->out->states, sizeof(ff_state_def), json_object_size(states), first);
    uint32_t index = *first;
    json_object_foreach((json_t *)states, name, value)
    {
        if (status == FF_OK && !json_is_object(value))
            return ff_json_fail_key(r->json, states, name, r->error, "a state is an object");
        if (status == FF_OK)
            status = ff_take_name(r, value, name, ((ff_state_def *)r->out->states.data)[index++].name);
    }
    return status;
}

static ff_status read_machine(const ff_behaviour_reading *r, const json_t *all, const char *name,
                              const json_t *object)
{
    (void)all;
    const json_t *states = json_object_get(object, "states"), *start = json_object_get(object, "start");
    uint32_t first, index;
    ff_status status = ff_json_only_keys(r->json, object, machine_keys, r->error);
    if (status == FF_OK && (json_object_size(states) == 0 || !json_is_string(start)))
        return ff_json_fail(
            r->json, object, r->error,
            "a behaviour needs \"states\" and the one to \"start\" in: {\"start\": \"Walk\", \"states\": "
            "{\"Walk\": {...}}}");
    TRY(name_states(r, states, &first));
    TRY(ff_grow_list(r, &r->out->machines, sizeof(ff_machine_def), 1, &index));
    if (status != FF_OK) return status;
    state_reading s = {r, object, first, first};
    ff_machine_def *machine = (ff_machine_def *)r->out->machines.data + index;
    TRY(ff_take_name(r, object, name, machine->name));
    TRY(find_state(&s, start, object, &machine->start));
    const char *state_name;
    json_t *value;
    json_object_foreach((json_t *)states, state_name, value)
    {
        s.object = value;
        TRY(read_state(&s));
        ++s.index;
    }
    return status;
}

ff_status ff_read_machines(const ff_behaviour_reading *r)
{
    return ff_read_each(r, "behaviours", "a behaviour is an object", read_machine);
}
#undef TRY
