/* gait_figures.h - how a clip is walked, in numbers: steps, cadence, speed, step length, turn. */
#ifndef FF_GAIT_FIGURES_H
#define FF_GAIT_FIGURES_H

#include "preprocess/plants/plants.h"

typedef struct ff_gait_figures {
    double seconds;
    int contacts;          /* all plants */
    int initial_contacts;  /* ... whose beginning the clip shows */
    int steps;             /* single steps: initial contacts less one, at least 0 */
    int first_ic, last_ic; /* frames, -1: none */
    double cadence;        /* steps per minute; 0 with fewer than two initial contacts */
    double stride_time;    /* s, between contacts of the same foot; 0: none */
    double speed_net;      /* m/s, of the hips: straight from first to last place */
    double speed_path;     /* m/s, along their way on the ground */
    double step_length, step_length_sd,
        step_width; /* m, ball to ball of the other foot, along and across the way */
    double turn;    /* rad, pelvis at the last frame less at the first, low-passed at 3 Hz; left positive */
} ff_gait_figures;

/* Measured as the step figures of the labels are (labels README). */
ff_status ff_gait_figures_find(const ff_clip *clip, const ff_plants *plants, ff_gait_figures *out,
                               ff_error *error);

#endif
