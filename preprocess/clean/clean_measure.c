#include "preprocess/clean/clean.h"

#include "preprocess/base/filter.h"
#include "preprocess/clean/clean_pins.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define STILL 0.2 /* m/s^2 */
/* Accelerations are taken of positions averaged twice over this time (cleanup study: 7 frames at 120 Hz). */
#define SMOOTHED (7.0 / 120.0) /* s */

static const int turned[] = {FF_ROLE_HIPS,  FF_ROLE_HIP_L,  FF_ROLE_KNEE_L, FF_ROLE_ANKLE_L,
                             FF_ROLE_HIP_R, FF_ROLE_KNEE_R, FF_ROLE_ANKLE_R};
enum { TURNED = sizeof turned / sizeof turned[0] };

/* Positions of one point of the body, one after the other. */
static void trace(const ff_rig *rig, const ff_motion *motion, int role, int first, int last, ff_vec3 *out)
{
    for (int k = first; k <= last; ++k) {
        ff_vec3 at[FF_BODY_COUNT];
        ff_motion_pose(rig, motion, k, at, NULL);
        out[k - first] = at[role];
    }
}

/* ----------------------------------------------------------------------------------------------------- the pins */

typedef struct pin_sums {
    double *off; /* m, of each pinned frame */
    int count;
    double worst, way, seconds;
} pin_sums;

static void measure_pin(const ff_rig *rig, const ff_motion *motion, const ff_clean_pin *pin,
                        const ff_clean_plant *plant, ff_vec3 *scratch, pin_sums *sums)
{
    int last = pin->last < motion->frame_count ? pin->last : motion->frame_count - 1;
    int n = last - pin->first + 1;
    if (n < 1) return;
    trace(rig, motion, ff_leg_role(pin->foot, FF_LEG_BALL), pin->first, last, scratch);
    ff_vec3 mean = {0.0, 0.0, 0.0};
    for (int i = 0; i < n; ++i)
        mean = ff_madd3(mean, scratch[i], 1.0 / n);
    mean.y = plant->ball_height;
    for (int i = 0; i < n; ++i) {
        double off = ff_length3(ff_sub3(scratch[i], mean));
        sums->off[sums->count++] = off;
        sums->worst = ff_max(sums->worst, off);
        if (i > 0) sums->way += ff_length2(ff_plane(ff_sub3(scratch[i], scratch[i - 1])));
    }
    sums->seconds += (n - 1) * motion->frame_time;
}

static int pinned_frames(const ff_clean_pins *pins)
{
    int frames = 0;
    for (int i = 0; i < pins->count; ++i)
        frames += pins->items[i].last - pins->items[i].first + 1;
    return frames;
}

static ff_status measure_pins(const ff_rig *rig, const ff_motion *motion, const ff_clean_pins *pins,
                              double *median, double *worst, double *skate, ff_error *error)
{
    int frames = pinned_frames(pins);
    ff_vec3 *scratch = ff_calloc((size_t)motion->frame_count, sizeof *scratch);
    pin_sums sums = {.off = ff_calloc((size_t)frames + 1, sizeof *sums.off)};
    bool enough = scratch && sums.off;
    for (int i = 0; enough && i < pins->count; ++i)
        if (pins->items[i].flat) measure_pin(rig, motion, &pins->items[i], &pins->plants[i], scratch, &sums);
    if (enough) {
        *median = sums.count > 0 ? ff_filter_quantile(sums.off, sums.count, 0.5) : 0.0;
        *worst = sums.worst;
        *skate = sums.seconds > 0.0 ? sums.way / sums.seconds : 0.0;
    }
    free(scratch);
    free(sums.off);
    return enough ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "measuring %d frames", motion->frame_count);
}

/* ------------------------------------------------------------------------------------------------ floor and knees */

static void measure_floor(const ff_rig *rig, const ff_motion *motion, const ff_clean_pins *pins, double *dip,
                          double *knee)
{
    static const int soles[] = {FF_BODY_HEEL_L, FF_ROLE_BALL_L, FF_ROLE_TOE_L,
                                FF_BODY_HEEL_R, FF_ROLE_BALL_R, FF_ROLE_TOE_R};
    enum { POINTS = sizeof soles / sizeof soles[0] };
    ff_vec3 at[FF_BODY_COUNT];
    *dip = 0.0;
    *knee = FF_PI;
    for (int k = 0; k < motion->frame_count; ++k) {
        ff_motion_pose(rig, motion, k, at, NULL);
        double ground[2] = {ff_clean_ground(pins, FF_LEFT, k), ff_clean_ground(pins, FF_RIGHT, k)};
        for (int p = 0; p < POINTS; ++p)
            *dip = ff_max(*dip, ground[2 * p / POINTS] - at[soles[p]].y);
        const ff_quat *local = motion->rotations + (size_t)k * FF_ROLE_JOINT_COUNT;
        *knee = ff_min(*knee, ff_knee_flexion(local[FF_ROLE_KNEE_L]));
        *knee = ff_min(*knee, ff_knee_flexion(local[FF_ROLE_KNEE_R]));
    }
}

/* -------------------------------------------------------------------------------------------------- joints, hips */

static ff_status measure_turns(const ff_motion *before, const ff_motion *after, ff_clean_report *report,
                               ff_error *error)
{
    int n = before->frame_count, count = 0;
    double *turns = ff_calloc((size_t)n * TURNED, sizeof *turns), sum = 0.0, shift = 0.0;
    if (!turns) return ff_fail(error, FF_ERR_NO_MEMORY, "measuring %d frames", n);
    report->turn_most = report->shift_most = 0.0;
    for (int k = 0; k < n; ++k) {
        size_t first = (size_t)k * FF_ROLE_JOINT_COUNT;
        for (int j = 0; j < TURNED; ++j) {
            const ff_quat *p = &before->rotations[first + (size_t)turned[j]];
            const ff_quat *q = &after->rotations[first + (size_t)turned[j]];
            double angle = ff_quat_angle(ff_quat_mul(ff_quat_conj(*p), *q));
            turns[count++] = angle;
            sum += angle;
            if (angle <= report->turn_most) continue;
            report->turn_most = angle;
            report->turn_role = turned[j];
            report->turn_frame = k;
        }
        double moved = ff_length3(ff_sub3(after->hips[k], before->hips[k]));
        shift += moved;
        report->shift_most = ff_max(report->shift_most, moved);
    }
    report->turn_mean = sum / count;
    report->shift_mean = shift / n;
    report->turn_most_95 = ff_filter_quantile(turns, count, 0.95);
    free(turns);
    return FF_OK;
}

static void average(ff_vec3 *points, ff_vec3 *scratch, int count, int half)
{
    memcpy(scratch, points, (size_t)count * sizeof *points);
    for (int i = 0; i < count; ++i) {
        int reach = half;
        if (i < reach) reach = i;
        if (count - 1 - i < reach) reach = count - 1 - i;
        ff_vec3 sum = {0.0, 0.0, 0.0};
        for (int k = i - reach; k <= i + reach; ++k)
            sum = ff_add3(sum, scratch[k]);
        points[i] = ff_scale3(sum, 1.0 / (2 * reach + 1));
    }
}

/* Sum of the squared second differences of knees and ankles. */
static double squared_acceleration(const ff_rig *rig, const ff_motion *motion, ff_vec3 *points,
                                   ff_vec3 *scratch)
{
    static const int joints[] = {FF_ROLE_KNEE_L, FF_ROLE_ANKLE_L, FF_ROLE_KNEE_R, FF_ROLE_ANKLE_R};
    int n = motion->frame_count, half = (int)(0.5 * SMOOTHED / motion->frame_time);
    double sum = 0.0;
    for (size_t j = 0; j < sizeof joints / sizeof joints[0]; ++j) {
        trace(rig, motion, joints[j], 0, n - 1, points);
        average(points, scratch, n, half);
        average(points, scratch, n, half);
        for (int k = 1; k + 1 < n; ++k) {
            ff_vec3 d = ff_madd3(ff_add3(points[k - 1], points[k + 1]), points[k], -2.0);
            sum += ff_dot3(d, d);
        }
    }
    return sum;
}

static ff_status measure_acceleration(const ff_rig *rig, const ff_motion *before, const ff_motion *after,
                                      double *ratio, ff_error *error)
{
    size_t n = (size_t)before->frame_count;
    ff_vec3 *points = ff_calloc(2 * n, sizeof *points);
    if (!points) return ff_fail(error, FF_ERR_NO_MEMORY, "measuring %zu frames", n);
    double was = squared_acceleration(rig, before, points, points + n);
    double is = squared_acceleration(rig, after, points, points + n);
    /* what hardly moves may move a little: the ratio of two next to nothings says nothing */
    double least = STILL * before->frame_time * before->frame_time, still = 4.0 * (double)n * least * least;
    *ratio = sqrt((is + still) / (was + still));
    free(points);
    return FF_OK;
}

ff_status ff_clean_measure(const ff_rig *rig, const ff_clean_settings *settings, const ff_motion *before,
                           const ff_motion *after, const ff_plants *plants, ff_clean_report *report,
                           ff_error *error)
{
    ff_clean_pins pins;
    ff_status status = ff_clean_pins_find(rig, settings, before, plants, &pins, error);
    if (status != FF_OK) return status;
    ff_clean_report *r = report;
    status = measure_pins(rig, before, &pins, &r->pin_median.before, &r->pin_worst.before, &r->skate.before,
                          error);
    if (status == FF_OK)
        status = measure_pins(rig, after, &pins, &r->pin_median.after, &r->pin_worst.after, &r->skate.after,
                              error);
    measure_floor(rig, before, &pins, &r->floor_dip.before, &r->knee_least.before);
    measure_floor(rig, after, &pins, &r->floor_dip.after, &r->knee_least.after);
    r->acceleration = 1.0;
    if (status == FF_OK && before != after) status = measure_turns(before, after, r, error);
    if (status == FF_OK && before != after)
        status = measure_acceleration(rig, before, after, &r->acceleration, error);
    ff_clean_pins_free(&pins);
    return status;
}
