/* Textures of a set share the history of their maps. Sharing changes no result: docs/manager.md,
 * "Sets". */
#include "core/fixture.h"

/* Heaps of 6 slots, one at most: too much is wanted from 22 tiles on. All happens at one time. */
static void feed_all(struct fixture *f, uint32_t count, const SluiceTextureId *ids, uint8_t level,
                     uint64_t timeout)
{
    for (uint32_t i = 0; i < count; i++)
        fixture_feed(f, ids[i], level, 1, timeout);
}

static void set_config(struct fixture *f, uint32_t prefetch_levels)
{
    const SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                       .numExtraStandbyTiles = 100,
                                                       .maxHeapCount = 1,
                                                       .missesToExpire = 1,
                                                       .prefetchLevels = prefetch_levels};
    CHECK_OK(sluiceSetConfig(f->manager, &config));
}

static uint32_t bias_after_handing_out(struct fixture *f)
{
    assert_true(fixture_to_map(f, SLUICE_ALL_TEXTURES) >= 0);
    return fixture_statistics(f).globalMipBias;
}

/* The bias looks at maps that found a state: 6 textures hold something, so 6 of these are needed.
 */
static void an_empty_map_of_a_prefetched_primary_is_none_for_a_follower_without_state(void **state)
{
    (void)state;
    for (uint32_t more = 0; more < 2; more++) {
        struct fixture f;
        fixture_open(&f, 6, false);
        SluiceTextureId primary = fixture_add_small(&f), kept[2], others[4];
        for (uint32_t i = 0; i < 2; i++)
            kept[i] = fixture_add_small(&f);
        feed_all(&f, 2, kept, 2, 1000);
        set_config(&f, 1);
        assert_int_equal(bias_after_handing_out(&f), 0);
        CHECK_STATE(&f, primary, 4, CANCELED); /* prefetched, so it has a state */
        set_config(&f, 0);
        SluiceTextureId follower = fixture_add_small(&f);
        CHECK_OK(sluiceSetPrimaryTexture(f.manager, follower, primary));
        for (uint32_t i = 0; i < 4; i++)
            others[i] = fixture_add_small(&f);
        feed_all(&f, 4, others, 0, 0);
        uint32_t bias = bias_after_handing_out(&f);
        assert_true(bias > 0);
        feed_all(&f, 4, others, SLUICE_MIP_UNTOUCHED, 0);
        for (; bias > 0; bias--) {
            feed_all(&f, 2, kept, 2, 1000);
            assert_int_equal(bias_after_handing_out(&f), bias - 1);
        }
        feed_all(&f, 4, others, 0, 0);
        fixture_feed(&f, primary, SLUICE_MIP_UNTOUCHED, 1, 0);
        if (more)
            fixture_feed(&f, primary, SLUICE_MIP_UNTOUCHED, 1, 0);
        assert_int_equal(bias_after_handing_out(&f) > 0, more);
        fixture_close(&f);
    }
}

/* A history is shared up to 65 536 regular tiles: one row more has another one. */
static void sets_of_large_textures_decide_as_small_ones_do(void **state)
{
    (void)state;
    for (uint32_t rows = 256; rows <= 257; rows++) {
        struct fixture f;
        fixture_open(&f, 1024, false);
        SluiceStreamedTextureDesc desc = {256 * 16, rows * 16, 2, 1, 1, 16, 16, 0, 0};
        SluiceTextureId primary = fixture_add(&f, &desc), follower = fixture_add(&f, &desc);
        CHECK_OK(sluiceSetPrimaryTexture(f.manager, follower, primary));
        for (uint64_t time = 0; time < 4; time++) {
            fixture_feed(&f, primary, time % 2 ? SLUICE_MIP_UNTOUCHED : 0, time, 0);
            const SluiceTileState state_now =
                time % 2 ? SLUICE_TILE_STATE_FREE : SLUICE_TILE_STATE_REQUESTED;
            assert_int_equal(fixture_statistics(&f).requestedTileCount,
                             time % 2 ? 0 : 2 * (256 * rows + 1));
            for (uint32_t tile = 0; tile <= 256 * rows; tile += 255)
                assert_int_equal(fixture_state(&f, follower, tile), state_now);
        }
        fixture_close(&f);
    }
}

/* Alone: who leaves takes a copy, and whoever is left last keeps the history itself. */
static void each_member_goes_on_by_itself_when_the_set_ends(void **state)
{
    (void)state;
    for (uint32_t first = 0; first < 4; first++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        SluiceTextureId ids[4];
        for (uint32_t i = 0; i < 4; i++) {
            ids[i] = fixture_add_small(&f);
            if (i)
                CHECK_OK(sluiceSetPrimaryTexture(f.manager, ids[i], ids[0]));
        }
        fixture_feed(&f, ids[0], 0, 0, 10);
        for (uint32_t i = 0; i < 4; i++) {
            SluiceTextureId id = ids[(first + i) % 4];
            CHECK_OK(sluiceSetPrimaryTexture(f.manager, id, SLUICE_NO_TEXTURE));
        }
        CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[first], 0));
        for (uint32_t i = 1; i < 4; i++)
            fixture_feed_region(&f, ids[(first + i) % 4], i, 0, 5, 10);
        for (uint32_t i = 1; i < 4; i++) /* the common map lapses, their own ones do not */
            fixture_feed(&f, ids[(first + i) % 4], SLUICE_MIP_UNTOUCHED, 10, 10);
        for (uint32_t i = 1; i < 4; i++)
            for (uint32_t tile = 0; tile < 4; tile++)
                assert_int_equal(fixture_state(&f, ids[(first + i) % 4], tile),
                                 tile == i ? SLUICE_TILE_STATE_REQUESTED : SLUICE_TILE_STATE_FREE);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sets_of_large_textures_decide_as_small_ones_do),
        cmocka_unit_test(each_member_goes_on_by_itself_when_the_set_ends),
        cmocka_unit_test(an_empty_map_of_a_prefetched_primary_is_none_for_a_follower_without_state),
    };
    return RUN_TESTS(tests);
}
