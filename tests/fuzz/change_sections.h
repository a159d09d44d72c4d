/* change_sections.h - a fuzzer's bytes as changes to a file of sections that was made just now, so that seeds outlive every
 * change of the format: 11 bytes each, for a section (modulo their number; one more is the table itself), a place in it (2
 * bytes: modulo its size) and the 8 bytes that are written there. */
#ifndef FF_CHANGE_SECTIONS_H
#define FF_CHANGE_SECTIONS_H

#include "runtime/core/pack/pack_format.h"

#include <string.h>

/* bytes starts as a copy of original. */
static inline void ff_change_sections(unsigned char *bytes, const unsigned char *original,
                                      const uint8_t *data, size_t size)
{
    enum { CHANGE = 11 };
    ff_pack_header header;
    memcpy(&header, original, sizeof header);
    for (; size >= CHANGE; data += CHANGE, size -= CHANGE) {
        ff_pack_section section;
        uint32_t index = data[0] % (header.section_count + 1u);
        bool table = index == header.section_count;
        memcpy(&section, original + sizeof header + (table ? 0 : index) * sizeof section, sizeof section);
        uint64_t start = table ? sizeof header : section.offset;
        uint64_t length = table ? header.section_count * sizeof section : section.size;
        uint64_t place = (uint64_t)(data[1] | data[2] << 8);
        if (length >= 8) memcpy(bytes + start + 8 * (place % (length / 8)), data + 3, 8);
    }
}

#endif
