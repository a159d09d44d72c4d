/* bench_fig9.c - `footfall-crowd bench fig9`: frames per second of crowds on footsteps (footstep planning paper, Figure 9), by our
 * planner and by the paper's own formulation on the same bodies. A frame is a step of 1/60 s with the joints' matrices of
 * everybody; there is no drawing in it, as there was in the paper's. */
#include "runtime/core/base/file.h"
#include "runtime/export/bars.h"
#include "runtime/export/text.h"
#include "runtime/program/bench.h"
#include "runtime/program/bench_options.h"
#include "runtime/program/footstep_trial.h"
#include "runtime/tool/progress.h"

#include <stdio.h>

#define STEP (1.0 / 60.0)
#define ROWS_MOST 16
#define PAPER_ACTIONS 28
#define NODES_MOST 20000 /* under a budget of time: as many as it lets one have */

typedef struct frame_row {
    const char *method; /* "ours" or "paper" */
    uint32_t agents;
    double density, budget_ms; /* budget 0: 300 nodes per plan */
    uint32_t actions;          /* 0: all there are */
    const char *published;     /* frames per second in the paper */
    ff_walk_measures measures;
} frame_row;

/* The paper's: 5 to 40 agents, 10 and 50 ms; then the crowds that are to run in real time. */
static const frame_row rows[] = {{.method = "ours",
                                  .agents = 20,
                                  .density = 0.1,
                                  .budget_ms = 10,
                                  .actions = PAPER_ACTIONS,
                                  .published = "164"},
                                 {.method = "ours",
                                  .agents = 20,
                                  .density = 0.1,
                                  .budget_ms = 50,
                                  .actions = PAPER_ACTIONS,
                                  .published = "59"},
                                 {.method = "ours",
                                  .agents = 40,
                                  .density = 0.1,
                                  .budget_ms = 10,
                                  .actions = PAPER_ACTIONS,
                                  .published = "61"},
                                 {.method = "ours",
                                  .agents = 40,
                                  .density = 0.1,
                                  .budget_ms = 50,
                                  .actions = PAPER_ACTIONS,
                                  .published = "22"},
                                 {.method = "paper",
                                  .agents = 20,
                                  .density = 0.1,
                                  .budget_ms = 10,
                                  .actions = PAPER_ACTIONS,
                                  .published = "164"},
                                 {.method = "paper",
                                  .agents = 20,
                                  .density = 0.1,
                                  .budget_ms = 50,
                                  .actions = PAPER_ACTIONS,
                                  .published = "59"},
                                 {.method = "paper",
                                  .agents = 40,
                                  .density = 0.1,
                                  .budget_ms = 10,
                                  .actions = PAPER_ACTIONS,
                                  .published = "61"},
                                 {.method = "paper",
                                  .agents = 40,
                                  .density = 0.1,
                                  .budget_ms = 50,
                                  .actions = PAPER_ACTIONS,
                                  .published = "22"},
                                 {.method = "ours", .agents = 200, .density = 0.1},
                                 {.method = "paper", .agents = 200, .density = 0.1},
                                 {.method = "ours", .agents = 800, .density = 0.25},
                                 {.method = "ours", .agents = 2000, .density = 0.1}};
#define ROWS ((int)(sizeof rows / sizeof rows[0]))

typedef struct frames_options {
    ff_bench_options common;
    int64_t agents;
    double seconds;
} frames_options;

typedef struct frames {
    const frames_options *options;
    frame_row row[ROWS_MOST];
    int count;
} frames;

static bool is_paper(const frame_row *row)
{
    return row->method[0] == 'p';
}

static ff_walk_trial trial_of(const frames *all, const frame_row *row)
{
    ff_walk_trial trial = {.scene = FF_WALK_CROSSING,
                           .agents = row->agents,
                           .threads = (uint32_t)all->options->common.threads,
                           .density = row->density,
                           .seconds = all->options->seconds,
                           .step = STEP,
                           .seed = (uint64_t)all->options->common.first_seed,
                           .planner = FF_PLANNER_FOOTSTEPS,
                           .footsteps = ff_crowd_def_default().footsteps};
    trial.footsteps.paper = is_paper(row);
    trial.footsteps.actions = row->actions;
    if (row->budget_ms > 0.0) {
        trial.footsteps.seconds = 1e-3 * row->budget_ms;
        trial.footsteps.nodes = NODES_MOST;
    }
    return trial;
}

static ff_status run_rows(frames *all, const ff_pack *pack, const ff_figure *figure, ff_error *error)
{
    ff_status status = FF_OK;
    ff_progress *progress = ff_progress_start("walking", ROWS, all->options->common.quiet);
    for (int i = 0; i < ROWS && status == FF_OK; ++i) {
        if (all->options->agents > 0 && rows[i].agents != all->options->agents) continue;
        frame_row *row = &all->row[all->count++];
        *row = rows[i];
        ff_walk_trial trial = trial_of(all, row);
        status = ff_walk_trial_run(pack, figure, &trial, &row->measures, error);
        ff_progress_step(progress, row->method);
    }
    ff_progress_end(progress);
    return status;
}

static double fps(const ff_walk_measures *m)
{
    return 1e3 / m->frame_ms.mean;
}

static void print_rows(const frames *all)
{
    printf("%-6s %6s %8s %9s | %8s %9s %6s %9s %9s | %8s %9s %8s | %7s %9s %13s\n", "method", "agents",
           "per m2", "budget", "fps mean", "p99 ms", "paper", "CPU mean", "CPU p99", "no plan", "overlap",
           "deepest", "speed", "nodes", "ms a plan:");
    printf("%-6s %6s %8s %9s | %8s %9s %6s %9s %9s | %8s %9s %8s | %7s %9s %13s\n", "", "", "", "ms", "", "",
           "fps", "ms", "ms", "s", "/100 s", "cm", "m/s", "per plan", "50 %, 99 %");
    for (int i = 0; i < all->count; ++i) {
        const frame_row *row = &all->row[i];
        const ff_walk_measures *m = &row->measures;
        char budget[24];
        snprintf(budget, sizeof budget, row->budget_ms > 0.0 ? "%.0f" : "300 nodes", row->budget_ms);
        printf("%-6s %6u %8.2f %9s | %8.0f %9.2f %6s %9.2f %9.2f | %8.1f %9.3f %8.1f | %7.2f %9.0f %6.3f "
               "%6.2f\n",
               row->method, row->agents, row->density, budget, fps(m), m->frame_ms.p99,
               row->published ? row->published : "", m->work_ms.mean, m->work_ms.p99, m->no_plan, m->overlap,
               100.0 * m->deepest, m->speed_to_goal,
               m->counts.searches > 0 ? (double)m->counts.nodes / m->counts.searches : 0.0, m->plan_ms_median,
               m->plan_ms_p99);
    }
}

static json_t *rows_json(const frames *all)
{
    json_t *list = json_array();
    for (int i = 0; i < all->count; ++i) {
        const frame_row *row = &all->row[i];
        const ff_walk_measures *m = &row->measures;
        json_array_append_new(
            list,
            json_pack(
                "{s:s,s:I,s:f,s:f,s:I,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:I,s:I,s:I,s:I}",
                "method", row->method, "agents", (json_int_t)row->agents, "density", row->density,
                "budget_ms", row->budget_ms, "actions", (json_int_t)row->actions, "fps_mean", fps(m),
                "frame_ms_p99", m->frame_ms.p99, "frame_ms_max", m->frame_ms.most, "cpu_ms_mean",
                m->work_ms.mean, "cpu_ms_p99", m->work_ms.p99, "cpu_ms_max", m->work_ms.most, "plan_ms_mean",
                m->plan_ms_mean, "one_plan_ms_median", m->plan_ms_median, "one_plan_ms_p99", m->plan_ms_p99,
                "no_plan_s", m->no_plan, "overlap", m->overlap, "deepest_m", m->deepest, "speed_to_goal",
                m->speed_to_goal, "searches", (json_int_t)m->counts.searches, "plans",
                (json_int_t)m->counts.plans, "failed", (json_int_t)m->counts.failed, "nodes",
                (json_int_t)m->counts.nodes));
    }
    return json_pack("{s:s,s:I,s:f,s:f,s:o}", "bench", "fig9", "threads",
                     (json_int_t)all->options->common.threads, "step", STEP, "seconds", all->options->seconds,
                     "rows", list);
}

static ff_status write_csv(const frames *all, const char *path, ff_error *error)
{
    ff_text text = {0};
    ff_text_add(&text, "method,agents,density,budget_ms,actions,fps_mean,frame_ms_p99,cpu_ms_mean,cpu_ms_p99,"
                       "no_plan_s,overlap,deepest_m,"
                       "speed_to_goal,one_plan_ms_median,one_plan_ms_p99\n");
    for (int i = 0; i < all->count; ++i) {
        const frame_row *row = &all->row[i];
        const ff_walk_measures *m = &row->measures;
        ff_text_add(&text, "%s,%u,%.2f,%.0f,%u,%.1f,%.3f,%.3f,%.3f,%.2f,%.4f,%.4f,%.3f,%.4f,%.3f\n",
                    row->method, row->agents, row->density, row->budget_ms, row->actions, fps(m),
                    m->frame_ms.p99, m->work_ms.mean, m->work_ms.p99, m->no_plan, m->overlap, m->deepest,
                    m->speed_to_goal, m->plan_ms_median, m->plan_ms_p99);
    }
    return ff_text_write(&text, path, error);
}

static ff_status draw(const frames *all, const char *path, ff_error *error)
{
    static const char *const values[] = {"footsteps"};
    char names[ROWS_MOST][48];
    const char *groups[ROWS_MOST];
    double rate[ROWS_MOST], worst[ROWS_MOST], overlap[ROWS_MOST], speed[ROWS_MOST];
    for (int i = 0; i < all->count; ++i) {
        const frame_row *row = &all->row[i];
        if (row->budget_ms > 0.0)
            snprintf(names[i], sizeof names[i], "%s %u, %.0f ms", row->method, row->agents, row->budget_ms);
        else
            snprintf(names[i], sizeof names[i], "%s %u", row->method, row->agents);
        groups[i] = names[i];
        rate[i] = fps(&row->measures);
        worst[i] = row->measures.frame_ms.p99;
        overlap[i] = row->measures.overlap;
        speed[i] = row->measures.speed_to_goal;
    }
    const ff_bar_panel panels[] = {{"frames per second, mean", "1/s", rate},
                                   {"worst 1 % of frames", "ms", worst},
                                   {"bodies touch", "s in 100 s", overlap},
                                   {"speed towards the goal", "m/s", speed}};
    const ff_bar_chart chart = {.title = "Crowds on footsteps",
                                .subtitle =
                                    "Crossing at random; ours beside the paper's own formulation (Figure 9)",
                                .groups = groups,
                                .methods = values,
                                .group_count = all->count,
                                .method_count = 1,
                                .panel_count = 4,
                                .panels = panels};
    return ff_bars_write(path, &chart, error);
}

static ff_status write_files(const frames *all, ff_error *error)
{
    const ff_bench_options *common = &all->options->common;
    char path[4096];
    ff_status status = ff_bench_write_json(common, "fig9", rows_json(all), error);
    if (status != FF_OK || !common->out) return status;
    snprintf(path, sizeof path, "%s/fig9.csv", common->out);
    status = write_csv(all, path, error);
    snprintf(path, sizeof path, "%s/fig9.png", common->out);
    return status == FF_OK ? draw(all, path, error) : status;
}

static int run_fig9(const frames_options *options)
{
    ff_error error = {0};
    ff_pack *pack = NULL;
    ff_figure figure;
    frames all = {.options = options};
    ff_status status = ff_pack_open(options->common.pack, &pack, &error);
    if (status == FF_OK) status = ff_figure_from_pack(pack, &figure, &error);
    if (status == FF_OK && options->common.out) status = ff_folder_create(options->common.out, &error);
    if (status == FF_OK) status = run_rows(&all, pack, &figure, &error);
    if (status == FF_OK) {
        print_rows(&all);
        status = write_files(&all, &error);
    }
    ff_pack_close(pack);
    return status == FF_OK ? FF_EXIT_OK : ff_command_fail(FF_BENCH_PROGRAM, &error);
}

int ff_bench_fig9_main(int argc, char **argv)
{
    frames_options given = {.common = {.seeds = 1, .first_seed = 1, .threads = 2}, .seconds = 20.0};
    const ff_option own[] = {{.name = "--agents",
                              .value_name = "N",
                              .help = "only crowds of N: 20, 40, 200, 800 or 2000",
                              .integer = &given.agents,
                              .low = 1,
                              .high = 2000},
                             {.name = "--seconds",
                              .value_name = "S",
                              .help = "that each crowd walks (default 20)",
                              .number = &given.seconds,
                              .low = 0.5,
                              .high = 600},
                             {0}};
    const ff_bench_command command = {.name = "bench fig9",
                                      .summary = "frames per second of crowds on footsteps",
                                      .files = "where fig9.csv, fig9.json and fig9.png go; made if missing",
                                      .seeds = NULL,
                                      .threads = "of the crowd (default 2)",
                                      .own = own};
    int status = ff_bench_parse(&command, argc, argv, &given.common);
    if (status >= 0) return status;
    bool known = given.agents == 0;
    for (int i = 0; i < ROWS; ++i)
        known = known || rows[i].agents == given.agents;
    return known ? run_fig9(&given) : ff_bench_misuse(&command, "--agents", "N", "20, 40, 200, 800 or 2000");
}
