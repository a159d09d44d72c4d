/* The pool of threads: every index once, whatever the counts. */
#include "tests/check.h"

#include "runtime/core/base/tasks.h"

#include <stdatomic.h>

enum { MOST = 5000 };

typedef struct tally {
    atomic_uint calls[MOST];
    atomic_uint beyond; /* calls with an index that is out of range */
    uint32_t count;
} tally;

static void count_call(void *context, uint32_t index)
{
    tally *t = context;
    if (index >= t->count) {
        atomic_fetch_add(&t->beyond, 1);
    } else {
        atomic_fetch_add(&t->calls[index], 1);
    }
}

static void every_index_is_called_once_on_one_to_four_threads(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 1, 2, 3, 7, 64, 65, 1000, MOST};
    static const uint32_t grains[] = {0, 1, 3, 64, 10000, UINT32_MAX};
    static tally t;
    ff_error error;
    for (uint32_t threads = 1; threads <= 4; ++threads) {
        ff_tasks *tasks;
        FF_ASSERT_OK(ff_tasks_create(threads, &tasks, &error), error);
        for (size_t c = 0; c < sizeof counts / sizeof counts[0]; ++c) {
            for (size_t g = 0; g < sizeof grains / sizeof grains[0]; ++g) {
                memset(&t, 0, sizeof t);
                t.count = counts[c];
                ff_tasks_for(tasks, counts[c], grains[g], count_call, &t);
                assert_int_equal(atomic_load(&t.beyond), 0);
                for (uint32_t i = 0; i < counts[c]; ++i)
                    assert_int_equal(atomic_load(&t.calls[i]), 1);
            }
        }
        ff_tasks_destroy(tasks);
    }
}

static void many_short_loops_follow_each_other_without_loss(void **state)
{
    (void)state;
    static tally t;
    ff_error error;
    ff_tasks *tasks;
    FF_ASSERT_OK(ff_tasks_create(3, &tasks, &error), error);
    memset(&t, 0, sizeof t);
    t.count = 5;
    for (int loop = 0; loop < 3000; ++loop)
        ff_tasks_for(tasks, 5, 1, count_call, &t);
    for (uint32_t i = 0; i < 5; ++i)
        assert_int_equal(atomic_load(&t.calls[i]), 3000);
    ff_tasks_destroy(tasks);
}

/* A pool inside a pool: each outer index runs an inner loop of its own size on its own pool. */
static void inner_loop(void *context, uint32_t index)
{
    atomic_uint *sum = context;
    tally *inner = calloc(1, sizeof *inner);
    ff_tasks *tasks = NULL;
    if (inner && ff_tasks_create(2, &tasks, NULL) == FF_OK) {
        inner->count = index * 3;
        ff_tasks_for(tasks, inner->count, 2, count_call, inner);
        for (uint32_t i = 0; i < inner->count; ++i)
            atomic_fetch_add(sum, atomic_load(&inner->calls[i]));
    }
    ff_tasks_destroy(tasks);
    free(inner);
}

static void loops_of_different_pools_may_be_nested(void **state)
{
    (void)state;
    ff_error error;
    ff_tasks *tasks;
    atomic_uint sum = 0;
    FF_ASSERT_OK(ff_tasks_create(4, &tasks, &error), error);
    ff_tasks_for(tasks, 20, 1, inner_loop, &sum);
    assert_int_equal(atomic_load(&sum), 3 * 19 * 20 / 2);
    ff_tasks_destroy(tasks);
}

static void absurd_numbers_of_threads_are_refused(void **state)
{
    (void)state;
    ff_error error;
    ff_tasks *tasks;
    assert_int_equal(ff_tasks_create(0, &tasks, &error), FF_ERR_ARGUMENT);
    assert_null(tasks);
    assert_int_equal(ff_tasks_create(257, &tasks, &error), FF_ERR_ARGUMENT);
    assert_null(tasks);
    ff_tasks_destroy(NULL);
    assert_in_range(ff_processor_count(), 1, 100000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_index_is_called_once_on_one_to_four_threads),
        cmocka_unit_test(many_short_loops_follow_each_other_without_loss),
        cmocka_unit_test(loops_of_different_pools_may_be_nested),
        cmocka_unit_test(absurd_numbers_of_threads_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
