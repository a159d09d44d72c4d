#define _GNU_SOURCE
#include "runtime/core/base/file.h"

#include "runtime/core/base/fail.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static ff_status fail_system(ff_error *error, const char *path, const char *doing)
{
    int number = errno;
    ff_fail(error, FF_ERR_IO, "cannot %s: %s", doing, strerror(number));
    ff_error_in_file(error, path);
    return FF_ERR_IO;
}

ff_status ff_file_map(const char *path, ff_file *out, ff_error *error)
{
    *out = (ff_file){"", 0, 0};
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* a pipe without a writer must not hang us */
    if (fd < 0) return fail_system(error, path, "open this file");
    struct stat info;
    ff_status status = FF_OK;
    if (fstat(fd, &info) != 0) {
        status = fail_system(error, path, "read this file's size");
    } else if (!S_ISREG(info.st_mode)) {
        status = ff_fail(error, FF_ERR_IO, "not a regular file");
        ff_error_in_file(error, path);
    } else if (info.st_size > 0) {
        void *data = mmap(NULL, (size_t)info.st_size, PROT_READ, MAP_PRIVATE, fd, 0);
        if (data == MAP_FAILED) {
            status = fail_system(error, path, "map this file");
        } else {
            *out = (ff_file){data, (size_t)info.st_size, 1};
        }
    }
    close(fd);
    return status;
}

void ff_file_unmap(ff_file *file)
{
    if (file->mapped) munmap((void *)(uintptr_t)file->data, file->size);
    *file = (ff_file){"", 0, 0};
}

static int write_all(int fd, const char *data, size_t size)
{
    while (size > 0) {
        ssize_t written = write(fd, data, size < INT_MAX ? size : INT_MAX);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return -1;
        data += written;
        size -= (size_t)written;
    }
    return 0;
}

static ff_status write_by_rename(const char *path, const void *data, size_t size, bool sync, ff_error *error)
{
    size_t length = strlen(path) + 32;
    char *temporary = malloc(length);
    if (!temporary) return ff_fail(error, FF_ERR_NO_MEMORY, "writing %s", path);
    snprintf(temporary, length, "%s.XXXXXX", path);
    int fd = mkostemp(temporary, O_CLOEXEC);
    ff_status status = FF_OK;
    if (fd < 0) {
        status = fail_system(error, path, "create this file");
    } else {
        mode_t mask = umask(0);
        umask(mask);
        if (write_all(fd, data, size) != 0 || fchmod(fd, 0666 & ~mask) != 0 || (sync && fsync(fd) != 0)) {
            status = fail_system(error, path, "write this file");
        }
        if (close(fd) != 0 && status == FF_OK) status = fail_system(error, path, "write this file");
        if (status == FF_OK && rename(temporary, path) != 0)
            status = fail_system(error, path, "create this file");
        if (status != FF_OK) unlink(temporary);
    }
    free(temporary);
    return status;
}

ff_status ff_file_write_atomic(const char *path, const void *data, size_t size, ff_error *error)
{
    return write_by_rename(path, data, size, true, error);
}

ff_status ff_file_write_unsynced(const char *path, const void *data, size_t size, ff_error *error)
{
    return write_by_rename(path, data, size, false, error);
}

ff_status ff_folder_create(const char *path, ff_error *error)
{
    char part[PATH_MAX];
    if (!*path || strlen(path) >= sizeof part) {
        return ff_fail(error, FF_ERR_ARGUMENT, "not a usable folder name: '%.80s'", path);
    }
    snprintf(part, sizeof part, "%s", path);
    for (char *at = part + 1;; ++at) {
        if (*at != '/' && *at != '\0') continue;
        char kept = *at;
        *at = '\0';
        if (mkdir(part, 0777) != 0 && errno != EEXIST) return fail_system(error, part, "create this folder");
        *at = kept;
        if (!kept) break;
    }
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISDIR(info.st_mode)) {
        ff_fail(error, FF_ERR_IO, "exists and is not a folder");
        ff_error_in_file(error, path);
        return FF_ERR_IO;
    }
    return FF_OK;
}
