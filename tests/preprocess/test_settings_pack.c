/* Every setting of what is made from all clips together changes the result; see test_settings_matter.c. */
#define _GNU_SOURCE
#include "tests/preprocess/build_folder.h"
#include "tests/preprocess/cycles_make.h"
#include "tests/preprocess/setting_rows.h"

#include "preprocess/actions/derive_motion.h"
#include "preprocess/actions/steps.h"
#include "preprocess/actions/successors.h"
#include "preprocess/examples/correspond_set.h"
#include "preprocess/examples/cycles.h"
#include "preprocess/examples/examples.h"
#include "preprocess/skin/mesh.h"

static const char *const names[] = {"walk-slow", "walk-normal", "walk-brisk", "curve-left", "jog", "run"};
enum { CLIPS = sizeof names / sizeof names[0] };

static ff_rig rig;
static made_motion made[CLIPS];

static int make_motions(void **state)
{
    (void)state;
    for (int i = 0; i < CLIPS; ++i) {
        ff_clip clip = generated_clip(names[i]);
        if (i == 0) rig = rig_of(&clip);
        made[i] = make_motion(&rig, clip);
    }
    return 0;
}

static int free_motions(void **state)
{
    (void)state;
    for (int i = 0; i < CLIPS; ++i)
        made_motion_free(&made[i]);
    return 0;
}

static ff_example_set choose(const ff_example_settings *settings)
{
    ff_cycles cycles[CLIPS];
    const int subject[CLIPS] = {0};
    for (int i = 0; i < CLIPS; ++i) {
        cycles[i] = cut_cycles(&rig, &made[i]);
        for (int k = 0; k < cycles[i].count; ++k)
            cycles[i].items[k].clip = i;
    }
    ff_example_set set;
    FF_ASSERT_OK(ff_examples_select(settings, &rig, cycles, subject, CLIPS, &set, &error), error);
    for (int i = 0; i < CLIPS; ++i)
        ff_cycles_free(&cycles[i]);
    return set;
}

static uint64_t chosen(const ff_settings *settings)
{
    ff_example_set set = choose(&settings->cut.examples);
    uint64_t hash = 0;
    for (int i = 0; i < set.count; ++i)
        hash = mix(&set.items[i].record, sizeof set.items[i].record, hash);
    ff_example_set_free(&set);
    return hash;
}

static void how_far_apart_examples_are_matters(void **state)
{
    (void)state;
    uint64_t usual = chosen(standard());
    for (int i = 0; i < ff_setting_count; ++i)
        if (strstr(ff_setting_table[i].key, "_spacing"))
            assert_true(row_matters(&ff_setting_table[i], chosen, usual));
}

/* Of a few examples: two straight walks, a curve, standing. */
static uint64_t corresponding(const ff_settings *settings)
{
    static ff_example_set all; /* chosen once */
    static ff_example none[8];
    if (!all.items) all = choose(&standard()->cut.examples);
    ff_example few[4];
    int count = 0, straight = 0, turning = 0;
    for (int i = 0; i < all.count; ++i) {
        const ff_pack_example *r = &all.items[i].record;
        bool turns = r->turn_rate != 0.0f;
        if (r->gait != FF_GAIT_WALK || (r->flags & (FF_EXAMPLE_DERIVED | FF_EXAMPLE_IDLE))) continue;
        if (turns ? turning++ < 1 : straight++ < 3) few[count++] = all.items[i];
    }
    assert_int_equal(count, 4);
    ff_example_set set = {.items = few, .count = count};
    ff_correspondences found;
    ff_tasks *tasks;
    FF_ASSERT_OK(ff_tasks_create(1, &tasks, &error), error);
    FF_ASSERT_OK(ff_correspond_set(&settings->correspondences, &rig, &set, none, tasks, &found, &error),
                 error);
    uint64_t hash = 0;
    for (int i = 0; i < found.count; ++i)
        hash = mix(found.items[i].pairs.pair,
                   (size_t)found.items[i].pairs.count * sizeof *found.items[i].pairs.pair, hash);
    ff_correspondences_free(&found);
    ff_tasks_destroy(tasks);
    return hash;
}

static void settings_of_correspondences_matter(void **state)
{
    (void)state;
    static const char *const sections[] = {"correspondences", NULL};
    assert_rows_matter(sections, corresponding);
}

/* Of the actions of all clips; half of them, or the limit of large sets is never the one of small ones. */
static uint64_t following(const ff_settings *settings)
{
    uint64_t hash = 0;
    for (int part = 0; part < 2; ++part) {
        ff_pack_content content = {0};
        for (int i = part ? 0 : 1; i < CLIPS; i += part ? 1 : 4) {
            ff_actions actions;
            FF_ASSERT_OK(ff_actions_cut(&standard()->cut, &rig, &made[i].motion, &made[i].plants, -1,
                                        &actions, &error),
                         error);
            for (int copies = 0; copies < (part ? 2 : 1); ++copies)
                for (int k = 0; k < actions.count; ++k) {
                    ff_pack_action *a = ff_array_grow(&content.actions, 1, sizeof *a);
                    ff_action_joins *j = ff_array_grow(&content.joins, 1, sizeof *j);
                    assert_true(a && j);
                    *a = actions.items[k].record;
                    *j = (ff_action_joins){actions.items[k].start, actions.items[k].end};
                }
            ff_actions_free(&actions);
        }
        ff_tasks *tasks;
        FF_ASSERT_OK(ff_tasks_create(1, &tasks, &error), error);
        FF_ASSERT_OK(ff_pack_add_successors(&content, &settings->successors, tasks, &error), error);
        hash = mix(content.successors.data, content.successors.count * sizeof(ff_pack_successor), hash);
        ff_tasks_destroy(tasks);
        ff_pack_content_free(&content);
    }
    return hash;
}

static void settings_of_successors_matter(void **state)
{
    (void)state;
    static const char *const sections[] = {"successors", NULL};
    assert_rows_matter(sections, following);
}

/* A bumpy sheet of 1,152 triangles. */
static ff_mesh make_sheet(void)
{
    enum { SIDE = 24 };
    ff_mesh sheet = {calloc((SIDE + 1) * (SIDE + 1), sizeof *sheet.vertices), 0,
                     calloc(2 * SIDE * SIDE, sizeof *sheet.triangles), 0};
    assert_true(sheet.vertices && sheet.triangles);
    for (int i = 0; i <= SIDE; ++i)
        for (int k = 0; k <= SIDE; ++k)
            sheet.vertices[sheet.vertex_count++] =
                (ff_skin_vertex){.at = ff_v3(0.1 * i, 0.3 * sin(0.9 * i) * cos(0.7 * k), 0.1 * k),
                                 .joint = {3},
                                 .weight = {1.0}};
    for (uint32_t i = 0; i < SIDE; ++i)
        for (uint32_t k = 0; k < SIDE; ++k) {
            uint32_t a = i * (SIDE + 1) + k, c = a + SIDE + 1;
            const uint32_t corners[2][3] = {{a, a + 1, c}, {a + 1, c + 1, c}};
            memcpy(sheet.triangles + sheet.triangle_count, corners, sizeof corners);
            sheet.triangle_count += 2;
        }
    return sheet;
}

static uint64_t levelled(const ff_settings *settings)
{
    ff_mesh sheet = make_sheet(), levels[FF_MESH_LEVELS];
    ff_mesh_faults faults = {0};
    FF_ASSERT_OK(ff_mesh_levels(&settings->skin, &sheet, levels, &faults, &error), error);
    uint64_t hash = 0;
    for (int i = 0; i < FF_MESH_LEVELS; ++i) {
        hash = mix(levels[i].vertices, (size_t)levels[i].vertex_count * sizeof *levels[i].vertices, hash);
        ff_mesh_free(&levels[i]);
    }
    ff_mesh_free(&sheet);
    return hash;
}

static void settings_of_the_skin_matter(void **state)
{
    (void)state;
    static const char *const sections[] = {"skin", NULL};
    assert_rows_matter(sections, levelled);
}

/* ----------------------------------------------------------------------------------------------------- whole packs */

static char folder[32];

static int make_clips(void **state)
{
    (void)state;
    make_folder(folder);
    static const char *const walks[] = {"walk-slow", "walk-brisk"};
    const ff_generator_options options = {.seed = 2, .skate_cm = 1.0};
    for (int i = 0; i < 2; ++i) {
        ff_generated walk;
        char path[64];
        snprintf(path, sizeof path, "%s/%s.bvh", folder, walks[i]);
        FF_ASSERT_OK(ff_generator_make(ff_generator_find(walks[i]), &options, &walk, &error), error);
        FF_ASSERT_OK(ff_clip_keep(&walk.clip, 0, 480, &error), error);
        FF_ASSERT_OK(ff_bvh_write(path, &walk.clip, &error), error);
        ff_generated_free(&walk);
    }
    return 0;
}

static int remove_clips(void **state)
{
    (void)state;
    remove_folder(folder);
    return 0;
}

/* All of a pack but what it says of its settings. */
static uint64_t built(const ff_settings *settings)
{
    const char *inputs[] = {folder};
    ff_catalogue catalogue = catalogue_of(inputs, 1);
    ff_build_settings how = ff_build_settings_default();
    how.pack = *settings;
    how.pack.correspondences.window = 0.005; /* not looked at here: hardly any, to save time */
    image out = build_with(&catalogue, how);
    const ff_pack *p = out.pack;
    uint64_t hash = mix(p->actions, p->action_count * sizeof *p->actions, 0);
    hash = mix(p->streams, p->stream_count * sizeof *p->streams, hash);
    hash = mix(p->tracks, (size_t)p->track_count * sizeof *p->tracks, hash);
    image_free(&out);
    ff_catalogue_free(&catalogue);
    return hash;
}

static void settings_of_poses_and_derived_actions_matter(void **state)
{
    (void)state;
    static const char *const sections[] = {"motion", "poses", "actions", NULL};
    assert_rows_matter(sections, built);
}

int main(void)
{
    const struct CMUnitTest of_motions[] = {
        cmocka_unit_test(how_far_apart_examples_are_matters),
        cmocka_unit_test(settings_of_correspondences_matter),
        cmocka_unit_test(settings_of_successors_matter),
        cmocka_unit_test(settings_of_the_skin_matter),
    };
    const struct CMUnitTest of_packs[] = {
        cmocka_unit_test(settings_of_poses_and_derived_actions_matter),
    };
    int failed = cmocka_run_group_tests(of_motions, make_motions, free_motions);
    return failed + cmocka_run_group_tests(of_packs, make_clips, remove_clips);
}
