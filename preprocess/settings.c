#include "preprocess/settings.h"

#include "preprocess/pose_encode.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/pack_format.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

#define NUMBER(section, key, stage, unit, standard, low, high, what)                                         \
    {                                                                                                        \
#section, #key, FF_SETTING_NUMBER, stage, unit, standard, low, high, what,                           \
            offsetof(ff_settings, section.key)                                                               \
    }

#define WHOLE(section, key, stage, standard, low, high, what)                                                \
    {                                                                                                        \
#section, #key, FF_SETTING_WHOLE, stage, "", standard, low, high, what,                              \
            offsetof(ff_settings, section.key)                                                               \
    }

#define SWITCH(section, key, stage, standard, what)                                                          \
    {                                                                                                        \
#section, #key, FF_SETTING_SWITCH, stage, "", standard, 0.0, 1.0, what,                              \
            offsetof(ff_settings, section.key)                                                               \
    }

#define FILE_NAME(section, key, stage, what)                                                                 \
    {                                                                                                        \
#section, #key, FF_SETTING_FILE, stage, "", 0.0, 0.0, 1.0, what, offsetof(ff_settings, section.key)  \
    }

/* Settings of one section stand together. */
const ff_setting ff_setting_table[] = {
    FILE_NAME(rig, skeleton, FF_STAGE_PACK,
              "clip or skeleton file (.asf, .bvh, .gltf, .glb, .amc) whose body the pack has; else the "
              "median of all"),
    SWITCH(motion, clean, FF_STAGE_CUT, true, "planted feet are made to stand still"),
    NUMBER(poses, rate, FF_STAGE_PACK, "Hz", FF_PACK_RATE, 10.0, 240.0,
           "how often the report shows heights and speeds of feet"),
    NUMBER(poses, bytes, FF_STAGE_CUT, "bytes per second", FF_POSE_BYTES, 1000.0, 100000.0,
           "how many a clip's motion may take; smooth motion takes less"),
    WHOLE(actions, count, FF_STAGE_PACK, 0.0, 0.0, 100000.0,
          "how many actions the pack has, without mirror images; the best are chosen; 0 = all"),
    SWITCH(actions, derive, FF_STAGE_PACK, true,
           "starts, stops, turns on the spot and side steps are made up when no clip shows them"),
};
const int ff_setting_count = sizeof ff_setting_table / sizeof ff_setting_table[0];

static void *place_of(ff_settings *settings, const ff_setting *setting)
{
    return (char *)settings + setting->place;
}

double ff_setting_value(const ff_settings *settings, const ff_setting *setting)
{
    const void *place = (const char *)settings + setting->place;
    switch (setting->kind) {
    case FF_SETTING_WHOLE:
        return (double)*(const int64_t *)place;
    case FF_SETTING_SWITCH:
        return *(const bool *)place ? 1.0 : 0.0;
    case FF_SETTING_FILE:
        return *(const char *)place ? 1.0 : 0.0;
    default:
        return *(const double *)place;
    }
}

static void set_value(ff_settings *settings, const ff_setting *setting, double value)
{
    void *place = place_of(settings, setting);
    switch (setting->kind) {
    case FF_SETTING_WHOLE:
        *(int64_t *)place = (int64_t)value;
        break;
    case FF_SETTING_SWITCH:
        *(bool *)place = value != 0.0;
        break;
    case FF_SETTING_FILE:
        *(char *)place = '\0';
        break;
    default:
        *(double *)place = value;
    }
}

ff_settings ff_settings_default(void)
{
    ff_settings settings;
    memset(&settings, 0, sizeof settings);
    for (int i = 0; i < ff_setting_count; ++i)
        set_value(&settings, &ff_setting_table[i], ff_setting_table[i].standard);
    return settings;
}

uint64_t ff_settings_hash(const ff_settings *settings, ff_setting_stage up_to, uint64_t seed)
{
    for (int i = 0; i < ff_setting_count; ++i) {
        const ff_setting *s = &ff_setting_table[i];
        double value = ff_setting_value(settings, s);
        if (s->stage <= up_to && s->kind != FF_SETTING_FILE) seed = XXH64(&value, sizeof value, seed);
    }
    return seed;
}

static json_t *json_of(const ff_settings *settings, const ff_setting *setting)
{
    double value = ff_setting_value(settings, setting);
    const char *path = (const char *)settings + setting->place;
    switch (setting->kind) {
    case FF_SETTING_WHOLE:
        return json_integer((json_int_t)value);
    case FF_SETTING_SWITCH:
        return json_boolean(value != 0.0);
    case FF_SETTING_FILE:
        return json_string(strrchr(path, '/') ? strrchr(path, '/') + 1 : path);
    default:
        return json_real(value);
    }
}

json_t *ff_settings_json(const ff_settings *settings)
{
    json_t *root = json_object();
    for (int i = 0; i < ff_setting_count; ++i) {
        const ff_setting *s = &ff_setting_table[i];
        json_t *section = json_object_get(root, s->section);
        if (!section) {
            section = json_object();
            json_object_set_new(root, s->section, section);
        }
        json_object_set_new(section, s->key, json_of(settings, s));
    }
    return root;
}

/* ----------------------------------------------------------------------------------------------------- reading */

static bool is_comment(const char *key)
{
    return strncmp(key, "//", 2) == 0;
}

/* Refuse members that are neither in known (count names) nor comments, and comments that are no text. */
static ff_status check_keys(const ff_json *json, json_t *object, const char *const *known, size_t count,
                            ff_error *error)
{
    const char **allowed = ff_calloc(count + json_object_size(object) + 1, sizeof *allowed), *key;
    if (!allowed) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the configuration");
    memcpy(allowed, known, count * sizeof *allowed);
    json_t *value;
    ff_status status = FF_OK;
    json_object_foreach(object, key, value)
    {
        if (!is_comment(key)) continue;
        allowed[count++] = key;
        if (!json_is_string(value) && status == FF_OK)
            status = ff_json_fail_key(json, object, key, error,
                                      "a key that begins with // is a comment; its value must be a text");
    }
    if (status == FF_OK) status = ff_json_only_keys(json, object, allowed, error);
    free(allowed);
    return status;
}

/* A path of the document, relative to the document's folder. */
static ff_status read_path(const ff_json *json, const json_t *section, const char *key, char *out,
                           ff_error *error)
{
    const char *value = NULL, *slash = strrchr(json->path, '/');
    ff_status status = ff_json_string(json, section, key, &value, error);
    if (status != FF_OK || !value) return status;
    int folder = slash && *value && *value != '/' ? (int)(slash + 1 - json->path) : 0;
    int length = snprintf(out, FF_SETTING_PATH, "%.*s%s", folder, json->path, value);
    if (length < FF_SETTING_PATH) return FF_OK;
    return ff_json_fail(json, json_object_get(section, key), error, "\"%s\": a path of more than %d bytes",
                        key, FF_SETTING_PATH - 1);
}

static ff_status read_setting(const ff_json *json, const json_t *section, const ff_setting *setting,
                              ff_settings *out, ff_error *error)
{
    void *place = place_of(out, setting);
    switch (setting->kind) {
    case FF_SETTING_WHOLE:
        return ff_json_integer(json, section, setting->key, (int64_t)setting->low, (int64_t)setting->high,
                               place, error);
    case FF_SETTING_SWITCH:
        return ff_json_bool(json, section, setting->key, place, error);
    case FF_SETTING_FILE:
        return read_path(json, section, setting->key, place, error);
    default:
        return ff_json_number(json, section, setting->key, setting->low, setting->high, place, error);
    }
}

static ff_status read_section(const ff_json *json, json_t *root, const char *name, ff_settings *out,
                              ff_error *error)
{
    json_t *section = json_object_get(root, name);
    if (!section) return FF_OK;
    if (!json_is_object(section))
        return ff_json_fail_key(json, root, name, error, "\"%s\": expected an object { ... } of settings",
                                name);
    const char *keys[64];
    size_t count = 0;
    for (int i = 0; i < ff_setting_count && count < sizeof keys / sizeof keys[0]; ++i)
        if (strcmp(ff_setting_table[i].section, name) == 0) keys[count++] = ff_setting_table[i].key;
    ff_status status = check_keys(json, section, keys, count, error);
    for (int i = 0; i < ff_setting_count && status == FF_OK; ++i)
        if (strcmp(ff_setting_table[i].section, name) == 0)
            status = read_setting(json, section, &ff_setting_table[i], out, error);
    return status;
}

static ff_status read_root(const ff_json *json, ff_settings *out, ff_error *error)
{
    const char *sections[32];
    size_t count = 0;
    for (int i = 0; i < ff_setting_count && count < sizeof sections / sizeof sections[0]; ++i)
        if (i == 0 || strcmp(ff_setting_table[i].section, sections[count - 1]) != 0)
            sections[count++] = ff_setting_table[i].section;
    ff_status status = check_keys(json, json->root, sections, count, error);
    for (size_t i = 0; i < count && status == FF_OK; ++i)
        status = read_section(json, json->root, sections[i], out, error);
    return status;
}

ff_status ff_settings_parse(const char *text, size_t size, const char *name, ff_settings *out,
                            ff_error *error)
{
    ff_json json;
    ff_settings read = ff_settings_default();
    ff_status status = ff_json_parse(text, size, name, &json, error);
    if (status != FF_OK) return status;
    status = read_root(&json, &read, error);
    ff_json_free(&json);
    if (status == FF_OK) *out = read;
    return status;
}

ff_status ff_settings_load(const char *path, ff_settings *out, ff_error *error)
{
    ff_file file;
    ff_status status = ff_file_map(path, &file, error);
    if (status != FF_OK) return status;
    status = ff_settings_parse(file.data, file.size, path, out, error);
    ff_file_unmap(&file);
    return status;
}
