/* The adapter to librecast: walkers get to their goals, and what cannot be made is refused. */
#include "runtime/core/base/maths.h"
#include "runtime/export/detour.h"
#include "tests/check.h"

static void need_detour(void)
{
    if (ff_detour_here()) return;
    print_message("SKIPPED: Detour: this build is without librecast\n");
    skip();
}

static void walkers_reach_their_goals(void **state)
{
    (void)state;
    need_detour();
    ff_error error;
    ff_detour *detour = NULL;
    const ff_detour_agent agents[2] = {{{-4.0, 0.1}, {4.0, 0.1}, 0.3, 1.3},
                                       {{4.0, -0.1}, {-4.0, -0.1}, 0.3, 1.3}};
    FF_ASSERT_OK(ff_detour_create(agents, 2, 10.0, &detour, &error), error);
    FF_ASSERT_NEAR(ff_detour_position(detour, 0).a, -4.0, 1e-3);
    FF_ASSERT_NEAR(ff_detour_position(detour, 1).b, -0.1, 1e-3);
    double nearest = 8.0, fastest = 0.0;
    for (int i = 0; i < 450; ++i) {
        ff_detour_step(detour, 1.0 / 30.0);
        ff_vec2 apart = ff_sub2(ff_detour_position(detour, 0), ff_detour_position(detour, 1));
        nearest = ff_min(nearest, ff_length2(apart));
        fastest = ff_max(fastest, ff_length2(ff_detour_velocity(detour, 0)));
    }
    for (uint32_t i = 0; i < 2; ++i)
        FF_ASSERT_BELOW(ff_length2(ff_sub2(ff_detour_position(detour, i), agents[i].goal)), 0.5);
    assert_true(nearest > 0.5);
    FF_ASSERT_BELOW(fastest, 1.31);
    ff_detour_destroy(detour);
}

static void a_goal_off_the_ground_is_refused(void **state)
{
    (void)state;
    ff_error error = {0};
    ff_detour *detour = NULL;
    const ff_detour_agent lost = {{0.0, 0.0}, {90.0, 0.0}, 0.3, 1.3};
    assert_int_equal(ff_detour_create(&lost, 1, 10.0, &detour, &error), FF_ERR_UNSUPPORTED);
    assert_null(detour);
    ff_detour_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walkers_reach_their_goals),
        cmocka_unit_test(a_goal_off_the_ground_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
