/* crowd_plan_times.h - how long plans take, for reports: never part of the state. */
#ifndef FF_CROWD_PLAN_TIMES_H
#define FF_CROWD_PLAN_TIMES_H

#include <stdint.h>

/* 16 for each doubling, from a microsecond to a second. */
enum { FF_PLAN_TIMES = 20 * 16 };

typedef struct ff_plan_times {
    uint32_t count[FF_PLAN_TIMES];
} ff_plan_times;

/* Of the calling thread, s. */
double ff_thread_seconds(void);

void ff_plan_times_add(ff_plan_times *times, double seconds);
/* s: so long the shortest ones took at most that make up a share; to 5 %. 0: there are none. */
double ff_plan_times_share(const ff_plan_times *times, double share);

#endif
