/* look.h - what each agent wears and stands on, the same in every file, so that one can be followed from picture to
 * picture. */
#ifndef FF_LOOK_H
#define FF_LOOK_H

#include "runtime/export/body_shape.h"
#include "runtime/export/picture.h"
#include "runtime/export/scene.h"

typedef struct ff_look {
    ff_colour cover[FF_COVER_COUNT];
} ff_look;

/* Shirts tell groups apart (on the circle and in custom scenes: agents). */
ff_look ff_look_of(const ff_scene *scene, uint32_t agent);

/* Side of the tiles of a ground of so many metres: 1 m, or 10, 100 ... where there would be too many of them. */
double ff_ground_tile(double width, double depth);

/* Outline of a place on the ground, counter-clockwise; a disc has eight corners, a point none. Returns how many. */
#define FF_OUTLINE_MOST 8
uint32_t ff_region_outline(const ff_region *region, ff_vec2 out[FF_OUTLINE_MOST]);

#endif
