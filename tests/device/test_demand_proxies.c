/* Proxies in launches of a demand loader: requests, their time, and reuse of indices. Shaders miss
 * pages as in proxy.glsl. */
#include "device/demand_runner.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/replay.h>
#include <sluice/vulkan_proxy.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct harness h;

enum { MOST = 5000 };

struct app {
    struct runner r;
    SluiceProxySet *set;
    SluiceDemandResourceId resource;
    uint32_t first_page;
    SluiceProxyId ids[MOST];
};

static void app_init(struct app *app, uint32_t count, uint32_t requests_per_launch)
{
    const SluiceDemandLoaderCreateInfo loader = {.structSize = sizeof loader,
                                                 .maxRequestsPerLaunch = requests_per_launch};
    const SluiceProxySetCreateInfo set = {
        .structSize = sizeof set, .kind = SLUICE_PROXY_KIND_MATERIAL, .maxProxyCount = MOST};
    runner_init(&app->r, &h, &loader);
    CHECK_OK(sluiceCreateProxySet(&set, &app->set));
    CHECK_OK(sluiceAddDemandProxies(app->r.loader, app->set, 3, &app->resource, &app->first_page));
    for (uint32_t i = 0; i < count; i++)
        CHECK_OK(sluiceAddMaterialProxy(app->set, &app->ids[i]));
}

static void app_finish(struct app *app)
{
    runner_finish(&app->r);
    sluiceDestroyProxySet(app->set);
}

static void hit(struct app *app, uint32_t count, const uint32_t *indices)
{
    runner_clear(&app->r);
    for (uint32_t i = 0; i < count; i++)
        runner_add_page(&app->r, app->first_page + indices[i]);
}

static void process(struct app *app)
{
    CHECK_OK(sluiceProcessDemandProxies(app->r.loader, app->resource, app->set));
}

static void launch(struct app *app)
{
    runner_launch(&app->r);
    process(app);
}

static void check_requested(const struct app *app, uint32_t count, const uint32_t *indices)
{
    SluiceProxyId listed[16];
    uint32_t n = 16;
    CHECK_OK(sluiceGetRequestedProxies(app->set, NULL, &n, listed));
    assert_int_equal(n, count);
    for (uint32_t i = 0; i < count; i++)
        assert_true(listed[i] == app->ids[indices[i]]);
}

static uint32_t requested_count(const struct app *app)
{
    SluiceProxySetInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetProxySetInfo(app->set, &info));
    return info.requestedCount;
}

static void hit_proxies_are_requested_once_and_again_after_clearing(void **state)
{
    (void)state;
    static const uint32_t hits[] = {7, 3, 7, 7, 0, 3}, sorted[] = {0, 3, 7};
    struct app app;
    app_init(&app, 10, 0);
    hit(&app, 6, hits);
    launch(&app);
    assert_int_equal(app.r.requests.missingCount, 3);
    check_requested(&app, 3, sorted);
    CHECK_OK(sluiceClearProxyRequests(app.set, SLUICE_ALL_PROXIES));
    check_requested(&app, 0, NULL);
    launch(&app); /* they are still hit */
    assert_int_equal(app.r.requests.missingCount, 3);
    check_requested(&app, 3, sorted);
    CHECK_OK(sluiceRemoveProxy(app.set, app.ids[3]));
    hit(&app, 0, NULL);
    launch(&app);
    assert_int_equal(app.r.requests.missingCount, 0);
    check_requested(&app, 2, (const uint32_t[]){0, 7}); /* until they are removed or cleared */
    app_finish(&app);
}

static void requests_beyond_the_list_come_back_next_launch(void **state)
{
    (void)state;
    enum { COUNT = 3000, LIST = 100 };
    static uint32_t all[COUNT];
    struct app app;
    for (uint32_t i = 0; i < COUNT; i++)
        all[i] = i;
    app_init(&app, COUNT, LIST);
    hit(&app, COUNT, all);
    launch(&app);
    assert_int_equal(app.r.requests.missingCount, COUNT);
    assert_int_equal(requested_count(&app), LIST);
    /* Listed proxies are built, and later launches do not hit them. */
    hit(&app, 0, NULL);
    for (uint32_t at = LIST; at < COUNT; at += LIST) {
        launch(&app);
        assert_int_equal(requested_count(&app), at + LIST);
    }
    launch(&app);
    assert_int_equal(app.r.requests.missingCount, 0);
    app_finish(&app);
}

static void a_request_of_a_launch_under_way_is_ignored_after_removal(void **state)
{
    (void)state;
    static const uint32_t hits[] = {1, 2};
    struct app app;
    app_init(&app, 3, 0);
    hit(&app, 2, hits);
    CHECK_OK(runner_submit(&app.r));
    CHECK_OK(sluiceRemoveProxy(app.set, app.ids[1]));
    CHECK_OK(sluiceProcessDemandRequests(app.r.loader, &app.r.launch, UINT64_MAX, &app.r.requests,
                                         NULL));
    process(&app);
    check_requested(&app, 1, hits + 1);
    app_finish(&app);
}

static uint32_t add(struct app *app)
{
    SluiceProxyId id;
    CHECK_OK(sluiceAddMaterialProxy(app->set, &id));
    app->ids[(uint32_t)id] = id;
    return (uint32_t)id;
}

static void an_index_is_reused_when_no_launch_can_name_the_old_material(void **state)
{
    (void)state;
    static const uint32_t one = 1;
    struct app app;
    app_init(&app, 3, 0);
    hit(&app, 1, &one);
    CHECK_OK(runner_submit(&app.r));
    SluiceDemandLaunch first = app.r.launch;
    CHECK_OK(runner_submit(&app.r)); /* both hit the old proxy */
    CHECK_OK(sluiceRemoveProxy(app.set, app.ids[1]));
    CHECK_OK(sluiceProcessDemandRequests(app.r.loader, &first, UINT64_MAX, &app.r.requests, NULL));
    process(&app);
    assert_int_equal(add(&app), 3); /* the second launch is in flight */
    CHECK_OK(sluiceProcessDemandRequests(app.r.loader, &app.r.launch, UINT64_MAX, &app.r.requests,
                                         NULL));
    process(&app);
    assert_int_equal(add(&app), 1);
    check_requested(&app, 0, NULL);
    launch(&app);
    check_requested(&app, 1, &one);
    app_finish(&app);
}

static void a_request_that_waits_in_its_bit_does_not_reach_the_next_proxy(void **state)
{
    (void)state;
    enum { COUNT = 3000, LIST = 1100 };
    static uint32_t all[COUNT];
    static const uint32_t last = COUNT - 1;
    struct app app;
    for (uint32_t i = 0; i < COUNT; i++)
        all[i] = i;
    app_init(&app, COUNT, LIST);
    hit(&app, COUNT, all);
    launch(&app); /* the last one is not listed */
    assert_int_equal(requested_count(&app), LIST);
    CHECK_OK(sluiceRemoveProxy(app.set, app.ids[last]));
    hit(&app, 0, NULL);
    for (uint32_t i = 0; i < 2; i++) {
        process(&app);
        assert_int_equal(add(&app), COUNT + i); /* its bit is still set */
        launch(&app);
    }
    assert_int_equal(add(&app), last);
    launch(&app);
    assert_int_equal(requested_count(&app), COUNT - 1);
    app_finish(&app);
}

static void other_resources_and_sets_are_refused(void **state)
{
    (void)state;
    const SluiceDemandResourceCreateInfo bytes = {
        .structSize = sizeof bytes, .pageCount = MOST, .pageSize = 16};
    const SluiceProxySetCreateInfo small = {.structSize = sizeof small, .maxProxyCount = MOST - 1};
    const SluiceProxySetCreateInfo huge = {.structSize = sizeof huge, .maxProxyCount = INT32_MAX};
    SluiceDemandResourceId id;
    SluiceProxySet *set;
    uint32_t first;
    struct app app;
    app_init(&app, 1, 0);
    CHECK_OK(sluiceAddDemandResource(app.r.loader, &bytes, &id, &first));
    CHECK_OK(sluiceCreateProxySet(&small, &set));
    h.quiet = true;
    CHECK_RESULT(sluiceProcessDemandProxies(app.r.loader, id, app.set),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceProcessDemandProxies(app.r.loader, app.resource, set),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(h.last_message, "pageCount is 5000"));
    h.quiet = false;
    sluiceDestroyProxySet(set);
    CHECK_OK(sluiceCreateProxySet(&huge, &set));
    CHECK_RESULT(sluiceAddDemandProxies(app.r.loader, set, 0, &id, &first),
                 SLUICE_ERROR_LIMIT_EXCEEDED);
    sluiceDestroyProxySet(set);
    CHECK_OK(sluiceRemoveDemandResource(app.r.loader, app.resource));
    CHECK_RESULT(sluiceProcessDemandProxies(app.r.loader, app.resource, app.set),
                 SLUICE_ERROR_STALE_TEXTURE);
    app_finish(&app);
}

static void geometry_describes_the_boxes_of_a_set(void **state)
{
    (void)state;
    struct failing_allocator allocator;
    failing_allocator_init(&allocator, UINT64_MAX);
    const SluiceProxySetCreateInfo info = {.structSize = sizeof info,
                                           .pAllocator = &allocator.callbacks};
    const SluiceProxyBox box = {{0, 0, 0}, {1, 1, 1}};
    SluiceProxyGeometry geometry = {.structSize = sizeof geometry};
    SluiceProxySet *set;
    SluiceProxyId ids[3];
    struct app app;
    app_init(&app, 1, 0);
    CHECK_RESULT(sluiceGetProxyGeometry(app.set, 64, &geometry), SLUICE_ERROR_INVALID_ARGUMENT);
    app_finish(&app);
    CHECK_OK(sluiceCreateProxySet(&info, &set));
    CHECK_OK(sluiceGetProxyGeometry(set, 0, &geometry));
    assert_int_equal(geometry.range.primitiveCount, 0);
    for (uint32_t i = 0; i < 3; i++)
        CHECK_OK(sluiceAddGeometryProxy(set, &box, &ids[i]));
    CHECK_OK(sluiceRemoveProxy(set, ids[0]));
    allocator.refuse_from = allocator.calls; /* it takes no memory */
    CHECK_RESULT(sluiceGetProxyGeometry(set, 0, &geometry), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceGetProxyGeometry(set, 68, &geometry), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_OK(sluiceGetProxyGeometry(set, 64, &geometry));
    assert_int_equal(geometry.range.primitiveCount, 3);
    assert_int_equal(geometry.geometry.geometry.aabbs.stride, sizeof(VkAabbPositionsKHR));
    sluiceDestroyProxySet(set);
}

static const char path[] = "test_demand_proxies.trace";

/* Runs launches that hit a moving window of proxies. Some are removed and added. */
static uint64_t run(struct app *app)
{
    uint64_t hash = 14695981039346656037u;
    for (uint32_t step = 0; step < 20; step++) {
        uint32_t hits[60];
        SluiceProxyId listed[16];
        uint32_t n = 16;
        for (uint32_t i = 0; i < 60; i++)
            hits[i] = (step * 17 + i * 3) % 250;
        hit(app, 60, hits);
        launch(app);
        SluiceResult result = sluiceGetRequestedProxies(app->set, NULL, &n, listed);
        assert_true(result >= 0);
        for (uint32_t i = 0; i < n; i++) {
            hash = (hash ^ listed[i]) * 1099511628211u;
            CHECK_OK(sluiceRemoveProxy(app->set, listed[i]));
        }
        if (step % 3 == 0)
            add(app);
    }
    return hash;
}

static SluiceReplayResult replay(void)
{
    SluiceReplayResult replayed = {.structSize = sizeof replayed};
    static uint8_t data[1 << 20];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const SluiceReplayInfo info = {
        .structSize = sizeof info, .pData = data, .size = fread(data, 1, sizeof data, file)};
    fclose(file);
    remove(path);
    CHECK_OK(sluiceReplay(&info, &replayed));
    return replayed;
}

static void requests_of_proxies_are_recorded_and_replayed(void **state)
{
    (void)state;
    struct app app;
    SluiceRecorder *recorder;
    uint64_t hashes[2];
    const SluiceFileRecordingInfo recording = {.structSize = sizeof recording, .pPath = path};
    for (uint32_t round = 0; round < 2; round++) { /* and twice the same */
        h.abandon_one_in = round ? 5 : 0;
        app_init(&app, 250, 40);
        CHECK_OK(sluiceBeginDemandRecording(app.r.loader, &recording, &recorder));
        hashes[round] = run(&app);
        CHECK_OK(sluiceEndRecording(recorder));
        app_finish(&app);
        SluiceReplayResult replayed = replay();
        assert_int_equal(replayed.divergedEvent, 0);
        assert_true(replayed.decisionHash == replayed.recordedHash);
        assert_int_equal(replayed.demand.launchCount, 20);
    }
    h.abandon_one_in = 0;
    assert_true(hashes[0] == hashes[1]);
}

static void without_host_memory_requests_come_with_a_later_launch(void **state)
{
    (void)state;
    enum { COUNT = 70 };
    uint32_t hits[COUNT];
    uint64_t refuse_from = 0;
    for (bool done = false; !done; refuse_from += 1 + refuse_from / 2) {
        struct failing_allocator allocator;
        struct app app;
        SluiceVulkanContextCreateInfo context = harness_context_info(&h);
        failing_allocator_init(&allocator, UINT64_MAX);
        context.pAllocator = &allocator.callbacks;
        CHECK_OK(harness_set_context(&h, &context));
        app_init(&app, COUNT, 0);
        for (uint32_t i = 0; i < COUNT; i++)
            hits[i] = i;
        hit(&app, COUNT, hits);
        CHECK_OK(runner_submit(&app.r));
        uint64_t before = allocator.calls;
        allocator.refuse_from = before + refuse_from;
        SluiceResult result = sluiceProcessDemandRequests(app.r.loader, &app.r.launch, UINT64_MAX,
                                                          &app.r.requests, NULL);
        done = allocator.calls <= before + refuse_from;
        if (result == SLUICE_SUCCESS)
            process(&app); /* allocates nothing */
        allocator.refuse_from = UINT64_MAX;
        for (uint32_t i = 0; i < 3 && requested_count(&app) < COUNT; i++)
            launch(&app);
        assert_int_equal(requested_count(&app), COUNT);
        app_finish(&app);
        CHECK_OK(harness_set_context(&h, NULL));
    }
    assert_true(refuse_from > 3);
}

static void pages_for_proxies_without_host_memory_are_refused(void **state)
{
    (void)state;
    struct failing_allocator allocator;
    struct app app;
    SluiceDemandResourceId id;
    uint32_t first, refused = 0;
    SluiceVulkanContextCreateInfo context = harness_context_info(&h);
    failing_allocator_init(&allocator, UINT64_MAX);
    context.pAllocator = &allocator.callbacks;
    CHECK_OK(harness_set_context(&h, &context));
    app_init(&app, 1, 0);
    for (uint32_t i = 0; i < 40; i++) { /* until a table must grow */
        allocator.refuse_from = allocator.calls;
        SluiceResult result = sluiceAddDemandProxies(app.r.loader, app.set, 0, &id, &first);
        allocator.refuse_from = UINT64_MAX;
        refused += result == SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        if (result != SLUICE_SUCCESS)
            CHECK_OK(sluiceAddDemandProxies(app.r.loader, app.set, 0, &id, &first));
    }
    assert_true(refused > 0);
    app_finish(&app);
    CHECK_OK(harness_set_context(&h, NULL));
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hit_proxies_are_requested_once_and_again_after_clearing),
        cmocka_unit_test(requests_beyond_the_list_come_back_next_launch),
        cmocka_unit_test(a_request_of_a_launch_under_way_is_ignored_after_removal),
        cmocka_unit_test(an_index_is_reused_when_no_launch_can_name_the_old_material),
        cmocka_unit_test(a_request_that_waits_in_its_bit_does_not_reach_the_next_proxy),
        cmocka_unit_test(other_resources_and_sets_are_refused),
        cmocka_unit_test(geometry_describes_the_boxes_of_a_set),
        cmocka_unit_test(requests_of_proxies_are_recorded_and_replayed),
        cmocka_unit_test(pages_for_proxies_without_host_memory_are_refused),
        cmocka_unit_test(without_host_memory_requests_come_with_a_later_launch),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
