/* json.h - JSON files that people write, read strictly: every complaint names file, line and column.
 *
 * jansson tells the place of a syntax error only; for a value that is well-formed but wrong the place is found by
 * walking the text again along the value's path.
 */
#ifndef FF_JSON_H
#define FF_JSON_H

#include "runtime/core/base/fail.h"

#include <jansson.h>
#include <stdbool.h>

typedef struct ff_json {
    json_t *root;
    char *text; /* the file's text, for finding places */
    size_t size;
    char path[256];
} ff_json;

/* Read and parse a file whose top level is an object; duplicate keys are refused. On failure *out is zeroed. */
ff_status ff_json_load(const char *path, ff_json *out, ff_error *error);
ff_status ff_json_parse(const char *text, size_t size, const char *name, ff_json *out, ff_error *error);
void ff_json_free(ff_json *json);

/* Raise an error at the place of a value of this document (an object, array, string or number reached from root;
 * jansson shares one true, false and null among all places, so for those name the object's key instead). */
ff_status ff_json_fail(const ff_json *json, const json_t *value, ff_error *error, const char *format, ...)
    FF_PRINTF(4, 5);

/* The same at the place of a key of object. */
ff_status ff_json_fail_key(const ff_json *json, const json_t *object, const char *key, ff_error *error,
                           const char *format, ...) FF_PRINTF(5, 6);

#if defined(__clang_analyzer__) && !defined(FF_JSON_C)
/* As in fail.h: what clang-tidy cannot see from one file. */
#define ff_json_fail(json, value, ...) (ff_json_fail(json, value, __VA_ARGS__), FF_ERR_PARSE)
#define ff_json_fail_key(json, object, ...) (ff_json_fail_key(json, object, __VA_ARGS__), FF_ERR_PARSE)
#endif

/* Refuse keys of object that are not in allowed (NULL-terminated list), naming the nearest allowed one. */
ff_status ff_json_only_keys(const ff_json *json, const json_t *object, const char *const *allowed,
                            ff_error *error);

/* Members with a default: leave *out alone when the key is absent; an error when it has another type or is out of
 * [low, high]. Strings are borrowed from the document. */
ff_status ff_json_number(const ff_json *json, const json_t *object, const char *key, double low, double high,
                         double *out, ff_error *error);
ff_status ff_json_integer(const ff_json *json, const json_t *object, const char *key, int64_t low,
                          int64_t high, int64_t *out, ff_error *error);
ff_status ff_json_string(const ff_json *json, const json_t *object, const char *key, const char **out,
                         ff_error *error);
ff_status ff_json_bool(const ff_json *json, const json_t *object, const char *key, bool *out,
                       ff_error *error);

#endif
