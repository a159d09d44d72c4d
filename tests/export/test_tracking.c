/* What is asked for is what is walked, over a grid of all that the examples can do: measured from poses and plants. */
#define _GNU_SOURCE /* readlink */
#include "tests/export/built_in_walk.h"

#define HZ 60
#define SETTLE 4.0 /* s */
#define CYCLES 5

/* Over whole gait cycles after the settling: how the hips move in the body's frame, how the pelvis turns, and where the left
 * foot is put. */
typedef struct tracked {
    ff_rates hips;
    ff_vec2 stride; /* m/s, of the left foot's footprints */
    double seconds;
} tracked;

static bool track(const built_in *all, ff_rates wanted, tracked *out)
{
    built_in_walker w;
    ff_quat rotations[FF_JOINT_COUNT];
    ff_vec3 hips, last = {0.0, 0.0, 0.0};
    ff_vec2 first_print = {0.0, 0.0};
    ff_rates sum = {0.0, 0.0, 0.0};
    double pelvis = 0.0;
    int cycles = -1, frames = 0;
    bool planted = true;
    built_in_begin(all, &w, 3);
    for (int k = 0; k < 20 * HZ && cycles < CYCLES; ++k) {
        built_in_go(&w, wanted, 1.0 / HZ);
        built_in_pose(&w, &hips, rotations);
        double yaw = ff_quat_heading(rotations[FF_JOINT_HIPS]);
        bool lands = !planted && w.gait.foot[0].planted;
        planted = w.gait.foot[0].planted != 0;
        if (cycles >= 0) {
            double middle = w.heading - 0.5 * w.rates.turn / HZ;
            ff_vec2 moved = ff_to_frame2(ff_fwd2(middle), ff_plane(ff_sub3(hips, last)));
            sum.forward += moved.a;
            sum.left += moved.b;
            sum.turn += ff_wrap(yaw - pelvis);
            ++frames;
        }
        last = hips;
        pelvis = yaw;
        if (!lands || k < SETTLE * HZ) continue;
        ff_vec2 print = ff_v2(w.gait.foot[0].lock.a, w.gait.foot[0].lock.b);
        if (++cycles == 0) first_print = print;
        out->seconds = ff_max((double)frames / HZ, 1e-9);
        out->stride = ff_scale2(ff_sub2(print, first_print), 1.0 / out->seconds);
    }
    out->hips = (ff_rates){sum.forward / out->seconds, sum.left / out->seconds, sum.turn / out->seconds};
    return cycles == CYCLES;
}

static bool inside(const ff_blend_space *space, ff_rates r)
{
    ff_rates c = ff_blend_clamp(space, r);
    return fabs(c.forward - r.forward) + fabs(c.left - r.left) + fabs(c.turn - r.turn) < 1e-9;
}

static void bodies_move_at_the_rates_asked_for(void **state)
{
    const built_in *all = *state;
    int count = 0;
    for (int f = -4; f <= 9; ++f)
        for (int l = -3; l <= 3; ++l)
            for (int t = -4; t <= 4; ++t) {
                ff_rates wanted = {0.2 * f, 0.2 * l, 0.4 * t};
                tracked got;
                double size = ff_length3(ff_blend_point(wanted));
                if (size < 0.25 || !inside(all->space, wanted)) continue; /* nearly a stand has no cycles */
                if (!track(all, wanted, &got))
                    print_error("%.1f %.1f %.1f\n", wanted.forward, wanted.left, wanted.turn);
                FF_ASSERT_NEAR(got.hips.forward, wanted.forward, ff_max(0.01 * fabs(wanted.forward), 0.005));
                FF_ASSERT_NEAR(got.hips.left, wanted.left, 0.03);
                FF_ASSERT_NEAR(got.hips.turn / FF_DEG, wanted.turn / FF_DEG, 1.0);
                ++count;
            }
    assert_in_range(count, 60, 600);
}

/* Without turning, footprints advance as the body does, or it would limp or slide. */
static void footprints_advance_with_the_body(void **state)
{
    const built_in *all = *state;
    static const ff_rates ways[] = {{0.5, 0.0, 0.0}, {1.3, 0.0, 0.0},  {1.7, 0.0, 0.0}, {-0.6, 0.0, 0.0},
                                    {0.0, 0.4, 0.0}, {0.0, -0.6, 0.0}, {0.8, 0.3, 0.0}};
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; ++i) {
        tracked got;
        assert_true(track(all, ways[i], &got));
        FF_ASSERT_NEAR(got.stride.a, ways[i].forward, 0.01 * fabs(ways[i].forward) + 0.005);
        FF_ASSERT_NEAR(got.stride.b, ways[i].left, 0.03);
    }
}

/* The whole chain, through the public interface: who likes a speed walks at it. */
static void agents_walk_at_their_preferred_speeds(void **state)
{
    const built_in *all = *state;
    for (double speed = 0.4; speed < 1.7; speed += 0.2) {
        ff_error error;
        ff_crowd *crowd;
        ff_agent agent;
        ff_crowd_def def = ff_crowd_def_default();
        def.max_agents = 1;
        FF_ASSERT_OK(ff_crowd_create(all->pack, &def, &crowd, &error), error);
        ff_agent_def person = ff_agent_def_default();
        person.goal = ff_v2(100.0, 0.0);
        person.preferred_speed = speed;
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &person, &agent, &error), error);
        ff_vec3 hips[2];
        ff_quat rotations[FF_JOINT_COUNT];
        for (int half = 0; half < 2; ++half) {
            for (int k = 0; k < (half ? 600 : 120); ++k)
                ff_crowd_step(crowd);
            FF_ASSERT_OK(ff_crowd_agent_pose(crowd, agent, &hips[half], rotations, &error), error);
        }
        FF_ASSERT_NEAR((hips[1].z - hips[0].z) / 20.0, speed, 0.01 * speed + 0.002);
        FF_ASSERT_NEAR((hips[1].x - hips[0].x) / 20.0, 0.0, 0.01);
        ff_crowd_destroy(crowd);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_move_at_the_rates_asked_for),
        cmocka_unit_test(footprints_advance_with_the_body),
        cmocka_unit_test(agents_walk_at_their_preferred_speeds),
    };
    return cmocka_run_group_tests(tests, built_in_open, built_in_close);
}
