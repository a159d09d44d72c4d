#include "preprocess/actions/derive_motion.h"

#include "preprocess/actions/derive_body.h"

#include <string.h>

static const double BOTH_DOWN = 0.10; /* s between the two feet's steps */
static const double RISE = 0.25;      /* rad, by which the heel of a stepping foot comes up before it */
static const double SWAY = 0.035, DIP = 0.008; /* m, of the hips towards the foot that stays, and down */
static const double HEAD_FIRST = 0.3;          /* share of a turn that the head is ahead at most */
static const double START_SHIFT = 0.35;        /* of the step: the weight goes over before the foot leaves */

ff_status ff_derive_stand(const ff_derive_base *base, ff_motion *out, ff_error *error)
{
    double seconds = ff_min((double)base->stand->record.period, 2.0);
    ff_status status = ff_motion_alloc(out, ff_derive_frames(seconds), 1.0 / FF_DERIVE_RATE, error);
    ff_derive_body first = ff_derive_stand_body(base, ff_v3(0.0, 0.0, 0.0));
    for (int k = 0; status == FF_OK && k < out->frame_count; ++k) {
        ff_derive_body b = ff_derive_example_body(
            base->rig, base->stand, k / FF_DERIVE_RATE / (double)base->stand->record.period, first.root);
        memcpy(b.feet, first.feet, sizeof b.feet);
        ff_derive_put_frame(base->rig, &b, k, out);
    }
    return status;
}

/* ----------------------------------------------------------------------------------- from one stance to another */

/* How far a move is, 0 to 1, that begins and ends at rest. */
static double share(double time, double from, double to)
{
    return ff_smooth((time - from) / (to - from));
}

static double hump(double time, double from, double to)
{
    double s = ff_sin(FF_PI * ff_clamp((time - from) / (to - from), 0.0, 1.0));
    return s * s;
}

double ff_stance_times(const ff_stance_move *move, double leaves[2], double lands[2])
{
    double shift = 0.5 * move->swing;
    leaves[0] = FF_DERIVE_STANDS + shift;
    lands[0] = leaves[0] + move->swing;
    leaves[1] = lands[0] + BOTH_DOWN + 0.15 * move->swing;
    lands[1] = leaves[1] + move->swing;
    return lands[1] + 0.5 * shift + FF_DERIVE_STANDS;
}

ff_status ff_derive_stance_move(const ff_derive_base *base, const ff_stance_move *move, ff_motion *out,
                                ff_error *error)
{
    const ff_rig *rig = base->rig;
    double from[2], to[2], side = move->first == FF_LEFT ? -1.0 : 1.0;
    double whole = ff_stance_times(move, from, to), begin = FF_DERIVE_STANDS, end = whole - FF_DERIVE_STANDS;
    ff_status status = ff_motion_alloc(out, ff_derive_frames(whole), 1.0 / FF_DERIVE_RATE, error);
    ff_derive_body before = ff_derive_stand_body(base, ff_v3(0.0, 0.0, 0.0));
    ff_derive_body after = ff_derive_stand_body(base, ff_v3(move->forward, move->left, move->turn));
    for (int k = 0; status == FF_OK && k < out->frame_count; ++k) {
        double time = k / FF_DERIVE_RATE, gone = share(time, begin, end);
        ff_derive_body b = before;
        b.root = ff_lerp3(before.root, after.root, gone);
        for (int i = 0; i < 2; ++i) {
            int foot = i ? 1 - move->first : move->first;
            b.feet[foot] = ff_derive_swing(&before.feet[foot], &after.feet[foot],
                                           (time - from[i]) / (to[i] - from[i]), base->settings->lift, RISE);
        }
        /* Towards the foot that stays: first the other one, then the one that went first. */
        double over = hump(time, begin, from[1]) - 0.7 * hump(time, to[0], end + 0.1);
        b.hips.y += side * SWAY * over;
        b.hips.z -= DIP * (hump(time, begin, to[0]) + hump(time, to[0], end));
        ff_quat look = ff_quat_yaw(HEAD_FIRST * move->turn * hump(time, begin - 0.15, end));
        b.local[FF_ROLE_NECK] = ff_quat_mul(look, b.local[FF_ROLE_NECK]);
        ff_derive_put_frame(rig, &b, k, out);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------- into and out of walking */

/* The walk as it passes over its standing right foot. */
typedef struct over_right {
    double period, speed;
    double middle; /* phase, in the middle of the right foot's stance, between 0.5 and 1 */
    ff_derive_body at_middle;
} over_right;

static double in_cycle(double phase)
{
    return phase - floor(phase);
}

static over_right pass_over_right(const ff_derive_base *base)
{
    const ff_pack_example *r = &base->walk->record;
    over_right w = {.period = (double)r->period, .speed = (double)r->v_forward};
    double from = (double)r->lock[FF_RIGHT][0], to = (double)r->lock[FF_RIGHT][1];
    w.middle = in_cycle(from + 0.5 * in_cycle(to - from));
    if (w.middle < 0.5) w.middle += 0.5; /* stances of odd length: anywhere before the left contact will do */
    w.at_middle = ff_derive_example_body(base->rig, base->walk, w.middle, ff_v3(0.0, 0.0, 0.0));
    return w;
}

/* The walk at a phase (counted on, 1 = the left contact after middle), its root where the right foot at middle says:
 * the root is at 0 then. */
static ff_derive_body walk_body(const ff_derive_base *base, const over_right *w, double phase)
{
    double x = (phase - w->middle) * w->period * w->speed;
    return ff_derive_example_body(base->rig, base->walk, phase, ff_v3(x, 0.0, 0.0));
}

/* Where one stands when the right foot is where the walk has it. */
static ff_derive_body stand_at_right(const ff_derive_base *base, const over_right *w)
{
    ff_derive_body there = ff_derive_stand_body(base, ff_v3(0.0, 0.0, 0.0));
    ff_vec3 off = ff_sub3(w->at_middle.feet[FF_RIGHT].ball, there.feet[FF_RIGHT].ball);
    return ff_derive_stand_body(base, ff_v3(off.z, off.x, 0.0));
}

ff_status ff_derive_start(const ff_derive_base *base, ff_motion *out, ff_error *error)
{
    over_right w = pass_over_right(base);
    ff_derive_body stand = stand_at_right(base, &w), landed = walk_body(base, &w, 1.0);
    double begin = FF_DERIVE_STANDS, contact = begin + base->settings->start,
           leaves = begin + START_SHIFT * base->settings->start;
    double end = contact + 0.75 * w.period;
    ff_status status = ff_motion_alloc(out, ff_derive_frames(end), 1.0 / FF_DERIVE_RATE, error);
    for (int k = 0; status == FF_OK && k < out->frame_count; ++k) {
        double time = k / FF_DERIVE_RATE, t = time - begin;
        double phase = time >= contact
                           ? 1.0 + (time - contact) / w.period
                           : ff_derive_hermite(w.middle, 0.0, 1.0, 1.0 / w.period, t, base->settings->start);
        ff_derive_body walk = walk_body(base, &w, phase), b = walk;
        if (time < contact) {
            double mix = share(time, begin, contact);
            ff_derive_mix_bodies(&stand, &walk, mix, &b);
            b.root =
                ff_v3(ff_derive_hermite(stand.root.x, 0.0, landed.root.x, w.speed, t, base->settings->start),
                      ff_lerp(stand.root.y, 0.0, mix), 0.0);
            b.hips.y -= SWAY * hump(time, begin, contact);
            /* The walk's foot as seen from this root. */
            ff_foot_target goal = walk.feet[FF_LEFT];
            goal.ball.z += b.root.x - walk.root.x;
            b.feet[FF_LEFT] =
                ff_derive_swing(&stand.feet[FF_LEFT], &goal, (time - leaves) / (contact - leaves),
                                base->settings->lift * (1.0 - mix), RISE * (1.0 - mix));
            b.feet[FF_RIGHT] = ff_derive_mix_feet(&stand.feet[FF_RIGHT], &walk.feet[FF_RIGHT], mix);
        }
        ff_derive_put_frame(base->rig, &b, k, out);
    }
    return status;
}

/* Phases of the walk at which the last step begins, the right foot whole on the floor, and its left toes leave. */
static void stop_phases(const ff_derive_base *base, double *first, double *off)
{
    const ff_pack_example *r = &base->walk->record;
    *first = (double)r->key[2] + FF_DERIVE_FULL;
    *off = (double)r->key[3] > *first ? (double)r->key[3] : *first + 0.05;
}

ff_stop_times ff_derive_stop_times(const ff_derive_base *base, bool ducking)
{
    double first, off, period = (double)base->walk->record.period, begin = 0.7 * period;
    stop_phases(base, &first, &off);
    return (ff_stop_times){.begin = begin,
                           .leaves = begin + (off - first) * period,
                           .lands = begin + 0.8 * base->settings->stop,
                           .end = begin + (ducking ? FF_DERIVE_DUCK : base->settings->stop)};
}

ff_status ff_derive_stop(const ff_derive_base *base, bool ducking, ff_motion *out, ff_error *error)
{
    over_right w = pass_over_right(base);
    const ff_stop_times at = ff_derive_stop_times(base, ducking);
    double first, off, begin = at.begin, end = begin + base->settings->stop;
    stop_phases(base, &first, &off);
    ff_derive_body stand = stand_at_right(base, &w), from = walk_body(base, &w, first),
                   toes = walk_body(base, &w, off);
    ff_status status =
        ff_motion_alloc(out, ff_derive_frames(at.end + FF_DERIVE_STANDS), 1.0 / FF_DERIVE_RATE, error);
    for (int k = 0; status == FF_OK && k < out->frame_count; ++k) {
        double time = k / FF_DERIVE_RATE, t = time - begin;
        double phase = time <= begin
                           ? first + t / w.period
                           : ff_derive_hermite(first, 1.0 / w.period, w.middle, 0.0, t, base->settings->stop);
        ff_derive_body walk = walk_body(base, &w, phase), b = walk;
        if (time > begin) {
            double mix = share(time, begin, end);
            ff_derive_mix_bodies(&walk, &stand, mix, &b);
            b.root =
                ff_v3(ff_derive_hermite(from.root.x, w.speed, stand.root.x, 0.0, t, base->settings->stop),
                      ff_lerp(0.0, stand.root.y, mix), 0.0);
            b.feet[FF_RIGHT] = ff_derive_mix_feet(&walk.feet[FF_RIGHT], &stand.feet[FF_RIGHT], mix);
            /* The left toes leave where and when the walk's would. */
            ff_derive_body here = walk_body(base, &w, ff_min(first + t / w.period, off));
            b.feet[FF_LEFT] = time < at.leaves ? here.feet[FF_LEFT]
                                               : ff_derive_swing(&toes.feet[FF_LEFT], &stand.feet[FF_LEFT],
                                                                 (time - at.leaves) / (at.lands - at.leaves),
                                                                 base->settings->lift, RISE);
            b.hips.y -= 0.5 * SWAY * hump(time, begin, end);
            if (ducking) ff_derive_crouch(base->rig, ff_derive_ducked(t), &b);
        }
        ff_derive_put_frame(base->rig, &b, k, out);
    }
    return status;
}
