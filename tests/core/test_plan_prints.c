/* Footprints of plans as the public interface gives them, and the feet that it poses: a plan says where and when each foot will
 * stand, and there and then it does. */
#define _GNU_SOURCE
#include "runtime/core/base/maths.h"
#include "runtime/core/pack/joints.h"
#include "tests/built_in_pack.h"

#define HZ 60.0
enum { PRINTS = 64, SECONDS = 9 };

typedef struct watched_print {
    ff_planned_print print;
    ff_vec3 landed; /* the ball at the first frame that is not before its time */
    int frame;      /* that one; -1: to come */
} watched_print;

static ff_vec3 ball_of(const ff_crowd *crowd, ff_agent agent, uint32_t foot)
{
    static ff_matrix joints[FF_JOINT_COUNT];
    ff_error error;
    FF_ASSERT_OK(ff_crowd_agent_matrices(crowd, agent, ff_v2(0.0, 0.0), joints, &error), error);
    const ff_matrix *at = &joints[FF_JOINT_BALL_L + (int)foot * FF_JOINT_LEG_STRIDE];
    return ff_v3((double)at->row[0][3], (double)at->row[1][3], (double)at->row[2][3]);
}

/* The next print of each foot, if it is less than a frame away. */
static void find_due(const ff_crowd *crowd, ff_agent agent, double now, watched_print *list, int *count)
{
    ff_planned_print prints[PRINTS];
    uint32_t there = 0;
    ff_error error;
    FF_ASSERT_OK(ff_crowd_agent_plan(crowd, agent, prints, PRINTS, &there, &error), error);
    for (uint32_t i = 0; i < there && i < PRINTS; ++i) {
        bool due = prints[i].time > now && prints[i].time <= now + 1.0 / HZ;
        if (!due || prints[i].action == UINT32_MAX) continue;
        assert_in_range(*count, 0, PRINTS - 1);
        list[(*count)++] = (watched_print){.print = prints[i], .frame = -1};
    }
}

/* One who walks to a goal; returns how many prints it stood on. */
static int walk(ff_pack *pack, ff_vec2 goal)
{
    enum { BEFORE = 3, HISTORY = 4 };
    ff_crowd_def def = ff_crowd_def_default();
    ff_agent_def person = ff_agent_def_default();
    ff_crowd *crowd;
    ff_agent agent;
    ff_error error;
    def.max_agents = 1;
    def.step = 1.0 / HZ;
    def.planner = FF_PLANNER_FOOTSTEPS;
    person.goal = goal;
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &crowd, &error), error);
    FF_ASSERT_OK(ff_crowd_add_agent(crowd, &person, &agent, &error), error);
    watched_print list[PRINTS];
    ff_vec3 past[HISTORY][2] = {{{0.0, 0.0, 0.0}}};
    int count = 0, done = 0;
    for (int frame = 0; frame < SECONDS * (int)HZ; ++frame) {
        ff_vec3 ball[2] = {ball_of(crowd, agent, 0), ball_of(crowd, agent, 1)};
        memcpy(past[frame % HISTORY], ball, sizeof ball);
        for (int i = done; i < count; ++i) {
            watched_print *w = &list[i];
            ff_vec3 now = ball[w->print.foot];
            if (w->frame < 0) {
                ff_vec3 before = past[(frame + HISTORY - BEFORE) % HISTORY][w->print.foot];
                w->frame = frame;
                w->landed = now;
                assert_true(ff_length3(ff_sub3(now, before)) > 0.001); /* it has only just come */
            }
            FF_ASSERT_BELOW(ff_length2(ff_sub2(ff_plane(now), w->print.ball)), 0.01);
            FF_ASSERT_BELOW(ff_length2(ff_sub2(ff_plane(now), ff_plane(w->landed))), 0.001);
            if (frame > w->frame)
                FF_ASSERT_BELOW(now.y - past[(frame + HISTORY - 1) % HISTORY][w->print.foot].y, 0.005);
            if (i == done && frame > w->frame + 6)
                ++done; /* a tenth of a second is enough to see that it stands */
        }
        find_due(crowd, agent, (double)ff_crowd_step_count(crowd) / HZ, list, &count);
        ff_crowd_step(crowd);
    }
    ff_crowd_destroy(crowd);
    return done;
}

static void walk_about(const char *path)
{
    ff_pack *pack;
    ff_error error;
    FF_ASSERT_OK(ff_pack_open(path, &pack, &error), error);
    int prints = walk(pack, ff_v2(8.0, 0.0)) + walk(pack, ff_v2(-5.0, 4.0)) + walk(pack, ff_v2(0.5, -6.0));
    print_message("%d prints\n", prints);
    assert_true(prints >= 24);
    ff_pack_close(pack);
}

static void feet_stand_on_the_published_prints_at_their_time(void **state)
{
    (void)state;
    walk_about(ff_built_in_pack_path());
}

static void captured_feet_stand_on_the_published_prints_at_their_time(void **state)
{
    (void)state;
    const char *path = ff_captured_pack_path();
    if (!path) {
        print_message("SKIPPED captured_feet_stand_on_the_published_prints_at_their_time: the shared folder "
                      "is not there\n");
        skip();
    }
    walk_about(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feet_stand_on_the_published_prints_at_their_time),
        cmocka_unit_test(captured_feet_stand_on_the_published_prints_at_their_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
