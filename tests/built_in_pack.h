/* built_in_pack.h - the packs that make builds before any test. Needs _GNU_SOURCE (readlink). */
#ifndef FF_TEST_BUILT_IN_PACK_H
#define FF_TEST_BUILT_IN_PACK_H

#include "tests/check.h"

#include <unistd.h>

/* Beside them, three names above the program's own (build/tests/ROOM/PROGRAM). */
static inline const char *ff_made_pack_path(char *path, size_t size, const char *name)
{
    ssize_t length = readlink("/proc/self/exe", path, size - strlen(name) - 1);
    assert_true(length > 0 && (size_t)length < size - strlen(name) - 1);
    path[length] = 0;
    for (int i = 0; i < 3; ++i) {
        char *slash = strrchr(path, '/');
        assert_non_null(slash);
        *slash = 0;
    }
    return strcat(path, name);
}

/* The pack of the built-in clips. */
static inline const char *ff_built_in_pack_path(void)
{
    static char path[4096];
    return ff_made_pack_path(path, sizeof path, "/builtin.ffpack");
}

/* The pack of a few captured clips, or NULL where the outside data is not there (the test must then say that it skipped). */
static inline const char *ff_captured_pack_path(void)
{
    static char path[4096];
    if (!ff_shared_folder()) return NULL;
    return ff_made_pack_path(path, sizeof path, "/captured.ffpack");
}

#endif
