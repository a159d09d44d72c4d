#include "preprocess/clean_pins.h"

#include "preprocess/filter.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

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
}

static ff_clean_plant place(const ff_rig *rig, const ff_motion *motion, const ff_plant *plant)
{
    ff_vec3 rest[FF_BODY_COUNT];
    ff_rig_rest_pose(rig, rest);
    ff_clean_plant out = {.heel_height = rest[FF_BODY_HEEL_L].y, .ball_height = rest[FF_ROLE_BALL_L].y};
    ff_vec3 ball = ff_ground(ff_scale2(plant->ball, motion->scale), 0.0);
    out.tied[0] = ball.x;
    out.tied[1] = ball.z;
    out.tied[2] = plant->yaw;
    memcpy(out.at, out.tied, sizeof out.at);
    return out;
}

ff_status ff_clean_pins_find(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants,
                             ff_clean_pins *out, ff_error *error)
{
    size_t n = (size_t)plants->count;
    *out = (ff_clean_pins){.items = ff_calloc(n, sizeof *out->items),
                           .plants = ff_calloc(n, sizeof *out->plants)};
    if (!out->items || !out->plants) {
        ff_clean_pins_free(out);
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d pinned feet", plants->count);
    }
    for (int i = 0; i < plants->count; ++i) {
        const ff_plant *plant = &plants->items[i];
        if (plant->flat_start < 0) continue;
        out->items[out->count] = (ff_clean_pin){.foot = plant->foot,
                                                .start = plant->start,
                                                .first = plant->flat_start,
                                                .last = plant->flat_end,
                                                .end = plant->end};
        out->plants[out->count++] = place(rig, motion, plant);
    }
    return FF_OK;
}
