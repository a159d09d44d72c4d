/* cache.h - results of single clips kept in a folder from one build to the next.
 *
 * An entry is a file named by its key, a hash of everything the result depends on, and holds a checksum. One that is
 * damaged, cut short or of other code is as good as none. Nothing here can fail a build: what cannot be read is made
 * anew, what cannot be written is not kept. Safe from several threads and for several builds in one folder. */
#ifndef FF_CACHE_H
#define FF_CACHE_H

#include "runtime/core/base/memory.h"

#include <stdatomic.h>
#include <stdbool.h>

typedef struct ff_cache {
    char *folder; /* NULL = nothing is kept */
    atomic_int found, missed, unwritten;
} ff_cache;

/* folder NULL: a cache that keeps nothing. A folder that is not there is made, but not those above it;
 * one that cannot be made gives the same as NULL. */
void ff_cache_open(ff_cache *cache, const char *folder);
void ff_cache_close(ff_cache *cache);

/* The entry of a key: kind is a short word, part of the file's name. True: *data (free() it) and *size are what was
 * stored. */
bool ff_cache_load(ff_cache *cache, const char *kind, uint64_t key, void **data, size_t *size);
void ff_cache_store(ff_cache *cache, const char *kind, uint64_t key, const void *data, size_t size);

/* Remove entries, and what killed builds left of entries, that are not in keys (sorted). Other files stay. */
void ff_cache_prune(const ff_cache *cache, const uint64_t *keys, size_t count);

#endif
