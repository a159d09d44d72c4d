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
/* When items are unlike: start, then weigh with the work of all of them, and step_by with each one's own, in any unit.
 * The time left, told of what takes more than a few seconds, goes by work. */
void ff_progress_weigh(ff_progress *progress, double work);
void ff_progress_step_by(ff_progress *progress, const char *item, double work);
void ff_progress_end(ff_progress *progress); /* clears the line, frees */

#endif
