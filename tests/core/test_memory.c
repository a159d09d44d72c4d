/* Arena and growable arrays, above all at the sizes that do not fit. */
#include "tests/check.h"

#include "runtime/core/base/memory.h"

static void an_arena_hands_out_zeroed_aligned_pieces_until_it_is_full(void **state)
{
    (void)state;
    ff_arena arena;
    ff_error error;
    FF_ASSERT_OK(ff_arena_create(&arena, 1000, &error), error);
    assert_int_equal(arena.size, 1024); /* whole cache lines */
    memset(arena.base, 0xff, arena.size);
    unsigned char *byte = ff_arena_push(&arena, 1, 1, 1);
    double *numbers = ff_arena_push(&arena, 3, sizeof *numbers, 64);
    assert_non_null(byte);
    assert_int_equal(*byte, 0);
    assert_int_equal((uintptr_t)numbers % 64, 0);
    FF_ASSERT_NEAR(numbers[2], 0.0, 0.0);
    assert_null(ff_arena_push(&arena, 1024, 1, 1));
    assert_int_equal(arena.used, 64 + 24); /* a refused piece takes nothing */
    assert_non_null(ff_arena_push(&arena, 1024 - 88, 1, 1));
    assert_null(ff_arena_push(&arena, 1, 1, 1));
    assert_non_null(ff_arena_push(&arena, 0, 1, 1));
    ff_arena_destroy(&arena);
}

static void releasing_to_a_mark_gives_the_same_place_again_and_the_peak_stays(void **state)
{
    (void)state;
    ff_arena arena;
    ff_error error;
    FF_ASSERT_OK(ff_arena_create(&arena, 256, &error), error);
    ff_arena_push(&arena, 64, 1, 64);
    size_t mark = ff_arena_mark(&arena);
    void *first = ff_arena_push(&arena, 128, 1, 64);
    ff_arena_release(&arena, mark);
    assert_ptr_equal(ff_arena_push(&arena, 16, 1, 64), first);
    assert_int_equal(arena.peak, 192);
    ff_arena_destroy(&arena);
}

static void sizes_that_overflow_are_refused(void **state)
{
    (void)state;
    ff_arena arena;
    ff_error error;
    assert_int_equal(ff_arena_create(&arena, SIZE_MAX, &error), FF_ERR_NO_MEMORY);
    assert_null(arena.base);
    ff_arena_destroy(&arena);
    FF_ASSERT_OK(ff_arena_create(&arena, 0, &error), error);
    assert_null(ff_arena_push(&arena, SIZE_MAX / 8 + 2, 8, 8)); /* times 8 wraps to 8 */
    assert_null(ff_arena_push(&arena, SIZE_MAX, 1, 1));
    ff_arena_destroy(&arena);

    ff_array array = {0};
    int *one = ff_array_grow(&array, 1, sizeof *one);
    assert_non_null(one);
    *one = 7;
    assert_null(ff_array_grow(&array, SIZE_MAX, sizeof *one));
    assert_null(ff_array_grow(&array, SIZE_MAX / sizeof *one, sizeof *one));
    assert_int_equal(array.count, 1);
    assert_int_equal(*(int *)array.data, 7);
    ff_array_free(&array);
    assert_null(array.data);
}

static void an_array_keeps_its_elements_while_it_grows(void **state)
{
    (void)state;
    ff_array array = {0};
    for (int i = 0; i < 10000; ++i) {
        int *next = ff_array_grow(&array, 1, sizeof *next);
        assert_non_null(next);
        *next = i;
    }
    const int *all = array.data;
    for (int i = 0; i < 10000; ++i)
        assert_int_equal(all[i], i);
    assert_in_range(array.capacity, 10000, 20000); /* doubling, not one at a time */
    ff_array_free(&array);
}

static void an_array_grows_by_nothing_too(void **state)
{
    (void)state;
    ff_array array = {0};
    assert_non_null(ff_array_grow(&array, 0, 16));
    assert_int_equal(array.count, 0);
    assert_ptr_equal(ff_array_grow(&array, 1, 16), array.data);
    ff_array_free(&array);
}

static void calloc_accepts_nothing_and_refuses_too_much(void **state)
{
    (void)state;
    void *nothing = ff_calloc(0, 16);
    assert_non_null(nothing);
    free(nothing);
    volatile size_t half = SIZE_MAX / 2; /* volatile: the compiler would warn of what is tested here */
    assert_null(ff_calloc(half, 4));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_arena_hands_out_zeroed_aligned_pieces_until_it_is_full),
        cmocka_unit_test(releasing_to_a_mark_gives_the_same_place_again_and_the_peak_stays),
        cmocka_unit_test(sizes_that_overflow_are_refused),
        cmocka_unit_test(an_array_keeps_its_elements_while_it_grows),
        cmocka_unit_test(an_array_grows_by_nothing_too),
        cmocka_unit_test(calloc_accepts_nothing_and_refuses_too_much),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
