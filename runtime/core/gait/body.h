/* body.h - the root: a body that follows commands with the lag of legs (navigation study, section 1).
 *
 * Navigation asks for a velocity and a facing; the body moves its own frame's rates towards them no faster than people
 * do, mostly round the plants, and only to rates that the walking examples can make. The root moves by exactly those
 * rates, and root and disc are one, so nothing is left to slide.
 */
#ifndef FF_BODY_H
#define FF_BODY_H

#include "runtime/core/gait/synth.h"
#include "runtime/core/nav/nav_walls.h"

/* Hashed as bytes: no padding. */
typedef struct ff_body {
    ff_vec2 position; /* m */
    double heading;   /* rad, in (-pi, pi] */
    ff_rates rates;   /* now */
    double phase;     /* of a step, [0, 1): 0 = a foot has just come down */
} ff_body;

/* The rates nearest to target that can be walked (ff_blend_clamp, or a box in tests). */
typedef ff_rates ff_rates_clamp(const void *context, ff_rates target);

typedef struct ff_body_limits {
    ff_rates_clamp *clamp;
    const void *context;
    const ff_wall *const *walls; /* those near the body */
    uint32_t wall_count;
    double radius;   /* m, that is kept off the walls */
    bool back_pedal; /* else a command to go backwards only slows down, until the body has turned round */
} ff_body_limits;

/* The velocity of the root in the plane. */
ff_vec2 ff_body_velocity(const ff_body *body);

/* Move for dt seconds. Returns the mean rates, for synthesis. */
ff_rates ff_body_step(ff_body *body, ff_vec2 command, double facing, double dt, const ff_body_limits *limits);

#endif
