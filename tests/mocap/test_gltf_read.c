/* The glTF reader on hand-made files, against closed forms. */
#define _POSIX_C_SOURCE 200809L
#include "mocap/read.h"
#include "tests/folder.h"
#include "tests/mocap/gltf_make.h"

#include <sys/stat.h>
#include <unistd.h>

static char json[32768];
static unsigned char glb[65536];

static const float second[2] = {0.0f, 1.0f};
/* Quarter turn about z. */
static const float quarter[8] = {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.70710678f, 0.70710678f};

/* One animation of one channel, on node 0, of a chain whose node 1 is at (1, 0, 0) from node 0. */
static const char chain[] =
    "\"nodes\":[{\"name\":\"a\",\"children\":[1]},{\"name\":\"b\",\"translation\":[1,0,0]}],"
    "\"animations\":[{\"name\":\"move\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,"
    "\"path\":\"%s\"}}],\"samplers\":[{\"input\":%d,\"output\":%d,\"interpolation\":\"%s\"}]}]";

static ff_clip load_made(const gltf_made *made, const char *rest)
{
    ff_load_options options = ff_load_options_default();
    ff_clip clip;
    ff_error error;
    made_json(made, "", rest, json, sizeof json);
    size_t size = made_glb(json, made, glb);
    FF_ASSERT_OK(ff_gltf_parse((const char *)glb, size, "made.glb", NULL, &options, &clip, &error), error);
    return clip;
}

static ff_clip load_chain(const gltf_made *made, const char *path, int input, int output,
                          const char *interpolation)
{
    char rest[1024];
    snprintf(rest, sizeof rest, chain, path, input, output, interpolation);
    return load_made(made, rest);
}

static void assert_at(const ff_clip *clip, int frame, const char *joint, double x, double y, double z)
{
    ff_vec3 at[64];
    ff_clip_pose(clip, frame, at, NULL);
    for (int j = 0; j < clip->joint_count; ++j) {
        if (strcmp(clip->joints[j].name, joint) != 0) continue;
        FF_ASSERT_NEAR(at[j].x, x, 1e-6);
        FF_ASSERT_NEAR(at[j].y, y, 1e-6);
        FF_ASSERT_NEAR(at[j].z, z, 1e-6);
        return;
    }
    fail_msg("no joint %s", joint);
}

static void linear_rotations_are_slerped_and_sixty_frames_a_second(void **state)
{
    (void)state;
    gltf_made made = {0};
    int input = made_floats(&made, second, 1, 2), output = made_floats(&made, quarter, 4, 2);
    ff_clip clip = load_chain(&made, "rotation", input, output, "LINEAR");
    assert_int_equal(clip.frame_count, 61);
    FF_ASSERT_NEAR(clip.frame_time, 1.0 / 60.0, 1e-12);
    for (int k = 0; k < 61; ++k)
        assert_at(&clip, k, "b", cos(FF_PI / 2 * k / 60.0), sin(FF_PI / 2 * k / 60.0), 0.0);
    ff_clip_free(&clip);
}

static void linear_rotations_take_the_shorter_way(void **state)
{
    (void)state;
    gltf_made made = {0};
    float far[8];
    for (int i = 0; i < 8; ++i)
        far[i] = i < 4 ? quarter[i] : -quarter[i]; /* the same rotation by its other quaternion */
    int input = made_floats(&made, second, 1, 2), output = made_floats(&made, far, 4, 2);
    ff_clip clip = load_chain(&made, "rotation", input, output, "LINEAR");
    assert_at(&clip, 30, "b", cos(FF_PI / 4), sin(FF_PI / 4), 0.0);
    ff_clip_free(&clip);
}

static void steps_hold_until_the_next_key(void **state)
{
    (void)state;
    gltf_made made = {0};
    const float places[6] = {0.0f, 0.0f, 0.0f, 3.0f, 4.0f, 5.0f};
    int input = made_floats(&made, second, 1, 2), output = made_floats(&made, places, 3, 2);
    ff_clip clip = load_chain(&made, "translation", input, output, "STEP");
    assert_at(&clip, 0, "b", 1.0, 0.0, 0.0);
    assert_at(&clip, 59, "b", 1.0, 0.0, 0.0);
    assert_at(&clip, 60, "b", 4.0, 4.0, 5.0);
    ff_clip_free(&clip);
}

/* Any cubic is its own Hermite spline: keys at uneven times must give it back everywhere. */
static double cubic_of(double t)
{
    return 0.5 * t * t * t - 2.0 * t * t + t + 0.25;
}
static double slope_of(double t)
{
    return 1.5 * t * t - 4.0 * t + 1.0;
}

static void cubic_splines_give_a_cubic_back(void **state)
{
    (void)state;
    gltf_made made = {0};
    const float times[3] = {0.0f, 0.5f, 2.0f};
    float keys[27] = {0};
    for (int i = 0; i < 3; ++i) {
        keys[9 * i] = keys[9 * i + 6] = (float)slope_of((double)times[i]);
        keys[9 * i + 3] = (float)cubic_of((double)times[i]);
        keys[9 * i + 4] = 7.0f;
    }
    int input = made_floats(&made, times, 1, 3), output = made_floats(&made, keys, 3, 9);
    ff_clip clip = load_chain(&made, "translation", input, output, "CUBICSPLINE");
    assert_int_equal(clip.frame_count, 121);
    for (int k = 0; k < 121; ++k)
        assert_at(&clip, k, "a", cubic_of(k / 60.0), 7.0, 0.0);
    ff_clip_free(&clip);
}

/* The same spline as a Bezier curve by de Casteljau's construction, then made a unit quaternion. */
static ff_quat bezier(const float keys[24], double t)
{
    double p[4], out[4];
    for (int i = 0; i < 4; ++i) {
        double from = (double)keys[4 + i], to = (double)keys[16 + i];
        p[0] = from, p[1] = from + (double)keys[8 + i] / 3.0, p[2] = to - (double)keys[12 + i] / 3.0,
        p[3] = to;
        for (int n = 3; n > 0; --n)
            for (int k = 0; k < n; ++k)
                p[k] = (1.0 - t) * p[k] + t * p[k + 1];
        out[i] = p[0];
    }
    return ff_quat_unit((ff_quat){out[0], out[1], out[2], out[3]});
}

static void cubic_splines_of_rotations_are_made_unit(void **state)
{
    (void)state;
    gltf_made made = {0};
    float keys[24] = {0};
    memcpy(keys + 4, quarter, 4 * sizeof *keys);
    memcpy(keys + 16, quarter + 4, 4 * sizeof *keys);
    keys[8] = 1.5f, keys[10] = -0.7f, keys[13] = 0.9f, keys[15] = -0.4f;
    int input = made_floats(&made, second, 1, 2), output = made_floats(&made, keys, 4, 6);
    ff_clip clip = load_chain(&made, "rotation", input, output, "CUBICSPLINE");
    for (int k = 0; k < 61; ++k) {
        ff_vec3 want = ff_quat_rotate(bezier(keys, k / 60.0), ff_v3(1.0, 0.0, 0.0));
        assert_at(&clip, k, "b", want.x, want.y, want.z);
    }
    ff_clip_free(&clip);
}

static void normalised_integers_are_fractions(void **state)
{
    (void)state;
    const int16_t words[8] = {0, 0, 0, 32767, 0, 0, 23170, 23170};
    const int8_t bytes[8] = {0, 0, 0, 127, 0, 0, 90, 90};
    const uint16_t places[6] = {0, 0, 0, 65535, 13107, 0};
    gltf_made made = {0};
    int input = made_floats(&made, second, 1, 2);
    int word = made_numbers(&made, words, sizeof words, 5122, "VEC4", 2, ",\"normalized\":true");
    int byte = made_numbers(&made, bytes, sizeof bytes, 5120, "VEC4", 2, ",\"normalized\":true");
    int place = made_numbers(&made, places, sizeof places, 5123, "VEC3", 2, ",\"normalized\":true");
    ff_clip clip = load_chain(&made, "rotation", input, word, "LINEAR");
    assert_at(&clip, 60, "b", 0.0, 1.0, 0.0);
    ff_clip_free(&clip);
    clip = load_chain(&made, "rotation", input, byte, "LINEAR");
    assert_at(&clip, 60, "b", 0.0, 1.0, 0.0);
    ff_clip_free(&clip);
    clip = load_chain(&made, "translation", input, place, "LINEAR");
    assert_at(&clip, 60, "a", 1.0, 0.2, 0.0);
    ff_clip_free(&clip);
}

static void sparse_accessors_replace_elements(void **state)
{
    (void)state;
    gltf_made made = {0};
    const float times[3] = {0.0f, 0.5f, 1.0f}, zeros[9] = {1.0f, 2.0f, 3.0f},
                places[6] = {0.0f, 5.0f, 0.0f, 6.0f, 0.0f, 8.0f};
    const uint8_t which[4] = {1, 2};
    int input = made_floats(&made, times, 1, 3);
    int base = made_view(&made, zeros, sizeof zeros), index = made_view(&made, which, 2);
    int value = made_view(&made, places, sizeof places);
    for (int dense = 0; dense < 2; ++dense) {
        char accessor[512], view[64] = "";
        if (dense) snprintf(view, sizeof view, "\"bufferView\":%d,", base);
        snprintf(accessor, sizeof accessor,
                 "%s\"componentType\":5126,\"type\":\"VEC3\",\"count\":3,\"sparse\":{\"count\":2,\"indices\":"
                 "{\"bufferView\":%d,"
                 "\"componentType\":5121},\"values\":{\"bufferView\":%d}}",
                 view, index, value);
        ff_clip clip = load_chain(&made, "translation", input, made_accessor(&made, accessor), "LINEAR");
        assert_at(&clip, 0, "a", dense ? 1.0 : 0.0, dense ? 2.0 : 0.0, dense ? 3.0 : 0.0);
        assert_at(&clip, 30, "a", 0.0, 5.0, 0.0);
        assert_at(&clip, 45, "a", 3.0, 2.5, 4.0);
        assert_at(&clip, 60, "a", 6.0, 0.0, 8.0);
        ff_clip_free(&clip);
    }
}

/* An armature in centimetres with z up, as Blender and others write them, with a matrix on the way. */
static void what_stands_above_the_skeleton_is_folded_in(void **state)
{
    (void)state;
    gltf_made made = {0};
    int input = made_floats(&made, second, 1, 2), output = made_floats(&made, quarter, 4, 2);
    char rest[2048];
    snprintf(rest, sizeof rest,
             "\"nodes\":[{\"children\":[1],\"rotation\":[-0.70710678118654752,0,0,0.70710678118654752],"
             "\"scale\":[0.01,0.01,0.01]},"
             "{\"children\":[2],\"matrix\":[0,2,0,0,-2,0,0,0,0,0,2,0,10,20,30,1]},"
             "{\"name\":\"hips\",\"children\":[3],\"translation\":[0,0,90]},"
             "{\"name\":\"idle\",\"children\":[4],\"translation\":[5,0,0],\"rotation\":[0,0,1,0],\"scale\":["
             "3,3,3]},"
             "{\"name\":\"toe\",\"translation\":[1,0,0]}],"
             "\"skins\":[{\"joints\":[2,3,4]}],"
             "\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":2,\"path\":\"rotation\"}}],"
             "\"samplers\":[{\"input\":%d,\"output\":%d}]}]",
             input, output);
    ff_clip clip = load_made(&made, rest);
    assert_int_equal(clip.joint_count, 3);
    for (int k = 0; k < 61; k += 6) {
        /* In the armature, before 0.01 and (x, y, z) -> (x, z, -y): the matrix doubles, turns (x, y) -> (-y, x), moves. */
        double turn = FF_PI / 2 * k / 60.0, c = cos(turn), s = sin(turn);
        assert_at(&clip, k, "hips", 0.10, 2.10, -0.20);
        double x = 5.0 * c, y = 5.0 * s;
        assert_at(&clip, k, "idle", 0.01 * (10.0 - 2.0 * y), 2.10, -0.01 * (20.0 + 2.0 * x));
        x += -3.0 * c, y += -3.0 * s; /* half a turn and three times as large */
        assert_at(&clip, k, "toe", 0.01 * (10.0 - 2.0 * y), 2.10, -0.01 * (20.0 + 2.0 * x));
    }
    assert_int_equal(clip.track_count, 1); /* only the root's: bones keep their lengths */
    ff_clip_free(&clip);
}

static void scales_that_change_are_warned_about(void **state)
{
    (void)state;
    gltf_made made = {0};
    const float same[6] = {2.0f, 2.0f, 2.0f, 2.0f, 2.0f, 2.0f},
                grows[6] = {1.0f, 1.0f, 1.0f, 2.0f, 2.0f, 2.0f};
    int input = made_floats(&made, second, 1, 2), still = made_floats(&made, same, 3, 2),
        grow = made_floats(&made, grows, 3, 2);
    ff_clip clip = load_chain(&made, "scale", input, still, "LINEAR");
    assert_int_equal(clip.warning_count, 0);
    assert_at(&clip, 30, "b", 2.0, 0.0, 0.0);
    ff_clip_free(&clip);
    clip = load_chain(&made, "scale", input, grow, "LINEAR");
    assert_int_equal(clip.warning_count, 1);
    assert_at(&clip, 30, "b", 1.5, 0.0, 0.0);
    ff_clip_free(&clip);
}

/* The pose that the skin was bound in is the clip's rest pose, in whatever pose the file leaves its nodes. */
static void the_pose_of_the_bind_is_the_rest_pose(void **state)
{
    (void)state;
    gltf_made made = {0};
    const float inverse[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1,
                               1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2, 0, 1};
    int input = made_floats(&made, second, 1, 2), output = made_floats(&made, quarter, 4, 2);
    int bind = made_floats(&made, inverse, 16, 2);
    char rest[1024];
    snprintf(rest, sizeof rest,
             "\"nodes\":[{\"name\":\"a\",\"children\":[1],\"translation\":[0,1,0]},"
             "{\"name\":\"b\",\"translation\":[0,1,0],\"rotation\":[0.6,0,0,0.8]}],"
             "\"skins\":[{\"joints\":[0,1],\"inverseBindMatrices\":%d}],\"animations\":[{\"channels\":[{"
             "\"sampler\":0,"
             "\"target\":{\"node\":0,\"path\":\"rotation\"}}],\"samplers\":[{\"input\":%d,\"output\":%d}]}]",
             bind, input, output);
    ff_clip clip = load_made(&made, rest);
    ff_vec3 at[2];
    ff_clip_rest_pose(&clip, at);
    FF_ASSERT_NEAR(at[0].y, 1.0, 1e-6);
    FF_ASSERT_NEAR(at[1].y, 2.0, 1e-6);
    ff_quat b = clip.rotations[1], want = ff_quat_unit((ff_quat){0.6, 0.0, 0.0, 0.8});
    FF_ASSERT_NEAR(fabs(ff_quat_dot(b, want)), 1.0, 1e-9);
    assert_at(&clip, 60, "b", -1.0, 1.0, 0.0);
    ff_clip_free(&clip);
}

/* --------------------------------------------------------------------------------------------- files and buffers */

static char folder[256];

static int make_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/footfall-gltf-XXXXXX");
    char path[512];
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/in", folder);
    return mkdir(path, 0777);
}

static int remove_folder(void **state)
{
    (void)state;
    return ff_remove_tree(folder);
}

static void write_file(const char *name, const void *data, size_t size)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    fclose(file);
}

static ff_status load_file(const char *name, ff_clip *clip, ff_error *error)
{
    char path[512];
    ff_load_options options = ff_load_options_default();
    options.unit_m = 1.0;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return ff_clip_load(path, &options, clip, error);
}

static void write_chain(gltf_made *made, const char *uri)
{
    char rest[1024];
    *made = (gltf_made){0};
    int input = made_floats(made, second, 1, 2), output = made_floats(made, quarter, 4, 2);
    snprintf(rest, sizeof rest, chain, "rotation", input, output, "LINEAR");
    made_json(made, uri, rest, json, sizeof json);
    write_file("in/made.gltf", json, strlen(json));
}

static void buffers_may_lie_beside_the_file_or_in_it(void **state)
{
    (void)state;
    gltf_made made;
    ff_clip clip;
    ff_error error;
    char path[512], text[8192] = "data:application/gltf-buffer;base64,", link[600];
    write_chain(&made, "with%20blank.bin");
    write_file("in/with blank.bin", made.bytes, made.size);
    FF_ASSERT_OK(load_file("in/made.gltf", &clip, &error), error);
    assert_string_equal(clip.name, "made");
    assert_at(&clip, 60, "b", 0.0, 1.0, 0.0);
    ff_clip_free(&clip);

    made_base64(&made, text + strlen(text));
    write_chain(&made, text);
    FF_ASSERT_OK(load_file("in/made.gltf#move", &clip, &error), error);
    assert_string_equal(clip.name, "made#move");
    assert_at(&clip, 60, "b", 0.0, 1.0, 0.0);
    ff_clip_free(&clip);

    snprintf(path, sizeof path, "%s/in/sub", folder);
    assert_int_equal(mkdir(path, 0777), 0);
    snprintf(link, sizeof link, "%s/inside.bin", path);
    assert_int_equal(symlink("../with blank.bin", link), 0);
    write_chain(&made, "./sub/inside.bin");
    FF_ASSERT_OK(load_file("in/made.gltf#0", &clip, &error), error);
    ff_clip_free(&clip);
}

static void buffers_outside_the_files_folder_are_never_read(void **state)
{
    (void)state;
    static const char *const escapes[] = {"../secret.bin",
                                          "%2e%2e/secret.bin",
                                          "sub/../../secret.bin",
                                          "..%2Fsecret.bin",
                                          ".//..//secret.bin",
                                          "/etc/passwd",
                                          "file:///etc/passwd",
                                          "..\\\\secret.bin",
                                          "http://host/x.bin",
                                          "C:/secret.bin",
                                          "link.bin",
                                          "linked/secret.bin",
                                          "data:,hello",
                                          "data:text/plain;base64,%%%%",
                                          "absent.bin",
                                          "in%00.bin",
                                          "",
                                          "..",
                                          ".",
                                          "linked"};
    gltf_made made;
    char path[600], secret[512];
    ff_error error;
    ff_clip clip;
    write_chain(&made, "x");
    write_file("secret.bin", made.bytes, made.size); /* what a document gets hold of if it escapes */
    snprintf(secret, sizeof secret, "%s/secret.bin", folder);
    snprintf(path, sizeof path, "%s/in/link.bin", folder);
    assert_int_equal(symlink(secret, path), 0);
    snprintf(path, sizeof path, "%s/in/linked", folder);
    assert_int_equal(symlink(folder, path), 0);
    for (size_t i = 0; i < sizeof escapes / sizeof escapes[0]; ++i) {
        write_chain(&made, escapes[i]);
        ff_status status = load_file("in/made.gltf", &clip, &error);
        if (status == FF_OK) fail_msg("%s was read", escapes[i]);
        assert_non_null(strstr(error.file, "made.gltf"));
        assert_true(error.line == 1 && error.column > 0 && strstr(error.message, "buffers[0]"));
    }
}

/* ------------------------------------------------------------------------------------------------- wrong files */

/* What is put for one sound part of the chain, and a part of what the reader must say. */
static const struct {
    const char *from, *to, *says;
} wrong[] = {
    {"\"version\":\"2.0\"", "\"version\":\"1.0\"", "only version 2"},
    {"\"asset\"", "\"assets\"", "\"asset\" is missing"},
    {"\"children\":[1]", "\"children\":[0]", "two parents"},
    {"\"children\":[1]", "\"children\":[7]", "no such node"},
    {"\"children\":[1]", "\"children\":[-1]", "not negative"},
    {"\"children\":[1]", "\"children\":1", "children: expected a list"},
    {"\"name\":\"b\"", "\"children\":[0]", "own ancestors"},
    {"\"name\":\"b\"", "\"name\":7", "name: expected text"},
    {"\"translation\":[1,0,0]", "\"translation\":[1,0]", "2 numbers where 3 belong"},
    {"\"translation\":[1,0,0]", "\"translation\":[1,0,\"x\"]", "expected numbers"},
    {"\"translation\":[1,0,0]", "\"translation\":[1e300,0,0]", "from the origin"},
    {"\"translation\":[1,0,0]", "\"mesh\":3", "no such mesh"},
    {"\"input\":0", "\"input\":9", "names no accessor"},
    {"\"sampler\":0", "\"sampler\":4", "no sampler 4"},
    {"\"LINEAR\"", "\"MAGIC\"", "STEP, LINEAR or CUBICSPLINE"},
    {"\"LINEAR\"", "\"CUBICSPLINE\"", "need 6 values"},
    {"\"node\":0", "\"node\":12", "no node 12"},
    {"\"path\":\"rotation\"", "\"path\":\"translation\"", "of 3 numbers"},
    {"\"byteLength\":8}", "\"byteLength\":800}", "bufferViews[0]"},
    {"\"buffer\":0", "\"buffer\":2", "no buffer 2"},
    {"\"bufferView\":0", "\"bufferView\":5", "do not fit"},
    {"\"count\":2", "\"count\":2000000000", "do not fit"},
    {"\"count\":2", "\"count\":0", "holds nothing"},
    {"\"count\":2", "\"count\":2.5", "whole number"},
    {"\"componentType\":5126", "\"componentType\":5124", "componentType"},
    {"\"type\":\"SCALAR\"", "\"type\":\"SCALE\"", "accessor"},
    {"\"byteLength\":40", "\"byteLength\":4000", "no binary chunk"},
    {"\"byteLength\":40", "\"byteLength\":0", "empty"},
    {"\"animations\"", "\"extensionsRequired\":[\"EXT_meshopt_compression\"],\"animations\"",
     "not supported"},
    {"\"animations\"", "\"animation\"", "has no animation"},
    {"]}]}", "]}]", "not valid JSON"},
};

static void replace(const char *text, const char *from, const char *to, char *out)
{
    const char *at = strstr(text, from);
    assert_non_null(at);
    sprintf(out, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
}

static void wrong_documents_are_refused_with_what_is_wrong(void **state)
{
    (void)state;
    static char broken[32768];
    gltf_made made;
    ff_load_options options = ff_load_options_default();
    ff_clip clip;
    ff_error error;
    write_chain(&made, "");
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
        replace(json, wrong[i].from, wrong[i].to, broken);
        size_t size = made_glb(broken, &made, glb);
        ff_status status = ff_gltf_parse((const char *)glb, size, "wrong.glb", NULL, &options, &clip, &error);
        if (status == FF_OK || !strstr(error.message, wrong[i].says) || strcmp(error.file, "wrong.glb") != 0)
            fail_msg("%s: '%s' instead of '%s'", wrong[i].to, status == FF_OK ? "accepted" : error.message,
                     wrong[i].says);
    }
}

static void wrong_containers_are_refused_with_their_byte(void **state)
{
    (void)state;
    gltf_made made;
    ff_load_options options = ff_load_options_default();
    ff_clip clip;
    ff_error error;
    write_chain(&made, "");
    size_t size = made_glb(json, &made, glb);
    for (size_t cut = 0; cut < size; ++cut) {
        assert_true(ff_gltf_parse((const char *)glb, cut, "cut.glb", NULL, &options, &clip, &error) != FF_OK);
        assert_true(error.message[0] && (error.section[0] || error.line));
    }
    glb[4] = 1;
    assert_int_equal(ff_gltf_parse((const char *)glb, size, "old.glb", NULL, &options, &clip, &error),
                     FF_ERR_PARSE);
    assert_int_equal(error.byte_offset, 4);
}

static void keys_that_go_back_or_are_no_numbers_are_refused(void **state)
{
    (void)state;
    const float back[2] = {1.0f, 0.0f}, absurd[2] = {0.0f, 1e9f}, nan[2] = {0.0f, NAN};
    const float *times[3] = {back, absurd, nan};
    static const char *const says[3] = {"go back", "lasts", "nan"};
    for (int i = 0; i < 3; ++i) {
        char rest[1024];
        gltf_made made = {0};
        int input = made_floats(&made, times[i], 1, 2), output = made_floats(&made, quarter, 4, 2);
        snprintf(rest, sizeof rest, chain, "rotation", input, output, "LINEAR");
        made_json(&made, "", rest, json, sizeof json);
        size_t size = made_glb(json, &made, glb);
        ff_load_options options = ff_load_options_default();
        ff_clip clip;
        ff_error error;
        assert_true(ff_gltf_parse((const char *)glb, size, "keys.glb", NULL, &options, &clip, &error) !=
                    FF_OK);
        assert_non_null(strstr(error.message, says[i]));
    }
}

static void deep_documents_do_not_exhaust_the_stack(void **state)
{
    (void)state;
    size_t depth = 1 << 20, size = 0;
    char *text = malloc(2 * depth + 64);
    assert_non_null(text);
    size += (size_t)sprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"extras\":");
    memset(text + size, '[', depth);
    memset(text + size + depth, ']', depth);
    size += 2 * depth;
    text[size++] = '}';
    ff_load_options options = ff_load_options_default();
    ff_clip clip;
    ff_error error;
    assert_int_equal(ff_gltf_parse(text, size, "deep.gltf", NULL, &options, &clip, &error), FF_ERR_PARSE);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_rotations_are_slerped_and_sixty_frames_a_second),
        cmocka_unit_test(linear_rotations_take_the_shorter_way),
        cmocka_unit_test(steps_hold_until_the_next_key),
        cmocka_unit_test(cubic_splines_give_a_cubic_back),
        cmocka_unit_test(cubic_splines_of_rotations_are_made_unit),
        cmocka_unit_test(normalised_integers_are_fractions),
        cmocka_unit_test(sparse_accessors_replace_elements),
        cmocka_unit_test(what_stands_above_the_skeleton_is_folded_in),
        cmocka_unit_test(scales_that_change_are_warned_about),
        cmocka_unit_test(the_pose_of_the_bind_is_the_rest_pose),
        cmocka_unit_test(buffers_may_lie_beside_the_file_or_in_it),
        cmocka_unit_test(buffers_outside_the_files_folder_are_never_read),
        cmocka_unit_test(wrong_documents_are_refused_with_what_is_wrong),
        cmocka_unit_test(wrong_containers_are_refused_with_their_byte),
        cmocka_unit_test(keys_that_go_back_or_are_no_numbers_are_refused),
        cmocka_unit_test(deep_documents_do_not_exhaust_the_stack),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
