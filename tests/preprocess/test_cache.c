/* The cache: what was stored comes back; what is damaged in any way does not; nothing of it can fail a build. */
#define _GNU_SOURCE
#include "preprocess/base/cache.h"

#include "runtime/core/base/file.h"
#include "tests/check.h"
#include "tests/folder.h"

#include <dirent.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

static int make_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/ff-cache-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    return ff_remove_tree(folder);
}

static int file_count(void)
{
    int count = 0;
    DIR *listing = opendir(folder);
    for (struct dirent *entry = readdir(listing); entry; entry = readdir(listing))
        count += entry->d_name[0] != '.';
    closedir(listing);
    return count;
}

static bool loads(ff_cache *cache, uint64_t key, const char *text)
{
    void *data;
    size_t size;
    if (!ff_cache_load(cache, "cut", key, &data, &size)) return false;
    assert_int_equal(size, strlen(text));
    assert_memory_equal(data, text, size);
    free(data);
    return true;
}

static void what_was_stored_comes_back_under_its_key_and_kind(void **state)
{
    (void)state;
    ff_cache cache;
    ff_cache_open(&cache, folder);
    ff_cache_store(&cache, "cut", 1, "one", 3);
    ff_cache_store(&cache, "cut", 2, "", 0);
    assert_true(loads(&cache, 1, "one"));
    assert_true(loads(&cache, 2, ""));
    ff_cache_store(&cache, "cut", 1, "other", 5);
    assert_true(loads(&cache, 1, "other"));
    assert_false(loads(&cache, 3, ""));
    void *data;
    size_t size;
    assert_false(ff_cache_load(&cache, "find", 1, &data, &size));
    assert_int_equal(atomic_load(&cache.found), 3);
    assert_int_equal(atomic_load(&cache.missed), 2);
    assert_int_equal(atomic_load(&cache.unwritten), 0);
    ff_cache_close(&cache);
}

static void a_damaged_entry_is_as_good_as_none(void **state)
{
    (void)state;
    ff_cache cache;
    char path[128], other[128], bytes[64];
    ff_file file;
    ff_cache_open(&cache, folder);
    ff_cache_store(&cache, "cut", 0xabc, "some result", 11);
    snprintf(path, sizeof path, "%s/0000000000000abc.cut", folder);
    assert_int_equal(ff_file_map(path, &file, NULL), FF_OK);
    size_t size = file.size;
    assert_in_range(size, 12, sizeof bytes);
    memcpy(bytes, file.data, size);
    ff_file_unmap(&file);
    for (size_t i = 0; i < size; ++i) {
        bytes[i] ^= 0x10;
        assert_int_equal(ff_file_write_unsynced(path, bytes, size, NULL), FF_OK);
        assert_false(loads(&cache, 0xabc, ""));
        bytes[i] ^= 0x10;
        assert_int_equal(ff_file_write_unsynced(path, bytes, i, NULL), FF_OK);
        assert_false(loads(&cache, 0xabc, ""));
    }
    /* the entry of another key, under this key's name */
    snprintf(other, sizeof other, "%s/0000000000000abd.cut", folder);
    assert_int_equal(ff_file_write_unsynced(other, bytes, size, NULL), FF_OK);
    assert_false(loads(&cache, 0xabd, ""));
    assert_int_equal(ff_file_write_unsynced(path, bytes, size, NULL), FF_OK);
    assert_true(loads(&cache, 0xabc, "some result"));
    ff_cache_close(&cache);
}

static void without_a_folder_nothing_is_kept_and_nothing_fails(void **state)
{
    (void)state;
    ff_cache cache;
    ff_cache_open(&cache, NULL);
    ff_cache_store(&cache, "cut", 1, "one", 3);
    assert_false(loads(&cache, 1, ""));
    ff_cache_prune(&cache, NULL, 0);
    ff_cache_close(&cache);
    ff_cache_open(&cache, "/dev/null/cache");
    ff_cache_store(&cache, "cut", 1, "one", 3);
    assert_false(loads(&cache, 1, ""));
    assert_true(atomic_load(&cache.unwritten) > 0);
    ff_cache_close(&cache);
}

static void pruning_leaves_what_is_used_and_what_is_not_the_caches(void **state)
{
    (void)state;
    static const char *const strangers[] = {"notes.txt", "0123.cut", "zzzzzzzzzzzzzzzz.cut"};
    ff_cache cache;
    char path[128];
    ff_cache_open(&cache, folder);
    for (uint64_t key = 10; key < 20; ++key)
        ff_cache_store(&cache, "cut", key, "x", 1);
    for (int i = 0; i < 3; ++i) {
        snprintf(path, sizeof path, "%s/%s", folder, strangers[i]);
        assert_int_equal(ff_file_write_unsynced(path, "x", 1, NULL), FF_OK);
    }
    snprintf(path, sizeof path, "%s/000000000000000a.cut.Ab3dEf", folder); /* a killed build's */
    assert_int_equal(ff_file_write_unsynced(path, "x", 1, NULL), FF_OK);
    const uint64_t used[] = {10, 12, 19};
    ff_cache_prune(&cache, used, 3);
    for (uint64_t key = 10; key < 20; ++key)
        assert_int_equal(loads(&cache, key, "x"), key == 10 || key == 12 || key == 19);
    assert_int_equal(file_count(), 6);
    ff_cache_close(&cache);
}

int main(void)
{
#define IN_A_FOLDER(test) cmocka_unit_test_setup_teardown(test, make_folder, remove_folder)
    const struct CMUnitTest tests[] = {
        IN_A_FOLDER(what_was_stored_comes_back_under_its_key_and_kind),
        IN_A_FOLDER(a_damaged_entry_is_as_good_as_none),
        cmocka_unit_test(without_a_folder_nothing_is_kept_and_nothing_fails),
        IN_A_FOLDER(pruning_leaves_what_is_used_and_what_is_not_the_caches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
