#include "preprocess/loop.h"

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

/* What is missing at the end of the cycle to be back at its start. */
typedef struct gap {
    ff_vec3 hips, turn[FF_ROLE_JOINT_COUNT];
    double mean, most; /* m, over the joints */
} gap;

static gap measure_gap(const ff_rig *rig, const ff_motion *motion, const ff_stretch *c,
                       const ff_steady_root *root)
{
    ff_quat first[FF_ROLE_JOINT_COUNT], last[FF_ROLE_JOINT_COUNT];
    ff_vec3 hips0, hips1, at0[FF_BODY_COUNT], at1[FF_BODY_COUNT];
    residual_pose(motion, c, root, 0.0, &hips0, first);
    residual_pose(motion, c, root, c->length, &hips1, last);
    gap out = {.hips = ff_sub3(hips0, hips1)};
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        out.turn[r] = ff_quat_log(ff_quat_mul(ff_quat_conj(last[r]), first[r]));
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
        residual_pose(motion, c, root, when[i], &hips, local);
        joints_of(rig, hips, local, at[i]);
    }
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        sum += ff_length3(ff_sub3(ff_sub3(at[0][r], at[1][r]), ff_sub3(at[2][r], at[3][r])));
    return sum / (2.0 * SPEED_SPAN * FF_ROLE_JOINT_COUNT);
}

/* Spread the gap linearly over the stretch: half of it lies before, half after its middle. */
static void close_pose(const gap *missing, double share, ff_vec3 *hips, ff_quat *local)
{
    *hips = ff_madd3(*hips, missing->hips, share - 0.5);
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        local[r] = ff_quat_mul(local[r], ff_quat_exp(ff_scale3(missing->turn[r], share - 0.5)));
}

/* Closed poses at near 60 Hz, frame 0 at the share `first` of the stretch. */
static void fill_poses(const ff_motion *motion, const ff_stretch *c, const ff_steady_root *root,
                       const gap *missing, double first, ff_example *out)
{
    for (int k = 0; k < out->frame_count; ++k) {
        double share = first + k / (double)out->frame_count;
        share -= floor(share);
        ff_quat *local = out->rotations + (size_t)k * FF_ROLE_JOINT_COUNT;
        residual_pose(motion, c, root, share * c->length, &out->hips[k], local);
        close_pose(missing, share, &out->hips[k], local);
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
    for (int k = 0; k <= SAMPLES; ++k) {
        double share = k / (double)SAMPLES;
        residual_pose(motion, c, root, share * c->length, &hips, local);
        joints_of(rig, hips, local, before);
        close_pose(missing, share, &hips, local);
        joints_of(rig, hips, local, after);
        out->moved = (float)ff_max((double)out->moved, farthest(before, after));
        if (k == 0) memcpy(first, after, sizeof first);
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
    ff_steady_root root = ff_steady_root_fit(motion, c);
    gap missing = measure_gap(rig, motion, c, &root);
    return missing.mean + 0.5 * missing.most + SPEED_COUNTS * measure_kick(rig, motion, c, &root);
}

ff_status ff_loop_close(const ff_rig *rig, const ff_motion *motion, const ff_stretch *c,
                        const ff_steady_root *root, double first, ff_example *out, ff_error *error)
{
    double period = c->length * motion->frame_time, rate = 1.0 / motion->frame_time;
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
