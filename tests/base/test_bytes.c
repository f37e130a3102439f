/* lib/base/bytes.h against loops over single bytes. */
#include "base/bytes.h"
#include "support/test.h"

static uint64_t next_random(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return *seed >> 33;
}

static void fill_random(uint8_t *bytes, size_t count, uint64_t *seed)
{
    for (size_t i = 0; i < count; i++)
        bytes[i] = (uint8_t)next_random(seed);
}

static void every_pair_of_bytes_has_its_least_greatest_and_difference(void **state)
{
    (void)state;
    for (uint32_t a = 0; a < 256; a++)
        for (uint32_t b = 0; b < 256; b++) {
            uint8_t x[SLC_BLOCK], y[SLC_BLOCK], out[SLC_BLOCK];
            memset(x, (int)a, sizeof x);
            memset(y, (int)a, sizeof y);
            uint32_t place = (a * 7 + b) % SLC_BLOCK;
            y[place] = (uint8_t)b;
            slc_block p = slc_load_block(x), q = slc_load_block(y);
            slc_store_block(out, slc_min_block(p, q));
            assert_int_equal(out[place], a < b ? a : b);
            slc_store_block(out, slc_max_block(p, q));
            assert_int_equal(out[place], a > b ? a : b);
            slc_store_block(out, slc_equal_block(p, q));
            assert_int_equal(out[place], a == b ? 255 : 0);
            assert_int_equal(out[(place + 1) % SLC_BLOCK], 255);
            assert_int_equal(slc_block_difference(p, q), a == b ? 0u : 1u << place);
        }
}

static void every_set_of_sixteen_bits_is_counted(void **state)
{
    (void)state;
    for (uint32_t bits = 0; bits < 1u << 16; bits++) {
        uint32_t count = 0;
        for (uint32_t i = 0; i < 16; i++)
            count += bits >> i & 1;
        assert_int_equal(slc_count_bits(bits), count);
    }
}

static void sums_hold_what_255_blocks_can_give(void **state)
{
    (void)state;
    assert_int_equal(slc_block_sum(slc_block_of(255)), 255 * SLC_BLOCK);
    assert_int_equal(slc_block_sum(slc_block_of(0)), 0);
    assert_int_equal(slc_batch_end(0, 255 * SLC_BLOCK), 255 * SLC_BLOCK);
    assert_int_equal(slc_batch_end(0, 256 * SLC_BLOCK), 255 * SLC_BLOCK);
    assert_int_equal(slc_batch_end(255 * SLC_BLOCK, 256 * SLC_BLOCK), 256 * SLC_BLOCK);
}

static void a_row_is_halved_to_the_least_of_pairs(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (uint32_t count = 0; count <= 100; count++) {
        uint8_t in[2 * 104 + SLC_BLOCK], out[104 + SLC_BLOCK];
        fill_random(in, sizeof in, &seed);
        slc_halve_bytes(in, count, out);
        for (uint32_t i = 0; i < count; i++)
            assert_int_equal(out[i], in[2 * i] < in[2 * i + 1] ? in[2 * i] : in[2 * i + 1]);
    }
}

static void a_short_row_is_filled_and_nothing_beside_it(void **state)
{
    (void)state;
    for (size_t count = 0; count <= 100; count++) {
        uint8_t bytes[128];
        memset(bytes, 1, sizeof bytes);
        slc_fill_bytes(bytes + 8, 200, count);
        for (size_t i = 0; i < sizeof bytes; i++)
            assert_int_equal(bytes[i], i >= 8 && i < 8 + count ? 200 : 1);
    }
}

static void equal_bytes_are_told_from_all_but_one(void **state)
{
    (void)state;
    for (size_t count = 1; count <= 70; count++) {
        uint8_t bytes[70];
        memset(bytes, 255, sizeof bytes);
        assert_true(slc_bytes_are(bytes, count, 255));
        assert_false(slc_bytes_are(bytes, count, 254));
        for (size_t i = 0; i < count; i++) {
            bytes[i] = 254;
            assert_false(slc_bytes_are(bytes, count, 255));
            bytes[i] = 255;
        }
    }
}

static void arrays_are_padded_to_whole_blocks(void **state)
{
    (void)state;
    for (size_t count = 0; count < 100; count++) {
        assert_true(slc_padded(count) >= count && slc_padded(count) < count + SLC_BLOCK);
        assert_int_equal(slc_padded(count) % SLC_BLOCK, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pair_of_bytes_has_its_least_greatest_and_difference),
        cmocka_unit_test(every_set_of_sixteen_bits_is_counted),
        cmocka_unit_test(sums_hold_what_255_blocks_can_give),
        cmocka_unit_test(a_row_is_halved_to_the_least_of_pairs),
        cmocka_unit_test(a_short_row_is_filled_and_nothing_beside_it),
        cmocka_unit_test(equal_bytes_are_told_from_all_but_one),
        cmocka_unit_test(arrays_are_padded_to_whole_blocks),
    };
    return RUN_TESTS(tests);
}
