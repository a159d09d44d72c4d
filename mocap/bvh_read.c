/* BVH in (algorithms A.3): hierarchy with any channels in any order, then one line of numbers per frame. */
#include "mocap/angles.h"
#include "mocap/read.h"
#include "mocap/text.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define MOST_CHANNELS 6

/* How a joint uses its channels. */
typedef struct plan {
    int channels;                       /* -1 = none given yet */
    unsigned char order[MOST_CHANNELS]; /* 0 1 2 = rotation about x y z, 3 4 5 = position */
    int rotations;
    int first_angle;
} plan;

typedef struct reader {
    ff_text text;
    bool strict;
    ff_clip *clip;
    ff_array joints, plans; /* ff_joint, plan */
    int open;               /* joint whose braces we are in, -1 = none */
    int channels, angles;   /* numbers per frame, those of them that are angles */
    uint16_t *slot;         /* where the n-th number of a row goes: angles first, then tracks by x y z */
    double *values, *sine, *cosine;
    ff_error *error;
} reader;

static ff_joint *joint_at(reader *r, int index)
{
    return (ff_joint *)r->joints.data + index;
}

static plan *plan_at(reader *r, int index)
{
    return (plan *)r->plans.data + index;
}

static ff_status expect_brace(reader *r)
{
    ff_text_skip(&r->text, false);
    ff_word word = ff_text_word(&r->text);
    if (word.length == 1 && *word.begin == '{') return FF_OK;
    return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error, "'%s' where '{' is expected",
                        ff_word_quote(word).text);
}

static ff_status add_joint(reader *r, ff_word name, bool end_site)
{
    if (r->joints.count >= FF_CLIP_MAX_JOINTS)
        return ff_text_fail(&r->text, name.begin, FF_ERR_RANGE, r->error, "more than %d joints",
                            FF_CLIP_MAX_JOINTS);
    ff_joint *joint = ff_array_grow(&r->joints, 1, sizeof(ff_joint));
    plan *channels = ff_array_grow(&r->plans, 1, sizeof(plan));
    if (!joint || !channels) return ff_fail(r->error, FF_ERR_NO_MEMORY, "no memory for the joints");
    memset(joint, 0, sizeof *joint);
    memset(channels, 0, sizeof *channels);
    channels->channels = -1;
    joint->parent = r->open;
    joint->track = -1;
    joint->role = FF_ROLE_NONE;
    joint->end_site = end_site;
    ff_status status = FF_OK;
    if (!ff_word_to_name(name, joint->name))
        status = ff_text_odd(&r->text, name.begin, r->strict, r->clip, r->error,
                             "name of more than 63 characters");
    r->open = (int)r->joints.count - 1;
    return status == FF_OK ? expect_brace(r) : status;
}

static ff_status read_joint(reader *r, ff_word keyword, bool root)
{
    if (root != (r->open < 0))
        return ff_text_fail(&r->text, keyword.begin, FF_ERR_PARSE, r->error,
                            root ? "ROOT inside another joint" : "JOINT outside any ROOT");
    if (r->open >= 0 && joint_at(r, r->open)->end_site)
        return ff_text_fail(&r->text, keyword.begin, FF_ERR_PARSE, r->error, "JOINT inside an End Site");
    ff_word name = ff_text_rest(&r->text, '{');
    if (name.length == 0)
        return ff_text_fail(&r->text, name.begin, FF_ERR_PARSE, r->error, "the joint has no name");
    return add_joint(r, name, false);
}

static ff_status read_end_site(reader *r, ff_word keyword)
{
    ff_word site = ff_text_word(&r->text);
    if (!ff_word_is(site, "site"))
        return ff_text_fail(&r->text, site.begin, FF_ERR_PARSE, r->error, "'End Site' is expected");
    if (r->open < 0 || joint_at(r, r->open)->end_site)
        return ff_text_fail(&r->text, keyword.begin, FF_ERR_PARSE, r->error, "End Site outside any joint");
    int parent = r->open;
    ff_text_rest(&r->text, '{'); /* some give it a name */
    ff_status status = add_joint(r, (ff_word){"end", 3}, true);
    if (status != FF_OK) return status;
    ff_joint *joint = joint_at(r, r->open);
    memcpy(joint->name, joint_at(r, parent)->name, sizeof joint->name);
    joint->name[59] = '\0';
    memcpy(joint->name + strlen(joint->name), "_end", 5);
    return FF_OK;
}

static int channel_of(ff_word word)
{
    static const char *const names[] = {"xrotation", "yrotation", "zrotation",
                                        "xposition", "yposition", "zposition"};
    for (int i = 0; i < 6; ++i)
        if (ff_word_is(word, names[i])) return i;
    return -1;
}

static ff_status read_channels(reader *r, ff_word keyword)
{
    plan *to = r->open < 0 ? NULL : plan_at(r, r->open);
    if (!to || to->channels >= 0)
        return ff_text_fail(&r->text, keyword.begin, FF_ERR_PARSE, r->error,
                            to ? "the joint has CHANNELS already" : "CHANNELS outside any joint");
    long long count;
    ff_status status =
        ff_text_integer(&r->text, "the number of channels", 0, MOST_CHANNELS, &count, r->error);
    if (status != FF_OK) return status;
    if (count > 0 && joint_at(r, r->open)->end_site)
        return ff_text_fail(&r->text, keyword.begin, FF_ERR_PARSE, r->error,
                            "an End Site cannot have channels");
    unsigned seen = 0;
    for (int i = 0; i < (int)count; ++i) {
        ff_text_skip(&r->text, false);
        ff_word word = ff_text_word(&r->text);
        int channel = channel_of(word);
        if (channel < 0)
            return ff_text_fail(
                &r->text, word.begin, FF_ERR_PARSE, r->error,
                "'%s' where the name of channel %d of %d is expected (Xrotation, Yposition ...)",
                ff_word_quote(word).text, i + 1, (int)count);
        if (seen & 1u << channel)
            return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error, "channel %s twice",
                                ff_word_quote(word).text);
        seen |= 1u << channel;
        to->order[i] = (unsigned char)channel;
        to->rotations += channel < 3;
    }
    to->channels = (int)count;
    ff_word more = ff_text_word(&r->text);
    if (channel_of(more) >= 0)
        return ff_text_fail(&r->text, more.begin, FF_ERR_PARSE, r->error,
                            "more channel names than the %d announced", (int)count);
    if (more.length > 0) r->text.cursor = more.begin;
    return FF_OK;
}

static ff_status read_offset(reader *r, ff_word keyword)
{
    if (r->open < 0)
        return ff_text_fail(&r->text, keyword.begin, FF_ERR_PARSE, r->error, "OFFSET outside any joint");
    return ff_text_vec3(&r->text, "the offset", &joint_at(r, r->open)->offset, r->error);
}

static ff_status read_hierarchy(reader *r)
{
    for (;;) {
        if (!ff_text_skip(&r->text, false))
            return ff_text_fail(&r->text, r->text.cursor, FF_ERR_PARSE, r->error,
                                r->open >= 0 ? "the file ends inside joint '%s'"
                                             : "the file ends before MOTION",
                                r->open >= 0 ? joint_at(r, r->open)->name : "");
        ff_word word = ff_text_word(&r->text);
        ff_status status;
        if (ff_word_is(word, "offset")) {
            status = read_offset(r, word);
        } else if (ff_word_is(word, "channels")) {
            status = read_channels(r, word);
        } else if (ff_word_is(word, "joint") || ff_word_is(word, "root")) {
            status = read_joint(r, word, ff_word_is(word, "root"));
        } else if (ff_word_is(word, "end")) {
            status = read_end_site(r, word);
        } else if (ff_word_is(word, "}") && r->open >= 0) {
            r->open = joint_at(r, r->open)->parent;
            status = FF_OK;
        } else if (ff_word_is(word, "motion") && r->open < 0) {
            return FF_OK;
        } else {
            return ff_text_fail(
                &r->text, word.begin, FF_ERR_PARSE, r->error,
                "'%s' where ROOT, JOINT, End Site, OFFSET, CHANNELS, '}' or MOTION is expected",
                ff_word_quote(word).text);
        }
        if (status != FF_OK) return status;
    }
}

/* Angles first, in the order of joints, then the tracks: what a row is unpacked into. */
static ff_status lay_out_row(reader *r)
{
    ff_clip *clip = r->clip;
    clip->joint_count = (int)r->joints.count;
    clip->joints = r->joints.data;
    r->joints = (ff_array){0};
    for (int j = 0; j < clip->joint_count; ++j) {
        plan *p = plan_at(r, j);
        if (p->channels < 0) p->channels = 0;
        p->first_angle = r->angles;
        r->angles += p->rotations;
        r->channels += p->channels;
        if (p->channels > p->rotations) clip->joints[j].track = clip->track_count++;
    }
    if (r->channels == 0)
        return ff_text_fail(&r->text, NULL, FF_ERR_NO_DATA, r->error,
                            "no joint has a channel: nothing moves");
    size_t whole = ff_angle_room((size_t)r->angles), room = whole + 3 * (size_t)clip->track_count;
    r->slot = ff_calloc((size_t)r->channels, sizeof *r->slot);
    r->values = ff_calloc(room, sizeof *r->values);
    r->sine = ff_calloc(whole, sizeof *r->sine);
    r->cosine = ff_calloc(whole, sizeof *r->cosine);
    if (!r->slot || !r->values || !r->sine || !r->cosine)
        return ff_fail(r->error, FF_ERR_NO_MEMORY, "no memory for a row of %d channels", r->channels);
    int n = 0;
    for (int j = 0; j < clip->joint_count; ++j) {
        plan *p = plan_at(r, j);
        int angle = p->first_angle, track = r->angles + 3 * clip->joints[j].track;
        if (clip->joints[j].track >= 0) /* coordinates without a channel stay as OFFSET has them */
            memcpy(r->values + track, &clip->joints[j].offset, sizeof(ff_vec3));
        for (int c = 0; c < p->channels; ++c)
            r->slot[n++] = (uint16_t)(p->order[c] < 3 ? angle++ : track + p->order[c] - 3);
    }
    return FF_OK;
}

/* One row into r->values. Returns its end, or NULL when anything at all is wrong with it. */
static const char *scan_row(const reader *r, const char *p)
{
    double largest = 0.0;
    for (int i = 0; i < r->channels; ++i) {
        double value;
        p = ff_number_scan(ff_skip_blanks(p), &value);
        if (!p) return NULL;
        r->values[r->slot[i]] = value;
        largest = ff_max(largest, fabs(value));
    }
    p = ff_skip_blanks(p);
    return *p == '\n' && largest <= FF_TEXT_LARGEST ? p : NULL;
}

static bool last_line(const ff_text *text)
{
    for (const char *p = memchr(text->cursor, '\n', (size_t)(text->end - text->cursor)); p < text->end; ++p)
        if ((unsigned char)*p > ' ') return false;
    return true;
}

/* Say what is wrong with the row at the cursor. Sets *dropped when it is a last row that was cut off. */
static ff_status explain_row(reader *r, bool *dropped)
{
    const char *p = ff_skip_blanks(r->text.cursor);
    int found = 0;
    for (double value; found < r->channels && *p != '\n'; ++found, p = ff_skip_blanks(p)) {
        const char *next = ff_number_scan(p, &value);
        if (!next || fabs(value) > FF_TEXT_LARGEST) break;
        p = next;
    }
    bool no_newline = r->text.copy != NULL;
    bool cut = *p == '\n' || (no_newline && ff_number_may_be_cut(p));
    if (found < r->channels && cut && last_line(&r->text) && r->clip->frame_count > 0) {
        *dropped = true;
        return ff_text_odd(&r->text, p, r->strict, r->clip, r->error,
                           "the last row was cut off after %d of %d values; it is dropped", found,
                           r->channels);
    }
    if (*p == '\n')
        return ff_text_fail(&r->text, p, FF_ERR_PARSE, r->error,
                            "the motion row has %d values, the skeleton needs %d", found, r->channels);
    if (found < r->channels) return ff_text_bad_number(&r->text, p, "a motion value", r->error);
    const char *surplus = p;
    for (double value; (p = ff_number_scan(p, &value)) != NULL; p = ff_skip_blanks(p))
        ++found;
    return ff_text_fail(&r->text, surplus, FF_ERR_PARSE, r->error,
                        "the motion row goes on (%d values or more), the skeleton needs %d", found,
                        r->channels);
}

static void store_frame(const reader *r)
{
    const ff_clip *clip = r->clip;
    const plan *plans = r->plans.data;
    ff_quat *rotations = clip->rotations + (size_t)clip->frame_count * (size_t)clip->joint_count;
    ff_half_sincos(r->values, (size_t)r->angles, true, r->sine, r->cosine);
    for (int j = 0; j < clip->joint_count; ++j) {
        const plan *p = &plans[j];
        const double *s = r->sine + p->first_angle, *c = r->cosine + p->first_angle;
        ff_quat q = FF_QUAT_IDENTITY;
        for (int i = 0; i < p->channels; ++i)
            if (p->order[i] < 3) q = ff_quat_turn(q, p->order[i], *s++, *c++);
        rotations[j] = q;
    }
    if (clip->track_count > 0)
        memcpy(clip->positions + (size_t)clip->frame_count * (size_t)clip->track_count, r->values + r->angles,
               (size_t)clip->track_count * sizeof(ff_vec3));
}

static ff_status read_motion_header(reader *r, long long *frames)
{
    ff_text *text = &r->text;
    ff_text_skip(text, false);
    ff_word word = ff_text_rest(text, ':');
    if (!ff_word_is(word, "frames") || *text->cursor != ':')
        return ff_text_fail(text, word.begin, FF_ERR_PARSE, r->error, "'Frames:' is expected");
    text->cursor++;
    const char *at = ff_skip_blanks(text->cursor);
    ff_status status = ff_text_integer(text, "the number of frames", 0, 10000000, frames, r->error);
    if (status != FF_OK) return status;
    long long fit = (text->end - text->cursor) / (2 * (long long)r->channels);
    if (*frames > 1000 + 64 * fit)
        return ff_text_fail(text, at, FF_ERR_RANGE, r->error,
                            "%lld frames are announced, the file has room for %lld at most", *frames, fit);
    ff_text_skip(text, false);
    word = ff_text_rest(text, ':');
    if (!(ff_word_is(word, "frame time") || ff_word_is(word, "frametime")) || *text->cursor != ':')
        return ff_text_fail(text, word.begin, FF_ERR_PARSE, r->error, "'Frame Time:' is expected");
    text->cursor++;
    at = ff_skip_blanks(text->cursor);
    status = ff_text_number(text, "the frame time", &r->clip->frame_time, r->error);
    if (status == FF_OK && !(r->clip->frame_time >= 1e-4 && r->clip->frame_time <= 1.0))
        status = ff_text_fail(text, at, FF_ERR_RANGE, r->error,
                              "a frame time of %g s is absurd (expected 0.0001 to 1, usually 0.0083 to 0.05)",
                              r->clip->frame_time);
    word = ff_text_word(text);
    if (status == FF_OK && word.length > 0)
        status = ff_text_fail(text, word.begin, FF_ERR_PARSE, r->error, "'%s' after the frame time",
                              ff_word_quote(word).text);
    return status;
}

static ff_status read_rows(reader *r, long long announced)
{
    ff_clip *clip = r->clip;
    int capacity = 0;
    long long fit = (r->text.end - r->text.cursor) / (2 * (long long)r->channels) + 1;
    int guess = (int)(announced < fit ? announced : fit);
    while (ff_text_skip(&r->text, false)) {
        ff_status status = ff_clip_reserve(clip, &capacity, clip->frame_count + 1, guess, r->error);
        if (status != FF_OK) return status;
        const char *end = scan_row(r, r->text.cursor);
        if (!end) {
            bool dropped = false;
            status = explain_row(r, &dropped);
            if (status != FF_OK) return status;
            if (dropped) break;
        }
        store_frame(r);
        clip->frame_count++;
        r->text.cursor = end;
        ff_text_next_line(&r->text);
    }
    if (clip->frame_count == 0)
        return ff_text_fail(&r->text, NULL, FF_ERR_NO_DATA, r->error, "there is no frame of motion");
    ff_clip_trim(clip, capacity);
    clip->rest_frames = ff_clip_count_rest_frames(clip);
    if (clip->frame_count == announced) return FF_OK;
    return ff_text_odd(&r->text, NULL, r->strict, clip, r->error,
                       "%d frames found, %lld announced; what is there is used", clip->frame_count,
                       announced);
}

static ff_status read_all(reader *r)
{
    ff_text_skip(&r->text, false);
    ff_word word = ff_text_word(&r->text);
    if (!ff_word_is(word, "hierarchy"))
        return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error,
                            "'%s' where HIERARCHY is expected: this is no BVH", ff_word_quote(word).text);
    long long frames = 0;
    ff_status status = read_hierarchy(r);
    if (status == FF_OK && r->joints.count == 0)
        status = ff_text_fail(&r->text, NULL, FF_ERR_NO_DATA, r->error, "the hierarchy has no joint");
    if (status == FF_OK) status = lay_out_row(r);
    if (status == FF_OK) status = read_motion_header(r, &frames);
    return status == FF_OK ? read_rows(r, frames) : status;
}

ff_status ff_bvh_parse(const char *data, size_t size, const char *name, const ff_load_options *options,
                       ff_clip *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    reader r = {.strict = options->strict, .clip = out, .open = -1, .error = error};
    ff_status status = ff_text_start(&r.text, data, size, name, error);
    if (status == FF_OK) status = read_all(&r);
    ff_text_end(&r.text);
    ff_array_free(&r.joints);
    ff_array_free(&r.plans);
    free(r.slot);
    free(r.values);
    free(r.sine);
    free(r.cosine);
    return ff_clip_read_end(status, name, out, error);
}
