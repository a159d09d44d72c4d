/* Every setting changes what its stage finds: each is moved to the ends of its range, one at a time, and the results are
 * compared with those of the defaults. So no row of the table is read by nobody, and none is of a later stage than it
 * says, as a stage is given the settings of its own and earlier ones only. */
#include "tests/preprocess/motion_make.h"
#include "tests/preprocess/setting_rows.h"

#include "preprocess/actions/steps.h"
#include "preprocess/clean/clean.h"
#include "preprocess/examples/cycles.h"
#include "preprocess/examples/example_judge.h"

/* ------------------------------------------------------------------------------------------------------ the clips */

/* Short ones; what is done to them before they are looked at. */
enum { CLIPS = 9 };
typedef enum change { AS_IS, JUMPS, STEPS_UP, LIFTS_A_FOOT, SLOWED, HURRIED } change;
static const struct {
    const char *name;
    change change;
    double seconds;
} sources[CLIPS] = {
    {"walk-normal", JUMPS, 3.0}, {"jog", SLOWED, 2.5},         {"curve-left-tight", AS_IS, 4.0},
    {"stop-slow", AS_IS, 9.0},   {"turn-left-90", AS_IS, 4.0}, {"jump", HURRIED, 5.0},
    {"idle", LIFTS_A_FOOT, 6.0}, {"back", AS_IS, 3.0},         {"walk-slow", STEPS_UP, 5.0}};
static ff_clip clips[CLIPS];

static void jump_and_freeze(ff_clip *clip)
{
    size_t joints = (size_t)clip->joint_count, tracks = (size_t)clip->track_count;
    for (int f = clip->frame_count / 2; f < clip->frame_count; ++f)
        clip->positions[(size_t)f * tracks].x += 0.15;
    for (int f = clip->frame_count / 4, last = f + 4; f < last; ++f) {
        memcpy(clip->rotations + (size_t)f * joints, clip->rotations + (size_t)(f - 1) * joints,
               joints * sizeof *clip->rotations);
        memcpy(clip->positions + (size_t)f * tracks, clip->positions + (size_t)(f - 1) * tracks,
               tracks * sizeof *clip->positions);
    }
}

/* Up, and down again. */
static void step_up(ff_clip *clip)
{
    double end = clip->frame_count * clip->frame_time;
    for (int f = 0; f < clip->frame_count; ++f) {
        double t = f * clip->frame_time;
        clip->positions[(size_t)f * (size_t)clip->track_count].y +=
            0.12 * ff_smooth((t - 0.4 * end) / 0.4) * ff_smooth((0.8 * end - t) / 0.4);
    }
}

static void turn(ff_clip *clip, int frame, ff_role role, double angle)
{
    ff_quat *q = clip->rotations + (size_t)frame * (size_t)clip->joint_count + ff_clip_find(clip, role);
    *q = ff_quat_mul(*q, ff_quat_axis(ff_v3(1.0, 0.0, 0.0), angle));
}

/* Held in the air for a while. */
static void lift_a_foot(ff_clip *clip)
{
    for (int f = 0; f < clip->frame_count; ++f) {
        double t = f * clip->frame_time, up = ff_smooth((t - 1.0) / 0.3) * ff_smooth((3.0 - t) / 0.3);
        turn(clip, f, FF_ROLE_HIP_L, -0.5 * up);
        turn(clip, f, FF_ROLE_KNEE_L, 0.9 * up);
        turn(clip, f, FF_ROLE_ANKLE_L, -0.4 * up);
    }
}

/* As captured: sliding, on a floor that is neither level nor at zero. */
static ff_clip captured(int index)
{
    const ff_generator_options options = {.seed = 3, .skate_cm = 1.5, .floor_cm = 4.0, .tilt_deg = 0.5};
    ff_generated made;
    FF_ASSERT_OK(ff_generator_make(ff_generator_find(sources[index].name), &options, &made, &error), error);
    ff_clip clip = made.clip;
    memset(&made.clip, 0, sizeof made.clip);
    ff_generated_free(&made);
    int last = (int)(sources[index].seconds / clip.frame_time);
    if (last < clip.frame_count - 1) FF_ASSERT_OK(ff_clip_keep(&clip, 0, last, &error), error);
    if (sources[index].change == JUMPS) jump_and_freeze(&clip);
    if (sources[index].change == STEPS_UP) step_up(&clip);
    if (sources[index].change == LIFTS_A_FOOT) lift_a_foot(&clip);
    if (sources[index].change == SLOWED) clip.frame_time *= 1.3;  /* runs at 1.85 m/s */
    if (sources[index].change == HURRIED) clip.frame_time *= 0.6; /* a hop */
    return clip;
}

static int make_clips(void **state)
{
    (void)state;
    for (int i = 0; i < CLIPS; ++i)
        clips[i] = captured(i);
    return 0;
}

static int free_clips(void **state)
{
    (void)state;
    for (int i = 0; i < CLIPS; ++i)
        ff_clip_free(&clips[i]);
    return 0;
}

/* ----------------------------------------------------------------------------------------------- plants of one clip */

static uint64_t found(const ff_settings *settings)
{
    uint64_t hash = 0;
    for (int i = 0; i < CLIPS; ++i) {
        ff_plants plants;
        if (ff_plants_find(&clips[i], &settings->find, &plants, &error) != FF_OK) return 1;
        for (int p = 0; p < plants.count; ++p) {
            const ff_plant *q = &plants.items[p];
            const double numbers[] = {q->foot,       q->start,  q->end,    q->flat_start, q->flat_end,
                                      q->confidence, q->ball.a, q->ball.b, q->level};
            hash = mix(numbers, sizeof numbers, hash);
        }
        hash = mix(&plants.floor, sizeof plants.floor, hash);
        for (int b = 0; b < plants.breaks.count; ++b)
            hash = mix(&plants.breaks.items[b].first, 3 * sizeof(int), hash);
        ff_plants_free(&plants);
    }
    return hash;
}

static void settings_of_what_is_found_matter(void **state)
{
    (void)state;
    static const char *const sections[] = {"breaks", "plants", "floor", NULL};
    assert_rows_matter(sections, found);
}

/* ---------------------------------------------------------------------------------------------- a clip on the rig */

typedef struct on_rig {
    ff_rig rig;
    ff_plants plants[CLIPS];
    ff_motion motion[CLIPS];
} on_rig;

static on_rig base;

static int make_motions(void **state)
{
    make_clips(state);
    const ff_clip *first = &clips[0];
    FF_ASSERT_OK(ff_rig_from_clips(&first, 1, &base.rig, &error), error);
    for (int r = 0; r < FF_BODY_COUNT; ++r) /* another person's: feet slide more */
        base.rig.offset[r] = ff_scale3(base.rig.offset[r], r < FF_ROLE_HIP_L ? 1.0 : 1.06);
    for (int i = 0; i < CLIPS; ++i) {
        FF_ASSERT_OK(ff_plants_find(&clips[i], &standard()->find, &base.plants[i], &error), error);
        FF_ASSERT_OK(ff_motion_from_clip(&base.rig, &clips[i], &base.plants[i], &base.motion[i], &error),
                     error);
    }
    ff_motion *back = &base.motion[7];
    for (int k = 0; k < back->frame_count; ++k) { /* under a bar */
        double t = k * back->frame_time;
        back->hips[k].z *= 1.0 - 0.3 * ff_smooth((t - 0.9) / 0.3) * ff_smooth((2.1 - t) / 0.3);
    }
    return 0;
}

static int free_motions(void **state)
{
    for (int i = 0; i < CLIPS; ++i) {
        ff_plants_free(&base.plants[i]);
        ff_motion_free(&base.motion[i]);
    }
    return free_clips(state);
}

/* The shortest clips only: this is the slow one. */
static uint64_t cleaned(const ff_settings *settings)
{
    uint64_t hash = 0;
    for (int i = 2; i < 5; ++i) {
        ff_motion motion;
        ff_clean_report report;
        FF_ASSERT_OK(ff_motion_copy(&base.motion[i], &motion, &error), error);
        ff_status status =
            ff_motion_clean(&base.rig, &settings->cut.clean, &motion, &base.plants[i], &report, &error);
        hash = mix(&status, sizeof status, hash);
        hash = mix(motion.rotations,
                   (size_t)motion.frame_count * FF_ROLE_JOINT_COUNT * sizeof *motion.rotations, hash);
        ff_motion_free(&motion);
    }
    return hash;
}

static void settings_of_the_clean_up_matter(void **state)
{
    (void)state;
    static const char *const sections[] = {"clean", NULL};
    assert_rows_matter(sections, cleaned);
}

static uint64_t cut(const ff_settings *settings)
{
    uint64_t hash = 0;
    for (int i = 0; i < CLIPS; ++i) {
        ff_actions actions;
        FF_ASSERT_OK(
            ff_actions_cut(&settings->cut, &base.rig, &base.motion[i], &base.plants[i], -1, &actions, &error),
            error);
        for (int k = 0; k < actions.count; ++k) {
            const ff_action *a = &actions.items[k];
            hash = mix(&a->record, sizeof a->record, hash);
            hash = mix(a->colliders, a->record.collider_samples * sizeof a->colliders[0], hash);
        }
        hash = mix(&actions.count, sizeof actions.count, hash);
        ff_actions_free(&actions);
    }
    return hash;
}

static void settings_of_actions_matter(void **state)
{
    (void)state;
    static const char *const sections[] = {"steps", "standing", "whole", "energy", "colliders", NULL};
    assert_rows_matter(sections, cut);
}

static ff_cycles cycles_of(const ff_settings *settings, int clip)
{
    ff_cycles cycles;
    const ff_cycle_settings *own = &settings->cut.cycles;
    FF_ASSERT_OK(ff_cycles_cut(own, &base.rig, &base.motion[clip], &base.plants[clip], 0, sources[clip].name,
                               &cycles, &error),
                 error);
    FF_ASSERT_OK(ff_cycles_cut_half(own, &base.rig, &base.motion[clip], &base.plants[clip], 0,
                                    sources[clip].name, &cycles, &error),
                 error);
    FF_ASSERT_OK(ff_cycles_cut_idle(own, &base.rig, &base.motion[clip], &base.plants[clip], 0,
                                    sources[clip].name, &cycles, &error),
                 error);
    return cycles;
}

static uint64_t cycled(const ff_settings *settings)
{
    uint64_t hash = 0;
    for (int i = 0; i < CLIPS; ++i) {
        ff_cycles cycles = cycles_of(settings, i);
        for (int k = 0; k < cycles.count; ++k)
            hash = mix(&cycles.items[k].record, sizeof cycles.items[k].record, hash);
        ff_cycles_free(&cycles);
    }
    return hash;
}

static void settings_of_cycles_matter(void **state)
{
    (void)state;
    static const char *const sections[] = {"cycles", NULL};
    assert_rows_matter(sections, cycled);
}

/* Which cycles are judged good, strictly and loosely. */
static uint64_t judged(const ff_settings *settings)
{
    static ff_cycles cycles[CLIPS]; /* cut once */
    static bool made;
    const ff_example_settings *own = &settings->cut.examples;
    uint64_t hash = 0;
    for (int i = 0; i < CLIPS; ++i) {
        if (!made) cycles[i] = cycles_of(standard(), i);
        for (int k = 0; k < cycles[i].count; ++k) {
            char why[2][96] = {{0}};
            const ff_example *e = &cycles[i].items[k];
            const bool good[2] = {ff_example_judge(own, &base.rig, e, why[0], sizeof why[0]),
                                  ff_example_judge_loosely(own, &base.rig, e, why[1], sizeof why[1])};
            hash = mix(good, sizeof good, hash);
        }
    }
    made = true;
    return hash;
}

static void settings_of_examples_matter(void **state)
{
    (void)state;
    static const char *const sections[] = {"examples", NULL};
    assert_rows_matter_but(sections, "spacing", judged); /* test_settings_pack.c has those */
}

int main(void)
{
    const struct CMUnitTest of_clips[] = {cmocka_unit_test(settings_of_what_is_found_matter)};
    const struct CMUnitTest of_motions[] = {
        cmocka_unit_test(settings_of_the_clean_up_matter),
        cmocka_unit_test(settings_of_actions_matter),
        cmocka_unit_test(settings_of_cycles_matter),
        cmocka_unit_test(settings_of_examples_matter),
    };
    int failed = cmocka_run_group_tests(of_clips, make_clips, free_clips);
    return failed + cmocka_run_group_tests(of_motions, make_motions, free_motions);
}
