#include "preprocess/pack/pack_write.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/core/pack/pack.h"

#include <stdlib.h>
#include <string.h>

/* In the order in which the sections stand in the file. */
static const struct section_kind {
    uint32_t tag, stride;
    size_t array; /* offset in ff_pack_content */
} kinds[FF_PACK_SECTION_COUNT] = {
    {FF_SECTION_STRINGS, 1, offsetof(ff_pack_content, strings)},
    {FF_SECTION_META, 1, offsetof(ff_pack_content, meta)},
    {FF_SECTION_JOINTS, sizeof(ff_pack_joint), offsetof(ff_pack_content, joints)},
    {FF_SECTION_POINTS, sizeof(ff_pack_point), offsetof(ff_pack_content, points)},
    {FF_SECTION_STREAMS, sizeof(ff_pack_stream), offsetof(ff_pack_content, streams)},
    {FF_SECTION_SLOTS, sizeof(ff_pack_slots), offsetof(ff_pack_content, slots)},
    {FF_SECTION_LANES, sizeof(ff_pack_lanes), offsetof(ff_pack_content, lanes)},
    {FF_SECTION_KEYS, 1, offsetof(ff_pack_content, keys)},
    {FF_SECTION_ROOTS, 3 * sizeof(float), offsetof(ff_pack_content, roots)},
    {FF_SECTION_CLIPS, sizeof(ff_pack_clip), offsetof(ff_pack_content, clips)},
    {FF_SECTION_PLANTS, sizeof(ff_pack_plant), offsetof(ff_pack_content, plants)},
    {FF_SECTION_ACTIONS, sizeof(ff_pack_action), offsetof(ff_pack_content, actions)},
    {FF_SECTION_COLLIDERS, sizeof(ff_pack_collider), offsetof(ff_pack_content, colliders)},
    {FF_SECTION_COLLIDER_RADII, sizeof(float), offsetof(ff_pack_content, collider_radii)},
    {FF_SECTION_EXAMPLES, sizeof(ff_pack_example), offsetof(ff_pack_content, examples)},
    {FF_SECTION_FEET, sizeof(ff_pack_foot), offsetof(ff_pack_content, feet)},
    {FF_SECTION_SIMPLICES, sizeof(ff_pack_simplex), offsetof(ff_pack_content, simplices)},
    {FF_SECTION_HULL, sizeof(ff_pack_point2), offsetof(ff_pack_content, hull)},
    {FF_SECTION_TRACKS, sizeof(ff_pack_track), offsetof(ff_pack_content, tracks)},
    {FF_SECTION_LOOPS, sizeof(ff_pack_loop), offsetof(ff_pack_content, loops)},
    {FF_SECTION_CORRESPONDENCES, sizeof(ff_pack_correspondence), offsetof(ff_pack_content, correspondences)},
    {FF_SECTION_PAIRS, sizeof(ff_pack_pair), offsetof(ff_pack_content, pairs)},
    {FF_SECTION_GAIT, sizeof(ff_pack_gait), offsetof(ff_pack_content, gait)},
    {FF_SECTION_GAIT_PATH, sizeof(ff_pack_gait_path), offsetof(ff_pack_content, gait_path)},
    {FF_SECTION_SHARP, sizeof(ff_pack_sharp), offsetof(ff_pack_content, sharp)},
    {FF_SECTION_EVENTS, sizeof(ff_pack_event), offsetof(ff_pack_content, events)},
    {FF_SECTION_SUCCESSORS, sizeof(ff_pack_successor), offsetof(ff_pack_content, successors)},
    {FF_SECTION_REACH, sizeof(ff_pack_reach), offsetof(ff_pack_content, reach)},
    {FF_SECTION_SKINS, sizeof(ff_pack_skin), offsetof(ff_pack_content, skins)},
    {FF_SECTION_VERTICES, sizeof(ff_pack_vertex), offsetof(ff_pack_content, vertices)},
    {FF_SECTION_TRIANGLES, sizeof(ff_pack_triangle), offsetof(ff_pack_content, triangles)},
};

static ff_array *section_array(ff_pack_content *content, int kind)
{
    return (ff_array *)(void *)((char *)content + kinds[kind].array);
}

void ff_pack_content_free(ff_pack_content *content)
{
    for (int k = 0; k < FF_PACK_SECTION_COUNT; ++k)
        ff_array_free(section_array(content, k));
    ff_array_free(&content->joins);
}

uint32_t ff_pack_add_string(ff_pack_content *content, const char *text)
{
    ff_array *strings = &content->strings;
    if (strings->count == 0) {
        char *first = ff_array_grow(strings, 1, 1);
        if (!first) return UINT32_MAX;
        *first = 0;
    }
    if (!text) return 0;
    const char *base = strings->data;
    for (size_t at = 0; at < strings->count; at += strlen(base + at) + 1)
        if (strcmp(base + at, text) == 0) return (uint32_t)at;
    size_t place = strings->count, length = strlen(text) + 1;
    if (length > UINT32_MAX - 1 - place) return UINT32_MAX;
    char *copy = ff_array_grow(strings, length, 1);
    if (!copy) return UINT32_MAX;
    memcpy(copy, text, length);
    return (uint32_t)place;
}

ff_status ff_pack_set_meta(ff_pack_content *content, const char *json, ff_error *error)
{
    content->meta.count = 0;
    size_t length = strlen(json);
    char *copy = ff_array_grow(&content->meta, length, 1);
    if (!copy) return ff_fail(error, FF_ERR_NO_MEMORY, "provenance of %zu bytes", length);
    memcpy(copy, json, length);
    return FF_OK;
}

ff_status ff_pack_image(ff_pack_content *content, void **data, size_t *size, ff_error *error)
{
    *data = NULL;
    *size = 0;
    if (ff_pack_add_string(content, "") == UINT32_MAX)
        return ff_fail(error, FF_ERR_NO_MEMORY, "the strings of the pack");
    ff_pack_section table[FF_PACK_SECTION_COUNT];
    for (int k = 0; k < FF_PACK_SECTION_COUNT; ++k)
        table[k] = (ff_pack_section){
            .tag = kinds[k].tag, .stride = kinds[k].stride, .count = section_array(content, k)->count};
    uint64_t whole = ff_sections_place(table, FF_PACK_SECTION_COUNT);
    unsigned char *image = aligned_alloc(FF_PACK_ALIGN, whole);
    if (!image) return ff_fail(error, FF_ERR_NO_MEMORY, "a pack of %llu bytes", (unsigned long long)whole);
    memset(image, 0, whole);
    memcpy(image + sizeof(ff_pack_header), table, sizeof table);
    for (int k = 0; k < FF_PACK_SECTION_COUNT; ++k)
        if (table[k].size) memcpy(image + table[k].offset, section_array(content, k)->data, table[k].size);
    ff_sections_seal(image, whole, &ff_pack_file_format, FF_PACK_SECTION_COUNT);
    *data = image;
    *size = whole;
    return FF_OK;
}

ff_status ff_pack_write(ff_pack_content *content, const char *path, size_t *size, ff_error *error)
{
    void *data;
    size_t bytes;
    ff_status status = ff_pack_image(content, &data, &bytes, error);
    if (status == FF_OK) status = ff_file_write_atomic(path, data, bytes, error);
    if (status == FF_OK && size) *size = bytes;
    free(data);
    return status;
}
