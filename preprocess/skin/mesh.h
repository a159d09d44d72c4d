/* mesh.h - the surface of a character on the pack's skeleton: cleaned, and at three levels of detail. */
#ifndef FF_MESH_H
#define FF_MESH_H

#include "mocap/skin.h"
#include "preprocess/motion/motion.h"
#include "runtime/core/pack/pack_format.h"

enum { FF_MESH_LEVELS = 3 };

/* Joints of the vertices are roles below FF_ROLE_JOINT_COUNT. */
typedef struct ff_mesh {
    ff_skin_vertex *vertices;
    int vertex_count;
    uint32_t (*triangles)[3]; /* counter-clockwise from outside */
    int triangle_count;
} ff_mesh;

void ff_mesh_free(ff_mesh *mesh);

/* What was wrong with a mesh. */
typedef struct ff_mesh_faults {
    int degenerate, repeated; /* triangles that were left out */
    int unused;               /* vertices that no triangle used */
    int torn;                 /* triangles at edges with more than two, given vertices of their own */
} ff_mesh_faults;

/* A skin brought into the rest pose and the proportions of the rig (joint directions as in retargeting, bones stretched to
 * the rig's). radius [FF_ROLE_JOINT_COUNT] receives how thick the body is about each bone (m): 90 % of the vertices that
 * hang mostly on it are nearer to it; 0 where there are none. */
ff_status ff_mesh_fit(const ff_skin *skin, const ff_rig *rig, ff_mesh *out, double *radius, ff_error *error);

/* How far (m) the fitted body reaches about the middles of the colliders (annotate.h): 95 % of the vertices that are mostly a
 * head's, hand's, foot's or the hips' are within. Left and right alike; 0 where there are none. */
ff_status ff_mesh_collider_radii(const ff_mesh *mesh, const ff_rig *rig, double out[FF_COLLIDER_COUNT],
                                 ff_error *error);

/* Leave out what is wrong in place: degenerate and repeated triangles, unused vertices. */
ff_status ff_mesh_clean(ff_mesh *mesh, ff_mesh_faults *faults, ff_error *error);

/* At most about `triangles` triangles: vertices at one place are welded, edges collapse by the quadric error (Garland and
 * Heckbert 1997), so every vertex left is one of the old ones with its own weights; normals are made anew, with creases
 * where faces meet at more than `crease` degrees. */
ff_status ff_mesh_reduce(const ff_mesh *mesh, int triangles, double crease, ff_mesh *out,
                         ff_mesh_faults *faults, ff_error *error);

/* The three levels of detail of a cleaned mesh, finest first; faults->torn counts those of the finest. */
ff_status ff_mesh_levels(const ff_skin_settings *settings, const ff_mesh *mesh,
                         ff_mesh levels[FF_MESH_LEVELS], ff_mesh_faults *faults, ff_error *error);

/* Part of the above (mesh_openmesh.cpp): triangles over welded places [count]; on success *kept (free()) lists the places that
 * are left and *faces (free()) the triangles over that list. */
ff_status ff_mesh_collapse(const ff_vec3 *places, int count, const uint32_t (*triangles)[3],
                           int triangle_count, int wanted, int **kept, int *kept_count, uint32_t (**faces)[3],
                           int *face_count, int *torn, ff_error *error);

#endif
