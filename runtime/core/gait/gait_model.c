#include "runtime/core/gait/gait_model.h"

#define LIFT_MIN 0.045    /* m, the ball rises at least this far in a swing in place ... */
#define LIFT_FADE 0.75    /* ... and by this share less in one as long as the clip's, which rises by itself */
#define CLEARANCE 0.04    /* m, how far a turning body's swing foot goes round the other one */
#define ANKLES_APART 0.14 /* m, of a strafe's closed feet */
#define LEAST_SIZE 0.12   /* step ratio (study, section 5) */
#define MOST_SIZE 1.15
#define FITTED_FROM 0.6 /* step ratio of the slowest walks that laws are fitted to */
#define LIFT_LEAST 0.6  /* of the clip's */
#define LIFT_MOST 1.3
#define SWAY_LEAST 0.6
#define STANCE_MIN 0.55 /* a walk always has both feet down for a while */
#define STANCE_MAX 0.75
#define STEP_PERIOD 1.1 /* s, of stepping in place */
#define SLOW 0.3        /* m/s, from where on the cadence law holds */
#define PERIOD_MIN 0.72 /* s */
#define PERIOD_MAX 1.6
#define SIDE_PERIOD 0.95 /* s, less SIDE_SLOPE per m/s */
#define SIDE_SLOPE 0.25
#define TURN_PER_CYCLE (0.5 * FF_PI)
/* Study, section 7: a strafe without them is an A-frame with a still trunk. */
#define SHIFT 0.4      /* of the way from the middle to the standing foot, in a side step */
#define SHIFT_FULL 0.3 /* m/s, from where on it is all of that */
#define RISE 0.018     /* m, either way, at LEAN_FULL: else knees stay bent for the widest moment */
#define LEAN 0.05      /* rad, at LEAN_FULL */
#define LEAN_FULL 0.6  /* m/s */
#define LEAN_SWAY 0.03 /* rad, over the standing foot, together with the shift */

static double fraction(double x)
{
    return x - floor(x);
}

double ff_gait_model_size(const ff_gait_model *model, ff_rates rates)
{
    return ff_clamp(fabs(rates.forward) / (double)model->gait->speed, LEAST_SIZE, MOST_SIZE);
}

/* x to the power of y for x > 0, from the reproducible functions: halving brings x near 1, where a series is exact. */
static double power(double x, double y)
{
    double log = 0.0;
    while (x > 1.5)
        x *= 0.5, log += 0.69314718055994530942;
    while (x < 0.75)
        x *= 2.0, log -= 0.69314718055994530942;
    double t = (x - 1.0) / (x + 1.0), t2 = t * t, term = t, sum = 0.0;
    for (int k = 1; k < 28; k += 2, term *= t2)
        sum += term / k;
    return ff_exp(y * (log + 2.0 * sum));
}

double ff_gait_model_period(const ff_gait_model *model, ff_rates rates)
{
    double ahead = fabs(rates.forward), aside = fabs(rates.left), speed = sqrt(ahead * ahead + aside * aside);
    double low = ff_max(PERIOD_MIN, 0.75 * (double)model->gait->period);
    double high = ff_min(PERIOD_MAX, 1.4 * (double)model->gait->period);
    double walk = (double)model->gait->period *
                  power(ff_max(speed, SLOW) / (double)model->gait->speed, -(double)model->gait->cadence);
    walk = ff_lerp(STEP_PERIOD, ff_clamp(walk, low, high), ff_min(1.0, speed / SLOW));
    double side = ff_clamp(SIDE_PERIOD - SIDE_SLOPE * aside, PERIOD_MIN, SIDE_PERIOD);
    double share = speed > 1e-9 ? aside / (ahead + aside) * ff_min(1.0, speed / SLOW) : 0.0;
    double period = ff_lerp(walk, side, share), turn = fabs(rates.turn);
    if (turn * period > TURN_PER_CYCLE) period = ff_max(PERIOD_MIN, TURN_PER_CYCLE / turn);
    return period;
}

double ff_gait_model_stance(const ff_gait_model *model, ff_rates rates)
{
    const ff_pack_gait *gait = model->gait;
    double speed = ff_max(fabs(rates.forward), FITTED_FROM * (double)gait->speed);
    double stance = (double)gait->stance + (double)gait->stance_slope * (speed - (double)gait->speed);
    return ff_clamp(stance, ff_min(STANCE_MIN, (double)gait->stance),
                    ff_max(STANCE_MAX, (double)gait->stance));
}

/* An amplitude as a share of the clip's: the law where it was fitted, from there down to nothing for no steps. */
static double amplitude(const ff_gait_model *model, int law, double ratio)
{
    double slope = (double)model->gait->law[law];
    if (ratio >= FITTED_FROM) return 1.0 + slope * (ratio - 1.0);
    return (1.0 + slope * (FITTED_FROM - 1.0)) * ratio / FITTED_FROM;
}

static ff_pack_gait_path sample(const ff_gait_model *model, double phase)
{
    double at = fraction(phase) * FF_GAIT_SAMPLES;
    int low = (int)at % FF_GAIT_SAMPLES;
    float t = (float)(at - floor(at));
    const ff_pack_gait_path *p = &model->path[low], *q = &model->path[(low + 1) % FF_GAIT_SAMPLES];
    ff_pack_gait_path out = {.ahead = p->ahead + (q->ahead - p->ahead) * t,
                             .side = p->side + (q->side - p->side) * t,
                             .lift = p->lift + (q->lift - p->lift) * t,
                             .yaw = p->yaw + (q->yaw - p->yaw) * t,
                             .pitch = p->pitch + (q->pitch - p->pitch) * t};
    for (int i = 0; i < 3; ++i)
        out.hips[i] = p->hips[i] + (q->hips[i] - p->hips[i]) * t;
    return out;
}

double ff_gait_model_backward(ff_rates rates)
{
    return 1.0 - ff_smooth(0.5 + 0.5 * rates.forward / FF_MODEL_TURN_ABOUT);
}

/* The clip at a phase of its own, read forwards, backwards, or between the two: where a foot lifted it now lands. ahead
 * is turned round with it. */
static ff_pack_gait_path sample_both_ways(const ff_gait_model *model, ff_rates rates, double at)
{
    double back = ff_gait_model_backward(rates), stance = (double)model->gait->stance;
    if (back <= 0.0) return sample(model, at);
    ff_pack_gait_path q = sample(model, stance - at), p = back < 1.0 ? sample(model, at) : q;
    float t = (float)back;
    ff_pack_gait_path out = {.ahead = p.ahead + (-q.ahead - p.ahead) * t,
                             .side = p.side + (q.side - p.side) * t,
                             .lift = p.lift + (q.lift - p.lift) * t,
                             .yaw = p.yaw + (q.yaw - p.yaw) * t,
                             .pitch = p.pitch + (q.pitch - p.pitch) * t};
    if (back >= 1.0) out.ahead = -q.ahead;
    for (int i = 0; i < 3; ++i)
        out.hips[i] = p.hips[i] + (q.hips[i] - p.hips[i]) * t;
    return out;
}

/* Phase of the clip for a phase of a cycle whose stance is another share of it. */
static double warp(double phase, double stance, double clip_stance)
{
    if (phase < stance) return phase / stance * clip_stance;
    return clip_stance + (phase - stance) / (1.0 - stance) * (1.0 - clip_stance);
}

/* Where the middle of a foot's path is, (forward, left) of the root: between the clip's and standing feet. */
static ff_vec2 foot_place(const ff_pack_gait *gait, ff_rates rates, double period, double part, double side)
{
    double ahead = ff_lerp((double)gait->stand[0], (double)gait->centre[0], part);
    double half = ff_lerp((double)gait->stand[1], (double)gait->centre[1], part);
    /* Side steps need room for the closing foot, unless the feet pass each other well apart in front and behind. */
    double wide = 0.5 * (ANKLES_APART + 0.5 * fabs(rates.left) * period);
    double pass = 0.25 * fabs(rates.forward) * period;
    double fade = (1.0 - ff_smooth((pass - 0.25) / 0.2)) * ff_min(1.0, fabs(rates.left) / 0.1);
    return ff_v2(ahead, side * (half + fade * ff_max(0.0, wide - half)));
}

/* Displacement of the root after time t at constant rates, in its frame at time 0. */
static ff_vec2 root_after(ff_rates rates, double t)
{
    double angle = rates.turn * t, sine, cosine;
    ff_vec2 v = ff_v2(rates.forward, rates.left);
    if (fabs(angle) < 1e-6) return ff_scale2(ff_madd2(v, ff_left2(v), 0.5 * angle), t);
    ff_sincos(angle, &sine, &cosine);
    double s = sine / rates.turn, c = (1.0 - cosine) / rates.turn;
    return ff_v2(s * v.a - c * v.b, c * v.a + s * v.b);
}

ff_model_foot ff_gait_model_foot(const ff_gait_model *model, ff_rates rates, double period, int foot,
                                 double phase)
{
    const ff_pack_gait *gait = model->gait;
    double side = foot ? -1.0 : 1.0, own = fraction(phase - (foot ? 0.5 : 0.0));
    double stance = ff_gait_model_stance(model, rates), clip_stance = (double)gait->stance;
    double ratio = fabs(rates.forward) / (double)gait->speed, size = ff_gait_model_size(model, rates);
    double part = ff_min(1.0, size), swing = own < stance ? -1.0 : (own - stance) / (1.0 - stance),
           bump = 0.0;
    if (swing >= 0.0) {
        double s = ff_sin(FF_PI * swing);
        bump = s * s;
    }
    double at = warp(own, stance, clip_stance);
    ff_pack_gait_path clip = sample_both_ways(model, rates, at);
    /* Time by which the foot is ahead of its place: in stance exactly what the root takes to get there. */
    double time = (double)clip.ahead * stance / clip_stance * period;
    ff_vec2 place = foot_place(gait, rates, period, part, side);
    double turning = ff_min(1.0, fabs(rates.turn)) * (1.0 - part);
    place.b += side * ((double)clip.side * part + CLEARANCE * turning * bump);
    double angle = rates.turn * time;
    ff_vec2 on_path = ff_add2(ff_from_frame2(ff_fwd2(angle), place), root_after(rates, time));
    double lift = ff_clamp(amplitude(model, FF_GAIT_LAW_LIFT, ratio), LIFT_LEAST, LIFT_MOST);
    double out = ff_lerp((double)gait->stand[2], (double)gait->centre[2], part) + (double)clip.yaw * size;
    return (ff_model_foot){
        .forward = on_path.a,
        .left = on_path.b,
        .height = (double)gait->ball_rest +
                  ff_max((double)clip.lift * lift, LIFT_MIN * (1.0 - LIFT_FADE * part) * bump),
        .yaw = angle + side * out,
        .pitch = (double)clip.pitch * amplitude(model, FF_GAIT_LAW_PITCH, ff_min(ratio, 1.5)),
        .swing = swing};
}

/* How much of a side step there is in the gait, 0 to 1. */
static double sidewards(ff_rates rates)
{
    double ahead = fabs(rates.forward), aside = fabs(rates.left);
    return aside / ff_max(ahead + aside, 1e-9) * ff_smooth(aside / SHIFT_FULL);
}

/* 1 in the middle of the left foot's stance to -1 in that of the right one's. */
static double over_foot(const ff_gait_model *model, ff_rates rates, double phase)
{
    return ff_cos(FF_TAU * (phase - 0.5 * ff_gait_model_stance(model, rates)));
}

ff_vec3 ff_gait_model_hips(const ff_gait_model *model, ff_rates rates, double phase)
{
    double ratio = ff_min(fabs(rates.forward) / (double)model->gait->speed, 1.5);
    ff_pack_gait_path clip = sample_both_ways(model, rates, fraction(phase));
    double sway = ff_max(SWAY_LEAST, amplitude(model, FF_GAIT_LAW_SWAY, ratio));
    double bob = amplitude(model, FF_GAIT_LAW_BOB, ratio);
    double left = (double)clip.hips[1] * sway, share = sidewards(rates);
    if (share > 0.0) {
        double part = ff_min(1.0, ff_gait_model_size(model, rates));
        ff_vec2 foot = foot_place(model->gait, rates, ff_gait_model_period(model, rates), part, 1.0);
        left = ff_lerp(left, SHIFT * foot.b * over_foot(model, rates, phase), share);
    }
    return ff_v3((double)clip.hips[0] * ff_min(1.0, ratio), left, (double)clip.hips[2] * bob);
}

double ff_gait_model_lean(const ff_gait_model *model, ff_rates rates, double phase)
{
    double share = sidewards(rates);
    if (!(share > 0.0)) return 0.0;
    return LEAN * ff_clamp(rates.left / LEAN_FULL, -1.0, 1.0) +
           LEAN_SWAY * share * over_foot(model, rates, phase);
}

double ff_gait_model_rise(const ff_gait_model *model, ff_rates rates, double phase)
{
    double share = sidewards(rates);
    if (!(share > 0.0)) return 0.0;
    double together = (rates.left > 0.0 ? 0.5 : 0.0) + 0.5 * (ff_gait_model_stance(model, rates) - 0.5);
    return share * RISE * ff_min(fabs(rates.left) / LEAN_FULL, 1.0) * ff_cos(FF_TAU * (phase - together));
}
