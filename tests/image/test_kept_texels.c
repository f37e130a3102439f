/* Texels that a SluiceReadPool keeps: for whom, how many, and when they are dropped. */
#define _POSIX_C_SOURCE 200809L

#include "image/pool_rig.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdlib.h>
#include <time.h>

static void texels_are_kept_for_loaders_that_ask_later(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 3, two_threads);
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
    pool_rig_finish(&r);
}

static void one_member_keeps_nothing(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 1, two_threads);
    submit(&r, 0, &r.source, 3);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    submit(&r, 0, &r.source, 3);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    assert_int_equal(r.source.read_count, 2);
    const SluiceReadPoolStatistics now = statistics_of(&r);
    assert_int_equal(now.readCount, 2);
    assert_int_equal(now.keptPeakSize, 0);
    pool_rig_finish(&r);
}

/* Loader 0 has read texel 3, and reads texel 10 until the end. One thread is free. */
static void kept_texels_do_not_wait_for_reads_that_stall(void **state)
{
    (void)state;
    static const SluiceReadPoolCreateInfo limits[] = {
        {.threadCount = 2, .maxReadsPerSource = 1},
        {.threadCount = 2, .maxReadsPerSource = 2, .maxBytesInFlight = sizeof(float)}};
    for (uint32_t i = 0; i < sizeof limits / sizeof limits[0]; i++) {
        struct pool_rig r;
        SluiceTileReadResult result;
        uint32_t count = 0;
        pool_rig_init(&r, 2, limits[i]);
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
        pool_rig_finish(&r);
    }
}

/* Loader 1 requests texels while the only thread reads something else. They are kept, and dropped
 * before they are copied. */
static void texels_that_are_dropped_before_their_copy_are_read(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 2, (SluiceReadPoolCreateInfo){.threadCount = 1});
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
    pool_rig_finish(&r);
}

/* Room for two texels of four bytes. */
static void the_least_recently_used_texels_are_evicted(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 2, (SluiceReadPoolCreateInfo){.threadCount = 1, .cacheSize = 8});
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
    pool_rig_finish(&r);
}

/* A region larger than the limit does not push out the small ones; nothing of it stays. */
static void regions_above_the_limit_are_joined_and_not_kept(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(
        &r, 2,
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
    pool_rig_finish(&r);
}

static void expect_kept(const struct pool_rig *r, uint64_t count)
{
    const SluiceReadPoolStatistics now = statistics_of(r);
    assert_int_equal(now.keptCount, count);
    assert_int_equal(now.keptPeakSize, count * sizeof(float));
    assert_int_equal(now.evictedCount, 0);
}

static void submit_rectangle(struct pool_rig *r, uint32_t loader, uint32_t width, uint32_t height)
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
    struct pool_rig r;
    pool_rig_init(&r, 2,
                  (SluiceReadPoolCreateInfo){.threadCount = 1, .cacheSize = 2 * sizeof(float)});
    for (uint32_t x = 0; x < 2; x++)
        submit(&r, 0, &r.source, x);
    expect(&r, 0, 2, SLUICE_SUCCESS);
    submit_rectangle(&r, 0, 1, SIZE + 1);
    expect(&r, 0, 1, SLUICE_ERROR_INVALID_ARGUMENT);
    submit_rectangle(&r, 0, 1u << 20, 1);
    expect(&r, 0, 1, SLUICE_ERROR_INVALID_ARGUMENT);
    expect_kept(&r, 2);
    pool_rig_finish(&r);
}

static void regions_without_memory_evict_nothing(void **state)
{
    (void)state;
    struct failing_allocator a;
    struct pool_rig r;
    failing_allocator_init(&a, UINT64_MAX);
    pool_rig_init(&r, 2,
                  (SluiceReadPoolCreateInfo){.threadCount = 1,
                                             .pAllocator = &a.callbacks,
                                             .cacheSize = 2 * sizeof(float)});
    for (uint32_t x = 0; x < 2; x++)
        submit(&r, 0, &r.source, x);
    expect(&r, 0, 2, SLUICE_SUCCESS);
    a.refuse_from = a.calls;
    submit_rectangle(&r, 0, 2, 1);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    expect_texel(&r, 0, 1);
    expect_kept(&r, 2);
    assert_int_equal(statistics_of(&r).refusedCount, 1);
    pool_rig_finish(&r);
}

/* A pool has at most maxBytesInFlight beyond its cache. */
static void regions_above_the_bytes_in_flight_are_read_alone(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 2,
                  (SluiceReadPoolCreateInfo){.threadCount = 1, .maxBytesInFlight = sizeof(float)});
    for (uint32_t i = 0; i < 2; i++) {
        submit_rectangle(&r, i, 2, 1);
        expect(&r, i, 1, SLUICE_SUCCESS);
        expect_texel(&r, i, 1);
    }
    assert_int_equal(r.source.read_count, 2);
    expect_kept(&r, 0);
    pool_rig_finish(&r);
}

/* Loader 1 has failed: loader 2 reads x and is held when loader 1 tries again. */
static void read_at_loader_2(void *user, const SluiceTileReadFailure *failure)
{
    struct pool_rig *r = user;
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
    struct pool_rig r;
    SluiceTileLoaderStatistics own = {.structSize = sizeof own};
    pool_rig_init(&r, 1, two_threads);
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
    pool_rig_finish(&r);
}

static void texels_that_changed_are_read_again(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 2, two_threads);
    submit(&r, 0, &r.source, 3);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    r.added = 0.5f;
    CHECK_OK(sluiceDropTileLoaderStatistics(r.loaders[1], &r.source.base));
    submit(&r, 1, &r.source, 3);
    expect(&r, 1, 1, SLUICE_SUCCESS);
    expect_texel(&r, 1, 3);
    assert_int_equal(r.source.read_count, 2);
    assert_int_equal(statistics_of(&r).invalidatedCount, 1);
    pool_rig_finish(&r);
}

/* A read that began before the change may have old texels: it is not joined after the change, and
 * its texels are not kept. */
static void reads_that_began_before_a_change_are_not_shared(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 3, (SluiceReadPoolCreateInfo){.threadCount = 3, .maxReadsPerSource = 3});
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
    pool_rig_finish(&r);
}

static void a_loader_that_leaves_takes_the_texels_of_its_sources(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 3, two_threads);
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
    pool_rig_finish(&r);
}

/* Loader 0 reads the source, and loader 1 the other one. */
static void read_both(struct pool_rig *r)
{
    submit(r, 0, &r->source, 3);
    expect(r, 0, 1, SLUICE_SUCCESS);
    submit(r, 1, &r->other, 3);
    expect(r, 1, 1, SLUICE_SUCCESS);
    assert_int_equal(statistics_of(r).keptCount, 2);
}

static void destroy_loader(struct pool_rig *r, uint32_t loader)
{
    sluiceDestroyTileLoader(r->loaders[loader]);
    r->loaders[loader] = NULL;
}

static void a_loader_that_leaves_takes_no_texels_of_other_sources(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 3, two_threads);
    read_both(&r);
    destroy_loader(&r, 1);
    submit(&r, 2, &r.source, 3);
    expect(&r, 2, 1, SLUICE_SUCCESS);
    assert_int_equal(r.source.read_count, 1);
    assert_int_equal(statistics_of(&r).keptCount, 1);
    pool_rig_finish(&r);
}

/* Loader 2 remembers one source. */
static void a_loader_that_has_forgotten_sources_takes_all_texels(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 2, two_threads);
    add_loader_of(&r, 2, (SluiceTileLoaderCreateInfo){.requestCapacity = 1});
    read_both(&r);
    submit(&r, 2, &r.source, 4);
    expect(&r, 2, 1, SLUICE_SUCCESS);
    submit(&r, 2, &r.other, 4);
    expect(&r, 2, 1, SLUICE_SUCCESS);
    assert_int_equal(statistics_of(&r).keptCount, 4);
    destroy_loader(&r, 2);
    assert_int_equal(statistics_of(&r).keptCount, 0);
    pool_rig_finish(&r);
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
        struct pool_rig r;
        pool_rig_init(&r, i == LAST_BUT_ONE ? 2 : 3,
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
        pool_rig_finish(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_are_kept_for_loaders_that_ask_later),
        cmocka_unit_test(one_member_keeps_nothing),
        cmocka_unit_test(kept_texels_do_not_wait_for_reads_that_stall),
        cmocka_unit_test(texels_that_are_dropped_before_their_copy_are_read),
        cmocka_unit_test(the_least_recently_used_texels_are_evicted),
        cmocka_unit_test(regions_above_the_limit_are_joined_and_not_kept),
        cmocka_unit_test(regions_outside_of_the_image_evict_nothing),
        cmocka_unit_test(regions_without_memory_evict_nothing),
        cmocka_unit_test(regions_above_the_bytes_in_flight_are_read_alone),
        cmocka_unit_test(texels_of_an_old_format_are_let_go),
        cmocka_unit_test(texels_that_changed_are_read_again),
        cmocka_unit_test(reads_that_began_before_a_change_are_not_shared),
        cmocka_unit_test(a_loader_that_leaves_takes_the_texels_of_its_sources),
        cmocka_unit_test(a_loader_that_leaves_takes_no_texels_of_other_sources),
        cmocka_unit_test(a_loader_that_has_forgotten_sources_takes_all_texels),
        cmocka_unit_test(texels_are_freed_without_the_lock),
    };
    return RUN_TESTS(tests);
}
