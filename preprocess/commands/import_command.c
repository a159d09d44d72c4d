#define _POSIX_C_SOURCE 200809L
#include "preprocess/commands/import_command.h"

#include "mocap/normal.h"
#include "mocap/write.h"
#include "preprocess/commands/each_clip.h"
#include "preprocess/motion/retarget.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"

#include <ctype.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const PROGRAM = "footfall-pack";

/* What a person wants to know of a clip before trusting it. */
typedef struct summary {
    char file[1024]; /* that was written; "" = none */
    int frames, rest_frames, roles;
    double rate, unit_m, leg, speed; /* Hz, m per file unit, m, m/s */
} summary;

typedef struct import {
    const char *folder; /* NULL: only look */
    bool json;
    json_t *list;
} import;

/* Mean speed on the ground, by the places half a second apart: swaying is not walking. */
static double ground_speed(const ff_clip *clip)
{
    int hips = ff_clip_find(clip, FF_ROLE_HIPS), stride = (int)(0.5 / clip->frame_time + 0.5);
    ff_vec3 at[FF_CLIP_MAX_JOINTS];
    ff_vec2 last = {0.0, 0.0};
    double length = 0.0;
    int strides = 0;
    if (stride > clip->frame_count - 1 - clip->rest_frames)
        stride = clip->frame_count - 1 - clip->rest_frames;
    if (stride < 1) stride = 1;
    for (int k = clip->rest_frames; k < clip->frame_count; k += stride) {
        ff_clip_pose(clip, k, at, NULL);
        ff_vec2 here = ff_plane(at[hips < 0 ? 0 : hips]);
        if (k > clip->rest_frames) {
            length += ff_length2(ff_sub2(here, last));
            ++strides;
        }
        last = here;
    }
    return strides > 0 ? length / (strides * stride * clip->frame_time) : 0.0;
}

static summary summarise(const ff_clip *clip)
{
    int joint[FF_ROLE_COUNT];
    ff_vec3 at[FF_CLIP_MAX_JOINTS];
    summary s = {.frames = clip->frame_count,
                 .rest_frames = clip->rest_frames,
                 .rate = 1.0 / clip->frame_time,
                 .unit_m = clip->unit_m};
    for (int r = 0; r < FF_ROLE_COUNT; ++r) {
        joint[r] = ff_clip_find(clip, (ff_role)r);
        s.roles += joint[r] >= 0;
    }
    ff_clip_pose(clip, clip->frame_count - 1, at, NULL);
    s.leg = ff_clip_leg_length(joint, at);
    s.speed = ground_speed(clip);
    return s;
}

/* FOLDER/NAME.bvh, or NAME-2.bvh ... when a clip of that name came before. */
static ff_status name_file(const import *run, const ff_clip *clip, char *path, size_t size, ff_error *error)
{
    char name[256];
    snprintf(name, sizeof name, "%s", clip->name);
    for (char *c = name; *c; ++c)
        if (!isalnum((unsigned char)*c) && !strchr("-_.", *c)) *c = '-';
    for (int number = 1; number < 10000; ++number) {
        char again[16] = "";
        if (number > 1) snprintf(again, sizeof again, "-%d", number);
        int length = snprintf(path, size, "%s/%s%s.bvh", run->folder, name, again);
        if (length < 0 || (size_t)length >= size)
            return ff_fail(error, FF_ERR_RANGE, "the name of the file to write is too long");
        bool taken = false;
        for (size_t i = 0; i < json_array_size(run->list) && !taken; ++i) {
            const char *file = json_string_value(json_object_get(json_array_get(run->list, i), "file"));
            taken = file && strcmp(file, path) == 0;
        }
        if (!taken) return FF_OK;
    }
    return ff_fail(error, FF_ERR_RANGE, "thousands of clips are called %s", name);
}

static void print_row(const ff_clip *clip, const summary *s)
{
    printf("%-24.24s %7d %6.4g %9.4g %6.3f %6.2f %3d/%-3d %s", clip->name, s->frames, s->rate, s->unit_m,
           s->leg, s->speed, s->roles, FF_ROLE_COUNT, clip->warning_count > 0 ? "" : "-");
    if (clip->warning_count > 0) printf("%d: %s", clip->warning_count, clip->warning);
    printf("\n");
}

static json_t *row_json(const ff_catalogue_entry *entry, const ff_clip *clip, const summary *s)
{
    json_t *missing = json_array();
    for (int r = 0; r < FF_ROLE_COUNT; ++r)
        if (ff_clip_find(clip, (ff_role)r) < 0)
            json_array_append_new(missing, json_string(ff_role_name((ff_role)r)));
    json_t *row = json_pack("{s:s, s:s, s:i, s:i, s:f, s:f, s:f, s:f, s:i, s:o, s:i}", "name", clip->name,
                            "source", entry->path, "frames", s->frames, "rest_frames", s->rest_frames, "rate",
                            s->rate, "unit_m", s->unit_m, "leg", s->leg, "speed", s->speed, "roles", s->roles,
                            "missing", missing, "warnings", clip->warning_count);
    if (row && clip->warning_count > 0) json_object_set_new(row, "warning", json_string(clip->warning));
    if (row && s->file[0]) json_object_set_new(row, "file", json_string(s->file));
    return row;
}

static ff_status import_one(const ff_catalogue_entry *entry, void *context, ff_error *error)
{
    import *run = context;
    ff_clip clip;
    ff_status status = ff_clip_load(entry->path, &entry->options, &clip, error);
    if (status != FF_OK) return status;
    status = ff_clip_keep(&clip, entry->trim_first, entry->trim_last, error);
    summary s = {.frames = 0};
    if (status == FF_OK) s = summarise(&clip);
    if (status == FF_OK && run->folder) {
        status = name_file(run, &clip, s.file, sizeof s.file, error);
        if (status == FF_OK) status = ff_clip_normalise(&clip, error);
        if (status == FF_OK) status = ff_bvh_write(s.file, &clip, error);
    }
    if (status == FF_OK) {
        json_array_append_new(run->list, row_json(entry, &clip, &s));
        if (!run->json) print_row(&clip, &s);
    }
    ff_clip_free(&clip);
    return status;
}

static int import_all(import *run, const ff_clip_run *clips, const ff_operands *inputs)
{
    ff_error error;
    if (run->folder && ff_folder_create(run->folder, &error) != FF_OK)
        return ff_command_fail(PROGRAM, &error);
    if (!run->json)
        printf("%-24s %7s %6s %9s %6s %6s %7s %s\n", "name", "frames", "Hz", "unit m", "leg m", "m/s",
               "roles", "warnings");
    return ff_each_entry(clips, inputs, import_one, run);
}

int ff_import_command(int argc, char **argv)
{
    ff_clip_run clips = {.program = PROGRAM, .what = "importing"};
import run = {.folder = NULL };
    ff_option options[] = {
        {.name = "--out",
         .alias = "-o",
         .value_name = "FOLDER",
         .help = "where to write NAME.bvh of each clip; without it they are only looked at",
         .text = &run.folder},
        {.name = "--json", .help = "the table as JSON, with the roles that are missing", .flag = &run.json},
        FF_QUIET_OPTION(clips),
        {0}};
    ff_command command = {
        .program = PROGRAM,
        .name = "import",
        .arguments = "CLIP|FOLDER|CATALOGUE...",
        .summary = "bring clips of any kind into one form, and say what they are",
        .details =
            "Writes BVH in metres, Y up, trimmed, without leading rest frames, the rest pose facing +Z, the "
            "motion\nstarting over the origin and facing +Z; poses are as they were. The table: frames, "
            "frames per\nsecond, metres per unit of the file, length of a leg, mean speed on the ground, "
            "joints whose role\nis known, oddities met. Exit status 1 when a clip could not be read; the "
            "others are written.",
        .options = options,
        .min_operands = 1,
        .max_operands = -1,
    };
    ff_operands operands;
    int result = ff_command_parse(&command, argc, argv, &operands);
    if (result >= 0) return result;
    run.list = json_array();
    result = import_all(&run, &clips, &operands);
    if (run.json) {
        json_dumpf(run.list, stdout, JSON_INDENT(1));
        printf("\n");
    }
    json_decref(run.list);
    return result;
}
