/* Clips brought into one form: nothing but place and facing changes. */
#include "mocap/normal.h"

#include "mocap/generator/generator.h"
#include "tests/check.h"

static ff_clip walk(void)
{
    ff_generated made;
    ff_error error;
    FF_ASSERT_OK(ff_generator_make(ff_generator_find("walk-normal"), NULL, &made, &error), error);
    ff_clip clip = made.clip;
    memset(&made.clip, 0, sizeof made.clip);
    ff_generated_free(&made);
    return clip;
}

/* Turn the motion of a clip about the vertical and move it, as a capture from anywhere in the room. */
static void displace(ff_clip *clip, double angle, ff_vec3 by)
{
    for (int k = 0; k < clip->frame_count; ++k) {
        ff_quat *q = &clip->rotations[(size_t)k * (size_t)clip->joint_count];
        ff_vec3 *p = &clip->positions[(size_t)k * (size_t)clip->track_count];
        *q = ff_quat_mul(ff_quat_yaw(angle), *q);
        *p = ff_add3(ff_quat_rotate(ff_quat_yaw(angle), *p), by);
    }
}

static void a_motion_starts_over_the_origin_facing_ahead(void **state)
{
    (void)state;
    ff_clip clip = walk();
    ff_error error;
    ff_vec3 at[FF_CLIP_MAX_JOINTS];
    double heading;
    displace(&clip, 2.1, ff_v3(5.0, 0.0, -3.0));
    FF_ASSERT_OK(ff_clip_normalise(&clip, &error), error);
    ff_clip_pose(&clip, 0, at, NULL);
    assert_true(ff_clip_heading(&clip, at, &heading));
    FF_ASSERT_NEAR(heading, 0.0, 1e-9);
    ff_vec3 hips = at[ff_clip_find(&clip, FF_ROLE_HIPS)];
    FF_ASSERT_NEAR(hips.x, 0.0, 1e-9);
    FF_ASSERT_NEAR(hips.z, 0.0, 1e-9);
    assert_true(hips.y > 0.7);
    ff_clip_rest_pose(&clip, at);
    assert_true(ff_clip_heading(&clip, at, &heading));
    FF_ASSERT_NEAR(heading, 0.0, 1e-9);
    ff_clip_free(&clip);
}

static void wherever_it_was_captured_the_result_is_the_same(void **state)
{
    (void)state;
    ff_clip here = walk(), there = walk();
    ff_error error;
    ff_vec3 a[FF_CLIP_MAX_JOINTS], b[FF_CLIP_MAX_JOINTS];
    displace(&there, -1.3, ff_v3(-40.0, 0.0, 7.0));
    FF_ASSERT_OK(ff_clip_normalise(&here, &error), error);
    FF_ASSERT_OK(ff_clip_normalise(&there, &error), error);
    for (int k = 0; k < here.frame_count; k += 50) {
        ff_clip_pose(&here, k, a, NULL);
        ff_clip_pose(&there, k, b, NULL);
        for (int j = 0; j < here.joint_count; ++j)
            FF_ASSERT_BELOW(ff_length3(ff_sub3(a[j], b[j])), 1e-9);
    }
    ff_clip_free(&here);
    ff_clip_free(&there);
}

static void a_skeleton_that_faces_aside_is_turned_with_its_motion(void **state)
{
    (void)state;
    ff_clip clip = walk(), aside = walk();
    ff_error error;
    ff_vec3 a[FF_CLIP_MAX_JOINTS], b[FF_CLIP_MAX_JOINTS];
    ff_quat turn = ff_quat_yaw(0.9), back = ff_quat_yaw(-0.9);
    for (int j = 0; j < aside.joint_count; ++j)
        aside.joints[j].offset = ff_quat_rotate(turn, aside.joints[j].offset);
    for (size_t i = 0; i < (size_t)aside.frame_count * (size_t)aside.joint_count; ++i)
        aside.rotations[i] = ff_quat_mul(ff_quat_mul(turn, aside.rotations[i]), back);
    for (size_t i = 0; i < (size_t)aside.frame_count * (size_t)aside.track_count; ++i)
        aside.positions[i] = ff_quat_rotate(turn, aside.positions[i]);
    FF_ASSERT_OK(ff_clip_normalise(&clip, &error), error);
    FF_ASSERT_OK(ff_clip_normalise(&aside, &error), error);
    for (int j = 0; j < clip.joint_count; ++j)
        FF_ASSERT_BELOW(ff_length3(ff_sub3(clip.joints[j].offset, aside.joints[j].offset)), 1e-9);
    ff_clip_pose(&clip, 77, a, NULL);
    ff_clip_pose(&aside, 77, b, NULL);
    for (int j = 0; j < clip.joint_count; ++j)
        FF_ASSERT_BELOW(ff_length3(ff_sub3(a[j], b[j])), 1e-9);
    ff_clip_free(&clip);
    ff_clip_free(&aside);
}

static void rest_frames_go_and_the_rest_of_the_frames_stays(void **state)
{
    (void)state;
    ff_clip clip = walk();
    ff_error error;
    int frames = clip.frame_count;
    clip.rest_frames = 3;
    FF_ASSERT_OK(ff_clip_normalise(&clip, &error), error);
    assert_int_equal(clip.frame_count, frames - 3);
    assert_int_equal(clip.rest_frames, 0);
    ff_clip_free(&clip);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_motion_starts_over_the_origin_facing_ahead),
        cmocka_unit_test(wherever_it_was_captured_the_result_is_the_same),
        cmocka_unit_test(a_skeleton_that_faces_aside_is_turned_with_its_motion),
        cmocka_unit_test(rest_frames_go_and_the_rest_of_the_frames_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
