#include "mocap/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ff_status ff_text_start(ff_text *text, const char *data, size_t size, const char *name, ff_error *error)
{
    memset(text, 0, sizeof *text);
    text->name = name;
    text->line = 1;
    if (size == 0) return ff_fail_at(error, FF_ERR_NO_DATA, name, 1, 1, "the file is empty");
    if (data[size - 1] != '\n') {
        text->copy = malloc(size + 1);
        if (!text->copy) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the text of %s", name);
        memcpy(text->copy, data, size);
        text->copy[size++] = '\n';
        data = text->copy;
    }
    text->end = data + size;
    if (size >= 3 && memcmp(data, "\xef\xbb\xbf", 3) == 0) data += 3;
    text->cursor = text->line_start = data;
    return FF_OK;
}

void ff_text_end(ff_text *text)
{
    free(text->copy);
    memset(text, 0, sizeof *text);
}

void ff_text_next_line(ff_text *text)
{
    if (text->cursor == text->end) return;
    text->cursor = (const char *)memchr(text->cursor, '\n', (size_t)(text->end - text->cursor)) + 1;
    text->line_start = text->cursor;
    text->line++;
}

bool ff_text_skip(ff_text *text, bool comments)
{
    while (text->cursor < text->end) {
        text->cursor = ff_skip_blanks(text->cursor);
        if (*text->cursor != '\n' && !(comments && *text->cursor == '#')) return true;
        ff_text_next_line(text);
    }
    return false;
}

static bool ends_word(char c)
{
    return (unsigned char)c <= ' ' || c == '{' || c == '}';
}

ff_word ff_text_word(ff_text *text)
{
    if (text->cursor == text->end) return (ff_word){text->end, 0};
    const char *begin = ff_skip_blanks(text->cursor), *p = begin;
    if (*p == '{' || *p == '}') {
        ++p;
    } else {
        while (!ends_word(*p))
            ++p;
        if (p == begin && *p != '\n') ++p; /* a control character: a word that nothing equals */
    }
    text->cursor = p;
    return (ff_word){begin, (size_t)(p - begin)};
}

ff_word ff_text_rest(ff_text *text, char stop)
{
    if (text->cursor == text->end) return (ff_word){text->end, 0};
    const char *begin = ff_skip_blanks(text->cursor), *p = begin;
    while (*p != '\n' && *p != stop)
        ++p;
    text->cursor = p;
    while (p > begin && (p[-1] == ' ' || p[-1] == '\t' || p[-1] == '\r'))
        --p;
    return (ff_word){begin, (size_t)(p - begin)};
}

bool ff_word_is(ff_word word, const char *lower)
{
    size_t i = 0;
    for (; i < word.length && lower[i]; ++i) {
        char c = word.begin[i];
        if (c >= 'A' && c <= 'Z') c = (char)(c + 32);
        if (c != lower[i]) return false;
    }
    return i == word.length && !lower[i];
}

bool ff_word_to_name(ff_word word, char name[64])
{
    size_t length = word.length < 63 ? word.length : 63;
    memcpy(name, word.begin, length);
    for (size_t i = 0; i < length; ++i)
        if (name[i] == '\0') name[i] = '?';
    memset(name + length, 0, 64 - length);
    return length == word.length;
}

ff_quote ff_word_quote(ff_word word)
{
    ff_quote quote = {{0}};
    size_t length = word.length < 40 ? word.length : 40;
    for (size_t i = 0; i < length; ++i)
        quote.text[i] = word.begin[i] >= ' ' && word.begin[i] < 127 ? word.begin[i] : '?';
    if (length < word.length) memcpy(quote.text + length, "...", 4);
    return quote;
}

static uint32_t column_of(const ff_text *text, const char *at)
{
    if (!at) return 0;
    return at < text->line_start ? 1 : (uint32_t)(at - text->line_start) + 1;
}

ff_status ff_text_fail(const ff_text *text, const char *at, ff_status status, ff_error *error,
                       const char *format, ...)
{
    char message[384];
    va_list list;
    va_start(list, format);
    vsnprintf(message, sizeof message, format, list);
    va_end(list);
    return ff_fail_at(error, status, text->name, text->line, column_of(text, at), "%s", message);
}

void ff_clip_warn(ff_clip *clip, const char *format, ...)
{
    if (clip->warning_count++ > 0) return;
    va_list list;
    va_start(list, format);
    vsnprintf(clip->warning, sizeof clip->warning, format, list);
    va_end(list);
}

ff_status ff_text_odd(const ff_text *text, const char *at, bool strict, ff_clip *clip, ff_error *error,
                      const char *format, ...)
{
    char message[384];
    va_list list;
    va_start(list, format);
    vsnprintf(message, sizeof message, format, list);
    va_end(list);
    if (strict)
        return ff_fail_at(error, FF_ERR_PARSE, text->name, text->line, column_of(text, at), "%s", message);
    ff_clip_warn(clip, "line %u: %s", text->line, message);
    return FF_OK;
}

ff_status ff_text_bad_number(const ff_text *text, const char *p, const char *what, ff_error *error)
{
    const char *stop = p;
    while (!ends_word(*stop))
        ++stop;
    ff_word word = {p, (size_t)(stop - p)};
    ff_quote quote = ff_word_quote(word);
    if (word.length == 0 && *p == '\n')
        return ff_text_fail(text, p, FF_ERR_PARSE, error, "the line ends where %s is expected", what);
    size_t sign = *p == '-' || *p == '+' ? 1 : 0;
    ff_word bare = {p + sign, word.length - sign};
    double value;
    bool overflow =
        bare.length > 0 && bare.begin[0] >= '0' && bare.begin[0] <= '9' && !ff_number_scan(p, &value);
    for (size_t i = 0; i < bare.length && overflow; ++i)
        overflow = strchr("0123456789.eE+-", bare.begin[i]) != NULL;
    if (ff_word_is(bare, "nan") || ff_word_is(bare, "inf") || ff_word_is(bare, "infinity") ||
        (bare.length > 4 && ff_word_is((ff_word){bare.begin, 4}, "nan(")))
        return ff_text_fail(text, p, FF_ERR_NOT_FINITE, error, "%s is '%s', a finite number is needed", what,
                            quote.text);
    if (ff_number_scan(p, &value))
        return ff_text_fail(text, p, FF_ERR_RANGE, error, "%s is %s, which is absurd (beyond %g)", what,
                            quote.text, FF_TEXT_LARGEST);
    return ff_text_fail(text, p, overflow ? FF_ERR_RANGE : FF_ERR_PARSE, error,
                        overflow ? "%s is '%s', which no number can hold"
                                 : "%s is '%s', which is not a decimal number",
                        what, quote.text);
}

ff_status ff_text_number(ff_text *text, const char *what, double *out, ff_error *error)
{
    const char *p = text->cursor < text->end ? ff_skip_blanks(text->cursor) : text->end - 1;
    const char *next = ff_number_scan(p, out);
    if (!next || !(fabs(*out) <= FF_TEXT_LARGEST)) return ff_text_bad_number(text, p, what, error);
    text->cursor = next;
    return FF_OK;
}

ff_status ff_text_vec3(ff_text *text, const char *what, ff_vec3 *out, ff_error *error)
{
    ff_status status = ff_text_number(text, what, &out->x, error);
    if (status == FF_OK) status = ff_text_number(text, what, &out->y, error);
    return status == FF_OK ? ff_text_number(text, what, &out->z, error) : status;
}

ff_status ff_text_integer(ff_text *text, const char *what, long long low, long long high, long long *out,
                          ff_error *error)
{
    const char *p = text->cursor < text->end ? ff_skip_blanks(text->cursor) : text->end - 1;
    const char *q = p + (*p == '-' || *p == '+');
    long long value = 0;
    const char *digits = q;
    for (; *q >= '0' && *q <= '9'; ++q)
        if (value < 1000000000000000LL) value = value * 10 + (*q - '0');
    if (*p == '-') value = -value;
    if (q == digits || !ends_word(*q)) {
        while (!ends_word(*q))
            ++q;
        return ff_text_fail(text, p, FF_ERR_PARSE, error, "%s is '%s', a whole number is expected", what,
                            ff_word_quote((ff_word){p, (size_t)(q - p)}).text);
    }
    if (value < low || value > high)
        return ff_text_fail(text, p, FF_ERR_RANGE, error, "%s is %.*s, expected %lld to %lld", what,
                            (int)(q - p < 24 ? q - p : 24), p, low, high);
    text->cursor = q;
    *out = value;
    return FF_OK;
}
