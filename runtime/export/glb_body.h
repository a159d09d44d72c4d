/* glb_body.h - the shared body and the clothes of a glTF document. */
#ifndef FF_GLB_BODY_H
#define FF_GLB_BODY_H

#include "runtime/export/body_mesh.h"
#include "runtime/export/glb_model.h"
#include "runtime/export/look.h"

/* Accessors of the body, to be worn by any number of meshes; materials and meshes already made. */
typedef struct ff_glb_wardrobe {
    int positions, normals, joints, weights, inverse_binds;
    int indices[FF_COVER_COUNT]; /* -1: nothing wears this cover */
    ff_array materials;          /* of distinct colours */
    ff_array meshes;             /* of distinct looks */
} ff_glb_wardrobe;

ff_status ff_glb_wardrobe_create(ff_glb_model *model, const ff_figure *figure, ff_glb_wardrobe *out,
                                 ff_error *error);
void ff_glb_wardrobe_free(ff_glb_wardrobe *wardrobe);

/* The mesh of a body dressed like this, made when first asked for; -1 when memory is short. */
int ff_glb_wardrobe_mesh(ff_glb_wardrobe *wardrobe, ff_glb_model *model, const ff_look *look);

#endif
