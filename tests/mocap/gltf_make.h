/* gltf_make.h - small glTF files, put together by the tests themselves. */
#ifndef FF_GLTF_MAKE_H
#define FF_GLTF_MAKE_H

#include "tests/check.h"

#include <stdio.h>

typedef struct gltf_made {
    unsigned char bytes[16384];
    size_t size;
    char views[8192], accessors[8192];
    int view_count, accessor_count;
} gltf_made;

/* Append data as a buffer view of its own; returns its index. */
static inline int made_view(gltf_made *made, const void *data, size_t size)
{
    size_t used = strlen(made->views);
    memcpy(made->bytes + made->size, data, size);
    snprintf(made->views + used, sizeof made->views - used,
             "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", used ? "," : "", made->size, size);
    made->size = (made->size + size + 3) & ~(size_t)3;
    return made->view_count++;
}

/* An accessor in JSON words; returns its index. */
static inline int made_accessor(gltf_made *made, const char *json)
{
    size_t used = strlen(made->accessors);
    snprintf(made->accessors + used, sizeof made->accessors - used, "%s{%s}", used ? "," : "", json);
    return made->accessor_count++;
}

static inline int made_numbers(gltf_made *made, const void *data, size_t size, int component,
                               const char *type, size_t count, const char *more)
{
    char json[256];
    snprintf(json, sizeof json, "\"bufferView\":%d,\"componentType\":%d,\"type\":\"%s\",\"count\":%zu%s",
             made_view(made, data, size), component, type, count, more);
    return made_accessor(made, json);
}

static inline int made_floats(gltf_made *made, const float *values, int width, size_t count)
{
    static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    return made_numbers(made, values, (size_t)width * count * sizeof *values, 5126,
                        width == 16 ? "MAT4" : types[width], count, "");
}

/* The document: its buffer (uri is the text of its uri member, "" = the binary chunk), and what rest adds. */
static inline void made_json(const gltf_made *made, const char *uri, const char *rest, char *out, size_t size)
{
    char member[9000] = "";
    if (*uri) snprintf(member, sizeof member, ",\"uri\":\"%s\"", uri);
    int length =
        snprintf(out, size,
                 "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu%s}],\"bufferViews\":[%s],"
                 "\"accessors\":[%s],%s}",
                 made->size, member, made->views, made->accessors, rest);
    assert_true(length > 0 && (size_t)length < size);
}

static inline void put_u32(unsigned char *to, size_t value)
{
    for (int i = 0; i < 4; ++i)
        to[i] = (unsigned char)(value >> (8 * i));
}

/* A binary container; returns its size. */
static inline size_t made_glb(const char *json, const gltf_made *made, unsigned char *out)
{
    size_t text = (strlen(json) + 3) & ~(size_t)3;
    memcpy(out, "glTF", 4);
    put_u32(out + 4, 2);
    put_u32(out + 8, 28 + text + made->size);
    put_u32(out + 12, text);
    memcpy(out + 16, "JSON", 4);
    memset(out + 20, ' ', text);
    memcpy(out + 20, json, strlen(json));
    put_u32(out + 20 + text, made->size);
    memcpy(out + 24 + text, "BIN\0", 4);
    memcpy(out + 28 + text, made->bytes, made->size);
    return 28 + text + made->size;
}

static inline void made_base64(const gltf_made *made, char *out)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < made->size; i += 3) {
        size_t left = made->size - i;
        unsigned long v = (unsigned long)made->bytes[i] << 16;
        if (left > 1) v |= (unsigned long)made->bytes[i + 1] << 8;
        if (left > 2) v |= made->bytes[i + 2];
        *out++ = digits[v >> 18];
        *out++ = digits[v >> 12 & 63];
        *out++ = left > 1 ? digits[v >> 6 & 63] : '=';
        *out++ = left > 2 ? digits[v & 63] : '=';
    }
    *out = '\0';
}

#endif
