#include "preprocess/plants/foot_points.h"

#include "preprocess/base/filter.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Where a missing ball or toe tip is, as shares of the leg's length: means of the CMU skeletons. */
static const double BALL_FORWARD = 0.13, BALL_DOWN = 0.045, TOE_FORWARD = 0.075, TOE_DOWN = 0.012;
/* The labels' virtual heel (behind the ankle, m). */
static const double HEEL_BACK = 0.04;

/* The joints of one leg and what stands in for missing ones. */
typedef struct leg_joints {
    int ankle, ball, toe; /* joint or -1 */
    ff_vec3 ball_offset;  /* in the ankle's frame, when ball is -1 */
    ff_vec3 toe_offset;   /* in the frame of ball (or ankle), when toe is -1 */
} leg_joints;

static ff_status find_leg(const ff_clip *clip, int foot, ff_vec3 *scratch, leg_joints *out, ff_error *error)
{
    ff_role side_hip = foot == FF_LEFT ? FF_ROLE_HIP_L : FF_ROLE_HIP_R;
    ff_role side_knee = foot == FF_LEFT ? FF_ROLE_KNEE_L : FF_ROLE_KNEE_R;
    int hip = ff_clip_find(clip, side_hip), knee = ff_clip_find(clip, side_knee);
    out->ankle = ff_clip_find(clip, foot == FF_LEFT ? FF_ROLE_ANKLE_L : FF_ROLE_ANKLE_R);
    out->ball = ff_clip_find(clip, foot == FF_LEFT ? FF_ROLE_BALL_L : FF_ROLE_BALL_R);
    out->toe = ff_clip_find(clip, foot == FF_LEFT ? FF_ROLE_TOE_L : FF_ROLE_TOE_R);
    int hip_l = ff_clip_find(clip, FF_ROLE_HIP_L), hip_r = ff_clip_find(clip, FF_ROLE_HIP_R);
    if (hip < 0 || knee < 0 || out->ankle < 0 || hip_l < 0 || hip_r < 0)
        return ff_fail(error, FF_ERR_NO_DATA,
                       "%s: no joint plays the %s: foot plants need hips, knees and ankles; name them in the "
                       "catalogue (\"roles\")",
                       clip->name, hip < 0 || hip_l < 0 || hip_r < 0 ? "hip" : (knee < 0 ? "knee" : "ankle"));
    ff_clip_rest_pose(clip, scratch);
    double length = ff_length3(ff_sub3(scratch[hip], scratch[knee])) +
                    ff_length3(ff_sub3(scratch[knee], scratch[out->ankle]));
    ff_vec3 up = ff_v3(0.0, 1.0, 0.0);
    ff_vec3 left = ff_sub3(scratch[hip_l], scratch[hip_r]);
    left.y = 0.0;
    ff_vec3 forward = ff_unit3(ff_cross3(left, up));
    if (ff_length3(forward) < 0.5) forward = ff_v3(0.0, 0.0, 1.0);
    out->ball_offset = ff_madd3(ff_scale3(forward, BALL_FORWARD * length), up, -BALL_DOWN * length);
    out->toe_offset = ff_madd3(ff_scale3(forward, TOE_FORWARD * length), up, -TOE_DOWN * length);
    return FF_OK;
}

static void read_poses(const ff_clip *clip, const leg_joints *leg, ff_vec3 *positions, ff_quat *rotations,
                       ff_foot_points *out)
{
    for (int i = 0; i < out->count; ++i) {
        ff_clip_pose(clip, clip->rest_frames + i, positions, rotations);
        out->ankle[i] = positions[leg->ankle];
        out->turn[i] = rotations[leg->ankle];
        out->ball[i] = leg->ball >= 0
                           ? positions[leg->ball]
                           : ff_add3(out->ankle[i], ff_quat_rotate(out->turn[i], leg->ball_offset));
        ff_quat toes = leg->ball >= 0 ? rotations[leg->ball] : out->turn[i];
        out->toe[i] = leg->toe >= 0 ? positions[leg->toe]
                                    : ff_add3(out->ball[i], ff_quat_rotate(toes, leg->toe_offset));
    }
}

/* Frames at which the foot is likeliest flat and still: slow, and with the ankle low over the ball for its speed.
 * Without a floor yet this looks only at the foot itself. Fills chosen[] and returns how many there are (>= 1). */
static int flat_frames(const ff_foot_points *points, double rate, int *chosen, double *scratch)
{
    int n = points->count, m = 0;
    for (int i = 0; i < n; ++i)
        scratch[i] = ff_length3(ff_filter_velocity(points->ball, n, i, rate));
    double slow = ff_max(0.2, ff_filter_quantile(scratch, n, 0.15));
    for (int i = 0; i < n; ++i) {
        double speed = ff_length3(ff_filter_velocity(points->ball, n, i, rate));
        double ankle = ff_length3(ff_filter_velocity(points->ankle, n, i, rate));
        if (speed > slow || ankle > 1.5 * slow) continue;
        scratch[m] = points->ankle[i].y - points->ball[i].y;
        chosen[m++] = i;
    }
    if (m == 0) {
        chosen[0] = 0;
        return 1;
    }
    /* Heel raised or toes up: keep frames near the middle of the ankle's height over the ball. */
    double middle = ff_filter_quantile(scratch, m, 0.4);
    int kept = 0;
    for (int k = 0; k < m; ++k) {
        double over = points->ankle[chosen[k]].y - points->ball[chosen[k]].y;
        if (fabs(over - middle) < 0.015) chosen[kept++] = chosen[k];
    }
    return kept > 0 ? kept : 1;
}

/* Median over the chosen frames of a point in the ankle's frame, per coordinate. */
static ff_vec3 in_ankle(const ff_foot_points *points, const int *chosen, int count, bool heel,
                        double *scratch)
{
    double median[3];
    for (int axis = 0; axis < 3; ++axis) {
        for (int k = 0; k < count; ++k) {
            int i = chosen[k];
            ff_vec3 ankle = points->ankle[i], at = points->ball[i];
            if (heel) {
                ff_vec3 along = ff_sub3(points->ball[i], ankle);
                along.y = 0.0;
                at = ff_madd3(ankle, ff_unit3(along), -HEEL_BACK);
                at.y = points->ball[i].y;
            }
            ff_vec3 local = ff_quat_rotate(ff_quat_conj(points->turn[i]), ff_sub3(at, ankle));
            scratch[k] = axis == 0 ? local.x : (axis == 1 ? local.y : local.z);
        }
        median[axis] = ff_filter_quantile(scratch, count, 0.5);
    }
    return ff_v3(median[0], median[1], median[2]);
}

static void find_shape(ff_foot_points *points, double rate, int *chosen, double *scratch,
                       ff_foot_shape *shape)
{
    int flat = flat_frames(points, rate, chosen, scratch);
    shape->heel = in_ankle(points, chosen, flat, true, scratch);
    shape->ball = in_ankle(points, chosen, flat, false, scratch);
    shape->length = ff_length3(ff_sub3(shape->ball, shape->heel));
    for (int k = 0; k < flat; ++k)
        scratch[k] = points->ankle[chosen[k]].y - points->ball[chosen[k]].y;
    shape->ankle_height =
        ff_filter_quantile(scratch, flat, 0.5); /* over the ball; the floor is not known yet */
    for (int i = 0; i < points->count; ++i)
        points->heel[i] = ff_add3(points->ankle[i], ff_quat_rotate(points->turn[i], shape->heel));
}

ff_status ff_foot_points_read(const ff_clip *clip, int foot, ff_foot_points *out, ff_foot_shape *shape,
                              ff_error *error)
{
    memset(out, 0, sizeof *out);
    memset(shape, 0, sizeof *shape);
    int count = clip->frame_count - clip->rest_frames;
    if (count < 1) return ff_fail(error, FF_ERR_NO_DATA, "%s: no frame after its rest pose", clip->name);
    size_t n = (size_t)count;
    ff_vec3 *points = ff_calloc(n * 4, sizeof *points);
    ff_quat *turn = ff_calloc(n, sizeof *turn);
    ff_vec3 *positions = ff_calloc((size_t)clip->joint_count, sizeof *positions);
    ff_quat *rotations = ff_calloc((size_t)clip->joint_count, sizeof *rotations);
    int *chosen = ff_calloc(n, sizeof *chosen);
    double *scratch = ff_calloc(n, sizeof *scratch);
    *out = (ff_foot_points){.count = count,
                            .ankle = points,
                            .heel = points + n,
                            .ball = points + 2 * n,
                            .toe = points + 3 * n,
                            .turn = turn,
                            .memory = points};
    ff_status status = FF_OK;
    leg_joints leg = {.ankle = -1};
    if (!points || !turn || !positions || !rotations || !chosen || !scratch)
        status = ff_fail(error, FF_ERR_NO_MEMORY, "%s: no memory for %d frames of foot positions", clip->name,
                         count);
    else
        status = find_leg(clip, foot, positions, &leg, error);
    if (status == FF_OK) {
        read_poses(clip, &leg, positions, rotations, out);
        find_shape(out, 1.0 / clip->frame_time, chosen, scratch, shape);
    }
    free(positions);
    free(rotations);
    free(chosen);
    free(scratch);
    if (status != FF_OK) ff_foot_points_free(out);
    return status;
}

void ff_foot_points_free(ff_foot_points *points)
{
    free(points->memory);
    free(points->turn);
    memset(points, 0, sizeof *points);
}
