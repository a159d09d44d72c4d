/* The configuration: every setting is described, its default is in its range, and what is wrong is refused with its
 * place. That the printed reference says the same is tested end to end. */
#include "preprocess/build/settings.h"

#include "tests/check.h"

#include <stdio.h>

static ff_status parse(const char *text, ff_settings *out, ff_error *error)
{
    return ff_settings_parse(text, strlen(text), "my.json", out, error);
}

static bool equal(const ff_settings *a, const ff_settings *b)
{
    return ff_settings_hash(a, FF_STAGE_PACK, 1) == ff_settings_hash(b, FF_STAGE_PACK, 1);
}

static void every_setting_is_described_and_its_default_is_in_range(void **state)
{
    (void)state;
    ff_settings settings = ff_settings_default();
    for (int i = 0; i < ff_setting_count; ++i) {
        const ff_setting *s = &ff_setting_table[i];
        assert_true(strlen(s->what) > 10);
        assert_true(s->low < s->high);
        assert_true(s->standard >= s->low && s->standard <= s->high);
        FF_ASSERT_NEAR(ff_setting_value(&settings, s), s->standard, 0.0);
        if (s->kind == FF_SETTING_SWITCH) assert_true(s->low == 0.0 && s->high == 1.0);
        if (s->kind == FF_SETTING_NUMBER) assert_true(s->unit[0] != '\0');
        for (int k = 0; k < i; ++k) {
            const ff_setting *t = &ff_setting_table[k];
            assert_true(s->place != t->place);
            bool same_section = strcmp(s->section, t->section) == 0;
            assert_false(same_section && strcmp(s->key, t->key) == 0);
            /* settings of one section stand together */
            if (same_section) assert_string_equal(s->section, s[-1].section);
        }
    }
}

/* Every byte of the struct belongs to a setting of the table: none can be added without a line. */
static void no_setting_is_missing_from_the_table(void **state)
{
    (void)state;
    static const size_t size[] = {[FF_SETTING_NUMBER] = sizeof(double),
                                  [FF_SETTING_WHOLE] = sizeof(int64_t),
                                  [FF_SETTING_SWITCH] = sizeof(bool),
                                  [FF_SETTING_FILE] = FF_SETTING_PATH};
    size_t described = 0;
    for (int i = 0; i < ff_setting_count; ++i)
        described += size[ff_setting_table[i].kind];
    assert_true(sizeof(ff_settings) - described < sizeof(double) * 8); /* padding after switches */
    if (described % sizeof(double) == 0) assert_int_equal(described, sizeof(ff_settings));
}

static void a_setting_can_be_set_to_both_ends_of_its_range_and_no_further(void **state)
{
    (void)state;
    for (int i = 0; i < ff_setting_count; ++i) {
        const ff_setting *s = &ff_setting_table[i];
        if (s->kind == FF_SETTING_SWITCH || s->kind == FF_SETTING_FILE) continue;
        const char *format =
            s->kind == FF_SETTING_WHOLE ? "{\"%s\": {\"%s\": %.0f}}" : "{\"%s\": {\"%s\": %.17g}}";
        const double inside[] = {s->low, s->high}, outside[] = {s->low - 1.0, s->high + 1.0};
        for (int end = 0; end < 2; ++end) {
            char text[200];
            ff_settings settings;
            ff_error error;
            snprintf(text, sizeof text, format, s->section, s->key, inside[end]);
            FF_ASSERT_OK(parse(text, &settings, &error), error);
            FF_ASSERT_NEAR(ff_setting_value(&settings, s), inside[end], 0.0);
            snprintf(text, sizeof text, format, s->section, s->key, outside[end]);
            assert_int_equal(parse(text, &settings, &error), FF_ERR_PARSE);
            assert_non_null(strstr(error.message, s->key));
            assert_int_equal(error.line, 1);
        }
    }
}

static void what_is_absent_keeps_its_default_and_comments_are_allowed_anywhere(void **state)
{
    (void)state;
    ff_settings settings, standard = ff_settings_default();
    ff_error error;
    FF_ASSERT_OK(parse("{}", &settings, &error), error);
    assert_true(equal(&settings, &standard));
    FF_ASSERT_OK(
        parse("{\"//\": \"mine\", \"poses\": {\"// rate\": \"slow\", \"rate\": 30}}", &settings, &error),
        error);
    FF_ASSERT_NEAR(settings.poses.rate, 30.0, 0.0);
}

static void files_are_named_relative_to_the_configuration(void **state)
{
    (void)state;
    static const struct {
        const char *name, *file, *path;
    } cases[] = {{"a/my.json", "body.bvh", "a/body.bvh"},
                 {"my.json", "b/body.bvh", "b/body.bvh"},
                 {"a/my.json", "/c/body.bvh", "/c/body.bvh"},
                 {"a/my.json", "", ""}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[100];
        ff_settings settings;
        ff_error error;
        snprintf(text, sizeof text, "{\"rig\": {\"skeleton\": \"%s\"}}", cases[i].file);
        FF_ASSERT_OK(ff_settings_parse(text, strlen(text), cases[i].name, &settings, &error), error);
        assert_string_equal(settings.rig.skeleton, cases[i].path);
    }
    char name[FF_SETTING_PATH + 1], text[FF_SETTING_PATH + 100];
    ff_settings settings;
    ff_error error;
    memset(name, 'x', FF_SETTING_PATH);
    name[FF_SETTING_PATH] = '\0';
    snprintf(text, sizeof text, "{\"rig\": {\"skeleton\": \"%s\"}}", name);
    assert_int_equal(parse(text, &settings, &error), FF_ERR_PARSE);
    assert_non_null(strstr(error.message, "more than"));
    assert_int_equal(error.column, 22);
}

static void what_is_wrong_is_refused_at_its_place_and_changes_nothing(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
        uint32_t line, column;
    } cases[] = {
        {"{\n \"pose\": {}\n}", "did you mean 'poses'?", 2, 2},
        {"{\"poses\": {\n  \"rat\": 30}}", "did you mean 'rate'?", 2, 3},
        {"{\"poses\": {\"rate\": \"30\"}}", "expected a number", 1, 20},
        {"{\"poses\": {\"rate\": 1e9}}", "expected 10 to 240", 1, 20},
        {"{\"poses\": {\"rate\": -1}}", "expected 10 to 240", 1, 20},
        {"{\"poses\": 30}", "expected an object", 1, 2},
        {"{\"poses\": {\"rate\": 30, \"rate\": 40}}", "not valid JSON", 1, 0},
        {"{\"poses\": {\"rate\": NaN}}", "not valid JSON", 1, 0},
        {"{\"//\": 3}", "comment", 1, 2},
        {"{\"poses\": {\"//\": {}}}", "comment", 1, 12},
        {"[]", "expected an object", 1, 1},
        {"", "not valid JSON", 1, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        ff_error error;
        ff_settings settings = ff_settings_default(), before = settings;
        assert_int_equal(parse(cases[i].text, &settings, &error), FF_ERR_PARSE);
        if (!strstr(error.message, cases[i].says)) fail_msg("%s: %s", cases[i].text, error.message);
        assert_string_equal(error.file, "my.json");
        assert_int_equal(error.line, cases[i].line);
        if (cases[i].column) assert_int_equal(error.column, cases[i].column);
        assert_true(equal(&settings, &before));
    }
}

static void a_hash_sees_the_settings_of_its_stage_and_those_before(void **state)
{
    (void)state;
    ff_settings settings = ff_settings_default(), changed = settings;
    changed.poses.rate = 30.0;
    assert_true(ff_settings_hash(&settings, FF_STAGE_PACK, 1) !=
                ff_settings_hash(&changed, FF_STAGE_PACK, 1));
    assert_true(ff_settings_hash(&settings, FF_STAGE_CUT, 1) == ff_settings_hash(&changed, FF_STAGE_CUT, 1));
    assert_true(ff_settings_hash(&settings, FF_STAGE_PACK, 1) !=
                ff_settings_hash(&settings, FF_STAGE_PACK, 2));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_setting_is_described_and_its_default_is_in_range),
        cmocka_unit_test(no_setting_is_missing_from_the_table),
        cmocka_unit_test(a_setting_can_be_set_to_both_ends_of_its_range_and_no_further),
        cmocka_unit_test(what_is_absent_keeps_its_default_and_comments_are_allowed_anywhere),
        cmocka_unit_test(files_are_named_relative_to_the_configuration),
        cmocka_unit_test(what_is_wrong_is_refused_at_its_place_and_changes_nothing),
        cmocka_unit_test(a_hash_sees_the_settings_of_its_stage_and_those_before),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
