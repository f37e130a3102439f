/* Budget of a context: refused requests, and the clients that it asks to release memory. */
#include "vulkan/memory_budget.h"

#include "support/test.h"

enum { MIB = 1 << 20 };

#define IMAGE SLUICE_DEVICE_MEMORY_PURPOSE_IMAGE
#define HEAP SLUICE_DEVICE_MEMORY_PURPOSE_HEAP
#define PAGES SLUICE_DEVICE_MEMORY_PURPOSE_PAGES
#define TABLE SLUICE_DEVICE_MEMORY_PURPOSE_TABLE
#define STAGING SLUICE_DEVICE_MEMORY_PURPOSE_STAGING

/* A streamer, a demand loader and the context. */
struct stage {
    struct slc_memory_budget budget;
    struct slc_memory_client a, b, c;
};

static void start(struct stage *s, uint64_t limit)
{
    CHECK_OK(slc_memory_budget_init(&s->budget));
    slc_memory_budget_set_limit(&s->budget, limit);
    slc_memory_client_init(&s->a, &s->budget);
    slc_memory_client_init(&s->b, &s->budget);
    slc_memory_client_init(&s->c, &s->budget);
}

static void finish(struct stage *s)
{
    slc_memory_client_finish(&s->b); /* from the middle, the end, the start of the list */
    slc_memory_client_finish(&s->a);
    slc_memory_client_finish(&s->c);
    slc_memory_budget_finish(&s->budget);
}

static uint64_t tiles(struct stage *s)
{
    SluiceVulkanContextStatistics statistics = {0};
    slc_memory_budget_get(&s->budget, &statistics);
    assert_true(statistics.tileMemorySize ==
                statistics.heapMemorySize + statistics.pageMemorySize + statistics.imageMemorySize);
    return statistics.tileMemorySize;
}

/* Returns both kinds of pressure. */
static uint64_t begin(struct slc_memory_client *client)
{
    struct slc_memory_pressure pressure = slc_memory_client_begin(client);
    return pressure.beyond + pressure.refused;
}

static void tile_memory_of_all_clients_shares_the_limit(void **state)
{
    (void)state;
    struct stage s;
    start(&s, 10 * MIB);
    assert_true(slc_memory_client_take(&s.a, HEAP, false, 4 * MIB));
    assert_true(slc_memory_client_take(&s.b, PAGES, false, 5 * MIB));
    assert_false(slc_memory_client_take(&s.c, IMAGE, false, MIB + 1));
    assert_int_equal(tiles(&s), 9 * MIB);
    assert_true(slc_memory_client_take(&s.c, IMAGE, false, MIB));
    assert_false(slc_memory_client_take(&s.a, HEAP, false, 1));
    assert_false(slc_memory_client_take(&s.a, HEAP, false, UINT64_MAX));
    slc_memory_client_give(&s.b, PAGES, false, 5 * MIB);
    assert_true(slc_memory_client_take(&s.a, HEAP, false, 5 * MIB));
    assert_int_equal(tiles(&s), 10 * MIB);
    slc_memory_client_give(&s.a, HEAP, false, 5 * MIB);
    slc_memory_client_give(&s.a, HEAP, false, 4 * MIB);
    slc_memory_client_give(&s.c, IMAGE, false, MIB);
    assert_int_equal(tiles(&s), 0);
    finish(&s);
}

static void other_memory_is_counted_but_has_no_limit(void **state)
{
    (void)state;
    struct stage s;
    uint64_t device, host;
    start(&s, 4 * MIB);
    assert_true(slc_memory_client_take(&s.a, TABLE, false, 100 * MIB));
    assert_true(slc_memory_client_take(&s.a, STAGING, true, 50 * MIB));
    assert_true(slc_memory_client_take(&s.a, HEAP, false, 4 * MIB));
    slc_memory_client_get(&s.a, &device, &host);
    assert_int_equal(device, 104 * MIB);
    assert_int_equal(host, 50 * MIB);
    SluiceVulkanContextStatistics statistics;
    slc_memory_budget_get(&s.budget, &statistics);
    assert_int_equal(statistics.memoryBlockCount, 3);
    assert_int_equal(statistics.tableMemorySize, 100 * MIB);
    assert_int_equal(statistics.stagingMemorySize, 50 * MIB);
    assert_int_equal(begin(&s.b), 0);
    slc_memory_client_give(&s.a, TABLE, false, 100 * MIB);
    slc_memory_client_give(&s.a, STAGING, true, 50 * MIB);
    slc_memory_client_give(&s.a, HEAP, false, 4 * MIB);
    finish(&s);
}

static void a_lowered_limit_presses_everybody_by_a_share(void **state)
{
    (void)state;
    struct stage s;
    start(&s, SLC_NO_MEMORY_LIMIT);
    assert_true(slc_memory_client_take(&s.a, HEAP, false, 20 * MIB));
    assert_true(slc_memory_client_take(&s.b, PAGES, false, 3 * MIB));
    assert_int_equal(begin(&s.a), 0);
    slc_memory_budget_set_limit(&s.budget, 15 * MIB);
    uint64_t a = begin(&s.a), b = begin(&s.b); /* 8 MiB too many: 20/23 and 3/23 of them */
    assert_in_range(a, 8 * MIB / 23 * 20, 8 * MIB / 23 * 20 + MIB / 4);
    assert_in_range(b, 8 * MIB / 23 * 3, 8 * MIB / 23 * 3 + MIB / 4);
    assert_true(a + b >= 8 * MIB);
    assert_int_equal(begin(&s.c), 0);
    slc_memory_budget_set_limit(&s.budget, 0);
    assert_int_equal(begin(&s.a), 20 * MIB);
    assert_int_equal(begin(&s.b), 3 * MIB);
    slc_memory_budget_set_limit(&s.budget, 15 * MIB);
    assert_false(slc_memory_client_take(&s.b, PAGES, false, 1));
    slc_memory_client_give(&s.a, HEAP, false, 20 * MIB);
    assert_int_equal(begin(&s.b), 0);
    slc_memory_client_give(&s.b, PAGES, false, 3 * MIB);
    finish(&s);
}

static void the_smaller_limit_counts(void **state)
{
    (void)state;
    struct stage s;
    start(&s, 10 * MIB);
    slc_memory_budget_set_device_limit(&s.budget, 6 * MIB);
    assert_false(slc_memory_client_take(&s.a, HEAP, false, 7 * MIB));
    slc_memory_budget_set_device_limit(&s.budget, 20 * MIB);
    assert_false(slc_memory_client_take(&s.a, HEAP, false, 11 * MIB));
    slc_memory_budget_set_device_limit(&s.budget, SLC_NO_MEMORY_LIMIT);
    assert_true(slc_memory_client_take(&s.a, HEAP, false, 10 * MIB));
    slc_memory_budget_set_device_limit(&s.budget, 9 * MIB);
    assert_int_equal(begin(&s.a), MIB);
    slc_memory_client_give(&s.a, HEAP, false, 10 * MIB);
    finish(&s);
}

/* Whoever was refused is not pressed by that himself; others are, whenever they begin. */
static void what_one_is_refused_presses_the_others_for_two_of_his_begins(void **state)
{
    (void)state;
    struct stage s;
    start(&s, 10 * MIB);
    assert_true(slc_memory_client_take(&s.a, HEAP, false, 10 * MIB));
    assert_false(slc_memory_client_take(&s.b, PAGES, false, 4 * MIB));
    assert_false(slc_memory_client_take(&s.b, PAGES, false, 2 * MIB)); /* then it tries less */
    assert_int_equal(begin(&s.a), 4 * MIB);
    assert_int_equal(begin(&s.b), 0);
    assert_int_equal(begin(&s.a), 4 * MIB);
    assert_int_equal(begin(&s.b), 0);
    assert_int_equal(begin(&s.a), 0);
    /* the device may refuse, too */
    slc_memory_client_give(&s.a, HEAP, false, 10 * MIB);
    assert_true(slc_memory_client_take(&s.a, HEAP, false, 3 * MIB));
    assert_true(slc_memory_client_take(&s.b, PAGES, false, 4 * MIB));
    slc_memory_client_refuse(&s.b, PAGES, false, 4 * MIB);
    assert_int_equal(begin(&s.a), 3 * MIB);
    assert_int_equal(tiles(&s), 3 * MIB);
    slc_memory_client_give(&s.a, HEAP, false, 3 * MIB);
    finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tile_memory_of_all_clients_shares_the_limit),
        cmocka_unit_test(other_memory_is_counted_but_has_no_limit),
        cmocka_unit_test(a_lowered_limit_presses_everybody_by_a_share),
        cmocka_unit_test(the_smaller_limit_counts),
        cmocka_unit_test(what_one_is_refused_presses_the_others_for_two_of_his_begins),
    };
    return RUN_TESTS(tests);
}
