/* bench_astar.c - `footfall-crowd bench astar`: what the search for footsteps costs and how good its plans are: among people, by
 * budget, by horizon, by inflation, and the footstep paper's own formulation beside ours. */
#include "runtime/core/base/file.h"
#include "runtime/export/bars.h"
#include "runtime/export/text.h"
#include "runtime/program/bench.h"
#include "runtime/program/bench_options.h"
#include "runtime/program/plan_load.h"
#include "runtime/program/plan_scenes.h"
#include "runtime/tool/progress.h"

#include <stdio.h>
#include <stdlib.h>

static const double DISTANCE = 5.0; /* m, to the goals */
enum { ROWS_MAX = 64, SIZES = 3 };
static const uint32_t sizes[SIZES] = {0, 8, 64}; /* people in view */

typedef struct astar_options {
    ff_bench_options common;
    int64_t problems;
} astar_options;

typedef struct astar_row {
    const char *part, *formulation;
    uint32_t agents, nodes, horizon;
    double inflation;
    ff_plan_load load;
} astar_row;

typedef struct astar {
    const astar_options *options;
    ff_action_set *set;
    ff_plan_scratch *scratch;
    ff_plan_street *street[SIZES]; /* [common.seeds] of each size */
    double *exact;                 /* of each problem in the open */
    astar_row row[ROWS_MAX];
    int count;
    ff_progress *progress;
} astar;

/* ------------------------------------------------------------------------------------------------- formulations */

/* Plain A* with the straight-line heuristic, every child tested, 12 actions ahead, plans that end anywhere; B.5's budget. */
static ff_plan_options paper(void)
{
    ff_plan_options o = ff_plan_options_default();
    o.nodes = 2000;
    o.horizon = 12;
    o.time_horizon = 0.0;
    o.inflation = 1.0;
    o.inflation_step = 0.0;
    o.wait = 1.0;
    o.lazy = o.safe = o.table = o.merge = 0;
    return o;
}

/* One round to the goal, however far ahead in time. */
static ff_plan_options to_goal(double inflation, bool table)
{
    ff_plan_options o = ff_plan_options_default();
    o.nodes = o.improve = 20000;
    o.horizon = 20;
    o.time_horizon = 0.0;
    o.inflation = inflation;
    o.inflation_step = 0.0;
    o.table = table;
    return o;
}

static ff_status measure(astar *all, const char *part, const char *formulation, int size,
                         const ff_plan_options *o, const double *exact, double *costs, ff_error *error)
{
    if (all->count == ROWS_MAX) return FF_OK;
    astar_row *row = &all->row[all->count++];
    *row = (astar_row){.part = part,
                       .formulation = formulation,
                       .agents = sizes[size],
                       .nodes = o->nodes,
                       .horizon = o->horizon,
                       .inflation = o->inflation};
    ff_progress_step(all->progress, formulation);
    return ff_plan_load_measure(all->street[size], (uint32_t)all->options->common.seeds, o,
                                (uint32_t)all->options->problems, DISTANCE, exact, costs, &row->load, error);
}

static ff_status measure_people(astar *all, ff_error *error)
{
    ff_status status = FF_OK;
    for (int s = 0; s < SIZES && status == FF_OK; ++s) {
        ff_plan_options o = ff_plan_options_default(), quick = o, tested = o, plain = paper();
        quick.inflation_step = 0.0;
        tested.lazy = 0;
        status = measure(all, "people", "ours", s, &o, NULL, NULL, error);
        if (status == FF_OK)
            status = measure(all, "people", "ours, first plan", s, &quick, NULL, NULL, error);
        if (status == FF_OK)
            status = measure(all, "people", "ours, all tested", s, &tested, NULL, NULL, error);
        if (status == FF_OK) status = measure(all, "people", "paper", s, &plain, NULL, NULL, error);
    }
    return status;
}

static ff_status measure_limits(astar *all, ff_error *error)
{
    static const uint32_t budgets[] = {50, 200, 1000, 5000}, horizons[] = {1, 2, 4, 8, 12};
    ff_status status = FF_OK;
    for (int i = 0; i < 4 && status == FF_OK; ++i) {
        ff_plan_options o = ff_plan_options_default(), plain = paper();
        o.nodes = plain.nodes = budgets[i];
        status = measure(all, "budget", "ours", 2, &o, NULL, NULL, error);
        if (status == FF_OK) status = measure(all, "budget", "paper", 2, &plain, NULL, NULL, error);
    }
    for (int i = 0; i < 5 && status == FF_OK; ++i) {
        ff_plan_options o = ff_plan_options_default(), plain = paper();
        o.horizon = plain.horizon = horizons[i];
        status = measure(all, "horizon", "ours", 1, &o, NULL, NULL, error);
        if (status == FF_OK) status = measure(all, "horizon", "paper", 1, &plain, NULL, NULL, error);
    }
    return status;
}

static ff_status measure_quality(astar *all, ff_error *error)
{
    static const double inflations[] = {1.0, 1.5, 2.0, 2.5};
    ff_plan_options exact = to_goal(1.0, false);
    ff_status status = measure(all, "quality", "straight line", 0, &exact, NULL, all->exact, error);
    for (int i = 0; i < 4 && status == FF_OK; ++i) {
        ff_plan_options straight = to_goal(inflations[i], false), table = to_goal(inflations[i], true);
        if (i > 0) status = measure(all, "quality", "straight line", 0, &straight, all->exact, NULL, error);
        if (status == FF_OK)
            status = measure(all, "quality", "reach table", 0, &table, all->exact, NULL, error);
    }
    ff_plan_options ours = to_goal(2.0, true);
    ours.inflation_step = 0.5;
    ours.nodes = ours.improve = 1000;
    return status == FF_OK ? measure(all, "quality", "ours, anytime", 0, &ours, all->exact, NULL, error)
                           : status;
}

/* ------------------------------------------------------------------------------------------------------ printing */

static void print_row(const astar_row *r)
{
    const ff_plan_load *l = &r->load;
    printf("%-8s %-17s %6u %6u %7u %5.1f %6.0f %6.0f %9.2f %8.3f %8.3f %8.3f %5.0f %5.0f %5.0f %5.0f %7.2f",
           r->part, r->formulation, r->agents, r->nodes, r->horizon, r->inflation, l->expanded_median,
           l->expanded_p90, 1e-6 * l->children_per_s, l->ms_median, l->ms_worst, l->ms_p99,
           100.0 * l->reached, 100.0 * l->ahead, 100.0 * l->part, 100.0 * l->none, l->progress);
    if (l->ratio_median > 0.0) printf("  %.3f %.3f", l->ratio_median, l->ratio_p95);
    puts("");
}

static void print_table(const astar *all)
{
    printf(
        "%lld plans a row, in %lld streets: from standing, with a random heading, to goals %.0f m away all "
        "around; one thread\n",
        (long long)all->options->problems, (long long)all->options->common.seeds, DISTANCE);
    puts(
        "  agents      in view, within 9 m, each on a plan of its own that leaves room for who stands there");
    puts("  expanded    nodes a plan, median and 90 %; children: generated, in millions a second");
    puts("  ms          a plan: median, the same in the worst street, and 99 %");
    puts("  %           goal reached; as far as the time horizon; as far as the budget or horizon; no plan");
    puts("  progress    m towards the goal where the plan ends");
    puts("  cost        to the least there is, median and 95 %: in the open, against A* with the straight "
         "line");
    printf("%-8s %-17s %6s %6s %7s %5s %13s %9s %26s %5s %5s %5s %5s %7s  %s\n", "", "", "agents", "nodes",
           "horizon", "eps", "expanded", "children", "ms", "goal", "ahead", "part", "none", "prog.", "cost");
    for (int i = 0; i < all->count; ++i)
        print_row(&all->row[i]);
}

static ff_status write_csv(const astar *all, const char *path, ff_error *error)
{
    ff_text text = {0};
    ff_text_add(
        &text,
        "part,formulation,agents,nodes,horizon,inflation,expanded_median,expanded_p90,children_per_s,"
        "expanded_per_s,tested_per_s,ms_median,ms_worst,ms_p99,reached,ahead,part,none,progress,cost_median,"
        "cost_p95\n");
    for (int i = 0; i < all->count; ++i) {
        const astar_row *r = &all->row[i];
        const ff_plan_load *l = &r->load;
        ff_text_add(&text,
                    "%s,\"%s\",%u,%u,%u,%.2f,%.0f,%.0f,%.0f,%.0f,%.0f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%."
                    "3f,%.4f,%.4f\n",
                    r->part, r->formulation, r->agents, r->nodes, r->horizon, r->inflation,
                    l->expanded_median, l->expanded_p90, l->children_per_s, l->expanded_per_s,
                    l->tested_per_s, l->ms_median, l->ms_worst, l->ms_p99, l->reached, l->ahead, l->part,
                    l->none, l->progress, l->ratio_median, l->ratio_p95);
    }
    return ff_text_write(&text, path, error);
}

static json_t *table_json(const astar *all)
{
    json_t *rows = json_array();
    for (int i = 0; i < all->count; ++i) {
        const astar_row *r = &all->row[i];
        const ff_plan_load *l = &r->load;
        json_array_append_new(
            rows,
            json_pack("{s:s,s:s,s:i,s:i,s:i,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f}",
                      "part", r->part, "formulation", r->formulation, "agents", (int)r->agents, "nodes",
                      (int)r->nodes, "horizon", (int)r->horizon, "inflation", r->inflation, "expanded_median",
                      l->expanded_median, "expanded_p90", l->expanded_p90, "children_per_s",
                      l->children_per_s, "expanded_per_s", l->expanded_per_s, "ms_median", l->ms_median,
                      "ms_worst", l->ms_worst, "ms_p99", l->ms_p99, "reached", l->reached, "ahead", l->ahead,
                      "partial", l->part, "none", l->none, "progress", l->progress, "cost_median",
                      l->ratio_median, "cost_p95", l->ratio_p95));
    }
    return json_pack("{s:s,s:i,s:i,s:i,s:o}", "bench", "astar", "problems", (int)all->options->problems,
                     "streets", (int)all->options->common.seeds, "first_seed",
                     (int)all->options->common.first_seed, "rows", rows);
}

static ff_status write_files(const astar *all, ff_error *error)
{
    const ff_bench_options *common = &all->options->common;
    char path[4096];
    ff_status status = ff_bench_write_json(common, "astar", table_json(all), error);
    if (status != FF_OK || !common->out) return status;
    snprintf(path, sizeof path, "%s/astar.csv", common->out);
    status = write_csv(all, path, error);
    snprintf(path, sizeof path, "%s/astar.png", common->out);
    if (status == FF_OK)
        status = ff_plan_scenes_write(path, all->street[0], all->street[1], all->street[2], error);
    return status;
}

static ff_status make_streets(astar *all, const ff_pack *pack, ff_error *error)
{
    const ff_bench_options *common = &all->options->common;
    ff_status status = ff_action_set_create(pack, 0, &all->set, error);
    if (status == FF_OK) status = ff_plan_scratch_create(all->set, FF_PLAN_LOAD_NODES, &all->scratch, error);
    for (int size = 0; size < SIZES && status == FF_OK; ++size) {
        all->street[size] = calloc((size_t)common->seeds, sizeof *all->street[size]);
        if (!all->street[size]) return ff_fail(error, FF_ERR_NO_MEMORY, "the streets of a bench");
        for (int64_t i = 0; i < common->seeds && status == FF_OK; ++i)
            status = ff_plan_street_create(all->set, all->scratch, sizes[size],
                                           (uint64_t)(common->first_seed + i), &all->street[size][i], error);
    }
    return status;
}

static void destroy_streets(astar *all)
{
    for (int size = 0; size < SIZES; ++size) {
        for (int64_t i = 0; all->street[size] && i < all->options->common.seeds; ++i)
            ff_plan_street_destroy(&all->street[size][i]);
        free(all->street[size]);
    }
    ff_plan_scratch_destroy(all->scratch);
    ff_action_set_destroy(all->set);
}

static ff_status measure_all(astar *all, const ff_pack *pack, ff_error *error)
{
    all->exact = calloc((size_t)all->options->problems, sizeof *all->exact);
    if (!all->exact) return ff_fail(error, FF_ERR_NO_MEMORY, "the figures of a bench");
    ff_status status = make_streets(all, pack, error);
    all->progress = ff_progress_start("planning", 39, all->options->common.quiet);
    if (status == FF_OK) status = measure_people(all, error);
    if (status == FF_OK) status = measure_limits(all, error);
    if (status == FF_OK) status = measure_quality(all, error);
    ff_progress_end(all->progress);
    return status;
}

static int run_astar(const astar_options *options)
{
    ff_error error = {0};
    ff_pack *pack = NULL;
    astar all = {.options = options};
    ff_status status = ff_pack_open(options->common.pack, &pack, &error);
    if (status == FF_OK) status = measure_all(&all, pack, &error);
    if (status == FF_OK) {
        print_table(&all);
        status = write_files(&all, &error);
    }
    destroy_streets(&all);
    free(all.exact);
    ff_pack_close(pack);
    return status == FF_OK ? FF_EXIT_OK : ff_command_fail(FF_BENCH_PROGRAM, &error);
}

int ff_bench_astar_main(int argc, char **argv)
{
    astar_options given = {.common = {.seeds = 6, .first_seed = 1}, .problems = 200};
    const ff_option own[] = {{.name = "--problems",
                              .value_name = "N",
                              .help = "plans a row (default 200)",
                              .integer = &given.problems,
                              .low = 1,
                              .high = 10000},
                             {0}};
    const ff_bench_command command = {.name = "bench astar",
                                      .summary = "the search for footsteps: its cost and its plans",
                                      .seeds = "streets that the plans are spread over (default 6)",
                                      .files = "where astar.csv, .json and .png go; made if missing",
                                      .own = own};
    int status = ff_bench_parse(&command, argc, argv, &given.common);
    return status >= 0 ? status : run_astar(&given);
}
