#include "preprocess/examples/cycles.h"

#include "preprocess/examples/loop.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The root's low-pass sees 0.25 s; nearer to a clip's end than this it still follows the sway of the hips (s). */
#define END_MARGIN 0.1
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
    int start,
        length; /* frames of the motion: from contact to the same foot's next, of half a cycle to the other's */
    bool half;
    double key[4]; /* frames after the left contact: left contact, right off, right contact, left off */
    int left;      /* frames from start to the left contact */
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
static bool find_keys(const ff_cycle_settings *set, const ff_plants *plants, int index, double frame_time,
                      cycle *out)
{
    const ff_plant *left = &plants->items[index], *right = NULL, *before = NULL;
    int next = next_of(plants, index, FF_LEFT);
    if (left->cut_start || left->cut_end || next < 0) return false;
    int start = left->start, end = plants->items[next].start;
    *out = (cycle){0};
    double period = end - start;
    if (period * frame_time < set->shortest || period * frame_time > set->longest || left->end >= end)
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

/* Keys of half a cycle that starts with plant index, of either foot: it lands, the other one leaves and lands in its turn.
 * What follows is taken to be the mirror image. */
static bool find_half_keys(const ff_cycle_settings *set, const ff_plants *plants, int index,
                           double frame_time, cycle *out)
{
    const ff_plant *first = &plants->items[index], *before = NULL, *second = NULL;
    if (first->cut_start) return false;
    for (int i = 0; i < plants->count; ++i) {
        const ff_plant *plant = &plants->items[i];
        if (plant->foot == first->foot) continue;
        if (plant->start <= first->start) before = plant;
        if (plant->start > first->start && !second) second = plant;
    }
    if (!before || !second || second->cut_start || before->level != first->level ||
        first->level != second->level)
        return false;
    int length = second->start - first->start, off = before->end + 1 - first->start;
    double period = 2.0 * length * frame_time;
    if (off <= 0 || off >= length || first->end < second->start) return false;
    if (period < set->shortest || period > set->longest) return false;
    *out = (cycle){.start = first->start,
                   .length = length,
                   .half = true,
                   .key = {0.0, off, length, length + off},
                   .left = first->foot == FF_LEFT ? 0 : length,
                   .gait = FF_GAIT_WALK};
    return true;
}

/* People drift a little; a straight example must be straight, or no blend is (synthesis study, section 6). */
static void straighten(const ff_cycle_settings *set, ff_pack_example *record)
{
    float drift = (float)set->drift;
    if (fabsf(record->v_forward) < drift) record->v_forward = 0.0f;
    if (fabsf(record->v_left) < drift + 0.05f * fabsf(record->v_forward)) record->v_left = 0.0f;
    if (fabsf(record->turn_rate) < (record->v_forward == 0.0f ? 0.5f : 1.0f) * (float)set->straight)
        record->turn_rate = 0.0f;
}

/* The stretch, about as long as from contact to contact, whose ends agree best: cut anywhere in the cycle, as the
 * contact itself is where poses change fastest. first, last: the frames that may be used. */
static ff_stretch best_cut(const ff_rig *rig, const ff_motion *motion, const cycle *c, int first, int last)
{
    ff_stretch best = {c->start, c->length, c->half};
    int step = (int)ceil(CUT_STEP / motion->frame_time), reach = c->length / 2;
    double least = ff_loop_cost(rig, motion, &best);
    for (int d = -reach / step; d <= reach / step; ++d) {
        ff_stretch here = {c->start + d * step, c->length, c->half};
        if (d == 0 || here.start < first || here.start + here.length > last) continue;
        double cost = ff_loop_cost(rig, motion, &here);
        if (cost < least) least = cost, best = here;
    }
    ff_stretch middle = best;
    int slack = (int)floor(CUT_SLACK / motion->frame_time);
    for (int d = -slack; d <= slack; ++d) {
        ff_stretch here = {middle.start, c->length + d, c->half};
        if (d == 0 || here.start + here.length > last) continue;
        double cost = ff_loop_cost(rig, motion, &here);
        if (cost < least) least = cost, best = here;
    }
    return best;
}

static ff_status make_example(const ff_cycle_settings *set, const ff_rig *rig, const ff_motion *motion,
                              const cycle *c, ff_stretch stretch, ff_example *out, ff_error *error)
{
    ff_steady_root root = ff_steady_root_of(motion, &stretch);
    double parts = c->half ? 2.0 : 1.0;
    double contact = (c->start + c->left - stretch.start) / (parts * stretch.length);
    ff_status status = ff_loop_close(rig, motion, &stretch, &root, contact - floor(contact), out, error);
    if (status != FF_OK) return status;
    ff_pack_example *record = &out->record;
    record->gait = (uint32_t)c->gait;
    if (c->half) record->flags |= FF_EXAMPLE_LOOSE;
    for (int k = 0; k < 4; ++k)
        record->key[k] = (float)(c->key[k] / (parts * c->length));
    straighten(set, record);
    ff_loop_find_contact_kick(rig, out);
    return FF_OK;
}

/* ---------------------------------------------------------------------------------------------------- cycles */

typedef bool find_keys_of(const ff_cycle_settings *set, const ff_plants *plants, int index, double frame_time,
                          cycle *out);

/* The cycle that begins with a plant is added, or counted as rejected. */
static ff_status add_cycle(const ff_cycle_settings *set, const ff_rig *rig, const ff_motion *motion,
                           const ff_plants *plants, int rest_frames, int index, find_keys_of *find,
                           const char *clip_name, ff_cycles *out, ff_error *error)
{
    cycle c;
    int margin = (int)ceil(END_MARGIN / motion->frame_time);
    ff_example *example = &out->items[out->count];
    ++out->rejected;
    if (!find(set, plants, index, motion->frame_time, &c) || c.start < rest_frames + margin ||
        c.start + c.length + margin > motion->frame_count ||
        ff_breaks_within(&plants->breaks, c.start, c.start + c.length))
        return FF_OK;
    ff_stretch cut = best_cut(rig, motion, &c, rest_frames + margin, motion->frame_count - margin);
    ff_status status = make_example(set, rig, motion, &c, cut, example, error);
    if (status != FF_OK) return status;
    snprintf(example->name, sizeof example->name, "%.60s@%d%s", clip_name, c.start,
             c.half ? " and its mirror image" : "");
    if (ff_example_find_feet(rig, example) < LOCK_MIN) {
        ff_example_free(example);
        return FF_OK;
    }
    ++out->count;
    --out->rejected;
    return FF_OK;
}

ff_status ff_cycles_cut(const ff_cycle_settings *settings, const ff_rig *rig, const ff_motion *motion,
                        const ff_plants *plants, int rest_frames, const char *clip_name, ff_cycles *out,
                        ff_error *error)
{
    memset(out, 0, sizeof *out);
    /* Whole ones begin with a left foot, half ones with either; + 1: an idle loop. */
    out->items = ff_calloc(2 * (size_t)plants->count + 1, sizeof *out->items);
    if (!out->items) return ff_fail(error, FF_ERR_NO_MEMORY, "the gait cycles of %s", clip_name);
    ff_status status = FF_OK;
    for (int i = 0; i < plants->count && status == FF_OK; ++i)
        if (plants->items[i].foot == FF_LEFT)
            status =
                add_cycle(settings, rig, motion, plants, rest_frames, i, find_keys, clip_name, out, error);
    if (status != FF_OK) ff_cycles_free(out);
    return status;
}

ff_status ff_cycles_cut_half(const ff_cycle_settings *settings, const ff_rig *rig, const ff_motion *motion,
                             const ff_plants *plants, int rest_frames, const char *clip_name, ff_cycles *out,
                             ff_error *error)
{
    for (int i = 0; i < plants->count; ++i) {
        ff_status status =
            add_cycle(settings, rig, motion, plants, rest_frames, i, find_half_keys, clip_name, out, error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}
