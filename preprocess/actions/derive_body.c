#include "preprocess/actions/derive_body.h"

#include <string.h>

static void find_feet(const ff_rig *rig, ff_derive_body *b)
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
ff_derive_body ff_derive_example_body(const ff_rig *rig, const ff_example *example, double phase,
                                      ff_vec3 root)
{
    ff_derive_body b = {.root = root};
    ff_example_sample(example, phase, &b.hips, b.local);
    find_feet(rig, &b);
    return b;
}

ff_foot_target ff_derive_mix_feet(const ff_foot_target *p, const ff_foot_target *q, double t)
{
    return (ff_foot_target){ff_lerp3(p->ball, q->ball, t), ff_quat_slerp(p->rotation, q->rotation, t),
                            ff_quat_slerp(p->toes, q->toes, t)};
}

/* All but the feet. */
void ff_derive_mix_bodies(const ff_derive_body *p, const ff_derive_body *q, double t, ff_derive_body *out)
{
    out->hips = ff_lerp3(p->hips, q->hips, t);
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        out->local[r] = ff_quat_slerp(p->local[r], q->local[r], t);
}

/* A foot on its way: t from 0 to 1. Its heel comes up first. */
ff_foot_target ff_derive_swing(const ff_foot_target *from, const ff_foot_target *to, double t, double lift,
                               double rise)
{
    ff_foot_target at = ff_derive_mix_feet(from, to, ff_smooth(t));
    double high = ff_sin(FF_PI * ff_clamp(t, 0.0, 1.0)), heel = ff_sin(FF_PI * ff_clamp(1.6 * t, 0.0, 1.0));
    at.ball.y += lift * high * high;
    at.rotation = ff_quat_mul(at.rotation, ff_quat_axis(ff_v3(1.0, 0.0, 0.0), rise * heel * heel));
    return at;
}

/* Lower the hips until both legs reach their feet, then pose the legs. */
void ff_derive_put_frame(const ff_rig *rig, const ff_derive_body *b, int k, ff_motion *motion)
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

ff_derive_body ff_derive_stand_body(const ff_derive_base *base, ff_vec3 root)
{
    return ff_derive_example_body(base->rig, base->stand, 0.0, root);
}

int ff_derive_frames(double seconds)
{
    return (int)floor(seconds * FF_DERIVE_RATE + 0.5) + 1;
}

/* Cubic from x0 with slope v0 to x1 with slope v1 over seconds. */
double ff_derive_hermite(double x0, double v0, double x1, double v1, double t, double seconds)
{
    double s = ff_clamp(t / seconds, 0.0, 1.0), s2 = s * s, s3 = s2 * s;
    return (2.0 * s3 - 3.0 * s2 + 1.0) * x0 + (s3 - 2.0 * s2 + s) * seconds * v0 +
           (3.0 * s2 - 2.0 * s3) * x1 + (s3 - s2) * seconds * v1;
}

/* Of the leg, of which ducking lowers the hips, and moves them back over the feet that stay flat. */
static const double DOWN = 0.48, BACK = 0.10;
static const double LEAN = 0.95;   /* rad, of the trunk, by hips, spine and chest */
static const double LOOK_UP = 0.5; /* of it, that neck and head take back */
static const double REACH = 0.5;   /* rad, of the arms forward: they balance the hips */

static const double GO_DOWN = 0.50, STAY = 0.80; /* s: faster would be a fall */

static void lean(ff_derive_body *body, int role, double angle)
{
    body->local[role] = ff_quat_mul(ff_quat_axis(ff_v3(1.0, 0.0, 0.0), angle), body->local[role]);
}

void ff_derive_crouch(const ff_rig *rig, double share, ff_derive_body *body)
{
    body->hips.z -= share * DOWN * rig->leg;
    body->hips.x -= share * BACK * rig->leg;
    lean(body, FF_ROLE_HIPS, 0.4 * share * LEAN);
    lean(body, FF_ROLE_SPINE, 0.35 * share * LEAN);
    lean(body, FF_ROLE_CHEST, 0.25 * share * LEAN);
    lean(body, FF_ROLE_NECK, -0.5 * share * LOOK_UP * LEAN);
    lean(body, FF_ROLE_HEAD, -0.5 * share * LOOK_UP * LEAN);
    lean(body, FF_ROLE_SHOULDER_L, -share * REACH);
    lean(body, FF_ROLE_SHOULDER_R, -share * REACH);
}

double ff_derive_ducked(double time)
{
    double rises = GO_DOWN + STAY;
    return time < rises ? ff_smooth(time / GO_DOWN)
                        : 1.0 - ff_smooth((time - rises) / (FF_DERIVE_DUCK - rises));
}
