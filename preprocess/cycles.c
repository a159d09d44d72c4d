#include "preprocess/cycles.h"

#include "preprocess/loop.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PERIOD_MIN 0.4 /* s */
#define PERIOD_MAX 2.0
/* The root's low-pass sees 0.25 s; nearer to a clip's end than this it still follows the sway of the hips (s). */
#define END_MARGIN 0.1
/* Slower turns than this are a wobble of a straight walk (rad/s). */
#define STRAIGHT_TURN 0.1f
#define DRIFT 0.04f    /* m/s */
#define CUT_STEP 0.03  /* s, between the cuts that are tried */
#define CUT_SLACK 0.03 /* s, that a cut may be shorter or longer than from contact to contact */
#define LOCK_MIN 0.08  /* share of the cycle; a shorter stance means the plants are wrong */

void ff_cycles_free(ff_cycles *cycles)
{
    for (int i = 0; i < cycles->count; ++i)
        ff_example_free(&cycles->items[i]);
    free(cycles->items);
    memset(cycles, 0, sizeof *cycles);
}

/* ------------------------------------------------------------------------------------------------------ keys */

typedef struct cycle {
    int start, length; /* frames of the motion */
    double key[4];     /* frames after start: left contact, right off, right contact, left off */
    int gait;
} cycle;

static int next_of(const ff_plants *plants, int from, int foot)
{
    for (int i = from + 1; i < plants->count; ++i)
        if (plants->items[i].foot == foot) return i;
    return -1;
}

/* Keys of the cycle that starts with plant index, a left one; false when contacts do not come in the order of a walk
 * (L on, R off, R on, L off) or a run (L on, L off, R on, R off), or a plant is cut by the clip's end. */
static bool find_keys(const ff_plants *plants, int index, double frame_time, cycle *out)
{
    const ff_plant *left = &plants->items[index], *right = NULL, *before = NULL;
    int next = next_of(plants, index, FF_LEFT);
    if (left->cut_start || left->cut_end || next < 0) return false;
    int start = left->start, end = plants->items[next].start;
    double period = end - start;
    if (period * frame_time < PERIOD_MIN || period * frame_time > PERIOD_MAX || left->end >= end)
        return false;
    for (int i = 0; i < plants->count; ++i) {
        const ff_plant *plant = &plants->items[i];
        if (plant->foot != FF_RIGHT) continue;
        if (plant->start <= start) {
            before = plant;
        } else if (plant->start < end) {
            if (right) return false;
            right = plant;
        }
    }
    if (!right || right->cut_end || right->cut_start) return false;
    if (left->level != right->level || left->level != plants->items[next].level)
        return false; /* a step up or down */
    bool walks = before && before->end >= start;
    double right_off = walks ? before->end + 1 : right->end + 1;
    out->start = start;
    out->length = end - start;
    out->gait = walks ? FF_GAIT_WALK : FF_GAIT_RUN;
    out->key[0] = 0.0;
    out->key[1] = right_off - start;
    out->key[2] = right->start - start;
    out->key[3] = left->end + 1 - start;
    if (walks) return out->key[1] < out->key[2] && out->key[2] < out->key[3] && out->key[3] < period;
    return out->key[3] < out->key[2] && out->key[2] < out->key[1] && out->key[1] < period;
}

/* People drift a little; a straight example must be straight, or no blend is (synthesis study, section 6). */
static void straighten(ff_pack_example *record)
{
    if (fabsf(record->v_forward) < DRIFT) record->v_forward = 0.0f;
    if (fabsf(record->v_left) < DRIFT + 0.05f * fabsf(record->v_forward)) record->v_left = 0.0f;
    if (fabsf(record->turn_rate) < (record->v_forward == 0.0f ? 0.5f : 1.0f) * STRAIGHT_TURN)
        record->turn_rate = 0.0f;
}

/* The stretch, about as long as from contact to contact, whose ends agree best: cut anywhere in the cycle, as the
 * contact itself is where poses change fastest. first, last: the frames that may be used. */
static ff_stretch best_cut(const ff_rig *rig, const ff_motion *motion, const cycle *c, int first, int last)
{
    ff_stretch best = {c->start, c->length};
    int step = (int)ceil(CUT_STEP / motion->frame_time), reach = c->length / 2;
    double least = ff_loop_cost(rig, motion, &best);
    for (int d = -reach / step; d <= reach / step; ++d) {
        ff_stretch here = {c->start + d * step, c->length};
        if (d == 0 || here.start < first || here.start + here.length > last) continue;
        double cost = ff_loop_cost(rig, motion, &here);
        if (cost < least) least = cost, best = here;
    }
    ff_stretch middle = best;
    int slack = (int)floor(CUT_SLACK / motion->frame_time);
    for (int d = -slack; d <= slack; ++d) {
        ff_stretch here = {middle.start, c->length + d};
        if (d == 0 || here.start + here.length > last) continue;
        double cost = ff_loop_cost(rig, motion, &here);
        if (cost < least) least = cost, best = here;
    }
    return best;
}

static ff_status make_example(const ff_rig *rig, const ff_motion *motion, const cycle *c, ff_stretch stretch,
                              ff_example *out, ff_error *error)
{
    ff_steady_root root = ff_steady_root_fit(motion, &stretch);
    double contact = (c->start - stretch.start) / (double)stretch.length;
    ff_status status = ff_loop_close(rig, motion, &stretch, &root, contact - floor(contact), out, error);
    if (status != FF_OK) return status;
    ff_pack_example *record = &out->record;
    record->gait = (uint32_t)c->gait;
    for (int k = 0; k < 4; ++k)
        record->key[k] = (float)(c->key[k] / c->length);
    straighten(record);
    ff_loop_find_contact_kick(rig, out);
    return FF_OK;
}

/* ------------------------------------------------------------------------------------------------------ idle */

#define IDLE_MIN 2.0 /* s */
#define IDLE_MAX 4.0
#define IDLE_STEP 0.1

/* Feet side by side: a lunge or a wide stance is no way to wait. */
static bool feet_together(const ff_plant *left, const ff_plant *right, double heading)
{
    ff_vec2 apart = ff_to_frame2(ff_fwd2(heading), ff_sub2(left->ball, right->ball));
    return fabs(apart.a) < 0.15 && apart.b > 0.05 && apart.b < 0.4;
}

/* The stretch of 2 to 4 s inside [first, last] whose ends agree best; its seam, or a huge one. */
static double best_loop(const ff_rig *rig, const ff_motion *motion, int first, int last, ff_stretch *best)
{
    int step = (int)ceil(IDLE_STEP / motion->frame_time);
    double seam = 1e9;
    for (int start = first; start < last; start += step) {
        int shortest = (int)ceil(IDLE_MIN / motion->frame_time),
            longest = (int)(IDLE_MAX / motion->frame_time);
        for (int length = shortest; length <= longest && start + length <= last; length += step) {
            ff_stretch stretch = {start, length};
            ff_steady_root root = ff_steady_root_still(motion, &stretch);
            double here = ff_loop_seam(rig, motion, &stretch, &root);
            if (here < seam) seam = here, *best = stretch;
        }
    }
    return seam;
}

ff_status ff_cycles_cut_idle(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants,
                             int rest_frames, const char *clip_name, ff_cycles *out, ff_error *error)
{
    ff_stretch best = {0, 0}, here;
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
            if ((last - first) * motion->frame_time < IDLE_MIN) continue;
            if (!feet_together(left, right, motion->root[first].z)) continue;
            if (ff_breaks_within(&plants->breaks, first, last)) continue;
            double found = best_loop(rig, motion, first, last, &here);
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

/* ---------------------------------------------------------------------------------------------------- cycles */

ff_status ff_cycles_cut(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants, int rest_frames,
                        const char *clip_name, ff_cycles *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    out->items = ff_calloc((size_t)plants->count + 1, sizeof *out->items); /* + 1: an idle loop */
    if (!out->items) return ff_fail(error, FF_ERR_NO_MEMORY, "the gait cycles of %s", clip_name);
    int margin = (int)ceil(END_MARGIN / motion->frame_time);
    for (int i = 0; i < plants->count; ++i) {
        cycle c;
        if (plants->items[i].foot != FF_LEFT) continue;
        if (!find_keys(plants, i, motion->frame_time, &c) || c.start < rest_frames + margin ||
            c.start + c.length + margin > motion->frame_count ||
            ff_breaks_within(&plants->breaks, c.start, c.start + c.length)) {
            ++out->rejected;
            continue;
        }
        ff_example *example = &out->items[out->count];
        ff_stretch cut = best_cut(rig, motion, &c, rest_frames + margin, motion->frame_count - margin);
        ff_status status = make_example(rig, motion, &c, cut, example, error);
        if (status != FF_OK) {
            ff_cycles_free(out);
            return status;
        }
        snprintf(example->name, sizeof example->name, "%.60s@%d", clip_name, c.start);
        if (ff_example_find_feet(rig, example) >= LOCK_MIN) {
            ++out->count;
        } else {
            ff_example_free(example);
            ++out->rejected;
        }
    }
    return FF_OK;
}
