/* A pack on a skeleton that was asked for: its bones are that skeleton's, made symmetric, whatever file it comes from,
 * and what is no skeleton is refused before any work is done. */
#define _GNU_SOURCE
#include "tests/preprocess/build_folder.h"

#include "mocap/load.h"

static char folder[32];

static int make_clips(void **state)
{
    (void)state;
    make_folder(folder);
    write_clip(folder, "walk-normal");
    return 0;
}

static int remove_clips(void **state)
{
    (void)state;
    remove_folder(folder);
    return 0;
}

static image build_on(const char *skeleton)
{
    char path[256];
    snprintf(path, sizeof path, "%s/walk-normal.bvh", folder);
    const char *inputs[] = {path};
    ff_catalogue catalogue = catalogue_of(inputs, 1);
    ff_build_settings settings = ff_build_settings_default();
    settings.pack.actions.derive = false;
    snprintf(settings.pack.rig.skeleton, sizeof settings.pack.rig.skeleton, "%s", skeleton);
    image out = build_with(&catalogue, settings);
    ff_catalogue_free(&catalogue);
    return out;
}

/* A body unlike the clips': every bone of its own length, the left leg longer than the right. */
static void make_odd(ff_clip *clip)
{
    for (int j = 0; j < clip->joint_count; ++j) {
        double factor = 1.0 + 0.01 * (j % 7);
        if (clip->joints[j].role == FF_ROLE_KNEE_L) factor = 1.2;
        clip->joints[j].offset = ff_scale3(clip->joints[j].offset, factor);
    }
}

/* Length of the bone that ends at role, mean of both sides. */
static double bone_of(const ff_clip *clip, ff_role role)
{
    ff_vec3 at[FF_CLIP_MAX_JOINTS];
    ff_clip_rest_pose(clip, at);
    double sum = 0.0;
    for (int side = 0; side < 2; ++side) {
        ff_role here = side ? ff_role_mirror(role) : role;
        int joint = ff_clip_find(clip, here), parent = ff_clip_find(clip, ff_role_parent(here));
        sum += 0.5 * ff_length3(ff_sub3(at[joint], at[parent]));
    }
    return sum;
}

static void assert_bones_equal(const ff_pack *pack, const ff_clip *skeleton)
{
    static const ff_role limbs[] = {FF_ROLE_KNEE_L,  FF_ROLE_ANKLE_L, FF_ROLE_BALL_L, FF_ROLE_SHOULDER_L,
                                    FF_ROLE_ELBOW_L, FF_ROLE_WRIST_L, FF_ROLE_HIP_L,  FF_ROLE_CHEST,
                                    FF_ROLE_NECK,    FF_ROLE_HEAD};
    for (size_t i = 0; i < sizeof limbs / sizeof limbs[0]; ++i) {
        double length = ff_length3(ff_pack_joint_offset(pack, (uint32_t)limbs[i]));
        FF_ASSERT_NEAR(length, bone_of(skeleton, limbs[i]), 1e-5);
    }
}

static void the_pack_has_the_bones_of_a_given_clip_made_symmetric(void **state)
{
    (void)state;
    ff_generated made;
    ff_error error;
    char path[64];
    FF_ASSERT_OK(ff_generator_make(ff_generator_find("idle"), NULL, &made, &error), error);
    make_odd(&made.clip);
    snprintf(path, sizeof path, "%s/odd.bvh", folder);
    FF_ASSERT_OK(ff_bvh_write(path, &made.clip, &error), error);
    image odd = build_on(path), own = build_on("");
    assert_bones_equal(odd.pack, &made.clip);
    double thigh = ff_length3(ff_pack_joint_offset(own.pack, FF_ROLE_KNEE_L));
    assert_true(ff_length3(ff_pack_joint_offset(odd.pack, FF_ROLE_KNEE_R)) > 1.05 * thigh);
    image_free(&odd);
    image_free(&own);
    ff_generated_free(&made);
}

/* The same body as ASF alone, without a motion. */
static void a_skeleton_file_without_motion_will_do(void **state)
{
    (void)state;
    ff_generated made;
    ff_clip read;
    ff_error error;
    char asf[64], amc[64];
    ff_load_options options = ff_load_options_default();
    FF_ASSERT_OK(ff_generator_make(ff_generator_find("idle"), NULL, &made, &error), error);
    make_odd(&made.clip);
    snprintf(asf, sizeof asf, "%s/odd.asf", folder);
    snprintf(amc, sizeof amc, "%s/odd.amc", folder);
    FF_ASSERT_OK(ff_asf_amc_write(asf, amc, &made.clip, &error), error);
    FF_ASSERT_OK(ff_skeleton_load(asf, &options, &read, &error), error);
    assert_int_equal(read.frame_count, 1);
    FF_ASSERT_NEAR(bone_of(&read, FF_ROLE_KNEE_L), bone_of(&made.clip, FF_ROLE_KNEE_L), 1e-5);
    FF_ASSERT_NEAR(bone_of(&read, FF_ROLE_WRIST_L), bone_of(&made.clip, FF_ROLE_WRIST_L), 1e-5);
    image out = build_on(asf);
    assert_bones_equal(out.pack, &read);
    image_free(&out);
    ff_clip_free(&read);
    ff_generated_free(&made);
}

static void a_configuration_names_it_relative_to_itself_and_the_pack_without_folders(void **state)
{
    (void)state;
    ff_settings settings;
    ff_error error;
    char config[64], path[64];
    write_clip(folder, "walk-slow");
    write_text(folder, "my.json", "{\"rig\": {\"skeleton\": \"walk-slow.bvh\"}}");
    snprintf(config, sizeof config, "%s/my.json", folder);
    snprintf(path, sizeof path, "%s/walk-slow.bvh", folder);
    FF_ASSERT_OK(ff_settings_load(config, &settings, &error), error);
    assert_string_equal(settings.rig.skeleton, path);
    image out = build_on(path);
    assert_non_null(memmem(out.pack->meta, out.pack->meta_size, "walk-slow.bvh", 13));
    assert_null(memmem(out.data, out.size, folder, strlen(folder)));
    image_free(&out);
}

static void what_is_no_skeleton_is_refused_with_its_place(void **state)
{
    (void)state;
    static const struct {
        const char *name, *text, *says;
        uint32_t line;
    } cases[] = {
        {"none.bvh", NULL, "cannot open", 0},
        {"notes.txt", "nothing", "unknown kind of skeleton", 0},
        {"empty.asf", "", "empty", 1},
        {"broken.bvh", "HIERARCHY\nROOT hips\n{\n  OFFSET 0 nan 0\n}\n", "number", 4},
        {"bones.asf",
         ":version 1.10\n:root\norder TX TY TZ RX RY RZ\naxis XYZ\nposition 0 0 0\norientation 0 0 0\n"
         ":bonedata\nbegin\nid 1\nname thing\ndirection 0 1 0\nlength 1\naxis 0 0 0 XYZ\nend\n"
         ":hierarchy\nbegin\nroot thing\nend\n",
         "no joint was recognised as", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char path[64];
        ff_error error;
        ff_build_settings settings = ff_build_settings_default();
        ff_build_result built;
        settings.quiet = true;
        if (cases[i].text) write_text(folder, cases[i].name, cases[i].text);
        snprintf(path, sizeof path, "%s/%s", folder, cases[i].name);
        strcpy(settings.pack.rig.skeleton, path);
        assert_int_not_equal(ff_build(NULL, &settings, &built, &error), FF_OK);
        ff_build_result_free(&built);
        if (!strstr(error.message, cases[i].says)) fail_msg("%s: %s", cases[i].name, error.message);
        assert_string_equal(error.file, path);
        assert_int_equal(error.line, cases[i].line);
    }
}

static void a_character_or_captured_skeleton_gives_its_bones(void **state)
{
    (void)state;
    if (!ff_shared_folder()) {
        print_message("SKIPPED: skeletons of others: no folder of outside data\n");
        skip();
    }
    static const char *const files[] = {"cmu/16/16.asf", "cmu/02/02.asf",
                                        "bandai/dataset-1/dataset-1_walk_normal_001.bvh",
                                        "gltf/cesium_man.gltf"};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; ++i) {
        char path[256];
        ff_clip clip;
        ff_error error;
        ff_load_options options = ff_load_options_default();
        snprintf(path, sizeof path, "%s/data/%s", ff_shared_folder(), files[i]);
        FF_ASSERT_OK(ff_skeleton_load(path, &options, &clip, &error), error);
        image out = build_on(path);
        static const ff_role legs[] = {FF_ROLE_KNEE_L, FF_ROLE_ANKLE_L, FF_ROLE_ELBOW_L};
        for (size_t k = 0; k < sizeof legs / sizeof legs[0]; ++k)
            FF_ASSERT_NEAR(ff_length3(ff_pack_joint_offset(out.pack, (uint32_t)legs[k])),
                           bone_of(&clip, legs[k]), 1e-4);
        image_free(&out);
        ff_clip_free(&clip);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_pack_has_the_bones_of_a_given_clip_made_symmetric),
        cmocka_unit_test(a_skeleton_file_without_motion_will_do),
        cmocka_unit_test(a_configuration_names_it_relative_to_itself_and_the_pack_without_folders),
        cmocka_unit_test(what_is_no_skeleton_is_refused_with_its_place),
        cmocka_unit_test(a_character_or_captured_skeleton_gives_its_bones),
    };
    return cmocka_run_group_tests(tests, make_clips, remove_clips);
}
