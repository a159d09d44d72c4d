/* A catalogue file. Every key is described in mocap/README.md; anything else is an error with its line. */
#define _POSIX_C_SOURCE 200809L
#include "mocap/catalogue_build.h"
#include "runtime/core/base/file.h"
#include "runtime/tool/json.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

typedef struct reader {
    ff_catalogue_builder *builder;
    ff_json json;
    const char *folder; /* the clips' */
    ff_error *error;
} reader;

static const char *const modes[] = {"",     "walk",   "run",   "idle",  "jump",
                                    "turn", "crouch", "climb", "start", "stop"};

static ff_status fail_memory(reader *r)
{
    return ff_json_fail(&r->json, r->json.root, r->error, "no memory for the catalogue");
}

/* Text of a key that is kept; leaves *out alone when the key is absent. */
static ff_status keep_string(reader *r, const json_t *object, const char *key, char **out)
{
    const char *text = NULL;
    ff_status status = ff_json_string(&r->json, object, key, &text, r->error);
    if (status != FF_OK || !text) return status;
    char *kept = ff_catalogue_keep_text(r->builder, text);
    if (!kept) return fail_memory(r);
    *out = kept;
    return FF_OK;
}

static ff_status read_unit(reader *r, const json_t *object, double *out)
{
    const json_t *value = json_object_get(object, "unit");
    if (!value) return FF_OK;
    if (json_is_number(value)) return ff_json_number(&r->json, object, "unit", 1e-6, 1e3, out, r->error);
    double unit = json_is_string(value) ? ff_unit_preset(json_string_value(value)) : 0.0;
    if (!(unit > 0.0))
        return ff_json_fail(&r->json, value, r->error,
                            "unit: expected \"cmu\", \"m\", \"cm\", \"mm\", \"inch\" or a number of metres");
    *out = unit;
    return FF_OK;
}

static ff_status read_up(reader *r, const json_t *object, char *out)
{
    const char *up = NULL;
    ff_status status = ff_json_string(&r->json, object, "up", &up, r->error);
    if (status != FF_OK || !up) return status;
    if (strcmp(up, "y") != 0 && strcmp(up, "z") != 0)
        return ff_json_fail_key(&r->json, object, "up", r->error, "up: expected \"y\" or \"z\"");
    *out = *up;
    return FF_OK;
}

static ff_status read_mode(reader *r, const json_t *object, char **out)
{
    ff_status status = keep_string(r, object, "mode", out);
    for (size_t i = 0; status == FF_OK && i < sizeof modes / sizeof modes[0]; ++i)
        if (strcmp(modes[i], *out) == 0) return FF_OK;
    if (status != FF_OK) return status;
    return ff_json_fail_key(
        &r->json, object, "mode", r->error,
        "unknown mode \"%s\", expected walk, run, idle, jump, turn, crouch, climb, start or stop", *out);
}

/* ["walk", "left turn"] becomes "walk left-turn": tags are words. */
static ff_status read_tags(reader *r, const json_t *object, char **out)
{
    const json_t *tags = json_object_get(object, "tags");
    if (!tags) return FF_OK;
    if (!json_is_array(tags)) return ff_json_fail(&r->json, tags, r->error, "tags: expected a list of words");
    size_t size = 1;
    for (size_t i = 0; i < json_array_size(tags); ++i) {
        const json_t *tag = json_array_get(tags, i);
        const char *text = json_string_value(tag);
        if (!text || !*text || strpbrk(text, " \t\n"))
            return ff_json_fail(&r->json, tag, r->error, "tags: expected a word without blanks");
        size += strlen(text) + 1;
    }
    char *kept = ff_catalogue_keep(r->builder, size);
    if (!kept) return fail_memory(r);
    size_t length = 0;
    for (size_t i = 0; i < json_array_size(tags); ++i) {
        const char *text = json_string_value(json_array_get(tags, i));
        if (i > 0) kept[length++] = ' ';
        memcpy(kept + length, text, strlen(text));
        length += strlen(text);
    }
    *out = kept;
    return FF_OK;
}

static ff_status read_trim(reader *r, const json_t *object, ff_catalogue_entry *entry)
{
    const json_t *trim = json_object_get(object, "trim");
    if (!trim) return FF_OK;
    const json_t *first = json_array_get(trim, 0), *last = json_array_get(trim, 1);
    bool whole = json_array_size(trim) == 2 && json_is_integer(first) && json_is_integer(last);
    json_int_t from = json_integer_value(first), to = json_integer_value(last);
    if (!whole || from < 0 || from > INT_MAX || to > INT_MAX || to < -1 || (to != -1 && to < from))
        return ff_json_fail(
            &r->json, trim, r->error,
            "trim: expected [FIRST, LAST], whole frames from 0 with FIRST <= LAST (LAST -1 = to the end)");
    entry->trim_first = (int)from;
    entry->trim_last = (int)to;
    return FF_OK;
}

/* {"LeftUpLeg": "left hip", "Twist1": "none"}; each joint is given its role. */
static ff_status read_roles(reader *r, json_t *object, ff_load_options *options)
{
    json_t *roles = json_object_get(object, "roles");
    if (!roles) return FF_OK;
    if (!json_is_object(roles))
        return ff_json_fail(&r->json, roles, r->error, "roles: expected an object of \"joint\": \"role\"");
    size_t count = json_object_size(roles), n = 0;
    ff_role_override *list = ff_catalogue_keep(r->builder, count * sizeof *list);
    if (!list) return fail_memory(r);
    const char *joint;
    json_t *value;
    json_object_foreach(roles, joint, value)
    {
        const char *name = json_string_value(value);
        if (!name || !ff_role_from_name(name, &list[n].role))
            return ff_json_fail(
                &r->json, value, r->error,
                "not a role; roles are \"hips\", \"left knee\" ... (mocap/README.md) or \"none\"");
        list[n].joint = ff_catalogue_keep_text(r->builder, joint);
        if (!list[n++].joint) return fail_memory(r);
    }
    options->overrides = list;
    options->override_count = (int)count;
    return FF_OK;
}

/* What may stand at the top for all clips and again at a clip. */
static ff_status read_common(reader *r, json_t *object, ff_catalogue_entry *entry)
{
    ff_status status = read_unit(r, object, &entry->options.unit_m);
    if (status == FF_OK)
        status = ff_json_number(&r->json, object, "fps", 1.0, 10000.0, &entry->options.fps, r->error);
    if (status == FF_OK) status = read_up(r, object, &entry->options.up);
    if (status == FF_OK) status = ff_json_bool(&r->json, object, "strict", &entry->options.strict, r->error);
    if (status == FF_OK) status = ff_json_bool(&r->json, object, "mirror", &entry->mirror, r->error);
    if (status == FF_OK)
        status = ff_json_bool(&r->json, object, "in_place", &entry->options.in_place, r->error);
    if (status == FF_OK) status = read_tags(r, object, &entry->tags);
    if (status == FF_OK) status = read_mode(r, object, &entry->mode);
    if (status == FF_OK) status = read_roles(r, object, &entry->options);
    if (status == FF_OK) status = keep_string(r, object, "licence", &entry->licence);
    if (status == FF_OK) status = keep_string(r, object, "citation", &entry->citation);
    return status;
}

static ff_status find_file(reader *r, const json_t *object, const char *key, const char *name, char **out)
{
    *out = ff_catalogue_keep_path(r->builder, r->folder, name);
    if (!*out) return fail_memory(r);
    if (access(*out, R_OK) == 0) return FF_OK;
    return ff_json_fail_key(
        &r->json, object, key, r->error,
        "cannot read %s; say where the clips are with \"folder\" or CATALOGUE.json:FOLDER", *out);
}

/* One animation of a glTF file, by name or index: it becomes FILE#ANIMATION. */
static ff_status read_animation(reader *r, const json_t *object, char **path)
{
    const json_t *value = json_object_get(object, "animation");
    if (!value) return FF_OK;
    const char *ending = strrchr(*path, '.');
    if (strcasecmp(ending, ".gltf") != 0 && strcasecmp(ending, ".glb") != 0)
        return ff_json_fail_key(&r->json, object, "animation", r->error,
                                "animation: only a glTF file has several");
    char index[16] = "";
    bool number =
        json_is_integer(value) && json_integer_value(value) >= 0 && json_integer_value(value) < 100000;
    if (number) snprintf(index, sizeof index, "%d", (int)json_integer_value(value));
    if (!number && !json_is_string(value))
        return ff_json_fail(&r->json, value, r->error, "animation: expected a name or an index from 0");
    *path = ff_catalogue_keep_joined(r->builder, *path, "#", number ? index : json_string_value(value));
    return *path ? FF_OK : fail_memory(r);
}

static ff_status read_clip(reader *r, json_t *object, const ff_catalogue_entry *defaults)
{
    static const char *const keys[] = {"file",  "skeleton", "trim",     "use",      "note",      "unit",
                                       "fps",   "up",       "strict",   "mirror",   "tags",      "mode",
                                       "roles", "licence",  "citation", "in_place", "animation", NULL};
    if (!json_is_object(object))
        return ff_json_fail(&r->json, object, r->error, "clips: expected objects { \"file\": ... }");
    ff_status status = ff_json_only_keys(&r->json, object, keys, r->error);
    const char *file = NULL, *skeleton = NULL, *note = NULL;
    bool use = true;
    if (status == FF_OK) status = ff_json_string(&r->json, object, "file", &file, r->error);
    if (status == FF_OK) status = ff_json_string(&r->json, object, "skeleton", &skeleton, r->error);
    if (status == FF_OK) status = ff_json_string(&r->json, object, "note", &note, r->error);
    if (status == FF_OK) status = ff_json_bool(&r->json, object, "use", &use, r->error);
    if (status != FF_OK) return status;
    if (!file) return ff_json_fail(&r->json, object, r->error, "the clip has no \"file\"");
    if (!ff_is_clip_path(file))
        return ff_json_fail_key(&r->json, object, "file", r->error,
                                "\"%s\" is no clip (.amc, .bvh, .gltf, .glb)", file);
    ff_catalogue_entry entry = *defaults;
    status = read_common(r, object, &entry);
    if (status == FF_OK) status = read_trim(r, object, &entry);
    if (status != FF_OK || !use) return status;
    status = find_file(r, object, "file", file, &entry.path);
    if (status == FF_OK && skeleton) {
        char *path;
        status = find_file(r, object, "skeleton", skeleton, &path);
        entry.options.skeleton = path;
    }
    if (status == FF_OK) status = read_animation(r, object, &entry.path);
    return status == FF_OK ? ff_catalogue_add_clips(r->builder, entry, r->error) : status;
}

/* "folder" is relative to the folder that the catalogue is in; one from the command line is relative to the caller's. */
static ff_status set_folder(reader *r, const char *catalogue_path, const char *given)
{
    r->folder = given;
    if (given) return FF_OK;
    char *home = ff_catalogue_keep_text(r->builder, catalogue_path);
    if (!home) return fail_memory(r);
    char *slash = strrchr(home, '/');
    home[slash ? slash - home + 1 : 0] = '\0';
    const char *folder = NULL;
    ff_status status = ff_json_string(&r->json, r->json.root, "folder", &folder, r->error);
    if (status != FF_OK) return status;
    r->folder = folder ? ff_catalogue_keep_path(r->builder, home, folder) : home;
    return r->folder ? FF_OK : fail_memory(r);
}

/* The character that is drawn: a glTF file, read with the catalogue's own unit and roles. */
static ff_status read_skin(reader *r, const json_t *root, const ff_catalogue_entry *defaults)
{
    const char *name = NULL;
    ff_status status = ff_json_string(&r->json, root, "skin", &name, r->error);
    if (status != FF_OK || !name) return status;
    r->builder->skin_options = defaults->options;
    return find_file(r, root, "skin", name, &r->builder->skin);
}

static ff_status read_root(reader *r, const char *path, const char *folder)
{
    static const char *const keys[] = {"folder",   "note",     "clips", "unit", "fps",   "up",
                                       "strict",   "mirror",   "tags",  "mode", "roles", "licence",
                                       "citation", "in_place", "skin",  NULL};
    json_t *root = r->json.root, *clips = json_object_get(root, "clips");
    ff_status status = ff_json_only_keys(&r->json, root, keys, r->error);
    const char *note = NULL;
    if (status == FF_OK) status = ff_json_string(&r->json, root, "note", &note, r->error);
    if (status == FF_OK) status = set_folder(r, path, folder);
    if (status != FF_OK) return status;
    if (!json_is_array(clips))
        return ff_json_fail(&r->json, clips ? clips : root, r->error, "\"clips\": expected a list of clips");
    ff_catalogue_entry defaults = ff_catalogue_default();
    status = read_common(r, root, &defaults);
    if (status == FF_OK) status = read_skin(r, root, &defaults);
    for (size_t i = 0; i < json_array_size(clips) && status == FF_OK; ++i)
        status = read_clip(r, json_array_get(clips, i), &defaults);
    return status;
}

ff_status ff_catalogue_add_text(ff_catalogue_builder *builder, const char *text, size_t size,
                                const char *path, const char *folder, ff_error *error)
{
    reader r = {.builder = builder, .error = error};
    ff_status status = ff_json_parse(text, size, path, &r.json, error);
    if (status != FF_OK) return status;
    status = read_root(&r, path, folder);
    ff_json_free(&r.json);
    return status;
}

ff_status ff_catalogue_add_json(ff_catalogue_builder *builder, const char *path, const char *folder,
                                ff_error *error)
{
    ff_file file;
    ff_status status = ff_file_map(path, &file, error);
    if (status != FF_OK) return status;
    status = ff_catalogue_add_text(builder, file.data, file.size, path, folder, error);
    ff_file_unmap(&file);
    return status;
}
