/* The difference of two motions at a switch: all of it at first, continuous in place and speed, gone at the end. */
#include "runtime/core/pose/pose_offset.h"
#include "tests/check.h"

#define H (1.0 / 240.0)

/* A motion with made-up curves, which are known at any time. */
static ff_pose_targets motion(double which, double time)
{
    ff_pose_targets pose;
    pose.hips =
        ff_v3(0.05 * which * ff_sin(2.0 * time + which), 0.02 * which, 0.9 + 0.02 * ff_sin(time * which));
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        ff_vec3 axis = ff_unit3(ff_v3(ff_sin(j + which), ff_cos(2.0 * j), 1.0));
        pose.turn[j] = ff_quat_axis(axis, 0.4 * ff_sin(3.0 * time + j * which));
    }
    for (int f = 0; f < 2; ++f)
        pose.foot[f] = (ff_pose_foot){0.3 * ff_sin(which * time + f), 0.1 - 0.2 * f, 0.04 * which,
                                      3.1 - 0.1 * which * ff_cos(time), 0.2 * which * time};
    return pose;
}

static ff_pose_targets shown(const ff_pose_offset *offset, double time)
{
    ff_pose_targets pose = motion(2.0, time);
    ff_pose_offset_apply(offset, &pose);
    return pose;
}

/* Largest difference of two poses: m or rad. */
static double apart(const ff_pose_targets *p, const ff_pose_targets *q)
{
    double most = ff_length3(ff_sub3(p->hips, q->hips));
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        most = ff_max(most, ff_quat_angle(ff_quat_mul(p->turn[j], ff_quat_conj(q->turn[j]))));
    for (int f = 0; f < 2; ++f) {
        const ff_pose_foot *a = &p->foot[f], *b = &q->foot[f];
        most = ff_max(most, fabs(a->forward - b->forward));
        most = ff_max(most, fabs(a->left - b->left));
        most = ff_max(most, fabs(a->height - b->height));
        most = ff_max(most, fabs(ff_wrap(a->yaw - b->yaw)));
        most = ff_max(most, fabs(ff_wrap(a->pitch - b->pitch)));
    }
    return most;
}

static void begin(ff_pose_offset *offset, const ff_pose_targets *old, const ff_pose_targets *old_later,
                  const ff_pose_targets *new, const ff_pose_targets *new_later)
{
    ff_pose_switch change = {old, old_later, new, new_later, H, {1.0, 1.0}, {false, false}};
    ff_pose_offset_begin(offset, &change);
}

static ff_pose_offset switched(void)
{
    ff_pose_targets from = motion(1.0, 0.0), from_later = motion(1.0, H);
    ff_pose_targets to = motion(2.0, 0.0), to_later = motion(2.0, H);
    ff_pose_offset offset;
    begin(&offset, &from, &from_later, &to, &to_later);
    return offset;
}

static void at_the_switch_the_old_pose_is_shown(void **state)
{
    (void)state;
    ff_pose_offset offset = switched();
    ff_pose_targets old = motion(1.0, 0.0), now = shown(&offset, 0.0);
    FF_ASSERT_BELOW(apart(&old, &now), 1e-6);
}

static void just_after_it_the_pose_goes_on_at_the_old_speed(void **state)
{
    (void)state;
    for (int i = 1; i <= 4; ++i) {
        ff_pose_offset offset = switched();
        double t = 0.25 * H * i;
        ff_pose_offset_advance(&offset, t);
        ff_pose_targets old = motion(1.0, t), now = shown(&offset, t);
        /* What is left over is of second order: half an acceleration of at most 250 per s2, times t squared. */
        FF_ASSERT_BELOW(apart(&old, &now), 125.0 * t * t + 250.0 * H * t + 1e-6);
        ff_pose_targets still = motion(1.0, 0.0);
        if (i == 4) assert_true(apart(&old, &now) < 0.2 * apart(&old, &still));
    }
}

static void one_number_follows_the_closed_form(void **state)
{
    (void)state;
    ff_pose_targets from = motion(1.0, 0.0), from_later = from, to = from, to_later = from;
    from.hips.x += 0.08;
    from_later.hips.x += 0.08 + 0.6 * H;
    ff_pose_offset offset;
    begin(&offset, &from, &from_later, &to, &to_later);
    const double T = FF_POSE_OFFSET_TIME;
    for (int i = 0; i < 30; ++i) {
        double t = i * 0.01, s = t / T;
        double want = 0.08 * (2 * s * s * s - 3 * s * s + 1) + 0.6 * T * (s * s * s - 2 * s * s + s);
        FF_ASSERT_NEAR(ff_pose_offset_hips(&offset).x, want, 1e-7);
        ff_pose_offset_advance(&offset, 0.01);
    }
}

static void it_ends_in_the_new_motion_without_a_jump(void **state)
{
    (void)state;
    ff_pose_offset offset = switched();
    double last = 1e9, t = 0.0;
    for (int i = 0; i < 3000; ++i, t += 1e-4) {
        ff_pose_targets now = shown(&offset, t), new = motion(2.0, t);
        double off = apart(&now, &new);
        if (t > 0.29) FF_ASSERT_BELOW(off, last + 1e-6);
        last = off;
        ff_pose_offset_advance(&offset, 1e-4);
    }
    FF_ASSERT_BELOW(last, 1e-5);
    ff_pose_offset_advance(&offset, 1e-3);
    static const ff_pose_offset nothing;
    assert_false(ff_pose_offset_active(&offset));
    assert_memory_equal(&offset, &nothing, sizeof nothing);
}

static void a_second_switch_in_between_is_as_smooth(void **state)
{
    (void)state;
    ff_pose_offset offset = switched(), later = offset;
    ff_pose_offset_advance(&offset, 0.1);
    ff_pose_offset_advance(&later, 0.1 + H);
    ff_pose_targets old = shown(&offset, 0.1), old_later = shown(&later, 0.1 + H);
    ff_pose_targets to = motion(3.0, 0.1), to_later = motion(3.0, 0.1 + H);
    begin(&offset, &old, &old_later, &to, &to_later);
    ff_pose_offset_apply(&offset, &to);
    FF_ASSERT_BELOW(apart(&to, &old), 1e-6);
    ff_pose_offset_advance(&offset, H);
    ff_pose_offset_apply(&offset, &to_later);
    FF_ASSERT_BELOW(apart(&to_later, &old_later), 2e-3);
}

static void a_foot_that_lands_soon_has_lost_its_offset_by_then(void **state)
{
    (void)state;
    ff_pose_targets from = motion(1.0, 0.0), from_later = motion(1.0, H);
    ff_pose_targets to = motion(2.0, 0.0), to_later = motion(2.0, H);
    ff_pose_switch change = {&from, &from_later, &to, &to_later, H, {0.1, 0.0}, {false, false}};
    ff_pose_offset offset;
    ff_pose_offset_begin(&offset, &change);
    for (int i = 0; i <= 10; ++i) {
        ff_pose_foot left = ff_pose_offset_foot(&offset, 0), right = ff_pose_offset_foot(&offset, 1);
        double most = ff_max(fabs(left.height), fabs(left.yaw)), other = fabs(right.height);
        assert_true(i == 0 ? most > 0.03 && other > 0.03 : i < 10 || most < 1e-6);
        if (i >= 2) FF_ASSERT_BELOW(other, 1e-6);
        ff_pose_offset_advance(&offset, 0.01);
    }
    assert_true(ff_pose_offset_active(&offset));
    assert_true(ff_length3(ff_pose_offset_hips(&offset)) > 1e-3);
}

/* However fast it came down: with the speed it would have gone 2 cm into the floor, or up again. */
static void a_foot_that_stands_neither_rises_nor_sinks_meanwhile(void **state)
{
    (void)state;
    const double speeds[] = {-2.0, -0.4, 0.0, 0.4, 2.0}, heights[] = {-0.02, 0.0, 0.03};
    for (int i = 0; i < 15; ++i) {
        ff_pose_targets to = motion(2.0, 0.0), to_later = to, from = to, from_later = to;
        double height = heights[i / 5], speed = speeds[i % 5];
        from.foot[0].height += height, from_later.foot[0].height += height + speed * H;
        from.foot[0].pitch += height, from_later.foot[0].pitch += height - speed * H;
        from.foot[1] = from.foot[0], from_later.foot[1] = from_later.foot[0]; /* this one does not stand */
        ff_pose_switch change = {&from, &from_later, &to, &to_later, H, {1.0, 1.0}, {true, false}};
        ff_pose_offset offset;
        ff_pose_offset_begin(&offset, &change);
        double before[2] = {fabs(height), fabs(height)};
        for (int k = 0; k < 300; ++k) {
            ff_pose_foot left = ff_pose_offset_foot(&offset, 0), right = ff_pose_offset_foot(&offset, 1);
            const double now[2] = {left.height, left.pitch};
            for (int n = 0; n < 2; ++n) {
                assert_true(now[n] * height >= -1e-12);
                FF_ASSERT_BELOW(fabs(now[n]), before[n] + 1e-8);
                before[n] = fabs(now[n]);
            }
            if (k == 100 && fabs(speed) > 1.0) assert_true(fabs(right.height) > 0.05);
            ff_pose_offset_advance(&offset, 0.001);
        }
    }
}

/* The left elbow is 1.5 rad from where it shall be, and the new motion itself turns it at `speed` (rad/s). */
static ff_quat elbow_of(double speed, double time)
{
    return ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -speed * time);
}

static ff_pose_offset elbow_to_go(double speed)
{
    enum { ELBOW = FF_JOINT_ELBOW_L };
    ff_pose_targets from = motion(1.0, 0.0), from_later = from, to = from, to_later = from;
    to.turn[ELBOW] = elbow_of(speed, 0.0);
    to_later.turn[ELBOW] = elbow_of(speed, H);
    from.turn[ELBOW] = from_later.turn[ELBOW] = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), 1.5);
    ff_pose_offset offset;
    begin(&offset, &from, &from_later, &to, &to_later);
    return offset;
}

/* How long it lasts (s), and the fastest that the elbow is turned (rad/s). */
static double fade_elbow(double speed, double most, double *fastest)
{
    enum { ARM = 1 };
    assert_int_equal(ff_arm_joints[ARM], FF_JOINT_ELBOW_L);
    ff_pose_offset offset = elbow_to_go(speed);
    ff_quat last = ff_pose_offset_turn(&offset, FF_JOINT_ELBOW_L, elbow_of(speed, 0.0));
    double time = 0.0;
    for (*fastest = 0.0; ff_pose_offset_active(&offset) && time < 10.0; time += H) {
        ff_pose_offset_advance(&offset, H);
        ff_quat before = elbow_of(speed, time), now = elbow_of(speed, time + H);
        if (ff_pose_offset_active(&offset)) ff_pose_offset_hold(&offset, ARM, before, now, most * H, H);
        ff_quat shown = ff_pose_offset_turn(&offset, FF_JOINT_ELBOW_L, now);
        *fastest = ff_max(*fastest, ff_quat_angle(ff_quat_mul(ff_quat_conj(last), shown)) / H);
        for (int arm = 0; arm < FF_ARM_JOINTS; ++arm)
            if (arm != ARM) assert_true(offset.late[arm] == 0.0f);
        last = shown;
    }
    return time;
}

static void an_arm_takes_its_time_and_is_turned_no_faster_than_it_may(void **state)
{
    (void)state;
    double fastest, free = fade_elbow(2.0, 1e3, &fastest);
    FF_ASSERT_NEAR(free, FF_POSE_OFFSET_TIME, 2.0 * H);
    assert_true(fastest > 7.0);
    double slow = fade_elbow(2.0, 5.0, &fastest);
    FF_ASSERT_BELOW(fastest, 5.0 * 1.01); /* within a step the fade counts as a straight line */
    assert_true(fastest > 4.9 && slow > free + 0.1);
    FF_ASSERT_BELOW(slow, 1.0); /* 1.5 rad at the 3 rad/s that are left, and its ends */
}

static void what_fades_against_the_motion_is_not_waited_for(void **state)
{
    (void)state;
    /* The motion bends the elbow faster than it may, and the fade stretches it: to wait would make it worse. */
    double fastest, time = fade_elbow(-9.0, 8.0, &fastest);
    FF_ASSERT_NEAR(time, FF_POSE_OFFSET_TIME, 2.0 * H);
    FF_ASSERT_BELOW(fastest, 9.0 + 1e-6);
}

static void the_speed_of_a_fade_is_that_of_its_turn(void **state)
{
    (void)state;
    ff_pose_offset offset = elbow_to_go(2.0);
    for (int i = 0; i < 80; ++i) {
        ff_pose_offset before = offset, after = offset;
        ff_quat none = {0.0, 0.0, 0.0, 1.0};
        before.age -= 1e-5;
        after.age += 1e-5;
        ff_quat p = ff_pose_offset_turn(&before, FF_JOINT_ELBOW_L, none),
                q = ff_pose_offset_turn(&after, FF_JOINT_ELBOW_L, none);
        if (i > 0 && offset.age < FF_POSE_OFFSET_TIME - 1e-5)
            FF_ASSERT_NEAR(ff_pose_offset_speed(&offset, 1),
                           ff_quat_angle(ff_quat_mul(ff_quat_conj(p), q)) / 2e-5, 1e-3);
        if (i == 75) assert_true(ff_pose_offset_speed(&offset, 1) == 0.0);
        ff_pose_offset_advance(&offset, H);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(at_the_switch_the_old_pose_is_shown),
        cmocka_unit_test(just_after_it_the_pose_goes_on_at_the_old_speed),
        cmocka_unit_test(one_number_follows_the_closed_form),
        cmocka_unit_test(it_ends_in_the_new_motion_without_a_jump),
        cmocka_unit_test(a_second_switch_in_between_is_as_smooth),
        cmocka_unit_test(a_foot_that_lands_soon_has_lost_its_offset_by_then),
        cmocka_unit_test(a_foot_that_stands_neither_rises_nor_sinks_meanwhile),
        cmocka_unit_test(an_arm_takes_its_time_and_is_turned_no_faster_than_it_may),
        cmocka_unit_test(what_fades_against_the_motion_is_not_waited_for),
        cmocka_unit_test(the_speed_of_a_fade_is_that_of_its_turn)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
