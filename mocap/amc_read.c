/* AMC in: the motion of an ASF skeleton (algorithms A.2). A line with one whole number starts a frame, then one line per
 * bone with its values. A bone that a frame leaves out keeps its last value. */
#include "mocap/angles.h"
#include "mocap/read.h"
#include "mocap/text.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* What a bone's line holds and where it goes. */
typedef struct line_plan {
    const ff_asf_bone *bone;
    size_t name_length;
    uint16_t slot[6]; /* into values: angles first, then the root's translation */
    int first_angle, angles;
    int next;       /* bone whose line followed this one's last time: nearly always right again */
    int last_frame; /* in which the bone was seen, to tell a bone that comes twice */
} line_plan;

typedef struct reader {
    ff_text text;
    bool strict, degrees;
    const ff_asf *asf;
    ff_clip *clip;
    line_plan *plans; /* [bone_count] */
    int moving;       /* bones with a dof */
    int angles;
    double *values, *sine, *cosine;
    int capacity;
    int last;   /* bone of the last line */
    int seen;   /* bones of the current frame */
    int number; /* of the current frame, as printed */
    int frames; /* begun; the last is stored when it is complete */
    const char *first_begin;
    bool cut; /* the text stops in the middle of the last line */
    ff_error *error;
} reader;

static ff_status plan_lines(reader *r)
{
    const ff_asf *asf = r->asf;
    for (int b = 0; b < asf->bone_count; ++b)
        for (int i = 0; i < asf->bones[b].dof_count; ++i)
            r->angles += asf->bones[b].dof[i] < 3;
    r->plans = ff_calloc((size_t)asf->bone_count, sizeof *r->plans);
    size_t room = ff_angle_room((size_t)r->angles);
    r->values = ff_calloc(room + 3, sizeof *r->values);
    r->sine = ff_calloc(room, sizeof *r->sine);
    r->cosine = ff_calloc(room, sizeof *r->cosine);
    r->clip->joints = ff_calloc((size_t)asf->joint_count, sizeof *asf->joints);
    if (!r->plans || !r->values || !r->sine || !r->cosine || !r->clip->joints)
        return ff_fail(r->error, FF_ERR_NO_MEMORY, "no memory for the skeleton");
    int angle = 0;
    for (int b = 0; b < asf->bone_count; ++b) {
        line_plan *plan = &r->plans[b];
        plan->bone = &asf->bones[b];
        plan->name_length = strlen(plan->bone->name);
        plan->first_angle = angle;
        plan->next = b + 1 < asf->bone_count ? b + 1 : 0;
        plan->last_frame = -1;
        for (int i = 0; i < plan->bone->dof_count; ++i) {
            int dof = plan->bone->dof[i];
            plan->slot[i] = (uint16_t)(dof < 3 ? angle++ : r->angles + dof - 3);
        }
        plan->angles = angle - plan->first_angle;
        r->moving += plan->bone->dof_count > 0;
    }
    memcpy(r->clip->joints, asf->joints, (size_t)asf->joint_count * sizeof *asf->joints);
    r->clip->joint_count = asf->joint_count;
    r->clip->track_count = 1;
    r->clip->warning_count = asf->warning_count;
    memcpy(r->clip->warning, asf->warning, sizeof r->clip->warning);
    return FF_OK;
}

static bool line_is_of(const reader *r, int bone, const char *p)
{
    const line_plan *plan = &r->plans[bone];
    size_t length = plan->name_length;
    return (size_t)(r->text.end - p) > length && memcmp(p, plan->bone->name, length) == 0 &&
           (unsigned char)p[length] <= ' ';
}

/* Local rotation C M C^-1. The values of a bone turn about fixed axes in the order written, so that the last is the
 * leftmost factor; C only turns the axis of M. */
static ff_quat bone_rotation(const reader *r, const line_plan *plan)
{
    ff_quat q = FF_QUAT_IDENTITY;
    int angle = plan->first_angle + plan->angles;
    for (int i = plan->bone->dof_count - 1; i >= 0; --i) {
        if (plan->bone->dof[i] > 2) continue;
        --angle;
        q = ff_quat_turn(q, plan->bone->dof[i], r->sine[angle], r->cosine[angle]);
    }
    if (!plan->bone->turned) return q;
    const double *c = plan->bone->axis;
    return (ff_quat){c[0] * q.x + c[1] * q.y + c[2] * q.z, c[3] * q.x + c[4] * q.y + c[5] * q.z,
                     c[6] * q.x + c[7] * q.y + c[8] * q.z, q.w};
}

static void store_frame(reader *r)
{
    ff_clip *clip = r->clip;
    ff_quat *rotations = clip->rotations + (size_t)clip->frame_count * (size_t)clip->joint_count;
    ff_half_sincos(r->values, (size_t)r->angles, r->degrees, r->sine, r->cosine);
    for (int j = 0; j < clip->joint_count; ++j)
        rotations[j] = FF_QUAT_IDENTITY;
    for (int b = 0; b < r->asf->bone_count; ++b)
        if (r->plans[b].angles > 0) rotations[r->plans[b].bone->joint] = bone_rotation(r, &r->plans[b]);
    const double *moved = r->values + r->angles;
    clip->positions[clip->frame_count++] = ff_add3(r->asf->position, ff_v3(moved[0], moved[1], moved[2]));
}

/* Frames like the first: how many does the file hold? */
static int guess_frames(const reader *r)
{
    if (r->frames != 1) return 0;
    size_t each = (size_t)(r->text.cursor - r->first_begin);
    size_t left = (size_t)(r->text.end - r->text.cursor);
    size_t guess = 2 + left / (each > 8 ? each - each / 16 : 8);
    return guess < 1000000 ? (int)guess : 1000000;
}

static ff_status end_frame(reader *r)
{
    if (r->seen == 0)
        return ff_text_fail(&r->text, NULL, FF_ERR_PARSE, r->error, "frame %d holds no bone", r->number);
    ff_status status = FF_OK;
    if (r->seen < r->moving)
        status = ff_text_odd(&r->text, NULL, r->strict, r->clip, r->error,
                             "frame %d holds %d of the %d bones that move; the others keep their last values",
                             r->number, r->seen, r->moving);
    if (status == FF_OK)
        status = ff_clip_reserve(r->clip, &r->capacity, r->clip->frame_count + 1, guess_frames(r), r->error);
    if (status == FF_OK) store_frame(r);
    return status;
}

static ff_status begin_frame(reader *r)
{
    const char *at = r->text.cursor;
    if (r->frames > 0) {
        ff_status status = end_frame(r);
        if (status != FF_OK) return status;
    } else {
        r->first_begin = at;
    }
    long long number;
    ff_status status =
        ff_text_integer(&r->text, "the frame number", -1000000000, 1000000000, &number, r->error);
    if (status != FF_OK) return status;
    ff_word more = ff_text_word(&r->text);
    if (more.length > 0)
        return ff_text_fail(&r->text, more.begin, FF_ERR_PARSE, r->error, "'%s' after the frame number",
                            ff_word_quote(more).text);
    if (r->frames > 0 && number != r->number + 1)
        status = ff_text_odd(&r->text, at, r->strict, r->clip, r->error, "frame %lld follows frame %d",
                             number, r->number);
    if (r->frames == 0) r->clip->first_frame = (int)number;
    r->number = (int)number;
    r->frames++;
    r->seen = 0;
    return status;
}

/* The current line is the last one and has no end, and there are whole frames before it. */
static bool may_be_cut(const reader *r)
{
    return r->text.copy && r->frames > 1 &&
           memchr(r->text.cursor, '\n', (size_t)(r->text.end - r->text.cursor)) == r->text.end - 1;
}

static int find_bone(const reader *r, const char *p)
{
    for (int b = 0; b < r->asf->bone_count; ++b)
        if (line_is_of(r, b, p)) return b;
    return -1;
}

/* Say what is wrong with the line of a bone. */
static ff_status explain_line(reader *r, const line_plan *plan)
{
    const char *p = ff_skip_blanks(r->text.cursor + plan->name_length);
    int found = 0;
    for (double value; found < plan->bone->dof_count && *p != '\n'; ++found, p = ff_skip_blanks(p)) {
        const char *next = ff_number_scan(p, &value);
        if (!next || fabs(value) > FF_TEXT_LARGEST) break;
        p = next;
    }
    if (found < plan->bone->dof_count && may_be_cut(r) && ff_number_may_be_cut(p)) {
        r->cut = true;
        return FF_OK;
    }
    if (found < plan->bone->dof_count && *p != '\n')
        return ff_text_bad_number(&r->text, p, "a bone's value", r->error);
    return ff_text_fail(&r->text, p, FF_ERR_PARSE, r->error,
                        "bone '%s' has %s values, its dof in the ASF has %d", plan->bone->name,
                        found < plan->bone->dof_count ? "fewer" : "more", plan->bone->dof_count);
}

static ff_status read_bone_line(reader *r)
{
    const char *p = r->text.cursor;
    int bone = r->plans[r->last].next;
    if (!line_is_of(r, bone, p)) {
        bone = find_bone(r, p);
        if (bone < 0 && may_be_cut(r)) {
            r->cut = true;
            return FF_OK;
        }
        if (bone < 0) {
            ff_word word = ff_text_word(&r->text);
            return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error, "bone '%s' is not in the ASF",
                                ff_word_quote(word).text);
        }
        r->plans[r->last].next = bone;
    }
    line_plan *plan = &r->plans[bone];
    if (plan->last_frame == r->frames)
        return ff_text_fail(&r->text, p, FF_ERR_PARSE, r->error, "bone '%s' twice in frame %d",
                            plan->bone->name, r->number);
    plan->last_frame = r->frames;
    r->last = bone;
    r->seen += plan->bone->dof_count > 0;
    p += plan->name_length;
    for (int i = 0; i < plan->bone->dof_count; ++i) {
        double value;
        p = ff_number_scan(ff_skip_blanks(p), &value);
        if (!p || fabs(value) > FF_TEXT_LARGEST) return explain_line(r, plan);
        r->values[plan->slot[i]] = value;
    }
    p = ff_skip_blanks(p);
    if (*p != '\n') return explain_line(r, plan);
    r->text.cursor = r->text.line_start = p + 1;
    r->text.line++;
    return FF_OK;
}

static ff_status read_header_word(reader *r)
{
    ff_word word = ff_text_word(&r->text);
    if (r->frames > 0)
        return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error, "'%s' after the first frame",
                            ff_word_quote(word).text);
    if (ff_word_is(word, ":fully-specified")) return FF_OK;
    if (ff_word_is(word, ":degrees") || ff_word_is(word, ":radians")) {
        r->degrees = ff_word_is(word, ":degrees");
        return FF_OK;
    }
    if (ff_word_is(word, ":samples-per-second")) {
        const char *at = ff_skip_blanks(r->text.cursor);
        double rate;
        ff_status status = ff_text_number(&r->text, "the frame rate", &rate, r->error);
        if (status == FF_OK && !(rate >= 1.0 && rate <= 10000.0))
            status = ff_text_fail(&r->text, at, FF_ERR_RANGE, r->error, "%g frames/s is absurd", rate);
        if (status == FF_OK) r->clip->frame_time = 1.0 / rate;
        return status;
    }
    return ff_text_odd(&r->text, word.begin, r->strict, r->clip, r->error, "unknown keyword '%s'",
                       ff_word_quote(word).text);
}

static ff_status read_lines(reader *r)
{
    while (ff_text_skip(&r->text, true)) {
        char c = *r->text.cursor;
        ff_status status;
        if ((c >= '0' && c <= '9') || c == '-' || c == '+') {
            status = begin_frame(r);
            if (status == FF_OK) ff_text_next_line(&r->text);
        } else if (c == ':') {
            status = read_header_word(r);
            if (status == FF_OK) ff_text_next_line(&r->text);
        } else if (r->frames == 0) {
            ff_word word = ff_text_word(&r->text);
            status = ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error,
                                  "'%s' where the number of the first frame is expected: this is no AMC",
                                  ff_word_quote(word).text);
        } else {
            status = read_bone_line(r);
        }
        if (status != FF_OK) return status;
        if (r->cut) break;
    }
    if (r->frames == 0)
        return ff_text_fail(&r->text, NULL, FF_ERR_NO_DATA, r->error, "there is no frame of motion");
    ff_status status;
    if (r->frames > 1 && (r->cut || r->seen < r->moving)) {
        status = ff_text_odd(&r->text, NULL, r->strict, r->clip, r->error,
                             "the last frame, %d, was cut off; it is dropped", r->number);
    } else {
        status = end_frame(r);
    }
    if (status != FF_OK) return status;
    ff_clip_trim(r->clip, r->capacity);
    r->clip->rest_frames = ff_clip_count_rest_frames(r->clip); /* 09_10 begins with four frames of zeros */
    return FF_OK;
}

ff_status ff_amc_parse(const ff_asf *asf, const char *data, size_t size, const char *name,
                       const ff_load_options *options, ff_clip *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    reader r = {.strict = options->strict, .degrees = asf->degrees, .asf = asf, .clip = out, .error = error};
    ff_status status = ff_text_start(&r.text, data, size, name, error);
    out->frame_time = 1.0 / 120.0; /* the format has no rate; CMU's is 120 */
    if (status == FF_OK) status = plan_lines(&r);
    if (status == FF_OK) status = read_lines(&r);
    ff_text_end(&r.text);
    free(r.plans);
    free(r.values);
    free(r.sine);
    free(r.cosine);
    return ff_clip_read_end(status, name, out, error);
}
