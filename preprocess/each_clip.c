#include "preprocess/each_clip.h"

#include "preprocess/plant_edit.h"
#include "runtime/core/base/fail.h"
#include "runtime/tool/command_line.h"
#include "runtime/tool/progress.h"

#include <string.h>

static ff_status see(const ff_catalogue_entry *entry, ff_clip_visit visit, void *context, ff_error *error)
{
    ff_seen_clip seen;
    memset(&seen, 0, sizeof seen);
    seen.entry = entry;
    ff_status status = ff_clip_load(entry->path, &entry->options, &seen.clip, error);
    if (status != FF_OK) return status;
    status = ff_breaks_repair(&seen.clip, &seen.breaks, error);
    ff_plant_edits edits;
    bool written = false;
    memset(&edits, 0, sizeof edits);
    if (status == FF_OK) status = ff_plant_edits_load(entry->path, &edits, &written, error);
    if (status == FF_OK)
        status = ff_plants_find_edited(&seen.clip, written ? &edits : NULL, &seen.plants, error);
    ff_plant_edits_free(&edits);
    if (status == FF_OK) status = visit(&seen, context, error);
    if (status != FF_OK) ff_error_in_file(error, entry->path);
    ff_plants_free(&seen.plants);
    ff_breaks_free(&seen.breaks);
    ff_clip_free(&seen.clip);
    return status;
}

int ff_each_clip(const char *program, const char *what, const char *const *inputs, int count, bool quiet,
                 ff_clip_visit visit, void *context)
{
    ff_error error;
    ff_catalogue catalogue;
    if (ff_catalogue_read(inputs, count, &catalogue, &error) != FF_OK)
        return ff_command_fail(program, &error);
    int result = FF_EXIT_OK;
    ff_progress *progress = ff_progress_start(what, (uint64_t)catalogue.count, quiet);
    for (int i = 0; i < catalogue.count; ++i) {
        if (see(&catalogue.entries[i], visit, context, &error) != FF_OK)
            result = ff_command_fail(program, &error);
        ff_progress_step(progress, catalogue.entries[i].path);
    }
    ff_progress_end(progress);
    ff_catalogue_free(&catalogue);
    return result;
}
