#include "preprocess/commands/plants_command.h"

#include "preprocess/commands/each_clip.h"
#include "preprocess/plants/plant_edit.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/tool/command_line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const PROGRAM = "footfall-pack";

typedef enum plants_layout { TABLE, CSV, OVERRIDE } plants_layout;

static void print_csv(const ff_clip *clip, const ff_plants *plants)
{
    for (int i = 0; i < plants->count; ++i) {
        const ff_plant *p = &plants->items[i];
        printf("%s,%c,%d,%d,%d,%d,%.2f\n", clip->name, p->foot == FF_LEFT ? 'L' : 'R', p->start, p->end,
               p->flat_start, p->flat_end, p->confidence);
    }
}

static void print_breaks(const ff_breaks *breaks)
{
    for (int i = 0; i < breaks->count; ++i) {
        char text[160];
        ff_break_say(&breaks->items[i], text, sizeof text);
        printf("  broken at %s\n", text);
    }
}

static void print_table(const ff_clip *clip, const ff_plants *plants)
{
    printf("%s: %d frames at %.4g Hz, %d plants; floor at %.1f cm, slope %.1f cm/m\n", clip->name,
           clip->frame_count, 1.0 / clip->frame_time, plants->count, 100.0 * plants->floor.base,
           100.0 * ff_length2(plants->floor.slope));
    printf("  foot   start     end  seconds    flat from - to  slide cm  confidence\n");
    for (int i = 0; i < plants->count; ++i) {
        const ff_plant *p = &plants->items[i];
        char flat[32] = "        -     -";
        if (p->flat_start >= 0) snprintf(flat, sizeof flat, "%9d - %5d", p->flat_start, p->flat_end);
        printf("  %-5s%c%6d%c%7d  %7.2f  %16s  %8.1f  %10.2f\n", p->foot == FF_LEFT ? "left" : "right",
               p->cut_start ? '<' : ' ', p->start, p->cut_end ? '>' : ' ', p->end,
               (p->end - p->start + 1) * clip->frame_time, flat, 100.0 * p->slide, p->confidence);
    }
}

/* A file for a person to go on from, beside the clip. */
static ff_status write_override(const ff_seen_clip *seen, ff_error *error)
{
    char path[1024], *text;
    if (!ff_plant_edits_path(seen->entry->path, path, sizeof path))
        return ff_fail(error, FF_ERR_RANGE, "the name of the clip's file is too long");
    if (access(path, F_OK) == 0)
        return ff_fail(error, FF_ERR_IO, "%s is there already, and what is in it holds; move it away first",
                       path);
    ff_status status = ff_plant_edits_write(&seen->plants, &text, error);
    if (status == FF_OK) status = ff_file_write_atomic(path, text, strlen(text), error);
    if (status == FF_OK) printf("%s\n", path);
    free(text);
    return status;
}

static ff_status print_clip(const ff_seen_clip *seen, void *context, ff_error *error)
{
    const plants_layout *layout = context;
    if (*layout == OVERRIDE) return write_override(seen, error);
    if (*layout == CSV) {
        print_csv(&seen->clip, &seen->plants);
    } else {
        print_table(&seen->clip, &seen->plants);
        print_breaks(&seen->breaks);
    }
    return FF_OK;
}

int ff_plants_command(int argc, char **argv)
{
    bool csv = false, override = false;
    ff_clip_run run = {.program = PROGRAM, .what = "plants"};
    ff_option options[] = {
        {.name = "--csv", .help = "one line per plant, with a header", .flag = &csv},
        {.name = "--write-override",
         .help = "write NAME.plants.json beside each clip, to be edited: what it says holds",
         .flag = &override},
        FF_CONFIG_OPTION(run),
        FF_QUIET_OPTION(run),
        {0}};
    ff_command command = {
        .program = PROGRAM,
        .name = "plants",
        .arguments = "CLIP|FOLDER|CATALOGUE...",
        .summary = "when each foot of a clip stands on the ground",
        .details =
            "Frames count from 0 at the file's first pose, both ends inclusive; flat is the stretch in which "
            "heel\n"
            "and ball are down and still. In the table '<' and '>' mark plants that the clip's ends cut.\n"
            "CSV columns: clip,foot,start_frame,end_frame,flat_start,flat_end,confidence.",
        .options = options,
        .min_operands = 1,
        .max_operands = -1,
    };
    ff_operands operands;
    int result = ff_command_parse(&command, argc, argv, &operands);
    if (result >= 0) return result;
    plants_layout layout = override ? OVERRIDE : (csv ? CSV : TABLE);
    if (layout == CSV) printf("clip,foot,start_frame,end_frame,flat_start,flat_end,confidence\n");
    return ff_each_clip(&run, &operands, print_clip, &layout);
}
