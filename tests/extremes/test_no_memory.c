/* Calls that the list of allocations declares free of allocations, made while none succeeds. */
#include "core/sound.h"
#include "extremes/note.h"

#include <sluice/input.h>
#include <sluice/loader.h>

#include <stdlib.h>

static void questions_about_a_manager_take_no_memory(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 1, 10);
    fixture_load(&f);
    f.memory.refuse_from = f.memory.calls;
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    SluiceTileState tile_state;
    SluiceTile tile;
    SluiceMinMipRect rect = {id, 0, 0, 1, 1};
    uint8_t map[4];
    uint32_t heaps[16], count = 16;
    SluiceStreamedTextureDesc desc = small_texture();
    CHECK_OK(sluiceGetTextureLayout(f.manager, id, &layout));
    CHECK_OK(sluiceGetStreamedTextureLayout(&desc, &layout));
    CHECK_OK(sluiceGetStatistics(f.manager, &statistics));
    CHECK_OK(sluiceGetTileState(f.manager, id, 0, &tile_state, &tile));
    CHECK_OK(sluiceWriteMinMipData(f.manager, id, 2, sizeof map, map));
    CHECK_OK(sluiceWriteMinMipRect(f.manager, &rect, 2, sizeof map, map));
    CHECK_OK(sluiceGetEmptyHeaps(f.manager, &count, heaps));
    assert_int_equal(f.memory.calls, f.memory.refuse_from);
    f.memory.refuse_from = UINT64_MAX;
    fixture_close(&f);
}

static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)user, (void)level, (void)width, (void)height;
    rgba[0] = (float)(x + y);
    rgba[1] = rgba[2] = rgba[3] = 0;
}

/* Sources that hold their texels or compute them. */
static void reads_of_what_is_in_memory_take_none(void **state)
{
    (void)state;
    struct failing_allocator memory;
    float texels[64 * 64] = {0};
    SluiceImageInfo info = {sizeof info, 64, 64, 0, SLUICE_FORMAT_R32_SFLOAT, "small", 1};
    SluiceProceduralImage image = {NULL, texel};
    SluiceImageSource *sources[3];
    failing_allocator_init(&memory, UINT64_MAX);
    CHECK_OK(sluiceCreateMemoryImageSource(texels, &info, &memory.callbacks, &sources[0]));
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, &memory.callbacks, &sources[1]));
    CHECK_OK(sluiceCreateArrayImageSource(sources, 2, &memory.callbacks, &sources[2]));
    memory.refuse_from = memory.calls;
    for (uint32_t i = 0; i < 3; i++) {
        SluiceImageRegion region = {1, 3, 4, 20, 10, i / 2};
        SluiceImageFault fault;
        CHECK_OK(sluiceGetImageInfo(sources[i], &info));
        CHECK_OK(sluiceReadImageRegion(sources[i], &region, texels, 20 * sizeof *texels));
        CHECK_OK(
            sluiceReadImageRegionLocated(sources[i], &region, texels, 20 * sizeof *texels, &fault));
    }
    assert_int_equal(memory.calls, memory.refuse_from);
    for (uint32_t i = 3; i-- > 0;)
        sluiceDestroyImageSource(sources[i]);
    assert_int_equal(memory.live_count, 0);
}

static void a_loader_takes_no_memory_once_it_is_there(void **state)
{
    (void)state;
    struct failing_allocator memory;
    SluiceImageInfo info = {sizeof info, 64, 64, 0, SLUICE_FORMAT_R32_SFLOAT, "small", 1};
    SluiceProceduralImage image = {NULL, texel};
    SluiceImageSource *source;
    SluiceTileLoader *loader;
    failing_allocator_init(&memory, UINT64_MAX);
    SluiceTileLoaderCreateInfo create = {.structSize = sizeof create,
                                         .threadCount = 1,
                                         .requestCapacity = 8,
                                         .pAllocator = &memory.callbacks};
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &source));
    CHECK_OK(sluiceCreateTileLoader(&create, &loader));
    memory.refuse_from = memory.calls;
    for (uint32_t i = 0; i < 50; i++) {
        float texels[3];
        void *where[3] = {&texels[0], &texels[1], &texels[2]};
        SluiceImageRegion region = {0, i, 5, 1, 1, 0};
        SluiceTileRead reads[3];
        uint64_t tickets[3];
        SluiceTileReadResult results[8];
        SluiceTileLoaderStatistics statistics = {.structSize = sizeof statistics};
        uint32_t count = 8;
        for (uint32_t r = 0; r < 3; r++)
            reads[r] = (SluiceTileRead){source, 1, &region, &where[r], r, r};
        CHECK_OK(sluiceSubmitTileRead(loader, &reads[0], &tickets[0]));
        CHECK_OK(sluiceSubmitTileReads(loader, 2, &reads[1], &tickets[1]));
        sluiceCancelTileRead(loader, tickets[1]);
        sluiceWaitTileLoaderIdle(loader);
        CHECK_OK(sluiceCollectTileReads(loader, &count, results));
        assert_int_equal(count, 3);
        assert_true(texels[0] == (float)(i + 5) && texels[2] == (float)(i + 5));
        CHECK_OK(sluiceGetTileLoaderStatistics(loader, source, &statistics));
        CHECK_OK(sluiceDropTileLoaderStatistics(loader, source));
    }
    assert_int_equal(memory.calls, memory.refuse_from);
    sluiceDestroyTileLoader(loader);
    assert_int_equal(memory.live_count, 0);
    sluiceDestroyImageSource(source);
}

static void questions_about_pools_take_no_memory(void **state)
{
    (void)state;
    struct failing_allocator memory;
    SluiceFilePool *pool;
    SluiceFilePoolStatistics statistics = {.structSize = sizeof statistics};
    failing_allocator_init(&memory, UINT64_MAX);
    SluiceFilePoolCreateInfo info = {
        .structSize = sizeof info, .maxOpenFileCount = 5, .pAllocator = &memory.callbacks};
    CHECK_OK(sluiceCreateFilePool(&info, &pool));
    memory.refuse_from = memory.calls;
    CHECK_OK(sluiceGetFilePoolStatistics(pool, &statistics));
    assert_int_equal(statistics.maxOpenFileCount, 5);
    assert_int_equal(memory.calls, memory.refuse_from);
    sluiceDestroyFilePool(pool);
    assert_int_equal(memory.live_count, 0);

    SluiceReadPool *reads;
    SluiceReadPoolStatistics counts = {.structSize = sizeof counts};
    failing_allocator_init(&memory, UINT64_MAX);
    const SluiceReadPoolCreateInfo read_info = {
        .structSize = sizeof read_info, .threadCount = 1, .pAllocator = &memory.callbacks};
    CHECK_OK(sluiceCreateReadPool(&read_info, &reads));
    memory.refuse_from = memory.calls;
    CHECK_OK(sluiceGetReadPoolStatistics(reads, &counts));
    assert_int_equal(counts.memberCount, 0);
    assert_int_equal(memory.calls, memory.refuse_from);
    sluiceDestroyReadPool(reads);
    assert_int_equal(memory.live_count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(questions_about_a_manager_take_no_memory),
        cmocka_unit_test(reads_of_what_is_in_memory_take_none),
        cmocka_unit_test(a_loader_takes_no_memory_once_it_is_there),
        cmocka_unit_test(questions_about_pools_take_no_memory),
    };
    return RUN_TESTS(tests);
}
