/* A foot out of reach lifts its heel by the least angle that helps; captured persons' postures are levelled, limbs are not. */
#include "runtime/core/base/random.h"
#include "runtime/core/gait/gait_hips.h"
#include "runtime/core/gait/leg_pose.h"
#include "runtime/core/pose/posture.h"
#include "tests/core/walker_space.h"

static double distance_raised(const ff_body_frame *body, ff_foothold ball, ff_vec3 hip, double raise)
{
    ff_vec3 lateral = ff_v3(ff_cos(ball.yaw), 0.0, -ff_sin(ball.yaw));
    ff_quat turn = ff_quat_mul(ff_quat_axis(lateral, raise), ff_gait_foot_rotation(ball.yaw, 0.0));
    return ff_length3(ff_sub3(ff_gait_ankle(body, 0, ball, turn), hip));
}

/* The left leg under hips, its foot flat on the ground at ball; the right one hangs. */
static ff_leg pose_left(const ff_body_frame *body, ff_vec3 hips, ff_foothold ball, ff_quat turn, double most)
{
    ff_quat rotations[FF_JOINT_COUNT];
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        rotations[j] = FF_QUAT_IDENTITY;
    ff_legs legs;
    ff_legs_of_clip(body, hips, rotations, &legs);
    ff_vec3 right = ff_pair3_half(legs.ankle, 1);
    ff_foothold hanging = {right.z, right.x, right.y, 0.0};
    ff_leg_target targets[2] = {{ball, turn, 0.0, most, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0},
                                {hanging, FF_QUAT_IDENTITY, 0.0, most, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}};
    ff_legs_pose(body, targets, &legs, rotations);
    return (ff_leg){.hip = ff_pair3_half(legs.hip, 0), .foot = ff_pairq_half(legs.foot, 0)};
}

/* Against raising the heel by hundredths of a degree until it helps. */
static void the_heel_is_raised_as_little_as_brings_the_ankle_in_reach(void **state)
{
    const ff_walker_space *walker = *state;
    const ff_body_frame *body = &walker->space->body;
    ff_random random = {7, 1, 0};
    const double most = 60.0 * FF_DEG, reach = FF_LEG_REACH * (body->thigh[0] + body->shank[0]);
    int raised = 0;
    for (int i = 0; i < 300; ++i) {
        ff_vec3 hips = ff_v3(0.0, ff_random_range(&random, 0.85, 0.95), ff_random_range(&random, -0.1, 0.45));
        ff_vec3 hip = ff_add3(hips, body->offset[FF_JOINT_HIP_L]);
        ff_foothold ball = {0.0, hip.x, body->ball_rest, ff_random_range(&random, -0.5, 0.5)};
        double least = 0.0;
        while (least < most && distance_raised(body, ball, hip, least) > reach)
            least += 0.01 * FF_DEG;
        if (least >= most) continue; /* nothing helps */
        ff_quat flat = ff_gait_foot_rotation(ball.yaw, 0.0);
        ff_leg posed = pose_left(body, hips, ball, flat, most);
        FF_ASSERT_NEAR(ff_quat_angle(ff_quat_mul(ff_quat_conj(flat), posed.foot)), least, 0.011 * FF_DEG);
        raised += least > 0.0;
    }
    assert_true(raised > 30);
}

/* A leg that is too short for any heel raises it as far as that brings it nearer, but for a hundredth of the foot, and never
 * past the hip. */
static void a_heel_that_does_not_help_is_not_thrown_over(void **state)
{
    const ff_walker_space *walker = *state;
    const ff_body_frame *body = &walker->space->body;
    ff_foothold ball = {0.0, body->offset[FF_JOINT_HIP_L].x, body->ball_rest, 0.0};
    ff_leg leg = pose_left(body, ff_v3(0.0, 0.95, 0.8), ball, ff_gait_foot_rotation(0.0, -0.5), 2.0);
    ff_vec3 centre = ff_v3(ball.b, ball.height, ball.a);
    ff_vec3 ankle = ff_sub3(ff_gait_ankle(body, 0, ball, leg.foot), centre), hip = ff_sub3(leg.hip, centre);
    assert_true(ff_atan2(ankle.z, ankle.y) < ff_atan2(hip.z, hip.y));
    double nearest = ff_length3(hip) - ff_length3(ankle);
    FF_ASSERT_BELOW(ff_length3(ff_sub3(hip, ankle)) - nearest, 0.03 * ff_length3(ankle));
}

static ff_quat world(const ff_quat *local, int joint)
{
    ff_quat turn = FF_QUAT_IDENTITY;
    for (int j = joint; j >= 0; j = ff_joint_parents[j])
        turn = ff_quat_mul(local[j], turn);
    return turn;
}

static ff_quat somehow(ff_random *random, double size)
{
    double x = ff_random_range(random, -size, size), y = ff_random_range(random, -size, size);
    return ff_quat_exp(ff_v3(x, y, ff_random_range(random, -size, size)));
}

static void levelled_postures_have_the_means_wanted_and_limbs_as_they_were(void **state)
{
    (void)state;
    ff_random random = {8, 1, 0};
    static const int limbs[2] = {FF_JOINT_HIP_L, FF_JOINT_HIP_R};
    for (int i = 0; i < 200; ++i) {
        ff_posture own, common;
        ff_quat pose[FF_JOINT_COUNT], level[FF_JOINT_COUNT];
        for (int j = 0; j < FF_JOINT_COUNT; ++j) {
            own.mean[j] = somehow(&random, 0.3);
            common.mean[j] = somehow(&random, 0.3);
            pose[j] = level[j] = own.mean[j];
        }
        ff_posture_level(&own, &common, level);
        for (int side = 0; side < 2; ++side) {
            int clavicle = side == 0 ? FF_JOINT_CLAVICLE_L : FF_JOINT_CLAVICLE_R;
            FF_ASSERT_BELOW(ff_quat_angle(ff_quat_mul(ff_quat_conj(common.mean[clavicle]), level[clavicle])),
                            1e-6);
            ff_quat before = ff_quat_mul(pose[clavicle], pose[clavicle + 1]);
            ff_quat after = ff_quat_mul(level[clavicle], level[clavicle + 1]);
            FF_ASSERT_BELOW(ff_quat_angle(ff_quat_mul(ff_quat_conj(before), after)), 1e-6);
            ff_quat turn = ff_quat_mul(ff_quat_conj(world(pose, limbs[side])), world(level, limbs[side]));
            FF_ASSERT_BELOW(ff_quat_angle(turn), 1e-6);
        }
        for (int j = FF_JOINT_HIPS; j <= FF_JOINT_HEAD; ++j) {
            ff_vec3 held = ff_quat_log(level[j]), wanted = ff_quat_log(common.mean[j]);
            FF_ASSERT_NEAR(held.x, wanted.x, 1e-6);
            if (j != FF_JOINT_HIPS) FF_ASSERT_NEAR(held.z, 0.0, 1e-6);
        }
    }
}

static int set_up(void **state)
{
    return open_walkers(state, &ff_walker_grid_small);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_heel_is_raised_as_little_as_brings_the_ankle_in_reach),
        cmocka_unit_test(a_heel_that_does_not_help_is_not_thrown_over),
        cmocka_unit_test(levelled_postures_have_the_means_wanted_and_limbs_as_they_were),
    };
    return cmocka_run_group_tests(tests, set_up, close_walkers);
}
