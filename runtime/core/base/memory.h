/* memory.h - an arena with marks, and growable arrays. */
#ifndef FF_MEMORY_H
#define FF_MEMORY_H

#include "runtime/footfall.h"

#include <stdbool.h>

/* A block that is handed out front to back and given back all at once (or down to a mark). */
typedef struct ff_arena {
    unsigned char *base;
    size_t size, used, peak;
} ff_arena;

ff_status ff_arena_create(ff_arena *arena, size_t size, ff_error *error);
void ff_arena_destroy(ff_arena *arena);
/* count elements of elem_size bytes, zeroed, aligned to align (a power of two); NULL when the arena is full. */
void *ff_arena_push(ff_arena *arena, size_t count, size_t elem_size, size_t align);
static inline size_t ff_arena_mark(const ff_arena *arena)
{
    return arena->used;
}
static inline void ff_arena_release(ff_arena *arena, size_t mark)
{
    arena->used = mark;
}

/* A growable array of elements of one size. Zero it to start; ff_array_free when done. */
typedef struct ff_array {
    void *data;
    size_t count, capacity;
} ff_array;

/* Make room for extra more elements and count them in; returns the first new one (uninitialised), or NULL when
 * memory is short or the size overflows (the array is then unchanged); never NULL for want of elements. */
void *ff_array_grow(ff_array *array, size_t extra, size_t elem_size);
void ff_array_free(ff_array *array);

/* calloc that checks for overflow and accepts 0 elements. */
void *ff_calloc(size_t count, size_t elem_size);

#endif
