#include "runtime/export/measures.h"

#include "runtime/core/base/fail.h"

#include <stdlib.h>
#include <string.h>

#define GAIT_STEP 0.5    /* s: one step of walking, over which velocities are averaged */
#define ROUTE_START 2.0  /* s */
#define STILL 0.15       /* m/s */
#define ROUTE_MARGIN 1.5 /* m before the goal (navigation study, section 2) */

typedef struct mean {
    double sum;
    uint64_t terms;
} mean;

static double mean_value(mean m)
{
    return m.terms ? m.sum / (double)m.terms : 0.0;
}

static ff_status take_accelerations(const ff_watch *watch, const ff_recording *recording, ff_measures *out,
                                    ff_error *error)
{
    mean raw = {0}, filtered = {0}, route = {0}, all = {0};
    size_t window = (size_t)ff_max(1.0, floor(GAIT_STEP / recording->step + 0.5));
    ff_vec2 *points = ff_calloc(recording->step_count, sizeof *points);
    if (!points) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for a path");
    for (uint32_t i = 0; i < recording->agent_count; ++i) {
        ff_span there = ff_recording_span(recording, i);
        uint32_t count = there.end - there.first, first = (uint32_t)(ROUTE_START / recording->step), end = 0;
        ff_vec2 goal = ff_scene_agents(watch->scene)[i].goal;
        for (uint32_t k = 0; k < count; ++k) {
            points[k] = ff_recording_track(recording, there.first + k, i)->position;
            if (end == k && ff_length2(ff_sub2(goal, points[k])) > ROUTE_MARGIN) end = k + 1;
        }
        ff_acceleration_add(points, count, 1, recording->step, 0.0, &raw.sum, &raw.terms);
        ff_acceleration_add(points, count, window, recording->step, 0.0, &filtered.sum, &filtered.terms);
        if (end <= first) continue;
        const ff_vec2 *way = points + first;
        ff_acceleration_add(way, end - first, window, recording->step, STILL, &route.sum, &route.terms);
        ff_acceleration_add(way, end - first, window, recording->step, 0.0, &all.sum, &all.terms);
    }
    free(points);
    out->raw = mean_value(raw);
    out->filtered = mean_value(filtered);
    out->route = mean_value(route);
    out->route_all = mean_value(all);
    return FF_OK;
}

static ff_slides slides_of(ff_array *slides)
{
    double *values = slides->data;
    size_t count = slides->count;
    return (ff_slides){ff_quantile(values, count, 0.5), ff_quantile(values, count, 0.95),
                       ff_quantile(values, count, 1.0), count};
}

static void take_arrivals(const ff_recording *recording, ff_measures *out)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < recording->agent_count; ++i) {
        for (uint32_t k = 0; k < recording->step_count; ++k) {
            if (!ff_recording_track(recording, k, i)->reached) continue;
            sum += k * recording->step;
            out->last_arrival = ff_max(out->last_arrival, k * recording->step);
            ++out->arrived;
            break;
        }
    }
    out->mean_arrival = out->arrived ? sum / out->arrived : 0.0;
}

ff_status ff_measures_take(ff_watch *watch, const ff_recording *recording, ff_measures *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    out->agents = recording->agent_count;
    take_arrivals(recording, out);
    out->collision_rate = ff_collision_rate(&watch->collisions);
    out->deepest = watch->collisions.deepest;
    out->pairs = watch->collisions.pairs;
    out->body_deepest = watch->contacts.deepest;
    out->body_pairs = watch->contacts.pairs;
    out->planted = slides_of(&watch->skate.planted);
    out->seen = slides_of(&watch->skate.seen);
    out->low_slide = watch->skate.low_time > 0.0 ? watch->skate.low_path / watch->skate.low_time : 0.0;
    out->joint_speed = 2.0 * ff_acos(ff_clamp(watch->least_dot, 0.0, 1.0)) / recording->step;
    return take_accelerations(watch, recording, out, error);
}
