/* Surfaces of characters: cleaning, levels of detail, fitting to the rig, thickness of bones. */
#include "mocap/generator/generator.h"
#include "preprocess/actions/annotate.h"
#include "preprocess/build/pack_fill.h"
#include "preprocess/motion/retarget.h"
#include "preprocess/skin/mesh.h"
#include "tests/check.h"
#include "tests/preprocess/standard.h"

#include <stdio.h>

/* --------------------------------------------------------------------------------------------------------- shapes */

static ff_mesh empty_mesh(int vertices, int triangles)
{
    ff_mesh mesh = {calloc((size_t)vertices, sizeof(ff_skin_vertex)), 0,
                    calloc((size_t)triangles, sizeof(uint32_t[3])), 0};
    assert_true(mesh.vertices && mesh.triangles);
    return mesh;
}

static uint32_t add_vertex(ff_mesh *mesh, ff_vec3 at, int joint)
{
    ff_skin_vertex *v = &mesh->vertices[mesh->vertex_count];
    *v = (ff_skin_vertex){.at = at, .joint = {joint}, .weight = {1.0}};
    return (uint32_t)mesh->vertex_count++;
}

static void add_triangle(ff_mesh *mesh, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *t = mesh->triangles[mesh->triangle_count++];
    t[0] = a, t[1] = b, t[2] = c;
}

/* A ball of rings and sectors; the seam of its texture splits the vertices of one meridian. */
enum { RINGS = 24, SECTORS = 48 };
static ff_mesh make_ball(void)
{
    ff_mesh mesh = empty_mesh((RINGS + 1) * (SECTORS + 1), 2 * RINGS * SECTORS);
    for (int r = 0; r <= RINGS; ++r)
        for (int s = 0; s <= SECTORS; ++s) {
            double down = FF_PI * r / RINGS, round = FF_TAU * (s % SECTORS) / SECTORS;
            double side = r == 0 || r == RINGS ? 0.0 : sin(down);
            uint32_t v = add_vertex(&mesh, ff_v3(side * sin(round), cos(down), side * cos(round)),
                                    r < RINGS / 2 ? 3 : 5);
            mesh.vertices[v].uv[0] = s / (double)SECTORS;
        }
    for (uint32_t r = 0; r < RINGS; ++r)
        for (uint32_t s = 0; s < SECTORS; ++s) {
            uint32_t a = r * (SECTORS + 1) + s, b = a + SECTORS + 1;
            add_triangle(&mesh, a, b, b + 1);
            add_triangle(&mesh, a, b + 1, a + 1);
        }
    return mesh;
}

static bool has_place(const ff_mesh *mesh, ff_vec3 at)
{
    for (int i = 0; i < mesh->vertex_count; ++i)
        if (ff_length3(ff_sub3(mesh->vertices[i].at, at)) <= 0.0) return true;
    return false;
}

/* Enclosed volume, by signed tetrahedra: positive when triangles turn the right way. */
static double volume_of(const ff_mesh *mesh)
{
    double volume = 0.0;
    for (int t = 0; t < mesh->triangle_count; ++t) {
        const uint32_t *c = mesh->triangles[t];
        volume +=
            ff_dot3(mesh->vertices[c[0]].at, ff_cross3(mesh->vertices[c[1]].at, mesh->vertices[c[2]].at)) /
            6.0;
    }
    return volume;
}

/* --------------------------------------------------------------------------------------------------------- cleaning */

static void degenerate_repeated_and_unused_parts_are_left_out(void **state)
{
    (void)state;
    ff_mesh mesh = empty_mesh(16, 16);
    uint32_t a = add_vertex(&mesh, ff_v3(0, 0, 0), 0), unused = add_vertex(&mesh, ff_v3(9, 9, 9), 0);
    uint32_t b = add_vertex(&mesh, ff_v3(1, 0, 0), 1), c = add_vertex(&mesh, ff_v3(0, 1, 0), 2);
    uint32_t twin = add_vertex(&mesh, ff_v3(0, 0, 0), 0), on = add_vertex(&mesh, ff_v3(0.5, 0, 0), 0);
    uint32_t d = add_vertex(&mesh, ff_v3(1, 1, 0), 3);
    (void)unused;
    add_triangle(&mesh, a, b, c);
    add_triangle(&mesh, b, c, twin); /* the same places */
    add_triangle(&mesh, a, twin, c); /* two corners in one place */
    add_triangle(&mesh, a, on, b);   /* on a line */
    add_triangle(&mesh, c, c, b);
    add_triangle(&mesh, b, d, c);
    ff_mesh_faults faults = {0};
    ff_error error;
    FF_ASSERT_OK(ff_mesh_clean(&mesh, &faults, &error), error);
    assert_int_equal(mesh.triangle_count, 2);
    assert_int_equal(mesh.vertex_count, 4);
    assert_int_equal(faults.degenerate, 3);
    assert_int_equal(faults.repeated, 1);
    assert_int_equal(faults.unused, 3);
    assert_int_equal(mesh.vertices[mesh.triangles[1][1]].joint[0], 3);
    ff_mesh_free(&mesh);
}

static void three_triangles_at_an_edge_are_taken_apart(void **state)
{
    (void)state;
    ff_mesh mesh = empty_mesh(8, 4), out;
    uint32_t a = add_vertex(&mesh, ff_v3(0, 0, 0), 0), b = add_vertex(&mesh, ff_v3(0, 1, 0), 0);
    for (int i = 0; i < 3; ++i)
        add_triangle(&mesh, a, b, add_vertex(&mesh, ff_v3(cos(2.0 * i), 0, sin(2.0 * i)), 0));
    ff_mesh_faults faults = {0};
    ff_error error;
    FF_ASSERT_OK(ff_mesh_reduce(&mesh, 100, 60.0, &out, &faults, &error), error);
    assert_int_equal(out.triangle_count, 3);
    assert_in_range(faults.torn, 1, 2);
    ff_mesh_free(&out);
    ff_mesh_free(&mesh);
}

/* --------------------------------------------------------------------------------------------------- levels of detail */

static void a_ball_stays_a_ball_at_every_level(void **state)
{
    (void)state;
    ff_mesh ball = make_ball(), levels[FF_MESH_LEVELS];
    ff_mesh_faults faults = {0};
    ff_error error;
    FF_ASSERT_OK(ff_mesh_clean(&ball, &faults, &error), error);
    assert_int_equal(faults.degenerate, 2 * SECTORS);
    FF_ASSERT_OK(ff_mesh_levels(&standard()->skin, &ball, levels, &faults, &error), error);
    assert_int_equal(levels[0].triangle_count, ball.triangle_count);
    for (int i = 0; i < FF_MESH_LEVELS; ++i) {
        const ff_mesh *mesh = &levels[i];
        FF_ASSERT_NEAR(volume_of(mesh), 4.0 / 3.0 * FF_PI, i == 0 ? 0.05 : 0.15);
        for (int k = 0; k < mesh->vertex_count; ++k) {
            const ff_skin_vertex *v = &mesh->vertices[k];
            assert_true(has_place(&ball, v->at)); /* one of the old ones, with its own weights */
            FF_ASSERT_NEAR(v->weight[0] + v->weight[1] + v->weight[2] + v->weight[3], 1.0, 1e-12);
            assert_int_equal(v->joint[0], v->at.y > 1e-9 ? 3 : 5);
            FF_ASSERT_NEAR(ff_length3(v->normal), 1.0, 1e-9);
            assert_true(ff_dot3(v->normal, ff_unit3(v->at)) > 0.9);
        }
    }
    assert_true(levels[1].triangle_count < 0.36 * ball.triangle_count);
    assert_in_range(levels[2].triangle_count, 300, 402);
    for (int i = 0; i < FF_MESH_LEVELS; ++i)
        ff_mesh_free(&levels[i]);
    ff_mesh_free(&ball);
}

static void a_box_keeps_its_edges(void **state)
{
    (void)state;
    ff_mesh box = empty_mesh(8, 12), out;
    for (int i = 0; i < 8; ++i)
        add_vertex(&box, ff_v3(i & 1, i >> 1 & 1, i >> 2), 0);
    static const uint32_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int s = 0; s < 6; ++s) {
        add_triangle(&box, sides[s][0], sides[s][1], sides[s][2]);
        add_triangle(&box, sides[s][0], sides[s][2], sides[s][3]);
    }
    ff_mesh_faults faults = {0};
    ff_error error;
    FF_ASSERT_OK(ff_mesh_reduce(&box, 100, 60.0, &out, &faults, &error), error);
    FF_ASSERT_NEAR(volume_of(&out), 1.0, 1e-12);
    assert_int_equal(out.vertex_count, 24); /* three normals at each corner */
    for (int i = 0; i < out.vertex_count; ++i) {
        ff_vec3 n = out.vertices[i].normal;
        FF_ASSERT_NEAR(ff_max(fabs(n.x), ff_max(fabs(n.y), fabs(n.z))), 1.0, 1e-9);
    }
    ff_mesh_free(&out);
    ff_mesh_free(&box);
}

/* ------------------------------------------------------------------------------------------------------------- fitting */

static ff_rig usual_rig(void)
{
    ff_generated walk;
    ff_rig rig;
    ff_error error;
    FF_ASSERT_OK(ff_generator_make(ff_generator_find("walk-normal"), NULL, &walk, &error), error);
    const ff_clip *clips[1] = {&walk.clip};
    FF_ASSERT_OK(ff_rig_from_clips(clips, 1, &rig, &error), error);
    ff_generated_free(&walk);
    return rig;
}

/* A person made of tubes of a known radius about the rig's own bones, scaled and turned round. */
enum { TUBE_SIDES = 12, TUBE_RINGS = 6 };
#define TUBE 0.04

static void add_tube(ff_mesh *mesh, ff_vec3 a, ff_vec3 b, int joint)
{
    ff_quat turn = ff_quat_between(ff_v3(0.0, 1.0, 0.0), ff_unit3(ff_sub3(b, a)));
    uint32_t first = (uint32_t)mesh->vertex_count;
    for (int r = 0; r < TUBE_RINGS; ++r)
        for (int s = 0; s < TUBE_SIDES; ++s) {
            double round = FF_TAU * s / TUBE_SIDES;
            ff_vec3 out = ff_quat_rotate(turn, ff_v3(TUBE * sin(round), 0.0, TUBE * cos(round)));
            add_vertex(mesh, ff_add3(ff_lerp3(a, b, r / (TUBE_RINGS - 1.0)), out), joint);
        }
    for (uint32_t r = 0; r + 1 < TUBE_RINGS; ++r)
        for (uint32_t s = 0; s < TUBE_SIDES; ++s) {
            uint32_t c = first + r * TUBE_SIDES + s, next = first + r * TUBE_SIDES + (s + 1) % TUBE_SIDES;
            add_triangle(mesh, c, next, next + TUBE_SIDES);
            add_triangle(mesh, c, next + TUBE_SIDES, c + TUBE_SIDES);
        }
}

static ff_skin person_of_tubes(const ff_rig *rig, double size, double heading)
{
    ff_vec3 at[FF_BODY_COUNT];
    ff_rig_rest_pose(rig, at);
    ff_mesh mesh =
        empty_mesh(FF_ROLE_COUNT * TUBE_RINGS * TUBE_SIDES, 2 * FF_ROLE_COUNT * TUBE_RINGS * TUBE_SIDES);
    for (int r = 1; r < FF_ROLE_COUNT; ++r) /* the tube of a bone hangs on the joint it starts at */
        add_tube(&mesh, at[ff_role_parent((ff_role)r)], at[r], (int)ff_role_parent((ff_role)r));
    ff_skin skin = {.vertices = mesh.vertices,
                    .vertex_count = mesh.vertex_count,
                    .triangles = mesh.triangles,
                    .triangle_count = mesh.triangle_count,
                    .joints = calloc(FF_ROLE_COUNT, sizeof(ff_skin_joint)),
                    .joint_count = FF_ROLE_COUNT};
    assert_non_null(skin.joints);
    for (int r = 0; r < FF_ROLE_COUNT; ++r) {
        ff_skin_joint *joint = &skin.joints[r];
        snprintf(joint->name, sizeof joint->name, "%s", ff_role_name((ff_role)r));
        joint->parent = (int)ff_role_parent((ff_role)r);
        joint->role = (ff_role)r;
        joint->near = r < FF_ROLE_JOINT_COUNT ? (ff_role)r : ff_role_parent((ff_role)r);
        joint->at = ff_scale3(ff_quat_rotate(ff_quat_yaw(heading), at[r]), size);
    }
    for (int i = 0; i < skin.vertex_count; ++i)
        skin.vertices[i].at = ff_scale3(ff_quat_rotate(ff_quat_yaw(heading), skin.vertices[i].at), size);
    return skin;
}

static void a_person_of_tubes_is_fitted_back_and_as_thick_as_the_tubes(void **state)
{
    (void)state;
    ff_rig rig = usual_rig();
    ff_skin same = person_of_tubes(&rig, 1.0, 0.0), other = person_of_tubes(&rig, 1.3, 1.1);
    double radius[FF_ROLE_JOINT_COUNT];
    ff_mesh mesh;
    ff_error error;
    FF_ASSERT_OK(ff_mesh_fit(&other, &rig, &mesh, radius, &error), error);
    /* Soles are put on the ground, so feet are judged without height. */
    for (int i = 0; i < mesh.vertex_count; ++i) {
        ff_vec3 off = ff_sub3(mesh.vertices[i].at, same.vertices[i].at);
        int joint = mesh.vertices[i].joint[0];
        bool foot = joint == FF_ROLE_ANKLE_L || joint == FF_ROLE_ANKLE_R || joint == FF_ROLE_BALL_L ||
                    joint == FF_ROLE_BALL_R;
        if (foot) off.y = 0.0;
        FF_ASSERT_BELOW(ff_length3(off), 0.02);
    }
    static const ff_role limbs[] = {FF_ROLE_SHOULDER_L, FF_ROLE_ELBOW_L, FF_ROLE_HIP_R, FF_ROLE_KNEE_R,
                                    FF_ROLE_SPINE};
    for (size_t i = 0; i < sizeof limbs / sizeof limbs[0]; ++i)
        FF_ASSERT_NEAR(radius[limbs[i]], TUBE, 0.004);
    ff_mesh_free(&mesh);
    ff_skin_free(&same);
    ff_skin_free(&other);
}

/* A ball of a known size about the middle of every collider, hung on its joint; the left hand's is larger. */
static void colliders_are_as_large_as_the_skin_about_them(void **state)
{
    (void)state;
    static const double size[FF_COLLIDER_COUNT] = {0.13, 0.09, 0.07, 0.12, 0.12, 0.2};
    static const int joint[FF_COLLIDER_COUNT] = {FF_ROLE_HEAD,    FF_ROLE_WRIST_L, FF_ROLE_WRIST_R,
                                                 FF_ROLE_ANKLE_L, FF_ROLE_BALL_R,  FF_ROLE_HIPS};
    ff_rig rig = usual_rig();
    ff_vec3 at[FF_BODY_COUNT], middle[FF_COLLIDER_COUNT];
    ff_rig_rest_pose(&rig, at);
    ff_collider_middles(at, middle);
    ff_mesh ball = make_ball(), body = empty_mesh(6 * ball.vertex_count + 200, 1);
    for (int c = 0; c < FF_COLLIDER_COUNT; ++c)
        for (int i = 0; i < ball.vertex_count; ++i) /* the ball's radius is 1 */
            add_vertex(&body, ff_madd3(middle[c], ball.vertices[i].at, size[c]), joint[c]);
    for (int i = 0; i < 20; ++i) /* a feather on the hat */
        add_vertex(&body, ff_v3(3.0 + i, 2.0, 0.0), FF_ROLE_HEAD);
    for (int i = 0; i < 100; ++i) /* limbs do not count */
        add_vertex(&body, ff_v3(5.0, i, 0.0), FF_ROLE_ELBOW_L);
    double radii[FF_COLLIDER_COUNT];
    ff_error error;
    FF_ASSERT_OK(ff_mesh_collider_radii(&body, &rig, radii, &error), error);
    for (int c = 0; c < FF_COLLIDER_COUNT; ++c) {
        double wanted = c == FF_COLLIDER_HAND_R ? size[FF_COLLIDER_HAND_L] : size[c];
        bool hand = c == FF_COLLIDER_HAND_L || c == FF_COLLIDER_HAND_R;
        FF_ASSERT_NEAR(radii[c], wanted,
                       hand ? 1e-9 : 0.01 * wanted); /* of a ball, some are nearer its axis */
    }
    body.vertex_count = 0;
    FF_ASSERT_OK(ff_mesh_collider_radii(&body, &rig, radii, &error), error);
    for (int c = 0; c < FF_COLLIDER_COUNT; ++c)
        FF_ASSERT_NEAR(radii[c], 0.0, 0.0);
    ff_mesh_free(&ball);
    ff_mesh_free(&body);
}

static void larger_colliders_make_the_cylinder_about_all_of_them_wider(void **state)
{
    (void)state;
    ff_pack_content content = {0};
    ff_error error;
    ff_pack_action *action = ff_array_grow(&content.actions, 1, sizeof *action);
    ff_pack_collider *at = ff_array_grow(&content.colliders, 2 * FF_COLLIDER_COUNT, sizeof *at);
    assert_true(action && at);
    memset(action, 0, sizeof *action);
    memset(at, 0, 2 * FF_COLLIDER_COUNT * sizeof *at);
    action->collider_samples = 2;
    at[FF_COLLIDER_COUNT + FF_COLLIDER_HAND_L].a = 3.0f; /* 5 m from the root of its own sample */
    at[FF_COLLIDER_COUNT + FF_COLLIDER_ROOT].b = 4.0f;
    const double radii[FF_COLLIDER_COUNT] = {0.1, 0.25, 0.25, 0.1, 0.1, 0.2};
    FF_ASSERT_OK(ff_pack_set_collider_radii(&content, radii, &error), error);
    FF_ASSERT_OK(ff_pack_set_collider_radii(&content, radii, &error), error);
    FF_ASSERT_NEAR((double)((ff_pack_action *)content.actions.data)->coarse_radius, 5.25, 1e-6);
    assert_int_equal(content.collider_radii.count, FF_COLLIDER_COUNT);
    ff_pack_content_free(&content);
}

static void characters_of_the_outside_data_stand_on_the_rig(void **state)
{
    (void)state;
    static const char *const files[] = {"boxman.glb", "cesium_man.gltf", "kaykit_knight.glb", "robot.glb"};
    if (!ff_shared_folder()) {
        print_message("SKIPPED the outside data is not here\n");
        skip();
    }
    ff_rig rig = usual_rig();
    for (size_t i = 0; i < sizeof files / sizeof files[0]; ++i) {
        char path[1024];
        ff_skin skin;
        ff_mesh mesh;
        ff_mesh_faults faults = {0};
        ff_error error;
        ff_load_options options = ff_load_options_default();
        double radius[FF_ROLE_JOINT_COUNT], low = 1e9, high = -1e9, left = 0.0, right = 0.0;
        snprintf(path, sizeof path, "%s/data/gltf/%s", ff_shared_folder(), files[i]);
        FF_ASSERT_OK(ff_skin_load(path, &options, &skin, &error), error);
        FF_ASSERT_OK(ff_mesh_fit(&skin, &rig, &mesh, radius, &error), error);
        FF_ASSERT_OK(ff_mesh_clean(&mesh, &faults, &error), error);
        for (int k = 0; k < mesh.vertex_count; ++k) {
            ff_vec3 at = mesh.vertices[k].at;
            low = ff_min(low, at.y), high = ff_max(high, at.y);
            left = ff_max(left, at.x), right = ff_min(right, at.x);
        }
        print_message("%s: %d vertices, %d triangles (left out: %d degenerate, %d repeated); %.2f m high, "
                      "arms %.2f m\n",
                      files[i], mesh.vertex_count, mesh.triangle_count, faults.degenerate, faults.repeated,
                      high, left - right);
        FF_ASSERT_NEAR(low, 0.0, 0.03);
        assert_true(high > 1.5 && high < 2.4);
        FF_ASSERT_NEAR(left, -right, 0.12);
        assert_true(left > 0.5); /* arms out */
        FF_ASSERT_NEAR(radius[FF_ROLE_HIP_L], radius[FF_ROLE_HIP_R], 0.03);
        ff_mesh_free(&mesh);
        ff_skin_free(&skin);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(degenerate_repeated_and_unused_parts_are_left_out),
        cmocka_unit_test(three_triangles_at_an_edge_are_taken_apart),
        cmocka_unit_test(a_ball_stays_a_ball_at_every_level),
        cmocka_unit_test(a_box_keeps_its_edges),
        cmocka_unit_test(a_person_of_tubes_is_fitted_back_and_as_thick_as_the_tubes),
        cmocka_unit_test(colliders_are_as_large_as_the_skin_about_them),
        cmocka_unit_test(larger_colliders_make_the_cylinder_about_all_of_them_wider),
        cmocka_unit_test(characters_of_the_outside_data_stand_on_the_rig),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
