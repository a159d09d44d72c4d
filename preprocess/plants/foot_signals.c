#include "preprocess/plants/foot_signals.h"

#include "preprocess/base/filter.h"
#include "preprocess/plants/foot_points.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Rules with times of 10 ms need a rate near that of optical capture. */
static const double WORKING_RATE = 120.0;
/* Noisy capture is smoothed more: at 2 mm a speed from 15 Hz positions is off by 0.1 m/s, a third of the limits it
 * is held against. Optical capture has 0.1 to 0.5 mm and keeps the labels' filter, 15 Hz. */
static const double QUIET = 0.0005, NOISY = 0.002, NOISY_SHARE = 11.0 / 15.0;

/* Cutoff for a foot's points as captured. Slow capture has no high frequencies to tell noise from. */
static double cutoff_for(const ff_foot_points *raw, double cutoff, double rate, double *scratch)
{
    if (rate < 100.0) return cutoff;
    double noise = ff_filter_noise(raw->ball, raw->count, scratch);
    return ff_lerp(cutoff, NOISY_SHARE * cutoff, ff_clamp((noise - QUIET) / (NOISY - QUIET), 0.0, 1.0));
}

static ff_status allocate(ff_foot_signals *out, const char *name, ff_error *error)
{
    size_t n = (size_t)out->count;
    size_t points = FF_FOOT_POINT_COUNT * n * sizeof(ff_vec3),
           numbers = FF_FOOT_POINT_COUNT * n * sizeof(double);
    unsigned char *memory = ff_calloc(1, points + 2 * numbers);
    if (!memory)
        return ff_fail(error, FF_ERR_NO_MEMORY, "%s: no memory for %d frames of foot signals", name,
                       out->count);
    out->memory = memory;
    for (int p = 0; p < FF_FOOT_POINT_COUNT; ++p) {
        out->point[p] = (ff_vec3 *)(void *)memory + (size_t)p * n;
        out->speed[p] = (double *)(void *)(memory + points) + (size_t)p * n;
        out->height[p] = (double *)(void *)(memory + points + numbers) + (size_t)p * n;
    }
    return FF_OK;
}

ff_status ff_foot_signals_read(const ff_clip *clip, int foot, const ff_plant_settings *settings,
                               ff_foot_signals *out, ff_foot_shape *shape, ff_error *error)
{
    memset(out, 0, sizeof *out);
    out->settings = settings;
    ff_foot_points raw;
    ff_status status = ff_foot_points_read(clip, foot, &raw, shape, error);
    if (status != FF_OK) return status;
    double rate = 1.0 / clip->frame_time;
    out->factor = (int)ff_clamp(floor(WORKING_RATE / rate + 0.5), 1.0, 100.0);
    out->rate = rate * out->factor;
    if (raw.count > 100000000 / out->factor)
        status = ff_fail(error, FF_ERR_RANGE, "%s: %d frames are more than the plant detector takes",
                         clip->name, raw.count);
    else {
        out->count = (raw.count - 1) * out->factor + 1;
        status = allocate(out, clip->name, error);
    }
    if (status == FF_OK) {
        ff_vec3 *source[FF_FOOT_POINT_COUNT] = {raw.heel, raw.ball, raw.toe};
        double cutoff = cutoff_for(&raw, settings->cutoff, rate, out->speed[0]);
        for (int p = 0; p < FF_FOOT_POINT_COUNT; ++p) {
            ff_filter_despike(source[p], raw.count, rate);
            ff_filter_upsample(source[p], raw.count, out->factor, out->point[p]);
            ff_filter_low_pass3(out->point[p], out->count, out->rate, cutoff);
            for (int i = 0; i < out->count; ++i)
                out->speed[p][i] = ff_length3(ff_filter_velocity(out->point[p], out->count, i, out->rate));
        }
    }
    ff_foot_points_free(&raw);
    return status;
}

void ff_foot_signals_free(ff_foot_signals *signals)
{
    free(signals->memory);
    memset(signals, 0, sizeof *signals);
}
