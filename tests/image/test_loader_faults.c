/* Sources that fail and recover: results and counts of the loader. */
#define _POSIX_C_SOURCE 200809L

#include <sluice/loader.h>

#include "image/loader_fixture.h"
#include "support/failing_allocator.h"
#include "support/test.h"

/* A read whose source answers by the script, then always with `later`. */
struct story {
    SluiceResult script[6];
    SluiceResult later;
    SluiceResult result;
    uint32_t attempts, failed, not_ready, reported;
};

static void check_story(const struct story *story)
{
    struct loader_fixture f;
    float texel = -1;
    uint32_t length = 0;
    fixture_init(&f,
                 (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo)});
    while (length < 6 && story->script[length] != SLUICE_SUCCESS)
        length++;
    f.source.script = story->script;
    f.source.script_length = length;
    f.source.fail_at = story->later == SLUICE_SUCCESS ? 0 : 1;
    f.source.fails_on = true;
    f.source.failure = story->later;
    fixture_submit(&f, &f.source, 7, &texel, 0);
    SluiceTileReadResult result = fixture_collect(&f);
    CHECK_RESULT(result.result, story->result);
    bool succeeded = story->result == SLUICE_SUCCESS;
    assert_int_equal(result.size, succeeded ? 4 : 0);
    if (succeeded)
        assert_true(texel == 7);
    for (int of_all = 0; of_all < 2; of_all++) {
        SluiceTileLoaderStatistics s = fixture_statistics(&f, of_all ? NULL : &f.source);
        assert_int_equal(s.readCount, 1);
        assert_int_equal(s.attemptCount, story->attempts);
        assert_int_equal(s.failedCount, story->failed);
        assert_int_equal(s.notReadyCount, story->not_ready);
        assert_int_equal(s.retriedCount, story->attempts - 1);
        assert_int_equal(s.succeededCount, succeeded);
        assert_int_equal(s.givenUpCount, !succeeded);
        assert_int_equal(s.byteCount, succeeded ? 4 : 0);
        assert_true(s.delayedCount == 0 && s.canceledCount == 0);
        assert_true(s.meanLatencyNs <= s.maxLatencyNs && s.medianLatencyNs <= s.latency99Ns &&
                    s.latency99Ns <= s.maxLatencyNs);
    }
    assert_int_equal(f.source.read_count, story->attempts);
    assert_int_equal(f.failure_count, story->reported);
    fixture_finish(&f);
}

static void every_kind_of_failure_has_its_number_of_attempts(void **state)
{
    (void)state;
    enum { OK = SLUICE_SUCCESS, IO = SLUICE_ERROR_IO, LATER = SLUICE_NOT_READY };
    enum { TORN = SLUICE_ERROR_CORRUPT_DATA, GONE = SLUICE_ERROR_FILE_NOT_FOUND };
    enum { MEMORY = SLUICE_ERROR_OUT_OF_HOST_MEMORY, UNKNOWN = SLUICE_ERROR_UNSUPPORTED };
    static const struct story stories[] = {
        {{OK}, OK, OK, 1, 0, 0, 0},
        {{IO}, OK, OK, 2, 1, 0, 1},
        {{IO, IO, IO}, OK, OK, 4, 3, 0, 3},
        {{IO, IO, IO, IO}, OK, IO, 4, 4, 0, 4},
        {{OK}, IO, IO, 4, 4, 0, 4},
        {{MEMORY, IO, LATER}, OK, OK, 4, 2, 1, 2},
        {{LATER, LATER}, OK, OK, 3, 0, 2, 0},
        {{LATER, LATER, LATER, LATER}, OK, LATER, 4, 0, 4, 1}, /* never ready: asked no more */
        {{TORN}, OK, OK, 2, 1, 0, 1},
        {{TORN, TORN}, OK, TORN, 2, 2, 0, 2},
        {{IO, TORN}, OK, OK, 3, 2, 0, 2},
        {{TORN, IO, TORN}, OK, TORN, 3, 3, 0, 3},
        {{GONE}, OK, GONE, 1, 1, 0, 1},
        {{IO, GONE}, OK, GONE, 2, 2, 0, 2}, /* disappeared meanwhile */
        {{UNKNOWN}, OK, UNKNOWN, 1, 1, 0, 1},
    };
    for (size_t i = 0; i < sizeof stories / sizeof stories[0]; i++)
        check_story(&stories[i]);
}

static void failures_are_reported_with_source_region_and_what_follows(void **state)
{
    (void)state;
    struct loader_fixture f;
    float texel;
    fixture_init(&f, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                                  .retry = {3, 5, 8}});
    f.source.fail_at = 1;
    f.source.fails_on = true;
    f.source.failure = SLUICE_ERROR_IO;
    fixture_submit(&f, &f.source, 9, &texel, 0);
    CHECK_RESULT(fixture_collect(&f).result, SLUICE_ERROR_IO);
    assert_int_equal(f.failure_count, 3);
    static const uint64_t delays[3] = {5, 8, 0};
    for (uint32_t i = 0; i < 3; i++) {
        const SluiceTileReadFailure *failure = &f.failures[i];
        assert_ptr_equal(failure->source, &f.source.base);
        assert_string_equal(failure->pName, "fault test"); /* the source still exists */
        assert_true(failure->region.x == 9 && failure->region.width == 1);
        CHECK_RESULT(failure->result, SLUICE_ERROR_IO);
        assert_int_equal(failure->attempt, i + 1);
        assert_int_equal(failure->willRetry, i < 2);
        assert_int_equal(failure->retryDelayNs, delays[i]);
        assert_int_equal(failure->userValue, 9);
        assert_true(failure->offset == SLUICE_UNKNOWN_OFFSET); /* not a file */
    }
    SluiceTileLoaderStatistics s = fixture_statistics(&f, &f.source);
    CHECK_RESULT(s.lastFailure, SLUICE_ERROR_IO);
    assert_true(s.lastFailureOffset == SLUICE_UNKNOWN_OFFSET);
    fixture_finish(&f);
}

static void a_source_that_cannot_be_opened_at_first_is_tried_again(void **state)
{
    (void)state;
    struct loader_fixture f;
    float texel = -1;
    fixture_init(&f,
                 (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo)});
    f.source.unopened = 2;
    f.source.failure = SLUICE_ERROR_IO;
    fixture_submit(&f, &f.source, 3, &texel, 0);
    CHECK_OK(fixture_collect(&f).result);
    assert_true(texel == 3);
    assert_int_equal(f.failure_count, 2);
    assert_string_equal(f.failures[0].pName, "");
    assert_int_equal(fixture_statistics(&f, &f.source).attemptCount, 3);
    fixture_finish(&f);
}

/* Delivered regions are not read again; interrupted ones are. */
static void another_attempt_goes_on_with_the_region_that_failed(void **state)
{
    (void)state;
    static const SluiceResult script[] = {SLUICE_SUCCESS, SLUICE_ERROR_IO, SLUICE_SUCCESS,
                                          SLUICE_ERROR_CORRUPT_DATA};
    struct loader_fixture f;
    static float texels[3][16];
    SluiceImageRegion regions[3] = {{0, 0, 0, 4, 4}, {1, 4, 4, 4, 4}, {2, 8, 8, 4, 4}};
    void *const places[3] = {texels[0], texels[1], texels[2]};
    uint64_t ticket;
    fixture_init(&f,
                 (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo)});
    f.source.script = script;
    f.source.script_length = 4;
    f.source.is_short = true;
    SluiceTileRead read = {&f.source.base, 3, regions, places, 0, 0};
    CHECK_OK(sluiceSubmitTileRead(f.loader, &read, &ticket));
    SluiceTileReadResult result = fixture_collect(&f);
    CHECK_OK(result.result);
    assert_int_equal(result.size, 3 * 16 * 4);
    assert_int_equal(f.source.read_count, 5);
    assert_int_equal(f.failures[0].region.mipLevel, 1);
    assert_int_equal(f.failures[1].region.mipLevel, 2);
    for (uint32_t r = 0; r < 3; r++)
        for (uint32_t i = 0; i < 16; i++)
            assert_true(texels[r][i] == (float)(r * 100000 + (4 * r + i / 4) * (FIXTURE_SIZE >> r) +
                                                4 * r + i % 4));
    fixture_finish(&f);
}

/* Four sources fail at every fifth read, with more reads than slots. */
static void many_reads_of_failing_sources_all_end_and_are_counted(void **state)
{
    (void)state;
    enum { SOURCES = 4, PER_SOURCE = 250 };
    static SluiceResult script[4 * PER_SOURCE];
    static float texels[SOURCES][PER_SOURCE];
    struct loader_fixture f;
    struct fault_source sources[SOURCES];
    fixture_init(&f, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                                  .threadCount = 4,
                                                  .requestCapacity = 64,
                                                  .retry = {.maxAttempts = 50}});
    for (uint32_t i = 0; i < 4 * PER_SOURCE; i++)
        script[i] = i % 5 == 4 ? SLUICE_ERROR_IO : SLUICE_SUCCESS;
    for (uint32_t s = 0; s < SOURCES; s++) {
        fault_source_init(&sources[s], f.inner);
        sources[s].script = script;
        sources[s].script_length = 4 * PER_SOURCE;
    }
    uint32_t ended = 0;
    for (uint32_t i = 0; i < SOURCES * PER_SOURCE; i++) {
        SluiceImageRegion region = {0, i / SOURCES % FIXTURE_SIZE, 0, 1, 1};
        void *place = &texels[i % SOURCES][i / SOURCES];
        uint64_t ticket;
        SluiceTileRead read = {&sources[i % SOURCES].base, 1, &region, &place, i % 3, i};
        for (; sluiceSubmitTileRead(f.loader, &read, &ticket) == SLUICE_NOT_READY; ended++)
            CHECK_OK(fixture_collect(&f).result);
    }
    for (; ended < SOURCES * PER_SOURCE; ended++)
        CHECK_OK(fixture_collect(&f).result);
    uint64_t attempts = 0;
    for (uint32_t s = 0; s < SOURCES; s++) {
        SluiceTileLoaderStatistics counts = fixture_statistics(&f, &sources[s]);
        /* every fifth attempt fails: n attempts have n - n / 5 successes */
        assert_int_equal(counts.attemptCount - counts.attemptCount / 5, PER_SOURCE);
        assert_int_equal(counts.attemptCount, sources[s].read_count);
        assert_int_equal(counts.failedCount, counts.attemptCount / 5);
        assert_int_equal(counts.retriedCount, counts.failedCount);
        assert_int_equal(counts.succeededCount, PER_SOURCE);
        assert_true(sources[s].most_running <= 3);
        attempts += counts.attemptCount;
        for (uint32_t i = 0; i < PER_SOURCE; i++)
            assert_true(texels[s][i] == (float)(i % FIXTURE_SIZE));
        CHECK_OK(sluiceDropTileLoaderStatistics(f.loader, &sources[s].base));
        assert_int_equal(fixture_statistics(&f, &sources[s]).readCount, 0);
    }
    assert_int_equal(fixture_statistics(&f, NULL).attemptCount, attempts);
    fixture_finish(&f);
    for (uint32_t s = 0; s < SOURCES; s++)
        fault_source_finish(&sources[s]);
}

static void a_source_with_reads_is_not_forgotten(void **state)
{
    (void)state;
    struct loader_fixture f;
    float texel;
    fixture_init(&f,
                 (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo)});
    fixture_submit(&f, &f.source, 0, &texel, 0);
    sluiceWaitTileLoaderIdle(f.loader);
    CHECK_RESULT(sluiceDropTileLoaderStatistics(f.loader, &f.source.base), SLUICE_NOT_READY);
    assert_int_equal(fixture_statistics(&f, &f.source).readCount, 1);
    CHECK_OK(fixture_collect(&f).result);
    CHECK_OK(sluiceDropTileLoaderStatistics(f.loader, &f.source.base));
    CHECK_OK(sluiceDropTileLoaderStatistics(f.loader, &f.source.base));
    fixture_finish(&f);
}

/* Only creation can run out of memory. Reading works without free memory. */
static void reads_need_no_memory(void **state)
{
    (void)state;
    enum { COUNT = 40 };
    struct loader_fixture f;
    struct failing_allocator a;
    struct fault_source sources[COUNT];
    float texel;
    failing_allocator_init(&a, UINT64_MAX);
    fixture_init(&f, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                                  .requestCapacity = 4,
                                                  .pAllocator = &a.callbacks});
    a.refuse_from = a.calls;
    for (uint32_t i = 0; i < COUNT; i++) {
        fault_source_init(&sources[i], f.inner);
        fixture_submit(&f, &sources[i], i, &texel, 0);
        CHECK_OK(fixture_collect(&f).result);
        assert_true(texel == (float)i);
    }
    assert_int_equal(a.calls, a.refuse_from);
    fixture_finish(&f);
    assert_int_equal(a.live_bytes, 0);
    for (uint32_t i = 0; i < COUNT; i++)
        fault_source_finish(&sources[i]);
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    struct loader_fixture f;
    SluiceTileLoaderStatistics s = {.structSize = sizeof s};
    SluiceTileLoader *loader = NULL;
    SluiceTileLoaderCreateInfo many_reads = {.structSize = sizeof many_reads,
                                             .requestCapacity = (1u << 29) + 1};
    SluiceTileLoaderCreateInfo many_sources = {.structSize = sizeof many_sources,
                                               .maxSourceCount = UINT32_MAX};
    CHECK_RESULT(sluiceCreateTileLoader(&many_reads, &loader), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceCreateTileLoader(&many_sources, &loader), SLUICE_ERROR_INVALID_ARGUMENT);
    fixture_init(&f,
                 (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo)});
    CHECK_RESULT(sluiceGetTileLoaderStatistics(NULL, NULL, &s), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceGetTileLoaderStatistics(f.loader, NULL, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceDropTileLoaderStatistics(NULL, &f.source.base), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceDropTileLoaderStatistics(f.loader, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_OK(sluiceGetTileLoaderStatistics(f.loader, f.inner, &s));
    assert_int_equal(s.readCount, 0);
    fixture_finish(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_failure_has_its_number_of_attempts),
        cmocka_unit_test(failures_are_reported_with_source_region_and_what_follows),
        cmocka_unit_test(a_source_that_cannot_be_opened_at_first_is_tried_again),
        cmocka_unit_test(another_attempt_goes_on_with_the_region_that_failed),
        cmocka_unit_test(many_reads_of_failing_sources_all_end_and_are_counted),
        cmocka_unit_test(a_source_with_reads_is_not_forgotten),
        cmocka_unit_test(reads_need_no_memory),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return RUN_TESTS(tests);
}
