#include "base/map.h"

#include "base/alloc.h"
#include "support/failing_allocator.h"
#include "support/roll.h"
#include "support/test.h"

static void random_adds_and_removes_agree_with_an_array(void **state)
{
    (void)state;
    enum { KEYS = 300, CAPACITY = 200 };
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_map map;
    CHECK_OK(slc_map_init(&map, &cb, CAPACITY));
    uint32_t oracle[KEYS];
    for (uint32_t i = 0; i < KEYS; i++)
        oracle[i] = SLC_MAP_NONE;
    roll_seed(3);
    uint32_t count = 0;
    for (uint32_t step = 0; step < 100000; step++) {
        uint32_t k = (uint32_t)roll() % KEYS;
        uint64_t key = slc_pair_key(k % 3, k / 3 * 1024); /* keys that differ in few bits */
        assert_int_equal(slc_map_get(&map, key), oracle[k]);
        if (oracle[k] != SLC_MAP_NONE) {
            slc_map_remove(&map, key);
            oracle[k] = SLC_MAP_NONE;
            count--;
        } else if (count < CAPACITY) {
            slc_map_add(&map, key, step);
            oracle[k] = step;
            count++;
        } else {
            slc_map_remove(&map, key); /* not there: nothing happens */
        }
        assert_int_equal(map.count, count);
    }
    for (uint32_t k = 0; k < KEYS; k++)
        assert_int_equal(slc_map_get(&map, slc_pair_key(k % 3, k / 3 * 1024)), oracle[k]);
    slc_map_finish(&map, &cb);
}

static void creation_survives_every_allocation_failure(void **state)
{
    (void)state;
    for (uint64_t n = 0;; n++) {
        struct failing_allocator a;
        failing_allocator_init(&a, n);
        struct slc_map map;
        SluiceResult result = slc_map_init(&map, &a.callbacks, 10);
        if (result == SLUICE_SUCCESS)
            slc_map_finish(&map, &a.callbacks);
        assert_int_equal(a.live_count, 0);
        if (result == SLUICE_SUCCESS)
            break;
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
}

static void a_map_that_grows_keeps_what_is_in_it(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_map map;
    CHECK_OK(slc_map_init(&map, &cb, 1));
    for (uint32_t i = 0; i < 1000; i++) {
        CHECK_OK(slc_map_reserve(&map, &cb, i + 1));
        slc_map_add(&map, slc_pair_key(i % 7, i), i * 3);
    }
    for (uint32_t i = 0; i < 1000; i++)
        assert_int_equal(slc_map_get(&map, slc_pair_key(i % 7, i)), i * 3);
    assert_int_equal(map.count, 1000);
    slc_map_finish(&map, &cb);
}

static void growing_survives_every_allocation_failure(void **state)
{
    (void)state;
    for (uint64_t n = 2;; n++) { /* two for init */
        struct failing_allocator a;
        failing_allocator_init(&a, n);
        struct slc_map map;
        CHECK_OK(slc_map_init(&map, &a.callbacks, 1));
        slc_map_add(&map, 77, 5);
        SluiceResult result = slc_map_reserve(&map, &a.callbacks, 100);
        assert_int_equal(slc_map_get(&map, 77), 5);
        assert_int_equal(map.capacity, result == SLUICE_SUCCESS ? 100 : 1);
        slc_map_finish(&map, &a.callbacks);
        assert_int_equal(a.live_count, 0);
        if (result == SLUICE_SUCCESS)
            break;
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_adds_and_removes_agree_with_an_array),
        cmocka_unit_test(creation_survives_every_allocation_failure),
        cmocka_unit_test(a_map_that_grows_keeps_what_is_in_it),
        cmocka_unit_test(growing_survives_every_allocation_failure),
    };
    return RUN_TESTS(tests);
}
