#include "preprocess/actions/steps.h"

#include "preprocess/actions/annotate.h"
#include "preprocess/actions/landing.h"
#include "preprocess/actions/step_check.h"
#include "preprocess/actions/whole.h"
#include "preprocess/motion/standing.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct cutting {
    const ff_cut_settings *settings;
    const ff_rig *rig;
    const ff_motion *motion;
    const ff_plants *plants;
    int mode_tag;
    ff_landing *landings;
    int landing_count;
    ff_stand *stands;
    int stand_count;
    ff_whole *wholes;
    int whole_count;
    ff_array actions, rejections;
    ff_error *error;
} cutting;

static int by_frame(const void *x, const void *y)
{
    const ff_landing *p = x, *q = y;
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
    ff_action_annotate(c->settings, c->rig, c->motion, c->plants, span, action);
    if (ff_step_acceptable(&c->settings->steps, c->rig, c->motion, c->plants, span, &action->record, reason,
                           sizeof reason))
        return FF_OK;
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

/* The standing that the person comes to soon after frame, before the next landing, or NULL. */
static const ff_stand *next_stand(const cutting *c, int frame, int next_landing)
{
    for (int i = 0; i < c->stand_count; ++i) {
        const ff_stand *s = &c->stands[i];
        if (s->first <= frame && s->last > frame) return s;
        if (s->first > frame && s->first < next_landing &&
            (s->first - frame) * c->motion->frame_time < c->settings->steps.stops_within)
            return s;
    }
    return NULL;
}

/* A jump or a duck is played whole: its steps are none of their own. */
static bool inside_whole(const cutting *c, const ff_step_span *span)
{
    for (int i = 0; i < c->whole_count; ++i) {
        const ff_whole *w = &c->wholes[i];
        if (w->mode != FF_MODE_TURN && span->first < w->last && span->last > w->first) return true;
    }
    return false;
}

/* Whether both feet stand at the ends; a step that comes to standing lasts until then. */
static void mind_standing(const cutting *c, ff_step_span *span, const ff_stand *before, const ff_stand *after)
{
    int swing_foot = c->plants->items[span->swing].foot;
    if (before && ff_plant_at(c->plants, swing_foot, span->first) >= 0)
        span->flags |= FF_ACTION_FROM_STANDING;
    if (!after) return;
    int last = after->first > span->last ? after->first : span->last;
    if (ff_plant_at(c->plants, 1 - swing_foot, last) != span->support) return;
    span->last = last;
    span->flags |= FF_ACTION_TO_STANDING;
}

/* One step that ends with landing number k. */
static ff_status cut_step(cutting *c, int k)
{
    const ff_landing *end = &c->landings[k];
    const ff_plant *swing = &c->plants->items[end->plant];
    ff_step_span span = {
        .first = -1, .last = end->frame, .support = -1, .swing = end->plant, .swing_from = -1};
    span.mode = -1;
    for (int i = k - 1; i >= 0 && (span.support < 0 || span.swing_from < 0); --i) {
        const ff_landing *before = &c->landings[i];
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
    if (inside_whole(c, &span)) return FF_OK;
    if (!stand && c->plants->items[c->landings[k - 1].plant].cut_start)
        return reject(c, span.first, span.last, "its first plant is cut by the clip's start");
    if (span.first < support->start || span.first > support->end)
        return reject(c, span.first, span.last, "the same foot lands twice while the other is in the air");
    int next = k + 1 < c->landing_count ? c->landings[k + 1].frame : c->motion->frame_count;
    const ff_stand *after = next_stand(c, end->frame, next);
    mind_standing(c, &span, stand, after);
    /* A clip with a duck in it is called crouched for the duck. */
    int tag = c->mode_tag == FF_MODE_CROUCH && c->whole_count > 0 ? -1 : c->mode_tag;
    span.mode =
        ff_step_mode(c->settings, c->rig, c->motion, c->plants, &span, tag, stand != NULL, after != NULL);
    if (span.mode == FF_MODE_JUMP) span.flags |= FF_ACTION_WHOLE;
    return take(c, &span);
}

/* A stretch that is played complete: it ends on the foot that lands last, and begins on the other one. */
static ff_status cut_whole(cutting *c, const ff_whole *w)
{
    ff_step_span span = {
        .first = w->first, .last = w->last, .mode = w->mode, .flags = FF_ACTION_WHOLE, .swing = -1};
    if (w->standing) span.flags |= FF_ACTION_FROM_STANDING | FF_ACTION_TO_STANDING;
    for (int i = 0; i < c->landing_count; ++i)
        if (c->landings[i].frame > w->first && c->landings[i].frame <= w->last)
            span.swing = c->landings[i].plant;
    if (span.swing < 0) return reject(c, w->first, w->last, "no foot lands in what would be played whole");
    int foot = c->plants->items[span.swing].foot;
    span.support = ff_plant_at(c->plants, 1 - foot, w->first);
    span.swing_from = ff_plant_at(c->plants, foot, w->first);
    if (span.support < 0 || span.last <= span.first)
        return reject(c, w->first, w->last, "no foot stands where the whole action would begin");
    return take(c, &span);
}

/* A clip that is tagged as a jump or a climb, in which no such thing was found by itself: all of it. */
static ff_whole whole_clip(const cutting *c)
{
    ff_whole w = {
        .first = c->landings[0].frame, .last = c->landings[c->landing_count - 1].frame, .mode = c->mode_tag};
    if (c->stand_count > 0 && c->stands[0].last < w.last) w.first = c->stands[0].last;
    return w;
}

static ff_status cut_wholes(cutting *c)
{
    bool platform = c->mode_tag == FF_MODE_JUMP || c->mode_tag == FF_MODE_CLIMB;
    ff_status status = FF_OK;
    for (int i = 0; i < c->whole_count && status == FF_OK; ++i)
        status = cut_whole(c, &c->wholes[i]);
    if (!platform || c->whole_count > 0 || status != FF_OK) return status;
    ff_whole all = whole_clip(c);
    return cut_whole(c, &all);
}

/* Half a second of standing from the middle of the longest stretch, so that waiting can be planned. Who sits or lies is
 * as still, but does not stand. */
static ff_status cut_idle(cutting *c)
{
    const ff_stand *best = NULL, *low = NULL;
    int frames = (int)floor(c->settings->steps.idle / c->motion->frame_time + 0.5);
    for (int i = 0; i < c->stand_count; ++i) {
        const ff_stand *s = &c->stands[i];
        if (s->last - s->first < frames) continue;
        bool up = !ff_is_crouched(&c->settings->steps, c->rig, c->motion, c->plants, s->first, s->last);
        if (up && (!best || s->last - s->first > best->last - best->first)) best = s;
        if (!up && !low) low = s;
    }
    if (!best) return low ? reject(c, low->first, low->last, "sits, lies or crouches: no standing") : FF_OK;
    int first = (best->first + best->last - frames) / 2;
    ff_step_span span = {.first = first,
                         .last = first + frames,
                         .support = ff_plant_at(c->plants, FF_LEFT, first),
                         .swing = ff_plant_at(c->plants, FF_RIGHT, first),
                         .swing_from = ff_plant_at(c->plants, FF_RIGHT, first),
                         .mode = FF_MODE_IDLE,
                         .flags = FF_ACTION_FROM_STANDING | FF_ACTION_TO_STANDING};
    return span.support < 0 || span.swing < 0 ? FF_OK : take(c, &span);
}

static ff_status cut_all(cutting *c)
{
    int count = 0;
    for (int i = 0; i < c->plants->count; ++i) {
        int full = ff_plant_full(c->plants, i);
        if (full < 0) continue;
        full = ff_landing_in_motion(c->rig, c->motion, &c->plants->items[i], full);
        c->landings[count++] = (ff_landing){full, i};
    }
    qsort(c->landings, (size_t)count, sizeof *c->landings, by_frame);
    int capacity = c->motion->frame_count / 2 + 1;
    c->landing_count = count;
    c->stand_count = ff_stands_find(&c->settings->standing, c->motion, c->plants, c->stands, capacity);
    if (count == 0) return reject(c, 0, c->motion->frame_count - 1, "no foot plant was found");
    ff_status status = cut_idle(c);
    if (c->mode_tag == FF_MODE_IDLE || status != FF_OK) return status;
    c->whole_count = ff_wholes_find(c->settings, c->rig, c->motion, c->plants, c->stands, c->stand_count,
                                    c->landings, count, c->wholes, capacity);
    status = cut_wholes(c);
    if (c->mode_tag == FF_MODE_JUMP || c->mode_tag == FF_MODE_CLIMB || status != FF_OK) return status;
    status = reject(c, 0, c->landings[0].frame, "before the first full plant");
    for (int k = 0; k < count && status == FF_OK; ++k)
        if (!c->plants->items[c->landings[k].plant].cut_start) status = cut_step(c, k);
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

ff_status ff_actions_cut(const ff_cut_settings *settings, const ff_rig *rig, const ff_motion *motion,
                         const ff_plants *plants, int mode_tag, ff_actions *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    cutting c = {.settings = settings,
                 .rig = rig,
                 .motion = motion,
                 .plants = plants,
                 .mode_tag = mode_tag,
                 .error = error};
    c.landings = ff_calloc((size_t)plants->count + 1, sizeof *c.landings);
    c.stands = ff_calloc((size_t)motion->frame_count / 2 + 1, sizeof *c.stands);
    c.wholes = ff_calloc((size_t)motion->frame_count / 2 + 1, sizeof *c.wholes);
    ff_status status = c.landings && c.stands && c.wholes ? cut_all(&c) : no_memory(&c);
    free(c.landings);
    free(c.stands);
    free(c.wholes);
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
