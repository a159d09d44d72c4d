/* From what a file holds to what clip.h promises: Y up, metres, roles, rest frames told apart. */
#include "mocap/read.h"
#include "mocap/roles_find.h"
#include "mocap/text.h"

#include <stdio.h>
#include <string.h>

/* The file's z axis becomes y. Everything is seen from turned axes, so that the rest pose turns too: rotations are
 * conjugated, offsets and positions turned. */
static void turn_z_up(ff_clip *clip)
{
    for (int j = 0; j < clip->joint_count; ++j) {
        ff_vec3 o = clip->joints[j].offset;
        clip->joints[j].offset = ff_v3(o.x, o.z, -o.y);
    }
    size_t rotations = (size_t)clip->frame_count * (size_t)clip->joint_count;
    for (size_t i = 0; i < rotations; ++i) {
        ff_quat q = clip->rotations[i];
        clip->rotations[i] = (ff_quat){q.x, q.z, -q.y, q.w};
    }
    size_t positions = (size_t)clip->frame_count * (size_t)clip->track_count;
    for (size_t i = 0; i < positions; ++i) {
        ff_vec3 p = clip->positions[i];
        clip->positions[i] = ff_v3(p.x, p.z, -p.y);
    }
}

static void scale(ff_clip *clip, double unit_m)
{
    clip->unit_m = unit_m;
    for (int j = 0; j < clip->joint_count; ++j)
        clip->joints[j].offset = ff_scale3(clip->joints[j].offset, unit_m);
    size_t positions = (size_t)clip->frame_count * (size_t)clip->track_count;
    for (size_t i = 0; i < positions; ++i)
        clip->positions[i] = ff_scale3(clip->positions[i], unit_m);
}

/* Rates are printed with few digits (.0083333, 0.016667): a whole number of frames per second that is within
 * 0.02 % is what was meant; 29.97 is 0.1 % from 30 and stays. */
static double plain_frame_time(double seconds)
{
    double rate = floor(1.0 / seconds + 0.5);
    return rate >= 1.0 && fabs(rate * seconds - 1.0) < 2e-4 ? 1.0 / rate : seconds;
}

/* ------------------------------------------------------------------------------------------------------ unit */

static const struct unit {
    const char *name;
    double metres;
} units[] = {{"m", 1.0}, {"cmu", 0.0254 / 0.45}, {"inch", 0.0254}, {"cm", 0.01}, {"mm", 0.001}};
enum { UNIT_COUNT = sizeof units / sizeof units[0] };

double ff_unit_preset(const char *name)
{
    for (int i = 0; name && i < UNIT_COUNT; ++i)
        if (strcmp(units[i].name, name) == 0) return units[i].metres;
    return 0.0;
}

/* Thigh plus shank (mean of both sides) in the clip's present unit; 0 when the legs are not known. */
static double leg_length(const ff_clip *clip)
{
    static const ff_role legs[2][3] = {{FF_ROLE_HIP_L, FF_ROLE_KNEE_L, FF_ROLE_ANKLE_L},
                                       {FF_ROLE_HIP_R, FF_ROLE_KNEE_R, FF_ROLE_ANKLE_R}};
    ff_vec3 at[FF_CLIP_MAX_JOINTS];
    ff_clip_pose(clip, ff_clip_typical_frame(clip), at, NULL);
    double sum = 0.0;
    for (int side = 0; side < 2; ++side) {
        int hip = ff_clip_find(clip, legs[side][0]), knee = ff_clip_find(clip, legs[side][1]);
        int ankle = ff_clip_find(clip, legs[side][2]);
        if (hip < 0 || knee < 0 || ankle < 0) return 0.0;
        sum += ff_length3(ff_sub3(at[hip], at[knee])) + ff_length3(ff_sub3(at[knee], at[ankle]));
    }
    return 0.5 * sum;
}

/* Legs of people from a small child to a giant; adults have 0.7 to 0.95 m. */
#define SHORTEST_LEG 0.40
#define TYPICAL_LEG 0.84
#define LONGEST_LEG 1.20

static const struct unit *likeliest_unit(double leg)
{
    const struct unit *best = &units[0];
    double least = HUGE_VAL;
    for (int i = 0; i < UNIT_COUNT; ++i) {
        double ratio = leg * units[i].metres / TYPICAL_LEG;
        double off = ff_max(ratio, 1.0 / ratio);
        if (off < least) least = off, best = &units[i];
    }
    return best;
}

static bool human(double leg)
{
    return leg >= SHORTEST_LEG && leg <= LONGEST_LEG;
}

static ff_status odd_unit(ff_clip *clip, bool strict, ff_error *error, const char *message)
{
    if (!strict) {
        ff_clip_warn(clip, "%s", message);
        return FF_OK;
    }
    ff_fail(error, FF_ERR_RANGE, "%s", message);
    ff_error_in_file(error, clip->source);
    return FF_ERR_RANGE;
}

/* What is odd about legs of this length (file units) under this unit; "" when nothing is. */
static void judge_unit(double leg, double unit_m, char message[256])
{
    const struct unit *likely = likeliest_unit(leg);
    message[0] = '\0';
    if (human(leg * unit_m)) return;
    if (human(leg * likely->metres)) {
        snprintf(
            message, 256,
            "legs are %.3g m long with a unit of %.4g m; the unit is likely '%s', which makes them %.2f m",
            leg * unit_m, unit_m, likely->name, leg * likely->metres);
    } else {
        snprintf(message, 256, "legs are %.3g m long with a unit of %.4g m, and no known unit fits them",
                 leg * unit_m, unit_m);
    }
}

static ff_status set_unit(ff_clip *clip, const ff_load_options *options, double stated_m, ff_error *error)
{
    double leg = leg_length(clip), unit_m = options->unit_m > 0.0 ? options->unit_m : stated_m;
    char message[256] = "";
    if (leg > 0.0) {
        if (!(unit_m > 0.0)) unit_m = likeliest_unit(leg)->metres;
        judge_unit(leg, unit_m, message);
    } else if (!(unit_m > 0.0)) {
        unit_m = 0.01;
        snprintf(message, sizeof message, "the unit cannot be told without legs; centimetres are assumed");
    }
    scale(clip, unit_m);
    return message[0] ? odd_unit(clip, options->strict, error, message) : FF_OK;
}

/* Characters of games are often as large as the artist liked: a person's legs are taken for theirs. */
static ff_status set_size(ff_clip *clip, const ff_load_options *options, ff_error *error)
{
    double leg = leg_length(clip), unit_m = 1.0;
    char message[256] = "";
    if (options->unit_m > 0.0 || human(leg) || !(leg > 0.0)) return set_unit(clip, options, unit_m, error);
    const struct unit *likely = likeliest_unit(leg);
    if (human(leg * likely->metres)) {
        unit_m = likely->metres;
        snprintf(message, sizeof message,
                 "legs are %.3g m long; the unit is taken to be '%s', which makes them %.2f m", leg,
                 likely->name, leg * unit_m);
    } else {
        unit_m = TYPICAL_LEG / leg;
        snprintf(
            message, sizeof message,
            "legs are %.3g m long, not a person's: scaled by %.3g to legs of %.2f m (a \"unit\" stops that)",
            leg, unit_m, TYPICAL_LEG);
    }
    scale(clip, unit_m);
    return odd_unit(clip, options->strict, error, message);
}

/* Frame rate, axes and roles: what every format needs before its unit can be judged. */
static ff_status finish_joints(ff_clip *clip, const ff_load_options *options, ff_error *error)
{
    clip->frame_time = options->fps > 0.0 ? 1.0 / options->fps : plain_frame_time(clip->frame_time);
    if (options->up == 'z') turn_z_up(clip);
    return ff_roles_find(clip, options->overrides, options->override_count, error);
}

ff_status ff_clip_finish_sized(ff_clip *clip, const ff_load_options *options, ff_error *error)
{
    ff_status status = finish_joints(clip, options, error);
    return status == FF_OK ? set_size(clip, options, error) : status;
}

ff_status ff_clip_finish(ff_clip *clip, const ff_load_options *options, double stated_m, ff_error *error)
{
    ff_status status = finish_joints(clip, options, error);
    return status == FF_OK ? set_unit(clip, options, stated_m, error) : status;
}
