/* text.h - scanning the text of motion files: lines, words and numbers, with places for messages.
 *
 * A text always ends in a newline (ff_text_start sees to it), so that loops over digits, blanks or the letters of a
 * word stop inside it without a bound being checked for every character.
 */
#ifndef FF_TEXT_H
#define FF_TEXT_H

#include "mocap/clip.h"
#include "mocap/number.h"
#include "runtime/core/base/fail.h"

typedef struct ff_text {
    const char *cursor, *end; /* end[-1] is '\n' */
    const char *line_start;
    uint32_t line;    /* 1-based, of line_start */
    const char *name; /* of the file, for messages */
    char *copy;       /* the text again when it had to be given a last newline; owned */
} ff_text;

/* A stretch of the text, not terminated. */
typedef struct ff_word {
    const char *begin;
    size_t length;
} ff_word;

/* Borrow size bytes at data; a byte order mark is skipped. Ends with ff_text_end. */
ff_status ff_text_start(ff_text *text, const char *data, size_t size, const char *name, ff_error *error);
void ff_text_end(ff_text *text);

static inline const char *ff_skip_blanks(const char *p)
{
    while (*p == ' ' || *p == '\t' || *p == '\r')
        ++p;
    return p;
}

/* The start of the next line. */
void ff_text_next_line(ff_text *text);

/* Skip white space over line ends (and the rest of lines after '#' when comments is set). False at the end of the text. */
bool ff_text_skip(ff_text *text, bool comments);

/* The next word of this line; empty at its end. '{' and '}' are words of their own. */
ff_word ff_text_word(ff_text *text);

/* The rest of this line up to stop ('\n' for all of it), without surrounding blanks. */
ff_word ff_text_rest(ff_text *text, char stop);

/* Equal but for upper and lower case; lower is in lower case. */
bool ff_word_is(ff_word word, const char *lower);

/* Copy word into a name of 64 bytes, cut when too long (false then). */
bool ff_word_to_name(ff_word word, char name[64]);

/* A word as it may stand in a message: at most 40 characters, nothing unprintable. */
typedef struct ff_quote {
    char text[48];
} ff_quote;
ff_quote ff_word_quote(ff_word word);

/* Raise an error at a place on the current line. */
ff_status ff_text_fail(const ff_text *text, const char *at, ff_status status, ff_error *error,
                       const char *format, ...) FF_PRINTF(5, 6);

/* Something odd that can be worked around: counted (and the first kept) in clip, or an error when strict. */
ff_status ff_text_odd(const ff_text *text, const char *at, bool strict, ff_clip *clip, ff_error *error,
                      const char *format, ...) FF_PRINTF(6, 7);

/* Count a warning in the clip; keeps the first. */
void ff_clip_warn(ff_clip *clip, const char *format, ...) FF_PRINTF(2, 3);

/* No coordinate or angle of a person is beyond this; more is refused as absurd. */
#define FF_TEXT_LARGEST 1e7

/* The next word of this line as a finite number of at most FF_TEXT_LARGEST; what names it in the message. */
ff_status ff_text_number(ff_text *text, const char *what, double *out, ff_error *error);
ff_status ff_text_vec3(ff_text *text, const char *what, ff_vec3 *out, ff_error *error);
ff_status ff_text_integer(ff_text *text, const char *what, long long low, long long high, long long *out,
                          ff_error *error);

/* Say why the word at p is no number that can be used. */
ff_status ff_text_bad_number(const ff_text *text, const char *p, const char *what, ff_error *error);

#endif
