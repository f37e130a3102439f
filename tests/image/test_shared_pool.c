/* Loaders that share a SluiceReadPool: reads are joined, canceled, fail, and end. */
#define _POSIX_C_SOURCE 200809L

#include "image/pool_rig.h"

#include "support/failing_allocator.h"
#include "support/job_system.h"
#include "support/test.h"

#include <stdio.h>

static void a_region_that_is_being_read_is_joined_without_a_thread(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 2, two_threads);
    join(&r, 7);
    fault_source_release(&r.source);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    expect(&r, 1, 2, SLUICE_SUCCESS);
    expect_texel(&r, 0, 7);
    expect_texel(&r, 1, 7);
    assert_int_equal(r.source.read_count, 1);
    const SluiceReadPoolStatistics now = statistics_of(&r);
    assert_int_equal(now.memberCount, 2);
    assert_int_equal(now.readCount, 2); /* includes the read of the other source */
    assert_int_equal(now.readSize, 8);
    assert_int_equal(now.joinedCount, 1);
    assert_int_equal(now.cachedCount, 0);
    assert_int_equal(now.keptCount, 2);
    assert_int_equal(now.keptSize, 8);
    pool_rig_finish(&r);
}

static void canceling_the_reader_does_not_cancel_those_who_joined(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 2, two_threads);
    join(&r, 7);
    CHECK_OK(sluiceCancelTileRead(r.loaders[0], r.tickets[0][7]));
    fault_source_release(&r.source);
    expect(&r, 1, 2, SLUICE_SUCCESS);
    expect_texel(&r, 1, 7);
    assert_int_equal(r.source.read_count, 1);
    pool_rig_finish(&r);
}

static void canceling_a_read_that_joined_ends_it_at_once(void **state)
{
    (void)state;
    struct pool_rig r;
    SluiceTileReadResult results[2];
    uint32_t count = 0;
    pool_rig_init(&r, 2, two_threads);
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
    pool_rig_finish(&r);
}

static void loaders_may_be_destroyed_before_their_reads_end(void **state)
{
    (void)state;
    for (uint32_t gone = 0; gone < 2; gone++) {
        struct pool_rig r;
        pool_rig_init(&r, 3, two_threads);
        join(&r, 7);
        if (gone == 1) { /* returns at once, without waiting for the other loader */
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
        pool_rig_finish(&r);
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

/* Loader 1 retries. */
static void a_failure_that_was_joined_is_an_attempt_of_each_reader(void **state)
{
    (void)state;
    struct pool_rig r;
    struct failures failures = {0};
    pool_rig_init(&r, 1, two_threads);
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
    pool_rig_finish(&r);
}

static void a_failure_takes_no_longer_with_more_members(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, LOADERS, two_threads);
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
        CHECK_OK(results[0].result); /* read of the other source */
        CHECK_RESULT(results[1].result, SLUICE_ERROR_IO);
    }
    assert_int_equal(r.source.read_count, 1);
    pool_rig_finish(&r);
}

/* Loader 1 waits for x with priority 1, and has a more urgent read. The other thread is held. */
static void reads_keep_their_priority_when_what_they_joined_fails(void **state)
{
    (void)state;
    struct pool_rig r;
    SluiceTileReadResult results[3];
    uint32_t count = 3;
    pool_rig_init(&r, 1, two_threads);
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
    assert_int_equal(results[1].userValue, 9); /* the first result belongs to the other source */
    assert_int_equal(results[2].userValue, 7);
    CHECK_OK(results[2].result);
    fault_source_release(&r.other);
    pool_rig_finish(&r);
}

/* A tail has four levels: one is kept, one is being read, two are new. */
static void parts_of_a_read_may_be_kept_or_joined(void **state)
{
    (void)state;
    struct pool_rig r;
    pool_rig_init(&r, 3, (SluiceReadPoolCreateInfo){.threadCount = 2, .maxReadsPerSource = 2});
    submit(&r, 0, &r.source, 20);
    expect(&r, 0, 1, SLUICE_SUCCESS);
    join(&r, 21);
    submit_regions(&r, 2, &r.source.base, 20, 4, 0);
    fault_source_await(&r.source, 2); /* reads of loader 0, and region 22 of loader 2 */
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
    pool_rig_finish(&r);
}

static void without_memory_reads_are_as_without_a_pool(void **state)
{
    (void)state;
    for (uint64_t more = 0; more < 4; more++) { /* the tables, then a region */
        struct failing_allocator a;
        struct pool_rig r;
        failing_allocator_init(&a, UINT64_MAX);
        pool_rig_init(&r, 2,
                      (SluiceReadPoolCreateInfo){.threadCount = 1, .pAllocator = &a.callbacks});
        a.refuse_from = a.calls + more;
        for (uint32_t i = 0; i < 2; i++) {
            submit(&r, i, &r.source, 3);
            expect(&r, i, 1, SLUICE_SUCCESS);
            expect_texel(&r, i, 3);
        }
        assert_int_equal(r.source.read_count, more < 3 ? 2 : 1);
        assert_int_equal(statistics_of(&r).refusedCount, more < 3 ? 2 : 0);
        assert_int_equal(statistics_of(&r).readCount, more < 3 ? 2 : 1);
        pool_rig_finish(&r);
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

/* Three loaders request the same texels, each in its own order, and cancel some. */
static void crowd(const SluiceReadPoolCreateInfo *create)
{
    struct pool_rig r;
    pool_rig_init(&r, LOADERS, *create);
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
    pool_rig_finish(&r);
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

/* A source whose texels all equal the version. */
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

/* A user of a loader. Its texels must not be older than the version when the loader last dropped
 * them. All users read, cancel, change and drop on threads of their own. */
struct user {
    struct pool_rig *rig;
    struct versions *versions;
    uint32_t loader;
};

static void *use(void *argument)
{
    const struct user *user = argument;
    struct pool_rig *r = user->rig;
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
    struct pool_rig r;
    struct user users[LOADERS];
    pthread_t threads[LOADERS];
    struct versions versions = {{&versions_interface}, 1};
    pool_rig_init(&r, LOADERS, (SluiceReadPoolCreateInfo){.threadCount = 3, .cacheSize = 64});
    r.source.inner = &versions.base;
    for (uint32_t i = 0; i < LOADERS; i++) {
        users[i] = (struct user){&r, &versions, i};
        assert_int_equal(pthread_create(&threads[i], NULL, use, &users[i]), 0);
    }
    for (uint32_t i = 0; i < LOADERS; i++)
        pthread_join(threads[i], NULL);
    assert_true(statistics_of(&r).keptSize <= 64);
    pool_rig_finish(&r);
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
    struct pool_rig r;
    struct lines lines = {0};
    pool_rig_init(&r, 2, (SluiceReadPoolCreateInfo){.threadCount = 1, .log = {&lines, note}});
    sluiceDestroyReadPool(r.pool);
    assert_int_equal(lines.count, 1);
    assert_string_equal(lines.last, "read pool is not destroyed: 2 of its contexts and tile "
                                    "loaders still exist");
    submit(&r, 1, &r.source, 3);
    expect(&r, 1, 1, SLUICE_SUCCESS);
    pool_rig_finish(&r);
    assert_int_equal(lines.count, 1);
}

static void settings_of_the_pool_are_refused_in_its_loaders(void **state)
{
    (void)state;
    struct pool_rig r;
    struct lines lines = {0};
    struct job_system jobs;
    job_system_init(&jobs, (struct job_system_habits){0});
    pool_rig_init(&r, 0, (SluiceReadPoolCreateInfo){.threadCount = 1, .log = {&lines, note}});
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
    pool_rig_finish(&r);
    job_system_finish(&jobs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_region_that_is_being_read_is_joined_without_a_thread),
        cmocka_unit_test(canceling_the_reader_does_not_cancel_those_who_joined),
        cmocka_unit_test(canceling_a_read_that_joined_ends_it_at_once),
        cmocka_unit_test(loaders_may_be_destroyed_before_their_reads_end),
        cmocka_unit_test(a_failure_that_was_joined_is_an_attempt_of_each_reader),
        cmocka_unit_test(a_failure_takes_no_longer_with_more_members),
        cmocka_unit_test(reads_keep_their_priority_when_what_they_joined_fails),
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
