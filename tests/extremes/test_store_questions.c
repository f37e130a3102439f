/* Queries of stores without memory, and pools shared by many sources. */
#include "extremes/note.h"
#include "store/stores.h"
#include "support/failing_allocator.h"

static SluiceStoreCreateInfo describe(const struct scratch *scratch,
                                      struct failing_allocator *memory)
{
    return (SluiceStoreCreateInfo){.structSize = sizeof(SluiceStoreCreateInfo),
                                   .pPath = scratch->path,
                                   .width = 300,
                                   .height = 140,
                                   .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                   .compressionLevel = 3,
                                   .pAllocator = memory ? &memory->callbacks : NULL};
}

static void questions_about_a_store_take_no_memory(void **state)
{
    (void)state;
    struct scratch scratch;
    struct failing_allocator memory;
    SluiceStoreWriter *writer;
    SluiceStoreLayout layout;
    SluiceImageSource *source;
    SluiceStoreInfo said = {.structSize = sizeof said};
    uint64_t written, total;
    bool is_written = false;
    scratch_init(&scratch);
    failing_allocator_init(&memory, UINT64_MAX);
    SluiceStoreCreateInfo info = describe(&scratch, &memory);
    CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
    CHECK_OK(write_tiles(writer, &info, PICTURE_MIXED, 3));
    memory.refuse_from = memory.calls;
    CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
    CHECK_OK(sluiceGetStoreProgress(writer, &written, &total));
    CHECK_OK(sluiceIsStoreTileWritten(writer, 0, 0, 0, 0, &is_written));
    assert_true(is_written && written == 3);
    assert_int_equal(memory.calls, memory.refuse_from);
    memory.refuse_from = UINT64_MAX;
    CHECK_OK(write_tiles(writer, &info, PICTURE_MIXED, UINT64_MAX));
    sluiceDestroyStoreWriter(writer);
    SluiceStoreImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = scratch.path, .pAllocator = &memory.callbacks};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    memory.refuse_from = memory.calls;
    CHECK_OK(sluiceGetStoreInfo(source, &said));
    assert_int_equal(memory.calls, memory.refuse_from);
    sluiceDestroyImageSource(source);
    assert_int_equal(memory.live_count, 0);
    scratch_finish(&scratch);
}

/* Sources of one pool: a read that lacked memory succeeds the next time. */
static SluiceResult read_through_pool(const char *path, struct failing_allocator *memory)
{
    static unsigned char texels[65536];
    const SluiceImageRegion region = {0, 5, 6, 100, 90, 0};
    SluiceStoreReadPool *pool = NULL;
    SluiceImageSource *sources[2] = {NULL, NULL};
    SluiceResult result = sluiceCreateStoreReadPool(&memory->callbacks, &pool);
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                               .pPath = path,
                                               .pAllocator = &memory->callbacks,
                                               .readPool = pool};
    for (uint32_t i = 0; i < 2 && result == SLUICE_SUCCESS; i++)
        result = sluiceCreateStoreImageSource(&create, &sources[i]);
    for (uint32_t i = 0; i < 2 && result == SLUICE_SUCCESS; i++)
        result = sluiceReadImageRegion(sources[i], &region, texels, 512);
    if (result == SLUICE_SUCCESS)
        assert_true(is_painted(PICTURE_MIXED, SLUICE_FORMAT_R8G8B8A8_UNORM, &region, texels, 512));
    sluiceDestroyImageSource(sources[0]);
    sluiceDestroyImageSource(sources[1]);
    sluiceDestroyStoreReadPool(pool);
    return result;
}

static void a_pool_survives_every_refused_allocation(void **state)
{
    (void)state;
    struct scratch scratch;
    uint64_t refusals = 0, left = 0;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, NULL);
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    for (uint32_t lasting = 0; lasting < 2; lasting++) {
        SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        for (uint64_t n = 0; result != SLUICE_SUCCESS; n++, refusals++) {
            struct failing_allocator memory;
            failing_allocator_init(&memory, n);
            memory.refuse_count = !lasting;
            result = read_through_pool(scratch.path, &memory);
            left += memory.live_count;
            if (result != SLUICE_SUCCESS)
                CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            assert_true(n < 1000);
        }
    }
    note("store pool: refused allocations, what is left", refusals, (double)left, 0);
    assert_int_equal(left, 0);
    assert_true(refusals > 10);
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(questions_about_a_store_take_no_memory),
        cmocka_unit_test(a_pool_survives_every_refused_allocation),
    };
    return RUN_TESTS(tests);
}
