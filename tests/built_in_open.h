/* built_in_open.h - the pack of the built-in clips, open for every test of a group:
 * cmocka_run_group_tests(tests, open_pack, close_pack). Needs _GNU_SOURCE. */
#ifndef FF_TEST_BUILT_IN_OPEN_H
#define FF_TEST_BUILT_IN_OPEN_H

#include "tests/built_in_pack.h"

static ff_pack *pack;

static inline int open_pack(void **state)
{
    (void)state;
    ff_error error;
    FF_ASSERT_OK(ff_pack_open(ff_built_in_pack_path(), &pack, &error), error);
    return 0;
}

static inline int close_pack(void **state)
{
    (void)state;
    ff_pack_close(pack);
    return 0;
}

#endif
