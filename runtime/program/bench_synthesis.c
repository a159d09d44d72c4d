/* bench_synthesis.c - `footfall-crowd bench synthesis`: what a pose costs, from stored motions to matrices, and what legs
 * add to it. */
#define _POSIX_C_SOURCE 199309L
#include "runtime/core/base/file.h"
#include "runtime/export/bars.h"
#include "runtime/export/metrics.h"
#include "runtime/export/text.h"
#include "runtime/program/bench.h"
#include "runtime/program/bench_options.h"
#include "runtime/program/synthesis_load.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SIZES = 3, SKELETONS = 2, ROWS_MOST = SIZES * SKELETONS * 2, REPEATS_MOST = 1000 };

typedef struct synthesis_options {
    ff_bench_options common;
    int64_t characters, repeats;
} synthesis_options;

/* us per character: median and least of the repeats. */
typedef struct synthesis_time {
    double median, least;
} synthesis_time;

typedef struct synthesis_row {
    uint32_t characters, joints;
    bool simd;
    synthesis_time blend, legs;
} synthesis_row;

typedef struct synthesis_table {
    const synthesis_options *options;
    synthesis_row row[ROWS_MOST];
    int count;
} synthesis_table;

/* Of this thread: not what other programs take. */
static double cpu_time(void)
{
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static synthesis_time measure(ff_synthesis_load *load, uint32_t characters, int64_t repeats, bool simd,
                              bool legs)
{
    double us[REPEATS_MOST];
    uint32_t rounds = 1 + 10000 / characters; /* of a few characters: enough for the clock */
    for (int64_t i = 0; i < repeats; ++i) {
        double start = cpu_time();
        for (uint32_t k = 0; k < rounds; ++k)
            ff_synthesis_load_run(load, simd, legs);
        us[i] = 1e6 * (cpu_time() - start) / ((double)characters * rounds);
    }
    return (synthesis_time){ff_quantile(us, (size_t)repeats, 0.5), ff_quantile(us, (size_t)repeats, 0.0)};
}

static ff_status measure_size(synthesis_table *table, const ff_pack *pack, uint32_t joints,
                              uint32_t characters, ff_error *error)
{
    ff_synthesis_load *load = NULL;
    ff_status status = ff_synthesis_load_create(pack, joints, characters, &load, error);
    for (int simd = 1; simd >= 0 && status == FF_OK; --simd) {
        synthesis_row *row = &table->row[table->count++];
        int64_t repeats = table->options->repeats;
        *row = (synthesis_row){.characters = characters, .joints = joints, .simd = simd};
        ff_synthesis_load_run(load, simd, true); /* touch all memory once */
        row->blend = measure(load, characters, repeats, simd, false);
        row->legs = measure(load, characters, repeats, simd, true);
        if (!isfinite(ff_synthesis_load_sum(load)))
            status = ff_fail(error, FF_ERR_NOT_FINITE, "a matrix of %u joints is not finite", joints);
    }
    ff_synthesis_load_destroy(load);
    return status;
}

static ff_status measure_all(synthesis_table *table, const ff_pack *pack, ff_error *error)
{
    static const uint32_t sizes[SIZES] = {100, 1000, 10000},
                          skeletons[SKELETONS] = {FF_LOAD_JOINTS, FF_JOINT_COUNT};
    ff_status status = FF_OK;
    for (int k = 0; k < SKELETONS; ++k)
        for (int i = 0; i < SIZES && status == FF_OK; ++i) {
            if (table->options->characters > 0 && i > 0) break;
            uint32_t characters =
                table->options->characters > 0 ? (uint32_t)table->options->characters : sizes[i];
            status = measure_size(table, pack, skeletons[k], characters, error);
        }
    return status;
}

static const char *path_name(const synthesis_row *row)
{
    return row->simd ? "SIMD" : "plain C";
}

static void print_table(const synthesis_table *table)
{
    puts("every character: 4 examples, each between two of its frames, blended, and 3x4 matrices of all "
         "joints");
    puts("  us        of CPU time per character, one thread: median of the repeats (least)");
    puts("  legs      with both legs solved to their footprints as well, as crowds have them");
    puts("  31 joints the pack's 21 and five fingers to a hand; 21: the pack's own, as crowds have them");
    puts("  elsewhere ozz-animation 0.16: 3.3 us, and 0.26 for two legs (31 joints, 10,000 characters)");
    printf("%10s %6s  %-8s %18s %18s\n", "characters", "joints", "path", "us", "us with legs");
    for (int r = 0; r < table->count; ++r) {
        const synthesis_row *row = &table->row[r];
        printf("%10u %6u  %-8s %8.3f (%7.3f) %8.3f (%7.3f)\n", row->characters, row->joints, path_name(row),
               row->blend.median, row->blend.least, row->legs.median, row->legs.least);
    }
}

static ff_status write_csv(const synthesis_table *table, const char *path, ff_error *error)
{
    ff_text text = {0};
    ff_text_add(&text, "characters,joints,simd,us_blend,us_blend_least,us_ik,us_ik_least\n");
    for (int r = 0; r < table->count; ++r) {
        const synthesis_row *row = &table->row[r];
        ff_text_add(&text, "%u,%u,%d,%.4f,%.4f,%.4f,%.4f\n", row->characters, row->joints, row->simd,
                    row->blend.median, row->blend.least, row->legs.median, row->legs.least);
    }
    return ff_text_write(&text, path, error);
}

static json_t *rows_json(const synthesis_table *table, uint32_t joints)
{
    json_t *rows = json_array();
    for (int r = 0; r < table->count; ++r) {
        const synthesis_row *row = &table->row[r];
        if (row->joints != joints) continue;
        json_array_append_new(rows, json_pack("{s:I,s:I,s:b,s:f,s:f,s:f,s:f}", "characters",
                                              (json_int_t)row->characters, "joints", (json_int_t)joints,
                                              "simd", row->simd, "us_blend", row->blend.median,
                                              "us_blend_least", row->blend.least, "us_ik", row->legs.median,
                                              "us_ik_least", row->legs.least));
    }
    return rows;
}

/* us_ik is with the legs, blending included. */
static json_t *table_json(const synthesis_table *table)
{
    return json_pack("{s:s,s:I,s:I,s:o,s:o}", "bench", "synthesis", "samples", (json_int_t)FF_LOAD_SAMPLES,
                     "repeats", (json_int_t)table->options->repeats, "rows", rows_json(table, FF_LOAD_JOINTS),
                     "rows_own_skeleton", rows_json(table, FF_JOINT_COUNT));
}

static ff_status write_picture(const synthesis_table *table, const char *path, ff_error *error)
{
    static const char *const methods[] = {"SIMD", "plain C"};
    double blend[ROWS_MOST], legs[ROWS_MOST];
    char names[ROWS_MOST][48];
    const char *groups[ROWS_MOST];
    for (int r = 0; r < table->count; ++r) {
        const synthesis_row *row = &table->row[r];
        snprintf(names[r / 2], sizeof names[0], "%u, %u joints", row->characters, row->joints);
        groups[r / 2] = names[r / 2];
        blend[r] = row->blend.median;
        legs[r] = row->legs.median;
    }
    const ff_bar_panel panels[] = {
        {"Four motions blended, matrices of all joints", "us per character", blend},
        {"The same with both legs' IK", "us per character", legs}};
    ff_bar_chart chart = {"What a pose costs",
                          "one core, median of CPU time; lower is better",
                          groups,
                          methods,
                          table->count / 2,
                          2,
                          2,
                          panels};
    return ff_bars_write(path, &chart, error);
}

static ff_status write_files(const synthesis_table *table, ff_error *error)
{
    const ff_bench_options *common = &table->options->common;
    char path[4096];
    ff_status status = ff_bench_write_json(common, "synthesis", table_json(table), error);
    if (status != FF_OK || !common->out) return status;
    snprintf(path, sizeof path, "%s/synthesis.csv", common->out);
    status = write_csv(table, path, error);
    snprintf(path, sizeof path, "%s/synthesis.png", common->out);
    if (status == FF_OK) status = write_picture(table, path, error);
    return status;
}

static int run_synthesis(const synthesis_options *options)
{
    ff_error error = {0};
    ff_pack *pack = NULL;
    synthesis_table table = {.options = options};
    ff_status status = ff_pack_open(options->common.pack, &pack, &error);
    if (status == FF_OK) status = measure_all(&table, pack, &error);
    if (status == FF_OK) {
        print_table(&table);
        status = write_files(&table, &error);
    }
    ff_pack_close(pack);
    return status == FF_OK ? FF_EXIT_OK : ff_command_fail(FF_BENCH_PROGRAM, &error);
}

int ff_bench_synthesis_main(int argc, char **argv)
{
    synthesis_options given = {.repeats = 25};
    const ff_option own[] = {{.name = "--characters",
                              .value_name = "N",
                              .help = "how many (default: 100, 1000 and 10000)",
                              .integer = &given.characters,
                              .low = 1,
                              .high = 100000},
                             {.name = "--repeats",
                              .value_name = "N",
                              .help = "measurements of each, of which the median counts (default 25)",
                              .integer = &given.repeats,
                              .low = 1,
                              .high = REPEATS_MOST},
                             {0}};
    const ff_bench_command command = {.name = "bench synthesis",
                                      .summary =
                                          "four motions blended and brought to matrices, thousands of times",
                                      .files = "where synthesis.csv, .json and .png go; made if missing",
                                      .own = own};
    int status = ff_bench_parse(&command, argc, argv, &given.common);
    return status >= 0 ? status : run_synthesis(&given);
}
