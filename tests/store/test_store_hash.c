/* The hash of a store follows from its texels, not from where tiles lie. */
#include "store/store_layout.h"

#include "store/stores.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

static SluiceStoreCreateInfo describe(const struct scratch *scratch)
{
    return (SluiceStoreCreateInfo){.structSize = sizeof(SluiceStoreCreateInfo),
                                   .pPath = scratch->path,
                                   .width = 2900,
                                   .height = 1500,
                                   .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                   .compressionLevel = 3};
}

static SluiceResult hash_of(const char *path, uint64_t *hash)
{
    SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info, .pPath = path};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateStoreImageSource(&info, &source));
    SluiceResult result = sluiceHashStore(source, hash);
    sluiceDestroyImageSource(source);
    return result;
}

/* Writes level 0 from its last tile to its first, then the missing levels. */
static void write_backwards(const SluiceStoreCreateInfo *info)
{
    SluiceStoreWriter *writer;
    SluiceStoreLayout layout;
    CHECK_OK(sluiceCreateStoreWriter(info, &writer));
    CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
    for (uint32_t y = layout.levelHeightInTiles[0]; y-- > 0;)
        for (uint32_t x = layout.levelWidthInTiles[0]; x-- > 0;)
            CHECK_OK(write_one(writer, &layout, PICTURE_MIXED, 0, 0, x, y));
    CHECK_OK(write_tiles(writer, info, PICTURE_MIXED, UINT64_MAX));
    sluiceDestroyStoreWriter(writer);
}

static void the_hash_is_that_of_the_checksums_wherever_tiles_lie(void **state)
{
    (void)state;
    struct scratch forward, backward;
    uint64_t hashes[2], expected = 0;
    SluiceStoreLayout layout;
    size_t sizes[2];
    scratch_init(&forward);
    scratch_init(&backward);
    SluiceStoreCreateInfo info = describe(&forward);
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    CHECK_OK(sluiceGetStoreLayout(info.width, info.height, info.format, &layout));
    info.pPath = backward.path;
    write_backwards(&info);
    unsigned char *bytes[] = {read_bytes(forward.path, &sizes[0]),
                              read_bytes(backward.path, &sizes[1])};
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_not_equal(bytes[0], bytes[1], sizes[0]);
    CHECK_OK(hash_of(forward.path, &hashes[0]));
    CHECK_OK(hash_of(backward.path, &hashes[1]));
    assert_true(layout.tileCount > SLC_STORE_BLOCK_ENTRIES); /* more than one block */
    for (uint64_t number = 0; number < layout.tileCount; number++) {
        struct slc_store_entry entry = slc_store_entry_read(
            bytes[0] + slc_store_block_offset(number / SLC_STORE_BLOCK_ENTRIES) +
            slc_store_entry_offset(number));
        const uint64_t pair[2] = {expected, entry.checksum};
        unsigned char pair_bytes[16];
        for (uint32_t i = 0; i < 16; i++)
            pair_bytes[i] = (unsigned char)(pair[i / 8] >> 8 * (i % 8));
        expected = XXH3_64bits(pair_bytes, 16);
    }
    assert_true(hashes[0] == expected && hashes[1] == expected);
    free(bytes[0]);
    free(bytes[1]);
    scratch_finish(&forward);
    scratch_finish(&backward);
}

static void other_texels_and_other_settings_have_other_hashes(void **state)
{
    (void)state;
    struct scratch scratch;
    uint64_t hashes[3];
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch);
    info.width = info.height = 300;
    for (uint32_t i = 0; i < 3; i++) {
        info.settingsHash = i == 2;
        CHECK_OK(write_store(&info, i == 1 ? PICTURE_SMOOTH : PICTURE_MIXED));
        CHECK_OK(hash_of(scratch.path, &hashes[i]));
    }
    assert_true(hashes[0] != hashes[1] && hashes[0] != hashes[2]);
    scratch_finish(&scratch);
}

static void a_damaged_index_has_no_hash(void **state)
{
    (void)state;
    struct scratch scratch;
    uint64_t hash = 7;
    size_t size;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = describe(&scratch);
    info.width = info.height = 300;
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    unsigned char *bytes = read_bytes(scratch.path, &size);
    bytes[SLC_STORE_HEADER_SIZE + 9] ^= 1;
    write_bytes(scratch.path, bytes, size);
    CHECK_RESULT(hash_of(scratch.path, &hash), SLUICE_ERROR_CORRUPT_DATA);
    assert_int_equal(hash, 7);
    free(bytes);
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hash_is_that_of_the_checksums_wherever_tiles_lie),
        cmocka_unit_test(other_texels_and_other_settings_have_other_hashes),
        cmocka_unit_test(a_damaged_index_has_no_hash),
    };
    return RUN_TESTS(tests);
}
