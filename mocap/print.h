/* print.h - text that grows, with numbers written the same way whatever the program's locale is. */
#ifndef FF_PRINT_H
#define FF_PRINT_H

#include "runtime/core/base/maths.h"
#include "runtime/core/base/memory.h"

typedef struct ff_print {
    ff_array bytes;
    bool failed; /* memory was short; what was added since is missing */
} ff_print;

void ff_print_text(ff_print *print, const char *text);
/* count copies of text. */
void ff_print_repeat(ff_print *print, const char *text, int count);
/* Decimals behind the point (at most 9), rounded; |value| below 1e9. */
void ff_print_number(ff_print *print, double value, int decimals);
void ff_print_integer(ff_print *print, long long value);
/* A blank and a number, three times. */
void ff_print_vec3(ff_print *print, ff_vec3 v, int decimals);

/* Write the text to a file, whole or not at all, and free it. */
ff_status ff_print_to_file(ff_print *print, const char *path, ff_error *error);

#endif
