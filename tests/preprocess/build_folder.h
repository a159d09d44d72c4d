/* build_folder.h - folders of clips to build packs from, and the packs as images, for tests of whole builds. Who includes
 * it defines _GNU_SOURCE. */
#ifndef FF_BUILD_FOLDER_H
#define FF_BUILD_FOLDER_H

#include "mocap/generator/generator.h"
#include "mocap/write.h"
#include "preprocess/build/build.h"
#include "runtime/core/base/file.h"
#include "runtime/core/pack/pack.h"
#include "tests/check.h"

#include <dirent.h>
#include <stdio.h>
#include <unistd.h>

typedef struct image {
    void *data;
    size_t size;
    ff_pack *pack;
} image;

static inline image build_with(const ff_catalogue *catalogue, ff_build_settings settings)
{
    ff_build_result built;
    ff_error error;
    image out;
    settings.quiet = true;
    FF_ASSERT_OK(ff_build(catalogue, &settings, &built, &error), error);
    FF_ASSERT_OK(ff_pack_image(&built.content, &out.data, &out.size, &error), error);
    ff_build_result_free(&built);
    FF_ASSERT_OK(ff_pack_open_memory(out.data, out.size, &out.pack, &error), error);
    return out;
}

static inline image build_image(const ff_catalogue *catalogue, uint32_t threads)
{
    ff_build_settings settings = ff_build_settings_default();
    settings.threads = threads;
    return build_with(catalogue, settings);
}

static inline void image_free(image *x)
{
    ff_pack_close(x->pack);
    free(x->data);
}

/* ------------------------------------------------------------------------------------------------ files to build from */

#define FOLDER_NAME "/tmp/ff-build-XXXXXX"

static inline void make_folder(char *folder)
{
    memcpy(folder, FOLDER_NAME, sizeof FOLDER_NAME);
    assert_non_null(mkdtemp(folder));
}

static inline void write_clip(const char *folder, const char *name)
{
    ff_generated made;
    ff_error error;
    char path[256];
    FF_ASSERT_OK(ff_generator_make(ff_generator_find(name), NULL, &made, &error), error);
    snprintf(path, sizeof path, "%s/%s.bvh", folder, name);
    FF_ASSERT_OK(ff_bvh_write(path, &made.clip, &error), error);
    ff_generated_free(&made);
}

static inline void write_text(const char *folder, const char *name, const char *text)
{
    char path[256];
    ff_error error;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FF_ASSERT_OK(ff_file_write_atomic(path, text, strlen(text), &error), error);
}

static inline void remove_folder(const char *folder)
{
    DIR *listing = opendir(folder);
    assert_non_null(listing);
    for (struct dirent *entry = readdir(listing); entry; entry = readdir(listing)) {
        char path[sizeof entry->d_name + 64];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (entry->d_name[0] != '.') assert_int_equal(unlink(path), 0);
    }
    closedir(listing);
    assert_int_equal(rmdir(folder), 0);
}

static inline ff_catalogue catalogue_of(const char *const *inputs, int count)
{
    ff_catalogue catalogue;
    ff_error error;
    FF_ASSERT_OK(ff_catalogue_read(inputs, count, &catalogue, &error), error);
    return catalogue;
}

#endif
