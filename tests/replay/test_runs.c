#include "replay/runs.h"

#include "base/alloc.h"
#include "support/test.h"

#include <string.h>

#define MAP_SIZE 5000

static uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* Runs of random lengths up to `longest`; 1 gives noise. */
static void fill(uint8_t *map, size_t size, uint32_t longest, uint32_t *seed)
{
    for (size_t i = 0; i < size;) {
        uint8_t value = (uint8_t)(next_random(seed) % 5);
        for (uint32_t n = 1 + next_random(seed) % longest; n > 0 && i < size; n--)
            map[i++] = value;
    }
}

static void every_map_comes_back(void **state)
{
    (void)state;
    static uint8_t map[MAP_SIZE], back[MAP_SIZE];
    uint32_t seed = 1;
    for (int round = 0; round < 400; round++) {
        size_t size = round < 40 ? (size_t)round : next_random(&seed) % MAP_SIZE;
        fill(map, size, 1u << (round % 10), &seed);
        SluiceAllocationCallbacks cb = slc_allocator(NULL);
        struct slc_bytes bytes;
        slc_bytes_init(&bytes, &cb);
        slc_put_runs(&bytes, map, size);
        assert_false(bytes.failed);
        assert_true(bytes.size <= size + size / 64 + 4);
        struct slc_cursor in = {bytes.data, 0, bytes.size, NULL};
        memset(back, 0xEE, sizeof back);
        slc_get_runs(&in, back, size);
        assert_null(in.why);
        assert_memory_equal(back, map, size);
        in = (struct slc_cursor){bytes.data, 0, bytes.size, NULL};
        slc_get_runs(&in, NULL, size);
        assert_null(in.why);
        slc_bytes_finish(&bytes);
    }
}

static void untouched_map_of_any_size_takes_few_bytes(void **state)
{
    (void)state;
    static uint8_t map[MAP_SIZE];
    memset(map, 255, sizeof map);
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_bytes bytes;
    slc_bytes_init(&bytes, &cb);
    slc_put_runs(&bytes, map, sizeof map);
    assert_int_equal(bytes.size, 3);
    slc_bytes_finish(&bytes);
}

static void runs_that_do_not_fit_the_map_fail(void **state)
{
    (void)state;
    static const uint8_t six[] = {2 << 1, 9, 2 << 1 | 1, 1, 2, 3};
    uint8_t map[8];
    struct slc_cursor in = {six, 0, sizeof six, NULL};
    slc_get_runs(&in, map, 6);
    assert_null(in.why);
    assert_int_equal(map[0] * 1000 + map[2] * 100 + map[3] * 10 + map[5], 9 * 1100 + 10 + 3);
    for (size_t size = 0; size < 9; size++) {
        in = (struct slc_cursor){six, 0, sizeof six, NULL};
        slc_get_runs(&in, map, size);
        assert_true(!in.why == (size == 6));
    }
    for (size_t cut = 0; cut < sizeof six; cut++) {
        in = (struct slc_cursor){six, 0, cut, NULL};
        slc_get_runs(&in, map, 6);
        assert_non_null(in.why);
    }
    static const uint8_t huge[] = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x01, 7};
    in = (struct slc_cursor){huge, 0, sizeof huge, NULL};
    slc_get_runs(&in, map, sizeof map);
    assert_non_null(in.why);
}

static void pairs_must_fill_the_map_exactly(void **state)
{
    (void)state;
    static const uint8_t pairs[] = {3, 255, 0, 4, 0x82, 0x00, 1};
    uint8_t map[8];
    struct slc_cursor in = {pairs, 0, sizeof pairs, NULL};
    slc_get_run_pairs(&in, map, 5);
    assert_null(in.why);
    assert_memory_equal(map, "\377\377\377\001\001", 5);
    for (size_t size = 0; size < 8; size++) {
        in = (struct slc_cursor){pairs, 0, sizeof pairs, NULL};
        slc_get_run_pairs(&in, map, size);
        assert_true(!in.why == (size == 5));
    }
    for (size_t cut = 0; cut < sizeof pairs; cut++) {
        in = (struct slc_cursor){pairs, 0, cut, NULL};
        slc_get_run_pairs(&in, map, 5);
        assert_non_null(in.why);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_map_comes_back),
        cmocka_unit_test(untouched_map_of_any_size_takes_few_bytes),
        cmocka_unit_test(runs_that_do_not_fit_the_map_fail),
        cmocka_unit_test(pairs_must_fill_the_map_exactly),
    };
    return RUN_TESTS(tests);
}
