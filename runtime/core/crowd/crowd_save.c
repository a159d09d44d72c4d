/* Writing a crowd down, to go on from it later. */
#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/core/crowd/crowd_format.h"

#include <stdlib.h>
#include <string.h>

typedef struct saved_layout {
    ff_section_kind kinds[FF_SECTIONS_MAX];
    ff_pack_section table[FF_SECTIONS_MAX];
    uint32_t count;
    uint64_t size; /* of the whole file */
} saved_layout;

static uint64_t records(const ff_crowd *crowd, const ff_crowd_array *array)
{
    if (!ff_crowd_array_element(crowd, array, 0)) return 0;
    return array->kind == FF_ARRAY_SLOT ? crowd->slot_count : crowd->agent_count;
}

/* Sections in the order of their kinds: the fixed ones, then the arrays. */
static void lay_out(const ff_crowd *crowd, saved_layout *layout)
{
    layout->count = ff_crowd_section_kinds(layout->kinds);
    for (uint32_t s = 0; s < layout->count; ++s)
        layout->table[s] = (ff_pack_section){.tag = layout->kinds[s].tag, .stride = layout->kinds[s].stride};
    layout->table[FF_SAVED_HEAD].count = layout->table[FF_SAVED_DEF].count = 1;
    layout->table[FF_SAVED_WALLS].count = crowd->walls.count;
    layout->table[FF_SAVED_OBSTACLES].count = crowd->obstacle_count;
    if (crowd->behaviour) {
        const ff_behaviour_def *def = &crowd->behaviour->def;
        layout->table[FF_SAVED_SPAWNING].count = def->spawner_count;
        layout->table[FF_SAVED_SHOWN].count = def->signal_count;
        for (uint32_t i = 0; i < FF_BEHAVIOUR_ARRAYS; ++i)
            layout->table[FF_SAVED_BEHAVIOUR + i].count =
                ff_behaviour_array_count(def, &ff_behaviour_arrays[i]);
    }
    uint32_t s = FF_SAVED_ARRAYS;
    for (uint32_t i = 0; i < ff_crowd_array_count(); ++i)
        if (ff_crowd_array_at(i)->kind != FF_ARRAY_STEP)
            layout->table[s++].count = records(crowd, ff_crowd_array_at(i));
    layout->size = ff_sections_place(layout->table, layout->count);
}

static void write_fixed(const ff_crowd *crowd, const saved_layout *layout, unsigned char *data)
{
    const ff_pack_header *pack = (const ff_pack_header *)(const void *)crowd->pack->data;
    ff_saved_head head = {.pack_checksum = pack->checksum,
                          .pack_size = crowd->pack->size,
                          .steps = crowd->steps,
                          .added = crowd->added,
                          .spawned = crowd->spawned,
                          .left = crowd->left,
                          .agent_count = crowd->agent_count,
                          .slot_count = crowd->slot_count,
                          .free_first = crowd->free_first,
                          .fault.number = FF_NONE};
    if (crowd->behaviour) head.fault = crowd->behaviour->fault;
    ff_saved_def def = ff_crowd_def_pack(&crowd->def);
    memcpy(data + layout->table[FF_SAVED_HEAD].offset, &head, sizeof head);
    memcpy(data + layout->table[FF_SAVED_DEF].offset, &def, sizeof def);
    unsigned char *at = data + layout->table[FF_SAVED_WALLS].offset;
    for (uint32_t i = 0; i < crowd->walls.count; ++i, at += sizeof(ff_saved_wall)) {
        ff_saved_wall wall = {crowd->walls.wall[i].from, crowd->walls.wall[i].to};
        memcpy(at, &wall, sizeof wall);
    }
    if (crowd->obstacle_count > 0)
        memcpy(data + layout->table[FF_SAVED_OBSTACLES].offset, crowd->obstacles,
               crowd->obstacle_count * sizeof *crowd->obstacles);
}

static void write_section(const saved_layout *layout, uint32_t section, const void *from, unsigned char *data)
{
    if (layout->table[section].size > 0)
        memcpy(data + layout->table[section].offset, from, layout->table[section].size);
}

static void write_behaviour(const ff_behaviour *behaviour, const saved_layout *layout, unsigned char *data)
{
    write_section(layout, FF_SAVED_SPAWNING, behaviour->spawning, data);
    write_section(layout, FF_SAVED_SHOWN, behaviour->shown, data);
    for (uint32_t i = 0; i < FF_BEHAVIOUR_ARRAYS; ++i)
        write_section(layout, FF_SAVED_BEHAVIOUR + i,
                      ff_behaviour_array_data(&behaviour->def, &ff_behaviour_arrays[i]), data);
}

static void write_array(const ff_crowd *crowd, const ff_crowd_array *array, unsigned char *at)
{
    for (uint32_t slot = 0; slot < crowd->slot_count; ++slot) {
        if (array->kind == FF_ARRAY_AGENT && !crowd->alive[slot]) continue;
        memcpy(at, ff_crowd_array_element(crowd, array, slot), array->size);
        at += array->size;
    }
}

size_t ff_crowd_save_size(const ff_crowd *crowd)
{
    saved_layout layout;
    lay_out(crowd, &layout);
    return (size_t)layout.size;
}

ff_status ff_crowd_save(const ff_crowd *crowd, void *data, size_t size, ff_error *error)
{
    if (!crowd || !data) return ff_fail(error, FF_ERR_ARGUMENT, "no crowd to save, or nowhere to put it");
    saved_layout layout;
    lay_out(crowd, &layout);
    if (size != layout.size)
        return ff_fail(error, FF_ERR_ARGUMENT,
                       "%zu bytes to save a crowd in; expected the %llu of ff_crowd_save_size()", size,
                       (unsigned long long)layout.size);
    memset(data, 0, size);
    memcpy((unsigned char *)data + sizeof(ff_pack_header), layout.table,
           layout.count * sizeof layout.table[0]);
    write_fixed(crowd, &layout, data);
    if (crowd->behaviour) write_behaviour(crowd->behaviour, &layout, data);
    uint32_t s = FF_SAVED_ARRAYS;
    for (uint32_t i = 0; i < ff_crowd_array_count(); ++i) {
        if (ff_crowd_array_at(i)->kind == FF_ARRAY_STEP) continue;
        const ff_pack_section *section = &layout.table[s++];
        if (section->count > 0)
            write_array(crowd, ff_crowd_array_at(i), (unsigned char *)data + section->offset);
    }
    ff_section_format format = ff_crowd_file_format(layout.kinds, layout.count);
    ff_sections_seal(data, size, &format, layout.count);
    return FF_OK;
}

ff_status ff_crowd_save_file(const ff_crowd *crowd, const char *path, ff_error *error)
{
    if (!crowd || !path) return ff_fail(error, FF_ERR_ARGUMENT, "no crowd to save, or no file to save it to");
    size_t size = ff_crowd_save_size(crowd);
    void *data = malloc(size);
    if (!data) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the %zu bytes of %s", size, path);
    ff_status status = ff_crowd_save(crowd, data, size, error);
    if (status == FF_OK) status = ff_file_write_atomic(path, data, size, error);
    free(data);
    return status;
}
