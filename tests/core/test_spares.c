#include "core/spares.h"

#include "support/failing_allocator.h"
#include "support/roll.h"
#include "support/test.h"

#include <string.h>

#define HEADER 32u /* bytes of the header in each block allocated at once */

static slc_manager m; /* only spares and callbacks are used */

static struct failing_allocator memory;

static void begin(uint64_t refuse_from)
{
    failing_allocator_init(&memory, refuse_from);
    m = (slc_manager){.cb = memory.callbacks};
}

/* The allocator checks that blocks are freed with the size of their allocation. */
static void blocks_have_the_size_asked_for_and_a_quarter_more_at_most(void **state)
{
    (void)state;
    begin(UINT64_MAX);
    roll_seed(1);
    for (uint32_t i = 0; i < 3000; i++) {
        size_t size = i < 1100 ? i : (size_t)1 << roll() % 24;
        size += i < 1100 ? 0 : (size_t)roll() % 3 - 1;
        void *block = slc_spares_take(&m, size);
        assert_non_null(block);
        memset(block, 0xAB, size);
        assert_true(memory.live_bytes >= size);
        assert_true(memory.live_bytes <= HEADER + (size < 64 ? 64 : size + size / 4));
        slc_spares_give(&m, block, size);
        assert_int_equal(memory.live_bytes, 0);
    }
}

static void what_was_given_back_serves_others_of_about_that_size(void **state)
{
    (void)state;
    begin(UINT64_MAX);
    void *a = slc_spares_take(&m, 1000), *b = slc_spares_take(&m, 1000);
    slc_spares_give(&m, a, 1000);
    assert_int_equal(memory.live_count, 2);
    assert_ptr_equal(slc_spares_take(&m, 1024), a);
    assert_int_equal(memory.calls, 2);
    void *c = slc_spares_take(&m, 1025);
    assert_int_equal(memory.calls, 3);
    slc_spares_give(&m, a, 1024);
    slc_spares_give(&m, b, 1000);
    assert_int_equal(memory.live_count, 1); /* none of that size is in use */
    slc_spares_give(&m, c, 1025);
    assert_int_equal(memory.live_count, 0);
    slc_spares_give(&m, NULL, 1025);
}

/* Uses blocks in random order. All sizes belong to one class with blocks of 512 bytes. */
static void an_eighth_more_is_held_than_was_in_use_at_once(void **state)
{
    (void)state;
    enum { BLOCKS = 400 };
    begin(UINT64_MAX);
    uint8_t *blocks[BLOCKS] = {0};
    size_t sizes[BLOCKS];
    uint64_t used = 1, most = 1;
    void *kept = slc_spares_take(&m, 500);
    roll_seed(2);
    for (uint32_t i = 0; i < 40000; i++) {
        uint32_t at = (uint32_t)roll() % BLOCKS;
        if (blocks[at]) {
            slc_spares_give(&m, blocks[at], sizes[at]);
            blocks[at] = NULL;
            used--;
        } else {
            sizes[at] = 449 + (size_t)roll() % 64;
            blocks[at] = slc_spares_take(&m, sizes[at]);
            memset(blocks[at], (int)(at & 255), sizes[at]);
            most = ++used > most ? used : most;
        }
        assert_true(memory.live_bytes <= (most + most / 8) * 512 + memory.live_count * HEADER);
    }
    assert_true(memory.calls < 50); /* some 16 single ones, then in steps */
    for (uint32_t i = 0; i < BLOCKS; i++)
        for (size_t k = 0; blocks[i] && k < sizes[i]; k++)
            assert_int_equal(blocks[i][k], i & 255); /* nobody else's */
    for (uint32_t i = 0; i < BLOCKS; i++)
        if (blocks[i])
            slc_spares_give(&m, blocks[i], sizes[i]);
    slc_spares_give(&m, kept, 500);
    assert_int_equal(memory.live_count, 0);
}

static void memory_that_is_refused_changes_nothing(void **state)
{
    (void)state;
    begin(1);
    void *block = slc_spares_take(&m, 100);
    assert_null(slc_spares_take(&m, 100));
    slc_spares_give(&m, block, 100);
    assert_int_equal(memory.live_count, 0);
    void *blocks[16];
    begin(16);
    for (uint32_t i = 0; i < 16; i++)
        assert_non_null(blocks[i] = slc_spares_take(&m, 100));
    assert_null(slc_spares_take(&m, 100));
    assert_int_equal(memory.calls, 18); /* for two, and for one */
    for (uint32_t i = 0; i < 16; i++)
        slc_spares_give(&m, blocks[i], 100);
    assert_int_equal(memory.live_count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_have_the_size_asked_for_and_a_quarter_more_at_most),
        cmocka_unit_test(what_was_given_back_serves_others_of_about_that_size),
        cmocka_unit_test(an_eighth_more_is_held_than_was_in_use_at_once),
        cmocka_unit_test(memory_that_is_refused_changes_nothing),
    };
    return RUN_TESTS(tests);
}
