/* The configuration reader on any bytes: refused with a place, or every setting in its range. */
#include "preprocess/build/settings.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ff_settings settings;
    ff_error error;
    if (ff_settings_parse((const char *)data, size, "fuzz.json", &settings, &error) != FF_OK) {
        if (error.status == FF_OK || !error.message[0] || !error.file[0]) abort();
        return 0;
    }
    for (int i = 0; i < ff_setting_count; ++i) {
        const ff_setting *s = &ff_setting_table[i];
        double value = ff_setting_value(&settings, s);
        if (!(value >= s->low && value <= s->high)) abort();
    }
    json_t *root = ff_settings_json(&settings);
    if (!root) abort();
    json_decref(root);
    return 0;
}
