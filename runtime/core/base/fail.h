/* fail.h - the one place where errors are made, so that one breakpoint finds any of them. */
#ifndef FF_FAIL_H
#define FF_FAIL_H

#include "runtime/footfall.h"

#if defined(__GNUC__)
#define FF_PRINTF(text, first) __attribute__((__format__(__printf__, text, first)))
#else
#define FF_PRINTF(text, first)
#endif

/* Fill *error (may be NULL) with status and message, without a place; returns status. */
ff_status ff_fail(ff_error *error, ff_status status, const char *format, ...) FF_PRINTF(3, 4);

/* The same at a place in a text file; line and column are 1-based, 0 = unknown. */
ff_status ff_fail_at(ff_error *error, ff_status status, const char *file, uint32_t line, uint32_t column,
                     const char *format, ...) FF_PRINTF(6, 7);

/* The same at a byte of a pack section. */
ff_status ff_fail_section(ff_error *error, ff_status status, const char *section, uint64_t byte_offset,
                          const char *format, ...) FF_PRINTF(5, 6);

#if defined(__clang_analyzer__) && !defined(FF_FAIL_C)
/* clang-tidy looks at one file at a time: this tells it that what these return is the status they are given. */
#define ff_fail(error, status, ...) (ff_fail(error, status, __VA_ARGS__), (status))
#define ff_fail_at(error, status, ...) (ff_fail_at(error, status, __VA_ARGS__), (status))
#define ff_fail_section(error, status, ...) (ff_fail_section(error, status, __VA_ARGS__), (status))
#endif

/* Put the file's name on an error that was raised where the name was not known. */
void ff_error_in_file(ff_error *error, const char *file);

#endif
