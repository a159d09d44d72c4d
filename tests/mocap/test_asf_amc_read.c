/* The ASF and AMC readers against closed forms, and on files that are odd or wrong. */
#include "mocap/read.h"
#include "tests/mocap/matrix.h"

/* root -> thigh -> shank (one dof) -> foot (two, radians of no axis), and a rigid bone beside; tips at foot and rib. */
#define SKELETON_UNITS(angle)                                                                                \
    "# made by hand\n:version 1.10\n:name test\n:units\n mass 1.0\n length 0.45\n angle " angle "\n"         \
    ":documentation\n begin here: any text\n:root\n order TX TY TZ RX RY RZ\n axis XYZ\n position 1 2 3\n"
#define SKELETON_BONES                                                                                       \
    ":bonedata\n begin\n id 1\n name thigh\n direction 0 -1 0\n length 4\n axis 0 0 20 XYZ\n dof rx ry rz\n" \
    " limits (-160.0 20.0)\n        (-70.0 70.0)\n        (-60.0 70.0)\n end\n"                              \
    " begin\n id 2\n name shank\n direction 0.6 -0.8 0\n length 5\n axis 10 -30 50 XYZ\n dof rx\n end\n"     \
    " begin\n id 3\n name foot\n direction 0 0 1\n length 2\n axis 90 5 0 ZXY\n dof rz rx\n limits (0 0)\n " \
    "(0 0)\n end\n"                                                                                          \
    " begin\n id 4\n name rib\n direction 1 0 0\n length 3\n axis 0 0 0 XYZ\n end\n"                         \
    ":hierarchy\n begin\n root rib thigh\n thigh shank\n shank foot\n end\n"
#define SKELETON SKELETON_UNITS("deg") " orientation 0 0 0\n" SKELETON_BONES

static ff_asf parse_asf(const char *text)
{
    ff_asf asf;
    ff_error error;
    FF_ASSERT_OK(ff_asf_parse(text, strlen(text), "x.asf", false, &asf, &error), error);
    return asf;
}

static ff_status parse_amc_bytes(const char *text, size_t size, bool strict, ff_clip *clip, ff_error *error)
{
    ff_asf asf = parse_asf(SKELETON);
    ff_load_options options = ff_load_options_default();
    options.strict = strict;
    ff_status status = ff_amc_parse(&asf, text, size, "x.amc", &options, clip, error);
    ff_asf_free(&asf);
    return status;
}

static ff_clip parse_amc(const char *text)
{
    ff_clip clip;
    ff_error error;
    FF_ASSERT_OK(parse_amc_bytes(text, strlen(text), false, &clip, &error), error);
    return clip;
}

/* "XYZ" a b c: about fixed x first. */
static matrix fixed_axes(const char *axes, double a, double b, double c)
{
    return matrix_times(matrix_times(matrix_about(axes[2], c), matrix_about(axes[1], b)),
                        matrix_about(axes[0], a));
}

/* A.2 word by word: G_bone = G_parent C M C^-1, end_bone = end_parent + G_bone (length direction). */
static void assert_pose_is_as_the_format_defines_it(const ff_clip *clip, int frame, const double *root,
                                                    const double *thigh, double shank, const double *foot)
{
    matrix g_root = fixed_axes("xyz", root[3], root[4], root[5]);
    matrix c_thigh = fixed_axes("xyz", 0, 0, 20), c_shank = fixed_axes("xyz", 10, -30, 50);
    matrix c_foot =
        matrix_times(matrix_times(matrix_about('y', 5), matrix_about('x', 90)), matrix_about('z', 0));
    matrix m_thigh = fixed_axes("xyz", thigh[0], thigh[1], thigh[2]), m_shank = matrix_about('x', shank);
    matrix m_foot = matrix_times(matrix_about('x', foot[1]), matrix_about('z', foot[0]));
    matrix g_thigh =
        matrix_times(g_root, matrix_times(matrix_times(c_thigh, m_thigh), matrix_transposed(c_thigh)));
    matrix g_shank =
        matrix_times(g_thigh, matrix_times(matrix_times(c_shank, m_shank), matrix_transposed(c_shank)));
    matrix g_foot =
        matrix_times(g_shank, matrix_times(matrix_times(c_foot, m_foot), matrix_transposed(c_foot)));
    ff_vec3 hips = ff_v3(1 + root[0], 2 + root[1], 3 + root[2]);
    ff_vec3 knee = ff_add3(hips, matrix_apply(g_thigh, ff_v3(0, -4, 0)));
    ff_vec3 ankle = ff_add3(knee, matrix_apply(g_shank, ff_v3(3, -4, 0)));
    ff_vec3 toe = ff_add3(ankle, matrix_apply(g_foot, ff_v3(0, 0, 2)));
    ff_vec3 at[16];
    ff_clip_pose(clip, frame, at, NULL);
    FF_ASSERT_AT(at[0], hips, 1e-12);
    FF_ASSERT_AT(at[1], hips, 1e-12); /* rib starts at the root */
    FF_ASSERT_AT(at[2], ff_add3(hips, matrix_apply(g_root, ff_v3(3, 0, 0))), 1e-12);
    FF_ASSERT_AT(at[3], hips, 1e-12); /* thigh rotates where it starts */
    FF_ASSERT_AT(at[4], knee, 1e-12);
    FF_ASSERT_AT(at[5], ankle, 1e-12);
    FF_ASSERT_AT(at[6], toe, 1e-12);
}

static void joints_are_where_bones_start_and_turn_about_the_bones_own_axes(void **state)
{
    (void)state;
    ff_clip clip = parse_amc(
        ":FULLY-SPECIFIED\n:DEGREES\n7\nroot 5 6 7 20 -30 40\nthigh 11 22 -33\nshank 44\nfoot 10 20\n"
        "8\nfoot -1e1 5e-1\nthigh 90 1 100\nroot -1 0 1 100 200 300\nshank -8.5\n");
    static const char *const names[] = {"root", "rib", "rib_end", "thigh", "shank", "foot", "foot_end"};
    assert_int_equal(clip.joint_count, 7);
    for (int i = 0; i < 7; ++i)
        assert_string_equal(clip.joints[i].name, names[i]);
    assert_int_equal(clip.frame_count, 2);
    assert_int_equal(clip.first_frame, 7);
    assert_int_equal(clip.warning_count, 0);
    FF_ASSERT_NEAR(clip.frame_time, 1.0 / 120.0, 0.0);
    assert_pose_is_as_the_format_defines_it(&clip, 0, (double[]){5, 6, 7, 20, -30, 40},
                                            (double[]){11, 22, -33}, 44, (double[]){10, 20});
    assert_pose_is_as_the_format_defines_it(&clip, 1, (double[]){-1, 0, 1, 100, 200, 300},
                                            (double[]){90, 1, 100}, -8.5, (double[]){-10, 0.5});
    ff_clip_free(&clip);
}

static void radians_are_read_where_either_file_says_so(void **state)
{
    (void)state;
    const char degrees[] = "1\nroot 0 0 0 20 -30 40\nthigh 10 20 30\nshank 40\nfoot 10 20\n";
    const char radians[] =
        ":RADIANS\n1\nroot 0 0 0 0.34906585039886591538 -0.52359877559829887308 "
        "0.69813170079773183077\nthigh 0.17453292519943295769 0.34906585039886591538 "
        "0.52359877559829887308\nshank 0.69813170079773183077\nfoot 0.17453292519943295769 "
        "0.34906585039886591538\n";
    ff_clip a = parse_amc(degrees), b = parse_amc(radians);
    for (int j = 0; j < a.joint_count; ++j)
        FF_ASSERT_NEAR(ff_quat_dot(a.rotations[j], b.rotations[j]), 1.0, 1e-15);
    ff_clip_free(&a);
    ff_clip_free(&b);
    /* the ASF's unit rules its own axes too, and the AMC that does not say */
    ff_asf asf = parse_asf(SKELETON_UNITS(
        "rad") " orientation 0 0 0\n:bonedata\nbegin\nname b\ndirection 0 1 0\nlength 1\n"
               "axis 0 0 1.5707963267948966 XYZ\ndof rx\nend\n:hierarchy\nbegin\nroot b\nend\n");
    ff_load_options options = ff_load_options_default();
    ff_error error;
    const char turn[] = "1\nroot 0 0 0 0 0 0\nb 1.5707963267948966\n";
    FF_ASSERT_OK(ff_amc_parse(&asf, turn, sizeof turn - 1, "x.amc", &options, &a, &error), error);
    ff_vec3 turned = ff_quat_rotate(a.rotations[1], ff_v3(1, 0, 0)); /* about y, to which C turns x */
    FF_ASSERT_AT(turned, ff_v3(0, 0, -1), 1e-15);
    ff_clip_free(&a);
    ff_asf_free(&asf);
}

static void a_bone_that_a_frame_leaves_out_keeps_its_last_value(void **state)
{
    (void)state;
    const char text[] =
        "1\nroot 5 6 7 20 -30 40\nthigh 11 22 -33\nshank 44\nfoot 10 20\n2\nroot 1 1 1 2 2 2\nfoot 3 4\n"
        "3\nroot 0 0 0 0 0 0\nthigh 0 0 0\nshank 0\nfoot 0 0\n";
    ff_clip clip = parse_amc(text);
    assert_int_equal(clip.warning_count, 1);
    assert_string_equal(
        clip.warning, "line 9: frame 2 holds 2 of the 4 bones that move; the others keep their last values");
    assert_pose_is_as_the_format_defines_it(&clip, 1, (double[]){1, 1, 1, 2, 2, 2}, (double[]){11, 22, -33},
                                            44, (double[]){3, 4});
    ff_clip_free(&clip);
    ff_error error;
    assert_int_equal(parse_amc_bytes(text, sizeof text - 1, true, &clip, &error), FF_ERR_PARSE);
    assert_int_equal(error.line, 9);
}

static void the_roots_own_orientation_conjugates_its_rotation(void **state)
{
    (void)state;
    ff_asf asf = parse_asf(SKELETON_UNITS("deg") " orientation 10 20 30\n" SKELETON_BONES);
    ff_load_options options = ff_load_options_default();
    ff_clip clip;
    ff_error error;
    const char text[] = "1\nroot 0 0 0 40 50 60\n";
    FF_ASSERT_OK(ff_amc_parse(&asf, text, sizeof text - 1, "x.amc", &options, &clip, &error), error);
    matrix c = fixed_axes("xyz", 10, 20, 30), m = fixed_axes("xyz", 40, 50, 60);
    matrix g = matrix_times(matrix_times(c, m), matrix_transposed(c));
    FF_ASSERT_AT(ff_quat_rotate(clip.rotations[0], ff_v3(1, 2, 3)), matrix_apply(g, ff_v3(1, 2, 3)), 1e-14);
    ff_clip_free(&clip);
    ff_asf_free(&asf);
}

static void the_unit_of_length_and_a_frame_rate_are_taken_from_the_files(void **state)
{
    (void)state;
    ff_asf asf = parse_asf(SKELETON);
    FF_ASSERT_NEAR(asf.length, 0.45, 0.0);
    ff_asf_free(&asf);
    ff_clip clip = parse_amc(":SAMPLES-PER-SECOND 60\n1\nroot 0 0 0 0 0 0\n");
    FF_ASSERT_NEAR(clip.frame_time, 1.0 / 60.0, 1e-15);
    ff_clip_free(&clip);
}

#define WHOLE "1\nroot 0 0 0 0 0 0\nthigh 0 0 0\nshank 0\nfoot 0 0\n"

static void a_last_frame_that_was_cut_off_is_dropped(void **state)
{
    (void)state;
    static const char *const cut[] = {WHOLE "2",
                                      WHOLE "2\n",
                                      WHOLE "2\nroot 0 0",
                                      WHOLE "2\nroot 0 0 0 0 0 0\nthi",
                                      WHOLE "2\nroot 0 0 0 0 0 0\nthigh 0 0 -",
                                      WHOLE "2\nroot 0 0 0 0 0 0\nthigh 0 0 0\nshank 0\n"};
    for (size_t i = 0; i < sizeof cut / sizeof cut[0]; ++i) {
        ff_clip clip = parse_amc(cut[i]);
        assert_int_equal(clip.frame_count, 1);
        assert_int_equal(clip.warning_count, 1);
        assert_non_null(strstr(clip.warning, "the last frame, 2, was cut off"));
        ff_clip_free(&clip);
        ff_error error;
        assert_int_equal(parse_amc_bytes(cut[i], strlen(cut[i]), true, &clip, &error), FF_ERR_PARSE);
    }
}

typedef struct bad_text {
    const char *text, *place;
    ff_status status;
} bad_text;

static const bad_text bad_amc[] = {
    {"", "x.amc:1:1: ", FF_ERR_NO_DATA},
    {"# nothing\n:DEGREES\n", "x.amc:3: ", FF_ERR_NO_DATA},
    {"HIERARCHY\n", "x.amc:1:1: ", FF_ERR_PARSE},
    {"1\n", "x.amc:2: ", FF_ERR_PARSE},
    {"1\n2\n" WHOLE, "x.amc:2: ", FF_ERR_PARSE},
    {"1 root 0\n", "x.amc:1:3: ", FF_ERR_PARSE},
    {"1.5\n", "x.amc:1:1: ", FF_ERR_PARSE},
    {"99999999999999999999\n", "x.amc:1:1: ", FF_ERR_RANGE},
    {WHOLE "2\nroot 0 0 0 0 0 0\nnose 1\nshank 0\n", "x.amc:8:1: ", FF_ERR_PARSE},
    {WHOLE "2\nroot 0 0 0 0 0\nthigh 0 0 0\n", "x.amc:7:15: ", FF_ERR_PARSE},
    {WHOLE "2\nroot 0 0 0 0 0 0 0\nthigh 0 0 0\n", "x.amc:7:18: ", FF_ERR_PARSE},
    {WHOLE "2\nroot 0 0 0 0 0 0\nthigh 0 nan 0\n", "x.amc:8:9: ", FF_ERR_NOT_FINITE},
    {WHOLE "2\nroot 0 0 0 0 0 0\nthigh 0 0 -inf\n", "x.amc:8:11: ", FF_ERR_NOT_FINITE},
    {WHOLE "2\nroot 0 0 0 0 0 0\nthigh 0 0x1 0\n", "x.amc:8:9: ", FF_ERR_PARSE},
    {WHOLE "2\nroot 0 0 0 0 0 0\nthigh 0 1e40 0\n", "x.amc:8:9: ", FF_ERR_RANGE},
    {WHOLE "2\nroot 0 0 0 0 0 0\nthigh 0 1e999 0\n", "x.amc:8:9: ", FF_ERR_RANGE},
    {WHOLE "2\nroot 0 0 0 0 0 0\nshank 0\nshank 0\n", "x.amc:9:1: ", FF_ERR_PARSE},
    {WHOLE ":DEGREES\n", "x.amc:6:1: ", FF_ERR_PARSE},
    {WHOLE "rib 3\n", "x.amc:6:5: ", FF_ERR_PARSE},
    {":SAMPLES-PER-SECOND 0\n" WHOLE, "x.amc:1:21: ", FF_ERR_RANGE},
};

#define BONE " begin\n name b\n direction 0 1 0\n length 1\n axis 0 0 0 XYZ\n dof rx\n end\n"
#define TREE ":hierarchy\n begin\n root b\n end\n"

static const bad_text bad_asf[] = {
    {"", "x.asf:1:1: ", FF_ERR_NO_DATA},
    {"HIERARCHY\n", "x.asf:1:1: ", FF_ERR_PARSE},
    {":version 1.10\n", "x.asf:2: ", FF_ERR_NO_DATA},
    {":units\n length 0\n", "x.asf:2:9: ", FF_ERR_RANGE},
    {":units\n length -0.45\n", "x.asf:2:9: ", FF_ERR_RANGE},
    {":units\n length nan\n", "x.asf:2:9: ", FF_ERR_NOT_FINITE},
    {":units\n angle grad\n", "x.asf:2:8: ", FF_ERR_PARSE},
    {":root\n order TX TY TZ RX RY RW\n", "x.asf:2:23: ", FF_ERR_PARSE},
    {":root\n order TX TX\n", "x.asf:2:11: ", FF_ERR_PARSE},
    {":root\n axis XXY\n", "x.asf:2:7: ", FF_ERR_PARSE},
    {":root\n position 0 0\n", "x.asf:2:14: ", FF_ERR_PARSE},
    {":bonedata\n name b\n", "x.asf:2:2: ", FF_ERR_PARSE},
    {":bonedata\n end\n", "x.asf:2:2: ", FF_ERR_PARSE},
    {":bonedata\n begin\n begin\n", "x.asf:3:2: ", FF_ERR_PARSE},
    {":bonedata\n begin\n name b\n", "x.asf:4: ", FF_ERR_PARSE},
    {":bonedata\n begin\n end\n", "x.asf:3:2: ", FF_ERR_PARSE},
    {":bonedata\n begin\n name b\n:hierarchy\n", "x.asf:4:1: ", FF_ERR_PARSE},
    {":bonedata\n" BONE BONE TREE, "x.asf:10:7: ", FF_ERR_PARSE},
    {":bonedata\n begin\n name root\n", "x.asf:3:7: ", FF_ERR_PARSE},
    {":bonedata\n begin\n name b\n direction 0 1\n", "x.asf:4:15: ", FF_ERR_PARSE},
    {":bonedata\n begin\n name b\n length -1\n", "x.asf:4:9: ", FF_ERR_RANGE},
    {":bonedata\n begin\n name b\n length 1e9\n", "x.asf:4:9: ", FF_ERR_RANGE},
    {":bonedata\n begin\n name b\n axis 0 0 0 XY\n", "x.asf:4:13: ", FF_ERR_PARSE},
    {":bonedata\n begin\n name b\n dof rx ry rx\n", "x.asf:4:12: ", FF_ERR_PARSE},
    {":bonedata\n begin\n name b\n dof tx\n", "x.asf:4:6: ", FF_ERR_UNSUPPORTED},
    {":bonedata\n begin\n name b\n dof rx l\n", "x.asf:4:9: ", FF_ERR_UNSUPPORTED},
    {":bonedata\n" BONE ":hierarchy\n begin\n root c\n end\n", "x.asf:11:7: ", FF_ERR_PARSE},
    {":bonedata\n" BONE ":hierarchy\n begin\n c b\n end\n", "x.asf:11:2: ", FF_ERR_PARSE},
    {":bonedata\n" BONE ":hierarchy\n begin\n root b\n b b\n end\n", "x.asf:12:4: ", FF_ERR_PARSE},
    {":bonedata\n" BONE ":hierarchy\n begin\n b root\n end\n", "x.asf:11:4: ", FF_ERR_PARSE},
    {":bonedata\n" BONE ":hierarchy\n begin\n b b\n end\n", "x.asf:2: ", FF_ERR_PARSE},
    {":bonedata\n" BONE, "x.asf:2: ", FF_ERR_PARSE},
};

static int count_wrong(const bad_text *texts, size_t count, bool amc)
{
    int wrong = 0;
    for (size_t i = 0; i < count; ++i) {
        ff_clip clip = {0};
        ff_asf asf = {0};
        ff_error error;
        char text[1024] = "read without complaint";
        size_t size = strlen(texts[i].text);
        ff_status status = amc ? parse_amc_bytes(texts[i].text, size, false, &clip, &error)
                               : ff_asf_parse(texts[i].text, size, "x.asf", false, &asf, &error);
        if (status != FF_OK) ff_error_text(&error, text, sizeof text);
        if (status != texts[i].status || strncmp(text, texts[i].place, strlen(texts[i].place)) != 0) {
            print_error("%s case %zu: %s (%s), want %s (%s)\n", amc ? "AMC" : "ASF", i, text,
                        ff_status_name(status), texts[i].place, ff_status_name(texts[i].status));
            ++wrong;
        }
        ff_clip_free(&clip);
        ff_asf_free(&asf);
    }
    return wrong;
}

static void wrong_files_are_refused_with_their_place(void **state)
{
    (void)state;
    int wrong = count_wrong(bad_amc, sizeof bad_amc / sizeof bad_amc[0], true);
    wrong += count_wrong(bad_asf, sizeof bad_asf / sizeof bad_asf[0], false);
    assert_int_equal(wrong, 0);
}

static void every_truncation_is_read_or_refused(void **state)
{
    (void)state;
    const char asf_text[] = SKELETON,
               amc_text[] = WHOLE "2\nroot 1 2 3 4 5 6\nthigh 0 0 0\nshank 0\nfoot 0 0\n";
    for (size_t size = 0; size < sizeof asf_text; ++size) {
        char *exact = malloc(size ? size : 1);
        assert_non_null(exact);
        memcpy(exact, asf_text, size);
        ff_asf asf;
        ff_error error;
        if (ff_asf_parse(exact, size, "x.asf", false, &asf, &error) == FF_OK) ff_asf_free(&asf);
        free(exact);
    }
    for (size_t size = 0; size < sizeof amc_text; ++size) {
        char *exact = malloc(size ? size : 1);
        assert_non_null(exact);
        memcpy(exact, amc_text, size);
        ff_clip clip;
        ff_error error;
        if (parse_amc_bytes(exact, size, false, &clip, &error) == FF_OK) ff_clip_free(&clip);
        free(exact);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(joints_are_where_bones_start_and_turn_about_the_bones_own_axes),
        cmocka_unit_test(radians_are_read_where_either_file_says_so),
        cmocka_unit_test(a_bone_that_a_frame_leaves_out_keeps_its_last_value),
        cmocka_unit_test(the_roots_own_orientation_conjugates_its_rotation),
        cmocka_unit_test(the_unit_of_length_and_a_frame_rate_are_taken_from_the_files),
        cmocka_unit_test(a_last_frame_that_was_cut_off_is_dropped),
        cmocka_unit_test(wrong_files_are_refused_with_their_place),
        cmocka_unit_test(every_truncation_is_read_or_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
