/* Crowds on footsteps: events, obstacles of three kinds, plans that never meet, changing planner, the same bits on any number of
 * threads. */
#define _GNU_SOURCE
#include "runtime/core/base/random.h"
#include "runtime/core/crowd/crowd_state.h"
#include "tests/built_in_open.h"
#include "tests/core/crowd_ask.h"

#define STEP (1.0 / 30.0)
#define AGENTS 16

static ff_crowd_def footsteps_def(uint32_t agents)
{
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = agents;
    def.step = STEP;
    def.planner = FF_PLANNER_FOOTSTEPS;
    return def;
}

static ff_crowd *crowd_of(const ff_crowd_def *def)
{
    ff_crowd *crowd;
    ff_error error;
    FF_ASSERT_OK(ff_crowd_create(pack, def, &crowd, &error), error);
    return crowd;
}

static ff_agent add(ff_crowd *crowd, ff_vec2 from, ff_vec2 to, ff_planner planner)
{
    ff_agent_def def = ff_agent_def_default();
    ff_agent agent;
    ff_error error;
    def.position = from;
    def.goal = to;
    def.heading = ff_atan2(to.b - from.b, to.a - from.a);
    def.planner = planner;
    FF_ASSERT_OK(ff_crowd_add_agent(crowd, &def, &agent, &error), error);
    return agent;
}

/* Everybody from a circle to the other side. */
static void add_circle(ff_crowd *crowd, uint32_t count, double radius, bool mixed, ff_agent *out)
{
    for (uint32_t i = 0; i < count; ++i) {
        ff_vec2 at = ff_scale2(ff_fwd2(FF_TAU * i / count + 0.02 * (i % 3)), radius);
        out[i] = add(crowd, at, ff_scale2(at, -1.0),
                     mixed && i % 2 == 1 ? FF_PLANNER_VELOCITY : FF_PLANNER_FOOTSTEPS);
    }
}

static ff_plan_counts counts_of(const ff_crowd *crowd, ff_agent agent)
{
    ff_plan_counts counts;
    ff_error error;
    FF_ASSERT_OK(ff_crowd_agent_plan_counts(crowd, agent, &counts, &error), error);
    return counts;
}

static void go(ff_crowd *crowd, double seconds)
{
    for (int i = 0; i < (int)(seconds / STEP + 0.5); ++i)
        ff_crowd_step(crowd);
}

/* ------------------------------------------------------------------------------------------------- events */

static void who_is_alone_gets_there_and_makes_plans_when_they_expire(void **state)
{
    (void)state;
    ff_crowd_def def = footsteps_def(1);
    ff_crowd *crowd = crowd_of(&def);
    ff_agent agent = add(crowd, ff_v2(0.0, 0.0), ff_v2(9.0, 2.0), FF_PLANNER_FOOTSTEPS);
    go(crowd, 12.0);
    ff_agent_state at = state_of(crowd, agent);
    ff_plan_counts counts = counts_of(crowd, agent);
    assert_int_equal(at.reached, 1);
    assert_int_equal(at.planner, FF_PLANNER_FOOTSTEPS);
    assert_true(counts.events[FF_EVENT_GOAL] == 1 && counts.events[FF_EVENT_EXPIRY] >= 2);
    assert_true(counts.plans >= 3 && counts.without_plan == 0.0);
    go(crowd, 5.0);
    assert_int_equal(counts_of(crowd, agent).searches, counts.searches); /* who has arrived plans no more */
    ff_crowd_destroy(crowd);
}

static void a_goal_that_moves_is_followed(void **state)
{
    (void)state;
    ff_crowd_def def = footsteps_def(1);
    ff_crowd *crowd = crowd_of(&def);
    ff_error error;
    ff_agent agent = add(crowd, ff_v2(0.0, 0.0), ff_v2(8.0, 0.0), FF_PLANNER_FOOTSTEPS);
    go(crowd, 2.5);
    FF_ASSERT_OK(ff_crowd_set_goal(crowd, agent, ff_v2(2.0, 6.0), &error), error);
    ff_plan_counts before = counts_of(crowd, agent);
    ff_crowd_step(crowd);
    ff_plan_counts after = counts_of(crowd, agent);
    assert_int_equal(after.events[FF_EVENT_GOAL], before.events[FF_EVENT_GOAL] + 1);
    assert_int_equal(after.plans, before.plans + 1);
    go(crowd, 12.0);
    assert_int_equal(state_of(crowd, agent).reached, 1);
    ff_crowd_destroy(crowd);
}

/* Who is there turns to what it shall look at, stays where it is, and then plans no more. */
static void who_has_arrived_turns_to_what_it_shall_look_at(void **state)
{
    (void)state;
    ff_crowd_def def = footsteps_def(1);
    ff_error error;
    for (int i = 0; i < 12; ++i) {
        ff_crowd *crowd = crowd_of(&def);
        ff_agent agent = add(crowd, ff_v2(0.0, 0.0), ff_v2(3.0, 1.0), FF_PLANNER_FOOTSTEPS);
        go(crowd, 5.0);
        assert_int_equal(state_of(crowd, agent).reached, 1);
        ff_vec2 was = state_of(crowd, agent).position,
                to = ff_madd2(was, ff_fwd2(FF_TAU * i / 12.0 + 0.1), i % 2 ? 4.0 : 1.0);
        ff_face face = i % 3 ? FF_FACE_POINT : FF_FACE_HEADING;
        FF_ASSERT_OK(ff_crowd_set_facing(crowd, agent, face, i % 3 ? to : ff_sub2(to, was), &error), error);
        go(crowd, 6.0);
        ff_agent_state at = state_of(crowd, agent);
        ff_vec2 way = i % 3 ? ff_sub2(to, at.position) : ff_sub2(to, was);
        assert_int_equal(at.reached, 1);
        FF_ASSERT_BELOW(fabs(ff_wrap(ff_atan2(way.b, way.a) - at.heading)), 0.36);
        FF_ASSERT_BELOW(ff_length2(ff_sub2(at.position, was)), 0.5);
        uint32_t searches = counts_of(crowd, agent).searches;
        go(crowd, 3.0);
        assert_int_equal(counts_of(crowd, agent).searches, searches);
        ff_crowd_destroy(crowd);
    }
}

static void waypoints_lead_round_a_wall_and_are_left_out_when_the_next_is_seen(void **state)
{
    (void)state;
    ff_crowd_def def = footsteps_def(1);
    ff_crowd *crowd = crowd_of(&def);
    ff_error error;
    FF_ASSERT_OK(ff_crowd_add_wall(crowd, ff_v2(2.0, -4.0), ff_v2(2.0, 3.0), &error), error);
    ff_agent agent = add(crowd, ff_v2(0.0, 0.0), ff_v2(4.0, 0.0), FF_PLANNER_FOOTSTEPS);
    const ff_vec2 way[] = {{0.0, 2.0}, {2.0, 4.2}};
    FF_ASSERT_OK(ff_crowd_set_waypoints(crowd, agent, way, 2, &error), error);
    go(crowd, 16.0);
    assert_int_equal(state_of(crowd, agent).reached, 1);
    assert_int_equal(crowd->steppers[agent.slot].waypoint_next, 2);
    ff_crowd_destroy(crowd);
}

static void an_obstacle_on_a_known_path_is_noticed_and_avoided(void **state)
{
    (void)state;
    ff_crowd_def def = footsteps_def(1);
    ff_crowd *crowd = crowd_of(&def);
    ff_error error;
    ff_agent agent = add(crowd, ff_v2(0.0, 0.0), ff_v2(8.0, 0.0), FF_PLANNER_FOOTSTEPS);
    go(crowd, 2.0);
    ff_obstacle_def block = ff_obstacle_def_default();
    block.kind = FF_OBSTACLE_PATH;
    block.half_length = 0.2;
    block.half_width = 1.0;
    double time = ff_crowd_time(crowd);
    ff_vec2 here = state_of(crowd, agent).position;
    block.path[0] = (ff_obstacle_point){0.0, ff_v2(here.a + 2.2, -2.0)};
    block.path[1] = (ff_obstacle_point){3.0, ff_v2(here.a + 2.2, 2.0)};
    block.path_count = 2;
    block.start = time;
    uint32_t number;
    FF_ASSERT_OK(ff_crowd_add_obstacle(crowd, &block, &number, &error), error);
    double nearest = INFINITY;
    for (int i = 0; i < 300; ++i) {
        ff_vec2 at;
        ff_crowd_step(crowd);
        FF_ASSERT_OK(ff_crowd_obstacle_place(crowd, number, &at, NULL, &error), error);
        ff_vec2 gap = ff_sub2(state_of(crowd, agent).position, at);
        nearest = ff_min(nearest, ff_max(fabs(gap.a) - 0.3, fabs(gap.b) - 1.1));
    }
    assert_true(counts_of(crowd, agent).events[FF_EVENT_NEARBY] >= 1);
    assert_true(nearest > 0.1);
    assert_int_equal(state_of(crowd, agent).reached, 1);
    ff_crowd_destroy(crowd);
}

/* A wall is put, or pushed, into somebody's way; it is never walked through. FF_WALLS in the environment: so many cases. */
static void an_unforeseen_wall_is_noticed_at_once_and_never_walked_through(void **state)
{
    (void)state;
    const char *asked = getenv("FF_WALLS");
    int cases = asked ? atoi(asked) : 24;
    ff_error error;
    double latest = 0.0;
    int through = 0;
    for (int k = 0; k < cases; ++k) {
        ff_random random = {(uint64_t)k, 0x77616c6cu, 0};
        ff_crowd_def def = footsteps_def(1);
        def.seed = (uint64_t)k;
        ff_crowd *crowd = crowd_of(&def);
        ff_agent agent = add(crowd, ff_v2(0.0, 0.0), ff_v2(10.0, 0.0), FF_PLANNER_FOOTSTEPS);
        ff_obstacle_def wall = ff_obstacle_def_default();
        wall.kind = FF_OBSTACLE_FREE;
        wall.position = ff_v2(50.0, 0.0);
        wall.half_length = ff_random_range(&random, 0.8, 2.0);
        wall.radius = 0.05;
        uint32_t number;
        FF_ASSERT_OK(ff_crowd_add_obstacle(crowd, &wall, &number, &error), error);
        go(crowd, ff_random_range(&random, 1.5, 3.5));
        ff_agent_state at = state_of(crowd, agent);
        /* Across the way, at a distance in which a person can come to a stand. */
        double heading = 0.5 * FF_PI + ff_random_range(&random, -0.4, 0.4);
        ff_vec2 place = ff_madd2(at.position, ff_fwd2(at.heading), ff_random_range(&random, 0.9, 2.2));
        double push = k % 2 == 0 ? 0.0 : ff_random_range(&random, 0.0, 0.3); /* m/s, towards the walker */
        double since = ff_crowd_time(crowd), noticed = -1.0;
        bool near = ff_length2(ff_sub2(place, at.position)) < 0.8 * ff_length2(at.velocity);
        ff_vec2 before = at.position;
        for (int i = 0; i < 150; ++i) {
            if (i < 30) place = ff_madd2(place, ff_fwd2(at.heading), -push * STEP);
            FF_ASSERT_OK(ff_crowd_move_obstacle(crowd, number, place, at.heading + heading, &error), error);
            ff_crowd_step(crowd);
            ff_vec2 now = state_of(crowd, agent).position, along = ff_fwd2(at.heading + heading);
            if (noticed < 0.0 && counts_of(crowd, agent).events[FF_EVENT_SURPRISE] > 0)
                noticed = ff_crowd_time(crowd) - since;
            ff_vec2 p = ff_to_frame2(along, ff_sub2(before, place)),
                    q = ff_to_frame2(along, ff_sub2(now, place));
            bool crosses = (p.b > 0.0) != (q.b > 0.0) && fabs(0.5 * (p.a + q.a)) < wall.half_length;
            if (crosses) {
                ++through;
                print_message("case %d went through\n", k);
                break;
            }
            before = now;
        }
        if (push == 0.0 && near) latest = ff_max(latest, noticed < 0.0 ? 9.0 : noticed);
        ff_crowd_destroy(crowd);
    }
    print_message("%d walls, %d walked through; those within a second's way noticed after %.2f s\n", cases,
                  through, latest);
    assert_int_equal(through, 0);
    FF_ASSERT_BELOW(latest, 0.1);
}

/* ------------------------------------------------------------------------------------------------- crowds */

static void plans_in_force_never_meet_and_nobody_is_without_one(void **state)
{
    (void)state;
    ff_crowd_def def = footsteps_def(AGENTS);
    ff_crowd *crowd = crowd_of(&def);
    ff_agent agent[AGENTS];
    add_circle(crowd, AGENTS, 5.0, false, agent);
    for (int i = 0; i < 400; ++i) {
        ff_crowd_step(crowd);
        double time = ff_crowd_time(crowd);
        for (uint32_t p = 0; p < AGENTS && i % 4 == 0; ++p)
            for (uint32_t q = 0; q < p; ++q)
                assert_false(
                    ff_track_conflict(&crowd->steppers[p].track, &crowd->steppers[q].track, time, 0.0, NULL));
    }
    for (uint32_t p = 0; p < AGENTS; ++p)
        assert_true(counts_of(crowd, agent[p]).without_plan == 0.0);
    ff_crowd_destroy(crowd);
}

static void how_long_plans_take_is_known_to_a_twentieth(void **state)
{
    (void)state;
    ff_plan_times times = {{0}};
    assert_true(ff_plan_times_share(&times, 0.5) == 0.0);
    /* 1 to 100 ms, and three that are beyond what is told apart. */
    for (int i = 1; i <= 100; ++i)
        ff_plan_times_add(&times, 1e-3 * i);
    static const double shares[] = {0.01, 0.1, 0.5, 0.9, 0.99, 1.0};
    for (int i = 0; i < 6; ++i)
        FF_ASSERT_NEAR(ff_plan_times_share(&times, shares[i]) / (0.1 * shares[i]), 1.0, 0.05);
    ff_plan_times_add(&times, 0.0);
    ff_plan_times_add(&times, -1.0);
    ff_plan_times_add(&times, 1e9);
    FF_ASSERT_BELOW(ff_plan_times_share(&times, 0.0), 1.1e-6);
    FF_ASSERT_NEAR(ff_plan_times_share(&times, 1.0), 1.0, 0.1);

    ff_crowd_def def = footsteps_def(AGENTS);
    ff_crowd *crowd = crowd_of(&def);
    ff_agent agent[AGENTS];
    add_circle(crowd, AGENTS, 5.0, false, agent);
    assert_true(ff_crowd_plan_seconds(crowd, 0.5) == 0.0);
    go(crowd, 1.0);
    assert_true(ff_crowd_plan_seconds(crowd, 0.5) > 0.0);
    FF_ASSERT_BELOW(ff_crowd_plan_seconds(crowd, 0.5), ff_crowd_plan_seconds(crowd, 0.99) + 1e-12);
    ff_crowd_destroy(crowd);
}

static uint64_t hash_after(uint32_t threads, bool mixed, int steps)
{
    ff_crowd_def def = footsteps_def(AGENTS);
    def.threads = threads;
    ff_crowd *crowd = crowd_of(&def);
    ff_agent agent[AGENTS];
    add_circle(crowd, AGENTS, 5.0, mixed, agent);
    for (int i = 0; i < steps; ++i)
        ff_crowd_step(crowd);
    uint64_t hash = ff_crowd_state_hash(crowd);
    ff_crowd_destroy(crowd);
    return hash;
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    for (int mixed = 0; mixed < 2; ++mixed) {
        uint64_t one = hash_after(1, mixed != 0, 200);
        assert_true(hash_after(2, mixed != 0, 200) == one);
        assert_true(hash_after(8, mixed != 0, 200) == one);
    }
}

static void a_crowd_on_footsteps_is_saved_and_goes_on_to_the_bit(void **state)
{
    (void)state;
    ff_crowd_def def = footsteps_def(AGENTS);
    def.footsteps.speed_variations[0] = 0.8;
    def.footsteps.speed_variations[3] = 1.2;
    ff_crowd *crowd = crowd_of(&def), *loaded;
    ff_agent agent[AGENTS];
    ff_error error;
    ff_obstacle_def post = ff_obstacle_def_default();
    FF_ASSERT_OK(ff_crowd_add_obstacle(crowd, &post, NULL, &error), error);
    add_circle(crowd, AGENTS, 5.0, true, agent);
    go(crowd, 4.0);
    uint32_t varied = 0;
    for (uint32_t i = 0; i < AGENTS; ++i)
        varied += crowd->steppers[i].play.step[0].pace != 1.0;
    assert_true(varied > 0);
    size_t size = ff_crowd_save_size(crowd);
    void *data = malloc(size);
    assert_non_null(data);
    FF_ASSERT_OK(ff_crowd_save(crowd, data, size, &error), error);
    FF_ASSERT_OK(ff_crowd_load(pack, data, size, NULL, &loaded, &error), error);
    assert_true(ff_crowd_state_hash(loaded) == ff_crowd_state_hash(crowd));
    go(crowd, 4.0);
    go(loaded, 4.0);
    assert_true(ff_crowd_state_hash(loaded) == ff_crowd_state_hash(crowd));
    free(data);
    ff_crowd_destroy(loaded);
    ff_crowd_destroy(crowd);
}

static void an_agent_takes_no_more_than_sixteen_kibibytes(void **state)
{
    (void)state;
    assert_true(sizeof(ff_stepper) % 8 == 0);
    assert_true(sizeof(ff_stepper) <= 16 * 1024);
}

/* ------------------------------------------------------------------------------------------------- changing planner */

typedef struct shown {
    ff_vec3 at[FF_JOINT_COUNT];
} shown;

static shown look(const ff_crowd *crowd, ff_agent agent)
{
    shown s;
    ff_vec3 hips;
    ff_quat local[FF_JOINT_COUNT], world[FF_JOINT_COUNT];
    ff_error error;
    FF_ASSERT_OK(ff_crowd_agent_pose(crowd, agent, &hips, local, &error), error);
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        int parent = ff_joint_parents[j];
        world[j] = parent < 0 ? local[j] : ff_quat_mul(world[parent], local[j]);
        s.at[j] = parent < 0
                      ? hips
                      : ff_add3(s.at[parent], ff_quat_rotate(world[parent], crowd->space->body.offset[j]));
    }
    return s;
}

/* How much the fastest joint's velocity changes within a step: a jump shows as a large one. */
static void changing_planner_on_the_way_does_not_show(void **state)
{
    (void)state;
    ff_crowd_def def = footsteps_def(1);
    def.footsteps.mixed = true;
    def.step = 1.0 / 60.0;
    double most[2] = {0.0, 0.0};  /* m/s: within a step, at other times and about the changes */
    double low = 1.0, high = 0.0; /* m, of the balls of planted feet, once they are down */
    int changes = 0;
    for (int k = 0; k < 8; ++k) {
        ff_crowd *crowd = crowd_of(&def);
        ff_error error;
        ff_agent agent = add(crowd, ff_v2(0.0, 0.0), ff_v2(20.0, 0.5 * k),
                             k % 2 ? FF_PLANNER_VELOCITY : FF_PLANNER_FOOTSTEPS);
        shown s[3];
        int since = 1000, down[2] = {0, 0};
        uint8_t planner = state_of(crowd, agent).planner;
        for (int i = 0; i < 540; ++i) {
            if (i % 130 == 100) {
                ff_planner other =
                    planner == FF_PLANNER_VELOCITY ? FF_PLANNER_FOOTSTEPS : FF_PLANNER_VELOCITY;
                FF_ASSERT_OK(ff_crowd_set_planner(crowd, agent, other, &error), error);
            }
            ff_crowd_step(crowd);
            ff_agent_state is = state_of(crowd, agent);
            if (is.planner != planner) since = 0, ++changes;
            planner = is.planner;
            s[2] = look(crowd, agent);
            for (int foot = 0; foot < 2; ++foot) {
                double ball = s[2].at[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE].y;
                down[foot] = is.planted[foot] ? down[foot] + 1 : 0;
                if (down[foot] < 4) continue; /* heel first: 0.07 s until the ball is down, too */
                low = ff_min(low, ball);
                high = ff_max(high, ball);
            }
            for (int j = 0; j < FF_JOINT_COUNT && i > 1; ++j) {
                ff_vec3 v = ff_sub3(s[2].at[j], s[1].at[j]), u = ff_sub3(s[1].at[j], s[0].at[j]);
                double change = ff_length3(ff_sub3(v, u)) * 60.0;
                int about = since < 20;
                assert_true(change < 100.0); /* a number at all */
                if (i > 60) most[about] = ff_max(most[about], change);
            }
            s[0] = s[1];
            s[1] = s[2];
            ++since;
        }
        ff_crowd_destroy(crowd);
    }
    print_message(
        "%d changes; joints' speeds change by up to %.2f m/s in a step about them, %.2f at other times\n",
        changes, most[1], most[0]);
    print_message("balls of planted feet are %.1f to %.1f cm high\n", 100.0 * low, 100.0 * high);
    assert_true(changes >= 16);
    FF_ASSERT_BELOW(high - low, 0.01);
    FF_ASSERT_BELOW(most[1], ff_max(1.5 * most[0], 1.0));
}

static void a_crowd_without_memory_for_footsteps_says_so(void **state)
{
    (void)state;
    ff_crowd_def def = footsteps_def(2);
    def.planner = FF_PLANNER_VELOCITY;
    ff_crowd *crowd = crowd_of(&def);
    ff_error error;
    ff_agent agent = add(crowd, ff_v2(0.0, 0.0), ff_v2(5.0, 0.0), FF_PLANNER_CROWD);
    assert_int_equal(ff_crowd_set_planner(crowd, agent, FF_PLANNER_FOOTSTEPS, &error), FF_ERR_UNSUPPORTED);
    ff_agent_def other = ff_agent_def_default();
    other.planner = FF_PLANNER_FOOTSTEPS;
    assert_int_equal(ff_crowd_add_agent(crowd, &other, &agent, &error), FF_ERR_UNSUPPORTED);
    other.planner = (ff_planner)9;
    assert_int_equal(ff_crowd_add_agent(crowd, &other, &agent, &error), FF_ERR_RANGE);
    ff_crowd_destroy(crowd);
}

static void bad_obstacles_are_refused(void **state)
{
    (void)state;
    ff_crowd_def def = footsteps_def(1);
    def.max_obstacles = 1;
    ff_crowd *crowd = crowd_of(&def);
    ff_error error;
    const struct {
        double radius, low, high, time;
        int kind, points;
        ff_status status;
    } bad[] = {{-1.0, 0.0, 2.0, 0.0, FF_OBSTACLE_STATIC, 0, FF_ERR_RANGE},
               {0.0, 0.0, 2.0, 0.0, FF_OBSTACLE_FREE, 0, FF_ERR_RANGE},
               {0.1, 2.0, 1.0, 0.0, FF_OBSTACLE_STATIC, 0, FF_ERR_RANGE},
               {0.1, 0.0, NAN, 0.0, FF_OBSTACLE_STATIC, 0, FF_ERR_RANGE},
               {0.1, 0.0, 2.0, 0.0, 7, 0, FF_ERR_RANGE},
               {0.1, 0.0, 2.0, 0.0, FF_OBSTACLE_PATH, 0, FF_ERR_RANGE},
               {0.1, 0.0, 2.0, -1.0, FF_OBSTACLE_PATH, 2, FF_ERR_RANGE},
               {0.1, 0.0, 2.0, 0.0, FF_OBSTACLE_PATH, 2, FF_ERR_RANGE}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        ff_obstacle_def obstacle = ff_obstacle_def_default();
        obstacle.kind = (ff_obstacle_kind)bad[i].kind;
        obstacle.radius = bad[i].radius;
        obstacle.low = bad[i].low;
        obstacle.high = bad[i].high;
        obstacle.path_count = (uint32_t)bad[i].points;
        obstacle.path[1].time = bad[i].time;
        assert_int_equal(ff_crowd_add_obstacle(crowd, &obstacle, NULL, &error), bad[i].status);
        assert_true(error.message[0] != 0);
    }
    ff_obstacle_def good = ff_obstacle_def_default();
    uint32_t number;
    FF_ASSERT_OK(ff_crowd_add_obstacle(crowd, &good, &number, &error), error);
    assert_int_equal(ff_crowd_add_obstacle(crowd, &good, &number, &error), FF_ERR_RANGE);
    assert_int_equal(ff_crowd_move_obstacle(crowd, 0, ff_v2(1.0, 0.0), 0.0, &error), FF_ERR_ARGUMENT);
    assert_int_equal(ff_crowd_move_obstacle(crowd, 1, ff_v2(1.0, 0.0), 0.0, &error), FF_ERR_ARGUMENT);
    ff_crowd_destroy(crowd);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(who_is_alone_gets_there_and_makes_plans_when_they_expire),
        cmocka_unit_test(a_goal_that_moves_is_followed),
        cmocka_unit_test(who_has_arrived_turns_to_what_it_shall_look_at),
        cmocka_unit_test(waypoints_lead_round_a_wall_and_are_left_out_when_the_next_is_seen),
        cmocka_unit_test(an_obstacle_on_a_known_path_is_noticed_and_avoided),
        cmocka_unit_test(an_unforeseen_wall_is_noticed_at_once_and_never_walked_through),
        cmocka_unit_test(plans_in_force_never_meet_and_nobody_is_without_one),
        cmocka_unit_test(how_long_plans_take_is_known_to_a_twentieth),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(a_crowd_on_footsteps_is_saved_and_goes_on_to_the_bit),
        cmocka_unit_test(an_agent_takes_no_more_than_sixteen_kibibytes),
        cmocka_unit_test(changing_planner_on_the_way_does_not_show),
        cmocka_unit_test(a_crowd_without_memory_for_footsteps_says_so),
        cmocka_unit_test(bad_obstacles_are_refused),
    };
    return cmocka_run_group_tests_name("crowds on footsteps", tests, open_pack, close_pack);
}
