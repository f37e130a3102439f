#include "core/sound.h"
#include "core/wanted_tiles.h"

#include <stdlib.h>
#include <string.h>

static const uint32_t shapes[][2] = {
    {1025, 1025}, {2052, 2052}, {4100, 4100}, {4099, 4099}, {7919, 7919},
    {1025, 4099}, {7919, 1},    {1, 7919},    {4100, 1},    {1, 1025},
};
#define SHAPE_COUNT (sizeof shapes / sizeof *shapes)

/* 0: the tile's; then smaller, larger and larger than the texture, none of which divides it. */
static const uint32_t regions[][2] = {{0, 0}, {50, 37}, {389, 300}, {UINT32_MAX, 9999}};
#define REGION_KINDS (sizeof regions / sizeof *regions)

enum { LEVEL_KINDS = 2 }; /* levels smaller than a tile are packed; every level is cut */

/* Thin ones get thin tiles unless every level is cut. */
static SluiceStreamedTextureDesc shape(size_t index, uint32_t level_kind, size_t region_kind)
{
    uint32_t width = shapes[index][0], height = shapes[index][1];
    SluiceStreamedTextureDesc desc =
        full_chain(width, height, width == 1 ? 1 : 128, height == 1 ? 1 : 128);
    if (level_kind == 1) {
        desc.regularMipCount = desc.mipLevelCount;
        desc.packedTileCount = 0;
        desc.tileWidth = desc.tileHeight = 128;
    }
    desc.feedbackRegionWidth = regions[region_kind][0];
    desc.feedbackRegionHeight = regions[region_kind][1];
    return desc;
}

/* A texture, its map, and the tiles that the map should request. */
struct subject {
    struct fixture f;
    SluiceTextureId id;
    SluiceStreamedTextureLayout layout;
    uint32_t regions;
    uint8_t *map, *asked; ///< [regions], so that a sanitizer sees a step beyond
    bool *wanted;         ///< [tiles]
};

static void subject_open(struct subject *s, const SluiceStreamedTextureDesc *desc)
{
    fixture_open(&s->f, 64, false);
    s->id = fixture_add(&s->f, desc);
    s->layout = fixture_layout(&s->f, s->id);
    s->regions = s->layout.feedbackWidth * s->layout.feedbackHeight;
    assert_int_equal(s->regions, region_count(&s->layout.desc));
    s->map = malloc(s->regions);
    s->asked = malloc(s->regions);
    s->wanted = malloc(s->layout.tileCount * sizeof *s->wanted);
    assert_true(s->map && s->asked && s->wanted);
}

static void subject_close(struct subject *s)
{
    fixture_close(&s->f);
    free(s->map);
    free(s->asked);
    free(s->wanted);
}

/* Feeds the map, which replaces the last one, and compares every tile with the count by texels. */
static void check_map(struct subject *s, int32_t bias, uint32_t limit)
{
    SluiceFeedbackDesc feedback = {sizeof feedback,          s->map, s->layout.feedbackWidth,
                                   s->layout.feedbackHeight, bias,   limit};
    SOUND(&s->f, sluiceUpdateWithSamplerFeedback(s->f.manager, s->id, &feedback, 0, 0));
    asked_levels(&s->layout.desc, &feedback, s->asked);
    wanted_tiles(&s->layout.desc, s->asked, s->wanted);
    check_requested(&s->f, s->id, s->wanted, __LINE__);
}

static void everything_resident_is_mip_zero_on_every_grid(void **state)
{
    (void)state;
    for (size_t i = 0; i < SHAPE_COUNT; i++) {
        for (uint32_t kind = 0; kind < LEVEL_KINDS; kind++) {
            struct subject s;
            SluiceStreamedTextureDesc desc = shape(i, kind, kind ? 2 : 1);
            subject_open(&s, &desc);
            memset(s.map, 0, s.regions);
            fixture_feed_map(&s.f, s.id, s.map, 0, 0);
            sound_load(&s.f);
            assert_int_equal(fixture_statistics(&s.f).mappedTileCount, s.layout.tileCount);
            size_t size = (size_t)s.layout.minMipWidth * s.layout.minMipHeight;
            uint8_t *min_mip = malloc(size);
            assert_non_null(min_mip);
            SOUND(&s.f,
                  sluiceWriteMinMipData(s.f.manager, s.id, s.layout.minMipWidth, size, min_mip));
            for (size_t t = 0; t < size; t++)
                assert_int_equal(min_mip[t], 0);
            free(min_mip);
            subject_close(&s);
        }
    }
}

/* Checks the last region of each edge alone, because a parent may lie beyond the coarser grid. */
static void the_last_regions_want_parents_inside_every_grid(void **state)
{
    (void)state;
    for (size_t i = 0; i < SHAPE_COUNT * LEVEL_KINDS; i++) {
        struct subject s;
        SluiceStreamedTextureDesc desc = shape(i / LEVEL_KINDS, i % LEVEL_KINDS, 0);
        subject_open(&s, &desc);
        const uint32_t corners[] = {0, s.layout.feedbackWidth - 1,
                                    s.regions - s.layout.feedbackWidth, s.regions - 1};
        for (uint32_t c = 0; c < 4; c++) {
            for (uint32_t level = 0; level <= desc.regularMipCount; level++) {
                memset(s.map, SLUICE_MIP_UNTOUCHED, s.regions);
                s.map[corners[c]] = (uint8_t)level;
                check_map(&s, 0, 0);
            }
        }
        subject_close(&s);
    }
}

static void random_maps_want_what_a_count_by_texels_finds(void **state)
{
    (void)state;
    uint64_t random = 11;
    const size_t kinds = LEVEL_KINDS * REGION_KINDS;
    for (size_t i = 0; i < SHAPE_COUNT * kinds; i++) {
        struct subject s;
        SluiceStreamedTextureDesc desc =
            shape(i / kinds, i % LEVEL_KINDS, i / LEVEL_KINDS % REGION_KINDS);
        subject_open(&s, &desc);
        for (uint32_t round = 0; round < 4; round++) {
            /* Fill the map from nearly empty to half full. */
            uint32_t rare = 2 + s.regions / (4u << 2 * round);
            for (uint32_t r = 0; r < s.regions; r++)
                s.map[r] = next_random(&random) % rare ? SLUICE_MIP_UNTOUCHED
                                                       : (uint8_t)(next_random(&random) % 8);
            check_map(&s, 0, 0);
        }
        subject_close(&s);
    }
}

/* Uses each value in some region of some map. */
static void check_every_value(struct subject *s, int32_t bias, uint32_t limit)
{
    for (uint32_t first = 0; first < 256; first += s->regions) {
        for (uint32_t r = 0; r < s->regions; r++)
            s->map[r] = (uint8_t)(first + r);
        check_map(s, bias, limit);
    }
}

static void every_value_and_bias_is_inside_the_chain_of_every_grid(void **state)
{
    (void)state;
    static const int32_t biases[] = {INT32_MIN, -300, -1, 0, 1, 300, INT32_MAX};
    const size_t kinds = LEVEL_KINDS * REGION_KINDS;
    for (size_t i = 0; i < SHAPE_COUNT * kinds; i++) {
        struct subject s;
        SluiceStreamedTextureDesc desc =
            shape(i / kinds, i % LEVEL_KINDS, i / LEVEL_KINDS % REGION_KINDS);
        subject_open(&s, &desc);
        /* A single region of thousands of tiles would take as many maps as there are values. */
        if (s.regions >= 8 || s.layout.tileCount < 500)
            for (size_t b = 0; b < sizeof biases / sizeof *biases; b++)
                check_every_value(&s, biases[b], 0);
        subject_close(&s);
    }
}

static void the_streamed_levels_are_the_coarsest_ones_of_every_grid(void **state)
{
    (void)state;
    for (size_t i = 0; i < SHAPE_COUNT; i++) {
        struct subject s;
        SluiceStreamedTextureDesc desc = shape(i, 0, 0);
        subject_open(&s, &desc);
        const uint32_t limits[] = {0, 1, desc.regularMipCount, desc.regularMipCount + 1,
                                   UINT32_MAX};
        for (size_t l = 0; l < sizeof limits / sizeof *limits; l++) {
            memset(s.map, 0, s.regions);
            check_map(&s, INT32_MAX, limits[l]);
            check_map(&s, 1, limits[l]);
            check_map(&s, INT32_MIN, limits[l]);
            uint32_t finest = limits[l] == 1 ? desc.regularMipCount - 1 : 0;
            check_state(&s.f, s.id, s.layout.levelFirstTile[finest], SLUICE_TILE_STATE_REQUESTED,
                        __LINE__);
            if (finest)
                CHECK_STATE(&s.f, s.id, s.layout.levelFirstTile[finest] - 1, FREE);
        }
        subject_close(&s);
    }
}

static void a_map_of_another_size_changes_nothing_of_a_busy_manager(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    fixture_configure(&f, 4, 0, 2, 500);
    SluiceStreamedTextureDesc desc = full_chain(1025, 771, 128, 128);
    SluiceTextureId ids[2] = {fixture_add(&f, &desc), fixture_add(&f, &desc)};
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, ids[1], ids[0]));
    uint8_t map[256] = {0};
    sound_feed(&f, ids[0], 0, 0, 100);
    assert_true(fixture_to_map_at_most(&f, ids[0], 100) >= 0);
    for (uint32_t i = 0; i < f.count; i += 3) /* mapped, failed and still loading */
        CHECK_OK(sluiceUpdateTilesMapping(f.manager, ids[0], 1, &f.tiles[i].tileIndex));
    for (uint32_t i = 1; i < f.count; i += 3)
        CHECK_OK(sluiceReportFailedTiles(f.manager, ids[0], 1, &f.tiles[i].tileIndex, 1));
    sound_feed_region(&f, ids[0], 0, 0, 9, 100);
    assert_true(fixture_statistics(&f).failedTileCount > 0);
    SluiceStreamedTextureLayout layout = fixture_layout(&f, ids[0]);
    uint32_t w = layout.feedbackWidth, h = layout.feedbackHeight;
    const uint32_t sizes[][2] = {{w - 1, h}, {w, h - 1}, {w + 1, h}, {h, w}, {w * h, 1}, {0, 0}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        SluiceFeedbackDesc feedback = {sizeof feedback, map,       sizes[i][0],
                                       sizes[i][1],     INT32_MIN, 0};
        /* Late enough for failed loads to be due and for all wants to lapse. */
        REFUSED(&f, 2, ids, sluiceUpdateWithSamplerFeedback(f.manager, ids[0], &feedback, 1000, 0),
                SLUICE_ERROR_SIZE_MISMATCH);
    }
    sound_feed_region(&f, ids[0], 0, 0, 10, 100); /* nor was the time taken over */
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_resident_is_mip_zero_on_every_grid),
        cmocka_unit_test(the_last_regions_want_parents_inside_every_grid),
        cmocka_unit_test(random_maps_want_what_a_count_by_texels_finds),
        cmocka_unit_test(every_value_and_bias_is_inside_the_chain_of_every_grid),
        cmocka_unit_test(the_streamed_levels_are_the_coarsest_ones_of_every_grid),
        cmocka_unit_test(a_map_of_another_size_changes_nothing_of_a_busy_manager),
    };
    return RUN_TESTS(tests);
}
