/* The built-in clips against what they promise: exact plants, whole bodies, soft knees, equal cycles, true mirrors, the
 * same bits each time, and the flaws that options add. */
#include "tests/mocap/watched.h"

#include <stdio.h>

/* Every clip as it is by default, made once. */
static ff_watched *all;

static int make_all(void **state)
{
    (void)state;
    all = calloc((size_t)ff_generator_count(), sizeof *all);
    if (!all) return -1;
    for (int i = 0; i < ff_generator_count(); ++i)
        watch(i, NULL, &all[i]);
    return 0;
}

static int free_all(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); ++i)
        unwatch(&all[i]);
    free(all);
    return 0;
}

/* ------------------------------------------------------------------------------------------------- plants */

static void check_plant(const ff_watched *w, const ff_true_plant *plant)
{
    int ball = ankle_of(plant->foot) + 1;
    if (plant->flat_start < 0) return;
    ff_vec3 back = ff_scale3(ff_ground(ff_fwd2(plant->yaw), 0.0), FF_BODY_FOOT + FF_BODY_HEEL);
    ff_vec3 heel = ff_sub3(plant->ball, back);
    for (int f = plant->flat_start; f <= plant->flat_end; ++f)
        FF_ASSERT_BELOW(ff_length3(ff_sub3(w->heels[2 * f + plant->foot], heel)), 1e-6);
    for (int f = plant->ball_start; f <= plant->ball_end; ++f) /* flat and toe roll */
        FF_ASSERT_BELOW(ff_length3(ff_sub3(at(w, f, ball), plant->ball)), 1e-6);
    if (plant->cut_start || plant->cut_end) return;
    bool backward = plant->ball_start < plant->flat_start;
    int first = backward ? plant->flat_end : plant->start, last = backward ? plant->end : plant->flat_start;
    for (int f = first; f <= last; ++f) /* heel rocker */
        FF_ASSERT_BELOW(ff_length3(ff_sub3(w->heels[2 * f + plant->foot], heel)), 1e-6);
}

static void feet_stand_still_to_a_micrometre(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); ++i) {
        const ff_watched *w = &all[i];
        assert_true(w->made.plant_count >= 2);
        for (int k = 0; k < w->made.plant_count; ++k)
            check_plant(w, &w->made.plants[k]);
    }
}

static void nothing_goes_through_the_floor(void **state)
{
    (void)state;
    const int low[] = {FF_ROLE_BALL_L, FF_ROLE_BALL_R, FF_ROLE_TOE_L, FF_ROLE_TOE_R};
    for (int i = 0; i < ff_generator_count(); ++i) {
        const ff_watched *w = &all[i];
        for (int f = 0; f < w->frames; ++f) {
            for (int k = 0; k < 4; ++k)
                FF_ASSERT_BELOW(FF_BODY_BALL_HEIGHT - at(w, f, low[k]).y, 0.006);
            for (int foot = 0; foot < 2; ++foot)
                FF_ASSERT_BELOW(FF_BODY_BALL_HEIGHT - w->heels[2 * f + foot].y, 0.006);
        }
    }
}

static void plants_alternate_and_lie_in_the_clip(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); ++i) {
        const ff_generated *made = &all[i].made;
        for (int k = 0; k < made->plant_count; ++k) {
            const ff_true_plant *p = &made->plants[k];
            assert_in_range(p->start, 0, (uintmax_t)p->end);
            assert_in_range(p->end, 0, (uintmax_t)made->clip.frame_count - 1);
            assert_true(k == 0 || made->plants[k - 1].start <= p->start);
            if (k > 0 && !p->cut_start && ff_generator_describe(i).steady)
                assert_int_not_equal(made->plants[k - 1].foot, p->foot);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- bodies */

static void the_skeleton_is_symmetric_and_stands_on_its_soles(void **state)
{
    (void)state;
    ff_clip clip;
    ff_error error;
    ff_vec3 p[FF_ROLE_COUNT];
    FF_ASSERT_OK(ff_body_clip("rest", 1, &clip, &error), error);
    ff_clip_rest_pose(&clip, p);
    for (int role = 0; role < FF_ROLE_COUNT; ++role) {
        int here = ff_clip_find(&clip, (ff_role)role),
            there = ff_clip_find(&clip, ff_role_mirror((ff_role)role));
        assert_true(here >= 0 && there >= 0);
        FF_ASSERT_NEAR(p[here].x, -p[there].x, 1e-12);
        FF_ASSERT_NEAR(p[here].y, p[there].y, 1e-12);
        FF_ASSERT_NEAR(p[here].z, p[there].z, 1e-12);
        assert_int_equal(clip.joints[here].end_site, role >= FF_ROLE_JOINT_COUNT);
        assert_true(clip.joints[here].parent < here);
    }
    ff_vec3 hip = p[ff_clip_find(&clip, FF_ROLE_HIP_L)], ankle = p[ff_clip_find(&clip, FF_ROLE_ANKLE_L)];
    FF_ASSERT_NEAR(hip.y - ankle.y, FF_BODY_LEG, 1e-12);
    FF_ASSERT_NEAR(hip.x, ankle.x, 1e-12);
    FF_ASSERT_NEAR(p[ff_clip_find(&clip, FF_ROLE_BALL_L)].y, FF_BODY_BALL_HEIGHT, 1e-12);
    ff_clip_free(&clip);
}

static void check_knees(const ff_watched *w)
{
    for (int f = 0; f < w->frames; ++f)
        for (int foot = 0; foot < 2; ++foot) {
            double angle = knee_flexion(w, f, foot);
            FF_ASSERT_BELOW(5.0, angle);
            FF_ASSERT_BELOW(angle, 135.0);
        }
}

static void knees_bend_one_way_and_never_lock(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); ++i)
        check_knees(&all[i]);
    for (int person = 1; person < ff_generator_people(); ++person)
        for (int i = person; i < ff_generator_count(); i += 9) {
            ff_generator_options options = {.person = person};
            ff_watched w;
            watch(i, &options, &w);
            check_knees(&w);
            unwatch(&w);
        }
}

static void bones_keep_their_length_and_nothing_twitches(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); ++i) {
        const ff_watched *w = &all[i];
        const ff_clip *clip = &w->made.clip;
        for (int f = 0; f < w->frames; ++f)
            for (int j = 1; j < clip->joint_count; ++j) {
                const ff_joint *joint = &clip->joints[j];
                ff_vec3 bone = ff_sub3(at(w, f, joint->role), at(w, f, clip->joints[joint->parent].role));
                FF_ASSERT_NEAR(ff_length3(bone), ff_length3(joint->offset), 1e-9);
                if (f == 0 || joint->end_site) continue;
                size_t now = (size_t)f * FF_ROLE_COUNT + (size_t)j;
                ff_quat step =
                    ff_quat_mul(ff_quat_conj(clip->rotations[now - FF_ROLE_COUNT]), clip->rotations[now]);
                /* 1300 deg/s: toes flick, nothing else comes near */
                FF_ASSERT_BELOW(ff_quat_angle(step) / FF_DEG, 1300.0 / 120.0);
            }
    }
}

/* Sideways distance of the ankles, in the pelvis's heading, while one passes the other. */
static void legs_never_cross(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); ++i) {
        const ff_watched *w = &all[i];
        for (int f = 0; f < w->frames; ++f) {
            ff_vec2 apart = ff_sub2(ff_plane(at(w, f, FF_ROLE_ANKLE_L)), ff_plane(at(w, f, FF_ROLE_ANKLE_R)));
            double heading = ff_quat_heading(turn_at(w, f, FF_ROLE_HIPS));
            ff_vec2 local = ff_to_frame2(ff_fwd2(heading), apart);
            if (fabs(local.a) < 0.10) FF_ASSERT_BELOW(0.06, local.b);
        }
    }
}

/* -------------------------------------------------------------------------------------------------- cycles */

/* Frames of the first whole cycle: two contacts of the left foot in a row. */
static int cycle_frames(const ff_generated *made, int *first)
{
    int found = -1;
    for (int k = 0; k < made->plant_count; ++k) {
        const ff_true_plant *p = &made->plants[k];
        if (p->foot != 0 || p->cut_start) continue;
        if (found >= 0) return p->start - found;
        *first = found = p->start;
    }
    return 0;
}

/* Speed and turn over a whole cycle are those of the description. */
static void check_pace(const ff_clip *clip, const ff_generator_info *info, int first, int cycle)
{
    ff_vec3 from = clip->positions[first], to = clip->positions[first + cycle];
    double seconds = cycle * clip->frame_time, turned = info->turn * seconds;
    double chord = fabs(turned) > 1e-9 ? 2.0 * sin(0.5 * fabs(turned)) / fabs(turned) : 1.0;
    double speed = hypot(info->forward, info->left) * chord;
    if (speed > 0.2) FF_ASSERT_NEAR(hypot(to.x - from.x, to.z - from.z) / seconds, speed, 0.10);
    double heading = ff_quat_heading(clip->rotations[(size_t)(first + cycle) * FF_ROLE_COUNT]) -
                     ff_quat_heading(clip->rotations[(size_t)first * FF_ROLE_COUNT]);
    FF_ASSERT_NEAR(ff_wrap(heading - turned), 0.0, 2e-3);
}

static void steady_clips_repeat_at_least_four_equal_cycles(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); ++i) {
        ff_generator_info info = ff_generator_describe(i);
        if (!info.steady) continue;
        const ff_clip *clip = &all[i].made.clip;
        int first = 0, cycle = cycle_frames(&all[i].made, &first);
        assert_true(cycle > 40 && clip->frame_count >= 4 * cycle);
        for (int f = 0; f + cycle < clip->frame_count; ++f)
            for (int j = 1; j < clip->joint_count; ++j) {
                ff_quat a = clip->rotations[(size_t)f * FF_ROLE_COUNT + (size_t)j];
                ff_quat b = clip->rotations[(size_t)(f + cycle) * FF_ROLE_COUNT + (size_t)j];
                bool leg = clip->joints[j].role >= FF_ROLE_HIP_L && clip->joints[j].role <= FF_ROLE_BALL_R;
                /* they breathe, not in step */
                FF_ASSERT_BELOW(ff_quat_angle(ff_quat_mul(ff_quat_conj(a), b)), leg ? 2e-5 : 0.05);
            }
        check_pace(clip, &info, first, cycle);
    }
}

/* ------------------------------------------------------------------------------------------------- mirrors */

static void mirrored_name(const char *name, char out[64])
{
    const char *left = strstr(name, "left");
    snprintf(out, 64, "%.*sright%s", (int)(left - name), name, left + 4);
}

static void compare_mirror(int left, int right)
{
    const ff_watched *a = &all[left], *b = &all[right];
    assert_int_equal(a->frames, b->frames);
    for (int f = 0; f < a->frames; ++f)
        for (int role = 0; role < FF_ROLE_COUNT; ++role) {
            ff_vec3 p = at(a, f, role), q = at(b, f, (int)ff_role_mirror((ff_role)role));
            FF_ASSERT_NEAR(p.x, -q.x, 1e-6);
            FF_ASSERT_NEAR(p.y, q.y, 1e-6);
            FF_ASSERT_NEAR(p.z, q.z, 1e-6);
        }
    assert_int_equal(a->made.plant_count, b->made.plant_count);
}

static void a_mirrored_clip_is_the_clip_of_the_other_side(void **state)
{
    (void)state;
    int pairs = 0;
    for (int i = 0; i < ff_generator_count(); ++i) {
        const char *name = ff_generator_describe(i).name;
        char other[64];
        if (!strstr(name, "left")) continue;
        mirrored_name(name, other);
        int right = ff_generator_find(other);
        assert_true(right >= 0);
        compare_mirror(i, right);
        ++pairs;
    }
    assert_true(pairs >= 15);
}

/* ------------------------------------------------------------------------------------------------- options */

static void the_same_options_give_the_same_bits(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); i += 3) {
        ff_generated a, b;
        ff_error error;
        ff_generator_options options = {.person = 2, .seed = 7, .noise_mm = 1.0, .missing = 0.1};
        FF_ASSERT_OK(ff_generator_make(i, &options, &a, &error), error);
        FF_ASSERT_OK(ff_generator_make(i, &options, &b, &error), error);
        size_t frames = (size_t)a.clip.frame_count;
        assert_memory_equal(a.clip.positions, b.clip.positions, frames * sizeof(ff_vec3));
        assert_memory_equal(a.clip.rotations, b.clip.rotations, frames * FF_ROLE_COUNT * sizeof(ff_quat));
        ff_generated_free(&a);
        ff_generated_free(&b);
    }
}

static void people_move_differently_on_the_same_feet(void **state)
{
    (void)state;
    ff_watched mean, other;
    int index = ff_generator_find("walk-normal");
    watch(index, NULL, &mean);
    for (int person = 1; person < ff_generator_people(); ++person) {
        ff_generator_options options = {.person = person};
        double hand = 0.0;
        watch(index, &options, &other);
        for (int f = 0; f < mean.frames; ++f) {
            hand = ff_max(hand,
                          ff_length3(ff_sub3(at(&mean, f, FF_ROLE_HAND_L), at(&other, f, FF_ROLE_HAND_L))));
            FF_ASSERT_BELOW(ff_length3(ff_sub3(at(&mean, f, FF_ROLE_BALL_L), at(&other, f, FF_ROLE_BALL_L))),
                            1e-9);
        }
        FF_ASSERT_BELOW(0.03, hand);
        unwatch(&other);
    }
    unwatch(&mean);
}

static void noise_moves_the_feet_by_what_was_asked(void **state)
{
    (void)state;
    ff_generator_options options = {.noise_mm = 2.0, .seed = 5};
    ff_watched clean, noisy;
    int index = ff_generator_find("walk-normal");
    watch(index, NULL, &clean);
    watch(index, &options, &noisy);
    double sum = 0.0;
    for (int f = 0; f < clean.frames; ++f) {
        ff_vec3 moved = ff_sub3(at(&noisy, f, FF_ROLE_BALL_L), at(&clean, f, FF_ROLE_BALL_L));
        sum += ff_dot3(moved, moved) / 3.0;
    }
    FF_ASSERT_NEAR(sqrt(sum / clean.frames), 0.002, 0.0006);
    unwatch(&clean);
    unwatch(&noisy);
}

static void frames_are_lost_and_floors_tilted_as_asked(void **state)
{
    (void)state;
    ff_generator_options options = {.missing = 0.2, .floor_cm = 5.0, .tilt_deg = 2.0, .seed = 3};
    ff_watched w;
    watch(ff_generator_find("walk-slow"), &options, &w);
    const ff_clip *clip = &w.made.clip;
    int same = 0;
    for (int f = 1; f < w.frames; ++f)
        same += ff_length3(ff_sub3(clip->positions[f], clip->positions[f - 1])) == 0.0;
    FF_ASSERT_NEAR((double)same / w.frames, 0.2, 0.07);
    for (int k = 0; k < w.made.plant_count; ++k) {
        ff_vec3 ball = w.made.plants[k].ball;
        FF_ASSERT_NEAR(ball.y, 0.05 + FF_BODY_BALL_HEIGHT + ball.z * tan(2.0 * FF_DEG), 1e-3);
    }
    unwatch(&w);
}

static void feet_skate_as_asked(void **state)
{
    (void)state;
    ff_generator_options options = {.skate_cm = 2.0, .seed = 3};
    ff_watched w;
    double longest = 0.0;
    watch(ff_generator_find("walk-slow"), &options, &w);
    for (int k = 0; k < w.made.plant_count; ++k) {
        const ff_true_plant *p = &w.made.plants[k];
        if (p->flat_start < 0) continue;
        int ball = ankle_of(p->foot) + 1;
        longest =
            ff_max(longest, ff_length3(ff_sub3(at(&w, p->flat_start, ball), at(&w, p->flat_end, ball))));
    }
    FF_ASSERT_NEAR(longest, 0.02, 0.01);
    unwatch(&w);
}

static void absurd_options_are_refused(void **state)
{
    (void)state;
    const ff_generator_options bad[] = {{.person = -1},          {.person = 99},    {.noise_mm = -1.0},
                                        {.skate_cm = -1.0},      {.missing = 1.0},  {.missing = -0.1},
                                        {.noise_mm = 0.0 / 0.0}, {.tilt_deg = 1e9}, {.floor_cm = 0.0 / 0.0}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        ff_generated made;
        ff_error error;
        assert_int_equal(ff_generator_make(0, &bad[i], &made, &error), FF_ERR_ARGUMENT);
        assert_null(made.plants);
        assert_true(strlen(error.message) > 10);
    }
    ff_generated made;
    ff_error error;
    assert_int_equal(ff_generator_make(-1, NULL, &made, &error), FF_ERR_ARGUMENT);
    assert_int_equal(ff_generator_make(ff_generator_count(), NULL, &made, &error), FF_ERR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feet_stand_still_to_a_micrometre),
        cmocka_unit_test(nothing_goes_through_the_floor),
        cmocka_unit_test(plants_alternate_and_lie_in_the_clip),
        cmocka_unit_test(the_skeleton_is_symmetric_and_stands_on_its_soles),
        cmocka_unit_test(knees_bend_one_way_and_never_lock),
        cmocka_unit_test(bones_keep_their_length_and_nothing_twitches),
        cmocka_unit_test(legs_never_cross),
        cmocka_unit_test(steady_clips_repeat_at_least_four_equal_cycles),
        cmocka_unit_test(a_mirrored_clip_is_the_clip_of_the_other_side),
        cmocka_unit_test(the_same_options_give_the_same_bits),
        cmocka_unit_test(people_move_differently_on_the_same_feet),
        cmocka_unit_test(noise_moves_the_feet_by_what_was_asked),
        cmocka_unit_test(frames_are_lost_and_floors_tilted_as_asked),
        cmocka_unit_test(feet_skate_as_asked),
        cmocka_unit_test(absurd_options_are_refused),
    };
    return cmocka_run_group_tests(tests, make_all, free_all);
}
