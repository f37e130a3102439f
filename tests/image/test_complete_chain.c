/* The oracle is a source in memory, whose box filter has tests of its own. */
#include <sluice/image.h>

#include "base/checked.h"
#include "image/convert.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* The first levels of another source. */
struct cut_source {
    SluiceImageSource base;
    SluiceImageSource *whole; ///< owned
    uint32_t level_count;
    SluiceFormat format; ///< UNDEFINED: that of `whole`
    uint32_t reads;      ///< not while threads overlap, unless `is_shared`
    uint32_t fail_at;    ///< the read that fails, from 1; 0: none
    bool is_shared;
    SluiceResult failure;
};

static SluiceResult get_cut_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    struct cut_source *cut = (struct cut_source *)base;
    SluiceResult result = sluiceGetImageInfo(cut->whole, info);
    info->mipLevelCount = cut->level_count;
    if (cut->format)
        info->format = cut->format;
    return result;
}

static SluiceResult read_cut(SluiceImageSource *base, const SluiceImageRegion *region, void *texels,
                             size_t row_pitch, SluiceImageFault *fault)
{
    struct cut_source *cut = (struct cut_source *)base;
    assert_true(region->mipLevel < cut->level_count);
    if (!cut->is_shared && ++cut->reads == cut->fail_at) {
        fault->offset = 4711;
        return cut->failure;
    }
    return sluiceReadImageRegionLocated(cut->whole, region, texels, row_pitch, fault);
}

static void destroy_cut(SluiceImageSource *base)
{
    sluiceDestroyImageSource(((struct cut_source *)base)->whole);
}

static const SluiceImageSourceInterface cut_interface = {.structSize = sizeof cut_interface,
                                                         .pfnGetInfo = get_cut_info,
                                                         .pfnDestroy = destroy_cut,
                                                         .pfnReadRegionLocated = read_cut};

static void cut_init(struct cut_source *cut, SluiceFormat format, uint32_t width, uint32_t height,
                     uint32_t level_count)
{
    SluiceImageInfo info = {.structSize = sizeof info,
                            .width = width,
                            .height = height,
                            .format = format,
                            .pName = "cut"};
    size_t count = (size_t)width * height, size = sluiceGetFormatTexelSize(format);
    char *texels = malloc(count * size);
    uint32_t random = width * 31 + height;
    for (size_t i = 0; i < count; i++) {
        float rgba[4];
        for (int c = 0; c < 4; c++)
            rgba[c] = (float)((random = random * 1664525u + 1013904223u) >> 8) * 0x1p-23f - 0.5f;
        slc_texels_from_rgba(format, rgba, texels + i * size, 1);
    }
    *cut = (struct cut_source){.base = {&cut_interface}, .level_count = level_count};
    CHECK_OK(sluiceCreateMemoryImageSource(texels, &info, NULL, &cut->whole));
    free(texels);
}

static SluiceImageSource *complete(struct cut_source *cut, uint64_t max_memory)
{
    const SluiceCompleteChainSourceCreateInfo info = {
        .structSize = sizeof info, .source = &cut->base, .maxMemorySize = max_memory};
    SluiceImageSource *source = NULL;
    CHECK_OK(sluiceCreateCompleteChainSource(&info, &source));
    return source;
}

static void check_region(SluiceImageSource *whole, SluiceImageSource *source, SluiceFormat format,
                         const SluiceImageRegion *region)
{
    size_t pitch = region->width * (size_t)sluiceGetFormatTexelSize(format);
    char *expected = malloc(pitch * region->height), *texels = malloc(pitch * region->height);
    CHECK_OK(sluiceReadImageRegion(whole, region, expected, pitch));
    CHECK_OK(sluiceReadImageRegion(source, region, texels, pitch));
    if (memcmp(expected, texels, pitch * region->height) != 0)
        fail_msg("%s, level %u: %u x %u texels at (%u, %u) differ", sluiceGetFormatName(format),
                 region->mipLevel, region->width, region->height, region->x, region->y);
    free(expected);
    free(texels);
}

/* Compares all levels as a whole, and rectangles in them. */
static void check_levels(SluiceImageSource *whole, SluiceImageSource *source)
{
    SluiceImageInfo info = {.structSize = sizeof info}, expected = {.structSize = sizeof expected};
    CHECK_OK(sluiceGetImageInfo(whole, &expected));
    CHECK_OK(sluiceGetImageInfo(source, &info));
    assert_memory_equal(&info, &expected, sizeof info);
    uint32_t random = 1;
    for (uint32_t level = info.mipLevelCount; level-- > 0;) {
        uint32_t width = slc_mip_size(info.width, level), height = slc_mip_size(info.height, level);
        SluiceImageRegion region = {.mipLevel = level, .width = width, .height = height};
        check_region(whole, source, info.format, &region);
        for (uint32_t i = 0; i < 4; i++) {
            random = random * 1664525u + 1013904223u;
            region.x = (random >> 8) % width;
            region.y = (random >> 16) % height;
            region.width = 1 + (random >> 4) % (width - region.x);
            region.height = 1 + (random >> 12) % (height - region.y);
            check_region(whole, source, info.format, &region);
        }
    }
}

/* Runs with all levels kept, only the coarsest kept, and none. */
static void built_levels_are_those_of_the_same_texels_in_memory(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {2, 1}, {64, 64}, {301, 77}, {1, 500}, {517, 258}};
    static const uint64_t budgets[] = {0, 700, 1};
    for (SluiceFormat f = 1; f < SLUICE_FORMAT_COUNT; f++)
        for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
            for (size_t b = 0; b < sizeof budgets / sizeof budgets[0]; b++) {
                uint32_t full = slc_mip_count(slc_max_u32(sizes[s][0], sizes[s][1]));
                if (sluiceGetFormatTexelSize(f) == 0)
                    continue;
                struct cut_source cut;
                cut_init(&cut, f, sizes[s][0], sizes[s][1], 1 + (f + s + b) % full);
                SluiceImageSource *source = complete(&cut, budgets[b]);
                check_levels(cut.whole, source);
                sluiceDestroyImageSource(source);
                sluiceDestroyImageSource(&cut.base);
            }
}

static void layers_are_built_each_from_its_own(void **state)
{
    (void)state;
    struct cut_source cuts[2];
    SluiceImageSource *parts[2], *array;
    cut_init(&cuts[0], SLUICE_FORMAT_R8G8B8A8_SRGB, 65, 40, 2);
    cut_init(&cuts[1], SLUICE_FORMAT_R8G8B8A8_SRGB, 65, 40, 2);
    uint8_t texels[65 * 40 * 4];
    memset(texels, 77, sizeof texels);
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetImageInfo(cuts[0].whole, &info));
    sluiceDestroyImageSource(cuts[1].whole);
    CHECK_OK(sluiceCreateMemoryImageSource(texels, &info, NULL, &cuts[1].whole));
    for (uint32_t i = 0; i < 2; i++)
        parts[i] = &cuts[i].base;
    CHECK_OK(sluiceCreateArrayImageSource(parts, 2, NULL, &array));
    for (uint64_t budget = 0; budget < 1000; budget += 500) {
        const SluiceCompleteChainSourceCreateInfo create = {
            .structSize = sizeof create, .source = array, .maxMemorySize = budget};
        SluiceImageSource *source;
        CHECK_OK(sluiceCreateCompleteChainSource(&create, &source));
        for (uint32_t layer = 0; layer < 2; layer++)
            for (uint32_t level = 0; level < info.mipLevelCount; level++) {
                SluiceImageRegion region = {.mipLevel = level,
                                            .width = slc_mip_size(65, level),
                                            .height = slc_mip_size(40, level)};
                uint8_t expected[sizeof texels], got[sizeof texels];
                size_t pitch = 4 * region.width;
                CHECK_OK(sluiceReadImageRegion(cuts[layer].whole, &region, expected, pitch));
                region.arrayLayer = layer;
                CHECK_OK(sluiceReadImageRegion(source, &region, got, pitch));
                assert_memory_equal(expected, got, pitch * region.height);
            }
        sluiceDestroyImageSource(source);
    }
    sluiceDestroyImageSource(array);
    for (uint32_t i = 0; i < 2; i++)
        sluiceDestroyImageSource(&cuts[i].base);
}

/* Whichever read of the inner source fails: the reader learns where, and a later read succeeds. */
static void errors_reach_the_reader_and_are_not_kept(void **state)
{
    (void)state;
    static const SluiceResult failures[] = {SLUICE_ERROR_IO, SLUICE_ERROR_CORRUPT_DATA,
                                            SLUICE_NOT_READY};
    for (uint64_t budget = 0; budget < 2; budget++)
        for (uint32_t n = 1, failed = 1; failed; n++) {
            struct cut_source cut;
            cut_init(&cut, SLUICE_FORMAT_R8_UNORM, 700, 500, 1);
            cut.fail_at = n;
            cut.failure = failures[n % 3];
            SluiceImageSource *source = complete(&cut, budget);
            SluiceImageRegion region = {.mipLevel = 2, .width = 175, .height = 125};
            SluiceImageFault fault;
            char texels[175 * 125];
            SluiceResult result =
                sluiceReadImageRegionLocated(source, &region, texels, 175, &fault);
            failed = result != SLUICE_SUCCESS;
            if (failed) {
                CHECK_RESULT(result, cut.failure);
                assert_int_equal(fault.offset, 4711);
                assert_string_equal(fault.pName, "cut");
            } else {
                assert_true(n > 2);
            }
            cut.fail_at = 0;
            check_levels(cut.whole, source);
            sluiceDestroyImageSource(source);
            sluiceDestroyImageSource(&cut.base);
        }
}

/* 8 levels of 2048 x 2048 texels are kept in 64 KiB; a tile of a level that is not takes blocks. */
static void kept_levels_and_blocks_stay_within_their_bounds(void **state)
{
    (void)state;
    struct cut_source cut;
    struct failing_allocator memory;
    failing_allocator_init(&memory, UINT64_MAX);
    cut_init(&cut, SLUICE_FORMAT_R8G8B8A8_UNORM, 2048, 2048, 1);
    const SluiceCompleteChainSourceCreateInfo info = {.structSize = sizeof info,
                                                      .source = &cut.base,
                                                      .maxMemorySize = 65536,
                                                      .pAllocator = &memory.callbacks};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateCompleteChainSource(&info, &source));
    check_levels(cut.whole, source);
    assert_in_range(memory.live_bytes, 64 * 64 * 4, 65536 + 4096);
    uint32_t reads = cut.reads;
    SluiceImageRegion coarse = {.mipLevel = 5, .width = 64, .height = 64};
    char texels[64 * 64 * 4];
    CHECK_OK(sluiceReadImageRegion(source, &coarse, texels, sizeof texels / 64));
    assert_int_equal(cut.reads, reads);
    sluiceDestroyImageSource(source);
    sluiceDestroyImageSource(&cut.base);
    assert_int_equal(memory.live_count, 0);
}

static void every_call_survives_every_refused_allocation(void **state)
{
    (void)state;
    struct cut_source cut;
    cut_init(&cut, SLUICE_FORMAT_R8G8_UNORM, 300, 200, 1);
    for (uint64_t budget = 0; budget < 4000; budget += 2000) {
        SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
            struct failing_allocator memory;
            failing_allocator_init(&memory, n);
            const SluiceCompleteChainSourceCreateInfo info = {.structSize = sizeof info,
                                                              .source = &cut.base,
                                                              .maxMemorySize = budget,
                                                              .pAllocator = &memory.callbacks};
            SluiceImageRegion region = {.mipLevel = 3, .width = 37, .height = 25};
            SluiceImageSource *source = NULL;
            char texels[37 * 25 * 2];
            result = sluiceCreateCompleteChainSource(&info, &source);
            if (result == SLUICE_SUCCESS)
                result = sluiceReadImageRegion(source, &region, texels, 37 * 2);
            if (result != SLUICE_SUCCESS)
                CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            if (source && result != SLUICE_SUCCESS) { /* the next read has memory again */
                memory.refuse_from = UINT64_MAX;
                check_levels(cut.whole, source);
            }
            sluiceDestroyImageSource(source);
            assert_int_equal(memory.live_count, 0);
        }
    }
    sluiceDestroyImageSource(&cut.base);
}

struct reader {
    SluiceImageSource *whole, *source;
    pthread_t thread;
};

static void *read_all(void *user)
{
    struct reader *reader = user;
    check_levels(reader->whole, reader->source);
    return NULL;
}

static void threads_may_read_at_the_same_time(void **state)
{
    (void)state;
    struct cut_source cut;
    struct reader readers[4];
    cut_init(&cut, SLUICE_FORMAT_R8G8B8A8_UNORM, 400, 300, 1);
    cut.is_shared = true;
    SluiceImageSource *source = complete(&cut, 9000);
    for (uint32_t i = 0; i < 4; i++) {
        readers[i] = (struct reader){.whole = cut.whole, .source = source};
        assert_int_equal(pthread_create(&readers[i].thread, NULL, read_all, &readers[i]), 0);
    }
    for (uint32_t i = 0; i < 4; i++)
        pthread_join(readers[i].thread, NULL);
    sluiceDestroyImageSource(source);
    sluiceDestroyImageSource(&cut.base);
}

static void chains_that_cannot_be_completed_are_refused(void **state)
{
    (void)state;
    struct cut_source cut;
    SluiceImageInfo info = {.structSize = sizeof info};
    cut_init(&cut, SLUICE_FORMAT_R8_UNORM, 64, 64, 1);
    const struct {
        SluiceFormat format;
        uint32_t level_count;
        SluiceResult result;
    } cases[] = {
        {SLUICE_FORMAT_BC7_UNORM_BLOCK, 1, SLUICE_ERROR_UNSUPPORTED},
        {SLUICE_FORMAT_BC7_UNORM_BLOCK, 6, SLUICE_ERROR_UNSUPPORTED},
        {SLUICE_FORMAT_BC7_UNORM_BLOCK, 7, SLUICE_SUCCESS},
        {SLUICE_FORMAT_UNDEFINED, 7, SLUICE_SUCCESS},
        {SLUICE_FORMAT_UNDEFINED, 0, SLUICE_ERROR_INVALID_ARGUMENT},
        {SLUICE_FORMAT_UNDEFINED, 8, SLUICE_ERROR_INVALID_ARGUMENT},
        {SLUICE_FORMAT_COUNT, 1, SLUICE_ERROR_INVALID_ARGUMENT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        cut.format = cases[i].format;
        cut.level_count = cases[i].level_count;
        SluiceImageSource *source = complete(&cut, 0);
        CHECK_RESULT(sluiceGetImageInfo(source, &info), cases[i].result);
        sluiceDestroyImageSource(source);
    }
    SluiceImageSource *source = NULL;
    SluiceCompleteChainSourceCreateInfo create = {.structSize = sizeof create};
    CHECK_RESULT(sluiceCreateCompleteChainSource(&create, &source), SLUICE_ERROR_NULL_POINTER);
    assert_null(source);
    sluiceDestroyImageSource(&cut.base);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(built_levels_are_those_of_the_same_texels_in_memory),
        cmocka_unit_test(layers_are_built_each_from_its_own),
        cmocka_unit_test(errors_reach_the_reader_and_are_not_kept),
        cmocka_unit_test(kept_levels_and_blocks_stay_within_their_bounds),
        cmocka_unit_test(every_call_survives_every_refused_allocation),
        cmocka_unit_test(threads_may_read_at_the_same_time),
        cmocka_unit_test(chains_that_cannot_be_completed_are_refused),
    };
    return RUN_TESTS(tests);
}
