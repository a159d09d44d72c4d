/* The BVH reader on any bytes. */
#include "tests/fuzz/clip_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ff_load_options options = ff_load_options_default();
    ff_clip clip;
    ff_error error;
    if (ff_bvh_parse((const char *)data, size, "fuzz.bvh", &options, &clip, &error) == FF_OK) {
        check_clip(&clip, size % 2 ? 'y' : 'z');
    } else {
        must(error.status != FF_OK && error.message[0] && error.file[0]);
    }
    return 0;
}
