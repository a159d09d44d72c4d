#include "preprocess/derive.h"

#include "runtime/core/leg_ik.h"

#include <stdio.h>
#include <string.h>

#define STAND_HALF_WIDTH 0.09 /* m, from the middle to a ball of standing feet */
#define STAND_TOE_OUT (7.0 * FF_DEG)
#define STAND_REACH 0.994 /* of the leg: knees that stand at ease bend by some 12 degrees */
#define LIFT_MIN 0.045    /* m, the ball rises at least this far in a swing */
#define CLEARANCE 0.04    /* m, how far a turning body's swing foot goes round the other one */
#define ANKLES_APART 0.14 /* m, of a strafe's closed feet */

/* What of the base is kept and how it is bent to the target. */
typedef struct plan {
    const ff_rig *rig;
    const ff_example *base;
    ff_vec3 rest[FF_BODY_COUNT];
    ff_quat mean[FF_ROLE_JOINT_COUNT]; /* of the base over its cycle */
    ff_vec3 mean_hips;
    double centre[2][3]; /* ball (forward, left) and yaw in the middle of the stance */
    double size;         /* of the gait, 1 = as the base: scales roll, rise, arms */
    double stride;       /* m, of the base, signed */
    double v0;
} plan;

static void mean_pose(plan *p)
{
    const ff_example *base = p->base;
    memset(p->mean, 0, sizeof p->mean);
    p->mean_hips = ff_v3(0.0, 0.0, 0.0);
    for (int k = 0; k < base->frame_count; ++k) {
        p->mean_hips = ff_madd3(p->mean_hips, base->hips[k], 1.0 / base->frame_count);
        for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
            ff_quat q = base->rotations[(size_t)k * FF_ROLE_JOINT_COUNT + (size_t)r], *m = &p->mean[r];
            double sign = ff_quat_dot(q, *m) < 0.0 ? -1.0 : 1.0;
            *m = (ff_quat){m->x + sign * q.x, m->y + sign * q.y, m->z + sign * q.z, m->w + sign * q.w};
        }
    }
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        p->mean[r] = ff_quat_unit(p->mean[r]);
}

/* forward, left, height of the ball, yaw, pitch at a phase */
static void foot_at(const ff_example *e, int foot, double phase, double out[5])
{
    int n = e->frame_count;
    double frame = (phase - floor(phase)) * n, t = frame - floor(frame);
    const ff_pack_foot *a = &e->feet[2 * ((int)frame % n) + foot],
                       *b = &e->feet[2 * (((int)frame + 1) % n) + foot];
    for (int i = 0; i < 3; ++i)
        out[i] = ff_lerp((double)a->ball[i], (double)b->ball[i], t);
    out[3] = (double)a->yaw + ff_wrap((double)b->yaw - (double)a->yaw) * t;
    out[4] = ff_lerp((double)a->pitch, (double)b->pitch, t);
}

static double middle_of_lock(const ff_example *e, int foot)
{
    double from = (double)e->record.lock[foot][0], to = (double)e->record.lock[foot][1];
    return from + 0.5 * (to < from ? to + 1.0 - from : to - from);
}

static void make_plan(const ff_rig *rig, const ff_example *base, plan *p)
{
    *p = (plan){.rig = rig, .base = base};
    ff_rig_rest_pose(rig, p->rest);
    mean_pose(p);
    for (int foot = 0; foot < 2; ++foot) {
        double at[5];
        foot_at(base, foot, middle_of_lock(base, foot), at);
        p->centre[foot][0] = at[0];
        p->centre[foot][1] = at[1];
        p->centre[foot][2] = at[3];
    }
    p->v0 = (double)base->record.v_forward;
    p->stride = p->v0 * (double)base->record.period;
}

/* How far a foot's swing has got: 0 at toe-off, 1 at contact; -1 while it is on the ground. */
static double swing_share(const ff_pack_example *record, int foot, double phase)
{
    double off = (double)record->key[foot ? 1 : 3], contact = (double)record->key[foot ? 2 : 0];
    double length = contact - off, at = phase - off;
    length += length <= 0.0 ? 1.0 : 0.0;
    at -= floor(at);
    return at < length ? at / length : -1.0;
}

/* Where the middle of a foot's path is: (forward, left) of the root, between that of the base and standing feet. */
static ff_vec2 foot_place(const plan *p, const ff_derive_target *target, int foot)
{
    double side = foot ? -1.0 : 1.0, part = ff_min(1.0, p->size);
    double ahead = ff_lerp(p->rest[FF_ROLE_BALL_L].z - p->rest[FF_ROLE_HIP_L].z, p->centre[foot][0], part);
    double half = ff_lerp(STAND_HALF_WIDTH, fabs(p->centre[foot][1]), part);
    /* Side steps need room for the closing foot, unless the feet pass each other well apart in front and behind. */
    double wide = 0.5 * (ANKLES_APART + 0.5 * fabs(target->left) * target->period);
    double pass = 0.25 * fabs(target->forward) * target->period;
    double fade = 1.0 - ff_smooth((pass - 0.25) / 0.2);
    return ff_v2(ahead, side * (half + fade * ff_max(0.0, wide - half)));
}

typedef struct foot_target {
    ff_vec3 ball; /* x left, y up, z forward */
    ff_quat rotation;
} foot_target;

static foot_target place_foot(const plan *p, const ff_derive_target *target, int foot, double phase)
{
    double at[5];
    foot_at(p->base, foot, phase, at);
    /* The base's forward path in strides says when the foot is where; the root's own path over that time, bent and
     * turned as the target's, says where that is: a foot that stood in the base stands here. */
    double ahead = (at[0] - p->centre[foot][0]) / p->stride * target->period;
    ff_vec2 place = foot_place(p, target, foot);
    place.b += (at[1] - p->centre[foot][1]) * ff_min(1.0, p->size);
    double rest = p->rest[FF_ROLE_BALL_L].y, swing = swing_share(&p->base->record, foot, phase), bump = 0.0;
    if (swing >= 0.0) {
        double s = ff_sin(FF_PI * swing);
        bump = s * s;
    }
    double turning = ff_min(1.0, fabs(target->turn)) * (1.0 - ff_min(1.0, p->size));
    place.b += (foot ? -1.0 : 1.0) * CLEARANCE * turning * bump;
    double angle = target->turn * ahead;
    ff_vec2 on_path = ff_add2(ff_from_frame2(ff_fwd2(angle), place),
                              ff_root_arc(ff_v2(target->forward, target->left), target->turn, ahead));
    double height = rest + ff_max((at[2] - rest) * ff_clamp(p->size, 0.6, 1.1), LIFT_MIN * bump);
    double toe_out = ff_lerp((foot ? -1.0 : 1.0) * STAND_TOE_OUT, p->centre[foot][2], ff_min(1.0, p->size));
    double yaw = angle + toe_out + ff_wrap(at[3] - p->centre[foot][2]) * p->size;
    ff_quat pitch = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -at[4] * p->size);
    return (foot_target){ff_v3(on_path.b, height, on_path.a), ff_quat_mul(ff_quat_yaw(yaw), pitch)};
}

static ff_vec3 ankle_of(const ff_rig *rig, const foot_target *t)
{
    return ff_sub3(t->ball, ff_quat_rotate(t->rotation, rig->offset[FF_ROLE_BALL_L]));
}

/* Trunk and arms between the base's mean and its motion; legs as the base has them, for the side of the knees. */
static void body_pose(const plan *p, double phase, ff_vec3 *hips, ff_quat *local)
{
    ff_example_sample(p->base, phase, hips, local);
    double part = ff_clamp(p->size, 0.15, 1.0);
    for (int r = 0; r < FF_ROLE_HIP_L; ++r)
        local[r] = ff_quat_slerp(p->mean[r], local[r], part);
    hips->x = (hips->x - p->mean_hips.x) * part;
    hips->y = (hips->y - p->mean_hips.y) * ff_max(part, 0.6);
    hips->z = p->mean_hips.z + (hips->z - p->mean_hips.z) * part;
}

/* How much higher the hips may be before this leg is longer than reach of its length. */
static double room_above(const plan *p, const ff_vec3 *at, int foot, ff_vec3 ankle, double reach)
{
    ff_vec3 hip = at[foot ? FF_ROLE_HIP_R : FF_ROLE_HIP_L];
    double length = reach * p->rig->leg;
    double flat = ff_length2(ff_sub2(ff_plane(hip), ff_plane(ankle)));
    return ankle.y + sqrt(ff_max(length * length - flat * flat, 0.01)) - hip.y;
}

static void world_of(const ff_quat *local, ff_quat *world)
{
    world[0] = local[0];
    for (int r = 1; r < FF_ROLE_JOINT_COUNT; ++r)
        world[r] = ff_quat_mul(world[ff_role_parent((ff_role)r)], local[r]);
}

static void solve_leg(const plan *p, int foot, const foot_target *target, const ff_vec3 *at, ff_quat *world,
                      ff_quat *local)
{
    int hip = foot ? FF_ROLE_HIP_R : FF_ROLE_HIP_L, knee = hip + 1, ankle = hip + 2, ball = hip + 3;
    ff_leg leg = {at[hip], at[knee], at[ankle], world[hip], world[knee], world[ankle]};
    ff_leg_solve(&leg, at[hip], ankle_of(p->rig, target));
    local[hip] = ff_quat_mul(ff_quat_conj(world[0]), leg.thigh);
    local[knee] = ff_quat_mul(ff_quat_conj(leg.thigh), leg.shank);
    local[ankle] = ff_quat_mul(ff_quat_conj(leg.shank), target->rotation);
    local[ball] = ff_quat_slerp(FF_QUAT_IDENTITY, local[ball], ff_min(1.0, p->size));
}

/* All frames: feet where place says, the hips at one height over the base's own motion, so that the longest reach of a
 * standing leg is reach. */
static void solve_frames(const plan *p, const ff_derive_target *target, double reach, ff_example *out)
{
    double lift = 1e9;
    for (int pass = 0; pass < 2; ++pass) {
        for (int k = 0; k < out->frame_count; ++k) {
            ff_quat world[FF_ROLE_JOINT_COUNT], *local = out->rotations + (size_t)k * FF_ROLE_JOINT_COUNT;
            ff_vec3 at[FF_BODY_COUNT], hips;
            double phase = k / (double)out->frame_count;
            body_pose(p, phase, &hips, local);
            if (pass) hips.z += lift;
            out->hips[k] = hips;
            world_of(local, world);
            ff_rig_pose(p->rig, ff_v3(hips.y, hips.z, hips.x), world, at);
            for (int foot = 0; foot < 2; ++foot) {
                foot_target to = place_foot(p, target, foot, phase);
                bool stands = swing_share(&p->base->record, foot, phase) < 0.0;
                if (pass) solve_leg(p, foot, &to, at, world, local);
                if (!pass && stands)
                    lift = ff_min(lift, room_above(p, at, foot, ankle_of(p->rig, &to), reach));
            }
        }
    }
}

ff_status ff_derive_walk(const ff_rig *rig, const ff_example *base, const ff_derive_target *target,
                         ff_example *out, ff_error *error)
{
    plan p;
    make_plan(rig, base, &p);
    p.size = ff_clamp(fabs(target->forward) / fabs(p.v0), 0.12, 1.15);
    ff_status status = ff_example_alloc(out, (int)floor(target->period * FF_PACK_RATE + 0.5), error);
    if (status != FF_OK) return status;
    out->record = base->record;
    out->record.flags = (base->record.flags | FF_EXAMPLE_DERIVED) & ~(uint32_t)FF_EXAMPLE_MIRRORED;
    out->record.period = (float)target->period;
    out->record.v_forward = (float)target->forward;
    out->record.v_left = (float)target->left;
    out->record.turn_rate = (float)target->turn;
    out->record.seam = 0.0f;
    out->clip = base->clip;
    snprintf(out->name, sizeof out->name, "%s from %.60s", target->name, base->name);
    solve_frames(&p, target, FF_LEG_REACH, out);
    ff_example_find_feet(rig, out);
    return FF_OK;
}

/* ------------------------------------------------------------------------------------------------------- idle */

#define BREATH 4.0 /* s */
#define BREATH_ANGLE (0.6 * FF_DEG)

ff_status ff_derive_idle(const ff_rig *rig, const ff_example *base, ff_example *out, ff_error *error)
{
    plan p;
    make_plan(rig, base, &p);
    p.size = 0.0;
    ff_status status = ff_example_alloc(out, (int)(BREATH * FF_PACK_RATE), error);
    if (status != FF_OK) return status;
    const float keys[4] = {0.0f, 0.1f, 0.5f, 0.6f};
    out->record.flags = FF_EXAMPLE_IDLE | FF_EXAMPLE_DERIVED;
    out->record.gait = FF_GAIT_WALK;
    out->record.period = (float)BREATH;
    memcpy(out->record.key, keys, sizeof keys);
    snprintf(out->name, sizeof out->name, "idle from %.60s", base->name);
    for (int k = 0; k < out->frame_count; ++k) {
        ff_quat world[FF_ROLE_JOINT_COUNT], *local = out->rotations + (size_t)k * FF_ROLE_JOINT_COUNT;
        memcpy(local, p.mean, sizeof p.mean);
        double breath = BREATH_ANGLE * ff_sin(FF_TAU * k / out->frame_count);
        ff_quat swell = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -breath);
        local[FF_ROLE_CHEST] = ff_quat_mul(local[FF_ROLE_CHEST], swell);
        local[FF_ROLE_NECK] = ff_quat_mul(ff_quat_conj(swell), local[FF_ROLE_NECK]);
        world_of(local, world);
        ff_vec3 at[FF_BODY_COUNT], hips = ff_v3(0.0, p.mean_hips.z, 0.0);
        foot_target feet[2];
        double lift = 1e9;
        ff_rig_pose(rig, hips, world, at);
        for (int foot = 0; foot < 2; ++foot) {
            double side = foot ? -1.0 : 1.0;
            feet[foot].ball = ff_v3(side * STAND_HALF_WIDTH, p.rest[FF_ROLE_BALL_L].y,
                                    p.rest[FF_ROLE_BALL_L].z - p.rest[FF_ROLE_HIP_L].z);
            feet[foot].rotation = ff_quat_yaw(side * STAND_TOE_OUT);
            lift = ff_min(lift, room_above(&p, at, foot, ankle_of(rig, &feet[foot]), STAND_REACH));
        }
        hips.y += lift;
        ff_rig_pose(rig, hips, world, at);
        for (int foot = 0; foot < 2; ++foot)
            solve_leg(&p, foot, &feet[foot], at, world, local);
        out->hips[k] = ff_v3(0.0, 0.0, hips.y);
    }
    ff_example_find_feet(rig, out);
    return FF_OK;
}
