/** Compares the required tiles of frames with the requests of a manager that gets all feedback. */
#include "support/test.h"

#include "demand/random.h"
#include "needs_rig.h"

#include <stdlib.h>
#include <string.h>

#define FRAMES 40

/* Even, wide, not evenly halving, of one packed tile, and without packed levels. */
static const SluiceStreamedTextureDesc descs[] = {
    {1024, 1024, 11, 4, 1, 128, 128, 0, 0}, {2048, 512, 12, 3, 2, 128, 128, 0, 0},
    {1000, 700, 10, 3, 1, 128, 64, 0, 0},   {1025, 517, 11, 2, 1, 128, 128, 0, 0},
    {100, 60, 7, 0, 1, 128, 128, 0, 0},     {512, 512, 3, 3, 0, 128, 128, 0, 0},
};
#define TEXTURES (sizeof descs / sizeof *descs)

/* Marks a few rectangles of one level each, and single regions of any level, packed ones
 * included. */
static void draw(struct needs_rig *rig, uint32_t texture, uint64_t *seed)
{
    const SluiceStreamedTextureLayout *layout = &rig->needs.textures[texture].layout;
    uint32_t *words = needs_rig_feedback(rig, texture);
    uint32_t width = layout->feedbackWidth, height = layout->feedbackHeight;
    for (uint32_t i = 0; i < width * height; i++)
        words[i] = SLUICE_MIP_UNTOUCHED;
    if (random_below(seed, 4) == 0)
        return;
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t level = random_below(seed, layout->desc.mipLevelCount);
        uint32_t x0 = random_below(seed, width), x1 = x0 + random_below(seed, width - x0) / 2;
        uint32_t y0 = random_below(seed, height), y1 = y0 + random_below(seed, height - y0) / 2;
        for (uint32_t y = y0; y <= y1; y++)
            for (uint32_t x = x0; x <= x1; x++)
                if (level < words[y * width + x])
                    words[y * width + x] = level;
    }
}

static void feed(struct needs_rig *rig, SluiceStreamedTextureManager *manager,
                 const SluiceTextureId *ids, uint64_t time, uint64_t timeout)
{
    for (uint32_t i = 0; i < rig->count; i++) {
        const SluiceStreamedTextureLayout *layout = &rig->needs.textures[i].layout;
        uint32_t count = layout->feedbackWidth * layout->feedbackHeight;
        uint8_t *map = malloc(count);
        assert_non_null(map);
        for (uint32_t r = 0; r < count; r++)
            map[r] = (uint8_t)needs_rig_feedback(rig, i)[r];
        SluiceFeedbackDesc feedback = {.structSize = sizeof feedback,
                                       .pMinMip = map,
                                       .width = layout->feedbackWidth,
                                       .height = layout->feedbackHeight};
        CHECK_OK(sluiceUpdateWithSamplerFeedback(manager, ids[i], &feedback, time, timeout));
        free(map);
    }
}

static bool is_wanted(SluiceStreamedTextureManager *manager, SluiceTextureId id, uint32_t tile)
{
    SluiceTileState state;
    CHECK_OK(sluiceGetTileState(manager, id, tile, &state, NULL));
    return state != SLUICE_TILE_STATE_FREE;
}

static void frames_need_what_a_manager_requests(void **state)
{
    (void)state;
    struct needs_rig rig;
    uint64_t seed = 7;
    needs_rig_open(&rig, descs, TEXTURES);
    for (uint64_t frame = 1; frame <= FRAMES; frame++) {
        SluiceTextureId ids[TEXTURES];
        SluiceStreamedTextureManager *manager = needs_rig_manager(&rig, ids);
        for (uint32_t i = 0; i < TEXTURES; i++)
            draw(&rig, i, &seed);
        feed(&rig, manager, ids, frame, 1);
        uint32_t needed = needs_rig_frame(&rig).needed_tiles, wanted = 0;
        for (uint32_t i = 0; i < TEXTURES; i++)
            for (uint32_t tile = 0; tile < rig.needs.textures[i].layout.tileCount; tile++) {
                bool is = is_wanted(manager, ids[i], tile);
                wanted += is;
                assert_int_equal(rig.needs.textures[i].tile_frames[tile] == frame, is);
            }
        assert_int_equal(needed, wanted);
        sluiceDestroyStreamedTextureManager(manager);
    }
    needs_rig_close(&rig);
}

static void a_run_needs_what_a_manager_requests_that_forgets_nothing(void **state)
{
    (void)state;
    struct needs_rig rig;
    uint64_t seed = 11, wanted = 0;
    needs_rig_open(&rig, descs, TEXTURES);
    for (uint64_t frame = 1; frame <= FRAMES / 4; frame++) {
        for (uint32_t i = 0; i < TEXTURES; i++)
            draw(&rig, i, &seed);
        feed(&rig, rig.manager, rig.ids, frame, 1000000);
        needs_rig_frame(&rig);
        wanted = 0;
        for (uint32_t i = 0; i < TEXTURES; i++)
            for (uint32_t tile = 0; tile < rig.needs.textures[i].layout.tileCount; tile++)
                wanted += is_wanted(rig.manager, rig.ids[i], tile);
        assert_int_equal(rig.needs.needed_tiles, wanted);
    }
    assert_true(wanted > 50);
    needs_rig_close(&rig);
}

static void textures_that_no_region_needs_are_never_sampled(void **state)
{
    (void)state;
    struct needs_rig rig;
    needs_rig_open(&rig, descs, TEXTURES);
    needs_rig_frame(&rig);
    assert_int_equal(needs_count_never_sampled(&rig.needs), TEXTURES);
    needs_rig_feedback(&rig, 4)[0] = 6;
    assert_int_equal(needs_rig_frame(&rig).needed_tiles, 1);
    needs_rig_feedback(&rig, 4)[0] = SLUICE_MIP_UNTOUCHED;
    needs_rig_frame(&rig);
    assert_int_equal(needs_count_never_sampled(&rig.needs), TEXTURES - 1);
    assert_int_equal(rig.needs.needed_tiles, 1);
    needs_rig_close(&rig);
}

static void regions_are_missing_until_their_level_is_shown_whole(void **state)
{
    (void)state;
    struct needs_rig rig;
    needs_rig_open(&rig, descs, 1);
    uint32_t *words = needs_rig_feedback(&rig, 0), *shown = needs_rig_min_mip(&rig, 0);
    words[0] = 2;
    words[9] = 0;
    words[20] = 9; /* packed: level 4 shows it */
    assert_int_equal(needs_rig_frame(&rig).missing_regions, 3);
    shown[20] = 0xFFFF0000u | (4 * SLUICE_SHOWN_STEPS + SLUICE_SHOWN_MARGIN);
    shown[0] = 2 * SLUICE_SHOWN_STEPS + SLUICE_SHOWN_MARGIN + 1; /* still loading */
    shown[9] = 1;
    assert_int_equal(needs_rig_frame(&rig).missing_regions, 2);
    shown[0] = 2 * SLUICE_SHOWN_STEPS + SLUICE_SHOWN_MARGIN;
    assert_int_equal(needs_rig_frame(&rig).missing_regions, 1);
    shown[9] = 0;
    assert_int_equal(needs_rig_frame(&rig).missing_regions, 0);
    needs_rig_close(&rig);
}

static void tiles_are_loaded_once_they_are_mapped(void **state)
{
    (void)state;
    struct needs_rig rig;
    SluiceTile tiles[16];
    uint32_t count = 16;
    needs_rig_open(&rig, descs, 1);
    needs_rig_feedback(&rig, 0)[0] = 2;
    needs_rig_frame(&rig);
    feed(&rig, rig.manager, rig.ids, 1, 1);
    needs_add_loaded(&rig.needs, rig.manager);
    assert_int_equal(needs_count_tiles(&rig.needs, true, true), 0);
    assert_int_equal(needs_count_tiles(&rig.needs, false, true), 3);
    CHECK_OK(sluiceGetTilesToMap(rig.manager, rig.ids[0], &count, tiles));
    assert_int_equal(count, 3);
    CHECK_OK(sluiceUpdateTilesMapping(rig.manager, rig.ids[0], 1, &tiles[0].tileIndex));
    needs_add_loaded(&rig.needs, rig.manager);
    assert_int_equal(needs_count_tiles(&rig.needs, true, true), 1);
    assert_int_equal(needs_count_tiles(&rig.needs, false, true), 2);
    assert_int_equal(needs_count_tiles(&rig.needs, true, false), 0);
    needs_rig_close(&rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_need_what_a_manager_requests),
        cmocka_unit_test(a_run_needs_what_a_manager_requests_that_forgets_nothing),
        cmocka_unit_test(textures_that_no_region_needs_are_never_sampled),
        cmocka_unit_test(regions_are_missing_until_their_level_is_shown_whole),
        cmocka_unit_test(tiles_are_loaded_once_they_are_mapped),
    };
    return RUN_TESTS(tests);
}
