#include "mocap/print.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/file.h"

#include <string.h>

static void add(ff_print *print, const char *text, size_t length)
{
    char *to = print->failed ? NULL : ff_array_grow(&print->bytes, length, 1);
    print->failed = !to;
    if (to) memcpy(to, text, length);
}

void ff_print_text(ff_print *print, const char *text)
{
    add(print, text, strlen(text));
}

void ff_print_repeat(ff_print *print, const char *text, int count)
{
    for (int i = 0; i < count; ++i)
        ff_print_text(print, text);
}

/* Digits of value from the back of text, which ends at stop; at least least of them. */
static char *put_digits(char *stop, unsigned long long value, int least)
{
    char *p = stop;
    for (int written = 0; value > 0 || written < least; ++written) {
        *--p = (char)('0' + value % 10u);
        value /= 10u;
    }
    return p;
}

void ff_print_integer(ff_print *print, long long value)
{
    char text[24], *stop = text + sizeof text;
    unsigned long long size = value < 0 ? 0ULL - (unsigned long long)value : (unsigned long long)value;
    char *p = put_digits(stop, size, 1);
    if (value < 0) *--p = '-';
    add(print, p, (size_t)(stop - p));
}

void ff_print_number(ff_print *print, double value, int decimals)
{
    double power = 1.0;
    for (int i = 0; i < decimals; ++i)
        power *= 10.0;
    double scaled = floor(fabs(value) * power + 0.5);
    unsigned long long whole = (unsigned long long)ff_min(scaled, 1e18);
    unsigned long long unit = (unsigned long long)power;
    char text[40], *stop = text + sizeof text, *p = stop;
    if (decimals > 0) {
        p = put_digits(p, whole % unit, decimals);
        *--p = '.';
    }
    p = put_digits(p, whole / unit, 1);
    if (value < 0.0 && whole > 0) *--p = '-';
    add(print, p, (size_t)(stop - p));
}

void ff_print_vec3(ff_print *print, ff_vec3 v, int decimals)
{
    const double values[3] = {v.x, v.y, v.z};
    for (int i = 0; i < 3; ++i) {
        ff_print_text(print, " ");
        ff_print_number(print, values[i], decimals);
    }
}

ff_status ff_print_to_file(ff_print *print, const char *path, ff_error *error)
{
    ff_status status = print->failed
                           ? ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the text of %s", path)
                           : ff_file_write_atomic(path, print->bytes.data, print->bytes.count, error);
    ff_array_free(&print->bytes);
    return status;
}
