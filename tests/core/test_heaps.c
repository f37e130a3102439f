#include "core/fixture.h"

#include "support/thin_heaps.h"

static void say_nothing_wanted(struct fixture *f, SluiceTextureId id, uint64_t time)
{
    fixture_feed(f, id, SLUICE_MIP_UNTOUCHED, time, 0);
}

/* Opens three small textures in heaps of 8 slots. The heaps hold 8, 8 and 2 tiles. */
static void open_three(struct fixture *f, SluiceTextureId ids[3])
{
    fixture_open(f, 8, false);
    for (uint32_t i = 0; i < 3; i++) {
        ids[i] = fixture_add_small(f);
        fixture_feed(f, ids[i], 0, 0, 0);
        fixture_load(f);
    }
    assert_int_equal(f->heaps.living_count, 3);
}

/* Counts tiles with a slot by heap. No slot may be held twice. */
static void count_slots(const struct fixture *f, uint32_t id_count, const SluiceTextureId *ids,
                        uint32_t capacity, uint32_t used[FIXTURE_HEAPS])
{
    bool taken[FIXTURE_HEAPS][64] = {{false}};
    assert_true(capacity <= 64);
    for (uint32_t i = 0; i < FIXTURE_HEAPS; i++)
        used[i] = 0;
    for (uint32_t i = 0; i < id_count; i++) {
        uint32_t count = fixture_layout(f, ids[i]).tileCount;
        for (uint32_t tile = 0; tile < count; tile++) {
            SluiceTileState s = fixture_state(f, ids[i], tile);
            if (s < SLUICE_TILE_STATE_ALLOCATED || s > SLUICE_TILE_STATE_CANCELED)
                continue;
            SluiceTile place = fixture_tile(f, ids[i], tile);
            assert_true(place.heapId < FIXTURE_HEAPS && f->heaps.living[place.heapId]);
            assert_true(place.slot < capacity && !taken[place.heapId][place.slot]);
            taken[place.heapId][place.slot] = true;
            used[place.heapId]++;
        }
    }
}

static void every_slot_is_held_by_one_tile(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId ids[3];
    uint32_t used[FIXTURE_HEAPS];
    open_three(&f, ids);
    count_slots(&f, 3, ids, 8, used);
    assert_true(used[0] == 8 && used[1] == 8 && used[2] == 2);
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 6);
    fixture_close(&f);
}

static void the_fullest_heap_is_filled_first(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId ids[3];
    uint32_t used[FIXTURE_HEAPS];
    open_three(&f, ids);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[1], 0)); /* 6, 4 and 2 are left */
    count_slots(&f, 1, &ids[0], 8, used);
    assert_int_equal(used[0], 6);
    const SluiceTextureId kept[] = {ids[0], ids[2], fixture_add_small(&f)};
    fixture_feed(&f, kept[2], 0, 1, 0);
    static const uint32_t expected[][3] = {{7, 4, 2}, {8, 4, 2}, {8, 5, 2}, {8, 6, 2}, {8, 7, 2}};
    for (uint32_t i = 0; i < 5; i++) {
        CHECK_RESULT(fixture_to_map_at_most(&f, kept[2], 1), SLUICE_INCOMPLETE);
        count_slots(&f, 3, kept, 8, used);
        for (uint32_t h = 0; h < 3; h++)
            assert_int_equal(used[h], expected[i][h]);
    }
    fixture_close(&f);
}

static void large_heaps_are_filled_fullest_first_too(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 10000, false);
    SluiceStreamedTextureDesc desc = full_chain(128 * 90, 128 * 90, 128, 128);
    SluiceTextureId big = fixture_add(&f, &desc), others[3]; /* more than one heap */
    for (uint32_t i = 0; i < 3; i++)
        others[i] = fixture_add_small(&f);
    fixture_feed(&f, others[0], 0, 0, 0);
    fixture_load(&f);
    fixture_feed(&f, big, 0, 0, 0);
    fixture_load(&f);
    fixture_feed(&f, others[1], 0, 0, 0);
    fixture_load(&f);
    assert_int_equal(f.heaps.living_count, 2);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, big, 0)); /* 6 tiles stay in each heap */
    assert_int_equal(fixture_tile(&f, others[0], 0).heapId, 0);
    assert_int_equal(fixture_tile(&f, others[1], 0).heapId, 1);
    fixture_feed(&f, others[0], 2, 1, 0); /* the packed one alone: 1 and 6 */
    CHECK_OK(fixture_to_unmap(&f, others[0], 0));
    fixture_feed(&f, others[2], 0, 1, 0);
    CHECK_OK(fixture_to_map(&f, others[2]));
    for (uint32_t i = 0; i < 6; i++)
        assert_int_equal(fixture_tile(&f, others[2], i).heapId, 1);
    fixture_close(&f);
}

static uint32_t empty_heaps(const struct fixture *f)
{
    uint32_t count = 99;
    CHECK_OK(sluiceGetEmptyHeaps(f->manager, &count, NULL));
    return count;
}

static void empty_heaps_are_listed_and_released(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId ids[3];
    open_three(&f, ids);
    assert_int_equal(empty_heaps(&f), 0);
    for (uint32_t i = 0; i < 3; i++)
        CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[i], 0));
    assert_int_equal(empty_heaps(&f), 3);
    uint32_t heaps[3] = {99, 99, 99}, count = 2;
    CHECK_RESULT(sluiceGetEmptyHeaps(f.manager, &count, heaps), SLUICE_INCOMPLETE);
    assert_int_equal(count, 2);
    count = 3;
    CHECK_OK(sluiceGetEmptyHeaps(f.manager, &count, heaps));
    assert_int_equal(count, 3);
    assert_true(heaps[0] != heaps[1] && heaps[1] != heaps[2] && heaps[0] != heaps[2]);
    CHECK_OK(sluiceReleaseHeap(f.manager, heaps[1]));
    assert_true(!f.heaps.living[heaps[1]] && f.heaps.released == 1);
    CHECK_RESULT(sluiceReleaseHeap(f.manager, heaps[1]), SLUICE_ERROR_UNKNOWN_HEAP);
    assert_int_equal(empty_heaps(&f), 2);
    assert_int_equal(fixture_statistics(&f).heapCount, 2);
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 16);
    SluiceTextureId again[3]; /* the id of the released heap may be used again */
    for (uint32_t i = 0; i < 3; i++) {
        again[i] = fixture_add_small(&f);
        fixture_feed(&f, again[i], 0, 1, 0);
    }
    fixture_load(&f);
    assert_int_equal(f.heaps.living_count, 3);
    uint32_t used[FIXTURE_HEAPS];
    count_slots(&f, 3, again, 8, used);
    assert_int_equal(used[0] + used[1] + used[2], 18);
    fixture_close(&f);
}

/* Otherwise a working set at the edge of a heap would release and request it repeatedly. */
static void an_empty_heap_is_listed_only_if_half_a_heap_stays_free(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 6, false);
    SluiceTextureId ids[3];
    for (uint32_t i = 0; i < 3; i++) {
        ids[i] = fixture_add_small(&f);
        fixture_feed(&f, ids[i], 0, 0, 0);
        fixture_load(&f);
    }
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[1], 0));
    const uint32_t heaps = fixture_statistics(&f).heapCount;
    const uint32_t free_slots = fixture_statistics(&f).freeSlotCount;
    assert_int_equal(free_slots, heaps * 6 - 12);
    assert_int_equal(empty_heaps(&f), (free_slots - 3) / 6);
    fixture_feed(&f, ids[0], 1, 1, 0); /* four of six are no longer wanted */
    CHECK_OK(fixture_to_unmap(&f, ids[0], 0));
    assert_int_equal(empty_heaps(&f), (free_slots + 4 - 3) / 6);
    assert_true((free_slots + 4 - 3) / 6 > (free_slots - 3) / 6);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[0], 0));
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[2], 0));
    assert_int_equal(empty_heaps(&f), heaps); /* nothing is left at all */
    fixture_close(&f);
}

static void a_heap_in_use_is_not_released(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId ids[3];
    open_three(&f, ids);
    uint64_t digest = fixture_digest(&f, 3, ids);
    for (uint32_t h = 0; h < 3; h++)
        CHECK_RESULT(sluiceReleaseHeap(f.manager, h), SLUICE_ERROR_HEAP_IN_USE);
    CHECK_RESULT(sluiceReleaseHeap(f.manager, 3), SLUICE_ERROR_UNKNOWN_HEAP);
    CHECK_RESULT(sluiceReleaseHeap(f.manager, UINT32_MAX), SLUICE_ERROR_UNKNOWN_HEAP);
    assert_true(fixture_digest(&f, 3, ids) == digest);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[2], 0));
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[1], 9));
    CHECK_RESULT(sluiceReleaseHeap(f.manager, 1), SLUICE_ERROR_HEAP_IN_USE); /* still retiring */
    CHECK_OK(sluiceCompleteRetireValue(f.manager, 9));
    CHECK_OK(sluiceReleaseHeap(f.manager, 1));
    assert_int_equal(f.heaps.released, 1);
    fixture_close(&f);
}

static void an_allocator_that_answers_a_living_id_has_refused(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId ids[3];
    open_three(&f, ids);
    f.heaps.answers_duplicate = true;
    SluiceTextureId more[2] = {fixture_add_small(&f), fixture_add_small(&f)};
    fixture_feed(&f, more[0], 0, 1, 0);
    fixture_feed(&f, more[1], 0, 1, 0);
    CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
    assert_int_equal(f.count, 5); /* all free slots except the reserved one */
    assert_int_equal(fixture_statistics(&f).heapCount, 3);
    f.heaps.answers_duplicate = false;
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f.count, 7);
    const SluiceTextureId all[] = {ids[0], ids[1], ids[2], more[0], more[1]};
    uint32_t used[FIXTURE_HEAPS];
    count_slots(&f, 5, all, 8, used);
    assert_int_equal(used[3], 6);
    assert_int_equal(f.heaps.released, 0); /* the living heap was not released for it */
    fixture_close(&f);
}

/* Moves at most `room` tiles. Each move must state the tile's old and new slot. */
static uint32_t defragment(struct fixture *f, uint64_t retire_value, uint32_t room)
{
    static const uint32_t most = 64;
    SluiceTileMove moves[64];
    assert_true(room <= most);
    uint32_t count = room;
    uint64_t moved = fixture_statistics(f).movedTotal;
    CHECK_OK(sluiceDefragmentTiles(f->manager, retire_value, &count, moves));
    assert_true(count <= room);
    for (uint32_t i = 0; i < count; i++) {
        SluiceTile now = fixture_tile(f, moves[i].from.textureId, moves[i].from.tileIndex);
        assert_true(now.heapId == moves[i].heapId && now.slot == moves[i].slot);
        assert_true(now.heapId != moves[i].from.heapId);
        assert_int_equal(now.mipLevel, moves[i].from.mipLevel);
    }
    assert_true(fixture_statistics(f).movedTotal == moved + count);
    return count;
}

static void defragmentation_empties_the_least_used_heap(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId ids[3];
    uint32_t used[FIXTURE_HEAPS];
    open_three(&f, ids);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[1], 0)); /* 6, 4 and 2 of 8 */
    const SluiceTextureId kept[] = {ids[0], ids[2]};
    assert_int_equal(defragment(&f, 5, 64), 2);
    count_slots(&f, 2, kept, 8, used);
    assert_true(used[0] + used[1] + used[2] == 12);
    assert_int_equal((used[0] > 0) + (used[1] > 0) + (used[2] > 0), 2);
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 10); /* copies still read two slots */
    CHECK_OK(sluiceCompleteRetireValue(f.manager, 5));
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 12); /* 8 of them in one heap */
    assert_int_equal(defragment(&f, 6, 64), 0);
    fixture_close(&f);
}

static void moved_tiles_stay_what_they_are(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId ids[3];
    open_three(&f, ids);
    fixture_configure(&f, 100, 0, 0, 0);
    say_nothing_wanted(&f, ids[2], 1);
    CHECK_OK(sluiceTrimStandbyTiles(f.manager, 3)); /* some of them listed for unmapping */
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[1], 0));
    uint8_t before[4], after[4];
    CHECK_OK(sluiceWriteMinMipData(f.manager, ids[2], 2, 4, before));
    assert_true(defragment(&f, 5, 64) > 0);
    CHECK_OK(sluiceWriteMinMipData(f.manager, ids[2], 2, 4, after));
    assert_memory_equal(before, after, 4);
    for (uint32_t i = 0; i < 6; i++) {
        CHECK_STATE(&f, ids[0], i, MAPPED);
        CHECK_STATE(&f, ids[2], i, STANDBY);
    }
    CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 6));
    assert_true(LISTED(&f, ids[2], 0, 1, 2)); /* the order of the list is kept */
    CHECK_OK(sluiceCompleteRetireValue(f.manager, 6));
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 24 - 9);
    fixture_close(&f);
}

static void nothing_moves_when_no_heap_can_be_emptied(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId ids[3];
    fixture_open(&f, 8, false);
    assert_int_equal(defragment(&f, 1, 64), 0); /* no heap at all */
    fixture_close(&f);
    open_three(&f, ids);
    assert_int_equal(defragment(&f, 1, 64), 0); /* 18 tiles need three heaps of 8 */
    fixture_close(&f);
    open_three(&f, ids);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[1], 0));
    assert_int_equal(defragment(&f, 1, 0), 0); /* no room for moves */
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[0], 0));
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[2], 0));
    assert_int_equal(defragment(&f, 1, 64), 0); /* empty heaps need no move */
    fixture_close(&f);
}

/* Loads and drops at random until heaps have holes, then moves until no move is left. */
static void repeated_defragmentation_ends_in_the_fewest_heaps(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 20; seed++) {
        struct fixture f;
        SluiceTextureId ids[24];
        uint32_t used[FIXTURE_HEAPS], count = 0, live = 0, heaps = 0;
        uint64_t random = seed, retire = 1;
        fixture_open(&f, 8, false);
        for (uint32_t i = 0; i < 24; i++) {
            ids[i] = fixture_add_small(&f);
            fixture_feed_region(&f, ids[i], next_random(&random) % 4, 0, 0, 0);
            fixture_load(&f);
            fixture_feed(&f, ids[i], next_random(&random) % 3, 0, 100);
            fixture_load(&f);
        }
        for (uint32_t i = 0; i < 24; i++) {
            if (next_random(&random) % 2)
                CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[i], 0));
            else
                ids[count++] = ids[i];
        }
        uint32_t room = seed % 2 ? 1 + seed % 5 : 64, moves = 0;
        while (defragment(&f, retire, room)) {
            count_slots(&f, count, ids, 8, used);
            if (seed % 3)
                CHECK_OK(sluiceCompleteRetireValue(f.manager, retire));
            retire++;
            assert_true(++moves < 1000);
        }
        count_slots(&f, count, ids, 8, used);
        for (uint32_t h = 0; h < FIXTURE_HEAPS; h++) {
            live += used[h];
            heaps += used[h] > 0;
        }
        if (seed % 3) /* with every copy over, slots that moves left count as free */
            assert_int_equal(heaps, (live + 7) / 8);
        fixture_close(&f);
    }
}

static void loads_under_way_do_not_move(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId ids[3];
    open_three(&f, ids);
    SluiceTextureId id = fixture_add_small(&f);
    fixture_feed_region(&f, id, 0, 0, 1, 0);
    CHECK_OK(fixture_to_map(&f, id)); /* three, into the third heap */
    static const uint32_t loads[] = {0, 4, 5};
    SluiceTile places[3];
    for (uint32_t i = 0; i < 3; i++)
        places[i] = fixture_tile(&f, id, loads[i]);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[1], 0)); /* 6, 4 and 2 + 3 of 8 */
    assert_int_equal(defragment(&f, 1, 64), 4);
    CHECK_OK(sluiceCompleteRetireValue(f.manager, 1));
    const SluiceTextureId left[] = {ids[0], ids[2], id};
    uint32_t used[FIXTURE_HEAPS];
    count_slots(&f, 3, left, 8, used);
    assert_int_equal((used[0] > 0) + (used[1] > 0) + (used[2] > 0), 2);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[0], 1)); /* now theirs is used least */
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[2], 1));
    defragment(&f, 2, 64);
    for (uint32_t i = 0; i < 3; i++) {
        SluiceTile now = fixture_tile(&f, id, loads[i]);
        assert_true(now.heapId == places[i].heapId && now.slot == places[i].slot);
        CHECK_STATE(&f, id, loads[i], ALLOCATED);
    }
    fixture_close(&f);
}

static void tiles_that_move_twice_in_one_call_are_counted_twice(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, THIN_HEAPS_CAPACITY, false);
    thin_heaps_make(f.manager);
    assert_int_equal(fixture_statistics(&f).mappedTileCount, THIN_HEAPS_TILES);
    SluiceTileMove moves[64];
    uint32_t count = 64, retiring = fixture_statistics(&f).retiringSlotCount;
    CHECK_OK(sluiceDefragmentTiles(f.manager, 7, &count, moves));
    assert_int_equal(count, THIN_HEAPS_MOVES);
    assert_int_equal(fixture_statistics(&f).retiringSlotCount, retiring + THIN_HEAPS_MOVES);
    CHECK_OK(sluiceCompleteRetireValue(f.manager, 7));
    assert_int_equal(empty_heaps(&f), 8);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_slot_is_held_by_one_tile),
        cmocka_unit_test(the_fullest_heap_is_filled_first),
        cmocka_unit_test(empty_heaps_are_listed_and_released),
        cmocka_unit_test(an_empty_heap_is_listed_only_if_half_a_heap_stays_free),
        cmocka_unit_test(a_heap_in_use_is_not_released),
        cmocka_unit_test(an_allocator_that_answers_a_living_id_has_refused),
        cmocka_unit_test(defragmentation_empties_the_least_used_heap),
        cmocka_unit_test(moved_tiles_stay_what_they_are),
        cmocka_unit_test(nothing_moves_when_no_heap_can_be_emptied),
        cmocka_unit_test(repeated_defragmentation_ends_in_the_fewest_heaps),
        cmocka_unit_test(loads_under_way_do_not_move),
        cmocka_unit_test(large_heaps_are_filled_fullest_first_too),
        cmocka_unit_test(tiles_that_move_twice_in_one_call_are_counted_twice),
    };
    return RUN_TESTS(tests);
}
