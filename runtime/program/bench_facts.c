/* bench_facts.c - `footfall-crowd bench facts`: straight walks beside what people do (gait facts), and beside the pack's own
 * examples. */
#include "runtime/export/gait_facts.h"
#include "runtime/export/scene.h"
#include "runtime/program/bench.h"
#include "runtime/program/bench_options.h"
#include "runtime/program/walk_drive.h"

#include <stdio.h>
#include <stdlib.h>

#define STEP (1.0 / 120.0) /* s, as the reference was captured */
#define SECONDS 30.0
#define SETTLE 4.0 /* s, left out */

typedef struct facts_options {
    ff_bench_options common;
    const char *synthesis;
    int64_t seed;
} facts_options;

typedef struct facts_watch {
    const ff_gait_standard *standard;
    ff_fact_frame *frames;
    uint32_t seen, count;
} facts_watch;

static ff_status look(void *context, const ff_walk_pose *pose, ff_error *error)
{
    facts_watch *watch = context;
    (void)error;
    if (watch->seen++ >= (uint32_t)(SETTLE / STEP))
        watch->frames[watch->count++] = ff_fact_frame_of(watch->standard, pose->hips, pose->rotations);
    return FF_OK;
}

typedef struct facts_table {
    double walked[FF_BAND_COUNT][FF_FACT_COUNT], example[FF_BAND_COUNT][FF_FACT_COUNT];
} facts_table;

static ff_status fill(const ff_pack *pack, const facts_options *options, ff_synthesis synthesis,
                      facts_table *out, ff_error *error)
{
    ff_figure figure;
    ff_gait_standard standard;
    ff_status status = ff_figure_from_pack(pack, &figure, error);
    if (status == FF_OK) status = ff_gait_standard_make(pack, &figure, STEP, &standard, error);
    facts_watch watch = {.standard = &standard};
    watch.frames = ff_calloc((size_t)(SECONDS / STEP) + 2, sizeof *watch.frames);
    if (!watch.frames) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the poses of a walk");
    for (int band = 0; band < FF_BAND_COUNT && status == FF_OK; ++band) {
        double speed = ff_fact_speed(band);
        ff_course course = {.name = "", .kind = FF_COURSE_STEADY, .rates = {speed, 0.0, 0.0}, .walkers = 1};
        ff_walk_def def = {SECONDS, STEP, (uint64_t)options->seed, synthesis};
        watch.seen = watch.count = 0;
        status = ff_walk_drive(pack, &course, &def, look, &watch, error);
        if (status == FF_OK)
            status = ff_gait_facts_find(&standard, watch.frames, watch.count, out->walked[band], error);
        if (status == FF_OK)
            status = ff_gait_facts_of_example(pack, &standard, speed, out->example[band], error);
    }
    free(watch.frames);
    return status;
}

static void print_table(const facts_table *table)
{
    const ff_fact_reference *references = ff_fact_references();
    static const char *const bands[FF_BAND_COUNT] = {"slow", "normal", "fast"};
    printf("%-31s", "walked; the example; people, +- deviation");
    for (int band = 0; band < FF_BAND_COUNT; ++band)
        printf("   %-7s %.2f m/s              ", bands[band], ff_fact_speed(band));
    printf("\n");
    for (int k = 0; k < FF_FACT_COUNT; ++k) {
        printf("%-31s", references[k].name);
        for (int band = 0; band < FF_BAND_COUNT; ++band) {
            double value = table->walked[band][k], example = table->example[band][k];
            printf("   %7.3f %7.3f %7.3f +-%5.3f%s", value, example, references[k].mean[band],
                   references[k].deviation[band],
                   ff_fact_holds((ff_fact)k, band, value, example) ? " " : "!");
        }
        printf("\n");
    }
}

static json_t *table_json(const facts_table *table)
{
    const ff_fact_reference *references = ff_fact_references();
    json_t *rows = json_array();
    for (int band = 0; band < FF_BAND_COUNT; ++band)
        for (int k = 0; k < FF_FACT_COUNT; ++k)
            json_array_append_new(
                rows,
                json_pack("{s:s, s:f, s:f, s:f, s:f, s:f, s:b}", "fact", references[k].name, "speed",
                          ff_fact_speed(band), "walked", table->walked[band][k], "example",
                          table->example[band][k], "people", references[k].mean[band], "deviation",
                          references[k].deviation[band], "holds",
                          ff_fact_holds((ff_fact)k, band, table->walked[band][k], table->example[band][k])));
    return json_pack("{s:s, s:o}", "bench", "facts", "rows", rows);
}

static int run_facts(const facts_options *options, ff_synthesis synthesis)
{
    ff_error error = {0};
    ff_pack *pack = NULL;
    facts_table table;
    ff_status status = ff_pack_open(options->common.pack, &pack, &error);
    if (status == FF_OK) status = fill(pack, options, synthesis, &table, &error);
    if (status == FF_OK) print_table(&table);
    if (status == FF_OK && options->common.json)
        status = ff_bench_write_json(&options->common, "facts", table_json(&table), &error);
    ff_pack_close(pack);
    return status == FF_OK ? FF_EXIT_OK : ff_command_fail(FF_BENCH_PROGRAM, &error);
}

int ff_bench_facts_main(int argc, char **argv)
{
    facts_options given = {.synthesis = "blending", .seed = 1};
    const ff_option own[] = {{.name = "--synthesis",
                              .value_name = "NAME",
                              .help = "blending (default) or semi-procedural",
                              .text = &given.synthesis},
                             {.name = "--seed",
                              .value_name = "N",
                              .help = "of the walker's own style (default 1)",
                              .integer = &given.seed,
                              .low = 0,
                              .high = 1e9},
                             {0}};
    const ff_bench_command command = {
        .name = "bench facts", .summary = "straight walks beside what people do", .own = own};
    int status = ff_bench_parse(&command, argc, argv, &given.common);
    if (status >= 0) return status;
    ff_synthesis synthesis = ff_synthesis_named(given.synthesis);
    if (synthesis == FF_SYNTHESIS_CROWD)
        return ff_bench_misuse(&command, "--synthesis", given.synthesis, "blending or semi-procedural");
    return run_facts(&given, synthesis);
}
