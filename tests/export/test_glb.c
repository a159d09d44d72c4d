/* crowd.glb taken apart by hand: container, accessors within bounds, shared body, poses as recorded. */
#define _XOPEN_SOURCE 700 /* mkdtemp */

#include "runtime/export/glb.h"
#include "runtime/tool/json.h"
#include "tests/export/folder.h"
#include "tests/export/walker.h"

typedef struct document {
    ff_file file;
    ff_json json;
    const unsigned char *binary;
    size_t binary_size;
    ff_scene scene;
    ff_recording recording;
} document;

static uint32_t word_at(const char *data, size_t at)
{
    uint32_t word;
    memcpy(&word, data + at, sizeof word);
    return word;
}

static int open_document(void **state)
{
    static document d;
    ff_error error;
    ff_figure figure;
    if (folder_create(state) != 0) return -1;
    walker_figure(&figure);
    walker_scene("{\"kind\": \"circle\", \"agents\": 6, \"walls\": [[-9, -9, 9, -9]], \"obstacles\": ["
                 "{\"position\": [2.2, 9], \"length\": 1.2, \"width\": 0.6, \"radius\": 0, \"high\": 1.5}, "
                 "{\"radius\": 0.3, \"low\": 1, \"high\": 1.5, \"path\": [[-20, 9, 0], [-16, 17, 2]]}]}",
                 &d.scene);
    walker_record(&d.scene, 1.0, &d.recording);
    FF_ASSERT_OK(ff_glb_write(folder_path("crowd.glb"), &figure, &d.scene, &d.recording, &error), error);
    d.file = folder_read("crowd.glb");
    assert_true(d.file.size > 28);
    assert_int_equal(word_at(d.file.data, 0), 0x46546C67);
    assert_int_equal(word_at(d.file.data, 4), 2);
    assert_int_equal(word_at(d.file.data, 8), d.file.size);
    uint32_t text_size = word_at(d.file.data, 12);
    assert_int_equal(word_at(d.file.data, 16), 0x4E4F534A);
    assert_int_equal(text_size % 4, 0);
    FF_ASSERT_OK(ff_json_parse(d.file.data + 20, text_size, "crowd.glb", &d.json, &error), error);
    d.binary_size = word_at(d.file.data, 20 + text_size);
    assert_int_equal(word_at(d.file.data, 24 + text_size), 0x004E4942);
    d.binary = (const unsigned char *)d.file.data + 28 + text_size;
    assert_int_equal(28 + text_size + d.binary_size, d.file.size);
    *state = &d;
    return 0;
}

static int close_document(void **state)
{
    static const char *const names[] = {"crowd.glb", NULL};
    document *d = *state;
    ff_file_unmap(&d->file);
    ff_json_free(&d->json);
    ff_recording_free(&d->recording);
    ff_scene_free(&d->scene);
    return folder_remove(names);
}

static json_int_t integer(const json_t *object, const char *key)
{
    return json_integer_value(json_object_get(object, key));
}

static const json_t *list(const document *d, const char *key)
{
    return json_object_get(d->json.root, key);
}

static size_t accessor_bytes(const json_t *accessor)
{
    const char *type = json_string_value(json_object_get(accessor, "type"));
    size_t width = strcmp(type, "SCALAR") == 0 ? 1
                   : strcmp(type, "VEC3") == 0 ? 3
                   : strcmp(type, "VEC4") == 0 ? 4
                                               : 16;
    json_int_t component = integer(accessor, "componentType");
    size_t each = component == 5121 ? 1 : component == 5122 ? 2 : 4;
    return width * each;
}

static void test_every_accessor_lies_inside_its_view_and_every_view_inside_the_file(void **state)
{
    const document *d = *state;
    const json_t *views = list(d, "bufferViews"), *accessors = list(d, "accessors");
    size_t index;
    const json_t *item;
    json_array_foreach((json_t *)views, index, item)
    {
        json_int_t offset = integer(item, "byteOffset"), length = integer(item, "byteLength");
        assert_int_equal(offset % 4, 0);
        assert_true(length > 0 && (size_t)(offset + length) <= d->binary_size);
    }
    json_array_foreach((json_t *)accessors, index, item)
    {
        const json_t *view = json_array_get(views, (size_t)integer(item, "bufferView"));
        size_t end =
            (size_t)integer(item, "byteOffset") + (size_t)integer(item, "count") * accessor_bytes(item);
        assert_non_null(view);
        assert_true(end <= (size_t)integer(view, "byteLength"));
    }
}

static void test_agents_share_vertices_and_bind_matrices(void **state)
{
    const document *d = *state;
    const json_t *skins = list(d, "skins"), *meshes = list(d, "meshes");
    assert_int_equal(json_array_size(skins), 6);
    for (size_t i = 1; i < 6; ++i) {
        const json_t *skin = json_array_get(skins, i);
        assert_int_equal(integer(skin, "inverseBindMatrices"),
                         integer(json_array_get(skins, 0), "inverseBindMatrices"));
        assert_int_equal(json_array_size(json_object_get(skin, "joints")), FF_JOINT_COUNT);
    }
    json_int_t shared = -1;
    size_t bodies = 0, m;
    const json_t *mesh;
    json_array_foreach((json_t *)meshes, m, mesh)
    {
        const json_t *primitives = json_object_get(mesh, "primitives");
        for (size_t p = 0; p < json_array_size(primitives); ++p) {
            const json_t *attributes = json_object_get(json_array_get(primitives, p), "attributes");
            if (!json_object_get(attributes, "JOINTS_0")) continue;
            if (shared < 0) shared = integer(attributes, "POSITION");
            assert_int_equal(integer(attributes, "POSITION"), shared);
            ++bodies;
        }
    }
    assert_true(bodies >= 5);
}

/* walker_record makes every second and third agent larger. */
static void test_bodies_of_other_sizes_have_their_hips_scaled(void **state)
{
    const document *d = *state;
    const json_t *skins = list(d, "skins"), *nodes = list(d, "nodes");
    for (size_t i = 0; i < json_array_size(skins); ++i) {
        const json_t *joints = json_object_get(json_array_get(skins, i), "joints");
        for (size_t j = 0; j < FF_JOINT_COUNT; ++j) {
            size_t node = (size_t)json_integer_value(json_array_get(joints, j));
            const json_t *scale = json_object_get(json_array_get(nodes, node), "scale");
            double want = j == 0 ? (double)(float)(1.0 + 0.05 * (double)(i % 3)) : 1.0;
            if (want == 1.0) assert_null(scale);
            for (size_t k = 0; k < 3 && want != 1.0; ++k)
                FF_ASSERT_NEAR(json_number_value(json_array_get(scale, k)), want, 1e-6);
        }
    }
}

static void test_only_joints_that_move_have_channels(void **state)
{
    const document *d = *state;
    const json_t *animation = json_array_get(list(d, "animations"), 0);
    /* Of the walker move: the hips' place; shoulders, thighs, shanks. And one obstacle. */
    assert_int_equal(json_array_size(json_object_get(animation, "channels")), 6 * (1 + 6) + 1);
}

static const void *accessor_data(const document *d, json_int_t index)
{
    const json_t *accessor = json_array_get(list(d, "accessors"), (size_t)index);
    const json_t *view = json_array_get(list(d, "bufferViews"), (size_t)integer(accessor, "bufferView"));
    return d->binary + integer(view, "byteOffset") + integer(accessor, "byteOffset");
}

static void test_hips_and_rotations_are_those_recorded(void **state)
{
    const document *d = *state;
    const json_t *animation = json_array_get(list(d, "animations"), 0);
    const json_t *channels = json_object_get(animation, "channels");
    const json_t *samplers = json_object_get(animation, "samplers");
    uint32_t agent = 0, places = 0;
    for (size_t c = 0; c < json_array_size(channels); ++c) {
        const json_t *channel = json_array_get(channels, c);
        const json_t *target = json_object_get(channel, "target");
        const json_t *sampler = json_array_get(samplers, (size_t)integer(channel, "sampler"));
        const json_t *node = json_array_get(list(d, "nodes"), (size_t)integer(target, "node"));
        const char *name = json_string_value(json_object_get(node, "name"));
        const void *data = accessor_data(d, integer(sampler, "output"));
        const float *times = accessor_data(d, integer(sampler, "input"));
        FF_ASSERT_NEAR((double)times[15], 0.5, 1e-6);
        if (strcmp(name, "hips") == 0) {
            agent = places++; /* an agent's first channel */
            assert_memory_equal((const float *)data + 3 * 15, ff_recording_raw_hips(&d->recording, 15, agent),
                                12);
        } else if (strcmp(name, "left hip") == 0) {
            assert_memory_equal((const int16_t *)data + 4 * 15,
                                ff_recording_raw_rotations(&d->recording, 15, agent)[FF_JOINT_HIP_L], 8);
        }
    }
    assert_int_equal(places, 6);
}

/* A reader of the file alone: where a node is in the rest pose, going down from the top of the scene. */
static bool find_rest(const document *d, json_int_t from, json_int_t wanted, ff_vec3 at, ff_vec3 *out)
{
    const json_t *node = json_array_get(list(d, "nodes"), (size_t)from);
    const json_t *translation = json_object_get(node, "translation"),
                 *children = json_object_get(node, "children");
    if (translation)
        at = ff_add3(at, ff_v3(json_number_value(json_array_get(translation, 0)),
                               json_number_value(json_array_get(translation, 1)),
                               json_number_value(json_array_get(translation, 2))));
    *out = at;
    if (from == wanted) return true;
    for (size_t i = 0; i < json_array_size(children); ++i)
        if (find_rest(d, json_integer_value(json_array_get(children, i)), wanted, at, out)) return true;
    return false;
}

static void test_bind_matrices_undo_the_rest_pose_of_every_skeleton(void **state)
{
    const document *d = *state;
    const json_t *roots = json_object_get(json_array_get(list(d, "scenes"), 0), "nodes");
    for (size_t s = 0; s < 6; ++s) {
        const json_t *skin = json_array_get(list(d, "skins"), s), *joints = json_object_get(skin, "joints");
        const float *binds = accessor_data(d, integer(skin, "inverseBindMatrices"));
        for (size_t j = 0; j < FF_JOINT_COUNT; ++j) {
            json_int_t node = json_integer_value(json_array_get(joints, j));
            ff_vec3 rest = {0};
            bool found = false;
            for (size_t r = 0; r < json_array_size(roots) && !found; ++r)
                found =
                    find_rest(d, json_integer_value(json_array_get(roots, r)), node, ff_v3(0, 0, 0), &rest);
            assert_true(found);
            FF_ASSERT_NEAR((double)binds[16 * j + 12], -rest.x, 1e-6);
            FF_ASSERT_NEAR((double)binds[16 * j + 13], -rest.y, 1e-6);
            FF_ASSERT_NEAR((double)binds[16 * j + 14], -rest.z, 1e-6);
            FF_ASSERT_NEAR((double)binds[16 * j + 15], 1.0, 0.0);
        }
    }
}

static json_int_t named(const document *d, const char *name)
{
    size_t index;
    const json_t *node;
    json_array_foreach((json_t *)list(d, "nodes"), index, node)
    {
        if (strcmp(json_string_value(json_object_get(node, "name")), name) == 0) return (json_int_t)index;
    }
    fail_msg("no node is named '%s'", name);
    return -1;
}

static ff_vec3 vector_at(const float *values, size_t index)
{
    return ff_v3((double)values[3 * index], (double)values[3 * index + 1], (double)values[3 * index + 2]);
}

/* Of the triangles of a node's mesh, signed: outward faces all around count what they enclose (divergence theorem). */
static double volume_of(const document *d, json_int_t node, double low[3], double high[3])
{
    const json_t *mesh = json_array_get(
        list(d, "meshes"), (size_t)integer(json_array_get(list(d, "nodes"), (size_t)node), "mesh"));
    const json_t *primitive = json_array_get(json_object_get(mesh, "primitives"), 0);
    json_int_t indices = integer(primitive, "indices");
    const json_t *attributes = json_object_get(primitive, "attributes");
    const float *at = accessor_data(d, integer(attributes, "POSITION"));
    const float *normal = accessor_data(d, integer(attributes, "NORMAL"));
    const uint32_t *corner = accessor_data(d, indices);
    size_t count = (size_t)integer(json_array_get(list(d, "accessors"), (size_t)indices), "count");
    double volume = 0.0;
    for (size_t t = 0; t < count; t += 3) {
        ff_vec3 p[3], n = vector_at(normal, corner[t]);
        for (size_t c = 0; c < 3; ++c) {
            p[c] = vector_at(at, corner[t + c]);
            const double v[3] = {p[c].x, p[c].y, p[c].z};
            for (int k = 0; k < 3; ++k) {
                low[k] = ff_min(low[k], v[k]);
                high[k] = ff_max(high[k], v[k]);
            }
        }
        ff_vec3 across = ff_cross3(ff_sub3(p[1], p[0]), ff_sub3(p[2], p[0]));
        assert_true(ff_dot3(across, n) > 0.99 * sqrt(ff_dot3(across, across)));
        volume += ff_dot3(p[0], ff_cross3(p[1], p[2])) / 6.0;
    }
    return volume;
}

static void test_obstacles_are_solids_where_the_scene_has_them(void **state)
{
    const document *d = *state;
    double low[3] = {9, 9, 9}, high[3] = {-9, -9, -9};
    json_int_t box = named(d, "obstacle 0"), bar = named(d, "obstacle 1");
    const json_t *at = json_object_get(json_array_get(list(d, "nodes"), (size_t)box), "translation");
    FF_ASSERT_NEAR(json_number_value(json_array_get(at, 0)), 2.2, 1e-6);
    FF_ASSERT_NEAR(json_number_value(json_array_get(at, 2)), 9.0, 1e-6);
    /* It stands on the ground, where nobody sees its underside: the missing lid at height 0 adds nothing. */
    FF_ASSERT_NEAR(volume_of(d, box, low, high), 1.2 * 0.6 * 1.5, 1e-6);
    const double wide[3] = {0.3, 0.75, 0.6}; /* length along z */
    for (int k = 0; k < 3; ++k)
        FF_ASSERT_NEAR(0.5 * (high[k] - low[k]), wide[k], 1e-6);
    FF_ASSERT_NEAR(low[1], 0.0, 1e-6);
    /* A disc's outline has twelve corners, 30 degrees apart; this one hangs, and is closed. */
    FF_ASSERT_NEAR(volume_of(d, bar, low, high), 0.5 * 12.0 * 0.3 * 0.3 * 0.5 * 0.5, 1e-6);
}

static void test_an_obstacle_on_a_path_moves_as_the_scene_says(void **state)
{
    const document *d = *state;
    const json_t *animation = json_array_get(list(d, "animations"), 0), *channel;
    json_int_t bar = named(d, "obstacle 1");
    size_t c, found = 0;
    json_array_foreach(json_object_get(animation, "channels"), c, channel)
    {
        const json_t *target = json_object_get(channel, "target");
        if (integer(target, "node") != bar) continue;
        const json_t *sampler =
            json_array_get(json_object_get(animation, "samplers"), (size_t)integer(channel, "sampler"));
        const float *places = accessor_data(d, integer(sampler, "output"));
        const float *times = accessor_data(d, integer(sampler, "input"));
        assert_string_equal(json_string_value(json_object_get(target, "path")), "translation");
        for (size_t k = 0; k <= 30; k += 15) { /* from (-20, 9) to (-16, 17) in 2 s */
            ff_vec3 place = vector_at(places, k);
            FF_ASSERT_NEAR(place.x, -20.0 + 2.0 * (double)times[k], 1e-5);
            FF_ASSERT_NEAR(place.y, 0.0, 0.0);
            FF_ASSERT_NEAR(place.z, 9.0 + 4.0 * (double)times[k], 1e-5);
        }
        ++found;
    }
    assert_int_equal(found, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_accessor_lies_inside_its_view_and_every_view_inside_the_file),
        cmocka_unit_test(test_agents_share_vertices_and_bind_matrices),
        cmocka_unit_test(test_bind_matrices_undo_the_rest_pose_of_every_skeleton),
        cmocka_unit_test(test_bodies_of_other_sizes_have_their_hips_scaled),
        cmocka_unit_test(test_only_joints_that_move_have_channels),
        cmocka_unit_test(test_hips_and_rotations_are_those_recorded),
        cmocka_unit_test(test_obstacles_are_solids_where_the_scene_has_them),
        cmocka_unit_test(test_an_obstacle_on_a_path_moves_as_the_scene_says),
    };
    return cmocka_run_group_tests(tests, open_document, close_document);
}
