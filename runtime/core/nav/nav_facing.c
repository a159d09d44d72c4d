#include "runtime/core/nav/nav_facing.h"

#include "runtime/core/nav/nav_view.h"

#define STRAFE_TIME 1.0                 /* s, algorithms C.9 */
#define COOL_DOWN 1.0                   /* s after it, or the body would flip to and fro */
#define STRAFE_SINE 0.25881904510252076 /* 15 degrees between facing and way are side-stepping */
#define NEAR 0.05                       /* m: what is nearer has no direction */
#define BACK_SPEED 0.9                  /* m/s: faster than that people turn round */

/* FbCrowd 4.5. The paper calls it side-stepping when the product of facing and way is non-zero; meant is: not parallel. */
static ff_vec2 strafe(ff_vec2 wish, ff_vec2 way, double step, double *strafing)
{
    bool may = *strafing >= 0.0 && ff_dot2(wish, way) >= 0.0;
    ff_vec2 face = may ? wish : way;
    if (*strafing < 0.0)
        *strafing = ff_min(*strafing + step, 0.0);
    else if (fabs(ff_det2(face, way)) > STRAFE_SINE)
        *strafing = *strafing + step < STRAFE_TIME ? *strafing + step : -COOL_DOWN;
    else
        *strafing = 0.0;
    return face;
}

double ff_nav_facing(ff_facing_rule rule, ff_vec2 preferred, ff_vec2 command, double facing, double step,
                     double *strafing)
{
    ff_vec2 wish = ff_unit2(preferred), way = ff_unit2(command), face = way;
    double speed = ff_length2(command);
    if (speed < FF_COMMAND_STILL || (rule.rule == FF_FACING_PREFERRED && ff_dot2(wish, wish) > 0.5))
        face = wish;
    else if (rule.back_pedal && ff_dot2(wish, way) <= 0.0 && speed < BACK_SPEED && ff_dot2(wish, wish) > 0.5)
        face = wish;
    else if (rule.rule == FF_FACING_STRAFE && ff_dot2(wish, wish) > 0.5)
        face = strafe(wish, way, step, strafing);
    else if (rule.rule == FF_FACING_HALFWAY && ff_dot2(wish, way) > 0.0)
        face = ff_add2(wish, way);
    /* Pushed aside by somebody: with the command faced he would have turned his back to the goal when the way is free again
     * (unlike in the study). */
    else if (rule.rule == FF_FACING_HALFWAY && speed < BACK_SPEED && ff_dot2(wish, wish) > 0.5)
        face = wish;
    return ff_dot2(face, face) > 0.0 ? ff_atan2(face.b, face.a) : facing;
}

double ff_nav_face(uint32_t face, ff_vec2 at, ff_vec2 position, double facing)
{
    ff_vec2 way = face == FF_FACE_POINT ? ff_sub2(at, position) : at;
    bool somewhere = face != FF_FACE_FREE && ff_dot2(way, way) > NEAR * NEAR;
    return somewhere ? ff_atan2(way.b, way.a) : facing;
}
