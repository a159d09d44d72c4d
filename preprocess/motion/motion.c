#include "preprocess/motion/motion.h"

#include "preprocess/motion/retarget.h"
#include "preprocess/motion/stand.h"
#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define ROOT_WINDOW 0.25 /* s, algorithms A.4 */

/* ----------------------------------------------------------------------------------------------------- the rig */

void ff_rig_pose(const ff_rig *rig, ff_vec3 hips, const ff_quat *world, ff_vec3 *positions)
{
    positions[FF_ROLE_HIPS] = hips;
    for (int r = 1; r < FF_BODY_COUNT; ++r) {
        int parent = r == FF_BODY_HEEL_L   ? (int)FF_ROLE_ANKLE_L
                     : r == FF_BODY_HEEL_R ? (int)FF_ROLE_ANKLE_R
                                           : (int)ff_role_parent((ff_role)r);
        positions[r] = ff_add3(positions[parent], ff_quat_rotate(world[parent], rig->offset[r]));
    }
}

void ff_rig_rest_pose(const ff_rig *rig, ff_vec3 *positions)
{
    ff_quat world[FF_ROLE_JOINT_COUNT];
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        world[r] = FF_QUAT_IDENTITY;
    ff_rig_pose(rig, rig->offset[FF_ROLE_HIPS], world, positions);
}

static void pose_local(const ff_rig *rig, ff_vec3 root, ff_vec3 hips, const ff_quat *local, ff_quat *world,
                       ff_vec3 *positions)
{
    world[0] = ff_quat_mul(ff_quat_yaw(root.z), local[0]);
    for (int r = 1; r < FF_ROLE_JOINT_COUNT; ++r)
        world[r] = ff_quat_mul(world[ff_role_parent((ff_role)r)], local[r]);
    ff_vec2 at = ff_add2(ff_v2(root.x, root.y), ff_from_frame2(ff_fwd2(root.z), ff_v2(hips.x, hips.y)));
    ff_rig_pose(rig, ff_ground(at, hips.z), world, positions);
}

void ff_rig_pose_local(const ff_rig *rig, ff_vec3 root, ff_vec3 hips, const ff_quat *local,
                       ff_vec3 *positions)
{
    ff_quat world[FF_ROLE_JOINT_COUNT];
    pose_local(rig, root, hips, local, world, positions);
}

void ff_motion_pose(const ff_rig *rig, const ff_motion *motion, int frame, ff_vec3 *positions,
                    ff_quat *rotations)
{
    ff_quat stack[FF_ROLE_JOINT_COUNT];
    pose_local(rig, motion->root[frame], motion->hips[frame],
               motion->rotations + (size_t)frame * FF_ROLE_JOINT_COUNT, rotations ? rotations : stack,
               positions);
}

/* --------------------------------------------------------------------------------------------------- the memory */

ff_status ff_motion_alloc(ff_motion *motion, int frames, double frame_time, ff_error *error)
{
    memset(motion, 0, sizeof *motion);
    size_t n = (size_t)frames;
    motion->frame_count = frames;
    motion->frame_time = frame_time;
    motion->scale = 1.0;
    motion->root = ff_calloc(n, sizeof *motion->root);
    motion->hips = ff_calloc(n, sizeof *motion->hips);
    motion->rotations = ff_calloc(n, FF_ROLE_JOINT_COUNT * sizeof *motion->rotations);
    if (motion->root && motion->hips && motion->rotations) return FF_OK;
    ff_motion_free(motion);
    return ff_fail(error, FF_ERR_NO_MEMORY, "a motion of %d frames", frames);
}

void ff_motion_free(ff_motion *motion)
{
    free(motion->root);
    free(motion->hips);
    free(motion->rotations);
    memset(motion, 0, sizeof *motion);
}

/* --------------------------------------------------------------------------------------------------- the root */

/* Moving average over a window of 2 half + 1 values, in place. Beyond its ends the signal goes on as its own point
 * reflection, so that a straight walk keeps its speed and its length to the last frame. */
static void moving_average(double *x, double *scratch, int count, int half)
{
    if (half > count - 1) half = count - 1;
    memcpy(scratch, x, (size_t)count * sizeof *x);
    for (int i = 0; i < count; ++i) {
        double sum = scratch[i];
        for (int k = 1; k <= half; ++k) {
            double before = i - k >= 0 ? scratch[i - k] : 2.0 * scratch[0] - scratch[k - i];
            double after =
                i + k < count ? scratch[i + k] : 2.0 * scratch[count - 1] - scratch[2 * (count - 1) - i - k];
            sum += before + after;
        }
        x[i] = sum / (2 * half + 1);
    }
}

static double facing(const ff_vec3 *at, double previous)
{
    ff_vec3 left = ff_add3(ff_sub3(at[FF_ROLE_HIP_L], at[FF_ROLE_HIP_R]),
                           ff_sub3(at[FF_ROLE_SHOULDER_L], at[FF_ROLE_SHOULDER_R]));
    left = ff_scale3(left, 0.5);
    if (ff_length2(ff_plane(left)) < 0.05) return previous;
    return previous + ff_wrap(ff_atan2(-left.z, left.x) - previous);
}

/* Root frame from raw hips and facing, hips and pelvis rotation relative to it. In: motion->hips in the world, its
 * rotations local with joint 0 in the world, root.z raw facing. */
static ff_status settle_root(ff_motion *motion, ff_error *error)
{
    int n = motion->frame_count;
    double *block = ff_calloc(4 * (size_t)n, sizeof *block);
    if (!block) return ff_fail(error, FF_ERR_NO_MEMORY, "the root path of %d frames", n);
    double *lane[3] = {block, block + n, block + 2 * n}, *scratch = block + 3 * n;
    for (int k = 0; k < n; ++k) {
        lane[0][k] = motion->hips[k].z;
        lane[1][k] = motion->hips[k].x;
        lane[2][k] = motion->root[k].z;
    }
    int half = (int)floor(0.5 * ROOT_WINDOW / motion->frame_time + 0.5);
    for (int i = 0; i < 6; ++i)
        moving_average(lane[i / 2], scratch, n, half);
    for (int k = 0; k < n; ++k) {
        ff_vec3 hips = motion->hips[k];
        ff_vec2 away = ff_sub2(ff_plane(hips), ff_v2(lane[0][k], lane[1][k]));
        ff_vec2 own = ff_to_frame2(ff_fwd2(lane[2][k]), away);
        motion->root[k] = ff_v3(lane[0][k], lane[1][k], lane[2][k]);
        motion->hips[k] = ff_v3(own.a, own.b, hips.y);
        ff_quat *pelvis = motion->rotations + (size_t)k * FF_ROLE_JOINT_COUNT;
        *pelvis = ff_quat_mul(ff_quat_yaw(-lane[2][k]), *pelvis);
    }
    free(block);
    return FF_OK;
}

/* ------------------------------------------------------------------------------------------------ whole motions */

static void carry_frame(const ff_rig *rig, const ff_retarget *retarget, const ff_clip *clip,
                        const ff_floor *floor, int frame, ff_motion *motion)
{
    ff_quat world[FF_ROLE_JOINT_COUNT], *local = motion->rotations + (size_t)frame * FF_ROLE_JOINT_COUNT;
    ff_vec3 hips, at[FF_BODY_COUNT];
    ff_retarget_pose(retarget, rig, clip, frame, &hips, world);
    ff_vec2 ground = ff_scale2(ff_plane(hips), 1.0 / retarget->scale);
    hips.y -= retarget->scale * (floor->base + ff_dot2(floor->slope, ground));
    ff_rig_pose(rig, hips, world, at);
    bool first = frame <= clip->rest_frames;
    motion->hips[frame] = hips;
    motion->root[frame].z = facing(at, first ? 0.0 : motion->root[frame - 1].z);
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
        int parent = (int)ff_role_parent((ff_role)r);
        ff_quat q = parent < 0 ? world[r] : ff_quat_mul(ff_quat_conj(world[parent]), world[r]);
        q = ff_quat_unit(q);
        /* One sign along the whole clip, so that neighbouring frames can be mixed component by component. */
        if (!first && ff_quat_dot(q, local[r - FF_ROLE_JOINT_COUNT]) < 0.0)
            q = (ff_quat){-q.x, -q.y, -q.z, -q.w};
        local[r] = q;
    }
}

ff_status ff_motion_from_clip(const ff_rig *rig, const ff_clip *clip, const ff_plants *plants, ff_motion *out,
                              ff_error *error)
{
    memset(out, 0, sizeof *out);
    ff_retarget retarget;
    int rest = clip->rest_frames;
    if (rest >= clip->frame_count) {
        ff_fail(error, FF_ERR_NO_DATA, "all %d frames are rest poses: there is no motion", clip->frame_count);
        ff_error_in_file(error, clip->source ? clip->source : "");
        return FF_ERR_NO_DATA;
    }
    ff_status status = ff_retarget_begin(rig, clip, plants, &retarget, error);
    if (status == FF_OK) status = ff_motion_alloc(out, clip->frame_count, clip->frame_time, error);
    if (status != FF_OK) return status;
    out->scale = retarget.scale;
    for (int k = rest; k < clip->frame_count; ++k)
        carry_frame(rig, &retarget, clip, &plants->floor, k, out);
    for (int k = 0; k < rest; ++k) {
        out->root[k] = out->root[rest];
        out->hips[k] = out->hips[rest];
        memcpy(out->rotations + (size_t)k * FF_ROLE_JOINT_COUNT,
               out->rotations + (size_t)rest * FF_ROLE_JOINT_COUNT,
               FF_ROLE_JOINT_COUNT * sizeof *out->rotations);
    }
    status = settle_root(out, error);
    if (status == FF_OK) status = ff_motion_stand(rig, out, plants, error);
    if (status != FF_OK) ff_motion_free(out);
    return status;
}

void ff_motion_sample(const ff_motion *motion, double frame, ff_vec3 *root, ff_vec3 *hips, ff_quat *rotations)
{
    frame = ff_clamp(frame, 0.0, motion->frame_count - 1);
    int low = (int)frame, high = low + 1 < motion->frame_count ? low + 1 : low;
    double t = frame - low;
    if (root) *root = ff_lerp3(motion->root[low], motion->root[high], t);
    if (hips) *hips = ff_lerp3(motion->hips[low], motion->hips[high], t);
    if (!rotations) return;
    const ff_quat *from = motion->rotations + (size_t)low * FF_ROLE_JOINT_COUNT;
    const ff_quat *to = motion->rotations + (size_t)high * FF_ROLE_JOINT_COUNT;
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        rotations[r] = ff_quat_nlerp(from[r], to[r], t);
}

ff_status ff_motion_copy(const ff_motion *motion, ff_motion *out, ff_error *error)
{
    ff_status status = ff_motion_alloc(out, motion->frame_count, motion->frame_time, error);
    if (status != FF_OK) return status;
    size_t n = (size_t)motion->frame_count;
    out->scale = motion->scale;
    memcpy(out->root, motion->root, n * sizeof *out->root);
    memcpy(out->hips, motion->hips, n * sizeof *out->hips);
    memcpy(out->rotations, motion->rotations, n * FF_ROLE_JOINT_COUNT * sizeof *out->rotations);
    return FF_OK;
}

void ff_pose_mirror(const ff_vec3 *hips, const ff_quat *from, ff_vec3 *out, ff_quat *to)
{
    *out = ff_v3(hips->x, -hips->y, hips->z);
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
        ff_quat q = from[ff_role_mirror((ff_role)r)];
        to[r] = (ff_quat){q.x, -q.y, -q.z, q.w};
    }
}

ff_status ff_motion_mirror(const ff_motion *motion, ff_motion *out, ff_error *error)
{
    ff_status status = ff_motion_alloc(out, motion->frame_count, motion->frame_time, error);
    if (status != FF_OK) return status;
    out->scale = motion->scale;
    for (int k = 0; k < motion->frame_count; ++k) {
        ff_vec3 root = motion->root[k];
        size_t at = (size_t)k * FF_ROLE_JOINT_COUNT;
        out->root[k] = ff_v3(root.x, -root.y, -root.z);
        ff_pose_mirror(&motion->hips[k], motion->rotations + at, &out->hips[k], out->rotations + at);
    }
    return FF_OK;
}
