/* Files that are not to be trusted: an error or the picture, and nothing else. */
#include "store/naive_store.h"
#include "store/stores.h"
#include "store/victim.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>
#include <zstd.h>

static bool is_an_error_of_the_file(SluiceResult result)
{
    return result == SLUICE_ERROR_CORRUPT_DATA || result == SLUICE_ERROR_UNSUPPORTED;
}

/* Returns whether readers use the byte: it belongs to the header, the index or a chunk. */
static bool is_read(const struct naive_store *store, size_t at)
{
    if (at < store->data)
        return true;
    for (uint64_t i = 0; i < store->chunks; i++) {
        struct naive_chunk chunk = naive_store_chunk(store, i);
        if (at >= chunk.offset && at - chunk.offset < chunk.size)
            return true;
    }
    return false;
}

/* The file is changed in place, one bit at a time. */
static void flip_bits(uint32_t compression, int count)
{
    struct victim victim;
    victim_init(&victim, compression);
    struct naive_store store;
    assert_null(naive_store_load(&store, victim.scratch.path));
    FILE *file = fopen(victim.scratch.path, "r+b");
    setvbuf(file, NULL, _IONBF, 0);
    uint32_t random = 12345, harmless = 0;
    for (int i = 0; i < count; i++) {
        random = random * 1664525u + 1013904223u;
        /* half of them in header and index */
        size_t at = (random >> 8) % (i % 2 ? victim.size : store.data);
        fseek(file, (long)at, SEEK_SET);
        fputc(victim.bytes[at] ^ 1 << random % 8, file);
        struct messages messages;
        SluiceResult result = read_store(victim.scratch.path, PICTURE_SMOOTH, &messages);
        if (is_read(&store, at)) {
            assert_true(is_an_error_of_the_file(result));
            assert_int_equal(messages.errors, 1);
            assert_non_null(strstr(messages.last, victim.scratch.path));
            assert_non_null(strstr(messages.last, ": at "));
        } else {
            CHECK_OK(result);
            harmless++;
        }
        fseek(file, (long)at, SEEK_SET);
        fputc(victim.bytes[at], file);
    }
    fclose(file);
    print_message("# %d bits flipped: %u errors, %u where nobody reads\n", count,
                  (unsigned)count - harmless, (unsigned)harmless);
    assert_true(compression == 0 ? harmless < (uint32_t)count / 4 : harmless == 0);
    CHECK_OK(read_store(victim.scratch.path, PICTURE_SMOOTH, NULL));
    naive_store_finish(&store);
    victim_finish(&victim);
}

static void every_flipped_bit_of_a_compressed_file_is_noticed(void **state)
{
    (void)state;
    flip_bits(3, 7000);
}

static void every_flipped_bit_that_is_read_of_a_raw_file_is_noticed(void **state)
{
    (void)state;
    flip_bits(0, 3000);
}

static void every_bit_of_header_and_chunks_that_matters_is_noticed(void **state)
{
    (void)state;
    /* not at random: all bits of the first bytes, and of where things end */
    struct victim victim;
    victim_init(&victim, 3);
    const size_t places[] = {0, 128, 4060, 4096, 8180, victim.size - 32};
    for (size_t p = 0; p < sizeof places / sizeof places[0]; p++)
        for (size_t bit = 0; bit < 32 * 8; bit++) {
            unsigned char *byte = &victim.bytes[places[p] + bit / 8];
            *byte ^= (unsigned char)(1 << bit % 8);
            write_bytes(victim.scratch.path, victim.bytes, victim.size);
            assert_true(
                is_an_error_of_the_file(read_store(victim.scratch.path, PICTURE_SMOOTH, NULL)));
            *byte ^= (unsigned char)(1 << bit % 8);
        }
    victim_finish(&victim);
}

static void a_file_cut_anywhere_is_refused_when_it_is_opened(void **state)
{
    (void)state;
    struct victim victim;
    victim_init(&victim, 3);
    for (size_t size = 0; size < victim.size;) {
        write_bytes(victim.scratch.path, victim.bytes, size);
        struct messages messages;
        CHECK_RESULT(read_store(victim.scratch.path, PICTURE_SMOOTH, &messages),
                     SLUICE_ERROR_CORRUPT_DATA);
        assert_int_equal(messages.errors, 1);
        size += size < 200 || size + 200 > victim.size ? 1 : 37;
    }
    victim_finish(&victim);
}

static void a_file_that_goes_on_behind_its_end_is_refused(void **state)
{
    (void)state;
    struct victim victim;
    victim_init(&victim, 3);
    victim.bytes[victim.size] = 0; /* read_bytes leaves room for it */
    write_bytes(victim.scratch.path, victim.bytes, victim.size + 1);
    CHECK_RESULT(read_store(victim.scratch.path, PICTURE_SMOOTH, NULL), SLUICE_ERROR_CORRUPT_DATA);
    victim_finish(&victim);
}

static void put(unsigned char *at, uint64_t value, int size)
{
    for (int i = 0; i < size; i++)
        at[i] = (unsigned char)(value >> 8 * i);
}

/* Lies with right checksums. */
static void contradictions_under_right_checksums_are_noticed(void **state)
{
    (void)state;
    const struct {
        size_t at; ///< in the header, or behind 4096 in the entry of the first tile
        uint64_t value;
        int size;
    } lies[] = {
        {16, 0, 4},
        {16, (1u << 20) + 1, 4},
        {20, 0, 4},
        {16, 301, 4},
        {20, 0xFFFFFFFF, 4},
        {24, 8, 4},
        {24, 0, 4},
        {28, 0, 4},
        {28, 2, 4},
        {28, 65537, 4},
        {32, 0, 4},
        {32, 30, 4},
        {32, 6, 4},
        {36, 64, 4},
        {40, 0, 4},
        {44, 0, 4},
        {44, 21, 4},
        {48, 5, 4},
        {48, 0xFFFFFFFF, 4},
        {52, 5, 4},
        {52, 0x80000000, 4},
        {56, 4, 4},
        {56, 0xFFFFFFFF, 4},
        {60, 4, 4},
        {60, 256, 4},
        {68, 3901, 4},
        {68, 0xFFFFFFFF, 4},
        {96, 1, 8},
        {96, UINT64_MAX, 8},
        {104, 4096, 8},
        {104, UINT64_MAX, 8},
        {4072, 0, 8},
        {4072, 9000, 8},
        {4072, UINT64_MAX, 8},
        {4096, 0, 8},
        {4096, 4096, 8},
        {4096, UINT64_MAX, 8},
        {4096, 1u << 30, 8},
        {4112, 0, 4},
        {4112, 65537, 4},
        {4112, 65536, 4},
        {4112, 0xFFFFFFFF, 4},
        {4112, 10, 4},
        {4112, 1, 4},
    };
    struct victim victim;
    victim_init(&victim, 3);
    unsigned char *copy = malloc(victim.size);
    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        memcpy(copy, victim.bytes, victim.size);
        put(copy + lies[i].at, lies[i].value, lies[i].size);
        naive_store_reseal(copy, victim.size);
        write_bytes(victim.scratch.path, copy, victim.size);
        struct messages messages;
        SluiceResult result = read_store(victim.scratch.path, PICTURE_SMOOTH, &messages);
        if (!is_an_error_of_the_file(result))
            fail_msg("%zu: %llu is %s", lies[i].at, (unsigned long long)lies[i].value,
                     sluiceGetResultName(result));
        assert_int_equal(messages.errors, 1);
    }
    free(copy);
    victim_finish(&victim);
}

/* A frame of other content, in the place of the first tile's, with right checksums. */
static SluiceResult read_with_frame(struct victim *victim, const void *frame, size_t size)
{
    struct naive_store store;
    assert_null(naive_store_load(&store, victim->scratch.path));
    struct naive_chunk chunk = naive_store_chunk(&store, 0);
    memcpy(store.bytes + chunk.offset, frame, size);
    put(store.bytes + chunk.entry + 16, size, 4);
    naive_store_reseal(store.bytes, store.size);
    write_bytes(victim->scratch.path, store.bytes, store.size);
    naive_store_finish(&store);
    struct messages messages;
    SluiceResult result = read_store(victim->scratch.path, PICTURE_SMOOTH, &messages);
    assert_true(result == SLUICE_SUCCESS || messages.errors == 1);
    return result;
}

static void frames_of_another_size_than_the_texels_are_refused(void **state)
{
    (void)state;
    /* Frames with a content size, each one run of the byte 7: RFC 8878, raw and RLE blocks. */
    const struct {
        uint64_t claimed;
        uint32_t run;
    } bombs[] = {
        {UINT64_C(1) << 40, 65536}, {65535, 65535}, {65537, 65537}, {65536, 65535}, {65536, 1},
        {1 << 17, 1 << 17}};
    struct victim victim;
    victim_init(&victim, 3);
    for (size_t i = 0; i < sizeof bombs / sizeof bombs[0]; i++) {
        /* descriptor: 8 bytes of content size, single segment */
        unsigned char frame[17] = {0x28, 0xB5, 0x2F, 0xFD, 0xE0};
        put(frame + 5, bombs[i].claimed, 8);
        put(frame + 13, bombs[i].run << 3 | 1 << 1 | 1, 3); /* last, RLE */
        frame[16] = 7;
        CHECK_RESULT(read_with_frame(&victim, frame, sizeof frame), SLUICE_ERROR_CORRUPT_DATA);
    }
    static const unsigned char without_size[9] = {0x28, 0xB5, 0x2F, 0xFD, 0x00, 0x58, 1, 0, 0};
    CHECK_RESULT(read_with_frame(&victim, without_size, 9), SLUICE_ERROR_CORRUPT_DATA);
    CHECK_RESULT(read_with_frame(&victim, "no frame", 8), SLUICE_ERROR_CORRUPT_DATA);
    victim_finish(&victim);
}

/* The first tile's own texels, in a frame made by zstd. */
static SluiceResult read_recompressed(uint32_t compression, bool says_size)
{
    struct victim victim;
    victim_init(&victim, compression);
    struct naive_store store;
    assert_null(naive_store_load(&store, victim.scratch.path));
    uint8_t *level = malloc(naive_store_level_size(&store, 0)), *tile = malloc(65536);
    assert_null(naive_store_level(&store, 0, 0, level));
    for (int y = 0; y < 128; y++)
        memcpy(tile + y * 512, level + y * 1200, 512);
    char frame[65536];
    ZSTD_CCtx *context = ZSTD_createCCtx();
    ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, says_size);
    size_t size = ZSTD_compress2(context, frame, sizeof frame, tile, 65536);
    assert_false(ZSTD_isError(size));
    assert_in_range(size, 1, naive_store_chunk(&store, 0).size);
    SluiceResult result = read_with_frame(&victim, frame, size);
    ZSTD_freeCCtx(context);
    free(level);
    free(tile);
    naive_store_finish(&store);
    victim_finish(&victim);
    return result;
}

static void a_frame_that_does_not_say_its_size_is_refused(void **state)
{
    (void)state;
    CHECK_OK(read_recompressed(3, true));
    CHECK_RESULT(read_recompressed(3, false), SLUICE_ERROR_CORRUPT_DATA);
}

static void a_frame_in_an_uncompressed_file_is_refused(void **state)
{
    (void)state;
    CHECK_RESULT(read_recompressed(0, true), SLUICE_ERROR_CORRUPT_DATA);
}

static void a_raw_tile_that_is_not_in_its_place_is_refused(void **state)
{
    (void)state;
    struct victim victim;
    victim_init(&victim, 0);
    const uint64_t places[] = {8192 + 65536, 8192 + 1, 4096, 0};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        put(victim.bytes + 4096, places[i], 8);
        naive_store_reseal(victim.bytes, victim.size);
        write_bytes(victim.scratch.path, victim.bytes, victim.size);
        CHECK_RESULT(read_store(victim.scratch.path, PICTURE_SMOOTH, NULL),
                     SLUICE_ERROR_CORRUPT_DATA);
    }
    victim_finish(&victim);
}

static void tiles_that_are_swapped_are_noticed(void **state)
{
    (void)state;
    for (uint32_t compression = 0; compression <= 3; compression += 3) {
        struct victim victim;
        victim_init(&victim, compression);
        struct naive_store store;
        assert_null(naive_store_load(&store, victim.scratch.path));
        uint8_t first[20];
        memcpy(first, store.bytes + 4096, 20);
        memcpy(store.bytes + 4096, store.bytes + 4116, 20);
        memcpy(store.bytes + 4116, first, 20);
        unsigned char *chunks = malloc(store.size);
        memcpy(chunks, store.bytes, store.size);
        naive_store_reseal(store.bytes, store.size);
        /* keep the old checksums of the entries, with the right one of the index */
        memcpy(store.bytes + 4104, chunks + 4104, 8);
        memcpy(store.bytes + 4124, chunks + 4124, 8);
        free(chunks);
        write_bytes(victim.scratch.path, store.bytes, store.size);
        CHECK_RESULT(read_store(victim.scratch.path, PICTURE_SMOOTH, NULL),
                     SLUICE_ERROR_CORRUPT_DATA);
        naive_store_finish(&store);
        victim_finish(&victim);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_flipped_bit_of_a_compressed_file_is_noticed),
        cmocka_unit_test(every_flipped_bit_that_is_read_of_a_raw_file_is_noticed),
        cmocka_unit_test(every_bit_of_header_and_chunks_that_matters_is_noticed),
        cmocka_unit_test(a_file_cut_anywhere_is_refused_when_it_is_opened),
        cmocka_unit_test(a_file_that_goes_on_behind_its_end_is_refused),
        cmocka_unit_test(contradictions_under_right_checksums_are_noticed),
        cmocka_unit_test(frames_of_another_size_than_the_texels_are_refused),
        cmocka_unit_test(a_frame_that_does_not_say_its_size_is_refused),
        cmocka_unit_test(a_frame_in_an_uncompressed_file_is_refused),
        cmocka_unit_test(a_raw_tile_that_is_not_in_its_place_is_refused),
        cmocka_unit_test(tiles_that_are_swapped_are_noticed),
    };
    return RUN_TESTS(tests);
}
