/* Whole builds: the same bytes for any number of threads, order of inputs and folder; bad clips named and left out; a
 * pack that the runtime opens and that says what the clips hold. */
#define _GNU_SOURCE
#include "tests/built_in_pack.h"
#include "tests/preprocess/build_folder.h"
#include "tests/preprocess/pack_bars.h"

/* ------------------------------------------------------------------------------------------------------------ tests */

static image
    built_in; /* as make built it; tests/e2e/pipeline.sh builds it once more and compares the bytes */

static int build_built_in(void **state)
{
    (void)state;
    ff_error error;
    FF_ASSERT_OK(ff_pack_open(ff_built_in_pack_path(), &built_in.pack, &error), error);
    return 0;
}

static int free_built_in(void **state)
{
    (void)state;
    image_free(&built_in);
    return 0;
}

static void examples_are_closed_and_correspond_within_the_limits(void **state)
{
    (void)state;
    ff_pack_bars bars = ff_bars_measure(built_in.pack);
    ff_bars_print(&bars);
    assert_true(ff_bars_met(&bars));
    FF_ASSERT_BELOW(bars.stored, FF_BARS_SLACK);
    assert_true(2 * bars.found[0] > bars.possible[0] && 2 * bars.found[1] > bars.possible[1]);
    assert_int_equal(built_in.pack->loop_count, built_in.pack->example_count);
    assert_true(built_in.pack->gait_count == 1 && built_in.pack->sharp_count >= 2);
}

static void the_built_in_pack_holds_what_walking_needs(void **state)
{
    (void)state;
    const ff_pack *pack = built_in.pack;
    assert_true(pack->clip_count >= 24);
    uint32_t captured = 0;
    for (uint32_t i = 0; i < pack->clip_count; ++i)
        captured += !(pack->clips[i].flags & FF_CLIP_DERIVED);
    assert_int_equal(captured, ff_generator_count());
    assert_true(pack->action_count >= 200);
    assert_true(pack->hull_count >= 4);
    assert_int_equal(pack->track_count, 2 * pack->frame_count - pack->foot_count);
    bool rests_in_simplex = false;
    for (uint32_t i = 0; i < pack->simplex_count; ++i) {
        const ff_pack_simplex *s = &pack->simplices[i];
        assert_true(s->gait != FF_GAIT_WALK || s->vertex[3] >= 0); /* tetrahedra, as blending wants */
        for (int k = 0; k < 4 && s->vertex[k] >= 0; ++k) {
            const ff_pack_example *e = &pack->examples[s->vertex[k]];
            rests_in_simplex =
                rests_in_simplex || (e->v_forward == 0.0f && e->v_left == 0.0f && e->turn_rate == 0.0f);
        }
    }
    assert_true(rests_in_simplex);
    for (uint32_t i = 0; i < pack->clip_count; ++i) {
        const char *source = ff_pack_string(pack, pack->clips[i].source);
        assert_int_equal(strncmp(source, "built-in/", 9), 0);
    }
}

static void folder_and_order_of_inputs_do_not_change_a_byte(void **state)
{
    (void)state;
    char first[32], second[32], a[256], b[256];
    make_folder(first);
    make_folder(second);
    const char *names[] = {"walk-normal", "walk-slow", "curve-left"};
    for (int i = 0; i < 3; ++i) {
        write_clip(first, names[i]);
        write_clip(second, names[2 - i]);
    }
    snprintf(a, sizeof a, "%s/walk-slow.bvh", second);
    snprintf(b, sizeof b, "%s/walk-normal.bvh", second);
    char c[256];
    snprintf(c, sizeof c, "%s/curve-left.bvh", second);
    const char *folder_input[] = {first}, *file_inputs[] = {a, c, b};
    ff_catalogue x = catalogue_of(folder_input, 1), y = catalogue_of(file_inputs, 3);
    image p = build_image(&x, 2), q = build_image(&y, 1);
    assert_int_equal(p.size, q.size);
    assert_memory_equal(p.data, q.data, p.size);
    assert_string_equal(ff_pack_string(p.pack, p.pack->clips[0].source), "curve-left.bvh");
    assert_null(memmem(p.data, p.size, "/tmp/", 5));
    image_free(&p);
    image_free(&q);
    ff_catalogue_free(&x);
    ff_catalogue_free(&y);
    remove_folder(first);
    remove_folder(second);
}

static void a_bad_clip_is_named_and_left_out_or_ends_a_strict_build(void **state)
{
    (void)state;
    char folder[32];
    make_folder(folder);
    write_clip(folder, "walk-normal");
    write_text(folder, "broken.bvh", "HIERARCHY\nROOT hips\n{\n  OFFSET 0 nan 0\n}\n");
    const char *inputs[] = {folder};
    ff_catalogue catalogue = catalogue_of(inputs, 1);
    ff_build_settings settings = ff_build_settings_default();
    ff_build_result built;
    ff_error error;
    settings.quiet = true;
    settings.pack.actions.derive = false;
    FF_ASSERT_OK(ff_build(&catalogue, &settings, &built, &error), error);
    assert_int_equal(built.skipped_count, 1);
    assert_non_null(strstr(built.skipped[0].file, "broken.bvh"));
    assert_int_equal(built.content.clips.count, 1);
    ff_build_result_free(&built);
    settings.strict = true;
    assert_int_not_equal(ff_build(&catalogue, &settings, &built, &error), FF_OK);
    assert_non_null(strstr(error.file, "broken.bvh"));
    ff_build_result_free(&built);
    ff_catalogue_free(&catalogue);

    char path[256], *arguments[] = {folder, "--strict", "--quiet", "--no-cache", "-o", path, NULL};
    snprintf(path, sizeof path, "%s/out.ffpack", folder);
    assert_int_equal(ff_build_command(6, arguments), 1);
    assert_int_not_equal(access(path, F_OK), 0);
    remove_folder(folder);
}

static void clips_that_never_walk_are_refused_with_the_reason(void **state)
{
    (void)state;
    char folder[32];
    make_folder(folder);
    write_clip(folder, "idle");
    const char *inputs[] = {folder};
    ff_catalogue catalogue = catalogue_of(inputs, 1);
    ff_build_settings settings = ff_build_settings_default();
    ff_build_result built;
    ff_error error;
    settings.quiet = true;
    assert_int_equal(ff_build(&catalogue, &settings, &built, &error), FF_ERR_NO_DATA);
    assert_non_null(strstr(error.message, "no straight walk to build on"));
    ff_build_result_free(&built);
    ff_catalogue_free(&catalogue);
    remove_folder(folder);
}

static void trimmed_clips_keep_the_times_of_the_file(void **state)
{
    (void)state;
    char folder[32], path[256];
    make_folder(folder);
    write_clip(folder, "walk-normal");
    write_text(folder, "whole.json", "{\"unit\": \"m\", \"clips\": [{\"file\": \"walk-normal.bvh\"}]}");
    write_text(folder, "part.json",
               "{\"unit\": \"m\", \"clips\": [{\"file\": \"walk-normal.bvh\", \"trim\": [120, -1]}]}");
    image packs[2];
    for (int i = 0; i < 2; ++i) {
        snprintf(path, sizeof path, "%s/%s.json", folder, i ? "part" : "whole");
        const char *inputs[] = {path};
        ff_catalogue catalogue = catalogue_of(inputs, 1);
        packs[i] = build_image(&catalogue, 1);
        ff_catalogue_free(&catalogue);
    }
    const ff_pack *whole = packs[0].pack, *part = packs[1].pack;
    FF_ASSERT_NEAR((double)part->clips[0].time_offset, 1.0, 1e-6);
    assert_true(part->plant_count < whole->plant_count);
    const ff_pack_plant *a = &whole->plants[whole->plant_count - 2],
                        *b = &part->plants[part->plant_count - 2];
    FF_ASSERT_NEAR((double)a->start, (double)b->start, 0.02);
    FF_ASSERT_NEAR((double)a->flat_end, (double)b->flat_end, 0.02);
    for (int i = 0; i < 2; ++i)
        image_free(&packs[i]);
    remove_folder(folder);
}

static void mirrored_actions_follow_all_captured_ones(void **state)
{
    (void)state;
    const ff_pack *pack = built_in.pack;
    bool mirrored = false;
    uint32_t captured = 0;
    for (uint32_t i = 0; i < pack->action_count; ++i) {
        bool here = (pack->actions[i].flags & FF_ACTION_MIRRORED) != 0;
        assert_true(here || !mirrored);
        mirrored = here;
        captured += !here;
    }
    assert_true(mirrored);
    uint32_t sum = 0;
    for (uint32_t i = 0; i < pack->clip_count; ++i) {
        assert_true(pack->clips[i].action_count == 0 || pack->clips[i].first_action == sum);
        sum += pack->clips[i].action_count;
    }
    assert_int_equal(sum, captured);
}

static void a_dozen_captured_clips_give_a_pack_that_walks(void **state)
{
    (void)state;
    if (!ff_shared_folder()) {
        print_message("SKIPPED: captured clips: no folder of outside data\n");
        skip();
    }
    const char *names[] = {"16_15", "16_21", "16_47", "16_11", "16_13", "16_23",
                           "16_31", "16_33", "16_35", "16_58", "16_19", "16_01"};
    char paths[12][256];
    const char *inputs[12];
    for (int i = 0; i < 12; ++i) {
        snprintf(paths[i], sizeof paths[i], "%s/data/cmu/16/%s.amc", ff_shared_folder(), names[i]);
        inputs[i] = paths[i];
    }
    ff_catalogue catalogue = catalogue_of(inputs, 12);
    image one = build_image(&catalogue, 1), two = build_image(&catalogue, 2);
    assert_int_equal(one.size, two.size);
    assert_memory_equal(one.data, two.data, one.size);
    uint32_t straight = 0;
    for (uint32_t i = 0; i < one.pack->example_count; ++i) {
        const ff_pack_example *e = &one.pack->examples[i];
        straight += e->v_forward > 0.8f && e->turn_rate == 0.0f && !(e->flags & FF_EXAMPLE_DERIVED);
        assert_true(e->seam < 0.081f);
    }
    assert_true(straight >= 3);
    image_free(&one);
    image_free(&two);
    ff_catalogue_free(&catalogue);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(examples_are_closed_and_correspond_within_the_limits),
        cmocka_unit_test(the_built_in_pack_holds_what_walking_needs),
        cmocka_unit_test(folder_and_order_of_inputs_do_not_change_a_byte),
        cmocka_unit_test(a_bad_clip_is_named_and_left_out_or_ends_a_strict_build),
        cmocka_unit_test(clips_that_never_walk_are_refused_with_the_reason),
        cmocka_unit_test(trimmed_clips_keep_the_times_of_the_file),
        cmocka_unit_test(mirrored_actions_follow_all_captured_ones),
        cmocka_unit_test(a_dozen_captured_clips_give_a_pack_that_walks),
    };
    return cmocka_run_group_tests(tests, build_built_in, free_built_in);
}
