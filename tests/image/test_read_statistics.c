#include "image/read_statistics.h"

#include "support/test.h"

#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* The smallest latency that at least so many percent of all do not exceed. */
static uint64_t exact_percentile(const uint64_t *sorted, uint32_t count, uint32_t percent)
{
    uint32_t wanted = (count * percent + 99) / 100;
    return sorted[wanted - 1];
}

static void percentiles_are_at_most_twice_too_large(void **state)
{
    (void)state;
    enum { LARGEST = 500 };
    uint64_t latencies[LARGEST], sorted[LARGEST];
    uint32_t random = 3;
    for (uint32_t count = 1; count <= LARGEST; count += 1 + count / 7) {
        struct slc_read_statistics statistics = {0};
        uint64_t sum = 0;
        for (uint32_t i = 0; i < count; i++) {
            random = random * 1664525u + 1013904223u;
            latencies[i] = sorted[i] = (uint64_t)random >> (random & 31);
            sum += latencies[i];
            slc_read_statistics_add_attempt(&statistics, SLUICE_SUCCESS, 0, latencies[i]);
        }
        qsort(sorted, count, sizeof *sorted, compare);
        SluiceTileLoaderStatistics s = {.structSize = sizeof s};
        slc_read_statistics_write(&statistics, &s);
        uint64_t median = exact_percentile(sorted, count, 50);
        uint64_t high = exact_percentile(sorted, count, 99);
        assert_true(s.medianLatencyNs >= median && s.medianLatencyNs <= 2 * median + 1);
        assert_true(s.latency99Ns >= high && s.latency99Ns <= 2 * high + 1);
        assert_true(s.latency99Ns <= s.maxLatencyNs && s.maxLatencyNs == sorted[count - 1]);
        assert_int_equal(s.meanLatencyNs, sum / count);
    }
}

static void equal_latencies_are_told_exactly(void **state)
{
    (void)state;
    static const uint64_t latencies[] = {0, 1, 2, 3, 1000, 1 << 20, (uint64_t)1 << 60, UINT64_MAX};
    for (size_t i = 0; i < sizeof latencies / sizeof latencies[0]; i++) {
        struct slc_read_statistics statistics = {0};
        SluiceTileLoaderStatistics s = {.structSize = sizeof s};
        slc_read_statistics_add_attempt(&statistics, SLUICE_SUCCESS, 0, latencies[i]);
        slc_read_statistics_write(&statistics, &s);
        assert_true(s.medianLatencyNs == latencies[i] && s.latency99Ns == latencies[i]);
        assert_true(s.meanLatencyNs == latencies[i] && s.maxLatencyNs == latencies[i]);
    }
}

static void attempts_and_ends_are_counted_by_their_results(void **state)
{
    (void)state;
    struct slc_read_statistics statistics = {0};
    static const SluiceResult attempts[] = {
        SLUICE_SUCCESS,  SLUICE_NOT_READY,          SLUICE_NOT_READY,     SLUICE_ERROR_IO,
        SLUICE_ERROR_IO, SLUICE_ERROR_CORRUPT_DATA, SLUICE_ERROR_CANCELED};
    for (size_t i = 0; i < sizeof attempts / sizeof attempts[0]; i++)
        slc_read_statistics_add_attempt(&statistics, attempts[i], 1000 + i, 0);
    slc_read_statistics_add_end(&statistics, SLUICE_SUCCESS, 100);
    slc_read_statistics_add_end(&statistics, SLUICE_SUCCESS, 11);
    slc_read_statistics_add_end(&statistics, SLUICE_ERROR_IO, 0);
    slc_read_statistics_add_end(&statistics, SLUICE_NOT_READY, 0);
    slc_read_statistics_add_end(&statistics, SLUICE_ERROR_CANCELED, 0);
    SluiceTileLoaderStatistics s = {.structSize = sizeof s};
    slc_read_statistics_write(&statistics, &s);
    assert_int_equal(s.attemptCount, 7);
    assert_int_equal(s.notReadyCount, 2);
    assert_int_equal(s.failedCount, 3);
    assert_int_equal(s.succeededCount, 2);
    assert_int_equal(s.byteCount, 111);
    assert_int_equal(s.givenUpCount, 2);
    assert_int_equal(s.canceledCount, 1);
    CHECK_RESULT(s.lastFailure, SLUICE_ERROR_CORRUPT_DATA);
    assert_int_equal(s.lastFailureOffset, 1005);
}

static void nothing_is_all_zeros(void **state)
{
    (void)state;
    struct slc_read_statistics statistics = {0};
    SluiceTileLoaderStatistics s = {.structSize = sizeof s};
    slc_read_statistics_write(&statistics, &s);
    assert_true(s.meanLatencyNs == 0 && s.medianLatencyNs == 0 && s.latency99Ns == 0 &&
                s.readCount == 0);
    assert_true(s.lastFailure == SLUICE_SUCCESS && s.lastFailureOffset == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(percentiles_are_at_most_twice_too_large),
        cmocka_unit_test(equal_latencies_are_told_exactly),
        cmocka_unit_test(attempts_and_ends_are_counted_by_their_results),
        cmocka_unit_test(nothing_is_all_zeros),
    };
    return RUN_TESTS(tests);
}
