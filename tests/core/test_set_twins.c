/*
 * Compares a set with single textures that sluiceMatchPrimaryTexture feeds one by one, without a
 * shared history. Two managers get equal calls otherwise, and must not differ.
 */
#include "core/fixture.h"

#include "core/lookup.h"

#include <string.h>

enum { MEMBERS = 7, TILES = 16, REGIONS = TILES * TILES };

struct twins {
    struct fixture set, lone;
    SluiceTextureId ids[MEMBERS]; ///< equal in both
    SluiceTextureId followers[MEMBERS];
    uint32_t follower_count; ///< followers of the first texture, in the order of their addition
    uint64_t random, time, retire;
    bool calm;                               ///< true: the set seldom changes
    uint32_t refused, shared, biased, apart; ///< number of steps with each condition
};

static uint32_t below(struct twins *t, uint32_t n)
{
    return next_random(&t->random) % n;
}

static SluiceStreamedTextureDesc desc_of(uint32_t member)
{
    SluiceStreamedTextureDesc desc = full_chain(TILES * 16, TILES * 16, 16, 16);
    if (member + 1 == MEMBERS) { /* one has another shape, and the same regions */
        desc.regularMipCount--;
        desc.packedTileCount++;
    }
    return desc;
}

static void add(struct twins *t, uint32_t member)
{
    SluiceStreamedTextureDesc desc = desc_of(member);
    t->ids[member] = fixture_add(&t->set, &desc);
    assert_true(fixture_add(&t->lone, &desc) == t->ids[member]);
}

static void open_twins(struct twins *t, uint64_t seed)
{
    memset(t, 0, sizeof *t);
    t->random = seed;
    t->calm = seed % 4 < 2;
    struct fixture *both[2] = {&t->set, &t->lone};
    uint32_t limit = seed % 3 ? 2 + below(t, 12) : FIXTURE_HEAPS;
    const SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                       .numExtraStandbyTiles = below(t, 200),
                                                       .maxLoadAttempts = 2,
                                                       .missesToExpire = below(t, 3),
                                                       .prefetchLevels = below(t, 2)};
    for (uint32_t i = 0; i < 2; i++) {
        fixture_open(both[i], 40, seed % 2);
        both[i]->heaps.limit = limit;
        CHECK_OK(sluiceSetConfig(both[i]->manager, &config));
    }
    for (uint32_t i = 0; i < MEMBERS; i++)
        add(t, i);
}

static void unfollow(struct twins *t, SluiceTextureId id)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < t->follower_count; i++)
        if (t->followers[i] != id)
            t->followers[kept++] = t->followers[i];
    t->follower_count = kept;
}

static void follow(struct twins *t, uint32_t member)
{
    SluiceTextureId id = t->ids[member];
    for (uint32_t i = 0; i < t->follower_count; i++)
        if (t->followers[i] == id)
            return;
    CHECK_OK(sluiceSetPrimaryTexture(t->set.manager, id, t->ids[0]));
    t->followers[t->follower_count++] = id;
}

/* Makes a map of a window, with gaps; or an empty map. */
static void make_map(struct twins *t, uint8_t *map)
{
    memset(map, SLUICE_MIP_UNTOUCHED, REGIONS);
    uint32_t x0 = below(t, TILES), y0 = below(t, TILES), size = 1 + below(t, TILES);
    uint32_t level = below(t, 6), shown = below(t, 8);
    for (uint32_t y = y0; y < y0 + size && y < TILES; y++)
        for (uint32_t x = x0; x < x0 + size && x < TILES; x++)
            if (below(t, 8) < shown)
                map[y * TILES + x] = (uint8_t)(level + below(t, 2));
}

/* Retries with 0, 1, 2, ... allowed allocations until it succeeds. A failed attempt must change
 * nothing. */
static void feed_under_pressure(struct twins *t, const SluiceFeedbackDesc *feedback,
                                uint64_t timeout)
{
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint64_t before = fixture_digest(&t->set, MEMBERS, t->ids);
    for (uint32_t n = 0; result == SLUICE_ERROR_OUT_OF_HOST_MEMORY; n++) {
        t->set.memory.refuse_from = t->set.memory.calls + n;
        result =
            sluiceUpdateWithSamplerFeedback(t->set.manager, t->ids[0], feedback, t->time, timeout);
        t->set.memory.refuse_from = UINT64_MAX;
        if (result != SLUICE_ERROR_OUT_OF_HOST_MEMORY)
            break;
        t->refused++;
        assert_true(fixture_digest(&t->set, MEMBERS, t->ids) == before);
    }
    CHECK_OK(result);
}

static void feed_set(struct twins *t)
{
    static const uint64_t timeouts[] = {0, 3, 10, 40, 1000};
    uint8_t map[REGIONS];
    make_map(t, map);
    SluiceFeedbackDesc feedback = {sizeof feedback,
                                   map,
                                   TILES,
                                   TILES,
                                   below(t, 8) ? 0 : (int32_t)below(t, 3) - 1,
                                   below(t, 8) ? 0 : 1 + below(t, 4)};
    uint64_t timeout = timeouts[below(t, 5)];
    if (below(t, 4) == 0)
        feed_under_pressure(t, &feedback, timeout);
    else
        CHECK_OK(sluiceUpdateWithSamplerFeedback(t->set.manager, t->ids[0], &feedback, t->time,
                                                 timeout));
    CHECK_OK(
        sluiceUpdateWithSamplerFeedback(t->lone.manager, t->ids[0], &feedback, t->time, timeout));
    for (uint32_t i = 0; i < t->follower_count; i++)
        CHECK_OK(sluiceMatchPrimaryTexture(t->lone.manager, t->ids[0], t->followers[i], t->time,
                                           timeout));
}

static void feed_one(struct twins *t)
{
    uint8_t map[REGIONS];
    make_map(t, map);
    uint32_t member = below(t, MEMBERS - 1) + 1, other = below(t, MEMBERS);
    bool match = below(t, 2) && other != member;
    struct fixture *both[2] = {&t->set, &t->lone};
    for (uint32_t i = 0; i < 2; i++) {
        if (match)
            CHECK_OK(sluiceMatchPrimaryTexture(both[i]->manager, t->ids[other], t->ids[member],
                                               t->time, 10));
        else
            fixture_feed_map(both[i], t->ids[member], map, t->time, 10);
    }
    t->apart++;
}

static void change_set(struct twins *t)
{
    uint32_t member = below(t, MEMBERS);
    if (below(t, 4)) {
        for (uint32_t i = 1; i < MEMBERS; i++)
            follow(t, i);
    } else if (below(t, 2) && member) {
        CHECK_OK(sluiceSetPrimaryTexture(t->set.manager, t->ids[member], SLUICE_NO_TEXTURE));
        unfollow(t, t->ids[member]);
    } else {
        CHECK_OK(sluiceRemoveStreamedTexture(t->set.manager, t->ids[member], ++t->retire));
        CHECK_OK(sluiceRemoveStreamedTexture(t->lone.manager, t->ids[member], t->retire));
        if (member == 0)
            t->follower_count = 0; /* they keep what they had */
        else
            unfollow(t, t->ids[member]);
        add(t, member);
    }
}

static void check_same_lists(const struct twins *t)
{
    assert_int_equal(t->set.count, t->lone.count);
    for (uint32_t i = 0; i < t->set.count; i++) {
        const SluiceTile *a = &t->set.tiles[i], *b = &t->lone.tiles[i];
        assert_true(a->textureId == b->textureId && a->tileIndex == b->tileIndex);
        assert_true(a->heapId == b->heapId && a->slot == b->slot);
    }
}

/* Most loads succeed at once. Some fail, some stay in flight. */
static void hand_out(struct twins *t)
{
    uint32_t room = below(t, 2) ? FIXTURE_ROOM : below(t, 100);
    CHECK_RESULT(fixture_to_map_at_most(&t->set, SLUICE_ALL_TEXTURES, room),
                 fixture_to_map_at_most(&t->lone, SLUICE_ALL_TEXTURES, room));
    check_same_lists(t);
    for (uint32_t i = 0; i < t->set.count; i++) {
        const SluiceTile *tile = &t->set.tiles[i];
        uint32_t dice = below(t, 16);
        struct fixture *both[2] = {&t->set, &t->lone};
        for (uint32_t k = 0; k < 2 && dice; k++)
            CHECK_OK(dice == 1 ? sluiceReportFailedTiles(both[k]->manager, tile->textureId, 1,
                                                         &tile->tileIndex, t->time)
                               : sluiceUpdateTilesMapping(both[k]->manager, tile->textureId, 1,
                                                          &tile->tileIndex));
    }
}

static void take_back(struct twins *t)
{
    t->retire++;
    CHECK_OK(fixture_to_unmap(&t->set, SLUICE_ALL_TEXTURES, t->retire));
    CHECK_OK(fixture_to_unmap(&t->lone, SLUICE_ALL_TEXTURES, t->retire));
    check_same_lists(t);
    CHECK_OK(sluiceCompleteRetireValue(t->set.manager, t->retire));
    CHECK_OK(sluiceCompleteRetireValue(t->lone.manager, t->retire));
    CHECK_OK(fixture_to_cancel(&t->set, SLUICE_ALL_TEXTURES));
    CHECK_OK(fixture_to_cancel(&t->lone, SLUICE_ALL_TEXTURES));
    check_same_lists(t);
    struct fixture *both[2] = {&t->set, &t->lone};
    for (uint32_t i = 0; i < t->set.count; i++)
        for (uint32_t k = 0; k < 2; k++)
            CHECK_OK(sluiceReportCanceledTiles(both[k]->manager, t->set.tiles[i].textureId, 1,
                                               &t->set.tiles[i].tileIndex, t->retire));
}

static void step(struct twins *t)
{
    t->time += below(t, 40) ? below(t, 3) : 3000;
    uint32_t dice = below(t, t->calm ? 160 : 40);
    if (dice == 0)
        change_set(t);
    else if (dice == 1)
        feed_one(t);
    else if (dice % 40 < 25)
        feed_set(t);
    else if (dice % 40 < 34)
        hand_out(t);
    else
        take_back(t);
}

static void check_twins(struct twins *t)
{
    assert_true(fixture_digest(&t->set, MEMBERS, t->ids) ==
                fixture_digest(&t->lone, MEMBERS, t->ids));
    SluiceStreamedTextureStatistics a = fixture_statistics(&t->set),
                                    b = fixture_statistics(&t->lone);
    assert_int_equal(a.globalMipBias, b.globalMipBias);
    t->biased += a.globalMipBias > 0;
    bool shared = false;
    for (uint32_t i = 0; i < MEMBERS; i++) {
        struct slc_managed_texture *texture;
        CHECK_OK(slc_find_texture(t->set.manager, t->ids[i], &texture));
        shared |= texture->history && texture->history->users > 1;
    }
    t->shared += shared;
}

static void a_set_decides_as_textures_that_are_matched_one_by_one(void **state)
{
    (void)state;
    static struct twins t;
    uint32_t refused = 0, shared = 0, biased = 0, apart = 0;
    for (uint64_t seed = 0; seed < 60; seed++) {
        open_twins(&t, seed);
        for (uint32_t i = 1; i < MEMBERS; i++)
            follow(&t, i);
        for (uint32_t i = 0; i < 150; i++) {
            step(&t);
            check_twins(&t);
        }
        refused += t.refused;
        shared += t.shared;
        biased += t.biased;
        apart += t.apart;
        fixture_close(&t.set);
        fixture_close(&t.lone);
    }
    assert_true(refused > 100 && shared > 1000 && biased > 500 && apart > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_set_decides_as_textures_that_are_matched_one_by_one),
    };
    return RUN_TESTS(tests);
}
