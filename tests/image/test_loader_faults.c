/* Sources that fail, stall and come back: what the loader makes of them, and what it counts. */
#define _POSIX_C_SOURCE 200809L

#include <sluice/loader.h>

#include "support/failing_allocator.h"
#include "support/fault_source.h"
#include "support/test.h"

#include <sched.h>
#include <string.h>

enum { SIZE = 64, MAX_FAILURES = 16, NEVER_NS_SHIFT = 62 };

static void mark(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                 uint32_t height, float rgba[4])
{
    (void)user;
    (void)height;
    rgba[0] = (float)(level * 100000 + y * width + x);
    rgba[1] = rgba[2] = rgba[3] = 0;
}

struct fixture {
    SluiceImageSource *inner;
    struct fault_source source;
    SluiceTileLoader *loader;
    pthread_mutex_t mutex; ///< around what follows
    uint32_t failure_count;
    SluiceTileReadFailure failures[MAX_FAILURES];
    bool cancels;
    uint64_t ticket; ///< what is cancelled then
};

static void on_failure(void *user, const SluiceTileReadFailure *failure)
{
    struct fixture *f = user;
    pthread_mutex_lock(&f->mutex);
    if (f->failure_count < MAX_FAILURES)
        f->failures[f->failure_count] = *failure;
    f->failure_count++;
    if (f->cancels)
        sluiceCancelTileRead(f->loader, f->ticket);
    pthread_mutex_unlock(&f->mutex);
}

/* One thread and delays that are no delays, unless the test says otherwise. */
static void setup(struct fixture *f, SluiceTileLoaderCreateInfo create)
{
    SluiceProceduralImage image = {NULL, mark};
    SluiceImageInfo info = {SIZE, SIZE, 0, SLUICE_FORMAT_R32_SFLOAT, "fault test"};
    *f = (struct fixture){0};
    pthread_mutex_init(&f->mutex, NULL);
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &f->inner));
    fault_source_init(&f->source, f->inner);
    create.threadCount = create.threadCount ? create.threadCount : 1;
    create.retry.firstDelay = create.retry.firstDelay ? create.retry.firstDelay : 1;
    create.failure = (SluiceTileReadFailureCallback){f, on_failure};
    CHECK_OK(sluiceCreateTileLoader(&create, &f->loader));
}

static void teardown(struct fixture *f)
{
    sluiceDestroyTileLoader(f->loader);
    fault_source_finish(&f->source);
    sluiceDestroyImageSource(f->inner);
    pthread_mutex_destroy(&f->mutex);
}

static uint64_t submit(struct fixture *f, struct fault_source *source, uint32_t x, float *texel,
                       uint32_t priority)
{
    SluiceImageRegion region = {0, x, 0, 1, 1};
    void *texels = texel;
    uint64_t ticket = 0;
    SluiceTileRead read = {&source->base, 1, &region, &texels, priority, x};
    CHECK_OK(sluiceSubmitTileRead(f->loader, &read, &ticket));
    return ticket;
}

static SluiceTileReadResult collect_one(struct fixture *f)
{
    SluiceTileReadResult result;
    for (uint32_t count = 0; count == 0;) {
        count = 1;
        assert_true(sluiceCollectTileReads(f->loader, &count, &result) >= 0);
        if (count == 0)
            sched_yield();
    }
    return result;
}

static SluiceTileLoaderStatistics statistics(struct fixture *f, const struct fault_source *source)
{
    SluiceTileLoaderStatistics s;
    CHECK_OK(sluiceGetTileLoaderStatistics(f->loader, source ? &source->base : NULL, &s));
    return s;
}

/* A read of a source that answers by the script, then always with `later`. */
struct story {
    SluiceResult script[6];
    SluiceResult later;
    SluiceResult result;
    uint32_t attempts, failed, not_ready, reported;
};

static void check_story(const struct story *story)
{
    struct fixture f;
    float texel = -1;
    uint32_t length = 0;
    setup(&f, (SluiceTileLoaderCreateInfo){0});
    while (length < 6 && story->script[length] != SLUICE_SUCCESS)
        length++;
    f.source.script = story->script;
    f.source.script_length = length;
    f.source.fail_at = story->later == SLUICE_SUCCESS ? 0 : 1;
    f.source.fails_on = true;
    f.source.failure = story->later;
    submit(&f, &f.source, 7, &texel, 0);
    SluiceTileReadResult result = collect_one(&f);
    CHECK_RESULT(result.result, story->result);
    bool succeeded = story->result == SLUICE_SUCCESS;
    assert_int_equal(result.size, succeeded ? 4 : 0);
    if (succeeded)
        assert_true(texel == 7);
    for (int of_all = 0; of_all < 2; of_all++) {
        SluiceTileLoaderStatistics s = statistics(&f, of_all ? NULL : &f.source);
        assert_int_equal(s.readCount, 1);
        assert_int_equal(s.attemptCount, story->attempts);
        assert_int_equal(s.failedCount, story->failed);
        assert_int_equal(s.notReadyCount, story->not_ready);
        assert_int_equal(s.retriedCount, story->attempts - 1);
        assert_int_equal(s.succeededCount, succeeded);
        assert_int_equal(s.givenUpCount, !succeeded);
        assert_int_equal(s.byteCount, succeeded ? 4 : 0);
        assert_true(s.delayedCount == 0 && s.cancelledCount == 0);
        assert_true(s.meanLatency <= s.maxLatency && s.medianLatency <= s.latency99 &&
                    s.latency99 <= s.maxLatency);
    }
    assert_int_equal(f.source.read_count, story->attempts);
    assert_int_equal(f.failure_count, story->reported);
    teardown(&f);
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
        {{IO, GONE}, OK, GONE, 2, 2, 0, 2}, /* vanished meanwhile */
        {{UNKNOWN}, OK, UNKNOWN, 1, 1, 0, 1},
    };
    for (size_t i = 0; i < sizeof stories / sizeof stories[0]; i++)
        check_story(&stories[i]);
}

static void failures_are_reported_with_source_region_and_what_follows(void **state)
{
    (void)state;
    struct fixture f;
    float texel;
    setup(&f, (SluiceTileLoaderCreateInfo){.retry = {3, 5, 8}});
    f.source.fail_at = 1;
    f.source.fails_on = true;
    f.source.failure = SLUICE_ERROR_IO;
    submit(&f, &f.source, 9, &texel, 0);
    CHECK_RESULT(collect_one(&f).result, SLUICE_ERROR_IO);
    assert_int_equal(f.failure_count, 3);
    static const uint64_t delays[3] = {5, 8, 0};
    for (uint32_t i = 0; i < 3; i++) {
        const SluiceTileReadFailure *failure = &f.failures[i];
        assert_ptr_equal(failure->source, &f.source.base);
        assert_string_equal(failure->pName, "fault test"); /* the source lives still */
        assert_true(failure->region.x == 9 && failure->region.width == 1);
        CHECK_RESULT(failure->result, SLUICE_ERROR_IO);
        assert_int_equal(failure->attempt, i + 1);
        assert_int_equal(failure->willRetry, i < 2);
        assert_int_equal(failure->retryDelay, delays[i]);
        assert_int_equal(failure->userValue, 9);
    }
    teardown(&f);
}

static void a_source_that_cannot_be_opened_at_first_is_tried_again(void **state)
{
    (void)state;
    struct fixture f;
    float texel = -1;
    setup(&f, (SluiceTileLoaderCreateInfo){0});
    f.source.unopened = 2;
    f.source.failure = SLUICE_ERROR_IO;
    submit(&f, &f.source, 3, &texel, 0);
    CHECK_OK(collect_one(&f).result);
    assert_true(texel == 3);
    assert_int_equal(f.failure_count, 2);
    assert_string_equal(f.failures[0].pName, "");
    assert_int_equal(statistics(&f, &f.source).attemptCount, 3);
    teardown(&f);
}

/* What was delivered is not read again; what was cut short is. */
static void another_attempt_goes_on_with_the_region_that_failed(void **state)
{
    (void)state;
    static const SluiceResult script[] = {SLUICE_SUCCESS, SLUICE_ERROR_IO, SLUICE_SUCCESS,
                                          SLUICE_ERROR_CORRUPT_DATA};
    struct fixture f;
    static float texels[3][16];
    SluiceImageRegion regions[3] = {{0, 0, 0, 4, 4}, {1, 4, 4, 4, 4}, {2, 8, 8, 4, 4}};
    void *const places[3] = {texels[0], texels[1], texels[2]};
    uint64_t ticket;
    setup(&f, (SluiceTileLoaderCreateInfo){0});
    f.source.script = script;
    f.source.script_length = 4;
    f.source.is_short = true;
    SluiceTileRead read = {&f.source.base, 3, regions, places, 0, 0};
    CHECK_OK(sluiceSubmitTileRead(f.loader, &read, &ticket));
    SluiceTileReadResult result = collect_one(&f);
    CHECK_OK(result.result);
    assert_int_equal(result.size, 3 * 16 * 4);
    assert_int_equal(f.source.read_count, 5);
    assert_int_equal(f.failures[0].region.mipLevel, 1);
    assert_int_equal(f.failures[1].region.mipLevel, 2);
    for (uint32_t r = 0; r < 3; r++)
        for (uint32_t i = 0; i < 16; i++)
            assert_true(texels[r][i] ==
                        (float)(r * 100000 + (4 * r + i / 4) * (SIZE >> r) + 4 * r + i % 4));
    teardown(&f);
}

static void a_stalled_source_keeps_only_its_share_of_the_threads(void **state)
{
    (void)state;
    enum { COUNT = 20 };
    struct fixture f;
    struct fault_source other;
    float stalled[COUNT], texels[COUNT];
    setup(&f, (SluiceTileLoaderCreateInfo){.threadCount = 3}); /* two for a source */
    fault_source_init(&other, f.inner);
    f.source.holds = true;
    for (uint32_t i = 0; i < COUNT; i++)
        submit(&f, &f.source, i, &stalled[i], 9); /* also more urgent */
    fault_source_await(&f.source, 2);
    for (uint32_t i = 0; i < COUNT; i++)
        submit(&f, &other, i, &texels[i], 0);
    for (uint32_t i = 0; i < COUNT; i++) {
        SluiceTileReadResult result = collect_one(&f);
        CHECK_OK(result.result);
        assert_int_equal(result.userValue, i);
        assert_true(texels[i] == (float)i);
    }
    assert_int_equal(f.source.read_count, 2);
    assert_int_equal(statistics(&f, &f.source).readCount, COUNT);
    assert_int_equal(statistics(&f, &f.source).attemptCount, 0);
    fault_source_release(&f.source);
    for (uint32_t i = 0; i < COUNT; i++)
        CHECK_OK(collect_one(&f).result);
    assert_int_equal(f.source.most_running, 2);
    teardown(&f);
    fault_source_finish(&other);
}

static void bytes_in_flight_are_bounded(void **state)
{
    (void)state;
    enum { COUNT = 300, ROW = 8 };
    static float texels[COUNT][ROW];
    struct fixture f;
    setup(&f, (SluiceTileLoaderCreateInfo){
                  .threadCount = 4, .maxReadsPerSource = 4, .maxBytesInFlight = 2 * ROW * 4 + 1});
    for (uint32_t i = 0; i < COUNT; i++) {
        SluiceImageRegion region = {0, 0, i % SIZE, ROW, 1};
        void *place = texels[i];
        uint64_t ticket;
        SluiceTileRead read = {&f.source.base, 1, &region, &place, 0, i};
        CHECK_OK(sluiceSubmitTileRead(f.loader, &read, &ticket));
    }
    sluiceWaitTileLoaderIdle(f.loader);
    assert_true(f.source.most_running >= 1 && f.source.most_running <= 2);
    for (uint32_t i = 0; i < COUNT; i++)
        CHECK_OK(collect_one(&f).result);
    assert_int_equal(statistics(&f, NULL).byteCount, COUNT * ROW * 4);
    teardown(&f);
}

/* A read that is larger than the bound is not refused: it waits until it is alone. */
static void a_read_beyond_the_bound_is_made_alone(void **state)
{
    (void)state;
    enum { COUNT = 50 };
    static float texels[COUNT][SIZE];
    struct fixture f;
    setup(&f, (SluiceTileLoaderCreateInfo){
                  .threadCount = 3, .maxReadsPerSource = 3, .maxBytesInFlight = 1});
    for (uint32_t i = 0; i < COUNT; i++) {
        SluiceImageRegion region = {0, 0, i, SIZE, 1};
        void *place = texels[i];
        uint64_t ticket;
        SluiceTileRead read = {&f.source.base, 1, &region, &place, 0, i};
        CHECK_OK(sluiceSubmitTileRead(f.loader, &read, &ticket));
    }
    sluiceWaitTileLoaderIdle(f.loader);
    assert_int_equal(f.source.most_running, 1);
    for (uint32_t i = 0; i < COUNT; i++)
        assert_true(texels[i][5] == (float)(i * SIZE + 5));
    teardown(&f);
}

static void wait_until_delayed(struct fixture *f, uint64_t count)
{
    while (statistics(f, &f->source).delayedCount < count)
        sched_yield();
}

static void a_read_that_waits_for_another_attempt_can_be_cancelled(void **state)
{
    (void)state;
    struct fixture f;
    float texels[2] = {-1, -1};
    uint64_t never = (uint64_t)1 << NEVER_NS_SHIFT;
    setup(&f, (SluiceTileLoaderCreateInfo){.retry = {4, never, never}});
    f.source.fail_at = 1;
    f.source.failure = SLUICE_ERROR_IO;
    uint64_t ticket = submit(&f, &f.source, 1, &texels[0], 0);
    wait_until_delayed(&f, 1);
    submit(&f, &f.source, 2, &texels[1], 0); /* others are not held up */
    CHECK_OK(collect_one(&f).result);
    sluiceCancelTileRead(f.loader, ticket);
    SluiceTileReadResult result = collect_one(&f);
    assert_int_equal(result.ticket, ticket);
    CHECK_RESULT(result.result, SLUICE_ERROR_CANCELLED);
    sluiceWaitTileLoaderIdle(f.loader);
    assert_int_equal(f.source.read_count, 2);
    SluiceTileLoaderStatistics s = statistics(&f, &f.source);
    assert_true(s.cancelledCount == 1 && s.delayedCount == 0 && s.retriedCount == 1);
    assert_true(s.givenUpCount == 0 && s.succeededCount == 1);
    teardown(&f);
}

static void a_read_that_is_cancelled_while_it_fails_is_not_tried_again(void **state)
{
    (void)state;
    struct fixture f;
    float texel;
    setup(&f, (SluiceTileLoaderCreateInfo){0});
    f.source.fail_at = 1;
    f.source.fails_on = true;
    f.source.failure = SLUICE_ERROR_IO;
    f.source.holds = true;
    f.cancels = true;
    pthread_mutex_lock(&f.mutex);
    f.ticket = submit(&f, &f.source, 1, &texel, 0);
    pthread_mutex_unlock(&f.mutex);
    fault_source_release(&f.source);
    CHECK_RESULT(collect_one(&f).result, SLUICE_ERROR_CANCELLED);
    assert_int_equal(f.source.read_count, 1);
    SluiceTileLoaderStatistics s = statistics(&f, NULL);
    assert_true(s.failedCount == 1 && s.retriedCount == 0 && s.cancelledCount == 1);
    teardown(&f);
}

static void destroying_does_not_wait_for_other_attempts(void **state)
{
    (void)state;
    enum { COUNT = 5 };
    struct fixture f;
    float texels[COUNT];
    uint64_t never = (uint64_t)1 << NEVER_NS_SHIFT;
    setup(&f, (SluiceTileLoaderCreateInfo){.threadCount = 2, .retry = {4, never, never}});
    f.source.fail_at = 1;
    f.source.fails_on = true;
    f.source.failure = SLUICE_ERROR_IO;
    for (uint32_t i = 0; i < COUNT; i++)
        submit(&f, &f.source, i, &texels[i], 0);
    wait_until_delayed(&f, COUNT);
    struct fault_source *source = &f.source;
    teardown(&f); /* in less than a century */
    assert_int_equal(source->read_count, COUNT);
}

/* Four sources, each failing at every fifth read, and more reads than slots. */
static void many_reads_of_failing_sources_all_end_and_are_counted(void **state)
{
    (void)state;
    enum { SOURCES = 4, PER_SOURCE = 250 };
    static SluiceResult script[4 * PER_SOURCE];
    static float texels[SOURCES][PER_SOURCE];
    struct fixture f;
    struct fault_source sources[SOURCES];
    setup(&f, (SluiceTileLoaderCreateInfo){
                  .threadCount = 4, .requestCapacity = 64, .retry = {.maxAttempts = 50}});
    for (uint32_t i = 0; i < 4 * PER_SOURCE; i++)
        script[i] = i % 5 == 4 ? SLUICE_ERROR_IO : SLUICE_SUCCESS;
    for (uint32_t s = 0; s < SOURCES; s++) {
        fault_source_init(&sources[s], f.inner);
        sources[s].script = script;
        sources[s].script_length = 4 * PER_SOURCE;
    }
    uint32_t ended = 0;
    for (uint32_t i = 0; i < SOURCES * PER_SOURCE; i++) {
        SluiceImageRegion region = {0, i / SOURCES % SIZE, 0, 1, 1};
        void *place = &texels[i % SOURCES][i / SOURCES];
        uint64_t ticket;
        SluiceTileRead read = {&sources[i % SOURCES].base, 1, &region, &place, i % 3, i};
        for (; sluiceSubmitTileRead(f.loader, &read, &ticket) == SLUICE_NOT_READY; ended++)
            CHECK_OK(collect_one(&f).result);
    }
    for (; ended < SOURCES * PER_SOURCE; ended++)
        CHECK_OK(collect_one(&f).result);
    uint64_t attempts = 0;
    for (uint32_t s = 0; s < SOURCES; s++) {
        SluiceTileLoaderStatistics counts = statistics(&f, &sources[s]);
        /* every fifth attempt fails: n attempts have n - n / 5 successes */
        assert_int_equal(counts.attemptCount - counts.attemptCount / 5, PER_SOURCE);
        assert_int_equal(counts.attemptCount, sources[s].read_count);
        assert_int_equal(counts.failedCount, counts.attemptCount / 5);
        assert_int_equal(counts.retriedCount, counts.failedCount);
        assert_int_equal(counts.succeededCount, PER_SOURCE);
        assert_true(sources[s].most_running <= 3);
        attempts += counts.attemptCount;
        for (uint32_t i = 0; i < PER_SOURCE; i++)
            assert_true(texels[s][i] == (float)(i % SIZE));
        CHECK_OK(sluiceForgetTileLoaderSource(f.loader, &sources[s].base));
        assert_int_equal(statistics(&f, &sources[s]).readCount, 0);
    }
    assert_int_equal(statistics(&f, NULL).attemptCount, attempts);
    teardown(&f);
    for (uint32_t s = 0; s < SOURCES; s++)
        fault_source_finish(&sources[s]);
}

static void a_source_with_reads_is_not_forgotten(void **state)
{
    (void)state;
    struct fixture f;
    float texel;
    setup(&f, (SluiceTileLoaderCreateInfo){0});
    submit(&f, &f.source, 0, &texel, 0);
    sluiceWaitTileLoaderIdle(f.loader);
    CHECK_RESULT(sluiceForgetTileLoaderSource(f.loader, &f.source.base), SLUICE_NOT_READY);
    assert_int_equal(statistics(&f, &f.source).readCount, 1);
    CHECK_OK(collect_one(&f).result);
    CHECK_OK(sluiceForgetTileLoaderSource(f.loader, &f.source.base));
    CHECK_OK(sluiceForgetTileLoaderSource(f.loader, &f.source.base));
    teardown(&f);
}

/* Out of memory is an answer of creation alone: reading goes on where nothing is left. */
static void reads_need_no_memory(void **state)
{
    (void)state;
    enum { COUNT = 40 };
    struct fixture f;
    struct failing_allocator a;
    struct fault_source sources[COUNT];
    float texel;
    failing_allocator_init(&a, UINT64_MAX);
    setup(&f, (SluiceTileLoaderCreateInfo){.requestCapacity = 4, .pAllocator = &a.callbacks});
    a.refuse_from = a.calls;
    for (uint32_t i = 0; i < COUNT; i++) {
        fault_source_init(&sources[i], f.inner);
        submit(&f, &sources[i], i, &texel, 0);
        CHECK_OK(collect_one(&f).result);
        assert_true(texel == (float)i);
    }
    assert_int_equal(a.calls, a.refuse_from);
    teardown(&f);
    assert_int_equal(a.live_bytes, 0);
    for (uint32_t i = 0; i < COUNT; i++)
        fault_source_finish(&sources[i]);
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    struct fixture f;
    SluiceTileLoaderStatistics s;
    SluiceTileLoader *loader = NULL;
    SluiceTileLoaderCreateInfo many_reads = {.requestCapacity = (1u << 29) + 1};
    SluiceTileLoaderCreateInfo many_sources = {.maxSourceCount = UINT32_MAX};
    CHECK_RESULT(sluiceCreateTileLoader(&many_reads, &loader), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceCreateTileLoader(&many_sources, &loader), SLUICE_ERROR_INVALID_ARGUMENT);
    setup(&f, (SluiceTileLoaderCreateInfo){0});
    CHECK_RESULT(sluiceGetTileLoaderStatistics(NULL, NULL, &s), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceGetTileLoaderStatistics(f.loader, NULL, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceForgetTileLoaderSource(NULL, &f.source.base), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceForgetTileLoaderSource(f.loader, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_OK(sluiceGetTileLoaderStatistics(f.loader, f.inner, &s));
    assert_int_equal(s.readCount, 0);
    teardown(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_failure_has_its_number_of_attempts),
        cmocka_unit_test(failures_are_reported_with_source_region_and_what_follows),
        cmocka_unit_test(a_source_that_cannot_be_opened_at_first_is_tried_again),
        cmocka_unit_test(another_attempt_goes_on_with_the_region_that_failed),
        cmocka_unit_test(a_stalled_source_keeps_only_its_share_of_the_threads),
        cmocka_unit_test(bytes_in_flight_are_bounded),
        cmocka_unit_test(a_read_beyond_the_bound_is_made_alone),
        cmocka_unit_test(a_read_that_waits_for_another_attempt_can_be_cancelled),
        cmocka_unit_test(a_read_that_is_cancelled_while_it_fails_is_not_tried_again),
        cmocka_unit_test(destroying_does_not_wait_for_other_attempts),
        cmocka_unit_test(many_reads_of_failing_sources_all_end_and_are_counted),
        cmocka_unit_test(a_source_with_reads_is_not_forgotten),
        cmocka_unit_test(reads_need_no_memory),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return RUN_TESTS(tests);
}
