/* The built-in walks and runs against people: ranges measured on motion capture, CMU clips by 4 to 9 people a band. Sources:
 * spatiotemporal.csv, reference_feet_knees.csv, reference_joint_velocity.csv, reference_root_acceleration.csv and
 * fits.csv of the gait figures; this data was obtained from mocap.cs.cmu.edu, created with funding from NSF
 * EIA-0196217. */
#include "tests/mocap/watched.h"

#include <stdio.h>

typedef struct ff_range {
    double low, high;
} ff_range;

enum { HIP, KNEE, ANKLE, SHOULDER, ELBOW, PELVIS, THORAX, HEAD, SPEED_JOINTS };
static const int speed_joint[SPEED_JOINTS][2] = {
    {FF_ROLE_HIP_L, FF_ROLE_HIPS},         {FF_ROLE_KNEE_L, FF_ROLE_HIP_L},
    {FF_ROLE_ANKLE_L, FF_ROLE_KNEE_L},     {FF_ROLE_SHOULDER_L, FF_ROLE_CHEST},
    {FF_ROLE_ELBOW_L, FF_ROLE_SHOULDER_L}, {FF_ROLE_HIPS, -1},
    {FF_ROLE_CHEST, FF_ROLE_HIPS},         {FF_ROLE_HEAD, FF_ROLE_CHEST},
};

typedef struct ff_band_truth {
    const char *clip;
    double speed;          /* m/s */
    ff_range cadence;      /* steps/min, mean and two deviations */
    ff_range step;         /* m */
    ff_range stance;       /* of a cycle */
    ff_range knee_contact; /* deg: 5th percentile of the lowest to 95th of the highest person ... */
    ff_range knee_stance_least;
    ff_range knee_swing_most;
    ff_range ankle_height; /* m over its flat height */
    ff_range clearance;    /* m, lowest point from 25 to 65 % of the swing */
    ff_range ankles_apart; /* m sideways as they pass */
    /* deg/s at 30 Hz: lowest person's median, highest person's 99th percentile */
    ff_range joint[SPEED_JOINTS];
    ff_range root; /* m/s2 over 0.25 s: lowest and highest person's mean */
} ff_band_truth;

static const ff_band_truth bands[] = {
    {"walk-slow",
     1.02,
     {83, 111},
     {0.515, 0.75},
     {0.598, 0.658},
     {8.3, 29.6},
     {5, 22.9},
     {60.5, 77.3},
     {0.128, 0.181},
     {0.004, 0.027},
     {0.074, 0.120},
     {{77, 286}, {59, 515}, {58, 332}, {40, 313}, {17, 158}, {25, 84}, {34, 112}, {15, 131}},
     {1.13, 1.35}},
    {"walk-normal",
     1.27,
     {99, 121},
     {0.614, 0.768},
     {0.593, 0.647},
     {1.6, 35.3},
     {5, 27},
     {63.2, 81},
     {0.154, 0.186},
     {0.0015, 0.035},
     {0.0717, 0.113},
     {{94, 330}, {76, 594}, {65, 495}, {44, 503}, {22, 259}, {30, 117}, {39, 128}, {19, 137}},
     {1.17, 1.65}},
    {"walk-fast",
     1.60,
     {106, 135},
     {0.749, 0.852},
     {0.554, 0.622},
     {14.2, 32.6},
     {5, 19.3},
     {68.3, 77.5},
     {0.154, 0.207},
     {0.001, 0.032},
     {0.0763, 0.112},
     {{128, 378}, {121, 687}, {107, 516}, {74, 770}, {44, 314}, {45, 132}, {50, 165}, {29, 136}},
     {1.44, 2.32}},
    {"run",
     3.00,
     {150, 166},
     {0.85, 1.44},
     {0.285, 0.43},
     {14, 37},
     {12, 42},
     {88, 120},
     {0.25, 0.40},
     {0.05, 0.16},
     {0.06, 0.12},
     {{156, 507}, {203, 695}, {122, 718}, {90, 498}, {50, 252}, {49, 213}, {70, 247}, {46, 196}},
     {3.59, 4.11}},
};

static void assert_in(const char *clip, const char *what, double value, ff_range range)
{
    if (!(value >= range.low && value <= range.high)) {
        print_error("%s: %s is %.4g, people have %.4g to %.4g\n", clip, what, value, range.low, range.high);
        fail();
    }
}

/* ------------------------------------------------------------------------------------------------- measures */

/* The next whole plant of the same foot, or NULL. */
static const ff_true_plant *next_of_foot(const ff_generated *made, int k)
{
    for (int i = k + 1; i < made->plant_count; ++i)
        if (made->plants[i].foot == made->plants[k].foot)
            return made->plants[i].cut_end ? NULL : &made->plants[i];
    return NULL;
}

static void check_stride(const ff_band_truth *band, const ff_watched *w, const ff_true_plant *p,
                         const ff_true_plant *next)
{
    double stride = next->start - p->start, least = 180.0, most = 0.0, high = 0.0, low = 1.0;
    int ankle = ankle_of(p->foot);
    assert_in(band->clip, "cadence", 2.0 * 60.0 * 120.0 / stride, band->cadence);
    assert_in(band->clip, "step length", 0.5 * ff_length3(ff_sub3(next->ball, p->ball)), band->step);
    assert_in(band->clip, "stance fraction", (p->end - p->start + 1) / stride, band->stance);
    assert_in(band->clip, "knee at contact", knee_flexion(w, p->start, p->foot), band->knee_contact);
    for (int f = p->start; f <= p->end; ++f)
        least = ff_min(least, knee_flexion(w, f, p->foot));
    for (int f = p->end; f < next->start; ++f) {
        double u = (f - p->end) / (double)(next->start - p->end);
        most = ff_max(most, knee_flexion(w, f, p->foot));
        high = ff_max(high, at(w, f, ankle).y - FF_BODY_ANKLE_HEIGHT);
        if (u < 0.25 || u > 0.65) continue;
        int toe = p->foot == 0 ? FF_ROLE_TOE_L : FF_ROLE_TOE_R;
        double sole = ff_min(ff_min(at(w, f, ankle + 1).y, at(w, f, toe).y), w->heels[2 * f + p->foot].y);
        low = ff_min(low, sole - FF_BODY_BALL_HEIGHT);
    }
    assert_in(band->clip, "least knee flexion in stance", least, band->knee_stance_least);
    assert_in(band->clip, "knee flexion in swing", most, band->knee_swing_most);
    assert_in(band->clip, "ankle height in swing", high, band->ankle_height);
    assert_in(band->clip, "clearance in swing", low, band->clearance);
}

static void feet_and_knees_are_those_of_people(void **state)
{
    (void)state;
    for (size_t b = 0; b < sizeof bands / sizeof bands[0]; ++b) {
        ff_watched w;
        watch_named(bands[b].clip, &w);
        int strides = 0;
        for (int k = 0; k < w.made.plant_count; ++k) {
            const ff_true_plant *next = next_of_foot(&w.made, k);
            if (w.made.plants[k].cut_start || !next) continue;
            check_stride(&bands[b], &w, &w.made.plants[k], next);
            ++strides;
        }
        assert_true(strides >= 6);
        unwatch(&w);
    }
}

static void ankles_pass_each_other_as_peoples_do(void **state)
{
    (void)state;
    for (size_t b = 0; b < sizeof bands / sizeof bands[0]; ++b) {
        ff_watched w;
        watch_named(bands[b].clip, &w);
        double before = 0.0;
        for (int f = 0; f < w.frames; ++f) {
            ff_vec3 apart = ff_sub3(at(&w, f, FF_ROLE_ANKLE_L), at(&w, f, FF_ROLE_ANKLE_R));
            if (f > 0 && before * apart.z < 0.0)
                assert_in(bands[b].clip, "ankles apart", apart.x, bands[b].ankles_apart);
            before = apart.z;
        }
        unwatch(&w);
    }
}

/* Every 4th frame, as the reference was measured. */
static int joint_speeds(const ff_watched *w, const int joint[2], double *out)
{
    int count = 0;
    ff_quat before = FF_QUAT_IDENTITY;
    for (int f = 0; f < w->frames; f += 4) {
        ff_quat now = turn_at(w, f, joint[0]);
        if (joint[1] >= 0) now = ff_quat_mul(ff_quat_conj(turn_at(w, f, joint[1])), now);
        if (f > 0) out[count++] = ff_quat_angle(ff_quat_mul(ff_quat_conj(before), now)) / FF_DEG * 30.0;
        before = now;
    }
    return count;
}

static void joints_turn_as_fast_as_peoples(void **state)
{
    (void)state;
    for (size_t b = 0; b < sizeof bands / sizeof bands[0]; ++b) {
        ff_watched w;
        watch_named(bands[b].clip, &w);
        for (int j = 0; j < SPEED_JOINTS; ++j) {
            double speeds[512];
            assert_true(w.frames / 4 < 512);
            int count = joint_speeds(&w, speed_joint[j], speeds);
            char what[64];
            snprintf(what, sizeof what, "median speed of joint %d", j);
            ff_range r = bands[b].joint[j];
            assert_in(bands[b].clip, what, quantile(speeds, count, 0.5),
                      (ff_range){0.7 * r.low, 1.3 * r.high});
            assert_in(bands[b].clip, "99th percentile of a joint", quantile(speeds, count, 0.99),
                      (ff_range){r.low, 1.3 * r.high});
        }
        unwatch(&w);
    }
}

static ff_vec3 root_velocity(const ff_watched *w, int f)
{
    return ff_scale3(ff_sub3(at(w, f + 1, FF_ROLE_HIPS), at(w, f, FF_ROLE_HIPS)), 120.0);
}

static void the_root_accelerates_as_peoples_does(void **state)
{
    (void)state;
    for (size_t b = 0; b < sizeof bands / sizeof bands[0]; ++b) {
        ff_watched w;
        watch_named(bands[b].clip, &w);
        double sum = 0.0;
        int count = 0;
        for (int f = 0; f + 31 < w.frames; ++f, ++count)
            sum += ff_length3(ff_sub3(root_velocity(&w, f + 30), root_velocity(&w, f))) * 4.0;
        ff_range r = bands[b].root;
        assert_in(bands[b].clip, "root acceleration", sum / count, (ff_range){0.8 * r.low, 1.25 * r.high});
        unwatch(&w);
    }
}

/* ------------------------------------------------------------------------------------------------ the others */

static void people_start_within_two_steps_and_stop_within_two(void **state)
{
    (void)state;
    ff_watched w;
    watch_named("start-left", &w);
    int first = 0;
    while (first < w.made.plant_count && w.made.plants[first].cut_start)
        ++first;
    assert_in_range(first, 2, (uintmax_t)w.made.plant_count - 1);
    double v = ff_length3(root_velocity(&w, w.made.plants[first].start));
    assert_in("start-left", "speed at the first contact, of steady", v / 1.27, (ff_range){0.40, 0.75});
    unwatch(&w);
    watch_named("stop-left", &w);
    const ff_true_plant *last = &w.made.plants[w.made.plant_count - 1];
    v = ff_length3(root_velocity(&w, last->start));
    assert_in("stop-left", "speed at the last contact, of steady", v / 1.27, (ff_range){0.05, 0.30});
    assert_in("stop-left", "speed at the end", ff_length3(root_velocity(&w, w.frames - 2)),
              (ff_range){0.0, 0.03});
    unwatch(&w);
}

static void turns_end_where_their_names_say(void **state)
{
    (void)state;
    const struct {
        const char *name;
        double degrees;
    } turns[] = {{"turn-left-45", 45},   {"turn-right-45", -45}, {"turn-left-90", 90},
                 {"turn-right-90", -90}, {"turn-left-180", 180}, {"turn-right-180", -180}};
    for (size_t i = 0; i < sizeof turns / sizeof turns[0]; ++i) {
        ff_watched w;
        watch_named(turns[i].name, &w);
        double turned = 0.0;
        for (int f = 1; f < w.frames; ++f)
            turned += ff_wrap(ff_quat_heading(turn_at(&w, f, FF_ROLE_HIPS)) -
                              ff_quat_heading(turn_at(&w, f - 1, FF_ROLE_HIPS)));
        FF_ASSERT_NEAR(turned / FF_DEG, turns[i].degrees, 1.0);
        ff_vec3 moved = ff_sub3(at(&w, w.frames - 1, FF_ROLE_HIPS), at(&w, 0, FF_ROLE_HIPS));
        FF_ASSERT_BELOW(hypot(moved.x, moved.z), 0.15);
        unwatch(&w);
    }
}

static void the_jump_leaves_the_ground(void **state)
{
    (void)state;
    ff_watched w;
    watch_named("jump", &w);
    int air = 0;
    for (int f = 0; f < w.frames; ++f)
        air += at(&w, f, FF_ROLE_TOE_L).y > FF_BODY_BALL_HEIGHT + 0.03 &&
               at(&w, f, FF_ROLE_TOE_R).y > FF_BODY_BALL_HEIGHT + 0.03;
    assert_in("jump", "frames in the air", air, (ff_range){25, 60});
    unwatch(&w);
}

static void one_who_stands_is_alive(void **state)
{
    (void)state;
    ff_watched w;
    watch_named("idle", &w);
    double low = 1e9, high = -1e9, turned = 0.0;
    for (int f = 0; f < w.frames; ++f) {
        low = ff_min(low, at(&w, f, FF_ROLE_HEAD).x);
        high = ff_max(high, at(&w, f, FF_ROLE_HEAD).x);
        turned = ff_max(turned, fabs(ff_quat_heading(turn_at(&w, f, FF_ROLE_HEAD))));
    }
    assert_in("idle", "sway of the head", high - low, (ff_range){0.005, 0.08});
    assert_in("idle", "turn of the head, deg", turned / FF_DEG, (ff_range){0.5, 20});
    unwatch(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feet_and_knees_are_those_of_people),
        cmocka_unit_test(ankles_pass_each_other_as_peoples_do),
        cmocka_unit_test(joints_turn_as_fast_as_peoples),
        cmocka_unit_test(the_root_accelerates_as_peoples_does),
        cmocka_unit_test(people_start_within_two_steps_and_stop_within_two),
        cmocka_unit_test(turns_end_where_their_names_say),
        cmocka_unit_test(the_jump_leaves_the_ground),
        cmocka_unit_test(one_who_stands_is_alive),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
