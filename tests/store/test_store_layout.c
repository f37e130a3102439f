/* Division of textures into tiles, compared with docs/store.md texel by texel. */
#include <sluice/store.h>

#include "base/checked.h"
#include "store/grid.h"
#include "support/test.h"

#include <stdlib.h>

static const uint32_t sizes[][2] = {{1, 1},       {64, 64},    {127, 128}, {128, 128},
                                    {129, 128},   {300, 200},  {1, 5000},  {4097, 3},
                                    {16384, 128}, {511, 1025}, {2, 700},   {1024, 512}};

static void every_texel_of_a_level_is_in_one_tile(void **state)
{
    (void)state;
    for (size_t n = 0; n < sizeof sizes / sizeof sizes[0]; n++)
        for (int f = 1; f < SLUICE_FORMAT_COUNT; f++) {
            SluiceStoreLayout layout;
            CHECK_OK(sluiceGetStoreLayout(sizes[n][0], sizes[n][1], (SluiceFormat)f, &layout));
            for (uint32_t l = 0; l < layout.mipLevelCount; l++) {
                uint64_t covered = 0;
                for (uint32_t y = 0; y < layout.levelHeightInTiles[l]; y++)
                    for (uint32_t x = 0; x < layout.levelWidthInTiles[l]; x++) {
                        SluiceImageRegion region;
                        CHECK_OK(sluiceGetStoreTileRegion(&layout, l, x, y, &region));
                        assert_int_equal(region.x, x * layout.tileWidth);
                        assert_int_equal(region.y, y * layout.tileHeight);
                        assert_in_range(region.width, 1, layout.tileWidth);
                        assert_in_range(region.height, 1, layout.tileHeight);
                        covered += (uint64_t)region.width * region.height;
                    }
                assert_int_equal(covered, (uint64_t)slc_mip_size(sizes[n][0], l) *
                                              slc_mip_size(sizes[n][1], l));
            }
        }
}

static void the_tail_begins_where_a_level_fits_into_a_tile_without_filling_it(void **state)
{
    (void)state;
    static const struct {
        uint32_t width, height;
        SluiceFormat format;
        uint32_t first, size;
    } cases[] = {
        {1, 1, SLUICE_FORMAT_R8_UNORM, 0, 1},
        {1, 1, SLUICE_FORMAT_BC7_SRGB_BLOCK, 0, 16},
        {128, 128, SLUICE_FORMAT_R8G8B8A8_SRGB, 1, 4 * (64 * 64 + 1024 + 256 + 64 + 16 + 4 + 1)},
        {128, 127, SLUICE_FORMAT_R8G8B8A8_SRGB, 0,
         4 * (128 * 127 + 64 * 63 + 32 * 31 + 16 * 15 + 8 * 7 + 4 * 3 + 2 + 1)},
        {4096, 4096, SLUICE_FORMAT_R8G8B8A8_UNORM, 6, 4 * (4096 + 1024 + 256 + 64 + 16 + 4 + 1)},
        {256, 256, SLUICE_FORMAT_BC7_UNORM_BLOCK, 1, 16 * (1024 + 256 + 64 + 16 + 4 + 1 + 1 + 1)},
        /* tiles of 128 x 64 */
        {128, 128, SLUICE_FORMAT_R16G16B16A16_SFLOAT, 1,
         8 * (64 * 64 + 1024 + 256 + 64 + 16 + 4 + 1)},
        /* 128 x 1 is the first that is no wider than a tile */
        {16384, 128, SLUICE_FORMAT_R8G8B8A8_UNORM, 7, 4 * 255},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        SluiceStoreLayout layout;
        CHECK_OK(sluiceGetStoreLayout(cases[i].width, cases[i].height, cases[i].format, &layout));
        assert_int_equal(layout.tailFirstLevel, cases[i].first);
        assert_int_equal(layout.tailSize, cases[i].size);
    }
}

static void no_tail_is_as_large_as_two_tiles(void **state)
{
    (void)state;
    uint32_t random = 1;
    for (int i = 0; i < 20000; i++) {
        random = random * 1664525u + 1013904223u;
        uint32_t width = 1 + (random >> 8) % 700, height = 1 + (random >> 20) % 700;
        for (int f = 1; f < SLUICE_FORMAT_COUNT; f += 3) {
            SluiceStoreLayout layout;
            CHECK_OK(sluiceGetStoreLayout(width, height, (SluiceFormat)f, &layout));
            assert_in_range(layout.tailSize, 1, 131071);
        }
    }
}

static void chunk_numbers_and_places_are_the_same_order(void **state)
{
    (void)state;
    for (size_t n = 0; n < sizeof sizes / sizeof sizes[0]; n++) {
        struct slc_store_grid grid;
        CHECK_OK(slc_store_grid_init(&grid, sizes[n][0], sizes[n][1],
                                     SLUICE_FORMAT_R16G16B16A16_SFLOAT, 3));
        uint64_t number = 0, end = 0;
        for (uint32_t layer = 0; layer < 3; layer++)
            for (uint32_t l = 0; l <= grid.layout.tailFirstLevel; l++)
                for (uint32_t y = 0; y < grid.layout.levelHeightInTiles[l]; y++)
                    for (uint32_t x = 0; x < grid.layout.levelWidthInTiles[l]; x++) {
                        struct slc_store_place place = {layer, l, x, y};
                        assert_int_equal(slc_store_chunk_number(&grid, &place), number);
                        struct slc_store_place back = slc_store_chunk_place(&grid, number++);
                        assert_memory_equal(&back, &place, sizeof place);
                        /* uncompressed, one lies right behind the other */
                        assert_int_equal(slc_store_chunk_offset(&grid, &place),
                                         (end + 4095) / 4096 * 4096);
                        end = slc_store_chunk_offset(&grid, &place) +
                              slc_store_chunk_size(&grid, &place);
                    }
        assert_int_equal(grid.chunk_count, number);
        assert_int_equal(3 * grid.layer_size, (end + 4095) / 4096 * 4096);
    }
}

static void the_largest_texture_has_offsets_that_fit(void **state)
{
    (void)state;
    struct slc_store_grid grid;
    CHECK_OK(slc_store_grid_init(&grid, SLUICE_STORE_MAX_SIZE, SLUICE_STORE_MAX_SIZE,
                                 SLUICE_FORMAT_R32G32B32A32_SFLOAT, SLUICE_STORE_MAX_ARRAY_LAYERS));
    struct slc_store_place last = slc_store_chunk_place(&grid, grid.chunk_count - 1);
    assert_int_equal(last.layer, SLUICE_STORE_MAX_ARRAY_LAYERS - 1);
    assert_true(slc_store_is_tail(&grid, &last));
    /* 16 bytes per texel and a third more for the levels, to within the tails */
    double expected = 4.0 / 3.0 * 16.0 * 1099511627776.0 * 65536.0;
    double got = (double)(slc_store_chunk_offset(&grid, &last));
    assert_true(got > 0.9999 * expected && got < 1.0001 * expected && got < 9.2e18);
}

static void what_is_not_a_texture_is_refused(void **state)
{
    (void)state;
    SluiceStoreLayout layout;
    SluiceImageRegion region;
    const SluiceFormat rgba = SLUICE_FORMAT_R8G8B8A8_UNORM;
    CHECK_RESULT(sluiceGetStoreLayout(0, 1, rgba, &layout), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceGetStoreLayout(1, 0, rgba, &layout), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceGetStoreLayout((1u << 20) + 1, 1, rgba, &layout),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceGetStoreLayout(1, 1, SLUICE_FORMAT_UNDEFINED, &layout),
                 SLUICE_ERROR_UNSUPPORTED);
    CHECK_RESULT(sluiceGetStoreLayout(1, 1, (SluiceFormat)SLUICE_FORMAT_COUNT, &layout),
                 SLUICE_ERROR_UNSUPPORTED);
    CHECK_RESULT(sluiceGetStoreLayout(1, 1, rgba, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_OK(sluiceGetStoreLayout(300, 100, rgba, &layout));
    CHECK_RESULT(sluiceGetStoreTileRegion(&layout, 0, 3, 0, &region),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceGetStoreTileRegion(&layout, 0, 0, 1, &region),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceGetStoreTileRegion(&layout, 9, 0, 0, &region),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceGetStoreTileRegion(NULL, 0, 0, 0, &region), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceGetStoreTileRegion(&layout, 0, 0, 0, NULL), SLUICE_ERROR_NULL_POINTER);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_texel_of_a_level_is_in_one_tile),
        cmocka_unit_test(the_tail_begins_where_a_level_fits_into_a_tile_without_filling_it),
        cmocka_unit_test(no_tail_is_as_large_as_two_tiles),
        cmocka_unit_test(chunk_numbers_and_places_are_the_same_order),
        cmocka_unit_test(the_largest_texture_has_offsets_that_fit),
        cmocka_unit_test(what_is_not_a_texture_is_refused),
    };
    return RUN_TESTS(tests);
}
