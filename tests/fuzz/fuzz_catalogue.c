/* Catalogue files: whatever is let through has sane entries whose files can be read. */
#include "mocap/catalogue_build.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ff_catalogue_builder builder = {0};
    ff_error error;
    if (ff_catalogue_add_text(&builder, (const char *)data, size, "fuzz.json", "tests/fuzz/seeds/bvh",
                              &error) == FF_OK) {
        const ff_catalogue_entry *entries = builder.entries.data;
        for (size_t i = 0; i < builder.entries.count; ++i)
            if (strlen(entries[i].path) == 0 || entries[i].trim_first < 0 ||
                (entries[i].trim_last >= 0 && entries[i].trim_last < entries[i].trim_first))
                abort();
    }
    ff_catalogue built = {builder.entries.data, (int)builder.entries.count, builder.memory};
    ff_catalogue_free(&built);
    return 0;
}
