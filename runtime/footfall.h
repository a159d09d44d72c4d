/* footfall.h - crowds of people who walk with their feet on the ground.
 *
 * Link libfootfall (pure C17: libc, libm and threads), open a motion pack made by `footfall-pack`, create a
 * crowd on it, add agents and walls, and step. Every agent's root and disc are one thing: what the body
 * really does is what moves.
 *
 * Units and axes: metres, seconds, radians; right-handed, Y up, ground y = 0; a character at rest faces +Z
 * with its left at +X; positive heading turns left (about +Y). Ground-plane points are ff_vec2 in PLANE
 * coordinates (a, b) := (z, x), so that heading psi points along (cos psi, sin psi) and "left" keeps its
 * sign; ff_plane() and ff_ground() convert. Quaternions are stored (x, y, z, w).
 *
 * Objects are opaque pointers with one owner; agents are handles with a generation. Every call that can fail
 * returns ff_status and fills the caller's ff_error (which may be NULL); outputs are then NULL or untouched.
 * Nothing is global; different crowds may be used from different threads at once.
 */
#ifndef FOOTFALL_H
#define FOOTFALL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default) /* what the shared library shows; everything else is compiled hidden */
#endif

#define FF_VERSION "0.1.0"

/* ------------------------------------------------------------------------------------- status and errors */

typedef enum ff_status {
    FF_OK = 0,
    FF_ERR_ARGUMENT,   /* a caller's value is outside what the function accepts */
    FF_ERR_IO,         /* the operating system refused to read or write */
    FF_ERR_PARSE,      /* a file does not say what its format demands */
    FF_ERR_NOT_FINITE, /* nan or inf where a number is needed */
    FF_ERR_RANGE,      /* a count or value is absurd, or a capacity is exceeded */
    FF_ERR_UNSUPPORTED,
    FF_ERR_NO_DATA, /* well-formed, but holds nothing usable */
    FF_ERR_NO_MEMORY,
} ff_status;

/* What went wrong and where. ff_error_text() renders it as "file:line:column: message". */
typedef struct ff_error {
    ff_status status;
    char file[256];       /* input being read; "" when there is none */
    uint32_t line;        /* 1-based; 0 = not a text position */
    uint32_t column;      /* 1-based; 0 = unknown */
    uint64_t byte_offset; /* from the start of a binary file; meaningful when section is not "" */
    char section[16];     /* pack section, "" for text files */
    char message[384];    /* what was found, what was expected, what to do */
} ff_error;

/* Render an error on one line into text (size bytes, always terminated). Returns text. */
const char *ff_error_text(const ff_error *error, char *text, size_t size);
const char *ff_status_name(ff_status status);

/* ---------------------------------------------------------------------------------------------- geometry */

typedef struct ff_vec2 {
    double a, b; /* plane coordinates: a = world z, b = world x */
} ff_vec2;
typedef struct ff_vec3 {
    double x, y, z;
} ff_vec3;
typedef struct ff_quat {
    double x, y, z, w;
} ff_quat;

/* From a joint's frame into the world: row i of the rotation, then the place's component i (x, y, z); for column vectors,
 * world = row[i][0..2] . v + row[i][3]. 48 bytes, as shaders and skinning take it (mat3x4 by rows). */
typedef struct ff_matrix {
    float row[3][4];
} ff_matrix;

static inline ff_vec2 ff_plane(ff_vec3 p)
{
    ff_vec2 q = {p.z, p.x};
    return q;
}
static inline ff_vec3 ff_ground(ff_vec2 p, double y)
{
    ff_vec3 q = {p.b, y, p.a};
    return q;
}

/* ------------------------------------------------------------------------------------------- motion packs */

/* An opened motion pack: immutable, used in place, may be shared by any number of crowds and threads. */
typedef struct ff_pack ff_pack;

/* Map a pack file and check every offset, count and index in it. On failure *out is NULL and error names the
 * section and byte. The pack must outlive every crowd made on it. */
ff_status ff_pack_open(const char *path, ff_pack **out, ff_error *error);

/* The same for size bytes at data (64-byte aligned; borrowed, must outlive the pack). */
ff_status ff_pack_open_memory(const void *data, size_t size, ff_pack **out, ff_error *error);

void ff_pack_close(ff_pack *pack); /* NULL is fine */

uint32_t ff_pack_joint_count(const ff_pack *pack);
const char *ff_pack_joint_name(const ff_pack *pack, uint32_t joint); /* owned by the pack */
int32_t ff_pack_joint_parent(const ff_pack *pack, uint32_t joint);   /* -1 = root */
ff_vec3 ff_pack_joint_offset(const ff_pack *pack, uint32_t joint);   /* m, from the parent, rest pose */

/* Every clip and every gait example is a stream of poses. */
uint32_t ff_pack_stream_count(const ff_pack *pack);
double ff_pack_stream_seconds(const ff_pack *pack, uint32_t stream); /* its length, or once round the cycle */
int ff_pack_stream_cyclic(const ff_pack *pack, uint32_t stream); /* 1: goes on with its start after its end */
uint32_t ff_pack_clip_count(const ff_pack *pack);
const char *ff_pack_clip_name(const ff_pack *pack, uint32_t clip); /* owned by the pack */
uint32_t ff_pack_clip_stream(const ff_pack *pack, uint32_t clip);

/* Where a motion is on the ground: a point under the hips, smoothed, and the way the body faces. */
typedef struct ff_root_frame {
    ff_vec2 position; /* m, plane coordinates of the clip's world; (0, 0) all through a gait example */
    double heading;   /* rad, goes on past full turns */
} ff_root_frame;

enum { FF_SAMPLE_MIRRORED = 1 }; /* flags: left and right exchanged */

/* Pose of a stream at a time (s from its start; a cyclic one goes round, another stays at its ends). *hips: position of
 * joint 0 in the root's frame (x left, y up from the ground, z ahead). rotations[joint_count]: local to the parent,
 * joint 0 relative to the root's heading; of length 1 within 1e-6. Any of the three may be NULL. Costs the same at any
 * time, remembers nothing, allocates nothing, the same bits everywhere; may be called from any number of threads. */
ff_status ff_pack_sample(const ff_pack *pack, uint32_t stream, double time, uint32_t flags,
                         ff_root_frame *root, ff_vec3 *hips, ff_quat *rotations, ff_error *error);

/* From the root's frame into the world: *hips and *rotation of joint 0, as ff_crowd_agent_pose gives them. */
void ff_root_place(const ff_root_frame *root, ff_vec3 *hips, ff_quat *rotation);

/* ---------------------------------------------------------------------------------------------- behaviour
 *
 * What people do one after the other: a state machine that each agent may follow. A state says which goal to take, whether
 * to walk there or to stand, how fast, and where to look; transitions say what leads from it to which others. Goals may
 * hold so many people and no more. Signals are clocks that all can see; spawners put people in, exits take them out.
 *
 * All of it is arrays of plain records that refer to each other by index; a crowd copies them when it is created, checks them
 * and saves them with its state. (A scene file says the same in words: runtime/scenes/README.md.) Everything that is
 * drawn comes from a stream of each agent's own.
 */

#define FF_NAME_SIZE 32 /* bytes of a name with its final 0 */
#define FF_VARIABLES 8  /* numbers that an agent can remember */
#define FF_NONE UINT32_MAX

typedef enum ff_region_shape { FF_REGION_POINT, FF_REGION_CIRCLE, FF_REGION_BOX } ff_region_shape;

/* A place: a point, a disc, or a rectangle that may be turned. */
typedef struct ff_region {
    uint32_t shape, unused;
    ff_vec2 centre; /* m */
    ff_vec2 half;   /* m. Circle: a is the radius. Box: half its sides, along heading and to the left of it */
    double heading; /* rad */
} ff_region;

/* A number: a; or drawn evenly between a and b; or normal about a with deviation b, within two of them and not below 0. */
typedef enum ff_amount_kind { FF_AMOUNT_CONST, FF_AMOUNT_UNIFORM, FF_AMOUNT_NORMAL } ff_amount_kind;
typedef struct ff_amount {
    uint32_t kind, unused;
    double a, b;
} ff_amount;

typedef struct ff_goal_def {
    char name[FF_NAME_SIZE];
    ff_region place;   /* each who takes the goal chooses a spot in it, away from the spots of others */
    ff_vec2 look_at;   /* m, what one looks at from there */
    double weight;     /* of FF_CHOOSE_WEIGHTED, > 0 */
    uint32_t capacity; /* how many may have taken it at a time; 0: any number */
    uint32_t unused;
} ff_goal_def;

/* Goals first_goal to first_goal + goal_count - 1. */
typedef struct ff_goal_set_def {
    char name[FF_NAME_SIZE];
    uint32_t first_goal, goal_count;
    uint32_t exit; /* 1: who arrives is taken out of the crowd */
    uint32_t unused;
} ff_goal_set_def;

typedef struct ff_region_def {
    char name[FF_NAME_SIZE];
    ff_region place;
} ff_region_def;

/* Phases that follow each other round and round; at time 0 so many seconds have passed. */
typedef struct ff_phase_def {
    char name[FF_NAME_SIZE];
    double seconds;
} ff_phase_def;
typedef struct ff_signal_def {
    char name[FF_NAME_SIZE];
    uint32_t first_phase, phase_count;
    double passed; /* s */
} ff_signal_def;

/* What conditions can compare and actions can change (the last two). */
typedef enum ff_property {
    FF_PROPERTY_SPEED,           /* m/s, now */
    FF_PROPERTY_RADIUS,          /* m */
    FF_PROPERTY_GOAL_DISTANCE,   /* m, to its spot at the goal */
    FF_PROPERTY_GOAL_NUMBER,     /* place of its goal in the set, from 0; -1: none */
    FF_PROPERTY_STATE_TIME,      /* s, in this state */
    FF_PROPERTY_AGE,             /* s, in the crowd */
    FF_PROPERTY_PREFERRED_SPEED, /* m/s, without the state's factor */
    FF_PROPERTY_VARIABLE,        /* and FF_VARIABLES - 1 more */
} ff_property;
typedef struct ff_variable_def {
    char name[FF_NAME_SIZE];
    double start;
} ff_variable_def;

typedef enum ff_act_kind { FF_ACT_SET, FF_ACT_ADD, FF_ACT_SCALE } ff_act_kind;
typedef struct ff_act_def {
    uint32_t kind, property;
    ff_amount amount;
} ff_act_def;

typedef enum ff_condition_kind {
    FF_IF_ALWAYS,
    FF_IF_ARRIVED, /* within amount.a m of its spot at the goal, or settled as near as others let it */
    FF_IF_TIMER,   /* amount s have passed in this state; drawn when it is entered */
    FF_IF_CHANCE,  /* amount.a times a second on average */
    FF_IF_INSIDE,  /* region index */
    FF_IF_OUTSIDE,
    FF_IF_SIGNAL,  /* signal index shows its phase `value` (counted from 0) */
    FF_IF_BLOCKED, /* has wanted to go and could not for amount.a s */
    FF_IF_LESS,    /* property index against amount.a */
    FF_IF_MORE,
    FF_IF_ALL, /* conditions first to first + count - 1, all of which stand behind this one */
    FF_IF_ANY,
    FF_IF_NOT, /* one */
} ff_condition_kind;
typedef struct ff_condition_def {
    uint32_t kind, index, value;
    uint32_t first, count, unused;
    ff_amount amount;
} ff_condition_def;

/* If the condition holds: one of the targets, drawn by weight. */
typedef struct ff_transition_def {
    uint32_t condition, first_target, target_count, unused;
} ff_transition_def;
typedef struct ff_target_def {
    uint32_t state, unused;
    double weight;
} ff_target_def;

/* Which goal a state takes when it is entered. A goal that is full is never taken; where none is left, the transition into
 * the state does not happen. */
typedef enum ff_goal_choice {
    FF_CHOOSE_SHARED,   /* the one it has: states share it */
    FF_CHOOSE_EXPLICIT, /* goal `from`; the next ones are among the goals of set `from` */
    FF_CHOOSE_RANDOM,
    FF_CHOOSE_WEIGHTED,
    FF_CHOOSE_NEAREST,
    FF_CHOOSE_FARTHEST,
    FF_CHOOSE_NEXT,     /* the one behind the last, round and round */
    FF_CHOOSE_MIRROR,   /* no goal of a set, but the place opposite through the origin */
    FF_CHOOSE_OFFSET,   /* where it is, plus offset */
    FF_CHOOSE_IDENTITY, /* where it is */
} ff_goal_choice;

typedef enum ff_state_motion {
    FF_MOTION_GOAL,  /* walk to the goal */
    FF_MOTION_STAND, /* come to a stand and stay */
} ff_state_motion;

/* Where somebody looks while standing: turned to in place, with steps. */
typedef enum ff_face {
    FF_FACE_FREE,    /* as it happens */
    FF_FACE_POINT,   /* a point, m */
    FF_FACE_HEADING, /* a direction */
    FF_FACE_GOAL,    /* of states: what is to be looked at from its goal */
} ff_face;

/* Transitions are tried in their order; acts are done in theirs. */
typedef struct ff_state_def {
    char name[FF_NAME_SIZE];
    uint32_t choice, from, not_last; /* not_last: 1, another one than it has */
    uint32_t motion, face;
    uint32_t first_enter, enter_count, first_exit, exit_count; /* acts */
    uint32_t first_transition, transition_count, unused;
    ff_vec2 offset;  /* m */
    ff_vec2 face_at; /* m, or a direction */
    double speed;    /* factor on the preferred speed */
} ff_state_def;

typedef struct ff_machine_def {
    char name[FF_NAME_SIZE];
    uint32_t start; /* state */
    uint32_t unused;
} ff_machine_def;

/* Puts people into place, where there is room for them. */
typedef struct ff_spawner_def {
    char name[FF_NAME_SIZE];
    ff_region place;
    uint32_t machine;
    uint32_t regular; /* 1: in equal intervals; 0: at random, as often on average */
    uint32_t total;   /* how many in all; 0: without end */
    uint32_t most;    /* how many of its own may live at a time; 0: any number */
    double rate;      /* per s */
    double heading;   /* rad */
    ff_amount preferred_speed, radius;
} ff_spawner_def;

typedef struct ff_behaviour_def {
    const ff_machine_def *machines;
    const ff_state_def *states;
    const ff_transition_def *transitions;
    const ff_target_def *targets;
    const ff_condition_def *conditions;
    const ff_act_def *acts;
    const ff_goal_set_def *sets;
    const ff_goal_def *goals;
    const ff_region_def *regions;
    const ff_signal_def *signals;
    const ff_phase_def *phases;
    const ff_variable_def *variables;
    const ff_spawner_def *spawners;
    uint32_t machine_count, state_count, transition_count, target_count, condition_count, act_count,
        set_count, goal_count, region_count, signal_count, phase_count, variable_count, spawner_count, unused;
} ff_behaviour_def;

/* Whether a crowd would take it: every index, number and name. Of an error, section names the array and byte_offset the
 * place in it. */
ff_status ff_behaviour_check(const ff_behaviour_def *def, ff_error *error);

/* ------------------------------------------------------------------------------------------------- crowds */

typedef struct ff_crowd ff_crowd;
typedef struct ff_agent {
    uint32_t slot, generation; /* {0, 0} means "no agent" */
} ff_agent;

/* Run function(context, index) for every index in [0, count), in any order, on any threads; return when all
 * are done. */
typedef void ff_parallel_for(void *pool, uint32_t count, void (*function)(void *context, uint32_t index),
                             void *context);

/* How agents move. */
typedef enum ff_planner {
    FF_PLANNER_CROWD,     /* of an agent: as its crowd's definition says. Of a crowd: by velocity */
    FF_PLANNER_VELOCITY,  /* navigation asks for velocities, the body follows, the gait fits (FbCrowd) */
    FF_PLANNER_FOOTSTEPS, /* steps are planned ahead and played (footstep planning, Beacco et al. 2013) */
} ff_planner;

/* How agents find their way past each other who move by velocity. */
typedef enum ff_navigation {
    FF_NAVIGATION_CROWD, /* of an agent: as its crowd's definition says. Of a crowd: MCN */
    FF_NAVIGATION_MCN,   /* motion-constrained navigation (FbCrowd, section 4) */
    FF_NAVIGATION_ORCA,  /* baseline: reciprocal velocity obstacles alone (van den Berg et al. 2011) */
    FF_NAVIGATION_SF,    /* baseline: power-law forces alone (Karamouzas et al. 2014) */
} ff_navigation;

/* Where the body faces while navigation asks for a velocity. */
typedef enum ff_facing {
    FF_FACING_HALFWAY, /* between preferred velocity and command, unless these differ by more than 90 degrees */
    FF_FACING_STRAFE,    /* FbCrowd 4.5: where one would like to go, for at most a second of side-stepping */
    FF_FACING_PREFERRED, /* where one would like to go */
    FF_FACING_COMMAND,   /* where one goes */
} ff_facing;

/* What the body walks by (FbCrowd, section 5). Whatever is chosen, who prefers more than 2.2 m/s runs where the pack has
 * runs and there is room. */
typedef enum ff_synthesis {
    FF_SYNTHESIS_CROWD,           /* of an agent: as its crowd's definition says. Of a crowd: hybrid */
    FF_SYNTHESIS_BLENDING,        /* examples, blended: natural, at the velocities between them */
    FF_SYNTHESIS_SEMI_PROCEDURAL, /* one clip, deformed: exactly the velocity that is asked for */
    FF_SYNTHESIS_HYBRID,          /* the former, and the latter when a collision is near or it is dense */
} ff_synthesis;

/* The parts of motion-constrained navigation, each with a switch (runtime/README.md says where each comes from). */
typedef struct ff_mcn_def {
    bool hull;       /* velocities outside the hull of the walking examples are forbidden (eq 2-5) */
    bool sharp_turn; /* turning round by more than 90 degrees is done slowly */
    bool stance;     /* nobody steps across the standing foot (eq 6-8) */
    bool forces;     /* the preferred velocity gives way to power-law forces (eq 9, 11) */
    bool density;    /* and slows down where it is dense */
    bool weighted;   /* where not all can be avoided, those met sooner count more; else all alike */
    bool gradual;    /* commands change by no more than 2 m/s2 where that leaves a way */
    bool back_pedal; /* walking backwards is allowed, where the pack can (not in the paper); default off */
    bool lean;       /* who meets head on, nearly, passes on the convention's side */
    bool progress;   /* who gets no nearer tries a way round, or settles beside a taken goal */
    bool make_way;   /* who stands steps aside for others */
    ff_facing facing;
    double padding;    /* m, added to every radius; default 0.02 */
    double prediction; /* s, ahead of which pairs are looked at, about the lag of a body; default 0.3 */
} ff_mcn_def;

/* What the two baselines are given of it: nothing, by default. */
typedef struct ff_baseline_def {
    double keep_right; /* rad, as ff_crowd_def.keep_right */
    double padding;    /* m */
    /* others see the body's rates instead of the displacement over a quarter of a second */
    bool model_velocity;
} ff_baseline_def;

/* How those plan who move by footsteps. */
enum { FF_SPEED_VARIATIONS_MAX = 4 };
typedef struct ff_footsteps_def {
    /* there is memory for them (12 kB each) though the crowd's planner is velocity: agents may differ, or
     * change; default off */
    bool mixed;
    /* the paper's own formulation, to compare: no stop at the end of plans, no table, no time horizon, plain
     * distance as heuristic; see runtime/README.md */
    bool paper;
    uint32_t nodes; /* expanded per plan, 1 to 20000; default 300 */
    double seconds; /* wall clock per plan, on top; 0 (default): none, so that results do not depend on it */
    uint32_t plans; /* made per step, at most; 0 (default): 0.8 per second and agent of max_agents, and one */
    uint32_t actions;        /* of the pack, at most; 0 (default): 200 */
    double expiry;           /* s, after which a plan is made anew; default 2 */
    uint32_t expiry_actions; /* or after so many actions of it; default 3 */
    double margin;           /* m, kept from others' bodies and obstacles; default 0.08 */
    double proximity_cost;   /* J/(kg s) that being within 0.3 m of somebody counts for; default 0 */
    double speed_variations
        [FF_SPEED_VARIATIONS_MAX]; /* factors, 0.5 to 1.5, at which walking steps are there besides their own
                                speed; 0: none; default none */
} ff_footsteps_def;

/* A waypoint on the way to an agent's goal: true and *out, or false: straight to the goal. Called from any of the crowd's
 * threads; must depend on its arguments alone. */
typedef bool ff_waypoint(void *context, ff_agent agent, ff_vec2 position, ff_vec2 goal, ff_vec2 *out);

typedef struct ff_crowd_def {
    uint32_t max_agents;      /* hard cap; all memory is taken at creation */
    uint32_t max_walls;       /* static segments */
    double step;              /* s, fixed simulation step, up to 0.25; default 1/30 */
    uint64_t seed;            /* same seed and same calls give the same bits */
    uint32_t threads;         /* own pool of this many threads; 1 = the caller's only. Ignored if tasks set */
    ff_parallel_for *tasks;   /* caller's scheduler, or NULL */
    void *task_pool;          /* passed to tasks */
    double keep_right;        /* rad, by which people turn aside for those they meet; default 0.30, negative =
                               to the left. 0 makes them meet head on and jam: a convention is needed */
    ff_navigation navigation; /* of agents that do not name their own */
    ff_synthesis synthesis;   /* likewise */
    /* 0 to 0.15: bodies are up to so much larger or smaller than the pack's, drawn from the seed; default 0.
     * Where anybody may move by footsteps, all are the pack's size: captured steps do not stretch */
    double body_scale;
    ff_mcn_def mcn;
    ff_baseline_def baseline;
    const ff_behaviour_def *behaviour; /* copied at creation; NULL: none */
    ff_planner planner;                /* of agents that do not name their own */
    ff_footsteps_def footsteps;
    uint32_t max_obstacles; /* default 64 */
    ff_waypoint *waypoint;  /* or NULL; for those who move by footsteps */
    void *waypoint_context;
    uint32_t cookie; /* set by ff_crowd_def_default(); leave it alone */
} ff_crowd_def;

typedef struct ff_agent_def {
    ff_vec2 position;       /* m, plane coordinates */
    double heading;         /* rad */
    ff_vec2 goal;           /* m; the agent stops and stands within goal_tolerance of it */
    double goal_tolerance;  /* m, default 0.5 */
    double preferred_speed; /* m/s, 0.1 to 4, default 1.3; above 2.2 it runs */
    double radius;          /* m, default 0.3 */
    ff_navigation navigation;
    ff_synthesis synthesis;
    uint32_t machine; /* of the crowd's behaviour, which chooses goals; default FF_NONE: the caller does */
    ff_planner planner;
    uint32_t cookie; /* set by ff_agent_def_default() */
} ff_agent_def;

ff_crowd_def ff_crowd_def_default(void);
ff_agent_def ff_agent_def_default(void);

/* The pack must outlive the crowd. */
ff_status ff_crowd_create(const ff_pack *pack, const ff_crowd_def *def, ff_crowd **out, ff_error *error);
void ff_crowd_destroy(ff_crowd *crowd); /* NULL is fine */

ff_status ff_crowd_add_agent(ff_crowd *crowd, const ff_agent_def *def, ff_agent *out, ff_error *error);
ff_status ff_crowd_remove_agent(ff_crowd *crowd, ff_agent agent, ff_error *error);
/* Of an agent with a machine the goal holds until its next state, the speed for good: states have factors on it. */
ff_status ff_crowd_set_goal(ff_crowd *crowd, ff_agent agent, ff_vec2 goal, ff_error *error);
ff_status ff_crowd_set_preferred_speed(ff_crowd *crowd, ff_agent agent, double speed, ff_error *error);
/* Where to look while it stands: FF_FACE_FREE, _POINT or _HEADING; at: the point, or a direction of any length. */
ff_status ff_crowd_set_facing(ff_crowd *crowd, ff_agent agent, ff_face face, ff_vec2 at, ff_error *error);

/* Make a signal show a phase (counted from 0) until it is told otherwise; FF_NONE: go by the clock again. */
ff_status ff_crowd_set_signal(ff_crowd *crowd, uint32_t signal, uint32_t phase, ff_error *error);

/* From now on the agent moves in this way; it changes over with the next foot that lands, or at once where it stands. To footsteps:
 * when a plan is found that is free of everybody's. FF_ERR_UNSUPPORTED where the crowd has no memory for footsteps. */
ff_status ff_crowd_set_planner(ff_crowd *crowd, ff_agent agent, ff_planner planner, ff_error *error);

/* Points on the way to the goal, in order, at most FF_WAYPOINTS_MAX (copied). Those are left out behind which a later one is seen.
 * For those who move by footsteps. */
enum { FF_WAYPOINTS_MAX = 8 };
ff_status ff_crowd_set_waypoints(ff_crowd *crowd, ff_agent agent, const ff_vec2 *points, uint32_t count,
                                 ff_error *error);

/* Things in the way. Who moves by footsteps sees them all; who moves by velocity avoids them all, whatever their height. */
typedef enum ff_obstacle_kind {
    FF_OBSTACLE_STATIC, /* fixed once the first step was taken */
    FF_OBSTACLE_PATH,   /* moves on a path that everybody knows */
    FF_OBSTACLE_FREE,   /* moved by the caller, who is not to be foreseen */
} ff_obstacle_kind;

typedef struct ff_obstacle_point {
    double time; /* s from the path's start, rising */
    ff_vec2 at;  /* m */
} ff_obstacle_point;

/* A box, capsule or disc with vertical sides, or rounded all over: a sphere, a lying capsule. */
enum { FF_OBSTACLE_POINTS_MAX = 8 };
typedef struct ff_obstacle_def {
    ff_obstacle_kind kind;
    ff_vec2 position;               /* m; added to the points of a path */
    double heading;                 /* rad, of the length */
    double half_length, half_width; /* m; a disc has neither, a capsule no width */
    double radius;                  /* m, on top of both; default 0.1 */
    double low, high;               /* m over the ground, radius of rounded ones included; default 0 to 2 */
    bool round;                     /* above and below, too */
    ff_obstacle_point path[FF_OBSTACLE_POINTS_MAX]; /* straight and even in between; waits at the last one */
    uint32_t path_count;
    bool cyclic;     /* the path begins again instead */
    double start;    /* s, when it begins */
    uint32_t cookie; /* set by ff_obstacle_def_default() */
} ff_obstacle_def;
ff_obstacle_def ff_obstacle_def_default(void);

/* Adds one; *out numbers it from 0 on. */
ff_status ff_crowd_add_obstacle(ff_crowd *crowd, const ff_obstacle_def *def, uint32_t *out, ff_error *error);
/* Put one of kind FREE somewhere else. Its velocity is taken to be what it moves between two steps. */
ff_status ff_crowd_move_obstacle(ff_crowd *crowd, uint32_t obstacle, ff_vec2 position, double heading,
                                 ff_error *error);
/* Where it is now, and how it is turned. */
ff_status ff_crowd_obstacle_place(const ff_crowd *crowd, uint32_t obstacle, ff_vec2 *position,
                                  double *heading, ff_error *error);

/* A static wall from p to q, solid from both sides. Walls are fixed once the first step was taken. */
ff_status ff_crowd_add_wall(ff_crowd *crowd, ff_vec2 p, ff_vec2 q, ff_error *error);

/* Advance by one fixed step. Does not allocate. */
void ff_crowd_step(ff_crowd *crowd);

/* FF_OK, or what a step could not do: an agent's machine that went through more than eight states at one moment. The crowd
 * goes on; the agent stays in the state it had come to. */
ff_status ff_crowd_fault(const ff_crowd *crowd, ff_error *error);

/* As it was created, or saved; its behaviour is the crowd's own copy. */
ff_crowd_def ff_crowd_definition(const ff_crowd *crowd);
uint32_t ff_crowd_agent_count(const ff_crowd *crowd);
uint64_t ff_crowd_step_count(const ff_crowd *crowd);

/* FNV-1a over the bits of the whole state: equal on any number of threads. */
uint64_t ff_crowd_state_hash(const ff_crowd *crowd);

/* A crowd written down whole, but for the pack: saved, loaded and continued it does to the bit what it would have done. The
 * size, then so many bytes at data; save_file writes all or nothing. Ask between steps, not from another thread. */
size_t ff_crowd_save_size(const ff_crowd *crowd);
ff_status ff_crowd_save(const ff_crowd *crowd, void *data, size_t size, ff_error *error);
ff_status ff_crowd_save_file(const ff_crowd *crowd, const char *path, ff_error *error);

/* A crowd from what was saved, on the pack it was saved with, which must outlive it; handles of agents stay what they were.
 * Of run only threads, tasks and task_pool are taken, all else is as saved; NULL: one thread. Everything is checked:
 * whatever is damaged or of another version is refused, with section and byte. */
ff_status ff_crowd_load(const ff_pack *pack, const void *data, size_t size, const ff_crowd_def *run,
                        ff_crowd **out, ff_error *error);
ff_status ff_crowd_load_file(const ff_pack *pack, const char *path, const ff_crowd_def *run, ff_crowd **out,
                             ff_error *error);

enum { FF_WAY_BLENDING, FF_WAY_SEMI_PROCEDURAL, FF_WAY_RUNNING };

typedef struct ff_agent_state {
    ff_vec2 position;   /* m, root and disc */
    ff_vec2 velocity;   /* m/s, of the root over the last step */
    double heading;     /* rad, where the body faces */
    double turn_rate;   /* rad/s */
    ff_vec2 command;    /* m/s, what navigation asked for */
    ff_vec2 goal;       /* m */
    double radius;      /* m */
    double scale;       /* of its body: joints are so many times as far from their parents as in the pack */
    uint8_t reached;    /* 1: stands at its goal */
    uint8_t planted[2]; /* left, right: the foot is locked to the ground */
    uint8_t way;        /* FF_WAY_*: what it moves by now */
    uint32_t number;    /* how many were added before: unlike slots, numbers are never used again */
    uint8_t planner;    /* ff_planner, as it moves now */
    uint8_t reserved[3];
} ff_agent_state;

/* State of a live agent. Fails with FF_ERR_ARGUMENT for a stale handle. */
ff_status ff_crowd_agent_state(const ff_crowd *crowd, ff_agent agent, ff_agent_state *out, ff_error *error);

/* By which ways an agent (or, agent {0, 0}, all that live) has moved since it came: seconds in each, how often it has
 * changed, and how often because it had to. */
typedef struct ff_synthesis_counts {
    double blending_s, semi_procedural_s, running_s;
    uint64_t transitions, urgent;
} ff_synthesis_counts;
ff_status ff_crowd_synthesis_counts(const ff_crowd *crowd, ff_agent agent, ff_synthesis_counts *out,
                                    ff_error *error);

/* What an agent's machine is at: indices into the crowd's behaviour, or FF_NONE. */
typedef struct ff_agent_behaviour {
    uint32_t machine, state, goal;
    uint32_t spawner; /* that put it in */
    double seconds;   /* in this state */
} ff_agent_behaviour;
ff_status ff_crowd_agent_behaviour(const ff_crowd *crowd, ff_agent agent, ff_agent_behaviour *out,
                                   ff_error *error);
uint32_t ff_crowd_goal_taken(const ff_crowd *crowd, uint32_t goal); /* by how many now */
/* That it shows; FF_NONE: there is no such signal. */
uint32_t ff_crowd_signal_phase(const ff_crowd *crowd, uint32_t signal);

/* How many were ever added (by the caller or by spawners), how many of those by spawners, and how many left by an exit. */
typedef struct ff_crowd_counts {
    uint64_t added, spawned, left;
} ff_crowd_counts;
ff_crowd_counts ff_crowd_count(const ff_crowd *crowd);
/* A footprint of an agent's plan. */
typedef struct ff_planned_print {
    ff_vec2 ball;  /* m */
    double yaw;    /* rad, of the foot */
    double time;   /* s: the foot stands there from then on, until its next print */
    uint32_t foot; /* 0 left, 1 right */
    /* the action that puts it there (footfall-pack inspect lists them); UINT32_MAX: it stands there already */
    uint32_t action;
} ff_planned_print;

/* The plan an agent has made known, for drawing and debugging: first where its feet stand (or stood), then its steps. Writes at most
 * capacity prints, *count is how many there are. None for those who move by velocity. */
ff_status ff_crowd_agent_plan(const ff_crowd *crowd, ff_agent agent, ff_planned_print *out, uint32_t capacity,
                              uint32_t *count, ff_error *error);

/* Why plans are made (Beacco et al. 2013, 3.1), and what became of it, since the agent began to move by footsteps. */
typedef enum ff_plan_event {
    FF_EVENT_GOAL,     /* the goal, or the waypoint before it, has changed */
    FF_EVENT_NEARBY,   /* somebody's new plan, or an obstacle on a path, is in the way of the agent's own */
    FF_EVENT_SURPRISE, /* what nobody foresees is in the way: a moved obstacle, one who moves by velocity */
    FF_EVENT_EXPIRY,   /* the plan is old, or nearly done */
    FF_EVENT_DANGER,   /* something that moves hits within about a second: the plan may jump and duck */
    FF_EVENT_PLAN_COUNT
} ff_plan_event;
typedef struct ff_plan_counts {
    uint32_t events[FF_EVENT_PLAN_COUNT];
    uint32_t searches, plans;     /* plans tried for, and made known */
    uint32_t failed, conflicting; /* no plan found; found, but another's came first */
    uint32_t reactions;           /* actions broken off */
    uint32_t dodges;              /* jumps and ducks begun */
    uint32_t nodes;               /* expanded */
    double without_plan; /* s: the plan was at its end and not a stand, or in conflict with another's */
} ff_plan_counts;
ff_status ff_crowd_agent_plan_counts(const ff_crowd *crowd, ff_agent agent, ff_plan_counts *out,
                                     ff_error *error);

/* Handles of all live agents in slot order. Writes at most capacity, returns how many there are. */
uint32_t ff_crowd_agents(const ff_crowd *crowd, ff_agent *out, uint32_t capacity);

/* Pose of one agent now: rotations[joint_count], local to the parent; *hips = world position of joint 0, whose
 * rotation is in world space. Allocates nothing; may be called from several threads for different agents. */
ff_status ff_crowd_agent_pose(const ff_crowd *crowd, ff_agent agent, ff_vec3 *hips, ff_quat *rotations,
                              ff_error *error);

/* Matrices of an agent's joints now: out[joint_count], from the joints' frames to a world whose origin is the given point of
 * the ground (near the camera: floats tell 0.1 mm up to a kilometre from it). Multiplied with the inverse of the rest pose
 * (a translation: rest rotations are the identity) they skin a mesh. Computed in floats, within 0.1 mm of
 * ff_crowd_agent_pose; no part of the state. Allocates nothing; may be called from several threads. */
ff_status ff_crowd_agent_matrices(const ff_crowd *crowd, ff_agent agent, ff_vec2 origin, ff_matrix *out,
                                  ff_error *error);

/* The same of all live agents at once, on the crowd's threads: out[agents][joint_count], agents in slot order, as
 * ff_crowd_agents lists them; room for capacity agents. FF_ERR_RANGE, and nothing written, when there are more. Not while
 * another thread calls this or ff_crowd_step on the same crowd. */
ff_status ff_crowd_matrices(ff_crowd *crowd, ff_vec2 origin, ff_matrix *out, uint32_t capacity,
                            ff_error *error);

/* Seconds spent per phase since creation, summed over steps: processor time of the calling thread where a crowd has no
 * other, else wall clock. For reports only, never part of the state. */
typedef struct ff_crowd_timings {
    double behaviour;  /* state machines and spawners */
    double snapshot;   /* what everybody shows the others, and who is where */
    double neighbours; /* who is near whom */
    double navigation; /* which velocity to ask for */
    double planning;   /* footsteps: events, plans */
    double bodies;     /* what bodies make of it: the root moves */
    double synthesis;  /* steps, weights and foot locks */
    double total;      /* of ff_crowd_step: the sum of these */
    double matrices;   /* of ff_crowd_matrices; not in total */
} ff_crowd_timings;
ff_crowd_timings ff_crowd_time_spent(const ff_crowd *crowd);

/* Seconds of its thread's processor that a plan of footsteps takes at most, of a share of all since creation (0.5: the median),
 * searches in vain among them; to 5 %. 0: there were none. For reports only, never part of the state. */
double ff_crowd_plan_seconds(const ff_crowd *crowd, double share);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif
#endif
