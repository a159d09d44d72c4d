#include "preprocess/examples/gait_fit.h"

#include <string.h>

#define FEW 3     /* walks, to fit a law to */
#define NEAR 0.02 /* m/s or step ratio: walks as fast as the clip say nothing about a slope */
#define STEEP 5.0 /* a slope that no gait has: the walks are too alike, or no walks */

/* Of people in general (gait facts: step length grows as speed^0.52; stance shrinks by 0.07 per m/s; the study's scaling
 * for the rest): what holds when the clips do not tell. */
#define CADENCE 0.48
#define STANCE_SLOPE (-0.07)
static const double laws_of_people[FF_GAIT_LAW_COUNT] = {
    [FF_GAIT_LAW_LIFT] = 0.4, [FF_GAIT_LAW_PITCH] = 0.8, [FF_GAIT_LAW_BOB] = 1.2, [FF_GAIT_LAW_SWAY] = -0.4};

/* -------------------------------------------------------------------------------------------- one cycle's paths */

/* A walk as the model sees it: both feet brought to one, stance the same share on both sides. */
typedef struct walk_paths {
    double speed, period, stance, centre[3];
    ff_pack_gait_path path[FF_GAIT_SAMPLES];
} walk_paths;

typedef struct foot_sample {
    double ball[3], yaw, pitch;
} foot_sample;

/* A runner's foot swings past the vertical, where yaw and pitch go over to the other side of the same rotation: yaw jumps by
 * half a turn, and pitch turns back. Followed is the pitch, beyond a right angle. */
static ff_pack_foot unfolded(const ff_pack_foot *at)
{
    ff_pack_foot out = *at;
    if (fabs((double)at->yaw) <= 0.5 * FF_PI) return out;
    out.yaw = (float)ff_wrap((double)at->yaw + FF_PI);
    out.pitch = (float)((at->pitch < 0.0f ? -FF_PI : FF_PI) - (double)at->pitch);
    return out;
}

static foot_sample foot_at(const ff_example *e, int foot, double phase)
{
    int n = e->frame_count;
    double frame = (phase - floor(phase)) * n, t = frame - floor(frame), side = foot ? -1.0 : 1.0;
    const ff_pack_foot p = unfolded(&e->feet[2 * ((int)frame % n) + foot]),
                       q = unfolded(&e->feet[2 * (((int)frame + 1) % n) + foot]);
    foot_sample out;
    for (int i = 0; i < 3; ++i)
        out.ball[i] = ff_lerp((double)p.ball[i], (double)q.ball[i], t);
    out.ball[1] *= side;
    out.yaw = side * ((double)p.yaw + ff_wrap((double)q.yaw - (double)p.yaw) * t);
    out.pitch = ff_lerp((double)p.pitch, (double)q.pitch, t);
    return out;
}

static double contact_of(const ff_example *e, int foot)
{
    return (double)e->record.key[foot ? 2 : 0];
}

static double stance_of(const ff_example *e, int foot)
{
    double stance = (double)e->record.key[foot ? 1 : 3] - contact_of(e, foot);
    return stance < 0.0 ? stance + 1.0 : stance;
}

/* A foot's own phase, in a cycle whose stance is the mean of both feet's, to the example's. */
static double unwarp(const ff_example *e, int foot, double stance, double phase)
{
    double own = stance_of(e, foot);
    double at = phase < stance ? phase / stance * own : own + (phase - stance) / (1.0 - stance) * (1.0 - own);
    return contact_of(e, foot) + at;
}

/* Mean over the middle of the stance of both feet: where the foot is when it stands under the body. */
static void find_centre(const ff_example *e, double centre[3])
{
    memset(centre, 0, 3 * sizeof *centre);
    for (int foot = 0; foot < 2; ++foot) {
        double from = (double)e->record.lock[foot][0], to = (double)e->record.lock[foot][1];
        foot_sample at = foot_at(e, foot, from + 0.5 * (to < from ? to + 1.0 - from : to - from));
        centre[0] += 0.5 * at.ball[0];
        centre[1] += 0.5 * at.ball[1];
        centre[2] += 0.5 * at.yaw;
    }
}

static void take_hips(const ff_example *e, walk_paths *out)
{
    double height = 0.0;
    ff_quat unused[FF_ROLE_JOINT_COUNT];
    for (int k = 0; k < FF_GAIT_SAMPLES; ++k) {
        double phase = k / (double)FF_GAIT_SAMPLES;
        ff_vec3 one, other;
        ff_example_sample(e, phase, &one, unused);
        ff_example_sample(e, contact_of(e, FF_RIGHT) + phase, &other, unused);
        float *hips = out->path[k].hips;
        hips[0] = (float)(0.5 * (one.x + other.x));
        hips[1] = (float)(0.5 * (one.y - other.y));
        hips[2] = (float)(0.5 * (one.z + other.z));
        height += (double)hips[2] / FF_GAIT_SAMPLES;
    }
    for (int k = 0; k < FF_GAIT_SAMPLES; ++k)
        out->path[k].hips[2] = (float)((double)out->path[k].hips[2] - height);
}

static void take_paths(const ff_rig *rig, const ff_example *e, walk_paths *out)
{
    ff_vec3 rest[FF_BODY_COUNT];
    ff_rig_rest_pose(rig, rest);
    out->speed = (double)e->record.v_forward;
    out->period = (double)e->record.period;
    out->stance = 0.5 * (stance_of(e, FF_LEFT) + stance_of(e, FF_RIGHT));
    find_centre(e, out->centre);
    for (int k = 0; k < FF_GAIT_SAMPLES; ++k) {
        double mean[5] = {0.0};
        for (int foot = 0; foot < 2; ++foot) {
            foot_sample at = foot_at(e, foot, unwarp(e, foot, out->stance, k / (double)FF_GAIT_SAMPLES));
            const double values[5] = {at.ball[0] - out->centre[0], at.ball[1] - out->centre[1],
                                      at.ball[2] - rest[FF_ROLE_BALL_L].y, ff_wrap(at.yaw - out->centre[2]),
                                      at.pitch};
            for (int i = 0; i < 5; ++i)
                mean[i] += 0.5 * values[i];
        }
        out->path[k] = (ff_pack_gait_path){.ahead = (float)(mean[0] / (out->speed * out->period)),
                                           .side = (float)mean[1],
                                           .lift = (float)mean[2],
                                           .yaw = (float)mean[3],
                                           .pitch = (float)mean[4]};
    }
    take_hips(e, out);
}

/* ---------------------------------------------------------------------------------------------------------- laws */

static float curve(const ff_pack_gait_path *path, int law)
{
    switch (law) {
    case FF_GAIT_LAW_LIFT:
        return path->lift;
    case FF_GAIT_LAW_PITCH:
        return path->pitch;
    case FF_GAIT_LAW_BOB:
        return path->hips[2];
    default:
        return path->hips[1];
    }
}

/* A walk's phase where the clip has reached phase: stances and swings laid on each other. */
static const ff_pack_gait_path *at_same_event(const walk_paths *walk, double stance, int k)
{
    double phase = k / (double)FF_GAIT_SAMPLES;
    double at = phase < stance ? phase / stance * walk->stance
                               : walk->stance + (phase - stance) / (1.0 - stance) * (1.0 - walk->stance);
    return &walk->path[(int)floor(at * FF_GAIT_SAMPLES + 0.5) % FF_GAIT_SAMPLES];
}

/* The factor by which the clip's curve is nearest to the walk's. */
static double amplitude_of(const walk_paths *clip, const walk_paths *walk, int law)
{
    double product = 0.0, square = 0.0;
    for (int k = 0; k < FF_GAIT_SAMPLES; ++k) {
        double own = (double)curve(&clip->path[k], law);
        product += own * (double)curve(at_same_event(walk, clip->stance, k), law);
        square += own * own;
    }
    return square > 0.0 ? product / square : 1.0;
}

/* Slope of y over x by least squares, through the origin, and the root mean square of what is left. */
typedef struct slope_fit {
    double xx, xy, yy;
    int count;
} slope_fit;

static void add_point(slope_fit *fit, double x, double y)
{
    fit->xx += x * x;
    fit->xy += x * y;
    fit->yy += y * y;
    ++fit->count;
}

static float slope_of(const slope_fit *fit, double otherwise, float *residual)
{
    double slope = fit->count >= FEW && fit->xx > fit->count * NEAR * NEAR ? fit->xy / fit->xx : otherwise;
    if (fabs(slope) > STEEP) slope = otherwise;
    double rest = fit->yy - 2.0 * slope * fit->xy + slope * slope * fit->xx;
    *residual = (float)(fit->count > 0 ? sqrt(ff_max(rest, 0.0) / fit->count) : 0.0);
    return (float)slope;
}

/* log(x) for x near 1. */
static double log_ratio(double x)
{
    double t = (x - 1.0) / (x + 1.0), t2 = t * t, term = t, sum = 0.0;
    for (int k = 1; k < 40; k += 2, term *= t2)
        sum += term / k;
    return 2.0 * sum;
}

typedef struct law_fits {
    slope_fit cadence, stance, law[FF_GAIT_LAW_COUNT];
} law_fits;

static void add_walk(law_fits *fits, const walk_paths *clip, const walk_paths *walk)
{
    double ratio = walk->speed / clip->speed;
    add_point(&fits->cadence, log_ratio(ratio), log_ratio(walk->period / clip->period));
    add_point(&fits->stance, walk->speed - clip->speed, walk->stance - clip->stance);
    for (int law = 0; law < FF_GAIT_LAW_COUNT; ++law)
        add_point(&fits->law[law], ratio - 1.0, amplitude_of(clip, walk, law) - 1.0);
}

/* Model against a walk's own balls, [3] sums of squares. */
static void add_ball_error(const ff_gait_fit *fit, const walk_paths *walk, double sums[3])
{
    ff_gait_model model = ff_gait_fit_model(fit);
    ff_rates rates = {walk->speed, 0.0, 0.0};
    for (int k = 0; k < FF_GAIT_SAMPLES; ++k) {
        ff_model_foot foot =
            ff_gait_model_foot(&model, rates, walk->period, FF_LEFT, k / (double)FF_GAIT_SAMPLES);
        const ff_pack_gait_path *own = &walk->path[k];
        const double off[3] = {foot.forward - walk->centre[0] -
                                   (double)own->ahead * walk->speed * walk->period,
                               foot.left - walk->centre[1] - (double)own->side,
                               foot.height - (double)fit->gait.ball_rest - (double)own->lift};
        for (int i = 0; i < 3; ++i)
            sums[i] += off[i] * off[i] / FF_GAIT_SAMPLES;
    }
}

static bool is_model(const ff_example *e)
{
    return e->record.gait == FF_GAIT_WALK && e->record.v_forward > 0.3f && e->record.v_left == 0.0f &&
           e->record.turn_rate == 0.0f &&
           !(e->record.flags & (FF_EXAMPLE_IDLE | FF_EXAMPLE_DERIVED | FF_EXAMPLE_LOOSE));
}

static void describe_clip(const ff_rig *rig, const walk_paths *clip, ff_gait_fit *out)
{
    ff_vec3 rest[FF_BODY_COUNT];
    ff_rig_rest_pose(rig, rest);
    memcpy(out->path, clip->path, sizeof out->path);
    out->gait = (ff_pack_gait){
        .speed = (float)clip->speed,
        .period = (float)clip->period,
        .stance = (float)clip->stance,
        .ball_rest = (float)rest[FF_ROLE_BALL_L].y,
        .centre = {(float)clip->centre[0], (float)clip->centre[1], (float)clip->centre[2]},
        .stand = {(float)(rest[FF_ROLE_BALL_L].z - rest[FF_ROLE_HIP_L].z), (float)FF_STAND_HALF_WIDTH,
                  (float)FF_STAND_TOE_OUT},
    };
}

void ff_gait_fit_make(const ff_rig *rig, const ff_example *clip, const ff_example *const *walks, int count,
                      ff_gait_fit *out)
{
    walk_paths own, walk;
    law_fits fits = {0};
    take_paths(rig, clip, &own);
    describe_clip(rig, &own, out);
    for (int i = 0; i < count; ++i) {
        if (!is_model(walks[i])) continue;
        take_paths(rig, walks[i], &walk);
        add_walk(&fits, &own, &walk);
        ++out->gait.walks;
    }
    out->gait.cadence = -slope_of(&fits.cadence, -CADENCE, &out->gait.period_residual);
    out->gait.period_residual *= out->gait.period; /* of a logarithm: a share */
    out->gait.stance_slope = slope_of(&fits.stance, STANCE_SLOPE, &out->gait.stance_residual);
    for (int law = 0; law < FF_GAIT_LAW_COUNT; ++law)
        out->gait.law[law] = slope_of(&fits.law[law], laws_of_people[law], &out->gait.residual[law]);
    double sums[3] = {0.0};
    for (int i = 0; i < count; ++i) {
        if (!is_model(walks[i])) continue;
        take_paths(rig, walks[i], &walk);
        add_ball_error(out, &walk, sums);
    }
    for (int i = 0; i < 3 && out->gait.walks > 0; ++i)
        out->gait.ball_residual[i] = (float)sqrt(sums[i] / out->gait.walks);
}
