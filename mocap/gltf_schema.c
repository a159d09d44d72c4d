/* A glTF document reduced to the members that are read, each of the type the specification gives it. */
#include "mocap/gltf_guard.h"
#include "runtime/tool/json.h"

#include <limits.h>
#include <string.h>

typedef enum kind { INTEGER, FLAG, TEXT, NUMBERS, INTEGERS, OBJECT, OBJECTS, ATTRIBUTES } kind;

typedef struct member {
    const char *key; /* NULL ends a list */
    kind kind;
    bool needed;
    int count;               /* of NUMBERS; most of the others, 0 = as many as there are */
    const struct member *of; /* OBJECT, OBJECTS */
} member;

/* Far more than any real file has, few enough to be safe. */
enum { MANY = 1 << 20 };

static const member node[] = {{"name", TEXT, false, 0, NULL},
                              {"children", INTEGERS, false, MANY, NULL},
                              {"matrix", NUMBERS, false, 16, NULL},
                              {"translation", NUMBERS, false, 3, NULL},
                              {"rotation", NUMBERS, false, 4, NULL},
                              {"scale", NUMBERS, false, 3, NULL},
                              {"mesh", INTEGER, false, 0, NULL},
                              {"skin", INTEGER, false, 0, NULL},
                              {0}};
static const member skin[] = {{"name", TEXT, false, 0, NULL},
                              {"joints", INTEGERS, true, MANY, NULL},
                              {"inverseBindMatrices", INTEGER, false, 0, NULL},
                              {0}};
static const member target[] = {{"node", INTEGER, false, 0, NULL}, {"path", TEXT, true, 0, NULL}, {0}};
static const member channel[] = {
    {"sampler", INTEGER, true, 0, NULL}, {"target", OBJECT, true, 0, target}, {0}};
static const member sampler[] = {{"input", INTEGER, true, 0, NULL},
                                 {"output", INTEGER, true, 0, NULL},
                                 {"interpolation", TEXT, false, 0, NULL},
                                 {0}};
static const member animation[] = {{"name", TEXT, false, 0, NULL},
                                   {"channels", OBJECTS, true, MANY, channel},
                                   {"samplers", OBJECTS, true, MANY, sampler},
                                   {0}};
static const member sparse_indices[] = {{"bufferView", INTEGER, true, 0, NULL},
                                        {"byteOffset", INTEGER, false, 0, NULL},
                                        {"componentType", INTEGER, true, 0, NULL},
                                        {0}};
static const member sparse_values[] = {
    {"bufferView", INTEGER, true, 0, NULL}, {"byteOffset", INTEGER, false, 0, NULL}, {0}};
static const member sparse[] = {{"count", INTEGER, true, 0, NULL},
                                {"indices", OBJECT, true, 0, sparse_indices},
                                {"values", OBJECT, true, 0, sparse_values},
                                {0}};
static const member accessor[] = {
    {"bufferView", INTEGER, false, 0, NULL},   {"byteOffset", INTEGER, false, 0, NULL},
    {"componentType", INTEGER, true, 0, NULL}, {"normalized", FLAG, false, 0, NULL},
    {"count", INTEGER, true, 0, NULL},         {"type", TEXT, true, 0, NULL},
    {"sparse", OBJECT, false, 0, sparse},      {0}};
static const member view[] = {{"buffer", INTEGER, true, 0, NULL},
                              {"byteOffset", INTEGER, false, 0, NULL},
                              {"byteLength", INTEGER, true, 0, NULL},
                              {"byteStride", INTEGER, false, 0, NULL},
                              {0}};
static const member buffer[] = {{"byteLength", INTEGER, true, 0, NULL}, {"uri", TEXT, false, 0, NULL}, {0}};
static const member primitive[] = {{"attributes", ATTRIBUTES, true, 0, NULL},
                                   {"indices", INTEGER, false, 0, NULL},
                                   {"mode", INTEGER, false, 0, NULL},
                                   {0}};
static const member mesh[] = {
    {"name", TEXT, false, 0, NULL}, {"primitives", OBJECTS, true, MANY, primitive}, {0}};
static const member asset[] = {{"version", TEXT, true, 0, NULL}, {0}};
static const member root[] = {{"asset", OBJECT, true, 0, asset},
                              {"nodes", OBJECTS, true, MANY, node},
                              {"skins", OBJECTS, false, MANY, skin},
                              {"animations", OBJECTS, false, MANY, animation},
                              {"accessors", OBJECTS, false, MANY, accessor},
                              {"bufferViews", OBJECTS, false, MANY, view},
                              {"buffers", OBJECTS, false, FF_GLTF_MOST_BUFFERS, buffer},
                              {"meshes", OBJECTS, false, MANY, mesh},
                              {0}};

/* Attributes that a skin is made of. */
static const char *const attributes[] = {"POSITION", "NORMAL",    "TEXCOORD_0",
                                         "JOINTS_0", "WEIGHTS_0", "JOINTS_1"};

typedef struct reducer {
    const ff_json *json;
    ff_error *error;
} reducer;

static ff_status refuse(const reducer *r, const json_t *holder, const member *m, const char *expected)
{
    return ff_json_fail_key(r->json, holder, m->key, r->error, "%s: expected %s", m->key, expected);
}

static bool whole(const json_t *value)
{
    return json_is_integer(value) && json_integer_value(value) >= 0 && json_integer_value(value) <= INT_MAX;
}

static ff_status take_object(const reducer *r, const json_t *from, const member *members, json_t **out);

static ff_status take_list(const reducer *r, const json_t *holder, const json_t *value, const member *m,
                           json_t **out)
{
    if (!json_is_array(value)) return refuse(r, holder, m, "a list");
    size_t count = json_array_size(value);
    if (m->kind == NUMBERS && count != (size_t)m->count)
        return ff_json_fail_key(r->json, holder, m->key, r->error, "%s: %zu numbers where %d belong", m->key,
                                count, m->count);
    if (count > (size_t)m->count)
        return ff_json_fail_key(r->json, holder, m->key, r->error,
                                "%s: %zu entries are absurd (at most %d are read)", m->key, count, m->count);
    for (size_t i = 0; m->kind != OBJECTS && i < count; ++i) {
        const json_t *item = json_array_get(value, i);
        if (m->kind == NUMBERS ? !json_is_number(item) : !whole(item))
            return refuse(r, holder, m,
                          m->kind == NUMBERS ? "numbers" : "whole numbers that are not negative");
    }
    *out = m->kind == OBJECTS ? json_array() : json_copy((json_t *)(uintptr_t)value);
    for (size_t i = 0; *out && m->kind == OBJECTS && i < count; ++i) {
        const json_t *item = json_array_get(value, i);
        if (!json_is_object(item)) return refuse(r, holder, m, "a list of objects");
        json_t *reduced = NULL;
        ff_status status = take_object(r, item, m->of, &reduced);
        if (status != FF_OK) return status;
        if (json_array_append_new(*out, reduced) != 0) *out = NULL;
    }
    return FF_OK;
}

static ff_status take_attributes(const reducer *r, const json_t *holder, const json_t *value, const member *m,
                                 json_t **out)
{
    if (!json_is_object(value)) return refuse(r, holder, m, "an object");
    *out = json_object();
    for (size_t i = 0; *out && i < sizeof attributes / sizeof attributes[0]; ++i) {
        json_t *index = json_object_get(value, attributes[i]);
        if (!index) continue;
        if (!whole(index))
            return ff_json_fail_key(r->json, value, attributes[i], r->error,
                                    "%s: expected the index of an accessor", attributes[i]);
        if (json_object_set(*out, attributes[i], index) != 0) return FF_OK;
    }
    return FF_OK;
}

static ff_status take_member(const reducer *r, const json_t *holder, json_t *value, const member *m,
                             json_t **out)
{
    switch (m->kind) {
    case INTEGER:
        if (!whole(value)) return refuse(r, holder, m, "a whole number from 0 to 2147483647");
        *out = json_incref(value);
        return FF_OK;
    case FLAG:
        if (!json_is_boolean(value)) return refuse(r, holder, m, "true or false");
        *out = json_incref(value);
        return FF_OK;
    case TEXT:
        if (!json_is_string(value)) return refuse(r, holder, m, "text");
        *out = json_string(json_string_value(value)); /* a copy: the guard rewrites some */
        return FF_OK;
    case OBJECT:
        if (!json_is_object(value)) return refuse(r, holder, m, "an object");
        return take_object(r, value, m->of, out);
    case ATTRIBUTES:
        return take_attributes(r, holder, value, m, out);
    default:
        return take_list(r, holder, value, m, out);
    }
}

static ff_status take_object(const reducer *r, const json_t *from, const member *members, json_t **out)
{
    *out = json_object();
    ff_status status = FF_OK;
    for (const member *m = members; *out && m->key && status == FF_OK; ++m) {
        json_t *value = json_object_get(from, m->key), *taken = NULL;
        if (!value && m->needed) {
            status = ff_json_fail(r->json, from, r->error, "\"%s\" is missing here", m->key);
        } else if (value) {
            status = take_member(r, from, value, m, &taken);
            if (status != FF_OK) {
                json_decref(taken);
            } else if (!taken || json_object_set_new(*out, m->key, taken) != 0) {
                status = ff_json_fail(r->json, from, r->error, "no memory for the document");
            }
        }
    }
    if (*out && status == FF_OK) return FF_OK;
    if (!*out) status = ff_json_fail(r->json, from, r->error, "no memory for the document");
    json_decref(*out);
    *out = NULL;
    return status;
}

/* Extensions that change what buffers or nodes hold: without them the rest would be misread. */
static ff_status refuse_extensions(const reducer *r)
{
    static const char *const unreadable[] = {"EXT_meshopt_compression", "KHR_meshopt_compression",
                                             "KHR_gaussian_splatting"};
    const json_t *required = json_object_get(r->json->root, "extensionsRequired");
    for (size_t i = 0; i < json_array_size(required); ++i) {
        const char *name = json_string_value(json_array_get(required, i));
        for (size_t k = 0; name && k < sizeof unreadable / sizeof unreadable[0]; ++k)
            if (strcmp(name, unreadable[k]) == 0)
                return ff_json_fail(r->json, json_array_get(required, i), r->error,
                                    "%s is required and not supported: export without compression", name);
    }
    return FF_OK;
}

ff_status ff_gltf_reduce(const ff_json *json, const json_t *from, json_t **out, ff_error *error)
{
    reducer r = {json, error};
    *out = NULL;
    ff_status status = refuse_extensions(&r);
    if (status == FF_OK) status = take_object(&r, from, root, out);
    if (status != FF_OK) return status;
    const char *version = json_string_value(json_object_get(json_object_get(*out, "asset"), "version"));
    if (version && strncmp(version, "2.", 2) == 0) return FF_OK;
    status = ff_json_fail_key(json, json_object_get(json->root, "asset"), "version", error,
                              "glTF %s: only version 2 is read", version ? version : "");
    json_decref(*out);
    *out = NULL;
    return status;
}
