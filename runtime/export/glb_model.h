/* glb_model.h - a glTF 2.0 document being put together, and its binary form. A thin C face on tinygltf: every function
 * that adds something returns its index, or -1 when memory is short (the model is then marked and cannot be
 * written). */
#ifndef FF_GLB_MODEL_H
#define FF_GLB_MODEL_H

#include "runtime/footfall.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ff_glb_model ff_glb_model;

typedef enum ff_glb_component { FF_GLB_U8, FF_GLB_I16, FF_GLB_U16, FF_GLB_U32, FF_GLB_F32 } ff_glb_component;
/* What a view is for; the validator wants vertex data and indices told apart from the rest. */
typedef enum ff_glb_use { FF_GLB_DATA, FF_GLB_VERTICES, FF_GLB_INDICES } ff_glb_use;
typedef enum ff_glb_path { FF_GLB_TRANSLATION, FF_GLB_ROTATION, FF_GLB_SCALE } ff_glb_path;

ff_glb_model *ff_glb_model_create(const char *generator);
void ff_glb_model_destroy(ff_glb_model *model);

/* Copy size bytes to the binary chunk, at a multiple of 4; stride 0 = tightly packed. */
int ff_glb_add_view(ff_glb_model *model, const void *data, size_t size, size_t stride, ff_glb_use use);

/* `width` components per element (1, 3, 4, 16). low and high (width numbers each) are the bounds, or NULL. */
int ff_glb_add_accessor(ff_glb_model *model, int view, size_t offset, ff_glb_component component,
                        int normalised, int width, size_t count, const double *low, const double *high);

int ff_glb_add_material(ff_glb_model *model, const char *name, const double linear_rgb[3], double roughness,
                        int both_sides);

/* A primitive of triangles; joints and weights may be -1. The accessors are shared by whoever names them. */
typedef struct ff_glb_primitive {
    int positions, normals, joints, weights, indices, material;
} ff_glb_primitive;
int ff_glb_add_mesh(ff_glb_model *model, const char *name, const ff_glb_primitive *primitives, int count);

/* parent -1: at the top of the scene. */
int ff_glb_add_node(ff_glb_model *model, const char *name, int parent, ff_vec3 translation);
void ff_glb_set_translation(ff_glb_model *model, int node, ff_vec3 translation); /* 0 writes nothing */
void ff_glb_set_rotation(ff_glb_model *model, int node, ff_quat rotation);
void ff_glb_set_scale(ff_glb_model *model, int node, double scale); /* 1 writes nothing */
void ff_glb_set_mesh(ff_glb_model *model, int node, int mesh, int skin);
int ff_glb_add_skin(ff_glb_model *model, const char *name, const int *joints, int count, int inverse_binds);

int ff_glb_add_animation(ff_glb_model *model, const char *name);
void ff_glb_add_channel(ff_glb_model *model, int animation, int node, ff_glb_path path, int times, int values,
                        int stepped);

/* The whole file as bytes (free()). */
ff_status ff_glb_model_serialise(ff_glb_model *model, char **bytes, size_t *size, ff_error *error);

#ifdef __cplusplus
}
#endif
#endif
