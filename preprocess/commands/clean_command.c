#include "preprocess/commands/clean_command.h"

#include "preprocess/base/filter.h"
#include "preprocess/build/build_clip.h"
#include "preprocess/commands/each_clip.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/base/tasks.h"
#include "runtime/tool/command_line.h"
#include "runtime/tool/progress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const PROGRAM = "footfall-pack";

typedef enum clean_layout { TABLE, CSV } clean_layout;

typedef struct clean_run {
    const ff_catalogue *catalogue;
    ff_build_clip *clips;
    ff_settings settings;
    ff_cache cache; /* of nothing */
    ff_rig rig;
    ff_progress *progress;
} clean_run;

static void load_one(void *context, uint32_t index)
{
    clean_run *run = context;
    ff_build_clip_begin(&run->clips[index], &run->catalogue->entries[index], 0);
    ff_build_clip_find(&run->clips[index],
                       &(ff_build_shared){.settings = &run->settings, .cache = &run->cache});
    ff_progress_step(run->progress, run->catalogue->entries[index].path);
}

static void clean_one(void *context, uint32_t index)
{
    clean_run *run = context;
    ff_build_clip *c = &run->clips[index];
    ff_clip whole = {0};
    if (c->status == FF_OK) c->status = ff_build_clip_read(c, &run->settings.find, &whole, &c->error);
    if (c->status == FF_OK)
        c->status = ff_motion_from_clip(&run->rig, &whole, &c->plants, &c->motion, &c->error);
    ff_clip_free(&whole);
    if (c->status == FF_OK)
        c->status = ff_motion_clean(&run->rig, &run->settings.cut.clean, &c->motion, &c->plants, &c->cleaned,
                                    &c->error);
    ff_progress_step(run->progress, run->catalogue->entries[index].path);
}

/* ------------------------------------------------------------------------------------------------------- printing */

static void print_csv(const ff_build_clip *c)
{
    const ff_clean_report *r = &c->cleaned;
    printf("%s,%.3f,%d", c->clip.name, ff_build_clip_seconds(c), r->was_clean ? 1 : 0);
    const ff_change mm[] = {r->pin_median, r->pin_worst, r->skate, r->floor_dip};
    for (size_t i = 0; i < sizeof mm / sizeof mm[0]; ++i)
        printf(",%.4f,%.4f", 1e3 * mm[i].before, 1e3 * mm[i].after);
    printf(",%.3f,%.3f", r->knee_least.before / FF_DEG, r->knee_least.after / FF_DEG);
    printf(",%.4f,%.4f,%.4f,%s,%d", r->turn_mean / FF_DEG, r->turn_most_95 / FF_DEG, r->turn_most / FF_DEG,
           ff_role_name((ff_role)r->turn_role), r->turn_frame);
    printf(",%.3f,%.3f,%.5f,%.4f,%d,%d,%d\n", 1e3 * r->shift_mean, 1e3 * r->shift_most, r->acceleration,
           1e3 * r->residual, r->solves, r->unconverged, r->iterations);
}

static void print_table(const ff_build_clip *c)
{
    const ff_clean_report *r = &c->cleaned;
    printf(
        "%-32.32s %6.1f | %5.1f %5.1f  %5.2f %5.2f | %5.1f %5.1f | %5.2f %5.2f %5.1f | %5.2f | %5.1f %5.1f | "
        "%5.1f%s\n",
        c->clip.name, ff_build_clip_seconds(c), 1e3 * r->pin_median.before, 1e3 * r->pin_worst.before,
        1e3 * r->pin_median.after, 1e3 * r->pin_worst.after, 1e3 * r->skate.before, 1e3 * r->skate.after,
        r->turn_mean / FF_DEG, r->turn_most_95 / FF_DEG, r->turn_most / FF_DEG, r->acceleration,
        1e3 * r->floor_dip.before, 1e3 * r->floor_dip.after, r->knee_least.after / FF_DEG,
        r->was_clean ? "  (was clean)" : "");
}

static void print_header(clean_layout layout)
{
    if (layout == CSV) {
        printf("clip,seconds,was_clean,pin_median_mm_before,pin_median_mm_after,pin_worst_mm_before,"
               "pin_worst_mm_after,skate_mm_per_s_before,skate_mm_per_s_after,floor_dip_mm_before,"
               "floor_dip_mm_after,knee_least_deg_before,knee_least_deg_after,turned_mean_deg,turned_95_deg,"
               "turned_most_deg,turned_most_joint,turned_most_frame,hips_moved_mean_mm,hips_moved_most_mm,"
               "acceleration_ratio,residual_mm,solves,unconverged,iterations\n");
        return;
    }
    printf("%-32s %6s | %-12s %-11s | %-11s | %-17s | %5s | %-11s | knee\n", "", "", " pin before",
           " pin after", "skate mm/s", "    turned deg", "accel", "  floor mm");
    printf("%-32s %6s | %5s %5s  %5s %5s | %5s %5s | %5s %5s %5s | %5s | %5s %5s | least\n", "clip", "s",
           "med.", "worst", "med.", "worst", "bef.", "after", "mean", "95%", "most", "ratio", "bef.",
           "after");
}

/* Median over the clips and the worst of them. */
static void print_quantity(const char *what, const char *unit, double *values, int count)
{
    double worst = ff_filter_quantile(values, count, 1.0);
    printf("  %-52s %8.3f %8.3f  %s\n", what, ff_filter_quantile(values, count, 0.5), worst, unit);
}

typedef double quantity(const ff_clean_report *r);
static double pin_before(const ff_clean_report *r)
{
    return 1e3 * r->pin_median.before;
}
static double pin_worst_before(const ff_clean_report *r)
{
    return 1e3 * r->pin_worst.before;
}
static double pin_after(const ff_clean_report *r)
{
    return 1e3 * r->pin_median.after;
}
static double pin_worst_after(const ff_clean_report *r)
{
    return 1e3 * r->pin_worst.after;
}
static double turn_mean(const ff_clean_report *r)
{
    return r->turn_mean / FF_DEG;
}
static double turn_95(const ff_clean_report *r)
{
    return r->turn_most_95 / FF_DEG;
}
static double acceleration(const ff_clean_report *r)
{
    return r->acceleration;
}
static double dip(const ff_clean_report *r)
{
    return 1e3 * r->floor_dip.after;
}
static double knee(const ff_clean_report *r)
{
    return -r->knee_least.after / FF_DEG;
}

static ff_status print_summary(const ff_build_clip *clips, int count, ff_error *error)
{
    static const struct {
        const char *what, *unit;
        quantity *of;
    } rows[] = {{"ball of a flat foot from its pin, before: median", "mm", pin_before},
                {"                                      worst", "mm", pin_worst_before},
                {"ball of a flat foot from its pin, after: median", "mm", pin_after},
                {"                                     worst", "mm", pin_worst_after},
                {"joints turned: mean", "degrees", turn_mean},
                {"joints turned: 95 % below", "degrees", turn_95},
                {"acceleration of knees and ankles, after / before", "", acceleration},
                {"lowest sole under the floor", "mm", dip},
                {"knee bent the wrong way (negative = never)", "degrees", knee}};
    double *values = ff_calloc((size_t)count, sizeof *values);
    if (!values) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %d clips", count);
    printf("\n  %-52s %8s %8s\n", "over the clips", "median", "worst");
    for (size_t row = 0; row < sizeof rows / sizeof rows[0]; ++row) {
        int n = 0;
        for (int i = 0; i < count; ++i)
            if (clips[i].status == FF_OK) values[n++] = rows[row].of(&clips[i].cleaned);
        if (n > 0) print_quantity(rows[row].what, rows[row].unit, values, n);
    }
    free(values);
    return FF_OK;
}

static int print_all(const clean_run *run, clean_layout layout)
{
    int result = FF_EXIT_OK, count = run->catalogue->count;
    ff_error error;
    print_header(layout);
    for (int i = 0; i < count; ++i) {
        ff_build_clip *c = &run->clips[i];
        if (c->status != FF_OK) {
            ff_error_in_file(&c->error, run->catalogue->entries[i].path);
            result = ff_command_fail(PROGRAM, &c->error);
        } else if (layout == CSV) {
            print_csv(c);
        } else {
            print_table(c);
        }
    }
    if (layout == TABLE && print_summary(run->clips, count, &error) != FF_OK)
        return ff_command_fail(PROGRAM, &error);
    return result;
}

static ff_status clean_all(clean_run *run, uint32_t threads, bool quiet, ff_error *error)
{
    uint32_t count = (uint32_t)run->catalogue->count;
    ff_tasks *tasks;
    run->clips = ff_calloc(count, sizeof *run->clips);
    if (!run->clips) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u clips", (unsigned)count);
    ff_status status = ff_tasks_create(threads, &tasks, error);
    if (status != FF_OK) return status;
    run->progress = ff_progress_start("reading", count, quiet);
    ff_tasks_for(tasks, count, 1, load_one, run);
    ff_progress_end(run->progress);
    status = ff_build_median_rig(run->clips, (int)count, &run->rig, error);
    if (status == FF_OK) {
        run->progress = ff_progress_start("cleaning", count, quiet);
        ff_tasks_for(tasks, count, 1, clean_one, run);
        ff_progress_end(run->progress);
    }
    ff_tasks_destroy(tasks);
    return status;
}

static int clean_inputs(const ff_clip_run *command, const ff_operands *inputs, clean_layout layout,
                        uint32_t threads)
{
    ff_error error;
    ff_catalogue catalogue;
    if (ff_catalogue_read(inputs->items, inputs->count, &catalogue, &error) != FF_OK)
        return ff_command_fail(PROGRAM, &error);
    clean_run run = {.catalogue = &catalogue, .settings = ff_settings_default()};
    ff_status status = FF_OK;
    if (command->config) status = ff_settings_load(command->config, &run.settings, &error);
    if (status == FF_OK) status = clean_all(&run, threads, command->quiet, &error);
    int result = status == FF_OK ? print_all(&run, layout) : ff_command_fail(PROGRAM, &error);
    for (int i = 0; run.clips && i < catalogue.count; ++i)
        ff_build_clip_free(&run.clips[i]);
    free(run.clips);
    ff_catalogue_free(&catalogue);
    return result;
}

int ff_clean_command(int argc, char **argv)
{
    bool csv = false;
    ff_clip_run run = {.program = PROGRAM, .what = "cleaning"};
    int64_t threads = ff_processor_count();
    ff_option options[] = {{.name = "--csv", .help = "one line per clip, with a header", .flag = &csv},
                           FF_THREADS_OPTION(threads),
                           FF_CONFIG_OPTION(run),
                           FF_QUIET_OPTION(run),
                           {0}};
    ff_command command = {
        .program = PROGRAM,
        .name = "clean",
        .arguments = "CLIP|FOLDER|CATALOGUE...",
        .summary = "what making feet stand still does to clips",
        .details =
            "Brings the clips onto one skeleton as a build does, makes planted feet stand still, and "
            "measures, "
            "before\n"
            "and after: how far the ball of a flat foot strays from its pin (mm), how fast it slides; by how "
            "much\n"
            "hips, hip joints, knees and ankles were turned; accelerations of knees and ankles against the\n"
            "captured ones; how deep a sole gets under the floor; the least bent knee.",
        .options = options,
        .min_operands = 1,
        .max_operands = -1,
    };
    ff_operands operands;
    int result = ff_command_parse(&command, argc, argv, &operands);
    if (result < 0) result = clean_inputs(&run, &operands, csv ? CSV : TABLE, (uint32_t)threads);
    return result;
}
