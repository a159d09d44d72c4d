#include "preprocess/plants/breaks.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double TOGETHER = 0.03; /* s between wild frames of one break */
/* What a joint carries moves with it: a child is named only when it is off this many times as far as its parents. */
static const double CARRIED = 1.4;
static const double SPEED_WINDOW = 0.025; /* s */

typedef struct search {
    const ff_clip *clip;
    const ff_break_settings *settings;
    ff_vec3 *at; /* [frame_count][joint_count] */
    /* m, that a joint may be from where the two frames before and after have it: markers by 1.2 cm, and by what the blow
     * of a landing does, where the speed changes by 4 m/s within one frame (a third of it shows). */
    double limit;
    ff_array found;
    ff_error *error;
} search;

const char *ff_break_kind_name(ff_break_kind kind)
{
    static const char *const names[FF_BREAK_KIND_COUNT] = {"spike", "burst", "jump", "frozen"};
    return names[kind];
}

static ff_vec3 at(const search *s, int frame, int joint)
{
    return s->at[(size_t)frame * (size_t)s->clip->joint_count + (size_t)joint];
}

/* Fourth difference over 6: how far the frame is from the cubic through two frames before and two after it. */
static double off_course(const search *s, int frame, int joint)
{
    int rest = s->clip->rest_frames;
    if (frame < rest + 2 || frame + 2 >= s->clip->frame_count) return 0.0;
    ff_vec3 near = ff_add3(at(s, frame - 1, joint), at(s, frame + 1, joint));
    ff_vec3 far = ff_add3(at(s, frame - 2, joint), at(s, frame + 2, joint));
    ff_vec3 d = ff_madd3(ff_madd3(far, at(s, frame, joint), 6.0), near, -4.0);
    return ff_length3(d) / 6.0;
}

/* Trunk, legs and balls of the feet. Arms, head and toe tips may be wild without harm to a step. */
static bool is_body(ff_role role)
{
    return role == FF_ROLE_HIPS || role == FF_ROLE_SPINE || role == FF_ROLE_CHEST ||
           (role >= FF_ROLE_HIP_L && role <= FF_ROLE_BALL_L) ||
           (role >= FF_ROLE_HIP_R && role <= FF_ROLE_BALL_R);
}

/* The joint at which a frame is off; trunk and legs go before the rest, parents before children. -1 when none is. */
static int worst_joint(const search *s, int frame, double *off, bool *body)
{
    int worst = -1;
    *off = 0.0;
    *body = false;
    for (int j = 0; j < s->clip->joint_count; ++j) {
        ff_role role = s->clip->joints[j].role;
        if (role == FF_ROLE_NONE) continue;
        double d = off_course(s, frame, j);
        bool here = is_body(role);
        if (d <= s->limit || (*body && !here) || (*body == here && d <= CARRIED * *off)) continue;
        worst = j;
        *off = d;
        *body = here;
    }
    return worst;
}

/* Mean speed of the joints that play a role between two frames, m/s. */
static double body_speed(const search *s, int from, int to)
{
    double sum = 0.0;
    int joints = 0;
    for (int j = 0; j < s->clip->joint_count; ++j) {
        if (s->clip->joints[j].role == FF_ROLE_NONE) continue;
        sum += ff_length3(ff_sub3(at(s, to, j), at(s, from, j)));
        ++joints;
    }
    return joints > 0 && to > from ? sum / (joints * (to - from) * s->clip->frame_time) : 0.0;
}

static ff_status keep(search *s, ff_break b)
{
    ff_break *place = ff_array_grow(&s->found, 1, sizeof *place);
    if (!place)
        return ff_fail(s->error, FF_ERR_NO_MEMORY, "%s: no memory for what is broken in it", s->clip->name);
    *place = b;
    return FF_OK;
}

/* ------------------------------------------------------------------------------------------- off its course */

/* How far the joint is after the break from where it was going, m: the way over the break less what its speeds before
 * and after make of it. */
static double left_behind(const search *s, int first, int last, int joint)
{
    int window = (int)(SPEED_WINDOW / s->clip->frame_time);
    window = window > 0 ? window : 1;
    int before = first - 1, after = last + 1, rest = s->clip->rest_frames, n = s->clip->frame_count;
    int early = before - window > rest ? before - window : rest,
        late = after + window < n ? after + window : n - 1;
    if (before <= early || after >= late) return 0.0;
    ff_vec3 v0 = ff_scale3(ff_sub3(at(s, before, joint), at(s, early, joint)), 1.0 / (before - early));
    ff_vec3 v1 = ff_scale3(ff_sub3(at(s, late, joint), at(s, after, joint)), 1.0 / (late - after));
    ff_vec3 way = ff_sub3(at(s, after, joint), at(s, before, joint));
    return ff_length3(ff_madd3(way, ff_add3(v0, v1), -0.5 * (after - before)));
}

/* With this one frame put back, is the joint on its course? */
static bool one_frame_explains(search *s, int worst, int joint)
{
    ff_vec3 *place = &s->at[(size_t)worst * (size_t)s->clip->joint_count + (size_t)joint], kept = *place;
    *place = ff_lerp3(at(s, worst - 1, joint), at(s, worst + 1, joint), 0.5);
    bool smooth = true;
    for (int f = worst - 3; f <= worst + 3; ++f)
        if (f >= 0 && f < s->clip->frame_count && off_course(s, f, joint) > 0.5 * s->limit) smooth = false;
    *place = kept;
    return smooth;
}

/* Frames first to last are off: what is it? */
static ff_status name_break(search *s, int first, int last)
{
    ff_break b = {.first = first, .last = last, .role = FF_ROLE_NONE, .kind = FF_BREAK_BURST};
    int peak = first, worst = -1;
    for (int f = first; f <= last; ++f) {
        double off;
        bool body;
        int joint = worst_joint(s, f, &off, &body);
        if (joint < 0 || (b.body && !body) || (b.body == body && off <= b.size)) continue;
        worst = joint;
        b.role = s->clip->joints[joint].role;
        b.size = off;
        b.body = body;
        peak = f;
    }
    bool single = true;
    for (int j = 0; j < s->clip->joint_count && single; ++j)
        if (s->clip->joints[j].role != FF_ROLE_NONE && off_course(s, peak, j) > s->limit)
            single = one_frame_explains(s, peak, j);
    if (single && last - first <= 4) {
        b.kind = FF_BREAK_SPIKE;
        b.first = b.last = peak;
    } else if (worst >= 0 && left_behind(s, first, last, worst) > s->settings->jump) {
        b.kind = FF_BREAK_JUMP;
        b.size = left_behind(s, first, last, worst);
    }
    return keep(s, b);
}

static ff_status find_wild(search *s)
{
    int gap = (int)(TOGETHER / s->clip->frame_time), first = -1, last = -1;
    ff_status status = FF_OK;
    for (int f = s->clip->rest_frames + 2; f + 2 < s->clip->frame_count && status == FF_OK; ++f) {
        double off;
        bool body;
        if (worst_joint(s, f, &off, &body) < 0) continue;
        if (first >= 0 && f - last > gap + 1) {
            status = name_break(s, first, last);
            first = -1;
        }
        if (first < 0) first = f;
        last = f;
    }
    return first >= 0 && status == FF_OK ? name_break(s, first, last) : status;
}

/* ----------------------------------------------------------------------------------------------------- frozen */

static bool same_pose(const ff_clip *clip, int f, int g)
{
    size_t joints = (size_t)clip->joint_count, tracks = (size_t)clip->track_count;
    return memcmp(clip->rotations + (size_t)f * joints, clip->rotations + (size_t)g * joints,
                  joints * sizeof *clip->rotations) == 0 &&
           (tracks == 0 || memcmp(clip->positions + (size_t)f * tracks, clip->positions + (size_t)g * tracks,
                                  tracks * sizeof *clip->positions) == 0);
}

/* Frames first to last have one pose. A body that was moving up to the frame before, or moves on at once, was not at
 * rest. */
static ff_status judge_still(search *s, int first, int last)
{
    double before = first > s->clip->rest_frames ? body_speed(s, first - 1, first) : 0.0;
    double after = last + 1 < s->clip->frame_count ? body_speed(s, last, last + 1) : 0.0;
    double speed = ff_max(before, after);
    if (last <= first || speed < s->settings->moving) return FF_OK;
    return keep(s, (ff_break){first, last, FF_BREAK_FROZEN, FF_ROLE_NONE, speed, true, false});
}

static ff_status find_frozen(search *s)
{
    int first = s->clip->rest_frames;
    ff_status status = FF_OK;
    for (int f = first + 1; f <= s->clip->frame_count && status == FF_OK; ++f) {
        if (f < s->clip->frame_count && same_pose(s->clip, f - 1, f)) continue;
        status = judge_still(s, first, f - 1);
        first = f;
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------ whole */

static int by_place(const void *x, const void *y)
{
    const ff_break *p = x, *q = y;
    if (p->first != q->first) return (p->first > q->first) - (p->first < q->first);
    return (p->kind > q->kind) - (p->kind < q->kind);
}

ff_status ff_breaks_find(const ff_clip *clip, const ff_break_settings *settings, ff_breaks *out,
                         ff_error *error)
{
    memset(out, 0, sizeof *out);
    if (clip->drawn) return FF_OK;
    search s = {.clip = clip,
                .settings = settings,
                .limit = settings->off + settings->blow / 3.0 * clip->frame_time,
                .found = {0},
                .error = error};
    s.at = ff_calloc((size_t)clip->frame_count * (size_t)clip->joint_count, sizeof *s.at);
    if (!s.at)
        return ff_fail(error, FF_ERR_NO_MEMORY, "%s: no memory for %d poses", clip->name, clip->frame_count);
    for (int f = 0; f < clip->frame_count; ++f)
        ff_clip_pose(clip, f, s.at + (size_t)f * (size_t)clip->joint_count, NULL);
    ff_status status = find_wild(&s);
    if (status == FF_OK) status = find_frozen(&s);
    free(s.at);
    if (status != FF_OK) {
        ff_array_free(&s.found);
        return status;
    }
    out->items = s.found.data;
    out->count = (int)s.found.count;
    if (out->count > 1) qsort(out->items, (size_t)out->count, sizeof *out->items, by_place);
    return FF_OK;
}

/* The pose of a frame, half way between its neighbours. */
static void put_back(ff_clip *clip, int frame)
{
    size_t joints = (size_t)clip->joint_count, tracks = (size_t)clip->track_count;
    ff_quat *turn = clip->rotations + (size_t)frame * joints;
    ff_vec3 *place = clip->positions + (size_t)frame * tracks;
    for (size_t j = 0; j < joints; ++j)
        turn[j] = ff_quat_slerp(turn[j - joints], turn[j + joints], 0.5);
    for (size_t k = 0; k < tracks; ++k)
        place[k] = ff_lerp3(place[k - tracks], place[k + tracks], 0.5);
}

ff_status ff_breaks_repair(ff_clip *clip, const ff_break_settings *settings, ff_breaks *out, ff_error *error)
{
    ff_status status = ff_breaks_find(clip, settings, out, error);
    for (int i = 0; i < out->count; ++i) {
        ff_break *b = &out->items[i];
        /* Of a frame that stands twice, the second one is wrong. */
        bool doubled =
            b->kind == FF_BREAK_FROZEN && b->last == b->first + 1 && b->last + 1 < clip->frame_count;
        if (b->kind != FF_BREAK_SPIKE && !doubled) continue;
        put_back(clip, b->last);
        b->repaired = true;
    }
    return status;
}

void ff_breaks_free(ff_breaks *breaks)
{
    free(breaks->items);
    memset(breaks, 0, sizeof *breaks);
}

const ff_break *ff_breaks_within(const ff_breaks *breaks, int first, int last)
{
    for (int i = 0; i < breaks->count; ++i) {
        const ff_break *b = &breaks->items[i];
        if (b->body && !b->repaired && b->first <= last && b->last >= first) return b;
    }
    return NULL;
}

void ff_break_say(const ff_break *b, char *text, size_t size)
{
    char frames[48];
    const char *joint = ff_role_name(b->role);
    if (b->last > b->first)
        snprintf(frames, sizeof frames, "frames %d to %d", b->first, b->last);
    else
        snprintf(frames, sizeof frames, "frame %d", b->first);
    const char *after = b->repaired ? ", put back from the frames around" : "";
    switch (b->kind) {
    case FF_BREAK_FROZEN:
        snprintf(text, size, "%s: frozen in a motion of %.1f m/s%s", frames, b->size, after);
        break;
    case FF_BREAK_JUMP:
        snprintf(text, size, "%s: %s jumps by %.0f cm", frames, joint, 100.0 * b->size);
        break;
    default:
        snprintf(text, size, "%s: %s is up to %.1f cm off its course%s", frames, joint, 100.0 * b->size,
                 after);
    }
}
