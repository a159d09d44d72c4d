/* Delaunay simplices: empty spheres, and a volume that is the hull's. */
#include "preprocess/examples/simplices.h"
#include "runtime/core/base/random.h"
#include "tests/check.h"

static double tetrahedron(const ff_vec3 *p, const int *v)
{
    ff_vec3 a = ff_sub3(p[v[1]], p[v[0]]), b = ff_sub3(p[v[2]], p[v[0]]), c = ff_sub3(p[v[3]], p[v[0]]);
    return fabs(ff_dot3(a, ff_cross3(b, c))) / 6.0;
}

static double whole_volume(const ff_vec3 *p, const ff_array *found)
{
    double sum = 0.0;
    const ff_simplex *s = found->data;
    for (size_t i = 0; i < found->count; ++i)
        sum += tetrahedron(p, s[i].vertex);
    return sum;
}

/* Is the point inside one of the tetrahedra? */
static bool covered(const ff_vec3 *p, const ff_array *found, ff_vec3 at)
{
    const ff_simplex *s = found->data;
    for (size_t i = 0; i < found->count; ++i) {
        ff_vec3 corner[5] = {p[s[i].vertex[0]], p[s[i].vertex[1]], p[s[i].vertex[2]], p[s[i].vertex[3]], at};
        double whole = tetrahedron(corner, (int[]){0, 1, 2, 3}), parts = 0.0;
        for (int k = 0; k < 4; ++k) {
            int v[4] = {0, 1, 2, 3};
            v[k] = 4;
            parts += tetrahedron(corner, v);
        }
        if (parts < whole * (1.0 + 1e-6)) return true;
    }
    return false;
}

static void a_cube_is_filled_whichever_way_it_is_cut(void **state)
{
    (void)state;
    ff_vec3 p[8];
    for (int i = 0; i < 8; ++i)
        p[i] = ff_v3(i & 1, i >> 1 & 1, i >> 2 & 1);
    ff_array found = {0};
    ff_error error;
    FF_ASSERT_OK(ff_simplices_find(p, 8, &found, &error), error);
    FF_ASSERT_NEAR(whole_volume(p, &found), 1.0, 1e-3);
    ff_array_free(&found);
}

static void mixtures_of_the_points_are_covered(void **state)
{
    (void)state;
    for (uint64_t set = 0; set < 10; ++set) {
        ff_random random = {3, set, 0};
        ff_vec3 p[20];
        for (int i = 0; i < 20; ++i)
            p[i] = ff_v3(ff_random_range(&random, -1.0, 2.0), ff_random_range(&random, -0.6, 0.6),
                         ff_random_range(&random, -0.8, 0.8));
        ff_array found = {0};
        ff_error error;
        FF_ASSERT_OK(ff_simplices_find(p, 20, &found, &error), error);
        int missed = 0;
        for (int trial = 0; trial < 200; ++trial) {
            ff_vec3 at = {0.0, 0.0, 0.0};
            double sum = 0.0;
            for (int i = 0; i < 20; ++i) {
                double w = ff_random_unit(&random);
                w = w * w * w * w;
                at = ff_madd3(at, p[i], w);
                sum += w;
            }
            missed += !covered(p, &found, ff_scale3(at, 1.0 / sum));
        }
        assert_int_equal(missed, 0);
        ff_array_free(&found);
    }
}

static void flat_sets_give_triangles_lines_segments_and_a_place_itself(void **state)
{
    (void)state;
    ff_error error;
    ff_array found = {0};
    const ff_vec3 flat[] = {{0, 0, 0}, {1, 0, -0.4}, {1, 0, 0}, {1, 0, 0.4}, {1.6, 0, 0}};
    FF_ASSERT_OK(ff_simplices_find(flat, 5, &found, &error), error);
    const ff_simplex *s = found.data;
    double area = 0.0;
    for (size_t i = 0; i < found.count; ++i) {
        assert_int_equal(s[i].vertex[3], -1);
        ff_vec3 a = ff_sub3(flat[s[i].vertex[1]], flat[s[i].vertex[0]]);
        ff_vec3 b = ff_sub3(flat[s[i].vertex[2]], flat[s[i].vertex[0]]);
        area += 0.5 * ff_length3(ff_cross3(a, b));
    }
    FF_ASSERT_NEAR(area, 0.5 * 0.8 * 1.6, 1e-9);
    found.count = 0;
    const ff_vec3 line[] = {{0, 0, 0}, {1.5, 0, 0}, {1.0, 0, 0}, {1.0, 0, 1e-5}};
    FF_ASSERT_OK(ff_simplices_find(line, 4, &found, &error), error);
    s = found.data;
    assert_int_equal(found.count, 2);
    assert_true(s[0].vertex[0] == 0 && s[0].vertex[1] == 2 && s[0].vertex[2] == -1);
    found.count = 0;
    FF_ASSERT_OK(ff_simplices_find(line, 1, &found, &error), error);
    s = found.data;
    assert_int_equal(found.count, 1);
    assert_true(s[0].vertex[0] == 0 && s[0].vertex[1] == -1);
    ff_array_free(&found);
}

static void too_many_points_are_refused_and_none_is_fine(void **state)
{
    (void)state;
    ff_error error;
    ff_array found = {0};
    ff_vec3 p[FF_SIMPLICES_MAX_POINTS + 1] = {{0, 0, 0}};
    assert_int_equal(ff_simplices_find(p, FF_SIMPLICES_MAX_POINTS + 1, &found, &error), FF_ERR_RANGE);
    FF_ASSERT_OK(ff_simplices_find(p, 0, &found, &error), error);
    assert_int_equal(found.count, 0);
    ff_array_free(&found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_is_filled_whichever_way_it_is_cut),
        cmocka_unit_test(mixtures_of_the_points_are_covered),
        cmocka_unit_test(flat_sets_give_triangles_lines_segments_and_a_place_itself),
        cmocka_unit_test(too_many_points_are_refused_and_none_is_fine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
