/* built_in_pack.h - the pack of the built-in clips that make builds before any test. Needs _GNU_SOURCE (readlink). */
#ifndef FF_TEST_BUILT_IN_PACK_H
#define FF_TEST_BUILT_IN_PACK_H

#include "tests/check.h"

#include <unistd.h>

/* Its path: three names above the program's own (build/tests/ROOM/PROGRAM). */
static inline const char *ff_built_in_pack_path(void)
{
    static const char name[] = "/builtin.ffpack";
    static char path[4096];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - sizeof name);
    assert_true(length > 0 && (size_t)length < sizeof path - sizeof name);
    path[length] = 0;
    for (int i = 0; i < 3; ++i) {
        char *slash = strrchr(path, '/');
        assert_non_null(slash);
        *slash = 0;
    }
    return strcat(path, name);
}

#endif
