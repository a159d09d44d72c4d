#include "runtime/export/gait_facts.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/pack/pack.h"

#include <stdlib.h>
#include <string.h>

#define EVENTS 256
#define STRAIGHT 0.05 /* m/s, rad/s */
#define EXAMPLE_SECONDS 20.0
#define EVENT_ROOM                                                                                           \
    0.033 /* of a cycle: where exactly a contact begins is a matter of definition (gait facts, limits) */

static const ff_fact_reference references[FF_FACT_COUNT] = {
    [FF_FACT_CADENCE] = {"cadence, steps/min", {97, 110, 121}, {7, 5, 7}},
    [FF_FACT_STEP] = {"step length, L", {0.76, 0.84, 0.99}, {0.07, 0.06, 0.04}},
    [FF_FACT_WIDTH] = {"step width, L", {0.11, 0.08, 0.06}, {0.05, 0.03, 0.05}},
    [FF_FACT_STANCE] = {"stance, of the cycle", {0.628, 0.620, 0.588}, {0.015, 0.013, 0.017}},
    [FF_FACT_DOUBLE] = {"double support, of the cycle", {0.255, 0.240, 0.177}, {0.030, 0.025, 0.029}},
    [FF_FACT_FLAT] = {"foot flat from phase", {0.07, 0.08, 0.08}, {0.01, 0.01, 0.02}},
    [FF_FACT_HEEL_OFF] = {"heel off at phase", {0.43, 0.41, 0.40}, {0.04, 0.05, 0.02}},
    [FF_FACT_PITCH_CONTACT] = {"foot pitch at contact, deg", {22, 25, 26}, {4, 6, 2}},
    [FF_FACT_PITCH_OFF] = {"foot pitch at toe-off, deg", {-57, -65, -63}, {5, 5, 6}},
    [FF_FACT_HIPS] = {"hips over the ankle, L", {0.954, 0.951, 0.929}, {0.012, 0.012, 0.007}},
    [FF_FACT_HIPS_RANGE] = {"hips up and down, L", {0.017, 0.026, 0.042}, {0.008, 0.009, 0.014}},
    [FF_FACT_HIPS_HIGHEST] = {"hips highest at phase", {0.27, 0.25, 0.27}, {0.07, 0.03, 0.04}},
    [FF_FACT_SWAY] = {"hips sideways, L", {0.071, 0.061, 0.042}, {0.015, 0.017, 0.016}},
    [FF_FACT_SLOWEST] = {"slowest, of mean speed", {0.83, 0.85, 0.89}, {0.05, 0.02, 0.02}},
    [FF_FACT_FASTEST] = {"fastest, of mean speed", {1.27, 1.22, 1.18}, {0.07, 0.02, 0.02}},
    [FF_FACT_PELVIS_YAW] = {"pelvis yaw range, deg", {8, 12, 16}, {2, 3, 1}},
    [FF_FACT_PELVIS_ROLL] = {"pelvis roll range, deg", {11, 11, 12}, {2, 3, 3}},
    [FF_FACT_HIP_MOST] = {"hip flexion most, deg", {36, 35, 46}, {7, 8, 7}},
    [FF_FACT_HIP_LEAST] = {"hip flexion least, deg", {-12, -18, -16}, {5, 8, 10}},
    [FF_FACT_KNEE_CONTACT] = {"knee at contact, deg", {20, 21, 21}, {4, 4, 4}},
    [FF_FACT_KNEE_LOADED] = {"knee most in stance, deg", {30, 32, 40}, {6, 4, 5}},
    [FF_FACT_KNEE_LEAST] = {"knee least in stance, deg", {12, 10, 10}, {8, 7, 9}},
    [FF_FACT_KNEE_SWING] = {"knee most in swing, deg", {69, 73, 73}, {4, 3, 2}},
    [FF_FACT_KNEE_SWING_AT] = {"... at phase", {0.74, 0.75, 0.72}, {0.01, 0.01, 0.01}},
    [FF_FACT_ANKLE_UP] = {"ankle dorsiflexion most, deg", {21, 22, 24}, {1, 4, 2}},
    [FF_FACT_ANKLE_DOWN] = {"ankle plantarflexion most, deg", {10, 18, 17}, {5, 5, 7}},
    [FF_FACT_LEAN] = {"lean forward, deg", {-1.7, -2.5, -1.5}, {2.2, 2.2, 0.5}},
    [FF_FACT_SPINE_YAW] = {"thorax on pelvis yaw range, deg", {14, 17, 19}, {3, 4, 3}},
    [FF_FACT_THORAX_YAW] = {"thorax yaw range, deg", {9, 8, 8}, {3, 2, 4}},
    [FF_FACT_HEAD_YAW] = {"head yaw range, deg", {6, 5, 4}, {3, 3, 2}},
    [FF_FACT_ARM_RANGE] = {"shoulder swing range, deg", {22, 25, 39}, {16, 14, 17}},
    [FF_FACT_ARM_AT] = {"arm furthest forward at phase", {0.47, 0.49, 0.49}, {0.02, 0.02, 0.02}},
    [FF_FACT_ELBOW] = {"elbow mean, deg", {29, 32, 30}, {4, 5, 2}},
    [FF_FACT_ELBOW_RANGE] = {"elbow range, deg", {19, 28, 42}, {8, 13, 12}},
};

const ff_fact_reference *ff_fact_references(void)
{
    return references;
}

double ff_fact_speed(int band)
{
    static const double speeds[FF_BAND_COUNT] = {1.02, 1.27, 1.61};
    return speeds[band];
}

/* ------------------------------------------------------------------------------------------------- one moment */

/* Rotation about the lateral axis that brings the vertical to v, seen from the side: forward +. */
static double tilt(ff_vec3 v)
{
    return ff_atan2(v.z, v.y) / FF_DEG;
}

/* Left side up, of Ry(yaw) Rx(pitch) Rz(roll). */
static double roll_of(ff_quat q)
{
    ff_vec3 left = ff_quat_rotate(q, ff_v3(1.0, 0.0, 0.0));
    return ff_atan2(left.y, sqrt(left.x * left.x + left.z * left.z)) / FF_DEG;
}

static double between(ff_vec3 u, ff_vec3 v)
{
    return ff_acos(ff_dot3(ff_unit3(u), ff_unit3(v))) / FF_DEG;
}

static double wrap_degrees(double degrees)
{
    return ff_wrap(degrees * FF_DEG) / FF_DEG;
}

static void measure_leg(const ff_gait_standard *standard, const ff_vec3 *at, const ff_quat *turn, int side,
                        ff_fact_frame *out)
{
    int hip = FF_JOINT_HIP_L + side * FF_JOINT_LEG_STRIDE, ankle = hip + 2, ball = hip + 3;
    out->heel[side] = ff_add3(at[ankle], ff_quat_rotate(turn[ankle], standard->heel[side]));
    out->ball[side] = at[ball];
    out->toe[side] = ff_add3(at[ball], ff_quat_rotate(turn[ball], standard->toe[side]));
    out->ankle_height[side] = at[ankle].y;
    ff_vec3 foot = ff_quat_rotate(turn[ankle], ff_v3(0.0, 0.0, 1.0));
    ff_vec3 shank = ff_sub3(at[ankle], at[hip + 1]), thigh = ff_sub3(at[hip + 1], at[hip]);
    /* In the pelvis; hanging straight down is 0. */
    ff_vec3 hangs = ff_quat_rotate(ff_quat_conj(turn[FF_JOINT_HIPS]), thigh);
    ff_quat bent = ff_quat_mul(ff_quat_conj(turn[hip + 1]), turn[ankle]);
    ff_vec3 sole = ff_quat_rotate(bent, ff_v3(0.0, 0.0, 1.0));
    out->pitch[side] = ff_atan2(foot.y, foot.z) / FF_DEG;
    out->hip[side] = ff_atan2(hangs.z, -hangs.y) / FF_DEG;
    out->knee[side] = between(thigh, shank);
    out->ankle[side] = -ff_atan2(sole.y, sole.z) / FF_DEG;
}

static void measure_arm(const ff_vec3 *at, const ff_quat *turn, int side, ff_fact_frame *out)
{
    int shoulder = side == 0 ? FF_JOINT_SHOULDER_L : FF_JOINT_SHOULDER_R;
    ff_vec3 upper = ff_sub3(at[shoulder + 1], at[shoulder]),
            fore = ff_sub3(at[shoulder + 2], at[shoulder + 1]);
    ff_vec3 hangs = ff_quat_rotate(ff_quat_conj(turn[FF_JOINT_CHEST]), upper);
    out->arm[side] = ff_atan2(hangs.z, -hangs.y) / FF_DEG;
    out->elbow[side] = between(upper, fore);
}

ff_fact_frame ff_fact_frame_of(const ff_gait_standard *standard, ff_vec3 hips, const ff_quat *rotations)
{
    ff_vec3 at[FF_FIGURE_MAX_JOINTS];
    ff_quat turn[FF_FIGURE_MAX_JOINTS];
    ff_fact_frame out;
    ff_figure_place(standard->figure, hips, rotations, at, turn);
    out.hips = ff_lerp3(at[FF_JOINT_HIP_L], at[FF_JOINT_HIP_R], 0.5);
    for (int side = 0; side < 2; ++side) {
        measure_leg(standard, at, turn, side, &out);
        measure_arm(at, turn, side, &out);
    }
    out.pelvis_yaw = ff_quat_heading(turn[FF_JOINT_HIPS]) / FF_DEG;
    out.pelvis_roll = roll_of(turn[FF_JOINT_HIPS]);
    out.thorax_yaw = ff_quat_heading(turn[FF_JOINT_CHEST]) / FF_DEG;
    out.spine_yaw = wrap_degrees(out.thorax_yaw - out.pelvis_yaw);
    out.head_yaw = ff_quat_heading(turn[FF_JOINT_HEAD]) / FF_DEG;
    out.lean = tilt(ff_sub3(at[FF_JOINT_NECK], out.hips));
    return out;
}

/* ----------------------------------------------------------------------------------------------------- events */

/* A stride of one foot, from its contact to its next, in frames. */
typedef struct stride {
    uint32_t first, last, off, flat, heel_off;
} stride;

typedef struct strides {
    stride item[2][EVENTS];
    int count[2];
} strides;

static double speed_at(const ff_vec3 *before, const ff_vec3 *after, double step)
{
    return ff_length3(ff_sub3(*after, *before)) / (2.0 * step);
}

enum { HEEL, BALL, TOE };

static double point_speed(const ff_fact_frame *frames, uint32_t k, int foot, int point, double step)
{
    const ff_fact_frame *p = &frames[k - 1], *q = &frames[k + 1];
    if (point == HEEL) return speed_at(&p->heel[foot], &q->heel[foot], step);
    if (point == BALL) return speed_at(&p->ball[foot], &q->ball[foot], step);
    return speed_at(&p->toe[foot], &q->toe[foot], step);
}

#define SWINGS 1.0 /* m/s, of a ball in swing */

/* The swing that begins at or after from: its frame of greatest ball speed in *peak, its end returned; 0 when none is whole. */
static uint32_t next_swing(const ff_fact_frame *frames, uint32_t count, uint32_t from, int foot, double step,
                           uint32_t *begin, uint32_t *peak)
{
    uint32_t k = from;
    while (k + 2 < count && point_speed(frames, k, foot, BALL, step) < SWINGS)
        ++k;
    *begin = *peak = k;
    while (k + 2 < count && point_speed(frames, k, foot, BALL, step) >= SWINGS) {
        if (point_speed(frames, k, foot, BALL, step) > point_speed(frames, *peak, foot, BALL, step))
            *peak = k;
        ++k;
    }
    return k + 2 < count ? k : 0;
}

/* Toe-off: the last frame before the swing in which the toe is slower than a quarter of the ball's top speed. */
static uint32_t toe_off(const ff_fact_frame *frames, uint32_t peak, int foot, double step)
{
    double limit = ff_clamp(0.25 * point_speed(frames, peak, foot, BALL, step), 0.35, 0.9);
    uint32_t k = peak;
    while (k > 1 && point_speed(frames, k, foot, TOE, step) > limit)
        --k;
    return k;
}

/* Contact: the first frame after the swing's peak in which the heel is low and slower than a quarter of its top speed. The
 * labels take the median of this and two estimates from accelerations, which are noise where poses are blended. */
static uint32_t contact(const ff_fact_frame *frames, uint32_t count, uint32_t begin, uint32_t peak, int foot,
                        double rest, double step)
{
    double most = 0.0;
    for (uint32_t k = begin; k < 2 * peak - begin && k + 1 < count; ++k)
        most = ff_max(most, point_speed(frames, k, foot, HEEL, step));
    double limit = ff_clamp(0.25 * most, 0.35, 0.9);
    uint32_t k = peak;
    while (k + 2 < count &&
           (point_speed(frames, k, foot, HEEL, step) > limit || frames[k].heel[foot].y > rest + 0.05))
        ++k;
    return k;
}

static void find_flat(const ff_fact_frame *frames, int foot, double rest, double step, stride *s)
{
    uint32_t best = 0, run = 0;
    s->flat = s->heel_off = s->first;
    for (uint32_t k = s->first; k < s->off; ++k) {
        bool flat = point_speed(frames, k, foot, BALL, step) < 0.30 &&
                    point_speed(frames, k, foot, HEEL, step) < 0.35 && frames[k].heel[foot].y < rest + 0.015;
        run = flat ? run + 1 : 0;
        if (run <= best) continue;
        best = run;
        s->flat = k + 1 - run;
        s->heel_off = k;
    }
}

static void find_strides(const ff_gait_standard *standard, const ff_fact_frame *frames, uint32_t count,
                         strides *out)
{
    memset(out, 0, sizeof *out);
    for (int foot = 0; foot < 2; ++foot) {
        int ankle = FF_JOINT_ANKLE_L + foot * FF_JOINT_LEG_STRIDE;
        double rest = standard->figure->rest[ankle].y + standard->heel[foot].y;
        uint32_t at = 1, begin, peak, last = 0;
        while ((at = next_swing(frames, count, at, foot, standard->step, &begin, &peak)) != 0) {
            uint32_t down = contact(frames, count, begin, peak, foot, rest, standard->step);
            stride s = {last, down, toe_off(frames, peak, foot, standard->step), 0, 0};
            if (last > 0 && s.off > last && s.off < down && out->count[foot] < EVENTS) {
                find_flat(frames, foot, rest, standard->step, &s);
                out->item[foot][out->count[foot]++] = s;
            }
            last = down;
            at = down > at ? down : at;
        }
    }
}

/* ------------------------------------------------------------------------------------------------------ figures */

typedef struct sums {
    double value[FF_FACT_COUNT];
    uint32_t terms[FF_FACT_COUNT];
} sums;

static void take(sums *s, ff_fact fact, double value)
{
    s->value[fact] += value;
    ++s->terms[fact];
}

typedef struct span {
    double low, high, mean;
    uint32_t low_at, high_at;
} span;

/* Of a series over frames [first, last); stride: bytes between values. */
static span span_of(const double *values, uint32_t first, uint32_t last)
{
    const size_t step = sizeof(ff_fact_frame) / sizeof(double);
    span s = {values[first * step], values[first * step], 0.0, first, first};
    for (uint32_t k = first; k < last; ++k) {
        double v = values[k * step];
        s.mean += v / (last - first);
        if (v < s.low) s.low = v, s.low_at = k;
        if (v > s.high) s.high = v, s.high_at = k;
    }
    return s;
}

static double phase_of(const stride *s, uint32_t frame)
{
    return (double)(frame - s->first) / (s->last - s->first);
}

static void take_limbs(const ff_fact_frame *frames, int foot, const stride *s, sums *out)
{
    span hip = span_of(&frames->hip[foot], s->first, s->last),
         ankle = span_of(&frames->ankle[foot], s->first, s->last);
    span stance = span_of(&frames->knee[foot], s->first, s->off),
         swing = span_of(&frames->knee[foot], s->off, s->last);
    span loaded = span_of(&frames->knee[foot], s->first, s->first + (s->last - s->first) * 3 / 10);
    span arm = span_of(&frames->arm[foot], s->first, s->last),
         elbow = span_of(&frames->elbow[foot], s->first, s->last);
    take(out, FF_FACT_STANCE, phase_of(s, s->off));
    take(out, FF_FACT_FLAT, phase_of(s, s->flat));
    take(out, FF_FACT_HEEL_OFF, phase_of(s, s->heel_off));
    take(out, FF_FACT_PITCH_CONTACT, frames[s->first].pitch[foot]);
    take(out, FF_FACT_PITCH_OFF, frames[s->off].pitch[foot]);
    take(out, FF_FACT_HIP_MOST, hip.high);
    take(out, FF_FACT_HIP_LEAST, hip.low);
    take(out, FF_FACT_KNEE_CONTACT, frames[s->first].knee[foot]);
    take(out, FF_FACT_KNEE_LOADED, loaded.high);
    take(out, FF_FACT_KNEE_LEAST, stance.low);
    take(out, FF_FACT_KNEE_SWING, swing.high);
    take(out, FF_FACT_KNEE_SWING_AT, phase_of(s, swing.high_at));
    take(out, FF_FACT_ANKLE_UP, -ankle.low);
    take(out, FF_FACT_ANKLE_DOWN, ankle.high);
    take(out, FF_FACT_ARM_RANGE, arm.high - arm.low);
    take(out, FF_FACT_ARM_AT, phase_of(s, arm.high_at));
    take(out, FF_FACT_ELBOW, elbow.mean);
    take(out, FF_FACT_ELBOW_RANGE, elbow.high - elbow.low);
}

/* Up and down twice a stride: what is the same in both of its halves. */
static void take_bob(const ff_fact_frame *frames, const stride *s, double leg, double ankle, sums *out)
{
    uint32_t half = (s->last - s->first) / 2, highest = 0;
    double low = 1e9, high = -1e9, mean = 0.0;
    for (uint32_t k = 0; k < half; ++k) {
        double y = 0.5 * (frames[s->first + k].hips.y + frames[s->first + k + half].hips.y);
        mean += y / half;
        low = ff_min(low, y);
        if (y > high) high = y, highest = k;
    }
    take(out, FF_FACT_HIPS, (mean - ankle) / leg);
    take(out, FF_FACT_HIPS_RANGE, (high - low) / leg);
    take(out, FF_FACT_HIPS_HIGHEST, 0.5 * highest / half);
}

static void take_middle(const ff_fact_frame *frames, const stride *s, double leg, double step, sums *out)
{
    double speed = (frames[s->last].hips.z - frames[s->first].hips.z) / ((s->last - s->first) * step);
    double slowest = 1e9, fastest = -1e9;
    for (uint32_t k = s->first; k < s->last; ++k) {
        double now = (frames[k + 1].hips.z - frames[k - 1].hips.z) / (2.0 * step);
        slowest = ff_min(slowest, now);
        fastest = ff_max(fastest, now);
    }
    span sway = span_of(&frames->hips.x, s->first, s->last),
         yaw = span_of(&frames->pelvis_yaw, s->first, s->last);
    span roll = span_of(&frames->pelvis_roll, s->first, s->last),
         spine = span_of(&frames->spine_yaw, s->first, s->last);
    span thorax = span_of(&frames->thorax_yaw, s->first, s->last),
         head = span_of(&frames->head_yaw, s->first, s->last);
    take(out, FF_FACT_SLOWEST, slowest / speed);
    take(out, FF_FACT_FASTEST, fastest / speed);
    take(out, FF_FACT_SWAY, (sway.high - sway.low) / leg);
    take(out, FF_FACT_PELVIS_YAW, yaw.high - yaw.low);
    take(out, FF_FACT_PELVIS_ROLL, roll.high - roll.low);
    take(out, FF_FACT_SPINE_YAW, spine.high - spine.low);
    take(out, FF_FACT_THORAX_YAW, thorax.high - thorax.low);
    take(out, FF_FACT_HEAD_YAW, head.high - head.low);
    take(out, FF_FACT_LEAN, span_of(&frames->lean, s->first, s->last).mean);
}

static void take_steps(const ff_fact_frame *frames, int foot, const stride *s, double leg, double step,
                       sums *out)
{
    double stride_time = (s->last - s->first) * step;
    take(out, FF_FACT_CADENCE, 120.0 / stride_time);
    take(out, FF_FACT_STEP, 0.5 * (frames[s->last].hips.z - frames[s->first].hips.z) / leg);
    uint32_t flat = (s->flat + s->heel_off) / 2, other = flat + (s->last - s->first) / 2;
    double apart = frames[flat].ball[foot].x - frames[other].ball[1 - foot].x;
    take(out, FF_FACT_WIDTH, (foot == 0 ? apart : -apart) / leg);
}

ff_status ff_gait_facts_find(const ff_gait_standard *standard, const ff_fact_frame *frames, uint32_t count,
                             double facts[FF_FACT_COUNT], ff_error *error)
{
    static const int legs[2] = {FF_JOINT_HIP_L, FF_JOINT_HIP_R};
    strides all;
    sums total;
    memset(&total, 0, sizeof total);
    find_strides(standard, frames, count, &all);
    if (all.count[0] < 2 || all.count[1] < 2)
        return ff_fail(error, FF_ERR_NO_DATA, "%d left and %d right strides, at least two of each are needed",
                       all.count[0], all.count[1]);
    for (int foot = 0; foot < 2; ++foot) {
        const ff_vec3 *rest = standard->figure->rest;
        int hip = legs[foot];
        double leg =
            ff_length3(ff_sub3(rest[hip + 1], rest[hip])) + ff_length3(ff_sub3(rest[hip + 2], rest[hip + 1]));
        for (int i = 0; i < all.count[foot]; ++i) {
            const stride *s = &all.item[foot][i];
            if (s->last + (s->last - s->first) >= count) break; /* the other foot's plant is looked at too */
            take_limbs(frames, foot, s, &total);
            take_steps(frames, foot, s, leg, standard->step, &total);
            take_bob(frames, s, leg, rest[hip + 2].y, &total);
            take_middle(frames, s, leg, standard->step, &total);
        }
    }
    for (int k = 0; k < FF_FACT_COUNT; ++k)
        facts[k] = total.value[k] / ff_max(1.0, total.terms[k]);
    facts[FF_FACT_DOUBLE] = 2.0 * facts[FF_FACT_STANCE] - 1.0;
    return FF_OK;
}

ff_status ff_gait_facts_of_example(const ff_pack *pack, const ff_gait_standard *standard, double speed,
                                   double facts[FF_FACT_COUNT], ff_error *error)
{
    const ff_pack_example *best = NULL;
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        const ff_pack_example *e = &pack->examples[i];
        bool straight = e->gait == FF_GAIT_WALK && !(e->flags & FF_EXAMPLE_IDLE) &&
                        fabs((double)e->v_left) < STRAIGHT && fabs((double)e->turn_rate) < STRAIGHT;
        if (!straight) continue;
        if (!best || fabs((double)e->v_forward - speed) < fabs((double)best->v_forward - speed)) best = e;
    }
    if (!best) return ff_fail(error, FF_ERR_NO_DATA, "the pack has no straight walk");
    uint32_t count = (uint32_t)(EXAMPLE_SECONDS / standard->step);
    ff_fact_frame *frames = ff_calloc(count, sizeof *frames);
    if (!frames) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %u poses", count);
    ff_status status = FF_OK;
    for (uint32_t k = 0; k < count && status == FF_OK; ++k) {
        ff_vec3 hips;
        ff_quat rotations[FF_FIGURE_MAX_JOINTS];
        status = ff_pack_sample(pack, best->stream, k * standard->step, 0, NULL, &hips, rotations, error);
        hips.z += (double)best->v_forward * k * standard->step;
        if (status == FF_OK) frames[k] = ff_fact_frame_of(standard, hips, rotations);
    }
    if (status == FF_OK) status = ff_gait_facts_find(standard, frames, count, facts, error);
    free(frames);
    return status;
}

bool ff_fact_holds(ff_fact fact, int band, double value, double example)
{
    static const bool at_phase[FF_FACT_COUNT] = {
        [FF_FACT_STANCE] = true,   [FF_FACT_DOUBLE] = true,       [FF_FACT_FLAT] = true,
        [FF_FACT_HEEL_OFF] = true, [FF_FACT_HIPS_HIGHEST] = true, [FF_FACT_KNEE_SWING_AT] = true,
        [FF_FACT_ARM_AT] = true};
    const ff_fact_reference *r = &references[fact];
    double room = 2.0 * r->deviation[band] + (at_phase[fact] ? EVENT_ROOM : 0.0);
    return fabs(value - r->mean[band]) <= room ||
           fabs(value - example) <= ff_max(r->deviation[band], EVENT_ROOM);
}
