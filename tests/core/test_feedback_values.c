#include "core/fixture.h"

#include <stdlib.h>
#include <string.h>

/* The level that a texel of the map asks for, in integers too wide to overflow. */
static int64_t wanted_level(const SluiceStreamedTextureDesc *desc, uint8_t value, int32_t bias,
                            uint32_t streamed)
{
    int64_t last = (int64_t)desc->mipLevelCount - 1, regular = desc->regularMipCount;
    int64_t finest = streamed && streamed < regular ? regular - streamed : 0;
    int64_t level = (value < last ? value : last) + (int64_t)bias;
    level = level < finest ? finest : level;
    level = level > last ? last : level;
    return level < regular ? level : regular;
}

static void check_only_from(const struct fixture *f, SluiceTextureId id, int64_t finest)
{
    SluiceStreamedTextureLayout layout = fixture_layout(f, id);
    for (uint32_t i = 0; i < layout.tileCount; i++) {
        bool wanted = (int64_t)fixture_tile(f, id, i).mipLevel >= finest;
        assert_int_equal(fixture_state(f, id, i),
                         wanted ? SLUICE_TILE_STATE_REQUESTED : SLUICE_TILE_STATE_FREE);
    }
}

static void every_value_bias_and_limit_is_clamped_to_the_chain(void **state)
{
    (void)state;
    static const int32_t biases[] = {INT32_MIN,
                                     INT32_MIN + 1,
                                     -256,
                                     -255,
                                     -9,
                                     -8,
                                     -2,
                                     -1,
                                     0,
                                     1,
                                     2,
                                     7,
                                     8,
                                     9,
                                     255,
                                     256,
                                     INT32_MAX - 255,
                                     INT32_MAX - 8,
                                     INT32_MAX - 1,
                                     INT32_MAX};
    static const uint32_t limits[] = {0, 1, 2, 3, 8, 9, 10, 255, UINT32_MAX};
    static const uint32_t regulars[] = {0, 1, 2, 3, 9};
    for (uint32_t r = 0; r < 5; r++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        SluiceStreamedTextureDesc desc = full_chain(256, 128, 128, 128);
        desc.regularMipCount = regulars[r];
        desc.packedTileCount = regulars[r] < desc.mipLevelCount ? 2 : 0;
        SluiceTextureId id = fixture_add(&f, &desc);
        for (uint32_t b = 0; b < sizeof biases / sizeof *biases; b++) {
            for (uint32_t l = 0; l < sizeof limits / sizeof *limits; l++) {
                for (uint32_t value = 0; value < 255; value++) {
                    const uint8_t map[2] = {(uint8_t)value, (uint8_t)value};
                    SluiceFeedbackDesc feedback = {sizeof feedback, map,      2, 1,
                                                   biases[b],       limits[l]};
                    CHECK_OK(sluiceUpdateWithSamplerFeedback(f.manager, id, &feedback, 0, 0));
                    check_only_from(&f, id,
                                    wanted_level(&desc, (uint8_t)value, biases[b], limits[l]));
                }
            }
        }
        fixture_close(&f);
    }
}

static void untouched_asks_for_nothing_whatever_the_bias(void **state)
{
    (void)state;
    static const int32_t biases[] = {INT32_MIN, -255, 0, 1, INT32_MAX};
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId id = fixture_add_small(&f);
    const uint8_t map[4] = {255, 255, 255, 255};
    for (uint32_t b = 0; b < 5; b++) {
        for (uint32_t limit = 0; limit < 4; limit++) {
            fixture_feed(&f, id, 0, 0, 0);
            SluiceFeedbackDesc feedback = {sizeof feedback, map, 2, 2, biases[b], limit};
            CHECK_OK(sluiceUpdateWithSamplerFeedback(f.manager, id, &feedback, 0, 0));
            check_only_from(&f, id, 99);
        }
    }
    fixture_close(&f);
}

static void maps_of_another_size_are_refused(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceStreamedTextureDesc desc = full_chain(384, 256, 128, 128);
    SluiceTextureId id = fixture_add(&f, &desc);
    const uint8_t map[16] = {0};
    static const uint32_t sizes[][2] = {{2, 3}, {3, 1}, {3, 3}, {2, 2},
                                        {4, 2}, {0, 0}, {6, 1}, {UINT32_MAX, 2}};
    for (uint32_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        SluiceFeedbackDesc feedback = {sizeof feedback, map, sizes[i][0], sizes[i][1], 0, 0};
        CHECK_RESULT(sluiceUpdateWithSamplerFeedback(f.manager, id, &feedback, 9, 0),
                     SLUICE_ERROR_SIZE_MISMATCH);
        check_only_from(&f, id, 99);
    }
    fixture_feed(&f, id, 0, 1, 0); /* the time of the refused was not taken over */
    check_only_from(&f, id, 0);
    fixture_close(&f);
}

static void the_map_is_not_kept(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId id = fixture_add_small(&f), follower = fixture_add_small(&f);
    uint8_t *map = malloc(4); /* gone before it could be read again: a sanitizer would see it */
    assert_non_null(map);
    memset(map, 1, 4);
    fixture_feed_map(&f, id, map, 0, 10);
    memset(map, 0, 4);
    free(map);
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, id, follower, 1, 10));
    check_only_from(&f, follower, 1);
    fixture_feed(&f, id, SLUICE_MIP_UNTOUCHED, 2, 10);
    check_only_from(&f, id, 1);
    fixture_close(&f);
}

/* Marks every tile that a region wants, texel by texel, and its parents. */
static void mark_region(const SluiceStreamedTextureLayout *layout, uint32_t region, uint32_t level,
                        bool *wanted)
{
    const SluiceStreamedTextureDesc *d = &layout->desc;
    uint32_t x0 = region % layout->feedbackWidth * d->feedbackRegionWidth;
    uint32_t y0 = region / layout->feedbackWidth * d->feedbackRegionHeight;
    for (uint32_t py = y0; py < y0 + d->feedbackRegionHeight && py < d->height; py++) {
        for (uint32_t px = x0; px < x0 + d->feedbackRegionWidth && px < d->width; px++) {
            uint32_t x = (px >> level) / d->tileWidth, y = (py >> level) / d->tileHeight;
            for (uint32_t l = level; l < d->regularMipCount; l++, x /= 2, y /= 2) {
                uint32_t w = layout->levelWidthInTiles[l], h = layout->levelHeightInTiles[l];
                x = x < w ? x : w - 1;
                y = y < h ? y : h - 1;
                wanted[layout->levelFirstTile[l] + y * w + x] = true;
            }
        }
    }
}

static void a_region_wants_the_tiles_under_each_of_its_texels(void **state)
{
    (void)state;
    static const SluiceStreamedTextureDesc shapes[] = {
        {.width = 257, .height = 129, .tileWidth = 32, .tileHeight = 16},
        {.width = 130,
         .height = 67,
         .tileWidth = 8,
         .tileHeight = 8,
         .feedbackRegionWidth = 3,
         .feedbackRegionHeight = 5},
        {.width = 130,
         .height = 67,
         .tileWidth = 8,
         .tileHeight = 8,
         .feedbackRegionWidth = 50,
         .feedbackRegionHeight = 31},
        {.width = 101,
         .height = 103,
         .tileWidth = 7,
         .tileHeight = 13,
         .feedbackRegionWidth = 11,
         .feedbackRegionHeight = 4},
        {.width = 1, .height = 1000, .tileWidth = 4, .tileHeight = 16},
        {.width = 97, .height = 1, .tileWidth = 8, .tileHeight = 8},
    };
    uint64_t random = 2;
    for (uint32_t i = 0; i < 2 * sizeof shapes / sizeof *shapes; i++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        const SluiceStreamedTextureDesc *s = &shapes[i / 2];
        SluiceStreamedTextureDesc desc =
            full_chain(s->width, s->height, s->tileWidth, s->tileHeight);
        desc.feedbackRegionWidth = s->feedbackRegionWidth;
        desc.feedbackRegionHeight = s->feedbackRegionHeight;
        if (i % 2) { /* levels smaller than a tile are cut too */
            desc.regularMipCount = desc.mipLevelCount;
            desc.packedTileCount = 0;
        }
        SluiceTextureId id = fixture_add(&f, &desc);
        SluiceStreamedTextureLayout layout = fixture_layout(&f, id);
        uint32_t regions = layout.feedbackWidth * layout.feedbackHeight;
        uint8_t *map = malloc(regions);
        bool *wanted = malloc(layout.tileCount * sizeof *wanted);
        assert_true(map && wanted);
        for (uint32_t round = 0; round < 10; round++) {
            memset(wanted, 0, layout.tileCount * sizeof *wanted);
            for (uint32_t r = 0; r < regions; r++) {
                map[r] = next_random(&random) % 4 ? SLUICE_MIP_UNTOUCHED : next_random(&random) % 6;
                if (map[r] == SLUICE_MIP_UNTOUCHED)
                    continue;
                uint32_t level = map[r] < desc.mipLevelCount ? map[r] : desc.mipLevelCount - 1;
                if (level < desc.regularMipCount)
                    mark_region(&layout, r, level, wanted);
                for (uint32_t t = layout.regularTileCount; t < layout.tileCount; t++)
                    wanted[t] = true;
            }
            fixture_feed_map(&f, id, map, round, 0);
            for (uint32_t t = 0; t < layout.tileCount; t++)
                assert_int_equal(fixture_state(&f, id, t),
                                 wanted[t] ? SLUICE_TILE_STATE_REQUESTED : SLUICE_TILE_STATE_FREE);
        }
        free(map);
        free(wanted);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_value_bias_and_limit_is_clamped_to_the_chain),
        cmocka_unit_test(untouched_asks_for_nothing_whatever_the_bias),
        cmocka_unit_test(maps_of_another_size_are_refused),
        cmocka_unit_test(the_map_is_not_kept),
        cmocka_unit_test(a_region_wants_the_tiles_under_each_of_its_texels),
    };
    return RUN_TESTS(tests);
}
