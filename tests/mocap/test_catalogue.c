/* Catalogues, folders and lists of clips; what is wrong in a catalogue is told with its line. */
#define _GNU_SOURCE
#include "mocap/catalogue.h"
#include "tests/check.h"

#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/footfall-catalogue-XXXXXX";

static const char *const files[] = {"a_01.amc",      "a_01.bvh",        "a_02.BVH", "sub/b.bvh",
                                    "sub/notes.txt", "sub/.hidden.bvh", "a.asf"};
enum { FILE_COUNT = sizeof files / sizeof files[0] };

static char *in_folder(const char *name, char path[256])
{
    snprintf(path, 256, "%s/%s", folder, name);
    return path;
}

static void write_file(const char *name, const char *text)
{
    char path[256];
    FILE *file = fopen(in_folder(name, path), "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static int make_folder(void **state)
{
    (void)state;
    char path[256];
    if (!mkdtemp(folder) || mkdir(in_folder("sub", path), 0700) != 0) return 1;
    for (int i = 0; i < FILE_COUNT; ++i)
        write_file(files[i], "");
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    char path[256];
    for (int i = 0; i < FILE_COUNT; ++i)
        unlink(in_folder(files[i], path));
    unlink(in_folder("c.json", path));
    rmdir(in_folder("sub", path));
    return rmdir(folder);
}

static const char *end_of(const ff_catalogue_entry *entry)
{
    return entry->path + strlen(folder) + 1;
}

static void a_folder_gives_every_clip_below_it_once_and_sorted(void **state)
{
    (void)state;
    char bvh[256];
    const char *inputs[] = {folder, in_folder("a_02.BVH", bvh), folder};
    ff_catalogue catalogue;
    ff_error error;
    FF_ASSERT_OK(ff_catalogue_read(inputs, 3, &catalogue, &error), error);
    assert_int_equal(catalogue.count, 3);
    assert_string_equal(end_of(&catalogue.entries[0]), "a_01.amc"); /* and not its BVH */
    assert_string_equal(end_of(&catalogue.entries[1]), "a_02.BVH");
    assert_string_equal(end_of(&catalogue.entries[2]), "sub/b.bvh");
    assert_true(catalogue.entries[0].mirror);
    assert_int_equal(catalogue.entries[0].trim_last, -1);
    assert_int_equal(catalogue.entries[0].options.up, 'y');
    assert_string_equal(catalogue.entries[0].tags, "");
    ff_catalogue_free(&catalogue);
}

static void a_catalogue_gives_its_clips_with_everything_it_says_of_them(void **state)
{
    (void)state;
    char path[256];
    write_file(
        "c.json",
        "{ \"note\": \"n\", \"unit\": \"cm\", \"fps\": 60, \"licence\": \"L\", \"tags\": [\"walk\"], "
        "\"clips\": [\n"
        "  { \"file\": \"sub/b.bvh\", \"trim\": [10, 90], \"mirror\": false, \"unit\": 0.5, \"up\": \"z\",\n"
        "    \"mode\": \"turn\", \"tags\": [\"left\", \"slow\"], \"roles\": { \"Bone\": \"left knee\", "
        "\"x\": \"none\" } },\n"
        "  { \"file\": \"sub/b.bvh\", \"trim\": [100, -1], \"citation\": \"C\", \"strict\": true },\n"
        "  { \"file\": \"a_01.amc\", \"skeleton\": \"a.asf\" },\n"
        "  { \"file\": \"not-there.bvh\", \"use\": false, \"note\": \"bad data\" } ] }\n");
    const char *inputs[] = {in_folder("c.json", path)};
    ff_catalogue catalogue;
    ff_error error;
    FF_ASSERT_OK(ff_catalogue_read(inputs, 1, &catalogue, &error), error);
    assert_int_equal(catalogue.count, 3);
    const ff_catalogue_entry *amc = &catalogue.entries[0], *first = amc + 1, *second = amc + 2;
    assert_string_equal(end_of(amc), "a_01.amc");
    assert_string_equal(amc->options.skeleton + strlen(folder) + 1, "a.asf");
    FF_ASSERT_NEAR(amc->options.unit_m, 0.01, 0.0);
    FF_ASSERT_NEAR(amc->options.fps, 60.0, 0.0);
    assert_string_equal(amc->tags, "walk");
    assert_string_equal(first->tags, "left slow");
    assert_string_equal(first->mode, "turn");
    assert_int_equal(first->trim_first, 10);
    assert_int_equal(first->trim_last, 90);
    assert_false(first->mirror);
    assert_int_equal(first->options.up, 'z');
    FF_ASSERT_NEAR(first->options.unit_m, 0.5, 0.0);
    assert_int_equal(first->options.override_count, 2);
    assert_string_equal(first->options.overrides[0].joint, "Bone");
    assert_int_equal(first->options.overrides[0].role, FF_ROLE_KNEE_L);
    assert_int_equal(first->options.overrides[1].role, FF_ROLE_NONE);
    assert_int_equal(second->trim_first, 100);
    assert_string_equal(second->licence, "L");
    assert_string_equal(second->citation, "C");
    assert_true(second->options.strict);
    ff_catalogue_free(&catalogue);
}

static void a_catalogues_files_are_where_the_caller_says(void **state)
{
    (void)state;
    char input[600], path[256];
    write_file("sub/notes.txt", "");
    write_file("c.json", "{ \"folder\": \"nowhere\", \"clips\": [ { \"file\": \"b.bvh\" } ] }");
    snprintf(input, sizeof input, "%s:%s/sub", in_folder("c.json", path), folder);
    const char *placed = input, *bare = path;
    ff_catalogue catalogue;
    ff_error error;
    FF_ASSERT_OK(ff_catalogue_read(&placed, 1, &catalogue, &error), error);
    assert_string_equal(end_of(&catalogue.entries[0]), "sub/b.bvh");
    ff_catalogue_free(&catalogue);
    assert_int_equal(ff_catalogue_read(&bare, 1, &catalogue, &error), FF_ERR_PARSE);
    assert_non_null(strstr(error.message, "nowhere/b.bvh"));
}

static void wrong_catalogues_are_refused_with_their_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        uint32_t line;
        const char *message;
    } bad[] = {
        {"{ \"clips\": [\n { \"file\": \"b.bvh\",\n \"colour\": 1 } ] }", 3, "colour"},
        {"{ \"clips\": [],\n \"files\": 1 }", 2, "files"},
        {"{\n \"clips\": 7 }", 2, "list of clips"},
        {"{\n }", 1, "list of clips"},
        {"{ \"clips\": [\n 3 ] }", 2, "objects"},
        {"{ \"clips\": [\n {\n} ] }", 2, "no \"file\""},
        {"{ \"clips\": [\n {\n\"file\": \"b.fbx\" } ] }", 3, "no clip (.amc"},
        {"{ \"clips\": [\n {\n\"file\": \"none.bvh\" } ] }", 3, "none.bvh"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\",\n \"unit\": \"feet\" } ] }", 2, "unit"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\",\n \"unit\": -1 } ] }", 2, "unit"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\",\n \"up\": \"x\" } ] }", 2, "up"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\",\n \"fps\": 0 } ] }", 2, "fps"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\",\n \"mode\": \"fly\" } ] }", 2, "fly"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\",\n \"tags\": \"walk\" } ] }", 2, "tags"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\",\n \"tags\": [\"two words\"] } ] }", 2, "tags"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\",\n \"trim\": [5] } ] }", 2, "trim"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\",\n \"trim\": [5, 4] } ] }", 2, "trim"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\",\n \"trim\": [-1, 4] } ] }", 2, "trim"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\",\n \"mirror\": 1 } ] }", 2, "mirror"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\", \"roles\": {\n \"x\": \"tail\" } } ] }", 2, "not a role"},
        {"{ \"clips\": [ { \"file\": \"a_02.BVH\",\n \"roles\": [] } ] }", 2, "roles"},
        {"{ \"clips\": [ {\n", 0, "JSON"},
    };
    char path[256];
    const char *input = in_folder("c.json", path);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        ff_catalogue catalogue;
        ff_error error;
        write_file("c.json", bad[i].text);
        ff_status status = ff_catalogue_read(&input, 1, &catalogue, &error);
        bool right =
            status != FF_OK && strcmp(error.file, path) == 0 && strstr(error.message, bad[i].message);
        if (!right || (bad[i].line > 0 && error.line != bad[i].line)) {
            print_error("case %zu: %s:%u: %s\n", i, error.file, error.line, error.message);
            fail();
        }
    }
}

static void inputs_that_are_nothing_of_the_kind_are_refused(void **state)
{
    (void)state;
    char sub[256], text[256];
    const char *const inputs[] = {in_folder("sub/notes.txt", text), in_folder("none", sub)};
    ff_catalogue catalogue;
    ff_error error;
    assert_int_equal(ff_catalogue_read(inputs, 1, &catalogue, &error), FF_ERR_ARGUMENT);
    assert_int_equal(ff_catalogue_read(inputs + 1, 1, &catalogue, &error), FF_ERR_ARGUMENT);
    assert_string_equal(error.file, sub);
    assert_int_equal(ff_catalogue_read(inputs, 0, &catalogue, &error), FF_ERR_NO_DATA);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_folder_gives_every_clip_below_it_once_and_sorted),
        cmocka_unit_test(a_catalogue_gives_its_clips_with_everything_it_says_of_them),
        cmocka_unit_test(a_catalogues_files_are_where_the_caller_says),
        cmocka_unit_test(wrong_catalogues_are_refused_with_their_line),
        cmocka_unit_test(inputs_that_are_nothing_of_the_kind_are_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
