/* bench_fig6.c - `footfall-crowd bench fig6`: how many whole people one core walks (FbCrowd, Figure 6), by every method, and
 * how the cost grows with the crowd; Detour's crowd beside them, as navigation alone. */
#include "runtime/core/base/file.h"
#include "runtime/core/base/maths.h"
#include "runtime/export/bars.h"
#include "runtime/export/detour.h"
#include "runtime/export/text.h"
#include "runtime/program/bench.h"
#include "runtime/program/bench_options.h"
#include "runtime/program/circles_load.h"
#include "runtime/tool/progress.h"

#include <stdio.h>

#define UPDATES 30.0 /* per second */

enum { METHODS = 4, OURS = 3, SIZES_MOST = 6 };

static const char *const keys[METHODS] = {"mcn", "orca", "sf", "detour"};
static const char *const labels[METHODS] = {"MCN", "ORCA", "SF", "Detour"};
static const ff_navigation navigation[OURS] = {FF_NAVIGATION_MCN, FF_NAVIGATION_ORCA, FF_NAVIGATION_SF};

typedef struct growth_options {
    ff_bench_options common;
    int64_t agents;
    bool mcn_only;
} growth_options;

typedef struct growth_row {
    uint32_t agents;
    bool known[METHODS];
    ff_load_times times[METHODS];
} growth_row;

typedef struct growth {
    const growth_options *options;
    growth_row row[SIZES_MOST];
    int count;
} growth;

static ff_status measure_row(const growth *all, const ff_pack *pack, growth_row *row, ff_progress *progress,
                             ff_error *error)
{
    ff_status status = FF_OK;
    for (int m = 0; m < METHODS && status == FF_OK; ++m) {
        if ((all->options->mcn_only && m > 0) || (m >= OURS && !ff_detour_here())) continue;
        char item[64];
        status = m < OURS ? ff_circles_measure(pack, navigation[m], row->agents, &row->times[m], error)
                          : ff_circles_measure_detour(row->agents, &row->times[m], error);
        row->known[m] = true;
        snprintf(item, sizeof item, "%u agents, %s", row->agents, labels[m]);
        ff_progress_step(progress, item);
    }
    return status;
}

static ff_status measure_all(growth *all, const ff_pack *pack, ff_error *error)
{
    static const uint32_t sizes[SIZES_MOST] = {40, 100, 1000, 5000, 10000, 20000};
    int64_t one = all->options->agents;
    int methods = all->options->mcn_only ? 1 : ff_detour_here() ? METHODS : OURS;
    all->count = one > 0 ? 1 : SIZES_MOST;
    ff_progress *progress =
        ff_progress_start("walking", (uint64_t)(all->count * methods), all->options->common.quiet);
    ff_status status = FF_OK;
    for (int i = 0; i < all->count && status == FF_OK; ++i) {
        all->row[i].agents = one > 0 ? (uint32_t)one : sizes[i];
        status = measure_row(all, pack, &all->row[i], progress, error);
    }
    ff_progress_end(progress);
    return status;
}

/* How much dearer one agent is in the largest crowd than in one of 1,000; 0 when these were not measured. */
static double growth_of(const growth *all, int method)
{
    double first = 0.0, last = 0.0;
    for (int r = 0; r < all->count; ++r) {
        if (all->row[r].agents == 1000) first = all->row[r].times[method].total;
        if (all->row[r].agents > 1000) last = all->row[r].times[method].total;
    }
    return first > 0.0 && last > 0.0 ? last / first - 1.0 : 0.0;
}

static const char *const legend[] = {
    "us          of CPU time per agent and update of 1/30 s, one thread: medians over 60 updates",
    "navigation  neighbours and decisions",
    "steps       feet, hips, weights: what is remembered of a gait",
    "matrices    pose, both legs' IK, 3x4 matrices of all joints",
    "coupling    bodies that follow the decisions; what everybody shows the others",
    "fit         agents that one core updates 30 times a second",
    "Detour      navigation alone, without bodies"};

static void print_table(const growth *all)
{
    printf("antipodal circles of %d people side by side, radius %.1f m, numbered at random; from 3 to 5 s: "
           "until they meet\n",
           FF_CIRCLE_PEOPLE, FF_CIRCLE_RADIUS);
    for (size_t i = 0; i < sizeof legend / sizeof *legend; ++i)
        printf("  %s\n", legend[i]);
    printf("%7s  %-7s %7s %11s %7s %9s %9s %8s\n", "agents", "method", "us", "navigation", "steps",
           "matrices", "coupling", "fit");
    for (int r = 0; r < all->count; ++r)
        for (int m = 0; m < METHODS; ++m) {
            const ff_load_times *t = &all->row[r].times[m];
            if (!all->row[r].known[m]) continue;
            printf("%7u  %-7s %7.2f %11.2f %7.2f %9.2f %9.2f %8.0f\n", all->row[r].agents, labels[m],
                   t->total, t->navigation, t->steps, t->matrices, t->coupling, 1e6 / UPDATES / t->total);
        }
    for (int m = 0; m < METHODS; ++m)
        if (growth_of(all, m) != 0.0)
            printf("%s: %+.0f %% per agent from 1,000 to %u\n", labels[m], 100.0 * growth_of(all, m),
                   all->row[all->count - 1].agents);
    puts("FbCrowd: more than 40 at 30 updates per second on four cores, without drawing");
}

static ff_status write_csv(const growth *all, const char *path, ff_error *error)
{
    ff_text text = {0};
    ff_text_add(&text, "agents,method,us_per_agent,us_navigation,us_steps,us_matrices,us_coupling\n");
    for (int r = 0; r < all->count; ++r)
        for (int m = 0; m < METHODS; ++m) {
            const ff_load_times *t = &all->row[r].times[m];
            if (!all->row[r].known[m]) continue;
            ff_text_add(&text, "%u,%s,%.4f,%.4f,%.4f,%.4f,%.4f\n", all->row[r].agents, keys[m], t->total,
                        t->navigation, t->steps, t->matrices, t->coupling);
        }
    return ff_text_write(&text, path, error);
}

/* us_synthesis is steps and matrices. */
static void add_times(json_t *object, const ff_load_times *t)
{
    json_object_set_new(object, "us_per_agent", json_real(t->total));
    json_object_set_new(object, "us_navigation", json_real(t->navigation));
    json_object_set_new(object, "us_synthesis", json_real(t->steps + t->matrices));
    json_object_set_new(object, "us_matrices", json_real(t->matrices));
    json_object_set_new(object, "us_coupling", json_real(t->coupling));
}

static json_t *row_json(const growth_row *row)
{
    json_t *object = json_object(), *methods = json_object();
    json_object_set_new(object, "agents", json_integer(row->agents));
    add_times(object, &row->times[0]);
    json_object_set_new(object, "fit", json_real(1e6 / UPDATES / row->times[0].total));
    for (int m = 0; m < METHODS; ++m) {
        if (!row->known[m]) continue;
        json_t *times = json_object();
        add_times(times, &row->times[m]);
        json_object_set_new(methods, keys[m], times);
    }
    json_object_set_new(object, "methods", methods);
    return object;
}

static json_t *table_json(const growth *all)
{
    json_t *rows = json_array();
    for (int r = 0; r < all->count; ++r)
        json_array_append_new(rows, row_json(&all->row[r]));
    return json_pack("{s:s,s:i,s:f,s:o}", "bench", "fig6", "threads", 1, "growth", growth_of(all, 0), "rows",
                     rows);
}

static ff_status write_picture(const growth *all, const char *path, ff_error *error)
{
    enum { PANELS = 3 };
    double value[PANELS][SIZES_MOST * METHODS];
    char names[SIZES_MOST][32];
    const char *groups[SIZES_MOST];
    for (int r = 0; r < all->count; ++r) {
        snprintf(names[r], sizeof names[r], "%u people", all->row[r].agents);
        groups[r] = names[r];
        for (int m = 0; m < METHODS; ++m) {
            const ff_load_times *t = &all->row[r].times[m];
            value[0][r * METHODS + m] = t->total;
            value[1][r * METHODS + m] = t->navigation;
            value[2][r * METHODS + m] = t->steps + t->matrices + t->coupling;
        }
    }
    const ff_bar_panel panels[PANELS] = {
        {"Everything (Detour: navigation alone)", "us per agent and update", value[0]},
        {"Navigation", "us per agent and update", value[1]},
        {"Bodies: coupling, steps, legs, matrices of all joints", "us per agent and update", value[2]}};
    ff_bar_chart chart = {"What one person costs, by the size of the crowd",
                          "FbCrowd, Figure 6: antipodal circles at equal density, one core; lower is better",
                          groups,
                          labels,
                          all->count,
                          METHODS,
                          PANELS,
                          panels};
    return ff_bars_write(path, &chart, error);
}

static ff_status write_files(const growth *all, ff_error *error)
{
    const ff_bench_options *common = &all->options->common;
    char path[4096];
    ff_status status = ff_bench_write_json(common, "fig6", table_json(all), error);
    if (status != FF_OK || !common->out) return status;
    snprintf(path, sizeof path, "%s/fig6.csv", common->out);
    status = write_csv(all, path, error);
    snprintf(path, sizeof path, "%s/fig6.png", common->out);
    if (status == FF_OK) status = write_picture(all, path, error);
    return status;
}

static int run_fig6(const growth_options *options)
{
    ff_error error = {0};
    ff_pack *pack = NULL;
    growth all = {.options = options};
    ff_status status = ff_pack_open(options->common.pack, &pack, &error);
    if (status == FF_OK) status = measure_all(&all, pack, &error);
    if (status == FF_OK) {
        print_table(&all);
        status = write_files(&all, &error);
    }
    ff_pack_close(pack);
    return status == FF_OK ? FF_EXIT_OK : ff_command_fail(FF_BENCH_PROGRAM, &error);
}

int ff_bench_fig6_main(int argc, char **argv)
{
    growth_options given = {.agents = 0};
    const ff_option own[] = {{.name = "--agents",
                              .value_name = "N",
                              .help = "one crowd of N (default: 40, 100, 1000, 5000, 10000 and 20000)",
                              .integer = &given.agents,
                              .low = 2,
                              .high = 200000},
                             {.name = "--mcn", .help = "MCN only", .flag = &given.mcn_only},
                             {0}};
    const ff_bench_command command = {.name = "bench fig6",
                                      .summary = "what whole people cost, by the size of the crowd",
                                      .files = "where fig6.csv, .json and .png go; made if missing",
                                      .own = own};
    int status = ff_bench_parse(&command, argc, argv, &given.common);
    return status >= 0 ? status : run_fig6(&given);
}
