/* gait_pose.c - the joints of a gait's present state. */
#include "runtime/core/gait/gait_hips.h"
#include "runtime/core/gait/leg_pose.h"

#include <string.h>

#define BREATH (0.7 * FF_DEG)
#define LOOK (5.0 * FF_DEG)

#define TOE_CLEARANCE 0.016 /* m, over the rest height of the toe tip (gait facts: people 1.4 to 2.3 cm) */

/* Local rotations of everything but the hips: of the motion, with what is left of the one before, and while standing of the
 * idle pose. */
static void sample_joints(const ff_blend_space *space, const ff_gait *gait, const ff_cursor *cursor,
                          ff_quat *rotations)
{
    ff_cursor idle;
    ff_quat still[FF_JOINT_COUNT];
    double share = ff_gait_idle_cursor(space, gait, &idle) ? ff_smooth(gait->stand) : 0.0;
    bool between = share > 0.0 && share < 1.0;
    bool offset = share < 1.0 && ff_pose_offset_active(&gait->offset); /* who stands shows neither way */
    bool at_once = between && !offset && !cursor->clip;
    ff_sample_rotations(space, share >= 1.0 ? &idle : cursor, at_once ? &idle : NULL, share, rotations);
    for (int j = FF_JOINT_SPINE; j < FF_JOINT_COUNT && offset; ++j)
        rotations[j] = ff_pose_offset_turn(&gait->offset, j, rotations[j]);
    if (!between || at_once) return;
    ff_sample_rotations(space, &idle, NULL, 0.0, still);
    for (int j = FF_JOINT_SPINE; j < FF_JOINT_COUNT; ++j)
        rotations[j] = ff_quat_nlerp(rotations[j], still[j], share);
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
    for (int i = 0; i < FF_ARM_JOINTS && space->idle >= 0; ++i) {
        int32_t joint = ff_arm_joints[i];
        rotations[joint] = ff_quat_nlerp(space->rest[joint], rotations[joint], gait->style.arms);
    }
    ff_quat stoop = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), gait->style.stoop);
    rotations[FF_JOINT_SPINE] = ff_quat_mul(stoop, rotations[FF_JOINT_SPINE]);
    rotations[FF_JOINT_NECK] = ff_quat_mul(ff_quat_conj(stoop), rotations[FF_JOINT_NECK]);
}

#define FLAT_TO (5.0 * FF_DEG) /* pitch up to which a foot has no roll of its own */
#define FREE_FROM (25.0 * FF_DEG)

/* A foot near the ground is set by its yaw and pitch alone, so that it lies flat. One on its toes or in the air rolls as in
 * the clip, but for the yaw, taken as the twist about the vertical: the heading of a foot that hangs straight down says
 * nothing. Its pitch is the gait's: small steps of the semi-procedural clip do not lift the heel as high as the clip's. In a
 * run, whose feet are thrown up beyond the vertical, it is the clip's. own: the share of the gait's. */
static ff_quat foot_rotation(const ff_gait_foot *state, ff_quat clip, double own)
{
    ff_quat flat = ff_gait_foot_rotation(state->now.yaw, state->pitch);
    double share = ff_smooth((fabs(state->pitch) - FLAT_TO) / (FREE_FROM - FLAT_TO));
    if (share <= 0.0) return flat;
    ff_quat turn = ff_quat_mul(ff_quat_yaw(-2.0 * ff_atan2(clip.y, clip.w)), clip);
    ff_vec3 ahead = ff_quat_rotate(turn, ff_v3(0.0, 0.0, 1.0));
    double up = own * ff_wrap(state->pitch - ff_atan2(ahead.y, ahead.z));
    turn = ff_quat_mul(ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -up), turn);
    return ff_quat_nlerp(flat, ff_quat_mul(ff_quat_yaw(state->now.yaw), turn), share);
}

/* 1 at the last change of way to 0. */
static double left_of_change(const ff_pose_offset *offset)
{
    return ff_pose_offset_active(offset) ? 1.0 - ff_smooth(offset->age / FF_POSE_OFFSET_TIME) : 0.0;
}

#define ROLLS (20.0 * FF_DEG) /* pitch of a foot that is up on its toes */
#define FLIES 0.08            /* of the swing, from where on, and until where before its end, a foot flies */

double ff_gait_toe_clearance(const ff_gait_foot *state)
{
    if (state->planted) return 0.0;
    double arc = 4.0 * state->progress * (1.0 - state->progress);
    double given =
        state->progress < 0.5 ? ff_max(state->give, 0.0) : 0.0; /* by which the foot is lower; none at 0.5 */
    return (TOE_CLEARANCE + given) * arc;
}

ff_leg_target ff_gait_leg_target(const ff_gait_foot *state, ff_quat turn)
{
    double swing = state->planted ? 0.0 : state->progress;
    double round = ff_max(ff_smooth(-state->pitch / ROLLS), ff_min(ff_min(swing, 1.0 - swing) / FLIES, 1.0));
    return (ff_leg_target){.ball = state->now,
                           .turn = turn,
                           .clearance = ff_gait_toe_clearance(state),
                           .most_raise = state->planted ? FF_MOST_RAISE : state->most_raise,
                           .grip = 1.0,
                           .swing = swing,
                           .round = round,
                           .toes_more = state->toes_more,
                           .give = state->give,
                           .raise = state->planted ? 0.0 : state->least_raise};
}

static void pose_legs(const ff_body_frame *body, const ff_gait *gait, ff_vec3 hips, ff_quat *rotations)
{
    ff_legs legs;
    ff_leg_target target[2];
    ff_legs_of_clip(body, hips, rotations, &legs);
    double own = gait->blend.way == FF_RUNNING ? left_of_change(&gait->offset) : 1.0;
    for (int foot = 0; foot < 2; ++foot)
        target[foot] = ff_gait_leg_target(
            &gait->foot[foot], foot_rotation(&gait->foot[foot], ff_pairq_half(legs.foot, foot), own));
    ff_legs_pose(body, target, &legs, rotations);
}

void ff_gait_idle_pose(const ff_blend_space *space, double idle_time, ff_vec2 position, double heading,
                       ff_vec3 *hips, ff_quat *rotations)
{
    ff_gait gait;
    memset(&gait, 0, sizeof gait);
    gait.stand = 1.0;
    gait.idle_time = idle_time;
    ff_blend_find(space, gait.rates, &gait.blend);
    ff_cursor cursor = ff_cursor_at(space, &gait.blend, 0.0, idle_time);
    ff_gait_hips(space, &gait, &cursor, position, heading, hips, &rotations[FF_JOINT_HIPS]);
    sample_joints(space, &gait, &cursor, rotations);
    apply_idle_life(&gait, rotations);
}

/* One step of Newton's method: what is a float's rounding off comes within 1e-13. */
static ff_quat near_unit(ff_quat q)
{
    double scale = 1.5 - 0.5 * ff_quat_dot(q, q);
    return (ff_quat){q.x * scale, q.y * scale, q.z * scale, q.w * scale};
}

void ff_gait_pose(const ff_blend_space *space, const ff_gait *gait, ff_vec2 position, double heading,
                  ff_vec3 *hips, ff_quat *rotations)
{
    ff_cursor cursor = ff_cursor_at(space, &gait->blend, gait->phase, gait->idle_time);
    position = ff_scale2(position, 1.0 / gait->style.scale);
    ff_gait_hips(space, gait, &cursor, position, heading, hips, &rotations[FF_JOINT_HIPS]);
    hips->y -= gait->hips_drop;
    sample_joints(space, gait, &cursor, rotations);
    apply_style(space, gait, rotations);
    apply_idle_life(gait, rotations);
    pose_legs(&space->body, gait, *hips, rotations);
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        rotations[j] = near_unit(rotations[j]);
    *hips = ff_scale3(*hips, gait->style.scale);
}
