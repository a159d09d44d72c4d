#include "preprocess/commands/each_clip.h"

#include "preprocess/build/settings.h"
#include "preprocess/plants/plant_edit.h"
#include "runtime/tool/progress.h"

#include <string.h>

int ff_each_entry(const ff_clip_run *run, const ff_operands *inputs, ff_entry_visit visit, void *context)
{
    ff_error error;
    ff_catalogue catalogue;
    if (ff_catalogue_read(inputs->items, inputs->count, &catalogue, &error) != FF_OK)
        return ff_command_fail(run->program, &error);
    int result = FF_EXIT_OK;
    ff_progress *progress = ff_progress_start(run->what, (uint64_t)catalogue.count, run->quiet);
    for (int i = 0; i < catalogue.count; ++i) {
        if (visit(&catalogue.entries[i], context, &error) != FF_OK) {
            ff_error_in_file(&error, catalogue.entries[i].path);
            result = ff_command_fail(run->program, &error);
        }
        ff_progress_step(progress, catalogue.entries[i].path);
    }
    ff_progress_end(progress);
    ff_catalogue_free(&catalogue);
    return result;
}

typedef struct seeing {
    ff_find_settings settings;
    ff_clip_visit visit;
    void *context;
} seeing;

static ff_status find_plants(const seeing *s, ff_seen_clip *seen, ff_error *error)
{
    ff_plant_edits edits;
    bool written = false;
    memset(&edits, 0, sizeof edits);
    ff_status status = ff_breaks_repair(&seen->clip, &s->settings.breaks, &seen->breaks, error);
    if (status == FF_OK) status = ff_plant_edits_load(seen->entry->path, &edits, &written, error);
    if (status == FF_OK)
        status =
            ff_plants_find_edited(&seen->clip, &s->settings, written ? &edits : NULL, &seen->plants, error);
    ff_plant_edits_free(&edits);
    return status;
}

static ff_status see(const ff_catalogue_entry *entry, void *context, ff_error *error)
{
    const seeing *s = context;
    ff_seen_clip seen;
    memset(&seen, 0, sizeof seen);
    seen.entry = entry;
    ff_status status = ff_clip_load(entry->path, &entry->options, &seen.clip, error);
    if (status == FF_OK) status = find_plants(s, &seen, error);
    if (status == FF_OK) status = s->visit(&seen, s->context, error);
    ff_plants_free(&seen.plants);
    ff_breaks_free(&seen.breaks);
    ff_clip_free(&seen.clip);
    return status;
}

int ff_each_clip(const ff_clip_run *run, const ff_operands *inputs, ff_clip_visit visit, void *context)
{
    ff_error error;
    ff_settings settings = ff_settings_default();
    if (run->config && ff_settings_load(run->config, &settings, &error) != FF_OK)
        return ff_command_fail(run->program, &error);
    seeing s = {settings.find, visit, context};
    return ff_each_entry(run, inputs, see, &s);
}
