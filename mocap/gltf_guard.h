/* gltf_guard.h - what is looked at before tinygltf sees a document: the container, the JSON and where buffers lie.
 *
 * tinygltf 2.7 would open any file a document names, decode its pictures, recurse into `extras` as deep as they go, and
 * skip what has the wrong type. So it is handed a document that holds only the members this project reads, each with the
 * type it must have, and buffers that are already found. */
#ifndef FF_GLTF_GUARD_H
#define FF_GLTF_GUARD_H

#include "mocap/gltf.h"
#include "runtime/core/base/file.h"
#include "runtime/tool/json.h"

enum { FF_GLTF_MOST_BUFFERS = 256 };

typedef struct ff_gltf_guarded {
    char
        *json; /* the document that is left; data URIs are still in it, other URIs are the buffers' numbers */
    ff_gltf_buffer buffers[FF_GLTF_MOST_BUFFERS]; /* bytes of the buffers that are not data URIs */
    ff_file files[FF_GLTF_MOST_BUFFERS];          /* those that were mapped */
    int buffer_count;
} ff_gltf_guarded;

/* keys says of which animations (gltf.h). */
ff_status ff_gltf_guard(const char *data, size_t size, const char *path, ff_gltf_keys keys,
                        ff_gltf_guarded *out, ff_error *error);
void ff_gltf_guarded_free(ff_gltf_guarded *guarded);

/* The members of root (json's own, or a selection of it) that are read (gltf_schema.c). Errors name line, column and
 * member. */
ff_status ff_gltf_reduce(const ff_json *json, const json_t *root, json_t **out, ff_error *error);

/* New numbers of a list's elements: to[old], UINT32_MAX = left out. */
typedef struct ff_gltf_numbers {
    uint32_t *to;
    size_t count;
} ff_gltf_numbers;

typedef struct ff_gltf_selection {
    json_t *root;
    ff_gltf_numbers accessors, views;
} ff_gltf_selection;

/* The document without the keys of other animations than one; its elements are the document's own. */
ff_status ff_gltf_select(const ff_json *json, const char *animation, ff_gltf_selection *out, ff_error *error);
/* Put the new numbers into a reduced copy of it; the old ones are kept as names, for messages. */
ff_status ff_gltf_renumber(const ff_gltf_selection *selection, json_t *document, ff_error *error);
void ff_gltf_selection_free(ff_gltf_selection *selection);

#endif
