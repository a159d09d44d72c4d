#include "preprocess/clean/clean.h"

#include "preprocess/clean/clean_finish.h"
#include "preprocess/clean/clean_knots.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Two passes of (1 2 1)/4 at 120 Hz: what is left between knots is jitter of the capture (cleanup study, section 4). */
#define SMOOTH_PASSES 2.0
#define SMOOTH_RATE 120.0

/* ------------------------------------------------------------------------------------------------------ smoothing */

static ff_quat middle_quat(ff_quat before, ff_quat at, ff_quat after)
{
    double s = ff_quat_dot(before, at) < 0.0 ? -0.25 : 0.25, e = ff_quat_dot(after, at) < 0.0 ? -0.25 : 0.25;
    return ff_quat_unit(
        (ff_quat){s * before.x + 0.5 * at.x + e * after.x, s * before.y + 0.5 * at.y + e * after.y,
                  s * before.z + 0.5 * at.z + e * after.z, s * before.w + 0.5 * at.w + e * after.w});
}

/* One pass of (1 2 1)/4 over hips and all rotations; the ends stay. */
static void smooth_once(ff_motion *motion)
{
    ff_vec3 hips = motion->hips[0];
    for (int k = 1; k + 1 < motion->frame_count; ++k) {
        ff_vec3 at = motion->hips[k], sum = ff_add3(hips, motion->hips[k + 1]);
        motion->hips[k] = ff_madd3(ff_scale3(sum, 0.25), at, 0.5);
        hips = at;
    }
    for (size_t r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
        ff_quat *at = motion->rotations + r, before = *at;
        for (int k = 1; k + 1 < motion->frame_count; ++k) {
            at += FF_ROLE_JOINT_COUNT;
            ff_quat own = *at;
            *at = middle_quat(before, own, at[FF_ROLE_JOINT_COUNT]);
            before = own;
        }
    }
}

static void smooth(ff_motion *motion)
{
    double rate = 1.0 / (motion->frame_time * SMOOTH_RATE);
    int passes = (int)(SMOOTH_PASSES * rate * rate + 0.25);
    for (int i = 0; i < passes; ++i)
        smooth_once(motion);
}

/* ---------------------------------------------------------------------------------------------------- the clean-up */

static ff_status clean(const ff_rig *rig, const ff_clean_settings *settings, ff_motion *motion,
                       const ff_plants *plants, ff_clean_report *report, ff_error *error)
{
    ff_clean_pins pins;
    ff_status status = ff_clean_pins_find(rig, settings, motion, plants, &pins, error);
    if (status != FF_OK) return status;
    smooth(motion);
    status = ff_clean_by_knots(rig, motion, &pins, report, error);
    if (status == FF_OK) ff_clean_finish(rig, motion, &pins);
    ff_clean_pins_free(&pins);
    return status;
}

/* ------------------------------------------------------------------------------------------------- good or no good */

/* Feet that stand still and knees that bend well need no help: made, not captured. Contacts are found to a frame or
 * two, so that a rolling foot's first millimetres may count as flat. */
static bool is_clean(const ff_clean_report *r)
{
    return r->pin_median.before < 0.0005 && r->pin_worst.before < 0.004 && r->floor_dip.before < 0.005 &&
           r->knee_least.before > 0.0;
}

/* Far beyond what the clips of the cleanup study need: such a motion is not the captured one any more. */
static ff_status judge(const ff_clean_settings *most, const ff_clean_report *r, ff_error *error)
{
    const struct {
        const char *what, *unit;
        double value, limit;
    } limits[] = {
        {"planted feet still slide by", "mm", 1e3 * r->pin_worst.after, 1e3 * most->most_slide},
        {"hips and legs had to be turned by, on average,", "degrees", r->turn_mean / FF_DEG,
         most->most_turned},
        {"one time in twenty a joint had to be turned by more than", "degrees", r->turn_most_95 / FF_DEG,
         most->most_turned_95},
        {"hips had to be moved by, on average,", "mm", 1e3 * r->shift_mean, 1e3 * most->most_moved},
        {"knees and ankles shake more than captured, by a factor of", "", r->acceleration,
         most->most_shaking},
    };
    for (size_t i = 0; i < sizeof limits / sizeof limits[0]; ++i)
        if (!(limits[i].value <= limits[i].limit))
            return ff_fail(
                error, FF_ERR_RANGE,
                "cannot be brought over cleanly: %s %.3g %s (limit %.3g); are its foot plants right? "
                "(footfall-pack plants, clean)",
                limits[i].what, limits[i].value, limits[i].unit, limits[i].limit);
    return FF_OK;
}

ff_status ff_motion_clean(const ff_rig *rig, const ff_clean_settings *settings, ff_motion *motion,
                          const ff_plants *plants, ff_clean_report *report, ff_error *error)
{
    memset(report, 0, sizeof *report);
    ff_motion before;
    ff_status status = ff_clean_measure(rig, settings, motion, motion, plants, report, error);
    report->was_clean = is_clean(report);
    if (status != FF_OK || report->was_clean) return status;
    status = ff_motion_copy(motion, &before, error);
    if (status != FF_OK) return status;
    status = clean(rig, settings, motion, plants, report, error);
    if (status == FF_OK) status = ff_clean_measure(rig, settings, &before, motion, plants, report, error);
    if (status == FF_OK) status = judge(settings, report, error);
    ff_motion_free(&before);
    return status;
}
