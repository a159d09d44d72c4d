/* Limits of sharp turns against velocity sets whose star can be drawn by hand. */
#include "preprocess/examples/sharp_turn.h"
#include "tests/check.h"

static double violation(const ff_pack_sharp *line, double f, double l)
{
    double da = (double)line->direction[0], db = (double)line->direction[1];
    return da * ((double)line->point[1] - l) - db * ((double)line->point[0] - f);
}

static ff_array find(ff_turning *motions, int count)
{
    ff_array out = {0};
    ff_error error;
    FF_ASSERT_OK(ff_sharp_turns_find(motions, count, &out, &error), error);
    const ff_pack_sharp *line = out.data;
    for (size_t i = 0; i < out.count; ++i) {
        assert_true(violation(&line[i], 0.0, 0.0) <= 1e-6); /* standing still is allowed */
        assert_true(line[i].side == 1 || line[i].side == -1);
    }
    return out;
}

static void without_tight_turns_one_may_only_drift(void **state)
{
    (void)state;
    ff_turning motions[] = {{1.3, 0.0}, {1.2, 0.6}, {1.2, -0.6}, {0.0, 1.7}};
    ff_array out = find(motions, 4);
    const ff_pack_sharp *line = out.data;
    assert_int_equal(out.count, 2);
    assert_int_equal(line[0].side, 1);
    assert_true(violation(&line[0], 1.0, 0.29) < 0.0 && violation(&line[0], 1.0, 0.31) > 0.0);
    assert_true(violation(&line[0], 1.0, -2.0) < 0.0);
    assert_int_equal(line[1].side, -1);
    assert_true(violation(&line[1], 1.0, -0.29) < 0.0 && violation(&line[1], 1.0, -0.31) > 0.0);
    ff_array_free(&out);
}

/* A slow tight turn between a fast wide one and a fast turn backwards: the star falls back, and its two edges there are the
 * limits. */
static void pockets_of_the_star_limit_their_own_side(void **state)
{
    (void)state;
    ff_turning motions[] = {
        {2.0, 0.0}, {0.5, 100.0 * FF_DEG}, {1.8, 60.0 * FF_DEG}, {1.5, 150.0 * FF_DEG}, {1.8, -60.0 * FF_DEG},
        {0.3, 0.0}};
    ff_array out = find(motions, 6);
    const ff_pack_sharp *line = out.data;
    assert_int_equal(out.count, 3);
    assert_true(line[0].side == 1 && line[1].side == 1 && line[2].side == -1);
    /* both pocket edges run through the tight turn */
    double f = 0.5 * cos(100.0 * FF_DEG), l = 0.5 * sin(100.0 * FF_DEG);
    FF_ASSERT_NEAR(violation(&line[0], f, l), 0.0, 1e-6);
    FF_ASSERT_NEAR(violation(&line[1], f, l), 0.0, 1e-6);
    assert_true(violation(&line[0], 1.1 * f, 1.1 * l) > 0.0);
    FF_ASSERT_NEAR(violation(&line[0], 1.8 * cos(60.0 * FF_DEG), 1.8 * sin(60.0 * FF_DEG)), 0.0, 1e-6);
    ff_array_free(&out);
}

static void left_and_right_are_mirror_images(void **state)
{
    (void)state;
    ff_turning motions[] = {{2.0, 0.0},  {0.5, 1.8}, {0.5, -1.8}, {1.9, 1.0},
                            {1.9, -1.0}, {1.6, 2.8}, {1.6, -2.8}};
    ff_array out = find(motions, 7);
    const ff_pack_sharp *line = out.data;
    assert_true(out.count >= 2 && out.count % 2 == 0);
    for (size_t i = 0; i < out.count / 2; ++i)
        for (double f = -2.0; f < 2.1; f += 0.5)
            for (double l = -2.0; l < 2.1; l += 0.5) {
                size_t other = out.count - 1 - i; /* the star is walked around the other way */
                FF_ASSERT_NEAR(violation(&line[i], f, l), violation(&line[other], f, -l), 1e-6);
            }
    ff_array_free(&out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_tight_turns_one_may_only_drift),
        cmocka_unit_test(pockets_of_the_star_limit_their_own_side),
        cmocka_unit_test(left_and_right_are_mirror_images),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
