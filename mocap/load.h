/* load.h - a clip from a file of any known format. */
#ifndef FF_LOAD_H
#define FF_LOAD_H

#include "mocap/clip.h"

typedef struct ff_role_override {
    const char *joint; /* name in the file */
    ff_role role;
} ff_role_override;

typedef struct ff_load_options {
    double unit_m; /* metres per file unit; 0 = the file's own statement, else the likeliest by leg length */
    double fps;    /* 0 = what the file says, 120 for AMC */
    char up;       /* 'y' or 'z' */
    bool strict;   /* oddities that are worked around become errors */
    const char *skeleton; /* ASF of an AMC; NULL = look beside it (NAME.asf, or the part before '_') */
    bool in_place;        /* glTF: leave an animation that walks on the spot there */
    const ff_role_override *overrides;
    int override_count;
} ff_load_options;

ff_load_options ff_load_options_default(void);

/* Read path (.amc, .bvh, .gltf, .glb by ending, case-insensitive). FILE.glb#ANIMATION is one animation of a glTF file, by
 * name or index; without it the first is taken. On failure *out is zeroed and error says file:line:column. The caller
 * frees *out with ff_clip_free. */
ff_status ff_clip_load(const char *path, const ff_load_options *options, ff_clip *out, ff_error *error);

/* Read the skeleton of a file (.asf, .bvh, .gltf, .glb, .amc) as a clip: of an ASF, or of a glTF character that nothing
 * moves, its rest pose as the one frame, of any other the clip. Hips, knees and ankles must be there, else
 * FF_ERR_NO_DATA names the missing one. Otherwise as ff_clip_load. */
ff_status ff_skeleton_load(const char *path, const ff_load_options *options, ff_clip *out, ff_error *error);

/* How much of a path is the file's: all of it, but for the #ANIMATION after .gltf or .glb. */
size_t ff_clip_file_length(const char *path);

/* XXH64 of the file's bytes (own), and of everything that loading it reads (all: also the skeleton of an AMC, the buffers of a glTF).
 * Which animation of a glTF file path means does not count. */
ff_status ff_clip_hash(const char *path, const ff_load_options *options, uint64_t *own, uint64_t *all,
                       ff_error *error);

/* Metres per file unit of a preset ("cmu", "m", "cm", "inch"), or 0 for an unknown name. */
double ff_unit_preset(const char *name);

#endif
