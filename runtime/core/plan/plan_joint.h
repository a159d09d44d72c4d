/* plan_joint.h - how one action becomes the next as it is played (play.h): what their poses differ by is added to the next one
 * and fades out. Tracks and searches do the same to the colliders, so that bodies are where their tracks have them.
 *
 * Head, hands and trunk take up place and speed, and lose both in FF_POSE_OFFSET_TIME. A foot that stood and goes on standing
 * stays where it is, and is led from there to its next place.
 */
#ifndef FF_PLAN_JOINT_H
#define FF_PLAN_JOINT_H

#include "runtime/core/gait/blend.h"
#include "runtime/core/plan/plan_set.h"
#include "runtime/core/pose/pose_offset.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#define FF_JOINT_TIME ((float)FF_POSE_OFFSET_TIME) /* s */

/* Of an action of the pack, whose colliders [knots] are evenly spread over it. */
void ff_set_ends_find(const ff_pack *pack, const ff_body_frame *body, uint32_t action, const ff_knot *samples,
                      uint32_t knots, ff_set_ends *out);

/* The same at another pace, at which it lasts so long. */
void ff_set_ends_pace(const ff_set_ends *own, float pace, float duration, ff_set_ends *out);

/* Without arcs. In S0 of next, which is turned by an angle (its cosine and sine) from S0 of before. jump, m: where before ends, off where
 * next begins. before NULL: one has stood. */
void ff_joint_make(const ff_set_ends *before, const float turn[2], const ff_set_ends *next,
                   const ff_knot *jump, ff_joint *out);

/* Its bounds (most_ ...), when all else is there. */
void ff_joint_measure(ff_joint *joint);

/* The arcs of all joints of a set that is whole but for them, and the joints' bounds (plan_arc.c). */
ff_status ff_set_find_arcs(ff_action_set *set, const ff_body_frame *body, ff_error *error);

/* Of two actions that follow each other, or NULL where the set knows of no joint. */
const ff_joint *ff_set_joint(const ff_action_set *set, uint32_t before, uint32_t next);

/* m, the most that it moves any collider. */
float ff_joint_most(const ff_joint *joint);

/* Of a difference: what is left of it after a share s of its time, and of the way (m) that its speed would go in that time: the cubic
 * of pose_offset.h. */
static inline void ff_joint_left(float s, float *place, float *speed)
{
    s = s < 0.0f ? 0.0f : s;
    s = s > 1.0f ? 1.0f : s;
    float rest = (1.0f - s) * (1.0f - s);
    *place = rest * (1.0f + 2.0f * s);
    *speed = rest * s;
}

/* How much further from the root it holds a collider at most, m, t seconds after next begins. */
static inline float ff_joint_about(const ff_joint *joint, float t)
{
    float body, rush, feet, unused, s = t * (1.0f / FF_JOINT_TIME);
    ff_joint_left(s, &body, &rush);
    ff_joint_left((t - joint->last_from) * joint->last_rate, &feet, &unused);
    if (s < 1.0f / 3.0f) rush = 4.0f / 27.0f; /* the most; what has less time has its most sooner */
    float near = body * joint->most_body, far = feet * joint->most_feet;
    float arc = s < 1.0f ? joint->most_arc : 0.0f;
    return (near > far ? near : far) + body * joint->most_root + rush * joint->most_rush + arc;
}

/* m: what is added to the root. */
static inline void ff_joint_move(const ff_joint *joint, float t, float move[2])
{
    enum { R = FF_COLLIDER_ROOT };
    float place, speed;
    ff_joint_left((t - joint->from[R]) * joint->rate[R], &place, &speed);
    move[0] = place * joint->jump.a[R] + speed * joint->rush_a[R];
    move[1] = place * joint->jump.b[R] + speed * joint->rush_b[R];
}

/* A collider of next, i, at t seconds: all of it is added to its a, b, y. */
static inline void ff_joint_add_one(const ff_joint *joint, float t, int i, float at[3])
{
    float s = (t - joint->from[i]) * joint->rate[i], place, speed;
    s = s < 0.0f ? 0.0f : (s > 1.0f ? 1.0f : s);
    ff_joint_left(s, &place, &speed);
    float arc = speed * s * 16.0f;
    at[0] += place * joint->jump.a[i] + speed * joint->rush_a[i] + arc * joint->arc_a[i];
    at[1] += place * joint->jump.b[i] + speed * joint->rush_b[i] + arc * joint->arc_b[i];
    at[2] += place * joint->jump.y[i];
}

/* Colliders of next at t seconds, with all of it added. */
static inline void ff_joint_add(const ff_joint *joint, float t, const ff_knot *restrict at,
                                ff_knot *restrict out)
{
#ifdef __SSE2__
    const __m128 zero = _mm_setzero_ps(), one = _mm_set1_ps(1.0f), now = _mm_set1_ps(t);
    for (int k = 0; k <= FF_TRACK_LANES - 4; k += FF_TRACK_LANES - 4) { /* the middle ones twice */
        __m128 s = _mm_sub_ps(now, _mm_loadu_ps(joint->from + k));
        s = _mm_mul_ps(s, _mm_loadu_ps(joint->rate + k));
        s = _mm_min_ps(_mm_max_ps(s, zero), one);
        __m128 left = _mm_sub_ps(one, s), rest = _mm_mul_ps(left, left), speed = _mm_mul_ps(rest, s);
        __m128 place = _mm_mul_ps(rest, _mm_add_ps(one, _mm_add_ps(s, s)));
        __m128 a = _mm_mul_ps(place, _mm_loadu_ps(joint->jump.a + k));
        __m128 b = _mm_mul_ps(place, _mm_loadu_ps(joint->jump.b + k));
        __m128 y = _mm_mul_ps(place, _mm_loadu_ps(joint->jump.y + k));
        a = _mm_add_ps(a, _mm_mul_ps(speed, _mm_loadu_ps(joint->rush_a + k)));
        b = _mm_add_ps(b, _mm_mul_ps(speed, _mm_loadu_ps(joint->rush_b + k)));
        __m128 arc = _mm_mul_ps(_mm_mul_ps(speed, s), _mm_set1_ps(16.0f));
        a = _mm_add_ps(a, _mm_mul_ps(arc, _mm_loadu_ps(joint->arc_a + k)));
        b = _mm_add_ps(b, _mm_mul_ps(arc, _mm_loadu_ps(joint->arc_b + k)));
        _mm_storeu_ps(out->a + k, _mm_add_ps(_mm_loadu_ps(at->a + k), a));
        _mm_storeu_ps(out->b + k, _mm_add_ps(_mm_loadu_ps(at->b + k), b));
        _mm_storeu_ps(out->y + k, _mm_add_ps(_mm_loadu_ps(at->y + k), y));
    }
#else
    for (int i = 0; i < FF_TRACK_LANES; ++i) {
        float one[3] = {at->a[i], at->b[i], at->y[i]};
        ff_joint_add_one(joint, t, i, one);
        out->a[i] = one[0];
        out->b[i] = one[1];
        out->y[i] = one[2];
    }
#endif
}

#endif
