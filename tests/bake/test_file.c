/* sluiceBakeFile beside its filters: equal results for any strips and threads; after an error, no
 * file. */
#define _XOPEN_SOURCE 700

#include "bake/baked.h"

#include "base/checked.h"
#include "support/failing_allocator.h"
#include "support/fault_source.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

static uint8_t *random_bytes(size_t count, uint32_t random)
{
    uint8_t *bytes = malloc(count);
    for (size_t i = 0; i < count; i++) {
        random = random * 1664525u + 1013904223u;
        bytes[i] = (uint8_t)(random >> 24);
    }
    return bytes;
}

static SluiceResult bake(uint32_t threads, uint64_t memory, const SluiceBakeInfo *info,
                         SluiceBakeReport *report)
{
    SluiceBakerCreateInfo create = {
        .structSize = sizeof create, .threadCount = threads, .maxMemory = memory};
    SluiceBaker *baker;
    CHECK_OK(sluiceCreateBaker(&create, &baker));
    SluiceResult result = sluiceBakeFile(baker, info, report);
    sluiceDestroyBaker(baker);
    return result;
}

static void check_same(const char *a, const char *b, uint32_t level_count)
{
    for (uint32_t level = 0; level < level_count; level++) {
        size_t size_a, size_b;
        void *bytes_a = read_bytes(a, level, &size_a), *bytes_b = read_bytes(b, level, &size_b);
        assert_int_equal(size_a, size_b);
        assert_memory_equal(bytes_a, bytes_b, size_a);
        free(bytes_a);
        free(bytes_b);
    }
}

/* Strips of 64 rows from a file, of 128 from a source, on 1 and on 5 threads. */
static void strips_and_threads_do_not_matter(void **state)
{
    (void)state;
    struct bake_folder folder;
    struct plain_source source;
    char picture[256], first[256], second[256];
    uint8_t *samples = random_bytes(517 * 701 * 4, 1);
    bake_folder_init(&folder);
    bake_folder_file(&folder, "picture.png", picture);
    bake_folder_file(&folder, "first.store", first);
    bake_folder_file(&folder, "second.store", second);
    write_png(picture, samples, 517, 701, 4, false);
    plain_source_init(&source, SLUICE_FORMAT_R8G8B8A8_SRGB, 517, 701, samples);
    for (int filter = 0; filter < 2; filter++) {
        SluiceBakeSettings settings = {.structSize = sizeof settings,
                                       .filter = filter,
                                       .alpha = SLUICE_BAKE_ALPHA_STRAIGHT,
                                       .wrapX = SLUICE_BAKE_WRAP_MIRROR,
                                       .wrapY = SLUICE_BAKE_WRAP_REPEAT};
        SluiceBakeInfo info = {.structSize = sizeof info,
                               .pInputPath = picture,
                               .pOutputPath = first,
                               .pSettings = &settings};
        CHECK_OK(bake(5, 0, &info, NULL));
        info.pInputPath = NULL;
        info.source = &source.base;
        info.pOutputPath = second;
        CHECK_OK(bake(1, 0, &info, NULL));
        check_same(first, second, 10);
    }
    free(samples);
    bake_folder_finish(&folder);
}

static void sources_that_fail_leave_nothing(void **state)
{
    (void)state;
    struct bake_folder folder;
    struct plain_source plain;
    struct fault_source faults;
    char path[256];
    uint8_t *samples = random_bytes(300 * 400, 2);
    bake_folder_init(&folder);
    bake_folder_file(&folder, "out.store", path);
    plain_source_init(&plain, SLUICE_FORMAT_R8_UNORM, 300, 400, samples);
    fault_source_init(&faults, &plain.base);
    faults.fail_at = 3;
    faults.failure = SLUICE_ERROR_IO;
    SluiceBakeInfo info = {.structSize = sizeof info, .source = &faults.base, .pOutputPath = path};
    CHECK_RESULT(bake(2, 0, &info, NULL), SLUICE_ERROR_IO);
    assert_int_equal(access(path, F_OK), -1);
    fault_source_finish(&faults);
    assert_int_equal(rmdir(folder.path), 0);
    free(samples);
}

static bool stop_at_half(void *user, uint64_t done, uint64_t total)
{
    (void)user;
    return done < total / 2;
}

static void a_canceled_bake_is_gone_on_with(void **state)
{
    (void)state;
    struct bake_folder folder;
    char picture[256], path[256], whole[256];
    uint8_t *samples = random_bytes(512 * 1024 * 3, 3);
    SluiceBakeReport report = {.structSize = sizeof report};
    bake_folder_init(&folder);
    bake_folder_file(&folder, "picture.png", picture);
    bake_folder_file(&folder, "out.store", path);
    bake_folder_file(&folder, "whole.store", whole);
    write_png(picture, samples, 512, 1024, 3, false);
    SluiceBakeInfo info = {.structSize = sizeof info,
                           .pInputPath = picture,
                           .pOutputPath = path,
                           .pfnProgress = stop_at_half};
    CHECK_RESULT(bake(1, 0, &info, NULL), SLUICE_ERROR_CANCELED);
    assert_int_equal(access(path, F_OK), -1);
    info.pfnProgress = NULL;
    CHECK_OK(bake(1, 0, &info, &report));
    assert_true(report.resumedTileCount > 0);
    info.pOutputPath = whole;
    CHECK_OK(bake(1, 0, &info, &report));
    assert_int_equal(report.resumedTileCount, 0);
    check_same(path, whole, 11);
    free(samples);
    bake_folder_finish(&folder);
}

static void what_is_up_to_date_is_skipped_until_something_changes(void **state)
{
    (void)state;
    struct bake_folder folder;
    char picture[256], path[256];
    uint8_t *samples = random_bytes(64 * 64 * 3, 4);
    SluiceBakeReport report = {.structSize = sizeof report};
    bake_folder_init(&folder);
    bake_folder_file(&folder, "picture.png", picture);
    bake_folder_file(&folder, "out.store", path);
    write_png(picture, samples, 64, 64, 3, false);
    SluiceBakeInfo info = {.structSize = sizeof info, .pInputPath = picture, .pOutputPath = path};
    CHECK_OK(bake(1, 0, &info, &report));
    assert_false(report.skipped);
    CHECK_OK(bake(1, 0, &info, &report));
    assert_true(report.skipped && report.width == 64 && report.outputSize > 0);
    SluiceBakeSettings settings = {.structSize = sizeof settings,
                                   .filter = SLUICE_BAKE_FILTER_KAISER};
    info.pSettings = &settings;
    CHECK_OK(bake(1, 0, &info, &report));
    assert_false(report.skipped);
    const struct timespec times[2] = {{1000000, 5}, {1000000, 5}};
    assert_int_equal(utimensat(AT_FDCWD, picture, times, 0), 0);
    CHECK_OK(bake(1, 0, &info, &report));
    assert_false(report.skipped);
    CHECK_OK(bake(1, 0, &info, &report));
    assert_true(report.skipped);
    info.force = true;
    CHECK_OK(bake(1, 0, &info, &report));
    assert_false(report.skipped);
    free(samples);
    bake_folder_finish(&folder);
}

static void too_little_memory_is_refused_and_the_rest_is_kept_to(void **state)
{
    (void)state;
    struct bake_folder folder;
    struct plain_source source;
    char path[256];
    SluiceBakeReport report = {.structSize = sizeof report};
    uint8_t *samples = random_bytes(4000 * 16, 5);
    bake_folder_init(&folder);
    bake_folder_file(&folder, "out.store", path);
    plain_source_init(&source, SLUICE_FORMAT_R8_UNORM, 4000, 16, samples);
    SluiceBakeInfo info = {.structSize = sizeof info, .source = &source.base, .pOutputPath = path};
    CHECK_RESULT(bake(1, 1 << 20, &info, &report), SLUICE_ERROR_LIMIT_EXCEEDED);
    assert_int_equal(access(path, F_OK), -1);
    CHECK_OK(bake(1, report.memorySize, &info, NULL));
    free(samples);
    bake_folder_finish(&folder);
}

struct waiting_bake {
    SluiceBaker *baker;
    SluiceBakeInfo info;
    uint32_t calls;
    SluiceResult result;
};

static bool cancel_the_third_call(void *user, uint64_t done, uint64_t total)
{
    struct waiting_bake *other = user;
    assert_int_equal(done, 0);
    assert_int_equal(total, 0);
    return ++other->calls < 3;
}

/* Called by the bake that holds the memory. Another bake gets none before this call returns. */
static bool bake_another(void *user, uint64_t done, uint64_t total)
{
    struct waiting_bake *other = user;
    (void)done, (void)total;
    if (other->calls == 0)
        other->result = sluiceBakeFile(other->baker, &other->info, NULL);
    return true;
}

static void a_bake_that_waits_for_memory_can_be_canceled(void **state)
{
    (void)state;
    struct bake_folder folder;
    struct plain_source source;
    char path[256], other_path[256];
    uint8_t *samples = random_bytes(400 * 16, 5);
    SluiceBakeReport report = {.structSize = sizeof report};
    struct waiting_bake other = {.result = SLUICE_SUCCESS};
    bake_folder_init(&folder);
    bake_folder_file(&folder, "out.store", path);
    bake_folder_file(&folder, "other.store", other_path);
    plain_source_init(&source, SLUICE_FORMAT_R8_UNORM, 400, 16, samples);
    SluiceBakeInfo info = {.structSize = sizeof info, .source = &source.base, .pOutputPath = path};
    CHECK_OK(bake(1, 0, &info, &report));
    SluiceBakerCreateInfo create = {
        .structSize = sizeof create, .threadCount = 1, .maxMemory = report.memorySize};
    CHECK_OK(sluiceCreateBaker(&create, &other.baker));
    other.info = info;
    other.info.pOutputPath = other_path;
    other.info.pUserData = &other;
    other.info.pfnProgress = cancel_the_third_call;
    info.pUserData = &other;
    info.pfnProgress = bake_another;
    CHECK_OK(sluiceBakeFile(other.baker, &info, NULL));
    CHECK_RESULT(other.result, SLUICE_ERROR_CANCELED);
    assert_int_equal(other.calls, 3);
    assert_int_equal(access(other_path, F_OK), -1);
    sluiceDestroyBaker(other.baker);
    free(samples);
    bake_folder_finish(&folder);
}

/* One thread, because the allocator is not thread-safe. */
static void run_out_of_memory(const SluiceBakeInfo *info)
{
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator allocator;
        failing_allocator_init(&allocator, n);
        SluiceBakerCreateInfo create = {
            .structSize = sizeof create, .threadCount = 1, .pAllocator = &allocator.callbacks};
        SluiceBaker *baker = NULL;
        result = sluiceCreateBaker(&create, &baker);
        if (result == SLUICE_SUCCESS)
            result = sluiceBakeFile(baker, info, NULL);
        sluiceDestroyBaker(baker);
        if (result != SLUICE_SUCCESS) {
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            assert_int_equal(access(info->pOutputPath, F_OK), -1);
        }
        assert_int_equal(allocator.live_count, 0);
    }
}

static void no_memory_is_an_ordinary_result(void **state)
{
    (void)state;
    struct bake_folder folder;
    struct plain_source source;
    char path[256];
    uint8_t *samples = random_bytes(300 * 200 * 4, 6);
    bake_folder_init(&folder);
    bake_folder_file(&folder, "out.store", path);
    plain_source_init(&source, SLUICE_FORMAT_R8G8B8A8_SRGB, 300, 200, samples);
    SluiceBakeInfo info = {.structSize = sizeof info,
                           .source = &source.base,
                           .pOutputPath = path,
                           .pSettings =
                               &(SluiceBakeSettings){.structSize = sizeof(SluiceBakeSettings),
                                                     .alpha = SLUICE_BAKE_ALPHA_STRAIGHT,
                                                     .cutout = 0.5f}};
    run_out_of_memory(&info);
    free(samples);
    bake_folder_finish(&folder);
}

/* Copies a store of blocks to another one, tile by tile on several threads. Repeats it while memory
 * runs out. */
static void blocks_are_copied_as_they_are(void **state)
{
    (void)state;
    struct bake_folder folder;
    struct plain_source plain;
    char first[256], second[256];
    uint8_t *samples = random_bytes(1100 * 700 * 4, 7);
    SluiceImageSource *blocks;
    bake_folder_init(&folder);
    bake_folder_file(&folder, "first.store", first);
    bake_folder_file(&folder, "second.store", second);
    plain_source_init(&plain, SLUICE_FORMAT_R8G8B8A8_SRGB, 1100, 700, samples);
    SluiceBakeInfo info = {.structSize = sizeof info,
                           .source = &plain.base,
                           .pOutputPath = first,
                           .pSettings =
                               &(SluiceBakeSettings){.structSize = sizeof(SluiceBakeSettings),
                                                     .format = SLUICE_FORMAT_BC4_UNORM_BLOCK,
                                                     .transfer = SLUICE_BAKE_TRANSFER_LINEAR}};
    SluiceResult result = bake(2, 0, &info, NULL);
    if (result == SLUICE_ERROR_UNSUPPORTED) {
        free(samples);
        bake_folder_finish(&folder);
        SKIP_TEST("this build makes no blocks");
    }
    CHECK_OK(result);
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = first};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &blocks));
    info = (SluiceBakeInfo){
        .structSize = sizeof(SluiceBakeInfo), .source = blocks, .pOutputPath = second};
    CHECK_OK(bake(5, 0, &info, NULL));
    check_same(first, second, 11);
    unlink(second);
    run_out_of_memory(&info);
    sluiceDestroyImageSource(blocks);
    free(samples);
    bake_folder_finish(&folder);
}

static void wrong_settings_are_refused(void **state)
{
    (void)state;
    const SluiceBakeSettings wrong[] = {
        {.structSize = sizeof(SluiceBakeSettings), .format = SLUICE_FORMAT_COUNT},
        {.structSize = sizeof(SluiceBakeSettings), .transfer = 3},
        {.structSize = sizeof(SluiceBakeSettings), .alpha = 3},
        {.structSize = sizeof(SluiceBakeSettings), .filter = 2},
        {.structSize = sizeof(SluiceBakeSettings), .wrapX = 3},
        {.structSize = sizeof(SluiceBakeSettings), .wrapY = 3},
        {.structSize = sizeof(SluiceBakeSettings), .cutout = 1.5f},
        {.structSize = sizeof(SluiceBakeSettings), .cutout = -0.5f},
        {.structSize = sizeof(SluiceBakeSettings), .compressionLevel = 23},
        {.structSize = sizeof(SluiceBakeSettings),
         .normalMap = true,
         .transfer = SLUICE_BAKE_TRANSFER_SRGB}};
    uint8_t texel = 0;
    struct plain_source source;
    plain_source_init(&source, SLUICE_FORMAT_R8_UNORM, 1, 1, &texel);
    SluiceBakeInfo info = {
        .structSize = sizeof info, .source = &source.base, .pOutputPath = "/nowhere/at/all.store"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        info.pSettings = &wrong[i];
        CHECK_RESULT(bake(1, 0, &info, NULL), SLUICE_ERROR_INVALID_ARGUMENT);
    }
    info.pSettings = &(SluiceBakeSettings){.structSize = sizeof(SluiceBakeSettings),
                                           .format = SLUICE_FORMAT_BC2_UNORM_BLOCK};
    CHECK_RESULT(bake(1, 0, &info, NULL), SLUICE_ERROR_UNSUPPORTED);
    info.pSettings = NULL;
    CHECK_RESULT(bake(1, 0, &info, NULL), SLUICE_ERROR_FILE_NOT_FOUND);
    info.pOutputPath = NULL;
    CHECK_RESULT(bake(1, 0, &info, NULL), SLUICE_ERROR_NULL_POINTER);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strips_and_threads_do_not_matter),
        cmocka_unit_test(sources_that_fail_leave_nothing),
        cmocka_unit_test(a_canceled_bake_is_gone_on_with),
        cmocka_unit_test(what_is_up_to_date_is_skipped_until_something_changes),
        cmocka_unit_test(too_little_memory_is_refused_and_the_rest_is_kept_to),
        cmocka_unit_test(a_bake_that_waits_for_memory_can_be_canceled),
        cmocka_unit_test(no_memory_is_an_ordinary_result),
        cmocka_unit_test(blocks_are_copied_as_they_are),
        cmocka_unit_test(wrong_settings_are_refused),
    };
    return RUN_TESTS(tests);
}
