/* People of different sizes: drawn from the seed, standing on the ground, walking in proportion; all ways to draw them agree. */
#define _GNU_SOURCE
#include "runtime/core/crowd/crowd_state.h"
#include "tests/built_in_open.h"

enum { PEOPLE = 40 };

static ff_crowd *people(double body_scale, uint64_t seed, ff_agent *agents)
{
    ff_error error;
    ff_crowd *crowd;
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = PEOPLE;
    def.seed = seed;
    def.body_scale = body_scale;
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &crowd, &error), error);
    for (int i = 0; i < PEOPLE; ++i) {
        ff_agent_def person = ff_agent_def_default();
        person.position = ff_v2(0.0, 1.2 * i);
        person.goal = ff_v2(20.0, 1.2 * i);
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &person, &agents[i], &error), error);
    }
    return crowd;
}

static double scale_of(const ff_crowd *crowd, ff_agent agent)
{
    ff_error error;
    ff_agent_state state;
    FF_ASSERT_OK(ff_crowd_agent_state(crowd, agent, &state, &error), error);
    return state.scale;
}

static void sizes_come_from_the_seed_and_stay_within_what_is_asked(void **state)
{
    (void)state;
    ff_agent agents[PEOPLE];
    ff_crowd *one = people(0.08, 1, agents), *same = people(0.08, 1, agents),
             *other = people(0.08, 2, agents);
    ff_crowd *plain = people(0.0, 1, agents);
    double least = 9.0, most = 0.0, mean = 0.0;
    int differ = 0;
    for (int i = 0; i < PEOPLE; ++i) {
        double scale = scale_of(one, agents[i]);
        least = ff_min(least, scale);
        most = ff_max(most, scale);
        mean += scale / PEOPLE;
        assert_true(scale == scale_of(same, agents[i]));
        differ += scale != scale_of(other, agents[i]);
        assert_true(scale_of(plain, agents[i]) == 1.0);
    }
    FF_ASSERT_BELOW(0.92 - 1e-12, least);
    FF_ASSERT_BELOW(most, 1.08 + 1e-12);
    FF_ASSERT_BELOW(0.08, most - least);
    FF_ASSERT_NEAR(mean, 1.0, 0.025);
    assert_in_range(differ, PEOPLE - 2, PEOPLE);
    ff_crowd_destroy(one);
    ff_crowd_destroy(same);
    ff_crowd_destroy(other);
    ff_crowd_destroy(plain);
}

/* Joints of an agent: offsets of the pack times its scale. */
static void place(const ff_crowd *crowd, ff_agent agent, double scale, ff_vec3 *at, ff_quat *world)
{
    ff_error error;
    ff_vec3 hips;
    ff_quat local[FF_JOINT_COUNT];
    FF_ASSERT_OK(ff_crowd_agent_pose(crowd, agent, &hips, local, &error), error);
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        int parent = ff_joint_parents[j];
        world[j] = parent < 0 ? local[j] : ff_quat_mul(world[parent], local[j]);
        ff_vec3 offset = ff_scale3(ff_pack_joint_offset(pack, (uint32_t)j), scale);
        at[j] = parent < 0 ? hips : ff_add3(at[parent], ff_quat_rotate(world[parent], offset));
    }
}

static void people_of_any_size_stand_on_the_ground_and_their_feet_stay_where_they_are(void **state)
{
    (void)state;
    ff_agent agents[PEOPLE];
    ff_crowd *crowd = people(0.15, 3, agents);
    static ff_vec3 last[PEOPLE][2];
    static bool stood[PEOPLE][2];
    ff_error error;
    double rest = crowd->space->body.ball_rest;
    for (int k = 0; k < 240; ++k) {
        for (int i = 0; i < PEOPLE; ++i) {
            ff_vec3 at[FF_JOINT_COUNT];
            ff_quat world[FF_JOINT_COUNT];
            ff_agent_state now;
            FF_ASSERT_OK(ff_crowd_agent_state(crowd, agents[i], &now, &error), error);
            place(crowd, agents[i], now.scale, at, world);
            if (k == 0) FF_ASSERT_NEAR(at[FF_JOINT_BALL_L].y, rest * now.scale, 1e-3);
            FF_ASSERT_NEAR(at[FF_JOINT_HIPS].y / now.scale, ff_pack_joint_offset(pack, 0).y, 0.12);
            for (int foot = 0; foot < 2; ++foot) {
                ff_vec3 ball = at[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE];
                if (now.planted[foot] && stood[i][foot])
                    FF_ASSERT_BELOW(ff_length2(ff_plane(ff_sub3(ball, last[i][foot]))), 1e-3);
                last[i][foot] = ball;
                stood[i][foot] = now.planted[foot] != 0;
            }
        }
        ff_crowd_step(crowd);
    }
    ff_crowd_destroy(crowd);
}

static void matrices_are_those_of_the_pose_with_the_size_in_them(void **state)
{
    (void)state;
    ff_agent agents[PEOPLE];
    ff_error error;
    ff_crowd *crowd = people(0.1, 4, agents);
    for (int k = 0; k < 40; ++k)
        ff_crowd_step(crowd);
    for (int i = 0; i < PEOPLE; i += 7) {
        double scale = scale_of(crowd, agents[i]);
        ff_vec3 at[FF_JOINT_COUNT];
        ff_quat world[FF_JOINT_COUNT];
        ff_matrix matrices[FF_JOINT_COUNT];
        place(crowd, agents[i], scale, at, world);
        FF_ASSERT_OK(ff_crowd_agent_matrices(crowd, agents[i], ff_v2(0.0, 0.0), matrices, &error), error);
        for (int j = 0; j < FF_JOINT_COUNT; ++j) {
            ff_vec3 v = {0.02, -0.1, 0.05},
                    want = ff_add3(at[j], ff_quat_rotate(world[j], ff_scale3(v, scale)));
            float(*m)[4] = matrices[j].row;
            const double got[3] = {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z + m[0][3],
                                   m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z + m[1][3],
                                   m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z + m[2][3]};
            FF_ASSERT_NEAR(got[0], want.x, 1e-4);
            FF_ASSERT_NEAR(got[1], want.y, 1e-4);
            FF_ASSERT_NEAR(got[2], want.z, 1e-4);
        }
    }
    ff_crowd_destroy(crowd);
}

static void a_larger_body_does_everything_in_proportion(void **state)
{
    (void)state;
    ff_error error;
    ff_blend_space *space;
    FF_ASSERT_OK(ff_blend_space_create(pack, &space, &error), error);
    static ff_gait small, large;
    const double size = 1.25;
    ff_vec2 p = {3.0, -2.0};
    double heading = 0.7;
    ff_gait_init(space, &small, p, heading, 9);
    ff_gait_init(space, &large, ff_scale2(p, size), heading, 9);
    ff_gait_set_scale(space, &large, ff_scale2(p, size), heading, size);
    for (int k = 0; k < 300; ++k) {
        ff_rates asked = {1.2, 0.0, 0.4 * sin(k * 0.02)}, twice = {1.2 * size, 0.0, asked.turn};
        ff_rates rates = ff_gait_clamp(space, &small, asked), other = ff_gait_clamp(space, &large, twice);
        FF_ASSERT_NEAR(other.forward, size * rates.forward, 1e-9);
        heading += rates.turn / 60.0;
        p = ff_madd2(p, ff_fwd2(heading), rates.forward / 60.0);
        ff_gait_step(space, &small, p, heading, rates, 1.0 / 60.0);
        ff_gait_step(space, &large, ff_scale2(p, size), heading, other, 1.0 / 60.0);
        ff_vec3 hips, hips_large;
        ff_quat turn[FF_JOINT_COUNT], turn_large[FF_JOINT_COUNT];
        ff_gait_pose(space, &small, p, heading, &hips, turn);
        ff_gait_pose(space, &large, ff_scale2(p, size), heading, &hips_large, turn_large);
        FF_ASSERT_BELOW(ff_length3(ff_sub3(ff_scale3(hips, size), hips_large)), 1e-6);
        for (int j = 0; j < FF_JOINT_COUNT; ++j)
            FF_ASSERT_BELOW(1.0 - fabs(ff_quat_dot(turn[j], turn_large[j])), 1e-9);
    }
    ff_blend_space_destroy(space);
}

static void sizes_out_of_range_are_refused(void **state)
{
    (void)state;
    ff_error error;
    ff_crowd *crowd;
    ff_crowd_def def = ff_crowd_def_default();
    static const double wrong[] = {-0.01, 0.16, NAN};
    for (int i = 0; i < 3; ++i) {
        def.body_scale = wrong[i];
        assert_true(ff_crowd_create(pack, &def, &crowd, &error) != FF_OK);
        assert_non_null(strstr(error.message, "body_scale"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_come_from_the_seed_and_stay_within_what_is_asked),
        cmocka_unit_test(people_of_any_size_stand_on_the_ground_and_their_feet_stay_where_they_are),
        cmocka_unit_test(matrices_are_those_of_the_pose_with_the_size_in_them),
        cmocka_unit_test(a_larger_body_does_everything_in_proportion),
        cmocka_unit_test(sizes_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, open_pack, close_pack);
}
