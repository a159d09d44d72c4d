/* scene_navigation.c - the keys of a scene that say how everyone finds their way. */
#include "runtime/core/base/maths.h"
#include "runtime/export/scene.h"

#include <string.h>

static const char *const method_names[] = {"", "mcn", "orca", "sf", NULL};
static const char *const synthesis_names[] = {"", "blending", "semi-procedural", "hybrid", NULL};
static const char *const facing_names[] = {"halfway", "strafe", "preferred", "command", NULL};
static const char *const mcn_keys[] = {
    "hull",     "sharp_turn", "stance",     "forces", "density",    "weighted", "gradual",    "lean",
    "progress", "make_way",   "back_pedal", "facing", "keep_right", "padding",  "prediction", NULL};
static const char *const baseline_keys[] = {"keep_right", "padding", "model_velocity", NULL};

const char *ff_navigation_name(ff_navigation navigation)
{
    return method_names[navigation];
}

const char *ff_synthesis_name(ff_synthesis synthesis)
{
    return synthesis_names[synthesis];
}

ff_synthesis ff_synthesis_named(const char *name)
{
    for (int i = 1; synthesis_names[i]; ++i)
        if (strcmp(name, synthesis_names[i]) == 0) return (ff_synthesis)i;
    return FF_SYNTHESIS_CROWD;
}

ff_scene_navigation ff_scene_navigation_default(void)
{
    ff_crowd_def def = ff_crowd_def_default();
    return (ff_scene_navigation){.method = def.navigation,
                                 .synthesis = def.synthesis,
                                 .planner = def.planner,
                                 .body_scale = def.body_scale,
                                 .keep_right = def.keep_right,
                                 .mcn = def.mcn,
                                 .baseline = def.baseline};
}

/* Go on only while nothing went wrong. */
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if (status == FF_OK) status = (call);                                                                \
    } while (0)

/* One of names, by its place in the list; *out stays when the key is absent. */
static ff_status read_name(const ff_json *json, const json_t *object, const char *key,
                           const char *const *names, const char *expected, int *out, ff_error *error)
{
    const char *name = NULL;
    ff_status status = ff_json_string(json, object, key, &name, error);
    if (status != FF_OK || !name) return status;
    for (int i = 0; names[i]; ++i) {
        if (names[i][0] && strcmp(name, names[i]) == 0) {
            *out = i;
            return FF_OK;
        }
    }
    return ff_json_fail_key(json, object, key, error, "%s is \"%s\"; it can be %s", key, name, expected);
}

ff_status ff_scene_method_read(const ff_json *json, const json_t *object, ff_navigation *out, ff_error *error)
{
    int method = (int)*out;
    ff_status status =
        read_name(json, object, "navigation", method_names, "\"mcn\", \"orca\" or \"sf\"", &method, error);
    *out = (ff_navigation)method;
    return status;
}

ff_status ff_scene_synthesis_read(const ff_json *json, const json_t *object, ff_synthesis *out,
                                  ff_error *error)
{
    int synthesis = (int)*out;
    ff_status status = read_name(json, object, "synthesis", synthesis_names,
                                 "\"blending\", \"semi-procedural\" or \"hybrid\"", &synthesis, error);
    *out = (ff_synthesis)synthesis;
    return status;
}

static ff_status read_part(const ff_json *json, const char *key, const char *const *keys, const json_t **out,
                           ff_error *error)
{
    *out = json_object_get(json->root, key);
    if (!*out) return FF_OK;
    if (!json_is_object(*out))
        return ff_json_fail_key(json, json->root, key, error, "%s is an object of settings", key);
    return ff_json_only_keys(json, *out, keys, error);
}

static ff_status read_mcn(const ff_json *json, ff_scene_navigation *out, ff_error *error)
{
    const json_t *part;
    ff_mcn_def *mcn = &out->mcn;
    ff_status status = read_part(json, "mcn", mcn_keys, &part, error);
    if (status != FF_OK || !part) return status;
    bool *const switches[] = {&mcn->hull,     &mcn->sharp_turn, &mcn->stance,    &mcn->forces,
                              &mcn->density,  &mcn->weighted,   &mcn->gradual,   &mcn->lean,
                              &mcn->progress, &mcn->make_way,   &mcn->back_pedal};
    for (size_t i = 0; i < sizeof switches / sizeof *switches; ++i)
        TRY(ff_json_bool(json, part, mcn_keys[i], switches[i], error));
    int facing = (int)mcn->facing;
    TRY(read_name(json, part, "facing", facing_names, "\"halfway\", \"strafe\", \"preferred\" or \"command\"",
                  &facing, error));
    mcn->facing = (ff_facing)facing;
    TRY(ff_json_number(json, part, "keep_right", -1.5, 1.5, &out->keep_right, error));
    TRY(ff_json_number(json, part, "padding", 0.0, 0.5, &mcn->padding, error));
    TRY(ff_json_number(json, part, "prediction", 0.0, 1.0, &mcn->prediction, error));
    return status;
}

ff_status ff_scene_navigation_read(const ff_json *json, ff_scene_navigation *out, ff_error *error)
{
    const json_t *part = NULL;
    ff_status status = ff_scene_method_read(json, json->root, &out->method, error);
    TRY(ff_scene_synthesis_read(json, json->root, &out->synthesis, error));
    TRY(ff_scene_planner_read(json, json->root, &out->planner, error));
    TRY(ff_scene_speeds_read(json, out->speed_variations, error));
    TRY(ff_json_number(json, json->root, "body_scale", 0.0, 0.15, &out->body_scale, error));
    TRY(read_mcn(json, out, error));
    TRY(read_part(json, "baseline", baseline_keys, &part, error));
    if (status != FF_OK || !part) return status;
    TRY(ff_json_number(json, part, "keep_right", -1.5, 1.5, &out->baseline.keep_right, error));
    TRY(ff_json_number(json, part, "padding", 0.0, 0.5, &out->baseline.padding, error));
    TRY(ff_json_bool(json, part, "model_velocity", &out->baseline.model_velocity, error));
    return status;
}
#undef TRY
