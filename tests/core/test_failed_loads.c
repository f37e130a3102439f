#include "core/fixture.h"

#include <stdlib.h>

/* A texture whose only tile is packed: one load at a time. */
static SluiceTextureId add_one_tile(struct fixture *f)
{
    SluiceStreamedTextureDesc desc = full_chain(64, 64, 128, 128);
    return fixture_add(f, &desc);
}

static void fail_load(struct fixture *f, SluiceTextureId id, uint32_t tile, uint64_t time)
{
    CHECK_OK(sluiceReportFailedTiles(f->manager, id, 1, &tile, time));
}

static void back_off_doubles_from_failure_to_failure(void **state)
{
    (void)state;
    static const uint64_t starts[] = {0, 1000, UINT64_MAX - 50};
    for (uint32_t i = 0; i < 3; i++) {
        struct fixture f;
        fixture_open(&f, 16, false);
        fixture_configure(&f, 0, 0, 6, 10);
        SluiceTextureId id = add_one_tile(&f);
        uint64_t time = starts[i];
        fixture_feed(&f, id, 0, time, 1);
        for (uint64_t delay = 10; delay <= 160; delay *= 2) {
            CHECK_STATE(&f, id, 0, REQUESTED);
            CHECK_OK(fixture_to_map(&f, id));
            assert_int_equal(f.count, 1);
            fail_load(&f, id, 0, time);
            CHECK_STATE(&f, id, 0, FAILED);
            fixture_feed(&f, id, 0, time + delay - 1, 1);
            CHECK_STATE(&f, id, 0, FAILED);
            CHECK_OK(fixture_to_map(&f, id));
            assert_int_equal(f.count, 0);
            time += delay;
            fixture_feed(&f, id, 0, time, 1);
        }
        CHECK_OK(fixture_to_map(&f, id));
        fail_load(&f, id, 0, time); /* the sixth */
        CHECK_STATE(&f, id, 0, GIVEN_UP);
        assert_int_equal(fixture_statistics(&f).failedTotal, 6);
        fixture_close(&f);
    }
}

static void the_slot_of_a_failed_load_is_free_at_once(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = add_one_tile(&f);
    fixture_feed(&f, id, 0, 0, 1);
    CHECK_OK(fixture_to_map(&f, id));
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 15);
    fail_load(&f, id, 0, 0);
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 16);
    assert_int_equal(fixture_statistics(&f).retiringSlotCount, 0);
    fixture_close(&f);
}

static void any_call_with_a_time_stamp_makes_due_retries_requested(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    fixture_configure(&f, 0, 0, 0, 10);
    SluiceTextureId a = add_one_tile(&f), b = add_one_tile(&f), c = add_one_tile(&f);
    fixture_feed(&f, a, 0, 0, 1);
    CHECK_OK(fixture_to_map(&f, a));
    fail_load(&f, a, 0, 0);
    fixture_feed(&f, b, 0, 10, 1); /* another texture's map */
    CHECK_STATE(&f, a, 0, REQUESTED);
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f.count, 2);
    fail_load(&f, a, 0, 10); /* due at 30 */
    fail_load(&f, b, 0, 30); /* a failure brings a time stamp too */
    CHECK_STATE(&f, a, 0, REQUESTED);
    CHECK_OK(fixture_to_map(&f, a));
    fail_load(&f, a, 0, 30); /* due at 70 */
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, b, c, 69, 1));
    CHECK_STATE(&f, a, 0, FAILED);
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, b, c, 70, 1));
    CHECK_STATE(&f, a, 0, REQUESTED);
    fixture_close(&f);
}

static void a_refused_call_retries_nothing(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    fixture_configure(&f, 0, 0, 0, 10);
    SluiceTextureId id = add_one_tile(&f);
    fixture_feed(&f, id, 0, 0, 1);
    CHECK_OK(fixture_to_map(&f, id));
    fail_load(&f, id, 0, 0);
    uint32_t tile = 0;
    CHECK_RESULT(sluiceReportFailedTiles(f.manager, id, 1, &tile, 100),
                 SLUICE_ERROR_INVALID_TILE_STATE);
    CHECK_STATE(&f, id, 0, FAILED);
    fixture_feed(&f, id, 0, 5, 1); /* and 100 was not taken over */
    CHECK_STATE(&f, id, 0, FAILED);
    fixture_close(&f);
}

static void five_attempts_are_the_default(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = add_one_tile(&f);
    fixture_feed(&f, id, 0, 0, 1);
    for (uint32_t i = 0; i < 5; i++) {
        CHECK_OK(fixture_to_map(&f, id));
        assert_int_equal(f.count, 1);
        fail_load(&f, id, 0, i); /* no delay: due at once, requested by the next time stamp */
        fixture_feed(&f, id, 0, i, 100);
        assert_int_equal(fixture_state(&f, id, 0),
                         i < 4 ? SLUICE_TILE_STATE_REQUESTED : SLUICE_TILE_STATE_GIVEN_UP);
    }
    fixture_close(&f);
}

static void a_tile_given_up_is_listed_once(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    fixture_configure(&f, 0, 0, 1, 10);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 0, 1);
    CHECK_OK(fixture_to_map(&f, id));
    fail_load(&f, id, 2, 0);
    fail_load(&f, id, 0, 0);
    fail_load(&f, id, 5, 0);
    uint32_t count = 0;
    CHECK_OK(sluiceGetGivenUpTiles(f.manager, &count, NULL));
    assert_int_equal(count, 3);
    f.count = 2;
    CHECK_RESULT(sluiceGetGivenUpTiles(f.manager, &f.count, f.tiles), SLUICE_INCOMPLETE);
    assert_true(LISTED(&f, id, 2, 0));
    f.count = 2;
    CHECK_OK(sluiceGetGivenUpTiles(f.manager, &f.count, f.tiles));
    assert_true(LISTED(&f, id, 5));
    assert_true(f.tiles[0].mipLevel == 2 && f.tiles[0].x == 0);
    f.count = 2;
    CHECK_OK(sluiceGetGivenUpTiles(f.manager, &f.count, f.tiles));
    assert_int_equal(f.count, 0);
    fixture_close(&f);
}

/* Nobody asks for the list, and what cannot be read is looked at again and again. */
static void a_tile_given_up_again_and_again_is_in_the_list_once(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    fixture_configure(&f, 0, 0, 1, 0);
    SluiceTextureId ids[2] = {add_one_tile(&f), add_one_tile(&f)};
    uint64_t early = 0;
    for (uint32_t time = 0; time < 5000; time++) {
        SluiceTextureId id = ids[time % 2];
        fixture_feed(&f, id, 0, time, 0);
        CHECK_OK(fixture_to_map(&f, id));
        assert_int_equal(f.count, 1);
        fail_load(&f, id, 0, time);
        CHECK_STATE(&f, id, 0, GIVEN_UP);
        fixture_feed(&f, id, SLUICE_MIP_UNTOUCHED, time, 0);
        CHECK_STATE(&f, id, 0, FREE);
        early = time == 10 ? f.memory.live_bytes : early;
    }
    assert_true(f.memory.live_bytes <= early);
    for (uint32_t left = 2; left > 0; left--) { /* the one that was given up first comes first */
        SluiceTile tile;
        uint32_t count = 1;
        CHECK_RESULT(sluiceGetGivenUpTiles(f.manager, &count, &tile),
                     left > 1 ? SLUICE_INCOMPLETE : SLUICE_SUCCESS);
        assert_true(count == 1 && tile.textureId == ids[2 - left]);
    }
    fixture_close(&f);
}

static void all_that_is_given_up_is_listed_in_order(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    fixture_configure(&f, 0, 0, 1, 0);
    SluiceStreamedTextureDesc desc = full_chain(2048, 2048, 128, 128);
    SluiceTextureId id = fixture_add(&f, &desc);
    fixture_feed(&f, id, 0, 0, 1);
    CHECK_OK(fixture_to_map(&f, id));
    uint32_t count = f.count, order[FIXTURE_ROOM], read = 0;
    for (uint32_t i = 0; i < count; i++)
        order[i] = f.tiles[i].tileIndex;
    for (uint32_t i = 0; i < count; i++) { /* three are given up for every two that are read */
        fail_load(&f, id, order[i], 0);
        f.count = i % 3 == 2 ? 2 : 0;
        assert_true(sluiceGetGivenUpTiles(f.manager, &f.count, f.tiles) >= 0);
        for (uint32_t n = 0; n < f.count; n++)
            assert_int_equal(f.tiles[n].tileIndex, order[read++]);
    }
    f.count = FIXTURE_ROOM;
    CHECK_OK(sluiceGetGivenUpTiles(f.manager, &f.count, f.tiles));
    for (uint32_t n = 0; n < f.count; n++)
        assert_int_equal(f.tiles[n].tileIndex, order[read++]);
    assert_int_equal(read, count);
    fixture_close(&f);
}

static void the_given_up_list_outlives_the_want_but_not_the_texture(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    fixture_configure(&f, 0, 0, 1, 10);
    SluiceTextureId a = add_one_tile(&f), b = add_one_tile(&f);
    fixture_feed(&f, a, 0, 0, 0);
    fixture_feed(&f, b, 0, 0, 0);
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    fail_load(&f, a, 0, 0);
    fail_load(&f, b, 0, 0);
    fixture_feed(&f, a, SLUICE_MIP_UNTOUCHED, 1, 0);
    CHECK_STATE(&f, a, 0, FREE);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, b, 0));
    f.count = 4;
    CHECK_OK(sluiceGetGivenUpTiles(f.manager, &f.count, f.tiles));
    assert_true(LISTED(&f, a, 0));
    fixture_close(&f);
}

static void a_tile_no_longer_wanted_forgets_its_failures(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    fixture_configure(&f, 0, 0, 2, 0);
    SluiceTextureId id = add_one_tile(&f);
    for (uint64_t t = 0; t < 10; t += 2) { /* one failure each time, never two in a row */
        fixture_feed(&f, id, 0, t, 0);
        CHECK_OK(fixture_to_map(&f, id));
        assert_int_equal(f.count, 1);
        fail_load(&f, id, 0, t);
        CHECK_STATE(&f, id, 0, FAILED);
        fixture_feed(&f, id, SLUICE_MIP_UNTOUCHED, t + 1, 0);
        CHECK_STATE(&f, id, 0, FREE);
    }
    fixture_close(&f);
}

static void a_tile_that_was_mapped_forgets_its_failures(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    fixture_configure(&f, 0, 0, 2, 0);
    SluiceTextureId id = add_one_tile(&f);
    for (uint64_t t = 0; t < 3; t++) {
        fixture_feed(&f, id, 0, 10 * t, 0);
        CHECK_OK(fixture_to_map(&f, id));
        fail_load(&f, id, 0, 10 * t);
        CHECK_STATE(&f, id, 0, FAILED);
        fixture_feed(&f, id, 0, 10 * t + 1, 0);
        fixture_load(&f);
        CHECK_STATE(&f, id, 0, MAPPED);
        fixture_feed(&f, id, SLUICE_MIP_UNTOUCHED, 10 * t + 2, 0);
        CHECK_OK(fixture_to_unmap(&f, id, 0));
        assert_int_equal(f.count, 1);
    }
    fixture_close(&f);
}

static void retry_requests_failed_tiles_then_those_given_up(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    fixture_configure(&f, 0, 0, 2, 10);
    SluiceTextureId id = fixture_add_small(&f), other = add_one_tile(&f);
    fixture_feed(&f, other, 0, 0, 1);
    fixture_feed(&f, id, 0, 0, 1);
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    fail_load(&f, id, 3, 0);
    fail_load(&f, id, 1, 0);
    fixture_feed(&f, id, 0, 10, 1);
    CHECK_OK(fixture_to_map(&f, id));
    assert_true(LISTED(&f, id, 3, 1)); /* in the order in which they became due */
    fail_load(&f, id, 3, 10);
    fail_load(&f, id, 1, 10);
    fail_load(&f, id, 2, 10);
    fail_load(&f, id, 0, 10);
    fail_load(&f, other, 0, 10);
    CHECK_STATE(&f, id, 3, GIVEN_UP);
    CHECK_STATE(&f, id, 2, FAILED);
    CHECK_OK(sluiceRetryFailedTiles(f.manager, id));
    CHECK_STATE(&f, other, 0, FAILED);
    CHECK_OK(fixture_to_map(&f, id));
    assert_true(LISTED(&f, id, 2, 0, 3, 1));
    fail_load(&f, id, 3, 10); /* given up: starts again from no failure */
    CHECK_STATE(&f, id, 3, FAILED);
    fail_load(&f, id, 2, 10); /* failed: the first failure still counts */
    CHECK_STATE(&f, id, 2, GIVEN_UP);
    CHECK_OK(sluiceRetryFailedTiles(f.manager, SLUICE_ALL_TEXTURES));
    CHECK_STATE(&f, other, 0, REQUESTED);
    CHECK_STATE(&f, id, 3, REQUESTED);
    CHECK_STATE(&f, id, 2, REQUESTED);
    fixture_close(&f);
}

static void a_region_stays_at_the_coarser_mip_of_what_loaded(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    fixture_configure(&f, 0, 0, 1, 0);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 0, 1);
    CHECK_OK(fixture_to_map(&f, id));
    fail_load(&f, id, 2, 0);
    const uint32_t loaded[] = {5, 4, 0, 1, 3};
    CHECK_OK(sluiceUpdateTilesMapping(f.manager, id, 5, loaded));
    uint8_t minmip[4];
    const uint8_t expected[4] = {0, 0, 1, 0};
    CHECK_OK(sluiceWriteMinMipData(f.manager, id, 2, 4, minmip));
    assert_memory_equal(minmip, expected, 4);
    fixture_close(&f);
}

static void the_longest_delays_do_not_overflow(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    fixture_configure(&f, 0, 0, UINT32_MAX, UINT64_MAX / 4);
    SluiceTextureId id = add_one_tile(&f);
    uint64_t time = 0;
    fixture_feed(&f, id, 0, time, 1);
    for (uint32_t i = 0; i < 80; i++) { /* 2^79 times the delay */
        CHECK_OK(fixture_to_map(&f, id));
        assert_int_equal(f.count, 1);
        fail_load(&f, id, 0, time);
        uint64_t delay = i == 0 ? UINT64_MAX / 4 : UINT64_C(1) << 62; /* capped */
        fixture_feed(&f, id, 0, time + delay - 1, 1);
        CHECK_STATE(&f, id, 0, FAILED);
        time += delay;
        fixture_feed(&f, id, 0, time, 1);
        CHECK_STATE(&f, id, 0, REQUESTED);
    }
    fixture_close(&f);
}

/* The configuration with which the facts about given-up tiles are shown: one attempt, 1000 rest. */
static void rest_for_1000(struct fixture *f)
{
    const SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                       .maxLoadAttempts = 1,
                                                       .retryDelayTicks = 10,
                                                       .givenUpRetryDelayTicks = 1000};
    CHECK_OK(sluiceSetConfig(f->manager, &config));
}

static uint32_t fail_all(struct fixture *f, SluiceTextureId scope, uint64_t time)
{
    uint32_t failed = 0;
    CHECK_OK(fixture_to_map(f, scope));
    for (; failed < f->count; failed++)
        fail_load(f, f->tiles[failed].textureId, f->tiles[failed].tileIndex, time);
    return failed;
}

static void given_up_tiles_are_probed_and_follow_the_first_that_comes(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    rest_for_1000(&f);
    SluiceStreamedTextureDesc desc = full_chain(1024, 1024, 128, 128);
    SluiceTextureId id = fixture_add(&f, &desc);
    fixture_feed(&f, id, 0, 0, 1);
    uint32_t wanted = fail_all(&f, id, 0);
    assert_int_equal(fixture_statistics(&f).givenUpTileCount, wanted);
    uint64_t time = 0;
    for (int round = 0; round < 3; round++) { /* nothing can be read: four reads in 1000 */
        fixture_feed(&f, id, 0, time + 999, 1);
        assert_int_equal(fail_all(&f, id, time + 999), 0);
        time += 1000;
        fixture_feed(&f, id, 0, time, 1);
        assert_int_equal(fail_all(&f, id, time), 4);
        assert_int_equal(fixture_statistics(&f).givenUpTileCount, wanted);
    }
    fixture_feed(&f, id, 0, time + 1000, 1); /* all is well again */
    CHECK_OK(fixture_to_map(&f, id));
    assert_int_equal(f.count, 4);
    CHECK_OK(sluiceUpdateTilesMapping(f.manager, id, 1, &f.tiles[0].tileIndex));
    assert_int_equal(fixture_statistics(&f).givenUpTileCount, 0);
    for (uint32_t i = 1; i < 4; i++)
        CHECK_OK(sluiceUpdateTilesMapping(f.manager, id, 1, &f.tiles[i].tileIndex));
    fixture_load(&f);
    assert_int_equal(fixture_statistics(&f).mappedTileCount, wanted);
    assert_int_equal(fixture_statistics(&f).givenUpRetriedTotal, 12 + wanted);
    fixture_close(&f);
}

static void tiles_damaged_for_good_do_not_hide_those_that_come_back(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    rest_for_1000(&f);
    SluiceStreamedTextureDesc desc = full_chain(1024, 1024, 128, 128);
    SluiceTextureId id = fixture_add(&f, &desc);
    fixture_feed(&f, id, 0, 0, 1);
    uint32_t wanted = fail_all(&f, id, 0), reads = 0;
    for (uint64_t time = 1000; time < 40000; time += 100) { /* a third is damaged for good */
        fixture_feed(&f, id, 0, time, 1);
        CHECK_OK(fixture_to_map(&f, id));
        reads += f.count;
        for (uint32_t i = 0; i < f.count; i++) {
            uint32_t tile = f.tiles[i].tileIndex;
            if (tile % 3 == 0)
                fail_load(&f, id, tile, time);
            else
                CHECK_OK(sluiceUpdateTilesMapping(f.manager, id, 1, &tile));
        }
    }
    assert_int_equal(fixture_statistics(&f).mappedTileCount, wanted - (wanted + 2) / 3);
    assert_true(reads < 2 * wanted + 4 * 40);
    fixture_close(&f);
}

static void another_tile_that_comes_is_a_sign_that_the_source_is_well(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    rest_for_1000(&f);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 1, 0, 1);
    assert_true(fail_all(&f, id, 0) > 0);
    for (uint64_t time = 124; time <= 125; time++) {
        uint32_t other = 0;
        fixture_feed(&f, id, 0, time, 1);
        CHECK_OK(fixture_to_map(&f, id));
        if (f.count == 0)
            break;
        other = f.tiles[0].tileIndex;
        CHECK_OK(sluiceUpdateTilesMapping(f.manager, id, 1, &other));
        fixture_feed(&f, id, 0, time, 1);
        uint32_t left = fixture_statistics(&f).givenUpTileCount;
        assert_true(time == 125 ? left == 0 : left > 0); /* an eighth of 1000 */
        for (uint32_t i = 1; time == 124 && i < f.count; i++)
            CHECK_OK(sluiceReportCanceledTiles(f.manager, id, 1, &f.tiles[i].tileIndex, 0));
    }
    fixture_close(&f);
}

/* A server that does not answer gets requests for 16 of 10 000 textures at a time, at any frame
 * rate. */
static void probes_of_many_textures_are_bounded(void **state)
{
    (void)state;
    enum { TEXTURES = 10000 };
    struct fixture f;
    fixture_open(&f, 256, false);
    rest_for_1000(&f);
    SluiceTextureId *ids = calloc(TEXTURES, sizeof *ids);
    for (uint32_t i = 0; i < TEXTURES; i++) {
        ids[i] = add_one_tile(&f);
        fixture_feed(&f, ids[i], 0, 0, UINT64_MAX);
    }
    for (uint32_t i = 0; i < TEXTURES; i++)
        assert_int_equal(fail_all(&f, ids[i], 0), 1);
    for (uint64_t time = 1000; time < 1010; time++) {
        fixture_feed(&f, ids[0], 0, time, UINT64_MAX);
        assert_int_equal(fail_all(&f, SLUICE_ALL_TEXTURES, time), 16);
    }
    uint64_t time = 2000; /* the server is back */
    for (; fixture_statistics(&f).givenUpTileCount > 0; time++) {
        fixture_feed(&f, ids[0], 0, time, UINT64_MAX);
        CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
        assert_true(f.count <= 16);
        for (uint32_t i = 0; i < f.count; i++)
            CHECK_OK(sluiceUpdateTilesMapping(f.manager, f.tiles[i].textureId, 1,
                                              &f.tiles[i].tileIndex));
    }
    assert_int_equal(fixture_statistics(&f).mappedTileCount, TEXTURES);
    free(ids);
    fixture_close(&f);
}

static void packed_tiles_are_probed_together(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, true);
    rest_for_1000(&f);
    SluiceStreamedTextureDesc desc = full_chain(256, 256, 128, 128);
    desc.packedTileCount = 9;
    SluiceTextureId id = fixture_add(&f, &desc);
    assert_int_equal(fail_all(&f, id, 0), 9);
    fixture_feed(&f, id, SLUICE_MIP_UNTOUCHED, 1000, 1);
    assert_int_equal(fail_all(&f, id, 1000), 9);
    fixture_close(&f);
}

static void a_texture_that_is_removed_while_it_rests_is_not_probed(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    rest_for_1000(&f);
    SluiceTextureId ids[3] = {add_one_tile(&f), add_one_tile(&f), add_one_tile(&f)};
    for (int i = 0; i < 3; i++)
        fixture_feed(&f, ids[i], 0, 0, UINT64_MAX);
    assert_int_equal(fail_all(&f, SLUICE_ALL_TEXTURES, 0), 3);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[1], 0));
    fixture_feed(&f, ids[0], 0, 1000, UINT64_MAX);
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f.count, 2);
    fixture_close(&f);
}

static void without_a_delay_given_up_tiles_wait_for_a_call(void **state)
{
    (void)state;
    static const SluiceStreamedTextureManagerConfig configs[] = {
        {.structSize = sizeof(SluiceStreamedTextureManagerConfig), .maxLoadAttempts = 1},
        {.structSize = sizeof(SluiceStreamedTextureManagerConfig),
         .maxLoadAttempts = 1,
         .givenUpRetryDelayTicks = UINT64_MAX}};
    for (int i = 0; i < 2; i++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        CHECK_OK(sluiceSetConfig(f.manager, &configs[i]));
        SluiceTextureId id = add_one_tile(&f);
        fixture_feed(&f, id, 0, 0, UINT64_MAX);
        assert_int_equal(fail_all(&f, id, 0), 1);
        fixture_feed(&f, id, 0, UINT64_MAX / 4, UINT64_MAX);
        CHECK_STATE(&f, id, 0, GIVEN_UP);
        CHECK_OK(sluiceRetryFailedTiles(f.manager, id));
        CHECK_STATE(&f, id, 0, REQUESTED);
        fixture_close(&f);
    }
}

static void the_default_delay_is_120_times_that_of_retries(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    fixture_configure(&f, 0, 0, 1, 10);
    SluiceTextureId id = add_one_tile(&f);
    fixture_feed(&f, id, 0, 0, UINT64_MAX);
    assert_int_equal(fail_all(&f, id, 0), 1);
    fixture_feed(&f, id, 0, 1199, UINT64_MAX);
    CHECK_STATE(&f, id, 0, GIVEN_UP);
    fixture_feed(&f, id, 0, 1200, UINT64_MAX);
    CHECK_STATE(&f, id, 0, REQUESTED);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(back_off_doubles_from_failure_to_failure),
        cmocka_unit_test(the_slot_of_a_failed_load_is_free_at_once),
        cmocka_unit_test(any_call_with_a_time_stamp_makes_due_retries_requested),
        cmocka_unit_test(a_refused_call_retries_nothing),
        cmocka_unit_test(five_attempts_are_the_default),
        cmocka_unit_test(a_tile_given_up_is_listed_once),
        cmocka_unit_test(a_tile_given_up_again_and_again_is_in_the_list_once),
        cmocka_unit_test(the_given_up_list_outlives_the_want_but_not_the_texture),
        cmocka_unit_test(a_tile_no_longer_wanted_forgets_its_failures),
        cmocka_unit_test(a_tile_that_was_mapped_forgets_its_failures),
        cmocka_unit_test(retry_requests_failed_tiles_then_those_given_up),
        cmocka_unit_test(a_region_stays_at_the_coarser_mip_of_what_loaded),
        cmocka_unit_test(the_longest_delays_do_not_overflow),
        cmocka_unit_test(all_that_is_given_up_is_listed_in_order),
        cmocka_unit_test(given_up_tiles_are_probed_and_follow_the_first_that_comes),
        cmocka_unit_test(tiles_damaged_for_good_do_not_hide_those_that_come_back),
        cmocka_unit_test(another_tile_that_comes_is_a_sign_that_the_source_is_well),
        cmocka_unit_test(probes_of_many_textures_are_bounded),
        cmocka_unit_test(a_texture_that_is_removed_while_it_rests_is_not_probed),
        cmocka_unit_test(without_a_delay_given_up_tiles_wait_for_a_call),
        cmocka_unit_test(the_default_delay_is_120_times_that_of_retries),
        cmocka_unit_test(packed_tiles_are_probed_together),
    };
    return RUN_TESTS(tests);
}
