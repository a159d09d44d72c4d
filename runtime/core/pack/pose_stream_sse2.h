/* pose_stream_sse2.h - part of pose_stream.c: the steps of decoding eight lanes or four joints at a time. SSE2 is what
 * every x86-64 has, and its multiply-and-add of 16-bit pairs does what a blend of keys needs. */
#include <emmintrin.h>

/* Values of eight lanes from their keys. The last block of a run reads on into what follows; nothing shows those. */
static inline void read_lanes(const ff_pack_lanes *lanes, __m128i k0, __m128i k1, __m128i k2, __m128i k3,
                              __m128i w01, __m128i w23, float *out)
{
    __m128i low = _mm_add_epi32(_mm_madd_epi16(_mm_unpacklo_epi16(k0, k1), w01),
                                _mm_madd_epi16(_mm_unpacklo_epi16(k2, k3), w23));
    __m128i high = _mm_add_epi32(_mm_madd_epi16(_mm_unpackhi_epi16(k0, k1), w01),
                                 _mm_madd_epi16(_mm_unpackhi_epi16(k2, k3), w23));
    _mm_store_ps(out, _mm_add_ps(_mm_loadu_ps(lanes->base),
                                 _mm_mul_ps(_mm_loadu_ps(lanes->scale), _mm_cvtepi32_ps(low))));
    _mm_store_ps(out + 4, _mm_add_ps(_mm_loadu_ps(lanes->base + 4),
                                     _mm_mul_ps(_mm_loadu_ps(lanes->scale + 4), _mm_cvtepi32_ps(high))));
}

static inline __m128i wide_keys(const unsigned char *at)
{
    return _mm_loadu_si128((const __m128i *)(const void *)at);
}

static inline __m128i narrow_keys(const unsigned char *at)
{
    return _mm_unpacklo_epi8(_mm_setzero_si128(), _mm_loadl_epi64((const __m128i *)(const void *)at));
}

static inline float *read_level(const ff_pack_level *level, const unsigned char *k0, __m128i w01, __m128i w23,
                                const ff_pack_lanes *lanes, float *out)
{
    size_t stride = ff_level_stride(level);
    const unsigned char *k1 = k0 + stride, *k2 = k1 + stride, *k3 = k2 + stride;
    for (size_t i = 0; i < 2 * (size_t)level->wide; i += 16, out += 8, ++lanes)
        read_lanes(lanes, wide_keys(k0 + i), wide_keys(k1 + i), wide_keys(k2 + i), wide_keys(k3 + i), w01,
                   w23, out);
    for (size_t i = 2 * (size_t)level->wide; i < 2 * (size_t)level->wide + level->narrow;
         i += 8, out += 8, ++lanes)
        read_lanes(lanes, narrow_keys(k0 + i), narrow_keys(k1 + i), narrow_keys(k2 + i), narrow_keys(k3 + i),
                   w01, w23, out);
    return out;
}

/* The weights of all four levels at once, as pairs of 16 bits; ff_stream_weights says the same. */
static inline void weights_sse2(const float *on, __m128i *w01, __m128i *w23)
{
    const __m128 one = _mm_set1_ps(1.0f), half = _mm_set1_ps(0.5f), sixth = _mm_set1_ps(32768.0f / 6.0f);
    __m128 t = _mm_load_ps(on), s = _mm_sub_ps(one, t), t2 = _mm_mul_ps(t, t), t3 = _mm_mul_ps(t2, t);
    __m128 f0 = _mm_mul_ps(_mm_mul_ps(_mm_mul_ps(s, s), s), sixth);
    __m128 f2 =
        _mm_mul_ps(_mm_add_ps(one, _mm_mul_ps(_mm_set1_ps(3.0f), _mm_sub_ps(_mm_add_ps(t, t2), t3))), sixth);
    __m128 f3 = _mm_mul_ps(t3, sixth);
    __m128i w0 = _mm_cvttps_epi32(_mm_add_ps(f0, half)), w2 = _mm_cvttps_epi32(_mm_add_ps(f2, half)),
            w3 = _mm_cvttps_epi32(_mm_add_ps(f3, half));
    __m128i w1 = _mm_sub_epi32(_mm_sub_epi32(_mm_sub_epi32(_mm_set1_epi32(32768), w0), w2), w3);
    *w01 = _mm_or_si128(w0, _mm_slli_epi32(w1, 16));
    *w23 = _mm_or_si128(w2, _mm_slli_epi32(w3, 16));
}

static inline void read_levels_sse2(const ff_pack *pack, const ff_pack_stream *stream, double fraction,
                                    values *now)
{
    _Alignas(16) float t[FF_STREAM_LEVELS] = {0.0f, 0.0f, 0.0f, 0.0f};
    _Alignas(16) uint32_t pair[2][FF_STREAM_LEVELS];
    const unsigned char *first[FF_STREAM_LEVELS];
    __m128i w01, w23;
    for (int i = 0; i < FF_STREAM_LEVELS; ++i)
        if (has_lanes(&stream->level[i])) first[i] = first_key(pack, &stream->level[i], fraction, &t[i]);
    weights_sse2(t, &w01, &w23);
    _mm_store_si128((__m128i *)(void *)pair[0], w01);
    _mm_store_si128((__m128i *)(void *)pair[1], w23);
    const ff_pack_lanes *lanes = pack->lanes + stream->first_lanes;
    float *start = now->at + FF_LANE_FIRST, *out = start;
    for (int i = 0; i < FF_STREAM_LEVELS; ++i)
        if (has_lanes(&stream->level[i]))
            out = read_level(&stream->level[i], first[i], _mm_set1_epi32((int32_t)pair[0][i]),
                             _mm_set1_epi32((int32_t)pair[1][i]), lanes + (out - start) / 8, out);
    read_still(lanes + (out - start) / 8, stream->still, out);
}

static inline void put_rotation(__m128 q, ff_quat *out)
{
    _mm_storeu_pd(&out->x, _mm_cvtps_pd(q));
    _mm_storeu_pd(&out->z, _mm_cvtps_pd(_mm_movehl_ps(q, q)));
}

static inline __m128 pick(const values *now, const uint8_t *lane)
{
    return _mm_set_ps(now->at[lane[3]], now->at[lane[2]], now->at[lane[1]], now->at[lane[0]]);
}

/* Four joints from j on; rotations_plain says the same in a line each. */
static inline void four_rotations(const values *now, const ff_pack_slots *slots, int j, bool four_parts,
                                  __m128 side, __m128 out[4])
{
    const __m128 one = _mm_set1_ps(1.0f);
    __m128 x = pick(now, slots->lane[0] + j), y = pick(now, slots->lane[1] + j),
           z = pick(now, slots->lane[2] + j), w = one;
    __m128 n = _mm_add_ps(_mm_mul_ps(x, x), _mm_mul_ps(y, y));
    if (four_parts) {
        w = pick(now, slots->lane[3] + j);
        n = _mm_add_ps(n, _mm_add_ps(_mm_mul_ps(z, z), _mm_mul_ps(w, w)));
        __m128 good = _mm_cmpgt_ps(n, _mm_set1_ps(SMALLEST));
        x = _mm_and_ps(good, x);
        y = _mm_and_ps(good, y);
        z = _mm_and_ps(good, z);
        w = _mm_or_ps(_mm_and_ps(good, w), _mm_andnot_ps(good, one));
        n = _mm_or_ps(_mm_and_ps(good, n), _mm_andnot_ps(good, one));
    } else {
        n = _mm_add_ps(n, _mm_add_ps(_mm_mul_ps(z, z), one));
    }
    __m128 r = _mm_div_ps(one, _mm_sqrt_ps(n));
    __m128 a = _mm_loadu_ps(slots->x + j), b = _mm_loadu_ps(slots->y + j), c = _mm_loadu_ps(slots->z + j),
           d = _mm_loadu_ps(slots->w + j);
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

static inline void all_rotations(const values *now, const ff_pack_slots *slots, bool four_parts,
                                 bool mirrored, ff_quat *rotations)
{
    const uint8_t *to = mirrored ? mirror_of : itself;
    __m128 side = _mm_set1_ps(mirrored ? -1.0f : 1.0f), q[4];
    for (int j = 0; j + 4 <= FF_JOINT_COUNT; j += 4) {
        four_rotations(now, slots, j, four_parts, side, q);
        for (int i = 0; i < 4; ++i)
            put_rotation(q[i], &rotations[to[j + i]]);
    }
    four_rotations(now, slots, FF_JOINT_COUNT - 1, four_parts, side, q);
    put_rotation(q[0], &rotations[to[FF_JOINT_COUNT - 1]]);
}

/* Two copies, so that what need not be computed is not. */
static void rotations_sse2(const values *now, const ff_pack_slots *slots, bool four_parts, bool mirrored,
                           ff_quat *rotations)
{
    if (four_parts) {
        all_rotations(now, slots, true, mirrored, rotations);
    } else {
        all_rotations(now, slots, false, mirrored, rotations);
    }
}
