#include "image/retry.h"

#include "support/test.h"

static const SluiceTileRetryPolicy five = {5, 100, 450};

static void temporary_errors_are_tried_again_with_doubled_delays(void **state)
{
    (void)state;
    static const SluiceResult results[] = {SLUICE_ERROR_IO, SLUICE_NOT_READY,
                                           SLUICE_ERROR_OUT_OF_HOST_MEMORY};
    static const uint64_t delays[] = {100, 200, 400, 450};
    for (size_t r = 0; r < sizeof results / sizeof results[0]; r++)
        for (uint32_t i = 1; i <= 6; i++) {
            struct slc_attempts attempts = {i, 0};
            uint64_t delay = 0;
            assert_int_equal(slc_retry_is_due(&five, &attempts, results[r], &delay), i < 5);
            if (i < 5)
                assert_int_equal(delay, delays[i - 1]);
        }
}

static void damage_is_looked_at_twice(void **state)
{
    (void)state;
    uint64_t delay;
    struct slc_attempts first = {1, 1}, second = {2, 2}, after_error = {3, 1}, last = {5, 1};
    assert_true(slc_retry_is_due(&five, &first, SLUICE_ERROR_CORRUPT_DATA, &delay));
    assert_int_equal(delay, 100);
    assert_false(slc_retry_is_due(&five, &second, SLUICE_ERROR_CORRUPT_DATA, &delay));
    assert_true(slc_retry_is_due(&five, &after_error, SLUICE_ERROR_CORRUPT_DATA, &delay));
    assert_int_equal(delay, 400);
    assert_false(slc_retry_is_due(&five, &last, SLUICE_ERROR_CORRUPT_DATA, &delay));
}

static void what_will_not_pass_is_not_tried_again(void **state)
{
    (void)state;
    static const SluiceResult results[] = {
        SLUICE_SUCCESS,           SLUICE_ERROR_CANCELED,       SLUICE_ERROR_INVALID_ARGUMENT,
        SLUICE_ERROR_UNSUPPORTED, SLUICE_ERROR_FILE_NOT_FOUND, SLUICE_ERROR_NULL_POINTER};
    struct slc_attempts attempts = {1, 0};
    uint64_t delay;
    for (size_t i = 0; i < sizeof results / sizeof results[0]; i++)
        assert_false(slc_retry_is_due(&five, &attempts, results[i], &delay));
}

static void zeros_are_the_defaults_and_one_attempt_is_no_retry(void **state)
{
    (void)state;
    SluiceTileRetryPolicy policy = slc_retry_policy(&(SluiceTileRetryPolicy){0});
    struct slc_attempts attempts = {1, 0};
    uint64_t delay;
    assert_int_equal(policy.maxAttempts, 4);
    assert_int_equal(policy.firstDelayNs, 10000000);
    assert_int_equal(policy.maxDelayNs, 1000000000);
    policy = slc_retry_policy(&(SluiceTileRetryPolicy){.maxAttempts = 1});
    assert_false(slc_retry_is_due(&policy, &attempts, SLUICE_ERROR_IO, &delay));
}

static void delays_do_not_wrap(void **state)
{
    (void)state;
    SluiceTileRetryPolicy policy = {UINT32_MAX, (uint64_t)1 << 60, UINT64_MAX};
    struct slc_attempts attempts = {4, 0};
    uint64_t delay;
    assert_true(slc_retry_is_due(&policy, &attempts, SLUICE_ERROR_IO, &delay));
    assert_true(delay == (uint64_t)1 << 63);
    attempts.count = 4000000000u;
    assert_true(slc_retry_is_due(&policy, &attempts, SLUICE_ERROR_IO, &delay));
    assert_true(delay == UINT64_MAX);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(temporary_errors_are_tried_again_with_doubled_delays),
        cmocka_unit_test(damage_is_looked_at_twice),
        cmocka_unit_test(what_will_not_pass_is_not_tried_again),
        cmocka_unit_test(zeros_are_the_defaults_and_one_attempt_is_no_retry),
        cmocka_unit_test(delays_do_not_wrap),
    };
    return RUN_TESTS(tests);
}
