#include "preprocess/pack/pose_spline.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/maths.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Weight of the squared third differences of the keys. It decides only where samples leave a key free: at the ends, and
 * where there are fewer samples than keys. */
#define STIFFNESS 1e-5
#define QUIET 20 /* keys after which an end is no longer felt: (2 - sqrt 3)^20 = 4e-12 */

static void weights_of(double place, int intervals, int *key, double w[4])
{
    *key = (int)place;
    if (*key > intervals - 1) *key = intervals - 1;
    double t = place - *key, s = 1.0 - t;
    w[0] = s * s * s / 6.0;
    w[1] = (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0;
    w[2] = (1.0 + 3.0 * (t + t * t - t * t * t)) / 6.0;
    w[3] = t * t * t / 6.0;
}

/* Key intervals from sample to sample. */
static double spacing(const ff_spline_fit *fit)
{
    int spans = fit->cyclic ? fit->samples : fit->samples - 1;
    return spans > 0 ? (double)fit->intervals / spans : 0.0;
}

/* Lower triangle of the normal equations: [i][d] belongs to keys i and i - d. */
static void add_square(double (*matrix)[4], int first, const double w[4], double weight)
{
    for (int p = 0; p < 4; ++p)
        for (int q = 0; q <= p; ++q)
            matrix[first + p][p - q] += weight * w[p] * w[q];
}

static void fill(const ff_spline_fit *fit)
{
    static const double third[4] = {-1.0, 3.0, -3.0, 1.0};
    double step = spacing(fit), w[4];
    int key;
    for (int i = 0; i < fit->samples * fit->turns; ++i) {
        weights_of(i * step, fit->keys - 3, &key, w);
        add_square(fit->factor, key, w, 1.0);
    }
    for (int k = 0; k + 3 < fit->keys; ++k)
        add_square(fit->factor, k, third, STIFFNESS);
}

/* Cholesky in place. A key that no sample touches keeps to its neighbours by STIFFNESS; fewer than four keys hold
 * nothing to each other, so the diagonal is kept away from zero. */
static void decompose(double (*a)[4], int count)
{
    for (int i = 0; i < count; ++i)
        for (int d = 3; d >= 0; --d) {
            int j = i - d;
            if (j < 0) continue;
            double sum = a[i][d];
            for (int k = j - 1; k >= 0 && k >= i - 3; --k)
                sum -= a[i][i - k] * a[j][j - k];
            a[i][d] = d > 0 ? sum / a[j][0] : sqrt(ff_max(sum, 1e-9));
        }
}

static void solve(double (*a)[4], int count, double *x)
{
    for (int i = 0; i < count; ++i) {
        for (int d = 1; d <= 3 && d <= i; ++d)
            x[i] -= a[i][d] * x[i - d];
        x[i] /= a[i][0];
    }
    for (int i = count - 1; i >= 0; --i) {
        for (int d = 1; d <= 3 && i + d < count; ++d)
            x[i] -= a[i + d][d] * x[i + d];
        x[i] /= a[i][0];
    }
}

ff_status ff_spline_fit_create(int samples, int intervals, bool cyclic, ff_spline_fit *fit, ff_error *error)
{
    *fit = (ff_spline_fit){.samples = samples, .intervals = intervals, .cyclic = cyclic, .turns = 1};
    if (cyclic) fit->turns = 2 * ((QUIET + intervals - 1) / intervals) + 1;
    fit->keys = fit->turns * intervals + 3;
    fit->factor = ff_calloc((size_t)fit->keys, sizeof *fit->factor);
    fit->work = ff_calloc((size_t)fit->keys, sizeof *fit->work);
    if (!fit->factor || !fit->work) {
        ff_spline_fit_free(fit);
        return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory fitting %d keys", fit->keys);
    }
    fill(fit);
    decompose(fit->factor, fit->keys);
    return FF_OK;
}

void ff_spline_fit_free(ff_spline_fit *fit)
{
    free(fit->factor);
    free(fit->work);
    memset(fit, 0, sizeof *fit);
}

void ff_spline_fit_keys(const ff_spline_fit *fit, const double *values, double *keys)
{
    double step = spacing(fit), w[4];
    int key;
    memset(fit->work, 0, (size_t)fit->keys * sizeof *fit->work);
    for (int i = 0; i < fit->samples * fit->turns; ++i) {
        weights_of(i * step, fit->keys - 3, &key, w);
        for (int p = 0; p < 4; ++p)
            fit->work[key + p] += w[p] * values[i % fit->samples];
    }
    solve(fit->factor, fit->keys, fit->work);
    const double *from = fit->work + (size_t)(fit->turns / 2) * (size_t)fit->intervals;
    memcpy(keys, from, ((size_t)fit->intervals + 3) * sizeof *keys);
    for (int i = 0; fit->cyclic && i < 3; ++i)
        keys[fit->intervals + i] = keys[i];
}

double ff_spline_fit_value(const ff_spline_fit *fit, const double *keys, int i)
{
    double w[4];
    int key;
    weights_of(i * spacing(fit), fit->intervals, &key, w);
    return w[0] * keys[key] + w[1] * keys[key + 1] + w[2] * keys[key + 2] + w[3] * keys[key + 3];
}
