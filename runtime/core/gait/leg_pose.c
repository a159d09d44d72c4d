#include "runtime/core/gait/leg_pose.h"

#include "runtime/core/gait/gait_hips.h"

#define SWING_BEYOND                                                                                         \
    0.08 /* of the reach: what a foot may be too far off in mid swing; at both ends its heel stays up */
#define ROUND_REACH                                                                                          \
    0.025 /* of the leg, over which the corner is rounded where a foot gets out of reach and back */

/* How far from the hip the ankle may be: FF_LEG_REACH for a foot on the ground. Where the foot rolls or flies, the corner is
 * rounded, or the knee would stop and bend all at once. */
static double allowed_distance(const ff_leg_target *target, double distance, double leg_length)
{
    double reach = FF_LEG_REACH * leg_length, swing = target->swing;
    reach *= 1.0 + SWING_BEYOND * ff_smooth(swing / 0.4) * ff_smooth((1.0 - swing) / 0.4);
    double round = ROUND_REACH * leg_length * target->round, over = distance - reach;
    if (fabs(over) >= round) return ff_min(distance, reach);
    return distance - (over + round) * (over + round) / (4.0 * round);
}

/* Where the ankle of a swinging leg may get to. */
static ff_vec3 swing_in_reach(const ff_leg_target *target, ff_vec3 hip, ff_vec3 ankle, double leg_length)
{
    ff_vec3 away = ff_sub3(ankle, hip);
    double distance = ff_length3(away);
    double wanted = ff_leg_swing_distance(target->swing, distance, leg_length) + target->give;
    return ff_madd3(hip, away, wanted / distance);
}

/* rad, between the way from the ball to the ankle and that to the hip: the last of it would be raised within a frame, for
 * what little reach is left in it (2 % of the foot). */
#define LEAST_OPEN 0.2

/* A foot out of reach lifts its heel about the ball before anything slides: by the least angle that brings the ankle within
 * reach of the hip, or, where none does, as near as it gets. Seen along the axis through the ball, the ankle goes round a
 * circle, and the cosine law gives the angle between it and the hip. */
static ff_quat heel_in_reach(const ff_body_frame *body, ff_foothold ball, int foot, ff_vec3 hip,
                             ff_quat rotation, double reach, double most)
{
    ff_vec3 lateral = ff_v3(ff_cos(ball.yaw), 0.0, -ff_sin(ball.yaw)),
            ahead = ff_v3(-lateral.z, 0.0, lateral.x);
    ff_vec3 centre = ff_v3(ball.b, ball.height, ball.a);
    ff_vec3 ankle = ff_sub3(ff_gait_ankle(body, foot, ball, rotation), centre), to_hip = ff_sub3(hip, centre);
    double ankle_ahead = ff_dot3(ankle, ahead), hip_ahead = ff_dot3(to_hip, ahead);
    double aside = ff_dot3(to_hip, lateral) - ff_dot3(ankle, lateral);
    double near2 = ankle_ahead * ankle_ahead + ankle.y * ankle.y;
    double far2 = hip_ahead * hip_ahead + to_hip.y * to_hip.y;
    double cosine =
        (near2 + far2 + aside * aside - reach * reach) / (2.0 * sqrt(ff_max(near2 * far2, 1e-12)));
    double between = ff_atan2(hip_ahead, to_hip.y) - ff_atan2(ankle_ahead, ankle.y);
    double open = ff_acos(cosine);
    if (open < 2.0 * LEAST_OPEN) open = LEAST_OPEN + open * open / (4.0 * LEAST_OPEN);
    double raise = ff_clamp(ff_wrap(between) - open, 0.0, most);
    return ff_quat_mul(ff_quat_axis(lateral, raise), rotation);
}

#define MOST_BEND (80.0 * FF_DEG)
#define LEAST_BEND 1e-4 /* rad: less is rounding */

static ff_quat bend_up(ff_quat toes, double angle)
{
    return ff_quat_mul(ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -angle), toes);
}

/* Toes bend up where the floor is in their way: at push-off, and in mid swing to keep clear of it. */
static ff_quat toes_on_floor(const ff_body_frame *body, const ff_leg_target *target, int foot,
                             ff_quat foot_turn, ff_quat toes)
{
    if (fabs(target->toes_more) > LEAST_BEND) toes = bend_up(toes, target->toes_more);
    ff_vec3 tip = ff_quat_rotate(foot_turn, ff_quat_rotate(toes, body->toe[foot]));
    ff_foothold ball = target->ball;
    double least = body->ball_rest + body->toe[foot].y + target->clearance - ball.height;
    if (tip.y >= least) return toes;
    double ahead = tip.z * ff_cos(ball.yaw) + tip.x * ff_sin(ball.yaw), now = ff_atan2(tip.y, ahead);
    double length = sqrt(ahead * ahead + tip.y * tip.y);
    double up = 0.5 * FF_PI - ff_acos(least / ff_max(length, 1e-6)) - now;
    return bend_up(toes, ff_clamp(up, 0.0, MOST_BEND));
}

/* The same joint of both legs. */
static ff_pairq both_rotations(const ff_quat *rotations, int left)
{
    return ff_pairq_of(rotations[left], rotations[left + FF_JOINT_LEG_STRIDE]);
}

static ff_pair3 both_offsets(const ff_body_frame *body, int left)
{
    return ff_pair3_of(body->offset[left], body->offset[left + FF_JOINT_LEG_STRIDE]);
}

static void put_both(ff_pairq turned, int left, ff_quat *rotations)
{
    rotations[left] = ff_pairq_half(turned, 0);
    rotations[left + FF_JOINT_LEG_STRIDE] = ff_pairq_half(turned, 1);
}

void ff_legs_of_clip(const ff_body_frame *body, ff_vec3 hips, const ff_quat *rotations, ff_legs *out)
{
    ff_pairq turn = ff_pairq_of(rotations[FF_JOINT_HIPS], rotations[FF_JOINT_HIPS]);
    out->hip =
        ff_pair3_add(ff_pair3_of(hips, hips), ff_pairq_rotate(turn, both_offsets(body, FF_JOINT_HIP_L)));
    out->thigh = ff_pairq_mul(turn, both_rotations(rotations, FF_JOINT_HIP_L));
    out->knee = ff_pair3_add(out->hip, ff_pairq_rotate(out->thigh, both_offsets(body, FF_JOINT_KNEE_L)));
    out->shank = ff_pairq_mul(out->thigh, both_rotations(rotations, FF_JOINT_KNEE_L));
    out->ankle = ff_pair3_add(out->knee, ff_pairq_rotate(out->shank, both_offsets(body, FF_JOINT_ANKLE_L)));
    out->foot = ff_pairq_mul(out->shank, both_rotations(rotations, FF_JOINT_ANKLE_L));
}

void ff_legs_of_pose(const ff_body_frame *body, ff_vec3 hips, const ff_quat *rotations, ff_vec3 ball[2],
                     ff_quat foot_turn[2])
{
    ff_legs legs;
    ff_legs_of_clip(body, hips, rotations, &legs);
    ff_pair3 balls =
        ff_pair3_add(legs.ankle, ff_pairq_rotate(legs.foot, both_offsets(body, FF_JOINT_BALL_L)));
    for (int foot = 0; foot < 2; ++foot) {
        foot_turn[foot] = ff_pairq_half(legs.foot, foot);
        ball[foot] = ff_pair3_half(balls, foot);
    }
}

ff_vec3 ff_leg_ankle(const ff_body_frame *body, int foot, const ff_leg_target *target, ff_vec3 hip,
                     ff_quat *turn)
{
    double length = body->thigh[foot] + body->shank[foot];
    if (target->raise > 0.0) {
        ff_vec3 lateral = ff_v3(ff_cos(target->ball.yaw), 0.0, -ff_sin(target->ball.yaw));
        *turn = ff_quat_mul(ff_quat_axis(lateral, target->raise), *turn);
    }
    ff_vec3 ankle = ff_gait_ankle(body, foot, target->ball, *turn);
    double distance = ff_length3(ff_sub3(ankle, hip));
    double allowed = allowed_distance(target, distance, length) + (target->swing > 0.0 ? 0.0 : target->give);
    if (target->grip > 0.0 && distance > allowed) {
        ff_quat raised = heel_in_reach(body, target->ball, foot, hip, *turn, allowed, target->most_raise);
        *turn = target->grip < 1.0 ? ff_quat_nlerp(*turn, raised, target->grip) : raised;
        ankle = ff_gait_ankle(body, foot, target->ball, *turn);
    }
    return target->swing > 0.0 ? swing_in_reach(target, hip, ankle, length) : ankle;
}

void ff_legs_pose(const ff_body_frame *body, const ff_leg_target target[2], ff_legs *legs, ff_quat *rotations)
{
    ff_vec3 ankle[2];
    ff_quat turn[2], toes[2];
    for (int foot = 0; foot < 2; ++foot) {
        turn[foot] = target[foot].turn;
        ankle[foot] = ff_leg_ankle(body, foot, &target[foot], ff_pair3_half(legs->hip, foot), &turn[foot]);
        toes[foot] = toes_on_floor(body, &target[foot], foot, turn[foot],
                                   rotations[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE]);
    }
    legs->foot = ff_pairq_of(turn[0], turn[1]);
    ff_legs_solve(legs, legs->hip, ff_pair3_of(ankle[0], ankle[1]));
    ff_pairq hips = ff_pairq_of(rotations[FF_JOINT_HIPS], rotations[FF_JOINT_HIPS]);
    put_both(ff_pairq_mul(ff_pairq_conj(hips), legs->thigh), FF_JOINT_HIP_L, rotations);
    put_both(ff_pairq_mul(ff_pairq_conj(legs->thigh), legs->shank), FF_JOINT_KNEE_L, rotations);
    put_both(ff_pairq_mul(ff_pairq_conj(legs->shank), legs->foot), FF_JOINT_ANKLE_L, rotations);
    put_both(ff_pairq_of(toes[0], toes[1]), FF_JOINT_BALL_L, rotations);
}
