/* A failing read reports its file and offset, through wrapping sources and the loader. */
#define _XOPEN_SOURCE 700

#include "store/naive_store.h"
#include "store/victim.h"
#include "support/test.h"

#include <sluice/loader.h>

#include <unistd.h>

static SluiceImageSource *open_store(const char *path)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *source = NULL;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    return source;
}

/* Returns the offset of one of the victim's chunks: 3 x 2 tiles, 2 x 1 of the next level, ..., the
 * tail last. */
static uint64_t chunk_offset(const struct victim *victim, uint64_t number)
{
    struct naive_store store;
    assert_null(naive_store_load(&store, victim->scratch.path));
    uint64_t offset = naive_store_chunk(&store, number).offset;
    naive_store_finish(&store);
    return offset;
}

static uint64_t chunk_count(const struct victim *victim)
{
    struct naive_store store;
    assert_null(naive_store_load(&store, victim->scratch.path));
    uint64_t count = store.chunks;
    naive_store_finish(&store);
    return count;
}

static void change_byte(const struct victim *victim, uint64_t at)
{
    FILE *file = fopen(victim->scratch.path, "r+b");
    fseek(file, (long)at, SEEK_SET);
    fputc(victim->bytes[at] ^ 1, file);
    fclose(file);
}

/* Reads a region of a file with one wrong byte. */
static void check_damage(uint32_t compression, uint64_t chunk, SluiceImageRegion region)
{
    static unsigned char texels[300 * 140 * 4];
    struct victim victim;
    victim_init(&victim, compression);
    uint64_t offset = chunk_offset(&victim, chunk);
    change_byte(&victim, offset + 3);
    SluiceImageSource *source = open_store(victim.scratch.path);
    SluiceImageFault fault = {NULL, 7};
    CHECK_RESULT(sluiceReadImageRegionLocated(source, &region, texels, 1200, &fault),
                 SLUICE_ERROR_CORRUPT_DATA);
    assert_string_equal(fault.pName, victim.scratch.path);
    assert_int_equal(fault.offset, offset);
    sluiceDestroyImageSource(source);
    victim_finish(&victim);
}

static void a_wrong_checksum_is_where_the_tile_is(void **state)
{
    (void)state;
    for (uint32_t compression = 0; compression <= 3; compression += 3) {
        check_damage(compression, 0, (SluiceImageRegion){.width = 128, .height = 128});
        check_damage(compression, 4,
                     (SluiceImageRegion){.x = 130, .y = 130, .width = 5, .height = 5});
        /* the last of six tiles */
        check_damage(compression, 5, (SluiceImageRegion){.width = 300, .height = 140});
    }
}

static void a_damaged_tail_is_where_the_tail_is(void **state)
{
    (void)state;
    struct victim victim;
    victim_init(&victim, 3);
    uint64_t tail = chunk_count(&victim) - 1;
    victim_finish(&victim);
    check_damage(3, tail, (SluiceImageRegion){.mipLevel = 8, .width = 1, .height = 1});
    check_damage(0, tail, (SluiceImageRegion){.mipLevel = 8, .width = 1, .height = 1});
}

static void a_damaged_part_of_the_index_is_where_it_begins(void **state)
{
    (void)state;
    unsigned char texel[4];
    struct victim victim;
    victim_init(&victim, 3);
    change_byte(&victim, 4096 + 2000);
    SluiceImageSource *source = open_store(victim.scratch.path);
    SluiceImageRegion region = {.width = 1, .height = 1};
    SluiceImageFault fault;
    CHECK_RESULT(sluiceReadImageRegionLocated(source, &region, texel, 4, &fault),
                 SLUICE_ERROR_CORRUPT_DATA);
    assert_int_equal(fault.offset, 4096);
    sluiceDestroyImageSource(source);
    victim_finish(&victim);
}

static void what_is_not_the_files_fault_has_no_place(void **state)
{
    (void)state;
    unsigned char texel[4];
    struct victim victim;
    victim_init(&victim, 3);
    SluiceImageSource *source = open_store(victim.scratch.path);
    SluiceImageRegion region = {.width = 1, .height = 1},
                      outside = {.x = 300, .width = 1, .height = 1};
    SluiceImageFault fault;
    CHECK_OK(sluiceReadImageRegionLocated(source, &region, texel, 4, &fault));
    assert_true(fault.offset == SLUICE_UNKNOWN_OFFSET);
    fault.offset = 7;
    CHECK_RESULT(sluiceReadImageRegionLocated(source, &outside, texel, 4, &fault),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_true(fault.offset == SLUICE_UNKNOWN_OFFSET);
    CHECK_RESULT(sluiceReadImageRegionLocated(source, &region, texel, 4, NULL),
                 SLUICE_ERROR_NULL_POINTER);
    sluiceDestroyImageSource(source);
    victim_finish(&victim);
}

/* Last failure reported by a loader, and its counts. */
struct told {
    SluiceTileReadFailure failure;
    char name[128];
    SluiceTileLoaderStatistics statistics;
};

static void on_failure(void *user, const SluiceTileReadFailure *failure)
{
    struct told *told = user;
    told->failure = *failure;
    snprintf(told->name, sizeof told->name, "%s", failure->pName);
}

static struct told load(SluiceImageSource *source, uint32_t layer)
{
    static unsigned char texels[65536];
    struct told told = {0};
    SluiceTileLoader *loader;
    SluiceTileLoaderCreateInfo create = {.structSize = sizeof create,
                                         .threadCount = 1,
                                         .retry = {.maxAttempts = 1},
                                         .failure = {&told, on_failure}};
    CHECK_OK(sluiceCreateTileLoader(&create, &loader));
    SluiceImageRegion region = {.width = 128, .height = 128, .arrayLayer = layer};
    void *place = texels;
    uint64_t ticket;
    SluiceTileRead read = {source, 1, &region, &place, 0, 0};
    CHECK_OK(sluiceSubmitTileRead(loader, &read, &ticket));
    sluiceWaitTileLoaderIdle(loader);
    told.statistics.structSize = sizeof told.statistics;
    CHECK_OK(sluiceGetTileLoaderStatistics(loader, source, &told.statistics));
    sluiceDestroyTileLoader(loader);
    return told;
}

static void check_told(const struct told *told, const char *path, SluiceResult result,
                       uint64_t offset)
{
    assert_string_equal(told->name, path);
    CHECK_RESULT(told->failure.result, result);
    assert_int_equal(told->failure.offset, offset);
    CHECK_RESULT(told->statistics.lastFailure, result);
    assert_int_equal(told->statistics.lastFailureOffset, offset);
}

static void loaders_tell_file_and_offset_of_a_wrong_checksum(void **state)
{
    (void)state;
    struct victim victim;
    victim_init(&victim, 3);
    uint64_t offset = chunk_offset(&victim, 0);
    change_byte(&victim, offset);
    SluiceImageSource *source = open_store(victim.scratch.path);
    struct told told = load(source, 0);
    check_told(&told, victim.scratch.path, SLUICE_ERROR_CORRUPT_DATA, offset);
    sluiceDestroyImageSource(source);
    victim_finish(&victim);
}

static void loaders_tell_file_and_offset_of_a_file_that_was_cut(void **state)
{
    (void)state;
    struct victim victim;
    victim_init(&victim, 0);
    uint64_t offset = chunk_offset(&victim, 0);
    SluiceImageSource *source = open_store(victim.scratch.path);
    assert_int_equal(truncate(victim.scratch.path, (off_t)offset + 5), 0);
    struct told told = load(source, 0);
    check_told(&told, victim.scratch.path, SLUICE_ERROR_IO, offset);
    sluiceDestroyImageSource(source);
    victim_finish(&victim);
}

static void of_an_array_the_layers_file_is_told(void **state)
{
    (void)state;
    struct victim victims[2];
    SluiceImageSource *layers[2], *array;
    for (int i = 0; i < 2; i++) {
        victim_init(&victims[i], 3);
        layers[i] = open_store(victims[i].scratch.path);
    }
    uint64_t offset = chunk_offset(&victims[1], 0);
    change_byte(&victims[1], offset);
    CHECK_OK(sluiceCreateArrayImageSource(layers, 2, NULL, &array));
    struct told told = load(array, 1);
    check_told(&told, victims[1].scratch.path, SLUICE_ERROR_CORRUPT_DATA, offset);
    assert_int_equal(told.failure.region.arrayLayer, 1);
    sluiceDestroyImageSource(array);
    for (int i = 0; i < 2; i++) {
        sluiceDestroyImageSource(layers[i]);
        victim_finish(&victims[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wrong_checksum_is_where_the_tile_is),
        cmocka_unit_test(a_damaged_tail_is_where_the_tail_is),
        cmocka_unit_test(a_damaged_part_of_the_index_is_where_it_begins),
        cmocka_unit_test(what_is_not_the_files_fault_has_no_place),
        cmocka_unit_test(loaders_tell_file_and_offset_of_a_wrong_checksum),
        cmocka_unit_test(loaders_tell_file_and_offset_of_a_file_that_was_cut),
        cmocka_unit_test(of_an_array_the_layers_file_is_told),
    };
    return RUN_TESTS(tests);
}
