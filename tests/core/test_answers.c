#include "core/fixture.h"

typedef SluiceResult (*answer)(SluiceStreamedTextureManager *, SluiceTextureId, uint32_t,
                               const uint32_t *);

static SluiceResult say_mapped(SluiceStreamedTextureManager *m, SluiceTextureId id, uint32_t count,
                               const uint32_t *tiles)
{
    return sluiceUpdateTilesMapping(m, id, count, tiles);
}

static SluiceResult say_failed(SluiceStreamedTextureManager *m, SluiceTextureId id, uint32_t count,
                               const uint32_t *tiles)
{
    return sluiceReportFailedTiles(m, id, count, tiles, 1000);
}

static SluiceResult say_canceled(SluiceStreamedTextureManager *m, SluiceTextureId id,
                                 uint32_t count, const uint32_t *tiles)
{
    return sluiceReportCanceledTiles(m, id, count, tiles, 0);
}

static const answer answers[] = {say_mapped, say_failed, say_canceled};

static void check_answer_refused(struct fixture *f, SluiceTextureId id, uint32_t count,
                                 const uint32_t *tiles, SluiceResult expected)
{
    for (uint32_t i = 0; i < 3; i++) {
        uint64_t digest = fixture_digest(f, 1, &id);
        CHECK_RESULT(answers[i](f->manager, id, count, tiles), expected);
        assert_true(fixture_digest(f, 1, &id) == digest);
    }
}

static SluiceTextureId open_loading(struct fixture *f)
{
    fixture_open(f, 16, false);
    fixture_configure(f, 100, 0, 0, 0);
    SluiceTextureId id = fixture_add_small(f);
    fixture_feed(f, id, 0, 0, 0);
    CHECK_OK(fixture_to_map(f, id));
    assert_int_equal(f->count, 6);
    return id;
}

static void a_tile_that_was_not_handed_out_has_no_answer(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f);
    uint32_t tile = 0;
    check_answer_refused(&f, id, 1, &tile, SLUICE_ERROR_INVALID_TILE_STATE); /* free */
    fixture_feed(&f, id, 0, 0, 0);
    check_answer_refused(&f, id, 1, &tile, SLUICE_ERROR_INVALID_TILE_STATE); /* requested */
    fixture_close(&f);
}

static void a_tile_is_answered_once(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = open_loading(&f);
    uint32_t tile = 0;
    CHECK_OK(say_mapped(f.manager, id, 1, &tile));
    check_answer_refused(&f, id, 1, &tile, SLUICE_ERROR_INVALID_TILE_STATE); /* mapped */
    tile = 1;
    fixture_configure(&f, 100, 0, 0, 1000);
    CHECK_OK(sluiceReportFailedTiles(f.manager, id, 1, &tile, 0));
    check_answer_refused(&f, id, 1, &tile, SLUICE_ERROR_INVALID_TILE_STATE); /* failed */
    fixture_configure(&f, 100, 0, 1, 1000);
    tile = 2;
    CHECK_OK(sluiceReportFailedTiles(f.manager, id, 1, &tile, 0));
    check_answer_refused(&f, id, 1, &tile, SLUICE_ERROR_INVALID_TILE_STATE); /* given up */
    fixture_feed(&f, id, SLUICE_MIP_UNTOUCHED, 1, 0);
    tile = 3;
    CHECK_OK(say_canceled(f.manager, id, 1, &tile));
    check_answer_refused(&f, id, 1, &tile, SLUICE_ERROR_INVALID_TILE_STATE); /* canceled, free */
    tile = 0;
    check_answer_refused(&f, id, 1, &tile, SLUICE_ERROR_INVALID_TILE_STATE); /* standby */
    fixture_close(&f);
}

static void one_bad_tile_refuses_the_whole_list(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = open_loading(&f);
    uint32_t tile = 4;
    CHECK_OK(say_mapped(f.manager, id, 1, &tile));
    static const uint32_t lists[][4] = {{0, 1, 2, 4}, {4, 0, 1, 2}, {0, 4, 1, 2}};
    for (uint32_t i = 0; i < 3; i++)
        check_answer_refused(&f, id, 4, lists[i], SLUICE_ERROR_INVALID_TILE_STATE);
    static const uint32_t beyond[][3] = {{0, 1, 6}, {6, 0, 1}, {0, UINT32_MAX, 1}};
    for (uint32_t i = 0; i < 3; i++)
        check_answer_refused(&f, id, 3, beyond[i], SLUICE_ERROR_UNKNOWN_TILE);
    const uint32_t good[] = {3, 0, 5, 1, 2};
    CHECK_OK(say_mapped(f.manager, id, 5, good));
    fixture_close(&f);
}

static void a_tile_twice_in_a_list_refuses_the_whole_list(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = open_loading(&f);
    static const uint32_t lists[][4] = {{0, 0, 1, 2}, {0, 1, 2, 0}, {3, 1, 2, 2}, {5, 5, 5, 5}};
    for (uint32_t i = 0; i < 4; i++)
        check_answer_refused(&f, id, 4, lists[i], SLUICE_ERROR_INVALID_TILE_STATE);
    for (uint32_t i = 0; i < 6; i++)
        CHECK_STATE(&f, id, i, ALLOCATED);
    fixture_feed(&f, id, SLUICE_MIP_UNTOUCHED, 1, 0); /* now for canceled tiles */
    for (uint32_t i = 0; i < 4; i++)
        check_answer_refused(&f, id, 4, lists[i], SLUICE_ERROR_INVALID_TILE_STATE);
    fixture_close(&f);
}

static void an_empty_answer_is_fine(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = open_loading(&f);
    uint32_t none = 0;
    for (uint32_t i = 0; i < 3; i++)
        CHECK_OK(answers[i](f.manager, id, 0, &none));
    CHECK_STATE(&f, id, 0, ALLOCATED);
    fixture_close(&f);
}

/* Brings the six tiles into eight states, one per step, and stops before step `state`. */
static SluiceTextureId reach(struct fixture *f, SluiceTileState state)
{
    const uint32_t all[] = {0, 1, 2, 3, 4, 5};
    SluiceTextureId id = fixture_add_small(f);
    fixture_configure(f, 100, 0, state == SLUICE_TILE_STATE_GIVEN_UP ? 1 : 2, 50);
    if (state == SLUICE_TILE_STATE_FREE)
        return id;
    fixture_feed(f, id, 0, 0, 0);
    if (state == SLUICE_TILE_STATE_REQUESTED)
        return id;
    CHECK_OK(fixture_to_map(f, id));
    if (state == SLUICE_TILE_STATE_FAILED || state == SLUICE_TILE_STATE_GIVEN_UP)
        CHECK_OK(sluiceReportFailedTiles(f->manager, id, 6, all, 0));
    if (state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY)
        CHECK_OK(say_mapped(f->manager, id, 6, all));
    if (state == SLUICE_TILE_STATE_STANDBY || state == SLUICE_TILE_STATE_CANCELED)
        fixture_feed(f, id, SLUICE_MIP_UNTOUCHED, 0, 0);
    return id;
}

static void check_nothing_listed(struct fixture *f)
{
    CHECK_OK(fixture_to_map(f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f->count, 0);
    CHECK_OK(fixture_to_cancel(f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f->count, 0);
    CHECK_OK(fixture_to_unmap(f, SLUICE_ALL_TEXTURES, 0));
    assert_int_equal(f->count, 0);
    f->count = FIXTURE_ROOM;
    CHECK_OK(sluiceGetGivenUpTiles(f->manager, &f->count, f->tiles));
    assert_int_equal(f->count, 0);
    SluiceMinMipRect rect;
    uint32_t count = 1;
    CHECK_OK(sluiceGetMinMipUpdates(f->manager, &count, &rect));
    assert_int_equal(count, 0);
}

static void removal_is_right_in_every_state(void **state)
{
    (void)state;
    for (SluiceTileState s = SLUICE_TILE_STATE_FREE; s <= SLUICE_TILE_STATE_GIVEN_UP; s++) {
        struct fixture f;
        fixture_open(&f, 16, false);
        SluiceTextureId id = reach(&f, s);
        for (uint32_t i = 0; i < 6; i++)
            assert_int_equal(fixture_state(&f, id, i), s);
        bool holds = s >= SLUICE_TILE_STATE_ALLOCATED && s <= SLUICE_TILE_STATE_CANCELED;
        bool heap = s > SLUICE_TILE_STATE_REQUESTED;
        CHECK_OK(sluiceRemoveStreamedTexture(f.manager, id, 7));
        SluiceStreamedTextureStatistics now = fixture_statistics(&f);
        assert_int_equal(now.retiringSlotCount, holds ? 6 : 0);
        assert_int_equal(now.freeSlotCount, (heap ? 16 : 0) - (holds ? 6 : 0));
        assert_int_equal(now.textureCount + now.tileCount, 0);
        assert_int_equal(now.requestedTileCount + now.allocatedTileCount + now.mappedTileCount +
                             now.standbyTileCount + now.canceledTileCount + now.failedTileCount +
                             now.givenUpTileCount,
                         0);
        check_nothing_listed(&f);
        const uint32_t tile = 0;
        for (uint32_t i = 0; i < 3; i++) /* late answers */
            CHECK_RESULT(answers[i](f.manager, id, 1, &tile), SLUICE_ERROR_STALE_TEXTURE);
        SluiceTextureId next = fixture_add_small(&f); /* a new texture with the same index */
        for (uint32_t i = 0; i < 3; i++)
            CHECK_RESULT(answers[i](f.manager, id, 1, &tile), SLUICE_ERROR_STALE_TEXTURE);
        for (uint32_t i = 0; i < 6; i++)
            CHECK_STATE(&f, next, i, FREE);
        fixture_feed(&f, next, 0, 5000, 0); /* includes due retries of the old texture */
        fixture_load(&f);
        CHECK_STATE(&f, next, 0, MAPPED);
        CHECK_OK(sluiceCompleteRetireValue(f.manager, 7));
        assert_int_equal(fixture_statistics(&f).freeSlotCount, 10);
        fixture_close(&f);
    }
}

static void removal_after_every_list_was_read_is_right_too(void **state)
{
    (void)state;
    for (SluiceTileState s = SLUICE_TILE_STATE_FREE; s <= SLUICE_TILE_STATE_GIVEN_UP; s++) {
        struct fixture f;
        fixture_open(&f, 16, false);
        SluiceTextureId id = reach(&f, s), other = fixture_add_small(&f);
        CHECK_OK(sluiceTrimStandbyTiles(f.manager, 3)); /* some listed, some not */
        CHECK_OK(fixture_to_cancel(&f, id));
        fixture_feed_region(&f, id, 0, 0, 1, 0); /* some wanted again after the listing */
        CHECK_OK(sluiceRemoveStreamedTexture(f.manager, id, 0));
        assert_int_equal(fixture_statistics(&f).retiringSlotCount, 0);
        fixture_feed(&f, other, 0, 100, 0);
        fixture_load(&f);
        assert_int_equal(fixture_statistics(&f).freeSlotCount, 10);
        assert_int_equal(f.heaps.living_count, 1);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tile_that_was_not_handed_out_has_no_answer),
        cmocka_unit_test(a_tile_is_answered_once),
        cmocka_unit_test(one_bad_tile_refuses_the_whole_list),
        cmocka_unit_test(a_tile_twice_in_a_list_refuses_the_whole_list),
        cmocka_unit_test(an_empty_answer_is_fine),
        cmocka_unit_test(removal_is_right_in_every_state),
        cmocka_unit_test(removal_after_every_list_was_read_is_right_too),
    };
    return RUN_TESTS(tests);
}
