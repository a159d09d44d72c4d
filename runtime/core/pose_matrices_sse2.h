/* pose_matrices_sse2.h - part of pose_matrices.c: local matrices of four joints at once, then a row at a time. */
#include <emmintrin.h>

typedef struct rows {
    __m128 row[3];
} rows;

/* local_plain() of joints j to j + 3. */
static inline void four_locals(const ff_pose_tree *tree, const float *rotations, uint32_t j, rows out[4])
{
    uint32_t lanes = tree->lanes;
    const __m128 one = _mm_set1_ps(1.0f);
    __m128 x = _mm_loadu_ps(rotations + j), y = _mm_loadu_ps(rotations + lanes + j),
           z = _mm_loadu_ps(rotations + 2 * lanes + j), w = _mm_loadu_ps(rotations + 3 * lanes + j);
    __m128 x2 = _mm_add_ps(x, x), y2 = _mm_add_ps(y, y), z2 = _mm_add_ps(z, z);
    __m128 xx = _mm_mul_ps(x, x2), yy = _mm_mul_ps(y, y2), zz = _mm_mul_ps(z, z2), xy = _mm_mul_ps(x, y2),
           xz = _mm_mul_ps(x, z2), yz = _mm_mul_ps(y, z2), wx = _mm_mul_ps(w, x2), wy = _mm_mul_ps(w, y2),
           wz = _mm_mul_ps(w, z2);
    __m128 m[3][4] = {{_mm_sub_ps(one, _mm_add_ps(yy, zz)), _mm_sub_ps(xy, wz), _mm_add_ps(xz, wy),
                       _mm_loadu_ps(tree->offsets + j)},
                      {_mm_add_ps(xy, wz), _mm_sub_ps(one, _mm_add_ps(xx, zz)), _mm_sub_ps(yz, wx),
                       _mm_loadu_ps(tree->offsets + lanes + j)},
                      {_mm_sub_ps(xz, wy), _mm_add_ps(yz, wx), _mm_sub_ps(one, _mm_add_ps(xx, yy)),
                       _mm_loadu_ps(tree->offsets + 2 * lanes + j)}};
    for (int i = 0; i < 3; ++i) {
        _MM_TRANSPOSE4_PS(m[i][0], m[i][1], m[i][2], m[i][3]);
        for (int k = 0; k < 4; ++k)
            out[k].row[i] = m[i][k];
    }
}

static inline __m128 last_of(__m128 row)
{
    return _mm_and_ps(row, _mm_castsi128_ps(_mm_set_epi32(-1, 0, 0, 0)));
}

static inline __m128 with_place(__m128 row, float place)
{
    return _mm_add_ps(_mm_sub_ps(row, last_of(row)), last_of(_mm_set1_ps(place)));
}

/* A row of multiply_plain(). */
static inline __m128 row_times(__m128 p, rows local)
{
    __m128 a = _mm_mul_ps(_mm_shuffle_ps(p, p, _MM_SHUFFLE(0, 0, 0, 0)), local.row[0]);
    __m128 b = _mm_mul_ps(_mm_shuffle_ps(p, p, _MM_SHUFFLE(1, 1, 1, 1)), local.row[1]);
    __m128 c = _mm_mul_ps(_mm_shuffle_ps(p, p, _MM_SHUFFLE(2, 2, 2, 2)), local.row[2]);
    return _mm_add_ps(_mm_add_ps(a, b), _mm_add_ps(c, last_of(p)));
}

static inline void matrices_sse2(const ff_pose_tree *tree, const float *rotations, const float hips[3],
                                 ff_matrix *out)
{
    rows local[4];
    for (uint32_t j = 0; j < tree->joint_count; ++j) {
        if (j % 4 == 0) four_locals(tree, rotations, j, local);
        const rows *own = &local[j % 4];
        for (int i = 0; i < 3; ++i) {
            __m128 row = j == 0 ? with_place(own->row[i], hips[i])
                                : row_times(_mm_loadu_ps(out[tree->parents[j]].row[i]), *own);
            _mm_storeu_ps(out[j].row[i], row);
        }
    }
}
