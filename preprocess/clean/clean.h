/* clean.h - feet that stand still: a retargeted motion changed as little as possible so that planted heels and balls
 * do not move, knees never bend backwards, nothing sinks into the floor, and all stays smooth.
 *
 * One least-squares problem per second of motion over the hips and both legs (cleanup study, section 3), solved with
 * Ceres, then leg by leg and frame by frame what is left of the error in closed form. */
#ifndef FF_CLEAN_H
#define FF_CLEAN_H

#include "preprocess/motion/motion.h"

/* Something measured before and after. */
typedef struct ff_change {
    double before, after;
} ff_change;

typedef struct ff_clean_report {
    bool was_clean;            /* feet stood still already: nothing was changed */
    ff_change pin_median;      /* m, ball of a flat foot from its pin (mean place), over all such frames */
    ff_change pin_worst;       /* m */
    ff_change skate;           /* m/s, mean ground speed of the ball of a flat foot */
    ff_change floor_dip;       /* m, deepest that heel, ball or toe tip gets under its height when planted */
    ff_change knee_least;      /* rad, smallest flexion */
    double turn_mean;          /* rad, by which hips, hip joints, knees and ankles were turned */
    double turn_most_95;       /* rad, 95 % of them are below */
    double turn_most;          /* rad */
    int turn_role, turn_frame; /* where the largest is */
    double shift_mean, shift_most; /* m, of the hips */
    double acceleration;           /* RMS acceleration of knees and ankles, after over before */
    double residual; /* m, RMS distance of pinned points from their pins before the closing frame by frame */
    int solves, unconverged, iterations;
} ff_clean_report;

/* Clean a motion that ff_motion_from_clip made with the same plants. Fails with FF_ERR_RANGE, saying why, when the clip
 * cannot be brought over cleanly; the motion is then useless. */
ff_status ff_motion_clean(const ff_rig *rig, const ff_clean_settings *settings, ff_motion *motion,
                          const ff_plants *plants, ff_clean_report *report, ff_error *error);

/* Measure a motion against the one it was made from (the same one: only the feet are judged). */
ff_status ff_clean_measure(const ff_rig *rig, const ff_clean_settings *settings, const ff_motion *before,
                           const ff_motion *after, const ff_plants *plants, ff_clean_report *report,
                           ff_error *error);

#endif
