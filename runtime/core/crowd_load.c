/* Going on from a crowd that was saved. */
#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/core/crowd_format.h"

#include <stdlib.h>
#include <string.h>

/* A file being read. Sections need not lie on any boundary in memory: everything is copied out. */
typedef struct loading {
    const ff_pack *pack;
    const unsigned char *data;
    ff_section_kind kinds[FF_SECTIONS_MAX];
    ff_section_view views[FF_SECTIONS_MAX];
    ff_saved_head head;
    ff_error *error;
} loading;

enum { HEAD, DEF, WALL, FIRST_ARRAY };

static uint64_t place(const loading *l, const void *at)
{
    return (uint64_t)((const unsigned char *)at - l->data);
}

static ff_status read_sections(loading *l, size_t size)
{
    uint32_t count = ff_crowd_section_kinds(l->kinds);
    ff_section_format format = ff_crowd_file_format(l->kinds, count);
    return ff_sections_read(l->data, size, &format, l->views, l->error);
}

static ff_status read_head(loading *l)
{
    memcpy(&l->head, l->views[HEAD].data, sizeof l->head);
    ff_pack_header pack;
    memcpy(&pack, l->pack->data, sizeof pack);
    if (l->head.pack_checksum != pack.checksum || l->head.pack_size != l->pack->size)
        return ff_fail_section(l->error, FF_ERR_ARGUMENT, "HEAD", place(l, l->views[HEAD].data),
                               "the crowd was saved with another motion pack (checksum %016llx, this one has "
                               "%016llx); load it with that one",
                               (unsigned long long)l->head.pack_checksum, (unsigned long long)pack.checksum);
    return FF_OK;
}

static ff_status read_def(loading *l, const ff_crowd_def *run, ff_crowd_def *def)
{
    ff_saved_def saved;
    memcpy(&saved, l->views[DEF].data, sizeof saved);
    if (!ff_crowd_def_unpack(&saved, def))
        return ff_fail_section(l->error, FF_ERR_PARSE, "CDEF", place(l, l->views[DEF].data),
                               "a switch or a choice of the crowd's definition is none that is known");
    if (run) {
        def->threads = run->threads;
        def->tasks = run->tasks;
        def->task_pool = run->task_pool;
    }
    return FF_OK;
}

/* Put a place on an error that was raised without one. */
static ff_status placed(const loading *l, ff_status status, const char *section, const void *at)
{
    if (status == FF_OK || !l->error || l->error->section[0]) return status;
    char message[sizeof l->error->message];
    memcpy(message, l->error->message, sizeof message);
    return ff_fail_section(l->error, status, section, place(l, at), "%s", message);
}

static ff_status read_walls(const loading *l, ff_crowd *crowd)
{
    const unsigned char *at = l->views[WALL].data;
    for (uint64_t i = 0; i < l->views[WALL].count; ++i, at += sizeof(ff_saved_wall)) {
        ff_saved_wall wall;
        memcpy(&wall, at, sizeof wall);
        ff_status status = ff_crowd_add_wall(crowd, wall.from, wall.to, l->error);
        if (status != FF_OK) return placed(l, status, "WALL", at);
    }
    return FF_OK;
}

static ff_status read_counts(const loading *l, ff_crowd *crowd)
{
    const ff_saved_head *head = &l->head;
    if (head->slot_count > crowd->def.max_agents || head->agent_count > head->slot_count)
        return ff_fail_section(l->error, FF_ERR_PARSE, "HEAD",
                               place(l, l->views[HEAD].data) + offsetof(ff_saved_head, agent_count),
                               "%u agents in %u slots of a crowd of at most %u", head->agent_count,
                               head->slot_count, crowd->def.max_agents);
    crowd->steps = head->steps;
    crowd->agent_count = head->agent_count;
    crowd->slot_count = head->slot_count;
    crowd->free_first = head->free_first;
    return FF_OK;
}

/* ----------------------------------------------------------------------------------------------- arrays */

static ff_status copy_array(const loading *l, const ff_crowd *crowd, const ff_crowd_array *array,
                            const ff_section_view *view)
{
    const unsigned char *at = view->data;
    for (uint32_t slot = 0; slot < crowd->slot_count; ++slot) {
        if (array->kind == FF_ARRAY_AGENT && !crowd->alive[slot]) continue;
        void *element = ff_crowd_array_element(crowd, array, slot);
        memcpy(element, at, array->size);
        size_t byte = 0;
        const char *wrong = array->check ? array->check(crowd, element, &byte) : NULL;
        if (wrong)
            return ff_fail_section(l->error, FF_ERR_PARSE, array->name, place(l, at) + byte, "%s", wrong);
        at += array->size;
    }
    return FF_OK;
}

static ff_status read_arrays(const loading *l, ff_crowd *crowd, ff_array_kind kind)
{
    uint32_t section = FIRST_ARRAY;
    for (uint32_t i = 0; i < ff_crowd_array_count(); ++i) {
        const ff_crowd_array *array = ff_crowd_array_at(i);
        if (array->kind == FF_ARRAY_STEP) continue;
        const ff_section_view *view = &l->views[section++];
        if (array->kind != kind) continue;
        uint64_t expected = kind == FF_ARRAY_SLOT ? crowd->slot_count : crowd->agent_count;
        if (!ff_crowd_array_element(crowd, array, 0)) expected = 0;
        if (view->count != expected)
            return ff_fail_section(l->error, FF_ERR_PARSE, array->name,
                                   view->present ? place(l, view->data) : 0, "%llu records, expected %llu",
                                   (unsigned long long)view->count, (unsigned long long)expected);
        ff_status status = expected > 0 ? copy_array(l, crowd, array, view) : FF_OK;
        if (status != FF_OK) return status;
    }
    return FF_OK;
}

/* As many live as are counted, and the list of free slots holds all the others, each once. */
static ff_status check_slots(const loading *l, const ff_crowd *crowd)
{
    uint32_t living = 0, listed = 0;
    for (uint32_t slot = 0; slot < crowd->slot_count; ++slot) {
        if (crowd->alive[slot] > 1)
            return ff_fail_section(l->error, FF_ERR_PARSE, "SLIV", 0, "slot %u is neither free nor taken",
                                   slot);
        living += crowd->alive[slot];
    }
    uint32_t free_count = crowd->slot_count - living, next = crowd->free_first;
    for (; next != 0 && listed < free_count; ++listed) {
        if (next > crowd->slot_count || crowd->alive[next - 1]) break;
        next = crowd->next_free[next - 1];
    }
    if (living != crowd->agent_count || next != 0 || listed != free_count)
        return ff_fail_section(l->error, FF_ERR_PARSE, "SFRE", 0,
                               "%u agents are counted and %u live; the list of free slots has %u of %u",
                               crowd->agent_count, living, listed, free_count);
    return FF_OK;
}

static ff_status read_crowd(loading *l, const ff_crowd_def *run, ff_crowd **out)
{
    ff_crowd_def def;
    ff_status status = read_head(l);
    if (status == FF_OK) status = read_def(l, run, &def);
    if (status != FF_OK) return status;
    status = placed(l, ff_crowd_create(l->pack, &def, out, l->error), "CDEF", l->views[DEF].data);
    if (status == FF_OK) status = read_walls(l, *out);
    if (status == FF_OK) status = read_counts(l, *out);
    if (status == FF_OK) status = read_arrays(l, *out, FF_ARRAY_SLOT);
    if (status == FF_OK) status = check_slots(l, *out);
    if (status == FF_OK) status = read_arrays(l, *out, FF_ARRAY_AGENT);
    return status;
}

ff_status ff_crowd_load(const ff_pack *pack, const void *data, size_t size, const ff_crowd_def *run,
                        ff_crowd **out, ff_error *error)
{
    if (!out) return ff_fail(error, FF_ERR_ARGUMENT, "nowhere to put the crowd");
    *out = NULL;
    if (!pack || !data) return ff_fail(error, FF_ERR_ARGUMENT, "a saved crowd needs its pack and its bytes");
    ff_error dummy = {0};
    loading l = {.pack = pack, .data = data, .error = error ? error : &dummy};
    *l.error = (ff_error){0};
    ff_status status = read_sections(&l, size);
    if (status == FF_OK) status = read_crowd(&l, run, out);
    if (status != FF_OK) {
        ff_crowd_destroy(*out);
        *out = NULL;
    }
    return status;
}

ff_status ff_crowd_load_file(const ff_pack *pack, const char *path, const ff_crowd_def *run, ff_crowd **out,
                             ff_error *error)
{
    if (!out || !path) return ff_fail(error, FF_ERR_ARGUMENT, "no file to load a crowd from");
    *out = NULL;
    ff_file file;
    ff_status status = ff_file_map(path, &file, error);
    if (status != FF_OK) return status;
    status = ff_crowd_load(pack, file.data, file.size, run, out, error);
    if (status != FF_OK) ff_error_in_file(error, path);
    ff_file_unmap(&file);
    return status;
}
