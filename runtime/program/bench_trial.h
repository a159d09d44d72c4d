/* bench_trial.h - one scene, one method, one seed, measured; and many of them, over seeds. */
#ifndef FF_BENCH_TRIAL_H
#define FF_BENCH_TRIAL_H

#include "runtime/export/measures.h"
#include "runtime/program/simulate.h"

#include <stdbool.h>

/* A way of navigating that is compared with others. */
typedef struct ff_contender {
    const char *key, *label; /* in JSON, in tables */
    ff_navigation method;
    bool aided; /* a baseline with MCN's side preference, padding and knowledge of others' velocities */
} ff_contender;

ff_scene_navigation ff_contender_navigation(const ff_contender *contender);

typedef struct ff_trial {
    ff_scene_def def; /* without walls and agents of its own */
    ff_measures measures;
    double navigation_ms, total_us; /* 2-D navigation per step; everything per agent and step */
    ff_status status;
    ff_error error;
} ff_trial;

/* What holds for all. */
typedef struct ff_trial_set {
    const ff_pack *pack;
    const ff_figure *figure;
    uint32_t threads; /* trials at once */
    bool quiet;
} ff_trial_set;

/* Run them all; fails with the first one's error that failed. */
ff_status ff_trials_run(const ff_trial_set *set, ff_trial *trials, uint32_t count, ff_error *error);

/* Run one and keep its recording (free both): for pictures. */
ff_status ff_trial_record(const ff_trial_set *set, const ff_scene_def *def, ff_scene *scene,
                          ff_simulation *simulation, ff_error *error);

/* Over the seeds of one scene and method. */
typedef struct ff_trial_mean {
    uint32_t agents, arrived;                               /* of all seeds together */
    double collision_rate, raw, filtered, route, route_all; /* means */
    double mean_arrival, last_arrival, last_worst;          /* s: means, and the worst seed's last */
    double deepest, body_deepest;                           /* m, of all seeds */
    double pairs, body_pairs;                               /* means */
    double slide_median, slide_p95;                         /* m, means */
    double joint_speed;                                     /* rad/s, of all seeds */
    double navigation_ms, total_us;                         /* means */
} ff_trial_mean;

ff_trial_mean ff_trials_mean(const ff_trial *trials, uint32_t count);

#endif
