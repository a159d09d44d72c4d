#include "runtime/core/pack/pack.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/pack/pack_check.h"

#include <stdlib.h>
#include <string.h>

enum {
    STRINGS,
    META,
    JOINTS,
    POINTS,
    STREAMS,
    SLOTS,
    LANES,
    KEYS,
    ROOTS,
    CLIPS,
    PLANTS,
    ACTIONS,
    COLLIDERS,
    COLLIDER_RADII,
    EXAMPLES,
    FEET,
    SIMPLICES,
    HULL,
    TRACKS,
    LOOPS,
    CORRESPONDENCES,
    PAIRS,
    GAIT,
    GAIT_PATH,
    SHARP,
    EVENTS,
    SUCCESSORS,
    REACH,
    SKINS,
    VERTICES,
    TRIANGLES,
    KIND_COUNT
};
_Static_assert(KIND_COUNT == FF_PACK_SECTION_COUNT, "a kind of section is missing here");

static const ff_section_kind kinds[KIND_COUNT] = {
    [STRINGS] = {FF_SECTION_STRINGS, 1, 1, 1},
    [META] = {FF_SECTION_META, 1, 0, 0},
    [JOINTS] = {FF_SECTION_JOINTS, sizeof(ff_pack_joint), 1, 1},
    [POINTS] = {FF_SECTION_POINTS, sizeof(ff_pack_point), FF_POINT_COUNT, 1},
    [STREAMS] = {FF_SECTION_STREAMS, sizeof(ff_pack_stream), 1, 1},
    [SLOTS] = {FF_SECTION_SLOTS, sizeof(ff_pack_slots), 1, 1},
    [LANES] = {FF_SECTION_LANES, sizeof(ff_pack_lanes), 1, 1},
    [KEYS] = {FF_SECTION_KEYS, 1, FF_STREAM_SLACK, 1},
    [ROOTS] = {FF_SECTION_ROOTS, 3 * sizeof(float), 0, 0},
    [CLIPS] = {FF_SECTION_CLIPS, sizeof(ff_pack_clip), 0, 0},
    [PLANTS] = {FF_SECTION_PLANTS, sizeof(ff_pack_plant), 0, 0},
    [ACTIONS] = {FF_SECTION_ACTIONS, sizeof(ff_pack_action), 0, 0},
    [COLLIDERS] = {FF_SECTION_COLLIDERS, sizeof(ff_pack_collider), 0, 0},
    [COLLIDER_RADII] = {FF_SECTION_COLLIDER_RADII, sizeof(float), 0, 0},
    [EXAMPLES] = {FF_SECTION_EXAMPLES, sizeof(ff_pack_example), 0, 0},
    [FEET] = {FF_SECTION_FEET, sizeof(ff_pack_foot), 0, 0},
    [SIMPLICES] = {FF_SECTION_SIMPLICES, sizeof(ff_pack_simplex), 0, 0},
    [HULL] = {FF_SECTION_HULL, sizeof(ff_pack_point2), 0, 0},
    [TRACKS] = {FF_SECTION_TRACKS, sizeof(ff_pack_track), 0, 0},
    [LOOPS] = {FF_SECTION_LOOPS, sizeof(ff_pack_loop), 0, 0},
    [CORRESPONDENCES] = {FF_SECTION_CORRESPONDENCES, sizeof(ff_pack_correspondence), 0, 0},
    [PAIRS] = {FF_SECTION_PAIRS, sizeof(ff_pack_pair), 0, 0},
    [GAIT] = {FF_SECTION_GAIT, sizeof(ff_pack_gait), 0, 0},
    [GAIT_PATH] = {FF_SECTION_GAIT_PATH, sizeof(ff_pack_gait_path), 0, 0},
    [SHARP] = {FF_SECTION_SHARP, sizeof(ff_pack_sharp), 0, 0},
    [EVENTS] = {FF_SECTION_EVENTS, sizeof(ff_pack_event), 0, 0},
    [SUCCESSORS] = {FF_SECTION_SUCCESSORS, sizeof(ff_pack_successor), 0, 0},
    [REACH] = {FF_SECTION_REACH, sizeof(ff_pack_reach), 0, 0},
    [SKINS] = {FF_SECTION_SKINS, sizeof(ff_pack_skin), 0, 0},
    [VERTICES] = {FF_SECTION_VERTICES, sizeof(ff_pack_vertex), 0, 0},
    [TRIANGLES] = {FF_SECTION_TRIANGLES, sizeof(ff_pack_triangle), 0, 0},
};

const ff_section_format ff_pack_file_format = {FF_PACK_MAGIC,
                                               FF_PACK_VERSION,
                                               kinds,
                                               KIND_COUNT,
                                               "motion pack",
                                               "FOOFPACK",
                                               "make one with footfall-pack build",
                                               "build the pack again",
                                               "build or copy the pack again"};

static void take_views(ff_pack *pack, const ff_section_view *views)
{
    pack->strings = (const char *)views[STRINGS].data;
    pack->string_size = views[STRINGS].count;
    pack->meta = (const char *)views[META].data;
    pack->meta_size = views[META].count;
    pack->joints = (const ff_pack_joint *)(const void *)views[JOINTS].data;
    pack->joint_count = (uint32_t)views[JOINTS].count;
    pack->points = (const ff_pack_point *)(const void *)views[POINTS].data;
    pack->point_count = (uint32_t)views[POINTS].count;
    pack->streams = (const ff_pack_stream *)(const void *)views[STREAMS].data;
    pack->stream_count = (uint32_t)views[STREAMS].count; /* at least 1 */
    const ff_pack_stream *last = &pack->streams[pack->stream_count - 1];
    pack->frame_count = last->first_frame + last->frame_count;
    pack->slots = (const ff_pack_slots *)(const void *)views[SLOTS].data;
    pack->slots_count = (uint32_t)views[SLOTS].count;
    pack->lanes = (const ff_pack_lanes *)(const void *)views[LANES].data;
    pack->lanes_count = (uint32_t)views[LANES].count;
    pack->keys = views[KEYS].data;
    pack->key_bytes = (uint32_t)views[KEYS].count;
    pack->roots = (const float(*)[3])(const void *)views[ROOTS].data;
    pack->root_count = (uint32_t)views[ROOTS].count;
    pack->clips = (const ff_pack_clip *)(const void *)views[CLIPS].data;
    pack->clip_count = (uint32_t)views[CLIPS].count;
    pack->plants = (const ff_pack_plant *)(const void *)views[PLANTS].data;
    pack->plant_count = (uint32_t)views[PLANTS].count;
    pack->actions = (const ff_pack_action *)(const void *)views[ACTIONS].data;
    pack->action_count = (uint32_t)views[ACTIONS].count;
    pack->colliders = (const ff_pack_collider *)(const void *)views[COLLIDERS].data;
    pack->collider_count = (uint32_t)views[COLLIDERS].count;
    pack->collider_radii = (const float *)(const void *)views[COLLIDER_RADII].data;
    pack->collider_radius_count = (uint32_t)views[COLLIDER_RADII].count;
    pack->examples = (const ff_pack_example *)(const void *)views[EXAMPLES].data;
    pack->example_count = (uint32_t)views[EXAMPLES].count;
    pack->feet = (const ff_pack_foot *)(const void *)views[FEET].data;
    pack->foot_count = (uint32_t)views[FEET].count;
    pack->simplices = (const ff_pack_simplex *)(const void *)views[SIMPLICES].data;
    pack->simplex_count = (uint32_t)views[SIMPLICES].count;
    pack->hull = (const ff_pack_point2 *)(const void *)views[HULL].data;
    pack->hull_count = (uint32_t)views[HULL].count;
    pack->tracks = (const ff_pack_track *)(const void *)views[TRACKS].data;
    pack->track_count = (uint32_t)views[TRACKS].count;
    pack->loops = (const ff_pack_loop *)(const void *)views[LOOPS].data;
    pack->loop_count = (uint32_t)views[LOOPS].count;
    pack->correspondences = (const ff_pack_correspondence *)(const void *)views[CORRESPONDENCES].data;
    pack->correspondence_count = (uint32_t)views[CORRESPONDENCES].count;
    pack->pairs = (const ff_pack_pair *)(const void *)views[PAIRS].data;
    pack->pair_count = (uint32_t)views[PAIRS].count;
    pack->gait = (const ff_pack_gait *)(const void *)views[GAIT].data;
    pack->gait_count = (uint32_t)views[GAIT].count;
    pack->gait_path = (const ff_pack_gait_path *)(const void *)views[GAIT_PATH].data;
    pack->gait_path_count = (uint32_t)views[GAIT_PATH].count;
    pack->sharp = (const ff_pack_sharp *)(const void *)views[SHARP].data;
    pack->sharp_count = (uint32_t)views[SHARP].count;
    pack->events = (const ff_pack_event *)(const void *)views[EVENTS].data;
    pack->event_count = (uint32_t)views[EVENTS].count;
    pack->successors = (const ff_pack_successor *)(const void *)views[SUCCESSORS].data;
    pack->successor_count = (uint32_t)views[SUCCESSORS].count;
    pack->reach = (const ff_pack_reach *)(const void *)views[REACH].data;
    pack->reach_count = (uint32_t)views[REACH].count;
    pack->skins = (const ff_pack_skin *)(const void *)views[SKINS].data;
    pack->skin_count = (uint32_t)views[SKINS].count;
    pack->vertices = (const ff_pack_vertex *)(const void *)views[VERTICES].data;
    pack->vertex_count = (uint32_t)views[VERTICES].count;
    pack->triangles = (const ff_pack_triangle *)(const void *)views[TRIANGLES].data;
    pack->triangle_count = (uint32_t)views[TRIANGLES].count;
}

static ff_status read_pack(ff_pack *pack, ff_error *error)
{
    ff_section_view views[KIND_COUNT];
    ff_status status = ff_sections_read(pack->data, pack->size, &ff_pack_file_format, views, error);
    if (status != FF_OK) return status;
    take_views(pack, views);
    return ff_pack_check(pack, error);
}

ff_status ff_pack_open_memory(const void *data, size_t size, ff_pack **out, ff_error *error)
{
    *out = NULL;
    if (!data) return ff_fail(error, FF_ERR_ARGUMENT, "no data given");
    if ((uintptr_t)data % FF_PACK_ALIGN != 0)
        return ff_fail(error, FF_ERR_ARGUMENT, "pack data must lie on a %u-byte boundary", FF_PACK_ALIGN);
    ff_pack *pack = ff_calloc(1, sizeof *pack);
    if (!pack) return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory opening a pack");
    pack->data = data;
    pack->size = size;
    ff_status status = read_pack(pack, error);
    if (status != FF_OK) {
        free(pack);
        return status;
    }
    *out = pack;
    return FF_OK;
}

ff_status ff_pack_open(const char *path, ff_pack **out, ff_error *error)
{
    *out = NULL;
    if (!path) return ff_fail(error, FF_ERR_ARGUMENT, "no path given");
    ff_file *file = ff_calloc(1, sizeof *file);
    if (!file) return ff_fail(error, FF_ERR_NO_MEMORY, "out of memory opening %s", path);
    ff_status status = ff_file_map(path, file, error);
    if (status == FF_OK && !file->mapped) {
        status = ff_fail_section(error, FF_ERR_PARSE, "header", 0, "the file is empty");
    } else if (status == FF_OK) {
        status = ff_pack_open_memory(file->data, file->size, out, error);
    }
    if (status != FF_OK) {
        ff_error_in_file(error, path);
        ff_file_unmap(file);
        free(file);
        return status;
    }
    (*out)->mapping = file;
    return FF_OK;
}

void ff_pack_close(ff_pack *pack)
{
    if (!pack) return;
    if (pack->mapping) {
        ff_file_unmap(pack->mapping);
        free(pack->mapping);
    }
    free(pack);
}

uint32_t ff_pack_joint_count(const ff_pack *pack)
{
    return pack->joint_count;
}

const char *ff_pack_joint_name(const ff_pack *pack, uint32_t joint)
{
    return joint < pack->joint_count ? ff_pack_string(pack, pack->joints[joint].name) : "";
}

int32_t ff_pack_joint_parent(const ff_pack *pack, uint32_t joint)
{
    return joint < pack->joint_count ? pack->joints[joint].parent : -1;
}

ff_vec3 ff_pack_joint_offset(const ff_pack *pack, uint32_t joint)
{
    if (joint >= pack->joint_count) return ff_v3(0.0, 0.0, 0.0);
    const float *offset = pack->joints[joint].offset;
    return ff_v3((double)offset[0], (double)offset[1], (double)offset[2]);
}
