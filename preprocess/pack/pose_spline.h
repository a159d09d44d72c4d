/* pose_spline.h - the uniform cubic B-spline nearest to given samples (least squares). */
#ifndef FF_POSE_SPLINE_H
#define FF_POSE_SPLINE_H

#include "runtime/footfall.h"

#include <stdbool.h>

/* What depends on the numbers of samples and keys only: made once, used for every signal. */
typedef struct ff_spline_fit {
    int samples, intervals; /* of one cycle where cyclic */
    bool cyclic;
    int turns; /* cyclic: how often the cycle is strung together, so that its middle turn knows no end */
    int keys;  /* of all turns */
    double (*factor)[4]; /* [keys]: rows of the banded Cholesky factor, diagonal first */
    double *work;        /* [keys] */
} ff_spline_fit;

/* Samples lie evenly from the first to the last key interval's end; round a cycle the first follows the last. */
ff_status ff_spline_fit_create(int samples, int intervals, bool cyclic, ff_spline_fit *fit, ff_error *error);
void ff_spline_fit_free(ff_spline_fit *fit);

/* Keys [intervals + 3] for values [samples]; a cycle's last three are its first three. */
void ff_spline_fit_keys(const ff_spline_fit *fit, const double *values, double *keys);

/* The spline at sample i. */
double ff_spline_fit_value(const ff_spline_fit *fit, const double *keys, int i);

#endif
