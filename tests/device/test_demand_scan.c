/* The scan of requests against sorting on the host, bit by bit. */
#include "device/scan_rig.h"

#include "support/roll.h"
#include "support/test.h"
#include "vulkan/compute.h"

#include <stdlib.h>
#include <string.h>

#define SECTION SLUICE_DEMAND_SECTION_PAGES

struct span {
    struct scan_rig *rig;
    uint32_t first, count;
};

static void record_span_of_ranks(void *user, VkCommandBuffer commands)
{
    struct span *span = user;
    slc_demand_scan_record_ranks(&span->rig->scan, &span->rig->vk, commands, span->rig->ranks,
                                 span->first, span->count);
}

static void record_forget(void *user, VkCommandBuffer commands)
{
    struct span *span = user;
    slc_demand_scan_record_forget(&span->rig->scan, &span->rig->vk, commands, span->first,
                                  span->count);
    slc_compute_barrier(&span->rig->vk, commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_ACCESS_TRANSFER_READ_BIT);
    demand_rig_record_download(&span->rig->vk, commands, &span->rig->scan.requests,
                               &span->rig->requests_after);
}

static void give_ranks(struct scan_rig *r)
{
    for (uint32_t i = 0; i < r->section_count; i++)
        r->ranks[i] = (uint8_t)demand_rig_random(SLUICE_DEMAND_RANKS);
    r->send_ranks = true;
}

/* Alone, in runs, and whole sections. */
static void request_some(struct scan_rig *r, uint32_t count)
{
    for (uint32_t i = 0; i < count;) {
        uint32_t page = demand_rig_random(r->page_capacity), kind = demand_rig_random(64);
        uint32_t run = kind < 40 ? 1 : kind < 63 ? 1 + demand_rig_random(100) : SECTION;
        for (uint32_t j = 0; j < run && page + j < r->page_capacity; j++)
            scan_rig_request(r, page + j);
        i += run;
    }
}

static void lists_are_sorted_by_age_rank_and_id(void **state)
{
    static const uint32_t sizes[] = {1, 2, 4, 5, 31, 32, 33, 127, 128, 129, 1000, 4097};
    roll_seed(71);
    for (uint32_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct scan_rig r;
        uint32_t most = sizes[i] < 20 ? sizes[i] * SECTION : 20000;
        scan_rig_init(&r, *state, sizes[i], most, sizes[i] * SECTION);
        give_ranks(&r);
        for (uint32_t round = 0; round < 12; round++) {
            request_some(&r, demand_rig_random(most));
            r.capacity = round % 4 == 3 ? most : demand_rig_random(most + 1) / (1 + round % 4 * 8);
            scan_rig_scan(&r);
        }
        scan_rig_finish(&r);
    }
}

static void capacities_of_none_and_one_and_just_enough(void **state)
{
    struct scan_rig r;
    roll_seed(72);
    scan_rig_init(&r, *state, 50, 3001, 50 * SECTION);
    give_ranks(&r);
    for (uint32_t i = 0; i < 3000; i++)
        scan_rig_request(&r, i * 17);
    const uint32_t capacities[] = {0, 0, 1, 1, 1000, 1998, 1, 3001};
    const uint32_t stay[] = {3000, 3000, 2999, 2998, 1998, 0, 0, 0};
    for (uint32_t i = 0; i < 8; i++) {
        r.capacity = capacities[i];
        scan_rig_scan(&r);
        assert_int_equal(r.expected.postponedCount, stay[i]);
    }
    scan_rig_finish(&r);
}

static void repeated_scans_lose_nothing_and_list_nothing_twice(void **state)
{
    struct scan_rig r;
    roll_seed(73);
    scan_rig_init(&r, *state, 300, 500, 300 * SECTION);
    give_ranks(&r);
    uint32_t requested = 0, listed = 0, round = 0;
    uint8_t *asked = demand_rig_allocate(r.page_capacity, 1);
    do {
        for (uint32_t i = 0; i < 900 && round < 15; i++) {
            uint32_t page = demand_rig_random(r.page_capacity);
            requested += asked[page] == 0;
            asked[page] = 1;
            scan_rig_request(&r, page);
        }
        scan_rig_scan(&r);
        const uint32_t *pages;
        uint32_t count = slc_demand_scan_result(&r.scan, r.slot, &pages).listedCount;
        for (uint32_t i = 0; i < count; i++) {
            assert_int_equal(asked[pages[i]], 1); /* not asked for, or listed before */
            asked[pages[i]] = round < 15 ? 0 : 2;
        }
        listed += count;
    } while (r.expected.postponedCount > 0 && round++ < 100);
    assert_int_equal(listed, requested);
    assert_true(round > 15 && round < 100);
    free(asked);
    scan_rig_finish(&r);
}

static void what_waited_comes_before_what_is_new(void **state)
{
    struct scan_rig r;
    scan_rig_init(&r, *state, 40, 4, 40 * SECTION);
    r.ranks[39] = 15;
    scan_rig_request(&r, 39 * SECTION + 7);
    r.capacity = 0;
    scan_rig_scan(&r);
    scan_rig_request(&r, 3); /* coarse, but new */
    r.capacity = 1;
    scan_rig_scan(&r);
    const uint32_t *pages;
    assert_int_equal(slc_demand_scan_result(&r.scan, r.slot, &pages).listedCount, 1);
    assert_int_equal(pages[0], 39 * SECTION + 7);
    scan_rig_scan(&r);
    assert_int_equal(slc_demand_scan_result(&r.scan, r.slot, &pages).listedCount, 1);
    assert_int_equal(pages[0], 3);
    scan_rig_finish(&r);
}

static void sections_beyond_the_end_wait_until_it_moves(void **state)
{
    struct scan_rig r;
    scan_rig_init(&r, *state, 200, 1000, 200 * SECTION);
    for (uint32_t s = 0; s < 200; s++) {
        scan_rig_request(&r, s * SECTION);
        scan_rig_request(&r, s * SECTION + SECTION - 1);
    }
    const uint32_t ends[] = {0,
                             1,
                             31 * SECTION,
                             32 * SECTION,
                             33 * SECTION - 1,
                             97 * SECTION,
                             128 * SECTION,
                             128 * SECTION + 1,
                             200 * SECTION};
    const uint32_t sections[] = {0, 1, 30, 1, 1, 64, 31, 1, 71};
    for (uint32_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        r.page_end = ends[i];
        scan_rig_scan(&r);
        assert_int_equal(r.expected.sectionCount, sections[i]);
    }
    scan_rig_finish(&r);
}

static void flags_of_sections_without_requests_go_and_do_not_count(void **state)
{
    struct scan_rig r;
    scan_rig_init(&r, *state, 100, 100, 100);
    scan_rig_scan(&r); /* nothing at all */
    for (uint32_t s = 0; s < 100; s += 3)
        scan_rig_set_bit(&r.sections, s, true);
    scan_rig_request(&r, 51 * SECTION + 9);
    scan_rig_scan(&r);
    assert_int_equal(r.expected.sectionCount, 1);
    scan_rig_finish(&r);
}

static void ranks_may_change_a_few_at_a_time(void **state)
{
    struct scan_rig r;
    roll_seed(74);
    scan_rig_init(&r, *state, 5003, 400, 100000);
    give_ranks(&r);
    for (uint32_t round = 0; round < 12; round++) {
        request_some(&r, 1000);
        scan_rig_scan(&r);
        uint32_t first = demand_rig_random(r.section_count);
        uint32_t count = demand_rig_random(r.section_count - first + 1);
        if (round % 3)
            count = count < 7 ? count : 7;
        for (uint32_t i = 0; i < count; i++)
            r.ranks[first + i] = (uint8_t)demand_rig_random(SLUICE_DEMAND_RANKS);
        struct span span = {&r, first, count};
        harness_run(r.h, record_span_of_ranks, &span);
    }
    scan_rig_finish(&r);
}

static void forgotten_pages_are_not_listed(void **state)
{
    struct scan_rig r;
    scan_rig_init(&r, *state, 70, 10, 70 * SECTION);
    for (uint32_t page = 0; page < r.page_capacity; page += 5)
        scan_rig_request(&r, page);
    scan_rig_scan(&r);
    const uint32_t spans[][2] = {{0, 0}, {32, 32}, {96, 33}, {2048, 5000}, {69 * SECTION, SECTION}};
    for (uint32_t i = 0; i < 5; i++) {
        struct span span = {&r, spans[i][0], spans[i][1]};
        harness_run(r.h, record_forget, &span);
        for (uint32_t j = 0; j < (span.count + 31) / 32 * 32; j++)
            scan_rig_set_bit(&r.requests, span.first + j, false);
        assert_memory_equal(r.requests_after.mapped, r.requests.mapped, r.requests.size);
        scan_rig_scan(&r);
    }
    scan_rig_finish(&r);
}

static void sixty_four_mi_pages_are_scanned_to_both_ends(void **state)
{
    struct scan_rig r;
    roll_seed(75);
    scan_rig_init(&r, *state, 65536, 1u << 18, 1u << 20);
    give_ranks(&r);
    for (uint32_t round = 0; round < 3; round++) {
        scan_rig_request(&r, 0);
        scan_rig_request(&r, r.page_capacity - 1);
        for (uint32_t i = 0; i < 300000 && round < 2; i++)
            scan_rig_request(&r, demand_rig_random(r.page_capacity));
        scan_rig_scan(&r);
        assert_int_equal(r.expected.requestCount > r.capacity, round < 2);
    }
    scan_rig_finish(&r);
}

static void every_bit_of_sixty_four_mi_may_be_set(void **state)
{
    struct scan_rig r;
    roll_seed(76);
    scan_rig_init(&r, *state, 65536, 1u << 20, 1u << 20);
    give_ranks(&r);
    memset(r.requests.mapped, 0xFF, r.requests.size);
    memset(r.sections.mapped, 0xFF, r.sections.size);
    for (uint32_t round = 0; round < 3; round++) {
        r.capacity = round == 0 ? 8192 : round == 1 ? 1u << 20 : 77;
        scan_rig_scan_many(&r);
        assert_int_equal(r.expected.requestCount,
                         (1u << 26) - (round > 0 ? 8192 : 0) - (round > 1 ? 1u << 20 : 0));
    }
    scan_rig_finish(&r);
}

static void sixty_four_mi_pages_cost_less_than_nine_mebibytes(void **state)
{
    struct scan_rig r;
    scan_rig_init(&r, *state, 65536, 16, 16);
    struct slc_demand_scan_create_info info = {r.page_capacity, SCAN_RIG_SLOTS, r.list_capacity};
    uint64_t size = slc_demand_scan_device_size(&info);
    assert_int_equal(size, r.scan.requests.size + r.scan.sections.size + r.scan.postponed.size +
                               r.scan.ranks.size + r.scan.scratch.size);
    assert_true(size > 8u << 20 && size < 9u << 20);
    scan_rig_finish(&r);
}

static void too_little_memory_and_too_small_ranges_are_refused(void **state)
{
    struct slc_vk vk;
    struct slc_caps caps;
    struct slc_demand_scan scan;
    const struct slc_demand_scan_create_info info = {1u << 20, SCAN_RIG_SLOTS, 100};
    demand_rig_init(*state, &vk, &caps);
    uint32_t count = 0;
    SluiceResult result;
    do { /* validation would tell of what is left */
        demand_rig_limit_memory(&vk, count);
        result = slc_demand_scan_init(&scan, &vk, &caps, &info);
        if (result != SLUICE_SUCCESS)
            assert_null(scan.requests.buffer);
    } while (result == SLUICE_ERROR_OUT_OF_DEVICE_MEMORY && count++ < 20);
    CHECK_OK(result);
    assert_int_equal(count, 6);
    slc_demand_scan_finish(&scan, &vk);
    caps.max_storage_buffer_range = (1u << 20) / 8 - 1;
    CHECK_RESULT(slc_demand_scan_init(&scan, &vk, &caps, &info), SLUICE_ERROR_LIMIT_EXCEEDED);
    slc_demand_scan_finish(&scan, &vk);
    harness_check_silence(*state);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_are_sorted_by_age_rank_and_id),
        cmocka_unit_test(capacities_of_none_and_one_and_just_enough),
        cmocka_unit_test(repeated_scans_lose_nothing_and_list_nothing_twice),
        cmocka_unit_test(what_waited_comes_before_what_is_new),
        cmocka_unit_test(sections_beyond_the_end_wait_until_it_moves),
        cmocka_unit_test(flags_of_sections_without_requests_go_and_do_not_count),
        cmocka_unit_test(ranks_may_change_a_few_at_a_time),
        cmocka_unit_test(forgotten_pages_are_not_listed),
        cmocka_unit_test(sixty_four_mi_pages_are_scanned_to_both_ends),
        cmocka_unit_test(every_bit_of_sixty_four_mi_may_be_set),
        cmocka_unit_test(sixty_four_mi_pages_cost_less_than_nine_mebibytes),
        cmocka_unit_test(too_little_memory_and_too_small_ranges_are_refused),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
