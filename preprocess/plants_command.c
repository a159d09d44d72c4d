#include "preprocess/plants_command.h"

#include "mocap/catalogue.h"
#include "preprocess/plants.h"
#include "runtime/core/base/fail.h"
#include "runtime/tool/command_line.h"
#include "runtime/tool/progress.h"

#include <stdio.h>

static const char *const PROGRAM = "footfall-pack";

typedef enum plants_layout { TABLE, CSV } plants_layout;

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

static ff_status print_clip(const ff_catalogue_entry *entry, plants_layout layout, ff_error *error)
{
    ff_clip clip;
    ff_status status = ff_clip_load(entry->path, &entry->options, &clip, error);
    if (status != FF_OK) return status;
    ff_plants plants;
    ff_breaks breaks;
    status = ff_breaks_repair(&clip, &breaks, error);
    if (status == FF_OK) status = ff_plants_find(&clip, &plants, error);
    if (status == FF_OK) {
        if (layout == CSV)
            print_csv(&clip, &plants);
        else
            print_table(&clip, &plants);
        if (layout == TABLE) print_breaks(&breaks);
        ff_plants_free(&plants);
    } else
        ff_error_in_file(error, entry->path);
    ff_breaks_free(&breaks);
    ff_clip_free(&clip);
    return status;
}

/* Every clip is tried; the ones that fail are named on stderr and make the exit status 1. */
static int print_all(const char *const *inputs, int count, plants_layout layout, bool quiet)
{
    ff_error error;
    ff_catalogue catalogue;
    if (ff_catalogue_read(inputs, count, &catalogue, &error) != FF_OK)
        return ff_command_fail(PROGRAM, &error);
    int result = FF_EXIT_OK;
    if (layout == CSV) printf("clip,foot,start_frame,end_frame,flat_start,flat_end,confidence\n");
    ff_progress *progress = ff_progress_start("plants", (uint64_t)catalogue.count, quiet);
    for (int i = 0; i < catalogue.count; ++i) {
        if (print_clip(&catalogue.entries[i], layout, &error) != FF_OK)
            result = ff_command_fail(PROGRAM, &error);
        ff_progress_step(progress, catalogue.entries[i].path);
    }
    ff_progress_end(progress);
    ff_catalogue_free(&catalogue);
    return result;
}

int ff_plants_command(int argc, char **argv)
{
    bool csv = false, quiet = false;
    ff_option options[] = {
        {.name = "--csv", .help = "one line per plant, with a header", .flag = &csv},
        {.name = "--quiet", .alias = "-q", .help = "no progress on stderr", .flag = &quiet},
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
    if (result < 0) result = print_all(operands.items, operands.count, csv ? CSV : TABLE, quiet);
    return result;
}
