/* The cache folder: files that Sluice made make room, files of others stay. */
#define _XOPEN_SOURCE 700

#include "base/alloc.h"
#include "base/part_file.h"
#include "open/store_cache.h"
#include "support/test.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void make_folder(char folder[64])
{
    snprintf(folder, 64, "/tmp/sluice-open-cache-XXXXXX");
    assert_non_null(mkdtemp(folder));
}

static void remove_folder(const char *folder)
{
    char command[100];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    assert_int_equal(system(command), 0);
}

static void write_file(const char *folder, const char *name, bool is_old)
{
    char path[300];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs("contents", file);
    fclose(file);
    const struct timespec times[2] = {{1000000000, 0}, {1000000000, 0}};
    if (is_old)
        assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

static bool is_there(const char *folder, const char *name)
{
    char path[300];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return access(path, F_OK) == 0;
}

static bool keep_nothing(void *user, const struct slc_cache_entry *store)
{
    (void)user, (void)store;
    return false;
}

static void only_names_of_the_cache_are_deleted_and_only_old_parts(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        bool is_old, stays;
    } files[] = {
        {"0123456789abcdef-2a.store", false, false},
        {"0123456789abcdef-2b.store.sluice-part", true, false},
        {"0123456789abcdef-2c.store.sluice-part", false, true},
        {"0123456789abcdef-2a-3039-7f0123456789.preview", true, false},
        {"0123456789abcdef-2a-303a-7f0123456789.preview", false, true},
        {"0123456789abcdef-2a-303b-7f0123456789.preview.sluice-part", true, false},
        {"ffffffffffffffff-ffff-ffffffffffffffff-ffffffffffffffff.preview.sluice-part", true,
         false},
        {"wood.store", true, true},
        {"movie.sluice-part", true, true},
        {"0123456789abcdef.store", true, true},
        {"0123456789abcdef-.store", true, true},
        {"0123456789abcdef-2a5fe.store", true, true},
        {"0123456789ABCDEF-2a.store", true, true},
        {"00123456789abcdef-2a.store", true, true},
        {"0123456789abcdef-2a.store.bak", true, true},
        {"0123456789abcdef-2a-wood.store", true, true},
        {"0123456789abcdef-2a.preview", true, true},
    };
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    char folder[64];
    make_folder(folder);
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++)
        write_file(folder, files[i].name, files[i].is_old);
    slc_store_cache_trim(folder, 1, &cb, keep_nothing, NULL);
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++)
        if (is_there(folder, files[i].name) != files[i].stays)
            fail_msg("%s %s", files[i].name, files[i].stays ? "was deleted" : "is still there");
    remove_folder(folder);
}

static void left_previews_go_even_if_there_is_room(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    char folder[64], store[128], preview[200];
    make_folder(folder);
    snprintf(store, sizeof store, "%s/0123456789abcdef-2a.store", folder);
    assert_true(slc_store_cache_preview_path(store, &cb, preview, sizeof preview));
    assert_false(slc_store_cache_preview_path(store, &cb, preview, 40));
    assert_true(slc_store_cache_preview_path(store, &cb, preview, sizeof preview));
    write_file(folder, strrchr(preview, '/') + 1, true);
    write_file(folder, "0123456789abcdef-2a.store", true);
    slc_store_cache_trim(folder, 1000, &cb, keep_nothing, NULL);
    assert_int_equal(access(preview, F_OK), -1);
    assert_int_equal(access(store, F_OK), 0);
    remove_folder(folder);
}

static void an_old_part_that_somebody_continues_stays(void **state)
{
    (void)state;
    static const SluiceLogCallback silent;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_part_file part;
    char folder[64], store[128];
    make_folder(folder);
    snprintf(store, sizeof store, "%s/0123456789abcdef-2a.store", folder);
    write_file(folder, "0123456789abcdef-2a.store.sluice-part", true);
    assert_false(slc_store_cache_is_busy(store, &cb));
    CHECK_OK(slc_part_file_open(&part, store, SLC_PART_FILE_RESUME, &cb, &silent));
    assert_true(slc_store_cache_is_busy(store, &cb));
    slc_store_cache_trim(folder, 1, &cb, keep_nothing, NULL);
    assert_true(is_there(folder, "0123456789abcdef-2a.store.sluice-part"));
    slc_part_file_close(&part);
    slc_store_cache_trim(folder, 1, &cb, keep_nothing, NULL);
    assert_false(is_there(folder, "0123456789abcdef-2a.store.sluice-part"));
    assert_false(slc_store_cache_is_busy(store, &cb));
    assert_false(is_there(folder, "0123456789abcdef-2a.store.sluice-part"));
    remove_folder(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_names_of_the_cache_are_deleted_and_only_old_parts),
        cmocka_unit_test(left_previews_go_even_if_there_is_room),
        cmocka_unit_test(an_old_part_that_somebody_continues_stays),
    };
    return RUN_TESTS(tests);
}
