/* Actions cut from generated clips: closed forms, sign conventions, mirroring, tiling. */
#include "preprocess/actions/annotate.h"
#include "preprocess/motion/standing.h"

#include "mocap/generator/generator.h"
#include "tests/preprocess/clip_change.h"
#include "tests/preprocess/standard.h"

#include <stdio.h>

/* One generated clip all the way to its actions. */
typedef struct cut {
    ff_generated made;
    ff_plants plants;
    ff_rig rig;
    ff_motion motion;
    ff_actions actions;
} cut;

static void cut_clip(cut *c, const ff_clip *clip, int mode_tag)
{
    ff_error error;
    FF_ASSERT_OK(ff_plants_find(clip, &standard()->find, &c->plants, &error), error);
    FF_ASSERT_OK(ff_rig_from_clips(&clip, 1, &c->rig, &error), error);
    FF_ASSERT_OK(ff_motion_from_clip(&c->rig, clip, &c->plants, &c->motion, &error), error);
    FF_ASSERT_OK(
        ff_actions_cut(&standard()->cut, &c->rig, &c->motion, &c->plants, mode_tag, &c->actions, &error),
        error);
}

static cut cut_generated(const char *name, bool reflected, int mode_tag)
{
    cut c;
    ff_error error;
    int index = ff_generator_find(name);
    assert_true(index >= 0);
    FF_ASSERT_OK(ff_generator_make(index, NULL, &c.made, &error), error);
    if (reflected) clip_reflect(&c.made.clip);
    cut_clip(&c, &c.made.clip, mode_tag);
    return c;
}

static void cut_free(cut *c)
{
    ff_actions_free(&c->actions);
    ff_motion_free(&c->motion);
    ff_plants_free(&c->plants);
    ff_generated_free(&c->made);
}

static void energy_of_known_paths(void **state)
{
    (void)state;
    enum { N = 241 };
    static ff_vec3 root[N];
    double dt = 1.0 / 120.0, seconds = (N - 1) * dt;
    FF_ASSERT_NEAR(ff_walk_energy(&standard()->cut.energy, root, 0, N - 1, dt), 2.23 * seconds,
                   1e-9); /* standing */
    FF_ASSERT_NEAR(ff_walk_energy(&standard()->cut.energy, root, 7, 7, dt), 0.0, 0.0);
    for (int i = 0; i < N; ++i)
        root[i] = ff_v3(1.1 * i * dt, -0.7 * i * dt, 0.3 * i);
    double constant = 2.23 + 1.26 * (1.1 * 1.1 + 0.7 * 0.7);
    FF_ASSERT_NEAR(ff_walk_energy(&standard()->cut.energy, root, 0, N - 1, dt), constant * seconds, 1e-9);
    FF_ASSERT_NEAR(ff_walk_energy(&standard()->cut.energy, root, 60, 180, dt), constant * 1.0, 1e-9);
    for (int i = 0; i < N; ++i)
        root[i] = ff_v3(0.5 * 1.5 * i * dt * i * dt, 0.0, 0.0); /* v = 1.5 t */
    double ramp = 2.23 * seconds + 1.26 * 1.5 * 1.5 * seconds * seconds * seconds / 3.0;
    FF_ASSERT_NEAR(ff_walk_energy(&standard()->cut.energy, root, 0, N - 1, dt), ramp, 0.005 * ramp);
    /* The best speed costs what the heuristic says per metre (algorithms B.2, section H). */
    double best = sqrt(2.23 / 1.26);
    for (int i = 0; i < N; ++i)
        root[i] = ff_v3(best * i * dt, 0.0, 0.0);
    FF_ASSERT_NEAR(ff_walk_energy(&standard()->cut.energy, root, 0, N - 1, dt) / (best * seconds), 3.3525,
                   1e-4);
}

static void a_walk_is_tiled_by_alternating_steps(void **state)
{
    (void)state;
    cut c = cut_generated("walk-normal", false, -1);
    assert_true(c.actions.count >= 8);
    for (int i = 0; i < c.actions.count; ++i) {
        const ff_action *a = &c.actions.items[i];
        const ff_pack_action *r = &a->record;
        assert_int_equal(r->support + r->swing, 1);
        assert_true(r->mode == FF_MODE_WALK_SHORT || r->mode == FF_MODE_WALK_LONG);
        FF_ASSERT_NEAR(r->alpha, 0.0, 12.0 * FF_DEG);
        FF_ASSERT_NEAR(r->theta, 0.0, 6.0 * FF_DEG);
        FF_ASSERT_NEAR(r->duration, r->t_end - r->t_0, 1e-6);
        FF_ASSERT_NEAR(r->t_0, a->first_frame * c.motion.frame_time, 1e-6);
        assert_true(r->step_width > 0.0f && r->step_width < 0.3f);
        assert_true(r->flight[0] < 0.0f && r->flight[1] < 0.0f);
        assert_int_equal(r->flags, 0);
        if (i == 0) continue;
        assert_int_equal(a->first_frame, c.actions.items[i - 1].last_frame);
        assert_int_equal(r->support, c.actions.items[i - 1].record.swing);
        assert_int_equal(r->support_plant, c.actions.items[i - 1].record.swing_plant);
    }
    cut_free(&c);
}

static void every_frame_is_in_an_action_or_in_a_rejection(void **state)
{
    (void)state;
    static const char *const names[] = {"walk-normal", "curve-left", "strafe-left", "walk-brisk"};
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
        cut c = cut_generated(names[k], false, -1);
        for (int f = 0; f + 1 < c.motion.frame_count; ++f) {
            int in = 0;
            for (int i = 0; i < c.actions.count; ++i)
                in += c.actions.items[i].first_frame <= f && f < c.actions.items[i].last_frame;
            for (int i = 0; i < c.actions.rejection_count; ++i) {
                in += c.actions.rejections[i].first_frame <= f && f < c.actions.rejections[i].last_frame;
                assert_true(c.actions.rejections[i].reason[0] != 0);
            }
            assert_int_equal(in, 1);
        }
        cut_free(&c);
    }
}

static void chained_steps_land_where_the_walk_went(void **state)
{
    (void)state;
    cut c = cut_generated("curve-left", false, -1);
    /* Walk the footsteps by the records alone, from the first support foot on. */
    const ff_action *first = &c.actions.items[0];
    ff_vec3 at[FF_BODY_COUNT];
    ff_motion_pose(&c.rig, &c.motion, first->first_frame, at, NULL);
    ff_vec2 foot = ff_plane(at[first->record.support == FF_LEFT ? FF_ROLE_BALL_L : FF_ROLE_BALL_R]);
    double heading = c.motion.root[first->first_frame].z;
    for (int i = 0; i < c.actions.count; ++i) {
        const ff_action *a = &c.actions.items[i];
        if (i > 0 && a->first_frame != c.actions.items[i - 1].last_frame) break;
        ff_vec2 local = ff_v2(a->record.land[0], a->record.land[1]);
        foot = ff_add2(foot, ff_from_frame2(ff_fwd2(heading), local));
        heading += a->record.theta;
        ff_motion_pose(&c.rig, &c.motion, a->last_frame, at, NULL);
        ff_vec2 truth = ff_plane(at[a->record.swing == FF_LEFT ? FF_ROLE_BALL_L : FF_ROLE_BALL_R]);
        FF_ASSERT_BELOW(ff_length2(ff_sub2(foot, truth)), 0.05); /* feet creep a little while they stand */
        FF_ASSERT_NEAR(ff_wrap(heading - c.motion.root[a->last_frame].z), 0.0, 1e-4);
    }
    cut_free(&c);
}

static void signs_of_turns_and_side_steps(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double theta; /* sign of the heading change */
        double side;  /* sign of the way to the left */
    } cases[] = {
        {"curve-left", 1, 0}, {"curve-right", -1, 0}, {"strafe-left", 0, 1}, {"strafe-right", 0, -1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        cut c = cut_generated(cases[k].name, false, -1);
        assert_true(c.actions.count >= 6);
        for (int i = 0; i < c.actions.count; ++i) {
            const ff_pack_action *r = &c.actions.items[i].record;
            if (cases[k].theta != 0) assert_true(cases[k].theta * r->theta > 0.0);
            if (cases[k].side == 0) continue;
            assert_true(cases[k].side * r->root_displacement[1] > 0.0);
            FF_ASSERT_NEAR(r->direction, cases[k].side * FF_PI / 2, 0.4);
            /* Towards the swing side alpha is +90 degrees; the closing foot goes the other way: -90. */
            double open = (r->swing == FF_LEFT) == (cases[k].side > 0) ? 1.0 : -1.0;
            FF_ASSERT_NEAR(r->alpha, open * FF_PI / 2, 0.5);
        }
        cut_free(&c);
    }
}

static void mirroring_twice_is_nothing(void **state)
{
    (void)state;
    cut c = cut_generated("curve-left", false, -1);
    for (int i = 0; i < c.actions.count; ++i) {
        static ff_action once, twice;
        ff_action_mirror(&c.actions.items[i], &once);
        ff_action_mirror(&once, &twice);
        assert_memory_equal(&twice, &c.actions.items[i], sizeof twice);
        assert_int_equal(once.record.flags & FF_ACTION_MIRRORED, FF_ACTION_MIRRORED);
        assert_int_equal(once.record.support, c.actions.items[i].record.swing);
        FF_ASSERT_NEAR(once.record.alpha, c.actions.items[i].record.alpha, 0.0);
        FF_ASSERT_NEAR(once.record.theta, -c.actions.items[i].record.theta, 0.0);
        FF_ASSERT_NEAR(once.record.step_width, c.actions.items[i].record.step_width, 0.0);
    }
    cut_free(&c);
}

static void a_mirrored_action_is_the_action_of_the_mirrored_clip(void **state)
{
    (void)state;
    cut c = cut_generated("curve-left-tight", false, -1), m = cut_generated("curve-left-tight", true, -1);
    assert_int_equal(c.actions.count, m.actions.count);
    for (int i = 0; i < c.actions.count; ++i) {
        static ff_action mine;
        ff_action_mirror(&c.actions.items[i], &mine);
        const ff_action *theirs = &m.actions.items[i];
        assert_int_equal(mine.record.support, theirs->record.support);
        assert_int_equal(mine.record.mode, theirs->record.mode);
        assert_int_equal(mine.first_frame, theirs->first_frame);
        assert_int_equal(mine.last_frame, theirs->last_frame);
        const float *a = mine.record.root_displacement, *b = theirs->record.root_displacement;
        /* All numbers from the displacement up to the energy are floats in a row. */
        size_t count = (size_t)(&mine.record.coarse_radius - a) + 1;
        for (size_t k = 0; k < count; ++k)
            FF_ASSERT_NEAR(a[k], b[k], 1e-6);
        assert_int_equal(mine.record.collider_samples, theirs->record.collider_samples);
        for (uint32_t s = 0; s < mine.record.collider_samples; ++s)
            for (int k = 0; k < FF_COLLIDER_COUNT; ++k) {
                FF_ASSERT_NEAR(mine.colliders[s][k].a, theirs->colliders[s][k].a, 1e-6);
                FF_ASSERT_NEAR(mine.colliders[s][k].b, theirs->colliders[s][k].b, 1e-6);
                FF_ASSERT_NEAR(mine.colliders[s][k].y, theirs->colliders[s][k].y, 1e-6);
            }
    }
    cut_free(&c);
    cut_free(&m);
}

static void colliders_follow_the_body_at_20_hz(void **state)
{
    (void)state;
    cut c = cut_generated("walk-normal", false, -1);
    for (int i = 0; i < c.actions.count; ++i) {
        const ff_action *a = &c.actions.items[i];
        uint32_t n = a->record.collider_samples;
        assert_int_equal(n, (int)ceil(a->record.duration * 20.0 - 1e-4) + 1);
        for (uint32_t s = 0; s < n; ++s) {
            const ff_pack_collider *at = a->colliders[s], *root = &at[FF_COLLIDER_ROOT];
            assert_true(at[FF_COLLIDER_HEAD].y > at[FF_COLLIDER_HAND_L].y);
            assert_true(at[FF_COLLIDER_HAND_L].y > at[FF_COLLIDER_FOOT_L].y);
            assert_true(at[FF_COLLIDER_FOOT_L].b > at[FF_COLLIDER_FOOT_R].b);
            for (int k = 0; k < FF_COLLIDER_COUNT; ++k)
                FF_ASSERT_BELOW(ff_length2(ff_v2((double)(at[k].a - root->a), (double)(at[k].b - root->b))),
                                a->record.coarse_radius);
        }
        FF_ASSERT_NEAR(a->colliders[0][FF_COLLIDER_ROOT].a, a->record.root_start[0], 1e-6);
        FF_ASSERT_NEAR(a->colliders[n - 1][FF_COLLIDER_ROOT].b, a->record.root_end[1], 1e-6);
        assert_in_range((int)(100 * a->record.coarse_radius), 35, 75);
    }
    cut_free(&c);
}

static void half_of_the_walking_steps_are_long(void **state)
{
    (void)state;
    cut slow = cut_generated("walk-slow", false, -1), fast = cut_generated("walk-brisk", false, -1);
    cut still = cut_generated("idle", false, -1);
    ff_actions *sets[3] = {&slow.actions, &still.actions, &fast.actions};
    ff_error error;
    FF_ASSERT_OK(ff_actions_split_walks(sets, 3, &error), error);
    int brief = 0, all = 0;
    for (int i = 0; i < 3; i += 2)
        for (int k = 0; k < sets[i]->count; ++k, ++all)
            brief += sets[i]->items[k].record.mode == FF_MODE_WALK_SHORT;
    assert_true(abs(2 * brief - all) <= 2);
    for (int k = 0; k < slow.actions.count; ++k)
        assert_int_equal(slow.actions.items[k].record.mode, FF_MODE_WALK_SHORT);
    assert_int_equal(still.actions.items[0].record.mode, FF_MODE_IDLE);
    cut_free(&slow);
    cut_free(&fast);
    cut_free(&still);
}

static void one_who_stands_gives_half_a_second_of_idling(void **state)
{
    (void)state;
    cut c = cut_generated("idle", false, -1);
    assert_int_equal(c.actions.count, 1);
    const ff_pack_action *r = &c.actions.items[0].record;
    assert_int_equal(r->mode, FF_MODE_IDLE);
    FF_ASSERT_NEAR(r->duration, 0.5, 1e-6);
    FF_ASSERT_NEAR(r->energy, 2.23 * 0.5, 0.01);
    assert_int_equal(r->flags & FF_ACTION_ALPHA_UNDEFINED, FF_ACTION_ALPHA_UNDEFINED);
    cut_free(&c);
}

/* Cut the clip's motion again, after a change. */
static void cut_again(cut *c)
{
    ff_error error;
    ff_actions_free(&c->actions);
    FF_ASSERT_OK(ff_actions_cut(&standard()->cut, &c->rig, &c->motion, &c->plants, -1, &c->actions, &error),
                 error);
}

static bool is_rejected(const cut *c, const char *why)
{
    for (int i = 0; i < c->actions.rejection_count; ++i)
        if (strstr(c->actions.rejections[i].reason, why)) return true;
    return false;
}

static void who_sits_still_does_not_stand(void **state)
{
    (void)state;
    cut c = cut_generated("idle", false, -1);
    for (int k = 0; k < c.motion.frame_count; ++k)
        c.motion.hips[k].z *= 0.6;
    cut_again(&c);
    assert_int_equal(c.actions.count, 0);
    assert_true(is_rejected(&c, "no standing"));
    cut_free(&c);
}

/* As where the markers of an ankle were mixed up: the plants say that the foot is down, its pose that it is not. */
static void a_step_onto_a_foot_in_the_air_is_none(void **state)
{
    (void)state;
    cut c = cut_generated("walk-normal", false, -1);
    int before = c.actions.count, frame = c.actions.items[3].last_frame;
    uint32_t swing = c.actions.items[3].record.swing;
    ff_quat *hip =
        &c.motion.rotations[frame * FF_ROLE_JOINT_COUNT + (swing == FF_LEFT ? FF_ROLE_HIP_L : FF_ROLE_HIP_R)];
    *hip = ff_quat_mul(ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -0.6), *hip);
    cut_again(&c);
    assert_int_equal(c.actions.count, before - 2); /* it, and the next one, which stands on that foot */
    assert_true(is_rejected(&c, "over the ground"));
    cut_free(&c);
}

/* How far a foot of one frame is over lying flat, m: the ball's or the heel's height, whichever is more. */
static double over_flat(const cut *c, int foot, int frame)
{
    ff_vec3 at[FF_BODY_COUNT], rest[FF_BODY_COUNT];
    int ball = foot == FF_LEFT ? FF_ROLE_BALL_L : FF_ROLE_BALL_R, heel = FF_BODY_HEEL_L + foot;
    ff_motion_pose(&c->rig, &c->motion, frame, at, NULL);
    ff_rig_rest_pose(&c->rig, rest);
    return ff_max(at[ball].y - rest[ball].y, at[heel].y - rest[heel].y);
}

static void a_walking_step_ends_as_its_foot_is_down_in_the_motion(void **state)
{
    (void)state;
    const char *names[] = {"walk-normal", "walk-creep", "walk-brisk", "back-slow", "back"};
    for (size_t k = 0; k < sizeof names / sizeof names[0]; ++k) {
        cut c = cut_generated(names[k], false, -1);
        int checked = 0;
        for (int i = 0; i < c.actions.count; ++i) {
            const ff_action *action = &c.actions.items[i];
            if (action->record.mode > FF_MODE_WALK_LONG || action->record.flags & FF_ACTION_TO_STANDING)
                continue;
            int foot = (int)action->record.swing, frame = action->last_frame;
            FF_ASSERT_BELOW(over_flat(&c, foot, frame), 0.0101);
            assert_true(over_flat(&c, foot, frame - 3) > 0.003); /* 25 ms before */
            ++checked;
        }
        assert_true(checked >= 4);
        cut_free(&c);
    }
}

static void a_clip_tagged_as_a_jump_stays_whole(void **state)
{
    (void)state;
    cut c = cut_generated("walk-normal", false, FF_MODE_JUMP);
    assert_int_equal(c.actions.count, 1);
    assert_int_equal(c.actions.items[0].record.mode, FF_MODE_JUMP);
    cut_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_of_known_paths),
        cmocka_unit_test(a_walk_is_tiled_by_alternating_steps),
        cmocka_unit_test(every_frame_is_in_an_action_or_in_a_rejection),
        cmocka_unit_test(chained_steps_land_where_the_walk_went),
        cmocka_unit_test(signs_of_turns_and_side_steps),
        cmocka_unit_test(mirroring_twice_is_nothing),
        cmocka_unit_test(a_mirrored_action_is_the_action_of_the_mirrored_clip),
        cmocka_unit_test(colliders_follow_the_body_at_20_hz),
        cmocka_unit_test(half_of_the_walking_steps_are_long),
        cmocka_unit_test(one_who_stands_gives_half_a_second_of_idling),
        cmocka_unit_test(who_sits_still_does_not_stand),
        cmocka_unit_test(a_step_onto_a_foot_in_the_air_is_none),
        cmocka_unit_test(a_walking_step_ends_as_its_foot_is_down_in_the_motion),
        cmocka_unit_test(a_clip_tagged_as_a_jump_stays_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
