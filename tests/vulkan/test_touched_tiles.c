#include "vulkan/touched_tiles.h"

#include "base/alloc.h"
#include "support/failing_allocator.h"
#include "support/test.h"

static void tile_counts_once(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_touch_budget budget = {.limit = 3};
    struct slc_touched_tiles tiles;
    CHECK_OK(slc_touched_tiles_init(&tiles, &cb, &budget, 100, 99));
    assert_int_equal(budget.count, 1); /* the packed one */
    for (int i = 0; i < 5; i++) {
        assert_true(slc_touched_tiles_touch(&tiles, &budget, 31));
        assert_true(slc_touched_tiles_touch(&tiles, &budget, 32));
        assert_true(slc_touched_tiles_touch(&tiles, &budget, 99));
    }
    assert_int_equal(budget.count, 3);
    assert_false(slc_touched_tiles_touch(&tiles, &budget, 0));
    assert_int_equal(budget.count, 3);
    slc_touched_tiles_finish(&tiles, &cb, &budget);
    assert_int_equal(budget.count, 0);
}

static void image_that_goes_makes_room_for_another(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_touch_budget budget = {.limit = 4};
    struct slc_touched_tiles a, b;
    CHECK_OK(slc_touched_tiles_init(&a, &cb, &budget, 10, 8));
    CHECK_OK(slc_touched_tiles_init(&b, &cb, &budget, 10, 10));
    assert_true(slc_touched_tiles_touch(&a, &budget, 0));
    assert_true(slc_touched_tiles_touch(&b, &budget, 0));
    assert_false(slc_touched_tiles_touch(&b, &budget, 1));
    slc_touched_tiles_finish(&a, &cb, &budget);
    for (uint32_t tile = 1; tile < 4; tile++)
        assert_true(slc_touched_tiles_touch(&b, &budget, tile));
    assert_false(slc_touched_tiles_touch(&b, &budget, 4));
    slc_touched_tiles_finish(&b, &cb, &budget);
}

static void packed_tiles_must_fit_at_once(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_touch_budget budget = {.limit = 4, .count = 1};
    struct slc_touched_tiles tiles;
    CHECK_RESULT(slc_touched_tiles_init(&tiles, &cb, &budget, 10, 6), SLUICE_ERROR_LIMIT_EXCEEDED);
    assert_int_equal(budget.count, 1);
    slc_touched_tiles_finish(&tiles, &cb, &budget);
    CHECK_OK(slc_touched_tiles_init(&tiles, &cb, &budget, 10, 7));
    assert_int_equal(budget.count, 4);
    slc_touched_tiles_finish(&tiles, &cb, &budget);
    assert_int_equal(budget.count, 1);
}

static void without_a_limit_nothing_is_counted(void **state)
{
    (void)state;
    struct failing_allocator a;
    failing_allocator_init(&a, 0); /* nor remembered */
    struct slc_touch_budget budget = {0};
    struct slc_touched_tiles tiles;
    CHECK_OK(slc_touched_tiles_init(&tiles, &a.callbacks, &budget, 1u << 31, 0));
    assert_true(slc_touched_tiles_touch(&tiles, &budget, 12345));
    assert_int_equal(budget.count, 0);
    slc_touched_tiles_finish(&tiles, &a.callbacks, &budget);
    budget.limit = 1;
    CHECK_RESULT(slc_touched_tiles_init(&tiles, &a.callbacks, &budget, 40, 40),
                 SLUICE_ERROR_OUT_OF_HOST_MEMORY);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tile_counts_once),
        cmocka_unit_test(image_that_goes_makes_room_for_another),
        cmocka_unit_test(packed_tiles_must_fit_at_once),
        cmocka_unit_test(without_a_limit_nothing_is_counted),
    };
    return RUN_TESTS(tests);
}
