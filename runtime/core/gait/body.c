#include "runtime/core/gait/body.h"

#define SUBSTEP (1.0 / 60.0) /* s, whatever the crowd's step */
#define FACING_TIME 0.4      /* s, in which a facing error would be turned off */
#define TURN_MAX 2.5         /* rad/s */
#define TURN_LAG 0.15        /* s */
#define FACING_SLACK 0.02    /* rad, that one who stands leaves */
#define IDLE 0.08            /* m/s: a command below it means to stand */
#define LAG 0.3              /* s */
#define PLANT_PART 0.4       /* of a step, round the plant, in which most of a change of velocity happens */
#define PLANT_GAIN 2.0
#define SWING_GAIN (1.0 / 3.0)
#define BRAKE_GAIN 1.0 /* in swing, for slowing down: a step can be cut short */
#define CHANGE_MAX 4.0 /* m/s^2 */
#define STEP_TIME 0.5  /* s */
#define SNAP 0.03      /* m/s, under which one who wants to stand does */
#define SNAP_TURN 0.02 /* rad/s */
#define WALL_TIME 0.1  /* s, in which a wall may be reached at most */

ff_vec2 ff_body_velocity(const ff_body *body)
{
    return ff_from_frame2(ff_fwd2(body->heading), ff_v2(body->rates.forward, body->rates.left));
}

static ff_rates target_rates(const ff_body *body, ff_vec2 command, double facing,
                             const ff_body_limits *limits)
{
    bool idle = ff_dot2(command, command) < IDLE * IDLE;
    ff_vec2 local = idle ? ff_v2(0.0, 0.0) : ff_to_frame2(ff_fwd2(body->heading), command);
    if (!limits->back_pedal) local.a = ff_max(local.a, 0.0);
    double error = ff_wrap(facing - body->heading);
    if (idle && fabs(error) < FACING_SLACK) error = 0.0;
    double turn = ff_clamp(error / FACING_TIME, -TURN_MAX, TURN_MAX);
    return limits->clamp(limits->context, (ff_rates){local.a, local.b, turn});
}

/* First-order response, quick round the plants and slow in swing, limited in acceleration. */
static void respond(ff_body *body, ff_rates target, double dt)
{
    ff_vec2 u = ff_v2(body->rates.forward, body->rates.left), wanted = ff_v2(target.forward, target.left);
    double swing = ff_dot2(wanted, wanted) < ff_dot2(u, u) ? BRAKE_GAIN : SWING_GAIN;
    double gain = body->phase < PLANT_PART ? PLANT_GAIN : swing;
    ff_vec2 change = ff_scale2(ff_sub2(ff_v2(target.forward, target.left), u), gain / LAG);
    double size = ff_length2(change);
    if (size > CHANGE_MAX) change = ff_scale2(change, CHANGE_MAX / size);
    u = ff_madd2(u, change, dt);
    double turn = body->rates.turn + (target.turn - body->rates.turn) * ff_min(dt / TURN_LAG, 1.0);
    if (target.forward == 0.0 && target.left == 0.0) {
        if (ff_dot2(u, u) < SNAP * SNAP) u = ff_v2(0.0, 0.0);
        if (target.turn == 0.0 && fabs(turn) < SNAP_TURN) turn = 0.0;
    }
    body->rates = (ff_rates){u.a, u.b, turn};
}

/* How much of the way towards this wall is too fast: the speed to take off, and the direction off the wall. */
static double too_fast(const ff_wall *wall, ff_vec2 p, ff_vec2 v, double radius, ff_vec2 *off)
{
    ff_vec2 away = ff_sub2(p, ff_wall_nearest(wall, p));
    double distance = ff_length2(away);
    *off = ff_unit2(away);
    if (!(distance > 1e-9)) return 0.0;
    return -ff_dot2(v, *off) - ff_max(distance - radius, 0.0) / WALL_TIME;
}

/* Slide along walls that the lag would carry us into; if the examples cannot slide so, slow down. The distance to a
 * wall is convex along a straight way, so what is right at its start is safe to its end: no wall is ever crossed. */
static void keep_off_walls(ff_body *body, double middle_heading, const ff_body_limits *limits)
{
    ff_vec2 frame = ff_fwd2(middle_heading), off;
    ff_vec2 v = ff_from_frame2(frame, ff_v2(body->rates.forward, body->rates.left)), before = v;
    for (uint32_t i = 0; i < limits->wall_count; ++i) {
        double excess = too_fast(limits->walls[i], body->position, v, limits->radius, &off);
        if (excess > 0.0) v = ff_madd2(v, off, excess);
    }
    if (v.a == before.a && v.b == before.b) return;
    ff_vec2 local = ff_to_frame2(frame, v);
    ff_rates slid = limits->clamp(limits->context, (ff_rates){local.a, local.b, body->rates.turn});
    v = ff_from_frame2(frame, ff_v2(slid.forward, slid.left));
    double scale = 1.0;
    for (uint32_t i = 0; i < limits->wall_count; ++i) {
        double excess = too_fast(limits->walls[i], body->position, v, limits->radius, &off);
        double approach = -ff_dot2(v, off);
        if (excess > 0.0 && approach > 0.0) scale = ff_min(scale, (approach - excess) / approach);
    }
    body->rates = (ff_rates){slid.forward * scale, slid.left * scale, body->rates.turn};
}

static void move(ff_body *body, double dt, const ff_body_limits *limits)
{
    double middle = body->heading + 0.5 * body->rates.turn * dt;
    if (limits->wall_count > 0) keep_off_walls(body, middle, limits);
    ff_vec2 v = ff_from_frame2(ff_fwd2(middle), ff_v2(body->rates.forward, body->rates.left));
    body->position = ff_madd2(body->position, v, dt);
    body->heading = ff_wrap(body->heading + body->rates.turn * dt);
    body->phase += dt / STEP_TIME;
    body->phase -= floor(body->phase);
}

ff_rates ff_body_step(ff_body *body, ff_vec2 command, double facing, double dt, const ff_body_limits *limits)
{
    uint32_t count = (uint32_t)ff_max(1.0, ceil(dt / SUBSTEP - 1e-9));
    double part = dt / (double)count;
    ff_rates sum = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < count; ++i) {
        respond(body, target_rates(body, command, facing, limits), part);
        move(body, part, limits);
        sum = (ff_rates){sum.forward + body->rates.forward, sum.left + body->rates.left,
                         sum.turn + body->rates.turn};
    }
    double share = 1.0 / (double)count;
    return (ff_rates){sum.forward * share, sum.left * share, sum.turn * share};
}
