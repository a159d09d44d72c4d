/* pose_blend_sse2.h - part of pose_blend.c: eight joints at a time. The multiply-and-add of 16-bit pairs that every x86-64
 * has weighs two frames in one instruction. */
#include <emmintrin.h>

/* Sums of one part of eight joints, in two halves. */
typedef struct eight {
    __m128i low, high;
} eight;

static inline eight add_pair(eight sum, const int16_t *k0, const int16_t *k1, __m128i weights)
{
    __m128i a = _mm_loadu_si128((const __m128i *)(const void *)k0),
            b = _mm_loadu_si128((const __m128i *)(const void *)k1);
    sum.low = _mm_add_epi32(sum.low, _mm_madd_epi16(_mm_unpacklo_epi16(a, b), weights));
    sum.high = _mm_add_epi32(sum.high, _mm_madd_epi16(_mm_unpackhi_epi16(a, b), weights));
    return sum;
}

/* unit() of four joints. */
static inline void put_unit(__m128i x, __m128i y, __m128i z, __m128i w, uint32_t lanes, float *out)
{
    const __m128 one = _mm_set1_ps(1.0f);
    __m128 a = _mm_cvtepi32_ps(x), b = _mm_cvtepi32_ps(y), c = _mm_cvtepi32_ps(z), d = _mm_cvtepi32_ps(w);
    __m128 n = _mm_add_ps(_mm_add_ps(_mm_mul_ps(a, a), _mm_mul_ps(b, b)),
                          _mm_add_ps(_mm_mul_ps(c, c), _mm_mul_ps(d, d)));
    __m128 good = _mm_cmpgt_ps(n, _mm_set1_ps(SMALLEST));
    n = _mm_or_ps(_mm_and_ps(good, n), _mm_andnot_ps(good, one));
    __m128 r = _mm_div_ps(one, _mm_sqrt_ps(n));
    d = _mm_or_ps(_mm_and_ps(good, d), _mm_andnot_ps(good, one));
    _mm_storeu_ps(out, _mm_mul_ps(_mm_and_ps(good, a), r));
    _mm_storeu_ps(out + lanes, _mm_mul_ps(_mm_and_ps(good, b), r));
    _mm_storeu_ps(out + 2 * lanes, _mm_mul_ps(_mm_and_ps(good, c), r));
    _mm_storeu_ps(out + 3 * lanes, _mm_mul_ps(d, r));
}

static inline void blend_sse2(const ff_pose_store *store, const ff_pose_mix *mix, float *out)
{
    uint32_t lanes = store->lanes;
    for (uint32_t j = 0; j < lanes; j += 8) {
        const eight none = {_mm_setzero_si128(), _mm_setzero_si128()};
        eight x = none, y = none, z = none, w = none;
        for (uint32_t p = 0; p < mix->count; ++p) {
            const int16_t *k0 = ff_pose_frame(store, mix->pair[p].frame[0]) + j;
            const int16_t *k1 = ff_pose_frame(store, mix->pair[p].frame[1]) + j;
            int32_t both;
            memcpy(&both, mix->pair[p].weight, sizeof both);
            __m128i weights = _mm_set1_epi32(both);
            x = add_pair(x, k0, k1, weights);
            y = add_pair(y, k0 + lanes, k1 + lanes, weights);
            z = add_pair(z, k0 + 2 * lanes, k1 + 2 * lanes, weights);
            w = add_pair(w, k0 + 3 * lanes, k1 + 3 * lanes, weights);
        }
        put_unit(x.low, y.low, z.low, w.low, lanes, out + j);
        put_unit(x.high, y.high, z.high, w.high, lanes, out + j + 4);
    }
}
