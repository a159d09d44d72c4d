/* glb_parts.h - what bodies and surroundings of a glTF document are made of. Each returns an index, as glb_model.h. */
#ifndef FF_GLB_PARTS_H
#define FF_GLB_PARTS_H

#include "runtime/export/glb_model.h"
#include "runtime/export/picture.h"

#include <stdbool.h>

/* One plain colour, given as it is on the screen (sRGB). */
int ff_glb_add_paint(ff_glb_model *model, const char *name, ff_colour colour, int both_sides);

/* count positions or normals of vertices; bounded: with their bounds, as positions must be. */
int ff_glb_add_vectors(ff_glb_model *model, const float (*values)[3], size_t count, bool bounded);

/* count triangles. */
int ff_glb_add_indices(ff_glb_model *model, const uint32_t (*triangles)[3], size_t count);

#endif
