/* A stretch of standing still, closed to a loop. */
#include "preprocess/examples/cycles.h"
#include "preprocess/examples/loop.h"

#include <stdio.h>
#include <string.h>

#define IDLE_STEP 0.1 /* s */

/* Feet side by side: a lunge or a wide stance is no way to wait. */
static bool feet_together(const ff_plant *left, const ff_plant *right, double heading)
{
    ff_vec2 apart = ff_to_frame2(ff_fwd2(heading), ff_sub2(left->ball, right->ball));
    return fabs(apart.a) < 0.15 && apart.b > 0.05 && apart.b < 0.4;
}

/* The stretch inside [first, last] whose ends agree best; its seam, or a huge one. */
static double best_loop(const ff_cycle_settings *set, const ff_rig *rig, const ff_motion *motion, int first,
                        int last, ff_stretch *best)
{
    int step = (int)ceil(IDLE_STEP / motion->frame_time);
    double seam = 1e9;
    for (int start = first; start < last; start += step) {
        int shortest = (int)ceil(set->idle_shortest / motion->frame_time),
            longest = (int)(set->idle_longest / motion->frame_time);
        for (int length = shortest; length <= longest && start + length <= last; length += step) {
            ff_stretch stretch = {start, length, false};
            ff_steady_root root = ff_steady_root_still(motion, &stretch);
            double here = ff_loop_seam(rig, motion, &stretch, &root);
            if (here < seam) seam = here, *best = stretch;
        }
    }
    return seam;
}

ff_status ff_cycles_cut_idle(const ff_cycle_settings *set, const ff_rig *rig, const ff_motion *motion,
                             const ff_plants *plants, int rest_frames, const char *clip_name, ff_cycles *out,
                             ff_error *error)
{
    ff_stretch best = {0, 0, false}, here;
    double seam = 1e9;
    for (int i = 0; i < plants->count; ++i) {
        const ff_plant *left = &plants->items[i];
        if (left->foot != FF_LEFT || left->flat_start < 0) continue;
        for (int k = 0; k < plants->count; ++k) {
            const ff_plant *right = &plants->items[k];
            if (right->foot != FF_RIGHT || right->flat_start < 0) continue;
            int first = left->flat_start > right->flat_start ? left->flat_start : right->flat_start;
            int last = left->flat_end < right->flat_end ? left->flat_end : right->flat_end;
            if (first < rest_frames) first = rest_frames;
            if ((last - first) * motion->frame_time < set->idle_shortest) continue;
            if (!feet_together(left, right, motion->root[first].z)) continue;
            if (ff_breaks_within(&plants->breaks, first, last)) continue;
            double found = best_loop(set, rig, motion, first, last, &here);
            if (found < seam) seam = found, best = here;
        }
    }
    if (best.length == 0) return FF_OK;
    ff_example *example = &out->items[out->count];
    ff_steady_root root = ff_steady_root_still(motion, &best);
    ff_status status = ff_loop_close(rig, motion, &best, &root, 0.0, example, error);
    if (status != FF_OK) return status;
    const float keys[4] = {0.0f, 0.1f, 0.5f, 0.6f};
    memcpy(example->record.key, keys, sizeof keys);
    example->record.flags = FF_EXAMPLE_IDLE;
    snprintf(example->name, sizeof example->name, "%.60s@%d idle", clip_name, best.start);
    ff_example_find_feet(rig, example);
    ++out->count;
    return FF_OK;
}
