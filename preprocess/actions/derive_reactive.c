#include "preprocess/actions/derive_reactive.h"

#include "preprocess/actions/derive_body.h"
#include "runtime/core/pack/pack_format.h"

#include <string.h>

static const double GRAVITY = 9.81; /* m/s2 */
/* Of a jump: s to go down, to push off, in the air, to land, to get up; m of the hips. */
static const double PREPARE = 0.30, PUSH = 0.17, FLIGHT = 0.55, ABSORB = 0.18, RECOVER = 0.40;
static const double LOW = -0.14, OFF = 0.07; /* m: before the push, as the toes leave */
static const double TUCK = 0.27;             /* m, by which the feet are drawn up */
static const double TIPTOE = 0.55;           /* rad, of the feet as they leave */
static const double FORWARD = 0.9;           /* m, of the one forward */
static const double BEND = 0.35;             /* of a duck's trunk, before the push and after landing */
static const double ARMS_BACK = 0.7, ARMS_UP = -1.6; /* rad, of the shoulders */
/* Of a leap: s, m. */
static const double LEAP = 0.90, LEAP_OFF = 0.32, LEAP_FLIGHT = 0.40, LEAP_BEHIND = 0.84;
static const double LEAP_MORE = 0.75, LEAP_LIFT = 0.50, LEAP_LOW = -0.05, LEAP_HIGH = 0.04;

/* 0 to 1 and back, over half of the time near 1. */
static double plateau(double s)
{
    double up = ff_sin(FF_PI * ff_clamp(s, 0.0, 1.0));
    return up * up * (2.0 - up * up);
}

static double gone(double time, double from, double to)
{
    return ff_smooth((time - from) / (to - from));
}

static void turn(ff_derive_body *b, int role, double angle)
{
    b->local[role] = ff_quat_mul(ff_quat_axis(ff_v3(1.0, 0.0, 0.0), angle), b->local[role]);
}

/* A foot turned with its toes down. */
static void point_toes(ff_foot_target *foot, double angle)
{
    foot->rotation = ff_quat_mul(foot->rotation, ff_quat_axis(ff_v3(1.0, 0.0, 0.0), angle));
}

/* -------------------------------------------------------------------------------------- from standing to standing */

/* When a jump does what, s. */
typedef struct jump_times {
    double begin, push, off, land, low, end;
} jump_times;

static jump_times times_of_jump(void)
{
    double begin = FF_DERIVE_STANDS, push = begin + PREPARE, off = push + PUSH, land = off + FLIGHT;
    return (jump_times){begin, push, off, land, land + ABSORB, land + ABSORB + RECOVER};
}

/* m, of the hips over their height in standing: a throw between two presses. */
static double jump_height(const jump_times *at, double time)
{
    double speed = 0.5 * GRAVITY * FLIGHT, t = time - at->off;
    if (time < at->push) return LOW * gone(time, at->begin, at->push);
    if (time < at->off) return ff_derive_hermite(LOW, 0.0, OFF, speed, time - at->push, PUSH);
    if (time < at->land) return OFF + speed * t - 0.5 * GRAVITY * t * t;
    if (time < at->low) return ff_derive_hermite(OFF, -speed, LOW, 0.0, time - at->land, ABSORB);
    return LOW * (1.0 - gone(time, at->low, at->end));
}

/* How far the trunk is bent, as a share of a duck's. */
static double jump_bend(const jump_times *at, double time)
{
    if (time < at->push) return BEND * gone(time, at->begin, at->push);
    if (time < at->off) return BEND * (1.0 - gone(time, at->push, at->off));
    double middle = 0.5 * (at->off + at->land);
    if (time < middle) return 0.0;
    if (time < at->low) return BEND * gone(time, middle, at->low);
    return BEND * (1.0 - gone(time, at->low, at->end));
}

static void jump_arms(const jump_times *at, double time, ff_derive_body *b)
{
    double back = gone(time, at->begin, at->push) - gone(time, at->push, at->off + 0.05);
    double up = gone(time, at->push, at->off + 0.1) - gone(time, at->off + 0.5 * FLIGHT, at->end);
    turn(b, FF_ROLE_SHOULDER_L, ARMS_BACK * back + ARMS_UP * up);
    turn(b, FF_ROLE_SHOULDER_R, ARMS_BACK * back + ARMS_UP * up);
    turn(b, FF_ROLE_ELBOW_L, -0.5 * up);
    turn(b, FF_ROLE_ELBOW_R, -0.5 * up);
}

static void jump_feet(const jump_times *at, double time, const ff_derive_body *after, ff_derive_body *b)
{
    double s = ff_clamp((time - at->off) / FLIGHT, 0.0, 1.0);
    double tip = TIPTOE * (gone(time, at->off - 0.12, at->off) - 0.7 * gone(time, at->off, at->off + 0.2) -
                           0.3 * gone(time, at->land - 0.02, at->land + 0.09));
    double high = time > at->off && time < at->land ? jump_height(at, time) - OFF : 0.0;
    for (int foot = 0; foot < 2; ++foot) {
        b->feet[foot].ball = ff_lerp3(b->feet[foot].ball, after->feet[foot].ball, s);
        b->feet[foot].ball.y += high + TUCK * plateau(s);
        point_toes(&b->feet[foot], tip);
    }
}

static ff_status derive_jump(const ff_derive_base *base, double forward, ff_motion *out,
                             ff_reactive_times *times, ff_error *error)
{
    const jump_times at = times_of_jump();
    double whole = at.end + FF_DERIVE_STANDS;
    *times = (ff_reactive_times){.plant = {{FF_LEFT, 0.0, at.off},
                                           {FF_RIGHT, 0.0, at.off},
                                           {FF_LEFT, at.land, INFINITY},
                                           {FF_RIGHT, at.land, INFINITY}},
                                 .plant_count = 4,
                                 .first = at.begin,
                                 .last = at.end,
                                 .support = FF_LEFT,
                                 .mode = FF_MODE_JUMP,
                                 .flags = FF_ACTION_FROM_STANDING | FF_ACTION_TO_STANDING | FF_ACTION_WHOLE};
    ff_status status = ff_motion_alloc(out, ff_derive_frames(whole), 1.0 / FF_DERIVE_RATE, error);
    ff_derive_body before = ff_derive_stand_body(base, ff_v3(0.0, 0.0, 0.0));
    ff_derive_body after = ff_derive_stand_body(base, ff_v3(forward, 0.0, 0.0));
    for (int k = 0; status == FF_OK && k < out->frame_count; ++k) {
        double time = k / FF_DERIVE_RATE;
        ff_derive_body b = before;
        b.root.x = forward * gone(time, at.push, at.low);
        jump_feet(&at, time, &after, &b);
        ff_derive_crouch(base->rig, jump_bend(&at, time), &b);
        b.hips.z = before.hips.z + jump_height(&at, time);
        jump_arms(&at, time, &b);
        ff_derive_put_frame(base->rig, &b, k, out);
    }
    return status;
}

static ff_status derive_duck(const ff_derive_base *base, ff_motion *out, ff_reactive_times *times,
                             ff_error *error)
{
    double begin = FF_DERIVE_STANDS, end = begin + FF_DERIVE_DUCK;
    *times = (ff_reactive_times){.plant = {{FF_LEFT, 0.0, INFINITY}, {FF_RIGHT, 0.0, INFINITY}},
                                 .plant_count = 2,
                                 .first = begin,
                                 .last = end,
                                 .support = FF_LEFT,
                                 .mode = FF_MODE_CROUCH,
                                 .flags = FF_ACTION_FROM_STANDING | FF_ACTION_TO_STANDING};
    ff_status status =
        ff_motion_alloc(out, ff_derive_frames(end + FF_DERIVE_STANDS), 1.0 / FF_DERIVE_RATE, error);
    ff_derive_body stand = ff_derive_stand_body(base, ff_v3(0.0, 0.0, 0.0));
    for (int k = 0; status == FF_OK && k < out->frame_count; ++k) {
        ff_derive_body b = stand;
        ff_derive_crouch(base->rig, ff_derive_ducked(k / FF_DERIVE_RATE - begin), &b);
        ff_derive_put_frame(base->rig, &b, k, out);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------ out of a walk */

/* The walk's events on the way from the whole right foot on the ground to the whole left one, as phases counted on. */
typedef struct walk_events {
    double period, speed;
    double right_full, left_off, left_full;
} walk_events;

static walk_events events_of(const ff_derive_base *base)
{
    const ff_pack_example *r = &base->walk->record;
    walk_events w = {.period = (double)r->period, .speed = (double)r->v_forward};
    w.right_full = (double)r->key[2] + FF_DERIVE_FULL;
    w.left_off = ff_max((double)r->key[3], w.right_full + 0.05);
    w.left_full = 1.0 + FF_DERIVE_FULL;
    return w;
}

/* The walk at a phase, its root where it has the feet stand still. */
static ff_derive_body walk_at(const ff_derive_base *base, const walk_events *w, double phase)
{
    double x = (phase - w->right_full) * w->period * w->speed;
    return ff_derive_example_body(base->rig, base->walk, phase, ff_v3(x, 0.0, 0.0));
}

/* m, of the hips over the walk's. */
static double leap_height(double t)
{
    double speed = 0.5 * GRAVITY * LEAP_FLIGHT, land = LEAP_OFF + LEAP_FLIGHT,
           push = 2.0 * (LEAP_HIGH - LEAP_LOW) / speed;
    double low = LEAP_OFF - push, air = t - LEAP_OFF;
    if (t < low) return LEAP_LOW * gone(t, 0.0, low);
    if (t < LEAP_OFF) return ff_derive_hermite(LEAP_LOW, 0.0, LEAP_HIGH, speed, t - low, push);
    if (t < land) return LEAP_HIGH + speed * air - 0.5 * GRAVITY * air * air;
    return ff_derive_hermite(LEAP_HIGH, -speed, 0.0, 0.0, t - land, LEAP - land);
}

/* The walk's foot, carried on and up between two moments. */
static void carry(ff_foot_target *foot, double t, double from, double to)
{
    double s = (t - from) / (to - from);
    foot->ball.z += LEAP_MORE * ff_smooth(s);
    foot->ball.y += LEAP_LIFT * plateau(s);
}

/* Phase and feet are the walk's at both ends; in between it goes slower, the feet further and through the air. */
static ff_status derive_leap(const ff_derive_base *base, ff_motion *out, ff_reactive_times *times,
                             ff_error *error)
{
    walk_events w = events_of(base);
    double begin = 0.7 * w.period, lands = LEAP_OFF + LEAP_FLIGHT, end = begin + LEAP;
    double steady = (w.left_off - w.right_full) * w.period; /* s: the left toes leave when the walk's would */
    *times = (ff_reactive_times){.plant = {{FF_RIGHT, begin - FF_DERIVE_FULL * w.period, begin + LEAP_OFF},
                                           {FF_LEFT, 0.0, begin + steady},
                                           {FF_LEFT, begin + lands, INFINITY},
                                           {FF_RIGHT, begin + LEAP_BEHIND, end + 0.02}},
                                 .plant_count = 4,
                                 .first = begin,
                                 .last = end,
                                 .support = FF_RIGHT,
                                 .mode = FF_MODE_JUMP,
                                 .flags = FF_ACTION_WHOLE};
    ff_status status = ff_motion_alloc(out, ff_derive_frames(end + 0.3), 1.0 / FF_DERIVE_RATE, error);
    for (int k = 0; status == FF_OK && k < out->frame_count; ++k) {
        double t = k / FF_DERIVE_RATE - begin, phase = w.right_full + t / w.period;
        if (t > LEAP)
            phase = w.left_full + (t - LEAP) / w.period;
        else if (t > steady)
            phase = ff_derive_hermite(w.left_off, 1.0 / w.period, w.left_full, 1.0 / w.period, t - steady,
                                      LEAP - steady);
        ff_derive_body b = walk_at(base, &w, phase);
        b.root.x += LEAP_MORE * gone(t, 0.15 * LEAP, 0.95 * LEAP);
        carry(&b.feet[FF_LEFT], t, steady, lands);
        carry(&b.feet[FF_RIGHT], t, LEAP_OFF, LEAP_BEHIND);
        b.hips.z += t > 0.0 && t < LEAP ? leap_height(t) : 0.0;
        ff_derive_put_frame(base->rig, &b, k, out);
    }
    return status;
}

static ff_status derive_dive(const ff_derive_base *base, ff_motion *out, ff_reactive_times *times,
                             ff_error *error)
{
    const ff_stop_times at = ff_derive_stop_times(base, true);
    double right = at.begin - FF_DERIVE_FULL * (double)base->walk->record.period;
    *times = (ff_reactive_times){
        .plant = {{FF_LEFT, 0.0, at.leaves}, {FF_RIGHT, right, INFINITY}, {FF_LEFT, at.lands, INFINITY}},
        .plant_count = 3,
        .first = at.begin,
        .last = at.end,
        .support = FF_RIGHT,
        .mode = FF_MODE_CROUCH,
        .flags = FF_ACTION_TO_STANDING};
    return ff_derive_stop(base, true, out, error);
}

ff_status ff_derive_reactive(const ff_derive_base *base, ff_reactive_kind kind, ff_motion *out,
                             ff_reactive_times *times, ff_error *error)
{
    switch (kind) {
    case FF_REACTIVE_JUMP:
        return derive_jump(base, 0.0, out, times, error);
    case FF_REACTIVE_OVER:
        return derive_jump(base, FORWARD, out, times, error);
    case FF_REACTIVE_LEAP:
        return derive_leap(base, out, times, error);
    case FF_REACTIVE_DIVE:
        return derive_dive(base, out, times, error);
    default:
        return derive_duck(base, out, times, error);
    }
}
