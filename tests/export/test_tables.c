/* Recordings and the files for other programs: CSV and BVH, read back with independent readers. */
#define _XOPEN_SOURCE 700 /* mkdtemp */

#include "mocap/load.h"
#include "runtime/export/bvh.h"
#include "runtime/export/csv.h"
#include "tests/export/folder.h"
#include "tests/export/walker.h"

static void test_a_recorded_pose_is_kept_to_a_hundredth_of_a_degree(void **state)
{
    (void)state;
    ff_scene scene;
    ff_recording recording;
    walker_scene("{\"kind\": \"circle\", \"agents\": 3}", &scene);
    walker_record(&scene, 2.0, &recording);
    assert_int_equal(recording.step_count, 61);
    assert_int_equal(recording.pose_count, 61);
    for (uint32_t k = 0; k < 61; k += 7) {
        const ff_scene_agent *agent = ff_scene_agents(&scene) + 1;
        ff_quat want[FF_JOINT_COUNT], got[FF_JOINT_COUNT];
        ff_vec3 hips;
        walker_pose(k * scene.step * 1.3 / 1.4, agent->heading, want);
        ff_recording_pose(&recording, k, 1, &hips, got);
        FF_ASSERT_NEAR(hips.y, 0.93, 1e-6);
        for (int j = 0; j < FF_JOINT_COUNT; ++j)
            FF_ASSERT_BELOW(ff_quat_angle(ff_quat_mul(ff_quat_conj(want[j]), got[j])), 0.01 * FF_DEG);
    }
    ff_recording_free(&recording);
    ff_scene_free(&scene);
}

static void test_poses_of_a_fine_step_are_taken_at_30_hz(void **state)
{
    (void)state;
    ff_error error;
    ff_recording recording;
    FF_ASSERT_OK(ff_recording_create(10, 21, 0.01, 1000, &recording, &error), error);
    assert_int_equal(recording.pose_stride, 3);
    ff_recording_free(&recording);
    FF_ASSERT_OK(ff_recording_create(10, 21, 0.1, 1000, &recording, &error), error);
    assert_int_equal(recording.pose_stride, 1);
    ff_recording_free(&recording);
}

static void test_a_run_too_large_to_keep_takes_fewer_poses_and_then_none(void **state)
{
    (void)state;
    ff_error error;
    ff_recording recording;
    FF_ASSERT_OK(ff_recording_create(5000, 21, 1.0 / 30.0, 1800, &recording, &error), error);
    assert_true(recording.pose_stride > 1);
    ff_recording_free(&recording);
    assert_int_equal(ff_recording_create(20000, 21, 1.0 / 30.0, 30 * 3600, &recording, &error), FF_ERR_RANGE);
    assert_non_null(strstr(error.message, "fewer"));
}

static void test_crowd_csv_has_one_row_per_agent_ten_times_a_second(void **state)
{
    (void)state;
    ff_error error;
    ff_scene scene;
    ff_recording recording;
    walker_scene("{\"kind\": \"circle\", \"agents\": 4}", &scene);
    walker_record(&scene, 2.0, &recording);
    FF_ASSERT_OK(ff_csv_write(folder_path("crowd.csv"), &scene, &recording, 0.1, &error), error);
    ff_file file = folder_read("crowd.csv");
    static const char header[] = "time,id,x,z,heading,speed,goal_x,goal_z,radius,reached\n";
    assert_true(file.size > sizeof header);
    assert_memory_equal(file.data, header, sizeof header - 1);
    int rows = 0;
    for (const char *line = file.data + sizeof header - 1; line < file.data + file.size; ++rows) {
        double v[10];
        assert_int_equal(sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &v[0], &v[1], &v[2], &v[3],
                                &v[4], &v[5], &v[6], &v[7], &v[8], &v[9]),
                         10);
        const ff_track *track = ff_recording_track(&recording, (uint32_t)(v[0] * 30.0 + 0.5), (uint32_t)v[1]);
        int tick = rows / 4;
        FF_ASSERT_NEAR(v[0], 0.1 * tick, 1e-3);
        FF_ASSERT_NEAR(v[1], rows % 4, 0.0);
        FF_ASSERT_NEAR(v[2], track->position.b, 1e-4);
        FF_ASSERT_NEAR(v[3], track->position.a, 1e-4);
        FF_ASSERT_NEAR(v[4], (double)track->heading, 1e-4);
        FF_ASSERT_NEAR(v[6], ff_scene_agents(&scene)[(int)v[1]].goal.b, 1e-3);
        line = (const char *)memchr(line, '\n', (size_t)(file.data + file.size - line)) + 1;
    }
    assert_int_equal(rows, 21 * 4);
    ff_file_unmap(&file);
    ff_recording_free(&recording);
    ff_scene_free(&scene);
}

static void test_agent_bvh_read_again_has_every_joint_where_it_was(void **state)
{
    (void)state;
    ff_error error;
    ff_scene scene;
    ff_recording recording;
    ff_figure figure;
    ff_clip clip;
    walker_figure(&figure);
    walker_scene("{\"kind\": \"circle\", \"agents\": 2}", &scene);
    walker_record(&scene, 3.0, &recording);
    FF_ASSERT_OK(ff_recording_write_bvh(folder_path("agent-0.bvh"), &figure, &recording, 0, &error), error);
    ff_load_options options = ff_load_options_default();
    options.unit_m = 1.0;
    options.strict = true;
    FF_ASSERT_OK(ff_clip_load(folder_path("agent-0.bvh"), &options, &clip, &error), error);
    assert_int_equal(clip.frame_count, recording.pose_count);
    FF_ASSERT_NEAR(clip.frame_time, 1.0 / 30.0, 1e-7);
    assert_int_equal(clip.warning_count, 0);
    for (int k = 0; k < clip.frame_count; k += 9) {
        ff_vec3 hips, want[FF_FIGURE_MAX_JOINTS], got[64];
        ff_quat local[FF_FIGURE_MAX_JOINTS];
        ff_recording_pose(&recording, (uint32_t)k, 0, &hips, local);
        ff_figure_place(&figure, hips, local, want, NULL);
        assert_true(clip.joint_count <= 64);
        ff_clip_pose(&clip, k, got, NULL);
        for (int role = 0; role < FF_ROLE_JOINT_COUNT; ++role) {
            int joint = ff_clip_find(&clip, (ff_role)role);
            assert_true(joint >= 0);
            FF_ASSERT_BELOW(ff_length3(ff_sub3(got[joint], want[role])), 1e-4);
        }
    }
    ff_clip_free(&clip);
    ff_recording_free(&recording);
    ff_scene_free(&scene);
}

static void test_a_bvh_through_straight_up_rotations_reads_back_too(void **state)
{
    (void)state;
    ff_error error;
    ff_figure figure;
    ff_recording recording;
    ff_clip clip;
    walker_figure(&figure);
    FF_ASSERT_OK(ff_recording_create(1, FF_JOINT_COUNT, 1.0 / 30.0, 40, &recording, &error), error);
    for (int k = 0; k < 37; ++k) { /* the middle angle of Z X Y passes +-90 degrees here */
        ff_quat local[FF_JOINT_COUNT];
        walker_pose(0.1, 0.7, local);
        local[FF_JOINT_SHOULDER_L] = ff_quat_axis(ff_v3(1, 0, 0), 10.0 * k * FF_DEG);
        FF_ASSERT_OK(ff_recording_begin(&recording, &error), error);
        ff_recording_set_track(&recording, 0, &(ff_agent_state){0});
        ff_recording_set_pose(&recording, 0, ff_v3(0.0, 0.93, 0.0), local);
    }
    FF_ASSERT_OK(ff_recording_write_bvh(folder_path("agent-0.bvh"), &figure, &recording, 0, &error), error);
    ff_load_options options = ff_load_options_default();
    options.unit_m = 1.0;
    FF_ASSERT_OK(ff_clip_load(folder_path("agent-0.bvh"), &options, &clip, &error), error);
    for (int k = 0; k < 37; ++k) {
        ff_vec3 hips, want[FF_FIGURE_MAX_JOINTS], got[64];
        ff_quat local[FF_FIGURE_MAX_JOINTS];
        ff_recording_pose(&recording, (uint32_t)k, 0, &hips, local);
        ff_figure_place(&figure, hips, local, want, NULL);
        ff_clip_pose(&clip, k, got, NULL);
        int wrist = ff_clip_find(&clip, FF_ROLE_WRIST_L);
        FF_ASSERT_BELOW(ff_length3(ff_sub3(got[wrist], want[FF_JOINT_WRIST_L])), 1e-4);
    }
    ff_clip_free(&clip);
    ff_recording_free(&recording);
}

static int remove_folder(void **state)
{
    (void)state;
    static const char *const names[] = {"crowd.csv", "agent-0.bvh", NULL};
    return folder_remove(names);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_recorded_pose_is_kept_to_a_hundredth_of_a_degree),
        cmocka_unit_test(test_poses_of_a_fine_step_are_taken_at_30_hz),
        cmocka_unit_test(test_a_run_too_large_to_keep_takes_fewer_poses_and_then_none),
        cmocka_unit_test(test_crowd_csv_has_one_row_per_agent_ten_times_a_second),
        cmocka_unit_test(test_agent_bvh_read_again_has_every_joint_where_it_was),
        cmocka_unit_test(test_a_bvh_through_straight_up_rotations_reads_back_too),
    };
    return cmocka_run_group_tests(tests, folder_create, remove_folder);
}
