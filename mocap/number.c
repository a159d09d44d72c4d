#define _GNU_SOURCE /* strtod_l: the locale of the program must not change how files are read */
#include "mocap/number.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const double ff_powers_of_ten[23] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                     1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

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
