/* Obstacles that move are not walked through by those who go by velocity. */
#define _GNU_SOURCE
#include "tests/built_in_open.h"
#include "tests/core/crowd_ask.h"

#include <stdlib.h>

#define STEP (1.0 / 30.0)
#define SECONDS 24.0 /* flat in front of what rests it takes 6 s without progress until one tries a detour */
#define DEEPEST 0.02 /* m */
enum { AGENTS = 12, FORMS = 3 };

static ff_obstacle_def form_of(int form, ff_obstacle_kind kind, double heading)
{
    ff_obstacle_def shape = ff_obstacle_def_default();
    const double sizes[FORMS][3] = {
        {1.0, 0.5, 0.0}, {0.0, 0.0, 0.5}, {1.5, 0.0, 0.2}}; /* box, disc, capsule */
    shape.kind = kind;
    shape.heading = heading;
    shape.half_length = sizes[form][0];
    shape.half_width = sizes[form][1];
    shape.radius = sizes[form][2];
    return shape;
}

/* m between the disc of an agent and an obstacle that is where the crowd says; negative: how deep. */
static double room(const ff_crowd *crowd, uint32_t number, const ff_obstacle_def *shape, ff_agent agent)
{
    ff_vec2 centre;
    double heading;
    ff_error error;
    FF_ASSERT_OK(ff_crowd_obstacle_place(crowd, number, &centre, &heading, &error), error);
    ff_vec2 x = ff_to_frame2(ff_fwd2(heading), ff_sub2(state_of(crowd, agent).position, centre));
    double a = fabs(x.a) - shape->half_length, b = fabs(x.b) - shape->half_width;
    double outside = ff_length2(ff_v2(ff_max(a, 0.0), ff_max(b, 0.0)));
    return outside + ff_min(ff_max(a, b), 0.0) - shape->radius - ff_agent_def_default().radius;
}

/* Agents in rows of four on the way from x = -5 to x = 5. */
static ff_crowd *crowd_of(uint32_t threads, int agents, ff_agent *agent)
{
    ff_crowd_def def = ff_crowd_def_default();
    ff_crowd *crowd;
    ff_error error;
    def.max_agents = AGENTS;
    def.step = STEP;
    def.threads = threads;
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &crowd, &error), error);
    for (int i = 0; i < agents; ++i) {
        ff_agent_def one = ff_agent_def_default();
        one.position = ff_v2(-5.0 - 1.2 * (i / 4), agents > 1 ? 1.2 * (i % 4) - 1.8 : 0.0);
        one.goal = ff_v2(5.0, one.position.b);
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &one, &agent[i], &error), error);
    }
    return crowd;
}

typedef struct outcome {
    double least; /* m between them */
    bool reached;
} outcome;

/* One agent, and an obstacle that goes from a place on at a velocity. */
static outcome meet(ff_obstacle_def shape, ff_vec2 from, ff_vec2 velocity)
{
    ff_agent agent;
    ff_crowd *crowd = crowd_of(1, 1, &agent);
    ff_error error;
    outcome out = {.least = INFINITY};
    shape.position = from;
    shape.path_count = 2;
    shape.path[1] = (ff_obstacle_point){SECONDS, ff_scale2(velocity, SECONDS)};
    FF_ASSERT_OK(ff_crowd_add_obstacle(crowd, &shape, NULL, &error), error);
    for (int i = 0; i < SECONDS / STEP; ++i) {
        ff_vec2 at = ff_madd2(from, velocity, i * STEP);
        if (shape.kind == FF_OBSTACLE_FREE)
            FF_ASSERT_OK(ff_crowd_move_obstacle(crowd, 0, at, shape.heading, &error), error);
        ff_crowd_step(crowd);
        out.least = ff_min(out.least, room(crowd, 0, &shape, agent));
    }
    out.reached = state_of(crowd, agent).reached == 1;
    ff_crowd_destroy(crowd);
    return out;
}

static void nobody_walks_through_what_crosses_his_way(void **state)
{
    (void)state;
    int count = 0, blocked = 0;
    double least = INFINITY;
    for (int kind = FF_OBSTACLE_PATH; kind <= FF_OBSTACLE_FREE; ++kind) {
        for (int k = 0; k < 18; ++k) {
            ff_vec2 v = ff_scale2(ff_fwd2(FF_TAU * (k % 6) / 12.0 + FF_PI / 2.0), 0.6 * (k / 6 + 1));
            for (int form = 0; form < FORMS; ++form) {
                ff_obstacle_def shape = form_of(form, (ff_obstacle_kind)kind, FF_TAU * (k % 6) / 12.0);
                outcome out = meet(shape, ff_scale2(v, -4.0), v);
                least = ff_min(least, out.least);
                FF_ASSERT_BELOW(-out.least, DEEPEST);
                blocked += !out.reached;
                ++count;
            }
        }
    }
    print_message("%d ways crossed, at least %.1f cm between; %d not at the goal\n", count, 100.0 * least,
                  blocked);
    assert_int_equal(blocked, 0);
}

static void what_rests_is_walked_round(void **state)
{
    (void)state;
    for (int form = 0; form < FORMS; ++form) {
        outcome out = meet(form_of(form, FF_OBSTACLE_FREE, 0.0), ff_v2(0.0, 0.0), ff_v2(0.0, 0.0));
        FF_ASSERT_BELOW(-out.least, DEEPEST);
        assert_true(out.reached);
    }
}

static void who_stands_steps_out_of_the_way(void **state)
{
    (void)state;
    ff_agent agent;
    ff_crowd *crowd = crowd_of(1, 1, &agent);
    ff_error error;
    ff_obstacle_def disc = form_of(1, FF_OBSTACLE_FREE, 0.0);
    FF_ASSERT_OK(ff_crowd_set_goal(crowd, agent, ff_v2(-5.0, 0.0), &error), error);
    disc.position = ff_v2(-5.0, 6.0);
    FF_ASSERT_OK(ff_crowd_add_obstacle(crowd, &disc, NULL, &error), error);
    for (int i = 0; i < 10.0 / STEP; ++i) {
        ff_vec2 at = ff_v2(-5.0, 6.0 - i * STEP);
        FF_ASSERT_OK(ff_crowd_move_obstacle(crowd, 0, at, 0.0, &error), error);
        ff_crowd_step(crowd);
        FF_ASSERT_BELOW(-room(crowd, 0, &disc, agent), DEEPEST);
    }
    ff_crowd_destroy(crowd);
}

/* A crowd that a box on a path, to and fro, and a disc go through. */
static ff_crowd *busy(uint32_t threads, ff_agent agent[AGENTS])
{
    ff_crowd *crowd = crowd_of(threads, AGENTS, agent);
    ff_error error;
    ff_obstacle_def box = form_of(0, FF_OBSTACLE_PATH, 0.5), disc = form_of(1, FF_OBSTACLE_FREE, 0.0);
    box.position = ff_v2(-1.0, -4.0);
    box.path_count = 3;
    box.path[1] = (ff_obstacle_point){6.0, ff_v2(1.0, 8.0)};
    box.path[2] = (ff_obstacle_point){12.0, ff_v2(0.0, 0.0)};
    box.cyclic = true;
    FF_ASSERT_OK(ff_crowd_add_obstacle(crowd, &box, NULL, &error), error);
    FF_ASSERT_OK(ff_crowd_add_obstacle(crowd, &disc, NULL, &error), error);
    return crowd;
}

static void go_on(ff_crowd *crowd, const ff_agent agent[AGENTS], int first, int end)
{
    const ff_obstacle_def box = form_of(0, FF_OBSTACLE_PATH, 0.5), disc = form_of(1, FF_OBSTACLE_FREE, 0.0);
    ff_error error;
    for (int i = first; i < end; ++i) {
        ff_vec2 at = ff_v2(3.0 - 0.9 * i * STEP, 0.3);
        FF_ASSERT_OK(ff_crowd_move_obstacle(crowd, 1, at, 0.0, &error), error);
        ff_crowd_step(crowd);
        for (int k = 0; k < AGENTS; ++k)
            FF_ASSERT_BELOW(-ff_min(room(crowd, 0, &box, agent[k]), room(crowd, 1, &disc, agent[k])),
                            DEEPEST);
    }
}

static void a_crowd_keeps_off_too_whatever_the_threads_and_after_a_break(void **state)
{
    (void)state;
    ff_agent agent[AGENTS];
    ff_crowd *one = busy(1, agent), *three = busy(3, agent), *later;
    ff_error error;
    go_on(one, agent, 0, 240);
    go_on(three, agent, 0, 240);
    size_t size = ff_crowd_save_size(one);
    void *bytes = malloc(size);
    assert_non_null(bytes);
    FF_ASSERT_OK(ff_crowd_save(one, bytes, size, &error), error);
    FF_ASSERT_OK(ff_crowd_load(pack, bytes, size, NULL, &later, &error), error);
    free(bytes);
    go_on(one, agent, 240, 360);
    go_on(three, agent, 240, 360);
    go_on(later, agent, 240, 360);
    assert_true(ff_crowd_state_hash(one) == ff_crowd_state_hash(three));
    assert_true(ff_crowd_state_hash(one) == ff_crowd_state_hash(later));
    ff_crowd_destroy(one);
    ff_crowd_destroy(three);
    ff_crowd_destroy(later);
}

static void what_moves_far_away_changes_nothing(void **state)
{
    (void)state;
    ff_agent agent[AGENTS];
    ff_crowd *with = crowd_of(1, AGENTS, agent), *without = crowd_of(1, AGENTS, agent);
    ff_error error;
    ff_obstacle_def disc = form_of(1, FF_OBSTACLE_FREE, 0.0);
    disc.position = ff_v2(1e3, 0.0);
    FF_ASSERT_OK(ff_crowd_add_obstacle(with, &disc, NULL, &error), error);
    for (int step = 0; step < 150; ++step) {
        FF_ASSERT_OK(ff_crowd_move_obstacle(with, 0, ff_v2(1e3 - step * STEP, 0.0), 0.0, &error), error);
        ff_crowd_step(with);
        ff_crowd_step(without);
    }
    for (int i = 0; i < AGENTS; ++i) {
        ff_agent_state x = state_of(with, agent[i]), y = state_of(without, agent[i]);
        assert_memory_equal(&x.position, &y.position, sizeof x.position);
        assert_memory_equal(&x.velocity, &y.velocity, sizeof x.velocity);
    }
    ff_crowd_destroy(with);
    ff_crowd_destroy(without);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nobody_walks_through_what_crosses_his_way),
        cmocka_unit_test(what_rests_is_walked_round),
        cmocka_unit_test(who_stands_steps_out_of_the_way),
        cmocka_unit_test(a_crowd_keeps_off_too_whatever_the_threads_and_after_a_break),
        cmocka_unit_test(what_moves_far_away_changes_nothing),
    };
    return cmocka_run_group_tests(tests, open_pack, close_pack);
}
