/* pack_check.h - is what the sections of a pack say usable? After this nothing has to check again. */
#ifndef FF_PACK_CHECK_H
#define FF_PACK_CHECK_H

#include "runtime/core/pack/pack.h"

/* The section views of pack are set and lie inside the file. Checks every index, count, name, order and number. */
ff_status ff_pack_check(const ff_pack *pack, ff_error *error);

/* Streams with their lanes, keys, roots and references (pack_check_streams.c). */
ff_status ff_pack_check_streams(const ff_pack *pack, ff_error *error);

/* Clips, plants, actions and colliders (pack_check_clips.c). */
ff_status ff_pack_check_clips(const ff_pack *pack, ff_error *error);

/* Loops, correspondences, the semi-procedural clip and sharp turns (pack_check_gait.c). */
ff_status ff_pack_check_gait(const ff_pack *pack, ff_error *error);

/* Levels of detail, vertices and triangles (pack_check_skin.c). */
ff_status ff_pack_check_skin(const ff_pack *pack, ff_error *error);

/* Fail with FF_ERR_PARSE at the byte that `at` points to. */
#define FF_PACK_REFUSE(section, at, ...)                                                                     \
    ff_fail_section(error, FF_ERR_PARSE, section, (uint64_t)((const unsigned char *)(at)-pack->data),        \
                    __VA_ARGS__)

/* The first of count floats that is not a number or beyond +-limit, or NULL. */
static inline const float *ff_pack_wild_float(const float *values, size_t count, float limit)
{
    for (size_t i = 0; i < count; ++i)
        if (!(values[i] >= -limit && values[i] <= limit)) return &values[i];
    return NULL;
}

/* first + count <= total without overflow. */
static inline bool ff_pack_range_fits(uint32_t first, uint64_t count, uint32_t total)
{
    return count <= total && first <= total - count;
}

#endif
