/* Override files: whatever is let through is applied to a clip's plants, whose frames then are in order and inside it. */
#include "preprocess/plants/plant_edit.h"

#include <stdlib.h>

enum { FRAMES = 300, FOUND = 4, MOST = 256 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static bool is_sane(const ff_plant *plants, int count)
{
    for (int i = 0; i < count; ++i) {
        const ff_plant *p = &plants[i];
        if (p->start < 0 || p->end < p->start || p->end >= FRAMES) return false;
        if (p->flat_start >= 0 &&
            (p->flat_start < p->start || p->flat_end > p->end || p->flat_end < p->flat_start))
            return false;
        if (i > 0 && plants[i - 1].end >= p->start) return false;
    }
    return true;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const ff_plant found[FOUND] = {
        {.foot = 0, .start = 10, .end = 60, .flat_start = 20, .flat_end = 50},
        {.foot = 1, .start = 40, .end = 100, .flat_start = 50, .flat_end = 80},
        {.foot = 0, .start = 90, .end = 150, .flat_start = -1, .flat_end = -1},
        {.foot = 1, .start = 140, .end = 299, .flat_start = 150, .flat_end = 299}};
    static ff_plant out[FOUND + MOST];
    ff_plant_edits edits;
    ff_error error;
    if (ff_plant_edits_parse((const char *)data, size, "fuzz.plants.json", &edits, &error) != FF_OK) return 0;
    for (int pass = 0; pass < 2 && edits.count <= MOST; ++pass) {
        for (int foot = 0; foot < 2; ++foot) {
            int count = 0;
            if (ff_plant_edits_apply(&edits, foot, FRAMES, found, FOUND, out, &count, &error) != FF_OK)
                continue;
            if (!is_sane(out, count)) abort();
        }
        ff_plant_edits_trim(&edits, 25, FRAMES);
    }
    ff_plant_edits_free(&edits);
    return 0;
}
