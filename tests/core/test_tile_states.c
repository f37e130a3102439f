#include "core/fixture.h"

#include <string.h>

static void pass(struct fixture *f, SluiceTextureId id, uint64_t time)
{
    fixture_feed(f, id, SLUICE_MIP_UNTOUCHED, time, 0);
}

static void map_one(struct fixture *f, SluiceTextureId id, uint32_t tile)
{
    CHECK_OK(sluiceUpdateTilesMapping(f->manager, id, 1, &tile));
}

static void a_request_no_longer_wanted_is_free_again(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 0, 0);
    for (uint32_t i = 0; i < 6; i++)
        CHECK_STATE(&f, id, i, REQUESTED);
    assert_int_equal(fixture_statistics(&f).requestedTileCount, 6);
    pass(&f, id, 1);
    for (uint32_t i = 0; i < 6; i++)
        CHECK_STATE(&f, id, i, FREE);
    assert_int_equal(fixture_statistics(&f).requestedTileCount, 0);
    CHECK_OK(fixture_to_map(&f, id));
    assert_int_equal(f.count, 0);
    assert_int_equal(f.heaps.asked, 0);
    fixture_close(&f);
}

static void a_canceled_load_is_never_mapped_and_its_memory_comes_back(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 0, 0);
    CHECK_OK(fixture_to_map(&f, id));
    assert_int_equal(f.count, 6);
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 10);
    pass(&f, id, 1);
    for (uint32_t i = 0; i < 6; i++)
        CHECK_STATE(&f, id, i, CANCELED);
    CHECK_OK(fixture_to_cancel(&f, id));
    /* each region drops its tile of the held level; the last one closes the parent; then packed */
    assert_true(LISTED(&f, id, 0, 1, 2, 3, 4, 5));
    CHECK_OK(fixture_to_cancel(&f, id));
    assert_int_equal(f.count, 0); /* each once */
    const uint32_t all[] = {0, 1, 2, 3, 4, 5};
    CHECK_OK(sluiceReportCanceledTiles(f.manager, id, 6, all, 0));
    SluiceStreamedTextureStatistics s = fixture_statistics(&f);
    assert_int_equal(s.freeSlotCount, 16);
    assert_int_equal(s.mappedTotal, 0);
    assert_int_equal(s.canceledTotal, 6);
    for (uint32_t i = 0; i < 6; i++)
        CHECK_STATE(&f, id, i, FREE);
    fixture_close(&f);
}

static void wanted_again_before_the_cancel_list_is_read_goes_on_loading(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 0, 0);
    CHECK_OK(fixture_to_map(&f, id));
    SluiceTile before = fixture_tile(&f, id, 0);
    pass(&f, id, 1);
    fixture_feed(&f, id, 0, 2, 0);
    for (uint32_t i = 0; i < 6; i++)
        CHECK_STATE(&f, id, i, ALLOCATED);
    CHECK_OK(fixture_to_cancel(&f, id));
    assert_int_equal(f.count, 0);
    SluiceTile after = fixture_tile(&f, id, 0);
    assert_true(after.heapId == before.heapId && after.slot == before.slot);
    map_one(&f, id, 0);
    CHECK_STATE(&f, id, 0, MAPPED);
    fixture_close(&f);
}

/* Tile 0 is listed for canceling and wanted again. Takes three units of time. */
static SluiceTextureId cancel_and_want_again(struct fixture *f, uint64_t time)
{
    SluiceTextureId id = fixture_add_small(f);
    fixture_feed_region(f, id, 0, 0, time, 0);
    CHECK_OK(fixture_to_map(f, id));
    pass(f, id, time + 1);
    CHECK_OK(fixture_to_cancel(f, id));
    assert_int_equal(f->count, 3);
    fixture_feed_region(f, id, 0, 0, time + 2, 0);
    CHECK_STATE(f, id, 0, CANCELED);
    CHECK_OK(fixture_to_cancel(f, id));
    assert_int_equal(f->count, 0);
    return id;
}

static void wanted_again_after_the_listing_waits_for_the_answer(void **state)
{
    (void)state;
    struct fixture f;
    uint32_t tile = 0;
    fixture_open(&f, 16, false);
    SluiceTextureId id = cancel_and_want_again(&f, 0);
    CHECK_OK(sluiceReportCanceledTiles(f.manager, id, 1, &tile, 0));
    CHECK_STATE(&f, id, 0, REQUESTED);
    id = cancel_and_want_again(&f, 10); /* answered as mapped: it came in time */
    map_one(&f, id, tile);
    CHECK_STATE(&f, id, 0, MAPPED);
    id = cancel_and_want_again(&f, 20);
    CHECK_OK(sluiceReportFailedTiles(f.manager, id, 1, &tile, 22));
    CHECK_STATE(&f, id, 0, FAILED);
    id = cancel_and_want_again(&f, 30); /* and unwanted once more: forgotten */
    pass(&f, id, 33);
    CHECK_OK(fixture_to_cancel(&f, id));
    assert_int_equal(f.count, 0);
    CHECK_OK(sluiceReportCanceledTiles(f.manager, id, 1, &tile, 0));
    CHECK_STATE(&f, id, 0, FREE);
    fixture_close(&f);
}

static void a_canceled_tile_whose_data_arrived_is_standby(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    fixture_configure(&f, 10, 0, 0, 0);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed_region(&f, id, 0, 0, 0, 0);
    CHECK_OK(fixture_to_map(&f, id));
    pass(&f, id, 1);
    uint32_t tile = 0;
    map_one(&f, id, tile); /* not listed yet: it may be answered all the same */
    CHECK_STATE(&f, id, 0, STANDBY);
    CHECK_OK(fixture_to_cancel(&f, id));
    assert_true(LISTED(&f, id, 4, 5));
    tile = 4;
    CHECK_OK(sluiceReportFailedTiles(f.manager, id, 1, &tile, 1)); /* unwanted: no failure kept */
    CHECK_STATE(&f, id, 4, FREE);
    assert_int_equal(fixture_statistics(&f).failedTileCount, 0);
    fixture_close(&f);
}

static void allocated_tiles_may_be_answered_as_canceled(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed_region(&f, id, 0, 0, 0, 0);
    CHECK_OK(fixture_to_map(&f, id));
    uint32_t tile = 0;
    CHECK_OK(sluiceReportCanceledTiles(f.manager, id, 1, &tile, 0));
    CHECK_STATE(&f, id, 0, REQUESTED); /* still wanted */
    CHECK_OK(fixture_to_map(&f, id));
    assert_true(LISTED(&f, id, 0));
    fixture_close(&f);
}

static SluiceTextureId all_standby(struct fixture *f, uint32_t keep)
{
    fixture_open(f, 16, false);
    fixture_configure(f, keep, 0, 0, 0);
    SluiceTextureId id = fixture_add_small(f);
    fixture_feed(f, id, 0, 0, 0);
    fixture_load(f);
    pass(f, id, 1);
    for (uint32_t i = 0; i < 6; i++)
        CHECK_STATE(f, id, i, STANDBY);
    return id;
}

static void standby_is_restored_without_a_load(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = all_standby(&f, 10);
    CHECK_OK(fixture_to_unmap(&f, id, 0));
    assert_int_equal(f.count, 0);
    fixture_feed(&f, id, 0, 2, 0);
    for (uint32_t i = 0; i < 6; i++)
        CHECK_STATE(&f, id, i, MAPPED);
    SluiceStreamedTextureStatistics s = fixture_statistics(&f);
    assert_int_equal(s.restoredTotal, 6);
    assert_int_equal(s.handedOutTotal, 6);
    assert_int_equal(s.mappedTotal, 6);
    CHECK_OK(fixture_to_map(&f, id));
    assert_int_equal(f.count, 0);
    fixture_close(&f);
}

static void standby_beyond_the_extra_is_listed_oldest_first(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = all_standby(&f, 2);
    assert_int_equal(fixture_statistics(&f).standbyTileCount, 6); /* until they are handed out */
    CHECK_OK(fixture_to_unmap(&f, id, 0));
    assert_true(LISTED(&f, id, 0, 1, 2, 3)); /* 4 closed with the last of them, 5 follows */
    for (uint32_t i = 0; i < 4; i++)
        CHECK_STATE(&f, id, i, FREE);
    CHECK_STATE(&f, id, 4, STANDBY);
    CHECK_STATE(&f, id, 5, STANDBY);
    assert_int_equal(fixture_statistics(&f).unmappedTotal, 4);
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 14);
    fixture_configure(&f, 0, 0, 0, 0); /* takes effect at once */
    CHECK_OK(fixture_to_unmap(&f, id, 0));
    assert_true(LISTED(&f, id, 4, 5));
    fixture_close(&f);
}

static void standby_ages_by_when_it_was_last_wanted(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    fixture_configure(&f, 16, 0, 0, 0);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 0, 0);
    fixture_load(&f);
    const uint8_t maps[][4] = {
        {0, 0, 1, 0}, {1, 0, 1, 0}, {1, 1, 1, 0}, {0, 1, 1, 0}, {1, 1, 1, 1}};
    for (uint32_t i = 0; i < 5; i++)
        fixture_feed_map(&f, id, maps[i], 1 + i, 0);
    /* 2, 0, 1 became standby, 0 was restored, then 0 and 3 followed */
    CHECK_OK(sluiceTrimStandbyTiles(f.manager, 0));
    CHECK_OK(fixture_to_unmap(&f, id, 0));
    assert_true(LISTED(&f, id, 2, 1, 0, 3));
    fixture_close(&f);
}

static void listed_for_unmapping_and_wanted_again_is_mapped_again(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = all_standby(&f, 0);
    uint32_t count = 0;
    CHECK_OK(sluiceGetTilesToUnmap(f.manager, id, 0, &count, NULL));
    assert_int_equal(count, 6);
    fixture_feed_region(&f, id, 0, 0, 2, 0);
    CHECK_STATE(&f, id, 0, MAPPED);
    CHECK_OK(fixture_to_unmap(&f, id, 0));
    assert_true(LISTED(&f, id, 1, 2, 3));
    assert_int_equal(fixture_statistics(&f).restoredTotal, 3);
    fixture_close(&f);
}

static void trim_lists_the_oldest_down_to_what_is_kept(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = all_standby(&f, 100);
    CHECK_OK(sluiceTrimStandbyTiles(f.manager, 100));
    CHECK_OK(fixture_to_unmap(&f, id, 0));
    assert_int_equal(f.count, 0);
    CHECK_OK(sluiceTrimStandbyTiles(f.manager, 4));
    CHECK_OK(sluiceTrimStandbyTiles(f.manager, 4)); /* listed tiles do not count again */
    CHECK_OK(fixture_to_unmap(&f, id, 0));
    assert_true(LISTED(&f, id, 0, 1));
    CHECK_OK(sluiceTrimStandbyTiles(f.manager, 0));
    CHECK_OK(fixture_to_unmap(&f, id, 0));
    assert_true(LISTED(&f, id, 2, 3, 4, 5));
    assert_int_equal(fixture_statistics(&f).standbyTileCount, 0);
    fixture_close(&f);
}

static void lists_hand_out_what_there_is_room_for(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = all_standby(&f, 0);
    SluiceTile tiles[8];
    uint32_t count = 4;
    CHECK_RESULT(sluiceGetTilesToUnmap(f.manager, id, 0, &count, tiles), SLUICE_INCOMPLETE);
    assert_int_equal(count, 4);
    count = 0; /* no room at all */
    CHECK_RESULT(sluiceGetTilesToUnmap(f.manager, id, 0, &count, tiles), SLUICE_INCOMPLETE);
    count = 2; /* exactly the rest */
    CHECK_OK(sluiceGetTilesToUnmap(f.manager, id, 0, &count, tiles));
    assert_int_equal(count, 2);
    fixture_feed(&f, id, 0, 2, 0);
    CHECK_RESULT(fixture_to_map_at_most(&f, id, 5), SLUICE_INCOMPLETE);
    pass(&f, id, 3); /* the sixth is free again, five are canceled */
    count = 3;
    CHECK_RESULT(sluiceGetTilesToCancel(f.manager, id, &count, tiles), SLUICE_INCOMPLETE);
    assert_int_equal(count, 3);
    CHECK_OK(sluiceGetTilesToCancel(f.manager, id, &count, tiles));
    assert_int_equal(count, 2);
    fixture_close(&f);
}

/* Checks the statistics of a texture whose regions are 2x2: level 0 has tiles 0 to 3, level 1 has
 * 4, 5 is packed. */
static void check_wanted(const struct fixture *f, SluiceTextureId id,
                         const SluiceTextureStatistics *s)
{
    uint8_t requested[4];
    uint32_t wanted = 0;
    CHECK_OK(sluiceWriteRequestedLevels(f->manager, id, 2, 4, requested));
    for (uint32_t i = 0; i < 4; i++)
        wanted += requested[i] == 0;
    const bool any = memcmp(requested, "\377\377\377\377", 4) != 0;
    for (uint32_t i = 0, found = 0; i < 4 && !found; i++)
        wanted += found = requested[i] <= 1;
    assert_int_equal(s->wantedTileCount, wanted + any);
    assert_int_equal(s->wantedSize, (wanted + any) * (uint64_t)65536);
}

/* Checks that each resident tile is in its slot, and that each used slot has its tile. */
static void check_slots(const struct fixture *f, const SluiceTextureId *ids, uint32_t count)
{
    uint32_t used = 0, placed = 0;
    for (uint32_t heap = 0; heap < FIXTURE_HEAPS; heap++)
        for (uint32_t slot = 0; f->heaps.living[heap] && slot < 4; slot++) {
            SluiceTile tile;
            CHECK_OK(sluiceGetSlotTile(f->manager, heap, slot, &tile));
            assert_true(tile.heapId == heap && tile.slot == slot);
            if (tile.textureId == SLUICE_NO_TEXTURE)
                continue;
            const SluiceTile same = fixture_tile(f, tile.textureId, tile.tileIndex);
            assert_memory_equal(&same, &tile, sizeof tile);
            used++;
        }
    for (uint32_t k = 0; k < count; k++)
        for (uint32_t i = 0; i < fixture_layout(f, ids[k]).tileCount; i++) {
            SluiceTileState is = fixture_state(f, ids[k], i);
            placed += is == SLUICE_TILE_STATE_MAPPED || is == SLUICE_TILE_STATE_STANDBY;
        }
    assert_int_equal(used, placed); /* nothing is being loaded */
    SluiceTile tile;
    CHECK_RESULT(sluiceGetSlotTile(f->manager, 0, 4, &tile), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceGetSlotTile(f->manager, 200, 0, &tile), SLUICE_ERROR_UNKNOWN_HEAP);
}

/* Checks sums against the states of all tiles, and against the manager's totals. */
static void check_sums(const struct fixture *f, const SluiceTextureId *ids, uint32_t count)
{
    const SluiceStreamedTextureStatistics all = fixture_statistics(f);
    uint64_t mapped = 0, unmapped = 0, failed = 0;
    for (uint32_t k = 0; k < count; k++) {
        SluiceTextureStatistics s = {.structSize = sizeof s};
        CHECK_OK(sluiceGetTextureStatistics(f->manager, ids[k], &s));
        uint32_t states[8] = {0};
        for (uint32_t i = 0; i < fixture_layout(f, ids[k]).tileCount; i++)
            states[fixture_state(f, ids[k], i)]++;
        uint32_t resident = 0, wanted = 0, tiles = 0;
        for (uint32_t l = 0; l <= fixture_layout(f, ids[k]).desc.regularMipCount; l++) {
            SluiceTextureLevelStatistics level = {.structSize = sizeof level};
            CHECK_OK(sluiceGetTextureLevelStatistics(f->manager, ids[k], l, &level));
            uint32_t here = 0;
            for (uint32_t i = 0; i < fixture_layout(f, ids[k]).tileCount; i++) {
                SluiceTileState is = fixture_state(f, ids[k], i);
                here += fixture_tile(f, ids[k], i).mipLevel == l &&
                        (is == SLUICE_TILE_STATE_MAPPED || is == SLUICE_TILE_STATE_STANDBY);
            }
            assert_int_equal(level.residentTileCount, here);
            assert_int_equal(level.residentSize, here * (uint64_t)65536);
            assert_int_equal(level.wantedSize, level.wantedTileCount * (uint64_t)65536);
            resident += here, wanted += level.wantedTileCount, tiles += level.tileCount;
        }
        assert_int_equal(resident, s.residentTileCount);
        assert_int_equal(wanted, s.wantedTileCount);
        assert_int_equal(tiles, fixture_layout(f, ids[k]).tileCount);
        assert_int_equal(s.residentTileCount,
                         states[SLUICE_TILE_STATE_MAPPED] + states[SLUICE_TILE_STATE_STANDBY]);
        assert_int_equal(s.requestedTileCount, states[SLUICE_TILE_STATE_REQUESTED]);
        assert_int_equal(s.residentSize, s.residentTileCount * (uint64_t)65536);
        check_wanted(f, ids[k], &s);
        mapped += s.mappedTotal, unmapped += s.unmappedTotal, failed += s.failedTotal;
    }
    assert_true(mapped == all.mappedTotal && unmapped == all.unmappedTotal);
    assert_true(failed == all.failedTotal);
}

static void statistics_of_textures_add_up(void **state)
{
    (void)state;
    struct fixture f;
    enum { COUNT = 4 };
    SluiceTextureId ids[COUNT];
    uint64_t random = 3, seen[COUNT] = {0};
    fixture_open(&f, 4, false);
    fixture_configure(&f, 3, 0, 3, 2);
    f.heaps.limit = 3;
    for (uint32_t k = 0; k < COUNT; k++)
        ids[k] = fixture_add_small(&f);
    for (uint64_t time = 1; time <= 300; time++) {
        uint32_t k = next_random(&random) % COUNT, level = next_random(&random) % 4;
        fixture_feed(&f, ids[k], level < 3 ? (uint8_t)level : SLUICE_MIP_UNTOUCHED, time, 2);
        seen[k] = level < 3 ? time : seen[k];
        CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
        assert_true(fixture_to_map(&f, SLUICE_ALL_TEXTURES) >= 0);
        for (uint32_t i = 0; i < f.count; i++)
            CHECK_OK(next_random(&random) % 4
                         ? sluiceUpdateTilesMapping(f.manager, f.tiles[i].textureId, 1,
                                                    &f.tiles[i].tileIndex)
                         : sluiceReportFailedTiles(f.manager, f.tiles[i].textureId, 1,
                                                   &f.tiles[i].tileIndex, time));
        check_sums(&f, ids, COUNT);
        if (f.heaps.living_count > 0)
            check_slots(&f, ids, COUNT);
        SluiceTextureStatistics s = {.structSize = sizeof s};
        const uint64_t calls = f.memory.calls;
        CHECK_OK(sluiceGetTextureStatistics(f.manager, ids[k], &s));
        assert_true(s.seenTime == seen[k] && s.seen == (seen[k] > 0) && f.memory.calls == calls);
        assert_true(s.wanted || level == 3);
    }
    assert_true(fixture_statistics(&f).unmappedTotal > 20 &&
                fixture_statistics(&f).failedTotal > 20);
    fixture_close(&f);
}

enum { EVENT_TEXTURES = 4, EVENT_TILES = 6 };

/* Makes a random step of a manager with few slots: loads arrive, fail and are canceled; tiles are
 * evicted. */
static void random_step(struct fixture *f, const SluiceTextureId *ids, uint64_t time,
                        uint64_t *random)
{
    const uint32_t k = next_random(random) % EVENT_TEXTURES, level = next_random(random) % 4;
    fixture_feed(f, ids[k], level < 3 ? (uint8_t)level : SLUICE_MIP_UNTOUCHED, time, 2);
    CHECK_OK(fixture_to_cancel(f, SLUICE_ALL_TEXTURES));
    CHECK_OK(fixture_to_unmap(f, SLUICE_ALL_TEXTURES, 0));
    if (next_random(random) % 8 == 0)
        CHECK_OK(sluiceEvictStreamedTexture(f->manager, ids[(k + 1) % EVENT_TEXTURES], 1));
    if (next_random(random) % 16 == 0)
        CHECK_OK(sluiceRetryFailedTiles(f->manager, SLUICE_ALL_TEXTURES));
    assert_true(fixture_to_map(f, SLUICE_ALL_TEXTURES) >= 0);
    for (uint32_t i = 0; i < f->count; i++) {
        const SluiceTile *t = &f->tiles[i];
        const uint32_t choice = next_random(random) % 8;
        if (choice == 0)
            CHECK_OK(sluiceReportCanceledTiles(f->manager, t->textureId, 1, &t->tileIndex, 0));
        else if (choice < 3)
            CHECK_OK(sluiceReportFailedTiles(f->manager, t->textureId, 1, &t->tileIndex, time));
        else if (choice < 7)
            CHECK_OK(sluiceUpdateTilesMapping(f->manager, t->textureId, 1, &t->tileIndex));
        else /* while it is being loaded */
            CHECK_OK(sluiceEvictStreamedTexture(f->manager, t->textureId, UINT32_MAX));
    }
    for (uint32_t i = 0; i < EVENT_TEXTURES; i++)
        for (uint32_t tile = 0; tile < EVENT_TILES; tile++) {
            SluiceTileState is = fixture_state(f, ids[i], tile);
            if (is == SLUICE_TILE_STATE_ALLOCATED || is == SLUICE_TILE_STATE_CANCELED)
                CHECK_OK(sluiceUpdateTilesMapping(f->manager, ids[i], 1, &tile));
        }
}

static void open_for_events(struct fixture *f, SluiceTextureId *ids, uint32_t capacity)
{
    fixture_open(f, 4, true);
    fixture_configure(f, 3, 0, 3, 2);
    f->heaps.limit = 3;
    CHECK_OK(sluiceSetTileEventCapacity(f->manager, capacity));
    CHECK_OK(sluiceMarkTileEvents(f->manager, 1001));
    for (uint32_t k = 0; k < EVENT_TEXTURES; k++)
        ids[k] = fixture_add_small(f);
}

/* Tracks the states of all tiles by events alone. */
static void follow_events(const struct fixture *f, uint64_t *cursor, uint64_t time,
                          SluiceTileState states[EVENT_TEXTURES][EVENT_TILES], uint32_t reasons[10])
{
    SluiceTileEvent events[7];
    for (SluiceResult more = SLUICE_INCOMPLETE; more == SLUICE_INCOMPLETE;) {
        uint32_t count = 7;
        uint64_t lost = 1;
        more = sluiceReadTileEvents(f->manager, cursor, &count, events, &lost);
        assert_true(more >= 0 && lost == 0 && (count == 7 || more == SLUICE_SUCCESS));
        for (uint32_t i = 0; i < count; i++) {
            const SluiceTileEvent *e = &events[i];
            SluiceTileState *is = &states[(uint32_t)e->textureId][e->tileIndex];
            assert_true(e->from == *is && e->to != *is && e->mark == 1000 + time);
            assert_true(e->timeStamp == time || e->timeStamp + 1 == time);
            *is = e->to;
            reasons[e->reason]++;
        }
    }
}

static void events_tell_all_changes_of_states(void **state)
{
    (void)state;
    struct fixture with, without;
    SluiceTextureId ids[EVENT_TEXTURES], same[EVENT_TEXTURES];
    SluiceTileState states[EVENT_TEXTURES][EVENT_TILES] = {{0}};
    uint64_t random = 9, again = 9, cursor = 0;
    uint32_t reasons[10] = {0};
    open_for_events(&with, ids, 200);
    open_for_events(&without, same, 0);
    for (uint64_t time = 1; time <= 400; time++) {
        const uint64_t calls = with.memory.calls;
        CHECK_OK(sluiceMarkTileEvents(with.manager, 1000 + time));
        assert_int_equal(calls, with.memory.calls);
        random_step(&with, ids, time, &random);
        random_step(&without, same, time, &again);
        follow_events(&with, &cursor, time, states, reasons);
        for (uint32_t i = 0; i < EVENT_TEXTURES * EVENT_TILES; i++)
            assert_int_equal(states[i / EVENT_TILES][i % EVENT_TILES],
                             fixture_state(&with, ids[i / EVENT_TILES], i % EVENT_TILES));
        assert_true(fixture_digest(&with, EVENT_TEXTURES, ids) ==
                    fixture_digest(&without, EVENT_TEXTURES, same));
    }
    CHECK_OK(sluiceRemoveStreamedTexture(with.manager, ids[1], 0));
    follow_events(&with, &cursor, 400, states, reasons);
    for (uint32_t i = 0; i < EVENT_TILES; i++)
        assert_int_equal(states[1][i], SLUICE_TILE_STATE_FREE);
    for (uint32_t i = 0; i < 10; i++)
        assert_true(reasons[i] > 0 || i == SLUICE_TILE_EVENT_PREFETCHED);
    fixture_close(&without);
    fixture_close(&with);
}

static void events_that_are_overwritten_are_counted(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId ids[EVENT_TEXTURES];
    SluiceTileEvent events[8];
    open_for_events(&f, ids, 3); /* each texture requests its packed tile: four events */
    uint64_t cursor = 0, lost = 0, late = 2;
    uint32_t count = 1;
    CHECK_RESULT(sluiceReadTileEvents(f.manager, &cursor, &count, events, &lost),
                 SLUICE_INCOMPLETE);
    assert_true(cursor == 2 && lost == 1 && count == 1 && events[0].textureId == ids[1]);
    assert_true(events[0].tileIndex == 5 && events[0].to == SLUICE_TILE_STATE_REQUESTED);
    assert_int_equal(events[0].reason, SLUICE_TILE_EVENT_ADDED);
    count = 8;
    CHECK_OK(sluiceReadTileEvents(f.manager, &late, &count, events, NULL)); /* another reader */
    assert_true(late == 4 && count == 2 && events[1].textureId == ids[3]);
    cursor = 5;
    CHECK_RESULT(sluiceReadTileEvents(f.manager, &cursor, &count, events, &lost),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_OK(sluiceSetTileEventCapacity(f.manager, 5)); /* drops the stored events */
    cursor = 3, count = 8;
    CHECK_OK(sluiceReadTileEvents(f.manager, &cursor, &count, events, &lost));
    assert_true(cursor == 4 && count == 0 && lost == 1);
    CHECK_RESULT(sluiceSetTileEventCapacity(f.manager, SLUICE_MAX_TILE_EVENTS + 1),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    fixture_load(&f);
    count = 8;
    CHECK_OK(sluiceReadTileEvents(f.manager, &cursor, &count, events, &lost));
    assert_true(count == 5 && lost == 3 && cursor == 12);
    fixture_close(&f);
}

static void events_survive_a_refused_allocation(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId ids[EVENT_TEXTURES];
    SluiceTileEvent events[8];
    open_for_events(&f, ids, 8);
    f.memory.refuse_from = f.memory.calls;
    CHECK_RESULT(sluiceSetTileEventCapacity(f.manager, 100), SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    uint64_t cursor = 0;
    uint32_t count = 8;
    CHECK_OK(sluiceReadTileEvents(f.manager, &cursor, &count, events, NULL));
    assert_int_equal(count, 4);
    CHECK_OK(sluiceSetTileEventCapacity(f.manager, 0));
    f.memory.refuse_from = UINT64_MAX;
    fixture_feed(&f, ids[0], 0, 1, 0);
    CHECK_OK(sluiceReadTileEvents(f.manager, &cursor, &count, events, NULL));
    assert_int_equal(count, 0);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_request_no_longer_wanted_is_free_again),
        cmocka_unit_test(a_canceled_load_is_never_mapped_and_its_memory_comes_back),
        cmocka_unit_test(wanted_again_before_the_cancel_list_is_read_goes_on_loading),
        cmocka_unit_test(wanted_again_after_the_listing_waits_for_the_answer),
        cmocka_unit_test(a_canceled_tile_whose_data_arrived_is_standby),
        cmocka_unit_test(allocated_tiles_may_be_answered_as_canceled),
        cmocka_unit_test(standby_is_restored_without_a_load),
        cmocka_unit_test(standby_beyond_the_extra_is_listed_oldest_first),
        cmocka_unit_test(standby_ages_by_when_it_was_last_wanted),
        cmocka_unit_test(listed_for_unmapping_and_wanted_again_is_mapped_again),
        cmocka_unit_test(trim_lists_the_oldest_down_to_what_is_kept),
        cmocka_unit_test(lists_hand_out_what_there_is_room_for),
        cmocka_unit_test(statistics_of_textures_add_up),
        cmocka_unit_test(events_tell_all_changes_of_states),
        cmocka_unit_test(events_that_are_overwritten_are_counted),
        cmocka_unit_test(events_survive_a_refused_allocation),
    };
    return RUN_TESTS(tests);
}
