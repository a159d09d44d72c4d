/* The body: a closed surface about the bones that bends with them. */
#include "runtime/export/body_mesh.h"
#include "tests/check.h"
#include "tests/export/walker.h"

static ff_figure figure;
static ff_body_mesh mesh;

static int make_body(void **state)
{
    (void)state;
    ff_error error;
    walker_figure(&figure);
    return ff_body_mesh_make(&figure, 0.03, &mesh, &error) == FF_OK ? 0 : -1;
}

static int free_body(void **state)
{
    (void)state;
    ff_body_mesh_free(&mesh);
    return 0;
}

static const ff_body_vertex *vertex(size_t i)
{
    return (const ff_body_vertex *)mesh.vertices.data + i;
}

static ff_vec3 position(size_t i)
{
    const float *p = vertex(i)->position;
    return ff_v3(p[0], p[1], p[2]);
}

static int compare_edges(const void *left, const void *right)
{
    return memcmp(left, right, 2 * sizeof(uint32_t));
}

static void test_every_edge_joins_two_triangles_that_run_along_it_in_opposite_senses(void **state)
{
    (void)state;
    size_t count = 3 * mesh.triangles.count;
    uint32_t(*edges)[2] = malloc(count * sizeof *edges), (*back)[2] = malloc(count * sizeof *back);
    assert_true(edges && back);
    const uint32_t(*triangles)[3] = (const uint32_t(*)[3])mesh.triangles.data;
    for (size_t t = 0; t < mesh.triangles.count; ++t)
        for (size_t k = 0; k < 3; ++k) {
            edges[3 * t + k][0] = back[3 * t + k][1] = triangles[t][k];
            edges[3 * t + k][1] = back[3 * t + k][0] = triangles[t][(k + 1) % 3];
        }
    qsort(edges, count, sizeof *edges, compare_edges);
    qsort(back, count, sizeof *back, compare_edges);
    assert_memory_equal(edges, back, count * sizeof *edges);
    free(edges);
    free(back);
}

static void test_it_faces_outwards_and_weighs_as_much_as_a_person(void **state)
{
    (void)state;
    double volume = 0.0;
    const uint32_t(*triangles)[3] = (const uint32_t(*)[3])mesh.triangles.data;
    for (size_t t = 0; t < mesh.triangles.count; ++t)
        volume += ff_dot3(position(triangles[t][0]),
                          ff_cross3(position(triangles[t][1]), position(triangles[t][2]))) /
                  6.0;
    FF_ASSERT_NEAR(volume, 0.070, 0.015); /* m3: 70 kg at the density of water */
}

static void test_vertices_lie_on_the_surface_above_the_ground(void **state)
{
    (void)state;
    ff_body_shape shape;
    ff_body_shape_make(&figure, &shape);
    double top = 0.0;
    for (size_t i = 0; i < mesh.vertices.count; ++i) {
        ff_vec3 p = position(i);
        FF_ASSERT_BELOW(fabs(ff_body_distance(&shape, p)), 0.01); /* in creases; a third of an edge */
        FF_ASSERT_BELOW(-p.y, 0.003);
        top = ff_max(top, p.y);
        const float *n = vertex(i)->normal;
        FF_ASSERT_NEAR(ff_length3(ff_v3(n[0], n[1], n[2])), 1.0, 1e-5);
    }
    FF_ASSERT_NEAR(top, figure.rest[FF_JOINT_SHOULDER_L].y + 0.105 + 0.205, 0.02);
}

static void test_weights_sum_to_one_and_stay_on_their_side(void **state)
{
    (void)state;
    for (size_t i = 0; i < mesh.vertices.count; ++i) {
        int sum = 0, sides = 0;
        for (int k = 0; k < 4; ++k) {
            uint32_t j = vertex(i)->joints[k];
            sum += vertex(i)->weights[k];
            if (vertex(i)->weights[k] == 0) continue;
            if (j >= FF_JOINT_HIP_L && j <= FF_JOINT_BALL_L) sides |= 1;
            if (j >= FF_JOINT_HIP_R && j <= FF_JOINT_BALL_R) sides |= 2;
        }
        assert_int_equal(sum, 255);
        /* Where the legs meet, both may pull. */
        assert_true(sides != 3 || fabs(position(i).x) < 0.025);
    }
}

static int leg_of(const ff_body_vertex *v)
{
    return v->joints[0] >= FF_JOINT_HIP_L ? ff_joint_side(v->joints[0]) : 0;
}

/* Some skeletons' hips are so narrow that the thighs of the rest pose touch: skin from one leg to the other would be a skirt. */
static void test_no_skin_reaches_from_leg_to_leg_below_the_hips(void **state)
{
    (void)state;
    for (int narrow = 0; narrow < 2; ++narrow)
        for (double cell = 0.016; cell < 0.032; cell += 0.007) {
            ff_figure person = figure;
            ff_body_mesh body;
            ff_error error;
            for (int j = FF_JOINT_HIP_L; narrow && j <= FF_JOINT_BALL_R; ++j)
                person.rest[j].x *= 0.046 / fabs(figure.rest[FF_JOINT_HIP_L].x);
            double crotch = person.rest[FF_JOINT_HIP_L].y - 0.16; /* where the trunk ends */
            FF_ASSERT_OK(ff_body_mesh_make(&person, cell, &body, &error), error);
            const ff_body_vertex *vertices = body.vertices.data;
            const uint32_t *corner = body.triangles.data;
            for (size_t i = 0; i < 3 * body.triangles.count; ++i) {
                const ff_body_vertex *p = &vertices[corner[i]],
                                     *q = &vertices[corner[i - i % 3 + (i + 1) % 3]];
                assert_true(leg_of(p) * leg_of(q) >= 0 || (double)p->position[1] > crotch);
            }
            ff_body_mesh_free(&body);
        }
}

static void test_every_piece_of_clothing_is_there_and_covers_are_contiguous(void **state)
{
    (void)state;
    for (int cover = 0; cover < FF_COVER_COUNT; ++cover)
        assert_true(mesh.cover_first[cover + 1] > mesh.cover_first[cover] + 20);
    assert_int_equal(mesh.cover_first[FF_COVER_COUNT], mesh.triangles.count);
}

static void test_skinning_the_rest_pose_changes_nothing_and_a_moved_root_moves_all(void **state)
{
    (void)state;
    size_t count = mesh.vertices.count;
    ff_vec3 *positions = malloc(count * sizeof *positions), *normals = malloc(count * sizeof *normals);
    ff_vec3 joints[FF_FIGURE_MAX_JOINTS];
    ff_quat local[FF_FIGURE_MAX_JOINTS], turns[FF_FIGURE_MAX_JOINTS];
    assert_true(positions && normals);
    for (int j = 0; j < FF_JOINT_COUNT; ++j)
        local[j] = FF_QUAT_IDENTITY;
    local[0] = ff_quat_yaw(FF_PI / 2);
    ff_figure_place(&figure, ff_v3(5.0, figure.rest[0].y, 0.0), local, joints, turns);
    ff_body_mesh_skin(&mesh, &figure, joints, turns, positions, normals);
    for (size_t i = 0; i < count; ++i) { /* facing +x: (x, y, z) -> (5 + z, y, -x) */
        ff_vec3 p = position(i);
        FF_ASSERT_BELOW(ff_length3(ff_sub3(positions[i], ff_v3(5.0 + p.z, p.y, -p.x))), 1e-6);
        FF_ASSERT_NEAR(normals[i].x, (double)vertex(i)->normal[2], 1e-5);
    }
    free(positions);
    free(normals);
}

static void test_a_skeleton_that_is_no_person_is_refused(void **state)
{
    (void)state;
    ff_error error;
    ff_figure out;
    const int32_t parents[3] = {-1, 0, 1};
    const ff_vec3 offsets[3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
    assert_int_equal(ff_figure_from_joints(3, parents, offsets, walker_names, &out, &error),
                     FF_ERR_UNSUPPORTED);
    assert_non_null(strstr(error.message, "3 joints"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_edge_joins_two_triangles_that_run_along_it_in_opposite_senses),
        cmocka_unit_test(test_it_faces_outwards_and_weighs_as_much_as_a_person),
        cmocka_unit_test(test_vertices_lie_on_the_surface_above_the_ground),
        cmocka_unit_test(test_weights_sum_to_one_and_stay_on_their_side),
        cmocka_unit_test(test_no_skin_reaches_from_leg_to_leg_below_the_hips),
        cmocka_unit_test(test_every_piece_of_clothing_is_there_and_covers_are_contiguous),
        cmocka_unit_test(test_skinning_the_rest_pose_changes_nothing_and_a_moved_root_moves_all),
        cmocka_unit_test(test_a_skeleton_that_is_no_person_is_refused),
    };
    return cmocka_run_group_tests(tests, make_body, free_body);
}
