/* JSON that people write: every complaint names the file and the right line and column. */
#include "tests/check.h"

#include "runtime/tool/json.h"

#include <stdio.h>
#include <unistd.h>

static void parse(const char *text, ff_json *json)
{
    ff_error error;
    FF_ASSERT_OK(ff_json_parse(text, strlen(text), "scene.json", json, &error), error);
}

static void assert_error(const ff_error *error, const char *want)
{
    char text[1024];
    assert_string_equal(ff_error_text(error, text, sizeof text), want);
}

static void members_are_read_and_absent_ones_keep_their_default(void **state)
{
    (void)state;
    ff_json json;
    ff_error error;
    parse("\xef\xbb\xbf{\"speed\": 2, \"count\": 7, \"name\": \"circle\", \"loop\": true}", &json);
    double speed = 0.0, other = 5.5;
    int64_t count = 0;
    const char *name = NULL;
    bool loop = false;
    FF_ASSERT_OK(ff_json_number(&json, json.root, "speed", 0.0, 3.0, &speed, &error), error);
    FF_ASSERT_OK(ff_json_number(&json, json.root, "other", 0.0, 3.0, &other, &error), error);
    FF_ASSERT_OK(ff_json_integer(&json, json.root, "count", 0, 10, &count, &error), error);
    FF_ASSERT_OK(ff_json_string(&json, json.root, "name", &name, &error), error);
    FF_ASSERT_OK(ff_json_bool(&json, json.root, "loop", &loop, &error), error);
    FF_ASSERT_NEAR(speed, 2.0, 0.0);
    FF_ASSERT_NEAR(other, 5.5, 0.0);
    assert_int_equal(count, 7);
    assert_string_equal(name, "circle");
    assert_true(loop);
    ff_json_free(&json);
}

static void files_that_are_not_json_are_refused_with_their_place(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        uint32_t line;
        const char *says;
    } bad[] = {
        {"", 1, "not valid JSON"},
        {"{\n \"a\": 1,\n}", 3, "not valid JSON"},
        {"{\"a\": 1, \"a\": 2}", 1, "duplicate"},
        {"{\"a\": nan}", 1, "not valid JSON"},
        {"{\"a\": 1e999}", 1, "not valid JSON"},
        {"{\"a\": \"\\u0000\"}", 1, "not valid JSON"},
        {"{} {}", 1, "not valid JSON"},
        {"{\"a\": \"\xff\"}", 1, "not valid JSON"},
        {"[1, 2]", 1, "expected an object"},
        {"3", 1, "not valid JSON"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        ff_json json;
        ff_error error;
        assert_int_equal(ff_json_parse(bad[i].text, strlen(bad[i].text), "x.json", &json, &error),
                         FF_ERR_PARSE);
        assert_string_equal(error.file, "x.json");
        assert_int_equal(error.line, bad[i].line);
        assert_non_null(strstr(error.message, bad[i].says));
        assert_null(json.root);
        assert_null(json.text);
    }
}

static void a_zero_byte_is_refused_with_its_place(void **state)
{
    (void)state;
    static const char text[] = "{\n \"a\": [1.0\0], \"b\": 2}";
    ff_json json;
    ff_error error;
    assert_int_equal(ff_json_parse(text, sizeof text - 1, "x.json", &json, &error), FF_ERR_PARSE);
    assert_int_equal(error.line, 2);
    assert_int_equal(error.column, 11);
    assert_non_null(strstr(error.message, "zero byte"));
    assert_null(json.text);
}

static void a_wrong_value_is_named_at_its_own_line_and_column(void **state)
{
    (void)state;
    /* Brackets, commas and escaped quotes inside strings, nested and empty containers lie on the way. */
    static const char text[] = "{\n"
                               "  \"odd \\\" ] } , :\": [{}, [], \"}\\\\\", [1, [2]]],\n"
                               "  \"na\xc3\xafve\": true, \"walls\": [\n"
                               "    {\"p\": [0, 0], \"kind\": \"brick\"},\n"
                               "    {\"p\": [0, \"one\"], \"kind\": 4, \"open\": true, \"speed\": -1.5e0}\n"
                               "  ]\n"
                               "}\n";
    ff_json json;
    ff_error error;
    parse(text, &json);
    json_t *wall = json_array_get(json_object_get(json.root, "walls"), 1);
    const char *kind;
    double speed, open;
    int64_t p;
    bool flag;
    ff_json_fail(&json, json_array_get(json_object_get(wall, "p"), 1), &error, "expected %d numbers", 2);
    assert_error(&error, "scene.json:5:15: expected 2 numbers");
    ff_json_fail(&json, wall, &error, "a wall");
    assert_error(&error, "scene.json:5:5: a wall");
    ff_json_fail(&json, json.root, &error, "all");
    assert_error(&error, "scene.json:1:1: all");
    ff_json_fail_key(&json, wall, "kind", &error, "this key");
    assert_error(&error, "scene.json:5:23: this key");
    ff_json_fail_key(&json, json.root, "walls", &error, "columns count characters");
    assert_error(&error, "scene.json:3:18: columns count characters");
    assert_int_equal(ff_json_string(&json, wall, "kind", &kind, &error), FF_ERR_PARSE);
    assert_error(&error, "scene.json:5:31: \"kind\" is a whole number; expected a string");
    assert_int_equal(ff_json_number(&json, wall, "open", 0.0, 1.0, &open, &error), FF_ERR_PARSE);
    assert_error(&error, "scene.json:5:42: \"open\" is true or false; expected a number");
    assert_int_equal(ff_json_number(&json, wall, "speed", 0.0, 3.0, &speed, &error), FF_ERR_PARSE);
    assert_error(&error, "scene.json:5:57: \"speed\" is -1.5; expected 0 to 3");
    assert_int_equal(ff_json_integer(&json, wall, "p", 0, 1, &p, &error), FF_ERR_PARSE);
    assert_error(&error, "scene.json:5:11: \"p\" is an array; expected a whole number");
    assert_int_equal(ff_json_bool(&json, wall, "kind", &flag, &error), FF_ERR_PARSE);
    assert_error(&error, "scene.json:5:31: \"kind\" is a whole number; expected true or false");
    ff_json_free(&json);
}

static void an_unknown_key_is_refused_and_the_nearest_known_one_named(void **state)
{
    (void)state;
    static const char *const known[] = {"agents", "seconds", "walls", NULL};
    ff_json json;
    ff_error error;
    parse("{\"agents\": 3,\n \"secnds\": 4}", &json);
    assert_int_equal(ff_json_only_keys(&json, json.root, known, &error), FF_ERR_PARSE);
    assert_error(&error, "scene.json:2:2: unknown key 'secnds'; did you mean 'seconds'?");
    ff_json_free(&json);
    parse("{\"colour\": 3}", &json);
    assert_int_equal(ff_json_only_keys(&json, json.root, known, &error), FF_ERR_PARSE);
    assert_error(&error, "scene.json:1:2: unknown key 'colour'; known keys: agents, seconds, walls");
    ff_json_free(&json);
}

/* A list of keys that is too long for a message ends with dots, not within a key. */
static void a_long_list_of_keys_ends_with_dots(void **state)
{
    (void)state;
    static const char *const many[] = {"one_of_the_keys_that_are_long",   "two_of_the_keys_that_are_long",
                                       "three_of_the_keys_that_are_long", "four_of_the_keys_that_are_long",
                                       "five_of_the_keys_that_are_long",  "six_of_the_keys_that_are_long",
                                       "seven_of_the_keys_that_are_long", "eight_of_the_keys_that_are_long",
                                       "nine_of_the_keys_that_are_long",  NULL};
    ff_json json;
    ff_error error;
    parse("{\"colour\": 3}", &json);
    assert_int_equal(ff_json_only_keys(&json, json.root, many, &error), FF_ERR_PARSE);
    const char *end = strrchr(error.message, ',');
    assert_non_null(end);
    assert_string_equal(end, ", ...");
    assert_null(strstr(error.message, "nine"));
    assert_non_null(strstr(error.message, "six_of_the_keys_that_are_long, "));
    ff_json_free(&json);
}

static void a_file_that_is_missing_or_a_folder_is_named(void **state)
{
    (void)state;
    ff_json json;
    ff_error error;
    assert_int_equal(ff_json_load("/nonexistent/scene.json", &json, &error), FF_ERR_IO);
    assert_string_equal(error.file, "/nonexistent/scene.json");
    assert_int_equal(ff_json_load("/", &json, &error), FF_ERR_IO);
    assert_null(json.root);
    ff_json_free(&json);
}

static void deep_nesting_is_refused_or_read_but_never_overflows_the_stack(void **state)
{
    (void)state;
    enum { DEPTH = 100000 };
    char *text = malloc(DEPTH + 8);
    assert_non_null(text);
    memcpy(text, "{\"a\":", 5);
    memset(text + 5, '[', DEPTH);
    ff_json json;
    ff_error error;
    assert_int_equal(ff_json_parse(text, DEPTH + 5, "deep.json", &json, &error), FF_ERR_PARSE);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(members_are_read_and_absent_ones_keep_their_default),
        cmocka_unit_test(files_that_are_not_json_are_refused_with_their_place),
        cmocka_unit_test(a_zero_byte_is_refused_with_its_place),
        cmocka_unit_test(a_wrong_value_is_named_at_its_own_line_and_column),
        cmocka_unit_test(an_unknown_key_is_refused_and_the_nearest_known_one_named),
        cmocka_unit_test(a_long_list_of_keys_ends_with_dots),
        cmocka_unit_test(a_file_that_is_missing_or_a_folder_is_named),
        cmocka_unit_test(deep_nesting_is_refused_or_read_but_never_overflows_the_stack),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
