/* Neighbours by grid and walls by boxes against brute force. */
#include "runtime/core/base/random.h"
#include "runtime/core/nav/nav_grid.h"
#include "runtime/core/nav/nav_walls.h"
#include "tests/check.h"

#define COUNT 700

static ff_seen people[COUNT];

static void scatter(uint64_t seed, double size, uint32_t count)
{
    ff_random random = {seed, 0, 0};
    for (uint32_t i = 0; i < count; ++i) {
        people[i] = (ff_seen){.radius = 0.3, .slot = 3 * i};
        people[i].position =
            ff_v2(ff_random_range(&random, -size, size), ff_random_range(&random, -size, size));
        people[i].velocity = ff_v2(ff_random_range(&random, -1, 1), ff_random_range(&random, -1, 1));
        if (i % 7 == 6) people[i].position = people[i - 1].position; /* some stand on one point */
    }
}

static int compare(const void *left, const void *right)
{
    const ff_neighbour *p = left, *q = right;
    if (p->time != q->time) return p->time < q->time ? -1 : 1;
    if (p->distance != q->distance) return p->distance < q->distance ? -1 : 1;
    return p->index < q->index ? -1 : 1; /* index into people: slots rise with it */
}

static uint32_t brute_force(uint32_t self, uint32_t count, ff_neighbour *out)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; ++i) {
        ff_vec2 x = ff_sub2(people[self].position, people[i].position);
        if (i == self || ff_length2(x) > FF_NEIGHBOUR_REACH) continue;
        ff_vec2 v = ff_sub2(people[self].velocity, people[i].velocity);
        out[found++] = (ff_neighbour){ff_time_to_disc(x, v, 0.64), ff_dot2(x, x), i};
    }
    qsort(out, found, sizeof *out, compare);
    return found < FF_NEIGHBOURS_MAX ? found : FF_NEIGHBOURS_MAX;
}

static void check_against_brute_force(uint32_t count)
{
    ff_error error;
    ff_arena arena;
    ff_grid grid;
    FF_ASSERT_OK(ff_arena_create(&arena, ff_grid_bytes(count), &error), error);
    assert_true(ff_grid_init(&grid, count, &arena));
    for (int twice = 0; twice < 2; ++twice) /* filling again must not depend on what was there */
        ff_grid_fill(&grid, people, count);
    static ff_neighbour want[COUNT];
    ff_neighbour got[FF_NEIGHBOURS_MAX];
    for (uint32_t k = 0; k < count; ++k) {
        uint32_t self = grid.seen[k].slot / 3, n = brute_force(self, count, want);
        assert_int_equal(ff_grid_neighbours(&grid, k, 0.02, got), n);
        for (uint32_t i = 0; i < n; ++i)
            assert_int_equal(grid.seen[got[i].index].slot, people[want[i].index].slot);
    }
    ff_arena_destroy(&arena);
}

static void neighbours_agree_with_brute_force_at_any_density(void **state)
{
    (void)state;
    const double sizes[] = {1.0, 6.0, 14.0, 40.0, 300.0};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        scatter(i, sizes[i], COUNT);
        check_against_brute_force(COUNT);
    }
    scatter(9, 3.0, 5);
    check_against_brute_force(5);
}

static void somebody_far_away_is_no_trouble(void **state)
{
    (void)state;
    scatter(11, 10.0, 50);
    people[3].position = ff_v2(1e6, -1e6);
    people[4].position = ff_v2(1e6, -1e6 + 1.0);
    check_against_brute_force(50);
}

static void walls_near_agree_with_brute_force(void **state)
{
    (void)state;
    ff_error error;
    ff_arena arena;
    ff_walls walls;
    const uint32_t count = 300;
    FF_ASSERT_OK(ff_arena_create(&arena, ff_walls_bytes(count), &error), error);
    assert_true(ff_walls_init(&walls, count, &arena));
    ff_random random = {3, 3, 0};
    const ff_wall *near[FF_NEAR_WALLS_MAX];
    assert_int_equal(ff_walls_near(&walls, ff_v2(0, 0), 100.0, near), 0);
    for (uint32_t i = 0; i < count; ++i) {
        ff_vec2 p = ff_v2(ff_random_range(&random, -20, 20), ff_random_range(&random, -20, 20));
        ff_walls_add(&walls, p, ff_madd2(p, ff_fwd2(ff_random_range(&random, -3, 3)), 1.5));
    }
    for (int round = 0; round < 500; ++round) {
        ff_vec2 p = ff_v2(ff_random_range(&random, -22, 22), ff_random_range(&random, -22, 22));
        double reach = ff_random_range(&random, 0.5, 9.0);
        uint32_t got = ff_walls_near(&walls, p, reach, near), want = 0;
        double farthest = 0.0;
        for (uint32_t i = 0; i < got; ++i) {
            double distance = ff_length2(ff_sub2(p, ff_wall_nearest(near[i], p)));
            assert_true(distance >= farthest - 1e-12 && distance <= reach);
            farthest = distance;
        }
        for (uint32_t i = 0; i < count; ++i) {
            double distance = ff_length2(ff_sub2(p, ff_wall_nearest(&walls.wall[i], p)));
            want += distance <= reach && (got < FF_NEAR_WALLS_MAX || distance <= farthest);
        }
        assert_int_equal(got, want);
    }
    ff_arena_destroy(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(neighbours_agree_with_brute_force_at_any_density),
        cmocka_unit_test(somebody_far_away_is_no_trouble),
        cmocka_unit_test(walls_near_agree_with_brute_force),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
