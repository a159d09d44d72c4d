/* gait_pose.c - the joints of a gait's present state. */
#include "runtime/core/gait_hips.h"
#include "runtime/core/leg_ik.h"

#define BREATH (0.7 * FF_DEG)
#define LOOK (5.0 * FF_DEG)
#define TOE_CLEARANCE 0.015 /* m, over the rest height of the toe tip (gait facts: people 1.4 to 2.3 cm) */

/* Blended local rotations of everything but the hips, the idle pose mixed in while standing. */
static void sample_joints(const ff_blend_space *space, const ff_gait *gait, const ff_cursor *cursor,
                          ff_quat *rotations)
{
    ff_cursor idle;
    bool standing = ff_gait_idle_cursor(space, gait, &idle);
    double share = ff_smooth(gait->stand);
    for (int j = FF_JOINT_SPINE; j < FF_JOINT_COUNT; ++j) {
        rotations[j] = standing && share >= 1.0 ? ff_sample_rotation(space, &idle, j)
                                                : ff_sample_rotation(space, cursor, j);
        if (ff_pose_offset_active(&gait->offset))
            rotations[j] = ff_pose_offset_turn(&gait->offset, j, rotations[j]);
        if (standing && share < 1.0)
            rotations[j] = ff_quat_nlerp(rotations[j], ff_sample_rotation(space, &idle, j), share);
    }
}

/* A standing person breathes and looks about. */
static void apply_idle_life(const ff_gait *gait, ff_quat *rotations)
{
    double share = ff_smooth(gait->stand), t = gait->idle_time;
    if (share <= 0.0) return;
    double breath = BREATH * ff_sin(t * FF_TAU / 3.9);
    double look = LOOK * (ff_sin(t * FF_TAU / 11.3) + 0.5 * ff_sin(t * FF_TAU / 6.1));
    ff_quat bend = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), share * breath);
    rotations[FF_JOINT_CHEST] = ff_quat_mul(bend, rotations[FF_JOINT_CHEST]);
    rotations[FF_JOINT_NECK] = ff_quat_mul(ff_quat_yaw(share * look), rotations[FF_JOINT_NECK]);
}

/* The person: how far the arms swing about the idle pose, how upright the spine is. */
static void apply_style(const ff_blend_space *space, const ff_gait *gait, ff_quat *rotations)
{
    static const int arms[4] = {FF_JOINT_SHOULDER_L, FF_JOINT_ELBOW_L, FF_JOINT_SHOULDER_R, FF_JOINT_ELBOW_R};
    if (space->idle >= 0) {
        ff_cursor rest = ff_cursor_of_vertex(space, space->idle, 0.0);
        for (int i = 0; i < 4; ++i)
            rotations[arms[i]] = ff_quat_nlerp(ff_sample_rotation(space, &rest, arms[i]), rotations[arms[i]],
                                               gait->style.arms);
    }
    ff_quat stoop = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), gait->style.stoop);
    rotations[FF_JOINT_SPINE] = ff_quat_mul(stoop, rotations[FF_JOINT_SPINE]);
    rotations[FF_JOINT_NECK] = ff_quat_mul(ff_quat_conj(stoop), rotations[FF_JOINT_NECK]);
}

#define FLAT_TO (5.0 * FF_DEG) /* pitch up to which a foot has no roll of its own */
#define FREE_FROM (25.0 * FF_DEG)

/* A foot near the ground is set by its yaw and pitch alone, so that it lies flat. One on its toes or in the air is
 * turned as in the clip, but for the yaw, taken as the twist about the vertical: the heading of a foot that hangs
 * straight down says nothing. */
static ff_quat foot_rotation(const ff_gait_foot *state, ff_quat clip)
{
    ff_quat flat = ff_gait_foot_rotation(state->now.yaw, state->pitch);
    double share = ff_smooth((fabs(state->pitch) - FLAT_TO) / (FREE_FROM - FLAT_TO));
    if (share <= 0.0) return flat;
    double twist = 2.0 * ff_atan2(clip.y, clip.w);
    ff_quat free = ff_quat_mul(ff_quat_yaw(state->now.yaw - twist), clip);
    return ff_quat_nlerp(flat, free, share);
}

/* A planted foot out of reach lifts its heel about the ball before anything slides: by the least angle that brings the
 * ankle within reach, found by bisection. */
static ff_quat heel_in_reach(const ff_body_frame *body, const ff_gait_foot *state, int foot, ff_vec3 hip,
                             ff_quat rotation, double reach)
{
    ff_vec3 lateral = ff_v3(ff_cos(state->now.yaw), 0.0, -ff_sin(state->now.yaw));
    double low = 0.0, high = 60.0 * FF_DEG;
    for (int i = 0; i < 12; ++i) {
        double middle = 0.5 * (low + high);
        ff_quat raised = ff_quat_mul(ff_quat_axis(lateral, middle), rotation);
        ff_vec3 ankle = ff_gait_ankle(body, foot, state->now, raised);
        if (ff_length3(ff_sub3(ankle, hip)) <= reach) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return ff_quat_mul(ff_quat_axis(lateral, high), rotation);
}

/* Toes bend up where the floor is in their way: at push-off, and in mid swing to keep clear of it. */
static ff_quat toes_on_floor(const ff_body_frame *body, const ff_gait_foot *state, int foot,
                             ff_quat foot_turn, ff_quat toes)
{
    ff_vec3 tip = ff_quat_rotate(foot_turn, ff_quat_rotate(toes, body->toe[foot]));
    double arc = state->planted ? 0.0 : 4.0 * state->progress * (1.0 - state->progress);
    double least = body->ball_rest + body->toe[foot].y + TOE_CLEARANCE * arc - state->now.height;
    if (tip.y >= least) return toes;
    double ahead = tip.z * ff_cos(state->now.yaw) + tip.x * ff_sin(state->now.yaw);
    double length = sqrt(ahead * ahead + tip.y * tip.y);
    double wanted = 0.5 * FF_PI - ff_acos(least / ff_max(length, 1e-6));
    double up = ff_clamp(wanted - ff_atan2(tip.y, ahead), 0.0, 80.0 * FF_DEG);
    return ff_quat_mul(ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -up), toes);
}

static ff_leg leg_of_clip(const ff_body_frame *body, ff_vec3 hips, ff_quat hips_turn,
                          const ff_quat *rotations, int joint)
{
    ff_leg leg;
    leg.hip = ff_add3(hips, ff_quat_rotate(hips_turn, body->offset[joint]));
    leg.thigh = ff_quat_mul(hips_turn, rotations[joint]);
    leg.knee = ff_add3(leg.hip, ff_quat_rotate(leg.thigh, body->offset[joint + 1]));
    leg.shank = ff_quat_mul(leg.thigh, rotations[joint + 1]);
    leg.ankle = ff_add3(leg.knee, ff_quat_rotate(leg.shank, body->offset[joint + 2]));
    leg.foot = ff_quat_mul(leg.shank, rotations[joint + 2]);
    return leg;
}

static void pose_leg(const ff_body_frame *body, const ff_gait_foot *state, int foot, ff_vec3 hips,
                     ff_quat hips_turn, ff_quat *rotations)
{
    int joint = FF_JOINT_HIP_L + foot * FF_JOINT_LEG_STRIDE;
    ff_leg leg = leg_of_clip(body, hips, hips_turn, rotations, joint);
    double reach = FF_LEG_REACH * (body->thigh[foot] + body->shank[foot]);
    leg.foot = foot_rotation(state, leg.foot);
    ff_vec3 ankle = ff_gait_ankle(body, foot, state->now, leg.foot);
    if (state->planted && ff_length3(ff_sub3(ankle, leg.hip)) > reach) {
        leg.foot = heel_in_reach(body, state, foot, leg.hip, leg.foot, reach);
        ankle = ff_gait_ankle(body, foot, state->now, leg.foot);
    }
    ff_leg_solve(&leg, leg.hip, ankle);
    rotations[joint] = ff_quat_mul(ff_quat_conj(hips_turn), leg.thigh);
    rotations[joint + 1] = ff_quat_mul(ff_quat_conj(leg.thigh), leg.shank);
    rotations[joint + 2] = ff_quat_mul(ff_quat_conj(leg.shank), leg.foot);
    rotations[joint + 3] = toes_on_floor(body, state, foot, leg.foot, rotations[joint + 3]);
}

void ff_gait_pose(const ff_blend_space *space, const ff_gait *gait, ff_vec2 position, double heading,
                  ff_vec3 *hips, ff_quat *rotations)
{
    ff_cursor cursor = ff_cursor_at(space, &gait->blend, gait->phase, gait->idle_time);
    ff_gait_hips(space, gait, &cursor, position, heading, hips, &rotations[FF_JOINT_HIPS]);
    hips->y -= gait->hips_drop;
    sample_joints(space, gait, &cursor, rotations);
    apply_style(space, gait, rotations);
    apply_idle_life(gait, rotations);
    for (int foot = 0; foot < 2; ++foot)
        pose_leg(&space->body, &gait->foot[foot], foot, *hips, rotations[FF_JOINT_HIPS], rotations);
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        rotations[j] = ff_quat_unit(rotations[j]);
}
