/* body_shape.h - a person's body as tapered capsules about the bones of a figure in its rest pose, and the smooth
 * solid they make together. */
#ifndef FF_BODY_SHAPE_H
#define FF_BODY_SHAPE_H

#include "runtime/export/figure.h"

/* What a part of the surface is covered with. */
typedef enum ff_cover {
    FF_COVER_SKIN,
    FF_COVER_HAIR,
    FF_COVER_SHIRT,
    FF_COVER_TROUSERS,
    FF_COVER_SHOES,
    FF_COVER_COUNT
} ff_cover;

typedef struct ff_limb {
    ff_vec3 a, b;              /* m, ends of the axis, rest pose */
    double radius_a, radius_b; /* m */
    double smooth;             /* m, width over which it flows into the limbs before it */
    uint32_t joint;            /* moves with this joint */
    ff_cover cover;
} ff_limb;

#define FF_BODY_MAX_LIMBS 64

typedef struct ff_body_shape {
    ff_limb limbs[FF_BODY_MAX_LIMBS];
    uint32_t count;
    double scale; /* of the figure, 1 = hips at 0.95 m */
} ff_body_shape;

void ff_body_shape_make(const ff_figure *figure, ff_body_shape *out);

/* Signed distance to one limb (a leg only on its side of the middle), and to the whole body (soles cut flat at y = 0); negative
 * inside. */
double ff_limb_distance(const ff_body_shape *shape, const ff_limb *limb, ff_vec3 point);
double ff_body_distance(const ff_body_shape *shape, ff_vec3 point);

#endif
