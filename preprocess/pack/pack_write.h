/* pack_write.h - the records of a motion pack, gathered in memory, to one file: same records, same bytes. */
#ifndef FF_PACK_WRITE_H
#define FF_PACK_WRITE_H

#include "runtime/core/base/memory.h"
#include "runtime/core/pack/pack_format.h"

/* One array of records per section (element types as pack_format.h says). Zero it to start, push records, write,
 * free. strings and meta are built by ff_pack_add_string and ff_pack_set_meta. */
typedef struct ff_pack_content {
    ff_array strings, meta, joints, points, streams, slots, lanes, keys, roots, clips, plants, actions,
        colliders, collider_radii, examples, feet, simplices, hull, tracks, loops, correspondences, pairs,
        gait, gait_path, sharp, events, successors, reach, skins, vertices, triangles;
    ff_array joins; /* ff_action_joins of each action, for ff_pack_add_successors; not written */
} ff_pack_content;

void ff_pack_content_free(ff_pack_content *content);

/* The place of text in STRS; the same text is stored once, "" and NULL are 0. UINT32_MAX = no memory. */
uint32_t ff_pack_add_string(ff_pack_content *content, const char *text);
ff_status ff_pack_set_meta(ff_pack_content *content, const char *json, ff_error *error);

/* Lay the content out as a whole pack, checksummed, padding zero. *data is 64-byte aligned; free() it. */
ff_status ff_pack_image(ff_pack_content *content, void **data, size_t *size, ff_error *error);

/* The same, into a file, all or nothing; size (may be NULL) receives its bytes. */
ff_status ff_pack_write(ff_pack_content *content, const char *path, size_t *size, ff_error *error);

#endif
