/* text.h - text that grows, for files written whole. */
#ifndef FF_TEXT_H
#define FF_TEXT_H

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

typedef struct ff_text {
    ff_array bytes;
    bool failed; /* memory ran out: the text is useless */
} ff_text;

/* Append one formatted piece (shorter than 512 bytes). */
void ff_text_add(ff_text *text, const char *format, ...) FF_PRINTF(2, 3);
void ff_text_free(ff_text *text);

/* Write it to path, whole or not at all, and free it. */
ff_status ff_text_write(ff_text *text, const char *path, ff_error *error);

#endif
