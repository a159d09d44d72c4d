/* gait_toes.c - toes carry nothing: they may come later than their motion has them, as long as they are not in the floor. */
#include "runtime/core/gait/gait_toes.h"

#include "runtime/core/gait/gait_hips.h"

#define QUICKEST 1.3    /* times the fastest in the database */
#define TOES_RELAX 0.42 /* of the swing, in which toes that the floor has bent come back to the clip's */
#define TOES_LOOSE (6.0 * FF_DEG) /* how far toes of a foot that stands may be off the floor */

static double bend_of(ff_quat toes)
{
    return -2.0 * ff_atan2(toes.x, toes.w);
}

/* How the motion bends toes, with what is left of the one before, or who stands has them (sample_joints in gait_pose.c). */
static double own_bend(const ff_blend_space *space, const ff_gait *gait, const ff_cursor *cursor,
                       const ff_cursor *idle, int joint)
{
    double share = idle ? ff_smooth(gait->stand) : 0.0;
    if (share >= 1.0) return bend_of(ff_sample_rotation(space, idle, joint));
    ff_quat toes = ff_sample_rotation(space, cursor, joint);
    if (ff_pose_offset_active(&gait->offset)) toes = ff_pose_offset_turn(&gait->offset, joint, toes);
    if (share > 0.0) toes = ff_quat_nlerp(toes, ff_sample_rotation(space, idle, joint), share);
    return bend_of(toes);
}

/* By how much toes must be bent for their tips to have the clearance. */
static double bend_on_floor(const ff_body_frame *body, const ff_gait_foot *state, int foot, double clearance)
{
    double least = body->ball_rest + body->toe[foot].y + clearance - state->now.height;
    double up = 0.5 * FF_PI - ff_acos(least / body->toe_length[foot]);
    return up - body->toe_flat[foot] + state->tilt;
}

static void bend_toes(const ff_body_frame *body, ff_gait_foot *state, int foot, double own, double most)
{
    double wanted = own, on_floor = bend_on_floor(body, state, foot, ff_gait_toe_clearance(state));
    if (state->planted) {
        wanted = ff_min(own, ff_max(state->tilt, 0.0) + TOES_LOOSE);
    } else if (state->progress < TOES_RELAX) {
        /* A foot that rises quickly is off the floor before its toes have come back from where that has bent them. */
        double bent = 1.0 - ff_smooth(state->progress / TOES_RELAX);
        wanted = ff_max(own, own + bent * (state->tilt - ff_max(own, bent * own)));
    }
    wanted = ff_max(wanted, on_floor);
    /* A switch, which takes no time, looks at the new way by itself before it adds what is left of the old one. */
    if (most > 0.0) state->toes = ff_max(ff_clamp(wanted, state->toes - most, state->toes + most), on_floor);
    state->toes_more = state->toes - own;
}

void ff_gait_bend_toes(const ff_blend_space *space, ff_gait *gait, const ff_cursor *cursor, double dt)
{
    ff_cursor idle;
    bool stands = ff_gait_idle_cursor(space, gait, &idle);
    for (int foot = 0; foot < 2; ++foot) {
        int joint = FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE;
        double own = own_bend(space, gait, cursor, stands ? &idle : NULL, joint);
        bend_toes(&space->body, &gait->foot[foot], foot, own, QUICKEST * space->fastest[joint] * dt);
    }
}
