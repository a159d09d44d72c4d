#define FF_JSON_C
#include "runtime/tool/json.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/tool/nearest.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    KEYS_SHOWN = 240
}; /* characters of a list of keys: a message has room for them and for what is said about them */

/* ---------------------------------------------------------------------------------------------- loading */

static ff_status refuse_syntax(const ff_json *json, const json_error_t *found, ff_error *error)
{
    uint32_t line = found->line > 0 ? (uint32_t)found->line : 0;
    uint32_t column = found->column > 0 ? (uint32_t)found->column : 0;
    if (json_error_code(found) == json_error_out_of_memory)
        return ff_fail_at(error, FF_ERR_NO_MEMORY, json->path, 0, 0, "reading JSON");
    return ff_fail_at(error, FF_ERR_PARSE, json->path, line, column, "not valid JSON: %s", found->text);
}

/* jansson takes a zero byte after a number for space, but the search for places would take it for the end. */
static ff_status refuse_zero(const ff_json *json, ff_error *error)
{
    const char *zero = memchr(json->text, '\0', json->size), *line_start = json->text;
    if (!zero) return FF_OK;
    uint32_t line = 1;
    for (const char *at = json->text; at < zero; ++at) {
        if (*at != '\n') continue;
        ++line;
        line_start = at + 1;
    }
    return ff_fail_at(error, FF_ERR_PARSE, json->path, line, (uint32_t)(zero - line_start) + 1,
                      "not valid JSON: a zero byte; is this a text file?");
}

ff_status ff_json_parse(const char *text, size_t size, const char *name, ff_json *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    snprintf(out->path, sizeof out->path, "%s", name);
    if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0)
        text += 3, size -= 3; /* some editors' byte order mark */
    out->text = malloc(size + 1);
    if (!out->text) return ff_fail(error, FF_ERR_NO_MEMORY, "reading %s", name);
    memcpy(out->text, text, size);
    out->text[size] = '\0';
    out->size = size;

    json_error_t found;
    ff_status status = refuse_zero(out, error);
    if (status != FF_OK) {
        ff_json_free(out);
        return status;
    }
    out->root = json_loadb(out->text, size, JSON_REJECT_DUPLICATES, &found);
    if (!out->root) {
        status = refuse_syntax(out, &found, error);
    } else if (!json_is_object(out->root)) {
        status = ff_fail_at(error, FF_ERR_PARSE, out->path, 1, 1, "expected an object { ... } at the top");
    }
    if (status != FF_OK) ff_json_free(out);
    return status;
}

ff_status ff_json_load(const char *path, ff_json *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    ff_file file;
    ff_status status = ff_file_map(path, &file, error);
    if (status != FF_OK) return status;
    status = ff_json_parse(file.data, file.size, path, out, error);
    ff_file_unmap(&file);
    return status;
}

void ff_json_free(ff_json *json)
{
    json_decref(json->root);
    free(json->text);
    memset(json, 0, sizeof *json);
}

/* ---------------------------------------------------------------------------------------- finding a place */

static const char *skip_space(const char *at)
{
    return at + strspn(at, " \t\r\n");
}

/* at stands on the opening quote. */
static const char *skip_string(const char *at)
{
    for (++at; *at && *at != '"'; ++at) {
        if (*at == '\\' && at[1]) ++at;
    }
    return *at ? at + 1 : at;
}

/* Past one whole value: strings are the only place where a bracket or comma means nothing. */
static const char *skip_value(const char *at)
{
    int depth = 0;
    at = skip_space(at);
    while (*at) {
        if (*at == '"') {
            at = skip_string(at);
            if (depth == 0) return at;
            continue;
        }
        if (*at == '{' || *at == '[') {
            ++depth;
        } else if (*at == '}' || *at == ']') {
            if (depth == 0) return at;
            if (--depth == 0) return at + 1;
        } else if (*at == ',' && depth == 0) {
            return at;
        }
        ++at;
    }
    return at;
}

/* What is looked for: a value, or a member of an object by its key. */
typedef struct target {
    const json_t *value;
    const char *key; /* NULL: the value itself */
    bool at_key;     /* the key's own place rather than that of its value */
    const char *found;
} target;

static void seek_value(const char *at, json_t *value, target *wanted);

/* jansson keeps members in the order of the text and duplicates are refused, so tree and text advance together. */
static void seek_members(const char *at, json_t *object, target *wanted)
{
    const char *key;
    json_t *member;
    json_object_foreach(object, key, member)
    {
        const char *key_place = skip_space(at + 1);
        if (*key_place != '"') return;
        at = skip_space(skip_string(key_place));
        if (*at != ':') return;
        const char *value_place = skip_space(at + 1);
        if (wanted->key && object == wanted->value && strcmp(key, wanted->key) == 0) {
            wanted->found = wanted->at_key ? key_place : value_place;
            return;
        }
        seek_value(value_place, member, wanted);
        if (wanted->found) return;
        at = skip_space(skip_value(value_place));
    }
}

static void seek_elements(const char *at, json_t *array, target *wanted)
{
    size_t index;
    json_t *element;
    json_array_foreach(array, index, element)
    {
        const char *place = skip_space(at + 1);
        seek_value(place, element, wanted);
        if (wanted->found) return;
        at = skip_space(skip_value(place));
    }
}

static void seek_value(const char *at, json_t *value, target *wanted)
{
    if (!wanted->key && value == wanted->value) {
        wanted->found = at;
    } else if (json_is_object(value)) {
        seek_members(at, value, wanted);
    } else if (json_is_array(value)) {
        seek_elements(at, value, wanted);
    }
}

static ff_status fail_at_target(const ff_json *json, target wanted, ff_error *error, const char *format,
                                va_list arguments) FF_PRINTF(4, 0);

static ff_status fail_at_target(const ff_json *json, target wanted, ff_error *error, const char *format,
                                va_list arguments)
{
    char message[sizeof error->message];
    vsnprintf(message, sizeof message, format, arguments);
    seek_value(skip_space(json->text), json->root, &wanted);
    uint32_t line = 0, column = 0;
    if (wanted.found) {
        line = column = 1;
        for (const char *at = json->text; at < wanted.found; ++at) {
            if (*at == '\n') {
                ++line, column = 1;
            } else if (((unsigned char)*at & 0xc0u) != 0x80u) { /* characters, as editors count, not bytes */
                ++column;
            }
        }
    }
    return ff_fail_at(error, FF_ERR_PARSE, json->path, line, column, "%s", message);
}

ff_status ff_json_fail(const ff_json *json, const json_t *value, ff_error *error, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    ff_status status = fail_at_target(json, (target){value, NULL, false, NULL}, error, format, arguments);
    va_end(arguments);
    return status;
}

ff_status ff_json_fail_key(const ff_json *json, const json_t *object, const char *key, ff_error *error,
                           const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    ff_status status = fail_at_target(json, (target){object, key, true, NULL}, error, format, arguments);
    va_end(arguments);
    return status;
}

/* At the place of a member's value. By key, because jansson has only one `true`, `false` and `null`. */
static ff_status fail_member(const ff_json *json, const json_t *object, const char *key, ff_error *error,
                             const char *format, ...) FF_PRINTF(5, 6);

static ff_status fail_member(const ff_json *json, const json_t *object, const char *key, ff_error *error,
                             const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    ff_status status = fail_at_target(json, (target){object, key, false, NULL}, error, format, arguments);
    va_end(arguments);
    return status;
}

/* ---------------------------------------------------------------------------------------------- members */

/* Every key, or as many as there is room for in a message, and dots. */
static void list_keys(const char *const *keys, char list[KEYS_SHOWN])
{
    static const char more[] = ", ...";
    for (size_t used = 0; *keys; ++keys) {
        if (used + strlen(", ") + strlen(*keys) + sizeof more > KEYS_SHOWN) {
            memcpy(list + used, more, sizeof more);
            return;
        }
        used += (size_t)snprintf(list + used, KEYS_SHOWN - used, "%s%s", used ? ", " : "", *keys);
    }
}

ff_status ff_json_only_keys(const ff_json *json, const json_t *object, const char *const *allowed,
                            ff_error *error)
{
    const char *key;
    json_t *member;
    json_object_foreach((json_t *)(uintptr_t)object, key, member)
    {
        const char *const *known = allowed;
        while (*known && strcmp(*known, key) != 0)
            ++known;
        if (*known) continue;
        const char *near = ff_nearest(key, allowed);
        if (near)
            return ff_json_fail_key(json, object, key, error, "unknown key '%.60s'; did you mean '%s'?", key,
                                    near);
        char list[KEYS_SHOWN] = "";
        list_keys(allowed, list);
        return ff_json_fail_key(json, object, key, error, "unknown key '%.60s'; known keys: %s", key, list);
    }
    return FF_OK;
}

static const char *type_name(const json_t *value)
{
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        return "an object";
    case JSON_ARRAY:
        return "an array";
    case JSON_STRING:
        return "a string";
    case JSON_INTEGER:
        return "a whole number";
    case JSON_REAL:
        return "a number";
    case JSON_TRUE:
    case JSON_FALSE:
        return "true or false";
    default:
        return "null";
    }
}

ff_status ff_json_number(const ff_json *json, const json_t *object, const char *key, double low, double high,
                         double *out, ff_error *error)
{
    const json_t *value = json_object_get(object, key);
    if (!value) return FF_OK;
    if (!json_is_number(value))
        return fail_member(json, object, key, error, "\"%s\" is %s; expected a number", key,
                           type_name(value));
    double number = json_number_value(value);
    if (!(number >= low && number <= high))
        return fail_member(json, object, key, error, "\"%s\" is %g; expected %g to %g", key, number, low,
                           high);
    *out = number;
    return FF_OK;
}

ff_status ff_json_integer(const ff_json *json, const json_t *object, const char *key, int64_t low,
                          int64_t high, int64_t *out, ff_error *error)
{
    const json_t *value = json_object_get(object, key);
    if (!value) return FF_OK;
    if (!json_is_integer(value))
        return fail_member(json, object, key, error, "\"%s\" is %s; expected a whole number", key,
                           type_name(value));
    long long number = json_integer_value(value);
    if (number < low || number > high)
        return fail_member(json, object, key, error, "\"%s\" is %lld; expected %lld to %lld", key, number,
                           (long long)low, (long long)high);
    *out = number;
    return FF_OK;
}

ff_status ff_json_string(const ff_json *json, const json_t *object, const char *key, const char **out,
                         ff_error *error)
{
    const json_t *value = json_object_get(object, key);
    if (!value) return FF_OK;
    if (!json_is_string(value))
        return fail_member(json, object, key, error, "\"%s\" is %s; expected a string", key,
                           type_name(value));
    *out = json_string_value(value);
    return FF_OK;
}

ff_status ff_json_bool(const ff_json *json, const json_t *object, const char *key, bool *out, ff_error *error)
{
    const json_t *value = json_object_get(object, key);
    if (!value) return FF_OK;
    if (!json_is_boolean(value))
        return fail_member(json, object, key, error, "\"%s\" is %s; expected true or false", key,
                           type_name(value));
    *out = json_is_true(value);
    return FF_OK;
}
