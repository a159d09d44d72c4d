/* The text of override files. Every key is described in preprocess/README.md; anything else is an error with its line. */
#include "preprocess/plants/plant_edit.h"

#include "runtime/core/base/file.h"
#include "runtime/core/base/memory.h"
#include "runtime/tool/json.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct reader {
    ff_json json;
    ff_array edits;
    ff_error *error;
} reader;

/* Where a value stands: complaints about plants come when the clip is known. */
static void find_place(const reader *r, const json_t *value, ff_plant_edit *edit)
{
    ff_error place;
    memset(&place, 0, sizeof place);
    ff_json_fail(&r->json, value, &place, "here");
    edit->line = place.line;
    edit->column = place.column;
}

static ff_status read_frame(reader *r, const json_t *object, const char *key, int *out)
{
    int64_t value = FF_EDIT_LEAVE;
    ff_status status = ff_json_integer(&r->json, object, key, 0, INT_MAX - 1, &value, r->error);
    *out = (int)value;
    return status;
}

static ff_status read_flat(reader *r, const json_t *object, ff_plant_edit *edit)
{
    const json_t *flat = json_object_get(object, "flat");
    edit->flat_start = edit->flat_end = FF_EDIT_LEAVE;
    if (!flat) return FF_OK;
    edit->flat_start = edit->flat_end = -1;
    if (json_is_array(flat) && json_array_size(flat) == 0) return FF_OK;
    json_t *first = json_array_get(flat, 0), *last = json_array_get(flat, 1);
    json_int_t from = json_integer_value(first), to = json_integer_value(last);
    bool whole = json_array_size(flat) == 2 && json_is_integer(first) && json_is_integer(last);
    if (!whole || from < 0 || to < from || to >= INT_MAX)
        return ff_json_fail(&r->json, flat, r->error,
                            "flat: expected [FIRST, LAST], frames with FIRST <= LAST, or [] for never");
    edit->flat_start = (int)from;
    edit->flat_end = (int)to;
    return FF_OK;
}

static ff_status read_foot(reader *r, const json_t *object, int *out)
{
    const char *foot = NULL;
    ff_status status = ff_json_string(&r->json, object, "foot", &foot, r->error);
    if (status != FF_OK) return status;
    if (!foot)
        return ff_json_fail(&r->json, object, r->error, "the plant has no \"foot\": \"left\" or \"right\"");
    if (strcmp(foot, "left") != 0 && strcmp(foot, "right") != 0)
        return ff_json_fail_key(&r->json, object, "foot", r->error, "foot: expected \"left\" or \"right\"");
    *out = strcmp(foot, "left") == 0 ? FF_LEFT : FF_RIGHT;
    return FF_OK;
}

static ff_status read_edit(reader *r, const json_t *object, ff_edit_kind kind)
{
    static const char *const add[] = {"foot", "start", "end", "flat", "note", NULL};
    static const char *const move[] = {"foot", "frame", "start", "end", "flat", "note", NULL};
    static const char *const take[] = {"foot", "frame", "note", NULL};
    ff_plant_edit edit = {.kind = kind};
    if (!json_is_object(object))
        return ff_json_fail(&r->json, object, r->error, "expected objects { \"foot\": \"left\", ... }");
    ff_status status = ff_json_only_keys(
        &r->json, object, kind == FF_EDIT_ADD ? add : (kind == FF_EDIT_MOVE ? move : take), r->error);
    if (status == FF_OK) status = read_foot(r, object, &edit.foot);
    if (status == FF_OK) status = read_frame(r, object, "frame", &edit.frame);
    if (status == FF_OK) status = read_frame(r, object, "start", &edit.start);
    if (status == FF_OK) status = read_frame(r, object, "end", &edit.end);
    if (status == FF_OK) status = read_flat(r, object, &edit);
    if (status != FF_OK) return status;
    if (kind == FF_EDIT_ADD && (edit.start < 0 || edit.end < 0))
        return ff_json_fail(&r->json, object, r->error, "the plant has no \"start\" or no \"end\" (frames)");
    if (kind != FF_EDIT_ADD && edit.frame < 0)
        return ff_json_fail(&r->json, object, r->error,
                            "no \"frame\": say any frame of the plant that is to be changed");
    if (edit.start >= 0 && edit.end >= 0 && edit.end < edit.start)
        return ff_json_fail_key(&r->json, object, "end", r->error, "end %d is before start %d", edit.end,
                                edit.start);
    find_place(r, object, &edit);
    ff_plant_edit *place = ff_array_grow(&r->edits, 1, sizeof *place);
    if (!place) return ff_json_fail(&r->json, object, r->error, "no memory for the plants");
    *place = edit;
    return FF_OK;
}

static ff_status read_list(reader *r, const char *key, ff_edit_kind kind, bool *there)
{
    const json_t *list = json_object_get(r->json.root, key);
    *there = list != NULL;
    if (!list) return FF_OK;
    if (!json_is_array(list))
        return ff_json_fail(&r->json, list, r->error, "%s: expected a list of plants", key);
    ff_status status = FF_OK;
    for (size_t i = 0; i < json_array_size(list) && status == FF_OK; ++i)
        status = read_edit(r, json_array_get(list, i), kind);
    return status;
}

static ff_status read_root(reader *r, bool *all)
{
    static const char *const keys[] = {"plants", "remove", "move", "add", "note", NULL};
    bool removes = false, moves = false, adds = false;
    const char *note = NULL;
    ff_status status = ff_json_only_keys(&r->json, r->json.root, keys, r->error);
    if (status == FF_OK) status = ff_json_string(&r->json, r->json.root, "note", &note, r->error);
    if (status == FF_OK) status = read_list(r, "plants", FF_EDIT_ADD, all);
    if (status == FF_OK) status = read_list(r, "remove", FF_EDIT_REMOVE, &removes);
    if (status == FF_OK) status = read_list(r, "move", FF_EDIT_MOVE, &moves);
    if (status == FF_OK) status = read_list(r, "add", FF_EDIT_ADD, &adds);
    if (status == FF_OK && *all && (removes || moves || adds))
        return ff_json_fail_key(
            &r->json, r->json.root, "plants", r->error,
            "plants lists every plant of the clip; with it there is nothing to remove, move or add");
    return status;
}

ff_status ff_plant_edits_parse(const char *text, size_t size, const char *path, ff_plant_edits *out,
                               ff_error *error)
{
    memset(out, 0, sizeof *out);
    reader r = {.error = error};
    ff_status status = ff_json_parse(text, size, path, &r.json, error);
    if (status == FF_OK) status = read_root(&r, &out->all);
    if (status == FF_OK) {
        out->items = r.edits.data;
        out->count = (int)r.edits.count;
        snprintf(out->path, sizeof out->path, "%s", path);
    } else {
        ff_array_free(&r.edits);
        out->all = false;
    }
    ff_json_free(&r.json);
    return status;
}

bool ff_plant_edits_path(const char *clip_path, char *path, size_t size)
{
    const char *slash = strrchr(clip_path, '/'), *dot = strrchr(clip_path, '.');
    int length = dot && (!slash || dot > slash) ? (int)(dot - clip_path) : (int)strlen(clip_path);
    int written = snprintf(path, size, "%.*s.plants.json", length, clip_path);
    return written > 0 && (size_t)written < size;
}

ff_status ff_plant_edits_load(const char *clip_path, ff_plant_edits *out, bool *found, ff_error *error)
{
    char path[sizeof out->path];
    memset(out, 0, sizeof *out);
    *found = ff_plant_edits_path(clip_path, path, sizeof path) && access(path, F_OK) == 0;
    if (!*found) return FF_OK;
    ff_file file;
    ff_status status = ff_file_map(path, &file, error);
    if (status != FF_OK) return status;
    status = ff_plant_edits_parse(file.data, file.size, path, out, error);
    ff_file_unmap(&file);
    return status;
}

ff_status ff_plant_edits_write(const ff_plants *plants, char **text, ff_error *error)
{
    static const char head[] =
        "{\n  \"note\": \"Every foot plant of the clip; change, remove and add lines. Frames count "
        "from 0.\",\n  \"plants\": [";
    size_t size = sizeof head + 16 + (size_t)plants->count * 128, at = 0;
    *text = malloc(size);
    if (!*text) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d plants", plants->count);
    at += (size_t)snprintf(*text, size, "%s", head);
    for (int i = 0; i < plants->count; ++i) {
        const ff_plant *p = &plants->items[i];
        at += (size_t)snprintf(*text + at, size - at,
                               "%s\n    { \"foot\": \"%s\", \"start\": %d, \"end\": %d, \"flat\": ",
                               i ? "," : "", p->foot == FF_LEFT ? "left" : "right", p->start, p->end);
        if (p->flat_start >= 0)
            at += (size_t)snprintf(*text + at, size - at, "[%d, %d] }", p->flat_start, p->flat_end);
        else
            at += (size_t)snprintf(*text + at, size - at, "[] }");
    }
    snprintf(*text + at, size - at, "\n  ]\n}\n");
    return FF_OK;
}
