/**
 * Cost of calls with many objects, in counted steps of searches. Twice as many objects must cost at
 * most three times as many steps. Quadratic cost would be four times.
 */
#include "core/fixture.h"

#include "core/check.h"
#include "core/state.h"

enum { MOVES = 16 };

static SluiceTextureId ids[20000];

/* Adds textures of one packed tile. The last list of each call names some of them. */
static void add_many(struct fixture *f, uint32_t count)
{
    const SluiceStreamedTextureDesc desc = full_chain(64, 64, 128, 128);
    for (uint32_t i = 0; i < count; i++)
        ids[i] = fixture_add(f, &desc);
}

static void check_growth(uint64_t once, uint64_t twice)
{
    if (twice > 3 * once)
        fail_msg("%llu steps, and %llu for twice as much", (unsigned long long)once,
                 (unsigned long long)twice);
}

/* Returns the steps for heaps that are three quarters empty, so that each can be emptied. */
static uint64_t steps_of_defragmenting(uint32_t heaps, bool movable)
{
    struct fixture f;
    SluiceTileMove moves[MOVES];
    uint32_t count = MOVES;
    fixture_open(&f, 4, true);
    add_many(&f, 4 * heaps);
    while (fixture_to_map(&f, SLUICE_ALL_TEXTURES) == SLUICE_INCOMPLETE || f.count)
        if (movable)
            fixture_answer_mapped(&f);
    for (uint32_t i = 0; i < 4 * heaps; i++)
        if (i % 4)
            CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[i], 0));
    uint64_t steps = f.manager->residency.steps;
    CHECK_OK(sluiceDefragmentTiles(f.manager, 0, &count, moves));
    assert_int_equal(count, movable ? MOVES : 0);
    steps = f.manager->residency.steps - steps;
    assert_null(slc_manager_check(f.manager));
    fixture_close(&f);
    return steps;
}

static void defragmenting_looks_at_each_heap_a_few_times(void **state)
{
    (void)state;
    for (int movable = 0; movable < 2; movable++) {
        uint64_t once = steps_of_defragmenting(FIXTURE_HEAPS / 2, movable);
        uint64_t twice = steps_of_defragmenting(FIXTURE_HEAPS, movable);
        check_growth(once, twice);
        assert_true(twice < 30 * FIXTURE_HEAPS); /* examining all for each takes at least 65 536 */
    }
}

static void fail_tiles(struct fixture *f, uint32_t first, uint32_t count, uint64_t time)
{
    const uint32_t tile = 0;
    for (uint32_t i = first; i < first + count; i++)
        CHECK_OK(sluiceReportFailedTiles(f->manager, ids[i], 1, &tile, time));
}

/* Half of the failures are reported after, and due before, the other half. */
static uint64_t steps_of_failing(uint32_t count)
{
    struct fixture f;
    fixture_open(&f, 4096, true);
    fixture_configure(&f, 0, 0, 0, 1000000);
    add_many(&f, count);
    while (fixture_to_map(&f, SLUICE_ALL_TEXTURES) == SLUICE_INCOMPLETE || f.count)
        continue;
    fail_tiles(&f, 0, count / 2, 0);
    fixture_configure(&f, 0, 0, 0, 1000);
    uint64_t steps = f.manager->residency.steps;
    fail_tiles(&f, count / 2, count / 2, 1);
    steps = f.manager->residency.steps - steps;
    assert_null(slc_manager_check(f.manager));
    fixture_close(&f);
    return steps;
}

static void failures_do_not_pass_all_that_are_due_later(void **state)
{
    (void)state;
    uint64_t once = steps_of_failing(5000), twice = steps_of_failing(10000);
    check_growth(once, twice);
    assert_true(twice < 40 * 10000);
}

static void failed_tiles_come_back_in_the_order_in_which_they_are_due(void **state)
{
    (void)state;
    struct fixture f;
    uint64_t seed = 7;
    enum { COUNT = 600 };
    uint64_t due[COUNT];
    fixture_open(&f, 1024, true);
    add_many(&f, COUNT);
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    for (uint32_t i = 0; i < COUNT; i++) {
        uint64_t delay = 10 * (next_random(&seed) % 20);
        fixture_configure(&f, 0, 0, 0, delay + 1);
        fail_tiles(&f, i, 1, 0);
        due[i] = delay + 1;
    }
    uint64_t last_due = 0, last_id = 0;
    uint32_t listed = 0;
    for (uint64_t time = 0; time < 200; time += 7) {
        CHECK_OK(sluiceReportFailedTiles(f.manager, ids[0], 0, NULL,
                                         time)); /* brings the time forward */
        CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
        for (uint32_t i = 0; i < f.count; i++, listed++) {
            uint32_t at = (uint32_t)f.tiles[i].textureId;
            assert_true(due[at] <= time && due[at] >= last_due);
            assert_true(due[at] > last_due || at > last_id || listed == 0);
            last_due = due[at];
            last_id = at;
        }
    }
    assert_int_equal(listed, COUNT);
    fixture_close(&f);
}

/* Returns the steps for textures with one given-up tile each and no requests. */
static uint64_t steps_of_removing_what_was_given_up(uint32_t count)
{
    struct fixture f;
    fixture_open(&f, 4096, true);
    fixture_configure(&f, 0, 0, 1, 1);
    add_many(&f, count);
    while (fixture_to_map(&f, SLUICE_ALL_TEXTURES) == SLUICE_INCOMPLETE || f.count)
        continue;
    fail_tiles(&f, 0, count, 0);
    uint64_t steps = f.manager->residency.steps;
    for (uint32_t i = count; i-- > 3;)
        CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[i], 0));
    steps = f.manager->residency.steps - steps;
    assert_null(slc_manager_check(f.manager));
    f.count = FIXTURE_ROOM;
    CHECK_OK(sluiceGetGivenUpTiles(f.manager, &f.count, f.tiles));
    assert_int_equal(f.count, 3);
    for (uint32_t i = 0; i < 3; i++)
        assert_true(f.tiles[i].textureId == ids[i]);
    fixture_close(&f);
    return steps;
}

static void a_removed_texture_forgets_its_own_reports_alone(void **state)
{
    (void)state;
    uint64_t once = steps_of_removing_what_was_given_up(5000);
    check_growth(once, steps_of_removing_what_was_given_up(10000));
    assert_true(once < 10 * 5000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defragmenting_looks_at_each_heap_a_few_times),
        cmocka_unit_test(failures_do_not_pass_all_that_are_due_later),
        cmocka_unit_test(failed_tiles_come_back_in_the_order_in_which_they_are_due),
        cmocka_unit_test(a_removed_texture_forgets_its_own_reports_alone),
    };
    return RUN_TESTS(tests);
}
