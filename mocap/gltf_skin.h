/* gltf_skin.h - the skinned meshes of one body of a glTF document. */
#ifndef FF_GLTF_SKIN_H
#define FF_GLTF_SKIN_H

#include "mocap/gltf_skeleton.h"
#include "mocap/skin.h"

/* Vertices and triangles, in the rest pose of the skeleton; joint indices are the skeleton's. No vertex (and FF_OK) when
 * the body has no skinned mesh. The caller frees out->vertices and out->triangles with ff_skin_free. */
ff_status ff_gltf_skin_read(const ff_gltf *gltf, const ff_gltf_skeleton *skeleton, ff_skin *out,
                            ff_error *error);

#endif
