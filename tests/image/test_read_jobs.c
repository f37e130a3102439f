/* Loaders that read in jobs of the application. Own threads are the oracle. */
#include <sluice/loader.h>

#include "image/read_pool.h"
#include "support/fault_source.h"
#include "support/job_system.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

enum { SIZE = 64, READS = 200 };

static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)user, (void)level, (void)width, (void)height;
    rgba[0] = (float)(SIZE * y + x);
    rgba[1] = rgba[2] = rgba[3] = 0;
}

struct rig {
    struct job_system system;
    SluiceTileLoader *loader;
    SluiceImageSource *inner;
    struct fault_source source;
    float texels[READS];
    SluiceResult results[READS];
    uint32_t collected;
};

/* `create` without a job system has threads of the loader. */
static void init(struct rig *r, struct job_system_habits habits, bool has_jobs,
                 SluiceTileLoaderCreateInfo create)
{
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = SIZE,
                                  .height = SIZE,
                                  .format = SLUICE_FORMAT_R32_SFLOAT};
    const SluiceProceduralImage procedural = {.pfnTexel = texel};
    *r = (struct rig){.collected = 0};
    CHECK_OK(sluiceCreateProceduralImageSource(&procedural, &info, NULL, &r->inner));
    fault_source_init(&r->source, r->inner);
    job_system_init(&r->system, habits);
    create.structSize = sizeof create;
    create.pJobSystem = has_jobs ? &r->system.callbacks : NULL;
    CHECK_OK(sluiceCreateTileLoader(&create, &r->loader));
}

static void finish(struct rig *r)
{
    sluiceDestroyTileLoader(r->loader);
    job_system_finish(&r->system);
    fault_source_finish(&r->source);
    sluiceDestroyImageSource(r->inner);
}

static uint64_t submit(struct rig *r, uint32_t i)
{
    const SluiceImageRegion region = {.x = i % SIZE, .y = i / SIZE, .width = 1, .height = 1};
    void *to = &r->texels[i];
    const SluiceTileRead read = {.source = &r->source.base,
                                 .regionCount = 1,
                                 .pRegions = &region,
                                 .ppTexels = &to,
                                 .priority = i * 7 % 5,
                                 .userValue = i};
    uint64_t ticket;
    CHECK_OK(sluiceSubmitTileRead(r->loader, &read, &ticket));
    return ticket;
}

static void collect(struct rig *r)
{
    SluiceTileReadResult results[READS];
    uint32_t count = READS;
    CHECK_OK(sluiceCollectTileReads(r->loader, &count, results));
    for (uint32_t i = 0; i < count; i++)
        r->results[results[i].userValue] = results[i].result;
    r->collected += count;
}

static const struct job_system_habits systems[] = {
    {.thread_count = 1},
    {.thread_count = 4},
    {.thread_count = 0},                                       /* inline */
    {.thread_count = 2, .refuse_count = UINT32_MAX},           /* takes nothing */
    {.thread_count = 0, .refuse_after = 3, .refuse_count = 5}, /* inline, and refuses some */
    {.thread_count = 2, .refuse_after = 1, .refuse_count = UINT32_MAX}, /* takes one job */
    {.thread_count = 3, .refuse_after = 2, .refuse_count = 40},
    {.thread_count = 2, .delay_us = 300},
};
enum { SYSTEMS = sizeof systems / sizeof systems[0] };

/* Two reads are tried again. */
static const SluiceResult script[] = {SLUICE_SUCCESS, SLUICE_SUCCESS,   SLUICE_ERROR_IO,
                                      SLUICE_SUCCESS, SLUICE_NOT_READY, SLUICE_SUCCESS};

static const SluiceTileRetryPolicy quick = {.firstDelayNs = 1, .maxDelayNs = 1};

static SluiceTileLoaderStatistics read_all(struct rig *r)
{
    SluiceTileLoaderStatistics statistics = {.structSize = sizeof statistics};
    r->source.script = script;
    r->source.script_length = sizeof script / sizeof script[0];
    for (uint32_t i = 0; i < READS; i++)
        submit(r, i);
    CHECK_OK(sluiceWaitTileLoaderIdle(r->loader));
    collect(r);
    CHECK_OK(sluiceGetTileLoaderStatistics(r->loader, NULL, &statistics));
    return statistics;
}

static void jobs_read_what_threads_read(void **state)
{
    (void)state;
    struct rig *own = calloc(1, sizeof *own), *r = calloc(1, sizeof *r);
    const SluiceTileLoaderCreateInfo create = {.threadCount = 3, .retry = quick};
    assert_non_null(own);
    assert_non_null(r);
    init(own, (struct job_system_habits){0}, false, create);
    SluiceTileLoaderStatistics expected = read_all(own);
    assert_int_equal(own->system.submitted_count, 0);
    for (uint32_t i = 0; i < SYSTEMS; i++) {
        init(r, systems[i], true, create);
        SluiceTileLoaderStatistics statistics = read_all(r);
        assert_int_equal(r->collected, READS);
        assert_memory_equal(r->texels, own->texels, sizeof r->texels);
        assert_memory_equal(r->results, own->results, sizeof r->results);
        assert_int_equal(statistics.attemptCount, expected.attemptCount);
        assert_int_equal(statistics.retriedCount, expected.retriedCount);
        assert_int_equal(statistics.byteCount, expected.byteCount);
        assert_true(r->source.most_running <= 3 + 1); /* and the thread that waits */
        finish(r);
    }
    finish(own);
    free(own);
    free(r);
}

static void a_loader_with_jobs_has_no_threads(void **state)
{
    (void)state;
    struct rig r;
    init(&r, (struct job_system_habits){.thread_count = 1}, true,
         (SluiceTileLoaderCreateInfo){.threadCount = 4});
    assert_int_equal(r.loader->pool->thread_count, 0);
    assert_null(r.loader->pool->threads);
    finish(&r);
}

static void callers_that_only_collect_get_every_read(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < SYSTEMS; i++) {
        struct rig r;
        if (systems[i].refuse_count == UINT32_MAX)
            continue; /* no thread tries again for a caller that does not wait */
        init(&r, systems[i], true,
             (SluiceTileLoaderCreateInfo){.threadCount = 2, .retry.firstDelayNs = 1000000});
        r.source.script = script;
        r.source.script_length = sizeof script / sizeof script[0];
        for (uint32_t k = 0; k < 20; k++)
            submit(&r, k);
        while (r.collected < 20)
            collect(&r);
        for (uint32_t k = 0; k < 20; k++) {
            CHECK_OK(r.results[k]);
            assert_true(r.texels[k] == (float)k);
        }
        finish(&r);
    }
}

/* Each thread of the application holds a read. */
static void as_many_jobs_run_as_threads_were_asked_for(void **state)
{
    (void)state;
    struct rig r;
    init(&r, (struct job_system_habits){.thread_count = 6}, true,
         (SluiceTileLoaderCreateInfo){.threadCount = 4, .maxReadsPerSource = 8});
    r.source.holds = true;
    for (uint32_t i = 0; i < 12; i++)
        submit(&r, i);
    fault_source_await(&r.source, 4);
    assert_int_equal(r.source.most_running, 4);
    fault_source_release(&r.source);
    CHECK_OK(sluiceWaitTileLoaderIdle(r.loader));
    collect(&r);
    assert_int_equal(r.collected, 12);
    finish(&r);
}

/* The reads that wait are canceled; the job that was submitted for them finds nothing. */
static void destruction_waits_for_jobs_that_were_not_run_yet(void **state)
{
    (void)state;
    struct rig r;
    init(&r, (struct job_system_habits){.thread_count = 1, .delay_us = 20000}, true,
         (SluiceTileLoaderCreateInfo){.threadCount = 2});
    for (uint32_t i = 0; i < 10; i++)
        submit(&r, i);
    sluiceDestroyTileLoader(r.loader);
    pthread_mutex_lock(&r.system.mutex);
    assert_int_equal(r.system.count, 0);
    pthread_mutex_unlock(&r.system.mutex);
    r.loader = NULL;
    finish(&r);
    assert_true(r.source.read_count < 10);
}

/* The only thread of the job system waits itself. */
struct waiter {
    struct rig *rig;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    bool is_done;
};

static void wait_in_job(void *user)
{
    struct waiter *waiter = user;
    for (uint32_t i = 0; i < 10; i++)
        submit(waiter->rig, i);
    CHECK_OK(sluiceWaitTileLoaderIdle(waiter->rig->loader));
    pthread_mutex_lock(&waiter->mutex);
    waiter->is_done = true;
    pthread_cond_signal(&waiter->changed);
    pthread_mutex_unlock(&waiter->mutex);
}

static void the_only_thread_of_a_job_system_may_wait(void **state)
{
    (void)state;
    struct rig r;
    struct waiter waiter = {&r, PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER, false};
    init(&r, (struct job_system_habits){.thread_count = 1}, true,
         (SluiceTileLoaderCreateInfo){.threadCount = 2});
    CHECK_OK(r.system.callbacks.pfnSubmitJob(&r.system, wait_in_job, &waiter));
    pthread_mutex_lock(&waiter.mutex);
    while (!waiter.is_done)
        pthread_cond_wait(&waiter.changed, &waiter.mutex);
    pthread_mutex_unlock(&waiter.mutex);
    collect(&r);
    assert_int_equal(r.collected, 10);
    finish(&r);
}

static void a_job_system_needs_its_function(void **state)
{
    (void)state;
    const SluiceJobSystem none = {0};
    const SluiceTileLoaderCreateInfo create = {.structSize = sizeof create, .pJobSystem = &none};
    SluiceTileLoader *loader;
    CHECK_RESULT(sluiceCreateTileLoader(&create, &loader), SLUICE_ERROR_NULL_POINTER);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jobs_read_what_threads_read),
        cmocka_unit_test(a_loader_with_jobs_has_no_threads),
        cmocka_unit_test(callers_that_only_collect_get_every_read),
        cmocka_unit_test(as_many_jobs_run_as_threads_were_asked_for),
        cmocka_unit_test(destruction_waits_for_jobs_that_were_not_run_yet),
        cmocka_unit_test(the_only_thread_of_a_job_system_may_wait),
        cmocka_unit_test(a_job_system_needs_its_function),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
