#include "preprocess/clean/clean_finish.h"

#define FOOT_UNDER 0.007          /* m, how far a heel or ball may be under its height on the ground ... */
#define TOE_UNDER 0.006           /* ... and a toe tip */
#define HEEL_MOST (20.0 * FF_DEG) /* by which a heel may rise where the leg is too short */
enum { GROWTH_FRAMES = 2 };
#define KNEE_LEAST (0.6 * FF_DEG)

/* One leg in the world. */
typedef struct leg_now {
    ff_vec3 hip, ankle;
    ff_quat thigh, shank, foot;
} leg_now;

static leg_now leg_of(const ff_rig *rig, const ff_clean_pose *pose, int side)
{
    const ff_quat *local = pose->legs[side];
    int first = ff_leg_role(side, FF_LEG_HIP);
    leg_now leg;
    leg.hip = ff_add3(pose->hips, ff_quat_rotate(pose->pelvis, rig->offset[first]));
    leg.thigh = ff_quat_mul(pose->pelvis, local[FF_LEG_HIP]);
    leg.shank = ff_quat_mul(leg.thigh, local[FF_LEG_KNEE]);
    leg.foot = ff_quat_mul(leg.shank, local[FF_LEG_ANKLE]);
    ff_vec3 knee = ff_add3(leg.hip, ff_quat_rotate(leg.thigh, rig->offset[first + FF_LEG_KNEE]));
    leg.ankle = ff_add3(knee, ff_quat_rotate(leg.shank, rig->offset[first + FF_LEG_ANKLE]));
    return leg;
}

/* The knee turned about its own axis so that hip and ankle are distance apart: the law of cosines on the angle about
 * that axis (cleanup study, section 5: without the sign the knee snaps backwards). */
static ff_quat bend_knee(ff_quat knee, double thigh, double shank, double distance)
{
    ff_vec3 seen = ff_quat_rotate(ff_quat_conj(knee), ff_v3(0.0, -thigh, 0.0));
    double flat =
        sqrt(seen.y * seen.y + seen.z * seen.z); /* thigh, but for what leans out of the knee's plane */
    double cosine =
        (distance * distance - thigh * thigh - shank * shank) / (2.0 * shank * ff_max(flat, 1e-6));
    double wanted = ff_acos(ff_min(cosine, ff_cos(KNEE_LEAST)));
    return ff_quat_mul(knee, ff_quat_axis(ff_v3(1.0, 0.0, 0.0), wanted - ff_knee_flexion(knee)));
}

void ff_clean_reach(const ff_rig *rig, ff_clean_pose *pose, int side, ff_vec3 ankle, ff_quat foot)
{
    ff_quat *local = pose->legs[side];
    leg_now leg = leg_of(rig, pose, side);
    int first = ff_leg_role(side, FF_LEG_HIP);
    ff_vec3 thigh = rig->offset[first + FF_LEG_KNEE], shank = rig->offset[first + FF_LEG_ANKLE];
    ff_vec3 wanted = ff_sub3(ankle, leg.hip);
    local[FF_LEG_KNEE] =
        bend_knee(local[FF_LEG_KNEE], ff_length3(thigh), ff_length3(shank), ff_length3(wanted));
    ff_vec3 reached = ff_add3(thigh, ff_quat_rotate(local[FF_LEG_KNEE], shank));
    ff_quat swing = ff_quat_between(ff_unit3(ff_quat_rotate(leg.thigh, reached)), ff_unit3(wanted));
    ff_quat turned = ff_quat_mul(swing, leg.thigh);
    local[FF_LEG_HIP] = ff_quat_unit(ff_quat_mul(ff_quat_conj(pose->pelvis), turned));
    turned = ff_quat_mul(turned, local[FF_LEG_KNEE]);
    local[FF_LEG_ANKLE] = ff_quat_unit(ff_quat_mul(ff_quat_conj(turned), foot));
    pose->flexion[side] = ff_knee_flexion(local[FF_LEG_KNEE]);
}

static double longest_reach(const ff_rig *rig, int side)
{
    int first = ff_leg_role(side, FF_LEG_HIP);
    double thigh = ff_length3(rig->offset[first + FF_LEG_KNEE]);
    double shank = ff_length3(rig->offset[first + FF_LEG_ANKLE]);
    return sqrt(thigh * thigh + shank * shank + 2.0 * thigh * shank * ff_cos(KNEE_LEAST));
}

/* A foot whose ball stands at ball while the leg is too short for its heel to be down: how it is turned with the heel
 * raised over the ball just so far that the ankle comes within reach of the hip. */
static ff_quat raise_heel(ff_vec3 hip, double reach, ff_vec3 ball, ff_vec3 to_ball, ff_quat foot)
{
    ff_vec3 across = ff_quat_rotate(foot, ff_v3(1.0, 0.0, 0.0));
    double low = 0.0, high = 0.0;
    for (int i = 0; i < 40; ++i) {
        double angle = i == 0 ? 0.0 : (i == 1 ? HEEL_MOST : 0.5 * (low + high));
        ff_quat turned = ff_quat_mul(ff_quat_axis(across, angle), foot);
        bool near = ff_length3(ff_sub3(ff_sub3(ball, ff_quat_rotate(turned, to_ball)), hip)) <= reach;
        if (i == 0 && near) return foot;
        if (near || i == 1)
            high = angle;
        else
            low = angle;
    }
    return ff_quat_mul(ff_quat_axis(across, high), foot);
}

/* How a foot has to be moved and turned to stand in its place. */
typedef struct correction {
    ff_vec3 shift, turn; /* of the ankle (m), of the foot (rotation vector, world) */
} correction;

static correction find_correction(const ff_rig *rig, const ff_clean_pose *pose, const ff_clean_pin *pin,
                                  const ff_clean_plant *plant, double heel_share)
{
    leg_now leg = leg_of(rig, pose, pin->foot);
    ff_vec3 heel, ball, to_ball = rig->offset[ff_leg_role(pin->foot, FF_LEG_BALL)];
    ff_vec3 to_heel = rig->offset[pin->foot == FF_LEFT ? FF_BODY_HEEL_L : FF_BODY_HEEL_R];
    ff_clean_plant_places(rig, plant, &heel, &ball);
    ff_quat foot = leg.foot;
    if (heel_share > 0.0) {
        ff_vec3 along = ff_quat_rotate(foot, ff_unit3(ff_sub3(to_ball, to_heel)));
        ff_quat turn = ff_quat_between(along, ff_unit3(ff_sub3(ball, heel)));
        foot = ff_quat_mul(ff_quat_exp(ff_scale3(ff_quat_log(turn), heel_share)), foot);
    }
    foot = raise_heel(leg.hip, longest_reach(rig, pin->foot), ball, to_ball, foot);
    ff_vec3 ankle = ff_sub3(ball, ff_quat_rotate(foot, to_ball));
    return (correction){ff_sub3(ankle, leg.ankle), ff_quat_log(ff_quat_mul(foot, ff_quat_conj(leg.foot)))};
}

static void correct(const ff_rig *rig, ff_motion *motion, int frame, int foot, const correction *by)
{
    ff_clean_pose pose;
    ff_clean_pose_read(motion, frame, &pose);
    leg_now leg = leg_of(rig, &pose, foot);
    ff_quat turned = ff_quat_mul(ff_quat_exp(by->turn), leg.foot);
    ff_clean_reach(rig, &pose, foot, ff_add3(leg.ankle, by->shift), turned);
    ff_clean_pose_write(&pose, motion, frame);
}

/* Frames over which a correction may fade from one end of a pin: not beyond the middle of the gap to the next one. */
static int fade_frames(const ff_clean_pins *pins, int index, int direction, double frame_time)
{
    const ff_clean_pin *pin = &pins->items[index];
    int fade = (int)(pins->settings->fade / frame_time + 0.5);
    for (int i = 0; i < pins->count; ++i) {
        const ff_clean_pin *other = &pins->items[i];
        if (i == index || other->foot != pin->foot) continue;
        int gap = direction > 0 ? other->first - pin->last - 1 : pin->first - other->last - 1;
        if (gap >= 0 && gap / 2 < fade) fade = gap / 2;
    }
    return fade;
}

/* One end of a pin: the correction there and by how much it grew towards the end in the last frame. */
typedef struct pin_end {
    correction at, growth;
} pin_end;

/* Hermite from (at, growth) to nothing, n frames on: neither a jump nor a kink. */
static correction faded(const pin_end *end, int i, int n)
{
    double s = (double)i / n, value = 1.0 - s * s * (3.0 - 2.0 * s), slope = n * s * (1.0 - s) * (1.0 - s);
    return (correction){ff_madd3(ff_scale3(end->at.shift, value), end->growth.shift, slope),
                        ff_madd3(ff_scale3(end->at.turn, value), end->growth.turn, slope)};
}

static void fade_out(const ff_rig *rig, ff_motion *motion, const ff_clean_pins *pins, int index,
                     int direction, const pin_end *end)
{
    const ff_clean_pin *pin = &pins->items[index];
    int fade = fade_frames(pins, index, direction, motion->frame_time);
    for (int i = 1; i <= fade; ++i) {
        int frame = direction > 0 ? pin->last + i : pin->first - i;
        if (frame < 0 || frame >= motion->frame_count) return;
        correction by = faded(end, i, fade + 1);
        correct(rig, motion, frame, pin->foot, &by);
    }
}

/* The correction of one frame as the motion is now. */
static correction needed(const ff_rig *rig, const ff_motion *motion, const ff_clean_pins *pins, int index,
                         int frame)
{
    ff_clean_pose pose;
    const ff_clean_pin *pin = &pins->items[index];
    ff_clean_pose_read(motion, frame, &pose);
    return find_correction(rig, &pose, pin, &pins->plants[index],
                           ff_clean_heel_share(pins, pin, frame, motion->frame_time));
}

static pin_end end_of(const ff_rig *rig, const ff_motion *motion, const ff_clean_pins *pins, int index,
                      int frame, int inward)
{
    pin_end end = {.at = needed(rig, motion, pins, index, frame)};
    const ff_clean_pin *pin = &pins->items[index];
    if (pin->last - pin->first < GROWTH_FRAMES) return end;
    correction before = needed(rig, motion, pins, index, frame + GROWTH_FRAMES * inward);
    end.growth.shift = ff_scale3(ff_sub3(end.at.shift, before.shift), 1.0 / GROWTH_FRAMES);
    end.growth.turn = ff_scale3(ff_sub3(end.at.turn, before.turn), 1.0 / GROWTH_FRAMES);
    return end;
}

static void close_pin(const ff_rig *rig, ff_motion *motion, const ff_clean_pins *pins, int index)
{
    const ff_clean_pin *pin = &pins->items[index];
    pin_end first = end_of(rig, motion, pins, index, pin->first, 1);
    pin_end last = end_of(rig, motion, pins, index, pin->last, -1);
    for (int frame = pin->first; frame <= pin->last; ++frame) {
        correction by = needed(rig, motion, pins, index, frame);
        correct(rig, motion, frame, pin->foot, &by);
    }
    fade_out(rig, motion, pins, index, -1, &first);
    fade_out(rig, motion, pins, index, 1, &last);
}

/* ------------------------------------------------------------------------------------------------ out of the ground */

/* Turn about a unit axis, the smallest, that brings the tip of a lever to a height over the axis: y(t) = still + R cos(t -
 * phase). */
static double lifting_turn(ff_vec3 lever, ff_vec3 axis, double height)
{
    double still = axis.y * ff_dot3(axis, lever), sine = ff_cross3(axis, lever).y, cosine = lever.y - still;
    double reach = sqrt(sine * sine + cosine * cosine);
    if (reach < 1e-9) return 0.0;
    double phase = ff_atan2(sine, cosine), away = ff_acos((height - still) / reach);
    double forth = ff_wrap(phase + away), back = ff_wrap(phase - away);
    return fabs(forth) < fabs(back) ? forth : back;
}

/* Raise a heel over its ball, a whole foot by its leg, and toes by their joint, until nothing is far under the ground. */
static void lift_foot(const ff_rig *rig, ff_clean_pose *pose, int side, double ground)
{
    const double zero[FF_CLEAN_LEG] = {0};
    const ff_vec3 x = {1.0, 0.0, 0.0};
    ff_vec3 places[FF_FOOT_PLACES], to_ball = rig->offset[ff_leg_role(side, FF_LEG_BALL)];
    ff_clean_foot(rig, pose, side, zero, zero, places, NULL);
    double heel = ground - FOOT_UNDER - places[FF_FOOT_AT_HEEL].y;
    double ball = ground - FOOT_UNDER - places[FF_FOOT_AT_BALL].y;
    if (heel > 0.0 || ball > 0.0) {
        leg_now leg = leg_of(rig, pose, side);
        ff_vec3 axis = ff_quat_rotate(leg.foot, x), middle = places[FF_FOOT_AT_BALL];
        if (ball > 0.0) middle.y += ball;
        ff_vec3 lever = ff_sub3(places[FF_FOOT_AT_HEEL], places[FF_FOOT_AT_BALL]);
        double least = ground - FOOT_UNDER - middle.y;
        if (lever.y < least)
            leg.foot = ff_quat_mul(ff_quat_axis(axis, lifting_turn(lever, axis, least)), leg.foot);
        ff_clean_reach(rig, pose, side, ff_sub3(middle, ff_quat_rotate(leg.foot, to_ball)), leg.foot);
        ff_clean_foot(rig, pose, side, zero, zero, places, NULL);
    }
    double least = ground - TOE_UNDER - places[FF_FOOT_AT_BALL].y;
    ff_vec3 toes = ff_sub3(places[FF_FOOT_AT_TOE], places[FF_FOOT_AT_BALL]);
    if (toes.y >= least) return;
    leg_now leg = leg_of(rig, pose, side);
    double turn = lifting_turn(toes, ff_quat_rotate(leg.foot, x), least);
    pose->legs[side][FF_LEG_BALL] = ff_quat_mul(pose->legs[side][FF_LEG_BALL], ff_quat_axis(x, turn));
}

static void lift_feet(const ff_rig *rig, ff_motion *motion, const ff_clean_pins *pins)
{
    for (int frame = 0; frame < motion->frame_count; ++frame) {
        ff_clean_pose pose;
        ff_clean_pose_read(motion, frame, &pose);
        for (int side = 0; side < 2; ++side)
            lift_foot(rig, &pose, side, ff_clean_ground(pins, side, frame));
        ff_clean_pose_write(&pose, motion, frame);
    }
}

void ff_clean_finish(const ff_rig *rig, ff_motion *motion, const ff_clean_pins *pins)
{
    for (int i = 0; i < pins->count; ++i)
        close_pin(rig, motion, pins, i);
    lift_feet(rig, motion, pins);
}
