/* body_mesh.h - one skinned body shared by everybody: the pack's character, or else a person made from the bones at run
 * time. */
#ifndef FF_BODY_MESH_H
#define FF_BODY_MESH_H

#include "runtime/core/base/memory.h"
#include "runtime/export/body_shape.h"

typedef struct ff_body_vertex {
    float position[3], normal[3]; /* rest pose, m */
    uint8_t joints[4];            /* unused ones are joint 0 with weight 0 */
    uint8_t weights[4];           /* sum 255 */
    uint8_t cover;                /* ff_cover */
} ff_body_vertex;

typedef struct ff_body_mesh {
    ff_array vertices;  /* ff_body_vertex */
    ff_array triangles; /* uint32_t[3], counter-clockwise from outside, sorted by cover */
    uint32_t cover_first[FF_COVER_COUNT + 1]; /* first triangle of each cover */
} ff_body_mesh;

/* cell: m, size of the details, about the length of an edge. */
ff_status ff_body_mesh_make(const ff_figure *figure, double cell, ff_body_mesh *out, ff_error *error);
void ff_body_mesh_free(ff_body_mesh *mesh);

/* 1 for joints of left limbs, -1 of right ones, 0 for trunk and head. */
int ff_joint_side(uint32_t joint);

/* Where every vertex is in a pose: positions and normals [vertex count]. */
void ff_body_mesh_skin(const ff_body_mesh *mesh, const ff_figure *figure, const ff_vec3 *joint_positions,
                       const ff_quat *joint_rotations, ff_vec3 *positions, ff_vec3 *normals);

#endif
