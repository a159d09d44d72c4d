/* Override files: what a person wrote about a clip's plants holds; what does not fit is refused with its line. */
#define _GNU_SOURCE
#include "preprocess/plants/plant_edit.h"

#include "preprocess/actions/steps.h"
#include "tests/preprocess/motion_make.h"
#include "tests/preprocess/standard.h"

#include <stdio.h>
#include <unistd.h>

static ff_plant_edits parse(const char *text)
{
    ff_plant_edits edits;
    ff_error error;
    FF_ASSERT_OK(ff_plant_edits_parse(text, strlen(text), "walk.plants.json", &edits, &error), error);
    return edits;
}

static ff_plants find_edited(const ff_clip *clip, const char *text)
{
    ff_plant_edits edits = parse(text);
    ff_plants plants;
    ff_error error;
    FF_ASSERT_OK(ff_plants_find_edited(clip, &standard()->find, &edits, &plants, &error), error);
    ff_plant_edits_free(&edits);
    return plants;
}

static const ff_plant *plant_at(const ff_plants *plants, int foot, int frame)
{
    for (int i = 0; i < plants->count; ++i)
        if (plants->items[i].foot == foot && plants->items[i].start <= frame && frame <= plants->items[i].end)
            return &plants->items[i];
    return NULL;
}

static void what_a_person_wrote_holds(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    ff_plants found;
    ff_error error;
    FF_ASSERT_OK(ff_plants_find(&clip, &standard()->find, &found, &error), error);
    const ff_plant *second = plant_at(&found, FF_LEFT, 180), *third = plant_at(&found, FF_RIGHT, 250);
    assert_true(second && third && !second->written);
    ff_plants plants = find_edited(&clip, "{\"move\": [{\"foot\": \"left\", \"frame\": 180, \"start\": 150, "
                                          "\"end\": 215, \"flat\": [160, 200]}],"
                                          " \"remove\": [{\"foot\": \"right\", \"frame\": 250}],"
                                          " \"add\": [{\"foot\": \"right\", \"start\": 240, \"end\": 270}]}");
    assert_int_equal(plants.count, found.count);
    assert_int_equal(plants.found_count, found.count);
    const ff_plant *moved = plant_at(&plants, FF_LEFT, 180), *added = plant_at(&plants, FF_RIGHT, 250);
    assert_true(moved && added && moved->written && added->written);
    assert_int_equal(moved->start, 150);
    assert_int_equal(moved->end, 215);
    assert_int_equal(moved->flat_start, 160);
    assert_int_equal(moved->flat_end, 200);
    assert_int_equal(added->start, 240);
    assert_true(added->flat_start >= 240 && added->flat_end <= 270); /* found inside what was written */
    FF_ASSERT_NEAR(added->ball.a, third->ball.a, 0.03);
    FF_ASSERT_NEAR(moved->confidence, 1.0, 0.0);
    for (int i = 0; i < found.count; ++i)
        assert_int_equal(plants.found[i].start, found.items[i].start);
    ff_plants_free(&plants);
    ff_plants_free(&found);
    ff_clip_free(&clip);
}

static void steps_follow_the_written_plants(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    ff_rig rig = rig_of(&clip);
    made_motion made = make_motion(&rig, clip);
    ff_plants_free(&made.plants);
    made.plants =
        find_edited(&clip, "{\"move\": [{\"foot\": \"left\", \"frame\": 180, \"flat\": [170, 190]}]}");
    ff_actions actions;
    ff_error error;
    FF_ASSERT_OK(ff_actions_cut(&standard()->cut, &rig, &made.motion, &made.plants, -1, &actions, &error),
                 error);
    bool lands = false, leaves = false;
    for (int i = 0; i < actions.count; ++i) {
        lands = lands || (actions.items[i].last_frame == 170 && actions.items[i].record.swing == FF_LEFT);
        leaves =
            leaves || (actions.items[i].first_frame == 170 && actions.items[i].record.support == FF_LEFT);
    }
    assert_true(lands && leaves);
    ff_actions_free(&actions);
    made_motion_free(&made);
}

static void a_written_list_replaces_all(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    ff_plants found;
    ff_error error;
    char *text;
    FF_ASSERT_OK(ff_plants_find(&clip, &standard()->find, &found, &error), error);
    FF_ASSERT_OK(ff_plant_edits_write(&found, &text, &error), error);
    ff_plants same = find_edited(&clip, text);
    assert_int_equal(same.count, found.count);
    for (int i = 0; i < same.count; ++i) {
        assert_int_equal(same.items[i].foot, found.items[i].foot);
        assert_int_equal(same.items[i].start, found.items[i].start);
        assert_int_equal(same.items[i].end, found.items[i].end);
        assert_int_equal(same.items[i].flat_start, found.items[i].flat_start);
        assert_int_equal(same.items[i].flat_end, found.items[i].flat_end);
        FF_ASSERT_NEAR(same.items[i].ball.a, found.items[i].ball.a, 1e-9);
        assert_true(same.items[i].written);
    }
    free(text);
    ff_plants_free(&same);
    ff_plants_free(&found);
    ff_clip_free(&clip);
}

static void a_trimmed_clip_counts_from_its_first_frame(void **state)
{
    (void)state;
    ff_plant_edits edits =
        parse("{\"plants\": [{\"foot\": \"left\", \"start\": 10, \"end\": 60, \"flat\": [20, 50]},"
              " {\"foot\": \"left\", \"start\": 70, \"end\": 200, \"flat\": [80, 190]},"
              " {\"foot\": \"right\", \"start\": 300, \"end\": 310}]}");
    ff_plant_edits_trim(&edits, 40, 100);
    assert_int_equal(edits.count, 2);
    assert_int_equal(edits.items[0].start, 0);
    assert_int_equal(edits.items[0].end, 20);
    assert_int_equal(edits.items[0].flat_start, 0);
    assert_int_equal(edits.items[0].flat_end, 10);
    assert_int_equal(edits.items[1].start, 30);
    assert_int_equal(edits.items[1].end, 99);
    ff_plant_edits_free(&edits);
}

static void what_does_not_fit_is_refused_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
        uint32_t line;
    } bad[] = {
        {"{\n \"plant\": []}", "plants", 2},
        {"{\"add\": [\n {\"foot\": \"both\", \"start\": 1, \"end\": 2}]}", "left", 2},
        {"{\"add\": [\n {\"foot\": \"left\", \"start\": 1}]}", "end", 2},
        {"{\"add\": [\n\n {\"foot\": \"left\", \"start\": 9, \"end\": 2}]}", "before start", 3},
        {"{\"add\": [{\"foot\": \"left\", \"start\": 1, \"end\": 9,\n \"flat\": [8, 3]}]}", "flat", 2},
        {"{\"move\": [\n {\"foot\": \"left\", \"start\": 9}]}", "frame", 2},
        {"{\"move\": [\n {\"foot\": \"left\", \"frame\": 9, \"begin\": 1}]}", "start", 2},
        {"{\"remove\": 3}", "list", 1},
        {"{\"plants\": [],\n \"add\": []}", "every plant", 1},
        {"{\"remove\": [{\"foot\": \"left\", \"frame\": -4}]}", "frame", 1},
        {"[]", "object", 1},
        /* Only the clip tells: */
        {"{\"remove\": [\n {\"foot\": \"left\", \"frame\": 100000}]}", "no left plant", 2},
        {"{\"add\": [\n {\"foot\": \"right\", \"start\": 5, \"end\": 99999}]}", "last frame", 2},
        {"{\"add\": [\n {\"foot\": \"right\", \"start\": 5, \"end\": 300}]}", "another", 2},
        {"{\"move\": [\n {\"foot\": \"left\", \"frame\": 180, \"flat\": [1, 5]}]}", "outside", 2},
    };
    ff_clip clip = generated_clip("walk-normal");
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        ff_plant_edits edits;
        ff_plants plants;
        ff_error error;
        memset(&error, 0, sizeof error);
        ff_status status =
            ff_plant_edits_parse(bad[i].text, strlen(bad[i].text), "x.plants.json", &edits, &error);
        if (status == FF_OK) {
            status = ff_plants_find_edited(&clip, &standard()->find, &edits, &plants, &error);
            ff_plant_edits_free(&edits);
        }
        if (status == FF_OK || !strstr(error.message, bad[i].says) || error.line != bad[i].line)
            print_error("%s\n gives line %u: %s\n", bad[i].text, error.line, error.message);
        assert_int_not_equal(status, FF_OK);
        assert_non_null(strstr(error.message, bad[i].says));
        assert_int_equal(error.line, bad[i].line);
        assert_non_null(strstr(error.file, "x.plants.json"));
    }
    ff_clip_free(&clip);
}

static void the_file_is_found_beside_the_clip(void **state)
{
    (void)state;
    char path[64];
    assert_true(ff_plant_edits_path("a.b/walk.amc", path, sizeof path));
    assert_string_equal(path, "a.b/walk.plants.json");
    assert_true(ff_plant_edits_path("a.b/walk", path, sizeof path));
    assert_string_equal(path, "a.b/walk.plants.json");
    assert_false(ff_plant_edits_path("walk.amc", path, 8));
    bool found = true;
    ff_plant_edits edits;
    ff_error error;
    FF_ASSERT_OK(ff_plant_edits_load("/nowhere/walk.amc", &edits, &found, &error), error);
    assert_false(found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_a_person_wrote_holds),
        cmocka_unit_test(steps_follow_the_written_plants),
        cmocka_unit_test(a_written_list_replaces_all),
        cmocka_unit_test(a_trimmed_clip_counts_from_its_first_frame),
        cmocka_unit_test(what_does_not_fit_is_refused_with_its_line),
        cmocka_unit_test(the_file_is_found_beside_the_clip),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
