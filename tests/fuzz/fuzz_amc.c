/* The AMC reader on any bytes, with one small skeleton. */
#include "tests/fuzz/clip_check.h"

#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char skeleton[] =
    ":units\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n axis XYZ\n position 0 0 0\n "
    "orientation 0 0 0\n"
    ":bonedata\nbegin\nname thigh\ndirection 0 -1 0\nlength 7\naxis 0 0 20 XYZ\ndof rx ry rz\nend\n"
    "begin\nname shank\ndirection 0 -1 0\nlength 7\naxis 10 0 20 XYZ\ndof rx\nend\n"
    "begin\nname rib\ndirection 1 0 0\nlength 2\naxis 0 0 0 XYZ\nend\n"
    ":hierarchy\nbegin\nroot thigh rib\nthigh shank\nend\n";

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ff_load_options options = ff_load_options_default();
    ff_asf asf;
    ff_clip clip;
    ff_error error;
    must(ff_asf_parse(skeleton, strlen(skeleton), "fuzz.asf", true, &asf, &error) == FF_OK);
    if (ff_amc_parse(&asf, (const char *)data, size, "fuzz.amc", &options, &clip, &error) == FF_OK) {
        check_clip(&clip, size % 2 ? 'y' : 'z');
    } else {
        must(error.status != FF_OK && error.message[0] && error.file[0]);
    }
    ff_asf_free(&asf);
    return 0;
}
