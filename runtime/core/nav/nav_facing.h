/* nav_facing.h - where the body shall face while it is asked for a velocity (FbCrowd 4.5; navigation study 4, 7). */
#ifndef FF_NAV_FACING_H
#define FF_NAV_FACING_H

#include "runtime/core/base/maths.h"

typedef struct ff_facing_rule {
    ff_facing rule;
    bool back_pedal; /* facing the goal while being pushed back from it */
} ff_facing_rule;

/* The heading to turn to; facing is the last one, kept when nothing has a direction. *strafing is remembered: s of
 * side-stepping so far, or, negative, s until it is allowed again. */
double ff_nav_facing(ff_facing_rule rule, ff_vec2 preferred, ff_vec2 command, double facing, double step,
                     double *strafing);

/* Where one who stands shall look (FF_FACE_*): the heading to a point or of a direction; facing, when there is none. */
double ff_nav_face(uint32_t face, ff_vec2 at, ff_vec2 position, double facing);

#endif
