/* tasks.h - a small pool of threads for data-parallel loops. */
#ifndef FF_TASKS_H
#define FF_TASKS_H

#include "runtime/footfall.h"

typedef struct ff_tasks ff_tasks;

/* threads counts the caller: 1 starts none. */
ff_status ff_tasks_create(uint32_t threads, ff_tasks **out, ff_error *error);
void ff_tasks_destroy(ff_tasks *tasks); /* NULL is fine */

/* Call function(context, i) for every i in [0, count), each once, and return when all are done. Iterations are
 * handed out in runs of grain. Does not allocate. One loop at a time per pool. */
void ff_tasks_for(ff_tasks *tasks, uint32_t count, uint32_t grain,
                  void (*function)(void *context, uint32_t index), void *context);

/* How many processors this process may use. */
uint32_t ff_processor_count(void);

#endif
