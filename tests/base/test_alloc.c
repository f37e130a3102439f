#include "base/alloc.h"
#include "base/checked.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <string.h>

static void product_that_overflows_is_refused(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    assert_null(slc_alloc(&cb, SIZE_MAX / 2, 3));
    assert_null(slc_alloc(&cb, 0, 3));
}

static void default_allocator_honors_large_alignments(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    for (size_t alignment = 1; alignment <= 4096; alignment *= 2) {
        void *memory = slc_alloc_aligned(&cb, 3, 7, alignment);
        assert_non_null(memory);
        assert_int_equal((uintptr_t)memory % alignment, 0);
        slc_free(&cb, memory, 3, 7);
    }
}

static void regrow_that_fails_keeps_the_old_memory(void **state)
{
    (void)state;
    struct failing_allocator a;
    failing_allocator_init(&a, 1);
    char *memory = slc_strdup(&a.callbacks, "abc");
    assert_null(slc_regrow(&a.callbacks, memory, 4, 100, 1));
    assert_string_equal(memory, "abc");
    a.refuse_from = UINT64_MAX;
    memory = slc_regrow(&a.callbacks, memory, 4, 100, 1);
    assert_string_equal(memory, "abc");
    slc_free(&a.callbacks, memory, 100, 1);
    assert_int_equal(a.live_bytes, 0);
}

static void checked_arithmetic_is_right_at_its_ends(void **state)
{
    (void)state;
    size_t out = 7;
    assert_false(slc_mul_size(SIZE_MAX, 2, &out));
    assert_false(slc_add_size(SIZE_MAX, 1, &out));
    assert_true(slc_mul_size(SIZE_MAX, 1, &out) && out == SIZE_MAX);
    assert_true(slc_add_size(SIZE_MAX, 0, &out) && out == SIZE_MAX);
    assert_int_equal(slc_div_up_u32(UINT32_MAX, 2), 0x80000000u);
    assert_int_equal(slc_mip_count((1u << 21) - 1), 21);
    assert_int_equal(slc_mip_count(1u << 20), 21);
    assert_int_equal(slc_mip_size(5, 2), 1);
    assert_int_equal(slc_mip_size(5, 40), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(product_that_overflows_is_refused),
        cmocka_unit_test(default_allocator_honors_large_alignments),
        cmocka_unit_test(regrow_that_fails_keeps_the_old_memory),
        cmocka_unit_test(checked_arithmetic_is_right_at_its_ends),
    };
    return RUN_TESTS(tests);
}
