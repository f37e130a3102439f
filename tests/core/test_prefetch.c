/** Prefetching: the coarsest levels of all textures, while nothing else is to be done. */
#include "core/scene.h"

enum { CAPACITY = 256 }; /* prefetching takes free slots and asks for no heap */

static const struct scene_window nothing = {0}, all_of_it = {0, 0, 8, 8, 0, 0};

static struct scene s;

/* Textures of 1024 x 1024: level 3 is one tile, level 2 is four. The first one is in view. */
static void open_scene(uint32_t heaps, uint32_t count, uint32_t levels, uint32_t standby)
{
    scene_open(&s, CAPACITY, heaps);
    s.config.prefetchLevels = levels;
    s.config.numExtraStandbyTiles = standby;
    scene_configure(&s);
    for (uint32_t i = 0; i < count; i++)
        scene_add(&s, 1024, i ? nothing : all_of_it);
}

static void check_totals(void)
{
    SluiceStreamedTextureStatistics now = fixture_statistics(&s.f);
    assert_int_equal(now.handedOutTotal, s.uploads);
    assert_int_equal(now.handedOutTotal, now.mappedTotal + s.load_count + now.canceledTotal);
    assert_int_equal(now.allocatedTileCount + now.canceledTileCount, s.load_count);
    assert_int_equal(now.mappedTileCount + now.standbyTileCount,
                     now.mappedTotal - now.unmappedTotal);
    assert_int_equal(now.unmappedTotal, s.unmapped);
}

/* Counts the tiles of the list that were not requested: they are CANCELED at once. */
static uint32_t prefetched(void)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s.f.count; i++)
        count += fixture_state(&s.f, s.f.tiles[i].textureId, s.f.tiles[i].tileIndex) ==
                 SLUICE_TILE_STATE_CANCELED;
    return count;
}

static void nothing_is_prefetched_by_default(void **state)
{
    (void)state;
    open_scene(2, 10, 0, 100);
    scene_run(&s, 200);
    assert_int_equal(s.uploads, 86);
    check_totals();
    scene_close(&s);
}

static void nothing_is_prefetched_where_nothing_may_stand_by(void **state)
{
    (void)state;
    open_scene(2, 10, 2, 0);
    scene_run(&s, 200);
    assert_int_equal(s.uploads, 86);
    scene_close(&s);
}

static void the_coarsest_levels_of_all_textures_are_prefetched_once(void **state)
{
    (void)state;
    for (uint32_t levels = 1; levels <= 2; levels++) {
        open_scene(2, 20, levels, 200);
        scene_run(&s, 100);
        uint32_t each = levels == 1 ? 1 : 5;
        for (uint32_t i = 1; i < 20; i++) {
            const struct scene_texture *t = &s.textures[i];
            assert_int_equal(scene_tiles_in(&s, t, SLUICE_TILE_STATE_STANDBY), each);
            for (uint32_t tile = 0; tile < t->layout.levelFirstTile[4 - levels]; tile++)
                CHECK_STATE(&s.f, t->id, tile, FREE);
        }
        assert_int_equal(s.uploads, 86 + 19 * each);
        scene_run(&s, 1000);
        assert_int_equal(s.uploads, 86 + 19 * each);
        assert_int_equal(scene_most_uploads(&s), 1);
        check_totals();
        scene_close(&s);
    }
}

static void the_coarsest_level_of_all_comes_before_the_next_of_any(void **state)
{
    (void)state;
    open_scene(2, 20, 2, 200);
    s.loads_per_frame = 7;
    uint32_t level = 3;
    for (uint32_t frame = 0; frame < 100; frame++) {
        scene_run(&s, 1);
        if (!prefetched())
            continue;
        for (uint32_t i = 0; i < s.f.count; i++) {
            if (fixture_state(&s.f, s.f.tiles[i].textureId, s.f.tiles[i].tileIndex) !=
                SLUICE_TILE_STATE_CANCELED)
                continue;
            assert_true(s.f.tiles[i].mipLevel <= level);
            level = s.f.tiles[i].mipLevel;
        }
    }
    assert_int_equal(level, 2);
    scene_close(&s);
}

/* Windows come and go, requests wait for slots and for room in the list. */
static void check_busy(uint32_t heaps, uint32_t standby)
{
    open_scene(heaps, 30, 2, standby);
    s.loads_per_frame = 16;
    uint32_t count = 0;
    for (uint32_t frame = 0; frame < 600; frame++) {
        if (frame % 20 == 0) {
            s.textures[frame / 20 % 30].window = nothing;
            s.textures[frame * 7 / 20 % 30].window = all_of_it;
        }
        scene_run(&s, 1);
        SluiceStreamedTextureStatistics now = fixture_statistics(&s.f);
        uint32_t here = prefetched();
        count += here;
        assert_true(here == 0 || now.requestedTileCount == 0);
        assert_true(here == 0 || now.freeSlotCount >= now.reservedSlotCount);
        assert_true(here == 0 || now.standbyTileCount + now.canceledTileCount <= standby);
        check_totals();
    }
    assert_true(count > 0);
    scene_close(&s);
}

static void nothing_is_prefetched_while_a_request_waits_or_beyond_the_standby(void **state)
{
    (void)state;
    check_busy(10, 500);
    check_busy(10, 40);
    check_busy(3, 40);
    check_busy(10, 7);
}

static void standby_that_is_full_with_prefetched_tiles_is_not_loaded_again(void **state)
{
    (void)state;
    open_scene(2, 30, 2, 20); /* 145 tiles could be prefetched */
    scene_run(&s, 1000);
    assert_int_equal(s.uploads, 86 + 20);
    assert_int_equal(s.unmapped, 0);
    assert_int_equal(scene_most_uploads(&s), 1);
    scene_close(&s);
}

static void what_comes_into_view_finds_its_coarse_levels(void **state)
{
    (void)state;
    for (uint32_t levels = 1; levels <= 2; levels++) {
        scene_open_packed(&s, CAPACITY, 2);
        s.config.prefetchLevels = levels;
        s.config.numExtraStandbyTiles = 200;
        scene_configure(&s);
        for (uint32_t i = 0; i < 10; i++)
            scene_add(&s, 1024, nothing);
        scene_run(&s, 100);
        struct scene_texture *t = &s.textures[5];
        uint64_t restored = fixture_statistics(&s.f).restoredTotal;
        t->window = (struct scene_window){0, 0, 8, 8, (uint8_t)(4 - levels), 0};
        s.maps_per_frame = 10;
        scene_run(&s, 1); /* the very frame of the map: no load is needed */
        assert_int_equal(scene_deficit(t), 0);
        assert_int_equal(t->min_mip[0], 4 - levels);
        assert_int_equal(fixture_statistics(&s.f).restoredTotal - restored, levels == 1 ? 1 : 5);
        check_totals();
        scene_close(&s);
    }
}

/* Without alwaysMapPackedTiles the packed tile is the only one left to load. */
static void one_load_is_enough_where_packed_tiles_come_and_go(void **state)
{
    (void)state;
    open_scene(2, 10, 1, 200);
    s.maps_per_frame = 10;
    scene_run(&s, 100);
    uint64_t uploads = s.uploads;
    struct scene_texture *t = &s.textures[5];
    t->window = (struct scene_window){0, 0, 8, 8, 3, 0};
    scene_run(&s, 1 + s.load_frames);
    assert_int_equal(scene_deficit(t), 0);
    assert_int_equal(s.uploads, uploads + 1);
    scene_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_prefetched_by_default),
        cmocka_unit_test(nothing_is_prefetched_where_nothing_may_stand_by),
        cmocka_unit_test(the_coarsest_levels_of_all_textures_are_prefetched_once),
        cmocka_unit_test(the_coarsest_level_of_all_comes_before_the_next_of_any),
        cmocka_unit_test(nothing_is_prefetched_while_a_request_waits_or_beyond_the_standby),
        cmocka_unit_test(standby_that_is_full_with_prefetched_tiles_is_not_loaded_again),
        cmocka_unit_test(what_comes_into_view_finds_its_coarse_levels),
        cmocka_unit_test(one_load_is_enough_where_packed_tiles_come_and_go),
    };
    return RUN_TESTS(tests);
}
