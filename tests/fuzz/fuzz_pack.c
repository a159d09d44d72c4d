/* The pack loader, and synthesis and footstep plans on whatever it lets through. A first byte of 0: the rest is the file. Else
 * it says which of a few small packs, made just now, the rest are changes to (change_sections.h). The checksum is put
 * right first: it would hide every other check. */
#include "runtime/core/plan/plan.h"
#include "tests/core/pack_seal.h"
#include "tests/core/pack_use.h"
#include "tests/core/walker_pack.h"
#include "tests/fuzz/change_sections.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const ff_walker_grid cube = {{2, 2, 2}, {{0.0, 1.2}, {0.0, 0.4}, {0.0, 1.0}}, 8.0};

/* The packs to change: a line of examples, a cube of them; each with a surface and with steps that follow each other. */
enum { PACKS = 2 };
static unsigned char *packs[PACKS];
static size_t pack_size[PACKS];

static void prepare(void)
{
    for (int i = 0; i < PACKS; ++i) {
        void *image;
        ff_pack_content content;
        ff_walker_content(&content, i ? &cube : &ff_walker_grid_tiny);
        ff_walker_steps(&content);
        if (ff_pack_image(&content, &image, &pack_size[i], NULL) != FF_OK) abort();
        ff_pack_content_free(&content);
        packs[i] = image;
        ff_pack *pack;
        if (ff_pack_open_memory(image, pack_size[i], &pack, NULL) != FF_OK) abort(); /* or nothing is tried */
        ff_pack_close(pack);
    }
}

/* Making a semi-procedural clip ready takes milliseconds: only now and then. */
static void use(const ff_pack *pack, uint64_t seed)
{
    ff_action_set *set;
    if ((pack->gait_count == 0 || seed % 16 == 0) && !ff_pack_use(pack, 6, seed)) abort();
    if (ff_action_set_create(pack, 0, &set, NULL) == FF_OK) ff_action_set_destroy(set);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (!packs[0]) prepare();
    if (size == 0) return 0;
    int which = data[0] == 0 ? -1 : data[0] % PACKS;
    size_t bytes = which < 0 ? size - 1 : pack_size[which];
    void *copy = NULL;
    if (posix_memalign(&copy, FF_PACK_ALIGN, bytes > 0 ? bytes : 1) != 0) return 0;
    if (bytes > 0) memcpy(copy, which < 0 ? data + 1 : packs[which], bytes);
    if (which >= 0) ff_change_sections(copy, packs[which], data + 1, size - 1);
    if (bytes >= sizeof(ff_pack_header)) ((ff_pack_header *)copy)->file_size = bytes;
    ff_pack_seal(copy, bytes);
    ff_pack *pack;
    if (ff_pack_open_memory(copy, bytes, &pack, NULL) == FF_OK) {
        use(pack, size > 0 ? data[size - 1] + size : 0);
        ff_pack_close(pack);
    }
    free(copy);
    return 0;
}
