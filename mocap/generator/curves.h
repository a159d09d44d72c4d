/* curves.h - the measured gait curves at any speed, for one person. */
#ifndef FF_CURVES_H
#define FF_CURVES_H

#include "mocap/generator/gait_data.h"
#include "runtime/core/base/maths.h"

/* A person's curves at one speed. Angles in radians, lengths in leg lengths, as gait_data.h lists them. */
typedef struct ff_gait_set {
    ff_fourier curve[FF_CURVE_COUNT];
} ff_gait_set;

/* Curves of a person (0 = the mean walker) at a speed (m/s); run chooses the running set. Between bands the
 * coefficients are interpolated linearly within the person (gait facts, "Making it look natural"); below the slowest
 * band everything but the means shrinks with the speed, so that a stand has no motion of its own. */
void ff_gait_set_at(int person, double speed, bool run, ff_gait_set *out);

/* Value at a phase (any real number). */
double ff_fourier_at(const ff_fourier *curve, double phase);

/* Value and slope (per unit of phase) at once. */
double ff_fourier_slope(const ff_fourier *curve, double phase, double *slope);

/* Stance fraction, cadence (steps per second) and step width (m, between the balls) that people choose at a speed. */
double ff_usual_stance(double speed, bool run);
double ff_usual_step_rate(double speed, bool run);
double ff_usual_width(double speed, bool run);

#endif
