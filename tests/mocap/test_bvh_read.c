/* The BVH reader against closed forms, and on files that are odd or wrong. */
#include "mocap/read.h"
#include "tests/mocap/matrix.h"

#include <stdio.h>

static ff_status parse_bytes(const char *text, size_t size, bool strict, ff_clip *clip, ff_error *error)
{
    ff_load_options options = ff_load_options_default();
    options.strict = strict;
    return ff_bvh_parse(text, size, "x.bvh", &options, clip, error);
}

static ff_clip parse(const char *text)
{
    ff_clip clip;
    ff_error error;
    FF_ASSERT_OK(parse_bytes(text, strlen(text), false, &clip, &error), error);
    return clip;
}

/* Two joints and a tip; every joint has its own order of channels, the second moves too. */
#define TWO_JOINTS                                                                                           \
    "HIERARCHY\nROOT Hips\n{\n OFFSET 1 2 3\n CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation " \
    "Zrotation\n"                                                                                            \
    " JOINT Arm\n {\n  OFFSET 0 10 0\n  CHANNELS 3 Zrotation Xrotation Yrotation\n"                          \
    "  End Site\n  {\n   OFFSET 0 0 5\n  }\n }\n}\n"

static void rotations_compose_in_the_order_of_the_channels(void **state)
{
    (void)state;
    ff_clip clip = parse(TWO_JOINTS "MOTION\nFrames: 2\nFrame Time: 0.01\n"
                                    "7 8 9 30 -40 50 10 200 -70\n-1 -2 -3 1000 0.5 -355 -1e1 +2.5E-1 .5\n");
    const double rows[2][9] = {{7, 8, 9, 30, -40, 50, 10, 200, -70},
                               {-1, -2, -3, 1000, 0.5, -355, -10, 0.25, 0.5}};
    assert_int_equal(clip.joint_count, 3);
    assert_int_equal(clip.frame_count, 2);
    for (int f = 0; f < 2; ++f) {
        const double *v = rows[f];
        matrix root = matrix_intrinsic("yxz", v[3], v[4], v[5]);
        matrix arm = matrix_times(root, matrix_intrinsic("zxy", v[6], v[7], v[8]));
        ff_vec3 hips = ff_v3(v[0], v[1], v[2]); /* positions replace the offset */
        ff_vec3 elbow = ff_add3(hips, matrix_apply(root, ff_v3(0, 10, 0)));
        ff_vec3 tip = ff_add3(elbow, matrix_apply(arm, ff_v3(0, 0, 5)));
        ff_vec3 at[3];
        ff_clip_pose(&clip, f, at, NULL);
        FF_ASSERT_AT(at[0], hips, 1e-12);
        FF_ASSERT_AT(at[1], elbow, 1e-12);
        FF_ASSERT_AT(at[2], tip, 1e-12);
    }
    assert_string_equal(clip.joints[2].name, "Arm_end");
    assert_true(clip.joints[2].end_site);
    assert_int_equal(clip.warning_count, 0);
    ff_clip_free(&clip);
}

static void any_subset_of_channels_in_any_mixture_is_honoured(void **state)
{
    (void)state;
    ff_clip clip = parse(
        "HIERARCHY ROOT a { OFFSET 1 1 1 CHANNELS 2 Zrotation Yposition\n"
        "JOINT b { OFFSET 2 0 0 CHANNELS 6 Xrotation Zposition Yrotation Xposition Zrotation Yposition\n"
        "JOINT c { OFFSET 0 3 0 CHANNELS 1 Xrotation } JOINT d { OFFSET 0 0 4 } } }\n"
        "ROOT e { OFFSET 9 9 9 CHANNELS 3 Xposition Yposition Zposition }\n"
        "MOTION\nFrames: 1\nFrame Time: 0.5\n90 5 10 7 20 6 30 8 -90 4 5 6\n");
    ff_vec3 at[5];
    ff_clip_pose(&clip, 0, at, NULL);
    matrix a = matrix_about('z', 90), b = matrix_times(a, matrix_intrinsic("xyz", 10, 20, 30));
    ff_vec3 at_a = ff_v3(1, 5, 1), at_b = ff_add3(at_a, matrix_apply(a, ff_v3(6, 8, 7)));
    FF_ASSERT_AT(at[0], at_a, 1e-12);
    FF_ASSERT_AT(at[1], at_b, 1e-12);
    FF_ASSERT_AT(at[2], ff_add3(at_b, matrix_apply(b, ff_v3(0, 3, 0))), 1e-12);
    FF_ASSERT_AT(at[3], ff_add3(at_b, matrix_apply(b, ff_v3(0, 0, 4))), 1e-12);
    FF_ASSERT_AT(at[4], ff_v3(4, 5, 6), 1e-12);
    assert_int_equal(clip.joints[4].parent, -1);
    assert_int_equal(clip.track_count, 3);
    ff_clip_free(&clip);
}

#define MOTION_2 "MOTION\nFrames: 2\nFrame Time: 0.01\n1 2 3 4 5 6 7 8 9\n1 2 3 4 5 6 7 8 10\n"

static void carriage_returns_tabs_blank_lines_marks_and_a_missing_last_newline_do_not_matter(void **state)
{
    (void)state;
    ff_clip plain = parse(TWO_JOINTS MOTION_2);
    static const char *const variants[] = {
        "\xef\xbb\xbf" TWO_JOINTS MOTION_2,
        TWO_JOINTS "MOTION\nFrames:\t2\nFrame Time:\t0.01\n\t1\t2  3 4 5 6 7 8 9 \t\n\n \n1 2 3 4 5 6 7 8 10",
        "hierarchy\r\nroot Hips\r\n{\r\n offset 1 2 3\r\n channels 6 XPOSITION yposition Zposition Yrotation "
        "Xrotation "
        "Zrotation\r\n joint Arm {\r\n OFFSET\t0 10 0\r\n CHANNELS 3 Zrotation\tXrotation Yrotation\r\n END "
        "SITE\r\n{ "
        "OFFSET 0 0 5 }\r\n}\r\n}\r\nmotion\r\nframes: 2\r\nframe time: 0.01\r\n1 2 3 4 5 6 7 8 9\r\n1 2 3 4 "
        "5 6 7 8 10\r\n",
    };
    for (size_t i = 0; i < sizeof variants / sizeof variants[0]; ++i) {
        ff_clip clip = parse(variants[i]);
        assert_int_equal(clip.frame_count, 2);
        assert_int_equal(clip.joint_count, 3);
        assert_int_equal(clip.warning_count, 0);
        assert_string_equal(clip.joints[0].name, "Hips");
        assert_memory_equal(clip.rotations, plain.rotations, 6 * sizeof(ff_quat));
        assert_memory_equal(clip.positions, plain.positions, 2 * sizeof(ff_vec3));
        ff_clip_free(&clip);
    }
    ff_clip_free(&plain);
}

/* What is worked around, and is an error in strict mode. */
static void oddities_are_counted_or_in_strict_mode_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int frames;
        const char *warning, *strict_place;
    } odd[] = {
        {TWO_JOINTS "MOTION\nFrames: 5\nFrame Time: 0.01\n1 2 3 4 5 6 7 8 9\n", 1,
         "line 20: 1 frames found, 5 announced; what is there is used", "x.bvh:20: "},
        {TWO_JOINTS "MOTION\nFrames: 1\nFrame Time: 0.01\n1 2 3 4 5 6 7 8 9\n1 2 3 4 5 6 7 8 9\n", 2,
         "line 21: 2 frames found, 1 announced; what is there is used", "x.bvh:21: "},
        {TWO_JOINTS "MOTION\nFrames: 2\nFrame Time: 0.01\n1 2 3 4 5 6 7 8 9\n1 2 3 4 5 6\n", 1,
         "line 20: the last row was cut off after 6 of 9 values; it is dropped", "x.bvh:20:12: "},
        {TWO_JOINTS "MOTION\nFrames: 2\nFrame Time: 0.01\n1 2 3 4 5 6 7 8 9\n1 2 3 4 5 6 7 -", 1,
         "line 20: the last row was cut off after 7 of 9 values; it is dropped", "x.bvh:20:15: "},
    };
    for (size_t i = 0; i < sizeof odd / sizeof odd[0]; ++i) {
        ff_clip clip = parse(odd[i].text);
        assert_int_equal(clip.frame_count, odd[i].frames);
        assert_true(clip.warning_count > 0);
        assert_string_equal(clip.warning, odd[i].warning);
        ff_clip_free(&clip);
        ff_error error;
        char text[1024];
        assert_int_equal(parse_bytes(odd[i].text, strlen(odd[i].text), true, &clip, &error), FF_ERR_PARSE);
        ff_error_text(&error, text, sizeof text);
        if (strncmp(text, odd[i].strict_place, strlen(odd[i].strict_place)) != 0) {
            print_error("%s, want place %s\n", text, odd[i].strict_place);
            fail();
        }
    }
}

#define HEAD "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n}\n"

static const struct {
    const char *text, *place;
    ff_status status;
} bad[] = {
    {"", "x.bvh:1:1: ", FF_ERR_NO_DATA},
    {"\x7f"
     "ELF\x01\x02",
     "x.bvh:1:1: ", FF_ERR_PARSE},
    {"HIERARCHY\n", "x.bvh:2:1: ", FF_ERR_PARSE},
    {"HIERARCHY\nMOTION\n", "x.bvh:2: ", FF_ERR_NO_DATA},
    {"HIERARCHY\nJOINT a\n{", "x.bvh:2:1: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT\n{", "x.bvh:2:5: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\nOFFSET 0 0 0\n", "x.bvh:3:1: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\n OFFSET 0 0\n", "x.bvh:4:12: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\n OFFSET 0 nan 0\n", "x.bvh:4:11: ", FF_ERR_NOT_FINITE},
    {"HIERARCHY\nROOT a\n{\n OFFSET 0 0 -inf\n", "x.bvh:4:13: ", FF_ERR_NOT_FINITE},
    {"HIERARCHY\nROOT a\n{\n OFFSET 0x1p3 0 0\n", "x.bvh:4:9: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\n OFFSET 1e30 0 0\n", "x.bvh:4:9: ", FF_ERR_RANGE},
    {"HIERARCHY\nROOT a\n{\n OFFSET 1e999 0 0\n", "x.bvh:4:9: ", FF_ERR_RANGE},
    {"HIERARCHY\nROOT a\n{\nCHANNELS 7 Xrotation\n", "x.bvh:4:10: ", FF_ERR_RANGE},
    {"HIERARCHY\nROOT a\n{\nCHANNELS -1\n", "x.bvh:4:10: ", FF_ERR_RANGE},
    {"HIERARCHY\nROOT a\n{\nCHANNELS 99999999999999999999 Xrotation\n", "x.bvh:4:10: ", FF_ERR_RANGE},
    {"HIERARCHY\nROOT a\n{\nCHANNELS three Xrotation\n", "x.bvh:4:10: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\nCHANNELS 2 Xrotation Wrotation\n", "x.bvh:4:22: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\nCHANNELS 2 Xrotation Xrotation\n", "x.bvh:4:22: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\nCHANNELS 1 Xrotation Yrotation\n", "x.bvh:4:22: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\nCHANNELS 1 Xrotation\nCHANNELS 1 Yrotation\n", "x.bvh:5:1: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\nROOT b\n{\n", "x.bvh:4:1: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\nEnd Site\n{\nJOINT b\n{\n", "x.bvh:6:1: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\nEnd Site\n{\nCHANNELS 1 Xrotation\n", "x.bvh:6:1: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\nEnd Point\n{\n", "x.bvh:4:5: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\n}\n}\n", "x.bvh:5:1: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\nMOTION\n", "x.bvh:4:1: ", FF_ERR_PARSE},
    {"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n}\nMOTION\nFrames: 1\n", "x.bvh:6: ", FF_ERR_NO_DATA},
    {HEAD "MOTION\n", "x.bvh:8:1: ", FF_ERR_PARSE},
    {HEAD "MOTION\nFrames 3\n", "x.bvh:8:1: ", FF_ERR_PARSE},
    {HEAD "MOTION\nFrames: -3\n", "x.bvh:8:9: ", FF_ERR_RANGE},
    {HEAD "MOTION\nFrames: 999999999999\n", "x.bvh:8:9: ", FF_ERR_RANGE},
    {HEAD "MOTION\nFrames: 9000000\nFrame Time: 0.01\n0 0 0\n", "x.bvh:8:9: ", FF_ERR_RANGE},
    {HEAD "MOTION\nFrames: 2.5\n", "x.bvh:8:9: ", FF_ERR_PARSE},
    {HEAD "MOTION\nFrames: 1\nFrame Rate: 30\n", "x.bvh:9:1: ", FF_ERR_PARSE},
    {HEAD "MOTION\nFrames: 1\nFrame Time: 0\n0 0 0\n", "x.bvh:9:13: ", FF_ERR_RANGE},
    {HEAD "MOTION\nFrames: 1\nFrame Time: -0.01\n0 0 0\n", "x.bvh:9:13: ", FF_ERR_RANGE},
    {HEAD "MOTION\nFrames: 1\nFrame Time: 33.3\n0 0 0\n", "x.bvh:9:13: ", FF_ERR_RANGE},
    {HEAD "MOTION\nFrames: 1\nFrame Time: nan\n0 0 0\n", "x.bvh:9:13: ", FF_ERR_NOT_FINITE},
    {HEAD "MOTION\nFrames: 0\nFrame Time: 0.01\n", "x.bvh:10: ", FF_ERR_NO_DATA},
    {HEAD "MOTION\nFrames: 2\nFrame Time: 0.01\n0 0\n0 0 0\n", "x.bvh:10:4: ", FF_ERR_PARSE},
    {HEAD "MOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0 0\n0 0 0\n", "x.bvh:10:7: ", FF_ERR_PARSE},
    {HEAD "MOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0\n0 0 nan\n", "x.bvh:11:5: ", FF_ERR_NOT_FINITE},
    {HEAD "MOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0\n0 inf 0\n", "x.bvh:11:3: ", FF_ERR_NOT_FINITE},
    {HEAD "MOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0\n0 0x2 0\n", "x.bvh:11:3: ", FF_ERR_PARSE},
    {HEAD "MOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0\n0 1,5 0\n", "x.bvh:11:3: ", FF_ERR_PARSE},
    {HEAD "MOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0\n0 1e300 0\n", "x.bvh:11:3: ", FF_ERR_RANGE},
    {HEAD "MOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0\n0 0 0\ngarbage\n", "x.bvh:12:1: ", FF_ERR_PARSE},
    {HEAD "MOTION\nFrames: 2\nFrame Time: 0.01\n0 0\n", "x.bvh:10:4: ", FF_ERR_PARSE},
};

static void wrong_files_are_refused_with_their_place(void **state)
{
    (void)state;
    int wrong = 0;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        ff_clip clip;
        ff_error error;
        char text[1024] = "read without complaint";
        ff_status status = parse_bytes(bad[i].text, strlen(bad[i].text), false, &clip, &error);
        if (status != FF_OK) ff_error_text(&error, text, sizeof text);
        if (status != bad[i].status || strncmp(text, bad[i].place, strlen(bad[i].place)) != 0) {
            print_error("case %zu: %s (%s), want %s (%s)\n", i, text, ff_status_name(status), bad[i].place,
                        ff_status_name(bad[i].status));
            ++wrong;
        }
        assert_null(clip.joints);
    }
    assert_int_equal(wrong, 0);
}

static void too_many_joints_and_endless_depth_are_refused(void **state)
{
    (void)state;
    enum { JOINTS = 100000 };
    char *text = malloc(JOINTS * 32 + 64), *p = text;
    assert_non_null(text);
    p += sprintf(p, "HIERARCHY\nROOT j\n{\n");
    for (int i = 1; i < JOINTS; ++i)
        p += sprintf(p, "JOINT j\n{\n");
    ff_clip clip;
    ff_error error;
    assert_int_equal(parse_bytes(text, (size_t)(p - text), false, &clip, &error), FF_ERR_RANGE);
    assert_int_equal(error.line, 2 + 2 * FF_CLIP_MAX_JOINTS);
    free(text);
}

static void zero_bytes_and_control_characters_do_no_harm(void **state)
{
    (void)state;
    char text[] = HEAD "MOTION\nFrames: 1\nFrame Time: 0.01\n0 0 0\n";
    for (size_t i = 0; i + 1 < sizeof text; ++i)
        for (int c = 0; c < 3; ++c) {
            char changed[sizeof text];
            memcpy(changed, text, sizeof text);
            changed[i] = (char)(c == 0 ? 0 : (c == 1 ? 0x0b : 0xff));
            ff_clip clip;
            ff_error error;
            if (parse_bytes(changed, sizeof text - 1, false, &clip, &error) == FF_OK) ff_clip_free(&clip);
        }
}

static void every_truncation_is_read_or_refused(void **state)
{
    (void)state;
    const char text[] = TWO_JOINTS MOTION_2;
    for (size_t size = 0; size < sizeof text; ++size) {
        char *exact = malloc(size ? size : 1); /* so that a sanitizer sees any step beyond the end */
        assert_non_null(exact);
        memcpy(exact, text, size);
        ff_clip clip;
        ff_error error;
        if (parse_bytes(exact, size, false, &clip, &error) == FF_OK) {
            assert_in_range(clip.frame_count, 1, 2);
            ff_clip_free(&clip);
        }
        free(exact);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotations_compose_in_the_order_of_the_channels),
        cmocka_unit_test(any_subset_of_channels_in_any_mixture_is_honoured),
        cmocka_unit_test(carriage_returns_tabs_blank_lines_marks_and_a_missing_last_newline_do_not_matter),
        cmocka_unit_test(oddities_are_counted_or_in_strict_mode_refused),
        cmocka_unit_test(wrong_files_are_refused_with_their_place),
        cmocka_unit_test(too_many_joints_and_endless_depth_are_refused),
        cmocka_unit_test(zero_bytes_and_control_characters_do_no_harm),
        cmocka_unit_test(every_truncation_is_read_or_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
