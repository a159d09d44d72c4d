#include "runtime/program/run.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/core/base/maths.h"
#include "runtime/export/bvh.h"
#include "runtime/export/csv.h"
#include "runtime/export/film.h"
#include "runtime/export/glb.h"
#include "runtime/export/trajectories.h"
#include "runtime/program/simulate.h"
#include "runtime/tool/command_line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PROGRAM "footfall-crowd"
#define CSV_INTERVAL 0.1 /* s */

typedef struct run_options {
    const char *scene, *pack, *out, *load, *save;
    int64_t agents, threads, seed; /* 0, 1, -1 = as the scene says */
    double seconds;                /* 0 = as the scene says */
    double save_at;                /* s; NAN = at the end */
    bool quiet, json;
} run_options;

/* Everything a run holds, so that one function gives it back. */
typedef struct crowd_run {
    const run_options *options;
    ff_pack *pack;
    ff_figure figure;
    ff_scene scene;
    ff_simulation simulation;
} crowd_run;

static ff_status load_scene(crowd_run *run, ff_error *error)
{
    const run_options *options = run->options;
    ff_scene_def def;
    ff_status status = ff_scene_def_load(options->scene, &def, error);
    if (status != FF_OK) return status;
    if (options->agents > 0) def.agents = options->agents;
    if (options->seconds > 0.0) def.seconds = options->seconds;
    if (options->seed >= 0) def.seed = (uint64_t)options->seed;
    if (options->agents > 0 && def.kind == FF_SCENE_CUSTOM)
        status = ff_fail(error, FF_ERR_ARGUMENT,
                         "--agents does not go with a custom scene, which lists its agents");
    else
        status = ff_scene_create(&def, &run->scene, error);
    ff_error_in_file(error, options->scene);
    ff_scene_def_free(&def);
    return status;
}

static void path_in(const crowd_run *run, const char *name, char *path, size_t size)
{
    snprintf(path, size, "%s/%s", run->options->out, name);
}

static ff_status write_csv(const crowd_run *run, const char *path, ff_error *error)
{
    return ff_csv_write(path, &run->scene, &run->simulation.recording, CSV_INTERVAL, error);
}

static ff_status write_bvh(const crowd_run *run, const char *path, ff_error *error)
{
    return ff_recording_write_bvh(path, &run->figure, &run->simulation.recording, 0, error);
}

static ff_status write_glb(const crowd_run *run, const char *path, ff_error *error)
{
    return ff_glb_write(path, &run->figure, &run->scene, &run->simulation.recording, error);
}

static ff_status write_trajectories(const crowd_run *run, const char *path, ff_error *error)
{
    return ff_trajectories_write(path, &run->scene, &run->simulation.recording, error);
}

static ff_status write_film(const crowd_run *run, const char *path, ff_error *error)
{
    return ff_film_write(path, &run->figure, &run->scene, &run->simulation.recording, error);
}

typedef struct output {
    const char *name;
    ff_status (*write)(const crowd_run *run, const char *path, ff_error *error);
} output;

static const output outputs[] = {{"crowd.glb", write_glb},
                                 {"crowd.csv", write_csv},
                                 {"agent-0.bvh", write_bvh},
                                 {"trajectories.png", write_trajectories},
                                 {"film.png", write_film}};
enum { OUTPUT_COUNT = sizeof outputs / sizeof outputs[0] };

static ff_status write_outputs(const crowd_run *run, ff_error *error)
{
    for (int i = 0; i < OUTPUT_COUNT; ++i) {
        char path[4096];
        path_in(run, outputs[i].name, path, sizeof path);
        if (!run->options->quiet) fprintf(stderr, "writing %s\n", path);
        ff_status status = outputs[i].write(run, path, error);
        if (status != FF_OK) return status;
    }
    return FF_OK;
}

static ff_status write_metrics(crowd_run *run, json_t **metrics, ff_error *error)
{
    ff_simulation *simulation = &run->simulation;
    ff_run_facts facts = {.scene_path = run->options->scene,
                          .pack_path = run->options->pack,
                          .threads = simulation->threads,
                          .seed = run->scene.seed,
                          .state_hash = simulation->state_hash,
                          .counts = simulation->counts,
                          .timings = simulation->timings,
                          .synthesis = simulation->synthesis};
    char path[4096];
    path_in(run, "metrics.json", path, sizeof path);
    *metrics = ff_watch_report(&simulation->watch, &simulation->recording, &facts);
    char *text = *metrics ? json_dumps(*metrics, JSON_INDENT(2) | JSON_REAL_PRECISION(6)) : NULL;
    if (!text) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %s", path);
    ff_status status = ff_file_write_atomic(path, text, strlen(text), error);
    free(text);
    return status;
}

static void print_json(const crowd_run *run, json_t *metrics)
{
    json_t *files = json_array();
    char path[4096];
    for (int i = 0; i < OUTPUT_COUNT; ++i) {
        path_in(run, outputs[i].name, path, sizeof path);
        json_array_append_new(files, json_string(path));
    }
    path_in(run, "metrics.json", path, sizeof path);
    json_array_append_new(files, json_string(path));
    json_object_set_new(metrics, "files", files);
    json_dumpf(metrics, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(6));
    putchar('\n');
}

static double figure_of(const json_t *metrics, const char *group, const char *key)
{
    const json_t *object = group ? json_object_get(metrics, group) : metrics;
    return json_number_value(json_object_get(object, key));
}

static void print_summary(const crowd_run *run, const json_t *metrics)
{
    const ff_crowd_counts *counts = &run->simulation.counts;
    if (ff_scene_has_behaviour(&run->scene))
        printf("%llu people, %llu of whom came in and %llu left by an exit",
               (unsigned long long)counts->added, (unsigned long long)counts->spawned,
               (unsigned long long)counts->left);
    else
        printf("%.0f of %.0f agents reached their goals", figure_of(metrics, NULL, "reached"),
               figure_of(metrics, NULL, "agents"));
    printf(" in %.1f s (seed %.0f, state %s)\n", figure_of(metrics, NULL, "seconds"),
           figure_of(metrics, NULL, "seed"), json_string_value(json_object_get(metrics, "state_hash")));
    printf(
        "foot skate %.2f cm per plant in the median, %.2f at the 95th percentile; deepest overlap %.1f cm; "
        "%.1f us per agent and step\n",
        figure_of(metrics, "foot_skate_cm", "median"), figure_of(metrics, "foot_skate_cm", "p95"),
        100.0 * figure_of(metrics, NULL, "max_penetration_m"),
        figure_of(metrics, "step_us_per_agent", "total"));
    for (int i = 0; i < OUTPUT_COUNT; ++i)
        printf("%s/%s\n", run->options->out, outputs[i].name);
    printf("%s/metrics.json\n", run->options->out);
}

static int run_scene(const run_options *options)
{
    ff_error error = {0};
    crowd_run run = {.options = options};
    json_t *metrics = NULL;
    ff_status status = load_scene(&run, &error);
    if (status == FF_OK) status = ff_pack_open(options->pack, &run.pack, &error);
    if (status == FF_OK) status = ff_figure_from_pack(run.pack, &run.figure, &error);
    if (status == FF_OK) status = ff_folder_create(options->out, &error);
    if (status == FF_OK) {
        run.simulation = (ff_simulation){.pack = run.pack,
                                         .scene = &run.scene,
                                         .figure = &run.figure,
                                         .threads = (uint32_t)options->threads,
                                         .load = options->load,
                                         .save = options->save,
                                         .save_at = isnan(options->save_at) ? INFINITY : options->save_at,
                                         .quiet = options->quiet};
        status = ff_simulate(&run.simulation, &error);
    }
    if (status == FF_OK) status = write_outputs(&run, &error);
    if (status == FF_OK) status = write_metrics(&run, &metrics, &error);
    if (status == FF_OK && options->json)
        print_json(&run, metrics);
    else if (status == FF_OK && !options->quiet)
        print_summary(&run, metrics);
    json_decref(metrics);
    ff_simulation_free(&run.simulation);
    ff_scene_free(&run.scene);
    ff_pack_close(run.pack);
    return status == FF_OK ? FF_EXIT_OK : ff_command_fail(PROGRAM, &error);
}

int ff_run_main(int argc, char **argv)
{
    run_options given = {.agents = 0, .threads = 1, .seed = -1, .save_at = NAN};
    ff_option options[] = {
        {.name = "--pack", .alias = "-p", .value_name = "FILE", .help = "motion pack", .text = &given.pack},
        {.name = "--out",
         .alias = "-o",
         .value_name = "FOLDER",
         .help = "where the files go; made if missing",
         .text = &given.out},
        {.name = "--agents",
         .value_name = "N",
         .help = "how many, instead of the scene's number",
         .integer = &given.agents,
         .low = 1,
         .high = 20000},
        {.name = "--seconds",
         .value_name = "S",
         .help = "longest time, instead of the scene's",
         .number = &given.seconds,
         .low = 0.1,
         .high = 3600},
        {.name = "--threads",
         .value_name = "N",
         .help = "threads that step the crowd (default 1)",
         .integer = &given.threads,
         .low = 1,
         .high = 256},
        {.name = "--seed",
         .value_name = "N",
         .help = "seed, instead of the scene's",
         .integer = &given.seed,
         .low = 0,
         .high = 9007199254740992.0},
        {.name = "--save",
         .value_name = "FILE",
         .help = "save the crowd's whole state, to go on from with --load",
         .text = &given.save},
        {.name = "--save-at",
         .value_name = "S",
         .help = "at this time of the scene (default: at the end)",
         .number = &given.save_at,
         .low = 0,
         .high = 3600},
        {.name = "--load",
         .value_name = "FILE",
         .help = "go on from a saved crowd of this scene; what is written tells of the rest",
         .text = &given.load},
        {.name = "--quiet", .alias = "-q", .help = "print errors only", .flag = &given.quiet},
        {.name = "--json", .help = "print the metrics and the files' names as JSON", .flag = &given.json},
        {0}};
    const ff_command command = {.program = PROGRAM,
                                .name = "run",
                                .arguments = "SCENE.json",
                                .summary = "run a scene on a motion pack and write what happened to files",
                                .details = "Runs until everyone has reached their goal, or the time is over.",
                                .options = options,
                                .min_operands = 1,
                                .max_operands = 1};
    ff_operands operands;
    int status = ff_command_parse(&command, argc, argv, &operands);
    if (status < 0) {
        given.scene = operands.items[0];
        if (!given.pack || !given.out) {
            status =
                ff_command_misuse(&command, "%s is missing", given.pack ? "--out FOLDER" : "--pack FILE");
        } else if (!isnan(given.save_at) && !given.save) {
            status = ff_command_misuse(&command, "--save-at needs --save FILE");
        } else {
            status = run_scene(&given);
        }
    }
    return status;
}
