#include "runtime/core/pack/sections.h"

#include "runtime/core/base/fail.h"

#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "records are used in place: little-endian only");

#define MAX_ELEMENTS 0x7fffffffu

typedef struct reading {
    const unsigned char *data;
    uint64_t size;
    const ff_section_format *format;
    ff_section_view *views;
    ff_error *error;
} reading;

static void tag_text(uint32_t tag, char text[5])
{
    for (int i = 0; i < 4; ++i) {
        unsigned char c = (unsigned char)(tag >> (8 * i));
        text[i] = c >= 32 && c < 127 ? (char)c : '?';
    }
    text[4] = 0;
}

static ff_status check_size(const reading *r, const ff_pack_header *header)
{
    if (header->file_size != r->size)
        return ff_fail_section(r->error, FF_ERR_PARSE, "header", offsetof(ff_pack_header, file_size),
                               "the header speaks of %llu bytes, the file has %llu: it was cut or grew; %s",
                               (unsigned long long)header->file_size, (unsigned long long)r->size,
                               r->format->mend);
    if (header->section_count > FF_SECTIONS_MAX ||
        header->section_count > (r->size - sizeof *header) / sizeof(ff_pack_section))
        return ff_fail_section(r->error, FF_ERR_PARSE, "header", offsetof(ff_pack_header, section_count),
                               "%u sections do not fit (at most %u)", header->section_count, FF_SECTIONS_MAX);
    return FF_OK;
}

static ff_status check_header(const reading *r, ff_pack_header *header)
{
    const ff_section_format *format = r->format;
    if (r->size < sizeof *header)
        return ff_fail_section(r->error, FF_ERR_PARSE, "header", r->size,
                               "the file ends after %llu bytes; a %s has a header of %zu bytes",
                               (unsigned long long)r->size, format->name, sizeof *header);
    memcpy(header, r->data, sizeof *header);
    if (header->magic != format->magic)
        return ff_fail_section(r->error, FF_ERR_PARSE, "header", 0,
                               "this is not a %s (it does not begin with %s); %s", format->name,
                               format->begin, format->make);
    if (header->version != format->version)
        return ff_fail_section(r->error, FF_ERR_UNSUPPORTED, "header", offsetof(ff_pack_header, version),
                               "%s format version %u, this program reads version %u; %s", format->name,
                               header->version, format->version, format->renew);
    ff_status status = check_size(r, header);
    if (status != FF_OK) return status;
    uint64_t sum = XXH64(r->data + sizeof *header, r->size - sizeof *header, 0);
    if (header->checksum != sum)
        return ff_fail_section(r->error, FF_ERR_PARSE, "header", offsetof(ff_pack_header, checksum),
                               "checksum %016llx, the bytes give %016llx: the file is damaged; %s",
                               (unsigned long long)header->checksum, (unsigned long long)sum, format->mend);
    return FF_OK;
}

static const ff_section_kind *find_kind(const ff_section_format *format, uint32_t tag)
{
    for (uint32_t kind = 0; kind < format->kind_count; ++kind)
        if (format->kinds[kind].tag == tag) return &format->kinds[kind];
    return NULL;
}

/* One entry of the section table: at is its place in the file. */
static ff_status check_section(const reading *r, uint64_t end, const ff_pack_section *section, uint64_t at)
{
    char name[5];
    tag_text(section->tag, name);
    const ff_section_kind *kind = find_kind(r->format, section->tag);
    if (!kind)
        return ff_fail_section(r->error, FF_ERR_PARSE, name, at, "unknown kind of section in the table");
    ff_section_view *view = &r->views[kind - r->format->kinds];
    if (view->present) return ff_fail_section(r->error, FF_ERR_PARSE, name, at, "the section appears twice");
    if (section->stride != kind->stride)
        return ff_fail_section(r->error, FF_ERR_PARSE, name, at + offsetof(ff_pack_section, stride),
                               "records of %u bytes, expected %u; %s", section->stride, kind->stride,
                               r->format->renew);
    if (section->count > MAX_ELEMENTS || section->count < kind->min_count)
        return ff_fail_section(r->error, FF_ERR_RANGE, name, at + offsetof(ff_pack_section, count),
                               "%llu records, expected %u to %u", (unsigned long long)section->count,
                               kind->min_count, MAX_ELEMENTS);
    if (section->size != section->count * section->stride) /* both below 2^32: no overflow */
        return ff_fail_section(r->error, FF_ERR_PARSE, name, at + offsetof(ff_pack_section, size),
                               "%llu bytes for %llu records of %u bytes", (unsigned long long)section->size,
                               (unsigned long long)section->count, section->stride);
    if (section->offset % FF_PACK_ALIGN != 0 || section->offset < end || section->offset > r->size ||
        section->size > r->size - section->offset)
        return ff_fail_section(r->error, FF_ERR_PARSE, name, at + offsetof(ff_pack_section, offset),
                               "%llu bytes at %llu are not inside the file of %llu bytes on a %u-byte "
                               "boundary after the section table",
                               (unsigned long long)section->size, (unsigned long long)section->offset,
                               (unsigned long long)r->size, FF_PACK_ALIGN);
    *view = (ff_section_view){r->data + section->offset, section->count, 1};
    return FF_OK;
}

static ff_status read_table(const reading *r, const ff_pack_header *header)
{
    uint64_t end = sizeof *header + (uint64_t)header->section_count * sizeof(ff_pack_section);
    for (uint32_t i = 0; i < header->section_count; ++i) {
        uint64_t at = sizeof *header + (uint64_t)i * sizeof(ff_pack_section);
        ff_pack_section section;
        memcpy(&section, r->data + at, sizeof section);
        ff_status status = check_section(r, end, &section, at);
        if (status != FF_OK) return status;
        end = section.offset + section.size; /* sections lie in table order, none over another */
    }
    for (uint32_t kind = 0; kind < r->format->kind_count; ++kind) {
        if (r->views[kind].present || !r->format->kinds[kind].required) continue;
        char name[5];
        tag_text(r->format->kinds[kind].tag, name);
        return ff_fail_section(r->error, FF_ERR_PARSE, name, sizeof *header, "this section is missing");
    }
    return FF_OK;
}

ff_status ff_sections_read(const void *data, size_t size, const ff_section_format *format,
                           ff_section_view *views, ff_error *error)
{
    reading r = {data, size, format, views, error};
    ff_pack_header header;
    memset(views, 0, format->kind_count * sizeof *views);
    ff_status status = check_header(&r, &header);
    return status == FF_OK ? read_table(&r, &header) : status;
}

static uint64_t align_up(uint64_t offset)
{
    return (offset + FF_PACK_ALIGN - 1) & ~(uint64_t)(FF_PACK_ALIGN - 1);
}

uint64_t ff_sections_place(ff_pack_section *table, uint32_t count)
{
    uint64_t end = sizeof(ff_pack_header) + count * sizeof *table;
    for (uint32_t i = 0; i < count; ++i) {
        table[i].offset = align_up(end);
        table[i].size = table[i].count * table[i].stride;
        end = table[i].offset + table[i].size;
    }
    return align_up(end);
}

void ff_sections_seal(void *data, uint64_t size, const ff_section_format *format, uint32_t count)
{
    ff_pack_header header = {format->magic, format->version, count, size, 0};
    memcpy(data, &header, sizeof header);
    header.checksum = XXH64((unsigned char *)data + sizeof header, size - sizeof header, 0);
    memcpy(data, &header, sizeof header);
}
