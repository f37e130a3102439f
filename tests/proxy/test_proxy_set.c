/* Proxies come, are requested, and go. The first tests are what goes wrong elsewhere. */
#include "proxy/proxy_set.h"

#include "proxy/naive_set.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include "demand/random.h"

#include <stdlib.h>
#include <string.h>

static const SluiceProxyBox unit = {{0, 0, 0}, {1, 1, 1}};

static SluiceProxySet *create(SluiceProxyKind kind, uint32_t max_count)
{
    SluiceProxySet *set;
    const SluiceProxySetCreateInfo info = {
        .structSize = sizeof info, .kind = kind, .maxProxyCount = max_count};
    CHECK_OK(sluiceCreateProxySet(&info, &set));
    return set;
}

static SluiceProxyId add(SluiceProxySet *set)
{
    SluiceProxyId id;
    CHECK_OK(sluiceAddGeometryProxy(set, &unit, &id));
    return id;
}

static void request(SluiceProxySet *set, uint64_t begun, uint64_t processed, uint32_t count,
                    const uint32_t *indices)
{
    const SluiceProxyRequests requests = {.structSize = sizeof requests,
                                          .begunLaunch = begun,
                                          .processedLaunch = processed,
                                          .indexCount = count,
                                          .pIndices = indices};
    CHECK_OK(sluiceAddProxyRequests(set, &requests));
}

static SluiceProxySetInfo info_of(const SluiceProxySet *set)
{
    SluiceProxySetInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetProxySetInfo(set, &info));
    return info;
}

static void check_requested(const SluiceProxySet *set, uint32_t count, const SluiceProxyId *ids)
{
    SluiceProxyId listed[16];
    uint32_t n = 16;
    CHECK_OK(sluiceGetRequestedProxies(set, NULL, &n, listed));
    assert_int_equal(n, count);
    assert_memory_equal(listed, ids, count * sizeof *ids);
    assert_int_equal(info_of(set).requestedCount, count);
}

static void clearing_requests_frees_no_id_in_use(void **state)
{
    (void)state;
    static const uint32_t all[] = {2, 0, 1, 1, 2};
    SluiceProxySet *set = create(SLUICE_PROXY_KIND_GEOMETRY, 0);
    SluiceProxyId ids[] = {add(set), add(set), add(set)};
    request(set, 1, 1, 5, all);
    check_requested(set, 3, ids); /* each once */
    check_requested(set, 3, ids); /* and again */
    CHECK_OK(sluiceClearProxyRequests(set, ids[0]));
    check_requested(set, 2, ids + 1);
    CHECK_OK(sluiceClearProxyRequests(set, SLUICE_ALL_PROXIES));
    check_requested(set, 0, NULL);
    assert_int_equal(info_of(set).proxyCount, 3);
    request(set, 9, 9, 0, NULL);
    assert_int_equal((uint32_t)add(set), 3); /* no index of the three */
    request(set, 10, 10, 3, all);
    check_requested(set, 3, ids); /* later launches hit them again */
    sluiceDestroyProxySet(set);
}

static void reused_indices_are_found_and_old_ids_are_not(void **state)
{
    (void)state;
    SluiceProxySet *set = create(SLUICE_PROXY_KIND_GEOMETRY, 0);
    SluiceProxyId ids[4];
    SluiceProxyBox box;
    for (uint32_t i = 0; i < 4; i++)
        ids[i] = add(set);
    CHECK_OK(sluiceRemoveProxy(set, ids[2]));
    CHECK_OK(sluiceRemoveProxy(set, ids[0]));
    request(set, 1, 1, 0, NULL);
    SluiceProxyId first = add(set), second = add(set);
    assert_true((uint32_t)first == 0 && (uint32_t)second == 2); /* the lowest one first */
    assert_true(first != ids[0] && second != ids[2]);
    CHECK_RESULT(sluiceGetProxyBox(set, ids[0], &box), SLUICE_ERROR_STALE_TEXTURE);
    CHECK_RESULT(sluiceRemoveProxy(set, ids[2]), SLUICE_ERROR_STALE_TEXTURE);
    CHECK_OK(sluiceGetProxyBox(set, first, &box));
    for (uint32_t i = 0; i < 4; i++)
        CHECK_OK(sluiceGetProxyBox(set, i == 0 ? first : i == 2 ? second : ids[i], &box));
    sluiceDestroyProxySet(set);
}

static void removing_twice_is_an_error_result(void **state)
{
    (void)state;
    SluiceProxySet *set = create(SLUICE_PROXY_KIND_MATERIAL, 0);
    SluiceProxyId id;
    CHECK_OK(sluiceAddMaterialProxy(set, &id));
    CHECK_OK(sluiceRemoveProxy(set, id));
    CHECK_RESULT(sluiceRemoveProxy(set, id), SLUICE_ERROR_STALE_TEXTURE);
    request(set, 1, 1, 0, NULL);
    CHECK_RESULT(sluiceRemoveProxy(set, id), SLUICE_ERROR_STALE_TEXTURE);
    CHECK_RESULT(sluiceClearProxyRequests(set, id), SLUICE_ERROR_STALE_TEXTURE);
    CHECK_RESULT(sluiceRemoveProxy(set, id + 1), SLUICE_ERROR_UNKNOWN_TEXTURE);
    CHECK_RESULT(sluiceRemoveProxy(set, id + ((uint64_t)1 << 32)), SLUICE_ERROR_UNKNOWN_TEXTURE);
    CHECK_RESULT(sluiceRemoveProxy(set, SLUICE_NO_PROXY), SLUICE_ERROR_UNKNOWN_TEXTURE);
    CHECK_RESULT(sluiceRemoveProxy(set, SLUICE_ALL_PROXIES), SLUICE_ERROR_UNKNOWN_TEXTURE);
    sluiceDestroyProxySet(set);
}

static void a_request_for_something_removed_meanwhile_is_ignored(void **state)
{
    (void)state;
    static const uint32_t indices[] = {0, 1, 7, UINT32_MAX};
    SluiceProxySet *set = create(SLUICE_PROXY_KIND_GEOMETRY, 0);
    SluiceProxyId ids[] = {add(set), add(set)};
    CHECK_OK(sluiceRemoveProxy(set, ids[0]));
    request(set, 2, 1, 4, indices); /* made by a launch before the removal */
    check_requested(set, 1, ids + 1);
    CHECK_OK(sluiceRemoveProxy(set, ids[1])); /* and one whose request is known */
    check_requested(set, 0, NULL);
    sluiceDestroyProxySet(set);
}

static void an_index_is_not_reused_while_launches_may_name_it(void **state)
{
    (void)state;
    static const uint32_t zero = 0;
    SluiceProxySet *set = create(SLUICE_PROXY_KIND_MATERIAL, 0);
    SluiceProxyId old, other, new;
    CHECK_OK(sluiceAddMaterialProxy(set, &old));
    CHECK_OK(sluiceRemoveProxy(set, old));
    CHECK_OK(sluiceAddMaterialProxy(set, &other));
    assert_int_equal((uint32_t)other, 1); /* no launch has been reported */
    request(set, 5, 3, 0, NULL);          /* launches 4 and 5 are pending */
    request(set, 6, 4, 1, &zero);         /* launch 6 does not know the old one */
    assert_int_equal(info_of(set).removedCount, 1);
    CHECK_OK(sluiceAddMaterialProxy(set, &other));
    assert_int_equal((uint32_t)other, 2);
    request(set, 6, 5, 1, &zero);
    assert_int_equal(info_of(set).removedCount, 0);
    CHECK_OK(sluiceAddMaterialProxy(set, &new));
    assert_int_equal((uint32_t) new, 0);
    check_requested(set, 0, NULL); /* the request was for the old proxy */
    request(set, 6, 6, 1, &zero);
    check_requested(set, 1, &new);
    sluiceDestroyProxySet(set);
}

static void indices_end_at_the_limit_until_some_are_free(void **state)
{
    (void)state;
    SluiceProxySet *set = create(SLUICE_PROXY_KIND_GEOMETRY, 3);
    SluiceProxyId ids[] = {add(set), add(set), add(set)}, id;
    CHECK_RESULT(sluiceAddGeometryProxy(set, &unit, &id), SLUICE_ERROR_LIMIT_EXCEEDED);
    CHECK_OK(sluiceRemoveProxy(set, ids[1]));
    CHECK_RESULT(sluiceAddGeometryProxy(set, &unit, &id), SLUICE_ERROR_LIMIT_EXCEEDED);
    request(set, 0, 0, 0, NULL);
    CHECK_OK(sluiceAddGeometryProxy(set, &unit, &id));
    assert_int_equal((uint32_t)id, 1);
    sluiceDestroyProxySet(set);
}

static void an_index_whose_generations_are_used_up_gets_no_proxy(void **state)
{
    (void)state;
    SluiceProxySet *set = create(SLUICE_PROXY_KIND_GEOMETRY, 0);
    SluiceProxyId id = add(set);
    slc_proxy_at(set, 0)->generation = UINT32_MAX - 1;
    CHECK_OK(sluiceRemoveProxy(set, (uint64_t)(UINT32_MAX - 1) << 32 | (uint32_t)id));
    request(set, 0, 0, 0, NULL);
    id = add(set);
    assert_true(id == (uint64_t)UINT32_MAX << 32);
    CHECK_OK(sluiceRemoveProxy(set, id));
    request(set, 0, 0, 0, NULL);
    assert_int_equal((uint32_t)add(set), 1);
    sluiceDestroyProxySet(set);
}

static void wrong_settings_and_kinds_are_refused(void **state)
{
    (void)state;
    SluiceProxySetCreateInfo info = {.structSize = sizeof info, .maxProxyCount = 1u << 31};
    SluiceProxySet *set;
    SluiceProxyId id;
    SluiceProxyBox box;
    CHECK_RESULT(sluiceCreateProxySet(&info, &set), SLUICE_ERROR_INVALID_ARGUMENT);
    info = (SluiceProxySetCreateInfo){.structSize = sizeof info, .kind = 2};
    CHECK_RESULT(sluiceCreateProxySet(&info, &set), SLUICE_ERROR_INVALID_ARGUMENT);
    set = create(SLUICE_PROXY_KIND_MATERIAL, 0);
    assert_int_equal(info_of(set).maxProxyCount, 1u << 20);
    CHECK_RESULT(sluiceAddGeometryProxy(set, &unit, &id), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_OK(sluiceAddMaterialProxy(set, &id));
    CHECK_RESULT(sluiceGetProxyBox(set, id, &box), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceGetProxyBounds(set, &box), SLUICE_ERROR_INVALID_ARGUMENT);
    SluiceProxyListInfo list = {.structSize = sizeof list, .order = SLUICE_PROXY_ORDER_VOLUME};
    uint32_t n = 1;
    CHECK_RESULT(sluiceGetRequestedProxies(set, &list, &n, &id), SLUICE_ERROR_INVALID_ARGUMENT);
    sluiceDestroyProxySet(set);
    set = create(SLUICE_PROXY_KIND_GEOMETRY, 0);
    CHECK_RESULT(sluiceAddMaterialProxy(set, &id), SLUICE_ERROR_INVALID_ARGUMENT);
    list = (SluiceProxyListInfo){.structSize = sizeof list, .order = 3};
    CHECK_RESULT(sluiceGetRequestedProxies(set, &list, &n, &id), SLUICE_ERROR_INVALID_ARGUMENT);
    list = (SluiceProxyListInfo){.structSize = sizeof list,
                                 .order = SLUICE_PROXY_ORDER_DISTANCE,
                                 .point = {0, 1.0f / 0.0f, 0}};
    CHECK_RESULT(sluiceGetRequestedProxies(set, &list, &n, &id), SLUICE_ERROR_INVALID_ARGUMENT);
    const SluiceProxyRequests wrong = {
        .structSize = sizeof wrong, .begunLaunch = 1, .processedLaunch = 2};
    CHECK_RESULT(sluiceAddProxyRequests(set, &wrong), SLUICE_ERROR_INVALID_ARGUMENT);
    sluiceDestroyProxySet(set);
}

static void refuse_each_allocation(SluiceProxyKind kind)
{
    enum { COUNT = 2100 }; /* three chunks */
    uint64_t refuse_from = 0;
    for (bool done = false; !done; refuse_from++) {
        struct failing_allocator allocator;
        failing_allocator_init(&allocator, refuse_from);
        const SluiceProxySetCreateInfo info = {
            .structSize = sizeof info, .kind = kind, .pAllocator = &allocator.callbacks};
        SluiceProxySet *set = NULL;
        uint32_t count = 0;
        SluiceResult result = sluiceCreateProxySet(&info, &set);
        while (result == SLUICE_SUCCESS && count < COUNT) {
            SluiceProxyId id = 0;
            result = kind == SLUICE_PROXY_KIND_GEOMETRY ? sluiceAddGeometryProxy(set, &unit, &id)
                                                        : sluiceAddMaterialProxy(set, &id);
            if (result == SLUICE_SUCCESS)
                assert_true(id == ((uint64_t)1 << 32 | count++));
        }
        done = count == COUNT;
        if (!done)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        if (set) {
            assert_int_equal(info_of(set).proxyCount, count);
            assert_int_equal(info_of(set).hostMemorySize, allocator.live_bytes);
            allocator.refuse_from = UINT64_MAX;
            if (kind == SLUICE_PROXY_KIND_GEOMETRY)
                assert_int_equal((uint32_t)add(set), count);
        }
        sluiceDestroyProxySet(set);
        assert_int_equal(allocator.live_count, 0);
    }
    assert_true(refuse_from > 10);
}

static void without_memory_nothing_changes(void **state)
{
    (void)state;
    refuse_each_allocation(SLUICE_PROXY_KIND_GEOMETRY);
    refuse_each_allocation(SLUICE_PROXY_KIND_MATERIAL);
}

static void calls_take_no_memory_once_an_index_was_used(void **state)
{
    (void)state;
    static const uint32_t zero = 0;
    struct failing_allocator allocator;
    failing_allocator_init(&allocator, UINT64_MAX);
    const SluiceProxySetCreateInfo info = {.structSize = sizeof info,
                                           .pAllocator = &allocator.callbacks};
    SluiceProxyBox boxes[1], box;
    SluiceProxyRange range;
    const SluiceProxyBoxWrite write = {.structSize = sizeof write,
                                       .capacity = 1,
                                       .pBoxes = boxes,
                                       .rangeCapacity = 1,
                                       .pRanges = &range};
    const SluiceProxyRequests requests = {
        .structSize = sizeof requests, .indexCount = 1, .pIndices = &zero};
    SluiceProxySet *set;
    CHECK_OK(sluiceCreateProxySet(&info, &set));
    SluiceProxyId id = add(set);
    allocator.refuse_from = allocator.calls;
    for (uint32_t round = 0; round < 2; round++) {
        uint64_t version = 0;
        uint32_t count = 1;
        CHECK_OK(sluiceAddProxyRequests(set, &requests));
        CHECK_OK(sluiceGetRequestedProxies(set, NULL, &count, &id));
        assert_int_equal(count, 1);
        CHECK_OK(sluiceClearProxyRequests(set, id));
        CHECK_OK(sluiceGetProxyBox(set, id, &box));
        CHECK_OK(sluiceGetProxyBounds(set, &box));
        CHECK_OK(sluiceWriteProxyBoxes(set, &write, &version, &count));
        assert_memory_equal(boxes, &box, sizeof box);
        CHECK_OK(sluiceRemoveProxy(set, id));
        CHECK_OK(sluiceAddProxyRequests(set, &requests));
        assert_int_equal(info_of(set).proxyCount, 0);
        assert_int_equal((uint32_t)add(set), 0);
    }
    assert_int_equal(allocator.calls, allocator.refuse_from);
    sluiceDestroyProxySet(set);
}

static SluiceProxyBox random_box(uint64_t *seed)
{
    SluiceProxyBox box;
    for (uint32_t axis = 0; axis < 3; axis++) {
        box.min[axis] = (float)random_below(seed, 20) - 10;
        box.max[axis] = box.min[axis] + 1 + (float)random_below(seed, 3);
    }
    return box;
}

static void check_lists(const SluiceProxySet *set, const struct naive_set *naive, uint64_t *seed)
{
    SluiceProxyId ids[200], expected[200];
    for (uint32_t order = 0; order < 3; order++) {
        const SluiceProxyListInfo info = {
            .structSize = sizeof info, .order = order, .point = {1, 2, (float)order}};
        uint32_t all = naive_list(naive, &info, expected);
        uint32_t capacity = random_below(seed, all + 3), n = capacity;
        CHECK_RESULT(sluiceGetRequestedProxies(set, &info, &n, ids),
                     capacity < all ? SLUICE_INCOMPLETE : SLUICE_SUCCESS);
        assert_int_equal(n, capacity < all ? capacity : all);
        assert_memory_equal(ids, expected, n * sizeof *ids);
    }
}

static void everything_in_random_order_is_what_a_naive_set_does(void **state)
{
    (void)state;
    enum { CAPACITY = 150, STEPS = 20000 };
    SluiceProxySet *set = create(SLUICE_PROXY_KIND_GEOMETRY, CAPACITY);
    struct naive_set naive;
    uint64_t seed = 77, begun = 1, processed = 0;
    naive_init(&naive, CAPACITY);
    for (uint32_t step = 0; step < STEPS; step++) {
        uint32_t index = random_below(&seed, CAPACITY), indices[20];
        SluiceProxyId id = (uint64_t)naive.proxies[index].generation << 32 | index, got = 0;
        SluiceProxyBox box = random_box(&seed);
        bool live = naive.proxies[index].state == NAIVE_LIVE;
        switch (random_below(&seed, 8)) {
        case 0:
        case 1:
        case 2:
            id = naive_add(&naive, &box);
            CHECK_RESULT(sluiceAddGeometryProxy(set, &box, &got),
                         id ? SLUICE_SUCCESS : SLUICE_ERROR_LIMIT_EXCEEDED);
            assert_true(got == id);
            break;
        case 3:
        case 4:
            assert_int_equal(sluiceRemoveProxy(set, id) == SLUICE_SUCCESS, live);
            if (live)
                naive_remove(&naive, index);
            break;
        case 5:
            assert_int_equal(sluiceClearProxyRequests(set, id) == SLUICE_SUCCESS, live);
            naive.proxies[index].requested = false;
            break;
        case 6:
            begun += random_below(&seed, 2);
            processed += random_below(&seed, (uint32_t)(begun - processed) + 1);
            for (uint32_t i = 0; i < 20; i++)
                indices[i] = random_below(&seed, CAPACITY + 10);
            naive_request(&naive, begun, processed, 20, indices);
            request(set, begun, processed, 20, indices);
            break;
        default: check_lists(set, &naive, &seed); break;
        }
    }
    naive_finish(&naive);
    sluiceDestroyProxySet(set);
}

static void a_million_proxies_come_and_go_in_random_order(void **state)
{
    (void)state;
    enum { COUNT = 1000000, ROUNDS = 2 };
    SluiceProxySet *set = create(SLUICE_PROXY_KIND_GEOMETRY, 0);
    SluiceProxyId *ids = calloc(COUNT, sizeof *ids);
    uint8_t *used = calloc(COUNT, 1);
    uint64_t seed = 5;
    uint32_t live = 0, wrong = 0;
    assert_true(ids && used);
    for (uint32_t round = 0; round < ROUNDS; round++) {
        for (; live < COUNT; live++) {
            wrong += sluiceAddGeometryProxy(set, &unit, &ids[live]) != SLUICE_SUCCESS;
            if ((uint32_t)ids[live] >= COUNT) /* dense: no other index is used */
                fail_msg("index %u", (uint32_t)ids[live]);
            wrong += used[(uint32_t)ids[live]]++;
        }
        assert_int_equal(info_of(set).proxyCount, COUNT);
        assert_int_equal(info_of(set).indexCount, COUNT);
        uint32_t stay = round + 1 < ROUNDS ? COUNT / 3 : 0;
        while (live > stay) {
            uint32_t at = random_below(&seed, live);
            wrong += sluiceRemoveProxy(set, ids[at]) != SLUICE_SUCCESS;
            used[(uint32_t)ids[at]] = 0;
            ids[at] = ids[--live];
        }
        request(set, round, round, 0, NULL);
    }
    assert_int_equal(wrong, 0);
    assert_int_equal(info_of(set).indexCount, 0);
    /* With the 24 bytes of a box in a buffer at most 64 bytes for each. */
    assert_true(info_of(set).hostMemorySize <= (uint64_t)COUNT * 29 + 65536);
    free(ids);
    free(used);
    sluiceDestroyProxySet(set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clearing_requests_frees_no_id_in_use),
        cmocka_unit_test(reused_indices_are_found_and_old_ids_are_not),
        cmocka_unit_test(removing_twice_is_an_error_result),
        cmocka_unit_test(a_request_for_something_removed_meanwhile_is_ignored),
        cmocka_unit_test(an_index_is_not_reused_while_launches_may_name_it),
        cmocka_unit_test(indices_end_at_the_limit_until_some_are_free),
        cmocka_unit_test(an_index_whose_generations_are_used_up_gets_no_proxy),
        cmocka_unit_test(wrong_settings_and_kinds_are_refused),
        cmocka_unit_test(without_memory_nothing_changes),
        cmocka_unit_test(calls_take_no_memory_once_an_index_was_used),
        cmocka_unit_test(everything_in_random_order_is_what_a_naive_set_does),
        cmocka_unit_test(a_million_proxies_come_and_go_in_random_order),
    };
    return RUN_TESTS(tests);
}
