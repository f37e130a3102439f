/* One source, many threads; and a source whose memory is refused at every point. */
#include <sluice/exr.h>
#include <sluice/loader.h>

#include "base/checked.h"
#include "exr/exr_paths.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS = 4, READS = 60 };

struct reader {
    SluiceImageSource *source;
    SluiceImageInfo info;
    char **levels; ///< each level as a single thread read it from another source
    uint32_t random, mismatches;
};

static SluiceImageSource *open_own(const char *name, const SluiceAllocationCallbacks *allocator)
{
    char path[1024];
    SluiceImageSource *source = NULL;
    SluiceExrImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = own_file(name, path), .pAllocator = allocator};
    CHECK_OK(sluiceCreateExrImageSource(&create, &source));
    return source;
}

static uint32_t draw(struct reader *reader, uint32_t below)
{
    reader->random = reader->random * 1664525u + 1013904223u;
    return (reader->random >> 12) % below;
}

static bool matches(const struct reader *reader, const SluiceImageRegion *region,
                    const char *texels)
{
    size_t size = sluiceGetFormatTexelSize(reader->info.format);
    size_t pitch = slc_mip_size(reader->info.width, region->mipLevel) * size;
    for (uint32_t y = 0; y < region->height; y++)
        if (memcmp(texels + y * region->width * size,
                   reader->levels[region->mipLevel] + (region->y + y) * pitch + region->x * size,
                   region->width * size) != 0)
            return false;
    return true;
}

static void *read_at_random(void *argument)
{
    struct reader *reader = argument;
    for (int i = 0; i < READS; i++) {
        uint32_t level = draw(reader, reader->info.mipLevelCount);
        uint32_t width = slc_mip_size(reader->info.width, level);
        uint32_t height = slc_mip_size(reader->info.height, level);
        SluiceImageRegion region = {level, draw(reader, width), draw(reader, height), 0, 0};
        region.width = 1 + draw(reader, width - region.x);
        region.height = 1 + draw(reader, height - region.y);
        size_t pitch = region.width * sluiceGetFormatTexelSize(reader->info.format);
        char *texels = malloc(pitch * region.height);
        if (sluiceReadImageRegion(reader->source, &region, texels, pitch) != SLUICE_SUCCESS ||
            !matches(reader, &region, texels))
            reader->mismatches++;
        free(texels);
    }
    return NULL;
}

static char **read_levels(SluiceImageSource *source, const SluiceImageInfo *info)
{
    char **levels = calloc(info->mipLevelCount, sizeof *levels);
    for (uint32_t level = 0; level < info->mipLevelCount; level++) {
        SluiceImageRegion region = {level, 0, 0, slc_mip_size(info->width, level),
                                    slc_mip_size(info->height, level)};
        size_t pitch = region.width * sluiceGetFormatTexelSize(info->format);
        levels[level] = malloc(pitch * region.height);
        CHECK_OK(sluiceReadImageRegion(source, &region, levels[level], pitch));
    }
    return levels;
}

static void threads_that_read_at_once_get_what_one_thread_gets(void **state)
{
    (void)state;
    static const char *const names[] = {"scan_piz.exr", "one_level.exr", "mip_zip.exr",
                                        "mip_none.exr", "rip_up.exr"};
    for (size_t n = 0; n < sizeof names / sizeof names[0]; n++) {
        SluiceImageInfo info = {.structSize = sizeof info};
        SluiceImageSource *alone = open_own(names[n], NULL), *shared = open_own(names[n], NULL);
        CHECK_OK(sluiceGetImageInfo(alone, &info));
        char **levels = read_levels(alone, &info);
        pthread_t threads[THREADS];
        struct reader readers[THREADS];
        for (uint32_t i = 0; i < THREADS; i++) {
            readers[i] = (struct reader){shared, info, levels, i + 1, 0};
            assert_int_equal(pthread_create(&threads[i], NULL, read_at_random, &readers[i]), 0);
        }
        for (uint32_t i = 0; i < THREADS; i++) {
            pthread_join(threads[i], NULL);
            assert_int_equal(readers[i].mismatches, 0);
        }
        for (uint32_t level = 0; level < info.mipLevelCount; level++)
            free(levels[level]);
        free(levels);
        sluiceDestroyImageSource(alone);
        sluiceDestroyImageSource(shared);
    }
}

/* Only the build allocates, under the source's lock, so counting needs none of its own. */
static void a_chain_is_built_once_however_many_wait_for_it(void **state)
{
    (void)state;
    uint64_t calls[2];
    for (int round = 0; round < 2; round++) {
        struct failing_allocator allocator;
        failing_allocator_init(&allocator, UINT64_MAX);
        SluiceImageSource *source = open_own("scan_zip.exr", &allocator.callbacks);
        SluiceTileLoaderCreateInfo create = {sizeof create, round ? 4 : 1, 0, NULL};
        SluiceTileLoader *loader;
        CHECK_OK(sluiceCreateTileLoader(&create, &loader));
        uint16_t texels[16][4];
        for (int i = 0; i < (round ? 16 : 1); i++) {
            SluiceImageRegion region = {0, (uint32_t)i, 3, 1, 1};
            void *place = texels[i];
            SluiceTileRead read = {source, 1, &region, &place, 0, 0};
            uint64_t ticket;
            CHECK_OK(sluiceSubmitTileRead(loader, &read, &ticket));
        }
        sluiceWaitTileLoaderIdle(loader);
        sluiceDestroyTileLoader(loader);
        calls[round] = allocator.calls;
        sluiceDestroyImageSource(source);
        assert_int_equal(allocator.live_bytes, 0);
    }
    assert_int_equal(calls[0], calls[1]);
}

static SluiceResult open_and_read(const char *path, const SluiceAllocationCallbacks *allocator)
{
    SluiceImageSource *source = NULL;
    SluiceExrImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = path, .pAllocator = allocator};
    SluiceResult result = sluiceCreateExrImageSource(&create, &source);
    uint16_t texel[4];
    for (uint32_t level = 0; level < 6 && result == SLUICE_SUCCESS; level++) {
        SluiceImageRegion region = {level, 0, 0, 1, 1};
        result = sluiceReadImageRegion(source, &region, texel, sizeof texel);
    }
    sluiceDestroyImageSource(source);
    return result;
}

static void every_refused_allocation_is_a_result_and_leaves_nothing(void **state)
{
    (void)state;
    static const char *const names[] = {"scan_zip.exr", "mip_zip.exr", "rip_down.exr"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
            char path[1024];
            struct failing_allocator allocator;
            assert_true(n < 1000);
            failing_allocator_init(&allocator, n);
            result = open_and_read(own_file(names[i], path), &allocator.callbacks);
            if (result != SLUICE_SUCCESS)
                CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            assert_int_equal(allocator.live_bytes, 0);
        }
    }
}

static void a_build_that_lacked_memory_succeeds_later(void **state)
{
    (void)state;
    struct failing_allocator allocator;
    failing_allocator_init(&allocator, UINT64_MAX);
    SluiceImageSource *source = open_own("scan_zip.exr", &allocator.callbacks);
    SluiceImageRegion region = {5, 0, 0, 1, 1};
    uint16_t texel[4];
    allocator.refuse_from = allocator.calls + 1;
    CHECK_RESULT(sluiceReadImageRegion(source, &region, texel, sizeof texel),
                 SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    allocator.refuse_from = UINT64_MAX;
    CHECK_OK(sluiceReadImageRegion(source, &region, texel, sizeof texel));
    sluiceDestroyImageSource(source);
    assert_int_equal(allocator.live_bytes, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_that_read_at_once_get_what_one_thread_gets),
        cmocka_unit_test(a_chain_is_built_once_however_many_wait_for_it),
        cmocka_unit_test(every_refused_allocation_is_a_result_and_leaves_nothing),
        cmocka_unit_test(a_build_that_lacked_memory_succeeds_later),
    };
    return RUN_TESTS(tests);
}
