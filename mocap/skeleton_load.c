/* A skeleton alone, as a clip of one pose: what a pack is to be built on. */
#define _POSIX_C_SOURCE 200809L
#include "mocap/load.h"
#include "mocap/read.h"
#include "mocap/roles_find.h"
#include "mocap/skin.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum kind { UNKNOWN, ASF, CLIP, GLTF };

static enum kind kind_of(const char *path)
{
    static const struct {
        const char *ending;
        enum kind kind;
    } known[] = {{".asf", ASF}, {".amc", CLIP}, {".bvh", CLIP}, {".glb", GLTF}, {".gltf", GLTF}};
    size_t length = ff_clip_file_length(path);
    for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i) {
        size_t size = strlen(known[i].ending);
        if (length > size && strncasecmp(path + length - size, known[i].ending, size) == 0)
            return known[i].kind;
    }
    return UNKNOWN;
}

/* One frame in which nothing is turned; the joints go over to the clip. */
static ff_status rest_of(ff_asf *asf, const char *path, ff_clip *out)
{
    out->joints = asf->joints;
    out->joint_count = asf->joint_count;
    asf->joints = NULL;
    out->track_count = 1; /* the root's */
    out->frame_count = 1;
    out->frame_time = 1.0;
    out->name = strdup("skeleton");
    out->source = strdup(path);
    out->rotations = ff_calloc((size_t)out->joint_count, sizeof *out->rotations);
    out->positions = ff_calloc(1, sizeof *out->positions);
    if (!out->name || !out->source || !out->rotations || !out->positions) return FF_ERR_NO_MEMORY;
    for (int j = 0; j < out->joint_count; ++j)
        out->rotations[j] = FF_QUAT_IDENTITY;
    out->positions[0] = asf->position;
    return FF_OK;
}

static ff_status load_asf(const char *path, const ff_load_options *options, ff_clip *out, ff_error *error)
{
    ff_asf asf;
    ff_status status = ff_asf_load(path, options->strict, &asf, error);
    if (status != FF_OK) return status;
    double stated_m = ff_asf_unit(&asf);
    if (rest_of(&asf, path, out) != FF_OK)
        status = ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the skeleton");
    ff_asf_free(&asf);
    return status == FF_OK ? ff_clip_finish(out, options, stated_m, error) : status;
}

/* A character that does not move. */
static ff_status load_skin(const char *path, const ff_load_options *options, ff_clip *out, ff_error *error)
{
    ff_skin skin;
    ff_status status = ff_skin_load(path, options, &skin, error);
    if (status != FF_OK) return status;
    status = ff_skin_rest_clip(&skin, out, error);
    ff_skin_free(&skin);
    return status;
}

ff_status ff_skeleton_load(const char *path, const ff_load_options *options, ff_clip *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    enum kind kind = kind_of(path);
    ff_status status = kind == UNKNOWN
                           ? ff_fail(error, FF_ERR_UNSUPPORTED,
                                     "unknown kind of skeleton, expected .asf, .bvh, .gltf, .glb or .amc")
                       : kind == ASF ? load_asf(path, options, out, error)
                                     : ff_clip_load(path, options, out, error);
    if (kind == GLTF && status == FF_ERR_NO_DATA) status = load_skin(path, options, out, error);
    if (status == FF_OK) status = ff_roles_require(out, error);
    if (status == FF_OK) return FF_OK;
    ff_error_in_file(error, path);
    ff_clip_free(out);
    return status;
}
