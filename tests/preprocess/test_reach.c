/* Reach tables against walks of the pack's own actions: nobody comes to stand anywhere for much less than the tables say. */
#define _GNU_SOURCE
#include "runtime/core/base/random.h"
#include "runtime/core/plan/plan_set.h"
#include "tests/built_in_pack.h"

#include <stdio.h>

typedef struct fixture {
    ff_pack *pack;
    ff_action_set *set, *varied; /* varied: walking steps at three speeds */
} fixture;

static int open_pack(void **state)
{
    static fixture f;
    ff_error error;
    FF_ASSERT_OK(ff_pack_open(ff_built_in_pack_path(), &f.pack, &error), error);
    FF_ASSERT_OK(ff_action_set_create(f.pack, 0, &f.set, &error), error);
    FF_ASSERT_OK(ff_action_set_create_varied(f.pack, 0, (const double[]){0.75, 1.25}, 2, &f.varied, &error),
                 error);
    *state = &f;
    return 0;
}

static int close_pack(void **state)
{
    fixture *f = *state;
    ff_action_set_destroy(f->set);
    ff_action_set_destroy(f->varied);
    ff_pack_close(f->pack);
    return 0;
}

/* Where the root, the landed foot and the anchor are; in the frame of the first root. */
typedef struct joint {
    ff_vec2 ball, anchor;
    double heading;
} joint;

static ff_vec2 placed(ff_vec2 origin, double heading, const float *at)
{
    return ff_add2(origin, ff_from_frame2(ff_fwd2(heading), ff_v2((double)at[0], (double)at[1])));
}

static joint joint_at_start(const ff_pack_action *r)
{
    joint j = {.heading = 0.0};
    ff_vec2 root =
        ff_from_frame2(ff_fwd2(-(double)r->theta), ff_v2((double)r->root_end[0], (double)r->root_end[1]));
    j.anchor = ff_scale2(root, -1.0);
    j.ball = placed(j.anchor, -(double)r->theta, r->land);
    return j;
}

static ff_vec2 follow(joint *j, const ff_pack_action *last, const ff_pack_action *next)
{
    ff_vec2 origin = next->support == last->swing ? j->ball : j->anchor;
    ff_vec2 root = placed(origin, j->heading, next->root_end);
    *j = (joint){placed(origin, j->heading, next->land), origin, j->heading + (double)next->theta};
    return root;
}

static double table_cost(const ff_pack *pack, const ff_pack_action *r, ff_vec2 goal)
{
    double side = r->swing == 1 ? -1.0 : 1.0;
    int i = (int)floor(goal.a / (double)FF_REACH_CELL + 40.5),
        k = (int)floor(side * goal.b / (double)FF_REACH_CELL + 40.5);
    if (i < 0 || k < 0 || i >= FF_REACH_CELLS || k >= FF_REACH_CELLS) return -1.0;
    return (double)FF_REACH_UNIT * pack->reach[r->reach].cost[i][k];
}

/* Ways that cost less than share of what the table says. */
typedef struct cheap_ways {
    int looked, less;
    double worst; /* J/kg */
} cheap_ways;

static cheap_ways walk_about(const fixture *f, const ff_action_set *set, int walks, double share)
{
    ff_random random = {7, 0, 0};
    cheap_ways out = {0, 0, 0.0};
    for (int walk = 0; walk < walks; ++walk) {
        uint32_t first = (uint32_t)(ff_random_unit(&random) * set->count), at = first;
        const ff_pack_action *begin = ff_action_set_record(set, first);
        if (begin->reach == FF_REACH_NONE) continue;
        joint j = joint_at_start(begin);
        double cost = 0.0;
        for (int step = 0; step < 5; ++step) {
            const ff_set_action *a = &set->actions[at];
            if (a->step_count == 0) break;
            const ff_set_next *next =
                &set->next[a->first_next + (uint32_t)(ff_random_unit(&random) * a->step_count)];
            ff_vec2 root = follow(&j, ff_action_set_record(set, at), ff_action_set_record(set, next->action));
            cost += (double)next->cost;
            at = next->action;
            if (!(set->actions[at].flags & FF_SET_TO_STANDING)) continue;
            /* A goal whose whole cell lies within the radius of where the root is now. */
            ff_vec2 goal = ff_madd2(root, ff_fwd2(ff_random_range(&random, -FF_PI, FF_PI)),
                                    0.2 * sqrt(ff_random_unit(&random)));
            double least = share * table_cost(f->pack, begin, goal);
            if (least < 0.0) continue;
            ++out.looked;
            out.less += least > cost;
            out.worst = ff_max(out.worst, least - cost);
        }
    }
    printf("  %d ways: %d cost less than %.3f of what the table says, by at most %.2f J/kg\n", out.looked,
           out.less, share, out.worst);
    return out;
}

static void nothing_gets_anywhere_for_less(void **state)
{
    const fixture *f = *state;
    cheap_ways own = walk_about(f, f->set, 60000, 1.0);
    assert_true(own.looked > 50000);
    FF_ASSERT_BELOW((double)own.less, 2e-3 * own.looked); /* the lattice */
    FF_ASSERT_BELOW(own.worst, 0.5);
}

static void at_other_speeds_it_costs_no_less_than_the_set_says(void **state)
{
    const fixture *f = *state;
    double share = (double)f->varied->reach_share;
    assert_true(f->varied->count > f->set->count + 20 && share < 1.0 && share > 0.5);
    assert_true(f->set->reach_share == 1.0f);
    cheap_ways ways = walk_about(f, f->varied, 60000, share);
    assert_true(ways.looked > 20000);
    FF_ASSERT_BELOW((double)ways.less, 2e-3 * ways.looked);
    FF_ASSERT_BELOW(ways.worst, 0.5);
}

static void straight_on_costs_what_walking_costs_and_turning_round_costs_more(void **state)
{
    const fixture *f = *state;
    uint32_t seen = 0;
    for (uint32_t i = 0; i < f->set->count; ++i) {
        const ff_pack_action *r = ff_action_set_record(f->set, i);
        if (r->reach == FF_REACH_NONE || !(r->flags & FF_ACTION_TO_STANDING)) continue;
        double ahead = table_cost(f->pack, r, ff_v2(3.5, 0.0)),
               behind = table_cost(f->pack, r, ff_v2(-3.5, 0.0));
        double here = table_cost(f->pack, r, ff_v2(0.2, 0.0));
        if (ahead > 60.0) continue; /* ends with its feet so that little may follow */
        ++seen;
        assert_true(here == 0.0);
        assert_true(ahead >= 3.3525 * (3.5 - 0.35 - 0.071) && behind > ahead + 1.0);
    }
    assert_true(seen >= 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_gets_anywhere_for_less),
        cmocka_unit_test(at_other_speeds_it_costs_no_less_than_the_set_says),
        cmocka_unit_test(straight_on_costs_what_walking_costs_and_turning_round_costs_more),
    };
    return cmocka_run_group_tests(tests, open_pack, close_pack);
}
