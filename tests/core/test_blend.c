/* Blending in the space of rates: exact, smooth, and nearest where it cannot be exact. */
#include "runtime/core/base/random.h"
#include "tests/core/walker_space.h"

static ff_rates random_rates(ff_random *random, double beyond)
{
    return (ff_rates){ff_random_range(random, -0.8 * beyond, 1.8 * beyond),
                      ff_random_range(random, -0.5 * beyond, 0.5 * beyond),
                      ff_random_range(random, -1.4 * beyond, 1.4 * beyond)};
}

/* What the root of a blended cycle does, from first principles: every example moves by its rates for its period, and
 * the blended cycle moves by the mean of that in the mean of their times. */
static ff_rates rates_of_cycle(const ff_blend_space *space, const ff_blend *blend)
{
    double time = 0.0;
    ff_rates moved = {0.0, 0.0, 0.0};
    for (int i = 0; i < FF_BLEND_MAX; ++i) {
        if (blend->vertex[i] < 0) continue;
        const ff_blend_vertex *vertex = &space->vertices[blend->vertex[i]];
        double share = blend->weight[i] * vertex->period;
        time += share;
        moved.forward += share * vertex->rates.forward;
        moved.left += share * vertex->rates.left;
        moved.turn += share * vertex->rates.turn;
    }
    FF_ASSERT_NEAR(time, blend->period, 1e-12);
    return (ff_rates){moved.forward / time, moved.left / time, moved.turn / time};
}

static void blended_rates_are_exact_in_speed_and_turn(void **state)
{
    const ff_walker_space *walker = *state;
    ff_random random = {1, 2, 0};
    for (int i = 0; i < 5000; ++i) {
        ff_rates target = random_rates(&random, 1.0);
        ff_blend blend;
        ff_blend_find(walker->space, target, &blend);
        double sum = 0.0;
        for (int k = 0; k < FF_BLEND_MAX; ++k) {
            assert_true(blend.weight[k] >= 0.0);
            sum += blend.weight[k];
        }
        FF_ASSERT_NEAR(sum, 1.0, 1e-12);
        ff_rates got = rates_of_cycle(walker->space, &blend);
        FF_ASSERT_NEAR(got.forward, target.forward, 1e-9);
        FF_ASSERT_NEAR(got.left, target.left, 1e-9);
        FF_ASSERT_NEAR(got.turn, target.turn, 1e-9);
    }
}

static void targets_inside_are_kept_and_others_go_to_the_nearest_point(void **state)
{
    const ff_walker_space *walker = *state;
    ff_random random = {3, 4, 0};
    for (int i = 0; i < 5000; ++i) {
        ff_rates target = random_rates(&random, 2.0), got = ff_blend_clamp(walker->space, target);
        /* The examples fill a box, whose nearest point is known axis by axis. */
        FF_ASSERT_NEAR(got.forward, ff_clamp(target.forward, -0.8, 1.8), 1e-6);
        FF_ASSERT_NEAR(got.left, ff_clamp(target.left, -0.5, 0.5), 1e-6);
        FF_ASSERT_NEAR(got.turn, ff_clamp(target.turn, -1.4, 1.4), 1e-6);
    }
    ff_rates still = ff_blend_clamp(walker->space, (ff_rates){0.0, 0.0, 0.0});
    assert_true(still.forward == 0.0 && still.left == 0.0 && still.turn == 0.0);
}

static void weights_change_as_smoothly_as_rates_do(void **state)
{
    const ff_walker_space *walker = *state;
    ff_random random = {5, 6, 0};
    double before[64] = {0}, worst = 0.0;
    ff_rates rates = {0.3, 0.1, 0.2}, speed = {0.0, 0.0, 0.0};
    for (int i = 0; i < 20000; ++i) {
        speed.forward += ff_random_range(&random, -1e-4, 1e-4);
        speed.left += ff_random_range(&random, -1e-4, 1e-4);
        speed.turn += ff_random_range(&random, -1e-4, 1e-4);
        double step = 1e-3 / ff_max(1e-3, fabs(speed.forward) + fabs(speed.left) + fabs(speed.turn));
        speed = (ff_rates){speed.forward * step, speed.left * step, speed.turn * step};
        rates = (ff_rates){rates.forward + speed.forward, rates.left + speed.left, rates.turn + speed.turn};
        rates = ff_blend_clamp(walker->space, rates);
        ff_blend blend;
        ff_blend_find(walker->space, rates, &blend);
        double now[64] = {0};
        for (int k = 0; k < FF_BLEND_MAX; ++k)
            if (blend.vertex[k] >= 0) now[blend.vertex[k]] += blend.weight[k];
        for (int v = 0; v < 64 && i > 0; ++v)
            worst = ff_max(worst, fabs(now[v] - before[v]));
        memcpy(before, now, sizeof now);
    }
    FF_ASSERT_BELOW(
        worst, 1e-3 * 8.0); /* the nearest neighbours on an axis are 0.5 apart: slope 2, with periods 3 */
}

static double change_between(const ff_blend *from, const ff_blend *to)
{
    double weight[64] = {0}, sum = 0.0;
    for (int k = 0; k < FF_BLEND_MAX; ++k) {
        if (from->vertex[k] >= 0) weight[from->vertex[k]] -= from->weight[k];
        if (to->vertex[k] >= 0) weight[to->vertex[k]] += to->weight[k];
    }
    for (int v = 0; v < 64; ++v)
        sum += fabs(weight[v]);
    return sum;
}

/* Whatever is asked for next: no jump, always whole and with its own speed exact, and there in time. */
static void one_blend_leads_over_to_another_gradually(void **state)
{
    const ff_walker_space *walker = *state;
    ff_random random = {7, 8, 0};
    ff_blend blend, wanted, before;
    ff_blend_find(walker->space, random_rates(&random, 1.0), &blend);
    for (int i = 0; i < 4000; ++i) {
        double most = ff_random_range(&random, 0.05, 0.4);
        int steps = ff_random_unit(&random) < 0.1 ? (int)(FF_BLEND_CHANGE_MOST / most) + 3 : 2;
        ff_blend_find(walker->space, random_rates(&random, 1.3), &wanted);
        for (int k = 0; k < steps; ++k) {
            before = blend;
            ff_blend_follow(walker->space, &wanted, most, &blend);
            double sum = 0.0;
            for (int v = 0; v < FF_BLEND_MAX; ++v)
                sum += blend.weight[v];
            FF_ASSERT_NEAR(sum, 1.0, 1e-12);
            /* Of more examples than there is room for, the smallest of the old ones go at once. */
            if (before.vertex[4] < 0) FF_ASSERT_BELOW(change_between(&before, &blend), most + 1e-9);
            ff_rates got = rates_of_cycle(walker->space, &blend);
            FF_ASSERT_NEAR(got.forward, blend.rates.forward, 1e-9);
            FF_ASSERT_NEAR(got.left, blend.rates.left, 1e-9);
            FF_ASSERT_NEAR(got.turn, blend.rates.turn, 1e-9);
        }
        if (steps > 2) assert_memory_equal(&blend, &wanted, sizeof blend);
    }
}

static void a_pack_of_one_line_of_walks_is_projected_onto(void **state)
{
    (void)state;
    ff_walker_space line = ff_walker_space_make(&ff_walker_grid_tiny);
    ff_rates got = ff_blend_clamp(line.space, (ff_rates){0.7, 0.4, 1.0});
    FF_ASSERT_NEAR(got.forward, 0.7, 1e-6);
    FF_ASSERT_NEAR(got.left, 0.0, 1e-6);
    FF_ASSERT_NEAR(got.turn, 0.0, 1e-6);
    got = ff_blend_clamp(line.space, (ff_rates){5.0, 0.0, 0.0});
    FF_ASSERT_NEAR(got.forward, 1.2, 1e-6);
    ff_walker_space_free(&line);
}

static void a_pack_with_every_simplex_twice_can_be_blended(void **state)
{
    (void)state;
    ff_pack_content content;
    ff_error error;
    ff_walker_content(&content, &ff_walker_grid_small);
    size_t count = content.simplices.count;
    ff_pack_simplex *more = ff_array_grow(&content.simplices, count, sizeof *more);
    assert_non_null(more);
    memcpy(more, content.simplices.data, count * sizeof *more);
    ff_walker_space twice;
    size_t size;
    FF_ASSERT_OK(ff_pack_image(&content, &twice.data, &size, &error), error);
    ff_pack_content_free(&content);
    FF_ASSERT_OK(ff_pack_open_memory(twice.data, size, &twice.pack, &error), error);
    FF_ASSERT_OK(ff_blend_space_create(twice.pack, &twice.space, &error), error);
    ff_rates got = ff_blend_clamp(twice.space, (ff_rates){9.0, 0.0, 0.0});
    FF_ASSERT_NEAR(got.forward, 1.2, 1e-6);
    ff_walker_space_free(&twice);
}

static void who_is_asked_for_too_quick_a_turn_goes_on_all_the_same(void **state)
{
    const ff_walker_space *full = *state;
    const ff_rates asked[] = {{0.8, 0.0, 2.5}, {0.0, 0.4, -2.5}, {0.3, -0.3, 9.0}};
    for (size_t i = 0; i < sizeof asked / sizeof *asked; ++i) {
        ff_rates got = ff_blend_clamp_turn(full->space, asked[i]);
        FF_ASSERT_NEAR(got.forward, asked[i].forward, 1e-9);
        FF_ASSERT_NEAR(got.left, asked[i].left, 1e-9);
        assert_true(got.turn * asked[i].turn > 0.0 && fabs(got.turn) < fabs(asked[i].turn));
        ff_rates again = ff_blend_clamp(full->space, got); /* it can be walked */
        FF_ASSERT_NEAR(again.turn, got.turn, 1e-6);
    }
    ff_rates inside = {0.6, 0.1, 0.5}, kept = ff_blend_clamp_turn(full->space, inside);
    FF_ASSERT_NEAR(kept.forward, inside.forward, 0.0);
    FF_ASSERT_NEAR(kept.turn, inside.turn, 0.0);
    /* Faster than anyone walks and a turn besides: some of it is turned. */
    ff_rates both = ff_blend_clamp_turn(full->space, (ff_rates){9.0, 0.0, 1.0});
    assert_true(both.forward > 1.0 && both.turn > 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blended_rates_are_exact_in_speed_and_turn),
        cmocka_unit_test(targets_inside_are_kept_and_others_go_to_the_nearest_point),
        cmocka_unit_test(who_is_asked_for_too_quick_a_turn_goes_on_all_the_same),
        cmocka_unit_test(weights_change_as_smoothly_as_rates_do),
        cmocka_unit_test(one_blend_leads_over_to_another_gradually),
        cmocka_unit_test(a_pack_with_every_simplex_twice_can_be_blended),
        cmocka_unit_test(a_pack_of_one_line_of_walks_is_projected_onto),
    };
    return cmocka_run_group_tests(tests, open_full_walkers, close_walkers);
}
