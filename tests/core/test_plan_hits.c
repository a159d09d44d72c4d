/* Collisions of colliders that move: against looking again and again. */
#define _GNU_SOURCE
#include "tests/core/plan_world.h"

#include "runtime/core/crowd/crowd_footsteps.h"
#include "runtime/core/plan/plan_body.h"
#include "runtime/core/plan/plan_hit.h"

#include <stdio.h>

static double between(double low, double high, ff_random *random)
{
    return ff_random_range(random, low, high);
}

static ff_knot random_knot(ff_random *random, double at, double spread)
{
    static const double height[FF_COLLIDER_COUNT] = {1.65, 0.85, 0.85, 0.06, 0.06, 0.95};
    ff_knot knot;
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i) {
        knot.a[i] = (float)(at + between(-spread, spread, random));
        knot.b[i] = (float)between(-spread, spread, random);
        knot.y[i] = (float)(height[i] + between(-0.1, 0.3, random));
    }
    return knot;
}

/* Smallest gap (m, radii taken off) of any two colliders that share a height, looked for at two hundred moments. */
static double smallest_gap(const ff_knot *x0, const ff_knot *x1, const ff_knot *y0, const ff_knot *y1,
                           ff_vec2 apart)
{
    double least = INFINITY;
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i)
        for (int k = 0; k < FF_COLLIDER_COUNT; ++k) {
            float low[2][2], high[2][2];
            ff_collider_extent((uint32_t)i, x0->y[i], &low[0][0], &high[0][0]);
            ff_collider_extent((uint32_t)i, x1->y[i], &low[0][1], &high[0][1]);
            ff_collider_extent((uint32_t)k, y0->y[k], &low[1][0], &high[1][0]);
            ff_collider_extent((uint32_t)k, y1->y[k], &low[1][1], &high[1][1]);
            if (fminf(low[0][0], low[0][1]) > fmaxf(high[1][0], high[1][1]) ||
                fminf(low[1][0], low[1][1]) > fmaxf(high[0][0], high[0][1]))
                continue;
            for (int t = 0; t <= 200; ++t) {
                double s = t / 200.0;
                double a =
                    ff_lerp((double)y0->a[k] - (double)x0->a[i], (double)y1->a[k] - (double)x1->a[i], s) +
                    apart.a;
                double b =
                    ff_lerp((double)y0->b[k] - (double)x0->b[i], (double)y1->b[k] - (double)x1->b[i], s) +
                    apart.b;
                double gap =
                    sqrt(a * a + b * b) - (double)ff_collider_radius[i] - (double)ff_collider_radius[k];
                least = ff_min(least, gap);
            }
        }
    return least;
}

/* Do any two meet, each pair looked at by itself? */
static bool any_pair_hits(const ff_knot *x0, const ff_knot *x1, const ff_knot *y0, const ff_knot *y1,
                          ff_vec2 apart, const ff_limits *limits)
{
    bool any = false;
    for (uint8_t i = 0; i < FF_COLLIDER_COUNT; ++i)
        for (uint8_t k = 0; k < FF_COLLIDER_COUNT; ++k) {
            const float from[3] = {x0->a[i], x0->b[i], x0->y[i]}, to[3] = {x1->a[i], x1->b[i], x1->y[i]};
            any |=
                ff_colliders_hit((ff_touch){i, k}, from, to, y0, y1, (float)apart.a, (float)apart.b, limits);
        }
    return any;
}

static void colliders_that_pass_are_seen_between_the_moments(void **state)
{
    (void)state;
    ff_random random = {2, 0, 0};
    int hits = 0, between_only = 0;
    for (int n = 0; n < 400; ++n) {
        ff_knot x0 = random_knot(&random, 0.0, 0.3), x1 = random_knot(&random, 0.0, 0.3);
        ff_knot y0 = random_knot(&random, between(-2.0, 2.0, &random), 0.3),
                y1 = random_knot(&random, between(-2.0, 2.0, &random), 0.3);
        ff_vec2 apart = ff_v2(between(-0.5, 0.5, &random), between(-1.5, 1.5, &random));
        double margin = n % 2 ? 0.05 : 0.0, gap = smallest_gap(&x0, &x1, &y0, &y1, apart);
        if (fabs(gap - margin) < 2e-3) continue;
        ff_limits limits = ff_limits_of(ff_collider_radius, ff_collider_radius, (float)margin);
        bool hit = ff_knots_hit(&x0, &x1, &y0, &y1, (float)apart.a, (float)apart.b, &limits);
        assert_int_equal(hit, gap < margin);
        assert_int_equal(hit, any_pair_hits(&x0, &x1, &y0, &y1, apart, &limits));
        /* The other way round it is the same. */
        assert_int_equal(hit, ff_knots_hit(&y0, &y1, &x0, &x1, (float)-apart.a, (float)-apart.b, &limits));
        float reach =
            fmaxf(ff_knot_radius(&x0, ff_collider_radius), ff_knot_radius(&x1, ff_collider_radius)) +
            fmaxf(ff_knot_radius(&y0, ff_collider_radius), ff_knot_radius(&y1, ff_collider_radius));
        ff_touch touch = {0, 0};
        assert_int_equal(hit, ff_bodies_hit(&x0, &x1, &y0, &y1, (float)apart.a, (float)apart.b, 9.0f, 9.0f,
                                            &limits, &touch));
        const float from[3] = {x0.a[touch.mine], x0.b[touch.mine], x0.y[touch.mine]},
                    to[3] = {x1.a[touch.mine], x1.b[touch.mine], x1.y[touch.mine]};
        if (hit)
            assert_true(ff_colliders_hit(touch, from, to, &y0, &y1, (float)apart.a, (float)apart.b, &limits));
        if (hit)
            assert_true(
                ff_roots_near(&x0, &x1, &y0, &y1, (float)apart.a, (float)apart.b, reach + (float)margin));
        hits += hit;
        between_only += hit && !ff_knots_hit(&x0, &x0, &y0, &y0, (float)apart.a, (float)apart.b, &limits) &&
                        !ff_knots_hit(&x1, &x1, &y1, &y1, (float)apart.a, (float)apart.b, &limits);
    }
    printf("  %d hits, %d of them between the moments alone\n", hits, between_only);
    assert_true(hits > 100 && between_only > 20);
}

/* Distance of a point to a shape's footprint without its radius. */
static double point_distance(const ff_shape *shape, ff_vec2 p)
{
    ff_vec2 local = ff_to_frame2(ff_fwd2(shape->heading), ff_sub2(p, shape->centre));
    double a = ff_max(fabs(local.a) - shape->half_length, 0.0),
           b = ff_max(fabs(local.b) - shape->half_width, 0.0);
    return sqrt(a * a + b * b);
}

static void segments_are_as_far_from_shapes_as_their_nearest_point(void **state)
{
    (void)state;
    ff_random random = {3, 0, 0};
    for (int n = 0; n < 3000; ++n) {
        ff_shape shape = {.centre = ff_v2(between(-1.0, 1.0, &random), between(-1.0, 1.0, &random)),
                          .heading = between(-FF_PI, FF_PI, &random),
                          .half_length = n % 3 ? between(0.0, 1.0, &random) : 0.0,
                          .half_width = n % 3 == 1 ? between(0.0, 1.0, &random) : 0.0,
                          .high = 2.0};
        ff_vec2 p = ff_v2(between(-3.0, 3.0, &random), between(-3.0, 3.0, &random)),
                q = ff_madd2(p, ff_fwd2(between(-FF_PI, FF_PI, &random)), between(0.0, 2.0, &random));
        ff_solid solid = ff_solid_of_shape(&shape);
        double least = INFINITY;
        for (int t = 0; t <= 400; ++t)
            least = ff_min(least, point_distance(&shape, ff_madd2(p, ff_sub2(q, p), t / 400.0)));
        FF_ASSERT_NEAR(sqrt(ff_solid_distance2(&solid, p, q)), least, 6e-3);
    }
}

/* Only the head, at a height, 1 m ahead; everything else far away. */
static ff_knot head_at(double a, double y)
{
    ff_knot knot;
    for (int i = 0; i < FF_COLLIDER_COUNT; ++i) {
        knot.a[i] = i == FF_COLLIDER_HEAD ? (float)a : 50.0f;
        knot.b[i] = 0.0f;
        knot.y[i] = (float)y;
    }
    return knot;
}

static void heights_and_round_tops_count(void **state)
{
    (void)state;
    ff_vec2 none = ff_v2(0.0, 0.0);
    ff_knot tall = head_at(1.0, 1.7),
            small = head_at(1.0, 1.0); /* solid from 1.55 to 1.82 and 0.85 to 1.12 */
    ff_shape box = {
        .centre = ff_v2(1.0, 0.0), .half_length = 0.2, .half_width = 0.2, .low = 1.3, .high = 1.6};
    ff_solid bar = ff_solid_of_shape(&box);
    assert_true(ff_solid_hit(&bar, none, none, &tall, &tall, ff_collider_radius, 0.0));
    assert_false(ff_solid_hit(&bar, none, none, &small, &small, ff_collider_radius, 0.0));
    assert_true(ff_solid_hit(&bar, none, none, &tall, &small, ff_collider_radius, 0.0)); /* on the way down */
    /* A ball of 0.5 m whose middle is at 1.0 m: at 1.4 m above it, sqrt(0.25 - 0.16) = 0.3 m wide. */
    ff_shape ball = {.centre = none, .radius = 0.5, .low = 0.5, .high = 1.5, .round = 1};
    ff_solid globe = ff_solid_of_shape(&ball);
    ff_knot over = head_at(0.43, 1.55), beside = head_at(0.41, 1.55); /* lowest at 1.40; radius 0.12 */
    assert_false(ff_solid_hit(&globe, none, none, &over, &over, ff_collider_radius, 0.0));
    assert_true(ff_solid_hit(&globe, none, none, &beside, &beside, ff_collider_radius, 0.0));
    /* One that comes along meets who stands. */
    ff_solid disc = ff_solid_of_shape(&(ff_shape){.centre = ff_v2(1.0, -3.0), .radius = 0.1, .high = 2.0});
    assert_false(ff_solid_hit(&disc, none, none, &tall, &tall, ff_collider_radius, 0.0));
    assert_true(ff_solid_hit(&disc, ff_v2(0.0, 6.0), none, &tall, &tall, ff_collider_radius, 0.0));
}

/* The track of a plan in words of its definition. */
static void a_track_runs_straight_between_where_the_colliders_are(void **state)
{
    const plan_world *w = *state;
    ff_plan plan;
    ff_track track;
    ff_plan_stand(w->set, ff_v2(500.0, -300.0), 0.4, 11.03, &plan);
    const ff_plan_world world = {0};
    ff_plan_goal goal = ff_plan_goal_at(ff_v2(504.0, -299.0));
    ff_plan_options options = ff_plan_options_default();
    ff_plan_search(w->set, &world, &plan, 11.7, &goal, &options, w->scratch, &plan);
    ff_plan_track(w->set, &plan, 11.7, &track);
    for (uint32_t k = 0; k < track.count; ++k) {
        ff_vec3 at[FF_COLLIDER_COUNT];
        ff_plan_colliders(w->set, &plan, (double)(track.first + (int64_t)k) * FF_TRACK_STEP, at);
        for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
            FF_ASSERT_NEAR(track.origin.a + (double)track.knots[k].a[c], at[c].x, 1e-5);
            FF_ASSERT_NEAR(track.origin.b + (double)track.knots[k].b[c], at[c].y, 1e-5);
            FF_ASSERT_NEAR((double)track.knots[k].y[c], at[c].z, 1e-5);
        }
    }
    /* Colliders do not jump where actions join, and feet that stand, stand. */
    ff_vec3 last[FF_COLLIDER_COUNT], at[FF_COLLIDER_COUNT];
    ff_plan_colliders(w->set, &plan, 11.5, last);
    for (double t = 11.505; t < plan.steps[plan.count - 1].start + 1.0; t += 0.005) {
        ff_plan_colliders(w->set, &plan, t, at);
        for (int c = 0; c < FF_COLLIDER_COUNT; ++c)
            FF_ASSERT_BELOW(ff_length2(ff_v2(at[c].x - last[c].x, at[c].y - last[c].y)), 0.04);
        memcpy(last, at, sizeof last);
    }
    for (uint32_t i = 1; i + 1 < plan.count; ++i) {
        ff_footprint print = ff_plan_landing(w->set, &plan.steps[i]);
        const ff_pack_action *next = ff_action_set_record(w->set, plan.steps[i + 1].action);
        if (plan.steps[i + 1].hold ||
            next->support != ff_action_set_record(w->set, plan.steps[i].action)->swing)
            continue;
        FF_ASSERT_BELOW(ff_length2(ff_sub2(print.ball, plan.steps[i + 1].anchor)), 1e-9);
    }
}

static void two_tracks_conflict_exactly_where_they_touch(void **state)
{
    const plan_world *w = *state;
    int conflicts = 0, free_ones = 0;
    for (int n = 0; n < 60; ++n) {
        ff_random random = {29, (uint64_t)n, 0};
        ff_plan plan[2];
        ff_track track[2];
        ff_plan_options options = ff_plan_options_default();
        options.inflation_step = 0.0;
        const ff_plan_world world = {0};
        for (int i = 0; i < 2; ++i) {
            ff_vec2 from = ff_v2(i ? 3.0 : -3.0, between(-0.8, 0.8, &random));
            ff_plan_stand(w->set, from, i ? FF_PI : 0.0, between(0.0, 0.4, &random), &plan[i]);
            ff_plan_goal goal = ff_plan_goal_at(ff_v2(-from.a, between(-0.8, 0.8, &random)));
            ff_plan_search(w->set, &world, &plan[i], 0.5, &goal, &options, w->scratch, &plan[i]);
            ff_plan_track(w->set, &plan[i], 0.0, &track[i]);
        }
        double least = INFINITY;
        ff_vec2 apart = ff_sub2(track[1].origin, track[0].origin);
        for (int64_t k = 0; k < FF_TRACK_KNOTS_MAX; ++k) {
            const ff_knot *x[2], *y[2];
            for (int i = 0; i < 2; ++i) {
                int64_t p = k + i - track[0].first, q = k + i - track[1].first;
                x[i] = &track[0].knots[p < track[0].count ? p : track[0].count - 1];
                y[i] = &track[1].knots[q < track[1].count ? q : track[1].count - 1];
            }
            least = ff_min(least, smallest_gap(x[0], x[1], y[0], y[1], apart));
        }
        if (fabs(least) < 2e-3) continue;
        double when = -1.0;
        bool conflict = ff_track_conflict(&track[0], &track[1], 0.0, 0.0, &when);
        assert_int_equal(conflict, least < 0.0);
        if (conflict) assert_true(when >= 0.0 && when < 10.0);
        conflicts += conflict;
        free_ones += !conflict;
    }
    printf("  %d pairs met, %d did not\n", conflicts, free_ones);
    assert_true(conflicts >= 10 && free_ones >= 10);
}

/* A character with a large head, by the pack's own measure of its skin, is kept from others and walls by it. */
static void the_packs_own_radii_count(void **state)
{
    const plan_world *w = *state;
    const float large[FF_COLLIDER_COUNT] = {0.5f, 0.08f, 0.08f, 0.11f, 0.11f, 0.18f};
    ff_pack dressed = *w->pack;
    dressed.collider_radii = large;
    ff_action_set *set;
    ff_error error;
    FF_ASSERT_OK(ff_action_set_create(&dressed, 24, &set, &error), error);
    for (int big = 0; big < 2; ++big) {
        const ff_action_set *of = big ? set : w->few;
        ff_plan plan[2];
        ff_track track[2];
        for (int i = 0; i < 2; ++i) {
            ff_plan_stand(of, ff_v2(0.9 * i, 0.0), 0.0, 0.0, &plan[i]);
            ff_plan_track(of, &plan[i], 0.0, &track[i]);
        }
        assert_int_equal(ff_track_conflict(&track[0], &track[1], 0.0, 0.0, NULL), big);
        const ff_shape post = {.centre = {-0.5, 0.0}, .radius = 0.05, .high = 2.0};
        assert_int_equal(ff_track_meets(&track[0], 0.0, 1.0, &post, ff_v2(0.0, 0.0), 0.0, NULL), big);
    }
    ff_action_set_destroy(set);
}

static void jumps_and_ducks_are_thought_of_only_when_asked_for(void **state)
{
    const plan_world *w = *state;
    uint32_t action = 0;
    while (action < w->set->count && w->set->actions[action].next_count == w->set->actions[action].step_count)
        ++action;
    assert_true(action < w->set->count);
    const ff_set_action *a = &w->set->actions[action];
    ff_plan start, plan;
    memset(&start, 0, sizeof start);
    start.count = 2;
    start.steps[0] = (ff_plan_step){.action = action};
    start.steps[1] = (ff_plan_step){.action = action, .start = (double)a->duration, .hold = 1};
    start.from = start.steps[0];
    const ff_plan_world world = {0};
    ff_plan_goal goal = ff_plan_goal_at(ff_v2(5.0, 0.0));
    ff_plan_options options = ff_plan_options_default();
    options.nodes = 1;
    uint32_t steps =
        ff_plan_search(w->set, &world, &start, 0.1, &goal, &options, w->scratch, &plan).generated;
    options.reactive = FF_EVADE_JUMP | FF_EVADE_DUCK;
    uint32_t all = ff_plan_search(w->set, &world, &start, 0.1, &goal, &options, w->scratch, &plan).generated;
    assert_int_equal(all - steps, a->next_count - a->step_count);
}

static void bodies_of_capsules_are_where_their_colliders_are(void **state)
{
    const plan_world *w = *state;
    ff_plan plan;
    ff_error error;
    ff_plan_stand(w->set, ff_v2(20.0, 5.0), 1.0, 0.0, &plan);
    const ff_plan_world world = {0};
    ff_plan_goal goal = ff_plan_goal_at(ff_v2(17.0, 6.0));
    ff_plan_options options = ff_plan_options_default();
    ff_plan_search(w->set, &world, &plan, 0.0, &goal, &options, w->scratch, &plan);
    for (double t = 0.0; t < plan.steps[plan.count - 1].start + 0.5; t += 0.07) {
        uint32_t step = ff_plan_step_at(&plan, t);
        if (!plan.steps[step].hold && t - plan.steps[step].start < 0.2)
            continue; /* joins move colliders one by one */
        ff_body_capsule body[FF_BODY_CAPSULES];
        ff_vec3 at[FF_COLLIDER_COUNT];
        FF_ASSERT_OK(ff_plan_body_at(w->set, &plan, t, body, &error), error);
        ff_plan_colliders(w->set, &plan, t, at);
        /* A foot is led from where it stood all the way to where it lands. */
        bool led = !plan.steps[step].hold && t < ff_plan_step_end(&plan, step) - FF_TRACK_STEP;
        for (int c = 0; c < (led ? FF_COLLIDER_FOOT_L : FF_COLLIDER_ROOT); ++c) {
            ff_vec3 there = ff_ground(ff_v2(at[c].x, at[c].y), at[c].z);
            double nearest = INFINITY;
            for (int i = 0; i < FF_BODY_CAPSULES; ++i)
                for (int k = 0; k <= 10; ++k)
                    nearest = ff_min(
                        nearest, ff_length3(ff_sub3(ff_lerp3(body[i].from, body[i].to, k / 10.0), there)));
            FF_ASSERT_BELOW(nearest, 0.06); /* a tenth of a second between samples of the colliders */
        }
    }
}

static void bodies_that_stand_are_as_far_apart_as_they_should(void **state)
{
    const plan_world *w = *state;
    ff_error error;
    double last = -INFINITY;
    for (int n = 0; n <= 10; ++n) {
        ff_plan x, y;
        ff_plan_stand(w->set, ff_v2(0.0, 0.0), 0.0, 0.0, &x);
        ff_plan_stand(w->set, ff_v2(0.2 + 0.2 * n, 0.0), FF_PI, 0.0, &y);
        double gap, when;
        FF_ASSERT_OK(ff_plan_bodies_gap(w->set, &x, &y, 1.0, 1.5, &gap, &when, &error), error);
        assert_true(gap > last);
        if (n == 0) assert_true(gap < 0.0);
        if (n > 0 && n < 10) assert_true(gap < 0.2 + 0.2 * n && gap > 0.2 * n - 0.5);
        last = gap;
    }
}

static void plans_that_are_free_keep_bodies_apart(void **state)
{
    const plan_world *w = *state;
    int met = 0, pairs = 0;
    double deepest = 0.0;
    for (int n = 0; n < 30; ++n) {
        ff_random random = {53, (uint64_t)n, 0};
        ff_plan plan[2];
        ff_track track;
        ff_error error;
        ff_plan_options options = ff_plan_options_default();
        const ff_track *seen[1] = {&track};
        for (int i = 0; i < 2; ++i) {
            ff_plan_stand(w->set, ff_v2(i ? 2.5 : -2.5, 0.0), i ? FF_PI : 0.0, 0.0, &plan[i]);
            ff_plan_goal goal = ff_plan_goal_at(ff_v2(i ? -2.5 : 2.5, between(-0.5, 0.5, &random)));
            const ff_plan_world world = {.tracks = seen, .track_count = (uint32_t)i};
            ff_plan_search(w->set, &world, &plan[i], 0.0, &goal, &options, w->scratch, &plan[i]);
            if (i == 0) ff_plan_track(w->set, &plan[0], 0.0, &track);
        }
        double gap, when;
        FF_ASSERT_OK(ff_plan_bodies_gap(w->set, &plan[0], &plan[1], 0.0, 8.0, &gap, &when, &error), error);
        ++pairs;
        met += gap < 0.0;
        deepest = ff_max(deepest, -gap);
    }
    printf("  %d of %d pairs' bodies touch, at most %.1f cm\n", met, pairs, 100.0 * deepest);
    assert_true(met <= 3);
    FF_ASSERT_BELOW(deepest, 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colliders_that_pass_are_seen_between_the_moments),
        cmocka_unit_test(segments_are_as_far_from_shapes_as_their_nearest_point),
        cmocka_unit_test(heights_and_round_tops_count),
        cmocka_unit_test(a_track_runs_straight_between_where_the_colliders_are),
        cmocka_unit_test(two_tracks_conflict_exactly_where_they_touch),
        cmocka_unit_test(bodies_of_capsules_are_where_their_colliders_are),
        cmocka_unit_test(bodies_that_stand_are_as_far_apart_as_they_should),
        cmocka_unit_test(plans_that_are_free_keep_bodies_apart),
        cmocka_unit_test(the_packs_own_radii_count),
        cmocka_unit_test(jumps_and_ducks_are_thought_of_only_when_asked_for),
    };
    return cmocka_run_group_tests(tests, plan_world_open, plan_world_close);
}
