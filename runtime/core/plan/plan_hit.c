#include "runtime/core/plan/plan_hit.h"

#define SLACK 1e-3f /* m, more than roundings come to */

#ifdef __SSE2__
#include <emmintrin.h>
#endif

ff_limits ff_limits_of(const float *mine, const float *theirs, float margin)
{
    ff_limits limits;
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i)
        for (int k = 0; k < FF_TRACK_LANES; ++k) {
            float near = mine[i] + theirs[k] + margin;
            limits.squared[i][k] = near > 0.0f ? near * near : -1.0f;
        }
    for (int k = 0; k < FF_TRACK_LANES; ++k)
        limits.reach[k] = fmaxf(mine[k], theirs[k]) + margin + SLACK;
    return limits;
}

float ff_knot_radius(const ff_knot *knot, const float *radii)
{
    float square[FF_TRACK_LANES], a = knot->a[FF_COLLIDER_ROOT], b = knot->b[FF_COLLIDER_ROOT];
    for (int i = 0; i < FF_TRACK_LANES; ++i) {
        float da = knot->a[i] - a, db = knot->b[i] - b;
        square[i] = da * da + db * db;
    }
    /* Of each kind the furthest: head, hands, feet. */
    float hand = square[1] > square[2] ? square[1] : square[2];
    float foot = square[3] > square[4] ? square[3] : square[4];
    float most = sqrtf(square[0]) + radii[0];
    float by_hand = sqrtf(hand) + fmaxf(radii[1], radii[2]),
          by_foot = sqrtf(foot) + fmaxf(radii[3], radii[4]);
    most = by_hand > most ? by_hand : most;
    most = by_foot > most ? by_foot : most;
    return fmaxf(most, radii[FF_COLLIDER_ROOT]);
}

/* Bit k: collider i of mine and k of theirs come nearer than their limit; *within (if that is asked for) gets the same for reach + radius. */
#ifdef __SSE2__
static unsigned near_lanes(int i, const ff_knot *x0, const ff_knot *x1, const ff_knot *y0, const ff_knot *y1,
                           float a, float b, const float *limit, const float *reach, float radius,
                           unsigned *within)
{
    unsigned near = 0, about = 0;
    __m128 xa0 = _mm_set1_ps(x0->a[i] - a), xb0 = _mm_set1_ps(x0->b[i] - b);
    __m128 xa1 = _mm_set1_ps(x1->a[i] - a), xb1 = _mm_set1_ps(x1->b[i] - b);
    const __m128 zero = _mm_setzero_ps(), one = _mm_set1_ps(1.0f), tiny = _mm_set1_ps(1e-12f);
    for (int k = 0; k <= FF_TRACK_LANES - 4; k += FF_TRACK_LANES - 4) { /* the middle ones twice */
        __m128 pa = _mm_sub_ps(_mm_loadu_ps(y0->a + k), xa0), pb = _mm_sub_ps(_mm_loadu_ps(y0->b + k), xb0);
        __m128 da = _mm_sub_ps(_mm_sub_ps(_mm_loadu_ps(y1->a + k), xa1), pa);
        __m128 db = _mm_sub_ps(_mm_sub_ps(_mm_loadu_ps(y1->b + k), xb1), pb);
        __m128 dd = _mm_add_ps(_mm_mul_ps(da, da), _mm_mul_ps(db, db));
        __m128 t = _mm_sub_ps(zero, _mm_add_ps(_mm_mul_ps(pa, da), _mm_mul_ps(pb, db)));
        t = _mm_and_ps(_mm_div_ps(t, _mm_max_ps(dd, tiny)), _mm_cmpgt_ps(dd, tiny));
        t = _mm_min_ps(_mm_max_ps(t, zero), one);
        pa = _mm_add_ps(pa, _mm_mul_ps(t, da));
        pb = _mm_add_ps(pb, _mm_mul_ps(t, db));
        __m128 square = _mm_add_ps(_mm_mul_ps(pa, pa), _mm_mul_ps(pb, pb));
        near |= (unsigned)_mm_movemask_ps(_mm_cmple_ps(square, _mm_loadu_ps(limit + k))) << k;
        if (!within) continue;
        __m128 most = _mm_add_ps(_mm_loadu_ps(reach + k), _mm_set1_ps(radius));
        about |= (unsigned)_mm_movemask_ps(_mm_cmple_ps(square, _mm_mul_ps(most, most))) << k;
    }
    if (within) *within = about;
    return near;
}
#else
static unsigned near_lanes(int i, const ff_knot *x0, const ff_knot *x1, const ff_knot *y0, const ff_knot *y1,
                           float a, float b, const float *limit, const float *reach, float radius,
                           unsigned *within)
{
    unsigned near = 0, about = 0;
    float xa0 = x0->a[i] - a, xb0 = x0->b[i] - b, xa1 = x1->a[i] - a, xb1 = x1->b[i] - b;
    for (int k = 0; k < FF_TRACK_LANES; ++k) {
        float pa = y0->a[k] - xa0, pb = y0->b[k] - xb0;
        float da = (y1->a[k] - xa1) - pa, db = (y1->b[k] - xb1) - pb;
        float square = ff_nearest_pass(pa, pb, da, db), most = reach[k] + radius;
        if (square <= limit[k]) near |= 1u << k;
        if (square <= most * most) about |= 1u << k;
    }
    if (within) *within = about;
    return near;
}
#endif

/* Do they share a height at some time of the interval, mine at heights x0 and x1? Heights taken for its whole. */
static bool share_height(int i, float x0, float x1, int k, float y0, float y1)
{
    float low_x, high_x, low_y, high_y, unused;
    ff_collider_extent((uint32_t)i, x0 < x1 ? x0 : x1, &low_x, &unused);
    ff_collider_extent((uint32_t)i, x0 < x1 ? x1 : x0, &unused, &high_x);
    ff_collider_extent((uint32_t)k, y0 < y1 ? y0 : y1, &low_y, &unused);
    ff_collider_extent((uint32_t)k, y0 < y1 ? y1 : y0, &unused, &high_y);
    return low_x <= high_y && low_y <= high_x;
}

bool ff_colliders_hit(ff_touch pair, const float x0[3], const float x1[3], const ff_knot *y0,
                      const ff_knot *y1, float a, float b, const ff_limits *limits)
{
    int i = pair.mine, k = pair.theirs;
    float pa = y0->a[k] - (x0[0] - a), pb = y0->b[k] - (x0[1] - b);
    float da = y1->a[k] - (x1[0] - a) - pa, db = y1->b[k] - (x1[1] - b) - pb;
    return ff_nearest_pass(pa, pb, da, db) <= limits->squared[i][k] &&
           share_height(i, x0[2], x1[2], k, y0->y[k], y1->y[k]);
}

enum { ROOT = FF_COLLIDER_ROOT, NOBODY = FF_COLLIDER_COUNT };

/* Which of those that come near collider i of mine does it meet? The root is asked for first. */
static int one_hits(int i, const ff_knot *x0, const ff_knot *x1, const ff_knot *y0, const ff_knot *y1,
                    unsigned near)
{
    if ((near >> ROOT & 1u) && share_height(i, x0->y[i], x1->y[i], ROOT, y0->y[ROOT], y1->y[ROOT]))
        return ROOT;
    for (int k = 0; near; ++k, near >>= 1)
        if ((near & 1u) && share_height(i, x0->y[i], x1->y[i], k, y0->y[k], y1->y[k])) return k;
    return NOBODY;
}

bool ff_knots_hit(const ff_knot *x0, const ff_knot *x1, const ff_knot *y0, const ff_knot *y1, float a,
                  float b, const ff_limits *limits)
{
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i)
        if (one_hits(i, x0, x1, y0, y1,
                     near_lanes(i, x0, x1, y0, y1, a, b, limits->squared[i], limits->reach, 0.0f, NULL)) !=
            NOBODY)
            return true;
    return false;
}

static bool met(ff_touch *touch, int mine, int theirs)
{
    if (mine == NOBODY || theirs == NOBODY) return false;
    if (touch) *touch = (ff_touch){(uint8_t)mine, (uint8_t)theirs};
    return true;
}

bool ff_bodies_hit(const ff_knot *x0, const ff_knot *x1, const ff_knot *y0, const ff_knot *y1, float a,
                   float b, float mine, float theirs, const ff_limits *limits, ff_touch *touch)
{
    const float *squared = limits->squared[ROOT];
    unsigned of_mine, of_theirs, near;
    /* The roots first, each with all of the other one: they meet oftenest, and it is seen who else may. */
    near = near_lanes(ROOT, x0, x1, y0, y1, a, b, squared, limits->reach, mine, &of_theirs);
    if (!of_theirs) return false;
    if (near && met(touch, ROOT, one_hits(ROOT, x0, x1, y0, y1, near))) return true;
    near = near_lanes(ROOT, y0, y1, x0, x1, -a, -b, squared, limits->reach, theirs, &of_mine);
    if (near && met(touch, one_hits(ROOT, y0, y1, x0, x1, near), ROOT)) return true;
    of_mine &= ~(1u << ROOT);
    of_theirs &= ~(1u << ROOT);
    if (!of_theirs) return false;
    for (int i = 0; of_mine; ++i, of_mine >>= 1) {
        if (!(of_mine & 1u)) continue;
        near = near_lanes(i, x0, x1, y0, y1, a, b, limits->squared[i], limits->reach, 0.0f, NULL) & of_theirs;
        if (near && met(touch, i, one_hits(i, x0, x1, y0, y1, near))) return true;
    }
    return false;
}
