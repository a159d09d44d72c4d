/* crowd_footsteps.h - those of a crowd who move by footsteps: what each of them remembers, what they share, and the phases of a
 * step that serve them (Beacco et al. 2013; algorithms B.7 to B.9; footstep study, section 4).
 *
 * Everybody's plan is public, ends in a stand and is free of everybody else's, for ever: a new one is only put in force when it
 * still is. So nobody is ever without a valid plan, and it does not matter who plans when, or on which thread: plans are
 * searched for in parallel against those in force when the step begins, and put in force one after the other, in the order of
 * slots, each checked against those just before it.
 *
 *   crowd_footsteps.c  memory, beginning, playing, questions
 *   crowd_events.c     who needs a new plan, and why
 *   crowd_plan.c       whose turn it is, searching, putting in force
 *   crowd_walkers.c    how they see those who go by velocity
 *   crowd_glides.c     how both keep a way to stop that is free of the others'
 *   crowd_react.c      breaking off a step
 *   crowd_change.c     from velocity to footsteps and back
 *   crowd_obstacles.c  things in the way
 */
#ifndef FF_CROWD_FOOTSTEPS_H
#define FF_CROWD_FOOTSTEPS_H

#include "runtime/core/base/memory.h"
#include "runtime/core/crowd/crowd_plan_times.h"
#include "runtime/core/nav/nav_grid.h"
#include "runtime/core/plan/plan.h"
#include "runtime/core/play/play.h"

#include <stdatomic.h>

/* Plain data, no padding: hashed as bytes. */
typedef struct ff_stepper {
    ff_plan plan;   /* in force */
    ff_track track; /* of it */
    ff_play play;
    ff_vec2 target; /* m, what the plan was made for */
    ff_vec2 waypoint[FF_WAYPOINTS_MAX];
    double created;   /* s: when it was put in force */
    double retry;     /* s: before that nothing is searched for */
    double asked;     /* s: since when a new plan is wanted */
    double surprised; /* s: when what is in the way was noticed */
    ff_vec2 goes;     /* m/s, of one who goes by velocity: the command of its glide, ... */
    double brakes;    /* s: ... and for how long it is kept */
    uint32_t waypoint_count, waypoint_next;
    uint32_t pending;       /* bit n: event n has called for a plan */
    uint32_t at;            /* step of the plan that is played */
    uint32_t consumed;      /* actions of it begun since it was made */
    uint32_t moves, wanted; /* FF_PLANNER_*: how it moves, and how it is to move */
    uint32_t landed;        /* 1: in the last step a foot came down, or both stand */
    uint32_t changed;       /* 1: the plan was put in force in the last step */
    uint32_t evasions;      /* FF_EVADE_*: what gets it past what is about to hit it */
    ff_plan_counts counts;
} ff_stepper;

/* Where a track is at all times: nowhere for those who move by velocity. Kept apart from all else, as everybody's is looked
 * at whenever somebody plans. */
typedef struct ff_bounds {
    ff_vec2 low, high; /* m */
} ff_bounds;

/* A search of this step. */
typedef struct ff_plan_job {
    ff_plan plan;
    ff_track track;
    ff_bounds bounds;
    ff_vec2 target;
    ff_plan_counts counts; /* what the search adds */
    uint32_t slot;
    uint32_t good; /* 1: found, and free of all plans in force */
    uint32_t kind; /* FF_JOB_* */
    uint32_t urgency;
    uint32_t tests;  /* collision tests of the search */
    uint32_t forced; /* 1: what is really there lets it come into force, whatever plans it crosses */
    double asked;
    double seconds; /* of the processor */
} ff_plan_job;
enum { FF_JOB_PLAN, FF_JOB_ENTER, FF_JOB_REACT };

/* An obstacle: the public definition, and where it is now. */
typedef struct ff_crowd_obstacle {
    ff_shape shape;           /* now */
    ff_vec2 home;             /* m, to which a path is added */
    ff_vec2 velocity, before; /* m/s; where it was at the last step */
    ff_path_point path[FF_OBSTACLE_POINTS_MAX];
    double start;
    uint32_t kind, path_count, cyclic;
    uint32_t first_wall, wall_count; /* that velocity navigation sees */
    uint32_t unused;
} ff_crowd_obstacle;

enum { FF_PLAN_LANES = 8 }; /* searches that may run at once */

typedef struct ff_plan_lane {
    ff_plan_scratch *scratch;
    const ff_track **tracks;   /* [max_agents] */
    ff_walker *walkers;        /* [max_agents] */
    ff_shape *shapes;          /* [max_obstacles * 2] */
    ff_mover *movers;          /* [max_obstacles] */
    ff_path_point (*paths)[2]; /* [max_obstacles] */
} ff_plan_lane;

/* Where one who goes by velocity gets, if it goes on for a while as was decided in this step and then stops: FF_TRACK_STEP apart, from
 * now on, relative to the first. */
enum { FF_GLIDE_POINTS = 46 };
typedef struct ff_glide {
    ff_vec2 origin; /* m */
    float a[FF_GLIDE_POINTS], b[FF_GLIDE_POINTS];
} ff_glide;

/* What all of them share. */
typedef struct ff_footsteps {
    ff_action_set *actions;
    ff_play_set *play;
    ff_solids *solids; /* walls and static obstacles */
    ff_plan_options options;
    ff_plan_lane lane[FF_PLAN_LANES];
    ff_plan_job *jobs; /* [job_max] */
    uint32_t job_max, job_count;
    uint64_t test_max;    /* of a step: no more searches are begun then */
    uint32_t *order;      /* [job_max] of slots */
    ff_bounds *bounds;    /* [max_agents], by slot */
    ff_path *paths;       /* [max_agents], by slot: of this step, of those who move by footsteps */
    ff_glide *glides;     /* [max_agents], by slot: of this step, of those who go by velocity */
    atomic_uint next_job; /* of this step; up to job_end */
    uint32_t job_end, spare;
    /* slots whose plans came into force in the last step, or that began with footsteps since */
    uint32_t *changed;
    uint32_t changed_count;
    uint32_t lane_count;
    ff_mover *movers; /* [max_obstacles] */
    uint32_t mover_count, unused;
    ff_plan_times times; /* of all searches, with what they see and the checks of what they find */
} ff_footsteps;

struct ff_crowd;

/* Does a crowd have memory for footsteps? */
bool ff_footsteps_wanted(const ff_crowd_def *def);
ff_status ff_footsteps_create(struct ff_crowd *crowd, ff_error *error);
void ff_footsteps_destroy(ff_footsteps *footsteps); /* NULL is fine */

/* Is the agent one who moves by footsteps now? */
bool ff_is_stepper(const struct ff_crowd *crowd, uint32_t slot);

/* Stand at the body's place from now on, idle_time into the idle motion, and plan from there. */
void ff_stepper_begin(struct ff_crowd *crowd, uint32_t slot, double idle_time);

/* No plan, no waypoints, nothing remembered: moves by velocity, or (FF_PLANNER_CROWD) is no more. */
void ff_stepper_forget(struct ff_crowd *crowd, uint32_t slot, ff_planner moves);

/* Whom the others look at, after loading. */
void ff_footsteps_restore(struct ff_crowd *crowd);

/* The others look at its plan anew in the next step. */
void ff_stepper_tell(struct ff_crowd *crowd, uint32_t slot);

/* The phases. Times are absolute: the step goes from steps * step on. */
double ff_crowd_time(const struct ff_crowd *crowd);
void ff_footsteps_watch(struct ff_crowd *crowd,
                        uint32_t index);                       /* one agent's events; index into grid.seen */
double ff_footsteps_plan(struct ff_crowd *crowd);              /* everybody's plans; when it was done */
void ff_footsteps_play(struct ff_crowd *crowd, uint32_t slot); /* one agent, to the end of the step */

/* How one who goes by velocity sees one who does not: paths of this step, and the velocity over what comes next. */
ff_vec2 ff_stepper_shows(const struct ff_crowd *crowd, uint32_t slot);

/* What ff_crowd_agent_state tells of one. */
void ff_stepper_state(const struct ff_crowd *crowd, uint32_t slot, ff_agent_state *out);

/* A plan comes into force at a time. */
void ff_stepper_adopt(struct ff_crowd *crowd, uint32_t slot, const ff_plan_job *job, double time);

/* Where the agent is making for now. */
ff_vec2 ff_stepper_target(const struct ff_crowd *crowd, uint32_t slot);
/* It stands within the tolerance of its goal. */
bool ff_stepper_arrived(const struct ff_crowd *crowd, uint32_t slot);
/* How far it has to turn to what it shall look at, from where it stands, rad; 0 when there is nothing, or it goes somewhere. *heading:
 * where it shall face. */
double ff_stepper_turns(const struct ff_crowd *crowd, uint32_t slot, double *heading);
ff_play_order ff_order_of(const ff_footsteps *footsteps, const ff_plan_step *step);

/* A job's plan is free of the one that an agent has in force. */
bool ff_job_free(const struct ff_crowd *crowd, const ff_plan_job *job, uint32_t slot, double time);

/* crowd_watch.c: does a track, from a time on for some seconds, meet a shape that moves at a velocity? *when: s, absolute. */
bool ff_track_meets(const ff_track *track, double from, double seconds, const ff_shape *shape,
                    ff_vec2 velocity, double margin, double *when);

ff_bounds ff_track_bounds(const ff_track *track);
static inline bool ff_bounds_meet(const ff_bounds *p, const ff_bounds *q)
{
    return p->low.a <= q->high.a && q->low.a <= p->high.a && p->low.b <= q->high.b && q->low.b <= p->high.b;
}
#define FF_BOUNDS_NONE ((ff_bounds){{INFINITY, INFINITY}, {-INFINITY, -INFINITY}})

/* crowd_walkers.c. Somebody who goes by velocity, as the agent sees it. */
ff_walker ff_walker_of(const struct ff_crowd *crowd, uint32_t slot, const ff_seen *other, double time);
/* The nearest of those who can be met. */
void ff_walkers_see(const struct ff_crowd *crowd, uint32_t slot, ff_plan_lane *lane, ff_plan_world *world);
/* They go where they say: without more room as time goes on. */
void ff_walkers_believe(ff_plan_lane *lane, const ff_plan_world *world);
#define FF_WALKER_IMMINENT 0.5 /* s: who goes by velocity cannot make way in less */

/* crowd_glides.c. After navigation has decided for one who goes by velocity: its command is changed to one from which it can stop
 * without meeting a plan, and its glide is published. */
void ff_glide_choose(struct ff_crowd *crowd, uint32_t index);
/* From a place at a velocity: towards a command for `hold` seconds, then to a stand. */
void ff_glide_roll(ff_vec2 position, ff_vec2 velocity, ff_vec2 command, double hold, ff_glide *out);
/* m, by which a glide comes nearer to a track than it shall; <= 0: it does not. *when (may be NULL): s from now. */
double ff_glide_meets(const ff_glide *glide, const ff_track *track, double time, double seconds,
                      double *when);

/* s from now until the agent's track, which stays within bounds, meets the first of all glides; INFINITY: none, in so many seconds. */
double ff_glides_met(const struct ff_crowd *crowd, uint32_t slot, const ff_track *track,
                     const ff_bounds *bounds, double time, double seconds);
/* Is a job's plan free of all glides, for ever, or no worse than the one in force? */
bool ff_glides_allow(const struct ff_crowd *crowd, const ff_plan_job *job, double time);

/* crowd_react.c: break off the step that is being done for one that is free of what is in the way. False: none is. */
bool ff_stepper_react(const struct ff_crowd *crowd, uint32_t slot, const ff_plan_world *world, double time,
                      ff_plan_job *job);

/* crowd_change.c: agents whose wanted planner is another than how they move. */
void ff_footsteps_change(struct ff_crowd *crowd);
/* This is a moment at which the agent could begin with footsteps: *current ends with the pose it is in. */
bool ff_stepper_enters(const struct ff_crowd *crowd, uint32_t slot, double time, ff_plan *current);
void ff_stepper_enter(struct ff_crowd *crowd, uint32_t slot, const ff_plan_job *job, double time);

/* crowd_obstacles.c. Add one as it was saved; NULL, or what is wrong with it. */
const char *ff_obstacle_restore(struct ff_crowd *crowd, const ff_crowd_obstacle *obstacle);
/* One that the caller moves, and that can be jumped or ducked. */
bool ff_obstacle_is_evaded(const ff_crowd_obstacle *obstacle);
void ff_obstacles_step(struct ff_crowd *crowd); /* velocities and places for this step */

#endif
