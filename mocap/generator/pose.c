#include "mocap/generator/pose.h"
#include "mocap/generator/curves.h"
#include "mocap/generator/feet.h"
#include "mocap/generator/skeleton.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/base/random.h"

#include <stdlib.h>

#define KNEE_LEAST (8.0 * FF_DEG) /* soft knees: gait facts give 6 to 10 degrees least flexion in walking */
#define KNEE_LEAST_RUN (16.0 * FF_DEG) /* and 17 to 20 in running */
#define STAND_HEIGHT 0.9945            /* hips over the ankles of someone who stands, leg lengths */
#define REACH_WINDOW_SIDE 0.17         /* in side steps hips sink with every wide stance */
#define REACH_WINDOW 0.38 /* s, half the time over which lowered hips spread: over a quarter of any cycle */

static const ff_vec3 axis_x = {1, 0, 0}, axis_z = {0, 0, 1};

/* Everything about one frame that the parts of the body share. Angles in radians, world space. */
typedef struct ff_frame {
    double t, phase;
    ff_root root;
    ff_gait_set set;
    double moving;     /* 0 = stands, 1 = walks */
    double lean_left;  /* body into a turn */
    double lean_front; /* into acceleration */
    double breath, sway[2];
    ff_gesture gesture;
    double bend; /* trunk forward, by style and gesture */
    ff_foot_pose foot[2];
    ff_quat pelvis;
    ff_vec3 hips; /* the root joint; y before lowering */
    ff_quat world[FF_ROLE_COUNT];
} ff_frame;

static double curve(const ff_frame *frame, ff_curve which)
{
    return ff_fourier_at(&frame->set.curve[which], frame->phase);
}
static double limb(const ff_frame *frame, ff_curve which, int side)
{
    return ff_fourier_at(&frame->set.curve[which], frame->phase + (side == 0 ? 0.0 : 0.5));
}

/* Ry(yaw) Rx(pitch forward) Rz(roll, left side up): the order of the measured curves. */
static ff_quat turned(double yaw, double pitch, double roll)
{
    return ff_quat_mul(ff_quat_mul(ff_quat_yaw(yaw), ff_quat_axis(axis_x, pitch)),
                       ff_quat_axis(axis_z, roll));
}

/* ------------------------------------------------------------------------------------------- whole body */

/* Slow aimless sway of a standing person: sums of sines with periods from 3 to 11 s (no common period). */
static double slow_noise(uint64_t seed, uint64_t stream, double t)
{
    double sum = 0.0;
    for (uint64_t k = 0; k < 4; ++k) {
        ff_random random = {seed, stream, 2 * k};
        double period = 3.0 + 2.2 * (double)k + ff_random_range(&random, 0.0, 0.8);
        sum += ff_sin(FF_TAU * (t / period + ff_random_unit(&random))) * (0.35 + 0.22 * (double)k);
    }
    return 0.6 * sum;
}

/* Weight put on one leg, then on the other: stays at either side, and crosses within a second or so. */
static double weight_shift(const ff_plan *plan, double t)
{
    double wave = 2.2 * ff_sin(FF_TAU * t / 7.6);
    return plan->style.shift * (ff_smooth(0.5 + 0.5 * wave) * 2.0 - 1.0);
}

static void start_frame(const ff_plan *plan, double t, ff_frame *frame)
{
    frame->t = t;
    frame->root = ff_plan_root(plan, t);
    frame->phase = ff_plan_phase(plan, t);
    const ff_root *root = &frame->root;
    double side = 0.8 * root->left, spot = 0.35 * root->turn;
    double speed = sqrt(root->forward * root->forward + side * side + spot * spot);
    if (plan->jump) speed = 0.0; /* the gesture is the whole motion */
    ff_gait_set_at(plan->style.person, speed, plan->style.run, &frame->set);
    frame->moving = ff_smooth(speed / 0.5);
    /* the line from feet to hips leans 1.15, the trunk 0.5 times the angle of the turn's acceleration */
    frame->lean_left =
        ff_atan2(root->forward * root->turn, 9.81) + 0.10 * root->left; /* and into side steps */
    ff_root before = ff_plan_root(plan, t - 0.12), after = ff_plan_root(plan, t + 0.12);
    frame->lean_front = 0.6 * ff_atan2((after.forward - before.forward) / 0.24, 9.81);
    double still = plan->style.breathing * (1.0 - ff_smooth(speed / 0.2));
    frame->breath = plan->style.breathing * ff_sin(FF_TAU * t / 3.9);
    frame->sway[0] = 0.008 * still * slow_noise(plan->style.seed, 1, t);
    frame->sway[1] =
        plan->style.side * (0.016 * still * slow_noise(plan->style.seed, 2, t) + weight_shift(plan, t));
    frame->gesture = ff_plan_gesture(plan, t);
    frame->bend = plan->style.bend + frame->gesture.bend;
    for (int foot = 0; foot < 2; ++foot)
        frame->foot[foot] = ff_foot_at(plan, foot, t);
}

/* The pelvis sways over the standing foot. In slow steps people sway further, not less (fits.csv,
 * pelvis_lateral_range); sideways steps take the whole weight from foot to foot. */
static double sway_size(const ff_plan *plan, const ff_root *root)
{
    if (plan->style.run) return 1.0;
    double speed = sqrt(root->forward * root->forward + root->left * root->left);
    double range = ff_clamp(0.1035 - 0.0432 * speed, 0.03, 0.085) + 0.060 * ff_smooth(fabs(root->left) / 0.4);
    double there = ff_smooth((speed + 0.25 * fabs(root->turn)) / 0.25);
    double measured = 0.0597 * ff_clamp(speed / ff_band_speed[FF_BAND_SLOW], 0.2, 1.0);
    if (speed > ff_band_speed[FF_BAND_SLOW]) return 1.0;
    measured *= 1.5 - 0.5 * ff_clamp(speed / ff_band_speed[FF_BAND_SLOW], 0.0, 1.0);
    return there * range / measured;
}

static void pose_pelvis(const ff_plan *plan, ff_frame *frame)
{
    const ff_root *root = &frame->root;
    double speed = sqrt(root->forward * root->forward + root->left * root->left);
    double forwardness = speed > 1e-6 ? fabs(root->forward) / speed : 0.0;
    double side = sway_size(plan, root) * curve(frame, FF_CURVE_PELVIS_X) * FF_BODY_LEG;
    double ripple = curve(frame, FF_CURVE_PELVIS_Z) * FF_BODY_LEG;
    ff_vec2 way = speed > 1e-6 ? ff_v2(root->forward / speed, root->left / speed) : ff_v2(1.0, 0.0);
    ff_vec2 local = ff_v2(ripple * way.a + frame->sway[0], side + ripple * way.b + frame->sway[1]);
    local.a -= 0.06 * frame->bend; /* hips back as the trunk bends forward */
    double height = ff_lerp(STAND_HEIGHT, frame->set.curve[FF_CURVE_PELVIS_Y].c[0], frame->moving);
    if (!plan->style.run) /* small steps need no low hips */
        height = ff_lerp(height, ff_max(height, 0.980), 1.0 - ff_smooth((speed - 0.2) / 0.8));
    height += curve(frame, FF_CURVE_PELVIS_Y) - frame->set.curve[FF_CURVE_PELVIS_Y].c[0];
    ff_vec2 ground = ff_plan_to_world(root, local);
    ff_vec3 middle = ff_ground(ground, FF_BODY_ANKLE_HEIGHT + height * FF_BODY_LEG - plan->style.sink +
                                           frame->gesture.rise);
    double yaw = curve(frame, FF_CURVE_PELVIS_YAW) * forwardness;
    double pitch = curve(frame, FF_CURVE_PELVIS_PITCH_FWD) + 0.3 * frame->lean_front + 0.45 * frame->bend;
    double roll = curve(frame, FF_CURVE_PELVIS_ROLL) - 0.5 * frame->lean_left - 1.2 * frame->sway[1];
    frame->pelvis = turned(root->heading + yaw, pitch, roll);
    frame->hips =
        ff_add3(middle, ff_quat_rotate(frame->pelvis, ff_v3(0, FF_BODY_ROOT_UP, -FF_BODY_ROOT_BACK)));
}

static ff_vec3 hip_joint(const ff_frame *frame, int foot)
{
    ff_vec3 offset = ff_body_offset(foot == 0 ? FF_ROLE_HIP_L : FF_ROLE_HIP_R);
    return ff_add3(frame->hips, ff_quat_rotate(frame->pelvis, offset));
}

/* 0 = forward, 1 = side steps. */
static double sideways(const ff_root *root)
{
    double speed = sqrt(root->forward * root->forward + root->left * root->left);
    return fabs(root->left) / ff_max(speed, 0.3);
}

/* How far the hips must come down for both legs to reach their feet with soft knees, m. */
static double excess_height(const ff_plan *plan, const ff_frame *frame)
{
    double a = FF_BODY_THIGH, b = FF_BODY_SHANK, excess = 0.0;
    double least = plan->style.run ? KNEE_LEAST_RUN : KNEE_LEAST + 6.0 * FF_DEG * sideways(&frame->root);
    double reach2 = a * a + b * b + 2.0 * a * b * ff_cos(least);
    for (int foot = 0; foot < 2; ++foot) {
        ff_vec3 hip = hip_joint(frame, foot), ankle = frame->foot[foot].ankle;
        double flat2 = (hip.x - ankle.x) * (hip.x - ankle.x) + (hip.z - ankle.z) * (hip.z - ankle.z);
        double up = sqrt(ff_max(0.0, reach2 - flat2));
        excess = ff_max(excess, hip.y - ankle.y - up);
    }
    return excess;
}

/* --------------------------------------------------------------------------------------------------- legs */

/* Rotation with these axes as columns. */
static ff_quat from_axes(ff_vec3 x, ff_vec3 y, ff_vec3 z)
{
    double trace = x.x + y.y + z.z;
    ff_quat q;
    if (trace > 0.0) {
        q = (ff_quat){y.z - z.y, z.x - x.z, x.y - y.x, 1.0 + trace};
    } else if (x.x >= y.y && x.x >= z.z) {
        q = (ff_quat){1.0 + x.x - y.y - z.z, x.y + y.x, z.x + x.z, y.z - z.y};
    } else if (y.y >= z.z) {
        q = (ff_quat){x.y + y.x, 1.0 - x.x + y.y - z.z, y.z + z.y, z.x - x.z};
    } else {
        q = (ff_quat){z.x + x.z, y.z + z.y, 1.0 - x.x - y.y + z.z, x.y - y.x};
    }
    return ff_quat_unit(q);
}

/* Two bones from hip to ankle; the knee bends in the plane of the leg and forward, half way between where pelvis and
 * foot point. */
static void pose_leg(ff_frame *frame, int foot)
{
    const ff_role thigh = foot == 0 ? FF_ROLE_HIP_L : FF_ROLE_HIP_R;
    ff_vec3 hip = hip_joint(frame, foot), ankle = frame->foot[foot].ankle;
    ff_vec3 leg = ff_sub3(ankle, hip);
    double a = FF_BODY_THIGH, b = FF_BODY_SHANK, length = ff_clamp(ff_length3(leg), 0.3, (a + b) * 0.99999);
    ff_vec3 down = ff_unit3(leg);
    double pelvis_yaw = ff_quat_heading(frame->pelvis);
    double knee_yaw = pelvis_yaw + 0.5 * ff_wrap(frame->foot[foot].yaw - pelvis_yaw);
    ff_vec3 forward = ff_ground(ff_fwd2(knee_yaw), 0.0);
    ff_vec3 hinge = ff_unit3(ff_cross3(ff_scale3(down, -1.0), forward));
    ff_vec3 front = ff_cross3(hinge, ff_scale3(down, -1.0));
    double along = (a * a - b * b + length * length) / (2.0 * length);
    double out = sqrt(ff_max(0.0, a * a - along * along));
    ff_vec3 knee = ff_madd3(ff_scale3(down, along), front, out); /* relative to the hip */
    ff_vec3 up = ff_scale3(knee, -1.0 / a), shin_up = ff_scale3(ff_sub3(leg, knee), -1.0 / b);
    frame->world[thigh] = from_axes(hinge, up, ff_cross3(hinge, up));
    frame->world[thigh + 1] = from_axes(hinge, shin_up, ff_cross3(hinge, shin_up));
    frame->world[thigh + 2] = ff_foot_rotation(&frame->foot[foot]);
    frame->world[thigh + 3] =
        ff_quat_mul(frame->world[thigh + 2], ff_quat_axis(axis_x, -frame->foot[foot].toe_extension));
    frame->world[foot == 0 ? FF_ROLE_TOE_L : FF_ROLE_TOE_R] = frame->world[thigh + 3];
}

/* -------------------------------------------------------------------------------------------- upper body */

static void pose_trunk(const ff_plan *plan, ff_frame *frame)
{
    const ff_root *root = &frame->root;
    double bend = frame->bend, lean = 0.55 * frame->lean_left;
    double yaw = curve(frame, FF_CURVE_THORAX_YAW), pitch = curve(frame, FF_CURVE_THORAX_PITCH_FWD);
    pitch += frame->lean_front + bend + 0.5 * FF_DEG * frame->breath + 0.5 * frame->sway[0];
    double roll = curve(frame, FF_CURVE_THORAX_ROLL) - lean + 0.5 * frame->sway[1];
    if (plan->style.run) pitch += (8.9 * FF_DEG) * (root->forward - ff_band_speed[FF_BAND_RUN]);
    ff_quat chest = turned(root->heading + yaw, pitch, roll);
    /* the head goes with the body, a little ahead of it */
    double ahead = ff_clamp(0.12 * root->turn, -0.25, 0.25);
    double look = frame->moving < 1.0 ? plan->style.side * 0.11 * plan->style.breathing *
                                            (1.0 - frame->moving) * slow_noise(plan->style.seed, 3, frame->t)
                                      : 0.0;
    ff_quat head = turned(root->heading + curve(frame, FF_CURVE_HEAD_YAW) + ahead + look,
                          curve(frame, FF_CURVE_HEAD_PITCH_FWD) + 0.35 * bend + 0.2 * frame->lean_front,
                          curve(frame, FF_CURVE_HEAD_ROLL) - 0.3 * lean);
    frame->world[FF_ROLE_HIPS] = frame->pelvis;
    frame->world[FF_ROLE_SPINE] = ff_quat_nlerp(frame->pelvis, chest, 0.5);
    frame->world[FF_ROLE_CHEST] = chest;
    frame->world[FF_ROLE_NECK] = ff_quat_nlerp(chest, head, 0.5);
    frame->world[FF_ROLE_HEAD] = frame->world[FF_ROLE_HEAD_TOP] = head;
}

/* A measured arm curve, its swing around the mean resized. */
static double arm_curve(const ff_plan *plan, const ff_frame *frame, ff_curve which, int side)
{
    double mean = frame->set.curve[which].c[0];
    return mean + plan->style.arms * (limb(frame, which, side) - mean);
}

static void pose_arm(const ff_plan *plan, ff_frame *frame, int side)
{
    const ff_role shoulder = side == 0 ? FF_ROLE_SHOULDER_L : FF_ROLE_SHOULDER_R;
    double s = side == 0 ? 1.0 : -1.0, lifted = s * 1.2 * FF_DEG * frame->breath;
    ff_quat hang = ff_quat_axis(axis_z, -s * 0.5 * FF_PI); /* from the arm held out to the arm hanging */
    double flexion =
        arm_curve(plan, frame, FF_CURVE_SHOULDER_FLEXION, side) + 0.6 * frame->bend + frame->gesture.arms;
    double abduction = arm_curve(plan, frame, FF_CURVE_SHOULDER_ABDUCTION, side) + 2.0 * FF_DEG;
    double rotation = arm_curve(plan, frame, FF_CURVE_SHOULDER_ROTATION_IN, side);
    double elbow = arm_curve(plan, frame, FF_CURVE_ELBOW_FLEXION, side);
    if (!plan->style.run) elbow *= ff_lerp(0.55, 1.0, frame->moving);
    elbow = ff_max(elbow, 6.0 * FF_DEG);
    ff_quat arm = ff_quat_mul(frame->world[FF_ROLE_CHEST], ff_quat_axis(axis_x, -flexion));
    arm = ff_quat_mul(arm, ff_quat_axis(axis_z, s * abduction));
    arm = ff_quat_mul(arm, ff_quat_yaw(-s * rotation));
    frame->world[shoulder - 1] = ff_quat_mul(frame->world[FF_ROLE_CHEST], ff_quat_axis(axis_z, lifted));
    frame->world[shoulder] = ff_quat_mul(arm, hang);
    frame->world[shoulder + 1] = ff_quat_mul(ff_quat_mul(arm, ff_quat_axis(axis_x, -elbow)), hang);
    ff_quat wrist = ff_quat_axis(axis_x, -(0.12 + 0.10 * elbow)); /* fingers hang a little forward */
    frame->world[shoulder + 2] =
        ff_quat_mul(ff_quat_mul(ff_quat_mul(arm, ff_quat_axis(axis_x, -elbow)), wrist), hang);
    frame->world[side == 0 ? FF_ROLE_HAND_L : FF_ROLE_HAND_R] = frame->world[shoulder + 2];
}

/* ---------------------------------------------------------------------------------------------- all frames */

static void write_frame(const ff_frame *frame, ff_clip *clip, int f)
{
    clip->positions[f] = frame->hips;
    ff_quat *local = clip->rotations + (size_t)f * (size_t)clip->joint_count;
    for (int j = 0; j < clip->joint_count; ++j) {
        const ff_joint *joint = &clip->joints[j];
        if (joint->end_site) continue;
        ff_quat world = frame->world[joint->role];
        if (joint->parent >= 0)
            world = ff_quat_mul(ff_quat_conj(frame->world[clip->joints[joint->parent].role]), world);
        local[j] = ff_quat_unit(world);
    }
}

/* Widest of the values within half frames on either side, then twice a moving average over the same window: never
 * below the values, and smooth. */
static bool spread(double *values, int count, int half)
{
    double *work = ff_calloc((size_t)count, sizeof *work);
    if (!work) return false;
    for (int i = 0; i < count; ++i)
        for (int k = i - half; k <= i + half; ++k)
            if (k >= 0 && k < count) work[i] = ff_max(work[i], values[k]);
    int quarter = half / 2;
    for (int pass = 0; pass < 2; ++pass) {
        double *from = pass == 0 ? work : values, *to = pass == 0 ? values : work;
        for (int i = 0; i < count; ++i) {
            double sum = 0.0;
            for (int k = i - quarter; k <= i + quarter; ++k)
                sum += from[k < 0 ? 0 : (k >= count ? count - 1 : k)];
            to[i] = sum / (2 * quarter + 1);
        }
    }
    for (int i = 0; i < count; ++i)
        values[i] = work[i];
    free(work);
    return true;
}

bool ff_pose_clip(const ff_plan *plan, ff_clip *clip)
{
    double window = sideways(&plan->roots[0]) > 0.8 ? REACH_WINDOW_SIDE : REACH_WINDOW;
    int half = (int)(window / clip->frame_time), margin = 2 * half, count = clip->frame_count + 2 * margin;
    double *excess = ff_calloc((size_t)count, sizeof *excess);
    if (!excess) return false;
    ff_frame frame;
    for (int i = 0; i < count; ++i) {
        start_frame(plan, (i - margin) * clip->frame_time, &frame);
        pose_pelvis(plan, &frame);
        excess[i] = excess_height(plan, &frame);
    }
    bool done = spread(excess, count, half);
    for (int f = 0; done && f < clip->frame_count; ++f) {
        start_frame(plan, f * clip->frame_time, &frame);
        pose_pelvis(plan, &frame);
        frame.hips.y -= excess[f + margin];
        pose_trunk(plan, &frame);
        for (int side = 0; side < 2; ++side) {
            pose_leg(&frame, side);
            pose_arm(plan, &frame, side);
        }
        write_frame(&frame, clip, f);
    }
    free(excess);
    return done;
}
