/* random.h - counter-based random numbers: the n-th number of a stream is a pure function of (seed, stream, n),
 * so results depend neither on the order of calls nor on the thread. Three rounds of the splitmix64 finaliser
 * (Steele, Lea and Flood 2014) over the mixed key. */
#ifndef FF_RANDOM_H
#define FF_RANDOM_H

#include "runtime/core/base/maths.h"

typedef struct ff_random {
    uint64_t seed, stream, counter;
} ff_random;

static inline uint64_t ff_mix64(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}
static inline uint64_t ff_random_at(uint64_t seed, uint64_t stream, uint64_t counter)
{
    uint64_t z = ff_mix64(seed + 0x9e3779b97f4a7c15u);
    z = ff_mix64(z ^ (stream + 0xd1342543de82ef95u));
    return ff_mix64(z + (counter + 1u) * 0x9e3779b97f4a7c15u);
}
static inline uint64_t ff_random_next(ff_random *random)
{
    return ff_random_at(random->seed, random->stream, random->counter++);
}
/* Uniform in [0, 1). */
static inline double ff_random_unit(ff_random *random)
{
    return (double)(ff_random_next(random) >> 11) * (1.0 / 9007199254740992.0);
}
static inline double ff_random_range(ff_random *random, double low, double high)
{
    return low + (high - low) * ff_random_unit(random);
}
/* Near-normal, mean 0, deviation 1: the sum of 12 uniforms less 6 (no log, so the bits are the same everywhere;
 * never beyond 6 deviations). */
static inline double ff_random_normal(ff_random *random)
{
    double sum = -6.0;
    for (int i = 0; i < 12; ++i)
        sum += ff_random_unit(random);
    return sum;
}

#endif
