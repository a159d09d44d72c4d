/* bench_walk.c - `footfall-crowd bench walk`: how people walk, on courses of every kind: planted feet that slide, knees
 * that pop, joints faster than the database's, feet that scrape the floor or brush each other. */
#include "runtime/core/base/file.h"
#include "runtime/core/pack/pack.h"
#include "runtime/export/film_walk.h"
#include "runtime/export/gait_meter.h"
#include "runtime/export/metrics.h"
#include "runtime/export/scene.h"
#include "runtime/export/text.h"
#include "runtime/program/bench.h"
#include "runtime/program/bench_options.h"
#include "runtime/program/walk_drive.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SKATE_MEDIAN 0.001 /* m per plant */
#define SKATE_P95 0.003
#define RARE 1e-5 /* of all poses, that may be above a bar: commands that nobody would give make some */
#define FILM_SECONDS 12.0 /* of each course */

typedef struct walk_options {
    ff_bench_options common;
    const char *course, *synthesis;
    double seconds, step;
    int64_t seed;
    bool examples, check;
} walk_options;

/* Of all walkers of a course. */
typedef struct walk_row {
    const ff_course *course;
    ff_gait_meter total;
    double skate[3], seen[3]; /* m: median, 95th percentile, most */
} walk_row;

/* One course under way. */
typedef struct walk_watch {
    ff_gait_meter *meters;   /* [walkers] */
    ff_recording *recording; /* of the first walker, for the film; NULL = none */
} walk_watch;

static ff_status record(ff_recording *recording, const ff_walk_pose *pose, ff_error *error)
{
    if (recording->step_count * recording->step > FILM_SECONDS) return FF_OK;
    ff_status status = ff_recording_begin(recording, error);
    if (status != FF_OK) return status;
    ff_recording_set_track(recording, 0, &pose->state);
    if (ff_recording_wants_pose(recording)) ff_recording_set_pose(recording, 0, pose->hips, pose->rotations);
    return FF_OK;
}

static ff_status look(void *context, const ff_walk_pose *pose, ff_error *error)
{
    walk_watch *watch = context;
    if (watch->recording && pose->walker == 0) {
        ff_status status = record(watch->recording, pose, error);
        if (status != FF_OK) return status;
    }
    return ff_gait_meter_add(&watch->meters[pose->walker], pose->state.heading, pose->state.planted,
                             pose->hips, pose->rotations, error);
}

static void take_quantiles(ff_array *slides, double out[3])
{
    static const double at[3] = {0.5, 0.95, 1.0};
    for (int i = 0; i < 3; ++i)
        out[i] = ff_quantile(slides->data, slides->count, at[i]);
}

typedef struct walk_bench {
    const walk_options *options;
    ff_synthesis synthesis;
    ff_pack *pack;
    ff_figure figure;
    ff_gait_standard standard;
    ff_course *examples; /* as courses */
    json_t *rows;
    uint32_t walked, broken;
} walk_bench;

static ff_status walk_and_look(const walk_bench *bench, walk_row *row, walk_watch *watch, ff_error *error)
{
    const walk_options *options = bench->options;
    const ff_course *course = row->course;
    ff_walk_def def = {options->seconds, options->step, (uint64_t)options->seed, bench->synthesis};
    /* Scene time: several walkers of one course share it, those of a crowd are in the same scene. */
    if (course->kind != FF_COURSE_GOALS) def.seconds /= course->walkers;
    ff_status status = ff_gait_meter_create(&bench->standard, &row->total, error);
    for (uint32_t i = 0; i < course->walkers && status == FF_OK; ++i)
        status = ff_gait_meter_create(&bench->standard, &watch->meters[i], error);
    if (status == FF_OK) status = ff_walk_drive(bench->pack, course, &def, look, watch, error);
    for (uint32_t i = 0; i < course->walkers; ++i) {
        if (status == FF_OK) status = ff_gait_meter_finish(&watch->meters[i], error);
        if (status == FF_OK) status = ff_gait_meter_merge(&row->total, &watch->meters[i], error);
        ff_gait_meter_free(&watch->meters[i]);
    }
    take_quantiles(&row->total.skate.planted, row->skate);
    take_quantiles(&row->total.skate.seen, row->seen);
    return status;
}

/* A name as part of a file's: letters, digits, dots and dashes. */
static void file_name(const char *name, char *out, size_t size)
{
    size_t k = 0;
    for (; name[k] && k + 1 < size; ++k)
        out[k] = isalnum((unsigned char)name[k]) || name[k] == '.' ? name[k] : '-';
    out[k] = 0;
}

static ff_status film(const walk_bench *bench, const char *name, const ff_recording *recording,
                      ff_error *error)
{
    char path[4096], part[80];
    file_name(name, part, sizeof part);
    snprintf(path, sizeof path, "%s/%s.png", bench->options->common.out, part);
    return ff_film_walk_write(path, &bench->figure, recording, name, error);
}

static ff_status walk_course(const walk_bench *bench, walk_row *row, ff_error *error)
{
    ff_recording recording = {0};
    walk_watch watch = {.meters = ff_calloc(row->course->walkers, sizeof *watch.meters)};
    ff_status status = FF_OK;
    if (!watch.meters)
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory to watch %u walkers", row->course->walkers);
    if (bench->options->common.out) {
        double step = bench->options->step;
        status = ff_recording_create(1, bench->figure.joint_count, step, (uint64_t)(FILM_SECONDS / step) + 2,
                                     &recording, error);
        watch.recording = &recording;
    }
    if (status == FF_OK) status = walk_and_look(bench, row, &watch, error);
    if (status == FF_OK && watch.recording) status = film(bench, row->course->name, &recording, error);
    ff_recording_free(&recording);
    free(watch.meters);
    return status;
}

/* The first measure of a row that breaks its bar, or NULL. Captured runs reach 63,000 deg/s2 at the knee: no bar for those who
 * run. */
static const char *broken(const walk_row *row)
{
    const ff_gait_meter *m = &row->total;
    if (row->skate[0] > SKATE_MEDIAN || row->skate[1] > SKATE_P95) return "skate";
    if (!row->course->runs && (double)m->pops > RARE * (double)m->bends) return "knee";
    if ((double)m->fast > RARE * (double)m->poses) return "joint";
    if ((double)m->scraping > RARE * (double)m->swings) return "clearance";
    if (m->close > 0) return "ankles";
    return NULL;
}

static const char *const legend[] = {
    "skate    path of the ball per plant, mm: median, 95th percentile, most",
    "seen     the same while the ball is low and slow, whatever the walker says, mm",
    "knee     largest second difference of its bend, 1000 deg/s2; poses in a million above 30; when, s",
    "joint    fastest turn of a joint against its fastest in the pack; poses in a million above 1.5; which",
    "clear    lowest heel, ball or toe in mid swing, cm; swings in a thousand under 1 cm; when",
    "ankles   least distance on the ground, cm; poses in a million under 4 cm; when"};

static double per(uint64_t part, uint64_t whole, double unit)
{
    return whole > 0 ? unit * (double)part / (double)whole : 0.0;
}

static void print_header(void)
{
    for (size_t i = 0; i < sizeof legend / sizeof *legend; ++i)
        printf("  %s\n", legend[i]);
    printf("%-16s %6s  %5s %5s %5s  %5s %5s  %5s %6s %7s  %5s %6s %-10s %7s  %5s %5s %7s  %5s %6s %7s\n",
           "course", "plants", "skate", "p95", "most", "seen", "p95", "knee", "ppm", "at", "joint", "ppm",
           "which", "at", "clear", "low", "at", "ankle", "ppm", "at");
}

static void print_row(const walk_row *row, const ff_figure *figure)
{
    const ff_gait_meter *m = &row->total;
    const char *which = m->joint.known ? figure->name[m->joint.part] : "-", *bad = broken(row);
    printf("%-16s %6zu  %5.2f %5.2f %5.2f  %5.2f %5.2f  %5.1f %6.0f %7.2f  %5.2f %6.0f %-10.10s %7.2f  %5.2f "
           "%5.1f "
           "%7.2f  %5.1f %6.0f %7.2f  %s\n",
           row->course->name, m->skate.planted.count, 1e3 * row->skate[0], 1e3 * row->skate[1],
           1e3 * row->skate[2], 1e3 * row->seen[0], 1e3 * row->seen[1], 1e-3 * m->knee.value,
           per(m->pops, m->bends, 1e6), m->knee.time, m->joint.value, per(m->fast, m->poses, 1e6), which,
           m->joint.time, 100.0 * m->clearance.value, per(m->scraping, m->swings, 1e3), m->clearance.time,
           100.0 * m->ankles.value, per(m->close, m->poses, 1e6), m->ankles.time, bad ? bad : "");
}

static json_t *row_json(const walk_row *row, const ff_figure *figure)
{
    const ff_gait_meter *m = &row->total;
    const char *bad = broken(row);
    return json_pack("{s:s, s:I, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:s, s:f, s:f, s:f, s:f, s:f, s:s}",
                     "course", row->course->name, "plants", (json_int_t)m->skate.planted.count,
                     "skate_median_m", row->skate[0], "skate_p95_m", row->skate[1], "skate_most_m",
                     row->skate[2], "seen_median_m", row->seen[0], "knee_deg_per_s2", m->knee.value,
                     "knee_above_ppm", per(m->pops, m->bends, 1e6), "joint_ratio", m->joint.value, "joint",
                     m->joint.known ? figure->name[m->joint.part] : "", "joint_above_ppm",
                     per(m->fast, m->poses, 1e6), "clear_m", m->clearance.value, "scraping_per_thousand",
                     per(m->scraping, m->swings, 1e3), "ankles_m", m->ankles.value, "close_ppm",
                     per(m->close, m->poses, 1e6), "broken", bad ? bad : "");
}

static ff_status walk_one(walk_bench *bench, const ff_course *course, ff_error *error)
{
    walk_row row = {.course = course};
    ff_status status = walk_course(bench, &row, error);
    if (status == FF_OK) {
        print_row(&row, &bench->figure);
        fflush(stdout);
        json_array_append_new(bench->rows, row_json(&row, &bench->figure));
        ++bench->walked;
        bench->broken += broken(&row) != NULL;
    }
    ff_gait_meter_free(&row.total);
    return status;
}

/* The pack's examples that somebody goes anywhere by, as courses. */
static const ff_course *example_courses(walk_bench *bench, uint32_t *count)
{
    const ff_pack *pack = bench->pack;
    *count = 0;
    bench->examples = ff_calloc(pack->example_count, sizeof *bench->examples);
    for (uint32_t i = 0; bench->examples && i < pack->example_count; ++i) {
        const ff_pack_example *example = &pack->examples[i];
        if (example->flags & FF_EXAMPLE_IDLE) continue;
        bench->examples[(*count)++] = (ff_course){
            .name = ff_pack_string(pack, example->name),
            .kind = FF_COURSE_STEADY,
            .rates = {(double)example->v_forward, (double)example->v_left, (double)example->turn_rate},
            .walkers = 1,
            .runs = example->gait == FF_GAIT_RUN};
    }
    return bench->examples;
}

static ff_status walk_all(walk_bench *bench, ff_error *error)
{
    uint32_t count;
    const char *wanted = bench->options->course;
    const ff_course *courses = bench->options->examples ? example_courses(bench, &count) : ff_courses(&count);
    if (!courses) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the courses");
    ff_status status = FF_OK;
    print_header();
    for (uint32_t i = 0; i < count && status == FF_OK; ++i)
        if (!wanted || strstr(courses[i].name, wanted)) status = walk_one(bench, &courses[i], error);
    if (status == FF_OK && bench->walked == 0)
        status = ff_fail(error, FF_ERR_ARGUMENT, "no course is called '%s'", wanted);
    return status;
}

static int run_walk(const walk_options *options, ff_synthesis synthesis)
{
    ff_error error = {0};
    walk_bench bench = {.options = options, .synthesis = synthesis, .rows = json_array()};
    ff_status status = ff_pack_open(options->common.pack, &bench.pack, &error);
    if (status == FF_OK) status = ff_figure_from_pack(bench.pack, &bench.figure, &error);
    if (status == FF_OK)
        status = ff_gait_standard_make(bench.pack, &bench.figure, options->step, &bench.standard, &error);
    if (status == FF_OK && options->common.out) status = ff_folder_create(options->common.out, &error);
    if (status == FF_OK) status = walk_all(&bench, &error);
    if (status == FF_OK && options->common.json) {
        json_t *all =
            json_pack("{s:s, s:s, s:f, s:f, s:O}", "bench", "walk", "synthesis", ff_synthesis_name(synthesis),
                      "seconds", options->seconds, "dt", options->step, "rows", bench.rows);
        status = ff_bench_write_json(&options->common, "walk", all, &error);
    }
    json_decref(bench.rows);
    free(bench.examples);
    ff_pack_close(bench.pack);
    if (status != FF_OK) return ff_command_fail(FF_BENCH_PROGRAM, &error);
    if (options->check && bench.broken > 0) {
        fprintf(stderr, FF_BENCH_PROGRAM ": %u of %u courses break a bar\n", bench.broken, bench.walked);
        return FF_EXIT_FAILURE;
    }
    return FF_EXIT_OK;
}

int ff_bench_walk_main(int argc, char **argv)
{
    walk_options given = {.synthesis = "blending", .seconds = 60.0, .step = 1.0 / 60.0, .seed = 1};
    const ff_option own[] = {
        {.name = "--course",
         .value_name = "NAME",
         .help = "only courses with this in their name",
         .text = &given.course},
        {.name = "--examples",
         .help = "walk the pack's examples instead, one by one",
         .flag = &given.examples},
        {.name = "--synthesis",
         .value_name = "NAME",
         .help = "blending (default), semi-procedural or hybrid",
         .text = &given.synthesis},
        {.name = "--seconds",
         .value_name = "S",
         .help = "scene time of each course (default 60)",
         .number = &given.seconds,
         .low = 1.0,
         .high = 1e5},
        {.name = "--step",
         .value_name = "S",
         .help = "simulation step (default 1/60)",
         .number = &given.step,
         .low = 0.005,
         .high = 0.1},
        {.name = "--seed",
         .value_name = "N",
         .help = "of everything random (default 1)",
         .integer = &given.seed,
         .low = 0,
         .high = 1e9},
        {.name = "--check", .help = "fail when a course breaks a bar", .flag = &given.check},
        {0}};
    const ff_bench_command command = {
        .name = "bench walk",
        .summary = "how people walk: feet, knees, joints, on courses of every kind",
        .files = "where a film of each course goes, as pictures; made if missing",
        .own = own};
    int status = ff_bench_parse(&command, argc, argv, &given.common);
    if (status >= 0) return status;
    ff_synthesis synthesis = ff_synthesis_named(given.synthesis);
    if (synthesis == FF_SYNTHESIS_CROWD)
        return ff_bench_misuse(&command, "--synthesis", given.synthesis,
                               "blending, semi-procedural or hybrid");
    return run_walk(&given, synthesis);
}
