/** Forgetting an unwanted texture, and evicting one: memory that is freed, and reloading. */
#include "core/sound.h"

#include <string.h>

static const uint32_t all_tiles[] = {0, 1, 2, 3, 4, 5};

static struct fixture f;

static SluiceTextureId open_loaded(bool always_map_packed)
{
    fixture_open(&f, 8, always_map_packed);
    fixture_configure(&f, 100, 0, 2, 50);
    SluiceTextureId id = fixture_add_small(&f);
    sound_feed(&f, id, 0, 1, 0);
    sound_load(&f);
    return id;
}

static uint8_t shown(SluiceTextureId id)
{
    uint8_t map[4];
    CHECK_OK(sluiceWriteMinMipData(f.manager, id, 2, sizeof map, map));
    for (uint32_t i = 1; i < sizeof map; i++)
        assert_int_equal(map[i], map[0]);
    return map[0];
}

static void its_tiles_are_free_and_its_slots_when_the_retire_value_has_completed(void **state)
{
    (void)state;
    SluiceTextureId id = open_loaded(false);
    sound_feed(&f, id, SLUICE_MIP_UNTOUCHED, 2, 0);
    assert_int_equal(shown(id), 0);
    const uint64_t taken = fixture_statistics(&f).freeSlotCount;
    SOUND(&f, sluiceForgetStreamedTexture(f.manager, id, 7));
    for (uint32_t i = 0; i < 6; i++)
        CHECK_STATE(&f, id, i, FREE);
    assert_int_equal(shown(id), SLUICE_MIP_UNTOUCHED);
    assert_int_equal(fixture_statistics(&f).retiringSlotCount, 6);
    SOUND(&f, fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 7));
    assert_int_equal(f.count, 0);
    SOUND(&f, sluiceCompleteRetireValue(f.manager, 7));
    assert_int_equal(fixture_statistics(&f).retiringSlotCount, 0);
    assert_int_equal(fixture_statistics(&f).freeSlotCount, taken + 6);
    fixture_close(&f);
}

static void tiles_that_are_listed_to_be_unmapped_are_listed_no_more(void **state)
{
    (void)state;
    SluiceTextureId id = open_loaded(false);
    sound_feed(&f, id, SLUICE_MIP_UNTOUCHED, 2, 0);
    SOUND(&f, sluiceTrimStandbyTiles(f.manager, 0));
    SOUND(&f, sluiceForgetStreamedTexture(f.manager, id, 1));
    SOUND(&f, fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 1));
    assert_int_equal(f.count, 0);
    fixture_close(&f);
}

static void the_next_map_requests_what_it_asks_for_like_the_first(void **state)
{
    (void)state;
    SluiceTextureId id = open_loaded(false);
    sound_feed(&f, id, SLUICE_MIP_UNTOUCHED, 2, 0);
    SOUND(&f, sluiceForgetStreamedTexture(f.manager, id, 0));
    sound_feed(&f, id, 0, 3, 0);
    for (uint32_t i = 0; i < 6; i++)
        CHECK_STATE(&f, id, i, REQUESTED);
    sound_load(&f);
    assert_int_equal(shown(id), 0);
    fixture_close(&f);
}

static void refuse(SluiceTextureId id)
{
    REFUSED(&f, 1, &id, sluiceForgetStreamedTexture(f.manager, id, 1), SLUICE_NOT_READY);
}

static void it_stays_while_it_is_wanted_or_loading(void **state)
{
    (void)state;
    fixture_open(&f, 8, false);
    fixture_configure(&f, 100, 0, 2, 50);
    SluiceTextureId id = fixture_add_small(&f);
    sound_feed(&f, id, 0, 1, 0);
    refuse(id);
    SOUND(&f, fixture_to_map(&f, id));
    refuse(id);
    sound_feed(&f, id, SLUICE_MIP_UNTOUCHED, 2, 0); /* canceled, not answered */
    refuse(id);
    SOUND(&f, sluiceReportCanceledTiles(f.manager, id, 5, all_tiles, 0));
    refuse(id);
    SOUND(&f, sluiceUpdateTilesMapping(f.manager, id, 1, &all_tiles[5]));
    CHECK_STATE(&f, id, 5, STANDBY);
    SOUND(&f, sluiceForgetStreamedTexture(f.manager, id, 1));
    CHECK_STATE(&f, id, 5, FREE);
    fixture_close(&f);
}

static void it_stays_while_a_wanted_tile_waits_for_its_retry(void **state)
{
    (void)state;
    fixture_open(&f, 8, false);
    fixture_configure(&f, 100, 0, 2, 50);
    SluiceTextureId id = fixture_add_small(&f);
    sound_feed(&f, id, 0, 1, 0);
    SOUND(&f, fixture_to_map(&f, id));
    SOUND(&f, sluiceReportFailedTiles(f.manager, id, 6, all_tiles, 1));
    refuse(id);
    sound_feed(&f, id, SLUICE_MIP_UNTOUCHED, 2, 0);
    SOUND(&f, sluiceForgetStreamedTexture(f.manager, id, 1));
    fixture_close(&f);
}

static void packed_tiles_that_are_always_mapped_keep_it(void **state)
{
    (void)state;
    SluiceTextureId id = open_loaded(true);
    sound_feed(&f, id, SLUICE_MIP_UNTOUCHED, 2, 0);
    refuse(id);
    fixture_close(&f);
}

static void nothing_stays_of_it_in_host_memory(void **state)
{
    (void)state;
    fixture_open(&f, 8, false);
    fixture_configure(&f, 100, 0, 2, 50);
    SluiceTextureId id = fixture_add_small(&f);
    sound_feed(&f, id, 0, 1, 0);
    sound_load(&f);
    sound_feed(&f, id, SLUICE_MIP_UNTOUCHED, 2, 0);
    SOUND(&f, sluiceForgetStreamedTexture(f.manager, id, 0));
    const uint64_t before = fixture_statistics(&f).hostMemorySize;
    for (uint64_t i = 0; i < 50; i++) { /* the freed memory suffices for the next round */
        sound_feed(&f, id, 0, 3 + 2 * i, 0);
        sound_load(&f);
        sound_feed(&f, id, SLUICE_MIP_UNTOUCHED, 4 + 2 * i, 0);
        SOUND(&f, sluiceForgetStreamedTexture(f.manager, id, 0));
    }
    assert_int_equal(fixture_statistics(&f).hostMemorySize, before);
    fixture_close(&f);
}

static void retire_values_do_not_go_back(void **state)
{
    (void)state;
    SluiceTextureId id = open_loaded(false);
    sound_feed(&f, id, SLUICE_MIP_UNTOUCHED, 2, 0);
    SOUND(&f, fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 5));
    REFUSED(&f, 1, &id, sluiceForgetStreamedTexture(f.manager, id, 4), SLUICE_ERROR_TIME_BACKWARDS);
    SOUND(&f, sluiceForgetStreamedTexture(f.manager, id, 5));
    SOUND(&f, sluiceRemoveStreamedTexture(f.manager, id, 5));
    CHECK_RESULT(sluiceForgetStreamedTexture(f.manager, id, 5), SLUICE_ERROR_STALE_TEXTURE);
    fixture_close(&f);
}

static void an_evicted_texture_is_unmapped_and_comes_back_with_its_next_map(void **state)
{
    (void)state;
    SluiceTextureId id = open_loaded(true);
    SOUND(&f, sluiceEvictStreamedTexture(f.manager, id, 0));
    assert_int_equal(shown(id), 0); /* until it is unmapped */
    SOUND(&f, fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 7));
    assert_int_equal(f.count, 5);
    for (uint32_t i = 0; i < 5; i++)
        CHECK_STATE(&f, id, i, FREE);
    CHECK_STATE(&f, id, 5, MAPPED); /* packed tiles are always mapped */
    assert_int_equal(shown(id), 2);
    SOUND(&f, sluiceCompleteRetireValue(f.manager, 7));
    sound_feed(&f, id, 0, 8, 0);
    for (uint32_t i = 0; i < 5; i++)
        CHECK_STATE(&f, id, i, REQUESTED);
    sound_load(&f);
    assert_int_equal(shown(id), 0);
    fixture_close(&f);
}

static void tiles_that_eviction_keeps_come_back_without_a_load(void **state)
{
    (void)state;
    SluiceTextureId id = open_loaded(false);
    SOUND(&f, sluiceEvictStreamedTexture(f.manager, id, UINT32_MAX));
    for (uint32_t i = 0; i < 6; i++)
        CHECK_STATE(&f, id, i, STANDBY);
    SOUND(&f, fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 1));
    assert_int_equal(f.count, 0);
    SOUND(&f, sluiceEvictStreamedTexture(f.manager, id, 3));
    SOUND(&f, fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 1));
    assert_int_equal(f.count, 3); /* finer levels first */
    for (uint32_t i = 0; i < 6; i++)
        if (i < 3)
            CHECK_STATE(&f, id, i, FREE);
        else
            CHECK_STATE(&f, id, i, STANDBY);
    const uint64_t handed_out = fixture_statistics(&f).handedOutTotal;
    sound_feed(&f, id, 1, 2, 0);
    CHECK_STATE(&f, id, 4, MAPPED);
    CHECK_STATE(&f, id, 5, MAPPED);
    sound_load(&f);
    assert_int_equal(fixture_statistics(&f).handedOutTotal, handed_out);
    fixture_close(&f);
}

static void eviction_cancels_loads_of_followers_too(void **state)
{
    (void)state;
    fixture_open(&f, 32, false);
    fixture_configure(&f, 100, 0, 2, 50);
    SluiceTextureId id = fixture_add_small(&f), follower = fixture_add_small(&f);
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, follower, id));
    sound_feed(&f, id, 0, 1, 0);
    SOUND(&f, fixture_to_map(&f, follower));
    SOUND(&f, sluiceEvictStreamedTexture(f.manager, id, 0));
    for (uint32_t i = 0; i < 6; i++) {
        CHECK_STATE(&f, id, i, FREE);
        CHECK_STATE(&f, follower, i, CANCELED);
    }
    sound_feed(&f, id, 0, 2, 0);
    SOUND(&f, sluiceEvictStreamedTexture(f.manager, follower, 0));
    for (uint32_t i = 0; i < 6; i++) {
        CHECK_STATE(&f, id, i, REQUESTED);
        CHECK_STATE(&f, follower, i, CANCELED);
    }
    const SluiceTextureId wrong[] = {SLUICE_NO_TEXTURE, SLUICE_ALL_TEXTURES, id + 7};
    for (uint32_t i = 0; i < 3; i++)
        REFUSED(&f, 1, &id, sluiceEvictStreamedTexture(f.manager, wrong[i], 0),
                SLUICE_ERROR_UNKNOWN_TEXTURE);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(its_tiles_are_free_and_its_slots_when_the_retire_value_has_completed),
        cmocka_unit_test(tiles_that_are_listed_to_be_unmapped_are_listed_no_more),
        cmocka_unit_test(the_next_map_requests_what_it_asks_for_like_the_first),
        cmocka_unit_test(it_stays_while_it_is_wanted_or_loading),
        cmocka_unit_test(it_stays_while_a_wanted_tile_waits_for_its_retry),
        cmocka_unit_test(packed_tiles_that_are_always_mapped_keep_it),
        cmocka_unit_test(nothing_stays_of_it_in_host_memory),
        cmocka_unit_test(retire_values_do_not_go_back),
        cmocka_unit_test(an_evicted_texture_is_unmapped_and_comes_back_with_its_next_map),
        cmocka_unit_test(tiles_that_eviction_keeps_come_back_without_a_load),
        cmocka_unit_test(eviction_cancels_loads_of_followers_too),
    };
    return RUN_TESTS(tests);
}
