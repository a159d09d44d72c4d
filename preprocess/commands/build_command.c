#include "preprocess/build/build.h"
#include "preprocess/commands/each_clip.h"

#include "runtime/core/base/file.h"
#include "runtime/tool/command_line.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PROGRAM "footfall-pack"
#define CACHE_ENDING ".cache"

static void print_summary(const ff_build_result *built, const char *path, size_t size)
{
    const ff_pack_content *c = &built->content;
    const ff_pack_action *action = c->actions.data;
    const ff_pack_example *example = c->examples.data;
    const ff_pack_clip *clip = c->clips.data;
    size_t mirrored = 0, derived = 0, made_clips = 0, made = 0;
    for (size_t i = 0; i < c->clips.count; ++i)
        made_clips += (clip[i].flags & FF_CLIP_DERIVED) != 0;
    for (size_t i = 0; i < c->actions.count; ++i) {
        bool mirror_image = (action[i].flags & FF_ACTION_MIRRORED) != 0;
        mirrored += mirror_image;
        made += !mirror_image && (action[i].flags & FF_ACTION_DERIVED);
    }
    for (size_t i = 0; i < c->examples.count; ++i)
        derived += (example[i].flags & FF_EXAMPLE_DERIVED) != 0;
    printf("%zu clips (%d left out), %zu plants, %zu actions (%zu of them made up) and %zu mirrored ones\n",
           c->clips.count - made_clips, built->skipped_count, c->plants.count, c->actions.count - mirrored,
           made, mirrored);
    printf("%zu examples to walk with (%zu of them made up), %zu simplices, velocity hull of %zu corners\n",
           c->examples.count, derived, c->simplices.count, c->hull.count);
    if (built->reused > 0)
        printf("%d of %d results of clips were there already\n", built->reused,
               built->reused + built->computed);
    printf("wrote %s (%.1f MB)\n", path, 1e-6 * (double)size);
}

static void print_json(const ff_build_result *built, const char *path)
{
    const ff_pack_content *c = &built->content;
    json_t *skipped = json_array();
    char text[1024];
    for (int i = 0; i < built->skipped_count; ++i)
        json_array_append_new(skipped, json_string(ff_error_text(&built->skipped[i], text, sizeof text)));
    json_t *root =
        json_pack("{s:s, s:I, s:I, s:I, s:I, s:I, s:I, s:i, s:i, s:o}", "pack", path, "clips",
                  (json_int_t)c->clips.count, "plants", (json_int_t)c->plants.count, "actions",
                  (json_int_t)c->actions.count, "examples", (json_int_t)c->examples.count, "simplices",
                  (json_int_t)c->simplices.count, "hull_corners", (json_int_t)c->hull.count, "reused",
                  built->reused, "computed", built->computed, "skipped", skipped);
    if (root && *built->warning) json_object_set_new(root, "warning", json_string(built->warning));
    if (root) json_dumpf(root, stdout, JSON_INDENT(1));
    printf("\n");
    json_decref(root);
}

static ff_status build_from(const ff_operands *operands, const ff_build_settings *settings,
                            ff_build_result *built, ff_error *error)
{
    if (operands->count == 0) return ff_build(NULL, settings, built, error);
    ff_catalogue catalogue;
    ff_status status = ff_catalogue_read(operands->items, operands->count, &catalogue, error);
    if (status != FF_OK) return status;
    status = ff_build(&catalogue, settings, built, error);
    ff_catalogue_free(&catalogue);
    return status;
}

/* What to know about how it went: on stderr, as it is not about the pack. */
static void print_left_out(const ff_build_result *built)
{
    char text[1024];
    for (int i = 0; i < built->skipped_count; ++i)
        fprintf(stderr, PROGRAM ": left out: %s\n", ff_error_text(&built->skipped[i], text, sizeof text));
}

/* A pack that no one could open must not take the place of one that works. */
static ff_status check_and_write(ff_pack_content *content, const char *path, size_t *size, ff_error *error)
{
    void *data;
    ff_pack *pack = NULL;
    ff_status status = ff_pack_image(content, &data, size, error);
    if (status != FF_OK) return status;
    status = ff_pack_open_memory(data, *size, &pack, error);
    ff_pack_close(pack);
    if (status == FF_OK) status = ff_file_write_atomic(path, data, *size, error);
    free(data);
    return status;
}

static int build_and_write(const ff_operands *operands, const ff_build_settings *settings, const char *path,
                           bool json)
{
    ff_build_result built = {0};
    size_t size = 0;
    ff_error error;
    ff_status status = build_from(operands, settings, &built, &error);
    print_left_out(&built);
    if (status == FF_OK) status = check_and_write(&built.content, path, &size, &error);
    if (status == FF_OK && *built.warning) fprintf(stderr, PROGRAM ": %s\n", built.warning);
    if (built.unkept > 0)
        fprintf(stderr,
                PROGRAM ": %s could not be written to; the next build will do this one's work again\n",
                settings->cache);
    if (status == FF_OK && json) print_json(&built, path);
    if (status == FF_OK && !json) print_summary(&built, path, size);
    int left_out = built.skipped_count;
    ff_build_result_free(&built);
    if (status != FF_OK) return ff_command_fail(PROGRAM, &error);
    return left_out > 0 ? FF_EXIT_FAILURE : FF_EXIT_OK;
}

/* Names and what they mean when the command's words are all read: configuration, then what options say, then the cache
 * beside the pack. Returns -1 to go on. */
typedef struct build_words {
    const char *path, *config, *cache, *skeleton;
    double rate;     /* 0 = not given */
    int64_t actions; /* 0 = not given */
    bool no_derived;
    int64_t threads;
    bool no_cache, raw, json;
} build_words;

static int settle(const ff_command *command, const build_words *words, ff_build_settings *settings,
                  char **own_cache)
{
    ff_error error;
    if (!words->path) return ff_command_misuse(command, "--out FILE (-o) is missing");
    if (words->cache && words->no_cache)
        return ff_command_misuse(command, "--cache and --no-cache exclude each other");
    if (words->config && ff_settings_load(words->config, &settings->pack, &error) != FF_OK)
        return ff_command_fail(PROGRAM, &error);
    if (words->rate > 0.0) settings->pack.poses.rate = words->rate;
    if (words->raw) settings->pack.cut.motion.clean = false;
    if (words->skeleton) {
        if (strlen(words->skeleton) >= FF_SETTING_PATH)
            return ff_command_misuse(command, "--skeleton: the path is too long");
        memcpy(settings->pack.rig.skeleton, words->skeleton, strlen(words->skeleton) + 1);
    }
    if (words->actions > 0) settings->pack.actions.count = words->actions;
    if (words->no_derived) settings->pack.actions.derive = false;
    settings->threads = (uint32_t)words->threads;
    settings->cache = words->cache;
    if (words->cache || words->no_cache) return -1;
    size_t size = strlen(words->path) + sizeof CACHE_ENDING;
    *own_cache = malloc(size);
    if (!*own_cache) return -1; /* built without */
    snprintf(*own_cache, size, "%s" CACHE_ENDING, words->path);
    settings->cache = *own_cache;
    settings->prune = true;
    return -1;
}

int ff_build_command(int argc, char **argv)
{
    ff_build_settings settings = ff_build_settings_default();
    build_words words = {.threads = settings.threads};
    ff_option options[] = {
        {.name = "--out",
         .alias = "-o",
         .value_name = "FILE",
         .help = "the pack to write (needed)",
         .text = &words.path},
        {.name = "--config",
         .value_name = "FILE",
         .help = "settings as JSON; 'footfall-pack config' prints them all",
         .text = &words.config},
        {.name = "--skeleton",
         .value_name = "FILE",
         .help = "clip or skeleton (.asf, .bvh, .gltf, .glb) whose body the pack has; default: the median",
         .text = &words.skeleton},
        {.name = "--skin",
         .value_name = "FILE",
         .help = "glTF character to draw instead of a body of capsules",
         .text = &settings.skin},
        {.name = "--strict",
         .help = "stop at the first bad clip instead of leaving it out",
         .flag = &settings.strict},
        {.name = "--cache",
         .value_name = "FOLDER",
         .help = "keep results of clips there; default: FILE" CACHE_ENDING,
         .text = &words.cache},
        {.name = "--no-cache", .help = "work everything out, keep nothing", .flag = &words.no_cache},
        FF_THREADS_OPTION(words.threads),
        {.name = "--rate",
         .value_name = "HZ",
         .help = "poses per second of the clips in the pack",
         .number = &words.rate,
         .low = 10,
         .high = 240},
        {.name = "--no-clean", .help = "leave feet sliding as they were captured", .flag = &words.raw},
        {.name = "--actions",
         .value_name = "N",
         .help = "keep the N best actions (their mirror images come on top); default: all",
         .integer = &words.actions,
         .low = 1,
         .high = 100000},
        {.name = "--no-derived",
         .help = "make up no start, stop, turn or side step that the clips lack",
         .flag = &words.no_derived},
        {.name = "--json", .help = "say on stdout what was built as JSON", .flag = &words.json},
        {.name = "--quiet", .alias = "-q", .help = "no progress on stderr", .flag = &settings.quiet},
        {0}};
    ff_command command = {
        .program = PROGRAM,
        .name = "build",
        .arguments = "[CATALOGUE|FOLDER|FILES...]",
        .summary = "make a motion pack from clips",
        .details =
            "A catalogue is a JSON file (mocap/README.md), a folder stands for every .amc and .bvh below "
            "it.\n"
            "Without any clip the built-in ones are used. The same clips and settings give the same bytes.\n"
            "Only what changed since the last build is worked out again.\n\n"
            "Exit status: 0 all clips are in the pack; 1 the pack was written without the clips named on "
            "stderr\n"
            "('left out: ...'), or, with another message, was not written; 2 the command line is wrong.",
        .options = options,
        .max_operands = -1,
    };
    ff_operands operands;
    char *own_cache = NULL;
    int result = ff_command_parse(&command, argc, argv, &operands);
    if (result < 0) result = settle(&command, &words, &settings, &own_cache);
    if (result < 0) result = build_and_write(&operands, &settings, words.path, words.json);
    free(own_cache);
    return result;
}
