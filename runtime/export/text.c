#include "runtime/export/text.h"

#include "runtime/core/base/file.h"

#include <stdarg.h>
#include <stdio.h>

void ff_text_add(ff_text *text, const char *format, ...)
{
    char line[512];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    if (text->failed) return;
    char *place = length >= 0 && (size_t)length < sizeof line
                      ? ff_array_grow(&text->bytes, (size_t)length, sizeof *place)
                      : NULL;
    if (!place) {
        text->failed = true;
        return;
    }
    for (int i = 0; i < length; ++i)
        place[i] = line[i];
}

void ff_text_free(ff_text *text)
{
    ff_array_free(&text->bytes);
    text->failed = false;
}

ff_status ff_text_write(ff_text *text, const char *path, ff_error *error)
{
    ff_status status = text->failed ? ff_fail(error, FF_ERR_NO_MEMORY, "no memory to write %s", path)
                                    : ff_file_write_atomic(path, text->bytes.data, text->bytes.count, error);
    ff_text_free(text);
    return status;
}
