#include "core/fixture.h"

#include <string.h>

/* Feeds an empty map, so that only time passes. */
static void pass(struct fixture *f, SluiceTextureId id, uint64_t time, uint64_t timeout)
{
    fixture_feed(f, id, SLUICE_MIP_UNTOUCHED, time, timeout);
}

static SluiceResult feed_result(struct fixture *f, SluiceTextureId id, uint64_t time)
{
    const uint8_t map[4] = {0};
    SluiceFeedbackDesc feedback = {sizeof feedback, map, 2, 2, 0, 0};
    return sluiceUpdateWithSamplerFeedback(f->manager, id, &feedback, time, 10);
}

static void time_going_backwards_is_refused_over_all_textures(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId ids[2] = {fixture_add_small(&f), fixture_add_small(&f)};
    fixture_feed(&f, ids[0], 1, 100, 10);
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    uint64_t digest = fixture_digest(&f, 2, ids);
    uint32_t tile = 4;
    CHECK_RESULT(feed_result(&f, ids[0], 99), SLUICE_ERROR_TIME_BACKWARDS);
    CHECK_RESULT(feed_result(&f, ids[1], 99), SLUICE_ERROR_TIME_BACKWARDS);
    CHECK_RESULT(feed_result(&f, ids[1], 0), SLUICE_ERROR_TIME_BACKWARDS);
    CHECK_RESULT(sluiceMatchPrimaryTexture(f.manager, ids[0], ids[1], 99, 10),
                 SLUICE_ERROR_TIME_BACKWARDS);
    CHECK_RESULT(sluiceReportFailedTiles(f.manager, ids[0], 1, &tile, 99),
                 SLUICE_ERROR_TIME_BACKWARDS);
    assert_true(fixture_digest(&f, 2, ids) == digest);
    CHECK_OK(feed_result(&f, ids[1], 100)); /* standing still is allowed */
    CHECK_OK(sluiceReportFailedTiles(f.manager, ids[0], 1, &tile, 101));
    CHECK_RESULT(feed_result(&f, ids[1], 100), SLUICE_ERROR_TIME_BACKWARDS);
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, ids[0], ids[1], 102, 10));
    CHECK_RESULT(feed_result(&f, ids[1], 101), SLUICE_ERROR_TIME_BACKWARDS);
    fixture_close(&f);
}

static void the_first_time_stamp_may_be_anything(void **state)
{
    (void)state;
    static const uint64_t firsts[] = {0, 1, UINT64_C(1) << 63, UINT64_MAX};
    for (uint32_t i = 0; i < 4; i++) {
        struct fixture f;
        fixture_open(&f, 16, false);
        SluiceTextureId id = fixture_add_small(&f);
        CHECK_OK(feed_result(&f, id, firsts[i]));
        CHECK_RESULT(feed_result(&f, id, firsts[i] - 1), SLUICE_ERROR_TIME_BACKWARDS);
        /* half the circle is the future, the other half the past */
        CHECK_RESULT(feed_result(&f, id, firsts[i] + (UINT64_C(1) << 63)),
                     SLUICE_ERROR_TIME_BACKWARDS);
        CHECK_OK(feed_result(&f, id, firsts[i] + (UINT64_C(1) << 63) - 1));
        fixture_close(&f);
    }
}

static void a_want_lasts_until_exactly_its_timeout(void **state)
{
    (void)state;
    static const uint64_t starts[] = {0, 100, UINT64_MAX - 3, UINT64_MAX};
    for (uint32_t i = 0; i < 4; i++) {
        struct fixture f;
        fixture_open(&f, 16, false);
        SluiceTextureId id = fixture_add_small(&f);
        uint64_t t = starts[i];
        fixture_feed_region(&f, id, 0, 0, t, 10);
        pass(&f, id, t + 9, 10);
        CHECK_STATE(&f, id, 0, REQUESTED);
        CHECK_STATE(&f, id, 5, REQUESTED);
        pass(&f, id, t + 10, 10);
        CHECK_STATE(&f, id, 0, FREE);
        CHECK_STATE(&f, id, 4, FREE);
        CHECK_STATE(&f, id, 5, FREE);
        fixture_close(&f);
    }
}

static void the_timeout_is_that_of_the_call_that_lets_lapse(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed_region(&f, id, 0, 0, 100, 1);
    pass(&f, id, 149, 50);
    CHECK_STATE(&f, id, 0, REQUESTED);
    pass(&f, id, 150, 50);
    CHECK_STATE(&f, id, 0, FREE);
    fixture_close(&f);
}

static void timeout_zero_keeps_the_newest_map_only(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed_region(&f, id, 0, 0, 100, 0);
    CHECK_STATE(&f, id, 0, REQUESTED);
    fixture_feed_region(&f, id, 1, 0, 100, 0); /* at the same time stamp */
    CHECK_STATE(&f, id, 0, FREE);
    CHECK_STATE(&f, id, 1, REQUESTED);
    fixture_feed_region(&f, id, 2, 0, 100, 1); /* 1 keeps the maps of the same time stamp */
    CHECK_STATE(&f, id, 1, REQUESTED);
    CHECK_STATE(&f, id, 2, REQUESTED);
    fixture_close(&f);
}

static void the_longest_timeout_never_lets_lapse(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed_region(&f, id, 0, 0, 7, UINT64_MAX);
    for (uint32_t i = 1; i < 4; i++)
        pass(&f, id, 7 + i * (UINT64_C(1) << 62), UINT64_MAX);
    CHECK_STATE(&f, id, 0, REQUESTED);
    fixture_close(&f);
}

static void a_region_missed_by_flickering_maps_holds_its_level(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 0, 8);
    fixture_load(&f);
    uint64_t random = 1;
    for (uint64_t t = 1; t < 1000; t++) { /* every region is seen once in 8, else missed */
        uint8_t map[4];
        for (uint32_t r = 0; r < 4; r++)
            map[r] = (t + r) % 8 == 0 ? 0 : next_random(&random) % 2 ? 1 : SLUICE_MIP_UNTOUCHED;
        fixture_feed_map(&f, id, map, t, 16);
        for (uint32_t i = 0; i < 6; i++)
            CHECK_STATE(&f, id, i, MAPPED);
    }
    assert_int_equal(fixture_statistics(&f).restoredTotal, 0);
    fixture_close(&f);
}

static void the_finest_map_lapses_and_the_coarser_one_holds(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed_region(&f, id, 0, 0, 100, 10);
    fixture_feed_region(&f, id, 0, 1, 105, 10);
    fixture_feed_region(&f, id, 0, 7, 108, 10);
    CHECK_STATE(&f, id, 0, REQUESTED);
    pass(&f, id, 110, 10);
    CHECK_STATE(&f, id, 0, FREE);
    CHECK_STATE(&f, id, 4, REQUESTED);
    pass(&f, id, 115, 10);
    CHECK_STATE(&f, id, 4, FREE);
    CHECK_STATE(&f, id, 5, REQUESTED);
    pass(&f, id, 118, 10);
    CHECK_STATE(&f, id, 5, FREE);
    fixture_close(&f);
}

static void lapsed_stays_lapsed_with_a_longer_timeout(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed_region(&f, id, 0, 0, 100, 10);
    pass(&f, id, 105, 3); /* a short timeout lets lapse at once */
    CHECK_STATE(&f, id, 0, FREE);
    pass(&f, id, 105, 1000);
    CHECK_STATE(&f, id, 0, FREE);
    CHECK_STATE(&f, id, 5, FREE);
    fixture_close(&f);
}

static void several_levels_may_lapse_in_one_call(void **state)
{
    (void)state;
    for (uint8_t last = 0; last < 4; last++) { /* levels in the map that makes them expire */
        struct fixture f;
        fixture_open(&f, 16, false);
        const SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                           .missesToExpire = 1};
        CHECK_OK(sluiceSetConfig(f.manager, &config));
        SluiceStreamedTextureDesc desc = full_chain(512, 512, 128, 128); /* 16, 4, 1 and packed */
        SluiceTextureId id = fixture_add(&f, &desc);
        for (uint8_t level = 0; level < 4; level++)
            fixture_feed_region(&f, id, 5, level, 100 + level, 10);
        CHECK_STATE(&f, id, 5, REQUESTED);
        fixture_feed_region(&f, id, 5, last, 200, 10);
        static const uint32_t over[] = {5, 16, 20, 21}; /* the region's tile of each level */
        for (uint8_t level = 0; level < 4; level++)
            assert_int_equal(fixture_state(&f, id, over[level]),
                             level >= last ? SLUICE_TILE_STATE_REQUESTED : SLUICE_TILE_STATE_FREE);
        pass(&f, id, 300, 10);
        assert_int_equal(fixture_statistics(&f).requestedTileCount, 0);
        fixture_close(&f);
    }
}

static void a_texture_without_maps_keeps_its_wants(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId a = fixture_add_small(&f), b = fixture_add_small(&f);
    fixture_feed(&f, a, 0, 0, 10);
    fixture_load(&f);
    for (uint64_t t = 1; t < 10; t++)
        fixture_feed(&f, b, 0, t * 1000, 10);
    for (uint32_t i = 0; i < 6; i++)
        CHECK_STATE(&f, a, i, MAPPED);
    pass(&f, a, 9000, 10);
    CHECK_STATE(&f, a, 0, STANDBY);
    fixture_close(&f);
}

/* Hashes the last list, including heaps and slots. */
static uint64_t hash_list(uint64_t h, const struct fixture *f)
{
    for (uint32_t i = 0; i < f->count; i++) {
        const SluiceTile *t = &f->tiles[i];
        uint64_t place = (uint64_t)t->tileIndex << 40 ^ (uint64_t)t->heapId << 20 ^ t->slot;
        h = (h ^ t->textureId ^ place) * 0x9E3779B97F4A7C15u;
        h ^= h >> 29;
    }
    return h;
}

/* Answers loads of the last frame in one of three ways, whether canceled or not. */
static void answer_at_random(struct fixture *f, uint32_t count, const SluiceTile *tiles,
                             uint64_t time, uint64_t *random)
{
    for (uint32_t i = 0; i < count; i++) {
        SluiceTextureId id = tiles[i].textureId;
        uint32_t tile = tiles[i].tileIndex, dice = next_random(random) % 4;
        if (dice == 0)
            CHECK_OK(sluiceReportFailedTiles(f->manager, id, 1, &tile, time));
        else if (dice == 1)
            CHECK_OK(sluiceReportCanceledTiles(f->manager, id, 1, &tile, 0));
        else
            CHECK_OK(sluiceUpdateTilesMapping(f->manager, id, 1, &tile));
    }
}

/* Runs 300 frames of random feedback with failing loads. Returns a hash of all results. */
static uint64_t run_from(uint64_t start, uint64_t unit)
{
    struct fixture f;
    fixture_open(&f, 4, false);
    f.heaps.limit = 6;
    fixture_configure(&f, 6, 0, 3, 2 * unit);
    SluiceStreamedTextureDesc desc = full_chain(1025, 516, 128, 128);
    SluiceTextureId ids[3] = {fixture_add(&f, &desc), fixture_add_small(&f),
                              fixture_add(&f, &desc)};
    uint64_t h = 1, random = 5;
    uint32_t loading = 0;
    SluiceTile loads[24];
    for (uint64_t frame = 0; frame < 300; frame++) {
        uint64_t time = start + frame * unit;
        uint8_t map[64];
        for (uint32_t i = 0; i < 64; i++)
            map[i] = next_random(&random) % 20 ? SLUICE_MIP_UNTOUCHED : next_random(&random) % 5;
        fixture_feed_map(&f, ids[frame % 3], map, time, 7 * unit);
        CHECK_OK(fixture_to_cancel(&f, SLUICE_ALL_TEXTURES));
        h = hash_list(h, &f);
        answer_at_random(&f, loading, loads, time, &random);
        CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
        h = hash_list(h, &f);
        assert_true(fixture_to_map(&f, SLUICE_ALL_TEXTURES) >= 0);
        h = hash_list(h, &f);
        loading = f.count;
        memcpy(loads, f.tiles, loading * sizeof *loads);
        h ^= fixture_digest(&f, 3, ids);
    }
    SluiceStreamedTextureStatistics s = fixture_statistics(&f);
    assert_true(s.failedTotal && s.canceledTotal && s.restoredTotal && s.unmappedTotal);
    fixture_close(&f);
    return h;
}

static void uptime_and_wrap_change_no_decision(void **state)
{
    (void)state;
    const uint64_t frame = 16666667, day = UINT64_C(86400000000000); /* nanoseconds */
    const uint64_t expected = run_from(0, frame);
    static const uint64_t days[] = {1, 100, 10000};
    for (uint32_t i = 0; i < 3; i++)
        assert_true(run_from(days[i] * day, frame) == expected);
    assert_true(run_from((UINT64_C(1) << 32) - 10 * frame, frame) == expected);
    assert_true(run_from((UINT64_C(1) << 63) - 150 * frame, frame) == expected);
    for (uint64_t before = 0; before < 40; before += 13)
        assert_true(run_from(UINT64_MAX - before * frame, frame) == expected);
    assert_true(run_from(0, frame + 1) == expected);              /* only ratios of times count */
    assert_true(run_from(UINT64_MAX - 150 * 16, 16) == expected); /* 16: patience divides by it */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(time_going_backwards_is_refused_over_all_textures),
        cmocka_unit_test(the_first_time_stamp_may_be_anything),
        cmocka_unit_test(a_want_lasts_until_exactly_its_timeout),
        cmocka_unit_test(the_timeout_is_that_of_the_call_that_lets_lapse),
        cmocka_unit_test(timeout_zero_keeps_the_newest_map_only),
        cmocka_unit_test(the_longest_timeout_never_lets_lapse),
        cmocka_unit_test(a_region_missed_by_flickering_maps_holds_its_level),
        cmocka_unit_test(the_finest_map_lapses_and_the_coarser_one_holds),
        cmocka_unit_test(lapsed_stays_lapsed_with_a_longer_timeout),
        cmocka_unit_test(a_texture_without_maps_keeps_its_wants),
        cmocka_unit_test(uptime_and_wrap_change_no_decision),
        cmocka_unit_test(several_levels_may_lapse_in_one_call),
    };
    return RUN_TESTS(tests);
}
