/* figure.h - the pack's skeleton as the exporters need it: names, rest pose, forward kinematics.
 *
 * Joint j of a pack always plays the same part (runtime/core/pack/joints.h), so that an exporter may say
 * FF_JOINT_KNEE_L and never look at a name. In the rest pose every rotation is the identity: facing +Z, arms out to
 * the sides, legs straight down, soles at y = 0.
 */
#ifndef FF_FIGURE_H
#define FF_FIGURE_H

#include "runtime/core/base/maths.h"
#include "runtime/core/pack/joints.h"
#include "runtime/core/pack/pack_format.h"

#define FF_FIGURE_MAX_JOINTS 64

typedef struct ff_figure {
    uint32_t joint_count;
    int32_t parent[FF_FIGURE_MAX_JOINTS];
    ff_vec3 offset[FF_FIGURE_MAX_JOINTS]; /* m, from the parent; hips: from the ground */
    ff_vec3 rest[FF_FIGURE_MAX_JOINTS];   /* m, in the rest pose */
    char name[FF_FIGURE_MAX_JOINTS][48];
    /* The character's surface, finest level, borrowed from the pack; NULL = none, a body is made from the bones. */
    const ff_pack_vertex *vertices;
    const ff_pack_triangle *triangles;
    uint32_t vertex_count, triangle_count;
} ff_figure;

/* Fails with FF_ERR_UNSUPPORTED when the skeleton is not one of a person (fewer joints than FF_JOINT_COUNT). */
ff_status ff_figure_from_pack(const ff_pack *pack, ff_figure *out, ff_error *error);
ff_status ff_figure_from_joints(uint32_t count, const int32_t *parents, const ff_vec3 *offsets,
                                const char *const *names, ff_figure *out, ff_error *error);

/* The same of a body scale times as large. */
void ff_figure_place_scaled(const ff_figure *figure, double scale, ff_vec3 hips, const ff_quat *local,
                            ff_vec3 *positions, ff_quat *rotations);

/* World positions and rotations of every joint; either output may be NULL. */
void ff_figure_place(const ff_figure *figure, ff_vec3 hips, const ff_quat *local, ff_vec3 *positions,
                     ff_quat *rotations);

/* End of the bone that starts at a leaf joint, in that joint's frame and in people's usual proportions: head top,
 * fingertips, toe tips. The public interface knows joints only, and this is for drawing and for BVH end sites. */
ff_vec3 ff_figure_tip(const ff_figure *figure, uint32_t joint);

/* 1 for a person with hips 0.95 m above the ground. */
double ff_figure_scale(const ff_figure *figure);

#endif
