#define _GNU_SOURCE
#include "runtime/core/base/tasks.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>

struct ff_tasks {
    pthread_mutex_t lock;
    pthread_cond_t work, done;
    pthread_t *threads;
    uint32_t thread_count; /* started, besides the caller */
    uint64_t loop;         /* number of the loop now running; workers wait for it to change */
    uint32_t working;      /* workers still inside the loop */
    int stop;

    void (*function)(void *context, uint32_t index);
    void *context;
    uint32_t count, grain;
    _Atomic uint64_t next; /* 64 bits: every thread runs past count once, which must not wrap */
};

static void run_share(ff_tasks *tasks)
{
    for (;;) {
        uint64_t start = atomic_fetch_add(&tasks->next, tasks->grain);
        if (start >= tasks->count) return;
        uint32_t first = (uint32_t)start;
        uint32_t end = tasks->count - first < tasks->grain ? tasks->count : first + tasks->grain;
        for (uint32_t i = first; i < end; ++i)
            tasks->function(tasks->context, i);
    }
}

static void *worker(void *argument)
{
    ff_tasks *tasks = argument;
    uint64_t seen = 0;
    pthread_mutex_lock(&tasks->lock);
    for (;;) {
        while (!tasks->stop && tasks->loop == seen)
            pthread_cond_wait(&tasks->work, &tasks->lock);
        if (tasks->stop) break;
        seen = tasks->loop;
        pthread_mutex_unlock(&tasks->lock);
        run_share(tasks);
        pthread_mutex_lock(&tasks->lock);
        if (--tasks->working == 0) pthread_cond_signal(&tasks->done);
    }
    pthread_mutex_unlock(&tasks->lock);
    return NULL;
}

ff_status ff_tasks_create(uint32_t threads, ff_tasks **out, ff_error *error)
{
    *out = NULL;
    if (threads < 1 || threads > 256) {
        return ff_fail(error, FF_ERR_ARGUMENT, "%u threads; expected 1 to 256", threads);
    }
    ff_tasks *tasks = ff_calloc(1, sizeof *tasks);
    if (!tasks) return ff_fail(error, FF_ERR_NO_MEMORY, "a pool of threads");
    tasks->threads = ff_calloc(threads, sizeof *tasks->threads);
    pthread_mutex_init(&tasks->lock, NULL);
    pthread_cond_init(&tasks->work, NULL);
    pthread_cond_init(&tasks->done, NULL);
    ff_status status = tasks->threads ? FF_OK : ff_fail(error, FF_ERR_NO_MEMORY, "a pool of threads");
    for (uint32_t i = 1; status == FF_OK && i < threads; ++i) {
        if (pthread_create(&tasks->threads[tasks->thread_count], NULL, worker, tasks) != 0) {
            status = ff_fail(error, FF_ERR_NO_MEMORY, "cannot start thread %u of %u", i + 1, threads);
        } else {
            ++tasks->thread_count;
        }
    }
    if (status != FF_OK) {
        ff_tasks_destroy(tasks);
        return status;
    }
    *out = tasks;
    return FF_OK;
}

void ff_tasks_destroy(ff_tasks *tasks)
{
    if (!tasks) return;
    pthread_mutex_lock(&tasks->lock);
    tasks->stop = 1;
    pthread_cond_broadcast(&tasks->work);
    pthread_mutex_unlock(&tasks->lock);
    for (uint32_t i = 0; i < tasks->thread_count; ++i)
        pthread_join(tasks->threads[i], NULL);
    pthread_cond_destroy(&tasks->done);
    pthread_cond_destroy(&tasks->work);
    pthread_mutex_destroy(&tasks->lock);
    free(tasks->threads);
    free(tasks);
}

void ff_tasks_for(ff_tasks *tasks, uint32_t count, uint32_t grain,
                  void (*function)(void *context, uint32_t index), void *context)
{
    if (grain < 1) grain = 1;
    if (tasks->thread_count == 0 || count <= grain) {
        for (uint32_t i = 0; i < count; ++i)
            function(context, i);
        return;
    }
    pthread_mutex_lock(&tasks->lock);
    tasks->function = function;
    tasks->context = context;
    tasks->count = count;
    tasks->grain = grain;
    atomic_store(&tasks->next, 0);
    tasks->working = tasks->thread_count;
    ++tasks->loop;
    pthread_cond_broadcast(&tasks->work);
    pthread_mutex_unlock(&tasks->lock);
    run_share(tasks);
    pthread_mutex_lock(&tasks->lock);
    while (tasks->working > 0)
        pthread_cond_wait(&tasks->done, &tasks->lock);
    pthread_mutex_unlock(&tasks->lock);
}

uint32_t ff_processor_count(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    int count = CPU_COUNT(&set);
    return count > 0 ? (uint32_t)count : 1;
}
