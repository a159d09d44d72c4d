/* The semi-procedural clip: it is its own clip at its own speed, follows other walks at theirs, and its feet stand still
 * at any rates. */
#include "tests/preprocess/cycles_make.h"
#include "tests/preprocess/standard.h"

#include "preprocess/examples/cycles.h"
#include "preprocess/examples/gait_fit.h"

#include <stdio.h>

enum { WALKS = 6 };
static const char *const names[WALKS] = {"walk-normal", "walk-slow",   "walk-fast",
                                         "walk-brisk",  "walk-stroll", "walk-shuffle"};

typedef struct fixture {
    ff_rig rig;
    ff_example walk[WALKS];
    ff_gait_fit fit;
} fixture;

static ff_example walk_of(const ff_rig *rig, const char *name)
{
    made_motion made = make_motion(rig, generated_clip(name));
    ff_cycles cycles = cut_cycles(rig, &made);
    assert_true(cycles.count > 1);
    ff_example walk = cycles.items[1];
    memset(&cycles.items[1], 0, sizeof cycles.items[1]);
    ff_cycles_free(&cycles);
    made_motion_free(&made);
    return walk;
}

static int set_up(void **state)
{
    static fixture f;
    f.rig = rig_of_generated(names[0]);
    const ff_example *walks[WALKS];
    for (int i = 0; i < WALKS; ++i) {
        f.walk[i] = walk_of(&f.rig, names[i]);
        walks[i] = &f.walk[i];
    }
    ff_gait_fit_make(&f.rig, &f.walk[0], walks, WALKS, &f.fit);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    for (int i = 0; i < WALKS; ++i)
        ff_example_free(&f->walk[i]);
    return 0;
}

/* Distance of the model's balls from an example's at the example's own rates and period: mean and worst (m). */
static void compare(const fixture *f, const ff_example *walk, double *mean, double *worst)
{
    ff_gait_model model = ff_gait_fit_model(&f->fit);
    ff_rates rates = {(double)walk->record.v_forward, 0.0, 0.0};
    *mean = *worst = 0.0;
    for (int k = 0; k < walk->frame_count; ++k) {
        for (int foot = 0; foot < 2; ++foot) {
            const ff_pack_foot *own = &walk->feet[2 * k + foot];
            ff_model_foot at = ff_gait_model_foot(&model, rates, (double)walk->record.period, foot,
                                                  k / (double)walk->frame_count);
            double off = ff_length3(ff_v3(at.forward - (double)own->ball[0], at.left - (double)own->ball[1],
                                          at.height - (double)own->ball[2]));
            *mean += off / (2.0 * walk->frame_count);
            *worst = ff_max(*worst, off);
        }
    }
}

static void at_its_own_speed_it_is_the_clip(void **state)
{
    const fixture *f = *state;
    double mean, worst;
    compare(f, &f->walk[0], &mean, &worst);
    FF_ASSERT_BELOW(mean, 0.003);
    FF_ASSERT_BELOW(worst, 0.010);
    ff_gait_model model = ff_gait_fit_model(&f->fit);
    ff_rates rates = {(double)f->fit.gait.speed, 0.0, 0.0};
    FF_ASSERT_NEAR(ff_gait_model_period(&model, rates), (double)f->fit.gait.period, 1e-9);
    FF_ASSERT_NEAR(ff_gait_model_stance(&model, rates), (double)f->fit.gait.stance, 1e-9);
    FF_ASSERT_NEAR(ff_gait_model_size(&model, rates), 1.0, 1e-9);
}

static void at_other_speeds_it_follows_other_walks(void **state)
{
    const fixture *f = *state;
    assert_int_equal(f->fit.gait.walks, WALKS);
    ff_gait_model model = ff_gait_fit_model(&f->fit);
    for (int i = 1; i < WALKS; ++i) {
        const ff_pack_example *r = &f->walk[i].record;
        double mean, worst;
        compare(f, &f->walk[i], &mean, &worst);
        print_message("%-13s %.2f m/s: balls off by %.1f cm, %.1f at most\n", names[i], (double)r->v_forward,
                      100.0 * mean, 100.0 * worst);
        FF_ASSERT_BELOW(mean, 0.04);
        FF_ASSERT_BELOW(worst, 0.12);
        ff_rates rates = {(double)r->v_forward, 0.0, 0.0};
        FF_ASSERT_NEAR(ff_gait_model_period(&model, rates) / (double)r->period, 1.0, 0.06);
    }
    FF_ASSERT_BELOW((double)f->fit.gait.period_residual, 0.05);
    FF_ASSERT_BELOW((double)f->fit.gait.stance_residual, 0.02);
}

/* People's steps: 0.61 v^0.52 m long (gait facts); stance gets shorter with speed, steps longer and quicker. */
static void steps_grow_and_quicken_with_speed_as_peoples_do(void **state)
{
    const fixture *f = *state;
    ff_gait_model model = ff_gait_fit_model(&f->fit);
    double last_period = 10.0, last_length = 0.0, last_stance = 1.0;
    for (double v = 0.5; v < 1.81; v += 0.1) {
        ff_rates rates = {v, 0.0, 0.0};
        double period = ff_gait_model_period(&model, rates), length = 0.5 * v * period;
        double stance = ff_gait_model_stance(&model, rates);
        if (v > 0.85) FF_ASSERT_NEAR(length / (0.6107 * pow(v, 0.5216)), 1.0, 0.12);
        assert_true(period < last_period + 1e-9 && length > last_length && stance < last_stance + 1e-9);
        FF_ASSERT_NEAR(stance, 0.64, 0.06);
        last_period = period, last_length = length, last_stance = stance;
    }
}

static ff_vec2 in_world(ff_rates rates, double time, const ff_model_foot *foot)
{
    return ff_add2(ff_root_arc(ff_v2(rates.forward, rates.left), rates.turn, time),
                   ff_from_frame2(ff_fwd2(rates.turn * time), ff_v2(foot->forward, foot->left)));
}

/* Between flat and heel-off, 15 to 70 % of the stance, a ball stays where it is, whatever the root does. */
static void feet_stand_still_at_all_rates(void **state)
{
    const fixture *f = *state;
    ff_gait_model model = ff_gait_fit_model(&f->fit);
    for (double forward = -1.2; forward < 1.7; forward += 0.4)
        for (double left = -0.6; left < 0.7; left += 0.3)
            for (double turn = -1.5; turn < 1.6; turn += 0.75) {
                ff_rates rates = {forward, left, turn};
                double period = ff_gait_model_period(&model, rates),
                       stance = ff_gait_model_stance(&model, rates);
                assert_true(period >= 0.7 && period <= 1.65);
                ff_vec2 first = {0.0, 0.0};
                for (int k = 0; k <= 20; ++k) {
                    double share = forward < 0.0 ? 0.3 + 0.0275 * k : 0.15 + 0.0275 * k;
                    ff_model_foot foot = ff_gait_model_foot(&model, rates, period, FF_LEFT, share * stance);
                    ff_vec2 at = in_world(rates, share * stance * period, &foot);
                    if (k == 0) first = at;
                    FF_ASSERT_BELOW(ff_length2(ff_sub2(at, first)), 0.025);
                    assert_true(foot.swing < 0.0);
                }
            }
}

/* No jump anywhere, seam included: a ball covers no more per hundredth of a cycle than a fast swing does. */
static void paths_are_smooth_all_around(void **state)
{
    const fixture *f = *state;
    ff_gait_model model = ff_gait_fit_model(&f->fit);
    for (double forward = -1.2; forward < 1.9; forward += 0.3)
        for (double turn = -1.5; turn < 1.6; turn += 1.5) {
            ff_rates rates = {forward, 0.2, turn};
            double period = ff_gait_model_period(&model, rates);
            ff_model_foot last = ff_gait_model_foot(&model, rates, period, FF_RIGHT, 0.0);
            ff_vec3 last_hips = ff_gait_model_hips(&model, rates, 0.0);
            for (int k = 1; k <= 200; ++k) {
                ff_model_foot at = ff_gait_model_foot(&model, rates, period, FF_RIGHT, k / 200.0);
                ff_vec3 hips = ff_gait_model_hips(&model, rates, k / 200.0);
                double moved = ff_length3(
                    ff_v3(at.forward - last.forward, at.left - last.left, at.height - last.height));
                FF_ASSERT_BELOW(moved, (1.5 + 3.0 * fabs(forward)) * period / 200.0);
                FF_ASSERT_BELOW(fabs(at.yaw - last.yaw), 0.06);
                FF_ASSERT_BELOW(fabs(at.pitch - last.pitch), 0.08);
                FF_ASSERT_BELOW(ff_length3(ff_sub3(hips, last_hips)), 0.004);
                assert_true(at.height >= (double)f->fit.gait.ball_rest - 0.01);
                last = at, last_hips = hips;
            }
        }
}

/* With one walk there is nothing to fit a slope to: the laws are those of people. */
static void one_walk_takes_its_laws_from_people(void **state)
{
    const fixture *f = *state;
    ff_gait_fit fit;
    ff_gait_fit_make(&f->rig, &f->walk[0], NULL, 0, &fit);
    FF_ASSERT_NEAR((double)fit.gait.cadence, 0.48, 1e-6);
    assert_int_equal(fit.gait.walks, 0);
    assert_memory_equal(fit.path, f->fit.path, sizeof fit.path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(at_its_own_speed_it_is_the_clip),
        cmocka_unit_test(at_other_speeds_it_follows_other_walks),
        cmocka_unit_test(steps_grow_and_quicken_with_speed_as_peoples_do),
        cmocka_unit_test(feet_stand_still_at_all_rates),
        cmocka_unit_test(paths_are_smooth_all_around),
        cmocka_unit_test(one_walk_takes_its_laws_from_people),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
