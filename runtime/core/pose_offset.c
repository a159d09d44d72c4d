#include "runtime/core/pose_offset.h"

#include <string.h>

/* How much of the difference, and of its speed times FF_POSE_OFFSET_TIME, is left: the cubic that begins with both and ends
 * with neither. The study found it and the quintic alike (section 6, last table), the cubic with the smaller peaks. */
static void shares(const ff_pose_offset *offset, double *place, double *speed)
{
    double t = ff_clamp(1.0 - offset->left / FF_POSE_OFFSET_TIME, 0.0, 1.0), rest = 1.0 - t;
    *place = rest * rest * (1.0 + 2.0 * t);
    *speed = rest * rest * t * FF_POSE_OFFSET_TIME;
}

static void put3(float out[2][3], ff_vec3 now, ff_vec3 later, double h)
{
    const double at[3] = {now.x, now.y, now.z}, then[3] = {later.x, later.y, later.z};
    for (int i = 0; i < 3; ++i) {
        out[0][i] = (float)at[i];
        out[1][i] = (float)((then[i] - at[i]) / h);
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

void ff_pose_offset_begin(ff_pose_offset *offset, const ff_pose_targets *old_now,
                          const ff_pose_targets *old_later, const ff_pose_targets *new_now,
                          const ff_pose_targets *new_later, double h)
{
    memset(offset, 0, sizeof *offset);
    offset->left = FF_POSE_OFFSET_TIME;
    put3(offset->hips, ff_sub3(old_now->hips, new_now->hips), ff_sub3(old_later->hips, new_later->hips), h);
    for (int foot = 0; foot < 2; ++foot) {
        double now[5], later[5];
        difference(&old_now->foot[foot], &new_now->foot[foot], now);
        difference(&old_later->foot[foot], &new_later->foot[foot], later);
        for (int i = 0; i < 5; ++i) {
            offset->foot[foot][0][i] = (float)now[i];
            offset->foot[foot][1][i] = (float)((later[i] - now[i]) / h);
        }
    }
    for (int joint = 0; joint < FF_POSE_OFFSET_JOINTS; ++joint) {
        float part[2][3];
        put3(part, turned(old_now->turn[joint], new_now->turn[joint]),
             turned(old_later->turn[joint], new_later->turn[joint]), h);
        memcpy(offset->turn[0][joint], part[0], sizeof part[0]);
        memcpy(offset->turn[1][joint], part[1], sizeof part[1]);
    }
}

void ff_pose_offset_advance(ff_pose_offset *offset, double dt)
{
    if (offset->left <= dt)
        memset(offset, 0, sizeof *offset);
    else
        offset->left -= dt;
}

static ff_vec3 mix(const ff_pose_offset *offset, const float place[3], const float speed[3])
{
    double p, s;
    shares(offset, &p, &s);
    return ff_v3(p * (double)place[0] + s * (double)speed[0], p * (double)place[1] + s * (double)speed[1],
                 p * (double)place[2] + s * (double)speed[2]);
}

ff_vec3 ff_pose_offset_hips(const ff_pose_offset *offset)
{
    return mix(offset, offset->hips[0], offset->hips[1]);
}

ff_pose_foot ff_pose_offset_foot(const ff_pose_offset *offset, int foot)
{
    const float(*part)[5] = offset->foot[foot];
    double p, s, sum[5];
    shares(offset, &p, &s);
    for (int i = 0; i < 5; ++i)
        sum[i] = p * (double)part[0][i] + s * (double)part[1][i];
    return (ff_pose_foot){sum[0], sum[1], sum[2], sum[3], sum[4]};
}

ff_quat ff_pose_offset_turn(const ff_pose_offset *offset, int joint, ff_quat rotation)
{
    ff_vec3 turn = mix(offset, offset->turn[0][joint], offset->turn[1][joint]);
    return ff_quat_unit(ff_quat_mul(ff_quat_exp(turn), rotation));
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
    for (int joint = 0; joint < FF_POSE_OFFSET_JOINTS; ++joint)
        targets->turn[joint] = ff_pose_offset_turn(offset, joint, targets->turn[joint]);
}
