#include "preprocess/plants/plant_edit.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

void ff_plant_edits_free(ff_plant_edits *edits)
{
    free(edits->items);
    memset(edits, 0, sizeof *edits);
}

void ff_plant_edits_trim(ff_plant_edits *edits, int first, int frame_count)
{
    int kept = 0;
    for (int i = 0; i < edits->count; ++i) {
        ff_plant_edit e = edits->items[i];
        int *frames[5] = {&e.frame, &e.start, &e.end, &e.flat_start, &e.flat_end};
        for (int k = 0; k < 5; ++k)
            if (*frames[k] >= 0) *frames[k] -= first;
        bool named = e.kind == FF_EDIT_ADD || (e.frame >= 0 && e.frame < frame_count);
        bool inside = e.kind == FF_EDIT_REMOVE || e.start == FF_EDIT_LEAVE || e.end == FF_EDIT_LEAVE ||
                      (e.start < frame_count && e.end >= 0);
        if (!named || !inside) continue;
        for (int k = 1; k < 5; ++k)
            if (*frames[k] >= frame_count) *frames[k] = frame_count - 1;
        /* Frames before the first kept one are below zero now, and mean something else there. */
        if (edits->items[i].start >= 0 && e.start < 0) e.start = 0;
        if (edits->items[i].flat_start >= 0 && e.flat_start < 0) e.flat_start = 0;
        if (edits->items[i].flat_end >= 0 && e.flat_end < 0) e.flat_start = e.flat_end = -1;
        edits->items[kept++] = e;
    }
    edits->count = kept;
}

static ff_status refuse(const ff_plant_edits *edits, const ff_plant_edit *e, ff_error *error,
                        const char *format, int value)
{
    /* Every format below takes the foot's name and one number. */
    return ff_fail_at(error, FF_ERR_RANGE, edits->path, e->line, e->column, format,
                      e->foot == FF_LEFT ? "left" : "right", value);
}

static int covers(const ff_plant *plants, int count, int frame)
{
    for (int i = 0; i < count; ++i)
        if (plants[i].start <= frame && frame <= plants[i].end) return i;
    return -1;
}

static void set_frames(const ff_plant_edit *e, int frame_count, ff_plant *p)
{
    if (e->start != FF_EDIT_LEAVE) p->start = e->start;
    if (e->end != FF_EDIT_LEAVE) p->end = e->end;
    if (e->flat_start != FF_EDIT_LEAVE) {
        p->flat_start = e->flat_start;
        p->flat_end = e->flat_end;
    } else if (p->flat_start >= 0) {
        /* The flat stretch stays inside what was moved. */
        p->flat_start = p->flat_start > p->start ? p->flat_start : p->start;
        p->flat_end = p->flat_end < p->end ? p->flat_end : p->end;
        if (p->flat_end < p->flat_start) p->flat_start = p->flat_end = -1;
    }
    p->cut_start = p->start == 0;
    p->cut_end = p->end == frame_count - 1;
    p->confidence = 1.0;
    p->written = true;
}

static ff_status check_frames(const ff_plant_edits *edits, const ff_plant_edit *e, int frame_count,
                              const ff_plant *p, ff_error *error)
{
    if (p->end >= frame_count)
        return refuse(edits, e, error, "the %s plant ends after the clip's last frame, %d", frame_count - 1);
    if (p->start > p->end)
        return refuse(edits, e, error, "the %s plant ends before it starts, at %d", p->start);
    if (p->flat_start >= 0 && (p->flat_start < p->start || p->flat_end > p->end))
        return refuse(edits, e, error, "the %s plant is flat outside itself, from %d", p->flat_start);
    return FF_OK;
}

static int by_start(const void *x, const void *y)
{
    const ff_plant *p = x, *q = y;
    return (p->start > q->start) - (p->start < q->start);
}

static ff_status apply_one(const ff_plant_edits *edits, const ff_plant_edit *e, int frame_count,
                           ff_plant *plants, int *count, ff_error *error)
{
    int at = e->kind == FF_EDIT_ADD ? *count : covers(plants, *count, e->frame);
    if (at < 0)
        return refuse(edits, e, error, "no %s plant was found at frame %d; `footfall-pack plants` lists them",
                      e->frame);
    if (e->kind == FF_EDIT_REMOVE) {
        memmove(plants + at, plants + at + 1, (size_t)(--*count - at) * sizeof *plants);
        return FF_OK;
    }
    if (e->kind == FF_EDIT_ADD) {
        plants[at] = (ff_plant){.foot = e->foot, .flat_start = FF_EDIT_LEAVE, .flat_end = FF_EDIT_LEAVE};
        ++*count;
    }
    set_frames(e, frame_count, &plants[at]);
    ff_status status = check_frames(edits, e, frame_count, &plants[at], error);
    for (int i = 0; i < *count && status == FF_OK; ++i)
        if (i != at && plants[i].start <= plants[at].end && plants[i].end >= plants[at].start)
            status = refuse(edits, e, error,
                            "the %s plant runs into another one, at frame %d; remove or move that one "
                            "first",
                            plants[i].start > plants[at].start ? plants[i].start : plants[at].start);
    qsort(plants, (size_t)*count, sizeof *plants, by_start);
    return status;
}

ff_status ff_plant_edits_apply(const ff_plant_edits *edits, int foot, int frame_count, const ff_plant *found,
                               int count, ff_plant *out, int *out_count, ff_error *error)
{
    *out_count = 0;
    for (int i = 0; i < count && !edits->all; ++i)
        if (found[i].foot == foot) out[(*out_count)++] = found[i];
    ff_status status = FF_OK;
    for (int i = 0; i < edits->count && status == FF_OK; ++i)
        if (edits->items[i].foot == foot)
            status = apply_one(edits, &edits->items[i], frame_count, out, out_count, error);
    return status;
}
