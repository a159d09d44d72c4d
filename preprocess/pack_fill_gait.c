/* What velocity planning and synthesis need beside the examples themselves. */
#include "preprocess/pack_fill.h"

#include "runtime/core/base/fail.h"

static ff_status no_memory(ff_error *error)
{
    return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory filling the pack");
}

static ff_status add_loops(ff_pack_content *content, const ff_example_set *set, ff_error *error)
{
    ff_pack_loop *loops = ff_array_grow(&content->loops, (size_t)set->count, sizeof *loops);
    if (!loops) return no_memory(error);
    for (int i = 0; i < set->count; ++i)
        loops[i] = set->items[i].loop;
    return FF_OK;
}

ff_status ff_pack_add_gait(ff_pack_content *content, const ff_example_set *set, ff_error *error)
{
    return add_loops(content, set, error);
}
