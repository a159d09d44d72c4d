#define FF_FAIL_C
#include "runtime/core/base/fail.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char *const status_names[] = {"ok",    "argument",    "io",      "parse",    "not finite",
                                           "range", "unsupported", "no data", "no memory"};

const char *ff_status_name(ff_status status)
{
    size_t count = sizeof status_names / sizeof status_names[0];
    return (size_t)status < count ? status_names[status] : "unknown";
}

static void copy_text(char *to, size_t size, const char *from)
{
    snprintf(to, size, "%s", from ? from : "");
}

static ff_status fill(ff_error *error, ff_status status, const char *format, va_list arguments)
    FF_PRINTF(3, 0);

static ff_status fill(ff_error *error, ff_status status, const char *format, va_list arguments)
{
    if (!error) return status;
    memset(error, 0, sizeof *error);
    error->status = status;
    vsnprintf(error->message, sizeof error->message, format, arguments);
    return status;
}

ff_status ff_fail(ff_error *error, ff_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fill(error, status, format, arguments);
    va_end(arguments);
    return status;
}

ff_status ff_fail_at(ff_error *error, ff_status status, const char *file, uint32_t line, uint32_t column,
                     const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fill(error, status, format, arguments);
    va_end(arguments);
    if (error) {
        copy_text(error->file, sizeof error->file, file);
        error->line = line;
        error->column = column;
    }
    return status;
}

ff_status ff_fail_section(ff_error *error, ff_status status, const char *section, uint64_t byte_offset,
                          const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fill(error, status, format, arguments);
    va_end(arguments);
    if (error) {
        copy_text(error->section, sizeof error->section, section);
        error->byte_offset = byte_offset;
    }
    return status;
}

void ff_error_in_file(ff_error *error, const char *file)
{
    if (error && !error->file[0]) copy_text(error->file, sizeof error->file, file);
}

const char *ff_error_text(const ff_error *error, char *text, size_t size)
{
    if (error->section[0]) {
        snprintf(text, size, "%s%ssection %s, byte %llu: %s", error->file, error->file[0] ? ": " : "",
                 error->section, (unsigned long long)error->byte_offset, error->message);
    } else if (error->line && error->column) {
        snprintf(text, size, "%s:%u:%u: %s", error->file, error->line, error->column, error->message);
    } else if (error->line) {
        snprintf(text, size, "%s:%u: %s", error->file, error->line, error->message);
    } else {
        snprintf(text, size, "%s%s%s", error->file, error->file[0] ? ": " : "", error->message);
    }
    return text;
}
