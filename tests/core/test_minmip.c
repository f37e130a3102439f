#include "core/fixture.h"

#include <stdlib.h>
#include <string.h>

static bool is_resident(const struct fixture *f, SluiceTextureId id, uint32_t tile)
{
    SluiceTileState s = fixture_state(f, id, tile);
    return s == SLUICE_TILE_STATE_MAPPED || s == SLUICE_TILE_STATE_STANDBY;
}

/* Computes a texel from the header's definition: goes to finer levels while the tile over the texel
 * is resident. */
static uint8_t expected_texel(const struct fixture *f, SluiceTextureId id,
                              const SluiceStreamedTextureLayout *layout, uint32_t x, uint32_t y)
{
    uint32_t regular = layout->desc.regularMipCount, finest = SLUICE_MIP_UNTOUCHED;
    for (uint32_t i = layout->regularTileCount; i < layout->tileCount; i++)
        if (!is_resident(f, id, i))
            return SLUICE_MIP_UNTOUCHED;
    if (regular < layout->desc.mipLevelCount)
        finest = regular;
    for (uint32_t level = regular; level-- > 0;) {
        uint32_t tx = x, ty = y; /* parent by parent */
        for (uint32_t l = 1; l <= level; l++) {
            tx = tx / 2 < layout->levelWidthInTiles[l] ? tx / 2 : layout->levelWidthInTiles[l] - 1;
            ty =
                ty / 2 < layout->levelHeightInTiles[l] ? ty / 2 : layout->levelHeightInTiles[l] - 1;
        }
        uint32_t tile = layout->levelFirstTile[level] + ty * layout->levelWidthInTiles[level] + tx;
        if (!is_resident(f, id, tile))
            break;
        finest = level;
    }
    return (uint8_t)finest;
}

static uint8_t *read_minmip(const struct fixture *f, SluiceTextureId id)
{
    SluiceStreamedTextureLayout layout = fixture_layout(f, id);
    size_t size = (size_t)layout.minMipWidth * layout.minMipHeight;
    uint8_t *map = malloc(size);
    assert_non_null(map);
    CHECK_OK(sluiceWriteMinMipData(f->manager, id, layout.minMipWidth, size, map));
    return map;
}

static void check_minmip(const struct fixture *f, SluiceTextureId id)
{
    SluiceStreamedTextureLayout layout = fixture_layout(f, id);
    uint8_t *map = read_minmip(f, id);
    for (uint32_t y = 0; y < layout.minMipHeight; y++)
        for (uint32_t x = 0; x < layout.minMipWidth; x++)
            assert_int_equal(map[y * layout.minMipWidth + x], expected_texel(f, id, &layout, x, y));
    free(map);
}

/* The copy that an application keeps: only the rectangles handed out are written into it. */
static void update_copy(struct fixture *f, SluiceTextureId id, uint8_t *copy)
{
    SluiceStreamedTextureLayout layout = fixture_layout(f, id);
    SluiceMinMipRect rect;
    uint32_t count = 1;
    CHECK_OK(sluiceGetMinMipUpdates(f->manager, &count, &rect));
    if (count) {
        assert_true(rect.textureId == id && rect.width > 0 && rect.height > 0);
        assert_true(rect.x + rect.width <= layout.minMipWidth);
        assert_true(rect.y + rect.height <= layout.minMipHeight);
        size_t size = (size_t)(rect.height - 1) * layout.minMipWidth + rect.width;
        CHECK_OK(sluiceWriteMinMipRect(f->manager, &rect, layout.minMipWidth, size,
                                       copy + (size_t)rect.y * layout.minMipWidth + rect.x));
    }
    uint8_t *whole = read_minmip(f, id);
    assert_memory_equal(copy, whole, (size_t)layout.minMipWidth * layout.minMipHeight);
    free(whole);
}

static const SluiceStreamedTextureDesc shapes[] = {
    {.width = 1025, .height = 1025, .tileWidth = 128, .tileHeight = 128},
    {.width = 2052, .height = 700, .tileWidth = 128, .tileHeight = 64},
    {.width = 4100, .height = 260, .tileWidth = 128, .tileHeight = 32},
    {.width = 1021, .height = 509, .tileWidth = 64, .tileHeight = 64},
    {.width = 1, .height = 3000, .tileWidth = 1, .tileHeight = 64},
    {.width = 777, .height = 1, .tileWidth = 32, .tileHeight = 1},
    {.width = 512, .height = 512, .tileWidth = 128, .tileHeight = 128},
    {.width = 100, .height = 60, .tileWidth = 128, .tileHeight = 128},
};
#define SHAPE_COUNT (sizeof shapes / sizeof *shapes)

/* Packed levels as usual, none of them (every level cut into tiles), or nothing else. */
static SluiceStreamedTextureDesc shape(size_t index, uint32_t kind)
{
    const SluiceStreamedTextureDesc *s = &shapes[index];
    SluiceStreamedTextureDesc desc = full_chain(s->width, s->height, s->tileWidth, s->tileHeight);
    if (kind == 1) {
        desc.regularMipCount = desc.mipLevelCount;
        desc.packedTileCount = 0;
    } else if (kind == 2) {
        desc.regularMipCount = 0;
        desc.packedTileCount = 3;
    }
    return desc;
}

static void everything_mapped_reaches_level_zero_everywhere(void **state)
{
    (void)state;
    for (size_t i = 0; i < SHAPE_COUNT; i++) {
        for (uint32_t kind = 0; kind < 3; kind++) {
            struct fixture f;
            fixture_open(&f, 64, false);
            SluiceStreamedTextureDesc desc = shape(i, kind);
            SluiceTextureId id = fixture_add(&f, &desc);
            fixture_feed(&f, id, 0, 0, 0);
            fixture_load(&f);
            SluiceStreamedTextureLayout layout = fixture_layout(&f, id);
            for (uint32_t t = 0; t < layout.tileCount; t++) /* and no tile is out of reach */
                CHECK_STATE(&f, id, t, MAPPED);
            uint8_t *map = read_minmip(&f, id);
            for (uint32_t t = 0; t < layout.minMipWidth * layout.minMipHeight; t++)
                assert_int_equal(map[t], 0);
            free(map);
            fixture_close(&f);
        }
    }
}

static void the_map_follows_random_residency(void **state)
{
    (void)state;
    for (size_t i = 0; i < SHAPE_COUNT; i++) {
        for (uint32_t kind = 0; kind < 3; kind++) {
            struct fixture f;
            fixture_open(&f, 8, false);
            SluiceStreamedTextureDesc desc = shape(i, kind);
            SluiceTextureId id = fixture_add(&f, &desc);
            SluiceStreamedTextureLayout layout = fixture_layout(&f, id);
            size_t size = (size_t)layout.minMipWidth * layout.minMipHeight;
            uint8_t map[600], *copy = malloc(size);
            assert_non_null(copy);
            assert_true(layout.feedbackWidth * layout.feedbackHeight <= sizeof map);
            memset(copy, 77, size);
            uint64_t random = i * 3 + kind;
            for (uint64_t t = 0; t < 25; t++) {
                fixture_configure(&f, next_random(&random) % 30, 0, 0, 3);
                for (size_t r = 0; r < sizeof map; r++)
                    map[r] =
                        next_random(&random) % 12 ? SLUICE_MIP_UNTOUCHED : next_random(&random) % 6;
                fixture_feed_map(&f, id, map, t, 4);
                CHECK_OK(fixture_to_unmap(&f, id, 0));
                assert_true(fixture_to_map(&f, id) >= 0);
                for (uint32_t n = 0; n < f.count; n++) {
                    uint32_t tile = f.tiles[n].tileIndex;
                    if (next_random(&random) % 4)
                        CHECK_OK(sluiceUpdateTilesMapping(f.manager, id, 1, &tile));
                    else
                        CHECK_OK(sluiceReportFailedTiles(f.manager, id, 1, &tile, t));
                }
                check_minmip(&f, id);
                update_copy(&f, id, copy);
            }
            free(copy);
            fixture_close(&f);
        }
    }
}

static void check_small(const struct fixture *f, SluiceTextureId id, uint8_t a, uint8_t b,
                        uint8_t c, uint8_t d)
{
    const uint8_t expected[4] = {a, b, c, d};
    uint8_t map[4];
    CHECK_OK(sluiceWriteMinMipData(f->manager, id, 2, 4, map));
    assert_memory_equal(map, expected, 4);
}

static void fine_tiles_count_only_over_resident_coarser_ones(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId id = fixture_add_small(&f);
    check_small(&f, id, 255, 255, 255, 255);
    fixture_feed(&f, id, 0, 0, 0);
    CHECK_OK(fixture_to_map(&f, id));
    static const uint32_t tiles[] = {0, 4, 5, 3};
    CHECK_OK(sluiceUpdateTilesMapping(f.manager, id, 1, &tiles[0]));
    check_small(&f, id, 255, 255, 255, 255); /* arrived before its parents */
    CHECK_OK(sluiceUpdateTilesMapping(f.manager, id, 1, &tiles[1]));
    check_small(&f, id, 255, 255, 255, 255);
    CHECK_OK(sluiceUpdateTilesMapping(f.manager, id, 1, &tiles[2]));
    check_small(&f, id, 0, 1, 1, 1);
    CHECK_OK(sluiceUpdateTilesMapping(f.manager, id, 1, &tiles[3]));
    check_small(&f, id, 0, 1, 1, 0);
    fixture_close(&f);
}

static void unmapping_shows_when_the_list_is_handed_out(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 0, 0);
    fixture_load(&f);
    const uint8_t map[4] = {1, 2, 0, 255};
    fixture_feed_map(&f, id, map, 1, 0);
    check_small(&f, id, 0, 0, 0, 0); /* listed, but not yet handed out */
    f.count = 1;
    CHECK_RESULT(sluiceGetTilesToUnmap(f.manager, id, 0, &f.count, f.tiles), SLUICE_INCOMPLETE);
    check_small(&f, id, 1, 0, 0, 0);
    CHECK_OK(fixture_to_unmap(&f, id, 0));
    check_small(&f, id, 1, 1, 0, 1);
    fixture_close(&f);
}

static void all_packed_tiles_must_be_there(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, true);
    SluiceStreamedTextureDesc desc = full_chain(256, 256, 128, 128);
    desc.packedTileCount = 3;
    SluiceTextureId id = fixture_add(&f, &desc);
    CHECK_OK(fixture_to_map(&f, id));
    for (uint32_t tile = 5; tile < 8; tile++) {
        check_small(&f, id, 255, 255, 255, 255);
        CHECK_OK(sluiceUpdateTilesMapping(f.manager, id, 1, &tile));
    }
    check_small(&f, id, 2, 2, 2, 2);
    fixture_close(&f);
}

static void pitch_and_size_are_checked(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, true);
    SluiceStreamedTextureDesc desc = full_chain(640, 384, 128, 128); /* 5 x 3 texels */
    SluiceTextureId id = fixture_add(&f, &desc);
    fixture_load(&f);
    uint8_t map[64];
    memset(map, 9, sizeof map);
    CHECK_RESULT(sluiceWriteMinMipData(f.manager, id, 4, 64, map), SLUICE_ERROR_SIZE_MISMATCH);
    CHECK_RESULT(sluiceWriteMinMipData(f.manager, id, 0, 64, map), SLUICE_ERROR_SIZE_MISMATCH);
    CHECK_RESULT(sluiceWriteMinMipData(f.manager, id, 5, 14, map), SLUICE_ERROR_SIZE_MISMATCH);
    CHECK_RESULT(sluiceWriteMinMipData(f.manager, id, 8, 20, map), SLUICE_ERROR_SIZE_MISMATCH);
    CHECK_RESULT(sluiceWriteMinMipData(f.manager, id, SIZE_MAX, 64, map),
                 SLUICE_ERROR_SIZE_MISMATCH);
    CHECK_RESULT(sluiceWriteMinMipData(f.manager, id, SIZE_MAX / 2 + 1, 64, map),
                 SLUICE_ERROR_SIZE_MISMATCH); /* twice that is 0 */
    for (uint32_t i = 0; i < sizeof map; i++)
        assert_int_equal(map[i], 9);
    CHECK_OK(sluiceWriteMinMipData(f.manager, id, 8, 21, map));
    for (uint32_t i = 0; i < sizeof map; i++) /* nothing between the rows, nothing behind */
        assert_int_equal(map[i], i < 21 && i % 8 < 5 ? desc.regularMipCount : 9);
    fixture_close(&f);
}

static void rectangles_are_checked(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, true);
    SluiceStreamedTextureDesc desc = full_chain(640, 384, 128, 128);
    SluiceTextureId id = fixture_add(&f, &desc);
    fixture_feed_region(&f, id, 7, 0, 0, 0); /* x = 2, y = 1 */
    fixture_load(&f);
    uint8_t whole[15], map[64];
    CHECK_OK(sluiceWriteMinMipData(f.manager, id, 5, 15, whole));
    assert_int_equal(whole[7], 0);
    for (uint32_t y = 0; y < 3; y++) {
        for (uint32_t x = 0; x < 5; x++) {
            SluiceMinMipRect rect = {id, x, y, 5 - x, 3 - y};
            memset(map, 9, sizeof map);
            CHECK_OK(sluiceWriteMinMipRect(f.manager, &rect, 6, 6 * (2 - y) + 5 - x, map));
            for (uint32_t i = 0; i < 18; i++) {
                bool inside = i % 6 < rect.width && i / 6 < rect.height;
                assert_int_equal(map[i], inside ? whole[(y + i / 6) * 5 + x + i % 6] : 9);
            }
            CHECK_RESULT(sluiceWriteMinMipRect(f.manager, &rect, 6, 6 * (2 - y) + 4 - x, map),
                         SLUICE_ERROR_SIZE_MISMATCH);
            CHECK_RESULT(sluiceWriteMinMipRect(f.manager, &rect, 4 - x, 64, map),
                         SLUICE_ERROR_SIZE_MISMATCH);
        }
    }
    const SluiceMinMipRect beyond[] = {{id, 0, 0, 6, 1},          {id, 0, 0, 1, 4},
                                       {id, 5, 0, 1, 1},          {id, 0, 3, 1, 1},
                                       {id, UINT32_MAX, 0, 2, 1}, {id, 0, UINT32_MAX, 1, 2},
                                       {id, 1, 1, UINT32_MAX, 1}};
    for (uint32_t i = 0; i < sizeof beyond / sizeof *beyond; i++)
        assert_true(sluiceWriteMinMipRect(f.manager, &beyond[i], 6, 64, map) < 0);
    fixture_close(&f);
}

static void each_changed_texture_is_listed_once_in_the_order_of_change(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId a = fixture_add_small(&f), b = fixture_add_small(&f);
    SluiceMinMipRect rects[4];
    uint32_t count = 0;
    CHECK_OK(sluiceGetMinMipUpdates(f.manager, &count, NULL));
    assert_int_equal(count, 2); /* new ones are listed whole */
    count = 1;
    CHECK_RESULT(sluiceGetMinMipUpdates(f.manager, &count, rects), SLUICE_INCOMPLETE);
    assert_true(count == 1 && rects[0].textureId == a);
    assert_true(rects[0].x + rects[0].y == 0 && rects[0].width == 2 && rects[0].height == 2);
    count = 4;
    CHECK_OK(sluiceGetMinMipUpdates(f.manager, &count, rects));
    assert_true(count == 1 && rects[0].textureId == b);
    fixture_feed(&f, b, 2, 0, 0);
    fixture_load(&f);
    fixture_feed_region(&f, a, 3, 0, 0, 0);
    fixture_load(&f);
    count = 4;
    CHECK_OK(sluiceGetMinMipUpdates(f.manager, &count, rects));
    assert_true(count == 2 && rects[0].textureId == b && rects[1].textureId == a);
    count = 4;
    CHECK_OK(sluiceGetMinMipUpdates(f.manager, &count, rects));
    assert_int_equal(count, 0);
    fixture_close(&f);
}

/* Texel by texel: the least level of all regions that have a texel of the tile. */
static uint8_t expected_request(const SluiceStreamedTextureLayout *layout, const uint8_t *map,
                                uint32_t x, uint32_t y)
{
    const SluiceStreamedTextureDesc *d = &layout->desc;
    uint8_t least = SLUICE_MIP_UNTOUCHED;
    for (uint32_t v = y * d->tileHeight; v < (y + 1) * d->tileHeight && v < d->height; v++)
        for (uint32_t u = x * d->tileWidth; u < (x + 1) * d->tileWidth && u < d->width; u++) {
            uint32_t region =
                v / d->feedbackRegionHeight * layout->feedbackWidth + u / d->feedbackRegionWidth;
            least = map[region] < least ? map[region] : least;
        }
    if (least == SLUICE_MIP_UNTOUCHED)
        return least;
    return least < d->mipLevelCount ? least : (uint8_t)(d->mipLevelCount - 1);
}

static void requested_levels_are_what_is_wanted(void **state)
{
    (void)state;
    const uint32_t regions[] = {128, 64, 200, 512};
    uint64_t random = 11;
    for (uint32_t k = 0; k < 4; k++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        SluiceStreamedTextureDesc desc = full_chain(700, 450, 128, 128);
        desc.feedbackRegionWidth = desc.feedbackRegionHeight = regions[k];
        SluiceTextureId id = fixture_add(&f, &desc);
        SluiceStreamedTextureLayout layout = fixture_layout(&f, id);
        uint8_t map[128], levels[64];
        const uint32_t width = layout.minMipWidth, height = layout.minMipHeight;
        CHECK_OK(sluiceWriteRequestedLevels(f.manager, id, width, sizeof levels, levels));
        assert_int_equal(levels[0], SLUICE_MIP_UNTOUCHED);
        for (uint32_t i = 0; i < sizeof map; i++)
            map[i] = next_random(&random) % 2 ? 255 : (uint8_t)(next_random(&random) % 12);
        fixture_feed_map(&f, id, map, 1, 0);
        memset(levels, 77, sizeof levels);
        CHECK_OK(sluiceWriteRequestedLevels(f.manager, id, width + 1,
                                            (height - 1) * (width + 1) + width, levels));
        for (uint32_t y = 0; y < height; y++) {
            for (uint32_t x = 0; x < width; x++)
                assert_int_equal(levels[y * (width + 1) + x], expected_request(&layout, map, x, y));
            assert_int_equal(levels[y * (width + 1) + width], 77);
        }
        CHECK_RESULT(sluiceWriteRequestedLevels(f.manager, id, width, width * height - 1, levels),
                     SLUICE_ERROR_SIZE_MISMATCH);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_mapped_reaches_level_zero_everywhere),
        cmocka_unit_test(the_map_follows_random_residency),
        cmocka_unit_test(fine_tiles_count_only_over_resident_coarser_ones),
        cmocka_unit_test(unmapping_shows_when_the_list_is_handed_out),
        cmocka_unit_test(all_packed_tiles_must_be_there),
        cmocka_unit_test(pitch_and_size_are_checked),
        cmocka_unit_test(rectangles_are_checked),
        cmocka_unit_test(each_changed_texture_is_listed_once_in_the_order_of_change),
        cmocka_unit_test(requested_levels_are_what_is_wanted),
    };
    return RUN_TESTS(tests);
}
