#define _GNU_SOURCE
#include "runtime/tool/progress.h"

#include "runtime/core/base/memory.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

struct ff_progress {
    pthread_mutex_t lock;
    char what[64];
    uint64_t total, done;
    double work, work_done;
    double began, last; /* s; last: when something was printed */
    bool terminal;
};

static double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

ff_progress *ff_progress_start(const char *what, uint64_t total, bool quiet)
{
    if (quiet) return NULL;
    ff_progress *progress = ff_calloc(1, sizeof *progress);
    if (!progress) return NULL; /* work goes on without */
    snprintf(progress->what, sizeof progress->what, "%s", what);
    progress->total = total;
    progress->work = (double)total;
    progress->began = progress->last = seconds_now(); /* work of less than a moment prints nothing */
    progress->terminal = isatty(STDERR_FILENO) != 0;
    pthread_mutex_init(&progress->lock, NULL);
    return progress;
}

void ff_progress_weigh(ff_progress *progress, double work)
{
    if (progress) progress->work = work;
}

void ff_progress_step(ff_progress *progress, const char *item)
{
    ff_progress_step_by(progress, item, 1.0);
}

/* ", 1:05 left", or nothing while too little is known. */
static const char *time_left(const ff_progress *progress, double now, char *text, size_t size)
{
    double spent = now - progress->began, left = progress->work - progress->work_done;
    text[0] = '\0';
    if (spent < 2.0 || !(left > 0.0) || !(progress->work_done > 0.02 * progress->work)) return text;
    double seconds = spent * left / progress->work_done + 0.5;
    if (seconds < 86400.0) snprintf(text, size, ", %d:%02d left", (int)(seconds / 60.0), (int)seconds % 60);
    return text;
}

void ff_progress_step_by(ff_progress *progress, const char *item, double work)
{
    if (!progress) return;
    pthread_mutex_lock(&progress->lock);
    ++progress->done;
    progress->work_done += work;
    double now = seconds_now();
    if (now - progress->last >= (progress->terminal ? 0.1 : 1.0)) {
        char left[32];
        progress->last = now;
        fprintf(stderr, "%s%s %llu/%llu%s%s%.60s%s", progress->terminal ? "\r\033[K" : "", progress->what,
                (unsigned long long)progress->done, (unsigned long long)progress->total,
                time_left(progress, now, left, sizeof left), item ? " " : "", item ? item : "",
                progress->terminal ? "" : "\n");
        fflush(stderr);
    }
    pthread_mutex_unlock(&progress->lock);
}

void ff_progress_end(ff_progress *progress)
{
    if (!progress) return;
    if (progress->terminal) {
        fputs("\r\033[K", stderr);
        fflush(stderr);
    }
    pthread_mutex_destroy(&progress->lock);
    free(progress);
}
