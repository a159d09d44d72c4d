/* plan_sight.h - what one search sees (plan_sight.c), and whether an action, or standing, is free of it (plan_stance.c). All
 * times count knots from the search's first one; all places are relative to where it starts. */
#ifndef FF_PLAN_SIGHT_H
#define FF_PLAN_SIGHT_H

#include "runtime/core/plan/plan_hit.h"
#include "runtime/core/plan/plan_set.h"
#include "runtime/core/plan/plan_solids.h"

enum { FF_SIGHT_MAX = 128, FF_SIGHT_MOVING_MAX = 64, FF_SIGHT_KNOTS = 48 };
enum {
    FF_SIGHT_CHUNKS = FF_TRACK_ROOMS,
    FF_SIGHT_WINDOW = 4
}; /* chunks of time; as long as most actions take */

/* Room that all those seen take up in chunks c to c + FF_SIGHT_WINDOW - 1. */
typedef struct ff_sight_rooms {
    float low_a[FF_SIGHT_MAX], low_b[FF_SIGHT_MAX], high_a[FF_SIGHT_MAX], high_b[FF_SIGHT_MAX];
} ff_sight_rooms;

/* Another agent's track. */
typedef struct ff_sight_track {
    const ff_track *track;
    float a, b;     /* m, of its origin */
    int32_t shift;  /* its first knot */
    int32_t chunk;  /* its first chunk */
    uint32_t rooms; /* of the track */
    float share;    /* of the way that can be walked to it by then */
} ff_sight_track;

/* Where its root is at all knots of the search, and radii that hold its body at a knot and the next one: four to be looked at
 * at a time. */
enum { FF_SIGHT_PATH = FF_TRACK_KNOTS_MAX + FF_SIGHT_KNOTS + 4 };
typedef struct ff_sight_path {
    float a[FF_SIGHT_PATH], b[FF_SIGHT_PATH], radius[FF_SIGHT_PATH];
} ff_sight_path;

/* A moving obstacle, or somebody who goes by velocity, knot by knot. */
typedef struct ff_sight_mover {
    ff_solid solid; /* at (0, 0) */
    double grow;    /* m per knot, of its margin */
    ff_vec2 at[FF_TRACK_KNOTS_MAX];
    float slack[FF_TRACK_KNOTS_MAX]; /* m, by which it leaves the straight line between knots k and k + 1 */
    uint32_t known;                  /* knots; after them it stands, or is gone */
    uint32_t gone;
    uint32_t evaded; /* 1: who stands can jump or duck it */
    int32_t yields;  /* knot from which on it goes round those who stand */
} ff_sight_mover;

/* A meeting with one that is seen, between a knot and the next. */
typedef struct ff_meeting {
    uint16_t who; /* FF_SIGHT_MAX: nobody yet */
    ff_touch touch;
    int32_t knot;
} ff_meeting;
enum { FF_MEETINGS = 3 };

typedef struct ff_sight {
    const ff_action_set *set;
    const ff_solids *solids;
    ff_vec2 origin;
    int64_t first_knot;
    int32_t skipped; /* knots of its chunk that are before it */
    double lead;     /* s, from the first knot to the start of the search */
    float margin, stand_margin;
    ff_limits limits, stand_limits;
    uint32_t count, mover_count, shape_count;
    uint32_t reactive; /* 1: jumps and ducks are thought of, too */
    ff_sight_track seen[FF_SIGHT_MAX];
    uint32_t window_count; /* of rooms; after them all stands */
    ff_sight_rooms rooms[FF_SIGHT_CHUNKS];
    ff_sight_path path[FF_SIGHT_MAX]; /* of those that have been come near to */
    bool pathed[FF_SIGHT_MAX];
    ff_meeting met[FF_MEETINGS]; /* the last ones that were found, the last first */
    ff_sight_mover mover[FF_SIGHT_MOVING_MAX];
    ff_solid shape[FF_SIGHT_MAX];
    float cost, cost_within; /* proximity */
} ff_sight;

/* What of the world is near enough; knots numbered from the one at or before time. */
void ff_sight_open(const ff_action_set *set, const ff_plan_world *world, const ff_plan_options *options,
                   ff_vec2 origin, double time, ff_sight *out);

/* Nothing can be met anywhere. */
static inline bool ff_sight_is_empty(const ff_sight *sight)
{
    return sight->count == 0 && sight->mover_count == 0 && sight->shape_count == 0 &&
           (!sight->solids || sight->solids->count == 0);
}

/* Where an agent is at the joint between two actions: everything its next steps have in common. */
typedef struct ff_stance {
    float at[2], other[2]; /* m: ball of the foot that has landed, anchor of the action that is over */
    float cosine, sine;    /* of the heading now */
    float time;            /* s from the first knot */
    uint16_t action;
    uint8_t hold; /* stood since then */
    ff_knot end;  /* colliders now */
    ff_knot tail; /* and at the last knot not after now */
    int32_t knot; /* its number */
    float moved;  /* m, the furthest that any collider moves from tail to end */
    float about;  /* m, about the root at the tail, holds all colliders */
    /* who is near enough for any successor to meet */
    uint32_t near_count, mover_count;
    uint8_t near[FF_SIGHT_MAX], mover[FF_SIGHT_MOVING_MAX];
    bool solids;
    ff_meeting met[FF_MEETINGS]; /* the last ones of successors; before there are any, of the search */
} ff_stance;

/* Fill in everything after `hold`; the heading is the one that the action began with. */
void ff_stance_begin(const ff_sight *sight, float begin_cosine, float begin_sine, ff_stance *stance);

/* The chunk that a knot, >= 0, is in. */
static inline uint32_t ff_sight_chunk(const ff_sight *sight, int32_t knot)
{
    return (uint32_t)(knot + sight->skipped) / FF_TRACK_CHUNK;
}

/* Colliders of one that is seen at a knot, before its origin is added, and the radius about its root. */
static inline const ff_knot *ff_sight_knot(const ff_sight_track *seen, int32_t knot, float *radius)
{
    int32_t k = knot - seen->shift, last = (int32_t)seen->track->count - 1;
    k = k < 0 ? 0 : (k > last ? last : k);
    *radius = seen->track->radius[k];
    return &seen->track->knots[k];
}

/* Does one that is seen take up room within radius of (a, b) in one of the chunks from first to last? */
static inline bool ff_sight_room_near(const ff_sight_track *seen, uint32_t first, uint32_t last, float a,
                                      float b, float radius)
{
    int32_t end = (int32_t)seen->rooms - 1;
    for (int32_t c = (int32_t)first - seen->chunk; c <= (int32_t)last - seen->chunk; ++c) {
        const ff_track_room *r = &seen->track->room[c < 0 ? 0 : (c > end ? end : c)];
        float x = a - seen->a, y = b - seen->b;
        float da = x < r->low_a ? r->low_a - x : (x > r->high_a ? x - r->high_a : 0.0f);
        float db = y < r->low_b ? r->low_b - y : (y > r->high_b ? y - r->high_b : 0.0f);
        if (da * da + db * db <= radius * radius) return true;
        if (c >= end) return false;
    }
    return false;
}

/* Is a successor (of set->next) free of everything, up to the knot at or before its end? *cost (may be NULL) gets what
 * going near others costs. */
bool ff_stance_free(ff_sight *sight, ff_stance *stance, const ff_set_next *next, float *cost);

/* Is waiting for a time, or (INFINITY) standing for ever? */
bool ff_stance_waits(ff_sight *sight, const ff_stance *stance, float seconds);

#endif
