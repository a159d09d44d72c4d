/* In two steps: rotations to local matrices, some joints at a time; then parent times child, down the tree. */
#include "runtime/core/pose/pose_matrices.h"

void ff_pose_lanes(const ff_quat *rotations, uint32_t joint_count, uint32_t lanes, float *out)
{
    float *x = out, *y = x + lanes, *z = y + lanes, *w = z + lanes;
    for (uint32_t j = 0; j < joint_count; ++j) {
        x[j] = (float)rotations[j].x;
        y[j] = (float)rotations[j].y;
        z[j] = (float)rotations[j].z;
        w[j] = (float)rotations[j].w;
    }
    for (uint32_t j = joint_count; j < lanes; ++j)
        x[j] = y[j] = z[j] = 0.0f, w[j] = 1.0f;
}

/* Joint 0's rotation becomes its matrix: all others follow it, in place and in size. */
static void put_root(const ff_pose_root *root, ff_matrix *out)
{
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k)
            out->row[i][k] *= root->scale;
        out->row[i][3] = root->place[i];
    }
}

/* -------------------------------------------------------------------------------------------------- in plain C */

static void local_plain(const ff_pose_tree *tree, const float *rotations, uint32_t j, ff_matrix *out)
{
    uint32_t lanes = tree->lanes;
    float x = rotations[j], y = rotations[lanes + j], z = rotations[2 * lanes + j],
          w = rotations[3 * lanes + j];
    float x2 = x + x, y2 = y + y, z2 = z + z;
    float xx = x * x2, yy = y * y2, zz = z * z2, xy = x * y2, xz = x * z2, yz = y * z2, wx = w * x2,
          wy = w * y2, wz = w * z2;
    const float *offset = tree->offsets + j;
    *out = (ff_matrix){{{1.0f - (yy + zz), xy - wz, xz + wy, offset[0]},
                        {xy + wz, 1.0f - (xx + zz), yz - wx, offset[lanes]},
                        {xz - wy, yz + wx, 1.0f - (xx + yy), offset[2 * lanes]}}};
}

static void multiply_plain(const ff_matrix *restrict parent, const ff_matrix *restrict local,
                           ff_matrix *restrict out)
{
    for (int i = 0; i < 3; ++i) {
        const float *p = parent->row[i];
        for (int k = 0; k < 4; ++k)
            out->row[i][k] = (p[0] * local->row[0][k] + p[1] * local->row[1][k]) + p[2] * local->row[2][k];
        out->row[i][3] += p[3];
    }
}

/* All local matrices first: read back as whole rows at once, they would stall on the parts just written. */
void ff_pose_matrices_plain(const ff_pose_tree *tree, const float *rotations, const ff_pose_root *root,
                            ff_matrix *out)
{
    ff_matrix local[FF_POSE_LANES_MAX];
    local_plain(tree, rotations, 0, &out[0]);
    for (uint32_t j = 1; j < tree->joint_count; ++j)
        local_plain(tree, rotations, j, &local[j]);
    put_root(root, &out[0]);
    for (uint32_t j = 1; j < tree->joint_count; ++j)
        multiply_plain(&out[tree->parents[j]], &local[j], &out[j]);
}

/* ----------------------------------------------------------------------------------------------------- with SSE2 */

#if defined(__SSE2__)
#include "runtime/core/pose/pose_matrices_sse2.h"

void ff_pose_matrices(const ff_pose_tree *tree, const float *rotations, const ff_pose_root *root,
                      ff_matrix *out)
{
    matrices_sse2(tree, rotations, root, out);
}
#else
void ff_pose_matrices(const ff_pose_tree *tree, const float *rotations, const ff_pose_root *root,
                      ff_matrix *out)
{
    ff_pose_matrices_plain(tree, rotations, root, out);
}
#endif
