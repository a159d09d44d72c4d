/* Broken capture: what is put into a clean clip by hand is found, named, put back or cut out; what is whole is left
 * alone. */
#include "preprocess/plants/breaks.h"

#include "mocap/load.h"
#include "preprocess/actions/steps.h"
#include "tests/preprocess/motion_make.h"
#include "tests/preprocess/standard.h"

#include <stdio.h>

static ff_breaks find(const ff_clip *clip)
{
    ff_breaks breaks;
    ff_error error;
    FF_ASSERT_OK(ff_breaks_find(clip, &standard()->find.breaks, &breaks, &error), error);
    return breaks;
}

static void built_in_clips_are_whole(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); ++i) {
        ff_clip clip = generated_clip(ff_generator_describe(i).name);
        ff_breaks breaks = find(&clip);
        if (breaks.count > 0) {
            char text[160];
            ff_break_say(&breaks.items[0], text, sizeof text);
            print_error("%s: %s\n", clip.name, text);
        }
        assert_int_equal(breaks.count, 0);
        ff_breaks_free(&breaks);
        ff_clip_free(&clip);
    }
}

static ff_vec3 joint_at(const ff_clip *clip, int frame, ff_role role)
{
    static ff_vec3 at[FF_CLIP_MAX_JOINTS];
    ff_clip_pose(clip, frame, at, NULL);
    return at[ff_clip_find(clip, role)];
}

/* Turn one joint in one frame. */
static void wrench(ff_clip *clip, int frame, ff_role role, double angle)
{
    ff_quat *q = &clip->rotations[frame * clip->joint_count + ff_clip_find(clip, role)];
    *q = ff_quat_mul(*q, ff_quat_axis(ff_v3(1.0, 0.0, 0.0), angle));
}

static void a_single_wild_frame_is_put_back(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    int frame = clip.frame_count / 2;
    ff_vec3 was = joint_at(&clip, frame, FF_ROLE_BALL_L);
    wrench(&clip, frame, FF_ROLE_HIP_L, 0.2);
    assert_true(ff_length3(ff_sub3(joint_at(&clip, frame, FF_ROLE_BALL_L), was)) > 0.1);
    ff_breaks breaks;
    ff_error error;
    FF_ASSERT_OK(ff_breaks_repair(&clip, &standard()->find.breaks, &breaks, &error), error);
    assert_int_equal(breaks.count, 1);
    assert_int_equal(breaks.items[0].kind, FF_BREAK_SPIKE);
    assert_int_equal(breaks.items[0].first, frame);
    assert_true(breaks.items[0].repaired);
    FF_ASSERT_BELOW(ff_length3(ff_sub3(joint_at(&clip, frame, FF_ROLE_BALL_L), was)), 0.003);
    assert_null(ff_breaks_within(&breaks, 0, clip.frame_count - 1));
    ff_breaks_free(&breaks);
    breaks = find(&clip);
    assert_int_equal(breaks.count, 0);
    ff_breaks_free(&breaks);
    ff_clip_free(&clip);
}

static void a_jump_of_the_root_is_found_and_no_step_or_plant_goes_across_it(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    ff_rig rig = rig_of(&clip);
    int frame = clip.frame_count / 2, track = clip.joints[0].track;
    for (int f = frame; f < clip.frame_count; ++f)
        clip.positions[f * clip.track_count + track].x += 0.5;
    made_motion made = make_motion(&rig, clip);
    const ff_break *b = ff_breaks_within(&made.plants.breaks, frame - 1, frame);
    assert_non_null(b);
    assert_int_equal(b->kind, FF_BREAK_JUMP);
    FF_ASSERT_NEAR(b->size, 0.5, 0.05);
    for (int i = 0; i < made.plants.count; ++i)
        assert_false(made.plants.items[i].start < frame && made.plants.items[i].end >= frame);
    ff_actions actions;
    ff_error error;
    FF_ASSERT_OK(ff_actions_cut(&standard()->cut, &rig, &made.motion, &made.plants, -1, &actions, &error),
                 error);
    assert_true(actions.count > 4);
    bool said = false;
    for (int i = 0; i < actions.count; ++i)
        assert_false(actions.items[i].first_frame < frame && actions.items[i].last_frame >= frame);
    for (int i = 0; i < actions.rejection_count; ++i)
        said = said || strstr(actions.rejections[i].reason, "jumps by");
    assert_true(said);
    ff_actions_free(&actions);
    made_motion_free(&made);
}

static void a_frozen_stretch_is_found_unless_the_body_rests(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    int frame = clip.frame_count / 3;
    size_t joints = (size_t)clip.joint_count, tracks = (size_t)clip.track_count;
    for (int f = frame + 1; f < frame + 9; ++f) {
        memcpy(clip.rotations + (size_t)f * joints, clip.rotations + (size_t)frame * joints,
               joints * sizeof *clip.rotations);
        memcpy(clip.positions + (size_t)f * tracks, clip.positions + (size_t)frame * tracks,
               tracks * sizeof *clip.positions);
    }
    ff_breaks breaks = find(&clip);
    const ff_break *frozen = NULL;
    for (int i = 0; i < breaks.count; ++i)
        if (breaks.items[i].kind == FF_BREAK_FROZEN) frozen = &breaks.items[i];
    assert_non_null(frozen);
    assert_int_equal(frozen->first, frame);
    assert_int_equal(frozen->last, frame + 8);
    ff_breaks_free(&breaks);
    ff_clip_free(&clip);
}

/* What the labels' README tells of these captures, and what they hold besides. */
static void known_broken_captures_are_found(void **state)
{
    (void)state;
    static const struct {
        const char *clip;
        int first, last;
        ff_break_kind kind;
    } known[] = {{"16/16_29", 102, 108, FF_BREAK_JUMP},
                 {"16/16_13", 205, 232, FF_BREAK_JUMP},
                 {"16/16_17", 470, 478, FF_BREAK_JUMP},
                 {"49/49_04", 158, 163, FF_BREAK_JUMP},
                 {"49/49_04", 244, 250, FF_BREAK_FROZEN}};
    const char *shared = ff_shared_folder();
    if (!shared) {
        print_message("SKIPPED known_broken_captures_are_found: the shared folder is not there\n");
        skip();
    }
    for (size_t k = 0; k < sizeof known / sizeof known[0]; ++k) {
        char path[512];
        snprintf(path, sizeof path, "%s/data/cmu/%s.amc", shared, known[k].clip);
        ff_load_options options = ff_load_options_default();
        ff_clip clip;
        ff_error error;
        FF_ASSERT_OK(ff_clip_load(path, &options, &clip, &error), error);
        ff_breaks breaks = find(&clip);
        bool found = false;
        for (int i = 0; i < breaks.count; ++i)
            found =
                found || (breaks.items[i].kind == known[k].kind && breaks.items[i].first >= known[k].first &&
                          breaks.items[i].last <= known[k].last);
        if (!found)
            print_error("%s: nothing found from %d to %d\n", known[k].clip, known[k].first, known[k].last);
        assert_true(found);
        ff_breaks_free(&breaks);
        ff_clip_free(&clip);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(built_in_clips_are_whole),
        cmocka_unit_test(a_single_wild_frame_is_put_back),
        cmocka_unit_test(a_jump_of_the_root_is_found_and_no_step_or_plant_goes_across_it),
        cmocka_unit_test(a_frozen_stretch_is_found_unless_the_body_rests),
        cmocka_unit_test(known_broken_captures_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
