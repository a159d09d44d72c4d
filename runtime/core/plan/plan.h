/* plan.h - plans of footsteps: what an agent is going to do, step by step, until it stands; and the search for one
 * (Beacco et al. 2013; algorithms A and B; footstep study, section 4).
 *
 * A plan places actions of the pack in the plane: each begins on a foot that stands, at an absolute time, and ends with
 * the other foot landed, from where the next one begins. Every plan ends in standing, for ever: who has a plan is never
 * without one, and everybody else may rely on where its owner will be.
 *
 * Where a plan's owner is at a time is its track: the six colliders of the pack, a straight line between moments a
 * fifteenth of a second apart, the same moments for everybody. Searches, checks between plans and the check when a plan is put in
 * force all use this one track, so plans that were found free of each other are.
 *
 * Everything is a pure function of its arguments; nothing allocates but the functions called create. Lengths in m,
 * angles in rad, times in s, energies in J/kg. Points are plane coordinates.
 */
#ifndef FF_PLAN_H
#define FF_PLAN_H

#include "runtime/core/pack/pack.h"

/* ------------------------------------------------------------------------------------------------- actions */

/* The actions that plans are made of, prepared from a pack. Immutable; shared by all agents and threads. */
typedef struct ff_action_set ff_action_set;

/* At most cap actions of the pack (0: the default, FF_ACTIONS_DEFAULT) and a few made-up jumps and ducks, the most useful ones, each with its mirror image
 * where the pack has one. Fails with FF_ERR_NO_DATA when the pack has no way to stand, to start and to stop. The pack must
 * outlive the set. */
enum { FF_ACTIONS_DEFAULT = 200 };
ff_status ff_action_set_create(const ff_pack *pack, uint32_t cap, ff_action_set **out, ff_error *error);
/* The same, and each walking step once more at each of speed_count (at most FF_SPEED_VARIATIONS_MAX) factors on its speed, as
 * an action of its own: same places, other times (algorithms A.13). Factors that are 0 are none. */
ff_status ff_action_set_create_varied(const ff_pack *pack, uint32_t cap, const double *speeds,
                                      uint32_t speed_count, ff_action_set **out, ff_error *error);
void ff_action_set_destroy(ff_action_set *set); /* NULL is fine */

uint32_t ff_action_set_count(const ff_action_set *set);
/* The record of an action (an index into the set), and its number in the pack. */
const ff_pack_action *ff_action_set_record(const ff_action_set *set, uint32_t action);
uint32_t ff_action_set_pack_index(const ff_action_set *set, uint32_t action);
/* How many times as fast as its record it is done. */
double ff_action_set_pace(const ff_action_set *set, uint32_t action);
/* The action whose last pose people stand in who have not come by any other way. */
uint32_t ff_action_set_stand(const ff_action_set *set);
const ff_pack *ff_action_set_pack(const ff_action_set *set);

/* ---------------------------------------------------------------------------------------------------- plans */

enum { FF_PLAN_STEPS_MAX = 26 };

/* An action in its place. Its frame S0 (pack_format.h) has its origin at anchor and looks along heading. */
typedef struct ff_plan_step {
    ff_vec2 anchor; /* where the ball of the support foot stands */
    double heading; /* rad, of the root when the action begins */
    double start;   /* s */
    uint32_t action;
    /* 1: no action, but standing in the last pose of one, whose anchor and heading these are, until the next step begins.
     * The last step of a plan is a hold that does not end. */
    uint32_t hold;
} ff_plan_step;

typedef struct ff_plan {
    ff_plan_step steps[FF_PLAN_STEPS_MAX];
    uint32_t count; /* >= 1; the last is a hold */
    uint32_t own;   /* index of the first step that the search chose; those before were being done already */
    uint32_t stop; /* index of the first step of the stop: what is only done if no newer plan comes in time */
    uint32_t reserved;
    ff_plan_step from; /* what steps[0] followed: it begins with that one's last pose */
    double cost; /* J/kg of steps own to stop - 1, and what is guessed to be left from there to the goal */
} ff_plan;

/* A plan that is nothing but standing: root at position, facing heading, from time on. */
void ff_plan_stand(const ff_action_set *set, ff_vec2 position, double heading, double time, ff_plan *out);

/* The step that is being done at a time: the last one that has begun (the first one before it began). */
uint32_t ff_plan_step_at(const ff_plan *plan, double time);

/* When step i ends: where the next one begins; INFINITY for the last one. */
double ff_plan_step_end(const ff_plan *plan, uint32_t step);

/* Where a foot stands when step i has ended. */
typedef struct ff_footprint {
    ff_vec2 ball;
    double yaw; /* rad, heel to ball */
} ff_footprint;
ff_footprint ff_plan_landing(const ff_action_set *set, const ff_plan_step *step);

/* Root (a, b, heading) of the action alone at a time within step i: the clip's, without what joins it to the step before. */
ff_root_frame ff_plan_root_at(const ff_action_set *set, const ff_plan *plan, double time);

/* The colliders at a time, joins included: plane coordinates and height over the ground, in order of FF_COLLIDER_*. The
 * track runs straight between these at its knots. */
void ff_plan_colliders(const ff_action_set *set, const ff_plan *plan, double time,
                       ff_vec3 out[FF_COLLIDER_COUNT]);

/* --------------------------------------------------------------------------------------------------- tracks */

#define FF_TRACK_STEP (1.0 / 15.0) /* s: knot k is at k * FF_TRACK_STEP */
enum { FF_TRACK_KNOTS_MAX = 160, FF_TRACK_LANES = FF_COLLIDER_COUNT, FF_TRACK_CHUNK = 4 };
enum { FF_TRACK_ROOMS = FF_TRACK_KNOTS_MAX / FF_TRACK_CHUNK + 1 };

/* Horizontal radii of the colliders, m, of a pack that does not say its own (algorithms A.9; root: footstep study, section 2). */
extern const float ff_collider_radius[FF_COLLIDER_COUNT];
/* Heights between which a collider at height y is solid. */
void ff_collider_extent(uint32_t collider, float y, float *low, float *high);

/* All colliders at one moment, relative to the track's origin. */
typedef struct ff_knot {
    float a[FF_TRACK_LANES], b[FF_TRACK_LANES], y[FF_TRACK_LANES];
} ff_knot;

/* Room (root and radius) that a track takes up in a chunk of time, relative to its origin. Chunk n is from knot 4 n to knot 4 n + 4: the same
 * moments for everybody. */
typedef struct ff_track_room {
    float low_a, low_b, high_a, high_b;
} ff_track_room;

/* The chunk that a knot is in. */
static inline int64_t ff_knot_chunk(int64_t knot)
{
    return (knot >= 0 ? knot : knot - (FF_TRACK_CHUNK - 1)) / FF_TRACK_CHUNK;
}

/* Where a plan's owner will be. Plain data without pointers. */
typedef struct ff_track {
    ff_vec2 origin;
    int64_t first;  /* number of the first knot */
    uint32_t count; /* >= 1; before the first and after the last knot all stays as it is there */
    uint32_t reserved;
    float radii[FF_TRACK_LANES];        /* m, of the colliders */
    ff_track_room room[FF_TRACK_ROOMS]; /* of the first knot's chunk and those after it */
    float radius[FF_TRACK_KNOTS_MAX];   /* about the root, holds all colliders */
    ff_knot knots[FF_TRACK_KNOTS_MAX];
} ff_track;

/* How many rooms of it there are; the last one is for ever. */
static inline uint32_t ff_track_rooms(const ff_track *track)
{
    int64_t last = track->first + (int64_t)track->count - 1;
    return (uint32_t)(ff_knot_chunk(last) - ff_knot_chunk(track->first)) + 1;
}

/* The track of a plan from a time on (from the knot at or before it). */
void ff_plan_track(const ff_action_set *set, const ff_plan *plan, double from, ff_track *out);

/* Do two tracks, from a time on, for ever, come nearer than their radii and margin? *when: the knot after which they do.
 * Exact on the tracks, heights included. What is asked of a plan before it is put in force: with margin 0, published plans
 * are then free of each other for as long as they are followed. */
bool ff_track_conflict(const ff_track *x, const ff_track *y, double from, double margin, double *when);

/* -------------------------------------------------------------------------------------- what is in the way */

/* A footprint with a rounded edge and a height: a disc (both half sizes 0), a capsule (one 0), a box. */
typedef struct ff_shape {
    ff_vec2 centre;
    double heading;                 /* rad, of the length */
    double half_length, half_width; /* m */
    double radius;                  /* m, on top of it */
    double low, high;               /* m over the ground */
    uint32_t round; /* 1: rounded over the top and below as well (spheres, lying capsules): low and high
                                      include the radius */
    uint32_t reserved;
} ff_shape;

/* How something that moves can be evaded on the spot, as bits. */
enum { FF_EVADE_JUMP = 1, FF_EVADE_DUCK = 2 };
uint32_t ff_shape_evasions(const ff_shape *shape);

/* A place on the way of an obstacle that moves on a known path. Between two it moves straight and evenly; it waits at the
 * last one, or begins again when the path goes round. */
typedef struct ff_path_point {
    double time; /* s from the path's start, rising */
    ff_vec2 at;
} ff_path_point;
typedef struct ff_mover {
    ff_shape shape; /* centre: added to the path */
    const ff_path_point *path;
    uint32_t count;
    uint32_t cyclic;
    double start; /* s */
} ff_mover;

/* Where its path has it at a time, without the shape's own centre. */
ff_vec2 ff_mover_at(const ff_mover *mover, double time);

/* Who goes by velocity: a capsule along its way, believed to go on straight for a while, with room that grows. */
typedef struct ff_walker {
    ff_vec2 position, velocity; /* at the time of the world */
    double wide;                /* m, its radius */
    double radius; /* m: no more than there is room for until the present step is over, and then regained */
    double half_length; /* m */
    double grow;        /* m/s, of the radius */
    double until;       /* s: for so long it is believed to go on */
    /* NULL: straight on; else from its position, FF_TRACK_STEP apart from the time of the world on; it stands at the last one */
    const float *path_a, *path_b;
    uint32_t path_count, reserved;
} ff_walker;

/* What does not move: walls (segments of any height, solid from both sides) and shapes, with a tree that finds those near. */
typedef struct ff_solids ff_solids;
ff_status ff_solids_create(const ff_vec2 (*walls)[2], uint32_t wall_count, const ff_shape *shapes,
                           uint32_t shape_count, ff_solids **out, ff_error *error);
void ff_solids_destroy(ff_solids *solids); /* NULL is fine */

/* Is the straight way of a disc from p to q free of what does not move? */
bool ff_solids_clear(const ff_solids *solids, ff_vec2 p, ff_vec2 q, double radius);

/* The one of count waypoints to make for from position: the furthest that is seen (a disc of the radius gets there
 * straight on) of those from `next` on, `next` itself if none is (Beacco et al. 2013, 5.1). */
uint32_t ff_waypoint_seen(const ff_solids *solids, const ff_vec2 *points, uint32_t count, uint32_t next,
                          ff_vec2 position, double radius);

/* Way to a goal past what does not move, from everywhere within an extent (m, each way), for somebody who keeps a clearance: 0.5 m
 * fits people, whose elbows catch at corners. Shared by all who have the goal; at most 1 MB. */
typedef struct ff_field ff_field;
ff_status ff_field_create(const ff_solids *solids, ff_vec2 goal, double extent, double clearance,
                          ff_field **out, ff_error *error);
void ff_field_destroy(ff_field *field); /* NULL is fine */

/* What a search sees. Everything is borrowed. */
typedef struct ff_plan_world {
    const ff_solids *solids; /* or NULL */
    /* Published plans of others, not the agent's own: all that can be met, who may be up to 20 m away now. */
    const ff_track *const *tracks;
    uint32_t track_count;
    const ff_mover *movers;
    uint32_t mover_count;
    const ff_walker *walkers;
    uint32_t walker_count;
    const ff_shape *shapes; /* unpredictable ones that are near, where they are now */
    uint32_t shape_count;
} ff_plan_world;

/* --------------------------------------------------------------------------------------------------- search */

typedef struct ff_plan_goal {
    ff_vec2 at;
    double radius;    /* m, within which the root must come; default 0.35 */
    double heading;   /* rad, wanted if tolerance < pi */
    double tolerance; /* rad */
    double latest;    /* s, absolute: not to be reached later; INFINITY */
    uint32_t stand;   /* 1 (default): it is reached by standing there; 0: a waypoint, to walk past */
    uint32_t reserved;
    const ff_field *field; /* made for `at`, or NULL */
} ff_plan_goal;

/* A second of waiting costs so many times the energy of standing (footstep study, section 4.4); so does one that an action
 * takes longer than a walk over its way would, or people would step about on the spot instead. */
#define FF_PLAN_WAIT 3.0

typedef struct ff_plan_options {
    uint32_t nodes;      /* how many may be expanded; default 300 */
    uint32_t improve;    /* of those, how many once there is a plan; default 60 */
    double seconds;      /* wall clock on top; 0 (default): none, and results depend on the arguments alone */
    uint32_t horizon;    /* actions ahead, default 16, at most 20; 1 = purely reactive */
    double time_horizon; /* s: who gets so far has done enough; default 5.5, 0 = none */
    double inflation;    /* of the heuristic in the first round; default 3 */
    double inflation_step; /* less of it in each further round, down to 1; 0 = one round only. Default 0.5 */
    double margin;         /* m, to keep from others on top of radii; default 0.05 */
    double stand_margin;   /* m, more of it where the plan stands in the end; default 0.03 */
    double wait;           /* price of waiting, in units of e_s; default 3 */
    double proximity_cost; /* J/(kg s) within proximity of somebody; default 0 */
    double proximity;      /* m; default 0.3 */
    /* J/kg that a jump or a duck costs on top of its energy, where they are allowed; default 150 */
    double reactive_cost;
    double view;         /* m, how far away those are now who can be met later; default 20 */
    uint32_t view_count; /* how many of them, the likeliest; default and at most 128 */
    uint8_t lazy;  /* actions are tested when they are looked at, not when they are thought of; default 1 */
    uint8_t safe;  /* plans end in a checked stop; default 1. 0: as in the paper */
    uint8_t table; /* the pack's reach table guides the search; default 1 */
    uint8_t merge; /* places that are nearly the same count as one; default 1 */
    uint8_t reactive; /* FF_EVADE_*: jumps, ducks too, for imminent danger; default 0 */
} ff_plan_options;
ff_plan_options ff_plan_options_default(void);
ff_plan_goal ff_plan_goal_at(ff_vec2 at);

typedef enum ff_plan_outcome {
    FF_PLAN_REACHED, /* to the goal */
    FF_PLAN_AHEAD,   /* as far as the time horizon */
    FF_PLAN_PART,    /* as far as the budget let it */
    FF_PLAN_NONE, /* nothing that is safe was found: the old plan is the best there is, *out is untouched */
} ff_plan_outcome;

typedef struct ff_plan_result {
    ff_plan_outcome outcome;
    uint32_t expanded, generated, tested; /* nodes */
    uint32_t rounds;
    double inflation; /* the plan costs at most so many times the least (by the table, nearly) */
    double cost;      /* as ff_plan.cost */
} ff_plan_result;

/* Memory of a search: one per thread. */
typedef struct ff_plan_scratch ff_plan_scratch;
ff_status ff_plan_scratch_create(const ff_action_set *set, uint32_t nodes_max, ff_plan_scratch **out,
                                 ff_error *error);
void ff_plan_scratch_destroy(ff_plan_scratch *scratch); /* NULL is fine */

/* A plan to the goal that begins where the step that current is doing at `time` ends (a hold ends at `time`). *out holds
 * that step too, so that it can be published at once, and may be current itself. What current says from there on is
 * looked at first: while the world is as it was, a plan to the goal is never followed by a dearer one. */
ff_plan_result ff_plan_search(const ff_action_set *set, const ff_plan_world *world, const ff_plan *current,
                              double time, const ff_plan_goal *goal, const ff_plan_options *options,
                              ff_plan_scratch *scratch, ff_plan *out);

#endif
