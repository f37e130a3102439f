/* Sources that stall, bounds on what is under way, canceling and destroying meanwhile. */
#define _POSIX_C_SOURCE 200809L

#include <sluice/loader.h>

#include "image/loader_fixture.h"
#include "support/test.h"

#include <sched.h>

enum { NEVER_NS_SHIFT = 62 };

static void a_stalled_source_keeps_only_its_share_of_the_threads(void **state)
{
    (void)state;
    enum { COUNT = 20 };
    struct loader_fixture f;
    struct fault_source other;
    float stalled[COUNT], texels[COUNT];
    fixture_init(&f, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                                  .threadCount = 3}); /* two for a source */
    fault_source_init(&other, f.inner);
    f.source.holds = true;
    for (uint32_t i = 0; i < COUNT; i++)
        fixture_submit(&f, &f.source, i, &stalled[i], 9); /* also more urgent */
    fault_source_await(&f.source, 2);
    for (uint32_t i = 0; i < COUNT; i++)
        fixture_submit(&f, &other, i, &texels[i], 0);
    for (uint32_t i = 0; i < COUNT; i++) {
        SluiceTileReadResult result = fixture_collect(&f);
        CHECK_OK(result.result);
        assert_int_equal(result.userValue, i);
        assert_true(texels[i] == (float)i);
    }
    assert_int_equal(f.source.read_count, 2);
    assert_int_equal(fixture_statistics(&f, &f.source).readCount, COUNT);
    assert_int_equal(fixture_statistics(&f, &f.source).attemptCount, 0);
    fault_source_release(&f.source);
    for (uint32_t i = 0; i < COUNT; i++)
        CHECK_OK(fixture_collect(&f).result);
    assert_int_equal(f.source.most_running, 2);
    fixture_finish(&f);
    fault_source_finish(&other);
}

static void a_stalled_source_does_not_stop_a_loader_with_default_threads(void **state)
{
    (void)state;
    struct loader_fixture f;
    struct fault_source other;
    SluiceTileLoaderCreateInfo create = {.structSize = sizeof create};
    float texels[2] = {-1, -1};
    fixture_init(&f,
                 (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo)});
    fault_source_init(&other, f.inner);
    fixture_replace_loader(&f, &create);
    f.source.holds = true;
    fixture_submit(&f, &f.source, 0, &texels[0], 1);
    fault_source_await(&f.source, 1);
    fixture_submit(&f, &other, 1, &texels[1], 0);
    CHECK_OK(fixture_collect(&f).result);
    assert_true(texels[1] == 1);
    fault_source_release(&f.source);
    CHECK_OK(fixture_collect(&f).result);
    fixture_finish(&f);
    fault_source_finish(&other);
}

static void bytes_in_flight_are_bounded(void **state)
{
    (void)state;
    enum { COUNT = 300, ROW = 8 };
    static float texels[COUNT][ROW];
    struct loader_fixture f;
    fixture_init(&f, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                                  .threadCount = 4,
                                                  .maxReadsPerSource = 4,
                                                  .maxBytesInFlight = 2 * ROW * 4 + 1});
    for (uint32_t i = 0; i < COUNT; i++) {
        SluiceImageRegion region = {0, 0, i % FIXTURE_SIZE, ROW, 1};
        void *place = texels[i];
        uint64_t ticket;
        SluiceTileRead read = {&f.source.base, 1, &region, &place, 0, i};
        CHECK_OK(sluiceSubmitTileRead(f.loader, &read, &ticket));
    }
    sluiceWaitTileLoaderIdle(f.loader);
    assert_true(f.source.most_running >= 1 && f.source.most_running <= 2);
    for (uint32_t i = 0; i < COUNT; i++)
        CHECK_OK(fixture_collect(&f).result);
    assert_int_equal(fixture_statistics(&f, NULL).byteCount, COUNT * ROW * 4);
    fixture_finish(&f);
}

/* A read that is larger than the bound is not refused: it waits until it is alone. */
static void a_read_beyond_the_bound_is_made_alone(void **state)
{
    (void)state;
    enum { COUNT = 50 };
    static float texels[COUNT][FIXTURE_SIZE];
    struct loader_fixture f;
    fixture_init(&f, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                                  .threadCount = 3,
                                                  .maxReadsPerSource = 3,
                                                  .maxBytesInFlight = 1});
    for (uint32_t i = 0; i < COUNT; i++) {
        SluiceImageRegion region = {0, 0, i, FIXTURE_SIZE, 1};
        void *place = texels[i];
        uint64_t ticket;
        SluiceTileRead read = {&f.source.base, 1, &region, &place, 0, i};
        CHECK_OK(sluiceSubmitTileRead(f.loader, &read, &ticket));
    }
    sluiceWaitTileLoaderIdle(f.loader);
    assert_int_equal(f.source.most_running, 1);
    for (uint32_t i = 0; i < COUNT; i++)
        assert_true(texels[i][5] == (float)(i * FIXTURE_SIZE + 5));
    fixture_finish(&f);
}

static void wait_until_delayed(struct loader_fixture *f, uint64_t count)
{
    while (fixture_statistics(f, &f->source).delayedCount < count)
        sched_yield();
}

static void a_read_that_waits_for_another_attempt_can_be_canceled(void **state)
{
    (void)state;
    struct loader_fixture f;
    float texels[2] = {-1, -1};
    uint64_t never = (uint64_t)1 << NEVER_NS_SHIFT;
    fixture_init(&f, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                                  .retry = {4, never, never}});
    f.source.fail_at = 1;
    f.source.failure = SLUICE_ERROR_IO;
    uint64_t ticket = fixture_submit(&f, &f.source, 1, &texels[0], 0);
    wait_until_delayed(&f, 1);
    fixture_submit(&f, &f.source, 2, &texels[1], 0); /* others are not held up */
    CHECK_OK(fixture_collect(&f).result);
    sluiceCancelTileRead(f.loader, ticket);
    SluiceTileReadResult result = fixture_collect(&f);
    assert_int_equal(result.ticket, ticket);
    CHECK_RESULT(result.result, SLUICE_ERROR_CANCELED);
    sluiceWaitTileLoaderIdle(f.loader);
    assert_int_equal(f.source.read_count, 2);
    SluiceTileLoaderStatistics s = fixture_statistics(&f, &f.source);
    assert_true(s.canceledCount == 1 && s.delayedCount == 0 && s.retriedCount == 1);
    assert_true(s.givenUpCount == 0 && s.succeededCount == 1);
    fixture_finish(&f);
}

static void a_read_that_is_canceled_while_it_fails_is_not_tried_again(void **state)
{
    (void)state;
    struct loader_fixture f;
    float texel;
    fixture_init(&f,
                 (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo)});
    f.source.fail_at = 1;
    f.source.fails_on = true;
    f.source.failure = SLUICE_ERROR_IO;
    f.source.holds = true;
    f.cancels = true;
    pthread_mutex_lock(&f.mutex);
    f.ticket = fixture_submit(&f, &f.source, 1, &texel, 0);
    pthread_mutex_unlock(&f.mutex);
    fault_source_release(&f.source);
    CHECK_RESULT(fixture_collect(&f).result, SLUICE_ERROR_CANCELED);
    assert_int_equal(f.source.read_count, 1);
    SluiceTileLoaderStatistics s = fixture_statistics(&f, NULL);
    assert_true(s.failedCount == 1 && s.retriedCount == 0 && s.canceledCount == 1);
    fixture_finish(&f);
}

static void destroying_does_not_wait_for_other_attempts(void **state)
{
    (void)state;
    enum { COUNT = 5 };
    struct loader_fixture f;
    float texels[COUNT];
    uint64_t never = (uint64_t)1 << NEVER_NS_SHIFT;
    fixture_init(&f, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                                  .threadCount = 2,
                                                  .retry = {4, never, never}});
    f.source.fail_at = 1;
    f.source.fails_on = true;
    f.source.failure = SLUICE_ERROR_IO;
    for (uint32_t i = 0; i < COUNT; i++)
        fixture_submit(&f, &f.source, i, &texels[i], 0);
    wait_until_delayed(&f, COUNT);
    struct fault_source *source = &f.source;
    fixture_finish(&f); /* in less than a century */
    assert_int_equal(source->read_count, COUNT);
}

/* Holds its worker until the loader is being destroyed and everything else is dropped. */
static void hold_until_dropped(void *user, const SluiceTileReadFailure *failure)
{
    struct loader_fixture *f = user;
    pthread_mutex_lock(&f->mutex);
    SluiceTileLoader *loader = f->loader;
    pthread_mutex_unlock(&f->mutex);
    SluiceTileLoaderStatistics s = {.structSize = sizeof s};
    assert_true(failure->willRetry);
    while (s.canceledCount != failure->userValue) {
        CHECK_OK(sluiceGetTileLoaderStatistics(loader, NULL, &s));
        sched_yield();
    }
}

static void destroying_drops_all_but_what_is_under_way(void **state)
{
    (void)state;
    enum { OTHERS = 30 };
    struct loader_fixture f;
    float texels[OTHERS + 1];
    fixture_init(&f,
                 (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo)});
    SluiceTileLoaderCreateInfo create = {.structSize = sizeof create,
                                         .threadCount = 1,
                                         .retry = {4, 1, 1},
                                         .failure = {&f, hold_until_dropped}};
    fixture_replace_loader(&f, &create);
    f.source.fail_at = 1;
    f.source.fails_on = true;
    f.source.failure = SLUICE_ERROR_IO;
    fixture_submit(&f, &f.source, OTHERS, &texels[OTHERS],
                   1); /* its value says how many to wait for */
    for (uint32_t i = 0; i < OTHERS; i++)
        fixture_submit(&f, &f.source, i, &texels[i], 0);
    struct fault_source *source = &f.source;
    while (atomic_load(&source->read_count) == 0)
        sched_yield();
    fixture_finish(&f);
    assert_int_equal(source->read_count, 1); /* nor was that one tried again */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stalled_source_keeps_only_its_share_of_the_threads),
        cmocka_unit_test(a_stalled_source_does_not_stop_a_loader_with_default_threads),
        cmocka_unit_test(bytes_in_flight_are_bounded),
        cmocka_unit_test(a_read_beyond_the_bound_is_made_alone),
        cmocka_unit_test(a_read_that_waits_for_another_attempt_can_be_canceled),
        cmocka_unit_test(a_read_that_is_canceled_while_it_fails_is_not_tried_again),
        cmocka_unit_test(destroying_does_not_wait_for_other_attempts),
        cmocka_unit_test(destroying_drops_all_but_what_is_under_way),
    };
    return RUN_TESTS(tests);
}
