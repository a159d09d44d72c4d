/* Obstacles in pictures: where a path has them, and outlines that keep their distance from the core they are rounded about. */
#include "runtime/export/obstacle_outline.h"
#include "tests/check.h"

static ff_obstacle_def cart(void)
{
    ff_obstacle_def def = ff_obstacle_def_default();
    def.kind = FF_OBSTACLE_PATH;
    def.position = ff_v2(1.0, 0.0);
    def.path[0] = (ff_obstacle_point){1.0, ff_v2(0.0, 0.0)};
    def.path[1] = (ff_obstacle_point){3.0, ff_v2(4.0, 0.0)};
    def.path[2] = (ff_obstacle_point){4.0, ff_v2(4.0, 2.0)};
    def.path_count = 3;
    def.start = 10.0;
    return def;
}

static void a_path_is_straight_and_even_between_its_points(void **state)
{
    (void)state;
    const double table[][3] = {/* time, a, b */
                               {0.0, 1.0, 0.0},  {11.0, 1.0, 0.0}, {12.0, 3.0, 0.0},
                               {13.0, 5.0, 0.0}, {13.5, 5.0, 1.0}, {99.0, 5.0, 2.0}};
    ff_obstacle_def def = cart();
    for (size_t i = 0; i < sizeof table / sizeof *table; ++i) {
        ff_vec2 at = ff_obstacle_at(&def, table[i][0]);
        FF_ASSERT_NEAR(at.a, table[i][1], 1e-12);
        FF_ASSERT_NEAR(at.b, table[i][2], 1e-12);
    }
    def.cyclic = true; /* once round in 4 s */
    FF_ASSERT_NEAR(ff_obstacle_at(&def, 10.0 + 4.0 * 7 + 2.0).a, 3.0, 1e-9);
    def.kind = FF_OBSTACLE_STATIC;
    FF_ASSERT_NEAR(ff_obstacle_at(&def, 12.0).a, 1.0, 0.0);
}

static void every_corner_is_the_radius_away_from_the_core_and_they_go_round_to_the_left(void **state)
{
    (void)state;
    ff_obstacle_def def = ff_obstacle_def_default();
    def.position = ff_v2(3.0, -2.0);
    def.heading = 0.7;
    def.half_length = 0.6;
    def.half_width = 0.25;
    def.radius = 0.1;
    ff_vec2 outline[FF_OBSTACLE_CORNERS];
    ff_obstacle_outline(&def, 5.0, outline);
    double area = 0.0;
    for (int i = 0; i < FF_OBSTACLE_CORNERS; ++i) {
        ff_vec2 p = ff_to_frame2(ff_fwd2(def.heading), ff_sub2(outline[i], def.position));
        double out_a = ff_max(fabs(p.a) - def.half_length, 0.0),
               out_b = ff_max(fabs(p.b) - def.half_width, 0.0);
        FF_ASSERT_NEAR(sqrt(out_a * out_a + out_b * out_b), def.radius, 1e-12);
        area += 0.5 * ff_det2(outline[i], outline[(i + 1) % FF_OBSTACLE_CORNERS]);
    }
    double box =
        4.0 * def.half_length * def.half_width + 4.0 * def.radius * (def.half_length + def.half_width);
    assert_true(area > box + 0.9 * FF_PI * def.radius * def.radius &&
                area < box + FF_PI * def.radius * def.radius);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_path_is_straight_and_even_between_its_points),
        cmocka_unit_test(every_corner_is_the_radius_away_from_the_core_and_they_go_round_to_the_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
