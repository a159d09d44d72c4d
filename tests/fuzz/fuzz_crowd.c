/* The loader of saved crowds, and a crowd going on from whatever it lets through. A first byte of 0: the rest is the file.
 * Else the rest are changes to a crowd that was saved just now (change_sections.h). The checksum is put right first: it would hide every other check. */
#include "tests/core/crowd_saved.h"
#include "tests/core/pack_seal.h"
#include "tests/fuzz/change_sections.h"

#define AGENTS_MOST 64u /* a definition may ask for a million, which only takes time */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static ff_pack *pack;
static unsigned char *saved;
static size_t saved_size;

static void prepare(void)
{
    static void *image;
    size_t size;
    ff_pack_content content;
    ff_walker_content(&content, &ff_walker_grid_tiny);
    /* Without the semi-procedural clip, which takes milliseconds to make ready for every crowd. */
    content.gait.count = content.gait_path.count = 0;
    --content.correspondences.count;
    --content.pairs.count;
    if (ff_pack_image(&content, &image, &size, NULL) != FF_OK) abort();
    ff_pack_content_free(&content);
    if (ff_pack_open_memory(image, size, &pack, NULL) != FF_OK) abort();
    ff_crowd *crowd = ff_saved_crowd(pack);
    saved = ff_saved_bytes(crowd, &saved_size);
    ff_crowd_destroy(crowd);
}

static uint32_t agents_most(const unsigned char *bytes, size_t size)
{
    /* The definition is the second section: its number of agents stands behind the step and the seed. */
    ff_pack_section def;
    uint32_t most = 0;
    if (size < sizeof(ff_pack_header) + 2 * sizeof def) return 0;
    memcpy(&def, bytes + sizeof(ff_pack_header) + sizeof def, sizeof def);
    if (def.offset <= size - 4 && size - 4 - def.offset >= 16) memcpy(&most, bytes + def.offset + 16, 4);
    return most;
}

static void load(unsigned char *bytes, size_t size)
{
    if (size >= sizeof(ff_pack_header)) ((ff_pack_header *)(void *)bytes)->file_size = size;
    ff_pack_seal(bytes, size);
    ff_crowd *crowd;
    if (agents_most(bytes, size) > AGENTS_MOST) return;
    if (ff_crowd_load(pack, bytes, size, NULL, &crowd, NULL) != FF_OK) return;
    if (!ff_saved_use(crowd, 3)) abort();
    ff_crowd_destroy(crowd);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (!pack) prepare();
    if (size == 0) return 0;
    bool whole = data[0] == 0;
    size_t bytes = whole ? size - 1 : saved_size;
    unsigned char *copy = malloc(bytes + 1);
    if (!copy) return 0;
    memcpy(copy, whole ? data + 1 : saved, bytes);
    if (!whole) ff_change_sections(copy, saved, data + 1, size - 1);
    load(copy, bytes);
    free(copy);
    return 0;
}
