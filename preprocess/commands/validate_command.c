#include "preprocess/commands/validate_command.h"

#include "preprocess/commands/each_clip.h"
#include "preprocess/report/validate.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/base/tasks.h"
#include "runtime/tool/command_line.h"

#include <stdio.h>
#include <stdlib.h>

static const char *const PROGRAM = "footfall-pack";

static bool print_own(const ff_valid_own *v)
{
    printf("flat feet   %u plants, the ball moves by %.2f mm in the median, %.2f mm at most", v->plants,
           1e3 * v->slide_median, 1e3 * v->slide_most);
    if (v->sliding > 0)
        printf("; %u by more than %.0f mm%s: %s", v->sliding, 1e3 * FF_VALID_SLIDE,
               v->cleaned ? "" : " (they were not cleaned up)", v->first[0]);
    printf("\nactions     %u, all begin and end on a foot that is down", v->actions);
    if (v->unplanted > 0) printf(" but for %u: %s", v->unplanted, v->first[1]);
    printf("\nexamples    %u, all close", v->loops);
    if (v->open_loops > 0) printf(" but for %u", v->open_loops);
    printf("\n");
    return ff_valid_own_good(v);
}

/* One line per clip that is not as it should be, then the count of each. Missing clips are no fault when only the
 * built-in ones could be looked for. */
static bool print_clips(const ff_pack *pack, const ff_valid_clip *clips, bool given)
{
    static const char *const say[] = {
        [FF_VALID_SAME] = "as in the pack",          [FF_VALID_DIFFERS] = "differ",
        [FF_VALID_CHANGED] = "have other bytes now", [FF_VALID_MISSING] = "not among the clips given",
        [FF_VALID_UNUSABLE] = "cannot be used",      [FF_VALID_MADE_UP] = "made up"};
    uint32_t count[FF_VALID_MADE_UP + 1] = {0};
    double worst_mean = 0.0, worst_99 = 0.0;
    for (uint32_t i = 0; i < pack->clip_count; ++i) {
        const ff_valid_clip *c = &clips[i];
        ++count[c->state];
        worst_mean = ff_max(worst_mean, c->pose_mean);
        worst_99 = ff_max(worst_99, c->pose_99);
        if (c->state == FF_VALID_SAME || c->state == FF_VALID_MADE_UP) continue;
        if (c->state == FF_VALID_MISSING && !given) continue;
        printf("  %s (%s): %s%s%s\n", ff_pack_string(pack, pack->clips[i].name),
               ff_pack_string(pack, pack->clips[i].source),
               c->state == FF_VALID_CHANGED ? "the file has other bytes than the pack was built from" : "",
               c->state == FF_VALID_MISSING ? "not among the clips given" : "", c->why);
    }
    printf("clips       %u", pack->clip_count);
    for (int state = 0; state <= FF_VALID_MADE_UP; ++state)
        if (count[state] > 0) printf("%s %u %s", state ? "," : ":", count[state], say[state]);
    printf("\n");
    if (count[FF_VALID_SAME] + count[FF_VALID_DIFFERS] > 0)
        printf(
            "poses       at worst %.3f mm off on average (limit %.1f), 1 %% more than %.3f mm (limit %.0f)\n",
            1e3 * worst_mean, 1e3 * FF_VALID_POSE_MEAN, 1e3 * worst_99, 1e3 * FF_VALID_POSE_99);
    return count[FF_VALID_DIFFERS] + count[FF_VALID_CHANGED] + count[FF_VALID_UNUSABLE] == 0 &&
           (!given || count[FF_VALID_MISSING] == 0);
}

static ff_status validate(const ff_pack *pack, const ff_operands *inputs, uint32_t threads, bool quiet,
                          bool *good, ff_error *error)
{
    ff_valid_own own;
    ff_catalogue catalogue;
    bool given = inputs->count > 1;
    ff_status status = ff_validate_own(pack, &own, error);
    if (status != FF_OK) return status;
    *good = print_own(&own);
    if (given) status = ff_catalogue_read(inputs->items + 1, inputs->count - 1, &catalogue, error);
    if (status != FF_OK) return status;
    ff_valid_clip *clips = ff_calloc((size_t)pack->clip_count + 1, sizeof *clips);
    status = clips ? ff_validate_clips(pack, given ? &catalogue : NULL, threads, quiet, clips, error)
                   : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u clips", pack->clip_count);
    if (status == FF_OK) *good = print_clips(pack, clips, given) && *good;
    free(clips);
    if (given) ff_catalogue_free(&catalogue);
    return status;
}

int ff_validate_command(int argc, char **argv)
{
    bool good = false;
    ff_clip_run run = {.program = PROGRAM, .what = "checking"};
    int64_t threads = ff_processor_count();
    ff_option options[] = {FF_THREADS_OPTION(threads), FF_QUIET_OPTION(run), {0}};
    ff_command command = {
        .program = PROGRAM,
        .name = "validate",
        .arguments = "PACK [CATALOGUE|FOLDER|FILES...]",
        .summary = "check a pack against itself and against its clips",
        .details = "Against itself: the ball of a flat foot stays within 5 mm of its mean place, every "
                   "action begins and\n"
                   "ends on a foot that is down, every example closes within 1 mm. Against the clips it was "
                   "built from,\n"
                   "when they are given (built-in ones need not be): the files' bytes are the same, and "
                   "plants, actions\n"
                   "(1.5 frames) and poses (0.5 mm on average, 2 mm for 99 of 100) are found again.\n"
                   "Exit status: 0 all is as it should be, 1 not, 2 the command line is wrong.",
        .options = options,
        .min_operands = 1,
        .max_operands = -1,
    };
    ff_operands operands;
    ff_error error;
    ff_pack *pack;
    int result = ff_command_parse(&command, argc, argv, &operands);
    if (result >= 0) return result;
    if (ff_pack_open(operands.items[0], &pack, &error) != FF_OK) return ff_command_fail(PROGRAM, &error);
    ff_status status = validate(pack, &operands, (uint32_t)threads, run.quiet, &good, &error);
    ff_pack_close(pack);
    if (status != FF_OK) return ff_command_fail(PROGRAM, &error);
    printf("%s\n", good ? "the pack is sound" : "the pack is NOT as it should be");
    return good ? FF_EXIT_OK : FF_EXIT_FAILURE;
}
