/* Pictures without tiles: coarse levels first, then the store of a bake, which is kept. */
#define _XOPEN_SOURCE 700

#include <sluice/bake.h>
#include <sluice/open.h>
#include <sluice/store.h>

#include "bake/baked.h"
#include "base/cache_folder.h"
#include "base/checked.h"
#include "open/picture_rig.h"
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

static void coarse_levels_come_first_and_all_of_them_in_the_end(void **state)
{
    (void)state;
    struct picture_fixture f;
    char path[512];
    uint8_t texel[4];
    SluiceImageSource *source;
    SluiceImageInfo image = {.structSize = sizeof image};
    picture_setup(&f);
    CHECK_OK(slc_cache_folder_make(f.cache, NULL));
    store_path(&f, f.png, path);
    SluiceStoreWriter *writer = begin_writing(path); /* while it is there no bake can begin */
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
    CHECK_OK(sluiceGetImageInfo(source, &image));
    assert_int_equal(image.width, PICTURE_WIDTH);
    assert_int_equal(image.height, PICTURE_HEIGHT);
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
    picture_teardown(&f);
}

static void the_store_is_kept_for_the_next_time(void **state)
{
    (void)state;
    struct picture_fixture f;
    char path[512];
    struct stat before, after;
    SluiceImageSource *source;
    picture_setup(&f);
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
        picture_opener(&f, 0);
    }
    assert_int_equal(before.st_ino, after.st_ino);
    assert_int_equal(f.errors, 0);
    picture_teardown(&f);
}

static void a_picture_that_changed_is_baked_again(void **state)
{
    (void)state;
    struct picture_fixture f;
    SluiceImageSource *first, *changed;
    SluiceImageInfo image = {.structSize = sizeof image};
    picture_setup(&f);
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
    picture_teardown(&f);
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
    struct picture_fixture f;
    struct shortage shortage = {"", 3};
    SluiceImageSource *source;
    picture_setup(&f);
    sluiceDestroyImageOpener(f.opener);
    const SluiceAllocationCallbacks callbacks = {&shortage, allocate_in_shortage, free_in_shortage};
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                        .pCacheFolder = f.cache,
                                        .bakeThreadCount = 1,
                                        .pAllocator = &callbacks,
                                        .log = {&f, picture_log}};
    CHECK_OK(sluiceCreateImageOpener(&info, &f.opener));
    store_path(&f, f.png, shortage.path);
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
    assert_true(wait_for(source).ready);
    assert_true(atomic_load(&shortage.left) <= 0); /* or nothing was refused */
    check_baked(&f, source, f.png);
    sluiceDestroyImageSource(source);
    picture_teardown(&f);
}

static void a_damaged_store_is_baked_again(void **state)
{
    (void)state;
    static const long parts[][2] = {{0, 200}, {4096, 8192}, {8192, 0}}; /* header, index, tiles */
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        struct picture_fixture f;
        char path[512];
        struct stat status;
        SluiceImageSource *source;
        uint8_t texel[4];
        picture_setup(&f);
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
        picture_teardown(&f);
    }
}

static void a_store_that_vanishes_is_baked_again_but_not_forever(void **state)
{
    (void)state;
    struct picture_fixture f;
    char path[512], other[256];
    uint8_t texel[4];
    SluiceImageSource *source, *closer;
    picture_setup(&f);
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
    picture_teardown(&f);
}

static void reads_that_succeed_forgive_stores_that_vanished(void **state)
{
    (void)state;
    struct picture_fixture f;
    char path[512], other[256];
    uint8_t texel[4];
    SluiceImageSource *source, *closer;
    picture_setup(&f);
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
    picture_teardown(&f);
}

static void a_source_that_goes_cancels_its_bake(void **state)
{
    (void)state;
    struct picture_fixture f;
    char path[512];
    SluiceImageSource *source;
    SluiceBaker *baker;
    SluiceBakerCreateInfo baker_info = {.structSize = sizeof baker_info, .threadCount = 1};
    SluiceBakeReport report = {.structSize = sizeof report};
    picture_setup(&f);
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
    picture_teardown(&f);
}

static void pictures_that_are_broken_are_refused_or_fail_in_the_end(void **state)
{
    (void)state;
    struct picture_fixture f;
    char path[256];
    uint8_t texel[4];
    SluiceImageSource *source = NULL;
    picture_setup(&f);
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
    picture_teardown(&f);
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
    struct picture_fixture f;
    char gray[256];
    struct stat status;
    SluiceImageSource *source;
    struct gate gate = {.opener = pthread_self()};
    SluiceAllocationCallbacks allocator = {&gate, allocate_behind_gate, free_behind_gate};
    picture_setup(&f);
    sluiceDestroyImageOpener(f.opener);
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                        .pCacheFolder = f.cache,
                                        .bakeThreadCount = 1,
                                        .pAllocator = &allocator,
                                        .log = {&f, picture_log}};
    CHECK_OK(sluiceCreateImageOpener(&info, &f.opener));
    bake_folder_file(&f.folder, "gray.png", gray);
    write_gray_picture(gray, PICTURE_WIDTH, PICTURE_HEIGHT);
    assert_int_equal(stat(f.png, &status), 0);
    assert_int_equal(truncate(gray, status.st_size), 0); /* readers stop at its last chunk */
    CHECK_OK(sluiceOpenImageSource(f.opener, gray, &source));
    replace_unnoticed(gray, f.png);
    gate.is_open = true;
    SluiceOpenedImageInfo opened = wait_for(source);
    assert_false(opened.previewReady);
    assert_int_equal(opened.failure, SLUICE_ERROR_IO);
    sluiceDestroyImageSource(source);
    picture_teardown(&f);
}

static void a_fault_names_the_picture_also_when_its_store_is_gone(void **state)
{
    (void)state;
    struct picture_fixture f;
    char path[512];
    struct stat status;
    uint8_t texel[4];
    SluiceImageSource *source;
    SluiceImageRegion region = {0, 0, 0, 1, 1, 0};
    SluiceImageFault fault;
    picture_setup(&f);
    store_path(&f, f.png, path);
    CHECK_OK(sluiceOpenImageSource(f.opener, f.png, &source));
    assert_true(wait_for(source).ready);
    assert_int_equal(stat(path, &status), 0);
    damage(path, 8192, (long)status.st_size);
    CHECK_RESULT(sluiceReadImageRegionLocated(source, &region, texel, 4, &fault), SLUICE_NOT_READY);
    assert_true(wait_for(source).ready);
    assert_string_equal(fault.pName, f.png);
    sluiceDestroyImageSource(source);
    picture_teardown(&f);
}

/* One call is refused; those of the background make the bake fail or nothing. */
/* Opens it with settings, and compares every level with a bake of our own with these settings. */
static void check_settings(struct picture_fixture *f, const SluiceBakeSettings *settings,
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
    struct picture_fixture f;
    picture_setup(&f);
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
    picture_teardown(&f);
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
        cmocka_unit_test(reads_that_succeed_forgive_stores_that_vanished),
        cmocka_unit_test(a_source_that_goes_cancels_its_bake),
        cmocka_unit_test(pictures_that_are_broken_are_refused_or_fail_in_the_end),
        cmocka_unit_test(a_preview_of_another_format_is_not_shown),
        cmocka_unit_test(a_fault_names_the_picture_also_when_its_store_is_gone),
        cmocka_unit_test(pictures_are_baked_with_the_settings_they_are_opened_with),
        cmocka_unit_test(every_refused_allocation_is_survived),
    };
    return RUN_TESTS(tests);
}
