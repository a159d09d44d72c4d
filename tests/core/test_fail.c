/* Errors: how each kind of place is rendered, and that nothing overflows. */
#include "tests/check.h"

#include "runtime/core/base/fail.h"

static void each_kind_of_place_is_rendered_on_one_line(void **state)
{
    (void)state;
    static const struct {
        ff_error error;
        const char *want;
    } cases[] = {
        {{.message = "no place"}, "no place"},
        {{.file = "a.bvh", .message = "empty"}, "a.bvh: empty"},
        {{.file = "a.bvh", .line = 3, .message = "short row"}, "a.bvh:3: short row"},
        {{.file = "a.bvh", .line = 3, .column = 9, .message = "nan"}, "a.bvh:3:9: nan"},
        {{.section = "JNTS", .byte_offset = 4096, .message = "bad parent"},
         "section JNTS, byte 4096: bad parent"},
        {{.file = "x.ffpack", .section = "HULL", .byte_offset = 5000000000, .message = "open"},
         "x.ffpack: section HULL, byte 5000000000: open"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[256];
        assert_string_equal(ff_error_text(&cases[i].error, text, sizeof text), cases[i].want);
    }
}

static void making_an_error_fills_every_field_and_clears_the_old_ones(void **state)
{
    (void)state;
    ff_error error;
    memset(&error, 0x55, sizeof error);
    assert_int_equal(ff_fail_at(&error, FF_ERR_PARSE, "a.amc", 7, 2, "%d of %d", 3, 4), FF_ERR_PARSE);
    assert_int_equal(error.status, FF_ERR_PARSE);
    assert_string_equal(error.file, "a.amc");
    assert_int_equal(error.line, 7);
    assert_int_equal(error.column, 2);
    assert_string_equal(error.section, "");
    assert_string_equal(error.message, "3 of 4");
    assert_int_equal(ff_fail_section(&error, FF_ERR_RANGE, "CLIP", 64, "too many"), FF_ERR_RANGE);
    assert_string_equal(error.file, "");
    assert_int_equal(error.line, 0);
    assert_string_equal(error.section, "CLIP");
    assert_int_equal(error.byte_offset, 64);
    ff_error_in_file(&error, "first.ffpack");
    ff_error_in_file(&error, "second.ffpack"); /* the innermost name stays */
    assert_string_equal(error.file, "first.ffpack");
}

static void a_caller_without_an_error_gets_the_status_alone(void **state)
{
    (void)state;
    assert_int_equal(ff_fail(NULL, FF_ERR_IO, "%s", "x"), FF_ERR_IO);
    assert_int_equal(ff_fail_at(NULL, FF_ERR_IO, "x", 1, 1, "x"), FF_ERR_IO);
    assert_int_equal(ff_fail_section(NULL, FF_ERR_IO, "x", 1, "x"), FF_ERR_IO);
    ff_error_in_file(NULL, "x");
}

static void long_names_and_messages_are_cut_not_overrun(void **state)
{
    (void)state;
    char longer[2000], text[64];
    memset(longer, 'y', sizeof longer - 1);
    longer[sizeof longer - 1] = '\0';
    ff_error error;
    ff_fail_at(&error, FF_ERR_PARSE, longer, 1, 1, "%s", longer);
    assert_int_equal(strlen(error.file), sizeof error.file - 1);
    assert_int_equal(strlen(error.message), sizeof error.message - 1);
    ff_error_text(&error, text, sizeof text);
    assert_int_equal(strlen(text), sizeof text - 1);
    ff_fail_section(&error, FF_ERR_PARSE, longer, 1, "x");
    assert_int_equal(strlen(error.section), sizeof error.section - 1);
}

static void every_status_has_a_name_of_its_own(void **state)
{
    (void)state;
    for (int i = FF_OK; i <= FF_ERR_NO_MEMORY; ++i) {
        for (int j = FF_OK; j < i; ++j)
            assert_string_not_equal(ff_status_name((ff_status)i), ff_status_name((ff_status)j));
    }
    assert_string_equal(ff_status_name(FF_OK), "ok");
    assert_string_equal(ff_status_name((ff_status)1000), "unknown");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_kind_of_place_is_rendered_on_one_line),
        cmocka_unit_test(making_an_error_fills_every_field_and_clears_the_old_ones),
        cmocka_unit_test(a_caller_without_an_error_gets_the_status_alone),
        cmocka_unit_test(long_names_and_messages_are_cut_not_overrun),
        cmocka_unit_test(every_status_has_a_name_of_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
