/* watch.h - everything that is measured while a crowd runs, and metrics.json at the end. */
#ifndef FF_WATCH_H
#define FF_WATCH_H

#include "runtime/export/body_contacts.h"
#include "runtime/export/metrics.h"
#include "runtime/export/scene.h"
#include "runtime/export/skate.h"

typedef struct ff_watch {
    const ff_scene *scene; /* borrowed */
    double *radii;
    ff_collisions collisions;
    ff_contacts contacts;
    ff_skate skate;
    ff_quat *last; /* [agent][joint] rotations of the last step */
    uint32_t joint_count;
    double least_dot;      /* of the rotations of any joint in two steps running */
    double rest_height[2]; /* m, of the balls of the feet */
} ff_watch;

/* What only the program knows. */
typedef struct ff_run_facts {
    const char *scene_path, *pack_path;
    uint32_t threads;
    uint64_t seed, state_hash;
    ff_crowd_counts counts;
    ff_crowd_timings timings;
    ff_synthesis_counts synthesis;
} ff_run_facts;

ff_status ff_watch_create(const ff_scene *scene, const ff_figure *figure, ff_watch *out, ff_error *error);
void ff_watch_free(ff_watch *watch);

/* After a step of the recording was filled in. */
void ff_watch_step(ff_watch *watch, const ff_recording *recording);

/* An agent's pose of that step, before it is rounded for keeping. */
ff_status ff_watch_pose(ff_watch *watch, const ff_figure *figure, uint32_t agent, const ff_agent_state *state,
                        ff_vec3 hips, const ff_quat *rotations, ff_error *error);

/* All figures as JSON; the caller owns the value. NULL when memory is short. Call once, at the end. */
json_t *ff_watch_report(ff_watch *watch, const ff_recording *recording, const ff_run_facts *facts);

/* "17 agents, 17 reached their goals in 9.2 s", or what there is to say of people who do other things. */
void ff_watch_caption(const ff_scene *scene, const ff_recording *recording, char *text, size_t size);

/* Agents that are at their goals, or were when they left. */
uint32_t ff_watch_reached(const ff_recording *recording);

#endif
