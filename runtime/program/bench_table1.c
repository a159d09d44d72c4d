/* bench_table1.c - `footfall-crowd bench table1`: FbCrowd's Table 1 with the layouts of the navigation study (section 2),
 * at the paper's large step of 0.1 s and at 1/30 s, every method on the same body and synthesis. */
#include "runtime/core/base/file.h"
#include "runtime/export/bars.h"
#include "runtime/export/text.h"
#include "runtime/program/bench.h"
#include "runtime/program/bench_options.h"
#include "runtime/program/bench_trial.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SCENES = 3, STEPS = 2, METHODS = 5, ROWS = SCENES * STEPS };

static const ff_contender contenders[METHODS] = {{"mcn", "MCN", FF_NAVIGATION_MCN, false},
                                                 {"orca", "ORCA", FF_NAVIGATION_ORCA, false},
                                                 {"sf", "SF", FF_NAVIGATION_SF, false},
                                                 {"orca_aided", "ORCA aided", FF_NAVIGATION_ORCA, true},
                                                 {"sf_aided", "SF aided", FF_NAVIGATION_SF, true}};

/* The paper's figures: MCN, ORCA, SF. */
typedef struct table_scene {
    const char *name, *title;
    ff_scene_kind kind;
    double collisions[3], acceleration[3], update_ms[3];
} table_scene;

static const table_scene scenes[SCENES] = {{"x2",
                                            "2-way crossflow",
                                            FF_SCENE_TWO_WAY,
                                            {0.0496, 0.0566, 0.1440},
                                            {0.1135, 0.1542, 0.1253},
                                            {0.43, 0.40, 0.32}},
                                           {"bi",
                                            "bidirectional",
                                            FF_SCENE_BIDIRECTIONAL,
                                            {0.0722, 0.0491, 0.0539},
                                            {0.1121, 0.1901, 0.1683},
                                            {0.70, 0.66, 0.57}},
                                           {"x4",
                                            "4-way crossflow",
                                            FF_SCENE_FOUR_WAY,
                                            {0.1791, 0.2027, 0.3369},
                                            {0.0387, 0.0532, 0.0390},
                                            {17.71, 6.40, 6.53}}};
static const double steps[STEPS] = {0.1, 1.0 / 30.0};

typedef struct table_options {
    ff_bench_options common;
    const char *scene;
} table_options;

typedef struct table {
    const table_options *options;
    int first, end;   /* rows that are run */
    ff_trial *trials; /* [row][method][seed] */
    ff_trial_mean mean[ROWS][METHODS];
} table;

static const table_scene *scene_of(int row)
{
    return &scenes[row / STEPS];
}

static ff_status run_trials(table *t, const ff_trial_set *set, ff_error *error)
{
    uint32_t seeds = (uint32_t)t->options->common.seeds,
             count = (uint32_t)(t->end - t->first) * METHODS * seeds, at = 0;
    t->trials = ff_calloc(count, sizeof *t->trials);
    if (!t->trials) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u runs", count);
    for (int row = t->first; row < t->end; ++row)
        for (int m = 0; m < METHODS; ++m)
            for (uint32_t s = 0; s < seeds; ++s) {
                ff_scene_def *def = &t->trials[at++].def;
                *def = ff_scene_def_default(scene_of(row)->kind);
                def->leave = true;
                def->seconds = 90.0;
                def->step = steps[row % STEPS];
                def->seed = (uint64_t)t->options->common.first_seed + s;
                def->navigation = ff_contender_navigation(&contenders[m]);
            }
    ff_status status = ff_trials_run(set, t->trials, count, error);
    for (int row = t->first; row < t->end; ++row)
        for (int m = 0; m < METHODS; ++m)
            t->mean[row][m] =
                ff_trials_mean(t->trials + (size_t)((row - t->first) * METHODS + m) * seeds, seeds);
    return status;
}

static void print_row(int row, int m, const ff_trial_mean *mean)
{
    char paper[64] = "";
    const table_scene *scene = scene_of(row);
    if (m < 3)
        snprintf(paper, sizeof paper, "  %.4f %.4f %6.2f", scene->collisions[m], scene->acceleration[m],
                 scene->update_ms[m]);
    printf("%-3s %5.3f  %-10s %8.5f %6.3f %6.3f %6.3f %6.3f ", scene->name, steps[row % STEPS],
           contenders[m].label, mean->collision_rate, mean->raw, mean->filtered, mean->route,
           mean->route_all);
    printf("%6.1f %6.1f %4u/%-4u %5.1f %5.1f %5.1f ", 100.0 * mean->deepest, mean->pairs, mean->arrived,
           mean->agents, mean->mean_arrival, mean->last_arrival, mean->last_worst);
    printf("%6.3f %5.0f %6.1f %6.1f %7.3f %5.1f%s\n", 100.0 * mean->slide_p95, mean->joint_speed / FF_DEG,
           100.0 * mean->body_deepest, mean->body_pairs, mean->navigation_ms, mean->total_us, paper);
}

static const char *const legend[] = {
    "C        collision rate, eq 17",
    "A        acceleration in m/s2, eq 18: raw; over one step of walking (0.5 s)",
    "A way    the latter en route, from 2 s on until 1.5 m before the goal, while walking",
    "A jam    the same with those who stand in jams (low where nobody gets on: see arrived)",
    "deep     deepest overlap of two discs in cm, of all seeds",
    "pairs    that ever overlapped more than 1 cm",
    "mean ... s to the goal: mean, last, last of the worst seed; of those there within 90 s",
    "skate    slide of planted feet in cm, 95th percentile",
    "joint    fastest joint between two updates, degrees/s",
    "body     deepest overlap of the bodies' five cylinders in cm, of all seeds",
    "touch    pairs of bodies that ever touched",
    "2-D ms   navigation of the whole crowd per update",
    "us       everything, per agent and update",
    "aided    the baseline with MCN's keep-right, padding and knowledge of velocities",
    "paper    FbCrowd's own C, A and ms"};

static void print_table(const table *t)
{
    printf("%lld seeds from %lld on, every method on the same bodies\n", (long long)t->options->common.seeds,
           (long long)t->options->common.first_seed);
    for (size_t i = 0; i < sizeof legend / sizeof *legend; ++i)
        printf("  %s\n", legend[i]);
    printf("%-3s %5s  %-10s %8s %6s %6s %6s %6s %6s %6s %9s %5s %5s %5s %6s %5s %6s %6s %7s %5s  %s\n", "",
           "step", "method", "C", "A raw", "A walk", "A way", "A jam", "deep", "pairs", "arrived", "mean",
           "last", "worst", "skate", "joint", "body", "touch", "2-D ms", "us", "paper");
    for (int row = t->first; row < t->end; ++row)
        for (int m = 0; m < METHODS; ++m)
            print_row(row, m, &t->mean[row][m]);
}

static ff_status write_csv(const table *t, const char *path, ff_error *error)
{
    ff_text text = {0};
    ff_text_add(
        &text,
        "scene,step,method,C,A_raw,A_whole,A_route,A_route_all,deepest_m,pairs,agents,arrived,mean_s,last_s,"
        "last_worst_s,"
        "skate_median_m,skate_p95_m,joint_rad_s,body_deepest_m,body_pairs,update_ms,us_per_agent,paper_C,"
        "paper_A,paper_ms\n");
    for (int row = t->first; row < t->end; ++row) {
        for (int m = 0; m < METHODS; ++m) {
            const ff_trial_mean *mean = &t->mean[row][m];
            const table_scene *scene = scene_of(row);
            ff_text_add(&text, "%s,%.6f,%s,%.8f,%.5f,%.5f,%.5f,%.5f,%.5f,%.2f,%u,%u,%.3f,%.3f,%.3f,",
                        scene->name, steps[row % STEPS], contenders[m].key, mean->collision_rate, mean->raw,
                        mean->filtered, mean->route, mean->route_all, mean->deepest, mean->pairs,
                        mean->agents, mean->arrived, mean->mean_arrival, mean->last_arrival,
                        mean->last_worst);
            ff_text_add(&text, "%.6f,%.6f,%.3f,%.4f,%.2f,%.4f,%.3f,", mean->slide_median, mean->slide_p95,
                        mean->joint_speed, mean->body_deepest, mean->body_pairs, mean->navigation_ms,
                        mean->total_us);
            if (m < 3)
                ff_text_add(&text, "%g,%g,%g\n", scene->collisions[m], scene->acceleration[m],
                            scene->update_ms[m]);
            else
                ff_text_add(&text, ",,\n");
        }
    }
    return ff_text_write(&text, path, error);
}

static json_t *method_json(const ff_trial_mean *mean)
{
    return json_pack("{s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:I,s:I,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f}", "C",
                     mean->collision_rate, "A_route", mean->route, "A_route_all", mean->route_all, "A_raw",
                     mean->raw, "A_whole", mean->filtered, "deepest_m", mean->deepest, "pairs", mean->pairs,
                     "agents", (json_int_t)mean->agents, "arrived", (json_int_t)mean->arrived, "mean_s",
                     mean->mean_arrival, "last_s", mean->last_arrival, "last_worst_s", mean->last_worst,
                     "skate_median_m", mean->slide_median, "skate_p95_m", mean->slide_p95, "joint_rad_s",
                     mean->joint_speed, "body_deepest_m", mean->body_deepest, "body_pairs", mean->body_pairs,
                     "update_ms", mean->navigation_ms, "us_per_agent", mean->total_us);
}

static json_t *table_json(const table *t)
{
    json_t *list = json_array();
    for (int row = t->first; row < t->end; ++row) {
        json_t *methods = json_object();
        for (int m = 0; m < METHODS; ++m)
            json_object_set_new(methods, contenders[m].key, method_json(&t->mean[row][m]));
        json_array_append_new(list, json_pack("{s:s,s:f,s:o}", "name", scene_of(row)->name, "dt",
                                              steps[row % STEPS], "methods", methods));
    }
    return json_pack("{s:s,s:I,s:I,s:o}", "bench", "table1", "seeds", (json_int_t)t->options->common.seeds,
                     "first_seed", (json_int_t)t->options->common.first_seed, "scenes", list);
}

static ff_status write_picture(const table *t, const char *path, ff_error *error)
{
    double c[ROWS * METHODS], a[ROWS * METHODS], deep[ROWS * METHODS], last[ROWS * METHODS];
    char names[ROWS][48], subtitle[128];
    const char *groups[ROWS], *methods[METHODS];
    for (int row = t->first; row < t->end; ++row) {
        snprintf(names[row], sizeof names[row], "%s, %s s", scene_of(row)->title,
                 row % STEPS ? "1/30" : "0.1");
        groups[row - t->first] = names[row];
        for (int m = 0; m < METHODS; ++m) {
            const ff_trial_mean *mean = &t->mean[row][m];
            int at = (row - t->first) * METHODS + m;
            methods[m] = contenders[m].label;
            c[at] = 1e4 * mean->collision_rate, a[at] = mean->route;
            deep[at] = 100.0 * mean->deepest, last[at] = mean->last_arrival;
        }
    }
    const ff_bar_panel panels[] = {
        {"Collisions C", "1e-4 per agent and step", c},
        {"Acceleration A, over one step of walking, en route while walking", "m/s2", a},
        {"Deepest overlap of two discs", "cm", deep},
        {"Last arrival", "s, mean over seeds; who has not arrived in 90 s is left out", last}};
    snprintf(subtitle, sizeof subtitle,
             "FbCrowd, Table 1: 30, 53 and 100 people, %lld seeds; lower is better everywhere",
             (long long)t->options->common.seeds);
    ff_bar_chart chart = {"Three ways to cross", subtitle, groups, methods,
                          t->end - t->first,     METHODS,  4,      panels};
    return ff_bars_write(path, &chart, error);
}

static ff_status write_files(const table *t, ff_error *error)
{
    const char *out = t->options->common.out;
    char path[4096];
    ff_status status = ff_bench_write_json(&t->options->common, "table1", table_json(t), error);
    if (status != FF_OK || !out) return status;
    snprintf(path, sizeof path, "%s/table1.csv", out);
    status = write_csv(t, path, error);
    snprintf(path, sizeof path, "%s/table1.png", out);
    if (status == FF_OK) status = write_picture(t, path, error);
    return status;
}

/* The rows of the scene of that name; false when there is none. */
static bool choose_rows(table *t)
{
    t->first = 0;
    t->end = ROWS;
    if (!t->options->scene) return true;
    for (int scene = 0; scene < SCENES; ++scene) {
        t->first = scene * STEPS;
        t->end = t->first + STEPS;
        if (strcmp(t->options->scene, scenes[scene].name) == 0) return true;
    }
    return false;
}

static int run_table(table *t)
{
    const table_options *options = t->options;
    ff_error error = {0};
    ff_pack *pack = NULL;
    ff_figure figure;
    ff_status status = ff_pack_open(options->common.pack, &pack, &error);
    if (status == FF_OK) status = ff_figure_from_pack(pack, &figure, &error);
    ff_trial_set set = {pack, &figure, (uint32_t)options->common.threads, options->common.quiet};
    if (status == FF_OK) status = run_trials(t, &set, &error);
    if (status == FF_OK) {
        print_table(t);
        status = write_files(t, &error);
    }
    free(t->trials);
    ff_pack_close(pack);
    return status == FF_OK ? FF_EXIT_OK : ff_command_fail(FF_BENCH_PROGRAM, &error);
}

int ff_bench_table1_main(int argc, char **argv)
{
    table_options given = {.common = {.seeds = 5, .first_seed = 1, .threads = 1}};
    const ff_option own[] = {{.name = "--scene",
                              .value_name = "NAME",
                              .help = "one scene only: x2, bi or x4",
                              .text = &given.scene},
                             {0}};
    const ff_bench_command command = {
        .name = "bench table1",
        .summary = "MCN against ORCA and SF in three crossing crowds",
        .files = "where table1.csv, .json and .png go; made if missing",
        .seeds = "runs of everything, with different starting places (default 5)",
        .threads = "runs at the same time (default 1; more make the times less true)",
        .own = own};
    int status = ff_bench_parse(&command, argc, argv, &given.common);
    if (status >= 0) return status;
    table t = {.options = &given};
    if (!choose_rows(&t)) return ff_bench_misuse(&command, "--scene", given.scene, "x2, bi or x4");
    return run_table(&t);
}
