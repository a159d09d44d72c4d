/* The clean-up as a part of builds: on unless switched off, the same bytes from any number of threads, and told of in
 * the pack. */
#define _GNU_SOURCE
#include "preprocess/build/build.h"

#include "mocap/generator/generator.h"
#include "mocap/write.h"
#include "runtime/core/pack/pack.h"
#include "tests/check.h"

#include <jansson.h>
#include <stdio.h>
#include <unistd.h>

typedef struct image {
    void *data;
    size_t size;
    ff_pack *pack;
    json_t *meta;
} image;

static image build_image(const ff_catalogue *catalogue, uint32_t threads, bool clean)
{
    ff_build_settings settings = ff_build_settings_default();
    ff_build_result built;
    ff_error error;
    image out;
    settings.quiet = true;
    settings.threads = threads;
    settings.pack.cut.motion.clean = clean;
    FF_ASSERT_OK(ff_build(catalogue, &settings, &built, &error), error);
    FF_ASSERT_OK(ff_pack_image(&built.content, &out.data, &out.size, &error), error);
    ff_build_result_free(&built);
    FF_ASSERT_OK(ff_pack_open_memory(out.data, out.size, &out.pack, &error), error);
    out.meta = json_loadb(out.pack->meta, out.pack->meta_size, 0, NULL);
    assert_non_null(out.meta);
    return out;
}

static void image_free(image *x)
{
    json_decref(x->meta);
    ff_pack_close(x->pack);
    free(x->data);
}

static const json_t *clean_of(const image *x, size_t clip)
{
    return json_object_get(json_array_get(json_object_get(x->meta, "clips"), clip), "clean");
}

static double after(const json_t *clean, const char *name)
{
    return json_number_value(json_array_get(json_object_get(clean, name), 1));
}

static void captured_like_clips_are_cleaned_alike_by_any_number_of_threads(void **state)
{
    (void)state;
    const char *names[] = {"walk-normal", "walk-fast", "curve-left"};
    char folder[] = "/tmp/ff-clean-XXXXXX", path[256];
    assert_non_null(mkdtemp(folder));
    ff_error error;
    for (int i = 0; i < 3; ++i) {
        const ff_generator_options options = {.noise_mm = 1.0, .skate_cm = 1.5};
        ff_generated made;
        FF_ASSERT_OK(ff_generator_make(ff_generator_find(names[i]), &options, &made, &error), error);
        snprintf(path, sizeof path, "%s/%s.bvh", folder, names[i]);
        FF_ASSERT_OK(ff_bvh_write(path, &made.clip, &error), error);
        ff_generated_free(&made);
    }
    const char *inputs[] = {folder};
    ff_catalogue catalogue;
    FF_ASSERT_OK(ff_catalogue_read(inputs, 1, &catalogue, &error), error);
    image one = build_image(&catalogue, 1, true), two = build_image(&catalogue, 2, true),
          raw = build_image(&catalogue, 2, false);
    assert_int_equal(one.size, two.size);
    assert_memory_equal(one.data, two.data, one.size);
    for (size_t i = 0; i < 3; ++i) {
        const json_t *clean = clean_of(&one, i);
        assert_true(json_is_false(json_object_get(clean, "was_clean")));
        FF_ASSERT_BELOW(after(clean, "pin_worst_mm"), 0.1);
        FF_ASSERT_BELOW(after(clean, "skate_mm_per_s"), 0.1);
        assert_true(json_number_value(json_array_get(json_object_get(clean, "pin_median_mm"), 0)) > 1.0);
        assert_true(json_number_value(json_object_get(clean, "turned_mean_deg")) > 0.1);
        assert_null(clean_of(&raw, i));
        snprintf(path, sizeof path, "%s/%s.bvh", folder, names[i]);
        unlink(path);
    }
    image_free(&one);
    image_free(&two);
    image_free(&raw);
    ff_catalogue_free(&catalogue);
    rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(captured_like_clips_are_cleaned_alike_by_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
