/* Blending, the semi-procedural clip and running on the built-in pack: what each can do, and nobody notices the change. */
#define _GNU_SOURCE
#include "runtime/core/base/random.h"
#include "runtime/core/gait/synth_state.h"
#include "tests/core/built_in_space.h"
#include "tests/core/walker_pack.h"

#define HZ 60
#define DT (1.0 / HZ)
#define MOST 1200 /* steps of a walk */

typedef struct step {
    ff_vec3 at[FF_JOINT_COUNT];
    ff_quat turn[FF_JOINT_COUNT];
    ff_vec2 root;
    double heading, knee[2]; /* rad; degrees */
    bool planted[2];
    uint32_t way;
} step;
static step steps[MOST];

typedef struct walk {
    ff_gait gait;
    ff_vec2 position;
    double heading;
    ff_rates rates;
} walk;

static walk begin(uint64_t variation)
{
    walk w = {.heading = 0.0};
    ff_gait_init(space, &w.gait, w.position, w.heading, variation);
    return w;
}

static double towards(double now, double wanted, double most)
{
    return now + ff_clamp(wanted - now, -most, most);
}

/* One step towards the rates asked for, as far as its way of moving allows and no faster than people do. */
static void go(walk *w, ff_rates asked)
{
    ff_rates to = ff_gait_clamp(space, &w->gait, asked);
    w->rates.forward = towards(w->rates.forward, to.forward, 2.0 * DT);
    w->rates.left = towards(w->rates.left, to.left, 2.0 * DT);
    w->rates.turn = towards(w->rates.turn, to.turn, 4.0 * DT);
    w->rates = ff_gait_clamp(space, &w->gait, w->rates);
    ff_vec2 ahead = ff_fwd2(w->heading + 0.5 * w->rates.turn * DT);
    w->position = ff_madd2(w->position, ff_from_frame2(ahead, ff_v2(w->rates.forward, w->rates.left)), DT);
    w->heading += w->rates.turn * DT;
    ff_gait_step(space, &w->gait, w->position, w->heading, w->rates, DT);
}

static void look(const walk *w, step *out)
{
    ff_vec3 hips;
    ff_quat world[FF_JOINT_COUNT];
    ff_gait_pose(space, &w->gait, w->position, w->heading, &hips, out->turn);
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        int parent = ff_joint_parents[j];
        world[j] = parent < 0 ? out->turn[j] : ff_quat_mul(world[parent], out->turn[j]);
        out->at[j] = parent < 0
                         ? hips
                         : ff_add3(out->at[parent], ff_quat_rotate(world[parent], space->body.offset[j]));
    }
    for (int foot = 0; foot < 2; ++foot) {
        const ff_vec3 *hip = &out->at[FF_JOINT_HIP_L + foot * FF_JOINT_LEG_STRIDE];
        ff_vec3 thigh = ff_unit3(ff_sub3(hip[1], hip[0])), shank = ff_unit3(ff_sub3(hip[2], hip[1]));
        out->knee[foot] = ff_acos(ff_dot3(thigh, shank)) / FF_DEG;
        out->planted[foot] = ff_gait_planted(&w->gait, foot) != 0;
    }
    out->root = w->position;
    out->heading = w->heading;
    out->way = w->gait.blend.way;
}

static ff_vec3 ball_of(const step *s, int foot)
{
    return s->at[FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE];
}

/* A walk by one way at constant rates; returns the number of steps. */
static int record(ff_locomotion way, ff_rates rates, double seconds, uint64_t variation)
{
    walk w = begin(variation);
    int count = (int)(seconds * HZ);
    for (int i = 0; i < count; ++i) {
        ff_gait_want(space, &w.gait, way, false);
        go(&w, rates);
        look(&w, &steps[i]);
    }
    return count;
}

/* Largest second difference of a knee's bend, 1000 degrees per s2. */
static double knee_jerk(int count)
{
    double worst = 0.0;
    for (int i = 2; i < count; ++i)
        for (int foot = 0; foot < 2; ++foot)
            worst = ff_max(
                worst, fabs(steps[i].knee[foot] - 2.0 * steps[i - 1].knee[foot] + steps[i - 2].knee[foot]));
    return worst * HZ * HZ * 1e-3;
}

/* How far a planted ball moves in any step. */
static double slide(int count)
{
    double worst = 0.0;
    for (int i = 1; i < count; ++i)
        for (int foot = 0; foot < 2; ++foot)
            if (steps[i].planted[foot] && steps[i - 1].planted[foot])
                worst = ff_max(worst, ff_length2(ff_plane(
                                          ff_sub3(ball_of(&steps[i], foot), ball_of(&steps[i - 1], foot)))));
    return worst;
}

static double fastest_trunk(int count)
{
    double worst = 0.0;
    for (int i = 1; i < count; ++i)
        for (int j = FF_JOINT_SPINE; j < FF_JOINT_HIP_L; ++j)
            worst = ff_max(worst,
                           ff_quat_angle(ff_quat_mul(ff_quat_conj(steps[i - 1].turn[j]), steps[i].turn[j])));
    return worst * HZ / FF_DEG;
}

/* ------------------------------------------------------------------------------------- the semi-procedural clip */

static void the_clip_does_whatever_is_asked_within_its_limits(void **state)
{
    (void)state;
    ff_random random = {1, 2, 0};
    double most = space->model.fastest;
    for (int i = 0; i < 20000; ++i) {
        ff_rates asked = {ff_random_range(&random, -3.0, 3.0), ff_random_range(&random, -1.5, 1.5),
                          ff_random_range(&random, -4.0, 4.0)};
        ff_rates got = ff_locomotion_clamp(space, FF_SEMI_PROCEDURAL, asked);
        double f = asked.forward / (asked.forward < 0.0 ? FF_MODEL_BACKWARD : most),
               l = asked.left / FF_MODEL_SIDEWAYS;
        bool inside = f * f + l * l <= 1.0;
        if (inside) FF_ASSERT_NEAR(got.forward, asked.forward, 1e-12);
        if (inside) FF_ASSERT_NEAR(got.left, asked.left, 1e-12);
        /* Where one goes is kept, how fast is not. */
        FF_ASSERT_NEAR(got.forward * asked.left, got.left * asked.forward, 1e-9);
        assert_true(got.forward * asked.forward >= 0.0 && got.turn * asked.turn >= 0.0);
        FF_ASSERT_BELOW(fabs(got.turn), 135.0 * FF_DEG + 1e-9);
        if (sqrt(got.forward * got.forward + got.left * got.left) > 0.95)
            FF_ASSERT_BELOW(fabs(got.turn), 90.0 * FF_DEG + 1e-9);
    }
}

/* The speed of the body as its footprints tell it, in its own frame, and its turn rate: the mean over strides, from one plant
 * of the left foot to the next. */
static int footprints(int from, int count, ff_rates *out)
{
    int last = -1, strides = 0;
    ff_rates sum = {0.0, 0.0, 0.0};
    double seconds = 0.0;
    for (int i = from + 1; i < count; ++i) {
        if (!steps[i].planted[0] || steps[i - 1].planted[0]) continue;
        if (last >= 0) {
            const step *p = &steps[last], *q = &steps[i];
            double turned = q->heading - p->heading, half = 0.5 * turned;
            double chord = fabs(half) > 1e-6 ? sin(half) / half : 1.0;
            /* A foot beside the root goes a way of its own when that turns: how it is carried round is taken away. */
            ff_vec2 off = ff_to_frame2(ff_fwd2(p->heading), ff_sub2(ff_plane(ball_of(p, 0)), p->root));
            ff_vec2 carried =
                ff_sub2(ff_from_frame2(ff_fwd2(half), off), ff_from_frame2(ff_fwd2(-half), off));
            ff_vec2 moved =
                ff_to_frame2(ff_fwd2(p->heading + half), ff_plane(ff_sub3(ball_of(q, 0), ball_of(p, 0))));
            sum.forward += (moved.a - carried.a) / chord;
            sum.left += (moved.b - carried.b) / chord;
            sum.turn += turned;
            seconds += (i - last) * DT;
            ++strides;
        }
        last = i;
    }
    if (strides > 0) *out = (ff_rates){sum.forward / seconds, sum.left / seconds, sum.turn / seconds};
    return strides;
}

static void footprints_of_the_clip_follow_the_rates_exactly(void **state)
{
    (void)state;
    static const ff_rates grid[] = {{0.3, 0.0, 0.0},  {0.6, 0.0, 0.0},  {1.0, 0.0, 0.0},  {1.3, 0.0, 0.0},
                                    {1.6, 0.0, 0.0},  {-0.5, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 0.3, 0.0},
                                    {0.0, -0.6, 0.0}, {0.8, 0.3, 0.0},  {0.8, -0.3, 0.0}, {1.2, 0.0, 0.6},
                                    {0.8, 0.0, 1.2},  {0.0, 0.0, 1.5},  {0.5, 0.2, -0.8}};
    for (size_t i = 0; i < sizeof grid / sizeof *grid; ++i) {
        int count = record(FF_SEMI_PROCEDURAL, grid[i], 14.0, i);
        ff_rates got = {0.0, 0.0, 0.0};
        assert_true(footprints(4 * HZ, count, &got) >= 4);
        assert_int_equal(steps[count - 1].way, FF_SEMI_PROCEDURAL);
        FF_ASSERT_BELOW(fabs(got.forward - grid[i].forward), ff_max(0.01 * fabs(grid[i].forward), 0.004));
        FF_ASSERT_BELOW(fabs(got.left - grid[i].left), 0.03);
        FF_ASSERT_BELOW(fabs(got.turn - grid[i].turn), 1.0 * FF_DEG);
    }
}

static void feet_on_the_clip_stand_still_and_knees_do_not_pop(void **state)
{
    (void)state;
    static const ff_rates grid[] = {{0.4, 0.0, 0.0},  {1.3, 0.0, 0.0}, {1.7, 0.0, 0.0}, {-0.8, 0.0, 0.0},
                                    {0.0, 0.45, 0.0}, {0.7, 0.3, 0.0}, {0.9, 0.0, 1.2}, {0.0, 0.0, -1.6}};
    for (size_t i = 0; i < sizeof grid / sizeof *grid; ++i) {
        int count = record(FF_SEMI_PROCEDURAL, grid[i], 8.0, 3 + i);
        FF_ASSERT_BELOW(slide(count), 5e-4);
        FF_ASSERT_BELOW(knee_jerk(count), 30.0);
        for (int k = 0; k < count; ++k) {
            assert_true(steps[k].planted[0] || steps[k].planted[1] || steps[k].at[FF_JOINT_BALL_L].y < 0.12);
            ff_vec3 l = steps[k].at[FF_JOINT_ANKLE_L], r = steps[k].at[FF_JOINT_ANKLE_R];
            FF_ASSERT_BELOW(0.06, ff_length2(ff_plane(ff_sub3(l, r))));
        }
    }
}

static double mean_height(int from, int count)
{
    double sum = 0.0;
    for (int i = from; i < count; ++i)
        sum += steps[i].at[FF_JOINT_HIPS].y;
    return sum / (count - from);
}

static void nobody_crouches_who_goes_slowly_or_turns_on_the_spot(void **state)
{
    (void)state;
    int count = record(FF_SEMI_PROCEDURAL, (ff_rates){0.0, 0.0, 0.0}, 3.0, 1);
    double standing = mean_height(HZ, count);
    count = record(FF_SEMI_PROCEDURAL, (ff_rates){0.3, 0.0, 0.0}, 8.0, 1);
    FF_ASSERT_BELOW(standing - 0.02, mean_height(3 * HZ, count));
    count = record(FF_SEMI_PROCEDURAL, (ff_rates){0.0, 0.0, 1.5}, 8.0, 1);
    FF_ASSERT_BELOW(standing - 0.02, mean_height(3 * HZ, count));
    count = record(FF_SEMI_PROCEDURAL, (ff_rates){1.3, 0.0, 0.0}, 8.0, 1);
    FF_ASSERT_BELOW(mean_height(3 * HZ, count), standing - 0.01);
}

static void side_steps_are_lowest_while_the_feet_are_apart(void **state)
{
    (void)state;
    for (int side = -1; side <= 1; side += 2) {
        int count = record(FF_SEMI_PROCEDURAL, (ff_rates){0.0, 0.6 * side, 0.0}, 8.0, 2), seen[2] = {0, 0};
        double height[2] = {0.0, 0.0};
        for (int i = 3 * HZ; i < count; ++i) {
            ff_vec3 l = steps[i].at[FF_JOINT_ANKLE_L], r = steps[i].at[FF_JOINT_ANKLE_R];
            double apart = ff_length2(ff_plane(ff_sub3(l, r)));
            if (apart > 0.16 && apart < 0.3) continue;
            height[apart >= 0.3] += steps[i].at[FF_JOINT_HIPS].y;
            ++seen[apart >= 0.3];
        }
        assert_true(seen[0] > 20 && seen[1] > 20);
        FF_ASSERT_BELOW(height[1] / seen[1] + 0.015, height[0] / seen[0]);
    }
}

static void side_steps_put_the_pelvis_over_the_standing_foot(void **state)
{
    (void)state;
    for (int side = -1; side <= 1; side += 2) {
        int count = record(FF_SEMI_PROCEDURAL, (ff_rates){0.0, 0.5 * side, 0.0}, 8.0, 2);
        double over[2] = {0.0, 0.0}, lean = 0.0;
        int seen[2] = {0, 0};
        for (int i = 3 * HZ; i < count; ++i) {
            ff_vec2 left = ff_left2(ff_fwd2(steps[i].heading));
            ff_vec3 hips = steps[i].at[FF_JOINT_HIPS], neck = steps[i].at[FF_JOINT_NECK];
            lean += ff_dot2(ff_plane(ff_sub3(neck, hips)), left) / (count - 3 * HZ);
            if (steps[i].planted[0] == steps[i].planted[1]) continue;
            int foot = steps[i].planted[0] ? 0 : 1;
            over[foot] += ff_dot2(ff_sub2(ff_plane(hips), steps[i].root), left);
            ++seen[foot];
        }
        assert_true(seen[0] > 20 && seen[1] > 20);
        /* To the left on the left foot, to the right on the right one; and the trunk leans to where one goes. */
        FF_ASSERT_BELOW(0.015, over[0] / seen[0]);
        FF_ASSERT_BELOW(over[1] / seen[1], -0.015);
        FF_ASSERT_BELOW(0.005, side * lean);
    }
}

/* ------------------------------------------------------------------------------------------------- switches */

/* Walks on for a while, changes at a phase of its cycle, walks on. */
static int switched(ff_rates rates, ff_locomotion from, ff_locomotion to, double when, uint64_t variation)
{
    walk w = begin(variation);
    int count = 9 * HZ;
    for (int i = 0; i < count; ++i) {
        ff_gait_want(space, &w.gait, i * DT < when ? from : to, false);
        go(&w, rates);
        look(&w, &steps[i]);
    }
    assert_int_equal(w.gait.blend.way, to);
    return count;
}

static void a_change_at_any_moment_shows_neither_in_feet_nor_knees_nor_trunk(void **state)
{
    (void)state;
    static const ff_rates courses[] = {{1.2, 0.0, 0.0}, {0.5, 0.0, 0.0}, {1.1, 0.0, 0.5}, {0.0, 0.4, 0.0}};
    for (size_t c = 0; c < sizeof courses / sizeof *courses; ++c) {
        int still = record(FF_SEMI_PROCEDURAL, courses[c], 9.0, 4);
        double usual = fastest_trunk(still);
        still = record(FF_BLENDING, courses[c], 9.0, 4);
        usual = ff_max(usual, fastest_trunk(still));
        for (int k = 0; k < 24; ++k) {
            bool there = k % 2 == 0;
            int count = switched(courses[c], there ? FF_BLENDING : FF_SEMI_PROCEDURAL,
                                 there ? FF_SEMI_PROCEDURAL : FF_BLENDING, 4.0 + k * 0.05, 4);
            FF_ASSERT_BELOW(slide(count), 6e-4);
            FF_ASSERT_BELOW(knee_jerk(count), 30.0);
            /* The study allows 100 degrees per s over the larger of the two motions (section 8). */
            FF_ASSERT_BELOW(fastest_trunk(count), usual + 100.0);
        }
    }
}

static void straight_on_one_changes_within_a_few_steps_of_the_clock_and_only_once(void **state)
{
    (void)state;
    for (int k = 0; k < 20; ++k) {
        walk w = begin(5);
        for (int i = 0; i < 6 * HZ; ++i) {
            bool asked = i * DT >= 4.0 + 0.05 * k;
            ff_gait_want(space, &w.gait, asked ? FF_SEMI_PROCEDURAL : FF_BLENDING, false);
            go(&w, (ff_rates){1.2, 0.0, 0.0});
            if (asked) FF_ASSERT_BELOW(w.gait.waited, 0.25);
        }
        assert_int_equal(w.gait.switches, 1);
        assert_int_equal(w.gait.urgent_switches, 0);
        FF_ASSERT_NEAR(w.gait.seconds[FF_BLENDING] + w.gait.seconds[FF_SEMI_PROCEDURAL], 6.0, 1e-9);
    }
}

static void a_request_taken_back_changes_nothing(void **state)
{
    (void)state;
    walk w = begin(6), plain = begin(6);
    for (int i = 0; i < 5 * HZ; ++i) {
        /* Running is asked for at a walk: there is no moment for it. */
        ff_gait_want(space, &w.gait, i > 3 * HZ && i < 4 * HZ ? FF_RUNNING : FF_BLENDING, false);
        go(&w, (ff_rates){1.0, 0.0, 0.0});
        go(&plain, (ff_rates){1.0, 0.0, 0.0});
    }
    assert_int_equal(w.gait.switches, 0);
    assert_memory_equal(&w.gait.foot, &plain.gait.foot, sizeof w.gait.foot);
}

/* A pack that says two cycles agree at one moment only: then that moment is waited for (FbCrowd, eq 10 and 15). */
static void where_cycles_differ_the_pair_is_waited_for(void **state)
{
    (void)state;
    ff_pack_content content;
    ff_error error;
    void *data;
    size_t size;
    ff_walker_content(&content, &ff_walker_grid_full);
    ff_pack_correspondence *c = content.correspondences.data;
    c[1].mean = 0.5f; /* example 0 and the clip; their pair is at half of both cycles */
    FF_ASSERT_OK(ff_pack_image(&content, &data, &size, &error), error);
    ff_pack_content_free(&content);
    ff_pack *other;
    ff_blend_space *made, *kept = space;
    FF_ASSERT_OK(ff_pack_open_memory(data, size, &other, &error), error);
    FF_ASSERT_OK(ff_blend_space_create(other, &made, &error), error);
    space = made;
    ff_rates rates = made->vertices[0].rates;
    for (int k = 0; k < 8; ++k) {
        walk w = begin(7);
        int i = 0;
        for (; i < 9 * HZ && w.gait.switches == 0; ++i) {
            ff_gait_want(space, &w.gait, i * DT > 5.0 + 0.1 * k ? FF_SEMI_PROCEDURAL : FF_BLENDING, false);
            go(&w, rates);
            if (w.gait.switches == 0) continue;
            /* Half of a cycle is the right contact, phase 2, in both; a foot may have to land first. */
            FF_ASSERT_NEAR(w.gait.phase, 2.5, 0.5);
        }
        assert_int_equal(w.gait.switches, 1);
    }
    space = kept;
    ff_blend_space_destroy(made);
    ff_pack_close(other);
    free(data);
}

/* ------------------------------------------------------------------------------------------------- running */

static double run_speed(double t)
{
    return t < 6.0 ? 2.8 : (t < 11.0 ? 1.2 : 0.0);
}

static void who_hurries_breaks_into_a_run_flies_and_walks_again(void **state)
{
    (void)state;
    for (uint64_t variation = 0; variation < 6; ++variation) {
        walk w = begin(variation);
        int flights = 0, both = 0, last = -1, count = 14 * HZ;
        for (int i = 0; i < count; ++i) {
            double speed = run_speed(i * DT);
            ff_gait_want(space, &w.gait, speed > 2.0 ? FF_RUNNING : FF_BLENDING, false);
            go(&w, (ff_rates){speed, 0.0, 0.0});
            look(&w, &steps[i]);
            bool settled = steps[i].way == FF_RUNNING && w.gait.since_switch > 0.8;
            if (i * DT > 2.5 && i * DT < 6.0) assert_int_equal(steps[i].way, FF_RUNNING);
            if (i * DT > 8.0) assert_int_equal(steps[i].way, FF_BLENDING);
            both += settled && steps[i].planted[0] && steps[i].planted[1];
            bool air = settled && !steps[i].planted[0] && !steps[i].planted[1];
            flights += air && i > 0 && (steps[i - 1].planted[0] || steps[i - 1].planted[1]);
            for (int foot = 0; foot < 2 && i > 0; ++foot) {
                if (!steps[i].planted[foot] || steps[i - 1].planted[foot] || i * DT > 10.0) continue;
                assert_int_not_equal(foot, last); /* left, right, left */
                last = foot;
            }
        }
        assert_int_equal(both, 0);
        assert_in_range(flights, 6, 16);
        assert_int_equal(w.gait.switches, 2);
        assert_int_equal(w.gait.mode, FF_GAIT_STAND);
        FF_ASSERT_BELOW(slide(count), 1e-3);
        FF_ASSERT_BELOW(knee_jerk(count), 45.0);
    }
}

static void runs_and_walks_are_never_blended(void **state)
{
    (void)state;
    ff_random random = {3, 4, 0};
    for (int i = 0; i < 5000; ++i) {
        ff_rates asked = {ff_random_range(&random, -1.0, 4.0), ff_random_range(&random, -0.8, 0.8),
                          ff_random_range(&random, -2.0, 2.0)};
        for (int way = FF_BLENDING; way < FF_LOCOMOTION_COUNT; ++way) {
            ff_blend blend;
            ff_locomotion_find(space, (ff_locomotion)way, asked, &blend);
            assert_int_equal(blend.way, way);
            for (int k = 0; k < FF_BLEND_MAX; ++k) {
                if (blend.vertex[k] < 0) continue;
                uint32_t gait = pack->examples[space->vertices[blend.vertex[k]].example].gait;
                assert_int_equal(gait, way == FF_RUNNING ? FF_GAIT_RUN : FF_GAIT_WALK);
            }
        }
    }
}

static void what_the_state_holds_is_all_there_is(void **state)
{
    (void)state;
    walk one = begin(8), two = begin(8);
    for (int i = 0; i < 12 * HZ; ++i) {
        ff_locomotion way = (ff_locomotion)(i / 70 % FF_LOCOMOTION_COUNT);
        ff_rates rates = {way == FF_RUNNING ? 2.6 : 1.0, 0.1, 0.2 * sin(i * 0.02)};
        step seen;
        ff_gait_want(space, &one.gait, way, i % 140 < 20);
        go(&one, rates);
        look(&one, &seen);
        ff_gait_want(space, &two.gait, way, i % 140 < 20);
        go(&two, rates);
    }
    assert_memory_equal(&one.gait, &two.gait, sizeof one.gait);
    assert_true(one.gait.switches > 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_clip_does_whatever_is_asked_within_its_limits),
        cmocka_unit_test(footprints_of_the_clip_follow_the_rates_exactly),
        cmocka_unit_test(feet_on_the_clip_stand_still_and_knees_do_not_pop),
        cmocka_unit_test(nobody_crouches_who_goes_slowly_or_turns_on_the_spot),
        cmocka_unit_test(side_steps_are_lowest_while_the_feet_are_apart),
        cmocka_unit_test(side_steps_put_the_pelvis_over_the_standing_foot),
        cmocka_unit_test(a_change_at_any_moment_shows_neither_in_feet_nor_knees_nor_trunk),
        cmocka_unit_test(straight_on_one_changes_within_a_few_steps_of_the_clock_and_only_once),
        cmocka_unit_test(a_request_taken_back_changes_nothing),
        cmocka_unit_test(where_cycles_differ_the_pair_is_waited_for),
        cmocka_unit_test(who_hurries_breaks_into_a_run_flies_and_walks_again),
        cmocka_unit_test(runs_and_walks_are_never_blended),
        cmocka_unit_test(what_the_state_holds_is_all_there_is),
    };
    return cmocka_run_group_tests(tests, open_space, close_space);
}
