/* walker_space.h - fixture: a pack of closed-form walkers, opened, with its blend space. */
#ifndef FF_TEST_WALKER_SPACE_H
#define FF_TEST_WALKER_SPACE_H

#include "runtime/core/gait/blend.h"
#include "tests/check.h"
#include "tests/core/walker_pack.h"

typedef struct ff_walker_space {
    void *data;
    ff_pack *pack;
    ff_blend_space *space;
} ff_walker_space;

static inline ff_walker_space ff_walker_space_make(const ff_walker_grid *grid)
{
    ff_walker_space made;
    ff_error error;
    size_t size;
    made.data = ff_walker_image(grid, &size);
    FF_ASSERT_OK(ff_pack_open_memory(made.data, size, &made.pack, &error), error);
    FF_ASSERT_OK(ff_blend_space_create(made.pack, &made.space, &error), error);
    return made;
}

static inline void ff_walker_space_free(ff_walker_space *made)
{
    ff_blend_space_destroy(made->space);
    ff_pack_close(made->pack);
    free(made->data);
}

/* Fixtures of a group: *state is a ff_walker_space. */
static inline int open_walkers(void **state, const ff_walker_grid *grid)
{
    static ff_walker_space walkers;
    walkers = ff_walker_space_make(grid);
    *state = &walkers;
    return 0;
}

static inline int open_full_walkers(void **state)
{
    return open_walkers(state, &ff_walker_grid_full);
}

static inline int close_walkers(void **state)
{
    ff_walker_space_free(*state);
    return 0;
}

#endif
