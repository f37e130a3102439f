/* DDS and KTX2 files that share a pool of open files, and such files that are in no file. */
#include <sluice/dds.h>
#include <sluice/ktx2.h>

#include "container/container_checks.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

enum kind { DDS, KTX2, KTX2_ZSTD, KIND_COUNT };

static struct picture rgba(void)
{
    return (struct picture){.format = format_names_of(SLUICE_FORMAT_R8G8B8A8_UNORM),
                            .width = 140,
                            .height = 24,
                            .layer_count = 2};
}

static uint32_t kind_count(void)
{
#ifdef TEST_HAS_ZSTD
    return KIND_COUNT;
#else
    return KTX2_ZSTD;
#endif
}

static struct file_bytes make_file(enum kind kind, const struct picture *picture)
{
    return kind == DDS ? make_dds(picture) : make_ktx2(picture, kind == KTX2_ZSTD ? 2 : 0);
}

static SluiceResult open_file(enum kind kind, const char *path, const SluiceInput *input,
                              SluiceFilePool *pool, const SluiceAllocationCallbacks *cb,
                              SluiceImageSource **source)
{
    SluiceDdsImageSourceCreateInfo dds = {.structSize = sizeof dds,
                                          .pPath = path,
                                          .pInput = input,
                                          .filePool = pool,
                                          .pAllocator = cb};
    SluiceKtx2ImageSourceCreateInfo ktx2 = {.structSize = sizeof ktx2,
                                            .pPath = path,
                                            .pInput = input,
                                            .filePool = pool,
                                            .pAllocator = cb};
    return kind == DDS ? sluiceCreateDdsImageSource(&dds, source)
                       : sluiceCreateKtx2ImageSource(&ktx2, source);
}

static void bytes_in_memory_are_read_like_a_file(void **state)
{
    (void)state;
    for (uint32_t kind = 0; kind < kind_count(); kind++) {
        struct picture picture = rgba();
        struct file_bytes file = make_file(kind, &picture);
        SluiceInput input = {.structSize = sizeof input, .pBytes = file.bytes, .size = file.size};
        SluiceImageSource *source;
        CHECK_OK(open_file(kind, NULL, &input, NULL, NULL, &source));
        memset(&input, 0, sizeof input); /* the struct is copied */
        check_picture(source, &picture);
        check_on_threads(source, &picture, 4);
        sluiceDestroyImageSource(source);
        free(file.bytes);
    }
}

static void bytes_that_are_cut_anywhere_are_refused(void **state)
{
    (void)state;
    for (uint32_t kind = 0; kind < kind_count(); kind++) {
        struct picture picture = rgba();
        struct file_bytes file = make_file(kind, &picture);
        for (size_t size = 1; size < file.size; size += 37) {
            uint8_t *bytes = malloc(size);
            memcpy(bytes, file.bytes, size);
            SluiceInput input = {.structSize = sizeof input, .pBytes = bytes, .size = size};
            SluiceImageSource *source;
            SluiceImageInfo info = {.structSize = sizeof info};
            CHECK_OK(open_file(kind, "cut", &input, NULL, NULL, &source));
            CHECK_RESULT(sluiceGetImageInfo(source, &info), SLUICE_ERROR_CORRUPT_DATA);
            sluiceDestroyImageSource(source);
            free(bytes);
        }
        free(file.bytes);
    }
}

static void inputs_without_bytes_are_refused(void **state)
{
    (void)state;
    for (uint32_t kind = 0; kind < KTX2_ZSTD; kind++) {
        SluiceImageSource *source = NULL;
        SluiceInput input = {.structSize = sizeof input, .size = 1};
        CHECK_RESULT(open_file(kind, NULL, NULL, NULL, NULL, &source), SLUICE_ERROR_NULL_POINTER);
        CHECK_RESULT(open_file(kind, "x", &input, NULL, NULL, &source), SLUICE_ERROR_NULL_POINTER);
        input.pBytes = &input;
        input.size = 0;
        CHECK_RESULT(open_file(kind, "x", &input, NULL, NULL, &source),
                     SLUICE_ERROR_INVALID_ARGUMENT);
        assert_null(source);
    }
}

static void files_of_a_pool_take_turns(void **state)
{
    (void)state;
    SluiceFilePoolCreateInfo info = {.structSize = sizeof info, .maxOpenFileCount = 1};
    SluiceFilePool *pool;
    CHECK_OK(sluiceCreateFilePool(&info, &pool));
    for (uint32_t kind = 0; kind < kind_count(); kind++) {
        struct picture picture = rgba();
        struct file_bytes file = make_file(kind, &picture);
        struct scratch scratch[2];
        SluiceImageSource *sources[2];
        for (uint32_t i = 0; i < 2; i++) {
            scratch_init(&scratch[i], &file);
            CHECK_OK(open_file(kind, scratch[i].path, NULL, pool, NULL, &sources[i]));
        }
        for (uint32_t i = 0; i < 4; i++)
            check_picture(sources[i % 2], &picture);
        check_on_threads(sources[0], &picture, 4);
        for (uint32_t i = 0; i < 2; i++) {
            sluiceDestroyImageSource(sources[i]);
            scratch_finish(&scratch[i]);
        }
        free(file.bytes);
    }
    SluiceFilePoolStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetFilePoolStatistics(pool, &statistics));
    assert_int_equal(statistics.openFilePeak, 1);
    assert_int_equal(statistics.openFileCount, 0);
    assert_true(statistics.closedTotal >= 2);
    sluiceDestroyFilePool(pool);
}

static void every_refused_allocation_is_survived(void **state)
{
    (void)state;
    struct picture picture = rgba();
    for (uint32_t kind = 0; kind < kind_count(); kind++)
        for (uint32_t in_memory = 0; in_memory < 2; in_memory++) {
            struct file_bytes file = make_file(kind, &picture);
            struct scratch scratch;
            SluiceFilePool *pool;
            SluiceInput input = {
                .structSize = sizeof input, .pBytes = file.bytes, .size = file.size};
            SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
            scratch_init(&scratch, &file);
            CHECK_OK(sluiceCreateFilePool(NULL, &pool));
            for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
                struct failing_allocator a;
                SluiceImageSource *source = NULL;
                failing_allocator_init(&a, n);
                result = open_file(kind, scratch.path, in_memory ? &input : NULL, pool,
                                   &a.callbacks, &source);
                if (result == SLUICE_SUCCESS)
                    result = read_everything(source);
                sluiceDestroyImageSource(source);
                if (result != SLUICE_SUCCESS)
                    CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
                assert_int_equal(a.live_bytes, 0);
            }
            sluiceDestroyFilePool(pool);
            scratch_finish(&scratch);
            free(file.bytes);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_in_memory_are_read_like_a_file),
        cmocka_unit_test(bytes_that_are_cut_anywhere_are_refused),
        cmocka_unit_test(inputs_without_bytes_are_refused),
        cmocka_unit_test(files_of_a_pool_take_turns),
        cmocka_unit_test(every_refused_allocation_is_survived),
    };
    return RUN_TESTS(tests);
}
