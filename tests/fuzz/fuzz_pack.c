/* The pack loader, and synthesis on whatever it lets through. The checksum is put right first: it would hide every
 * other check. */
#include "tests/core/pack_seal.h"
#include "tests/core/pack_use.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    void *copy = NULL;
    if (posix_memalign(&copy, FF_PACK_ALIGN, size > 0 ? size : 1) != 0) return 0;
    if (size > 0) memcpy(copy, data, size);
    if (size >= sizeof(ff_pack_header)) ((ff_pack_header *)copy)->file_size = size;
    ff_pack_seal(copy, size);
    ff_pack *pack;
    if (ff_pack_open_memory(copy, size, &pack, NULL) == FF_OK) {
        if (!ff_pack_use(pack, 6, size)) abort();
        ff_pack_close(pack);
    }
    free(copy);
    return 0;
}
