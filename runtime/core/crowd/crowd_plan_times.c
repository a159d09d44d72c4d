#define _POSIX_C_SOURCE 199309L
#include "runtime/core/crowd/crowd_plan_times.h"

#include <string.h>
#include <time.h>

#define LEAST 1e-6 /* s */

double ff_thread_seconds(void)
{
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* The exponent and four bits of the fraction: that is the logarithm, by pieces. */
static uint32_t place_of(double seconds)
{
    const double units = seconds / LEAST;
    uint64_t bits;
    if (!(units > 1.0)) return 0;
    memcpy(&bits, &units, sizeof bits);
    uint64_t place = (bits >> 48) - (UINT64_C(1023) << 4);
    return place < FF_PLAN_TIMES ? (uint32_t)place : FF_PLAN_TIMES - 1;
}

void ff_plan_times_add(ff_plan_times *times, double seconds)
{
    ++times->count[place_of(seconds)];
}

/* The middle of a place. */
static double seconds_of(uint32_t place)
{
    uint64_t bits = ((uint64_t)place + (UINT64_C(1023) << 4)) << 48 | UINT64_C(1) << 47;
    double units;
    memcpy(&units, &bits, sizeof units);
    return units * LEAST;
}

double ff_plan_times_share(const ff_plan_times *times, double share)
{
    uint64_t all = 0, sum = 0;
    for (uint32_t i = 0; i < FF_PLAN_TIMES; ++i)
        all += times->count[i];
    for (uint32_t i = 0; i < FF_PLAN_TIMES; ++i) {
        sum += times->count[i];
        if (sum > 0 && (double)sum >= share * (double)all) return seconds_of(i);
    }
    return 0.0;
}
