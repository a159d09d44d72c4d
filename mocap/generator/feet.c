#include "mocap/generator/feet.h"
#include "mocap/generator/skeleton.h"

#define CLEARANCE 0.022    /* m, lowest point of the sole in mid swing (gait facts: 1.1 to 2.3 cm) */
#define ANKLES_APART 0.088 /* m, sideways as they pass (gait facts: 8.7 to 9.4 cm) */
#define SLAP 0.9           /* how fast the sole starts to come down, of pitch over the time until flat */
#define INSTANT 1e-5       /* s, for one-sided differences */

/* ----------------------------------------------------------------------------------------------- one foot */

ff_quat ff_foot_rotation(const ff_foot_pose *pose)
{
    return ff_quat_mul(ff_quat_yaw(pose->yaw), ff_quat_axis(ff_v3(1, 0, 0), -pose->pitch));
}

static const ff_vec3 ankle_to_ball = {0.0, FF_BODY_BALL_HEIGHT - FF_BODY_ANKLE_HEIGHT, FF_BODY_FOOT};
static const ff_vec3 ankle_to_heel = {0.0, FF_BODY_BALL_HEIGHT - FF_BODY_ANKLE_HEIGHT, -FF_BODY_HEEL};

ff_vec3 ff_foot_ball(const ff_foot_pose *pose)
{
    return ff_add3(pose->ankle, ff_quat_rotate(ff_foot_rotation(pose), ankle_to_ball));
}
ff_vec3 ff_foot_heel(const ff_foot_pose *pose)
{
    return ff_add3(pose->ankle, ff_quat_rotate(ff_foot_rotation(pose), ankle_to_heel));
}

/* Standing or rolling: about the heel while the toes come down, about the ball while the heel goes up. */
static ff_foot_pose standing(const ff_footing *footing, double t)
{
    ff_foot_pose pose = {.yaw = footing->yaw};
    if (t < footing->flat) {
        double u = (t - footing->contact) / (footing->flat - footing->contact);
        pose.pitch = footing->pitch_contact * ff_hermite(u, 1.0, 0.0, -SLAP, 0.0);
    } else if (t > footing->heel_off) {
        double u = (t - footing->heel_off) / (footing->release - footing->heel_off);
        double risen =
            ff_hermite(u, 0.0, 1.0, 0.0, 1.6); /* slow start, as measured from heel off to toe off */
        pose.pitch = footing->pitch_release * risen;
        pose.yaw += footing->twist * risen;
    }
    ff_quat rotation = ff_foot_rotation(&pose);
    ff_vec3 ball = ff_ground(footing->ball, FF_BODY_BALL_HEIGHT);
    if (pose.pitch > 0.0 && t < footing->flat) {
        ff_vec2 heel = ff_madd2(footing->ball, ff_fwd2(footing->yaw), -(FF_BODY_FOOT + FF_BODY_HEEL));
        pose.ankle = ff_sub3(ff_ground(heel, FF_BODY_BALL_HEIGHT), ff_quat_rotate(rotation, ankle_to_heel));
        pose.toe_extension = 0.3 * pose.pitch;
    } else {
        pose.ankle = ff_sub3(ball, ff_quat_rotate(rotation, ankle_to_ball));
        pose.toe_extension = -pose.pitch; /* the floor bends the toes */
    }
    return pose;
}

/* --------------------------------------------------------------------------------------------------- swing */

/* A foot in the root's frame: forward, left, height of the ankle, pitch, yaw. */
typedef struct ff_local_foot {
    double v[5];
} ff_local_foot;

static ff_local_foot to_local(const ff_plan *plan, const ff_foot_pose *pose, double t)
{
    ff_root root = ff_plan_root(plan, t);
    ff_vec2 p = ff_plan_to_local(&root, ff_plane(pose->ankle));
    return (ff_local_foot){{p.a, p.b, pose->ankle.y, pose->pitch, pose->yaw - root.heading}};
}

/* Value and rate (per second) of the foot at both ends of a swing, in the root's frame. */
typedef struct ff_swing {
    ff_local_foot from, to, from_rate, to_rate;
    double start, duration;
} ff_swing;

/* The foot an instant before contact: its heel comes with what speed it has left in the recordings, forward and a
 * little downward, and the sole already turns down as it will after contact. */
static ff_foot_pose arriving(const ff_plan *plan, const ff_footing *next, const ff_foot_pose *landing)
{
    ff_root root = ff_plan_root(plan, next->contact);
    ff_vec2 travel = ff_from_frame2(ff_fwd2(root.heading), ff_v2(root.forward, root.left));
    double speed = ff_length2(travel), left_over = plan->style.run ? 0.36 * speed : 0.22 + 0.19 * speed;
    if (speed < 0.15) left_over = speed;
    /* a foot that lands flat is set down, not laid down */
    double flat = 1.0 - ff_smooth(next->pitch_contact / (12.0 * FF_DEG));
    double fall =
        plan->style.run ? 0.45 : 0.10 + 0.03 * speed + 0.27 * flat * (1.0 - 0.3 * ff_smooth(speed / 0.5));
    ff_foot_pose almost = *landing;
    if (next->flat > next->contact)
        almost.pitch += INSTANT * SLAP * next->pitch_contact / (next->flat - next->contact);
    ff_vec3 heel = ff_foot_heel(landing);
    heel = ff_sub3(heel, ff_ground(ff_scale2(ff_unit2(travel), left_over * INSTANT), -fall * INSTANT));
    almost.ankle = ff_sub3(heel, ff_quat_rotate(ff_foot_rotation(&almost), ankle_to_heel));
    return almost;
}

static void swing_ends(const ff_plan *plan, const ff_footing *last, const ff_footing *next, ff_swing *swing)
{
    double off = last->release, on = next->contact;
    swing->start = off;
    swing->duration = on - off;
    ff_foot_pose leaving = standing(last, off), before = standing(last, off - INSTANT);
    swing->from = to_local(plan, &leaving, off);
    ff_local_foot was = to_local(plan, &before, off - INSTANT);
    ff_foot_pose landing = standing(next, on), almost = arriving(plan, next, &landing);
    swing->to = to_local(plan, &landing, on);
    ff_local_foot next_to_last = to_local(plan, &almost, on - INSTANT);
    for (int i = 0; i < 5; ++i) {
        swing->from_rate.v[i] = (swing->from.v[i] - was.v[i]) / INSTANT;
        swing->to_rate.v[i] = (swing->to.v[i] - next_to_last.v[i]) / INSTANT;
    }
}

/* shape + what makes both ends and their rates right. What the rates lack is made up early (the foot leaves faster than
 * it rolls) and late, so that the measured shape rules in between. */
static double fitted(const ff_swing *swing, int i, double u, double shape, const double end[2],
                     const double slope[2])
{
    const double early = 0.50, late = 0.60;
    double t = swing->duration, value = shape;
    value += ff_hermite(u, swing->from.v[i] - end[0], swing->to.v[i] - end[1], 0.0, 0.0);
    if (u < early)
        value += early * ff_hermite(u / early, 0.0, 0.0, swing->from_rate.v[i] * t - slope[0], 0.0);
    if (u > 1.0 - late)
        value +=
            late * ff_hermite((u - 1.0 + late) / late, 0.0, 0.0, 0.0, swing->to_rate.v[i] * t - slope[1]);
    return value;
}

/* A measured curve over the swing: value at u, values and slopes (per unit of u) at its ends, all times scale. */
static double swing_shape(const ff_fourier *curve, double stance, double u, double scale, double end[2],
                          double slope[2])
{
    double span = 1.0 - stance;
    end[0] = scale * ff_fourier_slope(curve, stance, &slope[0]);
    end[1] = scale * ff_fourier_slope(curve, 1.0, &slope[1]);
    slope[0] *= span * scale;
    slope[1] *= span * scale;
    return scale * ff_fourier_at(curve, stance + u * span);
}

/* The toes leave last: they hang down from the rising ball with their tip on the floor. */
static double dragged_toes(const ff_foot_pose *pose)
{
    double rise = ff_foot_ball(pose).y - FF_BODY_BALL_HEIGHT;
    double sine = ff_clamp(rise / FF_BODY_TOES, 0.0, 0.8);
    return -ff_atan2(sine, sqrt(1.0 - sine * sine)) - pose->pitch;
}

/* Both feet in the air: no measured shape, the body's flight carries them. */
static ff_foot_pose leaping(const ff_plan *plan, const ff_swing *swing, const ff_footing *next, double t)
{
    const double none[2] = {0.0, 0.0};
    double u = (t - swing->start) / swing->duration;
    ff_local_foot at;
    for (int i = 0; i < 5; ++i)
        at.v[i] = fitted(swing, i, u, 0.0, none, none);
    at.v[2] += 4.0 * next->lift * u * (1.0 - u) * ff_smooth(4.0 * u) * ff_smooth(4.0 * (1.0 - u));
    ff_root root = ff_plan_root(plan, t);
    ff_foot_pose pose = {.yaw = at.v[4] + root.heading, .pitch = at.v[3], .swinging = true};
    pose.ankle = ff_ground(ff_plan_to_world(&root, ff_v2(at.v[0], at.v[1])), at.v[2]);
    pose.toe_extension = ff_lerp(-swing->from.v[3], -swing->to.v[3], u) * (1.0 - 2.4 * u * (1.0 - u));
    pose.toe_extension = ff_max(pose.toe_extension, dragged_toes(&pose));
    return pose;
}

static ff_foot_pose swinging(const ff_plan *plan, int foot, const ff_footing *last, const ff_footing *next,
                             double t)
{
    ff_swing swing;
    swing_ends(plan, last, next, &swing);
    double u = (t - swing.start) / swing.duration, bump = ff_sin(FF_PI * u);
    bump *= bump;
    if (plan->jump) return leaping(plan, &swing, next, t);
    ff_gait_set set;
    double speed = 0.5 * (last->speed + next->speed);
    ff_gait_set_at(0, ff_max(speed, 1.0), plan->style.run, &set);
    double stance = ff_usual_stance(ff_clamp(speed, 1.0, 1.7), false) - 0.055;
    if (plan->style.run) stance = 0.265;
    double size = ff_min(1.0, -last->pitch_release / ((plan->style.run ? 42.0 : 44.0) * FF_DEG));
    double end[2], slope[2];
    ff_local_foot at;
    /* along the ground: the measured fore-aft progress, applied to whatever way the foot has to go */
    double z = swing_shape(&set.curve[FF_CURVE_ANKLE_Z], stance, u, 1.0, end, slope);
    double span = end[1] - end[0], progress = (z - end[0]) / span;
    for (int i = 0; i < 2; ++i) {
        double way = swing.to.v[i] - swing.from.v[i];
        double e[2] = {0.0, way}, s[2] = {way * slope[0] / span, way * slope[1] / span};
        double shape = way * progress;
        at.v[i] = fitted(&swing, i, u, shape, e, s);
    }
    at.v[1] += (foot == 0 ? 1.0 : -1.0) * next->aside * bump;
    double y = swing_shape(&set.curve[FF_CURVE_ANKLE_Y], stance, u, size * FF_BODY_LEG, end, slope);
    at.v[2] = fitted(&swing, 2, u, y, end, slope) + next->lift * bump;
    double pitch = swing_shape(&set.curve[FF_CURVE_FOOT_PITCH_UP], stance, u, size, end, slope);
    at.v[3] = fitted(&swing, 3, u, pitch, end, slope);
    double none[2] = {0.0, 0.0};
    at.v[4] = fitted(&swing, 4, u, 0.0, none, none);

    ff_root root = ff_plan_root(plan, t);
    ff_foot_pose pose = {.yaw = at.v[4] + root.heading, .pitch = at.v[3], .swinging = true};
    pose.ankle = ff_ground(ff_plan_to_world(&root, ff_v2(at.v[0], at.v[1])), at.v[2]);
    double bent = -last->pitch_release, landing = 0.3 * next->pitch_contact;
    pose.toe_extension = ff_lerp(bent, 8.0 * FF_DEG, ff_smooth(u / 0.35));
    pose.toe_extension = ff_lerp(pose.toe_extension, landing, ff_smooth((u - 0.6) / 0.4));
    double leave = ff_smooth((t - last->toe_off + 0.01) / 0.09);
    if (leave < 1.0) pose.toe_extension = ff_lerp(dragged_toes(&pose), pose.toe_extension, leave);
    pose.toe_extension = ff_max(pose.toe_extension, dragged_toes(&pose)); /* not through the floor */
    return pose;
}

ff_foot_pose ff_foot_at(const ff_plan *plan, int foot, double t)
{
    const ff_footing *list = plan->footings[foot];
    int n = plan->footing_count[foot], i = 0;
    while (i + 1 < n && t >= list[i + 1].contact)
        ++i;
    if (t <= list[i].release || i + 1 == n)
        return standing(&list[i], ff_clamp(t, list[i].contact, list[i].release));
    return swinging(plan, foot, &list[i], &list[i + 1], t);
}

/* ----------------------------------------------------------------------------------------------- clearance */

static double sole_height(const ff_foot_pose *pose)
{
    ff_vec3 ball = ff_foot_ball(pose), heel = ff_foot_heel(pose);
    double toe = ball.y + FF_BODY_TOES * ff_sin(pose->pitch + pose->toe_extension);
    return ff_min(ff_min(ball.y, heel.y), toe) - FF_BODY_BALL_HEIGHT;
}

/* How much further outward, in the root's frame, the swinging foot should be from the standing one. */
static double too_close(const ff_plan *plan, int foot, const ff_foot_pose *pose, double t)
{
    ff_foot_pose other = ff_foot_at(plan, 1 - foot, t);
    if (other.swinging) return 0.0;
    ff_local_foot a = to_local(plan, pose, t), b = to_local(plan, &other, t);
    double fore = fabs(a.v[0] - b.v[0]), side = (foot == 0 ? 1.0 : -1.0) * (a.v[1] - b.v[1]);
    return (ANKLES_APART - side) * (1.0 - ff_smooth((fore - 0.10) / 0.15));
}

static void clear_swing(const ff_plan *plan, int foot, const ff_footing *last, ff_footing *next)
{
    double lift = plan->style.run ? 0.0 : -0.03, aside = 0.012;
    double clearance = CLEARANCE + 0.020 * (1.0 - ff_smooth(next->speed / 0.4));
    next->lift = next->aside = 0.0;
    for (int k = 20; k <= 76; k += 2) {
        double u = k / 100.0, bump = ff_sin(FF_PI * u), t = ff_lerp(last->release, next->contact, u);
        ff_foot_pose pose = swinging(plan, foot, last, next, t);
        bump *= bump;
        if (k >= 40 && k <= 70) lift = ff_max(lift, (clearance - sole_height(&pose)) / bump);
        aside = ff_max(aside, too_close(plan, foot, &pose, t) / bump);
    }
    next->lift = ff_min(lift, 0.10);
    next->aside = ff_min(aside, 0.12);
}

void ff_feet_clear(ff_plan *plan)
{
    if (plan->jump) return;
    for (int foot = 0; foot < 2; ++foot)
        for (int i = 1; i < plan->footing_count[foot]; ++i)
            clear_swing(plan, foot, &plan->footings[foot][i - 1], &plan->footings[foot][i]);
}
