/* bench_mixed.c - `footfall-crowd bench mixed`: crowds of which one half moves on planned footsteps and the other by velocity;
 * how deep people get into each other, by who meets whom, and the same crowds moved in one way for comparison. */
#include "runtime/core/base/file.h"
#include "runtime/export/bars.h"
#include "runtime/export/text.h"
#include "runtime/program/bench.h"
#include "runtime/program/bench_options.h"
#include "runtime/program/footstep_trial.h"
#include "runtime/tool/progress.h"

#include <stdio.h>
#include <string.h>

typedef struct mixed_row {
    const char *scene, *who;
    ff_walk_scene kind;
    ff_planner planner;
    ff_walk_mix mix;
    uint32_t agents;
    double density, seconds;
    /* over all runs */
    double agent_seconds, speed[2], arrived, last;
    ff_pair_contacts pairs[FF_PAIR_KINDS];
} mixed_row;

#define CROSSING "crossing", .kind = FF_WALK_CROSSING, .agents = 100, .density = 0.1, .seconds = 20.0
#define CIRCLE "circle", .kind = FF_WALK_CIRCLE, .agents = 40, .seconds = 40.0
#define STREAMS "streams", .kind = FF_WALK_STREAMS, .agents = 48, .seconds = 40.0
static const mixed_row rows[] = {
    {.scene = CROSSING, .who = "mixed", .planner = FF_PLANNER_FOOTSTEPS, .mix = FF_MIX_HALF},
    {.scene = CROSSING, .who = "footsteps", .planner = FF_PLANNER_FOOTSTEPS},
    {.scene = CROSSING, .who = "velocity", .planner = FF_PLANNER_VELOCITY},
    {.scene = CIRCLE, .who = "mixed", .planner = FF_PLANNER_FOOTSTEPS, .mix = FF_MIX_HALF},
    {.scene = CIRCLE, .who = "footsteps", .planner = FF_PLANNER_FOOTSTEPS},
    {.scene = CIRCLE, .who = "velocity", .planner = FF_PLANNER_VELOCITY},
    {.scene = STREAMS, .who = "mixed", .planner = FF_PLANNER_FOOTSTEPS, .mix = FF_MIX_HALF},
    {.scene = STREAMS, .who = "one side", .planner = FF_PLANNER_FOOTSTEPS, .mix = FF_MIX_SIDES},
    {.scene = STREAMS, .who = "footsteps", .planner = FF_PLANNER_FOOTSTEPS},
    {.scene = STREAMS, .who = "velocity", .planner = FF_PLANNER_VELOCITY},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

typedef struct mixed_options {
    ff_bench_options common;
    const char *scene;
    double step;
    bool mixed_only;
} mixed_options;

typedef struct mixed {
    const mixed_options *options;
    const ff_pack *pack;
    const ff_figure *figure;
    mixed_row row[ROWS];
    int count;
} mixed;

static ff_walk_trial trial_of(const mixed *all, const mixed_row *row, int64_t seed)
{
    return (ff_walk_trial){.scene = row->kind,
                           .agents = row->agents,
                           .threads = (uint32_t)all->options->common.threads,
                           .density = row->density,
                           .seconds = row->seconds,
                           .step = all->options->step,
                           .seed = (uint64_t)seed,
                           .planner = row->planner,
                           .footsteps = ff_crowd_def_default().footsteps,
                           .mix = row->mix};
}

static void add(mixed_row *row, const ff_walk_measures *m, double share)
{
    row->agent_seconds += m->agent_seconds;
    row->arrived += m->arrived;
    row->last += share * m->last_arrival;
    for (int way = 0; way < 2; ++way)
        row->speed[way] += share * m->speed_by[way];
    for (int kind = 0; kind < FF_PAIR_KINDS; ++kind) {
        ff_pair_contacts *sum = &row->pairs[kind];
        const ff_pair_contacts *one = &m->pairs[kind];
        sum->seconds += one->seconds;
        sum->deepest = ff_max(sum->deepest, one->deepest);
        sum->discs = ff_max(sum->discs, one->discs);
    }
}

static ff_status run_row(mixed *all, mixed_row *row, ff_progress *progress, ff_error *error)
{
    const ff_bench_options *common = &all->options->common;
    ff_status status = FF_OK;
    for (int64_t i = 0; i < common->seeds && status == FF_OK; ++i) {
        ff_walk_trial trial = trial_of(all, row, common->first_seed + i);
        ff_walk_measures measures;
        status = ff_walk_trial_run(all->pack, all->figure, &trial, &measures, error);
        if (status == FF_OK) add(row, &measures, 1.0 / (double)common->seeds);
        ff_progress_step(progress, row->scene);
    }
    return status;
}

static double seconds_of(const mixed_row *row, int kind)
{
    return 100.0 * row->pairs[kind].seconds / row->agent_seconds;
}

static const char *const pair_names[FF_PAIR_KINDS] = {"velocity", "mixed", "footsteps"};

static void print_rows(const mixed *all)
{
    printf("seeds from %lld on; per kind of pair: s of contact of the five cylinders in 100 agent-seconds,\n"
           "their deepest overlap, and that of the discs that velocity navigation keeps apart, in cm\n",
           (long long)all->options->common.first_seed);
    printf("%-9s %-9s %6s |", "scene", "who", "agents");
    for (int kind = 0; kind < FF_PAIR_KINDS; ++kind)
        printf(" %-9s %6s %6s |", pair_names[kind], "bodies", "discs");
    printf(" %-13s %9s %6s\n", "m/s vel. foot.", "arrived", "last");
    for (int i = 0; i < all->count; ++i) {
        const mixed_row *row = &all->row[i];
        printf("%-9s %-9s %6u |", row->scene, row->who, row->agents);
        for (int kind = 0; kind < FF_PAIR_KINDS; ++kind)
            printf(" %9.4f %6.1f %6.1f |", seconds_of(row, kind), 100.0 * row->pairs[kind].deepest,
                   100.0 * row->pairs[kind].discs);
        printf(" %6.2f %6.2f  %4.0f/%-4.0f %6.1f\n", row->speed[0], row->speed[1], row->arrived,
               (double)row->agents * (double)all->options->common.seeds, row->last);
    }
}

static json_t *rows_json(const mixed *all)
{
    json_t *list = json_array();
    for (int i = 0; i < all->count; ++i) {
        const mixed_row *row = &all->row[i];
        json_t *pairs = json_object();
        for (int kind = 0; kind < FF_PAIR_KINDS; ++kind)
            json_object_set_new(pairs, pair_names[kind],
                                json_pack("{s:f,s:f,s:f}", "overlap", seconds_of(row, kind), "deepest_m",
                                          row->pairs[kind].deepest, "discs_m", row->pairs[kind].discs));
        json_array_append_new(list, json_pack("{s:s,s:s,s:I,s:f,s:f,s:I,s:f,s:o}", "scene", row->scene, "who",
                                              row->who, "agents", (json_int_t)row->agents, "speed_velocity",
                                              row->speed[0], "speed_footsteps", row->speed[1], "arrived",
                                              (json_int_t)row->arrived, "last_arrival_s", row->last, "pairs",
                                              pairs));
    }
    const ff_bench_options *common = &all->options->common;
    return json_pack("{s:s,s:I,s:I,s:f,s:o}", "bench", "mixed", "seeds", (json_int_t)common->seeds,
                     "first_seed", (json_int_t)common->first_seed, "step", all->options->step, "rows", list);
}

static ff_status write_csv(const mixed *all, const char *path, ff_error *error)
{
    ff_text text = {0};
    ff_text_add(&text, "scene,who,agents,pair,overlap,deepest_m,discs_m,speed_velocity,speed_footsteps,"
                       "arrived,last_arrival_s\n");
    for (int i = 0; i < all->count; ++i) {
        const mixed_row *row = &all->row[i];
        for (int kind = 0; kind < FF_PAIR_KINDS; ++kind)
            ff_text_add(&text, "%s,%s,%u,%s,%.5f,%.4f,%.4f,%.3f,%.3f,%.0f,%.2f\n", row->scene, row->who,
                        row->agents, pair_names[kind], seconds_of(row, kind), row->pairs[kind].deepest,
                        row->pairs[kind].discs, row->speed[0], row->speed[1], row->arrived, row->last);
    }
    return ff_text_write(&text, path, error);
}

static ff_status draw_bars(const mixed *all, const char *path, ff_error *error)
{
    char names[ROWS][32];
    const char *groups[ROWS];
    double deepest[ROWS * FF_PAIR_KINDS], overlap[ROWS * FF_PAIR_KINDS];
    for (int i = 0; i < all->count; ++i) {
        const mixed_row *row = &all->row[i];
        snprintf(names[i], sizeof names[i], "%s, %s", row->scene, row->who);
        groups[i] = names[i];
        for (int kind = 0; kind < FF_PAIR_KINDS; ++kind) {
            deepest[i * FF_PAIR_KINDS + kind] = 100.0 * row->pairs[kind].deepest;
            overlap[i * FF_PAIR_KINDS + kind] = seconds_of(row, kind);
        }
    }
    const ff_bar_panel panels[] = {{"deepest overlap of bodies", "cm", deepest},
                                   {"bodies touch", "s in 100 s", overlap}};
    const ff_bar_chart chart = {.title = "Mixed crowds",
                                .subtitle = "Pairs by velocity, mixed ones, and on footsteps",
                                .groups = groups,
                                .methods = pair_names,
                                .group_count = all->count,
                                .method_count = FF_PAIR_KINDS,
                                .panel_count = 2,
                                .panels = panels};
    return ff_bars_write(path, &chart, error);
}

/* Three moments of the first seed of the first mixed crowd that was walked. */
static ff_status draw_crowd(const mixed *all, const char *path, ff_error *error)
{
    return ff_walk_trial_draw(all->pack, all->figure,
                              trial_of(all, &all->row[0], all->options->common.first_seed),
                              "A mixed crowd: prints and plans of those on footsteps", NULL, path, error);
}

static ff_status write_files(const mixed *all, ff_error *error)
{
    const ff_bench_options *common = &all->options->common;
    char path[4096];
    ff_status status = ff_bench_write_json(common, "mixed", rows_json(all), error);
    if (status != FF_OK || !common->out) return status;
    snprintf(path, sizeof path, "%s/mixed.csv", common->out);
    status = write_csv(all, path, error);
    snprintf(path, sizeof path, "%s/mixed.png", common->out);
    if (status == FF_OK) status = draw_bars(all, path, error);
    snprintf(path, sizeof path, "%s/mixed-crowd.png", common->out);
    return status == FF_OK ? draw_crowd(all, path, error) : status;
}

static int run_mixed(const mixed_options *options)
{
    ff_error error = {0};
    ff_pack *pack = NULL;
    ff_figure figure;
    mixed all = {.options = options, .figure = &figure};
    ff_status status = ff_pack_open(options->common.pack, &pack, &error);
    all.pack = pack;
    if (status == FF_OK) status = ff_figure_from_pack(pack, &figure, &error);
    if (status == FF_OK && options->common.out) status = ff_folder_create(options->common.out, &error);
    for (int i = 0; i < ROWS; ++i) {
        bool asked = !options->scene || strcmp(options->scene, rows[i].scene) == 0;
        if (asked && (rows[i].mix != FF_MIX_NONE || !options->mixed_only)) all.row[all.count++] = rows[i];
    }
    uint64_t runs = (uint64_t)all.count * (uint64_t)options->common.seeds;
    ff_progress *progress = ff_progress_start("walking", runs, options->common.quiet);
    for (int i = 0; i < all.count && status == FF_OK; ++i)
        status = run_row(&all, &all.row[i], progress, &error);
    ff_progress_end(progress);
    if (status == FF_OK) {
        print_rows(&all);
        status = write_files(&all, &error);
    }
    ff_pack_close(pack);
    return status == FF_OK ? FF_EXIT_OK : ff_command_fail(FF_BENCH_PROGRAM, &error);
}

int ff_bench_mixed_main(int argc, char **argv)
{
    mixed_options given = {.common = {.seeds = 5, .first_seed = 1, .threads = 1}, .step = 1.0 / 30.0};
    const ff_option own[] = {{.name = "--scene",
                              .value_name = "NAME",
                              .help = "crossing, circle or streams (default: all)",
                              .text = &given.scene},
                             {.name = "--step",
                              .value_name = "S",
                              .help = "simulation step (default 1/30)",
                              .number = &given.step,
                              .low = 0.005,
                              .high = 0.1},
                             {.name = "--mixed", .help = "mixed crowds only", .flag = &given.mixed_only},
                             {0}};
    const ff_bench_command command = {
        .name = "bench mixed",
        .summary = "crowds of which one half is on footsteps and the other goes by velocity",
        .files =
            "where mixed.csv, mixed.json, mixed.png and a picture of prints and plans go; made if missing",
        .seeds = "runs of each crowd (default 5)",
        .threads = "of each crowd (default 1)",
        .own = own};
    int status = ff_bench_parse(&command, argc, argv, &given.common);
    if (status >= 0) return status;
    bool known = !given.scene;
    for (int i = 0; i < ROWS; ++i)
        known = known || (given.scene && strcmp(given.scene, rows[i].scene) == 0);
    return known ? run_mixed(&given)
                 : ff_bench_misuse(&command, "--scene", given.scene, "crossing, circle or streams");
}
