/* progress.h - what a long command is doing: a line that rewrites itself on a terminal, plain lines elsewhere (at
 * most one a second), nothing with --quiet. Goes to stderr; results go to stdout. Safe from several threads. */
#ifndef FF_PROGRESS_H
#define FF_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct ff_progress ff_progress;

ff_progress *ff_progress_start(const char *what, uint64_t total,
                               bool quiet);                     /* may return NULL: all calls accept it */
void ff_progress_step(ff_progress *progress, const char *item); /* one more done; item may be NULL */
void ff_progress_end(ff_progress *progress);                    /* clears the line, frees */

#endif
