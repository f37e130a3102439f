/* Written stores are read by this library, and by a reader made from docs/store.md alone. */
#include "base/checked.h"
#include "store/naive_store.h"
#include "store/stores.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static void check_with_naive_reader(const char *path, enum picture picture)
{
    struct naive_store store;
    assert_null(naive_store_load(&store, path));
    for (uint32_t layer = 0; layer < store.layers; layer++)
        for (uint32_t level = 0; level < store.levels; level++) {
            size_t size = naive_store_level_size(&store, level);
            uint8_t *texels = malloc(size);
            assert_null(naive_store_level(&store, layer, level, texels));
            SluiceImageRegion region = {
                level, 0, 0, slc_mip_size(store.width, level), slc_mip_size(store.height, level),
                layer};
            SluiceFormat format = (SluiceFormat)store.format;
            assert_true(is_painted(picture, format, &region, texels,
                                   sluiceGetFormatRegionSize(format, region.width, 1)));
            free(texels);
        }
    naive_store_finish(&store);
}

static void check_round_trip(const SluiceStoreCreateInfo *given, enum picture picture)
{
    struct scratch scratch;
    struct messages written, read;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = *given;
    info.pPath = scratch.path;
    info.log = messages_log(&written);
    CHECK_OK(write_store(&info, picture));
    assert_false(exists(scratch.part_path));
    CHECK_OK(read_store(scratch.path, picture, &read));
    check_with_naive_reader(scratch.path, picture);
    assert_int_equal(written.errors + written.others + read.errors + read.others, 0);
    scratch_finish(&scratch);
}

static void every_format_comes_back_as_it_was(void **state)
{
    (void)state;
    static const enum picture pictures[] = {PICTURE_SMOOTH, PICTURE_NOISE, PICTURE_MIXED};
    for (int f = 1; f < SLUICE_FORMAT_COUNT; f++)
        for (uint32_t i = 0; i < 3; i++) {
            SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                          .width = 517,
                                          .height = 301,
                                          .format = (SluiceFormat)f,
                                          .compressionLevel = i == 2 ? 0 : 3};
            check_round_trip(&info, pictures[i]);
        }
}

static void every_size_comes_back_as_it_was(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1},   {2, 1},     {1, 3},      {128, 128},
                                        {129, 1}, {128, 127}, {255, 257},  {1, 3000},
                                        {640, 7}, {1023, 65}, {16384, 128}};
    static const SluiceFormat formats[] = {SLUICE_FORMAT_R8G8B8A8_SRGB,
                                           SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK,
                                           SLUICE_FORMAT_R16G16B16A16_SFLOAT};
    for (size_t n = 0; n < sizeof sizes / sizeof sizes[0]; n++)
        for (size_t f = 0; f < sizeof formats / sizeof formats[0]; f++)
            for (uint32_t level = 0; level <= 3; level += 3) {
                SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                              .width = sizes[n][0],
                                              .height = sizes[n][1],
                                              .format = formats[f],
                                              .compressionLevel = level};
                check_round_trip(&info, PICTURE_MIXED);
            }
}

static void arrays_come_back_layer_by_layer(void **state)
{
    (void)state;
    for (uint32_t level = 0; level <= 1; level++) {
        SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                      .width = 300,
                                      .height = 200,
                                      .arrayLayerCount = 7,
                                      .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                      .compressionLevel = level};
        check_round_trip(&info, PICTURE_MIXED);
    }
}

static void every_compression_level_comes_back_as_it_was(void **state)
{
    (void)state;
    for (uint32_t level = 1; level <= SLUICE_STORE_MAX_COMPRESSION_LEVEL; level++) {
        SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                      .width = 257,
                                      .height = 130,
                                      .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                      .compressionLevel = level};
        check_round_trip(&info, PICTURE_MIXED);
    }
}

static void more_tiles_than_a_block_of_the_index_has_come_back(void **state)
{
    (void)state;
    SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                  .width = 2304,
                                  .height = 1024,
                                  .arrayLayerCount = 2,
                                  .format = SLUICE_FORMAT_R16G16B16A16_SFLOAT,
                                  .compressionLevel = 1};
    check_round_trip(&info, PICTURE_MIXED);
}

static void what_a_file_says_of_itself_comes_back(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    char name[SLUICE_STORE_MAX_SOURCE_NAME + 2];
    memset(name, 'n', sizeof name);
    name[SLUICE_STORE_MAX_SOURCE_NAME] = '\0';
    SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                  .pPath = scratch.path,
                                  .width = 300,
                                  .height = 130,
                                  .mipLevelCount = 9,
                                  .arrayLayerCount = 2,
                                  .format = SLUICE_FORMAT_R8_UNORM,
                                  .colorSpace = SLUICE_STORE_COLOR_SPACE_ACESCG,
                                  .meaning = SLUICE_STORE_MEANING_COLOR_PREMULTIPLIED,
                                  .addressModeU = SLUICE_STORE_ADDRESS_MODE_CLAMP_TO_EDGE,
                                  .addressModeV = SLUICE_STORE_ADDRESS_MODE_MIRRORED_REPEAT,
                                  .pSourceName = name,
                                  .sourceSize = UINT64_C(0xFEDCBA9876543210),
                                  .sourceModifiedTimeNs = INT64_C(-1234567890123456789),
                                  .settingsHash = UINT64_C(0x0123456789ABCDEF),
                                  .compressionLevel = 5};
    CHECK_OK(write_store(&info, PICTURE_SMOOTH));
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = scratch.path};
    SluiceImageSource *source;
    SluiceStoreInfo got = {.structSize = sizeof got};
    SluiceImageInfo image = {.structSize = sizeof image};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(sluiceGetStoreInfo(source, &got));
    CHECK_OK(sluiceGetImageInfo(source, &image));
    SluiceStoreLayout layout;
    CHECK_OK(sluiceGetStoreLayout(300, 130, SLUICE_FORMAT_R8_UNORM, &layout));
    assert_memory_equal(&got.layout, &layout, sizeof layout);
    assert_int_equal(got.versionMajor, 1);
    assert_int_equal(got.versionMinor, SLUICE_STORE_VERSION_MINOR);
    assert_int_equal(got.arrayLayerCount, 2);
    assert_int_equal(got.colorSpace, info.colorSpace);
    assert_int_equal(got.meaning, info.meaning);
    assert_int_equal(got.addressModeU, info.addressModeU);
    assert_int_equal(got.addressModeV, info.addressModeV);
    assert_string_equal(got.pSourceName, name);
    assert_true(got.sourceSize == info.sourceSize);
    assert_true(got.sourceModifiedTimeNs == info.sourceModifiedTimeNs);
    assert_true(got.settingsHash == info.settingsHash);
    assert_int_equal(got.compressionLevel, 5);
    assert_int_equal(image.width, 300);
    assert_int_equal(image.height, 130);
    assert_int_equal(image.mipLevelCount, 9);
    assert_int_equal(image.arrayLayerCount, 2);
    assert_int_equal(image.addressModeU, info.addressModeU + SLUICE_IMAGE_ADDRESS_MODE_REPEAT);
    assert_int_equal(image.addressModeV, info.addressModeV + SLUICE_IMAGE_ADDRESS_MODE_REPEAT);
    assert_int_equal(image.format, SLUICE_FORMAT_R8_UNORM);
    assert_string_equal(image.pName, scratch.path);
    sluiceDestroyImageSource(source);
    struct naive_store store;
    assert_null(naive_store_load(&store, scratch.path));
    assert_int_equal(got.fileSize, store.size);
    assert_int_equal(store.color_space, 4);
    assert_int_equal(store.meaning, 2);
    assert_int_equal(store.address_u, 2);
    assert_int_equal(store.address_v, 1);
    assert_int_equal(store.compression, 5);
    assert_string_equal(store.name, name);
    assert_true(store.source_size == info.sourceSize && store.settings == info.settingsHash &&
                store.source_time == info.sourceModifiedTimeNs);
    naive_store_finish(&store);
    scratch_finish(&scratch);
}

static void tiles_that_do_not_shrink_are_stored_as_they_are(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                  .pPath = scratch.path,
                                  .width = 700,
                                  .height = 700,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .compressionLevel = 3};
    CHECK_OK(write_store(&info, PICTURE_NOISE));
    struct naive_store store;
    assert_null(naive_store_load(&store, scratch.path));
    uint64_t end = store.data;
    for (uint64_t i = 0; i < store.chunks; i++) {
        struct naive_chunk chunk = naive_store_chunk(&store, i);
        assert_int_equal(chunk.size, chunk.texel_size);
        assert_int_equal(chunk.offset, end); /* nothing is wasted */
        end += chunk.size;
    }
    assert_int_equal(end, store.size);
    naive_store_finish(&store);
    scratch_finish(&scratch);
}

static void the_same_calls_give_the_same_bytes(void **state)
{
    (void)state;
    for (uint32_t level = 0; level <= 3; level += 3) {
        unsigned char *bytes[2];
        size_t sizes[2];
        for (int i = 0; i < 2; i++) {
            struct scratch scratch;
            scratch_init(&scratch);
            SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                          .pPath = scratch.path,
                                          .width = 400,
                                          .height = 300,
                                          .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                          .compressionLevel = level};
            CHECK_OK(write_store(&info, PICTURE_MIXED));
            bytes[i] = read_bytes(scratch.path, &sizes[i]);
            scratch_finish(&scratch);
        }
        assert_int_equal(sizes[0], sizes[1]);
        assert_memory_equal(bytes[0], bytes[1], sizes[0]);
        free(bytes[0]);
        free(bytes[1]);
    }
}

/* Writes a chain whose tiles have one of two contents, and constant tails. */
static void write_repeats(const SluiceStoreCreateInfo *info, const unsigned char *tiles[2],
                          SluiceStoreLayout *layout)
{
    static const unsigned char tail[1 << 17];
    SluiceStoreWriter *writer;
    CHECK_OK(sluiceCreateStoreWriter(info, &writer));
    CHECK_OK(sluiceGetStoreWriterLayout(writer, layout));
    for (uint32_t l = 0; l < layout->tailFirstLevel; l++)
        for (uint32_t y = 0; y < layout->levelHeightInTiles[l]; y++)
            for (uint32_t x = 0; x < layout->levelWidthInTiles[l]; x++)
                CHECK_OK(sluiceWriteStoreTile(writer, 0, l, x, y, tiles[(x ^ y) & 1], 128 * 4));
    const void *levels[16];
    for (uint32_t i = 0; i < 16; i++)
        levels[i] = tail;
    CHECK_OK(sluiceWriteStoreTail(writer, 0, levels, NULL));
    CHECK_OK(sluiceFinishStore(writer));
    sluiceDestroyStoreWriter(writer);
}

static void tiles_with_equal_bytes_are_stored_once(void **state)
{
    (void)state;
    static unsigned char noise[65536], constant[65536];
    const unsigned char *tiles[2] = {noise, constant};
    const SluiceImageRegion all = {.width = 128, .height = 128};
    paint(PICTURE_NOISE, SLUICE_FORMAT_R8G8B8A8_UNORM, &all, noise, 512);
    memset(constant, 7, sizeof constant);
    for (uint32_t compression = 0; compression <= 3; compression += 3) {
        struct scratch scratch;
        scratch_init(&scratch);
        SluiceStoreLayout layout;
        const SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                            .pPath = scratch.path,
                                            .width = 2048,
                                            .height = 2048,
                                            .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                            .compressionLevel = compression};
        write_repeats(&info, tiles, &layout);
        struct naive_store store;
        assert_null(naive_store_load(&store, scratch.path));
        uint64_t places[2] = {naive_store_chunk(&store, 0).offset,
                              naive_store_chunk(&store, 1).offset};
        for (uint64_t i = 0; compression && i < 256; i++)
            assert_int_equal(naive_store_chunk(&store, i).offset, places[(i % 16 ^ i / 16) & 1]);
        if (compression)
            assert_in_range(store.size - store.data, 65536, 65536 + 4096);
        else
            assert_true(store.size >= layout.tileCount / 2 * 65536);
        uint8_t *texels = malloc(naive_store_level_size(&store, 0));
        assert_null(naive_store_level(&store, 0, 0, texels));
        for (uint32_t y = 0; y < 2048; y++)
            for (uint32_t x = 0; x < 2048; x += 128)
                assert_memory_equal(texels + (y * 2048u + x) * 4u,
                                    tiles[(x / 128 ^ y / 128) & 1] + y % 128 * 512, 512);
        free(texels);
        naive_store_finish(&store);
        scratch_finish(&scratch);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_comes_back_as_it_was),
        cmocka_unit_test(every_size_comes_back_as_it_was),
        cmocka_unit_test(arrays_come_back_layer_by_layer),
        cmocka_unit_test(every_compression_level_comes_back_as_it_was),
        cmocka_unit_test(more_tiles_than_a_block_of_the_index_has_come_back),
        cmocka_unit_test(what_a_file_says_of_itself_comes_back),
        cmocka_unit_test(tiles_that_do_not_shrink_are_stored_as_they_are),
        cmocka_unit_test(the_same_calls_give_the_same_bytes),
        cmocka_unit_test(tiles_with_equal_bytes_are_stored_once),
    };
    return RUN_TESTS(tests);
}
