#include "vulkan/region_arena.h"

#include "base/alloc.h"
#include "support/roll.h"
#include "support/test.h"

#include <string.h>

enum { SIZE = 1000, RANGES = 40 };

struct range {
    uint32_t first, count;
};

static void random_ranges_never_overlap_and_all_room_comes_back(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_region_arena arena;
    CHECK_OK(slc_region_arena_init(&arena, &cb, SIZE, RANGES));
    uint8_t used[SIZE] = {0};
    struct range ranges[RANGES] = {{0, 0}};
    roll_seed(5);
    for (int step = 0; step < 20000; step++) {
        struct range *r = &ranges[roll() % RANGES];
        if (r->count) {
            slc_region_arena_give(&arena, r->first, r->count);
            memset(used + r->first, 0, r->count);
            r->count = 0;
            continue;
        }
        uint32_t count = 1 + (uint32_t)roll() % 80;
        if (!slc_region_arena_take(&arena, count, &r->first))
            continue;
        r->count = count;
        assert_int_equal(r->first % SLC_REGION_ALIGNMENT, 0);
        assert_true(r->first + count <= SIZE);
        for (uint32_t i = 0; i < count; i++)
            assert_int_equal(used[r->first + i]++, 0);
    }
    for (int i = 0; i < RANGES; i++)
        if (ranges[i].count)
            slc_region_arena_give(&arena, ranges[i].first, ranges[i].count);
    uint32_t first;
    assert_true(slc_region_arena_take(&arena, SIZE, &first));
    assert_int_equal(first, 0);
    assert_false(slc_region_arena_take(&arena, 1, &first));
    slc_region_arena_finish(&arena, &cb);
}

static void nothing_and_too_much_are_refused(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_region_arena arena;
    CHECK_OK(slc_region_arena_init(&arena, &cb, 64, 4));
    uint32_t first;
    assert_false(slc_region_arena_take(&arena, 0, &first));
    assert_false(slc_region_arena_take(&arena, 65, &first));
    assert_false(slc_region_arena_take(&arena, UINT32_MAX, &first));
    slc_region_arena_finish(&arena, &cb);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_ranges_never_overlap_and_all_room_comes_back),
        cmocka_unit_test(nothing_and_too_much_are_refused),
    };
    return RUN_TESTS(tests);
}
