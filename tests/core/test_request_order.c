#include "core/fixture.h"

/* 512x256 in 128x128: level 0 is 4x2 (0 to 7), level 1 is 2x1 (8, 9), 10 is packed. */
static SluiceTextureId add_wide(struct fixture *f)
{
    SluiceStreamedTextureDesc desc = full_chain(512, 256, 128, 128);
    return fixture_add(f, &desc);
}

static void packed_tiles_come_first_and_coarse_before_fine(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceStreamedTextureDesc desc = full_chain(1024, 1024, 128, 128);
    desc.packedTileCount = 2;
    SluiceTextureId id = fixture_add(&f, &desc);
    fixture_feed(&f, id, 0, 0, 0);
    CHECK_OK(fixture_to_map(&f, id));
    assert_int_equal(f.count, 64 + 16 + 4 + 1 + 2);
    assert_true(f.tiles[0].tileIndex == 85 && f.tiles[1].tileIndex == 86);
    for (uint32_t i = 2; i < f.count; i++)
        assert_true(f.tiles[i].mipLevel <= f.tiles[i - 1].mipLevel);
    fixture_close(&f);
}

static void within_a_level_what_more_regions_want_comes_first(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId id = add_wide(&f);
    const uint8_t map[8] = {1, 255, 1, 0, 255, 255, 255, 255};
    fixture_feed_map(&f, id, map, 0, 0);
    CHECK_OK(fixture_to_map(&f, id));
    assert_true(LISTED(&f, id, 10, 9, 8, 3)); /* 9 for two regions, 8 for one */
    fixture_close(&f);
}

static void equal_requests_are_served_in_the_order_in_which_they_came(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId a = add_wide(&f), b = add_wide(&f);
    fixture_feed(&f, a, 2, 0, 100);
    fixture_feed(&f, b, 2, 0, 100);
    fixture_load(&f);
    fixture_feed_region(&f, b, 7, 1, 1, 100);
    fixture_feed_region(&f, a, 0, 1, 2, 100);
    fixture_feed_region(&f, b, 0, 1, 3, 100);
    fixture_feed_region(&f, a, 3, 1, 4, 100);
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f.count, 4);
    const SluiceTextureId ids[] = {b, a, b, a};
    const uint32_t tiles[] = {9, 8, 8, 9};
    for (uint32_t i = 0; i < 4; i++)
        assert_true(f.tiles[i].textureId == ids[i] && f.tiles[i].tileIndex == tiles[i]);
    fixture_close(&f);
}

/* Levels come first, then priorities, then age. A follower has its primary's priority. */
static void priorities_order_tiles_of_one_level(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId ids[3] = {add_wide(&f), add_wide(&f), add_wide(&f)};
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, ids[2], ids[1]));
    fixture_feed(&f, ids[0], 0, 0, 100);
    fixture_feed(&f, ids[1], 0, 0, 100);
    const uint64_t calls = f.memory.calls;
    CHECK_OK(sluiceSetTexturePriority(f.manager, ids[1], 4)); /* also reorders waiting requests */
    CHECK_OK(sluiceSetTexturePriority(f.manager, ids[2], -9));
    assert_int_equal(f.memory.calls, calls);
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f.count, 3 * 11);
    for (uint32_t i = 1; i < f.count; i++) {
        bool last = f.tiles[i].textureId == ids[0], before = f.tiles[i - 1].textureId == ids[0];
        assert_true(f.tiles[i].mipLevel <= f.tiles[i - 1].mipLevel);
        assert_true(f.tiles[i].mipLevel < f.tiles[i - 1].mipLevel || last >= before);
    }
    CHECK_RESULT(sluiceSetTexturePriority(f.manager, ids[0], 17), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceSetTexturePriority(f.manager, ids[0], -17), SLUICE_ERROR_INVALID_ARGUMENT);
    fixture_close(&f);
}

/* Checks the positions of textures 0 to 2 among requests of one level. */
static void check_places(struct fixture *f, const SluiceTextureId ids[3], const uint32_t places[3])
{
    CHECK_OK(fixture_to_map(f, SLUICE_ALL_TEXTURES));
    assert_true(f->count > 0);
    for (uint32_t i = 0, place = 0; i < f->count; i++) {
        uint32_t before = place;
        for (uint32_t k = 0; k < 3; k++)
            if (f->tiles[i].textureId == ids[k])
                place = places[k];
        if (i > 0 && f->tiles[i].mipLevel == f->tiles[i - 1].mipLevel)
            assert_true(place >= before);
    }
}

/* Waiting requests get the priority of a new primary, and lose that of a removed one. Later changes
 * of the priority start from the present value. */
static void waiting_requests_follow_the_priority_of_their_primary(void **state)
{
    (void)state;
    static const uint32_t places[4][3] = {{1, 0, 0}, {1, 0, 2}, {1, 0, 2}, {1, 0, 0}};
    for (uint32_t step = 0; step < 4; step++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        SluiceTextureId ids[3] = {add_wide(&f), add_wide(&f), add_wide(&f)};
        CHECK_OK(sluiceSetTexturePriority(f.manager, ids[1], 4));
        if (step == 1 || step == 2)
            CHECK_OK(sluiceSetPrimaryTexture(f.manager, ids[2], ids[1]));
        for (uint32_t i = 0; i < 3; i++)
            if (i < 2 || step == 0 || step == 3)
                fixture_feed(&f, ids[i], 0, 0, 100);
        if (step == 0 || step == 3)
            CHECK_OK(sluiceSetPrimaryTexture(f.manager, ids[2], ids[1]));
        if (step == 1)
            CHECK_OK(sluiceSetPrimaryTexture(f.manager, ids[2], SLUICE_NO_TEXTURE));
        if (step == 2)
            CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[1], 0));
        if (step == 3)
            CHECK_OK(sluiceSetTexturePriority(f.manager, ids[1], 1)); /* still before texture 0 */
        check_places(&f, ids, places[step]);
        fixture_close(&f);
    }
}

static uint32_t resident_in(const struct fixture *f, SluiceTextureId id, uint32_t level)
{
    SluiceTextureLevelStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetTextureLevelStatistics(f->manager, id, level, &s));
    return s.residentTileCount;
}

/* 8 slots for two textures of 4, 1 and 1 tiles: coarse levels of both fit, and one level 0. */
static void the_level_that_does_not_fit_goes_to_priority(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 8, false);
    f.heaps.limit = 1;
    SluiceTextureId ids[2] = {fixture_add_small(&f), fixture_add_small(&f)};
    uint64_t time = 0;
    for (uint32_t turn = 0; turn < 4; turn++) {
        CHECK_OK(sluiceSetTexturePriority(f.manager, ids[turn % 2], 2));
        CHECK_OK(sluiceSetTexturePriority(f.manager, ids[1 - turn % 2], turn / 2 ? -3 : 1));
        for (uint32_t frame = 0; frame < 8; frame++) {
            time++;
            fixture_feed(&f, ids[0], 0, time, 100);
            fixture_feed(&f, ids[1], 0, time, 100);
            fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0);
            fixture_to_map(&f, SLUICE_ALL_TEXTURES);
            fixture_answer_mapped(&f);
        }
        assert_int_equal(resident_in(&f, ids[turn % 2], 0), 4);
        for (uint32_t k = 0; k < 2; k++)
            assert_true(resident_in(&f, ids[k], 1) == 1 && resident_in(&f, ids[k], 2) == 1);
        const uint64_t loads = fixture_statistics(&f).mappedTotal;
        fixture_feed(&f, ids[1], 0, ++time, 100);
        CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
        assert_true(f.count == 0 && fixture_statistics(&f).mappedTotal == loads); /* it ends */
    }
    fixture_close(&f);
}

static void within_one_map_regions_are_served_row_by_row(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId id = add_wide(&f);
    fixture_feed(&f, id, 1, 0, 100);
    fixture_load(&f);
    const uint8_t map[8] = {255, 0, 255, 0, 0, 255, 255, 0};
    fixture_feed_map(&f, id, map, 1, 100);
    CHECK_OK(fixture_to_map(&f, id));
    assert_true(LISTED(&f, id, 1, 3, 4, 7));
    fixture_close(&f);
}

static void one_texture_can_be_asked_for_alone(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId a = add_wide(&f), b = add_wide(&f);
    fixture_feed(&f, a, 0, 0, 0);
    fixture_feed_region(&f, b, 0, 0, 0, 0);
    uint32_t count = 0;
    CHECK_OK(sluiceGetTilesToMap(f.manager, SLUICE_ALL_TEXTURES, &count, NULL));
    assert_int_equal(count, 14);
    CHECK_OK(sluiceGetTilesToMap(f.manager, b, &count, NULL));
    assert_int_equal(count, 3);
    CHECK_OK(fixture_to_map(&f, b));
    assert_true(LISTED(&f, b, 10, 8, 0));
    CHECK_STATE(&f, a, 0, REQUESTED);
    CHECK_OK(fixture_to_map(&f, b));
    assert_int_equal(f.count, 0);
    CHECK_OK(fixture_to_map(&f, a));
    assert_int_equal(f.count, 11);
    fixture_close(&f);
}

static void little_room_keeps_the_order(void **state)
{
    (void)state;
    struct fixture whole, parts;
    fixture_open(&whole, 7, false);
    fixture_open(&parts, 7, false);
    SluiceStreamedTextureDesc desc = full_chain(1000, 700, 128, 64);
    SluiceTextureId id = fixture_add(&whole, &desc);
    assert_true(id == fixture_add(&parts, &desc));
    uint8_t map[128];
    uint64_t random = 3;
    for (uint32_t i = 0; i < sizeof map; i++)
        map[i] = next_random(&random) % 6;
    fixture_feed_map(&whole, id, map, 0, 0);
    fixture_feed_map(&parts, id, map, 0, 0);
    CHECK_OK(fixture_to_map(&whole, id));
    uint32_t done = 0;
    SluiceResult result;
    do {
        result = fixture_to_map_at_most(&parts, SLUICE_ALL_TEXTURES, 3);
        for (uint32_t i = 0; i < parts.count; i++, done++) {
            assert_int_equal(parts.tiles[i].tileIndex, whole.tiles[done].tileIndex);
            assert_int_equal(parts.tiles[i].slot, whole.tiles[done].slot);
        }
    } while (result == SLUICE_INCOMPLETE);
    CHECK_OK(result);
    assert_int_equal(done, whole.count);
    fixture_close(&whole);
    fixture_close(&parts);
}

static void unread_lists_survive_later_updates(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    fixture_configure(&f, 0, 0, 1, 0);
    SluiceTextureId a = fixture_add_small(&f), b = fixture_add_small(&f), c = fixture_add_small(&f),
                    d = fixture_add_small(&f);
    fixture_feed(&f, a, 0, 0, 0);
    fixture_load(&f);
    fixture_feed(&f, a, SLUICE_MIP_UNTOUCHED, 1, 0); /* six to unmap */
    fixture_feed(&f, b, 0, 1, 0);
    fixture_feed_region(&f, c, 0, 0, 1, 0);
    CHECK_OK(fixture_to_map(&f, b));
    CHECK_OK(fixture_to_map(&f, c));
    uint32_t tile = 0;
    CHECK_OK(sluiceReportFailedTiles(f.manager, c, 1, &tile, 1));
    fixture_feed(&f, b, SLUICE_MIP_UNTOUCHED, 2, 0); /* six to cancel */
    fixture_feed_region(&f, d, 3, 0, 2, 0);          /* three to map */
    for (uint64_t t = 3; t < 40; t++) {
        fixture_feed(&f, a, SLUICE_MIP_UNTOUCHED, t, 0);
        fixture_feed(&f, b, SLUICE_MIP_UNTOUCHED, t, 0);
        fixture_feed_region(&f, c, 0, 0, t, 0);
        fixture_feed_region(&f, d, 3, 0, t, 0);
    }
    CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 0));
    assert_true(LISTED(&f, a, 0, 1, 2, 3, 4, 5));
    CHECK_OK(fixture_to_cancel(&f, SLUICE_ALL_TEXTURES));
    assert_true(LISTED(&f, b, 0, 1, 2, 3, 4, 5));
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    assert_true(LISTED(&f, d, 5, 4, 3));
    f.count = 9;
    CHECK_OK(sluiceGetGivenUpTiles(f.manager, &f.count, f.tiles));
    assert_true(LISTED(&f, c, 0));
    SluiceMinMipRect rects[9];
    uint32_t count = 9;
    CHECK_OK(sluiceGetMinMipUpdates(f.manager, &count, rects));
    assert_int_equal(count, 4);
    fixture_close(&f);
}

static void packed_tiles_can_always_be_wanted(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, true);
    SluiceTextureId id = fixture_add_small(&f);
    CHECK_STATE(&f, id, 5, REQUESTED); /* before any feedback */
    CHECK_STATE(&f, id, 4, FREE);
    CHECK_OK(fixture_to_map(&f, id));
    assert_true(LISTED(&f, id, 5));
    fixture_answer_mapped(&f);
    fixture_feed(&f, id, 0, 0, 0);
    fixture_load(&f);
    fixture_feed(&f, id, SLUICE_MIP_UNTOUCHED, 1, 0);
    CHECK_STATE(&f, id, 4, STANDBY);
    CHECK_STATE(&f, id, 5, MAPPED);
    CHECK_OK(sluiceTrimStandbyTiles(f.manager, 0));
    CHECK_OK(fixture_to_unmap(&f, id, 0));
    CHECK_STATE(&f, id, 5, MAPPED);
    fixture_close(&f);
}

static void packed_tiles_can_follow_the_feedback(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId id = fixture_add_small(&f);
    CHECK_STATE(&f, id, 5, FREE);
    fixture_feed_region(&f, id, 2, 2, 0, 0); /* the packed level itself */
    CHECK_STATE(&f, id, 5, REQUESTED);
    CHECK_STATE(&f, id, 4, FREE);
    fixture_load(&f);
    fixture_feed(&f, id, SLUICE_MIP_UNTOUCHED, 1, 0);
    CHECK_STATE(&f, id, 5, STANDBY);
    fixture_feed_region(&f, id, 1, 200, 2, 0); /* beyond the chain: its last level */
    CHECK_STATE(&f, id, 5, MAPPED);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packed_tiles_come_first_and_coarse_before_fine),
        cmocka_unit_test(within_a_level_what_more_regions_want_comes_first),
        cmocka_unit_test(equal_requests_are_served_in_the_order_in_which_they_came),
        cmocka_unit_test(priorities_order_tiles_of_one_level),
        cmocka_unit_test(waiting_requests_follow_the_priority_of_their_primary),
        cmocka_unit_test(the_level_that_does_not_fit_goes_to_priority),
        cmocka_unit_test(within_one_map_regions_are_served_row_by_row),
        cmocka_unit_test(one_texture_can_be_asked_for_alone),
        cmocka_unit_test(little_room_keeps_the_order),
        cmocka_unit_test(unread_lists_survive_later_updates),
        cmocka_unit_test(packed_tiles_can_always_be_wanted),
        cmocka_unit_test(packed_tiles_can_follow_the_feedback),
    };
    return RUN_TESTS(tests);
}
