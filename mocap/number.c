#define _GNU_SOURCE /* strtod_l: the locale of the program must not change how files are read */
#include "mocap/number.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const double ff_powers_of_ten[23] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                     1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

__extension__ typedef unsigned __int128 wide;

/* 10^0 to 10^19: the powers of ten that 64 bits hold. */
static const uint64_t whole_powers[20] = {UINT64_C(1),
                                          UINT64_C(10),
                                          UINT64_C(100),
                                          UINT64_C(1000),
                                          UINT64_C(10000),
                                          UINT64_C(100000),
                                          UINT64_C(1000000),
                                          UINT64_C(10000000),
                                          UINT64_C(100000000),
                                          UINT64_C(1000000000),
                                          UINT64_C(10000000000),
                                          UINT64_C(100000000000),
                                          UINT64_C(1000000000000),
                                          UINT64_C(10000000000000),
                                          UINT64_C(100000000000000),
                                          UINT64_C(1000000000000000),
                                          UINT64_C(10000000000000000),
                                          UINT64_C(100000000000000000),
                                          UINT64_C(1000000000000000000),
                                          UINT64_C(10000000000000000000)};

/* 2^exponent, for an exponent that a normal double has. */
static double power_of_two(int exponent)
{
    uint64_t bits = (uint64_t)(exponent + 1023) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

/* Both are shifted up to 64 bits, so that their quotient has 63 or 64 bits, ten more than a double; the remainder says
 * whether it lies above them. */
double ff_number_divide(uint64_t digits, int places)
{
    uint64_t power = whole_powers[places];
    int up = __builtin_clzll(digits), down = __builtin_clzll(power);
    wide dividend = (wide)(digits << up) << 63;
    uint64_t divisor = power << down;
    uint64_t quotient = (uint64_t)(dividend / divisor);
    bool rest = (wide)quotient * divisor != dividend;
    int extra = 64 - 53 - __builtin_clzll(quotient);
    uint64_t kept = quotient >> extra, lost = quotient & ((UINT64_C(1) << extra) - 1);
    uint64_t half = UINT64_C(1) << (extra - 1);
    if (lost > half || (lost == half && (rest || (kept & 1u)))) ++kept;
    return (double)kept * power_of_two(extra + down - up - 63);
}

bool ff_number_slow(const char *begin, const char *end, double *out)
{
    char text[400];
    size_t length = (size_t)(end - begin);
    if (length >= sizeof text) return false;
    memcpy(text, begin, length);
    text[length] = '\0';
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!plain) return false;
    char *stop;
    double value = strtod_l(text, &stop, plain);
    freelocale(plain);
    if (stop != text + length || !isfinite(value)) return false;
    *out = value;
    return true;
}

bool ff_number_may_be_cut(const char *p)
{
    while ((*p >= '0' && *p <= '9') || *p == '-' || *p == '+' || *p == '.' || *p == 'e' || *p == 'E')
        ++p;
    while (*p == ' ' || *p == '\t' || *p == '\r')
        ++p;
    return *p == '\n';
}
