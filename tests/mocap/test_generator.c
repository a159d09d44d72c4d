/* The built-in clips against what they promise: exact plants, whole bodies, soft knees, the same bits each time. */
#include "mocap/generator/generator.h"
#include "mocap/generator/skeleton.h"
#include "tests/check.h"

#include <stdio.h>

typedef struct ff_watched {
    ff_generated made;
    ff_vec3 *points; /* [frame][FF_ROLE_COUNT] by role */
    ff_vec3 *heels;  /* [frame][2] */
} ff_watched;

static void watch(int index, const ff_generator_options *options, ff_watched *out)
{
    ff_error error;
    FF_ASSERT_OK(ff_generator_make(index, options, &out->made, &error), error);
    const ff_clip *clip = &out->made.clip;
    out->points = malloc(sizeof(ff_vec3) * FF_ROLE_COUNT * (size_t)clip->frame_count);
    out->heels = malloc(sizeof(ff_vec3) * 2 * (size_t)clip->frame_count);
    assert_non_null(out->points);
    assert_non_null(out->heels);
    for (int f = 0; f < clip->frame_count; ++f) {
        ff_vec3 p[FF_ROLE_COUNT];
        ff_quat q[FF_ROLE_COUNT];
        ff_clip_pose(clip, f, p, q);
        for (int j = 0; j < clip->joint_count; ++j) {
            int role = clip->joints[j].role;
            out->points[f * FF_ROLE_COUNT + role] = p[j];
            if (role == FF_ROLE_ANKLE_L || role == FF_ROLE_ANKLE_R)
                out->heels[2 * f + (role == FF_ROLE_ANKLE_R)] =
                    ff_add3(p[j], ff_quat_rotate(q[j], ff_v3(0, FF_BODY_BALL_HEIGHT - FF_BODY_ANKLE_HEIGHT,
                                                             -FF_BODY_HEEL)));
        }
    }
}

static void unwatch(ff_watched *watched)
{
    free(watched->points);
    free(watched->heels);
    ff_generated_free(&watched->made);
}

static ff_vec3 at(const ff_watched *w, int frame, int role)
{
    return w->points[frame * FF_ROLE_COUNT + role];
}

static void check_plant(const ff_watched *w, const ff_true_plant *plant)
{
    int ball = plant->foot == 0 ? FF_ROLE_BALL_L : FF_ROLE_BALL_R;
    if (plant->flat_start < 0) return;
    ff_vec3 heel =
        ff_sub3(plant->ball, ff_scale3(ff_ground(ff_fwd2(plant->yaw), 0.0), FF_BODY_FOOT + FF_BODY_HEEL));
    for (int f = plant->flat_start; f <= plant->flat_end; ++f) {
        FF_ASSERT_BELOW(ff_length3(ff_sub3(at(w, f, ball), plant->ball)), 1e-6);
        FF_ASSERT_BELOW(ff_length3(ff_sub3(w->heels[2 * f + plant->foot], heel)), 1e-6);
    }
    for (int f = plant->ball_start; f <= plant->ball_end; ++f) /* toe roll */
        FF_ASSERT_BELOW(ff_length3(ff_sub3(at(w, f, ball), plant->ball)), 1e-6);
    bool backward = plant->ball_start < plant->flat_start;
    int first = backward ? plant->flat_end : plant->start, last = backward ? plant->end : plant->flat_start;
    if (plant->cut_start || plant->cut_end) return;
    for (int f = first; f <= last; ++f) /* heel rocker */
        FF_ASSERT_BELOW(ff_length3(ff_sub3(w->heels[2 * f + plant->foot], heel)), 1e-6);
}

static void feet_stand_still_to_a_micrometre(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); ++i) {
        ff_watched w;
        watch(i, NULL, &w);
        assert_true(w.made.plant_count >= 2);
        for (int k = 0; k < w.made.plant_count; ++k)
            check_plant(&w, &w.made.plants[k]);
        unwatch(&w);
    }
}

static void the_same_options_give_the_same_bits(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); i += 3) {
        ff_generated a, b;
        ff_error error;
        ff_generator_options options = {.person = 2, .seed = 7};
        FF_ASSERT_OK(ff_generator_make(i, &options, &a, &error), error);
        FF_ASSERT_OK(ff_generator_make(i, &options, &b, &error), error);
        size_t frames = (size_t)a.clip.frame_count;
        assert_memory_equal(a.clip.positions, b.clip.positions, frames * sizeof(ff_vec3));
        assert_memory_equal(a.clip.rotations, b.clip.rotations, frames * FF_ROLE_COUNT * sizeof(ff_quat));
        ff_generated_free(&a);
        ff_generated_free(&b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feet_stand_still_to_a_micrometre),
        cmocka_unit_test(the_same_options_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
