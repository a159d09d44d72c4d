/* Every clip of the outside data loads; where CMU has the same motion in both formats, legs and root agree. */
#include "mocap/catalogue.h"
#include "mocap/roles_find.h"
#include "mocap/write.h"
#include "tests/check.h"

#include <dirent.h>
#include <stdio.h>
#include <strings.h>

static const char *folder_or_skip(void)
{
    const char *folder = ff_shared_folder();
    if (!folder) {
        print_message("SKIPPED the outside data is not here\n");
        skip();
    }
    return folder;
}

static bool ends_in(const char *name, const char *ending)
{
    size_t length = strlen(name), tail = strlen(ending);
    return length > tail && strcasecmp(name + length - tail, ending) == 0;
}

typedef void visit(const char *path, void *context);

/* Call function for every .amc and .bvh below folder (the data has no links). */
static void visit_clips(const char *folder, visit *function, void *context)
{
    DIR *directory = opendir(folder);
    if (!directory) return;
    for (const struct dirent *file; (file = readdir(directory)) != NULL;) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", folder, file->d_name);
        if (ends_in(path, ".amc") || ends_in(path, ".bvh")) {
            function(path, context);
        } else if (!strchr(file->d_name, '.')) {
            visit_clips(path, function, context);
        }
    }
    closedir(directory);
}

typedef struct tally {
    int loaded, refused, wrong;
} tally;

static void check_loaded(const char *path, const ff_clip *clip, tally *count)
{
    ff_error error;
    char text[1024] = "";
    bool cgspeed = strstr(path, "/cmu/") && ends_in(path, ".bvh") && !strstr(path, "131_");
    bool right = ff_roles_require(clip, &error) == FF_OK && clip->warning_count == 0;
    if (!right && error.message[0]) ff_error_text(&error, text, sizeof text);
    double want = strstr(path, "/cmu/") ? 0.0254 / 0.45 : 0.01;
    if (strstr(path, "scaled_131")) want = 1.0;
    if (strstr(path, "10_01.bvh") || strstr(path, "11_01.bvh")) want = 0.01;
    right = right && fabs(clip->unit_m - want) < 1e-9;
    int rest = ends_in(path, "09_10.amc") ? 4 : 0; /* it begins with four frames of zeros */
    right = right && clip->rest_frames == (cgspeed ? 1 : rest);
    double rate = strstr(path, "/cmu/") ? 120.0 : (strstr(path, "/bandai/") ? 30.0 : 60.0);
    right = right && fabs(clip->frame_time * rate - 1.0) < 1e-9;
    if (right) return;
    print_error("%s: unit %g, %d rest frames, %g frames/s, warning '%s', %s\n", path, clip->unit_m,
                clip->rest_frames, 1.0 / clip->frame_time, clip->warning, text);
    count->wrong++;
}

static void load_one(const char *path, void *context)
{
    tally *count = context;
    ff_load_options options = ff_load_options_default();
    ff_clip clip;
    ff_error error;
    if (ff_clip_load(path, &options, &clip, &error) == FF_OK) {
        count->loaded++;
        check_loaded(path, &clip, count);
        ff_clip_free(&clip);
        return;
    }
    char text[1024];
    print_message("refused: %s\n", ff_error_text(&error, text, sizeof text));
    count->refused++;
    count->wrong += error.line == 0 || !error.message[0] || !error.file[0];
}

static void every_clip_loads_with_its_roles_unit_and_rate_or_is_refused_with_a_place(void **state)
{
    (void)state;
    const char *folder = folder_or_skip();
    char path[1024];
    tally count = {0, 0, 0};
    snprintf(path, sizeof path, "%s/data", folder);
    visit_clips(path, load_one, &count);
    print_message("%d clips loaded, %d refused\n", count.loaded, count.refused);
    assert_int_equal(count.wrong, 0);
    assert_true(count.loaded >= 140);
}

/* ------------------------------------------------------------------------------------------- AMC against BVH */

static bool clip_of(const char *folder, const char *name, const char *ending, ff_clip *clip)
{
    char path[1024];
    ff_error error;
    ff_load_options options = ff_load_options_default();
    options.unit_m = 1.0; /* file units, in which the two are compared */
    snprintf(path, sizeof path, "%s/data/cmu/%.*s/%s.%s", folder, (int)(strchr(name, '_') - name), name, name,
             ending);
    return ff_clip_load(path, &options, clip, &error) == FF_OK;
}

/* Largest distance of root, hips, knees, ankles and toe joints over all frames. The BVH files print four decimals:
 * that alone moves the root by up to 0.00007 and, with the angles on the way, the toe tips by a little over 0.0001. */
static double largest_difference(const ff_clip *amc, const ff_clip *bvh, int *compared)
{
    static const ff_role roles[] = {FF_ROLE_HIPS,    FF_ROLE_HIP_L,   FF_ROLE_KNEE_L,
                                    FF_ROLE_ANKLE_L, FF_ROLE_BALL_L,  FF_ROLE_HIP_R,
                                    FF_ROLE_KNEE_R,  FF_ROLE_ANKLE_R, FF_ROLE_BALL_R};
    static ff_vec3 a[FF_CLIP_MAX_JOINTS], b[FF_CLIP_MAX_JOINTS];
    double worst = 0.0;
    *compared = 0;
    for (int k = 0; k < amc->frame_count && amc->first_frame + k < bvh->frame_count; ++k) {
        ff_clip_pose(amc, k, a, NULL);
        ff_clip_pose(bvh, amc->first_frame + k, b,
                     NULL); /* BVH frame = AMC frame number: 0 is the rest pose */
        for (size_t r = 0; r < sizeof roles / sizeof roles[0]; ++r) {
            int i = ff_clip_find(amc, roles[r]), j = ff_clip_find(bvh, roles[r]);
            if (i < 0 || j < 0) return 1e9;
            worst = ff_max(worst, ff_length3(ff_sub3(a[i], b[j])));
        }
        ++*compared;
    }
    return worst;
}

static void legs_and_root_of_cmu_clips_agree_in_both_formats(void **state)
{
    (void)state;
    const char *folder = folder_or_skip();
    static const char *const pairs[] = {"01_01", "02_01", "02_03", "03_01", "05_01", "07_01",
                                        "07_03", "08_01", "08_04", "09_01", "09_02", "09_12"};
    double worst = 0.0;
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; ++i) {
        ff_clip amc, bvh;
        assert_true(clip_of(folder, pairs[i], "amc", &amc));
        assert_true(clip_of(folder, pairs[i], "bvh", &bvh));
        int compared;
        double difference = largest_difference(&amc, &bvh, &compared);
        if (!(difference <= 1e-4))
            print_error("%s: %g units over %d frames\n", pairs[i], difference, compared);
        assert_true(compared > 100);
        worst = ff_max(worst, difference);
        ff_clip_free(&amc);
        ff_clip_free(&bvh);
    }
    print_message("12 clips in both formats: largest difference %.2g file units\n", worst);
    FF_ASSERT_BELOW(worst, 1e-4);
}

static void the_cmu_catalogue_lists_every_clip_once(void **state)
{
    (void)state;
    const char *folder = folder_or_skip();
    char input[1024], bare[1024];
    snprintf(input, sizeof input, "mocap/cmu.json:%s/data/cmu", folder);
    snprintf(bare, sizeof bare, "%s/data/cmu", folder);
    const char *inputs[2] = {input, bare};
    ff_catalogue listed, found;
    ff_error error;
    FF_ASSERT_OK(ff_catalogue_read(inputs, 1, &listed, &error), error);
    FF_ASSERT_OK(ff_catalogue_read(inputs + 1, 1, &found, &error), error);
    /* Six are listed as not to be used: 01_01, 03_01, 10_01, 11_01, 32_01 and the scaled copy of 131_01. */
    assert_int_equal(listed.count + 6, found.count);
    for (int i = 0; i < listed.count; ++i) {
        FF_ASSERT_NEAR(listed.entries[i].options.unit_m, 0.0254 / 0.45, 1e-12);
        assert_non_null(strstr(listed.entries[i].citation, "NSF EIA-0196217"));
        assert_true(listed.entries[i].tags[0] != '\0');
    }
    ff_catalogue_free(&listed);
    ff_catalogue_free(&found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_clip_loads_with_its_roles_unit_and_rate_or_is_refused_with_a_place),
        cmocka_unit_test(legs_and_root_of_cmu_clips_agree_in_both_formats),
        cmocka_unit_test(the_cmu_catalogue_lists_every_clip_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
