/* Fewer heaps than there are: tiles are evicted, the others gather in full heaps, memory falls. */
#include "core/fixture.h"

enum { CAPACITY = 16, TILES = 341, FRAMES = 120 };

static struct fixture f;
static uint64_t now;

/* 2048x2048 in tiles of 128x128: levels of 256, 64, 16, 4 and 1 tiles, and a packed one. */
static SluiceTextureId open_with_everything_mapped(void)
{
    fixture_open(&f, CAPACITY, true);
    now = 1;
    SluiceStreamedTextureDesc desc = full_chain(2048, 2048, 128, 128);
    SluiceTextureId id = fixture_add(&f, &desc);
    fixture_feed(&f, id, 0, now, 1000000);
    fixture_load(&f);
    assert_int_equal(fixture_statistics(&f).mappedTileCount, TILES + 1);
    return id;
}

static void configure(const SluiceStreamedTextureManagerConfig *config)
{
    SluiceStreamedTextureManagerConfig with = *config;
    with.missesToExpire = 1;
    CHECK_OK(sluiceSetConfig(f.manager, &with));
}

static void release_empty_heaps(void)
{
    uint32_t heaps[FIXTURE_HEAPS], count = FIXTURE_HEAPS;
    CHECK_OK(sluiceGetEmptyHeaps(f.manager, &count, heaps));
    for (uint32_t i = 0; i < count; i++)
        CHECK_OK(sluiceReleaseHeap(f.manager, heaps[i]));
}

/* Runs a frame: a map, evictions, at most `evacuated` evacuations, and loads. Returns the number of
 * unmapped tiles. */
static uint32_t frame(SluiceTextureId id, uint32_t evacuated)
{
    fixture_feed(&f, id, 0, ++now, 1000000);
    CHECK_OK(sluiceCompleteRetireValue(f.manager, now - 2));
    CHECK_OK(sluiceEvacuateHeaps(f.manager, evacuated));
    assert_true(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, now) >= 0);
    uint32_t unmapped = f.count;
    release_empty_heaps();
    assert_true(fixture_to_map(&f, SLUICE_ALL_TEXTURES) >= 0);
    fixture_answer_mapped(&f);
    return unmapped;
}

static uint32_t count_mapped(SluiceTextureId id, uint32_t first, uint32_t count)
{
    uint32_t mapped = 0;
    for (uint32_t i = first; i < first + count; i++)
        mapped += fixture_state(&f, id, i) == SLUICE_TILE_STATE_MAPPED;
    return mapped;
}

static void heaps_fall_to_the_target_and_the_coarse_levels_stay(void **state)
{
    (void)state;
    SluiceTextureId id = open_with_everything_mapped();
    uint32_t before = f.heaps.living_count;
    assert_true(before >= 22);
    configure(&(SluiceStreamedTextureManagerConfig){.structSize =
                                                        sizeof(SluiceStreamedTextureManagerConfig),
                                                    .targetHeapCount = 4,
                                                    .noMipBias = true});
    for (uint32_t i = 0; i < FRAMES; i++)
        frame(id, 8);
    assert_int_equal(f.heaps.living_count, 4);
    assert_int_equal(count_mapped(id, 320, 22), 22); /* all but the two finest levels */
    assert_int_equal(count_mapped(id, 0, 256), 0);
    assert_true(count_mapped(id, 256, 64) >= 30);
    for (uint32_t i = 0; i < 20; i++)
        assert_int_equal(frame(id, 8), 0); /* and rests */

    configure(&(SluiceStreamedTextureManagerConfig){.structSize =
                                                        sizeof(SluiceStreamedTextureManagerConfig),
                                                    .targetHeapCount = 0,
                                                    .noMipBias = true});
    for (uint32_t i = 0; i < 20; i++)
        frame(id, 0);
    assert_int_equal(count_mapped(id, 0, TILES), TILES);
    fixture_close(&f);
}

static void standby_tiles_go_first(void **state)
{
    (void)state;
    SluiceTextureId id = open_with_everything_mapped();
    SluiceStreamedTextureDesc desc = full_chain(1024, 1024, 128, 128);
    SluiceTextureId other = fixture_add(&f, &desc);
    configure(&(SluiceStreamedTextureManagerConfig){
        .structSize = sizeof(SluiceStreamedTextureManagerConfig), .numExtraStandbyTiles = 1000});
    fixture_feed(&f, other, 0, now, 0);
    fixture_load(&f);
    fixture_feed(&f, other, SLUICE_MIP_UNTOUCHED, ++now, 0);
    uint32_t standby = fixture_statistics(&f).standbyTileCount;
    assert_int_equal(standby, 85);
    uint32_t heaps = f.heaps.living_count;
    /* four heaps less: two of them are empty */
    configure(&(SluiceStreamedTextureManagerConfig){.structSize =
                                                        sizeof(SluiceStreamedTextureManagerConfig),
                                                    .numExtraStandbyTiles = 1000,
                                                    .targetHeapCount = heaps - 4});
    for (uint32_t i = 0; i < 10; i++)
        frame(id, 0);
    assert_int_equal(count_mapped(id, 0, TILES), TILES);
    assert_in_range(fixture_statistics(&f).standbyTileCount, 1, standby - CAPACITY);
    fixture_close(&f);
}

static void evacuation_evicts_no_more_tiles_than_asked_and_ends(void **state)
{
    (void)state;
    SluiceTextureId id = open_with_everything_mapped();
    uint8_t map[256];
    for (uint32_t i = 0; i < 256; i++) /* every fourth tile of level 0 stays */
        map[i] = i % 4 == 0 ? 0 : 1;
    now++;
    fixture_feed_map(&f, id, map, now, 0);
    fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0);
    uint32_t before = f.heaps.living_count, wanted = fixture_statistics(&f).mappedTileCount;
    assert_int_equal(wanted, TILES + 1 - 192);
    for (uint32_t i = 0; i < FRAMES; i++) {
        CHECK_OK(sluiceEvacuateHeaps(f.manager, 3));
        fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0);
        assert_true(f.count <= 3);
        release_empty_heaps();
        fixture_to_map(&f, SLUICE_ALL_TEXTURES);
        fixture_answer_mapped(&f);
        assert_int_equal(fixture_statistics(&f).mappedTileCount, wanted); /* elsewhere at once */
    }
    CHECK_OK(sluiceEvacuateHeaps(f.manager, 1000));
    fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0);
    assert_int_equal(f.count, 0);
    assert_true(f.heaps.living_count <= (wanted + CAPACITY - 1) / CAPACITY + 2);
    assert_true(f.heaps.living_count < before);
    fixture_close(&f);
}

static void evacuation_survives_a_refused_allocation(void **state)
{
    (void)state;
    SluiceTextureId id = open_with_everything_mapped();
    configure(&(SluiceStreamedTextureManagerConfig){
        .structSize = sizeof(SluiceStreamedTextureManagerConfig), .targetHeapCount = 20});
    uint64_t digest = fixture_digest(&f, 1, &id);
    f.memory.refuse_from = f.memory.calls;
    CHECK_RESULT(sluiceEvacuateHeaps(f.manager, 8), SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    f.memory.refuse_from = UINT64_MAX;
    assert_true(fixture_digest(&f, 1, &id) == digest);
    CHECK_OK(sluiceEvacuateHeaps(f.manager, 8));
    fixture_close(&f);
}

static void heaps_with_packed_tiles_are_not_evacuated(void **state)
{
    (void)state;
    fixture_open(&f, 4, true);
    for (int i = 0; i < 8; i++)
        fixture_add_small(&f); /* a packed tile each */
    fixture_load(&f);
    assert_true(f.heaps.living_count >= 2);
    CHECK_OK(sluiceEvacuateHeaps(f.manager, 1000));
    fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0);
    assert_int_equal(f.count, 0);
    fixture_close(&f);
}

/* Textures come one by one, while others stream. Then nothing is seen any more. Returns how many
 * heaps stay. */
static uint32_t heaps_that_stay(bool separate)
{
    enum { TEXTURES = 48 };
    SluiceTextureId ids[TEXTURES];
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                 .separatePackedTiles = separate};
    fixture_open(&f, CAPACITY, true);
    configure(&config);
    now = 1;
    for (uint32_t i = 0; i < TEXTURES; i++) { /* 21 regular tiles and a packed one each */
        SluiceStreamedTextureDesc desc = full_chain(512, 512, 128, 128);
        ids[i] = fixture_add(&f, &desc);
        fixture_feed(&f, ids[i], 0, now, 1000000);
        fixture_load(&f);
    }
    assert_int_equal(fixture_statistics(&f).mappedTileCount, 22 * TEXTURES);
    assert_in_range(f.heaps.living_count, 66, 71); /* with the reserve of 64 slots, and one more */
    config.targetHeapCount = 1;
    configure(&config);
    for (uint32_t i = 0; i < 200; i++) {
        ++now;
        for (uint32_t k = 0; k < TEXTURES; k++)
            fixture_feed(&f, ids[k], SLUICE_MIP_UNTOUCHED, now, 0);
        CHECK_OK(sluiceCompleteRetireValue(f.manager, now - 2));
        CHECK_OK(sluiceEvacuateHeaps(f.manager, 8));
        assert_true(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, now) >= 0);
        release_empty_heaps();
    }
    for (uint32_t i = 0; i < TEXTURES; i++)
        assert_int_equal(count_mapped(ids[i], 21, 1), 1);
    uint32_t count = f.heaps.living_count;
    fixture_close(&f);
    return count;
}

static void packed_tiles_in_heaps_of_their_own_let_the_others_go(void **state)
{
    (void)state;
    assert_true(heaps_that_stay(false) >= 40);
    assert_int_equal(heaps_that_stay(true), 48 / CAPACITY);
}

/* Packed and other tiles both use the last slots. No slot stays free while a request waits. */
static void tiles_take_slots_of_the_other_kind_before_they_wait(void **state)
{
    (void)state;
    SluiceStreamedTextureDesc desc = full_chain(1024, 1024, 128, 128);
    fixture_open(&f, CAPACITY, true);
    configure(&(SluiceStreamedTextureManagerConfig){.structSize =
                                                        sizeof(SluiceStreamedTextureManagerConfig),
                                                    .maxHeapCount = 2,
                                                    .separatePackedTiles = true});
    now = 1;
    SluiceTextureId id = fixture_add(&f, &desc);
    fixture_feed(&f, id, 0, now, 1000000);
    fixture_load(&f);
    SluiceStreamedTextureStatistics stats = fixture_statistics(&f);
    assert_int_equal(stats.heapCount, 2);
    assert_int_equal(stats.freeSlotCount, stats.reservedSlotCount);
    for (uint32_t i = 0; i < stats.freeSlotCount; i++) {
        SluiceTextureId other = fixture_add(&f, &desc);
        fixture_load(&f);
        assert_int_equal(fixture_state(&f, other, 85), SLUICE_TILE_STATE_MAPPED);
    }
    assert_int_equal(fixture_statistics(&f).freeSlotCount, 0);
    fixture_close(&f);
}

static void without_eviction_requests_wait(void **state)
{
    (void)state;
    SluiceTextureId id = open_with_everything_mapped();
    SluiceStreamedTextureDesc desc = full_chain(1024, 1024, 128, 128);
    SluiceTextureId other = fixture_add(&f, &desc);
    uint32_t heaps = f.heaps.living_count;
    configure(&(SluiceStreamedTextureManagerConfig){.structSize =
                                                        sizeof(SluiceStreamedTextureManagerConfig),
                                                    .maxHeapCount = heaps,
                                                    .noEviction = true});
    for (uint32_t i = 0; i < 20; i++) {
        fixture_feed(&f, other, 0, now, 1000000);
        assert_int_equal(frame(id, 0), 0);
    }
    assert_int_equal(count_mapped(id, 0, TILES), TILES);
    assert_true(fixture_statistics(&f).requestedTileCount > 0);
    configure(&(SluiceStreamedTextureManagerConfig){
        .structSize = sizeof(SluiceStreamedTextureManagerConfig), .maxHeapCount = heaps});
    uint32_t unmapped = 0;
    for (uint32_t i = 0; i < 20; i++) {
        fixture_feed(&f, other, 0, now, 1000000);
        unmapped += frame(id, 0);
    }
    assert_true(unmapped > 0);
    fixture_close(&f);
}

static void without_mip_bias_it_is_0_at_once(void **state)
{
    (void)state;
    SluiceTextureId id = open_with_everything_mapped();
    configure(&(SluiceStreamedTextureManagerConfig){.structSize =
                                                        sizeof(SluiceStreamedTextureManagerConfig),
                                                    .maxHeapCount = 2,
                                                    .targetHeapCount = 2});
    for (uint32_t i = 0; i < 10; i++)
        frame(id, 8);
    assert_true(fixture_statistics(&f).globalMipBias > 0);
    configure(&(SluiceStreamedTextureManagerConfig){.structSize =
                                                        sizeof(SluiceStreamedTextureManagerConfig),
                                                    .maxHeapCount = 2,
                                                    .targetHeapCount = 2,
                                                    .noMipBias = true});
    frame(id, 8);
    assert_int_equal(fixture_statistics(&f).globalMipBias, 0);
    for (uint32_t i = 0; i < 10; i++)
        frame(id, 8);
    assert_int_equal(fixture_statistics(&f).globalMipBias, 0);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heaps_fall_to_the_target_and_the_coarse_levels_stay),
        cmocka_unit_test(standby_tiles_go_first),
        cmocka_unit_test(evacuation_evicts_no_more_tiles_than_asked_and_ends),
        cmocka_unit_test(evacuation_survives_a_refused_allocation),
        cmocka_unit_test(heaps_with_packed_tiles_are_not_evacuated),
        cmocka_unit_test(packed_tiles_in_heaps_of_their_own_let_the_others_go),
        cmocka_unit_test(tiles_take_slots_of_the_other_kind_before_they_wait),
        cmocka_unit_test(without_eviction_requests_wait),
        cmocka_unit_test(without_mip_bias_it_is_0_at_once),
    };
    return RUN_TESTS(tests);
}
