/* simulate.h - step a crowd through a scene and keep what it does. */
#ifndef FF_SIMULATE_H
#define FF_SIMULATE_H

#include "runtime/export/recording.h"
#include "runtime/export/watch.h"

typedef struct ff_simulation {
    const ff_pack *pack; /* borrowed, like scene and figure */
    ff_scene *scene;     /* whoever spawners put in is added to it */
    const ff_figure *figure;
    uint32_t threads;
    bool quiet;
    bool tracks_only;   /* do not keep poses; they are measured all the same */
    bool leave_walking; /* who leaves does so as soon as the goal is near enough, without standing first */
    const char *load;   /* file of a saved crowd to go on from; NULL: begin as the scene says */
    const char *save;   /* file to save the crowd to, or NULL */
    double save_at;     /* s, of the scene's time; or when the run ends before */
    /* Made by ff_simulate: */
    ff_recording recording;
    ff_watch watch;
    uint64_t state_hash;
    ff_crowd_counts counts;
    ff_crowd_timings timings;
    ff_synthesis_counts synthesis; /* of everybody, those who left too */
} ff_simulation;

/* Run until everyone has stood at their goal for a second, or the scene's time is over. */
ff_status ff_simulate(ff_simulation *simulation, ff_error *error);
void ff_simulation_free(ff_simulation *simulation);

#endif
