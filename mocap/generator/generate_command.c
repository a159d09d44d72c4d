#include "mocap/generator/generator.h"
#include "mocap/print.h"
#include "mocap/write.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/tool/command_line.h"
#include "runtime/tool/progress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const PROGRAM = "footfall-pack";

typedef struct ff_generate_job {
    const char *folder;
    bool bvh, amc;
    ff_generator_options options;
    ff_print truth, catalogue;
    int listed;
} ff_generate_job;

static ff_status clip_path(const char *folder, const char *name, const char *ending, char path[1024],
                           ff_error *error)
{
    int length = snprintf(path, 1024, "%s/%s.%s", folder, name, ending);
    if (length < 0 || length >= 1024)
        return ff_fail(error, FF_ERR_ARGUMENT, "the path %.200s... is too long", folder);
    return FF_OK;
}

/* The columns of foot-contact labels, so that a scoring program can read them as labels. */
static void add_truth(ff_print *out, const ff_generator_info *info, const ff_generated *made)
{
    for (int i = 0; i < made->plant_count; ++i) {
        const ff_true_plant *p = &made->plants[i];
        char line[320];
        bool partial = (p->cut_start || p->cut_end) && (p->flat_start < 0 || p->end - p->start < 29);
        snprintf(line, sizeof line, "%s,%s,%c,%d,%d,%d,%d,%d,%d,%d,1.0,", info->name, info->mode,
                 p->foot == 0 ? 'L' : 'R', p->start, p->end, p->flat_start, p->flat_end, p->cut_start ? 1 : 0,
                 p->cut_end ? 1 : 0, partial ? 1 : 0);
        ff_print_text(out, line);
        const double numbers[] = {p->ball.x, p->ball.y, p->ball.z, p->yaw / FF_DEG};
        for (int k = 0; k < 4; ++k) {
            ff_print_number(out, numbers[k], k < 3 ? 6 : 4);
            ff_print_text(out, ",");
        }
        ff_print_integer(out, made->clip.frame_count);
        ff_print_text(out, "\n");
    }
}

/* One line of the catalogue; tags are a list of words in it. */
static void add_listing(ff_generate_job *job, const ff_generator_info *info)
{
    ff_print *out = &job->catalogue;
    ff_print_text(out, job->listed++ ? ",\n" : "");
    ff_print_text(out, "        { \"file\": \"");
    ff_print_text(out, info->name);
    ff_print_text(out, job->bvh ? ".bvh\", \"mode\": \"" : ".amc\", \"mode\": \"");
    ff_print_text(out, info->mode);
    ff_print_text(out, "\", \"tags\": [\"");
    for (const char *c = info->tags; *c; ++c) {
        char one[2] = {*c, 0};
        ff_print_text(out, *c == ' ' ? "\", \"" : one);
    }
    ff_print_text(out, "\"], \"note\": \"");
    ff_print_text(out, info->description);
    ff_print_text(out, "\" }");
}

static ff_status write_clip(ff_generate_job *job, int index, ff_error *error)
{
    ff_generator_info info = ff_generator_describe(index);
    ff_generated made;
    char path[1024], asf[1024];
    ff_status status = ff_generator_make(index, &job->options, &made, error);
    if (status != FF_OK) return status;
    if (job->bvh) {
        status = clip_path(job->folder, info.name, "bvh", path, error);
        if (status == FF_OK) status = ff_bvh_write(path, &made.clip, error);
    }
    if (job->amc && status == FF_OK) {
        status = clip_path(job->folder, info.name, "amc", path, error);
        if (status == FF_OK) status = clip_path(job->folder, info.name, "asf", asf, error);
        if (status == FF_OK) status = ff_asf_amc_write(asf, path, &made.clip, error);
    }
    add_truth(&job->truth, &info, &made);
    add_listing(job, &info);
    ff_generated_free(&made);
    return status;
}

static ff_status write_text(ff_print *print, const char *folder, const char *name, const char *ending,
                            ff_error *error)
{
    char path[1024];
    ff_status status = clip_path(folder, name, ending, path, error);
    if (status == FF_OK) return ff_print_to_file(print, path, error);
    ff_array_free(&print->bytes);
    return status;
}

static ff_status write_all(ff_generate_job *job, const char *const *names, int count, bool quiet,
                           ff_error *error)
{
    int total = count > 0 ? count : ff_generator_count();
    ff_status status = ff_folder_create(job->folder, error);
    if (status != FF_OK) return status;
    ff_print_text(&job->truth,
                  "clip,tag,foot,start_frame,end_frame,flat_start,flat_end,start_truncated,end_truncated,"
                  "partial,confidence,ball_x_m,ball_y_m,ball_z_m,yaw_deg,n_frames\n");
    ff_print_text(&job->catalogue,
                  "{\n    \"note\": \"Clips made by footfall-pack generate.\",\n    \"unit\": \"m\",\n"
                  "    \"fps\": 120,\n    \"up\": \"y\",\n    \"licence\": \"MIT\",\n"
                  "    \"citation\": \"The data used in this project was obtained from mocap.cs.cmu.edu. The "
                  "database was created with funding from NSF EIA-0196217.\",\n    \"clips\": [\n");
    ff_progress *progress = ff_progress_start("generate", (uint64_t)total, quiet);
    for (int i = 0; i < total && status == FF_OK; ++i) {
        int index = count > 0 ? ff_generator_find(names[i]) : i;
        status = write_clip(job, index, error);
        ff_progress_step(progress, ff_generator_describe(index).name);
    }
    ff_progress_end(progress);
    ff_print_text(&job->catalogue, "\n    ]\n}\n");
    if (status == FF_OK) status = write_text(&job->truth, job->folder, "plants", "csv", error);
    if (status == FF_OK) status = write_text(&job->catalogue, job->folder, "catalogue", "json", error);
    ff_array_free(&job->truth.bytes);
    ff_array_free(&job->catalogue.bytes);
    return status;
}

static void list_clips(void)
{
    for (int i = 0; i < ff_generator_count(); ++i) {
        ff_generator_info info = ff_generator_describe(i);
        printf("%-20s %-7s %s\n", info.name, info.mode, info.description);
    }
}

static int run(const ff_command *command, ff_generate_job *job, const char *format,
               const ff_operands *operands, bool quiet)
{
    if (!job->folder) return ff_command_misuse(command, "say where to write the clips: -o FOLDER");
    job->bvh = strcmp(format, "bvh") == 0 || strcmp(format, "both") == 0;
    job->amc = strcmp(format, "amc") == 0 || strcmp(format, "both") == 0;
    if (!job->bvh && !job->amc)
        return ff_command_misuse(command, "unknown format \"%s\", expected bvh, amc or both", format);
    for (int i = 0; i < operands->count; ++i)
        if (ff_generator_find(operands->items[i]) < 0)
            return ff_command_misuse(command, "no built-in clip is called \"%s\"; --list names them",
                                     operands->items[i]);
    ff_error error;
    if (write_all(job, operands->items, operands->count, quiet, &error) != FF_OK)
        return ff_command_fail(PROGRAM, &error);
    return FF_EXIT_OK;
}

int ff_generate_command(int argc, char **argv)
{
    ff_generate_job job = {0};
    const char *format = "bvh";
    bool quiet = false, list = false;
    int64_t person = 0, seed = 0;
    ff_generator_options *o = &job.options;
    ff_option options[] = {
        {.name = "--out",
         .alias = "-o",
         .value_name = "FOLDER",
         .help = "where to write",
         .text = &job.folder},
        {.name = "--format",
         .value_name = "bvh|amc|both",
         .help = "format of the clips (default bvh)",
         .text = &format},
        {.name = "--person",
         .value_name = "N",
         .help = "0 = the mean walker, 1 to 7 = one measured person",
         .integer = &person,
         .low = 0,
         .high = ff_generator_people() - 1},
        {.name = "--seed",
         .value_name = "N",
         .help = "seed of sway and noise",
         .integer = &seed,
         .low = 0,
         .high = 9e15},
        {.name = "--noise",
         .value_name = "MM",
         .help = "noise of the joints, standard deviation in mm",
         .number = &o->noise_mm,
         .low = 0,
         .high = 100},
        {.name = "--skate",
         .value_name = "CM",
         .help = "drift of a planted foot in cm",
         .number = &o->skate_cm,
         .low = 0,
         .high = 50},
        {.name = "--floor",
         .value_name = "CM",
         .help = "height of the floor in cm",
         .number = &o->floor_cm,
         .low = -1000,
         .high = 1000},
        {.name = "--tilt",
         .value_name = "DEG",
         .help = "slope of the floor along z in degrees",
         .number = &o->tilt_deg,
         .low = -20,
         .high = 20},
        {.name = "--missing",
         .value_name = "SHARE",
         .help = "share of frames that repeat the one before",
         .number = &o->missing,
         .low = 0,
         .high = 0.85},
        {.name = "--list", .help = "name the clips and write nothing", .flag = &list},
        {.name = "--quiet", .alias = "-q", .help = "no progress on stderr", .flag = &quiet},
        {0}};
    ff_command command = {
        .program = PROGRAM,
        .name = "generate",
        .arguments = "[CLIP...]",
        .summary = "write the built-in clips, with the truth about their foot plants",
        .details =
            "Without names all clips are written, with plants.csv (columns of foot-contact labels) and\n"
            "catalogue.json, which 'footfall-pack build' reads.",
        .options = options,
        .min_operands = 0,
        .max_operands = -1,
    };
    ff_operands operands;
    int result = ff_command_parse(&command, argc, argv, &operands);
    o->person = (int)person;
    o->seed = (uint64_t)seed;
    if (result < 0 && list) {
        list_clips();
        result = FF_EXIT_OK;
    }
    if (result < 0) result = run(&command, &job, format, &operands, quiet);
    return result;
}
