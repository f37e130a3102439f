#include "core/fixture.h"

#include <string.h>

static void check_refused(SluiceStreamedTextureDesc desc, SluiceResult expected)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout},
                                before = {.structSize = sizeof before};
    memset(&layout, 0x5A, sizeof layout);
    memcpy(&before, &layout, sizeof layout);
    CHECK_RESULT(sluiceGetStreamedTextureLayout(&desc, &layout), expected);
    assert_memory_equal(&layout, &before, sizeof layout);

    struct fixture f;
    fixture_open(&f, 16, true);
    SluiceTextureId other = fixture_add_small(&f), id = 77;
    uint64_t digest = fixture_digest(&f, 1, &other);
    uint64_t bytes = f.memory.live_bytes;
    CHECK_RESULT(sluiceAddStreamedTexture(f.manager, &desc, &id), expected);
    assert_true(fixture_digest(&f, 1, &other) == digest);
    assert_int_equal(f.memory.live_bytes, bytes);
    fixture_close(&f);
}

static void sizes_of_zero_have_no_tiles(void **state)
{
    (void)state;
    SluiceStreamedTextureDesc desc = small_texture();
    desc.width = 0;
    check_refused(desc, SLUICE_ERROR_ZERO_TILES);
    desc = small_texture();
    desc.height = 0;
    check_refused(desc, SLUICE_ERROR_ZERO_TILES);
    desc = small_texture();
    desc.tileWidth = 0;
    check_refused(desc, SLUICE_ERROR_ZERO_TILES);
    desc = small_texture();
    desc.tileHeight = 0;
    check_refused(desc, SLUICE_ERROR_ZERO_TILES);
    desc = small_texture();
    desc.mipLevelCount = desc.regularMipCount = desc.packedTileCount = 0;
    check_refused(desc, SLUICE_ERROR_ZERO_TILES);
}

static void packed_counts_must_agree_with_the_levels(void **state)
{
    (void)state;
    SluiceStreamedTextureDesc desc = small_texture();
    desc.packedTileCount = 0; /* packed levels in no tile */
    check_refused(desc, SLUICE_ERROR_INVALID_PACKED_MIPS);
    desc = small_texture();
    desc.regularMipCount = desc.mipLevelCount; /* a packed tile of no level */
    check_refused(desc, SLUICE_ERROR_INVALID_PACKED_MIPS);
    desc.packedTileCount = 0;
    desc.regularMipCount = desc.mipLevelCount + 1;
    check_refused(desc, SLUICE_ERROR_INVALID_PACKED_MIPS);
    desc.regularMipCount = UINT32_MAX;
    check_refused(desc, SLUICE_ERROR_INVALID_PACKED_MIPS);
}

static void sizes_and_levels_out_of_range_are_invalid(void **state)
{
    (void)state;
    SluiceStreamedTextureDesc desc = full_chain(SLUICE_MAX_TEXTURE_SIZE, 1, 256, 256);
    desc.width++;
    check_refused(desc, SLUICE_ERROR_INVALID_ARGUMENT);
    desc = full_chain(1, SLUICE_MAX_TEXTURE_SIZE, 256, 256);
    desc.height = UINT32_MAX;
    check_refused(desc, SLUICE_ERROR_INVALID_ARGUMENT);
    desc = small_texture();
    desc.mipLevelCount = 10; /* 256 texels have 9 */
    check_refused(desc, SLUICE_ERROR_INVALID_ARGUMENT);
    desc.mipLevelCount = UINT32_MAX;
    check_refused(desc, SLUICE_ERROR_INVALID_ARGUMENT);
}

static void more_tiles_or_regions_than_an_index_counts_are_refused(void **state)
{
    (void)state;
    SluiceStreamedTextureDesc desc = {.width = 1u << 20,
                                      .height = 1u << 20,
                                      .mipLevelCount = 1,
                                      .regularMipCount = 1,
                                      .tileWidth = 32,
                                      .tileHeight = 32}; /* exactly 2^30 tiles */
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    CHECK_OK(sluiceGetStreamedTextureLayout(&desc, &layout));
    assert_int_equal(layout.tileCount, 1u << 30);
    SluiceStreamedTextureDesc more = desc;
    more.mipLevelCount = 2;
    more.packedTileCount = 1;
    check_refused(more, SLUICE_ERROR_LIMIT_EXCEEDED);
    more.packedTileCount = UINT32_MAX; /* the sum wraps in 32 bits */
    check_refused(more, SLUICE_ERROR_LIMIT_EXCEEDED);
    more = desc;
    more.tileWidth = more.tileHeight = 1; /* 2^40, 0 in 32 bits */
    check_refused(more, SLUICE_ERROR_LIMIT_EXCEEDED);
    more = desc;
    more.feedbackRegionWidth = 31;
    more.feedbackRegionHeight = 32;
    check_refused(more, SLUICE_ERROR_LIMIT_EXCEEDED);
    more.feedbackRegionWidth = more.feedbackRegionHeight = 1;
    check_refused(more, SLUICE_ERROR_LIMIT_EXCEEDED);
}

/* Halving and counting by steps, as one would on paper. */
static uint32_t count_steps(uint32_t size, uint32_t step)
{
    uint32_t count = 0;
    for (uint64_t begin = 0; begin < size; begin += step)
        count++;
    return count;
}

static void check_layout(SluiceStreamedTextureDesc desc)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    CHECK_OK(sluiceGetStreamedTextureLayout(&desc, &layout));
    uint32_t width = desc.width, height = desc.height, first = 0;
    for (uint32_t l = 0; l < desc.regularMipCount; l++) {
        uint32_t x = count_steps(width, desc.tileWidth), y = count_steps(height, desc.tileHeight);
        assert_int_equal(layout.levelWidthInTiles[l], x);
        assert_int_equal(layout.levelHeightInTiles[l], y);
        assert_int_equal(layout.levelFirstTile[l], first);
        first += x * y;
        width = width > 1 ? width / 2 : 1;
        height = height > 1 ? height / 2 : 1;
    }
    assert_int_equal(layout.regularTileCount, first);
    assert_int_equal(layout.tileCount, first + desc.packedTileCount);
    uint32_t rw = desc.feedbackRegionWidth ? desc.feedbackRegionWidth : desc.tileWidth;
    uint32_t rh = desc.feedbackRegionHeight ? desc.feedbackRegionHeight : desc.tileHeight;
    assert_int_equal(layout.desc.feedbackRegionWidth, rw);
    assert_int_equal(layout.desc.feedbackRegionHeight, rh);
    assert_int_equal(layout.feedbackWidth, count_steps(desc.width, rw));
    assert_int_equal(layout.feedbackHeight, count_steps(desc.height, rh));
    bool regular = desc.regularMipCount > 0;
    assert_int_equal(layout.minMipWidth, regular ? layout.levelWidthInTiles[0] : 1);
    assert_int_equal(layout.minMipHeight, regular ? layout.levelHeightInTiles[0] : 1);
}

static void grids_are_exact_for_awkward_sizes(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {1,     2,     3,     5,     127,     128,     129,
                                     255,   257,   1021,  1023,  1025,    2052,    4100,
                                     16384, 32749, 32768, 65537, 1048573, 1048575, 1048576};
    static const uint32_t shapes[][2] = {{256, 256}, {256, 128}, {128, 128},  {128, 64},
                                         {512, 256}, {7, 1000},  {3, 1048576}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        for (size_t j = 0; j < sizeof sizes / sizeof *sizes; j++) {
            for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
                SluiceStreamedTextureDesc desc =
                    full_chain(sizes[i], sizes[j], shapes[k][0], shapes[k][1]);
                check_layout(desc);
                desc.regularMipCount = desc.mipLevelCount; /* all cut into tiles */
                desc.packedTileCount = 0;
                check_layout(desc);
            }
        }
    }
}

static void two_to_the_twenty_squared_has_its_exact_tiles(void **state)
{
    (void)state;
    SluiceStreamedTextureDesc desc = full_chain(1u << 20, 1u << 20, 256, 256);
    check_layout(desc);
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    CHECK_OK(sluiceGetStreamedTextureLayout(&desc, &layout));
    /* 4096^2 + 2048^2 + ... + 1 = (4^13 - 1) / 3, and the packed tile */
    assert_int_equal(layout.regularTileCount, ((1u << 26) - 1) / 3);
    assert_int_equal(layout.tileCount, ((1u << 26) - 1) / 3 + 1);
}

static void one_texel_may_be_regular_or_packed(void **state)
{
    (void)state;
    SluiceStreamedTextureDesc desc = {.width = 1,
                                      .height = 1,
                                      .mipLevelCount = 1,
                                      .regularMipCount = 1,
                                      .tileWidth = 128,
                                      .tileHeight = 128};
    check_layout(desc);
    desc.regularMipCount = 0;
    desc.packedTileCount = 3;
    check_layout(desc);
    desc.tileWidth = desc.tileHeight = UINT32_MAX;
    desc.feedbackRegionWidth = desc.feedbackRegionHeight = UINT32_MAX;
    check_layout(desc);
}

static void regions_need_not_match_the_tiles(void **state)
{
    (void)state;
    static const uint32_t regions[][2] = {{1, 0}, {0, 1}, {3, 5}, {128, 256}, {1000, 1}, {4096, 9}};
    for (size_t i = 0; i < sizeof regions / sizeof *regions; i++) {
        SluiceStreamedTextureDesc desc = full_chain(1025, 513, 128, 64);
        desc.feedbackRegionWidth = regions[i][0];
        desc.feedbackRegionHeight = regions[i][1];
        check_layout(desc);
    }
}

static void a_texture_has_the_layout_of_its_description(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceStreamedTextureDesc desc = full_chain(1025, 2052, 128, 64);
    SluiceTextureId id = fixture_add(&f, &desc);
    SluiceStreamedTextureLayout expected = {.structSize = sizeof expected},
                                layout = fixture_layout(&f, id);
    CHECK_OK(sluiceGetStreamedTextureLayout(&desc, &expected));
    assert_int_equal(layout.tileCount, expected.tileCount);
    assert_int_equal(layout.feedbackWidth, expected.feedbackWidth);
    assert_int_equal(layout.feedbackHeight, expected.feedbackHeight);
    assert_int_equal(layout.minMipWidth, expected.minMipWidth);
    assert_int_equal(layout.minMipHeight, expected.minMipHeight);
    uint32_t index = 0;
    for (uint32_t l = 0; l < desc.regularMipCount; l++) {
        assert_int_equal(layout.levelFirstTile[l], index);
        for (uint32_t y = 0; y < expected.levelHeightInTiles[l]; y++) {
            for (uint32_t x = 0; x < expected.levelWidthInTiles[l]; x++) {
                SluiceTile tile = fixture_tile(&f, id, index);
                assert_true(tile.textureId == id && tile.tileIndex == index++);
                assert_true(tile.mipLevel == l && tile.x == x && tile.y == y);
            }
        }
    }
    SluiceTile tile = fixture_tile(&f, id, index);
    assert_true(tile.mipLevel == desc.regularMipCount && tile.x == 0 && tile.y == 0);
    CHECK_RESULT(sluiceGetTileState(f.manager, id, layout.tileCount, NULL, NULL),
                 SLUICE_ERROR_UNKNOWN_TILE);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_of_zero_have_no_tiles),
        cmocka_unit_test(packed_counts_must_agree_with_the_levels),
        cmocka_unit_test(sizes_and_levels_out_of_range_are_invalid),
        cmocka_unit_test(more_tiles_or_regions_than_an_index_counts_are_refused),
        cmocka_unit_test(grids_are_exact_for_awkward_sizes),
        cmocka_unit_test(two_to_the_twenty_squared_has_its_exact_tiles),
        cmocka_unit_test(one_texel_may_be_regular_or_packed),
        cmocka_unit_test(regions_need_not_match_the_tiles),
        cmocka_unit_test(a_texture_has_the_layout_of_its_description),
    };
    return RUN_TESTS(tests);
}
