/* Stores that share a pool of open files, and stores that are in no file. */
#define _XOPEN_SOURCE 700

#include "store/stores.h"
#include "store/victim.h"
#include "support/few_descriptors.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static SluiceResult read_first_tile(SluiceImageSource *source)
{
    unsigned char texels[65536];
    SluiceImageRegion region = {0, 0, 0, 128, 128, 0};
    SluiceResult result = sluiceReadImageRegion(source, &region, texels, 512);
    if (result == SLUICE_SUCCESS)
        assert_true(is_painted(PICTURE_SMOOTH, SLUICE_FORMAT_R8G8B8A8_UNORM, &region, texels, 512));
    return result;
}

/* All of them stay in use under a limit of 64 descriptors. */
static void a_thousand_stores_are_read_with_sixty_descriptors(void **state)
{
    (void)state;
    enum { COUNT = 1000 };
    struct victim victim;
    SluiceImageSource *sources[COUNT] = {0};
    SluiceStoreReadPool *read_pool;
    SluiceFilePool *pool;
    victim_init(&victim, 3);
    CHECK_OK(sluiceCreateStoreReadPool(NULL, &read_pool));
    struct few_descriptors few;
    few_descriptors_begin(&few, 40);
    SluiceResult result = sluiceCreateFilePool(NULL, &pool);
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                               .pPath = victim.scratch.path,
                                               .readPool = read_pool,
                                               .filePool = pool};
    for (uint32_t i = 0; i < COUNT && result == SLUICE_SUCCESS; i++)
        result = sluiceCreateStoreImageSource(&create, &sources[i]);
    for (uint32_t i = 0; i < 2 * COUNT && result == SLUICE_SUCCESS; i++)
        result = read_first_tile(sources[i * 7 % COUNT]);
    few_descriptors_end(&few);
    CHECK_OK(result);
    SluiceFilePoolStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetFilePoolStatistics(pool, &statistics));
    assert_int_equal(statistics.openFilePeak, 16);
    for (uint32_t i = 0; i < COUNT; i++)
        sluiceDestroyImageSource(sources[i]);
    CHECK_OK(sluiceGetFilePoolStatistics(pool, &statistics));
    assert_int_equal(statistics.openFileCount, 0);
    sluiceDestroyFilePool(pool);
    sluiceDestroyStoreReadPool(read_pool);
    victim_finish(&victim);
}

static void a_store_that_was_replaced_while_it_was_closed_is_reported(void **state)
{
    (void)state;
    struct victim victim, other;
    struct messages messages;
    SluiceFilePool *pool;
    SluiceFilePoolCreateInfo info = {.structSize = sizeof info, .maxOpenFileCount = 1};
    SluiceImageSource *source, *closer;
    victim_init(&victim, 3);
    victim_init(&other, 3);
    CHECK_OK(sluiceCreateFilePool(&info, &pool));
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                               .pPath = victim.scratch.path,
                                               .filePool = pool,
                                               .log = messages_log(&messages)};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(read_first_tile(source));
    create.pPath = other.scratch.path;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &closer));
    CHECK_OK(read_first_tile(closer));
    unlink(victim.scratch.path);
    write_bytes(victim.scratch.path, other.bytes, other.size);
    for (int again = 0; again < 2; again++) {
        CHECK_RESULT(read_first_tile(source), SLUICE_ERROR_IO);
        CHECK_OK(read_first_tile(closer));
    }
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.last, victim.scratch.path));
    assert_non_null(strstr(messages.last, "another file has taken its place"));
    sluiceDestroyImageSource(source);
    create.pPath = victim.scratch.path;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(read_first_tile(source));
    sluiceDestroyImageSource(source);
    sluiceDestroyImageSource(closer);
    sluiceDestroyFilePool(pool);
    victim_finish(&victim);
    victim_finish(&other);
}

/* Exactly its bytes, from malloc, so that a sanitizer sees a byte too many. */
static SluiceResult open_bytes(const unsigned char *bytes, size_t size, SluiceImageSource **source)
{
    SluiceInput input = {.structSize = sizeof input, .pBytes = bytes, .size = size};
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pInput = &input};
    return sluiceCreateStoreImageSource(&create, source);
}

static void a_store_in_memory_is_read_like_its_file(void **state)
{
    (void)state;
    for (uint32_t compression = 0; compression <= 3; compression += 3) {
        struct victim victim;
        SluiceImageSource *source;
        SluiceImageInfo info = {.structSize = sizeof info};
        victim_init(&victim, compression);
        unlink(victim.scratch.path);
        unsigned char *bytes = malloc(victim.size);
        memcpy(bytes, victim.bytes, victim.size);
        CHECK_OK(open_bytes(bytes, victim.size, &source));
        CHECK_OK(sluiceGetImageInfo(source, &info));
        assert_string_equal(info.pName, "(memory)");
        assert_int_equal(info.width, 300);
        CHECK_OK(read_first_tile(source));
        sluiceDestroyImageSource(source);
        free(bytes);
        victim_finish(&victim);
    }
}

static void bytes_that_are_cut_are_refused(void **state)
{
    (void)state;
    struct victim victim;
    SluiceImageSource *source = NULL;
    victim_init(&victim, 3);
    CHECK_RESULT(open_bytes(victim.bytes, 0, &source), SLUICE_ERROR_INVALID_ARGUMENT);
    for (size_t size = 1; size < victim.size; size += size < 5000 ? 101 : 1009) {
        unsigned char *bytes = malloc(size);
        memcpy(bytes, victim.bytes, size);
        CHECK_RESULT(open_bytes(bytes, size, &source), SLUICE_ERROR_CORRUPT_DATA);
        free(bytes);
    }
    assert_null(source);
    victim_finish(&victim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_thousand_stores_are_read_with_sixty_descriptors),
        cmocka_unit_test(a_store_that_was_replaced_while_it_was_closed_is_reported),
        cmocka_unit_test(a_store_in_memory_is_read_like_its_file),
        cmocka_unit_test(bytes_that_are_cut_are_refused),
    };
    return RUN_TESTS(tests);
}
