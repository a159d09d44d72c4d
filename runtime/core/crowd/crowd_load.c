/* Going on from a crowd that was saved. */
#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/core/crowd/crowd_behave.h"
#include "runtime/core/crowd/crowd_format.h"

#include <stdlib.h>
#include <string.h>

/* A file being read. Sections need not lie on any boundary in memory: everything is copied out. */
typedef struct loading {
    const ff_pack *pack;
    const unsigned char *data;
    ff_section_kind kinds[FF_SECTIONS_MAX];
    ff_section_view views[FF_SECTIONS_MAX];
    ff_saved_head head;
    ff_behaviour_def behaviour;
    void *block; /* of its arrays */
    ff_error *error;
} loading;

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
    memcpy(&l->head, l->views[FF_SAVED_HEAD].data, sizeof l->head);
    ff_pack_header pack;
    memcpy(&pack, l->pack->data, sizeof pack);
    if (l->head.pack_checksum != pack.checksum || l->head.pack_size != l->pack->size)
        return ff_fail_section(l->error, FF_ERR_ARGUMENT, "HEAD", place(l, l->views[FF_SAVED_HEAD].data),
                               "the crowd was saved with another motion pack (checksum %016llx, this one has "
                               "%016llx); load it with that one",
                               (unsigned long long)l->head.pack_checksum, (unsigned long long)pack.checksum);
    return FF_OK;
}

/* The arrays of the definition, side by side in a block; ff_crowd_create checks them. */
static ff_status read_behaviour(loading *l)
{
    size_t bytes = 0;
    const ff_section_view *views = &l->views[FF_SAVED_BEHAVIOUR];
    for (uint32_t i = 0; i < FF_BEHAVIOUR_ARRAYS; ++i)
        bytes += views[i].count * ff_behaviour_arrays[i].size;
    unsigned char *at = l->block = ff_calloc(bytes, 1);
    if (!at) return ff_fail(l->error, FF_ERR_NO_MEMORY, "a behaviour of %zu bytes", bytes);
    for (uint32_t i = 0; i < FF_BEHAVIOUR_ARRAYS; ++i) {
        size_t size = views[i].count * ff_behaviour_arrays[i].size;
        if (size > 0) memcpy(at, views[i].data, size);
        ff_behaviour_array_set(&l->behaviour, &ff_behaviour_arrays[i], at, (uint32_t)views[i].count);
        at += size;
    }
    return FF_OK;
}

static ff_status read_def(loading *l, const ff_crowd_def *run, ff_crowd_def *def)
{
    ff_saved_def saved;
    memcpy(&saved, l->views[FF_SAVED_DEF].data, sizeof saved);
    if (!ff_crowd_def_unpack(&saved, def))
        return ff_fail_section(l->error, FF_ERR_PARSE, "CDEF", place(l, l->views[FF_SAVED_DEF].data),
                               "a switch or a choice of the crowd's definition is none that is known");
    if (saved.behaviour) {
        ff_status status = read_behaviour(l);
        if (status != FF_OK) return status;
        def->behaviour = &l->behaviour;
    }
    if (run) {
        def->threads = run->threads;
        def->tasks = run->tasks;
        def->task_pool = run->task_pool;
        def->waypoint = run->waypoint;
        def->waypoint_context = run->waypoint_context;
    }
    return FF_OK;
}

/* Put a place on an error that was raised without one, or with one in an array of the behaviour. */
static ff_status placed(const loading *l, ff_status status, const char *section, const void *at)
{
    if (status == FF_OK) return status;
    uint64_t byte = place(l, at);
    for (uint32_t i = 0; i < FF_BEHAVIOUR_ARRAYS; ++i) {
        if (strcmp(l->error->section, ff_behaviour_arrays[i].name) != 0) continue;
        section = ff_behaviour_arrays[i].name;
        byte = place(l, l->views[FF_SAVED_BEHAVIOUR + i].data) + l->error->byte_offset;
    }
    char message[sizeof l->error->message];
    memcpy(message, l->error->message, sizeof message);
    return ff_fail_section(l->error, status, section, byte, "%s", message);
}

/* Is the wall one of those that velocity navigation has of a static obstacle? */
static bool of_obstacle(const ff_crowd *crowd, uint64_t wall)
{
    for (uint32_t i = 0; i < crowd->obstacle_count; ++i) {
        const ff_crowd_obstacle *obstacle = &crowd->obstacles[i];
        if (obstacle->kind == FF_OBSTACLE_STATIC && wall - obstacle->first_wall < obstacle->wall_count)
            return true;
    }
    return false;
}

static ff_status read_obstacles(const loading *l, ff_crowd *crowd)
{
    const unsigned char *at = l->views[FF_SAVED_OBSTACLES].data;
    for (uint64_t i = 0; i < l->views[FF_SAVED_OBSTACLES].count; ++i, at += sizeof(ff_crowd_obstacle)) {
        ff_crowd_obstacle obstacle;
        memcpy(&obstacle, at, sizeof obstacle);
        const char *wrong = ff_obstacle_restore(crowd, &obstacle);
        if (wrong) return ff_fail_section(l->error, FF_ERR_PARSE, "OBST", place(l, at), "%s", wrong);
    }
    return FF_OK;
}

static ff_status read_walls(const loading *l, ff_crowd *crowd)
{
    const unsigned char *at = l->views[FF_SAVED_WALLS].data;
    for (uint64_t i = 0; i < l->views[FF_SAVED_WALLS].count; ++i, at += sizeof(ff_saved_wall)) {
        ff_saved_wall wall;
        memcpy(&wall, at, sizeof wall);
        ff_status status = ff_crowd_put_wall(crowd, wall.from, wall.to, of_obstacle(crowd, i), l->error);
        if (status != FF_OK) return placed(l, status, "WALL", at);
    }
    return FF_OK;
}

static ff_status read_counts(const loading *l, ff_crowd *crowd)
{
    const ff_saved_head *head = &l->head;
    if (head->slot_count > crowd->def.max_agents || head->agent_count > head->slot_count)
        return ff_fail_section(l->error, FF_ERR_PARSE, "HEAD",
                               place(l, l->views[FF_SAVED_HEAD].data) + offsetof(ff_saved_head, agent_count),
                               "%u agents in %u slots of a crowd of at most %u", head->agent_count,
                               head->slot_count, crowd->def.max_agents);
    crowd->steps = head->steps;
    crowd->agent_count = head->agent_count;
    crowd->slot_count = head->slot_count;
    crowd->free_first = head->free_first;
    crowd->added = head->added;
    crowd->spawned = head->spawned;
    crowd->left = head->left;
    return FF_OK;
}

static const char *wrong_spawning(const ff_spawning *spawning)
{
    return spawning->due >= 0.0 && spawning->due <= 1001.0 ? NULL : "a spawner is late by no number";
}

/* What all agents share. */
static ff_status read_shared(const loading *l, ff_crowd *crowd)
{
    const ff_section_view *spawning = &l->views[FF_SAVED_SPAWNING], *shown = &l->views[FF_SAVED_SHOWN];
    ff_behaviour *behaviour = crowd->behaviour;
    uint32_t spawners = behaviour ? behaviour->def.spawner_count : 0;
    uint32_t signals = behaviour ? behaviour->def.signal_count : 0;
    if (spawning->count != spawners || shown->count != signals)
        return ff_fail_section(l->error, FF_ERR_PARSE, "HEAD", place(l, l->views[FF_SAVED_HEAD].data),
                               "%llu spawners and %llu signals, expected %u and %u",
                               (unsigned long long)spawning->count, (unsigned long long)shown->count,
                               spawners, signals);
    if (!behaviour) return FF_OK;
    for (uint32_t i = 0; i < spawners; ++i) {
        const unsigned char *at = spawning->data + i * sizeof *behaviour->spawning;
        memcpy(&behaviour->spawning[i], at, sizeof *behaviour->spawning);
        behaviour->spawning[i].alive = 0; /* counted when the agents are there */
        const char *wrong = wrong_spawning(&behaviour->spawning[i]);
        if (wrong) return ff_fail_section(l->error, FF_ERR_PARSE, "SPWN", place(l, at), "%s", wrong);
    }
    for (uint32_t i = 0; i < signals; ++i) {
        const unsigned char *at = shown->data + i * sizeof *behaviour->shown;
        memcpy(&behaviour->shown[i], at, sizeof *behaviour->shown);
        if (behaviour->shown[i] != FF_NONE && behaviour->shown[i] >= behaviour->def.signals[i].phase_count)
            return ff_fail_section(l->error, FF_ERR_PARSE, "SHOW", place(l, at),
                                   "a signal is made to show a phase that it has not");
    }
    behaviour->fault = l->head.fault;
    if (behaviour->fault.number != FF_NONE && behaviour->fault.state >= behaviour->def.state_count)
        return ff_fail_section(l->error, FF_ERR_PARSE, "HEAD",
                               place(l, l->views[FF_SAVED_HEAD].data) + offsetof(ff_saved_head, fault),
                               "a fault in a state that is none");
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
    uint32_t section = FF_SAVED_ARRAYS;
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
    status = placed(l, ff_crowd_create(l->pack, &def, out, l->error), "CDEF", l->views[FF_SAVED_DEF].data);
    if (status == FF_OK) status = read_obstacles(l, *out);
    if (status == FF_OK) status = read_walls(l, *out);
    if (status == FF_OK) status = read_counts(l, *out);
    if (status == FF_OK) status = read_shared(l, *out);
    if (status == FF_OK) status = read_arrays(l, *out, FF_ARRAY_SLOT);
    if (status == FF_OK) status = check_slots(l, *out);
    if (status == FF_OK) status = read_arrays(l, *out, FF_ARRAY_AGENT);
    if (status == FF_OK && (*out)->behaviour) ff_crowd_behave_recount(*out);
    if (status == FF_OK) ff_footsteps_restore(*out);
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
    free(l.block);
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
