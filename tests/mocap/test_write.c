/* Clips out and back in: the same poses within 1e-4 m, the same unit and rate. */
#define _GNU_SOURCE
#include "mocap/euler.h"
#include "mocap/load.h"
#include "mocap/write.h"
#include "runtime/core/base/random.h"
#include "tests/mocap/matrix.h"

#include <stdio.h>
#include <unistd.h>

static char folder[] = "/tmp/footfall-write-XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : 1;
}

static int remove_folder(void **state)
{
    (void)state;
    return rmdir(folder);
}

static char *in_folder(const char *name, char path[256])
{
    snprintf(path, 256, "%s/%s", folder, name);
    return path;
}

enum { FRAMES = 20, JOINTS = 12 };

/* Hips with two legs (end sites at the feet) and a chest whose children start in three places. */
static ff_clip make_clip(double unit_m)
{
    static const struct {
        const char *name;
        int parent;
        ff_vec3 offset;
        bool end_site;
    } shape[JOINTS] = {
        {"Hips", -1, {0, 0.95, 0}, false},
        {"LeftUpLeg", 0, {0.09, -0.05, 0}, false},
        {"LeftLeg", 1, {0, -0.42, 0}, false},
        {"LeftFoot", 2, {0, -0.41, 0.01}, false},
        {"LeftFoot_end", 3, {0, -0.05, 0.2}, true},
        {"RightUpLeg", 0, {-0.09, -0.05, 0}, false},
        {"RightLeg", 5, {0, -0.42, 0}, false},
        {"RightFoot", 6, {0, -0.41, 0.01}, false},
        {"RightFoot_end", 7, {0, -0.05, 0.2}, true},
        {"Spine", 0, {0, 0.1, 0}, false},
        {"Neck", 9, {0, 0.4, 0}, false},
        {"LeftArm", 9, {0.2, 0.35, 0}, false},
    };
    static ff_joint joints[JOINTS];
    static ff_quat rotations[FRAMES * JOINTS];
    static ff_vec3 positions[FRAMES];
    static char name[] = "made";
    ff_random random = {11, 5, 0};
    for (int j = 0; j < JOINTS; ++j) {
        memset(&joints[j], 0, sizeof joints[j]);
        snprintf(joints[j].name, sizeof joints[j].name, "%s", shape[j].name);
        joints[j].parent = shape[j].parent;
        joints[j].offset = shape[j].offset;
        joints[j].track = j == 0 ? 0 : -1;
        joints[j].role = FF_ROLE_NONE;
        joints[j].end_site = shape[j].end_site;
    }
    for (int f = 0; f < FRAMES; ++f) {
        positions[f] = ff_v3(0.1 * f, 0.95, -0.2 * f);
        for (int j = 0; j < JOINTS; ++j) {
            ff_vec3 turn = ff_v3(ff_random_range(&random, -3, 3), ff_random_range(&random, -3, 3),
                                 ff_random_range(&random, -3, 3));
            rotations[f * JOINTS + j] =
                shape[j].end_site ? FF_QUAT_IDENTITY : ff_quat_exp(ff_scale3(turn, 0.5));
        }
    }
    return (ff_clip){.name = name,
                     .joints = joints,
                     .joint_count = JOINTS,
                     .track_count = 1,
                     .frame_time = 1.0 / 60.0,
                     .frame_count = FRAMES,
                     .rotations = rotations,
                     .positions = positions,
                     .unit_m = unit_m};
}

/* Largest distance of joints of the same name; end sites are compared by their parents' rotations already. */
static double largest_difference(const ff_clip *a, const ff_clip *b)
{
    ff_vec3 p[64], q[64];
    double worst = 0.0;
    int compared = 0;
    for (int f = 0; f < a->frame_count; ++f) {
        ff_clip_pose(a, f, p, NULL);
        ff_clip_pose(b, f, q, NULL);
        for (int i = 0; i < a->joint_count; ++i)
            for (int j = 0; j < b->joint_count; ++j) {
                bool root = i == 0 && j == 0;
                if (!root && strcmp(a->joints[i].name, b->joints[j].name) != 0) continue;
                worst = ff_max(worst, ff_length3(ff_sub3(p[i], q[j])));
                ++compared;
            }
    }
    assert_true(compared >= FRAMES * (JOINTS - 2));
    return worst;
}

static void load_back(const char *path, const ff_clip *written)
{
    ff_load_options options = ff_load_options_default();
    ff_clip back;
    ff_error error;
    FF_ASSERT_OK(ff_clip_load(path, &options, &back, &error), error);
    assert_int_equal(back.frame_count, written->frame_count);
    assert_string_equal(back.warning, "");
    FF_ASSERT_NEAR(back.unit_m, written->unit_m, 1e-8);
    FF_ASSERT_NEAR(back.frame_time, written->frame_time, 1e-12);
    FF_ASSERT_BELOW(largest_difference(written, &back), 1e-6);
    ff_clip_free(&back);
}

static void a_bvh_reads_back_as_it_was(void **state)
{
    (void)state;
    static const char *const units[] = {"cm", "m", "cmu"};
    for (int i = 0; i < 3; ++i) {
        ff_clip clip = make_clip(ff_unit_preset(units[i]));
        char path[256];
        ff_error error;
        FF_ASSERT_OK(ff_bvh_write(in_folder("a.bvh", path), &clip, &error), error);
        load_back(path, &clip);
        unlink(path);
    }
}

static void an_asf_with_amc_reads_back_as_it_was(void **state)
{
    (void)state;
    static const char *const units[] = {"cmu", "m", "inch"};
    for (int i = 0; i < 3; ++i) {
        ff_clip clip = make_clip(ff_unit_preset(units[i]));
        char asf[256], amc[256];
        ff_error error;
        FF_ASSERT_OK(ff_asf_amc_write(in_folder("a.asf", asf), in_folder("a.amc", amc), &clip, &error),
                     error);
        load_back(amc, &clip);
        unlink(asf);
        unlink(amc);
    }
}

static void what_asf_cannot_hold_is_refused_and_nothing_is_written(void **state)
{
    (void)state;
    char asf[256], amc[256];
    ff_error error;
    in_folder("b.asf", asf);
    in_folder("b.amc", amc);
    ff_clip clip = make_clip(1.0);
    clip.joints[3].track = 0;
    assert_int_equal(ff_asf_amc_write(asf, amc, &clip, &error), FF_ERR_UNSUPPORTED);
    clip = make_clip(1.0);
    memcpy(clip.joints[3].name, "LeftLeg", 8);
    assert_int_equal(ff_asf_amc_write(asf, amc, &clip, &error), FF_ERR_UNSUPPORTED);
    clip = make_clip(1.0);
    clip.joints[5].parent = 8; /* an end site */
    assert_int_equal(ff_bvh_write(asf, &clip, &error), FF_ERR_ARGUMENT);
    assert_int_equal(access(asf, F_OK), -1);
    assert_int_equal(access(amc, F_OK), -1);
}

static void a_folder_that_is_not_there_is_an_error(void **state)
{
    (void)state;
    ff_clip clip = make_clip(1.0);
    char path[256];
    ff_error error;
    assert_int_equal(ff_bvh_write(in_folder("none/a.bvh", path), &clip, &error), FF_ERR_IO);
}

static void angles_give_back_the_rotation_also_where_two_axes_fall_together(void **state)
{
    (void)state;
    ff_random random = {3, 9, 0};
    for (int i = 0; i < 5000; ++i) {
        double middle = i % 3 == 0 ? 90.0 : (i % 3 == 1 ? -90.0 : ff_random_range(&random, -180, 180));
        double a = ff_random_range(&random, -180, 180), b = ff_random_range(&random, -180, 180);
        ff_quat x = ff_quat_axis(ff_v3(1, 0, 0), middle * FF_DEG),
                y = ff_quat_axis(ff_v3(0, 1, 0), a * FF_DEG);
        ff_quat z = ff_quat_axis(ff_v3(0, 0, 1), b * FF_DEG);
        ff_vec3 zxy = ff_euler_zxy(ff_quat_mul(ff_quat_mul(z, x), y));
        ff_quat middle_y = ff_quat_axis(ff_v3(0, 1, 0), middle * FF_DEG),
                outer_x = ff_quat_axis(ff_v3(1, 0, 0), a * FF_DEG);
        ff_vec3 zyx = ff_euler_zyx(ff_quat_mul(ff_quat_mul(z, middle_y), outer_x));
        ff_vec3 v = ff_v3(0.6, -0.7, 0.4);
        FF_ASSERT_AT(matrix_apply(matrix_intrinsic("zxy", zxy.z, zxy.x, zxy.y), v),
                     matrix_apply(matrix_intrinsic("zxy", b, middle, a), v), 3e-7);
        FF_ASSERT_AT(matrix_apply(matrix_intrinsic("zyx", zyx.z, zyx.y, zyx.x), v),
                     matrix_apply(matrix_intrinsic("zyx", b, middle, a), v), 3e-7);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bvh_reads_back_as_it_was),
        cmocka_unit_test(an_asf_with_amc_reads_back_as_it_was),
        cmocka_unit_test(what_asf_cannot_hold_is_refused_and_nothing_is_written),
        cmocka_unit_test(a_folder_that_is_not_there_is_an_error),
        cmocka_unit_test(angles_give_back_the_rotation_also_where_two_axes_fall_together),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
