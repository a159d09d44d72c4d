#include "runtime/core/gait_hips.h"

#include "runtime/core/leg_ik.h"

#define SWAY_AHEAD 0.004 /* m, of standing hips */
#define SWAY_ASIDE 0.008
#define RUN_RELAX 0.03 /* m/s */
#define RUN_REACH                                                                                            \
    0.975              /* of the leg: who runs pushes off with a knee bent by 18 to 26 degrees (gait facts) */
#define MOST_DROP 0.12 /* m */
#define KNEE_QUICK (24000.0 * FF_DEG) /* rad/s2 */
#define KNEE_LANDS (150.0 * FF_DEG)   /* rad/s */
#define LANDS_WITHIN 0.12             /* s */
#define STRIKES (5.0 * FF_DEG)        /* pitch of a foot whose heel comes down first */
#define GIVE_ENDS 0.5                 /* of the swing */
#define MOST_GIVE 0.02                /* m */
#define SOLE 0.003                    /* m, by which one yields */
#define LANDING_SEEN 0.5              /* of the swing, from where on hips are lowered for its end */
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

static double time_left(const ff_gait_foot *state)
{
    return state->elapsed * (1.0 - state->progress) / state->progress;
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
                              time_left(state));
    ff_quat turn = ff_gait_foot_rotation(state->lock.yaw, pitch);
    return ff_sub3(ff_add3(hip, ff_ground(moved, 0.0)), ff_gait_ankle(body, foot, state->lock, turn));
}

/* What the knee of a leg goes by. */
typedef struct limb {
    ff_vec3 hip, landing; /* landing: from ankle to hip, when the swing ends */
    ff_quat turn;         /* of the foot */
} limb;

/* The bend of a knee between two bones whose ends are this far from each other, and back. */
static double bend_at(double distance, double thigh, double shank)
{
    double cosine = (distance * distance - thigh * thigh - shank * shank) / (2.0 * thigh * shank);
    return ff_acos(cosine);
}

static double distance_at(double bend, double thigh, double shank)
{
    return sqrt(thigh * thigh + shank * shank + 2.0 * thigh * shank * ff_cos(bend));
}

/* Knees are looked after where a foot leaves the ground, from when the other one is about to be down, and where it comes back. */
static bool minds_knee(const ff_gait *gait, int foot)
{
    const ff_gait_foot *state = &gait->foot[foot], *other = &gait->foot[1 - foot];
    if (!state->planted) return state->progress < GIVE_ENDS || time_left(state) < LANDS_WITHIN;
    if (gait->blend.way == FF_RUNNING) return true;
    return gait->mode == FF_GAIT_STEP && (other->planted || other->progress > 0.2);
}

/* A foot that lands stops at once, and with it the knee if the leg was still stretching towards it: the part of that which is
 * quicker than KNEE_LANDS is done before. Where a foot takes up its swing the knee may have to turn round within a moment: it does
 * so no faster than KNEE_QUICK. For a moment the leg is longer, and its foot lower, than the swing has it. */
static double eased_bend(const ff_gait_foot *state, double bend, double at_landing, double dt)
{
    if (!(state->knee > 0.0)) return bend; /* nothing is known of it yet */
    if (state->progress < LANDING_SEEN) {
        double most = KNEE_QUICK * dt, speed = (bend - state->knee) / dt;
        double slow = ff_clamp(speed, state->knee_speed - most, state->knee_speed + most);
        return ff_lerp(state->knee + slow * dt, bend, ff_smooth(1.0 - (GIVE_ENDS - state->progress) / 0.15));
    }
    double left = time_left(state), share = 1.0 - left / LANDS_WITHIN;
    if (share <= 0.0) return bend;
    share *= share * ff_smooth(1.0 - state->pitch / STRIKES);
    return bend - ff_max(bend - at_landing - KNEE_LANDS * left, 0.0) * share;
}

static void ease_knee(const ff_body_frame *body, ff_gait_foot *state, int foot, const limb *leg_at, double dt)
{
    double thigh = body->thigh[foot], shank = body->shank[foot], length = thigh + shank;
    state->give = 0.0;
    ff_leg_target target = ff_gait_leg_target(state, leg_at->turn);
    ff_vec3 leg = ff_sub3(leg_at->hip, ff_leg_ankle(body, foot, &target, leg_at->hip, &target.turn));
    double far = ff_length3(leg), distance = ff_leg_soft_reach(far, length);
    double bend = bend_at(distance, thigh, shank);
    if (!state->planted) {
        double landing = bend_at(ff_leg_soft_reach(ff_length3(leg_at->landing), length), thigh, shank);
        double give = distance_at(eased_bend(state, bend, landing, dt), thigh, shank) - distance;
        double room = (state->now.height - body->ball_rest + SOLE) * far / ff_max(leg.y, 0.5 * far);
        state->give = ff_clamp(give, -MOST_GIVE, ff_clamp(room, 0.0, MOST_GIVE));
        bend = bend_at(distance + state->give, thigh, shank);
    }
    state->knee_speed = state->knee > 0.0 ? (bend - state->knee) / dt : 0.0;
    state->knee = bend;
}

void ff_gait_lower_hips(const ff_blend_space *space, ff_gait *gait, const ff_cursor *cursor, ff_vec2 position,
                        double heading, double dt)
{
    const ff_body_frame *body = &space->body;
    ff_vec3 hips;
    ff_quat rotation;
    ff_gait_hips(space, gait, cursor, position, heading, &hips, &rotation);
    double wanted = 0.0;
    limb limbs[2];
    const ff_vec3 nowhere = ff_v3(0.0, 0.0, 0.0);
    for (int foot = 0; foot < 2; ++foot) {
        const ff_gait_foot *state = &gait->foot[foot];
        int joint = FF_JOINT_HIP_L + foot * FF_JOINT_LEG_STRIDE;
        ff_vec3 hip = ff_add3(hips, ff_quat_rotate(rotation, body->offset[joint]));
        ff_quat turn = ff_gait_foot_rotation(state->now.yaw, state->pitch);
        double reach = (gait->blend.way == FF_RUNNING ? RUN_REACH : FF_LEG_REACH) *
                       (body->thigh[foot] + body->shank[foot]);
        wanted = ff_max(wanted, ff_gait_lack(hip, ff_gait_ankle(body, foot, state->now, turn), reach));
        limbs[foot] = (limb){hip, nowhere, turn};
        /* Hips are low in time for where a swing ends. */
        if (state->planted || state->progress < LANDING_SEEN) continue;
        ff_vec3 landing = leg_at_landing(body, gait, foot, hip, heading, 0.0);
        wanted = ff_max(wanted, ff_gait_lack(landing, nowhere, reach));
        if (time_left(state) < LANDS_WITHIN)
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
    for (int foot = 0; foot < 2 && dt > 0.0; ++foot) {
        limbs[foot].hip.y -= gait->hips_drop;
        limbs[foot].landing.y -= gait->hips_drop;
        if (minds_knee(gait, foot))
            ease_knee(body, &gait->foot[foot], foot, &limbs[foot], dt);
        else
            gait->foot[foot].knee = gait->foot[foot].knee_speed = gait->foot[foot].give = 0.0;
    }
}
