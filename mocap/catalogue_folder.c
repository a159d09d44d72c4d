/* Every clip below a folder. */
#define _POSIX_C_SOURCE 200809L
#include "mocap/catalogue_build.h"
#include "runtime/core/base/fail.h"

#include <dirent.h>
#include <errno.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* Deeper folders are not looked into: a link that leads back up would never end. */
enum { DEEPEST = 12 };

typedef struct pending {
    char *path;
    int depth;
} pending;

static ff_status fail_folder(const char *path, ff_error *error)
{
    int number = errno;
    ff_fail(error, FF_ERR_IO, "cannot read this folder: %s", strerror(number));
    ff_error_in_file(error, path);
    return FF_ERR_IO;
}

/* Sort what one folder holds into clips and folders still to be read. */
static ff_status add_files(ff_catalogue_builder *builder, pending here, ff_array *folders, ff_error *error)
{
    DIR *directory = opendir(here.path);
    if (!directory) return fail_folder(here.path, error);
    bool enough_memory = true;
    ff_status status = FF_OK;
    for (const struct dirent *file;
         enough_memory && status == FF_OK && (file = readdir(directory)) != NULL;) {
        struct stat info;
        if (file->d_name[0] == '.') continue;
        char *path = ff_catalogue_keep_path(builder, here.path, file->d_name);
        if (!path) {
            enough_memory = false;
        } else if (stat(path, &info) == 0 && S_ISDIR(info.st_mode)) {
            pending *more = here.depth < DEEPEST ? ff_array_grow(folders, 1, sizeof *more) : NULL;
            if (more) *more = (pending){path, here.depth + 1};
            enough_memory = more || here.depth >= DEEPEST;
        } else if (ff_is_clip_path(path)) {
            ff_catalogue_entry entry = ff_catalogue_default();
            entry.path = path;
            status = ff_catalogue_add_clips(builder, entry, error);
        }
    }
    closedir(directory);
    return enough_memory ? status
                         : ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the files of %s", here.path);
}

/* Is the same clip in the list as AMC? (names equal but for the ending) */
static bool has_amc(const ff_catalogue_entry *entries, size_t count, const char *bvh)
{
    size_t stem = strlen(bvh) - 3;
    for (size_t i = 0; i < count; ++i)
        if (strlen(entries[i].path) == stem + 3 && strncmp(entries[i].path, bvh, stem) == 0 &&
            strcasecmp(entries[i].path + stem, "amc") == 0)
            return true;
    return false;
}

static void drop_bvh_twins(ff_catalogue_builder *builder, size_t first)
{
    ff_catalogue_entry *entries = (ff_catalogue_entry *)builder->entries.data + first;
    size_t count = builder->entries.count - first, kept = 0;
    for (size_t i = 0; i < count; ++i) {
        const char *path = entries[i].path;
        bool twin = strcasecmp(path + strlen(path) - 3, "bvh") == 0 && has_amc(entries, count, path);
        entries[i].tags = twin ? NULL : entries[i].tags;
    }
    for (size_t i = 0; i < count; ++i)
        if (entries[i].tags) entries[kept++] = entries[i];
    builder->entries.count = first + kept;
}

ff_status ff_catalogue_add_folder(ff_catalogue_builder *builder, const char *path, ff_error *error)
{
    size_t first = builder->entries.count;
    ff_array folders = {0};
    pending *start = ff_array_grow(&folders, 1, sizeof *start);
    char *copy = ff_catalogue_keep_text(builder, path);
    if (!start || !copy) {
        ff_array_free(&folders);
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the files of %s", path);
    }
    *start = (pending){copy, 0};
    ff_status status = FF_OK;
    while (folders.count > 0 && status == FF_OK) {
        pending next = ((pending *)folders.data)[--folders.count];
        status = add_files(builder, next, &folders, error);
    }
    ff_array_free(&folders);
    if (status == FF_OK && builder->entries.count > first) drop_bvh_twins(builder, first);
    return status;
}
