#include "preprocess/pack/pose_lanes.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Seen from its reference a rotation is (x, y, z, w) / w, tangents of half its angle, as long as it stays within this of
 * it; else all four parts are kept, which know no limit. */
#define WIDEST_COS 0.34 /* cos(70 degrees): 140 degrees from the reference */
#define STILL 2e-5      /* m: a lane that moves joints by less, root mean square, stands still */

static double component(ff_quat q, int c)
{
    return c == 0 ? q.x : (c == 1 ? q.y : (c == 2 ? q.z : q.w));
}

/* The mean rotation of a joint, signs followed from frame to frame. */
static ff_quat mean_rotation(const ff_pose_motion *motion, int joint)
{
    ff_quat sum = {0.0, 0.0, 0.0, 0.0}, last = motion->rotations[joint];
    for (int k = 0; k < motion->frame_count; ++k) {
        ff_quat q = motion->rotations[(size_t)k * FF_JOINT_COUNT + (size_t)joint];
        if (ff_quat_dot(q, last) < 0.0) q = (ff_quat){-q.x, -q.y, -q.z, -q.w};
        sum = (ff_quat){sum.x + q.x, sum.y + q.y, sum.z + q.z, sum.w + q.w};
        last = q;
    }
    return ff_quat_unit(sum);
}

/* Seen from the reference, signs followed; returns the smallest w. */
static double relative_rotations(const ff_pose_motion *motion, int joint, ff_quat reference, ff_quat *out)
{
    double least = 1.0;
    for (int k = 0; k < motion->frame_count; ++k) {
        ff_quat q = ff_quat_mul(ff_quat_conj(reference),
                                motion->rotations[(size_t)k * FF_JOINT_COUNT + (size_t)joint]);
        if (k == 0 ? q.w < 0.0 : ff_quat_dot(q, out[k - 1]) < 0.0) q = (ff_quat){-q.x, -q.y, -q.z, -q.w};
        least = ff_min(least, q.w);
        out[k] = ff_quat_unit(q);
    }
    return least;
}

/* Rest position of a joint: every rotation is the identity there. */
static ff_vec3 rest_position(const ff_pack_joint *joints, int joint)
{
    ff_vec3 at = {0.0, 0.0, 0.0};
    for (int j = joint; j >= 0; j = joints[j].parent)
        at = ff_add3(
            at, ff_v3((double)joints[j].offset[0], (double)joints[j].offset[1], (double)joints[j].offset[2]));
    return at;
}

static bool carries(const ff_pack_joint *joints, int joint, int other)
{
    while (other > joint)
        other = joints[other].parent;
    return other == joint;
}

/* Root mean square over joints and points of how far they move per unit of a half angle's tangent, about any axis. */
static double lever_of(const ff_pack_joint *joints, const ff_pack_point *points, int joint)
{
    ff_vec3 from = rest_position(joints, joint);
    double sum = 0.0;
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        if (!carries(joints, joint, j)) continue;
        ff_vec3 arm = ff_sub3(rest_position(joints, j), from);
        sum += ff_dot3(arm, arm);
    }
    for (int p = 0; p < FF_POINT_COUNT; ++p) {
        if (!carries(joints, joint, points[p].joint)) continue;
        const float *offset = points[p].offset;
        ff_vec3 arm = ff_add3(rest_position(joints, points[p].joint),
                              ff_v3((double)offset[0], (double)offset[1], (double)offset[2]));
        arm = ff_sub3(arm, from);
        sum += ff_dot3(arm, arm);
    }
    return 2.0 * sqrt(2.0 / 3.0 * sum / (FF_JOINT_COUNT + FF_POINT_COUNT));
}

static ff_pose_lane *add_lane(ff_pose_lanes *lanes, int slot, double lever, int frames)
{
    ff_pose_lane *lane = &lanes->lane[lanes->count];
    *lane = (ff_pose_lane){slot, false, lever, lanes->values + (size_t)lanes->count * (size_t)frames};
    ++lanes->count;
    return lane;
}

/* A lane that does not move is kept at its middle; one that need not be kept is taken back. */
static void settle(ff_pose_lanes *lanes, int frames)
{
    ff_pose_lane *lane = &lanes->lane[lanes->count - 1];
    double low = lane->values[0], high = low;
    for (int k = 1; k < frames; ++k) {
        low = ff_min(low, lane->values[k]);
        high = ff_max(high, lane->values[k]);
    }
    lane->still = (high - low) * lane->lever < STILL;
    double middle = 0.5 * (low + high);
    bool nothing = lane->slot < 3 * FF_STREAM_SLOTS && fabs(middle) * lane->lever < 0.1 * STILL;
    if (!lane->still) return;
    for (int k = 0; k < frames; ++k)
        lane->values[k] = nothing ? 0.0 : middle;
    if (nothing) --lanes->count;
}

static void add_joint(ff_pose_lanes *lanes, const ff_pose_motion *motion, int joint, double lever,
                      ff_quat *scratch)
{
    ff_quat reference = mean_rotation(motion, joint);
    bool whole = relative_rotations(motion, joint, reference, scratch) < WIDEST_COS;
    lanes->reference[joint] = reference;
    lanes->whole[joint] = whole;
    for (int c = 0; c < (whole ? 4 : 3); ++c) {
        ff_pose_lane *lane = add_lane(lanes, c * FF_STREAM_SLOTS + joint, lever, motion->frame_count);
        for (int k = 0; k < motion->frame_count; ++k)
            lane->values[k] = component(scratch[k], c) / (whole ? 1.0 : scratch[k].w);
        settle(lanes, motion->frame_count);
    }
}

static void add_hips(ff_pose_lanes *lanes, const ff_pose_motion *motion)
{
    for (int c = 0; c < 3; ++c) {
        ff_pose_lane *lane = add_lane(lanes, c * FF_STREAM_SLOTS + FF_STREAM_HIPS, 1.0, motion->frame_count);
        for (int k = 0; k < motion->frame_count; ++k) {
            ff_vec3 hips = motion->hips[k];
            lane->values[k] = c == 0 ? hips.x : (c == 1 ? hips.y : hips.z);
        }
        settle(lanes, motion->frame_count);
    }
}

ff_status ff_pose_lanes_create(const ff_pack_joint *joints, const ff_pack_point *points,
                               const ff_pose_motion *motion, ff_pose_lanes *out, ff_error *error)
{
    memset(out, 0, sizeof *out);
    size_t n = (size_t)motion->frame_count;
    out->values = ff_calloc(n, FF_LANES_MAX * sizeof *out->values);
    ff_quat *scratch = ff_calloc(n, sizeof *scratch);
    ff_status status = FF_OK;
    if (out->values && scratch) {
        for (int j = 0; j < FF_JOINT_COUNT; ++j)
            add_joint(out, motion, j, lever_of(joints, points, j), scratch);
        add_hips(out, motion);
    } else {
        ff_pose_lanes_free(out);
        status = ff_fail(error, FF_ERR_NO_MEMORY, "out of memory storing %d poses", motion->frame_count);
    }
    free(scratch);
    return status;
}

void ff_pose_lanes_free(ff_pose_lanes *lanes)
{
    free(lanes->values);
    memset(lanes, 0, sizeof *lanes);
}

double ff_pose_lane_effect(const ff_pose_lanes *lanes, int index, int frame)
{
    const ff_pose_lane *lane = &lanes->lane[index];
    int joint = lane->slot % FF_STREAM_SLOTS;
    if (joint == FF_STREAM_HIPS || lanes->whole[joint]) return 1.0;
    double tangent = lane->values[frame];
    return 1.0 / (1.0 + tangent * tangent);
}

void ff_pose_lanes_pose(const ff_pose_lanes *lanes, const double *value, ff_vec3 *hips, ff_quat *rotations)
{
    double part[4][FF_STREAM_SLOTS] = {{0.0}};
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        part[3][j] = 1.0;
    for (int i = 0; i < lanes->count; ++i)
        part[lanes->lane[i].slot / FF_STREAM_SLOTS][lanes->lane[i].slot % FF_STREAM_SLOTS] = value[i];
    *hips = ff_v3(part[0][FF_STREAM_HIPS], part[1][FF_STREAM_HIPS], part[2][FF_STREAM_HIPS]);
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        ff_quat q = {part[0][j], part[1][j], part[2][j], part[3][j]};
        rotations[j] = ff_quat_mul(lanes->reference[j], ff_quat_unit(q));
    }
}
