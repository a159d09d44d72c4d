/* plan_hit.h - do colliders that move straight between two moments meet? */
#ifndef FF_PLAN_HIT_H
#define FF_PLAN_HIT_H

#include "runtime/core/plan/plan.h"

/* Squares of how near colliders may come: [mine][theirs], the same both ways. */
typedef struct ff_limits {
    float squared[FF_COLLIDER_COUNT][FF_TRACK_LANES];
    float reach
        [FF_TRACK_LANES]; /* m, not squared: of each, with the margin, to something of no size; a little more */
} ff_limits;
ff_limits ff_limits_of(const float *mine, const float *theirs, float margin);

/* About the root, holds all colliders with their radii. */
float ff_knot_radius(const ff_knot *knot, const float *radii);

/* Smallest squared length of p + t d for t in [0, 1]. */
static inline float ff_nearest_pass(float pa, float pb, float da, float db)
{
    float dd = da * da + db * db, t = -(pa * da + pb * db);
    t = dd > 1e-12f ? t / dd : 0.0f;
    t = t < 0.0f ? 0.0f : (t > 1.0f ? 1.0f : t);
    float a = pa + t * da, b = pb + t * db;
    return a * a + b * b;
}

/* Do the roots, mine from x0 to x1 and theirs from y0 to y1 (whose origin is at (a, b) of mine), come within reach? Most do not,
 * which is seen without a division. */
static inline bool ff_roots_near(const ff_knot *x0, const ff_knot *x1, const ff_knot *y0, const ff_knot *y1,
                                 float a, float b, float reach)
{
    enum { R = FF_COLLIDER_ROOT };
    float pa = y0->a[R] + a - x0->a[R], pb = y0->b[R] + b - x0->b[R];
    float qa = y1->a[R] + a - x1->a[R], qb = y1->b[R] + b - x1->b[R];
    float da = qa - pa, db = qb - pb, p = pa * pa + pb * pb, q = qa * qa + qb * qb;
    float nearer = p < q ? p : q;
    if (nearer <= reach * reach) return true;
    float pass = reach + 0.5f * ((da < 0.0f ? -da : da) + (db < 0.0f ? -db : db));
    return nearer <= pass * pass && ff_nearest_pass(pa, pb, da, db) <= reach * reach;
}

/* Do any two colliders come nearer than the limits, and are they at a height? */
bool ff_knots_hit(const ff_knot *x0, const ff_knot *x1, const ff_knot *y0, const ff_knot *y1, float a,
                  float b, const ff_limits *limits);

/* Two colliders that meet. */
typedef struct ff_touch {
    uint8_t mine, theirs;
} ff_touch;

/* The same for bodies that radii (mine, theirs) about their roots hold, at both moments: those colliders are looked at alone
 * that come near the other body. *touch (may be NULL): two that meet; the roots if they do. */
bool ff_bodies_hit(const ff_knot *x0, const ff_knot *x1, const ff_knot *y0, const ff_knot *y1, float a,
                   float b, float mine, float theirs, const ff_limits *limits, ff_touch *touch);

/* Do two of them alone? x0 and x1: a, b, height of mine. */
bool ff_colliders_hit(ff_touch pair, const float x0[3], const float x1[3], const ff_knot *y0,
                      const ff_knot *y1, float a, float b, const ff_limits *limits);

#endif
