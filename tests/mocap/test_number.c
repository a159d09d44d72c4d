/* Numbers out of text: correctly rounded like strtod's, and only what is a plain decimal number. */
#include "mocap/number.h"
#include "runtime/core/base/random.h"
#include "tests/check.h"

#include <locale.h>
#include <stdio.h>

static const char *scan(const char *text, double *out)
{
    static char line[600];
    snprintf(line, sizeof line, "%s\n", text);
    const char *end = ff_number_scan(line, out);
    return end ? text + (end - line) : NULL;
}

static void assert_same_bits_as_strtod(const char *text)
{
    double got = 0.0, want = strtod(text, NULL);
    uint64_t got_bits, want_bits;
    assert_non_null(scan(text, &got));
    memcpy(&got_bits, &got, sizeof got);
    memcpy(&want_bits, &want, sizeof want);
    if (got_bits != want_bits) {
        print_error("%s read as %.17g, strtod says %.17g\n", text, got, want);
        fail();
    }
}

static void numbers_as_motion_files_write_them_are_rounded_like_strtod(void **state)
{
    (void)state;
    static const char *const formats[] = {"%.4f", "%.6f", "%g", "%.9g", "%e", "%.15g", "%.17g", "%.25f"};
    ff_random random = {7, 1, 0};
    for (int i = 0; i < 40000; ++i) {
        char text[400];
        double size = ff_random_range(&random, -20.0, 12.0);
        double value = ff_random_range(&random, -1.0, 1.0) * pow(10.0, size);
        snprintf(text, sizeof text, formats[i % 8], value);
        assert_same_bits_as_strtod(text);
    }
}

/* 19 digits and up to 19 decimals, many of them halfway between two doubles or a hair beside. */
static void many_digits_are_rounded_like_strtod(void **state)
{
    (void)state;
    ff_random random = {9, 2, 0};
    for (int i = 0; i < 60000; ++i) {
        char text[64], whole[24];
        uint64_t digits = ff_random_next(&random) % UINT64_C(10000000000000000000);
        if (i % 3 == 0) { /* the middle of two neighbours among the doubles above 2^53, plus -1, 0 or 1 */
            uint64_t bits = (ff_random_next(&random) >> 11) | (UINT64_C(1) << 52);
            digits = ((bits << 1 | 1u) << (ff_random_next(&random) % 9)) + ff_random_next(&random) % 3 - 1;
        }
        int length = snprintf(whole, sizeof whole, "%llu", (unsigned long long)digits);
        int places = (int)(ff_random_next(&random) % 20);
        if (places >= length) {
            snprintf(text, sizeof text, "-0.%0*d%s", places - length + 1, 0, whole);
        } else {
            snprintf(text, sizeof text, "%.*s.%s", length - places, whole, whole + length - places);
        }
        assert_same_bits_as_strtod(text);
    }
}

static void odd_but_legal_spellings_are_read(void **state)
{
    (void)state;
    static const char *const legal[] = {"0",
                                        "-0",
                                        "+1.5",
                                        ".5",
                                        "5.",
                                        "-.25e+1",
                                        "1E3",
                                        "00012",
                                        "7.62852e-016",
                                        "-1.6201e-014",
                                        "1e22",
                                        "1e-22",
                                        "9007199254740993",
                                        "123456789012345678901234567890",
                                        "0.000000000000000000000000000001",
                                        "2.2250738585072011e-308",
                                        "1e-400",
                                        "0e99999999999"};
    for (size_t i = 0; i < sizeof legal / sizeof legal[0]; ++i)
        assert_same_bits_as_strtod(legal[i]);
}

static void everything_else_is_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {"",       "-",     "+",     ".",     "-.",       "e5",  "1e",
                                        "1e+",    "1.5x",  "0x10",  "1..2",  "1.2.3",    "--1", "+-1",
                                        "nan",    "-nan",  "inf",   "-inf",  "infinity", "1,5", "1e999",
                                        "-1e400", "0x1p3", "1_000", "NaN(1)"};
    double value = 0.0;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i)
        if (scan(wrong[i], &value)) {
            print_error("'%s' was read as %g\n", wrong[i], value);
            fail();
        }
    char endless[520];
    memset(endless, '1', sizeof endless - 1);
    endless[sizeof endless - 1] = '\0';
    assert_null(scan(endless, &value));
}

static void the_scan_stops_behind_the_number(void **state)
{
    (void)state;
    double value = 0.0;
    assert_string_equal(scan("12.5 next", &value), " next");
    assert_string_equal(scan("-3\tnext", &value), "\tnext");
    assert_string_equal(scan("4.5e1\r", &value), "\r");
    FF_ASSERT_NEAR(value, 45.0, 0.0);
}

static void the_locale_does_not_matter(void **state)
{
    (void)state;
    if (!setlocale(LC_NUMERIC, "de_DE.UTF-8") && !setlocale(LC_NUMERIC, "fr_FR.UTF-8"))
        print_message("no locale with a decimal comma here; the check is then trivial\n");
    double value = 0.0;
    assert_non_null(scan("0.12345678901234567890123", &value)); /* too long for the fast path */
    setlocale(LC_NUMERIC, "C");
    FF_ASSERT_NEAR(value, 0.12345678901234567890123, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_as_motion_files_write_them_are_rounded_like_strtod),
        cmocka_unit_test(many_digits_are_rounded_like_strtod),
        cmocka_unit_test(odd_but_legal_spellings_are_read),
        cmocka_unit_test(everything_else_is_refused),
        cmocka_unit_test(the_scan_stops_behind_the_number),
        cmocka_unit_test(the_locale_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
