#include "core/sound.h"

static uint32_t empty_heaps(const struct fixture *f)
{
    uint32_t count = 0;
    CHECK_OK(sluiceGetEmptyHeaps(f->manager, &count, NULL));
    return count;
}

static void check_in_use(struct fixture *f, SluiceTextureId id, uint32_t heap)
{
    REFUSED(f, 1, &id, sluiceReleaseHeap(f->manager, heap), SLUICE_ERROR_HEAP_IN_USE);
    assert_int_equal(empty_heaps(f), 0);
    assert_int_equal(f->heaps.released, 0);
}

/* A heap is in use if one of its 64 slots is held, in any state. */
static void a_heap_is_in_use_in_every_state_that_holds_a_slot(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    fixture_configure(&f, 1, 0, 0, 0);
    SluiceTextureId id = fixture_add_small(&f);
    const uint32_t packed = 5;
    for (uint32_t answer = 0; answer < 2; answer++) { /* after a load, after a canceled one */
        uint64_t time = answer, retire = answer + 1;
        sound_feed(&f, id, 7, time, 0);
        SOUND(&f, fixture_to_map(&f, id));
        assert_int_equal(f.count, 1);
        check_in_use(&f, id, 0); /* allocated */
        sound_feed(&f, id, SLUICE_MIP_UNTOUCHED, time, 0);
        CHECK_STATE(&f, id, packed, CANCELED);
        check_in_use(&f, id, 0);
        SOUND(&f, fixture_to_cancel(&f, id));
        check_in_use(&f, id, 0); /* listed as canceled */
        if (answer == 1) {
            SOUND(&f, sluiceReportCanceledTiles(f.manager, id, 1, &packed, retire));
        } else {
            SOUND(&f, sluiceUpdateTilesMapping(f.manager, id, 1, &packed));
            CHECK_STATE(&f, id, packed, STANDBY);
            check_in_use(&f, id, 0);
            sound_feed(&f, id, 7, time, 0);
            CHECK_STATE(&f, id, packed, MAPPED);
            check_in_use(&f, id, 0);
            sound_feed(&f, id, SLUICE_MIP_UNTOUCHED, time, 0);
            SOUND(&f, sluiceTrimStandbyTiles(f.manager, 0));
            check_in_use(&f, id, 0); /* listed for unmapping */
            SOUND(&f, fixture_to_unmap(&f, id, retire));
            assert_int_equal(f.count, 1);
        }
        CHECK_STATE(&f, id, packed, FREE);
        check_in_use(&f, id, 0); /* retiring */
        SOUND(&f, sluiceCompleteRetireValue(f.manager, retire));
        assert_int_equal(empty_heaps(&f), 1);
    }
    SOUND(&f, sluiceReleaseHeap(f.manager, 0));
    assert_int_equal(f.heaps.released, 1);
    fixture_close(&f);
}

/* Counts heaps that hold a tile of one of these textures. */
static uint32_t used_heaps(const struct fixture *f, uint32_t count, const SluiceTextureId *ids)
{
    bool used[FIXTURE_HEAPS] = {false};
    uint32_t heaps = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t tile = 0; tile < fixture_layout(f, ids[i]).tileCount; tile++) {
            SluiceTileState s = fixture_state(f, ids[i], tile);
            if (s >= SLUICE_TILE_STATE_ALLOCATED && s <= SLUICE_TILE_STATE_CANCELED)
                used[fixture_tile(f, ids[i], tile).heapId] = true;
        }
    for (uint32_t heap = 0; heap < FIXTURE_HEAPS; heap++)
        heaps += used[heap];
    return heaps;
}

enum { CROWD = 60, CROWD_CAPACITY = 8 };

/* Simulates a walk past pictures. Few are visible: each is loaded and dropped in turn. */
static void a_smaller_working_set_empties_heaps_by_placement_alone(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, CROWD_CAPACITY, false);
    SluiceTextureId ids[CROWD];
    uint64_t random = 51, time = 0;
    for (uint32_t i = 0; i < CROWD; i++) {
        ids[i] = fixture_add_small(&f);
        sound_feed(&f, ids[i], 0, 0, 0);
    }
    sound_load(&f);
    const SluiceStreamedTextureStatistics all = fixture_statistics(&f);
    assert_true(all.heapCount <= (CROWD * 6 + all.reservedSlotCount) / CROWD_CAPACITY + 1);
    assert_int_equal(used_heaps(&f, CROWD, ids), CROWD * 6 / CROWD_CAPACITY);
    bool seen[CROWD] = {false};
    for (uint32_t i = 0; i < CROWD; i++) { /* one picture in ten stays, so all heaps have holes */
        seen[i] = i % 10 == 0;
        if (!seen[i])
            sound_feed(&f, ids[i], SLUICE_MIP_UNTOUCHED, ++time, 0);
    }
    SOUND(&f, fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
    for (uint32_t step = 0; step < 200; step++) { /* one is loaded, then one dropped */
        uint32_t come = next_random(&random) % CROWD, go = next_random(&random) % CROWD;
        while (seen[come])
            come = (come + 1) % CROWD;
        while (!seen[go])
            go = (go + 1) % CROWD;
        sound_feed(&f, ids[come], 0, ++time, 0);
        sound_load(&f);
        sound_feed(&f, ids[go], SLUICE_MIP_UNTOUCHED, time, 0);
        SOUND(&f, fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
        seen[come] = true, seen[go] = false;
    }
    assert_int_equal(fixture_statistics(&f).mappedTileCount, CROWD / 10 * 6);
    /* 36 tiles fill 5 heaps; at most 42 tiles fill 6. Most of the 45 heaps have become empty. */
    assert_true(used_heaps(&f, CROWD, ids) <= 8);
    assert_true(fixture_statistics(&f).heapCount == all.heapCount);
    fixture_close(&f);
}

/* Repeats short defragmentations until no move is left. `complete`: completes every copy in
 * between. */
static uint32_t defragment_to_the_end(struct fixture *f, uint32_t room, bool complete,
                                      uint64_t *retire)
{
    SluiceTileMove moves[64];
    uint32_t total = 0;
    for (;;) {
        uint32_t count = room;
        SOUND(f, sluiceDefragmentTiles(f->manager, ++*retire, &count, moves));
        if (complete)
            SOUND(f, sluiceCompleteRetireValue(f->manager, *retire));
        if (!count)
            return total;
        total += count;
        assert_true(total < 10000);
    }
}

/* Every heap holds only the packed tile of one texture, which is never evicted. */
static void packed_tiles_move_too_and_pin_no_heap(void **state)
{
    (void)state;
    for (uint32_t complete = 0; complete < 2; complete++) {
        struct fixture f;
        fixture_open(&f, 6, true);
        SluiceTextureId ids[12];
        uint64_t retire = 0;
        for (uint32_t i = 0; i < 12; i++) {
            ids[i] = fixture_add_small(&f);
            sound_feed(&f, ids[i], 0, i, 0);
            sound_load(&f);
        }
        for (uint32_t i = 0; i < 12; i++)
            sound_feed(&f, ids[i], SLUICE_MIP_UNTOUCHED, 20, 0);
        SOUND(&f, fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
        assert_int_equal(fixture_statistics(&f).mappedTileCount, 12);
        assert_int_equal(used_heaps(&f, 12, ids), 12);
        uint32_t moves = defragment_to_the_end(&f, 5, complete, &retire);
        assert_true(moves >= 10); /* two heaps of 6 are left */
        SOUND(&f, sluiceCompleteRetireValue(f.manager, retire));
        assert_int_equal(used_heaps(&f, 12, ids), 2);
        uint32_t heaps[12], count = 12;
        SOUND(&f, sluiceGetEmptyHeaps(f.manager, &count, heaps));
        for (uint32_t i = 0; i < count; i++)
            SOUND(&f, sluiceReleaseHeap(f.manager, heaps[i]));
        assert_int_equal(f.heaps.living_count,
                         4); /* two full ones, and half of one and the reserve */
        for (uint32_t i = 0; i < 12; i++)
            CHECK_STATE(&f, ids[i], 5, MAPPED);
        fixture_close(&f);
    }
}

static void defragmentation_ends_and_then_gains_nothing(void **state)
{
    (void)state;
    uint64_t random = 52;
    for (uint32_t round = 0; round < 30; round++) {
        struct fixture f;
        uint32_t capacity = 2 + next_random(&random) % 12, tiles = 0;
        uint64_t retire = 0;
        fixture_open(&f, capacity, round % 2);
        SluiceTextureId ids[20];
        for (uint32_t i = 0; i < 20; i++) {
            ids[i] = fixture_add_small(&f);
            sound_feed(&f, ids[i], 0, i, 0);
        }
        sound_load(&f);
        for (uint32_t i = 0; i < 20; i++) /* other regions of each picture are still requested */
            sound_feed_region(&f, ids[i], next_random(&random) % 4,
                              (uint8_t)(next_random(&random) % 3), 20, 0);
        SOUND(&f, fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
        tiles = fixture_statistics(&f).mappedTileCount;
        uint32_t before = used_heaps(&f, 20, ids), fewest = (tiles + capacity - 1) / capacity;
        uint32_t moves = defragment_to_the_end(&f, 1 + round % 7, true, &retire);
        assert_int_equal(used_heaps(&f, 20, ids), fewest);
        assert_int_equal(moves > 0, before > fewest);
        assert_true(moves < 2 * tiles);
        uint64_t digest = fixture_digest(&f, 20, ids);
        assert_int_equal(defragment_to_the_end(&f, 64, true, &retire), 0);
        assert_true(fixture_digest(&f, 20, ids) == digest);
        fixture_close(&f);
    }
}

static void heaps_that_were_released_come_back_up_to_the_cap(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 4, false);
    fixture_configure(&f, 0, 3, 0, 0);
    SluiceTextureId ids[4];
    for (uint32_t i = 0; i < 4; i++)
        ids[i] = fixture_add_small(&f);
    for (uint64_t round = 0; round < 12; round++) {
        for (uint32_t i = 0; i < 3; i++) /* 18 tiles for 12 slots */
            sound_feed(&f, ids[(round + i) % 4], 0, round, 0);
        CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
        assert_int_equal(f.count, 12);
        CHECK_SOUND(&f);
        sound_answer_mapped(&f);
        assert_int_equal(f.heaps.living_count, 3);
        assert_int_equal(fixture_statistics(&f).requestedTileCount, 6);
        for (uint32_t i = 0; i < 4; i++)
            sound_feed(&f, ids[i], SLUICE_MIP_UNTOUCHED, round, 0);
        SOUND(&f, fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
        assert_int_equal(empty_heaps(&f), 3);
        for (uint32_t h = 0; h < 1 + round % 3; h++) /* one, two or all */
            SOUND(&f, sluiceReleaseHeap(f.manager, h));
        assert_int_equal(f.heaps.living_count, 2 - round % 3);
    }
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_heap_is_in_use_in_every_state_that_holds_a_slot),
        cmocka_unit_test(a_smaller_working_set_empties_heaps_by_placement_alone),
        cmocka_unit_test(packed_tiles_move_too_and_pin_no_heap),
        cmocka_unit_test(defragmentation_ends_and_then_gains_nothing),
        cmocka_unit_test(heaps_that_were_released_come_back_up_to_the_cap),
    };
    return RUN_TESTS(tests);
}
