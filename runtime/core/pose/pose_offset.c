#include "runtime/core/pose/pose_offset.h"

#include <string.h>

enum { BODY, FOOT, LEGS = FOOT + 2 }; /* of ff_pose_offset.time */
enum { HEIGHT = 2, PITCH = 4 };       /* of what feet differ by */
#define LEAST_TIME 0.02               /* s, that a foot gets at least */

/* How much is left of a difference, and of its speed (s): the cubic that begins with both and ends with neither. The
 * study found it and the quintic alike (section 6, last table), the cubic with the smaller peaks. */
static void shares(const ff_pose_offset *offset, int part, double late, double *place, double *speed)
{
    double time = (double)offset->time[part], age = ff_max(offset->age - late, 0.0);
    *place = *speed = 0.0;
    if (!(age < time)) return;
    double t = age / time, rest = 1.0 - t;
    *place = rest * rest * (1.0 + 2.0 * t);
    *speed = rest * rest * t * time;
}

static void put3(float place[3], float speed[3], ff_vec3 now, ff_vec3 later, double h)
{
    const double at[3] = {now.x, now.y, now.z}, then[3] = {later.x, later.y, later.z};
    for (int i = 0; i < 3; ++i) {
        place[i] = (float)at[i];
        speed[i] = (float)((then[i] - at[i]) / h);
    }
}

static void difference(const ff_pose_foot *p, const ff_pose_foot *q, double out[5])
{
    out[0] = p->forward - q->forward;
    out[1] = p->left - q->left;
    out[2] = p->height - q->height;
    out[3] = ff_wrap(p->yaw - q->yaw);
    out[4] = ff_wrap(p->pitch - q->pitch);
}

static ff_vec3 turned(ff_quat p, ff_quat q)
{
    return ff_quat_log(ff_quat_mul(p, ff_quat_conj(q)));
}

/* The nearest speed with which the cubic of shares() goes from a difference to nothing without growing or overshooting
 * (Fritsch and Carlson 1980). */
static double shrinking(double difference, double speed, double time)
{
    double most = -3.0 * difference / time;
    return ff_clamp(speed, ff_min(most, 0.0), ff_max(most, 0.0));
}

static void begin_foot(ff_pose_offset *offset, const ff_pose_switch *change, int foot)
{
    double now[5], later[5];
    difference(&change->old_now->foot[foot], &change->new_now->foot[foot], now);
    difference(&change->old_later->foot[foot], &change->new_later->foot[foot], later);
    double time = ff_clamp(change->until[foot], LEAST_TIME, FF_POSE_OFFSET_TIME);
    for (int i = 0; i < 5; ++i) {
        double speed = (later[i] - now[i]) / change->later;
        if (change->stands[foot] && (i == HEIGHT || i == PITCH)) speed = shrinking(now[i], speed, time);
        offset->foot[foot][0][i] = (float)now[i];
        offset->foot[foot][1][i] = (float)speed;
    }
    offset->time[FOOT + foot] = (float)time;
}

void ff_pose_offset_begin(ff_pose_offset *offset, const ff_pose_switch *change)
{
    const ff_pose_targets *from = change->old_now, *to = change->new_now;
    const ff_pose_targets *from_later = change->old_later, *to_later = change->new_later;
    memset(offset, 0, sizeof *offset);
    offset->time[BODY] = offset->time[LEGS] = (float)FF_POSE_OFFSET_TIME;
    put3(offset->hips[0], offset->hips[1], ff_sub3(from->hips, to->hips),
         ff_sub3(from_later->hips, to_later->hips), change->later);
    for (int joint = 0; joint < FF_JOINT_COUNT; ++joint)
        put3(offset->turn[0][joint], offset->turn[1][joint], turned(from->turn[joint], to->turn[joint]),
             turned(from_later->turn[joint], to_later->turn[joint]), change->later);
    for (int foot = 0; foot < 2; ++foot)
        begin_foot(offset, change, foot);
}

void ff_pose_offset_advance(ff_pose_offset *offset, double dt)
{
    double late = 0.0;
    for (int arm = 0; arm < FF_ARM_JOINTS; ++arm)
        late = ff_max(late, (double)offset->late[arm]);
    offset->age += dt;
    if (!(offset->age - late < (double)offset->time[BODY])) memset(offset, 0, sizeof *offset);
}

static ff_vec3 mix(const ff_pose_offset *offset, int part, double late, const float place[3],
                   const float speed[3])
{
    double p, s;
    shares(offset, part, late, &p, &s);
    return ff_v3(p * (double)place[0] + s * (double)speed[0], p * (double)place[1] + s * (double)speed[1],
                 p * (double)place[2] + s * (double)speed[2]);
}

ff_vec3 ff_pose_offset_hips(const ff_pose_offset *offset)
{
    return mix(offset, BODY, 0.0, offset->hips[0], offset->hips[1]);
}

ff_pose_foot ff_pose_offset_foot(const ff_pose_offset *offset, int foot)
{
    const float(*part)[5] = offset->foot[foot];
    double p, s, sum[5];
    shares(offset, FOOT + foot, 0.0, &p, &s);
    for (int i = 0; i < 5; ++i)
        sum[i] = p * (double)part[0][i] + s * (double)part[1][i];
    return (ff_pose_foot){sum[0], sum[1], sum[2], sum[3], sum[4]};
}

static double late_of(const ff_pose_offset *offset, int joint)
{
    for (int arm = 0; arm < FF_ARM_JOINTS; ++arm)
        if (ff_arm_joints[arm] == joint) return (double)offset->late[arm];
    return 0.0;
}

ff_quat ff_pose_offset_turn(const ff_pose_offset *offset, int joint, ff_quat rotation)
{
    int part = joint < FF_JOINT_HIP_L ? BODY : LEGS;
    ff_vec3 turn = mix(offset, part, late_of(offset, joint), offset->turn[0][joint], offset->turn[1][joint]);
    return ff_quat_unit(ff_quat_mul(ff_quat_exp(turn), rotation));
}

/* The largest share of the way from held to free at which the length is at most `most`, or the least. Both are turns of a few
 * degrees, as vectors. */
static double share_within(ff_vec3 held, ff_vec3 free, double most)
{
    ff_vec3 way = ff_sub3(free, held);
    double a = ff_dot3(way, way), b = ff_dot3(held, way), c = ff_dot3(held, held) - most * most;
    if (a < 1e-18) return 1.0;
    return ff_clamp((sqrt(ff_max(b * b - a * c, 0.0)) - b) / a, 0.0, 1.0);
}

double ff_pose_offset_speed(const ff_pose_offset *offset, int arm)
{
    double time = (double)offset->time[BODY], square = 0.0;
    double age = ff_max(offset->age - (double)offset->late[arm], 0.0);
    if (!(age < time)) return 0.0;
    double t = age / time, rest = 1.0 - t;
    double place = -6.0 * rest * t / time, speed = rest * (1.0 - 3.0 * t); /* the slopes of shares() */
    for (int i = 0; i < 3; ++i) {
        int joint = ff_arm_joints[arm];
        double v = place * (double)offset->turn[0][joint][i] + speed * (double)offset->turn[1][joint][i];
        square += v * v;
    }
    return sqrt(square);
}

void ff_pose_offset_hold(ff_pose_offset *offset, int arm, ff_quat before, ff_quat now, double most, double dt)
{
    int joint = ff_arm_joints[arm];
    ff_pose_offset last = *offset;
    last.age -= dt;
    ff_quat back = ff_quat_conj(ff_pose_offset_turn(&last, joint, before));
    ff_vec3 free = ff_quat_log(ff_quat_mul(back, ff_pose_offset_turn(offset, joint, now)));
    if (ff_length3(free) <= most) return;
    last = *offset;
    last.late[arm] += (float)dt;
    ff_vec3 held = ff_quat_log(ff_quat_mul(back, ff_pose_offset_turn(&last, joint, now)));
    offset->late[arm] += (float)((1.0 - share_within(held, free, most)) * dt);
}

void ff_pose_offset_apply(const ff_pose_offset *offset, ff_pose_targets *targets)
{
    if (!ff_pose_offset_active(offset)) return;
    targets->hips = ff_add3(targets->hips, ff_pose_offset_hips(offset));
    for (int foot = 0; foot < 2; ++foot) {
        ff_pose_foot add = ff_pose_offset_foot(offset, foot), *to = &targets->foot[foot];
        *to = (ff_pose_foot){to->forward + add.forward, to->left + add.left, to->height + add.height,
                             to->yaw + add.yaw, to->pitch + add.pitch};
    }
    for (int joint = 0; joint < FF_JOINT_COUNT; ++joint)
        targets->turn[joint] = ff_pose_offset_turn(offset, joint, targets->turn[joint]);
}
