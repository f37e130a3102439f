#include "base/bits.h"
#include "support/test.h"

/* Bit by bit. */
static void every_pair_of_bits_is_found_and_counted(void **state)
{
    (void)state;
    for (uint32_t low = 0; low < 64; low++)
        for (uint32_t high = low; high < 64; high++) {
            uint64_t bits = UINT64_C(1) << low | UINT64_C(1) << high;
            assert_int_equal(slc_lowest_bit64(bits), low);
            if (high >= 32)
                continue;
            assert_int_equal(slc_lowest_bit((uint32_t)bits), low);
            assert_int_equal(slc_highest_bit((uint32_t)bits), high);
            assert_int_equal(slc_count_ones((uint32_t)bits), low == high ? 1 : 2);
        }
    assert_int_equal(slc_count_ones(0), 0);
    assert_int_equal(slc_count_ones(UINT32_MAX), 32);
    assert_int_equal(slc_lowest_bit64(UINT64_MAX), 0);
    assert_int_equal(slc_highest_bit(UINT32_MAX), 31);
    SLC_PREFETCH(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_pair_of_bits_is_found_and_counted)};
    return RUN_TESTS(tests);
}
