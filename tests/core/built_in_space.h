/* built_in_space.h - the pack of the built-in clips with its blend space, for every test of a group. Needs _GNU_SOURCE. */
#ifndef FF_TEST_BUILT_IN_SPACE_H
#define FF_TEST_BUILT_IN_SPACE_H

#include "runtime/core/gait/blend.h"
#include "tests/built_in_open.h"

static ff_blend_space *space;

static inline int open_space(void **state)
{
    ff_error error;
    open_pack(state);
    FF_ASSERT_OK(ff_blend_space_create(pack, &space, &error), error);
    return 0;
}

static inline int close_space(void **state)
{
    ff_blend_space_destroy(space);
    return close_pack(state);
}

#endif
