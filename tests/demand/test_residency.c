#include "demand/page_residency.h"

#include "demand/fake_memory.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdlib.h>

enum { CHANGES = 1 << 17 };

static struct slc_demand_residency *create(struct failing_allocator *a, uint64_t limit,
                                           const struct slc_page_memory *memory)
{
    struct slc_demand_residency *r;
    const struct slc_page_residency_create_info info = {
        .cb = &a->callbacks, .class_count = 1, .no_lod_bias = true};
    failing_allocator_init(a, UINT64_MAX);
    CHECK_OK(slc_residency_create(&info, &r));
    CHECK_OK(slc_residency_set_class(r, 0, limit, memory));
    return r;
}

static enum slc_request_answer request(struct slc_demand_residency *r, uint32_t page, uint8_t rank)
{
    SluiceResult result;
    const struct slc_page_request request = {.page = page, .rank = rank};
    enum slc_request_answer answer = slc_residency_request(r, &request, &result);
    CHECK_OK(result);
    return answer;
}

static void load(struct slc_demand_residency *r, uint32_t page, uint8_t rank, uint64_t value)
{
    assert_int_equal(request(r, page, rank), SLC_REQUEST_LOAD);
    slc_residency_loaded(r, page, value);
}

static uint32_t take(struct slc_demand_residency *r)
{
    static struct slc_page_change changes[CHANGES];
    return slc_residency_take_changes(r, changes, CHANGES);
}

static void creation_survives_every_allocation_failure(void **state)
{
    (void)state;
    for (uint64_t n = 0;; n++) {
        struct failing_allocator a;
        failing_allocator_init(&a, n);
        struct slc_demand_residency *r;
        const struct slc_page_residency_create_info info = {.cb = &a.callbacks, .class_count = 2};
        SluiceResult result = slc_residency_create(&info, &r);
        if (result == SLUICE_SUCCESS)
            slc_residency_destroy(r);
        assert_int_equal(a.live_count, 0);
        if (result == SLUICE_SUCCESS)
            break;
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
}

/* All but the last page go, one by one. */
static void oldest_use_goes_first_then_finest_rank_then_lowest_page(void **state)
{
    (void)state;
    const struct {
        uint32_t page;
        uint8_t rank;
        uint64_t used;
    } pages[] = {{9, 1, 2}, {40, 7, 3}, {41, 7, 3}, {8, 2, 3}, {5, 9, 4}, {6, 0, 4}};
    enum { COUNT = sizeof pages / sizeof *pages };
    struct failing_allocator a;
    struct slc_demand_residency *r = create(&a, COUNT, NULL);
    for (uint32_t i = COUNT; i > 0; i--)
        load(r, pages[i - 1].page, pages[i - 1].rank, pages[i - 1].page);
    take(r);
    for (uint64_t launch = 1; launch <= 4; launch++) {
        slc_residency_begin(r, launch);
        for (uint32_t i = 0; i < COUNT; i++)
            if (launch <= pages[i].used)
                slc_residency_use(r, pages[i].page);
        slc_residency_settle(r, 0);
    }
    slc_residency_begin(r, 5);
    for (uint32_t i = 0; i < COUNT; i++) {
        struct slc_page_evicted evicted;
        load(r, 1000 + i, 0, 0);
        assert_int_equal(slc_residency_take_evicted(r, &evicted, 1), 1);
        assert_int_equal(evicted.page, pages[i].page);
        assert_int_equal(evicted.value, pages[i].page);
    }
    slc_residency_destroy(r);
    assert_int_equal(a.live_count, 0);
}

static void a_page_that_changed_twice_is_told_once_and_both_values_go_once(void **state)
{
    (void)state;
    struct failing_allocator a;
    struct slc_demand_residency *r = create(&a, 4, NULL);
    struct slc_page_change change;
    struct slc_page_evicted evicted[3];
    load(r, 7, 0, 100);
    assert_int_equal(take(r), 1);
    slc_residency_forget(r, 7, 1);
    load(r, 7, 0, 200); /* never shown */
    slc_residency_forget(r, 7, 1);
    load(r, 7, 0, 300);
    assert_int_equal(slc_residency_take_changes(r, &change, 1), 1);
    assert_int_equal(change.page, 7);
    assert_int_equal(change.shown, SLC_SHOW_RESIDENT);
    assert_int_equal(change.value, 300);
    assert_int_equal(take(r), 0);
    assert_int_equal(slc_residency_take_evicted(r, evicted, 3), 2);
    assert_int_equal(evicted[0].value, 100);
    assert_int_equal(evicted[1].value, 200);
    slc_residency_destroy(r);
}

static void what_was_loaded_after_it_was_forgotten_is_dropped(void **state)
{
    (void)state;
    struct failing_allocator a;
    struct fake_memory memory;
    fake_memory_init(&memory, 4, 4);
    struct slc_page_memory calls = fake_page_memory(&memory);
    struct slc_demand_residency *r = create(&a, 4, &calls);
    assert_int_equal(request(r, 3, 0), SLC_REQUEST_LOAD);
    slc_residency_forget(r, 0, UINT64_C(1) << 31);
    assert_int_equal(slc_residency_place(r, 3), SLC_NO_PLACE);
    assert_int_equal(memory.taken_count, 1); /* the read may still write there */
    assert_int_equal(request(r, 3, 0), SLC_REQUEST_PENDING);
    slc_residency_loaded(r, 3, 0);
    assert_int_equal(memory.taken_count, 0);
    assert_int_equal(take(r), 0);
    assert_int_equal(request(r, 3, 0), SLC_REQUEST_LOAD);
    slc_residency_destroy(r);
}

static void an_evicted_page_comes_back_while_its_place_is_free(void **state)
{
    (void)state;
    struct failing_allocator a;
    struct fake_memory memory;
    fake_memory_init(&memory, 3, 3);
    struct slc_page_memory calls = fake_page_memory(&memory);
    struct slc_demand_residency *r = create(&a, 2, &calls);
    load(r, 1, 0, 0);
    load(r, 2, 0, 0);
    take(r);
    slc_residency_begin(r, 1);
    slc_residency_use(r, 2);
    slc_residency_settle(r, 0);
    slc_residency_begin(r, 2);
    load(r, 3, 0, 0); /* in the place of 1, but there is one that nobody had */
    slc_residency_settle(r, 0);
    take(r);
    slc_residency_begin(r, 3);
    slc_residency_use(r, 3);
    assert_int_equal(request(r, 1, 0), SLC_REQUEST_RESTORED);
    slc_residency_settle(r, 1);
    slc_residency_destroy(r);
}

static void everything_is_forgotten_in_one_call(void **state)
{
    (void)state;
    struct failing_allocator a;
    struct slc_demand_residency *r = create(&a, 500, NULL);
    struct slc_residency_counts counts;
    for (uint32_t i = 0; i < 500; i++)
        load(r, i * 4000000, 0, i);
    assert_int_equal(take(r), 500);
    slc_residency_forget(r, 0, UINT64_C(1) << 31);
    slc_residency_get_counts(r, 0, &counts);
    assert_int_equal(counts.resident, 0);
    assert_int_equal(take(r), 500);
    assert_true(slc_residency_check(r));
    slc_residency_destroy(r);
}

/* A million pages pass through a few places. */
static void memory_follows_what_is_resident(void **state)
{
    (void)state;
    struct failing_allocator a;
    struct fake_memory memory;
    fake_memory_init(&memory, 20, 20);
    struct slc_page_memory calls = fake_page_memory(&memory);
    struct slc_demand_residency *r = create(&a, 10, &calls);
    uint64_t bytes = 0;
    for (uint32_t launch = 1; launch <= 100000; launch++) {
        slc_residency_begin(r, launch);
        for (uint32_t i = 0; i < 5; i++)
            load(r, launch * 10 + i, (uint8_t)i, 0);
        slc_residency_settle(r, 5);
        take(r);
        if (launch == 1000)
            bytes = a.live_bytes;
    }
    assert_int_equal(a.live_bytes, bytes);
    assert_in_range(bytes, 1, 64 * 1024);
    slc_residency_destroy(r);
    assert_int_equal(a.live_count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(creation_survives_every_allocation_failure),
        cmocka_unit_test(oldest_use_goes_first_then_finest_rank_then_lowest_page),
        cmocka_unit_test(a_page_that_changed_twice_is_told_once_and_both_values_go_once),
        cmocka_unit_test(what_was_loaded_after_it_was_forgotten_is_dropped),
        cmocka_unit_test(an_evicted_page_comes_back_while_its_place_is_free),
        cmocka_unit_test(everything_is_forgotten_in_one_call),
        cmocka_unit_test(memory_follows_what_is_resident),
    };
    return RUN_TESTS(tests);
}
