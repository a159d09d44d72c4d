#include "preprocess/examples/derive.h"

#include "preprocess/examples/loop.h"
#include "preprocess/motion/foot_target.h"

#include <stdio.h>
#include <string.h>

#define STAND_REACH 0.994 /* of the leg: knees that stand at ease bend by some 12 degrees */
#define GRAVITY 9.81

/* What of the base is kept and how it is bent to the target. */
typedef struct plan {
    const ff_rig *rig;
    const ff_example *base; /* trunk, arms and the side of the knees; read backwards for backward targets */
    ff_gait_model model;    /* feet */
    ff_rates rates;
    ff_vec3 rest[FF_BODY_COUNT];
    ff_quat mean[FF_ROLE_JOINT_COUNT]; /* of the base over its cycle */
    ff_vec3 mean_hips;
    double size, period; /* of the gait, 1 = as the base: scales trunk and arms */
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

static void make_plan(const ff_rig *rig, const ff_example *base, plan *p)
{
    *p = (plan){.rig = rig, .base = base};
    ff_rig_rest_pose(rig, p->rest);
    mean_pose(p);
}

static ff_foot_target place_foot(const plan *p, int foot, double phase, bool *stands)
{
    ff_model_foot at = ff_gait_model_foot(&p->model, p->rates, p->period, foot, phase);
    ff_quat pitch = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -at.pitch);
    *stands = at.swing < 0.0;
    return (ff_foot_target){ff_v3(at.left, at.height, at.forward), ff_quat_mul(ff_quat_yaw(at.yaw), pitch),
                            FF_QUAT_IDENTITY};
}

/* The base's phase whose body goes with the feet at a phase: backwards the cycle is read backwards. */
static double body_phase(const plan *p, double phase)
{
    return p->rates.forward < 0.0 ? (double)p->base->record.key[3] - phase : phase;
}

/* Trunk and arms between the base's mean and its motion; legs as the base has them, for the side of the knees. Who runs
 * a bend leans into it. */
static void body_pose(const plan *p, double phase, ff_vec3 *hips, ff_quat *local)
{
    ff_example_sample(p->base, body_phase(p, phase), hips, local);
    double part = ff_clamp(p->size, 0.15, 1.0);
    for (int r = 0; r < FF_ROLE_HIP_L; ++r)
        local[r] = ff_quat_slerp(p->mean[r], local[r], part);
    *hips = ff_gait_model_hips(&p->model, p->rates, phase);
    hips->z += p->mean_hips.z;
    if (p->base->record.gait != FF_GAIT_RUN) return;
    double lean = ff_atan2(p->rates.forward * p->rates.turn, GRAVITY);
    hips->y += p->mean_hips.z * ff_sin(lean);
    local[0] = ff_quat_mul(ff_quat_axis(ff_v3(0.0, 0.0, 1.0), -lean), local[0]);
}

/* How much higher the hips may be before this leg is longer than reach of its length. */
static double room_above(const plan *p, const ff_vec3 *at, int foot, ff_vec3 ankle, double reach)
{
    ff_vec3 hip = at[foot ? FF_ROLE_HIP_R : FF_ROLE_HIP_L];
    double length = reach * p->rig->leg;
    double flat = ff_length2(ff_sub2(ff_plane(hip), ff_plane(ankle)));
    return ankle.y + sqrt(ff_max(length * length - flat * flat, 0.01)) - hip.y;
}

static void solve_leg(const plan *p, int foot, const ff_foot_target *target, const ff_vec3 *at,
                      const ff_quat *world, ff_quat *local)
{
    ff_foot_target bent = *target;
    bent.toes = ff_quat_slerp(FF_QUAT_IDENTITY, local[(foot ? FF_ROLE_HIP_R : FF_ROLE_HIP_L) + 3],
                              ff_min(1.0, p->size));
    ff_leg_to_target(p->rig, foot, &bent, at, world, local);
}

/* All frames: feet where the model says, the hips at one height over the base's own motion, so that the longest reach of
 * a standing leg is reach. */
static void solve_frames(const plan *p, double reach, ff_example *out)
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
            ff_local_to_world(local, world);
            ff_rig_pose(p->rig, ff_v3(hips.y, hips.z, hips.x), world, at);
            for (int foot = 0; foot < 2; ++foot) {
                bool stands;
                ff_foot_target to = place_foot(p, foot, phase, &stands);
                if (pass) solve_leg(p, foot, &to, at, world, local);
                if (!pass && stands)
                    lift = ff_min(lift, room_above(p, at, foot, ff_target_ankle(p->rig, &to), reach));
            }
        }
    }
}

/* Both sides are alike; a run's right foot leaves after its own contact, a walk's after the left one's. */
static void set_keys(const plan *p, ff_pack_example *record)
{
    double stance = ff_gait_model_stance(&p->model, p->rates), right_off = 0.5 + stance;
    record->key[0] = 0.0f;
    record->key[1] = (float)(right_off - floor(right_off));
    record->key[2] = 0.5f;
    record->key[3] = (float)stance;
}

ff_status ff_derive_walk(const ff_rig *rig, const ff_example *base, const ff_gait_fit *fit,
                         const ff_derive_target *target, ff_example *out, ff_error *error)
{
    plan p;
    make_plan(rig, base, &p);
    p.model = ff_gait_fit_model(fit);
    p.rates = (ff_rates){target->forward, target->left, target->turn};
    p.size = ff_gait_model_size(&p.model, p.rates);
    p.period = target->period > 0.0 ? target->period : ff_gait_model_period(&p.model, p.rates);
    ff_status status = ff_example_alloc(out, (int)floor(p.period * FF_PACK_RATE + 0.5), error);
    if (status != FF_OK) return status;
    out->record = base->record;
    out->record.flags =
        (base->record.flags | FF_EXAMPLE_DERIVED) & ~(uint32_t)(FF_EXAMPLE_MIRRORED | FF_EXAMPLE_LOOSE);
    out->record.period = (float)p.period;
    out->record.v_forward = (float)target->forward;
    out->record.v_left = (float)target->left;
    out->record.turn_rate = (float)target->turn;
    out->record.seam = 0.0f;
    out->clip = base->clip;
    set_keys(&p, &out->record);
    snprintf(out->name, sizeof out->name, "%s from %.60s", target->name, base->name);
    solve_frames(&p, FF_LEG_REACH, out);
    ff_example_find_feet(rig, out);
    ff_loop_find_contact_kick(rig, out);
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
        ff_local_to_world(local, world);
        ff_vec3 at[FF_BODY_COUNT], hips = ff_v3(0.0, p.mean_hips.z, 0.0);
        ff_foot_target feet[2];
        double lift = 1e9;
        ff_rig_pose(rig, hips, world, at);
        for (int foot = 0; foot < 2; ++foot) {
            double side = foot ? -1.0 : 1.0;
            feet[foot].ball = ff_v3(side * FF_STAND_HALF_WIDTH, p.rest[FF_ROLE_BALL_L].y,
                                    p.rest[FF_ROLE_BALL_L].z - p.rest[FF_ROLE_HIP_L].z);
            feet[foot].rotation = ff_quat_yaw(side * FF_STAND_TOE_OUT);
            lift = ff_min(lift, room_above(&p, at, foot, ff_target_ankle(rig, &feet[foot]), STAND_REACH));
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
