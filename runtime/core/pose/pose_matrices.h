/* pose_matrices.h - from local rotations to matrices of all joints in the world. */
#ifndef FF_POSE_MATRICES_H
#define FF_POSE_MATRICES_H

#include "runtime/core/pose/pose_blend.h"

/* Of the joints: parents before children, joint 0 the root. Offsets from the parents x[lanes], y, z; m. */
typedef struct ff_pose_tree {
    const int32_t *parents;
    const float *offsets;
    uint32_t joint_count, lanes; /* lanes: as in ff_pose_store */
} ff_pose_tree;

/* Where joint 0 is in the world, and how large a body is beside the tree. */
typedef struct ff_pose_root {
    float place[3], scale;
} ff_pose_root;

/* rotations: unit quaternions x[lanes], y, z, w, local to the parent; of joint 0 in the world. out[joint_count]. The same
 * bits with SIMD instructions and without. */
void ff_pose_matrices(const ff_pose_tree *tree, const float *rotations, const ff_pose_root *root,
                      ff_matrix *out);
/* The same in plain C: what ff_pose_matrices is where there is no SSE2, and what it is tested against. */
void ff_pose_matrices_plain(const ff_pose_tree *tree, const float *rotations, const ff_pose_root *root,
                            ff_matrix *out);

/* From quaternions to lanes (those without a joint become the identity). */
void ff_pose_lanes(const ff_quat *rotations, uint32_t joint_count, uint32_t lanes, float *out);

#endif
