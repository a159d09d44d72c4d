/* Walkers on trajectories of every kind: planted feet stand, nothing jumps, legs do not cross, one foot is down. */
#include "runtime/core/base/tasks.h"
#include "runtime/core/gait/synth_state.h"
#include "tests/core/walker_space.h"

#define HZ 60
#define DT (1.0 / HZ)
#define MAX_FRAMES (12 * HZ)

enum { HEEL_L = FF_JOINT_COUNT, HEEL_R, TOE_L, TOE_R, POINT_COUNT };

typedef struct frame {
    ff_vec3 point[POINT_COUNT];
    ff_quat local[FF_JOINT_COUNT];
    bool planted[2];
    double progress[2];
    double heading;
} frame;

typedef struct walk {
    const ff_blend_space *space;
    ff_gait gait;
    ff_vec2 position;
    double heading;
} walk;

static void begin(const ff_walker_space *walker, walk *w, uint64_t variation)
{
    *w = (walk){.space = walker->space};
    ff_gait_init(w->space, &w->gait, w->position, w->heading, variation);
}

static void go(walk *w, ff_rates rates, double dt)
{
    rates = ff_blend_clamp(w->space, rates);
    ff_vec2 ahead = ff_fwd2(w->heading + 0.5 * rates.turn * dt);
    w->position = ff_madd2(w->position, ff_from_frame2(ahead, ff_v2(rates.forward, rates.left)), dt);
    w->heading += rates.turn * dt;
    ff_gait_step(w->space, &w->gait, w->position, w->heading, rates, dt);
}

static void look(const walk *w, frame *out)
{
    const ff_body_frame *body = &w->space->body;
    ff_vec3 hips;
    ff_quat world[FF_JOINT_COUNT];
    ff_gait_pose(w->space, &w->gait, w->position, w->heading, &hips, out->local);
    for (int j = 0; j < FF_JOINT_COUNT; ++j) {
        int parent = ff_joint_parents[j];
        world[j] = parent < 0 ? out->local[j] : ff_quat_mul(world[parent], out->local[j]);
        out->point[j] =
            parent < 0 ? hips : ff_add3(out->point[parent], ff_quat_rotate(world[parent], body->offset[j]));
        FF_ASSERT_NEAR(ff_quat_dot(out->local[j], out->local[j]), 1.0, 1e-9);
    }
    for (int foot = 0; foot < 2; ++foot) {
        int ankle = FF_JOINT_ANKLE_L + foot * FF_JOINT_LEG_STRIDE, ball = ankle + 1;
        out->point[HEEL_L + foot] =
            ff_add3(out->point[ankle], ff_quat_rotate(world[ankle], body->heel[foot]));
        out->point[TOE_L + foot] = ff_add3(out->point[ball], ff_quat_rotate(world[ball], body->toe[foot]));
        out->planted[foot] = ff_gait_planted(&w->gait, foot) != 0;
        out->progress[foot] = w->gait.foot[foot].progress;
    }
    out->heading = w->heading;
}

/* Rates wanted at time t of a trajectory. */
typedef ff_rates trajectory(double t);

static double ramp(double value, double t, double acceleration)
{
    return ff_min(value, acceleration * t);
}
static ff_rates straight(double t)
{
    return (ff_rates){ramp(1.3, t, 1.5), 0.0, 0.0};
}
static ff_rates slow(double t)
{
    return (ff_rates){ramp(0.4, t, 1.0), 0.0, 0.0};
}
static ff_rates curve(double t)
{
    return (ff_rates){ramp(1.2, t, 1.5), 0.0, ramp(0.8, t, 1.0)};
}
static ff_rates strafe(double t)
{
    return (ff_rates){0.0, ramp(0.45, t, 1.0), 0.0};
}
static ff_rates backward(double t)
{
    return (ff_rates){-ramp(0.7, t, 1.0), 0.0, 0.0};
}
static ff_rates turn_in_place(double t)
{
    return (ff_rates){0.0, 0.0, 1.3 * ff_smooth(t / 0.3) * (1.0 - ff_smooth((t - 3.0) / 0.4))};
}
static ff_rates stop_and_go(double t)
{
    double m = t - 3.0 * floor(t / 3.0);
    return (ff_rates){m < 1.6 ? ramp(1.2, m, 1.8) : ff_max(0.0, 1.2 - 2.0 * (m - 1.6)), 0.0, 0.0};
}
static ff_rates dodging(double t)
{
    double k = ramp(1.0, t, 1.0);
    return (ff_rates){k * (0.7 + 0.5 * sin(2.1 * t) + 0.2 * sin(5.3 * t + 1.0)),
                      k * 0.25 * sin(1.7 * t + 2.0), k * (0.9 * sin(1.3 * t) + 0.4 * sin(4.1 * t))};
}

static const struct {
    const char *name;
    trajectory *rates;
} trajectories[] = {{"straight", straight},       {"slow", slow},         {"curve", curve},
                    {"strafe", strafe},           {"backward", backward}, {"turn in place", turn_in_place},
                    {"stop and go", stop_and_go}, {"dodging", dodging}};
#define TRAJECTORIES (sizeof trajectories / sizeof trajectories[0])

static frame recorded[MAX_FRAMES];

static int record(const ff_walker_space *walker, trajectory *rates, double seconds, uint64_t variation)
{
    walk w;
    begin(walker, &w, variation);
    int count = (int)(seconds * HZ);
    for (int i = 0; i < count; ++i) {
        go(&w, rates(i * DT), DT);
        look(&w, &recorded[i]);
    }
    return count;
}

static int compare_doubles(const void *p, const void *q)
{
    double x = *(const double *)p, y = *(const double *)q;
    return (x > y) - (x < y);
}

/* Paths of the balls on the ground per plant, sorted; returns how many. */
static int plant_paths(int frames, double *paths, int capacity)
{
    int count = 0;
    for (int foot = 0; foot < 2; ++foot) {
        int ball = FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE;
        double path = 0.0;
        for (int i = 1; i < frames; ++i) {
            bool held = recorded[i].planted[foot] && recorded[i - 1].planted[foot];
            if (held)
                path += ff_length2(ff_plane(ff_sub3(recorded[i].point[ball], recorded[i - 1].point[ball])));
            bool over = held && (i + 1 == frames || !recorded[i + 1].planted[foot]);
            if (!over) continue;
            if (count < capacity) paths[count++] = path;
            path = 0.0;
        }
    }
    qsort(paths, (size_t)count, sizeof *paths, compare_doubles);
    return count;
}

static void planted_feet_do_not_skate_on_any_trajectory(void **state)
{
    for (size_t k = 0; k < TRAJECTORIES; ++k)
        for (uint64_t variation = 0; variation < 3; ++variation) {
            double paths[128] = {0};
            int frames = record(*state, trajectories[k].rates, 12.0, variation);
            int count = plant_paths(frames, paths, 128);
            assert_true(count >= 8);
            double median = paths[count / 2], p95 = paths[(int)(0.95 * (count - 1))];
            if (median > 0.0005 || p95 > 0.003) print_error("%s\n", trajectories[k].name);
            FF_ASSERT_BELOW(median, 0.0005);
            FF_ASSERT_BELOW(p95, 0.003);
        }
}

static void one_foot_is_always_down_and_none_goes_under_the_floor(void **state)
{
    for (size_t k = 0; k < TRAJECTORIES; ++k) {
        int frames = record(*state, trajectories[k].rates, 12.0, 5);
        for (int i = 0; i < frames; ++i) {
            const frame *f = &recorded[i];
            double lowest = 1.0;
            for (int p = HEEL_L; p < POINT_COUNT; ++p)
                lowest = ff_min(lowest, f->point[p].y);
            assert_true(f->planted[0] || f->planted[1] || lowest < 0.015); /* or a heel has struck */
            for (int p = HEEL_L; p < POINT_COUNT; ++p)
                FF_ASSERT_BELOW(-0.01, f->point[p].y);
        }
    }
}

/* The least height of heel and toe in the middle half of each swing: people clear 1.4 to 2.3 cm (gait facts). */
static void swinging_feet_clear_the_floor_by_a_centimetre(void **state)
{
    for (size_t k = 0; k < TRAJECTORIES; ++k) {
        int frames = record(*state, trajectories[k].rates, 12.0, 6);
        for (int i = 0; i < frames; ++i)
            for (int foot = 0; foot < 2; ++foot) {
                const frame *f = &recorded[i];
                if (f->planted[foot] || f->progress[foot] < 0.35 || f->progress[foot] > 0.65) continue;
                FF_ASSERT_BELOW(0.01, ff_min(f->point[HEEL_L + foot].y, f->point[TOE_L + foot].y));
            }
    }
}

static void legs_do_not_cross(void **state)
{
    for (size_t k = 0; k < TRAJECTORIES; ++k) {
        int frames = record(*state, trajectories[k].rates, 12.0, 7);
        for (int i = 0; i < frames; ++i) {
            ff_vec2 apart = ff_to_frame2(
                ff_fwd2(recorded[i].heading),
                ff_plane(ff_sub3(recorded[i].point[FF_JOINT_ANKLE_L], recorded[i].point[FF_JOINT_ANKLE_R])));
            if (fabs(apart.a) < 0.05) FF_ASSERT_BELOW(0.03, apart.b);
        }
    }
}

/* Largest speed of a joint at 30 frames/s after the start, deg/s. */
static double joint_speed(int frames, int joint)
{
    double worst = 0.0;
    for (int i = 2; i < frames; ++i) {
        ff_quat step = ff_quat_mul(ff_quat_conj(recorded[i - 2].local[joint]), recorded[i].local[joint]);
        worst = ff_max(worst, ff_quat_angle(step) / FF_DEG * 30.0);
    }
    return worst;
}

static void joints_are_no_faster_than_people_s(void **state)
{
    /* Gait facts, normal walk, 99th percentile of the highest subject, with a margin of 1.3. */
    static const struct {
        int joint;
        double limit;
    } limits[] = {{FF_JOINT_HIP_L, 330.0}, {FF_JOINT_KNEE_L, 594.0},    {FF_JOINT_ANKLE_L, 495.0},
                  {FF_JOINT_HIP_R, 330.0}, {FF_JOINT_KNEE_R, 594.0},    {FF_JOINT_ANKLE_R, 495.0},
                  {FF_JOINT_SPINE, 128.0}, {FF_JOINT_SHOULDER_L, 503.0}};
    for (size_t k = 0; k < TRAJECTORIES; ++k) {
        int frames = record(*state, trajectories[k].rates, 12.0, 8);
        for (size_t i = 0; i < sizeof limits / sizeof limits[0]; ++i) {
            double speed = joint_speed(frames, limits[i].joint);
            if (speed > 1.3 * limits[i].limit)
                print_error("%s, joint %d\n", trajectories[k].name, limits[i].joint);
            FF_ASSERT_BELOW(speed, 1.3 * limits[i].limit);
        }
    }
}

static double knee_flexion(const frame *f, int foot)
{
    int hip = FF_JOINT_HIP_L + foot * FF_JOINT_LEG_STRIDE;
    ff_vec3 thigh = ff_unit3(ff_sub3(f->point[hip + 1], f->point[hip]));
    ff_vec3 shank = ff_unit3(ff_sub3(f->point[hip + 2], f->point[hip + 1]));
    return ff_acos(ff_dot3(thigh, shank)) / FF_DEG;
}

/* Second differences at 60 Hz in 1000 deg/s2: recorded cycles have 7 to 16, more than 30 is a pop (study, section 8);
 * the closed-form walker's own straight cycle has 28. */
static void knees_do_not_pop(void **state)
{
    for (size_t k = 0; k < TRAJECTORIES; ++k) {
        int frames = record(*state, trajectories[k].rates, 12.0, 9);
        for (int i = 1; i + 1 < frames; ++i)
            for (int foot = 0; foot < 2; ++foot) {
                double bend = knee_flexion(&recorded[i + 1], foot) - 2.0 * knee_flexion(&recorded[i], foot) +
                              knee_flexion(&recorded[i - 1], foot);
                FF_ASSERT_BELOW(fabs(bend) * HZ * HZ * 1e-3, 40.0);
            }
    }
}

static int lifts(int frames, int foot)
{
    int count = 0;
    for (int i = 1; i < frames; ++i)
        count += recorded[i - 1].planted[foot] && !recorded[i].planted[foot];
    return count;
}

static ff_rates no_rates(double t)
{
    (void)t;
    return (ff_rates){0.0, 0.0, 0.0};
}

static void who_stands_keeps_the_feet_still_and_sways(void **state)
{
    int frames = record(*state, no_rates, 6.0, 10);
    double sway = 0.0;
    for (int i = 1; i < frames; ++i) {
        for (int foot = 0; foot < 2; ++foot) {
            int ball = FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE;
            FF_ASSERT_BELOW(ff_length3(ff_sub3(recorded[i].point[ball], recorded[0].point[ball])), 1e-6);
            assert_true(recorded[i].planted[foot]);
        }
        sway = ff_max(sway, ff_length3(ff_sub3(recorded[i].point[0], recorded[0].point[0])));
    }
    FF_ASSERT_BELOW(0.005, sway);
    FF_ASSERT_BELOW(joint_speed(frames, FF_JOINT_NECK), 20.0);
    FF_ASSERT_BELOW(1.0, joint_speed(frames, FF_JOINT_NECK));
}

static ff_rates walk_then_stand(double t)
{
    return (ff_rates){t < 4.0 ? ramp(1.2, t, 1.5) : ff_max(0.0, 1.2 - 2.0 * (t - 4.0)), 0.0, 0.0};
}

static void who_stops_closes_the_feet_and_stands(void **state)
{
    for (uint64_t variation = 0; variation < 8; ++variation) {
        int frames = record(*state, walk_then_stand, 9.0, variation);
        for (int i = (int)(6.2 * HZ); i < frames; ++i)
            for (int foot = 0; foot < 2; ++foot)
                assert_true(recorded[i].planted[foot]);
        ff_vec3 apart =
            ff_sub3(recorded[frames - 1].point[FF_JOINT_BALL_L], recorded[frames - 1].point[FF_JOINT_BALL_R]);
        FF_ASSERT_BELOW(fabs(apart.z), 0.21);
        FF_ASSERT_BELOW(0.08, apart.x);
        FF_ASSERT_BELOW(apart.x, 0.31);
    }
}

static void turning_on_the_spot_is_done_in_steps(void **state)
{
    int frames = record(*state, turn_in_place, 6.0, 11);
    assert_in_range(lifts(frames, 0), 2, 8);
    assert_in_range(lifts(frames, 1), 2, 8);
    assert_true(recorded[frames - 1].planted[0] && recorded[frames - 1].planted[1]);
}

static void the_foot_on_the_side_one_goes_to_steps_first(void **state)
{
    int frames = record(*state, strafe, 3.0, 12);
    int first = 0;
    while (first < frames && recorded[first].planted[0] && recorded[first].planted[1])
        ++first;
    assert_true(first < frames && !recorded[first].planted[0]);
}

static void the_state_depends_on_nothing_but_its_arguments(void **state)
{
    walk first, second;
    begin(*state, &first, 13);
    begin(*state, &second, 13);
    for (int i = 0; i < 6 * HZ; ++i) {
        frame seen;
        go(&first, dodging(i * DT), DT);
        look(&first, &seen); /* asking for poses changes nothing */
        go(&second, dodging(i * DT), DT);
    }
    assert_int_equal(ff_gait_size(), sizeof first.gait);
    assert_memory_equal(&first.gait, &second.gait, sizeof first.gait);
}

static ff_rates round_and_round(double t)
{
    return (ff_rates){ramp(0.8, t, 1.0), 0.0, ramp(1.2, t, 1.0)};
}

/* The crowd keeps headings in (-pi, pi]: nothing may jump where they wrap. */
static void full_turns_make_no_difference(void **state)
{
    static walk plain, wrapped;
    begin(*state, &plain, 14);
    begin(*state, &wrapped, 14);
    for (int i = 0; i < 12 * HZ; ++i) {
        frame seen, same;
        go(&plain, round_and_round(i * DT), DT);
        go(&wrapped, round_and_round(i * DT), DT);
        wrapped.heading = ff_wrap(wrapped.heading);
        look(&plain, &seen);
        look(&wrapped, &same);
        for (int p = 0; p < POINT_COUNT; ++p)
            FF_ASSERT_BELOW(ff_length3(ff_sub3(seen.point[p], same.point[p])), 1e-6);
    }
    FF_ASSERT_BELOW(2.0 * FF_TAU, plain.heading);
}

static void walk_one(void *context, uint32_t index)
{
    walk *w = (walk *)context + index;
    for (int i = 0; i < 3 * HZ; ++i)
        go(w, dodging(i * DT + index), DT);
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    static walk one[48], many[48];
    ff_error error;
    for (int i = 0; i < 48; ++i) {
        begin(*state, &one[i], (uint64_t)i);
        begin(*state, &many[i], (uint64_t)i);
        walk_one(one, (uint32_t)i);
    }
    ff_tasks *tasks;
    FF_ASSERT_OK(ff_tasks_create(4, &tasks, &error), error);
    ff_tasks_for(tasks, 48, 1, walk_one, many);
    ff_tasks_destroy(tasks);
    for (int i = 0; i < 48; ++i)
        assert_memory_equal(&one[i].gait, &many[i].gait, sizeof one[i].gait);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planted_feet_do_not_skate_on_any_trajectory),
        cmocka_unit_test(one_foot_is_always_down_and_none_goes_under_the_floor),
        cmocka_unit_test(swinging_feet_clear_the_floor_by_a_centimetre),
        cmocka_unit_test(legs_do_not_cross),
        cmocka_unit_test(joints_are_no_faster_than_people_s),
        cmocka_unit_test(knees_do_not_pop),
        cmocka_unit_test(who_stands_keeps_the_feet_still_and_sways),
        cmocka_unit_test(who_stops_closes_the_feet_and_stands),
        cmocka_unit_test(turning_on_the_spot_is_done_in_steps),
        cmocka_unit_test(the_foot_on_the_side_one_goes_to_steps_first),
        cmocka_unit_test(the_state_depends_on_nothing_but_its_arguments),
        cmocka_unit_test(full_turns_make_no_difference),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
    };
    return cmocka_run_group_tests(tests, open_full_walkers, close_walkers);
}
