/* The catalogue reader on any bytes. The files it may name are the seeds' own names, which are no clips: it looks
 * whether they are there, and into glTF files for their animations. */
#include "mocap/catalogue_build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void must(bool holds)
{
    if (!holds) abort();
}

static void check(const ff_catalogue_entry *entry)
{
    const ff_load_options *o = &entry->options;
    must(entry->path[0] && strlen(entry->tags) < 1u << 20 && strlen(entry->mode) < 32);
    must(strlen(entry->licence) + strlen(entry->citation) < 1u << 21);
    must(isfinite(o->unit_m) && o->unit_m >= 0.0 && isfinite(o->fps) && o->fps >= 0.0);
    must(o->up == 'y' || o->up == 'z');
    must(entry->trim_first >= 0 && (entry->trim_last == -1 || entry->trim_last >= entry->trim_first));
    for (int i = 0; i < o->override_count; ++i)
        must(o->overrides[i].joint && o->overrides[i].role >= FF_ROLE_NONE &&
             o->overrides[i].role < FF_ROLE_COUNT);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ff_error error;
    ff_catalogue_builder builder = {{0}, NULL};
    ff_status status = ff_catalogue_add_text(&builder, (const char *)data, size, "fuzz.json",
                                             "tests/fuzz/seeds/gltf", &error);
    must(status == FF_OK || (error.message[0] && error.status == status));
    ff_catalogue catalogue = {
        .entries = builder.entries.data, .count = (int)builder.entries.count, .memory = builder.memory};
    for (int i = 0; i < catalogue.count; ++i)
        check(&catalogue.entries[i]);
    ff_catalogue_free(&catalogue);
    return 0;
}
