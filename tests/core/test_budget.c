#include "core/fixture.h"

static void pass(struct fixture *f, SluiceTextureId id, uint64_t time)
{
    fixture_feed(f, id, SLUICE_MIP_UNTOUCHED, time, 0);
}

/* Opens heaps of 6 slots, at most `limit`. The first texture fills one of them. */
static SluiceTextureId open_full(struct fixture *f, uint32_t limit)
{
    fixture_open(f, 6, false);
    fixture_configure(f, 100, 0, 0, 0);
    f->heaps.limit = limit;
    SluiceTextureId id = fixture_add_small(f);
    fixture_feed(f, id, 0, 0, 0);
    fixture_load(f);
    assert_int_equal(fixture_statistics(f).mappedTileCount, 6);
    return id;
}

static void heaps_are_asked_for_one_by_one_when_slots_are_needed(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = open_full(&f, 10);
    assert_int_equal(f.heaps.asked, 1);
    assert_true(f.heaps.size == 6 * (uint64_t)SLUICE_DEFAULT_TILE_SIZE);
    SluiceTextureId more[2] = {fixture_add_small(&f), fixture_add_small(&f)};
    assert_int_equal(f.heaps.asked, 1);
    fixture_feed(&f, more[0], 0, 1, 0);
    fixture_feed_region(&f, more[1], 0, 0, 1, 0);
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f.count, 9);
    assert_int_equal(f.heaps.asked, 3);
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 3);
    CHECK_STATE(&f, id, 0, MAPPED);
    fixture_close(&f);
}

static void a_refusal_is_the_budget_and_is_heard_once_per_call(void **state)
{
    (void)state;
    struct fixture f;
    open_full(&f, 1);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 1, 0);
    for (uint32_t i = 1; i < 4; i++) {
        CHECK_RESULT(fixture_to_map(&f, id), SLUICE_BUDGET_REACHED);
        assert_int_equal(f.count, 0);
        assert_int_equal(f.heaps.refused, i);
        CHECK_STATE(&f, id, 0, REQUESTED);
    }
    uint32_t count = 0;
    CHECK_OK(sluiceGetTilesToMap(f.manager, id, &count, NULL)); /* a query requests no heap */
    assert_int_equal(count, 6);
    assert_int_equal(f.heaps.refused, 3);
    f.heaps.limit = 2; /* there is room after all */
    CHECK_OK(fixture_to_map(&f, id));
    assert_int_equal(f.count, 6);
    fixture_close(&f);
}

static void what_fits_is_handed_out_before_the_budget_is_reached(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 4, false);
    f.heaps.limit = 1;
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 0, 0);
    CHECK_RESULT(fixture_to_map(&f, id), SLUICE_BUDGET_REACHED);
    assert_true(LISTED(&f, id, 5, 4, 0, 1));
    CHECK_STATE(&f, id, 2, REQUESTED);
    fixture_close(&f);
}

static void the_heap_cap_is_kept_without_asking(void **state)
{
    (void)state;
    struct fixture f;
    open_full(&f, 10);
    fixture_configure(&f, 0, 1, 0, 0);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 1, 0);
    CHECK_RESULT(fixture_to_map(&f, id), SLUICE_BUDGET_REACHED);
    assert_int_equal(f.heaps.asked, 1);
    fixture_configure(&f, 0, 2, 0, 0);
    CHECK_OK(fixture_to_map(&f, id));
    assert_int_equal(f.heaps.asked, 2);
    fixture_configure(&f, 0, 1, 0, 0); /* below the number of living heaps: releases none */
    assert_int_equal(f.heaps.living_count, 2);
    fixture_close(&f);
}

static void wanted_tiles_make_room_for_coarser_requests_only(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId full = open_full(&f, 1), id = fixture_add_small(&f);
    uint64_t loads = 0;
    for (uint64_t time = 1; time < 30; time++) {
        fixture_feed(&f, full, 0, time, 4);
        fixture_feed(&f, id, 0, time, 4);
        CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
        loads += f.count;
        CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
        fixture_answer_mapped(&f);
    }
    assert_int_equal(loads, 2); /* two evictions of level 0 made room, and no more */
    CHECK_STATE(&f, id, 5, MAPPED);
    CHECK_STATE(&f, id, 4, MAPPED);
    CHECK_STATE(&f, full, 5, MAPPED);
    CHECK_STATE(&f, full, 4, MAPPED);
    for (uint32_t i = 0; i < 4; i++)
        CHECK_STATE(&f, id, i, REQUESTED);
    fixture_close(&f);
}

static void a_texture_that_gets_no_more_maps_gives_way(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId full = open_full(&f, 1), id = fixture_add_small(&f);
    fixture_feed(&f, full, 0, 10, 4);
    for (uint64_t time = 11; time < 30; time++) {
        fixture_feed(&f, id, 0, time, 4);
        CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
        CHECK_STATE(&f, full, 5, MAPPED); /* its maps were 10 apart: less than 40 is not long */
    }
    fixture_feed(&f, id, 0, 50, 4);
    CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
    CHECK_STATE(&f, full, 5, MAPPED); /* no map came for 21 anywhere, so 40 is still not long */
    fixture_feed(&f, id, 0, 51, 4);
    CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
    CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
    assert_true(LISTED(&f, full, 0, 1, 2, 3, 4, 5));
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f.count, 6);
    fixture_close(&f);
}

/* With 16 slots or more, one in 16 is reserved, so that new textures show something at once. */
static void the_last_slots_are_for_packed_tiles(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 32, false);
    f.heaps.limit = 1;
    SluiceStreamedTextureDesc desc = full_chain(1024, 1024, 128, 128);
    SluiceTextureId big = fixture_add(&f, &desc), id = fixture_add_small(&f);
    fixture_feed(&f, big, 0, 0, 10);
    CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
    assert_int_equal(f.count, 30);
    assert_int_equal(fixture_statistics(&f).reservedSlotCount, 2);
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 2);
    fixture_feed(&f, id, 0, 0, 10);
    CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
    assert_true(LISTED(&f, id, 5));
    fixture_close(&f);
}

static void the_global_bias_rises_with_the_demand_and_falls_with_the_budget(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 32, false);
    fixture_configure(&f, 0, 1, 0, 0);
    SluiceStreamedTextureDesc desc = full_chain(2048, 2048, 128, 128); /* 341 tiles and one */
    SluiceTextureId id = fixture_add(&f, &desc);
    uint64_t time = 0;
    fixture_feed(&f, id, 0, time++, 0);
    assert_int_equal(fixture_statistics(&f).requestedTileCount, 342);
    for (uint32_t i = 0; i < 40; i++) {
        fixture_feed(&f, id, 0, time++, 0);
        assert_true(fixture_to_map(&f, SLUICE_ALL_TEXTURES) >= 0);
    }
    SluiceStreamedTextureStatistics s = fixture_statistics(&f);
    assert_true(s.globalMipBias > 0 && s.requestedTileCount + s.allocatedTileCount <= 3 * 32);
    fixture_configure(&f, 0, 16, 0, 0);
    for (uint32_t i = 0; i < 100; i++) {
        fixture_feed(&f, id, 0, time++, 0);
        assert_true(fixture_to_map(&f, SLUICE_ALL_TEXTURES) >= 0);
    }
    s = fixture_statistics(&f);
    assert_int_equal(s.globalMipBias, 0);
    assert_int_equal(s.requestedTileCount + s.allocatedTileCount, 342);
    fixture_close(&f);
}

/* Eight textures request far too much, until only a small one is visible. */
static void check_bias_after_a_cut(uint64_t cut)
{
    struct fixture f;
    fixture_open(&f, 16, true);
    fixture_configure(&f, 0, 6, 0, 0);
    SluiceStreamedTextureDesc large = full_chain(1024, 1024, 32, 32);
    SluiceTextureId forest[8], wall = fixture_add_small(&f);
    for (uint32_t i = 0; i < 8; i++)
        forest[i] = fixture_add(&f, &large);
    for (uint64_t time = 1; time < 150; time++) {
        for (uint32_t i = 0; i < 8; i++)
            fixture_feed(&f, forest[i], time < cut ? 0 : SLUICE_MIP_UNTOUCHED, time, 2);
        fixture_feed(&f, wall, 0, time, 2);
        CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, time));
        CHECK_OK(sluiceCompleteRetireValue(f.manager, time));
        assert_true(fixture_to_map(&f, SLUICE_ALL_TEXTURES) >= 0);
        fixture_answer_mapped(&f);
        if (time == cut - 1)
            assert_true(fixture_statistics(&f).globalMipBias > 0);
    }
    assert_int_equal(fixture_statistics(&f).globalMipBias, 0);
    CHECK_STATE(&f, wall, 0, MAPPED);
    fixture_close(&f);
}

static void the_global_bias_goes_when_the_demand_does_whenever_that_is(void **state)
{
    (void)state;
    for (uint64_t cut = 2; cut < 30; cut++)
        check_bias_after_a_cut(cut);
}

static uint32_t listed_for_unmapping(const struct fixture *f)
{
    uint32_t count = 0;
    CHECK_OK(sluiceGetTilesToUnmap(f->manager, SLUICE_ALL_TEXTURES, 0, &count, NULL));
    return count;
}

static void standby_is_evicted_oldest_first_as_many_as_needed(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId full = open_full(&f, 1), id = fixture_add_small(&f);
    pass(&f, full, 1);
    fixture_feed_region(&f, id, 0, 0, 1, 0);
    assert_int_equal(listed_for_unmapping(&f), 0);
    CHECK_RESULT(fixture_to_map_at_most(&f, id, 1), SLUICE_BUDGET_REACHED);
    assert_int_equal(listed_for_unmapping(&f),
                     3); /* one per waiting request, for any room of the list */
    CHECK_RESULT(fixture_to_map(&f, id), SLUICE_BUDGET_REACHED);
    assert_int_equal(listed_for_unmapping(&f), 3);
    CHECK_RESULT(fixture_to_map(&f, id), SLUICE_BUDGET_REACHED);
    assert_int_equal(listed_for_unmapping(&f), 3); /* another call evicts no more tiles */
    f.count = 1;
    CHECK_RESULT(sluiceGetTilesToUnmap(f.manager, full, 6, &f.count, f.tiles), SLUICE_INCOMPLETE);
    assert_true(LISTED(&f, full, 0));
    CHECK_RESULT(fixture_to_map(&f, id), SLUICE_BUDGET_REACHED);
    assert_int_equal(listed_for_unmapping(&f), 2); /* one retires, two are listed */
    CHECK_OK(fixture_to_unmap(&f, full, 7));
    assert_true(LISTED(&f, full, 1, 2));
    CHECK_RESULT(fixture_to_map(&f, id), SLUICE_BUDGET_REACHED);
    assert_int_equal(listed_for_unmapping(&f), 0); /* retiring slots are counted */
    CHECK_OK(sluiceCompleteRetireValue(f.manager, 7));
    CHECK_OK(fixture_to_map(&f, id));
    assert_true(LISTED(&f, id, 5, 4, 0));
    CHECK_STATE(&f, full, 3, STANDBY);
    fixture_close(&f);
}

static void a_thousand_wants_take_no_more_than_what_is_finer(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId full = open_full(&f, 1);
    fixture_feed_region(&f, full, 3, 0, 1, 0); /* 3, 4 and 5 stay wanted */
    SluiceStreamedTextureDesc desc = full_chain(4096, 4096, 128, 128);
    SluiceTextureId id = fixture_add(&f, &desc);
    fixture_feed(&f, id, 0, 1, 0);
    CHECK_RESULT(fixture_to_map(&f, id), SLUICE_BUDGET_REACHED);
    CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
    assert_true(LISTED(&f, full, 0, 1, 2, 3, 4)); /* two of them because others are coarser */
    CHECK_RESULT(fixture_to_map(&f, id), SLUICE_BUDGET_REACHED);
    assert_int_equal(f.count, 5);
    CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
    assert_int_equal(f.count, 0);
    fixture_close(&f);
}

static void a_slot_is_not_used_again_before_its_value_completed(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId full = open_full(&f, 1), id = fixture_add_small(&f);
    pass(&f, full, 1);
    CHECK_OK(sluiceTrimStandbyTiles(f.manager, 0));
    f.count = 2;
    CHECK_RESULT(sluiceGetTilesToUnmap(f.manager, full, 10, &f.count, f.tiles), SLUICE_INCOMPLETE);
    CHECK_OK(fixture_to_unmap(&f, full, 20));
    assert_int_equal(f.count, 4);
    CHECK_STATE(&f, full, 0, FREE);
    fixture_feed(&f, id, 0, 1, 0);
    static const uint64_t completed[] = {0, 9, 10, 19, 20};
    static const uint32_t free_slots[] = {0, 0, 2, 2, 6};
    for (uint32_t i = 0; i < 5; i++) {
        CHECK_OK(sluiceCompleteRetireValue(f.manager, completed[i]));
        SluiceStreamedTextureStatistics s = fixture_statistics(&f);
        assert_int_equal(s.freeSlotCount, free_slots[i]);
        assert_int_equal(s.retiringSlotCount, 6 - free_slots[i]);
    }
    CHECK_OK(fixture_to_map(&f, id));
    assert_int_equal(f.count, 6);
    fixture_close(&f);
}

static void slots_of_canceled_loads_and_removed_textures_retire_too(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId full = open_full(&f, 2), id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 1, 0);
    CHECK_OK(fixture_to_map(&f, id));
    const uint32_t loads[] = {1, 3};
    CHECK_OK(sluiceReportCanceledTiles(f.manager, id, 2, loads, 5));
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, full, 6));
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, id, 8));
    assert_int_equal(fixture_statistics(&f).retiringSlotCount, 12);
    CHECK_OK(sluiceCompleteRetireValue(f.manager, 5));
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 2);
    CHECK_OK(sluiceCompleteRetireValue(f.manager, 7));
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 8);
    CHECK_OK(sluiceCompleteRetireValue(f.manager, UINT64_MAX));
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 12);
    fixture_close(&f);
}

static void values_that_completed_already_free_at_once(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId full = open_full(&f, 1);
    CHECK_OK(sluiceCompleteRetireValue(f.manager, 10));
    pass(&f, full, 1);
    CHECK_OK(sluiceTrimStandbyTiles(f.manager, 3));
    CHECK_OK(fixture_to_unmap(&f, full, 9));
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 3);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, full, 11));
    assert_int_equal(fixture_statistics(&f).retiringSlotCount, 3);
    fixture_close(&f);
}

static void retire_values_going_backwards_are_refused(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId full = open_full(&f, 2), id = fixture_add_small(&f);
    fixture_feed(&f, id, 0, 1, 0);
    CHECK_OK(fixture_to_map(&f, id));
    pass(&f, full, 2);
    CHECK_OK(sluiceTrimStandbyTiles(f.manager, 0));
    f.count = 1;
    CHECK_RESULT(sluiceGetTilesToUnmap(f.manager, full, 10, &f.count, f.tiles), SLUICE_INCOMPLETE);
    CHECK_OK(sluiceCompleteRetireValue(f.manager, 5));
    const SluiceTextureId ids[] = {full, id};
    uint64_t digest = fixture_digest(&f, 2, ids);
    uint32_t tile = 0, moves = 1;
    SluiceTileMove move;
    CHECK_RESULT(fixture_to_unmap(&f, full, 9), SLUICE_ERROR_TIME_BACKWARDS);
    CHECK_RESULT(sluiceReportCanceledTiles(f.manager, id, 1, &tile, 9),
                 SLUICE_ERROR_TIME_BACKWARDS);
    CHECK_RESULT(sluiceRemoveStreamedTexture(f.manager, id, 9), SLUICE_ERROR_TIME_BACKWARDS);
    CHECK_RESULT(sluiceDefragmentTiles(f.manager, 9, &moves, &move), SLUICE_ERROR_TIME_BACKWARDS);
    CHECK_RESULT(sluiceCompleteRetireValue(f.manager, 4), SLUICE_ERROR_TIME_BACKWARDS);
    assert_true(fixture_digest(&f, 2, ids) == digest);
    CHECK_OK(sluiceReportCanceledTiles(f.manager, id, 1, &tile, 0)); /* 0: no upload was made */
    CHECK_OK(fixture_to_unmap(&f, full, 10));
    assert_int_equal(f.count, 5);
    fixture_close(&f);
}

static void wants_last_for_the_whole_timeout_while_slots_are_short(void **state)
{
    (void)state;
    struct fixture f;
    const SluiceStreamedTextureDesc desc = full_chain(64, 64, 128, 128); /* one packed tile */
    fixture_open(&f, 1, false);
    f.heaps.limit = 1;
    SluiceTextureId id = fixture_add(&f, &desc), waits = fixture_add(&f, &desc);
    fixture_feed(&f, id, 0, 0, 16);
    fixture_load(&f);
    for (uint64_t time = 4; time <= 16; time++) { /* earlier maps would join the first one */
        fixture_feed(&f, waits, 0, time, 16);
        CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
        fixture_feed(&f, id, SLUICE_MIP_UNTOUCHED, time, 16);
        SluiceTileState expected = time < 16 ? SLUICE_TILE_STATE_MAPPED : SLUICE_TILE_STATE_STANDBY;
        assert_int_equal(fixture_state(&f, id, 0), expected);
    }
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heaps_are_asked_for_one_by_one_when_slots_are_needed),
        cmocka_unit_test(a_refusal_is_the_budget_and_is_heard_once_per_call),
        cmocka_unit_test(what_fits_is_handed_out_before_the_budget_is_reached),
        cmocka_unit_test(the_heap_cap_is_kept_without_asking),
        cmocka_unit_test(wanted_tiles_make_room_for_coarser_requests_only),
        cmocka_unit_test(a_texture_that_gets_no_more_maps_gives_way),
        cmocka_unit_test(the_last_slots_are_for_packed_tiles),
        cmocka_unit_test(the_global_bias_rises_with_the_demand_and_falls_with_the_budget),
        cmocka_unit_test(the_global_bias_goes_when_the_demand_does_whenever_that_is),
        cmocka_unit_test(standby_is_evicted_oldest_first_as_many_as_needed),
        cmocka_unit_test(a_thousand_wants_take_no_more_than_what_is_finer),
        cmocka_unit_test(wants_last_for_the_whole_timeout_while_slots_are_short),
        cmocka_unit_test(a_slot_is_not_used_again_before_its_value_completed),
        cmocka_unit_test(slots_of_canceled_loads_and_removed_textures_retire_too),
        cmocka_unit_test(values_that_completed_already_free_at_once),
        cmocka_unit_test(retire_values_going_backwards_are_refused),
    };
    return RUN_TESTS(tests);
}
