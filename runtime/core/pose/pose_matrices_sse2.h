/* pose_matrices_sse2.h - part of pose_matrices.c: local matrices of four joints at once, then a row at a time. */
#include <emmintrin.h>

/* One row of four joints' matrices, from its four columns. */
static inline void put_rows(__m128 c0, __m128 c1, __m128 c2, __m128 c3, uint32_t row, ff_matrix *out)
{
    _MM_TRANSPOSE4_PS(c0, c1, c2, c3);
    _mm_store_ps(out[0].row[row], c0);
    _mm_store_ps(out[1].row[row], c1);
    _mm_store_ps(out[2].row[row], c2);
    _mm_store_ps(out[3].row[row], c3);
}

/* local_plain() of joints j to j + 3. */
static inline void four_locals(const ff_pose_tree *tree, const float *rotations, uint32_t j, ff_matrix *out)
{
    size_t lanes = tree->lanes;
    const __m128 one = _mm_set1_ps(1.0f);
    const float *at = rotations + j, *offset = tree->offsets + j;
    __m128 x = _mm_loadu_ps(at), y = _mm_loadu_ps(at + lanes), z = _mm_loadu_ps(at + 2 * lanes),
           w = _mm_loadu_ps(at + 3 * lanes);
    __m128 x2 = _mm_add_ps(x, x), y2 = _mm_add_ps(y, y), z2 = _mm_add_ps(z, z);
    __m128 xx = _mm_mul_ps(x, x2), yy = _mm_mul_ps(y, y2), zz = _mm_mul_ps(z, z2);
    __m128 xy = _mm_mul_ps(x, y2), xz = _mm_mul_ps(x, z2), yz = _mm_mul_ps(y, z2);
    __m128 wx = _mm_mul_ps(w, x2), wy = _mm_mul_ps(w, y2), wz = _mm_mul_ps(w, z2);
    put_rows(_mm_sub_ps(one, _mm_add_ps(yy, zz)), _mm_sub_ps(xy, wz), _mm_add_ps(xz, wy),
             _mm_loadu_ps(offset), 0, out);
    put_rows(_mm_add_ps(xy, wz), _mm_sub_ps(one, _mm_add_ps(xx, zz)), _mm_sub_ps(yz, wx),
             _mm_loadu_ps(offset + lanes), 1, out);
    put_rows(_mm_sub_ps(xz, wy), _mm_add_ps(yz, wx), _mm_sub_ps(one, _mm_add_ps(xx, yy)),
             _mm_loadu_ps(offset + 2 * lanes), 2, out);
}

static inline __m128 last_of(__m128 row)
{
    return _mm_and_ps(row, _mm_castsi128_ps(_mm_set_epi32(-1, 0, 0, 0)));
}

#define SPREAD(row, lane)                                                                                    \
    _mm_castsi128_ps(_mm_shuffle_epi32(_mm_castps_si128(row), _MM_SHUFFLE(lane, lane, lane, lane)))

/* A row of multiply_plain(). Adding -0 to what is no place changes nothing, not even its sign. */
static inline __m128 row_times(__m128 p, __m128 l0, __m128 l1, __m128 l2)
{
    __m128 sum = _mm_add_ps(_mm_mul_ps(SPREAD(p, 0), l0), _mm_mul_ps(SPREAD(p, 1), l1));
    sum = _mm_add_ps(sum, _mm_mul_ps(SPREAD(p, 2), l2));
    return _mm_add_ps(sum, _mm_or_ps(last_of(p), _mm_set_ps(0.0f, -0.0f, -0.0f, -0.0f)));
}

static inline void multiply(const ff_matrix *parent, const ff_matrix *local, ff_matrix *out)
{
    __m128 l0 = _mm_load_ps(local->row[0]), l1 = _mm_load_ps(local->row[1]), l2 = _mm_load_ps(local->row[2]);
    __m128 p0 = _mm_loadu_ps(parent->row[0]), p1 = _mm_loadu_ps(parent->row[1]),
           p2 = _mm_loadu_ps(parent->row[2]);
    _mm_storeu_ps(out->row[0], row_times(p0, l0, l1, l2));
    _mm_storeu_ps(out->row[1], row_times(p1, l0, l1, l2));
    _mm_storeu_ps(out->row[2], row_times(p2, l0, l1, l2));
}

static inline void matrices_sse2(const ff_pose_tree *tree, const float *rotations, const ff_pose_root *root,
                                 ff_matrix *out)
{
    _Alignas(16) ff_matrix local[FF_POSE_LANES_MAX];
    four_locals(tree, rotations, 0, local);
    for (uint32_t j = 4; j < tree->joint_count; j += 4)
        four_locals(tree, rotations, j, local + j);
    out[0] = local[0];
    put_root(root, &out[0]);
    for (uint32_t j = 1; j < tree->joint_count; ++j)
        multiply(&out[tree->parents[j]], &local[j], &out[j]);
}
