#include "runtime/core/gait/gait_hips.h"

#include "runtime/core/gait/gait_knees.h"
#include "runtime/core/gait/gait_toes.h"
#include "runtime/core/gait/leg_ik.h"

#define SWAY_AHEAD 0.004 /* m, of standing hips */
#define SWAY_ASIDE 0.008
#define RUN_RELAX 0.03 /* m/s */
#define RUN_REACH                                                                                            \
    0.975              /* of the leg: who runs pushes off with a knee bent by 18 to 26 degrees (gait facts) */
#define MOST_DROP 0.12 /* m */
#define LANDING_SEEN 0.5 /* of the swing, from where on hips are lowered for its end */
#define DROP_FREQUENCY                                                                                       \
    14.0 /* rad/s, of the critically damped follower (about 0.2 s to settle; study, section 4.5) */

bool ff_gait_idle_cursor(const ff_blend_space *space, const ff_gait *gait, ff_cursor *out)
{
    if (space->idle < 0 || !(gait->stand > 0.0)) return false;
    *out = ff_cursor_of_vertex(space, space->idle, ff_idle_fraction(space, gait->idle_time));
    return true;
}

/* Nobody stands like a post: the weight goes slowly from foot to foot, whatever the idle example does. */
static ff_vec3 idle_sway(double idle_time)
{
    double side = ff_sin(idle_time * FF_TAU / 7.3) + 0.6 * ff_sin(idle_time * FF_TAU / 4.1);
    return ff_v3(SWAY_AHEAD * ff_sin(idle_time * FF_TAU / 5.7), SWAY_ASIDE * side, 0.0);
}

void ff_gait_hips(const ff_blend_space *space, const ff_gait *gait, const ff_cursor *cursor, ff_vec2 position,
                  double heading, ff_vec3 *hips, ff_quat *rotation)
{
    ff_vec3 place = ff_sample_hips(space, cursor);
    ff_quat turn = ff_sample_rotation(space, cursor, FF_JOINT_HIPS);
    if (ff_pose_offset_active(&gait->offset)) {
        place = ff_add3(place, ff_pose_offset_hips(&gait->offset));
        turn = ff_pose_offset_turn(&gait->offset, FF_JOINT_HIPS, turn);
    }
    ff_cursor idle;
    if (ff_gait_idle_cursor(space, gait, &idle)) {
        double share = ff_smooth(gait->stand);
        ff_vec3 standing = ff_add3(ff_sample_hips(space, &idle), idle_sway(gait->idle_time));
        place = ff_lerp3(place, standing, share);
        turn = ff_quat_nlerp(turn, ff_sample_rotation(space, &idle, FF_JOINT_HIPS), share);
    }
    ff_vec2 ground = ff_add2(position, ff_from_frame2(ff_fwd2(heading), ff_v2(place.x, place.y)));
    *hips = ff_ground(ground, place.z);
    *rotation = ff_quat_unit(ff_quat_mul(ff_quat_yaw(heading), turn));
}

ff_quat ff_gait_foot_rotation(double yaw, double pitch)
{
    double turn, turned, tip, tipped; /* sines and cosines of half the angles */
    ff_sincos(0.5 * yaw, &turn, &turned);
    ff_sincos(-0.5 * pitch, &tip, &tipped);
    return (ff_quat){turned * tip, turn * tipped, -(turn * tip), turned * tipped};
}

ff_vec3 ff_gait_ankle(const ff_body_frame *body, int foot, ff_foothold ball, ff_quat rotation)
{
    ff_vec3 to_ball = body->offset[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE];
    return ff_sub3(ff_v3(ball.b, ball.height, ball.a), ff_quat_rotate(rotation, to_ball));
}

double ff_gait_lack(ff_vec3 hip, ff_vec3 ankle, double reach)
{
    double x = ankle.x - hip.x, z = ankle.z - hip.z;
    return hip.y - ankle.y - sqrt(ff_max(reach * reach - x * x - z * z, 0.0));
}

/* Of a foot that comes down toes first; a heel that strikes is another matter (eased_bend). */
static double landing_pitch(const ff_blend_space *space, const ff_gait *gait, int foot)
{
    double start, length;
    ff_blend_lock(space, &gait->blend, foot, &start, &length);
    ff_cursor landing = ff_cursor_at(space, &gait->blend, start, gait->idle_time);
    return ff_min(ff_sample_foot(space, &landing, foot).pitch, 0.0);
}

/* From the ankle to the hip, where a swing ends: known before it gets there. */
static ff_vec3 leg_at_landing(const ff_body_frame *body, const ff_gait *gait, int foot, ff_vec3 hip,
                              double heading, double pitch)
{
    const ff_gait_foot *state = &gait->foot[foot];
    ff_vec2 moved = ff_scale2(ff_from_frame2(ff_fwd2(heading), ff_v2(gait->rates.forward, gait->rates.left)),
                              ff_gait_time_left(state));
    ff_quat turn = ff_gait_foot_rotation(state->lock.yaw, pitch);
    return ff_sub3(ff_add3(hip, ff_ground(moved, 0.0)), ff_gait_ankle(body, foot, state->lock, turn));
}

void ff_gait_lower_hips(const ff_blend_space *space, ff_gait *gait, const ff_cursor *cursor, ff_vec2 position,
                        double heading, double dt)
{
    const ff_body_frame *body = &space->body;
    ff_vec3 hips;
    ff_quat rotation;
    ff_gait_hips(space, gait, cursor, position, heading, &hips, &rotation);
    double wanted = 0.0;
    ff_limb limbs[2];
    const ff_vec3 nowhere = ff_v3(0.0, 0.0, 0.0);
    for (int foot = 0; foot < 2; ++foot) {
        const ff_gait_foot *state = &gait->foot[foot];
        int joint = FF_JOINT_HIP_L + foot * FF_JOINT_LEG_STRIDE;
        ff_vec3 hip = ff_add3(hips, ff_quat_rotate(rotation, body->offset[joint]));
        ff_quat turn = ff_gait_foot_rotation(state->now.yaw, state->pitch);
        double reach = (gait->blend.way == FF_RUNNING ? RUN_REACH : FF_LEG_REACH) *
                       (body->thigh[foot] + body->shank[foot]);
        wanted = ff_max(wanted, ff_gait_lack(hip, ff_gait_ankle(body, foot, state->now, turn), reach));
        limbs[foot] = (ff_limb){hip, nowhere, turn};
        /* Hips are low in time for where a swing ends. */
        if (state->planted || state->progress < LANDING_SEEN) continue;
        ff_vec3 landing = leg_at_landing(body, gait, foot, hip, heading, 0.0);
        wanted = ff_max(wanted, ff_gait_lack(landing, nowhere, reach));
        if (ff_gait_time_left(state) < FF_LANDS_WITHIN)
            limbs[foot].landing =
                leg_at_landing(body, gait, foot, hip, heading, landing_pitch(space, gait, foot));
    }
    wanted = ff_min(wanted, MOST_DROP);
    /* A runner's legs are stretched for a moment in each step, too short for the hips to follow: they stay low. */
    gait->hips_peak = gait->blend.way == FF_RUNNING ? ff_max(wanted, gait->hips_peak - RUN_RELAX * dt) : 0.0;
    wanted = ff_max(wanted, gait->hips_peak);
    /* Exact step of the critically damped oscillator, so that it is stable for any dt. */
    double decay = ff_exp(-DROP_FREQUENCY * dt), away = gait->hips_drop - wanted;
    double push = (gait->hips_speed + DROP_FREQUENCY * away) * dt;
    gait->hips_speed = (gait->hips_speed - DROP_FREQUENCY * push) * decay;
    gait->hips_drop = wanted + (away + push) * decay;
    for (int foot = 0; foot < 2; ++foot) {
        limbs[foot].hip.y -= gait->hips_drop;
        limbs[foot].landing.y -= gait->hips_drop;
    }
    if (dt > 0.0) ff_gait_ease_knees(space, gait, limbs, dt);
    ff_gait_bend_toes(space, gait, cursor, dt);
}
