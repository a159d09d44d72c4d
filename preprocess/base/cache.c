#define _POSIX_C_SOURCE 200809L
#include "preprocess/base/cache.h"

#include "runtime/core/base/file.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <xxhash.h>

#define MAGIC 0x31484341434646u /* "FFCACH1" read as a little-endian u64 */

/* Before the data of an entry. */
typedef struct entry_head {
    uint64_t magic, key, size, checksum;
} entry_head;

enum { NAME_SIZE = 64 };

void ff_cache_open(ff_cache *cache, const char *folder)
{
    memset(cache, 0, sizeof *cache);
    if (!folder) return;
    if (mkdir(folder, 0777) == 0 || errno == EEXIST) cache->folder = strdup(folder);
    if (!cache->folder) atomic_store(&cache->unwritten, 1);
}

void ff_cache_close(ff_cache *cache)
{
    free(cache->folder);
    cache->folder = NULL;
}

/* Path of an entry; free() it. NULL without a folder or memory. */
static char *path_of(const ff_cache *cache, const char *kind, uint64_t key)
{
    if (!cache->folder) return NULL;
    size_t size = strlen(cache->folder) + NAME_SIZE;
    char *path = malloc(size);
    if (path) snprintf(path, size, "%s/%016" PRIx64 ".%.16s", cache->folder, key, kind);
    return path;
}

static bool read_entry(const ff_file *file, uint64_t key, void **data, size_t *size)
{
    entry_head head;
    if (file->size < sizeof head) return false;
    memcpy(&head, file->data, sizeof head);
    const char *rest = file->data + sizeof head;
    if (head.magic != MAGIC || head.key != key || head.size != file->size - sizeof head) return false;
    if (XXH64(rest, head.size, key) != head.checksum) return false;
    *data = malloc(head.size ? head.size : 1);
    if (!*data) return false;
    memcpy(*data, rest, head.size);
    *size = head.size;
    return true;
}

bool ff_cache_load(ff_cache *cache, const char *kind, uint64_t key, void **data, size_t *size)
{
    bool whole = false;
    ff_file file;
    char *path = path_of(cache, kind, key);
    if (path && ff_file_map(path, &file, NULL) == FF_OK) {
        whole = read_entry(&file, key, data, size);
        ff_file_unmap(&file);
    }
    free(path);
    atomic_fetch_add(whole ? &cache->found : &cache->missed, 1);
    return whole;
}

void ff_cache_store(ff_cache *cache, const char *kind, uint64_t key, const void *data, size_t size)
{
    char *path = path_of(cache, kind, key);
    if (!path) return;
    entry_head head = {MAGIC, key, size, XXH64(data, size, key)};
    char *entry = malloc(sizeof head + size);
    bool written = false;
    if (entry) {
        memcpy(entry, &head, sizeof head);
        memcpy(entry + sizeof head, data, size);
        written = ff_file_write_unsynced(path, entry, sizeof head + size, NULL) == FF_OK;
    }
    if (!written) atomic_fetch_add(&cache->unwritten, 1);
    free(entry);
    free(path);
}

static int by_value(const void *left, const void *right)
{
    const uint64_t *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

/* Does the name begin as those of entries do, with 16 hexadecimal digits and a dot? */
static bool key_of_name(const char *name, uint64_t *key)
{
    if (strspn(name, "0123456789abcdef") != 16 || name[16] != '.') return false;
    *key = strtoull(name, NULL, 16);
    return true;
}

void ff_cache_prune(const ff_cache *cache, const uint64_t *keys, size_t count)
{
    DIR *directory = cache->folder ? opendir(cache->folder) : NULL;
    if (!directory) return;
    for (const struct dirent *file; (file = readdir(directory)) != NULL;) {
        uint64_t key;
        if (!key_of_name(file->d_name, &key)) continue;
        /* A second dot: a temporary file of a build that was killed, or of one that runs now and then does without. */
        bool temporary = strchr(file->d_name + 17, '.') != NULL;
        if (!temporary && bsearch(&key, keys, count, sizeof *keys, by_value)) continue;
        size_t size = strlen(cache->folder) + strlen(file->d_name) + 2;
        char *path = malloc(size);
        if (!path) continue;
        snprintf(path, size, "%s/%s", cache->folder, file->d_name);
        unlink(path);
        free(path);
    }
    closedir(directory);
}
