#include "preprocess/clean/clean_pins.h"

#include "preprocess/base/filter.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define HEEL_DOWN 0.04 /* m: a heel so much under the ball of a flat foot is broken capture */
/* A ball that is slower (m/s) and lower (m) for a while (s) stands. */
#define STILL 0.4
#define STILL_HEIGHT 0.02
#define STILL_LEAST 0.03
#define RAMP (4.0 / 120.0) /* s, in which a pin comes and goes */
#define ROLL_OFF 0.3       /* share of the roll over the ball in which the ball stays pinned */

void ff_clean_pins_free(ff_clean_pins *pins)
{
    free(pins->items);
    free(pins->plants);
    memset(pins, 0, sizeof *pins);
}

void ff_clean_plant_places(const ff_rig *rig, const ff_clean_plant *plant, ff_vec3 *heel, ff_vec3 *ball)
{
    double reach = ff_foot_reach(rig, plant->ball_height - plant->heel_height), s, c;
    ff_sincos(plant->at[2], &s, &c);
    *ball = ff_v3(plant->at[0], plant->ball_height, plant->at[1]);
    *heel = ff_v3(plant->at[0] - reach * s, plant->heel_height, plant->at[1] - reach * c);
}

void ff_clean_pin_weights(const ff_clean_pin *pin, int frame, double frame_time, double *heel, double *ball)
{
    double ramp = RAMP / frame_time, before = pin->first - frame, after = frame - pin->last;
    double down = ff_max(ramp, pin->first - pin->start),
           roll = ff_max(ramp, ROLL_OFF * (pin->end - pin->last));
    *heel = *ball = 1.0;
    if (before > 0.0) {
        *heel = ff_smooth(1.0 - before / down);
        *ball = ff_smooth(1.0 - before / ramp);
    } else if (after > 0.0) {
        *heel = ff_smooth(1.0 - after / ramp);
        *ball = ff_smooth(1.0 - after / roll);
    }
    if (pin->heel_free) *heel = 0.0;
}

double ff_clean_heel_share(const ff_clean_pins *pins, const ff_clean_pin *pin, int frame, double frame_time)
{
    if (pin->heel_free) return 0.0;
    double release = ff_min(pins->settings->heel_off / frame_time, 0.5 * (pin->last - pin->first)) + 1.0;
    return ff_smooth((pin->last + 1 - frame) / release);
}

/* ------------------------------------------------------------------------------------------------- finding them */

/* Mean places of heel and ball, in the motion, over frames first to last. */
static void mean_places(const ff_rig *rig, const ff_motion *motion, int foot, int first, int last,
                        ff_vec3 *heel, ff_vec3 *ball)
{
    *heel = *ball = ff_v3(0.0, 0.0, 0.0);
    double share = 1.0 / (last - first + 1);
    for (int k = first; k <= last; ++k) {
        ff_vec3 at[FF_BODY_COUNT];
        ff_motion_pose(rig, motion, k, at, NULL);
        *heel = ff_madd3(*heel, at[foot == FF_LEFT ? FF_BODY_HEEL_L : FF_BODY_HEEL_R], share);
        *ball = ff_madd3(*ball, at[ff_leg_role(foot, FF_LEG_BALL)], share);
    }
}

/* Longest stretch of a plant in which the ball is low and slow; false when there is none worth pinning. */
static bool still_ball(const ff_plants *plants, const ff_plant *plant, double frame_time, ff_clean_pin *pin)
{
    int from = -1;
    pin->first = 0;
    pin->last = -1;
    for (int k = plant->start; k <= plant->end + 1 && k < plants->frame_count; ++k) {
        const ff_foot_track *track = &plants->tracks[2 * k + plant->foot];
        bool still = k <= plant->end && track->ball_speed < STILL && track->ball_height < STILL_HEIGHT;
        if (still && from < 0) from = k;
        if (still && k - from > pin->last - pin->first) {
            pin->first = from;
            pin->last = k;
        }
        if (!still) from = -1;
    }
    return (pin->last - pin->first) * frame_time >= STILL_LEAST;
}

/* Captured place of the ball on the rig. Of a foot that is never flat the plant knows only where it was on the whole:
 * the motion says where the still stretch is from there. */
static ff_vec2 captured_place(const ff_rig *rig, const ff_motion *motion, const ff_plant *plant,
                              const ff_clean_pin *pin, ff_vec3 still)
{
    ff_vec2 place = ff_scale2(plant->ball, motion->scale);
    if (pin->flat) return place;
    ff_vec3 heel, ball;
    int end = plant->end < motion->frame_count ? plant->end : motion->frame_count - 1;
    mean_places(rig, motion, plant->foot, plant->start, end, &heel, &ball);
    return ff_add2(place, ff_plane(ff_sub3(still, ball)));
}

/* Returns where the motion has the ball, from its captured place. */
static ff_vec2 add_pin(const ff_rig *rig, const ff_motion *motion, const ff_plant *plant, ff_clean_pin pin,
                       ff_clean_pins *pins)
{
    ff_vec3 heel, ball;
    if (pin.last >= motion->frame_count) pin.last = motion->frame_count - 1;
    mean_places(rig, motion, pin.foot, pin.first, pin.last, &heel, &ball);
    double rise = heel.y - ball.y;
    pin.heel_free = !pin.flat || rise > pins->settings->heel_up || rise < -HEEL_DOWN;
    ff_vec2 at = captured_place(rig, motion, plant, &pin, ball);
    ff_clean_plant place = {.tied = {at.b, at.a, plant->yaw},
                            .heel_height = pins->uneven ? heel.y : pins->rest,
                            .ball_height = pins->uneven ? ball.y : pins->rest};
    memcpy(place.at, place.tied, sizeof place.at);
    pins->plants[pins->count] = place;
    pins->items[pins->count++] = pin;
    return ff_sub2(ff_plane(ball), at);
}

/* A body of other proportions, whose joints turn alike, sets its feet elsewhere under its hips than the captured one
 * times the scale: wider, further ahead. Seen from the root that is the same all through a clip, so plants are moved by
 * its mean. Ahead both feet alike: each its own way would make one's steps longer and the other's shorter. */
static void fit_to_body(const ff_motion *motion, ff_clean_pins *pins, const ff_vec2 *off)
{
    double weight[2] = {0.0, 0.0};
    ff_vec2 mean[2] = {{0.0, 0.0}, {0.0, 0.0}};
    for (int i = 0; i < pins->count; ++i) {
        const ff_clean_pin *pin = &pins->items[i];
        double frames = pin->last - pin->first + 1;
        ff_vec2 ahead = ff_fwd2(motion->root[(pin->first + pin->last) / 2].z);
        mean[pin->foot] = ff_madd2(mean[pin->foot], ff_to_frame2(ahead, off[i]), frames);
        weight[pin->foot] += frames;
    }
    for (int foot = 0; foot < 2; ++foot)
        if (weight[foot] > 0.0) mean[foot] = ff_scale2(mean[foot], 1.0 / weight[foot]);
    if (weight[FF_LEFT] > 0.0 && weight[FF_RIGHT] > 0.0)
        mean[FF_LEFT].a = mean[FF_RIGHT].a = 0.5 * (mean[FF_LEFT].a + mean[FF_RIGHT].a);
    for (int i = 0; i < pins->count; ++i) {
        const ff_clean_pin *pin = &pins->items[i];
        ff_vec2 ahead = ff_fwd2(motion->root[(pin->first + pin->last) / 2].z);
        ff_vec2 by = ff_from_frame2(ahead, mean[pin->foot]);
        ff_clean_plant *plant = &pins->plants[i];
        plant->at[0] = plant->tied[0] += by.b;
        plant->at[1] = plant->tied[1] += by.a;
    }
}

static bool is_uneven(const ff_plants *plants)
{
    for (int i = 0; i < plants->count; ++i)
        if (fabs(plants->items[i].level) > 0.0) return true;
    return false;
}

ff_status ff_clean_pins_find(const ff_rig *rig, const ff_clean_settings *settings, const ff_motion *motion,
                             const ff_plants *plants, ff_clean_pins *out, ff_error *error)
{
    size_t n = (size_t)plants->count;
    ff_vec3 rest[FF_BODY_COUNT];
    ff_rig_rest_pose(rig, rest);
    *out = (ff_clean_pins){.items = ff_calloc(n, sizeof *out->items),
                           .plants = ff_calloc(n, sizeof *out->plants),
                           .settings = settings,
                           .rest = rest[FF_ROLE_BALL_L].y,
                           .uneven = is_uneven(plants)};
    ff_vec2 *off = ff_calloc(n, sizeof *off);
    if (!out->items || !out->plants || !off) {
        free(off);
        ff_clean_pins_free(out);
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d pinned feet", plants->count);
    }
    for (int i = 0; i < plants->count; ++i) {
        const ff_plant *plant = &plants->items[i];
        ff_clean_pin pin = {.foot = plant->foot,
                            .start = plant->start,
                            .first = plant->flat_start,
                            .last = plant->flat_end,
                            .end = plant->end,
                            .flat = plant->flat_start >= 0};
        if (!pin.flat && !still_ball(plants, plant, motion->frame_time, &pin)) continue;
        int index = out->count;
        off[index] = add_pin(rig, motion, plant, pin, out);
    }
    fit_to_body(motion, out, off);
    free(off);
    return FF_OK;
}

double ff_clean_ground(const ff_clean_pins *pins, int foot, int frame)
{
    if (!pins->uneven) return pins->rest;
    /* between two plants of a foot the lower one's: nothing is known of the ground there */
    int before = -1, after = -1;
    for (int i = 0; i < pins->count; ++i) {
        if (pins->items[i].foot != foot) continue;
        if (pins->items[i].first <= frame) before = i;
        if (pins->items[i].last >= frame && after < 0) after = i;
    }
    if (before < 0) before = after;
    if (after < 0) after = before;
    if (before < 0) return pins->rest;
    const ff_clean_plant *p = &pins->plants[before], *q = &pins->plants[after];
    return ff_min(ff_min(p->ball_height, p->heel_height), ff_min(q->ball_height, q->heel_height));
}
