#include "runtime/export/gait_meter.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/pack/pack.h"

#include <string.h>

/* Thorax to head, slow walkers, 99th percentile of all (gait facts): people look about, and walkers made by formula do not. */
#define HEAD_SPEED (91.0 * FF_DEG)
#define STILL (30.0 * FF_DEG) /* rad/s: a joint that is never faster is not really moved in the database */
#define MIDDLE_FROM 0.35      /* of the swing: mid swing */
#define MIDDLE_TO 0.65

/* ------------------------------------------------------------------------------------------------ the standard */

static double turn_speed(ff_quat from, ff_quat to, double step)
{
    return ff_quat_angle(ff_quat_mul(ff_quat_conj(from), to)) / step;
}

/* How joints are turned, and then their bones as a whole, against the heading. */
static void turns_of(const ff_figure *figure, const ff_quat *rotations, ff_quat *out)
{
    uint32_t count = figure->joint_count;
    memcpy(out, rotations, count * sizeof *out);
    ff_figure_place(figure, ff_v3(0.0, 0.0, 0.0), rotations, NULL, out + count);
}

/* Speeds at every step of an example. */
static ff_status learn_stream(const ff_pack *pack, uint32_t stream, ff_gait_standard *standard,
                              double *fastest, ff_error *error)
{
    ff_quat pose[FF_FIGURE_MAX_JOINTS], now[2 * FF_FIGURE_MAX_JOINTS], last[2 * FF_FIGURE_MAX_JOINTS];
    uint32_t count = (uint32_t)(ff_pack_stream_seconds(pack, stream) / standard->step);
    for (uint32_t k = 0; k <= count; ++k) {
        ff_status status = ff_pack_sample(pack, stream, k * standard->step, 0, NULL, NULL, pose, error);
        if (status != FF_OK) return status;
        turns_of(standard->figure, pose, now);
        for (uint32_t j = 0; j < 2 * standard->figure->joint_count && k > 0; ++j)
            fastest[j] = ff_max(fastest[j], turn_speed(last[j], now[j], standard->step));
        memcpy(last, now, sizeof now);
    }
    return FF_OK;
}

/* People have no faster side. */
static void even_out(double *fastest, int left, int right, int count)
{
    for (int k = 0; k < count; ++k)
        fastest[left + k] = fastest[right + k] = ff_max(fastest[left + k], fastest[right + k]);
}

static ff_status learn_speeds(const ff_pack *pack, ff_gait_standard *standard, ff_error *error)
{
    double fastest[2 * FF_FIGURE_MAX_JOINTS] = {0};
    uint32_t count = standard->figure->joint_count;
    ff_status status = FF_OK;
    for (uint32_t i = 0; i < pack->example_count && status == FF_OK; ++i)
        if (!(pack->examples[i].flags & FF_EXAMPLE_DERIVED))
            status = learn_stream(pack, pack->examples[i].stream, standard, fastest, error);
    for (int half = 0; half < 2; ++half) {
        even_out(fastest + half * (int)count, FF_JOINT_CLAVICLE_L, FF_JOINT_CLAVICLE_R,
                 FF_JOINT_CLAVICLE_R - FF_JOINT_CLAVICLE_L);
        even_out(fastest + half * (int)count, FF_JOINT_HIP_L, FF_JOINT_HIP_R, FF_JOINT_LEG_STRIDE);
    }
    for (uint32_t j = 0; j < count; ++j) {
        standard->as_bone[j] = fastest[j] < STILL;
        standard->fastest[j] = ff_max(standard->as_bone[j] ? fastest[count + j] : fastest[j], STILL);
    }
    for (int j = FF_JOINT_NECK; j <= FF_JOINT_HEAD; ++j)
        standard->fastest[j] = ff_max(standard->fastest[j], HEAD_SPEED);
    return status;
}

ff_status ff_gait_standard_make(const ff_pack *pack, const ff_figure *figure, double step,
                                ff_gait_standard *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    out->figure = figure;
    out->step = step;
    if (figure->joint_count > FF_FIGURE_MAX_JOINTS)
        return ff_fail(error, FF_ERR_UNSUPPORTED, "%u joints, at most %d can be measured",
                       figure->joint_count, FF_FIGURE_MAX_JOINTS);
    for (uint32_t foot = 0; foot < 2; ++foot) {
        uint32_t ball = FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE;
        out->ball_rest[foot] = figure->rest[ball].y;
        for (uint32_t p = 0; p < pack->point_count; ++p) {
            const ff_pack_point *point = &pack->points[p];
            ff_vec3 offset =
                ff_v3((double)point->offset[0], (double)point->offset[1], (double)point->offset[2]);
            if (point->kind == FF_POINT_HEEL_L + foot) out->heel[foot] = offset;
            if (point->kind == FF_POINT_TOE_L + foot) out->toe[foot] = offset;
        }
    }
    return learn_speeds(pack, out, error);
}

/* -------------------------------------------------------------------------------------------------- the walker */

ff_status ff_gait_meter_create(const ff_gait_standard *standard, ff_gait_meter *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    out->standard = standard;
    return ff_skate_create(1, standard->step, &out->skate, error);
}

void ff_gait_meter_free(ff_gait_meter *meter)
{
    ff_skate_free(&meter->skate);
}

/* Keep the worse of two; sign 1 where more is worse, -1 where less is. */
static void worsen(ff_gait_extreme *extreme, double value, double time, int32_t part, double sign)
{
    if (extreme->known && sign * value <= sign * extreme->value) return;
    *extreme = (ff_gait_extreme){value, time, part, 1};
}

static double bend_of_knee(const ff_vec3 *joints, int hip)
{
    ff_vec3 thigh = ff_unit3(ff_sub3(joints[hip + 1], joints[hip]));
    ff_vec3 shank = ff_unit3(ff_sub3(joints[hip + 2], joints[hip + 1]));
    return ff_acos(ff_dot3(thigh, shank)) / FF_DEG;
}

static void watch_knee(ff_gait_meter *meter, int foot, double bend, double time)
{
    ff_gait_meter_foot *state = &meter->foot[foot];
    double step = meter->standard->step;
    if (meter->poses >= 2) {
        double acceleration = fabs(bend - 2.0 * state->knee[0] + state->knee[1]) / (step * step);
        worsen(&meter->knee, acceleration, time, foot, 1.0);
        meter->pops += acceleration > FF_KNEE_POP;
        ++meter->bends;
    }
    state->knee[1] = state->knee[0];
    state->knee[0] = bend;
}

/* Height of the lowest part of a foot over the floor. The rest pose has its soles there. */
static double clearance(const ff_gait_standard *standard, const ff_vec3 *joints, const ff_quat *turns,
                        int foot)
{
    int ankle = FF_JOINT_ANKLE_L + foot * FF_JOINT_LEG_STRIDE, ball = ankle + 1;
    ff_vec3 heel = ff_add3(joints[ankle], ff_quat_rotate(turns[ankle], standard->heel[foot]));
    ff_vec3 toe = ff_add3(joints[ball], ff_quat_rotate(turns[ball], standard->toe[foot]));
    const ff_figure *figure = standard->figure;
    double heel_rest = figure->rest[ankle].y + standard->heel[foot].y;
    double toe_rest = figure->rest[ball].y + standard->toe[foot].y;
    return ff_min(ff_min(heel.y - heel_rest, toe.y - toe_rest), joints[ball].y - standard->ball_rest[foot]);
}

static void close_swing(ff_gait_meter *meter, int foot, double time)
{
    ff_gait_meter_foot *state = &meter->foot[foot];
    uint32_t count = state->swing < FF_METER_SWING ? state->swing : FF_METER_SWING;
    double least = 1e9;
    for (uint32_t k = (uint32_t)(MIDDLE_FROM * count + 0.5); k < MIDDLE_TO * count; ++k)
        least = ff_min(least, state->clear[k]);
    state->swing = 0;
    if (least > 1e8) return;
    ++meter->swings;
    meter->scraping += least < FF_SWING_CLEAR;
    worsen(&meter->clearance, least, time, foot, -1.0);
}

static void watch_swing(ff_gait_meter *meter, int foot, bool planted, double clear, double time)
{
    ff_gait_meter_foot *state = &meter->foot[foot];
    if (!planted) {
        if (state->swing < FF_METER_SWING) state->clear[state->swing] = clear;
        ++state->swing;
    } else if (state->swing > 0) {
        close_swing(meter, foot, time);
    }
}

static void watch_joints(ff_gait_meter *meter, const ff_quat *turns, double time)
{
    const ff_gait_standard *standard = meter->standard;
    double worst = 0.0;
    uint32_t count = standard->figure->joint_count;
    for (uint32_t j = 0; j < count; ++j) {
        uint32_t k = standard->as_bone[j] ? count + j : j;
        double ratio = turn_speed(meter->last[k], turns[k], standard->step) / standard->fastest[j];
        worst = ff_max(worst, ratio);
        worsen(&meter->joint, ratio, time, (int32_t)j, 1.0);
    }
    meter->fast += worst > FF_JOINT_FASTER;
}

ff_status ff_gait_meter_add(ff_gait_meter *meter, double heading, const uint8_t planted[2], ff_vec3 hips,
                            const ff_quat *rotations, ff_error *error)
{
    const ff_gait_standard *standard = meter->standard;
    ff_vec3 joints[FF_FIGURE_MAX_JOINTS];
    ff_quat turns[FF_FIGURE_MAX_JOINTS], local[FF_FIGURE_MAX_JOINTS], both[2 * FF_FIGURE_MAX_JOINTS];
    uint32_t count = standard->figure->joint_count;
    double time = (double)meter->poses * standard->step;
    ff_figure_place(standard->figure, hips, rotations, joints, turns);
    memcpy(local, rotations, count * sizeof *local);
    local[FF_JOINT_HIPS] = ff_quat_mul(ff_quat_yaw(-heading), rotations[FF_JOINT_HIPS]);
    turns_of(standard->figure, local, both);
    if (meter->poses > 0) watch_joints(meter, both, time);
    memcpy(meter->last, both, 2 * count * sizeof *both);
    for (int foot = 0; foot < 2; ++foot) {
        int hip = FF_JOINT_HIP_L + foot * FF_JOINT_LEG_STRIDE;
        watch_knee(meter, foot, bend_of_knee(joints, hip), time);
        watch_swing(meter, foot, planted[foot] != 0, clearance(standard, joints, turns, foot), time);
        ff_status status = ff_skate_add(&meter->skate, 0, foot, joints[hip + 3], standard->ball_rest[foot],
                                        planted[foot] != 0, error);
        if (status != FF_OK) return status;
    }
    double apart = ff_length2(ff_plane(ff_sub3(joints[FF_JOINT_ANKLE_L], joints[FF_JOINT_ANKLE_R])));
    worsen(&meter->ankles, apart, time, 0, -1.0);
    meter->close += apart < FF_ANKLE_GAP;
    ++meter->poses;
    return FF_OK;
}

ff_status ff_gait_meter_finish(ff_gait_meter *meter, ff_error *error)
{
    return ff_skate_finish(&meter->skate, error);
}

static ff_status append(ff_array *into, const ff_array *from, ff_error *error)
{
    if (from->count == 0) return FF_OK;
    double *slot = ff_array_grow(into, from->count, sizeof *slot);
    if (!slot) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu plants", from->count);
    memcpy(slot, from->data, from->count * sizeof *slot);
    return FF_OK;
}

static void merge_extreme(ff_gait_extreme *into, const ff_gait_extreme *from, double sign)
{
    if (from->known) worsen(into, from->value, from->time, from->part, sign);
}

ff_status ff_gait_meter_merge(ff_gait_meter *into, const ff_gait_meter *from, ff_error *error)
{
    into->poses += from->poses;
    into->pops += from->pops;
    into->bends += from->bends;
    into->fast += from->fast;
    into->scraping += from->scraping;
    into->swings += from->swings;
    into->close += from->close;
    merge_extreme(&into->knee, &from->knee, 1.0);
    merge_extreme(&into->joint, &from->joint, 1.0);
    merge_extreme(&into->ankles, &from->ankles, -1.0);
    merge_extreme(&into->clearance, &from->clearance, -1.0);
    ff_status status = append(&into->skate.planted, &from->skate.planted, error);
    return status == FF_OK ? append(&into->skate.seen, &from->skate.seen, error) : status;
}
