/** Feedback that randomly misses much of the view. Visible tiles stay, others are dropped. */
#include "core/scene.h"

enum { TEXTURES = 4 };

static struct scene s;

/* 4 textures of which all 256 regions are in view; enough slots, nothing is kept on standby. */
static void open_scene(uint32_t missing)
{
    scene_open(&s, 64, 0);
    s.missing = missing;
    s.loads_per_frame = 512;
    for (uint32_t i = 0; i < TEXTURES; i++)
        scene_add(&s, 2048, (struct scene_window){0, 0, 16, 16, 0, 3});
}

/* Feeds `maps` maps to each texture, one in `interval` frames. */
static void run_maps(uint32_t maps, uint32_t interval)
{
    for (uint32_t map = 0; map < maps; map++) {
        s.maps_per_frame = TEXTURES;
        scene_run(&s, 1);
        s.maps_per_frame = 0;
        scene_run(&s, interval - 1);
    }
}

/* Sixteenths of the timeout from map to map. */
static const uint32_t intervals[] = {1, 2, 4, 8, 15, 16, 24, 64};
enum { INTERVALS = sizeof intervals / sizeof *intervals };

/*
 * Limits the uploads during `maps` maps of a settled texture. An estimate is wrong with a
 * probability of 10^-6 per region and map: one of 1024 regions in 1000 maps. If 99 of 100 samples
 * are missing, few hits give a poor estimate of that share. Then all tiles may be loaded once more
 * in 1000 maps.
 */
static void check_settled(uint32_t maps, uint32_t interval)
{
    uint64_t uploads = s.uploads;
    uint32_t allowed = s.missing < 99 ? 1 : scene_working_set(&s);
    run_maps(maps, interval);
    if (s.uploads - uploads > allowed)
        fail_msg("%u %% missing, every %u frames: %u uploads in %u maps", (unsigned)s.missing,
                 (unsigned)interval, (unsigned)(s.uploads - uploads), (unsigned)maps);
    assert_in_range(scene_mean_deficit(&s), 0, s.missing < 99 ? 0 : 100);
}

static void check_missing(uint32_t missing, uint32_t settling, uint32_t first, uint32_t end)
{
    for (uint32_t i = first; i < end; i++) {
        open_scene(missing);
        run_maps(settling, intervals[i]);
        check_settled(1000, intervals[i]);
        scene_close(&s);
    }
}

static void reliable_maps_load_each_tile_once(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < INTERVALS; i++) {
        open_scene(0);
        run_maps(100, intervals[i]);
        assert_int_equal(s.uploads, scene_working_set(&s));
        assert_int_equal(s.unmapped, 0);
        scene_close(&s);
    }
}

static void half_of_the_regions_missing_cost_no_uploads_within_the_timeout(void **state)
{
    (void)state;
    check_missing(50, 20, 0, 5);
}

static void half_of_the_regions_missing_cost_no_uploads_beyond_the_timeout(void **state)
{
    (void)state;
    check_missing(50, 200, 5, INTERVALS);
}

static void nine_tenths_missing_cost_no_uploads_within_the_timeout(void **state)
{
    (void)state;
    check_missing(90, 60, 0, 5);
}

static void nine_tenths_missing_cost_no_uploads_beyond_the_timeout(void **state)
{
    (void)state;
    check_missing(90, 500, 5, INTERVALS);
}

static void ninety_nine_hundredths_missing_cost_no_uploads_within_the_timeout(void **state)
{
    (void)state;
    check_missing(99, 3000, 0, 5);
}

static void ninety_nine_hundredths_missing_cost_no_uploads_beyond_the_timeout(void **state)
{
    (void)state;
    check_missing(99, 3000, 5, INTERVALS);
}

static void check_change(uint32_t from, uint32_t to, uint32_t settling, uint32_t interval)
{
    open_scene(from);
    run_maps(300, interval);
    s.missing = to;
    run_maps(settling, interval);
    check_settled(1000, interval);
    scene_close(&s);
}

static void maps_that_begin_to_miss_more_are_learned_within_the_timeout(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 5; i++) {
        check_change(0, 50, 100, intervals[i]);
        check_change(50, 90, 600, intervals[i]);
        check_change(99, 0, 10, intervals[i]);
    }
    check_change(50, 99, 8000, 1);
}

static void maps_that_begin_to_miss_more_are_learned_beyond_the_timeout(void **state)
{
    (void)state;
    for (uint32_t i = 5; i < INTERVALS; i++) {
        check_change(0, 50, 300, intervals[i]);
        check_change(50, 90, 600, intervals[i]);
        check_change(99, 0, 10, intervals[i]);
    }
    check_change(50, 99, 8000, 16);
}

/* Returns the number of maps until only visible tiles are MAPPED, at most `limit`. */
static uint32_t maps_until_dropped(uint32_t limit, uint32_t interval)
{
    uint32_t wanted = scene_working_set(&s), maps = 0;
    while (fixture_statistics(&s.f).mappedTileCount > wanted && maps < limit) {
        run_maps(1, interval);
        maps++;
    }
    return maps;
}

/* Half of each texture leaves the view, then all of it, which one empty map after another shows. */
static void what_leaves_the_view_is_dropped_in_the_end(void **state)
{
    (void)state;
    static const struct {
        uint32_t missing, settling, half, all; ///< maps
    } cases[] = {{0, 10, 21, 21}, {50, 100, 40, 21}, {90, 200, 400, 21}};
    for (uint32_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        for (uint32_t i = 0; i < 5; i++) {
            open_scene(cases[c].missing);
            run_maps(cases[c].settling, intervals[i]);
            for (uint32_t k = 0; k < TEXTURES; k++)
                s.textures[k].window.width = 8;
            uint32_t half = maps_until_dropped(10000, intervals[i]);
            for (uint32_t k = 0; k < TEXTURES; k++)
                s.textures[k].window.width = 0;
            uint32_t all = maps_until_dropped(10000, intervals[i]);
            if (half > cases[c].half || all > cases[c].all)
                fail_msg("%u %% missing, every %u frames: %u maps for a half, %u for the whole",
                         (unsigned)cases[c].missing, (unsigned)intervals[i], (unsigned)half,
                         (unsigned)all);
            scene_close(&s);
        }
    }
}

/* 16 textures of 86 tiles in a fraction of the slots. */
static void check_under_pressure(uint32_t missing, uint32_t heaps, uint32_t settling)
{
    scene_open(&s, 16, heaps);
    s.missing = missing;
    s.maps_per_frame = 16;
    for (uint32_t i = 0; i < 16; i++)
        scene_add(&s, 1024, (struct scene_window){0, 0, 8, 8, 0, 0});
    scene_run(&s, settling);
    uint64_t uploads = s.uploads;
    scene_run(&s, 1000);
    if (s.uploads > uploads + 10)
        fail_msg("%u %% missing, %u slots: %u uploads in 1000 frames", (unsigned)missing,
                 (unsigned)heaps * 16, (unsigned)(s.uploads - uploads));
    scene_close(&s);
}

static void uploads_end_where_slots_are_short_too(void **state)
{
    (void)state;
    static const uint32_t heaps[] = {57, 21, 8};
    for (uint32_t i = 0; i < 3; i++) {
        check_under_pressure(50, heaps[i], 200);
        check_under_pressure(90, heaps[i], 500);
    }
}

static void uploads_end_where_slots_are_short_and_nearly_all_is_missing(void **state)
{
    (void)state;
    static const uint32_t heaps[] = {57, 21, 8};
    for (uint32_t i = 0; i < 3; i++)
        check_under_pressure(99, heaps[i], 3000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reliable_maps_load_each_tile_once),
        cmocka_unit_test(half_of_the_regions_missing_cost_no_uploads_within_the_timeout),
        cmocka_unit_test(half_of_the_regions_missing_cost_no_uploads_beyond_the_timeout),
        cmocka_unit_test(nine_tenths_missing_cost_no_uploads_within_the_timeout),
        cmocka_unit_test(nine_tenths_missing_cost_no_uploads_beyond_the_timeout),
        cmocka_unit_test(ninety_nine_hundredths_missing_cost_no_uploads_within_the_timeout),
        cmocka_unit_test(ninety_nine_hundredths_missing_cost_no_uploads_beyond_the_timeout),
        cmocka_unit_test(maps_that_begin_to_miss_more_are_learned_within_the_timeout),
        cmocka_unit_test(maps_that_begin_to_miss_more_are_learned_beyond_the_timeout),
        cmocka_unit_test(what_leaves_the_view_is_dropped_in_the_end),
        cmocka_unit_test(uploads_end_where_slots_are_short_too),
        cmocka_unit_test(uploads_end_where_slots_are_short_and_nearly_all_is_missing),
    };
    return RUN_TESTS(tests);
}
