/** missesToExpire: number of maps without a level after which a region's demand expires. */
#include "core/fixture.h"

enum { TIMEOUT = 100 };

/* 1024 x 1024: tiles 0 to 63 are level 0, 64 to 79 level 1, 80 to 83 level 2, 84 level 3. */
static SluiceTextureId open_with(struct fixture *f, uint32_t misses)
{
    fixture_open(f, 64, false);
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                 .missesToExpire = misses};
    CHECK_OK(sluiceSetConfig(f->manager, &config));
    SluiceStreamedTextureDesc desc = full_chain(1024, 1024, 128, 128);
    return fixture_add(f, &desc);
}

static bool is_wanted(const struct fixture *f, SluiceTextureId id, uint32_t tile)
{
    return fixture_state(f, id, tile) == SLUICE_TILE_STATE_REQUESTED;
}

/*
 * Region 0 asks once for `level`, then all maps ask for the far corner alone, `step` apart. Returns
 * how many of them until the tile of that level over region 0 is wanted no more.
 */
static uint32_t maps_until_forgotten(uint32_t misses, uint8_t level, uint64_t step)
{
    static const uint32_t first_tile[] = {0, 64, 80};
    struct fixture f;
    SluiceTextureId id = open_with(&f, misses);
    uint64_t time = 1;
    fixture_feed_region(&f, id, 0, level, time, TIMEOUT);
    uint32_t maps = 0;
    while (is_wanted(&f, id, first_tile[level]) && maps < 1000) {
        time += step;
        fixture_feed_region(&f, id, 63, 0, time, TIMEOUT);
        maps++;
    }
    assert_true(is_wanted(&f, id, 63));
    fixture_close(&f);
    return maps;
}

static void with_one_the_timeout_alone_counts(void **state)
{
    (void)state;
    assert_int_equal(maps_until_forgotten(1, 0, TIMEOUT), 1);
    assert_int_equal(maps_until_forgotten(1, 0, 10 * TIMEOUT), 1);
    assert_int_equal(maps_until_forgotten(1, 2, TIMEOUT), 1);
    assert_int_equal(maps_until_forgotten(1, 0, TIMEOUT / 2), 2);
    /* Maps of a quarter of the timeout count as one: up to 5/4 of it and a map more. */
    assert_in_range(maps_until_forgotten(1, 0, TIMEOUT / 20), 20, 26);
}

static void with_one_returns_teach_nothing(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = open_with(&f, 1);
    for (uint64_t time = 1; time < 100 * TIMEOUT; time += TIMEOUT) {
        fixture_feed_region(&f, id, time / TIMEOUT % 2 ? 0 : 63, 0, time, TIMEOUT);
        assert_true(is_wanted(&f, id, time / TIMEOUT % 2 ? 0 : 63));
        assert_false(is_wanted(&f, id, time / TIMEOUT % 2 ? 63 : 0));
    }
    fixture_close(&f);
}

static void with_n_that_many_maps_have_to_miss_it(void **state)
{
    (void)state;
    static const uint32_t counts[] = {2, 3, 4, 8, 20, 64, 200};
    for (uint32_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        uint32_t n = counts[i];
        uint32_t maps = maps_until_forgotten(n, 0, 2 * TIMEOUT);
        assert_in_range(maps, n, n + n / 4 + 1); /* maps that count as one go together */
    }
}

static void with_n_the_timeout_counts_beside_it(void **state)
{
    (void)state;
    assert_in_range(maps_until_forgotten(4, 0, TIMEOUT / 20), 20, 26);
    assert_in_range(maps_until_forgotten(40, 0, TIMEOUT / 20), 40, 51);
}

static void coarser_levels_need_a_quarter_per_level(void **state)
{
    (void)state;
    assert_in_range(maps_until_forgotten(64, 1, 2 * TIMEOUT), 16, 16 + 17);
    assert_in_range(maps_until_forgotten(64, 2, 2 * TIMEOUT), 4, 4 + 17);
    assert_true(maps_until_forgotten(64, 1, 2 * TIMEOUT) <
                maps_until_forgotten(64, 0, 2 * TIMEOUT));
}

static void a_map_that_shows_it_again_starts_the_count_anew(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = open_with(&f, 5);
    uint64_t time = 1;
    for (uint32_t map = 0; map < 200; map++, time += 2 * TIMEOUT) {
        fixture_feed_region(&f, id, map % 5 ? 63 : 0, 0, time, TIMEOUT); /* missed four times */
        assert_true(is_wanted(&f, id, 0));
    }
    fixture_close(&f);
}

/* An empty map says of every region that it is gone. */
static void a_texture_that_is_not_seen_at_all_is_forgotten_at_once(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTextureId id = open_with(&f, 60);
    fixture_feed(&f, id, 0, 1, TIMEOUT);
    assert_int_equal(fixture_statistics(&f).requestedTileCount, 86);
    fixture_feed(&f, id, SLUICE_MIP_UNTOUCHED, 1 + TIMEOUT, TIMEOUT);
    assert_int_equal(fixture_statistics(&f).requestedTileCount, 0);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(with_one_the_timeout_alone_counts),
        cmocka_unit_test(with_one_returns_teach_nothing),
        cmocka_unit_test(with_n_that_many_maps_have_to_miss_it),
        cmocka_unit_test(with_n_the_timeout_counts_beside_it),
        cmocka_unit_test(coarser_levels_need_a_quarter_per_level),
        cmocka_unit_test(a_map_that_shows_it_again_starts_the_count_anew),
        cmocka_unit_test(a_texture_that_is_not_seen_at_all_is_forgotten_at_once),
    };
    return RUN_TESTS(tests);
}
