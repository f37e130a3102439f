/* Files with millions of tiles: little is read and kept. The file is sparse. */
#define _XOPEN_SOURCE 700
#define _FILE_OFFSET_BITS 64

#include "store/fault_io.h"
#include "store/naive_store.h"
#include "store/stores.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

enum { SIZE = 65536, KEPT = 256 * 1024 + 16 * 1024 };

static void put(unsigned char *at, uint64_t value, int size)
{
    for (int i = 0; i < size; i++)
        at[i] = (unsigned char)(value >> 8 * i);
}

static uint64_t get(const unsigned char *at)
{
    uint64_t value = 0;
    for (int i = 7; i >= 0; i--)
        value = value << 8 | at[i];
    return value;
}

/* Makes an unfinished file look finished: few of very many tiles were written. */
static void seal_by_hand(const struct scratch *scratch)
{
    int file = open(scratch->part_path, O_RDWR);
    struct stat status;
    assert_true(file >= 0);
    unsigned char block[4096];
    assert_int_equal(pread(file, block, 4096, 0), 4096);
    uint64_t identity = get(block + 4064), blocks = get(block + 104) / 4096 - 1;
    assert_int_equal(fstat(file, &status), 0);
    put(block + 4072, (uint64_t)status.st_size, 8);
    put(block + 4088, XXH3_64bits(block, 4088), 8);
    assert_int_equal(pwrite(file, block, 4096, 0), 4096);
    for (uint64_t i = 0; i < blocks; i++) {
        off_t at = (off_t)(4096 * (i + 1));
        assert_int_equal(pread(file, block, 4096, at), 4096);
        put(block + 4088, XXH3_64bits_withSeed(block, 4088, identity + i), 8);
        assert_int_equal(pwrite(file, block, 4096, at), 4096);
    }
    close(file);
    assert_int_equal(rename(scratch->part_path, scratch->path), 0);
}

static SluiceStoreCreateInfo describe(const struct scratch *scratch,
                                      const SluiceAllocationCallbacks *allocator)
{
    return (SluiceStoreCreateInfo){.structSize = sizeof(SluiceStoreCreateInfo),
                                   .pPath = scratch->path,
                                   .width = SIZE,
                                   .height = SIZE,
                                   .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                   .flags = SLUICE_STORE_WRITER_RESUME,
                                   .pAllocator = allocator};
}

/* Returns the position of one of 300 distant tiles, or of the last one of level 0. */
static void place_of(uint32_t i, uint32_t *x, uint32_t *y)
{
    *x = i < 300 ? i * 97 % 512 : 511;
    *y = i < 300 ? i * 31 % 512 : 511;
}

static void write_far_tiles(const SluiceStoreCreateInfo *info)
{
    SluiceStoreWriter *writer;
    SluiceStoreLayout layout;
    CHECK_OK(sluiceCreateStoreWriter(info, &writer));
    CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
    assert_int_equal(layout.tileCount, 349525 + 1); /* (4^10 - 1) / 3 tiles, the tail */
    for (uint32_t i = 0; i <= 300; i++) {
        uint32_t x, y;
        place_of(i, &x, &y);
        CHECK_OK(write_one(writer, &layout, PICTURE_MIXED, 0, 0, x, y));
    }
    sluiceDestroyStoreWriter(writer);
}

static void writing_a_large_texture_takes_no_more_memory_than_a_small_one(void **state)
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
    for (uint32_t i = 0; i < 50; i++)
        CHECK_OK(write_one(writer, &layout, PICTURE_MIXED, 0, 0, i * 10, 511 - i));
    assert_true(allocator.live_bytes < 400 * 1024);
    sluiceDestroyStoreWriter(writer);
    scratch_finish(&scratch);
}

static void a_large_file_is_opened_by_one_small_read_and_little_is_kept(void **state)
{
    (void)state;
    struct scratch scratch;
    struct failing_allocator allocator;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, NULL);
    write_far_tiles(&info);
    seal_by_hand(&scratch);
    failing_allocator_init(&allocator, UINT64_MAX);
    SluiceStoreReadPool *pool; /* has its own counters */
    CHECK_OK(sluiceCreateStoreReadPool(NULL, &pool));
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create,
                                               .pPath = scratch.path,
                                               .pAllocator = &allocator.callbacks,
                                               .readPool = pool};
    SluiceImageSource *source;
    fault_io = (struct fault_io){0};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    assert_int_equal(fault_io.count[FAULT_READ], 1);
    assert_int_equal(fault_io.read_size, 4096);
    unsigned char *texels = malloc(65536);
    for (uint32_t i = 0; i <= 300; i++) {
        uint32_t x, y;
        place_of(i, &x, &y);
        SluiceImageRegion region = {0, x * 128, y * 128, 128, 128, 0};
        uint64_t reads = fault_io.count[FAULT_READ];
        for (int again = 0; again < 3; again++)
            CHECK_OK(sluiceReadImageRegion(source, &region, texels, 512));
        /* the index part once, the tile each time */
        assert_in_range(fault_io.count[FAULT_READ] - reads, 3, 4);
        assert_true(is_painted(PICTURE_MIXED, info.format, &region, texels, 512));
        assert_true(allocator.live_bytes <= KEPT);
    }
    SluiceImageRegion hole = {1, 0, 0, 128, 128, 0};
    CHECK_RESULT(sluiceReadImageRegion(source, &hole, texels, 512), SLUICE_ERROR_CORRUPT_DATA);
    free(texels);
    sluiceDestroyImageSource(source);
    assert_int_equal(allocator.live_bytes, 0);
    sluiceDestroyStoreReadPool(pool);
    scratch_finish(&scratch);
}

/* Tiles 0 and 64 x 204, whose parts of the index use the same slot. */
static void what_was_checked_is_forgotten_with_its_part_of_the_index(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch, NULL);
    SluiceStoreWriter *writer;
    SluiceStoreLayout layout;
    CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
    CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
    CHECK_OK(write_one(writer, &layout, PICTURE_MIXED, 0, 0, 0, 0));
    CHECK_OK(write_one(writer, &layout, PICTURE_MIXED, 0, 0, 64 * 204 % 512, 64 * 204 / 512));
    sluiceDestroyStoreWriter(writer);
    seal_by_hand(&scratch);
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = scratch.path};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    int file = open(scratch.path, O_RDWR);
    off_t second = 4096 * (1 + (off_t)(349526 + 203) / 204) + (off_t)64 * 204 * 65536;
    unsigned char byte;
    assert_int_equal(pread(file, &byte, 1, second), 1);
    byte ^= 1;
    assert_int_equal(pwrite(file, &byte, 1, second), 1);
    close(file);
    unsigned char *texels = malloc(65536);
    SluiceImageRegion tiles[] = {{0, 0, 0, 128, 128, 0},
                                 {0, 64 * 204 % 512 * 128, 64 * 204 / 512 * 128, 128, 128, 0}};
    CHECK_OK(sluiceReadImageRegion(source, &tiles[0], texels, 512));
    for (int i = 0; i < 2; i++) /* its part of the index is kept after the first read */
        CHECK_RESULT(sluiceReadImageRegion(source, &tiles[1], texels, 512),
                     SLUICE_ERROR_CORRUPT_DATA);
    free(texels);
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
}

static void resuming_a_large_file_finds_its_tiles_in_little_memory(void **state)
{
    (void)state;
    struct scratch scratch;
    struct failing_allocator allocator;
    scratch_init(&scratch);
    failing_allocator_init(&allocator, UINT64_MAX);
    SluiceStoreCreateInfo info = describe(&scratch, &allocator.callbacks);
    write_far_tiles(&info);
    SluiceStoreWriter *writer;
    uint64_t written, total;
    CHECK_OK(sluiceCreateStoreWriter(&info, &writer));
    CHECK_OK(sluiceGetStoreProgress(writer, &written, &total));
    assert_int_equal(written, 301);
    assert_true(allocator.live_bytes < 16 * 1024);
    sluiceDestroyStoreWriter(writer);
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(writing_a_large_texture_takes_no_more_memory_than_a_small_one),
        cmocka_unit_test(a_large_file_is_opened_by_one_small_read_and_little_is_kept),
        cmocka_unit_test(what_was_checked_is_forgotten_with_its_part_of_the_index),
        cmocka_unit_test(resuming_a_large_file_finds_its_tiles_in_little_memory),
    };
    return RUN_TESTS(tests);
}
