/* nav_walls.h - static walls, and which of them are near. A complete binary tree of boxes over the walls in the order
 * they were added (walls come as chains, so neighbours in the list are neighbours in the plane). */
#ifndef FF_NAV_WALLS_H
#define FF_NAV_WALLS_H

#include "runtime/core/base/memory.h"
#include "runtime/core/nav/nav_time.h"

#define FF_NEAR_WALLS_MAX 16

typedef struct ff_box {
    ff_vec2 low, high;
} ff_box;

typedef struct ff_walls {
    ff_wall *wall;
    ff_box *box;     /* [2 * leaves], node 1 is the root, children of n are 2n and 2n + 1 */
    uint32_t leaves; /* power of two, at least capacity */
    uint32_t count, capacity;
} ff_walls;

size_t ff_walls_bytes(uint32_t capacity);
bool ff_walls_init(ff_walls *walls, uint32_t capacity, ff_arena *arena);
void ff_walls_add(ff_walls *walls, ff_vec2 from, ff_vec2 to); /* count < capacity */

/* The at most FF_NEAR_WALLS_MAX walls nearest to p that are within reach, nearest first, ties in order of adding. */
uint32_t ff_walls_near(const ff_walls *walls, ff_vec2 p, double reach, const ff_wall *out[FF_NEAR_WALLS_MAX]);

#endif
