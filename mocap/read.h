/* read.h - the readers themselves: text in memory in, clip out. ff_clip_load (load.h) calls them on files.
 *
 * What they return is as the file has it: lengths in file units (clip.unit_m = 1), no roles, the file's
 * up axis, its own frame time. ff_clip_finish turns that into what clip.h promises.
 */
#ifndef FF_READ_H
#define FF_READ_H

#include "mocap/load.h"

/* Of the options the readers look at strict only. name stands in messages. On failure *out is zeroed. */
ff_status ff_bvh_parse(const char *data, size_t size, const char *name, const ff_load_options *options,
                       ff_clip *out, ff_error *error);

/* How every reader ends: the clip is in file units; of a failure the error names the file and the clip is freed. Returns
 * status. */
ff_status ff_clip_read_end(ff_status status, const char *name, ff_clip *out, ff_error *error);

/* A bone of an ASF as a joint at the bone's START that turns by C M C^-1 (algorithms A.2). */
typedef struct ff_asf_bone {
    char name[64];
    int joint;            /* index in ff_asf.joints */
    int dof_count;        /* values on the bone's AMC line, 0 = rigid */
    unsigned char dof[6]; /* in file order: 0 1 2 = rotation about x y z, 3 4 5 = translation (root only) */
    bool turned;          /* axis is not the identity */
    double axis[9];       /* C as a matrix, row by row */
} ff_asf_bone;

typedef struct ff_asf {
    ff_joint *joints; /* offsets in file units; parents first, end sites of leaf bones included */
    int joint_count;
    ff_asf_bone *bones; /* bones[0] is the root */
    int bone_count;
    ff_vec3 position; /* of the root, file units */
    double length;    /* the length entry of :units, 0 = not given */
    bool degrees;
    int warning_count;
    char warning[256];
} ff_asf;

ff_status ff_asf_parse(const char *data, size_t size, const char *name, bool strict, ff_asf *out,
                       ff_error *error);
void ff_asf_free(ff_asf *asf);

ff_status ff_asf_load(const char *path, bool strict, ff_asf *out, ff_error *error);
/* Metres per file unit as the file states it; 0 = it does not. */
double ff_asf_unit(const ff_asf *asf);

/* The motion of a skeleton; the clip gets its own copy of the joints. */
ff_status ff_amc_parse(const ff_asf *asf, const char *data, size_t size, const char *name,
                       const ff_load_options *options, ff_clip *out, ff_error *error);

/* One animation of a glTF document (NULL = the only or first one, else a name or an index in digits), at options->fps or
 * 60 frames/s from its first key on. Buffers beside the file are looked for in the folder of name. */
ff_status ff_gltf_parse(const char *data, size_t size, const char *name, const char *animation,
                        const ff_load_options *options, ff_clip *out, ff_error *error);

/* Bring what a reader returned into metres with Y up: find roles and the unit (stated_m is what the file
 * says a unit is, 0 = nothing), set the frame time. */
ff_status ff_clip_finish(ff_clip *clip, const ff_load_options *options, double stated_m, ff_error *error);

/* The same for a format in metres whose characters need not be of human size: others are scaled to a person's legs. */
ff_status ff_clip_finish_sized(ff_clip *clip, const ff_load_options *options, ff_error *error);

/* An animation that walks on the spot (planted feet slide) is moved so that planted feet stay, and one that also ends as
 * it began is repeated, so that whole steps can be cut from it (in_place.c). Both are warnings, or errors when strict. */
ff_status ff_clip_restore_travel(ff_clip *clip, bool strict, ff_error *error);

/* How many leading frames are a rest pose that was put before the motion. */
int ff_clip_count_rest_frames(const ff_clip *clip);

/* Make room for needed frames (and, in one go, for those that guess expects). Refuses absurd sizes. */
ff_status ff_clip_reserve(ff_clip *clip, int *capacity, int needed, int guess, ff_error *error);
/* Give back what was reserved too much. */
void ff_clip_trim(ff_clip *clip, int capacity);

/* q turned further about its own axis 0 1 2 = x y z; sine and cosine of half the angle. */
static inline ff_quat ff_quat_turn(ff_quat q, int axis, double s, double c)
{
    if (axis == 0)
        return (ff_quat){q.x * c + q.w * s, q.y * c + q.z * s, q.z * c - q.y * s, q.w * c - q.x * s};
    if (axis == 1)
        return (ff_quat){q.x * c - q.z * s, q.y * c + q.w * s, q.z * c + q.x * s, q.w * c - q.y * s};
    return (ff_quat){q.x * c + q.y * s, q.y * c - q.x * s, q.z * c + q.w * s, q.w * c - q.z * s};
}

#endif
