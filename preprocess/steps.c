#include "preprocess/steps.h"

#include "preprocess/annotate.h"
#include "preprocess/standing.h"
#include "preprocess/step_check.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double STOPS_WITHIN = 0.4; /* s from the last full plant to standing */
static const double IDLE = 0.5;         /* s, algorithms A.6 */

/* A moment at which a foot has come down whole. */
typedef struct landing {
    int frame, plant;
} landing;

typedef struct cutting {
    const ff_rig *rig;
    const ff_motion *motion;
    const ff_plants *plants;
    int mode_tag;
    landing *landings;
    ff_stand *stands;
    int stand_count;
    ff_array actions, rejections;
    ff_error *error;
} cutting;

static int by_frame(const void *x, const void *y)
{
    const landing *p = x, *q = y;
    return p->frame != q->frame ? (p->frame > q->frame) - (p->frame < q->frame) : p->plant - q->plant;
}

static ff_status no_memory(cutting *c)
{
    return ff_fail(c->error, FF_ERR_NO_MEMORY, "no memory for the steps of %d frames",
                   c->motion->frame_count);
}

static ff_status reject(cutting *c, int first, int last, const char *reason)
{
    if (last <= first) return FF_OK;
    ff_rejection *r = ff_array_grow(&c->rejections, 1, sizeof *r);
    if (!r) return no_memory(c);
    r->first_frame = first;
    r->last_frame = last;
    snprintf(r->reason, sizeof r->reason, "%s", reason);
    return FF_OK;
}

/* Annotate the span and keep it, or say why not. */
static ff_status take(cutting *c, const ff_step_span *span)
{
    char reason[sizeof((ff_rejection *)0)->reason];
    const ff_break *b = ff_breaks_within(&c->plants->breaks, span->first, span->last);
    if (b) {
        ff_break_say(b, reason, sizeof reason);
        return reject(c, span->first, span->last, reason);
    }
    ff_action *action = ff_array_grow(&c->actions, 1, sizeof *action);
    if (!action) return no_memory(c);
    ff_action_annotate(c->rig, c->motion, c->plants, span, action);
    if (ff_step_acceptable(c->motion, c->plants, span, &action->record, reason, sizeof reason)) return FF_OK;
    --c->actions.count;
    return reject(c, span->first, span->last, reason);
}

/* The last stretch of standing between two frames, or NULL. */
static const ff_stand *last_stand(const cutting *c, int after, int before)
{
    for (int i = c->stand_count - 1; i >= 0; --i)
        if (c->stands[i].last > after && c->stands[i].first < before) return &c->stands[i];
    return NULL;
}

/* Does the person stand soon after frame, before the next landing? */
static bool comes_to_stand(const cutting *c, int frame, int next_landing)
{
    for (int i = 0; i < c->stand_count; ++i) {
        const ff_stand *s = &c->stands[i];
        if (s->first <= frame && s->last > frame) return true;
        if (s->first > frame && s->first < next_landing &&
            (s->first - frame) * c->motion->frame_time < STOPS_WITHIN)
            return true;
    }
    return false;
}

/* One step that ends with landing number k. */
static ff_status cut_step(cutting *c, int k, int landing_count)
{
    const landing *end = &c->landings[k];
    const ff_plant *swing = &c->plants->items[end->plant];
    ff_step_span span = {
        .first = -1, .last = end->frame, .support = -1, .swing = end->plant, .swing_from = -1};
    span.mode = -1;
    for (int i = k - 1; i >= 0 && (span.support < 0 || span.swing_from < 0); --i) {
        const landing *before = &c->landings[i];
        int *place = c->plants->items[before->plant].foot == swing->foot ? &span.swing_from : &span.support;
        if (*place < 0) *place = before->plant;
    }
    if (k == 0 || span.support < 0)
        return reject(c, k ? c->landings[k - 1].frame : 0, end->frame,
                      "no foot stands before the first landing");
    span.first = c->landings[k - 1].frame;
    const ff_stand *stand = last_stand(c, span.first, swing->start);
    if (stand) span.first = stand->last;
    const ff_plant *support = &c->plants->items[span.support];
    if (!stand && c->plants->items[c->landings[k - 1].plant].cut_start)
        return reject(c, span.first, span.last, "its first plant is cut by the clip's start");
    if (span.first < support->start || span.first > support->end)
        return reject(c, span.first, span.last, "the same foot lands twice while the other is in the air");
    int next = k + 1 < landing_count ? c->landings[k + 1].frame : c->motion->frame_count;
    span.mode = ff_step_mode(c->rig, c->motion, c->plants, &span, c->mode_tag, stand != NULL,
                             comes_to_stand(c, end->frame, next));
    return take(c, &span);
}

/* Platform clips (jumps, climbs) are played only complete (Beacco et al. 2013, section 4). */
static ff_status cut_whole(cutting *c, int landing_count)
{
    int last = landing_count - 1;
    ff_step_span span = {.first = c->landings[0].frame, .last = c->landings[last].frame, .mode = c->mode_tag};
    if (c->stand_count > 0 && c->stands[0].last < span.last) span.first = c->stands[0].last;
    span.swing = c->landings[last].plant;
    int foot = c->plants->items[span.swing].foot;
    span.support = ff_plant_at(c->plants, 1 - foot, span.first);
    span.swing_from = ff_plant_at(c->plants, foot, span.first);
    if (span.support < 0 || span.last <= span.first)
        return reject(c, 0, c->motion->frame_count - 1,
                      "no foot stands where the whole-clip action would begin");
    ff_action *action = ff_array_grow(&c->actions, 1, sizeof *action);
    if (!action) return no_memory(c);
    ff_action_annotate(c->rig, c->motion, c->plants, &span, action);
    return FF_OK;
}

/* Half a second of standing from the middle of the longest stretch, so that waiting can be planned. */
static ff_status cut_idle(cutting *c)
{
    const ff_stand *best = NULL;
    for (int i = 0; i < c->stand_count; ++i)
        if (!best || c->stands[i].last - c->stands[i].first > best->last - best->first) best = &c->stands[i];
    int frames = (int)floor(IDLE / c->motion->frame_time + 0.5);
    if (!best || best->last - best->first < frames) return FF_OK;
    int first = (best->first + best->last - frames) / 2;
    ff_step_span span = {.first = first,
                         .last = first + frames,
                         .support = ff_plant_at(c->plants, FF_LEFT, first),
                         .swing = ff_plant_at(c->plants, FF_RIGHT, first),
                         .swing_from = ff_plant_at(c->plants, FF_RIGHT, first),
                         .mode = FF_MODE_IDLE};
    if (span.support < 0 || span.swing < 0) return FF_OK;
    ff_action *action = ff_array_grow(&c->actions, 1, sizeof *action);
    if (!action) return no_memory(c);
    ff_action_annotate(c->rig, c->motion, c->plants, &span, action);
    return FF_OK;
}

static ff_status cut_all(cutting *c)
{
    int count = 0;
    for (int i = 0; i < c->plants->count; ++i) {
        int full = ff_plant_full(c->plants, i);
        if (full >= 0) c->landings[count++] = (landing){full, i};
    }
    qsort(c->landings, (size_t)count, sizeof *c->landings, by_frame);
    c->stand_count = ff_stands_find(c->motion, c->plants, c->stands, c->motion->frame_count / 2 + 1);
    if (count == 0) return reject(c, 0, c->motion->frame_count - 1, "no foot plant was found");
    ff_status status = cut_idle(c);
    if (c->mode_tag == FF_MODE_IDLE || status != FF_OK) return status;
    if (c->mode_tag == FF_MODE_JUMP || c->mode_tag == FF_MODE_CLIMB) return cut_whole(c, count);
    status = reject(c, 0, c->landings[0].frame, "before the first full plant");
    for (int k = 0; k < count && status == FF_OK; ++k)
        if (!c->plants->items[c->landings[k].plant].cut_start) status = cut_step(c, k, count);
    if (status == FF_OK)
        status =
            reject(c, c->landings[count - 1].frame, c->motion->frame_count - 1, "after the last full plant");
    return status;
}

static int by_place(const void *x, const void *y)
{
    const ff_rejection *p = x, *q = y;
    return p->first_frame != q->first_frame
               ? (p->first_frame > q->first_frame) - (p->first_frame < q->first_frame)
               : (p->last_frame > q->last_frame) - (p->last_frame < q->last_frame);
}

static int by_time(const void *x, const void *y)
{
    const ff_action *p = x, *q = y;
    return p->first_frame != q->first_frame
               ? (p->first_frame > q->first_frame) - (p->first_frame < q->first_frame)
               : (p->last_frame > q->last_frame) - (p->last_frame < q->last_frame);
}

ff_status ff_actions_cut(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants, int mode_tag,
                         ff_actions *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    cutting c = {.rig = rig, .motion = motion, .plants = plants, .mode_tag = mode_tag, .error = error};
    c.landings = ff_calloc((size_t)plants->count + 1, sizeof *c.landings);
    c.stands = ff_calloc((size_t)motion->frame_count / 2 + 1, sizeof *c.stands);
    ff_status status = c.landings && c.stands ? cut_all(&c) : no_memory(&c);
    free(c.landings);
    free(c.stands);
    if (status != FF_OK) {
        ff_array_free(&c.actions);
        ff_array_free(&c.rejections);
        return status;
    }
    out->items = c.actions.data;
    out->count = (int)c.actions.count;
    out->rejections = c.rejections.data;
    out->rejection_count = (int)c.rejections.count;
    if (out->rejection_count > 1)
        qsort(out->rejections, (size_t)out->rejection_count, sizeof *out->rejections, by_place);
    if (out->count > 1) qsort(out->items, (size_t)out->count, sizeof *out->items, by_time);
    return FF_OK;
}

void ff_actions_free(ff_actions *actions)
{
    free(actions->items);
    free(actions->rejections);
    memset(actions, 0, sizeof *actions);
}
