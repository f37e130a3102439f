/* Number of rounds that a request waits until a visible finer tile makes room. */
#include "core/fixture.h"

enum { FINE = 4 }; /* number of slots, all taken by tiles of level 0 */

/* Adds a square texture with `levels` levels, all regular. The coarsest has one tile, or four if it
 * is alone. */
static SluiceTextureId add_square(struct fixture *f, uint32_t levels)
{
    const uint32_t size = levels > 1 ? 128u << (levels - 1) : 256;
    const SluiceStreamedTextureDesc desc = {size, size, levels, levels, 0, 128, 128, 0, 0};
    return fixture_add(f, &desc);
}

/* Runs a round: every texture that holds something gets a map, then tiles are handed out. The fine
 * texture's map shows level `seen`. */
static bool displaced_in_round(struct fixture *f, SluiceTextureId fine, uint8_t seen,
                               SluiceTextureId coarse, uint32_t level, uint64_t time)
{
    uint32_t count = 0;
    fixture_feed(f, fine, seen, time, 100);
    if (coarse)
        fixture_feed(f, coarse, (uint8_t)level, time, 100);
    SluiceResult result = fixture_to_map(f, SLUICE_ALL_TEXTURES);
    CHECK_RESULT(result, coarse ? SLUICE_BUDGET_REACHED : SLUICE_SUCCESS);
    fixture_answer_mapped(f);
    CHECK_OK(sluiceGetTilesToUnmap(f->manager, SLUICE_ALL_TEXTURES, 0, &count, NULL));
    return count > 0;
}

/* Returns the round in which a tile of level 0 makes room for a request of round `requested`. */
static uint32_t round_of_displacing(uint32_t level, uint32_t requested)
{
    struct fixture f;
    fixture_open(&f, FINE, false);
    f.heaps.limit = 1;
    SluiceTextureId fine = add_square(&f, 1), coarse = add_square(&f, level + 1);
    uint32_t round = 1;
    while (!displaced_in_round(&f, fine, 0, round < requested ? SLUICE_NO_TEXTURE : coarse, level,
                               round)) {
        assert_int_equal(fixture_statistics(&f).mappedTileCount, FINE);
        assert_true(++round < 100);
    }
    assert_int_equal(fixture_statistics(&f).mappedTileCount, FINE - 1);
    fixture_close(&f);
    return round;
}

static void three_levels_are_worth_an_upload_at_once(void **state)
{
    (void)state;
    for (uint32_t requested = 2; requested <= 12; requested++)
        assert_int_equal(round_of_displacing(3, requested), requested);
}

static void two_levels_are_once_the_request_has_waited_for_a_whole_round(void **state)
{
    (void)state;
    for (uint32_t requested = 2; requested <= 12; requested++)
        assert_int_equal(round_of_displacing(2, requested), requested + 1);
}

static void one_level_is_after_four_rounds_that_end_with_a_fourth(void **state)
{
    (void)state;
    for (uint32_t requested = 2; requested <= 20; requested++)
        assert_int_equal(round_of_displacing(1, requested), (requested + 3) / 4 * 4 + 4);
}

/* Returns that round for tiles that are still wanted, but no longer in their texture's maps. */
static uint32_t round_of_displacing_unseen(uint32_t level, uint32_t requested)
{
    struct fixture f;
    fixture_open(&f, FINE, false);
    f.heaps.limit = 1;
    SluiceTextureId fine = add_square(&f, 1), other = add_square(&f, level + 1);
    uint32_t round = 1;
    for (; round < requested; round++)
        assert_false(displaced_in_round(&f, fine, 0, SLUICE_NO_TEXTURE, level, round));
    while (!displaced_in_round(&f, fine, SLUICE_MIP_UNTOUCHED, other, level, round))
        assert_true(++round < 100);
    fixture_close(&f);
    return round;
}

static void an_unseen_tile_makes_room_for_a_coarser_level_at_once(void **state)
{
    (void)state;
    for (uint32_t level = 1; level <= 3; level++)
        for (uint32_t requested = 2; requested <= 12; requested++)
            assert_int_equal(round_of_displacing_unseen(level, requested), requested);
}

static void an_unseen_tile_makes_room_for_its_own_level_after_a_whole_round(void **state)
{
    (void)state;
    for (uint32_t requested = 2; requested <= 12; requested++)
        assert_int_equal(round_of_displacing_unseen(0, requested), requested + 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_levels_are_worth_an_upload_at_once),
        cmocka_unit_test(two_levels_are_once_the_request_has_waited_for_a_whole_round),
        cmocka_unit_test(one_level_is_after_four_rounds_that_end_with_a_fourth),
        cmocka_unit_test(an_unseen_tile_makes_room_for_a_coarser_level_at_once),
        cmocka_unit_test(an_unseen_tile_makes_room_for_its_own_level_after_a_whole_round),
    };
    return RUN_TESTS(tests);
}
