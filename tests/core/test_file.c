/* Whole files in, whole files out: what is refused, and that a failed write changes nothing. */
#define _GNU_SOURCE
#include "tests/check.h"

#include "runtime/core/base/file.h"

#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

static int folder_setup(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/ff-file-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static const char *inside(const char *name)
{
    static char path[400];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int folder_entries(void)
{
    int count = 0;
    DIR *open = opendir(folder);
    assert_non_null(open);
    for (struct dirent *entry = readdir(open); entry; entry = readdir(open))
        count += entry->d_name[0] != '.';
    closedir(open);
    return count;
}

static int folder_teardown(void **state)
{
    (void)state;
    DIR *open = opendir(folder);
    if (!open) return -1;
    for (struct dirent *entry = readdir(open); entry; entry = readdir(open)) {
        if (entry->d_name[0] != '.') remove(inside(entry->d_name));
    }
    closedir(open);
    return rmdir(folder);
}

static void assert_holds(const char *path, const char *want)
{
    ff_file file;
    ff_error error;
    FF_ASSERT_OK(ff_file_map(path, &file, &error), error);
    assert_int_equal(file.size, strlen(want));
    assert_memory_equal(file.data, want, file.size);
    ff_file_unmap(&file);
}

static void a_written_file_is_mapped_back_and_replaces_the_old_one(void **state)
{
    (void)state;
    ff_error error;
    const char *path = inside("a.txt");
    FF_ASSERT_OK(ff_file_write_atomic(path, "first", 5, &error), error);
    assert_holds(path, "first");
    FF_ASSERT_OK(ff_file_write_atomic(path, "", 0, &error), error);
    assert_holds(path, "");
    FF_ASSERT_OK(ff_file_write_atomic(path, "second", 6, &error), error);
    assert_holds(path, "second");
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    mode_t mask = umask(0);
    umask(mask);
    assert_int_equal(info.st_mode & 0777, 0666 & ~mask); /* as any other program would have made it */
    assert_int_equal(folder_entries(), 1);
}

static void a_write_that_fails_half_way_leaves_the_old_file_and_no_other(void **state)
{
    (void)state;
    enum { LIMIT = 65536 };
    static char large[LIMIT * 4];
    ff_error error;
    const char *path = inside("a.txt");
    FF_ASSERT_OK(ff_file_write_atomic(path, "old", 3, &error), error);
    /* A full disk in small: no file of this process may grow beyond the limit. */
    struct rlimit before, limit;
    getrlimit(RLIMIT_FSIZE, &before);
    limit = (struct rlimit){LIMIT, before.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    ff_status status = ff_file_write_atomic(path, large, sizeof large, &error);
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, SIG_DFL);
    assert_int_equal(status, FF_ERR_IO);
    assert_string_equal(error.file, path);
    assert_holds(path, "old");
    assert_int_equal(folder_entries(), 1);
}

static void a_place_that_cannot_be_written_is_named(void **state)
{
    (void)state;
    ff_error error;
    assert_int_equal(ff_file_write_atomic(inside("no/such/folder.txt"), "x", 1, &error), FF_ERR_IO);
    assert_string_equal(error.file, inside("no/such/folder.txt"));
    assert_int_equal(ff_file_write_atomic(folder, "x", 1, &error), FF_ERR_IO); /* a folder is in the way */
    assert_string_equal(error.file, folder);
    assert_int_equal(folder_entries(), 0);
}

static void what_is_no_regular_file_is_refused_and_a_pipe_does_not_hang(void **state)
{
    (void)state;
    ff_file file;
    ff_error error;
    assert_int_equal(mkfifo(inside("pipe"), 0600), 0);
    const char *const refused[] = {"/nonexistent.bvh", folder, "/dev/zero", inside("pipe")};
    alarm(20);
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; ++i) {
        assert_int_equal(ff_file_map(refused[i], &file, &error), FF_ERR_IO);
        assert_string_equal(error.file, refused[i]);
        assert_true(error.message[0] != '\0');
        assert_int_equal(file.size, 0);
        ff_file_unmap(&file);
        assert_int_equal(ff_file_map(refused[i], &file, NULL), FF_ERR_IO);
    }
    alarm(0);
}

static void folders_are_made_with_their_parents(void **state)
{
    (void)state;
    ff_error error;
    char deep[160];
    snprintf(deep, sizeof deep, "%s/b//c/", folder);
    FF_ASSERT_OK(ff_folder_create(deep, &error), error);
    FF_ASSERT_OK(ff_folder_create(deep, &error), error);
    struct stat info;
    assert_int_equal(stat(inside("b/c"), &info), 0);
    assert_true(S_ISDIR(info.st_mode));
    assert_int_equal(rmdir(inside("b/c")), 0);
    assert_int_equal(ff_folder_create("", &error), FF_ERR_ARGUMENT);
    FF_ASSERT_OK(ff_file_write_atomic(inside("file"), "x", 1, &error), error);
    assert_int_equal(ff_folder_create(inside("file"), &error), FF_ERR_IO);
    assert_int_equal(ff_folder_create(inside("file/below"), &error), FF_ERR_IO);
}

int main(void)
{
#define IN_A_FOLDER(test) cmocka_unit_test_setup_teardown(test, folder_setup, folder_teardown)
    const struct CMUnitTest tests[] = {
        IN_A_FOLDER(a_written_file_is_mapped_back_and_replaces_the_old_one),
        IN_A_FOLDER(a_write_that_fails_half_way_leaves_the_old_file_and_no_other),
        IN_A_FOLDER(a_place_that_cannot_be_written_is_named),
        IN_A_FOLDER(what_is_no_regular_file_is_refused_and_a_pipe_does_not_hang),
        IN_A_FOLDER(folders_are_made_with_their_parents),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
