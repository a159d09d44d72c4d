/* pack.h - a checked pack, as arrays of records in place. */
#ifndef FF_PACK_H
#define FF_PACK_H

#include "runtime/core/base/maths.h"
#include "runtime/core/pack/sections.h"

struct ff_pack {
    const unsigned char *data;
    size_t size;
    void *mapping; /* owned ff_file, or NULL when the memory is borrowed */

    const char *strings;
    uint64_t string_size;
    const char *meta; /* not terminated */
    uint64_t meta_size;
    const ff_pack_joint *joints;
    uint32_t joint_count;
    const ff_pack_point *points;
    uint32_t point_count;
    const ff_pack_stream *streams;
    uint32_t stream_count;
    const ff_pack_slots *slots; /* [stream_count] */
    uint32_t slots_count;
    const ff_pack_lanes *lanes;
    uint32_t lanes_count; /* blocks of eight */
    const unsigned char *keys;
    uint32_t key_bytes;
    const float (*roots)[3];
    uint32_t root_count;
    uint32_t frame_count; /* of all streams */
    const ff_pack_clip *clips;
    uint32_t clip_count;
    const ff_pack_plant *plants;
    uint32_t plant_count;
    const ff_pack_action *actions;
    uint32_t action_count;
    const ff_pack_collider *colliders;
    uint32_t collider_count;
    const float *collider_radii; /* [FF_COLLIDER_COUNT] m, NULL when the pack has none */
    uint32_t collider_radius_count;
    const ff_pack_example *examples;
    uint32_t example_count;
    const ff_pack_foot *feet;
    uint32_t foot_count;
    const ff_pack_simplex *simplices;
    uint32_t simplex_count;
    const ff_pack_point2 *hull;
    uint32_t hull_count;
    const ff_pack_track *tracks; /* NULL when the pack has none */
    uint32_t track_count;
    const ff_pack_loop *loops;
    uint32_t loop_count; /* example_count or 0 */
    const ff_pack_correspondence *correspondences;
    uint32_t correspondence_count;
    const ff_pack_pair *pairs;
    uint32_t pair_count;
    const ff_pack_gait *gait;
    uint32_t gait_count; /* 1 or 0 */
    const ff_pack_gait_path *gait_path;
    uint32_t gait_path_count; /* FF_GAIT_SAMPLES or 0, as gait_count */
    const ff_pack_sharp *sharp;
    uint32_t sharp_count;
    const ff_pack_event *events;
    uint32_t event_count;
    const ff_pack_skin *skins;
    uint32_t skin_count;
    const ff_pack_vertex *vertices;
    uint32_t vertex_count;
    const ff_pack_triangle *triangles;
    uint32_t triangle_count;
    const ff_pack_successor *successors;
    uint32_t successor_count;
    const ff_pack_reach *reach; /* NULL when the pack has none */
    uint32_t reach_count;
};

extern const ff_section_format ff_pack_file_format; /* pack.c */

static inline const char *ff_pack_string(const ff_pack *pack, uint32_t name)
{
    return pack->strings + name;
}

#endif
