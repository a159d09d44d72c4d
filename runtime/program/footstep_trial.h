/* footstep_trial.h - one crowd on footsteps, measured: how long its steps take, and how its bodies get past each other. */
#ifndef FF_FOOTSTEP_TRIAL_H
#define FF_FOOTSTEP_TRIAL_H

#include "runtime/export/figure.h"
#include "runtime/export/plan_picture.h"
#include "runtime/program/pair_contacts.h"

typedef enum ff_walk_scene {
    FF_WALK_CROSSING, /* random places on a square, random goals, a new one when that is reached */
    FF_WALK_CIRCLE,   /* to the opposite side of a circle of radius max(4, 0.16 N) m */
    FF_WALK_FOUR,     /* four whose ways cross in the middle, a little off (Figures 1 and 10) */
    FF_WALK_STREAMS,  /* two blocks, six abreast, that walk through each other */
} ff_walk_scene;

/* Who goes by velocity in a crowd on footsteps. */
typedef enum ff_walk_mix {
    FF_MIX_NONE,
    FF_MIX_HALF,  /* half of them, drawn */
    FF_MIX_SIDES, /* one of two streams */
} ff_walk_mix;

typedef struct ff_walk_trial {
    ff_walk_scene scene;
    uint32_t agents, threads;
    double density; /* per m2, of a crossing */
    double seconds, step;
    uint64_t seed;
    ff_planner planner;
    ff_footsteps_def footsteps;
    ff_walk_mix mix;
    bool bodies; /* look at whole bodies as well, of capsules about the bones: slower */
    /* or NULL: shots pictures, evenly in time, of at most shot_count moments */
    ff_plan_scene *shots;
    uint32_t shot_count;
} ff_walk_trial;

typedef struct ff_walk_times {
    double mean, p99, most; /* ms */
} ff_walk_times;

typedef struct ff_walk_measures {
    double agent_seconds;
    ff_walk_times frame_ms; /* of a step with the poses of everybody, by the clock on the wall */
    /* the same in time of the processor, all threads together: other programs do not count */
    ff_walk_times work_ms;
    double plan_ms_mean;                /* per step */
    double plan_ms_median, plan_ms_p99; /* of a plan, of the processor */
    double overlap; /* pair-seconds of contact of the five cylinders per 100 agent-seconds */
    double deepest; /* m */
    double body_overlap, body_deepest;     /* the same of whole bodies, if they were looked at */
    ff_pair_contacts pairs[FF_PAIR_KINDS]; /* the same by who meets whom */
    double speed_to_goal;                  /* m/s, mean over those who are not there yet */
    double speed_by[2]; /* m/s, the same of those who go by velocity, and on footsteps; 0: there are none */
    double no_plan;     /* s, of all agents: without a valid plan */
    double last_arrival, mean_arrival; /* s; of those who arrived */
    uint32_t arrived;
    ff_plan_counts counts; /* of all */
} ff_walk_measures;

ff_status ff_walk_trial_run(const ff_pack *pack, const ff_figure *figure, const ff_walk_trial *trial,
                            ff_walk_measures *out, ff_error *error);

enum { FF_WALK_SHOTS = 3 };
/* The trial's first seconds as a picture of three moments from above, with plans and prints, under one title; when: what is said
 * under each, or NULL. */
ff_status ff_walk_trial_draw(const ff_pack *pack, const ff_figure *figure, ff_walk_trial trial,
                             const char *title, const char *const when[FF_WALK_SHOTS], const char *path,
                             ff_error *error);

#endif
