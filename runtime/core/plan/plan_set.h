/* plan_set.h - the inside of an action set: what a search touches, close together. Single precision: searches work near
 * their own start. */
#ifndef FF_PLAN_SET_H
#define FF_PLAN_SET_H

#include "runtime/core/plan/plan.h"
#include "runtime/core/plan/plan_action.h"

#include <string.h>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

enum {
    FF_SET_TO_STANDING = 1,   /* ends in standing */
    FF_SET_FROM_STANDING = 2, /* begins in standing */
    FF_SET_REACTIVE = 4,      /* a jump, a duck: only when asked for */
    FF_SET_DUCK = 8,          /* a duck */
};

typedef struct ff_set_action {
    float duration, cost; /* s, J/kg with penalties */
    float land[2];        /* m, in S0 */
    float root_end[2];    /* m */
    float theta, cosine, sine;
    float samples_per_s;
    float circle[3]; /* a, b, radius: in S0, holds all colliders at all times */
    /* Of the successors: [0] of steps, [1] of jumps and ducks as well. */
    float next_longest[2];                       /* s */
    float next_reach[2];                         /* m: from the root at the end, how far any collider gets */
    uint32_t first_knot, knots;                  /* into samples, evenly from start to end */
    uint32_t first_next, next_count, step_count; /* into next; the first step_count are no jumps and ducks */
    uint32_t first_stop, stop_count;             /* into stops */
    uint16_t flags;
    uint8_t support, kind; /* foot; ff_action_class of the end */
    float pace;            /* factor on the record's speed */
    uint32_t pack_index;
    uint32_t first_variant, variant_count; /* the same at other speeds: actions of the set */
    uint32_t reach;                        /* table of the pack */
} ff_set_action;

/* How an action begins and ends, for what joins it to others (plan_joint.h). */
typedef struct ff_set_ends {
    float begin[2][FF_TRACK_LANES], end[2][FF_TRACK_LANES]; /* m/s: a and b of the colliders, in S0 */
    float lift[2];           /* s from the start, per foot: until when it stands, if it begins so */
    float land[2];           /* s: when it comes down */
    float last;              /* s: by then what joins it to the action before is over */
    bool begins[2], ends[2]; /* it stands as the action begins, and as it ends */
} ff_set_ends;

/* What joins an action to one before, in its own S0. */
typedef struct ff_joint {
    ff_knot jump; /* m: where the action before ends, off where this one begins */
    /* m: by how much faster they move then, times the span in which they lose it */
    float rush_a[FF_TRACK_LANES], rush_b[FF_TRACK_LANES];
    float arc_a[FF_TRACK_LANES], arc_b[FF_TRACK_LANES]; /* m: off the straight way half way (plan_arc.c) */
    float from[FF_TRACK_LANES]; /* s from the start, until when all of the jump is left */
    float rate[FF_TRACK_LANES]; /* 1/s: of the span in which it then fades */
    float over;                 /* s from the start, when nothing is left */
    /* How far colliders are moved about the root: m, of jumps of head and hands, feet, root, by speeds, on arcs; s and 1/s, between
     * when feet get to their places at the latest. */
    float most_body, most_feet, most_root, most_rush, most_arc, last_from, last_rate;
} ff_joint;

/* What may follow, cheapest first. */
typedef struct ff_set_next {
    uint16_t action;
    uint16_t other; /* 1: stands on the foot that the action before stood on */
    float cost;     /* J/kg of action and joint */
    float jump;     /* m, the most that the joint moves any collider */
} ff_set_next;

/* The shortest ways to a stand from the end of an action: one or two actions. */
typedef struct ff_set_stop {
    /* into the lists of `next`, relative to the first of each action; 0xffff: no second one */
    uint16_t next[2];
    float time, cost;
} ff_set_stop;
enum { FF_SET_STOPS_MAX = 12, FF_SET_NO_STOP = 0xffff };

/* Of a sample: where the root is, and the radius about it that holds all colliders. */
typedef struct ff_set_root {
    float a, b, about; /* m */
} ff_set_root;

struct ff_action_set {
    const ff_pack *pack;
    const ff_pack_reach *reach; /* NULL when some action has no table */
    const float *radii;         /* [FF_COLLIDER_COUNT] m */
    uint32_t count, stand;
    ff_set_action *actions;
    ff_set_ends *ends; /* [count] */
    ff_set_next *next;
    ff_joint *joints; /* [next_total] */
    ff_set_stop *stops;
    ff_knot *samples;
    ff_set_root *roots; /* [knot_total] of the samples */
    uint32_t next_total, knot_total, stop_total;
    uint32_t next_most; /* successors of one action */
    float stop_cost;    /* J/kg: the cheapest way to a stand, from where that is dearest */
    float rate;         /* J/kg per m: no sequence of actions moves the root further for less */
    float reach_share;  /* of what the reach tables say: no sequence with speeds varied costs less */
};

/* p + f (q - p), for all colliders. */
static inline void ff_mix_lanes(const float *p, const float *q, float f, float *restrict out)
{
#ifdef __SSE2__
    for (int i = 0; i <= FF_TRACK_LANES - 4; i += FF_TRACK_LANES - 4) { /* the middle ones twice */
        __m128 x = _mm_loadu_ps(p + i), d = _mm_sub_ps(_mm_loadu_ps(q + i), x);
        _mm_storeu_ps(out + i, _mm_add_ps(x, _mm_mul_ps(_mm_set1_ps(f), d)));
    }
#else
    for (int i = 0; i < FF_TRACK_LANES; ++i)
        out[i] = p[i] + f * (q[i] - p[i]);
#endif
}

/* The sample of an action before t seconds from its start; *share: of the way to the next one. */
static inline const ff_knot *ff_set_samples_at(const ff_action_set *set, const ff_set_action *action, float t,
                                               float *share)
{
    float at = t * (float)(action->knots - 1) / action->duration;
    int k = (int)at;
    k = k < 0 ? 0 : (k > (int)action->knots - 2 ? (int)action->knots - 2 : k);
    float f = at - (float)k;
    *share = f < 0.0f ? 0.0f : (f > 1.0f ? 1.0f : f);
    return &set->samples[action->first_knot + (uint32_t)k];
}

/* Colliders of an action at t seconds from its start, in S0. */
static inline void ff_set_sample(const ff_action_set *set, const ff_set_action *action, float t,
                                 ff_knot *restrict out)
{
    float f;
    const ff_knot *p = ff_set_samples_at(set, action, t, &f), *q = p + 1;
    ff_mix_lanes(p->a, q->a, f, out->a);
    ff_mix_lanes(p->b, q->b, f, out->b);
    ff_mix_lanes(p->y, q->y, f, out->y);
}

/* The same of one of them, i: a, b, y. */
static inline void ff_set_sample_one(const ff_action_set *set, const ff_set_action *action, float t, int i,
                                     float out[3])
{
    float f;
    const ff_knot *p = ff_set_samples_at(set, action, t, &f), *q = p + 1;
    out[0] = p->a[i] + f * (q->a[i] - p->a[i]);
    out[1] = p->b[i] + f * (q->b[i] - p->b[i]);
    out[2] = p->y[i] + f * (q->y[i] - p->y[i]);
}

/* Colliders in S0, in their place. */
static inline void ff_set_put(const ff_knot *local, const float anchor[2], float c, float s,
                              ff_knot *restrict out)
{
#ifdef __SSE2__
    const __m128 cosine = _mm_set1_ps(c), sine = _mm_set1_ps(s);
    const __m128 at_a = _mm_set1_ps(anchor[0]), at_b = _mm_set1_ps(anchor[1]);
    for (int i = 0; i <= FF_TRACK_LANES - 4; i += FF_TRACK_LANES - 4) { /* the middle ones twice */
        __m128 a = _mm_loadu_ps(local->a + i), b = _mm_loadu_ps(local->b + i);
        __m128 x = _mm_add_ps(at_a, _mm_mul_ps(cosine, a)), y = _mm_add_ps(at_b, _mm_mul_ps(sine, a));
        _mm_storeu_ps(out->a + i, _mm_sub_ps(x, _mm_mul_ps(sine, b)));
        _mm_storeu_ps(out->b + i, _mm_add_ps(y, _mm_mul_ps(cosine, b)));
    }
#else
    for (int i = 0; i < FF_TRACK_LANES; ++i) {
        out->a[i] = anchor[0] + c * local->a[i] - s * local->b[i];
        out->b[i] = anchor[1] + s * local->a[i] + c * local->b[i];
    }
#endif
    memcpy(out->y, local->y, sizeof out->y);
}

/* The root alone, and a radius about it that holds all colliders. */
static inline ff_set_root ff_set_root_at(const ff_action_set *set, const ff_set_action *action, float t)
{
    float at = t * action->samples_per_s;
    int k = (int)at, last = (int)action->knots - 2;
    k = k < last ? k : last;
    float f = at - (float)k;
    f = f < 1.0f ? f : 1.0f;
    const ff_set_root *p = &set->roots[action->first_knot + (uint32_t)k], *q = p + 1;
    return (ff_set_root){p->a + f * (q->a - p->a), p->b + f * (q->b - p->b),
                         (p->about > q->about ? p->about : q->about) +
                             1e-4f}; /* which roundings do not come to */
}

/* May it be done by who may do what the bits FF_EVADE_* say? */
static inline bool ff_set_allows(const ff_set_action *action, uint32_t evasions)
{
    if (!(action->flags & FF_SET_REACTIVE)) return true;
    return (evasions & (action->flags & FF_SET_DUCK ? (uint32_t)FF_EVADE_DUCK : (uint32_t)FF_EVADE_JUMP)) !=
           0;
}

/* Which actions of the pack to take: marks chosen[], at most cap and, from 40 on, the jumps and ducks that were made up; returns how many (plan_select.c). */
uint32_t ff_set_select(const ff_pack *pack, uint32_t cap, bool *usable, bool *chosen, uint32_t *stand);

#endif
