#include "preprocess/build/build.h"
#include "preprocess/commands/inspect_examples.h"
#include "preprocess/report/coverage.h"

#include "runtime/core/base/maths.h"
#include "runtime/core/pack/pack.h"
#include "runtime/tool/command_line.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#define PROGRAM "footfall-pack"

static const char *const mode_names[FF_MODE_COUNT] = {
    [FF_MODE_IDLE] = "idle",           [FF_MODE_WALK_SHORT] = "walk short",
    [FF_MODE_WALK_LONG] = "walk long", [FF_MODE_RUN] = "run",
    [FF_MODE_JUMP] = "jump",           [FF_MODE_CLIMB] = "climb",
    [FF_MODE_TURN] = "turn",           [FF_MODE_CROUCH] = "crouch",
    [FF_MODE_START] = "start",         [FF_MODE_STOP] = "stop"};

/* What a clip's poses amount to. */
static double clip_seconds(const ff_pack *pack, const ff_pack_clip *clip)
{
    const ff_pack_stream *stream = &pack->streams[clip->stream];
    return (stream->frame_count - 1) / (double)stream->rate;
}

static const char *example_kind(const ff_pack_example *example, char *text, size_t size)
{
    snprintf(text, size, "%s%s%s%s",
             example->flags & FF_EXAMPLE_IDLE ? "idle"
             : example->gait                  ? "run"
                                              : "walk",
             example->flags & FF_EXAMPLE_MIRRORED ? ", mirrored" : "",
             example->flags & FF_EXAMPLE_DERIVED ? ", made up" : "",
             example->flags & FF_EXAMPLE_LOOSE ? ", second best" : "");
    return text;
}

/* ------------------------------------------------------------------------------------------------- for people */

/* mm, from the poses of a clip's entry in META; 0 where there are none. */
static double stored_error(const json_t *poses, const char *member)
{
    return 1e3 * json_number_value(json_object_get(json_object_get(poses, "whole"), member));
}

static void print_clips(const ff_pack *pack)
{
    json_t *meta = json_loadb(pack->meta, (size_t)pack->meta_size, 0, NULL);
    printf("\nclips%67s\n  %-24s %7s %5s %6s %7s %5s %5s %5s  %s\n", "off by, mm", "name", "s", "Hz",
           "plants", "actions", "kB/s", "mean", "p99", "source");
    for (uint32_t i = 0; i < pack->clip_count; ++i) {
        const ff_pack_clip *clip = &pack->clips[i];
        const json_t *poses = json_object_get(json_array_get(json_object_get(meta, "clips"), i), "poses");
        printf("  %-24s %7.2f %5.0f %6u %7u %5.1f %5.2f %5.2f  %s\n", ff_pack_string(pack, clip->name),
               clip_seconds(pack, clip), (double)clip->source_rate, clip->plant_count, clip->action_count,
               1e-3 * json_number_value(json_object_get(poses, "bytes_per_second")),
               stored_error(poses, "mean"), stored_error(poses, "p99"), ff_pack_string(pack, clip->source));
    }
    json_decref(meta);
}

static void print_actions(const ff_pack *pack)
{
    printf("\nactions        as captured  mirrored  s (mean)  m (mean)\n");
    for (uint32_t mode = 0; mode < FF_MODE_COUNT; ++mode) {
        uint32_t plain = 0, mirrored = 0;
        double seconds = 0.0, metres = 0.0;
        for (uint32_t i = 0; i < pack->action_count; ++i) {
            const ff_pack_action *action = &pack->actions[i];
            if (action->mode != mode) continue;
            ++*(action->flags & FF_ACTION_MIRRORED ? &mirrored : &plain);
            seconds += (double)action->duration;
            metres +=
                ff_length2(ff_v2((double)action->root_displacement[0], (double)action->root_displacement[1]));
        }
        double all = plain + mirrored;
        if (all > 0.0)
            printf("  %-12s %11u %9u %9.2f %9.2f\n", mode_names[mode], plain, mirrored, seconds / all,
                   metres / all);
    }
}

static void print_coverage(const ff_pack *pack)
{
    if (pack->action_count == 0) return;
    ff_branching b = ff_coverage_branching(pack);
    printf("  %.0f actions may follow one (median; %u to %u); %u joints for want of better ones\n", b.median,
           b.least, b.most, b.forced);
    uint32_t guided = 0;
    for (uint32_t i = 0; i < pack->action_count; ++i)
        guided += pack->actions[i].reach != FF_REACH_NONE;
    printf("  planners take %u of them by default, guided by %u reach tables\n", guided, pack->reach_count);
    if (pack->collider_radii) {
        const float *r = pack->collider_radii;
        printf("  kept apart: head %.0f, hands %.0f, feet %.0f, hips %.0f cm about their middles\n",
               100.0 * (double)r[FF_COLLIDER_HEAD], 100.0 * (double)r[FF_COLLIDER_HAND_L],
               100.0 * (double)r[FF_COLLIDER_FOOT_L], 100.0 * (double)r[FF_COLLIDER_ROOT]);
    }
    for (int k = 0; k < ff_coverage_kinds(); ++k)
        if (ff_coverage_count(pack, k) == 0) printf("  no %s\n", ff_coverage_words(k));
}

static json_t *coverage_json(const ff_pack *pack)
{
    json_t *missing = json_array();
    ff_branching b = ff_coverage_branching(pack);
    for (int k = 0; k < ff_coverage_kinds(); ++k)
        if (ff_coverage_count(pack, k) == 0)
            json_array_append_new(missing, json_string(ff_coverage_words(k)));
    return json_pack("{s:f, s:i, s:i, s:i, s:o}", "successors_median", b.median, "successors_least",
                     (int)b.least, "successors_most", (int)b.most, "joints_forced", (int)b.forced, "missing",
                     missing);
}

static void print_examples(const ff_pack *pack)
{
    printf("\nexamples                                  forward   left   turn  cycle  seam  closing  jump   "
           "kick\n"
           "                                              m/s    m/s  deg/s      s    cm       cm    mm   "
           "cm/s\n");
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        const ff_pack_example *e = &pack->examples[i];
        char kind[48];
        const ff_pack_loop none = {0}, *loop = pack->loop_count ? &pack->loops[i] : &none;
        printf("  %-38.38s %8.2f %6.2f %6.0f %6.2f %5.1f %8.1f %5.2f %3.0f/%-3.0f  %s\n",
               ff_pack_string(pack, e->name), (double)e->v_forward, (double)e->v_left,
               (double)e->turn_rate / FF_DEG, (double)e->period, 100.0 * (double)e->seam,
               100.0 * (double)loop->moved, 1000.0 * (double)loop->jump, 100.0 * (double)loop->cut_kick,
               100.0 * (double)loop->contact_kick, example_kind(e, kind, sizeof kind));
    }
}

static void print_skin(const ff_pack *pack)
{
    if (pack->skin_count == 0) return;
    printf("\ncharacter:");
    for (uint32_t i = 0; i < pack->skin_count; ++i)
        printf("%s %u triangles", i ? "," : "", pack->skins[i].triangle_count);
    printf("\n");
}

static void print_hull(const ff_pack *pack)
{
    printf("\nvelocity hull (forward, left; m/s):");
    for (uint32_t i = 0; i < pack->hull_count; ++i)
        printf(" (%.2f, %.2f)", (double)pack->hull[i].f, (double)pack->hull[i].l);
    printf("\n");
}

/* Each distinct licence with its citation and how many clips are under it. */
static void print_licences(const ff_pack *pack)
{
    printf("\nlicences\n");
    for (uint32_t i = 0; i < pack->clip_count; ++i) {
        const ff_pack_clip *clip = &pack->clips[i];
        uint32_t same = 0, before = 0;
        for (uint32_t k = 0; k < pack->clip_count; ++k) {
            bool equal = pack->clips[k].licence == clip->licence && pack->clips[k].citation == clip->citation;
            same += equal;
            before += equal && k < i;
        }
        if (before) continue;
        const char *licence = ff_pack_string(pack, clip->licence),
                   *citation = ff_pack_string(pack, clip->citation);
        printf("  %u clips: %s\n", same, *licence ? licence : "not stated");
        if (*citation) printf("    %s\n", citation);
    }
}

/* Where the captures are broken. */
static void print_broken(const json_t *clips)
{
    size_t i, k, put_back = 0;
    const json_t *clip, *b;
    bool any = false;
    json_array_foreach(clips, i, clip) json_array_foreach(json_object_get(clip, "broken"), k, b)
    {
        if (!json_is_true(json_object_get(b, "cut"))) {
            ++put_back;
            continue;
        }
        const char *name = json_string_value(json_object_get(clip, "name"));
        const char *what = json_string_value(json_object_get(b, "what"));
        if (!any) printf("broken capture, cut out:\n");
        any = true;
        printf("  %s: %s\n", name ? name : "?", what ? what : "?");
    }
    if (put_back) printf("%zu wild frames of single joints were put back or do no harm\n", put_back);
}

static void print_provenance(const ff_pack *pack)
{
    json_error_t place;
    json_t *meta = json_loadb(pack->meta, (size_t)pack->meta_size, 0, &place);
    if (!meta) {
        printf("\nno provenance\n");
        return;
    }
    const char *tool = json_string_value(json_object_get(meta, "tool"));
    const char *version = json_string_value(json_object_get(meta, "version"));
    printf("\nbuilt by %s %s", tool ? tool : "an unknown tool", version ? version : "");
    size_t skipped = json_array_size(json_object_get(meta, "skipped"));
    if (skipped) printf("; %zu clips were left out:", skipped);
    printf("\n");
    for (size_t i = 0; i < skipped; ++i) {
        const json_t *entry = json_array_get(json_object_get(meta, "skipped"), i);
        const char *source = json_string_value(json_object_get(entry, "source"));
        const char *why = json_string_value(json_object_get(entry, "why"));
        printf("  %s: %s\n", source ? source : "?", why ? why : "?");
    }
    print_broken(json_object_get(meta, "clips"));
    json_decref(meta);
}

static void print_all(const ff_pack *pack, const char *path)
{
    printf("%s: %.1f MB, format %u, %u joints, %u clips, %u actions, %u examples\n", path,
           1e-6 * (double)pack->size, FF_PACK_VERSION, pack->joint_count, pack->clip_count,
           pack->action_count, pack->example_count);
    print_clips(pack);
    print_actions(pack);
    print_coverage(pack);
    print_examples(pack);
    print_hull(pack);
    print_skin(pack);
    print_licences(pack);
    print_provenance(pack);
}

/* ----------------------------------------------------------------------------------------------------- as JSON */

static json_t *clips_json(const ff_pack *pack)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < pack->clip_count; ++i) {
        const ff_pack_clip *c = &pack->clips[i];
        char hash[20];
        snprintf(hash, sizeof hash, "%016" PRIx64, c->source_hash);
        json_array_append_new(
            list, json_pack("{s:s, s:s, s:s, s:f, s:f, s:i, s:i, s:s, s:s}", "name",
                            ff_pack_string(pack, c->name), "source", ff_pack_string(pack, c->source), "hash",
                            hash, "seconds", clip_seconds(pack, c), "rate", (double)c->source_rate, "plants",
                            (int)c->plant_count, "actions", (int)c->action_count, "licence",
                            ff_pack_string(pack, c->licence), "tags", ff_pack_string(pack, c->tags)));
    }
    return list;
}

static json_t *actions_json(const ff_pack *pack)
{
    json_t *modes = json_object();
    for (uint32_t mode = 0; mode < FF_MODE_COUNT; ++mode) {
        int plain = 0, mirrored = 0;
        for (uint32_t i = 0; i < pack->action_count; ++i)
            if (pack->actions[i].mode == mode)
                ++*(pack->actions[i].flags & FF_ACTION_MIRRORED ? &mirrored : &plain);
        json_object_set_new(modes, mode_names[mode],
                            json_pack("{s:i, s:i}", "captured", plain, "mirrored", mirrored));
    }
    return modes;
}

static json_t *examples_json(const ff_pack *pack)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        const ff_pack_example *e = &pack->examples[i];
        const ff_pack_loop none = {0}, *loop = pack->loop_count ? &pack->loops[i] : &none;
        json_array_append_new(
            list,
            json_pack(
                "{s:s, s:s, s:b, s:b, s:b, s:b, s:f, s:f, s:f, s:f, s:f, s:[f, f, f, f], s:{s:f, s:f, s:f, "
                "s:f, s:f}}",
                "name", ff_pack_string(pack, e->name), "gait", e->gait ? "run" : "walk", "idle",
                (e->flags & FF_EXAMPLE_IDLE) != 0, "mirrored", (e->flags & FF_EXAMPLE_MIRRORED) != 0,
                "derived", (e->flags & FF_EXAMPLE_DERIVED) != 0, "loose", (e->flags & FF_EXAMPLE_LOOSE) != 0,
                "v_forward", (double)e->v_forward, "v_left", (double)e->v_left, "turn_rate",
                (double)e->turn_rate, "period", (double)e->period, "seam", (double)e->seam, "key",
                (double)e->key[0], (double)e->key[1], (double)e->key[2], (double)e->key[3], "loop", "cut",
                (double)loop->cut, "moved", (double)loop->moved, "jump", (double)loop->jump, "cut_kick",
                (double)loop->cut_kick, "contact_kick", (double)loop->contact_kick));
    }
    return list;
}

static json_t *hull_json(const ff_pack *pack)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < pack->hull_count; ++i)
        json_array_append_new(list, json_pack("[f, f]", (double)pack->hull[i].f, (double)pack->hull[i].l));
    return list;
}

static void print_json(const ff_pack *pack, const char *path)
{
    json_error_t place;
    json_t *meta = json_loadb(pack->meta, (size_t)pack->meta_size, 0, &place);
    json_t *root = json_pack("{s:s, s:I, s:i, s:i, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "pack", path, "bytes",
                             (json_int_t)pack->size, "joints", (int)pack->joint_count, "simplices",
                             (int)pack->simplex_count, "clips", clips_json(pack), "actions",
                             actions_json(pack), "coverage", coverage_json(pack), "examples",
                             examples_json(pack), "correspondences", ff_correspondences_json(pack), "hull",
                             hull_json(pack), "provenance", meta ? meta : json_null());
    if (root) json_dumpf(root, stdout, JSON_INDENT(1));
    printf("\n");
    json_decref(root);
}

int ff_inspect_command(int argc, char **argv)
{
    bool json = false, examples = false;
    ff_option options[] = {{.name = "--json", .help = "everything as JSON", .flag = &json},
                           {.name = "--examples",
                            .help = "how examples were closed to loops, and when to pass from one to another",
                            .flag = &examples},
                           {0}};
    ff_command command = {
        .program = PROGRAM,
        .name = "inspect",
        .arguments = "PACK",
        .summary =
            "say what is in a motion pack: clips, actions, examples, velocity hull, licences, provenance",
        .options = options,
        .min_operands = 1,
        .max_operands = 1,
    };
    ff_operands operands;
    int result = ff_command_parse(&command, argc, argv, &operands);
    if (result < 0) {
        ff_pack *pack;
        ff_error error;
        if (ff_pack_open(operands.items[0], &pack, &error) == FF_OK) {
            if (examples) {
                ff_inspect_examples(pack);
            } else {
                (json ? print_json : print_all)(pack, operands.items[0]);
            }
            ff_pack_close(pack);
            result = FF_EXIT_OK;
        } else {
            result = ff_command_fail(PROGRAM, &error);
        }
    }
    return result;
}
