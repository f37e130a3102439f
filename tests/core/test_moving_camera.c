/** A camera that moves over more than the budget holds. */
#include "core/scene.h"

enum { CAPACITY = 16, TEXTURES = 8 };

static struct scene s;

/* 8 textures of 4096 x 4096, of which 10 x 10 of 32 x 32 regions are in view, the middle sharp. */
static void open_scene(uint32_t times, uint8_t rings)
{
    scene_open(&s, CAPACITY, 1);
    s.maps_per_frame = 4;
    for (uint32_t i = 0; i < TEXTURES; i++)
        scene_add(&s, 4096, (struct scene_window){i, i, 10, 10, 0, rings});
    s.config.maxHeapCount = scene_working_set(&s) * 10 / times / CAPACITY;
    assert_in_range(s.config.maxHeapCount, 2, FIXTURE_HEAPS);
    scene_configure(&s);
}

/* Back and forth along the diagonal, a region at a time; each texture begins elsewhere. */
static void pan(uint32_t step)
{
    for (uint32_t i = 0; i < TEXTURES; i++) {
        uint32_t at = (step + 3 * i) % 44;
        s.textures[i].window.x = s.textures[i].window.y = at < 22 ? at : 44 - at;
    }
}

/* Adds the regions in view that show this level or a coarser one. */
static void count_coarse(const struct scene_texture *t, uint32_t level, uint32_t *coarse,
                         uint32_t *all)
{
    for (uint32_t i = 0; i < t->layout.minMipWidth * t->layout.minMipHeight; i++) {
        uint32_t x = i % t->layout.minMipWidth, y = i / t->layout.minMipWidth;
        bool in_view = scene_wanted(t, x, y) != SLUICE_MIP_UNTOUCHED;
        *coarse += in_view && t->min_mip[i] >= level;
        *all += in_view;
    }
}

static const uint32_t times[] = {15, 40, 100};
enum { TIMES = sizeof times / sizeof *times };

/* Levels 0 to 5 are regular: level 5 is one tile, level 4 is four, level 3 sixteen. */
static void the_coarse_levels_of_what_is_in_view_are_there(void **state)
{
    (void)state;
    static const struct {
        uint32_t times, rings, level;
    } cases[] = {{15, 0, 4}, {15, 2, 4}, {40, 0, 4}, {40, 2, 4}, {100, 0, 4}, {100, 2, 6}};
    for (uint32_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        open_scene(cases[i].times, (uint8_t)cases[i].rings);
        uint32_t coarse = 0, all = 0;
        for (uint32_t frame = 0; frame < 1200; frame++) {
            if (frame % 6 == 0)
                pan(frame / 6);
            scene_run(&s, 1);
            /* Count just before the next step, after a map and a load for the last one. */
            for (uint32_t k = 0; frame >= 60 && frame % 6 == 5 && k < TEXTURES; k++)
                count_coarse(&s.textures[k], cases[i].level, &coarse, &all);
        }
        if (coarse > all / 50)
            fail_msg("%u tenths, rings %u: %u of %u show level %u at best",
                     (unsigned)cases[i].times, (unsigned)cases[i].rings, (unsigned)coarse,
                     (unsigned)all, (unsigned)cases[i].level);
        assert_true(s.unmapped > s.config.maxHeapCount * CAPACITY);
        scene_close(&s);
    }
}

/* Seen once, a region that stays in view never loses its packed level again. */
static void nothing_in_view_ever_shows_nothing(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < TIMES; i++) {
        open_scene(times[i], 2);
        /* Wait, because with few slots the first texture may hold the last packed tile's slot. */
        scene_run(&s, 2 * scene_round(&s) + s.timeout_frames + 2 * s.load_frames);
        for (uint32_t frame = 0; frame < 600; frame++) {
            if (frame % 6 == 0)
                pan(frame / 6);
            scene_run(&s, 1);
            for (uint32_t k = 0; k < TEXTURES; k++)
                assert_true(scene_shows_something(&s.textures[k]));
        }
        scene_close(&s);
    }
}

static bool is_on_its_way(const struct scene_texture *t, uint32_t tile)
{
    SluiceTileState state = fixture_state(&s.f, t->id, tile);
    return state >= SLUICE_TILE_STATE_ALLOCATED && state <= SLUICE_TILE_STATE_STANDBY;
}

static void no_tile_is_loaded_before_all_that_are_coarser_over_it(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < TIMES; i++) {
        open_scene(times[i], 2);
        for (uint32_t frame = 0; frame < 400; frame++) {
            if (frame % 6 == 0)
                pan(frame / 6);
            scene_run(&s, 1);
            for (uint32_t k = 0; k < s.f.count; k++) { /* the last list of a frame */
                const SluiceTile *tile = &s.f.tiles[k];
                const struct scene_texture *t = &s.textures[(uint32_t)tile->textureId];
                assert_true(t->id == tile->textureId);
                uint32_t parent = t->layout.regularTileCount;
                if (tile->mipLevel + 1 < t->layout.desc.regularMipCount)
                    parent = t->layout.levelFirstTile[tile->mipLevel + 1] +
                             tile->y / 2 * t->layout.levelWidthInTiles[tile->mipLevel + 1] +
                             tile->x / 2;
                assert_true(tile->tileIndex == parent || is_on_its_way(t, parent));
            }
        }
        scene_close(&s);
    }
}

/* Levels grow from the front of each list to its end, and nothing coarser is left out. */
static void coarse_tiles_of_all_textures_come_before_fine_ones(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < TIMES; i++) {
        open_scene(times[i], 0);
        s.loads_per_frame = 6;
        for (uint32_t frame = 0; frame < 400; frame++) {
            if (frame % 12 == 0)
                pan(frame / 12);
            scene_run(&s, 1);
            for (uint32_t k = 1; k < s.f.count; k++)
                assert_true(s.f.tiles[k].mipLevel <= s.f.tiles[k - 1].mipLevel);
        }
        scene_close(&s);
    }
}

/* A new view is shown coarsely at once, however many fine tiles still hold slots. */
static void after_a_cut_the_new_view_shows_its_coarse_levels_first(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < TIMES; i++) {
        open_scene(times[i], 0);
        scene_run(&s, 200);
        for (uint32_t k = 0; k < TEXTURES; k++)
            s.textures[k].window.x = s.textures[k].window.y = 20;
        /* Run a round of maps without the old view, then its timeout. */
        scene_run(&s, scene_round(&s) + s.timeout_frames + 20);
        uint32_t coarse = 0, all = 0;
        for (uint32_t k = 0; k < TEXTURES; k++)
            count_coarse(&s.textures[k], 5, &coarse, &all);
        assert_int_equal(coarse, 0);
        scene_run(&s, 100);
        uint32_t deficit = scene_mean_deficit(&s);
        scene_run(&s, 400);
        assert_in_range(scene_mean_deficit(&s), deficit > 100 ? deficit - 100 : 0, deficit + 100);
        scene_close(&s);
    }
}

/* The whole view fits, except the tiles of earlier views in STANDBY. Every 60 frames the camera
 * cuts. The whole new view must be resident before the next cut, although a list holds only 8
 * tiles. */
static void slots_are_reclaimed_for_all_that_waits_however_short_the_list(void **state)
{
    (void)state;
    for (uint32_t retire = 2; retire <= 8; retire += 6) {
        scene_open(&s, CAPACITY, 16);
        s.config.numExtraStandbyTiles = 256;
        scene_configure(&s);
        s.loads_per_frame = 8;
        s.retire_frames = retire;
        for (uint32_t i = 0; i < 3; i++)
            scene_add(&s, 2048, (struct scene_window){i, i, 6, 6, 0, 0});
        for (uint32_t step = 0; step < 20; step++) {
            for (uint32_t i = 0; i < 3; i++) {
                s.textures[i].window.x = (step * 3 + i) % 10;
                s.textures[i].window.y = (step * 5 + i) % 10;
            }
            scene_run(&s, 60);
            assert_int_equal(fixture_statistics(&s.f).requestedTileCount, 0);
            assert_int_equal(scene_mean_deficit(&s), 0);
        }
        scene_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_coarse_levels_of_what_is_in_view_are_there),
        cmocka_unit_test(nothing_in_view_ever_shows_nothing),
        cmocka_unit_test(no_tile_is_loaded_before_all_that_are_coarser_over_it),
        cmocka_unit_test(coarse_tiles_of_all_textures_come_before_fine_ones),
        cmocka_unit_test(after_a_cut_the_new_view_shows_its_coarse_levels_first),
        cmocka_unit_test(slots_are_reclaimed_for_all_that_waits_however_short_the_list),
    };
    return RUN_TESTS(tests);
}
