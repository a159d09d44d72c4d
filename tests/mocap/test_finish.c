/* From file units to metres with Y up: the unit, the axes, the frame rate and rest poses before the motion. */
#include "mocap/read.h"
#include "tests/mocap/matrix.h"

#include <stdio.h>

/* A person of two legs, leg file units long, with one frame. */
static ff_clip person(double leg, const char *frame_time)
{
    static char text[2048];
    snprintf(text, sizeof text,
             "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation "
             "Xrotation Yrotation\n"
             "JOINT LeftUpLeg\n{\nOFFSET %g 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
             "JOINT LeftLeg\n{\nOFFSET 0 %g 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
             "JOINT LeftFoot\n{\nOFFSET 0 %g 0\nEnd Site\n{\nOFFSET 0 0 %g\n}\n}\n}\n}\n"
             "JOINT RightUpLeg\n{\nOFFSET %g 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
             "JOINT RightLeg\n{\nOFFSET 0 %g 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
             "JOINT RightFoot\n{\nOFFSET 0 %g 0\nEnd Site\n{\nOFFSET 0 0 %g\n}\n}\n}\n}\n}\n"
             "MOTION\nFrames: 1\nFrame Time: %s\n%g %g %g 10 20 30 5 5 5 0 0 0 5 5 5 0 0 0\n",
             0.1 * leg, -0.5 * leg, -0.5 * leg, 0.2 * leg, -0.1 * leg, -0.5 * leg, -0.5 * leg, 0.2 * leg,
             frame_time, leg, 2 * leg, 3 * leg);
    ff_load_options options = ff_load_options_default();
    ff_clip clip;
    ff_error error;
    FF_ASSERT_OK(ff_bvh_parse(text, strlen(text), "x.bvh", &options, &clip, &error), error);
    return clip;
}

static void the_unit_is_guessed_from_the_length_of_the_legs(void **state)
{
    (void)state;
    static const struct {
        const char *unit;
        double metres;
    } units[] = {{"m", 1.0}, {"cmu", 0.0254 / 0.45}, {"cm", 0.01}, {"inch", 0.0254}, {"mm", 0.001}};
    for (size_t i = 0; i < sizeof units / sizeof units[0]; ++i)
        for (int size = 0; size < 4; ++size) {
            double leg_m = 0.65 + 0.1 * size;
            ff_clip clip = person(leg_m / units[i].metres, "0.01");
            ff_load_options options = ff_load_options_default();
            ff_error error;
            FF_ASSERT_OK(ff_clip_finish(&clip, &options, 0.0, &error), error);
            FF_ASSERT_NEAR(clip.unit_m, units[i].metres, 0.0);
            FF_ASSERT_NEAR(clip.unit_m, ff_unit_preset(units[i].unit), 0.0);
            FF_ASSERT_NEAR(clip.positions[0].y, 2.0 * leg_m, 1e-5);
            FF_ASSERT_NEAR(clip.joints[1].offset.x, 0.1 * leg_m, 1e-5);
            assert_int_equal(clip.warning_count, 0);
            ff_clip_free(&clip);
        }
    FF_ASSERT_NEAR(ff_unit_preset("furlong"), 0.0, 0.0);
}

static void a_wrong_unit_is_warned_about_with_the_likely_right_one(void **state)
{
    (void)state;
    ff_load_options options = ff_load_options_default();
    ff_error error;
    options.unit_m = 1.0;
    ff_clip clip = person(84.0, "0.01");
    FF_ASSERT_OK(ff_clip_finish(&clip, &options, 0.0, &error), error);
    FF_ASSERT_NEAR(clip.unit_m, 1.0, 0.0); /* what the caller says is done */
    assert_string_equal(
        clip.warning,
        "legs are 84 m long with a unit of 1 m; the unit is likely 'cm', which makes them 0.84 m");
    ff_clip_free(&clip);

    options.strict = true;
    clip = person(84.0, "0.01");
    assert_int_equal(ff_clip_finish(&clip, &options, 0.0, &error), FF_ERR_RANGE);
    ff_clip_free(&clip);

    options = ff_load_options_default();
    clip = person(14.9, "0.01"); /* the file's own statement stands too, and is doubted as well */
    FF_ASSERT_OK(ff_clip_finish(&clip, &options, 0.01, &error), error);
    FF_ASSERT_NEAR(clip.unit_m, 0.01, 0.0);
    assert_non_null(strstr(clip.warning, "likely 'cmu'"));
    ff_clip_free(&clip);
}

static void a_unit_that_the_file_states_is_taken_unless_the_caller_names_one(void **state)
{
    (void)state;
    ff_load_options options = ff_load_options_default();
    ff_error error;
    ff_clip clip = person(0.5 / 0.07, "0.01");
    FF_ASSERT_OK(ff_clip_finish(&clip, &options, 0.07, &error), error);
    FF_ASSERT_NEAR(clip.unit_m, 0.07, 0.0);
    assert_int_equal(clip.warning_count, 0);
    ff_clip_free(&clip);
    options.unit_m = 0.08;
    clip = person(0.5 / 0.07, "0.01");
    FF_ASSERT_OK(ff_clip_finish(&clip, &options, 0.07, &error), error);
    FF_ASSERT_NEAR(clip.unit_m, 0.08, 0.0);
    ff_clip_free(&clip);
}

static void z_up_is_turned_so_that_poses_and_rest_pose_stand(void **state)
{
    (void)state;
    ff_clip plain = person(0.8, "0.01"), turned = person(0.8, "0.01");
    ff_load_options options = ff_load_options_default();
    ff_error error;
    options.unit_m = 1.0;
    FF_ASSERT_OK(ff_clip_finish(&plain, &options, 0.0, &error), error);
    options.up = 'z';
    FF_ASSERT_OK(ff_clip_finish(&turned, &options, 0.0, &error), error);
    ff_vec3 a[16], b[16];
    for (int pose = 0; pose < 2; ++pose) {
        if (pose == 0) {
            ff_clip_pose(&plain, 0, a, NULL);
            ff_clip_pose(&turned, 0, b, NULL);
        } else {
            ff_clip_rest_pose(&plain, a);
            ff_clip_rest_pose(&turned, b);
        }
        for (int j = 0; j < plain.joint_count; ++j) { /* x stays, z becomes y, y becomes -z */
            FF_ASSERT_AT(b[j], ff_v3(a[j].x, a[j].z, -a[j].y), 1e-14);
        }
    }
    ff_clip_free(&plain);
    ff_clip_free(&turned);
}

static void a_frame_time_with_few_digits_means_a_whole_rate(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double rate;
    } times[] = {{".0083333", 120}, {"0.008333", 120},       {"0.00833333", 120},
                 {"0.016667", 60},  {"0.0333333", 30},       {"0.0333667", 1.0 / 0.0333667},
                 {"0.04", 25},      {"0.0123", 1.0 / 0.0123}};
    ff_load_options options = ff_load_options_default();
    ff_error error;
    for (size_t i = 0; i < sizeof times / sizeof times[0]; ++i) {
        ff_clip clip = person(0.8, times[i].text);
        FF_ASSERT_OK(ff_clip_finish(&clip, &options, 0.0, &error), error);
        FF_ASSERT_NEAR(1.0 / clip.frame_time, times[i].rate, 1e-11);
        ff_clip_free(&clip);
    }
    options.fps = 50.0;
    ff_clip clip = person(0.8, "0.01");
    FF_ASSERT_OK(ff_clip_finish(&clip, &options, 0.0, &error), error);
    FF_ASSERT_NEAR(clip.frame_time, 0.02, 1e-15);
    ff_clip_free(&clip);
}

/* Rows of root and knee angles (Z X Y each). */
static int rest_frames_of(const char *rows, int frames)
{
    static char text[4096];
    snprintf(text, sizeof text,
             "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nJOINT "
             "b\n{\nOFFSET 0 1 0\n"
             "CHANNELS 3 Zrotation Xrotation Yrotation\n}\n}\nMOTION\nFrames: %d\nFrame Time: 0.01\n%s",
             frames, rows);
    ff_load_options options = ff_load_options_default();
    ff_clip clip;
    ff_error error;
    FF_ASSERT_OK(ff_bvh_parse(text, strlen(text), "x.bvh", &options, &clip, &error), error);
    assert_int_equal(clip.frame_count, frames); /* none is removed */
    int found = clip.rest_frames;
    ff_clip_free(&clip);
    return found;
}

static void a_rest_pose_before_the_motion_is_told_apart_by_the_jump_after_it(void **state)
{
    (void)state;
    assert_int_equal(rest_frames_of("0 0 0 0 0 0\n5 6 40 7 8 9\n5 6 41 7 8 9\n5 6 42 7 8 9\n", 4), 1);
    assert_int_equal(
        rest_frames_of("0 0 0 0 0 0\n0 0 0 0 0 0\n5 6 40 7 8 9\n5 6 41 7 8 9\n5 6 42 7 8 9\n", 5), 2);
    assert_int_equal(rest_frames_of("0 0 0 -17 0 0\n5 6 40 7 8 9\n5 6 41 7 8 9\n5 6 42 7 8 9\n", 4), 1);
}

static void motion_that_begins_at_rest_is_motion(void **state)
{
    (void)state;
    assert_int_equal(rest_frames_of("0 0 0 0 0 0\n0 0 1 1 0 0\n0 0 2 2 0 0\n0 0 3 3 0 0\n", 4), 0);
    assert_int_equal(rest_frames_of("0 0 0 0 0 0\n0 0 0 0 0 0\n0 0 0 0 0 0\n", 3), 0);
    assert_int_equal(rest_frames_of("0 0 30 1 0 0\n0 0 70 9 0 0\n0 0 71 9 0 0\n0 0 72 9 0 0\n", 4), 0);
    assert_int_equal(rest_frames_of("0 0 0 0 0 0\n", 1), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_unit_is_guessed_from_the_length_of_the_legs),
        cmocka_unit_test(a_wrong_unit_is_warned_about_with_the_likely_right_one),
        cmocka_unit_test(a_unit_that_the_file_states_is_taken_unless_the_caller_names_one),
        cmocka_unit_test(z_up_is_turned_so_that_poses_and_rest_pose_stand),
        cmocka_unit_test(a_frame_time_with_few_digits_means_a_whole_rate),
        cmocka_unit_test(a_rest_pose_before_the_motion_is_told_apart_by_the_jump_after_it),
        cmocka_unit_test(motion_that_begins_at_rest_is_motion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
