#include "preprocess/build.h"

#include "runtime/tool/command_line.h"

#include <jansson.h>
#include <stdio.h>

#define PROGRAM "footfall-pack"

static void print_summary(const ff_build_result *built, const char *path, size_t size)
{
    const ff_pack_content *c = &built->content;
    const ff_pack_action *action = c->actions.data;
    const ff_pack_example *example = c->examples.data;
    size_t mirrored = 0, derived = 0;
    for (size_t i = 0; i < c->actions.count; ++i)
        mirrored += (action[i].flags & FF_ACTION_MIRRORED) != 0;
    for (size_t i = 0; i < c->examples.count; ++i)
        derived += (example[i].flags & FF_EXAMPLE_DERIVED) != 0;
    printf("%zu clips (%d left out), %zu plants, %zu actions and %zu mirrored ones\n", c->clips.count,
           built->skipped_count, c->plants.count, c->actions.count - mirrored, mirrored);
    printf("%zu examples to walk with (%zu of them made up), %zu simplices, velocity hull of %zu corners\n",
           c->examples.count, derived, c->simplices.count, c->hull.count);
    printf("wrote %s (%.1f MB)\n", path, 1e-6 * (double)size);
}

static void print_json(const ff_build_result *built, const char *path)
{
    const ff_pack_content *c = &built->content;
    json_t *skipped = json_array();
    char text[1024];
    for (int i = 0; i < built->skipped_count; ++i)
        json_array_append_new(skipped, json_string(ff_error_text(&built->skipped[i], text, sizeof text)));
    json_t *root = json_pack("{s:s, s:I, s:I, s:I, s:I, s:I, s:I, s:o}", "pack", path, "clips",
                             (json_int_t)c->clips.count, "plants", (json_int_t)c->plants.count, "actions",
                             (json_int_t)c->actions.count, "examples", (json_int_t)c->examples.count,
                             "simplices", (json_int_t)c->simplices.count, "hull_corners",
                             (json_int_t)c->hull.count, "skipped", skipped);
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

static int build_and_write(const ff_operands *operands, const ff_build_settings *settings, const char *path,
                           bool json)
{
    ff_build_result built = {0};
    size_t size = 0;
    ff_error error;
    char text[1024];
    ff_status status = build_from(operands, settings, &built, &error);
    for (int i = 0; i < built.skipped_count && !(status != FF_OK && settings->strict); ++i)
        fprintf(stderr, PROGRAM ": left out: %s\n", ff_error_text(&built.skipped[i], text, sizeof text));
    if (status == FF_OK) status = ff_pack_write(&built.content, path, &size, &error);
    if (status == FF_OK && json) print_json(&built, path);
    if (status == FF_OK && !json) print_summary(&built, path, size);
    ff_build_result_free(&built);
    return status == FF_OK ? FF_EXIT_OK : ff_command_fail(PROGRAM, &error);
}

int ff_build_command(int argc, char **argv)
{
    ff_build_settings settings = ff_build_settings_default();
    const char *path = NULL;
    int64_t threads = settings.threads;
    bool json = false, raw = false;
    ff_option options[] = {
        {.name = "--out",
         .alias = "-o",
         .value_name = "FILE",
         .help = "the pack to write (needed)",
         .text = &path},
        {.name = "--strict",
         .help = "a bad clip stops the build instead of being left out",
         .flag = &settings.strict},
        {.name = "--threads",
         .value_name = "N",
         .help = "threads to use; the pack does not depend on it",
         .integer = &threads,
         .low = 1,
         .high = 256},
        {.name = "--rate",
         .value_name = "HZ",
         .help = "poses per second of the clips in the pack",
         .number = &settings.rate,
         .low = 10,
         .high = 240},
        {.name = "--no-clean", .help = "leave feet sliding as they were captured", .flag = &raw},
        {.name = "--json", .help = "say on stdout what was built as JSON", .flag = &json},
        {.name = "--quiet", .alias = "-q", .help = "no progress on stderr", .flag = &settings.quiet},
        {0}};
    ff_command command = {
        .program = PROGRAM,
        .name = "build",
        .arguments = "[CATALOGUE|FOLDER|FILES...]",
        .summary = "make a motion pack from clips",
        .details = "A catalogue is a JSON file (mocap/README.md), a folder stands for every .amc and .bvh "
                   "below it.\n"
                   "Without any clip the built-in ones are used. The same clips give the same bytes.",
        .options = options,
        .max_operands = -1,
    };
    ff_operands operands;
    int result = ff_command_parse(&command, argc, argv, &operands);
    if (result < 0 && !path) result = ff_command_misuse(&command, "--out FILE (-o) is missing");
    settings.threads = (uint32_t)threads;
    settings.clean = !raw;
    if (result < 0) result = build_and_write(&operands, &settings, path, json);
    return result;
}
