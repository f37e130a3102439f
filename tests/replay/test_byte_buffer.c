#include "replay/byte_buffer.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdlib.h>

static struct slc_cursor whole(const struct slc_bytes *bytes)
{
    return (struct slc_cursor){bytes->data, 0, bytes->size, NULL};
}

static void numbers_come_back_at_both_ends_of_their_range(void **state)
{
    (void)state;
    struct failing_allocator a;
    failing_allocator_init(&a, UINT64_MAX);
    struct slc_bytes bytes;
    slc_bytes_init(&bytes, &a.callbacks);
    for (int bit = 0; bit < 64; bit++) {
        for (int d = -1; d <= 1; d++) {
            uint64_t value = (UINT64_C(1) << bit) + (uint64_t)(int64_t)d;
            slc_put_varint(&bytes, value);
            slc_put_signed(&bytes, (int64_t)value);
            slc_put_u64(&bytes, value);
            slc_put_u32(&bytes, (uint32_t)value);
            slc_put_u8(&bytes, (uint8_t)value);
        }
    }
    struct slc_cursor in = whole(&bytes);
    for (int bit = 0; bit < 64; bit++) {
        for (int d = -1; d <= 1; d++) {
            uint64_t value = (UINT64_C(1) << bit) + (uint64_t)(int64_t)d;
            assert_true(slc_get_varint(&in) == value);
            assert_true(slc_get_signed(&in) == (int64_t)value);
            assert_true(slc_get_u64(&in) == value);
            assert_true(slc_get_u32(&in) == (uint32_t)value);
            assert_true(slc_get_u8(&in) == (uint8_t)value);
        }
    }
    assert_null(in.why);
    assert_int_equal(in.pos, in.end);
    slc_bytes_finish(&bytes);
    assert_int_equal(a.live_bytes, 0);
}

static void fixed_numbers_are_little_endian(void **state)
{
    (void)state;
    static const uint8_t data[] = {0x01, 0x02, 0x03, 0x04, 0xAC, 0x02, 0x01};
    struct slc_cursor in = {data, 0, sizeof data, NULL};
    assert_int_equal(slc_get_u32(&in), 0x04030201);
    assert_int_equal(slc_get_varint(&in), 300);
    assert_int_equal(slc_get_signed(&in), -1);
    assert_null(in.why);
}

static void read_past_the_end_fails_where_it_began(void **state)
{
    (void)state;
    static const uint8_t data[] = {1, 0x80, 0x80};
    struct slc_cursor in = {data, 0, sizeof data, NULL};
    slc_get_u8(&in);
    assert_int_equal(slc_get_u32(&in), 0);
    assert_non_null(in.why);
    assert_int_equal(in.pos, 1);
    assert_int_equal(slc_get_u8(&in), 0); /* stays so */
    assert_int_equal(in.pos, 1);
    in = (struct slc_cursor){data, 1, sizeof data, NULL};
    assert_int_equal(slc_get_varint(&in), 0);
    assert_non_null(in.why);
    assert_null(slc_get_bytes(&in, 0));
}

static void number_too_large_for_its_type_fails(void **state)
{
    (void)state;
    static const uint8_t eleven[] = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF,
                                     0xFF, 0xFF, 0xFF, 0xFF, 0x01};
    static const uint8_t bit_64[] = {0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x02};
    static const uint8_t bit_32[] = {0x80, 0x80, 0x80, 0x80, 0x10};
    struct slc_cursor in = {eleven, 0, sizeof eleven, NULL};
    slc_get_varint(&in);
    assert_non_null(in.why);
    in = (struct slc_cursor){bit_64, 0, sizeof bit_64, NULL};
    slc_get_varint(&in);
    assert_non_null(in.why);
    in = (struct slc_cursor){bit_32, 0, sizeof bit_32, NULL};
    assert_int_equal(slc_get_varint32(&in), 0);
    assert_non_null(in.why);
    assert_int_equal(in.pos, 0);
    in = (struct slc_cursor){bit_32, 0, sizeof bit_32, NULL};
    assert_int_equal(slc_get_signed32(&in), 0);
    assert_non_null(in.why);
}

static void bytes_without_memory_stay_failed_and_leak_nothing(void **state)
{
    (void)state;
    for (uint64_t n = 0; n < 3; n++) {
        struct failing_allocator a;
        failing_allocator_init(&a, n);
        struct slc_bytes bytes;
        slc_bytes_init(&bytes, &a.callbacks);
        for (int i = 0; i < 10000; i++)
            slc_put_u64(&bytes, 7);
        assert_true(bytes.failed);
        assert_true(bytes.size <= bytes.capacity);
        slc_bytes_finish(&bytes);
        assert_int_equal(a.live_bytes, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_come_back_at_both_ends_of_their_range),
        cmocka_unit_test(fixed_numbers_are_little_endian),
        cmocka_unit_test(read_past_the_end_fails_where_it_began),
        cmocka_unit_test(number_too_large_for_its_type_fails),
        cmocka_unit_test(bytes_without_memory_stay_failed_and_leak_nothing),
    };
    return RUN_TESTS(tests);
}
