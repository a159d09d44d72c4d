/* bench_fig7.c - `footfall-crowd bench fig7`: the antipodal circle of FbCrowd's Figure 7, with 17 people as there and with
 * more, by every method; Detour's crowd beside them, as navigation alone. */
#include "runtime/core/base/file.h"
#include "runtime/export/detour.h"
#include "runtime/export/text.h"
#include "runtime/export/trajectories.h"
#include "runtime/program/bench.h"
#include "runtime/program/bench_options.h"
#include "runtime/program/bench_peer.h"

#include <stdio.h>
#include <stdlib.h>

#define LARGE 100      /* people: larger circles run once, with a larger step, and are not drawn */
#define LARGE_STEP 0.1 /* s */

enum { METHODS = 4, OURS = 3, SIZES_MOST = 4 };

static const ff_contender contenders[METHODS] = {{"mcn", "MCN", FF_NAVIGATION_MCN, false},
                                                 {"orca", "ORCA", FF_NAVIGATION_ORCA, false},
                                                 {"sf", "SF", FF_NAVIGATION_SF, false},
                                                 {"detour", "Detour", FF_NAVIGATION_CROWD, false}};

typedef struct circle_options {
    ff_bench_options common;
    int64_t agents;
    double step;
    bool mcn_only;
} circle_options;

typedef struct circle_row {
    uint32_t agents;
    double step, unhindered; /* s; of one walker alone */
    bool known[METHODS];
    ff_trial_mean mean[METHODS];
} circle_row;

typedef struct circles {
    const circle_options *options;
    ff_trial_set set;
    circle_row row[SIZES_MOST];
    int row_count;
} circles;

static ff_scene_def circle_def(const circle_row *row, int method, uint64_t seed)
{
    ff_scene_def def = ff_scene_def_default(FF_SCENE_CIRCLE);
    def.agents = row->agents;
    def.radius = ff_max(4.0, 0.16 * row->agents);
    def.seconds = ff_max(60.0, 1.7 * 2.0 * def.radius / def.preferred_speed);
    def.step = row->step;
    def.seed = seed;
    if (method < OURS) def.navigation = ff_contender_navigation(&contenders[method]);
    snprintf(def.title, sizeof def.title, "Antipodal circle, %s", contenders[method].label);
    return def;
}

static ff_status walk_alone(const circles *all, circle_row *row, ff_error *error)
{
    ff_trial alone = {.def = circle_def(row, 0, 1)};
    alone.def.agents = 1;
    ff_status status = ff_trials_run(&all->set, &alone, 1, error);
    row->unhindered = alone.measures.last_arrival;
    return status;
}

static ff_status draw(const circles *all, const circle_row *row, int method, const ff_scene *scene,
                      const ff_recording *recording, ff_error *error)
{
    char path[4096];
    if (!all->options->common.out || row->agents > LARGE) return FF_OK;
    snprintf(path, sizeof path, "%s/fig7-%u-%s.png", all->options->common.out, row->agents,
             contenders[method].key);
    return ff_trajectories_write(path, scene, recording, error);
}

static ff_status draw_ours(const circles *all, const circle_row *row, int method, const ff_scene_def *def,
                           ff_error *error)
{
    if (!all->options->common.out || row->agents > LARGE) return FF_OK;
    ff_scene scene;
    ff_simulation simulation;
    ff_status status = ff_trial_record(&all->set, def, &scene, &simulation, error);
    if (status == FF_OK) status = draw(all, row, method, &scene, &simulation.recording, error);
    ff_simulation_free(&simulation);
    ff_scene_free(&scene);
    return status;
}

static ff_status run_peer(const circles *all, const circle_row *row, int method, ff_trial *trial, bool first,
                          ff_error *error)
{
    ff_scene scene;
    ff_recording recording;
    ff_status status = ff_peer_run(all->set.figure, trial, &scene, &recording, error);
    if (status == FF_OK && first) status = draw(all, row, method, &scene, &recording, error);
    ff_recording_free(&recording);
    ff_scene_free(&scene);
    return status;
}

static ff_status run_method(const circles *all, circle_row *row, int method, ff_error *error)
{
    uint32_t seeds = row->agents > LARGE ? 1 : (uint32_t)all->options->common.seeds;
    ff_trial *trials = ff_calloc(seeds, sizeof *trials);
    if (!trials) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u runs", seeds);
    for (uint32_t s = 0; s < seeds; ++s)
        trials[s].def = circle_def(row, method, (uint64_t)all->options->common.first_seed + s);
    ff_status status = FF_OK;
    if (method < OURS) {
        status = ff_trials_run(&all->set, trials, seeds, error);
        if (status == FF_OK) status = draw_ours(all, row, method, &trials[0].def, error);
    }
    for (uint32_t s = 0; s < seeds && status == FF_OK && method >= OURS; ++s)
        status = run_peer(all, row, method, &trials[s], s == 0, error);
    row->mean[method] = ff_trials_mean(trials, seeds);
    row->known[method] = true;
    free(trials);
    return status;
}

static ff_status run_circles(circles *all, ff_error *error)
{
    static const uint32_t sizes[SIZES_MOST] = {17, 40, 100, 1000};
    const circle_options *options = all->options;
    for (int i = 0; i < SIZES_MOST; ++i) {
        if (options->agents > 0 && i > 0) break;
        circle_row *row = &all->row[all->row_count++];
        row->agents = options->agents > 0 ? (uint32_t)options->agents : sizes[i];
        row->step = row->agents > LARGE ? LARGE_STEP : options->step;
        ff_status status = walk_alone(all, row, error);
        for (int m = 0; m < METHODS && status == FF_OK; ++m) {
            bool left_out = (options->mcn_only && m > 0) || (m >= OURS && !ff_detour_here());
            if (!left_out) status = run_method(all, row, m, error);
        }
        if (status != FF_OK) return status;
    }
    return FF_OK;
}

static const char *const legend[] = {
    "alone    s that one walker takes to stand at the goal",
    "mean ... s to the goal: mean, last, last of the worst seed, of those who arrived; the latter two "
    "against alone",
    "C        collision rate, eq 17",
    "deep     deepest overlap of two discs in cm, of all seeds",
    "body     the same of the bodies' five cylinders; pairs that ever touched",
    "A        acceleration over one step of walking, m/s2",
    "2-D ms   navigation of the whole crowd per update; us: everything, per agent and update (Detour has no "
    "bodies)"};

static void print_circles(const circles *all)
{
    printf("seeds from %lld on; everyone to the other side of a circle, to stand there\n",
           (long long)all->options->common.first_seed);
    for (size_t i = 0; i < sizeof legend / sizeof *legend; ++i)
        printf("  %s\n", legend[i]);
    printf("%6s %5s %6s  %-7s %10s %6s %6s %6s %5s %5s %9s %6s %6s %6s %6s %8s %6s\n", "agents", "step",
           "alone", "method", "arrived", "mean", "last", "worst", "ratio", "worst", "C", "deep", "body",
           "touch", "A", "2-D ms", "us");
    for (int r = 0; r < all->row_count; ++r) {
        const circle_row *row = &all->row[r];
        for (int m = 0; m < METHODS; ++m) {
            const ff_trial_mean *mean = &row->mean[m];
            if (!row->known[m]) continue;
            printf("%6u %5.3f %6.1f  %-7s %5u/%-5u %5.1f %6.1f %6.1f %5.2f %5.2f %9.6f %6.1f %6.1f %6.1f "
                   "%6.3f %8.3f %6.1f\n",
                   row->agents, row->step, row->unhindered, contenders[m].label, mean->arrived, mean->agents,
                   mean->mean_arrival, mean->last_arrival, mean->last_worst,
                   mean->last_arrival / row->unhindered, mean->last_worst / row->unhindered,
                   mean->collision_rate, 100.0 * mean->deepest, 100.0 * mean->body_deepest, mean->body_pairs,
                   mean->filtered, mean->navigation_ms, mean->total_us);
        }
    }
}

static ff_status write_csv(const circles *all, const char *path, ff_error *error)
{
    ff_text text = {0};
    ff_text_add(&text, "circle,step,unhindered_s,method,agents,arrived,mean_s,last_s,last_worst_s,C,deepest_"
                       "m,body_deepest_m,body_pairs,"
                       "A_raw,A_whole,A_route,update_ms,us_per_agent\n");
    for (int r = 0; r < all->row_count; ++r) {
        const circle_row *row = &all->row[r];
        for (int m = 0; m < METHODS; ++m) {
            const ff_trial_mean *mean = &row->mean[m];
            if (!row->known[m]) continue;
            ff_text_add(&text,
                        "%u,%.6f,%.3f,%s,%u,%u,%.3f,%.3f,%.3f,%.8f,%.5f,%.4f,%.2f,%.5f,%.5f,%.5f,%.4f,%.3f\n",
                        row->agents, row->step, row->unhindered, contenders[m].key, mean->agents,
                        mean->arrived, mean->mean_arrival, mean->last_arrival, mean->last_worst,
                        mean->collision_rate, mean->deepest, mean->body_deepest, mean->body_pairs, mean->raw,
                        mean->filtered, mean->route, mean->navigation_ms, mean->total_us);
        }
    }
    return ff_text_write(&text, path, error);
}

static json_t *circles_json(const circles *all)
{
    json_t *rows = json_array();
    for (int r = 0; r < all->row_count; ++r) {
        const circle_row *row = &all->row[r];
        json_t *methods = json_object();
        for (int m = 0; m < METHODS; ++m) {
            const ff_trial_mean *mean = &row->mean[m];
            if (!row->known[m]) continue;
            json_object_set_new(
                methods, contenders[m].key,
                json_pack("{s:I,s:I,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f}", "agents",
                          (json_int_t)mean->agents, "arrived", (json_int_t)mean->arrived, "mean_s",
                          mean->mean_arrival, "last_s", mean->last_arrival, "last_worst_s", mean->last_worst,
                          "ratio", mean->last_arrival / row->unhindered, "ratio_worst",
                          mean->last_worst / row->unhindered, "C", mean->collision_rate, "deepest_m",
                          mean->deepest, "body_deepest_m", mean->body_deepest, "body_pairs", mean->body_pairs,
                          "A_raw", mean->raw, "A_whole", mean->filtered, "update_ms", mean->navigation_ms,
                          "us_per_agent", mean->total_us));
        }
        json_array_append_new(rows,
                              json_pack("{s:I,s:f,s:f,s:o}", "agents", (json_int_t)row->agents, "dt",
                                        row->step, "unhindered_s", row->unhindered, "methods", methods));
    }
    return json_pack("{s:s,s:I,s:I,s:o}", "bench", "fig7", "seeds", (json_int_t)all->options->common.seeds,
                     "first_seed", (json_int_t)all->options->common.first_seed, "rows", rows);
}

static ff_status write_files(const circles *all, ff_error *error)
{
    const circle_options *options = all->options;
    char path[4096];
    ff_status status = ff_bench_write_json(&options->common, "fig7", circles_json(all), error);
    if (status != FF_OK || !options->common.out) return status;
    snprintf(path, sizeof path, "%s/fig7.csv", options->common.out);
    status = write_csv(all, path, error);
    return status;
}

static int run_fig7(const circle_options *options)
{
    ff_error error = {0};
    ff_pack *pack = NULL;
    ff_figure figure;
    circles all = {.options = options};
    ff_status status = ff_pack_open(options->common.pack, &pack, &error);
    if (status == FF_OK) status = ff_figure_from_pack(pack, &figure, &error);
    if (status == FF_OK && options->common.out) status = ff_folder_create(options->common.out, &error);
    all.set = (ff_trial_set){pack, &figure, (uint32_t)options->common.threads, options->common.quiet};
    if (status == FF_OK) status = run_circles(&all, &error);
    if (status == FF_OK) {
        print_circles(&all);
        status = write_files(&all, &error);
    }
    ff_pack_close(pack);
    return status == FF_OK ? FF_EXIT_OK : ff_command_fail(FF_BENCH_PROGRAM, &error);
}

int ff_bench_fig7_main(int argc, char **argv)
{
    circle_options given = {.common = {.seeds = 5, .first_seed = 1, .threads = 1}, .step = 1.0 / 30.0};
    const ff_option own[] = {
        {.name = "--agents",
         .value_name = "N",
         .help = "one circle of N people (default: 17, 40, 100 and 1000)",
         .integer = &given.agents,
         .low = 2,
         .high = 5000},
        {.name = "--step",
         .value_name = "S",
         .help = "simulation step (default 1/30; circles of more than 100 people take 0.1)",
         .number = &given.step,
         .low = 0.005,
         .high = 0.1},
        {.name = "--mcn", .help = "MCN only", .flag = &given.mcn_only},
        {0}};
    const ff_bench_command command = {
        .name = "bench fig7",
        .summary = "everyone to the other side of a circle",
        .files = "where fig7.csv, fig7.json and pictures of the paths go; made if missing",
        .seeds = "runs of each circle (default 5; one of those of more than 100 people)",
        .threads = "runs at the same time (default 1; more make the times less true)",
        .own = own};
    int status = ff_bench_parse(&command, argc, argv, &given.common);
    return status >= 0 ? status : run_fig7(&given);
}
