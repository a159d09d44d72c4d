/* pack_seal.h - give bytes that were changed on purpose a checksum that fits, so that the checks behind it are met. */
#ifndef FF_TEST_PACK_SEAL_H
#define FF_TEST_PACK_SEAL_H

#include "runtime/core/pack/pack_format.h"

#include <stddef.h>
#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

static inline void ff_pack_seal(unsigned char *data, size_t size)
{
    if (size < sizeof(ff_pack_header)) return;
    ff_pack_header header;
    memcpy(&header, data, sizeof header);
    header.checksum = XXH64(data + sizeof header, size - sizeof header, 0);
    memcpy(data, &header, sizeof header);
}

#endif
