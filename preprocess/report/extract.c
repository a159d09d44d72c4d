#include "preprocess/report/extract.h"

#include "preprocess/examples/example.h"
#include "preprocess/report/report_parts.h"
#include "runtime/core/base/fail.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* -------------------------------------------------------------------------------------------------------- names */

static uint32_t count_of(const ff_pack *pack, ff_part_kind kind)
{
    return kind == FF_PART_ACTION    ? pack->action_count
           : kind == FF_PART_EXAMPLE ? pack->example_count
                                     : pack->clip_count;
}

/* "action:", "example:" or "clip:" in front of name is taken off. */
static bool take_word(const char **name, ff_part_kind *kind)
{
    static const char *const words[] = {"action:", "example:", "clip:"};
    for (int i = 0; i < 3; ++i) {
        size_t length = strlen(words[i]);
        if (strncmp(*name, words[i], length) != 0) continue;
        *name += length;
        *kind = (ff_part_kind)i;
        return true;
    }
    return false;
}

static const char *name_of(const ff_pack *pack, ff_part_kind kind, uint32_t index)
{
    return ff_pack_string(pack,
                          kind == FF_PART_EXAMPLE ? pack->examples[index].name : pack->clips[index].name);
}

static bool find_name(const ff_pack *pack, const char *name, ff_part_kind kind, ff_part *out)
{
    for (uint32_t i = 0; kind != FF_PART_ACTION && i < count_of(pack, kind); ++i) {
        if (strcmp(name_of(pack, kind, i), name) != 0) continue;
        *out = (ff_part){kind, i};
        return true;
    }
    return false;
}

ff_status ff_part_find(const ff_pack *pack, const char *name, ff_part *out, ff_error *error)
{
    ff_part_kind kind = FF_PART_ACTION;
    const char *rest = name;
    bool worded = take_word(&rest, &kind);
    if (*rest && strspn(rest, "0123456789") == strlen(rest)) {
        unsigned long index = strtoul(rest, NULL, 10);
        *out = (ff_part){kind, (uint32_t)index};
        if (index < count_of(pack, kind)) return FF_OK;
        return ff_fail(error, FF_ERR_RANGE,
                       "there is no %s; the pack has actions 0 to %d, examples 0 to %d, clips 0 to %d", name,
                       (int)pack->action_count - 1, (int)pack->example_count - 1, (int)pack->clip_count - 1);
    }
    if ((!worded || kind == FF_PART_EXAMPLE) && find_name(pack, rest, FF_PART_EXAMPLE, out)) return FF_OK;
    if ((!worded || kind == FF_PART_CLIP) && find_name(pack, rest, FF_PART_CLIP, out)) return FF_OK;
    return ff_fail(error, FF_ERR_ARGUMENT,
                   "no example and no clip is called '%.60s'; expected NUMBER or action:NUMBER (0 to %d), "
                   "example:NUMBER "
                   "(0 to %d), clip:NUMBER (0 to %d) or a name that 'footfall-pack inspect' lists",
                   name, (int)pack->action_count - 1, (int)pack->example_count - 1,
                   (int)pack->clip_count - 1);
}

void ff_part_say(const ff_pack *pack, ff_part part, char *text, size_t size)
{
    if (part.kind == FF_PART_ACTION) {
        const ff_pack_action *a = &pack->actions[part.index];
        snprintf(text, size, "action %u (%s%s%s, of %s)", part.index, ff_report_mode(a->mode),
                 a->flags & FF_ACTION_MIRRORED ? ", mirrored" : "",
                 a->flags & FF_ACTION_DERIVED ? ", made up" : "",
                 ff_pack_string(pack, pack->clips[a->clip].name));
    } else {
        snprintf(text, size, "%s %s", part.kind == FF_PART_EXAMPLE ? "example" : "clip",
                 name_of(pack, part.kind, part.index));
    }
}

/* -------------------------------------------------------------------------------------------------------- poses */

/* Where in which stream a part lies. */
typedef struct stretch {
    uint32_t stream, flags;
    double from, seconds;
    const ff_pack_example *cycle; /* of an example: its rates move the root */
} stretch;

static stretch stretch_of(const ff_pack *pack, ff_part part, int cycles)
{
    if (part.kind == FF_PART_EXAMPLE) {
        const ff_pack_example *e = &pack->examples[part.index];
        return (stretch){.stream = e->stream, .seconds = cycles * (double)e->period, .cycle = e};
    }
    if (part.kind == FF_PART_CLIP) {
        uint32_t stream = pack->clips[part.index].stream;
        return (stretch){.stream = stream, .seconds = ff_pack_stream_seconds(pack, stream)};
    }
    const ff_pack_action *a = &pack->actions[part.index];
    const ff_pack_clip *clip = &pack->clips[a->clip];
    return (stretch){.stream = clip->stream,
                     .flags = a->flags & FF_ACTION_MIRRORED ? FF_SAMPLE_MIRRORED : 0,
                     .from = (double)a->t_0 - (double)clip->time_offset,
                     .seconds = (double)a->t_end - (double)a->t_0};
}

static void sample(const ff_pack *pack, const stretch *s, double at, ff_root_frame *root, ff_vec3 *hips,
                   ff_quat *rotations)
{
    ff_pack_sample(pack, s->stream, s->from + at, s->flags, root, hips, rotations, NULL);
    if (!s->cycle) return;
    ff_vec2 rate = ff_v2((double)s->cycle->v_forward, (double)s->cycle->v_left);
    root->position = ff_root_arc(rate, (double)s->cycle->turn_rate, at);
    root->heading = (double)s->cycle->turn_rate * at;
}

static ff_root_frame seen_from(const ff_root_frame *start, const ff_root_frame *root)
{
    ff_root_frame out;
    out.position = ff_to_frame2(ff_fwd2(start->heading), ff_sub2(root->position, start->position));
    out.heading = root->heading - start->heading;
    return out;
}

ff_status ff_part_record(const ff_pack *pack, ff_part part, double rate, int cycles, ff_recording *out,
                         ff_error *error)
{
    stretch s = stretch_of(pack, part, cycles);
    int poses = (int)ff_max(1.0, floor(s.seconds * rate + 0.5));
    double step =
        s.seconds > 0.0 ? s.seconds / poses : 1.0 / rate; /* so that the last pose is the last moment */
    ff_status status = ff_recording_create(1, pack->joint_count, step, (uint64_t)poses, out, error);
    out->pose_stride = 1;
    ff_root_frame start = {{0.0, 0.0}, 0.0};
    ff_vec2 last = {0.0, 0.0};
    for (int k = 0; k <= poses && status == FF_OK; ++k) {
        ff_root_frame root;
        ff_vec3 hips;
        ff_quat rotations[FF_PACK_MAX_JOINTS];
        sample(pack, &s, k * step, &root, &hips, rotations);
        if (k == 0) start = root;
        root = seen_from(&start, &root);
        ff_root_place(&root, &hips, &rotations[0]);
        status = ff_recording_begin(out, error);
        if (status != FF_OK) break;
        ff_agent_state state = {.position = root.position, .heading = root.heading};
        state.velocity = k > 0 ? ff_scale2(ff_sub2(root.position, last), 1.0 / step) : ff_v2(0.0, 0.0);
        last = root.position;
        ff_recording_set_track(out, 0, &state);
        ff_recording_set_pose(out, 0, hips, rotations);
    }
    if (status != FF_OK) ff_recording_free(out);
    return status;
}
