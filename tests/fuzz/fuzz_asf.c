/* The ASF reader on any bytes, and a one-line motion on every skeleton it accepts. */
#include "tests/fuzz/clip_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char motion[] = "1\nroot 1 2 3 40 50 60\nthigh 10 20 30\nshank 40\n";
    ff_load_options options = ff_load_options_default();
    ff_asf asf;
    ff_clip clip;
    ff_error error;
    if (ff_asf_parse((const char *)data, size, "fuzz.asf", false, &asf, &error) != FF_OK) {
        must(error.status != FF_OK && error.message[0] && error.file[0]);
        return 0;
    }
    must(asf.joint_count > 1 && asf.bone_count > 1 && asf.joint_count <= FF_CLIP_MAX_JOINTS);
    for (int j = 0; j < asf.joint_count; ++j)
        must(asf.joints[j].parent < j);
    if (ff_amc_parse(&asf, motion, sizeof motion - 1, "fuzz.amc", &options, &clip, &error) == FF_OK)
        check_clip(&clip, size % 2 ? 'y' : 'z');
    ff_asf_free(&asf);
    return 0;
}
