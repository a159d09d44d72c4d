#include "preprocess/plants/plants.h"

#include "preprocess/base/filter.h"
#include "preprocess/plants/contact.h"
#include "preprocess/plants/floor.h"
#include "preprocess/plants/plant_edit.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* The sole is this far below the ball joint, as a share of the leg's length (CMU, level clips: 3 cm of 0.84 m). */
static const double BALL_OVER_SOLE = 0.036;
/* How much further over the floor a planted foot may be per metre of mean distance from the plane, which is large where
 * the ground is uneven. */
static const double ABOVE_PER_SCATTER = 3.0;
static const double GLIMPSE = 0.018; /* s */

/* What is known while one clip is searched. */
typedef struct search {
    const ff_clip *clip;
    const ff_find_settings *settings;
    ff_foot_signals feet[2];
    ff_contact *contacts[2];
    int count[2];
    ff_vec3 *hips;   /* m, smoothed, per working frame */
    double *scratch; /* per working frame */
    ff_floor_fit floor;
    double leg; /* m */
} search;

static void search_free(search *s)
{
    for (int foot = 0; foot < 2; ++foot) {
        ff_foot_signals_free(&s->feet[foot]);
        free(s->contacts[foot]);
    }
    free(s->hips);
    free(s->scratch);
}

static ff_status read_hips(search *s, ff_error *error)
{
    const ff_clip *clip = s->clip;
    int joint = ff_clip_find(clip, FF_ROLE_HIPS), hip = ff_clip_find(clip, FF_ROLE_HIP_L);
    int knee = ff_clip_find(clip, FF_ROLE_KNEE_L), ankle = ff_clip_find(clip, FF_ROLE_ANKLE_L);
    if (joint < 0) joint = hip;
    int frames = clip->frame_count - clip->rest_frames;
    ff_vec3 *pose = ff_calloc((size_t)clip->joint_count, sizeof *pose);
    ff_vec3 *raw = ff_calloc((size_t)frames, sizeof *raw);
    ff_status status = FF_OK;
    if (!pose || !raw)
        status = ff_fail(error, FF_ERR_NO_MEMORY, "%s: no memory for %d frames", clip->name, frames);
    else {
        for (int i = 0; i < frames; ++i) {
            ff_clip_pose(clip, clip->rest_frames + i, pose, NULL);
            raw[i] = pose[joint];
        }
        s->leg = ff_length3(ff_sub3(pose[hip], pose[knee])) + ff_length3(ff_sub3(pose[knee], pose[ankle]));
        ff_filter_despike(raw, frames, 1.0 / clip->frame_time);
        ff_filter_upsample(raw, frames, s->feet[0].factor, s->hips);
        ff_filter_low_pass3(s->hips, s->feet[0].count, s->feet[0].rate, 3.0);
    }
    free(pose);
    free(raw);
    return status;
}

static ff_status search_begin(search *s, const ff_clip *clip, const ff_find_settings *settings,
                              ff_plants *out, ff_error *error)
{
    memset(s, 0, sizeof *s);
    s->clip = clip;
    s->settings = settings;
    for (int foot = 0; foot < 2; ++foot) {
        ff_status status =
            ff_foot_signals_read(clip, foot, &settings->plants, &s->feet[foot], &out->shape[foot], error);
        if (status != FF_OK) return status;
    }
    size_t n = (size_t)s->feet[0].count;
    s->hips = ff_calloc(n, sizeof *s->hips);
    s->scratch = ff_calloc(n, sizeof *s->scratch);
    /* A contact and a swing take at least two working frames. */
    for (int foot = 0; foot < 2; ++foot)
        s->contacts[foot] = ff_calloc(n / 2 + 1, sizeof(ff_contact));
    if (!s->hips || !s->scratch || !s->contacts[0] || !s->contacts[1])
        return ff_fail(error, FF_ERR_NO_MEMORY, "%s: no memory for %zu working frames", clip->name, n);
    return read_hips(s, error);
}

/* Where the ball rests in a contact: median over its slower half. */
static ff_floor_sample resting_place(search *s, int foot, const ff_contact *c)
{
    const ff_foot_signals *f = &s->feet[foot];
    int n = c->last - c->first + 1;
    memcpy(s->scratch, f->speed[FF_FOOT_BALL] + c->first, (size_t)n * sizeof(double));
    double slow = ff_filter_quantile(s->scratch, n, 0.5);
    double median[3];
    int m = 0;
    for (int axis = 0; axis < 3; ++axis) {
        m = 0;
        for (int i = c->first; i <= c->last; ++i) {
            ff_vec3 p = f->point[FF_FOOT_BALL][i];
            if (f->speed[FF_FOOT_BALL][i] <= slow)
                s->scratch[m++] = axis == 0 ? p.x : (axis == 1 ? p.y : p.z);
        }
        median[axis] = ff_filter_quantile(s->scratch, m, 0.5);
    }
    return (ff_floor_sample){
        .foot = foot, .ball = ff_v3(median[0], median[1], median[2]), .weight = m / f->rate};
}

static ff_status fit_floor(search *s, ff_error *error)
{
    int total = s->count[0] + s->count[1], m = 0;
    ff_floor_sample *samples = ff_calloc((size_t)total + 1, sizeof *samples);
    if (!samples)
        return ff_fail(error, FF_ERR_NO_MEMORY, "%s: no memory for %d contacts", s->clip->name, total);
    for (int foot = 0; foot < 2; ++foot)
        for (int c = 0; c < s->count[foot]; ++c)
            samples[m++] = resting_place(s, foot, &s->contacts[foot][c]);
    if (m == 0) {
        /* Never slow: the lowest the ball gets has to do. */
        ff_vec3 lowest = s->feet[0].point[FF_FOOT_BALL][0];
        for (int i = 0; i < s->feet[0].count; ++i)
            if (s->feet[0].point[FF_FOOT_BALL][i].y < lowest.y) lowest = s->feet[0].point[FF_FOOT_BALL][i];
        samples[m++] = (ff_floor_sample){.foot = 0, .ball = lowest, .weight = 1.0};
    }
    s->floor = ff_floor_solve(&s->settings->floor, samples, m);
    free(samples);
    for (int foot = 0; foot < 2; ++foot)
        ff_floor_heights(&s->floor, foot, &s->feet[foot], s->scratch);
    return FF_OK;
}

/* 0 where the hips go at the speed of a walk, 1 at that of a run, and between in between. */
static double running_share(const search *s, const ff_contact *c)
{
    double walking = s->settings->plants.walking,
           running = ff_max(s->settings->plants.running, walking + 0.01);
    const ff_foot_signals *f = &s->feet[0];
    int reach = (int)(0.2 * f->rate), n = f->count;
    int from = c->first - reach > 0 ? c->first - reach : 0,
        to = c->last + reach < n ? c->last + reach : n - 1;
    ff_vec3 moved = ff_sub3(s->hips[to], s->hips[from]);
    double speed = to > from ? ff_length2(ff_plane(moved)) * f->rate / (to - from) : 0.0;
    return ff_clamp((speed - walking) / (running - walking), 0.0, 1.0);
}

/* Too little of a swing at the clip's start to tell that it was one, and of a contact at its end. */
static void mind_ends(search *s, int foot)
{
    ff_contact *contacts = s->contacts[foot];
    int *count = &s->count[foot], last = s->feet[foot].count - 1;
    double glimpse = GLIMPSE * s->feet[foot].rate;
    if (*count > 0 && contacts[0].first <= glimpse) contacts[0].first = 0;
    if (*count > 0 && last - contacts[*count - 1].first + 1 <= glimpse) --*count;
}

static void refine_foot(search *s, int foot)
{
    ff_contact *contacts = s->contacts[foot];
    int count = s->count[foot];
    for (int c = 0; c < count; ++c) {
        int previous = c > 0 ? contacts[c - 1].last : -1;
        int next = c + 1 < count ? contacts[c + 1].first : s->feet[foot].count;
        ff_contact_refine(&s->feet[foot], previous, next, running_share(s, &contacts[c]), &contacts[c]);
    }
    mind_ends(s, foot);
}

/* Is the foot, or the body it belongs to, somewhere else after this break? */
static bool tears(const search *s, const ff_break *b, int foot)
{
    if (b->repaired || !b->body) return false;
    if (b->kind == FF_BREAK_FROZEN) return true;
    ff_role first = foot == FF_LEFT ? FF_ROLE_HIP_R : FF_ROLE_HIP_L; /* the other leg */
    bool other = b->role >= first && b->role <= first + (FF_ROLE_BALL_L - FF_ROLE_HIP_L);
    return b->kind == FF_BREAK_JUMP && b->size > s->settings->breaks.torn && !other;
}

/* Cut the torn stretch out of the foot's contacts: what is left on either side is a contact of its own. */
static void cut_out(search *s, int foot, const ff_break *b)
{
    ff_contact *contacts = s->contacts[foot];
    int factor = s->feet[foot].factor, rest = s->clip->rest_frames, capacity = s->feet[foot].count / 2 + 1;
    int from = (b->first - rest) * factor, to = (b->last - rest) * factor,
        least = (int)(0.06 * s->feet[foot].rate);
    for (int c = 0; c < s->count[foot]; ++c) {
        ff_contact after = contacts[c];
        if (after.first > to || after.last < from) continue;
        after.first = after.first > to ? after.first : to + 1;
        contacts[c].last = contacts[c].last < from ? contacts[c].last : from - 1;
        bool keep_before = contacts[c].last - contacts[c].first >= least,
             keep_after = after.last - after.first >= least;
        if (keep_before && keep_after && s->count[foot] < capacity) {
            memmove(contacts + c + 1, contacts + c, (size_t)(s->count[foot] - c) * sizeof *contacts);
            ++s->count[foot];
            contacts[++c] = after;
        } else if (keep_after) {
            contacts[c] = after;
        } else if (!keep_before) {
            memmove(contacts + c, contacts + c + 1, (size_t)(s->count[foot] - c - 1) * sizeof *contacts);
            --s->count[foot];
            --c;
        }
    }
}

static void cut_out_breaks(search *s, const ff_breaks *breaks)
{
    for (int foot = 0; foot < 2; ++foot) {
        int before = s->count[foot];
        for (int i = 0; i < breaks->count; ++i)
            if (tears(s, &breaks->items[i], foot)) cut_out(s, foot, &breaks->items[i]);
        bool changed = s->count[foot] != before || breaks->count > 0;
        for (int c = 0; changed && c < s->count[foot]; ++c)
            ff_contact_find_flat(&s->feet[foot], running_share(s, &s->contacts[foot][c]),
                                 &s->contacts[foot][c]);
    }
}

/* The labels' idea of trust: 1 when the estimates agree, 0.8 with one unsure end, 0.7 or less for runs, cut ones and
 * ones that were never flat. */
static double confidence(const ff_contact *c, double running, bool cut)
{
    double trust = 1.0;
    if (c->start_spread > 0.045) trust -= 0.2;
    if (c->end_spread > 0.055) trust -= 0.2;
    if (cut) trust = ff_min(trust, 0.7);
    if (running > 0.5) trust = ff_min(trust, 0.7);
    if (c->flat_first < 0) trust -= 0.2;
    return ff_clamp(trust, 0.1, 1.0);
}

static void place(const ff_foot_signals *f, const ff_contact *c, ff_plant *plant, double *scratch)
{
    int from = c->flat_first >= 0 ? c->flat_first : c->first,
        to = c->flat_first >= 0 ? c->flat_last : c->last;
    const ff_vec3 *ball = f->point[FF_FOOT_BALL], *heel = f->point[FF_FOOT_HEEL];
    double median[3];
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = from; i <= to; ++i)
            scratch[i - from] = axis == 0 ? ball[i].z : (axis == 1 ? ball[i].x : ball[i].y);
        median[axis] = ff_filter_quantile(scratch, to - from + 1, 0.5);
    }
    plant->ball = ff_v2(median[0], median[1]);
    plant->ball_y = median[2];
    ff_vec2 along = ff_v2(0.0, 0.0);
    plant->slide = 0.0;
    for (int i = from; i <= to; ++i) {
        along = ff_add2(along, ff_plane(ff_sub3(ball[i], heel[i])));
        if (i > from) plant->slide += ff_length2(ff_plane(ff_sub3(ball[i], ball[i - 1])));
    }
    plant->yaw = ff_atan2(along.b, along.a);
}

/* Nearest clip frames inside a stretch of working frames. */
static int frame_up(const search *s, int i)
{
    int factor = s->feet[0].factor;
    return (i + factor / 2) / factor + s->clip->rest_frames;
}

static ff_plant make_plant(search *s, int foot, const ff_contact *c)
{
    bool cut_start = c->first == 0, cut_end = c->last == s->feet[foot].count - 1;
    ff_plant plant = {.foot = foot,
                      .start = frame_up(s, c->first),
                      .end = frame_up(s, c->last),
                      .flat_start = -1,
                      .flat_end = -1,
                      .cut_start = cut_start,
                      .cut_end = cut_end,
                      .confidence = confidence(c, running_share(s, c), cut_start || cut_end)};
    if (c->flat_first >= 0) {
        plant.flat_start = frame_up(s, c->flat_first);
        plant.flat_end = frame_up(s, c->flat_last);
    }
    place(&s->feet[foot], c, &plant, s->scratch);
    return plant;
}

static int by_start(const void *x, const void *y)
{
    const ff_plant *p = x, *q = y;
    if (p->start != q->start) return (p->start > q->start) - (p->start < q->start);
    /* Of two that the clip's start cuts, the one that leaves first came first. */
    return p->end != q->end ? (p->end > q->end) - (p->end < q->end) : p->foot - q->foot;
}

static ff_status collect(search *s, ff_plants *out, ff_error *error)
{
    int total = s->count[0] + s->count[1];
    out->frame_count = s->clip->frame_count;
    out->items = ff_calloc((size_t)total + 1, sizeof *out->items);
    out->tracks = ff_calloc((size_t)out->frame_count * 2, sizeof *out->tracks);
    if (!out->items || !out->tracks)
        return ff_fail(error, FF_ERR_NO_MEMORY, "%s: no memory for %d plants", s->clip->name, total);
    for (int foot = 0; foot < 2; ++foot) {
        for (int c = 0; c < s->count[foot]; ++c)
            out->items[out->count++] = make_plant(s, foot, &s->contacts[foot][c]);
        const ff_foot_signals *f = &s->feet[foot];
        for (int i = 0; i < out->frame_count; ++i) {
            int k = i < s->clip->rest_frames ? 0 : (i - s->clip->rest_frames) * f->factor;
            out->tracks[2 * i + foot] = (ff_foot_track){
                .heel_height = f->height[FF_FOOT_HEEL][k],
                .ball_height = f->height[FF_FOOT_BALL][k],
                .toe_height = f->height[FF_FOOT_TOE][k],
                .heel_speed = f->speed[FF_FOOT_HEEL][k],
                .ball_speed = f->speed[FF_FOOT_BALL][k],
                .toe_speed = f->speed[FF_FOOT_TOE][k],
            };
        }
    }
    qsort(out->items, (size_t)out->count, sizeof *out->items, by_start);
    return FF_OK;
}

static int working_frame(const search *s, int frame)
{
    int i = (frame - s->clip->rest_frames) * s->feet[0].factor, last = s->feet[0].count - 1;
    return i < 0 ? 0 : (i > last ? last : i);
}

/* Where a plant that a person wrote is, and when it is flat if that is not written. */
static void describe_written(search *s, ff_plant *p)
{
    const ff_foot_signals *f = &s->feet[p->foot];
    ff_contact c = {.first = working_frame(s, p->start), .last = working_frame(s, p->end)};
    ff_contact_find_flat(f, running_share(s, &c), &c);
    if (p->flat_start != FF_EDIT_LEAVE) {
        c.flat_first = p->flat_start >= 0 ? working_frame(s, p->flat_start) : -1;
        c.flat_last = p->flat_start >= 0 ? working_frame(s, p->flat_end) : -1;
    } else {
        p->flat_start = c.flat_first >= 0 ? frame_up(s, c.flat_first) : -1;
        p->flat_end = c.flat_first >= 0 ? frame_up(s, c.flat_last) : -1;
    }
    place(f, &c, p, s->scratch);
}

/* A person's word: what was found is kept beside it. */
static ff_status let_edit(search *s, const ff_plant_edits *edits, ff_plants *out, ff_error *error)
{
    ff_plant *items = ff_calloc((size_t)(out->count + edits->count) + 1, sizeof *items);
    if (!items)
        return ff_fail(error, FF_ERR_NO_MEMORY, "%s: no memory for %d plants", s->clip->name, out->count);
    int total = 0;
    ff_status status = FF_OK;
    for (int foot = 0; foot < 2 && status == FF_OK; ++foot) {
        int count = 0;
        status = ff_plant_edits_apply(edits, foot, s->clip->frame_count, out->items, out->count,
                                      items + total, &count, error);
        total += count;
    }
    for (int i = 0; i < total && status == FF_OK; ++i)
        if (items[i].written) describe_written(s, &items[i]);
    if (status != FF_OK) {
        free(items);
        return status;
    }
    out->found = out->items;
    out->found_count = out->count;
    out->items = items;
    out->count = total;
    qsort(out->items, (size_t)out->count, sizeof *out->items, by_start);
    return FF_OK;
}

static void describe_floor(const search *s, ff_plants *out)
{
    double ball = BALL_OVER_SOLE * s->leg;
    out->floor.base = 0.5 * (s->floor.level[FF_LEFT] + s->floor.level[FF_RIGHT]) - ball;
    out->floor.slope = s->floor.slope;
    for (int foot = 0; foot < 2; ++foot) {
        out->shape[foot].ball_height = s->floor.level[foot] - out->floor.base;
        out->shape[foot].ankle_height += out->shape[foot].ball_height;
    }
    for (int i = 0; i < out->count; ++i) {
        ff_plant *p = &out->items[i];
        double plane = s->floor.level[p->foot] + ff_dot2(s->floor.slope, p->ball), over = p->ball_y - plane;
        out->floor.residual = ff_max(out->floor.residual, fabs(over));
        p->level = p->flat_start >= 0 && fabs(over) > s->settings->plants.own_level ? over : 0.0;
    }
}

ff_status ff_plants_find(const ff_clip *clip, const ff_find_settings *settings, ff_plants *out,
                         ff_error *error)
{
    return ff_plants_find_edited(clip, settings, NULL, out, error);
}

ff_status ff_plants_find_edited(const ff_clip *clip, const ff_find_settings *settings,
                                const ff_plant_edits *edits, ff_plants *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    search s;
    ff_status status = search_begin(&s, clip, settings, out, error);
    if (status == FF_OK) status = ff_breaks_find(clip, &settings->breaks, &out->breaks, error);
    if (status == FF_OK) {
        int capacity = s.feet[0].count / 2 + 1;
        for (int foot = 0; foot < 2; ++foot)
            s.count[foot] = ff_contacts_by_speed(&s.feet[foot], s.contacts[foot], capacity);
        status = fit_floor(&s, error);
    }
    if (status == FF_OK) {
        double tolerance = settings->plants.above_floor + ABOVE_PER_SCATTER * s.floor.scatter;
        for (int foot = 0; foot < 2; ++foot) {
            s.count[foot] = ff_contacts_keep_low(&s.feet[foot], tolerance, s.contacts[foot], s.count[foot]);
            refine_foot(&s, foot);
        }
        cut_out_breaks(&s, &out->breaks);
        status = collect(&s, out, error);
    }
    if (status == FF_OK && edits) status = let_edit(&s, edits, out, error);
    if (status == FF_OK)
        describe_floor(&s, out);
    else
        ff_plants_free(out);
    search_free(&s);
    return status;
}

void ff_plants_free(ff_plants *plants)
{
    free(plants->items);
    free(plants->found);
    free(plants->tracks);
    ff_breaks_free(&plants->breaks);
    memset(plants, 0, sizeof *plants);
}
