/* Memory that is refused at every point: an error, nothing lost, and the same call works later. */
#include "store/stores.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdlib.h>

static SluiceStoreCreateInfo describe(const struct scratch *scratch,
                                      const SluiceAllocationCallbacks *allocator)
{
    return (SluiceStoreCreateInfo){.structSize = sizeof(SluiceStoreCreateInfo),
                                   .pPath = scratch->path,
                                   .width = 300,
                                   .height = 140,
                                   .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                   .compressionLevel = 3,
                                   .flags = SLUICE_STORE_WRITER_RESUME,
                                   .pAllocator = allocator};
}

static void a_writer_without_memory_can_be_resumed_at_every_point(void **state)
{
    (void)state;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint64_t n = 0;
    for (; result != SLUICE_SUCCESS; n++) {
        struct scratch scratch;
        struct failing_allocator allocator;
        scratch_init(&scratch);
        failing_allocator_init(&allocator, n);
        SluiceStoreCreateInfo info = describe(&scratch, &allocator.callbacks);
        result = write_store(&info, PICTURE_MIXED);
        CHECK_RESULT(result,
                     allocator.calls > n ? SLUICE_ERROR_OUT_OF_HOST_MEMORY : SLUICE_SUCCESS);
        assert_int_equal(allocator.live_bytes, 0);
        assert_int_equal(allocator.live_count, 0);
        assert_int_equal(exists(scratch.path), result == SLUICE_SUCCESS);
        info.pAllocator = NULL;
        CHECK_OK(write_store(&info, PICTURE_MIXED));
        CHECK_OK(read_store(scratch.path, PICTURE_MIXED, NULL));
        scratch_finish(&scratch);
    }
    assert_true(n > 5); /* writer, paths, bench, zstd's */
}

/* The tiles before it are written; without memory one is not, and then it is. */
static void a_write_without_memory_can_be_repeated(void **state)
{
    (void)state;
    struct scratch scratch;
    struct failing_allocator allocator;
    scratch_init(&scratch);
    failing_allocator_init(&allocator, UINT64_MAX);
    SluiceStoreCreateInfo info = describe(&scratch, &allocator.callbacks);
    SluiceStoreWriter *writer;
    SluiceStoreLayout layout;
    CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
    CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint32_t refusals = 0;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        allocator.refuse_from = allocator.calls + n;
        result = write_one(writer, &layout, PICTURE_MIXED, 0, 0, 0, 0);
        refusals += result == SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        bool is_written = false;
        CHECK_OK(sluiceIsStoreTileWritten(writer, 0, 0, 0, 0, &is_written));
        assert_int_equal(is_written, result == SLUICE_SUCCESS);
    }
    assert_true(refusals >= 2);
    allocator.refuse_from = UINT64_MAX;
    CHECK_OK(write_tiles(writer, &info, PICTURE_MIXED, UINT64_MAX));
    sluiceDestroyStoreWriter(writer);
    assert_int_equal(allocator.live_bytes, 0);
    CHECK_OK(read_store(scratch.path, PICTURE_MIXED, NULL));
    scratch_finish(&scratch);
}

static void a_turn_without_memory_ends_without_its_tile(void **state)
{
    (void)state;
    struct scratch scratch;
    struct failing_allocator allocator;
    static unsigned char texels[65536];
    scratch_init(&scratch);
    failing_allocator_init(&allocator, UINT64_MAX);
    SluiceStoreCreateInfo info = describe(&scratch, &allocator.callbacks);
    SluiceStoreWriter *writer;
    CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint64_t turn = 0;
    for (; result != SLUICE_SUCCESS; turn++) {
        bool is_written = true;
        CHECK_OK(sluiceIsStoreTileWritten(writer, 0, 0, 0, 0, &is_written));
        assert_false(is_written);
        allocator.refuse_from = allocator.calls + turn;
        result = sluiceWriteStoreTileInTurn(writer, turn, 0, 0, 0, 0, texels, 512);
        assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
    assert_true(turn >= 3); /* two were refused */
    allocator.refuse_from = UINT64_MAX;
    sluiceDestroyStoreWriter(writer);
    scratch_finish(&scratch);
}

static void resuming_without_memory_loses_nothing(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, NULL);
    SluiceStoreWriter *writer;
    CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
    CHECK_OK(write_tiles(writer, &info, PICTURE_MIXED, 4));
    sluiceDestroyStoreWriter(writer);
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator allocator;
        failing_allocator_init(&allocator, n);
        info.pAllocator = &allocator.callbacks;
        result = sluiceCreateStoreWriter(&info, &writer);
        if (result != SLUICE_SUCCESS) {
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            assert_int_equal(allocator.live_bytes, 0);
            continue;
        }
        uint64_t written, total;
        CHECK_OK(sluiceGetStoreProgress(writer, &written, &total));
        assert_int_equal(written, 4);
        sluiceDestroyStoreWriter(writer);
        assert_int_equal(allocator.live_bytes, 0);
    }
    scratch_finish(&scratch);
}

/* Opening, a whole tile, a part of one, and of the tail. */
static SluiceResult open_and_read(const char *path, struct failing_allocator *allocator)
{
    static unsigned char texels[65536];
    static const SluiceImageRegion regions[] = {
        {0, 0, 0, 128, 128, 0}, {0, 5, 6, 7, 8, 0}, {4, 0, 0, 3, 2, 0}};
    SluiceStoreImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = path, .pAllocator = &allocator->callbacks};
    SluiceImageSource *source;
    SluiceResult result = sluiceCreateStoreImageSource(&create, &source);
    if (result != SLUICE_SUCCESS)
        return result;
    uint64_t hash;
    result = sluiceHashStore(source, &hash);
    for (int i = 0; i < 3 && result == SLUICE_SUCCESS; i++) {
        result = sluiceReadImageRegion(source, &regions[i], texels, 512);
        if (result == SLUICE_SUCCESS)
            assert_true(
                is_painted(PICTURE_SMOOTH, SLUICE_FORMAT_R8G8B8A8_UNORM, &regions[i], texels, 512));
    }
    sluiceDestroyImageSource(source);
    return result;
}

static SluiceResult verify(const char *path, struct failing_allocator *allocator)
{
    SluiceStoreVerifyInfo info = {
        .structSize = sizeof info, .pPath = path, .pAllocator = &allocator->callbacks};
    return sluiceVerifyStore(&info, NULL);
}

static void reading_without_memory_is_an_error_and_nothing_is_lost(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, NULL);
    CHECK_OK(write_store(&info, PICTURE_SMOOTH));
    SluiceResult (*const calls[])(const char *, struct failing_allocator *) = {open_and_read,
                                                                               verify};
    for (int i = 0; i < 2; i++) {
        SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        uint64_t n = 0;
        for (; result != SLUICE_SUCCESS; n++) {
            struct failing_allocator allocator;
            failing_allocator_init(&allocator, n);
            result = calls[i](scratch.path, &allocator);
            assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            assert_int_equal(allocator.live_bytes, 0);
            assert_int_equal(allocator.live_count, 0);
        }
        assert_true(n > 5);
    }
    scratch_finish(&scratch);
}

static void an_allocator_of_one_function_is_refused(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceAllocationCallbacks half = {0};
    SluiceStoreCreateInfo info = describe(&scratch, &half);
    SluiceStoreWriter *writer;
    CHECK_RESULT(sluiceCreateStoreWriter(&info, &writer), SLUICE_ERROR_NULL_POINTER);
    SluiceStoreImageSourceCreateInfo create = {
        .structSize = sizeof create, .pPath = scratch.path, .pAllocator = &half};
    SluiceImageSource *source;
    CHECK_RESULT(sluiceCreateStoreImageSource(&create, &source), SLUICE_ERROR_NULL_POINTER);
    SluiceStoreVerifyInfo verification = {
        .structSize = sizeof verification, .pPath = scratch.path, .pAllocator = &half};
    CHECK_RESULT(sluiceVerifyStore(&verification, NULL), SLUICE_ERROR_NULL_POINTER);
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_writer_without_memory_can_be_resumed_at_every_point),
        cmocka_unit_test(a_write_without_memory_can_be_repeated),
        cmocka_unit_test(a_turn_without_memory_ends_without_its_tile),
        cmocka_unit_test(resuming_without_memory_loses_nothing),
        cmocka_unit_test(reading_without_memory_is_an_error_and_nothing_is_lost),
        cmocka_unit_test(an_allocator_of_one_function_is_refused),
    };
    return RUN_TESTS(tests);
}
