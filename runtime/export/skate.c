#include "runtime/export/skate.h"

#include "runtime/core/base/fail.h"

#include <stdlib.h>
#include <string.h>

/* Label-free plants: the ball within SEEN_HEIGHT of its rest height, slower than the entry speed, until it is higher
 * or faster than the exit speed (algorithms A.5, with a lower height as there is no noise). */
#define SEEN_HEIGHT 0.015
#define SEEN_ENTER 0.35
#define SEEN_LEAVE 0.55
#define LOW_HEIGHT 0.025 /* H of G.3 */

ff_status ff_skate_create(uint32_t agents, double step, ff_skate *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    out->agent_count = agents;
    out->step = step;
    out->feet = ff_calloc(2 * (size_t)agents, sizeof *out->feet);
    return out->feet ? FF_OK
                     : ff_fail(error, FF_ERR_NO_MEMORY, "no memory to watch the feet of %u agents", agents);
}

void ff_skate_free(ff_skate *skate)
{
    free(skate->feet);
    ff_array_free(&skate->planted);
    ff_array_free(&skate->seen);
    memset(skate, 0, sizeof *skate);
}

static ff_status close_run(ff_skate_run *run, ff_array *plants, ff_error *error)
{
    if (run->open && run->frames > 1) {
        double *slot = ff_array_grow(plants, 1, sizeof *slot);
        if (!slot) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for another foot plant");
        *slot = run->path;
    }
    memset(run, 0, sizeof *run);
    return FF_OK;
}

static ff_status follow_run(ff_skate_run *run, bool on, ff_vec2 ball, ff_array *plants, ff_error *error)
{
    if (!on) return close_run(run, plants, error);
    if (run->open) run->path += ff_length2(ff_sub2(ball, run->last));
    run->open = true;
    run->last = ball;
    ++run->frames;
    return FF_OK;
}

ff_status ff_skate_add(ff_skate *skate, uint32_t agent, int foot, ff_vec3 ball, double rest_height,
                       bool planted, ff_error *error)
{
    ff_skate_foot *state = skate->feet + 2 * (size_t)agent + foot;
    ff_vec2 ground = ff_plane(ball);
    ff_status status = follow_run(&state->planted, planted, ground, &skate->planted, error);
    if (status != FF_OK) return status;

    double moved = state->known ? ff_length2(ff_sub2(ground, ff_plane(state->last))) : 0.0;
    double speed = moved / skate->step, height = ball.y - rest_height;
    bool still = state->known && height < SEEN_HEIGHT && speed < (state->seen.open ? SEEN_LEAVE : SEEN_ENTER);
    status = follow_run(&state->seen, still, ground, &skate->seen, error);
    if (height <= LOW_HEIGHT && state->known) {
        skate->low_path += moved * (2.0 - exp2(ff_max(height, 0.0) / LOW_HEIGHT));
        skate->low_time += skate->step;
    }
    state->last = ball;
    state->known = true;
    return status;
}

ff_status ff_skate_finish(ff_skate *skate, ff_error *error)
{
    for (size_t i = 0; i < 2 * (size_t)skate->agent_count; ++i) {
        ff_status status = close_run(&skate->feet[i].planted, &skate->planted, error);
        if (status == FF_OK) status = close_run(&skate->feet[i].seen, &skate->seen, error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}
