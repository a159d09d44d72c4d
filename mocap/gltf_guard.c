#define _GNU_SOURCE
#include "mocap/gltf_guard.h"

#include "runtime/core/base/fail.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------------------------------------- container */

typedef struct container {
    const char *json;
    size_t json_size;
    ff_gltf_buffer bin; /* data NULL = there is no such chunk */
} container;

static uint32_t number_at(const char *data, size_t offset)
{
    const unsigned char *p = (const unsigned char *)data + offset;
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static ff_status fail_byte(ff_error *error, size_t offset, const char *what)
{
    return ff_fail_section(error, FF_ERR_PARSE, "GLB", offset, "%s", what);
}

/* The binary container: 12 bytes of header, then chunks of 4-byte length, 4-byte type and data. */
static ff_status open_glb(const char *data, size_t size, container *out, ff_error *error)
{
    enum { HEADER = 12, CHUNK = 8, JSON_CHUNK = 0x4e4f534a, BIN_CHUNK = 0x004e4942 };
    if (size < HEADER + CHUNK) return fail_byte(error, size, "the file ends inside its header");
    if (number_at(data, 4) != 2) return fail_byte(error, 4, "not version 2 of the binary container");
    size_t length = number_at(data, 8);
    if (length > size)
        return fail_byte(error, 8, "the header announces more bytes than the file has: it was cut off");
    for (size_t at = HEADER; at + CHUNK <= length;) {
        size_t chunk = number_at(data, at), type = number_at(data, at + 4);
        if (chunk > length - at - CHUNK)
            return fail_byte(error, at, "a chunk goes beyond the end of the file");
        if (at == HEADER && type != JSON_CHUNK)
            return fail_byte(error, at + 4, "the first chunk is not JSON");
        if (at == HEADER) {
            out->json = data + at + CHUNK;
            out->json_size = chunk;
        } else if (type == BIN_CHUNK && !out->bin.data) {
            out->bin = (ff_gltf_buffer){(const unsigned char *)data + at + CHUNK, chunk};
        }
        at += CHUNK + chunk;
    }
    return out->json ? FF_OK : fail_byte(error, HEADER, "there is no JSON chunk");
}

static ff_status open_container(const char *data, size_t size, container *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    if (size >= 4 && memcmp(data, "glTF", 4) == 0) return open_glb(data, size, out, error);
    out->json = data;
    out->json_size = size;
    return FF_OK;
}

/* ------------------------------------------------------------------------------------------------ buffers */

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* %20 and the like; false for an escape that is none or stands for a zero byte. */
static bool decode_uri(const char *uri, char *out)
{
    for (; *uri; ++uri) {
        if (*uri != '%') {
            *out++ = *uri;
            continue;
        }
        int high = hex_digit(uri[1]), low = high >= 0 ? hex_digit(uri[2]) : -1;
        if (low < 0 || (high == 0 && low == 0)) return false;
        *out++ = (char)(high * 16 + low);
        uri += 2;
    }
    *out = '\0';
    return true;
}

/* A relative path without a step upwards, a drive or a scheme. */
static bool stays_below(const char *name)
{
    if (*name == '\0' || *name == '/' || strchr(name, '\\') || strchr(name, ':')) return false;
    for (const char *part = name; part; part = strchr(part, '/')) {
        part += *part == '/';
        if (part[0] == '.' && part[1] == '.' && (part[2] == '/' || part[2] == '\0')) return false;
    }
    return true;
}

/* Where links lead counts: the real path of the buffer must lie below the real path of the folder. */
static bool really_below(const char *folder, const char *path)
{
    char real_folder[PATH_MAX], real_path[PATH_MAX];
    if (!realpath(folder, real_folder) || !realpath(path, real_path)) return false;
    size_t length = strlen(real_folder);
    if (length > 0 && real_folder[length - 1] == '/') --length;
    return strncmp(real_folder, real_path, length) == 0 && real_path[length] == '/';
}

typedef struct guard {
    const ff_json *json;
    const char *path;
    container container;
    ff_gltf_guarded *out;
    ff_error *error;
} guard;

static json_t *original(const guard *g, size_t index)
{
    return json_array_get(json_object_get(g->json->root, "buffers"), index);
}

static ff_status refuse_buffer(const guard *g, size_t index, const char *what, const char *detail)
{
    return ff_json_fail_key(g->json, original(g, index), "uri", g->error, "buffers[%zu].uri: %s%.100s", index,
                            what, detail);
}

static ff_status map_external(guard *g, size_t index, const char *uri, size_t needed)
{
    char name[PATH_MAX], folder[PATH_MAX] = ".", path[2 * PATH_MAX];
    if (strlen(uri) >= sizeof name || strlen(g->path) >= sizeof folder || !decode_uri(uri, name))
        return refuse_buffer(g, index, "no path that can be used: ", uri);
    if (!stays_below(name))
        return refuse_buffer(g, index, "a buffer may only lie in the file's own folder, not at ", uri);
    const char *slash = strrchr(g->path, '/');
    if (slash) snprintf(folder, sizeof folder, "%.*s", (int)(slash - g->path) + 1, g->path);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    ff_file *file = &g->out->files[index];
    ff_error reason = {0};
    if (ff_file_map(path, file, &reason) != FF_OK) {
        char text[512];
        snprintf(text, sizeof text, "%.80s (%s)", name, reason.message);
        return refuse_buffer(g, index, "cannot read ", text);
    }
    if (!really_below(folder, path))
        return refuse_buffer(g, index, "a link leads out of the file's folder: ", uri);
    if (file->size < needed)
        return ff_json_fail_key(g->json, original(g, index), "byteLength", g->error,
                                "buffers[%zu].byteLength: %zu bytes, but %.100s has %zu", index, needed, name,
                                file->size);
    g->out->buffers[index] = (ff_gltf_buffer){(const unsigned char *)file->data, needed};
    return FF_OK;
}

/* How many bytes the base64 text after a data URI's comma holds; false when it is none. */
static bool base64_size(const char *text, size_t *size)
{
    size_t length = strspn(text, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/");
    size_t padding = strspn(text + length, "=");
    if (text[length + padding] != '\0' || padding > 2 || length % 4 == 1) return false;
    *size = length / 4 * 3 + (length % 4 ? length % 4 - 1 : 0);
    return true;
}

/* tinygltf knows data URIs by a few media types and wants byteLength to be exactly what they hold. */
static ff_status plain_data_uri(guard *g, size_t index, json_t *buffer, const char *uri, size_t needed)
{
    static const char plain[] = "data:application/octet-stream;base64,";
    const char *comma = strchr(uri, ',');
    size_t size = 0;
    if (!comma || comma - uri < 7 || strncmp(comma - 7, ";base64", 7) != 0 || !base64_size(comma + 1, &size))
        return refuse_buffer(g, index, "expected data:...;base64, and base64 text", "");
    if (size < needed)
        return ff_json_fail_key(g->json, original(g, index), "byteLength", g->error,
                                "buffers[%zu].byteLength: %zu bytes, but the uri holds %zu", index, needed,
                                size);
    size_t text = strlen(comma + 1);
    char *copy = malloc(sizeof plain + text);
    if (!copy) return ff_fail(g->error, FF_ERR_NO_MEMORY, "no memory for buffers[%zu]", index);
    memcpy(copy, plain, sizeof plain - 1);
    memcpy(copy + sizeof plain - 1, comma + 1, text + 1);
    bool stored = json_object_set_new(buffer, "uri", json_string(copy)) == 0 &&
                  json_object_set_new(buffer, "byteLength", json_integer((json_int_t)size)) == 0;
    free(copy);
    return stored ? FF_OK : ff_fail(g->error, FF_ERR_NO_MEMORY, "no memory for buffers[%zu]", index);
}

static ff_status find_buffer(guard *g, size_t index, json_t *buffer)
{
    const char *uri = json_string_value(json_object_get(buffer, "uri"));
    size_t needed = (size_t)json_integer_value(json_object_get(buffer, "byteLength"));
    if (needed == 0)
        return ff_json_fail_key(g->json, original(g, index), "byteLength", g->error, "buffers[%zu] is empty",
                                index);
    if (uri && strncmp(uri, "data:", 5) == 0) return plain_data_uri(g, index, buffer, uri, needed);
    ff_status status = FF_OK;
    if (uri) {
        status = map_external(g, index, uri, needed);
    } else if (index != 0 || !g->container.bin.data || g->container.bin.size < needed) {
        status = ff_json_fail(g->json, original(g, index), g->error,
                              "buffers[%zu] has no uri, and the file no binary chunk of %zu bytes for it",
                              index, needed);
    } else {
        g->out->buffers[index] = (ff_gltf_buffer){g->container.bin.data, needed};
    }
    if (status != FF_OK) return status;
    return json_object_set_new(buffer, "uri", json_sprintf("%zu", index)) == 0
               ? FF_OK
               : ff_fail(g->error, FF_ERR_NO_MEMORY, "no memory for buffers[%zu]", index);
}

static ff_status find_buffers(guard *g, const json_t *document)
{
    json_t *buffers = json_object_get(document, "buffers");
    g->out->buffer_count = (int)json_array_size(buffers);
    ff_status status = FF_OK;
    for (size_t i = 0; i < json_array_size(buffers) && status == FF_OK; ++i)
        status = find_buffer(g, i, json_array_get(buffers, i));
    return status;
}

ff_status ff_gltf_guard(const char *data, size_t size, const char *path, ff_gltf_keys keys,
                        ff_gltf_guarded *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    guard g = {.path = path, .out = out, .error = error};
    ff_json json;
    json_t *document = NULL;
    ff_status status = open_container(data, size, &g.container, error);
    if (status == FF_OK) status = ff_json_parse(g.container.json, g.container.json_size, path, &json, error);
    if (status != FF_OK) return status;
    g.json = &json;
    ff_gltf_selection selection = {0};
    if (!keys.all) status = ff_gltf_select(&json, keys.animation, &selection, error);
    if (status == FF_OK)
        status = ff_gltf_reduce(&json, selection.root ? selection.root : json.root, &document, error);
    if (status == FF_OK && selection.root) status = ff_gltf_renumber(&selection, document, error);
    ff_gltf_selection_free(&selection);
    if (status == FF_OK) status = find_buffers(&g, document);
    if (status == FF_OK) {
        out->json = json_dumps(document, JSON_COMPACT);
        if (!out->json) status = ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the document");
    }
    json_decref(document);
    ff_json_free(&json);
    if (status != FF_OK) ff_gltf_guarded_free(out);
    return status;
}

void ff_gltf_guarded_free(ff_gltf_guarded *guarded)
{
    free(guarded->json);
    for (int i = 0; i < FF_GLTF_MOST_BUFFERS; ++i)
        if (guarded->files[i].mapped) ff_file_unmap(&guarded->files[i]);
    memset(guarded, 0, sizeof *guarded);
}
