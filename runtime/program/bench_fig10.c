/* bench_fig10.c - `footfall-crowd bench fig10`: how bodies get past each other on footsteps, with little time to plan (footstep
 * planning paper, Figures 1 and 10), on a circle and crossing at random; by our planner and by the paper's formulation. */
#include "runtime/core/base/file.h"
#include "runtime/core/base/tasks.h"
#include "runtime/export/text.h"
#include "runtime/program/bench.h"
#include "runtime/program/bench_options.h"
#include "runtime/program/footstep_scenes.h"
#include "runtime/program/footstep_trial.h"
#include "runtime/tool/progress.h"

#include <stdio.h>
#include <string.h>

#define STEP (1.0 / 60.0)
#define TINY_NODES 20
#define NODES_MOST 20000
#define SIDE_BY_SIDE 64

typedef struct contact_row {
    const char *scene, *method;
    ff_walk_scene kind;
    uint32_t agents, nodes; /* per plan; under a budget of time as many as it lets one have */
    double budget_ms, seconds, density;
    int64_t share; /* of the seeds: one in so many is run */
    /* over all runs */
    int64_t runs, touched;
    double overlap, agent_seconds, deepest, speed, arrived, last;
    int64_t bodies_touched; /* the same of whole bodies */
    double body_overlap, body_deepest;
} contact_row;

static const contact_row rows[] = {
    {.scene = "four",
     .method = "ours",
     .kind = FF_WALK_FOUR,
     .agents = 4,
     .nodes = NODES_MOST,
     .budget_ms = 1.0,
     .seconds = 12.0,
     .share = 1},
    {.scene = "four",
     .method = "ours",
     .kind = FF_WALK_FOUR,
     .agents = 4,
     .nodes = 300,
     .seconds = 12.0,
     .share = 1},
    {.scene = "four",
     .method = "paper",
     .kind = FF_WALK_FOUR,
     .agents = 4,
     .nodes = NODES_MOST,
     .budget_ms = 1.0,
     .seconds = 12.0,
     .share = 1},
    {.scene = "four",
     .method = "paper",
     .kind = FF_WALK_FOUR,
     .agents = 4,
     .nodes = TINY_NODES,
     .seconds = 12.0,
     .share = 1},
    {.scene = "circle",
     .method = "ours",
     .kind = FF_WALK_CIRCLE,
     .agents = 40,
     .nodes = 300,
     .seconds = 40.0,
     .share = 20},
    {.scene = "circle",
     .method = "paper",
     .kind = FF_WALK_CIRCLE,
     .agents = 40,
     .nodes = 300,
     .seconds = 40.0,
     .share = 20},
    {.scene = "crossing",
     .method = "ours",
     .kind = FF_WALK_CROSSING,
     .agents = 200,
     .nodes = 300,
     .seconds = 20.0,
     .density = 0.1,
     .share = 20},
    {.scene = "crossing",
     .method = "paper",
     .kind = FF_WALK_CROSSING,
     .agents = 200,
     .nodes = 300,
     .seconds = 20.0,
     .density = 0.1,
     .share = 20},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

typedef struct contacts {
    const ff_bench_options *options;
    const ff_pack *pack;
    const ff_figure *figure;
    const char *speeds; /* or NULL: factors, between commas, at which walking steps are there, too */
    ff_tasks *tasks;
    contact_row row[ROWS];
    int count;
} contacts;

/* False when it is no list of factors. */
static bool take_speeds(const char *list, double out[FF_SPEED_VARIATIONS_MAX])
{
    for (int i = 0; list && *list; ++i) {
        char *end;
        double factor = strtod(list, &end);
        if (i == FF_SPEED_VARIATIONS_MAX || end == list || (*end != ',' && *end != '\0')) return false;
        if (!(factor >= 0.5 && factor <= 1.5)) return false;
        out[i] = factor;
        list = *end ? end + 1 : end;
    }
    return true;
}

static ff_walk_trial trial_of(const contacts *all, const contact_row *row, int64_t seed)
{
    ff_walk_trial trial = {.scene = row->kind,
                           .agents = row->agents,
                           .threads = 1,
                           .density = row->density,
                           .seconds = row->seconds,
                           .step = STEP,
                           .seed = (uint64_t)seed,
                           .planner = FF_PLANNER_FOOTSTEPS,
                           .bodies = true,
                           .footsteps = ff_crowd_def_default().footsteps};
    trial.footsteps.paper = row->method[0] == 'p';
    trial.footsteps.nodes = row->nodes;
    trial.footsteps.seconds = 1e-3 * row->budget_ms;
    take_speeds(all->speeds, trial.footsteps.speed_variations);
    return trial;
}

static int64_t runs_of(const contacts *all, const contact_row *row)
{
    int64_t runs = all->options->seeds / row->share;
    return runs > 0 ? runs : 1;
}

/* Runs side by side, one a thread. */
typedef struct batch {
    const contacts *all;
    const contact_row *row;
    int64_t first_seed;
    ff_walk_measures measures[SIDE_BY_SIDE];
    ff_status status[SIDE_BY_SIDE];
    ff_error error[SIDE_BY_SIDE];
} batch;

static void run_one(void *context, uint32_t index)
{
    batch *b = context;
    ff_walk_trial trial = trial_of(b->all, b->row, b->first_seed + index);
    b->status[index] =
        ff_walk_trial_run(b->all->pack, b->all->figure, &trial, &b->measures[index], &b->error[index]);
}

static void add_run(contact_row *row, const ff_walk_measures *m)
{
    ++row->runs;
    row->touched += m->deepest > 0.0;
    row->overlap += m->overlap * m->agent_seconds;
    row->agent_seconds += m->agent_seconds;
    row->deepest = m->deepest > row->deepest ? m->deepest : row->deepest;
    row->bodies_touched += m->body_deepest > 0.0;
    row->body_overlap += m->body_overlap * m->agent_seconds;
    row->body_deepest = m->body_deepest > row->body_deepest ? m->body_deepest : row->body_deepest;
    row->speed += m->speed_to_goal;
    row->arrived += m->arrived;
    row->last += m->last_arrival;
}

static ff_status run_row(contacts *all, contact_row *row, ff_progress *progress, ff_error *error)
{
    ff_status status = FF_OK;
    int64_t runs = runs_of(all, row), threads = all->options->threads;
    if (threads > SIDE_BY_SIDE) threads = SIDE_BY_SIDE;
    for (int64_t i = 0; i < runs && status == FF_OK; i += threads) {
        batch b = {.all = all, .row = row, .first_seed = all->options->first_seed + i};
        int64_t count = runs - i < threads ? runs - i : threads;
        ff_tasks_for(all->tasks, (uint32_t)count, 1, run_one, &b);
        for (int64_t k = 0; k < count && status == FF_OK; ++k) {
            status = b.status[k];
            if (status != FF_OK)
                *error = b.error[k];
            else
                add_run(row, &b.measures[k]);
            ff_progress_step(progress, row->scene);
        }
    }
    if (row->runs == 0) return status;
    row->overlap /= row->agent_seconds;
    row->body_overlap /= row->agent_seconds;
    row->speed /= (double)row->runs;
    row->last /= (double)row->runs;
    return status;
}

/* Pictures of four who cross, by either method with hardly any time. */
static ff_status draw_four(contacts *all, const contact_row *row, const char *path, ff_error *error)
{
    static const char *const when[FF_WALK_SHOTS] = {"setting out", "crossing", "past each other"};
    const char *title =
        row->method[0] == 'p' ? "Four who cross, as in the paper, 20 nodes" : "Four who cross, ours, 1 ms";
    return ff_walk_trial_draw(all->pack, all->figure, trial_of(all, row, all->options->first_seed), title,
                              when, path, error);
}

static void print_rows(const contacts *all)
{
    printf("%-9s %-6s %6s %10s %5s | %8s %9s %8s | %8s %9s %8s | %7s %9s %6s\n", "scene", "method", "agents",
           "budget", "runs", "touched", "overlap", "deepest", "bodies", "overlap", "deepest", "speed",
           "arrived", "last");
    printf("%-9s %-6s %6s %10s %5s | %8s %9s %8s | %8s %9s %8s | %7s %9s %6s\n", "", "", "", "", "", "%",
           "/100 s", "cm", "%", "/100 s", "cm", "m/s", "", "s");
    for (int i = 0; i < all->count; ++i) {
        const contact_row *row = &all->row[i];
        double percent = 100.0 / (double)row->runs;
        char budget[24];
        if (row->budget_ms > 0.0)
            snprintf(budget, sizeof budget, "%.0f ms", row->budget_ms);
        else
            snprintf(budget, sizeof budget, "%u nodes", row->nodes);
        printf(
            "%-9s %-6s %6u %10s %5lld | %8.2f %9.4f %8.1f | %8.2f %9.4f %8.1f | %7.2f %4.0f/%-4.0f %6.1f\n",
            row->scene, row->method, row->agents, budget, (long long)row->runs,
            percent * (double)row->touched, row->overlap, 100.0 * row->deepest,
            percent * (double)row->bodies_touched, row->body_overlap, 100.0 * row->body_deepest, row->speed,
            row->arrived, (double)row->agents * (double)row->runs, row->last);
    }
}

static json_t *rows_json(const contacts *all)
{
    json_t *list = json_array();
    for (int i = 0; i < all->count; ++i) {
        const contact_row *row = &all->row[i];
        json_array_append_new(
            list,
            json_pack("{s:s,s:s,s:I,s:f,s:I,s:I,s:I,s:f,s:f,s:I,s:f,s:f,s:f,s:f,s:f}", "scene", row->scene,
                      "method", row->method, "agents", (json_int_t)row->agents, "budget_ms", row->budget_ms,
                      "nodes", (json_int_t)row->nodes, "runs", (json_int_t)row->runs, "touched_runs",
                      (json_int_t)row->touched, "overlap", row->overlap, "deepest_m", row->deepest,
                      "bodies_touched_runs", (json_int_t)row->bodies_touched, "body_overlap",
                      row->body_overlap, "body_deepest_m", row->body_deepest, "speed_to_goal", row->speed,
                      "arrived", row->arrived, "last_arrival_s", row->last));
    }
    return json_pack("{s:s,s:I,s:I,s:o}", "bench", "fig10", "seeds", (json_int_t)all->options->seeds,
                     "first_seed", (json_int_t)all->options->first_seed, "rows", list);
}

static ff_status write_csv(const contacts *all, const char *path, ff_error *error)
{
    ff_text text = {0};
    ff_text_add(&text,
                "scene,method,agents,budget_ms,nodes,runs,touched_runs,overlap,deepest_m,bodies_touched_runs,"
                "body_overlap,body_deepest_m,speed_to_goal,arrived,last_arrival_s\n");
    for (int i = 0; i < all->count; ++i) {
        const contact_row *row = &all->row[i];
        ff_text_add(&text, "%s,%s,%u,%.1f,%u,%lld,%lld,%.5f,%.4f,%lld,%.5f,%.4f,%.3f,%.0f,%.2f\n", row->scene,
                    row->method, row->agents, row->budget_ms, row->nodes, (long long)row->runs,
                    (long long)row->touched, row->overlap, row->deepest, (long long)row->bodies_touched,
                    row->body_overlap, row->body_deepest, row->speed, row->arrived, row->last);
    }
    return ff_text_write(&text, path, error);
}

static ff_status write_files(contacts *all, ff_error *error)
{
    const ff_bench_options *options = all->options;
    char path[4096];
    ff_status status = ff_bench_write_json(options, "fig10", rows_json(all), error);
    if (status != FF_OK || !options->out) return status;
    snprintf(path, sizeof path, "%s/fig10.csv", options->out);
    status = write_csv(all, path, error);
    snprintf(path, sizeof path, "%s/fig10-ours.png", options->out);
    if (status == FF_OK) status = draw_four(all, &rows[0], path, error);
    snprintf(path, sizeof path, "%s/fig10-paper.png", options->out);
    if (status == FF_OK) status = draw_four(all, &rows[3], path, error);
    return status == FF_OK ? ff_footstep_scenes_draw(all->pack, options->out, error) : status;
}

/* Is it one of the rows that were asked for? NULL: all. */
static bool is_wanted(const contact_row *row, const char *scene, const char *method)
{
    return (!scene || strcmp(scene, row->scene) == 0) && (!method || strcmp(method, row->method) == 0);
}

static int run_fig10(const ff_bench_options *options, const char *scene, const char *method,
                     const char *speeds)
{
    ff_error error = {0};
    ff_pack *pack = NULL;
    ff_figure figure;
    contacts all = {.options = options, .figure = &figure, .speeds = speeds};
    uint64_t runs = 0;
    ff_status status = ff_pack_open(options->pack, &pack, &error);
    all.pack = pack;
    if (status == FF_OK) status = ff_figure_from_pack(pack, &figure, &error);
    if (status == FF_OK && options->out) status = ff_folder_create(options->out, &error);
    if (status == FF_OK) status = ff_tasks_create((uint32_t)options->threads, &all.tasks, &error);
    for (int i = 0; i < ROWS; ++i) {
        if (!is_wanted(&rows[i], scene, method)) continue;
        all.row[all.count++] = rows[i];
        runs += (uint64_t)runs_of(&all, &rows[i]);
    }
    ff_progress *progress = ff_progress_start("walking", runs, options->quiet);
    for (int i = 0; i < all.count && status == FF_OK; ++i)
        status = run_row(&all, &all.row[i], progress, &error);
    ff_progress_end(progress);
    if (status == FF_OK) {
        print_rows(&all);
        status = write_files(&all, &error);
    }
    ff_tasks_destroy(all.tasks);
    ff_pack_close(pack);
    return status == FF_OK ? FF_EXIT_OK : ff_command_fail(FF_BENCH_PROGRAM, &error);
}

int ff_bench_fig10_main(int argc, char **argv)
{
    ff_bench_options given = {.seeds = 100, .first_seed = 1, .threads = 1};
    const char *scene = NULL, *method = NULL, *speeds = NULL;
    double factors[FF_SPEED_VARIATIONS_MAX];
    const ff_option own[] = {
        {.name = "--scene",
         .value_name = "NAME",
         .help = "four, circle or crossing (default: all)",
         .text = &scene},
        {.name = "--method", .value_name = "NAME", .help = "ours or paper (default: both)", .text = &method},
        {.name = "--speeds",
         .value_name = "LIST",
         .help = "walking steps at these factors on their speed, too, as 0.8,1.25 (default: none)",
         .text = &speeds},
        {0}};
    const ff_bench_command command = {
        .name = "bench fig10",
        .summary = "how bodies get past each other on footsteps",
        .files = "where fig10.csv, fig10.json and pictures go: four who cross, two moving blocks (Figure 7), "
                 "a moved wall (8)",
        .seeds = "runs of the four (default 100); of the larger scenes one for every 20",
        .threads = "runs side by side (default 1); those with a budget in ms want a processor each",
        .own = own};
    int status = ff_bench_parse(&command, argc, argv, &given);
    if (status >= 0) return status;
    bool known = false, known_scene = false;
    for (int i = 0; i < ROWS; ++i) {
        known_scene = known_scene || is_wanted(&rows[i], scene, NULL);
        known = known || is_wanted(&rows[i], scene, method);
    }
    if (!take_speeds(speeds, factors))
        return ff_bench_misuse(&command, "--speeds", speeds, "at most 4 factors, 0.5 to 1.5");
    if (!known_scene) return ff_bench_misuse(&command, "--scene", scene, "four, circle or crossing");
    return known ? run_fig10(&given, scene, method, speeds)
                 : ff_bench_misuse(&command, "--method", method, "ours or paper");
}
