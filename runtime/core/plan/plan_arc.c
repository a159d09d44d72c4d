/* plan_arc.c - by what head and hands leave the straight way on which a joint's difference fades: played, joints turn, and hands go
 * round on arcs, by 10 cm and more where one who swings bent arms follows one who does not. Found out half way through, from the poses
 * that are played then (play.c, pose_offset.h). */
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"
#include "runtime/core/plan/plan_joint.h"
#include "runtime/core/play/play_set.h"

#include <stdlib.h>

#define LATER (1.0 / 240.0) /* s, over which speeds are taken */

enum { UPPER = FF_JOINT_HIP_L, ENDS = FF_COLLIDER_HAND_R + 1 }; /* joints; colliders that are looked at */

/* Trunk, head and arms of an action at a moment, in S0. */
typedef struct upper {
    ff_vec3 hips; /* as ff_ground() gives them */
    double heading;
    ff_quat turn[UPPER]; /* the others local */
} upper;

/* Of an action: as it ends and begins, and a little later; half way through what joins it to the one before. */
typedef struct moments {
    upper end[2], begin[2], middle;
    float time; /* s, of the middle */
} moments;

/* Where the colliders of the upper body are: half way from a joint to its tip. */
typedef struct tip_list {
    uint32_t joint[ENDS];
    ff_vec3 offset[ENDS]; /* m, in the joint's frame */
} tip_list;

static upper upper_at(const ff_action_set *set, const ff_body_frame *body, const ff_play_action *action,
                      double time)
{
    ff_play_sample at;
    ff_play_action_sample(set->pack, body, action, time, &at);
    upper out = {.hips = at.hips, .heading = at.heading};
    for (int j = 0; j < UPPER; ++j)
        out.turn[j] = at.rotations[j];
    return out;
}

static void find_moments(const ff_action_set *set, const ff_body_frame *body, uint32_t index, moments *out)
{
    const ff_set_action *a = &set->actions[index];
    ff_play_action played;
    ff_play_action_make(set->pack, body, a->pack_index, &played);
    double pace = (double)a->pace;
    bool stands = (a->flags & FF_SET_TO_STANDING) != 0;
    out->time = 0.5f * fminf(FF_JOINT_TIME, set->ends[index].last);
    for (int i = 0; i < 2; ++i) {
        double later = i * LATER * pace;
        out->begin[i] = upper_at(set, body, &played, later);
        out->end[i] = upper_at(set, body, &played, played.duration + (stands ? 0.0 : later));
    }
    out->middle = upper_at(set, body, &played, (double)out->time * pace);
}

static tip_list find_tips(const ff_pack *pack)
{
    static const uint32_t joint[ENDS] = {FF_JOINT_HEAD, FF_JOINT_WRIST_L, FF_JOINT_WRIST_R};
    static const uint32_t kind[ENDS] = {FF_POINT_HEAD_TOP, FF_POINT_HAND_L, FF_POINT_HAND_R};
    tip_list out = {.joint = {0}};
    for (int c = 0; c < ENDS; ++c) {
        out.joint[c] = joint[c];
        for (uint32_t p = 0; p < pack->point_count; ++p) {
            const float *offset = pack->points[p].offset;
            if (pack->points[p].kind == kind[c])
                out.offset[c] =
                    ff_scale3(ff_v3((double)offset[0], (double)offset[1], (double)offset[2]), 0.5);
        }
    }
    return out;
}

/* What is left to add of a difference and of its speed after a share of the time that play gives it. */
static ff_vec3 left_of(ff_vec3 now, ff_vec3 later, double share)
{
    float place, speed;
    ff_joint_left((float)share, &place, &speed);
    ff_vec3 faster = ff_scale3(ff_sub3(later, now), FF_POSE_OFFSET_TIME / LATER);
    return ff_add3(ff_scale3(now, (double)place), ff_scale3(faster, (double)speed));
}

/* The upper body in the middle of the joint, as it is played. turn: by which S0 of the second is turned from S0 of the first, in
 * which it lies at anchor. */
static upper played_between(const moments *first, const moments *second, ff_vec2 anchor, double turn)
{
    upper out = second->middle;
    double share = (double)second->time / FF_POSE_OFFSET_TIME;
    ff_vec3 hips[2], turned[2][UPPER];
    for (int i = 0; i < 2; ++i) {
        const upper *old = &first->end[i], *new = &second->begin[i];
        ff_vec2 back = ff_fwd2(new->heading);
        ff_vec2 place = ff_to_frame2(ff_fwd2(turn), ff_sub2(ff_plane(old->hips), anchor));
        ff_vec2 off = ff_to_frame2(back, ff_sub2(place, ff_plane(new->hips)));
        hips[i] = ff_v3(off.a, off.b, old->hips.y - new->hips.y);
        for (int j = 0; j < UPPER; ++j) {
            ff_quat p = old->turn[j], q = new->turn[j];
            if (j == 0) {
                p = ff_quat_mul(ff_quat_yaw(-turn - new->heading), p);
                q = ff_quat_mul(ff_quat_yaw(-new->heading), q);
            }
            turned[i][j] = ff_quat_log(ff_quat_mul(p, ff_quat_conj(q)));
        }
    }
    ff_vec3 moved = left_of(hips[0], hips[1], share);
    ff_vec2 ahead = ff_fwd2(out.heading);
    out.hips = ff_add3(out.hips, ff_ground(ff_from_frame2(ahead, ff_v2(moved.x, moved.y)), moved.z));
    out.turn[0] = ff_quat_mul(ff_quat_yaw(-out.heading), out.turn[0]);
    for (int j = 0; j < UPPER; ++j)
        out.turn[j] = ff_quat_mul(ff_quat_exp(left_of(turned[0][j], turned[1][j], share)), out.turn[j]);
    out.turn[0] = ff_quat_mul(ff_quat_yaw(out.heading), out.turn[0]);
    return out;
}

static void find_colliders(const upper *at, const ff_body_frame *body, const tip_list *tips,
                           ff_vec2 out[ENDS])
{
    ff_vec3 place[UPPER] = {at->hips};
    ff_quat world[UPPER] = {at->turn[0]};
    for (int j = 1; j < UPPER; ++j) {
        int parent = ff_joint_parents[j];
        place[j] = ff_add3(place[parent], ff_quat_rotate(world[parent], body->offset[j]));
        world[j] = ff_quat_mul(world[parent], at->turn[j]);
    }
    for (int c = 0; c < ENDS; ++c) {
        uint32_t joint = tips->joint[c];
        out[c] = ff_plane(ff_add3(place[joint], ff_quat_rotate(world[joint], tips->offset[c])));
    }
}

static void find_arc(const ff_action_set *set, const ff_body_frame *body, const tip_list *tips,
                     const moments *all, uint32_t index, const ff_set_next *next, ff_joint *joint)
{
    const ff_set_action *a = &set->actions[index];
    const moments *second = &all[next->action];
    ff_vec2 anchor = ff_v2(0.0, 0.0), played[ENDS];
    if (!next->other) anchor = ff_v2((double)a->land[0], (double)a->land[1]);
    upper between = played_between(&all[index], second, anchor, (double)a->theta);
    find_colliders(&between, body, tips, played);
    ff_knot at, straight;
    ff_set_sample(set, &set->actions[next->action], second->time, &at);
    ff_joint_add(joint, second->time, &at, &straight);
    for (int c = 0; c < ENDS; ++c) {
        joint->arc_a[c] = (float)played[c].a - straight.a[c];
        joint->arc_b[c] = (float)played[c].b - straight.b[c];
    }
}

ff_status ff_set_find_arcs(ff_action_set *set, const ff_body_frame *body, ff_error *error)
{
    moments *all = ff_calloc(set->count, sizeof *all);
    if (!all) return ff_fail(error, FF_ERR_NO_MEMORY, "the joints of %u actions", set->count);
    tip_list tips = find_tips(set->pack);
    for (uint32_t i = 0; i < set->count; ++i)
        find_moments(set, body, i, &all[i]);
    for (uint32_t i = 0; i < set->count; ++i) {
        const ff_set_action *a = &set->actions[i];
        for (uint32_t k = a->first_next; k < a->first_next + a->next_count; ++k) {
            find_arc(set, body, &tips, all, i, &set->next[k], &set->joints[k]);
            ff_joint_measure(&set->joints[k]);
        }
    }
    free(all);
    return FF_OK;
}
