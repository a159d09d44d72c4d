/* gait_knees.c - knees neither stop nor start within a frame: where a foot lifts or lands, where a leg comes to its reach, where hips
 * have a jerk. What is needed for it are millimetres: of hips, or between a leg's end and its foot in the air. */
#include "runtime/core/gait/gait_knees.h"

#include "runtime/core/gait/gait_hips.h"

#define KNEE_QUICK (22000.0 * FF_DEG) /* rad/s2 */
#define KNEE_LANDS (150.0 * FF_DEG)   /* rad/s */
#define STRIKES (9.0 * FF_DEG)        /* pitch of a foot whose heel comes down first */
#define LANDING_FROM 0.5              /* of the swing, from where on its end is looked at */
#define GIVE_ENDS 0.5                 /* of the swing */
#define MOST_GIVE 0.02                /* m */
#define MOST_LIFT 0.012               /* m, of hips within a step */
#define LEAST_BEND (8.0 * FF_DEG)     /* of a planted knee that takes its time to stop */
#define LEAST_RAISED 0.002            /* rad: less is rounding */
#define QUICKEST_HEEL 1.15            /* times the fastest ankle, or toes, in the database */
#define SINKS 0.6                     /* of that, the other way: in swing the shank turns against it */
#define DROP_STEPS 3
#define QUICKEST_KNEE 1.3 /* times the fastest in the database: of a knee as its foot lifts */
#define ROLLS_FIRST                                                                                          \
    (4.0 * FF_DEG) /* by which a foot rolls on instead of with a heel that was raised to be in reach ... */
#define ROLLS_LATER                                                                                          \
    0.3 /* ... and a share of what it rolls by then: heels would stop in the middle of rolling */
#define HEEL_SINKS                                                                                           \
    0.6 /* of the swing, in which a heel that was raised to be in reach comes back to the gait's */

#define SOLE 0.003 /* m, by which one yields */

double ff_gait_time_left(const ff_gait_foot *state)
{
    return state->elapsed * (1.0 - state->progress) / state->progress;
}

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

/* Knees are looked after while a foot stands, where it leaves the ground and where it comes back. */
static bool minds_knee(const ff_gait *gait, int foot)
{
    const ff_gait_foot *state = &gait->foot[foot];
    if (!state->planted) return state->progress < GIVE_ENDS || ff_gait_time_left(state) < FF_LANDS_WITHIN;
    return gait->blend.way == FF_RUNNING || gait->mode == FF_GAIT_STEP;
}

/* A foot that lands stops at once, and with it the knee if the leg was still stretching towards it: the part of that which is
 * quicker than KNEE_LANDS is done before. Where a foot takes up its swing the knee may have to turn round within a moment: it does
 * so no faster than KNEE_QUICK. For a moment the leg is longer, and its foot lower, than the swing has it. */
static double eased_bend(const ff_gait_foot *state, double bend, double at_landing, double quickest,
                         double dt)
{
    if (!(state->knee > 0.0)) return bend; /* nothing is known of it yet */
    if (state->progress < LANDING_FROM) {
        double most = KNEE_QUICK * dt, speed = (bend - state->knee) / dt;
        double slow = ff_clamp(speed, state->knee_speed - most, ff_min(state->knee_speed + most, quickest));
        return ff_lerp(state->knee + slow * dt, bend, ff_smooth(1.0 - (GIVE_ENDS - state->progress) / 0.15));
    }
    double left = ff_gait_time_left(state), share = 1.0 - left / FF_LANDS_WITHIN;
    if (share <= 0.0) return bend;
    share *= share * ff_smooth(1.0 - state->pitch / STRIKES);
    return bend - ff_max(bend - at_landing - KNEE_LANDS * left, 0.0) * share;
}

/* A leg as it is to its foot. */
typedef struct leg_now {
    ff_vec3 leg; /* from ankle to hip */
    double far, distance, bend;
    double raised; /* rad, of the heel, to be in reach */
    double lever;  /* m, that the ankle comes nearer to the hip for every radian that the heel is raised */
} leg_now;

static leg_now leg_as_is(const ff_body_frame *body, const ff_gait_foot *state, int foot, const ff_limb *limb)
{
    double thigh = body->thigh[foot], shank = body->shank[foot];
    ff_leg_target target = ff_gait_leg_target(state, limb->turn);
    ff_vec3 ankle = ff_leg_ankle(body, foot, &target, limb->hip, &target.turn);
    leg_now now = {.leg = ff_sub3(limb->hip, ankle)};
    now.far = ff_length3(now.leg);
    /* Raised, the ankle goes on ahead as far as it is over the ball, and up as far as it is behind it. */
    double over = ankle.y - state->now.height;
    double behind =
        (state->now.b - ankle.x) * ff_sin(state->now.yaw) + (state->now.a - ankle.z) * ff_cos(state->now.yaw);
    double ahead = now.leg.x * ff_sin(state->now.yaw) + now.leg.z * ff_cos(state->now.yaw);
    now.lever = (over * ahead + behind * now.leg.y) / now.far;
    now.distance = ff_leg_soft_reach(now.far, thigh + shank);
    now.bend = bend_at(now.distance, thigh, shank);
    double raised = ff_quat_angle(ff_quat_mul(ff_quat_conj(limb->turn), target.turn));
    now.raised = raised > LEAST_RAISED ? raised : 0.0;
    return now;
}

/* How much longer a leg must be for its knee to have this bend. */
static double longer_by(const ff_body_frame *body, int foot, const leg_now *now, double bend)
{
    double thigh = body->thigh[foot], shank = body->shank[foot];
    double distance = distance_at(ff_max(bend, LEAST_BEND), thigh, shank);
    return ff_leg_hard_reach(distance, thigh + shank) - now->far;
}

/* How much longer a leg is for every metre that its hip is higher. */
static double per_height(const leg_now *now)
{
    return ff_max(now->leg.y, 0.5 * now->far) / now->far;
}

/* How far hips must come down for the heel of a leg at its reach to be raised no further than by most. */
static double drop_for_heel(const ff_body_frame *body, const ff_gait_foot *state, int foot,
                            const ff_limb *limb, leg_now now, double most)
{
    ff_limb lower = *limb;
    ff_vec3 lateral = ff_v3(ff_cos(state->now.yaw), 0.0, -ff_sin(state->now.yaw));
    ff_quat turn = ff_quat_mul(ff_quat_axis(lateral, most), limb->turn);
    ff_vec3 ankle = ff_gait_ankle(body, foot, state->now, turn);
    for (int i = 0; i < DROP_STEPS && now.raised > most; ++i) { /* the leg's reach changes a little with it */
        lower.hip.y -= ff_max(ff_gait_lack(lower.hip, ankle, now.far), 0.0);
        now = leg_as_is(body, state, foot, &lower);
    }
    return limb->hip.y - lower.hip.y;
}

/* Between which heights, from here, hips must be for the knee of a planted leg neither to stop nor to start within a frame. A leg at
 * its reach, whose heel is raised, becomes longer without that, as its heel sinks: ease_planted sees to it. */
static void narrow_lift(const ff_body_frame *body, const ff_gait_foot *state, int foot, const ff_limb *limb,
                        const leg_now *now, double quickest, double dt, double range[2])
{
    double most_raise = ff_max(state->tilt + quickest + state->pitch, 0.0);
    if (now->raised > most_raise)
        range[1] = ff_min(range[1], -drop_for_heel(body, state, foot, limb, *now, most_raise));
    double next = state->knee + state->knee_speed * dt, most = KNEE_QUICK * dt * dt;
    if (now->bend > next + most) {
        double longer = longer_by(body, foot, now, next + most) - now->raised * now->lever;
        range[0] = ff_max(range[0], longer / per_height(now));
    }
    if (now->bend < next - most)
        range[1] = ff_min(range[1], longer_by(body, foot, now, next - most) / per_height(now));
}

static double lift_for_knees(const ff_body_frame *body, ff_gait *gait, const ff_limb limbs[2],
                             double quickest, double dt)
{
    double range[2] = {-1.0, 1.0};
    if (gait->blend.way == FF_RUNNING) return 0.0; /* captured runs are quicker than that */
    for (int foot = 0; foot < 2; ++foot) {
        ff_gait_foot *state = &gait->foot[foot];
        if (!state->planted || !(state->knee > 0.0) || !minds_knee(gait, foot)) continue;
        state->give = 0.0;
        leg_now now = leg_as_is(body, state, foot, &limbs[foot]);
        narrow_lift(body, state, foot, &limbs[foot], &now, quickest, dt, range);
    }
    double lift = range[0] > range[1] ? 0.5 * (range[0] + range[1]) : ff_clamp(0.0, range[0], range[1]);
    return ff_clamp(lift, -MOST_LIFT, MOST_LIFT);
}

static void ease_flying(const ff_body_frame *body, ff_gait_foot *state, int foot, const ff_limb *limb,
                        double quickest, double dt, leg_now *now)
{
    double thigh = body->thigh[foot], shank = body->shank[foot];
    double landing = bend_at(ff_leg_soft_reach(ff_length3(limb->landing), thigh + shank), thigh, shank);
    double give =
        distance_at(eased_bend(state, now->bend, landing, quickest, dt), thigh, shank) - now->distance;
    double room = (state->now.height - body->ball_rest + SOLE) / per_height(now);
    state->give = ff_clamp(give, -MOST_GIVE, ff_clamp(room, 0.0, MOST_GIVE));
    now->bend = bend_at(now->distance + state->give, thigh, shank);
}

/* A leg that comes to its reach stretches a little further before its heel comes up. */
static void ease_planted(const ff_body_frame *body, ff_gait_foot *state, int foot, const ff_limb *limb,
                         double dt, leg_now *now)
{
    double most = state->knee + (state->knee_speed + KNEE_QUICK * dt) * dt;
    if (now->raised > 0.0 && state->knee > 0.0 && now->bend > most) {
        state->give = ff_clamp(longer_by(body, foot, now, most), 0.0, MOST_GIVE);
        *now = leg_as_is(body, state, foot, limb);
    }
    state->raised = now->raised;
}

static void ease_knee(const ff_body_frame *body, ff_gait_foot *state, int foot, const ff_limb *limb,
                      double quickest, double dt)
{
    state->give = 0.0;
    leg_now now = leg_as_is(body, state, foot, limb);
    if (state->planted)
        ease_planted(body, state, foot, limb, dt, &now);
    else
        ease_flying(body, state, foot, limb, quickest, dt, &now);
    state->knee_speed = state->knee > 0.0 ? (now.bend - state->knee) / dt : 0.0;
    state->knee = now.bend;
    state->above = now.raised;
    state->tilt = now.raised - state->pitch;
}

/* A heel that was raised for its foot to be in reach, as it lifted, stays up until the gait has it there, and sinks again. */
static double raise_left(const ff_gait_foot *state)
{
    if (state->planted || state->raised <= 0.0) return 0.0;
    double rolled = ff_max(state->left_pitch - state->pitch, 0.0);
    double less = ff_min(rolled, ROLLS_FIRST) + ROLLS_LATER * ff_max(rolled - ROLLS_FIRST, 0.0);
    return ff_max(state->raised - less, 0.0) * (1.0 - ff_smooth(state->progress / HEEL_SINKS));
}

/* What is in the air need not be in reach at once, or at all, nor forget at once that it was out of it: its heel is raised and sinks no
 * faster than by quickest. Feet of who runs come up as fast as that by themselves. */
static void tip_foot(const ff_gait *gait, ff_gait_foot *state, double quickest)
{
    double least = raise_left(state);
    if (gait->blend.way != FF_RUNNING) least = ff_max(least, state->above - SINKS * quickest);
    state->least_raise = least;
    state->most_raise = ff_clamp(state->tilt + quickest + state->pitch - least, 0.0, FF_MOST_RAISE);
}

/* Of a foot that stands: should a switch lift it right now. */
static void ready_to_lift(ff_gait_foot *state, double most_tilt)
{
    state->least_raise = state->raised;
    state->most_raise = ff_clamp(most_tilt - state->tilt, 0.0, FF_MOST_RAISE);
}

static void forget_knee(ff_gait_foot *state)
{
    state->above = state->planted ? 0.0 : state->least_raise;
    state->tilt = state->above - state->pitch;
    state->knee = state->knee_speed = state->give = 0.0;
    if (state->planted) state->raised = 0.0;
}

/* rad, by which a foot may be tipped further in this step. */
static double tilt_in_step(const ff_blend_space *space, double dt)
{
    return QUICKEST_HEEL * ff_min(space->fastest[FF_JOINT_ANKLE_L], space->fastest[FF_JOINT_BALL_L]) * dt;
}

void ff_gait_ease_knees(const ff_blend_space *space, ff_gait *gait, ff_limb limbs[2], double dt)
{
    const ff_body_frame *body = &space->body;
    double quickest = tilt_in_step(space, dt), lift = lift_for_knees(body, gait, limbs, quickest, dt);
    double quickest_bend = QUICKEST_KNEE * space->fastest[FF_JOINT_KNEE_L];
    gait->hips_drop -= lift;
    for (int foot = 0; foot < 2; ++foot) {
        ff_gait_foot *state = &gait->foot[foot];
        double most_tilt = state->tilt + quickest;
        limbs[foot].hip.y += lift;
        limbs[foot].landing.y += lift;
        if (!state->planted) tip_foot(gait, state, quickest);
        if (minds_knee(gait, foot))
            ease_knee(body, state, foot, &limbs[foot], quickest_bend, dt);
        else
            forget_knee(state);
        if (state->planted) ready_to_lift(state, most_tilt);
    }
}
