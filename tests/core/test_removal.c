#include "core/sound.h"

#include <string.h>

/* State of a tile when its texture is removed. */
enum stage {
    NEVER_SAMPLED,
    LAPSED, /* sampled once, FREE again */
    QUEUED,
    IN_FLIGHT,
    CANCELED,
    CANCELED_AND_LISTED,
    CANCELED_AND_WANTED_AGAIN,
    MAPPED,
    STANDBY,
    STANDBY_AND_LISTED,
    RESTORED,
    FAILED,
    GIVEN_UP,
    GIVEN_UP_AND_LISTED,
    STAGE_COUNT
};

static const SluiceTileState states[STAGE_COUNT] = {
    [NEVER_SAMPLED] = SLUICE_TILE_STATE_FREE,
    [LAPSED] = SLUICE_TILE_STATE_FREE,
    [QUEUED] = SLUICE_TILE_STATE_REQUESTED,
    [IN_FLIGHT] = SLUICE_TILE_STATE_ALLOCATED,
    [CANCELED] = SLUICE_TILE_STATE_CANCELED,
    [CANCELED_AND_LISTED] = SLUICE_TILE_STATE_CANCELED,
    [CANCELED_AND_WANTED_AGAIN] = SLUICE_TILE_STATE_CANCELED,
    [MAPPED] = SLUICE_TILE_STATE_MAPPED,
    [STANDBY] = SLUICE_TILE_STATE_STANDBY,
    [STANDBY_AND_LISTED] = SLUICE_TILE_STATE_STANDBY,
    [RESTORED] = SLUICE_TILE_STATE_MAPPED,
    [FAILED] = SLUICE_TILE_STATE_FAILED,
    [GIVEN_UP] = SLUICE_TILE_STATE_GIVEN_UP,
    [GIVEN_UP_AND_LISTED] = SLUICE_TILE_STATE_GIVEN_UP,
};

static const uint32_t all_tiles[] = {0, 1, 2, 3, 4, 5};

struct bench {
    struct fixture f;
    uint64_t time, retire;
    SluiceTextureId bystander; ///< all of it MAPPED, all the time
};

static void bench_open(struct bench *b)
{
    memset(b, 0, sizeof *b);
    fixture_open(&b->f, 8, false);
    fixture_configure(&b->f, 100, 0, 2, 50);
    b->bystander = fixture_add_small(&b->f);
    sound_feed(&b->f, b->bystander, 0, 0, 0);
    sound_load(&b->f);
}

static void feed(struct bench *b, SluiceTextureId id, uint8_t level)
{
    sound_feed(&b->f, id, level, b->time, 0);
}

static void answer_failed(struct bench *b, SluiceTextureId id)
{
    SOUND(&b->f, fixture_to_map(&b->f, id));
    assert_int_equal(b->f.count, 6);
    SOUND(&b->f, sluiceReportFailedTiles(b->f.manager, id, 6, all_tiles, b->time));
}

static void fail_until(struct bench *b, SluiceTextureId id, enum stage stage)
{
    answer_failed(b, id);
    if (stage == FAILED)
        return;
    b->time += 50;
    feed(b, id, 0); /* brings the time at which they are due */
    answer_failed(b, id);
    if (stage == GIVEN_UP)
        return;
    SluiceTile tiles[12]; /* maybe those of another texture too */
    uint32_t count = 12;
    SOUND(&b->f, sluiceGetGivenUpTiles(b->f.manager, &count, tiles));
    assert_true(count == 6 || count == 12);
}

static void load_until(struct bench *b, SluiceTextureId id, enum stage stage)
{
    SOUND(&b->f, fixture_to_map(&b->f, id));
    if (stage == IN_FLIGHT)
        return;
    if (stage >= MAPPED)
        SOUND(&b->f, sluiceUpdateTilesMapping(b->f.manager, id, 6, all_tiles));
    if (stage == MAPPED)
        return;
    feed(b, id, SLUICE_MIP_UNTOUCHED);
    if (stage == CANCELED_AND_LISTED || stage == CANCELED_AND_WANTED_AGAIN)
        SOUND(&b->f, fixture_to_cancel(&b->f, id));
    if (stage == STANDBY_AND_LISTED || stage == RESTORED)
        SOUND(&b->f, sluiceTrimStandbyTiles(b->f.manager, 0));
    if (stage == CANCELED_AND_WANTED_AGAIN || stage == RESTORED)
        feed(b, id, 0);
}

/* A new texture whose six tiles are at this stage. */
static SluiceTextureId reach(struct bench *b, enum stage stage)
{
    SluiceTextureId id = fixture_add_small(&b->f);
    if (stage != NEVER_SAMPLED)
        feed(b, id, 0);
    if (stage == LAPSED)
        feed(b, id, SLUICE_MIP_UNTOUCHED);
    else if (stage >= FAILED)
        fail_until(b, id, stage);
    else if (stage >= IN_FLIGHT)
        load_until(b, id, stage);
    for (uint32_t i = 0; i < 6; i++)
        check_state(&b->f, id, i, states[stage], (int)stage);
    return id;
}

/* The lists are read only now, after the texture is gone. */
static void check_nothing_listed(struct bench *b)
{
    struct fixture *f = &b->f;
    SOUND(f, fixture_to_cancel(f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f->count, 0);
    SOUND(f, fixture_to_unmap(f, SLUICE_ALL_TEXTURES, b->retire));
    assert_int_equal(f->count, 0);
    SOUND(f, fixture_to_map(f, SLUICE_ALL_TEXTURES));
    assert_int_equal(f->count, 0);
    f->count = FIXTURE_ROOM;
    SOUND(f, sluiceGetGivenUpTiles(f->manager, &f->count, f->tiles));
    assert_int_equal(f->count, 0);
    SluiceMinMipRect rects[4];
    uint32_t count = 4;
    SOUND(f, sluiceGetMinMipUpdates(f->manager, &count, rects));
    for (uint32_t i = 0; i < count; i++)
        assert_true(rects[i].textureId == b->bystander);
}

/* Makes every call that takes a texture. None may have an effect. `alive`: textures to check. */
static void check_id_is_stale(struct bench *b, SluiceTextureId id, uint32_t count,
                              const SluiceTextureId *alive)
{
    SluiceStreamedTextureManager *m = b->f.manager;
    const SluiceResult stale = SLUICE_ERROR_STALE_TEXTURE;
    const uint8_t map[4] = {0};
    const SluiceFeedbackDesc feedback = {sizeof feedback, map, 2, 2, 0, 0};
    const uint64_t late = b->time + 1000;
    uint32_t room = 8;
    SluiceTile tiles[8];
    uint64_t digest = fixture_digest(&b->f, count, alive);
    for (uint32_t i = 0; i < 6; i++) {
        CHECK_RESULT(sluiceUpdateTilesMapping(m, id, 1, &all_tiles[i]), stale);
        CHECK_RESULT(sluiceReportFailedTiles(m, id, 1, &all_tiles[i], late), stale);
        CHECK_RESULT(sluiceReportCanceledTiles(m, id, 1, &all_tiles[i], 0), stale);
        CHECK_RESULT(sluiceGetTileState(m, id, i, NULL, tiles), stale);
    }
    CHECK_RESULT(sluiceUpdateTilesMapping(m, id, 6, all_tiles), stale);
    CHECK_RESULT(sluiceUpdateWithSamplerFeedback(m, id, &feedback, late, 0), stale);
    CHECK_RESULT(sluiceMatchPrimaryTexture(m, id, b->bystander, late, 0), stale);
    CHECK_RESULT(sluiceMatchPrimaryTexture(m, b->bystander, id, late, 0), stale);
    CHECK_RESULT(sluiceSetPrimaryTexture(m, b->bystander, id), stale);
    CHECK_RESULT(sluiceGetTilesToMap(m, id, &room, tiles), stale);
    CHECK_RESULT(sluiceGetTilesToCancel(m, id, &room, tiles), stale);
    CHECK_RESULT(sluiceGetTilesToUnmap(m, id, b->retire, &room, tiles), stale);
    CHECK_RESULT(sluiceRetryFailedTiles(m, id), stale);
    CHECK_RESULT(sluiceRemoveStreamedTexture(m, id, b->retire), stale);
    CHECK_SOUND(&b->f);
    assert_true(fixture_digest(&b->f, count, alive) == digest);
}

static void remove_texture(struct bench *b, SluiceTextureId id)
{
    SluiceStreamedTextureStatistics before = fixture_statistics(&b->f);
    uint32_t held = 0;
    for (uint32_t i = 0; i < 6; i++) {
        SluiceTileState s = fixture_state(&b->f, id, i);
        held += s >= SLUICE_TILE_STATE_ALLOCATED && s <= SLUICE_TILE_STATE_CANCELED;
    }
    SOUND(&b->f, sluiceRemoveStreamedTexture(b->f.manager, id, ++b->retire));
    SluiceStreamedTextureStatistics now = fixture_statistics(&b->f);
    assert_int_equal(now.retiringSlotCount, before.retiringSlotCount + held);
    assert_int_equal(now.freeSlotCount, before.freeSlotCount);
    assert_int_equal(now.textureCount, before.textureCount - 1);
    assert_int_equal(now.mappedTileCount, 6); /* the bystander's: nobody else is there */
    assert_int_equal(now.requestedTileCount + now.allocatedTileCount + now.standbyTileCount +
                         now.canceledTileCount + now.failedTileCount + now.givenUpTileCount,
                     0);
}

/* Completes everything. Then only the bystander holds slots, and one heap suffices for it. */
static void complete_and_release(struct bench *b)
{
    SOUND(&b->f, sluiceCompleteRetireValue(b->f.manager, b->retire));
    const uint32_t kept = fixture_tile(&b->f, b->bystander, 0).heapId;
    for (uint32_t heap = 0; heap < FIXTURE_HEAPS; heap++)
        if (b->f.heaps.living[heap] && heap != kept) /* one may not be listed: to have some room */
            SOUND(&b->f, sluiceReleaseHeap(b->f.manager, heap));
    SluiceStreamedTextureStatistics now = fixture_statistics(&b->f);
    assert_true(now.heapCount == 1 && now.freeSlotCount == 2 && now.retiringSlotCount == 0);
}

static void removal_at_every_stage_leaves_nothing_behind(void **state)
{
    (void)state;
    for (uint32_t stage = 0; stage < STAGE_COUNT; stage++) {
        struct bench b;
        bench_open(&b);
        SluiceTextureId id = reach(&b, (enum stage)stage);
        remove_texture(&b, id);
        check_id_is_stale(&b, id, 1, &b.bystander);
        check_nothing_listed(&b);
        complete_and_release(&b);
        for (uint32_t i = 0; i < 6; i++)
            CHECK_STATE(&b.f, b.bystander, i, MAPPED);
        fixture_close(&b.f);
    }
}

/* Runs each stage after each other one, so that remains of an old texture at an index would
 * show. */
static void the_next_texture_of_an_index_starts_from_nothing(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < STAGE_COUNT * STAGE_COUNT; i++) {
        struct bench b;
        bench_open(&b);
        SluiceTextureId old = reach(&b, (enum stage)(i / STAGE_COUNT));
        remove_texture(&b, old);
        if (i % 3 == 0) /* else its slots are still retiring */
            SOUND(&b.f, sluiceCompleteRetireValue(b.f.manager, b.retire));
        SluiceTextureId fresh = fixture_add_small(&b.f);
        assert_true((uint32_t)fresh == (uint32_t)old && fresh != old);
        for (uint32_t t = 0; t < 6; t++)
            CHECK_STATE(&b.f, fresh, t, FREE);
        uint8_t map[4], empty[4] = {255, 255, 255, 255};
        SOUND(&b.f, sluiceWriteMinMipData(b.f.manager, fresh, 2, 4, map));
        assert_memory_equal(map, empty, 4);
        SOUND(&b.f, sluiceRemoveStreamedTexture(b.f.manager, fresh, b.retire));
        SluiceTextureId next = reach(&b, (enum stage)(i % STAGE_COUNT));
        assert_true((uint32_t)next == (uint32_t)old && next != old && next != fresh);
        const SluiceTextureId alive[] = {b.bystander, next};
        check_id_is_stale(&b, old, 2, alive); /* answers of old loads reach no new tile */
        check_id_is_stale(&b, fresh, 2, alive);
        remove_texture(&b, next);
        check_nothing_listed(&b);
        complete_and_release(&b);
        fixture_close(&b.f);
    }
}

static void memory_is_back_after_everything_is_removed(void **state)
{
    (void)state;
    struct bench b;
    bench_open(&b);
    uint64_t before = 0;
    for (uint32_t round = 0; round < 5; round++) { /* the first ones may fill pools */
        SluiceTextureId ids[STAGE_COUNT];
        for (uint32_t stage = 0; stage < STAGE_COUNT; stage++)
            ids[stage] = reach(&b, (enum stage)stage);
        for (uint32_t i = 0; i < STAGE_COUNT; i++) { /* in another order every time */
            uint32_t at = (i * 5 + round) % STAGE_COUNT;
            SOUND(&b.f, sluiceRemoveStreamedTexture(b.f.manager, ids[at], ++b.retire));
        }
        check_nothing_listed(&b);
        complete_and_release(&b);
        if (round <= 1)
            before = b.f.memory.live_bytes;
        assert_true(b.f.memory.live_bytes <= before);
    }
    fixture_close(&b.f);
}

/* Maps of a removed primary do not reach its followers, and a new texture is not their primary. */
static void removal_of_a_primary_in_flight_frees_its_followers(void **state)
{
    (void)state;
    for (uint32_t stage = QUEUED; stage < STAGE_COUNT; stage++) {
        struct bench b;
        bench_open(&b);
        SluiceTextureId follower = fixture_add_small(&b.f), id = reach(&b, (enum stage)stage);
        SOUND(&b.f, sluiceSetPrimaryTexture(b.f.manager, follower, id));
        feed(&b, id, 0);
        CHECK_STATE(&b.f, follower, 0, REQUESTED);
        SOUND(&b.f, sluiceRemoveStreamedTexture(b.f.manager, id, ++b.retire));
        CHECK_STATE(&b.f, follower, 0, REQUESTED);
        SluiceTextureId next = fixture_add_small(&b.f);
        assert_int_equal((uint32_t)next, (uint32_t)id);
        feed(&b, next, SLUICE_MIP_UNTOUCHED);
        CHECK_STATE(&b.f, follower, 0, REQUESTED);
        SOUND(&b.f, sluiceSetPrimaryTexture(b.f.manager, next, follower)); /* it stands alone */
        feed(&b, follower, SLUICE_MIP_UNTOUCHED);
        CHECK_STATE(&b.f, follower, 0, FREE);
        fixture_close(&b.f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(removal_at_every_stage_leaves_nothing_behind),
        cmocka_unit_test(the_next_texture_of_an_index_starts_from_nothing),
        cmocka_unit_test(memory_is_back_after_everything_is_removed),
        cmocka_unit_test(removal_of_a_primary_in_flight_frees_its_followers),
    };
    return RUN_TESTS(tests);
}
