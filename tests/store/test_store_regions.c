/* Rectangles at any position of any level, as GPUs with other tails and other readers request
 * them. */
#include "base/checked.h"
#include "store/stores.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static SluiceImageSource *open_store(const struct scratch *scratch,
                                     const SluiceStoreCreateInfo *given)
{
    SluiceStoreCreateInfo info = *given;
    info.pPath = scratch->path;
    CHECK_OK(write_store(&info, PICTURE_MIXED));
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = scratch->path};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    return source;
}

static uint32_t draw(uint32_t *random, uint32_t below)
{
    *random = *random * 1664525u + 1013904223u;
    return (*random >> 12) % below;
}

/* Draws a region. Compressed formats use whole blocks. */
static SluiceImageRegion draw_region(const SluiceImageInfo *info, uint32_t *random)
{
    SluiceFormatInfo format = {.structSize = sizeof format};
    CHECK_OK(sluiceGetFormatInfo(info->format, &format));
    uint32_t level = draw(random, info->mipLevelCount), extent = format.blockWidth;
    uint32_t width = slc_mip_size(info->width, level), height = slc_mip_size(info->height, level);
    SluiceImageRegion region = {level, 0, 0, 0, 0, draw(random, info->arrayLayerCount)};
    region.x = draw(random, slc_div_up_u32(width, extent)) * extent;
    region.y = draw(random, slc_div_up_u32(height, extent)) * extent;
    uint32_t columns = 1 + draw(random, slc_div_up_u32(width - region.x, extent));
    uint32_t rows = 1 + draw(random, slc_div_up_u32(height - region.y, extent));
    region.width = slc_min_u32(columns * extent, width - region.x);
    region.height = slc_min_u32(rows * extent, height - region.y);
    return region;
}

/* Bytes between rows must stay unchanged. */
static void check_region(SluiceImageSource *source, const SluiceImageInfo *info,
                         const SluiceImageRegion *region, size_t gap)
{
    size_t row = sluiceGetFormatRegionSize(info->format, region->width, 1), pitch = row + gap;
    size_t rows = sluiceGetFormatRegionSize(info->format, region->width, region->height) / row;
    size_t size = (rows - 1) * pitch + row;
    unsigned char *texels = malloc(size);
    memset(texels, 0xA5, size);
    CHECK_OK(sluiceReadImageRegion(source, region, texels, pitch));
    assert_true(is_painted(PICTURE_MIXED, info->format, region, texels, pitch));
    for (size_t y = 0; y + 1 < rows; y++)
        for (size_t i = row; i < pitch; i++)
            assert_int_equal(texels[y * pitch + i], 0xA5);
    free(texels);
}

static void any_rectangle_is_what_was_written_there(void **state)
{
    (void)state;
    static const SluiceFormat formats[] = {
        SLUICE_FORMAT_R8G8B8A8_SRGB, SLUICE_FORMAT_BC7_SRGB_BLOCK, SLUICE_FORMAT_R8_UNORM,
        SLUICE_FORMAT_R16G16B16A16_SFLOAT, SLUICE_FORMAT_BC4_UNORM_BLOCK};
    uint32_t random = 5;
    for (size_t f = 0; f < sizeof formats / sizeof formats[0]; f++)
        for (uint32_t compression = 0; compression < 2; compression++) {
            struct scratch scratch;
            scratch_init(&scratch);
            SluiceStoreCreateInfo create = {.structSize = sizeof create,
                                            .width = 795,
                                            .height = 411,
                                            .arrayLayerCount = 2,
                                            .format = formats[f],
                                            .compressionLevel = compression};
            SluiceImageSource *source = open_store(&scratch, &create);
            SluiceImageInfo info = {.structSize = sizeof info};
            CHECK_OK(sluiceGetImageInfo(source, &info));
            for (int i = 0; i < 60; i++) {
                SluiceImageRegion region = draw_region(&info, &random);
                check_region(source, &info, &region, draw(&random, 2) * 13);
            }
            sluiceDestroyImageSource(source);
            scratch_finish(&scratch);
        }
}

static void every_tile_and_every_level_is_read_by_its_own_region(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo create = {.structSize = sizeof create,
                                    .width = 795,
                                    .height = 411,
                                    .format = SLUICE_FORMAT_R8G8B8A8_SRGB,
                                    .compressionLevel = 1};
    SluiceImageSource *source = open_store(&scratch, &create);
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceStoreInfo store = {.structSize = sizeof store};
    CHECK_OK(sluiceGetImageInfo(source, &info));
    CHECK_OK(sluiceGetStoreInfo(source, &store));
    for (uint32_t l = 0; l < info.mipLevelCount; l++)
        for (uint32_t y = 0; y < store.layout.levelHeightInTiles[l]; y++)
            for (uint32_t x = 0; x < store.layout.levelWidthInTiles[l]; x++)
                for (size_t gap = 0; gap < 8; gap += 4) {
                    SluiceImageRegion region;
                    CHECK_OK(sluiceGetStoreTileRegion(&store.layout, l, x, y, &region));
                    check_region(source, &info, &region, gap);
                }
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
}

static void a_store_of_one_layer_can_be_a_layer_of_an_array(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo create = {.structSize = sizeof create,
                                    .width = 300,
                                    .height = 200,
                                    .format = SLUICE_FORMAT_R8G8B8A8_SRGB,
                                    .compressionLevel = 1};
    SluiceImageSource *source = open_store(&scratch, &create);
    SluiceImageSource *const layers[] = {source, source};
    SluiceImageSource *array;
    SluiceImageInfo info = {.structSize = sizeof info};
    /* a source of one layer can be one of an array's */
    CHECK_OK(sluiceCreateArrayImageSource(layers, 2, NULL, &array));
    CHECK_OK(sluiceGetImageInfo(array, &info));
    assert_int_equal(info.arrayLayerCount, 2);
    sluiceDestroyImageSource(array);
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
}

static void sources_share_a_pool(void **state)
{
    (void)state;
    struct scratch scratches[2];
    SluiceImageSource *sources[2];
    SluiceStoreReadPool *pool;
    struct failing_allocator allocator;
    failing_allocator_init(&allocator, UINT64_MAX);
    CHECK_OK(sluiceCreateStoreReadPool(&allocator.callbacks, &pool));
    uint64_t after_first = 0;
    for (int i = 0; i < 2; i++) {
        scratch_init(&scratches[i]);
        SluiceStoreCreateInfo info = {.structSize = sizeof info,
                                      .pPath = scratches[i].path,
                                      .width = 300,
                                      .height = 200,
                                      .format = SLUICE_FORMAT_R8G8B8A8_SRGB,
                                      .compressionLevel = 1};
        CHECK_OK(write_store(&info, PICTURE_MIXED));
        SluiceStoreImageSourceCreateInfo create = {
            .structSize = sizeof create, .pPath = scratches[i].path, .readPool = pool};
        CHECK_OK(sluiceCreateStoreImageSource(&create, &sources[i]));
        SluiceImageInfo image = {.structSize = sizeof image};
        CHECK_OK(sluiceGetImageInfo(sources[i], &image));
        for (uint32_t l = 0; l < image.mipLevelCount; l++) {
            SluiceImageRegion level = {l, 0, 0, slc_mip_size(300, l), slc_mip_size(200, l), 0};
            check_region(sources[i], &image, &level, 4);
        }
        if (i == 0)
            after_first = allocator.live_bytes;
    }
    assert_in_range(after_first, 1, 512 * 1024);
    assert_int_equal(allocator.live_bytes, after_first);
    for (int i = 0; i < 2; i++) {
        sluiceDestroyImageSource(sources[i]);
        scratch_finish(&scratches[i]);
    }
    sluiceDestroyStoreReadPool(pool);
    sluiceDestroyStoreReadPool(NULL);
    assert_int_equal(allocator.live_bytes, 0);
    CHECK_RESULT(sluiceCreateStoreReadPool(NULL, NULL), SLUICE_ERROR_NULL_POINTER);
    failing_allocator_init(&allocator, 0);
    CHECK_RESULT(sluiceCreateStoreReadPool(&allocator.callbacks, &pool),
                 SLUICE_ERROR_OUT_OF_HOST_MEMORY);
}

static void what_leaves_the_level_is_refused(void **state)
{
    (void)state;
    struct scratch scratch;
    scratch_init(&scratch);
    SluiceStoreCreateInfo create = {.structSize = sizeof create,
                                    .width = 300,
                                    .height = 200,
                                    .format = SLUICE_FORMAT_R8_UNORM,
                                    .arrayLayerCount = 2};
    SluiceImageSource *source = open_store(&scratch, &create);
    char texel[1];
    const SluiceImageRegion bad[] = {{0, 300, 0, 1, 1, 0}, {0, 0, 200, 1, 1, 0},
                                     {9, 0, 0, 1, 1, 0},   {0, 0, 0, 1, 1, 2},
                                     {0, 0, 0, 0, 1, 0},   {8, 0, 0, 2, 1, 0}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        CHECK_RESULT(sluiceReadImageRegion(source, &bad[i], texel, 1000),
                     SLUICE_ERROR_INVALID_ARGUMENT);
    SluiceStoreInfo info = {.structSize = sizeof info};
    CHECK_RESULT(sluiceGetStoreInfo(NULL, &info), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceGetStoreInfo(source, NULL), SLUICE_ERROR_NULL_POINTER);
    SluiceImageInfo image = {
        .structSize = sizeof image, .width = 1, .height = 1, .format = SLUICE_FORMAT_R8_UNORM};
    SluiceImageSource *other;
    CHECK_OK(sluiceCreateMemoryImageSource("a", &image, NULL, &other));
    CHECK_RESULT(sluiceGetStoreInfo(other, &info), SLUICE_ERROR_INVALID_ARGUMENT);
    sluiceDestroyImageSource(other);
    sluiceDestroyImageSource(source);
    scratch_finish(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_rectangle_is_what_was_written_there),
        cmocka_unit_test(every_tile_and_every_level_is_read_by_its_own_region),
        cmocka_unit_test(a_store_of_one_layer_can_be_a_layer_of_an_array),
        cmocka_unit_test(sources_share_a_pool),
        cmocka_unit_test(what_leaves_the_level_is_refused),
    };
    return RUN_TESTS(tests);
}
