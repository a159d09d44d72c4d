/* scene_groups.c - who begins where in a scene and follows which behaviour, and who comes later. */
#include "runtime/core/base/maths.h"
#include "runtime/export/scene_behaviour.h"

#include <stdio.h>

#define AGENTS_MOST 20000

/* Go on only while nothing went wrong. */
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if (status == FF_OK) status = (call);                                                                \
    } while (0)

static const char *const group_keys[] = {FF_REGION_KEYS, "behaviour",       "count", "preferred_speed",
                                         "radius",       "heading_degrees", NULL};
static const char *const spawner_keys[] = {
    FF_REGION_KEYS,    "name",   "behaviour",       "rate", "regular", "total", "most",
    "preferred_speed", "radius", "heading_degrees", NULL};

/* What groups and spawners have in common. */
typedef struct people {
    uint32_t machine;
    ff_region place;
    ff_amount preferred_speed, radius;
    double heading; /* rad; NAN: not given */
} people;

static ff_status read_people(const ff_behaviour_reading *r, const json_t *object, const ff_scene_usual *usual,
                             people *out)
{
    const json_t *speed = json_object_get(object, "preferred_speed"),
                 *radius = json_object_get(object, "radius");
    double degrees = NAN;
    *out = (people){.machine = FF_NONE,
                    .preferred_speed = {FF_AMOUNT_NORMAL, 0, usual->preferred_speed, usual->speed_spread},
                    .radius = {FF_AMOUNT_CONST, 0, usual->radius, 0.0}};
    ff_status status = ff_scene_machine_read(r->json, object, r->out, &out->machine, r->error);
    if (status == FF_OK && out->machine == FF_NONE)
        return ff_json_fail(r->json, object, r->error, "expected \"behaviour\": one of \"behaviours\"");
    TRY(ff_read_region(r, object, &out->place));
    if (speed)
        TRY(ff_read_amount(r, speed, object, "preferred_speed (m/s)", 0.1, 4.0, &out->preferred_speed));
    if (radius) TRY(ff_read_amount(r, radius, object, "radius (m)", 0.1, 1.0, &out->radius));
    TRY(ff_json_number(r->json, object, "heading_degrees", -360.0, 360.0, &degrees, r->error));
    out->heading = degrees * FF_DEG;
    return status;
}

/* The objects of a list under a key. */
static ff_status read_list(const ff_behaviour_reading *r, const char *key, const json_t **out)
{
    *out = json_object_get(r->json->root, key);
    if (*out && !json_is_array(*out))
        return ff_json_fail_key(r->json, r->json->root, key, r->error, "%s is a list of objects", key);
    for (size_t i = 0; i < json_array_size(*out); ++i)
        if (!json_is_object(json_array_get(*out, i)))
            return ff_json_fail(r->json, ff_place_of(json_array_get(*out, i), *out), r->error,
                                "%s is a list of objects", key);
    return FF_OK;
}

static ff_status read_spawner(const ff_behaviour_reading *r, const json_t *object, size_t number,
                              const ff_scene_usual *usual)
{
    people p;
    const char *name = NULL;
    char numbered[FF_NAME_SIZE];
    int64_t total = 0, most = 0;
    bool regular = false;
    double rate = NAN;
    uint32_t index;
    snprintf(numbered, sizeof numbered, "spawner %zu", number);
    ff_status status = ff_json_only_keys(r->json, object, spawner_keys, r->error);
    TRY(read_people(r, object, usual, &p));
    TRY(ff_json_string(r->json, object, "name", &name, r->error));
    TRY(ff_json_number(r->json, object, "rate", 0.0, 100.0, &rate, r->error));
    TRY(ff_json_bool(r->json, object, "regular", &regular, r->error));
    TRY(ff_json_integer(r->json, object, "total", 0, AGENTS_MOST, &total, r->error));
    TRY(ff_json_integer(r->json, object, "most", 0, AGENTS_MOST, &most, r->error));
    if (status == FF_OK && isnan(rate))
        return ff_json_fail(r->json, object, r->error, "a spawner needs \"rate\": how many people a second");
    TRY(ff_grow_list(r, &r->out->spawners, sizeof(ff_spawner_def), 1, &index));
    if (status != FF_OK) return status;
    ff_spawner_def *spawner = (ff_spawner_def *)r->out->spawners.data + index;
    *spawner = (ff_spawner_def){.place = p.place,
                                .machine = p.machine,
                                .regular = regular,
                                .total = (uint32_t)total,
                                .most = (uint32_t)most,
                                .rate = rate,
                                .heading = isnan(p.heading) ? 0.0 : p.heading,
                                .preferred_speed = p.preferred_speed,
                                .radius = p.radius};
    return ff_take_name(r, object, name ? name : numbered, spawner->name);
}

ff_status ff_read_spawners(const ff_behaviour_reading *r, const ff_scene_usual *usual)
{
    const json_t *list;
    ff_status status = read_list(r, "spawners", &list);
    for (size_t i = 0; i < json_array_size(list); ++i)
        TRY(read_spawner(r, json_array_get(list, i), i + 1, usual));
    return status;
}

ff_status ff_read_groups(const ff_behaviour_reading *r, const ff_scene_usual *usual, ff_array *groups)
{
    const json_t *list;
    ff_status status = read_list(r, "groups", &list);
    for (size_t i = 0; i < json_array_size(list); ++i) {
        const json_t *object = json_array_get(list, i);
        people p;
        uint32_t index;
        int64_t count = 1;
        TRY(ff_json_only_keys(r->json, object, group_keys, r->error));
        TRY(read_people(r, object, usual, &p));
        TRY(ff_json_integer(r->json, object, "count", 1, AGENTS_MOST, &count, r->error));
        TRY(ff_grow_list(r, groups, sizeof(ff_scene_group), 1, &index));
        if (status != FF_OK) return status;
        ((ff_scene_group *)groups->data)[index] =
            (ff_scene_group){p.machine, (uint32_t)count, p.place, p.preferred_speed, p.radius, p.heading};
    }
    return status;
}
#undef TRY
