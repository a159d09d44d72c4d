/* crowd_arrays.h - the one list of a crowd's arrays. Memory, state hash, saving and loading all walk it: an array that has
 * a row here (and a pointer in crowd_state.h) is allocated, hashed, saved and loaded. */
#ifndef FF_CROWD_ARRAYS_H
#define FF_CROWD_ARRAYS_H

#include "runtime/core/base/memory.h"

typedef enum ff_array_kind {
    FF_ARRAY_SLOT,  /* state of every slot ever used, alive or not */
    FF_ARRAY_AGENT, /* state of the agents that live; plain data without padding, for it is hashed as bytes */
    FF_ARRAY_STEP,  /* made anew in every step: no state */
} ff_array_kind;

/* One array of max_agents elements, zeroed at creation, on a 64-byte boundary. */
typedef struct ff_crowd_array {
    char name[8]; /* of its section in a saved crowd; four letters, unique */
    ff_array_kind kind;
    size_t pointer;                          /* offsetof(ff_crowd, ...) of the pointer to the array */
    size_t size;                             /* bytes per element */
    bool (*wanted)(const ff_crowd_def *def); /* NULL: always. Where false the pointer stays NULL */
    /* Of an agent's state: NULL, or what is wrong with an element that was read and at which of its bytes
     * (crowd_check.h). */
    const char *(*check)(const ff_crowd *crowd, const void *element, size_t *byte);
} ff_crowd_array;

uint32_t ff_crowd_array_count(void);
const ff_crowd_array *ff_crowd_array_at(uint32_t index);

/* The element of a slot; NULL where the crowd does without the array. */
void *ff_crowd_array_element(const ff_crowd *crowd, const ff_crowd_array *array, uint32_t slot);

/* Bytes of the arena that all arrays take. */
size_t ff_crowd_arrays_bytes(const ff_crowd_def *def);
/* Take them from the arena. False when it is too small. */
bool ff_crowd_arrays_init(ff_crowd *crowd, ff_arena *arena);

#endif
