#include "preprocess/examples/examples_why.h"

#include "preprocess/examples/example_judge.h"
#include "runtime/core/base/fail.h"

#include <stdio.h>
#include <string.h>

/* What the cycles are that are no straight walk. */
typedef struct tally {
    int all, runs, turns, aside, slow, bad, idle;
} tally;

static tally count_kinds(const ff_cycles *cycles, int clip_count)
{
    tally t = {0};
    for (int c = 0; c < clip_count; ++c)
        for (int i = 0; i < cycles[c].count; ++i) {
            const ff_example *e = &cycles[c].items[i];
            if (e->record.flags & FF_EXAMPLE_IDLE) {
                ++t.idle;
                continue;
            }
            ++t.all;
            if (e->record.gait == FF_GAIT_RUN)
                ++t.runs;
            else if (e->record.turn_rate != 0.0f)
                ++t.turns;
            else if (e->record.v_left != 0.0f)
                ++t.aside;
            else if (e->record.v_forward < FF_MODEL_SLOWEST)
                ++t.slow;
            else
                ++t.bad;
        }
    return t;
}

static void add(char *text, size_t size, int count, const char *what)
{
    size_t used = strlen(text);
    if (count > 0) snprintf(text + used, size - used, "%s%d %s", used ? ", " : "", count, what);
}

/* Of the straight walks the one that closes best, and what is wrong with it all the same: " (name: why)". */
static void explain_best(const ff_example_settings *settings, const ff_rig *rig, const ff_cycles *cycles,
                         int clip_count, char *text, size_t size)
{
    const ff_example *best = NULL;
    char why[96] = "";
    for (int c = 0; c < clip_count; ++c)
        for (int i = 0; i < cycles[c].count; ++i) {
            const ff_example *e = &cycles[c].items[i];
            if (ff_example_is_model(e) && (!best || e->loop.moved < best->loop.moved)) best = e;
        }
    if (best && !ff_example_judge_loosely(settings, rig, best, why, sizeof why))
        snprintf(text, size, " (the best, %.60s: %s)", best->name, why);
}

ff_status ff_examples_fail(const ff_example_settings *settings, const ff_rig *rig, const ff_cycles *cycles,
                           int clip_count, ff_error *error)
{
    tally t = count_kinds(cycles, clip_count);
    char kinds[160] = "", bad[200] = "";
    if (t.all == 0)
        return ff_fail(
            error, FF_ERR_NO_DATA,
            "no straight walk to build on: in %d clip%s nobody is seen to land on one foot, step, and land "
            "on the other; give longer walks, or see with 'footfall-pack plants' what was found",
            clip_count, clip_count == 1 ? "" : "s");
    add(kinds, sizeof kinds, t.runs, "run");
    add(kinds, sizeof kinds, t.turns, "turn");
    add(kinds, sizeof kinds, t.aside, "go aside");
    add(kinds, sizeof kinds, t.slow, "are too slow or go back");
    add(kinds, sizeof kinds, t.bad, "are no good");
    explain_best(settings, rig, cycles, clip_count, bad, sizeof bad);
    return ff_fail(
        error, FF_ERR_NO_DATA,
        "no straight walk to build on: of %d gait cycles %s%s; add a clip of someone walking straight", t.all,
        kinds, bad);
}
