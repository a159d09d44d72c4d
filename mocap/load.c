/* A clip from a file: which reader, which skeleton, then ff_clip_finish. */
#define _POSIX_C_SOURCE 200809L
#include "mocap/load.h"

#include "mocap/gltf.h"
#include "mocap/read.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include <xxhash.h>

ff_load_options ff_load_options_default(void)
{
    return (ff_load_options){.up = 'y'};
}

size_t ff_clip_file_length(const char *path)
{
    for (const char *hash = strchr(path, '#'); hash; hash = strchr(hash + 1, '#'))
        if ((hash - path > 4 && strncasecmp(hash - 4, ".glb", 4) == 0) ||
            (hash - path > 5 && strncasecmp(hash - 5, ".gltf", 5) == 0))
            return (size_t)(hash - path);
    return strlen(path);
}

static const char *ending_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    return dot && (!slash || dot > slash) ? dot : "";
}

/* path without its ending and what follows the last '_' of the file name (when at_underscore), with a new ending. Sets
 * *out to NULL when memory is short; returns whether there is such a file. */
static bool skeleton_beside(const char *path, bool at_underscore, const char *ending, char **out)
{
    size_t length = (size_t)(ending_of(path) - path);
    const char *slash = strrchr(path, '/');
    size_t folder = slash ? (size_t)(slash - path) + 1 : 0;
    if (at_underscore) {
        while (length > folder && path[length] != '_')
            --length;
        if (length == folder) return false;
    }
    *out = malloc(length + strlen(ending) + 1);
    if (!*out) return false;
    memcpy(*out, path, length);
    memcpy(*out + length, ending, strlen(ending) + 1);
    if (access(*out, R_OK) == 0) return true;
    free(*out);
    *out = NULL;
    return false;
}

static ff_status find_skeleton(const char *path, char **out, ff_error *error)
{
    *out = NULL;
    if (skeleton_beside(path, false, ".asf", out) || skeleton_beside(path, true, ".asf", out) ||
        skeleton_beside(path, false, ".ASF", out) || skeleton_beside(path, true, ".ASF", out))
        return FF_OK;
    ff_fail(error, FF_ERR_IO,
            "no ASF skeleton beside it (the same name, or the part before '_', with .asf): name one "
            "(\"skeleton\")");
    ff_error_in_file(error, path);
    return FF_ERR_IO;
}

double ff_asf_unit(const ff_asf *asf)
{
    return asf->length > 0.0 ? 0.0254 / asf->length : 0.0; /* algorithms A.2: inches over the length entry */
}

ff_status ff_asf_load(const char *path, bool strict, ff_asf *out, ff_error *error)
{
    ff_file file;
    ff_status status = ff_file_map(path, &file, error);
    if (status != FF_OK) return status;
    status = ff_asf_parse(file.data, file.size, path, strict, out, error);
    ff_file_unmap(&file);
    return status;
}

static ff_status read_amc(const ff_file *file, const char *path, const ff_load_options *options,
                          double *unit_m, ff_clip *out, ff_error *error)
{
    char *found = NULL;
    ff_status status = options->skeleton ? FF_OK : find_skeleton(path, &found, error);
    ff_asf asf;
    if (status == FF_OK)
        status = ff_asf_load(found ? found : options->skeleton, options->strict, &asf, error);
    free(found);
    if (status != FF_OK) return status;
    *unit_m = ff_asf_unit(&asf);
    status = ff_amc_parse(&asf, file->data, file->size, path, options, out, error);
    ff_asf_free(&asf);
    return status;
}

/* NAME of NAME.bvh, NAME#ANIMATION of NAME.glb#ANIMATION. */
static ff_status name_clip(ff_clip *clip, const char *path)
{
    size_t file = ff_clip_file_length(path), base = file;
    while (base > 0 && path[base - 1] != '/')
        --base;
    size_t stem = file;
    while (stem > base && path[stem - 1] != '.')
        --stem;
    stem = stem > base + 1 ? stem - 1 - base : file - base;
    clip->source = strdup(path);
    clip->name = malloc(stem + strlen(path + file) + 1);
    if (!clip->source || !clip->name) return FF_ERR_NO_MEMORY;
    memcpy(clip->name, path + base, stem);
    memcpy(clip->name + stem, path + file, strlen(path + file) + 1);
    return FF_OK;
}

enum format { UNKNOWN, AMC, BVH, GLTF };

static enum format format_of(const char *file)
{
    static const struct {
        const char *ending;
        enum format format;
    } known[] = {{".amc", AMC}, {".bvh", BVH}, {".gltf", GLTF}, {".glb", GLTF}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i)
        if (strcasecmp(ending_of(file), known[i].ending) == 0) return known[i].format;
    return UNKNOWN;
}

/* path as given, file the part of it that names the file. */
static ff_status read_clip(const char *path, const char *file, const ff_load_options *options, ff_clip *out,
                           ff_error *error)
{
    enum format format = format_of(file);
    if (format == UNKNOWN)
        return ff_fail(error, FF_ERR_UNSUPPORTED,
                       "unknown kind of clip '%.20s', expected .amc, .bvh, .gltf or .glb", ending_of(file));
    ff_file bytes;
    ff_status status = ff_file_map(file, &bytes, error);
    if (status != FF_OK) return status;
    const char *animation = path[strlen(file)] == '#' ? path + strlen(file) + 1 : NULL;
    double stated_m = 0.0;
    if (format == AMC) {
        status = read_amc(&bytes, file, options, &stated_m, out, error);
    } else if (format == BVH) {
        status = ff_bvh_parse(bytes.data, bytes.size, file, options, out, error);
    } else {
        status = ff_gltf_parse(bytes.data, bytes.size, file, animation, options, out, error);
    }
    ff_file_unmap(&bytes);
    if (status == FF_OK) status = name_clip(out, path);
    if (status == FF_ERR_NO_MEMORY) return ff_fail(error, status, "no memory for the clip");
    if (status != FF_OK) return status;
    if (format != GLTF) return ff_clip_finish(out, options, stated_m, error);
    status = ff_clip_finish_sized(out, options, error);
    return status == FF_OK && !options->in_place ? ff_clip_restore_travel(out, options->strict, error)
                                                 : status;
}

ff_status ff_clip_load(const char *path, const ff_load_options *options, ff_clip *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    char *file = strndup(path, ff_clip_file_length(path));
    if (!file) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the clip's name");
    ff_status status = read_clip(path, file, options, out, error);
    free(file);
    if (status == FF_OK) return FF_OK;
    ff_error_in_file(error, path);
    ff_clip_free(out);
    return status;
}

/* --------------------------------------------------------------------------------------------------------- hash */

static ff_status hash_file(const char *path, uint64_t seed, uint64_t *hash, ff_error *error)
{
    ff_file file;
    ff_status status = ff_file_map(path, &file, error);
    if (status != FF_OK) return status;
    *hash = XXH64(file.data, file.size, seed);
    ff_file_unmap(&file);
    return FF_OK;
}

/* The files beside a .gltf. One that cannot be opened is the reader's to complain about. */
static ff_status hash_buffers(const char *path, uint64_t *hash, ff_error *error)
{
    ff_file file;
    ff_gltf gltf;
    ff_status status = ff_file_map(path, &file, error);
    if (status != FF_OK) return status;
    if (ff_gltf_open(file.data, file.size, path, (ff_gltf_keys){.all = true}, &gltf, NULL) == FF_OK) {
        for (int i = 0; i < gltf.buffer_count; ++i)
            *hash = XXH64(gltf.buffers[i].data, gltf.buffers[i].size, *hash);
        ff_gltf_close(&gltf);
    }
    ff_file_unmap(&file);
    return FF_OK;
}

static ff_status hash_all(const char *file, const ff_load_options *options, uint64_t *own, uint64_t *all,
                          ff_error *error)
{
    char *found = NULL;
    ff_status status = hash_file(file, 0, own, error);
    *all = *own;
    if (status == FF_OK && format_of(file) == AMC) {
        if (!options->skeleton) status = find_skeleton(file, &found, error);
        if (status == FF_OK) status = hash_file(found ? found : options->skeleton, *own, all, error);
        free(found);
    } else if (status == FF_OK && strcasecmp(ending_of(file), ".gltf") == 0) {
        status = hash_buffers(file, all, error);
    }
    return status;
}

ff_status ff_clip_hash(const char *path, const ff_load_options *options, uint64_t *own, uint64_t *all,
                       ff_error *error)
{
    char *file = strndup(path, ff_clip_file_length(path));
    if (!file) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the clip's name");
    ff_status status = hash_all(file, options, own, all, error);
    free(file);
    return status;
}
