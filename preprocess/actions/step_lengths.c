#include "preprocess/actions/steps.h"

#include "preprocess/base/filter.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>

static bool is_walk(const ff_action *action)
{
    return action->record.mode == FF_MODE_WALK_SHORT || action->record.mode == FF_MODE_WALK_LONG;
}

/* From ball to ball, whatever the direction. */
static double step_length(const ff_action *action)
{
    return ff_length2(ff_v2((double)action->record.step_length, (double)action->record.step_width));
}

ff_status ff_actions_split_walks(ff_actions *const *sets, int count, ff_error *error)
{
    size_t total = 0;
    for (int i = 0; i < count; ++i)
        total += (size_t)sets[i]->count;
    double *lengths = ff_calloc(total + 1, sizeof *lengths);
    if (!lengths) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the lengths of %zu steps", total);
    int walks = 0;
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < sets[i]->count; ++k)
            if (is_walk(&sets[i]->items[k])) lengths[walks++] = step_length(&sets[i]->items[k]);
    double median = walks > 0 ? ff_filter_quantile(lengths, walks, 0.5) : 0.0;
    free(lengths);
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < sets[i]->count; ++k) {
            ff_action *action = &sets[i]->items[k];
            bool brief = step_length(action) < median;
            if (is_walk(action)) action->record.mode = brief ? FF_MODE_WALK_SHORT : FF_MODE_WALK_LONG;
        }
    return FF_OK;
}
