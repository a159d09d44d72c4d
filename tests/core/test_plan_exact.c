/* The search against a search of everything: 200 small worlds in which all sequences of actions can be tried. */
#define _GNU_SOURCE
#include "tests/core/plan_world.h"

#include "runtime/core/plan/plan_sight.h"

#include <stdio.h>

enum { PROBLEMS = 200, DEPTH = 4, VARIED_DEPTH = 3, OTHERS = 6 };

typedef struct problem {
    const ff_action_set *set;
    ff_plan_world world;
    ff_plan start;
    ff_plan_goal goal;
    ff_plan_options options;
    ff_solids *solids;
    const ff_track *list[OTHERS];
} problem;

static ff_plan other_plans[OTHERS];
static ff_track other_tracks[OTHERS];

static void make_problem(const plan_world *w, int number, problem *p)
{
    ff_random random = {31, (uint64_t)number, 0};
    memset(p, 0, sizeof *p);
    /* One in eight has walking steps at three speeds. */
    p->set = number % 8 == 7 ? w->varied : w->few;
    double time = ff_random_range(&random, 0.0, 100.0);
    ff_plan_stand(p->set, ff_v2(0.0, 0.0), ff_random_range(&random, -0.4, 0.4), time - 1.0, &p->start);
    p->goal = ff_plan_goal_at(
        ff_scale2(ff_fwd2(ff_random_range(&random, -0.5, 0.5)), ff_random_range(&random, 0.7, 1.6)));
    p->goal.stand = number % 4 == 0;
    p->goal.latest = time; /* kept here; see solve */
    if (number % 2) p->solids = plan_things(&random, 0.6, 2.2, number % 4 == 1 ? 3 : 6);
    p->world.solids = p->solids;
    if (number % 3 == 0)
        p->world.track_count = plan_others(w, &random, 3.0, OTHERS, time, other_plans, other_tracks, p->list);
    /* Nobody stands where the search begins. */
    ff_track own;
    ff_plan_track(p->set, &p->start, time, &own);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < p->world.track_count; ++i)
        if (!ff_track_conflict(&own, p->list[i], time, 0.1, NULL)) p->list[kept++] = p->list[i];
    p->world.track_count = kept;
    p->world.tracks = p->list;
    p->options = ff_plan_options_default();
    p->options.nodes = p->options.improve = 40000;
    p->options.horizon = p->set == w->varied ? VARIED_DEPTH : DEPTH;
    p->options.time_horizon = 0.0;
    p->options.inflation = 1.0;
    p->options.inflation_step = 0.0;
    p->options.table = p->options.merge = 0;
    p->options.lazy = number % 5 != 0;
}

static double problem_time(const problem *p)
{
    return p->goal.latest;
}

static ff_plan_result solve(const plan_world *w, const problem *p, ff_plan *out)
{
    ff_plan_goal goal = p->goal;
    goal.latest = INFINITY;
    *out = p->start;
    return ff_plan_search(p->set, &p->world, &p->start, problem_time(p), &goal, &p->options,
                          p->set == w->varied ? w->varied_scratch : w->few_scratch, out);
}

/* ------------------------------------------------------------------------------------------------ trying everything */

/* Where an agent is, in doubles and by the pack's records. */
typedef struct place {
    ff_vec2 ball, anchor;
    double heading, time;
    uint32_t action;
    bool hold;
} place;

static ff_vec2 placed(ff_vec2 origin, double heading, const float *at)
{
    return ff_add2(origin, ff_from_frame2(ff_fwd2(heading), ff_v2((double)at[0], (double)at[1])));
}

static ff_vec2 root_of(const problem *p, const place *at)
{
    const ff_pack_action *r = ff_action_set_record(p->set, at->action);
    return placed(at->anchor, at->heading - (double)r->theta, r->root_end);
}

static place after(const problem *p, const place *at, const ff_set_next *next)
{
    const ff_pack_action *last = ff_action_set_record(p->set, at->action);
    const ff_pack_action *r = ff_action_set_record(p->set, next->action);
    ff_vec2 origin = r->support == last->swing ? at->ball : at->anchor;
    return (place){placed(origin, at->heading, r->land),
                   origin,
                   at->heading + (double)r->theta,
                   at->time + (double)r->duration / ff_action_set_pace(p->set, next->action),
                   next->action,
                   false};
}

static void stance_at(const problem *p, ff_sight *sight, const place *at, ff_stance *out)
{
    (void)p;
    ff_vec2 ball = ff_sub2(at->ball, sight->origin), other = ff_sub2(at->anchor, sight->origin);
    const ff_set_action *a = &p->set->actions[at->action];
    ff_vec2 now = ff_fwd2(at->heading), then = ff_fwd2(at->heading - (double)a->theta);
    *out = (ff_stance){.at = {(float)ball.a, (float)ball.b},
                       .other = {(float)other.a, (float)other.b},
                       .cosine = (float)now.a,
                       .sine = (float)now.b,
                       .time = (float)(at->time - (double)sight->first_knot * FF_TRACK_STEP),
                       .action = (uint16_t)at->action,
                       .hold = at->hold};
    ff_stance_begin(sight, (float)then.a, (float)then.b, out);
}

/* May one come to stand from here, by the ways of the set, and stay? */
static bool stops(const problem *p, ff_sight *sight, const place *at)
{
    const ff_set_action *a = &p->set->actions[at->action];
    ff_stance stance;
    stance_at(p, sight, at, &stance);
    if ((a->flags & FF_SET_TO_STANDING) && ff_stance_waits(sight, &stance, INFINITY)) return true;
    for (uint32_t k = 0; k < a->stop_count; ++k) {
        const ff_set_stop *stop = &p->set->stops[a->first_stop + k];
        place here = *at;
        bool good = true;
        for (int i = 0; i < 2 && good && stop->next[i] != FF_SET_NO_STOP; ++i) {
            const ff_set_next *next = &p->set->next[p->set->actions[here.action].first_next + stop->next[i]];
            stance_at(p, sight, &here, &stance);
            good = ff_stance_free(sight, &stance, next, NULL);
            here = after(p, &here, next);
        }
        stance_at(p, sight, &here, &stance);
        if (good && ff_stance_waits(sight, &stance, INFINITY)) return true;
    }
    return false;
}

typedef struct tried {
    double best;
    long sequences;
} tried;

static void try_all(const problem *p, ff_sight *sight, const place *at, int depth, double cost, tried *out)
{
    const ff_set_action *a = &p->set->actions[at->action];
    ++out->sequences;
    bool there = ff_length2(ff_sub2(root_of(p, at), p->goal.at)) <= p->goal.radius;
    if (there && (!p->goal.stand || (a->flags & FF_SET_TO_STANDING)) && cost < out->best &&
        stops(p, sight, at))
        out->best = cost;
    if (depth == 0) return;
    ff_stance stance;
    stance_at(p, sight, at, &stance);
    for (uint32_t k = 0; k < a->step_count; ++k) {
        const ff_set_next *next = &p->set->next[a->first_next + k];
        if (!ff_stance_free(sight, &stance, next, NULL)) continue;
        place then = after(p, at, next);
        try_all(p, sight, &then, depth - 1, cost + (double)next->cost, out);
    }
    if ((a->flags & FF_SET_TO_STANDING) && ff_stance_waits(sight, &stance, 0.5f)) {
        place then = *at;
        then.time += 0.5;
        then.hold = true;
        try_all(p, sight, &then, depth - 1, cost + 0.5 * p->options.wait * FF_E_S, out);
    }
}

static tried best_of_all(const problem *p)
{
    static ff_sight sight;
    const ff_plan_step *step = &p->start.steps[0];
    const ff_pack_action *r = ff_action_set_record(p->set, step->action);
    double time = problem_time(p);
    ff_sight_open(p->set, &p->world, &p->options, step->anchor, time, &sight);
    place start = {placed(step->anchor, step->heading, r->land),
                   step->anchor,
                   step->heading + (double)r->theta,
                   time,
                   step->action,
                   true};
    tried out = {.best = INFINITY};
    try_all(p, &sight, &start, (int)p->options.horizon, 0.0, &out);
    return out;
}

/* --------------------------------------------------------------------------------------------------------- tests */

static void what_costs_least_of_everything_is_found(void **state)
{
    const plan_world *w = *state;
    int solved = 0, blocked = 0, detours = 0, varied = 0;
    long sequences = 0;
    for (int i = 0; i < PROBLEMS; ++i) {
        problem p;
        make_problem(w, i, &p);
        tried all = best_of_all(&p);
        sequences += all.sequences;
        ff_plan plan;
        ff_plan_result result = solve(w, &p, &plan);
        if (all.best < INFINITY) {
            ++solved;
            for (uint32_t k = 0; k < plan.count; ++k)
                varied += !plan.steps[k].hold && ff_action_set_pace(p.set, plan.steps[k].action) != 1.0;
            assert_int_equal(result.outcome, FF_PLAN_REACHED);
            FF_ASSERT_NEAR(result.cost, all.best, 1e-3);
            problem empty = p;
            empty.world = (ff_plan_world){0};
            detours += solve(w, &empty, &plan).cost < result.cost - 0.01;
            for (int k = 0; k < 3; ++k) {
                p.options.inflation = (double[]){1.5, 2.5, 4.0}[k];
                FF_ASSERT_BELOW(solve(w, &p, &plan).cost, p.options.inflation * all.best + 1e-3);
            }
        } else {
            ++blocked;
            assert_int_not_equal(result.outcome, FF_PLAN_REACHED);
        }
        ff_solids_destroy(p.solids);
    }
    printf("  %d solved, %d of them around something, %d cannot be; %ld sequences\n", solved, detours,
           blocked, sequences);
    assert_true(solved >= 100 && detours >= 20 && varied >= 5);
}

static void the_anytime_search_ends_at_the_best_and_its_cost_never_rises(void **state)
{
    const plan_world *w = *state;
    for (int i = 0; i < PROBLEMS; i += 4) {
        problem p;
        make_problem(w, i, &p);
        ff_plan plan;
        double exact = solve(w, &p, &plan).cost, last = INFINITY, bound = INFINITY;
        bool solvable = solve(w, &p, &plan).outcome == FF_PLAN_REACHED;
        p.options.inflation = 4.0;
        p.options.inflation_step = 0.5;
        for (uint32_t nodes = 1; nodes <= 32768; nodes *= 2) {
            p.options.nodes = nodes;
            ff_plan_result result = solve(w, &p, &plan);
            if (result.outcome != FF_PLAN_REACHED) continue;
            FF_ASSERT_BELOW(result.cost, last);
            FF_ASSERT_BELOW(result.inflation, bound);
            FF_ASSERT_BELOW(result.cost, result.inflation * exact + 1e-3);
            last = result.cost;
            bound = result.inflation;
        }
        if (solvable) FF_ASSERT_NEAR(last, exact, 1e-3);
        ff_solids_destroy(p.solids);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_costs_least_of_everything_is_found),
        cmocka_unit_test(the_anytime_search_ends_at_the_best_and_its_cost_never_rises),
    };
    return cmocka_run_group_tests(tests, plan_world_open, plan_world_close);
}
