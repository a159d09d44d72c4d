/* play_pose.c - what an entry of the queue looks like at a moment. */
#include "runtime/core/gait/gait_hips.h"
#include "runtime/core/gait/leg_pose.h"
#include "runtime/core/play/play.h"

#include <string.h>

#define GRIP 0.12                  /* s, in which a foot lets go of the ground and takes hold of it */
#define CLEAR 0.018                /* m, over the ground, of a foot in the air ... */
#define RISES 0.06                 /* ... once so many s have passed since it left, and so many are left */
#define FOOT 0.1                   /* m, more than any foot is over the ground on which it stands */
#define RAISE (25.0 * FF_DEG)      /* a heel may be raised so far before the hips come down for it */
#define MOST_RAISE (35.0 * FF_DEG) /* and so far at all */
#define MOST_DROP 0.10             /* m */
#define STEEP (50.0 * FF_DEG)      /* toes hang down so far as they were captured, ... */
#define STEEPER (20.0 * FF_DEG)    /* ... and so much more at most */
#define ROUND 0.01                 /* m, over which hips begin to come down */

static double local_time(const ff_play_step *step, double time)
{
    return (time - step->start) * step->pace;
}

static ff_vec2 place(const ff_play_step *step, ff_vec2 ahead, ff_vec2 local)
{
    return ff_add2(ff_v2(step->a, step->b), ff_from_frame2(ahead, local));
}

/* ------------------------------------------------------------------------------------------------- feet */

/* Where a foot really stands in the k-th stance of its action: on its footprint, if it stood there before. */
static ff_play_foot stance_place(const ff_play_step *step, const ff_play_action *action, int foot, uint32_t k)
{
    const ff_play_stance *stance = &action->stance[foot][k];
    if (k == 0 && stance->from <= 0.0 && step->foot[foot].planted) return step->foot[foot];
    ff_vec2 at = place(step, ff_fwd2(step->heading), ff_v2(stance->a, stance->b));
    return (ff_play_foot){at.a, at.b, step->heading + stance->yaw, 1, 0};
}

void ff_play_feet_after(const ff_play_set *set, const ff_play_step *step, ff_play_foot feet[2])
{
    for (int foot = 0; foot < 2; ++foot) {
        feet[foot] = step->foot[foot];
        if (step->action == FF_PLAY_STAND) continue;
        const ff_play_action *action = &set->actions[step->action];
        uint32_t count = action->stance_count[foot];
        bool ends = count > 0 && action->stance[foot][count - 1].to >= action->duration;
        feet[foot] = ends ? stance_place(step, action, foot, count - 1) : (ff_play_foot){0};
    }
}

double ff_play_landing(const ff_play_set *set, const ff_play_step *step, int foot)
{
    if (step->action == FF_PLAY_STAND) return step->start;
    const ff_play_action *action = &set->actions[step->action];
    uint32_t count = action->stance_count[foot];
    return count > 0 ? step->start + ff_max(action->stance[foot][count - 1].down, 0.0) / step->pace
                     : step->end;
}

/* What is added to the clip's foot on the ground, in the world: m, m, rad. */
typedef struct lead {
    ff_vec2 place;
    double yaw;
} lead;

/* Of a stance: from the clip's place for it to the real one. */
static lead lead_of_stance(const ff_play_step *step, const ff_play_action *action, int foot, uint32_t k)
{
    const ff_play_stance *stance = &action->stance[foot][k];
    ff_play_foot real = stance_place(step, action, foot, k);
    ff_vec2 clip = place(step, ff_fwd2(step->heading), ff_v2(stance->a, stance->b));
    return (lead){ff_sub2(ff_v2(real.a, real.b), clip), ff_wrap(real.yaw - step->heading - stance->yaw)};
}

static double hermite(double s, double from, double slope_from, double to, double slope_to)
{
    double s2 = s * s, s3 = s2 * s;
    return (2.0 * s3 - 3.0 * s2 + 1.0) * from + (s3 - 2.0 * s2 + s) * slope_from +
           (3.0 * s2 - 2.0 * s3) * to + (s3 - s2) * slope_to;
}

/* One end of a swing. */
typedef struct swing_end {
    double time;
    lead lead;
    ff_vec2 slope; /* m/s, of the lead */
} swing_end;

/* end 0: the k-th stance begins, 1: it is over. The lead is of the clip's ball as it moves there, so that the ball has the
 * place and the speed of a foot that stands (synthesis study 4.2). */
static swing_end end_of_stance(const ff_play_step *step, const ff_play_action *action, int foot, uint32_t k,
                               int end)
{
    const ff_play_stance *stance = &action->stance[foot][k];
    ff_vec2 ahead = ff_fwd2(step->heading);
    swing_end out = {end == 0 ? stance->from : stance->to, lead_of_stance(step, action, foot, k), {0.0, 0.0}};
    out.lead.place = ff_sub2(out.lead.place, ff_from_frame2(ahead, stance->off[end]));
    out.slope = ff_scale2(ff_from_frame2(ahead, stance->speed[end]), -1.0);
    return out;
}

static lead lead_between(const swing_end *p, const swing_end *q, double time)
{
    double span = q->time - p->time, s = ff_clamp((time - p->time) / span, 0.0, 1.0);
    lead out;
    out.place.a = hermite(s, p->lead.place.a, p->slope.a * span, q->lead.place.a, q->slope.a * span);
    out.place.b = hermite(s, p->lead.place.b, p->slope.b * span, q->lead.place.b, q->slope.b * span);
    out.yaw = ff_lerp(p->lead.yaw, q->lead.yaw, ff_smooth(s));
    return out;
}

/* The stance that a foot is in at local time, or the next one it comes to (the count when there is none). One that it would
 * be in as the action begins is none if the foot did not stand. */
static uint32_t stance_at(const ff_play_step *step, const ff_play_action *action, int foot, double local)
{
    uint32_t count = action->stance_count[foot], next = 0;
    if (count > 0 && action->stance[foot][0].from <= 0.0 && !step->foot[foot].planted) next = 1;
    while (next < count && action->stance[foot][next].to < local &&
           action->stance[foot][next].to < action->duration)
        ++next; /* one that reaches the action's end goes on into the next action */
    return next;
}

/* A captured foot may still be over the ground, its toes by 3 cm, when the plan has the body on it: the toes go down about the
 * heel, then the whole foot, by most together. */
static void put_down(const ff_body_frame *body, int foot, double most, ff_play_targets *out)
{
    ff_play_over over = ff_play_over_ground(body, foot, out->ball[foot].y, out->foot[foot]);
    double toes = ff_min(most, over.toes), sole = ff_min(most - toes, over.sole);
    out->ball[foot].y -= toes + sole;
    if (!(toes > 0.0)) return;
    ff_vec3 ball = body->offset[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE];
    ff_vec3 from_heel = ff_quat_rotate(out->foot[foot], ff_sub3(ball, body->heel[foot]));
    double square = ff_dot3(from_heel, from_heel), was = from_heel.y, is = was - toes;
    double turn = ff_atan2(was, sqrt(ff_max(square - was * was, 0.0))) -
                  ff_atan2(is, sqrt(ff_max(square - is * is, 0.0)));
    double yaw = ff_play_foot_yaw(out->foot[foot]);
    out->foot[foot] = ff_quat_mul(ff_quat_axis(ff_v3(ff_cos(yaw), 0.0, -ff_sin(yaw)), turn), out->foot[foot]);
}

/* m: by how much a foot is put down at most: all that it is over the ground while it stands, before and after that as much as
 * brings it there. next: its stance, or the one it comes to; left: there was one before. */
static double put_down_most(const ff_play_action *action, int foot, uint32_t next, bool left, double local)
{
    double most = 0.0;
    if (left) {
        const ff_play_stance *from = &action->stance[foot][next - 1];
        most = from->over[1] * (1.0 - ff_smooth((local - from->to) / GRIP));
    }
    if (next == action->stance_count[foot]) return most;
    const ff_play_stance *to = &action->stance[foot][next];
    if (to->from <= 0.0) return FOOT;
    if (local >= to->down) return to->over[0] + FOOT * ff_smooth((local - to->down) / (0.5 * GRIP));
    double near = ff_max(0.0, 1.0 - (to->down - local) / GRIP); /* a foot meets the ground with some speed */
    return ff_max(most, to->over[0] * near * near * (2.0 - near));
}

/* m: in some clips feet glide to their places, flat on the ground, or scrape along it with the toes: one in the air is held over it,
 * and comes down at its time. */
static double clearance(const ff_play_action *action, int foot, uint32_t next, bool left, double local)
{
    const ff_play_stance *stance = action->stance[foot];
    double up = CLEAR;
    if (left) up *= ff_smooth((local - stance[next - 1].to) / RISES);
    if (next == action->stance_count[foot]) return up;
    double near = ff_clamp(1.0 - (stance[next].from - local) / RISES, 0.0, 1.0);
    return up * (1.0 - near * near * (2.0 - near));
}

/* A foot at local time: its place if it stands, else the clip's way, led from where it stood to where it will. */
static void place_foot(const ff_body_frame *body, const ff_play_step *step, const ff_play_action *action,
                       int foot, double local, ff_play_targets *out)
{
    uint32_t count = action->stance_count[foot], next = stance_at(step, action, foot, local);
    swing_end from = {0.0, {{0.0, 0.0}, 0.0}, {0.0, 0.0}}, to = from;
    bool left = next > 0 && (next > 1 || action->stance[foot][0].from > 0.0 || step->foot[foot].planted);
    if (next < count && action->stance[foot][next].from <= local) {
        ff_play_foot real = stance_place(step, action, foot, next);
        from.lead = lead_of_stance(step, action, foot, next);
        out->ball[foot] = ff_v3(real.b, out->ball[foot].y, real.a);
        out->planted[foot] = 1;
        out->grip[foot] = 1.0;
    } else {
        if (left) from = end_of_stance(step, action, foot, next - 1, 1);
        to.time = from.time + FF_PLAY_SETTLE;
        if (next < count) to = end_of_stance(step, action, foot, next, 0);
        from.lead = lead_between(&from, &to, local);
        out->ball[foot] = ff_add3(out->ball[foot], ff_ground(from.lead.place, 0.0));
        out->planted[foot] = 0;
        double since = left ? local - from.time : GRIP, until = next < count ? to.time - local : GRIP;
        out->grip[foot] = 1.0 - ff_smooth(ff_min(since, until) / GRIP);
    }
    out->foot[foot] = ff_quat_mul(ff_quat_yaw(from.lead.yaw), out->foot[foot]);
    put_down(body, foot, put_down_most(action, foot, next, left, local), out);
    if (!out->planted[foot] && foot != (int)action->support)
        out->ball[foot].y =
            ff_max(out->ball[foot].y, body->ball_rest + clearance(action, foot, next, left, local));
}

/* ------------------------------------------------------------------------------------------- actions */

static void action_targets(const ff_play_set *set, const ff_play_step *step, double time,
                           ff_play_targets *out)
{
    const ff_play_action *action = &set->actions[step->action];
    double local = local_time(step, time);
    ff_vec2 ahead = ff_fwd2(step->heading);
    ff_quat turn = ff_quat_yaw(step->heading);
    ff_play_sample at;
    ff_play_sample_at(set, step->action, local, &at);
    out->root = place(step, ahead, at.root);
    out->heading = step->heading + at.heading;
    out->hips = ff_ground(place(step, ahead, ff_plane(at.hips)), at.hips.y);
    memcpy(out->rotations, at.rotations, sizeof out->rotations);
    out->rotations[FF_JOINT_HIPS] = ff_quat_mul(turn, at.rotations[FF_JOINT_HIPS]);
    for (int foot = 0; foot < 2; ++foot) {
        out->ball[foot] = ff_ground(place(step, ahead, ff_plane(at.ball[foot])), at.ball[foot].y);
        out->foot[foot] = ff_quat_mul(turn, at.foot[foot]);
        place_foot(&set->space->body, step, action, foot, local, out);
    }
}

/* ------------------------------------------------------------------------------------------- standing */

/* The last pose of the action before, which plans rely on, moved by what the idle motion has done since. */
static void stand_in_last_pose(const ff_play_set *set, const ff_play *play, const ff_play_step *step,
                               ff_play_targets *out)
{
    ff_vec3 before;
    ff_quat then[FF_JOINT_COUNT];
    ff_play_sample at;
    ff_gait_idle_pose(set->space, play->idle_time + step->entered, out->root, step->heading, &before, then);
    ff_play_sample_at(set, step->last, set->actions[step->last].duration, &at);
    ff_quat turn = ff_quat_yaw(step->heading - at.heading);
    ff_vec2 hips = ff_from_frame2(ff_fwd2(step->heading - at.heading), ff_sub2(ff_plane(at.hips), at.root));
    out->hips = ff_add3(ff_ground(ff_add2(out->root, hips), at.hips.y), ff_sub3(out->hips, before));
    at.rotations[FF_JOINT_HIPS] = ff_quat_mul(turn, at.rotations[FF_JOINT_HIPS]);
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        out->rotations[j] =
            ff_quat_unit(ff_quat_mul(ff_quat_mul(out->rotations[j], ff_quat_conj(then[j])), at.rotations[j]));
}

static void stand_targets(const ff_play_set *set, const ff_play *play, const ff_play_step *step, double time,
                          ff_play_targets *out)
{
    out->root = ff_v2(step->a, step->b);
    out->heading = step->heading;
    ff_gait_idle_pose(set->space, play->idle_time + time, out->root, step->heading, &out->hips,
                      out->rotations);
    if (step->last != FF_PLAY_STAND) stand_in_last_pose(set, play, step, out);
    for (int foot = 0; foot < 2; ++foot) {
        const ff_play_foot *real = &step->foot[foot];
        out->ball[foot] = ff_v3(real->b, set->space->body.ball_rest, real->a);
        out->foot[foot] = ff_quat_yaw(real->yaw);
        out->planted[foot] = 1;
        out->grip[foot] = 1.0;
    }
}

/* ------------------------------------------------------------------------------------------- both */

static void add_offset(const ff_pose_offset *began, double age, ff_play_targets *out)
{
    ff_pose_offset offset = *began;
    offset.age = age;
    ff_vec2 ahead = ff_fwd2(out->heading);
    ff_quat turn = ff_quat_yaw(out->heading), back = ff_quat_conj(turn);
    ff_vec3 hips = ff_pose_offset_hips(&offset);
    ff_vec2 moved = ff_from_frame2(ahead, ff_v2(hips.x, hips.y));
    out->root = ff_add2(out->root, moved);
    out->hips = ff_add3(out->hips, ff_ground(moved, hips.z));
    for (int joint = 0; joint < FF_JOINT_COUNT; ++joint)
        if (joint != FF_JOINT_HIPS && joint != FF_JOINT_ANKLE_L && joint != FF_JOINT_ANKLE_R)
            out->rotations[joint] = ff_pose_offset_turn(&offset, joint, out->rotations[joint]);
    ff_quat *pelvis = &out->rotations[FF_JOINT_HIPS];
    *pelvis = ff_quat_mul(turn, ff_pose_offset_turn(&offset, FF_JOINT_HIPS, ff_quat_mul(back, *pelvis)));
    for (int foot = 0; foot < 2; ++foot) {
        ff_pose_foot add = ff_pose_offset_foot(&offset, foot);
        ff_vec2 ball = out->planted[foot] ? ff_v2(0.0, 0.0) : ff_v2(add.forward, add.left);
        int ankle = FF_JOINT_ANKLE_L + foot * FF_JOINT_LEG_STRIDE;
        out->ball[foot] = ff_add3(out->ball[foot], ff_ground(ff_from_frame2(ahead, ball), add.height));
        out->foot[foot] =
            ff_quat_mul(turn, ff_pose_offset_turn(&offset, ankle, ff_quat_mul(back, out->foot[foot])));
    }
}

void ff_play_targets_at(const ff_play_set *set, const ff_play *play, double time, ff_play_targets *out)
{
    const ff_play_step *step = &play->step[0];
    if (step->action == FF_PLAY_STAND)
        stand_targets(set, play, step, time, out);
    else
        action_targets(set, step, time, out);
    double age = time - play->joined;
    if (ff_pose_offset_active(&play->offset) && age < FF_POSE_OFFSET_TIME)
        add_offset(&play->offset, age, out);
}

/* After a long step comes a short one, whose hips are too high for the foot that is still behind: they come down. */
static void lower_hips(const ff_body_frame *body, ff_play_targets *at)
{
    double drop = 0.0;
    for (int foot = 0; foot < 2; ++foot) {
        int joint = FF_JOINT_HIP_L + foot * FF_JOINT_LEG_STRIDE;
        ff_vec3 hip = ff_add3(at->hips, ff_quat_rotate(at->rotations[FF_JOINT_HIPS], body->offset[joint]));
        double yaw = ff_play_foot_yaw(at->foot[foot]);
        ff_quat raised =
            ff_quat_mul(ff_quat_axis(ff_v3(ff_cos(yaw), 0.0, -ff_sin(yaw)), RAISE), at->foot[foot]);
        ff_foothold ball = {at->ball[foot].z, at->ball[foot].x, at->ball[foot].y, yaw};
        double reach = FF_LEG_REACH * (body->thigh[foot] + body->shank[foot]);
        double lack = ff_gait_lack(hip, ff_gait_ankle(body, foot, ball, raised), reach);
        double wanted = at->grip[foot] * 0.5 * (lack + sqrt(lack * lack + ROUND * ROUND));
        drop = sqrt(drop * drop + wanted * wanted);
    }
    at->hips.y -= ff_min(drop, MOST_DROP);
}

void ff_play_root(const ff_play_set *set, const ff_play *play, double time, ff_vec2 *root, double *heading)
{
    const ff_play_step *step = &play->step[0];
    *root = ff_v2(step->a, step->b);
    *heading = step->heading;
    if (step->action != FF_PLAY_STAND) {
        ff_root_frame local = ff_play_root_at(set, step->action, local_time(step, time));
        *root = place(step, ff_fwd2(step->heading), local.position);
        *heading += local.heading;
    }
    double age = time - play->joined;
    if (!ff_pose_offset_active(&play->offset) || !(age < FF_POSE_OFFSET_TIME)) return;
    ff_pose_offset offset = play->offset;
    offset.age = age;
    ff_vec3 hips = ff_pose_offset_hips(&offset);
    *root = ff_add2(*root, ff_from_frame2(ff_fwd2(*heading), ff_v2(hips.x, hips.y)));
}

/* Captured toes hang down from a foot that swings on steeply; where they came near the floor they would turn up all at once, by
 * 50 degrees within a frame: the steeper they are the less they hang. */
static ff_quat hang_less(const ff_body_frame *body, int foot, double yaw, ff_quat turn, ff_quat toes)
{
    ff_vec3 tip = ff_quat_rotate(turn, ff_quat_rotate(toes, body->toe[foot]));
    double steep = -ff_atan2(tip.y, tip.z * ff_cos(yaw) + tip.x * ff_sin(yaw)), over = steep - STEEP;
    if (!(over > 0.0)) return toes;
    double less = over - over / (1.0 + over / STEEPER);
    return ff_quat_mul(ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -less), toes);
}

static void pose_legs(const ff_body_frame *body, const ff_play_targets *at, ff_quat *rotations)
{
    ff_legs legs;
    ff_leg_target target[2];
    ff_legs_of_clip(body, at->hips, rotations, &legs);
    for (int foot = 0; foot < 2; ++foot) {
        ff_foothold ball = {at->ball[foot].z, at->ball[foot].x, at->ball[foot].y,
                            ff_play_foot_yaw(at->foot[foot])};
        ff_quat *toes = &rotations[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE];
        *toes = hang_less(body, foot, ball.yaw, at->foot[foot], *toes);
        target[foot] =
            (ff_leg_target){ball, at->foot[foot], 0.0, MOST_RAISE, at->grip[foot], 0.0, 0.0, 0.0, 0.0, 0.0};
    }
    ff_legs_pose(body, target, &legs, rotations);
}

void ff_play_pose(const ff_play_set *set, const ff_play *play, double time, ff_vec3 *hips, ff_quat *rotations)
{
    ff_play_targets at;
    ff_play_targets_at(set, play, time, &at);
    lower_hips(&set->space->body, &at);
    *hips = at.hips;
    memcpy(rotations, at.rotations, sizeof at.rotations);
    pose_legs(&set->space->body, &at, rotations);
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        rotations[j] = ff_quat_unit(rotations[j]);
}
