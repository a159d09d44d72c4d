#include "preprocess/clean/clean_foot.h"

#include <string.h>

void ff_clean_pose_read(const ff_motion *motion, int frame, ff_clean_pose *out)
{
    ff_vec3 root = motion->root[frame], hips = motion->hips[frame];
    const ff_quat *local = motion->rotations + (size_t)frame * FF_ROLE_JOINT_COUNT;
    ff_vec2 at = ff_add2(ff_v2(root.x, root.y), ff_from_frame2(ff_fwd2(root.z), ff_v2(hips.x, hips.y)));
    out->hips = ff_ground(at, hips.z);
    out->pelvis = ff_quat_mul(ff_quat_yaw(root.z), local[FF_ROLE_HIPS]);
    for (int side = 0; side < 2; ++side) {
        for (int j = 0; j < FF_LEG_JOINTS; ++j)
            out->legs[side][j] = local[ff_leg_role(side, j)];
        out->flexion[side] = ff_knee_flexion(out->legs[side][FF_LEG_KNEE]);
    }
}

void ff_clean_pose_write(const ff_clean_pose *pose, ff_motion *motion, int frame)
{
    ff_vec3 root = motion->root[frame];
    ff_quat *local = motion->rotations + (size_t)frame * FF_ROLE_JOINT_COUNT;
    ff_vec2 own = ff_to_frame2(ff_fwd2(root.z), ff_sub2(ff_plane(pose->hips), ff_v2(root.x, root.y)));
    motion->hips[frame] = ff_v3(own.a, own.b, pose->hips.y);
    for (int j = -1; j < 2 * FF_LEG_JOINTS; ++j) {
        int role = j < 0 ? (int)FF_ROLE_HIPS : ff_leg_role(j / FF_LEG_JOINTS, j % FF_LEG_JOINTS);
        ff_quat q = j < 0 ? ff_quat_mul(ff_quat_yaw(-root.z), pose->pelvis)
                          : pose->legs[j / FF_LEG_JOINTS][j % FF_LEG_JOINTS];
        /* the sign the motion has already, so that neighbouring frames can be mixed component by component */
        if (ff_quat_dot(q, local[role]) < 0.0) q = (ff_quat){-q.x, -q.y, -q.z, -q.w};
        local[role] = ff_quat_unit(q);
    }
}

static ff_quat turn_by(ff_quat q, const double *d)
{
    return ff_quat_mul(q, ff_quat_exp(ff_v3(d[0], d[1], d[2])));
}

void ff_clean_pose_change(ff_clean_pose *pose, const double *root, const double *legs)
{
    const ff_vec3 x = {1.0, 0.0, 0.0};
    pose->hips = ff_add3(pose->hips, ff_v3(root[0], root[1], root[2]));
    pose->pelvis = turn_by(pose->pelvis, root + 3);
    for (int side = 0; side < 2; ++side) {
        const double *d = legs + (size_t)side * FF_CLEAN_LEG;
        ff_quat *leg = pose->legs[side];
        leg[FF_LEG_HIP] = turn_by(leg[FF_LEG_HIP], d);
        leg[FF_LEG_KNEE] = ff_quat_mul(leg[FF_LEG_KNEE], ff_quat_axis(x, d[FF_CLEAN_KNEE]));
        leg[FF_LEG_ANKLE] = turn_by(leg[FF_LEG_ANKLE], d + 4);
        leg[FF_LEG_BALL] = ff_quat_mul(leg[FF_LEG_BALL], ff_quat_axis(x, d[7]));
        pose->flexion[side] += d[FF_CLEAN_KNEE];
    }
}

double ff_knee_flexion(ff_quat knee)
{
    /* thigh direction seen from the shank; both bones hang along -Y at rest */
    ff_vec3 thigh = ff_quat_rotate(ff_quat_conj(knee), ff_v3(0.0, -1.0, 0.0));
    return ff_atan2(thigh.z, -thigh.y);
}

double ff_foot_reach(const ff_rig *rig, double rise)
{
    double length = ff_length3(ff_sub3(rig->offset[FF_ROLE_BALL_L], rig->offset[FF_BODY_HEEL_L]));
    return sqrt(ff_max(length * length - rise * rise, 0.0));
}

/* J = I - (1 - cos t)/t^2 [v] + (t - sin t)/t^3 [v]^2, t = |v| (the right Jacobian of SO(3)). */
void ff_rotation_slope(ff_vec3 v, ff_vec3 *columns)
{
    double t2 = ff_dot3(v, v), t = sqrt(t2), first = 0.5 - t2 / 24.0, second = 1.0 / 6.0 - t2 / 120.0;
    if (t > 1e-2) {
        double s, c;
        ff_sincos(t, &s, &c);
        first = (1.0 - c) / t2;
        second = (t - s) / (t2 * t);
    }
    const ff_vec3 axes[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    for (int i = 0; i < 3; ++i) {
        ff_vec3 once = ff_cross3(v, axes[i]), twice = ff_cross3(v, once);
        columns[i] = ff_madd3(ff_madd3(axes[i], once, -first), twice, second);
    }
}

/* One joint on the way down: where it is, how it is turned, and about which world axes its unknowns turn it. */
typedef struct link {
    ff_vec3 at;
    ff_quat turned;
    ff_vec3 axes[3];
    int axis_count;
} link;

static link ball_joint(ff_vec3 at, ff_quat before, const double *d, bool slopes)
{
    ff_vec3 v = ff_v3(d[0], d[1], d[2]);
    link joint = {.at = at, .turned = ff_quat_mul(before, ff_quat_exp(v)), .axis_count = 3};
    if (!slopes) return joint;
    ff_rotation_slope(v, joint.axes);
    for (int i = 0; i < 3; ++i)
        joint.axes[i] = ff_quat_rotate(joint.turned, joint.axes[i]);
    return joint;
}

static link hinge_joint(ff_vec3 at, ff_quat before, double d)
{
    const ff_vec3 x = {1.0, 0.0, 0.0};
    return (link){.at = at,
                  .turned = ff_quat_mul(before, ff_quat_axis(x, d)),
                  .axes = {ff_quat_rotate(before, x)},
                  .axis_count = 1};
}

static ff_vec3 below(const link *joint, ff_vec3 offset)
{
    return ff_add3(joint->at, ff_quat_rotate(joint->turned, offset));
}

/* How place moves when the joint turns: axis x arm. out[coordinate * width] for each axis. */
static void put_slopes(const link *joint, ff_vec3 place, double *out, int width)
{
    ff_vec3 arm = ff_sub3(place, joint->at);
    for (int i = 0; i < joint->axis_count; ++i) {
        ff_vec3 moved = ff_cross3(joint->axes[i], arm);
        out[i] = moved.x;
        out[width + i] = moved.y;
        out[2 * width + i] = moved.z;
    }
}

void ff_clean_foot(const ff_rig *rig, const ff_clean_pose *pose, int side, const double *root,
                   const double *leg, ff_vec3 *places, ff_clean_slopes *slopes)
{
    const ff_quat *local = pose->legs[side];
    const ff_vec3 *offset = rig->offset;
    bool wanted = slopes != NULL;
    int first = ff_leg_role(side, FF_LEG_HIP);
    ff_vec3 hips = ff_add3(pose->hips, ff_v3(root[0], root[1], root[2]));
    link pelvis = ball_joint(hips, pose->pelvis, root + 3, wanted);
    link hip =
        ball_joint(below(&pelvis, offset[first]), ff_quat_mul(pelvis.turned, local[FF_LEG_HIP]), leg, wanted);
    link knee = hinge_joint(below(&hip, offset[first + FF_LEG_KNEE]),
                            ff_quat_mul(hip.turned, local[FF_LEG_KNEE]), leg[FF_CLEAN_KNEE]);
    link ankle = ball_joint(below(&knee, offset[first + FF_LEG_ANKLE]),
                            ff_quat_mul(knee.turned, local[FF_LEG_ANKLE]), leg + 4, wanted);
    places[FF_FOOT_AT_HEEL] = below(&ankle, offset[side == FF_LEFT ? FF_BODY_HEEL_L : FF_BODY_HEEL_R]);
    places[FF_FOOT_AT_BALL] = below(&ankle, offset[first + FF_LEG_BALL]);
    link ball = hinge_joint(places[FF_FOOT_AT_BALL], ff_quat_mul(ankle.turned, local[FF_LEG_BALL]), leg[7]);
    places[FF_FOOT_AT_TOE] = below(&ball, offset[side == FF_LEFT ? FF_ROLE_TOE_L : FF_ROLE_TOE_R]);
    if (!wanted) return;
    memset(slopes, 0, sizeof *slopes);
    for (int p = 0; p < FF_FOOT_PLACES; ++p) {
        double *on_root = slopes->root[p][0], *on_leg = slopes->leg[p][0];
        for (int i = 0; i < 3; ++i)
            slopes->root[p][i][i] = 1.0;
        put_slopes(&pelvis, places[p], on_root + 3, FF_CLEAN_ROOT);
        put_slopes(&hip, places[p], on_leg, FF_CLEAN_LEG);
        put_slopes(&knee, places[p], on_leg + FF_CLEAN_KNEE, FF_CLEAN_LEG);
        put_slopes(&ankle, places[p], on_leg + 4, FF_CLEAN_LEG);
        if (p == FF_FOOT_AT_TOE) put_slopes(&ball, places[p], on_leg + 7, FF_CLEAN_LEG);
    }
}
