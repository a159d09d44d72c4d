/* sections.h - files made of sections: a header with a checksum, a table, and records on 64-byte boundaries. Motion packs
 * (pack_format.h, which defines header and table) and saved crowds (crowd_format.h) are such files. */
#ifndef FF_SECTIONS_H
#define FF_SECTIONS_H

#include "runtime/core/pack/pack_format.h"
#include "runtime/footfall.h"

#define FF_SECTIONS_MAX 64u

/* What a section must look like. */
typedef struct ff_section_kind {
    uint32_t tag, stride;
    uint32_t min_count;
    int required;
} ff_section_kind;

typedef struct ff_section_view {
    const unsigned char *data;
    uint64_t count;
    int present;
} ff_section_view;

/* A format of such files, with the words of its errors. */
typedef struct ff_section_format {
    uint64_t magic;
    uint32_t version;
    const ff_section_kind *kinds;
    uint32_t kind_count;
    const char *name;  /* "motion pack" */
    const char *begin; /* "FOOFPACK", the magic as text */
    const char *make;  /* "make one with ...", for a file that is none */
    const char *renew; /* "build the pack again", for one of another version or of another size of records */
    const char *mend;  /* "build or copy the pack again", for a damaged one */
} ff_section_format;

/* Check header, checksum and table of size bytes; views[kind_count] then point into data. */
ff_status ff_sections_read(const void *data, size_t size, const ff_section_format *format,
                           ff_section_view *views, ff_error *error);

/* Set offsets and sizes in a table whose tags, strides and counts are given. Returns the size of the whole file. */
uint64_t ff_sections_place(ff_pack_section *table, uint32_t count);

/* Write the header over a file whose table and sections stand in place and whose gaps are 0. */
void ff_sections_seal(void *data, uint64_t size, const ff_section_format *format, uint32_t count);

#endif
