#include "preprocess/derive_motion.h"

#include "preprocess/foot_target.h"

#include <string.h>

static const double RATE = 60.0;      /* frames per second */
static const double STANDS = 0.6;     /* s, before and after */
static const double BOTH_DOWN = 0.10; /* s between the two feet's steps */
static const double RISE = 0.25;      /* rad, by which the heel of a stepping foot comes up before it */
static const double SWAY = 0.035, DIP = 0.008; /* m, of the hips towards the foot that stays, and down */
static const double HEAD_FIRST = 0.3;          /* share of a turn that the head is ahead at most */
static const double START_SHIFT = 0.35;        /* of the step: the weight goes over before the foot leaves */

/* A pose with its feet in the world. */
typedef struct body {
    ff_vec3 root, hips; /* as in ff_motion */
    ff_quat local[FF_ROLE_JOINT_COUNT];
    ff_foot_target feet[2];
} body;

static void find_feet(const ff_rig *rig, body *b)
{
    ff_vec3 at[FF_BODY_COUNT];
    ff_quat world[FF_ROLE_JOINT_COUNT];
    ff_rig_pose_local(rig, b->root, b->hips, b->local, at);
    ff_local_to_world(b->local, world);
    for (int foot = 0; foot < 2; ++foot) {
        int ball = foot ? FF_ROLE_BALL_R : FF_ROLE_BALL_L;
        b->feet[foot] =
            (ff_foot_target){at[ball], ff_quat_mul(ff_quat_yaw(b->root.z), world[ball - 1]), b->local[ball]};
    }
}

/* The pose of an example at a phase, on a root; what it does to its feet is in feet. */
static body example_body(const ff_rig *rig, const ff_example *example, double phase, ff_vec3 root)
{
    body b = {.root = root};
    ff_example_sample(example, phase, &b.hips, b.local);
    find_feet(rig, &b);
    return b;
}

static ff_foot_target mix_feet(const ff_foot_target *p, const ff_foot_target *q, double t)
{
    return (ff_foot_target){ff_lerp3(p->ball, q->ball, t), ff_quat_slerp(p->rotation, q->rotation, t),
                            ff_quat_slerp(p->toes, q->toes, t)};
}

/* All but the feet. */
static void mix_bodies(const body *p, const body *q, double t, body *out)
{
    out->hips = ff_lerp3(p->hips, q->hips, t);
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        out->local[r] = ff_quat_slerp(p->local[r], q->local[r], t);
}

/* A foot on its way: t from 0 to 1. Its heel comes up first. */
static ff_foot_target swing(const ff_foot_target *from, const ff_foot_target *to, double t, double lift,
                            double rise)
{
    ff_foot_target at = mix_feet(from, to, ff_smooth(t));
    double high = ff_sin(FF_PI * ff_clamp(t, 0.0, 1.0)), heel = ff_sin(FF_PI * ff_clamp(1.6 * t, 0.0, 1.0));
    at.ball.y += lift * high * high;
    at.rotation = ff_quat_mul(at.rotation, ff_quat_axis(ff_v3(1.0, 0.0, 0.0), rise * heel * heel));
    return at;
}

/* Lower the hips until both legs reach their feet, then pose the legs. */
static void put_frame(const ff_rig *rig, const body *b, int k, ff_motion *motion)
{
    ff_quat world[FF_ROLE_JOINT_COUNT], *local = motion->rotations + (size_t)k * FF_ROLE_JOINT_COUNT;
    ff_vec3 at[FF_BODY_COUNT];
    motion->root[k] = b->root;
    motion->hips[k] = b->hips;
    memcpy(local, b->local, sizeof b->local);
    ff_motion_pose(rig, motion, k, at, NULL);
    for (int foot = 0; foot < 2; ++foot) {
        ff_vec3 hip = at[foot ? FF_ROLE_HIP_R : FF_ROLE_HIP_L], ankle = ff_target_ankle(rig, &b->feet[foot]);
        double reach = FF_LEG_REACH * rig->leg, away = ff_length2(ff_plane(ff_sub3(hip, ankle)));
        double high = ankle.y + sqrt(ff_max(reach * reach - away * away, 0.01));
        motion->hips[k].z = ff_min(motion->hips[k].z, b->hips.z + high - hip.y);
    }
    ff_motion_pose(rig, motion, k, at, world);
    for (int foot = 0; foot < 2; ++foot)
        ff_leg_to_target(rig, foot, &b->feet[foot], at, world, local);
    for (int r = 0; k > 0 && r < FF_ROLE_JOINT_COUNT; ++r)
        if (ff_quat_dot(local[r], local[r - FF_ROLE_JOINT_COUNT]) < 0.0)
            local[r] = (ff_quat){-local[r].x, -local[r].y, -local[r].z, -local[r].w};
}

static body stand_body(const ff_derive_base *base, ff_vec3 root)
{
    return example_body(base->rig, base->stand, 0.0, root);
}

static int frames_of(double seconds)
{
    return (int)floor(seconds * RATE + 0.5) + 1;
}

ff_status ff_derive_stand(const ff_derive_base *base, ff_motion *out, ff_error *error)
{
    double seconds = ff_min((double)base->stand->record.period, 2.0);
    ff_status status = ff_motion_alloc(out, frames_of(seconds), 1.0 / RATE, error);
    body first = stand_body(base, ff_v3(0.0, 0.0, 0.0));
    for (int k = 0; status == FF_OK && k < out->frame_count; ++k) {
        body b =
            example_body(base->rig, base->stand, k / RATE / (double)base->stand->record.period, first.root);
        memcpy(b.feet, first.feet, sizeof b.feet);
        put_frame(base->rig, &b, k, out);
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
    leaves[0] = STANDS + shift;
    lands[0] = leaves[0] + move->swing;
    leaves[1] = lands[0] + BOTH_DOWN + 0.15 * move->swing;
    lands[1] = leaves[1] + move->swing;
    return lands[1] + 0.5 * shift + STANDS;
}

ff_status ff_derive_stance_move(const ff_derive_base *base, const ff_stance_move *move, ff_motion *out,
                                ff_error *error)
{
    const ff_rig *rig = base->rig;
    double from[2], to[2], side = move->first == FF_LEFT ? -1.0 : 1.0;
    double whole = ff_stance_times(move, from, to), begin = STANDS, end = whole - STANDS;
    ff_status status = ff_motion_alloc(out, frames_of(whole), 1.0 / RATE, error);
    body before = stand_body(base, ff_v3(0.0, 0.0, 0.0));
    body after = stand_body(base, ff_v3(move->forward, move->left, move->turn));
    for (int k = 0; status == FF_OK && k < out->frame_count; ++k) {
        double time = k / RATE, gone = share(time, begin, end);
        body b = before;
        b.root = ff_lerp3(before.root, after.root, gone);
        for (int i = 0; i < 2; ++i) {
            int foot = i ? 1 - move->first : move->first;
            b.feet[foot] = swing(&before.feet[foot], &after.feet[foot], (time - from[i]) / (to[i] - from[i]),
                                 base->settings->lift, RISE);
        }
        /* Towards the foot that stays: first the other one, then the one that went first. */
        double over = hump(time, begin, from[1]) - 0.7 * hump(time, to[0], end + 0.1);
        b.hips.y += side * SWAY * over;
        b.hips.z -= DIP * (hump(time, begin, to[0]) + hump(time, to[0], end));
        ff_quat look = ff_quat_yaw(HEAD_FIRST * move->turn * hump(time, begin - 0.15, end));
        b.local[FF_ROLE_NECK] = ff_quat_mul(look, b.local[FF_ROLE_NECK]);
        put_frame(rig, &b, k, out);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------- into and out of walking */

/* Cubic from x0 with slope v0 to x1 with slope v1 over seconds. */
static double hermite(double x0, double v0, double x1, double v1, double t, double seconds)
{
    double s = ff_clamp(t / seconds, 0.0, 1.0), s2 = s * s, s3 = s2 * s;
    return (2.0 * s3 - 3.0 * s2 + 1.0) * x0 + (s3 - 2.0 * s2 + s) * seconds * v0 +
           (3.0 * s2 - 2.0 * s3) * x1 + (s3 - s2) * seconds * v1;
}

/* The walk as it passes over its standing right foot. */
typedef struct over_right {
    double period, speed;
    double middle; /* phase, in the middle of the right foot's stance, between 0.5 and 1 */
    body at_middle;
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
    w.at_middle = example_body(base->rig, base->walk, w.middle, ff_v3(0.0, 0.0, 0.0));
    return w;
}

/* The walk at a phase (counted on, 1 = the left contact after middle), its root where the right foot at middle says:
 * the root is at 0 then. */
static body walk_body(const ff_derive_base *base, const over_right *w, double phase)
{
    double x = (phase - w->middle) * w->period * w->speed;
    return example_body(base->rig, base->walk, phase, ff_v3(x, 0.0, 0.0));
}

/* Where one stands when the right foot is where the walk has it. */
static body stand_at_right(const ff_derive_base *base, const over_right *w)
{
    body there = stand_body(base, ff_v3(0.0, 0.0, 0.0));
    ff_vec3 off = ff_sub3(w->at_middle.feet[FF_RIGHT].ball, there.feet[FF_RIGHT].ball);
    return stand_body(base, ff_v3(off.z, off.x, 0.0));
}

ff_status ff_derive_start(const ff_derive_base *base, ff_motion *out, ff_error *error)
{
    over_right w = pass_over_right(base);
    body stand = stand_at_right(base, &w), landed = walk_body(base, &w, 1.0);
    double begin = STANDS, contact = begin + base->settings->start,
           leaves = begin + START_SHIFT * base->settings->start;
    double end = contact + 0.75 * w.period;
    ff_status status = ff_motion_alloc(out, frames_of(end), 1.0 / RATE, error);
    for (int k = 0; status == FF_OK && k < out->frame_count; ++k) {
        double time = k / RATE, t = time - begin;
        double phase = time >= contact
                           ? 1.0 + (time - contact) / w.period
                           : hermite(w.middle, 0.0, 1.0, 1.0 / w.period, t, base->settings->start);
        body walk = walk_body(base, &w, phase), b = walk;
        if (time < contact) {
            double mix = share(time, begin, contact);
            mix_bodies(&stand, &walk, mix, &b);
            b.root = ff_v3(hermite(stand.root.x, 0.0, landed.root.x, w.speed, t, base->settings->start),
                           ff_lerp(stand.root.y, 0.0, mix), 0.0);
            b.hips.y -= SWAY * hump(time, begin, contact);
            /* The walk's foot as seen from this root. */
            ff_foot_target goal = walk.feet[FF_LEFT];
            goal.ball.z += b.root.x - walk.root.x;
            b.feet[FF_LEFT] = swing(&stand.feet[FF_LEFT], &goal, (time - leaves) / (contact - leaves),
                                    base->settings->lift * (1.0 - mix), RISE * (1.0 - mix));
            b.feet[FF_RIGHT] = mix_feet(&stand.feet[FF_RIGHT], &walk.feet[FF_RIGHT], mix);
        }
        put_frame(base->rig, &b, k, out);
    }
    return status;
}

ff_status ff_derive_stop(const ff_derive_base *base, ff_motion *out, ff_error *error)
{
    const ff_pack_example *r = &base->walk->record;
    over_right w = pass_over_right(base);
    /* The last step begins when the right foot is whole on the floor, some 0.08 of the cycle after its contact. */
    double first = (double)r->key[2] + 0.08, lead = 0.7 * w.period, begin = lead,
           end = begin + base->settings->stop;
    double off =
        (double)r->key[3] > first ? (double)r->key[3] : first + 0.05; /* phase, the left toes leave */
    body stand = stand_at_right(base, &w), from = walk_body(base, &w, first), toes = walk_body(base, &w, off);
    double leaves = begin + (off - first) * w.period, lands = begin + 0.8 * base->settings->stop;
    ff_status status = ff_motion_alloc(out, frames_of(end + STANDS), 1.0 / RATE, error);
    for (int k = 0; status == FF_OK && k < out->frame_count; ++k) {
        double time = k / RATE, t = time - begin;
        double phase = time <= begin ? first + t / w.period
                                     : hermite(first, 1.0 / w.period, w.middle, 0.0, t, base->settings->stop);
        body walk = walk_body(base, &w, phase), b = walk;
        if (time > begin) {
            double mix = share(time, begin, end);
            mix_bodies(&walk, &stand, mix, &b);
            b.root = ff_v3(hermite(from.root.x, w.speed, stand.root.x, 0.0, t, base->settings->stop),
                           ff_lerp(0.0, stand.root.y, mix), 0.0);
            b.feet[FF_RIGHT] = mix_feet(&walk.feet[FF_RIGHT], &stand.feet[FF_RIGHT], mix);
            /* The left toes leave where and when the walk's would. */
            body here = walk_body(base, &w, ff_min(first + t / w.period, off));
            b.feet[FF_LEFT] = time < leaves
                                  ? here.feet[FF_LEFT]
                                  : swing(&toes.feet[FF_LEFT], &stand.feet[FF_LEFT],
                                          (time - leaves) / (lands - leaves), base->settings->lift, RISE);
            b.hips.y -= 0.5 * SWAY * hump(time, begin, end);
        }
        put_frame(base->rig, &b, k, out);
    }
    return status;
}
