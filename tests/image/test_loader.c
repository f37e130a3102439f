#define _POSIX_C_SOURCE 200809L

#include <sluice/loader.h>

#include "support/failing_allocator.h"
#include "support/fault_source.h"
#include "support/test.h"

#include <sched.h>
#include <string.h>

enum { SIZE = 64 };

static void mark(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                 uint32_t height, float rgba[4])
{
    (void)user;
    (void)height;
    rgba[0] = (float)(level * 100000 + y * width + x);
    rgba[1] = rgba[2] = rgba[3] = 0;
}

/* A loader on a source that tests can hold and break. */
struct fixture {
    SluiceImageSource *inner;
    struct fault_source source;
    SluiceTileLoader *loader;
};

static void setup(struct fixture *f, uint32_t threads, uint32_t capacity)
{
    SluiceProceduralImage image = {NULL, mark};
    SluiceImageInfo info = {sizeof info, SIZE, SIZE, 0, SLUICE_FORMAT_R32_SFLOAT, "loader test"};
    SluiceTileLoaderCreateInfo create = {sizeof create, threads, capacity, NULL,
                                         .retry.maxAttempts = 1};
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &f->inner));
    fault_source_init(&f->source, f->inner);
    CHECK_OK(sluiceCreateTileLoader(&create, &f->loader));
}

static void teardown(struct fixture *f)
{
    sluiceDestroyTileLoader(f->loader);
    fault_source_finish(&f->source);
    sluiceDestroyImageSource(f->inner);
}

static SluiceResult submit(struct fixture *f, const SluiceImageRegion *regions, uint32_t count,
                           void *const *texels, uint32_t priority, uint64_t value, uint64_t *ticket)
{
    SluiceTileRead read = {&f->source.base, count, regions, texels, priority, value};
    return sluiceSubmitTileRead(f->loader, &read, ticket);
}

static uint64_t submit_texel(struct fixture *f, uint32_t x, float *texel, uint32_t priority)
{
    SluiceImageRegion region = {0, x, 0, 1, 1};
    void *texels = texel;
    uint64_t ticket = 0;
    CHECK_OK(submit(f, &region, 1, &texels, priority, x, &ticket));
    assert_true(ticket != 0);
    return ticket;
}

static SluiceTileReadResult collect_one(struct fixture *f)
{
    SluiceTileReadResult result;
    uint32_t count = 0;
    while (count == 0) {
        count = 1;
        assert_true(sluiceCollectTileReads(f->loader, &count, &result) >= 0);
        if (count == 0)
            sched_yield();
    }
    return result;
}

static void all_regions_of_a_read_are_delivered(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 2, 0);
    static float texels[3][SIZE * SIZE];
    SluiceImageRegion regions[3] = {{0, 3, 5, 7, 9}, {2, 0, 0, 16, 16}, {6, 0, 0, 1, 1}};
    void *const places[3] = {texels[0], texels[1], texels[2]};
    uint64_t ticket;
    CHECK_OK(submit(&f, regions, 3, places, 1, 77, &ticket));
    SluiceTileReadResult result = collect_one(&f);
    assert_int_equal(result.ticket, ticket);
    assert_int_equal(result.userValue, 77);
    CHECK_OK(result.result);
    assert_int_equal(result.size, 4 * (7 * 9 + 256 + 1));
    assert_true(texels[0][7 * 2 + 1] == (5 + 2) * SIZE + 3 + 1);
    assert_true(texels[1][255] == 200255 && texels[2][0] == 600000);
    teardown(&f);
}

static void urgent_reads_go_first_and_equal_ones_in_order(void **state)
{
    (void)state;
    enum { COUNT = 40 };
    struct fixture f;
    setup(&f, 1, 0);
    f.source.holds = true;
    float texels[COUNT + 1];
    submit_texel(&f, 0, &texels[0], 0);
    fault_source_await(&f.source, 1);
    for (uint32_t i = 1; i <= COUNT; i++)
        submit_texel(&f, i, &texels[i], i * 7 % 5);
    fault_source_release(&f.source);
    sluiceWaitTileLoaderIdle(f.loader);
    assert_int_equal(collect_one(&f).userValue, 0);
    for (int priority = 4; priority >= 0; priority--)
        for (uint32_t i = 1; i <= COUNT; i++)
            if (i * 7 % 5 == (uint32_t)priority) {
                assert_int_equal(collect_one(&f).userValue, i);
                assert_true(texels[i] == (float)i);
            }
    teardown(&f);
}

static void a_queued_read_that_is_canceled_is_never_begun(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 1, 0);
    f.source.holds = true;
    float texels[3] = {-1, -1, -1};
    submit_texel(&f, 0, &texels[0], 0);
    fault_source_await(&f.source, 1);
    uint64_t dropped = submit_texel(&f, 1, &texels[1], 9);
    submit_texel(&f, 2, &texels[2], 0);
    sluiceCancelTileRead(f.loader, dropped);
    SluiceTileReadResult result = collect_one(&f);
    assert_int_equal(result.ticket, dropped);
    assert_int_equal(result.size, 0);
    CHECK_RESULT(result.result, SLUICE_ERROR_CANCELED);
    fault_source_release(&f.source);
    sluiceWaitTileLoaderIdle(f.loader);
    CHECK_OK(collect_one(&f).result);
    CHECK_OK(collect_one(&f).result);
    assert_true(texels[1] == -1 && texels[2] == 2);
    assert_int_equal(f.source.read_count, 2);
    teardown(&f);
}

static void a_running_read_that_is_canceled_stops_between_regions(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 1, 0);
    f.source.holds = true;
    float texels[2] = {-1, -1};
    SluiceImageRegion regions[2] = {{0, 1, 0, 1, 1}, {0, 2, 0, 1, 1}};
    void *const places[2] = {&texels[0], &texels[1]};
    uint64_t ticket;
    CHECK_OK(submit(&f, regions, 2, places, 0, 0, &ticket));
    fault_source_await(&f.source, 1);
    sluiceCancelTileRead(f.loader, ticket);
    fault_source_release(&f.source);
    SluiceTileReadResult result = collect_one(&f);
    CHECK_RESULT(result.result, SLUICE_ERROR_CANCELED);
    assert_int_equal(result.size, 0);
    assert_int_equal(f.source.read_count, 1);
    assert_true(texels[1] == -1);
    teardown(&f);
}

struct ends {
    uint32_t count;
    uint64_t values[4];
    SluiceResult results[4];
};

static void note_end(void *user, uint64_t value, SluiceResult result)
{
    struct ends *ends = user; /* the loader's lock is around it */
    if (ends->count < 4) {
        ends->values[ends->count] = value;
        ends->results[ends->count] = result;
    }
    ends->count++;
}

static void every_end_of_a_read_is_told_once_with_its_result(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 1, 0);
    sluiceDestroyTileLoader(f.loader);
    struct ends ends = {0};
    SluiceTileLoaderCreateInfo create = {sizeof create,           1, 0, NULL, .retry = {2, 1, 1},
                                         .end = {&ends, note_end}};
    CHECK_OK(sluiceCreateTileLoader(&create, &f.loader));
    f.source.fail_at = 2; /* after which the same read is tried again */
    f.source.failure = SLUICE_ERROR_IO;
    f.source.holds = true;
    float texels[3] = {0};
    submit_texel(&f, 7, &texels[0], 0);
    fault_source_await(&f.source, 1);
    uint64_t dropped = submit_texel(&f, 8, &texels[1], 0);
    submit_texel(&f, 9, &texels[2], 0);
    assert_int_equal(ends.count, 0);
    sluiceCancelTileRead(f.loader, dropped);
    sluiceCancelTileRead(f.loader, dropped);
    fault_source_release(&f.source);
    sluiceWaitTileLoaderIdle(f.loader);
    assert_int_equal(ends.count, 3);
    for (uint32_t i = 0; i < 3; i++) {
        SluiceTileReadResult result = collect_one(&f);
        assert_int_equal(ends.values[i], result.userValue);
        CHECK_RESULT(ends.results[i], result.result);
    }
    assert_int_equal(ends.values[0], 8);
    CHECK_RESULT(ends.results[0], SLUICE_ERROR_CANCELED);
    CHECK_OK(ends.results[2]);
    teardown(&f);
}

static void a_read_in_its_last_region_ends_as_if_nothing_had_been_said(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 1, 0);
    f.source.holds = true;
    float texel = -1;
    uint64_t ticket = submit_texel(&f, 5, &texel, 0);
    fault_source_await(&f.source, 1);
    sluiceCancelTileRead(f.loader, ticket);
    fault_source_release(&f.source);
    CHECK_OK(collect_one(&f).result);
    assert_true(texel == 5);
    sluiceCancelTileRead(f.loader, ticket); /* collected, */
    sluiceCancelTileRead(f.loader, 0);      /* never given, */
    sluiceCancelTileRead(f.loader, 999999); /* not given yet */
    submit_texel(&f, 6, &texel, 0);
    CHECK_OK(collect_one(&f).result);
    teardown(&f);
}

static void capacity_counts_what_is_not_collected(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 1, 3);
    float texels[4];
    for (uint32_t i = 0; i < 3; i++)
        submit_texel(&f, i, &texels[i], 0);
    sluiceWaitTileLoaderIdle(f.loader);
    SluiceImageRegion region = {0, 3, 0, 1, 1};
    void *place = &texels[3];
    uint64_t ticket = 12345;
    CHECK_RESULT(submit(&f, &region, 1, &place, 0, 3, &ticket), SLUICE_NOT_READY);
    assert_int_equal(ticket, 12345);
    SluiceTileReadResult results[3];
    uint32_t count = 2;
    CHECK_RESULT(sluiceCollectTileReads(f.loader, &count, results), SLUICE_INCOMPLETE);
    assert_int_equal(count, 2);
    CHECK_OK(submit(&f, &region, 1, &place, 0, 3, &ticket));
    sluiceWaitTileLoaderIdle(f.loader);
    count = 3;
    CHECK_OK(sluiceCollectTileReads(f.loader, &count, results));
    assert_int_equal(count, 2);
    count = 3;
    CHECK_OK(sluiceCollectTileReads(f.loader, &count, results));
    assert_int_equal(count, 0);
    teardown(&f);
}

static void reads_are_submitted_together_or_not_at_all(void **state)
{
    (void)state;
    enum { COUNT = 4 };
    struct fixture f;
    setup(&f, 1, COUNT + 1);
    float texels[COUNT];
    SluiceImageRegion regions[COUNT];
    void *places[COUNT];
    SluiceTileRead reads[COUNT];
    uint64_t tickets[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        regions[i] = (SluiceImageRegion){0, i, 0, 1, 1};
        places[i] = &texels[i];
        reads[i] = (SluiceTileRead){&f.source.base, 1, &regions[i], &places[i], COUNT - i, i};
    }
    f.source.holds = true;
    CHECK_OK(sluiceSubmitTileReads(f.loader, COUNT, reads, tickets));
    CHECK_RESULT(sluiceSubmitTileReads(f.loader, 2, reads, tickets), SLUICE_NOT_READY);
    reads[COUNT - 1].regionCount = 0;
    CHECK_RESULT(sluiceSubmitTileReads(f.loader, COUNT, reads, tickets),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_OK(sluiceSubmitTileReads(f.loader, 0, NULL, NULL));
    fault_source_release(&f.source);
    for (uint32_t i = 0; i < COUNT; i++) { /* the most urgent first */
        SluiceTileReadResult result = collect_one(&f);
        assert_int_equal(result.userValue, i);
        assert_int_equal(result.ticket, tickets[i]);
        assert_true(texels[i] == i);
    }
    SluiceTileLoaderStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetTileLoaderStatistics(f.loader, NULL, &statistics));
    assert_int_equal(statistics.readCount, COUNT);
    teardown(&f);
}

static void failures_of_the_source_reach_the_result(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 1, 0);
    f.source.postponed = 1;
    f.source.fail_at = 3;
    f.source.failure = SLUICE_ERROR_IO;
    f.source.is_short = true;
    const SluiceResult expected[4] = {SLUICE_NOT_READY, SLUICE_SUCCESS, SLUICE_ERROR_IO,
                                      SLUICE_SUCCESS};
    for (uint32_t i = 0; i < 4; i++) {
        float texel;
        submit_texel(&f, i, &texel, 0);
        SluiceTileReadResult result = collect_one(&f);
        CHECK_RESULT(result.result, expected[i]);
        assert_int_equal(result.size, expected[i] == SLUICE_SUCCESS ? 4 : 0);
    }
    SluiceImageRegion outside = {0, SIZE, 0, 1, 1};
    float texel;
    void *place = &texel;
    uint64_t ticket;
    CHECK_OK(submit(&f, &outside, 1, &place, 0, 0, &ticket));
    CHECK_RESULT(collect_one(&f).result, SLUICE_ERROR_INVALID_ARGUMENT);
    teardown(&f);
}

static void destroying_drops_what_waits_and_waits_for_what_runs(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 2, 0);
    f.source.delay_us = 2000;
    float texels[50];
    for (uint32_t i = 0; i < 50; i++)
        submit_texel(&f, i % SIZE, &texels[i], 0);
    teardown(&f); /* sanitizers see a read that outlives it */
    assert_true(f.source.read_count <= 50);
}

/* Many threads that submit, cancel and collect at once. */
enum { SUBMITTERS = 4, PER_SUBMITTER = 400 };

struct storm {
    struct fixture f;
    float texels[SUBMITTERS][PER_SUBMITTER];
    atomic_uint collected[SUBMITTERS][PER_SUBMITTER];
    atomic_uint finished, succeeded;
};

struct submitter {
    struct storm *storm;
    uint32_t index;
};

static void collect_some(struct storm *storm)
{
    SluiceTileReadResult results[7];
    uint32_t count = 7;
    sluiceCollectTileReads(storm->f.loader, &count, results);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t who = (uint32_t)(results[i].userValue >> 32),
                 which = (uint32_t)results[i].userValue;
        atomic_fetch_add(&storm->collected[who][which], 1);
        if (results[i].result == SLUICE_SUCCESS &&
            storm->texels[who][which] == (float)(which % SIZE))
            atomic_fetch_add(&storm->succeeded, 1);
        else if (results[i].result != SLUICE_ERROR_CANCELED)
            atomic_fetch_add(&storm->finished, 1000000); /* seen at the end */
        atomic_fetch_add(&storm->finished, 1);
    }
}

static void *submit_many(void *argument)
{
    struct submitter *me = argument;
    struct storm *storm = me->storm;
    for (uint32_t i = 0; i < PER_SUBMITTER; i++) {
        SluiceImageRegion region = {0, i % SIZE, 0, 1, 1};
        void *place = &storm->texels[me->index][i];
        uint64_t ticket, value = (uint64_t)me->index << 32 | i;
        while (submit(&storm->f, &region, 1, &place, i % 3, value, &ticket) == SLUICE_NOT_READY)
            collect_some(storm);
        if (i % 5 == 0)
            sluiceCancelTileRead(storm->f.loader, ticket);
    }
    return NULL;
}

static void every_read_is_collected_once_whoever_submits_and_collects(void **state)
{
    (void)state;
    static struct storm storm;
    setup(&storm.f, 3, 32);
    pthread_t threads[SUBMITTERS];
    struct submitter submitters[SUBMITTERS];
    for (uint32_t i = 0; i < SUBMITTERS; i++) {
        submitters[i] = (struct submitter){&storm, i};
        assert_int_equal(pthread_create(&threads[i], NULL, submit_many, &submitters[i]), 0);
    }
    for (uint32_t i = 0; i < SUBMITTERS; i++)
        pthread_join(threads[i], NULL);
    sluiceWaitTileLoaderIdle(storm.f.loader);
    while (atomic_load(&storm.finished) < SUBMITTERS * PER_SUBMITTER)
        collect_some(&storm);
    assert_int_equal(atomic_load(&storm.finished), SUBMITTERS * PER_SUBMITTER);
    assert_true(atomic_load(&storm.succeeded) >= SUBMITTERS * PER_SUBMITTER * 4 / 5);
    for (uint32_t i = 0; i < SUBMITTERS; i++)
        for (uint32_t k = 0; k < PER_SUBMITTER; k++)
            assert_int_equal(atomic_load(&storm.collected[i][k]), 1);
    teardown(&storm.f);
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, 1, 4);
    SluiceTileLoader *loader = NULL;
    SluiceTileLoaderCreateInfo create = {.structSize = sizeof create};
    CHECK_RESULT(sluiceCreateTileLoader(NULL, &loader), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceCreateTileLoader(&create, NULL), SLUICE_ERROR_NULL_POINTER);
    SluiceImageRegion region = {0, 0, 0, 1, 1};
    float texel;
    void *place = &texel, *nowhere = NULL;
    uint64_t ticket;
    SluiceTileRead read = {&f.source.base, 1, &region, &place, 0, 0};
    CHECK_RESULT(sluiceSubmitTileRead(NULL, &read, &ticket), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceSubmitTileRead(f.loader, NULL, &ticket), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceSubmitTileRead(f.loader, &read, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(submit(&f, NULL, 1, &place, 0, 0, &ticket), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(submit(&f, &region, 1, NULL, 0, 0, &ticket), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(submit(&f, &region, 1, &nowhere, 0, 0, &ticket), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(submit(&f, &region, 0, &place, 0, 0, &ticket), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(submit(&f, &region, SLUICE_MAX_READ_REGIONS + 1, &place, 0, 0, &ticket),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    uint32_t count = 1;
    CHECK_RESULT(sluiceCollectTileReads(f.loader, NULL, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceCollectTileReads(f.loader, &count, NULL), SLUICE_ERROR_NULL_POINTER);
    sluiceDestroyTileLoader(NULL);
    teardown(&f);
}

static void creation_survives_every_refused_allocation(void **state)
{
    (void)state;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator a;
        SluiceTileLoader *loader = NULL;
        assert_true(n < 100);
        failing_allocator_init(&a, n);
        SluiceTileLoaderCreateInfo create = {sizeof create, 2, 8, &a.callbacks};
        result = sluiceCreateTileLoader(&create, &loader);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        sluiceDestroyTileLoader(loader);
        assert_int_equal(a.live_bytes, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_regions_of_a_read_are_delivered),
        cmocka_unit_test(urgent_reads_go_first_and_equal_ones_in_order),
        cmocka_unit_test(a_queued_read_that_is_canceled_is_never_begun),
        cmocka_unit_test(a_running_read_that_is_canceled_stops_between_regions),
        cmocka_unit_test(every_end_of_a_read_is_told_once_with_its_result),
        cmocka_unit_test(a_read_in_its_last_region_ends_as_if_nothing_had_been_said),
        cmocka_unit_test(capacity_counts_what_is_not_collected),
        cmocka_unit_test(reads_are_submitted_together_or_not_at_all),
        cmocka_unit_test(failures_of_the_source_reach_the_result),
        cmocka_unit_test(destroying_drops_what_waits_and_waits_for_what_runs),
        cmocka_unit_test(every_read_is_collected_once_whoever_submits_and_collects),
        cmocka_unit_test(wrong_arguments_are_refused),
        cmocka_unit_test(creation_survives_every_refused_allocation),
    };
    return RUN_TESTS(tests);
}
