/* pose_stream_sse2.h - part of pose_stream.c: the steps of decoding eight lanes or four joints at a time. SSE2 is what
 * every x86-64 has, and its multiply-and-add of 16-bit pairs does what a blend of keys needs. */
#include <emmintrin.h>

/* Values of eight lanes from their weighted sums, each put where it belongs. */
static inline void put_lanes(const ff_pack_lanes *lanes, __m128i low, __m128i high, values *out)
{
    _Alignas(16) float value[8];
    _mm_store_ps(value, _mm_add_ps(_mm_loadu_ps(lanes->base),
                                   _mm_mul_ps(_mm_loadu_ps(lanes->scale), _mm_cvtepi32_ps(low))));
    _mm_store_ps(value + 4, _mm_add_ps(_mm_loadu_ps(lanes->base + 4),
                                       _mm_mul_ps(_mm_loadu_ps(lanes->scale + 4), _mm_cvtepi32_ps(high))));
    for (int i = 0; i < 8; ++i)
        out->at[lanes->slot[i]] = value[i];
}

/* Weighted sums of eight 16-bit keys each. */
static inline void sum_lanes(const ff_pack_lanes *lanes, const __m128i key[4], __m128i w01, __m128i w23,
                             values *out)
{
    __m128i low = _mm_add_epi32(_mm_madd_epi16(_mm_unpacklo_epi16(key[0], key[1]), w01),
                                _mm_madd_epi16(_mm_unpacklo_epi16(key[2], key[3]), w23));
    __m128i high = _mm_add_epi32(_mm_madd_epi16(_mm_unpackhi_epi16(key[0], key[1]), w01),
                                 _mm_madd_epi16(_mm_unpackhi_epi16(key[2], key[3]), w23));
    put_lanes(lanes, low, high, out);
}

static inline __m128i weight_pair(int16_t first, int16_t second)
{
    return _mm_set1_epi32((int32_t)((uint32_t)(uint16_t)first | (uint32_t)(uint16_t)second << 16));
}

/* The last block of a run reads on into what follows; those sums go to no slot. */
static const ff_pack_lanes *read_level_sse2(const ff_pack *pack, const ff_pack_level *level, double fraction,
                                            const ff_pack_lanes *lanes, values *out)
{
    place p = place_on(pack, level, fraction);
    __m128i w01 = weight_pair(p.weight[0], p.weight[1]), w23 = weight_pair(p.weight[2], p.weight[3]), key[4];
    for (size_t i = 0; i < level->wide; i += 8) {
        for (int k = 0; k < 4; ++k)
            key[k] = _mm_loadu_si128((const __m128i *)(const void *)(p.key[k] + 2 * i));
        sum_lanes(lanes++, key, w01, w23, out);
    }
    for (size_t i = 0; i < level->narrow; i += 8) {
        for (int k = 0; k < 4; ++k) {
            __m128i bytes =
                _mm_loadl_epi64((const __m128i *)(const void *)(p.key[k] + 2 * (size_t)level->wide + i));
            key[k] = _mm_unpacklo_epi8(_mm_setzero_si128(), bytes);
        }
        sum_lanes(lanes++, key, w01, w23, out);
    }
    return lanes;
}

static inline void put_rotation(__m128 q, ff_quat *out)
{
    _mm_storeu_pd(&out->x, _mm_cvtps_pd(q));
    _mm_storeu_pd(&out->z, _mm_cvtps_pd(_mm_movehl_ps(q, q)));
}

/* Four joints from j on; rotations_plain says the same in a line each. */
static inline void four_rotations(const float *at, const ff_pack_reference *reference, int j, __m128 side,
                                  __m128 out[4])
{
    const __m128 one = _mm_set1_ps(1.0f);
    __m128 x = _mm_load_ps(at + j), y = _mm_load_ps(at + FF_STREAM_SLOTS + j),
           z = _mm_load_ps(at + 2 * FF_STREAM_SLOTS + j), w = _mm_load_ps(at + W_SLOTS + j);
    __m128 n = _mm_add_ps(_mm_add_ps(_mm_mul_ps(x, x), _mm_mul_ps(y, y)),
                          _mm_add_ps(_mm_mul_ps(z, z), _mm_mul_ps(w, w)));
    __m128 good = _mm_cmpgt_ps(n, _mm_set1_ps(SMALLEST));
    x = _mm_and_ps(good, x);
    y = _mm_and_ps(good, y);
    z = _mm_and_ps(good, z);
    w = _mm_or_ps(_mm_and_ps(good, w), _mm_andnot_ps(good, one));
    n = _mm_or_ps(_mm_and_ps(good, n), _mm_andnot_ps(good, one));
    __m128 r = _mm_div_ps(one, _mm_sqrt_ps(n));
    __m128 a = _mm_loadu_ps(reference->x + j), b = _mm_loadu_ps(reference->y + j),
           c = _mm_loadu_ps(reference->z + j), d = _mm_loadu_ps(reference->w + j);
    __m128 qx = _mm_add_ps(_mm_add_ps(_mm_mul_ps(d, x), _mm_mul_ps(a, w)),
                           _mm_sub_ps(_mm_mul_ps(b, z), _mm_mul_ps(c, y)));
    __m128 qy = _mm_add_ps(_mm_add_ps(_mm_mul_ps(d, y), _mm_mul_ps(b, w)),
                           _mm_sub_ps(_mm_mul_ps(c, x), _mm_mul_ps(a, z)));
    __m128 qz = _mm_add_ps(_mm_add_ps(_mm_mul_ps(d, z), _mm_mul_ps(c, w)),
                           _mm_sub_ps(_mm_mul_ps(a, y), _mm_mul_ps(b, x)));
    __m128 qw = _mm_sub_ps(_mm_sub_ps(_mm_mul_ps(d, w), _mm_mul_ps(a, x)),
                           _mm_add_ps(_mm_mul_ps(b, y), _mm_mul_ps(c, z)));
    out[0] = _mm_mul_ps(qx, r);
    out[1] = _mm_mul_ps(_mm_mul_ps(qy, r), side);
    out[2] = _mm_mul_ps(_mm_mul_ps(qz, r), side);
    out[3] = _mm_mul_ps(qw, r);
    _MM_TRANSPOSE4_PS(out[0], out[1], out[2], out[3]);
}

static void rotations_sse2(const values *from, const ff_pack_reference *reference, bool mirrored,
                           ff_quat *rotations)
{
    const uint8_t *to = mirrored ? mirror_of : itself;
    __m128 side = _mm_set1_ps(mirrored ? -1.0f : 1.0f), q[4];
    for (int j = 0; j + 4 <= FF_JOINT_COUNT; j += 4) {
        four_rotations(from->at, reference, j, side, q);
        for (int i = 0; i < 4; ++i)
            put_rotation(q[i], &rotations[to[j + i]]);
    }
    four_rotations(from->at, reference, FF_JOINT_COUNT - 1, side, q);
    put_rotation(q[0], &rotations[to[FF_JOINT_COUNT - 1]]);
}
