#include "preprocess/examples/correspond_set.h"

#include "preprocess/examples/example_judge.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

typedef struct job {
    const ff_correspondence_settings *settings;
    const ff_example_set *set;
    const ff_example *gait;
    const ff_rig *rig;
    ff_point_cycle *cycles;  /* [2 * count]: of the examples, of the semi-procedural clip at their rates */
    ff_map_windows *windows; /* likewise */
    ff_correspondences *out;
    ff_status *status; /* [2 * count], then reused [out->count] */
    ff_error *errors;
} job;

static const ff_example *example_of(const job *j, int index)
{
    return index < j->set->count ? &j->set->items[index] : &j->gait[index - j->set->count];
}

static void prepare_one(void *context, uint32_t index)
{
    job *j = context;
    const ff_example *e = example_of(j, (int)index);
    if (e->frame_count == 0) return;
    j->status[index] = ff_point_cycle_from_example(j->rig, e, &j->cycles[index], &j->errors[index]);
    if (j->status[index] == FF_OK)
        j->status[index] = ff_map_windows_make(&j->cycles[index], &j->windows[index], &j->errors[index]);
}

static ff_cycle_side side_of(const job *j, int index)
{
    const ff_pack_example *record = &example_of(j, index)->record;
    return (ff_cycle_side){&j->cycles[index], &j->windows[index],
                           record->flags & FF_EXAMPLE_IDLE ? NULL : record->key};
}

static bool walks_straight(const ff_example *e)
{
    return e->record.gait == FF_GAIT_WALK && !(e->record.flags & FF_EXAMPLE_IDLE) &&
           ff_example_is_straight(e);
}

static void correspond_one(void *context, uint32_t index)
{
    job *j = context;
    ff_set_pairs *item = &j->out->items[index];
    int other = item->to < 0 ? j->set->count + item->from : item->to;
    ff_cycle_side first = side_of(j, item->from), second = side_of(j, other);
    bool straight = walks_straight(example_of(j, item->from)) && walks_straight(example_of(j, other));
    double *map = malloc(FF_MAP_SIDE * FF_MAP_SIDE * sizeof *map);
    j->status[index] = map ? ff_correspond(j->settings, &first, &second,
                                           straight ? j->settings->straight : j->settings->other, map,
                                           &item->pairs, &j->errors[index])
                           : ff_fail(&j->errors[index], FF_ERR_NO_MEMORY, "a distance map");
    free(map);
}

static ff_status first_failure(const job *j, int count, ff_error *error)
{
    for (int i = 0; i < count; ++i) {
        if (j->status[i] == FF_OK) continue;
        if (error) *error = j->errors[i];
        return j->status[i];
    }
    return FF_OK;
}

static void list_items(job *j)
{
    int n = j->set->count;
    for (int from = 0; from < n; ++from) {
        for (int to = from + 1; to < n; ++to)
            j->out->items[j->out->count++] = (ff_set_pairs){.from = from, .to = to};
        if (j->gait[from].frame_count > 0)
            j->out->items[j->out->count++] = (ff_set_pairs){.from = from, .to = -1};
    }
}

ff_status ff_correspond_set(const ff_correspondence_settings *settings, const ff_rig *rig,
                            const ff_example_set *set, const ff_example *gait, ff_tasks *tasks,
                            ff_correspondences *out, ff_error *error)
{
    size_t n = (size_t)set->count, room = n * (n + 3) / 2; /* at least 2 n */
    *out = (ff_correspondences){.items = ff_calloc(room, sizeof *out->items)};
    job j = {.settings = settings,
             .set = set,
             .gait = gait,
             .rig = rig,
             .out = out,
             .cycles = ff_calloc(2 * n, sizeof *j.cycles),
             .windows = ff_calloc(2 * n, sizeof *j.windows),
             .status = ff_calloc(room, sizeof *j.status),
             .errors = ff_calloc(room, sizeof *j.errors)};
    ff_status status = FF_OK;
    if (!out->items || !j.cycles || !j.windows || !j.status || !j.errors)
        status = ff_fail(error, FF_ERR_NO_MEMORY, "the correspondences of %zu examples", n);
    if (status == FF_OK) {
        ff_tasks_for(tasks, (uint32_t)(2 * n), 1, prepare_one, &j);
        status = first_failure(&j, (int)(2 * n), error);
    }
    if (status == FF_OK) {
        list_items(&j);
        ff_tasks_for(tasks, (uint32_t)out->count, 4, correspond_one, &j);
        status = first_failure(&j, out->count, error);
    }
    for (size_t i = 0; j.cycles && j.windows && i < 2 * n; ++i) {
        ff_point_cycle_free(&j.cycles[i]);
        ff_map_windows_free(&j.windows[i]);
    }
    free(j.cycles);
    free(j.windows);
    free(j.status);
    free(j.errors);
    if (status != FF_OK) ff_correspondences_free(out);
    return status;
}

void ff_correspondences_free(ff_correspondences *correspondences)
{
    free(correspondences->items);
    memset(correspondences, 0, sizeof *correspondences);
}
