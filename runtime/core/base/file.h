/* file.h - whole files in, whole files out. */
#ifndef FF_FILE_H
#define FF_FILE_H

#include "runtime/footfall.h"

/* A file's bytes, mapped read-only. data is page-aligned; size may be 0 (data is then a valid empty string). */
typedef struct ff_file {
    const char *data;
    size_t size;
    int mapped;
} ff_file;

ff_status ff_file_map(const char *path, ff_file *out, ff_error *error);
void ff_file_unmap(ff_file *file);

/* Write all or nothing: a temporary file beside path, fsync, rename. On failure path is as it was before and the
 * temporary file is gone. */
ff_status ff_file_write_atomic(const char *path, const void *data, size_t size, ff_error *error);

/* The same without waiting until the disk has it: for what may be lost in a power cut, or be damaged by one. */
ff_status ff_file_write_unsynced(const char *path, const void *data, size_t size, ff_error *error);

/* Create a folder and its parents; an existing folder is fine. */
ff_status ff_folder_create(const char *path, ff_error *error);

#endif
