/* Danger: bars that sweep at people on footsteps are jumped or ducked, by bodies and not in plans alone. */
#define _GNU_SOURCE
#include "runtime/core/base/random.h"
#include "runtime/core/crowd/crowd_state.h"
#include "runtime/core/pack/joints.h"
#include "tests/built_in_pack.h"

#include <stdlib.h>

#define STEP (1.0 / 30.0)
enum { PEOPLE = 4, BARS = 8, FRAMES = 250 };

static ff_pack *pack;

static int open_pack(void **state)
{
    (void)state;
    ff_error error;
    FF_ASSERT_OK(ff_pack_open(ff_built_in_pack_path(), &pack, &error), error);
    return 0;
}

static int close_pack(void **state)
{
    (void)state;
    ff_pack_close(pack);
    return 0;
}

/* A bar across the way of people who walk, or stand, side by side. */
typedef struct trial {
    double low, high; /* m */
    double speed;     /* m/s, towards them */
    double width;     /* m, along its way */
    double from;      /* m, ahead of them */
    bool stands, known;
    double across; /* m, of its length */
} trial;

typedef struct findings {
    uint32_t hits; /* joints of bodies in the bar, frame by frame */
    uint32_t dangers, dodges;
    double highest_foot, lowest_head;
} findings;

/* Is a point of the body in the bar? */
static uint32_t hits_of(const ff_crowd *crowd, ff_agent agent, const ff_shape *bar, findings *out)
{
    ff_vec3 hips, at[FF_JOINT_COUNT];
    ff_quat local[FF_JOINT_COUNT], world[FF_JOINT_COUNT];
    ff_error error;
    FF_ASSERT_OK(ff_crowd_agent_pose(crowd, agent, &hips, local, &error), error);
    uint32_t hits = 0;
    double foot = INFINITY;
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        int parent = ff_joint_parents[j];
        const float *offset = pack->joints[j].offset;
        ff_vec3 bone = ff_v3((double)offset[0], (double)offset[1], (double)offset[2]);
        world[j] = parent < 0 ? local[j] : ff_quat_mul(world[parent], local[j]);
        at[j] = parent < 0 ? hips : ff_add3(at[parent], ff_quat_rotate(world[parent], bone));
        if (j == FF_JOINT_BALL_L || j == FF_JOINT_BALL_R) foot = ff_min(foot, at[j].y);
        hits += fabs(at[j].z - bar->centre.a) < bar->half_length &&
                fabs(at[j].x - bar->centre.b) < bar->half_width && at[j].y > bar->low && at[j].y < bar->high;
    }
    out->highest_foot = ff_max(out->highest_foot, foot);
    out->lowest_head = ff_min(out->lowest_head, at[FF_JOINT_HEAD].y);
    return hits;
}

static findings sweep(const trial *t)
{
    ff_crowd_def def = ff_crowd_def_default();
    ff_crowd *crowd;
    ff_error error;
    ff_agent agent[PEOPLE];
    findings out = {.lowest_head = INFINITY};
    def.max_agents = PEOPLE;
    def.step = STEP;
    def.planner = FF_PLANNER_FOOTSTEPS;
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &crowd, &error), error);
    for (int i = 0; i < PEOPLE; ++i) {
        ff_agent_def person = ff_agent_def_default();
        person.position = ff_v2(0.1 * i, 1.2 * i);
        person.goal = ff_v2(t->stands ? person.position.a : 12.0, person.position.b);
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &person, &agent[i], &error), error);
    }
    ff_obstacle_def bar = ff_obstacle_def_default();
    uint32_t number;
    bar.kind = t->known ? FF_OBSTACLE_PATH : FF_OBSTACLE_FREE;
    bar.position = ff_v2(t->from, 1.8);
    bar.radius = 0.0;
    bar.half_length = 0.5 * t->width;
    bar.half_width = 0.5 * t->across;
    bar.low = t->low;
    bar.high = t->high;
    if (t->known) {
        bar.path[0] = (ff_obstacle_point){0.0, {0.0, 0.0}};
        bar.path[1] = (ff_obstacle_point){20.0, {-20.0 * t->speed, 0.0}};
        bar.path_count = 2;
    }
    FF_ASSERT_OK(ff_crowd_add_obstacle(crowd, &bar, &number, &error), error);
    for (int i = 0; i < FRAMES; ++i) {
        double time = (i + 1) * STEP;
        if (!t->known)
            FF_ASSERT_OK(
                ff_crowd_move_obstacle(crowd, number, ff_v2(t->from - t->speed * time, 1.8), 0.0, &error),
                error);
        ff_crowd_step(crowd);
        for (int k = 0; k < PEOPLE; ++k)
            out.hits += hits_of(crowd, agent[k], &crowd->obstacles[number].shape, &out);
    }
    for (int k = 0; k < PEOPLE; ++k) {
        ff_plan_counts counts;
        FF_ASSERT_OK(ff_crowd_agent_plan_counts(crowd, agent[k], &counts, &error), error);
        out.dangers += counts.events[FF_EVENT_DANGER];
        out.dodges += counts.dodges;
    }
    ff_crowd_destroy(crowd);
    return out;
}

/* Random bars: at people who walk at them or stand, on known paths or not. FF_BARS: how many. */
static findings sweep_many(bool low)
{
    const char *given = getenv("FF_BARS");
    int cases = given ? atoi(given) : BARS;
    ff_random random = {low ? 11u : 12u, 0, 0};
    findings sum = {.lowest_head = INFINITY};
    for (int i = 0; i < cases; ++i) {
        trial t = {.speed = ff_random_range(&random, 1.0, 4.5),
                   .width = ff_random_range(&random, 0.04, 0.15),
                   .from = ff_random_range(&random, 6.0, 8.0),
                   .across = 12.0,
                   .stands = i % 2 == 1,
                   .known = i % 4 >= 2};
        t.low = low ? 0.0 : ff_random_range(&random, 1.25, 1.45);
        t.high = low ? ff_random_range(&random, 0.08, 0.3) : t.low + 0.15;
        findings one = sweep(&t);
        sum.hits += one.hits;
        sum.dangers += one.dangers;
        sum.dodges += one.dodges;
        sum.lowest_head = ff_min(sum.lowest_head, one.lowest_head);
        sum.highest_foot = ff_max(sum.highest_foot, one.highest_foot);
    }
    print_message("%d bars at %d people: %u joints hit, %u dangers, %u jumps and ducks\n", cases,
                  cases * PEOPLE, sum.hits, sum.dangers, sum.dodges);
    assert_int_equal(sum.hits, 0);
    assert_true(sum.dangers >= (uint32_t)(cases * PEOPLE));
    assert_true(sum.dodges >= (uint32_t)(cases * PEOPLE * 9 / 10));
    return sum;
}

static void low_bars_that_sweep_at_people_are_jumped(void **state)
{
    (void)state;
    findings all = sweep_many(true);
    assert_true(all.highest_foot > 0.3);
}

static void bars_at_the_height_of_heads_are_ducked(void **state)
{
    (void)state;
    findings all = sweep_many(false);
    assert_true(all.lowest_head < 1.15 && all.highest_foot < 0.25);
}

/* What can be neither jumped nor ducked hits (so the measure sees it), and a post is stepped aside for. */
static void other_things_are_not_jumped(void **state)
{
    (void)state;
    const trial wall = {
        .low = 0.6, .high = 0.9, .speed = 3.0, .width = 0.1, .from = 9.0, .across = 12.0, .stands = true};
    findings hit = sweep(&wall);
    assert_true(hit.hits > PEOPLE && hit.dangers >= PEOPLE && hit.dodges == 0);
    const trial post = {
        .high = 2.0, .speed = 1.5, .width = 0.2, .from = 9.0, .across = 0.2, .stands = true, .known = true};
    findings aside = sweep(&post);
    assert_int_equal(aside.hits, 0);
    assert_int_equal(aside.dodges, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(low_bars_that_sweep_at_people_are_jumped),
        cmocka_unit_test(bars_at_the_height_of_heads_are_ducked),
        cmocka_unit_test(other_things_are_not_jumped),
    };
    return cmocka_run_group_tests(tests, open_pack, close_pack);
}
