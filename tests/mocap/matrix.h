/* matrix.h - rotation matrices by their definition, an independent truth for the readers' quaternions. */
#ifndef FF_TEST_MATRIX_H
#define FF_TEST_MATRIX_H

#include "tests/check.h"

typedef struct matrix {
    double m[3][3];
} matrix;

static inline matrix matrix_about(char axis, double degrees)
{
    double c = cos(degrees * FF_PI / 180.0), s = sin(degrees * FF_PI / 180.0);
    if (axis == 'x') return (matrix){{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
    if (axis == 'y') return (matrix){{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
    return (matrix){{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}

static inline matrix matrix_times(matrix a, matrix b)
{
    matrix r = {{{0}}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                r.m[i][j] += a.m[i][k] * b.m[k][j];
    return r;
}

static inline matrix matrix_transposed(matrix a)
{
    matrix r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            r.m[i][j] = a.m[j][i];
    return r;
}

static inline ff_vec3 matrix_apply(matrix a, ff_vec3 v)
{
    return ff_v3(a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z,
                 a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
                 a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z);
}

/* Rotations in the order written, each about the axes that the one before turned: "zxy" = Rz Rx Ry. */
static inline matrix matrix_intrinsic(const char *axes, double a, double b, double c)
{
    return matrix_times(matrix_times(matrix_about(axes[0], a), matrix_about(axes[1], b)),
                        matrix_about(axes[2], c));
}

#define FF_ASSERT_AT(got, want, tolerance)                                                                   \
    FF_ASSERT_NEAR((got).x, (want).x, tolerance);                                                            \
    FF_ASSERT_NEAR((got).y, (want).y, tolerance);                                                            \
    FF_ASSERT_NEAR((got).z, (want).z, tolerance)

#endif
