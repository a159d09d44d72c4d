/* Joints of actions: tracks go on without a jump, bounds hold, and played bodies are where their tracks have them. */
#define _GNU_SOURCE
#include "runtime/core/crowd/crowd_state.h"
#include "runtime/core/plan/plan_joint.h"
#include "runtime/export/body_contacts.h"
#include "tests/core/plan_world.h"

#include <stdlib.h>

#define CASES 3000

/* A random joint of a set: an action and one that follows it. */
typedef struct pair {
    const ff_set_action *before, *next;
    const ff_set_next *link;
    const ff_joint *joint;
} pair;

static pair random_pair(const ff_action_set *set, ff_random *random)
{
    pair p = {.before = NULL};
    do
        p.before = &set->actions[(uint32_t)ff_random_range(random, 0.0, set->count - 1e-6)];
    while (p.before->next_count == 0);
    uint32_t k = p.before->first_next + (uint32_t)ff_random_range(random, 0.0, p.before->next_count - 1e-6);
    p.link = &set->next[k];
    p.next = &set->actions[p.link->action];
    p.joint = &set->joints[k];
    return p;
}

static ff_knot joined(const ff_action_set *set, const pair *p, float t)
{
    ff_knot at, out;
    ff_set_sample(set, p->next, t, &at);
    ff_joint_add(p->joint, t, &at, &out);
    return out;
}

static void an_action_begins_where_the_one_before_ended(void **state)
{
    const plan_world *w = *state;
    const ff_action_set *sets[] = {w->set, w->varied};
    ff_random random = {7, 0, 0};
    for (int i = 0; i < CASES; ++i) {
        const ff_action_set *set = sets[i % 2];
        pair p = random_pair(set, &random);
        ff_knot begin = joined(set, &p, 0.0f), end, over, own;
        ff_set_sample(set, p.before, p.before->duration, &end);
        /* S0 of the next lies on the foot that has landed, or goes on standing, along the heading at the end. */
        ff_vec2 axis = ff_fwd2((double)p.before->theta), anchor = ff_v2(0.0, 0.0);
        if (!p.link->other) anchor = ff_v2((double)p.before->land[0], (double)p.before->land[1]);
        for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
            ff_vec2 at = ff_add2(anchor, ff_from_frame2(axis, ff_v2((double)begin.a[c], (double)begin.b[c])));
            FF_ASSERT_NEAR(at.a, (double)end.a[c], 1e-5);
            FF_ASSERT_NEAR(at.b, (double)end.b[c], 1e-5);
            FF_ASSERT_NEAR((double)begin.y[c], (double)end.y[c], 1e-5);
        }
        /* It is over by the last moment of a track before the end, which is where the next joint starts from. */
        float last = p.next->duration - (float)FF_TRACK_STEP;
        assert_true(p.joint->over <= last + 1e-5f || p.joint->over <= 0.03f);
        over = joined(set, &p, p.joint->over);
        ff_set_sample(set, p.next, p.joint->over, &own);
        for (int c = 0; c < FF_COLLIDER_COUNT; ++c)
            FF_ASSERT_NEAR((double)over.a[c], (double)own.a[c], 1e-5);
    }
}

static void bounds_of_joints_hold(void **state)
{
    const plan_world *w = *state;
    ff_random random = {8, 0, 0};
    double tightest = INFINITY;
    for (int i = 0; i < CASES; ++i) {
        pair p = random_pair(w->set, &random);
        float t = (float)ff_random_range(&random, 0.0, (double)p.joint->over);
        ff_knot at, out;
        ff_set_sample(w->set, p.next, t, &at);
        ff_joint_add(p.joint, t, &at, &out);
        double about = (double)ff_joint_about(p.joint, t), most = (double)ff_joint_most(p.joint);
        const int root = FF_COLLIDER_ROOT;
        ff_vec2 base = ff_v2((double)(out.a[root] - at.a[root]), (double)(out.b[root] - at.b[root]));
        float move[2];
        ff_joint_move(p.joint, t, move);
        FF_ASSERT_NEAR(base.a, (double)move[0], 1e-6);
        FF_ASSERT_NEAR(base.b, (double)move[1], 1e-6);
        for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
            ff_vec2 moved = ff_v2((double)(out.a[c] - at.a[c]), (double)(out.b[c] - at.b[c]));
            double from_root = ff_length2(ff_sub2(moved, base));
            FF_ASSERT_BELOW(from_root, about + 1e-5);
            FF_ASSERT_BELOW(ff_length2(moved), most + 1e-5);
            if (about > 0.02) tightest = ff_min(tightest, about - from_root);
        }
    }
    FF_ASSERT_BELOW(tightest, 0.03);
}

/* Searches look at one collider where they can, and rely on its being where all six together have it. */
static void one_collider_is_to_the_bit_where_all_together_have_it(void **state)
{
    const plan_world *w = *state;
    ff_random random = {9, 0, 0};
    for (int i = 0; i < CASES; ++i) {
        pair p = random_pair(w->set, &random);
        float t = (float)ff_random_range(&random, -0.1, (double)p.next->duration + 0.1);
        ff_knot all = joined(w->set, &p, t);
        for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
            float one[3];
            ff_set_sample_one(w->set, p.next, t, c, one);
            ff_joint_add_one(p.joint, t, c, one);
            assert_true(one[0] == all.a[c] && one[1] == all.b[c] && one[2] == all.y[c]);
        }
    }
}

/* --------------------------------------------------------------------------------------------- in a crowd */

enum { PEOPLE = 24, SECONDS = 12, HZ = 30 };

/* m: how far each collider is off its track, of everybody at all moments. */
typedef struct misses {
    double *off[FF_COLLIDER_COUNT];
    size_t count;
} misses;

static int by_size(const void *x, const void *y)
{
    double p = *(const double *)x, q = *(const double *)y;
    return (p > q) - (p < q);
}

static ff_vec2 on_track(const ff_track *track, double time, int collider)
{
    double at = time / FF_TRACK_STEP - (double)track->first, last = (double)track->count - 1.0;
    at = ff_clamp(at, 0.0, last);
    uint32_t k = (uint32_t)ff_min(floor(at), ff_max(last - 1.0, 0.0)),
             next = k + 1 < track->count ? k + 1 : k;
    const ff_knot *p = &track->knots[k], *q = &track->knots[next];
    double f = at - k;
    return ff_add2(track->origin, ff_v2(ff_lerp((double)p->a[collider], (double)q->a[collider], f),
                                        ff_lerp((double)p->b[collider], (double)q->b[collider], f)));
}

static void look_at(const ff_crowd *crowd, const ff_figure *figure, ff_agent agent, misses *m)
{
    ff_vec3 hips, joints[FF_FIGURE_MAX_JOINTS];
    ff_quat local[FF_FIGURE_MAX_JOINTS], world[FF_FIGURE_MAX_JOINTS];
    ff_agent_state at;
    ff_error error;
    FF_ASSERT_OK(ff_crowd_agent_pose(crowd, agent, &hips, local, &error), error);
    FF_ASSERT_OK(ff_crowd_agent_state(crowd, agent, &at, &error), error);
    ff_figure_place(figure, hips, local, joints, world);
    ff_cylinders body = ff_cylinders_of_colliders(crowd->pack, joints, world);
    const ff_track *track = &crowd->steppers[agent.slot].track;
    for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
        ff_vec2 is = c == FF_COLLIDER_ROOT ? at.position : ff_plane(body.at[c]);
        m->off[c][m->count] = ff_length2(ff_sub2(is, on_track(track, ff_crowd_time(crowd), c)));
    }
    ++m->count;
}

static void played_bodies_are_where_their_tracks_have_them(void **state)
{
    const plan_world *w = *state;
    ff_crowd_def def = ff_crowd_def_default();
    ff_crowd *crowd;
    ff_figure figure;
    ff_error error;
    ff_agent agents[PEOPLE];
    misses m = {.count = 0};
    def.max_agents = PEOPLE;
    def.step = 1.0 / HZ;
    def.planner = FF_PLANNER_FOOTSTEPS;
    FF_ASSERT_OK(ff_figure_from_pack(w->pack, &figure, &error), error);
    FF_ASSERT_OK(ff_crowd_create(w->pack, &def, &crowd, &error), error);
    for (int i = 0; i < PEOPLE; ++i) {
        ff_agent_def one = ff_agent_def_default();
        one.position = ff_scale2(ff_fwd2(FF_TAU * i / PEOPLE), 5.0);
        one.goal = ff_scale2(ff_fwd2(FF_TAU * i / PEOPLE + 2.5), 5.0);
        one.heading = FF_TAU * i / PEOPLE + 1.0; /* not towards the goal: some turn round first */
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &one, &agents[i], &error), error);
    }
    for (int c = 0; c < FF_COLLIDER_COUNT; ++c)
        assert_non_null(m.off[c] = malloc((size_t)PEOPLE * SECONDS * HZ * sizeof **m.off));
    for (int k = 0; k < SECONDS * HZ; ++k) {
        ff_crowd_step(crowd);
        for (int i = 0; i < PEOPLE; ++i)
            look_at(crowd, &figure, agents[i], &m);
    }
    static const double most[FF_COLLIDER_COUNT] = {0.025, 0.025, 0.025, 0.04, 0.04, 0.02};
    for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
        qsort(m.off[c], m.count, sizeof **m.off, by_size);
        double almost = m.off[c][m.count * 99 / 100];
        print_message("%s%.1f", c == 0 ? "  off their tracks in 99 of 100 moments, cm: " : ", ",
                      100.0 * almost);
        FF_ASSERT_BELOW(almost, most[c]);
        FF_ASSERT_BELOW(m.off[c][m.count - 1], 0.07);
        free(m.off[c]);
    }
    print_message("\n");
    ff_crowd_destroy(crowd);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_action_begins_where_the_one_before_ended),
        cmocka_unit_test(bounds_of_joints_hold),
        cmocka_unit_test(one_collider_is_to_the_bit_where_all_together_have_it),
        cmocka_unit_test(played_bodies_are_where_their_tracks_have_them),
    };
    return cmocka_run_group_tests_name("joints of actions", tests, plan_world_open, plan_world_close);
}
