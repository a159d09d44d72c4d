#include "preprocess/examples/pose_distance.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Feet 2, legs 1.5, others 1 (algorithms A.12). */
static const double joint_weights[FF_ROLE_JOINT_COUNT] = {
    [FF_ROLE_HIPS] = 1.0,    [FF_ROLE_SPINE] = 1.0,      [FF_ROLE_CHEST] = 1.0,      [FF_ROLE_NECK] = 1.0,
    [FF_ROLE_HEAD] = 1.0,    [FF_ROLE_CLAVICLE_L] = 1.0, [FF_ROLE_SHOULDER_L] = 1.0, [FF_ROLE_ELBOW_L] = 1.0,
    [FF_ROLE_WRIST_L] = 1.0, [FF_ROLE_CLAVICLE_R] = 1.0, [FF_ROLE_SHOULDER_R] = 1.0, [FF_ROLE_ELBOW_R] = 1.0,
    [FF_ROLE_WRIST_R] = 1.0, [FF_ROLE_HIP_L] = 1.5,      [FF_ROLE_KNEE_L] = 1.5,     [FF_ROLE_ANKLE_L] = 2.0,
    [FF_ROLE_BALL_L] = 2.0,  [FF_ROLE_HIP_R] = 1.5,      [FF_ROLE_KNEE_R] = 1.5,     [FF_ROLE_ANKLE_R] = 2.0,
    [FF_ROLE_BALL_R] = 2.0,
};

ff_status ff_point_cycle_from_example(const ff_rig *rig, const ff_example *example, ff_point_cycle *out,
                                      ff_error *error)
{
    *out = (ff_point_cycle){
        .frame_count = example->frame_count,
        .point_count = FF_ROLE_JOINT_COUNT,
        .period = (double)example->record.period,
        .velocity = {(double)example->record.v_forward, (double)example->record.v_left},
        .turn = (double)example->record.turn_rate,
        .points = ff_calloc((size_t)example->frame_count, FF_ROLE_JOINT_COUNT * sizeof(ff_vec3)),
        .weights = joint_weights,
    };
    if (!out->points) return ff_fail(error, FF_ERR_NO_MEMORY, "the joints of %s", example->name);
    for (int k = 0; k < example->frame_count; ++k) {
        ff_vec3 at[FF_BODY_COUNT];
        ff_example_pose(rig, example, k, at);
        memcpy(out->points + (size_t)k * FF_ROLE_JOINT_COUNT, at, FF_ROLE_JOINT_COUNT * sizeof *at);
    }
    return FF_OK;
}

void ff_point_cycle_free(ff_point_cycle *cycle)
{
    free(cycle->points);
    memset(cycle, 0, sizeof *cycle);
}

/* ------------------------------------------------------------------------------------------------------- windows */

/* Catmull-Rom weights of the four frames around t in [0, 1], and their slopes. */
static void spline_weights(double t, double w[4], double slope[4])
{
    double t2 = t * t, t3 = t2 * t;
    const double value[4] = {-t3 + 2.0 * t2 - t, 3.0 * t3 - 5.0 * t2 + 2.0, -3.0 * t3 + 4.0 * t2 + t,
                             t3 - t2};
    const double change[4] = {-3.0 * t2 + 4.0 * t - 1.0, 9.0 * t2 - 10.0 * t, -9.0 * t2 + 8.0 * t + 1.0,
                              3.0 * t2 - 2.0 * t};
    for (int i = 0; i < 4; ++i)
        w[i] = 0.5 * value[i], slope[i] = 0.5 * change[i];
}

/* Turned about the vertical by an angle whose sine and cosine are given. */
static ff_vec3 turned(ff_vec3 p, double sine, double cosine)
{
    return ff_v3(p.x * cosine + p.z * sine, p.y, p.z * cosine - p.x * sine);
}

void ff_cycle_window(const ff_point_cycle *cycle, double phase, ff_vec3 *points, ff_vec3 *slopes)
{
    int n = cycle->frame_count, count = cycle->point_count;
    for (int i = 0; i < FF_WINDOW; ++i) {
        double time = (i - FF_WINDOW / 2) * FF_WINDOW_STEP, at = phase + time / cycle->period;
        double frame = (at - floor(at)) * n, w[4], change[4], sine, cosine;
        int first = (int)frame;
        spline_weights(frame - first, w, change);
        ff_sincos(cycle->turn * time, &sine, &cosine);
        ff_vec2 moved = ff_root_arc(cycle->velocity, cycle->turn, time);
        for (int p = 0; p < count; ++p) {
            ff_vec3 sum = {0.0, 0.0, 0.0}, slope = {0.0, 0.0, 0.0};
            for (int k = 0; k < 4; ++k) {
                ff_vec3 q = cycle->points[(size_t)((first + k - 1 + n) % n) * (size_t)count + (size_t)p];
                sum = ff_madd3(sum, q, w[k]);
                slope = ff_madd3(slope, q, change[k] * n);
            }
            points[i * count + p] = ff_add3(turned(sum, sine, cosine), ff_v3(moved.b, 0.0, moved.a));
            if (slopes) slopes[i * count + p] = turned(slope, sine, cosine);
        }
    }
}

/* ----------------------------------------------------------------------------------------------------- alignment */

ff_vec3 ff_aligned(const ff_alignment *alignment, ff_vec3 point)
{
    double sine, cosine;
    ff_sincos(alignment->turn, &sine, &cosine);
    return ff_add3(turned(point, sine, cosine), ff_v3(alignment->shift.b, 0.0, alignment->shift.a));
}

ff_alignment ff_cloud_align(const ff_vec3 *first, const ff_vec3 *second, const double *weights, int period,
                            int count)
{
    double x = 0.0, z = 0.0, x1 = 0.0, z1 = 0.0, total = 0.0, along = 0.0, across = 0.0;
    for (int i = 0; i < count; ++i) {
        ff_vec3 p = first[i], q = second[i];
        double w = weights ? weights[i % period] : 1.0;
        total += w;
        x += w * p.x, z += w * p.z, x1 += w * q.x, z1 += w * q.z;
        along += w * (p.x * q.x + p.z * q.z);
        across += w * (p.x * q.z - q.x * p.z);
    }
    ff_alignment out = {ff_atan2(across - (x * z1 - x1 * z) / total, along - (x * x1 + z * z1) / total),
                        {0.0, 0.0}};
    double sine, cosine;
    ff_sincos(out.turn, &sine, &cosine);
    out.shift.b = (x - x1 * cosine - z1 * sine) / total;
    out.shift.a = (z + x1 * sine - z1 * cosine) / total;
    return out;
}

double ff_cloud_distance(const ff_vec3 *first, const ff_vec3 *second, const double *weights, int period,
                         int count, const ff_alignment *alignment)
{
    double sum = 0.0, total = 0.0, sine, cosine;
    ff_sincos(alignment->turn, &sine, &cosine);
    ff_vec3 shift = ff_v3(alignment->shift.b, 0.0, alignment->shift.a);
    for (int i = 0; i < count; ++i) {
        ff_vec3 apart = ff_sub3(first[i], ff_add3(turned(second[i], sine, cosine), shift));
        double w = weights ? weights[i % period] : 1.0;
        sum += w * ff_dot3(apart, apart);
        total += w;
    }
    return sqrt(sum / total);
}

/* ----------------------------------------------------------------------------------------------------------- map */

void ff_map_windows_free(ff_map_windows *windows)
{
    free(windows->points);
    free(windows->sums);
    free(windows->spread);
    free(windows->roots);
    memset(windows, 0, sizeof *windows);
}

ff_status ff_map_windows_make(const ff_point_cycle *cycle, ff_map_windows *out, ff_error *error)
{
    size_t n = (size_t)(FF_WINDOW * cycle->point_count);
    *out = (ff_map_windows){.point_count = (int)n,
                            .points = ff_calloc(FF_MAP_SIDE * n, sizeof *out->points),
                            .sums = ff_calloc(FF_MAP_SIDE, sizeof *out->sums),
                            .spread = ff_calloc(FF_MAP_SIDE, sizeof *out->spread),
                            .roots = ff_calloc(n, sizeof *out->roots)};
    if (!out->points || !out->sums || !out->spread || !out->roots) {
        ff_map_windows_free(out);
        return ff_fail(error, FF_ERR_NO_MEMORY, "the windows of a distance map");
    }
    for (size_t i = 0; i < n; ++i) {
        double w = cycle->weights[i % (size_t)cycle->point_count];
        out->roots[i] = sqrt(w);
        out->total += w;
    }
    for (int k = 0; k < FF_MAP_SIDE; ++k) {
        ff_vec3 *window = out->points + (size_t)k * n;
        ff_cycle_window(cycle, k / (double)FF_MAP_SIDE, window, NULL);
        for (size_t i = 0; i < n; ++i) {
            double root = out->roots[i];
            out->sums[k] = ff_madd3(out->sums[k], window[i], root * root);
            window[i] = ff_scale3(window[i], root);
            out->spread[k] += ff_dot3(window[i], window[i]);
        }
    }
    return FF_OK;
}

void ff_distance_map(const ff_map_windows *first, const ff_map_windows *second, double *map)
{
    double total = first->total;
    size_t n = (size_t)first->point_count;
    for (int i = 0; i < FF_MAP_SIDE; ++i) {
        for (int k = 0; k < FF_MAP_SIDE; ++k) {
            const ff_vec3 *a = first->points + (size_t)i * n, *b = second->points + (size_t)k * n;
            ff_vec3 s = first->sums[i], t = second->sums[k];
            double along = 0.0, across = 0.0, up = 0.0;
            for (size_t p = 0; p < n; ++p) {
                along += a[p].x * b[p].x + a[p].z * b[p].z;
                across += a[p].x * b[p].z - b[p].x * a[p].z;
                up += a[p].y * b[p].y;
            }
            along -= (s.x * t.x + s.z * t.z) / total;
            across -= (s.x * t.z - t.x * s.z) / total;
            /* Turned by the best angle, along and across become the length of (along, across). */
            double means = (s.x * s.x + s.z * s.z + t.x * t.x + t.z * t.z) / total;
            double square = first->spread[i] + second->spread[k] - means - 2.0 * up -
                            2.0 * sqrt(along * along + across * across);
            map[i * FF_MAP_SIDE + k] = sqrt(ff_max(square, 0.0) / total);
        }
    }
}
