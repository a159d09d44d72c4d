/* The pack's bytes: where sections stand, that padding is zero, that the checksum is right, that files appear whole or
 * not at all. */
#define _GNU_SOURCE
#include "preprocess/pack/pack_write.h"
#include "runtime/core/base/file.h"
#include "tests/check.h"

#include <stdio.h>
#include <unistd.h>

#include <xxhash.h>

/* A pack with an odd number of bytes in most sections, so that there is padding to get wrong. */
static void fill(ff_pack_content *content)
{
    memset(content, 0, sizeof *content);
    ff_error error;
    assert_true(ff_pack_add_string(content, "hips") == 1);
    FF_ASSERT_OK(ff_pack_set_meta(content, "{\"tool\": \"test\"}", &error), error);
    ff_pack_joint *joint = ff_array_grow(&content->joints, 1, sizeof *joint);
    assert_non_null(joint);
    *joint = (ff_pack_joint){-1, 1, {0.0f, 0.9f, 0.0f}, 0.1f};
    ff_pack_point2 *hull = ff_array_grow(&content->hull, 3, sizeof *hull);
    assert_non_null(hull);
    hull[0] = (ff_pack_point2){0.0f, 0.0f};
    hull[1] = (ff_pack_point2){1.0f, -0.5f};
    hull[2] = (ff_pack_point2){1.0f, 0.5f};
}

static void records_have_no_hidden_padding(void **state)
{
    (void)state;
    assert_int_equal(sizeof(ff_pack_header), 32);
    assert_int_equal(sizeof(ff_pack_section), 32);
    assert_int_equal(sizeof(ff_pack_joint), 24);
    assert_int_equal(sizeof(ff_pack_level), 12);
    assert_int_equal(sizeof(ff_pack_stream), 9 * 4 + 4 * 12);
    assert_int_equal(sizeof(ff_pack_slots), 4 * 24 * 5);
    assert_int_equal(sizeof(ff_pack_lanes), 64);
    assert_int_equal(sizeof(ff_pack_clip), 10 * 4 + 8 + 6 * 4);
    assert_int_equal(sizeof(ff_pack_plant), 13 * 4);
    assert_int_equal(sizeof(ff_pack_action), 43 * 4);
    assert_int_equal(sizeof(ff_pack_event), 16);
    assert_int_equal(sizeof(ff_pack_successor), 12);
    assert_int_equal(sizeof(ff_pack_reach), 81 * 82 * 2);
    assert_int_equal(sizeof(ff_pack_example), 18 * 4);
    assert_int_equal(sizeof(ff_pack_foot), 20);
    assert_int_equal(sizeof(ff_pack_simplex), 20);
    assert_int_equal(sizeof(ff_pack_track), 12);
    assert_int_equal(sizeof(ff_pack_loop), 5 * 4);
    assert_int_equal(sizeof(ff_pack_correspondence), 8 * 4);
    assert_int_equal(sizeof(ff_pack_pair), 7 * 4);
    assert_int_equal(sizeof(ff_pack_gait), 27 * 4);
    assert_int_equal(sizeof(ff_pack_gait_path), 8 * 4);
    assert_int_equal(sizeof(ff_pack_sharp), 5 * 4);
}

static void sections_are_aligned_in_order_and_padding_is_zero(void **state)
{
    (void)state;
    ff_pack_content content;
    ff_error error;
    void *data;
    size_t size;
    fill(&content);
    FF_ASSERT_OK(ff_pack_image(&content, &data, &size, &error), error);
    const unsigned char *bytes = data;
    const ff_pack_header *header = data;
    assert_memory_equal(bytes, "FOOFPACK", 8);
    assert_int_equal(header->file_size, size);
    assert_int_equal(header->section_count, FF_PACK_SECTION_COUNT);
    assert_int_equal((uintptr_t)data % FF_PACK_ALIGN, 0);
    const ff_pack_section *table = (const ff_pack_section *)(const void *)(bytes + sizeof *header);
    size_t end = sizeof *header + FF_PACK_SECTION_COUNT * sizeof *table;
    for (int k = 0; k < FF_PACK_SECTION_COUNT; ++k) {
        assert_int_equal(table[k].offset % FF_PACK_ALIGN, 0);
        assert_int_equal(table[k].size, table[k].stride * table[k].count);
        for (size_t i = end; i < table[k].offset; ++i)
            assert_int_equal(bytes[i], 0);
        end = table[k].offset + table[k].size;
        if (table[k].tag == FF_SECTION_HULL) {
            assert_int_equal(table[k].count, 3);
            assert_memory_equal(bytes + table[k].offset, content.hull.data, table[k].size);
        }
    }
    for (size_t i = end; i < size; ++i)
        assert_int_equal(bytes[i], 0);
    assert_true(XXH64(bytes + sizeof *header, size - sizeof *header, 0) == header->checksum);
    free(data);
    ff_pack_content_free(&content);
}

static void the_same_content_gives_the_same_bytes(void **state)
{
    (void)state;
    ff_pack_content first, second;
    void *a, *b;
    size_t a_size, b_size;
    ff_error error;
    fill(&first);
    fill(&second);
    FF_ASSERT_OK(ff_pack_image(&first, &a, &a_size, &error), error);
    FF_ASSERT_OK(ff_pack_image(&second, &b, &b_size, &error), error);
    assert_int_equal(a_size, b_size);
    assert_memory_equal(a, b, a_size);
    free(a);
    free(b);
    ff_pack_content_free(&first);
    ff_pack_content_free(&second);
}

static void equal_strings_are_stored_once(void **state)
{
    (void)state;
    ff_pack_content content = {0};
    uint32_t walk = ff_pack_add_string(&content, "walk");
    uint32_t run = ff_pack_add_string(&content, "run");
    assert_int_equal(walk, 1);
    assert_int_equal(run, 6);
    assert_int_equal(ff_pack_add_string(&content, "walk"), walk);
    assert_int_equal(ff_pack_add_string(&content, ""), 0);
    assert_int_equal(ff_pack_add_string(&content, NULL), 0);
    assert_int_equal(content.strings.count, 10);
    ff_pack_content_free(&content);
}

static void a_pack_that_cannot_be_written_leaves_nothing(void **state)
{
    (void)state;
    ff_pack_content content;
    ff_error error;
    fill(&content);
    assert_int_equal(ff_pack_write(&content, "/nonexistent-folder/x.ffpack", NULL, &error), FF_ERR_IO);
    size_t size;
    char path[] = "/tmp/ff-pack-write-XXXXXX";
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    close(fd);
    FF_ASSERT_OK(ff_pack_write(&content, path, &size, &error), error);
    ff_file file;
    FF_ASSERT_OK(ff_file_map(path, &file, &error), error);
    assert_memory_equal(file.data, "FOOFPACK", 8);
    assert_int_equal(file.size, size);
    ff_file_unmap(&file);
    unlink(path);
    ff_pack_content_free(&content);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(records_have_no_hidden_padding),
        cmocka_unit_test(sections_are_aligned_in_order_and_padding_is_zero),
        cmocka_unit_test(the_same_content_gives_the_same_bytes),
        cmocka_unit_test(equal_strings_are_stored_once),
        cmocka_unit_test(a_pack_that_cannot_be_written_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
