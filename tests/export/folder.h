/* folder.h - a folder for the files of one test program, and whole files read back. */
#ifndef FF_TEST_FOLDER_H
#define FF_TEST_FOLDER_H

#include "runtime/core/base/file.h"
#include "tests/check.h"

#include <stdio.h>
#include <unistd.h>

static char folder_name[] = "/tmp/ff-export-XXXXXX";

static inline int folder_create(void **state)
{
    (void)state;
    return mkdtemp(folder_name) ? 0 : -1;
}

/* Path of a file in the folder, good until the next call. */
static inline const char *folder_path(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder_name, name);
    return path;
}

static inline ff_file folder_read(const char *name)
{
    ff_error error;
    ff_file file;
    FF_ASSERT_OK(ff_file_map(folder_path(name), &file, &error), error);
    return file;
}

/* Removes the files named (NULL-terminated), then the folder, which must be empty: nothing half-written is left. */
static inline int folder_remove(const char *const *names)
{
    for (; *names; ++names)
        unlink(folder_path(*names));
    return rmdir(folder_name);
}

#endif
