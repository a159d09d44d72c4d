#include "preprocess/plants/floor.h"

#include "preprocess/base/filter.h"

/* Unknowns: common level, half the difference of the feet (left +), slope along a, slope along b. */
enum { UNKNOWNS = 4 };

static void solve4(double m[UNKNOWNS][UNKNOWNS + 1], double x[UNKNOWNS])
{
    /* The priors keep the matrix positive definite, so no pivoting is needed. */
    for (int k = 0; k < UNKNOWNS; ++k)
        for (int i = k + 1; i < UNKNOWNS; ++i) {
            double f = m[i][k] / m[k][k];
            for (int j = k; j <= UNKNOWNS; ++j)
                m[i][j] -= f * m[k][j];
        }
    for (int k = UNKNOWNS - 1; k >= 0; --k) {
        x[k] = m[k][UNKNOWNS];
        for (int j = k + 1; j < UNKNOWNS; ++j)
            x[k] -= m[k][j] * x[j];
        x[k] /= m[k][k];
    }
}

static double off_plane(const ff_floor_sample *s, ff_vec3 centre, const double x[UNKNOWNS])
{
    double side = s->foot == FF_LEFT ? 1.0 : -1.0;
    return s->ball.y - (x[0] + side * x[1] + x[2] * (s->ball.z - centre.z) + x[3] * (s->ball.x - centre.x));
}

/* One round of reweighted least squares (Geman-McClure) from the plane x. Real floors of capture rooms slope by up to 2
 * cm/m, feet are up to 2 cm apart (labels, "things to know"), samples repeat to about half a centimetre. */
static void refine(const ff_floor_settings *set, const ff_floor_sample *samples, int count, ff_vec3 centre,
                   double x[UNKNOWNS], double outlier)
{
    double m[UNKNOWNS][UNKNOWNS + 1] = {{0}};
    double prior[UNKNOWNS] = {1e-6, 1.0 / (set->feet * set->feet), 1.0 / (set->slope * set->slope),
                              1.0 / (set->slope * set->slope)};
    for (int k = 0; k < UNKNOWNS; ++k)
        m[k][k] = prior[k];
    for (int i = 0; i < count; ++i) {
        const ff_floor_sample *s = &samples[i];
        double off = off_plane(s, centre, x) / outlier;
        double w =
            ff_min(s->weight, 1.0) / (set->spread * set->spread) / ((1.0 + off * off) * (1.0 + off * off));
        double row[UNKNOWNS] = {1.0, s->foot == FF_LEFT ? 1.0 : -1.0, s->ball.z - centre.z,
                                s->ball.x - centre.x};
        for (int j = 0; j < UNKNOWNS; ++j) {
            for (int k = 0; k < UNKNOWNS; ++k)
                m[j][k] += w * row[j] * row[k];
            m[j][UNKNOWNS] += w * row[j] * s->ball.y;
        }
    }
    solve4(m, x);
}

ff_floor_fit ff_floor_solve(const ff_floor_settings *settings, const ff_floor_sample *samples, int count)
{
    ff_vec3 centre = ff_v3(0.0, 0.0, 0.0);
    for (int i = 0; i < count; ++i)
        centre = ff_madd3(centre, samples[i].ball, 1.0 / count);
    double x[UNKNOWNS] = {centre.y};
    /* From a blunt to a sharp idea of what lies off the floor, so that a few samples in the air cannot win. */
    double outlier = 0.2;
    for (int round = 0; round < 14; ++round, outlier *= 0.75)
        refine(settings, samples, count, centre, x, ff_max(outlier, settings->outlier));
    ff_floor_fit fit = {.slope = ff_v2(x[2], x[3])};
    double origin = x[0] - ff_floor_rise(fit.slope, centre);
    fit.level[FF_LEFT] = origin + x[1];
    fit.level[FF_RIGHT] = origin - x[1];
    double sum = 0.0, weight = 0.0;
    for (int i = 0; i < count; ++i) {
        sum += samples[i].weight * ff_min(fabs(off_plane(&samples[i], centre, x)), 0.2);
        weight += samples[i].weight;
    }
    fit.scatter = weight > 0.0 ? sum / weight : 0.0;
    return fit;
}

void ff_floor_heights(const ff_floor_fit *fit, int foot, ff_foot_signals *signals, double *scratch)
{
    const double still = 0.3, low = 0.02; /* m/s, m */
    for (int p = 0; p < FF_FOOT_POINT_COUNT; ++p) {
        int m = 0;
        for (int i = 0; i < signals->count; ++i) {
            ff_vec3 ball = signals->point[FF_FOOT_BALL][i], at = signals->point[p][i];
            double over = ball.y - ff_floor_rise(fit->slope, ball) - fit->level[foot];
            if (over < low && over > -low && signals->speed[FF_FOOT_HEEL][i] < still &&
                signals->speed[FF_FOOT_BALL][i] < still && signals->speed[FF_FOOT_TOE][i] < 2.0 * still)
                scratch[m++] = at.y - ff_floor_rise(fit->slope, at);
        }
        double level = m > 0 ? ff_filter_quantile(scratch, m, 0.5) : fit->level[foot];
        for (int i = 0; i < signals->count; ++i) {
            ff_vec3 at = signals->point[p][i];
            signals->height[p][i] = at.y - ff_floor_rise(fit->slope, at) - level;
        }
    }
}
