#include "preprocess/examples/loop.h"

#include "runtime/core/base/fail.h"

#include <string.h>

/* Travel within this angle of straight ahead (or back) counts as straight (algorithms A.10). */
#define STRAIGHT_ANGLE (15.0 * FF_DEG)
#define SPEED_SPAN (1.0 / 60.0) /* s */
#define SPEED_COUNTS 0.1        /* m per m/s: what a change of velocity adds to the cost of a cut (A.12) */

static void steady_at(const ff_steady_root *root, double t, ff_vec2 *position, double *heading)
{
    *heading = root->heading + root->turn * t;
    *position = ff_add2(root->origin,
                        ff_from_frame2(ff_fwd2(root->heading), ff_root_arc(root->velocity, root->turn, t)));
}

/* Turn the root's frame by angle: the path stays, the components change. */
static void turn_frame(ff_steady_root *root, double angle)
{
    root->heading += angle;
    root->velocity = ff_from_frame2(ff_fwd2(-angle), root->velocity);
}

/* Mean over the cycle of the body's heading and hips relative to the root. */
static void mean_residual(const ff_motion *motion, const ff_stretch *c, const ff_steady_root *root,
                          double *turn, ff_vec2 *away)
{
    *turn = 0.0;
    *away = ff_v2(0.0, 0.0);
    for (int k = 0; k < c->length; ++k) {
        ff_vec3 r = motion->root[c->start + k], h = motion->hips[c->start + k];
        ff_vec2 at, hips = ff_add2(ff_v2(r.x, r.y), ff_from_frame2(ff_fwd2(r.z), ff_v2(h.x, h.y)));
        double heading;
        steady_at(root, k, &at, &heading);
        *turn += (r.z - heading) / c->length;
        *away = ff_madd2(*away, ff_to_frame2(ff_fwd2(heading), ff_sub2(hips, at)), 1.0 / c->length);
    }
}

/* The constant-rate root through the smoothed root at both ends of the cycle, then shifted and turned so that hips
 * and facing are on it on average. Walks within 15 degrees of straight ahead or back face along their path. */
ff_steady_root ff_steady_root_fit(const ff_motion *motion, const ff_stretch *c)
{
    ff_vec3 r0 = motion->root[c->start], r1 = motion->root[c->start + c->length];
    double t = c->length, turn = (r1.z - r0.z) / t;
    ff_vec2 chord = ff_to_frame2(ff_fwd2(r0.z), ff_sub2(ff_v2(r1.x, r1.y), ff_v2(r0.x, r0.y)));
    ff_vec2 ahead = ff_root_arc(ff_v2(1.0, 0.0), turn, t); /* of a unit velocity: a rotation times a length */
    ff_steady_root root = {ff_v2(r0.x, r0.y),
                           ff_scale2(ff_to_frame2(ahead, chord), 1.0 / ff_dot2(ahead, ahead)), r0.z, turn};
    double angle;
    ff_vec2 away;
    mean_residual(motion, c, &root, &angle, &away);
    turn_frame(&root, angle);
    double speed = ff_length2(root.velocity) / motion->frame_time;
    double direction = ff_atan2(root.velocity.b, root.velocity.a);
    double from_back = ff_wrap(direction + FF_PI);
    if (speed > 0.2 && fabs(direction) < STRAIGHT_ANGLE) turn_frame(&root, direction);
    if (speed > 0.2 && fabs(from_back) < STRAIGHT_ANGLE) turn_frame(&root, from_back);
    mean_residual(motion, c, &root, &angle, &away);
    root.origin = ff_add2(root.origin, ff_from_frame2(ff_fwd2(root.heading), away));
    root.velocity = ff_madd2(root.velocity, ff_left2(away), root.turn);
    return root;
}

ff_steady_root ff_steady_root_half(const ff_motion *motion, const ff_stretch *c)
{
    ff_vec3 r0 = motion->root[c->start], r1 = motion->root[c->start + c->length];
    ff_vec2 chord = ff_v2(r1.x - r0.x, r1.y - r0.y);
    ff_steady_root root = {.heading = 0.5 * (r0.z + r1.z)};
    ff_vec2 axis = ff_fwd2(root.heading);
    root.velocity = ff_v2(ff_dot2(chord, axis) / c->length, 0.0);
    /* Through the middle of the chord: what is aside of it at the start is as far aside at the end. */
    ff_vec2 middle = ff_v2(0.5 * (r0.x + r1.x), 0.5 * (r0.y + r1.y));
    root.origin = ff_madd2(middle, axis, -0.5 * root.velocity.a * c->length);
    double angle;
    ff_vec2 away;
    mean_residual(motion, c, &root, &angle, &away);
    root.origin = ff_madd2(root.origin, axis, away.a);
    return root;
}

ff_steady_root ff_steady_root_of(const ff_motion *motion, const ff_stretch *c)
{
    return c->half ? ff_steady_root_half(motion, c) : ff_steady_root_fit(motion, c);
}

static double wander(const ff_motion *motion, const ff_stretch *c, const ff_steady_root *root)
{
    double angle, worst = 0.0, heading;
    ff_vec2 away;
    mean_residual(motion, c, root, &angle, &away);
    for (int k = 0; k <= c->length; ++k) {
        steady_at(root, k, &away, &heading);
        worst = ff_max(worst, fabs(motion->root[c->start + k].z - heading - angle));
    }
    return worst;
}

ff_steady_root ff_steady_root_still(const ff_motion *motion, const ff_stretch *c)
{
    ff_vec3 r0 = motion->root[c->start];
    ff_steady_root root = {ff_v2(r0.x, r0.y), ff_v2(0.0, 0.0), r0.z, 0.0};
    double angle;
    ff_vec2 away;
    mean_residual(motion, c, &root, &angle, &away);
    turn_frame(&root, angle);
    mean_residual(motion, c, &root, &angle, &away);
    root.origin = ff_add2(root.origin, ff_from_frame2(ff_fwd2(root.heading), away));
    return root;
}

/* ------------------------------------------------------------------------------------------------- the poses */

static void residual_pose(const ff_motion *motion, const ff_stretch *c, const ff_steady_root *root, double t,
                          ff_vec3 *hips, ff_quat *rotations)
{
    ff_vec3 r, h;
    ff_motion_sample(motion, c->start + t, &r, &h, rotations);
    ff_vec2 at, place = ff_add2(ff_v2(r.x, r.y), ff_from_frame2(ff_fwd2(r.z), ff_v2(h.x, h.y)));
    double heading;
    steady_at(root, t, &at, &heading);
    ff_vec2 own = ff_to_frame2(ff_fwd2(heading), ff_sub2(place, at));
    *hips = ff_v3(own.a, own.b, h.z);
    rotations[0] = ff_quat_mul(ff_quat_yaw(r.z - heading), rotations[0]);
}

static void joints_of(const ff_rig *rig, ff_vec3 hips, const ff_quat *local, ff_vec3 *at)
{
    ff_quat world[FF_ROLE_JOINT_COUNT];
    world[0] = local[0];
    for (int r = 1; r < FF_ROLE_JOINT_COUNT; ++r)
        world[r] = ff_quat_mul(world[ff_role_parent((ff_role)r)], local[r]);
    ff_rig_pose(rig, ff_v3(hips.y, hips.z, hips.x), world, at);
}

static double farthest(const ff_vec3 *p, const ff_vec3 *q)
{
    double most = 0.0;
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        most = ff_max(most, ff_length3(ff_sub3(p[r], q[r])));
    return most;
}

/* What is missing at the end of the cycle to be back at its start: [1] as the end sees it, [0] as the start does, which is
 * the same, or of half a cycle its mirror image. */
typedef struct gap {
    ff_vec3 hips[2], turn[2][FF_ROLE_JOINT_COUNT];
    double mean, most; /* m, over the joints */
} gap;

/* What the end of the stretch has to meet: the pose at t, of half a cycle its mirror image. */
static void next_pose(const ff_motion *motion, const ff_stretch *c, const ff_steady_root *root, double t,
                      ff_vec3 *hips, ff_quat *rotations)
{
    ff_quat own[FF_ROLE_JOINT_COUNT];
    ff_vec3 at;
    residual_pose(motion, c, root, t, hips, rotations);
    if (!c->half) return;
    at = *hips;
    memcpy(own, rotations, sizeof own);
    ff_pose_mirror(&at, own, hips, rotations);
}

static void see_from_start(const ff_stretch *c, gap *g)
{
    ff_vec3 h = g->hips[1];
    g->hips[0] = c->half ? ff_v3(h.x, -h.y, h.z) : h;
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
        ff_vec3 t = g->turn[1][c->half ? ff_role_mirror((ff_role)r) : (ff_role)r];
        g->turn[0][r] = c->half ? ff_v3(t.x, -t.y, -t.z) : t;
    }
}

static gap measure_gap(const ff_rig *rig, const ff_motion *motion, const ff_stretch *c,
                       const ff_steady_root *root)
{
    ff_quat first[FF_ROLE_JOINT_COUNT], last[FF_ROLE_JOINT_COUNT];
    ff_vec3 hips0, hips1, at0[FF_BODY_COUNT], at1[FF_BODY_COUNT];
    next_pose(motion, c, root, 0.0, &hips0, first);
    residual_pose(motion, c, root, c->length, &hips1, last);
    gap out = {.hips = {[1] = ff_sub3(hips0, hips1)}};
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        out.turn[1][r] = ff_quat_log(ff_quat_mul(ff_quat_conj(last[r]), first[r]));
    see_from_start(c, &out);
    joints_of(rig, hips0, first, at0);
    joints_of(rig, hips1, last, at1);
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        out.mean += ff_length3(ff_sub3(at1[r], at0[r])) / FF_ROLE_JOINT_COUNT;
    out.most = farthest(at0, at1);
    return out;
}

/* How much the joints' velocities (m/s, mean) differ at the end from those at the start. */
static double measure_kick(const ff_rig *rig, const ff_motion *motion, const ff_stretch *c,
                           const ff_steady_root *root)
{
    double span = SPEED_SPAN / motion->frame_time, sum = 0.0;
    const double when[4] = {span, -span, c->length + span, c->length - span};
    ff_vec3 at[4][FF_BODY_COUNT], hips;
    ff_quat local[FF_ROLE_JOINT_COUNT];
    for (int i = 0; i < 4; ++i) {
        (i < 2 ? next_pose : residual_pose)(motion, c, root, when[i], &hips, local);
        joints_of(rig, hips, local, at[i]);
    }
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        sum += ff_length3(ff_sub3(ff_sub3(at[0][r], at[1][r]), ff_sub3(at[2][r], at[3][r])));
    return sum / (2.0 * SPEED_SPAN * FF_ROLE_JOINT_COUNT);
}

/* Spread the gap linearly over the stretch: half of it lies before, half after its middle. */
static void close_pose(const gap *missing, double share, ff_vec3 *hips, ff_quat *local)
{
    double before = 0.5 * share - 0.5, after = 0.5 * share;
    *hips = ff_madd3(ff_madd3(*hips, missing->hips[0], before), missing->hips[1], after);
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
        ff_vec3 turn = ff_madd3(ff_scale3(missing->turn[0][r], before), missing->turn[1][r], after);
        local[r] = ff_quat_mul(local[r], ff_quat_exp(turn));
    }
}

/* The closed pose at a share [0, 1) of the cycle. */
static void closed_pose(const ff_motion *motion, const ff_stretch *c, const ff_steady_root *root,
                        const gap *missing, double share, ff_vec3 *hips, ff_quat *local)
{
    double within = c->half ? 2.0 * share : share;
    bool again = within >= 1.0;
    if (again) within -= 1.0;
    residual_pose(motion, c, root, within * c->length, hips, local);
    close_pose(missing, within, hips, local);
    if (!again) return;
    ff_quat own[FF_ROLE_JOINT_COUNT];
    ff_vec3 at = *hips;
    memcpy(own, local, sizeof own);
    ff_pose_mirror(&at, own, hips, local);
}

/* Closed poses at near 60 Hz, frame 0 at the share `first` of the cycle. */
static void fill_poses(const ff_motion *motion, const ff_stretch *c, const ff_steady_root *root,
                       const gap *missing, double first, ff_example *out)
{
    for (int k = 0; k < out->frame_count; ++k) {
        double share = first + k / (double)out->frame_count;
        share -= floor(share);
        ff_quat *local = out->rotations + (size_t)k * FF_ROLE_JOINT_COUNT;
        closed_pose(motion, c, root, missing, share, &out->hips[k], local);
        for (int r = 0; r < FF_ROLE_JOINT_COUNT && k > 0; ++r)
            if (ff_quat_dot(local[r], local[r - FF_ROLE_JOINT_COUNT]) < 0.0)
                local[r] = (ff_quat){-local[r].x, -local[r].y, -local[r].z, -local[r].w};
    }
}

/* What closing did: how far it moved any joint, and what is left between the last and the first pose. */
static void measure_closing(const ff_rig *rig, const ff_motion *motion, const ff_stretch *c,
                            const ff_steady_root *root, const gap *missing, ff_pack_loop *out)
{
    enum { SAMPLES = 16 };
    ff_vec3 before[FF_BODY_COUNT], after[FF_BODY_COUNT], first[FF_BODY_COUNT], hips;
    ff_quat local[FF_ROLE_JOINT_COUNT];
    *out = (ff_pack_loop){0};
    closed_pose(motion, c, root, missing, c->half ? 0.5 : 0.0, &hips, local);
    joints_of(rig, hips, local, first);
    for (int k = 0; k <= SAMPLES; ++k) {
        double share = k / (double)SAMPLES;
        residual_pose(motion, c, root, share * c->length, &hips, local);
        joints_of(rig, hips, local, before);
        close_pose(missing, share, &hips, local);
        joints_of(rig, hips, local, after);
        out->moved = (float)ff_max((double)out->moved, farthest(before, after));
    }
    out->jump = (float)farthest(first, after);
}

double ff_loop_seam(const ff_rig *rig, const ff_motion *motion, const ff_stretch *c,
                    const ff_steady_root *root)
{
    return measure_gap(rig, motion, c, root).mean;
}

double ff_loop_cost(const ff_rig *rig, const ff_motion *motion, const ff_stretch *c)
{
    ff_steady_root root = ff_steady_root_of(motion, c);
    gap missing = measure_gap(rig, motion, c, &root);
    return missing.mean + 0.5 * missing.most + SPEED_COUNTS * measure_kick(rig, motion, c, &root);
}

ff_status ff_loop_close(const ff_rig *rig, const ff_motion *motion, const ff_stretch *c,
                        const ff_steady_root *root, double first, ff_example *out, ff_error *error)
{
    double period = (c->half ? 2.0 : 1.0) * c->length * motion->frame_time, rate = 1.0 / motion->frame_time;
    ff_status status = ff_example_alloc(out, (int)floor(period * FF_PACK_RATE + 0.5), error);
    if (status != FF_OK) return status;
    gap missing = measure_gap(rig, motion, c, root);
    measure_closing(rig, motion, c, root, &missing, &out->loop);
    out->loop.cut_kick = (float)measure_kick(rig, motion, c, root);
    out->loop.cut = (float)(first > 0.0 ? 1.0 - first : 0.0);
    fill_poses(motion, c, root, &missing, first, out);
    ff_example_level_head(out);
    ff_pack_example *record = &out->record;
    record->period = (float)period;
    record->v_forward = (float)(root->velocity.a * rate);
    record->v_left = (float)(root->velocity.b * rate);
    record->turn_rate = (float)(root->turn * rate);
    record->seam = (float)missing.mean;
    out->first_frame = c->start;
    out->wander = wander(motion, c, root);
    status = ff_example_smooth(out, error);
    if (status != FF_OK) ff_example_free(out);
    return status;
}
