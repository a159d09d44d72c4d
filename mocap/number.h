/* number.h - decimal numbers out of text, correctly rounded and independent of the locale. */
#ifndef FF_NUMBER_H
#define FF_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/* Any well-formed number of length characters at begin; false when it is too long or beyond the range of double. */
bool ff_number_slow(const char *begin, const char *end, double *out);

/* Correctly rounded digits / 10^places, for digits > 0 and places from 0 to 19. */
double ff_number_divide(uint64_t digits, int places);

/* The word at p may be the beginning of a number that was cut off: nothing follows it on its line. */
bool ff_number_may_be_cut(const char *p);

/* 10^0 to 10^22: the powers of ten that a double holds exactly. */
extern const double ff_powers_of_ten[23];

/* Read a number at p: [+-] digits [. digits] [e [+-] digits], at least one digit, followed by white space. Returns the
 * place behind it, or NULL when there is no such number at p or it is not finite (nan, inf and hexadecimal are not
 * numbers here). The text must end in a newline.
 *
 * Up to 19 digits are gathered in an integer; when it and the power of ten are both exact as doubles, one multiplication
 * or division rounds correctly (Clinger 1990, the fast path). With more digits, as programs print that want to read back
 * the same bits, an integer division does; all else goes the slow way. */
static inline const char *ff_number_scan(const char *p, double *out)
{
    const char *begin = p;
    bool negative = *p == '-';
    p += (negative || *p == '+');
    uint64_t digits = 0;
    unsigned digit;
    const char *first = p;
    while ((digit = (unsigned)(unsigned char)*p - '0') < 10u)
        digits = digits * 10u + digit, ++p;
    long count = p - first;
    int exponent = 0;
    if (*p == '.') {
        first = ++p;
        while ((digit = (unsigned)(unsigned char)*p - '0') < 10u)
            digits = digits * 10u + digit, ++p;
        long decimals = p - first;
        count += decimals;
        exponent = decimals < 64 ? -(int)decimals : -64;
    }
    if (count == 0) return 0;
    if ((*p | 0x20) == 'e') {
        ++p;
        bool small = *p == '-';
        p += (small || *p == '+');
        first = p;
        int written = 0;
        while ((digit = (unsigned)(unsigned char)*p - '0') < 10u)
            written = written < 10000 ? written * 10 + (int)digit : written, ++p;
        if (p == first) return 0;
        exponent += small ? -written : written;
    }
    if ((unsigned char)*p > ' ') return 0;
    double value;
    if (count <= 19 && digits <= (UINT64_C(1) << 53) && exponent >= -22 && exponent <= 22) {
        value = (double)digits;
        value = exponent < 0 ? value / ff_powers_of_ten[-exponent] : value * ff_powers_of_ten[exponent];
    } else if (count <= 19 && digits > 0 && exponent >= -19 && exponent <= 0) {
        value = ff_number_divide(digits, -exponent);
    } else {
        return ff_number_slow(begin, p, out) ? p : 0;
    }
    *out = negative ? -value : value;
    return p;
}

#endif
