/* Motions: what a clip looks like on the rig must not depend on where it was captured, in which unit, which way its
 * skeleton's rest pose faces or what that pose is; and it must stand on the floor and face where it walks. */
#include "tests/preprocess/motion_make.h"

#include "mocap/load.h"

#include <stdio.h>

/* ------------------------------------------------------------------------------------------------------- the rig */

static void the_rig_is_symmetric_and_stands_on_its_soles(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    ff_rig rig = rig_of(&clip);
    ff_vec3 at[FF_BODY_COUNT];
    ff_rig_rest_pose(&rig, at);
    for (int r = 0; r < FF_ROLE_COUNT; ++r) {
        ff_vec3 other = at[ff_role_mirror((ff_role)r)];
        FF_ASSERT_NEAR(at[r].x, -other.x, 1e-12);
        FF_ASSERT_NEAR(at[r].y, other.y, 1e-12);
    }
    FF_ASSERT_NEAR(at[FF_ROLE_HIP_L].y - at[FF_ROLE_ANKLE_L].y, rig.leg, 1e-12);
    FF_ASSERT_NEAR(at[FF_ROLE_HIP_L].x, at[FF_ROLE_ANKLE_L].x, 1e-12);
    FF_ASSERT_NEAR(at[FF_ROLE_SHOULDER_L].y, at[FF_ROLE_WRIST_L].y, 1e-12);
    FF_ASSERT_NEAR(at[FF_BODY_HEEL_L].y, at[FF_ROLE_BALL_L].y, 1e-12);
    FF_ASSERT_NEAR(at[FF_ROLE_BALL_L].y, 0.025, 1e-12);
    assert_true(at[FF_ROLE_TOE_L].z > at[FF_ROLE_BALL_L].z && at[FF_ROLE_BALL_L].z > at[FF_ROLE_ANKLE_L].z);
    assert_true(at[FF_ROLE_SHOULDER_L].x > 0.1);
    ff_clip_free(&clip);
}

static void the_rig_takes_the_median_of_people(void **state)
{
    (void)state;
    ff_clip clips[3];
    const ff_clip *list[3];
    for (int i = 0; i < 3; ++i) {
        clips[i] = generated_clip("idle");
        double size = 0.9 + 0.1 * i;
        for (int j = 0; j < clips[i].joint_count; ++j)
            clips[i].joints[j].offset = ff_scale3(clips[i].joints[j].offset, size);
        list[i] = &clips[i];
    }
    ff_rig all, middle = rig_of(&clips[1]);
    ff_error error;
    FF_ASSERT_OK(ff_rig_from_clips(list, 3, &all, &error), error);
    FF_ASSERT_NEAR(all.leg, middle.leg, 1e-9);
    for (int i = 0; i < 3; ++i)
        ff_clip_free(&clips[i]);
}

static void a_clip_without_legs_is_refused(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("idle");
    for (int j = 0; j < clip.joint_count; ++j)
        if (clip.joints[j].role == FF_ROLE_KNEE_R) clip.joints[j].role = FF_ROLE_NONE;
    const ff_clip *list = &clip;
    ff_rig rig;
    ff_error error;
    assert_int_equal(ff_rig_from_clips(&list, 1, &rig, &error), FF_ERR_NO_DATA);
    assert_int_equal(ff_rig_from_clips(&list, 0, &rig, &error), FF_ERR_NO_DATA);
    ff_clip_free(&clip);
}

/* ------------------------------------------------------------------------------------------- standing and walking */

static void planted_feet_are_flat_and_at_rest_height(void **state)
{
    (void)state;
    ff_rig rig;
    const char *names[] = {"walk-normal", "curve-left", "strafe-left", "walk-slow"};
    for (int i = 0; i < 4; ++i) {
        ff_clip clip = generated_clip(names[i]);
        rig = rig_of(&clip);
        made_motion made = make_motion(&rig, clip);
        for (int p = 0; p < made.plants.count; ++p) {
            const ff_plant *plant = &made.plants.items[p];
            if (plant->cut_start || plant->cut_end) continue;
            /* the middle half: at its ends a heel within 1.5 cm of the floor still counts as down */
            int quarter = (plant->flat_end - plant->flat_start) / 4;
            for (int k = plant->flat_start + quarter;
                 plant->flat_start >= 0 && k <= plant->flat_end - quarter; ++k) {
                ff_vec3 at[FF_BODY_COUNT];
                ff_motion_pose(&rig, &made.motion, k, at, NULL);
                ff_vec3 ball = at[plant->foot ? FF_ROLE_BALL_R : FF_ROLE_BALL_L];
                ff_vec3 heel = at[plant->foot ? FF_BODY_HEEL_R : FF_BODY_HEEL_L];
                FF_ASSERT_NEAR(ball.y, 0.025, 0.0005);
                FF_ASSERT_NEAR(heel.y, ball.y, 0.0005);
            }
        }
        made_motion_free(&made);
    }
}

static void the_root_moves_and_turns_as_the_clip_was_made_to(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); ++i) {
        ff_generator_info info = ff_generator_describe(i);
        if (!info.steady || strcmp(info.mode, "crouch") == 0) continue;
        ff_clip clip = generated_clip(info.name);
        ff_rig rig = rig_of(&clip);
        made_motion made = make_motion(&rig, clip);
        const ff_motion *m = &made.motion;
        int a = m->frame_count / 4, b = 3 * m->frame_count / 4;
        double seconds = (b - a) * m->frame_time;
        /* whole cycles do not fit exactly: sway is left in heading and path */
        FF_ASSERT_NEAR((m->root[b].z - m->root[a].z) / seconds, info.turn, 0.05);
        double path = 0.0;
        for (int k = a; k < b; ++k)
            path += ff_length2(ff_v2(m->root[k + 1].x - m->root[k].x, m->root[k + 1].y - m->root[k].y));
        double speed = ff_length2(ff_v2(info.forward, info.left));
        if (speed > 0.0) FF_ASSERT_NEAR(path / seconds, speed * m->scale, 0.06 + 0.03 * speed);
        made_motion_free(&made);
    }
}

static void headings_go_on_beyond_half_a_turn(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("spin-left");
    ff_rig rig = rig_of(&clip);
    made_motion made = make_motion(&rig, clip);
    const ff_motion *m = &made.motion;
    for (int k = 1; k < m->frame_count; ++k)
        FF_ASSERT_BELOW(fabs(m->root[k].z - m->root[k - 1].z), 0.1);
    assert_true(m->root[m->frame_count - 1].z - m->root[0].z > FF_TAU);
    made_motion_free(&made);
}

/* A clip that glides at constant speed, its pose frozen: the root's low-pass must not shorten the way at its ends. */
static void a_straight_way_keeps_its_length_to_the_last_frame(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("idle");
    for (int k = 1; k < clip.frame_count; ++k) {
        memcpy(clip.rotations + (size_t)k * (size_t)clip.joint_count, clip.rotations,
               (size_t)clip.joint_count * sizeof *clip.rotations);
        clip.positions[k * clip.track_count] = ff_add3(clip.positions[0], ff_v3(0.0, 0.0, 0.01 * k));
    }
    ff_rig rig = rig_of(&clip);
    made_motion made = make_motion(&rig, clip);
    for (int k = 1; k < made.motion.frame_count; ++k) {
        FF_ASSERT_NEAR(made.motion.root[k].x - made.motion.root[k - 1].x, 0.01 * made.motion.scale, 1e-9);
        FF_ASSERT_NEAR(made.motion.hips[k].x, made.motion.hips[0].x, 1e-9);
    }
    made_motion_free(&made);
}

/* ------------------------------------------------------------------------------------- what must make no difference */

/* Largest distance between points of two motions, seen from their roots. */
static double difference(const ff_rig *rig, const ff_motion *x, const ff_motion *y, bool mean)
{
    double worst = 0.0, sum = 0.0, frames = 0.0;
    assert_int_equal(x->frame_count, y->frame_count);
    for (int k = 0; k < x->frame_count; k += 7, frames += 1.0) {
        ff_vec3 p[FF_BODY_COUNT], q[FF_BODY_COUNT];
        ff_motion a = *x, b = *y;
        ff_vec3 origin[1] = {{0.0, 0.0, 0.0}};
        a.root = b.root = origin;
        a.hips += k;
        b.hips += k;
        a.rotations += (size_t)k * FF_ROLE_JOINT_COUNT;
        b.rotations += (size_t)k * FF_ROLE_JOINT_COUNT;
        ff_motion_pose(rig, &a, 0, p, NULL);
        ff_motion_pose(rig, &b, 0, q, NULL);
        for (int r = 0; r < FF_BODY_COUNT; ++r) {
            double d = ff_length3(ff_sub3(p[r], q[r]));
            worst = ff_max(worst, d);
            sum += d / FF_BODY_COUNT;
        }
    }
    return mean ? sum / frames : worst;
}

static void place_and_direction_of_the_capture_do_not_matter(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("curve-left"), moved = clip_copy(&clip);
    ff_rig rig = rig_of(&clip);
    clip_move(&moved, ff_quat_yaw(2.1), ff_v3(3.0, 0.2, -7.0));
    made_motion x = make_motion(&rig, clip), y = make_motion(&rig, moved);
    FF_ASSERT_BELOW(difference(&rig, &x.motion, &y.motion, false), 1e-6);
    FF_ASSERT_NEAR(ff_wrap(y.motion.root[50].z - x.motion.root[50].z - 2.1), 0.0, 1e-6);
    made_motion_free(&x);
    made_motion_free(&y);
}

static void a_taller_person_moves_the_same_on_the_rig(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal"), tall = clip_copy(&clip);
    ff_rig rig = rig_of(&clip);
    for (int j = 0; j < tall.joint_count; ++j)
        tall.joints[j].offset = ff_scale3(tall.joints[j].offset, 1.15);
    for (int k = 0; k < tall.frame_count * tall.track_count; ++k)
        tall.positions[k] = ff_scale3(tall.positions[k], 1.15);
    made_motion x = make_motion(&rig, clip), y = make_motion(&rig, tall);
    FF_ASSERT_NEAR(y.motion.scale * 1.15, x.motion.scale, 1e-9);
    /* the virtual heel is 4 cm behind the ankle whatever the size: foot pitch differs by a hair */
    FF_ASSERT_BELOW(difference(&rig, &x.motion, &y.motion, false), 0.004);
    made_motion_free(&x);
    made_motion_free(&y);
}

/* The same motion of a file whose identity pose has joint j turned by rest[j]. */
static void change_rest_pose(ff_clip *clip, const ff_quat *rest)
{
    int n = clip->joint_count;
    ff_vec3 at[FF_CLIP_MAX_JOINTS];
    ff_quat world[FF_CLIP_MAX_JOINTS];
    for (int k = 0; k < clip->frame_count; ++k) {
        ff_clip_pose(clip, k, at, world);
        for (int j = 0; j < n; ++j) {
            int parent = clip->joints[j].parent;
            ff_quat own = ff_quat_mul(world[j], ff_quat_conj(rest[j]));
            ff_quat above =
                parent < 0 ? FF_QUAT_IDENTITY : ff_quat_mul(world[parent], ff_quat_conj(rest[parent]));
            clip->rotations[k * n + j] = ff_quat_mul(ff_quat_conj(above), own);
        }
    }
    for (int j = 0; j < n; ++j)
        if (clip->joints[j].parent >= 0)
            clip->joints[j].offset = ff_quat_rotate(rest[clip->joints[j].parent], clip->joints[j].offset);
}

static void turn_below(const ff_clip *clip, ff_role role, ff_quat turn, ff_quat *rest)
{
    int top = ff_clip_find(clip, role);
    for (int j = 0; j < clip->joint_count; ++j)
        for (int up = j; up >= 0; up = clip->joints[up].parent)
            if (up == top) {
                rest[j] = turn;
                break;
            }
}

static void arms_that_hang_at_rest_do_not_matter(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal"), other = clip_copy(&clip);
    ff_rig rig = rig_of(&clip);
    ff_quat rest[FF_CLIP_MAX_JOINTS];
    for (int j = 0; j < clip.joint_count; ++j)
        rest[j] = FF_QUAT_IDENTITY;
    turn_below(&clip, FF_ROLE_SHOULDER_L, ff_quat_axis(ff_v3(0.0, 0.0, 1.0), -1.3), rest);
    turn_below(&clip, FF_ROLE_SHOULDER_R, ff_quat_axis(ff_v3(0.0, 0.0, 1.0), 1.3), rest);
    change_rest_pose(&other, rest);
    made_motion x = make_motion(&rig, clip), y = make_motion(&rig, other);
    FF_ASSERT_BELOW(difference(&rig, &x.motion, &y.motion, false), 1e-6);
    made_motion_free(&x);
    made_motion_free(&y);
}

static void a_rest_pose_that_faces_elsewhere_does_not_matter(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal"), other = clip_copy(&clip);
    ff_rig rig = rig_of(&clip);
    ff_quat rest[FF_CLIP_MAX_JOINTS];
    for (int j = 0; j < clip.joint_count; ++j)
        rest[j] = ff_quat_yaw(1.9);
    change_rest_pose(&other, rest);
    made_motion x = make_motion(&rig, clip), y = make_motion(&rig, other);
    FF_ASSERT_BELOW(difference(&rig, &x.motion, &y.motion, false), 1e-6);
    made_motion_free(&x);
    made_motion_free(&y);
}

/* Every bone along +X at rest, as Maya writes them: nothing but the motion itself can tell which way is which. */
static void a_rest_pose_that_is_no_person_is_worked_out_from_the_motion(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal"), other = clip_copy(&clip);
    ff_rig rig = rig_of(&clip);
    ff_quat rest[FF_CLIP_MAX_JOINTS];
    for (int j = 0; j < clip.joint_count; ++j) {
        ff_vec3 bone = {0.0, 1.0, 0.0};
        for (int c = clip.joint_count - 1; c > j; --c)
            if (clip.joints[c].parent == j && ff_length3(clip.joints[c].offset) > 0.01)
                bone = ff_unit3(clip.joints[c].offset);
        rest[j] = ff_quat_mul(ff_quat_axis(ff_v3(1.0, 0.0, 0.0), 0.7 * j),
                              ff_quat_between(bone, ff_v3(1.0, 0.0, 0.0)));
    }
    change_rest_pose(&other, rest);
    made_motion x = make_motion(&rig, clip), y = make_motion(&rig, other);
    FF_ASSERT_BELOW(difference(&rig, &x.motion, &y.motion, true), 0.03);
    made_motion_free(&x);
    made_motion_free(&y);
}

/* -------------------------------------------------------------------------------------------------------- mirrored */

static void mirrored_twice_is_the_same_to_the_last_bit(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("curve-left");
    ff_rig rig = rig_of(&clip);
    made_motion made = make_motion(&rig, clip);
    ff_motion once, twice;
    ff_error error;
    FF_ASSERT_OK(ff_motion_mirror(&made.motion, &once, &error), error);
    FF_ASSERT_OK(ff_motion_mirror(&once, &twice, &error), error);
    for (int k = 0; k < twice.frame_count; ++k) {
        FF_ASSERT_NEAR(ff_length3(ff_sub3(twice.root[k], made.motion.root[k])), 0.0, 0.0);
        FF_ASSERT_NEAR(ff_length3(ff_sub3(twice.hips[k], made.motion.hips[k])), 0.0, 0.0);
        for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
            size_t i = (size_t)k * FF_ROLE_JOINT_COUNT + (size_t)r;
            assert_memory_equal(&twice.rotations[i], &made.motion.rotations[i], sizeof twice.rotations[i]);
        }
    }
    ff_motion_free(&once);
    ff_motion_free(&twice);
    made_motion_free(&made);
}

static void a_mirrored_pose_is_the_reflection(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("curve-left");
    ff_rig rig = rig_of(&clip);
    made_motion made = make_motion(&rig, clip);
    ff_motion mirrored;
    ff_error error;
    FF_ASSERT_OK(ff_motion_mirror(&made.motion, &mirrored, &error), error);
    for (int k = 0; k < mirrored.frame_count; k += 13) {
        ff_vec3 p[FF_BODY_COUNT], q[FF_BODY_COUNT];
        ff_motion_pose(&rig, &made.motion, k, p, NULL);
        ff_motion_pose(&rig, &mirrored, k, q, NULL);
        for (int r = 0; r < FF_BODY_COUNT; ++r) {
            int other = r == FF_BODY_HEEL_L   ? FF_BODY_HEEL_R
                        : r == FF_BODY_HEEL_R ? FF_BODY_HEEL_L
                                              : (int)ff_role_mirror((ff_role)r);
            FF_ASSERT_NEAR(ff_length3(ff_sub3(ff_v3(-p[r].x, p[r].y, p[r].z), q[other])), 0.0, 1e-12);
        }
    }
    ff_motion_free(&mirrored);
    made_motion_free(&made);
}

/* ---------------------------------------------------------------------------------------------------- odd clips */

static void rest_frames_hold_the_first_real_pose(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    ff_rig rig = rig_of(&clip);
    for (int j = 0; j < clip.joint_count; ++j)
        clip.rotations[j] = FF_QUAT_IDENTITY;
    clip.rest_frames = 1;
    made_motion made = make_motion(&rig, clip);
    FF_ASSERT_NEAR(ff_length3(ff_sub3(made.motion.root[1], made.motion.root[0])), 0.0, 0.02);
    ff_vec3 p[FF_BODY_COUNT], q[FF_BODY_COUNT];
    ff_motion_pose(&rig, &made.motion, 0, p, NULL);
    ff_motion_pose(&rig, &made.motion, 1, q, NULL);
    for (int r = 0; r < FF_BODY_COUNT; ++r)
        FF_ASSERT_BELOW(ff_length3(ff_sub3(p[r], q[r])), 0.02);
    made.clip.rest_frames = made.clip.frame_count;
    ff_motion none;
    ff_error error;
    assert_int_equal(ff_motion_from_clip(&rig, &made.clip, &made.plants, &none, &error), FF_ERR_NO_DATA);
    made_motion_free(&made);
}

static void a_single_frame_and_a_clip_without_arms_work(void **state)
{
    (void)state;
    ff_clip whole = generated_clip("idle");
    ff_rig rig = rig_of(&whole);
    ff_clip one = clip_every(&whole, whole.frame_count - 1, 1);
    for (int j = 0; j < one.joint_count; ++j)
        if (one.joints[j].role >= FF_ROLE_CLAVICLE_L && one.joints[j].role <= FF_ROLE_WRIST_R)
            one.joints[j].role = FF_ROLE_NONE;
    made_motion made = make_motion(&rig, one);
    assert_int_equal(made.motion.frame_count, 1);
    ff_vec3 at[FF_BODY_COUNT];
    ff_motion_pose(&rig, &made.motion, 0, at, NULL);
    FF_ASSERT_NEAR(at[FF_ROLE_BALL_L].y, 0.025, 0.01);
    made_motion_free(&made);
    ff_clip_free(&whole);
}

/* --------------------------------------------------------------------------------------------------- real capture */

static ff_clip captured(const char *file)
{
    char path[512];
    snprintf(path, sizeof path, "%s/data/%s", ff_shared_folder(), file);
    ff_clip clip;
    ff_error error;
    ff_load_options options = ff_load_options_default();
    FF_ASSERT_OK(ff_clip_load(path, &options, &clip, &error), error);
    return clip;
}

/* Captured people of four kinds of file walk upright, forwards, with knees that bend to the front. */
static void captured_walkers_face_their_way_and_bend_their_knees_forwards(void **state)
{
    (void)state;
    if (!ff_shared_folder()) {
        print_message("SKIPPED: captured clips: no folder of outside data\n");
        skip();
    }
    const char *files[] = {"cmu/16/16_15.amc", "cmu/07/07_01.bvh", "cmu/16/16_47.amc",
                           "bandai/dataset-1/dataset-1_walk_normal_001.bvh"};
    ff_clip first = captured(files[0]);
    ff_rig rig = rig_of(&first);
    ff_clip_free(&first);
    for (int i = 0; i < 4; ++i) {
        made_motion made = make_motion(&rig, captured(files[i]));
        const ff_motion *m = &made.motion;
        int n = m->frame_count;
        ff_vec2 way = ff_v2(m->root[n - 1].x - m->root[0].x, m->root[n - 1].y - m->root[0].y);
        FF_ASSERT_BELOW(fabs(ff_wrap(m->root[n / 2].z - ff_atan2(way.b, way.a))), 0.3);
        for (int k = made.clip.rest_frames; k < n; k += 5) {
            ff_vec3 at[FF_BODY_COUNT];
            ff_quat world[FF_ROLE_JOINT_COUNT];
            ff_motion_pose(&rig, m, k, at, world);
            ff_vec2 ahead = ff_fwd2(m->root[k].z);
            for (int hip = FF_ROLE_HIP_L; hip <= FF_ROLE_HIP_R; hip += FF_ROLE_HIP_R - FF_ROLE_HIP_L) {
                ff_vec3 middle = ff_lerp3(at[hip], at[hip + 2], 0.5);
                double knee = ff_dot2(ahead, ff_sub2(ff_plane(at[hip + 1]), ff_plane(middle)));
                assert_true(knee > -0.02);
            }
            assert_true(at[FF_ROLE_HEAD].y > 1.2 && at[FF_ROLE_WRIST_L].y < 1.3);
            assert_true(at[FF_ROLE_TOE_L].y > 0.02 && at[FF_ROLE_TOE_R].y > 0.02);
            assert_true(at[FF_BODY_HEEL_L].y > -0.02 && at[FF_BODY_HEEL_R].y > -0.02);
        }
        made_motion_free(&made);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rig_is_symmetric_and_stands_on_its_soles),
        cmocka_unit_test(the_rig_takes_the_median_of_people),
        cmocka_unit_test(a_clip_without_legs_is_refused),
        cmocka_unit_test(planted_feet_are_flat_and_at_rest_height),
        cmocka_unit_test(the_root_moves_and_turns_as_the_clip_was_made_to),
        cmocka_unit_test(headings_go_on_beyond_half_a_turn),
        cmocka_unit_test(a_straight_way_keeps_its_length_to_the_last_frame),
        cmocka_unit_test(place_and_direction_of_the_capture_do_not_matter),
        cmocka_unit_test(a_taller_person_moves_the_same_on_the_rig),
        cmocka_unit_test(arms_that_hang_at_rest_do_not_matter),
        cmocka_unit_test(a_rest_pose_that_faces_elsewhere_does_not_matter),
        cmocka_unit_test(a_rest_pose_that_is_no_person_is_worked_out_from_the_motion),
        cmocka_unit_test(mirrored_twice_is_the_same_to_the_last_bit),
        cmocka_unit_test(a_mirrored_pose_is_the_reflection),
        cmocka_unit_test(rest_frames_hold_the_first_real_pose),
        cmocka_unit_test(a_single_frame_and_a_clip_without_arms_work),
        cmocka_unit_test(captured_walkers_face_their_way_and_bend_their_knees_forwards),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
