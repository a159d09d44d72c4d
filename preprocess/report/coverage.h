/* coverage.h - what a pack's actions can and cannot do, in words. */
#ifndef FF_COVERAGE_H
#define FF_COVERAGE_H

#include "runtime/core/pack/pack.h"

/* The kinds of actions that a planner likes to have. */
int ff_coverage_kinds(void);
/* "side step to the right longer than 0.3 m" */
const char *ff_coverage_words(int kind);
/* How many of the pack's actions, mirror images among them, are of this kind. */
uint32_t ff_coverage_count(const ff_pack *pack, int kind);

/* How many actions may follow one, over all of them. */
typedef struct ff_branching {
    double median;
    uint32_t least, most;
    /* actions whose nearest successor is further than poses should be: taken for want of a better one */
    uint32_t forced;
} ff_branching;
ff_branching ff_coverage_branching(const ff_pack *pack);

#endif
