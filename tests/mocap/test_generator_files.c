/* The clips that `footfall-pack generate` writes, read back. */
#define _POSIX_C_SOURCE 200809L
#include "mocap/catalogue.h"
#include "mocap/generator/generator.h"
#include "runtime/tool/command_line.h"
#include "tests/check.h"

#include <stdio.h>
#include <unistd.h>

static char folder[] = "/tmp/ff-generate-XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static void remove_file(const char *name, const char *ending)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s.%s", folder, name, ending);
    (void)unlink(path);
}

static int remove_folder(void **state)
{
    (void)state;
    for (int i = 0; i < ff_generator_count(); ++i) {
        const char *const endings[] = {"bvh", "amc", "asf"};
        for (int k = 0; k < 3; ++k)
            remove_file(ff_generator_describe(i).name, endings[k]);
    }
    remove_file("plants", "csv");
    remove_file("catalogue", "json");
    return rmdir(folder);
}

static int generate(const char *format, const char *clip)
{
    char *words[] = {"-o", folder, "--format", (char *)(uintptr_t)format, "--quiet", (char *)(uintptr_t)clip};
    return ff_generate_command(6, words);
}

/* World positions of the two clips by role, over all frames. */
static double largest_difference(const ff_clip *a, const ff_clip *b)
{
    double largest = 0.0;
    ff_vec3 p[FF_ROLE_COUNT * 2], q[FF_ROLE_COUNT * 2];
    assert_in_range(b->joint_count, FF_ROLE_JOINT_COUNT, FF_ROLE_COUNT * 2);
    for (int f = 0; f < a->frame_count; ++f) {
        ff_clip_pose(a, f, p, NULL);
        ff_clip_pose(b, f + b->rest_frames, q, NULL);
        for (int role = 0; role < FF_ROLE_COUNT; ++role) {
            int i = ff_clip_find(a, (ff_role)role), k = ff_clip_find(b, (ff_role)role);
            assert_true(i >= 0 && k >= 0);
            largest = ff_max(largest, ff_length3(ff_sub3(p[i], q[k])));
        }
    }
    return largest;
}

static void check_written(const char *ending, const char *name)
{
    char path[256];
    ff_clip read;
    ff_generated made;
    ff_error error;
    ff_load_options options = ff_load_options_default();
    snprintf(path, sizeof path, "%s/%s.%s", folder, name, ending);
    FF_ASSERT_OK(ff_clip_load(path, &options, &read, &error), error);
    FF_ASSERT_OK(ff_generator_make(ff_generator_find(name), NULL, &made, &error), error);
    assert_int_equal(read.frame_count - read.rest_frames, made.clip.frame_count);
    FF_ASSERT_BELOW(largest_difference(&made.clip, &read), 1e-4);
    ff_clip_free(&read);
    ff_generated_free(&made);
}

static void written_clips_are_read_back_as_they_were(void **state)
{
    (void)state;
    const char *const names[] = {"walk-normal", "turn-left-90", "jump"};
    for (int i = 0; i < 3; ++i) {
        assert_int_equal(generate("both", names[i]), FF_EXIT_OK);
        check_written("bvh", names[i]);
        check_written("amc", names[i]);
    }
}

static void the_catalogue_lists_them_and_the_truth_has_every_plant(void **state)
{
    (void)state;
    char path[256], line[512];
    ff_error error;
    ff_catalogue catalogue;
    ff_generated made;
    assert_int_equal(generate("bvh", "curve-left"), FF_EXIT_OK);
    snprintf(path, sizeof path, "%s/catalogue.json", folder);
    const char *inputs[] = {path};
    FF_ASSERT_OK(ff_catalogue_read(inputs, 1, &catalogue, &error), error);
    assert_int_equal(catalogue.count, 1);
    assert_string_equal(catalogue.entries[0].mode, "walk");
    assert_string_equal(catalogue.entries[0].tags, "walk curve left");
    ff_catalogue_free(&catalogue);

    FF_ASSERT_OK(ff_generator_make(ff_generator_find("curve-left"), NULL, &made, &error), error);
    snprintf(path, sizeof path, "%s/plants.csv", folder);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    int rows = 0;
    while (fgets(line, sizeof line, file))
        ++rows;
    assert_int_equal(fclose(file), 0);
    assert_int_equal(rows, made.plant_count + 1);
    ff_generated_free(&made);
}

static void wrong_words_are_usage_errors(void **state)
{
    (void)state;
    char *none[] = {NULL}, *no_clip[] = {"-o", folder, "wlak"},
         *no_format[] = {"-o", folder, "--format", "fbx"};
    char *no_person[] = {"-o", folder, "--person", "99"};
    assert_int_equal(ff_generate_command(0, none), FF_EXIT_USAGE);
    assert_int_equal(ff_generate_command(3, no_clip), FF_EXIT_USAGE);
    assert_int_equal(ff_generate_command(4, no_format), FF_EXIT_USAGE);
    assert_int_equal(ff_generate_command(4, no_person), FF_EXIT_USAGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(written_clips_are_read_back_as_they_were),
        cmocka_unit_test(the_catalogue_lists_them_and_the_truth_has_every_plant),
        cmocka_unit_test(wrong_words_are_usage_errors),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
