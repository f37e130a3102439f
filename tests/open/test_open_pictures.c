/* Pictures without tiles: coarse levels first, then the store of a bake, which is kept. */
#define _XOPEN_SOURCE 700

#include <sluice/bake.h>
#include <sluice/open.h>
#include <sluice/store.h>

#include "bake/baked.h"
#include "base/alloc.h"
#include "base/checked.h"
#include "open/store_cache.h"
#include "support/failing_allocator.h"
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

enum { WIDTH = 1300, HEIGHT = 700 };

struct fixture {
    struct bake_folder folder;
    char cache[400], png[256];
    SluiceImageOpener *opener;
    atomic_int errors, warnings;
    char last[1024], last_warning[1024];
};

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    struct fixture *f = user;
    f->errors += severity == SLUICE_LOG_ERROR;
    f->warnings += severity == SLUICE_LOG_WARNING;
    if (severity == SLUICE_LOG_ERROR)
        snprintf(f->last, sizeof f->last, "%s", message);
    if (severity == SLUICE_LOG_WARNING)
        snprintf(f->last_warning, sizeof f->last_warning, "%s", message);
}

static void write_picture(const char *path, uint32_t width, uint32_t height, uint32_t seed)
{
    uint8_t *samples = malloc((size_t)width * height * 3);
    for (uint32_t i = 0; i < width * height * 3; i++)
        samples[i] = (uint8_t)(i / 3 % width / 7 + seed + i % 3 * 40);
    write_png(path, samples, width, height, 3, false);
    free(samples);
}

static void open_opener(struct fixture *f, uint64_t max_cache_size)
{
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                        .maxOpenFileCount = 1,
                                        .pCacheFolder = f->cache,
                                        .maxCacheSize = max_cache_size,
                                        .bakeThreadCount = 1,
                                        .log = {f, on_log}};
    CHECK_OK(sluiceCreateImageOpener(&info, &f->opener));
}

static void setup(struct fixture *f)
{
    memset(f, 0, sizeof *f);
    bake_folder_init(&f->folder);
    snprintf(f->cache, sizeof f->cache, "%s/cache", f->folder.path);
    bake_folder_file(&f->folder, "a.png", f->png);
    write_picture(f->png, WIDTH, HEIGHT, 1);
    open_opener(f, 0);
}

static void teardown(struct fixture *f)
{
    char command[500];
    sluiceDestroyImageOpener(f->opener);
    snprintf(command, sizeof command, "rm -rf '%s'", f->cache);
    assert_int_equal(system(command), 0);
    bake_folder_finish(&f->folder);
}

static void store_path(const struct fixture *f, const char *picture, char path[512])
{
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    char *made;
    CHECK_OK(slc_store_cache_path(f->cache, picture, 0, &cb, &made));
    snprintf(path, 512, "%s", made);
    slc_free(&cb, made, strlen(made) + 1, 1);
}

static SluiceOpenedImageInfo state_of(SluiceImageSource *source)
{
    SluiceOpenedImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetOpenedImageInfo(source, &info));
    return info;
}

static void wait_a_little(void)
{
    const struct timespec time = {0, 2000000};
    nanosleep(&time, NULL);
}

/* Until a bake has ended, one way or the other; two minutes at most. */
static SluiceOpenedImageInfo wait_for(SluiceImageSource *source)
{
    SluiceOpenedImageInfo info = state_of(source);
    for (int i = 0; !info.ready && info.failure == SLUICE_SUCCESS && i < 60000; i++) {
        wait_a_little();
        info = state_of(source);
    }
    return info;
}

static SluiceResult read_texel(SluiceImageSource *source, uint32_t level, uint8_t texel[4])
{
    SluiceImageRegion region = {level, 0, 0, 1, 1, 0};
    return sluiceReadImageRegion(source, &region, texel, 4);
}

/* Every level is that of a bake of our own. */
static void check_baked(struct fixture *f, SluiceImageSource *source, const char *picture)
{
    char baked[256];
    SluiceImageInfo info = {.structSize = sizeof info};
    bake_folder_file(&f->folder, "baked.store", baked);
    bake_picture_file(picture, baked, NULL);
    CHECK_OK(sluiceGetImageInfo(source, &info));
    assert_string_equal(info.pName, picture);
    for (uint32_t level = 0; level < info.mipLevelCount; level++) {
        size_t size;
        uint8_t *expected = read_bytes(baked, level, &size), *texels = malloc(size);
        SluiceImageRegion region = {level, 0, 0, slc_mip_size(info.width, level),
                                    slc_mip_size(info.height, level)};
        CHECK_OK(sluiceReadImageRegion(source, &region, texels, (size_t)region.width * 4));
        assert_memory_equal(texels, expected, size);
        free(expected);
        free(texels);
    }
    unlink(baked);
}

/* Takes the store as another process would that bakes the same picture. */
static SluiceStoreWriter *begin_writing(const char *path)
{
    SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                  .pPath = path,
                                  .width = 16,
                                  .height = 16,
                                  .format = SLUICE_FORMAT_R8_UNORM};
    SluiceStoreWriter *writer;
    CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
    return writer;
}

static void coarse_levels_come_first_and_all_of_them_in_the_end(void **state)
{
    (void)state;
    struct fixture f;
    char path[512];
    uint8_t texel[4];
    SluiceImageSource *source;
    SluiceImageInfo image = {.structSize = sizeof image};
    setup(&f);
    CHECK_OK(slc_cache_folder_make(f.cache, NULL));
    store_path(&f, f.png, path);
    SluiceStoreWriter *writer = begin_writing(path); /* while it is there no bake can begin */
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
    CHECK_OK(sluiceGetImageInfo(source, &image));
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.height, HEIGHT);
    assert_int_equal(image.mipLevelCount, 11);
    assert_int_equal(image.format, SLUICE_FORMAT_R8G8B8A8_SRGB);
    for (int i = 0; !state_of(source).previewReady && i < 60000; i++)
        wait_a_little();
    assert_true(state_of(source).previewReady);
    assert_false(state_of(source).ready);
    CHECK_RESULT(read_texel(source, 0, texel), SLUICE_NOT_READY);
    CHECK_RESULT(read_texel(source, 1, texel), SLUICE_NOT_READY); /* 650 x 350 */
    for (uint32_t level = 2; level < 11; level++)
        CHECK_OK(read_texel(source, level, texel));
    CHECK_OK(read_texel(source, 2, texel));
    assert_in_range(texel[0], 0, 4); /* about 1 */
    assert_in_range(texel[2], 78, 84);
    SluiceImageRegion right = {3, 160, 80, 1, 1, 0}; /* texel 1280 of level 0: 1280 / 7 + 1 */
    CHECK_OK(sluiceReadImageRegion(source, &right, texel, 4));
    assert_in_range(texel[0], 179, 187);
    sluiceDestroyStoreWriter(writer);
    assert_true(wait_for(source).ready);
    assert_int_equal(f.errors, 0); /* to wait for a writer is none */
    check_baked(&f, source, f.png);
    sluiceDestroyImageSource(source);
    teardown(&f);
}

static void the_store_is_kept_for_the_next_time(void **state)
{
    (void)state;
    struct fixture f;
    char path[512];
    struct stat before, after;
    SluiceImageSource *source;
    setup(&f);
    store_path(&f, f.png, path);
    for (int again = 0; again < 2; again++) {
        CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
        if (again)
            assert_true(state_of(source).ready);
        else
            assert_true(wait_for(source).ready);
        check_baked(&f, source, f.png);
        sluiceDestroyImageSource(source);
        assert_int_equal(stat(path, again ? &after : &before), 0);
        sluiceDestroyImageOpener(f.opener);
        open_opener(&f, 0);
    }
    assert_int_equal(before.st_ino, after.st_ino);
    assert_int_equal(f.errors, 0);
    teardown(&f);
}

static void a_picture_that_changed_is_baked_again(void **state)
{
    (void)state;
    struct fixture f;
    SluiceImageSource *first, *changed;
    SluiceImageInfo image = {.structSize = sizeof image};
    setup(&f);
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &first));
    assert_true(wait_for(first).ready);
    write_picture(f.png, 600, 500, 9);
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &changed));
    assert_ptr_not_equal(first, changed);
    assert_true(wait_for(changed).ready);
    CHECK_OK(sluiceGetImageInfo(changed, &image));
    assert_int_equal(image.width, 600);
    check_baked(&f, changed, f.png);
    sluiceDestroyImageSource(first);
    sluiceDestroyImageSource(changed);
    teardown(&f);
}

static void damage(const char *path, long from, long to)
{
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    for (long at = from; at < to; at++) {
        fseek(file, at, SEEK_SET);
        int byte = fgetc(file);
        fseek(file, at, SEEK_SET);
        fputc(byte ^ 0x55, file);
    }
    fclose(file);
}

/* Refuses the first allocations after the store is there. */
struct shortage {
    char path[512];
    atomic_int left;
};

static void *allocate_in_shortage(void *user, size_t size, size_t alignment)
{
    struct shortage *shortage = user;
    (void)alignment;
    if (shortage->path[0] && access(shortage->path, F_OK) == 0 &&
        atomic_fetch_sub(&shortage->left, 1) > 0)
        return NULL;
    return malloc(size);
}

static void free_in_shortage(void *user, void *memory, size_t size)
{
    (void)user, (void)size;
    free(memory);
}

static void a_shortage_of_memory_after_a_bake_is_not_kept(void **state)
{
    (void)state;
    struct fixture f;
    struct shortage shortage = {"", 3};
    SluiceImageSource *source;
    setup(&f);
    sluiceDestroyImageOpener(f.opener);
    const SluiceAllocationCallbacks callbacks = {&shortage, allocate_in_shortage, free_in_shortage};
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                        .pCacheFolder = f.cache,
                                        .bakeThreadCount = 1,
                                        .pAllocator = &callbacks,
                                        .log = {&f, on_log}};
    CHECK_OK(sluiceCreateImageOpener(&info, &f.opener));
    store_path(&f, f.png, shortage.path);
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
    assert_true(wait_for(source).ready);
    assert_true(atomic_load(&shortage.left) <= 0); /* or nothing was refused */
    check_baked(&f, source, f.png);
    sluiceDestroyImageSource(source);
    teardown(&f);
}

static void a_damaged_store_is_baked_again(void **state)
{
    (void)state;
    static const long parts[][2] = {{0, 200}, {4096, 8192}, {8192, 0}}; /* header, index, tiles */
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        struct fixture f;
        char path[512];
        struct stat status;
        SluiceImageSource *source;
        uint8_t texel[4];
        setup(&f);
        store_path(&f, f.png, path);
        CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
        assert_true(wait_for(source).ready);
        sluiceDestroyImageSource(source);
        assert_int_equal(stat(path, &status), 0);
        damage(path, parts[i][0], parts[i][1] ? parts[i][1] : (long)status.st_size);
        CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
        SluiceResult result = read_texel(source, 0, texel);
        assert_true(result == SLUICE_NOT_READY || (i == 0 && result == SLUICE_SUCCESS));
        assert_true(wait_for(source).ready);
        check_baked(&f, source, f.png);
        assert_int_equal(f.errors, 0);
        assert_true(f.warnings > 0);
        assert_non_null(strstr(f.last_warning, path));
        sluiceDestroyImageSource(source);
        teardown(&f);
    }
}

static void a_store_that_vanishes_is_baked_again_but_not_forever(void **state)
{
    (void)state;
    struct fixture f;
    char path[512], other[256];
    uint8_t texel[4];
    SluiceImageSource *source, *closer;
    setup(&f);
    store_path(&f, f.png, path);
    bake_folder_file(&f.folder, "b.png", other);
    write_picture(other, 64, 64, 5);
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
    CHECK_OK(sluiceOpenImageSource(f.opener, other, &closer)); /* the pool has one file open */
    assert_true(wait_for(source).ready);
    assert_true(wait_for(closer).ready);
    for (int i = 0; i < 3; i++) {
        CHECK_OK(read_texel(closer, 0, texel));
        unlink(path);
        CHECK_RESULT(read_texel(source, 0, texel),
                     i < 2 ? SLUICE_NOT_READY : SLUICE_ERROR_FILE_NOT_FOUND);
        if (i < 2)
            assert_true(wait_for(source).ready);
    }
    sluiceDestroyImageSource(source);
    sluiceDestroyImageSource(closer);
    teardown(&f);
}

/* Each file of a pool of one file is opened again when the other was read. */
static void openers_do_not_bake_over_the_stores_of_each_other(void **state)
{
    (void)state;
    struct fixture f, g;
    char other[256], path[512];
    uint8_t texel[4];
    SluiceImageSource *sources[2], *closers[2];
    setup(&f);
    memset(&g, 0, sizeof g);
    memcpy(g.cache, f.cache, sizeof f.cache);
    open_opener(&g, 0);
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
    teardown(&f);
}

static void reads_that_succeed_forgive_stores_that_vanished(void **state)
{
    (void)state;
    struct fixture f;
    char path[512], other[256];
    uint8_t texel[4];
    SluiceImageSource *source, *closer;
    setup(&f);
    store_path(&f, f.png, path);
    bake_folder_file(&f.folder, "b.png", other);
    write_picture(other, 64, 64, 5);
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
    CHECK_OK(sluiceOpenImageSource(f.opener, other, &closer));
    assert_true(wait_for(source).ready);
    assert_true(wait_for(closer).ready);
    for (int i = 0; i < 5; i++) {
        CHECK_OK(read_texel(source, 0, texel));
        CHECK_OK(read_texel(closer, 0, texel));
        unlink(path);
        CHECK_RESULT(read_texel(source, 0, texel), SLUICE_NOT_READY);
        assert_true(wait_for(source).ready);
    }
    sluiceDestroyImageSource(source);
    sluiceDestroyImageSource(closer);
    teardown(&f);
}

static void a_source_that_goes_cancels_its_bake(void **state)
{
    (void)state;
    struct fixture f;
    char path[512];
    SluiceImageSource *source;
    SluiceBaker *baker;
    SluiceBakerCreateInfo baker_info = {.structSize = sizeof baker_info, .threadCount = 1};
    SluiceBakeReport report = {.structSize = sizeof report};
    setup(&f);
    write_picture(f.png, 4096, 3000, 1); /* baked in seconds */
    store_path(&f, f.png, path);
    SluiceBakeInfo info = {.structSize = sizeof info, .pInputPath = f.png, .pOutputPath = path};
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
    SluiceOpenedImageInfo opened = state_of(source);
    for (int i = 0; i < 60000 && 4 * opened.doneTexels <= opened.totalTexels; i++) {
        wait_a_little();
        opened = state_of(source);
    }
    assert_false(opened.ready);
    sluiceDestroyImageSource(source);
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(f.errors, 0);
    CHECK_OK(sluiceCreateBaker(&baker_info, &baker));
    CHECK_OK(sluiceBakeFile(baker, &info, &report));
    assert_true(report.resumedTileCount > 0);
    sluiceDestroyBaker(baker);
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
    assert_true(state_of(source).ready);
    check_baked(&f, source, f.png);
    sluiceDestroyImageSource(source);
    teardown(&f);
}

static void a_store_that_another_process_writes_holds_up_no_other(void **state)
{
    (void)state;
    struct fixture f;
    char path[512], others[2][256];
    SluiceImageSource *waiting, *sources[2];
    setup(&f);
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
    teardown(&f);
}

static void a_source_that_waits_for_another_process_can_go(void **state)
{
    (void)state;
    struct fixture f;
    char path[512];
    SluiceImageSource *source;
    setup(&f);
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
    teardown(&f);
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
        struct fixture f;
        char paths[3][512], pictures[3][256];
        SluiceImageSource *kept = NULL, *source;
        struct stat status;
        int older = run % 2;
        bool is_older_open = run >= 2;
        setup(&f);
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
        open_opener(&f, (uint64_t)status.st_size * 5 / 2);
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
        teardown(&f);
    }
}

static void a_store_in_the_folder_that_is_open_by_its_own_name_stays(void **state)
{
    (void)state;
    struct fixture f;
    char path[512];
    uint8_t texel[4];
    SluiceImageSource *plain, *source;
    setup(&f);
    sluiceDestroyImageOpener(f.opener);
    open_opener(&f, 1);
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
    teardown(&f);
}

static void pictures_that_are_broken_are_refused_or_fail_in_the_end(void **state)
{
    (void)state;
    struct fixture f;
    char path[256];
    uint8_t texel[4];
    SluiceImageSource *source = NULL;
    setup(&f);
    bake_folder_file(&f.folder, "x.png", path);
    FILE *file = fopen(path, "wb");
    fputs("not a picture at all", file);
    fclose(file);
    CHECK_RESULT(sluiceOpenImageSource(f.opener, path, &source), SLUICE_ERROR_CORRUPT_DATA);
    assert_non_null(strstr(f.last, path));
    assert_null(source);
    struct stat status;
    assert_int_equal(stat(f.png, &status), 0);
    assert_int_equal(truncate(f.png, status.st_size / 2), 0);
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
    SluiceOpenedImageInfo info = wait_for(source);
    assert_false(info.ready);
    assert_int_equal(info.failure, SLUICE_ERROR_CORRUPT_DATA);
    CHECK_RESULT(read_texel(source, 0, texel), SLUICE_ERROR_CORRUPT_DATA);
    sluiceDestroyImageSource(source);
    teardown(&f);
}

static void a_cache_folder_that_cannot_be_made_is_an_error(void **state)
{
    (void)state;
    struct fixture f;
    SluiceImageSource *source = NULL;
    setup(&f);
    sluiceDestroyImageOpener(f.opener);
    snprintf(f.cache, sizeof f.cache, "%s/cache", f.png); /* in a file */
    open_opener(&f, 0);
    CHECK_RESULT(sluiceOpenImageSource(f.opener, f.png, &source), SLUICE_ERROR_IO);
    assert_non_null(strstr(f.last, f.cache));
    assert_null(source);
    teardown(&f);
}

struct gate {
    pthread_t opener;
    atomic_bool is_open;
};

/* Threads of the background wait at the gate. */
static void *allocate_behind_gate(void *user, size_t size, size_t alignment)
{
    struct gate *gate = user;
    (void)alignment;
    while (!pthread_equal(pthread_self(), gate->opener) && !gate->is_open)
        wait_a_little();
    return malloc(size);
}

static void free_behind_gate(void *user, void *memory, size_t size)
{
    (void)user, (void)size;
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
        struct fixture f;
        char other[256], path[256];
        pthread_t first, second;
        struct slow_open slow = {.path = path};
        struct second_open again = {.first = &slow};
        SluiceImageSource *source;
        const SluiceAllocationCallbacks callbacks = {&slow, allocate_for_slow_open,
                                                     free_behind_gate};
        setup(&f);
        sluiceDestroyImageOpener(f.opener);
        SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                            .pCacheFolder = f.cache,
                                            .bakeThreadCount = 1,
                                            .pAllocator = &callbacks,
                                            .log = {&f, on_log}};
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
        teardown(&f);
    }
}

static void write_gray_picture(const char *path, uint32_t width, uint32_t height)
{
    uint8_t *samples = calloc((size_t)width * height, 1);
    write_png(path, samples, width, height, 1, false);
    free(samples);
}

/* Gives `path` the contents of `other`, and keeps size and time of the last change. */
static void replace_unnoticed(const char *path, const char *other)
{
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    const struct timespec times[2] = {status.st_atim, status.st_mtim};
    assert_int_equal(utimensat(AT_FDCWD, other, times, 0), 0);
    assert_int_equal(rename(other, path), 0);
}

static void a_preview_of_another_format_is_not_shown(void **state)
{
    (void)state;
    struct fixture f;
    char gray[256];
    struct stat status;
    SluiceImageSource *source;
    struct gate gate = {.opener = pthread_self()};
    SluiceAllocationCallbacks allocator = {&gate, allocate_behind_gate, free_behind_gate};
    setup(&f);
    sluiceDestroyImageOpener(f.opener);
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                        .pCacheFolder = f.cache,
                                        .bakeThreadCount = 1,
                                        .pAllocator = &allocator,
                                        .log = {&f, on_log}};
    CHECK_OK(sluiceCreateImageOpener(&info, &f.opener));
    bake_folder_file(&f.folder, "gray.png", gray);
    write_gray_picture(gray, WIDTH, HEIGHT);
    assert_int_equal(stat(f.png, &status), 0);
    assert_int_equal(truncate(gray, status.st_size), 0); /* readers stop at its last chunk */
    CHECK_OK(sluiceOpenImageSource(f.opener, gray, &source));
    replace_unnoticed(gray, f.png);
    gate.is_open = true;
    SluiceOpenedImageInfo opened = wait_for(source);
    assert_false(opened.previewReady);
    assert_int_equal(opened.failure, SLUICE_ERROR_IO);
    sluiceDestroyImageSource(source);
    teardown(&f);
}

static void a_fault_names_the_picture_also_when_its_store_is_gone(void **state)
{
    (void)state;
    struct fixture f;
    char path[512];
    struct stat status;
    uint8_t texel[4];
    SluiceImageSource *source;
    SluiceImageRegion region = {0, 0, 0, 1, 1, 0};
    SluiceImageFault fault;
    setup(&f);
    store_path(&f, f.png, path);
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
    assert_true(wait_for(source).ready);
    assert_int_equal(stat(path, &status), 0);
    damage(path, 8192, (long)status.st_size);
    CHECK_RESULT(sluiceReadImageRegionLocated(source, &region, texel, 4, &fault), SLUICE_NOT_READY);
    assert_true(wait_for(source).ready);
    assert_string_equal(fault.pName, f.png);
    sluiceDestroyImageSource(source);
    teardown(&f);
}

/* One call is refused; those of the background make the bake fail or nothing. */
/* Opens it with settings, and compares every level with a bake of our own with these settings. */
static void check_settings(struct fixture *f, const SluiceBakeSettings *settings,
                           SluiceFormat format, SluiceImageAddressMode mode)
{
    SluiceImageSource *source;
    char baked[256];
    SluiceImageInfo before = {.structSize = sizeof before}, after = before;
    bake_folder_file(&f->folder, "baked.store", baked);
    bake_picture_file(f->png, baked, settings);
    CHECK_OK(sluiceOpenBakedImageSource(f->opener, f->png, settings, &source));
    CHECK_OK(sluiceGetImageInfo(source, &before));
    assert_true(wait_for(source).ready);
    for (uint32_t level = 0; level < before.mipLevelCount; level++) {
        size_t size;
        uint8_t *expected = read_bytes(baked, level, &size), *texels = malloc(size);
        SluiceImageRegion region = {
            level, 0, 0, slc_mip_size(before.width, level), slc_mip_size(before.height, level), 0};
        CHECK_OK(sluiceReadImageRegion(source, &region, texels, (size_t)region.width * 4));
        assert_memory_equal(texels, expected, size);
        free(expected);
        free(texels);
    }
    sluiceDestroyImageSource(source);
    /* Once more, from the cache. */
    CHECK_OK(sluiceOpenBakedImageSource(f->opener, f->png, settings, &source));
    CHECK_OK(sluiceGetImageInfo(source, &after));
    assert_true(state_of(source).ready);
    assert_true(before.format == format && after.format == format);
    assert_true(before.addressModeU == mode && after.addressModeU == mode);
    sluiceDestroyImageSource(source);
}

static void pictures_are_baked_with_the_settings_they_are_opened_with(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f);
    const SluiceBakeSettings usual = {.structSize = sizeof usual},
                             normals = {.structSize = sizeof normals, .normalMap = true},
                             repeated = {.structSize = sizeof repeated,
                                         .wrapX = SLUICE_BAKE_WRAP_REPEAT,
                                         .transfer = SLUICE_BAKE_TRANSFER_LINEAR},
                             wrong = {.structSize = sizeof wrong, .cutout = 2};
    check_settings(&f, &normals, SLUICE_FORMAT_R8G8B8A8_UNORM,
                   SLUICE_IMAGE_ADDRESS_MODE_CLAMP_TO_EDGE);
    check_settings(&f, &repeated, SLUICE_FORMAT_R8G8B8A8_UNORM, SLUICE_IMAGE_ADDRESS_MODE_REPEAT);
    check_settings(&f, &usual, SLUICE_FORMAT_R8G8B8A8_SRGB,
                   SLUICE_IMAGE_ADDRESS_MODE_CLAMP_TO_EDGE);
    SluiceImageSource *sources[3], *none;
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &sources[0]));
    CHECK_OK(sluiceOpenBakedImageSource(f.opener, f.png, &usual, &sources[1]));
    CHECK_OK(sluiceOpenBakedImageSource(f.opener, f.png, &normals, &sources[2]));
    assert_ptr_equal(sources[0], sources[1]);
    assert_ptr_not_equal(sources[0], sources[2]);
    for (int i = 0; i < 3; i++)
        assert_true(state_of(sources[i]).ready);
    CHECK_RESULT(sluiceOpenBakedImageSource(f.opener, f.png, &wrong, &none),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    for (int i = 0; i < 3; i++)
        sluiceDestroyImageSource(sources[i]);
    teardown(&f);
}

static void every_refused_allocation_is_survived(void **state)
{
    (void)state;
    struct bake_folder folder;
    const SluiceBakeSettings normals = {.structSize = sizeof normals, .normalMap = true};
    char path[256], cache[256], command[400];
    bake_folder_init(&folder);
    bake_folder_file(&folder, "a.png", path);
    bake_folder_file(&folder, "cache", cache);
    write_picture(path, 40, 30, 3); /* has no preview, so that one thread allocates at a time */
    bool has_refused = true;
    for (uint64_t n = 0; has_refused; n++) {
        struct failing_allocator a;
        SluiceImageOpener *opener = NULL;
        SluiceImageSource *source = NULL;
        failing_allocator_init(&a, n);
        a.refuse_count = 1;
        SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                            .pCacheFolder = cache,
                                            .bakeThreadCount = 1,
                                            .pAllocator = &a.callbacks};
        SluiceResult result = sluiceCreateImageOpener(&info, &opener);
        if (result == SLUICE_SUCCESS)
            result = sluiceOpenBakedImageSource(opener, path, &normals, &source);
        if (result == SLUICE_SUCCESS) {
            SluiceOpenedImageInfo opened = wait_for(source);
            assert_true(opened.ready || opened.failure == SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        } else {
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        }
        sluiceDestroyImageSource(source);
        sluiceDestroyImageOpener(opener);
        assert_int_equal(a.live_bytes, 0);
        has_refused = a.calls > n;
        snprintf(command, sizeof command, "rm -rf '%s'", cache);
        assert_int_equal(system(command), 0);
    }
    bake_folder_finish(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coarse_levels_come_first_and_all_of_them_in_the_end),
        cmocka_unit_test(the_store_is_kept_for_the_next_time),
        cmocka_unit_test(a_picture_that_changed_is_baked_again),
        cmocka_unit_test(a_shortage_of_memory_after_a_bake_is_not_kept),
        cmocka_unit_test(a_damaged_store_is_baked_again),
        cmocka_unit_test(a_store_that_vanishes_is_baked_again_but_not_forever),
        cmocka_unit_test(openers_do_not_bake_over_the_stores_of_each_other),
        cmocka_unit_test(reads_that_succeed_forgive_stores_that_vanished),
        cmocka_unit_test(a_source_that_goes_cancels_its_bake),
        cmocka_unit_test(a_store_that_another_process_writes_holds_up_no_other),
        cmocka_unit_test(a_source_that_waits_for_another_process_can_go),
        cmocka_unit_test(old_stores_make_room_and_those_in_use_stay),
        cmocka_unit_test(a_store_in_the_folder_that_is_open_by_its_own_name_stays),
        cmocka_unit_test(pictures_that_are_broken_are_refused_or_fail_in_the_end),
        cmocka_unit_test(a_cache_folder_that_cannot_be_made_is_an_error),
        cmocka_unit_test(a_file_that_opens_slowly_holds_up_no_other),
        cmocka_unit_test(a_preview_of_another_format_is_not_shown),
        cmocka_unit_test(a_fault_names_the_picture_also_when_its_store_is_gone),
        cmocka_unit_test(pictures_are_baked_with_the_settings_they_are_opened_with),
        cmocka_unit_test(every_refused_allocation_is_survived),
    };
    return RUN_TESTS(tests);
}
