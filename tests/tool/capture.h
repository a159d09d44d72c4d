/* capture.h - what a piece of code prints, for tests of command lines and progress. */
#ifndef FF_CAPTURE_H
#define FF_CAPTURE_H

#include <stdio.h>
#include <unistd.h>

/* One stream of this process turned into a temporary file for a while. */
typedef struct ff_capture {
    FILE *stream, *file;
    int kept; /* the stream's real descriptor */
    char text[4096];
} ff_capture;

static inline void ff_capture_start(ff_capture *capture, FILE *stream)
{
    capture->stream = stream;
    capture->file = tmpfile();
    assert_non_null(capture->file);
    fflush(stream);
    capture->kept = dup(fileno(stream));
    assert_true(dup2(fileno(capture->file), fileno(stream)) >= 0);
}

/* Give the stream back; returns what was printed. */
static inline const char *ff_capture_end(ff_capture *capture)
{
    fflush(capture->stream);
    dup2(capture->kept, fileno(capture->stream));
    close(capture->kept);
    rewind(capture->file);
    size_t size = fread(capture->text, 1, sizeof capture->text - 1, capture->file);
    capture->text[size] = '\0';
    fclose(capture->file);
    return capture->text;
}

#endif
