/* What of a captured body is calibration and noise and not gait. */
#include "preprocess/examples/example.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define GAZE (-5.0 * FF_DEG) /* below the horizon, walking on level ground */

static ff_quat head_rotation(const ff_example *example, int frame)
{
    const ff_quat *local = example->rotations + (size_t)frame * FF_ROLE_JOINT_COUNT;
    ff_quat world = FF_QUAT_IDENTITY;
    for (int r = FF_ROLE_HEAD; r >= 0; r = (int)ff_role_parent((ff_role)r))
        world = ff_quat_mul(local[r], world);
    return world;
}

void ff_example_level_head(ff_example *example)
{
    ff_quat mean = {0.0, 0.0, 0.0, 0.0};
    for (int k = 0; k < example->frame_count; ++k) {
        ff_quat q = head_rotation(example, k);
        double sign = ff_quat_dot(q, mean) < 0.0 ? -1.0 : 1.0;
        mean = (ff_quat){mean.x + sign * q.x, mean.y + sign * q.y, mean.z + sign * q.z, mean.w + sign * q.w};
    }
    mean = ff_quat_unit(mean);
    ff_quat wanted =
        ff_quat_mul(ff_quat_yaw(ff_quat_heading(mean)), ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -GAZE));
    ff_quat turn = ff_quat_mul(ff_quat_conj(mean), wanted);
    for (int k = 0; k < example->frame_count; ++k) {
        ff_quat *head = &example->rotations[(size_t)k * FF_ROLE_JOINT_COUNT + FF_ROLE_HEAD];
        *head = ff_quat_unit(ff_quat_mul(*head, turn));
    }
}

/* A Gaussian of 0.8 frames: 10 Hz at 60 frames per second. */
#define REACH 2
static const double weights[REACH + 1] = {0.4991, 0.2286, 0.02185};

static ff_quat smooth_rotation(const ff_quat *all, int count, int frame, int joint)
{
    ff_quat middle = all[frame * FF_ROLE_JOINT_COUNT + joint], sum = {0.0, 0.0, 0.0, 0.0};
    for (int d = -REACH; d <= REACH; ++d) {
        int k = (frame + d + REACH * count) % count;
        ff_quat q = all[k * FF_ROLE_JOINT_COUNT + joint];
        double w = weights[abs(d)] * (ff_quat_dot(q, middle) < 0.0 ? -1.0 : 1.0);
        sum = (ff_quat){sum.x + w * q.x, sum.y + w * q.y, sum.z + w * q.z, sum.w + w * q.w};
    }
    return ff_quat_unit(sum);
}

static ff_vec3 smooth_point(const ff_vec3 *all, int count, int frame)
{
    ff_vec3 sum = {0.0, 0.0, 0.0};
    for (int d = -REACH; d <= REACH; ++d)
        sum = ff_madd3(sum, all[(frame + d + REACH * count) % count], weights[abs(d)]);
    return sum;
}

ff_status ff_example_smooth(ff_example *example, ff_error *error)
{
    size_t n = (size_t)example->frame_count;
    ff_vec3 *hips = ff_calloc(n, sizeof *hips);
    ff_quat *rotations = ff_calloc(n * FF_ROLE_JOINT_COUNT, sizeof *rotations);
    ff_status status = FF_OK;
    if (hips && rotations) {
        memcpy(hips, example->hips, n * sizeof *hips);
        memcpy(rotations, example->rotations, n * FF_ROLE_JOINT_COUNT * sizeof *rotations);
        for (int k = 0; k < example->frame_count; ++k) {
            example->hips[k] = smooth_point(hips, example->frame_count, k);
            for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
                example->rotations[k * FF_ROLE_JOINT_COUNT + r] =
                    smooth_rotation(rotations, example->frame_count, k, r);
        }
    } else {
        status = ff_fail(error, FF_ERR_NO_MEMORY, "smoothing a gait cycle of %zu frames", n);
    }
    free(hips);
    free(rotations);
    return status;
}
