/* Texels are little endian in files and have the host's byte order in memory. */
#include "base/checked.h"
#include "store/naive_store.h"
#include "store/stores.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

/* Words of different bytes: `index` counts them in the level. */
static uint32_t word_of(uint32_t level, uint64_t index)
{
    return (uint32_t)index * 0x9E3779B1u ^ level << 20;
}

/* Words of a region of a level as a program has them in memory. */
static void put_words(const SluiceStoreLayout *layout, const SluiceImageRegion *region,
                      uint32_t word_size, char *texels, size_t pitch)
{
    uint64_t words = sluiceGetFormatRegionSize(layout->format, 1, 1) / word_size;
    uint64_t row = words * slc_mip_size(layout->width, region->mipLevel);
    for (uint32_t y = 0; y < region->height; y++)
        for (uint64_t i = 0; i < words * region->width; i++) {
            uint32_t word =
                word_of(region->mipLevel, (region->y + y) * row + region->x * words + i);
            uint16_t half = (uint16_t)word;
            memcpy(texels + y * pitch + i * word_size, word_size == 2 ? (const void *)&half : &word,
                   word_size);
        }
}

static void write_words(const SluiceStoreCreateInfo *info, uint32_t word_size)
{
    SluiceStoreWriter *writer;
    SluiceStoreLayout layout;
    CHECK_OK(sluiceCreateStoreWriter(info, &writer));
    CHECK_OK(sluiceGetStoreWriterLayout(writer, &layout));
    char *texels = malloc(2 * 65536), *tail = texels;
    for (uint32_t l = 0; l < layout.tailFirstLevel; l++)
        for (uint32_t y = 0; y < layout.levelHeightInTiles[l]; y++)
            for (uint32_t x = 0; x < layout.levelWidthInTiles[l]; x++) {
                SluiceImageRegion region;
                CHECK_OK(sluiceGetStoreTileRegion(&layout, l, x, y, &region));
                size_t pitch =
                    sluiceGetFormatRegionSize(layout.format, region.width, 1) + x % 2 * 3;
                put_words(&layout, &region, word_size, texels, pitch);
                CHECK_OK(sluiceWriteStoreTile(writer, 0, l, x, y, texels, pitch));
            }
    const void *levels[SLUICE_STORE_MAX_MIP_LEVELS];
    for (uint32_t l = layout.tailFirstLevel; l < layout.mipLevelCount; l++) {
        SluiceImageRegion region = {
            l, 0, 0, slc_mip_size(info->width, l), slc_mip_size(info->height, l), 0};
        put_words(&layout, &region, word_size, tail,
                  sluiceGetFormatRegionSize(layout.format, region.width, 1));
        levels[l - layout.tailFirstLevel] = tail;
        tail += sluiceGetFormatRegionSize(layout.format, region.width, region.height);
    }
    CHECK_OK(sluiceWriteStoreTail(writer, 0, levels, NULL));
    CHECK_OK(sluiceFinishStore(writer));
    sluiceDestroyStoreWriter(writer);
    free(texels);
}

/* Words have their lowest byte first in the file, and the host's order in memory. */
static void check_words(const SluiceStoreCreateInfo *info, uint32_t word_size)
{
    struct naive_store file;
    SluiceImageSource *source;
    SluiceStoreInfo store = {.structSize = sizeof store};
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = info->pPath};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(sluiceGetStoreInfo(source, &store));
    assert_null(naive_store_load(&file, info->pPath));
    for (uint32_t l = 0; l < store.layout.mipLevelCount; l++) {
        SluiceImageRegion region = {
            l, 0, 0, slc_mip_size(info->width, l), slc_mip_size(info->height, l), 0};
        size_t size = naive_store_level_size(&file, l), pitch = size / region.height;
        uint8_t *stored = malloc(size);
        char *read = malloc(size), *expected = malloc(size);
        assert_null(naive_store_level(&file, 0, l, stored));
        for (size_t i = 0; i < size; i++)
            assert_int_equal(stored[i], (uint8_t)(word_of(l, i / word_size) >> i % word_size * 8));
        put_words(&store.layout, &region, word_size, expected, pitch);
        CHECK_OK(sluiceReadImageRegion(source, &region, read, pitch));
        assert_memory_equal(read, expected, size);
        free(stored), free(read), free(expected);
    }
    naive_store_finish(&file);
    sluiceDestroyImageSource(source);
}

static void words_have_their_lowest_byte_first_in_files(void **state)
{
    (void)state;
    static const struct {
        SluiceFormat format;
        uint32_t word_size;
    } formats[] = {{SLUICE_FORMAT_R16G16_SFLOAT, 2},
                   {SLUICE_FORMAT_R32_UINT, 4},
                   {SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32, 4}};
    for (uint32_t i = 0; i < 6; i++) {
        struct scratch scratch;
        scratch_init(&scratch);
        SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                      .pPath = scratch.path,
                                      .width = 300,
                                      .height = 70,
                                      .format = formats[i / 2].format,
                                      .compressionLevel = i % 2};
        write_words(&info, formats[i / 2].word_size);
        check_words(&info, formats[i / 2].word_size);
        scratch_finish(&scratch);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_have_their_lowest_byte_first_in_files),
    };
    return RUN_TESTS(tests);
}
