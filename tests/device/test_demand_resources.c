/* Resources: a callback fills pages, shaders read the values, and each value is released once. */
#include "device/demand_runner.h"

#include "support/test.h"

#include <pthread.h>
#include <string.h>

static struct harness h;

enum { PAGES = 4000 };

/* Values that were handed out and not returned. */
struct store {
    pthread_mutex_t mutex;
    uint64_t next;
    uint64_t held[PAGES]; ///< 0: not handed out
    uint32_t fills, evictions, wrong;
    uint32_t later;        ///< number of NOT_READY results first
    uint32_t failing_page; ///< page without a value
};

static void store_init(struct store *store)
{
    *store = (struct store){.next = 1, .failing_page = UINT32_MAX};
    pthread_mutex_init(&store->mutex, NULL);
}

static void store_finish(struct store *store)
{
    for (uint32_t i = 0; i < PAGES; i++)
        assert_int_equal(store->held[i], 0);
    assert_int_equal(store->wrong, 0);
    assert_int_equal(store->fills, store->evictions);
    pthread_mutex_destroy(&store->mutex);
}

static SluiceResult fill(void *user, uint32_t page, uint64_t *value)
{
    struct store *store = user;
    SluiceResult result = SLUICE_SUCCESS;
    pthread_mutex_lock(&store->mutex);
    if (store->later) {
        store->later--;
        result = SLUICE_NOT_READY;
    } else if (page == store->failing_page) {
        result = SLUICE_ERROR_UNSUPPORTED;
    } else {
        store->wrong += page >= PAGES || store->held[page] != 0;
        *value = store->held[page] = store->next++ << 32 | page;
        store->fills++;
    }
    pthread_mutex_unlock(&store->mutex);
    return result;
}

static void evict(void *user, uint32_t page, uint64_t value)
{
    struct store *store = user;
    pthread_mutex_lock(&store->mutex);
    store->wrong += page >= PAGES || store->held[page] != value;
    store->held[page] = 0;
    store->evictions++;
    pthread_mutex_unlock(&store->mutex);
}

static SluiceDemandResourceCreateInfo describe(struct store *store, uint32_t limit)
{
    return (SluiceDemandResourceCreateInfo){.structSize = sizeof(SluiceDemandResourceCreateInfo),
                                            .pageCount = PAGES,
                                            .rank = 3,
                                            .maxResidentPageCount = limit,
                                            .pUserData = store,
                                            .pfnFill = fill,
                                            .pfnEvict = evict};
}

static void check_value(const struct runner *r, const struct store *store, uint32_t sample,
                        uint32_t page)
{
    struct RunnerOutput out = runner_output(r, sample);
    assert_true(out.resident);
    assert_int_equal((uint64_t)out.value[1] << 32 | out.value[0], store->held[page]);
}

static void shaders_get_what_the_callback_says(void **state)
{
    (void)state;
    struct runner r;
    struct store store;
    SluiceDemandResourceId id;
    uint32_t first;
    store_init(&store);
    runner_init(&r, &h, NULL);
    const SluiceDemandResourceCreateInfo info = describe(&store, 0);
    CHECK_OK(sluiceAddDemandResource(r.loader, &info, &id, &first));
    const uint32_t pages[] = {0, 1, 31, 32, 1023, 1024, PAGES - 1};
    for (uint32_t i = 0; i < 7; i++)
        runner_add_page(&r, first + pages[i]);
    assert_int_equal(runner_load(&r, 9), 2);
    for (uint32_t i = 0; i < 7; i++)
        check_value(&r, &store, i, pages[i]);
    assert_int_equal(store.fills, 7);
    assert_int_equal(runner_statistics(&r).residentResourcePageCount, 7);
    /* Some have changed. */
    CHECK_OK(sluiceInvalidateDemandPages(r.loader, id, 31, 2));
    CHECK_RESULT(sluiceInvalidateDemandPages(r.loader, id, PAGES - 1, 2),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    runner_load(&r, 9);
    assert_int_equal(store.fills, 9);
    assert_int_equal(store.evictions, 2);
    for (uint32_t i = 0; i < 7; i++)
        check_value(&r, &store, i, pages[i]);
    runner_finish(&r);
    store_finish(&store);
}

static void values_beyond_the_limit_go_once_and_when_no_launch_reads_them(void **state)
{
    (void)state;
    enum { LIMIT = 100 };
    struct runner r;
    struct store store;
    SluiceDemandResourceId id;
    uint32_t first;
    store_init(&store);
    runner_init(&r, &h, NULL);
    const SluiceDemandResourceCreateInfo info = describe(&store, LIMIT);
    CHECK_OK(sluiceAddDemandResource(r.loader, &info, &id, &first));
    for (uint32_t round = 0; round < 30; round++) {
        runner_clear(&r);
        for (uint32_t i = 0; i < LIMIT * 3 / 4; i++)
            runner_add_page(&r, first + (round * 37 + i * 3) % PAGES);
        runner_load(&r, 9);
        for (uint32_t i = 0; i < LIMIT * 3 / 4; i++)
            check_value(&r, &store, i, (round * 37 + i * 3) % PAGES);
        assert_true(runner_statistics(&r).residentResourcePageCount <= LIMIT);
        /* Values that a launch in flight may use are not released yet. All others are. */
        assert_true(store.fills - store.evictions <= 2 * LIMIT);
    }
    assert_true(store.evictions > 0);
    runner_finish(&r);
    store_finish(&store);
}

static void a_destroyed_resource_gets_all_values_back_after_the_launches(void **state)
{
    (void)state;
    struct runner r;
    struct store store;
    SluiceDemandResourceId id, next;
    uint32_t first, second;
    store_init(&store);
    runner_init(&r, &h, NULL);
    SluiceDemandResourceCreateInfo info = describe(&store, 0);
    CHECK_OK(sluiceAddDemandResource(r.loader, &info, &id, &first));
    for (uint32_t i = 0; i < 50; i++)
        runner_add_page(&r, first + i);
    runner_load(&r, 9);
    CHECK_OK(runner_submit(&r));
    CHECK_OK(sluiceRemoveDemandResource(r.loader, id));
    CHECK_RESULT(sluiceRemoveDemandResource(r.loader, id), SLUICE_ERROR_STALE_TEXTURE);
    CHECK_RESULT(sluiceInvalidateDemandPages(r.loader, id, 0, 1), SLUICE_ERROR_STALE_TEXTURE);
    assert_int_equal(store.evictions, 0); /* a launch reads them */
    CHECK_OK(sluiceProcessDemandRequests(r.loader, &r.launch, UINT64_MAX, &r.requests, NULL));
    assert_int_equal(store.evictions, 50);
    CHECK_OK(sluiceAddDemandResource(r.loader, &info, &next, &second));
    assert_true(next != id);
    runner_clear(&r);
    runner_add_page(&r, second + 49);
    runner_load(&r, 9);
    check_value(&r, &store, 0, 49);
    info.pageCount = 0;
    CHECK_RESULT(sluiceAddDemandResource(r.loader, &info, &id, &first),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    info.pageCount = 1u << 30;
    CHECK_RESULT(sluiceAddDemandResource(r.loader, &info, &id, &first),
                 SLUICE_ERROR_LIMIT_EXCEEDED);
    runner_finish(&r);
    store_finish(&store);
}

static void later_is_asked_again_and_what_fails_is_told(void **state)
{
    (void)state;
    struct runner r;
    struct store store;
    SluiceDemandResourceId id;
    uint32_t first;
    store_init(&store);
    store.later = 7;
    store.failing_page = 11;
    CHECK_OK(harness_set_context(&h, &(SluiceVulkanContextCreateInfo){.readRetry = {2, 1, 1}}));
    runner_init(&r, &h, NULL);
    const SluiceDemandResourceCreateInfo info = describe(&store, 0);
    CHECK_OK(sluiceAddDemandResource(r.loader, &info, &id, &first));
    runner_add_page(&r, first + 10);
    assert_in_range(runner_load(&r, 20), 5, 5); /* 2 + 2 + 2 + 2 attempts, and a query */
    check_value(&r, &store, 0, 10);
    runner_clear(&r);
    runner_add_page(&r, first + 11);
    h.quiet = true;
    assert_in_range(runner_load(&r, 9), 2, 3); /* otherwise applications would launch forever */
    h.quiet = false;
    assert_false(runner_output(&r, 0).resident);
    assert_int_equal(r.requests.refusedCount, 1);
    runner_finish(&r);
    store_finish(&store);
    CHECK_OK(harness_set_context(&h, NULL));
}

static void resources_are_served_by_rank_and_before_finer_tiles(void **state)
{
    (void)state;
    struct runner r;
    struct store stores[2];
    SluiceDemandResourceId id;
    uint32_t first[2];
    const SluiceDemandLoaderCreateInfo create = {.structSize = sizeof create,
                                                 .maxRequestsPerLaunch = 10};
    runner_init(&r, &h, &create);
    for (uint32_t i = 0; i < 2; i++) {
        store_init(&stores[i]);
        SluiceDemandResourceCreateInfo info = describe(&stores[i], 0);
        info.rank = i ? 2 : 9;
        CHECK_OK(sluiceAddDemandResource(r.loader, &info, &id, &first[i]));
        for (uint32_t p = 0; p < 10; p++)
            runner_add_page(&r, first[i] + p);
    }
    runner_launch(&r);
    assert_int_equal(r.requests.missingCount, 20);
    assert_int_equal(r.requests.servedCount, 10);
    assert_int_equal(r.requests.postponedCount, 10);
    CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    assert_int_equal(stores[0].fills, 0);
    assert_int_equal(stores[1].fills, 10);
    runner_load(&r, 9);
    assert_int_equal(stores[0].fills, 10);
    runner_finish(&r);
    for (uint32_t i = 0; i < 2; i++)
        store_finish(&stores[i]);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shaders_get_what_the_callback_says),
        cmocka_unit_test(values_beyond_the_limit_go_once_and_when_no_launch_reads_them),
        cmocka_unit_test(a_destroyed_resource_gets_all_values_back_after_the_launches),
        cmocka_unit_test(later_is_asked_again_and_what_fails_is_told),
        cmocka_unit_test(resources_are_served_by_rank_and_before_finer_tiles),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
