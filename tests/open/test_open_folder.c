/* Openers of several threads and processes share a folder of stores. */
#define _XOPEN_SOURCE 700

#include <sluice/bake.h>
#include <sluice/open.h>
#include <sluice/store.h>

#include "bake/baked.h"
#include "base/cache_folder.h"
#include "open/picture_rig.h"
#include "support/test.h"

#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Each file of a pool of one file is opened again when the other was read. */
static void openers_do_not_bake_over_the_stores_of_each_other(void **state)
{
    (void)state;
    struct picture_fixture f, g;
    char other[256], path[512];
    uint8_t texel[4];
    SluiceImageSource *sources[2], *closers[2];
    picture_setup(&f);
    memset(&g, 0, sizeof g);
    memcpy(g.cache, f.cache, sizeof f.cache);
    picture_opener(&g, 0);
    SluiceImageOpener *openers[2] = {f.opener, g.opener};
    bake_folder_file(&f.folder, "b.png", other);
    write_picture(other, 64, 64, 5);
    store_path(&f, f.png, path);
    for (int i = 0; i < 2; i++) {
        CHECK_OK(sluiceOpenImageSource(openers[i], f.png, &sources[i]));
        CHECK_OK(sluiceOpenImageSource(openers[i], other, &closers[i]));
        assert_true(wait_for(sources[i]).ready);
        assert_true(wait_for(closers[i]).ready);
        CHECK_OK(read_texel(closers[i], 0, texel));
    }
    unlink(path);
    CHECK_RESULT(read_texel(sources[0], 0, texel), SLUICE_NOT_READY);
    assert_true(wait_for(sources[0]).ready);
    struct stat first, last;
    assert_int_equal(stat(path, &first), 0);
    for (int round = 0; round < 4; round++)
        for (int i = 0; i < 2; i++) {
            CHECK_OK(read_texel(closers[i], 0, texel));
            SluiceResult expected =
                round == 0 && i == 1 ? SLUICE_NOT_READY : SLUICE_SUCCESS; /* opens the new one */
            CHECK_RESULT(read_texel(sources[i], 0, texel), expected);
            assert_true(state_of(sources[i]).ready);
        }
    assert_int_equal(stat(path, &last), 0);
    assert_int_equal(first.st_ino, last.st_ino);
    assert_int_equal(first.st_mtim.tv_nsec, last.st_mtim.tv_nsec);
    for (int i = 0; i < 2; i++) {
        sluiceDestroyImageSource(sources[i]);
        sluiceDestroyImageSource(closers[i]);
    }
    sluiceDestroyImageOpener(g.opener);
    picture_teardown(&f);
}

static void a_store_that_another_process_writes_holds_up_no_other(void **state)
{
    (void)state;
    struct picture_fixture f;
    char path[512], others[2][256];
    SluiceImageSource *waiting, *sources[2];
    picture_setup(&f);
    CHECK_OK(slc_cache_folder_make(f.cache, NULL));
    store_path(&f, f.png, path);
    SluiceStoreWriter *writer = begin_writing(path);
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &waiting));
    for (int i = 0; i < 2; i++) {
        bake_folder_file(&f.folder, i == 0 ? "b.png" : "c.png", others[i]);
        write_picture(others[i], 600, 40, 3);
        CHECK_OK(sluiceOpenImageSource(f.opener, others[i], &sources[i]));
        assert_true(wait_for(sources[i]).ready);
        assert_false(state_of(waiting).ready);
    }
    sluiceDestroyStoreWriter(writer);
    assert_true(wait_for(waiting).ready);
    check_baked(&f, waiting, f.png);
    assert_int_equal(f.errors, 0);
    for (int i = 0; i < 2; i++)
        sluiceDestroyImageSource(sources[i]);
    sluiceDestroyImageSource(waiting);
    picture_teardown(&f);
}

static void a_source_that_waits_for_another_process_can_go(void **state)
{
    (void)state;
    struct picture_fixture f;
    char path[512];
    SluiceImageSource *source;
    picture_setup(&f);
    CHECK_OK(slc_cache_folder_make(f.cache, NULL));
    store_path(&f, f.png, path);
    SluiceStoreWriter *writer = begin_writing(path);
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
    while (!state_of(source).previewReady)
        wait_a_little();
    for (int i = 0; i < 50; i++) /* the bake was tried more than once */
        wait_a_little();
    sluiceDestroyImageSource(source);
    sluiceDestroyStoreWriter(writer);
    assert_int_equal(access(path, F_OK), -1);
    picture_teardown(&f);
}

static void set_used(const char *path, time_t seconds)
{
    const struct timespec times[2] = {{.tv_sec = seconds}, {.tv_nsec = UTIME_OMIT}};
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

/* Two stores of equal size are there; there is room for one beside that of a third picture. */
static void old_stores_make_room_and_those_in_use_stay(void **state)
{
    (void)state;
    for (int run = 0; run < 4; run++) {
        struct picture_fixture f;
        char paths[3][512], pictures[3][256];
        SluiceImageSource *kept = NULL, *source;
        struct stat status;
        int older = run % 2;
        bool is_older_open = run >= 2;
        picture_setup(&f);
        for (int i = 0; i < 3; i++) {
            bake_folder_file(&f.folder, (const char *[]){"0.png", "1.png", "2.png"}[i],
                             pictures[i]);
            write_picture(pictures[i], 100, 100, (uint32_t)i);
            store_path(&f, pictures[i], paths[i]);
        }
        for (int i = 0; i < 2; i++) {
            CHECK_OK(sluiceOpenImageSource(f.opener, pictures[i], &source));
            assert_true(wait_for(source).ready);
            sluiceDestroyImageSource(source); /* waits for the end of its bake */
            assert_int_equal(access(paths[i], F_OK), 0);
        }
        sluiceDestroyImageOpener(f.opener);
        assert_int_equal(stat(paths[0], &status), 0);
        picture_opener(&f, (uint64_t)status.st_size * 5 / 2);
        if (is_older_open)
            CHECK_OK(sluiceOpenImageSource(f.opener, pictures[older], &kept));
        set_used(paths[older], 1000000000);
        set_used(paths[!older], 1000000001);
        CHECK_OK(sluiceOpenImageSource(f.opener, pictures[2], &source));
        assert_true(wait_for(source).ready);
        sluiceDestroyImageSource(source);
        assert_int_equal(access(paths[older], F_OK), is_older_open ? 0 : -1);
        assert_int_equal(access(paths[!older], F_OK), is_older_open ? -1 : 0);
        assert_int_equal(access(paths[2], F_OK), 0);
        if (kept)
            check_baked(&f, kept, pictures[older]);
        sluiceDestroyImageSource(kept);
        picture_teardown(&f);
    }
}

static void a_store_in_the_folder_that_is_open_by_its_own_name_stays(void **state)
{
    (void)state;
    struct picture_fixture f;
    char path[512];
    uint8_t texel[4];
    SluiceImageSource *plain, *source;
    picture_setup(&f);
    sluiceDestroyImageOpener(f.opener);
    picture_opener(&f, 1);
    CHECK_OK(slc_cache_folder_make(f.cache, NULL));
    snprintf(path, sizeof path, "%s/0123456789abcdef-2a.store", f.cache);
    bake_picture_file(f.png, path, NULL);
    for (int i = 0; i < 2; i++) { /* open, and then no more */
        char picture[256];
        bake_folder_file(&f.folder, i == 0 ? "0.png" : "1.png", picture);
        write_picture(picture, 100, 100, (uint32_t)i);
        if (i == 0)
            CHECK_OK(sluiceOpenImageSource(f.opener, path, &plain));
        CHECK_OK(sluiceOpenImageSource(f.opener, picture, &source));
        assert_true(wait_for(source).ready);
        sluiceDestroyImageSource(source); /* waits for the end of its bake */
        assert_int_equal(access(path, F_OK), i == 0 ? 0 : -1);
        if (i == 0) {
            CHECK_OK(read_texel(plain, 0, texel));
            sluiceDestroyImageSource(plain);
        }
    }
    picture_teardown(&f);
}

static void a_cache_folder_that_cannot_be_made_is_an_error(void **state)
{
    (void)state;
    struct picture_fixture f;
    SluiceImageSource *source = NULL;
    picture_setup(&f);
    sluiceDestroyImageOpener(f.opener);
    snprintf(f.cache, sizeof f.cache, "%s/cache", f.png); /* in a file */
    picture_opener(&f, 0);
    CHECK_RESULT(sluiceOpenImageSource(f.opener, f.png, &source), SLUICE_ERROR_IO);
    assert_non_null(strstr(f.last, f.cache));
    assert_null(source);
    picture_teardown(&f);
}

static void free_plainly(void *user, void *memory, size_t size)
{
    (void)user;
    (void)size;
    free(memory);
}

/* Its thread stops at the gate after it has copied `path`, which is then in the opener. */
struct slow_open {
    SluiceImageOpener *opener;
    const char *path;
    pthread_t thread;
    SluiceImageSource *source;
    SluiceResult result;
    atomic_bool has_thread, is_at_gate, is_open;
};

static void *allocate_for_slow_open(void *user, size_t size, size_t alignment)
{
    struct slow_open *slow = user;
    (void)alignment;
    if (slow->has_thread && pthread_equal(pthread_self(), slow->thread)) {
        while (slow->is_at_gate && !slow->is_open)
            wait_a_little();
        slow->is_at_gate = slow->is_at_gate || size == strlen(slow->path) + 1;
    }
    return malloc(size);
}

static void *open_slowly(void *argument)
{
    struct slow_open *slow = argument;
    slow->thread = pthread_self();
    slow->has_thread = true;
    slow->result = sluiceOpenImageSource(slow->opener, slow->path, &slow->source);
    return NULL;
}

struct second_open {
    const struct slow_open *first;
    SluiceImageSource *source;
    SluiceResult result;
    atomic_bool has_ended;
};

static void *open_second(void *argument)
{
    struct second_open *second = argument;
    second->result =
        sluiceOpenImageSource(second->first->opener, second->first->path, &second->source);
    second->has_ended = true;
    return NULL;
}

static void a_file_that_opens_slowly_holds_up_no_other(void **state)
{
    (void)state;
    for (int is_broken = 0; is_broken < 2; is_broken++) {
        struct picture_fixture f;
        char other[256], path[256];
        pthread_t first, second;
        struct slow_open slow = {.path = path};
        struct second_open again = {.first = &slow};
        SluiceImageSource *source;
        const SluiceAllocationCallbacks callbacks = {&slow, allocate_for_slow_open, free_plainly};
        picture_setup(&f);
        sluiceDestroyImageOpener(f.opener);
        SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                            .pCacheFolder = f.cache,
                                            .bakeThreadCount = 1,
                                            .pAllocator = &callbacks,
                                            .log = {&f, picture_log}};
        CHECK_OK(sluiceCreateImageOpener(&info, &f.opener));
        slow.opener = f.opener;
        bake_folder_file(&f.folder, "slow.png", path);
        bake_folder_file(&f.folder, "b.png", other);
        write_picture(path, 100, 100, 7);
        write_picture(other, 64, 64, 5);
        if (is_broken)
            assert_int_equal(truncate(path, 20), 0);
        assert_int_equal(pthread_create(&first, NULL, open_slowly, &slow), 0);
        while (!slow.is_at_gate)
            wait_a_little();
        CHECK_OK(sluiceOpenImageSource(f.opener, other, &source));
        assert_true(wait_for(source).ready);
        sluiceDestroyImageSource(source);
        assert_int_equal(pthread_create(&second, NULL, open_second, &again), 0);
        for (int i = 0; i < 20; i++)
            wait_a_little();
        assert_false(again.has_ended); /* waits for the first */
        slow.is_open = true;
        pthread_join(first, NULL);
        pthread_join(second, NULL);
        CHECK_RESULT(slow.result, is_broken ? SLUICE_ERROR_CORRUPT_DATA : SLUICE_SUCCESS);
        CHECK_RESULT(again.result, slow.result);
        assert_ptr_equal(again.source, slow.source);
        if (!is_broken) {
            assert_int_equal(state_of(slow.source).openCount, 2);
            sluiceDestroyImageSource(slow.source);
            sluiceDestroyImageSource(slow.source);
        }
        picture_teardown(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(openers_do_not_bake_over_the_stores_of_each_other),
        cmocka_unit_test(a_store_that_another_process_writes_holds_up_no_other),
        cmocka_unit_test(a_source_that_waits_for_another_process_can_go),
        cmocka_unit_test(old_stores_make_room_and_those_in_use_stay),
        cmocka_unit_test(a_store_in_the_folder_that_is_open_by_its_own_name_stays),
        cmocka_unit_test(a_cache_folder_that_cannot_be_made_is_an_error),
        cmocka_unit_test(a_file_that_opens_slowly_holds_up_no_other),
    };
    return RUN_TESTS(tests);
}
