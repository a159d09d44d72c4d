/* walker_open.h - the pack of walkers opened once for all tests of a program: cmocka_run_group_tests(tests,
 * ff_walker_open, ff_walker_close) with walker.grid set before, or left alone for the full grid. */
#ifndef FF_TEST_WALKER_OPEN_H
#define FF_TEST_WALKER_OPEN_H

#include "tests/check.h"
#include "tests/core/walker_pack.h"

static struct {
    const ff_walker_grid *grid;
    void *image;
    ff_pack *pack;
} walker = {&ff_walker_grid_full, NULL, NULL};

static int ff_walker_open(void **state)
{
    (void)state;
    size_t size;
    ff_error error;
    walker.image = ff_walker_image(walker.grid, &size);
    FF_ASSERT_OK(ff_pack_open_memory(walker.image, size, &walker.pack, &error), error);
    return 0;
}

static int ff_walker_close(void **state)
{
    (void)state;
    ff_pack_close(walker.pack);
    free(walker.image);
    return 0;
}

#endif
