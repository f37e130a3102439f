/* Loaders that share a SluiceReadPool: each region of a source is read once for all of them. */
#define _POSIX_C_SOURCE 200809L

#include <sluice/loader.h>

#include "support/failing_allocator.h"
#include "support/fault_source.h"
#include "support/job_system.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SIZE = 64, LOADERS = 3, MOST = 256 };

/* Level 0: 64 y + x + `*user`. */
static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)width, (void)height;
    rgba[0] = (float)(10000 * level + SIZE * y + x) + *(const float *)user;
    rgba[1] = rgba[2] = rgba[3] = 0;
}

struct rig {
    SluiceReadPool *pool;
    SluiceTileLoader *loaders[LOADERS];
    SluiceImageSource *inner;
    float added; ///< to the texels of `inner`
    struct fault_source source, other;
    float texels[LOADERS][MOST];
    uint64_t tickets[LOADERS][MOST];
};

static SluiceImageSource *create_image_of(SluiceFormat format, float *added)
{
    const SluiceImageInfo info = {
        .structSize = sizeof info, .width = SIZE, .height = SIZE, .format = format};
    const SluiceProceduralImage procedural = {added, texel};
    SluiceImageSource *image;
    CHECK_OK(sluiceCreateProceduralImageSource(&procedural, &info, NULL, &image));
    return image;
}

static SluiceImageSource *create_image(float *added)
{
    return create_image_of(SLUICE_FORMAT_R32_SFLOAT, added);
}

/* Zeros: the defaults, but for one attempt. */
static void add_loader_of(struct rig *r, uint32_t i, SluiceTileLoaderCreateInfo create)
{
    create.structSize = sizeof create;
    create.requestCapacity = create.requestCapacity ? create.requestCapacity : MOST;
    create.retry.maxAttempts = create.retry.maxAttempts ? create.retry.maxAttempts : 1;
    create.retry.firstDelayNs = create.retry.maxDelayNs = 1;
    create.readPool = r->pool;
    CHECK_OK(sluiceCreateTileLoader(&create, &r->loaders[i]));
}

static void add_loader(struct rig *r, uint32_t i)
{
    add_loader_of(r, i, (SluiceTileLoaderCreateInfo){0});
}

static void init(struct rig *r, uint32_t loaders, SluiceReadPoolCreateInfo create)
{
    *r = (struct rig){.added = 0};
    r->inner = create_image(&r->added);
    fault_source_init(&r->source, r->inner);
    fault_source_init(&r->other, r->inner);
    create.structSize = sizeof create;
    CHECK_OK(sluiceCreateReadPool(&create, &r->pool));
    for (uint32_t i = 0; i < loaders; i++)
        add_loader(r, i);
}

static void finish(struct rig *r)
{
    for (uint32_t i = 0; i < LOADERS; i++)
        sluiceDestroyTileLoader(r->loaders[i]);
    sluiceDestroyReadPool(r->pool);
    fault_source_finish(&r->source);
    fault_source_finish(&r->other);
    sluiceDestroyImageSource(r->inner);
}

static SluiceReadPoolStatistics statistics_of(const struct rig *r)
{
    SluiceReadPoolStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetReadPoolStatistics(r->pool, &statistics));
    return statistics;
}

/* Texel `x`, counted row by row. */
static SluiceImageRegion region_at(uint32_t x)
{
    return (SluiceImageRegion){.x = x % SIZE, .y = x / SIZE, .width = 1, .height = 1};
}

static void submit_regions(struct rig *r, uint32_t loader, SluiceImageSource *source,
                           uint32_t first, uint32_t count, uint32_t priority)
{
    SluiceImageRegion regions[4];
    void *texels[4];
    for (uint32_t i = 0; i < count; i++) {
        regions[i] = region_at(first + i);
        texels[i] = &r->texels[loader][first + i];
        r->texels[loader][first + i] = -1;
    }
    const SluiceTileRead read = {.source = source,
                                 .regionCount = count,
                                 .pRegions = regions,
                                 .ppTexels = texels,
                                 .priority = priority,
                                 .userValue = first};
    CHECK_OK(sluiceSubmitTileRead(r->loaders[loader], &read, &r->tickets[loader][first]));
}

static void submit(struct rig *r, uint32_t loader, struct fault_source *source, uint32_t x)
{
    submit_regions(r, loader, &source->base, x, 1, 0);
}

/* Waits, and expects `count` reads with the result. */
static void expect(struct rig *r, uint32_t loader, uint32_t count, SluiceResult result)
{
    SluiceTileReadResult results[MOST];
    uint32_t found = MOST;
    CHECK_OK(sluiceWaitTileLoaderIdle(r->loaders[loader]));
    CHECK_OK(sluiceCollectTileReads(r->loaders[loader], &found, results));
    assert_int_equal(found, count);
    for (uint32_t i = 0; i < found; i++)
        CHECK_RESULT(results[i].result, result);
}

static void expect_texel(const struct rig *r, uint32_t loader, uint32_t x)
{
    assert_true(r->texels[loader][x] == (float)x + r->added);
}

/* With two threads and a read that is held: everything more urgent of the loader is put aside. */
static void settle(struct rig *r, uint32_t loader)
{
    uint64_t count = r->other.read_count;
    submit(r, loader, &r->other, MOST - 1 - (uint32_t)count); /* none twice: it would be kept */
    while (r->other.read_count == count)
        nanosleep(&(struct timespec){0, 50000}, NULL);
}

/* Loader 0 reads x and is held. Loader 1 has joined it: with both threads, a later read of another
 * source has ended. */
static void join(struct rig *r, uint32_t x)
{
    r->source.holds = true;
    submit(r, 0, &r->source, x);
    fault_source_await(&r->source, 1);
    submit_regions(r, 1, &r->source.base, x, 1, 1);
    settle(r, 1);
}

static const SluiceReadPoolCreateInfo two_threads = {.threadCount = 2, .maxReadsPerSource = 2};

static void a_region_that_is_being_read_is_joined_without_a_thread(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 2, two_threads);
    join(&r, 7);
    fault_source_release(&r.source);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    expect(&r, 1, 2, SLUICE_SUCCESS);
    expect_texel(&r, 0, 7);
    expect_texel(&r, 1, 7);
    assert_int_equal(r.source.read_count, 1);
    const SluiceReadPoolStatistics now = statistics_of(&r);
    assert_int_equal(now.memberCount, 2);
    assert_int_equal(now.readCount, 2); /* and that of the other source */
    assert_int_equal(now.readSize, 8);
    assert_int_equal(now.joinedCount, 1);
    assert_int_equal(now.cachedCount, 0);
    assert_int_equal(now.keptCount, 2);
    assert_int_equal(now.keptSize, 8);
    finish(&r);
}

static void texels_are_kept_for_loaders_that_ask_later(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 3, two_threads);
    submit(&r, 0, &r.source, 3);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    r.source.fail_at = 2; /* nobody reads it again */
    r.source.failure = SLUICE_ERROR_UNSUPPORTED;
    for (uint32_t i = 1; i < 3; i++) {
        submit(&r, i, &r.source, 3);
        expect(&r, i, 1, SLUICE_SUCCESS);
        expect_texel(&r, i, 3);
    }
    assert_int_equal(r.source.read_count, 1);
    assert_int_equal(statistics_of(&r).cachedCount, 2);
    finish(&r);
}

static void one_member_keeps_nothing(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 1, two_threads);
    submit(&r, 0, &r.source, 3);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    submit(&r, 0, &r.source, 3);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    assert_int_equal(r.source.read_count, 2);
    const SluiceReadPoolStatistics now = statistics_of(&r);
    assert_int_equal(now.readCount, 2);
    assert_int_equal(now.keptPeakSize, 0);
    finish(&r);
}

/* Loader 0 has read texel 3, and reads texel 10 until the end. One thread is free. */
static void kept_texels_do_not_wait_for_reads_that_stall(void **state)
{
    (void)state;
    static const SluiceReadPoolCreateInfo limits[] = {
        {.threadCount = 2, .maxReadsPerSource = 1},
        {.threadCount = 2, .maxReadsPerSource = 2, .maxBytesInFlight = sizeof(float)}};
    for (uint32_t i = 0; i < sizeof limits / sizeof limits[0]; i++) {
        struct rig r;
        SluiceTileReadResult result;
        uint32_t count = 0;
        init(&r, 2, limits[i]);
        submit(&r, 0, &r.source, 3);
        expect(&r, 0, 1, SLUICE_SUCCESS);
        r.source.holds = true;
        submit(&r, 0, &r.source, 10);
        fault_source_await(&r.source, 1);
        submit_regions(&r, 1, &r.source.base, 4, 1, 1); /* more urgent, but not kept */
        submit(&r, 1, &r.source, 3);
        for (uint32_t ms = 0; ms < 5000 && count == 0; ms++) {
            nanosleep(&(struct timespec){0, 1000000}, NULL);
            count = 1;
            CHECK_OK(sluiceCollectTileReads(r.loaders[1], &count, &result));
        }
        assert_int_equal(count, 1);
        assert_int_equal(result.userValue, 3);
        CHECK_OK(result.result);
        expect_texel(&r, 1, 3);
        assert_int_equal(r.source.read_count, 2);
        fault_source_release(&r.source);
        expect(&r, 1, 1, SLUICE_SUCCESS);
        finish(&r);
    }
}

/* The texels were kept when loader 1 asked for them, while the one thread reads something else. */
static void texels_that_are_dropped_before_their_copy_are_read(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 2, (SluiceReadPoolCreateInfo){.threadCount = 1});
    submit(&r, 0, &r.source, 3);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    r.other.holds = true;
    submit(&r, 0, &r.other, 8);
    fault_source_await(&r.other, 1);
    submit(&r, 1, &r.source, 3);
    CHECK_OK(sluiceDropTileLoaderStatistics(r.loaders[0], &r.source.base));
    r.added = 0.5f;
    fault_source_release(&r.other);
    expect(&r, 1, 1, SLUICE_SUCCESS);
    expect_texel(&r, 1, 3);
    assert_int_equal(r.source.read_count, 2);
    finish(&r);
}

/* Room for two texels of four bytes. */
static void the_least_recently_used_texels_are_evicted(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 2, (SluiceReadPoolCreateInfo){.threadCount = 1, .cacheSize = 8});
    static const uint32_t order[] = {0, 1, 0, 2, 0, 1};
    static const uint32_t reads[] = {1, 2, 2, 3, 3, 4};
    for (uint32_t i = 0; i < sizeof order / sizeof order[0]; i++) {
        submit(&r, i % 2, &r.source, order[i]);
        expect(&r, i % 2, 1, SLUICE_SUCCESS);
        expect_texel(&r, i % 2, order[i]);
        assert_int_equal(r.source.read_count, reads[i]);
        assert_true(statistics_of(&r).keptSize <= 8);
    }
    assert_int_equal(statistics_of(&r).evictedCount, 2);
    finish(&r);
}

/* A region larger than the limit does not push out the small ones; nothing of it stays. */
static void regions_above_the_limit_are_joined_and_not_kept(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 2,
         (SluiceReadPoolCreateInfo){.threadCount = 2, .maxReadsPerSource = 2, .cacheSize = 1});
    join(&r, 7);
    fault_source_release(&r.source);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    expect(&r, 1, 2, SLUICE_SUCCESS);
    expect_texel(&r, 1, 7);
    assert_int_equal(r.source.read_count, 1);
    assert_int_equal(statistics_of(&r).keptCount, 0);
    submit(&r, 1, &r.source, 7);
    expect(&r, 1, 1, SLUICE_SUCCESS);
    assert_int_equal(r.source.read_count, 2);
    finish(&r);
}

static void expect_kept(const struct rig *r, uint64_t count)
{
    const SluiceReadPoolStatistics now = statistics_of(r);
    assert_int_equal(now.keptCount, count);
    assert_int_equal(now.keptPeakSize, count * sizeof(float));
    assert_int_equal(now.evictedCount, 0);
}

static void submit_rectangle(struct rig *r, uint32_t loader, uint32_t width, uint32_t height)
{
    const SluiceImageRegion region = {.width = width, .height = height};
    void *texels = r->texels[loader];
    const SluiceTileRead read = {
        .source = &r->source.base, .regionCount = 1, .pRegions = &region, .ppTexels = &texels};
    uint64_t ticket;
    CHECK_OK(sluiceSubmitTileRead(r->loaders[loader], &read, &ticket));
}

static void regions_outside_of_the_image_evict_nothing(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 2, (SluiceReadPoolCreateInfo){.threadCount = 1, .cacheSize = 2 * sizeof(float)});
    for (uint32_t x = 0; x < 2; x++)
        submit(&r, 0, &r.source, x);
    expect(&r, 0, 2, SLUICE_SUCCESS);
    submit_rectangle(&r, 0, 1, SIZE + 1);
    expect(&r, 0, 1, SLUICE_ERROR_INVALID_ARGUMENT);
    submit_rectangle(&r, 0, 1u << 20, 1);
    expect(&r, 0, 1, SLUICE_ERROR_INVALID_ARGUMENT);
    expect_kept(&r, 2);
    finish(&r);
}

static void regions_without_memory_evict_nothing(void **state)
{
    (void)state;
    struct failing_allocator a;
    struct rig r;
    failing_allocator_init(&a, UINT64_MAX);
    init(&r, 2,
         (SluiceReadPoolCreateInfo){
             .threadCount = 1, .pAllocator = &a.callbacks, .cacheSize = 2 * sizeof(float)});
    for (uint32_t x = 0; x < 2; x++)
        submit(&r, 0, &r.source, x);
    expect(&r, 0, 2, SLUICE_SUCCESS);
    a.refuse_from = a.calls;
    submit_rectangle(&r, 0, 2, 1);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    expect_texel(&r, 0, 1);
    expect_kept(&r, 2);
    assert_int_equal(statistics_of(&r).refusedCount, 1);
    finish(&r);
}

/* A pool has at most maxBytesInFlight beyond its cache. */
static void regions_above_the_bytes_in_flight_are_read_alone(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 2, (SluiceReadPoolCreateInfo){.threadCount = 1, .maxBytesInFlight = sizeof(float)});
    for (uint32_t i = 0; i < 2; i++) {
        submit_rectangle(&r, i, 2, 1);
        expect(&r, i, 1, SLUICE_SUCCESS);
        expect_texel(&r, i, 1);
    }
    assert_int_equal(r.source.read_count, 2);
    expect_kept(&r, 0);
    finish(&r);
}

static void canceling_the_reader_does_not_cancel_those_who_joined(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 2, two_threads);
    join(&r, 7);
    CHECK_OK(sluiceCancelTileRead(r.loaders[0], r.tickets[0][7]));
    fault_source_release(&r.source);
    expect(&r, 1, 2, SLUICE_SUCCESS);
    expect_texel(&r, 1, 7);
    assert_int_equal(r.source.read_count, 1);
    finish(&r);
}

static void canceling_a_read_that_joined_ends_it_at_once(void **state)
{
    (void)state;
    struct rig r;
    SluiceTileReadResult results[2];
    uint32_t count = 0;
    init(&r, 2, two_threads);
    join(&r, 7);
    CHECK_OK(sluiceCancelTileRead(r.loaders[1], r.tickets[1][7]));
    while (count < 2) {
        uint32_t more = 2 - count;
        CHECK_OK(sluiceCollectTileReads(r.loaders[1], &more, results + count));
        count += more;
    }
    bool first = results[0].userValue == 7;
    CHECK_RESULT(results[!first].result, SLUICE_ERROR_CANCELED);
    fault_source_release(&r.source);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    expect_texel(&r, 0, 7);
    finish(&r);
}

static void loaders_may_be_destroyed_before_their_reads_end(void **state)
{
    (void)state;
    for (uint32_t gone = 0; gone < 2; gone++) {
        struct rig r;
        init(&r, 3, two_threads);
        join(&r, 7);
        if (gone == 1) { /* at once: it waits for nothing of the other loader */
            sluiceDestroyTileLoader(r.loaders[1]);
            r.loaders[1] = NULL;
        }
        fault_source_release(&r.source);
        if (gone == 0) {
            sluiceDestroyTileLoader(r.loaders[0]);
            r.loaders[0] = NULL;
        }
        expect(&r, 1 - gone, gone ? 1 : 2, SLUICE_SUCCESS);
        expect_texel(&r, 1 - gone, 7);
        assert_int_equal(r.source.read_count, 1);
        finish(&r);
    }
}

struct failures {
    uint32_t count;
    SluiceTileReadFailure last;
};

static void note_failure(void *user, const SluiceTileReadFailure *failure)
{
    struct failures *failures = user;
    failures->count++;
    failures->last = *failure;
}

/* Loader 1 tries again. */
static void a_failure_that_was_joined_is_an_attempt_of_each_reader(void **state)
{
    (void)state;
    struct rig r;
    struct failures failures = {0};
    init(&r, 1, two_threads);
    add_loader_of(&r, 1,
                  (SluiceTileLoaderCreateInfo){.retry = {2}, .failure = {&failures, note_failure}});
    r.source.fail_at = 1;
    r.source.failure = SLUICE_ERROR_IO;
    join(&r, 7);
    fault_source_release(&r.source);
    expect(&r, 0, 1, SLUICE_ERROR_IO);
    expect(&r, 1, 2, SLUICE_SUCCESS);
    expect_texel(&r, 1, 7);
    assert_int_equal(r.source.read_count, 2);
    SluiceTileLoaderStatistics own = {.structSize = sizeof own};
    CHECK_OK(sluiceGetTileLoaderStatistics(r.loaders[1], &r.source.base, &own));
    assert_int_equal(own.attemptCount, 2);
    assert_int_equal(own.failedCount, 1);
    assert_int_equal(own.lastFailure, SLUICE_ERROR_IO);
    assert_true(own.maxLatencyNs > 0);
    assert_int_equal(failures.count, 1);
    assert_ptr_equal(failures.last.source, &r.source.base);
    assert_int_equal(failures.last.region.x, 7);
    assert_int_equal(failures.last.userValue, 7);
    assert_int_equal(failures.last.attempt, 1);
    assert_true(failures.last.willRetry);
    finish(&r);
}

static void a_failure_takes_no_longer_with_more_members(void **state)
{
    (void)state;
    struct rig r;
    init(&r, LOADERS, two_threads);
    r.source.fail_at = 1;
    r.source.fails_on = true;
    r.source.failure = SLUICE_ERROR_IO;
    join(&r, 7);
    submit_regions(&r, 2, &r.source.base, 7, 1, 1);
    settle(&r, 2);
    fault_source_release(&r.source);
    expect(&r, 0, 1, SLUICE_ERROR_IO);
    for (uint32_t i = 1; i < LOADERS; i++) {
        SluiceTileReadResult results[2];
        uint32_t count = 2;
        CHECK_OK(sluiceWaitTileLoaderIdle(r.loaders[i]));
        CHECK_OK(sluiceCollectTileReads(r.loaders[i], &count, results));
        assert_int_equal(count, 2);
        CHECK_OK(results[0].result); /* of the other source */
        CHECK_RESULT(results[1].result, SLUICE_ERROR_IO);
    }
    assert_int_equal(r.source.read_count, 1);
    finish(&r);
}

/* Loader 1 waits for x, with priority 1, and has a more urgent read. The other thread is held. */
static void reads_keep_their_priority_when_what_they_joined_fails(void **state)
{
    (void)state;
    struct rig r;
    SluiceTileReadResult results[3];
    uint32_t count = 3;
    init(&r, 1, two_threads);
    add_loader_of(&r, 1, (SluiceTileLoaderCreateInfo){.retry = {2}});
    r.source.fail_at = 1;
    r.source.failure = SLUICE_ERROR_IO;
    join(&r, 7);
    r.other.holds = true;
    submit(&r, 0, &r.other, 8);
    fault_source_await(&r.other, 1);
    submit_regions(&r, 1, &r.source.base, 9, 1, 2);
    fault_source_release(&r.source);
    CHECK_OK(sluiceWaitTileLoaderIdle(r.loaders[1]));
    CHECK_OK(sluiceCollectTileReads(r.loaders[1], &count, results));
    assert_int_equal(count, 3);
    assert_int_equal(results[1].userValue, 9); /* the first one is of the other source */
    assert_int_equal(results[2].userValue, 7);
    CHECK_OK(results[2].result);
    fault_source_release(&r.other);
    finish(&r);
}

/* Loader 1 has failed: loader 2 reads x and is held when loader 1 tries again. */
static void read_at_loader_2(void *user, const SluiceTileReadFailure *failure)
{
    struct rig *r = user;
    assert_true(failure->willRetry);
    r->source.holds = true;
    submit(r, 2, &r->source, 7);
    fault_source_await(&r->source, 1);
}

/* The texels that loader 1 waited for are of the old format. It reads itself, fails, and waits for
 * the region again. */
static void texels_of_an_old_format_are_let_go(void **state)
{
    (void)state;
    struct rig r;
    SluiceTileLoaderStatistics own = {.structSize = sizeof own};
    init(&r, 1, two_threads);
    add_loader_of(&r, 1,
                  (SluiceTileLoaderCreateInfo){.retry = {3}, .failure = {&r, read_at_loader_2}});
    add_loader(&r, 2);
    r.source.fail_at = 2;
    r.source.failure = SLUICE_ERROR_IO;
    join(&r, 7);
    r.source.inner = create_image_of(SLUICE_FORMAT_R8_UNORM, &r.added);
    fault_source_release(&r.source);
    while (own.retriedCount == 0)
        CHECK_OK(sluiceGetTileLoaderStatistics(r.loaders[1], &r.source.base, &own));
    settle(&r, 1);
    fault_source_release(&r.source);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    expect(&r, 1, 3, SLUICE_SUCCESS);
    expect(&r, 2, 1, SLUICE_SUCCESS);
    assert_int_equal(r.source.read_count, 3);
    assert_int_equal(statistics_of(&r).joinedCount, 1);
    for (uint32_t i = 0; i < LOADERS; i++) {
        sluiceDestroyTileLoader(r.loaders[i]);
        r.loaders[i] = NULL;
    }
    assert_int_equal(statistics_of(&r).keptCount, 0);
    sluiceDestroyImageSource(r.source.inner);
    finish(&r);
}

static void texels_that_changed_are_read_again(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 2, two_threads);
    submit(&r, 0, &r.source, 3);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    r.added = 0.5f;
    CHECK_OK(sluiceDropTileLoaderStatistics(r.loaders[1], &r.source.base));
    submit(&r, 1, &r.source, 3);
    expect(&r, 1, 1, SLUICE_SUCCESS);
    expect_texel(&r, 1, 3);
    assert_int_equal(r.source.read_count, 2);
    assert_int_equal(statistics_of(&r).invalidatedCount, 1);
    finish(&r);
}

/* A read that began before the change may have old texels: it is not joined after the change, and
 * its texels are not kept. */
static void reads_that_began_before_a_change_are_not_shared(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 3, (SluiceReadPoolCreateInfo){.threadCount = 3, .maxReadsPerSource = 3});
    r.source.holds = true;
    submit(&r, 0, &r.source, 3);
    fault_source_await(&r.source, 1);
    CHECK_RESULT(sluiceDropTileLoaderStatistics(r.loaders[0], &r.source.base), SLUICE_NOT_READY);
    submit(&r, 1, &r.source, 3);
    fault_source_await(&r.source, 2);
    fault_source_release(&r.source);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    expect(&r, 1, 1, SLUICE_SUCCESS);
    assert_int_equal(r.source.read_count, 2);
    assert_int_equal(statistics_of(&r).keptCount, 1);
    submit(&r, 2, &r.source, 3); /* joins nothing, copies the newer ones */
    expect(&r, 2, 1, SLUICE_SUCCESS);
    assert_int_equal(r.source.read_count, 2);
    finish(&r);
}

static void a_loader_that_leaves_takes_the_texels_of_its_sources(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 3, two_threads);
    submit(&r, 0, &r.source, 3);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    sluiceDestroyTileLoader(r.loaders[0]);
    r.loaders[0] = NULL;
    fault_source_finish(&r.source); /* and another one at the same address */
    fault_source_init(&r.source, r.inner);
    r.added = 0.25f;
    submit(&r, 1, &r.source, 3);
    expect(&r, 1, 1, SLUICE_SUCCESS);
    expect_texel(&r, 1, 3);
    assert_int_equal(r.source.read_count, 1);
    finish(&r);
}

/* Loader 0 reads the source, and loader 1 the other one. */
static void read_both(struct rig *r)
{
    submit(r, 0, &r->source, 3);
    expect(r, 0, 1, SLUICE_SUCCESS);
    submit(r, 1, &r->other, 3);
    expect(r, 1, 1, SLUICE_SUCCESS);
    assert_int_equal(statistics_of(r).keptCount, 2);
}

static void destroy_loader(struct rig *r, uint32_t loader)
{
    sluiceDestroyTileLoader(r->loaders[loader]);
    r->loaders[loader] = NULL;
}

static void a_loader_that_leaves_takes_no_texels_of_other_sources(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 3, two_threads);
    read_both(&r);
    destroy_loader(&r, 1);
    submit(&r, 2, &r.source, 3);
    expect(&r, 2, 1, SLUICE_SUCCESS);
    assert_int_equal(r.source.read_count, 1);
    assert_int_equal(statistics_of(&r).keptCount, 1);
    finish(&r);
}

/* Loader 2 remembers one source. */
static void a_loader_that_has_forgotten_sources_takes_all_texels(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 2, two_threads);
    add_loader_of(&r, 2, (SluiceTileLoaderCreateInfo){.requestCapacity = 1});
    read_both(&r);
    submit(&r, 2, &r.source, 4);
    expect(&r, 2, 1, SLUICE_SUCCESS);
    submit(&r, 2, &r.other, 4);
    expect(&r, 2, 1, SLUICE_SUCCESS);
    assert_int_equal(statistics_of(&r).keptCount, 4);
    destroy_loader(&r, 2);
    assert_int_equal(statistics_of(&r).keptCount, 0);
    finish(&r);
}

/* While texels are freed, another thread uses the pool. */
struct watched_free {
    SluiceAllocationCallbacks callbacks;
    SluiceReadPool *pool;
    bool watches;
    uint32_t count;
    atomic_bool is_done;
    pthread_t thread;
};

static void *allocate(void *user, size_t size, size_t alignment)
{
    (void)user;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void *use_pool(void *user)
{
    struct watched_free *w = user;
    SluiceReadPoolStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetReadPoolStatistics(w->pool, &statistics));
    w->is_done = true;
    return NULL;
}

static void watch_free(void *user, void *memory, size_t size)
{
    struct watched_free *w = user;
    (void)size;
    if (w->watches && w->count++ == 0) {
        assert_int_equal(pthread_create(&w->thread, NULL, use_pool, w), 0);
        for (uint32_t ms = 0; ms < 2000 && !w->is_done; ms++)
            nanosleep(&(struct timespec){0, 1000000}, NULL);
        w->watches = false;
        assert_true(w->is_done);
    }
    free(memory);
}

static void texels_are_freed_without_the_lock(void **state)
{
    (void)state;
    enum { DROPPED, DESTROYED, LAST_BUT_ONE, CASES };
    for (uint32_t i = 0; i < CASES; i++) {
        struct watched_free w = {.callbacks = {&w, allocate, watch_free}};
        struct rig r;
        init(&r, i == LAST_BUT_ONE ? 2 : 3,
             (SluiceReadPoolCreateInfo){.threadCount = 1, .pAllocator = &w.callbacks});
        submit(&r, 0, &r.source, 3);
        expect(&r, 0, 1, SLUICE_SUCCESS);
        w.pool = r.pool;
        w.watches = true;
        if (i == DROPPED)
            CHECK_OK(sluiceDropTileLoaderStatistics(r.loaders[0], &r.source.base));
        else
            destroy_loader(&r, i == DESTROYED ? 0 : 1);
        assert_int_equal(w.count, 1);
        pthread_join(w.thread, NULL);
        finish(&r);
    }
}

/* Of a tail of four levels one is kept, one is being read, two are new. */
static void parts_of_a_read_may_be_kept_or_joined(void **state)
{
    (void)state;
    struct rig r;
    init(&r, 3, (SluiceReadPoolCreateInfo){.threadCount = 2, .maxReadsPerSource = 2});
    submit(&r, 0, &r.source, 20);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    join(&r, 21);
    submit_regions(&r, 2, &r.source.base, 20, 4, 0);
    fault_source_await(&r.source, 2); /* that of loader 0, and 22 of loader 2 */
    fault_source_release(&r.source);
    expect(&r, 2, 1, SLUICE_SUCCESS);
    for (uint32_t x = 20; x < 24; x++)
        expect_texel(&r, 2, x);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    expect(&r, 1, 2, SLUICE_SUCCESS);
    assert_int_equal(r.source.read_count, 4);
    SluiceTileLoaderStatistics own = {.structSize = sizeof own};
    CHECK_OK(sluiceGetTileLoaderStatistics(r.loaders[2], NULL, &own));
    assert_int_equal(own.byteCount, 16);
    finish(&r);
}

static void without_memory_reads_are_as_without_a_pool(void **state)
{
    (void)state;
    for (uint64_t more = 0; more < 4; more++) { /* the tables, then a region */
        struct failing_allocator a;
        struct rig r;
        failing_allocator_init(&a, UINT64_MAX);
        init(&r, 2, (SluiceReadPoolCreateInfo){.threadCount = 1, .pAllocator = &a.callbacks});
        a.refuse_from = a.calls + more;
        for (uint32_t i = 0; i < 2; i++) {
            submit(&r, i, &r.source, 3);
            expect(&r, i, 1, SLUICE_SUCCESS);
            expect_texel(&r, i, 3);
        }
        assert_int_equal(r.source.read_count, more < 3 ? 2 : 1);
        assert_int_equal(statistics_of(&r).refusedCount, more < 3 ? 2 : 0);
        assert_int_equal(statistics_of(&r).readCount, more < 3 ? 2 : 1);
        finish(&r);
        assert_int_equal(a.live_bytes, 0);
    }
}

static void creation_survives_every_refused_allocation(void **state)
{
    (void)state;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator a;
        SluiceReadPool *pool = NULL;
        failing_allocator_init(&a, n);
        const SluiceReadPoolCreateInfo info = {
            .structSize = sizeof info, .threadCount = 2, .pAllocator = &a.callbacks};
        result = sluiceCreateReadPool(&info, &pool);
        assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_true(!pool == (result != SLUICE_SUCCESS));
        sluiceDestroyReadPool(pool);
        assert_int_equal(a.live_bytes, 0);
    }
}

/* Three loaders ask for the same texels, each in its own order, and cancel some. */
static void crowd(const SluiceReadPoolCreateInfo *create)
{
    struct rig r;
    init(&r, LOADERS, *create);
    r.source.delay_us = 20;
    for (uint32_t k = 0; k < MOST; k++)
        for (uint32_t i = 0; i < LOADERS; i++) {
            static const uint32_t steps[LOADERS] = {1, 77, 255};
            submit(&r, i, &r.source, k * steps[i] % MOST);
        }
    for (uint32_t i = 0; i < LOADERS; i++) {
        expect(&r, i, MOST, SLUICE_SUCCESS);
        for (uint32_t x = 0; x < MOST; x++)
            expect_texel(&r, i, x);
    }
    assert_int_equal(r.source.read_count, MOST);
    const SluiceReadPoolStatistics now = statistics_of(&r);
    assert_int_equal(now.readCount, MOST);
    assert_int_equal(now.joinedCount + now.cachedCount, (LOADERS - 1) * MOST);
    finish(&r);
}

static void three_loaders_read_each_region_once(void **state)
{
    (void)state;
    crowd(&(const SluiceReadPoolCreateInfo){.threadCount = 4});
}

static void jobs_read_each_region_once(void **state)
{
    (void)state;
    static const struct job_system_habits habits[] = {
        {.thread_count = 4}, {0}, {.refuse_count = UINT32_MAX}};
    for (uint32_t i = 0; i < sizeof habits / sizeof habits[0]; i++) {
        struct job_system jobs;
        job_system_init(&jobs, habits[i]);
        crowd(&(const SluiceReadPoolCreateInfo){.threadCount = 4, .pJobSystem = &jobs.callbacks});
        job_system_finish(&jobs);
    }
}

/* Every texel is the version. */
struct versions {
    SluiceImageSource base; ///< must be first
    atomic_uint version;
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    (void)base;
    info->width = info->height = SIZE;
    info->mipLevelCount = 1;
    info->format = SLUICE_FORMAT_R32_SFLOAT;
    return SLUICE_SUCCESS;
}

static SluiceResult read_texel(SluiceImageSource *base, const SluiceImageRegion *region,
                               void *texels, size_t row_pitch)
{
    (void)region, (void)row_pitch;
    *(float *)texels = (float)((struct versions *)base)->version;
    return SLUICE_SUCCESS;
}

static const SluiceImageSourceInterface versions_interface = {
    .structSize = sizeof versions_interface, .pfnGetInfo = get_info, .pfnReadRegion = read_texel};

/* Texels are not older than the version when this loader last dropped them, while all loaders read,
 * cancel, change and drop on threads of their own. */
struct user {
    struct rig *rig;
    struct versions *versions;
    uint32_t loader;
};

static void *use(void *argument)
{
    const struct user *user = argument;
    struct rig *r = user->rig;
    uint32_t number = user->loader + 1, least = 0;
    for (uint32_t round = 0; round < 200; round++) {
        SluiceTileReadResult results[MOST];
        uint32_t count = MOST;
        number = number * 1664525u + 1013904223u;
        if (number >> 31)
            user->versions->version++;
        if (round % 4 == 0) {
            least = user->versions->version;
            sluiceDropTileLoaderStatistics(r->loaders[user->loader], &r->source.base);
        }
        for (uint32_t x = 0; x < 32; x++)
            submit(r, user->loader, &r->source, x);
        for (uint32_t k = 0; k < 4; k++) {
            number = number * 1664525u + 1013904223u;
            CHECK_OK(sluiceCancelTileRead(r->loaders[user->loader],
                                          r->tickets[user->loader][number >> 27]));
        }
        CHECK_OK(sluiceWaitTileLoaderIdle(r->loaders[user->loader]));
        CHECK_OK(sluiceCollectTileReads(r->loaders[user->loader], &count, results));
        assert_int_equal(count, 32);
        for (uint32_t i = 0; i < count; i++)
            if (results[i].result == SLUICE_SUCCESS)
                assert_true(r->texels[user->loader][results[i].userValue] >= (float)least);
            else
                CHECK_RESULT(results[i].result, SLUICE_ERROR_CANCELED);
    }
    return NULL;
}

static void loaders_may_be_used_on_threads_of_their_own(void **state)
{
    (void)state;
    struct rig r;
    struct user users[LOADERS];
    pthread_t threads[LOADERS];
    struct versions versions = {{&versions_interface}, 1};
    init(&r, LOADERS, (SluiceReadPoolCreateInfo){.threadCount = 3, .cacheSize = 64});
    r.source.inner = &versions.base;
    for (uint32_t i = 0; i < LOADERS; i++) {
        users[i] = (struct user){&r, &versions, i};
        assert_int_equal(pthread_create(&threads[i], NULL, use, &users[i]), 0);
    }
    for (uint32_t i = 0; i < LOADERS; i++)
        pthread_join(threads[i], NULL);
    assert_true(statistics_of(&r).keptSize <= 64);
    finish(&r);
}

/* Refusals ----------------------------------------------------------------------------------- */

struct lines {
    uint32_t count;
    char last[256];
};

static void note(void *user, SluiceLogSeverity severity, const char *message)
{
    struct lines *lines = user;
    (void)severity;
    lines->count++;
    snprintf(lines->last, sizeof lines->last, "%s", message);
}

static void a_pool_in_use_is_not_destroyed(void **state)
{
    (void)state;
    struct rig r;
    struct lines lines = {0};
    init(&r, 2, (SluiceReadPoolCreateInfo){.threadCount = 1, .log = {&lines, note}});
    sluiceDestroyReadPool(r.pool);
    assert_int_equal(lines.count, 1);
    assert_string_equal(lines.last, "read pool is not destroyed: 2 of its contexts and tile "
                                    "loaders still exist");
    submit(&r, 1, &r.source, 3);
    expect(&r, 1, 1, SLUICE_SUCCESS);
    finish(&r);
    assert_int_equal(lines.count, 1);
}

static void settings_of_the_pool_are_refused_in_its_loaders(void **state)
{
    (void)state;
    struct rig r;
    struct lines lines = {0};
    struct job_system jobs;
    job_system_init(&jobs, (struct job_system_habits){0});
    init(&r, 0, (SluiceReadPoolCreateInfo){.threadCount = 1, .log = {&lines, note}});
    const SluiceTileLoaderCreateInfo wrong[] = {{.threadCount = 1},
                                                {.maxReadsPerSource = 1},
                                                {.maxBytesInFlight = 1},
                                                {.pJobSystem = &jobs.callbacks}};
    for (uint32_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        SluiceTileLoaderCreateInfo info = wrong[i];
        info.structSize = sizeof info;
        info.readPool = r.pool;
        CHECK_RESULT(sluiceCreateTileLoader(&info, &r.loaders[0]), SLUICE_ERROR_INVALID_ARGUMENT);
    }
    assert_int_equal(lines.count, 4);
    assert_int_equal(statistics_of(&r).memberCount, 0);
    const SluiceReadPoolCreateInfo many = {.structSize = sizeof many, .threadCount = 1025};
    const SluiceJobSystem none = {0};
    const SluiceReadPoolCreateInfo empty = {.structSize = sizeof empty, .pJobSystem = &none};
    SluiceReadPool *pool;
    CHECK_RESULT(sluiceCreateReadPool(&many, &pool), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceCreateReadPool(&empty, &pool), SLUICE_ERROR_NULL_POINTER);
    finish(&r);
    job_system_finish(&jobs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_region_that_is_being_read_is_joined_without_a_thread),
        cmocka_unit_test(texels_are_kept_for_loaders_that_ask_later),
        cmocka_unit_test(one_member_keeps_nothing),
        cmocka_unit_test(kept_texels_do_not_wait_for_reads_that_stall),
        cmocka_unit_test(texels_that_are_dropped_before_their_copy_are_read),
        cmocka_unit_test(the_least_recently_used_texels_are_evicted),
        cmocka_unit_test(regions_above_the_limit_are_joined_and_not_kept),
        cmocka_unit_test(regions_outside_of_the_image_evict_nothing),
        cmocka_unit_test(regions_without_memory_evict_nothing),
        cmocka_unit_test(regions_above_the_bytes_in_flight_are_read_alone),
        cmocka_unit_test(canceling_the_reader_does_not_cancel_those_who_joined),
        cmocka_unit_test(canceling_a_read_that_joined_ends_it_at_once),
        cmocka_unit_test(loaders_may_be_destroyed_before_their_reads_end),
        cmocka_unit_test(a_failure_that_was_joined_is_an_attempt_of_each_reader),
        cmocka_unit_test(a_failure_takes_no_longer_with_more_members),
        cmocka_unit_test(reads_keep_their_priority_when_what_they_joined_fails),
        cmocka_unit_test(texels_of_an_old_format_are_let_go),
        cmocka_unit_test(texels_that_changed_are_read_again),
        cmocka_unit_test(reads_that_began_before_a_change_are_not_shared),
        cmocka_unit_test(a_loader_that_leaves_takes_the_texels_of_its_sources),
        cmocka_unit_test(a_loader_that_leaves_takes_no_texels_of_other_sources),
        cmocka_unit_test(a_loader_that_has_forgotten_sources_takes_all_texels),
        cmocka_unit_test(texels_are_freed_without_the_lock),
        cmocka_unit_test(parts_of_a_read_may_be_kept_or_joined),
        cmocka_unit_test(without_memory_reads_are_as_without_a_pool),
        cmocka_unit_test(creation_survives_every_refused_allocation),
        cmocka_unit_test(three_loaders_read_each_region_once),
        cmocka_unit_test(jobs_read_each_region_once),
        cmocka_unit_test(loaders_may_be_used_on_threads_of_their_own),
        cmocka_unit_test(a_pool_in_use_is_not_destroyed),
        cmocka_unit_test(settings_of_the_pool_are_refused_in_its_loaders),
    };
    return RUN_TESTS(tests);
}
