/* bench_hybrid.c - `footfall-crowd bench hybrid`: an obstacle course of walls walked by blending, semi-procedurally and by
 * the hybrid of both (FbCrowd, section 7.1): who collides, and who walks like people. */
#include "runtime/core/base/file.h"
#include "runtime/core/base/tasks.h"
#include "runtime/export/bars.h"
#include "runtime/export/film.h"
#include "runtime/export/text.h"
#include "runtime/export/trajectories.h"
#include "runtime/program/bench.h"
#include "runtime/program/bench_options.h"
#include "runtime/program/obstacle_course.h"
#include "runtime/tool/progress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { METHODS = 3 };
static const ff_synthesis methods[METHODS] = {FF_SYNTHESIS_BLENDING, FF_SYNTHESIS_SEMI_PROCEDURAL,
                                              FF_SYNTHESIS_HYBRID};

typedef struct hybrid_trial {
    ff_obstacle_course course;
    ff_obstacle_result result;
    ff_status status;
    ff_error error;
} hybrid_trial;

/* Over the seeds of one method. */
typedef struct hybrid_row {
    ff_synthesis synthesis;
    uint32_t agents, arrived;
    double collision_rate, deepest, body_deepest, body_pairs, wall_deepest,
        wall_share;                              /* m; deepest: of all seeds */
    double open, passage;                        /* m */
    double mean_arrival, last_arrival;           /* s */
    double skate_median, skate_p95, joint_speed; /* m, m, rad/s */
    double semi, changes, urgent; /* share of the time; per agent and minute; of those changes */
} hybrid_row;

typedef struct hybrid_bench {
    const ff_bench_options *options;
    ff_obstacle_course course; /* but for method and seed */
    ff_pack *pack;
    ff_figure figure;
    ff_pose_base base;
    hybrid_trial *trials; /* [method][seed] */
    ff_progress *progress;
    hybrid_row row[METHODS];
} hybrid_bench;

static void run_trial(void *context, uint32_t index)
{
    hybrid_bench *bench = context;
    hybrid_trial *trial = &bench->trials[index];
    trial->status = ff_obstacle_walk(bench->pack, &bench->figure, &bench->base, &trial->course,
                                     &trial->result, NULL, NULL, &trial->error);
    char item[64];
    snprintf(item, sizeof item, "%s, seed %llu", ff_synthesis_name(trial->course.synthesis),
             (unsigned long long)trial->course.seed);
    ff_progress_step(bench->progress, item);
}

static hybrid_row mean_of(const hybrid_trial *trials, uint32_t count)
{
    hybrid_row row = {.synthesis = trials->course.synthesis};
    ff_mean open = {0}, passage = {0}, wall = {0};
    double share = 1.0 / count, time = 0.0;
    for (uint32_t i = 0; i < count; ++i) {
        const ff_obstacle_result *r = &trials[i].result;
        const ff_measures *m = &r->measures;
        row.agents += m->agents;
        row.arrived += m->arrived;
        row.collision_rate += share * m->collision_rate;
        row.deepest = ff_max(row.deepest, m->deepest);
        row.body_deepest = ff_max(row.body_deepest, m->body_deepest);
        row.body_pairs += share * (double)m->body_pairs;
        row.wall_deepest = ff_max(row.wall_deepest, r->wall_deepest);
        row.mean_arrival += share * m->mean_arrival;
        row.last_arrival += share * m->last_arrival;
        row.skate_median += share * m->planted.median;
        row.skate_p95 += share * m->planted.p95;
        row.joint_speed = ff_max(row.joint_speed, m->joint_speed);
        row.semi += r->counts.semi_procedural_s;
        row.changes += (double)r->counts.transitions;
        row.urgent += (double)r->counts.urgent;
        time += r->counts.blending_s + r->counts.semi_procedural_s + r->counts.running_s;
        open.sum += r->open.sum, open.terms += r->open.terms;
        passage.sum += r->passage.sum, passage.terms += r->passage.terms;
        wall.sum += r->wall.sum, wall.terms += r->wall.terms;
    }
    row.open = ff_mean_value(open);
    row.passage = ff_mean_value(passage);
    row.wall_share = ff_mean_value(wall);
    row.urgent /= ff_max(row.changes, 1.0);
    row.semi /= ff_max(time, 1e-9);
    row.changes *= 60.0 / ff_max(time, 1e-9);
    return row;
}

static ff_status run_trials(hybrid_bench *bench, ff_error *error)
{
    uint32_t seeds = (uint32_t)bench->options->seeds, count = METHODS * seeds;
    ff_tasks *tasks = NULL;
    bench->trials = ff_calloc(count, sizeof *bench->trials);
    if (!bench->trials) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u runs", count);
    for (uint32_t i = 0; i < count; ++i) {
        bench->trials[i].course = bench->course;
        bench->trials[i].course.synthesis = methods[i / seeds];
        bench->trials[i].course.seed = (uint64_t)bench->options->first_seed + i % seeds;
    }
    ff_status status = ff_tasks_create((uint32_t)bench->options->threads, &tasks, error);
    if (status != FF_OK) return status;
    bench->progress = ff_progress_start("walking", count, bench->options->quiet);
    ff_tasks_for(tasks, count, 1, run_trial, bench);
    ff_progress_end(bench->progress);
    ff_tasks_destroy(tasks);
    for (uint32_t i = 0; i < count; ++i) {
        if (bench->trials[i].status == FF_OK) continue;
        if (error) *error = bench->trials[i].error;
        return bench->trials[i].status;
    }
    for (int m = 0; m < METHODS; ++m)
        bench->row[m] = mean_of(bench->trials + (size_t)m * seeds, seeds);
    return FF_OK;
}

static const char *const legend[] = {
    "C        collision rate of discs, eq 17, in 1e-4 per agent and step",
    "deep     deepest overlap of two discs in cm; of two bodies' cylinders; pairs of bodies that ever "
    "touched",
    "wall     deepest a body's cylinder is in a wall, in cm; share of the poses in which one is, in percent",
    "NN       distance to the nearest pose of the database in cm, of those who walk: in the open; in the "
    "passage",
    "mean ... s to the end of the course: mean, last, of those there",
    "skate    slide of planted feet in cm: median, 95th percentile",
    "joint    fastest joint between two updates, degrees/s",
    "semi     share of the time in which people walked semi-procedurally, percent; changes per agent and "
    "minute; of them urgent"};

static void print_table(const hybrid_bench *bench)
{
    printf("%lld seeds from %lld on, %u people through gaps of %.2f m\n", (long long)bench->options->seeds,
           (long long)bench->options->first_seed, bench->course.agents, bench->course.gap);
    for (size_t i = 0; i < sizeof legend / sizeof *legend; ++i)
        printf("  %s\n", legend[i]);
    printf("%-16s %6s %5s %5s %5s %5s %5s %6s %6s %9s %6s %6s %6s %6s %6s %5s %7s %6s\n", "", "C", "deep",
           "body", "pairs", "wall", "%", "open", "pass", "arrived", "mean", "last", "skate", "p95", "joint",
           "semi", "changes", "urgent");
    for (int m = 0; m < METHODS; ++m) {
        const hybrid_row *r = &bench->row[m];
        printf("%-16s %6.3f %5.1f %5.1f %5.1f %5.1f %5.2f %6.2f %6.2f %4u/%-4u %6.1f %6.1f %6.3f %6.3f %6.0f "
               "%5.1f %7.1f %5.0f%%\n",
               ff_synthesis_name(r->synthesis), 1e4 * r->collision_rate, 100.0 * r->deepest,
               100.0 * r->body_deepest, r->body_pairs, 100.0 * r->wall_deepest, 100.0 * r->wall_share,
               100.0 * r->open, 100.0 * r->passage, r->arrived, r->agents, r->mean_arrival, r->last_arrival,
               100.0 * r->skate_median, 100.0 * r->skate_p95, r->joint_speed / FF_DEG, 100.0 * r->semi,
               r->changes, 100.0 * r->urgent);
    }
}

static ff_status write_csv(const hybrid_bench *bench, const char *path, ff_error *error)
{
    ff_text text = {0};
    ff_text_add(&text, "synthesis,C,deepest_m,body_deepest_m,body_pairs,wall_deepest_m,wall_share,nn_open_m,"
                       "nn_passage_m,agents,arrived,mean_s,last_s,skate_median_m,skate_p95_m,joint_rad_s,"
                       "semi_procedural,changes_per_minute,urgent\n");
    for (int m = 0; m < METHODS; ++m) {
        const hybrid_row *r = &bench->row[m];
        ff_text_add(&text, "%s,%.8f,%.5f,%.5f,%.2f,%.5f,%.5f,%.5f,%.5f,%u,%u,",
                    ff_synthesis_name(r->synthesis), r->collision_rate, r->deepest, r->body_deepest,
                    r->body_pairs, r->wall_deepest, r->wall_share, r->open, r->passage, r->agents,
                    r->arrived);
        ff_text_add(&text, "%.3f,%.3f,%.6f,%.6f,%.3f,%.4f,%.3f,%.4f\n", r->mean_arrival, r->last_arrival,
                    r->skate_median, r->skate_p95, r->joint_speed, r->semi, r->changes, r->urgent);
    }
    return ff_text_write(&text, path, error);
}

static json_t *table_json(const hybrid_bench *bench)
{
    json_t *all = json_object();
    for (int m = 0; m < METHODS; ++m) {
        const hybrid_row *r = &bench->row[m];
        json_object_set_new(
            all, ff_synthesis_name(r->synthesis),
            json_pack("{s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:I,s:I,s:f,s:f,s:f,s:f,s:f,s:f,s:f,s:f}", "C",
                      r->collision_rate, "deepest_m", r->deepest, "body_deepest_m", r->body_deepest,
                      "body_pairs", r->body_pairs, "wall_deepest_m", r->wall_deepest, "wall_share",
                      r->wall_share, "nn_open_m", r->open, "nn_passage_m", r->passage, "agents",
                      (json_int_t)r->agents, "arrived", (json_int_t)r->arrived, "mean_s", r->mean_arrival,
                      "last_s", r->last_arrival, "skate_median_m", r->skate_median, "skate_p95_m",
                      r->skate_p95, "joint_rad_s", r->joint_speed, "semi_procedural", r->semi,
                      "changes_per_minute", r->changes, "urgent", r->urgent));
    }
    return json_pack("{s:s,s:I,s:I,s:f,s:o}", "bench", "hybrid", "seeds", (json_int_t)bench->options->seeds,
                     "first_seed", (json_int_t)bench->options->first_seed, "dt", bench->course.step,
                     "methods", all);
}

static ff_status write_chart(const hybrid_bench *bench, const char *path, ff_error *error)
{
    double walls[METHODS], discs[METHODS], open[METHODS], passage[METHODS], last[METHODS];
    const char *names[METHODS], *groups[1] = {"obstacle course"};
    for (int m = 0; m < METHODS; ++m) {
        const hybrid_row *r = &bench->row[m];
        names[m] = ff_synthesis_name(r->synthesis);
        discs[m] = 1e4 * r->collision_rate;
        walls[m] = 100.0 * r->wall_share;
        open[m] = 100.0 * r->open;
        passage[m] = 100.0 * r->passage;
        last[m] = r->last_arrival;
    }
    char subtitle[160];
    snprintf(subtitle, sizeof subtitle,
             "%u people wind through gaps of %.2f m, %lld seeds; lower is better everywhere",
             bench->course.agents, bench->course.gap, (long long)bench->options->seeds);
    const ff_bar_panel panels[] = {{"Collisions C", "1e-4 per agent and step", discs},
                                   {"Poses with a body in a wall", "percent", walls},
                                   {"Distance to the nearest recorded pose, in the open", "cm", open},
                                   {"... in the passage", "cm", passage},
                                   {"Last arrival", "s, mean over seeds", last}};
    ff_bar_chart chart = {
        "Blending, semi-procedural, hybrid", subtitle, groups, names, 1, METHODS, 5, panels};
    return ff_bars_write(path, &chart, error);
}

/* Paths and a film of the first seed, of each method. */
static ff_status draw_runs(const hybrid_bench *bench, const char *folder, ff_error *error)
{
    ff_status status = FF_OK;
    for (int m = 0; m < METHODS && status == FF_OK; ++m) {
        ff_obstacle_course course = bench->course;
        ff_obstacle_result result;
        ff_scene scene;
        ff_recording recording;
        char path[4096];
        course.synthesis = methods[m];
        course.seed = (uint64_t)bench->options->first_seed;
        status = ff_obstacle_walk(bench->pack, &bench->figure, &bench->base, &course, &result, &scene,
                                  &recording, error);
        snprintf(path, sizeof path, "%s/hybrid-%s.png", folder, ff_synthesis_name(methods[m]));
        if (status == FF_OK) status = ff_trajectories_write(path, &scene, &recording, error);
        snprintf(path, sizeof path, "%s/hybrid-%s-film.png", folder, ff_synthesis_name(methods[m]));
        if (status == FF_OK) status = ff_film_write(path, &bench->figure, &scene, &recording, error);
        ff_recording_free(&recording);
        ff_scene_free(&scene);
    }
    return status;
}

static ff_status write_files(const hybrid_bench *bench, ff_error *error)
{
    const char *out = bench->options->out;
    char path[4096];
    ff_status status = ff_bench_write_json(bench->options, "hybrid", table_json(bench), error);
    if (status != FF_OK || !out) return status;
    snprintf(path, sizeof path, "%s/hybrid.csv", out);
    status = write_csv(bench, path, error);
    snprintf(path, sizeof path, "%s/hybrid.png", out);
    if (status == FF_OK) status = write_chart(bench, path, error);
    if (status == FF_OK) status = draw_runs(bench, out, error);
    return status;
}

static int run_hybrid(hybrid_bench *bench)
{
    ff_error error = {0};
    ff_status status = ff_pack_open(bench->options->pack, &bench->pack, &error);
    if (status == FF_OK) status = ff_figure_from_pack(bench->pack, &bench->figure, &error);
    if (status == FF_OK) status = ff_pose_base_create(bench->pack, &bench->figure, &bench->base, &error);
    if (status == FF_OK) status = run_trials(bench, &error);
    if (status == FF_OK) {
        print_table(bench);
        status = write_files(bench, &error);
    }
    free(bench->trials);
    ff_pose_base_free(&bench->base);
    ff_pack_close(bench->pack);
    return status == FF_OK ? FF_EXIT_OK : ff_command_fail(FF_BENCH_PROGRAM, &error);
}

int ff_bench_hybrid_main(int argc, char **argv)
{
    ff_bench_options given = {.seeds = 5, .first_seed = 1, .threads = 1};
    int64_t agents = 12;
    double gap = 1.1, step = 1.0 / 30.0;
    const ff_option own[] = {{.name = "--agents",
                              .value_name = "N",
                              .help = "people (default 12)",
                              .integer = &agents,
                              .low = 1,
                              .high = 100},
                             {.name = "--gap",
                              .value_name = "M",
                              .help = "width of the gaps (default 1.1)",
                              .number = &gap,
                              .low = 0.7,
                              .high = 2.5},
                             {.name = "--step",
                              .value_name = "S",
                              .help = "simulation step (default 1/30)",
                              .number = &step,
                              .low = 0.005,
                              .high = 0.1},
                             {0}};
    const ff_bench_command command = {
        .name = "bench hybrid",
        .summary = "an obstacle course by blending, semi-procedurally and by both",
        .files = "where hybrid.csv, .json, .png, paths and films of the first seed go; made if missing",
        .seeds = "runs of each, with different people (default 5)",
        .threads = "runs at the same time (default 1)",
        .own = own};
    int status = ff_bench_parse(&command, argc, argv, &given);
    if (status >= 0) return status;
    hybrid_bench bench = {.options = &given,
                          .course = {.agents = (uint32_t)agents, .seconds = 120.0, .step = step, .gap = gap}};
    return run_hybrid(&bench);
}
