/* The clean-up of feet: slopes against differences, a leg against the law of cosines, a walk with a known slide, walks
 * that need none, and captured clips against what is asked of them. */
#include "preprocess/clean/clean_finish.h"
#include "preprocess/clean/clean_knots.h"
#include "tests/preprocess/motion_make.h"
#include "tests/preprocess/standard.h"

#include "mocap/load.h"

#include <stdio.h>

/* ------------------------------------------------------------------------------------------------------- slopes */

typedef struct tried {
    ff_rig rig;
    ff_clean_knot knot;
    ff_clean_plant plant;
    ff_clean_problem problem;
    double root[FF_CLEAN_ROOT], leg[FF_CLEAN_LEG], place[FF_CLEAN_PLANT];
} tried;

/* A crouching pose with all unknowns away from 0, both heel and ball pinned, everything under the ground. */
static void tried_begin(tried *t, ff_random *random)
{
    ff_clip clip = generated_clip("walk-normal");
    t->rig = rig_of(&clip);
    ff_clip_free(&clip);
    t->knot = (ff_clean_knot){.heel = {0.7, 0.7}, .ball = {0.9, 0.9}, .ground = {0.3, 0.3}};
    t->knot.pose.hips = ff_v3(0.3, 0.7, -1.2);
    t->knot.pose.pelvis = ff_quat_yaw(2.0);
    for (int side = 0; side < 2; ++side) {
        t->knot.pose.legs[side][FF_LEG_HIP] = ff_quat_axis(ff_unit3(ff_v3(-1.0, 0.1, 0.2)), 0.8);
        t->knot.pose.legs[side][FF_LEG_KNEE] = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), 0.03);
        t->knot.pose.legs[side][FF_LEG_ANKLE] = ff_quat_axis(ff_unit3(ff_v3(0.3, 1.0, 0.2)), 0.3);
        t->knot.pose.legs[side][FF_LEG_BALL] = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), -0.2);
        t->knot.pose.flexion[side] = 0.03;
    }
    t->plant = (ff_clean_plant){.heel_height = 0.03, .ball_height = 0.025};
    t->problem = (ff_clean_problem){.rig = &t->rig,
                                    .settings = &standard()->cut.clean,
                                    .knot_time = 1.0 / 60.0,
                                    .knot_count = 1,
                                    .plant_count = 1,
                                    .knots = &t->knot,
                                    .plants = &t->plant};
    for (int i = 0; i < FF_CLEAN_ROOT; ++i)
        t->root[i] = 0.1 * ff_random_normal(random);
    for (int i = 0; i < FF_CLEAN_LEG; ++i)
        t->leg[i] = 0.2 * ff_random_normal(random);
    for (int i = 0; i < FF_CLEAN_PLANT; ++i)
        t->place[i] = ff_random_normal(random);
    t->leg[FF_CLEAN_KNEE] = -0.01;
}

enum { PIN, GROUND, KNEE, TERMS };
static const int heights[TERMS] = {6, 3, 1}, blocks[TERMS] = {3, 2, 1};

static void run_term(const tried *t, int term, int side, double *const *x, double *residuals, double **slopes)
{
    if (term == PIN) ff_clean_pin_term(&t->problem, 0, side, x[0], x[1], x[2], residuals, slopes);
    if (term == GROUND) ff_clean_ground_term(&t->problem, 0, side, x[0], x[1], residuals, slopes);
    if (term == KNEE) ff_clean_knee_term(&t->problem, 0, side, x[0], residuals, slopes);
}

static void check_slopes(tried *t, int term, int side)
{
    double slope[3][6 * FF_CLEAN_LEG], *slopes[3] = {slope[0], slope[1], slope[2]}, residuals[6];
    double *x[3] = {t->root, t->leg, t->place};
    int width[3] = {FF_CLEAN_ROOT, FF_CLEAN_LEG, FF_CLEAN_PLANT};
    if (term == KNEE) {
        x[0] = t->leg;
        width[0] = FF_CLEAN_LEG;
    }
    run_term(t, term, side, x, residuals, slopes);
    const double h = 1e-6;
    for (int b = 0; b < blocks[term]; ++b)
        for (int i = 0; i < width[b]; ++i) {
            double up[6], down[6], kept = x[b][i];
            x[b][i] = kept + h;
            run_term(t, term, side, x, up, NULL);
            x[b][i] = kept - h;
            run_term(t, term, side, x, down, NULL);
            x[b][i] = kept;
            for (int row = 0; row < heights[term]; ++row) {
                double want = (up[row] - down[row]) / (2.0 * h), got = slope[b][row * width[b] + i];
                FF_ASSERT_NEAR(got, want, 1e-5 * (1.0 + fabs(want)));
            }
        }
}

static void slopes_are_those_of_small_differences(void **state)
{
    (void)state;
    ff_random random = {7, 0, 0};
    for (int trial = 0; trial < 20; ++trial) {
        tried t;
        tried_begin(&t, &random);
        t.knot.plant[0] = t.knot.plant[1] = 0;
        if (trial == 0) memset(t.leg, 0, sizeof t.leg); /* where most solutions start */
        for (int term = 0; term < TERMS; ++term)
            for (int side = 0; side < 2; ++side)
                check_slopes(&t, term, side);
    }
}

static void what_is_above_the_ground_and_a_bent_knee_cost_nothing(void **state)
{
    (void)state;
    ff_random random = {8, 0, 0};
    tried t;
    tried_begin(&t, &random);
    t.knot.ground[0] = -5.0;
    t.knot.pose.flexion[0] = 0.5;
    double residuals[3], slope[3 * FF_CLEAN_LEG], *slopes[2] = {NULL, slope};
    ff_clean_ground_term(&t.problem, 0, 0, t.root, t.leg, residuals, slopes);
    for (int i = 0; i < 3; ++i)
        FF_ASSERT_NEAR(residuals[i], 0.0, 0.0);
    for (int i = 0; i < 3 * FF_CLEAN_LEG; ++i)
        FF_ASSERT_NEAR(slope[i], 0.0, 0.0);
    ff_clean_knee_term(&t.problem, 0, 0, t.leg, residuals, NULL);
    FF_ASSERT_NEAR(residuals[0], 0.0, 0.0);
}

static void places_are_those_of_the_posed_body(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("curve-left");
    ff_rig rig = rig_of(&clip);
    made_motion made = make_motion(&rig, clip);
    const double zero[FF_CLEAN_LEG] = {0};
    for (int k = 0; k < made.motion.frame_count; k += 17) {
        ff_vec3 at[FF_BODY_COUNT], places[FF_FOOT_PLACES];
        ff_clean_pose pose;
        ff_motion_pose(&rig, &made.motion, k, at, NULL);
        ff_clean_pose_read(&made.motion, k, &pose);
        ff_clean_foot(&rig, &pose, FF_RIGHT, zero, zero, places, NULL);
        FF_ASSERT_BELOW(ff_length3(ff_sub3(places[FF_FOOT_AT_HEEL], at[FF_BODY_HEEL_R])), 1e-12);
        FF_ASSERT_BELOW(ff_length3(ff_sub3(places[FF_FOOT_AT_BALL], at[FF_ROLE_BALL_R])), 1e-12);
        FF_ASSERT_BELOW(ff_length3(ff_sub3(places[FF_FOOT_AT_TOE], at[FF_ROLE_TOE_R])), 1e-12);
    }
    made_motion_free(&made);
}

/* ------------------------------------------------------------------------------------------------------ one leg */

static void a_leg_reaches_what_it_can_and_bends_forward_only(void **state)
{
    (void)state;
    ff_random random = {9, 0, 0};
    tried t;
    tried_begin(&t, &random);
    const double zero[FF_CLEAN_LEG] = {0}, leg = t.rig.leg;
    int first = ff_leg_role(FF_LEFT, FF_LEG_HIP);
    double thigh = ff_length3(t.rig.offset[first + 1]), shank = ff_length3(t.rig.offset[first + 2]);
    for (int trial = 0; trial < 200; ++trial) {
        ff_clean_pose pose = t.knot.pose;
        double start = 0.8 * ff_random_unit(&random) - 0.2; /* some knees start bent the wrong way */
        pose.legs[FF_LEFT][FF_LEG_KNEE] = ff_quat_axis(ff_v3(1.0, 0.0, 0.0), start);
        double away = leg * (0.4 + 0.8 * ff_random_unit(&random));
        ff_vec3 hip = ff_add3(pose.hips, ff_quat_rotate(pose.pelvis, t.rig.offset[first]));
        ff_vec3 line =
            ff_unit3(ff_v3(0.4 * ff_random_normal(&random), -1.0, 0.4 * ff_random_normal(&random)));
        ff_vec3 wanted = ff_madd3(hip, line, away), places[FF_FOOT_PLACES];
        ff_quat foot = ff_quat_yaw(ff_random_normal(&random));
        ff_clean_reach(&t.rig, &pose, FF_LEFT, wanted, foot);
        ff_clean_foot(&t.rig, &pose, FF_LEFT, zero, zero, places, NULL);
        ff_vec3 ankle = ff_sub3(places[FF_FOOT_AT_BALL], ff_quat_rotate(foot, t.rig.offset[first + 3]));
        double straight = sqrt(thigh * thigh + shank * shank + 2.0 * thigh * shank * ff_cos(0.6 * FF_DEG));
        double reached = ff_min(away, straight);
        FF_ASSERT_BELOW(ff_length3(ff_sub3(ankle, ff_madd3(hip, line, reached))), 1e-9);
        double cosine = (thigh * thigh + shank * shank - reached * reached) / (2.0 * thigh * shank);
        FF_ASSERT_NEAR(ff_knee_flexion(pose.legs[FF_LEFT][FF_LEG_KNEE]), FF_PI - ff_acos(cosine), 1e-6);
    }
}

/* ------------------------------------------------------------------------------------------------- whole motions */

/* The body drifts to and fro under itself, feet and all: every planted foot slides by up to 2 cm. */
static void add_skate(ff_motion *motion, double metres)
{
    for (int k = 0; k < motion->frame_count; ++k) {
        double t = k * motion->frame_time;
        motion->hips[k].x += metres * ff_sin(5.0 * t);
        motion->hips[k].y += metres * ff_cos(4.0 * t);
    }
}

/* How far balls, or heels, leave their place while flat; heels until a twelfth of a second before they rise. */
static double strays(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants, bool heel)
{
    double worst = 0.0;
    for (int p = 0; p < plants->count; ++p) {
        const ff_plant *plant = &plants->items[p];
        int point = ff_leg_role(plant->foot, FF_LEG_BALL);
        if (heel) point = plant->foot == FF_LEFT ? FF_BODY_HEEL_L : FF_BODY_HEEL_R;
        ff_vec3 first[FF_BODY_COUNT], at[FF_BODY_COUNT];
        if (plant->flat_start < 0) continue;
        int end = plant->flat_end - (heel ? (int)(1.0 / 12.0 / motion->frame_time) : 0);
        ff_motion_pose(rig, motion, plant->flat_start, first, NULL);
        for (int k = plant->flat_start; k <= end; ++k) {
            ff_motion_pose(rig, motion, k, at, NULL);
            worst = ff_max(worst, ff_length3(ff_sub3(at[point], first[point])));
        }
    }
    return worst;
}

static void sliding_feet_are_brought_to_stand_exactly(void **state)
{
    (void)state;
    const char *names[] = {"walk-normal", "curve-left", "walk-stroll"};
    for (int i = 0; i < 3; ++i) {
        ff_clip clip = generated_clip(names[i]);
        ff_rig rig = rig_of(&clip);
        made_motion made = make_motion(&rig, clip);
        ff_clean_report report;
        ff_error error;
        add_skate(&made.motion, 0.02);
        assert_true(strays(&rig, &made.motion, &made.plants, false) > 0.02);
        FF_ASSERT_OK(
            ff_motion_clean(&rig, &standard()->cut.clean, &made.motion, &made.plants, &report, &error),
            error);
        FF_ASSERT_BELOW(strays(&rig, &made.motion, &made.plants, false), 1e-6);
        FF_ASSERT_BELOW(strays(&rig, &made.motion, &made.plants, true), 0.002); /* legs are short for it */
        FF_ASSERT_BELOW(report.pin_worst.after, 1e-6);
        FF_ASSERT_BELOW(report.skate.after, 1e-6);
        assert_true(report.skate.before > 0.03);
        assert_false(report.was_clean);
        assert_int_equal(report.unconverged, 0);
        /* the hips go back to where they were before the slide was added, at most a little further */
        FF_ASSERT_BELOW(report.shift_most, 0.045);
        FF_ASSERT_BELOW(report.turn_mean, 2.0 * FF_DEG);
        assert_true(report.knee_least.after >= 0.0);
        FF_ASSERT_BELOW(report.acceleration, 1.1);
        FF_ASSERT_BELOW(report.floor_dip.after, 0.01);
        made_motion_free(&made);
    }
}

/* The clip's hips are much wider than the rig's: legs are not to be splayed for it, and steps are to keep their length. */
static void a_body_of_other_proportions_keeps_its_steps(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal"), wide = clip_copy(&clip);
    ff_rig rig = rig_of(&clip);
    wide.joints[ff_clip_find(&wide, FF_ROLE_HIP_L)].offset.x *= 1.6;
    wide.joints[ff_clip_find(&wide, FF_ROLE_HIP_R)].offset.x *= 1.6;
    made_motion made = make_motion(&rig, wide);
    ff_clean_report report;
    ff_error error;
    add_skate(&made.motion, 0.01);
    FF_ASSERT_OK(ff_motion_clean(&rig, &standard()->cut.clean, &made.motion, &made.plants, &report, &error),
                 error);
    FF_ASSERT_BELOW(report.turn_mean, 1.5 * FF_DEG);
    const ff_plant *last = NULL;
    ff_vec3 stood = {0.0, 0.0, 0.0};
    for (int p = 0; p < made.plants.count; ++p) {
        const ff_plant *plant = &made.plants.items[p];
        if (plant->flat_start < 0) continue;
        ff_vec3 at[FF_BODY_COUNT];
        ff_motion_pose(&rig, &made.motion, plant->flat_start, at, NULL);
        ff_vec3 ball = at[ff_leg_role(plant->foot, FF_LEG_BALL)];
        if (last && last->foot != plant->foot) {
            double want = made.motion.scale * (plant->ball.a - last->ball.a);
            FF_ASSERT_NEAR(ball.z - stood.z, want, 0.006); /* straight ahead is +a */
        }
        last = plant;
        stood = ball;
    }
    made_motion_free(&made);
    ff_clip_free(&clip);
}

static void feet_that_stand_are_left_alone_to_the_last_bit(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); i += 4) {
        ff_clip clip = generated_clip(ff_generator_describe(i).name);
        ff_rig rig = rig_of(&clip);
        made_motion made = make_motion(&rig, clip);
        ff_motion before;
        ff_clean_report report;
        ff_error error;
        FF_ASSERT_OK(ff_motion_copy(&made.motion, &before, &error), error);
        FF_ASSERT_OK(
            ff_motion_clean(&rig, &standard()->cut.clean, &made.motion, &made.plants, &report, &error),
            error);
        assert_true(report.was_clean);
        size_t n = (size_t)before.frame_count;
        assert_memory_equal(before.hips, made.motion.hips, n * sizeof *before.hips);
        assert_memory_equal(before.rotations, made.motion.rotations,
                            n * FF_ROLE_JOINT_COUNT * sizeof *before.rotations);
        ff_motion_free(&before);
        made_motion_free(&made);
    }
}

static void the_same_motion_gives_the_same_bits(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("curve-left");
    ff_rig rig = rig_of(&clip);
    made_motion x = make_motion(&rig, clip_copy(&clip)), y = make_motion(&rig, clip);
    ff_clean_report first, second;
    ff_error error;
    add_skate(&x.motion, 0.015);
    add_skate(&y.motion, 0.015);
    FF_ASSERT_OK(ff_motion_clean(&rig, &standard()->cut.clean, &x.motion, &x.plants, &first, &error), error);
    FF_ASSERT_OK(ff_motion_clean(&rig, &standard()->cut.clean, &y.motion, &y.plants, &second, &error), error);
    size_t n = (size_t)x.motion.frame_count;
    assert_memory_equal(x.motion.hips, y.motion.hips, n * sizeof *x.motion.hips);
    assert_memory_equal(x.motion.rotations, y.motion.rotations,
                        n * FF_ROLE_JOINT_COUNT * sizeof *x.motion.rotations);
    made_motion_free(&x);
    made_motion_free(&y);
}

static void other_rates_are_cleaned_alike(void **state)
{
    (void)state;
    for (int step = 2; step <= 4; step *= 2) {
        ff_clip whole = generated_clip("walk-normal"), clip = clip_every(&whole, 0, step);
        ff_rig rig = rig_of(&whole);
        made_motion made = make_motion(&rig, clip);
        ff_clean_report report;
        ff_error error;
        add_skate(&made.motion, 0.02);
        FF_ASSERT_OK(
            ff_motion_clean(&rig, &standard()->cut.clean, &made.motion, &made.plants, &report, &error),
            error);
        FF_ASSERT_BELOW(strays(&rig, &made.motion, &made.plants, false), 1e-6);
        FF_ASSERT_BELOW(strays(&rig, &made.motion, &made.plants, true), 0.002); /* legs are short for it */
        FF_ASSERT_BELOW(report.turn_mean, 2.5 * FF_DEG);
        assert_true(report.knee_least.after >= 0.0);
        ff_clip_free(&whole);
        made_motion_free(&made);
    }
}

static void short_motions_and_motions_without_plants_work(void **state)
{
    (void)state;
    ff_clip whole = generated_clip("walk-normal");
    ff_rig rig = rig_of(&whole);
    for (int frames = 1; frames <= 7; ++frames) {
        ff_clip clip = clip_every(&whole, whole.frame_count - frames, 1);
        made_motion made = make_motion(&rig, clip);
        ff_clean_report report;
        ff_error error;
        add_skate(&made.motion, 0.5);
        made.motion.hips[0].z -= 0.1; /* so that there is something to do */
        FF_ASSERT_OK(ff_clean_measure(&rig, &standard()->cut.clean, &made.motion, &made.motion, &made.plants,
                                      &report, &error),
                     error);
        made.plants.count = 0;
        ff_status status =
            ff_motion_clean(&rig, &standard()->cut.clean, &made.motion, &made.plants, &report, &error);
        assert_true(status == FF_OK || status == FF_ERR_RANGE);
        for (int k = 0; k < frames; ++k)
            assert_true(isfinite(made.motion.hips[k].x) && isfinite(made.motion.hips[k].z));
        made_motion_free(&made);
    }
    ff_clip_free(&whole);
}

static void a_motion_that_cannot_be_cleaned_is_refused_and_says_why(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    ff_rig rig = rig_of(&clip);
    made_motion made = make_motion(&rig, clip);
    ff_clean_report report;
    ff_error error;
    add_skate(&made.motion, 0.4);
    assert_int_equal(
        ff_motion_clean(&rig, &standard()->cut.clean, &made.motion, &made.plants, &report, &error),
        FF_ERR_RANGE);
    assert_non_null(strstr(error.message, "cannot be brought over cleanly"));
    assert_non_null(strstr(error.message, "limit"));
    made_motion_free(&made);
}

/* --------------------------------------------------------------------------------------------------- real capture */

/* Acceleration of a knee in a frame, m/s^2. */
static double knee_acceleration(const ff_rig *rig, const ff_motion *motion, int knee, int frame)
{
    ff_vec3 at[3][FF_BODY_COUNT];
    for (int i = 0; i < 3; ++i)
        ff_motion_pose(rig, motion, frame - 1 + i, at[i], NULL);
    ff_vec3 change = ff_madd3(ff_add3(at[0][knee], at[2][knee]), at[1][knee], -2.0);
    return ff_length3(change) / (motion->frame_time * motion->frame_time);
}

/* By how much a knee jerks more than the captured one did anywhere within 8 frames. */
static double new_jerk(const ff_rig *rig, const ff_motion *before, const ff_motion *after)
{
    double worst = 0.0;
    for (int knee = FF_ROLE_KNEE_L; knee <= FF_ROLE_KNEE_R; knee += FF_ROLE_KNEE_R - FF_ROLE_KNEE_L)
        for (int k = 9; k + 9 < before->frame_count; ++k) {
            double is = knee_acceleration(rig, after, knee, k), was = 0.0;
            for (int i = k - 8; is > worst && i <= k + 8; ++i)
                was = ff_max(was, knee_acceleration(rig, before, knee, i));
            worst = ff_max(worst, is - was);
        }
    return worst;
}

static void captured_clips_meet_what_is_asked_of_them(void **state)
{
    (void)state;
    if (!ff_shared_folder()) {
        print_message("SKIPPED: captured clips: no folder of outside data\n");
        skip();
    }
    static const struct {
        const char *file;
        double turn_95;
    } tries[] = {{"16/16_15.amc", 5.0}, {"08/08_03.amc", 5.0}, {"16/16_19.amc", 5.0},
                 {"16/16_43.amc", 5.0}, {"09/09_01.amc", 5.0}, {"38/38_01.amc", 5.0}};
    ff_rig rig = {0};
    for (size_t i = 0; i < sizeof tries / sizeof tries[0]; ++i) {
        char path[512];
        ff_clip clip;
        ff_error error;
        ff_clean_report r;
        ff_load_options options = ff_load_options_default();
        snprintf(path, sizeof path, "%s/data/cmu/%s", ff_shared_folder(), tries[i].file);
        FF_ASSERT_OK(ff_clip_load(path, &options, &clip, &error), error);
        if (i == 0) rig = rig_of(&clip);
        made_motion made = make_motion(&rig, clip);
        ff_motion before;
        FF_ASSERT_OK(ff_motion_copy(&made.motion, &before, &error), error);
        FF_ASSERT_OK(ff_motion_clean(&rig, &standard()->cut.clean, &made.motion, &made.plants, &r, &error),
                     error);
        FF_ASSERT_BELOW(new_jerk(&rig, &before, &made.motion), 45.0);
        ff_motion_free(&before);
        FF_ASSERT_BELOW(r.pin_median.after, 0.0001);
        FF_ASSERT_BELOW(r.pin_worst.after, 0.003);
        FF_ASSERT_BELOW(r.turn_mean, 1.5 * FF_DEG);
        FF_ASSERT_BELOW(r.turn_most_95, tries[i].turn_95 * FF_DEG);
        FF_ASSERT_BELOW(r.acceleration, 1.1);
        FF_ASSERT_BELOW(r.floor_dip.after, 0.01);
        assert_true(r.knee_least.after >= 0.0);
        assert_true(r.pin_median.before > 0.002);
        made_motion_free(&made);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slopes_are_those_of_small_differences),
        cmocka_unit_test(what_is_above_the_ground_and_a_bent_knee_cost_nothing),
        cmocka_unit_test(places_are_those_of_the_posed_body),
        cmocka_unit_test(a_leg_reaches_what_it_can_and_bends_forward_only),
        cmocka_unit_test(sliding_feet_are_brought_to_stand_exactly),
        cmocka_unit_test(a_body_of_other_proportions_keeps_its_steps),
        cmocka_unit_test(feet_that_stand_are_left_alone_to_the_last_bit),
        cmocka_unit_test(the_same_motion_gives_the_same_bits),
        cmocka_unit_test(other_rates_are_cleaned_alike),
        cmocka_unit_test(short_motions_and_motions_without_plants_work),
        cmocka_unit_test(a_motion_that_cannot_be_cleaned_is_refused_and_says_why),
        cmocka_unit_test(captured_clips_meet_what_is_asked_of_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
