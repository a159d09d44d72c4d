/* Sets of clips without a whole straight walking cycle: one step and its mirror image make one, symmetric to the bit and
 * with the clip's own rates; then a cycle that closes badly; and when nothing will do, the message says what there is. */
#include "tests/preprocess/cycles_make.h"

#include "preprocess/examples/example_judge.h"
#include "preprocess/examples/examples.h"

/* Only half cycles. */
static ff_cycles cut_half(const ff_rig *rig, const made_motion *made)
{
    ff_error error;
    ff_cycles cycles = cut_cycles(rig, made);
    for (int i = 0; i < cycles.count; ++i)
        ff_example_free(&cycles.items[i]);
    cycles.count = 0;
    FF_ASSERT_OK(ff_cycles_cut_half(&standard()->cut.cycles, rig, &made->motion, &made->plants, 0,
                                    made->clip.name, &cycles, &error),
                 error);
    return cycles;
}

static double farthest(const ff_rig *rig, const ff_example *a, const ff_example *b)
{
    double most = 0.0;
    assert_int_equal(a->frame_count, b->frame_count);
    for (int k = 0; k < a->frame_count; ++k) {
        ff_vec3 p[FF_BODY_COUNT], q[FF_BODY_COUNT];
        ff_example_pose(rig, a, k, p);
        ff_example_pose(rig, b, k, q);
        for (int r = 0; r < FF_ROLE_COUNT; ++r)
            most = ff_max(most, ff_length3(ff_sub3(p[r], q[r])));
    }
    return most;
}

static void a_step_and_its_mirror_image_are_a_symmetric_walk_of_the_same_rates(void **state)
{
    (void)state;
    static const char *const names[] = {"walk-slow", "walk-normal", "walk-fast"};
    for (int n = 0; n < 3; ++n) {
        ff_clip clip = generated_clip(names[n]);
        ff_rig rig = rig_of(&clip);
        made_motion made = make_motion(&rig, clip);
        ff_cycles whole = cut_cycles(&rig, &made), half = cut_half(&rig, &made);
        assert_true(half.count >= 2 * whole.count - 1); /* from either foot */
        for (int i = 0; i < half.count; ++i) {
            ff_example *e = &half.items[i], other;
            const ff_pack_example *r = &e->record, *w = &whole.items[0].record;
            char why[96];
            ff_error error;
            assert_true(r->flags & FF_EXAMPLE_LOOSE);
            assert_true(ff_example_is_model(e));
            assert_true(ff_example_judge(&standard()->cut.examples, &rig, e, why, sizeof why));
            FF_ASSERT_NEAR((double)r->v_forward, (double)w->v_forward, 0.02);
            FF_ASSERT_NEAR((double)r->period, (double)w->period, 0.02);
            for (int k = 0; k < 4; ++k)
                FF_ASSERT_NEAR((double)r->key[k], (double)w->key[k], 0.02);
            FF_ASSERT_NEAR((double)r->key[2], 0.5, 1e-6);
            FF_ASSERT_BELOW((double)e->loop.jump, 1e-4);
            FF_ASSERT_BELOW((double)e->loop.moved, 0.01);
            if (e->frame_count % 2 == 0) {
                FF_ASSERT_OK(ff_example_mirror(&rig, e, &other, &error), error);
                FF_ASSERT_BELOW(farthest(&rig, e, &other), 1e-6);
                ff_example_free(&other);
            }
        }
        ff_cycles_free(&whole);
        ff_cycles_free(&half);
        made_motion_free(&made);
    }
}

/* One person's cycles through the choice. */
static ff_status choose(const ff_rig *rig, ff_cycles *cycles, ff_example_set *set, ff_error *error)
{
    int subject = 0;
    return ff_examples_select(&standard()->cut.examples, rig, cycles, &subject, 1, set, error);
}

static void half_cycles_are_taken_when_no_whole_one_will_do_and_only_then(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    ff_rig rig = rig_of(&clip);
    made_motion made = make_motion(&rig, clip);
    for (int with_whole = 0; with_whole < 2; ++with_whole) {
        ff_cycles cycles = with_whole ? cut_cycles(&rig, &made) : cut_half(&rig, &made);
        ff_example_set set;
        ff_error error;
        if (with_whole)
            FF_ASSERT_OK(ff_cycles_cut_half(&standard()->cut.cycles, &rig, &made.motion, &made.plants, 0, "x",
                                            &cycles, &error),
                         error);
        FF_ASSERT_OK(choose(&rig, &cycles, &set, &error), error);
        assert_int_equal(set.level, with_whole ? FF_LEVEL_FIRM : FF_LEVEL_HALF);
        int loose = 0, derived = 0;
        for (int i = 0; i < set.count; ++i) {
            loose += (set.items[i].record.flags & FF_EXAMPLE_LOOSE) != 0;
            derived += (set.items[i].record.flags & FF_EXAMPLE_DERIVED) != 0;
        }
        assert_int_equal(loose, with_whole ? 0 : 1);
        assert_true(derived > 10);
        ff_example_set_free(&set);
        ff_cycles_free(&cycles);
    }
    made_motion_free(&made);
}

static void the_best_of_cycles_that_close_badly_is_taken_last(void **state)
{
    (void)state;
    made_cycles of = make_cycles("walk-normal");
    ff_example_set set;
    ff_error error;
    for (int i = 0; i < of.cycles.count; ++i) { /* as if closing had moved joints this far */
        of.cycles.items[i].loop.moved = 0.05f + 0.01f * (float)i;
        of.cycles.items[i].record.seam = 0.02f + 0.01f * (float)i;
    }
    char best[96];
    memcpy(best, of.cycles.items[0].name, sizeof best);
    FF_ASSERT_OK(choose(&of.rig, &of.cycles, &set, &error), error);
    assert_int_equal(set.level, FF_LEVEL_LOOSE);
    assert_string_equal(set.items[set.gait.gait.example].name, best);
    assert_true(set.items[set.gait.gait.example].record.flags & FF_EXAMPLE_LOOSE);
    assert_int_equal(set.gait.gait.walks, 0); /* no law is fitted to such */
    ff_example_set_free(&set);
    made_cycles_free(&of);
}

static void what_there_is_instead_of_a_walk_is_told(void **state)
{
    (void)state;
    static const struct {
        const char *clip, *says;
        float moved;
    } cases[] = {{"idle", "nobody is seen to land", 0.0f},
                 {"run", "run", 0.0f},
                 {"curve-left-tight", "turn", 0.0f},
                 {"strafe-left", "go aside", 0.0f},
                 {"walk-normal", "closing moves a joint by cm 30.0, at most 10.0", 0.3f}};
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; ++n) {
        made_cycles of = make_cycles(cases[n].clip);
        ff_example_set set;
        ff_error error;
        for (int i = 0; i < of.cycles.count; ++i)
            of.cycles.items[i].loop.moved = fmaxf(of.cycles.items[i].loop.moved, cases[n].moved);
        assert_int_equal(choose(&of.rig, &of.cycles, &set, &error), FF_ERR_NO_DATA);
        if (!strstr(error.message, cases[n].says)) fail_msg("%s: %s", cases[n].clip, error.message);
        made_cycles_free(&of);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_and_its_mirror_image_are_a_symmetric_walk_of_the_same_rates),
        cmocka_unit_test(half_cycles_are_taken_when_no_whole_one_will_do_and_only_then),
        cmocka_unit_test(the_best_of_cycles_that_close_badly_is_taken_last),
        cmocka_unit_test(what_there_is_instead_of_a_walk_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
