/* gltf.h - a glTF 2.0 document as plain arrays: what of it has to do with motion and skins.
 *
 * tinygltf parses; gltf_guard.h looks at the bytes before it does, so that it never sees a file, a picture or anything it
 * was not built for. Every index in the arrays is checked: -1 = none, everything else exists.
 */
#ifndef FF_GLTF_H
#define FF_GLTF_H

#include "runtime/footfall.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ff_gltf_node {
    char name[64]; /* cut after 63 bytes; "" when the file gives none */
    int parent;
    int mesh, skin;
    bool has_matrix;
    double matrix[16]; /* column by column */
    double translation[3], rotation[4], scale[3];
} ff_gltf_node;

typedef struct ff_gltf_view {
    int buffer;
    size_t offset, size, stride; /* bytes; stride 0 = packed */
    int number;                  /* in the file */
} ff_gltf_view;

typedef struct ff_gltf_buffer {
    const unsigned char *data;
    size_t size;
} ff_gltf_buffer;

typedef enum ff_gltf_component {
    FF_GLTF_I8 = 5120,
    FF_GLTF_U8 = 5121,
    FF_GLTF_I16 = 5122,
    FF_GLTF_U16 = 5123,
    FF_GLTF_U32 = 5125,
    FF_GLTF_F32 = 5126
} ff_gltf_component;

/* Numbers in one place of one view. */
typedef struct ff_gltf_place {
    int view; /* -1: zeros */
    size_t offset;
    int component; /* ff_gltf_component */
} ff_gltf_place;

typedef struct ff_gltf_accessor {
    ff_gltf_place at;
    int width; /* numbers per element */
    size_t count;
    bool normalised;
    int number;          /* in the file */
    size_t sparse_count; /* elements that are replaced; 0 = not sparse */
    ff_gltf_place sparse_indices, sparse_values;
} ff_gltf_accessor;

typedef enum ff_gltf_path {
    FF_GLTF_TRANSLATION,
    FF_GLTF_ROTATION,
    FF_GLTF_SCALE,
    FF_GLTF_OTHER
} ff_gltf_path;
typedef enum ff_gltf_interpolation {
    FF_GLTF_LINEAR,
    FF_GLTF_STEP,
    FF_GLTF_CUBICSPLINE
} ff_gltf_interpolation;

typedef struct ff_gltf_channel {
    int node; /* -1: nothing that this reader knows */
    ff_gltf_path path;
    ff_gltf_interpolation interpolation;
    int input, output; /* accessors */
} ff_gltf_channel;

typedef struct ff_gltf_animation {
    char name[64];
    int first_channel, channel_count;
} ff_gltf_animation;

typedef struct ff_gltf_skin {
    char name[64];
    int first_joint, joint_count; /* into skin_joints */
    int inverse_bind;             /* accessor */
} ff_gltf_skin;

typedef struct ff_gltf_primitive {
    int mode; /* 4 = triangles */
    int indices, position, normal, uv, joints, weights;
    bool more_weights; /* JOINTS_1: more than four bones a vertex */
} ff_gltf_primitive;

typedef struct ff_gltf_mesh {
    char name[64];
    int first_primitive, primitive_count;
} ff_gltf_mesh;

typedef struct ff_gltf {
    ff_gltf_node *nodes;
    int node_count;
    int *order; /* node indices depth first: parents before children */
    ff_gltf_buffer *buffers;
    int buffer_count;
    ff_gltf_view *views;
    int view_count;
    ff_gltf_accessor *accessors;
    int accessor_count;
    ff_gltf_animation *animations;
    int animation_count;
    ff_gltf_channel *channels;
    int channel_count;
    ff_gltf_skin *skins;
    int skin_count;
    int *skin_joints; /* nodes */
    int skin_joint_count;
    ff_gltf_mesh *meshes;
    int mesh_count;
    ff_gltf_primitive *primitives;
    int primitive_count;
    void *model; /* tinygltf's, which owns the buffers' bytes */
} ff_gltf;

/* Whose keys are read: those of all animations, or of one (name, or index in digits; NULL = the first). The others keep
 * their places and names and have no channels. */
typedef struct ff_gltf_keys {
    bool all;
    const char *animation;
} ff_gltf_keys;

/* Index of the animation that is so called, else of the one with that index, else -1; NULL is the first. */
int ff_gltf_find_animation(const char *const *names, int count, const char *wanted);

/* Read a .gltf or .glb that is in memory; path is where it came from: external buffers are looked for in its folder and
 * nowhere else. On failure *out is zeroed. */
ff_status ff_gltf_open(const char *data, size_t size, const char *path, ff_gltf_keys keys, ff_gltf *out,
                       ff_error *error);
void ff_gltf_close(ff_gltf *gltf);

/* All numbers of an accessor (count * width) as doubles: sparse elements put in, normalised integers made [-1, 1] or
 * [0, 1]. The caller frees *out. */
ff_status ff_gltf_read(const ff_gltf *gltf, int accessor, double **out, ff_error *error);

/* Parts of ff_gltf_open: tinygltf's model into arrays, and every index and extent of them checked. */
ff_status ff_gltf_adapt(const char *json, const ff_gltf_buffer *buffers, int buffer_count, ff_gltf *out,
                        ff_error *error);
void ff_gltf_release_model(void *model);
ff_status ff_gltf_check(ff_gltf *gltf, ff_error *error);

#ifdef __cplusplus
}
#endif
#endif
