#include "runtime/core/base/memory.h"

#include "runtime/core/base/fail.h"

#include <stdlib.h>
#include <string.h>

ff_status ff_arena_create(ff_arena *arena, size_t size, ff_error *error)
{
    memset(arena, 0, sizeof *arena);
    size_t rounded = (size + 63u) & ~(size_t)63u;
    if (rounded < size) return ff_fail(error, FF_ERR_NO_MEMORY, "an arena of %zu bytes", size);
    arena->base = aligned_alloc(64, rounded ? rounded : 64);
    if (!arena->base) return ff_fail(error, FF_ERR_NO_MEMORY, "an arena of %zu bytes", size);
    arena->size = rounded ? rounded : 64;
    return FF_OK;
}

void ff_arena_destroy(ff_arena *arena)
{
    free(arena->base);
    memset(arena, 0, sizeof *arena);
}

void *ff_arena_push(ff_arena *arena, size_t count, size_t elem_size, size_t align)
{
    size_t start = (arena->used + align - 1) & ~(align - 1);
    if (start > arena->size || (elem_size && count > (arena->size - start) / elem_size)) return NULL;
    arena->used = start + count * elem_size;
    if (arena->used > arena->peak) arena->peak = arena->used;
    memset(arena->base + start, 0, count * elem_size);
    return arena->base + start;
}

void *ff_array_grow(ff_array *array, size_t extra, size_t elem_size)
{
    if (extra > SIZE_MAX / elem_size - array->count) return NULL;
    size_t need = array->count + extra;
    if (need > array->capacity || !array->data) { /* none of no elements is still an answer, not a lack */
        size_t capacity = array->capacity < SIZE_MAX / 2 / elem_size ? array->capacity * 2 : need;
        if (capacity < need) capacity = need;
        if (capacity < 16 && 16 <= SIZE_MAX / elem_size) capacity = 16;
        void *data = realloc(array->data, capacity * elem_size);
        if (!data) return NULL;
        array->data = data;
        array->capacity = capacity;
    }
    void *first = (char *)array->data + array->count * elem_size;
    array->count = need;
    return first;
}

void ff_array_free(ff_array *array)
{
    free(array->data);
    memset(array, 0, sizeof *array);
}

void *ff_calloc(size_t count, size_t elem_size)
{
    if (elem_size && count > SIZE_MAX / elem_size)
        return NULL; /* sanitizers stop the program in calloc itself */
    return calloc(count ? count : 1, elem_size ? elem_size : 1);
}
