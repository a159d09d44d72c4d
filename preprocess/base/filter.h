/* filter.h - filters that do not shift in time, for signals sampled at a constant rate. */
#ifndef FF_FILTER_H
#define FF_FILTER_H

#include "mocap/clip.h"

/* Second-order Butterworth run forwards and backwards (zero phase), in place on count values that lie stride doubles
 * apart. cutoff is the -3 dB frequency of the whole. Signals that the rate cannot hold (cutoff near rate / 2) and
 * ones of fewer than 4 values are left as they are. */
void ff_filter_low_pass(double *values, int count, int stride, double rate, double cutoff);

/* The same on all three coordinates. */
void ff_filter_low_pass3(ff_vec3 *points, int count, double rate, double cutoff);

/* Replace single points that leave the line between their neighbours further than a body can (marker swaps). */
void ff_filter_despike(ff_vec3 *points, int count, double rate);

/* Cubic interpolation: out has (count - 1) * factor + 1 points, every factor-th one is a point of in. */
void ff_filter_upsample(const ff_vec3 *in, int count, int factor, ff_vec3 *out);

/* Central difference, one-sided at the ends. */
ff_vec3 ff_filter_velocity(const ff_vec3 *points, int count, int index, double rate);

/* Value at share (0..1) of the sorted values; sorts them in place. count >= 1. */
double ff_filter_quantile(double *values, int count, double share);

/* Deviation (m, per coordinate) of white noise on the points, from their third differences, in which smooth motion
 * at 100 Hz and more all but vanishes. scratch holds count numbers. */
double ff_filter_noise(const ff_vec3 *points, int count, double *scratch);

#endif
